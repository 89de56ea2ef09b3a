"""Judges statements of the article (Cheng et al.), sections 4.2 and 5 and appendix C: on clogging lengths of polygons
and disks."""

import math
from collections.abc import Callable, Iterable, Sequence

import numpy as np
from scipy import stats

from ..curves import features, model, points
from ..paper import arrays, dilute
from ..paper.dilute import PUBLISHED, Family
from ..paper.runner import Runner
from ..tools import rounded
from ..tools.hints import Group, Numbers
from .evidence import LEAST_LINEARITY, bounds, curves, fall_with_stiffness, falls, length_of, overall, shorter, trend
from .verdicts import AGREES, DOES_NOT, FITTED, IN_KIND, NOT_KNOWN, Finding

SLIDES = "nothing holds a soft droplet that hangs over an obstacle, so the droplet slides off"
CONFIDENCE = 0.95


def peak(curve: Sequence[Group]) -> Group | None:
    """The peak of a curve, or None. A point can be the peak only if it is clearly above at least one point on each
    side. The peak is the highest of these points."""
    found = [point for i, point in enumerate(curve)
             if any(shorter(other, point) for other in curve[:i])
             and any(shorter(other, point) for other in curve[i + 1:])]
    return max(found, key=dilute.known_length) if found else None


def shape(curve: Sequence[Group]) -> str:
    """The verdict on whether a curve is non-monotonic. A curve without a peak counts as monotonic only if it clearly
    falls and its softest droplets do not clog."""
    return AGREES if peak(curve) else DOES_NOT if falls(curve, shorter) and curve[0]["clogs"] == 0 else NOT_KNOWN


def is_not_monotonic(groups: list[Group]) -> Finding:
    by_gap = curves(groups, "obstacle_gap")
    verdicts = [shape(curve) for curve in by_gap.values()]
    gap, curve = next(iter(by_gap.items()))
    highest = peak(curve) or max(curve, key=dilute.known_length)
    lengths = ", ".join(f"{length_of(point)} at {point['line_tension']:g}" for point in (curve[0], highest, curve[-1]))
    return Finding(overall(verdicts),
                   f"peak in {verdicts.count(AGREES)} of {len(verdicts)} gaps; gap {gap:g}: {lengths}")


def peak_draws(curve: Sequence[Group], seed: int) -> tuple[features.Peak, Numbers]:
    """Fits the curve. @return the fitted peak, and log Gamma_peak of each curve that is drawn from the posterior
    @param seed  a different seed for each gap, so that the draws of different gaps are independent"""
    known = model.Points(np.log([[group["line_tension"]] for group in curve]),
                         *(np.array([group[name] for group in curve], float) for name in ("clogs", "total_distance")))
    places = points.grid_over(known.places)
    fitted = model.fit_curve(known, places)
    tops, _ = features.tops(features.drawn_curves(fitted, seed=seed), places)
    return features.find_peak(fitted, places, CONFIDENCE), tops[:, 0]


def peak_moves(groups: list[Group]) -> Finding:
    """Fits a straight line to log Gamma_peak against the gap for each posterior draw. The verdict depends on the
    fraction of draws with a slope of zero or below."""
    by_gap = curves([group for group in groups if group["total_distance"]], "obstacle_gap")
    found = {gap: peak_draws(curve, seed) for seed, (gap, curve) in enumerate(by_gap.items(), 1)
             if sum(group["clogs"] > 0 for group in curve) >= points.FEWEST_CLOGGING}
    inside = {gap: one for gap, one in found.items() if one[0].probability_inside >= CONFIDENCE}
    tensions = {gap: np.exp([one.place[0], one.place_lower[0], one.place_upper[0]]) for gap, (one, _) in inside.items()}
    words = "; ".join(f"gap {gap:g}: {rounded.with_interval(*interval)}" for gap, interval in tensions.items())
    if len(inside) < 2:
        return Finding(NOT_KNOWN if inside else DOES_NOT, words or "no peak in the range")
    slopes = np.polyfit(list(inside), np.array([draws for _, draws in inside.values()]), 1)[0]
    share = float(np.mean(slopes <= 0))
    verdict = AGREES if share <= 1 - CONFIDENCE else DOES_NOT if share >= CONFIDENCE else NOT_KNOWN
    return Finding(verdict, f"peaks at {words}; no move to larger Γ in {100 * share:.2g} % of draws from the fit")


def transition(curve: Sequence[Group]) -> tuple[float, float] | None:
    """The range of line tensions in which squeezed clogs replace wrapped clogs. The range begins at the largest line
    tension at which more clogs are wrapped than squeezed, and ends at the next line tension at which more clogs are
    squeezed than wrapped."""
    wrapped = max((point["line_tension"] for point in curve if point["wrapped"] > point["squeezed"]), default=math.inf)
    squeezed = [point["line_tension"] for point in curve
                if point["squeezed"] > point["wrapped"] and point["line_tension"] > wrapped]
    return (wrapped, min(squeezed)) if squeezed else None


