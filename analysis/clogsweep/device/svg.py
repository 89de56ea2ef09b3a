"""Reads outlines from SVG drawings as librsvg shows them. The unit of length is a CSS pixel; an inch has 96 pixels."""

from __future__ import annotations

import copy
import io
import pathlib
import re
from typing import Any
from xml.etree import ElementTree

import numpy as np

from ..tools.errors import UserError
from ..tools.hints import Numbers
from . import areas, flat, walls
from .flat import NAMESPACE, Flat
from .libraries import library
from .shapes import Drawing

METRES_IN_PIXEL = 25.4e-3 / 96
LENGTHS = ("mm", "cm", "in", "pt", "pc", "Q")
# Number of straight pieces of each curved segment. For a quarter of a circle, the pieces deviate by 2e-5 of the radius.
PIECES_OF_CURVE = 64
# Drawing programs draw a quarter of an ellipse as a Bezier curve. The handles of this curve extend to this fraction of
# the distance to the corner.
QUARTER = 4 / 3 * (np.sqrt(2) - 1)
NO_AREA = 1e-6  # A path is a line if it encloses at most this fraction of the square of its size.
PAGE_WITHOUT_SIZE = 1e4  # [px]


def read_svg(path: pathlib.Path, are_holes_posts: bool = False) -> Drawing:
    """Reads visible circles and closed outlines, including curves.
    @param are_holes_posts  whether holes in filled paths are read as holes, and not as outlines within outlines"""
    text = re.sub(r"<!--.*?-->", "", path.read_bytes().decode(errors="replace"), flags=re.DOTALL)
    root = ElementTree.parse(path).getroot()
    flat.refuse_unknown_css(text, path)
    refuse_unknown(root, path)
    ignored = flat.named_in(text, flat.IGNORED)
    found = Drawing([], [], None, notes=[f"ignored: {ignored}"] if ignored else [], skipped={})
    set_scale(found, root)
    svgelements = library("svgelements", "python3-svgelements")
    page = svgelements.SVG.parse(io.BytesIO(ElementTree.tostring(empty(root))), reify=False)
    viewport = svgelements.Matrix(page.viewbox_transform) if page.viewbox else svgelements.Matrix()
    found.from_own = lambda points: upwards(np.asarray(points) @ [[viewport.a, viewport.b], [viewport.c, viewport.d]]
                                            + [viewport.e, viewport.f])
    size = size_of(page, text, path)
    if size is not None:
        found.page = (0.0, -size[1], size[0], 0.0)
    found.skipped.update({name: number
                          for name in flat.NO_SHAPES if (number := len(list(root.iter(NAMESPACE + name))))})
    drawing = flat.flatten(root, *(size or (PAGE_WITHOUT_SIZE, PAGE_WITHOUT_SIZE)), path)
    read_flat(svgelements, drawing, found, are_holes_posts, transform_length(viewport))
    return found


def refuse_unknown(root: Any, path: pathlib.Path) -> None:
    """@throws UserError  if the target of a <use> is not in the file, or if the root of the drawing has a transform or
    no size"""
    names = {element.get("id") for element in root.iter()}
    for use in root.iter(NAMESPACE + "use"):
        link = next((use.get(name) for name in ("href", flat.LINK) if use.get(name)), "")
        if link[:1] != "#" or link[1:] not in names:
            raise UserError(f"cannot read {path} (<use> refers to '{link[:60]}', which is not in the file); "
                            "embed it, or unlink clones, in the drawing program")
    if root.get("transform", "").strip() not in ("", "none"):
        raise UserError(f"cannot read {path} (transform of the whole <svg>); apply it in the drawing program")
    sizes = [root.get("width", ""), root.get("height", ""), *re.split(r"[\s,]+", root.get("viewBox", "").strip())[2:]]
    if any(re.match(r"\s*(-|[0.]+(?![\d.]))", size) for size in sizes):
        raise UserError(f"cannot read {path} (its width, height or viewBox has no size); "
                        "give the size of the page in the drawing program")


def set_scale(found: Drawing, root: Any) -> None:
    """Sets the drawing's unit of length."""
    width = str(root.get("width", "")).strip()
    has_unit = width.endswith(LENGTHS)
    found.metres = METRES_IN_PIXEL if has_unit else None
    found.unit_in_words = width.lstrip("0123456789.eE+- ") if has_unit else "px"
    found.unit_hint = "" if has_unit else f" (--pixel {METRES_IN_PIXEL * 1e3:.7g}mm, if 96 of them are an inch; Inkscape before 0.92 had 90, --pixel {25.4 / 90:.7g}mm)"


