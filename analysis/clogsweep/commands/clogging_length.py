"""Draws the clogging length against line tension (DP) or wall stiffness (SP), one curve per obstacle array.

    python3 -m clogsweep clogging-length sweep.h5        # sweep-clogging-length.png, sweep-clogging-length.pdf
    clogfit sweep.h5 --format json | python3 -m clogsweep clogging-length /dev/stdin --output clogging-length     # the same

Every number comes from clogfit, which is asked for a sweep's; nothing is fitted here. Bars are its confidence
intervals; markers show by what most droplets clogged; an open marker is a length that clogfit doubts, the picture says
why; a triangle pointing up is a lower bound where no run clogged.
"""

import pathlib

from .. import command_line, fit, lengths, programs
from ..picture import Picture


def body() -> int:
    parser = command_line.Parser(__doc__)
    parser.add_argument("sweep", type=pathlib.Path, help="file of clogsweep --output, or output of clogfit --format json")
    command_line.add_output(parser, "name of the picture; .png and .pdf are made (SWEEP-clogging-length)", ".png", ".pdf")
    programs.add_option(parser)
    arguments = parser.parse_args()
    output = arguments.output or command_line.beside(arguments.sweep, "clogging-length")
    command_line.refuse_unwritable_picture(output, arguments.sweep)
    groups = fit.read(arguments.sweep, arguments.programs).drawable(arguments.sweep)
    print(f"{Picture(lengths.draw(groups)).save(output)} (and .pdf)")
    return 0
