"""Draws P(r), the probability that a droplet travels farther than r without a clog, with a curve for each group.

    python3 -m clogsweep survival sweep.h5        # sweep-survival.png, sweep-survival.pdf
    python3 -m clogsweep survival own.csv         # measured distances, see clogfit lengths

The curves are the product-limit estimates of clogfit. Steps are clogs; ticks are droplets that were last seen moving.
clogfit compare has the p-value of the log-rank test for pairs of groups.
"""

import json

from .. import style
from ..drawing import survival_curve
from ..reading import programs, stored
from ..results import fit
from . import command_line


def body() -> int:
    arguments = command_line.sweep_to_draw(__doc__, "survival", "file of clogsweep --output, or table of measured distances", [command_line.add_width])
    if stored.is_distance_table(arguments.sweep):
        told = json.loads(programs.run_program(programs.programs_in(arguments.programs) / "clogfit", "lengths", arguments.sweep, "--format", "json"))
        curves, unit, source = survival_curve.of_table(told), told["unit"], f"clogfit lengths {arguments.sweep}"
    else:
        fitted = fit.read(arguments.sweep, arguments.programs)
        groups = fitted.known.with_lengths(arguments.sweep)
        curves, unit, source = survival_curve.of_groups(groups), "mm" if groups.are_in_mm else "sigma", fitted.source
    return command_line.save(style.Picture(style.figure_of(survival_curve.draw_on, curves, unit), source), arguments)
