"""Draws a device, and shows where the droplets of a sweep were released, passed and clogged."""

from __future__ import annotations

import dataclasses
import pathlib
import sys
import tempfile
from collections.abc import Sequence
from typing import TypeVar

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.image import AxesImage

from .. import style
from ..labels.groups import Groups
from ..reading import replays, stored
from ..tools import progress, rounded
from ..tools.errors import UserError
from ..tools.hints import AnyPath, Group, Numbers, Records
from ..tools.texts import literal
from . import device_plan, surroundings

T = TypeVar("T")
OVER = [b"clogged", b"flowing", b"passed", b"broken", b"failed"]
MOST_PANELS = 6
# The width of the colour bar, which is also the width of the legend without its text, and the width of a letter in the
# legend [inches].
BESIDE, OF_LETTER = 0.9, 0.055
SITE = 0.25  # Clogs closer together than this are at one place [sigma].
STEP = 0.1  # Distance between two points of the path of a free droplet [sigma].
CELL = 0.1  # Side of a cell in the map of passages [sigma].


@dataclasses.dataclass
class Place:
    """User-supplied circles, and the runs of a sweep among these circles."""

    name: str
    circles: Numbers  # (n, 3): x, y, diameter
    length: float
    width: float
    has_walls: bool
    exit: float  # distance of the exit from the entrance, or 0 if there is no exit
    rows: Records
    droplet: float = 1.0  # Diameter of the droplet in the unit of all lengths.
    unit: str = ""  # Name of the unit of all lengths. The name is empty if this unit is the droplet's diameter.

    def coordinate(self, name: str) -> str:
        """The label of an axis."""
        return f"${name}$ [{self.unit}]" if self.unit else rf"${name}/\sigma$"

    def scaled(self, droplet_mm: float) -> Place:
        """The same device with lengths in millimetres."""
        rows = self.rows.copy()
        for name in ("release_x", "release_y", "distance", "sound_distance", "lateral_displacement"):
            rows[name] *= droplet_mm
        lengths = {name: getattr(self, name) * droplet_mm for name in ("circles", "length", "width", "exit")}
        return dataclasses.replace(self, name=self.name.rpartition("@")[0] or self.name, rows=rows, droplet=droplet_mm,
                                   unit="mm", **lengths)

    def is_same_device(self, other: Place) -> bool:
        """Whether posts, edges and exit of both devices have the same places, apart from the rounding of stored
        lengths."""
        return len(self.circles) == len(other.circles) and self.has_walls == other.has_walls and all(
            np.allclose(getattr(self, name), getattr(other, name), rtol=1e-5, atol=1e-5 * self.droplet)
            for name in ("circles", "length", "width", "exit"))

    def wrapped(self, points: Numbers) -> Numbers:
        """Maps positions (n, 2) back into the device in each direction in which the device is periodic."""
        x, y = points.T
        return np.column_stack([x if self.exit > 0 else x % self.length, y if self.has_walls else y % self.width])

    def parts(self, groups: Groups) -> list[Part]:
        """The runs of each parameter set, in the order of clogfit's table. Sets without any ended run are left out."""
        found = []
        for member in groups.members:
            is_of_group = np.ones(len(self.rows), dtype=bool)
            for name, value in groups.row_values(member).items():
                is_of_group &= self.rows[name] == (value.encode() if isinstance(value, str) else value)
            if np.isin(self.rows["status"][is_of_group], OVER).any():
                found.append(Part(panel_label(groups, member), dataclasses.replace(self, rows=self.rows[is_of_group]),
                                  member["displaced"], member.get("diameter_mm")))
        return found

    @property
    def releases(self) -> Numbers:
        return np.column_stack([self.rows["release_x"], self.rows["release_y"]])

    @property
    def ends(self) -> Numbers:
        """The places where the droplets were last observed. The y of failed droplets is unknown (NaN)."""
        across = np.where(self.rows["status"] == b"failed", np.nan, self.rows["lateral_displacement"])
        return self.releases + np.column_stack([np.nan_to_num(stored.observed_distances(self.rows)), across])


def panel_label(groups: Groups, member: Group) -> str:
    """The parameters that distinguish a group. If the laboratory is known, they include the interfacial tension."""
    tension = member.get("tension_mN_per_m") if "line_tension" in groups.distinguishing() else None
    return groups.label_of(member) + (f" ({rounded.plain(tension)} mN/m)" if tension else "")


