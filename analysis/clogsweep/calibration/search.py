"""Searches for the line tension and the near-wall drag with which the simulation is closest to a measured passage.

Close to a line tension at which the droplet clogs, Delta_v has several minima, each about a percent of Gamma wide. The
search begins on a coarse grid and descends from the best points of this grid by the simplex method. The next step
brackets the line tension at which droplets clog. The search then descends again from several line tensions below this
bracket. Each of these line tensions is twice as far from the bracket as the one before. At the end the search takes
Gauss-Newton steps. The search stops when neither these steps nor another simplex lower Delta_v further.
"""

import itertools
import math
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from typing import NamedTuple, TypeVar

import numpy as np
from scipy import optimize

from ..tools.hints import Numbers
from .deviation import correlation, root_mean_square, shape_residuals, speed_residuals
from .profiles import Profile
from .simulation import Simulation

Item = TypeVar("Item")
Result = TypeVar("Result")
Place = Sequence[float] | Numbers  # log Gamma, b_0/b_inf

LOWER = np.array([math.log(0.02), 0])
UPPER = np.array([math.log(10), 2])
GRID_TENSIONS = LOWER[0] + (UPPER[0] - LOWER[0]) * (np.arange(7) + 0.5) / 7
GRID_DRAGS = np.array([0, 0.01, 0.03, 0.1, 0.3]) * UPPER[1]
# Starting points of the second descents: their distances from the line tension at which droplets clog, in log Gamma.
LADDER_DISTANCES = (0, 0.01, 0.02, 0.04, 0.08, 0.16, 0.32)
LADDER_DRAGS = (0.9, 1, 1.1)
NUM_STARTS = 3
CLOG_WIDTH = 0.005  # Width to which the bracket around the line tension of a clog is narrowed, in log Gamma.
# Steps of the finite differences, in log Gamma and b_0/b_inf. If no droplet clogs within these steps, the residuals are
# linear even over the longest steps.
LONGEST_STEP = np.array([0.05, 0.01])
SHORTEST_STEP = np.array([5e-4, 1e-4])
MOST_ROUNDS = 20
WORTH_IT = 0.999  # A round is a gain if the ratio of the new Delta_v to the old one is below this value.
NEGLIGIBLE = 0.03  # Gauss-Newton steps shorter than this many standard errors are not taken.

GOOD = 0.2  # A larger Delta_v causes a warning, because speeds then differ by more than a fifth.
# Smaller systematic residuals cause no warning: even simulations without noise differ smoothly by almost this much,
# both in speed and in shape.
MESH = 0.01
NEAR_CLOG = 1.1


class Attempt(NamedTuple):
    """A simulation's result."""

    place: tuple[float, float]
    simulated: Profile
    residuals: Numbers  # Residuals of the speed.
    num_never_reached: int  # Number of frames that the droplet never reached.

    @property
    def delta(self) -> float:
        return root_mean_square(self.residuals)


class Calibration(NamedTuple):
    """The line tension and the near-wall drag of one profile. Errors are NaN if the frames do not determine both
    quantities."""

    line_tension: float  # [g rho sigma^2].
    line_tension_error: float  # The error follows from the scatter of the frames about the best run.
    near_wall_drag: float  # b_0/b_inf
    near_wall_drag_error: float
    delta_v: float
    delta_a: float
    speed_correlation: float
    shape_correlation: float
    converged: bool
    # Droplets of this line tension or a larger one do not reach all frames. The value is NaN if all tried droplets
    # reach all frames, or if none does.
    clogging_tension: float
    simulations: int
    warnings: list[str]


class Linearised(NamedTuple):
    """A least-squares problem, with residuals linearised about a place."""

    step: Numbers  # from the place to the minimum
    errors: Numbers


