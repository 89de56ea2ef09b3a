"""Draws families: droplets that break up, and the sizes of those that pass."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle
from matplotlib.ticker import FixedLocator, NullLocator, StrMethodFormatter

from .. import style
from ..labels.groups import Groups
from ..reading import stored
from ..tools.errors import UserError
from ..tools.hints import AnyPath, Group
from .lengths import add_scale

if TYPE_CHECKING:
    import pandas

PLACE = StrMethodFormatter("{x:.4g}")  # Places of exits have more digits than those of other lines.
MOST_UNKNOWN = 0.1  # Largest share of the area that may have an unknown fate at the outlet.
# style.DROPLET is the colour of a droplet that has not ended.
END_COLOURS = {"clogged": style.COLOURS[3], "flowing": style.COLOURS[0], "passed": style.COLOURS[0],
               "small": style.COLOURS[4], "failed": style.COLOURS[6], "broken": "0.6"}
END_WORDS = {"clogged": "clogged", "flowing": "still moving", "passed": "passed the exit",
             "small": "too small, not followed", "failed": "failed", "broken": "broke up"}
EXIT = {"color": "0.3", "linestyle": "--", "linewidth": 0.8}


@dataclasses.dataclass
class Outlet:
    """The line at which the distribution of diameters is taken."""

    place: float
    unit: str  # sigma or mm

    def __str__(self) -> str:
        return f"{self.place:g}\N{NO-BREAK SPACE}{'σ' if self.unit == 'sigma' else self.unit}"

    def with_mm(self, diameter: float | None) -> str:
        """The place as text, also in mm if a place in diameters is converted. @param diameter  sigma [mm], if known"""
        if not diameter or self.unit == "mm":
            return str(self)
        return f"{self} ({self.place * diameter:.4g}\N{NO-BREAK SPACE}mm)"

    def of(self, group: Group) -> float:
        """The place in diameters of the group's droplets. @throws UserError  if the place is in mm, and the diameter is
        not known"""
        if self.unit == "sigma":
            return self.place
        length = (group.get("laboratory_scale") or {}).get("length_mm")
        if not length:
            raise UserError(f"invalid --outlet={self.place:g}mm (the droplets' diameter is not known) "
                            "give the outlet in droplet diameters, or add --lab FILE")
        return self.place / length

    def refuse_outside_devices(self, groups: Sequence[Group]) -> None:
        """@throws UserError  if the place is behind the exit of a device, or upstream of the release"""
        for group in groups:
            own = group.get("in_table", group)  # lengths in sigma
            if own.get("release") == "entrance" and self.of(group) < own["entrance"]:
                raise UserError(f"invalid --outlet={self.place:g}{self.unit} (upstream of the release at x = "
                                f"{own['entrance'] * self.place / self.of(group):g} {self.unit}) "
                                "give a place downstream of it")
            exit_place = own.get("exit") or math.inf
            if self.of(group) > exit_place * (1 + 1e-9):  # A place in mm is rounded.
                raise UserError(f"invalid --outlet={self.place:g}{self.unit} (behind the exit at x = "
                                f"{exit_place * self.place / self.of(group):g} {self.unit}, where runs end) "
                                "give a place up to the exit of every device")

    def line(self, group: Group) -> dict[str, Any] | None:
        """The group's line at this place."""
        place = self.of(group)
        return next((line for line in group["families"]["lines"] if math.isclose(line["distance"], place)), None)


def unknown_area(line: dict[str, Any]) -> float:
    """Fraction of the area whose fate at a line is not known. Droplets that are too small to be followed belong to
    it."""
    return float(line["not_known"] + line["small"])


def with_families(groups: Groups, source: AnyPath) -> list[Group]:
    found = [group for group in groups.members if group.get("families")]
    if not found:
        raise UserError(f"no droplet of {source} has daughters; {remedy_for(groups)}")
    return found


def remedy_for(groups: Groups) -> str:
    if any(group.get("break_up") == "daughters" for group in groups.members):
        return "no family has ended yet; start or resume the sweep"
    return "run the sweep with break-up=daughters and break-up-neck"


def outlet_of(members: Sequence[Group]) -> Outlet:
    """The farthest line at which most of the area is known (the first line if there is none). @throws UserError  if no
    droplet reached a line"""
    known = sorted({line["distance"] for group in members for line in group["families"]["lines"]})
    if not known:
        raise UserError("no droplet went 10 sigma; give --outlet X with a smaller distance, or make max-time longer")

    def is_known(outlet: Outlet) -> bool:
        lines = [outlet.line(group) for group in members]
        return all(line and unknown_area(line) <= MOST_UNKNOWN for line in lines)

    outlets = [Outlet(distance, "sigma") for distance in known]
    return next(filter(is_known, reversed(outlets)), outlets[0])


