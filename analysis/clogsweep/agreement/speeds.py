"""Judges statements of the article (Cheng et al.), section 4.3 and appendices D and E: on mean speeds among
obstacles."""

import math
from typing import Any

from scipy import stats

from ..paper import arrays
from ..paper.dilute import Family
from ..paper.runner import Runner
from ..tools.hints import Group
from .evidence import (LEAST_LINEARITY, by_tolerance, curves, fall_with_stiffness, falls, overall, rises, slower,
                       speed_of, trend)
from .verdicts import AGREES, DOES_NOT, IN_KIND, NOT_KNOWN, Finding


def speed_curves(runner: Runner, config: str, parameter: str, abscissa: str) -> dict[Any, list[Group]]:
    found = curves(arrays.with_speeds(runner, config), parameter)
    return {value: sorted(curve, key=lambda group: group[abscissa]) for value, curve in found.items()}


# In the published model, the corners of the polygon do not hold the droplet (no corner pinning).
WALLS = [Family("speed-robust", "no friction, no corner pinning"), Family("speed", "no friction, corner pinning")]


def speeds_rise_among_walls(runner: Runner, family: Family) -> Finding:
    return speeds_rise(runner, family.config, "obstacle_gap", "gap")


def speeds_rise(runner: Runner, config: str, parameter: str, name: str) -> Finding:
    """Judges whether the mean speed rises monotonically with Gamma."""
    verdicts, words = [], []
    for value, curve in speed_curves(runner, config, parameter, "line_tension").items():
        verdicts.append(trend(rises(curve, slower), falls(curve, slower)))
        top = max(curve, key=lambda group: group[arrays.STEADY])
        words.append(f"{name} {value:g}: " + ", ".join(f"{speed_of(group)} at {group['line_tension']:g}"
                                                       for group in (curve[0], top, curve[-1])))
    return Finding(overall(verdicts), "; ".join(words))


def plateau(runner: Runner, config: str, parameter: str) -> list[Group]:
    return [curve[-1] for curve in speed_curves(runner, config, parameter, "line_tension").values()]


def plateau_by_gap(runner: Runner) -> Finding:
    stiff = plateau(runner, "speed", "obstacle_gap")
    return Finding(trend(slower(stiff[0], stiff[-1]), slower(stiff[-1], stiff[0])),
                   ", ".join(f"{speed_of(group)} in gaps of {group['obstacle_gap']:g}" for group in stiff))


def at_diameters(groups: list[Group]) -> str:
    return ", ".join(f"{speed_of(group)} for a diameter of {group['obstacle_diameter']:g}" for group in groups)


def plateau_by_diameter(runner: Runner) -> Finding:
    stiff = plateau(runner, "speed-diameter", "obstacle_diameter")
    differ = rises(stiff, slower) or falls(stiff, slower)
    return Finding(DOES_NOT if differ else AGREES, at_diameters(stiff))


def soft_by_diameter(runner: Runner) -> Finding:
    soft = [curve[0] for curve in speed_curves(runner, "speed-diameter", "obstacle_diameter", "line_tension").values()]
    return Finding(trend(slower(soft[0], soft[-1]), slower(soft[-1], soft[0])), at_diameters(soft))


def speed_by_capillary_number(runner: Runner) -> Finding:
    verdicts, words = [], []
    for gap, curve in speed_curves(runner, "speed", "obstacle_gap", "capillary_number").items():
        small = [group[arrays.STEADY] for group in curve if group["capillary_number"] < 1]
        spread = max(small) - min(small) if small else math.nan
        is_as_published = AGREES if spread < 0.05 else IN_KIND
        verdicts.append(NOT_KNOWN if not small else is_as_published if falls(curve, slower) else DOES_NOT)
        words.append(f"gap {gap:g}: below Ca = 1 speeds differ by up to {spread:.2f}, "
                     f"{speed_of(curve[-1])} at Ca = {curve[-1]['capillary_number']:.2g}")
    return Finding(overall(verdicts), "; ".join(words))


def disks_fall_with_stiffness(runner: Runner) -> Finding:
    return fall_with_stiffness(speed_curves(runner, "speed-sp", "obstacle_gap", "wall_stiffness"), slower, speed_of)


