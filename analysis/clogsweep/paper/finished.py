"""The full sweeps of the gallery in small files, from which figures are drawn without repeating hours of runs.

Each sweep of `jobs/figures` that has been run in full has two files in a folder (docs/gallery/rows): NAME.csv.gz has
one line per run, NAME.json.gz has the groups that clogfit fitted to these runs, and where the runs came from. A sweep
may be added in parts, for instance one gap after the other.
"""

from __future__ import annotations

import dataclasses
import gzip
import json
import math
import pathlib
import re
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

from ..reading import fits, programs, stored
from ..tools import lists, outputs
from ..tools.errors import NotThere, UserError
from ..tools.hints import Group

if TYPE_CHECKING:
    import pandas

FOLDER = programs.JOBS.parent / "docs" / "gallery" / "rows"
# Files that are older than break-up=daughters lack these columns. Disks do not break up, so they have no neck.
BREAKING = ["break_up_neck", "speed_exponent"]
# The parameters that differ between the runs of at least one sweep of jobs/figures.
PARAMETERS = ["model", "preset", "line_tension", "wall_stiffness", "obstacle_gap", "obstacle_diameter",
              "obstacle_density", "obstacle_filling", "friction", "near_wall_drag", "vertices", "inertia",
              *BREAKING]
# Columns from which clogfit computes lengths, speeds and doubts.
RESULTS = ["status", "distance", "sound_distance", "time", "steady_distance", "steady_time", "mechanism", "stability",
           "failed_by", "wrapped_support", "mesh_hold", "friction_use", "shape_parameter", "longest_dwell",
           "first_contact_at", "healed_crossings", "processor_seconds"]
WORDS = ["model", "preset", "obstacle_filling", "status", "mechanism", "stability", "failed_by"]
# Digits of these numbers. All other numbers have 6 digits.
DIGITS = {"distance": 12, "sound_distance": 12, "obstacle_density": 12, "wall_stiffness": 12}
# Curves of P(r) are the largest part of clogfit's JSON. A single figure needs one of these curves.
LARGE = ("survival", "censored_distances")
MOST_CURVES = 4


@dataclasses.dataclass(frozen=True)
class Finished:
    """A full sweep.
    @param fit  `groups`, `columns` and `confidence` as clogfit's JSON has them, and `sources`
    @param rows  one line per run; words that do not apply are ''"""

    fit: dict[str, Any]
    rows: pandas.DataFrame

    @property
    def groups(self) -> list[Group]:
        """The groups of which every planned run is over."""
        return [group for group in self.fit["groups"] if is_complete(group)]

    @property
    def incomplete(self) -> list[Group]:
        return [group for group in self.fit["groups"] if not is_complete(group)]

    @property
    def core_hours(self) -> float:
        return float(self.rows["processor_seconds"].sum() / 3600)


def is_complete(group: Group) -> bool:
    return bool(group["runs"] >= group["planned"] and group["interrupted"] == 0)


def words_of(group: Group) -> str:
    """An incomplete group in words: its parameters, and the number of runs by how they ended."""
    names = ("line_tension", "wall_stiffness", "obstacle_gap", "friction")
    where = ", ".join(f"{name}={group[name]:g}" for name in names if group[name] is not None)
    counts = ("clogs", "flowing", "passed", "failed", "interrupted")
    ended = ", ".join(f"{group[name]} {name}" for name in counts if group[name])
    return f"{where}: {group['runs']} of {group['planned']} runs ({ended or 'none'})"


def files_of(name: str, folder: pathlib.Path) -> tuple[pathlib.Path, pathlib.Path]:
    return folder / f"{name}.csv.gz", folder / f"{name}.json.gz"


def read(name: str, folder: pathlib.Path = FOLDER) -> Finished:
    """Reads a sweep. @throws NotThere  if the folder does not have it"""
    import pandas  # pandas is slow to load, and seldom needed here.

    table, fit = files_of(name, folder)
    if not table.exists():
        raise NotThere(f"{folder} holds no rows of {name}: its full sweep has not been run; run it with --size full")
    try:
        with gzip.open(fit, "rt", encoding="utf-8") as text:
            answer = json.load(text)
        rows = pandas.read_csv(table, dtype={column: str for column in WORDS}, keep_default_na=False,
                               na_values={column: [""] for column in [*PARAMETERS, *RESULTS] if column not in WORDS})
    except (OSError, EOFError, ValueError) as error:
        raise UserError(f"cannot read the rows of {name} in {folder} ({error}); check them out again") from error
    add_breaking(rows)
    for group in answer["groups"]:
        group.setdefault("break_up_neck", None if group["model"] == "sp" else 0.0)
        group.setdefault("speed_exponent", 0.0)
    rows.insert(0, "task", range(len(rows)))
    return Finished(answer, rows)


