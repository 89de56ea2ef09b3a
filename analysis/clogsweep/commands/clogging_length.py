"""Draws the clogging length against line tension (DP) or wall stiffness (SP), one curve per obstacle array. For
lattices it draws the lateral displacement per distance against the angle of the rows.

    python3 -m clogsweep clogging-length sweep.h5        # sweep-clogging-length.png, sweep-clogging-length.pdf
    python3 -m clogsweep clogging-length sweep.h5 --with own.csv --lab lab.cfg     # beside measured distances, see clogfit lengths
    clogfit sweep.h5 --format json | python3 -m clogsweep clogging-length /dev/stdin --output clogging-length     # points only

Every length and its confidence interval (the bar) come from clogfit. Smooth lines with bands are the curves of clogfit
curve; they are drawn only from a sweep file. Each marker shows the most frequent mechanism of its clogs. A hollow
marker means a doubt, which the picture explains. An arrow pointing up starts at a lower bound:
no run clogged.
"""

import argparse
import pathlib

from .. import style
from ..drawing import curve, measured
from ..results import fit
from ..tools.errors import UserError
from . import command_line


def add_measured(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--with", dest="measured", metavar="TABLE", type=pathlib.Path,
                        help="also draw the lengths from this table of measured distances, see clogfit lengths")


def body() -> int:
    arguments = command_line.sweep_to_draw(__doc__, "clogging-length",
                                           "file of clogsweep --output, or output of clogfit --format json",
                                           [command_line.add_lab, add_measured, command_line.add_width])
    lab = command_line.lab_options(arguments)
    fitted = fit.read(arguments.sweep, arguments.programs, *lab)
    groups = fitted.known.with_lengths(arguments.sweep)
    if arguments.measured and groups.are_lattices:
        raise UserError("no place for --with (pictures of lattices show lateral displacements); "
                        f"clogfit compare {arguments.measured} {arguments.sweep} compares lengths")
    own = measured.lengths_of(arguments.measured, groups, arguments.programs, *lab) if arguments.measured else []
    figure = style.figure_of(curve.draw_on, groups)
    if own:
        measured.draw_on(figure.axes[0], own, groups, arguments.measured.name)
    return command_line.save(style.Picture(figure, fitted.source), arguments)
