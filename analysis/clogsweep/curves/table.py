"""The curves of a sweep as text for people, and as CSV."""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from ..tools import rounded
from ..tools.lists import numbers
from .answer import ALL, CAUSES
from .points import parameter_text, value_text

EVERY_ON_LINE = 8  # A curve of one key has 97 places, and every eighth is printed.
ON_SIDE = 25
EVERY_ON_SIDE = 6
ROUNDING = 1e-9  # Keys are exponentials of their logarithms.


def shortest(value: Any) -> str:
    """A number in its shortest exact form, or an empty text for None."""
    return "" if value is None else repr(value).removesuffix(".0") if isinstance(value, float) else str(value)


def with_interval(values: Mapping[str, Any], name: str) -> str:
    """A number with its interval, such as `0.51 (0.44 to 0.60)`. If an end of the interval is unknown, only the number
    is printed."""
    value, lower, upper = (values[f"{name}{end}"] for end in ("", "_lower", "_upper"))
    return f"{value:.3g}" if lower is None or upper is None else rounded.with_interval(value, lower, upper)


def unit_of(answer: dict[str, Any]) -> str:
    """The unit of lengths: sigma, or mm if the droplets have several sizes."""
    return str(answer["units"]["clogging_length"])


def text(answer: dict[str, Any], crossing: list[float]) -> str:
    """Prints the peak, the crossings and some places of every curve, and the points that belong to no curve."""
    keys = answer["keys"]
    lines = [f"lambda vs {' and '.join(keys)}, fitted; {100 * answer['confidence']:g} % intervals"]
    for curve in answer["curves"]:
        shared = " ".join(parameter_text(name, value) for name, value in curve["shared"].items())
        num_clogs = sum(point["clogs"] for point in curve["points"])
        lines += ["", f"{shared}{': ' if shared else ''}through {rounded.count_text(len(curve['points']), 'point')} with {rounded.count_text(num_clogs, 'clog')}"]
        if curve["common_obstacles"]:
            lines.append("  (points share seeds and so obstacles: their errors are correlated, the band takes them for independent)")
        num_runs = sum(point["runs"] for point in curve["points"])
        if num_failed := curve["failed"]:
            lines.append(f"  ({num_failed} of {rounded.count_text(num_runs, 'run')} failed, and count as not clogged up to sound_distance)")
        lines += [f"  ({number} of {rounded.count_text(len(curve['points']), 'point')}: {answer['doubts'][doubt]})" for doubt, number in curve["doubts"].items()]
        lines += [*_peak(answer, curve), *_crossings(answer, curve, crossing), "", *_places(answer, curve)]
    if answer["excluded"]:
        lines += ["", "in no curve:"]
        lines += [f"  {', '.join(f'{key} {value_text(one[key])}' for key in keys)}: {one['reason']}"
                  for one in answer["excluded"]]
    return "\n".join(lines) + "\n"


def _is_peak_known(answer: dict[str, Any], peak: dict[str, Any]) -> bool:
    """Whether the curve has its peak between the outermost values. Otherwise it may still rise beyond them."""
    return bool(peak["probability_between_borders"] >= answer["confidence"])


def _peak(answer: dict[str, Any], curve: dict[str, Any]) -> list[str]:
    peak = curve["peak"]
    at = ", ".join(f"{key} {with_interval(peak, key)}" for key in answer["keys"])
    highest = f"{at}, with lambda {with_interval(peak, ALL[0])} {unit_of(answer)}"
    if _is_peak_known(answer, peak):
        return [f"highest at {highest}"]
    borders = [f"the {word} {key}" for key in answer["keys"]
               for word, end in (("smallest", min), ("largest", max))
               if math.isclose(peak[key], end(place[key] for place in curve["curve"]), rel_tol=ROUNDING)]
    share = 100 * (1 - peak["probability_between_borders"])
    reason = f"with a probability of {share:.0f} % it is higher at a border than anywhere between; add points beyond"
    if borders:
        return [f"no peak is known: highest at {' and '.join(borders)} of these points, {highest}", f"  ({reason})"]
    return [f"highest at {highest}", f"  (no peak is known: {reason})"]


def _crossings(answer: dict[str, Any], curve: dict[str, Any], crossing: list[float]) -> list[str]:
    key = answer["keys"][0]
    lines = []
    for length in crossing:
        found = [one for one in curve["crossings"] if one["clogging_length"] == length]
        if not found:
            lines.append(f"does not cross {length:g} {unit_of(answer)} between these values")
        for one in found:
            beyond = ", or beyond the outermost values" if one[f"{key}_lower"] == 0 or one[f"{key}_upper"] is None else ""
            lines.append(f"crosses {length:g} {unit_of(answer)} {one['direction']} at {key} {with_interval(one, key)}{beyond}")
    return lines


def _places(answer: dict[str, Any], curve: dict[str, Any]) -> list[str]:
    keys = answer["keys"]
    if len(keys) == 1:
        shown = curve["curve"][::EVERY_ON_LINE]
    else:
        shown = [place for i, place in enumerate(curve["curve"]) if i % ON_SIDE % EVERY_ON_SIDE == 0 and i // ON_SIDE % EVERY_ON_SIDE == 0]
    widths = [max(len(key), 10) for key in keys]
    lines = ["  ".join([*(f"{key:>{width}}" for key, width in zip(keys, widths)), f"{f'lambda/{unit_of(answer)}':>12}", f"{'lower':>10}", f"{'upper':>10}"])]
    for place in shown:
        numbers = [*(f"{place[key]:>{width}.4g}" for key, width in zip(keys, widths)), *(f"{place[name]:>{w}.3g}" for name, w in zip(ALL, (12, 10, 10)))]
        lines.append("  ".join(numbers))
    return lines


def _comma_separated(rows: Iterable[Sequence[str]]) -> str:
    output = io.StringIO()
    csv.writer(output, lineterminator="\n").writerows(rows)
    return output.getvalue()


def comma_separated(answer: dict[str, Any]) -> str:
    """The curves as CSV, with a line for every place of every curve."""
    shared, names = list(answer["curves"][0]["shared"]), [*answer["keys"], *ALL, *(name for names in CAUSES.values() for name in names)]
    return _comma_separated([[*shared, *names], *([*(shortest(curve["shared"].get(name)) for name in shared), *(shortest(place.get(name)) for name in names)]
                                                  for curve in answer["curves"] for place in curve["curve"])])


def peaks(answer: dict[str, Any]) -> str:
    """The peaks as CSV, with a line for every curve. The peak is missing if the curve may be highest at an end of the
    range of values."""
    shared, names = list(answer["curves"][0]["shared"]), [f"{name}{end}" for name in [*answer["keys"], ALL[0]] for end in ("", "_lower", "_upper")]
    found = [(curve["shared"], curve["peak"]) for curve in answer["curves"]]
    lines = [[*shared, *names, "probability_between_borders"]]
    for values, peak in found:
        is_known = _is_peak_known(answer, peak)
        places = [f"{peak[name]:.3g}" if is_known else "none" for name in names]
        lines.append([*(shortest(values.get(name)) for name in shared), *places,
                      shortest(peak["probability_between_borders"])])
    return _comma_separated(lines)


def lengths(words: str) -> list[float]:
    """Reads a list such as `10,100` or `log(1,100,3)`. @throws ValueError  unless all are positive numbers"""
    found = numbers(words)
    if not all(0 < length < math.inf for length in found):
        raise ValueError("must be positive numbers")
    return found