def disks_are_faster_in_wide_gaps(runner: Runner) -> Finding:
    verdicts, words = [], []
    for stiffness, members in curves(arrays.with_speeds(runner, "speed-sp"), "wall_stiffness").items():
        narrow, wide = (choose(members, key=lambda group: group["obstacle_gap"]) for choose in (min, max))
        verdicts.append(trend(slower(narrow, wide), slower(wide, narrow)))
        words.append(f"{speed_of(narrow)} and {speed_of(wide)} at {stiffness:g}")
    return Finding(overall(verdicts), f"narrowest and widest gap: {'; '.join(words)}")


def soft_disks_are_free(runner: Runner) -> Finding:
    soft = [curve[0] for curve in speed_curves(runner, "speed-sp", "obstacle_gap", "wall_stiffness").values()]
    return Finding(overall([by_tolerance(group[arrays.STEADY], 1, 0.02) for group in soft]),
                   ", ".join(f"{speed_of(group)} at {group['wall_stiffness']:g}" for group in soft))


def speed_pairs(runner: Runner) -> list[tuple[float, Group, float, Group]]:
    """Two pairs of a polygon and a disk in gaps of 1.1: the stiffest droplets of both models, and the softest droplets
    of both models. Each droplet comes with its sag."""
    found = []
    for config in ("speed", "speed-sp"):
        groups = [group for group in arrays.with_speeds(runner, config) if math.isclose(group["obstacle_gap"], 1.1)]
        found.append(sorted(zip(arrays.sags(runner, config, groups), groups), key=lambda point: point[0]))
    return [(*found[0][end], *found[1][end]) for end in (0, -1)]


def stiff_models_agree(runner: Runner) -> Finding:
    _, polygon, _, disk = speed_pairs(runner)[0]
    differ = slower(polygon, disk) or slower(disk, polygon)
    return Finding(DOES_NOT if differ else AGREES, f"polygon {speed_of(polygon)}, disk {speed_of(disk)}")


def soft_models_differ(runner: Runner) -> Finding:
    sag, polygon, disk_sag, disk = speed_pairs(runner)[1]
    return Finding(AGREES if slower(polygon, disk) else DOES_NOT,
                   f"polygon {speed_of(polygon)} at a sag of {sag:.2f}, disk {speed_of(disk)} at {disk_sag:.2f}")


def nothing_clogs_in_wide_gaps(runner: Runner) -> Finding:
    groups = [group for group in runner.sweep("speed") if group["obstacle_gap"] > 1.0]
    runs, clogs, on_mesh = (sum(group[name] for group in groups) for name in ("runs", "clogs", "on_mesh"))
    return Finding(AGREES if clogs == 0 else IN_KIND if clogs <= 0.05 * runs else DOES_NOT,
                   f"{clogs} of {runs} runs clogged, {on_mesh} of them by corner pinning")


def displacement_is_linear(runner: Runner) -> Finding:
    found = {tension: stats.linregress(run.table["time"], run.table["distance"]).rvalue ** 2
             for tension, run in arrays.displacements(runner).items()}
    right = [r_squared >= LEAST_LINEARITY for r_squared in found.values()]
    return Finding(AGREES if all(right) else IN_KIND if any(right) else DOES_NOT,
                   "R² = " + ", ".join(f"{r_squared:.4f} at {tension:g}" for tension, r_squared in found.items()))


def drag_slows_down(runner: Runner) -> Finding:
    lines = list(speed_curves(runner, "near-wall-drag", "near_wall_drag", "line_tension").values())
    pairs = [(first, last) for first in lines[0] for last in lines[-1] if first["line_tension"] == last["line_tension"]]
    right = [slower(last, first) for first, last in pairs]
    speeds = "; ".join(f"{speed_of(first)} and {speed_of(last)} at {first['line_tension']:g}" for first, last in pairs)
    return Finding(AGREES if all(right) else IN_KIND if any(right) else DOES_NOT,
                   f"b_0/b_∞ {lines[0][0]['near_wall_drag']:g} and {lines[-1][0]['near_wall_drag']:g}: {speeds}")
