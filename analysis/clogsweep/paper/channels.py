"""Draws the article's figures of droplets in narrow channels and along walls."""

import math
import pathlib
from collections.abc import Iterable
from typing import Any

import numpy as np
from matplotlib.axes import Axes

from .. import style
from ..drawing import surroundings
from ..labels import AXES, interface_of
from ..reading.trajectory import Trajectory
from ..tools.errors import UserError
from .plate import Plate, figure
from .runner import Runner, measured

SMOOTH = 512  # With at least this many vertices, a passage through w = 0.4 shows no ripples.


def passages(runner: Runner, name: str, **keys: object) -> list[np.void]:
    """The rows of a sweep of channels. @param keys  keys of Runner.runs(), with _ instead of -"""
    start, end = (-10, 3) if runner.size == "full" else (-2, 2)
    return runner.runs(name, "channel", {"obstacle-layout": "channel", "start": start, "end": end}
                       | {key.replace("_", "-"): value for key, value in keys.items()})


def profiles(runner: Runner, name: str, outlines: bool = False, **keys: object) -> list[Trajectory]:
    """Replays passages. Each replay has h, v and A along the path, and outlines if they are requested."""
    rows = passages(runner, name, **keys)
    # Between two frames, a droplet at terminal speed moves by a fiftieth of a diameter. Between two samples the droplet
    # moves by a fifth of this distance.
    frame = 0.02 / rows[0]["terminal_speed"]
    return runner.ways(name, rows, frame / 5, frame if outlines else None)


def parameters(run: Trajectory, orifice: float) -> str:
    row = run.row
    return (rf"orifice ${orifice}\,\sigma$, line tension {row['line_tension']:g}, "
            f"near-wall drag {row['near_wall_drag']:g}, terminal speed {row['terminal_speed']:g}, "
            f"{row['vertices']} vertices, {interface_of(run.word('preset'))}")


def ending(run: Trajectory) -> str:
    """The end of a label. If the droplet did not pass, this text states its last position."""
    return "" if run.word("status") == "passed" else f" (stops at $h = {run.table['h'][-1]:.2f}$)"


def draw_profile(axes: Axes, run: Trajectory, column: str, index: int, label: str) -> None:
    style_of = style.curve_style(index)
    axes.plot(run.table["h"], run.table[column], color=style_of["color"], linewidth=1.4, label=label)
    if run.word("status") != "passed":
        axes.plot(run.table["h"][-1:], run.table[column][-1:], color=style_of["color"], marker="x", markersize=7,
                  linestyle="none")


def draw_measured(paths: Iterable[pathlib.Path], axes: Axes, column: str) -> None:
    for number, table in enumerate(map(measured, paths)):
        if column in table:
            axes.plot(table["h"], table[column], "o", color="black", markerfacecolor="none", markersize=4,
                      label="measured" if number == 0 else None)


def finish(axes: Axes, ordinate: str, reach: float = 1.6) -> None:
    axes.set_xlim(-reach, reach)
    axes.set_xlabel(AXES["h"])
    axes.set_ylabel(AXES[ordinate])
    axes.axvline(0, color="0.8", linewidth=0.8, zorder=0)
    if ordinate == "profile":
        axes.axhline(1, color="0.6", linewidth=0.8, linestyle=":", zorder=0)
        axes.set_ylim(bottom=-0.03)  # leaves room for the cross of a droplet that stops
    style.grid(axes)


def extremes(run: Trajectory, label: str) -> dict[str, Any]:
    """The largest and smallest values of the passage, as the row states them."""
    return {"curve": label} | {f"{extreme}{at}": run.row[f"{extreme}{at}"] for at in ("", "_at")
                               for extreme in ("largest_shape_parameter", "smallest_relative_speed",
                                               "largest_relative_speed")}


