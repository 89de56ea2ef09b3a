"""How far droplets in lattices migrate sideways, against what the sweep varies: the angle of the rows, as a rule."""

import math
from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes

from .. import style
from ..labels import AXES
from ..labels.groups import Groups
from ..tools.hints import Group
from . import lengths


def draw_slopes(axes: Axes, places: Sequence[float], groups: Sequence[Group], index: int, label: str) -> None:
    """Lateral displacement per distance, with standard errors from the scatter between runs; of one run it has none."""
    points = sorted(((place, group) for place, group in zip(places, groups) if group["lateral_slope"] is not None), key=lambda point: point[0])
    known = [group for _, group in points]
    drawn = axes.errorbar(
        [x for x, _ in points], [group["lateral_slope"] for group in known], yerr=[group["lateral_slope_error"] or 0.0 for group in known],
        **style.curve_style(index), markersize=5, linewidth=1, elinewidth=1, capsize=2.5, label=label, gid=style.mark("curve", known))
    drawn.lines[0].set_gid(style.mark("point", known))


def draw_rows(axes: Axes, groups: Groups) -> None:
    """Lines for a droplet that follows the rows, and for one that goes straight on."""
    angles = [group["lattice_angle"] for group in groups.members]
    axes.axhline(0, color="0.6", linewidth=0.8, linestyle=":", zorder=1)
    if groups.abscissa == "lattice_angle" and min(angles) < max(angles):
        along = np.linspace(min(angles), max(angles), 100)
        axes.plot(along, [math.tan(math.radians(angle)) for angle in along], color="0.6", linewidth=0.8, linestyle="--", zorder=1)


def notes(groups: Groups) -> list[str]:
    """Says what is drawn, and for how many droplets it is not known."""
    lines = ["dashed: along the rows; dotted: straight on; bars: standard errors"]
    unknown = sum(group["lateral_slope"] is None for group in groups.members)
    return lines + ([f"{unknown} of {len(groups.members)} points: no droplet went half a diameter"] if unknown else [])


def draw_on(axes: Axes, groups: Groups) -> None:
    lengths.draw_curves(axes, groups, draw_slopes)
    draw_rows(axes, groups)
    axes.set_ylabel(AXES["slope"])
    style.grid(axes)
    style.legend(axes)
    style.caption(axes, groups.caption())
    style.notes(axes, notes(groups))
