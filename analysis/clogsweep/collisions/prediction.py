"""Clogging lengths from droplets that fall onto one or two obstacles: which obstacles hold a droplet, and how many of these an array has.

docs/explanation/predicted.md has the law and its limits.
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

GAP_STEP = 0.04  # of pairs that are tried [sigma]: a twentieth of the range in which they can hold a droplet
ANGLE_STEP = 3  # [degrees]
DIAMETER_STEP = 0.1  # of the mean diameter of a pair [sigma]
EXIT = 6  # behind the obstacles: farther than droplets hang [sigma]
LONGEST_FALL = 90  # at terminal speed, before a droplet that creeps on an obstacle counts as free [sigma]
OFFSET_PRECISION, OFFSET_STEPS = 0.0001, 6  # of the half-width within which one obstacle holds a droplet [sigma]; of a search
SPEED = 0.03  # terminal speed by default [sqrt(sigma g)]
SMALLEST_LENGTH = 4  # [sigma]: shorter ones were too long by a third and more
SOFTEST = 1  # line tension: at 0.5 up to 42 % of all clogs hang on three obstacles, at 0.3 85 % (docs/explanation/predicted.md)
ARRAYS, ARRAY_BOX = 4, 60  # number of random arrays in which pairs are counted, and their width [sigma]

# The keys of the array. All other keys belong to the droplet; `obstacle-diameter` belongs to both.
OF_ARRAYS = ("obstacle-layout", "obstacle-gap", "obstacle-density", "obstacle-diameter-spread", "obstacles", "lattice", "pitch", "lattice-angle", "box",
             "boxes", "length")
REFUSED = {"exit": "droplets leave the obstacles at one of their own", "seeds": "arrays and pairs have seeds of their own here", "max-time": "nothing runs in the array", "release": "nothing runs in the array"}


Circles = Sequence[tuple[float, float, float]]  # x along the flow, y across it, diameter [sigma]


@dataclasses.dataclass(frozen=True)
class Array:
    """The obstacles of an array, and its pairs of obstacles between which a free droplet does not fit."""

    area: float  # [sigma^2]
    obstacles: int
    mean_diameter: float  # of the obstacles [sigma]
    diameters: Numbers  # mean of the two obstacles, of each pair [sigma]
    separations: Numbers  # of the centres, of each pair [sigma]
    angles: Numbers  # between their line and the horizontal, which is across the flow, 0 to 90 [degrees]
    is_isotropic: bool  # of no direction, as random arrays are


def pairs_of(circles: Numbers, width: float, length: float) -> Iterator[Numbers]:
    """Pairs of obstacles between which a free droplet does not fit, in a periodic array, for each obstacle and those behind it in the list.

    @param circles  n x 3, x, y and diameter [sigma]; @param width  period across the flow, y; @param length  along it, x
    @return arrays of m x 3: vector from the first to the second obstacle, mean diameter
    """
    period = np.array([length, width])
    for index, circle in enumerate(circles):
        ways = circles[index + 1:, :2] - circle[:2]
        ways -= period * np.round(ways / period)
        diameters = (circles[index + 1:, 2] + circle[2]) / 2
        near = np.hypot(ways[:, 0], ways[:, 1]) < 1 + diameters
        yield np.column_stack([ways, diameters])[near]


class Droplets:
    """Droplets that fall onto one or two obstacles."""

    def __init__(self, clogsweep: pathlib.Path, folder: pathlib.Path, keys: dict[str, str]) -> None:
        """@param keys  of clogsweep, those of the droplet"""
        self.clogsweep, self.folder = clogsweep, folder
        try:
            speed = float(keys.get("terminal-speed", SPEED))
        except ValueError:
            raise UserError(f"invalid terminal-speed={keys['terminal-speed']} (must be a number); try {SPEED}") from None
        # Soft droplets creep on an obstacle; those that pass end at the exit.
        self.keys = {"max-time": f"{LONGEST_FALL / speed:g}", "exit": f"{BOX / 2 + FALL + EXIT:g}"} | keys

    def ends(self, arrays: Sequence[Circles], tension: float | None = None) -> dict[float, list[bytes]]:
        """What holds it. @param arrays  of each droplet, from FALL below its release on; @param tension  if not all of the keys
        @return for each line tension, a word per array: wrapped, squeezed and so on, empty if it passed
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
        found: dict[float, list[bytes]] = {}
        for row in rows:
            index = int(pathlib.Path(names[stored.text(row["obstacles"])]).stem)
            found.setdefault(float(row["line_tension"]), [b""] * len(arrays))[index] = row["mechanism"] if row["status"] == b"clogged" else b""
        return found

    def held(self, gap: float, diameter: float, angles: Sequence[float]) -> dict[float, list[bool]]:
        """Which pairs stop a droplet that falls onto their middle, if not one of their obstacles alone does. @param angles  of the pairs [degrees]"""
        halves = [[(gap + diameter) / 2 * part(math.radians(angle)) for part in (math.sin, math.cos)] for angle in angles]
        ends = self.ends([[(0, -y, diameter), (2 * x, y, diameter)] for x, y in halves])
        return {tension: [end in (b"squeezed", b"hybrid") for end in words] for tension, words in ends.items()}

    def half_width(self, diameter: float, tension: float) -> float:
        """Largest offset from the centre of one obstacle at which it holds the droplet [sigma], 0 if below OFFSET_PRECISION."""
        low, high = 0.0, (1 + diameter) / 2
        while high - low > max(OFFSET_PRECISION, low / OFFSET_STEPS**2):
            offsets = [low + (high - low) * step / OFFSET_STEPS for step in range(OFFSET_STEPS + 1)]
            ends = self.ends([[(0, offset, diameter)] for offset in offsets[1:-1]], tension)[tension]
            first_free = ends.index(b"") if b"" in ends else len(ends)
            low, high = offsets[first_free:first_free + 2]
        return (low + high) / 2 if low > 0 else 0


