"""Writes a table of this folder: the lengths and speeds of finished sweeps, and where they came from.

    docs/gallery/tables/lengths.py figure-6c-full.csv SWEEP.h5...

A parameter set of which runs are missing is left out. Lengths are in droplet diameters, with 95 % intervals; speeds in units of v_t.
"""

import pathlib
import re
import sys

import clogsweep
import pandas

PARAMETERS = ["model", "preset", "friction", "line_tension", "wall_stiffness", "obstacle_gap", "obstacle_diameter", "obstacle_density",
              "near_wall_drag", "vertices", "max_time"]
RESULTS = ["runs", "clogs", "wrapped", "squeezed", "hybrid", "clogging_length", "clogging_length_lower", "clogging_length_upper",
           "relative_speed_all", "relative_speed_all_error", "weibull_p_value", "doubts"]


def finished(groups):
    """The sets with as many runs as any, none of them unfinished."""
    return groups[(groups.runs == groups.runs.max()) & (groups.interrupted == 0)]


def processor():
    return next(line.split(":")[1].strip() for line in open("/proc/cpuinfo") if line.startswith("model name"))


def main(name, *files):
    about, tables = [], []
    for file in files:
        sweep = clogsweep.open(file)
        tables.append(finished(sweep.fit().groups))
        command = re.sub(r"\S+/(jobs/|[^/ ]+\.h5)", r"\1", sweep.attributes["command_line"])
        about.append(f"# {command}\n#   {sweep.rows.processor_seconds.sum() / 3600:.2f} core-hours on {processor()}, "
                     f"model version {sweep.rows.model_version.max()}, git {sweep.attributes['git_hash']}, "
                     f"{sweep.attributes['start_time'][:10]}\n")
    table = pandas.concat(tables, ignore_index=True)[PARAMETERS + RESULTS].dropna(axis="columns", how="all")
    text = table.to_csv(index=False, float_format="%.4g")
    (pathlib.Path(__file__).parent / name).write_text("".join(about) + text)


main(*sys.argv[1:])
