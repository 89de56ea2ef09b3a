"""Section 4.2, appendix C: clogging lengths of polygons and disks."""

import math
from collections.abc import Callable, Iterable, Sequence

import numpy as np

from ..paper import dilute
from ..paper.arrays import sags
from ..paper.dilute import PUBLISHED, Family
from ..paper.workshop import Workshop
from ..tools.hints import Group
from .evidence import bounds, curves, fall_with_stiffness, falls, fisher_p_value, grow_with_gap, length_of, overall, shorter, trend
from .statements import AGREES, DOES_NOT, FITTED, IN_KIND, NOT_KNOWN, Finding, statement, statement_of_family, statement_of_walls


DENSITY = "the density of the published arrays is unknown, and λ depends on it"
BY_DENSITY = "the density was fitted to this length, with other seeds"


def peak(curve: Sequence[Group]) -> Group | None:
    """The highest of the points that lie clearly above one on their left and one on their right."""
    found = [point for i, point in enumerate(curve)
             if any(shorter(other, point) for other in curve[:i]) and any(shorter(other, point) for other in curve[i + 1:])]
    return max(found, key=dilute.known_length) if found else None


def peak_range(curve: Sequence[Group]) -> tuple[float, float]:
    """Range of line tensions where lambda may be longest: of the points that are not clearly below another."""
    candidates = [point["line_tension"] for point in curve if not any(shorter(point, other) for other in curve)]
    return min(candidates), max(candidates)


@statement_of_walls("4.2, figure 6c", "λ(Γ) is non-monotonic: it rises, peaks and falls",
                    does_not_agree="nothing holds a soft droplet that hangs over an obstacle; it slides off",
                    not_known="too few clogs")
def is_not_monotonic(groups: list[Group]) -> Finding:
    verdicts, words = [], []
    for gap, curve in curves(groups, "obstacle_gap").items():
        top = peak(curve)
        clogs_when_soft = curve[0]["clogs"] > 0
        verdicts.append(AGREES if top else DOES_NOT if falls(curve, shorter) and not clogs_when_soft else NOT_KNOWN)
        highest = top or max(curve, key=dilute.known_length)
        words.append(f"gap {gap:g}: {length_of(curve[0])} at {curve[0]['line_tension']:g}, {length_of(highest)} at {highest['line_tension']:g}, "
                     f"{length_of(curve[-1])} at {curve[-1]['line_tension']:g}")
    return Finding(overall(verdicts), "; ".join(words))


@statement_of_walls("4.2, figure 6c", "the peak moves to larger Γ as gaps widen",
                    in_kind="the peak's ranges for the narrowest and the widest gap overlap",
                    not_known="fewer than two curves have a peak, or their ranges overlap")
def peak_moves(groups: list[Group]) -> Finding:
    return grow_with_gap({gap: peak_range(curve) for gap, curve in curves(groups, "obstacle_gap").items() if peak(curve)})


def transition(curve: Sequence[Group]) -> tuple[float, float] | None:
    """The crossover of the branches: the largest line tension at which wrapped clogs prevail, the next at which squeezed ones do."""
    wrapped = [point["line_tension"] for point in curve if point["wrapped"] > point["squeezed"]]
    if not wrapped:
        return None
    squeezed = [point["line_tension"] for point in curve if point["squeezed"] > point["wrapped"] and point["line_tension"] > max(wrapped)]
    return (max(wrapped), min(squeezed)) if squeezed else None


@statement_of_walls("4.2, figure 6c", "wrapping gives way to squeezing at larger Γ as gaps widen",
                    does_not_agree="wrapped clogs nowhere prevail",
                    in_kind="the ranges for the narrowest and the widest gap overlap",
                    not_known="the branches meet in fewer than two gaps, or their ranges overlap")
def transition_moves(groups: list[Group]) -> Finding:
    found = {gap: range_ for gap, curve in curves(groups, "obstacle_gap").items() if (range_ := transition(curve))}
    if not found and sum(group["clogs"] for group in groups) >= 20:
        return Finding(DOES_NOT, f"{sum(group['wrapped'] for group in groups)} of {sum(group['clogs'] for group in groups)} clogs are wrapped")
    return grow_with_gap(found)


@statement_of_walls("4.2, figure 6a, b", "soft droplets clog by wrapping, stiff ones by squeezing",
                    in_kind="not in every gap", does_not_agree="soft droplets slide off")