class Search:
    """The simulations of one profile, stored by their places (log Gamma and b_0/b_inf). Simulations run in parallel. A
    place is rarely simulated twice."""

    def __init__(self, measured: Profile, simulate: Simulation,
                 progress: Callable[[float, float, float], None]) -> None:
        self.measured, self.simulate, self.progress = measured, simulate, progress
        self.known: dict[tuple[float, float], Attempt] = {}

    def attempt(self, place: Place) -> Attempt:
        log_tension, drag = map(float, np.clip(place, LOWER, UPPER))
        if (log_tension, drag) not in self.known:
            simulated = self.simulate(math.exp(log_tension), drag)
            found = Attempt((log_tension, drag), simulated, *speed_residuals(self.measured, simulated))
            self.known[found.place] = found
            self.progress(math.exp(log_tension), drag, found.delta)
        return self.known[log_tension, drag]

    def attempts(self, places: Sequence[Place]) -> list[Attempt]:
        return in_parallel(self.attempt, places)

    def descend(self, start: Place, first_step: Place, tolerance: Place, most: int) -> tuple[Attempt, bool]:
        """Minimises by Nelder and Mead's simplex. @return the best attempt, and whether the simplex has shrunk to the
        tolerance"""
        scale = np.array(tolerance)  # SciPy has one tolerance for all coordinates, so the coordinates are scaled.
        corners = np.array(start) + np.vstack([np.zeros(2), np.diag(first_step)])
        corners = np.where(corners > UPPER, 2 * np.array(start) - corners, corners)
        found = optimize.minimize(
            lambda scaled: self.attempt(scaled * scale).delta, corners[0] / scale, method="Nelder-Mead",
            bounds=optimize.Bounds(LOWER / scale, UPPER / scale),
            options={"initial_simplex": corners / scale, "xatol": 1, "fatol": math.inf, "maxfev": most})
        return self.attempt(found.x * scale), found.success

    def linearise_over(self, place: Numbers, step: Numbers) -> Linearised | None:
        """Finds the linearised residuals by finite differences over a step. Returns None if the droplet clogs within
        the step, or if the frames do not determine both line tension and drag."""
        below = np.maximum(place - step, [-math.inf, 0])
        beside = [(place[0] + step[0], place[1]), (below[0], place[1]), (place[0], place[1] + step[1]),
                  (place[0], below[1])]
        here, stiffer, softer, slower, faster = every = self.attempts([place, *beside])
        if len({attempt.num_never_reached for attempt in every}) > 1:
            return None
        differences = [stiffer.residuals - softer.residuals, slower.residuals - faster.residuals]
        slopes = np.stack(differences, axis=1) / (place + step - below)
        information = slopes.T @ slopes
        if not np.linalg.det(information) > 1e-12 * np.prod(np.diag(information)):
            return None
        variance = here.residuals @ here.residuals / (len(here.residuals) - 2)
        return Linearised(-np.linalg.lstsq(slopes, here.residuals, rcond=None)[0],
                          np.sqrt(variance * np.diag(np.linalg.inv(information))))

    def linearise(self, place: Place) -> Linearised | None:
        """Computes the linearised residuals twice: first over steps so short that the droplets on both sides of the
        place pass, then over steps as long as the errors."""
        step = LONGEST_STEP
        while (found := self.linearise_over(np.array(place), step)) is None and np.all(step > 2 * SHORTEST_STEP):
            step = step / 2
        return found and self.linearise_over(np.array(place), np.clip(found.errors, SHORTEST_STEP, step))

    def polish(self, best: Attempt) -> tuple[Attempt, bool]:
        """Takes Gauss-Newton steps. If these steps gain nothing, a new simplex follows: the previous simplex may have
        shrunk to a point that is not a minimum."""
        for _ in range(MOST_ROUNDS):
            before = best.delta
            if around := self.linearise(best.place):
                if np.all(np.abs(around.step) <= np.maximum(NEGLIGIBLE * around.errors, [1e-5, 1e-6])):
                    return best, True
                along = [np.array(best.place) + share * around.step for share in (1, 0.5, 0.2, 0.05)]
                best = nearest([best, *self.attempts(along)])
            if best.delta >= WORTH_IT * before:
                found, is_small = self.descend(best.place, (0.005, max(0.02 * best.place[1], 0.001)), (5e-5, 5e-6), 80)
                best = nearest([best, found])
                if is_small and best.delta >= WORTH_IT * before:
                    return best, True
        return best, False

    def bracket_clog(self, grid: Sequence[Attempt], drag: float) -> tuple[float, float] | None:
        """log Gamma of a droplet that reaches all frames, and of a slightly stiffer droplet that does not. The result
        is None if there are no two such droplets."""
        brackets = [(softer.place[0], stiffer.place[0]) for softer, stiffer in zip(grid, grid[len(GRID_DRAGS):])
                    if softer.num_never_reached == 0 < stiffer.num_never_reached]
        if not brackets:
            return None
        passing, clogging = brackets[-1]
        while clogging - passing > CLOG_WIDTH:
            middle = (passing + clogging) / 2
            passing, clogging = (passing, middle) if self.attempt((middle, drag)).num_never_reached else (middle, clogging)
        return passing, clogging

    def run(self) -> tuple[Attempt, bool, float]:
        """@return the best simulation; whether the search converged; the smallest Gamma at which droplets clog, or
        NaN"""
        grid = self.attempts(list(itertools.product(GRID_TENSIONS, GRID_DRAGS)))
        minima = in_parallel(lambda start: self.descend(start, (0.4, max(0.3 * start[1], 0.03)), (0.01, 0.002), 40)[0],
                             starts(grid))
        drag = nearest(minima).place[1]
        clog = self.bracket_clog(grid, drag)
        if clog:
            ladder = self.attempts([(clog[0] - distance, factor * drag)
                                    for distance in LADDER_DISTANCES for factor in LADDER_DRAGS])
            minima += in_parallel(lambda start: self.descend(start, (0.01, max(0.05 * start[1], 0.001)), (5e-4, 5e-5), 60)[0], starts(ladder))
        return *self.polish(nearest(minima)), math.exp(clog[1]) if clog else math.nan


