"""A device as a whole: what was understood of its drawing; where droplets of a sweep were released, passed and clogged."""

from __future__ import annotations

import dataclasses
import pathlib
import tempfile
from collections.abc import Sequence
from typing import TypeVar

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PatchCollection
from matplotlib.figure import Figure
from matplotlib.patches import Circle, Polygon, Rectangle
from matplotlib.transforms import ScaledTranslation

from .. import style
from ..device.shapes import METRES, Device
from ..reading import replays, stored
from ..tools import rounded
from ..tools.errors import UserError
from ..tools.hints import AnyPath, Numbers, Records
from . import surroundings

WIDEST, NARROWEST = 14.0, 5.0  # figures [inches]
RED = "#D00000"
T = TypeVar("T")
STEP = 0.1  # between two points of a way, of a free droplet [sigma]
CELL = 0.1  # of the map of passages [sigma]


def axes_for(length: float, width: float, rows: int = 1) -> tuple[Figure, Numbers]:
    """A figure and its axes, with equal scales along and across a device of this shape. @param rows  2: with a strip below it"""
    figure_width = min(WIDEST, max(NARROWEST, 0.45 * length))
    height = min(12.0, max(2.2, figure_width * width / length))
    figure, axes = style.subplots(rows, figsize=(figure_width, height + 1.3 + 1.5 * (rows - 1)), squeeze=False, sharex=True,
                                  height_ratios=[height, 1.5][:rows])
    return figure, axes[:, 0]


def draw_posts(axes: Axes, circles: Numbers, colour: str = style.OBSTACLE) -> None:
    """@param circles  (n, 3): x, y, diameter"""
    axes.add_collection(PatchCollection([Circle((x, y), diameter / 2) for x, y, diameter in circles], facecolor=colour, edgecolor="none"))


def frame(axes: Axes, length: float, width: float, line: str, points_below: float, beside: Sequence[Numbers] = ()) -> None:
    """The edge of the device, and what is beside it. @param points_below  where the arrow of the flow is; @param beside  lines to be
    in the picture, too, unless they are farther away than the device is large"""
    axes.add_patch(Rectangle((0, 0), length, width, fill=False, edgecolor="0.3", linestyle=line))
    size = np.array([length, width])
    points = np.clip(np.vstack([np.zeros(2), size, *beside]), -size, 2 * size)
    margin = 0.02 * max(length, width) + 0.5
    surroundings.frame_limits(axes, tuple(points.min(axis=0) - margin), tuple(points.max(axis=0) + margin))
    surroundings.draw_bar(axes)
    draw_flow(axes, points_below)
    axes.set_ylabel(r"$y/\sigma$")


def draw_flow(axes: Axes, points_below: float) -> None:
    """An arrow along the flow, below the right end of the axes, where no post is."""
    place = axes.transAxes + ScaledTranslation(0, -points_below / 72, axes.figure.dpi_scale_trans)
    start = axes.transAxes + ScaledTranslation(-0.6, -points_below / 72, axes.figure.dpi_scale_trans)
    axes.annotate("flow", (1, 0), (1, 0), xycoords=place, textcoords=start, va="center", ha="right", fontsize=9, annotation_clip=False,
                  arrowprops={"arrowstyle": "-|>", "linewidth": 1.5, "color": "black", "shrinkB": 0})