@dataclasses.dataclass
class Part:
    """The runs of one parameter set in a device, and some paths."""

    label: str
    place: Place
    num_displaced: int = 0  # Number of droplets that were not released at their random place on the entrance.
    droplet_mm: float | None = None  # Diameter of the droplet, if it is known.
    lines: Sequence[Numbers] = ()  # Paths of droplet centres that are drawn as lines (n, 2).
    mapped: Sequence[Numbers] = ()  # Paths of droplet centres that make up the map of passages (n, 2).
    shares: Numbers | None = None  # The map of passages.

    def scaled(self, droplet_mm: float) -> Part:
        return dataclasses.replace(self, place=self.place.scaled(droplet_mm),
                                   lines=[line * droplet_mm for line in self.lines])


DEVICE_COLUMNS = ["obstacles", "obstacle_diameter", "box", "boxes", "length", "side_walls", "exit"]


def beginnings_of_ways(rows: Records) -> Numbers:
    """The x at which droplets start. The void nearest to an entrance may be across the border of the array. The result
    is then the x of the periodic image nearest to the entrance."""
    x, entrance = rows["release_x"], rows["entrance"]
    period = np.where(rows["length"] > 0, rows["length"], rows["boxes"] * rows["box"])
    away = x - entrance
    return np.where(rows["release"] == b"entrance", entrance + away - period * np.round(away / period), x)


def places(path: AnyPath, folder: AnyPath | None = None) -> list[Place]:
    """The devices of a sweep. @throws UserError  if the sweep has no device, or does not state where droplets were
    released"""
    with stored.opened(path, stored.SWEEP, folder) as file:
        rows, circles, names = file["runs"][:], stored.circles(file), stored.circle_files(file)
    own = rows[rows["obstacle_filling"] == b"file"]
    if len(own) == 0:
        raise UserError(f"{path} has no circles of your own; "
                        "python3 -m clogsweep droplet and clogs show what droplets meet")
    own = own[np.isfinite(own["release_x"])]
    own["release_x"] = beginnings_of_ways(own)
    if len(own) == 0:
        raise UserError(f"{path} does not say where droplets were released (none has begun); wait")
    found = []
    for kind in np.unique(own[DEVICE_COLUMNS]):
        check_sum = stored.text(kind["obstacles"])
        radii = circles[check_sum][:, 2]
        table = circles[check_sum].copy()
        table[:, 2] = np.where(radii > 0, 2 * radii, kind["obstacle_diameter"])
        found.append(Place(name=names.get(check_sum) or check_sum, circles=table,
                           length=float(kind["length"] or kind["boxes"] * kind["box"]), width=float(kind["box"]),
                           has_walls=kind["side_walls"] == b"on", exit=float(kind["exit"]),
                           rows=own[own[DEVICE_COLUMNS] == kind]))
    return found


def pictures(found: Sequence[Place], groups: Groups) -> list[list[Part]]:
    """The parameter sets of each picture. There is one picture for each device. Droplets of several sizes among the
    same posts are in one picture, too: they have several devices in droplet diameters, but one device in
    millimetres."""
    every = [place.parts(groups) for place in found]
    # In the order of clogfit's table
    labels = [panel_label(groups, member) for member in groups.members]
    joined = sorted((part for parts in every for part in parts), key=lambda part: labels.index(part.label))
    if len(found) > 1 and joined and all(part.droplet_mm for part in joined):
        in_mm = [part.place.scaled(part.droplet_mm or 1) for part in joined]
        if all(in_mm[0].is_same_device(other) for other in in_mm):
            return [joined]
    return every


def the_picture(found: Sequence[Place], groups: Groups, path: AnyPath) -> list[Part]:
    """The parameter sets of the only device of a sweep. @throws UserError  if there are several devices"""
    drawn = pictures(found, groups)
    if len(drawn) > 1:
        names = ", ".join(sorted({f"{place.name}: {stored.text(place.rows[0]['obstacles'])}" for place in found}))
        raise UserError(f"cannot draw {len(found)} devices as one; "
                        f"clogsweep select {path} obstacles=SUM --output one.h5 takes one of them ({names})")
    return drawn[0]


def chosen(rows: Records, number: int) -> list[np.void]:
    """Chooses the runs whose paths are shown. The ended runs are sorted by distance, and every n-th run is chosen."""
    over = np.sort(rows[np.isin(rows["status"], OVER) & (rows["status"] != b"failed")], order=["distance", "task"])
    return evenly(list(over), number)


