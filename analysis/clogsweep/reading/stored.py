"""Reads files of clogsweep and clogrun. A file is opened only if nothing in it is damaged
(docs/explanation/survival.md)."""

from __future__ import annotations

import contextlib
import functools
import os
import pathlib
import re
import sys
import zlib
from collections.abc import Iterator
from typing import TYPE_CHECKING

import h5py
import numpy as np

from ..tools.errors import Damaged, ProgramFailed, UserError
from ..tools.hints import AnyPath, Numbers, Records
from ..tools.texts import printable
from . import programs

if TYPE_CHECKING:
    import pandas

SEAL = re.compile(rb"\nclogsweep seal 1: crc32 ([0-9a-f]{8}) of ([0-9]{20}) bytes\n")
SEAL_SIZE = 64
READABLE_VERSIONS = ("9", "10", "11", "12")
SWEEP, RUN = "sweep", "run"
KINDS = {"clogsweep sweep": SWEEP, "clogsweep trajectory": RUN}  # kind of a file by its attribute `kind`
WRITERS: dict[str | None, str] = {
    SWEEP: "the output of clogsweep", RUN: "the output of clogrun with --polygon-interval",
    None: "a file of clogsweep or clogrun"}


def is_sealed(path: AnyPath) -> bool:
    """Whether the file has a seal. @throws Damaged  if the seal does not match the content"""
    with open(path, "rb") as file:
        content = file.read()
    seal = SEAL.fullmatch(content[-SEAL_SIZE:])
    if not seal:
        return False
    if (int(seal[1], 16), int(seal[2])) != (zlib.crc32(content[:-SEAL_SIZE]), len(content) - SEAL_SIZE):
        raise Damaged(f"cannot trust {path} (damaged: its checksum is not that of its bytes); see clogsweep verify")
    return True


def text(value: object) -> str:
    """A word of a table, or lines of an attribute. Unprintable bytes are escaped, because a file from elsewhere may
    contain any bytes."""
    return printable(value.decode(errors="surrogateescape") if isinstance(value, bytes) else value, "\n\t")


def unreadable(path: AnyPath, reason: object, kind: str | None = None) -> UserError:
    """The error for a file of the wrong kind."""
    return UserError(f"cannot read {path} ({reason}); give {WRITERS[kind]}")


def check_kind(path: AnyPath, file: h5py.File, kind: str | None) -> None:
    """Refuses a file of the wrong kind. @throws UserError"""
    found = KINDS.get(text(file.attrs.get("kind", "")))
    if found is None:
        raise unreadable(path, "an HDF5 file, but not one of clogsweep or clogrun", kind)
    version = text(file.attrs["format_version"])
    if version not in READABLE_VERSIONS:
        raise UserError(f"cannot read {path} (format version {version}, "
                        f"this program reads {READABLE_VERSIONS[0]} to {READABLE_VERSIONS[-1]}); "
                        "use the program that wrote it, or compute the rows anew")
    if kind == SWEEP and found == RUN:
        raise unreadable(path, "holds one run of clogrun, not a sweep", kind)
    if kind == RUN and found == SWEEP:
        raise unreadable(path, "holds a sweep, not one run of clogrun", kind)


def kind_of(path: AnyPath, folder: AnyPath | None = None) -> str:
    """The kind of a file, SWEEP or RUN. @throws as opened()"""
    with opened(path, folder=folder) as file:
        return KINDS[text(file.attrs["kind"])]


@functools.lru_cache
def check_copy(path: str, folder: str | None, *_as_it_is: float) -> None:
    """Lets clogsweep check a sweep without a seal, and prints the warnings. A sweep has no seal if another program
    copied or changed the file. The check is repeated only if the file has changed since. @throws Damaged; UserError"""
    try:
        clogsweep = programs.programs_in(folder) / "clogsweep"
    except UserError as error:
        raise UserError(f"cannot check {path}, which has no seal: {error}") from error
    try:
        print(programs.warnings_of(clogsweep, "status", path, "--format", "json"), end="", file=sys.stderr)
    except ProgramFailed as failure:
        reason = str(failure).removeprefix("clogsweep status: ")
        if "(one run of clogrun" in reason:
            raise changed_run(path) from failure
        raise (Damaged if "(damaged: " in reason else UserError)(reason) from failure


def changed_run(path: AnyPath) -> UserError:
    return UserError(f"cannot trust {path} (another program copied or changed it, "
                     "and outlines have no checksums of their own); "
                     "give the file that clogrun wrote, or run the droplet again")


def is_distance_table(path: AnyPath) -> bool:
    """Whether this is the name of a text table rather than of a sweep's file. The rule is that of clogfit."""
    return os.fspath(path).lower().endswith((".csv", ".tsv", ".txt", ".dat"))


def why_not_open(path: AnyPath, error: OSError) -> str:
    if error.errno:
        return os.strerror(error.errno)
    if is_distance_table(path):
        return "not an HDF5 file; clogfit lengths fits measured distances"
    return str(error) if h5py.is_hdf5(path) else "not an HDF5 file"


@contextlib.contextmanager
def opened(path: AnyPath, kind: str | None = None, folder: AnyPath | None = None) -> Iterator[h5py.File]:
    """Opens a file with h5py, read only.
    @param kind  SWEEP or RUN, if only this kind is acceptable
    @param folder  of the programs
    @throws Damaged; UserError  if the file cannot be read"""
    if os.path.exists(path) and not os.path.isfile(path) and not os.path.isdir(path):
        # Reading such a file may never end.
        raise unreadable(path, "not a regular file: a pipe, device or socket", kind)
    try:
        is_whole = is_sealed(path)
        if h5py.is_hdf5(path) and not is_whole:
            if kind == RUN:
                raise changed_run(path)
            now = os.stat(path)
            check_copy(os.path.realpath(path),
                       str(folder) if folder else None, now.st_dev, now.st_ino, now.st_size, now.st_ctime_ns)
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
    """The attributes of an open file as text. Attributes state the provenance of the file. A long attribute is stored
    in parts with the names `config`, `config.2` and so on."""
    parts = {name: text(value) for name, value in file.attrs.items()}
    for name in list(parts):
        if name not in parts:
            continue
        number = 2
        while (part := f"{name}.{number}") in parts:
            parts[name] += parts.pop(part)
            number += 1
    return parts