def mean_cosine(held: Sequence[bool]) -> float:
    """Mean of cos(angle) over all directions, 0 where a pair does not hold the droplet.

    A pair that holds it catches what arrives between its centres; a droplet that arrives beside them slides off outwards.
    @param held  for angles in the middles of steps of ANGLE_STEP
    """
    edges = np.radians(ANGLE_STEP * np.arange(len(held) + 1))
    return float(np.sum(np.diff(np.sin(edges))[np.array(held, dtype=bool)]) / (math.pi / 2))


def largest_angle(gap: float, diameter: float) -> float:
    """Largest angle at which a rigid disc rests on two obstacles [degrees]: the disc's centre is above the line
    between the obstacles' centres."""
    return math.degrees(math.asin(min(1.0, (gap + diameter) / (1 + diameter))))


class Prediction(NamedTuple):
    """Clogging lengths, infinite where nothing holds the droplet [sigma]."""

    tension: float
    length: float
    squeezed: float  # by pairs alone
    wrapped: float  # by single obstacles alone


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
        for tension, held in droplets.held(gap, diameter, [ANGLE_STEP * (index + 0.5) for index in range(num_angles)]).items():
            if array.is_isotropic:
                total = mean_cosine(held) * np.sum(array.separations[here])
            else:
                total = np.sum(across[np.isin(angle_cells, np.flatnonzero(held))])
            caught[tension] += float(total)
    for tension, width in sorted(caught.items()):
        rates = width / array.area, 2 * droplets.half_width(array.mean_diameter, tension) * array.obstacles / array.area
        yield Prediction(tension, length_of(sum(rates)), *map(length_of, rates))


def doubts_of(tension: float, length: float) -> list[str]:
    """Reasons why a predicted length may be wrong by more than a tenth, as in docs/explanation/predicted.md."""
    return [word for word, holds in (("soft", tension < SOFTEST), ("crowded", length < SMALLEST_LENGTH)) if holds]


def read_array(clogrun: pathlib.Path, folder: pathlib.Path, keys: dict[str, str]) -> Array:
    """Has clogrun make the array, or several of a random one. @param keys  that describe it. @throws UserError"""
    run, circle_file = folder / "array.h5", folder / "array.csv"
    is_own = keys.get("obstacle-layout", "random") != "random" or "obstacles" in keys
    keys = keys if is_own else {"box": str(ARRAY_BOX)} | keys
    ways: list[Numbers] = []
    area, sizes = 0.0, []
    for seed in range(1, 2 if is_own else ARRAYS + 1):
        programs.run_program(clogrun, "array", *(f"{key}={value}" for key, value in keys.items()), f"seeds={seed}", "vertices=64", "max-time=1",
                             "--output", run, "--write-obstacles", circle_file)
        row = stored.read_rows(run)[0]
        run.unlink()
        circles = np.loadtxt(circle_file, delimiter=",", skiprows=1, ndmin=2, encoding="utf-8")
        circle_file.unlink()
        width, length = float(row["box"]), float(row["length"] if row["length"] > 0 else row["box"] * row["boxes"])
        area += width * length
        sizes += circles[:, 2].tolist()
        ways += pairs_of(circles, width, length)
    along, across, diameters = np.abs(np.concatenate(ways)).T
    return Array(area, len(sizes), float(np.mean(sizes)), diameters, np.hypot(along, across), np.degrees(np.arctan2(along, across)), not is_own)
