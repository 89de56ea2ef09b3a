"""Compares a measured passage through a channel with simulated passages. Prints Delta_v and Delta_A, the relative
root-mean-square deviations of speed and shape, as JSON.

  clogfit deviation measured.csv simulated1.csv simulated2.csv
  clogfit deviation measured.csv channel.h5 --diameter 3.3mm --speed 1.1mm/s

Each file is a CSV file with the header h [sigma], v [v_t], A, or was written by clogrun channel. With --diameter and
--speed the CSV files may have laboratory units, such as h [mm], v [mm/s], A. Simulated frames must be in the order of
time; they are interpolated to the measured h. The simulation must start upstream of all measured frames.
"""

from ..calibration import deviation, laboratory, profiles
from ..reading import programs
from ..tools.errors import UserError
from . import command_line


def body() -> int:
    parser = command_line.Parser(__doc__)
    parser.add_argument("profiles", nargs="*",
                        help="CSV files or files of clogrun channel, with the measured passage first")
    parser.add_argument("--diameter", help="diameter of the undeformed droplet, e.g. 3.3mm")
    parser.add_argument("--speed", help="terminal speed far from walls, e.g. 1.1mm/s")
    programs.add_option(parser)
    arguments = parser.parse_args()
    if len(arguments.profiles) < 2:
        raise UserError("missing profiles; try clogfit deviation measured.csv simulated.csv")
    answer, scales = laboratory.quantities({"diameter": arguments.diameter, "speed": arguments.speed},
                                           programs.programs_in(arguments.programs))
    measured_file, *files = arguments.profiles
    measured = profiles.read_trial(measured_file, scales)[0]
    laboratory.print_json(answer, {"measured": measured_file,
                                   "deviations": [deviations(measured, file, scales) for file in files]})
    return 0


def deviations(measured: profiles.Profile, file: str, scales: profiles.ReducedUnits) -> dict[str, str | float]:
    """@throws UserError  that names the file if measured frames are upstream of its start"""
    simulated = profiles.read_profile(file, scales)[0]
    try:
        speeds, _ = deviation.speed_residuals(measured, simulated)
    except UserError as error:
        raise UserError(f"{file}: {error}") from error
    return {"profile": file, "delta_v": deviation.root_mean_square(speeds),
            "delta_a": deviation.root_mean_square(deviation.shape_residuals(measured, simulated))}