def understood(device: Device, source: str) -> Figure:
    """Posts grey, what is not round red, the edge dashed. @param source  name of the drawing"""
    figure, (axes,) = axes_for(device.length, device.width)
    draw_posts(axes, device.circles)
    for outline in device.others:
        axes.add_patch(Polygon(outline, facecolor=RED, edgecolor="black", linewidth=0.5))
    for outline in device.replaced:
        axes.add_patch(Polygon(outline, facecolor=style.OBSTACLE, edgecolor=RED, linewidth=0.5))
    for outline in device.walls:
        axes.add_patch(Polygon(outline, facecolor=style.OBSTACLE, edgecolor=style.OBSTACLE))
    for line in device.lines:
        axes.plot(*line.T, color=RED, linewidth=1.0)
    for pair in device.overlaps():
        draw_posts(axes, device.circles[list(pair)], RED)
    frame(axes, device.length, device.width, "--" if device.has_frame else ":", 26, [*device.walls, *device.lines])
    axes.set_xlabel(r"$x/\sigma$, along the flow")
    micrometres = device.droplet_metres / METRES["um"]
    red = f", {len(device.others)} not round (red)" if device.others else ""
    style.caption(axes, rf"{source}: {rounded.counted(device.num_posts(), 'post')}{red}, "
                        rf"$\sigma$ = {micrometres:.4g} µm, device {device.length * micrometres:.5g} µm x {device.width * micrometres:.5g} µm")
    return figure


@dataclasses.dataclass
class Place:
    """The user-supplied circles that runs of a sweep share, and these runs."""

    name: str
    circles: Numbers  # (n, 3): x, y, diameter
    length: float
    width: float
    has_walls: bool
    exit: float  # 0: there is none
    rows: Records

    def wrapped(self, points: Numbers) -> Numbers:
        """Back into the device, of places (n, 2) of droplets for which it repeats."""
        x, y = points.T
        return np.column_stack([x if self.exit > 0 else x % self.length, y if self.has_walls else y % self.width])

    @property
    def releases(self) -> Numbers:
        return np.column_stack([self.rows["release_x"], self.rows["release_y"]])

    @property
    def ends(self) -> Numbers:
        return self.releases + np.column_stack([self.rows["distance"], self.rows["lateral_displacement"]])


DEVICE_COLUMNS = ["obstacles", "obstacle_diameter", "box", "boxes", "length", "side_walls", "exit"]


def places(path: AnyPath, folder: AnyPath | None = None) -> list[Place]:
    """The devices of a sweep. @throws UserError  if it has none, or does not say where droplets were released"""
    with stored.opened(path, stored.SWEEP, folder) as file:
        rows, circles, names = file["runs"][:], stored.circles(file), stored.circle_files(file)
    own = rows[rows["obstacle_filling"] == b"file"]
    if len(own) == 0:
        raise UserError(f"{path} has no circles of your own; python3 -m clogsweep droplet and clogs show what droplets meet")
    if "release_x" in stored.columns_of(rows):
        own = own[np.isfinite(own["release_x"])]
    if "release_x" not in stored.columns_of(rows) or len(own) == 0:
        raise UserError(f"{path} does not say where droplets were released (an older version ran them, or none has begun); sweep anew, or wait")
    found = []
    for kind in np.unique(own[DEVICE_COLUMNS]):
        check_sum = kind["obstacles"].decode()
        radii = circles[check_sum][:, 2]
        table = circles[check_sum].copy()
        table[:, 2] = np.where(radii > 0, 2 * radii, kind["obstacle_diameter"])
        found.append(Place(name=names.get(check_sum) or check_sum, circles=table, length=float(kind["length"] or kind["boxes"] * kind["box"]), width=float(kind["box"]),
                           has_walls=kind["side_walls"] == b"on", exit=float(kind["exit"]), rows=own[own[DEVICE_COLUMNS] == kind]))
    return found


def the_place(path: AnyPath, folder: AnyPath | None = None) -> Place:
    """@throws UserError  as places(), and if there are several"""
    found = places(path, folder)
    if len(found) > 1:
        raise UserError(f"{path} has {len(found)} devices ({', '.join(sorted({place.name for place in found}))}); sweep one at a time to draw it")
    return found[0]


def chosen(rows: Records, number: int) -> list[np.void]:
    """Runs whose ways are to be shown, evenly among all that are over, from the shortest way to the longest."""
    over = np.sort(rows[np.isin(rows["status"], [b"clogged", b"flowing", b"passed", b"broken"])], order=["distance", "task"])
    return evenly(list(over), number)


