"""Draws clogged droplets of a sweep and their mechanisms. The droplets are replayed until they rest."""

from __future__ import annotations

import concurrent.futures
import dataclasses
import pathlib
import sys
import tempfile
from collections.abc import Collection, Iterator, Sequence
from typing import overload

import numpy as np
import numpy.typing as npt
import scipy.spatial
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Circle, Patch, Polygon

from .. import style
from ..reading import replays, stored, trajectory
from ..tools import rounded
from ..tools.errors import ProgramFailed, UserError
from ..tools.hints import Numbers, Records
from . import surroundings

MARGIN = 0.15  # free height above the panels of a sheet [inches]
MECHANISMS = ("wrapped", "squeezed", "hybrid", "other")


def are_passages(rows: Records) -> npt.NDArray[np.bool_]:
    """Whether the droplet of each row was in a channel or on a wall."""
    return np.isin(rows["obstacle_filling"], (b"channel", b"wall"))


def are_clogged_polygons(rows: Records) -> npt.NDArray[np.bool_]:
    return np.asarray((rows["status"] == b"clogged") & (rows["model"] == b"dp"))


def of_polygons(rows: Records, path: object) -> list[np.void]:
    """The rows of the polygons that have clogged in arrays. @param path  the sweep's file. @throws UserError  if no
    droplet was in an array"""
    if len(rows) > 0 and are_passages(rows).all():
        raise UserError(f"cannot draw clogs of {path} (its droplets were in a channel or on a wall); "
                        "clogfit report draws their results")
    return list(rows[are_clogged_polygons(rows) & ~are_passages(rows)])


def tell_left_out(rows: Records) -> None:
    """If of_polygons() excludes clogs, prints how many."""
    if number := int((are_clogged_polygons(rows) & are_passages(rows)).sum()):
        print(f"left out: {rounded.count_text(number, 'clog')} in a channel or on a wall; "
              "clogfit report draws them, after clogsweep select "
              "has made a sweep of one kind", file=sys.stderr)


def mechanism_of(row: np.void) -> str:
    """The mechanism by the name that clogfit uses. Every mechanism except wrapped, squeezed and hybrid is `other`."""
    name = stored.text(row["mechanism"])
    return name if name in MECHANISMS else "other"


def lacking(path: object, has_unfinished: bool) -> UserError:
    """The error for a sweep that has no clogged polygon in an array.
    @param has_unfinished  whether the sweep can be resumed"""
    resume = "resume it, or " if has_unfinished else ""
    return UserError(f"{path} holds no clogged polygon in an array (soft disks and daughters do not count); "
                     f"{resume}sweep with a longer max-time into another file")


def chosen(rows: list[np.void], path: object, *, mechanism: str | None, tasks: Collection[int] | None,
           most: int) -> list[np.void]:
    """Chooses the clogs to draw. @param rows  clogs of the sweep. @throws UserError  if one of `tasks` has no clog, or
    no clog has the mechanism"""
    if mechanism not in (None, *MECHANISMS):
        raise UserError(f"no mechanism {mechanism}; they are {', '.join(MECHANISMS)}")
    left = [row for row in rows if mechanism in (None, mechanism_of(row))]
    missing = set(tasks or ()) - {row["task"] for row in left}
    if missing or not left:
        which = f"tasks {', '.join(map(str, sorted(missing)))}" if missing else f"mechanism {mechanism}"
        raise UserError(f"{which}: {path} holds no such clogged polygon; clogfit counts them")
    return [row for row in left if row["task"] in tasks] if tasks else computed_once(left)[:most]


def computed_once(rows: list[np.void]) -> list[np.void]:
    """The clogs, with each run only once. Several laboratories may have the same run."""
    names = ("line_tension", "seed", "release_x", "release_y", "distance", "time", "steps")
    return list({tuple(row[name].tobytes() for name in names): row for row in reversed(rows)}.values())[::-1]


