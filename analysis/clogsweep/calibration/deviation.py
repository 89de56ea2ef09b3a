"""Deviation of a simulated passage from a measured one (Cheng et al., Delta_v and Delta_A)."""

import math

import numpy as np

from ..tools.hints import Numbers
from .profiles import Profile, at

# Relative deviation of a frame that the simulated droplet never reached, and the largest deviation of any other frame.
NEVER_REACHED = 10
# Fewer successive residuals do not determine their correlation.
FEWEST_CORRELATED = 8


def speed_residuals(measured: Profile, simulated: Profile) -> tuple[Numbers, int]:
    """v_measured/v_simulated - 1 of each frame, and the number of frames that the simulated droplet never reached.

    Such a frame counts 10, and 10 more for each missing diameter, which gives a direction to a search among droplets
    that clog.
    """
    speed = at(simulated, measured.h).speed
    never = np.isnan(speed)
    with np.errstate(all="ignore"):
        found = np.clip(measured.speed / speed - 1, -NEVER_REACHED, NEVER_REACHED)
    found[~(speed > 0)] = NEVER_REACHED  # the droplet rests, or is pushed back
    found[never] += NEVER_REACHED * np.maximum(0, measured.h - max(simulated.h))[never]
    return found, int(never.sum())


def shape_residuals(measured: Profile, simulated: Profile) -> Numbers:
    """A_measured/A_simulated - 1 of each frame that has a shape."""
    frames = at(simulated, measured.h)
    found = np.where(np.isnan(frames.speed), NEVER_REACHED, measured.shape / frames.shape - 1)
    return found[~np.isnan(measured.shape) & ~np.isnan(found)]


def root_mean_square(values: Numbers) -> float:
    return float(np.sqrt(np.mean(values**2))) if len(values) else math.nan


def correlation(residuals: Numbers) -> float:
    """The correlation of successive residuals about zero: within 1/sqrt(residuals) of zero for noise, near one where the profiles differ in shape."""
    squares = float(residuals @ residuals)
    return float(residuals[1:] @ residuals[:-1]) / squares if len(residuals) >= FEWEST_CORRELATED and squares > 0 else math.nan
