"""Predicts the clogging length of stiff droplets in an array from droplets that fall onto two obstacles.

    python3 -m clogsweep predict obstacle-gap=0.3 obstacle-density=0.3 line-tension=1,3
    python3 -m clogsweep predict obstacles=posts.csv box=20 line-tension=2

KEY=VALUE are keys of clogsweep. It tries pairs of obstacles of all gaps and directions, one droplet each, in some ten
seconds for a line tension; then it counts the pairs of the array that hold a droplet. Prints the clogging length as
CSV, with reasons to doubt it: soft (line tension below 1: many droplets hang on three or more obstacles; up to a fifth
off at 0.5, ten times too long at 0.3), crowded (below 4 sigma: too long, because other obstacles are in between).
docs/explanation/predicted.md has the limits.
"""

import argparse
import math
import pathlib
import tempfile

from ..collisions import prediction
from ..reading import programs
from ..tools.errors import UserError
from . import command_line


def parse() -> argparse.Namespace:
    parser = command_line.Parser(__doc__)
    parser.add_argument("keys", type=command_line.key_and_value, nargs="*", metavar="KEY=VALUE", help="of clogsweep; line-tension may be a list")
    programs.add_option(parser)
    return parser.parse_args()


def body() -> int:
    arguments = parse()
    keys = dict(arguments.keys)
    for key, reason in prediction.REFUSED.items():
        if key in keys:
            raise UserError(f"no place for {key} ({reason}); leave it out")
    for key, value in keys.items():
        if key not in ("line-tension", "obstacles") and ("," in value or ".." in value or "(" in value):
            raise UserError(f"invalid {key}={value} (only line-tension takes a list here); give one value")
    folder_of_programs = programs.programs_in(arguments.programs)
    of_array = {key: keys[key] for key in (*prediction.OF_ARRAYS, "obstacle-diameter") if key in keys}
    of_droplet = {key: value for key, value in keys.items() if key not in of_array}
    with tempfile.TemporaryDirectory(prefix="clogsweep-predict-") as name:
        folder = pathlib.Path(name)
        array = prediction.read_array(folder_of_programs / "clogrun", folder, of_array)
        pairs = prediction.Pairs(folder_of_programs / "clogsweep", folder, of_droplet)
        found = list(prediction.predict(pairs, array))
    print("line_tension,clogging_length,doubts")
    for tension, length in found:
        print(f"{tension:g}", f"{length:.4g}" if math.isfinite(length) else "", " ".join(prediction.doubts_of(tension, length)), sep=",")
    return 0
