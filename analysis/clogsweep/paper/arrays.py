"""Draws the article's figures of droplets among obstacles."""

from __future__ import annotations

import functools
import math
from collections.abc import Callable, Iterable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axes import Axes

from .. import style
from ..drawing import surroundings, survival_curve
from ..drawing.lengths import draw_lengths, draw_speeds, length_notes
from ..labels import AXES, interface_of, parameter_label
from ..reading import trajectory
from ..tools import rounded
from ..tools.errors import UserError
from ..tools.hints import Group, Numbers
from .captions import describe
from .plate import Plate, figure
from .runner import Runner

if TYPE_CHECKING:
    import pandas

# The column of clogfit with mean speeds from a fixed time on. In other columns this time is chosen from the data.
STEADY = "relative_speed_steady"
SPEED_NOTES = [r"distance divided by time, from $5\sigma/v_t$ on; bars: standard errors"]
# Columns of clogfit with the numbers of droplets that the mesh holds, and of clogs by mechanism.
HOLDS = ("vertices", "on_mesh", "wrapped", "squeezed", "hybrid")


def numbers(groups: Sequence[Group], label: str, **more: Sequence[Any]) -> list[dict[str, Any]]:
    """The numbers from clogfit that a figure draws, for each group."""
    columns = ["model", "line_tension", "wall_stiffness", "obstacle_gap", "obstacle_diameter",
               "obstacle_density", "near_wall_drag", "runs", "clogs",
               "clogging_length", "clogging_length_lower", "clogging_length_upper",
               STEADY, f"{STEADY}_error", "capillary_number", "doubts"]
    return [{"curve": label, **{name: group[name] for name in columns},
             **{name: values[i] for name, values in more.items()}}
            for i, group in enumerate(groups)]


def of_each(curve: Sequence[Group], *names: str) -> dict[str, list[Any]]:
    return {name: [group[name] for group in curve] for name in names}


def by(groups: Iterable[Group], name: str) -> list[tuple[Any, list[Group]]]:
    """The groups of each curve, with the value that distinguishes the curve."""
    return [(value, [group for group in groups if group[name] == value])
            for value in sorted({group[name] for group in groups})]


# the function that draws each quantity
DRAWINGS: dict[str, Callable[..., None]] = {"length": draw_lengths,
                                            "speed": functools.partial(draw_speeds, column=STEADY)}


def with_speeds(runner: Runner, config: str) -> list[Group]:
    """The groups of a sweep that have a steady speed, with the capillary number of this speed. @throws UserError if
    there are none"""
    groups = [group for group in runner.sweep(config) if group[STEADY] is not None]
    if not groups:
        raise UserError(f"no group of {runner.place_of(config)} has a {STEADY} (version 1.0 did not record it, "
                        "and it needs three runs beyond 5 sigma/v_t); "
                        "give more seeds or a larger max-time, or remove a file of version 1.0")
    return [group | {"capillary_number": group[STEADY] * math.pi / (4 * group["line_tension"])} if group["model"] == "dp" else group for group in groups]


def of_quantity(runner: Runner, config: str, quantity: str) -> list[Group]:
    return with_speeds(runner, config) if quantity == "speed" else runner.sweep(config)


def finish(axes: Axes, runner: Runner, config: str, drawn: Sequence[Group], abscissa: str, quantity: str,
           varied: Sequence[str]) -> None:
    """Adds the legend, the labels of the axes, the caption and the notes. @param quantity  a key of DRAWINGS;
    @param varied  columns that the caption leaves out"""
    if quantity == "length":
        style.logarithmic_ordinate(axes)
    style.label(axes, AXES[abscissa], AXES[quantity])
    style.caption(axes, describe(runner.columns(config), drawn, varied))
    style.notes(axes, length_notes(drawn, runner.confidence(config), [axes]) if quantity == "length" else SPEED_NOTES)
    style.legend(axes)


