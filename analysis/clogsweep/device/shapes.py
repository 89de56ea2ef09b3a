"""Interprets the content of a drawing of a device: its round posts, other outlines, frame, and unit of length."""

from __future__ import annotations

import dataclasses
import functools
import math
import re
from collections.abc import Callable
from typing import Any

import numpy as np

from ..tools import rounded
from ..tools.errors import UserError
from ..tools.hints import Numbers
from . import walls
from .libraries import library
from .walls import area, centroid

METRES = {"nm": 1e-9, "um": 1e-6, "µm": 1e-6, "mm": 1e-3, "cm": 1e-2, "m": 1.0, "in": 25.4e-3, "mil": 25.4e-6}
MARGIN = 0.5  # Distance from the posts to the edge of a device, if the drawing has no edge [sigma].
NEAR = 0.01  # A line that is part of the edge may be this far outside the edge [sigma].
ROUNDED = 1e-6  # The centre of a fitted circle is rounded by at most this fraction of the size of the drawing.
SAME = 1e-3  # Two circles are the same if they differ by at most this fraction of the diameter.
WINDOW = 1000  # Copies of a circle are searched for among this number of neighbours along x.
LONGEST = 10000  # A side of a device that is longer than this probably comes from a wrong unit [sigma].
Box = tuple[float, float, float, float]  # Left, bottom, right and top.
Line = tuple[str, Numbers]  # The kind of an object in a drawing, and its points (n, 2).


@dataclasses.dataclass
class Drawing:
    """A drawing as read from its file. Lengths are in the drawing's own unit, and y points upwards."""

    circles: list[tuple[float, float, float]]  # Each has x, y and diameter.
    # Corners (n, 2) of each outline. An outline is closed from its last corner to its first, unless the border of a
    # picture cuts the outline.
    outlines: list[Numbers]
    metres: float | None  # Length of the drawing's unit [m]; None if the file does not state it.
    frame: Box | None = None  # The border of a picture, or of the region that the user gave.
    is_picture: bool = False  # Whether the drawing consists of pixels.
    # Holes in outlines. Holes are no posts, but a hole may be the device's edge.
    holes: list[Numbers] = dataclasses.field(default_factory=list)
    pieces: list[Line] = dataclasses.field(default_factory=list)  # Open lines, before they are joined.
    lines: list[Line] = dataclasses.field(default_factory=list)  # The pieces that do not form a closed outline.
    objects: int = 0  # Number of circles, outlines and lines that were read.
    joined: tuple[int, int] = (0, 0)  # Number of pieces that were joined, and number of outlines that they became.
    united: tuple[int, int] = (0, 0)  # Number of outlines that touched, and number of outlines that they became.
    duplicates: int = 0  # Number of outlines and circles that were drawn twice.
    unit_hint: str = ""  # Words that name a unit that the drawing may mean.
    notes: list[str] = dataclasses.field(default_factory=list)  # Messages about how the drawing was read.
    layers: dict[str, int] = dataclasses.field(default_factory=dict)  # Number of objects on each layer, chosen or not.
    # Each outline that came from a union of round posts with other outlines, and the number of these posts.
    swallowing: list[tuple[Numbers, int]] = dataclasses.field(default_factory=list)
    page: Box | None = None  # The page of an SVG, outside which nothing is visible.
    outside: int = 0  # Number of outlines, circles and lines outside the region that the user gave.
    can_join: bool = True
    unit_in_words: str | None = None  # Name of the unit in messages, if it is not unit_name(metres).
    # Converts points (n, 2) from the coordinates of a drawing program to those of this object.
    from_own: Callable[[Any], Numbers] = np.asarray
    # Number of objects of each kind that are no posts. Lines are not counted here.
    skipped: dict[str, int] = dataclasses.field(default_factory=dict)

    @property
    def unit(self) -> str:
        return self.unit_in_words or unit_name(self.metres or 0.0)

    def to_own(self, points: Numbers) -> Numbers:
        """The inverse of from_own()."""
        origin, *ends = self.from_own([(0, 0), (1, 0), (0, 1)])
        return np.asarray(np.linalg.solve(np.transpose(ends - origin), np.transpose(points - origin)).T)

    def layers_in_words(self) -> str:
        """The layers and their numbers of objects, such as "; its layers are 1/0 with 55 objects, 2/0 with 1 object".
        """
        named = ", ".join(f"{name} with {rounded.count_text(count, 'object')}"
                          for name, count in sorted(self.layers.items()))
        return f"; its layers are {named}" if named else ""


