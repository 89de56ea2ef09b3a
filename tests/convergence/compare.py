#!/usr/bin/env python3
"""Compares the runs of sweeps over `vertices` with the runs of the most vertices: their verdicts, the places of clogs,
and lambda.

    compare.py --clogfit build/release/bin/clogfit sweep.h5 [sweep.h5 ...]

Two runs count as the same if both clogged within 0.02 sigma of each other, or if neither clogged. Prints a row per
preset, gap and line tension, with a cell per number of vertices. A cell contains the number of equal runs, the median
distance between the two clogs of a seed [sigma], and lambda with its 95 % interval from clogfit [sigma]. The last rows
contain the sums, and the time that the runs took.
"""

import argparse
import json
import subprocess

import pandas

SAME_PLACE = 0.02  # sigma
GROUP = ["preset", "obstacle_gap", "line_tension"]


def fits(clogfit, path):
    document = json.loads(subprocess.run([clogfit, path, "--format", "json"], check=True, capture_output=True).stdout)
    return {tuple(group[key] for key in [*GROUP, "vertices"]): group for group in document["groups"]}


def compared(runs, finest):
    """Joins every run with the run of the same seed that has the most vertices."""
    both = runs.set_index("seed").join(finest.set_index("seed"), rsuffix="_finest", how="inner")
    both["both_clog"] = (both.status == "clogged") & (both.status_finest == "clogged")
    both["apart"] = (both.distance - both.distance_finest).abs()
    neither = (both.status != "clogged") & (both.status_finest != "clogged")
    both["same"] = neither | (both.both_clog & (both.apart < SAME_PLACE))
    return both


def text_of(both, fit):
    median = f"{both.apart[both.both_clog].median():.0e}" if both.both_clog.any() else "-"
    length, low, high = (fit["clogging_length" + part] for part in ("", "_lower", "_upper"))
    shown = f"{length:.3g} ({low:.2g} .. {high:.2g})" if length else f"> {low:.2g}"
    return f"{both.same.sum()}; {median}; {shown}"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--clogfit", required=True)
    parser.add_argument("sweeps", nargs="+")
    arguments = parser.parse_args()
    runs = pandas.concat([pandas.read_hdf(path, "runs") for path in arguments.sweeps])
    fit_of = {key: fit for path in arguments.sweeps for key, fit in fits(arguments.clogfit, path).items()}
    numbers = sorted(runs.vertices.unique())

    def print_row(*cells):
        print("| " + " | ".join(map(str, cells)) + " |")

    print_row("interface", "gap", "Gamma", "runs", *numbers)
    print("|" + "---|" * (4 + len(numbers)))
    for key, group in runs.groupby(GROUP):
        of = {number: part for number, part in group.groupby("vertices")}
        cells = [text_of(compared(of[number], of[numbers[-1]]), fit_of[*key, number]) for number in numbers]
        print_row(key[0], f"{key[1]:g}", f"{key[2]:g}", len(of[numbers[-1]]), *cells)
    for preset, group in runs.groupby("preset"):
        for name, part in [("all", group), ("Gamma >= 0.3", group[group.line_tension >= 0.3])]:
            finest = part[part.vertices == numbers[-1]]
            sums = []
            for number in numbers:
                of = part[part.vertices == number]
                same = sum(compared(of_key, finest_of(finest, key)).same.sum() for key, of_key in of.groupby(GROUP))
                sums.append(f"{same} of {len(of)}; {of.wall_seconds.sum():.0f} s")
            print_row(f"**{preset}, {name}**", "", "", len(finest), *sums)


def finest_of(finest, key):
    return finest[(finest[GROUP] == list(key)).all(axis=1)]


if __name__ == "__main__":
    main()
