#!/usr/bin/env python3
"""Compares the verdicts, distances, steps and seconds of the same runs with clog-detection=threshold and certified.

    compare.py threshold.h5 certified.h5

Prints a row per group of runs. Also prints a line for every run with another verdict, or with a distance that differs
by more than 1e-3 sigma; the exit code is then 1. If max-time ended the run before the threshold could decide, the run
counts as flowing. Repeat such a run with a larger max-time.
"""

import sys

import pandas

SAME_DISTANCE = 1e-3  # sigma
GROUP = ["model", "preset", "obstacle_gap", "stiffness"]
COMPARED = ["status", "clogged_by", "distance", "lateral_displacement", "time", "steps", "wall_seconds"]


def read(path):
    runs = pandas.read_hdf(path, "runs")
    runs["stiffness"] = runs.line_tension.where(runs.model == "dp", runs.wall_stiffness)
    return runs.set_index("task").sort_index()


def compare(threshold, certified):
    both = threshold.join(certified[COMPARED].add_suffix("_certified"), how="inner")
    both["same"] = both.status == both.status_certified
    clogs = (both.status == "clogged") & both.same
    for column in ("distance", "lateral_displacement"):
        both[column + "_error"] = (both[column] - both[column + "_certified"]).abs().where(clogs)
    return both


def summarise(runs):
    clogs = runs[runs.distance_error.notna()]

    def ratio(of, column):
        return f"{of[column].sum() / of[column + '_certified'].sum():.2f}" if len(of) else "-"

    def largest(column):
        return f"{runs[column].max():.1e}" if len(clogs) else "-"

    return pandas.Series({
        "runs": len(runs),
        "clogs": int((runs.status == "clogged").sum()),
        "certified": int((runs.clogged_by_certified == "certified").sum()),
        "other verdict": int((~runs.same).sum()),
        "distance": largest("distance_error"),
        "lateral": largest("lateral_displacement_error"),
        "steps, clogs": ratio(clogs, "steps"),
        "seconds, clogs": ratio(clogs, "wall_seconds"),
        "steps, all": ratio(runs, "steps"),
        "seconds, all": ratio(runs, "wall_seconds"),
    })


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    both = compare(*map(read, sys.argv[1:]))
    groups = [summarise(runs).rename(" ".join(map(str, key))) for key, runs in both.groupby(GROUP)]
    print(pandas.DataFrame([*groups, summarise(both).rename("all")]).to_string())
    wrong = both[~both.same | (both.distance_error > SAME_DISTANCE)]
    for _, run in wrong.iterrows():
        print(f"differs: {run.preset} {run.stiffness} gap {run.obstacle_gap} {run.obstacle_filling} seed {run.seed}: "
              f"{run.status} r={run.distance:.6f} t={run.time:.0f}; "
              f"{run.status_certified} r={run.distance_certified:.6f} t={run.time_certified:.0f}")
    sys.exit(1 if len(wrong) else 0)


if __name__ == "__main__":
    main()
