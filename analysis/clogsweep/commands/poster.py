"""Draws a poster of a sweep: its curves, some of its droplets, and the origin of its numbers, on one page.

    clogsweep --output sweep.h5 line-tension=0.2,0.3,1 seeds=1..10
    python3 -m clogsweep poster sweep.h5                 # sweep-poster.pdf, sweep-poster.png

The page is A3. Every number comes from clogfit; clogs and the path of a droplet are replayed by clogrun, in a temporary
folder. For droplets in a channel or on a wall the poster shows the passage or the sag vs the varied parameter.
"""

from ..results.sweep import Sweep
from . import command_line


def body() -> int:
    arguments = command_line.sweep_to_draw(__doc__, "poster", more=[command_line.add_lab])
    return command_line.save(Sweep(arguments.sweep, arguments.programs).poster(lab=arguments.lab), arguments)
