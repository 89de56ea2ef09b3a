"""How all figures look: colours, axes, error bars, and what is written beside a picture."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Iterable, Sequence
from typing import Any

import matplotlib
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.legend import Legend
from matplotlib.lines import Line2D

from ..labels import AXES
from ..labels.groups import Groups
from ..tools import rounded
from ..tools.hints import AnyPath, Group

# Okabe and Ito's palette, safe for colour-blind readers; a marker of its own for every curve besides.
COLOURS = ["#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000"]
MARKERS = ["o", "s", "D", "v", "P", "X", "*"]
MECHANISM_COLOURS = {"wrapped": COLOURS[0], "squeezed": COLOURS[1], "hybrid": COLOURS[2], "other": COLOURS[3]}
CAUSE_COLOURS = {**MECHANISM_COLOURS, "broken": COLOURS[4]}
MECHANISM_MARKERS = {"wrapped": "o", "squeezed": "s", "hybrid": "D", "other": "X"}
VIRIDIS = matplotlib.colormaps["viridis"]
OBSTACLE = "0.72"
DROPLET = "#D55E00"

def new_figure(**options: Any) -> Figure:
    """Not one of `pyplot`'s, which stay in memory and belong to a backend: whoever draws in a notebook has chosen one."""
    made = Figure(**options)
    FigureCanvasAgg(made)
    return made


def subplots(rows: int = 1, columns: int = 1, *, figsize: tuple[float, float], **options: Any) -> tuple[Figure, Any]:
    """A figure laid out by itself, and its axes, as `pyplot`'s."""
    made = new_figure(figsize=figsize, layout="constrained")
    return made, made.subplots(rows, columns, **options)


def figure_of(draw: Callable[..., None], *what: Any) -> Figure:
    """A figure with one drawing. @param draw  called with the axes and what follows here"""
    figure, axes = subplots(figsize=(6.4, 4.8))
    draw(axes, *what)
    return figure


def curve_style(index: int) -> dict[str, Any]:
    """Of no two curves the same: once colours and markers are used up, lines are broken, by more dots each time."""
    round_, which = divmod(index, len(COLOURS))
    line = (0, (6, 2) + (1, 2) * (round_ - 1)) if round_ > 0 else "-"
    return {"color": COLOURS[which], "marker": MARKERS[which], "linestyle": line}


# Doubts of clogfit in a length itself, and what to say of them under a picture.
OPEN_MARKERS = {
    "few_clogs": "fewer than 5 clogs: more seeds are needed",
    "held_by_mesh": "the polygon's corners may hold droplets: more vertices are needed",
    "array_repeats": "droplets went farther than the array is long, which repeats",
    "below_spacing": "shorter than one obstacle spacing, the depth of the void of release",
    "not_proved_sound": "outside of what was proved sound",
}


def mark(kind: str, groups: Collection[Group]) -> str | None:
    """The name (`gid`) of what stands for groups of a report (report.write()); elsewhere they have no numbers.
    @param kind  point, curve or legend"""
    numbers = [str(group["number"]) for group in groups if "number" in group]
    return f"{kind}-{','.join(numbers)}" if numbers else None


def mark_legend(legend: Legend, handles: Sequence[Any]) -> None:
    """Entries of what has a name of mark() stand for the same."""
    for handle, text in zip(handles, legend.get_texts()):
        name = (handle.lines[0] if hasattr(handle, "lines") else handle).get_gid()
        if name:
            text.set_gid(f"legend-{name.partition('-')[2]}")


def doubts(group: Group) -> list[str]:
    return (group["doubts"] or "").split()


def reasons_for_open_marker(group: Group) -> list[str]:
    """Of a group without clogs, whose marker is a triangle, it goes without saying that they are few."""
    return [doubt for doubt in doubts(group) if doubt in OPEN_MARKERS and (doubt != "few_clogs" or group["clogs"] > 0)]


THROUGH_BOUNDS = "_through bounds"  # label of a line, in no legend


def length_note(groups: Collection[Group], confidence: float, panels: Iterable[Axes]) -> str:
    """What bars, open markers, triangles and dotted lines of draw_lengths() mean, as far as they are there.
    @param panels  that they were drawn on"""
    notes = [f"bars: {100 * confidence:g} % confidence"] if any(group["clogs"] > 0 for group in groups) else []
    for reason in dict.fromkeys(reason for group in groups for reason in reasons_for_open_marker(group)):
        notes.append(f"open markers: {OPEN_MARKERS[reason]}")
    if any(group["clogs"] == 0 for group in groups):
        are_dotted = any(line.get_label() == THROUGH_BOUNDS for axes in panels for line in axes.lines)
        notes.append("open triangles: lower bound, no run clogged" + (", dotted: through bounds" if are_dotted else ""))
    if num_incomplete := sum("incomplete" in doubts(group) for group in groups):
        notes.append(f"not complete: {num_incomplete} of {rounded.counted(len(groups), 'point')} with runs that are under way, interrupted or failed")
    return "\n".join(notes)