@dataclasses.dataclass
class Device:
    """The posts of a device. Lengths are in droplet diameters, the flow goes along +x, and the frame begins at (0,
    0)."""

    circles: Numbers  # Array (n, 3) of x, y and diameter.
    others: list[Numbers]  # Outlines that are not round.
    length: float
    width: float
    has_frame: bool
    droplet_metres: float
    post_of: Numbers | None = None  # Number of the post to which each circle belongs. If None, each circle is a post.
    replaced: list[Numbers] = dataclasses.field(default_factory=list)  # Outlines that were replaced by circles.
    # Outlines or lines beside the device that side-walls=on replaces.
    walls: list[Numbers] = dataclasses.field(default_factory=list)
    # Lines that neither form a closed outline nor are walls.
    lines: list[Line] = dataclasses.field(default_factory=list)

    @property
    def droplet_micrometres(self) -> float:
        return self.droplet_metres / METRES["um"]

    def overlaps(self) -> list[tuple[int, int]]:
        """Pairs of circles that belong to different posts and touch. clogsweep refuses such posts."""
        return self._gaps[1]

    def smallest_gap(self) -> float:
        """The narrowest gap between two posts. The gap is infinite if there are fewer than two posts."""
        return self._gaps[0]

    @functools.cached_property
    def _gaps(self) -> tuple[float, list[tuple[int, int]]]:
        """The narrowest gap, and two circles of each pair of posts that touch.

        Circles are sorted by x. Each circle is compared with the next one, then with the next but one, and so on. The
        comparison stops when all compared circles are farther apart along x than the narrowest gap so far."""
        posts = np.arange(len(self.circles)) if self.post_of is None else self.post_of
        order = np.argsort(self.circles[:, 0], kind="stable")
        x, y, diameter = self.circles[order].T
        posts = posts[order]
        narrowest = np.inf
        touching: dict[frozenset[int], tuple[int, int]] = {}
        for step in range(1, len(x)):
            is_near = x[step:] - x[:-step] <= (diameter[:-step] + diameter.max()) / 2 + max(narrowest, 0.0)
            if not is_near.any():
                break
            i = np.flatnonzero(is_near & (posts[step:] != posts[:-step]))
            gaps = np.hypot(x[i + step] - x[i], y[i + step] - y[i]) - (diameter[i + step] + diameter[i]) / 2
            narrowest = min(narrowest, gaps.min(initial=np.inf))
            for first in i[gaps <= 0]:
                pair = (int(order[first]), int(order[first + step]))
                touching.setdefault(frozenset((posts[first], posts[first + step])), (min(pair), max(pair)))
        return float(narrowest), sorted(touching.values())

    def gap_to_sides(self) -> float:
        """The narrowest gap between a post and a side of the device. The gap is infinite if all posts overlap a
        side."""
        x, y, diameter = self.circles.T
        gaps = np.concatenate([y, self.width - y]) - np.tile(diameter / 2, 2)
        return float(gaps.min(initial=np.inf, where=gaps > 0))

    def drawn_size(self) -> Numbers:
        """The length and the width of the drawing: those of the frame, or, without a frame, those of posts and walls
        without a margin."""
        if self.has_frame:
            return np.array([self.length, self.width])
        return np.ptp(np.vstack([surroundings(self.circles, self.others), *self.walls]), axis=0)

    def num_posts(self) -> int:
        return len(self.circles) if self.post_of is None else len(np.unique(self.post_of))


def length_in_metres(text: str, option: str) -> float:
    """Reads a length with its unit, such as 200um, in metres. @throws UserError"""
    found = re.fullmatch(r"([0-9.]+(?:e[+-]?[0-9]+)?)(nm|um|µm|mm|cm|mil|m|in)", text)
    try:
        value = float(found[1]) * METRES[found[2]] if found else 0.0
    except ValueError:
        value = 0.0
    if value <= 0:
        raise UserError(f"invalid {option}: {text} (must be a length with its unit, nm, um, mm, cm, m, "
                        "in or mil) try 200um")
    return value


