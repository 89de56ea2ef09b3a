"""Draws the critical angle of lattices vs line tension or another parameter. Up to this angle droplets follow the rows.

    python3 -m clogsweep critical-angle lattice.h5                           # lattice-critical-angle.png, .pdf
    python3 -m clogsweep critical-angle lattice.h5 --format csv > angles.csv # a table
    python3 -m clogsweep critical-angle angles.csv                           # the same picture from the table

The sweep has several angles for every set of parameters, for instance from refine lattice-angle --until
critical-angle=0.5. The table has a line for each set: the parameters that vary, the largest angle at which droplets
follow the rows, the smallest at which some leave them, and the number of runs. Failed and unfinished runs do not
count. A lattice with a negative angle counts as its mirror image.
"""

import argparse
import json
import pathlib
import sys
from collections.abc import Container

import pandas

from .. import style
from ..drawing import critical_angles
from ..reading import fits, programs, stored
from ..refinement import critical_angle
from ..refinement.driver import UNFINISHED
from ..tools import rounded, tables
from ..tools.errors import UserError
from . import command_line


def add_format(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--format", choices=("picture", "csv"), default="picture",
                        help="draw a picture, or print the table as csv (%(default)s)")


def read_angles(path: pathlib.Path, columns: Container[str]) -> pandas.DataFrame:
    """@throws UserError"""
    tables.refuse_misread(path)
    try:
        table = pandas.read_csv(path, comment="#")
        table = table.astype(dict.fromkeys(critical_angles.FOUND, float))
    except (ValueError, KeyError):  # UnicodeDecodeError and the errors of pandas are ValueErrors
        table = pandas.DataFrame()
    if table.empty or not all(name in columns for name in table if name not in critical_angles.FOUND):
        raise UserError(f"cannot read {path} (not a table of this command); give a sweep, or its table")
    return table


def body() -> int:
    arguments = command_line.sweep_to_draw(__doc__, "critical-angle",
                                           "file of clogsweep --output, or the table of this command",
                                           [command_line.add_width, add_format])
    schema = json.loads(programs.run_program(programs.programs_in(arguments.programs) / "clogsweep", "--schema"))
    columns = fits.droplet_columns() | {column["name"]: column for column in schema["columns"]}
    source = spans = ""
    if arguments.sweep.suffix == ".csv":
        table = read_angles(arguments.sweep, columns)
    else:
        with stored.opened(arguments.sweep, stored.SWEEP, arguments.programs) as file:
            source = stored.source(stored.attributes(file))
        # Droplet sizes come first. Parameters that may follow from other parameters come last.
        parameters = sorted((name for name, column in columns.items()
                             if column.get("role") == "parameter" and column.get("parameter_role") != "ensemble"),
                            key=lambda name:
                            (name != "obstacle_diameter", "key" not in columns[name], "automatic_in" in columns[name]))
        rows = stored.read_table(arguments.sweep, arguments.programs)
        if (rows["laboratory"] != "none").all():
            groups = fits.run_clogfit(programs.programs_in(arguments.programs) / "clogfit", arguments.sweep)["groups"]
            for name in fits.DROPLETS:
                rows[name] = rows["laboratory"].map({group["laboratory"]: group[name] for group in groups})
            parameters = [*fits.DROPLETS, *parameters]
        table = critical_angle.table_of(rows, parameters)
        for words, statuses in [("failed", ["failed"]), ("are unfinished", UNFINISHED)]:
            if number := rows["status"].isin(statuses).sum():
                print(f"{number} of {rounded.count_text(len(rows), 'run')} {words} and do not count", file=sys.stderr)
        ends = sorted({rows["max_time"].min(), rows["max_time"].max()})
        spans = " within max-time=" + " to ".join(f"{span:.4g}" for span in ends)
    if arguments.format == "csv":
        print(table.to_csv(index=False, float_format="%.6g"), end="")
        return 0
    if table[["lower", "upper"]].isna().all(axis=None):
        raise UserError(f"cannot draw critical angles (the paths{spans} are too short: "
                        "straight on, they would cross fewer than two rows) try a larger max-time or lattice-angle")
    figure = style.figure_of(critical_angles.draw_on, table, columns)
    return command_line.save(style.Picture(figure, source), arguments)
