"""Calibrates several trials side by side, and shows the progress on the standard error."""

import math
import threading
from collections.abc import Sequence

from ..tools.errors import ProgramFailed
from ..tools.progress import StatusLine, readable_duration
from ..tools.rounded import count_text
from . import search
from .profiles import Profile
from .search import Calibration
from .simulation import Clogrun, Stopped

INTERRUPTED = 75


class Progress:
    """Shows the progress of all trials in one line. The line contains the best simulation so far of the trial with the
    largest Delta_v. Several threads may report simulations."""

    def __init__(self, num_trials: int) -> None:
        self.best = [(math.inf, 0.0, 0.0)] * num_trials  # Delta_v, Gamma, b_0/b_inf
        self.num_simulations = self.num_ended = 0
        self.line = StatusLine()
        self.lock = threading.Lock()

    def tried(self, trial: int, line_tension: float, drag: float, delta: float) -> None:
        with self.lock:
            self.num_simulations += 1
            self.best[trial] = min(self.best[trial], (delta, line_tension, drag))
            self.line.redraw(self.text)

    def text(self, seconds: float) -> str:
        trials = f", {self.num_ended}/{len(self.best)} trials done" if len(self.best) > 1 else ""
        worst = max(self.best)
        best = f", {self.text_of(worst)}" if math.isfinite(worst[0]) else ""
        return f"{count_text(self.num_simulations, 'simulation')}{trials}{best}, {readable_duration(seconds)} so far"

    @staticmethod
    def text_of(best: tuple[float, float, float]) -> str:
        if math.isinf(best[0]):
            return "no simulation is over"
        return "Delta_v down to {:.3g}, with Gamma = {:.4g}, b_0/b_inf = {:.4g}".format(*best)


def calibrate(clogrun: Clogrun, words: Sequence[str], files: Sequence[str],
              profiles: Sequence[Profile]) -> list[Calibration]:
    """Calibrates all profiles. @param words  keys of clogrun channel. @throws ProgramFailed  after a signal, with the
    best results so far"""
    progress = Progress(len(files))

    def calibrate_one(number: int) -> Calibration:
        found = search.calibrate(profiles[number], clogrun.past(profiles[number], words),
                                 lambda *attempt: progress.tried(number, *attempt))
        progress.num_ended += 1
        return found

    with clogrun.stoppable():
        try:
            return search.in_parallel(calibrate_one, range(len(files)))
        except Stopped as stop:
            best = "".join(f"; {file}: {progress.text_of(best)}" for file, best in zip(files, progress.best))
            raise ProgramFailed(f"stopped by a signal{best}", INTERRUPTED) from stop
        finally:
            progress.line.wipe()
