"""Draws the diameters of the droplets that leave an array in which droplets break up, for line tensions, meshes, necks
and speeds of daughters."""

import numpy as np

from .. import style
from ..drawing.families import Outlet, fate_note
from ..tools.errors import UserError
from ..tools.hints import Group
from .arrays import by
from .captions import describe
from .plate import Plate, figure
from .runner import Runner

CONFIG = "families"
OUTLET = 50  # Distance from the release at which diameters are counted [sigma].
LINES = ("-", "--", ":", "-.")
VARIED = ("speed_exponent", "break_up_neck", "vertices")


def outlet_of(groups: list[Group]) -> Outlet:
    """The farthest line up to OUTLET that droplets of all groups have passed."""
    lines = [{line["distance"] for line in group["families"]["lines"]} for group in groups]
    common = [distance for distance in set.intersection(*lines) if distance <= OUTLET]
    if not common:
        raise UserError(f"the droplets of {CONFIG} do not go 10 sigma; make max-time longer")
    return Outlet(max(common), "sigma")


def label_of(group: Group) -> str:
    power = f"diameter^{group['speed_exponent']:g}".removesuffix("^1")
    exponent = f", speed proportional to {power}" if group["speed_exponent"] else ""
    return rf"neck ${group['break_up_neck']:g}\,\sigma$, {group['vertices']} vertices{exponent}"


@figure("sizes", "diameters of droplets behind an array in which they break up, for three line tensions, two meshes, "
                 "two necks and two laws of the daughters' speed", [CONFIG], "2 min")
def diameters_behind_an_array(runner: Runner) -> Plate:
    groups = [group for group in runner.sweep(CONFIG) if group.get("families")]
    outlet = outlet_of(groups)
    tensions = by(groups, "line_tension")
    drawing, panels = style.subplots(len(tensions), 1, figsize=(6.8, 1.6 + 2.4 * len(tensions)), sharex=True,
                                     squeeze=False)
    data = []
    for (tension, members), axes in zip(tensions, panels.flat):
        for index, group in enumerate(sorted(members, key=lambda member: [member[name] for name in VARIED])):
            line = outlet.line(group)
            assert line  # outlet_of() chooses a line of all groups.
            width, passed = group["families"]["diameter_class"], line["passed"]
            edges = np.arange(len(passed["numbers"]) + 1) * width
            axes.stairs(passed["numbers"], edges, color=style.COLOURS[index], linewidth=1.4,
                        linestyle=LINES[index % len(LINES)], label=label_of(group))
            data += [{"line_tension": tension, **{name: group[name] for name in VARIED},
                      "ancestors": group["families"]["ancestors"], "outlet": outlet.place, "diameter_from": edges[i],
                      "diameter_to": edges[i + 1], "number": passed["numbers"][i], "area": passed["areas"][i],
                      "clogged": line["clogged"], "small": line["small"], "not_known": line["not_known"]}
                     for i in range(len(passed["numbers"]))]
        axes.set_title(f"line tension {tension:g}", fontsize=9)
    panels[0, 0].set_ylim(0, 1.65 * panels[0, 0].dataLim.ymax)  # The legend is above the bars.
    panels[0, 0].legend(frameon=False, fontsize=8, loc="upper left")
    panels.flat[-1].set_xlim(0, 1)
    panels.flat[-1].set_xlabel(r"diameter $d/\sigma$")
    drawing.supylabel(
        rf"droplets per released droplet at {outlet}, in classes of ${width:g}\,\sigma$", fontsize="medium")
    fits = style.fitting(drawing, 8, 0.9 * drawing.bbox.width)
    drawing.suptitle(style.in_lines(describe(runner.columns(CONFIG), groups, ["vertices", "line_tension"]), fits),
                     fontsize=8, color="0.25")
    unknown = max(point["not_known"] + point["small"] for point in data)
    style.notes_of_panels(drawing, [fate_note(str(outlet), unknown)])
    return Plate(drawing, data)
