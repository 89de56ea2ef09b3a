"""Changes results in a sweep's file, and makes the checksums correct again. This module is a second implementation of
the format, in Python."""

import zlib

import h5py
import numpy as np


def edited(path, edit):
    """Changes a file. @param edit  is called with the open file; afterwards checksums and seal are made to agree with
    the file"""
    content = path.read_bytes()
    path.write_bytes(content[:content.rindex(b"\nclogsweep seal")])
    with h5py.File(path, "r+") as file:
        edit(file)
        names = [line.split(" ", 1)[1] for line in file.attrs["checksums"].decode().splitlines()[1:]]
        names = [name for name in names if name in file.attrs]
        names += [name for name in file.attrs if name not in {"checksums", *names}]
        rows = file["runs"][:]
        sums = np.array([zlib.crc32(row.tobytes()) for row in rows], dtype=np.uint32)
        file["row_checksums"][:] = sums
        lines = [(zlib.crc32(sums.tobytes()), f"{len(rows)} rows"),
                 *((zlib.crc32(file.attrs[name]), name) for name in names)]
        file.attrs["checksums"] = np.bytes_("".join(f"{digits:08x} {name}\n" for digits, name in lines))
    content = path.read_bytes()
    path.write_bytes(content + b"\nclogsweep seal 1: crc32 %08x of %020d bytes\n" % (zlib.crc32(content), len(content)))


def change(path, edit):
    """Changes the rows of a file. @param edit  is called with the rows, and changes them in place; the stability
    follows the status"""
    def edit_rows(file):
        rows = file["runs"][:]
        before = rows["status"].copy()
        edit(rows)
        if "stability" in rows.dtype.names:
            changed = rows["status"] != before
            rows["stability"][changed] = np.where(rows["status"][changed] == b"clogged", b"stable", b"none")
        file["runs"][:] = rows

    edited(path, edit_rows)


def change_attribute(path, name, text):
    edited(path, lambda file: file.attrs.__setitem__(name, np.bytes_(text)))


def change_columns(path, **columns):
    def edit(rows):
        for name, values in columns.items():
            rows[name] = values

    change(path, edit)


def fail(rows, which, distance, sound_distance, failed_by=b"crossing"):
    """Changes rows to those of failed runs. @param which  mask of these rows; the other arguments are their results"""
    for name, value in {"status": b"failed", "failed_by": failed_by, "message": b"made to fail",
                        "clogged_by": b"none", "mechanism": b"none", "distance": distance,
                        "sound_distance": sound_distance, "lateral_displacement": distance}.items():
        rows[name][which] = value


def columns(path):
    with h5py.File(path) as file:
        return file["runs"].dtype.names


def make_older(path, version, without=()):
    """Gives the file an older format version, and removes columns."""
    def edit(file):
        table = file["runs"][:]
        del file["runs"]
        kept = [(name, table.dtype[name]) for name in table.dtype.names if name not in without]
        file.create_dataset("runs", data=table[[name for name, _ in kept]].astype(kept), chunks=(64,), maxshape=(None,))
        file.attrs["format_version"] = np.bytes_(version)
        file.attrs.pop("num_columns", None)

    edited(path, edit)
