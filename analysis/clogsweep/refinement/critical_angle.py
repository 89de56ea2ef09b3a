"""Searches for the critical angle of a lattice. Up to this angle droplets follow the rows, and beyond it they leave the
rows."""

import itertools
import math
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import pandas

from ..tools.errors import UserError
from ..tools.rounded import count_text
from .driver import HOUR, UNFINISHED, Line, number_text
from .membership import Membership, Values

KEY = "lattice-angle"
FOLLOWING = ("lattice_angle", "length", "box")  # The angle, and parameters that follow from it.
DECIMALS = 6  # Decimals to which an angle is rounded. Angles of different lattices differ by far more.
MOST_ROWS_OFF = 1.0  # A droplet follows the rows if it is never farther off its row than this many row spacings.
# A run can show that droplets follow the rows only if a straight path of its length would cross at least this many
# rows.
FEWEST_ROWS = 2.0


def verdicts(runs: pandas.DataFrame) -> pandas.DataFrame:
    """For each run, its angle, and whether the droplet leaves the rows or follows them. Both are false for failed and
    unfinished runs, and for runs that are too short to decide."""
    angle, side = np.radians(abs(runs["lattice_angle"])), np.where(runs["lattice_angle"] < 0, -1, 1)
    of_pitch = np.select([runs["obstacle_filling"] == "triangular", runs["obstacle_filling"] == "rhombic"], [math.sqrt(3) / 2, np.cos(angle)], 1)
    spacing = (runs["obstacle_gap"] + runs["obstacle_diameter"]) * of_pitch  # spacing of the rows
    along, across = runs["distance"], side * runs["lateral_displacement"]
    counts = ~runs["status"].isin(["failed", *UNFINISHED])
    leaves = counts & (abs(across * np.cos(angle) - along * np.sin(angle)) > MOST_ROWS_OFF * spacing)
    is_long = counts & (along * np.sin(angle) >= FEWEST_ROWS * spacing)
    return pandas.DataFrame({"angle": abs(runs["lattice_angle"]), "leaves": leaves, "follows": is_long & ~leaves})


def tried_angles(runs: pandas.DataFrame) -> pandas.DataFrame:
    """For each angle, whether some droplets leave the rows, and whether droplets follow the rows. The angles
    increase; a negative angle counts as its mirror image."""
    found = verdicts(runs).groupby("angle").any()
    return found.assign(follows=found["follows"] & ~found["leaves"])


def bracket(angles: pandas.DataFrame) -> tuple[float, float]:
    """The bracket of the critical angle. The upper end of the bracket is the smallest angle at which some droplets
    leave the rows. The lower end is the largest angle below the upper end at which droplets follow the rows. An end is
    NaN if there is no such angle."""
    upper = angles.index[angles["leaves"]].min()
    below = angles if math.isnan(upper) else angles[angles.index < upper]
    return below.index[below["follows"]].max(), upper


def table_of(rows: pandas.DataFrame, parameters: Sequence[str]) -> pandas.DataFrame:
    """For every set of parameters: the parameters that vary, the ends of the bracket, `lower` and `upper`, and the
    number of `runs` that leave the rows or follow them.
    @param parameters  names of columns; a column is excluded if its values follow from the columns before it
    @throws UserError"""
    lattices = rows[rows["lattice_angle"].notna()]
    if lattices.empty:
        raise UserError("cannot find critical angles (these are no lattices) try refine lattice-angle obstacle-layout=lattice")
    varying: list[str] = []
    for name in parameters:
        sets = lattices.groupby(varying, dropna=False) if varying else lattices.assign(all=0).groupby("all")
        if name not in FOLLOWING and sets[name].nunique(dropna=False).max() > 1:
            varying.append(name)
    lines = []
    for _, runs in lattices.groupby(varying, dropna=False) if varying else [((), lattices)]:
        lower, upper = bracket(tried_angles(runs))
        lines.append([*(runs[name].iloc[0] for name in varying), lower, upper, verdicts(runs)[["leaves", "follows"]].any(axis=1).sum()])
    return pandas.DataFrame(lines, columns=[*varying, "lower", "upper", "runs"])


def nearest_angle(plan: dict[str, Any], angle: float) -> float | None:
    """The angle nearest to `angle` for which the lattice has a period in its box. @param plan  first line of `clogsweep
    --dry-run --format json` with this `lattice-angle`; clogsweep accepts this value if such an angle is near"""
    angles = plan.get("nearest", []) if "refused" in plan else [lattice["angle"] for lattice in plan["lattices"]]
    return min(angles, key=lambda one: abs(one - angle)) if angles else None


