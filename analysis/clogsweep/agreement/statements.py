"""The statements of the article (Cheng et al.) in the article's order. Each has its place in the article, its text, and
a judge.

A judge gets the runner with the sweeps of the figures. for_families() and for_walls() call a judge once for each law of
the walls. A reason belongs to a verdict and is printed with it.
"""

from functools import partial

from ..paper.dilute import FAMILIES, MAPS, Family
from ..paper.runner import Runner
from . import frames, lengths, passages, speeds
from .lengths import SLIDES
from .verdicts import (DOES_NOT, FITTED, IN_KIND, NOT_KNOWN, Judged, Statement, for_contacts, for_families, for_walls,
                       judge, the_version)

EXPONENT = ("4/3 is the exponent for a vertex; a droplet has a smaller one, because the wall slows only the nearest"
            " vertices; a vertex exponent of 11/6 gives 1.31 to 1.36 for a droplet near one wall")
# The model, interface and contact of a verdict. Variants have others.
CHANNEL, SURFACE = "robust, contact at half a vertex's distance (published)", "robust, contact at the surface"
ROBUST, ELASTIC, DISK = "robust, no friction", "elastic, no friction", "soft disk"
SPRINGS = "elastic, contact at the surface, and literal, contact at half a vertex's distance"
FORMULA, NOTHING = "published numbers", "-"
CLOSE_SHAPE = "within 0.01, the published deviation of shapes; within 0.04 qualitatively"
CLOSE_PLACE = "within 0.1 σ; within 0.4 σ qualitatively"
MOST_GAPS = "in every gap; not in every gap: qualitatively; not known in most gaps: not known"
NOT_PUBLISHED = "measurements are not published as numbers; tried: clogfit calibrate on simulated profiles"

