"""Judges statements of section 4.1 and of appendices A and B, on measured quantities and on passages through channels.
Nothing in such a passage is random, so there are no confidence intervals."""

import math
from typing import Any

import numpy as np
from scipy.signal import find_peaks

from ..paper import channels
from ..paper.workshop import Workshop
from ..tools import rounded
from .evidence import by_tolerance
from .statements import AGREES, DOES_NOT, IN_KIND, NOT_KNOWN, Finding, statement


def shape_at(shop: Workshop, h: float, published: float) -> Finding:
    way = channels.narrow(shop).table
    shape = float(np.interp(h, way["h"], way["shape_parameter"]))
    return Finding(by_tolerance(shape, published, 0.015), f"{shape:.3f}")


def largest_shape(shop: Workshop, orifice: float, published: float, tolerance: float) -> Finding:
    row = channels.passage(shop, orifice).row
    return Finding(by_tolerance(row["largest_shape_parameter"], published, tolerance), f"{row['largest_shape_parameter']:.3f}, {row['status'].decode()}")


statement("4.1, figure 2", "w = 0.4: A = 1.07 at h = 0.5", "2", in_kind="the droplet is stretched more")(lambda shop: shape_at(shop, 0.5, 1.07))
statement("4.1, figure 2", "w = 0.4: A = 1.00 at h = -0.5, so the shape is not symmetric about the orifice", "2")(lambda shop: shape_at(shop, -0.5, 1.0))
statement("4.1, figure 3", "w = 0.9: largest A = 1.014", "3", in_kind="the droplet is stretched less")(lambda shop: largest_shape(shop, 0.9, 1.014, 0.002))
statement("4.1, figure 3", "w = 0.7: largest A = 1.093", "3")(lambda shop: largest_shape(shop, 0.7, 1.093, 0.01))


@statement("4.1, figure 3", "w = 0.7: the first minimum of the speed is near h = -0.25", "3")
def first_minimum(shop: Workshop) -> Finding:
    h = slowest_before(channels.passage(shop, 0.7).table)
    return Finding(by_tolerance(h, -0.25, 0.1), f"{h:.2f}")


def slowest_before(way: Any) -> float:
    """The position at which the droplet is slowest, within one diameter before the orifice. Farther upstream the
    droplet still accelerates from rest."""
    before = way[(way["h"] > -1) & (way["h"] < 0)]
    return float(before["h"][np.argmin(before["speed_ratio"])])


def top_behind(way: Any) -> Any:
    """The point behind the orifice at which the speed has its peak, or None if the droplet does not pass. Only the
    first 0.6 diameters count: farther away a slow droplet approaches v_t."""
    behind = way[(way["h"] > 0) & (way["h"] < 0.6)]
    peaks, found = find_peaks(behind["speed_ratio"], prominence=0)
    return behind[peaks[np.argmax(found["prominences"])]] if way["h"][-1] > 0.6 and len(peaks) else None


def tops_of_speeds(shop: Workshop, orifice: float) -> tuple[list[float], str]:
    """The largest speeds of the droplets of figure 4 that pass, and a text about all droplets of this figure."""
    tops = {tension: top_behind(run.table) for tension, run in channels.overshooting(shop, orifice).items()}
    words = [f"the droplet of {tension:g} does not pass" if top is None else f"{top['speed_ratio']:.2f} at {tension:g}" for tension, top in tops.items()]
    return [top["speed_ratio"] for top in tops.values() if top is not None], f"w = {orifice:g}, b_0/b_∞ = {channels.OVERSHOOTS[orifice]:g}: {', '.join(words)}"


@statement("4.1, figure 3", "w = 0.7: the speed overshoots v_t near h = 0.3", "3", "4", in_kind="at another place",
           does_not_agree="at the published near-wall drag the speed peaks below v_t; with less drag it overshoots")
def overshoots(shop: Workshop) -> Finding:
    top = top_behind(channels.passage(shop, 0.7).table)
    if top is None:
        return Finding(DOES_NOT, "the droplet does not pass")
    verdict = DOES_NOT if top["speed_ratio"] <= 1 else by_tolerance(top["h"], 0.3, 0.1)
    return Finding(verdict, f"{top['speed_ratio']:.2f} at h = {top['h']:.2f}", tops_of_speeds(shop, 0.7)[1])


@statement("4.1, figure 3", "w = 0.7: a second minimum of the speed is near h = 0.5", "3", in_kind="the minimum is nearer to the orifice")
def second_minimum(shop: Workshop) -> Finding:
    way = channels.passage(shop, 0.7).table
    top = top_behind(way)
    if top is None:
        return Finding(DOES_NOT, "the droplet does not pass")
    after = way[(way["h"] > top["h"]) & (way["h"] < 1)]
    lowest = after[np.argmin(after["speed_ratio"])]
    return Finding(by_tolerance(lowest["h"], 0.5, 0.1) if lowest["speed_ratio"] < after["speed_ratio"][-1] else DOES_NOT, f"{lowest['speed_ratio']:.2f} at h = {lowest['h']:.2f}")


@statement("4.1, figure 4", "w = 0.7: the overshoot shrinks as the tilt grows (Γ = 1.85, 1.11, 0.83)", "4",
           does_not_agree="the stiffest droplet does not pass, as the balance of forces predicts; the softest stays below v_t")
def overshoot_shrinks(shop: Workshop) -> Finding:
    tops, words = tops_of_speeds(shop, 0.7)
    return Finding(AGREES if len(tops) == 3 and tops[0] > tops[1] > max(tops[2], 1) else DOES_NOT, words, tops_of_speeds(shop, 0.8)[1])


