"""Near-wall drag from the speeds of a droplet that moves along a wall."""

import math
from typing import NamedTuple

import numpy as np

from ..tools.hints import Numbers


class NearWallDrag(NamedTuple):
    """v/(v_t - v) = (b_inf/b_0) (d/sigma)^alpha (Cheng et al., Appendix A); errors are NaN for two speeds."""

    exponent: float
    exponent_error: float
    drag: float
    drag_error: float


def fit(distances: Numbers, speeds: Numbers) -> NearWallDrag:
    """Straight line through log(v/(v_t - v)) against log d by least squares.

    @param distances  between wall and droplet surface [sigma]; @param speeds  far from walls 1 [v_t]
    @throws ValueError  for numbers that have no such logarithm, or fewer than two different distances
    """
    if not np.all(distances > 0):
        raise ValueError("a distance from the wall is not positive")
    if not np.all((speeds > 0) & (speeds < 1)):
        raise ValueError("a speed does not lie between 0 and v_t")
    if len(np.unique(distances)) < 2:
        raise ValueError("needs speeds at two different distances at least")
    x, y = np.log(distances), np.log(speeds / (1 - speeds))
    design = np.stack([x, np.ones(len(x))], axis=1)
    exponent, intercept = np.linalg.lstsq(design, y, rcond=None)[0]
    drag = math.exp(-intercept)
    if len(x) == 2:
        return NearWallDrag(float(exponent), math.nan, drag, math.nan)
    residuals = y - design @ (exponent, intercept)
    covariance = residuals @ residuals / (len(x) - 2) * np.linalg.inv(design.T @ design)
    return NearWallDrag(float(exponent), math.sqrt(covariance[0, 0]), drag, drag * math.sqrt(covariance[1, 1]))
