"""Predicts clogging lengths from droplets that fall onto one or two obstacles. Simulations show which pairs of
obstacles, and which single obstacles, hold a droplet. The prediction follows from the number of pairs and of
single obstacles in an array that would hold a droplet.

docs/reference/analysis.md describes the law and its limits.
"""

import dataclasses
import math
import pathlib
from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np

from ..reading import programs, stored
from ..tools.errors import UserError
from ..tools.hints import Numbers
from .collision import BOX, FALL

# Step between the gaps of the simulated pairs [sigma]. The step is a twentieth of the range of gaps that can hold a
# droplet.
GAP_STEP = 0.04
ANGLE_STEP = 3  # Step between the angles of the simulated pairs [degrees].
DIAMETER_STEP = 0.1  # Step between the mean diameters of the simulated pairs [sigma].
EXIT = 6  # Distance of the exit behind the obstacles [sigma]. Droplets that hang there do not reach the exit.
# Length of a fall [sigma]. A droplet that still moves after the time of this fall at terminal speed counts as free.
LONGEST_FALL = 90
# Precision of half_width() [sigma], and the number of parts into which each step of its search divides the bracket.
OFFSET_PRECISION, OFFSET_STEPS = 0.0001, 6
SPEED = 0.03  # Default terminal speed [sqrt(sigma g)].
SMALLEST_LENGTH = 4  # Below this length, predictions were too long by a third or more [sigma].
# Smallest line tension without a warning. At a line tension of 0.5, up to 42 % of all clogs hang on three obstacles,
# and at 0.3 up to 85 % (docs/reference/analysis.md).
SOFTEST = 1
ARRAYS, ARRAY_BOX = 4, 60  # number of random arrays in which pairs are counted; width of each array [sigma]

# Keys that describe the array. All other keys describe the droplet. `obstacle-diameter` describes both.
OF_ARRAYS = ("obstacle-layout", "obstacle-gap", "obstacle-density", "obstacle-diameter-spread",
             "obstacles", "lattice", "pitch", "lattice-angle", "box",
             "boxes", "length")
REFUSED = {"exit": "droplets leave the obstacles at one of their own",
           "seeds": "arrays and pairs have seeds of their own here",
           "max-time": "nothing runs in the array",
           "release": "nothing runs in the array"}


Circles = Sequence[tuple[float, float, float]]  # x along the flow, y across it, diameter [sigma]


@dataclasses.dataclass(frozen=True)
class Array:
    """The obstacles of an array, and those pairs of obstacles between which an undeformed droplet does not fit."""

    area: float  # [sigma^2]
    obstacles: int
    mean_diameter: float  # Mean diameter of the obstacles [sigma].
    diameters: Numbers  # Mean diameter of the two obstacles of each pair [sigma].
    separations: Numbers  # Distance between the two centres of each pair [sigma].
    # Angle between the line through the two centres and the direction across the flow, 0 to 90 [degrees].
    angles: Numbers
    is_isotropic: bool  # Whether all directions of pairs are equally likely, as in random arrays.


def pairs_of(circles: Numbers, width: float, length: float) -> Iterator[Numbers]:
    """Finds the pairs of obstacles in a periodic array between which an undeformed droplet does not fit. For each
    obstacle it yields the pairs with obstacles that come later in the list.

    @param circles  shape (n, 3): x, y and diameter [sigma]
    @param width  period across the flow, along y
    @param length  period along the flow, along x
    @return arrays of shape (m, 3): the vector from the first to the second obstacle, and their mean diameter
    """
    period = np.array([length, width])
    for index, circle in enumerate(circles):
        ways = circles[index + 1:, :2] - circle[:2]
        ways -= period * np.round(ways / period)
        diameters = (circles[index + 1:, 2] + circle[2]) / 2
        near = np.hypot(ways[:, 0], ways[:, 1]) < 1 + diameters
        yield np.column_stack([ways, diameters])[near]


