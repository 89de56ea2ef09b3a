"""Values that a search may try, and the choice of those that tell most for their work."""

import itertools
import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ..curves.model import Curve
from ..tools.hints import Numbers

SERIES = (192, 96, 48, 24, 12, 6)  # preferred numbers per decade; the coarser series are parts of the finer ones
MOST_VALUES = {1: 100, 2: 13}  # of each key, by the number of keys
FIRST_VALUES = {1: 7, 2: 4}
SHARE_OF_ROUND = 0.5  # work of a round, divided by that of all earlier rounds
NEARNESS = 1e-3  # squared share of the range: points that are nearer count alike


class Sums(NamedTuple):
    """Sums over the runs at each place that is known, one entry per place."""

    places: Numbers  # logarithms of the keys, shape (places, keys)
    clogs: Numbers
    distance: Numbers  # [sigma]
    time: Numbers  # [t0]
    work: Numbers  # steps times points of the droplet's outline


def number_text(value: float) -> str:
    """The shortest text that means this number."""
    return repr(float(value)).removesuffix(".0")


def preferred_values(given: Sequence[float], most: int) -> list[float]:
    """Preferred numbers of three figures between the outermost values, and the values given: no more than `most`,
    or one more than are given. Files of two people thus meet in the same values."""
    values = sorted(given)
    for per_decade in SERIES:
        first = math.floor(per_decade * math.log10(given[0]))
        last = math.ceil(per_decade * math.log10(given[-1]))
        preferred = {float(f"{10 ** (i / per_decade):.3g}") for i in range(first, last + 1)}
        values = sorted({*given, *(value for value in preferred if given[0] < value < given[-1])})
        if len(values) <= max(most, len(given) + 1):
            break
    return values


def spread(values: Sequence[float], count: int) -> list[float]:
    """`count` of the values, evenly on a logarithmic scale, including the outermost; fewer if they coincide."""
    logs = np.log(values)
    nearest = [int(np.argmin(abs(logs - place))) for place in np.linspace(logs[0], logs[-1], count)]
    return [values[i] for i in dict.fromkeys(nearest)]


def combinations(lists: Sequence[Sequence[float]]) -> list[tuple[float, ...]]:
    """All combinations of the keys' values; the first key varies fastest."""
    return [tuple(reversed(values)) for values in itertools.product(*reversed(lists))]


def expected_runs(points: Sums, places: Numbers, log_length: Numbers, max_time: float) -> tuple[Numbers, Numbers]:
    """Clogs and work to be expected of one run at each place. Speed and work per time are those of points nearby."""
    extent = np.ptp(places, axis=0)
    scale = np.where(extent > 0, extent, 1.0)
    apart = (((places[:, None, :] - points.places[None, :, :]) / scale) ** 2).sum(axis=2)
    weight = 1 / (points.time * (NEARNESS + apart) ** 2)
    distance, time, work = weight @ points.distance, weight @ points.time, weight @ points.work
    longest = max_time * distance / time
    length = np.exp(log_length)
    clogs = -np.expm1(-longest / length)
    return clogs, np.minimum(length * clogs, longest) * work / distance


def choose_blocks(curve: Curve, clogs: Numbers, work: Numbers, weights: Numbers, blocks_left: Sequence[int],
                  block: int, work_of_round: float, most_work: float) -> list[int]:
    """How many blocks of seeds each place gets: again and again the place whose block reduces the weighted variance
    most for its work, until the round has its work.

    The variances fall as if the expected clogs had been seen (rank-one updates); the means stay.
    @param clogs, work  to be expected of one run at each place; @param most_work  that is never exceeded
    """
    covariance = curve.covariance.copy()
    blocks = np.zeros(len(blocks_left), dtype=int)
    left = np.asarray(blocks_left)
    cost, seen = block * work, block * clogs
    used = 0.0
    while True:
        shares = seen / (1 + seen * np.maximum(np.diag(covariance), 0))
        gain = shares * (weights @ covariance**2) / cost
        gain[(blocks >= left) | (used + cost > most_work)] = 0
        best = int(np.argmax(gain))
        if not gain[best] > 0 or (used > 0 and used + cost[best] > work_of_round):
            return blocks.tolist()
        covariance -= shares[best] * np.outer(covariance[:, best], covariance[:, best])
        blocks[best] += 1
        used += cost[best]
