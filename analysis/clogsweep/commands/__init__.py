"""Commands of python3 -m clogsweep: a module each, with the words of its help and body()."""

import argparse
import pathlib

from ..reading import programs
from . import command_line


def sweep_to_draw(about: str | None, ending: str, what: str = "file of clogsweep --output") -> argparse.Namespace:
    """Options of a command that makes one picture of a sweep: sweep, output, programs.

    @param about  the command's docstring; @param ending  of the picture's name, which begins with that of the sweep
    @param what  is given as the sweep. @throws UserError  if the picture could not be written
    """
    parser = command_line.Parser(about)
    parser.add_argument("sweep", type=pathlib.Path, help=what)
    command_line.add_output(parser, f"name of the picture; .png and .pdf are made (SWEEP-{ending})", ".png", ".pdf")
    programs.add_option(parser)
    arguments = parser.parse_args()
    arguments.output = arguments.output or command_line.beside(arguments.sweep, ending)
    command_line.refuse_unwritable_picture(arguments.output, arguments.sweep)
    return arguments
