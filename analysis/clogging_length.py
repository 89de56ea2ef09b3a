#!/usr/bin/python3
"""Draws the clogging length against line tension (DP) or wall stiffness (SP), one curve per obstacle array.

    analysis/clogging_length.py sweep.h5        # sweep-clogging-length.png, sweep-clogging-length.pdf
    clogfit sweep.h5 --format json | analysis/clogging_length.py /dev/stdin --output clogging-length     # the same

Every number comes from clogfit, which is asked for a sweep's; nothing is fitted here. Bars are its confidence
intervals; markers show by what most droplets clogged; an open marker is a length that clogfit doubts, the picture says
why; a triangle pointing up is a lower bound where no run clogged.
"""

import json
import pathlib
import sys

import command_line
from command_line import UserError

with command_line.needs_modules():
    import programs
    import style
    from groups import Groups
    from style import plt

HDF5_BEGINNING = b"\x89HDF\r\n\x1a\n"


def draw(groups):
    figure, axes = plt.subplots(figsize=(6.4, 4.8), layout="constrained")
    curves = groups.curves()
    for index, (label, members) in enumerate(curves):
        style.draw_lengths(axes, groups.places(members, index, len(curves)), members, index, label)
    groups.draw_abscissa(axes)
    style.finish_lengths(axes, groups, groups.members)
    return figure


def read_fit(path, folder):
    """What clogfit says of a sweep. @param path  of the sweep, or of clogfit's JSON; @param folder  of the programs"""
    try:
        content = path.read_bytes()
    except FileNotFoundError as error:
        raise UserError(f"cannot read {path} (no such file); check the name") from error
    except OSError as error:
        raise UserError(f"cannot read {path} ({error.strerror}); give a sweep, or the output of clogfit --format json") from error
    if content.startswith(HDF5_BEGINNING):
        content = programs.run_program(programs.programs_in(folder) / "clogfit", path, "--format", "json")
    try:
        return Groups(json.loads(content))
    except (ValueError, KeyError, TypeError) as error:
        raise UserError(f"cannot read {path} ({error}); give a sweep, or the output of clogfit --format json") from error


def body():
    parser = command_line.Parser(__doc__)
    parser.add_argument("sweep", type=pathlib.Path, help="file of clogsweep --output, or output of clogfit --format json")
    command_line.add_output(parser, "name of the picture; .png and .pdf are made (SWEEP-clogging-length)", ".png", ".pdf")
    programs.add_option(parser)
    arguments = parser.parse_args()
    output = arguments.output or command_line.beside(arguments.sweep, "clogging-length")
    command_line.refuse_unwritable_picture(output, arguments.sweep)
    groups = read_fit(arguments.sweep, arguments.programs)
    groups.refuse_passages()
    if not groups.members:
        raise UserError(f"{arguments.sweep} holds no finished runs")
    style.save(draw(groups), output)
    print(f"{output}.png (and .pdf)")
    return 0


if __name__ == "__main__":
    sys.exit(command_line.run(body))
