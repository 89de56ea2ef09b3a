"""Finds the line tension Gamma and the near-wall drag b_0/b_inf with which a simulated droplet passes a channel most
like a measured droplet, that is, with the smallest relative root-mean-square deviation Delta_v of the speeds. Each
trial is one file.

  clogfit calibrate trial1.csv trial2.csv orifice=0.7 terminal-speed=0.032
  clogfit calibrate channel.h5 orifice=0.7 terminal-speed=0.032
  clogfit calibrate trial*.csv orifice=0.4 --diameter 3.5mm --speed 7mm/s --angle 28deg
  ... --tension 10mN/m --other "1.98mm 8.5deg"

A profile is a file of clogrun channel, or a CSV file with the header h [sigma], v [v_t], A. With --diameter and --speed
the CSV file may have laboratory units, such as h [mm], v [mm/s], A. With --angle the terminal speed V_t follows from
the laboratory's quantities.

Keys of the droplet and its channel (clogrun channel --help) are given as KEY=VALUE or as options.

Errors (+-) come from the scatter of a trial's frames about the best run, as if the frames were independent. They do not
include errors of the model and its mesh, so without noise they are too small.
"""

import argparse
import math
import os
import statistics
import sys
from collections.abc import Sequence

from ..calibration import laboratory, profiles, trials
from ..calibration.profiles import Channel
from ..calibration.search import Calibration
from ..calibration.simulation import Clogrun
from ..reading import programs
from ..tools.errors import UserError
from ..tools.texts import printable
from . import command_line

QUANTITIES = {"diameter": "diameter of the undeformed droplet, e.g. 3.5mm",
              "speed": "terminal speed far from walls, e.g. 7mm/s",
              "angle": "angle of the plates to the horizontal, e.g. 28deg",
              "density": "density of the droplet (0.703g/ml)",
              "outer-density": "density of the liquid around the droplet (0.997g/ml)",
              "tension": "interfacial tension, e.g. 10mN/m, to compute Gamma_exp"}
OWN = (*QUANTITIES, "other", "format", "programs", "help", "version")
FOUND = ("line-tension", "near-wall-drag")


def options() -> command_line.Parser:
    parser = command_line.Parser(__doc__)
    parser.add_argument("profiles", nargs="*",
                        help="CSV files, or files written by clogrun channel, one per trial; and KEY=VALUE")
    for name, meaning in QUANTITIES.items():
        parser.add_argument(f"--{name}", help=meaning)
    parser.add_argument("--other", help="diameter and angle of another experiment, to which Gamma is scaled")
    command_line.add_format(parser)
    programs.add_option(parser)
    return parser


def split(words: Sequence[str]) -> tuple[list[str], list[str]]:
    """Separates the keys of clogrun channel, which may stand anywhere and may be options. @return words for the parser, keys"""
    own: list[str] = []
    keys: list[str] = []
    rest = iter(words)
    for word in rest:
        name, equals, _ = word.partition("=")
        if name.startswith("--") and name[2:] not in OWN:
            keys.append(word if equals else f"{word}={next(rest, '')}")
        elif equals and not word.startswith("-") and not os.path.exists(word):
            keys.append(word)
        else:
            own.append(word)
    return own, keys


def refuse_contradictions(arguments: argparse.Namespace, names: set[str]) -> None:
    if not arguments.profiles:
        raise UserError("missing profile; try clogfit calibrate trial.csv --orifice 0.7")
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


def refuse_other_channel(file: str, stored: Channel | None, simulated: Channel, names: set[str]) -> None:
    """Refuses keys that contradict the channel stored with a simulated passage. For a measured passage, the channel
    must be given as keys, because Gamma depends on it."""
    if stored is None and "orifice" not in names:
        raise UserError("missing orifice (the fitted line tension depends on the channel); "
                        "give its width in droplet diameters, e.g. orifice=0.8, "
                        "and wedge-angle and tip-radius if they differ from the defaults of clogrun channel")
    for name, was, given in zip(Channel._fields, stored or (), simulated):
        key = name.replace("_", "-")
        if not math.isclose(was, given, rel_tol=1e-12):
            raise UserError(f"{file} was written with {key}={was:.12g}, not {given:.12g}; give {key}={was:.12g}")


