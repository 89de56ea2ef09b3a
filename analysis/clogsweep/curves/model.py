"""log lambda as a Gaussian process over the logarithms of one or two keys.

If runs together travelled the distance S and clogged d times, d is a Poisson count with exposure S. With f = log
lambda, log L = -d f - S exp(-f), which is concave in f (Lawless, Statistical Models and Methods for Lifetime Data,
chapter 4). The kernel is a product of Matern's with smoothness 5/2, one for each key. The posterior is Laplace's
approximation (Rasmussen and Williams, Gaussian Processes for Machine Learning, algorithms 3.1 and 3.2), averaged over
amplitudes and correlation lengths by the marginal likelihood.
"""

from __future__ import annotations

import dataclasses
import itertools
from collections.abc import Sequence

import numpy as np
from scipy import linalg

from ..tools.hints import Numbers

LEVEL_VARIANCE = 100.0  # prior variance of the process's mean about the common log lambda of all points: a standard deviation of a factor e^10
JITTER = 1e-8  # times the kernel's variance: added to the diagonal, so that rounding leaves the matrix positive definite
AMPLITUDES = (0.25, 0.5, 1, 2, 4, 8)  # standard deviations of log lambda; as factors of lambda 1.3 to 3000
RANGE_FRACTIONS = (0.1, 0.16, 0.25, 0.4, 0.63, 1, 1.6, 3)  # correlation lengths, divided by the range of the places
WEIGHT_USED = 0.98  # the most likely scales are used until their weights sum to this; the others change nothing
MOST_STEPS = 200
MOST_HALVINGS = 40
SETTLED = 1e-10  # gain of log posterior below which Newton's iteration ends


@dataclasses.dataclass(frozen=True)
class Scales:
    """Standard deviation of log lambda, and the correlation length of each key's logarithm."""

    amplitude: float
    lengths: tuple[float, ...]


@dataclasses.dataclass(frozen=True)
class Points:
    """Data: sums over all runs at each place. Points without a clog are lower bounds, which the fit uses, too.

    `places` has a row for each point and a column for each key, its logarithm; `distances` [sigma].
    @throws ValueError  unless there is a point, and each has a finite place, clogs >= 0 and a positive, finite distance
    """

    places: Numbers
    clogs: Numbers
    distances: Numbers

    def __post_init__(self) -> None:
        if not len(self.places):
            raise ValueError("a curve needs a point")
        are_valid = np.isfinite(self.places).all() and np.isfinite(self.distances).all() and (self.distances > 0).all() and (self.clogs >= 0).all()
        if not are_valid:
            raise ValueError("a point of a curve needs a finite place and a positive, finite distance")

    @property
    def level(self) -> float:
        """Logarithm of the common clogging length of all points. If there is no clog, half a clog is assumed."""
        return float(np.log(self.distances.sum() / max(self.clogs.sum(), 0.5)))


@dataclasses.dataclass(frozen=True)
class Curve:
    """Normal distribution of log lambda at some places.

    `log_evidence` is the logarithm of the marginal likelihood, up to a constant that depends on the points alone.
    """

    mean: Numbers
    covariance: Numbers
    log_evidence: float

    @property
    def deviation(self) -> Numbers:
        return np.sqrt(np.maximum(np.diagonal(self.covariance), 0))


@dataclasses.dataclass(frozen=True)
class Mode:
    """The maximum of the posterior for known scales, and its curvature there."""

    scales: Scales
    slopes: Numbers  # gradient of the log likelihood at the mode, which equals K^-1 f
    roots: Numbers  # square roots of the expected clogs W = S exp(-f), which are the curvature of the log likelihood
    factor: Numbers  # lower triangular factor of 1 + W^1/2 K W^1/2
    log_evidence: float


def matern(distance: Numbers) -> Numbers:
    """Matern's correlation with smoothness 5/2. @param distance  in units of the correlation length"""
    x = np.sqrt(5) * np.abs(distance)
    return (1 + x + x * x / 3) * np.exp(-x)


def kernel(rows: Numbers, columns: Numbers, scales: Scales) -> Numbers:
    product = np.full((len(rows), len(columns)), float(scales.amplitude**2))
    for key, length in enumerate(scales.lengths):
        # On a grid each key has few different values, so the correlation is computed for these only.
        first, row = np.unique(rows[:, key], return_inverse=True)
        second, column = np.unique(columns[:, key], return_inverse=True)
        product *= matern((first[:, None] - second) / length)[np.ix_(row, column)]
    return product + LEVEL_VARIANCE


