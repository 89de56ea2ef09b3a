"""Outlines of SVG drawings, with all transforms. Length unit: a CSS pixel, 96 in an inch."""

from __future__ import annotations

import collections
import copy
import io
import pathlib
from typing import Any
from xml.etree import ElementTree

import numpy as np

from ..tools.errors import UserError
from ..tools.hints import Numbers
from .libraries import library
from .shapes import Drawing

METRES_IN_PIXEL = 25.4e-3 / 96
LENGTHS = ("mm", "cm", "in", "pt", "pc", "Q")
PIECES_OF_CURVE = 64  # of each segment: a quarter of a circle is off by 2e-5 of its radius
NAMESPACE = "{http://www.w3.org/2000/svg}"
TEMPLATES = [NAMESPACE + name for name in ("symbol", "marker", "mask")]  # drawn only where something refers to them
LINKS = ("href", "{http://www.w3.org/1999/xlink}href")


def read_svg(path: pathlib.Path) -> Drawing:
    """Circles, and closed outlines with their curves."""
    svgelements = library("svgelements", "python3-svgelements")
    root = ElementTree.parse(path).getroot()
    by_id = {element.get("id"): element for element in root.iter()}
    expand(root, by_id, path)
    content = svgelements.SVG.parse(io.BytesIO(ElementTree.tostring(root)), reify=False)
    width = str(root.get("width", "")).strip()
    found = Drawing([], [], METRES_IN_PIXEL, unit_is_assumed=not width.endswith(LENGTHS), skipped=collections.Counter())
    found.unit_in_words = "px, 96 in an inch" if found.unit_is_assumed else width.lstrip("0123456789.eE+- ")
    viewport = svgelements.Matrix(content.viewbox_transform) if content.viewbox else svgelements.Matrix()
    found.from_own = applied(viewport)
    for element in content.elements():
        if not isinstance(element, svgelements.Shape):
            if isinstance(element, (svgelements.Text, svgelements.Image)):
                found.skipped[type(element).__name__.lower()] += 1
        elif element.values.get("visibility") in ("hidden", "collapse"):
            found.skipped[f"hidden {element.values.get('tag')}"] += 1
        else:
            for part in svgelements.Path(element).as_subpaths():
                add(found, applied(element.transform)(corners_of(svgelements, svgelements.Path(part))))
    return found


def expand(element: Any, by_id: dict[str | None, Any], path: pathlib.Path) -> None:
    """Replaces each <use> by a group with a copy of what it refers to, before the library would: it drops those that refer to
    something below them, draws <symbol> where it is defined, and ignores its viewBox."""
    element[:] = [group_of(child, by_id, path) if child.tag == NAMESPACE + "use" else child for child in element if child.tag not in TEMPLATES]
    for child in element:
        expand(child, by_id, path)


def group_of(use: Any, by_id: dict[str | None, Any], path: pathlib.Path) -> Any:
    """@throws UserError  if nothing in the file has the name that it refers to"""
    link = next((use.get(name) for name in LINKS if use.get(name)), "")
    if link[:1] != "#" or link[1:] not in by_id:
        raise UserError(f"cannot read {path} (<use> refers to '{link[:60]}', which is not in the file); embed it, or unlink clones, in the drawing program")
    original = copy.deepcopy(by_id[link[1:]])
    if original.tag == NAMESPACE + "symbol":
        original.tag = NAMESPACE + "svg"  # it is drawn as an inner drawing
        original.attrib.update({name: use.get(name) for name in ("width", "height") if use.get(name)})
    attributes = {name: value for name, value in use.attrib.items() if name not in ("x", "y", "width", "height", *LINKS)}
    attributes["transform"] = f"{use.get('transform', '')} translate({use.get('x', 0)}, {use.get('y', 0)})"
    group = ElementTree.Element(NAMESPACE + "g", attributes)
    group.append(original)
    return group


def corners_of(svgelements: Any, outline: Any) -> Numbers:
    """Corners of straight parts, and points along curves, before any transform."""
    points: list[tuple[float, float]] = []
    for segment in outline:
        is_straight = isinstance(segment, (svgelements.Move, svgelements.Line, svgelements.Close))
        steps = np.linspace(0, 1, 2 if is_straight else PIECES_OF_CURVE + 1)[1:]
        points += [(point.x, point.y) for point in (segment.point(at) for at in steps) if point is not None]
    return np.array(points, dtype=float).reshape(-1, 2)


def applied(matrix: Any) -> Any:
    """A function that transforms points (n, 2) into the drawing's axes, y upwards."""
    linear = np.array([[matrix.a, matrix.c], [-matrix.b, -matrix.d]], dtype=float)
    shift = np.array([matrix.e, -matrix.f], dtype=float)
    return lambda points: np.asarray(points) @ linear.T + shift


def add(found: Drawing, corners: Numbers) -> None:
    """As an outline, if its ends meet; otherwise as a line."""
    if len(corners) < 2:
        return
    size = float(np.ptp(corners, axis=0).max())
    if len(corners) < 4 or not np.allclose(corners[0], corners[-1], rtol=0, atol=1e-3 * size):
        found.pieces.append(("open outline", corners))
    else:
        found.outlines.append(corners[:-1])
