"""How far droplets in lattices migrate sideways, against what the sweep varies: the angle of the rows, as a rule."""

import functools
import math

import numpy as np
from matplotlib.axes import Axes

from .. import style
from ..labels import AXES
from ..labels.groups import Groups
from . import lengths


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
    lengths.draw_curves(axes, groups, functools.partial(lengths.draw_speeds, column="lateral_slope"))
    draw_rows(axes, groups)
    style.finish(axes, AXES["slope"], groups.caption(), notes(groups))
