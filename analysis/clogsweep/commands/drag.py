"""Finds the exponent alpha and the strength b_0/b_inf of the near-wall drag from the speeds of a droplet
that moves along a wall: a straight line through log(v/(v_t - v)) against log d, by least squares.

  clogfit drag speeds.csv
  clogfit drag speeds.csv --diameter 0.98mm --speed 0.65mm/s

The CSV file has the header d [sigma], v [v_t] or, with --diameter and --speed, laboratory units such as d [mm], v [mm/s];
d is the distance between wall and droplet surface.
"""

from ..calibration import drag, experiment, profiles
from ..reading import programs
from ..tools.errors import UserError
from . import command_line


def body() -> int:
    parser = command_line.Parser(__doc__)
    parser.add_argument("file", nargs="?", help="CSV file")
    parser.add_argument("--diameter", help="of the undeformed droplet, e.g. 0.98mm")
    parser.add_argument("--speed", help="terminal, far from walls, e.g. 0.65mm/s")
    command_line.add_format(parser)
    programs.add_option(parser)
    arguments = parser.parse_args()
    if not arguments.file:
        raise UserError("missing file; try clogfit drag speeds.csv")
    folder = programs.programs_in(arguments.programs)
    given = {"diameter": arguments.diameter, "speed": arguments.speed}
    answer = experiment.quantities(given, folder)
    distances, speeds, _ = profiles.read_csv(arguments.file, "d", experiment.scales(given, answer), folder)
    try:
        fit = drag.fit(distances, speeds)
    except ValueError as error:
        raise UserError(f"{arguments.file} cannot be fitted ({error})") from error
    if arguments.format == "text":
        print(f"alpha = {fit.exponent:.4g} +- {fit.exponent_error:.2g}, b_0/b_inf = {fit.drag:.4g} +- {fit.drag_error:.2g}, from {len(speeds)} speeds")
    else:
        experiment.print_json({
            **experiment.version_of(answer), "near_wall_exponent": fit.exponent, "near_wall_exponent_error": fit.exponent_error,
            "near_wall_drag": fit.drag, "near_wall_drag_error": fit.drag_error, "speeds": len(speeds)})
    return 0
