"""Draws the ratios of the clogging lengths of sweeps.

    python3 -m clogsweep compare robust.h5 elastic.h5                # robust-compare.png, robust-compare.pdf
    python3 -m clogsweep compare sweep.h5 --by friction

Every number comes from clogfit compare, which has the same options; `clogfit compare --picture NAME` draws the same
picture. Bars are confidence intervals: solid bars come from pairs of runs with the same seed, dashed bars from the
numbers of clogs alone. A hollow marker means a doubt about one of the two lengths. The picture explains the doubts, and
counts failed and unfinished runs.
"""

import json
import pathlib

from .. import style
from ..drawing import ratios
from ..reading import programs
from ..tools import outputs
from .command_line import Parser, add_output, add_width, beside, save


def body() -> int:
    parser = Parser(__doc__)
    parser.add_argument("sweeps", type=pathlib.Path, nargs="+",
                        help="files of clogsweep --output; each further file is compared with the first")
    parser.add_argument("--by", help="key; its values are compared with each other")
    parser.add_argument("--within",
                        help="the two clogs of a pair count as one place if they are within this distance [sigma]")
    parser.add_argument("--confidence", help="confidence level of the intervals (0.95)")
    add_output(parser, "name of the picture; .png and .pdf are made (FIRST-compare)", ".png", ".pdf")
    add_width(parser)
    programs.add_option(parser)
    arguments = parser.parse_args()
    arguments.output = arguments.output or beside(arguments.sweeps[0], "compare")
    outputs.refuse_unwritable_picture(arguments.output, arguments.sweeps[0])
    options = [word for name in ("by", "within", "confidence") if (value := getattr(arguments, name)) is not None
               for word in (f"--{name}", value)]
    clogfit = programs.programs_in(arguments.programs) / "clogfit"
    answer = json.loads(programs.run_with_warnings(clogfit, "compare", *arguments.sweeps, *options, "--format", "json"))
    source = f"clogfit compare {' '.join(map(str, [*arguments.sweeps, *options]))}"
    return save(style.Picture(style.figure_of(ratios.draw_on, answer), source), arguments)
