"""Draws clogging lengths and mean speeds against the varied parameter, with a curve for each obstacle array."""

import functools
import math
import textwrap
from collections.abc import Callable, Collection, Iterable, Sequence

from matplotlib.axes import Axes
from matplotlib.axis import Axis

from .. import style
from ..labels import AXES, LABORATORY
from ..labels.groups import Groups
from ..tools import rounded
from ..tools.hints import Group

# The doubts of clogfit that concern the length itself, with the words for them in a note.
HOLLOW_MARKERS = {
    "few_clogs": "fewer than 5 clogs",
    "equal_distances": "runs that are copies of each other, or clogs at one place",
    "held_by_mesh": "clogs that the polygon's corners may hold",
    "near_friction_limit": "clogs that almost exceed the friction (a finer mesh may let them go)",
    "wetted_mesh": "wetted walls, where the mesh matters",
    "array_repeats": "longer paths than the period of the array",
    "below_spacing": "lengths below one obstacle spacing (they reflect the release void, not clogging)",
    "failures_matter": "failures, which would change the length if they were clogs",
    "untested": "outside the range that was tested for soundness",
}


def reasons_for_hollow_marker(group: Group) -> list[str]:
    """The doubts that make a group's marker hollow. A group without clogs has an arrow in place of a marker. The arrow
    already shows that clogs are few."""
    return [doubt for doubt in style.doubts(group)
            if doubt in HOLLOW_MARKERS and (doubt != "few_clogs" or group["clogs"] > 0)]


SPEED_NOTES = ["bars: standard errors"]
NOTE_WIDTH = 100  # Number of characters in a line below a picture.
# clogfit's name for distance divided by time, averaged over all runs, even over those with a short distance.
OF_ALL_RUNS = "relative_speed_all"
THROUGH_BOUNDS = "_through bounds"  # The underscore hides a line from matplotlib's legends.
FITTED = "_fitted"
FITTED_TO_COMMON_OBSTACLES = "_fitted, common obstacles"  # Fitted curve through points that share seeds.


def length_notes(groups: Collection[Group], confidence: float, panels: Iterable[Axes],
                 other: str = "other clogs") -> list[str]:
    """Explains those markers, bars, arrows and dotted lines of draw_lengths() that occur in the picture.
    @param panels  the axes with the curves
    @param other  see style.mechanism_note()
    @return  lines of text"""
    labels = {line.get_label() for axes in panels for line in axes.lines}
    marks = [f"bars: {100 * confidence:g} % confidence intervals"] if any(group["clogs"] > 0 for group in groups) else []
    if any(group["clogs"] == 0 for group in groups):
        marks.append("arrows: lower bounds (no run clogged)"
                     + (", joined by dotted lines" if THROUGH_BOUNDS in labels else ""))
    if labels & {FITTED, FITTED_TO_COMMON_OBSTACLES}:
        marks.append(f"lines: fitted curves, with {100 * confidence:g} % bands")
    lines = [line for line in (style.mechanism_note(groups, other), "; ".join(marks)) if line]
    if FITTED_TO_COMMON_OBSTACLES in labels:
        lines.append("points of a curve share seeds and so obstacles: their errors are correlated")
    return lines + flaw_notes(groups)


def flaw_notes(groups: Collection[Group]) -> list[str]:
    """Explains hollow markers, and states how many points have unfinished or failed runs."""
    lines = []
    reasons = dict.fromkeys(HOLLOW_MARKERS[reason] for group in groups for reason in reasons_for_hollow_marker(group))
    if reasons:
        lines += textwrap.wrap(f"hollow: {', or '.join(reasons)}", NOTE_WIDTH)
    return lines + failure_notes(groups)


def failure_notes(groups: Collection[Group], noun: str = "point") -> list[str]:
    """States how many points or curves have unfinished or failed runs."""
    lines = []
    if num_incomplete := sum("incomplete" in style.doubts(group) for group in groups):
        lines.append(f"incomplete: runs of {num_incomplete} of {rounded.count_text(len(groups), noun)} are unfinished")
    if num_failed := sum((group.get("failed") or 0) > 0 for group in groups):
        lines.append(f"failed: some runs of {num_failed} of {rounded.count_text(len(groups), noun)} "
                     "(not clogged up to their last check)")
    return lines


def automatic_notes(groups: Groups) -> list[str]:
    """States how many points are at an automatic value of the abscissa, which the user has not chosen."""
    number = groups.num_automatic(groups.abscissa) if groups.varies(groups.abscissa) else 0
    key = groups.abscissa_key().replace("_", " ")
    return [f"automatic: the {key} of {number} of {rounded.count_text(len(groups.members), 'point')} follows "
            "from other parameters"] if number else []


def excluded_notes(groups: Groups) -> list[str]:
    """Names the points that belong to no fitted curve."""
    excluded = groups.excluded_from_curves()
    return textwrap.wrap(f"not in a curve: {'; '.join(excluded)}", NOTE_WIDTH) if excluded else []