STATEMENTS = [
    # Section 4.1, appendices A and B: passages through orifices, and the experiments
    Statement(
        "4.1, figure 2", "w = 0.4: A = 1.07 at h = 0.5",
        CHANNEL,
        CLOSE_SHAPE,
        for_contacts(passages.shape_at, h=0.5, published=1.07), ("2",),
        {IN_KIND: "the droplet is stretched more"}),
    Statement(
        "4.1, figure 2", "w = 0.4: A = 1.00 at h = -0.5, so the shape is not symmetric about the orifice",
        CHANNEL,
        CLOSE_SHAPE,
        for_contacts(passages.shape_at, h=-0.5, published=1.0), ("2",)),
    Statement(
        "4.1, figure 3", "w = 0.9: largest A = 1.014",
        CHANNEL,
        "within 0.002; within 0.008 qualitatively",
        for_contacts(passages.largest_shape, orifice=0.9, published=1.014, tolerance=0.002), ("3",),
        {IN_KIND: "the droplet is stretched less"}),
    Statement(
        "4.1, figure 3", "w = 0.7: largest A = 1.093",
        CHANNEL,
        CLOSE_SHAPE,
        for_contacts(passages.largest_shape, orifice=0.7, published=1.093, tolerance=0.01), ("3",)),
    Statement(
        "4.1, figure 3", "w = 0.7: the first minimum of the speed is near h = -0.25",
        CHANNEL,
        CLOSE_PLACE,
        for_contacts(passages.first_minimum), ("3",)),
    Statement(
        "4.1, figure 3", "w = 0.7: the speed overshoots v_t near h = 0.3",
        CHANNEL,
        f"a peak above v_t, and for its place: {CLOSE_PLACE}",
        for_contacts(passages.overshoots), ("3", "4"),
        {IN_KIND: "at another place",
         DOES_NOT: "the cutoff of the near-wall drag, which is not published, decides: peaks of 0.70 v_t with"
                   " 0.00614 σ,"
                   " of 1.00 v_t with 0.06 σ"}),
    Statement(
        "4.1, figure 3", "w = 0.7: a second minimum of the speed is near h = 0.5",
        CHANNEL,
        f"a minimum behind the peak, and for its place: {CLOSE_PLACE}",
        for_contacts(passages.second_minimum), ("3",),
        {IN_KIND: "the minimum is nearer to the orifice"}),
    Statement(
        "4.1, figure 4", "w = 0.7: the overshoot shrinks as the tilt grows (Γ = 1.85, 1.11, 0.83)",
        SURFACE,
        "all three droplets pass, and their peaks are above v_t and in the published order",
        passages.overshoot_shrinks, ("4",),
        {DOES_NOT: "the stiffest droplet does not pass, as the balance of forces predicts;"
                   " the softest stays below v_t"}),
    Statement(
        "appendix A, figure A1", "v_g/(v_t - v_g) grows as d^(4/3) of the distance from the wall",
        SURFACE,
        "within 0.05 or two standard errors of 4/3; four times this qualitatively",
        passages.drag_exponent, ("A1",),
        {IN_KIND: EXPONENT, DOES_NOT: EXPONENT}),
    Statement(
        "appendix B, figure B1", "speed profiles are noisy up to 64 vertices, smooth from 128 on",
        SURFACE,
        "from 128 vertices on, droplets pass and profiles ripple by at most 0.02 v_t about that of the finest mesh;"
        " those of coarser meshes ripple more, qualitatively also less",
        passages.profiles_are_smooth, ("B1",),
        {IN_KIND: "the profiles of coarse meshes are smooth up to where the droplet stops"}),
    Statement(
        "4.1", "Γ_exp = 0.57, 5.80, 3.47 for the three tilts and diameters",
        FORMULA,
        "within 6 %, the error of Γ*; within 30 % qualitatively",
        passages.tensions_of_experiments),
    Statement(
        "4.1", "V_t = 0.08, 0.028, 0.032 for the three terminal speeds",
        FORMULA,
        "within 7 %; within 30 % qualitatively",
        passages.speeds_of_experiments),
    Statement(
        "4.1", "Γ** = 1.7 ± 0.1 and 1.08 ± 0.09 follow from Γ* = 0.16 ± 0.01 by tilt and diameter",
        FORMULA,
        "both within two combined errors; one of them qualitatively",
        passages.tensions_scale),
    Statement(
        "4.1, figures 2, 3",
        "calibrated line tensions are 0.16 ± 0.01, 1.7 ± 0.1, 1.08 ± 0.09, a third of those of the experiments",
        NOTHING,
        "needs the measured profiles",
        passages.not_published, reasons={NOT_KNOWN: NOT_PUBLISHED}),
    Statement(
        "4.1, figures 2, 3", "calibrated near-wall drag is 0.06 to 0.2 and hardly depends on diameter and tilt",
        NOTHING,
        "needs the measured profiles",
        passages.not_published, reasons={NOT_KNOWN: NOT_PUBLISHED}),
    Statement(
        "4.1, figures 2, 3", "simulations deviate from experiments by 0.06 to 0.09 in speed, 0.004 to 0.01 in shape",
        NOTHING,
        "needs the measured profiles",
        passages.not_published, reasons={NOT_KNOWN: NOT_PUBLISHED}),
    Statement(
        "appendix B, figure B2", "the deviation from the experiment reaches a plateau for K_l/Γ below 0.01",
        SPRINGS,
        "profiles for K_l/Γ below 0.01 differ by at most twice 0.08, the deviation of each from the"
        " experiment",
        passages.springs_reach_a_plateau, ("B2",),
        {DOES_NOT: "two profiles that are 0.08 from one experiment differ by at most 0.16"}),
    Statement(
        "4.2, figure 5", "droplets wrap around obstacles and squeeze into gaps in experiments as in simulations",
        NOTHING,
        "needs the measured outlines",
        passages.not_published, reasons={NOT_KNOWN: NOT_PUBLISHED}),
    Statement(
        "4.1, figures 2, 3", "Γ**/Γ_exp = 0.28, 0.29, 0.31 for the three experiments",
        FORMULA,
        "within 2 %; within 30 % qualitatively",
        passages.calibrated_to_measured),
    Statement(
        "4.1, figure 4", "Γ = 1.85, 1.11, 0.83 are inversely proportional to the sine of the tilt",
        FORMULA,
        "products within 2 %; within 30 % qualitatively",
        passages.tension_times_tilt),
    Statement(
        "4.1", "shapes deviate much less than speeds: Δ_A is much smaller than Δ_v",
        "elastic, contact at the surface",
        "Δ_A/Δ_v is at most 0.2 for every pair of springs; below 1 qualitatively",
        passages.shapes_deviate_less, ("B2",)),
    Statement(
        "4.3, text", "a wrapped droplet unwraps when one of its ends moves against the drive",
        "elastic, a droplet over a post",
        "one end rises by 0.5 σ or more while the droplet slides off; by 0.05 σ qualitatively",
        frames.unwraps_against_the_drive, ("W3",)),
    Statement(
        "5", "droplets wrap and squeeze at once while they flow",
        "robust and elastic, saturated arrays, a gap of 0.3",
        "in 1 % or more of the frames in which droplets move, they wrap an obstacle (over more than 180°) and fill a"
        " gap between two others; in any frame qualitatively",
        frames.hybrids_flow),

    # Sections 4.2 and 5: clogging lengths in dilute arrays
    Statement(
        "4.2, figure 6c", "λ(Γ) is non-monotonic: it rises, peaks and falls",
        ROBUST,
        f"a point of each curve is clearly above one on its left and one on its right; {MOST_GAPS}",
        for_walls(lengths.is_not_monotonic), ("6c",),
        {IN_KIND: "not in every gap", DOES_NOT: SLIDES, NOT_KNOWN: "too few clogs"}),
    Statement(
        "4.2, figure 6c", "the peak moves to larger Γ as gaps widen",
        ROBUST,
        "two curves or more have a peak, and log Γ_peak falls with the gap in at most 5 % of draws from the fits;"
        " does not agree from 95 % on",
        for_walls(lengths.peak_moves), ("6c",),
        {DOES_NOT: "no peak moves to larger Γ",
         NOT_KNOWN: "fewer than two curves have a peak, or the sign of the slope is uncertain"}),
    Statement(
        "4.2, figure 6c", "wrapping gives way to squeezing at larger Γ as gaps widen",
        ROBUST,
        "the ranges of Γ in which squeezed clogs replace wrapped ones do not overlap in the narrowest and the"
        " widest gap",
        for_walls(lengths.transition_moves), ("6c",),
        {IN_KIND: "the ranges of the narrowest and the widest gap overlap",
         DOES_NOT: "at no Γ are most clogs wrapped",
         NOT_KNOWN: "the branches meet in fewer than two gaps, or their ranges overlap"}),
    Statement(
        "4.2, figure 6a, b", "soft droplets clog by wrapping, stiff ones by squeezing",
        ROBUST,
        f"more than half of the clogs of the softest droplets are wrapped, and of the stiffest squeezed; {MOST_GAPS}",
        for_walls(lengths.two_mechanisms), ("6c",),
        {IN_KIND: "not in every gap", DOES_NOT: SLIDES, NOT_KNOWN: "too few clogs"}),
    Statement(
        "4.2, figure 6a", "wrapped clogs carry additional forces from neighbouring obstacles",
        ROBUST,
        "neighbours bear 1 % of the support or more in more than half of the wrapped clogs; in a tenth of them"
        " qualitatively",
        for_families(lengths.neighbours_support), ("6c",),
        {IN_KIND: "most wrapped clogs are held only by the obstacles that they wrap",
         DOES_NOT: "nearly all wrapped clogs are held only by the obstacles that they wrap",
         NOT_KNOWN: SLIDES}),
    Statement(
        "4.2, figure 6c", "λ grows with the gap, right of the peak",
        ROBUST,
        "clearly longer in the widest gap than in the narrowest, at every Γ beyond the peaks; at some qualitatively",
        for_walls(lengths.longer_in_wide_gaps), ("6c",),
        {IN_KIND: "at equal density λ of stiff droplets does not grow; at equal filling it grows for all droplets"
                  " (figure 6c-filling)",
         NOT_KNOWN: "too few clogs"}),
    Statement(
        "4, text", "at intermediate Γ droplets flow continuously",
        ROBUST,
        f"no run clogs at some Γ between two at which some clog; {MOST_GAPS}",
        for_walls(lengths.flows_between), ("6c",),
        {IN_KIND: "not in every gap, or not only at intermediate Γ", DOES_NOT: "some clog at every Γ"}),
    Statement(
        "5", "hybrid clogs (wrapping and squeezing at once) occur where the two branches meet",
        ROBUST,
        "their fraction is larger there with p < 0.05 (Fisher's exact test); smaller with p < 0.05: does not agree",
        for_walls(lengths.hybrids_between), ("6c",),
        {DOES_NOT: "less often there than elsewhere",
         NOT_KNOWN: "the branches do not meet, or too few clogs are hybrid"}),

    # Other densities
    Statement(
        "5", "hybrid clogs depend on the density: dense arrays have more",
        ROBUST,
        "their fraction is larger beyond 0.35 obstacles per σ² with p < 0.05 (Fisher's exact test); smaller with p"
        " < 0.05: does not agree",
        for_walls(lengths.hybrids_in_dense_arrays, MAPS), ("map",),
        {DOES_NOT: "dense arrays have fewer", NOT_KNOWN: "too few clogs are hybrid"}),
    Statement(
        "4, text", "results are qualitatively similar over a wide range of densities: λ(Γ) has a peak",
        ROBUST,
        f"each curve has a clear peak; {MOST_GAPS}, for gaps and densities",
        for_walls(lengths.similar_at_other_densities, MAPS), ("map",),
        {IN_KIND: "not at all densities", DOES_NOT: f"λ falls with Γ: {SLIDES}", NOT_KNOWN: "too few clogs"}),

    # Appendix C: single lengths
    Statement(
        "appendix C, figure C2", "λ = 24 ± 1 at Γ = 1.09 and a gap of 0.2",
        ROBUST,
        "by construction if the interval meets 23 to 25, to which the density was fitted; within a factor of 2"
        " qualitatively",
        for_walls(lengths.published_length, [Family("survival", FAMILIES[0].name), *FAMILIES]), ("C2",),
        {FITTED: "the density was fitted to this length, with other seeds",
         IN_KIND: "the published density is unknown: ± 1 is less than the sampling error of 50 droplets, 3.4, with"
                  " which it is"
                  " 0.30 to 0.40",
         DOES_NOT: "the published density is unknown",
         NOT_KNOWN: "no run clogged"}),
    Statement(
        "4.2, appendix C", "P(r) is exponential",
        ROBUST,
        "Weibull's shape is compatible with 1 (p >= 0.05), with 10 clogs or more",
        lengths.is_exponential, ("C2",),
        {DOES_NOT: "λ is no longer than the release void, or the runs differ", NOT_KNOWN: "too few clogs"}),
    Statement(
        "appendix C, figure C1", "E_k of a droplet that clogs decays exponentially to the threshold",
        ROBUST,
        "ln E_k against t is a straight line: R² >= 0.99",
        lengths.energy_decays, ("C1",)),

    # Figure 7: soft disks, and both models against the sag
    Statement(
        "4.2, figure 7a", "λ of soft disks falls monotonically with E_w",
        DISK,
        f"some point is clearly above one on its right, none clearly below; {MOST_GAPS}",
        lengths.disks_fall_with_stiffness, ("7a",),
        {NOT_KNOWN: "too few clogs"}),
    Statement(
        "4.2, figure 7a", "λ of soft disks grows with the gap",
        DISK,
        "clearly longer in the widest gap than in the narrowest, at every stiffness with clogs; at some qualitatively",
        lengths.disks_grow_with_gap, ("7a",),
        {IN_KIND: "at equal density λ of stiff disks does not grow", NOT_KNOWN: "too few clogs"}),
    Statement(
        "4.2, figure 7c", "λ against the sag is the same for disks and polygons below 0.25 σ",
        ROBUST,
        "intervals overlap, or the ratio is at most 2, at every sag below 0.25 σ; at some qualitatively",
        for_families(partial(lengths.compared, is_beyond=False)), ("7c",),
        {IN_KIND: "the lengths of disks and polygons separate at a smaller sag"}),
    Statement(
        "4.2, figure 7c", "λ against the sag differs between disks and polygons beyond 0.25 σ",
        ROBUST,
        "no overlap and a ratio beyond 2, at every sag beyond 0.25 σ; at some qualitatively",
        for_families(partial(lengths.compared, is_beyond=True)), ("7c",),
        {NOT_KNOWN: "the softest polygon does not sink that far"}),
    Statement(
        "4.2, figure 7c", "λ of polygons tends to 0 at large sag",
        ROBUST,
        "the interval of the softest is below σ; clearly shorter than the longest qualitatively",
        for_families(lengths.polygons_stop_at_once), ("7c",),
        {DOES_NOT: SLIDES,
         IN_KIND: "it falls, but not below a droplet's diameter",
         NOT_KNOWN: "the softest polygons do not differ"}),
    Statement(
        "4.2, figure 7c", "λ of disks diverges at large sag",
        DISK,
        "no clog of the softest disks, and a lower bound beyond 10,000 σ; in every gap",
        lengths.disks_diverge, ("7a",),
        {NOT_KNOWN: "the bound is too low"}),

    # Section 4.3, appendices D and E: mean speeds among obstacles
    Statement(
        "4.3, figure 8a", "the mean speed rises with Γ in gaps of 1 and wider",
        ROBUST,
        f"some speed is clearly below a later one (two standard errors), none clearly above; both: qualitatively;"
        f" {MOST_GAPS}",
        for_families(speeds.speeds_rise_among_walls, speeds.WALLS), ("8a",),
        {IN_KIND: "the speed has a maximum, then falls to the plateau",
         DOES_NOT: "walls do not slow soft droplets down"}),
    Statement(
        "4.3, figure 8a, b", "at large Γ the speed reaches a plateau set by the gap",
        ELASTIC,
        "the stiffest droplets are clearly faster in the widest gap than in the narrowest (two standard errors)",
        speeds.plateau_by_gap, ("8a",)),
    Statement(
        "4.3, figure 8b", "at large Γ the speed does not depend on the obstacle diameter",
        ELASTIC,
        "no two of the stiffest droplets differ by two standard errors",
        speeds.plateau_by_diameter, ("8b",)),
    Statement(
        "4.3, figure 8b", "at small Γ droplets pass larger obstacles faster",
        ELASTIC,
        "the softest droplets are faster at the largest diameter than at the smallest, by two standard errors",
        speeds.soft_by_diameter, ("8b",),
        {NOT_KNOWN: "the difference is less than two standard errors"}),
    Statement(
        "4.3, text on figure 8a", "the speed is nearly constant at small Ca and falls at large Ca",
        ELASTIC,
        f"speeds below Ca = 1 differ by less than 0.05, and the speed falls clearly; {MOST_GAPS}",
        speeds.speed_by_capillary_number, ("8ca",),
        {IN_KIND: "the speed is not constant at small Ca"}),
    Statement(
        "4.3, figure 9a", "the speed of soft disks falls with E_w",
        DISK,
        f"some speed is clearly above a later one (two standard errors), none clearly below; {MOST_GAPS}",
        speeds.disks_fall_with_stiffness, ("9a",)),
    Statement(
        "4.3, figure 9a", "the speed of soft disks tends to v_t as E_w tends to 0",
        DISK,
        f"within 0.02 v_t; within 0.08 qualitatively; {MOST_GAPS}",
        speeds.soft_disks_are_free, ("9a",),
        {IN_KIND: "the softest are not soft enough"}),
    Statement(
        "4.3, figure 9a", "the speed of soft disks grows with the gap",
        DISK,
        "faster in the widest gap than in the narrowest by two standard errors, at every stiffness; at some"
        " qualitatively",
        speeds.disks_are_faster_in_wide_gaps, ("9a",)),
    Statement(
        "4.3, figure 9b", "stiff droplets of both models have the same speed",
        ELASTIC,
        "the stiffest differ by less than two standard errors",
        speeds.stiff_models_agree, ("9b",)),
    Statement(
        "4.3, figure 9b", "soft polygons are slower than soft disks",
        ELASTIC,
        "the softest polygon is slower than the softest disk by two standard errors",
        speeds.soft_models_differ, ("9b",)),
    Statement(
        "4.3, appendix D", "no droplet clogs in gaps wider than 1",
        ELASTIC,
        "no run clogs; up to 5 % qualitatively",
        speeds.nothing_clogs_in_wide_gaps, ("8a",),
        {IN_KIND: "few droplets do", DOES_NOT: "soft droplets hang over obstacles, held by corner pinning (`m`)"}),
    Statement(
        "appendix D, figure D", "r(t) is linear",
        ELASTIC,
        "R² >= 0.99 for every Γ; for some qualitatively",
        speeds.displacement_is_linear, ("D",),
        {IN_KIND: "the softest droplet stops and goes"}),
    Statement(
        "appendix E, figure E", "near-wall drag slows droplets down",
        ELASTIC,
        "slower with the strongest drag than without, by two standard errors, at every Γ; at some qualitatively",
        speeds.drag_slows_down, ("E",)),
    Statement(
        "appendix E, figure E", "the speed rises monotonically with Γ for every near-wall drag",
        ELASTIC,
        "some speed is clearly below a later one (two standard errors), none clearly above; both: qualitatively",
        partial(speeds.speeds_rise, config="near-wall-drag", parameter="near_wall_drag", name="b_0/b_∞"), ("E",),
        {IN_KIND: "the speed has a maximum"}),
]


def judge_all(runner: Runner) -> tuple[list[Judged], int | None]:
    """Judges all statements.
    @param runner  a runner that runs nothing
    @return the judged statements, and the model version of the sweeps, None without sweeps
    @throws UserError  if the sweeps have several model versions"""
    return [judge(runner, one) for one in STATEMENTS], the_version(runner.model_versions())