def transition_moves(groups: list[Group]) -> Finding:
    """Judges whether the range of transition() is at larger line tensions in the widest gap than in the narrowest
    gap."""
    found = {gap: range_ for gap, curve in curves(groups, "obstacle_gap").items() if (range_ := transition(curve))}
    wrapped, clogs = (sum(group[name] for group in groups) for name in ("wrapped", "clogs"))
    if len(found) < 2:
        return Finding(DOES_NOT if not found and clogs >= 20 else NOT_KNOWN, f"{wrapped} of {clogs} clogs are wrapped")
    (low, high), *_, (last_low, last_high) = found.values()
    if last_low > high:
        verdict = AGREES
    elif last_high < low:
        verdict = DOES_NOT
    else:
        verdict = IN_KIND if last_low * last_high > low * high else NOT_KNOWN
    return Finding(verdict, "; ".join(f"gap {gap:g}: between {first:g} and {second:g}"
                                      for gap, (first, second) in found.items()))


def two_mechanisms(groups: list[Group]) -> Finding:
    ends = [(curve[0], curve[-1]) for curve in curves(groups, "obstacle_gap").values()]
    verdicts, counted = [], []
    for soft, stiff in ends:
        as_published = 2 * soft["wrapped"] > soft["clogs"] and 2 * stiff["squeezed"] > stiff["clogs"]
        verdicts.append(NOT_KNOWN if stiff["clogs"] == 0 else AGREES if as_published else DOES_NOT)
    for of_end, mechanism in zip(zip(*ends), ("wrapped", "squeezed")):
        held, clogs = (sum(point[name] for point in of_end) for name in (mechanism, "clogs"))
        counted.append(f"{held} of {clogs} {mechanism} at {of_end[0]['line_tension']:g}")
    return Finding(overall(verdicts), ", ".join(counted))


LEAST_HELP = 0.01  # A neighbouring obstacle that bears a smaller fraction of the support does not count.


def neighbours_support(runner: Runner, family: Family) -> Finding:
    runner.sweep(family.config)
    rows = runner.rows(family.config)
    support = rows.wrapped_support[(rows.mechanism == "wrapped") & np.isclose(rows.friction, family.friction)]
    if support.empty:
        return Finding(NOT_KNOWN, "no wrapped clog")
    helped = int((support <= 1 - LEAST_HELP).sum())
    share = helped / len(support)
    return Finding(AGREES if share > 0.5 else IN_KIND if share >= 0.1 else DOES_NOT,
                   f"neighbours bear {LEAST_HELP:.0%} of the support or more in {helped} of {len(support)} wrapped"
                   f" clogs, "
                   f"{1 - support.median():.1%} in the median")


def grows_with_gap(groups: Iterable[Group], abscissa: str, beyond: float = 0.0) -> Finding:
    """Judges whether lambda is longer in the widest gap than in the narrowest gap, at every abscissa larger than
    `beyond`. An abscissa is excluded if no droplet clogs there in either gap."""
    verdicts, words = {}, []
    for place, members in curves(groups, abscissa).items():
        members = sorted(members, key=lambda group: group["obstacle_gap"])
        narrow, wide = members[0], members[-1]
        if place <= beyond or len(members) < 2 or narrow["clogs"] + wide["clogs"] == 0:
            continue
        verdicts[place] = trend(shorter(narrow, wide), shorter(wide, narrow))
        if verdicts[place] != NOT_KNOWN:
            words.append(f"{length_of(narrow)} and {length_of(wide)} at {place:g}")
    if words:
        words[0] = f"narrowest and widest gap: {words[0]}"
    alike = [f"{place:g}" for place, verdict in verdicts.items() if verdict == NOT_KNOWN]
    if alike:
        words.append(f"no clear difference at {', '.join(alike)}")
    found = set(verdicts.values())
    verdict = IN_KIND if len(found) > 1 and AGREES in found else overall(list(verdicts.values()))
    return Finding(verdict, "; ".join(words))


def longer_in_wide_gaps(groups: list[Group]) -> Finding:
    tops = [top["line_tension"] for curve in curves(groups, "obstacle_gap").values() if (top := peak(curve))]
    return grows_with_gap(groups, "line_tension", max(tops, default=0.0))


