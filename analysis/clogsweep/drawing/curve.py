"""Draws the curves of a sweep of droplets among obstacles."""

from matplotlib.axes import Axes

from ..labels.groups import Groups
from . import lengths, migration


def draw_on(axes: Axes, groups: Groups) -> None:
    """Draws lateral displacement for lattices, and clogging lengths otherwise."""
    (migration if groups.are_lattices else lengths).draw_on(axes, groups)


def heading(groups: Groups) -> str:
    return "lateral displacement per distance" if groups.are_lattices else "clogging length"
