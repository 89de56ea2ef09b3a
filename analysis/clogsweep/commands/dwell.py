"""Draws the clogging length against the time after which a droplet that has not moved counts as clogged.

    python3 -m clogsweep dwell sweep.h5        # sweep-dwell.png, sweep-dwell.pdf

An experiment calls a droplet clogged that it has not seen move for a while, though it might go on; the longer the while,
the longer the length. A curve for each group of runs; every number comes from clogfit --dwell, nothing is fitted here.
The first time is the shortest of which all rows know who stood for longer, the last is the length of the runs, and the
length there is that of clogs alone. Bars are confidence intervals; a triangle is a lower bound where no run clogged.
"""

import pathlib

from .. import command_line, dwell, programs, stored


def body() -> int:
    parser = command_line.Parser(__doc__)
    parser.add_argument("sweep", type=pathlib.Path, help="file of clogsweep --output")
    command_line.add_output(parser, "name of the picture; .png and .pdf are made (SWEEP-dwell)", ".png", ".pdf")
    programs.add_option(parser)
    arguments = parser.parse_args()
    output = arguments.output or command_line.beside(arguments.sweep, "dwell")
    command_line.refuse_unwritable_picture(output, arguments.sweep)
    with stored.opened(arguments.sweep, stored.SWEEP):
        pass
    picture = dwell.picture(programs.programs_in(arguments.programs) / "clogfit", arguments.sweep)
    print(f"{picture.save(output)} (and .pdf)")
    return 0
