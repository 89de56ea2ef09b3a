"""Judges statements of the article (Cheng et al.), section 4.1 and appendices A and B: on measured quantities and on
passages through channels. Nothing in a passage through a channel is random, so there are no confidence intervals."""

import math
from typing import Any

import numpy as np
from scipy.signal import find_peaks

from ..paper import channels
from ..paper.runner import Runner
from ..tools import rounded
from .evidence import by_tolerance
from .verdicts import AGREES, DOES_NOT, IN_KIND, NOT_KNOWN, Finding


# Error of the published shape parameters. The published simulations deviate from their experiments by a Delta_A of up
# to this value.
PUBLISHED_ERROR = 0.01


def shape_at(runner: Runner, h: float, published: float, contact: str) -> Finding:
    way = channels.narrow(runner, contact).table
    shape = float(np.interp(h, way["h"], way["shape_parameter"]))
    return Finding(by_tolerance(shape, published, PUBLISHED_ERROR), f"{shape:.3f}")


def largest_shape(runner: Runner, orifice: float, published: float, tolerance: float, contact: str) -> Finding:
    row = channels.passage(runner, orifice, contact).row
    shape = row["largest_shape_parameter"]
    return Finding(by_tolerance(shape, published, tolerance), f"{shape:.3f}, {row['status'].decode()}")


def first_minimum(runner: Runner, contact: str) -> Finding:
    h = slowest_before(channels.passage(runner, 0.7, contact).table)
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


def tops_of_speeds(runner: Runner, orifice: float) -> tuple[list[float], str]:
    """The largest speeds of the droplets of figure 4 that pass, and a text about all droplets of this figure."""
    tops = {tension: top_behind(run.table) for tension, run in channels.overshooting(runner, orifice).items()}
    words = [f"the droplet of {tension:g} does not pass" if top is None else f"{top['speed_ratio']:.2f} at {tension:g}"
             for tension, top in tops.items()]
    text = f"w = {orifice:g}, b_0/b_∞ = {channels.OVERSHOOTS[orifice]:g}: {', '.join(words)}"
    return [top["speed_ratio"] for top in tops.values() if top is not None], text


def overshoots(runner: Runner, contact: str) -> Finding:
    top = top_behind(channels.passage(runner, 0.7, contact).table)
    if top is None:
        return Finding(DOES_NOT, "the droplet does not pass")
    verdict = DOES_NOT if top["speed_ratio"] <= 1 else by_tolerance(top["h"], 0.3, 0.1)
    return Finding(verdict, f"{top['speed_ratio']:.2f} at h = {top['h']:.2f}")


def second_minimum(runner: Runner, contact: str) -> Finding:
    way = channels.passage(runner, 0.7, contact).table
    top = top_behind(way)
    if top is None:
        return Finding(DOES_NOT, "the droplet does not pass")
    after = way[(way["h"] > top["h"]) & (way["h"] < 1)]
    lowest = after[np.argmin(after["speed_ratio"])]
    is_minimum = lowest["speed_ratio"] < after["speed_ratio"][-1]
    return Finding(by_tolerance(lowest["h"], 0.5, 0.1) if is_minimum else DOES_NOT,
                   f"{lowest['speed_ratio']:.2f} at h = {lowest['h']:.2f}")


def overshoot_shrinks(runner: Runner) -> Finding:
    tops, words = tops_of_speeds(runner, 0.7)
    shrinks = len(tops) == 3 and tops[0] > tops[1] > max(tops[2], 1)
    return Finding(AGREES if shrinks else DOES_NOT, words, tops_of_speeds(runner, 0.8)[1])


def drag_exponent(runner: Runner) -> Finding:
    fit = channels.drag_of_walls(runner)[-1]
    value, error = fit["near_wall_exponent"], fit["near_wall_exponent_error"] or 0.0
    return Finding(by_tolerance(value, 4 / 3, max(0.05, 2 * error)), f"{rounded.with_error(value, error)}")


def profiles_are_smooth(runner: Runner) -> Finding:
    """Compares the profile of each mesh with the profile of the finest mesh. The verdict is IN_KIND if all profiles
    with 128 vertices or more are smooth, but not all coarser meshes have noisy profiles."""
    runs = channels.meshes(runner)
    *coarser, finest = sorted(runs)
    if not coarser or not coarser[0] < 128 <= coarser[-1]:
        return Finding(NOT_KNOWN, f"meshes of {', '.join(map(str, sorted(runs)))} vertices only")
    if runs[finest].word("status") != "passed":
        return Finding(DOES_NOT, f"the droplet of {finest} vertices does not pass")
    noise = {count: ripples(runs[count].table, runs[finest].table) for count in coarser}
    passes = {count: runs[count].word("status") == "passed" for count in coarser}
    is_smooth = {count: passes[count] and noise[count] <= SMOOTH for count in coarser}
    verdict = (DOES_NOT if not all(is_smooth[count] for count in coarser if count >= 128) else
               AGREES if all(noise[count] > SMOOTH for count in coarser if count < 128) else IN_KIND)
    words = [f"{noise[count]:.2g} v_t with {count}" + ("" if passes[count] else " (does not pass)")
             for count in coarser]
    return Finding(verdict, f"ripples about the profile of {finest} vertices: {', '.join(words)}")


