"""Writes a page about a sweep: curves, table, example clogs or outlines, doubts, the origin of its numbers. The page
opens offline in any browser.

    clogfit report sweep.h5 --output report.html      # is python3 -m clogsweep report

Every number comes from clogfit. Example clogs are replayed by clogrun until they rest, in a temporary folder. For
droplets in a channel or on a wall the page shows the passage or the sag vs the varied parameter, and some outlines.
"""

import pathlib

from ..pages import report
from ..reading import programs
from . import command_line


def body() -> int:
    parser = command_line.Parser(__doc__)
    parser.add_argument("sweep", type=pathlib.Path, help="output of clogsweep")
    command_line.add_output(parser, "HTML file to write (SWEEP-report.html)")
    parser.add_argument("--examples", type=command_line.whole(0), default=4,
                        help="number of runs to replay and to show as clogs, outlines or paths (4); 0: replay nothing")
    command_line.add_lab(parser)
    programs.add_option(parser)
    arguments = parser.parse_args()
    output = arguments.output or command_line.beside(arguments.sweep, "report.html")
    command_line.tell(report.write(arguments.sweep, output, arguments.examples,
                                   programs.programs_in(arguments.programs), *command_line.lab_options(arguments)))
    return 0
