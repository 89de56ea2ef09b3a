"""Fits log lambda as a Gaussian process over the logarithms of one or two keys.

Suppose that the runs at a place travelled the total distance S and clogged d times. Then d is a Poisson count with
exposure S. With f = log lambda the log likelihood is log L = -d f - S exp(-f), which is concave in f (Lawless,
Statistical Models and Methods for Lifetime Data, chapter 4). The kernel is a product of Matern kernels with smoothness
5/2, one for each key. Laplace's approximation gives the posterior (Rasmussen and Williams, Gaussian Processes for
Machine Learning, algorithms 3.1 and 3.2). The posterior is averaged over amplitudes and correlation lengths, with the
marginal likelihood as the weight.
"""

from __future__ import annotations

import dataclasses
import itertools
from collections.abc import Sequence

import numpy as np
from scipy import linalg

from ..tools.hints import Numbers

# Prior variance of the process's mean about the common log lambda of all points. The standard deviation corresponds to
# a factor of e^10 in lambda.
LEVEL_VARIANCE = 100.0
# This multiple of the kernel's variance is added to the diagonal, so that rounding does not make the matrix indefinite.
JITTER = 1e-8
# Standard deviations of log lambda, equivalent to factors of lambda from 1.3 to 3000.
AMPLITUDES = (0.25, 0.5, 1, 2, 4, 8)
RANGE_FRACTIONS = (0.1, 0.16, 0.25, 0.4, 0.63, 1, 1.6, 3)  # Correlation lengths, divided by the range of the places.
WEIGHT_USED = 0.98  # Scales are used in the order of their weights, up to this sum of weights.
MOST_STEPS = 200
MOST_HALVINGS = 40
SETTLED = 1e-10  # Newton's iteration ends when the log posterior gains less than this.


@dataclasses.dataclass(frozen=True)
class Hyperparameters:
    """The standard deviation of log lambda, and the correlation length of the logarithm of each key."""

    amplitude: float
    lengths: tuple[float, ...]


@dataclasses.dataclass(frozen=True)
class Points:
    """The data: sums over all runs at each place. Points without a clog give a lower bound, and the fit uses them, too.

    `places` has a row for each point and a column for each key, with the key's logarithm. `distances` are in units of
    sigma.
    @throws ValueError  if there is no point, or if a point has no finite place, fewer than 0 clogs, or a distance that
    is not positive and finite
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
        """Logarithm of the common clogging length of all points. Without any clog, half a clog is assumed."""
        return float(np.log(self.distances.sum() / max(self.clogs.sum(), 0.5)))


@dataclasses.dataclass(frozen=True)
class Curve:
    """The normal distribution of log lambda at some places.

    `log_evidence` is the logarithm of the marginal likelihood, without a constant that depends only on the points.
    """

    mean: Numbers
    covariance: Numbers
    log_evidence: float

    @property
    def deviation(self) -> Numbers:
        return np.sqrt(np.maximum(np.diagonal(self.covariance), 0))


@dataclasses.dataclass(frozen=True)
class Mode:
    """The maximum of the posterior for given scales, and its curvature there."""

    scales: Hyperparameters
    slopes: Numbers  # Gradient of the log likelihood at the mode, equal to K^-1 f.
    # Square roots of the expected numbers of clogs, W = S exp(-f). The curvature of the log likelihood is -W.
    roots: Numbers
    factor: Numbers  # Lower triangular factor of the matrix 1 + W^1/2 K W^1/2.
    log_evidence: float


def matern(distance: Numbers) -> Numbers:
    """The Matern correlation with smoothness 5/2. @param distance  in units of the correlation length"""
    x = np.sqrt(5) * np.abs(distance)
    return (1 + x + x * x / 3) * np.exp(-x)


def kernel(rows: Numbers, columns: Numbers, scales: Hyperparameters) -> Numbers:
    product = np.full((len(rows), len(columns)), float(scales.amplitude**2))
    for key, length in enumerate(scales.lengths):
        # Each key has few different values on a grid, so the correlation is computed only for these values.
        first, row = np.unique(rows[:, key], return_inverse=True)
        second, column = np.unique(columns[:, key], return_inverse=True)
        product *= matern((first[:, None] - second) / length)[np.ix_(row, column)]
    return product + LEVEL_VARIANCE


def find_mode(points: Points, scales: Hyperparameters) -> Mode:
    """Maximises the posterior, which is concave, by Newton's iteration. Steps that are too long are halved."""
    covariance = kernel(points.places, points.places, scales) + JITTER * scales.amplitude**2 * np.eye(len(points.places))
    exposures = points.distances * np.exp(-points.level)  # scaled such that log lambda is about zero

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
        if not gain >= SETTLED:  # also true if the gain is NaN
            break
    roots, factor = curvature(f)
    return Mode(scales, slopes, roots, factor, float(best - np.log(np.diagonal(factor)).sum()))


def curve_of_mode(points: Points, mode: Mode, places: Numbers) -> Curve:
    across = kernel(points.places, places, mode.scales)
    known = linalg.solve_triangular(mode.factor, mode.roots[:, None] * across, lower=True, check_finite=False)
    return Curve(across.T @ mode.slopes + points.level, kernel(places, places, mode.scales) - known.T @ known, mode.log_evidence)


def curve_of_scales(points: Points, scales: Hyperparameters, places: Numbers) -> Curve:
    """The curve for given scales. @param places  in the form of Points.places"""
    return curve_of_mode(points, find_mode(points, scales), places)


def all_scales(places: Numbers) -> list[Hyperparameters]:
    """All combinations of amplitudes and correlation lengths, both evenly spread on a logarithmic scale. The
    correlation length of a key with a single value is arbitrary."""
    ranges = np.ptp(places, axis=0)
    lengths = [[fraction * extent for fraction in RANGE_FRACTIONS] if extent > 0 else [1.0] for extent in ranges]
    return [Hyperparameters(amplitude, chosen) for amplitude in AMPLITUDES for chosen in itertools.product(*lengths)]


def fit_curve(points: Points, places: Numbers) -> Curve:
    """The curve at these places. The curve is averaged over the scales with the marginal likelihood as the weight.
    @param places  in the form of Points.places"""
    modes = [find_mode(points, scales) for scales in all_scales(np.concatenate([points.places, places]))]
    modes.sort(key=lambda mode: -mode.log_evidence)
    weights = np.exp([mode.log_evidence - modes[0].log_evidence for mode in modes])
    log_evidence = modes[0].log_evidence + float(np.log(weights.sum()))
    num_used = int(np.searchsorted(np.cumsum(weights / weights.sum()), WEIGHT_USED)) + 1
    return mixture([curve_of_mode(points, mode, places) for mode in modes[:num_used]], weights[:num_used], log_evidence)


def mixture(curves: Sequence[Curve], weights: Numbers, log_evidence: float) -> Curve:
    """The normal distribution that has the mean and the covariance of a weighted mixture."""
    weights = weights / weights.sum()
    mean = sum((weight * curve.mean for weight, curve in zip(weights, curves)), np.zeros_like(curves[0].mean))
    covariance = np.zeros_like(curves[0].covariance)
    for weight, curve in zip(weights, curves):
        covariance += weight * (curve.covariance + np.outer(curve.mean - mean, curve.mean - mean))
    return Curve(mean, covariance, log_evidence)
