"""Reads the trajectories that clogrun writes."""

import dataclasses
import math
import pathlib

import numpy as np
import numpy.typing as npt

from ..tools.hints import AnyPath, Numbers, Records
from ..tools.texts import literal
from . import stored

POINTS_OF_DISK = 128


@dataclasses.dataclass
class Trajectory:
    """The content of a trajectory file. docs/reference/files.md gives the shapes of the arrays. Without
    --polygon-interval the file has no frames, obstacles and wedges. The polygons are refined, see outlines()."""

    path: pathlib.Path
    table: Records
    row: np.void
    attributes: dict[str, str]
    polygons: Numbers
    times: Numbers
    obstacles: Numbers
    wedges: Numbers

    def word(self, column: str) -> str:
        return stored.text(self.row[column])

    def frame_at(self, column: str, value: float) -> int:
        """The index of the first frame in which a column is nearest to a given value."""
        at_frames = np.interp(self.times, self.table["time"], self.table[column])
        return int(np.argmin(np.abs(at_frames - value)))

    @property
    def middle(self) -> Numbers:
        """The point h = 0 on a channel's axis, in the coordinates of the polygons. For a wall, this is a point on the
        wall."""
        return self.wedges[:, :2].mean(axis=0)


def refined(polygons: Numbers, row: np.void) -> Numbers:
    """Refined polygons: the middles of the edges, where walls also touch, become additional points. Polygons of runs
    with wall-contact=vertex stay unchanged.

    @param polygons  (..., 2, N_v) [sigma]
    @return (..., 2, 2 N_v)
    """
    return polygons if row["wall_contact"] != b"edge" or polygons.size == 0 else with_middles(polygons)


def with_middles(polygons: Numbers) -> Numbers:
    """Adds a point between every two vertices by the four-point rule (docs/explanation/model.md). Repeated calls give a
    smooth curve.
    @param polygons  (..., 2, N)
    @return (..., 2, 2 N)"""
    before, after = np.roll(polygons, 1, axis=-1), np.roll(polygons, -1, axis=-1)
    middles = (9 * (polygons + after) - before - np.roll(polygons, -2, axis=-1)) / 16
    return np.stack([polygons, middles], axis=-1).reshape(*polygons.shape[:-1], -1)


def outlines(polygons: Numbers, row: np.void) -> Numbers:
    """The outline that touches walls: refined polygons, or the circle of a soft disk. Only the centre of a soft disk is
    stored."""
    if row["model"] != b"sp" or polygons.size == 0:
        return refined(polygons, row)
    angle = np.linspace(0, 2 * np.pi, POINTS_OF_DISK, endpoint=False)
    return polygons + 0.5 * np.stack([np.cos(angle), np.sin(angle)])


def read(path: AnyPath, needs_frames: bool = True) -> Trajectory:
    """Reads a trajectory file. @throws UserError  if the file is no trajectory, or lacks frames that are needed"""
    with stored.opened(path, stored.RUN) as file:
        frames = [file[name][:] if name in file else np.empty(shape)
                  for name, shape in [("polygons", (0, 2, 0)), ("polygon_times", (0,)),
                                      ("obstacles", (0, 3)), ("wedges", (0, 6))]]
        row = file["runs"][0]
        frames[0] = outlines(frames[0], row)
        trajectory = Trajectory(pathlib.Path(path), file["trajectory"][:], row, stored.attributes(file), *frames)
    if needs_frames:
        require_frames(trajectory)
    return trajectory


def require_frames(trajectory: Trajectory) -> None:
    """Refuses a trajectory without outlines. @throws UserError"""
    if len(trajectory.times) == 0:
        raise stored.unreadable(trajectory.path, "holds no polygons", stored.RUN)


def wedge_outline(wedge: Numbers, reach: float = 50.0) -> Numbers:
    """Points around a wedge with a rounded tip. The wedge is cut off far away. @param wedge  a row of /wedges"""
    x, y, axis_x, axis_y, half_angle, radius = wedge
    centre = np.array([x, y]) + radius * np.array([axis_x, axis_y])
    axis = math.atan2(axis_y, axis_x)

    def direction(angle: float) -> Numbers:
        return np.array([math.cos(angle), math.sin(angle)])

    sides = [(direction(axis + sign * half_angle), direction(axis + sign * (half_angle + math.pi / 2)))
             for sign in (1, -1)]
    (flank, normal), (other_flank, other_normal) = sides
    start, end = axis + half_angle + math.pi / 2, axis - half_angle - math.pi / 2 + 2 * math.pi
    arc = [centre + radius * direction(angle) for angle in np.linspace(start, end, 40)]
    behind = reach * direction(axis)
    return np.array([centre + reach * flank + behind, centre + reach * flank + radius * normal, *arc,
                     centre + reach * other_flank + radius * other_normal, centre + reach * other_flank + behind])


def described(trajectory: Trajectory) -> str:
    """The parameters of the run in words."""
    row = trajectory.row
    name = "line tension" if trajectory.word("model") == "dp" else "wall stiffness"
    words = [f"{name} {row[name.replace(' ', '_')]:.4g}"]
    if np.isfinite(row["obstacle_gap"]):
        words.append(rf"obstacle gap ${row['obstacle_gap']:.4g}\,\sigma$")
        words.append(f"seed {row['seed']}")
    return ", ".join(words)


def end_of(trajectory: Trajectory) -> str:
    """Describes in words how the run ended."""
    ends = {"wrapped": "clogged by wrapping", "squeezed": "clogged by squeezing",
            "hybrid": "clogged by wrapping and squeezing"}
    status = trajectory.word("status")
    return ends.get(trajectory.word("mechanism"), status) if status == "clogged" else {"flowing": "still flowing", "broken": "broken up"}.get(status, status)


def verdict(trajectory: Trajectory) -> str:
    """How the run ended, with the distance, as text for a picture."""
    return rf"{literal(end_of(trajectory))} after $r = {trajectory.row['distance']:.2f}\,\sigma$"


def centroids(polygons: Numbers) -> Numbers:
    """The centroid of each enclosed area. @param polygons  frames x 2 x N. @return frames x 2"""
    reference = polygons[:, :, :1]  # A reference near the polygon. With it, no digits are lost far from the origin.
    x, y = np.moveaxis(polygons - reference, 1, 0)
    next_x, next_y = np.roll(x, -1, axis=-1), np.roll(y, -1, axis=-1)
    cross = x * next_y - next_x * y
    moments = np.stack([((x + next_x) * cross).sum(axis=-1), ((y + next_y) * cross).sum(axis=-1)], axis=-1)
    return reference[:, :, 0] + moments / (3 * cross.sum(axis=-1, keepdims=True))


def along_the_way(polygons: Numbers, number: int) -> npt.NDArray[np.intp]:
    """Chooses frames that are evenly spaced along the path. Frames evenly spaced in time would mostly show the same
    outline, because a clogged droplet rests for most of its run."""
    centres = polygons.mean(axis=2)
    way = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(centres, axis=0).T))])
    chosen = np.searchsorted(way, np.linspace(0, way[-1], number)).clip(max=len(polygons) - 1)
    return np.unique(np.append(chosen, len(polygons) - 1))


def interface_speeds(trajectory: Trajectory) -> Numbers:
    """The speed of every point of the interface in every frame, from differences between frames [sqrt(sigma g)]."""
    if len(trajectory.times) < 2:
        return np.zeros((len(trajectory.times), trajectory.polygons.shape[2]))
    velocity = np.gradient(trajectory.polygons, trajectory.times, axis=0)
    return np.hypot(velocity[:, 0], velocity[:, 1])
