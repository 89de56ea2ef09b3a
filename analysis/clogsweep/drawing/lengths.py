"""Clogging lengths and mean speeds over what a sweep varies, a curve for each obstacle array."""

from collections.abc import Callable

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from .. import style
from ..labels.groups import Groups


def draw_curves(axes: Axes, groups: Groups, draw_curve: Callable[..., None]) -> None:
    """@param draw_curve  of style: axes, places, groups of the curve, its index, its label"""
    curves = groups.curves()
    for index, (label, members) in enumerate(curves):
        draw_curve(axes, groups.places(members, index, len(curves)), members, index, label)
    groups.draw_abscissa(axes)


def draw(groups: Groups) -> Figure:
    return style.figure_of(draw_on, groups)


def draw_on(axes: Axes, groups: Groups) -> None:
    draw_curves(axes, groups, style.draw_lengths)
    style.finish_lengths(axes, groups, groups.members)


def draw_speeds(groups: Groups) -> Figure:
    return style.figure_of(draw_speeds_on, groups)


def draw_speeds_on(axes: Axes, groups: Groups) -> None:
    draw_curves(axes, groups, style.draw_speeds)
    axes.set_ylabel(style.AXES["speed"])
    style.grid(axes)
    style.legend(axes)
    style.caption(axes, f"{groups.caption()}\n{groups.note('bars: standard error' if any(curve.lines[0].get_xdata().size for curve in axes.containers) else '')}")