def add_breaking(rows: pandas.DataFrame) -> None:
    """Adds parameters of break-up to rows of older programs, in which no droplet broke up."""
    if "break_up_neck" not in rows:
        rows["break_up_neck"] = (rows["model"] == "sp").map({True: math.nan, False: 0.0})
    if "speed_exponent" not in rows:
        rows["speed_exponent"] = 0.0


def names_in(folder: pathlib.Path = FOLDER) -> list[str]:
    """The sweeps in a folder, in alphabetical order."""
    return sorted(path.name.removesuffix(".csv.gz") for path in folder.glob("*.csv.gz"))


def identity(group: Group) -> tuple[Any, ...]:
    return tuple(group[name] for name in PARAMETERS)


def rounded_rows(sweep: pathlib.Path, folder: pathlib.Path) -> pandas.DataFrame:
    table = stored.read_table(sweep, folder)
    add_breaking(table)
    rows = table[[*PARAMETERS, "seed", *RESULTS]].copy()
    for name in rows.columns[[kind.kind == "f" for kind in rows.dtypes]]:
        rows[name] = [float(f"{value:.{DIGITS.get(name, 6)}g}") for value in rows[name]]
    return rows


def order_of(group: Group) -> list[tuple[bool, Any]]:
    return [(value is None, value or ("" if isinstance(value, str) else 0)) for value in identity(group)]


def add(name: str, sweeps: Iterable[pathlib.Path], clogsweep_folder: pathlib.Path, processor: str,
        folder: pathlib.Path = FOLDER) -> Finished:
    """Adds runs to the files of a sweep. Groups that the files already have are replaced.

    @param sweeps  files of clogsweep, whose groups are all different
    @param clogsweep_folder  folder of the programs
    @param processor  the processor that made the runs
    """
    import pandas

    is_new = not files_of(name, folder)[0].exists()
    known = Finished({"groups": [], "sources": []}, pandas.DataFrame()) if is_new else read(name, folder)
    groups = {identity(group): group for group in known.fit["groups"]}
    tables = [known.rows.drop(columns="task", errors="ignore")]
    sources = list(known.fit["sources"])
    answer: dict[str, Any] = {}
    for sweep in sweeps:
        answer = fits.run_clogfit(clogsweep_folder / "clogfit", sweep)
        with stored.opened(sweep, stored.SWEEP, clogsweep_folder) as file:
            about = stored.attributes(file)
        planned = sum(len(lists.numbers(text)) for text in stored.values(about["config"], "seeds"))
        few = len(answer["groups"]) <= MOST_CURVES
        for group in answer["groups"]:
            kept = {key: value for key, value in group.items() if few or key not in LARGE}
            groups[identity(group)] = kept | {"planned": planned}
        rows = rounded_rows(sweep, clogsweep_folder)
        tables.append(rows)
        command = re.sub(r"\S*/(jobs/|[^/ ]+$)", r"\1", about["command_line"])
        sources = [source for source in sources if source["command"] != command]
        sources.append({"command": command, "clogsweep": stored.writer(about), "begun": about["start_time"],
                        "model_version": max(group["model_version"] for group in answer["groups"]),
                        "processor": processor, "core_hours": round(float(rows["processor_seconds"].sum() / 3600), 3)})
    rows = pandas.concat([table for table in tables if len(table)], ignore_index=True)
    rows = rows.drop_duplicates([*PARAMETERS, "seed"], keep="last").sort_values([*PARAMETERS, "seed"], kind="stable")
    fit = {"columns": answer["columns"], "confidence": answer["confidence"], "sources": sources,
           "groups": sorted(groups.values(), key=order_of)}
    write(name, Finished(fit, rows), folder)
    return read(name, folder)


def write(name: str, sweep: Finished, folder: pathlib.Path = FOLDER) -> None:
    table, fit = files_of(name, folder)
    rows = sweep.rows.drop(columns="task", errors="ignore").to_csv(index=False)
    for path, text in ((table, rows), (fit, json.dumps(sweep.fit, separators=(",", ":")))):
        with outputs.replaced(path) as fresh:
            fresh.write_bytes(gzip.compress(text.encode(), 9, mtime=0))
