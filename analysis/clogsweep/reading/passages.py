"""Reads passages through a channel that clogrun wrote, without the outlines of the droplet."""

import os
import sys

import h5py
import numpy as np

from ..tools.errors import UserError
from ..tools.hints import Records
from . import stored
from .rehearsal import is_ours, is_run


def is_hdf5(path: str) -> bool:
    """False for a file that is not there, and for pipes, which may never end."""
    return os.path.isfile(path) and h5py.is_hdf5(path)


def read(path: str) -> tuple[Records, np.void]:
    """Samples and row. A file without a seal, which another program copied or changed, is read with a warning. @throws Damaged; UserError"""
    try:
        if not stored.is_sealed(path):
            stored.look(path)
            print(f"{path} was copied or changed by another program: damage to it may go unnoticed", file=sys.stderr)
        with h5py.File(path, "r") as file:
            if not (is_ours(file) and is_run(file) and "h" in file["trajectory"].dtype.names):
                raise UserError(f"cannot read {path} (not a passage through a channel); give a file written by clogrun channel")
            return file["trajectory"][:], file["runs"][0]
    except OSError as error:
        raise stored.unreadable(path, stored.why_not_open(path, error), stored.RUN) from error
