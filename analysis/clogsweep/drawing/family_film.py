"""Makes a film of a family: a droplet and all droplets into which it breaks up, in the array and in the units of the
first droplet."""

from __future__ import annotations

import concurrent.futures
import dataclasses
import pathlib
import tempfile
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.collections import PatchCollection
from matplotlib.patches import Circle, Rectangle

from .. import style
from ..reading import replays, trajectory
from ..tools.hints import Numbers
from . import families, film, surroundings

if TYPE_CHECKING:
    import pandas

WIDTH = film.WIDTHS["mechanism"]
STAYS = ("clogged", "small", "flowing")  # droplets with these ends stay in the picture


@dataclasses.dataclass
class Motion:
    """The outlines of one droplet, in the units of the ancestor."""

    member: Any  # a line of the table of droplets
    times: Numbers
    outlines: Numbers  # frames x 2 x points
    obstacles: Numbers

    def outline_at(self, time: float) -> Numbers | None:
        """The outline at the nearest recorded time; None before the birth, and after the end of a droplet that does
        not stay."""
        if time < self.times[0] or (time > self.member.end_time and self.member.status not in STAYS):
            return None
        return np.asarray(self.outlines[int(np.argmin(np.abs(self.times - time)))])


def motion_of(clogrun: pathlib.Path, sweep: pathlib.Path, member: Any, interval: float, folder: str) -> Motion:
    """Replays a droplet. @param interval  between outlines [t0]"""
    output = pathlib.Path(folder) / f"droplet-{member.path}.h5"
    scale = member.diameter
    replays.replay(clogrun, sweep, member.task, output, "--polygon-interval", f"{interval / scale**0.5:.6g}",
                   "--sample-interval", "1e9", *(["--droplet", member.path] if member.path else []))
    run = trajectory.read(output)
    return Motion(member, member.birth_time + run.times * scale**0.5, run.polygons * scale, run.obstacles * scale)


def small_one(member: Any, ancestor: Motion) -> Motion:
    """A circle for a droplet that was too small to be followed."""
    angle = np.linspace(0, 2 * np.pi, trajectory.POINTS_OF_DISK, endpoint=False)
    centre = trajectory.centroids(ancestor.outlines[:1])[0] + [member.birth_distance, member.birth_lateral]
    outline = centre[:, None] + 0.5 * member.diameter * np.stack([np.cos(angle), np.sin(angle)])
    return Motion(member, np.array([member.birth_time]), outline[None], np.empty((0, 3)))


def motions_of(clogrun: pathlib.Path, sweep: pathlib.Path, family: pandas.DataFrame, interval: float,
               jobs: int = 2) -> list[Motion]:
    """The motions of all members of a family; the first one is the ancestor."""
    members = sorted(family.itertuples(), key=lambda member: (len(member.path), member.path))
    followed = [member for member in members if member.status != "small" and member.end_time > member.birth_time]
    with (tempfile.TemporaryDirectory(prefix="clogsweep-family-") as folder,
          concurrent.futures.ThreadPoolExecutor(jobs) as pool):
        motions = list(pool.map(lambda member: motion_of(clogrun, sweep, member, interval, folder), followed))
    return motions + [small_one(member, motions[0]) for member in members if member.status == "small"]


class FamilyFilm(film.Film):
    """Shows all droplets of a family at equal intervals."""

    def __init__(self, motions: Sequence[Motion], num_frames: int, rate: int, size: str = "1080p",
                 exit_distance: float | None = None) -> None:
        """@param motions  see motions_of(); @param exit_distance  from the release to the exit of a device [sigma]"""
        self._motions = motions
        self._rate = rate
        self._frames = np.linspace(0, max(motion.member.end_time for motion in motions), num_frames)
        self._camera = film.Camera(self._views(), rate, film.FORMAT[0] * WIDTH / (film.FORMAT[1] * film.HEIGHT))
        self.figure = style.new_figure(figsize=film.FORMAT, dpi=film.SIZES[size])
        self._axes = self.figure.add_axes((film.LINE, film.LINE, WIDTH, film.HEIGHT))
        self._axes.axis("off")
        circles = np.unique(np.concatenate([motion.obstacles for motion in motions]).round(6), axis=0)
        self._axes.add_collection(PatchCollection([Circle((x, y), diameter / 2) for x, y, diameter in circles],
                                                  facecolor=style.OBSTACLE, edgecolor="none"))
        self._axes.add_patch(Rectangle((0, 0), 1, 1, transform=self._axes.transAxes, fill=False, linewidth=0.8))
        if exit_distance is not None:
            release = trajectory.centroids(motions[0].outlines[:1])[0, 0]
            self._axes.axvline(release + exit_distance, **families.EXIT)
        surroundings.draw_guides(self._axes)
        self._fills = [self._axes.fill([0], [0], alpha=0.75, edgecolor="black", linewidth=0.8)[0] for _ in motions]
        self._clock = self.figure.text(WIDTH - 0.01, 0.965, "", va="center", ha="right", fontsize=11)

    def _views(self) -> Numbers:
        """The corners of the smallest box around the droplets that move, for each frame."""
        views: list[Numbers] = []
        for time in self._frames:
            moving = [outline for motion in self._motions if motion.member.end_time >= time
                      and (outline := motion.outline_at(time)) is not None]
            if moving:
                points = np.concatenate(moving, axis=1)
                views.append(np.stack([points.min(axis=1), points.max(axis=1)], axis=1))
            else:
                views.append(views[-1])
        return np.array(views)

    def show(self, index: int) -> None:
        time = self._frames[index]
        surroundings.frame_limits(self._axes, *self._camera.corners(index))
        for motion, fill in zip(self._motions, self._fills):
            outline = motion.outline_at(time)
            fill.set_visible(outline is not None)
            if outline is not None:
                fill.set_xy(outline.T)
                has_ended = time >= motion.member.end_time
                fill.set_facecolor(families.END_COLOURS[motion.member.status] if has_ended else style.DROPLET)
        self._clock.set_text(f"t = {time:.0f} t\N{SUBSCRIPT ZERO}")

    def pixels(self, index: int) -> film.Pixels:
        self.show(index)
        self.figure.canvas.draw()
        return film.pixels_of(self.figure)
