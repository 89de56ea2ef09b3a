"""Chooses the values and seeds of the runs that improve the fitted curve of lambda most."""

import itertools
import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import pandas

from ..curves import features
from ..curves.model import Curve, Points, fit_curve
from ..tools.errors import UserError
from ..tools.hints import Numbers
from ..tools.rounded import count_text
from . import choice, goals
from .driver import HOUR, UNFINISHED, Line, number_text
from .goals import Goal
from .membership import Membership, Values

MOST_VALUES = {1: 100, 2: 13}  # Largest number of values of each key, by the number of keys.
FIRST_VALUES = {1: 7, 2: 4}
MOST_COMBINATIONS = 500
COSTLY = 0.1  # If values without clogs took a larger share of all work, a message states this.
SHARE_OF_ROUND = 0.5  # Work of a round, divided by the work of all earlier rounds.


class Options(NamedTuple):
    goal: Goal
    budget: float  # Core-hours of all runs, possibly infinite.
    most_seeds: int  # Largest number of seeds of one value.
    same_seeds: bool


class Known(NamedTuple):
    """The runs so far, and the curve that follows from them."""

    runs: pandas.DataFrame  # Sums over the runs of each value, including failed runs.
    curve: Curve | None  # The curve at the candidates, or None if no run has covered any distance.


def combinations(lists: Sequence[Sequence[float]]) -> list[Values]:
    """All combinations of the keys' values. The value of the first key varies fastest."""
    return [tuple(reversed(values)) for values in itertools.product(*reversed(lists))]


