"""A poster of a sweep: its curves, some of its droplets, and where the numbers came from, on one page.

    clogsweep --output sweep.h5 line-tension=0.2,0.3,1 seeds=1..10
    python3 -m clogsweep poster sweep.h5                 # sweep-poster.pdf, sweep-poster.png

The page is A3. Every number comes from clogfit; clogs and the way of a droplet are run once more by clogrun, in a
temporary folder. Of droplets in a channel or on a wall it shows the passage or the sag over what the sweep varies.
"""

import pathlib

from .. import command_line, poster, programs
from ..picture import Picture


def body() -> int:
    parser = command_line.Parser(__doc__)
    parser.add_argument("sweep", type=pathlib.Path, help="output of clogsweep")
    command_line.add_output(parser, "name of the poster; .png and .pdf are made (SWEEP-poster)", ".png", ".pdf")
    programs.add_option(parser)
    arguments = parser.parse_args()
    output = arguments.output or command_line.beside(arguments.sweep, "poster")
    command_line.refuse_unwritable_picture(output, arguments.sweep)
    made = Picture(poster.draw(arguments.sweep, programs.programs_in(arguments.programs)))
    print(f"{made.save(output)} (and .pdf)")
    return 0
