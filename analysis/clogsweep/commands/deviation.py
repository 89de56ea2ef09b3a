"""Prints Delta_v and Delta_A of a measured passage through a channel from simulated ones, as JSON:
the relative root-mean-square deviations of speed and shape.

  clogfit deviation measured.csv simulated1.csv simulated2.csv

All are CSV files with the header h [sigma], v [v_t], A, or written by clogrun channel. Simulated frames are in the order
of time and interpolated to the measured h.
"""

from ..calibration import experiment, profiles
from ..calibration.deviation import deviation
from ..reading import programs
from ..tools.errors import UserError
from . import command_line


def body() -> int:
    parser = command_line.Parser(__doc__)
    parser.add_argument("profiles", nargs="*", help="CSV files or of clogrun channel, the measured one first")
    programs.add_option(parser)
    arguments = parser.parse_args()
    if len(arguments.profiles) < 2:
        raise UserError("missing profiles; try clogfit deviation measured.csv simulated.csv")
    folder = programs.programs_in(arguments.programs)
    measured_file, *simulated_files = arguments.profiles
    measured = profiles.read_trial(measured_file, folder=folder).frames
    found = []
    for file in simulated_files:
        speed, shape = deviation(measured, profiles.read_profile(file, folder=folder))
        found.append({"profile": file, "delta_v": speed, "delta_a": shape})
    experiment.print_json({**experiment.version_of(experiment.quantities({}, folder)), "measured": measured_file, "deviations": found})
    return 0
