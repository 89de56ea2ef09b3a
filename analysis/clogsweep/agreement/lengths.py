"""Judges statements of sections 4.2 and 5 and of appendix C, on clogging lengths of polygons and disks."""

import math
from collections.abc import Callable, Iterable, Sequence

import numpy as np
from scipy import stats

from ..curves import features, model, points
from ..paper import arrays, dilute
from ..paper.dilute import FAMILIES, MAPS, PUBLISHED, Family
from ..paper.workshop import Workshop
from ..tools import rounded
from ..tools.hints import Group, Numbers
from .evidence import LEAST_LINEARITY, bounds, curves, fall_with_stiffness, falls, length_of, overall, shorter, trend
from .statements import AGREES, DOES_NOT, FITTED, IN_KIND, NOT_KNOWN, Finding, statement, statement_of_families, statement_of_walls

SLIDES = "nothing holds a soft droplet that hangs over an obstacle, so the droplet slides off"
CONFIDENCE = 0.95


def peak(curve: Sequence[Group]) -> Group | None:
    """The highest point among those that are clearly above some point on their left and some point on their right."""
    found = [point for i, point in enumerate(curve)
             if any(shorter(other, point) for other in curve[:i]) and any(shorter(other, point) for other in curve[i + 1:])]
    return max(found, key=dilute.known_length) if found else None


def shape(curve: Sequence[Group]) -> str:
    """The verdict on whether a curve is non-monotonic. A curve without a peak counts as monotonic only if it clearly
    falls and its softest droplets do not clog."""
    return AGREES if peak(curve) else DOES_NOT if falls(curve, shorter) and curve[0]["clogs"] == 0 else NOT_KNOWN


@statement_of_walls("4.2, figure 6c", "λ(Γ) is non-monotonic: it rises, peaks and falls",
                    in_kind="not in every gap", does_not_agree=SLIDES, not_known="too few clogs")
def is_not_monotonic(groups: list[Group]) -> Finding:
    by_gap = curves(groups, "obstacle_gap")
    verdicts = [shape(curve) for curve in by_gap.values()]
    gap, curve = next(iter(by_gap.items()))
    highest = peak(curve) or max(curve, key=dilute.known_length)
    return Finding(overall(verdicts), f"peak in {verdicts.count(AGREES)} of {len(verdicts)} gaps; gap {gap:g}: "
                   + ", ".join(f"{length_of(point)} at {point['line_tension']:g}" for point in (curve[0], highest, curve[-1])))


def peak_draws(curve: Sequence[Group], seed: int) -> tuple[features.Peak, Numbers]:
    """Fits the curve. @return the fitted peak, and log Gamma_peak of each curve that is drawn from the posterior
    @param seed  a different seed for each gap, so that the draws of different gaps are independent"""
    known = model.Points(np.log([[group["line_tension"]] for group in curve]), *(np.array([group[name] for group in curve], float) for name in ("clogs", "total_distance")))
    places = points.grid_over(known.places)
    fitted = model.fit_curve(known, places)
    return features.find_peak(fitted, places, CONFIDENCE), features.tops(features.drawn_curves(fitted, seed=seed), places)[0][:, 0]


@statement_of_walls("4.2, figure 6c", "the peak moves to larger Γ as gaps widen",
                    does_not_agree="no peak moves to larger Γ", not_known="fewer than two curves have a peak, or the sign of the slope is uncertain")
def peak_moves(groups: list[Group]) -> Finding:
    """Fits a straight line to log Gamma_peak against the gap for each posterior draw. The fraction of draws in which
    the slope is zero or negative decides the verdict."""
    by_gap = curves([group for group in groups if group["total_distance"]], "obstacle_gap")
    found = {gap: peak_draws(curve, seed) for seed, (gap, curve) in enumerate(by_gap.items(), 1)
             if sum(group["clogs"] > 0 for group in curve) >= points.FEWEST_CLOGGING}
    inside = {gap: one for gap, one in found.items() if one[0].probability_inside >= CONFIDENCE}
    words = "; ".join(f"gap {gap:g}: {rounded.with_interval(*np.exp([one.place[0], one.place_lower[0], one.place_upper[0]]))}" for gap, (one, _) in inside.items())
    if len(inside) < 2:
        return Finding(NOT_KNOWN if inside else DOES_NOT, words or "no peak in the range")
    slopes = np.polyfit(list(inside), np.array([draws for _, draws in inside.values()]), 1)[0]
    share = float(np.mean(slopes <= 0))
    verdict = AGREES if share <= 1 - CONFIDENCE else DOES_NOT if share >= CONFIDENCE else NOT_KNOWN
    return Finding(verdict, f"peaks at {words}; no move to larger Γ in {100 * share:.2g} % of draws from the fit")