def curves(runner: Runner, config: str, abscissa: str, parameter: str, quantity: str) -> Plate:
    """Draws one curve for each value of a parameter. @param quantity  a key of DRAWINGS"""
    groups = of_quantity(runner, config, quantity)
    drawing, axes = style.subplots(figsize=(6.8, 5.0))
    data = []
    families = by(groups, parameter)
    places = [] if abscissa == "capillary_number" else [group[abscissa] for group in groups]
    for index, (value, members) in enumerate(families):
        label = parameter_label(runner.columns(config)[parameter], value)
        shift = style.side_by_side(index, len(families), places) if places else 1
        members = [group for group in members if group[abscissa] is not None]
        DRAWINGS[quantity](axes, [group[abscissa] * shift for group in members], members, index, label)
        data += numbers(members, label)
    style.logarithmic_abscissa(axes, places)
    finish(axes, runner, config, groups, abscissa, quantity, [parameter, abscissa])
    return Plate(drawing, data)


def enter(name: str, caption: str, config: str, cost: str, *, abscissa: str, parameter: str, quantity: str) -> None:
    """Registers a figure of curves() in the catalogue."""
    figure(name, caption, [config], cost)(lambda runner: curves(runner, config, abscissa, parameter, quantity))


enter("6c-saturated", "the same as 6c in saturated arrays, walls without friction", "clogging-saturated", "5 min",
      abscissa="line_tension", parameter="obstacle_gap", quantity="length")
enter("7a", "clogging length against wall stiffness for four values of the minimum gap (soft disk), dilute arrays",
      "clogging-sp", "1 min", abscissa="wall_stiffness", parameter="obstacle_gap", quantity="length")
enter("7a-saturated", "the same as 7a in saturated arrays", "clogging-sp-saturated", "10 s", abscissa="wall_stiffness",
      parameter="obstacle_gap", quantity="length")
enter("8a", "mean speed against line tension for four wide gaps (deformable polygon)", "speed", "1 min",
      abscissa="line_tension", parameter="obstacle_gap", quantity="speed")
enter("8b", "mean speed against line tension for three obstacle diameters", "speed-diameter", "1 min",
      abscissa="line_tension", parameter="obstacle_diameter", quantity="speed")
enter("8ca", "the speeds of 8a against the capillary number", "speed", "1 min, shared with 8a",
      abscissa="capillary_number", parameter="obstacle_gap", quantity="speed")
enter("9a", "mean speed against wall stiffness for four wide gaps (soft disk)", "speed-sp", "5 s",
      abscissa="wall_stiffness", parameter="obstacle_gap", quantity="speed")
enter("E", "mean speed against line tension for three near-wall drags", "near-wall-drag", "1 min",
      abscissa="line_tension", parameter="near_wall_drag", quantity="speed")


# The following figures compare both models at equal sags. The article defines the sag as the distance by which the top
# of a droplet sinks, up to one diameter for very soft droplets. The centroid sinks by half a diameter at most. The top
# and the centroid of a soft disk sink by the same distance, because a disk cannot change its shape.
def sags(runner: Runner, config: str, groups: Sequence[Group]) -> list[float]:
    """The sag delta_s of each group, which is the sinking of the top. The sags come from one sweep of droplets on walls, with the line tension or
    stiffness of each group."""
    is_polygon = groups[0]["model"] == "dp"
    column, key = ("line_tension", "line-tension") if is_polygon else ("wall_stiffness", "wall-stiffness")
    keys = runner.keys(config)
    settings = {name: keys[name] for name in ("model", "preset", "vertices") if name in keys}
    values = sorted({group[column] for group in groups})
    rows = runner.runs(f"sag-{config}", None, {"obstacle-layout": "wall", **settings, key: values})
    known = dict(zip(values, rows, strict=True))
    return [known[group[column]]["top_sag"] for group in groups]


# For each curve: a sweep, the curve's label, and a function that selects the groups of this curve.
Curve = tuple[str, str, Callable[[Sequence[Group]], list[Group]]]


def over_sag(runner: Runner, curves: Sequence[Curve], gap: float, quantity: str) -> Plate:
    drawing, axes = style.subplots(figsize=(6.8, 5.0))
    data, drawn = [], []
    for index, (config, label, chosen) in enumerate(curves):
        groups = [group for group in chosen(of_quantity(runner, config, quantity))
                  if math.isclose(group["obstacle_gap"], gap)]
        if not groups and runner.rows_folder:
            continue
        if not groups:
            raise UserError(f"sweep {config} has no runs with obstacle-gap={gap}; add it to the list")
        places = sags(runner, config, groups)
        DRAWINGS[quantity](axes, places, groups, index, label)
        data += numbers(groups, label, top_sag=places)
        drawn += groups
    style.logarithmic_abscissa(axes)
    axes.axvline(0.25, color="0.75", linewidth=0.8, linestyle=":", zorder=0)
    axes.text(0.25, 0.02, " published\n curves separate", ha="left", color="0.4", fontsize=8,
              transform=axes.get_xaxis_transform())
    finish(axes, runner, curves[0][0], drawn, "top_sag", quantity, ["line_tension"])
    return Plate(drawing, data)


