"""The critical angle of a lattice: up to it droplets follow its rows, beyond it they leave them."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..tools.errors import UserError
from ..tools.hints import Records
from .candidates import number_text
from .curve_search import HOUR, UNFINISHED
from .membership import Membership, Values
from .rounds import Line

KEY = "lattice-angle"
SAME_ANGLE = 1e-9  # equal angles differ by rounding only [degrees]
LARGEST_ERROR = 0.1  # that clogsweep accepts between the angle given and the lattice's [degrees]
SMALLEST_BOX = 5.0  # [sigma], and no less than two spacings
MOST_ROWS_OFF = 1.0  # a droplet that follows the rows comes no farther off its own
FEWEST_ROWS = 2.0  # that a path along the flow must cross for the run to count


@dataclass
class Angle:
    """Runs at one angle [degrees]."""

    angle: float
    following: int = 0
    leaving: int = 0
    short: int = 0

    def count(self, along: float, across: float, spacing: float) -> None:
        """Counts a run by its displacement along and across the flow [sigma]. @param spacing  of the rows"""
        sine, cosine = math.sin(math.radians(self.angle)), math.cos(math.radians(self.angle))
        if abs(across * cosine - along * sine) / spacing > MOST_ROWS_OFF:
            self.leaving += 1
        elif along * sine >= FEWEST_ROWS * spacing:
            self.following += 1
        else:
            self.short += 1

    @property
    def leaves(self) -> bool:
        return self.leaving > 0

    @property
    def follows(self) -> bool:
        return self.following > 0 and self.leaving == 0


def bracket(angles: Sequence[Angle]) -> tuple[float, float]:
    """The largest angle below all that leave the rows at which droplets follow them, and the smallest at which some
    leave them; NaN where there is none. @param angles  increasing"""
    lower = math.nan
    for one in angles:
        if one.leaves:
            return lower, one.angle
        lower = one.angle if one.follows else lower
    return lower, math.nan


def nearest_lattice(spacing: float, angle: float, box: float) -> float | None:
    """Angle of the lattice nearest to `angle` that has a period of at most `box`: its edge joins two points of the
    lattice, p and q spacings apart, and tan(angle) = q/p."""
    nearest = None
    least = max(SMALLEST_BOX, 2 * spacing)
    for p in range(1, int(box * (1 + 1e-9) / spacing) + 1):
        wanted = p * math.tan(math.radians(angle))
        for q in (math.floor(wanted), math.ceil(wanted)):
            if not least * (1 - 1e-9) <= spacing * math.hypot(p, q) <= box * (1 + 1e-9):
                continue
            found = math.degrees(math.atan2(q, p))
            if nearest is None or abs(found - angle) < abs(nearest - angle) - SAME_ANGLE:
                nearest = found
    return nearest


class AngleSearch:
    """Rounds of up to three angles, between the last one that droplets follow and the first that they leave."""

    def __init__(self, given: Sequence[float], width: float, budget: float, spacing: float, box: float,
                 num_seeds: int) -> None:
        """@param given  angles, increasing; @param width  of the bracket to be reached, 0 if only the budget ends it"""
        self.end = ""
        self._width, self._budget, self._spacing, self._box, self._num_seeds = width, budget, spacing, box, num_seeds
        inner = self._within(given[0], given[-1], given) if len(given) == 2 else []
        self.candidates: list[Values] = [(angle,) for angle in sorted([*given, *inner])]

    def first_round(self) -> list[Line]:
        return [(values, None) for values in self.candidates]

    def _within(self, lower: float, upper: float, tried: Sequence[float]) -> list[float]:
        """Up to three lattices near the quarters of the bracket that have not been tried."""
        found: list[float] = []
        for part in (1, 2, 3):
            angle = nearest_lattice(self._spacing, lower + part * (upper - lower) / 4, self._box)
            if angle is None or not lower < angle < upper:
                continue
            if all(abs(angle - other) > SAME_ANGLE for other in [*tried, *found]):
                found.append(angle)
        return [self._short_text(angle) for angle in found]

    def _short_text(self, angle: float) -> float:
        """The angle with as few decimals as mean this lattice."""
        for decimals in range(2, 7):
            rounded = round(angle, decimals)
            nearest = nearest_lattice(self._spacing, rounded, self._box)
            if nearest is not None and abs(nearest - angle) <= SAME_ANGLE and abs(rounded - angle) <= LARGEST_ERROR:
                return rounded
        return angle

    def _look(self, rows: Records, members: Membership) -> tuple[list[Angle], float]:
        angles: dict[float, Angle] = {}
        hours = 0.0
        values_of = members.values_of(rows)
        for row, values in zip(rows, values_of, strict=True):
            if values is None or row["status"] in UNFINISHED:
                continue
            hours += float(row["wall_seconds"]) / HOUR
            here = angles.setdefault(float(row["lattice_angle"]), Angle(float(row["lattice_angle"])))
            if row["status"] == b"failed":
                here.short += 1
            else:
                here.count(float(row["distance"]), float(row["lateral_displacement"]), self._spacing)
        return [angles[angle] for angle in sorted(angles)], hours

    def next_round(self, rows: Records, members: Membership) -> list[Line]:
        """The points of the next round; none at the end of the search, whose reason is `end` then."""
        angles, hours = self._look(rows, members)
        lower, upper = bracket(angles)
        found: list[float] = []
        if math.isnan(upper - lower):
            self.end = "the angles do not bracket it"
        elif upper - lower <= self._width:
            self.end = f"critical-angle={self._width:g} is reached"
        elif hours >= self._budget:
            self.end = "the budget is used up"
        else:
            found = self._within(lower, upper, [one.angle for one in angles])
            if not found:
                self.end = (f"no other lattice in between has a period of box={number_text(self._box)} or less; "
                            "a larger box has more")
        return [((angle,), None) for angle in found]

    def known(self, rows: Records, members: Membership) -> str:
        """What the rows say, in one line."""
        angles, _ = self._look(rows, members)
        lower, upper = bracket(angles)
        if math.isnan(lower) and math.isnan(upper):
            text = "no droplet went far enough to say (the flow has to cross two rows); try a larger max-time"
        elif math.isnan(upper):
            text = f"up to {lower:.4g} degrees droplets follow the rows; try larger angles"
        elif math.isnan(lower):
            text = f"at {upper:.4g} degrees droplets leave the rows; try smaller angles, or a larger max-time"
        else:
            text = (f"the critical angle is {(lower + upper) / 2:.4g} degrees ({lower:.4g} to {upper:.4g}): droplets "
                    f"follow the rows at {lower:.4g} and leave them at {upper:.4g}")
        again = ", ".join(f"{one.angle:.4g}" for one in angles if one.follows and one.angle > upper)
        unknown = ", ".join(f"{one.angle:.4g}" for one in angles if not one.follows and not one.leaves)
        words = [self.end, text, f"they follow them again at {again}" if again else "",
                 f"runs were too short to say at {unknown} (max-time, clogs or failures)" if unknown else ""]
        return "; ".join(filter(None, words))

    def costs(self, hours_per_run: float) -> list[str]:
        """What the rounds may cost, for --dry-run. @param hours_per_run  of the first round; NaN: not known"""
        words = ["this is the first round; each of the others has up to three angles where droplets begin to leave the rows"]
        if math.isfinite(self._budget):
            words.append(f"all rounds: about {self._budget:.2g} core-hours at most (--budget)")
        if self._width > 0:
            apart = (self.candidates[-1][0] - self.candidates[0][0]) / (len(self.candidates) - 1)
            num_rounds = max(0, math.ceil(math.log(apart / self._width, 4)))
            num_runs = 3 * num_rounds * self._num_seeds
            cost = "" if math.isnan(hours_per_run) else f": {num_runs * hours_per_run:.2g} core-hours"
            words.append(f"critical-angle={self._width:g} takes about {num_rounds} more rounds, {num_runs} runs{cost}")
        return words


def require_angles(text: str, given: Sequence[float]) -> None:
    """@throws UserError  unless these are increasing angles between 0 and 45 degrees"""
    if len(given) < 2 or not all(np.isfinite(given)):
        why = "refine lattice-angle needs its bounds"
    elif any(one >= other for one, other in zip(given, given[1:], strict=False)):
        why = "values must increase: the lower bound comes first"
    elif not (given[0] > 0 and given[-1] <= 45):
        why = "the critical angle lies above 0, where droplets follow the rows by symmetry, up to 45 degrees"
    else:
        return
    raise UserError(f"invalid {KEY}={text} ({why}) try {KEY}=5,40")
