"""Draws P(r) of a group in clogfit's JSON: the probability that a droplet has not clogged within a distance r."""

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes

from .. import style
from ..tools.hints import Group, Numbers


def longest_way(group: Group) -> float:
    """The longest distance of any run, including runs that still moved at their end [sigma]."""
    return max([step["distance"] for step in group["survival"]] + group["censored_distances"])


def probability(group: Group, distances: Sequence[float] | Numbers) -> Numbers:
    """The estimate of P(r) at these distances."""
    steps = group["survival"]
    values = np.array([1.0] + [step["probability"] for step in steps])
    return values[np.searchsorted([step["distance"] for step in steps], distances, side="right")]


def draw(axes: Axes, group: Group, colour: str | Sequence[float], label: str, label_of_ticks: str | None = None, begin: float = 0.0) -> None:
    """Draws the estimate up to the longest distance. Each run that still moved at its end has a tick.
    @param begin  distance at which the curve begins [sigma]"""
    corners = [begin, *(step["distance"] for step in group["survival"]), longest_way(group)]
    axes.step(corners, probability(group, corners), where="post", color=colour, linewidth=1.2, label=label,
              gid=style.mark("point", [group]))
    censored = group["censored_distances"]
    if censored:
        axes.plot(censored, probability(group, censored), linestyle="none", marker="|", markersize=9, markeredgewidth=1.2, color=colour,
                  label=label_of_ticks)
