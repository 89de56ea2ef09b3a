"""Draws the clogging length vs the waiting time after which a resting droplet counts as clogged.

    python3 -m clogsweep dwell sweep.h5        # sweep-dwell.png, sweep-dwell.pdf

In an experiment a droplet counts as clogged if it has not moved for a waiting time, although it might move on. The
longer this time is, the longer is the clogging length. Each group of runs has a curve, which clogfit --dwell computes.
The first waiting time is the shortest one for which every row records its dwells. The last waiting time is the duration
of the runs; with this time only runs with the status clogged count. Bars are confidence intervals; an arrow begins at a
lower bound where no run clogged.
"""

from ..drawing import dwell
from ..labels.groups import Groups
from ..reading import fits, programs, stored
from ..results.fit import Fit
from ..style import Picture
from . import command_line


def body() -> int:
    arguments = command_line.sweep_to_draw(__doc__, "dwell", more=[command_line.add_lab, command_line.add_width])
    with stored.opened(arguments.sweep, stored.SWEEP, arguments.programs):
        pass
    clogfit = programs.programs_in(arguments.programs) / "clogfit"
    lab = command_line.lab_options(arguments)
    fit = Fit(*fits.fitted(clogfit, arguments.sweep, *lab))
    times = dwell.times_of(fit.known.with_lengths(arguments.sweep))
    known = [Groups(*fits.fitted(clogfit, arguments.sweep, "--dwell", repr(time), *lab)).with_lengths(arguments.sweep)
             for time in times]
    return command_line.save(Picture(dwell.draw(times, known), fit.source), arguments)
