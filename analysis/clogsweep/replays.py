"""Rows of a sweep run once more by clogrun, for what is not in them: h, v and A on the way, outlines."""

import concurrent.futures
import os
import pathlib
import shlex
import tempfile

from . import trajectory
from .errors import UserError
from .programs import run_program

# What may differ between a row and the same run once more.
CIRCUMSTANCES = {"task", "wall_seconds", "rank", "host", "attempt"}


def is_of(known, row, options):
    """Is this trajectory what the row's run gives with these options?"""
    return shlex.split(known.attributes["command_line"])[4:-2] == options and known.row.dtype == row.dtype and all(
        known.row[column].tobytes() == row[column].tobytes() for column in set(row.dtype.names) - CIRCUMSTANCES)


def follow(clogrun, sweep, row, folder, options):
    """The trajectory of a row, in a file of the folder, which is reused if it holds the same already.

    @param clogrun  the program; None: nothing is to be run
    """
    file = pathlib.Path(folder) / f"{sweep.stem}-{row['task']}.h5"
    known = trajectory.read(file, needs_frames=False) if file.exists() else None
    if known is not None and is_of(known, row, options):
        return known
    if clogrun is None:
        raise UserError(f"{file} is {'not there' if known is None else 'another run'}; leave out --draw-only")
    # clogrun never overwrites; the old one goes when the new one is whole. Another script may do the same run.
    with tempfile.TemporaryDirectory(prefix=f"{file.stem}-", dir=folder) as place:
        fresh = pathlib.Path(place) / file.name
        run_program(clogrun, "replay", sweep, row["task"], *options, "--output", fresh)
        os.replace(fresh, file)
    return trajectory.read(file, needs_frames=False)


def follow_all(clogrun, sweep, rows, folder, jobs, samples, outlines=None):
    """The same of several rows, some at a time. @param samples, outlines  time between two of them [t0]"""
    options = ["--sample-interval", f"{samples:.3g}", *(["--polygon-interval", f"{outlines:.3g}"] if outlines else [])]
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        return list(pool.map(lambda row: follow(clogrun, sweep, row, folder, options), rows))