def writer(attributes: dict[str, str]) -> str:
    """The version and commit of the program that wrote a file, in words. Files from before version 0.2.0 have only the
    hash of the commit. A salvaged file may have neither."""
    commit = attributes.get("git_describe") or attributes.get("git_hash") or "unknown"
    return f"{attributes.get('version', 'of unknown version')}, git {commit}"


def source(attributes: dict[str, str]) -> str:
    """The provenance of a file's rows, to be shown with a picture of these rows. @param attributes  of the file"""
    began = f", begun {attributes['start_time']}" if "start_time" in attributes else ""
    return f"clogsweep {writer(attributes)}{began}\n{attributes.get('command_line', '')}".strip()


def settings(config: str) -> dict[str, str]:
    """The keys and values of a stored config. A stored config has all keys. A default that follows from other keys is a
    word such as `auto`."""
    pairs = [line.partition(" = ") for line in config.split("\n")]
    of_points = {key for name, _, keys in pairs if name == "point-keys" for key in keys.split()}
    return {key: unescaped(value) for key, equals, value in pairs if equals and key not in of_points}


def values(config: str, key: str) -> list[str]:
    """All values that a stored config gives to a key. The parameter sets of a sweep may be single points."""
    pairs = [line.split(" = ", 1) for line in config.split("\n") if " = " in line]
    keys = dict(pairs).get("point-keys", "").split()
    return [value for name, value in pairs if name == key] + [value.split()[keys.index(key)] for name, value in pairs if name == "point" and key in keys]


def unescaped(value: str) -> str:
    r"""A value of a config as the user gave it. In the stored text, \x and two hexadecimal digits stand for a control
    character, #, or a backslash."""
    return re.sub(r"\\x([0-9a-fA-F]{2})", lambda found: chr(int(found[1], 16)), value)


def circle_files(file: h5py.File) -> dict[str, str]:
    """The names of the files of user-supplied circles, by the checksums in the rows."""
    return {sum_: pathlib.Path(text(circles.attrs["file"])).name
            for sum_, circles in file.get("obstacles", {}).items() if "file" in circles.attrs}


def circles(file: h5py.File) -> dict[str, Numbers]:
    """User-supplied circles by their checksums: x, y and radius [sigma]. A radius of 0 means half of the row's
    obstacle_diameter."""
    return {sum_: np.column_stack([circles[name] for name in ("x", "y", "radius")])
            for sum_, circles in file.get("obstacles", {}).items()}


def columns_of(rows: Records | np.void) -> tuple[str, ...]:
    """Names of the columns of a table or a row."""
    return rows.dtype.names or ()


def observed_distances(rows: Records) -> Numbers:
    """The distance up to which each run was observed [sigma]. A failed run was observed up to its last passed check. In
    files of version 1.0 this distance is unknown (NaN), except for droplets that crossed themselves."""
    if "sound_distance" in columns_of(rows):
        of_failed = rows["sound_distance"]
    else:
        has_crossed = np.char.startswith(rows["message"], b"the interface crossed itself")
        of_failed = np.where(has_crossed, rows["distance"], np.nan)
    return np.where(rows["status"] == b"failed", of_failed, rows["distance"])


def warn_of_failures(rows: Records, outcome: str) -> None:
    """If runs failed, prints how many. @param outcome  the word for the assumed outcome of these runs, such as whole"""
    failed = rows[rows["status"] == b"failed"]
    if len(failed):
        print(f"{len(failed)} of {len(rows)} runs failed and count as {outcome}; the first one: "
              f"{text(failed['message'][0])}", file=sys.stderr)


def read_rows(path: AnyPath, folder: AnyPath | None = None) -> Records:
    """Reads the table of runs, with one record per run. @throws as opened()"""
    with opened(path, folder=folder) as file:
        return file["runs"][:]


def unit(meaning: str) -> str:
    """The unit of a column, which the column's description has in brackets. Counts, ratios and words have an empty
    unit."""
    found = re.search(r"\[(.*?)\]", meaning)
    return found[1] if found else ""


def read_table(path: AnyPath, folder: AnyPath | None = None) -> pandas.DataFrame:
    """Reads the table of runs for pandas, with text as strings. The table's `attrs` contain `units` and `meanings`,
    dictionaries by column name."""
    with opened(path, folder=folder) as file:
        return table_of(file)


def table_of(file: h5py.File, name: str = "runs") -> pandas.DataFrame:
    """The table of runs in an open file, for pandas. @param name  of another table"""
    import pandas  # pandas is slow to load, and not always needed.

    rows = file[name][:]
    meanings = {column: text(file[name].attrs.get(column, "")) for column in rows.dtype.names}
    table = pandas.DataFrame({column: [text(value) for value in rows[column]] if rows.dtype[column].kind == "S"
                              else rows[column] for column in rows.dtype.names})
    table.attrs = {"units": {column: unit(meaning) for column, meaning in meanings.items()}, "meanings": meanings}
    return table


def droplets(file: h5py.File) -> pandas.DataFrame:
    """The table of droplets, with one row for each member of a family; empty without break-up=daughters."""
    import pandas

    return table_of(file, "droplets") if "droplets" in file else pandas.DataFrame({"task": [], "path": []})