def means(found: Sequence[Calibration]) -> dict[str, float]:
    """Mean and standard deviation over independent trials, as published (Cheng et al., Fig. 2). The standard deviation
    of a single trial is NaN."""
    values = {"line_tension": [one.line_tension for one in found],
              "near_wall_drag": [one.near_wall_drag for one in found]}
    every: dict[str, float] = {}
    for name, numbers in values.items():
        every |= {name: statistics.fmean(numbers),
                  f"{name}_deviation": statistics.stdev(numbers) if len(numbers) > 1 else math.nan}
    return every


def print_table(files: Sequence[str], found: Sequence[Calibration], mean: dict[str, float]) -> None:
    width = max(7, *map(len, files))
    print(f"{'profile':{width}}    Gamma*        +-  b_0/b_inf        +-   Delta_v   Delta_A")
    for file, one in zip(files, found):
        print(f"{file:{width}}  {one.line_tension:>8.4g}  {one.line_tension_error:>8.2g}  {one.near_wall_drag:>9.4g}  "
              f"{one.near_wall_drag_error:>8.2g}"
              f"  {one.delta_v:>8.3g}  {one.delta_a:>8.3g}")
    for file, one in zip(files, found):
        for warning in one.warnings:
            print(f"note: {file}: {warning}")
    if len(found) > 1:
        print("\nmean of {} trials and their standard deviation: "
              "Gamma* = {:.3g} +- {:.2g}, b_0*/b_inf = {:.3g} +- {:.2g}".format(len(found), *mean.values()))
    else:
        print("\none trial: the errors come from the scatter of its frames")


def body() -> int:
    words, keys = split(sys.argv[1:])
    arguments = options().parse_args(words)
    names = {word.partition("=")[0].lstrip("-") for word in keys}
    refuse_contradictions(arguments, names)
    folder = programs.programs_in(arguments.programs)
    given = {name: getattr(arguments, name.replace("-", "_")) for name in QUANTITIES}
    lab, scales = laboratory.quantities(given, folder)
    in_lab = {"gravity": lab["gravity_m_per_s2"]} if arguments.angle else {}
    if arguments.tension:
        in_lab["line_tension_experiment"] = lab["line_tension_experiment"]
    if arguments.other:
        diameter, blank, angle = arguments.other.rpartition(" ")
        if not blank:
            raise UserError(f"invalid --other={arguments.other} (needs a diameter and an angle) try \"1.98mm 8.5deg\"")
        other = laboratory.quantities({**given, "diameter": diameter, "angle": angle, "speed": None}, folder)[0]
    if arguments.angle:
        keys.append(f"terminal-speed={lab['terminal_speed']}")
    clogrun = Clogrun(folder)
    simulated = clogrun.channel(keys)
    measured = []
    for file in arguments.profiles:
        frames, stored = profiles.read_trial(file, scales)
        refuse_other_channel(file, stored, simulated, names)
        measured.append(frames)
    if arguments.format == "text":
        print("channel: orifice={:.12g} wedge-angle={:.12g} tip-radius={:.12g}, V_t = {:.4g}\n".format(*simulated), flush=True)

    found = trials.calibrate(clogrun, keys, arguments.profiles, measured)
    mean = means(found)
    if arguments.other:  # Gamma is proportional to 1/(sigma^2 g)
        weight, other_weight = (answer["diameter_mm"] ** 2 * answer["gravity_m_per_s2"] for answer in (lab, other))
        in_lab["line_tension_scaled"] = mean["line_tension"] * weight / other_weight
    if arguments.format == "json":
        every = [{"profile": file, **one._asdict()} for file, one in zip(arguments.profiles, found)]
        laboratory.print_json(lab, {"trials": every, **mean, **simulated._asdict(), **in_lab})
        return 0
    print_table([printable(file) for file in arguments.profiles], found, mean)
    if arguments.angle:
        print(f"g_exp = {lab['gravity_m_per_s2']:.3g} m/s^2")
    if arguments.tension:
        in_experiment = lab["line_tension_experiment"]
        print(f"Gamma_exp = {in_experiment:.3g}, Gamma*/Gamma_exp = {mean['line_tension'] / in_experiment:.3g}")
    if arguments.other:
        print(f"Gamma** = {in_lab['line_tension_scaled']:.3g} for a droplet of {diameter} at {angle}")
    return 0
