"""Break-up of droplets on a single obstacle: the largest line tension at which they break up, vs the offset of their
path from the obstacle's centre."""

import math
import pathlib
from collections.abc import Sequence

from ..reading import programs, stored

DIAMETER = 0.3  # of the obstacle [sigma]
FALL = 3  # from the release to the obstacle's centre [sigma]: the obstacle is too far away to displace the release
BOX = 20
KEYS = {"preset": "robust", "vertices": "128", "terminal-speed": "0.03", "break-up-neck": "0.02"}
TENSIONS = (0.01, 0.6)  # range of the search: from below the tested range of line tensions to droplets that never break
PRECISION = 0.02
STEPS = 6  # a sweep divides the range into so many steps

Threshold = tuple[float | None, float | None]  # the largest tried line tension at which the droplet breaks up, and the smallest larger one at which it does not


def symmetry(offset: float) -> float:
    """The symmetry of a collision: the area of the smaller part divided by that of the larger part, for a droplet of radius 1/2."""
    small = (math.acos(2 * offset) - 2 * offset * math.sqrt(1 - 4 * offset**2)) / math.pi
    return small / (1 - small)


def capillary_number(tension: float) -> float:
    return math.pi / 4 / tension


class Collisions:
    """Droplets that fall onto the obstacle."""

    def __init__(self, clogsweep: pathlib.Path, folder: pathlib.Path, keys: dict[str, str]) -> None:
        self.clogsweep, self.folder, self.keys = clogsweep, folder, KEYS | keys
        # A droplet that has not broken up after four times the duration of its fall counts as whole.
        self.keys.setdefault("max-time", f"{4 * FALL / float(self.keys['terminal-speed']):g}")

    def break_up(self, offset: float, tensions: Sequence[float]) -> list[bool]:
        """Whether each of the droplets breaks up."""
        circles, sweep = self.folder / "circle.csv", self.folder / "collisions.h5"
        circles.write_text(f"x,y,diameter\n{BOX / 2 + FALL},{BOX / 2 + offset},{DIAMETER}\n", encoding="utf-8")
        programs.run_program(self.clogsweep, f"obstacles={circles}", f"box={BOX}", "seeds=1", *(f"{key}={value}" for key, value in self.keys.items()),
                             "line-tension=" + ",".join(f"{tension:.6g}" for tension in tensions), "--output", sweep, "--quiet")
        ends = [row["status"] for row in sorted(stored.read_rows(sweep), key=lambda row: row["line_tension"])]
        sweep.unlink()
        return [end == b"broken" for end in ends]

    def threshold(self, offset: float) -> Threshold:
        """@return the bracket; None beyond TENSIONS"""
        low, high = TENSIONS
        while high / low > 1 + PRECISION:
            tensions = [low * (high / low)**(step / STEPS) for step in range(STEPS + 1)]
            broken = self.break_up(offset, tensions)
            first_whole = broken.index(False) if False in broken else len(broken)
            if first_whole in (0, len(broken)):
                return (None, low) if first_whole == 0 else (high, None)
            low, high = tensions[first_whole - 1], tensions[first_whole]
        return low, high