def unit_name(metres: float) -> str:
    """The name of a unit, such as um. A unit without a name gets its length instead."""
    return next((name for name, size in METRES.items() if np.isclose(size, metres, rtol=1e-6, atol=0)),
                f"{metres:.4g} m")


def is_likely(length: float, width: float) -> bool:
    """Whether a device of this size is likely. @param length, width  of the device [sigma]"""
    return max(length, width) <= LONGEST and min(length, width) >= 1


def refuse_unlikely(device: Device, unit: str, metres: float, remedy: str, is_picture: bool) -> None:
    """Refuses a device that is too large or too small for its droplets, because the unit is probably wrong.
    @param unit, metres  unit in which the drawing was read, and its length
    @param is_picture  whether the drawing consists of pixels
    @throws UserError"""
    if is_likely(device.length, device.width):
        return
    drawn = device.drawn_size()
    better = ""
    for name in () if is_picture else ("um", "mm"):
        length, width = drawn * METRES[name] / metres
        better += f", in {name} it would be {length:.2g} by {width:.2g}" if is_likely(length, width) else ""
    raise UserError(f"the device is {drawn[0]:.2g} by {drawn[1]:.2g} droplet diameters "
                    f"(the drawing's unit is {unit}{better}); {remedy}, or check --droplet")


def along_edges(outline: Numbers, is_closed: bool) -> Numbers:
    """Evenly spaced points along the edges. The corners alone are not enough: the corners of a square, for example, are
    on a circle."""
    ends = np.vstack([outline, outline[:1]]) if is_closed else outline
    ways = np.hypot(*np.diff(ends, axis=0).T)
    places = np.concatenate([[0], np.cumsum(ways)])
    wanted = np.linspace(0, places[-1], 200, endpoint=False)
    return np.column_stack([np.interp(wanted, places, ends[:, axis]) for axis in (0, 1)])


def fitted_circle(outline: Numbers, is_closed: bool, tolerance: float) -> tuple[float, float, float] | None:
    """Fits a circle to an outline by least squares (Kasa's method). @return x, y and diameter; None if a point deviates
    by more than `tolerance` times the radius"""
    points = along_edges(outline, is_closed)
    middle = points.mean(axis=0)
    near = points - middle
    size = np.abs(near).max()
    if not size > 0:
        return None
    solution, *_ = np.linalg.lstsq(np.column_stack([near, np.full(len(near), size)]), (near**2).sum(axis=1), rcond=None)
    centre = solution[:2] / 2
    radius = float(np.sqrt(max(solution[2] * size + centre @ centre, 0)))
    deviation = np.abs(np.hypot(*(near - centre).T) - radius).max()
    if not radius > 0 or deviation > tolerance * radius:
        return None
    return float(middle[0] + centre[0]), float(middle[1] + centre[1]), 2 * radius


def edges_among(outlines: list[Numbers], holes: list[Numbers],
                centres: Numbers) -> tuple[Numbers | None, list[Numbers]]:
    """The edge of the device, and the other outlines. The edge is an outline that contains everything else. If a
    rectangle or a hole within this outline also contains all the rest, this rectangle or hole is the edge.
    @param centres  of circles"""
    edge: Numbers | None = None
    while (index := holder_among(outlines, centres)) is not None and (edge is None or walls.is_rectangle(outlines[index])):
        edge, outlines = outlines[index], outlines[:index] + outlines[index + 1:]
    for hole in sorted(holes, key=lambda hole: abs(area(hole))):
        if (outlines or len(centres)) and holds(hole, [*outlines, centres]):
            return hole, outlines
    return edge, outlines


def holder_among(outlines: list[Numbers], centres: Numbers) -> int | None:
    """The index of the outline that contains everything else, or None."""
    if len(outlines) + len(centres) < 2:
        return None
    ends = np.array([(outline.min(axis=0), outline.max(axis=0)) for outline in [*outlines, centres] if len(outline)])
    box = np.array([ends[:, 0].min(axis=0), ends[:, 1].max(axis=0)])
    return next((index for index, outline in enumerate(outlines) if holds(outline, [box])), None)