def common_outlet(members: Sequence[Group]) -> Outlet:
    """The outlet of droplets of several diameters, at one place in mm: the nearest one of outlet_of() of each group."""
    return Outlet(min(outlet_of([group]).place * group["diameter_mm"] for group in members), "mm")


def fate_note(outlet: str, unknown: float) -> str:
    """@param outlet  the line in words; @param unknown  largest fraction of the area whose fate at the line is not
    known"""
    of_area = f"at most {100 * unknown:.2g} % of the area is not known" if unknown > 0 else "the whole area is known"
    return f"at {outlet} the fate of {of_area}"


def draw(groups: Groups, asked: Outlet | None, source: AnyPath) -> Figure:
    """@param asked  the outlet, or None for the farthest line at which most of the area is known"""
    members = with_families(groups, source)
    outlet = asked or outlet_of(members)
    figure = style.new_figure(figsize=(8.6, 7.2), layout="constrained")
    grid = figure.add_gridspec(2, 2)
    share, number, sizes = (figure.add_subplot(place) for place in (grid[0, 0], grid[0, 1], grid[1, :]))
    width = members[0]["families"]["diameter_class"]
    # Droplets of several diameters have no common sigma, so all axes are in mm.
    scales = [group["diameter_mm"] if groups.are_in_mm else 1.0 for group in members]
    known = sorted({line["distance"] * scale for group, scale in zip(members, scales)
                    for line in group["families"]["lines"]})
    highest = 1.0  # number of droplets
    for index, (group, colour) in enumerate(zip(members, style.shades(len(members)))):
        label = groups.label_of(group)
        lines = group["families"]["lines"]
        places = [line["distance"] * scales[index] for line in lines]
        passing, *ends = (np.array([line[name] for line in lines], dtype=float)  # NaN: unknown
                          for name in ("passing", "passing_lower", "passing_upper"))
        bars = np.nan_to_num(np.abs(np.array(ends) - passing))
        shifted = [place * style.side_by_side(index, len(members), places) for place in places]
        marker = style.MARKERS[index % len(style.MARKERS)]
        share.errorbar(shifted, passing, yerr=bars, color=colour, capsize=2)
        counts = np.array([line["passed"]["number"] if line["passed"]["number"] or line["not_known"] == 0 else np.nan
                           for line in lines])
        highest = max([highest, *counts[np.isfinite(counts)]])
        number.plot(places, counts, color=colour)
        for axes, abscissas, heights in ((share, shifted, passing), (number, places, counts)):
            for abscissa, height, line in zip(abscissas, heights, lines):
                axes.plot(abscissa, height, color=colour, marker=marker,
                          fillstyle="none" if unknown_area(line) > MOST_UNKNOWN else "full")
        at_outlet = outlet.line(group)
        if at_outlet:
            numbers = at_outlet["passed"]["numbers"]
            edges = np.arange(len(numbers) + 1) * width * scales[index]
            # Legends avoid a line but not stairs().
            sizes.step([0, *edges], [0, *numbers, 0], where="post", color=colour, linewidth=1.6, label=label)
    for axes in (share, number):
        style.logarithmic_abscissa(axes, known)
        axes.xaxis.set_major_formatter(PLACE)
    share.set_ylim(0, 1.05)
    number.set_ylim(0, 1.05 * highest)
    length = groups.laboratory.get("length_mm")
    at_line = outlet.with_mm(length)
    place = "place in the device" if any(group.get("passages") for group in members) else "distance from the release"
    x, d = ("$x$ [mm]", "$d$ [mm]") if groups.are_in_mm else (r"$x/\sigma$", r"$d/\sigma$")
    style.label(share, f"{place} {x}", "share of the area that passes")
    style.label(number, f"{place} {x}", "droplets that pass, per released droplet")
    sizes.set_ylim(bottom=0)
    style.label(sizes, f"diameter {d}",
                f"droplets per released droplet\nat {at_line}, in classes of ${width:g}\\,\\sigma$")
    style.legend(sizes)
    if length:
        add_scale(sizes, "top", length, "diameter [mm]")
        for axes in (share, number):
            axis = add_scale(axes, "top", length, f"{place} [mm]")
            axis.set_major_locator(FixedLocator([length * tick for tick in axes.get_xticks()]))
            axis.set_minor_locator(NullLocator())
            axis.set_major_formatter(PLACE)
    unknown = [unknown_area(line) for group in members if (line := outlet.line(group))]
    style.notes_of_panels(figure, [
        "bars: intervals from resampled released droplets; a droplet passes when it, or one from which it descends, "
        "first crosses the line",
        f"{fate_note(at_line, max(unknown, default=0))}; "
        f"hollow: of more than {100 * MOST_UNKNOWN:g} %, so more droplets may still pass"])
    return figure