def transition(curve: Sequence[Group]) -> tuple[float, float] | None:
    """The range of line tensions in which squeezed clogs replace wrapped ones. The range begins at the largest line
    tension at which more clogs are wrapped than squeezed. It ends at the next line tension at which more clogs are
    squeezed than wrapped."""
    wrapped = max((point["line_tension"] for point in curve if point["wrapped"] > point["squeezed"]), default=math.inf)
    squeezed = [point["line_tension"] for point in curve if point["squeezed"] > point["wrapped"] and point["line_tension"] > wrapped]
    return (wrapped, min(squeezed)) if squeezed else None


@statement_of_walls("4.2, figure 6c", "wrapping gives way to squeezing at larger Γ as gaps widen", in_kind="the ranges of the narrowest and the widest gap overlap",
                    does_not_agree="at no Γ are most clogs wrapped", not_known="the branches meet in fewer than two gaps, or their ranges overlap")
def transition_moves(groups: list[Group]) -> Finding:
    """Judges whether the range of transition() lies at larger line tensions in the widest gap than in the narrowest
    gap."""
    found = {gap: range_ for gap, curve in curves(groups, "obstacle_gap").items() if (range_ := transition(curve))}
    wrapped, clogs = (sum(group[name] for group in groups) for name in ("wrapped", "clogs"))
    if len(found) < 2:
        return Finding(DOES_NOT if not found and clogs >= 20 else NOT_KNOWN, f"{wrapped} of {clogs} clogs are wrapped")
    (low, high), *_, (last_low, last_high) = found.values()
    verdict = AGREES if last_low > high else DOES_NOT if last_high < low else IN_KIND if last_low * last_high > low * high else NOT_KNOWN
    return Finding(verdict, "; ".join(f"gap {gap:g}: between {first:g} and {second:g}" for gap, (first, second) in found.items()))


@statement_of_walls("4.2, figure 6a, b", "soft droplets clog by wrapping, stiff ones by squeezing",
                    in_kind="not in every gap", does_not_agree=SLIDES, not_known="too few clogs")
def two_mechanisms(groups: list[Group]) -> Finding:
    ends = [(curve[0], curve[-1]) for curve in curves(groups, "obstacle_gap").values()]
    verdicts = [NOT_KNOWN if stiff["clogs"] == 0 else AGREES if 2 * soft["wrapped"] > soft["clogs"] and 2 * stiff["squeezed"] > stiff["clogs"] else DOES_NOT
                for soft, stiff in ends]
    counted = [f"{sum(point[mechanism] for point in of_end)} of {sum(point['clogs'] for point in of_end)} {mechanism} at {of_end[0]['line_tension']:g}"
               for of_end, mechanism in zip(zip(*ends), ("wrapped", "squeezed"))]
    return Finding(overall(verdicts), ", ".join(counted))


@statement_of_families("4.2, figure 6a", "wrapped clogs carry additional forces from neighbouring obstacles",
                       in_kind="most wrapped clogs are held only by the obstacles that they wrap", does_not_agree="wrapped clogs are held only by the obstacles that they wrap", not_known=SLIDES)
