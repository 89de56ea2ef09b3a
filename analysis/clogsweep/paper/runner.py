"""Runs the programs for a figure. A run that exists is not repeated. The origin of every number is recorded."""

from __future__ import annotations

import csv
import dataclasses
import itertools
import json
import math
import pathlib
import shlex
from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ..reading import programs, replays, stored
from ..reading.trajectory import Trajectory
from ..tools import outputs, tables
from ..tools.errors import NotThere, UserError
from ..tools.hints import Column, Group
from ..tools.texts import printable
from . import finished

if TYPE_CHECKING:
    import pandas

CONFIGS = programs.JOBS / "figures"


def config_keys(path: pathlib.Path) -> dict[str, str]:
    """The keys and values of a config file, as text."""
    keys = {}
    for line in path.read_text(encoding="utf-8").splitlines():
        line = line.split("#", 1)[0]
        if "=" in line:
            key, value = line.split("=", 1)
            keys[key.strip()] = value.strip()
    return keys


def as_text(value: object) -> str:
    """A key's value as text."""
    return f"{value:g}" if isinstance(value, float) else str(value)


def in_row(row: np.void, key: str, otherwise: str) -> str:
    """The text of a key's value in a row. If the row has no number for the key, `otherwise` is returned."""
    if key == "perimeter-stiffness-ratio":
        return as_text(row["perimeter_stiffness"] / row["line_tension"])
    column = "seed" if key == "seeds" else key.replace("-", "_")
    has_number = column in stored.columns_of(row) and not isinstance(row[column], bytes)
    return as_text(row[column]) if has_number and otherwise.lstrip("+-.")[:1].isdigit() else otherwise


@dataclasses.dataclass(frozen=True)
class Override:
    """A KEY=VALUE for all configs, or a CONFIG:KEY=VALUE for one config."""

    config: str | None
    key: str
    value: str

    @staticmethod
    def parse(text: str) -> Override:
        name, equals, value = text.partition("=")
        config, colon, key = name.rpartition(":")
        if not equals or not key or not value:
            raise UserError(f"invalid --set {text} (is not KEY=VALUE or CONFIG:KEY=VALUE) try --set max-time=100")
        return Override(config if colon else None, key, value)