def holds(outline: Numbers, others: list[Numbers]) -> bool:
    """Whether all points are in the bounding box of an outline."""
    points = np.vstack(others)
    return bool((outline.min(axis=0) <= points.min(axis=0)).all() and (outline.max(axis=0) >= points.max(axis=0)).all())


def distinct(circles: Numbers) -> Numbers:
    """Removes circles that are drawn twice. Two copies may differ slightly, because curves in a drawing are
    inaccurate."""
    kept: list[int] = []
    for index in np.argsort(circles[:, 0], kind="stable"):
        near = np.array(kept[-WINDOW:], dtype=int)
        if not (np.abs(circles[near] - circles[index]) <= SAME * circles[index, 2]).all(axis=1).any():
            kept.append(int(index))
    return circles[sorted(kept)]


def understood(drawing: Drawing, metres: float, droplet: float, tolerance: float, turns: int) -> Device:
    """Interprets a drawing as a device.
    @param metres  length of the drawing's unit
    @param droplet  diameter of the droplet [m]
    @param turns  number of counter-clockwise turns by 90 degrees that make the flow point along +x
    @throws UserError  for an empty drawing"""
    found, others = list(drawing.circles), []
    outlines = drawing.outlines
    edge: Numbers | None = None
    if not drawing.is_picture:
        edge, outlines = edges_among(outlines, drawing.holes, np.reshape([circle[:2] for circle in found], (-1, 2)))
        refuse_swallowed(drawing, [] if edge is None else [edge])
        refuse_lost_holes(drawing, edge, tolerance)
        refuse_indented(edge, metres / droplet, droplet)
    for outline in outlines:
        is_closed = not drawing.is_picture or bool(np.allclose(outline[0], outline[-1]))
        circle = fitted_circle(outline, is_closed, tolerance)
        found.append(circle) if circle else others.append(outline)
    if drawing.frame is not None and edge is None:
        found = leave_out_centres_beyond(drawing, drawing.frame, found)
    if not found and not others:
        read = f" ({'; '.join(drawing.notes)})" if drawing.notes else ""
        raise UserError(f"the drawing holds no posts{read}; "
                        f"choose another --layer or --region, or close the outlines{drawing.layers_in_words()}")
    circles = distinct(np.reshape(found, (-1, 3))) if found else np.empty((0, 3))
    drawing.duplicates += len(found) - len(circles)
    frame = drawing.frame if edge is None else (*edge.min(axis=0), *edge.max(axis=0))
    return placed(drawing, circles, others, frame, metres / droplet, droplet, turns)


def holds_centre(region: Box, circle: tuple[float, float, float]) -> bool:
    """Whether the centre of a circle is in a region. A centre on the upper or the right border is outside, because the
    array repeats there. The centre of a fitted circle is rounded."""
    left, bottom, right, top = region
    near = ROUNDED * max(right - left, top - bottom)
    return left - near <= circle[0] < right - near and bottom - near <= circle[1] < top - near


def leave_out_centres_beyond(drawing: Drawing, frame: Box,
                             circles: list[tuple[float, float, float]]) -> list[tuple[float, float, float]]:
    """The circles with a centre within the frame of a picture or a region. Notes the number of the other circles."""
    kept = [circle for circle in circles if holds_centre(frame, circle)]
    if number := len(circles) - len(kept):
        drawing.notes.append(left_out(number, "picture" if drawing.is_picture else "region"))
    return kept


def left_out(number: int, name: str) -> str:
    """The message about posts with a centre outside a region. @param name  name of the region"""
    return f"{rounded.count_text(number, 'post')} left out that {'reaches' if number == 1 else 'reach'} into the {name} from outside"


def refuse_swallowed(drawing: Drawing, outlines: list[Numbers]) -> None:
    """Refuses outlines that came from a union with round posts, because these posts would be lost.
    @param outlines  outlines that do not become posts with their own shape"""
    number = sum(posts for outline, posts in drawing.swallowing if walls.is_one_of(outline, outlines))
    if number:
        raise UserError(f"{rounded.count_text(number, 'round post')} would vanish, because posts cross a larger "
                        "outline, such as the rim of a reservoir, and were united with it; "
                        "choose the layer of the posts by --layer, "
                        f"or a part of the drawing by --region{drawing.layers_in_words()}")


