"""Draws a droplet among obstacles and walls, with guides for the eye."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PatchCollection
from matplotlib.patches import Circle, Polygon
from matplotlib.patheffects import withStroke
from matplotlib.text import Text
from mpl_toolkits.axes_grid1.anchored_artists import AnchoredSizeBar

from .. import style
from ..reading.trajectory import Trajectory, wedge_outline, with_middles
from ..tools.hints import Numbers, Point

HALO = withStroke(linewidth=3, foreground="white")  # white outline of guides, which may overlap obstacles


def draw_surroundings(axes: Axes, trajectory: Trajectory, origin: Point = (0.0, 0.0)) -> None:
    """Draws obstacles and walls in grey."""
    shift = np.asarray(origin)
    circles = [Circle((x - shift[0], y - shift[1]), diameter / 2) for x, y, diameter in trajectory.obstacles]
    axes.add_collection(PatchCollection(circles, facecolor=style.OBSTACLE, edgecolor="none"))
    draw_walls(axes, trajectory, shift)


def colour_of(trajectory: Trajectory) -> str:
    """The colour of the mechanism by which the droplet clogged, or style.DROPLET."""
    return style.MECHANISM_COLOURS.get(trajectory.word("mechanism"), style.DROPLET)


def draw_droplet(axes: Axes, trajectory: Trajectory, frame: int, origin: Point = (0.0, 0.0)) -> None:
    """Draws the droplet's outline in one frame as a smooth curve through the vertices, among the droplet's
    surroundings."""
    draw_surroundings(axes, trajectory, origin)
    outline = with_middles(with_middles(trajectory.polygons[frame]))
    axes.fill(*(outline - np.asarray(origin)[:, None]), facecolor=colour_of(trajectory), alpha=0.75, edgecolor="black",
              linewidth=1)


def draw_walls(axes: Axes, trajectory: Trajectory, shift: float | Numbers = 0.0) -> None:
    for wedge in trajectory.wedges:
        axes.add_patch(Polygon(wedge_outline(wedge) - shift, facecolor=style.OBSTACLE, edgecolor="none"))


def draw_guides(axes: Axes) -> None:
    """Draws a bar as long as a droplet is wide, and an arrow along gravity. Bar and arrow keep their corners of the
    axes when the view moves."""
    draw_bar(axes)
    arrow = axes.annotate("", (0.17, 0.95), (0.02, 0.95), xycoords="axes fraction", zorder=6,
                          arrowprops={"arrowstyle": "-|>", "linewidth": 1.5, "color": "black"})
    word = axes.text(0.03, 0.925, "gravity", transform=axes.transAxes, va="top", fontsize=9, zorder=6)
    for artist in (arrow.arrow_patch, word):
        artist.set_path_effects([HALO])


def draw_bar(axes: Axes, droplet: float = 1.0) -> None:
    """Draws a bar as long as a droplet is wide."""
    bar = AnchoredSizeBar(axes.transData, droplet, r"$\sigma$", "lower left", pad=0.2, borderpad=0.3, sep=2,
                          label_top=True, frameon=False)
    bar.set_zorder(6)
    axes.add_artist(bar)
    for artist in (bar.size_bar.get_children()[0], *bar.findobj(Text)):
        artist.set_path_effects([HALO])


def frame_limits(axes: Axes, low: Point, high: Point) -> None:
    axes.set_xlim(low[0], high[0])
    axes.set_ylim(low[1], high[1])
    axes.set_aspect("equal")
