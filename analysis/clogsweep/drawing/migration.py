"""Draws the lateral displacement of droplets in lattices against the varied parameter, usually the angle of the
rows."""

import functools
import math
from typing import Any

import numpy as np
from matplotlib.axes import Axes

from .. import style
from ..labels import AXES
from ..labels.groups import Groups
from . import lengths


def draw_rows(axes: Axes, groups: Groups) -> bool:
    """Draws one line for a droplet that follows the rows, and one for a droplet that moves straight on. @return whether
    the line for the rows is drawn"""
    angles = [group["lattice_angle"] for group in groups.members]
    axes.axhline(0, color="0.6", linewidth=0.8, linestyle=":", zorder=1)
    dashed: dict[str, Any] = {"color": "0.6", "linewidth": 0.8, "linestyle": "--", "zorder": 1}
    if groups.abscissa == "lattice_angle":
        along = np.linspace(min(angles), max(angles), 100)
        axes.plot(along, np.tan(np.radians(along)), **dashed)
        return True
    if any(len({group["lattice_angle"] for group in members}) > 1 for _, members in groups.curves()):
        return False
    tilts = set(angles) - {0}
    for angle in tilts:
        axes.axhline(math.tan(math.radians(angle)), **dashed)
    return bool(tilts)


def notes(groups: Groups, has_rows: bool) -> list[str]:
    """Explains the picture, and states the number of droplets without a value."""
    lines = ["dashed: along the rows; " * has_rows + "dotted: straight on; bars: standard errors"]
    unknown = sum(group["lateral_slope"] is None for group in groups.members)
    return lines + ([f"{unknown} of {len(groups.members)} points: no droplet went half a diameter"] if unknown else [])


def draw_on(axes: Axes, groups: Groups) -> None:
    lengths.draw_curves(axes, groups, functools.partial(lengths.draw_speeds, column="lateral_slope"))
    style.finish(axes, AXES["slope"], groups.caption(), notes(groups, draw_rows(axes, groups)))
