"""Draws the largest line tension at which droplets break up on a single obstacle against the offset from the obstacle's
centre."""

import math

from matplotlib.figure import Figure

from .. import style
from ..collisions.collision import DIAMETER, Threshold
from ..labels import AXES

REACH = (1 + DIAMETER) / 2  # the largest offset with contact [sigma]


def draw(found: dict[float, Threshold], shared: str) -> Figure:
    """Draws the thresholds. @param found  thresholds by offset; @param shared  the common parameters of all droplets,
    for the caption"""
    figure, axes = style.subplots(figsize=(6.4, 4.8))
    known = {offset: math.sqrt(low * high) for offset, (low, high) in sorted(found.items()) if low and high}
    axes.plot(*zip(*known.items()), marker="o", color=style.COLOURS[0])
    axes.set_yscale("log")
    # This fixes the lower limit of the axis before the area below the curve is filled, which would lower the limit.
    axes.set_ylim(bottom=axes.get_ylim()[0])
    style.plain_logarithmic(axes.yaxis)
    axes.fill_between(list(known), list(known.values()), 1e-9, color=style.COLOURS[0], alpha=0.13, linewidth=0)
    for x, y, word in ((0.05, 0.1, "droplets break up"), (0.95, 0.9, "droplets stay whole")):
        axes.text(x, y, word, ha="left" if x < 0.5 else "right", color="0.25", transform=axes.transAxes)
    style.label(axes, r"offset of the path from the obstacle's centre $/\sigma$", AXES["line_tension"])
    axes.secondary_xaxis("top", functions=(lambda offset: offset / REACH, lambda part: part * REACH)).set_xlabel("fraction of collisions with a smaller offset")
    style.caption(axes, shared)
    return figure
