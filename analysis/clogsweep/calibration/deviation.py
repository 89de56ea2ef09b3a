"""Deviation of a simulated passage from a measured one (Cheng et al., Delta_v and Delta_A)."""

import math

import numpy as np

from ..tools.hints import Numbers
from .profiles import Profile, at

# Smallest residual of a frame that the simulated droplet never reached. All other residuals are limited to this.
NEVER_REACHED = 10
# A profile with fewer residuals has no correlation.
FEWEST_CORRELATED = 8


def speed_residuals(measured: Profile, simulated: Profile) -> tuple[Numbers, int]:
    """v_measured/v_simulated - 1 of each frame, and the number of frames that the simulated droplet never reached.

    For such a frame the residual is 10, and 10 more for each diameter between the droplet's end and the frame. So a
    search among droplets that clog can tell which of them get closer.
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
    """The correlation of successive residuals about zero. For n residuals of pure noise it is about 1/sqrt(n) or less;
    if the profiles differ in shape it is near one."""
    squares = float(residuals @ residuals)
    return float(residuals[1:] @ residuals[:-1]) / squares if len(residuals) >= FEWEST_CORRELATED and squares > 0 else math.nan
