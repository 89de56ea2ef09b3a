"""Measures break-up on one post, and compares the families of sweeps.

    python3 docs/notes/2026-11-30-families.py PROGRAMS post             half-widths b within which one post breaks
    python3 docs/notes/2026-11-30-families.py PROGRAMS symmetry         areas of the daughters, and the slope 4/3
    python3 docs/notes/2026-11-30-families.py PROGRAMS sweep SWEEP.h5   area, meshes and necks of jobs/figures/families
"""

import math
import pathlib
import subprocess
import sys
import tempfile

import numpy as np
import pandas
from clogsweep.collisions import collision
from clogsweep.paper.breaking import OFFSETS, slope_of
from clogsweep.reading import stored

NECK = 0.05  # of the sweeps of arrays [sigma]
EXIT = 17  # x at which a droplet has passed the post, whose x is 13 [sigma]
PRECISION = 0.0005  # of half-widths [sigma]
PARTS = (1, 0.75, 0.5, 0.25)  # of the largest line tension at which a droplet breaks up
RESAMPLES = 10000


def half_width(collisions, tension):
    """Largest offset at which a droplet breaks up. A coarse scan shows that there is only one border."""
    scan = [round(0.02 * step, 2) for step in range(31)]
    broken = [collisions.break_up(offset, [tension])[0] for offset in scan]
    first_whole = broken.index(False)
    if any(broken[first_whole:]):
        raise SystemExit(f"Gamma={tension:g}: droplets break up at the offsets "
                         f"{[offset for offset, breaks in zip(scan, broken) if breaks]}")
    low, high = scan[first_whole - 1], scan[first_whole]
    while high - low > PRECISION:
        middle = (low + high) / 2
        low, high = (middle, high) if collisions.break_up(middle, [tension])[0] else (low, middle)
    return (low + high) / 2


def post(programs, folder):
    for tension in (0.03, 0.05):
        for vertices in (128, 256):
            collisions = collision.Collisions(programs / "clogsweep", folder, {
                "break-up-neck": f"{NECK}", "vertices": f"{vertices}", "exit": f"{EXIT}", "max-time": "3000"})
            width = half_width(collisions, tension)
            print(f"{tension:g},{vertices},{width:.4f}," +
                  ",".join(f"{1 / (2 * width * density):.2f}" for density in (0.05, 0.02)), flush=True)


def ratio_of_daughters(collisions, offset, tension):
    """Smaller over larger area of the two daughters of a break-up on one post."""
    circles, sweep = collisions.folder / "circle.csv", collisions.folder / "family.h5"
    circles.write_text(f"x,y,diameter\n{collision.BOX / 2 + collision.FALL},{collision.BOX / 2 + offset},"
                       f"{collision.DIAMETER}\n", encoding="utf-8")
    keys = collisions.keys | {"break-up": "daughters", "line-tension": f"{tension:.6g}", "smallest-daughter": "0.7"}
    subprocess.run([collisions.clogsweep, f"obstacles={circles}", f"box={collision.BOX}", "seeds=1",
                    *(f"{key}={value}" for key, value in keys.items()), "--output", sweep, "--quiet"], check=True)
    droplets = pandas.read_hdf(sweep, "droplets").set_index("path")
    sweep.unlink()
    areas = sorted(droplets.diameter.get(path, math.nan)**2 for path in "01")
    return areas[0] / areas[1]


def symmetry(programs, folder):
    """At each offset: the largest line tension at which the droplet breaks up, and the ratio of its daughters' areas at
    this tension, and at smaller ones."""
    collisions = collision.Collisions(programs / "clogsweep", folder, {})
    found = []
    print("offset,S,line_tension," + ",".join(f"ratio_at_{part:g}" for part in PARTS), flush=True)
    for offset in OFFSETS:
        low, high = collisions.threshold(offset)
        if not (low and high):
            print(f"# offset {offset:g}: no border in the range of line tensions", flush=True)
            continue
        found.append([collision.symmetry(offset), math.sqrt(low * high),
                      *(ratio_of_daughters(collisions, offset, part * low) for part in PARTS)])
        print(f"{offset:g},{found[-1][0]:.4f},{found[-1][1]:.5f}," +
              ",".join(f"{ratio:.4f}" for ratio in found[-1][2:]), flush=True)
    shapes, tensions, *ratios = zip(*found)
    for name, values in [("S", shapes), *((f"ratio_at_{part:g}", ratio) for part, ratio in zip(PARTS, ratios))]:
        slope, error = slope_of(values, tensions)
        print(f"# slope against {name}: {slope:.3f} +- {error:.3f}", flush=True)


def first_ratio(family):
    areas = sorted(family[family.path.isin(["0", "1"])].diameter**2)
    return areas[0] / areas[1] if len(areas) == 2 else math.nan


def at_outlet(family, distance):
    """Diameters of the droplets that first cross a line, each line of descent once, as clogfit counts them."""
    crossing = family[family[["birth_distance", "end_distance"]].max(axis=1) >= distance]
    paths = set(crossing.path)
    return [member.diameter for member in crossing.itertuples()
            if not any(member.path[:length] in paths for length in range(len(member.path)))]


