"""Compares each statement of the article with the results of this program.

    python3 -m clogsweep agreement
    python3 -m clogsweep agreement --run --format csv

The sweeps of the figures decide whether a statement holds. The command prints our result with its interval, the results
with other laws of the walls, and a verdict: agrees, qualitatively, agrees with an added force (wall friction), artefact
of the mesh, by construction (a parameter was fitted to the published number), does not agree, not known, not run. All
rows must have the same model version.
"""

import argparse
import contextlib
import pathlib
import sys

from .. import agreement
from ..paper import finished
from ..paper.runner import Runner
from ..reading import programs
from . import command_line


def parse() -> argparse.Namespace:
    parser = command_line.Parser(__doc__)
    parser.add_argument("--size", choices=["reduced", "full"], default="reduced",
                        help="size of the figures' sweeps (reduced)")
    parser.add_argument("-o", "--output", type=pathlib.Path, default=pathlib.Path("results/figures"),
                        help="folder that python3 -m clogsweep figures wrote (results/figures)")
    parser.add_argument("--from-rows", type=pathlib.Path, nargs="?", const=finished.FOLDER, metavar="FOLDER",
                        help="judge by the full sweeps in docs/gallery/rows of the sources, "
                             "and repeat single runs only")
    parser.add_argument("--run", action="store_true",
                        help="first run the missing sweeps, which takes an hour in reduced size")
    parser.add_argument("--ranks", type=command_line.whole(1), default=2, help="MPI ranks of the sweeps (2)")
    parser.add_argument("--format", choices=sorted(agreement.WRITERS), default="markdown",
                        help="format of the table (markdown)")
    programs.add_option(parser)
    return parser.parse_args()


def body() -> int:
    arguments = parse()
    size = "full" if arguments.from_rows else arguments.size
    runner = Runner(size=size, ranks=arguments.ranks, folder=arguments.output / size,
                    programs=programs.programs_in(arguments.programs), overrides=[],
                    draw_only=not (arguments.run or arguments.from_rows), rows_folder=arguments.from_rows)
    with contextlib.redirect_stdout(sys.stderr):  # what is run; the output is the table alone
        judged = agreement.judge_all(runner)
    print(agreement.WRITERS[arguments.format](*judged), end="")
    return 0