@dataclasses.dataclass(frozen=True)
class Clog:
    """A droplet at rest. In a notebook the object shows itself as a picture."""

    row: np.void  # The sweep's row.
    polygon: Numbers  # Vertices of the interface that meets walls, 2 x N [sigma].
    obstacles: Numbers  # Array n x 3 of x, y and diameter [sigma].
    wedges: Numbers  # Side walls as in a trajectory's file, n x 6 [sigma].
    source: str = ""  # Provenance of the row, in words.

    @property
    def task(self) -> int:
        return int(self.row["task"])

    @property
    def mechanism(self) -> str:
        """wrapped, squeezed, hybrid or other"""
        return mechanism_of(self.row)

    def picture(self) -> style.Picture:
        figure, axes = style.subplots(figsize=(4.6, 4.6))
        draw(axes, self, view_of([self]))
        axes.set_xlabel(r"$x/\sigma$ from the droplet's middle")
        axes.set_ylabel(r"$y/\sigma$")
        return style.Picture(figure, f"{self.source}\ntask {self.task}")

    def _repr_png_(self) -> bytes:
        return self.picture().png()


class Clogs(Sequence[Clog]):
    """Several clogs of a sweep. In a notebook the object shows all of them on one sheet."""

    def __init__(self, clogs: list[Clog]) -> None:
        self._clogs = clogs

    def __len__(self) -> int:
        return len(self._clogs)

    @overload
    def __getitem__(self, index: int) -> Clog: ...

    @overload
    def __getitem__(self, index: slice) -> Clogs: ...

    def __getitem__(self, index: int | slice) -> Clog | Clogs:
        return Clogs(self._clogs[index]) if isinstance(index, slice) else self._clogs[index]

    def __iter__(self) -> Iterator[Clog]:
        return iter(self._clogs)

    def __repr__(self) -> str:
        return f"<{rounded.count_text(len(self), 'clog')}: {', '.join(f'task {clog.task} {clog.mechanism}' for clog in self)}>"

    def picture(self) -> style.Picture:
        tasks = ", ".join(str(clog.task) for clog in self)
        return style.Picture(sheet(self._clogs), f"{self._clogs[0].source}\ntasks {tasks}")

    def _repr_png_(self) -> bytes:
        return self.picture().png(80)


def run_again(clogrun: pathlib.Path, sweep: pathlib.Path, source: str, row: np.void, folder: str) -> Clog:
    """Computes a run again until its droplet rests. @throws ProgramFailed"""
    output = pathlib.Path(folder) / f"{row['task']}.h5"
    # A run with a certified clog ended before the droplet reached the equilibrium that the row describes. With
    # --to-rest the replay continues to the equilibrium.
    replays.replay(clogrun, sweep, row["task"], output, "--to-rest", "--polygon-interval",
                   "1e9", "--sample-interval", "1e9")
    with stored.opened(output) as file:
        return Clog(row, trajectory.refined(file["polygons"][-1], row), file["obstacles"][:],
                    file["wedges"][:] if "wedges" in file else np.empty((0, 6)), source)


def run_all(clogrun: pathlib.Path, sweep: pathlib.Path, rows: Sequence[np.void], jobs: int) -> Clogs:
    """Computes several runs again. @param jobs  number of simultaneous replays. @throws UserError  with clogrun's
    reason"""
    with stored.opened(sweep, folder=clogrun.parent) as file:
        source = stored.source(stored.attributes(file))
    with tempfile.TemporaryDirectory(prefix="clogsweep-clogs-") as folder, concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        try:
            return Clogs(list(pool.map(lambda row: run_again(clogrun, sweep, source, row, folder), rows)))
        except (ProgramFailed, OSError) as error:
            raise UserError(f"cannot run clogrun ({error})") from error


def distances(polygon: Numbers, obstacle: Numbers) -> Numbers:
    """The distance of each edge from the surface of an obstacle."""
    begin, way = polygon, np.roll(polygon, -1, axis=1) - polygon
    to_centre = obstacle[:2, None] - begin
    along = np.clip((to_centre * way).sum(axis=0) / (way**2).sum(axis=0), 0, 1)
    return np.hypot(*(to_centre - along * way)) - obstacle[2] / 2


def distances_to_wedge(polygon: Numbers, wedge: Numbers) -> Numbers:
    """The distance of each edge from the surface of a wedge, measured at the nearer end of the edge."""
    tip, axis, half_angle, radius = wedge[:2], wedge[2:4], wedge[4], wedge[5]
    from_centre = polygon - (tip + radius * axis)[:, None]
    along, across = axis @ from_centre, np.abs([-axis[1], axis[0]] @ from_centre)
    flank = across * np.cos(half_angle) - along * np.sin(half_angle)
    before_tip = along * np.cos(half_angle) + across * np.sin(half_angle) < 0
    of_vertex = np.where(before_tip, np.hypot(along, across), flank) - radius
    return np.minimum(of_vertex, np.roll(of_vertex, -1))


