"""Readers of drawings: DXF, GDSII, SVG, and pictures in black and white. Each loads its library when it is needed."""

from __future__ import annotations

import collections
import pathlib
import warnings
from collections.abc import Callable

import numpy as np

from ..tools.errors import UserError
from .dxf import read_dxf
from .libraries import library
from .shapes import Drawing
from .pictures import ENDINGS, read_picture
from .svg import read_svg


def read(path: pathlib.Path, layer: str | None = None, posts: str | None = None) -> Drawing:
    """@param layer  of a DXF or GDSII file, if only that one counts; @param posts  of a picture: dark or bright; None: found out. @throws UserError"""
    readers: dict[str, Callable[[], Drawing]] = {".dxf": lambda: read_dxf(path, layer), ".gds": lambda: read_gds(path, layer), ".gdsii": lambda: read_gds(path, layer),
                                                 ".svg": lambda: read_svg(path), **{ending: lambda: read_picture(path, posts) for ending in ENDINGS}}
    reader = readers.get(path.suffix.lower())
    if reader is None:
        raise UserError(f"cannot read {path} (its ending is none of {', '.join(readers)}); save the drawing as one of these")
    if not path.is_file():
        raise UserError(f"cannot read {path} (no such file); check the name")
    try:
        found = reader()
        found.objects = len(found.circles) + len(found.outlines) + len(found.pieces)
        return found
    except UserError:
        raise
    except Exception as error:  # of many libraries
        raise UserError(f"cannot read {path} ({type(error).__name__}: {error}); is it really of this kind?") from error


def read_gds(path: pathlib.Path, layer: str | None) -> Drawing:
    """Polygons of the top cells, with all that they refer to."""
    gdspy = library("gdspy", "python3-gdspy")
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error", UserWarning)  # for records that gdspy would ignore
            content = gdspy.GdsLibrary(infile=str(path), units="import")
    except UserWarning as warning:
        raise UserError(f"cannot read {path} ({warning}); convert everything to polygons in the layout program") from warning
    missing = {str(part.ref_cell) for cell in content.cell_dict.values() for part in cell.references if not isinstance(part.ref_cell, gdspy.Cell)}
    if missing:
        raise UserError(f"cannot read {path} (it lacks the cells {', '.join(sorted(missing))}, to which it refers); save it with these")
    cells = content.top_level()
    drawn = [item for cell in cells for item in cell.get_polygons(by_spec=True).items()]
    texts = sum(len(cell.get_labels()) for cell in cells)
    found = Drawing([], [], float(f"{content.unit:.12g}"), skipped=collections.Counter({"text": texts} if texts else {}))
    if len(cells) > 1:
        found.notes.append(f"{len(cells)} top cells, drawn together: {', '.join(cell.name for cell in cells)}")
    for (of_layer, _), polygons in drawn:
        if layer is not None and str(of_layer) != layer:
            found.skipped[f"polygons on layer {of_layer}"] += len(polygons)
        else:
            found.outlines += [np.asarray(polygon, dtype=float) for polygon in polygons]
    return found
