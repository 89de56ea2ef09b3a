"""Coverage of four rules for the interval of a clogging length; takes some 10 s."""

import math
import numpy as np
from scipy.stats import chi2

engine = np.random.default_rng(1)
coverage = {"2d": [], "2d + 1": [], "2d if all clogged": [], "2d upper, 2d + 2 lower": []}
for runs in (10, 20, 50):
    with np.errstate(all="ignore"):
        high = {k: chi2.ppf(0.975, 2 * np.arange(runs + 1) + k) for k in (0, 1, 2)}
        low = {k: chi2.ppf(0.025, 2 * np.arange(runs + 1) + k) for k in (0, 1, 2)}
    for end in np.geomspace(0.1, 7, 60):
        distance = engine.exponential(size=(100_000, runs))
        clogs = (distance < end).sum(axis=1)
        way = np.minimum(distance, end).sum(axis=1)
        all_clogged = clogs == runs
        quantiles = {
            "2d": (high[0][clogs], low[0][clogs]),
            "2d + 1": (high[1][clogs], low[1][clogs]),
            "2d if all clogged": (np.where(all_clogged, high[0][clogs], high[1][clogs]),
                                  np.where(all_clogged, low[0][clogs], low[1][clogs])),
            "2d upper, 2d + 2 lower": (high[2][clogs], low[0][clogs]),
        }
        for rule, (for_lower, for_upper) in quantiles.items():
            with np.errstate(all="ignore"):
                lower = np.where(clogs == 0, way / math.log(20), 2 * way / for_lower)
                upper = np.where(clogs == 0, np.inf, 2 * way / for_upper)
            coverage[rule].append(((lower <= 1) & (1 <= upper)).mean())
for rule, values in coverage.items():
    print(f"{rule:24} {min(values):.3f} {np.mean(values):.3f} {max(values):.3f}")
