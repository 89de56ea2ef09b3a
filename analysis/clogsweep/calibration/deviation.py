"""Computes the deviation of a simulated passage from a measured one (Delta_v and Delta_A of Cheng et al.)."""

import math

import numpy as np

from ..tools.errors import UserError
from ..tools.hints import Numbers
from ..tools.rounded import count_text
from .profiles import Profile, at
from .simulation import APPROACH

# Residual of a frame just beyond the farthest point of the simulated droplet. Residuals of frames that the droplet
# reached are limited to this value.
NEVER_REACHED = 10
# The correlation is NaN for a profile with fewer residuals.
FEWEST_CORRELATED = 8


def speed_residuals(measured: Profile, simulated: Profile) -> tuple[Numbers, int]:
    """v_measured/v_simulated - 1 of each frame, and the number of frames that the simulated droplet never reached.
    @throws UserError  if frames are upstream of the start of the simulation

    The residual of a frame that was never reached is 10, plus 10 for each diameter between the frame and the farthest
    point that the droplet reached. With these residuals, a search among droplets that clog can detect progress.
    """
    speed = at(simulated, measured.h).speed
    refuse_upstream(measured.h[np.isnan(speed) & (measured.h < simulated.h[0])], simulated)
    never = np.isnan(speed)
    with np.errstate(all="ignore"):
        found = np.clip(measured.speed / speed - 1, -NEVER_REACHED, NEVER_REACHED)
    found[~(speed > 0)] = NEVER_REACHED  # the droplet rests, or is pushed back
    found[never] += NEVER_REACHED * np.maximum(0, measured.h - max(simulated.h))[never]
    return found, int(never.sum())


def refuse_upstream(missed: Numbers, simulated: Profile) -> None:
    """@param missed  the measured h upstream of the start of the simulation. @throws UserError  if there are any"""
    if len(missed):
        start = simulated.h[0]
        remedy = ("write the simulated frames in the order of time" if simulated.h[-1] < start else
                  f"start the simulation farther upstream, start={missed.min() - APPROACH:.4g}, or delete these frames")
        raise UserError(f"{count_text(len(missed), 'measured frame')}, down to h = {missed.min():.6g}, {'is' if len(missed) == 1 else 'are'} upstream of the simulated start at h = {start:.6g}; {remedy}")


def shape_residuals(measured: Profile, simulated: Profile) -> Numbers:
    """A_measured/A_simulated - 1 of each frame with a measured shape."""
    frames = at(simulated, measured.h)
    found = np.where(np.isnan(frames.speed), NEVER_REACHED, measured.shape / frames.shape - 1)
    return found[~np.isnan(measured.shape) & ~np.isnan(found)]


def root_mean_square(values: Numbers) -> float:
    return float(np.sqrt(np.mean(values**2))) if len(values) else math.nan


def correlation(residuals: Numbers) -> float:
    """The correlation between successive residuals, without subtraction of their mean. For n residuals of pure noise it
    is about 1/sqrt(n) or less. If the profiles differ systematically, the correlation is near one."""
    squares = float(residuals @ residuals)
    if len(residuals) < FEWEST_CORRELATED or not squares > 0:
        return math.nan
    return float(residuals[1:] @ residuals[:-1]) / squares