EXPONENT = "4/3 is the exponent for a vertex; a droplet has a smaller one, because the wall slows only the nearest vertices"


@statement("appendix A, figure A1", "v_g/(v_t - v_g) grows as d^(4/3) of the distance from the wall", "A1",
           in_kind=EXPONENT, does_not_agree=EXPONENT)
def drag_exponent(shop: Workshop) -> Finding:
    fit = channels.drag_of_walls(shop)[-1]
    value, error = fit["near_wall_exponent"], fit["near_wall_exponent_error"] or 0.0
    return Finding(by_tolerance(value, 4 / 3, max(0.05, 2 * error)), f"{rounded.with_error(value, error)}")


@statement("appendix B, figure B1", "speed profiles are noisy up to 64 vertices, smooth from 128 on", "B1",
           in_kind="smooth only on finer meshes", does_not_agree="ripples shrink up to the finest mesh")
def profiles_are_smooth(shop: Workshop) -> Finding:
    """Finds the meshes that give smooth speed profiles. The ripples on a smooth mesh, and on all finer meshes, are at
    most a tenth larger than those on the finest mesh."""
    noise = {count: roughness(run.table) for count, run in channels.meshes(shop).items()}
    counts = sorted(noise)
    rough = [count for count in counts if noise[count] > 1.1 * noise[counts[-1]]]
    verdict = DOES_NOT if not rough or rough[-1] == counts[-2] else AGREES if rough[-1] == 64 else IN_KIND
    return Finding(verdict, "ripples of " + ", ".join(f"{value:.3f} v_t with {count}" for count, value in noise.items()))


def roughness(way: Any) -> float:
    """The root mean square deviation of a speed profile from its running mean [v_t]. The mean is taken over a tenth of
    a diameter."""
    h = np.arange(-0.9, 0.9, 0.005)
    known = (h > way["h"].min()) & (h < way["h"].max())
    speed = np.interp(h[known], way["h"], way["speed_ratio"])
    width = 21
    if len(speed) <= width:
        return math.nan
    mean = np.convolve(speed, np.ones(width) / width, "valid")
    return float(np.sqrt(np.mean((speed[width // 2:-(width // 2)] - mean) ** 2)))


# Tilt [degrees], diameter [m] and terminal speed [m/s] of the experiments of Figs. 2 and 3.
EXPERIMENTS = ((28.0, 3.5e-3, 7e-3), (8.5, 1.98e-3, 0.97e-3), (5.0, 3.3e-3, 1.1e-3))
TENSION, OIL, WATER, GRAVITY = 0.010, 703.0, 997.0, 9.8  # N/m, kg/m^3, m/s^2


def buoyancy(tilt: float) -> float:
    """The acceleration g_exp of the buoyant droplet along the plates [m/s^2]"""
    return math.sin(math.radians(tilt)) * GRAVITY * (WATER - OIL) / OIL


def arithmetic(found: list[float], published: tuple[float, ...], tolerance: float) -> Finding:
    apart = max(abs(value / other - 1) for value, other in zip(found, published, strict=True))
    return Finding(AGREES if apart <= tolerance else IN_KIND if apart < 0.3 else DOES_NOT, ", ".join(f"{value:.3g}" for value in found) + f"; within {apart:.0%}")


statement("4.1", "Γ_exp = 0.57, 5.80, 3.47 for the three tilts and diameters")(
    lambda shop: arithmetic([TENSION / (buoyancy(tilt) * OIL * diameter**2) for tilt, diameter, _ in EXPERIMENTS], (0.57, 5.80, 3.47), 0.06))
statement("4.1", "V_t = 0.08, 0.028, 0.032 for the three terminal speeds")(
    lambda shop: arithmetic([speed / math.sqrt(diameter * buoyancy(tilt)) for tilt, diameter, speed in EXPERIMENTS], (0.08, 0.028, 0.032), 0.07))


@statement("4.1", "Γ** = 1.7 ± 0.1 and 1.08 ± 0.09 follow from Γ* = 0.16 ± 0.01 by tilt and diameter")
def tensions_scale(shop: Workshop) -> Finding:
    """Compares ratios of line tensions. Values agree if they differ by at most twice their combined errors. The error
    of Gamma* is 6 %."""
    weights = [math.sin(math.radians(tilt)) * diameter**2 for tilt, diameter, _ in EXPERIMENTS]
    found = [0.16 * weights[0] / weight for weight in weights[1:]]
    is_within = [abs(value - published) <= 2 * math.hypot(error, value / 16) for value, published, error in zip(found, (1.7, 1.08), (0.1, 0.09))]
    return Finding(AGREES if all(is_within) else IN_KIND if any(is_within) else DOES_NOT, ", ".join(f"{value:.3g} ± {value / 16:.1g}" for value in found))


for _where, _text in [("4.1, figures 2, 3", "calibrated line tensions are 0.16 ± 0.01, 1.7 ± 0.1, 1.08 ± 0.09, a third of those of the experiments"),
                      ("4.1, figures 2, 3", "calibrated near-wall drag is 0.06 to 0.2 and hardly depends on diameter and tilt"),
                      ("4.1, figures 2, 3", "simulations deviate from experiments by 0.06 to 0.09 in speed, 0.004 to 0.01 in shape"),
                      ("appendix B, figure B2", "the deviation from the experiment reaches a plateau for K_l/Γ below 0.01"),
                      ("4.2, figure 5", "droplets wrap around obstacles and squeeze into gaps in experiments as in simulations")]:
    statement(_where, _text, not_known="measurements are not published as numbers; tried: clogfit calibrate on simulated profiles")(
        lambda shop: Finding(NOT_KNOWN, "-"))
