"""Compares a measured passage through a channel with simulated passages. Prints Delta_v and Delta_A, the relative
root-mean-square deviations of speed and shape, as JSON.

  clogfit deviation measured.csv simulated1.csv simulated2.csv

Each file is a CSV file with the header h [sigma], v [v_t], A, or was written by clogrun channel. Simulated frames must
be in the order of time; they are interpolated to the measured h.
"""

from ..calibration import deviation, laboratory, profiles
from ..reading import programs
from ..tools.errors import UserError
from . import command_line


def body() -> int:
    parser = command_line.Parser(__doc__)
    parser.add_argument("profiles", nargs="*", help="CSV files or files of clogrun channel, with the measured passage first")
    programs.add_option(parser)
    arguments = parser.parse_args()
    if len(arguments.profiles) < 2:
        raise UserError("missing profiles; try clogfit deviation measured.csv simulated.csv")
    answer, _ = laboratory.quantities({}, programs.programs_in(arguments.programs))
    measured_file, *files = arguments.profiles
    measured = profiles.read_trial(measured_file)[0]
    every = [profiles.read_profile(file)[0] for file in files]
    laboratory.print_json(answer, {"measured": measured_file, "deviations": [
        {"profile": file, "delta_v": deviation.root_mean_square(deviation.speed_residuals(measured, simulated)[0]),
         "delta_a": deviation.root_mean_square(deviation.shape_residuals(measured, simulated))} for file, simulated in zip(files, every)]})
    return 0
