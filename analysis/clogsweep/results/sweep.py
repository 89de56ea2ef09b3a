"""A sweep, with its table of runs, its fits and its clogs."""

from __future__ import annotations

import html
import json
import os
import pathlib
import tempfile
from collections.abc import Collection, Sequence
from typing import TYPE_CHECKING, Any

from ..reading import export, fits, programs, replays, stored
from ..tools import checked
from ..tools.errors import ProgramFailed, UserError
from ..tools.texts import printable
from .fit import Fit
from .run import Run

if TYPE_CHECKING:
    import pandas

    from ..drawing.clogs import Clogs
    from ..style import Picture


class Status(dict[str, Any]):
    """The progress of a sweep. In a notebook the object shows itself as a table."""

    def _repr_html_(self) -> str:
        import pandas

        shown = {name: value for name, value in self.items() if not isinstance(value, list | dict)}
        return pandas.DataFrame({"": shown}).to_html(header=False)


class Sweep:
    """A file of ``clogsweep --output``, complete or in progress.

    - `rows`: table with a row for each run, as it was when the file was opened; `rows.attrs` contains `units` and
      `meanings` of the columns
    - `droplets`: table with a row for each member of a family, with break-up=daughters
    - `attributes`: version, commit, config, command line

    All other methods run the programs on the present file.
    """

    def __init__(self, path: str | os.PathLike[str], programs: str | os.PathLike[str] | None = None) -> None:
        """@param programs  folder of clogsweep, clogrun and clogfit, if they are not in the PATH or beside this module
        @throws UserError  if the file is no sweep, or is damaged"""
        self.path = pathlib.Path(path)
        self._programs = programs
        self._name = ""
        # Contains a file that is removed together with this object.
        self._folder: tempfile.TemporaryDirectory[str] | None = None
        with stored.opened(self.path, stored.SWEEP, programs) as file:
            self._records = file["runs"][:]
            self.rows = stored.table_of(file)
            self.droplets = stored.droplets(file)
            self.attributes: dict[str, str] = stored.attributes(file)

    def _program(self, name: str) -> pathlib.Path:
        return programs.programs_in(self._programs) / name

    def fit(self, *, dwell: float | None = None, from_distance: float | None = None, confidence: float | None = None,
            row_angle: float | None = None, lab: str | os.PathLike[str] | None = None) -> Fit:
        """Clogging lengths and mean speeds, from clogfit.

        @param dwell  a droplet that has not moved for this time counts as clogged [t0]
        @param from_distance  distances are counted from this distance on [sigma]
        @param confidence  confidence level of the intervals, between 0 and 1
        @param row_angle  tilt of the rows of user-supplied circles [degrees], for the displacement along these rows
        @param lab  file that describes the laboratory; lengths and speeds are then also given in its units
        @throws ProgramFailed  with the reason of clogfit
        """
        given = {"--dwell": dwell, "--from-distance": from_distance, "--confidence": confidence,
                 "--row-angle": row_angle}
        options = [word for name, value in given.items() if value is not None for word in (name, repr(float(value)))]
        of_lab = ["--lab", os.fspath(lab)] if lab is not None else []
        fit = Fit(*fits.fitted(self._program("clogfit"), self.path, *options, *of_lab))
        fit.known.fit_curves(self.path, programs.programs_in(self._programs))
        return fit

    def fitted_curves(self, *keys: str, crossing: Sequence[float] = ()) -> dict[str, Any]:
        """Smooth curves that are fitted to the clogging lengths, with bands, peaks and crossings. The curves have the
        form of the output of `clogfit curve --format json`.

        @param keys  one or two keys that the curves depend on; may be left out if only one key varies
        @param crossing  lengths that a curve may cross, in droplet diameters
        @throws UserError  with the reason why there is no curve
        """
        from ..curves import answer  # SciPy is slow to load

        return answer.of_sweep(self._program("clogfit"), [self.path], keys, crossing=crossing)[0]

    def status(self) -> dict[str, Any]:
        """The progress of the sweep, as clogsweep status reports it."""
        return Status(json.loads(programs.run_program(self._program("clogsweep"),
                                                      "status", self.path, "--format", "json")))

    def clogs(self, *, mechanism: str | None = None, tasks: Collection[int] | None = None, most: int = 6,
              jobs: int = 2) -> Clogs:
        """Clogged polygons, which are replayed until they rest.

        @param mechanism  only "wrapped", "squeezed", "hybrid" or "other"
        @param tasks  only these tasks
        @param most  largest number of clogs; the first ones are taken
        @param jobs  number of simultaneous replays
        @throws UserError  if there are none
        """
        from ..drawing import clogs  # This module is slow to load, like all modules that draw.

        checked.whole("most", most, 1)
        checked.whole("jobs", jobs, 1)
        clogged = clogs.of_polygons(self._records, self.path)
        if not clogged:
            raise clogs.lacking(self.path, self.status()["unfinished"] > 0)
        clogs.tell_left_out(self._records)
        rows = clogs.chosen(clogged, self.path, mechanism=mechanism, tasks=tasks, most=most)
        return clogs.run_all(self._program("clogrun"), self.path, rows, jobs)

    def device(self, *, ways: int = 3, map: int = 6, jobs: int = 2) -> Picture:
        """Draws user-supplied circles with the places where droplets were released, passed and clogged, and the paths
        of droplets. Each of up to six parameter sets has a panel.

        @param ways  number of runs of each panel with a path that is drawn as a line
        @param map  number of runs in the map of each panel; all of them are replayed
        @param jobs  number of simultaneous replays
        @throws UserError  if the sweep has no user-supplied circles, or circles of several devices
        """
        from ..drawing import device
        from ..style import Picture

        checked.whole("ways", ways, 0)
        checked.whole("map", map, 0)
        checked.whole("jobs", jobs, 1)
        found = device.places(self.path, self._programs)
        groups = self.fit().known.finished(self.path)
        parts = device.shown_parts(device.the_picture(found, groups, self.path), self.path, self._program("clogrun"),
                                   ways, map, jobs)
        return Picture(device.draw(*parts, groups.laboratory.get("length_mm")), stored.source(self.attributes))

    def replay(self, task: int, output: str | os.PathLike[str] | None = None, *, interval: float = 1.0,
               droplet: str = "") -> Run:
        """Replays a run, with outlines.

        @param output  file in which the run is kept
        @param interval  time between outlines [t0, of the daughter for a daughter]
        @param droplet  path of a daughter in the table of droplets, such as "01". Its run begins with its birth, and is
        in units of the daughter. Empty: the released droplet
        @throws UserError  if `droplet` is no text; ProgramFailed, with the paths of the run's daughters, if there is no
        such daughter
        """
        if task not in self._records["task"]:
            raise UserError(f"{self.path} holds no task {task}; it has {len(self._records)} rows")
        options = ["--sample-interval", repr(float(interval)), "--polygon-interval", repr(float(interval))]
        if not isinstance(droplet, str):
            raise UserError(f"invalid droplet={droplet!r} (a path is a text; as a number, 00 would be 0) "
                            "give it in quotes; read the column path as text")
        if droplet:
            options += ["--droplet", droplet]
        if output is not None:
            replays.replay(self._program("clogrun"), self.path, task, output, *options)
            return Run(output)
        with tempfile.TemporaryDirectory(prefix="clogsweep-replay-") as folder:
            return self.replay(task, pathlib.Path(folder) / f"{self.path.stem}-{task}.h5", interval=interval,
                               droplet=droplet)

    def report(self, output: str | os.PathLike[str], examples: int = 4, *,
               lab: str | os.PathLike[str] | None = None) -> pathlib.Path:
        """Writes an HTML page about the sweep. The page may replace an earlier page, but no other file.
        @param examples  number of clogs to show
        @param lab  file that describes the laboratory; results are then also given in its units
        @return the file of the page
        @throws UserError"""
        from ..pages import report

        checked.whole("examples", examples, 0)
        return report.write(self.path, pathlib.Path(output), examples, programs.programs_in(self._programs),
                            *(["--lab", lab] if lab is not None else []))

    def poster(self, *, lab: str | os.PathLike[str] | None = None) -> Picture:
        """Draws one printable A3 page of the sweep, with its curves and some of its droplets.

        @param lab  file that describes the laboratory; results are then also given in its units
        @throws UserError
        """
        from ..pages import poster
        from ..style import Picture

        return Picture(poster.draw(self.path, programs.programs_in(self._programs),
                                   *(["--lab", lab] if lab is not None else [])), stored.source(self.attributes))

    def export(self, output: str | os.PathLike[str]) -> pathlib.Path:
        """Writes `rows` for other programs, with the units of the columns. A .csv has one table, and a .h5 has a
        dataset for each column. If the laboratory is known, diameter and tilt of the droplet are the last columns. If
        there are `droplets`, OUTPUT-droplets.csv (or .h5) has them.
        @return the file of the rows. @throws UserError  if a file exists"""
        path = pathlib.Path(output)
        files = [path, export.file_of_droplets(path)] if len(self.droplets) else [path]
        for file in files:
            export.refuse_unwritable(file)
        for file, table in zip(files, (self._rows_with_droplets(), self.droplets)):
            export.write(table, file, stored.source(self.attributes))
        return path

    def _rows_with_droplets(self) -> pandas.DataFrame:
        """`rows` with the diameter and the tilt of each droplet, if the laboratory is known."""
        if not self.rows["laboratory"].any():
            return self.rows
        groups = self.fit().output["groups"]
        known = {name: {group["laboratory"]: group.get(name) for group in groups} for name in fits.DROPLETS}
        droplets = {name: self.rows["laboratory"].map(of).astype(float)
                    for name, of in known.items() if any(of.values())}
        table = self.rows.assign(**droplets)
        for name in droplets:
            table.attrs["units"] = table.attrs["units"] | {name: fits.DROPLETS[name]["unit"]}
            table.attrs["meanings"] = table.attrs["meanings"] | {name: f"{fits.DROPLETS[name]['meaning']} [{fits.DROPLETS[name]['unit']}]"}
        return table

    def __repr__(self) -> str:
        """Names the file, or all files if there are several."""
        counts = ", ".join(f"{number} {status}" for status, number in self.rows.status.value_counts().items())
        return f"<sweep {printable(self._name or self.path)}: {len(self.rows)} runs ({counts})>"

    def _repr_html_(self) -> str:
        return f"<p>{html.escape(repr(self)[1:-1])}; the first rows:</p>{self.rows.head()._repr_html_()}"


def merged(paths: Sequence[str | os.PathLike[str]], folder: str | os.PathLike[str] | None = None) -> Sweep:
    """Joins several files to one sweep, in a temporary file. @param folder  of the programs. @throws UserError  if the
    files contradict each other, or are no sweeps"""
    if len(paths) < 2:
        raise UserError("a list needs at least two files; give the name of a single file without a list")
    place = tempfile.TemporaryDirectory(prefix="clogsweep-merged-")
    path = pathlib.Path(place.name) / "merged.h5"
    try:
        programs.run_program(programs.programs_in(folder) / "clogsweep", "merge", *paths, "--output", path)
        sweep = Sweep(path, folder)
    except ProgramFailed as failure:
        place.cleanup()
        raise UserError(str(failure).removeprefix("clogsweep merge: ")) from failure
    sweep._folder, sweep._name = place, " + ".join(map(str, paths))
    return sweep
