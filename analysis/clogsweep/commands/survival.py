"""Draws P(r), the probability that a droplet travels farther than r without a clog, with a curve for each group.

    python3 -m clogsweep survival sweep.h5        # sweep-survival.png, sweep-survival.pdf
    python3 -m clogsweep survival own.csv         # measured distances, see clogfit lengths
    python3 -m clogsweep survival sizes.h5 --mixture diameter=2.8mm:0.3,3.2mm:0.7

The curves are the product-limit estimates of clogfit. Steps are clogs; ticks are droplets that were last seen moving.
clogfit compare has the p-value of the log-rank test for pairs of groups.
"""

import argparse
import json

from .. import style
from ..drawing import survival_curve
from ..reading import programs, stored
from ..results import fit
from ..tools.errors import UserError
from . import command_line


def add_mixture(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--mixture", metavar="COLUMN=VALUE:WEIGHT,...",
                        help="also draw the curve of droplets that are mixed in these shares, see clogfit --mixture")


def body() -> int:
    arguments = command_line.sweep_to_draw(__doc__, "survival",
                                           "file of clogsweep --output, or table of measured distances",
                                           [command_line.add_width, add_mixture])
    mixture = None
    if stored.is_distance_table(arguments.sweep):
        if arguments.mixture:
            raise UserError("no place for --mixture (measured distances have no seeds); leave it out")
        clogfit = programs.programs_in(arguments.programs) / "clogfit"
        answer = json.loads(programs.run_program(clogfit, "lengths", arguments.sweep, "--format", "json"))
        curves, unit, source = survival_curve.of_table(answer), answer["unit"], f"clogfit lengths {arguments.sweep}"
    else:
        options = ["--mixture", arguments.mixture] if arguments.mixture else []
        fitted = fit.read(arguments.sweep, arguments.programs, *options)
        groups = fitted.known.with_lengths(arguments.sweep)
        curves, unit, source = survival_curve.of_groups(groups), "mm" if groups.are_in_mm else "sigma", fitted.source
        mixture = survival_curve.of_mixture(fitted.output, unit)
        if arguments.mixture and not mixture:
            raise UserError(f"no place for --mixture ({arguments.sweep} is JSON without a mixture); give the sweep")
    figure = style.figure_of(survival_curve.draw_on, curves, unit, mixture)
    return command_line.save(style.Picture(figure, source), arguments)
