"""A search that puts values and seeds where the fitted curve of lambda needs them."""

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ..curves import features
from ..curves.model import Curve, Points, fit_curve
from ..tools.errors import UserError
from ..tools.hints import Numbers, Records
from . import candidates, goals
from .candidates import Sums, number_text
from .goals import Goal
from .membership import Membership, Values
from .rounds import Line

HOUR = 3600.0
UNFINISHED = (b"running", b"interrupted")


class Options(NamedTuple):
    keys: list[str]
    goal: Goal
    budget: float  # core-hours of all runs; may be infinite
    most_seeds: int  # of one value
    same_seeds: bool


class Known(NamedTuple):
    """What the rows say at one moment."""

    points: Sums
    curve: Curve | None  # None: no run got anywhere
    runs: list[int]  # of each candidate, failed ones included
    last_seeds: list[int]  # of each candidate; the seed before the first where it has none
    hopeless: list[bool]  # all runs of the candidate failed
    failures: list[str]
    hours: float


class CurveSearch:
    """Rounds for a curve over one or two keys."""

    def __init__(self, options: Options, lists: Sequence[Sequence[float]], seeds: Sequence[int], max_time: float) -> None:
        """@param lists  values given for each key, increasing; @param seeds  that follow one another: a block"""
        self.options, self.end = options, ""
        self._first_seed, self._block, self._max_time = seeds[0], len(seeds), max_time
        count = len(lists)
        values = [candidates.preferred_values(given, candidates.MOST_VALUES[count]) for given in lists]
        self.candidates: list[Values] = candidates.combinations(values)
        first = [candidates.spread(all_values, candidates.FIRST_VALUES[count]) if len(given) == 2 else list(given)
                 for given, all_values in zip(lists, values, strict=True)]
        self._first = candidates.combinations(first)
        self._places = np.log(np.array(self.candidates))

    def first_round(self) -> list[Line]:
        step = 0 if self.options.same_seeds else self._block
        return [(values, (self._first_seed + i * step, self._block)) for i, values in enumerate(self._first)]

    def next_round(self, rows: Records, members: Membership) -> list[Line]:
        """The points of the next round; none at the end of the search, whose reason is `end` then."""
        known = self._look(rows, members)
        goal = self.options.goal
        if known.curve is None:
            self.end = "no run got anywhere"
            return []
        if goals.known_precision(known.curve, self._places, goal) <= goal.precision:
            self.end = f"{goal} is reached"
            return []
        done = float(known.points.work.sum())
        most = math.inf
        if math.isfinite(self.options.budget) and known.hours > 0:
            most = max(0.0, self.options.budget - known.hours) * done / known.hours
        left = [0 if hopeless else max(0, (self.options.most_seeds - runs) // self._block)
                for runs, hopeless in zip(known.runs, known.hopeless, strict=True)]
        clogs, work = candidates.expected_runs(known.points, self._places, known.curve.mean, self._max_time)
        blocks = candidates.choose_blocks(known.curve, clogs, work, goals.weights(known.curve, goal), left,
                                          self._block, candidates.SHARE_OF_ROUND * done, most)
        if not any(blocks):
            self.end = "the budget is used up" if any(left) else "no value may get more seeds (--most-seeds)"
            return []
        return self._lines(blocks, known.last_seeds)

    def _lines(self, blocks: list[int], last_seeds: list[int]) -> list[Line]:
        next_seed = max(last_seeds) + 1
        lines: list[Line] = []
        for values, count, last in zip(self.candidates, blocks, last_seeds, strict=True):
            if count == 0:
                continue
            first = last + 1 if self.options.same_seeds else next_seed
            lines.append((values, (first, count * self._block)))
            next_seed += count * self._block
        return lines

    def _look(self, rows: Records, members: Membership) -> Known:
        values_of = members.values_of(rows)
        finished = ~np.isin(rows["status"], UNFINISHED)
        failed = rows["status"] == b"failed"
        sums: dict[Values, Numbers] = {}
        runs: dict[Values, list[int]] = {}  # all runs, failed ones, the last seed
        work = rows["steps"] * np.where(rows["model"] == b"dp", rows["vertices"], 1.0)
        hours = 0.0
        last_seed = self._first_seed - 1
        for i, values in enumerate(values_of):
            if values is None or not finished[i]:
                continue
            count = runs.setdefault(values, [0, 0, self._first_seed - 1])
            count[0] += 1
            count[1] += bool(failed[i])
            count[2] = max(count[2], int(rows["seed"][i]))
            last_seed = max(last_seed, count[2])
            hours += float(rows["wall_seconds"][i]) / HOUR
            if not failed[i]:
                clogged = rows["status"][i] == b"clogged"
                one = [clogged, max(float(rows["distance"][i]), 0.0), rows["time"][i], work[i]]
                sums[values] = sums.get(values, np.zeros(4)) + np.array(one, dtype=float)
        told = {values: of for values, of in sorted(sums.items()) if of[1] > 0 and of[2] > 0}
        table = np.array(list(told.values())).reshape(-1, 4)
        points = Sums(np.log(np.array(list(told)).reshape(-1, self._places.shape[1])), *table.T)
        failures = [f"{self._named(values)} ({bad} of {all_} run{'s' * (all_ != 1)})"
                    for values, (all_, bad, _) in sorted(runs.items()) if bad]
        none = (0, 0, self._first_seed - 1)
        at = [tuple(runs.get(values, none)) for values in self.candidates]
        last = [one[2] if self.options.same_seeds else last_seed for one in at]
        curve = fit_curve(Points(points.places, points.clogs, points.distance), self._places) if told else None
        return Known(points, curve, [one[0] for one in at], last, [0 < one[0] == one[1] for one in at], failures, hours)

    def _named(self, values: Values) -> str:
        return " ".join(f"{key}={number_text(value)}" for key, value in zip(self.options.keys, values, strict=True))

    def known(self, rows: Records, members: Membership) -> str:
        """What the rows say, in one line."""
        known = self._look(rows, members)
        begin = f"{self.end}; " if self.end else ""
        if known.curve is None:
            return f"{begin}nothing is known"
        precision = goals.known_precision(known.curve, self._places, Goal("curve"))
        peak = features.find_peak(known.curve, self._places, goals.CONFIDENCE)
        at = ", ".join(f"{key} {math.exp(place):.3g} ({math.exp(lower):.3g} to {math.exp(upper):.3g})"
                       for key, place, lower, upper in zip(self.options.keys, peak.place, peak.place_lower, peak.place_upper, strict=True))
        words = [f"{begin}lambda is known within {100 * precision:.2g} % along the curve",
                 f"highest at {at}, with {peak.length:.3g} sigma ({peak.length_lower:.3g} to {peak.length_upper:.3g})"]
        if self.options.goal.kind == "crossing":
            length = self.options.goal.length
            found = features.find_crossings(known.curve, self._places[:, 0], length, goals.CONFIDENCE)
            words += [f"it crosses {length:g} sigma at {self.options.keys[0]} {math.exp(one.place):.3g} "
                      f"({math.exp(one.lower):.3g} to {math.exp(one.upper):.3g})" for one in found]
            words += [] if found else [f"it does not cross {length:g} sigma"]
        return "; ".join(words + ([f"failed: {', '.join(known.failures)}"] if known.failures else []))

    def costs(self, hours_per_run: float) -> list[str]:
        """What the rounds may cost, for --dry-run. @param hours_per_run  of the first round; NaN: not known"""
        words = ["this is the first round; each of the others is to cost half of all before it"]
        if math.isfinite(self.options.budget):
            words.append(f"all rounds: {self.options.budget:.2g} core-hours at most (--budget)")
        goal = self.options.goal
        if goal.kind in ("peak", "crossing"):
            words.append(f"how much {goal} takes is known when its place is, after the first round")
        if goal.kind == "curve":
            # An error e of log lambda takes 1/e^2 clogs at each of so many places that do not inform each other.
            error = math.asinh(goal.precision) / features.normal_deviate(goals.CONFIDENCE)
            smooth, rough = 2 / error**2, len(self._first) / error**2
            cost = "" if math.isnan(hours_per_run) else (
                f": {smooth * hours_per_run:.2g} to {rough * hours_per_run:.2g} core-hours in all if every run clogs")
            words.append(f"{goal} takes about {smooth:.0f} clogs of a curve as smooth as a straight line, {rough:.0f} of "
                         f"one that is new at each of the first {len(self._first)} values{cost}")
        return words


def require_bounds(key: str, text: str, values: Sequence[float]) -> None:
    """@throws UserError  unless these are increasing, positive values, two at least"""
    if any(math.isnan(value) for value in values):
        raise UserError(f"invalid {key}={text} (refine needs numbers) try {key}=0.1,3")
    if len(values) < 2:
        raise UserError(f"invalid {key}={text} (refine needs its bounds) try {key}=0.1,3")
    if any(one >= other for one, other in zip(values, values[1:], strict=False)):
        raise UserError(f"invalid {key}={text} (values must increase: the lower bound comes first)")
    if values[0] <= 0:
        raise UserError(f"invalid {key}={text} (refine works on logarithms: values must be positive)")
