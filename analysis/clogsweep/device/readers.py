"""Readers of drawings: DXF, GDSII, SVG, and pictures in black and white. Each loads its library when it is needed."""

from __future__ import annotations

import collections
import pathlib
from collections.abc import Callable

import numpy as np

from ..tools.errors import UserError
from .dxf import read_dxf
from .libraries import library
from .shapes import Drawing
from .svg import read_svg
from .walls import area

PICTURES = (".png", ".tif", ".tiff", ".bmp", ".jpg", ".jpeg")


def read(path: pathlib.Path, layer: str | None = None, posts: str = "dark") -> Drawing:
    """@param layer  of a DXF or GDSII file, if only that one counts; @param posts  of a picture: dark or bright. @throws UserError"""
    readers: dict[str, Callable[[], Drawing]] = {".dxf": lambda: read_dxf(path, layer), ".gds": lambda: read_gds(path, layer), ".gdsii": lambda: read_gds(path, layer),
                                                 ".svg": lambda: read_svg(path), **{ending: lambda: read_picture(path, posts) for ending in PICTURES}}
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
    content = gdspy.GdsLibrary(infile=str(path))
    found = Drawing([], [], content.unit, skipped=collections.Counter())
    for cell in content.top_level():
        for (of_layer, _), polygons in cell.get_polygons(by_spec=True).items():
            if layer is not None and str(of_layer) != layer:
                found.skipped[f"polygons on layer {of_layer}"] += len(polygons)
            else:
                found.outlines += [np.asarray(polygon, dtype=float) for polygon in polygons]
    return found


def read_picture(path: pathlib.Path, posts: str) -> Drawing:
    """Outlines of the dark or bright parts, between pixels; the unit is a pixel. Specks of a few pixels do not count."""
    io, measure, filters, colour = (library(f"skimage.{name}", "python3-skimage") for name in ("io", "measure", "filters", "color"))
    image = np.asarray(io.imread(path), dtype=float)
    if image.ndim == 3:
        image = colour.rgb2gray(image[..., :3] / max(image[..., :3].max(), 1)) if image.shape[2] >= 3 else image[..., 0]
    if image.ndim != 2 or np.ptp(image) == 0:
        raise UserError(f"cannot read {path} (a picture of one colour, or of several slices); give a mask in black and white")
    threshold = filters.threshold_otsu(image)
    level = (image[image <= threshold].mean() + image[image > threshold].mean()) / 2  # half-way, so that edges lie between pixels
    sign = 1 if posts == "bright" else -1
    high = image.shape[0]
    found = Drawing([], [], None, frame=(0.0, 0.0, float(image.shape[1]), float(high)), is_picture=True, skipped=collections.Counter())
    fewest = 12  # corners of an outline: a speck of three pixels has so many
    for contour in measure.find_contours(sign * image, sign * level, positive_orientation="high"):
        outline = np.column_stack([contour[:, 1] + 0.5, high - contour[:, 0] - 0.5])
        if len(outline) < fewest:
            found.skipped["speck"] += 1
        elif np.allclose(outline[0], outline[-1]) and area(outline) < 0:
            found.skipped["hole"] += 1
        else:
            found.outlines.append(outline)
    return found