class Droplets:
    """Simulates droplets that fall onto one or two obstacles."""

    def __init__(self, clogsweep: pathlib.Path, folder: pathlib.Path, keys: dict[str, str]) -> None:
        """@param keys  those keys of clogsweep that describe the droplet"""
        self.clogsweep, self.folder = clogsweep, folder
        try:
            speed = float(keys.get("terminal-speed", SPEED))
        except ValueError:
            raise UserError(f"invalid terminal-speed={keys['terminal-speed']} "
                            f"(must be a number); try {SPEED}") from None
        # max-time is set because a soft droplet may creep on an obstacle for ever. A droplet that passes ends its run
        # at the exit.
        self.keys = {"max-time": f"{LONGEST_FALL / speed:g}", "exit": f"{BOX / 2 + FALL + EXIT:g}"} | keys

    def ends(self, arrays: Sequence[Circles], tension: float | None = None) -> dict[float, list[bytes]]:
        """How the run in each array ends.
        @param arrays  obstacles of each array; x = 0 is at the distance FALL below the release
        @param tension  a single line tension, or None for all line tensions of the keys
        @return for each line tension, one word per array: the mechanism of the clog, such as wrapped or squeezed, or
        empty if the droplet passed
        """
        files = [self.folder / f"{index}.csv" for index in range(len(arrays))]
        for file, circles in zip(files, arrays):
            lines = [f"{BOX / 2 + FALL + x},{BOX / 2 + y},{diameter}\n" for x, y, diameter in circles]
            file.write_text("x,y,diameter\n" + "".join(lines), encoding="utf-8")
        sweep = self.folder / "caught.h5"
        keys = self.keys if tension is None else self.keys | {"line-tension": str(tension)}
        programs.run_program(self.clogsweep, "obstacles=" + ",".join(map(str, files)), f"box={BOX}", "seeds=1",
                             *(f"{key}={value}" for key, value in keys.items()), "--output", sweep, "--quiet")
        with stored.opened(sweep) as stored_sweep:
            rows, names = stored_sweep["runs"][:], stored.circle_files(stored_sweep)
        sweep.unlink()
        stored.warn_of_failures(rows, "passed")
        found: dict[float, list[bytes]] = {}
        for row in rows:
            index = int(pathlib.Path(names[stored.text(row["obstacles"])]).stem)
            ends = found.setdefault(float(row["line_tension"]), [b""] * len(arrays))
            ends[index] = row["mechanism"] if row["status"] == b"clogged" else b""
        return found

    def held(self, gap: float, diameter: float, angles: Sequence[float]) -> dict[float, list[bool]]:
        """For each line tension, whether each pair of obstacles holds a droplet that falls midway between the two. A
        droplet that one of the obstacles holds alone does not count.
        @param angles  of the pairs [degrees]"""
        halves = [[(gap + diameter) / 2 * part(math.radians(angle))
                   for part in (math.sin, math.cos)]
                  for angle in angles]
        ends = self.ends([[(0, -y, diameter), (2 * x, y, diameter)] for x, y in halves])
        return {tension: [end in (b"squeezed", b"hybrid") for end in words] for tension, words in ends.items()}

    def half_width(self, diameter: float, tension: float) -> float:
        """The largest offset from an obstacle's centre at which the obstacle holds the droplet [sigma]. An offset below
        OFFSET_PRECISION is returned as 0."""
        low, high = 0.0, (1 + diameter) / 2
        while high - low > max(OFFSET_PRECISION, low / OFFSET_STEPS**2):
            offsets = [low + (high - low) * step / OFFSET_STEPS for step in range(OFFSET_STEPS + 1)]
            ends = self.ends([[(0, offset, diameter)] for offset in offsets[1:-1]], tension)[tension]
            first_free = ends.index(b"") if b"" in ends else len(ends)
            low, high = offsets[first_free:first_free + 2]
        return (low + high) / 2 if low > 0 else 0


def mean_cosine(held: Sequence[bool]) -> float:
    """The mean of cos(angle) over all directions of a pair, with 0 in place of the cosine for directions in which the
    pair does not hold the droplet.

    A pair that holds the droplet is assumed to stop every droplet that arrives between the centres of its obstacles.
    Other droplets slide off to the outside.
    @param held  whether the pair holds the droplet at the middle of each interval of ANGLE_STEP, beginning with 0
    degrees
    """
    edges = np.radians(ANGLE_STEP * np.arange(len(held) + 1))
    return float(np.sum(np.diff(np.sin(edges))[np.array(held, dtype=bool)]) / (math.pi / 2))


