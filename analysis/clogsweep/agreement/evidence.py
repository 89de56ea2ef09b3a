"""Decides which differences are clear, and formats numbers for the table.

Lengths differ *clearly* if their confidence intervals do not overlap, speeds if they differ by more than two standard
errors of the difference. A curve counts as a straight line if a linear fit has an R^2 of LEAST_LINEARITY or more.
"""

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any

from ..paper.arrays import STEADY
from ..tools import rounded
from ..tools.hints import Group
from .verdicts import AGREES, DOES_NOT, IN_KIND, NOT_KNOWN, Finding

LEAST_LINEARITY = 0.99


def bounds(group: Group) -> tuple[float, float]:
    """The confidence interval of a clogging length. The upper end is infinite if no run clogged."""
    upper = group["clogging_length_upper"]
    return group["clogging_length_lower"], math.inf if upper is None else upper


def shorter(first: Group, second: Group) -> bool:
    """Whether the first clogging length is clearly shorter than the second."""
    return bounds(first)[1] < bounds(second)[0]


def slower(first: Group, second: Group) -> bool:
    """Whether the first mean speed is clearly lower than the second."""
    error = math.hypot(first[f"{STEADY}_error"] or 0.0, second[f"{STEADY}_error"] or 0.0)
    return second[STEADY] - first[STEADY] > 2 * error


def length_of(group: Group) -> str:
    if group["clogs"] == 0:
        return f"> {rounded.plain(group['clogging_length_lower'])}"
    return rounded.with_interval(*(group[name] for name in (
        "clogging_length", "clogging_length_lower", "clogging_length_upper")))


def speed_of(group: Group) -> str:
    return rounded.with_error(group[STEADY], group[f"{STEADY}_error"])


def curves(groups: Iterable[Group], parameter: str) -> dict[Any, list[Group]]:
    """One curve for each value of the parameter, in ascending order of the values."""
    found: dict[Any, list[Group]] = {}
    for group in groups:
        found.setdefault(group[parameter], []).append(group)
    return dict(sorted(found.items()))


def rises(curve: Sequence[Group], is_less: Callable[[Group, Group], bool]) -> bool:
    """Whether any point of the curve is clearly below a later point."""
    return any(is_less(curve[i], curve[j]) for i in range(len(curve)) for j in range(i + 1, len(curve)))


def falls(curve: Sequence[Group], is_less: Callable[[Group, Group], bool]) -> bool:
    return rises(curve[::-1], is_less)


def trend(is_as_published: bool, is_opposite: bool) -> str:
    """The verdict on a curve, or on two points. Some points of a curve may clearly differ as published, and others in
    the opposite way: the verdict is then IN_KIND. Without a clear difference the verdict is NOT_KNOWN."""
    return (IN_KIND if is_opposite else AGREES) if is_as_published else DOES_NOT if is_opposite else NOT_KNOWN


def fall_with_stiffness(found: Mapping[float, Sequence[Group]], is_less: Callable[[Group, Group], bool],
                        value_of: Callable[[Group], str]) -> Finding:
    """Judges whether the clogging length of soft disks falls with the wall stiffness E_w. There is one curve for each
    gap."""
    ordered = {gap: sorted(curve, key=lambda group: group["wall_stiffness"]) for gap, curve in found.items()}
    words = {gap: [f"{value_of(end)} at {end['wall_stiffness']:g}" for end in (curve[0], curve[-1])]
             for gap, curve in ordered.items()}
    return Finding(overall([trend(falls(curve, is_less), rises(curve, is_less)) for curve in ordered.values()]),
                   "; ".join(f"gap {gap:g}: {', '.join(ends)}" for gap, ends in words.items()))


def overall(verdicts: Sequence[str]) -> str:
    """One verdict for several curves: their common verdict, if they have one. For curves with different verdicts the
    result is NOT_KNOWN if more than half of the curves are NOT_KNOWN, DOES_NOT if all others are DOES_NOT, and IN_KIND
    in all other cases."""
    if len(set(verdicts)) == 1:
        return verdicts[0]
    if not verdicts or 2 * list(verdicts).count(NOT_KNOWN) > len(verdicts):
        return NOT_KNOWN
    return DOES_NOT if set(verdicts) == {DOES_NOT, NOT_KNOWN} else IN_KIND


def by_tolerance(value: float, published: float, tolerance: float) -> str:
    """The verdict on a value: `agrees` if it differs from the published value by at most the tolerance, `qualitatively`
    up to four times the tolerance."""
    difference = abs(value - published)
    return AGREES if difference <= tolerance else IN_KIND if difference <= 4 * tolerance else DOES_NOT
