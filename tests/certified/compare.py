#!/usr/bin/env python3
"""Compares the same runs with clog-detection=threshold and certified: verdicts, distances, steps, seconds.

    compare.py threshold.h5 certified.h5

Prints a row per group of runs and a line for every run that differs; exit code 1 if there is one.
"""

import sys

import pandas

SAME_PLACE = 1e-3  # sigma
GROUP = ["model", "preset", "obstacle_gap", "stiffness"]


def read(path):
    runs = pandas.read_hdf(path, "runs")
    runs["stiffness"] = runs.line_tension.where(runs.model == "dp", runs.wall_stiffness)
    return runs.set_index("task").sort_index()


def compare(threshold, certified):
    both = threshold.join(certified[["status", "clogged_by", "distance", "lateral_displacement", "time", "steps", "wall_seconds"]],
                          rsuffix="_certified", how="inner")
    if "clogged_by_certified" not in both:
        both = both.rename(columns={"clogged_by": "clogged_by_certified"})
    both["same"] = both.status == both.status_certified
    clogged = (both.status == "clogged") & both.same
    apart = (both.distance - both.distance_certified).abs()
    both["apart"] = apart.combine((both.lateral_displacement - both.lateral_displacement_certified).abs(), max).where(clogged)
    return both


def summarise(runs):
    clogged = runs[runs.apart.notna()]
    return pandas.Series({
        "runs": len(runs),
        "clogs": int((runs.status == "clogged").sum()),
        "certified": int((runs.clogged_by_certified == "certified").sum()),
        "other verdict": int((~runs.same).sum()),
        "largest difference": f"{runs.apart.max():.1e}" if len(clogged) else "-",
        "steps of clogs": f"{clogged.steps.sum() / clogged.steps_certified.sum():.2f}" if len(clogged) else "-",
        "seconds of clogs": f"{clogged.wall_seconds.sum() / clogged.wall_seconds_certified.sum():.2f}" if len(clogged) else "-",
        "steps": f"{runs.steps.sum() / runs.steps_certified.sum():.2f}",
        "seconds": f"{runs.wall_seconds.sum() / runs.wall_seconds_certified.sum():.2f}",
    })


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    both = compare(*map(read, sys.argv[1:]))
    table = both.groupby(GROUP).apply(summarise)
    print(pandas.concat([table.reset_index(), summarise(both).to_frame().T.assign(model="all")]).fillna("").to_string(index=False))
    wrong = both[~both.same | (both.apart > SAME_PLACE)]
    for task, run in wrong.iterrows():
        print(f"differs: {run.preset} {run.stiffness} gap {run.obstacle_gap} {run.obstacle_filling} seed {run.seed}: "
              f"{run.status} {run.distance:.6f} t {run.time:.0f}, "
              f"{run.status_certified} {run.distance_certified:.6f} t {run.time_certified:.0f} {run.clogged_by_certified}")
    sys.exit(1 if len(wrong) else 0)


if __name__ == "__main__":
    main()
