"""Clogging lengths and mean speeds over what a sweep varies, a curve for each obstacle array."""

from collections.abc import Callable, Sequence

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from .. import style
from ..labels import AXES
from ..labels.groups import Groups
from ..tools.hints import Group


def draw_curves(axes: Axes, groups: Groups, draw_curve: Callable[..., None]) -> None:
    """@param draw_curve  of style: axes, places, groups of the curve, its index, its label"""
    curves = groups.curves()
    for index, (label, members) in enumerate(curves):
        draw_curve(axes, places(groups, members, index, len(curves)), members, index, label)
    draw_abscissa(axes, groups)


def places(groups: Groups, members: Sequence[Group], index: int, num_curves: int) -> list[float]:
    """Where a curve's points are drawn: apart from those of the others, so that their bars can be told apart."""
    values = groups.values(groups.abscissa)
    if groups.is_logarithmic():
        return [group[groups.abscissa] * style.side_by_side(index, num_curves, values) for group in members]
    step = min(0.006, 0.06 / max(num_curves - 1, 1))
    shift = step * (max(values) - min(values)) * (index - (num_curves - 1) / 2)
    return [group[groups.abscissa] + shift for group in members]


def draw_abscissa(axes: Axes, groups: Groups) -> None:
    if groups.is_logarithmic():
        style.logarithmic_abscissa(axes, [group[groups.abscissa] for group in groups.members])
    axes.set_xlabel(groups.axis_label())


def draw(groups: Groups) -> Figure:
    return style.figure_of(draw_on, groups)


def draw_on(axes: Axes, groups: Groups) -> None:
    draw_curves(axes, groups, style.draw_lengths)
    style.finish_lengths(axes, groups, groups.members)


def draw_speeds(groups: Groups) -> Figure:
    return style.figure_of(draw_speeds_on, groups)


def draw_speeds_on(axes: Axes, groups: Groups) -> None:
    draw_curves(axes, groups, style.draw_speeds)
    axes.set_ylabel(AXES["speed"])
    style.grid(axes)
    style.legend(axes)
    style.caption(axes, f"{groups.caption()}\n{groups.note('bars: standard error' if any(curve.lines[0].get_xdata().size for curve in axes.containers) else '')}")