def finish_lengths(axes: Axes, groups: Groups, drawn: Collection[Group], other: str = "other clogs") -> None:
    """Adds the ordinate, the legend and the caption to a picture of clogging lengths.
    @param drawn  all groups that were passed to draw_lengths()
    @param other  see style.mechanism_note()"""
    style.logarithmic_ordinate(axes)
    style.finish(axes, (LABORATORY if groups.are_in_mm else AXES)["length"], groups.caption(),
                 [*length_notes(drawn, groups.confidence, [axes], other), *automatic_notes(groups),
                  *excluded_notes(groups)])


def draw_lengths(axes: Axes, places: Sequence[float], groups: Sequence[Group], index: int, label: str,
                 linestyle: str | tuple[int, tuple[int, ...]] | None = None, size: float = 5.5, unit: str = "") -> None:
    """Draws clogging lengths with clogfit's intervals. The shape of a marker shows the most frequent mechanism of the
    clogs. The marker is hollow if the length is in doubt (HOLLOW_MARKERS). If no run clogged, an arrow begins at the
    lower bound.
    @param linestyle  None: that of `index`
    @param size  of markers [pt]
    @param unit  end of the names of clogfit's columns: "_mm", or "" for sigma"""
    order = sorted(range(len(groups)), key=lambda i: places[i])
    places, groups = [places[i] for i in order], [groups[i] for i in order]
    # A length is NaN if no run clogged. The solid line is interrupted there, and a dotted line continues it.
    middle, lower, upper = (f"clogging_length{end}{unit}" for end in ("", "_lower", "_upper"))
    lengths = [math.nan if group["clogs"] == 0 else group[middle] for group in groups]
    bars = [[math.nan if group["clogs"] == 0 else abs(group[middle] - group[end]) for group in groups]
            for end in (lower, upper)]
    colour, line = (style.curve_style(index)[name] for name in ("color", "linestyle"))
    has_bars = any(group["clogs"] > 0 for group in groups)
    axes.errorbar(places, lengths, yerr=bars if has_bars else None, color=colour, linestyle=linestyle or line,
                  linewidth=1, elinewidth=1, capsize=2.5, label=label, gid=style.mark("curve", groups))
    for x, y, group in zip(places, lengths, groups):
        # "auto" follows the line's colour, even if a user changes it later.
        face = "white" if reasons_for_hollow_marker(group) else "auto"
        axes.plot(x, y, color=colour, marker=style.MECHANISM_MARKERS[style.main_mechanism(group)], markerfacecolor=face,
                  markersize=size, zorder=3, gid=style.mark("point", [group]) if group["clogs"] > 0 else None)
    if linestyle != "none" and len(groups) > 1 and any(group["clogs"] == 0 for group in groups):
        through = [group[lower if group["clogs"] == 0 else middle] for group in groups]
        axes.plot(places, through, color=colour, linewidth=0.8, linestyle=":", zorder=1, label=THROUGH_BOUNDS)
    bounds = [(x, group) for x, group in zip(places, groups) if group["clogs"] == 0]
    if bounds:
        axes.margins(y=0.12)  # for the arrows
    axes.plot([x for x, _ in bounds], [group[lower] for _, group in bounds], color=colour, marker=style.LOWER_BOUND,
              markerfacecolor="none", linestyle="none",
              markersize=4.5 * size * (1 + 0.3 * (index % 5)),  # The heads of arrows at one place are side by side.
              gid=style.mark("point", [group for _, group in bounds]))


def draw_speeds(axes: Axes, places: Sequence[float], groups: Sequence[Group], index: int, label: str,
                column: str = "relative_speed") -> None:
    """Draws mean speeds relative to the terminal speed. If a group has several runs, its bar is the standard error from
    the scatter between runs.
    @param column  "relative_speed" is the mean of the runs that went far enough to have a speed, as published. The
    other columns are OF_ALL_RUNS and "lateral_slope"."""
    points = sorted(((place, group) for place, group in zip(places, groups) if group[column] is not None),
                    key=lambda point: point[0])
    known = [group for _, group in points]
    drawn = axes.errorbar([x for x, _ in points],
                          [group[column] for group in known], yerr=[group[f"{column}_error"] or 0.0 for group in known],
                          **style.curve_style(index), markersize=5, linewidth=1, elinewidth=1, capsize=2.5, label=label,
                          gid=style.mark("curve", known))
    drawn.lines[0].set_gid(style.mark("point", known))


def speed_column(groups: Iterable[Group]) -> str:
    """The column with the mean speed. The mean over the runs that went far enough to have a speed is too high, because
    most of these runs are fast. The speed of all runs does not have this bias, and is preferred. Files without dwells
    do not have the speed of all runs."""
    return OF_ALL_RUNS if any(group.get(OF_ALL_RUNS) is not None for group in groups) else "relative_speed"


def have_speeds(groups: Collection[Group]) -> bool:
    return any(group[speed_column(groups)] is not None for group in groups)


