"""Clogging lengths from pairs of obstacles: which pairs hold a droplet, and how many of them an array has.

docs/explanation/predicted.md has the law and its limits.
"""

import dataclasses
import math
import pathlib
from collections.abc import Iterator, Sequence

import numpy as np

from ..reading import programs, stored
from ..tools.errors import UserError
from ..tools.hints import Numbers
from .collision import BOX, FALL

GAP_STEP = 0.04  # of pairs that are tried [sigma]: a twentieth of the range in which they can hold a droplet
ANGLE_STEP = 3  # [degrees]
SPEED = 0.03  # terminal speed by default [sqrt(sigma g)]
SMALLEST_LENGTH = 4  # [sigma]: shorter ones were too long by a third and more
SOFTEST = 1  # line tension: at 0.5 up to 42 % of all clogs hang on three obstacles, at 0.3 85 % (docs/explanation/predicted.md)
ARRAYS, ARRAY_BOX = 4, 60  # of random arrays, pairs of so many are counted

# The keys of the array. All other keys belong to the droplet; `obstacle-diameter` belongs to both.
OF_ARRAYS = ("obstacle-layout", "obstacle-gap", "obstacle-density", "obstacles", "lattice-angle", "box", "boxes")
REFUSED = {"seeds": "arrays and pairs have seeds of their own here", "max-time": "nothing runs in the array", "release": "nothing runs in the array",
           "obstacle-diameter-spread": "pairs are of obstacles alike"}


@dataclasses.dataclass(frozen=True)
class Array:
    """Neighbours in an array: pairs of obstacles with gaps too narrow for a free droplet."""

    diameter: float  # of all obstacles [sigma]
    area: float  # of the array [sigma^2]
    separations: Numbers  # of the centres, of each pair [sigma]
    angles: Numbers  # between their line and the horizontal, which is across the flow, 0 to 90 [degrees]
    is_isotropic: bool  # of no direction, as random arrays are


def pairs_of(circles: Numbers, width: float, length: float, nearest: float) -> Iterator[Numbers]:
    """Vectors from each obstacle to later ones in the list that are less than `nearest` away, in an array that repeats.

    @param circles  n x 2, x and y [sigma]; @param width  period across the flow, y; @param length  along it, x
    @return arrays of m x 2
    """
    period = np.array([length, width])
    for index, circle in enumerate(circles):
        ways = circles[index + 1:] - circle
        ways -= period * np.round(ways / period)
        yield ways[np.hypot(ways[:, 0], ways[:, 1]) < nearest]


class Pairs:
    """Droplets that fall onto the middle of two obstacles."""

    def __init__(self, clogsweep: pathlib.Path, folder: pathlib.Path, keys: dict[str, str]) -> None:
        """@param keys  of clogsweep, those of the droplet"""
        self.clogsweep, self.folder = clogsweep, folder
        try:
            speed = float(keys.get("terminal-speed", SPEED))
        except ValueError:
            raise UserError(f"invalid terminal-speed={keys['terminal-speed']} (must be a number); try {SPEED}") from None
        self.keys = {"max-time": f"{4 * FALL / speed:g}"} | keys  # four times the duration of a free fall to the pair

    def held(self, gap: float, diameter: float, angles: Sequence[float]) -> dict[float, list[bool]]:
        """Which pairs hold it. @param angles  of the pairs [degrees]. @return for each line tension, an entry per
        angle"""
        files = [self.folder / f"{index}.csv" for index in range(len(angles))]
        for file, angle in zip(files, angles):
            half_x, half_y = ((gap + diameter) / 2 * part(math.radians(angle)) for part in (math.sin, math.cos))
            x, y = BOX / 2 + FALL + half_x, BOX / 2
            file.write_text(f"x,y,diameter\n{x - half_x},{y - half_y},{diameter}\n{x + half_x},{y + half_y},{diameter}\n", encoding="utf-8")
        sweep = self.folder / "pairs.h5"
        programs.run_program(self.clogsweep, "obstacles=" + ",".join(map(str, files)), f"box={BOX}", "seeds=1",
                             *(f"{key}={value}" for key, value in self.keys.items()), "--output", sweep, "--quiet")
        with stored.opened(sweep) as stored_sweep:
            rows, names = stored_sweep["runs"][:], stored.circle_files(stored_sweep)
        sweep.unlink()
        found: dict[float, list[bool]] = {}
        for row in rows:
            index = int(pathlib.Path(names[stored.text(row["obstacles"])]).stem)
            found.setdefault(float(row["line_tension"]), [False] * len(angles))[index] = row["status"] == b"clogged"
        return found


