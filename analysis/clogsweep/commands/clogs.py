"""Draws the clogged droplets of a sweep on one sheet, with the mechanism of each.

    clogsweep --output sweep.h5 line-tension=0.2,0.3,1 seeds=1..10
    python3 -m clogsweep clogs sweep.h5                  # sweep-clogs.png, sweep-clogs.pdf

clogrun replays the clogged runs until the droplets rest, because no table contains outlines. The flow is to the right.
Touched obstacles are blue, arcs of contact red, the droplet's convex hull dashed. Titles give the mechanism and the
distance, the number of wrapped obstacles and which fraction of the support they bear, and the numbers of gaps and
contacts.
"""

import argparse

from ..drawing import clogs
from ..results.sweep import Sweep
from .command_line import save, sweep_to_draw, tasks, whole


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--most", type=whole(1), default=30,
                        help="draw at most this number of clogs, beginning with the first (%(default)s)")
    parser.add_argument("--tasks", type=tasks, help="draw only the clogs of these tasks, e.g. 3,17,40")
    parser.add_argument("--mechanism", choices=clogs.MECHANISMS, help="draw only clogs with this mechanism")
    parser.add_argument("--jobs", type=whole(1), default=2, help="number of simultaneous replays (%(default)s)")


def body() -> int:
    arguments = sweep_to_draw(__doc__, "clogs", more=[add_options])
    found = Sweep(arguments.sweep, arguments.programs).clogs(
        mechanism=arguments.mechanism, tasks=arguments.tasks, most=arguments.most, jobs=arguments.jobs)
    return save(found.picture(), arguments)
