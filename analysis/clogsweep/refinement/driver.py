"""Runs clogsweep round by round. The points of a round are written to the disk before the round starts, so that a round
that is killed continues with the same points."""

import os
import pathlib
import signal
import subprocess
import sys
import time
from collections.abc import Sequence
from typing import Protocol

import pandas

from ..reading import stored
from ..tools.outputs import replaced
from ..tools.signals import WARNINGS, stop_signals
from .membership import Membership, Values

HOUR = 3600.0
UNFINISHED = ("running", "interrupted")
FAILED, USER_FAULT, INCOMPLETE = 1, 2, 75  # Exit codes of clogsweep.
# Values of the keys, and the first seed with the number of seeds. None means the seeds of the config.
Line = tuple[Values, tuple[int, int] | None]


class Search(Protocol):
    """A search plans the rounds. The two kinds of searches are CurveSearch and AngleSearch."""

    keys: Sequence[str]
    candidates: list[Values]

    def first_round(self) -> list[Line]: ...

    def next_round(self, rows: pandas.DataFrame, members: Membership) -> list[Line]: ...

    def known(self, rows: pandas.DataFrame, members: Membership) -> str: ...

    def costs(self, hours_per_run: float) -> list[str]: ...


def number_text(value: float) -> str:
    """The shortest text that gives exactly this number."""
    return repr(float(value)).removesuffix(".0")


def points_text(keys: Sequence[str], lines: Sequence[Line]) -> str:
    """The text of a file for clogsweep --points."""
    with_seeds = any(seeds for _, seeds in lines)
    out = [",".join([*keys, "seeds"] if with_seeds else keys)]
    for values, seeds in lines:
        words = list(map(number_text, values))
        out.append(",".join(words if seeds is None else [*words, f"{seeds[0]}..{seeds[0] + seeds[1] - 1}"]))
    return "\n".join(out) + "\n"


def store(path: pathlib.Path, text: str) -> None:
    """Replaces the file in one step, and waits until it is on the disk. @throws UserError"""
    with replaced(path) as draft, open(draft, "w", encoding="utf-8") as file:
        file.write(text)
        file.flush()
        os.fsync(file.fileno())


class Launcher:
    """Starts clogsweep by a launcher, such as mpirun -np 64.

    A stop signal is forwarded as SIGUSR1, because mpirun and srun pass this signal on to the ranks and wait for them. A
    second stop signal is forwarded unchanged, unless it is a warning of a batch system."""

    def __init__(self, words: Sequence[object]) -> None:
        self._words = list(map(str, words))
        self._process: subprocess.Popen[bytes] | None = None
        self._is_warned = False
        for number in stop_signals():
            signal.signal(number, self._warn)

    def _warn(self, number: int, _frame: object) -> None:
        forced = self._is_warned and number not in WARNINGS
        self._is_warned = True
        if self._process:
            self._process.send_signal(number if forced else signal.SIGUSR1)

    def is_warned(self) -> bool:
        return self._is_warned

    def run(self, *arguments: object) -> int:
        """Runs the launcher with the streams of this process. @return the launcher's exit code, or 75 if the launcher
        may have been stopped"""
        if self.is_warned():
            return INCOMPLETE
        # The launcher has its own session, so that it receives Ctrl-C from a terminal only once, through this process.
        self._process = subprocess.Popen([*self._words, *map(str, arguments)], start_new_session=True)
        if self.is_warned():  # The warning came while the launcher started.
            self._process.send_signal(signal.SIGUSR1)
        code = self._process.wait()
        self._process = None
        # After a warning the launcher may be killed by the signal, or may end with its own exit code, even 0.
        if self.is_warned() and code not in (FAILED, USER_FAULT):
            return INCOMPLETE
        return 128 - code if code < 0 else code


def refine(search: Search, members: Membership, launcher: Launcher, options: Sequence[object], points: pathlib.Path,
           output: pathlib.Path, max_hours: float) -> int:
    """Runs rounds until the search ends.

    The file `points` contains the points of all rounds. The points of a round are added to this file before the round
    starts, so an interrupted round is completed before the next round is planned.
    @param options  of clogsweep
    @return an exit code of clogsweep"""
    end = time.monotonic() + max_hours * HOUR
    if not (points.exists() and output.exists()):
        store(points, points_text(search.keys, search.first_round()))
    while True:
        hours = max(1e-9, (end - time.monotonic()) / HOUR)
        code = launcher.run(*options, "--points", points, "--output", output, *(["--max-hours", hours] if hours < 1e9 else []))
        if code != 0:
            return code
        rows = stored.read_table(output)
        lines = search.next_round(rows, members)
        if not lines:
            if "--quiet" not in options:
                print(search.known(rows, members), file=sys.stderr)
            return 0
        store(points, points.read_text(encoding="utf-8") + points_text(search.keys, lines).split("\n", 1)[1])
        if launcher.is_warned() or time.monotonic() >= end:
            print(f"{output}: stopped between two rounds; the same command resumes the search", file=sys.stderr)
            return INCOMPLETE