def neighbours_support(shop: Workshop, family: Family) -> Finding:
    shop.sweep(family.config)
    rows = shop.rows(family.config)
    support = rows.wrapped_support[(rows.mechanism == "wrapped") & np.isclose(rows.friction, family.friction)]
    helped = int((support < 0.999).sum())
    verdict = NOT_KNOWN if support.empty else DOES_NOT if helped == 0 else AGREES if 2 * helped > len(support) else IN_KIND
    return Finding(verdict, f"{helped} of {len(support)} wrapped clogs, neighbours bear {1 - support.median():.1%} of the support in the median" if len(support) else "no wrapped clog")


def grows_with_gap(groups: Iterable[Group], abscissa: str, beyond: float = 0.0) -> Finding:
    """Judges whether lambda is longer in the widest gap than in the narrowest gap, at every abscissa larger than
    `beyond`. An abscissa at which no droplet clogs in either gap does not count."""
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
    verdict = overall(list(verdicts.values()))
    return Finding(IN_KIND if verdict == AGREES and alike else verdict, "; ".join(words + ([f"no clear difference at {', '.join(alike)}"] if alike else [])))


@statement_of_walls("4.2, figure 6c", "λ grows with the gap, right of the peak",
                    in_kind="at equal density λ of stiff droplets does not grow; at equal filling it grows for all droplets (figure 6c-filling)", not_known="too few clogs")
def longer_in_wide_gaps(groups: list[Group]) -> Finding:
    tops = [top["line_tension"] for curve in curves(groups, "obstacle_gap").values() if (top := peak(curve))]
    return grows_with_gap(groups, "line_tension", max(tops, default=0.0))


@statement_of_walls("4, text", "at intermediate Γ droplets flow continuously", in_kind="not in every gap, or not only at intermediate Γ", does_not_agree="some clog at every Γ")
def flows_between(groups: list[Group]) -> Finding:
    """Judges whether there is a line tension at which no droplet clogs, although some clog at smaller and at larger
    line tensions."""
    verdicts, words = [], []
    for gap, curve in curves(groups, "obstacle_gap").items():
        free = [i for i, point in enumerate(curve) if point["clogs"] == 0]
        between = [i for i in free if any(point["clogs"] for point in curve[:i]) and any(point["clogs"] for point in curve[i:])]
        verdicts.append(AGREES if between else IN_KIND if free else DOES_NOT)
        words.append(f"gap {gap:g}: " + (f"none clogs at {', '.join(format(curve[i]['line_tension'], 'g') for i in free)}" if free else "some clog at every Γ"))
    return Finding(overall(verdicts), "; ".join(words))


@statement_of_walls("5", "hybrid clogs (wrapping and squeezing at once) occur where the two branches meet",
                    in_kind="more often there than elsewhere, but not significantly", does_not_agree="not more often there than elsewhere",
                    not_known="the branches do not meet, or no clog is hybrid")
def hybrids_between(groups: list[Group]) -> Finding:
    ranges = {gap: range_ for gap, curve in curves(groups, "obstacle_gap").items() if (range_ := transition(curve))}
    known = [group for group in groups if group["obstacle_gap"] in ranges]
    return more_hybrids(known, lambda group: ranges[group["obstacle_gap"]][0] <= group["line_tension"] <= ranges[group["obstacle_gap"]][1], "where the branches meet")


def more_hybrids(groups: Sequence[Group], is_inside: Callable[[Group], bool], where: str) -> Finding:
    inside, outside = (np.array([[group["hybrid"], group["clogs"]] for group in groups if is_inside(group) == side] or [[0, 0]]).sum(axis=0).tolist() for side in (True, False))
    words = f"hybrid clogs: {inside[0]} of {inside[1]} {where}, {outside[0]} of {outside[1]} elsewhere"
    if inside[1] == 0 or outside[1] == 0 or inside[0] + outside[0] == 0:
        return Finding(NOT_KNOWN, words)
    p = stats.fisher_exact([[hits, number - hits] for hits, number in (inside, outside)], alternative="greater")[1]
    more = inside[0] * outside[1] > outside[0] * inside[1]
    return Finding(AGREES if p < 0.05 else IN_KIND if more else DOES_NOT, f"{words}, p = {p:.2g}")


# The map: other densities

@statement_of_walls("5", "hybrid clogs depend on the density: dense arrays have more", "map", MAPS, in_kind="dense arrays have more, but not significantly",
                    does_not_agree="dense arrays do not have more", not_known="no clog is hybrid")