def two_mechanisms(groups: list[Group]) -> Finding:
    verdicts, words = [], []
    for gap, curve in curves(groups, "obstacle_gap").items():
        soft, stiff = curve[0], curve[-1]
        words.append(f"gap {gap:g}: {soft['wrapped']} of {soft['clogs']} wrapped at {soft['line_tension']:g}, {stiff['squeezed']} of {stiff['clogs']} squeezed at {stiff['line_tension']:g}")
        if stiff["clogs"] > 0:
            right = 2 * stiff["squeezed"] > stiff["clogs"]
            left = 2 * soft["wrapped"] > soft["clogs"]
            verdicts.append(AGREES if left and right else DOES_NOT)
        else:
            verdicts.append(NOT_KNOWN)
    return Finding(overall(verdicts), "; ".join(words))


def grows_with_gap(groups: Iterable[Group], abscissa: str) -> Finding:
    longer, less, words = 0, 0, []
    for place, members in curves(groups, abscissa).items():
        members = sorted(members, key=lambda group: group["obstacle_gap"])
        if len(members) < 2:
            continue
        narrow, wide = members[0], members[-1]
        if shorter(narrow, wide) or shorter(wide, narrow):
            words.append(f"{length_of(narrow)} and {length_of(wide)} at {place:g}")
        longer += shorter(narrow, wide)
        less += shorter(wide, narrow)
    return Finding(trend(longer > 0, less > 0), "; ".join(words) or "no clear difference between the narrowest and the widest gap")


@statement_of_walls("4.2, figure 6c", "λ grows with the gap", in_kind="at some line tensions it shrinks",
                    not_known="too few clogs")
def longer_in_wide_gaps(groups: list[Group]) -> Finding:
    return grows_with_gap(groups, "line_tension")


@statement_of_walls("5", "hybrid clogs (wrapping and squeezing at once) occur where the two branches meet",
                    in_kind="more often there than elsewhere, but not significantly",
                    does_not_agree="not more often there than elsewhere",
                    not_known="the branches do not meet, or no clog is hybrid")
def hybrids_between(groups: list[Group]) -> Finding:
    inside, outside = np.zeros(2, int), np.zeros(2, int)
    for curve in curves(groups, "obstacle_gap").values():
        range_ = transition(curve)
        if range_ is None:
            continue
        for point in curve:
            count = inside if range_[0] <= point["line_tension"] <= range_[1] else outside
            count += [point["hybrid"], point["clogs"]]
    hybrid, clogs = (int(number) for number in inside)
    others, other_clogs = (int(number) for number in outside)
    words = f"{hybrid} of {clogs} where they meet, {others} of {other_clogs} elsewhere"
    if clogs == 0 or other_clogs == 0 or hybrid + others == 0:
        return Finding(NOT_KNOWN, words)
    p = fisher_p_value(hybrid, clogs, others, other_clogs)
    more = hybrid * other_clogs > others * clogs
    return Finding(AGREES if p < 0.05 else IN_KIND if more else DOES_NOT, f"{words}, p = {p:.2g}")


@statement_of_walls("appendix C", "λ = 24 ± 1 at Γ = 1.09 and a gap of 0.2",
                    fitted=BY_DENSITY, in_kind=DENSITY, does_not_agree=DENSITY)
def published_length(groups: list[Group]) -> Finding:
    found = [group for group in groups if all(math.isclose(group[name], PUBLISHED[name]) for name in ("line_tension", "obstacle_gap"))]
    return length_as_published(found)


def length_as_published(found: Sequence[Group]) -> Finding:
    if not found or found[0]["clogs"] == 0:
        return Finding(NOT_KNOWN, "no run clogged, or none of this line tension")
    low, high = bounds(found[0])
    least, most = (PUBLISHED["clogging_length"] + sign * PUBLISHED["error"] for sign in (-1, 1))
    verdict = FITTED if low <= most and high >= least else IN_KIND if low <= 2 * most and high >= least / 2 else DOES_NOT
    return Finding(verdict, f"{length_of(found[0])} at {found[0]['obstacle_density']:g} obstacles per σ²")


@statement("appendix C, figure C2", "λ = 24 ± 1 at Γ = 1.09 and a gap of 0.2", "C2",
           fitted=BY_DENSITY, in_kind=DENSITY, does_not_agree=DENSITY)
