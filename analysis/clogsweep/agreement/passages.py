"""Section 4.1, appendices A and B: channels, where nothing is random and runs have no intervals; and what was measured."""

import math
from typing import Any

import numpy as np

from ..paper import channels
from ..paper.workshop import Workshop
from ..tools import rounded
from .evidence import by_tolerance
from .statements import AGREES, DOES_NOT, IN_KIND, NOT_KNOWN, Finding, statement


EXPONENT = "4/3 is the exponent for a vertex; only the nearest vertices feel the wall, so that of the droplet is smaller"


@statement("4.1, figure 2", "w = 0.4: A = 1.07 at h = 0.5", "2", in_kind="the droplet is stretched more")
def shape_behind(shop: Workshop) -> Finding:
    return shape_at(shop, 0.5, 1.07)


@statement("4.1, figure 2", "w = 0.4: A = 1.00 at h = -0.5: the shape is not symmetric about the orifice", "2")
def shape_before(shop: Workshop) -> Finding:
    return shape_at(shop, -0.5, 1.0)


def shape_at(shop: Workshop, h: float, published: float) -> Finding:
    way = channels.narrow(shop).table
    shape = float(np.interp(h, way["h"], way["shape_parameter"]))
    return Finding(by_tolerance(shape, published, 0.015), f"{shape:.3f}")


@statement("4.1, figure 3a", "w = 0.9: largest A = 1.014", "3")
def largest_shape_wide(shop: Workshop) -> Finding:
    row = channels.passage(shop, 0.9).row
    return Finding(by_tolerance(row["largest_shape_parameter"], 1.014, 0.002), f"{row['largest_shape_parameter']:.3f}")


@statement("4.1, figure 3c", "w = 0.7: largest A = 1.093", "3")
def largest_shape(shop: Workshop) -> Finding:
    row = channels.passage(shop, 0.7).row
    return Finding(by_tolerance(row["largest_shape_parameter"], 1.093, 0.01), f"{row['largest_shape_parameter']:.3f}, {row['status'].decode()}")


@statement("4.1, figure 3d", "w = 0.7: the first minimum of the speed is near h = -0.25", "3")
def first_minimum(shop: Workshop) -> Finding:
    h = slowest_before(channels.passage(shop, 0.7).table)
    return Finding(by_tolerance(h, -0.25, 0.1), f"{h:.2f}")


def slowest_before(way: Any) -> float:
    """The place of a droplet's least speed on the last diameter before the orifice; farther away it starts from rest."""
    before = way[(way["h"] > -1) & (way["h"] < 0)]
    return float(before["h"][np.argmin(before["speed_ratio"])])


@statement("4.1, figure 3d", "w = 0.7: the speed overshoots v_t near h = 0.3", "3",
           in_kind="the speed peaks there, but below v_t", does_not_agree="no maximum behind the orifice")
def overshoots(shop: Workshop) -> Finding:
    way = channels.passage(shop, 0.7).table
    behind = way[(way["h"] > 0) & (way["h"] < 0.6)]
    if not len(behind):
        return Finding(DOES_NOT, "the droplet does not pass")
    top = behind[np.argmax(behind["speed_ratio"])]
    verdict = AGREES if top["speed_ratio"] > 1 else IN_KIND if 0.1 < top["h"] < 0.5 else DOES_NOT
    return Finding(verdict, f"{top['speed_ratio']:.2f} at h = {top['h']:.2f}")


@statement("4.1, figure 4", "w = 0.7: the overshoot shrinks as the tilt grows (Γ = 1.85, 1.11, 0.83)", "4",
           in_kind="the stiffest droplet does not pass the orifice",
           does_not_agree="the stiffer droplets do not pass the orifice")