def order_of(paths: Sequence[str]) -> dict[str, float]:
    """The height of each droplet in the tree: leaves one below the other, mothers between their daughters."""
    leaves = [path for path in sorted(paths) if path + "0" not in paths]
    heights = {path: float(-place) for place, path in enumerate(leaves)}
    for path in sorted(paths, key=len, reverse=True):
        if path not in heights:
            heights[path] = (heights[path + "0"] + heights[path + "1"]) / 2
    return heights


def family_of(droplets: pandas.DataFrame, task: int, source: AnyPath, remedy: str = "") -> pandas.DataFrame:
    """The droplets of one run. @param remedy  if no run has a family. @throws UserError  if the run has no family"""
    family = droplets[droplets.task == task]
    if family.empty:
        known = sorted(set(droplets.task))
        if known:
            more = f" and {len(known) - 20} more" if len(known) > 20 else ""
            remedy = f"its tasks with one are {', '.join(map(str, known[:20]))}{more}"
        raise UserError(f"task {task} of {source} has no family that has ended; "
                        f"{remedy or 'run the sweep with break-up=daughters, or resume it'}")
    return family


def release_in_device(row: np.void) -> float | None:
    """The x where the droplet of a row was released [sigma]. None: the run was not in a device (clogfit has the same
    rule)."""
    is_in_device = row["obstacle_filling"] == b"file" and (row["release"] == b"entrance" or row["exit"] > 0)
    return float(row["release_x"]) if is_in_device else None


def diameter_of(row: np.void, groups: Groups) -> float | None:
    """sigma of the row's droplet [mm], if known"""
    own = (group["laboratory_scale"]["length_mm"] for group in groups.members
           if group.get("laboratory_scale") and group["laboratory"] == stored.text(row["laboratory"]))
    return groups.laboratory.get("length_mm") or next(own, None)


def draw_family(family: pandas.DataFrame, row: np.void, groups: Groups) -> Figure:
    """Draws the droplets of one family as bars from birth to end. @param row  of the ancestor in the table of runs"""
    release = release_in_device(row)
    births, ends = (family[name] + (release or 0) for name in ("birth_distance", "end_distance"))
    heights = order_of(list(family.path))
    lowest, highest = min(heights.values()), max(heights.values())
    figure, axes = style.subplots(figsize=(7.6, 1.6 + 0.45 * (highest - lowest + 1)))
    for member, birth, end in zip(family.itertuples(), births, np.maximum(births, ends)):
        height = heights[member.path]
        axes.add_patch(Rectangle((birth, height - 0.4 * member.diameter), end - birth, 0.8 * member.diameter,
                                 facecolor=END_COLOURS[member.status], edgecolor="none"))
        axes.annotate(f"{member.diameter:.2f}", (end, height), xytext=(3, 0), textcoords="offset points", fontsize=7,
                      va="center")
        if member.status == "broken":
            for part in "01":
                axes.plot([end, end], [height, heights[member.path + part]], color="0.6", linewidth=0.8, zorder=0)
    handles: list[Any] = [Rectangle((0, 0), 1, 1, facecolor=colour, label=END_WORDS[status])
                          for status, colour in END_COLOURS.items() if status in set(family.status)]
    last = ends.max()
    if row["exit"] > 0:
        handles += axes.plot([row["exit"]] * 2, [lowest - 0.6, highest + 0.7], label="exit", **EXIT)
        last = max(last, row["exit"])
    first = births.min()
    axes.set_xlim(first, last + 0.06 * (last - first))
    axes.set_ylim(lowest - 1.3, highest + 0.7)  # The legend is below the bars.
    axes.set_yticks([])
    axes.legend(handles=handles, frameon=False, fontsize=8, loc="lower right", ncols=len(handles))
    words = "displacement along gravity" if release is None else "place in the device"
    axes.set_xlabel(rf"{words} ${'r' if release is None else 'x'}/\sigma$")
    if diameter := diameter_of(row, groups):
        add_scale(axes, "top", diameter, f"{words} [mm]")
    style.notes(axes, [f"task {row['task']}: each bar is a droplet, as thick as its diameter, which is beside it"])
    return figure