def profile_rows(run: Trajectory, label: str) -> list[dict[str, Any]]:
    step = max(1, len(run.table) // 400)
    return [{"curve": label, "h": frame["h"], "speed_ratio": frame["speed_ratio"],
             "shape_parameter": frame["shape_parameter"]}
            for frame in run.table[::step]]


def with_contact(contact: str) -> tuple[str, dict[str, object]]:
    """The end of a sweep's name, and keys. @param contact  "surface", the default, or "half-vertex", as published"""
    return ("", {}) if contact == "surface" else (f"-{contact}", {"contact_range": contact})


def narrow(runner: Runner, contact: str = "surface") -> Trajectory:
    """The passage in Figs. 1 and 2."""
    ending, keys = with_contact(contact)
    return profiles(runner, f"channel-0.4{ending}", outlines=contact == "surface", orifice=0.4, line_tension=0.16,
                    near_wall_drag=0.064, terminal_speed=0.08, **keys)[0]


@figure("1", "geometry: a droplet in a narrow channel, and one among obstacles with its trajectory",
        ["channel", "trajectory"], "1 s")
def geometry(runner: Runner) -> Plate:
    channel = narrow(runner)
    released, = runner.runs("geometry", "trajectory",
                            {"seeds": 1, "line-tension": 0.3, "obstacle-gap": 1.0, "max-time": 300.0})
    array, = runner.ways("geometry", [released], 1, 4)
    drawing, (left, right) = style.subplots(1, 2, figsize=(9.6, 4.4), width_ratios=[1, 1.5])
    middle = channel.middle
    frame = channel.frame_at("h", -0.75)
    surroundings.draw_droplet(left, channel, frame, middle)
    left.annotate("", (0.0, 0.2), (0.0, -0.2), arrowprops={"arrowstyle": "<->"})
    left.text(0.06, 0, "$w$", va="center")
    left.annotate("", (1.2, 0), (0.75, 0), arrowprops={"arrowstyle": "-|>", "color": "black"})
    left.text(0.97, 0.06, "gravity", ha="center")
    surroundings.frame_limits(left, (-1.3, -1.3), (1.3, 1.3))
    style.caption(left, f"(a) {parameters(channel, 0.4)}")
    start = array.polygons[0].mean(axis=1)
    centres = array.polygons.mean(axis=2) - start
    right.plot(*centres.T, "o", color="black", markerfacecolor="none", markersize=3.5, markeredgewidth=0.6)
    shown = int(np.argmin(np.abs(centres[:, 0] - 0.5 * centres[-1, 0])))
    surroundings.draw_droplet(right, array, shown, start)
    middle_y = (centres[:, 1].min() + centres[:, 1].max()) / 2
    half = max(2.4, (centres[:, 1].max() - centres[:, 1].min()) / 2 + 1.5)
    surroundings.frame_limits(right, (-1, middle_y - half), (centres[-1, 0] + 1, middle_y + half))
    row = array.row
    style.caption(right, rf"(b) obstacle gap ${row['obstacle_gap']:g}\,\sigma$, "
                         rf"obstacle diameter ${row['obstacle_diameter']:g}\,\sigma$, "
                  f"line tension {row['line_tension']:g}, {interface_of(array.word('preset'))}\n"
                  rf"circles: centre, every {np.diff(array.times[:2])[0]:.3g} $t_0$; seed {row['seed']}")
    for axes in (left, right):
        axes.set_xlabel(r"$x/\sigma$, along gravity")
        axes.set_ylabel(r"$y/\sigma$")
    data = [{"panel": "b", "time": t, "x": c[0], "y": c[1]} for t, c in zip(array.times, centres)]
    return Plate(drawing, data)


@figure("2", "a droplet squeezes through an orifice of 0.4 diameters: "
             "outlines, shape parameter, speed", ["channel"], "1 s")
def squeezing(runner: Runner) -> Plate:
    run = narrow(runner)
    drawing = style.new_figure(figsize=(9.6, 6.2), layout="constrained")
    top, bottom = drawing.subfigures(2, 1, height_ratios=[1, 2.4])
    middle = run.middle
    for axes, h in zip(top.subplots(1, 6), [-1.0, -0.5, -0.25, 0.0, 0.25, 0.5]):
        frame = run.frame_at("h", h)
        surroundings.draw_droplet(axes, run, frame, middle)
        surroundings.frame_limits(axes, (-1.55, -0.85), (1.15, 0.85))
        axes.set_xticks([]), axes.set_yticks([])
        reached = np.interp(run.times[frame], run.table["time"], run.table["h"])
        axes.set_title(rf"$h = {reached + 0.0:.2f}\sigma$".replace("-0.00", "0.00"), fontsize=9)
    panels = bottom.subplots(1, 2)
    for place, (column, ordinate) in enumerate([("shape_parameter", "shape"), ("speed_ratio", "profile")]):
        axes = panels[place]
        draw_profile(axes, run, column, 1, "simulation" + ending(run))
        draw_measured(runner.profiles, axes, "A" if place == 0 else "v")
        finish(axes, ordinate)
        if runner.profiles:
            axes.legend(frameon=False)
    ripples = "" if run.row["vertices"] >= SMOOTH else f"; ripples of the speed: one for each vertex that passes the tips, none with {SMOOTH}"
    drawing.suptitle(f"{parameters(run, 0.4)}\ngravity to the right, walls grey{ripples}", fontsize=9, color="0.25")
    return Plate(drawing, profile_rows(run, "w=0.4"))


# The line tension, near-wall drag and terminal speed that the article calibrated for each orifice of Fig. 3.
CALIBRATED = {0.9: (1.7, 0.21, 0.028), 0.7: (1.08, 0.07, 0.032)}


def passage(runner: Runner, orifice: float, contact: str = "surface") -> Trajectory:
    """A passage in Fig. 3. @param orifice  0.9 or 0.7"""
    line_tension, drag, speed = CALIBRATED[orifice]
    ending, keys = with_contact(contact)
    return profiles(runner, f"channel-{orifice}{ending}", outlines=contact == "surface", orifice=orifice,
                    line_tension=line_tension, near_wall_drag=drag, terminal_speed=speed, **keys)[0]


@figure("3", "shape and speed through orifices of 0.9 and 0.7 diameters", ["channel"], "3 s")
def two_orifices(runner: Runner) -> Plate:
    drawing, panels = style.subplots(2, 2, figsize=(9.0, 6.8))
    data = []
    for line, orifice in enumerate(CALIBRATED):
        run = passage(runner, orifice)
        for place, (column, ordinate) in enumerate([("shape_parameter", "shape"), ("speed_ratio", "profile")]):
            axes = panels[line][place]
            draw_profile(axes, run, column, 1, "simulation" + ending(run))
            finish(axes, ordinate)
            style.caption(axes, parameters(run, orifice))
            if run.word("status") != "passed":
                axes.legend(frameon=False)
        # An inset in an empty part of the figure shows the most deformed outline.
        inset = panels[line][0].inset_axes([0.68, 0.5, 0.3, 0.47])
        frame = run.frame_at("h", run.row["largest_shape_parameter_at"])
        surroundings.draw_droplet(inset, run, frame, run.middle)
        surroundings.frame_limits(inset, (-0.8, -0.8), (0.8, 0.8))
        inset.set_xticks([]), inset.set_yticks([])
        inset.set_xlabel(rf"$A_\mathrm{{max}} = {run.row['largest_shape_parameter']:.3f}$", fontsize=8)
        data += [*profile_rows(run, f"w={orifice}"), extremes(run, f"w={orifice}")]
    for pair, path in zip(panels, runner.profiles):
        for axes, column in zip(pair, "Av"):
            draw_measured([path], axes, column)
    return Plate(drawing, data)


OVERSHOOTS = {0.7: 0.02, 0.8: 0.0}  # near-wall drag for each orifice of Fig. 4


# The tilts of Fig. 4 by their line tension [degrees]. At 5 degrees V_t was 0.032, and it grows as sqrt(sin tilt).
TILTS = {1.85: 2.7, 1.11: 4.5, 0.83: 6.0}


def terminal_speed(tilt: float) -> float:
    """V_t = v_t/sqrt(sigma g) of the droplet of figure 4 at a tilt [degrees]"""
    return round(0.032 * math.sqrt(math.sin(math.radians(tilt)) / math.sin(math.radians(5))), 4)


def overshooting(runner: Runner, orifice: float) -> dict[float, Trajectory]:
    """The passages in Fig. 4 by line tension. @param orifice  0.7 or 0.8"""
    return {line_tension: profiles(runner, f"overshoot-{orifice}-{line_tension}", orifice=orifice,
                                   line_tension=line_tension, near_wall_drag=OVERSHOOTS[orifice],
                                   terminal_speed=terminal_speed(tilt))[0] for line_tension, tilt in TILTS.items()}


@figure("4", "speed behind an orifice, which overshoots the terminal speed, for three line tensions", ["channel"], "3 s")
def overshoot(runner: Runner) -> Plate:
    drawing, panels = style.subplots(1, 2, figsize=(9.6, 4.6))
    data = []
    for axes, (orifice, drag), origin in zip(panels, OVERSHOOTS.items(),
                                             ("parameters of the article", "not published, for comparison")):
        for index, (line_tension, run) in enumerate(overshooting(runner, orifice).items()):
            draw_profile(axes, run, "speed_ratio", index, rf"$\Gamma = {line_tension:g}$" + ending(run))
            data += profile_rows(run, f"w={orifice} b_0={drag:g} Gamma={line_tension:g}")
        finish(axes, "profile")
        style.caption(axes, rf"{origin}: orifice ${orifice}\,\sigma$, near-wall drag {drag:g}" "\n"
                      f"terminal speeds {', '.join(f'{terminal_speed(tilt):g}' for tilt in TILTS.values())}, "
                      rf"{run.row['vertices']} vertices, {interface_of(run.word('preset'))}")
    draw_measured(runner.profiles, panels[0], "v")
    for axes in panels:
        axes.legend(frameon=False, fontsize=8, loc="lower right", title="line tension")
    return Plate(drawing, data)


def drag_of_walls(runner: Runner) -> tuple[list[float], list[np.void], list[float], dict[str, Any]]:
    """Droplets midway between two walls, as in Fig. A1. @return distances from a wall, rows, speeds [v_t], and the fit
    of clogfit drag"""
    distances = [0.03, 0.05, 0.1, 0.2, 0.4, 0.8, 1.6, 3.2]
    rows = passages(runner, "walls", start=-1.5, end=1.5, wedge_angle=0,
                    orifice=[1 + 2 * distance for distance in distances], line_tension=1, near_wall_drag=0.07,
                    terminal_speed=0.03)
    speeds = [row["mean_speed"] / row["terminal_speed"] for row in rows]
    if not np.isfinite(speeds).all():
        raise UserError(f"droplets of {runner.sweep_file('walls')} went too short a way for a mean speed; "
                        "raise max-time, e.g. --set channel:max-time=3000")
    table = runner.table("walls", ["d [sigma]", "v [v_t]"], zip(distances, speeds))
    return distances, rows, speeds, runner.fit("drag", table, "--format", "json")


@figure("A1", "near-wall drag: speed between parallel walls against the distance from them, and its exponent",
        ["channel"], "3 s")
def near_wall_drag(runner: Runner) -> Plate:
    distances, rows, speeds, fit = drag_of_walls(runner)
    data = [{"distance": distance, "speed_ratio": speed, "ratio": speed / (1 - speed)}
            for distance, speed in zip(distances, speeds)]
    row = rows[0]
    drawing, axes = style.subplots(figsize=(6.4, 4.8))
    ratio = np.array([point["ratio"] for point in data])
    axes.plot(distances, ratio, "o", color=style.COLOURS[0], label="simulated droplet, midway between two walls")
    d = np.geomspace(0.02, 5, 100)
    alpha, strength = fit["near_wall_exponent"], fit["near_wall_drag"]
    axes.plot(d, d**alpha / strength, color=style.COLOURS[0], linewidth=1,
              label=rf"fit to these: exponent ${alpha:.2f}\pm{fit['near_wall_exponent_error'] or math.nan:.2f}$")
    # v/(v_t - v) of a circle, computed from the drag on each vertex. The value is the inverse of b_0/b_inf times the
    # mean of d_i^-alpha over the vertices.
    exponent, height = row["near_wall_exponent"], 0.5 * (1 - np.abs(np.sin(np.linspace(0, 2 * np.pi, row["vertices"], endpoint=False))))
    circle = 1 / (row["near_wall_drag"] * np.mean((d[:, None] + height) ** -exponent, axis=1))
    axes.plot(d, circle, ":", color="black", linewidth=1, label="sum over the vertices of a circle (no fit)")
    axes.plot(d, ratio[-1] * (d / distances[-1])**exponent, "--", color="0.4", linewidth=1,
              label=rf"exponent {exponent:.3g} of each vertex")
    style.logarithmic_abscissa(axes)
    axes.set_yscale("log")
    style.label(axes, r"distance between wall and droplet $d/\sigma$", r"$v_g/(v_t - v_g)$")
    axes.legend(frameon=False)
    style.caption(axes, f"line tension 1, near-wall drag 0.07, terminal speed 0.03, {row['vertices']} vertices, "
                        r"one run per point" "\n"
                  "drag of a droplet grows less steeply than that of its vertices: "
                  "near a wall only the nearest ones feel it")
    return Plate(drawing, data)


def meshes(runner: Runner) -> dict[int, Trajectory]:
    """The passages in Fig. B1 by their number of vertices. The finest run takes most of the time, so a figure of
    reduced size has no run with more than twice the vertices of the config."""
    line_tension, most = (1.08, 4) if runner.size == "full" else (0.83, 2)
    largest = most * int(runner.keys("channel")["vertices"])
    counts = [count for count in (32, 64, 128, 256, 512, 1024) if count <= largest]
    return dict(zip(counts, profiles(runner, "vertices", orifice=0.7, line_tension=line_tension,
                                     near_wall_drag=0.07, terminal_speed=0.032, vertices=counts)))


@figure("B1", "speed through an orifice of 0.7 diameters for different numbers of vertices", ["channel"], "4 s")
def vertices(runner: Runner) -> Plate:
    drawing, axes = style.subplots(figsize=(7.2, 5.0))
    inset = axes.inset_axes([0.72, 0.1, 0.25, 0.36])
    data = []
    for index, (count, run) in enumerate(meshes(runner).items()):
        for panel in (axes, inset):
            draw_profile(panel, run, "speed_ratio", index,
                         f"{count} vertices" + (" (stops)" if run.word("status") != "passed" else ""))
        data += [*profile_rows(run, f"N_v={count}"), extremes(run, f"N_v={count}")]
    finish(axes, "profile")
    inset.set_xlim(-0.4, -0.1)
    inset.set_ylim(0, 0.5)
    inset.tick_params(labelsize=7)
    axes.legend(frameon=False, fontsize=8, loc="lower left")
    style.caption(axes, rf"orifice $0.7\,\sigma$, line tension {run.row['line_tension']:g}, near-wall drag 0.07, "
                        f"terminal speed 0.032, {interface_of(run.word('preset'))}"
                  "\ninset: near the first minimum")
    return Plate(drawing, data)


SPRINGS = [1e-4, 1e-3, 1e-2, 3e-2, 0.1, 0.3, 1.0]  # perimeter stiffness divided by line tension, of figure B2


def spring_deviations(runner: Runner, preset: str) -> tuple[Trajectory, dict[float, dict[str, float]]]:
    """The passages of Fig. B2. @return the last passage; for each ratio of SPRINGS, the deviations `delta_v` and
    `delta_a` from the measured profile, or from the profile of the softest springs if no profile was measured"""
    runs = profiles(runner, f"springs-{preset}", orifice=0.9, line_tension=1.7, near_wall_drag=0.21,
                    terminal_speed=0.028, preset=preset, perimeter_spring="rest", perimeter_stiffness_ratio=SPRINGS)
    files = []
    for ratio, run in zip(SPRINGS, runs):
        # The passage of the softest springs is made shorter, so that the other passages contain all its places.
        frames = run.table[np.abs(run.table["h"]) < (1.2 if run is runs[0] and not runner.profiles else np.inf)]
        files.append(runner.table(f"springs-{preset}-{ratio:g}", ["h [sigma]", "v [v_t]", "A"],
                                  zip(frames["h"], frames["speed_ratio"], frames["shape_parameter"])))
    reference, compared = (runner.profiles[0], files) if runner.profiles else (files[0], files[1:])
    places = SPRINGS if runner.profiles else SPRINGS[1:]
    return runs[-1], dict(zip(places, runner.fit("deviation", reference, *compared)["deviations"], strict=True))


@figure("B2", "deviation of the speed profile as the perimeter's springs stiffen", ["channel"], "15 s")
def perimeter_springs(runner: Runner) -> Plate:
    drawing, axes = style.subplots(figsize=(6.4, 4.8))
    data = []
    for index, preset in enumerate(["elastic", "literal"]):
        run, deviations = spring_deviations(runner, preset)
        places, found = list(deviations), [entry["delta_v"] for entry in deviations.values()]
        axes.plot(places, found, **style.curve_style(index), markersize=5, linewidth=1, label=interface_of(preset))
        data += [{"preset": preset, "stiffness_ratio": x, "delta_v": y} for x, y in zip(places, found)]
    style.logarithmic_abscissa(axes, places)
    axes.set_ylim(bottom=0)
    reference = "the measured profile" if runner.profiles else r"the profile at $K_l/\Gamma = 10^{-4}$"
    style.label(axes, r"perimeter stiffness divided by line tension $K_l/\Gamma$", rf"$\Delta_v$ from {reference}")
    axes.legend(frameon=False)
    style.caption(axes, parameters(run, 0.9).rpartition(", ")[0] + ", springs to the rest length")
    return Plate(drawing, data)
