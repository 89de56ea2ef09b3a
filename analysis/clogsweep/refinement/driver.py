"""Runs clogsweep by a launcher, such as mpirun, round by round."""

import os
import pathlib
import re
import signal
import subprocess
import sys
import time
from collections.abc import Sequence
from typing import Any, Protocol

from ..reading import programs, stored
from ..tools.errors import ProgramFailed
from ..tools.hints import Records
from .membership import Membership
from .rounds import Line, StoredRounds

INCOMPLETE = 75
STOPPED = "stopped by a signal; the same command resumes"
ALL_TASKS = re.compile(r"# (\d+) tasks?:")  # the line below the tasks of a dry run
FAILED, USER_FAULT = 1, 2  # exit codes of clogsweep that a warning does not change


class Search(Protocol):
    """What decides about the rounds: CurveSearch or AngleSearch."""

    end: str

    def first_round(self) -> list[Line]: ...

    def next_round(self, rows: Records, members: Membership) -> list[Line]: ...

    def known(self, rows: Records, members: Membership) -> str: ...

    def costs(self, hours_per_run: float) -> list[str]: ...


class Launcher:
    """Starts clogsweep, and passes warnings on to it: SIGUSR1, SIGTERM and SIGINT all go on as SIGUSR1, the one that
    mpirun and srun forward while they wait for the ranks. A second SIGTERM or SIGINT goes on as it is."""

    SIGNALS = (signal.SIGUSR1, signal.SIGTERM, signal.SIGINT)

    def __init__(self, words: Sequence[str], clogsweep: pathlib.Path) -> None:
        self._command = [*words, str(clogsweep)]
        self._process: subprocess.Popen[str] | None = None
        self.is_warned = self._is_forced = False

    def __enter__(self) -> "Launcher":
        self._before = {number: signal.signal(number, self._warn) for number in self.SIGNALS}
        return self

    def __exit__(self, *_: object) -> None:
        for number, handler in self._before.items():
            signal.signal(number, handler)

    def _warn(self, number: int, _frame: object) -> None:
        again = self.is_warned and number != signal.SIGUSR1
        self.is_warned, self._is_forced = True, again or self._is_forced
        if self._process:
            self._process.send_signal(number if again else signal.SIGUSR1)

    def _start(self, arguments: Sequence[object], **streams: Any) -> subprocess.Popen[str]:
        # In a session of its own: Ctrl-C in a terminal reaches it once, through this process.
        process = subprocess.Popen([*self._command, *map(str, arguments)], stdin=subprocess.DEVNULL, text=True,
                                   start_new_session=True, **streams)
        self._process = process
        if self.is_warned:  # while it started
            process.send_signal(signal.SIGUSR1)
        return process

    def run(self, *arguments: object) -> int:
        """Runs it with the streams of this process. @return its exit code, 75 if it was stopped before its end"""
        if self.is_warned:
            return INCOMPLETE
        code = self._start(arguments).wait()
        self._process = None
        # A warning may end a launcher by its signal, or with a code of its own.
        if self.is_warned and (self._is_forced or code not in (0, FAILED, USER_FAULT)):
            return INCOMPLETE
        return 128 - code if code < 0 else code

    def ask(self, *arguments: object) -> str:
        """@return what it prints. @throws ProgramFailed  with its reason"""
        if self.is_warned:
            raise ProgramFailed(STOPPED, INCOMPLETE)
        process = self._start(arguments, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        out, error = process.communicate()
        self._process = None
        if process.returncode != 0:
            stopped = self.is_warned and process.returncode not in (FAILED, USER_FAULT)
            raise ProgramFailed(STOPPED if stopped else programs.reason(error or out),
                                INCOMPLETE if stopped else process.returncode)
        return out


    def tasks(self, *arguments: object) -> str:
        """What it prints of its tasks in a dry run, which is stopped before it estimates their cost.
        @throws ProgramFailed  with its reason"""
        out: list[str] = []
        if not self.is_warned:
            process = self._start([*arguments, "--dry-run"], stdout=subprocess.PIPE, stderr=subprocess.PIPE)
            assert process.stdout
            for line in process.stdout:
                out.append(line)
                if ALL_TASKS.match(line):
                    process.send_signal(signal.SIGUSR1)
            _, error = process.communicate()
            self._process = None
            if not self.is_warned and not any(map(ALL_TASKS.match, out)):
                raise ProgramFailed(programs.reason(error or "".join(out)), process.returncode)
        if self.is_warned:
            raise ProgramFailed(STOPPED, INCOMPLETE)
        return "".join(out)


class Limits:
    """--max-hours of the whole search."""

    def __init__(self, hours: float) -> None:
        self._end = time.monotonic() + hours * 3600 if hours < 1e9 else None

    def options(self) -> list[str]:
        """For clogsweep, which stops at the same time."""
        return [] if self._end is None else ["--max-hours", repr(max(1e-9, (self._end - time.monotonic()) / 3600))]

    def are_reached(self) -> bool:
        return self._end is not None and time.monotonic() >= self._end


def refine(search: Search, launcher: Launcher, members: Membership, rounds: StoredRounds,
           output: pathlib.Path, options: Sequence[object], limits: Limits, folder: str | os.PathLike[str] | None) -> int:
    """Runs rounds until the search ends. A round is stored before it starts, and a stored one is completed before the
    next is planned. @param options  of clogsweep in every round. @return an exit code of clogsweep"""
    if not (rounds.exists() and output.exists()):
        rounds.begin(search.first_round())
    while True:
        code = launcher.run(*options, "--points", rounds.path, "--output", output, *limits.options())
        if code != 0:
            return code
        rows = stored.read_rows(output, folder)
        lines = search.next_round(rows, members)
        if not lines:
            if "--quiet" not in options:
                print(search.known(rows, members), file=sys.stderr)
            return 0
        if launcher.is_warned or limits.are_reached():
            print(f"clogsweep refine: stopped between two rounds; the same command resumes. Results so far are in {output}",
                  file=sys.stderr)
            return INCOMPLETE
        rounds.add(lines)
