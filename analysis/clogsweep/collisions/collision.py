"""Finds the largest line tension at which droplets break up on a single obstacle, for each offset of the droplet's path
from the obstacle's centre."""

import math
import pathlib
from collections.abc import Sequence

import numpy as np

from ..reading import programs, stored

DIAMETER = 0.3  # Diameter of the obstacle [sigma].
# Distance from the release to the obstacle's centre [sigma]. At this distance the obstacle does not displace the
# release.
FALL = 3
BOX = 20
KEYS = {"preset": "robust", "vertices": "128", "terminal-speed": "0.03", "break-up-neck": "0.02"}
# The searched range of line tensions. The lower end is below the tested line tensions. At the upper end no droplet
# breaks up.
TENSIONS = (0.01, 0.6)
PRECISION = 0.02
STEPS = 6  # number of parts into which each sweep divides the range

# A bracket of tried line tensions: the droplet breaks up at the first of them, and stays whole at the second. No line
# tension in between was tried.
Threshold = tuple[float | None, float | None]


def symmetry(offset: float) -> float:
    """The symmetry of a collision. A line divides a circle of radius 1/2 into two parts. The distance of the line from
    the circle's centre is the offset. The symmetry is the area of the smaller part divided by that of the larger
    part."""
    small = (math.acos(2 * offset) - 2 * offset * math.sqrt(1 - 4 * offset**2)) / math.pi
    return small / (1 - small)


def capillary_number(tension: float) -> float:
    return math.pi / 4 / tension


class Collisions:
    """Simulates droplets that fall onto the obstacle."""

    def __init__(self, clogsweep: pathlib.Path, folder: pathlib.Path, keys: dict[str, str]) -> None:
        self.clogsweep, self.folder, self.keys = clogsweep, folder, KEYS | keys
        # A droplet that has not broken up after four times the duration of its fall counts as intact.
        self.keys.setdefault("max-time", f"{4 * FALL / float(self.keys['terminal-speed']):g}")

    def break_up(self, offset: float, tensions: Sequence[float]) -> list[bool]:
        """Whether a droplet of each line tension breaks up."""
        circles, sweep = self.folder / "circle.csv", self.folder / "collisions.h5"
        circles.write_text(f"x,y,diameter\n{BOX / 2 + FALL},{BOX / 2 + offset},{DIAMETER}\n", encoding="utf-8")
        programs.run_program(self.clogsweep, f"obstacles={circles}", f"box={BOX}", "seeds=1",
                             *(f"{key}={value}" for key, value in self.keys.items()),
                             "line-tension=" + ",".join(f"{tension:.6g}" for tension in tensions),
                             "--output", sweep, "--quiet")
        rows = np.sort(stored.read_rows(sweep), order="line_tension")
        sweep.unlink()
        stored.warn_of_failures(rows, "whole")
        return (rows["status"] == b"broken").tolist()

    def threshold(self, offset: float) -> Threshold:
        """Brackets the line tension below which droplets break up. @return the bracket; an end is None if it would be
        outside TENSIONS"""
        low, high = TENSIONS
        while high / low > 1 + PRECISION:
            tensions = [low * (high / low)**(step / STEPS) for step in range(STEPS + 1)]
            broken = self.break_up(offset, tensions)
            first_whole = broken.index(False) if False in broken else len(broken)
            if first_whole in (0, len(broken)):
                return (None, low) if first_whole == 0 else (high, None)
            low, high = tensions[first_whole - 1], tensions[first_whole]
        return low, high
