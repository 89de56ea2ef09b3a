"""Finds and draws the largest line tension at which droplets break up on a single obstacle, for each offset of their
path from its centre.

    python3 -m clogsweep collision --output collision                     # collision.png, collision.pdf; the numbers as CSV
    python3 -m clogsweep collision --output fine vertices=512 break-up-neck=0.05 --offsets 0,0.1,0.3

For each offset, droplets of several line tensions fall onto a circle of diameter 0.3 sigma. Repeated sweeps bracket the
largest line tension at which droplets break up. KEY=VALUE are keys of clogsweep for all of these sweeps. In the CSV, the
line along the flow through the obstacle's centre divides the droplet into two parts; the symmetry S of a collision is
the area of the smaller part divided by that of the larger part. The capillary number Ca is weight divided by tension,
pi/(4 Gamma). The upper axis of the picture is the fraction of collisions that break a droplet of the curve's line
tension, if all offsets with contact are equally likely.
"""

import argparse
import math
import pathlib
import tempfile

from ..collisions import collision
from ..drawing import break_up
from ..labels import key_phrase
from ..reading import programs
from ..style import Picture
from ..tools import outputs
from ..tools.errors import UserError
from . import command_line


def offsets(word: str) -> list[float]:
    """Type of an option: offsets from the obstacle's centre at which the droplet touches it [sigma]."""
    try:
        numbers = [float(part) for part in word.split(",")]
    except ValueError:
        numbers = [math.nan]
    if not all(0 <= number < 0.5 for number in numbers):
        raise argparse.ArgumentTypeError(f"invalid value: {word} (must be numbers from 0 to below 0.5 with commas "
                                         "between them) try 0,0.1,0.3")
    return numbers


def parse() -> argparse.Namespace:
    parser = command_line.Parser(__doc__)
    parser.add_argument("keys", type=command_line.key_and_value, nargs="*", metavar="KEY=VALUE",
                        help="keys of clogsweep; vertices, terminal-speed, break-up-neck, max-time have other "
                        "defaults here")
    command_line.add_output(parser, "name of the picture; .png and .pdf are made", ".png", ".pdf", required=True)
    parser.add_argument("--offsets", type=offsets, default="0,0.01,0.02,0.05,0.1,0.15,0.2,0.25,0.3,0.35",
                        help="offsets of the droplet's path from the obstacle's centre [sigma]")
    programs.add_option(parser)
    return parser.parse_args()


def body() -> int:
    arguments = parse()
    outputs.refuse_unwritable_picture(arguments.output)
    found: dict[float, collision.Threshold] = {}
    print("offset,symmetry,breaks_up_to,whole_from,capillary_number")
    with tempfile.TemporaryDirectory(prefix="clogsweep-collision-") as folder:
        collisions = collision.Collisions(programs.programs_in(arguments.programs) / "clogsweep",
                                          pathlib.Path(folder), dict(arguments.keys))
        for offset in arguments.offsets:
            low, high = found[offset] = collisions.threshold(offset)
            middle = f"{collision.capillary_number(math.sqrt(low * high)):.4g}" if low and high else ""
            print(offset, f"{collision.symmetry(offset):.4f}", *(f"{end:.4g}" if end else "" for end in (low, high)),
                  middle, sep=",", flush=True)
    if not any(low and high for low, high in found.values()):
        raise UserError(f"nothing to draw (no offset has a threshold between line tensions of {collision.TENSIONS[0]} "
                        f"and {collision.TENSIONS[1]}); try smaller --offsets")
    shared = ", ".join(key_phrase(*item) for item in collisions.keys.items())
    Picture(break_up.draw(found, shared)).save(arguments.output)
    return 0
