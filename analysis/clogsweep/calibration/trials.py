"""Calibrates several trials side by side, shows the progress on the standard error, and warns of what spoils a result."""

import math
import pathlib
import sys
import threading
import time
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ..tools.errors import ProgramFailed, UserError
from ..tools.progress import readable_duration
from ..tools.rounded import counted
from . import channel, search
from .channel import ChannelSimulation
from .profiles import Channel, Trial
from .search import Calibration

INTERRUPTED = 75

GOOD = 0.2  # Delta_v of speeds that agree within a fifth
MESH = 0.01  # runs without noise differ by less, smoothly, in speed and in shape
NEAR_CLOG = 1.1


class Mean(NamedTuple):
    """Mean and standard deviation over independent trials, as published (Cheng et al., Fig. 2)."""

    line_tension: float
    line_tension_deviation: float  # NaN for one trial
    near_wall_drag: float
    near_wall_drag_deviation: float


class Progress:
    """One line that is renewed on a terminal, a new line now and then elsewhere. Called from several threads."""

    def __init__(self, num_trials: int) -> None:
        self.best = [(math.inf, 0.0, 0.0)] * num_trials  # Delta_v, Gamma, b_0/b_inf
        self.num_simulations = self.num_ended = 0
        self.begin = self.last = time.monotonic()
        self.on_terminal = sys.stderr.isatty()
        self.lock = threading.Lock()

    def tried(self, trial: int, line_tension: float, drag: float, delta: float) -> None:
        with self.lock:
            self.num_simulations += 1
            self.best[trial] = min(self.best[trial], (delta, line_tension, drag))
            now = time.monotonic()
            if now - self.last >= (0.2 if self.on_terminal else 10):
                self.last = now
                text = f"{self.text()}, {readable_duration(now - self.begin)} so far"
                print(f"\r{text}\x1b[K" if self.on_terminal else text, end="" if self.on_terminal else "\n", file=sys.stderr, flush=True)

    def text(self) -> str:
        trials = f", {self.num_ended}/{len(self.best)} trials done" if len(self.best) > 1 else ""
        worst = max(range(len(self.best)), key=lambda trial: self.best[trial][0])
        best = f", {self.best_text(worst)}" if math.isfinite(self.best[worst][0]) else ""
        return counted(self.num_simulations, "simulation") + trials + best

    def best_text(self, trial: int) -> str:
        delta, line_tension, drag = self.best[trial]
        if math.isinf(delta):
            return "no simulation is over"
        return f"Delta_v down to {delta:.3g}, with Gamma = {line_tension:.4g}, b_0/b_inf = {drag:.4g}"

    def wipe(self) -> None:
        if self.on_terminal:
            print("\r\x1b[K", end="", file=sys.stderr, flush=True)


def refuse_other_channel(trial: Trial, simulated: Channel) -> None:
    """A simulated passage has to be compared with ones through the same channel at the same speed."""
    if trial.channel is None:
        return
    for name, stored, given in zip(Channel._fields, trial.channel, simulated):
        key = name.replace("_", "-")
        if not math.isclose(stored, given, rel_tol=1e-12):
            raise UserError(f"{trial.file} was written with {key}={stored:.12g}, not {given:.12g}; give {key}={stored:.12g}")


def calibrate(folder: pathlib.Path, words: Sequence[str], trials: Sequence[Trial]) -> list[Calibration]:
    """@param folder  of the programs; @param words  keys of clogrun channel. @throws ProgramFailed  after a signal, with the best so far"""
    progress = Progress(len(trials))

    def calibrate_one(number: int) -> Calibration:
        frames = trials[number].frames
        found = search.calibrate(frames, ChannelSimulation(folder, words, frames, cores), lambda *attempt: progress.tried(number, *attempt))
        with progress.lock:
            progress.num_ended += 1
        return found

    with channel.stoppable(), channel.all_cores() as cores:
        try:
            return search.in_parallel(calibrate_one, range(len(trials)))
        except channel.Stopped as stop:
            best = "".join(f"; {trial.file}: {progress.best_text(number)}" for number, trial in enumerate(trials))
            raise ProgramFailed(f"stopped by a signal{best}", INTERRUPTED) from stop
        finally:
            progress.wipe()


def combine(found: Sequence[Calibration]) -> Mean:
    values = np.array([calibration[:2] for calibration in found])
    deviations = values.std(axis=0, ddof=1) if len(found) > 1 else np.full(2, math.nan)
    return Mean(*(float(number) for pair in zip(values.mean(axis=0), deviations) for number in pair))


def shape_of_residuals(found: Calibration) -> list[str]:
    """A warning if the best run's residuals are no noise: then something else than Gamma and b_0 differs."""
    largest = 3 / math.sqrt(found.num_frames)  # independent noise exceeds it once in seven hundred trials
    for name, correlation, deviation in zip(("speeds", "shapes"), found.correlation, found.deviation):
        if correlation > largest and deviation > MESH:
            return [f"the {name} of successive frames differ alike from the best run (correlation {correlation:.2f}; noise of {found.num_frames} frames "
                    f"stays below {largest:.2f}): no Gamma and b_0 explain this profile, and errors are too small; look at V_t "
                    "(terminal-speed, or --speed and --angle) first, then at orifice, wedge-angle and units"]
    return []


def warnings(found: Calibration) -> list[str]:
    every = [
        (not found.is_converged, "the search did not converge: another place may have a smaller Delta_v"),
        (found.is_at_bound, "the best is at the end of what was searched, and may lie beyond"),
        (found.num_never_reached > 0,
         f"no simulated droplet comes to {found.num_never_reached} of the frames: look at --orifice, at the units and at h"),
        (math.isnan(found.line_tension_error),
         "no errors: the frames do not determine both, or the droplet clogs at a line tension beside this one"),
        (found.deviation.speed > GOOD, "Delta_v is large: no simulated droplet moves like this one; look at --orifice, units, vertices")]
    near_clog = []
    if found.clogging_tension < NEAR_CLOG * found.line_tension:
        near_clog = [f"close to a clog: simulated droplets of Gamma = {found.clogging_tension:.4g} and more do not pass"]
    return [text for is_so, text in every if is_so] + shape_of_residuals(found) + near_clog