def empty(root: Any) -> Any:
    """The drawing without its content. If the drawing has no size, its size is that of its viewBox."""
    frame = ElementTree.Element(root.tag, {name: root.get(name)
                                           for name in ("width", "height", "viewBox", "preserveAspectRatio")
                                           if root.get(name)})
    if not all(re.fullmatch(rf"\s*[0-9.eE+]+\s*({'|'.join(LENGTHS)}|px)?\s*", frame.get(name, ""))
               for name in ("width", "height")):
        for name in ("width", "height"):
            frame.attrib.pop(name, None)
        view = re.split(r"[\s,]+", frame.get("viewBox", "").strip())
        if len(view) == 4:
            frame.attrib.update(width=view[2], height=view[3])
    return frame


def size_of(page: Any, text: str, path: pathlib.Path) -> tuple[float, float] | None:
    """The size of the page, or None if the drawing has neither a size nor a viewBox.
    @throws UserError  if such a drawing has lengths in per cent"""
    if page.values.get("width") and float(page.width) > 0 and float(page.height) > 0:
        return float(page.width), float(page.height)
    if re.search(r"[:=]\s*[\"']?\s*[-+\d.]+%", text):
        raise UserError(f"cannot read {path} (it has lengths in per cent, but no size); "
                        "give it width and height, or a viewBox, in the drawing program")
    return None


def read_flat(svgelements: Any, drawing: Flat, found: Drawing, are_holes_posts: bool, own_unit: float) -> None:
    """Adds the paths of a flat drawing. @param own_unit  of the drawing, in pixels"""
    clips = Clips(svgelements, drawing)
    content = svgelements.SVG.parse(io.BytesIO(ElementTree.tostring(drawing.root)), reify=False)
    widest = 0.0
    for element in content.elements():
        if not isinstance(element, svgelements.Shape):
            continue
        is_filled, is_stroked = is_painted(element.fill), is_painted(element.stroke) and element.stroke_width > 0
        if not is_filled and not is_stroked:
            found.skipped["transparent path"] = found.skipped.get("transparent path", 0) + 1
            continue
        parts = parts_of(svgelements, element, drawing)
        if is_filled and not is_stroked:
            parts = [closed(part) for part in parts]
        compound = [part for part in parts if is_closed(part)] if are_holes_posts and is_filled else []
        if len(compound) > 1:
            clips.cut_area(found, element.values,
                           areas.filled([part[:-1] for part in compound], element.values.get("fill-rule", "nonzero")))
            parts = [part for part in parts if not is_closed(part)]
        for part in parts:
            clips.cut(found, element.values, part)
        if is_filled and is_stroked and any(map(is_closed, parts)):
            widest = max(widest, float(element.stroke_width) * transform_length(element.transform) * drawing.pixel)
    if widest:
        found.notes.append(f"strokes not counted (of filled shapes at most {widest / own_unit:.4g} wide); "
                           "if a post includes its stroke, convert strokes to paths")


def parts_of(svgelements: Any, element: Any, drawing: Flat) -> list[Numbers]:
    """The outlines and lines of a path, with y upwards."""
    matrix = element.transform
    linear = np.array([[matrix.a, matrix.b], [matrix.c, matrix.d]], dtype=float)
    shift = np.array([matrix.e, matrix.f], dtype=float)
    outlines = [corners_of(svgelements, svgelements.Path(part)) for part in svgelements.Path(element).as_subpaths()]
    return [upwards(drawing.to_page(corners @ linear + shift)) for corners in outlines if len(corners) > 1]


def upwards(points: Numbers) -> Numbers:
    return np.asarray(points) * (1.0, -1.0)


def transform_length(matrix: Any) -> float:
    """The average factor by which a matrix of the library scales lengths."""
    return float(np.sqrt(abs(matrix.determinant)))


def is_painted(colour: Any) -> bool:
    """Whether a fill or a stroke is visible. @param colour  of the fill or stroke, as the library reads it"""
    return colour is not None and colour.value is not None and colour.opacity > 0