class AngleSearch:
    """Plans rounds of up to three angles. The angles are between the largest angle at which droplets follow the rows
    and the smallest angle at which droplets leave the rows."""

    keys: Sequence[str] = (KEY,)

    def __init__(self, given: Sequence[float], box: float, num_seeds: int, width: float, budget: float,
                 nearest: Callable[[float], float | None]) -> None:
        """@param given  angles, increasing
        @param width  width of the bracket at which the search ends; 0 if only the budget ends the search
        @param nearest  the nearest angle at which there is a lattice, see nearest_angle()"""
        self.end = ""
        self._width, self._budget, self._box, self._num_seeds, self._nearest = width, budget, box, num_seeds, nearest
        inner = self._within(given[0], given[-1], given) if len(given) == 2 else []
        self.candidates: list[Values] = [(angle,) for angle in sorted([*given, *inner])]

    def first_round(self) -> list[Line]:
        return [(values, None) for values in self.candidates]

    def _within(self, lower: float, upper: float, tried: Sequence[float]) -> list[float]:
        """Up to three angles that have not been tried yet: the angles of the lattices nearest to the quarters of the bracket."""
        nearest = [self._nearest(lower + part * (upper - lower) / 4) for part in (1, 2, 3)]
        rounded = {round(angle, DECIMALS) for angle in nearest if angle is not None and lower < angle < upper}
        return sorted(rounded - {round(angle, DECIMALS) for angle in tried})

    def _runs(self, rows: pandas.DataFrame, members: Membership) -> pandas.DataFrame:
        # The box is a period of the lattice, so it follows from the angle. The box has no effect on the droplet, so it
        # may differ between runs.
        runs = members.of_curve(rows, lambda name: name not in FOLLOWING)
        return runs[~runs["status"].isin(UNFINISHED)]

    def next_round(self, rows: pandas.DataFrame, members: Membership) -> list[Line]:
        """The points of the next round. The list is empty if the search has ended; `end` is then the reason."""
        runs = self._runs(rows, members)
        angles, hours = tried_angles(runs), float(runs["processor_seconds"].sum()) / HOUR
        lower, upper = bracket(angles)
        found: list[float] = []
        if math.isnan(upper - lower):
            self.end = "the angles do not bracket it"
        elif upper - lower <= self._width:
            self.end = f"critical-angle={self._width:g} is reached"
        elif hours >= self._budget:
            self.end = "the budget is used up"
        else:
            found = self._within(lower, upper, list(angles.index))
            if not found:
                self.end = (f"no other lattice in between has a period of box={number_text(self._box)} or less; "
                            "a larger box has more")
        return [((angle,), None) for angle in found]

    def known(self, rows: pandas.DataFrame, members: Membership) -> str:
        """States the result so far in one line."""
        runs = self._runs(rows, members)
        angles, num_failed = tried_angles(runs), (runs["status"] == "failed").sum()
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
        again = ", ".join(f"{angle:.4g}" for angle in angles.index[angles["follows"] & (angles.index > upper)])
        unknown = ", ".join(f"{angle:.4g}" for angle in angles.index[~angles["follows"] & ~angles["leaves"]])
        return "; ".join(filter(None, [
            self.end, text, again and f"they follow them again at {again}",
            unknown and f"runs were too short to say at {unknown} (max-time, clogs or failures)",
            num_failed and f"{num_failed} of {count_text(len(runs), 'run')} failed and do not count"]))

    def costs(self, hours_per_run: float) -> list[str]:
        """States the cost of the rounds, for --dry-run. @param hours_per_run  of the first round"""
        words = ["this is the first round; each of the others has up to three angles where droplets begin to leave the rows"]
        if math.isfinite(self._budget):
            words.append(f"all rounds: about {self._budget:.2g} core-hours at most (--budget)")
        if self._width > 0:
            apart = (self.candidates[-1][0] - self.candidates[0][0]) / (len(self.candidates) - 1)
            num_rounds = max(0, math.ceil(math.log(apart / self._width, 4)))
            num_runs = 3 * num_rounds * self._num_seeds
            words.append(f"critical-angle={self._width:g} takes about {num_rounds} more rounds, {num_runs} runs: "
                         f"{num_runs * hours_per_run:.2g} core-hours")
        return words


def require_angles(text: str, given: Sequence[float], kind: str) -> None:
    """Refuses a wrong list of angles. @throws UserError  unless these are increasing angles between 0 and 45 degrees,
    or up to 30 degrees for triangular lattices"""
    most, why = 30 if kind == "triangular" else 45, ""
    if len(given) < 2 or not all(np.isfinite(given)):
        why = "refine lattice-angle needs its bounds"
    elif any(one >= other for one, other in itertools.pairwise(given)):
        why = "values must increase: the lower bound comes first"
    elif not (given[0] > 0 and given[-1] <= most):
        why = f"the critical angle lies above 0, where droplets follow the rows by symmetry, up to {most} degrees"
    if why:
        raise UserError(f"invalid {KEY}={text} ({why}) try {KEY}=5,{most - 5}")
