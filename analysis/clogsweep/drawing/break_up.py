"""Which droplets break up on a single obstacle, against the symmetry of the collision, and how many."""

import math
from collections.abc import Sequence

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from .. import style
from ..collisions.collision import DIAMETER, Threshold, capillary_number, symmetry

CAPILLARY_TICKS = [2, 3, 5, 10, 20, 50, 100]


def logarithmic(axes: Axes, which: str, ticks: Sequence[float]) -> None:
    """One of the axes, with plain numbers where they fall within what is drawn."""
    axes.set(**{f"{which}scale": "log"})
    axis, (low, high) = getattr(axes, f"{which}axis"), getattr(axes, f"get_{which}lim")()
    axis.set_ticks([tick for tick in ticks if low <= tick <= high])
    axis.set_major_formatter("{x:g}")
    axis.set_ticks([], minor=True)


def draw(found: dict[float, Threshold]) -> Figure:
    """@param found  thresholds by offset"""
    figure, (left, right) = style.subplots(1, 2, figsize=(9.6, 4.4))
    known = {offset: math.sqrt(low * high) for offset, (low, high) in found.items() if low and high}
    places = {offset: (symmetry(offset), capillary_number(tension)) for offset, tension in known.items()}
    left.plot(*zip(*places.values()), marker="o", linestyle="none", color=style.COLOURS[0], label="droplets above break up")
    off_centre = [place for offset, place in places.items() if offset > 0]
    if off_centre:
        s, ca = off_centre[len(off_centre) // 2]
        ends = min(place[0] for place in off_centre), 1
        left.plot(ends, [ca * (end / s)**(-4 / 3) for end in ends], color="0.4", linewidth=1, linestyle="--", label=r"$Ca\,S^{4/3}$ constant")
    logarithmic(left, "x", [0.1, 0.2, 0.3, 0.5, 0.7, 1])
    logarithmic(left, "y", CAPILLARY_TICKS)
    left.set_xlabel("symmetry of the collision $S$")
    left.set_ylabel(r"capillary number $Ca = \pi/(4\Gamma)$")
    ordered = sorted(known, key=lambda offset: places[offset][1])
    right.plot([places[offset][1] for offset in ordered], [offset / ((1 + DIAMETER) / 2) for offset in ordered], marker="o", color=style.COLOURS[0])
    logarithmic(right, "x", CAPILLARY_TICKS)
    right.set_ylim(0, 1)
    right.set_xlabel(left.get_ylabel())
    right.set_ylabel("share of collisions that break the droplet up")
    left.legend(frameon=False, fontsize=8)
    for axes in (left, right):
        style.grid(axes)
    return figure
