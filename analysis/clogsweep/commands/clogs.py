"""Draws the clogged droplets of a sweep on one sheet, with what holds each of them.

    clogsweep --output sweep.h5 line-tension=0.2,0.3,1 seeds=1..10
    python3 -m clogsweep clogs sweep.h5                  # sweep-clogs.png, sweep-clogs.pdf

Runs the clogged rows again until they rest (clogrun; an outline is in no table). The flow goes to the right. Touched
obstacles are blue, arcs of contact red, the droplet's convex hull dashed. Titles say by what and how far away it
clogged, how many obstacles it wraps and which part of its support they bear, and how many gaps and contacts it has.
"""

import pathlib

from ..drawing import clogs
from ..reading import programs
from ..results.sweep import Sweep
from ..tools import outputs
from . import command_line


def body() -> int:
    parser = command_line.Parser(__doc__)
    parser.add_argument("sweep", type=pathlib.Path, help="file of clogsweep --output")
    command_line.add_output(parser, "name of the picture; .png and .pdf are made (SWEEP-clogs)", ".png", ".pdf")
    programs.add_option(parser)
    parser.add_argument("--most", type=command_line.whole(1), default=30, help="draw so many clogs at most, the first (%(default)s)")
    parser.add_argument("--tasks", type=command_line.tasks, help="only these, e.g. 3,17,40")
    parser.add_argument("--mechanism", choices=clogs.MECHANISMS, help="only these")
    parser.add_argument("--jobs", type=command_line.whole(1), default=2, help="runs at a time (%(default)s)")
    arguments = parser.parse_args()
    output = arguments.output or command_line.beside(arguments.sweep, "clogs")
    outputs.refuse_unwritable_picture(output, arguments.sweep)
    found = Sweep(arguments.sweep, arguments.programs).clogs(
        mechanism=arguments.mechanism, tasks=arguments.tasks, most=arguments.most, jobs=arguments.jobs)
    print(f"{found.picture().save(output)} (and .pdf)")
    return 0
