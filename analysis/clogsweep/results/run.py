"""One run of clogrun, with the droplet's outlines."""

from __future__ import annotations

import base64
import os
import pathlib
from typing import TYPE_CHECKING, NoReturn

import pandas

from ..reading import stored, trajectory
from ..tools import checked
from ..tools.errors import UserError
from ..tools.texts import printable

if TYPE_CHECKING:
    from ..style import Picture


class Film:
    """A film in the file `path`. In a notebook the object plays the film."""

    def __init__(self, path: pathlib.Path) -> None:
        self.path = path

    def __repr__(self) -> str:
        return f"<film {printable(self.path)}>"

    def _repr_html_(self) -> str:
        data = base64.b64encode(self.path.read_bytes()).decode()
        if self.path.suffix == ".gif":
            return f'<img src="data:image/gif;base64,{data}">'
        return f'<video controls loop style="max-width: 100%" src="data:video/mp4;base64,{data}"></video>'


class Run:
    """A file that clogrun wrote with ``--output`` and ``--polygon-interval``. The file contains the path of a droplet
    and its outlines.

    - `samples`: table of the path with time [t0], distance [sigma], speed [sqrt(sigma g)], energies and shape parameter
    - `polygons`: refined outlines, frames x 2 x points [sigma], at the `times` (frames) [t0]
    - `obstacles`: circles x 3 (x, y, diameter) [sigma]; `wedges`: walls, in the form that docs/reference/files.md
      describes
    - `row`: parameters and results, by the names of the columns of a sweep; `attributes`: the origin of the file
    """

    def __init__(self, path: str | os.PathLike[str]) -> None:
        """@throws UserError  if the file is no run, or is damaged"""
        self.path = pathlib.Path(path)
        self.trajectory = trajectory.read(self.path, needs_frames=False)
        self.samples = pandas.DataFrame(self.trajectory.table)
        self.polygons = self.trajectory.polygons
        self.times = self.trajectory.times
        self.obstacles = self.trajectory.obstacles
        self.wedges = self.trajectory.wedges
        self.row = stored.read_table(self.path).iloc[0]
        self.attributes: dict[str, str] = self.trajectory.attributes

    def picture(self, outlines: int = 12) -> Picture:
        """Draws several moments of the run in one picture. @param outlines  largest number of moments. @throws
        UserError  if there are no outlines"""
        from ..drawing import way  # This module is slow to load, like all modules that draw.
        from ..style import Picture

        checked.whole("outlines", outlines, 1)
        trajectory.require_frames(self.trajectory)
        return Picture(way.draw(self.trajectory, outlines), stored.source(self.attributes))

    def film(self, output: str | os.PathLike[str], *, colour: str = "speed", rate: int = 20, most_frames: int = 600,
             size: str | None = None) -> Film:
        """Writes a film. A file that exists is never replaced.

        @param output  name of the film, ending in .mp4 (needs ffmpeg) or .gif; without an ending, the one that can be
        made is added
        @param colour  "speed": the outline is coloured by the speed of the interface; "mechanism": the last frame shows
        how the droplet clogged
        @param rate  frames per second
        @param most_frames  largest number of frames; frames of a longer run are skipped
        @param size  size of the frames, "540p", "1080p" or "2160p"; by default 1080p, and 540p for a .gif
        @throws UserError  if the film cannot be made
        """
        from ..drawing import film

        checked.one_of("colour", colour, film.COLOURS)
        checked.one_of("size", size, (*film.SIZES, None))
        checked.whole("rate", rate, 1)
        checked.whole("most_frames", most_frames, 1)
        trajectory.require_frames(self.trajectory)
        path = film.path_of(pathlib.Path(output))
        frames = film.chosen_frames(self.trajectory, most_frames)
        moving = film.Film(self.trajectory, frames, colour, rate, size or film.size_for(path))
        return Film(film.write_film(moving, path, rate))

    def export_vtk(self, output: str | os.PathLike[str]) -> pathlib.Path:
        """Writes files for ParaView. @return the file to open in ParaView, OUTPUT.pvd. @throws UserError"""
        from ..drawing import vtk

        trajectory.require_frames(self.trajectory)
        return vtk.export(self.trajectory, pathlib.Path(output))

    def _repr_png_(self) -> bytes | None:
        return self.picture().png() if len(self.times) > 0 else None

    def fit(self) -> NoReturn:
        """Refuses, because only sweeps have a fit. @throws UserError"""
        raise UserError("a run has no fit; give a sweep")

    def __repr__(self) -> str:
        return f"<run {printable(self.path.name)}: {trajectory.end_of(self.trajectory)}>"
