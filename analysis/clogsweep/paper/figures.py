"""Makes the figures of the article from our own runs: runs a sweep, fits it with clogfit, and draws the picture."""

import csv
import datetime
import pathlib

from .. import style
from ..reading import programs
from ..tools import outputs
from ..tools.texts import printable
from . import arrays, breaking, channels, density, dilute, hanging, sizes  # noqa: F401, they fill the catalogue
from .plate import CATALOGUE, Entry, Plate
from .runner import Runner

ORDER = [
    "1", "2", "3", "4", "5", "6a", "6b", "6c", "6c-filling", "6c-saturated", "7a",
    "7a-saturated", "7b", "7c", "7c-saturated", "map", "density",
    "8a", "8b", "8ca", "9a", "9b", "A1", "B1", "B2", "C1", "C2", "D", "E", "W1", "W2", "W3", "S", "sizes"]


def print_list() -> None:
    print(f"{'name':12} {'reduced size':24} {'sweep or settings':24} what")
    for name in ORDER:
        entry = CATALOGUE[name]
        print(f"{name:12} {entry.cost:24} {', '.join(entry.configs) or '-':24} {entry.caption}")


def output_of(name: str, runner: Runner) -> pathlib.Path:
    """The path of a figure without its ending."""
    return runner.folder / f"figure-{name}"


def refuse_unwritable(name: str, runner: Runner) -> None:
    """Checks that write() can write its four files, before minutes are spent on a computation."""
    output = output_of(name, runner)
    outputs.refuse_unwritable_picture(output, *runner.profiles)
    for ending in ("csv", "txt"):
        outputs.refuse_unwritable(pathlib.Path(f"{output}.{ending}"), "text", *runner.profiles)


def write(plate: Plate, entry: Entry, runner: Runner, command: str) -> None:
    output = output_of(entry.name, runner)
    sources = runner.take_sources()
    version = programs.run_program(runner.programs / "clogsweep", "--version").splitlines()[0]
    about = "\n".join([f"Figure {entry.name}, {runner.size} size: {entry.caption}", f"drawn by {command}",
                       f"{version}, {datetime.datetime.now(datetime.timezone.utc):%Y-%m-%dT%H:%M:%SZ}", "from", *sources]) + "\n"
    style.save(plate.figure, output, {"Title": f"Figure {entry.name}: {entry.caption}",
                                      "Description": about, "Software": "clogsweep"})
    columns = list(dict.fromkeys(name for row in plate.data for name in row))
    with outputs.replaced(f"{output}.csv") as fresh, open(fresh, "w", newline="", encoding="utf-8") as out:
        table = csv.DictWriter(out, columns)
        table.writeheader()
        table.writerows(plate.data)
    with outputs.replaced(f"{output}.txt") as fresh:
        fresh.write_text(printable(about, "\n"), encoding="utf-8")
    print(printable(f"{output}.png (and .pdf, .csv, .txt)"), flush=True)