def main_mechanism(group: Group) -> str:
    """What holds most of the clogs of a group."""
    return max(MECHANISM_MARKERS, key=lambda name: group[name])


def finish_lengths(axes: Axes, groups: Groups, drawn: Collection[Group], other: str = "other clogs") -> None:
    """The ordinate, legend and caption of a picture of clogging lengths. @param drawn  all that draw_lengths() was given"""
    logarithmic_ordinate(axes)
    axes.set_ylabel(AXES["length"])
    grid(axes)
    legend(axes, drawn, other)
    caption(axes, f"{groups.caption()}\n{groups.note(length_note(drawn, groups.confidence, [axes]))}")


def legend(axes: Axes, groups: Collection[Group] = (), other: str = "other clogs") -> None:
    """Of the curves if they have names, and of the markers that draw_lengths() gave these groups. That of many is
    beside the axes, in a figure that is as much wider. @param other  what clogs are called that are of no mechanism"""
    curves = [(handle, label) for handle, label in zip(*axes.get_legend_handles_labels()) if label]
    names = {main_mechanism(group) for group in groups if group["clogs"] > 0}
    markers = [(Line2D([], [], color="0.4", marker=marker, linestyle="none"), f"most clogs {name}" if name != "other" else other)
               for name, marker in MECHANISM_MARKERS.items() if name in names]
    entries = [*curves, *markers]
    if len(entries) > len(COLOURS):
        made = axes.legend(*zip(*entries), frameon=False, fontsize=7, handlelength=4, ncols=math.ceil(len(entries) / 28),
                           loc="upper left", bbox_to_anchor=(1, 1))
        figure = axes.figure
        if isinstance(figure, Figure):  # not a part of one, whose width is given
            figure.set_figwidth(figure.get_figwidth() + made.get_window_extent(figure.canvas.get_renderer()).width / figure.dpi)
    elif entries:
        made = axes.legend(*zip(*entries), frameon=False)
    if curves:
        mark_legend(made, [handle for handle, _ in curves])


def draw_lengths(axes: Axes, places: Sequence[float], groups: Sequence[Group], index: int, label: str, linestyle: str | tuple[int, tuple[int, ...]] | None = None,
                 size: float = 5.5) -> None:
    """Clogging lengths with clogfit's intervals, `linestyle` where it is not that of the index, markers of `size` points. The marker is that of what holds most of the clogs; an open one is a
    length in doubt (OPEN_MARKERS), an open triangle a lower bound, where no run clogged."""
    order = sorted(range(len(groups)), key=lambda i: places[i])
    places, groups = [places[i] for i in order], [groups[i] for i in order]
    # Not a number where no run clogged: the line is broken there, and goes on dotted.
    lengths = [math.nan if group["clogs"] == 0 else group["clogging_length"] for group in groups]
    bars = [
        [math.nan if group["clogs"] == 0 else abs(group["clogging_length"] - group[end]) for group in groups]
        for end in ("clogging_length_lower", "clogging_length_upper")
    ]
    colour, line = (curve_style(index)[name] for name in ("color", "linestyle"))
    line = linestyle or line
    axes.errorbar(places, lengths, yerr=bars, color=colour, linestyle=line, linewidth=1, elinewidth=1, capsize=2.5, label=label,
                  gid=mark("curve", groups))
    for x, y, group in zip(places, lengths, groups):
        face = "white" if reasons_for_open_marker(group) else colour
        axes.plot(x, y, color=colour, marker=MECHANISM_MARKERS[main_mechanism(group)], markerfacecolor=face, markersize=size, zorder=3,
                  gid=mark("point", [group]) if group["clogs"] > 0 else None)
    if len(groups) > 1 and any(group["clogs"] == 0 for group in groups):
        through = [group["clogging_length_lower"] if group["clogs"] == 0 else group["clogging_length"] for group in groups]
        axes.plot(places, through, color=colour, linewidth=0.8, linestyle=":", zorder=1, label=THROUGH_BOUNDS)
    bounds = [(x, group) for x, group in zip(places, groups) if group["clogs"] == 0]
    axes.plot(
        [x for x, _ in bounds], [group["clogging_length_lower"] for _, group in bounds],
        color=colour, marker="^", markerfacecolor="white", markersize=size + 2.5, linestyle="none", gid=mark("point", [group for _, group in bounds]),
    )


