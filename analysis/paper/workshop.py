"""Runs what a figure needs with clogsweep, clogrun and clogfit, once, and remembers where every number came from."""

import csv
import dataclasses
import io
import json
import os
import pathlib
import shlex
import tempfile

import stored
import trajectory
from command_line import UserError
from programs import ROOT, run_program

CONFIGS = ROOT / "jobs" / "figures"


def config_keys(path):
    """Keys and values of a config file, as text."""
    keys = {}
    for line in path.read_text().splitlines():
        line = line.split("#", 1)[0]
        if "=" in line:
            key, value = line.split("=", 1)
            keys[key.strip()] = value.strip()
    return keys


@dataclasses.dataclass(frozen=True)
class Override:
    """KEY=VALUE for all configs, or CONFIG:KEY=VALUE for one."""

    config: str | None
    key: str
    value: str

    @staticmethod
    def parse(text):
        name, equals, value = text.partition("=")
        config, colon, key = name.rpartition(":")
        if not equals or not key or not value:
            raise UserError(f"invalid --set {text} (is not KEY=VALUE or CONFIG:KEY=VALUE) try --set max-time=100")
        return Override(config if colon else None, key, value)


@dataclasses.dataclass
class Workshop:
    size: str
    ranks: int
    folder: pathlib.Path
    programs: pathlib.Path
    overrides: list
    profiles: list = dataclasses.field(default_factory=list)
    draw_only: bool = False

    def __post_init__(self):
        self._fits = {}
        self._sources = []

    # Configs

    def config(self, name):
        return CONFIGS / f"{name}.{self.size}.cfg"

    def keys(self, name):
        """What a config and --set say together."""
        keys = config_keys(self.config(name))
        # What is meant for this config alone has the last word.
        for config in (None, name):
            keys |= {override.key: override.value for override in self.overrides if override.config == config}
        return keys

    def _arguments(self, name, own_keys=None):
        """The config and what differs from it: first --set, then the figure's own keys, which have the last word."""
        keys = self.keys(name) | {key: f"{value:g}" if isinstance(value, float) else str(value)
                                  for key, value in (own_keys or {}).items()}
        in_file = config_keys(self.config(name))
        return ["--config", str(self.config(name)), *(f"{key}={value}" for key, value in keys.items() if in_file.get(key) != value)]

    # Programs

    def _call(self, program, *arguments, ranks=1):
        return run_program(self.programs / program, *arguments, ranks=ranks)

    # Sweeps

    def sweep_file(self, name):
        return self.folder / "sweeps" / f"{name}.h5"

    def sweep(self, name):
        """Runs what is missing of a sweep. @return clogfit's groups"""
        if name not in self._fits:
            file = self.sweep_file(name)
            if self.draw_only and not file.exists():
                raise UserError(f"{file} is not there; leave out --draw-only, or run clogsweep with {self.config(name)}")
            if not self.draw_only:
                file.parent.mkdir(parents=True, exist_ok=True)
                print(f"sweep {name}: {file}", flush=True)
                self._call("clogsweep", "--output", file, *self._arguments(name), ranks=self.ranks)
            self._fits[name] = json.loads(self._call("clogfit", file, "--format", "json"))
        fit = self._fits[name]
        self._note_sweep(name)
        return [group for group in fit["groups"] if group["runs"] > 0]

    def columns(self, name):
        """What the parameters of a sweep that sweep() has run are called: see clogfit's JSON, by name."""
        return {column["name"]: column for column in self._fits[name]["columns"]}

    def confidence(self, name):
        """Of the intervals of a sweep that sweep() has run."""
        return self._fits[name]["confidence"]

    def rows(self, name):
        """The table of a sweep that sweep() has run."""
        return stored.read_table(self.sweep_file(name))

    def _note_sweep(self, name):
        with stored.opened(self.sweep_file(name)) as file:
            about, rows = stored.attributes(file), file["runs"][:]
        seeds = sorted(set(rows["seed"].tolist()))
        finished = sum(status not in (b"running", b"interrupted") for status in rows["status"])
        self._sources.append(
            f"{about['command_line']}\n    {finished} of {len(rows)} runs finished, rows 0 to {len(rows) - 1}, "
            f"seeds {seeds[0]} to {seeds[-1]}; clogsweep {about['version']}, git {about['git_hash']}, begun {about['start_time']}")

    # Single droplets

    def run(self, name, system, config, keys, options=()):
        """One droplet's way by clogrun, reused if the same command has written it before.

        @param keys  of the config file, e.g. {"line-tension": 0.3}; @param options  e.g. ["--orifice", 0.7]
        """
        file = self.folder / "runs" / f"{name}.h5"
        if system == "array":
            keys = {"seeds": 1} | keys
        command = [system, *map(str, options), *self._arguments(config, keys)]
        if system != "array":
            # Nothing is random or periodic in a channel or on a wall: such a --set is meant for the others.
            command = [word for word in command if not word.startswith(("seeds=", "box="))]
        known = trajectory.read(file, needs_frames=False) if file.exists() else None
        if self.draw_only and known is None:
            raise UserError(f"{file} is not there; leave out --draw-only")
        if self.draw_only:
            self._refuse_others(file, known, keys)
        if not self.draw_only and (known is None or not self._is_from(known, command)):
            file.parent.mkdir(parents=True, exist_ok=True)
            print(f"run {name}: {file}", flush=True)
            # clogrun never overwrites; the old one goes when the new one is whole. Another figures.py may do the same run.
            with tempfile.TemporaryDirectory(prefix=f"{name}-", dir=file.parent) as folder:
                fresh = pathlib.Path(folder) / file.name
                self._call("clogrun", *command, "--output", fresh)
                os.replace(fresh, file)
            known = trajectory.read(file, needs_frames=False)
        self._sources.append(
            f"{known.attributes['command_line']}\n    {known.word('status')} at t = {known.row['time']:.6g}; "
            f"clogrun {known.attributes['version']}, git {known.attributes['git_hash']}, {known.attributes['start_time']}; file {file}")
        return known

    @staticmethod
    def _refuse_others(file, known, keys):
        """A run kept from before may be of another droplet than the figure wants now; the keys it sets itself tell."""
        for key, value in keys.items():
            column = "seed" if key == "seeds" else key.replace("-", "_")
            if column not in known.row.dtype.names:
                continue
            there = known.row[column]
            if (there.decode() != str(value)) if isinstance(there, bytes) else (there != value):
                raise UserError(f"{file} is another run ({column} is {there}, the figure needs {value}); leave out --draw-only")

    @staticmethod
    def _is_from(known, command):
        words = shlex.split(known.attributes["command_line"])[1:]
        place = words.index("--output") if "--output" in words else len(words)
        return words[:place] + words[place + 2:] == command and known.word("status") not in ("interrupted", "running")

    def sag(self, name, keys, options=()):
        """How far droplets sink onto a flat wall, by clogrun sag. @return rows of its table, numbers as float"""
        file = self.folder / "runs" / f"{name}.csv"
        arguments = ["sag", *map(str, options), *(f"{key}={value}" for key, value in keys.items())]
        if self.draw_only:
            if not file.exists():
                raise UserError(f"{file} is not there; leave out --draw-only")
            text = file.read_text()
        else:
            text = self._call("clogrun", *arguments)
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_text(text)
        self._sources.append("clogrun " + shlex.join(arguments))
        return [{key: value if key in ("model", "status") else float(value) for key, value in row.items()}
                for row in csv.DictReader(io.StringIO(text))]

    # Fits of tables

    def fit(self, *arguments):
        """JSON of clogfit drag, clogfit deviation."""
        self._sources.append("clogfit " + shlex.join(map(str, arguments)))
        return json.loads(self._call("clogfit", *arguments))

    def table(self, name, columns, rows):
        """A CSV file that clogfit reads. @param columns  its header, e.g. ["h [sigma]", "v [v_t]"]"""
        file = self.folder / "runs" / f"{name}.csv"
        file.parent.mkdir(parents=True, exist_ok=True)
        with open(file, "w", newline="") as out:
            csv.writer(out).writerows([columns, *rows])
        return file

    def take_sources(self):
        """Where the numbers of the figure drawn last came from; forgets them."""
        sources, self._sources = self._sources, []
        return sources


def measured(path):
    """Columns h, v, A of a measured passage in reduced units, as clogfit calibrate reads it; for display."""
    import pandas  # slow to load, and seldom needed

    try:
        table = pandas.read_csv(path, comment="#", skipinitialspace=True)
    except FileNotFoundError as error:
        raise UserError(f"cannot read {path} (no such file); check the name") from error
    except (OSError, ValueError) as error:
        raise UserError(f"cannot read {path} ({error}); give a CSV file with the header h [sigma], v [v_t], A") from error
    table.columns = [name.strip() for name in table.columns]
    if not {"h [sigma]", "v [v_t]"} <= set(table.columns):
        raise UserError(f"cannot read {path} (no columns h [sigma] and v [v_t]); give a CSV file with the header h [sigma], v [v_t], A")
    return table.rename(columns={"h [sigma]": "h", "v [v_t]": "v"})
