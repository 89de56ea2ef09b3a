"""Draws the ratios of the clogging lengths of several sweeps."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from matplotlib.axes import Axes

from .. import style
from ..labels import AXES, axis_label, is_number, parameter_label
from ..reading import fits
from ..tools.errors import UserError
from ..tools.hints import Group
from ..tools.rounded import count_text
from ..tools.texts import literal
from . import lengths

Comparison = dict[str, Any]
PAIRED, UNPAIRED = "solid", "dashed"  # lines of bars
DROPLETS = {column["key"]: column for column in fits.droplet_columns().values()}


def abscissa_of(answer: dict[str, Any]) -> str:
    """The parameter for the abscissa: the number with the most values. If several numbers have equally many values, the
    line tension is preferred. Empty if nothing varies."""
    comparisons = answer["comparisons"]
    numbers = [name for name in answer["columns"] if all(is_number(str(one[name])) for one in comparisons)]
    return max(numbers, key=lambda name: (len({one[name] for one in comparisons}), name == "line_tension"), default="")


def curves_of(answer: dict[str, Any], abscissa: str) -> list[tuple[str, list[Comparison]]]:
    """For every curve, a label and its comparisons. The comparisons of a curve differ only in the abscissa."""
    others = [name for name in answer["columns"] if name != abscissa]
    curves: dict[tuple[Any, ...], list[Comparison]] = {}
    for one in answer["comparisons"]:
        curves.setdefault((one["here"], *(one[name] for name in others)), []).append(one)
    distinguished = {key[0] for key in curves}
    labels = [", ".join([*([side(answer, key[0])] if len(distinguished) > 1 or not others else []),
                         *(value_label(name, value) for name, value in zip(others, key[1:]))])
              for key in curves]
    return list(zip(labels, curves.values()))


def value_label(name: str, value: float | str) -> str:
    if name in DROPLETS:
        return parameter_label(DROPLETS[name], value)
    return f"{name.replace('_', ' ')} {value:g}" if isinstance(value, int | float) else literal(value)


def side(answer: dict[str, Any], name: str) -> str:
    """One side of a comparison in words: a file, or a key and its value."""
    key, _, value = name.partition("=")
    return f"{key.replace('_', ' ')} {literal(value)}" if key in answer["differing"] else literal(name)


def flaws_of(one: Comparison) -> Group:
    """The doubts and failures of both sides, combined into those of one group."""
    sides = ("here", "there")
    doubts = dict.fromkeys(word for side in sides for word in (one[f"doubts_{side}"] or "").split())
    return {"doubts": " ".join(doubts), "clogs": min(one[f"clogs_{side}"] for side in sides),
            "failed": sum(one[f"failed_{side}"] for side in sides)}


def draw_curve(axes: Axes, places: Sequence[float], curve: Sequence[Comparison], index: int, label: str) -> None:
    order = sorted(range(len(curve)), key=lambda i: places[i])
    known = [(places[i], curve[i]) for i in order if curve[i]["ratio_lower"] is not None]
    looks = style.curve_style(index)
    drawn = axes.errorbar([x for x, _ in known], [one["ratio"] for _, one in known],
                          yerr=[[abs(one["ratio"] - one[end]) for _, one in known]
                                for end in ("ratio_lower", "ratio_upper")], color=looks["color"],
                          linestyle=looks["linestyle"], linewidth=1, elinewidth=1, capsize=2.5,
                          label=label if known else "_")
    for bars in drawn.lines[2]:
        bars.set_linestyle([PAIRED if one["interval"] == "paired" else UNPAIRED for _, one in known])
    for x, one in known:
        face = "white" if lengths.reasons_for_hollow_marker(flaws_of(one)) else "auto"
        axes.plot(x, one["ratio"], color=looks["color"], marker=looks["marker"],
                  markerfacecolor=face, markersize=5.5, zorder=3)


def note_lines(answer: dict[str, Any]) -> list[str]:
    kinds = {one["interval"] for one in answer["comparisons"] if one["ratio_lower"] is not None}
    lines = [f"bars: {100 * answer['confidence']:g} % confidence intervals"]
    meanings = {"paired": "solid bars: from pairs of the same seed",
                "unpaired": "dashed bars: from numbers of clogs alone"}
    lines += ["; ".join(meaning for kind, meaning in meanings.items() if kind in kinds)]
    unknown = sum(one["ratio_lower"] is None for one in answer["comparisons"])
    identical = sum(one["interval"] == "identical" for one in answer["comparisons"])
    if unknown > identical:
        lines.append(f"{count_text(unknown - identical, 'point')} without clogs on one side: no ratio")
    if identical:
        lines.append(f"{count_text(identical, 'point')} with identical runs on both sides: no interval")
    return lines + lengths.flaw_notes([flaws_of(one) for one in answer["comparisons"]])


def draw_on(axes: Axes, answer: dict[str, Any]) -> None:
    """Draws the ratios. @param answer  the JSON output of clogfit compare. @throws UserError  if there is no ratio"""
    comparisons = answer["comparisons"]
    if all(one["ratio_lower"] is None for one in comparisons):
        raise UserError("no ratio to draw: in every comparison one side has no clogs, "
                        "or both sides have identical runs")
    abscissa = abscissa_of(answer)
    curves = curves_of(answer, abscissa)
    values = [one[abscissa] for one in comparisons] if abscissa else []
    is_logarithmic = bool(values) and min(values) > 0
    for index, (label, curve) in enumerate(curves):
        if not abscissa:
            places = [float(index)]
        elif is_logarithmic:
            places = [one[abscissa] * style.side_by_side(index, len(curves), values) for one in curve]
        else:
            places = [one[abscissa] for one in curve]
        with style.curve(axes, label):
            draw_curve(axes, places, curve, index, label)
    axes.axhline(1, color="0.4", linewidth=0.8, linestyle="--", zorder=1)
    style.logarithmic_ordinate(axes)
    if is_logarithmic:
        style.logarithmic_abscissa(axes, values)
    if abscissa:
        axes.set_xlabel(axis_label(DROPLETS[abscissa]) if abscissa in DROPLETS else AXES.get(abscissa, abscissa.replace("_", " ")))
    else:
        axes.set_xticks([])
    reference = side(answer, comparisons[0]["there"])
    names = {side(answer, one["here"]) for one in comparisons}
    of_one = f" of {names.pop()}" if len(names) == 1 else ""
    axes.set_ylabel(rf"$\lambda${of_one} / $\lambda$ of {reference}")
    style.grid(axes)
    if len(curves) > 1 or not abscissa:
        style.legend(axes)
    if answer["differing"]:
        style.caption(axes, "they differ in " + ", ".join(name.replace("_", " ") for name in answer["differing"]))
    style.notes(axes, note_lines(answer))
