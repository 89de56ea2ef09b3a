"""The processes of a program: mpirun, its ranks, their helpers, the processes that compute."""

import os
import signal
import time

from support import children_of

GONE_SECONDS = 60  # killed processes are gone at once; a machine may be busy


def descend(pid):
    """The process and all that it began, one list for each generation."""
    generations = [[pid]]
    while generations[-1]:
        generations.append([child for parent in generations[-1] for child in children_of(parent)])
    return generations[:-1]


def send(pid, number):
    try:
        os.kill(pid, number)
    except ProcessLookupError:
        pass  # it has ended


def kill(pids):
    for pid in pids:
        send(pid, signal.SIGKILL)


def is_alive(pid):
    try:
        with open(f"/proc/{pid}/stat") as file:
            return file.read().rpartition(")")[2].split()[0] != "Z"
    except (FileNotFoundError, ProcessLookupError):
        return False


def are_gone(pids):
    """Have all of them ended, or do they at once?"""
    deadline = time.monotonic() + GONE_SECONDS
    while any(map(is_alive, pids)):
        if time.monotonic() > deadline:
            return False
        time.sleep(0.05)
    return True
