"""Chooses the reader of a drawing: DXF, GDSII, SVG, or a black-and-white picture. Each reader loads its library when it
is needed."""

from __future__ import annotations

import pathlib
from collections.abc import Callable

from ..tools.errors import UserError
from .dxf import read_dxf
from .gds import read_gds
from .shapes import Drawing
from .pictures import ENDINGS, read_picture
from .svg import read_svg


def read(path: pathlib.Path, layer: str | None = None, posts: str | None = None, cell: str | None = None,
         are_holes_posts: bool = False) -> Drawing:
    """Reads a drawing.
    @param layer  the only layer to be read from a DXF or GDSII file, or None for all layers
    @param cell  the only cell to be read from a GDSII file, or None for the top cells
    @param posts  of a picture: dark or bright, or None if the picture decides
    @param are_holes_posts  whether the posts are holes in filled areas
    @throws UserError"""
    readers: dict[str, Callable[[], Drawing]] = {".dxf": lambda: read_dxf(path, layer),
                                                 ".gds": lambda: read_gds(path, layer, cell),
                                                 ".gdsii": lambda: read_gds(path, layer, cell),
                                                 ".svg": lambda: read_svg(path, are_holes_posts),
                                                 **{ending: lambda: read_picture(path, posts) for ending in ENDINGS}}
    reader = readers.get(path.suffix.lower())
    if reader is None:
        raise UserError(f"cannot read {path} (its ending is none of {', '.join(readers)}); "
                        "save the drawing as one of these")
    if not path.is_file():
        raise UserError(f"cannot read {path} (no such file); check the name")
    try:
        found = reader()
        if cell is not None and path.suffix.lower() not in (".gds", ".gdsii"):
            raise UserError("no place for --cell (only GDSII files have cells); leave it out")
        if layer is not None and found.layers and not (found.circles or found.outlines or found.pieces):
            raise UserError(f"{path} has nothing that can be a post on layer {layer}{found.layers_in_words()}")
        found.objects = len(found.circles) + len(found.outlines) + len(found.pieces)
        return found
    except UserError:
        raise
    except Exception as error:  # Each library raises its own kinds of errors.
        raise UserError(f"cannot read {path} ({type(error).__name__}: {error}); is it really of this kind?") from error
