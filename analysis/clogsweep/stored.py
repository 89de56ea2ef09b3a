"""Files of clogsweep and clogrun, opened only if nothing in them is damaged (docs/explanation/survival.md says how that is known)."""

from __future__ import annotations

import contextlib
import functools
import os
import re
import sys
import zlib
from collections.abc import Iterator
from typing import TYPE_CHECKING

import h5py
import numpy as np

from . import programs
from .errors import Damaged, ProgramFailed, UserError
from .hints import AnyPath, Records

if TYPE_CHECKING:
    import pandas

SEAL = re.compile(rb"\nclogsweep seal 1: crc32 ([0-9a-f]{8}) of ([0-9]{20}) bytes\n")
SEAL_SIZE = 64
OLD_VERSIONS = ("2", "3", "4")  # had no checksums
SWEEP, RUN = "sweep", "run"
WRITERS: dict[str | None, str] = {
    SWEEP: "the output of clogsweep", RUN: "the output of clogrun with --polygon-interval", None: "a file of clogsweep or clogrun"}


def is_sealed(path: AnyPath) -> bool:
    """Is every bit of the file as it was written? Or does its end not say? @throws Damaged if it is not"""
    with open(path, "rb") as file:
        content = file.read()
    seal = SEAL.fullmatch(content[-SEAL_SIZE:])
    if not seal:
        return False
    if (int(seal[1], 16), int(seal[2])) != (zlib.crc32(content[:-SEAL_SIZE]), len(content) - SEAL_SIZE):
        raise Damaged(f"cannot trust {path} (damaged: its checksum is not that of its bytes); see clogsweep verify")
    return True


def text(value: object) -> str:
    return value.decode() if isinstance(value, bytes) else str(value)


def unreadable(path: AnyPath, reason: object, kind: str | None = None) -> UserError:
    """What is to be thrown where a file is not of the kind that is wanted."""
    return UserError(f"cannot read {path} ({reason}); give {WRITERS[kind]}")


def is_table(part: object) -> bool:
    """With a row for each of something, and named columns? What pandas writes of its own is a group."""
    return isinstance(part, h5py.Dataset) and part.ndim == 1 and part.dtype.names is not None


def check_kind(path: AnyPath, file: h5py.File, kind: str | None) -> None:
    """@throws UserError"""
    if "format_version" not in file.attrs or not all(is_table(file[name]) for name in ("runs", "trajectory") if name in file) or "runs" not in file:
        raise unreadable(path, "an HDF5 file, but not one of clogsweep or clogrun", kind)
    if kind == SWEEP and "trajectory" in file:
        raise unreadable(path, "holds one run of clogrun, not a sweep", kind)
    if kind == RUN and "trajectory" not in file:
        raise unreadable(path, "holds a sweep, not one run of clogrun", kind)


def kind_of(path: AnyPath, folder: AnyPath | None = None) -> str:
    """SWEEP or RUN. @throws as opened()"""
    with opened(path, folder=folder) as file:
        return RUN if "trajectory" in file else SWEEP


def rehearse(path: AnyPath) -> None:
    """Reads all of a file in a process that may die, as HDF5 does of some damage. @throws Damaged if it does"""
    process = os.fork()
    if process == 0:
        code = 1
        with contextlib.suppress(Exception), open(os.devnull, "w") as nowhere:
            os.dup2(nowhere.fileno(), 2)
            with h5py.File(path, "r") as file:
                attributes(file)
                file.visititems(lambda _, part: part[()] if isinstance(part, h5py.Dataset) else None)
            code = 0
        os._exit(code)
    if os.waitpid(process, 0)[1] != 0:
        raise Damaged(f"cannot trust {path} (damaged: reading it fails); put a copy in its place")


