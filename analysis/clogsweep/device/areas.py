"""Combines areas in a drawing: outlines that are drawn twice, outlines that touch, and holes in other outlines."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..tools import rounded
from ..tools.errors import UserError
from ..tools.hints import Numbers
from .libraries import library
from .shapes import Box, Drawing, fitted_circle, holds, holds_centre, left_out
from . import walls
from .walls import SHARE, is_rectangle

# Outlines touch if the gap between them is at most this fraction of the size of all outlines. A file that rounds
# corners can cause such a small gap.
NEAR = 1e-6
SAME = 1e-8  # Corners are the same if they differ by at most this fraction of the largest coordinate.


def tidy(drawing: Drawing, region: Numbers | None, tolerance: float, are_holes_posts: bool = False) -> None:
    """Drops duplicates, unites outlines that touch, and removes what is outside the page or outside a region.
    @param are_holes_posts  whether the holes in outlines are the posts, see posts_of_holes()
    @param region  two opposite corners in the coordinates that a drawing program shows, or None
    @param tolerance  as in fitted_circle()"""
    if drawing.page is not None:
        leave_out_beyond(drawing, drawing.page)
    if not drawing.is_picture:
        drop_duplicates(drawing)
        find_slits(drawing)
        if are_holes_posts:
            posts_of_holes(drawing)
        else:
            unite(drawing, tolerance)
    if drawing.page is not None:
        cut_at_page(drawing, drawing.page, tolerance)
    if region is not None:
        corners = drawing.from_own(region)
        (left, bottom), (right, top) = corners.min(axis=0), corners.max(axis=0)
        drawing.frame = left, bottom, right, top
        drawing.outside, _ = cut(drawing, drawing.frame, tolerance, "region")


def polygon(corners: Numbers) -> Any:
    """@throws UserError  if the outline crosses itself"""
    found = library("shapely.geometry", "python3-shapely").Polygon(corners)
    if not found.is_valid:
        x, y = corners.mean(axis=0)
        raise UserError(f"an outline around x={x:.6g}, y={y:.6g} in the drawing crosses itself; "
                        "correct it there (a picture: even out its light, and make it black and white)")
    return found


def union(shapes: list[Any], tolerance: float | None = None) -> Any:
    """The union of polygons. Gaps of up to twice the tolerance are closed."""
    ops = library("shapely.ops", "python3-shapely")
    if tolerance is None:
        tolerance = NEAR * max(np.ptp(np.reshape(shape.bounds, (2, 2)), axis=0).max() for shape in shapes)
    return ops.unary_union([shape.buffer(tolerance, join_style=2) for shape in shapes]).buffer(-tolerance, join_style=2)


def add(drawing: Drawing, area: Any) -> None:
    """Adds the outlines and holes of a shapely area to the drawing."""
    for part in getattr(area, "geoms", [area]):
        if part.geom_type == "Polygon" and not part.is_empty:
            drawing.outlines.append(np.asarray(part.exterior.coords)[:-1])
            drawing.holes += [np.asarray(ring.coords)[:-1] for ring in part.interiors]


def fill(drawing: Drawing, boundaries: list[Numbers], is_even_odd: bool) -> None:
    """Adds the filled area of a hatch. @param is_even_odd  whether a boundary inside another boundary is the edge of a
    hole"""
    boundaries = [corners for corners in boundaries if len(corners) > 2]
    if len(boundaries) == 1:
        drawing.outlines += boundaries
    elif boundaries:
        add(drawing,
            filled(boundaries, "evenodd") if is_even_odd else union([polygon(corners) for corners in boundaries]))


def filled(boundaries: list[Numbers], rule: str) -> Any:
    """The area within boundaries.
    @param rule  the fill-rule of SVG. With `evenodd`, a place is filled if it is within an odd number of boundaries.
    With `nonzero`, it is filled if the numbers of clockwise and of counter-clockwise boundaries around it differ.
    @throws UserError  if a boundary crosses itself"""
    ops = library("shapely.ops", "python3-shapely")
    shapes = [polygon(corners) for corners in boundaries]
    bounds = np.array([shape.bounds for shape in shapes])
    turns = np.array([1 if rule == "evenodd" or shape.exterior.is_ccw else -1 for shape in shapes])

    def is_filled(place: Any) -> bool:
        near = np.flatnonzero((bounds[:, 0] <= place.x) & (place.x <= bounds[:, 2]) & (bounds[:, 1] <= place.y)
                              & (place.y <= bounds[:, 3]))
        winding = sum(int(turns[i]) for i in near.tolist() if shapes[i].contains(place))
        return bool(winding % 2 if rule == "evenodd" else winding)

    edges = ops.unary_union([shape.exterior for shape in shapes])
    faces = ops.polygonize(getattr(edges, "geoms", [edges]))
    return ops.unary_union([face for face in faces if is_filled(face.representative_point())])


def drop_duplicates(drawing: Drawing) -> None:
    """Removes the copies of outlines that are drawn twice, and counts these outlines."""
    outlines = drawing.outlines
    step = SAME * max((float(np.abs(outline).max()) for outline in outlines), default=0.0) or 1.0
    kept = {frozenset(map(tuple, np.round(outline / step).astype(np.int64))): outline for outline in outlines}
    drawing.duplicates += len(outlines) - len(kept)
    drawing.outlines = list(kept.values())


def find_slits(drawing: Drawing) -> None:
    """Replaces outlines with slits by their edges and their holes. Files without holes, such as GDSII, draw a hole as a
    slit that leads from the edge to the hole, around it, and back."""
    for index, outline in enumerate(drawing.outlines):
        if len(outline) > 5 and has_slit(outline):
            area = library("shapely.geometry", "python3-shapely").Polygon(outline).buffer(0)
            if area.geom_type == "Polygon" and area.interiors:
                drawing.outlines[index] = np.asarray(area.exterior.coords)[:-1]
                drawing.holes += [np.asarray(ring.coords)[:-1] for ring in area.interiors]


def has_slit(outline: Numbers) -> bool:
    """Whether an outline passes through two corners twice."""
    step = SAME * float(np.abs(outline).max()) or 1.0
    _, counts = np.unique(np.round(outline / step).astype(np.int64), axis=0, return_counts=True)
    return int((counts > 1).sum()) >= 2


def posts_of_holes(drawing: Drawing) -> None:
    """Makes the holes of the drawn areas the posts, and the outer edge of the areas the device's edge. Areas are united
    first, because programs cut areas with holes into pieces. Outlines within holes fill them.
    @throws UserError  if there are no holes"""
    geometry, ops = (library(f"shapely.{name}", "python3-shapely") for name in ("geometry", "ops"))
    extent = np.ptp(np.vstack(drawing.outlines), axis=0).max() if drawing.outlines else 0.0
    tolerance = NEAR * float(extent)
    circles = [geometry.Point(x, y).buffer(diameter / 2, 64) for x, y, diameter in drawing.circles]
    shapes = [*(geometry.Polygon(outline).buffer(0) for outline in drawing.outlines), *circles]
    holes = [geometry.Polygon(hole).buffer(0) for hole in drawing.holes]
    inside = [shape for shape in shapes if any(hole.contains(shape) for hole in holes)]
    outside = [shape for shape in shapes if not walls.is_one_of(shape, inside)]
    area = geometry.Polygon()
    if outside:
        area = union(outside, tolerance).difference(ops.unary_union(holes)).union(ops.unary_union(inside))
    parts = [part for part in getattr(area, "geoms", [area]) if part.geom_type == "Polygon"]
    if not any(part.interiors for part in parts):
        raise UserError(f"the drawing has no holes; leave out --holes{drawing.layers_in_words()}")
    drawing.circles, drawing.outlines, drawing.holes = [], [], []
    for part in parts:
        drawing.outlines += [np.asarray(ring.coords)[:-1] for ring in (part.exterior, *part.interiors)]


def unite(drawing: Drawing, circle_tolerance: float) -> None:
    """Unites outlines that touch, because programs that write GDSII cut circles into slices. Some outlines are never
    united: outlines within others, the edge of the device, and walls.
    @param circle_tolerance  as in fitted_circle()"""
    outlines = drawing.outlines
    pairs = meeting(outlines)
    if not pairs:
        return
    geometry = library("shapely.geometry", "python3-shapely")
    shapes = {i: geometry.Polygon(outlines[i]) for i in {one for pair in pairs for one in pair}}
    tolerance = NEAR * float(np.ptp(np.vstack(outlines), axis=0).max())
    root = list(range(len(outlines)))  # for each outline, another outline that it touches, or itself

    def group_of(i: int) -> int:
        while root[i] != i:
            i = root[i]
        return i

    for i, j in pairs:
        one, other = shapes[i], shapes[j]
        if one.is_valid and other.is_valid and one.distance(other) <= tolerance and not one.contains(other) and not other.contains(one):
            root[max(group_of(i), group_of(j))] = min(group_of(i), group_of(j))
    groups: dict[int, list[int]] = {}
    for i in range(len(outlines)):
        groups.setdefault(group_of(i), []).append(i)
    touching = [members for members in groups.values() if len(members) > 1]
    drawing.outlines = [outlines[members[0]] for members in groups.values() if len(members) == 1]
    for members in touching:
        first = len(drawing.outlines)
        add(drawing, union([shapes[i] for i in members], tolerance))
        posts = sum(fitted_circle(outlines[i], True, circle_tolerance) is not None for i in members)
        if 0 < posts < len(members):
            drawing.swallowing += [(outline, posts) for outline in drawing.outlines[first:]]
    drawing.united = sum(map(len, touching)), len(touching)


def meeting(outlines: list[Numbers]) -> list[tuple[int, int]]:
    """Pairs of outlines with bounding boxes that touch. Outlines as long and as wide as the drawing are excluded,
    because they are edges of the device. A rectangle as long as the drawing is a wall, and is not paired. Two long
    rectangles side by side, one of them with notches, are an exception: they are pieces of an area with holes."""
    if len(outlines) < 2:
        return []
    lows, highs = (np.array([end(outline, axis=0) for outline in outlines]) for end in (np.min, np.max))
    is_long = highs - lows >= SHARE * np.ptp(np.vstack(outlines), axis=0)
    is_wall = ~is_long.all(axis=1) & is_long.any(axis=1) & [is_rectangle(outline) for outline in outlines]
    is_post = ~is_long.all(axis=1) & ~is_wall
    is_notched = is_wall & [not is_rectangle(outline, 1 - NEAR) for outline in outlines]
    near = NEAR * np.abs(np.ptp(np.vstack(outlines), axis=0)).max()

    def may_meet(i: int) -> Any:
        """For each outline before the i-th: whether it may be united with the i-th one if they touch."""
        if is_post[i]:
            return is_post[:i]
        are_pieces = is_wall[:i] & (is_long[:i] == is_long[i]).all(axis=1) & (is_notched[:i] | is_notched[i])
        return are_pieces if is_wall[i] else np.zeros(i, dtype=bool)

    return [(i, int(j)) for i in range(len(outlines))
            for j in np.flatnonzero(may_meet(i) & (lows[:i] <= highs[i] + near).all(axis=1) & (highs[:i] >= lows[i] - near).all(axis=1))]


def leave_out_beyond(drawing: Drawing, page: Box) -> None:
    """Removes everything that is completely outside the page, and notes how many objects were removed, and where."""
    visible: dict[str, list[Any]] = {"circles": [], "outlines": [], "lines": []}
    beyond: list[Numbers] = []
    for kind, kept in visible.items():
        for one in getattr(drawing, kind):
            if kind == "circles":
                points = np.asarray([np.subtract(one[:2], one[2] / 2), np.add(one[:2], one[2] / 2)])
            else:
                points = one[1] if kind == "lines" else one
            beyond.append(points) if is_beyond(points, page, kind == "outlines") else kept.append(one)
    drawing.circles, drawing.outlines, drawing.lines = visible.values()
    drawing.holes = [hole for hole in drawing.holes if not is_beyond(hole, page, True)]
    if beyond:
        own = drawing.to_own(np.vstack(beyond))
        (left, low), (right, high) = own.min(axis=0), own.max(axis=0)
        drawing.notes.append(f"{rounded.count_text(len(beyond), 'object')} wholly outside the page left out, "
                             f"at x={left:.6g} to {right:.6g}, y={low:.6g} to {high:.6g} "
                             "(enlarge the page if they belong to the device)")


def is_beyond(points: Numbers, page: Box, is_closed: bool) -> bool:
    """Whether an outline or a line has no part on the page."""
    if not is_near(points, page):
        return True
    if is_on(points, page):
        return False
    geometry = library("shapely.geometry", "python3-shapely")
    shape = geometry.Polygon(points).buffer(0) if is_closed else geometry.LineString(points)
    common = geometry.box(*page).intersection(shape)
    return bool(common.area == 0 if is_closed else common.length == 0)


def is_on(points: Numbers, page: Box) -> bool:
    """Whether all points are on the page, apart from rounding."""
    near = NEAR * max(page[2] - page[0], page[3] - page[1])
    return bool((points.min(axis=0) >= np.array(page[:2]) - near).all()
                and (points.max(axis=0) <= np.array(page[2:]) + near).all())


def cut_at_page(drawing: Drawing, page: Box, tolerance: float) -> None:
    """Cuts the outlines and lines that cross the border of the page. An outline around the whole page becomes the
    border of the page. @param tolerance  as in fitted_circle()"""
    inside, inside_lines = [outline for outline in drawing.outlines
                            if is_on(outline, page)], [line for line in drawing.lines if is_on(line[1], page)]
    if len(inside) == len(drawing.outlines) and len(inside_lines) == len(drawing.lines):
        return
    drawing.outlines = [outline for outline in drawing.outlines if not walls.is_one_of(outline, inside)]
    drawing.lines = [line for line in drawing.lines if not is_on(line[1], page)]
    _, around = cut(drawing, page, tolerance, "page")
    left, bottom, right, top = page
    border = [np.array([(left, bottom), (right, bottom), (right, top), (left, top)], dtype=float)]
    drawing.outlines += inside + border * bool(around)
    drawing.lines += inside_lines


def cut(drawing: Drawing, region: Box, tolerance: float, name: str) -> tuple[int, int]:
    """Keeps the part of the drawing that is in a region. A round post on the region's border is kept complete if its
    centre is inside, and removed if it is outside. Other outlines and lines are cut at the border. Outlines around the
    whole region are removed.
    @param region  left, bottom, right, top
    @param tolerance  as in fitted_circle()
    @param name  of the region
    @return the number of outlines, circles and lines outside the region, and the number of outlines around it"""
    geometry = library("shapely.geometry", "python3-shapely")
    box = geometry.box(*region)
    number = len(drawing.circles) + len(drawing.outlines) + len(drawing.lines)
    reaching = [circle for circle in drawing.circles if box.distance(geometry.Point(circle[:2])) < circle[2] / 2]
    drawing.circles = [circle for circle in reaching if holds_centre(region, circle)]
    inside, cuts, around, beside = [], [], 0, len(reaching) - len(drawing.circles)
    for outline in drawing.outlines:
        common = box.intersection(polygon(outline)) if is_near(outline, region) else None
        if common is not None and common.area > 0:
            circle = fitted_circle(outline, True, tolerance)
            if circle and not holds_centre(region, circle):
                beside += 1
            elif circle or holds(np.reshape(region, (2, 2)), [outline]):
                inside.append(outline)
            elif common.area < (1 - NEAR) * box.area:
                cuts.append(common)
            else:
                around += 1
    drawing.outlines = inside
    lines = [(kind, box.intersection(geometry.LineString(line))) for kind, line in drawing.lines]
    drawing.lines = [(kind, np.asarray(part.coords)) for kind, line in lines
                     for part in getattr(line, "geoms", [line]) if part.length > 0]
    outside = number - len(drawing.circles) - len(inside) - len(cuts) - around - sum(line.length > 0 for _, line in lines)
    for common in cuts:
        add(drawing, common)
    if beside:
        drawing.notes.append(left_out(beside, name))
    return outside, around


def is_near(outline: Numbers, region: Box) -> bool:
    """Whether the bounding box of an outline meets a region."""
    return bool((outline.min(axis=0) < region[2:]).all() and (outline.max(axis=0) > region[:2]).all())
