"""Rounds of a search, as points on disk: stored before they run, so that a kill does not change them."""

import csv
import io
import os
import pathlib
from collections.abc import Iterable, Sequence

from .candidates import number_text

Seeds = tuple[int, int]  # the first one, and how many follow; none: the seeds of the config
Line = tuple[tuple[float, ...], Seeds | None]


def write_durably(path: pathlib.Path, text: str) -> None:
    """Replaces the file in one step, and waits until it is on the disk."""
    draft = path.with_name(path.name + ".new")
    with open(draft, "w", encoding="utf-8") as file:
        file.write(text)
        file.flush()
        os.fsync(file.fileno())
    os.replace(draft, path)
    folder = os.open(path.parent, os.O_RDONLY)
    try:
        os.fsync(folder)
    except OSError:  # some file systems cannot
        pass
    finally:
        os.close(folder)


def points_text(keys: Sequence[str], lines: Iterable[Line], comment: str = "") -> str:
    """A file for clogsweep --points."""
    lines = list(lines)
    out = io.StringIO()
    out.write("".join(f"# {line}\n" for line in comment.splitlines()))
    writer = csv.writer(out, lineterminator="\n")
    with_seeds = any(seeds for _, seeds in lines)
    writer.writerow([*keys, *(["seeds"] if with_seeds else [])])
    for values, seeds in lines:
        of_seeds = [] if seeds is None else [str(seeds[0]) if seeds[1] == 1 else f"{seeds[0]}..{seeds[0] + seeds[1] - 1}"]
        writer.writerow([*map(number_text, values), *of_seeds])
    return out.getvalue()


class StoredRounds:
    """All points of a search so far, in a file that clogsweep --points reads."""

    def __init__(self, path: pathlib.Path, keys: Sequence[str], comment: str) -> None:
        self.path, self._keys, self._comment = path, list(keys), comment

    def exists(self) -> bool:
        return self.path.exists()

    def begin(self, lines: Sequence[Line]) -> None:
        write_durably(self.path, points_text(self._keys, lines, self._comment))

    def add(self, lines: Sequence[Line]) -> None:
        more = points_text(self._keys, lines).split("\n", 1)[1]
        write_durably(self.path, self.path.read_text(encoding="utf-8") + more)