def evenly(members: list[T], number: int) -> list[T]:
    """So many of them at most, the first and the last among them."""
    if number == 0 or not members:
        return []
    return [members[i] for i in np.unique(np.linspace(0, len(members) - 1, min(number, len(members))).round().astype(int))]


def ways_of(place: Place, sweep: pathlib.Path, clogrun: pathlib.Path, number: int, jobs: int) -> list[Numbers]:
    """Places of the centre on the way (n, 2), from replayed runs."""
    rows = chosen(place.rows, number)
    if not rows:
        return []
    samples = STEP / min(float(row["terminal_speed"]) for row in rows)
    with tempfile.TemporaryDirectory(prefix="clogsweep-device-") as folder:
        runs = replays.follow_all(clogrun, sweep, rows, folder, jobs, samples)
    return [np.array([row["release_x"], row["release_y"]]) + np.column_stack([run.table["distance"], run.table["lateral_displacement"]])
            for row, run in zip(rows, runs)]


def shown_ways(place: Place, sweep: pathlib.Path, clogrun: pathlib.Path, num_lines: int, num_mapped: int, jobs: int) -> tuple[list[Numbers], list[Numbers]]:
    """Those to be lines, and those for the map."""
    ways = ways_of(place, sweep, clogrun, max(num_lines, num_mapped), jobs)
    return evenly(ways, num_lines), evenly(ways, num_mapped)


def unbroken(points: Numbers, place: Place) -> Numbers:
    """A way in the device, with a gap wherever it leaves at one side and comes in at the other."""
    inside = place.wrapped(points)
    jumps = np.flatnonzero((np.abs(np.diff(inside, axis=0)) > [place.length / 2, place.width / 2]).any(axis=1)) + 1
    return np.insert(inside, jumps, np.nan, axis=0)


def draw_ends(axes: Axes, place: Place) -> None:
    """Draws where droplets clogged and by which mechanism, and where they passed the exit, broke up, or ran out of time."""
    ends = place.wrapped(place.ends)
    words = {"flowing": (".", "0.2", "still moving"), "passed": (">", "0.2", "passed"), "broken": ("*", style.CAUSE_COLOURS["broken"], "broken")}
    for status, (marker, colour, name) in words.items():
        of_status = place.rows["status"] == status.encode()
        if of_status.any():
            axes.plot(*ends[of_status].T, marker, color=colour, markersize=5, linestyle="none", label=f"{name}: {of_status.sum()}", zorder=4)
    clogged = place.rows["status"] == b"clogged"
    for mechanism, marker in style.MECHANISM_MARKERS.items():
        named = place.rows["mechanism"] == mechanism.encode()
        others = ~np.isin(place.rows["mechanism"], [name.encode() for name in style.MECHANISM_MARKERS])
        of_kind = clogged & (named | others if mechanism == "other" else named)
        if of_kind.any():
            axes.plot(*ends[of_kind].T, marker, color=style.MECHANISM_COLOURS[mechanism], markersize=6, markeredgecolor="white", linestyle="none",
                      label=f"clogged, {mechanism}: {of_kind.sum()}", zorder=5)


def draw_passages(axes: Axes, place: Place) -> None:
    """The number of droplets that passed each place along the flow. One that passes the device twice counts twice."""
    cells = np.linspace(0, place.length, 201)
    middles = (cells[1:] + cells[:-1]) / 2
    counts = np.zeros(len(middles))
    for begin, end in zip(place.releases[:, 0], place.ends[:, 0]):
        for lap in range(int(np.floor(begin / place.length)), int(np.floor(end / place.length)) + 1) if place.exit == 0 else (0,):
            at = middles + lap * place.length
            counts += (at >= begin) & (at <= end)
    axes.fill_between(middles, counts, step="mid", color=style.COLOURS[5], alpha=0.6, linewidth=0)
    axes.set_ylabel("droplets\nthat came past")
    axes.set_ylim(bottom=0)
    axes.set_xlabel(r"$x/\sigma$, along the flow")
    style.grid(axes)


