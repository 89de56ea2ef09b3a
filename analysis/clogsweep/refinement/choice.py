"""Lists the values that a search may try, and chooses those that give the most information for the work of their
runs."""

import math
from collections.abc import Sequence

import numpy as np
import pandas

from ..curves.model import Curve
from ..tools.hints import Numbers

# Preferred numbers per decade (IEC 60063). The numbers of each coarser series are a part of those of the finer series.
SERIES = (192, 96, 48, 24, 12, 6)
# Squared distance divided by the range. Points that are nearer to each other than this count as equally near.
NEARNESS = 1e-3


def preferred_values(given: Sequence[float], most: int) -> list[float]:
    """The given values, and preferred numbers of three digits between the outermost given values. The list has at most
    `most` values, or one more than were given. Because of the preferred numbers, the files of two people have values in
    common."""
    values = sorted(given)
    for per_decade in SERIES:
        first, last = (round_(per_decade * math.log10(end)) for round_, end in ((math.floor, given[0]), (math.ceil, given[-1])))
        preferred = (float(f"{10 ** (i / per_decade):.3g}") for i in range(first, last + 1))
        values = sorted({*given, *(value for value in preferred if given[0] < value < given[-1])})
        if len(values) <= max(most, len(given) + 1):
            break
    return values


def spread(values: Sequence[float], count: int) -> list[float]:
    """Chooses `count` of the values, evenly spread on a logarithmic scale, including the outermost values. The list is
    shorter if some chosen values coincide."""
    logs = np.log(values)
    nearest = [int(np.argmin(abs(logs - place))) for place in np.linspace(logs[0], logs[-1], count)]
    return [values[i] for i in dict.fromkeys(nearest)]


def expected_runs(sums: pandas.DataFrame, known: Numbers, places: Numbers, log_length: Numbers,
                  max_time: float) -> tuple[Numbers, Numbers]:
    """The expected number of clogs and the expected work of one run at each place. Speed, and work per time, are
    interpolated from the known points.

    @param sums  sums of distance, time and work over the runs at the `known` places
    @param log_length  log lambda of the fitted curve at `places`
    """
    extent = np.ptp(places, axis=0)
    apart = (((places[:, None] - known) / np.where(extent > 0, extent, 1)) ** 2).sum(axis=2)
    weight = 1 / (sums["time"].to_numpy() * (NEARNESS + apart) ** 2)
    distance, time, work = (weight @ sums[name].to_numpy() for name in ("distance", "time", "work"))
    longest = max_time * distance / time
    length = np.exp(log_length)
    clogs = -np.expm1(-longest / length)
    return clogs, np.minimum(length * clogs, longest) * work / distance


def choose_blocks(curve: Curve, clogs: Numbers, work: Numbers, weights: Numbers, most_blocks: Numbers,
                  work_of_round: float, most_work: float) -> Numbers:
    """The number of blocks of seeds for each place. Blocks are added one by one until the work of the round is used up.
    Each time, the block is chosen that reduces the weighted variance most for its work.

    Each added block reduces the variances as if its expected clogs had been observed (a rank-one update). The means do
    not change.
    @param clogs, work  expected values for one block at each place
    @param most_work  upper bound on the work of the round
    """
    covariance = curve.covariance.copy()
    blocks = np.zeros(len(most_blocks), dtype=int)
    used = 0.0
    while True:
        shares = clogs / (1 + clogs * np.maximum(np.diagonal(covariance), 0))
        gain = shares * (weights @ covariance**2) / work
        gain[(blocks >= most_blocks) | (used + work > most_work)] = 0
        best = int(np.argmax(gain))
        if not gain[best] > 0 or (used > 0 and used + work[best] > work_of_round):
            return blocks
        covariance -= shares[best] * np.outer(covariance[:, best], covariance[:, best])
        blocks[best] += 1
        used += work[best]
