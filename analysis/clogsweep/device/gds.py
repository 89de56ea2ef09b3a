"""Reads outlines from GDSII drawings, with all cells to which the top cells refer."""

from __future__ import annotations

import collections
import pathlib
import warnings
from typing import Any

import numpy as np

from ..tools.errors import UserError
from .libraries import library
from .shapes import Drawing

# A polygon with this many corners is 1e-4 of the diameter wider than a circle of equal area.
CORNERS_OF_DISC = 128


def read_gds(path: pathlib.Path, layer: str | None, cell: str | None = None) -> Drawing:
    """Reads the polygons of the top cells, and those of all cells to which they refer.
    @param layer  the only layer to be read, such as 1, or 1/0 with its datatype
    @param cell  the only cell to be read, in place of the top cells"""
    gdspy = library("gdspy", "python3-gdspy")
    try:
        with path.open("rb") as stream, warnings.catch_warnings():  # gdspy would leave an unreadable file open.
            warnings.simplefilter("error", UserWarning)  # By default gdspy prints a warning about ignored records.
            content = exact_library(gdspy)(infile=stream, units="import")
    except UserWarning as warning:
        raise UserError(f"cannot read {path} ({warning}); "
                        "convert everything to polygons in the layout program") from warning
    references = [part for cell in content.cell_dict.values() for part in cell.references]
    missing = {str(part.ref_cell) for part in references if not isinstance(part.ref_cell, gdspy.Cell)}
    if missing:
        raise UserError(f"cannot read {path} (it lacks the cells {', '.join(sorted(missing))}, to which it refers); "
                        "save it with these")
    # If this version of gdspy leaves a CellArray here, it does not call _create_array().
    if any(isinstance(part, gdspy.CellArray) for part in references):
        raise UserError(f"cannot read {path} (gdspy {gdspy.__version__} may misplace its arrays of cells); "
                        "flatten them in the layout program")
    if cell is not None and cell not in content.cell_dict:
        raise UserError(f"{path} has no cell {cell}; its cells are {', '.join(sorted(content.cell_dict))}")
    cells = content.top_level() if cell is None else [content.cell_dict[cell]]
    drawn = [item for one in cells for item in one.get_polygons(by_spec=True).items()]
    texts = sum(len(one.get_labels()) for one in cells)
    found = Drawing([], [], float(f"{content.unit:.12g}"),
                    skipped=collections.Counter({"text": texts} if texts else {}))
    if len(cells) > 1:
        found.notes.append(f"{len(cells)} top cells, drawn together (--cell chooses one): "
                           f"{', '.join(one.name for one in cells)}")
    layers: collections.Counter[str] = collections.Counter()
    for (of_layer, datatype), polygons in drawn:
        name = f"{of_layer}/{datatype}"
        layers[name] += len(polygons)
        if layer is not None and layer not in (str(of_layer), name):
            found.skipped[f"polygons on layer {name}"] += len(polygons)
        else:
            found.outlines += [np.asarray(polygon, dtype=float) for polygon in polygons]
    found.layers = layers
    return found


def exact_library(gdspy: Any) -> Any:
    """gdspy's reader with two changes. An array becomes one reference for each of its places, and a round path without
    length becomes a disc.

    gdspy's own arrays have only two spacings, along the axes of the cell. Because of this, gdspy misplaces an array
    with an oblique lattice, or with a lattice that is turned by another angle than the cell."""
    class Library(gdspy.GdsLibrary):  # type: ignore[misc]
        def _create_path(self, *, xy: Any, **path: Any) -> Any:
            """@throws UserWarning  if the path has neither length nor round ends"""
            if np.ptp(np.reshape(xy, (-1, 2)), axis=0).any():
                return super()._create_path(xy=xy, **path)
            if path.get("ends") != "round":
                raise UserWarning(f"a path of layer {path.get('layer', 0)} has no length")
            return gdspy.Round(xy[:2],
                               abs(path["width"]) / 2, number_of_points=CORNERS_OF_DISC, layer=path["layer"],
                               datatype=path["datatype"])

        def _create_array(self, *, columns: int, rows: int, xy: Any, **reference: Any) -> list[Any]:
            """@param xy  three points: the origin, the point that is `columns` columns away from the origin, and the
            point that is `rows` rows away"""
            origin, end_of_columns, end_of_rows = np.reshape(xy, (3, 2))
            along, across = (end_of_columns - origin) / columns, (end_of_rows - origin) / rows
            return [self._create_reference(xy=origin + i * along + j * across, **reference)
                    for i in range(columns) for j in range(rows)]

    return Library