def in_parallel(function: Callable[[Item], Result], items: Sequence[Item]) -> list[Result]:
    """Works on all items at once. Each item has its own thread, which waits until a core is free for its simulation."""
    with ThreadPoolExecutor(max_workers=len(items)) as threads:
        return list(threads.map(function, items))


def nearest(attempts: Sequence[Attempt]) -> Attempt:
    return min(attempts, key=lambda attempt: attempt.delta)


def starts(attempts: Sequence[Attempt]) -> list[tuple[float, float]]:
    """The parameters (`place`) of the best attempts: at most one for each line tension, and at most NUM_STARTS."""
    best: dict[float, tuple[float, float]] = {}
    for attempt in sorted(attempts, key=lambda attempt: attempt.delta):
        best.setdefault(attempt.place[0], attempt.place)
    return list(best.values())[:NUM_STARTS]


def warnings(best: Attempt, found: Calibration) -> list[str]:
    """Reasons to doubt a result."""
    num_frames, log_tension, drag = len(best.residuals), *best.place
    # The correlation of independent noise exceeds this limit once in seven hundred trials. If the residuals are
    # systematic, the measurement differs from the model in more than Gamma and b_0.
    largest = 3 / math.sqrt(num_frames)
    shapes = [(name, measure) for name, measure, delta in (("speeds", found.speed_correlation, found.delta_v),
                                                           ("shapes", found.shape_correlation, found.delta_a))
              if measure > largest and delta > MESH][:1]
    every = [
        (not found.converged, "the search did not converge: another place may have a smaller Delta_v"),
        # A drag at its lower limit of 0 needs no warning, because it cannot be negative.
        (not LOWER[0] + 0.01 < log_tension < UPPER[0] - 0.01 or drag > 0.99 * UPPER[1],
         "the best is at the end of what was searched, and may lie beyond"),
        (best.num_never_reached > 0, f"no simulated droplet comes to {best.num_never_reached} of the frames: "
                                     "look at --orifice, at the units and at h"),
        (math.isnan(found.line_tension_error), "no errors: the frames do not determine both, "
                                               "or the droplet clogs at a line tension beside this one"),
        (found.delta_v > GOOD, "Delta_v is large: no simulated droplet moves like this one; "
                               "look at --orifice, units, vertices"),
        *((True, f"the {name} of successive frames differ alike from the best run (correlation {measure:.2f}; "
                 f"noise of {num_frames} frames stays below {largest:.2f}): no Gamma and b_0 explain this profile, "
                 "and errors are too small; look at V_t (terminal-speed, or --speed and --angle) first, "
                 "then at orifice, wedge-angle and units") for name, measure in shapes),
        (found.clogging_tension < NEAR_CLOG * found.line_tension,
         f"close to a clog: simulated droplets of Gamma = {found.clogging_tension:.4g} and more do not pass")]
    return [text for is_so, text in every if is_so]


def calibrate(measured: Profile, simulate: Simulation,
              progress: Callable[[float, float, float], None] = lambda *_: None) -> Calibration:
    """Minimises Delta_v. The same profile gives the same result every time.

    Errors come from least squares. They assume that the frames are independent and have equal relative scatter. The
    residuals are linearised by finite differences over steps about as long as the errors.
    @param simulate  is called from several threads
    @param progress  is called with line tension, drag and Delta_v of each simulation
    @throws what a simulation throws
    """
    measured = Profile(*(values[np.argsort(measured.h, kind="stable")] for values in measured))
    search = Search(measured, simulate, progress)
    best, is_converged, clogging_tension = search.run()
    tension, drag = math.exp(best.place[0]), best.place[1]
    around = search.linearise(best.place)
    errors = around.errors if around else np.full(2, math.nan)
    shapes = shape_residuals(measured, best.simulated)
    found = Calibration(tension, tension * float(errors[0]), drag,
                        float(errors[1]), best.delta, root_mean_square(shapes), correlation(best.residuals),
                        correlation(shapes), is_converged, clogging_tension, len(search.known), [])
    return found._replace(warnings=warnings(best, found))