def flows_between(groups: list[Group]) -> Finding:
    """Judges whether there is a line tension at which no droplet clogs, although some droplets clog at smaller line
    tensions and some at larger ones."""
    verdicts, words = [], []
    for gap, curve in curves(groups, "obstacle_gap").items():
        free = [i for i, point in enumerate(curve) if point["clogs"] == 0]
        between = [i for i in free
                   if any(point["clogs"] for point in curve[:i]) and any(point["clogs"] for point in curve[i:])]
        verdicts.append(AGREES if between else IN_KIND if free else DOES_NOT)
        tensions = ", ".join(f"{curve[i]['line_tension']:g}" for i in free)
        words.append(f"gap {gap:g}: " + (f"none clogs at {tensions}" if free else "some clog at every Γ"))
    return Finding(overall(verdicts), "; ".join(words))


def hybrids_between(groups: list[Group]) -> Finding:
    ranges = {gap: range_ for gap, curve in curves(groups, "obstacle_gap").items() if (range_ := transition(curve))}
    known = [group for group in groups if group["obstacle_gap"] in ranges]

    def is_inside(group: Group) -> bool:
        first, last = ranges[group["obstacle_gap"]]
        return bool(first <= group["line_tension"] <= last)

    return more_hybrids(known, is_inside, "where the branches meet")


def more_hybrids(groups: Sequence[Group], is_inside: Callable[[Group], bool], where: str) -> Finding:
    inside = [group for group in groups if is_inside(group)]
    outside = [group for group in groups if not is_inside(group)]
    hybrids, clogs = (sum(group[name] for group in inside) for name in ("hybrid", "clogs"))
    other_hybrids, other_clogs = (sum(group[name] for group in outside) for name in ("hybrid", "clogs"))
    words = f"hybrid clogs: {hybrids} of {clogs} {where}, {other_hybrids} of {other_clogs} elsewhere"
    if clogs == 0 or other_clogs == 0:
        return Finding(NOT_KNOWN, words)
    counts = [[hybrids, clogs - hybrids], [other_hybrids, other_clogs - other_hybrids]]
    p = stats.fisher_exact(counts, alternative="greater")[1]
    fewer = stats.fisher_exact(counts, alternative="less")[1]
    most = stats.binomtest(hybrids + other_hybrids, clogs + other_clogs).proportion_ci(0.95, "exact").high
    return Finding(AGREES if p < 0.05 else DOES_NOT if fewer < 0.05 else NOT_KNOWN,
                   f"{words}, p = {p:.2g}; below {most:.1%} of all clogs")


def hybrids_in_dense_arrays(groups: list[Group]) -> Finding:
    published = PUBLISHED["obstacle_density"]
    return more_hybrids(groups, lambda group: bool(group["obstacle_density"] > published),
                        f"beyond {published:g} obstacles per σ²")


def similar_at_other_densities(groups: list[Group]) -> Finding:
    verdicts, words = [], []
    for is_saturated, density in sorted({dilute.density_key(group) for group in groups}):
        members = [group for group in groups if dilute.density_key(group) == (is_saturated, density)]
        of_gaps = [shape(curve) for curve in curves(members, "obstacle_gap").values()]
        verdicts.append(overall(of_gaps))
        arrays_of = "in saturated arrays" if is_saturated else f"at {density:g} obstacles per σ²"
        words.append(f"{of_gaps.count(AGREES)} of {len(of_gaps)} gaps {arrays_of}")
    return Finding(overall(verdicts), "peak in " + ", ".join(words))


def published_length(groups: list[Group]) -> Finding:
    found = [group for group in groups
             if all(math.isclose(group[name], PUBLISHED[name]) for name in ("line_tension", "obstacle_gap"))]
    if not found or found[0]["clogs"] == 0:
        return Finding(NOT_KNOWN, "no run clogged, or none of this line tension")
    low, high = bounds(found[0])
    least, most = (PUBLISHED["clogging_length"] + sign * PUBLISHED["error"] for sign in (-1, 1))
    fits, is_near = low <= most and high >= least, low <= 2 * most and high >= least / 2
    return Finding(FITTED if fits else IN_KIND if is_near else DOES_NOT,
                   f"{length_of(found[0])} at {found[0]['obstacle_density']:g} obstacles per σ²")


def is_exponential(runner: Runner) -> Finding:
    group = runner.sweep("survival")[0]
    if group["clogs"] < dilute.ENOUGH_CLOGS or group["weibull_p_value"] is None:
        return Finding(NOT_KNOWN, f"{group['clogs']} clogs")
    return Finding(AGREES if group["weibull_p_value"] >= 0.05 else DOES_NOT,
                   f"Weibull's shape is {group['weibull_shape']:.2f} for {group['clogs']} clogs, "
                   f"p = {group['weibull_p_value']:.2g}")


