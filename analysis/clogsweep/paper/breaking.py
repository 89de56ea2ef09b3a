"""Draws the line tension at which droplets break up on one obstacle against the symmetry of the collision, beside the
scaling of Meer et al., Soft Matter 2026, https://doi.org/10.1039/D5SM01266J."""

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
from scipy import stats

from .. import style
from ..collisions import collision
from ..labels import interface_of
from .plate import Plate, figure
from .runner import Runner

OFFSETS = (0.01, 0.02, 0.05, 0.1, 0.15, 0.2, 0.25, 0.3)  # of the path from the obstacle's centre [sigma]
PUBLISHED_SLOPE = 4 / 3


def slope_of(symmetries: Sequence[float], tensions: Sequence[float]) -> tuple[float, float]:
    """The slope of log tension against log symmetry, and its standard error"""
    fit = stats.linregress(np.log(symmetries), np.log(tensions))
    return float(fit.slope), float(fit.stderr)


@figure("S", "largest line tension at which droplets break up on one obstacle, against the symmetry of the collision",
        [], "2 min")
def break_up_by_symmetry(runner: Runner) -> Plate:
    drawing, axes = style.subplots(figsize=(6.4, 4.8))
    folder = runner.folder / "runs"
    folder.mkdir(parents=True, exist_ok=True)
    data: list[dict[str, Any]] = []
    for index, preset in enumerate(("robust", "elastic")):
        collisions = collision.Collisions(runner.programs / "clogsweep", folder, {"preset": preset})
        found = [(offset, *collisions.threshold(offset)) for offset in OFFSETS]
        known = [(collision.symmetry(offset), math.sqrt(low * high)) for offset, low, high in found if low and high]
        slope, error = slope_of(*zip(*known))
        axes.plot(*zip(*known), **style.curve_style(index), markersize=5, linewidth=1,
                  label=rf"{interface_of(preset)}: slope ${slope:.2f}\pm{error:.2f}$")
        data += [{"preset": preset, "symmetry": symmetry, "line_tension": tension, "slope": slope, "slope_error": error}
                 for symmetry, tension in known]
    symmetries = np.geomspace(min(point["symmetry"] for point in data), 1, 20)
    highest = max(point["line_tension"] for point in data)
    axes.plot(symmetries, highest * symmetries**PUBLISHED_SLOPE, ":", color="0.4",
              label="slope 4/3 (Meer et al. 2026, droplets in a flow)")
    style.logarithmic_abscissa(axes)
    style.logarithmic_ordinate(axes)
    style.label(axes, "symmetry of the collision $S$, smaller over larger area",
                r"largest line tension $\Gamma$ [$g\rho\sigma^2$] at break-up")
    axes.legend(frameon=False, fontsize=8)
    keys = collisions.keys
    style.caption(axes, rf"post of ${collision.DIAMETER}\sigma$, terminal speed ${keys['terminal-speed']}$, "
                  rf"{keys['vertices']} vertices, necks below ${keys['break-up-neck']}\sigma$ break")
    return Plate(drawing, data)
