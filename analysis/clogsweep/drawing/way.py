"""Draws the path of one droplet among obstacles, with several moments of the run in one picture."""

import math
from collections.abc import Iterable

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from .. import style
from ..labels import AXES
from ..reading import trajectory
from ..tools.hints import Numbers, Point
from . import surroundings


def view(run: trajectory.Trajectory) -> tuple[Numbers, Numbers]:
    """The bounding box of all outlines of the droplet, with a margin."""
    return run.polygons.min(axis=(0, 2)) - 0.5, run.polygons.max(axis=(0, 2)) + 0.5


LONGEST_STRIP = 30.0  # A longer path is drawn in several strips, one below the other [sigma].
MOST_STRIPS = 10  # If the path needs more strips than this, the strips become longer instead.


def draw(run: trajectory.Trajectory, num_outlines: int) -> Figure:
    """Draws a path. @param run  a run with outlines; @param num_outlines  number of outlines in each strip"""
    low, high = view(run)
    width, height = high - low
    if width > LONGEST_STRIP and len(run.wedges) != 2:
        return draw_strips(run, num_outlines)
    figure_width = min(12.0, max(5.0, 2.2 * width))
    figure, axes = style.subplots(figsize=(figure_width, max(3.0, figure_width * height / width + 1.2)))
    draw_on(axes, run, num_outlines)
    return figure


def draw_strips(run: trajectory.Trajectory, num_outlines: int) -> Figure:
    """Draws a long path in several strips. The path continues from the end of each strip in the strip below."""
    low, high = view(run)
    count = min(math.ceil((high[0] - low[0]) / LONGEST_STRIP), MOST_STRIPS)
    ends = np.linspace(low[0], high[0], count + 1)
    middles = run.polygons[:, 0].mean(axis=1)
    strips = []
    for begin, end in zip(ends, ends[1:]):
        inside = np.flatnonzero((middles >= begin - 0.5) & (middles <= end + 0.5))
        if inside.size:
            across = run.polygons[inside, 1]
            strips.append((begin, end, across.min() - 0.5, across.max() + 0.5, inside))
    width = 12.0
    heights = [(top - bottom) * width / (end - begin) for begin, end, bottom, top, _ in strips]
    figure, all_axes = style.subplots(len(strips), 1, figsize=(width, sum(heights) + 0.45 * len(strips) + 0.9),
                                      squeeze=False, gridspec_kw={"height_ratios": heights})
    for axes, (begin, end, bottom, top, inside) in zip(all_axes[:, 0], strips):
        surroundings.draw_surroundings(axes, run)
        surroundings.frame_limits(axes, (begin, bottom), (end, top))
        axes.set_ylabel(r"$y/\sigma$")
        draw_outlines(axes, run,
                      [inside[place] for place in trajectory.along_the_way(run.polygons[inside], num_outlines)])
    surroundings.draw_guides(all_axes[0, 0])
    all_axes[0, 0].set_title(f"{trajectory.described(run)}: {trajectory.verdict(run)}", fontsize=9)
    all_axes[-1, 0].set_xlabel(r"$x/\sigma$, along gravity; the path continues from strip to strip")
    figure.colorbar(time_scale(run), ax=list(all_axes[:, 0]), label=r"$t/t_0$", fraction=0.02, pad=0.01)
    return figure


def draw_on(axes: Axes, run: trajectory.Trajectory, num_outlines: int) -> None:
    is_passage = run.word("obstacle_filling") == "channel"
    origin = run.middle if is_passage else np.zeros(2)
    surroundings.draw_surroundings(axes, run, origin)
    low, high = view(run)
    surroundings.frame_limits(axes, low - origin, high - origin)
    axes.set_xlabel(AXES["h"] if is_passage else r"$x/\sigma$, along gravity")
    axes.set_ylabel(r"$y/\sigma$")
    surroundings.draw_guides(axes)
    axes.set_title(f"{trajectory.described(run)}: {trajectory.verdict(run)}", fontsize=9)
    draw_outlines(axes, run, trajectory.along_the_way(run.polygons, num_outlines), origin)
    # The colour bar is as high as the axes, which have a fixed shape. By default it would be as high as the figure.
    axes.figure.colorbar(time_scale(run), cax=axes.inset_axes((1.01, 0, 0.02, 1)), label=r"$t/t_0$")


def time_scale(run: trajectory.Trajectory) -> matplotlib.cm.ScalarMappable:
    """A scale of colours for the times until the droplet nearly rests."""
    last = trajectory.along_the_way(run.polygons, 20)[-2:][0]
    return matplotlib.cm.ScalarMappable(matplotlib.colors.Normalize(0, run.times[last]), cmap=style.SCALE)


def draw_outlines(axes: Axes, run: trajectory.Trajectory, frames: Iterable[int], origin: Point = (0.0, 0.0)) -> None:
    """Draws the outlines of these frames. The last outline of the run is filled."""
    colours = time_scale(run)
    for frame in frames:
        x, y = run.polygons[frame] - np.asarray(origin)[:, None]
        is_last = frame == len(run.polygons) - 1
        axes.fill(x, y, facecolor=surroundings.colour_of(run) if is_last else "none", alpha=0.75 if is_last else 1.0,
                  edgecolor="black" if is_last else colours.to_rgba(run.times[frame]), linewidth=1.0,
                  zorder=3 if is_last else 2)
