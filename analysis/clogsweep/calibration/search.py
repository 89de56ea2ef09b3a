"""Searches the line tension and the near-wall drag of the simulation that is closest to a measured passage.

Close to a line tension at which the droplet clogs, Delta_v has several minima, each a percent wide. The search begins on a
coarse grid, descends from its best points by the simplex method, brackets the line tension at which droplets clog,
descends again from distances to it that double, and ends with Gauss-Newton steps until these and another simplex gain nothing.
"""

import itertools
import math
import threading
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from typing import NamedTuple, TypeVar

import numpy as np
from scipy import optimize

from ..tools.hints import Numbers
from .deviation import Deviation, deviation, residual_correlation, root_mean_square, speed_residuals
from .profiles import Profile

Simulation = Callable[[float, float], Profile]
Item = TypeVar("Item")
Result = TypeVar("Result")

# What is searched: (log Gamma, b_0/b_inf).
LOWER = np.array([math.log(0.02), 0])
UPPER = np.array([math.log(10), 2])
GRID_TENSIONS = LOWER[0] + (UPPER[0] - LOWER[0]) * (np.arange(7) + 0.5) / 7
GRID_DRAGS = np.array([0, 0.01, 0.03, 0.1, 0.3]) * UPPER[1]
LADDER_DISTANCES = (0, 0.01, 0.02, 0.04, 0.08, 0.16, 0.32)  # of log Gamma from a clog
LADDER_DRAGS = (0.9, 1, 1.1)
NUM_STARTS = 3
CLOG_WIDTH = 0.005  # of the bracket, in log Gamma
# Residuals are linear over such differences where no droplet clogs.
LONGEST_STEP = np.array([0.05, 0.01])
SHORTEST_STEP = np.array([5e-4, 1e-4])
MOST_ROUNDS = 20
WORTH_IT = 0.999  # Delta_v after a round that is worth another, relative to that before
NEGLIGIBLE = 0.03  # length of a step, in standard errors


class Attempt(NamedTuple):
    """A simulation's result."""

    place: tuple[float, float]
    residuals: Numbers
    num_never_reached: int

    @property
    def delta(self) -> float:
        return root_mean_square(self.residuals)


class Calibration(NamedTuple):
    """Line tension and near-wall drag of one profile."""

    line_tension: float  # [g rho sigma^2]
    near_wall_drag: float  # b_0/b_inf
    line_tension_error: float  # from the scatter of the frames about the best run; NaN if the frames do not determine both
    near_wall_drag_error: float
    deviation: Deviation
    correlation: Deviation
    num_frames: int
    num_simulations: int
    is_converged: bool
    is_at_bound: bool
    num_never_reached: int  # frames at an h that the best run's droplet did not come to
    clogging_tension: float  # from which on droplets do not come to all frames; NaN if all do, or none


class Linearised(NamedTuple):
    """Least squares at a place as if the residuals were linear there."""

    step: Numbers  # to the minimum
    errors: Numbers


