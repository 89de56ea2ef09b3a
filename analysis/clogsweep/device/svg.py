"""Reads outlines from SVG drawings, and applies all transforms. The unit of length is a CSS pixel. An inch has 96 of
them."""

from __future__ import annotations

import collections
import copy
import io
import pathlib
import re
from typing import Any
from xml.etree import ElementTree

import numpy as np

from ..tools.hints import Numbers
from . import areas, css, elements, walls
from .elements import NAMESPACE
from .libraries import library
from .shapes import Box, Drawing

METRES_IN_PIXEL = 25.4e-3 / 96
LENGTHS = ("mm", "cm", "in", "pt", "pc", "Q")
# Number of straight pieces of each curved segment. For a quarter of a circle they deviate by 2e-5 of its radius.
PIECES_OF_CURVE = 64


def read_svg(path: pathlib.Path, are_holes_posts: bool = False) -> Drawing:
    """Reads visible circles and closed outlines, including curves.
    @param are_holes_posts  whether holes in filled paths are read as holes, and not as outlines within outlines"""
    svgelements = library("svgelements", "python3-svgelements")
    root = ElementTree.parse(path).getroot()
    notes = ["style sheet in another file ignored; embed it in the drawing"] if b"<?xml-stylesheet" in path.read_bytes() else []
    css.apply(root, notes)
    elements.prepare(root, path)
    hide_within_transparent(root)
    clips = Clips(root)
    content = svgelements.SVG.parse(io.BytesIO(ElementTree.tostring(root)), reify=False)
    width = str(root.get("width", "")).strip()
    has_unit = width.endswith(LENGTHS)
    found = Drawing([], [], METRES_IN_PIXEL if has_unit else None, notes=notes, skipped=collections.Counter())
    found.unit_in_words = width.lstrip("0123456789.eE+- ") if has_unit else "px"
    found.unit_hint = "" if has_unit else f" (--pixel {METRES_IN_PIXEL * 1e3:.7g}mm, if 96 of them are an inch; Inkscape before 0.92 had 90, --pixel {25.4 / 90:.7g}mm)"
    viewport = svgelements.Matrix(content.viewbox_transform) if content.viewbox else svgelements.Matrix()
    found.from_own = applied(viewport)
    found.page = page_of(root, content, found)
    widest = 0.0
    for element in content.elements():
        if not isinstance(element, svgelements.Shape):
            if isinstance(element, (svgelements.Text, svgelements.Image)):
                found.skipped[type(element).__name__.lower()] += 1
            continue
        transform = applied(element.transform)
        parts = [transform(corners_of(svgelements, svgelements.Path(part))) for part in svgelements.Path(element).as_subpaths()]
        tag = element.values.get("tag")
        if not clips.define(element.values, parts):
            if kind := invisible(element):
                found.skipped[f"{kind} {tag}"] += 1
                continue
            compound = [part for part in parts if is_closed(part)] if are_holes_posts and is_painted(element.fill) else []
            if len(compound) > 1:
                clips.cut_area(found, element.values, tag, areas.filled([part[:-1] for part in compound], element.values.get("fill-rule", "nonzero")))
                parts = [part for part in parts if not is_closed(part)]
            for part in parts:
                clips.cut(found, element.values, tag, part)
            if is_painted(element.fill) and is_painted(element.stroke) and any(map(is_closed, parts)):
                widest = max(widest, float(element.stroke_width) * transform_length(element.transform))
    if widest:
        found.notes.append(f"strokes not counted (of filled shapes at most {widest / transform_length(viewport):.4g} wide); if a post includes its stroke, convert strokes to paths")
    if clips.unknown:
        found.notes.append(f"{clips.unknown} clips or masks ignored, which are not of plain shapes")
    return found


