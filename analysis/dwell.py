#!/usr/bin/python3
"""Draws the clogging length against the time after which a droplet that has not moved counts as clogged.

    analysis/dwell.py sweep.h5        # sweep-dwell.png, sweep-dwell.pdf

An experiment calls a droplet clogged that it has not seen move for a while, though it might go on; the longer the while,
the longer the length. A curve for each group of runs; every number comes from clogfit --dwell, nothing is fitted here.
The first time is the shortest of which all rows know who stood for longer, the last is the length of the runs, and the
length there is that of clogs alone. Bars are confidence intervals; a triangle is a lower bound where no run clogged.
"""

import json
import pathlib
import sys

import command_line
from command_line import UserError

with command_line.needs_modules():
    import numpy as np
    import programs
    import stored
    import style
    from groups import Groups
    from style import plt

NUM_TIMES = 12


def fit_at(program, sweep, *options):
    """The groups that clogfit tells of."""
    return Groups(json.loads(programs.run_program(program, sweep, "--format", "json", *options)))


def times_of(groups):
    """Evenly spaced on a logarithmic scale, for all groups. @throws UserError  if there are none"""
    known = [group["dwells_known_from"] for group in groups.members]
    if None in known:
        raise UserError("cannot draw dwells (the file holds rows of a version that did not look for them); compute the sweep anew, into another file")
    first, last = max(known), max(groups.values("max_time"))
    if not 0 < first < last:
        raise UserError(f"cannot draw dwells (they are known from {first:.4g} t0 on, and no run is longer); make max-time longer")
    # Ends as they are: a first time that is rounded down would be refused.
    return [first, *np.geomspace(first, last, NUM_TIMES)[1:-1].tolist(), last]


def label_of(groups, member):
    """What tells a group from the others."""
    names = [name for name in [groups.abscissa, *groups.curve_parameters()] if groups.varies(name)]
    return ", ".join(groups.said(name, member[name]) for name in names)


def draw(times, fits):
    """@param fits  groups of the same sweep for each of these times"""
    figure, axes = plt.subplots(figsize=(6.4, 4.8), layout="constrained")
    curves = list(zip(*(groups.members for groups in fits)))
    for index, members in enumerate(curves):
        places = [time * style.side_by_side(index, len(curves), times) for time in times]
        style.draw_lengths(axes, places, members, index, label_of(fits[-1], members[-1]))
    style.logarithmic_abscissa(axes, times)
    axes.xaxis.set_major_formatter("{x:g}")  # times may be long
    lengths = fits[-1].values("dwell_length")
    moved = f"{lengths.pop():g}" + r"\,\sigma" if len(lengths) == 1 else r"\delta_\mathrm{d}"
    axes.set_xlabel(f"time without having moved by ${moved}$ that counts as clogged $/t_0$")
    everyone = [group for groups in fits for group in groups.members]
    style.finish_lengths(axes, fits[-1], everyone, "most went on later, or other clogs")
    return figure


def body():
    parser = command_line.Parser(__doc__)
    parser.add_argument("sweep", type=pathlib.Path, help="file of clogsweep --output")
    command_line.add_output(parser, "name of the picture; .png and .pdf are made (SWEEP-dwell)", ".png", ".pdf")
    programs.add_option(parser)
    arguments = parser.parse_args()
    output = arguments.output or command_line.beside(arguments.sweep, "dwell")
    command_line.refuse_unwritable_picture(output, arguments.sweep)
    with stored.opened(arguments.sweep, stored.SWEEP):
        pass
    program = programs.programs_in(arguments.programs) / "clogfit"
    groups = fit_at(program, arguments.sweep)
    groups.refuse_passages()
    if not groups.members:
        raise UserError(f"{arguments.sweep} holds no finished runs")
    times = times_of(groups)
    style.save(draw(times, [fit_at(program, arguments.sweep, "--dwell", repr(time)) for time in times]), output)
    print(f"{output}.png (and .pdf)")
    return 0


if __name__ == "__main__":
    sys.exit(command_line.run(body))