def find_mode(points: Points, scales: Scales) -> Mode:
    """Newton's iteration for a concave function, with steps halved where they are too long."""
    covariance = kernel(points.places, points.places, scales) + JITTER * scales.amplitude**2 * np.eye(len(points.places))
    exposures = points.distances * np.exp(-points.level)  # in units in which log lambda is about zero

    def height(slopes: Numbers, f: Numbers) -> float:
        with np.errstate(over="ignore"):  # a step that is far too long gives -inf
            return float(np.sum(-points.clogs * f - exposures * np.exp(-f)) - slopes @ f / 2)

    def curvature(f: Numbers) -> tuple[Numbers, Numbers]:
        roots = np.sqrt(exposures * np.exp(-f))
        return roots, linalg.cholesky(np.eye(len(f)) + roots[:, None] * covariance * roots, lower=True, check_finite=False)

    slopes = f = np.zeros(len(exposures))
    best = height(slopes, f)
    for _ in range(MOST_STEPS):
        roots, factor = curvature(f)
        target = roots**2 * (f + 1) - points.clogs
        solved = linalg.cho_solve((factor, True), roots * (covariance @ target), check_finite=False)
        step = target - roots * solved - slopes
        for halving in range(MOST_HALVINGS):
            tried = slopes + step / 2**halving
            reached = height(tried, covariance @ tried)
            if reached >= best:
                slopes, f = tried, covariance @ tried
                break
        gain, best = reached - best, max(best, reached)
        if not gain >= SETTLED:  # NaN, too
            break
    roots, factor = curvature(f)
    return Mode(scales, slopes, roots, factor, float(best - np.log(np.diagonal(factor)).sum()))


def curve_of_mode(points: Points, mode: Mode, places: Numbers) -> Curve:
    across = kernel(points.places, places, mode.scales)
    known = linalg.solve_triangular(mode.factor, mode.roots[:, None] * across, lower=True, check_finite=False)
    return Curve(across.T @ mode.slopes + points.level, kernel(places, places, mode.scales) - known.T @ known, mode.log_evidence)


def curve_of_scales(points: Points, scales: Scales, places: Numbers) -> Curve:
    """The curve for known scales. @param places  in the form of Points.places"""
    return curve_of_mode(points, find_mode(points, scales), places)


def all_scales(places: Numbers) -> list[Scales]:
    """All combinations of amplitudes and correlation lengths, which are spread evenly on a logarithmic scale. A key
    with one value has no correlation length."""
    ranges = np.ptp(places, axis=0)
    lengths = [[fraction * extent for fraction in RANGE_FRACTIONS] if extent > 0 else [1.0] for extent in ranges]
    return [Scales(amplitude, chosen) for amplitude in AMPLITUDES for chosen in itertools.product(*lengths)]


def fit_curve(points: Points, places: Numbers) -> Curve:
    """The curve at these places, averaged over the scales by their marginal likelihood. @param places  in the form of
    Points.places"""
    modes = [find_mode(points, scales) for scales in all_scales(np.concatenate([points.places, places]))]
    modes.sort(key=lambda mode: -mode.log_evidence)
    weights = np.exp([mode.log_evidence - modes[0].log_evidence for mode in modes])
    log_evidence = modes[0].log_evidence + float(np.log(weights.sum()))
    num_used = int(np.searchsorted(np.cumsum(weights / weights.sum()), WEIGHT_USED)) + 1
    return mixture([curve_of_mode(points, mode, places) for mode in modes[:num_used]], weights[:num_used], log_evidence)


def mixture(curves: Sequence[Curve], weights: Numbers, log_evidence: float) -> Curve:
    """The normal distribution with the mean and the covariance of a weighted mixture."""
    weights = weights / weights.sum()
    mean = sum((weight * curve.mean for weight, curve in zip(weights, curves)), np.zeros_like(curves[0].mean))
    covariance = np.zeros_like(curves[0].covariance)
    for weight, curve in zip(weights, curves):
        covariance += weight * (curve.covariance + np.outer(curve.mean - mean, curve.mean - mean))
    return Curve(mean, covariance, log_evidence)