def length_of_survival(shop: Workshop) -> Finding:
    return length_as_published(shop.sweep("survival"))


def is_law_exponential(group: Group) -> Finding:
    if group["weibull_shape"] is None or group["weibull_p_value"] is None:
        return Finding(NOT_KNOWN, f"{group['clogs']} clogs")
    verdict = NOT_KNOWN if group["clogs"] < dilute.ENOUGH_CLOGS else AGREES if group["weibull_p_value"] >= 0.05 else DOES_NOT
    return Finding(verdict, f"Weibull's shape {group['weibull_shape']:.2f} of {group['clogs']} clogs, p = {group['weibull_p_value']:.2g}")


@statement("4.2, appendix C", "P(r) is exponential", "C2",
           does_not_agree="λ is no longer than the release void, or the runs differ")
def is_exponential(shop: Workshop) -> Finding:
    return is_law_exponential(shop.sweep("survival")[0])


# Figure 7: soft disks, and both models over the sag

@statement("4.2, figure 7a", "λ of soft disks falls monotonically with E_w", "7a")
def disks_are_monotonic(shop: Workshop) -> Finding:
    return fall_with_stiffness(curves(shop.sweep("clogging-sp"), "obstacle_gap"), shorter, length_of)


@statement("4.2, figure 7a", "λ of soft disks grows with the gap", "7a", not_known="too few clogs")
def disks_travel_farther_in_wide_gaps(shop: Workshop) -> Finding:
    return grows_with_gap(shop.sweep("clogging-sp"), "wall_stiffness")


APART = 0.25  # the published sag beyond which the models differ
ALIKE = 2.0  # factor within which lengths are alike


def compared(shop: Workshop, family: Family) -> list[tuple[float, float, bool]]:
    """Polygons and disks of the same sag, gap 0.2.

    @return for each polygon its sag, the ratio of its clogging length to that of a disk, and whether the two are the same: their
    intervals overlap, or they differ by less than ALIKE. Lower bounds count as lengths.
    """
    def curve(config: str, groups: Sequence[Group]) -> list[tuple[float, Group]]:
        chosen = [group for group in groups if math.isclose(group["obstacle_gap"], 0.2)]
        return sorted(zip(sags(shop, config, chosen), chosen), key=lambda point: point[0])

    disks = curve("clogging-sp", shop.sweep("clogging-sp"))
    polygons = curve(family.config, family.of(shop.sweep(family.config)))
    logs = [math.log(sag) for sag, _ in disks]

    def of_disk(sag: float, number: Callable[[Group], float]) -> float:
        return math.exp(np.interp(math.log(sag), logs, [math.log(min(number(group), 1e12)) for _, group in disks]))

    found = []
    for sag, polygon in polygons:
        if not disks[0][0] <= sag <= disks[-1][0]:
            continue
        ratio = dilute.known_length(polygon) / of_disk(sag, dilute.known_length)
        low, high = bounds(polygon)
        overlap = low <= of_disk(sag, lambda group: bounds(group)[1]) and high >= of_disk(sag, lambda group: bounds(group)[0])
        found.append((sag, ratio, overlap or 1 / ALIKE <= ratio <= ALIKE))
    return found


def over_the_sag(is_beyond: bool) -> Callable[[Workshop, Family], Finding]:
    def judge(shop: Workshop, family: Family) -> Finding:
        points = [point for point in compared(shop, family) if (point[0] > APART) == is_beyond]
        words = ", ".join(f"{ratio:.2g} at {sag:.3f}" for sag, ratio, _ in points)
        if not points:
            return Finding(NOT_KNOWN, "no polygon of such a sag")
        right = [is_alike != is_beyond for *_, is_alike in points]
        return Finding(AGREES if all(right) else IN_KIND if any(right) else DOES_NOT, f"polygon/disk ratio at each sag: {words}")

    return judge


statement_of_family("4.2, figure 7c", "λ against the sag is the same for disks and polygons below 0.25 σ", "7c", over_the_sag(is_beyond=False),
                    in_kind="they separate at a smaller sag", not_known="no polygon of such a sag")
statement_of_family("4.2, figure 7c", "λ against the sag differs between disks and polygons beyond 0.25 σ", "7c", over_the_sag(is_beyond=True),
                    not_known="the softest polygon does not sink that far")