def hybrids_in_dense_arrays(groups: list[Group]) -> Finding:
    return more_hybrids(groups, lambda group: group["obstacle_density"] > PUBLISHED["obstacle_density"], f"beyond {PUBLISHED['obstacle_density']:g} obstacles per σ²")


@statement_of_walls("4, text", "results are qualitatively similar over a wide range of densities: λ(Γ) has a peak", "map", MAPS,
                    in_kind="not at all densities", does_not_agree="λ falls with Γ: " + SLIDES, not_known="too few clogs")
def similar_at_other_densities(groups: list[Group]) -> Finding:
    verdicts, words = [], []
    for is_saturated, density in sorted({dilute.density_key(group) for group in groups}):
        members = [group for group in groups if dilute.density_key(group) == (is_saturated, density)]
        of_gaps = [shape(curve) for curve in curves(members, "obstacle_gap").values()]
        verdicts.append(overall(of_gaps))
        words.append(f"{of_gaps.count(AGREES)} of {len(of_gaps)} gaps " + ("in saturated arrays" if is_saturated else f"at {density:g} obstacles per σ²"))
    return Finding(overall(verdicts), "peak in " + ", ".join(words))


# Single lengths

@statement_of_walls("appendix C, figure C2", "λ = 24 ± 1 at Γ = 1.09 and a gap of 0.2", "C2", [Family("survival", FAMILIES[0].name), *FAMILIES],
                    fitted="the density was fitted to this length, with other seeds", in_kind="the published density is unknown", does_not_agree="the published density is unknown", not_known="no run clogged")
def published_length(groups: list[Group]) -> Finding:
    found = [group for group in groups if all(math.isclose(group[name], PUBLISHED[name]) for name in ("line_tension", "obstacle_gap"))]
    if not found or found[0]["clogs"] == 0:
        return Finding(NOT_KNOWN, "no run clogged, or none of this line tension")
    low, high = bounds(found[0])
    least, most = (PUBLISHED["clogging_length"] + sign * PUBLISHED["error"] for sign in (-1, 1))
    verdict = FITTED if low <= most and high >= least else IN_KIND if low <= 2 * most and high >= least / 2 else DOES_NOT
    return Finding(verdict, f"{length_of(found[0])} at {found[0]['obstacle_density']:g} obstacles per σ²")


@statement("4.2, appendix C", "P(r) is exponential", "C2",
           does_not_agree="λ is no longer than the release void, or the runs differ", not_known="too few clogs")
def is_exponential(shop: Workshop) -> Finding:
    group = shop.sweep("survival")[0]
    if group["clogs"] < dilute.ENOUGH_CLOGS or group["weibull_p_value"] is None:
        return Finding(NOT_KNOWN, f"{group['clogs']} clogs")
    return Finding(AGREES if group["weibull_p_value"] >= 0.05 else DOES_NOT,
                   f"Weibull's shape is {group['weibull_shape']:.2f} for {group['clogs']} clogs, p = {group['weibull_p_value']:.2g}")


@statement("appendix C, figure C1", "E_k of a droplet that clogs decays exponentially to the threshold", "C1")
def energy_decays(shop: Workshop) -> Finding:
    """Judges how well a straight line fits ln E_k at the end of the run, after E_k has fallen to 1e10 times the clog's
    threshold."""
    run = arrays.energies(shop)[0.3]
    if run.word("status") != "clogged":
        return Finding(DOES_NOT, f"the droplet is {run.word('status')}")
    energy = run.table["kinetic_energy_ratio"]
    tail = np.arange(len(energy)) > np.flatnonzero(energy > 1e10 * run.row["clog_energy"]).max(initial=0)
    r_squared = stats.linregress(run.table["time"][tail], np.log(energy[tail])).rvalue ** 2
    return Finding(AGREES if r_squared >= LEAST_LINEARITY else DOES_NOT, f"R² = {r_squared:.4f} of ln E_k over {np.log10(energy[tail].max() / energy[tail].min()):.0f} decades")


