"""Draws figures of the paper from our own sweeps.

    python3 -m clogsweep figures list
    python3 -m clogsweep figures 6c 7c
    python3 -m clogsweep figures all --size full --output results/figures

The same command resumes an interrupted sweep, and never repeats finished runs. Figures that share a sweep run it once.
Each figure is written to FOLDER/SIZE as figure-NAME.png and .pdf, with its numbers as .csv and their origin as .txt.
"""

import argparse
import pathlib
import sys

from ..paper import figures, finished
from ..paper.plate import CATALOGUE
from ..paper.runner import Override, Runner, measured
from ..reading import programs
from ..tools.errors import NotThere, UserError
from ..tools.texts import printable
from . import command_line


def parse() -> argparse.Namespace:
    parser = command_line.Parser(__doc__)
    parser.add_argument("names", nargs="+", metavar="NAME",
                        help="names of figures; list shows the names, all means all figures")
    parser.add_argument("--size", choices=["reduced", "full"], default="reduced",
                        help="reduced sweeps take minutes on two cores; full sweeps have the published size")
    parser.add_argument("--ranks", type=command_line.whole(1), default=2,
                        help="number of MPI ranks of the sweeps, and of simultaneous runs (2)")
    parser.add_argument("-o", "--output", type=pathlib.Path, default=pathlib.Path("results/figures"),
                        help="folder of the results (results/figures)")
    parser.add_argument("--draw-only", action="store_true", help="draw from existing results and run nothing")
    parser.add_argument("--from-rows", type=pathlib.Path, nargs="?", const=finished.FOLDER, metavar="FOLDER",
                        help="draw the full size from the runs in docs/gallery/rows of the sources, "
                             "and repeat single runs only")
    parser.add_argument("--profile", type=pathlib.Path, action="append", default=[], metavar="FILE.csv",
                        help="measured passage (columns h [sigma], v [v_t], A), drawn in figures 2, 3 (two profiles: "
                             "orifices of 0.9, then 0.7 sigma) and 4, and compared with the simulation in figure B2")
    parser.add_argument("--set", action="append", default=[], metavar="[CONFIG:]KEY=VALUE",
                        help="replace a value of the config, e.g. clogging-sp:seeds=1..50; "
                             "keys that a figure itself sets cannot be replaced")
    programs.add_option(parser)
    return parser.parse_args()


def body() -> int:
    arguments = parse()
    if arguments.names == ["list"]:
        figures.print_list()
        return 0
    names = figures.ORDER if arguments.names == ["all"] else arguments.names
    for name in names:
        if name not in CATALOGUE:
            raise UserError(f"no figure {name}; {command_line.name()} list names them")
    if arguments.from_rows and arguments.draw_only:
        raise UserError("invalid --from-rows with --draw-only (single runs are repeated, which takes seconds); "
                        "drop --draw-only")
    if arguments.from_rows and arguments.set:
        raise UserError("invalid --from-rows with --set (the rows are of the full configs); drop one of them")
    size = "full" if arguments.from_rows else arguments.size
    runner = Runner(size=size, ranks=arguments.ranks, folder=arguments.output / size, rows_folder=arguments.from_rows,
                    programs=programs.programs_in(arguments.programs),
                    overrides=[Override.parse(text) for text in getattr(arguments, "set")],
                    profiles=arguments.profile, draw_only=arguments.draw_only)
    for path in arguments.profile:
        measured(path)
    try:
        runner.folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise UserError(f"cannot make {runner.folder} ({error.strerror}); give another --output") from error
    for name in names:
        figures.refuse_unwritable(name, runner)
    command = " ".join([command_line.name(), *sys.argv[1:]])
    for name in names:
        try:
            figures.write(CATALOGUE[name].draw(runner), CATALOGUE[name], runner, command)
        except NotThere as missing:
            if not (arguments.from_rows and arguments.names == ["all"]):
                raise
            runner.take_sources()
            print(printable(f"figure {name} is not drawn: {missing}"), file=sys.stderr)
    return 0
