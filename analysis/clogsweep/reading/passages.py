"""Reads passages through a channel that clogrun wrote. The outlines of the droplet are not read."""

import multiprocessing
import os
import resource
import sys
from concurrent.futures.process import BrokenProcessPool, ProcessPoolExecutor

import h5py
import numpy as np

from ..tools.errors import Damaged, UserError
from ..tools.hints import Records
from . import stored

READING_SECONDS = 10  # Limit on the processor time of reading [s]. A passage has only a few thousand samples.


def is_hdf5(path: str) -> bool:
    """Whether the path leads to an HDF5 file. Pipes are not opened, because reading from them may never end."""
    return os.path.isfile(path) and h5py.is_hdf5(path)


def read_samples(path: str) -> tuple[Records, np.void]:
    with h5py.File(path, "r") as file:
        if stored.KINDS.get(stored.text(file.attrs.get("kind", ""))) != stored.RUN or "h" not in file["trajectory"].dtype.names:
            raise UserError(f"cannot read {path} (not a passage through a channel); give a file written by clogrun channel")
        stored.check_kind(path, file, stored.RUN)
        table = file["trajectory"]
        # The table is never compressed, so all its bytes must be in the file.
        if table.nbytes > table.id.get_storage_size():
            raise ValueError(f"the file cannot hold {len(table)} samples")
        return table[:], file["runs"][0]


def limit_reading() -> None:
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    resource.setrlimit(resource.RLIMIT_CPU, (READING_SECONDS, READING_SECONDS))


def read_in_child(path: str) -> tuple[Records, np.void]:
    """Reads the file in a child process, because HDF5 may crash or never end on damaged files. @throws Damaged;
    UserError"""
    with ProcessPoolExecutor(1, multiprocessing.get_context("spawn"), limit_reading) as child:
        try:
            return child.submit(read_samples, path).result()
        except (BrokenProcessPool, OSError, KeyError, ValueError, MemoryError) as error:
            raise Damaged(f"cannot trust {path} (damaged: reading it fails); restore it from a copy, or run the droplet again") from error


def read(path: str) -> tuple[Records, np.void]:
    """Reads samples and row. A file without a seal was copied or changed by another program; it is read with a warning.
    @throws Damaged; UserError"""
    try:
        if stored.is_sealed(path):
            return read_samples(path)
    except OSError as error:
        raise stored.unreadable(path, stored.why_not_open(path, error), stored.RUN) from error
    found = read_in_child(path)
    print(f"{path} was copied or changed by another program: damage to it may go unnoticed", file=sys.stderr)
    return found
