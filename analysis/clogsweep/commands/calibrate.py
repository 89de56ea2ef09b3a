"""Finds the line tension Gamma and the near-wall drag b_0/b_inf of the simulated droplet that passes a
channel most like a measured one: those that minimise Delta_v, the relative root-mean-square deviation of the speeds.
One file per trial.

  clogfit calibrate trial1.csv trial2.csv orifice=0.7 terminal-speed=0.032
  clogfit calibrate channel.h5 orifice=0.7 terminal-speed=0.032
  clogfit calibrate trial*.csv orifice=0.4 --diameter 3.5mm --speed 7mm/s --angle 28deg
  ... --tension 10mN/m --other "1.98mm 8.5deg"

A profile is a CSV file with the header h [sigma], v [v_t], A or, with --diameter and --speed, in laboratory units such
as h [mm], v [mm/s], A; or what clogrun channel has written. With --angle the terminal speed V_t follows from the laboratory's
quantities. Keys of the droplet and its channel (clogrun channel --help) are given as KEY=VALUE or as options.

Errors (+-) come from the scatter of a trial's frames about the best run, treated as independent noise. They do not
contain errors of the model or its mesh: for frames without noise they are too small.
"""

import argparse
import math
import os
import pathlib
import sys
from collections.abc import Sequence
from typing import Any

from ..calibration import channel, experiment, profiles, trials
from ..calibration.profiles import Trial
from ..calibration.search import Calibration
from ..calibration.trials import Mean
from ..reading import programs
from ..tools.errors import UserError
from . import command_line

QUANTITIES = ("diameter", "speed", "angle", "density", "outer-density", "tension")
OWN = (*QUANTITIES, "other", "format", "programs")
FOUND = ("line-tension", "near-wall-drag")
# Options of clogrun that are no keys.
NOT_KEYS = ("output", "sample-interval", "polygon-interval", "frames", "most-frames", "dry-run", "write-obstacles", "lab", "to-rest", "system", "file", "task")


def options() -> command_line.Parser:
    parser = command_line.Parser(__doc__)
    parser.add_argument("profiles", nargs="*", help="CSV files, or files written by clogrun channel, one per trial; and KEY=VALUE")
    parser.add_argument("--diameter", help="of the undeformed droplet, e.g. 3.5mm")
    parser.add_argument("--speed", help="terminal, far from walls, e.g. 7mm/s")
    parser.add_argument("--angle", help="of the plates to the horizontal, e.g. 28deg")
    parser.add_argument("--density", default="0.703g/ml", help="of the droplet (%(default)s)")
    parser.add_argument("--outer-density", default="0.997g/ml", help="of the liquid around it (%(default)s)")
    parser.add_argument("--tension", help="interfacial, e.g. 10mN/m: for Gamma_exp")
    parser.add_argument("--other", help="another experiment's diameter and angle, to scale Gamma to")
    command_line.add_format(parser)
    programs.add_option(parser)
    return parser


def split(words: Sequence[str]) -> tuple[list[str], list[str]]:
    """@return words for the parser, and keys for clogrun channel, which may stand anywhere and also be options"""
    own: list[str] = []
    keys: list[str] = []
    rest = iter(words)
    for word in rest:
        name, equals, _ = word.partition("=")
        if not word.startswith("-"):
            (keys if equals and not os.path.exists(word) else own).append(word)
        elif name in ("-h", "--help"):
            own.append(word)
        elif name.startswith("--") and name[2:] in NOT_KEYS:
            raise UserError(f"unknown option {name}; {command_line.name()} --help lists the options")
        else:
            (own if name[2:] in OWN else keys).append(word if equals else f"{word}={next(rest, '')}")
    return own, keys


def names_of(keys: Sequence[str]) -> set[str]:
    return {word.partition("=")[0].lstrip("-") for word in keys}


def refuse_contradictions(arguments: argparse.Namespace, names: set[str]) -> None:
    for key in FOUND:
        if key in names:
            raise UserError(f"--{key} is what {command_line.name()} finds; leave it out")
    if arguments.angle and "terminal-speed" in names:
        raise UserError("--angle and terminal-speed contradict each other; give one of them")
    for option in ("tension", "other"):
        if getattr(arguments, option) and not (arguments.angle and arguments.diameter):
            raise UserError(f"--{option} needs --diameter and --angle")
    if arguments.angle and not (arguments.diameter and arguments.speed):
        raise UserError("--angle needs --diameter and --speed")


def other_experiment(text: str, liquids: dict[str, str | None], folder: pathlib.Path) -> tuple[dict[str, Any], float]:
    """The answer of clogfit units for another droplet of the same liquids, such as "1.98mm 8.5deg", and its angle in degrees."""
    diameter, blank, angle = text.rpartition(" ")
    if not blank:
        raise UserError(f"invalid --other={text} (needs a diameter and an angle) try \"1.98mm 8.5deg\"")
    try:
        tilted = experiment.quantities({**liquids, "diameter": diameter, "angle": angle}, folder)
    except UserError as error:
        raise UserError(f"invalid --other={text}: {error}") from error
    upright = experiment.quantities({**liquids, "diameter": diameter}, folder)
    return tilted, math.degrees(math.asin(min(1, tilted["gravity_m_per_s2"] / upright["gravity_m_per_s2"])))


