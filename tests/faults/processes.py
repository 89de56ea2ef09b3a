"""Watches the processes of a program: mpirun, its ranks, their helpers, and the processes that compute."""

import os
import pathlib
import signal
import subprocess
import time

from support import children_of

# The limits do not depend on how busy the machine is.
CPU_SECONDS = 100  # Limit for all processes of a program together; a sweep with sanitizers needs about 30.
IDLE_SECONDS = 100  # Limit on the time in which all processes wait. Waiting for a processor or a disk does not count.
LOOK_SECONDS = 1
BUSY = {"R", "D"}  # states of processes that run, or wait for a processor or a disk
TICKS = os.sysconf("SC_CLK_TCK")


def descend(pid):
    """A process and all its descendants, with one list for each generation."""
    generations = [[pid]]
    while generations[-1]:
        generations.append([child for parent in generations[-1] for child in children_of(parent)])
    return generations[:-1]


def send(pid, number):
    try:
        os.kill(pid, number)
    except ProcessLookupError:
        pass  # The process has ended.


def kill(pids):
    for pid in pids:
        send(pid, signal.SIGKILL)


def status(folder):
    """The state of a process or thread, and its processor time, which includes the time of its ended children. For an
    ended process the state is Z and the time is 0."""
    try:
        fields = (folder / "stat").read_text().rpartition(")")[2].split()
    except (FileNotFoundError, ProcessLookupError):
        return "Z", 0
    return fields[0], sum(map(int, fields[11:15])) / TICKS


def threads(folder):
    try:
        return list((folder / "task").iterdir())
    except (FileNotFoundError, ProcessLookupError):
        return []  # The process has ended.


def is_alive(pid):
    return status(pathlib.Path(f"/proc/{pid}"))[0] != "Z"


class Limits:
    """Distinguishes a program that hangs from a program that a busy machine slows down. In a slow program at least one
    process always has work. In a program that hangs, all processes wait, or some use too much processor time."""

    def __init__(self):
        self.idle_seconds = 0

    def exceeded_by(self, pids, seconds):
        """Inspects processes. @param seconds  time since the last call. @return what is wrong with the processes, or
        None"""
        folders = [pathlib.Path(f"/proc/{pid}") for pid in pids]
        if not any(status(thread)[0] in BUSY for folder in folders for thread in threads(folder)):
            self.idle_seconds += seconds
        if self.idle_seconds > IDLE_SECONDS:
            return f"hangs: it was idle for {IDLE_SECONDS} s"
        if sum(status(folder)[1] for folder in folders) > CPU_SECONDS:
            return f"did not end within {CPU_SECONDS} s of processor time"
        return None


class Hung(Exception):
    """A program did not end by itself. The text states how the test noticed this."""


def wait_for(pid, wait):
    """Waits until a program ends by itself, even if this takes long on a busy machine.

    @param wait  waits for the end, or for a given time, as subprocess does
    @return the result of `wait`
    """
    limits = Limits()
    while True:
        try:
            return wait(timeout=LOOK_SECONDS)
        except subprocess.TimeoutExpired:
            pids = [pid for generation in descend(pid) for pid in generation]
            wrong = limits.exceeded_by(pids, LOOK_SECONDS)
        if wrong:
            raise Hung(wrong)


def are_gone(pids):
    """Whether all processes have ended, or end within the limits."""
    limits = Limits()
    while alive := [pid for pid in pids if is_alive(pid)]:
        if limits.exceeded_by(alive, 0.05):
            return False
        time.sleep(0.05)
    return True
