"""Reads passages through a channel that clogrun wrote, without the outlines of the droplet."""

import pathlib
import sys

import h5py
import numpy as np

from ..tools.errors import UserError
from ..tools.hints import Records
from . import stored
from .rehearsal import is_run

HDF5_SIGNATURE = b"\x89HDF\r\n\x1a\n"


def is_hdf5(path: str) -> bool:
    """False for a file that is not there, and for pipes, which may never end."""
    if not pathlib.Path(path).is_file():
        return False
    with open(path, "rb") as file:
        return file.read(len(HDF5_SIGNATURE)) == HDF5_SIGNATURE


def read(path: str) -> tuple[Records, np.void]:
    """Samples and row of a passage. A file without a seal, which another program copied or changed, is read with a warning.

    @throws Damaged; UserError  for a file of another kind
    """
    try:
        if not stored.is_sealed(path):
            if not stored.look(path)["is_ours"]:
                raise UserError(f"cannot read {path} (an HDF5 file, but not one of clogrun); give a file written by clogrun channel")
            print(f"{path} was copied or changed by another program: damage to it may go unnoticed", file=sys.stderr)
        with h5py.File(path, "r") as file:
            if not is_run(file):
                raise UserError(f"cannot read {path} (holds a sweep, not a trajectory); give a file written by clogrun channel")
            table, row = file["trajectory"][:], file["runs"][0]
    except OSError as error:
        raise stored.unreadable(path, stored.why_not_open(path, error), stored.RUN) from error
    if "h" not in table.dtype.names:
        raise UserError(f"cannot read {path} (not a passage through a channel); give a file written by clogrun channel")
    return table, row
