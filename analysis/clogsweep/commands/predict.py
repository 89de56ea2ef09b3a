"""Predicts the clogging lengths of an array from droplets that fall onto one or two obstacles, without runs in the
array.

    python3 -m clogsweep predict obstacle-gap=0.3 obstacle-density=0.3 line-tension=1,3
    python3 -m clogsweep predict obstacles=posts.csv box=20 line-tension=2
    python3 -m clogsweep predict --lab lab.cfg obstacle-gap=0.6mm obstacle-density=0.05/mm^2
    python3 -m clogsweep predict preset=elastic friction=0.05 line-tension=0.05,0.07,0.1,0.5,1,3 --output curve --with sweep.h5

KEY=VALUE are keys of clogsweep. With --lab, line tension and terminal speed are those of the laboratory's droplet
unless they are given, keys of the array take units, and lengths are also in mm. For each gap and direction a droplet
falls onto a pair of obstacles. Other droplets fall onto a single obstacle at several offsets, to find the largest
offset at which the obstacle holds a wrapped droplet. These runs take half a minute for a large line tension. Then the
command counts the obstacles and pairs of the array. It prints lengths as CSV, with the reasons to doubt them: soft
(line tension below 1: clogs on three obstacles and more are not predicted), crowded (length below 4 sigma: the
prediction is too long, because other obstacles are in between). docs/reference/analysis.md says where the predictions
hold.
"""

import argparse
import math
import pathlib
import re
import sys
import tempfile
from typing import Any

from ..collisions import prediction
from ..labels import key_phrase
from ..reading import fits, programs
from ..results import laboratory
from ..tools import outputs
from ..tools.errors import UserError
from . import command_line


def parse() -> argparse.Namespace:
    parser = command_line.Parser(__doc__)
    parser.add_argument("keys", type=command_line.key_and_value, nargs="*", metavar="KEY=VALUE",
                        help="keys of clogsweep; line-tension may be a list")
    parser.add_argument("--lab", type=pathlib.Path,
                        help="file that describes the laboratory of one droplet, see clogfit units")
    command_line.add_output(parser, "name of a picture; .png and .pdf are made", ".png", ".pdf")
    parser.add_argument("--with", dest="measured", metavar="SWEEP", type=pathlib.Path,
                        help="also draw the lengths of this file of clogsweep --output")
    programs.add_option(parser)
    return parser.parse_intermixed_args()


# entries of a laboratory
OF_DROPLET = {"terminal-speed": "speed of the droplet", "line-tension": "tension of the droplet"}


def as_number(length: float) -> str:
    return f"{length:.4g}" if math.isfinite(length) else ""


def body() -> int:
    arguments = parse()
    keys = dict(arguments.keys)
    for key, reason in prediction.REFUSED.items():
        if key in keys:
            raise UserError(f"no place for {key} ({reason}); leave it out")
    for key, value in keys.items():
        if key not in ("line-tension", "obstacles") and ("," in value or ".." in value or "(" in value):
            raise UserError(f"invalid {key}={value} (only line-tension takes a list here); give one value")
        if arguments.lab and key in OF_DROPLET and re.search("[A-Za-z]", value):
            raise UserError(f"invalid {key}={value} (is without a unit here); "
                            f"write it into {arguments.lab} as the {OF_DROPLET[key]}, or give it in the model's unit")
    if arguments.measured and not arguments.output:
        raise UserError("no picture for the lengths of --with; give --output NAME")
    if arguments.output:
        outputs.refuse_unwritable_picture(arguments.output)
    folder_of_programs = programs.programs_in(arguments.programs)
    droplet: Any = {}  # a list for several droplets
    if arguments.lab:
        droplet = laboratory.units(arguments.lab, folder=folder_of_programs)
    if isinstance(droplet, list):
        raise UserError(f"no place for --lab {arguments.lab} (it describes {len(droplet)} droplets); "
                        "give one diameter and one angle")
    for key in OF_DROPLET:
        if (value := droplet.get(key.replace("-", "_"))) is not None:
            keys.setdefault(key, f"{value:.4g}")
    of_array = {key: keys[key] for key in (*prediction.OF_ARRAYS, "obstacle-diameter") if key in keys}
    of_droplet = {key: value for key, value in keys.items() if key not in of_array}
    with tempfile.TemporaryDirectory(prefix="clogsweep-predict-") as name:
        folder = pathlib.Path(name)
        array = prediction.read_array(folder_of_programs / "clogrun", folder, of_array,
                                      *command_line.lab_options(arguments))
        droplets = prediction.Droplets(folder_of_programs / "clogsweep", folder, of_droplet)
        found = list(prediction.predict(droplets, array))
    print("line_tension,clogging_length,squeezed,wrapped,doubts" + (",clogging_length_mm" if droplet else ""))
    for one in found:
        print(f"{one.tension:g}", *map(as_number, one[1:]), " ".join(prediction.doubts_of(one.tension, one.length)),
              *([as_number(one.length * droplet["diameter_mm"])] if droplet else []), sep=",")
    if without := [f"{one.tension:g}" for one in found if math.isinf(one.length)]:
        print(f"no length at line-tension={','.join(without)}: neither an obstacle nor a pair held a droplet, "
              "and clogs on three obstacles or more are not predicted", file=sys.stderr)
    if arguments.output:
        fit: dict[str, Any] = {"groups": [], "confidence": 0.95}
        if arguments.measured:
            fit = fits.run_clogfit(folder_of_programs / "clogfit", arguments.measured)
        from .. import style  # loads matplotlib, which only a picture needs
        from ..drawing import predicted

        shared = [key_phrase(key, value) for key, value in keys.items() if key != "line-tension"]
        style.Picture(predicted.draw(found, fit["groups"], fit["confidence"], shared)).save(arguments.output)
    return 0
