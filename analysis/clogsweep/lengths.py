"""Clogging lengths and mean speeds over what a sweep varies, a curve for each obstacle array."""

from collections.abc import Callable

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from . import style
from .groups import Groups


def over_abscissa(groups: Groups, draw_curve: Callable[..., None]) -> tuple[Figure, Axes]:
    """@param draw_curve  of style: axes, places, groups of the curve, its index, its label"""
    figure, axes = style.subplots(figsize=(6.4, 4.8))
    curves = groups.curves()
    for index, (label, members) in enumerate(curves):
        draw_curve(axes, groups.places(members, index, len(curves)), members, index, label)
    groups.draw_abscissa(axes)
    return figure, axes


def draw(groups: Groups) -> Figure:
    figure, axes = over_abscissa(groups, style.draw_lengths)
    style.finish_lengths(axes, groups, groups.members)
    return figure


def draw_speeds(groups: Groups) -> Figure:
    figure, axes = over_abscissa(groups, style.draw_speeds)
    axes.set_ylabel(style.AXES["speed"])
    style.grid(axes)
    style.legend(axes)
    style.caption(axes, f"{groups.caption()}\n{groups.note('bars: standard error')}")
    return figure
