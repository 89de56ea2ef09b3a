"""Replays rows of a sweep with clogrun, for quantities that the rows do not contain: outlines, and the position h, the
speed v and the shape parameter A along the path."""

import concurrent.futures
import pathlib
import shlex
from collections.abc import Iterable

import numpy as np

from ..tools import outputs
from ..tools.errors import NotThere
from ..tools.hints import AnyPath
from . import stored, trajectory
from .programs import run_program
from .trajectory import Trajectory

# A row and its replay may differ in these columns.
CIRCUMSTANCES = {"task", "wall_seconds", "processor_seconds", "rank", "host", "attempt"}


def replay(clogrun: pathlib.Path, sweep: AnyPath, task: int, output: AnyPath, *options: str) -> None:
    """Replays a row. @throws ProgramFailed  with the reason of clogrun"""
    run_program(clogrun, "replay", sweep, task, *options, "--output", output)


def is_of(known: Trajectory, row: np.void, options: list[str]) -> bool:
    """Whether a trajectory comes from a replay of this row with these options."""
    return shlex.split(known.attributes["command_line"])[4:-2] == options and known.row.dtype == row.dtype and all(
        known.row[column].tobytes() == row[column].tobytes() for column in set(stored.columns_of(row)) - CIRCUMSTANCES)


def follow(clogrun: pathlib.Path | None, sweep: pathlib.Path, row: np.void, folder: AnyPath,
           options: list[str]) -> Trajectory:
    """The trajectory of a row, from a file in the folder. The row is replayed only if the file does not contain its
    trajectory yet.

    @param clogrun  the program; with None no row is replayed
    """
    file = pathlib.Path(folder) / f"{sweep.stem}-{row['task']}.h5"
    known = trajectory.read(file, needs_frames=False) if file.exists() else None
    if known is not None and is_of(known, row, options):
        return known
    if clogrun is None:
        raise NotThere(f"{file} is {'not there' if known is None else 'another run'}; leave out --draw-only")
    # Another script may replay the same row at the same time.
    with outputs.replaced(file) as fresh:
        replay(clogrun, sweep, row["task"], fresh, *options)
    return trajectory.read(file, needs_frames=False)


def follow_all(clogrun: pathlib.Path | None, sweep: pathlib.Path, rows: Iterable[np.void], folder: AnyPath, jobs: int,
               samples: float, outlines: float | None = None) -> list[Trajectory]:
    """The trajectories of several rows, as from follow().
    @param jobs  number of simultaneous replays
    @param samples  time between two samples [t0]
    @param outlines  time between two outlines [t0]"""
    options = ["--sample-interval", f"{samples:.3g}", *(["--polygon-interval", f"{outlines:.3g}"] if outlines else [])]
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        return list(pool.map(lambda row: follow(clogrun, sweep, row, folder, options), rows))
