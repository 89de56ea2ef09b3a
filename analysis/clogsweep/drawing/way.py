"""The way of one droplet among obstacles: several moments of a run in one picture."""

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from .. import style
from ..labels import AXES
from ..reading import trajectory
from ..tools.hints import Numbers
from . import surroundings


def view(run: trajectory.Trajectory) -> tuple[Numbers, Numbers]:
    """Corners of what the droplet comes to."""
    return run.polygons.min(axis=(0, 2)) - 0.5, run.polygons.max(axis=(0, 2)) + 0.5


def draw(run: trajectory.Trajectory, num_outlines: int) -> Figure:
    """@param run  with outlines"""
    low, high = view(run)
    width, height = high - low
    figure_width = min(12.0, max(5.0, 2.2 * width))
    figure, axes = style.subplots(figsize=(figure_width, max(3.0, figure_width * height / width + 1.2)))
    draw_on(axes, run, num_outlines)
    return figure


def draw_on(axes: Axes, run: trajectory.Trajectory, num_outlines: int) -> None:
    is_passage = len(run.wedges) == 2
    origin = run.middle if is_passage else np.zeros(2)
    surroundings.draw_surroundings(axes, run, origin)
    low, high = view(run)
    surroundings.frame_limits(axes, low - origin, high - origin)
    axes.set_xlabel(AXES["h"] if is_passage else r"$x/\sigma$, along the flow")
    axes.set_ylabel(r"$y/\sigma$")
    surroundings.draw_guides(axes)
    axes.set_title(f"{trajectory.described(run)}: {trajectory.verdict(run)}", fontsize=9)
    chosen = trajectory.along_the_way(run.polygons, num_outlines)
    for frame in chosen:
        x, y = run.polygons[frame] - origin[:, None]
        share = run.times[frame] / run.times[-1] if run.times[-1] > 0 else 1.0
        is_last = frame == chosen[-1]
        axes.fill(
            x, y, facecolor=style.DROPLET if is_last else "none", alpha=0.75 if is_last else 1.0,
            edgecolor="black" if is_last else style.VIRIDIS(share), linewidth=1.0, zorder=3 if is_last else 2)
    scale = matplotlib.cm.ScalarMappable(matplotlib.colors.Normalize(0, run.times[-1]), cmap=style.VIRIDIS)
    # As high as the axes, whose shape is given: a colour bar of its own would be as high as the figure.
    axes.figure.colorbar(scale, cax=axes.inset_axes((1.01, 0, 0.02, 1)), label=r"$t/t_0$")
