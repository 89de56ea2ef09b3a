"""Finds the density of the published arrays. The article states one clogging length as a number, but no density."""

import dataclasses
import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from .. import style
from ..drawing.lengths import draw_lengths, length_notes
from ..labels import AXES
from ..tools import rounded
from ..tools.hints import Group
from .arrays import numbers
from .captions import describe
from .plate import Plate, figure
from .runner import Runner

# The length and its error [sigma], at Gamma = 1.09 and a minimum gap of 0.2 sigma.
PUBLISHED_LENGTH, PUBLISHED_ERROR = 24.0, 1.0
NORMAL_QUANTILE = 1.96  # two-sided 95 %
CONFIGS = {"density-robust": "constant tension", "density-elastic": "tension grows with the perimeter",
           "density-friction": "likewise, wall friction 0.05"}


@dataclasses.dataclass(frozen=True)
class DensityFit:
    """A parabola through log lambda as a function of log density, and the density at which the parabola has the
    published length.

    The relative error of a length from n clogs is 1/sqrt(n). This is also the absolute error of log lambda.
    """

    coefficients: np.ndarray[Any, Any]  # highest power first
    covariance: np.ndarray[Any, Any]
    chi_squared: float
    degrees_of_freedom: int
    density: float  # [1/sigma^2].
    lower: float  # Lower end of the 95 % interval; the interval includes the error of the fit and the published error.
    upper: float

    def length(self, density: np.ndarray[Any, Any]) -> np.ndarray[Any, Any]:
        return np.exp(np.polyval(self.coefficients, np.log(density)))


def fit_density(densities: Sequence[float], lengths: Sequence[float], clogs: Sequence[int]) -> DensityFit:
    """Fits the parabola. @throws ValueError  if there are fewer than four densities, or if the published length is not
    between the shortest and the longest length"""
    x, y = np.log(densities), np.log(lengths)
    if len(x) < 4 or not min(lengths) < PUBLISHED_LENGTH < max(lengths):
        raise ValueError("needs four densities or more, on both sides of the published length")
    errors = 1 / np.sqrt(clogs)
    coefficients, covariance = np.polyfit(x, y, 2, w=1 / errors, cov="unscaled")
    residuals = (y - np.polyval(coefficients, x)) / errors
    target = math.log(PUBLISHED_LENGTH)
    roots = [root.real for root in np.roots(coefficients - [0, 0, target]) if abs(root.imag) < 1e-9]
    place = min(roots, key=lambda root: abs(root - float(np.mean(x))))
    slope = 2 * coefficients[0] * place + coefficients[1]
    powers = np.array([place**2, place, 1])
    error = math.sqrt(powers @ covariance @ powers + (PUBLISHED_ERROR / PUBLISHED_LENGTH) ** 2) / abs(slope)
    return DensityFit(coefficients, covariance, float(residuals @ residuals), len(x) - 3, math.exp(place),
                      math.exp(place - NORMAL_QUANTILE * error), math.exp(place + NORMAL_QUANTILE * error))


def fitted(groups: Sequence[Group]) -> DensityFit:
    closed = [group for group in groups if group["clogs"] > 0]
    return fit_density(*([group[name] for group in closed]
                         for name in ("obstacle_density", "clogging_length", "clogs")))


@figure("density",
        "clogging length of stiff droplets against the density of obstacles, and the density of the published arrays",
        CONFIGS, "5 min")
def density_of_the_published_arrays(runner: Runner) -> Plate:
    drawing, axes = style.subplots(figsize=(6.8, 5.0))
    families = {label: runner.sweep(config) for config, label in CONFIGS.items()}
    everyone = [group for groups in families.values() for group in groups]
    places = sorted({group["obstacle_density"] for group in everyone})
    data = []
    for index, (label, groups) in enumerate(families.items()):
        fit = fitted(groups)
        text = rounded.with_interval(fit.density, fit.lower, fit.upper)
        shift = style.side_by_side(index, len(families), places)
        draw_lengths(axes, [group["obstacle_density"] * shift for group in groups], groups, index, label,
                     linestyle="none")
        line = np.geomspace(places[0], places[-1], 100)
        axes.plot(line, fit.length(line), color=style.COLOURS[index], linewidth=1)
        share = [number / saturated_density(groups[0]) for number in (fit.density, fit.lower, fit.upper)]
        data += numbers(groups, label)
        data.append({"curve": label, "published_length": PUBLISHED_LENGTH, "density": fit.density,
                     "density_lower": fit.lower, "density_upper": fit.upper,
                     "share_of_saturated": share[0], "share_lower": share[1], "share_upper": share[2],
                     "chi_squared": fit.chi_squared, "degrees_of_freedom": fit.degrees_of_freedom})
        print(f"{label}: {text} per sigma^2, "
              f"{rounded.with_interval(*(100 * number for number in share))} % of the saturated density", flush=True)
    axes.axhspan(PUBLISHED_LENGTH - PUBLISHED_ERROR, PUBLISHED_LENGTH + PUBLISHED_ERROR,
                 color="0.85", zorder=0)
    style.logarithmic_ordinate(axes)
    style.logarithmic_abscissa(axes, places)
    style.grid(axes)
    axes.set_xlabel(r"obstacles per area $\rho_\mathrm{ob}\,\sigma^2$")
    axes.set_ylabel(AXES["length"])
    style.caption(axes, describe(runner.columns("density-robust"), everyone, ["obstacle_density"]))
    style.notes(axes, [rf"grey: the published length, ${PUBLISHED_LENGTH:g}\pm{PUBLISHED_ERROR:g}\,\sigma$; "
                       "lines: fitted parabolas",
                       *length_notes(everyone, runner.confidence("density-robust"), [axes])])
    style.legend(axes)
    return Plate(drawing, data)


def saturated_density(group: Group) -> float:
    """The density of equal circles at the jamming limit of random sequential addition [1/sigma^2]. The circles cover
    0.547069 of the plane (Feder 1980)."""
    return 0.547069 / (math.pi / 4 * (group["obstacle_diameter"] + group["obstacle_gap"]) ** 2)