def evenly(members: list[T], number: int) -> list[T]:
    """At most `number` of the members, evenly spaced, including the first and the last member."""
    if number == 0 or not members:
        return []
    return [members[i] for i in np.unique(np.linspace(0, len(members) - 1, min(number, len(members))).round().astype(int))]


def ways_of(place: Place, sweep: pathlib.Path, clogrun: pathlib.Path, number: int, jobs: int) -> list[Numbers]:
    """Replays runs. @return the paths of the droplets' centres (n, 2)"""
    rows = chosen(place.rows, number)
    if not rows:
        return []
    samples = STEP / min(float(row["terminal_speed"]) for row in rows)
    with tempfile.TemporaryDirectory(prefix="clogsweep-device-") as folder:
        runs = replays.follow_all(clogrun, sweep, rows, folder, jobs, samples)
    return [np.array([row["release_x"], row["release_y"]])
            + np.column_stack([run.table["distance"], run.table["lateral_displacement"]])
            for row, run in zip(rows, runs)]


def shown_parts(every: Sequence[Part], sweep: pathlib.Path, clogrun: pathlib.Path, num_lines: int, num_mapped: int,
                jobs: int) -> tuple[list[Part], int]:
    """The parameter sets that have a panel, with their paths, and the number of all parameter sets. Prints a line if
    some parameter sets have no panel.
    @param num_lines  number of runs in each panel whose path is drawn as a line
    @param num_mapped  number of runs in the map of each panel
    @throws UserError  if no run has ended"""
    if not every:
        raise UserError("no run among the circles has ended; let the sweep finish some first")
    shown = evenly(list(every), MOST_PANELS)
    if len(shown) < len(every):
        print(f"{shown[0].place.name}: {len(shown)} of {len(every)} parameter sets are drawn; "
              "clogsweep select makes a sweep of the others", file=sys.stderr)
    for part in progress.shown(shown, "replayed panel", len(shown)):
        ways = ways_of(part.place, sweep, clogrun, max(num_lines, num_mapped), jobs)
        part.lines, part.mapped = evenly(ways, num_lines), evenly(ways, num_mapped)
        part.shares = passages(part.place, part.mapped) if part.mapped else None
    return in_one_unit(shown), len(every)


def in_one_unit(parts: list[Part]) -> list[Part]:
    """Droplets of several sizes are drawn in millimetres, others in droplet diameters."""
    if len({part.place.length for part in parts}) == 1:
        return parts
    return [part.scaled(part.droplet_mm or 1) for part in parts]


def unbroken(points: Numbers, place: Place) -> Numbers:
    """A path in the device. The path has a gap where the droplet leaves the device at one side and enters the device
    again at the opposite side."""
    inside = place.wrapped(points)
    jumps = np.flatnonzero((np.abs(np.diff(inside, axis=0)) > [place.length / 2, place.width / 2]).any(axis=1)) + 1
    return np.insert(inside, jumps, np.nan, axis=0)


def draw_ends(axes: Axes, place: Place) -> None:
    """Draws where droplets clogged and by which mechanism. Also draws where droplets passed the exit, broke up, or ran
    out of time. Failed droplets are only counted."""
    ends = place.wrapped(place.ends)
    words = {"flowing": (".", "0.2", "still moving"), "passed": (">", "0.2", "passed"),
             "broken": ("*", style.CAUSE_COLOURS["broken"], "broken")}
    for status, (marker, colour, name) in words.items():
        of_status = place.rows["status"] == status.encode()
        if of_status.any():
            axes.plot(*ends[of_status].T, marker, color=colour, markersize=5, linestyle="none",
                      label=f"{name}: {of_status.sum()}", zorder=4)
    if num_failed := np.count_nonzero(place.rows["status"] == b"failed"):
        axes.plot([], [], linestyle="none", label=f"failed: {num_failed}")
    clogged = place.rows["status"] == b"clogged"
    for mechanism, marker in style.MECHANISM_MARKERS.items():
        named = place.rows["mechanism"] == mechanism.encode()
        others = ~np.isin(place.rows["mechanism"], [name.encode() for name in style.MECHANISM_MARKERS])
        of_kind = clogged & (named | others if mechanism == "other" else named)
        if of_kind.any():
            axes.plot(*ends[of_kind].T, marker, color=style.MECHANISM_COLOURS[mechanism],
                      markersize=6, markeredgecolor="white", linestyle="none",
                      label=f"clogged, {mechanism}: {of_kind.sum()}", zorder=5)
    for site, count in sites(ends[clogged], SITE * place.droplet):
        if count > 1:
            axes.annotate(str(count), site, (4, 3), textcoords="offset points", fontsize=8, zorder=7,
                          path_effects=[surroundings.HALO])