def lost_holes(drawing: Drawing, edge: Numbers | None, tolerance: float) -> list[Numbers]:
    """The holes that may be meant as posts. These are round holes, unless they are the device's edge or within a round
    post. Holes of any other form may be meant as posts if they are within the edge (or within the only outline), and
    within no other outline."""
    posts = [*drawing.circles, *filter(None, (fitted_circle(outline, True, tolerance) for outline in drawing.outlines))]
    places = np.reshape(posts, (-1, 3))
    is_alone = edge is None and len(drawing.outlines) + len(drawing.circles) == 1
    hollow = [outline for outline in drawing.outlines if outline is not edge and not is_alone]

    def is_lost(hole: Numbers) -> bool:
        if (circle := fitted_circle(hole, True, tolerance)) is not None:
            return not (np.hypot(places[:, 0] - circle[0], places[:, 1] - circle[1]) <= places[:, 2] / 2).any()
        is_in_edge = edge is not None and holds(edge, [hole])
        return is_alone or is_in_edge and not any(holds(outline, [hole]) for outline in hollow)

    return [hole for hole in drawing.holes if hole is not edge and is_lost(hole)]


def refuse_lost_holes(drawing: Drawing, edge: Numbers | None, tolerance: float) -> None:
    """@throws UserError  if holes in the drawing may be meant as posts"""
    if holes := lost_holes(drawing, edge, tolerance):
        # An area may consist of several pieces. A hole that is cut by a border between pieces is not counted here.
        least = "at least " if edge is None and len(drawing.outlines) > 1 else ""
        kind = "round hole" if all(fitted_circle(hole, True, tolerance) for hole in holes) else "hole"
        raise UserError(f"the drawing has {least}{rounded.count_text(len(holes), kind)}, which would not be posts; "
                        "--holes reads holes as posts, and --layer or --region leave them out"
                        f"{drawing.layers_in_words()}")


def refuse_indented(edge: Numbers | None, scale: float, droplet: float) -> None:
    """Refuses an edge that is no rectangle. The device is the rectangle around its edge, so material within this
    rectangle would be lost.
    @param scale  droplet diameters per unit of the drawing, @param droplet  diameter of the droplet [m]
    @throws UserError"""
    if edge is None:
        return
    low, high = edge.min(axis=0), edge.max(axis=0)
    along = np.linspace(0, 1, 9)[:-1, None]
    points = np.vstack([begin + along * (end - begin) for begin, end in zip(edge, np.roll(edge, -1, axis=0))])
    depths = scale * np.minimum(points - low, high - points).min(axis=1)
    is_deep = depths > walls.FLAT
    if is_deep.any():
        number = int((is_deep & ~np.roll(is_deep, 1)).sum()) or 1
        micrometres = droplet / METRES["um"]
        x, y = scale * (points[np.argmax(depths)] - low) * micrometres
        raise UserError(f"the device's edge is no rectangle: it has {rounded.count_text(number, 'indentation')}, "
                        f"the deepest of {depths.max():.3g} droplet diameters "
                        f"({depths.max() * micrometres:.4g} um) at x={x:.5g} um, y={y:.5g} um from the edge's lower "
                        "left corner; the material there, such as posts at the edge, would be lost. "
                        "Cut a rectangle within the edge by --region, "
                        "or draw a rectangular edge and the material within it as outlines")