def largest_angle(gap: float, diameter: float) -> float:
    """The largest angle at which a rigid disc rests on two obstacles [degrees]. At this angle the disc's centre is
    straight above the centre of the lower obstacle."""
    return math.degrees(math.asin(min(1.0, (gap + diameter) / (1 + diameter))))


class Prediction(NamedTuple):
    """The clogging lengths [sigma]. A length is infinite if nothing holds the droplet."""

    tension: float
    length: float
    squeezed: float  # Clogging length if only pairs held droplets.
    wrapped: float  # Clogging length if only single obstacles held droplets.


def length_of(rate: float) -> float:
    return 1 / rate if rate > 0 else math.inf


def predict(droplets: Droplets, array: Array) -> Iterator[Prediction]:
    beside = (1 + array.mean_diameter) / 2
    caught = dict.fromkeys(droplets.ends([[(0, beside, array.mean_diameter)]]), 0.0)
    cells = np.floor((array.separations - array.diameters) / GAP_STEP).astype(int)
    sizes = np.round(array.diameters / DIAMETER_STEP).astype(int)
    for cell, size in sorted(set(zip(cells.tolist(), sizes.tolist()))):
        here = (cells == cell) & (sizes == size)
        gap, diameter = GAP_STEP * (cell + 0.5), float(np.mean(array.diameters[here]))
        num_angles = math.ceil(largest_angle(min(1, gap + GAP_STEP / 2), diameter) / ANGLE_STEP)
        angle_cells = np.floor(array.angles[here] / ANGLE_STEP).astype(int)
        across = array.separations[here] * np.cos(np.radians(array.angles[here]))
        angles = [ANGLE_STEP * (index + 0.5) for index in range(num_angles)]
        for tension, held in droplets.held(gap, diameter, angles).items():
            if array.is_isotropic:
                total = mean_cosine(held) * np.sum(array.separations[here])
            else:
                total = np.sum(across[np.isin(angle_cells, np.flatnonzero(held))])
            caught[tension] += float(total)
    for tension, width in sorted(caught.items()):
        rates = width / array.area, 2 * droplets.half_width(array.mean_diameter, tension) * array.obstacles / array.area
        yield Prediction(tension, length_of(sum(rates)), *map(length_of, rates))


def doubts_of(tension: float, length: float) -> list[str]:
    """Reasons why a predicted length may be wrong by more than a tenth. docs/reference/analysis.md explains them."""
    return [word for word, holds in (("soft", tension < SOFTEST), ("crowded", length < SMALLEST_LENGTH)) if holds]


def read_array(clogrun: pathlib.Path, folder: pathlib.Path, keys: dict[str, str], *options: object) -> Array:
    """Lets clogrun make the array. If it is random, several arrays are made. @param keys  that describe the array.
    @param options  of clogrun. @throws UserError"""
    run, circle_file = folder / "array.h5", folder / "array.csv"
    is_own = keys.get("obstacle-layout", "random") != "random" or "obstacles" in keys
    keys = keys if is_own else {"box": str(ARRAY_BOX)} | keys
    ways: list[Numbers] = []
    area, sizes = 0.0, []
    for seed in range(1, 2 if is_own else ARRAYS + 1):
        programs.run_program(clogrun, "array", *options, *(f"{key}={value}" for key, value in keys.items()),
                             f"seeds={seed}", "vertices=64", "max-time=1", "--output", run, "--write-obstacles",
                             circle_file)
        row = stored.read_rows(run)[0]
        run.unlink()
        circles = np.loadtxt(circle_file, delimiter=",", skiprows=1, ndmin=2, encoding="utf-8")
        circle_file.unlink()
        width, length = float(row["box"]), float(row["length"] if row["length"] > 0 else row["box"] * row["boxes"])
        area += width * length
        sizes += circles[:, 2].tolist()
        ways += pairs_of(circles, width, length)
    along, across, diameters = np.abs(np.concatenate(ways)).T
    return Array(area, len(sizes), float(np.mean(sizes)), diameters, np.hypot(along, across),
                 np.degrees(np.arctan2(along, across)), not is_own)
