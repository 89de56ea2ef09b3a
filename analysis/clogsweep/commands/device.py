"""Draws the circles of a sweep as one device, with releases, clogs by mechanism and some paths.

    clogsweep obstacles=posts.csv box=8 length=20 side-walls=on release=entrance exit=20 seeds=1..20 --output sweep.h5
    python3 -m clogsweep device sweep.h5                 # sweep-device.png, sweep-device.pdf

Each parameter set, such as each line tension, has a panel. There are at most six panels; to draw other parameter sets,
make a sweep of them with clogsweep select. The lines are paths of replayed runs (clogrun), from the shortest to the
longest. The colour of a place shows in which fraction of the replayed runs the droplet passed over it. A number counts
the clogs at a place. The strip below shows the fraction of the droplets that passed each place along the flow, with the
counts of clogfit --lines. All lengths are in droplet diameters, or in millimetres for droplets of several sizes;
coordinates are those of the file of circles.
"""

import argparse

from ..results.sweep import Sweep
from .command_line import save, sweep_to_draw, whole


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--ways", type=whole(0), default=3, help="number of paths drawn in each panel (%(default)s)")
    parser.add_argument("--map", type=whole(0), default=6,
                        help="number of replayed runs in the map of each panel; 0: no map (%(default)s)")
    parser.add_argument("--jobs", type=whole(1), default=2, help="number of simultaneous replays (%(default)s)")


def body() -> int:
    arguments = sweep_to_draw(__doc__, "device", more=[add_options])
    sweep = Sweep(arguments.sweep, arguments.programs)
    return save(sweep.device(ways=arguments.ways, map=arguments.map, jobs=arguments.jobs), arguments)
