"""Finds the exponent alpha and the strength b_0/b_inf of the near-wall drag from the speeds of a droplet that moves
along a wall. The command fits a straight line to log(v/(v_t - v)) against log d by least squares.

  clogfit drag speeds.csv
  clogfit drag speeds.csv --diameter 0.98mm --speed 0.65mm/s

The CSV file has the header d [sigma], v [v_t] or, with --diameter and --speed, laboratory units such as d [mm], v [mm/s];
d is the distance between wall and droplet surface.
"""

import math

import numpy as np
from scipy import stats

from ..calibration import laboratory, profiles
from ..reading import programs
from ..tools.errors import UserError
from ..tools.hints import Numbers
from . import command_line


def fit(distances: Numbers, speeds: Numbers) -> dict[str, float | None]:
    """v/(v_t - v) = (b_inf/b_0) (d/sigma)^alpha (Cheng et al., Appendix A); two speeds leave no errors (None).

    @param distances  between wall and droplet surface [sigma]; @param speeds  far from walls 1 [v_t]
    @throws UserError  for numbers that have no such logarithm, or fewer than two different distances
    """
    if not np.all(distances > 0):
        raise UserError("a distance from the wall is not positive")
    if not np.all((speeds > 0) & (speeds < 1)):
        raise UserError("a speed does not lie between 0 and v_t")
    if len(np.unique(distances)) < 2:
        raise UserError("needs speeds at two different distances at least")
    line = stats.linregress(np.log(distances), np.log(speeds / (1 - speeds)))
    drag = math.exp(-line.intercept)
    errors = (float(line.stderr), float(drag * line.intercept_stderr)) if len(speeds) > 2 else (None, None)
    return {"near_wall_exponent": float(line.slope), "near_wall_exponent_error": errors[0],
            "near_wall_drag": drag, "near_wall_drag_error": errors[1]}


def with_error(value: float | None, error: float | None) -> str:
    return f"{value:.4g}" if error is None else f"{value:.4g} +- {error:.2g}"


def body() -> int:
    parser = command_line.Parser(__doc__)
    parser.add_argument("file", nargs="?", help="CSV file with speeds along a wall")
    parser.add_argument("--diameter", help="diameter of the undeformed droplet, e.g. 0.98mm")
    parser.add_argument("--speed", help="terminal speed far from walls, e.g. 0.65mm/s")
    command_line.add_format(parser)
    programs.add_option(parser)
    arguments = parser.parse_args()
    if not arguments.file:
        raise UserError("missing file; try clogfit drag speeds.csv")
    answer, scales = laboratory.quantities({"diameter": arguments.diameter, "speed": arguments.speed},
                                           programs.programs_in(arguments.programs))
    distances, speeds, _ = profiles.read_table(arguments.file, "d", scales)
    try:
        found = fit(distances, speeds)
    except UserError as error:
        raise UserError(f"{arguments.file} cannot be fitted ({error})") from error
    if arguments.format == "text":
        exponent, drag = (with_error(found[name], found[f"{name}_error"])
                          for name in ("near_wall_exponent", "near_wall_drag"))
        print(f"alpha = {exponent}, b_0/b_inf = {drag}, "
              f"from {len(speeds)} speeds{', which are too few for errors' if len(speeds) < 3 else ''}")
    else:
        laboratory.print_json(answer, {**found, "speeds": len(speeds)})
    return 0