def ask_clogsweep(path: AnyPath, folder: AnyPath | None) -> None:
    """Has the program check rows, attributes and types of a sweep, and say what it has to say. @throws Damaged"""
    try:
        said = programs.warnings_of(programs.programs_in(folder) / "clogsweep", "status", path, "--format", "json")
    except ProgramFailed as failure:
        raise Damaged(str(failure).removeprefix("clogsweep status: ")) from failure
    print(said, end="", file=sys.stderr)


@functools.lru_cache
def check_copy(path: str, folder: str | None, _changed: int) -> None:
    """Of a file without a seal, which another program has copied or changed. Once for each, as it was then. @throws Damaged; UserError"""
    rehearse(path)
    with h5py.File(path, "r") as file:
        is_old = text(file.attrs.get("format_version", "")) in OLD_VERSIONS
        is_run = "trajectory" in file
    if is_run and is_old:
        print(f"{path} is of an older format without checksums: damage to it may go unnoticed", file=sys.stderr)
    elif is_run:
        raise UserError(f"cannot trust {path} (another program copied or changed it, and outlines have no checksums of their own); "
                        "give the file that clogrun wrote, or run the droplet once more")
    else:
        ask_clogsweep(path, folder)


def why_not_open(path: AnyPath, error: OSError) -> str:
    if error.errno:
        return os.strerror(error.errno)
    return str(error) if h5py.is_hdf5(path) else "not an HDF5 file"


@contextlib.contextmanager
def opened(path: AnyPath, kind: str | None = None, folder: AnyPath | None = None) -> Iterator[h5py.File]:
    """The file for h5py, read only. @param kind  SWEEP or RUN, if only that will do; @param folder  of the programs.
    @throws Damaged; UserError if it cannot be read"""
    if os.path.exists(path) and not os.path.isfile(path) and not os.path.isdir(path):
        raise unreadable(path, "not a regular file: a pipe, device or socket", kind)  # which may never end
    try:
        is_whole = is_sealed(path)
        if h5py.is_hdf5(path) and not is_whole:
            check_copy(str(path), str(folder) if folder else None, os.stat(path).st_mtime_ns)
        opened_file = h5py.File(path, "r")
    except FileNotFoundError as error:
        raise UserError(f"cannot read {path} (no such file); check the name") from error
    except OSError as error:
        raise unreadable(path, why_not_open(path, error), kind) from error
    with opened_file as file:
        try:
            check_kind(path, file, kind)
            yield file
        except (OSError, KeyError, ValueError) as error:
            raise unreadable(path, error, kind) from error


def attributes(file: h5py.File) -> dict[str, str]:
    """Of an open file: where it comes from, as text."""
    return {name: text(value) for name, value in file.attrs.items()}


def writer(attributes: dict[str, str]) -> str:
    """Version and commit of the program that wrote a file, in words. Older files have the commit's hash alone."""
    return f"{attributes['version']}, git {attributes.get('git_describe') or attributes['git_hash']}"


def source(attributes: dict[str, str]) -> str:
    """Where the rows of a file come from, for whoever finds a picture of them. @param attributes  of the file"""
    return f"clogsweep {writer(attributes)}, begun {attributes['start_time']}\n{attributes['command_line']}"


def columns_of(rows: Records | np.void) -> tuple[str, ...]:
    """Names of the columns of a table or a row."""
    return rows.dtype.names or ()


def read_rows(path: AnyPath, folder: AnyPath | None = None) -> Records:
    """The table of runs, one record per run. @throws as opened()"""
    with opened(path, folder=folder) as file:
        return file["runs"][:]


def unit(meaning: str) -> str:
    """What stands in brackets in the meaning of a column; empty for counts, ratios and words."""
    found = re.search(r"\[(.*?)\]", meaning)
    return found[1] if found else ""


def read_table(path: AnyPath, folder: AnyPath | None = None) -> pandas.DataFrame:
    """The same for pandas, with text as text. `attrs` of the table holds the columns' `units` and `meanings`, by name."""
    with opened(path, folder=folder) as file:
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
