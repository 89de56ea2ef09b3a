"""The goals of a search: a quantity and its precision. Also computes the precision of a fitted curve."""

import math
from typing import NamedTuple

import numpy as np

from ..curves import features
from ..curves.model import Curve
from ..tools.errors import UserError
from ..tools.hints import Numbers
from ..tools.lists import number

CONFIDENCE = 0.95  # Confidence of all intervals.
EVEN_SHARE = 0.1  # This fraction of the weight is spread evenly over all places, so that each place gets some runs.
TRY = "try curve=20%, peak=10%, crossing=10:5% or, for a lattice, critical-angle=0.5"


class Goal(NamedTuple):
    """The goal. `kind` is curve, peak, crossing or critical-angle, or "" if only a budget ends the search."""

    kind: str
    # Relative precision of lambda, or of the key at a peak or crossing. For critical-angle it is the width of the
    # bracket [degrees].
    precision: float = 0.0
    length: float = 0.0  # Value of lambda for a crossing [sigma].

    def __str__(self) -> str:
        if self.kind == "critical-angle":
            return f"critical-angle={self.precision:g}"
        length = f"{self.length:g}:" if self.kind == "crossing" else ""
        return f"{self.kind}={length}{100 * self.precision:g}%"


def parse_goal(text: str) -> Goal:
    """Reads the goal of --until. @throws UserError"""
    kind, _, rest = text.partition("=")
    if kind not in ("curve", "peak", "crossing", "critical-angle"):
        raise UserError(f"invalid --until={text} (is not one of curve, peak, crossing, critical-angle) {TRY}")
    if kind == "critical-angle":
        if not 1e-3 <= number(rest) <= 20:
            raise UserError(f"invalid --until={text} (the width of the bracket must lie between 0.001 and 20 degrees) "
                            "try critical-angle=0.5")
        return Goal(kind, number(rest))
    length = 0.0
    if kind == "crossing":
        of_length, _, rest = rest.partition(":")
        length = number(of_length)
        if not 0 < length < math.inf:
            raise UserError(f"invalid --until={text} (a crossing has a length and a precision) {TRY}")
    precision = number(rest.removesuffix("%")) / (100 if rest.endswith("%") else 1)
    if not 0.001 <= precision < 1:
        raise UserError(f"invalid --until={text} (the precision must lie between 0.1% and 100%) {TRY}")
    return Goal(kind, precision, length)


def parse_budget(text: str) -> float:
    """Reads the core-hours of --budget. @throws UserError"""
    hours = number(text.removesuffix("h"))
    if not 0 < hours < math.inf:
        raise UserError(f"invalid --budget={text} (must be a number of core-hours above zero) try 10h")
    return hours


def half_width(lower: float, upper: float) -> float:
    """Half the width of a quantity's interval, divided by the quantity. @param lower, upper  ends of the interval of
    its logarithm"""
    return math.sinh(min(upper - lower, 200.0) / 2)  # prevents an overflow if the interval of a crossing is infinite


def known_precision(curve: Curve, places: Numbers, goal: Goal) -> float:
    """The precision that is reached for the quantity of the goal, or infinity if it is unknown. For a curve it is the
    root mean square of half the band's width."""
    if goal.kind == "curve":
        return math.sinh(features.normal_deviate(CONFIDENCE) * math.sqrt(float(np.mean(curve.deviation**2))))
    if goal.kind == "peak":
        peak = features.find_peak(curve, places, CONFIDENCE)
        return max(map(half_width, peak.place_lower, peak.place_upper))
    if goal.kind == "crossing":
        found = features.find_crossings(curve, places[:, 0], goal.length, CONFIDENCE)
        return max((half_width(one.lower, one.upper) for one in found), default=math.inf)
    return math.inf


def weights(curve: Curve, goal: Goal) -> Numbers:
    """The weight of each place of the curve for the goal."""
    even = np.full(curve.mean.size, 1 / curve.mean.size)
    special = even
    if goal.kind == "peak":
        special = features.peak_probabilities(curve)
    elif goal.kind == "crossing":
        deviation = np.maximum(curve.deviation, np.finfo(float).tiny)
        special = np.exp(-0.5 * ((curve.mean - math.log(goal.length)) / deviation) ** 2) / deviation
    total = special.sum()
    return EVEN_SHARE * even + (1 - EVEN_SHARE) * special / total if 0 < total < math.inf else even
