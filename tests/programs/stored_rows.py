"""Puts other results into a sweep's file, with checksums that are right: the file's format once more, in Python."""

import zlib

import h5py
import numpy as np


def change(path, edit):
    """@param edit  called with the rows, to be changed in place. What clogsweep wrote behind the file's end goes."""
    with h5py.File(path, "r+") as file:
        rows = file["runs"][:]
        edit(rows)
        sums = np.array([zlib.crc32(row.tobytes()) for row in rows], dtype=np.uint32)
        file["runs"][:], file["row_checksums"][:] = rows, sums
        lines = file.attrs["checksums"].decode().splitlines()
        lines[0] = f"{zlib.crc32(sums.tobytes()):08x} {len(rows)} rows"
        file.attrs["checksums"] = np.bytes_("\n".join(lines) + "\n")
    return rows


def change_columns(path, **columns):
    def edit(rows):
        for name, values in columns.items():
            rows[name] = values

    return change(path, edit)


def make_older(path, version, without=()):
    """Makes the file one of an older format: no checksums, fewer columns."""
    with h5py.File(path, "r+") as file:
        table = file["runs"][:]
        del file["runs"], file["row_checksums"]
        kept = [(name, table.dtype[name]) for name in table.dtype.names if name not in without]
        file.create_dataset("runs", data=table[[name for name, _ in kept]].astype(kept), chunks=(64,), maxshape=(None,))
        file.attrs["format_version"] = np.bytes_(version)
        del file.attrs["checksums"]