figure("7c-saturated", "the same as 7c in saturated arrays, walls without friction", ["clogging-saturated", "clogging-sp-saturated"], "shared with 6c-saturated, 7a-saturated")(
    lambda runner: over_sag(runner, [("clogging-saturated", "deformable polygon", list),
                                     ("clogging-sp-saturated", "soft disk", list)], 0.2, "length"))
figure("9b", "mean speed against sag, deformable polygon and soft disk, minimum gap 1.1", ["speed", "speed-sp"], "shared with 8a, 9a")(
    lambda runner: over_sag(runner, [("speed", "deformable polygon", list), ("speed-sp", "soft disk", list)],
                            1.1, "speed"))


@figure("7b", "what the sag is: a soft disk and a polygon on a wall, "
              "before and after gravity sets in", ["channel"], "1 s")
def sag_picture(runner: Runner) -> Plate:
    line_tension, stiffness = 0.3, 1.0
    on_wall = {"obstacle-layout": "wall"}
    row, = runner.runs("sag-polygon", "channel", {**on_wall, "line-tension": line_tension})
    polygon, = runner.ways("sag-polygon", [row], 1, 2)
    disk, = runner.runs("sag-disk", None, {**on_wall, "model": "sp", "wall-stiffness": stiffness})
    disk_sag, polygon_sag = disk["top_sag"], row["top_sag"]
    drawing, panels = style.subplots(1, 2, figsize=(7.2, 4.2), sharey=True)
    wall = polygon.wedges[0, :2]
    # In the model gravity points along +x, and in the picture it points down.
    outlines = [np.array([shape[1] - wall[1], wall[0] - shape[0]]) for shape in polygon.polygons]
    angle = np.linspace(0, 2 * math.pi, 200)
    circle = np.array([0.5 * np.cos(angle), 0.5 + 0.5 * np.sin(angle)])
    for axes, before, after, sag, title in [
        (panels[0], circle, circle - np.array([[0], [disk_sag]]), disk_sag, f"soft disk, wall stiffness {stiffness:g}"),
        (panels[1], outlines[0], outlines[-1], polygon_sag,
         f"deformable polygon, line tension {line_tension:g}, {interface_of(polygon.word('preset'))}"),
    ]:
        axes.axhspan(-0.3, 0, facecolor=style.OBSTACLE)
        axes.fill(*after, facecolor=style.DROPLET, alpha=0.75, edgecolor="black", linewidth=1.2, label="with weight")
        axes.plot(*np.append(before, before[:, :1], axis=1), color="black", linestyle="--", linewidth=1,
                  label="without")
        top = before[1].max()
        axes.plot([-0.08, 0.08], [top, top], color="black", linewidth=1)
        axes.plot([-0.08, 0.08], [top - sag, top - sag], color="black", linewidth=1)
        axes.annotate("", (0, top - sag), (0, top), arrowprops={"arrowstyle": "-|>", "color": "black"})
        axes.text(0, top - sag - 0.04, rf"$\delta_s = {sag:.3f}\sigma$", ha="center", va="top")
        surroundings.frame_limits(axes, (-0.85, -0.25), (0.85, 1.1))
        axes.set_xlabel(r"along the wall $/\sigma$")
        style.caption(axes, title)
    panels[0].set_ylabel(r"height above the wall $/\sigma$")
    panels[1].legend(frameon=False, loc="lower center", ncols=2, fontsize=8)
    return Plate(drawing, [{"model": "sp", "wall_stiffness": stiffness, "top_sag": disk_sag},
                           {"model": "dp", "line_tension": line_tension, "top_sag": polygon_sag}])


# Clogs

CLOGS = "clogging-friction"  # With friction, walls hold wrapped droplets on every mesh.


