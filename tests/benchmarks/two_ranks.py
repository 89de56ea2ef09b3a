"""Compares the speed of two ranks with that of one rank. Both compute the same sweep, in which all runs have equal
lengths. The program alternates several times between one rank and two ranks.

    two_ranks.py FOLDER_OF_PROGRAMS

Steps per second are meaningful only on two cores that nobody else uses. Steps per second of CPU time show the cost of
the scheduler even on shared cores.
"""

import pathlib
import resource
import statistics
import subprocess
import sys
import tempfile
import time

import h5py

MPIRUN = pathlib.Path(__file__).resolve().parents[1] / "mpirun.sh"
SWEEP = ["vertices=64", "box=20", "obstacle-density=saturated", "obstacle-gap=1.2", "max-time=4000", "seeds=1..24"]
REPEATS = 3


def measure(clogsweep, num_ranks):
    """Steps per second, and steps per second of CPU time, both in millions."""
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "s.h5"

        def cpu():
            usage = resource.getrusage(resource.RUSAGE_CHILDREN)
            return usage.ru_utime + usage.ru_stime

        cpu_before, begin = cpu(), time.monotonic()
        subprocess.run([MPIRUN, str(num_ranks), clogsweep, *SWEEP, "--output", file], check=True, capture_output=True)
        wall, used = time.monotonic() - begin, cpu() - cpu_before
        with h5py.File(file) as sweep:
            steps = sweep["runs"]["steps"].sum() / 1e6
    return steps / wall, steps / used


clogsweep = pathlib.Path(sys.argv[1]) / "clogsweep"
rates = {1: [], 2: []}
for _ in range(REPEATS):
    for num_ranks in rates:
        rates[num_ranks].append(measure(clogsweep, num_ranks))
wall = {n: statistics.median(rate[0] for rate in rates[n]) for n in rates}
cpu = {n: statistics.median(rate[1] for rate in rates[n]) for n in rates}
print(f"million steps/s: one rank {wall[1]:.3f}, two ranks {wall[2]:.3f}: {wall[2] / wall[1]:.2f} times as many; "
      f"per second of CPU time {cpu[1]:.3f}, {cpu[2]:.3f}: {2 * cpu[2] / cpu[1]:.2f} times on idle cores")