def page_of(root: Any, content: Any, found: Drawing) -> Box | None:
    """The page: width and height, or the viewBox of a drawing without these. None if the drawing has neither."""
    if all(re.fullmatch(rf"[0-9.eE+]+\s*({'|'.join(LENGTHS)}|px)?", root.get(name, "").strip()) for name in ("width", "height")):
        corners = np.array([(0.0, -float(content.height)), (float(content.width), 0.0)])
    elif content.viewbox:
        view = content.viewbox
        corners = found.from_own([(view.x, view.y), (view.x + view.width, view.y + view.height)])
    else:
        return None
    (left, bottom), (right, top) = corners.min(axis=0), corners.max(axis=0)
    return (left, bottom, right, top) if right > left and top > bottom else None


def transform_length(matrix: Any) -> float:
    """The average factor by which a matrix of the library scales lengths."""
    return float(np.sqrt(abs(matrix.determinant)))


def is_painted(colour: Any) -> bool:
    """Whether a fill or a stroke is visible. @param colour  of the fill or stroke, as the library reads it"""
    return colour is not None and colour.value is not None and colour.opacity > 0


def invisible(element: Any) -> str:
    """The reason why a shape is invisible, or an empty text if it is visible."""
    if element.values.get("visibility") in ("hidden", "collapse"):
        return "hidden"
    if number(element.values.get("opacity", "1")) == 0:
        return "transparent"
    return "" if is_painted(element.fill) or is_painted(element.stroke) and element.stroke_width > 0 else "unpainted"


def hide_within_transparent(root: Any) -> None:
    """Makes all that is within a transparent group transparent. The library lets a part replace the group's opacity."""
    for element in root.iter():
        if number(element.get("opacity", "1")) == 0:
            for part in element.iter():
                part.set("opacity", "0")


def number(text: Any) -> float:
    """An opacity as a number. Text that is no number counts as 1."""
    try:
        return float(str(text).rstrip("%"))
    except ValueError:
        return 1.0


class Clips:
    """Clips shapes: only the part inside a clip-path is visible. The clip-path belongs to the shape itself or to a
    group around it. The viewport of an <svg> within the drawing is a rectangle that clips its content.

    The library ignores clips. So the shapes of each clip are added to a group around the clipped element, and the
    library applies the element's transform to them. Both the clipping and the clipped shapes are marked with attributes that the
    library keeps."""

    SHAPE, USED = "clip-shape", "clipped-by"

    def __init__(self, root: Any) -> None:
        self._by_id = {element.get("id"): element for element in root.iter(NAMESPACE + "clipPath")}
        self._areas: dict[str, list[Numbers]] = {}
        self.unknown = 0
        self._draw(root, "")

    def _link(self, element: Any) -> str:
        """The name of the clip-path of an element, or an empty text."""
        clip = element.get("clip-path", "none")
        link = re.search(r"url\(([^)]*)\)", clip)
        self.unknown += ("url(" in element.get("mask", "")) + (link is None and clip != "none")
        return link[1].strip(" '\"#") if link else ""

    def _draw(self, element: Any, outer: str) -> None:
        """Adds the shapes of clip-paths to the groups that they clip. @param outer  numbers of the clips around the
        element"""
        for index, child in enumerate(list(element)):
            if child.tag in (NAMESPACE + "clipPath", NAMESPACE + "defs"):
                continue
            link, clips = self._link(child), outer
            clip = self._by_id.get(link)
            contents: list[tuple[list[Any], str]] = []
            if clip is not None and clip.get("clipPathUnits") != "objectBoundingBox":
                contents.append((list(clip), clip.get("transform", "")))
            elif link:
                self.unknown += 1
            if child.tag == NAMESPACE + "svg" and child.get("overflow") not in ("visible", "auto"):
                sides = {name: child.get(name, "0") for name in elements.LENGTHS["svg"]}
                contents.append(([ElementTree.Element(NAMESPACE + "rect", sides)], ""))
            if contents:
                group = ElementTree.Element(NAMESPACE + "g", {"transform": child.attrib.pop("transform", "")})
                for shapes, transform in contents:
                    name = str(len(self._areas))
                    self._areas[name] = []
                    clips = f"{clips} {name}"
                    area = ElementTree.SubElement(group, NAMESPACE + "g", {self.SHAPE: name, "visibility": "visible", "transform": transform})
                    area.extend(copy.deepcopy(shapes))
                group.append(child)
                element[index] = group
            child.set(self.USED, clips)
            self._draw(child, clips)

    def define(self, values: dict[str, Any], parts: list[Numbers]) -> bool:
        """Stores a shape if it is part of a clip. @return whether it is"""
        name = values.get(self.SHAPE)
        if name is not None:
            self._areas[name] += [part for part in parts if len(part) > 2]
        return name is not None

    def cut(self, found: Drawing, values: dict[str, Any], tag: Any, corners: Numbers) -> None:
        """Adds the part of an outline or a line that is inside all its clips."""
        clips = [self._areas[name] for name in values.get(self.USED, "").split()]
        if len(corners) == 0 or all(len(clip) == 1 and walls.is_rectangle(clip[0][:-1]) and is_within(corners, clip[0]) for clip in clips):
            add(found, corners)
            return
        geometry = library("shapely.geometry", "python3-shapely")
        shape = areas.polygon(corners) if is_closed(corners) else geometry.LineString(corners)
        left = self._visible(values, shape)
        if left.is_empty:
            found.skipped[f"clipped {tag}"] += 1
        elif left.equals(shape):
            add(found, corners)
        elif is_closed(corners):
            areas.add(found, left)
        else:
            found.pieces += [("open outline", np.asarray(part.coords)) for part in getattr(left, "geoms", [left]) if part.length > 0]

    def cut_area(self, found: Drawing, values: dict[str, Any], tag: Any, area: Any) -> None:
        """Adds the part of an area that is inside all its clips."""
        left = self._visible(values, area)
        if left.is_empty:
            found.skipped[f"clipped {tag}"] += 1
        areas.add(found, left)

    def _visible(self, values: dict[str, Any], shape: Any) -> Any:
        """The part of a shape that is inside all its clips."""
        for name in values.get(self.USED, "").split():
            clip = self._areas[name]
            shape = shape.intersection(areas.union([areas.polygon(part) for part in clip], 0.0) if clip else library("shapely.geometry", "python3-shapely").Polygon())
        return shape