class Search:
    """Places that were tried for one profile. Simulations run in parallel, and once for each place."""

    def __init__(self, measured: Profile, simulate: Simulation, progress: Callable[[float, float, float], None]) -> None:
        self.measured, self.simulate, self.progress = measured, simulate, progress
        self.known: dict[tuple[float, float], Attempt] = {}
        self.lock = threading.Lock()

    def attempt(self, place: Sequence[float] | Numbers) -> Attempt:
        log_tension, drag = np.clip(place, LOWER, UPPER)
        key = float(log_tension), float(drag)
        with self.lock:
            if key in self.known:
                return self.known[key]
        found = Attempt(key, *speed_residuals(self.measured, self.simulate(math.exp(key[0]), key[1])))
        with self.lock:
            self.known[key] = found
        self.progress(math.exp(key[0]), key[1], found.delta)
        return found

    def attempts(self, places: Sequence[Sequence[float] | Numbers]) -> list[Attempt]:
        return in_parallel(self.attempt, places)

    def simplex(self, start: Sequence[float], first_step: Sequence[float], tolerance: Sequence[float], most: int) -> tuple[Attempt, bool]:
        """Nelder and Mead's simplex. @return the best, and whether the simplex has shrunk to the tolerance"""
        scale = np.array(tolerance)  # SciPy has one tolerance for all coordinates
        corners = np.array(start) + np.vstack([np.zeros(2), np.diag(first_step)])
        too_high = corners > UPPER
        corners[too_high] = (2 * np.array(start) - corners)[too_high]
        found = optimize.minimize(
            lambda scaled: self.attempt(scaled * scale).delta, corners[0] / scale, method="Nelder-Mead", bounds=optimize.Bounds(LOWER / scale, UPPER / scale),
            options={"initial_simplex": corners / scale, "xatol": 1, "fatol": math.inf, "maxfev": most})
        return self.attempt(found.x * scale), found.success

    def linearise_over(self, place: Numbers, step: Numbers) -> Linearised | None:
        """By differences over a step. None if the droplet clogs a step away, or if the frames do not determine both."""
        below = np.maximum(place - step, [-math.inf, 0])
        beside = [(place[0] + step[0], place[1]), (below[0], place[1]), (place[0], place[1] + step[1]), (place[0], below[1])]
        here, stiffer, softer, slower, faster = self.attempts([place, *beside])
        if len({attempt.num_never_reached for attempt in (here, stiffer, softer, slower, faster)}) > 1:
            return None
        differences = np.stack([stiffer.residuals - softer.residuals, slower.residuals - faster.residuals], axis=1)
        slopes = differences / (place + step - below)
        information = slopes.T @ slopes
        if not np.linalg.det(information) > 1e-12 * np.prod(np.diag(information)):
            return None
        variance = here.residuals @ here.residuals / (len(here.residuals) - 2)
        return Linearised(-np.linalg.lstsq(slopes, here.residuals, rcond=None)[0], np.sqrt(variance * np.diag(np.linalg.inv(information))))

    def linearise(self, place: Sequence[float]) -> Linearised | None:
        """Over steps so short that the droplet passes on both sides, and then as long as the errors."""
        step = LONGEST_STEP
        while (found := self.linearise_over(np.array(place), step)) is None and np.all(step > 2 * SHORTEST_STEP):
            step = step / 2
        return found and self.linearise_over(np.array(place), np.clip(found.errors, SHORTEST_STEP, step))

    def polish(self, best: Attempt) -> tuple[Attempt, bool]:
        """Gauss-Newton steps; where these gain nothing, a new simplex, since the last one may have collapsed on a slope."""
        for _ in range(MOST_ROUNDS):
            before = best.delta
            here = self.linearise(best.place)
            if here is not None:
                if np.all(np.abs(here.step) <= np.maximum(NEGLIGIBLE * here.errors, [1e-5, 1e-6])):
                    return best, True
                best = nearest([best, *self.attempts([np.array(best.place) + share * here.step for share in (1, 0.5, 0.2, 0.05)])])
                if best.delta < WORTH_IT * before:
                    continue
            found, is_small = self.simplex(best.place, (0.005, max(0.02 * best.place[1], 0.001)), (5e-5, 5e-6), 80)
            best = nearest([best, found])
            if is_small and not best.delta < WORTH_IT * before:
                return best, True
        return best, False

    def bracket_clog(self, grid: Sequence[Attempt], drag: float) -> tuple[float, float] | None:
        """log Gamma of two droplets, of which the softer passes all frames and the stiffer does not, if there are any."""
        pairs = zip(grid, grid[len(GRID_DRAGS):])
        brackets = [(softer.place[0], stiffer.place[0]) for softer, stiffer in pairs if softer.num_never_reached == 0 < stiffer.num_never_reached]
        if not brackets:
            return None
        passing, clogging = brackets[-1]
        while clogging - passing > CLOG_WIDTH:
            middle = (passing + clogging) / 2
            if self.attempt((middle, drag)).num_never_reached:
                clogging = middle
            else:
                passing = middle
        return passing, clogging

    def run(self) -> tuple[Attempt, bool, float]:
        """@return the best, whether the search converged, and log Gamma from which on droplets clog, or NaN"""
        grid = self.attempts(list(itertools.product(GRID_TENSIONS, GRID_DRAGS)))
        minima = in_parallel(lambda start: self.simplex(start, (0.4, max(0.3 * start[1], 0.03)), (0.01, 0.002), 40)[0], starts(grid))
        drag = nearest(minima).place[1]
        clog = self.bracket_clog(grid, drag)
        if clog:
            ladder = self.attempts([(clog[0] - distance, factor * drag) for distance in LADDER_DISTANCES for factor in LADDER_DRAGS])
            minima += in_parallel(lambda start: self.simplex(start, (0.01, max(0.05 * start[1], 0.001)), (5e-4, 5e-5), 60)[0], starts(ladder))
        best, is_converged = self.polish(nearest(minima))
        return best, is_converged, clog[1] if clog else math.nan


def in_parallel(function: Callable[[Item], Result], items: Sequence[Item]) -> list[Result]:
    """Waits in a thread for each; simulations have a core each."""
    with ThreadPoolExecutor(max_workers=max(1, len(items))) as threads:
        return list(threads.map(function, items))


def nearest(attempts: Sequence[Attempt]) -> Attempt:
    return min(attempts, key=lambda attempt: attempt.delta)


def starts(attempts: Sequence[Attempt]) -> list[tuple[float, float]]:
    """The best places, no two of the same line tension."""
    best: dict[float, tuple[float, float]] = {}
    for attempt in sorted(attempts, key=lambda attempt: attempt.delta):
        best.setdefault(attempt.place[0], attempt.place)
    return list(best.values())[:NUM_STARTS]


def calibrate(measured: Profile, simulate: Simulation, progress: Callable[[float, float, float], None] = lambda *_: None) -> Calibration:
    """Minimises Delta_v. The same every time.

    Errors are those of linearised least squares with independent frames of equal relative scatter, over a range like the errors.
    @param simulate  is called from several threads; @param progress  gets line tension, drag and Delta_v of each simulation
    @throws what a simulation throws
    """
    search = Search(measured, simulate, progress)
    best, is_converged, clog = search.run()
    log_tension, drag = best.place
    around = search.linearise(best.place)
    errors = around.errors if around else np.full(2, math.nan)
    tension = math.exp(log_tension)
    profile = simulate(tension, drag)
    is_at_bound = not LOWER[0] + 0.01 < log_tension < UPPER[0] - 0.01 or drag > 0.99 * UPPER[1]  # a drag of 0 hides nothing better
    return Calibration(tension, drag, tension * float(errors[0]), float(errors[1]), deviation(measured, profile), residual_correlation(measured, profile),
                       len(measured.h), len(search.known) + 1, is_converged, is_at_bound, best.num_never_reached, math.exp(clog))