def placed(drawing: Drawing, circles: Numbers, others: list[Numbers], frame: tuple[float, ...] | None, scale: float,
           droplet: float, turns: int) -> Device:
    """Turns all points, moves them to (0, 0), and converts lengths to droplet diameters."""
    turn = scale * np.linalg.matrix_power(np.array([[0, -1], [1, 0]]), turns % 4)
    circles = np.column_stack([circles[:, :2] @ turn.T, scale * circles[:, 2]])
    others = [outline @ turn.T for outline in others]
    edges = surroundings(circles, others) if frame is None else np.array(frame).reshape(2, 2) @ turn.T
    lines = [(kind, line @ turn.T) for kind, line in drawing.lines]
    reaching = [line for _, line in lines if frame is None or is_within(line, edges)]
    below, above = walls.among(circles, others, reaching, float(np.ptp(edges[:, 0])))
    sides = [*below[:1], *above[:1]]
    lines = [(kind, line) for kind, line in lines if not walls.is_one_of(line, [*below, *above])]
    others = [outline for outline in others if not walls.is_one_of(outline, [*below, *above])]
    if frame is None:
        inside = surroundings(circles, others)
        ends = [(x, inside[0, 1]) for side in sides for x in side[:, 0]]
        edges = np.vstack([inside.min(axis=0) - MARGIN, inside.max(axis=0) + MARGIN, *ends])
    low, high = edges.min(axis=0), edges.max(axis=0)
    low[1] = sides[0][:, 1].max() if below else low[1]
    high[1] = sides[-1][:, 1].min() if above else high[1]
    length, width = high - low
    circles[:, :2] -= low
    return Device(circles=circles, others=[outline - low for outline in others], length=float(length),
                  width=float(width), has_frame=frame is not None, droplet_metres=droplet,
                  walls=[side - low for side in sides], lines=[(kind, line - low) for kind, line in lines])


def is_within(line: Numbers, edges: Numbers) -> bool:
    """Whether a line is within the drawn edge of the device. A line beside the edge, such as a dimension line, is no
    wall."""
    return bool((line >= edges.min(axis=0) - NEAR).all() and (line <= edges.max(axis=0) + NEAR).all())


def surroundings(circles: Numbers, others: list[Numbers]) -> Numbers:
    """Points that have the same bounding box as all posts together."""
    radii = circles[:, 2:] / 2
    return np.vstack([circles[:, :2] - radii, circles[:, :2] + radii, *others])


def slender(outlines: list[Numbers]) -> list[Numbers]:
    """The outlines that are at least three times as long as wide. Scale bars and labels have such outlines."""

    def is_slender(outline: Numbers) -> bool:
        near = along_edges(outline, True)
        near = near - near.mean(axis=0)
        along = near @ np.linalg.svd(near, full_matrices=False)[2].T  # along the principal axes
        length, width = np.ptp(along, axis=0)
        return bool(length >= walls.SLENDER * width)

    return [outline for outline in outlines if is_slender(outline)]


def valid(polygon: Any) -> Any:
    """@throws UserError  if its outline crosses itself"""
    if not polygon.is_valid:
        x, y = np.asarray(polygon.exterior.coords).mean(axis=0)
        raise UserError(f"the outline around x={x:.4g}, y={y:.4g} in droplet diameters crosses itself; "
                        "correct it in the drawing")
    return polygon


def as_circles(device: Device) -> Device:
    """The device with a circle in place of each outline that is not round. The circle and the outline have equal areas.
    @throws UserError  if an outline crosses itself, because the areas of its parts have different signs"""
    if device.others:
        geometry = library("shapely.geometry", "python3-shapely")
        for outline in device.others:
            valid(geometry.Polygon(outline))
    made = [(*centroid(outline), 2 * np.sqrt(abs(area(outline)) / np.pi)) for outline in device.others]
    return dataclasses.replace(device, circles=np.vstack([device.circles,
                                                          np.array(made or np.empty((0, 3)))]), others=[])


def csv_of(device: Device, source: str) -> str:
    """A CSV file of circles for clogsweep, in micrometres. Lengths are rounded to a nanometre, or to six digits of the
    smallest diameter or gap if this is finer."""
    unit = device.droplet_micrometres
    lines = [f"# circles of {source}", f"# units=um droplet={unit:.10g}um",
             f"# the device is {device.length * unit:.10g} long and {device.width * unit:.10g} wide", "x,y,diameter"]
    smallest = unit * min(float(device.circles[:, 2].min(initial=np.inf)), device.smallest_gap())
    decimals = max(3, 5 - math.floor(math.log10(smallest))) if 0 < smallest < np.inf else 3
    lines += [",".join(f"{round(value * unit, decimals):.15g}" for value in circle) for circle in device.circles]
    return "\n".join(lines) + "\n"