def speed_notes(groups: Collection[Group]) -> list[str]:
    """Notes that explain the points of draw_speeds_on()."""
    if speed_column(groups) == OF_ALL_RUNS:
        return ["distance divided by time, of all runs; bars: standard errors"]
    fewer = any(group["relative_speed_runs"] < group["runs"] for group in groups)
    return ["mean of the runs that went far enough, the fast ones where droplets clog; "
            "bars: standard errors"] if fewer else SPEED_NOTES


def add_laboratory(axes: Axes, groups: Groups, ordinate: str) -> None:
    """Adds a second scale in the units of the laboratory, if the sweep or clogfit knows the laboratory. @param ordinate
    "length" or "speed"
    """
    if upright := groups.laboratory.get({"length": "length_mm", "speed": "speed_mm_per_s"}[ordinate]):
        add_scale(axes, "right", upright, LABORATORY[ordinate])
    tension = groups.laboratory.get("tension_mN_per_m_of_gamma_1")
    if tension and groups.abscissa == "line_tension":
        add_scale(axes, "top", tension, LABORATORY["line_tension"])


def add_scale(axes: Axes, side: str, factor: float, label: str) -> Axis:
    """Adds a second scale in other units at a side, "top" or "right". Complete the first scale before this call,
    because later changes would remove the ticks of the second scale. @return the axis of the second scale"""
    upright = side == "right"
    second = (axes.secondary_yaxis if upright else axes.secondary_xaxis)(side, functions=(lambda value: value * factor, lambda value: value / factor))
    axis = second.yaxis if upright else second.xaxis
    axis.set_label_text(label)
    if (axes.get_yscale() if upright else axes.get_xscale()) == "log":
        first, last = axes.get_ylim() if upright else axes.get_xlim()
        style.plain_logarithmic(axis, last / first)
    return axis


def draw_curves(axes: Axes, groups: Groups, draw_curve: Callable[..., None]) -> None:
    """Draws each curve of the groups. @param draw_curve  draw_lengths or draw_speeds. The function is called with the
    axes, the places and groups of a curve, its index and its label"""
    curves = groups.curves()
    for index, (label, members) in enumerate(curves):
        with style.curve(axes, label):
            draw_curve(axes, places(groups, members, index, len(curves)), members, index, label)
    draw_abscissa(axes, groups)


def places(groups: Groups, members: Sequence[Group], index: int, num_curves: int) -> list[float]:
    """The places of a curve's points. Points are shifted so that their bars do not cover the bars of other curves."""
    values = groups.values(groups.abscissa)
    if groups.is_logarithmic():
        return [group[groups.abscissa] * style.side_by_side(index, num_curves, values) for group in members]
    step = min(0.006, 0.06 / max(num_curves - 1, 1))
    shift = step * (max(values) - min(values)) * (index - (num_curves - 1) / 2)
    return [group[groups.abscissa] + shift for group in members]


def draw_abscissa(axes: Axes, groups: Groups) -> None:
    if groups.is_logarithmic():
        style.logarithmic_abscissa(axes, [group[groups.abscissa] for group in groups.members])
    axes.set_xlabel(groups.axis_label())


def draw_fitted(axes: Axes, groups: Groups, members: Sequence[Group], index: int) -> bool:
    """Draws the smooth curve that was fitted to these groups, with its band. @return whether such a curve exists"""
    fitted = groups.fitted_curve(members)
    if not fitted:
        return False
    x = [place[groups.abscissa] for place in fitted["curve"]]
    lengths, lower, upper = ([place[f"clogging_length{end}"] for place in fitted["curve"]]
                             for end in ("", "_lower", "_upper"))
    style_of_curve = style.curve_style(index)
    axes.fill_between(x, lower, upper, color=style_of_curve["color"], alpha=0.13, linewidth=0, zorder=0)
    label = FITTED_TO_COMMON_OBSTACLES if fitted["common_obstacles"] else FITTED
    axes.plot(x, lengths, color=style_of_curve["color"], linestyle=style_of_curve["linestyle"], linewidth=1.2,
              label=label, zorder=1)
    return True


def draw_on(axes: Axes, groups: Groups) -> None:
    """Draws points with their bars, and fitted curves through the points. Where no curve could be fitted, straight
    lines join the points."""
    def draw_curve(axes: Axes, places: Sequence[float], members: Sequence[Group], index: int, label: str) -> None:
        is_fitted = draw_fitted(axes, groups, members, index)
        draw_lengths(axes, places, members, index, label, linestyle="none" if is_fitted else None,
                     unit="_mm" if groups.are_in_mm else "")

    draw_curves(axes, groups, draw_curve)
    finish_lengths(axes, groups, groups.members)
    add_laboratory(axes, groups, "length")


def draw_speeds_on(axes: Axes, groups: Groups) -> None:
    draw_curves(axes, groups, functools.partial(draw_speeds, column=speed_column(groups.members)))
    add_laboratory(axes, groups, "speed")
    has_points = any(curve.lines[0].get_xdata().size for curve in axes.containers)
    of_all = " of all runs" if speed_column(groups.members) == OF_ALL_RUNS else ""
    style.finish(axes, AXES["speed"] + of_all, groups.caption(),
                 [*speed_notes(groups.members), *automatic_notes(groups)] if has_points else [])
