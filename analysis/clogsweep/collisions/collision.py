"""Which droplets break up on a single obstacle: up to which line tension, by how far off its centre they fall."""

from __future__ import annotations

import math
import pathlib
from collections.abc import Sequence

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from .. import style
from ..reading import programs, stored

DIAMETER = 0.3  # of the obstacle [sigma]
FALL = 3  # from the release to the obstacle's centre [sigma]: far enough that the droplet starts where it is told to
BOX = 20
KEYS = {"vertices": "128", "terminal-speed": "0.03", "break-up-neck": "0.02"}
TENSIONS = (0.01, 0.6)  # the softest droplets that are proved sound, and some that none breaks
PRECISION = 0.02
STEPS = 6  # of a sweep
CAPILLARY_TICKS = [2, 3, 5, 10, 20, 50, 100]

Threshold = tuple[float | None, float | None]  # the largest line tension of a droplet that breaks up, the next of one that does not


def symmetry(offset: float) -> float:
    """Of a collision with a droplet of radius 1/2."""
    small = (math.acos(2 * offset) - 2 * offset * math.sqrt(1 - 4 * offset**2)) / math.pi
    return small / (1 - small)


def capillary_number(tension: float) -> float:
    return math.pi / 4 / tension


class Collisions:
    """Droplets that fall onto the obstacle."""

    def __init__(self, clogsweep: pathlib.Path, folder: pathlib.Path, keys: dict[str, str]) -> None:
        self.clogsweep, self.folder, self.keys = clogsweep, folder, KEYS | keys
        # A droplet that hangs on until it has had the time to fall four times the way has not broken up.
        self.keys.setdefault("max-time", f"{4 * FALL / float(self.keys['terminal-speed']):g}")

    def break_up(self, offset: float, tensions: Sequence[float]) -> list[bool]:
        """Which of the droplets do."""
        circles, sweep = self.folder / "circle.csv", self.folder / "collisions.h5"
        circles.write_text(f"x,y,diameter\n{BOX / 2 + FALL},{BOX / 2 + offset},{DIAMETER}\n")
        programs.run_program(self.clogsweep, f"obstacles={circles}", f"box={BOX}", "seeds=1", *(f"{key}={value}" for key, value in self.keys.items()),
                             "line-tension=" + ",".join(f"{tension:.6g}" for tension in tensions), "--output", sweep, "--quiet")
        ends = [row["status"] for row in sorted(stored.read_rows(sweep), key=lambda row: row["line_tension"])]
        sweep.unlink()
        return [end == b"broken" for end in ends]

    def threshold(self, offset: float) -> Threshold:
        """@return the two that it lies between; None beyond TENSIONS"""
        low, high = TENSIONS
        while high / low > 1 + PRECISION:
            tensions = [low * (high / low)**(step / STEPS) for step in range(STEPS + 1)]
            broken = self.break_up(offset, tensions)
            first_whole = broken.index(False) if False in broken else len(broken)
            if first_whole in (0, len(broken)):
                return (None, low) if first_whole == 0 else (high, None)
            low, high = tensions[first_whole - 1], tensions[first_whole]
        return low, high


def logarithmic(axes: Axes, which: str, ticks: Sequence[float]) -> None:
    """One of the axes, with plain numbers where they fall within what is drawn."""
    axes.set(**{f"{which}scale": "log"})
    axis, (low, high) = getattr(axes, f"{which}axis"), getattr(axes, f"get_{which}lim")()
    axis.set_ticks([tick for tick in ticks if low <= tick <= high])
    axis.set_major_formatter("{x:g}")
    axis.set_ticks([], minor=True)


def draw(found: dict[float, Threshold]) -> Figure:
    """@param found  thresholds by offset"""
    figure, (left, right) = style.subplots(1, 2, figsize=(9.6, 4.4))
    known = {offset: math.sqrt(low * high) for offset, (low, high) in found.items() if low and high}
    places = {offset: (symmetry(offset), capillary_number(tension)) for offset, tension in known.items()}
    left.plot(*zip(*places.values()), marker="o", linestyle="none", color=style.COLOURS[0], label="droplets above break up")
    off_centre = [place for offset, place in places.items() if offset > 0]
    if off_centre:
        s, ca = off_centre[len(off_centre) // 2]
        ends = min(place[0] for place in off_centre), 1
        left.plot(ends, [ca * (end / s)**(-4 / 3) for end in ends], color="0.4", linewidth=1, linestyle="--", label=r"$Ca\,S^{4/3}$ constant")
    logarithmic(left, "x", [0.1, 0.2, 0.3, 0.5, 0.7, 1])
    logarithmic(left, "y", CAPILLARY_TICKS)
    left.set_xlabel("symmetry of the collision $S$")
    left.set_ylabel(r"capillary number $Ca = \pi/(4\Gamma)$")
    ordered = sorted(known, key=lambda offset: places[offset][1])
    right.plot([places[offset][1] for offset in ordered], [offset / ((1 + DIAMETER) / 2) for offset in ordered], marker="o", color=style.COLOURS[0])
    logarithmic(right, "x", CAPILLARY_TICKS)
    right.set_ylim(0, 1)
    right.set_xlabel(left.get_ylabel())
    right.set_ylabel("share of collisions that break the droplet up")
    left.legend(frameon=False, fontsize=8)
    for axes in (left, right):
        style.grid(axes)
    return figure