def draw_speeds(axes: Axes, places: Sequence[float], groups: Sequence[Group], index: int, label: str) -> None:
    """Mean speeds over the terminal speed, with standard errors from the scatter between runs."""
    points = sorted(((place, group) for place, group in zip(places, groups) if group["relative_speed"] is not None), key=lambda point: point[0])
    known = [group for _, group in points]
    drawn = axes.errorbar(
        [x for x, _ in points], [group["relative_speed"] for group in known], yerr=[group["relative_speed_error"] or 0.0 for group in known],
        **curve_style(index), markersize=5, linewidth=1, elinewidth=1, capsize=2.5, label=label, gid=mark("curve", known),
    )
    drawn.lines[0].set_gid(mark("point", known))


def logarithmic_margin(values: Collection[float]) -> float:
    """Factor by which a logarithmic axis goes on beyond these values."""
    return (max(values) / min(values)) ** 0.05 if max(values) > min(values) else 1.3


def side_by_side(index: int, num_curves: int, values: Collection[float]) -> float:
    """Factor on logarithmic abscissae that curves share: moved apart by a percent, or less so that all of them stay off
    the frame, their bars can be told apart."""
    outermost = max(num_curves - 1, 1) / 2
    return min(1.012, logarithmic_margin(values) ** (0.7 / outermost)) ** (index - (num_curves - 1) / 2)


def far_apart(values: Collection[float]) -> list[float]:
    """Of values on a logarithmic axis those whose labels have room side by side."""
    ordered = sorted(set(values))
    room = 0.08 * math.log(ordered[-1] / ordered[0])
    kept = ordered[:1]
    for value in ordered[1:]:
        if math.log(value / kept[-1]) >= room:
            kept.append(value)
    return kept


def logarithmic_abscissa(axes: Axes, values: Collection[float] = ()) -> None:
    """Plain numbers, at the values themselves where they are few or within a decade."""
    axes.set_xscale("log")
    axis = axes.xaxis
    axis.set_major_formatter(matplotlib.ticker.FuncFormatter(lambda value, _: f"{value:.3g}"))
    if values and (len(set(values)) <= 10 or max(values) < 10 * min(values)):
        axis.set_ticks(far_apart(values), minor=False)
        axis.set_ticks(values, minor=True)
        axis.set_minor_formatter(matplotlib.ticker.NullFormatter())
    if values:
        # Ticks widen an axis without a margin: what is drawn at the last one would lie on the frame.
        margin = logarithmic_margin(values)
        axes.set_xlim(min(values) / margin, max(values) * margin)


def logarithmic_ordinate(axes: Axes) -> None:
    """Plain numbers where it has fewer than two decades, at 1, 2 and 5, or at every mark of less than half a decade: powers
    of ten would be too few."""
    axes.set_yscale("log")
    axis = axes.yaxis
    usual = axis.get_major_formatter()

    def label(value: float, digits: tuple[int, ...], otherwise: str) -> str:
        low, high = axes.get_ylim()
        if high >= 100 * low:
            return otherwise
        first = value / 10.0 ** rounded.exponent(value)
        return f"{value:.4g}" if high < 5 * low or any(math.isclose(first, digit) for digit in digits) else ""

    axis.set_minor_formatter(matplotlib.ticker.FuncFormatter(lambda value, _: label(value, (2, 5), "")))
    axis.set_major_formatter(matplotlib.ticker.FuncFormatter(lambda value, position: label(value, (1, 10), usual(value, position))))


def grid(axes: Axes) -> None:
    axes.grid(True, which="major", color="0.9", linewidth=0.6)
    axes.set_axisbelow(True)


def caption(axes: Axes, text: str) -> None:
    """Above the axes; lines that are wider than these go on below."""
    title = axes.set_title(text, fontsize=8, color="0.25")
    renderer = axes.figure.canvas.get_renderer()
    widest = 1.1 * axes.get_window_extent(renderer).width  # the layout makes axes wider than they are now

    def fits(line: str) -> bool:
        title.set_text(line)
        return title.get_window_extent(renderer).width <= widest

    lines = []
    for line in text.strip().split("\n"):
        first, *others = line.split(", ")
        lines.append(first)
        for phrase in others:
            if fits(f"{lines[-1]}, {phrase}"):
                lines[-1] += f", {phrase}"
            else:
                lines[-1] += ","
                lines.append(phrase)
    title.set_text("\n".join(lines))


def save(figure: Figure, output: AnyPath, metadata: dict[str, str] | None = None) -> None:
    """Writes OUTPUT.png and OUTPUT.pdf. @param output  path without ending"""
    # Not with_suffix(): a name may hold a dot.
    metadata = metadata or {}
    figure.savefig(f"{output}.png", dpi=160, metadata=metadata)
    # Laid out once.
    figure.set_layout_engine("none")
    subject = {"Title": metadata.get("Title"), "Subject": metadata.get("Description")}
    figure.savefig(f"{output}.pdf", metadata={key: value for key, value in subject.items() if value})
