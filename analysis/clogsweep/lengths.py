"""Clogging lengths and mean speeds over what a sweep varies, a curve for each obstacle array."""

from matplotlib.figure import Figure

from . import style
from .groups import Groups


def draw(groups: Groups) -> Figure:
    figure, axes = style.subplots(figsize=(6.4, 4.8))
    curves = groups.curves()
    for index, (label, members) in enumerate(curves):
        style.draw_lengths(axes, groups.places(members, index, len(curves)), members, index, label)
    groups.draw_abscissa(axes)
    style.finish_lengths(axes, groups, groups.members)
    return figure


def draw_speeds(groups: Groups) -> Figure:
    figure, axes = style.subplots(figsize=(6.4, 4.8))
    curves = groups.curves()
    for index, (label, members) in enumerate(curves):
        style.draw_speeds(axes, groups.places(members, index, len(curves)), members, index, label)
    groups.draw_abscissa(axes)
    axes.set_ylabel(style.AXES["speed"])
    style.grid(axes)
    style.legend(axes)
    style.caption(axes, f"{groups.caption()}\n{groups.note('bars: standard error')}")
    return figure
