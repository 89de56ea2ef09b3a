"""Work of grids over two keys that are read with straight lines, divided by that of refined sweeps."""

import numpy as np
from scipy.interpolate import RegularGridInterpolator

rng, longest, repetitions = np.random.default_rng(1), 3000.0, 200
fine = np.meshgrid(np.linspace(0, 1, 49), np.linspace(0, 1, 49), indexing="ij")
refined = np.log([(5333, 0.632), (14244, 0.228), (32722, 0.159), (75606, 0.110), (172458, 0.076)])  # work, error


def log_length(x, second, peak, width):
    return (3 - second) * np.log(10) * np.exp(-(((x - peak - 0.15 * second) / width) ** 2) / 2)


def runs(length, number):
    distance = rng.exponential(length, (number, len(length)))
    clogged = distance < longest
    times = np.where(clogged, distance + 5, longest)
    return np.array([clogged.sum(0), np.minimum(distance, longest).sum(0), times.sum(0)])


for num_values in (6, 8, 12, 16):
    for until_precision in (False, True):
        found = []
        for number in (4, 8, 16, 32, 64, 128):
            work = error = 0
            for _ in range(repetitions):
                peak, width = 0.35 + 0.3 * rng.random(), 0.15 + 0.15 * rng.random()
                values = np.linspace(0, 1, num_values)
                length = np.exp(log_length(*np.meshgrid(values, values, indexing="ij"), peak, width)).ravel()
                seeds = np.full(len(length), 4 if until_precision else number)
                sums = runs(length, seeds[0])
                while until_precision and (lacking := np.flatnonzero(sums[0] < number)).size:
                    for i in lacking:
                        estimate = np.ceil(seeds[i] * number / max(sums[0, i], 1))
                        more = int(np.clip(estimate, seeds[i] + 1, 2 * seeds[i])) - seeds[i]
                        sums[:, i] += runs(length[i:i + 1], more)[:, 0]
                        seeds[i] += more
                logs = np.log(sums[1] / np.maximum(sums[0], 0.5)).reshape(num_values, num_values)
                curve = RegularGridInterpolator((values, values), logs)(np.stack(fine, -1))
                error += ((curve - log_length(*fine, peak, width)) ** 2).mean() / repetitions
                work += sums[2].sum() / repetitions
            found.append((np.log(work), np.log(error) / 2))
        works, errors = np.array(found).T
        for wanted in np.log((0.25, 0.20, 0.15, 0.12, 0.10)):
            is_reached = errors.min() <= wanted <= errors.max()
            theirs = np.interp(-wanted, -errors, works) if is_reached else np.nan
            print(num_values, until_precision, np.exp(wanted).round(2),
                  np.exp(theirs - np.interp(-wanted, -refined[:, 1], refined[:, 0])).round(1))