SMOOTH = 0.02  # A quarter of 0.08, the deviation of a published simulation from its experiment [v_t].


def ripples(way: Any, finest: Any) -> float:
    """The size of the ripples of a speed profile [v_t]. The profile on the finest mesh is subtracted, and then a
    running mean over a tenth of a diameter. The size is the root mean square of the rest."""
    h = np.arange(-0.9, 0.9, 0.005)
    known = (h > way["h"].min()) & (h < way["h"].max())
    apart = np.interp(h[known], way["h"], way["speed_ratio"]) - np.interp(h[known], finest["h"], finest["speed_ratio"])
    width = 21
    if len(apart) <= width:
        return math.nan
    mean = np.convolve(apart, np.ones(width) / width, "valid")
    return float(np.sqrt(np.mean((apart[width // 2:-(width // 2)] - mean) ** 2)))


# Tilt [degrees], diameter [m] and terminal speed [m/s] of the experiments of Figs. 2 and 3.
EXPERIMENTS = ((28.0, 3.5e-3, 7e-3), (8.5, 1.98e-3, 0.97e-3), (5.0, 3.3e-3, 1.1e-3))
TENSION, OIL, WATER, GRAVITY = 0.010, 703.0, 997.0, 9.8  # N/m, kg/m^3, m/s^2


def buoyancy(tilt: float) -> float:
    """The acceleration g_exp of the buoyant droplet along the plates [m/s^2]"""
    return math.sin(math.radians(tilt)) * GRAVITY * (WATER - OIL) / OIL


def arithmetic(found: list[float], published: tuple[float, ...], tolerance: float) -> Finding:
    apart = max(abs(value / other - 1) for value, other in zip(found, published, strict=True))
    return Finding(AGREES if apart <= tolerance else IN_KIND if apart < 0.3 else DOES_NOT,
                   ", ".join(f"{value:.3g}" for value in found) + f"; within {apart:.0%}")


def tensions_of_experiments(_: Runner) -> Finding:
    found = [TENSION / (buoyancy(tilt) * OIL * diameter**2) for tilt, diameter, _ in EXPERIMENTS]
    return arithmetic(found, (0.57, 5.80, 3.47), 0.06)


def speeds_of_experiments(_: Runner) -> Finding:
    found = [speed / math.sqrt(diameter * buoyancy(tilt)) for tilt, diameter, speed in EXPERIMENTS]
    return arithmetic(found, (0.08, 0.028, 0.032), 0.07)


def tensions_scale(_: Runner) -> Finding:
    """Compares ratios of line tensions. Values agree if they differ by at most twice their combined errors. The error
    of Gamma* (the line tension of the simulated droplet that moves like the measured one) is 6 %."""
    weights = [math.sin(math.radians(tilt)) * diameter**2 for tilt, diameter, _ in EXPERIMENTS]
    found = [0.16 * weights[0] / weight for weight in weights[1:]]
    is_within = [abs(value - published) <= 2 * math.hypot(error, value / 16)
                 for value, published, error in zip(found, (1.7, 1.08), (0.1, 0.09))]
    return Finding(AGREES if all(is_within) else IN_KIND if any(is_within) else DOES_NOT,
                   ", ".join(f"{value:.3g} ± {value / 16:.1g}" for value in found))


def calibrated_to_measured(_: Runner) -> Finding:
    """Divides the calibrated line tensions by those that follow from the published measurements."""
    found = [calibrated / measured for calibrated, measured in zip((0.16, 1.7, 1.08), (0.57, 5.80, 3.47))]
    return arithmetic(found, (0.28, 0.29, 0.31), 0.02)


def tension_times_tilt(_: Runner) -> Finding:
    """Gamma is inversely proportional to the sine of the tilt, so Gamma times this sine is equal for all tilts."""
    products = [tension * math.sin(math.radians(tilt)) for tension, tilt in channels.TILTS.items()]
    return arithmetic(products, (products[0],) * 3, 0.02)


def springs_reach_a_plateau(runner: Runner) -> Finding:
    """Two profiles that deviate from one experiment by 0.08 each deviate from each other by at most 0.16."""
    most = 2 * 0.08
    of_presets = {preset: channels.spring_deviations(runner, preset)[1] for preset in ("elastic", "literal")}
    found = {preset: max(entry["delta_v"] for ratio, entry in deviations.items() if ratio < 0.01)
             for preset, deviations in of_presets.items()}
    return Finding(AGREES if max(found.values()) <= most else DOES_NOT if min(found.values()) > most else IN_KIND,
                   "Δ_v between K_l/Γ = 1e-3 and 1e-4: "
                   + ", ".join(f"{value:.2f} ({preset})" for preset, value in found.items()))


def shapes_deviate_less(runner: Runner) -> Finding:
    """Compares how much springs change the shapes in a passage with how much they change its speeds."""
    entries = channels.spring_deviations(runner, "elastic")[1].values()
    shares = [entry["delta_a"] / entry["delta_v"] for entry in entries]
    return Finding(AGREES if max(shares) <= 0.2 else IN_KIND if max(shares) < 1 else DOES_NOT,
                   f"Δ_A/Δ_v of {min(shares):.2g} to {max(shares):.2g} between springs of different stiffness")


def not_published(_: Runner) -> Finding:
    return Finding(NOT_KNOWN, "-")
