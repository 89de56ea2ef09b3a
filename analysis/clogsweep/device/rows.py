"""Replaces posts that are not round by rows of overlapping circles along their outlines. Each row is a wall without
gaps."""

from __future__ import annotations

import dataclasses
import sys
from typing import Any

import numpy as np

from ..tools.errors import UserError
from ..tools.hints import Numbers
from .libraries import library
from .shapes import Device, valid

# Distance between neighbouring circles of a row, divided by their radius. The roughness of the row is then 1.4 % of the
# radius.
SPACING = 1 / 3
SMALLEST_VOID = 0.35  # Largest radius of an empty space inside a post [sigma], into which no droplet fits.
MOST_FILLERS = 100
MOST_CIRCLES, MANY_CIRCLES = 200000, 20000


def shapely(part: str) -> Any:
    """Imports a part of shapely. @throws UserError  if shapely is not installed"""
    try:
        return library(f"shapely.{part}", "python3-shapely")
    except UserError as error:
        raise UserError("--as-rows needs python3-shapely (apt install python3-shapely), "
                        "and Debian's own /usr/bin/python3") from error


@dataclasses.dataclass
class Rows:
    """The resulting posts. Lengths are in droplet diameters."""

    device: Device
    # Radius of the circles of a row, to which corners are rounded. In thin posts the circles are smaller.
    corner: float
    farthest: float  # Largest distance of a drawn outline from the circles, which do not fill its corners.
    roughness: float


def as_rows(device: Device, corner: float) -> Rows:
    """The posts of the device, with rows of circles in place of each outline that is not round.
    @param corner  radius to which corners are rounded. If a post is too thin for this radius, the radius is nearly half
    of its width.
    @throws UserError  if an outline crosses itself"""
    geometry = shapely("geometry")
    frame = geometry.box(0, 0, device.length, device.width)
    circles, posts = [device.circles], [np.arange(len(device.circles))]
    number, farthest = len(device.circles), 0.0
    whole = [part for outline in device.others for part in parts(valid(geometry.Polygon(outline)).intersection(frame))]
    refuse_too_many([cores(part, corner) for part in whole])
    for part in whole:
        made = np.vstack([of_part(core, part, radius) for core, radius in cores(part, corner)])
        circles.append(made)
        posts.append(np.full(len(made), number))
        number += 1
        farthest = max(farthest, distance_left(part, made))
    rough = corner * (1 - np.sqrt(1 - SPACING**2 / 4))
    made_of_them = dataclasses.replace(device, circles=np.vstack(circles), others=[], post_of=np.concatenate(posts),
                                       replaced=device.others)
    return Rows(made_of_them, corner, farthest, float(rough))


def refuse_too_many(all_cores: list[list[tuple[Any, float]]]) -> None:
    """Refuses outlines that need too many circles. @throws UserError  if there would be more circles than are usable"""
    number = sum(core.exterior.length / (SPACING * radius) for of_part in all_cores for core, radius in of_part)
    if number > MOST_CIRCLES:
        raise UserError(f"--as-rows needs {number:.2g} circles (at most {MOST_CIRCLES}); "
                        "give a larger --corner, or check --unit and --droplet")
    if number > MANY_CIRCLES:
        print(f"--as-rows makes about {number:.2g} circles, which takes minutes; "
              "a larger --corner makes fewer, and so does the right --droplet", file=sys.stderr)


def parts(shape: Any) -> list[Any]:
    """The polygons of a shape. A shape may consist of several polygons."""
    return [part for part in getattr(shape, "geoms", [shape]) if part.geom_type == "Polygon" and part.area > 0]


def deepest(polygon: Any) -> tuple[Any, float]:
    """The centre and radius of the largest circle that fits into the polygon."""
    ops = shapely("ops")
    centre = ops.polylabel(polygon, 1e-3 * np.sqrt(polygon.area))
    return centre, polygon.boundary.distance(centre)


def cores(polygon: Any, corner: float) -> list[tuple[Any, float]]:
    """The cores of a polygon. Circles of the returned radius with their centres on the edge of a core are within the
    polygon and touch its outline. In a thin polygon this radius is smaller than `corner`."""
    _, half_width = deepest(polygon)
    radius = min(corner, 0.9 * half_width)
    return [(core, radius) for core in parts(polygon.buffer(-radius))]


def of_part(core: Any, polygon: Any, radius: float) -> Numbers:
    """Covers a polygon by a row of circles along the edge of a core. Larger circles fill the interior where a droplet
    would fit."""
    found = [(x, y, 2 * radius) for x, y in places(core.exterior.simplify(0.01 * radius), SPACING * radius)]
    rest = core
    for _ in range(MOST_FILLERS):
        left = [deepest(part) for part in parts(rest)]
        if not left or max(room for _, room in left) < SMALLEST_VOID:
            break
        centre, _ = max(left, key=lambda one: one[1])
        size = polygon.exterior.distance(centre)
        found.append((centre.x, centre.y, 2 * size))
        rest = rest.difference(centre.buffer(size))
    return np.array(found)


def places(ring: Any, spacing: float) -> Numbers:
    """The corners of a ring, and evenly spaced points between them."""
    corners = np.asarray(ring.coords)
    parts = []
    for begin, end in zip(corners, corners[1:]):
        number = max(1, int(np.ceil(np.hypot(*(end - begin)) / spacing)))
        parts.append(begin + np.linspace(0, 1, number, endpoint=False)[:, None] * (end - begin))
    return np.vstack(parts)


def distance_left(polygon: Any, circles: Numbers) -> float:
    """The largest distance of a point of the outline from the circles."""
    corners = places(polygon.exterior, polygon.exterior.length / 2000)
    nearest = np.full(len(corners), np.inf)
    # The distances of all circles at once would need gigabytes.
    for some in np.array_split(circles, 1 + len(circles) // 1000):
        x, y = (corners[:, None, axis] - some[None, :, axis] for axis in (0, 1))
        gaps = np.hypot(x, y) - some[None, :, 2] / 2
        nearest = np.minimum(nearest, gaps.min(axis=1))
    return float(nearest.max())