class CurveSearch:
    """Plans rounds for a curve over one or two keys."""

    def __init__(self, keys: Sequence[str], lists: Sequence[Sequence[float]], seeds: Sequence[int], max_time: float,
                 options: Options) -> None:
        """@param lists  values given for each key, increasing; @param seeds  a block of consecutive seeds
        @throws UserError  if there are too many values"""
        self.end = ""
        self.keys, self._options, self._max_time = keys, options, max_time
        self._first_seed, self._block = seeds[0], len(seeds)
        count = len(keys)
        values = [choice.preferred_values(given, MOST_VALUES[count]) for given in lists]
        self.candidates = combinations(values)
        if len(self.candidates) > MOST_COMBINATIONS:
            raise UserError(f"cannot refine {','.join(keys)} (its lists have {len(self.candidates)} combinations, more than "
                            f"{MOST_COMBINATIONS}); give their bounds")
        self._first = combinations([given if len(given) > 2 else choice.spread(all_, FIRST_VALUES[count])
                                    for given, all_ in zip(lists, values)])
        self._places = np.log(np.array(self.candidates))

    def first_round(self) -> list[Line]:
        step = 0 if self._options.same_seeds else self._block
        return [(values, (self._first_seed + i * step, self._block)) for i, values in enumerate(self._first)]

    def next_round(self, rows: pandas.DataFrame, members: Membership) -> list[Line]:
        """The points of the next round. The list is empty if the search has ended; `end` is then the reason."""
        known, options, block = self._look(rows, members), self._options, self._block
        if known.curve is None:
            self.end = "no run got anywhere"
            return []
        if goals.known_precision(known.curve, self._places, options.goal) <= options.goal.precision:
            self.end = f"{options.goal} is reached"
            return []
        done, hours = known.runs["work"].sum(), known.runs["hours"].sum()
        most_work = max(0.0, options.budget - hours) * done / hours if math.isfinite(options.budget) else math.inf
        here = known.runs.reindex(self.candidates, fill_value=0)
        left = np.maximum(options.most_seeds - here["runs"], 0) // block
        left[(here["runs"] > 0) & (here["runs"] == here["failed"])] = 0
        clogs, work = choice.expected_runs(*_informing(known.runs), self._places, known.curve.mean, self._max_time)
        blocks = choice.choose_blocks(known.curve, block * clogs, block * work, goals.weights(known.curve, options.goal),
                                      left.to_numpy(), SHARE_OF_ROUND * done, most_work)
        if not blocks.any():
            self.end = "the budget is used up" if left.any() else "no value may get more seeds (--most-seeds)"
        last = here["last_seed"].where(here["runs"] > 0, self._first_seed - 1)
        lines: list[Line] = []
        next_seed = int(known.runs["last_seed"].max()) + 1
        for values, seeds, last_seed in zip(self.candidates, map(int, block * blocks), map(int, last)):
            if seeds:
                lines.append((values, (last_seed + 1 if options.same_seeds else next_seed, seeds)))
                next_seed += seeds
        return lines

    def _look(self, rows: pandas.DataFrame, members: Membership) -> Known:
        runs = members.of_values(rows)
        runs = runs[~runs["status"].isin(UNFINISHED)]
        failed = runs["status"] == "failed"
        table = pandas.DataFrame({
            "values": runs["values"], "runs": 1, "failed": failed, "last_seed": runs["seed"].astype(int),
            "hours": runs["processor_seconds"] / HOUR, "clogs": runs["status"] == "clogged",
            # A failed run is censored at its sound distance.
            "distance": runs["distance"].where(~failed, runs["sound_distance"]).clip(lower=0).fillna(0), "time": runs["time"],
            "work": runs["steps"] * runs["vertices"].where(runs["model"] == "dp", 1)})
        of_values = table.groupby("values")
        sums = of_values.sum().assign(last_seed=of_values["last_seed"].max())
        informing, places = _informing(sums)
        curve = None if informing.empty else fit_curve(
            Points(places, informing["clogs"].to_numpy(float), informing["distance"].to_numpy()), self._places)
        return Known(sums, curve)

    def known(self, rows: pandas.DataFrame, members: Membership) -> str:
        """States the result so far in one line."""
        known = self._look(rows, members)
        words = [self.end] if self.end else []
        if known.curve is None:
            return "; ".join([*words, "nothing is known"])
        precision = goals.known_precision(known.curve, self._places, Goal("curve"))
        peak = features.find_peak(known.curve, self._places, goals.CONFIDENCE)
        at = ", ".join(f"{key} {math.exp(place):.3g} ({math.exp(lower):.3g} to {math.exp(upper):.3g})"
                       for key, place, lower, upper in zip(self.keys, peak.place, peak.place_lower, peak.place_upper))
        words += [f"lambda is known within {100 * precision:.2g} % along the curve",
                  f"highest at {at}, with {peak.length:.3g} sigma ({peak.length_lower:.3g} to {peak.length_upper:.3g})"]
        if self._options.goal.kind == "crossing":
            length = self._options.goal.length
            found = features.find_crossings(known.curve, self._places[:, 0], length, goals.CONFIDENCE)
            words += [f"it crosses {length:g} sigma at {self.keys[0]} {math.exp(one.place):.3g} "
                      f"({math.exp(one.lower):.3g} to {math.exp(one.upper):.3g})" for one in found]
            words += [] if found else [f"it does not cross {length:g} sigma"]
        without = known.runs[known.runs["clogs"] == 0]
        share = without["work"].sum() / known.runs["work"].sum()
        if share > COSTLY:
            words.append(f"{count_text(int(without['runs'].sum()), 'run')} ({100 * share:.0f} % of the computing time) did not clog, at "
                         f"{', '.join(map(self._named, without.index))}: they only show that lambda is larger")
        failures = [f"{self._named(values)} ({one.failed} of {count_text(one.runs, 'run')})"
                    for values, one in zip(known.runs.index, known.runs.itertuples()) if one.failed]
        return "; ".join([*words, f"failed: {', '.join(failures)}"] if failures else words)

    def _named(self, values: Values) -> str:
        return " ".join(f"{key}={number_text(value)}" for key, value in zip(self.keys, values))

    def costs(self, hours_per_run: float) -> list[str]:
        """States the cost of the rounds, for --dry-run. @param hours_per_run  of the first round"""
        words = ["this is the first round; each of the others is to cost half of all before it"]
        if math.isfinite(self._options.budget):
            words.append(f"all rounds: {self._options.budget:.2g} core-hours at most (--budget)")
        goal = self._options.goal
        if goal.kind in ("peak", "crossing"):
            words.append(f"how much {goal} takes is known when its place is, after the first round")
        if goal.kind == "curve":
            # To reach an error e of log lambda, each independent place of the curve needs 1/e^2 clogs. A straight line
            # has two independent places. In the roughest curve all values are independent places.
            error = math.asinh(goal.precision) / features.normal_deviate(goals.CONFIDENCE)
            smooth, rough = 2 / error**2, len(self._first) / error**2
            words.append(f"{goal} takes about {smooth:.0f} clogs of a curve as smooth as a straight line, {rough:.0f} of one "
                         f"that is new at each of the first {len(self._first)} values: {smooth * hours_per_run:.2g} to "
                         f"{rough * hours_per_run:.2g} core-hours in all if every run clogs")
        return words


def _informing(runs: pandas.DataFrame) -> tuple[pandas.DataFrame, Numbers]:
    """The values of the key with at least one droplet that has moved, and the places of these values on the curve."""
    runs = runs[(runs["distance"] > 0) & (runs["time"] > 0)]
    return runs, np.log(np.array(list(runs.index)))


def require_bounds(key: str, text: str, values: Sequence[float]) -> None:
    """Refuses a wrong list of values. @throws UserError  unless there are at least two increasing, positive values"""
    why = ""
    if any(math.isnan(value) for value in values):
        why = "refine needs numbers"
    elif len(values) < 2:
        why = "refine needs its bounds"
    elif any(one >= other for one, other in itertools.pairwise(values)):
        why = "values must increase: the lower bound comes first"
    elif values[0] <= 0:
        why = "refine works on logarithms: values must be positive"
    if why:
        raise UserError(f"invalid {key}={text} ({why}) try {key}=0.1,3")