def sites(points: Numbers, reach: float) -> list[tuple[Numbers, int]]:
    """Mean places of points that are near each other, with the numbers of these points."""
    found = []
    while len(points):
        near = np.hypot(*(points - points[0]).T) < reach
        found.append((points[near].mean(axis=0), int(near.sum())))
        points = points[~near]
    return found


ROUND_OFF = 1e-6  # Largest rounding error of the place of a release [sigma].


def has_daughters(rows: Records) -> bool:
    """Whether runs follow the daughters of droplets that break up."""
    return "break_up" in (rows.dtype.names or ()) and bool((rows["break_up"] == b"daughters").any())


def came_past(place: Place) -> tuple[Numbers, Numbers]:
    """Places along the flow, and for each place the fraction of droplets that passed it. A droplet counts at a place
    only if the place is downstream of the release. Droplets that were still moving upstream of the place at the end of
    their run do not count. clogfit has the same rules. Without entrance and exit, a place has periodic images; its
    first image downstream of the release counts.
    @return the places, and the fractions, which are NaN where no droplet counts"""
    cells = np.linspace(0, place.length, 201)
    middles = (cells[1:] + cells[:-1]) / 2
    if place.exit > 0:
        middles = middles[middles <= place.exit]
    begins, ends = place.releases[:, :1], place.ends[:, :1]
    is_final = np.isin(place.rows["status"], [b"clogged", b"broken"])[:, None]
    repeats = (place.rows["release"] != b"entrance")[:, None] & (place.exit == 0)
    images = middles + np.where(repeats, place.length * np.ceil((begins - middles) / place.length), 0)
    is_behind = begins <= images + ROUND_OFF
    passed = (is_behind & (ends >= images)).sum(axis=0)
    known = passed + (is_behind & (ends < images) & is_final).sum(axis=0)
    return middles, np.where(known > 0, passed / np.maximum(1, known), np.nan)


def draw_passages(axes: Axes, parts: Sequence[Part]) -> None:
    """Draws the fraction of the droplets that passed each place along the flow."""
    for number, part in enumerate(parts):
        axes.step(*came_past(part.place), where="mid", color=style.shades(len(parts))[number], linewidth=1.2,
                  label=part.label)
    axes.set_ylabel("share that\ncame past")
    axes.set_ylim(bottom=0)
    style.grid(axes)
    if len(parts) > 1:
        axes.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0), fontsize=8, frameon=False)


def passages(place: Place, ways: Sequence[Numbers]) -> Numbers:
    """The fraction of the droplets that passed over each cell (y, x) of the device. Each droplet covers a disk of its
    diameter around its centre."""
    rows, columns = (max(1, round(size / CELL)) for size in (place.width, place.length))
    reach = np.arange(-int(0.5 / CELL), int(0.5 / CELL) + 1)
    disk = np.array([(i, j) for i in reach for j in reach if np.hypot(i, j) * CELL < 0.5])
    counts = np.zeros((rows, columns))
    for way in ways:
        points = place.wrapped(along(way))
        cells = np.unique((points / (place.length, place.width) * (columns, rows)).astype(int), axis=0)[:, ::-1]
        covered = (cells[:, None, :] + disk[None, :, :]).reshape(-1, 2)
        # No droplet moves beyond a wall or an exit. In a direction without walls or exit, the device repeats.
        is_in_width = (not place.has_walls) | (covered[:, 0] >= 0) & (covered[:, 0] < rows)
        is_in_length = (place.exit == 0) | (covered[:, 1] >= 0) & (covered[:, 1] < columns)
        inside = is_in_width & is_in_length
        covered = covered[inside] % (rows, columns)
        over = np.zeros_like(counts, dtype=bool)
        over[covered[:, 0], covered[:, 1]] = True
        counts += over
    return counts / max(1, len(ways))


def along(way: Numbers) -> Numbers:
    """Inserts points into a path where neighbouring points are farther apart than a cell."""
    ways = np.concatenate([[0], np.cumsum(np.hypot(*np.diff(way, axis=0).T))])
    wanted = np.linspace(0, ways[-1], int(ways[-1] / CELL) + 2)
    return np.column_stack([np.interp(wanted, ways, way[:, axis]) for axis in (0, 1)])