def is_within(corners: Numbers, rectangle: Numbers) -> bool:
    """Whether all corners are in a rectangle, apart from rounding."""
    (left, bottom), (right, top) = rectangle.min(axis=0), rectangle.max(axis=0)
    return areas.is_on(corners, (left, bottom, right, top))


def corners_of(svgelements: Any, outline: Any) -> Numbers:
    """The corners of straight parts, and points along curves. No transform is applied."""
    points: list[tuple[float, float]] = []
    for segment in outline:
        is_straight = isinstance(segment, (svgelements.Move, svgelements.Line, svgelements.Close))
        steps = np.linspace(0, 1, 2 if is_straight else PIECES_OF_CURVE + 1)[1:]
        points += [(point.x, point.y) for point in (segment.point(at) for at in steps) if point is not None]
    return np.array(points, dtype=float).reshape(-1, 2)


def applied(matrix: Any) -> Any:
    """Returns a function that transforms points (n, 2) into the coordinates of a Drawing, with y upwards."""
    linear = np.array([[matrix.a, matrix.c], [-matrix.b, -matrix.d]], dtype=float)
    shift = np.array([matrix.e, -matrix.f], dtype=float)
    return lambda points: np.asarray(points) @ linear.T + shift


def add(found: Drawing, corners: Numbers) -> None:
    """Adds a path as an outline if its ends meet, and as a line otherwise."""
    size = float(np.ptp(corners, axis=0).max()) if len(corners) else 0.0
    if size == 0:
        if len(corners) > 1:
            found.skipped["dot"] = found.skipped.get("dot", 0) + 1
    elif is_closed(corners):
        found.outlines.append(corners[:-1])
    else:
        found.pieces.append(("open outline", corners))


def is_closed(corners: Numbers) -> bool:
    """Whether the ends of an outline meet."""
    size = float(np.ptp(corners, axis=0).max()) if len(corners) else 0.0
    return len(corners) >= 4 and size > 0 and bool(np.allclose(corners[0], corners[-1], rtol=0, atol=1e-3 * size))
