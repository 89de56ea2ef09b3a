"""Files of clogsweep and clogrun, opened only if nothing in them is damaged (docs/explanation/survival.md says how that is known)."""

from __future__ import annotations

import contextlib
import os
import re
import sys
import zlib
from collections.abc import Iterator
from typing import TYPE_CHECKING

import h5py
import numpy as np

from .errors import Damaged, UserError
from .hints import AnyPath, Records

if TYPE_CHECKING:
    import pandas

SEAL = re.compile(rb"\nclogsweep seal 1: crc32 ([0-9a-f]{8}) of ([0-9]{20}) bytes\n")
SEAL_SIZE = 64
OLD_VERSIONS = ("2", "3", "4")  # had no checksums
SWEEP, RUN = "sweep", "run"
WRITERS: dict[str | None, str] = {
    SWEEP: "the output of clogsweep", RUN: "the output of clogrun with --polygon-interval", None: "a file of clogsweep or clogrun"}


def is_sealed(path: AnyPath) -> bool | None:
    """Is every bit of the file as it was written? None: its end does not say. @throws Damaged if not"""
    with open(path, "rb") as file:
        content = file.read()
    seal = SEAL.fullmatch(content[-SEAL_SIZE:])
    if not seal:
        return None
    if (int(seal[1], 16), int(seal[2])) != (zlib.crc32(content[:-SEAL_SIZE]), len(content) - SEAL_SIZE):
        raise Damaged(f"cannot trust {path} (damaged: its checksum is not that of its bytes); see clogsweep verify")
    return True


def check_rows(path: AnyPath, file: h5py.File) -> None:
    """Of a file without a seal: every row and every attribute against its own checksum. @throws Damaged"""
    rows, sums = file["runs"][:], file["row_checksums"][:]
    listed = {name: digits for digits, name in (line.split(" ", 1) for line in text(file.attrs["checksums"]).splitlines())}
    actual = {name: zlib.crc32(text(file.attrs.get(name, "")).encode()) for name in listed if not name.endswith(" rows")}
    actual[f"{len(rows)} rows"] = zlib.crc32(sums.tobytes())
    if actual != {name: int(digits, 16) for name, digits in listed.items()} or [zlib.crc32(row.tobytes()) for row in rows] != sums.tolist():
        raise Damaged(f"cannot trust {path} (damaged: rows or attributes are not as they were written); see clogsweep verify")


def text(value: object) -> str:
    return value.decode() if isinstance(value, bytes) else str(value)


def unreadable(path: AnyPath, reason: object, kind: str | None = None) -> UserError:
    """What is to be thrown where a file is not of the kind that is wanted."""
    return UserError(f"cannot read {path} ({reason}); give {WRITERS[kind]}")


def check_kind(path: AnyPath, file: h5py.File, kind: str | None) -> None:
    """@throws UserError"""
    if "runs" not in file:
        raise unreadable(path, "an HDF5 file, but not one of clogsweep or clogrun", kind)
    if kind == SWEEP and "trajectory" in file:
        raise unreadable(path, "holds one run of clogrun, not a sweep", kind)
    if kind == RUN and "trajectory" not in file:
        raise unreadable(path, "holds a sweep, not one run of clogrun", kind)


def kind_of(path: AnyPath) -> str:
    """SWEEP or RUN. @throws as opened()"""
    with opened(path) as file:
        return RUN if "trajectory" in file else SWEEP


def check_checksums(path: AnyPath, file: h5py.File, sealed: bool | None) -> None:
    """Makes the second of the checks, unless the first has been made. @throws Damaged"""
    if text(file.attrs.get("format_version", "")) in OLD_VERSIONS:
        print(f"{path} is of an older format without checksums: damage to it may go unnoticed", file=sys.stderr)
    elif not sealed:
        try:
            check_rows(path, file)
        except (KeyError, ValueError, OSError) as error:
            raise Damaged(f"cannot trust {path} (damaged: {error}); see clogsweep verify") from error


def why_not_open(path: AnyPath, error: OSError) -> str:
    if error.errno:
        return os.strerror(error.errno)
    return str(error) if h5py.is_hdf5(path) else "not an HDF5 file"


@contextlib.contextmanager
def opened(path: AnyPath, kind: str | None = None) -> Iterator[h5py.File]:
    """The file for h5py, read only. @param kind  SWEEP or RUN, if only that will do. @throws Damaged; UserError if it cannot be read"""
    try:
        sealed = is_sealed(path)
        opened_file = h5py.File(path, "r")
    except FileNotFoundError as error:
        raise UserError(f"cannot read {path} (no such file); check the name") from error
    except OSError as error:
        raise unreadable(path, why_not_open(path, error), kind) from error
    with opened_file as file:
        try:
            check_kind(path, file, kind)
            check_checksums(path, file, sealed)
            yield file
        except (OSError, KeyError, ValueError) as error:
            raise unreadable(path, error, kind) from error


def attributes(file: h5py.File) -> dict[str, str]:
    """Of an open file: where it comes from, as text."""
    return {name: text(value) for name, value in file.attrs.items()}


def writer(attributes: dict[str, str]) -> str:
    """Version and commit of the program that wrote a file, in words. Older files have the commit's hash alone."""
    return f"{attributes['version']}, git {attributes.get('git_describe') or attributes['git_hash']}"


def columns_of(rows: Records | np.void) -> tuple[str, ...]:
    """Names of the columns of a table or a row."""
    return rows.dtype.names or ()


def read_rows(path: AnyPath) -> Records:
    """The table of runs, one record per run. @throws as opened()"""
    with opened(path) as file:
        return file["runs"][:]


def unit(meaning: str) -> str:
    """What stands in brackets in the meaning of a column; empty for counts, ratios and words."""
    found = re.search(r"\[(.*?)\]", meaning)
    return found[1] if found else ""


def read_table(path: AnyPath) -> pandas.DataFrame:
    """The same for pandas, with text as text. `attrs` of the table holds the columns' `units` and `meanings`, by name."""
    with opened(path) as file:
        return table_of(file)


def table_of(file: h5py.File) -> pandas.DataFrame:
    """The same of an open file."""
    import pandas  # slow to load, and not needed by all

    rows = file["runs"][:]
    meanings = {name: text(file["runs"].attrs.get(name, "")) for name in rows.dtype.names}
    table = pandas.DataFrame({name: [text(value) for value in rows[name]] if rows.dtype[name].kind == "S" else rows[name]
                              for name in rows.dtype.names})
    table.attrs = {"units": {name: unit(meaning) for name, meaning in meanings.items()}, "meanings": meanings}
    return table