def overshoot_shrinks(shop: Workshop) -> Finding:
    runs = channels.overshooting(shop, 0.7)
    tops = {tension: run.table["speed_ratio"][run.table["h"] > 0].max() for tension, run in runs.items() if run.word("status") == "passed"}
    words = ", ".join(f"{tension:g}: {tops[tension]:.2f}" if tension in tops else f"{tension:g} does not pass" for tension in runs)
    in_order = all(first >= second for first, second in zip(tops.values(), list(tops.values())[1:]))
    return Finding(DOES_NOT if len(tops) < 2 or not in_order else AGREES if len(tops) == len(runs) else IN_KIND, words)


@statement("appendix A, figure A1", "v_g/(v_t - v_g) grows as d^(4/3) of the distance from the wall", "A1",
           in_kind=EXPONENT, does_not_agree=EXPONENT)
def drag_exponent(shop: Workshop) -> Finding:
    fit = channels.drag_of_walls(shop)[-1]
    value, error = fit["near_wall_exponent"], fit["near_wall_exponent_error"] or 0.0
    return Finding(by_tolerance(value, 4 / 3, max(0.05, 2 * error)), f"{rounded.with_error(value, error)}")


@statement("appendix B, figure B1", "speed profiles are noisy up to 64 vertices, smooth from 128 on", "B1",
           in_kind="smooth only from a finer mesh on")
def profiles_are_smooth(shop: Workshop) -> Finding:
    noise = {count: roughness(run.table) for count, run in channels.meshes(shop).items()}
    smooth = [count for count, value in noise.items() if value < 0.01]
    verdict = DOES_NOT if not smooth else AGREES if min(smooth) == 128 else IN_KIND
    return Finding(verdict, "ripples of " + ", ".join(f"{value:.3f} v_t with {count}" for count, value in noise.items()))


def roughness(way: Any) -> float:
    """Root mean square deviation of a speed profile from its running mean over a tenth of a diameter [v_t]."""
    h = np.arange(-0.9, 0.9, 0.005)
    known = (h > way["h"].min()) & (h < way["h"].max())
    speed = np.interp(h[known], way["h"], way["speed_ratio"])
    width = 21
    if len(speed) <= width:
        return math.nan
    mean = np.convolve(speed, np.ones(width) / width, "valid")
    return float(np.sqrt(np.mean((speed[width // 2:-(width // 2)] - mean) ** 2)))


@statement("4.1", "Γ_exp = 0.57, 5.80, 3.47 for the three tilts and diameters",
           in_kind="the interfacial tension of 10 mN/m is a rounded value")
def tensions_of_experiments(shop: Workshop) -> Finding:
    tension, oil, water, gravity = 0.010, 703.0, 997.0, 9.81  # N/m, kg/m^3, m/s^2
    found = [tension / (math.sin(math.radians(tilt)) * gravity * (water - oil) * diameter**2) for tilt, diameter in ((28, 3.5e-3), (8.5, 1.98e-3), (5.0, 3.3e-3))]
    apart = max(abs(value / published - 1) for value, published in zip(found, (0.57, 5.80, 3.47)))
    return Finding(AGREES if apart < 0.03 else IN_KIND if apart < 0.3 else DOES_NOT, ", ".join(f"{value:.3g}" for value in found))


UNPUBLISHED = "the measured profiles and images are not published as numbers; clogfit calibrate compares with your own"


def needs_measurements(shop: Workshop) -> Finding:
    return Finding(NOT_KNOWN, "-")


for _where, _text in [("4.1, figures 2, 3", "calibrated line tensions are 0.16 ± 0.01, 1.7 ± 0.1, 1.08 ± 0.09, a third of those of the experiments"),
                      ("4.1, figures 2, 3", "calibrated near-wall drag is 0.06 to 0.2 and hardly depends on diameter and tilt"),
                      ("4.1, figures 2, 3", "simulations deviate from experiments by 0.06 to 0.09 in speed, 0.004 to 0.01 in shape"),
                      ("appendix B, figure B2", "the deviation from the experiment reaches a plateau for K_l/Γ below 0.01"),
                      ("4.2, figure 5", "droplets wrap around obstacles and squeeze into gaps in experiments as in simulations")]:
    statement(_where, _text, not_known=UNPUBLISHED)(needs_measurements)