def largest_difference(first, second):
    """The largest difference between two cumulative numbers of droplets per ancestor and diameter."""
    diameters = np.sort(np.concatenate([*first, *second]))
    counts = [np.searchsorted(np.sort(np.concatenate(group)), diameters, "right") / len(group)
              for group in (first, second)]
    return float(np.abs(counts[0] - counts[1]).max())


def p_value(first, second, chance):
    """Test that families of two groups, paired by seed, have the same distribution of diameters: exchanging the
    families of random seeds gives the distribution of the largest difference."""
    seen = largest_difference(first, second)
    larger = 0
    for _ in range(RESAMPLES):
        swapped = chance.random(len(first)) < 0.5
        pairs = [(b, a) if swap else (a, b) for a, b, swap in zip(first, second, swapped)]
        larger += largest_difference(*zip(*pairs)) >= seen - 1e-12
    return seen, (larger + 1) / (RESAMPLES + 1)


def interval(values, statistic, chance):
    """95 % interval from resampled ancestors."""
    drawn = [statistic([values[i] for i in chance.integers(len(values), size=len(values))]) for _ in range(2000)]
    return np.quantile(drawn, [0.025, 0.975])


def mean_diameter(families):
    every = np.concatenate(families)
    return float(every.mean()) if len(every) else math.nan


def mean_number(families):
    return float(np.mean([len(family) for family in families]))


def compare(name, first, second, chance):
    """Two groups of families, paired by seed."""
    gap, probability = p_value(first, second, chance)
    pairs = list(zip(first, second))
    said = []
    for statistic in (mean_number, mean_diameter):
        def ratio(drawn, statistic=statistic):
            return statistic([b for _, b in drawn]) / statistic([a for a, _ in drawn])

        said.append(f"{ratio(pairs):.3f} ({', '.join(f'{end:.3f}' for end in interval(pairs, ratio, chance))})")
    print(f"{name}: largest difference {gap:.2f}, p = {probability:.4f}; ratio of numbers {said[0]}, "
          f"of mean diameters {said[1]}", flush=True)


def sweep(path, outlet=50.0):
    rows = stored.read_table(path).set_index("task")
    droplets = pandas.read_hdf(path, "droplets")
    chance = np.random.default_rng(1)
    leaves = droplets[droplets.status != "broken"]
    areas = (leaves.diameter**2).groupby(leaves.task).sum()
    print(f"{len(rows)} families, {rows.processor_seconds.sum() / 3600:.2f} core-hours, {len(droplets)} droplets; "
          f"sum of areas within {np.abs(areas - 1).max():.1e} of 1")
    print(f"ends of droplets: {droplets.status.value_counts().to_dict()}; "
          f"of ancestors: {rows.status.value_counts().to_dict()}")
    families = {task: family for task, family in droplets.groupby("task")}
    sets = {}
    for task, row in rows.iterrows():
        key = (row.line_tension, row.break_up_neck, int(row.vertices), row.speed_exponent)
        sets.setdefault(key, {})[int(row.seed)] = task
    passed = {key: [np.array(at_outlet(families[task], outlet)) for _, task in sorted(tasks.items())]
              for key, tasks in sets.items()}
    print("line_tension,neck,vertices,speed_exponent,number,lower,upper,"
          "mean_diameter,lower,upper,seconds")
    for key, tasks in sets.items():
        number, diameter = (interval(passed[key], statistic, chance) for statistic in (mean_number, mean_diameter))
        print(",".join(f"{value:.4g}" for value in [*key, mean_number(passed[key]), *number,
                                                    mean_diameter(passed[key]), *diameter,
                                                    rows.processor_seconds[list(tasks.values())].mean()]))
    for tension in sorted({key[0] for key in sets}):
        base = tension, 0.05, 128, 0.0
        for name, other in (("256 vertices", (tension, 0.05, 256, 0.0)), ("neck 0.1", (tension, 0.1, 128, 0.0)),
                            ("speed-exponent 1", (tension, 0.05, 128, 1.0))):
            compare(f"Gamma={tension:g}, {name}", passed[base], passed[other], chance)
    differences, ratios, both, either = [], [], 0, 0
    for tension in sorted({key[0] for key in sets}):
        coarse, fine = (sets[tension, 0.05, vertices, 0.0] for vertices in (128, 256))
        for seed in coarse:
            pair = rows.loc[[coarse[seed], fine[seed]]]
            broken = (pair.status == "broken").tolist()
            either += any(broken)
            both += all(broken)
            if all(broken):
                differences.append(abs(pair.distance.iloc[0] - pair.distance.iloc[1]))
                ratios.append(abs(first_ratio(families[coarse[seed]]) - first_ratio(families[fine[seed]])))
    differences, ratios = np.array(differences), np.array(ratios)
    print(f"two meshes: {either} ancestors break on at least one, {both} on both; first break-up within 0.05 sigma: "
          f"{(differences < 0.05).mean():.3f}, median difference {np.median(differences):.4f}; "
          f"of these, ratio of areas within 0.02: {(ratios[differences < 0.05] < 0.02).mean():.3f}")


def main(programs, what, *files):
    with tempfile.TemporaryDirectory() as folder:
        if what == "sweep":
            sweep(pathlib.Path(files[0]))
        else:
            {"post": post, "symmetry": symmetry}[what](pathlib.Path(programs).resolve(), pathlib.Path(folder))


main(*sys.argv[1:])
