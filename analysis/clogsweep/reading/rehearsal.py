"""Determines the kind of a file by reading all of it. HDF5 may crash on damage, so this runs as a separate script."""

import json
import os
import resource
import sys

import h5py

MOST_COMPRESSED = 1100  # zlib does not exceed 1032
SECONDS = 10
BYTES_A_SECOND = 50_000_000


def is_table(part: object) -> bool:
    """Is it a dataset with named columns? (A table written by pandas itself is a group.)"""
    return isinstance(part, h5py.Dataset) and part.ndim == 1 and part.dtype.names is not None


def is_run(file: h5py.File) -> bool:
    return "trajectory" in file


def is_ours(file: h5py.File) -> bool:
    """Does it look like a file of clogsweep or clogrun?"""
    if "format_version" not in file.attrs or "runs" not in file:
        return False
    return is_table(file["runs"]) and (not is_run(file) or is_table(file["trajectory"]))


def read(part: object) -> None:
    if not isinstance(part, h5py.Dataset):
        return
    if part.nbytes > MOST_COMPRESSED * part.id.get_storage_size():
        raise ValueError(f"{part.name} is larger than what is stored of it")
    part[()]


def rehearse(path: str) -> None:
    seconds = SECONDS + os.path.getsize(path) // BYTES_A_SECOND
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds))
    with h5py.File(path, "r") as file:
        version = file.attrs.get("format_version", "")
        found = {"is_ours": is_ours(file), "is_run": is_run(file), "format_version": version.decode(errors="backslashreplace") if isinstance(version, bytes) else str(version)}
        if found["is_ours"]:
            dict(file.attrs)
            dict(file["runs"].attrs)
            file.visititems(lambda _, part: read(part))
    print(json.dumps(found))


if __name__ == "__main__":
    rehearse(sys.argv[1])
