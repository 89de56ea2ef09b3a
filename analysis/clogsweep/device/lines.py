"""Joins lines that are drawn separately but form closed outlines, such as the three sides of a triangle."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..tools.errors import UserError
from ..tools.hints import Numbers
from .libraries import library
from .shapes import Drawing

MISSED = 1e-5  # Ends of lines meet if their distance is at most this fraction of the size of all lines.


def join(drawing: Drawing) -> None:
    """Moves the pieces that form closed outlines to `outlines`, and all other pieces to `lines`. Without shapely, all
    pieces become `lines`."""
    pieces = [(kind, piece) for kind, piece in drawing.pieces if np.ptp(piece, axis=0).max() > 0]
    if not pieces:
        return
    try:
        geometry, ops, prepared = (library(f"shapely.{name}", "python3-shapely")
                                   for name in ("geometry", "ops", "prepared"))
    except UserError:
        drawing.can_join = False
        drawing.lines = pieces
        return
    tolerance = MISSED * float(np.ptp(np.vstack([piece for _, piece in pieces]), axis=0).max())
    shapes = [geometry.LineString(piece) for piece in meeting([piece for _, piece in pieces], tolerance)]
    faces: list[Any] = []
    left = list(range(len(pieces)))
    # Lines that meet at their ends come first. In this way a centre line does not cut a post in two. Lines that cross
    # come second.
    for cut in (distinct, ops.unary_union):
        found = [face for face in ops.polygonize(cut([shapes[index] for index in left])) if face.is_valid]
        near = ops.unary_union([face.boundary for face in found]).buffer(tolerance)
        within = prepared.prep(near)
        left = [index for index in left if not within.contains(shapes[index]) and is_off(near, shapes[index])]
        faces += found
    drawing.joined = len(pieces) - len(left), len(faces)
    drawing.outlines += [np.asarray(face.exterior.coords)[:-1] for face in faces]
    drawing.lines = [pieces[index] for index in left]


def distinct(shapes: list[Any]) -> list[Any]:
    """Keeps one of several lines that are drawn at the same place."""
    return list({shape.normalize().wkb: shape for shape in shapes}.values())


def is_off(outlines: Any, line: Any) -> bool:
    """Whether more than half of a line is outside the outlines."""
    return bool(line.difference(outlines).length > line.length / 2)


def meeting(pieces: list[Numbers], tolerance: float) -> list[Numbers]:
    """The pieces, after ends that nearly meet were moved to the same place."""
    known: dict[tuple[int, int], Numbers] = {}

    def place(end: Numbers) -> Numbers:
        i, j = (int(cell) for cell in np.floor(end / tolerance))
        for cell in ((i + di, j + dj) for di in (-1, 0, 1) for dj in (-1, 0, 1)):
            if cell in known and np.hypot(*(known[cell] - end)) <= tolerance:
                return known[cell]
        known[i, j] = end
        return end

    return [np.vstack([place(piece[0]), piece[1:-1], place(piece[-1])]) for piece in pieces]