def overlaps(clog: Clog) -> Numbers:
    """The overlap of each edge (columns) with each obstacle and then each wedge (rows) [sigma]. An edge touches a
    surface if the overlap is positive."""
    surfaces = [distances(clog.polygon, obstacle) for obstacle in clog.obstacles]
    surfaces += [distances_to_wedge(clog.polygon, wedge) for wedge in clog.wedges]
    return clog.row["contact_range"] - np.array(surfaces)


def title(row: np.void) -> str:
    """Describes the droplet and its clog in words."""
    support = f"{100 * row['wrapped_support']:.0f} %"
    wrapped = f"{row['num_wrapped']} wrapped ({support})" if row["num_wrapped"] > 0 else "none wrapped"
    return (rf"{mechanism_of(row)} after $r = {rounded.plain(row['distance'])}\,\sigma$, "
            f"task {row['task']}, seed {row['seed']}\n"
            rf"line tension {row['line_tension']:.4g}, obstacle gap ${row['obstacle_gap']:.4g}\,\sigma$" "\n"
            f"{wrapped}, {rounded.count_text(row['num_gaps'], 'gap')}, {rounded.count_text(row['num_arcs'], 'arc')}")


def view_of(clogs: Sequence[Clog]) -> Numbers:
    """Width and height of a view that has room for each of the clogs and for the guides [sigma]."""
    width, height = np.max([np.ptp(clog.polygon, axis=1) for clog in clogs], axis=0) + 0.6
    return np.array([max(width, height / 1.4), max(1.2 * height, 0.5 * width)])


def draw(axes: Axes, clog: Clog, view: Numbers, has_guides: bool = True) -> None:
    """Draws a clog. The droplet is in the middle. @param view  from view_of()"""
    polygon = clog.polygon
    middle = (polygon.min(axis=1) + polygon.max(axis=1)) / 2
    interface = polygon - middle[:, None]
    axes.fill(*interface, facecolor=style.MECHANISM_COLOURS[clog.mechanism], edgecolor="black", linewidth=0.6,
              alpha=0.7)
    corners = scipy.spatial.ConvexHull(interface.T).vertices
    axes.plot(*interface[:, [*corners, corners[0]]], color="0.4", linewidth=0.6, linestyle="--")
    patches: list[Patch] = [Circle(obstacle[:2] - middle, obstacle[2] / 2) for obstacle in clog.obstacles]
    patches += [Polygon(trajectory.wedge_outline(wedge) - middle) for wedge in clog.wedges]
    for patch, depths in zip(patches, overlaps(clog)):
        touches = np.flatnonzero(depths > 0)
        patch.set_color("#0072B2" if len(touches) else "0.85")
        axes.add_patch(patch)
        for edge in touches:
            axes.plot(*interface[:, [edge, (edge + 1) % interface.shape[1]]], color="#D00000", linewidth=2.4,
                      solid_capstyle="butt")
    surroundings.frame_limits(axes, -view / 2, view / 2)
    axes.locator_params(nbins=5)
    if has_guides:
        surroundings.draw_guides(axes)
    axes.set_title(title(clog.row), fontsize=8)


def sheet(clogs: Sequence[Clog]) -> Figure:
    """Draws all clogs on the same scale. The first panel has the guides."""
    view = view_of(clogs)
    across = min(3 if view[0] > 1.5 * view[1] else 4, len(clogs))
    down = -(-len(clogs) // across)
    width = 10 / across if len(clogs) > 1 else 4.6
    height = (width * view[1] / view[0] + 0.75) * down + MARGIN
    figure, axes = style.subplots(down, across, figsize=(width * across, height), squeeze=False)
    # Without this margin the titles of the first row would be cut off.
    figure.get_layout_engine().set(h_pad=0.1, rect=(0, 0, 1, 1 - MARGIN / height))
    for place in axes.flat:
        place.axis("off")
    for place, clog in zip(axes.flat, clogs):
        draw(place, clog, view, has_guides=clog is clogs[0])
    return figure
