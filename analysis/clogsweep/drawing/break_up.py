"""Break-up of droplets on a single obstacle vs the symmetry of the collision, and its probability."""

import math

from matplotlib.figure import Figure

from .. import style
from ..collisions.collision import DIAMETER, Threshold, capillary_number, symmetry


def draw(found: dict[float, Threshold]) -> Figure:
    """@param found  brackets of the largest line tension that breaks a droplet, by offset"""
    figure, (left, right) = style.subplots(1, 2, figsize=(9.6, 4.4))
    known = {offset: math.sqrt(low * high) for offset, (low, high) in found.items() if low and high}
    places = {offset: (symmetry(offset), capillary_number(tension)) for offset, tension in known.items()}
    left.plot(*zip(*places.values()), marker="o", linestyle="none", color=style.COLOURS[0], label="droplets above break up")
    off_centre = [place for offset, place in places.items() if offset > 0]
    if off_centre:
        s, ca = off_centre[len(off_centre) // 2]
        ends = min(place[0] for place in off_centre), 1
        left.plot(ends, [ca * (end / s)**(-4 / 3) for end in ends], color="0.4", linewidth=1, linestyle="--", label=r"$Ca\,S^{4/3}$ constant")
    left.set(xscale="log", yscale="log")
    left.set_xlabel("symmetry of the collision $S$")
    left.set_ylabel(r"capillary number $Ca = \pi/(4\Gamma)$")
    ordered = sorted(known, key=lambda offset: places[offset][1])
    right.plot([places[offset][1] for offset in ordered], [offset / ((1 + DIAMETER) / 2) for offset in ordered], marker="o", color=style.COLOURS[0])
    right.set(xscale="log")
    for axis in (left.xaxis, left.yaxis, right.xaxis):
        style.plain_logarithmic(axis)
    right.set_ylim(0, 1)
    right.set_xlabel(left.get_ylabel())
    right.set_ylabel("share of collisions that break the droplet up")
    left.legend(frameon=False, fontsize=8)
    for axes in (left, right):
        style.grid(axes)
    return figure