def draw_map(axes: Axes, place: Place, shares: Numbers) -> AxesImage:
    """Draws the map of passages."""
    return axes.imshow(np.where(shares > 0, shares, np.nan), extent=(0, place.length, 0, place.width), origin="lower",
                       cmap=style.PASSAGES, vmin=0, vmax=1, interpolation="nearest", aspect="equal", zorder=0)


def draw_scale(figure: Figure, panels: Sequence[Axes], drawn: AxesImage, parts: Sequence[Part]) -> None:
    """Draws the colour bar of the maps."""
    counts = {len(part.mapped) for part in parts if part.mapped}
    most = ("" if len(counts) == 1 else "up to ") + rounded.count_text(max(counts), "droplet")
    scale = figure.colorbar(drawn, ax=list(panels), pad=0.01, fraction=0.05)
    scale.set_label(f"share of {most}{' each' if len(parts) > 1 else ''}\nthat passed over it", fontsize=8)


def draw_part(axes: Axes, part: Part, legend_columns: int) -> None:
    place = part.place
    device_plan.draw_posts(axes, place.circles)
    device_plan.frame(axes, place.length, place.width, "-" if place.has_walls else ":", droplet=place.droplet)
    axes.set_ylabel(f"{part.label}\n{place.coordinate('y')}".strip())
    if place.exit > 0:
        axes.axvline(place.exit, color="0.3", linestyle="--", linewidth=0.8)
    for number, way in enumerate(part.lines):
        axes.plot(*unbroken(way, place).T, color=style.COLOURS[number % len(style.COLOURS)], linewidth=1.0, zorder=3)
    axes.plot(*place.wrapped(place.releases).T, "|", color="#009E73", markersize=7, zorder=4,
              label=f"released: {len(place.rows)}"
              + (f", displaced: {part.num_displaced}" if part.num_displaced else ""))
    draw_ends(axes, place)
    axes.legend(loc="lower left", bbox_to_anchor=(0, 1.0), ncols=legend_columns, fontsize=8, frameon=False,
                borderaxespad=0.2)


def draw(parts: Sequence[Part], num_parts: int, droplet_mm: float | None = None) -> Figure:
    """Draws a panel for each part, and a strip that compares the parts.
    @param parts  of one device
    @param num_parts  number of all parameter sets of the device
    @param droplet_mm  diameter of the droplet [mm], if it is known"""
    place = parts[0].place
    if len(parts) > 1:
        beside = BESIDE + OF_LETTER * max(len(part.label) for part in parts)
    else:
        beside = BESIDE if parts[0].mapped else 0
    figure, (*panels, below) = device_plan.axes_for(place.length / place.droplet, place.width / place.droplet,
                                                    len(parts), strip=1.5, beside=beside)
    is_grid = below.get_gridspec().ncols > 1
    maps = [draw_map(axes, part.place, part.shares) for axes, part in zip(panels, parts) if part.shares is not None]
    for axes, part in zip(panels, parts):
        draw_part(axes, part, 2 if is_grid else 4)
    if maps:
        draw_scale(figure, panels, maps[0], parts)
    device_plan.draw_gravity(panels[-1], 26 if is_grid else 12)
    draw_passages(below, parts)
    below.set_xlabel(f"{place.coordinate('x')}, along gravity"
                     + (rf"; $\sigma$ = {droplet_mm:.4g} mm" if droplet_mm else ""))
    if any(has_daughters(part.place.rows) for part in parts):
        style.notes(below, ["released droplets until they break up; python3 -m clogsweep daughters draws their daughters"])
    walls = "between walls" if place.has_walls else "periodic across the flow"
    some = f"; {len(parts)} of {num_parts} parameter sets" if len(parts) < num_parts else ""
    figure.suptitle(f"{literal(place.name)}: {place.length:.4g} x {place.width:.4g} "
                    f"{place.unit or 'droplet diameters'}, {walls}{some}", fontsize=9)
    if not is_grid:
        align(below, panels[-1])
    return figure


def align(strip: Axes, panel: Axes) -> None:
    """Makes the strip as wide as the panel above it. A panel has equal scales, so it may be narrower than its slot in
    the layout."""
    strip.figure.draw_without_rendering()
    strip.figure.set_layout_engine("none")
    panel.apply_aspect()
    wide, high = panel.get_position(), strip.get_position()
    strip.set_position([wide.x0, high.y0, wide.width, high.height])