def energy_decays(runner: Runner) -> Finding:
    """Judges how well a straight line fits ln E_k at the end of the run, after E_k has fallen to 1e10 times the clog's
    threshold."""
    run = arrays.energies(runner)[0.3]
    if run.word("status") != "clogged":
        return Finding(DOES_NOT, f"the droplet is {run.word('status')}")
    energy = run.table["kinetic_energy_ratio"]
    tail = np.arange(len(energy)) > np.flatnonzero(energy > 1e10 * run.row["clog_energy"]).max(initial=0)
    r_squared = stats.linregress(run.table["time"][tail], np.log(energy[tail])).rvalue ** 2
    decades = np.log10(energy[tail].max() / energy[tail].min())
    return Finding(AGREES if r_squared >= LEAST_LINEARITY else DOES_NOT,
                   f"R² = {r_squared:.4f} of ln E_k over {decades:.0f} decades")


def disks_fall_with_stiffness(runner: Runner) -> Finding:
    return fall_with_stiffness(curves(runner.sweep("clogging-sp"), "obstacle_gap"), shorter, length_of)


def disks_grow_with_gap(runner: Runner) -> Finding:
    return grows_with_gap(runner.sweep("clogging-sp"), "wall_stiffness")


def disks_diverge(runner: Runner) -> Finding:
    """Judges whether the softest disks of every gap travel without a clog."""
    softest = [min(curve, key=lambda group: group["wall_stiffness"])
               for curve in curves(runner.sweep("clogging-sp"), "obstacle_gap").values()]
    verdicts = [DOES_NOT if group["clogs"] else AGREES if bounds(group)[0] > LONG else NOT_KNOWN for group in softest]
    return Finding(overall(verdicts), ", ".join(f"gap {group['obstacle_gap']:g}: {length_of(group)}"
                                                for group in softest))


LONG = 1e4  # Longer lengths are 1e4 to 1e5 times the length of stiff droplets.
APART = 0.25  # Largest sag at which the models agree, according to the article.
ALIKE = 2.0  # Two lengths are alike if their ratio is at most this.


def over_the_sag(runner: Runner, config: str, groups: Sequence[Group]) -> list[tuple[float, Group]]:
    chosen = [group for group in groups if math.isclose(group["obstacle_gap"], 0.2)]
    return sorted(zip(arrays.sags(runner, config, chosen), chosen), key=lambda point: point[0])


def compared(runner: Runner, family: Family, is_beyond: bool) -> Finding:
    """Compares the lengths of polygons with those of disks that have the same sag. With `is_beyond` the sags are larger
    than APART, and the lengths should differ. Without `is_beyond` the sags are smaller, and the lengths should agree.
    Lengths agree if their intervals overlap, or if their ratio is at most ALIKE. If no droplet clogged, the lower bound
    replaces the length."""
    disks = over_the_sag(runner, "clogging-sp", runner.sweep("clogging-sp"))
    logs = [math.log(sag) for sag, _ in disks]

    def of_disk(sag: float, number: Callable[[Group], float]) -> float:
        return math.exp(np.interp(math.log(sag), logs, [math.log(min(number(group), 1e12)) for _, group in disks]))

    right, words = [], []
    for sag, polygon in over_the_sag(runner, family.config, family.of(runner.sweep(family.config))):
        if disks[0][0] <= sag <= disks[-1][0] and (sag > APART) == is_beyond:
            ratio = dilute.known_length(polygon) / of_disk(sag, dilute.known_length)
            low, high = bounds(polygon)
            disk_low = of_disk(sag, lambda group: bounds(group)[0])
            disk_high = of_disk(sag, lambda group: bounds(group)[1])
            overlap = low <= disk_high and high >= disk_low
            right.append((overlap or 1 / ALIKE <= ratio <= ALIKE) != is_beyond)
            words.append(f"{ratio:.2g} at {sag:.3f}")
    verdict = NOT_KNOWN if not right else AGREES if all(right) else IN_KIND if any(right) else DOES_NOT
    ratios = f"polygon/disk ratio of λ at each sag: {', '.join(words)}"
    return Finding(verdict, ratios if words else "no polygon has such a sag")


def polygons_stop_at_once(runner: Runner, family: Family) -> Finding:
    curve = over_the_sag(runner, family.config, family.of(runner.sweep(family.config)))
    (last_sag, softest), (top_sag, longest) = curve[-1], max(curve, key=lambda point: dilute.known_length(point[1]))
    if bounds(softest)[1] < 1:
        verdict = AGREES
    elif shorter(softest, longest):
        verdict = IN_KIND
    else:
        verdict = DOES_NOT if softest["clogs"] == 0 else NOT_KNOWN
    return Finding(verdict, f"{length_of(longest)} at a sag of {top_sag:.2f}, {length_of(softest)} at {last_sag:.2f}")
