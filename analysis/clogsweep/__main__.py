"""Pictures, films and pages of the results of clogsweep and clogrun.

    python3 -m clogsweep COMMAND ...
    python3 -m clogsweep COMMAND --help
"""

import importlib
import sys

from .commands import command_line
from .tools.errors import UserError
from .tools.texts import did_you_mean

COMMANDS = {
    "figures": "a figure of the article from runs of our own",
    "agreement": "the statements of the article compared with the results of this program",
    "report": "one page of HTML about a sweep, as clogfit report",
    "refine": "values and seeds of a sweep where its curve needs them",
    "curve": "a smooth curve through the clogging lengths, its peak and crossings, as clogfit curve",
    "poster": "one page of a sweep to be printed",
    "clogging-length": "the clogging length against what a sweep varies",
    "critical-angle": "the angle up to which droplets follow the rows of lattices",
    "dwell": "the same over the time after which a droplet that stands counts as clogged",
    "survival": "the probability to travel farther than r, for each group of a sweep or of measured distances",
    "compare": "ratios of the clogging lengths of two sweeps",
    "clogs": "the clogs of a sweep on one sheet",
    "predict": "the clogging length of stiff droplets in an array in which none has run",
    "daughters": "the droplets into which those of a sweep break up, and their sizes where they leave",
    "collision": "which droplets break up on a single obstacle",
    "droplet": "one run as a picture or a film",
    "circles": "a drawing of a device, or a picture of one, as a file of circles",
    "device": "the circles of a sweep, with releases, clogs and some ways",
    "calibrate": "line tension and near-wall drag from measured passages through a channel, as clogfit calibrate",
    "deviation": "Delta_v and Delta_A of one passage from others, as clogfit deviation",
    "drag": "exponent of the near-wall drag from speeds along a wall, as clogfit drag",
    "export": "the rows of a sweep as CSV, or as HDF5 with a dataset for each column",
    "export-vtk": "one run for ParaView",
}


def usage() -> str:
    return f"{__doc__}\n" + "\n".join(f"  {name:16} {about}" for name, about in COMMANDS.items())


def become(command: str) -> int:
    """@return the command's exit code"""
    with command_line.needs_modules():
        module = importlib.import_module(f".commands.{command.replace('-', '_')}", __package__)
    return module.body()


def choose() -> int:
    command, *words = sys.argv[1:] or ["--help"]
    if command in ("-h", "--help"):
        print(usage())
        return 0
    if command not in COMMANDS:
        raise UserError(f"unknown command: {command}{did_you_mean(command, COMMANDS) or '; python3 -m clogsweep --help lists them'}")
    command_line.speak_as(f"python3 -m clogsweep {command}")
    sys.argv[1:] = words
    return become(command)


def main() -> int:
    command_line.speak_as("python3 -m clogsweep")
    return command_line.run(choose)


if __name__ == "__main__":
    sys.exit(main())
