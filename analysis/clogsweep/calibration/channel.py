"""Simulates passages through a channel by clogrun, as many at a time as there are cores."""

import contextlib
import os
import pathlib
import re
import signal
import subprocess
import tempfile
import threading
from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from types import FrameType

from ..reading import programs
from ..tools.errors import ProgramFailed, UserError
from .profiles import Channel, Profile, read_run

# Half a diameter before the first frame the motion is overdamped and has forgotten its start.
APPROACH = 0.5
# The start has to be clear of the wedges.
USUAL_START = -2.0
# A droplet of 1/30 of its terminal speed on average still passes.
SLOWEST = 30
# Below 64 steps: clogrun has no more samples than one for so many.
SAMPLE_INTERVAL = "1e-9"
SECONDS_BETWEEN_LOOKS = 0.1


class Stopped(Exception):
    """A signal asked for an early end."""


stopping = threading.Event()


@contextlib.contextmanager
def stoppable() -> Iterator[None]:
    """In this block SIGINT, SIGTERM and SIGHUP end the simulations, which raise Stopped."""
    def stop(_number: int, _frame: FrameType | None) -> None:
        stopping.set()

    signals = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)
    before = [signal.signal(number, stop) for number in signals]
    try:
        yield
    finally:
        stopping.clear()
        for number, handler in zip(signals, before):
            signal.signal(number, handler)


def run_clogrun(folder: pathlib.Path, *words: str) -> str:
    """What clogrun channel prints. @throws UserError  with its reason; Stopped"""
    command = [str(folder / "clogrun"), "channel", *words]
    # In a session of its own the terminal does not send it SIGINT.
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, start_new_session=True) as process:
        while True:
            try:
                out, error = process.communicate(timeout=SECONDS_BETWEEN_LOOKS)
                break
            except subprocess.TimeoutExpired:
                if stopping.is_set():
                    process.terminate()
    if stopping.is_set():
        raise Stopped
    if process.returncode == 2:
        raise UserError(programs.reason(error).removeprefix("clogrun: ").replace("clogrun --help", "clogrun channel --help"))
    if process.returncode != 0:
        raise ProgramFailed(programs.reason(error or out), process.returncode)
    return out


def config_of(folder: pathlib.Path, words: Sequence[str]) -> dict[str, str]:
    """All keys that clogrun channel would run with. @throws UserError  for what it refuses"""
    with tempfile.TemporaryDirectory(prefix="clogsweep-calibrate-") as place:
        printed = run_clogrun(folder, *words, f"--output={place}/run.h5", "--dry-run")
    return dict(line.split(" = ", 1) for line in printed.splitlines() if " = " in line and not line.startswith("#"))


def channel_of(config: dict[str, str]) -> Channel:
    return Channel(*(float(config[name.replace("_", "-")]) for name in Channel._fields))


def clear_start(folder: pathlib.Path, words: Sequence[str], start: float) -> float:
    """The same start, or one farther upstream, where the droplet is clear of the wedges."""
    try:
        config_of(folder, [*words, f"start={start!r}"])
    except UserError as error:
        farthest = re.search(r"invalid start=.* use at most (\S+)$", str(error))
        if not farthest:
            raise
        return float(farthest[1]) - 0.1
    return start


class ChannelSimulation:
    """Passages of droplets that differ in line tension and near-wall drag, past the frames of a measured one.

    @param words  keys of clogrun channel; @param cores  on which clogrun runs, shared by the simulations of all trials
    """

    def __init__(self, folder: pathlib.Path, words: Sequence[str], measured: Profile, cores: ThreadPoolExecutor) -> None:
        end = float(max(measured.h)) + 0.1
        words = [word for word in words if word.partition("=")[0].lstrip("-") not in ("start", "end", "max-time")]
        words.append(f"end={end!r}")
        start = clear_start(folder, words, min(float(min(measured.h)) - APPROACH, USUAL_START))
        speed = channel_of(config_of(folder, [*words, f"start={start!r}"])).terminal_speed
        self.words = [*words, f"start={start!r}", f"max-time={SLOWEST * (end - start) / speed!r}", f"--sample-interval={SAMPLE_INTERVAL}"]
        self.folder = folder
        self.cores = cores

    def __call__(self, line_tension: float, near_wall_drag: float) -> Profile:
        """Waits for a free core. Of a droplet that breaks or clogs, as far as it came. @throws Stopped; UserError"""
        return self.cores.submit(self._simulate, line_tension, near_wall_drag).result()

    def _simulate(self, line_tension: float, near_wall_drag: float) -> Profile:
        if stopping.is_set():
            raise Stopped
        with tempfile.TemporaryDirectory(prefix="clogsweep-calibrate-") as place:
            output = f"{place}/run.h5"
            run_clogrun(self.folder, *self.words, f"line-tension={line_tension!r}", f"near-wall-drag={near_wall_drag!r}", f"--output={output}")
            return read_run(output)[0]


def all_cores() -> ThreadPoolExecutor:
    return ThreadPoolExecutor(max_workers=len(os.sched_getaffinity(0)))