def passages(place: Place, ways: Sequence[Numbers]) -> Numbers:
    """Share of the droplets that passed over each cell (y, x) of the device, each taken as a disk of its diameter around its centre."""
    rows, columns = (max(1, round(size / CELL)) for size in (place.width, place.length))
    reach = np.arange(-int(0.5 / CELL), int(0.5 / CELL) + 1)
    disk = np.array([(i, j) for i in reach for j in reach if np.hypot(i, j) * CELL < 0.5])
    counts = np.zeros((rows, columns))
    for way in ways:
        points = place.wrapped(along(way))
        cells = np.unique((points / (place.length, place.width) * (columns, rows)).astype(int), axis=0)[:, ::-1]
        covered = (cells[:, None, :] + disk[None, :, :]).reshape(-1, 2)
        # Beyond a wall or an exit there is nothing; elsewhere the device repeats.
        inside = ((not place.has_walls) | (covered[:, 0] >= 0) & (covered[:, 0] < rows)) & ((place.exit == 0) | (covered[:, 1] >= 0) & (covered[:, 1] < columns))
        covered = covered[inside] % (rows, columns)
        over = np.zeros_like(counts, dtype=bool)
        over[covered[:, 0], covered[:, 1]] = True
        counts += over
    return counts / max(1, len(ways))


def along(way: Numbers) -> Numbers:
    """With further points where two are farther apart than a cell."""
    ways = np.concatenate([[0], np.cumsum(np.hypot(*np.diff(way, axis=0).T))])
    wanted = np.linspace(0, ways[-1], int(ways[-1] / CELL) + 2)
    return np.column_stack([np.interp(wanted, ways, way[:, axis]) for axis in (0, 1)])


def draw_map(figure: Figure, panels: Sequence[Axes], place: Place, ways: Sequence[Numbers]) -> None:
    """Where droplets went, on the first of the panels. The scale is beside all."""
    shares = passages(place, ways)
    drawn = panels[0].imshow(np.where(shares > 0, shares, np.nan), extent=(0, place.length, 0, place.width), origin="lower", cmap=style.PASSAGES, vmin=0,
                             interpolation="nearest", aspect="equal", zorder=0)
    scale = figure.colorbar(drawn, ax=list(panels), pad=0.01, fraction=0.05)
    scale.set_label(f"share of {len(ways)} of {rounded.counted(len(place.rows), 'droplet')}\nthat passed over it", fontsize=8)


def draw(place: Place, lines: Sequence[Numbers] = (), mapped: Sequence[Numbers] = ()) -> Figure:
    """@param lines, mapped  ways of shown_ways(), for lines and for the map"""
    figure, (axes, below) = axes_for(place.length, place.width, rows=2)
    if mapped:
        draw_map(figure, [axes, below], place, mapped)
    draw_posts(axes, place.circles)
    frame(axes, place.length, place.width, "-" if place.has_walls else ":", 12)
    if place.exit > 0:
        axes.axvline(place.exit, color="0.3", linestyle="--", linewidth=0.8)
    for number, way in enumerate(lines):
        axes.plot(*unbroken(way, place).T, color=style.VIRIDIS(0.85 * number / max(1, len(lines) - 1)), linewidth=1.0, zorder=3)
    axes.plot(*place.wrapped(place.releases).T, "|", color="#009E73", markersize=7, label=f"released: {len(place.rows)}", zorder=4)
    draw_ends(axes, place)
    axes.legend(loc="lower left", bbox_to_anchor=(0, 1.0), ncols=4, fontsize=8, frameon=False)
    draw_passages(below, place)
    walls = "between walls" if place.has_walls else "periodic across the flow"
    figure.suptitle(f"{place.name}: {rounded.counted(len(place.circles), 'circle')}, {place.length:.4g} x {place.width:.4g} droplet diameters, {walls}", fontsize=9)
    return figure
