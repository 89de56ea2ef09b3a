"""Draws a device with its posts, its edges and the direction of gravity, and shows how a drawing was interpreted."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PatchCollection
from matplotlib.figure import Figure
from matplotlib.patches import Circle, Polygon, Rectangle
from matplotlib.transforms import ScaledTranslation

from .. import style
from ..device.shapes import Device
from ..tools import rounded
from ..tools.hints import Numbers
from ..tools.texts import literal
from . import surroundings

WIDEST, NARROWEST = 14.0, 5.0  # Limits of a figure's width [inches].
TALLEST = 11.0  # Largest height of all panels together [inches].
RED = "#D00000"


def axes_for(length: float, width: float, panels: int = 1, strip: float = 0.0,
             beside: float = 0.0) -> tuple[Figure, list[Axes]]:
    """A figure and its axes. The scales along and across a device of this size are equal. Panels are in one column, or
    in several columns if one would be too tall.
    @param strip  height of an additional panel below the devices [inches]
    @param beside  width for what is drawn beside the devices [inches]"""
    figure_width = min(WIDEST, max(NARROWEST, 0.45 * length))
    shapes = [(columns, -(-panels // columns)) for columns in range(1, panels + 1)]
    columns, rows = next((shape for shape in shapes
                          if figure_width / shape[0] * shape[1] * width / length <= TALLEST), shapes[-1])
    height = min(TALLEST / rows, max(2.2, figure_width / columns * width / length))
    heights = [height] * rows + ([strip] if strip else [])
    figure = style.new_figure(figsize=(figure_width + beside, sum(heights) + 1.3 + 0.45 * (rows - 1)),
                              layout="constrained")
    grid = figure.add_gridspec(len(heights), columns, height_ratios=heights)
    axes = [figure.add_subplot(grid[number // columns, number % columns]) for number in range(panels)]
    axes += [figure.add_subplot(grid[-1, :])] if strip else []
    for one in axes[1:]:
        one.sharex(axes[0])
    for one in axes:
        one.label_outer()
    for one in axes[panels - columns:panels] if columns > 1 else []:
        one.tick_params(labelbottom=True)
    return figure, axes


def draw_posts(axes: Axes, circles: Numbers, colour: str = style.OBSTACLE) -> None:
    """Draws posts as filled circles. @param circles  (n, 3): x, y, diameter"""
    rings = [Polygon(ring) for ring in rings_among(circles)]
    axes.add_collection(PatchCollection([*(Circle((x, y), diameter / 2) for x, y, diameter in circles), *rings],
                                        facecolor=colour, edgecolor="none"))


def rings_among(circles: Numbers) -> list[Numbers]:
    """Closed chains of overlapping circles, as centres (n, 2). The inside of such a chain is drawn filled, because no
    droplet can enter it."""
    def overlap(i: int, j: int) -> bool:
        return bool(np.hypot(*(circles[i, :2] - circles[j, :2])) < max(circles[i, 2], circles[j, 2]) / 2)

    breaks = [i for i in range(1, len(circles)) if not overlap(i - 1, i)]
    found = []
    for begin, end in zip([0, *breaks], [*breaks, len(circles)]):
        # The row of circles along a post may be followed by circles that fill the inside of the post.
        last = next((j for j in range(end - 1, begin + 2, -1) if overlap(j, begin)), None)
        if last is not None:
            found.append(circles[begin:last + 1, :2])
    return found


def frame(axes: Axes, length: float, width: float, line: str, beside: Sequence[Numbers] = (),
          droplet: float = 1.0) -> None:
    """Draws the edge of the device and its surroundings. @param beside  lines to include in the picture, unless they
    are farther away than the size of the device
    @param droplet  diameter of the droplet, in the unit of the axes"""
    axes.add_patch(Rectangle((0, 0), length, width, fill=False, edgecolor="0.3", linestyle=line))
    size = np.array([length, width])
    points = np.clip(np.vstack([np.zeros(2), size, *beside]), -size, 2 * size)
    margin = 0.02 * max(length, width) + 0.5 * droplet
    surroundings.frame_limits(axes, tuple(points.min(axis=0) - margin), tuple(points.max(axis=0) + margin))
    surroundings.draw_bar(axes, droplet)
    axes.set_ylabel(r"$y/\sigma$")


def draw_gravity(axes: Axes, points_below: float) -> None:
    """Draws an arrow along gravity, where there are no posts: below the right end of the axes, at a distance of
    `points_below` points."""
    place = axes.transAxes + ScaledTranslation(0, -points_below / 72, axes.figure.dpi_scale_trans)
    start = axes.transAxes + ScaledTranslation(-0.6, -points_below / 72, axes.figure.dpi_scale_trans)
    axes.annotate("gravity", (1, 0), (1, 0), xycoords=place, textcoords=start, va="center", ha="right", fontsize=9,
                  annotation_clip=False,
                  arrowprops={"arrowstyle": "-|>", "linewidth": 1.5, "color": "black", "shrinkB": 0})


def understood(device: Device, source: str) -> Figure:
    """Draws how a drawing was interpreted. Posts are grey, other shapes are red, and the edge is dashed. @param source
    name of the drawing"""
    figure, (axes,) = axes_for(device.length, device.width)
    draw_posts(axes, device.circles)
    for outline in device.others:
        axes.add_patch(Polygon(outline, facecolor=RED, edgecolor="black", linewidth=0.5))
    for outline in device.replaced:
        axes.add_patch(Polygon(outline, fill=False, edgecolor=RED, linewidth=0.5))
    for outline in device.walls:
        axes.add_patch(Polygon(outline, closed=False, facecolor=style.OBSTACLE, edgecolor=style.OBSTACLE))
    for _, line in device.lines:
        axes.plot(*line.T, color=RED, linewidth=1.0)
    for pair in device.overlaps():
        draw_posts(axes, device.circles[list(pair)], RED)
    frame(axes, device.length, device.width, "--" if device.has_frame else ":",
          [*device.walls, *(line for _, line in device.lines)])
    draw_gravity(axes, 26)
    axes.set_xlabel(r"$x/\sigma$, along gravity")
    micrometres = device.droplet_micrometres
    red = f", {len(device.others)} not round (red)" if device.others else ""
    style.caption(axes, rf"{literal(source)}: {rounded.count_text(device.num_posts(), 'post')}{red}, "
                        rf"$\sigma$ = {micrometres:.4g} µm, "
                        rf"device {device.length * micrometres:.5g} µm x {device.width * micrometres:.5g} µm")
    return figure
