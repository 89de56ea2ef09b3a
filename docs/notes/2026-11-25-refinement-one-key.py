"""Work and error of grids over one key that are read with straight lines; takes 3 s."""

import numpy as np

rng, key_range, longest = np.random.default_rng(1), 2 * np.log(10), 3000.0
places = np.linspace(0, key_range, 97)


def log_length(x, peak, width):
    return 3 * np.log(10) * np.exp(-((x / key_range - peak) / width) ** 2 / 2)


def runs(length, number):
    distance = rng.exponential(length, number)
    clogged = distance < longest
    return clogged.sum(), np.minimum(distance, longest).sum(), np.where(clogged, distance + 5, longest).sum()


for num_values in (8, 12, 16):
    for until_precision in (False, True):
        for number in (4, 8, 16, 32, 64, 128):
            work = error = 0
            for _ in range(200):
                peak, width = 0.35 + 0.3 * rng.random(), 0.15 + 0.15 * rng.random()
                values = np.linspace(0, key_range, num_values)
                found = []
                for length in np.exp(log_length(values, peak, width)):
                    seeds = 4 if until_precision else number
                    sums = np.array(runs(length, seeds))
                    while until_precision and sums[0] < number:
                        more = int(np.clip(np.ceil(seeds * number / max(sums[0], 1)), seeds + 1, 2 * seeds)) - seeds
                        sums, seeds = sums + runs(length, more), seeds + more
                    found.append(np.log(sums[1] / max(sums[0], 0.5)))
                    work += sums[2] / 200
                error += ((np.interp(places, values, found) - log_length(places, peak, width)) ** 2).mean() / 200
            print(num_values, until_precision, number, round(work), round(error ** 0.5, 3))