def capture_widths(gap: float, diameter: float, held: Sequence[bool]) -> tuple[Numbers, float]:
    """The width across the flow within which a pair stops a droplet [sigma].

    It is the distance of both centres across the flow if the pair holds the droplet, and otherwise zero, because a
    droplet that arrives beside it slides off outwards. @param held  for angles in the middles of steps of ANGLE_STEP
    @return one for each of those angles, divided by the cosine of the pair's own; and the mean of all directions
    """
    edges = np.radians(ANGLE_STEP * np.arange(len(held) + 1))
    apart = (gap + diameter) * np.array(held, dtype=float)
    return apart, float(np.sum(apart * np.diff(np.sin(edges))) / (math.pi / 2))


def largest_angle(gap: float, diameter: float) -> float:
    """Largest angle at which a rigid disc rests on two obstacles [degrees]: its centre is above the line between
    theirs."""
    return math.degrees(math.asin(min(1.0, (gap + diameter) / (1 + diameter))))


def predict(pairs: Pairs, array: Array) -> Iterator[tuple[float, float]]:
    """@return line tension, and clogging length [sigma], infinite where no pair holds a droplet"""
    caught: dict[float, float] = {}
    gaps = array.separations - array.diameter
    cells = np.floor(gaps / GAP_STEP).astype(int)
    for cell in np.unique(cells):
        gap = GAP_STEP * (cell + 0.5)
        num_angles = math.ceil(largest_angle(min(1, gap + GAP_STEP / 2), array.diameter) / ANGLE_STEP)
        here = cells == cell
        angle_cells = np.floor(array.angles[here] / ANGLE_STEP).astype(int)
        can_hold = angle_cells < num_angles
        for tension, held in pairs.held(gap, array.diameter, [ANGLE_STEP * (index + 0.5) for index in range(num_angles)]).items():
            widths, mean_width = capture_widths(gap, array.diameter, held)
            if array.is_isotropic:
                total = mean_width * np.count_nonzero(here)
            else:
                total = np.sum(widths[angle_cells[can_hold]] * np.cos(np.radians(array.angles[here][can_hold])))
            caught[tension] = caught.get(tension, 0) + float(total)
    for tension, width in sorted(caught.items()):
        yield tension, array.area / width if width > 0 else math.inf


def doubts_of(tension: float, length: float) -> list[str]:
    """Reasons why a predicted length may be wrong by more than a tenth; words of docs/explanation/predicted.md."""
    return [word for word, holds in (("soft", tension < SOFTEST), ("crowded", length < SMALLEST_LENGTH)) if holds]


def read_array(clogrun: pathlib.Path, folder: pathlib.Path, keys: dict[str, str]) -> Array:
    """Has clogrun make the array, or several of a random one. @param keys  that describe it. @throws UserError"""
    run, circle_file = folder / "array.h5", folder / "array.csv"
    is_own = keys.get("obstacle-layout", "random") != "random" or "obstacles" in keys
    keys = keys if is_own else {"box": str(ARRAY_BOX)} | keys
    ways: list[Numbers] = []
    area = 0.0
    for seed in range(1, 2 if is_own else ARRAYS + 1):
        programs.run_program(clogrun, "array", *(f"{key}={value}" for key, value in keys.items()), f"seeds={seed}", "vertices=64", "max-time=1",
                             "--output", run, "--write-obstacles", circle_file)
        row = stored.read_rows(run)[0]
        run.unlink()
        circles = np.loadtxt(circle_file, delimiter=",", skiprows=1, ndmin=2, encoding="utf-8")
        circle_file.unlink()
        diameter = float(circles[0, 2])
        if not np.allclose(circles[:, 2], diameter):
            raise UserError("obstacles differ in diameter; a length can be predicted of obstacles alike only")
        width, length = float(row["box"]), float(row["box"] * row["boxes"])
        area += width * length
        ways += pairs_of(circles[:, :2], width, length, 1 + diameter)
    along, across = np.abs(np.concatenate(ways)).T
    if along.size == 0:
        raise UserError("no two obstacles are less than a droplet apart; no droplet clogs between them")
    return Array(diameter, area, np.hypot(along, across), np.degrees(np.arctan2(along, across)), not is_own)
