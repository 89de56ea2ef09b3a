"""Fits a smooth curve through the clogging lengths of a sweep, as a function of one or two keys that the sweep varies.
Prints values between the points, the peak, and where the curve crosses a given length, all with intervals.

    clogfit curve sweep.h5                       # is python3 -m clogsweep curve
    clogfit curve sweep.h5 --key line-tension --crossing 10,100
    clogfit curve sweep.h5 --key line-tension,friction --format csv > surface.csv
    clogfit curve monday.h5 tuesday.h5           # several files as one sweep

If the runs of a point together travelled a distance S and clogged d times, d is a Poisson variable with exposure S. So
points without a clog inform the curve, too, as lower bounds. log lambda is a Gaussian process over the logarithm of the
key. The other physical keys separate curves. A curve needs four values of the key, three of them with clogs; points in
no curve are listed with the reason. The formats csv and json contain the whole curve, at 97 values of the key (25 x 25
with two keys), and the curve of each mechanism; peaks is a CSV table of the peaks alone.

Runs of the same seed met the same obstacles at every value of a key that does not change the array. Then the errors of
the points are correlated, but the band assumes that they are independent. Different seeds at each value avoid this
correlation.
"""

import argparse
import json
import pathlib

from ..curves import answer, table
from ..reading import programs
from ..tools import rounded
from . import command_line


def crossed_lengths(word: str) -> list[float]:
    try:
        return table.lengths(word)
    except ValueError as error:
        raise argparse.ArgumentTypeError(f"invalid --crossing={word} ({error}) try 10,100") from error


def body() -> int:
    parser = command_line.Parser(__doc__)
    parser.add_argument("file", type=pathlib.Path, nargs="*", help="sweep files, fitted as one sweep")
    parser.add_argument("--key", default="", help="key of the abscissa, or two keys separated by a comma")
    parser.add_argument("--crossing", type=crossed_lengths, default=[],
                        help="print where the curve reaches these lengths [sigma; mm for droplets of several sizes]")
    parser.add_argument("--format", default="text", help="text, csv, json or peaks")
    for name, meaning in (("confidence", "confidence level of the intervals (0.95)"),
                          ("from-distance", "see clogfit --help [sigma]"),
                          ("dwell", "see clogfit --help [t0]"),
                          ("lab", "file that describes the laboratory, see clogfit units; "
                                  "its units are printed below the curve")):
        parser.add_argument(f"--{name}", help=meaning)
    programs.add_option(parser)
    arguments = parser.parse_args()
    if not arguments.file:
        parser.error("missing sweep file; try clogfit curve sweep.h5")
    if arguments.format not in ("text", "csv", "json", "peaks"):
        parser.error(f"invalid --format={arguments.format} (must be text, csv, json or peaks)")
    options = [f"--{name}={value}" for name in ("confidence", "from-distance", "dwell", "lab")
               if (value := getattr(arguments, name.replace("-", "_"))) is not None]
    keys = [name for name in arguments.key.split(",") if name]
    clogfit = programs.programs_in(arguments.programs) / "clogfit"
    found, lab = answer.of_sweep(clogfit, arguments.file, keys, *options, crossing=arguments.crossing)
    if arguments.format == "json":
        print(json.dumps(found, indent=2))
    elif arguments.format in ("csv", "peaks"):
        print((table.comma_separated if arguments.format == "csv" else table.peaks)(found), end="")
    else:
        print(table.text(found, arguments.crossing), end="")
        if lab:
            print(f"in the laboratory: sigma = {rounded.plain(lab['length_mm'])} mm, "
                  f"Gamma = 1 is {rounded.plain(lab['tension_mN_per_m_of_gamma_1'])} mN/m")
    return 0
