"""The statements of the article in its order: the place of each, its text, and how it is judged.

A judge gets the workshop with the sweeps of the figures. for_families() and for_walls() repeat it for each law of the
walls. A reason belongs to a verdict and is printed with it.
"""

from functools import partial

from ..paper.dilute import FAMILIES, MAPS, Family
from ..paper.workshop import Workshop
from . import lengths, passages, speeds
from .lengths import SLIDES
from .verdicts import (DOES_NOT, FITTED, IN_KIND, NOT_KNOWN, Judged, Statement, for_families, for_walls, judge,
                       the_version)

EXPONENT = ("4/3 is the exponent for a vertex; "
            "a droplet has a smaller one, because the wall slows only the nearest vertices")
NOT_PUBLISHED = "measurements are not published as numbers; tried: clogfit calibrate on simulated profiles"

STATEMENTS = [
    # Section 4.1, appendices A and B: passages through orifices, and the experiments
    Statement(
        "4.1, figure 2", "w = 0.4: A = 1.07 at h = 0.5",
        partial(passages.shape_at, h=0.5, published=1.07), ("2",),
        {IN_KIND: "the droplet is stretched more"}),
    Statement(
        "4.1, figure 2", "w = 0.4: A = 1.00 at h = -0.5, so the shape is not symmetric about the orifice",
        partial(passages.shape_at, h=-0.5, published=1.0), ("2",)),
    Statement(
        "4.1, figure 3", "w = 0.9: largest A = 1.014",
        partial(passages.largest_shape, orifice=0.9, published=1.014, tolerance=0.002), ("3",),
        {IN_KIND: "the droplet is stretched less"}),
    Statement(
        "4.1, figure 3", "w = 0.7: largest A = 1.093",
        partial(passages.largest_shape, orifice=0.7, published=1.093, tolerance=0.01), ("3",)),
    Statement(
        "4.1, figure 3", "w = 0.7: the first minimum of the speed is near h = -0.25",
        passages.first_minimum, ("3",)),
    Statement(
        "4.1, figure 3", "w = 0.7: the speed overshoots v_t near h = 0.3",
        passages.overshoots, ("3", "4"),
        {IN_KIND: "at another place",
         DOES_NOT: "at the published near-wall drag the speed peaks below v_t; with less drag it overshoots"}),
    Statement(
        "4.1, figure 3", "w = 0.7: a second minimum of the speed is near h = 0.5",
        passages.second_minimum, ("3",),
        {IN_KIND: "the minimum is nearer to the orifice"}),
    Statement(
        "4.1, figure 4", "w = 0.7: the overshoot shrinks as the tilt grows (Γ = 1.85, 1.11, 0.83)",
        passages.overshoot_shrinks, ("4",),
        {DOES_NOT: "the stiffest droplet does not pass, as the balance of forces predicts;"
                   " the softest stays below v_t"}),
    Statement(
        "appendix A, figure A1", "v_g/(v_t - v_g) grows as d^(4/3) of the distance from the wall",
        passages.drag_exponent, ("A1",),
        {IN_KIND: EXPONENT, DOES_NOT: EXPONENT}),
    Statement(
        "appendix B, figure B1", "speed profiles are noisy up to 64 vertices, smooth from 128 on",
        passages.profiles_are_smooth, ("B1",),
        {IN_KIND: "smooth only on finer meshes", DOES_NOT: "ripples shrink up to the finest mesh"}),
    Statement(
        "4.1", "Γ_exp = 0.57, 5.80, 3.47 for the three tilts and diameters",
        passages.tensions_of_experiments),
    Statement(
        "4.1", "V_t = 0.08, 0.028, 0.032 for the three terminal speeds",
        passages.speeds_of_experiments),
    Statement(
        "4.1", "Γ** = 1.7 ± 0.1 and 1.08 ± 0.09 follow from Γ* = 0.16 ± 0.01 by tilt and diameter",
        passages.tensions_scale),
    Statement(
        "4.1, figures 2, 3",
        "calibrated line tensions are 0.16 ± 0.01, 1.7 ± 0.1, 1.08 ± 0.09, a third of those of the experiments",
        passages.not_published, reasons={NOT_KNOWN: NOT_PUBLISHED}),
    Statement(
        "4.1, figures 2, 3", "calibrated near-wall drag is 0.06 to 0.2 and hardly depends on diameter and tilt",
        passages.not_published, reasons={NOT_KNOWN: NOT_PUBLISHED}),
    Statement(
        "4.1, figures 2, 3", "simulations deviate from experiments by 0.06 to 0.09 in speed, 0.004 to 0.01 in shape",
        passages.not_published, reasons={NOT_KNOWN: NOT_PUBLISHED}),
    Statement(
        "appendix B, figure B2", "the deviation from the experiment reaches a plateau for K_l/Γ below 0.01",
        passages.not_published, reasons={NOT_KNOWN: NOT_PUBLISHED}),
    Statement(
        "4.2, figure 5", "droplets wrap around obstacles and squeeze into gaps in experiments as in simulations",
        passages.not_published, reasons={NOT_KNOWN: NOT_PUBLISHED}),

    # Sections 4.2 and 5: clogging lengths in dilute arrays
    Statement(
        "4.2, figure 6c", "λ(Γ) is non-monotonic: it rises, peaks and falls",
        for_walls(lengths.is_not_monotonic), ("6c",),
        {IN_KIND: "not in every gap", DOES_NOT: SLIDES, NOT_KNOWN: "too few clogs"}),
    Statement(
        "4.2, figure 6c", "the peak moves to larger Γ as gaps widen",
        for_walls(lengths.peak_moves), ("6c",),
        {DOES_NOT: "no peak moves to larger Γ",
         NOT_KNOWN: "fewer than two curves have a peak, or the sign of the slope is uncertain"}),
    Statement(
        "4.2, figure 6c", "wrapping gives way to squeezing at larger Γ as gaps widen",
        for_walls(lengths.transition_moves), ("6c",),
        {IN_KIND: "the ranges of the narrowest and the widest gap overlap",
         DOES_NOT: "at no Γ are most clogs wrapped",
         NOT_KNOWN: "the branches meet in fewer than two gaps, or their ranges overlap"}),
    Statement(
        "4.2, figure 6a, b", "soft droplets clog by wrapping, stiff ones by squeezing",
        for_walls(lengths.two_mechanisms), ("6c",),
        {IN_KIND: "not in every gap", DOES_NOT: SLIDES, NOT_KNOWN: "too few clogs"}),
    Statement(
        "4.2, figure 6a", "wrapped clogs carry additional forces from neighbouring obstacles",
        for_families(lengths.neighbours_support), ("6c",),
        {IN_KIND: "most wrapped clogs are held only by the obstacles that they wrap",
         DOES_NOT: "wrapped clogs are held only by the obstacles that they wrap",
         NOT_KNOWN: SLIDES}),
    Statement(
        "4.2, figure 6c", "λ grows with the gap, right of the peak",
        for_walls(lengths.longer_in_wide_gaps), ("6c",),
        {IN_KIND: "at equal density λ of stiff droplets does not grow; at equal filling it grows for all droplets"
                  " (figure 6c-filling)",
         NOT_KNOWN: "too few clogs"}),
    Statement(
        "4, text", "at intermediate Γ droplets flow continuously",
        for_walls(lengths.flows_between), ("6c",),
        {IN_KIND: "not in every gap, or not only at intermediate Γ", DOES_NOT: "some clog at every Γ"}),
    Statement(
        "5", "hybrid clogs (wrapping and squeezing at once) occur where the two branches meet",
        for_walls(lengths.hybrids_between), ("6c",),
        {IN_KIND: "more often there than elsewhere, but not significantly",
         DOES_NOT: "not more often there than elsewhere",
         NOT_KNOWN: "the branches do not meet, or no clog is hybrid"}),

    # Other densities
    Statement(
        "5", "hybrid clogs depend on the density: dense arrays have more",
        for_walls(lengths.hybrids_in_dense_arrays, MAPS), ("map",),
        {IN_KIND: "dense arrays have more, but not significantly",
         DOES_NOT: "dense arrays do not have more",
         NOT_KNOWN: "no clog is hybrid"}),
    Statement(
        "4, text", "results are qualitatively similar over a wide range of densities: λ(Γ) has a peak",
        for_walls(lengths.similar_at_other_densities, MAPS), ("map",),
        {IN_KIND: "not at all densities", DOES_NOT: f"λ falls with Γ: {SLIDES}", NOT_KNOWN: "too few clogs"}),

    # Appendix C: single lengths
    Statement(
        "appendix C, figure C2", "λ = 24 ± 1 at Γ = 1.09 and a gap of 0.2",
        for_walls(lengths.published_length, [Family("survival", FAMILIES[0].name), *FAMILIES]), ("C2",),
        {FITTED: "the density was fitted to this length, with other seeds",
         IN_KIND: "the published density is unknown",
         DOES_NOT: "the published density is unknown",
         NOT_KNOWN: "no run clogged"}),
    Statement(
        "4.2, appendix C", "P(r) is exponential",
        lengths.is_exponential, ("C2",),
        {DOES_NOT: "λ is no longer than the release void, or the runs differ", NOT_KNOWN: "too few clogs"}),
    Statement(
        "appendix C, figure C1", "E_k of a droplet that clogs decays exponentially to the threshold",
        lengths.energy_decays, ("C1",)),

    # Figure 7: soft disks, and both models against the sag
    Statement(
        "4.2, figure 7a", "λ of soft disks falls monotonically with E_w",
        lengths.disks_fall_with_stiffness, ("7a",),
        {NOT_KNOWN: "too few clogs"}),
    Statement(
        "4.2, figure 7a", "λ of soft disks grows with the gap",
        lengths.disks_grow_with_gap, ("7a",),
        {IN_KIND: "at equal density λ of stiff disks does not grow", NOT_KNOWN: "too few clogs"}),
    Statement(
        "4.2, figure 7c", "λ against the sag is the same for disks and polygons below 0.25 σ",
        for_families(partial(lengths.compared, is_beyond=False)), ("7c",),
        {IN_KIND: "the lengths of disks and polygons separate at a smaller sag"}),
    Statement(
        "4.2, figure 7c", "λ against the sag differs between disks and polygons beyond 0.25 σ",
        for_families(partial(lengths.compared, is_beyond=True)), ("7c",),
        {NOT_KNOWN: "the softest polygon does not sink that far"}),
    Statement(
        "4.2, figure 7c", "λ of polygons tends to 0 at large sag",
        for_families(lengths.polygons_stop_at_once), ("7c",),
        {DOES_NOT: SLIDES,
         IN_KIND: "it falls, but not below a droplet's diameter",
         NOT_KNOWN: "the softest polygons do not differ"}),

    # Section 4.3, appendices D and E: mean speeds among obstacles
    Statement(
        "4.3, figure 8a", "the mean speed rises with Γ in gaps of 1 and wider",
        partial(speeds.speeds_rise, config="speed", parameter="obstacle_gap", name="gap"), ("8a",),
        {IN_KIND: "the speed has a maximum, then falls to the plateau",
         DOES_NOT: "walls do not slow soft droplets down"}),
    Statement(
        "4.3, figure 8a, b", "at large Γ the speed reaches a plateau set by the gap",
        speeds.plateau_by_gap, ("8a",)),
    Statement(
        "4.3, figure 8b", "at large Γ the speed does not depend on the obstacle diameter",
        speeds.plateau_by_diameter, ("8b",)),
    Statement(
        "4.3, figure 8b", "at small Γ droplets pass larger obstacles faster",
        speeds.soft_by_diameter, ("8b",),
        {NOT_KNOWN: "the difference is less than two standard errors, and 2.7 at the published size"
                    " (figure-8b-full.csv)"}),
    Statement(
        "4.3, text on figure 8a", "the speed is nearly constant at small Ca and falls at large Ca",
        speeds.speed_by_capillary_number, ("8ca",),
        {IN_KIND: "the speed is not constant at small Ca"}),
    Statement(
        "4.3, figure 9a", "the speed of soft disks falls with E_w",
        speeds.disks_fall_with_stiffness, ("9a",)),
    Statement(
        "4.3, figure 9a", "the speed of soft disks tends to v_t as E_w tends to 0",
        speeds.soft_disks_are_free, ("9a",),
        {IN_KIND: "the softest are not soft enough"}),
    Statement(
        "4.3, figure 9b", "stiff droplets of both models have the same speed",
        speeds.stiff_models_agree, ("9b",)),
    Statement(
        "4.3, figure 9b", "soft polygons are slower than soft disks",
        speeds.soft_models_differ, ("9b",)),
    Statement(
        "4.3, appendix D", "no droplet clogs in gaps wider than 1",
        speeds.nothing_clogs_in_wide_gaps, ("8a",),
        {IN_KIND: "few droplets do", DOES_NOT: "soft droplets hang over obstacles, held by corner pinning (`m`)"}),
    Statement(
        "appendix D, figure D", "r(t) is linear",
        speeds.displacement_is_linear, ("D",),
        {IN_KIND: "the softest droplet stops and goes"}),
    Statement(
        "appendix E, figure E", "near-wall drag slows droplets down",
        speeds.drag_slows_down, ("E",)),
    Statement(
        "appendix E, figure E", "the speed rises monotonically with Γ for every near-wall drag",
        partial(speeds.speeds_rise, config="near-wall-drag", parameter="near_wall_drag", name="b_0/b_∞"), ("E",),
        {IN_KIND: "the speed has a maximum"}),
]


def judge_all(shop: Workshop) -> tuple[list[Judged], int | None]:
    """Judges all statements.
    @param shop  a workshop that runs nothing
    @return the judged statements, and the model version of the sweeps, None without sweeps
    @throws UserError  if the sweeps have several model versions"""
    return [judge(shop, one) for one in STATEMENTS], the_version(shop.model_versions())