def example(runner: Runner, mechanism: str) -> tuple[trajectory.Trajectory, pandas.Series]:
    """Replays one clog of the sweep with its outline. Of the squeezed clogs it takes the stiffest droplet that
    travelled at least half a diameter, if there is one. Of the wrapped clogs it takes the one with median shape,
    preferably among those that only hang over obstacles."""
    runner.sweep(CLOGS)
    rows = runner.rows(CLOGS)
    if "mechanism" not in rows or not rows.mechanism.any():
        raise UserError(f"{runner.place_of(CLOGS)} does not know how droplets clogged (it is of an earlier version); "
                        "remove it and sweep again")
    is_wrapped = mechanism == "wrapped"
    clogs = rows[(rows.status == "clogged") & (rows.mechanism == mechanism)]
    if is_wrapped and clogs.empty:
        clogs = rows[(rows.status == "clogged") & (rows.mechanism == "hybrid")]
    if clogs.empty:
        raise UserError(f"no {mechanism} clog in {runner.place_of(CLOGS)}; more seeds, or other line tensions")
    if is_wrapped:
        row = clogs.sort_values(["shape_parameter", "task"]).iloc[len(clogs) // 2]
    else:
        travelled = clogs[clogs.distance >= 0.5]
        row = (clogs if travelled.empty else travelled).sort_values(["line_tension", "task"]).iloc[-1]
    sweep, record = runner.record(CLOGS, mechanism, row)
    run, = runner.ways(sweep, [record], 1, max(0.5, row.time / 400))
    return run, row


def clog_title(run: trajectory.Trajectory, row: pandas.Series) -> str:
    return (rf"{trajectory.end_of(run)}: "
            rf"line tension {row.line_tension:g}, obstacle gap ${row.obstacle_gap:g}\,\sigma$, "
            rf"friction {row.friction:g}, seed {row.seed}, after $r = {row.distance:.2f}\,\sigma$")


def clog_numbers(run: trajectory.Trajectory, row: pandas.Series, frame: int) -> list[dict[str, Any]]:
    return [{"mechanism": row.mechanism, "line_tension": row.line_tension, "obstacle_gap": row.obstacle_gap,
             "seed": row.seed,
             "distance": row.distance, "x": x, "y": y} for x, y in run.polygons[frame].T]


# Width and height of the view in Figs. 5 and 6, which have the same scale [sigma]. Longer droplets need more.
VIEW = np.array([5.6, 3.2])


def view_of(outlines: Numbers) -> Numbers:
    """Width and height of a view that has room for these outlines. @param outlines  frames x 2 x N"""
    return np.maximum(VIEW, np.ptp(outlines, axis=(0, 2)) + 0.4)


def show_clog(axes: Axes, run: trajectory.Trajectory, frame: int, view: Numbers, outlines: Numbers) -> None:
    """Draws a clog. @param view  from view_of(); @param outlines  the middle of the view is the middle of these"""
    surroundings.draw_droplet(axes, run, frame)
    middle = (outlines.min(axis=(0, 2)) + outlines.max(axis=(0, 2))) / 2
    surroundings.frame_limits(axes, middle - view / 2, middle + view / 2)
    axes.set_xticks([]), axes.set_yticks([])


def snapshot(runner: Runner, mechanism: str) -> Plate:
    run, row = example(runner, mechanism)
    last = run.polygons[-1:]
    view = view_of(last)
    drawing, axes = style.subplots(figsize=(5.6, 0.3 + 5.6 * view[1] / view[0]))
    show_clog(axes, run, -1, view, last)
    surroundings.draw_guides(axes)
    style.caption(axes, clog_title(run, row))
    return Plate(drawing, clog_numbers(run, row, -1))


figure("6a", "a clog by wrapping, from the sweep of 6c", [CLOGS], "shared with 6c")(
    lambda runner: snapshot(runner, "wrapped"))
figure("6b", "a clog by squeezing, from the sweep of 6c", [CLOGS], "shared with 6c")(
    lambda runner: snapshot(runner, "squeezed"))


@figure("5", "how droplets wrap around an obstacle and squeeze into a gap: the last outlines before two clogs of 6c",
        [CLOGS], "shared with 6c")
def two_ways(runner: Runner) -> Plate:
    kinds = []
    for mechanism in ("wrapped", "squeezed"):
        run, row = example(runner, mechanism)
        final = run.polygons[-1].mean(axis=1)
        # These are the frames of the last one and a half diameters of the path.
        near = np.flatnonzero(np.hypot(*(run.polygons.mean(axis=2) - final).T) > 1.5)
        first = near[-1] + 1 if len(near) else 0
        kinds.append((run, row, first + trajectory.along_the_way(run.polygons[first:], 4)[-4:]))
    view = np.max([view_of(run.polygons[chosen]) for run, _, chosen in kinds], axis=0)
    drawing = style.new_figure(figsize=(9.0, 1.5 + 4.5 * view[1] / view[0]), layout="constrained")
    for (run, row, chosen), part in zip(kinds, drawing.subfigures(2, 1)):
        panels = part.subplots(1, 4)
        for axes, frame in zip(panels, chosen):
            show_clog(axes, run, frame, view, run.polygons[chosen])
            axes.set_title(f"$t = {run.times[frame]:.0f}\\,t_0$", fontsize=9)
        for axes in panels[len(chosen):]:
            axes.axis("off")
        surroundings.draw_guides(panels[0])
        part.suptitle(clog_title(run, row), fontsize=9, color="0.25")
    return Plate(drawing, [line for run, row, _ in kinds for line in clog_numbers(run, row, -1)])


# Single runs and P(r)

def energies(runner: Runner) -> dict[float, trajectory.Trajectory]:
    """The paths of Fig. C1 by their gap. The droplet clogs in one gap and flows in the other."""
    rows = runner.runs("energy", "trajectory",
                       {"seeds": 1, "line-tension": 0.5, "obstacle-gap": [0.3, 1.1], "clog-detection": "threshold"})
    return {row["obstacle_gap"]: way for row, way in zip(rows, runner.ways("energy", rows, 1))}


@figure("C1", "kinetic energy of a droplet that clogs and of one that flows", ["trajectory"], "2 s")
def kinetic_energy(runner: Runner) -> Plate:
    drawing, axes = style.subplots(figsize=(7.2, 4.8))
    data = []
    for index, (gap, run) in enumerate(energies(runner).items()):
        energy = np.where(run.table["kinetic_energy_ratio"] > 0, run.table["kinetic_energy_ratio"], math.nan)
        label = rf"obstacle gap ${gap}\,\sigma$ ({run.word('status')})"
        axes.plot(run.table["time"], energy, color=style.COLOURS[index], linewidth=0.9, label=label)
        data += [{"obstacle_gap": gap, "time": t, "kinetic_energy_ratio": e}
                 for t, e in zip(run.table["time"], run.table["kinetic_energy_ratio"])]
    threshold = run.row["clog_energy"]
    axes.axhline(threshold, color="0.5", linewidth=0.8, linestyle="--")
    axes.text(0.99, threshold * 2, "threshold of a clog", ha="right", fontsize=8, color="0.4",
              transform=axes.get_yaxis_transform())
    axes.set_yscale("log")
    style.label(axes, r"time $t/t_0$", r"kinetic energy / kinetic energy at terminal speed $E_k/E_t$")
    axes.legend(frameon=False)
    row = run.row
    style.caption(axes, rf"line tension 0.5, obstacle diameter ${row['obstacle_diameter']:g}\,\sigma$, "
                        rf"saturated arrays, terminal speed ${row['terminal_speed']:g}$, "
                  rf"{row['vertices']} vertices, seed {row['seed']}, {interface_of(run.word('preset'))}")
    return Plate(drawing, data)


def draw_band(axes: Axes, group: Group) -> None:
    """Draws the confidence band of P(r), up to the longest distance."""
    steps = group["survival"]
    known = [step for step in steps if step["lower"] is not None]  # The last step has no band if no run remains there.
    end = survival_curve.longest_way(group) if known == steps else steps[-1]["distance"]
    axes.fill_between([0.0] + [step["distance"] for step in known] + [end], *(
        [1.0] + [step[bound] for step in known] + [known[-1][bound] if known else 1.0] for bound in ("lower", "upper")),
        step="post", color=style.COLOURS[0], alpha=0.2, linewidth=0, label="95 % confidence band")


def lowest_shown(group: Group, end: float) -> float:
    """The lower end of the ordinate. The band, the estimate and the exponential law are above it up to the longest
    distance, unless they have reached zero."""
    lowest = [step[name] for step in group["survival"] for name in ("lower", "probability") if step[name]]
    return 0.7 * min(1.0, *lowest, math.exp(-end / group["clogging_length"]))


@figure("C2", "probability P(r) of not having clogged, with its error band and the exponential law", ["survival"], "10 s")
def survival(runner: Runner) -> Plate:
    group = runner.sweep("survival")[0]
    if not group["survival"]:
        raise UserError(f"no run has clogged in {runner.place_of('survival')}; raise max-time or seeds")
    drawing, axes = style.subplots(figsize=(6.8, 5.0))
    draw_band(axes, group)
    survival_curve.draw(axes, group, style.COLOURS[0], f"estimate from {rounded.count_text(group['runs'], 'run')}",
                        f"end of a run that still flowed ({len(group['censored_distances'])} of {group['runs']})")
    end = survival_curve.longest_way(group)
    length, lower, upper = (group[f"clogging_length{bound}"] for bound in ("", "_lower", "_upper"))
    r = np.linspace(0, end, 200)
    axes.plot(r, np.exp(-r / length), color=style.COLOURS[1], linewidth=1.4,
              label=rf"$e^{{-r/\lambda}}$ with $\lambda = {length:.3g}\sigma$ ({lower:.3g} to {upper:.3g})")
    style.logarithmic_ordinate(axes)
    axes.set_ylim(lowest_shown(group, end), 1.3)
    axes.set_xlim(0, 1.02 * end)
    style.label(axes, r"displacement along gravity $r/\sigma$", r"probability of not having clogged $P(r)$")
    axes.legend(frameon=False)
    style.caption(axes, f"{describe(runner.columns('survival'), [group])}\nWeibull's exponent "
                        f"{group['weibull_shape']:.2f}, 1 if exponential (p = {group['weibull_p_value']:.2f})")
    names = ["distance", "probability", "standard_error", "lower", "upper"]
    return Plate(drawing, [{"distance": 0.0, "probability": 1.0}]
                 + [{name: step[name] for name in names} for step in group["survival"]]
                 + [{"censored_distance": distance} for distance in group["censored_distances"]]
                 + [{"clogging_length": length, "clogging_length_lower": lower, "clogging_length_upper": upper}])


def displacements(runner: Runner) -> dict[float, trajectory.Trajectory]:
    """The paths of Fig. D by their line tension."""
    rows = runner.runs("displacement", "trajectory", {"seeds": 1, "line-tension": [0.04, 0.1, 0.2, 0.5, 1.0],
                                                      "obstacle-gap": 1.1, "preset": "elastic"})
    return {row["line_tension"]: way for row, way in zip(rows, runner.ways("displacement", rows, 2))}


@figure("D", "displacement against time for five line tensions, minimum gap 1.1", ["trajectory"], "3 s")
def displacement(runner: Runner) -> Plate:
    drawing, axes = style.subplots(figsize=(6.8, 5.0))
    data = []
    ends = {}
    for index, (line_tension, run) in enumerate(displacements(runner).items()):
        label = rf"$\Gamma = {line_tension:g}$" + (" (clogged)" if run.word("status") == "clogged" else "")
        line, = axes.plot(run.table["time"], run.table["distance"], color=style.COLOURS[index], linewidth=1.2,
                          label=label)
        ends[line] = run.table["distance"][-1]
        if run.word("status") == "clogged":
            axes.plot(run.table["time"][-1], run.table["distance"][-1], "x", color=style.COLOURS[index], markersize=8)
        data += [{"line_tension": line_tension, "time": t, "distance": r}
                 for t, r in zip(run.table["time"], run.table["distance"])]
    row = run.row
    t = np.array([0, axes.get_xlim()[1]])
    fastest, = axes.plot(t, row["terminal_speed"] * t, ":", color="0.5", linewidth=1, label="terminal speed $v_t$")
    axes.set_xlim(0, t[1]), axes.set_ylim(bottom=0)
    style.label(axes, r"time $t/t_0$", r"displacement along gravity $r/\sigma$")
    axes.legend(handles=[fastest, *sorted(ends, key=ends.__getitem__, reverse=True)], frameon=False)
    style.caption(axes, rf"obstacle gap ${row['obstacle_gap']:g}\,\sigma$, "
                        rf"obstacle diameter ${row['obstacle_diameter']:g}\,\sigma$, saturated array, "
                  rf"terminal speed ${row['terminal_speed']:g}$, {row['vertices']} vertices, seed {row['seed']}, "
                  rf"{interface_of(run.word('preset'))}")
    return Plate(drawing, data)