@dataclasses.dataclass
class Runner:
    """@param rows_folder  a folder of finished sweeps: they are read, and no sweep is run"""

    size: str
    ranks: int
    folder: pathlib.Path
    programs: pathlib.Path
    overrides: list[Override]
    profiles: list[pathlib.Path] = dataclasses.field(default_factory=list)
    draw_only: bool = False
    rows_folder: pathlib.Path | None = None

    def __post_init__(self) -> None:
        self._complete_sweeps: set[str] = set()
        self._fits: dict[str, dict[str, Any]] = {}
        self._finished: dict[str, finished.Finished] = {}
        self._sources: list[str] = []
        self._model_versions: dict[str, set[int]] = {}
        for override in self.overrides:
            if override.config and not self.config(override.config).exists():
                raise UserError(f"invalid --set {override.config}:{override.key}={override.value} "
                                "(no figure has a config of that name) "
                                "use one of the sweeps that figures list shows")

    # Configs

    def config(self, name: str) -> pathlib.Path:
        return CONFIGS / f"{name}.{self.size}.cfg"

    def _points(self, name: str) -> list[str]:
        """The arguments for the points file beside a config. The points differ in their meshes. If --set overrides a
        key of the file, the points become lists, one for each of the other keys, and a message states this."""
        file = self.config(name).with_suffix(".csv")
        if not file.exists():
            return []
        with file.open(encoding="utf-8", newline="") as lines:
            points = list(csv.DictReader(lines))
        overridden = {override.key for override in self.overrides if override.config in (None, name)}
        if overridden.isdisjoint(points[0]):
            return ["--points", str(file)]
        replaced = ", ".join(sorted(overridden & points[0].keys()))
        print(printable(f"--set {replaced} replaces {file.name}, which pairs {' and '.join(points[0])}"), flush=True)
        return [f"{key}={','.join(point[key] for point in points)}"
                for key in points[0] if key not in overridden and all(point[key] for point in points)]

    def keys(self, name: str) -> dict[str, str]:
        """The settings of a config, changed by --set."""
        keys = config_keys(self.config(name))
        # A --set for this config overrides a --set for all configs.
        for config in (None, name):
            keys |= {override.key: override.value for override in self.overrides if override.config == config}
        return keys

    def _arguments(self, name: str, own_keys: dict[str, str]) -> list[str]:
        """The arguments for a config and its changes. The keys of --set come first, and the keys that the figure itself
        sets come second, so that they override --set."""
        in_file = config_keys(self.config(name))
        keys = self.keys(name) | own_keys
        if own_keys.get("obstacle-layout") in ("channel", "wall"):
            # In a channel or on a wall nothing is random or periodic. If --set has a key of random or periodic arrays,
            # this key is meant for other sweeps.
            keys = {key: value for key, value in keys.items() if key not in ("seeds", "box")}
        return ["--config", str(self.config(name)),
                *(f"{key}={value}" for key, value in keys.items() if in_file.get(key) != value)]

    # Programs

    def _call(self, program: str, *arguments: object, ranks: int = 1) -> str:
        return programs.run_program(self.programs / program, *arguments, ranks=ranks)

    # Sweeps

    def sweep_file(self, name: str) -> pathlib.Path:
        return self.folder / "sweeps" / f"{name}.h5"

    def place_of(self, name: str) -> pathlib.Path:
        """The file that holds the runs of a sweep."""
        return finished.files_of(name, self.rows_folder)[0] if self.rows_folder else self.sweep_file(name)

    def _complete(self, name: str, arguments: list[str], ranks: int) -> None:
        """Runs the part of a sweep that is missing."""
        file = self.sweep_file(name)
        if self.draw_only and not file.exists():
            raise NotThere(f"{file} is not there; leave out --draw-only, or run clogsweep {shlex.join(arguments)}")
        if not self.draw_only and name not in self._complete_sweeps:
            file.parent.mkdir(parents=True, exist_ok=True)
            print(printable(f"sweep {name}: {file}"), flush=True)
            self._call("clogsweep", "--output", file, *arguments, ranks=ranks)
            self._complete_sweeps.add(name)
        self._note_sweep(name)

    def has(self, name: str) -> bool:
        """Whether the folder of finished sweeps has this sweep; True if sweeps are run."""
        return self.rows_folder is None or finished.files_of(name, self.rows_folder)[0].exists()

    def sweep(self, name: str) -> list[Group]:
        """Runs the part of a config's sweep that is missing. @return clogfit's groups"""
        if self.rows_folder:
            return self._read_finished(name).groups
        self._complete(name, self._arguments(name, {}) + self._points(name), self.ranks)
        if name not in self._fits:
            self._fits[name] = json.loads(self._call("clogfit", self.sweep_file(name), "--format", "json"))
        return [group for group in self._fits[name]["groups"] if group["runs"] > 0]

    def _read_finished(self, name: str) -> finished.Finished:
        assert self.rows_folder
        if name not in self._finished:
            self._finished[name] = finished.read(name, self.rows_folder)
            self._fits[name] = self._finished[name].fit
        sweep = self._finished[name]
        self._model_versions[name] = {source["model_version"] for source in sweep.fit["sources"]}
        self._sources += [f"{source['command']}\n    clogsweep {source['clogsweep']}, begun {source['begun']}"
                          for source in sweep.fit["sources"]]
        self._sources += [f"not drawn: {finished.words_of(group)}" for group in sweep.incomplete]
        return sweep

    def runs(self, name: str, config: str | None, keys: Mapping[str, object]) -> list[np.void]:
        """Runs the missing part of a sweep over keys that the figure itself sets.

        @param config  the config for all other keys, or None for their defaults
        @param keys  for each key a value or a list of values, such as {"line-tension": [0.3, 1]}
        @return the rows, in the order of the lists; the last list varies fastest
        """
        lists = {key: [as_text(value) for value in (values if isinstance(values, list) else [values])]
                 for key, values in keys.items()}
        words = {key: ",".join(values) for key, values in lists.items()}
        wanted = list(itertools.product(*lists.values()))
        self._complete(name,
                       self._arguments(config, words) if config else [f"{key}={word}" for key, word in words.items()],
                       min(self.ranks, len(wanted)))
        # The file may contain other rows, too. If a key has no column, its value is the same in all rows.
        known = {tuple(in_row(row, key, values[0]) for key, values in lists.items()): row
                 for row in stored.read_rows(self.sweep_file(name), self.programs)}
        if missing := [values for values in wanted if values not in known]:
            which = ", ".join(map("=".join, zip(lists, missing[0])))
            raise NotThere(f"{self.sweep_file(name)} holds no run of {which}; "
                           "drop --draw-only, or give another --output")
        found = [known[values] for values in wanted]
        for row in found:
            if row["status"] == b"failed":
                raise UserError(f"task {row['task']} of {self.sweep_file(name)} failed "
                                f"({stored.text(row['message'])}); clogrun replay shows how far it came")
        return found

    def columns(self, name: str) -> dict[str, Column]:
        """The parameters of a sweep by name, as clogfit's JSON describes them. sweep() must have run the sweep."""
        return {column["name"]: column for column in self._fits[name]["columns"]}

    def confidence(self, name: str) -> float:
        """The confidence of a sweep's intervals. sweep() must have run the sweep."""
        return self._fits[name]["confidence"]

    def rows(self, name: str) -> pandas.DataFrame:
        """The table of a sweep. sweep() must have run the sweep."""
        if self.rows_folder:
            return self._finished[name].rows
        return stored.read_table(self.sweep_file(name), self.programs)

    def record(self, name: str, mechanism: str, row: pandas.Series) -> tuple[str, np.void]:
        """One run of a sweep as its file has it, and the name of this file. If the rows come from a finished sweep
        without its file, the run is repeated. @param row  of rows()"""
        if not self.rows_folder:
            rows = stored.read_rows(self.sweep_file(name), self.programs)
            return name, next(one for one in rows if one["task"] == row.task)
        keys = {"line-tension": row.line_tension, "obstacle-gap": row.obstacle_gap, "friction": row.friction,
                "seeds": int(row.seed)}
        again, = self.runs(f"{name}-{mechanism}", name, keys)
        if not math.isclose(again["distance"], row.distance, rel_tol=1e-9):
            raise UserError(f"the {mechanism} droplet of {name} goes {again['distance']:.9g} sigma now, and went "
                            f"{row.distance:.9g} in {self.rows_folder}; use programs of the same model version and "
                            "the same instruction set")
        return f"{name}-{mechanism}", again

    def _note_sweep(self, name: str) -> None:
        with stored.opened(self.sweep_file(name), folder=self.programs) as file:
            about, rows = stored.attributes(file), file["runs"][:]
        self._model_versions[name] = set(rows["model_version"].tolist())
        seeds = sorted(set(rows["seed"].tolist()))
        finished = sum(status not in (b"running", b"interrupted") for status in rows["status"])
        self._sources.append(
            f"{about['command_line']}\n    {finished} of {len(rows)} runs finished, rows 0 to {len(rows) - 1}, "
            f"seeds {seeds[0]} to {seeds[-1]}; clogsweep {stored.writer(about)}, begun {about['start_time']}")

    # Ways of single droplets

    def ways(self, name: str, rows: Iterable[np.void], samples: float,
             outlines: float | None = None) -> list[Trajectory]:
        """Replays rows of a sweep, see replays.follow_all(). If a file already contains a replay, the replay is not
        repeated."""
        folder = self.folder / "runs"
        if not self.draw_only:
            print(printable(f"ways of {name}: {folder}"), flush=True)
            folder.mkdir(parents=True, exist_ok=True)
        clogrun = None if self.draw_only else self.programs / "clogrun"
        ways = replays.follow_all(clogrun, self.sweep_file(name), rows, folder, self.ranks, samples, outlines)
        for way in ways:
            self._sources.append(
                f"{way.attributes['command_line']}\n    {way.word('status')} at t = {way.row['time']:.6g}; "
                f"clogrun {stored.writer(way.attributes)}, {way.attributes['start_time']}; file {way.path}")
        return ways

    # Fits of tables

    def fit(self, *arguments: object) -> dict[str, Any]:
        """The JSON output of clogfit drag or clogfit deviation."""
        self._sources.append("clogfit " + shlex.join(map(str, arguments)))
        return json.loads(self._call("clogfit", *arguments))

    def table(self, name: str, columns: Sequence[str], rows: Iterable[Sequence[object]]) -> pathlib.Path:
        """Writes a CSV file for clogfit. @param columns  its header, such as ["h [sigma]", "v [v_t]"]"""
        file = self.folder / "runs" / f"{name}.csv"
        file.parent.mkdir(parents=True, exist_ok=True)
        with outputs.replaced(file) as fresh, open(fresh, "w", newline="", encoding="utf-8") as out:
            csv.writer(out).writerows([columns, *rows])
        return file

    def model_versions(self) -> dict[str, set[int]]:
        """The model versions in the rows of all sweeps that were used so far."""
        return self._model_versions

    def take_sources(self) -> list[str]:
        """Returns the sources of the numbers in the last figure, and forgets them."""
        sources, self._sources = list(dict.fromkeys(self._sources)), []
        return sources


def measured(path: pathlib.Path) -> pandas.DataFrame:
    """The columns h, v and A of a measured passage in reduced units, in the format of clogfit calibrate. The columns
    are only displayed."""
    import pandas  # pandas is slow to load, and seldom needed here.

    if path.is_file():
        tables.refuse_misread(path)
    try:
        table = pandas.read_csv(path, comment="#", skipinitialspace=True)
    except FileNotFoundError as error:
        raise UserError(f"cannot read {path} (no such file); check the name") from error
    except (OSError, ValueError) as error:
        raise UserError(f"cannot read {path} ({error}); "
                        "give a CSV file with the header h [sigma], v [v_t], A") from error
    table.columns = [name.strip() for name in table.columns]
    if not {"h [sigma]", "v [v_t]"} <= set(table.columns):
        raise UserError(f"cannot read {path} (no columns h [sigma] and v [v_t]); "
                        "give a CSV file with the header h [sigma], v [v_t], A")
    return table.rename(columns={"h [sigma]": "h", "v [v_t]": "v"})
