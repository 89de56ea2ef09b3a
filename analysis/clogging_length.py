#!/usr/bin/python3
"""Draws the clogging length against line tension (DP) or wall stiffness (SP), one curve per obstacle array.

    analysis/clogging_length.py sweep.h5        # sweep-clogging-length.png, sweep-clogging-length.pdf
    clogfit sweep.h5 --format json | analysis/clogging_length.py /dev/stdin --output clogging-length     # the same

Every number comes from clogfit, which is asked for a sweep's; nothing is fitted here. Bars are its confidence
intervals; markers show by what most droplets clogged; an open marker is a length that clogfit doubts, the picture says
why; a triangle pointing up is a lower bound where no run clogged.
"""

import json
import math
import pathlib
import sys

import command_line
from command_line import UserError

with command_line.needs_modules():
    import programs
    import style
    from style import plt

HDF5_BEGINNING = b"\x89HDF\r\n\x1a\n"
# What a sweep may vary beside the abscissa: name in the file, symbol.
CURVE_PARAMETERS = [
    ("obstacle_gap", r"w_\mathrm{ob}/\sigma"),
    ("obstacle_diameter", r"\sigma_\mathrm{ob}/\sigma"),
    ("obstacle_diameter_spread", r"\Delta\sigma_\mathrm{ob}/\sigma_\mathrm{ob}"),
    ("obstacle_density", r"\rho_\mathrm{ob}\sigma^2"),
    ("lattice_angle", r"\theta/^\circ"),
    ("near_wall_drag", r"b_0/b_\infty"),
    ("terminal_speed", r"V_t"),
    ("vertices", r"N_v"),
    ("max_time", r"T/t_0"),
    ("box", r"L/\sigma"),
    ("boxes", r"n_\mathrm{box}"),
    ("clog_energy", r"E_k/E_t"),
]
IN_CAPTION = {"obstacle_gap", "obstacle_diameter", "lattice_angle", "near_wall_drag", "terminal_speed", "vertices"}
# Their automatic values follow from the others; then they make no curve of their own.
AUTOMATIC_PARAMETERS = [
    ("time_step", r"\Delta t/t_0"),
    ("area_stiffness", r"K_a"),
    ("perimeter_stiffness", r"K_l"),
]


def number(value):
    # The density of a saturated mixture is not known beforehand: clogfit has no number for it.
    return r"\mathrm{saturated}" if value is None else f"{value:.4g}"


def caption(groups):
    """What all curves have in common, and how many runs are behind them."""
    first = groups[0]
    words = ["deformable polygon" if first["model"] == "dp" else "soft disk"]
    for name, symbol in CURVE_PARAMETERS:
        is_common = first[name] is not None and all(group[name] == first[name] for group in groups)
        is_of_model = first["model"] == "dp" or name not in ("near_wall_drag", "vertices")
        if is_common and is_of_model and name in IN_CAPTION:
            words.append(f"${symbol} = {number(first[name])}$")
    if all(group["obstacle_filling"] == "saturated" for group in groups):
        words.append("saturated arrays")
    if first["lattice_angle"] is not None:
        words.append("square lattice")
    words.append(style.runs_a_point(groups))
    return ", ".join(words)


def note(groups, about_bars):
    """The interface, if it is one, and what bars and markers mean."""
    presets = {group["preset"] for group in groups if group["model"] == "dp"}
    return (f"interface: {presets.pop()}; " if len(presets) == 1 else "") + about_bars


def follows(name, groups, others):
    """Is this parameter's value known once the others' are?"""
    known = {}
    return all(known.setdefault(tuple(group[o] for o in others), group[name]) == group[name] for group in groups)


def curves(groups, abscissa):
    """Groups that differ in the abscissa only, with a label that says how the curves differ."""
    varied = [
        (name, symbol) for name, symbol in CURVE_PARAMETERS if len({group[name] for group in groups}) > 1
    ]
    for name, symbol in AUTOMATIC_PARAMETERS:
        if not follows(name, groups, [abscissa, *(varying for varying, _ in varied)]):
            varied.append((name, symbol))
    # In saturated arrays the density follows from gap and diameter: it needs no place in the label.
    if all(group["obstacle_filling"] == "saturated" for group in groups):
        varied = [(name, symbol) for name, symbol in varied if name != "obstacle_density"]
    keys = sorted(
        {tuple(group[name] for name, _ in varied) for group in groups},
        key=lambda key: [math.inf if value is None else value for value in key],
    )
    for key in keys:
        members = [group for group in groups if tuple(group[name] for name, _ in varied) == key]
        label = ", ".join(f"${symbol} = {number(value)}$" for (_, symbol), value in zip(varied, key))
        yield label, members


def draw(groups, abscissa, confidence):
    figure, axes = plt.subplots(figsize=(6.4, 4.8), layout="constrained")
    all_curves = list(curves(groups, abscissa))
    for index, (label, members) in enumerate(all_curves):
        places = [group[abscissa] * style.side_by_side(index, len(all_curves)) for group in members]
        style.draw_lengths(axes, places, members, index, label)
    style.logarithmic_abscissa(axes, [group[abscissa] for group in groups])
    axes.set_yscale("log")
    axes.set_xlabel(style.AXES[abscissa])
    axes.set_ylabel(style.AXES["length"])
    style.grid(axes)
    style.legend(axes, groups)
    style.caption(axes, f"{caption(groups)}\n{note(groups, style.length_note(groups, confidence))}")
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
        fit = json.loads(content)
        return fit, [group for group in fit["groups"] if group["runs"] > 0]
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
    fit, groups = read_fit(arguments.sweep, arguments.programs)
    if not groups:
        raise UserError(f"{arguments.sweep} holds no finished runs")
    abscissa = "line_tension" if groups[0]["model"] == "dp" else "wall_stiffness"
    style.save(draw(groups, abscissa, fit["confidence"]), output)
    print(f"{output}.png (and .pdf)")
    return 0


if __name__ == "__main__":
    sys.exit(command_line.run(body))