def scaled(line_tension: float, here: dict[str, Any], there: dict[str, Any]) -> float:
    """Gamma of another experiment: it goes with 1/(sigma^2 g)."""
    def weight(answer: dict[str, Any]) -> float:
        return answer["diameter_mm"] ** 2 * answer["gravity_m_per_s2"]

    return line_tension * weight(here) / weight(there)


def require_orifice(measured: Sequence[Trial], names: set[str]) -> None:
    """Gamma hangs on the orifice; a file of clogrun says which it was."""
    if any(trial.channel is None for trial in measured) and "orifice" not in names:
        raise UserError("missing orifice (the line tension that is found depends on the channel) give its width in droplet diameters, "
                        "e.g. orifice=0.8, and wedge-angle, tip-radius unless they are those of --help")


def print_table(files: Sequence[str], found: Sequence[Calibration], mean: Mean) -> None:
    width = max(7, *map(len, files))
    print(f"{'profile':{width}}    Gamma*        +-  b_0/b_inf        +-   Delta_v   Delta_A")
    for file, one in zip(files, found):
        print(f"{file:{width}}  {one.line_tension:>8.4g}  {one.line_tension_error:>8.2g}  {one.near_wall_drag:>9.4g}  {one.near_wall_drag_error:>8.2g}"
              f"  {one.deviation.speed:>8.3g}  {one.deviation.shape:>8.3g}")
    for file, one in zip(files, found):
        for warning in trials.warnings(one):
            print(f"note: {file}: {warning}")
    if len(found) > 1:
        print(f"\nmean of {len(found)} trials and their standard deviation: Gamma* = {mean.line_tension:.3g} +- {mean.line_tension_deviation:.2g}, "
              f"b_0*/b_inf = {mean.near_wall_drag:.3g} +- {mean.near_wall_drag_deviation:.2g}")
    else:
        print("\none trial: errors are from the scatter of its frames")


def as_json(file: str, found: Calibration) -> dict[str, Any]:
    return {"profile": file, "line_tension": found.line_tension, "line_tension_error": found.line_tension_error,
            "near_wall_drag": found.near_wall_drag, "near_wall_drag_error": found.near_wall_drag_error,
            "delta_v": found.deviation.speed, "delta_a": found.deviation.shape,
            "speed_correlation": found.correlation.speed, "shape_correlation": found.correlation.shape,
            "converged": found.is_converged, "clogging_tension": found.clogging_tension, "simulations": found.num_simulations,
            "warnings": trials.warnings(found)}


def body() -> int:
    words, keys = split(sys.argv[1:])
    arguments = options().parse_args(words)
    if not arguments.profiles:
        raise UserError("missing profile; try clogfit calibrate trial.csv --orifice 0.7")
    names = names_of(keys)
    refuse_contradictions(arguments, names)
    folder = programs.programs_in(arguments.programs)
    given = {name: getattr(arguments, name.replace("-", "_")) for name in QUANTITIES}
    lab = experiment.quantities(given, folder)
    liquids = {name: given[name] for name in ("density", "outer-density")}
    other = other_experiment(arguments.other, liquids, folder) if arguments.other else None
    if arguments.angle:
        keys.append(f"terminal-speed={lab['terminal_speed']!r}")
    simulated = channel.channel_of(channel.config_of(folder, keys))
    scales = experiment.scales(given, lab)
    measured = [profiles.read_trial(file, scales, folder) for file in arguments.profiles]
    for trial in measured:
        trials.refuse_other_channel(trial, simulated)
    require_orifice(measured, names)
    if arguments.format == "text":
        print(f"channel: orifice={simulated.orifice:.12g} wedge-angle={simulated.wedge_angle:.12g} tip-radius={simulated.tip_radius:.12g}, "
              f"V_t = {simulated.terminal_speed:.4g}\n", flush=True)

    found = trials.calibrate(folder, keys, measured)
    mean = trials.combine(found)
    in_lab: dict[str, float] = {}
    if arguments.angle:
        in_lab["gravity"] = lab["gravity_m_per_s2"]
    if arguments.tension:
        in_lab["line_tension_experiment"] = lab["line_tension_experiment"]
    if other:
        in_lab["line_tension_scaled"] = scaled(mean.line_tension, lab, other[0])
    if arguments.format == "json":
        every = [as_json(file, one) for file, one in zip(arguments.profiles, found)]
        experiment.print_json({**experiment.version_of(lab), "trials": every, **mean._asdict(), **simulated._asdict(), **in_lab})
        return 0
    print_table(arguments.profiles, found, mean)
    if arguments.angle:
        print(f"g_exp = {in_lab['gravity']:.3g} m/s^2")
    if arguments.tension:
        in_experiment = in_lab["line_tension_experiment"]
        print(f"Gamma_exp = {in_experiment:.3g}, Gamma*/Gamma_exp = {mean.line_tension / in_experiment:.3g}")
    if other:
        print(f"Gamma** = {in_lab['line_tension_scaled']:.3g} for a droplet of {other[0]['diameter_mm']:.3g} mm at {other[1]:.3g} degrees")
    return 0
