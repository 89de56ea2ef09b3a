"""Computes features of a fitted curve: its band, its peak, and the places where it crosses a given length."""

from __future__ import annotations

import dataclasses

import numpy as np
from scipy import linalg, special

from ..tools.hints import Numbers
from .model import Curve

NUM_DRAWS = 2000
# This multiple of the largest variance is added to the diagonal, so that rounding does not make the covariance
# indefinite.
FIRST_JITTER = 1e-10


@dataclasses.dataclass(frozen=True)
class Peak:
    """The peak of a curve. `place` and its interval are logarithms of the keys. Lengths are in units of sigma.

    `probability_inside` is the fraction of the curves drawn from the posterior that have their peak inside the range of
    places, not at one of its ends.
    """

    place: Numbers
    place_lower: Numbers
    place_upper: Numbers
    length: float
    length_lower: float
    length_upper: float
    probability_inside: float


@dataclasses.dataclass(frozen=True)
class Crossing:
    """The place at which a curve crosses a length, with its interval, as logarithms of the key. The interval ends where
    the band crosses the length. If an end would be outside the range of places, it is infinite."""

    place: float
    lower: float
    upper: float
    is_upward: bool


def normal_deviate(confidence: float) -> float:
    """The half-width of the interval that contains a normally distributed number with this confidence, in standard
    deviations.
    @throws ValueError  unless 0 < confidence < 1"""
    if not 0 < confidence < 1:
        raise ValueError("a confidence is between 0 and 1")
    return float(special.ndtri((1 + confidence) / 2))


def band(curve: Curve, confidence: float) -> Numbers:
    """The pointwise confidence band. @return three rows: lambda, the lower end and the upper end of its interval at
    every place [sigma]"""
    half = normal_deviate(confidence) * curve.deviation
    return np.exp([curve.mean, curve.mean - half, curve.mean + half])


def drawn_curves(curve: Curve, number: int = NUM_DRAWS, seed: int = 1) -> Numbers:
    """Draws curves of log lambda from the posterior, one per row. The same seed always gives the same curves. Curves of
    different seeds are independent."""
    variance = max(float(np.max(np.diagonal(curve.covariance))), float(np.finfo(float).tiny))
    jitter = FIRST_JITTER
    while True:
        try:
            factor = linalg.cholesky(curve.covariance + jitter * variance * np.eye(len(curve.mean)), lower=True)
            break
        except linalg.LinAlgError:
            jitter *= 10
            if jitter >= 1:
                raise
    # NumPy guarantees that RandomState gives the same numbers in every version.
    return curve.mean + np.random.RandomState(seed).standard_normal((number, len(curve.mean))) @ factor.T


def tops_of_lines(heights: Numbers, x: Numbers) -> tuple[Numbers, Numbers]:
    """The top of the parabola through the highest value of each row and its two neighbours. @return places, heights"""
    number = np.arange(len(heights))
    highest = np.argmax(heights, axis=1)
    middle = np.clip(highest, 1, len(x) - 2)
    left, right = x[middle - 1] - x[middle], x[middle + 1] - x[middle]
    height = heights[number, middle]
    slope_left = (heights[number, middle - 1] - height) / left
    slope_right = (heights[number, middle + 1] - height) / right
    curvature = (slope_right - slope_left) / (right - left)
    slope = slope_left - curvature * left
    is_parabola = (highest == middle) & (curvature < 0)
    shift = np.where(is_parabola, np.clip(-slope / (2 * np.where(is_parabola, curvature, -1)), left / 2, right / 2), 0)
    return x[highest] + shift, heights[number, highest] + slope * shift + curvature * shift**2


def tops(heights: Numbers, places: Numbers) -> tuple[Numbers, Numbers]:
    """The place and the height of each row's maximum. @param places  values of one key in increasing order, or a
    rectangular grid of two keys"""
    if places.shape[1] == 1 and len(places) > 2:
        x, height = tops_of_lines(heights, places[:, 0])
        return x[:, None], height
    highest = np.argmax(heights, axis=1)
    return places[highest], heights[np.arange(len(heights)), highest]


def find_peak(curve: Curve, places: Numbers, confidence: float) -> Peak:
    """The place and the height of the peak of the mean curve. The intervals of both come from curves drawn from the
    posterior. @param places  see tops()"""
    draws = drawn_curves(curve)
    draw_places, draw_heights = tops(draws, places)
    (place,), (height,) = tops(curve.mean[None], places)
    highest = places[np.argmax(draws, axis=1)]
    is_inside = ((highest > places.min(axis=0)) & (highest < places.max(axis=0))).all(axis=1)
    tails = [(1 - confidence) / 2, (1 + confidence) / 2]
    place_lower, place_upper = np.quantile(draw_places, tails, axis=0)
    length_lower, length_upper = np.exp(np.quantile(draw_heights, tails))
    return Peak(place, place_lower, place_upper, float(np.exp(height)), float(length_lower), float(length_upper), float(is_inside.mean()))


def peak_probabilities(curve: Curve) -> Numbers:
    """The probability that the peak is at each place."""
    return np.bincount(np.argmax(drawn_curves(curve), axis=1), minlength=len(curve.mean)) / NUM_DRAWS


def find_crossings(curve: Curve, x: Numbers, length: float, confidence: float) -> list[Crossing]:
    """The crossings of a length by a curve over one key. Between two neighbouring places the curve counts as a straight
    line.
    @param x  logarithms of the key, in increasing order; @param length  [sigma]"""
    above = curve.mean - np.log(length)
    half = normal_deviate(confidence) * curve.deviation

    def zero(values: Numbers, i: int) -> float:
        """The point at which the straight line between the places i and i + 1 crosses zero."""
        return float(x[i] + (x[i + 1] - x[i]) * values[i] / (values[i] - values[i + 1]))

    crossings = []
    for i in np.flatnonzero((above[:-1] < 0) != (above[1:] < 0)):
        is_upward = bool(above[i] < 0)
        before, after = (above + half, above - half) if is_upward else (above - half, above + half)
        # The places before the crossing at which the whole band is still below the length (or above it, if the curve
        # falls).
        outside_before = np.flatnonzero((before[:i + 1] < 0) == is_upward)
        outside_after = np.flatnonzero((after[i + 1:] >= 0) == is_upward) + i + 1
        crossings.append(Crossing(zero(above, i), zero(before, outside_before[-1]) if outside_before.size else -np.inf,
                                  zero(after, outside_after[0] - 1) if outside_after.size else np.inf, is_upward))
    return crossings