class Clips:
    """Clips paths: only the part inside all clip-paths of the groups around a path is visible. The library that parses
    paths ignores clips, but keeps the attribute that marks clipped paths here."""

    CLIPPED = "clipped-by"

    def __init__(self, svgelements: Any, drawing: Flat) -> None:
        self._areas = {}
        for clip in drawing.root.iter(NAMESPACE + "clipPath"):
            content = svgelements.SVG.parse(io.BytesIO(ElementTree.tostring(with_content(clip))), reify=False)
            shapes = [element for element in content.elements() if isinstance(element, svgelements.Shape)]
            self._areas[clip.get("id")] = [part for shape in shapes
                                           for part in parts_of(svgelements, shape, drawing) if len(part) > 2]
        self._mark(drawing.root, "")

    def _mark(self, element: Any, outer: str) -> None:
        """@param outer  names of the clips around the element"""
        link = re.search(r"url\(#([^)]*)\)", element.get("clip-path", ""))
        clips = f"{outer} {link[1]}" if link else outer
        element.set(self.CLIPPED, clips)
        for child in element:
            self._mark(child, clips)

    def _clips_of(self, values: dict[str, Any]) -> list[list[Numbers]]:
        return [self._areas[name] for name in values.get(self.CLIPPED, "").split()]

    def cut(self, found: Drawing, values: dict[str, Any], corners: Numbers) -> None:
        """Adds the part of an outline or a line that is inside all its clips."""
        clips = self._clips_of(values)
        if len(corners) == 0 or all(len(clip) == 1 and walls.is_rectangle(clip[0][:-1]) and is_within(corners, clip[0])
                                    for clip in clips):
            add(found, corners)
            return
        geometry = library("shapely.geometry", "python3-shapely")
        shape = areas.polygon(corners) if is_closed(corners) else geometry.LineString(corners)
        left = self._visible(values, shape)
        if left.is_empty:
            found.skipped["clipped path"] = found.skipped.get("clipped path", 0) + 1
        elif left.equals(shape):
            add(found, corners)
        elif is_closed(corners):
            areas.add(found, left)
        else:
            found.pieces += [("open outline", np.asarray(part.coords))
                             for part in getattr(left, "geoms", [left])
                             if part.length > 0]

    def cut_area(self, found: Drawing, values: dict[str, Any], area: Any) -> None:
        """Adds the part of an area that is inside all its clips."""
        left = self._visible(values, area)
        if left.is_empty:
            found.skipped["clipped path"] = found.skipped.get("clipped path", 0) + 1
        areas.add(found, left)

    def _visible(self, values: dict[str, Any], shape: Any) -> Any:
        """The part of a shape that is inside all its clips."""
        for clip in self._clips_of(values):
            if clip:
                area = areas.union([areas.polygon(part) for part in clip], 0.0)
            else:
                area = library("shapely.geometry", "python3-shapely").Polygon()
            shape = shape.intersection(area)
        return shape


def with_content(clip: Any) -> Any:
    """A drawing of the shapes of a clip-path."""
    drawing = ElementTree.Element(NAMESPACE + "svg")
    drawing.extend(copy.deepcopy(list(clip)))
    return drawing


def is_within(corners: Numbers, rectangle: Numbers) -> bool:
    """Whether all corners are in a rectangle, apart from rounding."""
    (left, bottom), (right, top) = rectangle.min(axis=0), rectangle.max(axis=0)
    return areas.is_on(corners, (left, bottom, right, top))


def corners_of(svgelements: Any, outline: Any) -> Numbers:
    """The corners of straight parts, and points along curves. No transform is applied."""
    points: list[Numbers] = []
    for segment in outline:
        if isinstance(segment, svgelements.CubicBezier):
            controls = (segment.start, segment.control1, segment.control2, segment.end)
            points.append(along_curve(np.array([(point.x, point.y) for point in controls])))
        elif segment.end is not None:
            points.append(np.array([(segment.end.x, segment.end.y)]))
    return np.concatenate(points) if points else np.empty((0, 2))


def along_curve(handles: Numbers) -> Numbers:
    """Points along a Bezier curve, without the first point. If the curve represents a quarter of an ellipse, the points
    are on the ellipse.
    @param handles  the four points of the curve (4, 2)"""
    share = np.linspace(0, 1, PIECES_OF_CURVE + 1)[1:, None]
    start, first, last, end = handles
    corner, other = start + (first - start) / QUARTER, end + (last - end) / QUARTER
    if np.allclose(corner, other, rtol=0, atol=1e-3 * np.abs(end - start).max()):
        centre, angle = start + end - (corner + other) / 2, np.pi / 2 * share
        return np.asarray(centre + (start - centre) * np.cos(angle) + (end - centre) * np.sin(angle))
    return np.asarray((1 - share)**3 * start + 3 * (1 - share)**2 * share * first + 3 * (1 - share) * share**2 * last
                      + share**3 * end)


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


def closed(corners: Numbers) -> Numbers:
    """A filled outline with a last corner that equals the first, because viewers fill open paths as if they were
    closed. Lines stay unchanged, because they have no area to fill."""
    ends = np.vstack([corners, corners[:1]])
    size = float(np.ptp(corners, axis=0).max())
    return corners if is_closed(corners) or abs(walls.area(ends)) <= NO_AREA * size**2 else ends


def is_closed(corners: Numbers) -> bool:
    """Whether the ends of an outline meet."""
    size = float(np.ptp(corners, axis=0).max()) if len(corners) else 0.0
    return len(corners) >= 4 and size > 0 and bool(np.allclose(corners[0], corners[-1], rtol=0, atol=1e-3 * size))
