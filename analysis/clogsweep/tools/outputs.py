"""Decides where an output file may be written and what it may replace. Only complete files appear."""

import contextlib
import os
import pathlib
import shutil
import tempfile
from collections.abc import Iterator

from .errors import UserError

# Whether this process is a command. Pictures of commands do not depend on the user's settings of matplotlib.
are_of_command = False

# The first bytes of the files that commands make.
BEGINNINGS = {"html": b"<!DOCTYPE html>", "png": b"\x89PNG\r\n", "pdf": b"%PDF-",
              "vtk": b"<?xml", "csv": b"# circles of ", "text": b""}


def refuse_unwritable(path: pathlib.Path, kind: str, *inputs: pathlib.Path) -> None:
    """Checks that a file can be written, so that no long computation is lost. The file may replace an earlier file of
    the same kind, but no other file.

    @param kind  a key of BEGINNINGS
    @param inputs  files that the command reads
    """
    if not path.parent.is_dir():
        raise UserError(f"cannot write {path} (no folder {path.parent}); make it first")
    if path.is_dir():
        raise UserError(f"cannot write {path} (it is a folder); give the name of a file")
    if path.exists() and not path.is_file():
        raise UserError(f"cannot write {path} (not a regular file: a pipe, device or socket); "
                        "give another name, or move it away")
    target = path.resolve()
    if not (os.access(target.parent, os.W_OK) and os.access(target if target.exists() else target.parent, os.W_OK)):
        raise UserError(f"cannot write {path} (permission denied); give another --output")
    if any(path.exists() and source.exists() and path.samefile(source) for source in inputs):
        raise UserError(f"will not overwrite {path} (it is an input); give another --output")
    if path.is_file() and not is_of_kind(path, kind):
        reason = "it was not made by this command" if kind == "csv" else f"it is no {kind.upper()} file"
        raise UserError(f"will not overwrite {path} ({reason}); give another --output, or remove it first")


def is_of_kind(path: pathlib.Path, kind: str) -> bool:
    """Whether the file begins as files of this kind do, or is empty."""
    with open(path, "rb") as file:
        beginning = file.read(len(BEGINNINGS[kind]))
    return not beginning or beginning == BEGINNINGS[kind]


@contextlib.contextmanager
def replaced(path: str | os.PathLike[str]) -> Iterator[pathlib.Path]:
    """A temporary path for a file. When the block ends, this file replaces `path`. If the block fails, an earlier file
    is kept.
    @throws UserError  if the file cannot be written"""
    target = pathlib.Path(path).resolve()  # If `path` is a link, the link remains and points to the new file.
    try:
        with tempfile.TemporaryDirectory(prefix=".clogsweep-", dir=target.parent) as folder:
            fresh = pathlib.Path(folder) / target.name
            yield fresh
            if target.exists():
                shutil.copymode(target, fresh)
            os.replace(fresh, target)
    except OSError as error:
        raise UserError(f"cannot write {path} ({error.strerror or error}); "
                        "look at the folder and its disk, or give another --output") from error


# Endings of pictures and films. Other text after a dot may be a part of the name, as in gap-0.3.
ENDINGS = (".png", ".pdf", ".mp4", ".gif", ".jpg", ".jpeg", ".svg", ".eps", ".ps", ".tif", ".tiff", ".bmp", ".webp",
           ".avi", ".mov", ".mkv", ".webm", ".mpg", ".mpeg", ".apng")


def refuse_ending(output: pathlib.Path, *made: str) -> None:
    """Refuses a name with the ending of another format. @param made  the available endings. @throws UserError"""
    if output.suffix.lower() in ENDINGS and output.suffix not in made:
        raise UserError(f"cannot write {output} (it can only be {' or '.join(made)}); give another ending, or none")


def refuse_unwritable_picture(output: str | os.PathLike[str], *inputs: pathlib.Path) -> None:
    """Refuses a path if one of the two files of style.save() cannot be written. @param output  path without ending"""
    refuse_ending(pathlib.Path(output), ".png", ".pdf")
    for kind in ("png", "pdf"):
        refuse_unwritable(pathlib.Path(f"{output}.{kind}"), kind, *inputs)
