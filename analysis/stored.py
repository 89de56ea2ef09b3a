"""Files of clogsweep and clogrun, opened only if nothing in them is damaged (src/store/README.md says how that is known)."""

import contextlib
import re
import sys
import zlib

import h5py
from command_line import UserError

SEAL = re.compile(rb"\nclogsweep seal 1: crc32 ([0-9a-f]{8}) of ([0-9]{20}) bytes\n")
SEAL_SIZE = 64
OLD_VERSIONS = ("2", "3", "4")  # had no checksums


class Damaged(UserError):
    """A file that is not as it was written; the message is one line and names the file."""


def is_sealed(path):
    """Is every bit of the file as it was written? None: its end does not say. @throws Damaged if not"""
    with open(path, "rb") as file:
        content = file.read()
    seal = SEAL.fullmatch(content[-SEAL_SIZE:])
    if not seal:
        return None
    if (int(seal[1], 16), int(seal[2])) != (zlib.crc32(content[:-SEAL_SIZE]), len(content) - SEAL_SIZE):
        raise Damaged(f"cannot trust {path} (damaged: its checksum is not that of its bytes); see clogsweep verify")
    return True


def check_rows(path, file):
    """Of a file without a seal: every row and every attribute against its own checksum. @throws Damaged"""
    rows, sums = file["runs"][:], file["row_checksums"][:]
    listed = dict(reversed(line.split(" ", 1)) for line in text(file.attrs["checksums"]).splitlines())
    actual = {name: zlib.crc32(text(file.attrs.get(name, "")).encode()) for name in listed if not name.endswith(" rows")}
    actual[f"{len(rows)} rows"] = zlib.crc32(sums.tobytes())
    if actual != {name: int(digits, 16) for name, digits in listed.items()} or [zlib.crc32(row.tobytes()) for row in rows] != sums.tolist():
        raise Damaged(f"cannot trust {path} (damaged: rows or attributes are not as they were written); see clogsweep verify")


def text(value):
    return value.decode() if isinstance(value, bytes) else str(value)


@contextlib.contextmanager
def opened(path):
    """The file for h5py, read only. @throws Damaged; OSError if it cannot be read"""
    sealed = is_sealed(path)
    with h5py.File(path, "r") as file:
        if text(file.attrs.get("format_version", "")) in OLD_VERSIONS:
            print(f"{path} is of an older format without checksums: damage to it may go unnoticed", file=sys.stderr)
        elif not sealed:
            try:
                check_rows(path, file)
            except (KeyError, ValueError, OSError) as error:
                raise Damaged(f"cannot trust {path} (damaged: {error}); see clogsweep verify") from error
        yield file


def attributes(file):
    """Of an open file: where it comes from, as text."""
    return {name: text(value) for name, value in file.attrs.items()}


def read_rows(path):
    """The table of runs, one record per run. @throws as opened()"""
    with opened(path) as file:
        return file["runs"][:]


def unit(meaning):
    """What stands in brackets in the meaning of a column; empty for counts, ratios and words."""
    found = re.search(r"\[(.*?)\]", meaning)
    return found[1] if found else ""


def read_table(path):
    """The same for pandas, with text as text. `attrs` of the table holds the columns' `units` and `meanings`, by name."""
    import pandas  # slow to load, and not needed by all

    with opened(path) as file:
        rows = file["runs"][:]
        meanings = {name: text(file["runs"].attrs.get(name, "")) for name in rows.dtype.names}
    table = pandas.DataFrame({name: [text(value) for value in rows[name]] if rows.dtype[name].kind == "S" else rows[name]
                              for name in rows.dtype.names})
    table.attrs = {"units": {name: unit(meaning) for name, meaning in meanings.items()}, "meanings": meanings}
    return table
