"""Draws the clogged droplets of a sweep on one sheet, with what holds each of them.

    clogsweep --output sweep.h5 line-tension=0.2,0.3,1 seeds=1..10
    python3 -m clogsweep clogs sweep.h5                  # sweep-clogs.png, sweep-clogs.pdf

Runs the clogged rows again until they rest (clogrun; an outline is in no table). The flow goes to the right. Touched
obstacles are blue, arcs of contact red, the droplet's convex hull dashed. Titles say by what and how far away it
clogged, how many obstacles it wraps and which part of its support they bear, and how many gaps and contacts it has.
"""

import argparse

from ..drawing import clogs
from ..results.sweep import Sweep
from .command_line import save, sweep_to_draw, tasks, whole


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--most", type=whole(1), default=30, help="draw so many clogs at most, the first (%(default)s)")
    parser.add_argument("--tasks", type=tasks, help="only these, e.g. 3,17,40")
    parser.add_argument("--mechanism", choices=clogs.MECHANISMS, help="only these")
    parser.add_argument("--jobs", type=whole(1), default=2, help="runs at a time (%(default)s)")


def body() -> int:
    arguments = sweep_to_draw(__doc__, "clogs", more=[add_options])
    found = Sweep(arguments.sweep, arguments.programs).clogs(
        mechanism=arguments.mechanism, tasks=arguments.tasks, most=arguments.most, jobs=arguments.jobs)
    return save(found.picture(), arguments)
