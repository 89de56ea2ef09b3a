"""Simulates passages through a channel with clogrun. As many simulations run at a time as there are cores."""

import contextlib
import os
import pathlib
import re
import signal
import subprocess
import tempfile
import threading
from collections.abc import Callable, Iterator, Sequence
from types import FrameType

from ..reading import programs
from ..tools.errors import ProgramFailed
from ..tools.signals import stop_signals
from .profiles import Channel, Profile, read_run

Simulation = Callable[[float, float], Profile]  # its arguments are line tension and near-wall drag

# The run starts this many diameters before the first frame. Motion is overdamped, so at the first frame the start no
# longer has an effect.
APPROACH = 0.5
# A droplet that starts here is usually clear of the wedges [sigma].
USUAL_START = -2.0
# The run is long enough for a droplet to pass with a mean speed of 1/30 of its terminal speed.
SLOWEST = 30
# This interval is shorter than any step, so clogrun stores as many samples as possible: one every 64 steps.
SAMPLE_INTERVAL = 1e-9


class Stopped(Exception):
    """A signal has asked the program to end early."""


class Clogrun:
    """Runs clogrun channel. Several threads may call it; they wait for a free core."""

    def __init__(self, folder: pathlib.Path) -> None:
        self.program = folder / "clogrun"
        self.cores = threading.Semaphore(len(os.sched_getaffinity(0)))
        self.running: set[subprocess.Popen[str]] = set()
        self.stopping = threading.Event()

    def __call__(self, *words: object) -> str:
        """Runs clogrun channel with these arguments. @return what clogrun prints. @throws ProgramFailed  with clogrun's
        reason; Stopped"""
        with self.cores:
            if self.stopping.is_set():
                raise Stopped
            # The process has its own session, so the terminal does not send it SIGINT.
            with subprocess.Popen([self.program, "channel", *map(str, words)], stdout=subprocess.PIPE,
                                  stderr=subprocess.PIPE, encoding="utf-8", errors="backslashreplace",
                                  start_new_session=True) as process:
                self.running.add(process)
                # The signal may have come between the check above and the start of the process.
                if self.stopping.is_set():
                    process.terminate()
                out, error = process.communicate()
                self.running.discard(process)
        if self.stopping.is_set():
            raise Stopped
        if process.returncode != 0:
            raise ProgramFailed(programs.reason(error or out).removeprefix("clogrun: "), process.returncode)
        return out

    @contextlib.contextmanager
    def stoppable(self) -> Iterator[None]:
        """Within this block, a stop signal ends all runs. The calls that started these runs then raise Stopped."""
        def stop(_number: int, _frame: FrameType | None) -> None:
            self.stopping.set()
            for process in list(self.running):
                process.terminate()

        before = {number: signal.signal(number, stop) for number in stop_signals()}
        try:
            yield
        finally:
            for number, handler in before.items():
                signal.signal(number, handler)

    def channel(self, words: Sequence[str]) -> Channel:
        """The channel that follows from these keys. @throws ProgramFailed  for keys that clogrun refuses"""
        with tempfile.TemporaryDirectory(prefix="clogsweep-calibrate-") as place:
            config = dict(line.split(" = ", 1)
                          for line in self(*words, f"--output={place}/run.h5", "--dry-run").splitlines()
                          if " = " in line)
        return Channel(*(float(config[name.replace("_", "-")]) for name in Channel._fields))

    def past(self, measured: Profile, words: Sequence[str]) -> Simulation:
        """Returns a function that simulates a passage. The passage begins before the first measured frame and ends
        after the last.
        @param words  keys of clogrun channel"""
        words = [word for word in words if word.partition("=")[0].lstrip("-") not in ("start", "end", "max-time")]
        start, end = min(float(min(measured.h)) - APPROACH, USUAL_START), float(max(measured.h)) + 0.1
        try:
            channel = self.channel([*words, f"start={start}", f"end={end}"])
        except ProgramFailed as failure:
            farthest = re.search(r"invalid start=.* use at most (\S+)$", str(failure))
            if not farthest:
                raise
            start = float(farthest[1]) - 0.1
            channel = self.channel([*words, f"start={start}", f"end={end}"])
        words += [f"start={start}", f"end={end}", f"max-time={SLOWEST * (end - start) / channel.terminal_speed}",
                  f"--sample-interval={SAMPLE_INTERVAL}"]

        def simulate(line_tension: float, near_wall_drag: float) -> Profile:
            """The simulated passage, which ends early if the droplet breaks or clogs."""
            with tempfile.TemporaryDirectory(prefix="clogsweep-calibrate-") as place:
                self(*words, f"line-tension={line_tension}", f"near-wall-drag={near_wall_drag}",
                     f"--output={place}/run.h5")
                return read_run(f"{place}/run.h5")[0]

        return simulate