# Figure 7: soft disks, and both models against the sag

statement("4.2, figure 7a", "λ of soft disks falls monotonically with E_w", "7a", not_known="too few clogs")(
    lambda shop: fall_with_stiffness(curves(shop.sweep("clogging-sp"), "obstacle_gap"), shorter, length_of))
statement("4.2, figure 7a", "λ of soft disks grows with the gap", "7a", in_kind="at equal density λ of stiff disks does not grow", not_known="too few clogs")(
    lambda shop: grows_with_gap(shop.sweep("clogging-sp"), "wall_stiffness"))

APART = 0.25  # The article says that the models differ if the sag is larger than this.
ALIKE = 2.0  # Lengths with a larger ratio than this are not alike.


def over_the_sag(shop: Workshop, config: str, groups: Sequence[Group]) -> list[tuple[float, Group]]:
    chosen = [group for group in groups if math.isclose(group["obstacle_gap"], 0.2)]
    return sorted(zip(arrays.sags(shop, config, chosen), chosen), key=lambda point: point[0])


def compared(shop: Workshop, family: Family, is_beyond: bool) -> Finding:
    """Compares the lengths of polygons with those of disks with the same sag. With `is_beyond` the sags are larger than
    APART, and the lengths should differ; otherwise the sags are smaller, and the lengths should agree. Lengths agree if
    their intervals overlap, or if their ratio is at most ALIKE. If no droplet clogged, the lower bound serves as the
    length."""
    disks = over_the_sag(shop, "clogging-sp", shop.sweep("clogging-sp"))
    logs = [math.log(sag) for sag, _ in disks]

    def of_disk(sag: float, number: Callable[[Group], float]) -> float:
        return math.exp(np.interp(math.log(sag), logs, [math.log(min(number(group), 1e12)) for _, group in disks]))

    right, words = [], []
    for sag, polygon in over_the_sag(shop, family.config, family.of(shop.sweep(family.config))):
        if disks[0][0] <= sag <= disks[-1][0] and (sag > APART) == is_beyond:
            ratio = dilute.known_length(polygon) / of_disk(sag, dilute.known_length)
            low, high = bounds(polygon)
            overlap = low <= of_disk(sag, lambda group: bounds(group)[1]) and high >= of_disk(sag, lambda group: bounds(group)[0])
            right.append((overlap or 1 / ALIKE <= ratio <= ALIKE) != is_beyond)
            words.append(f"{ratio:.2g} at {sag:.3f}")
    verdict = NOT_KNOWN if not right else AGREES if all(right) else IN_KIND if any(right) else DOES_NOT
    return Finding(verdict, f"polygon/disk ratio of λ at each sag: {', '.join(words)}" if words else "no polygon has such a sag")


statement_of_families("4.2, figure 7c", "λ against the sag is the same for disks and polygons below 0.25 σ", "7c", in_kind="the lengths of disks and polygons separate at a smaller sag")(
    lambda shop, family: compared(shop, family, is_beyond=False))
statement_of_families("4.2, figure 7c", "λ against the sag differs between disks and polygons beyond 0.25 σ", "7c", not_known="the softest polygon does not sink that far")(
    lambda shop, family: compared(shop, family, is_beyond=True))


@statement_of_families("4.2, figure 7c", "λ of polygons tends to 0 at large sag", "7c", does_not_agree=SLIDES, in_kind="it falls, but not below a droplet's diameter",
                       not_known="the softest polygons do not differ")
def polygons_stop_at_once(shop: Workshop, family: Family) -> Finding:
    curve = over_the_sag(shop, family.config, family.of(shop.sweep(family.config)))
    (last_sag, softest), (top_sag, longest) = curve[-1], max(curve, key=lambda point: dilute.known_length(point[1]))
    verdict = AGREES if bounds(softest)[1] < 1 else IN_KIND if shorter(softest, longest) else DOES_NOT if softest["clogs"] == 0 else NOT_KNOWN
    return Finding(verdict, f"{length_of(longest)} at a sag of {top_sag:.2f}, {length_of(softest)} at {last_sag:.2f}")
