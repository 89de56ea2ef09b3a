"""Draws the critical angles of lattices against the line tension, or against another parameter."""

import pandas
from matplotlib.axes import Axes

from .. import style
from ..labels import axis_label, parameter_label
from ..tools.errors import UserError
from ..tools.hints import Column

FOUND = ("lower", "upper", "runs")


def abscissa_of(table: pandas.DataFrame) -> str:
    """The parameter for the abscissa: the line tension if it varies, otherwise the number with the most values.
    @throws UserError  if no number varies"""
    numbers = [name for name in table.select_dtypes("number") if name not in FOUND]
    if not numbers:
        raise UserError("cannot draw critical angles (one set of parameters has one angle, and nothing varies); "
                        "vary line-tension")
    return max(numbers, key=lambda name: (name == "line_tension", table[name].nunique()))


def draw_on(axes: Axes, table: pandas.DataFrame, columns: dict[str, Column]) -> None:
    """Draws the critical angles.
    @param table  with the ends of the brackets, `lower` and `upper` [degrees], and the parameters that vary
    @param columns  from clogsweep --schema"""
    abscissa = abscissa_of(table)
    others = [name for name in table if name not in (abscissa, *FOUND)]
    curves = [points for _, points in table.groupby(others)] if others else [table]
    for index, points in enumerate(curves):
        points = points.sort_values(abscissa)
        label = ", ".join(parameter_label(columns[name], points[name].iloc[0]) for name in others)
        look = style.curve_style(index)
        places = points[abscissa] * style.side_by_side(index, len(curves), table[abscissa].tolist())
        middle = (points["lower"] + points["upper"]) / 2
        half = (points["upper"] - points["lower"]).fillna(0) / 2  # matplotlib refuses a list that contains only NaN.
        with style.curve(axes, label):
            axes.errorbar(places, middle, yerr=half, label=label or None, capsize=2, **look)
            for bound, marker in (("lower", "^"), ("upper", "v")):  # draws brackets of which only one end is known
                axes.plot(places[middle.isna()], points[bound][middle.isna()], marker, color=look["color"],
                          fillstyle="none")
    unknown = int(table[["lower", "upper"]].isna().all(axis=1).sum())
    style.logarithmic_abscissa(axes, table[abscissa].tolist())
    axes.set_xlabel(axis_label(columns[abscissa]))
    note = "droplets follow the rows at the lower end of a bar and leave them at the upper end" + ("; a triangle is a bound" if table[["lower", "upper"]].isna().any(axis=None) else "")
    style.finish(axes, "critical angle [degrees]", "",
                 [note] + [f"{unknown} of {len(table)} points: the paths are too short"] * (unknown > 0))
