"""Draws clogging lengths against the line tension in several panels. The panels share axes, legend and caption."""

import math
from collections.abc import Callable, Collection, Sequence
from typing import Any

from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from .. import style
from ..drawing.lengths import draw_lengths, length_notes
from ..labels import AXES
from ..tools.hints import Group
from .captions import describe
from .runner import Runner

# For each curve: its groups, the number of its colour, its name in the legend, and options of draw_lengths().
Curve = tuple[Sequence[Group], int, str, dict[str, Any]]
# For each panel: words that distinguish it, and its curves.
Panel = tuple[str, Sequence[Curve]]


def explain_gap(axes: Axes, tensions: Sequence[float], groups: Sequence[Group]) -> None:
    """Marks the range of line tensions below those of this panel. Line tensions in this range were run for other panels
    only. @param tensions  of all panels, ascending"""
    first = min(group["line_tension"] for group in groups)
    if first == tensions[0]:
        return
    left, right = axes.get_xlim()[0], math.sqrt(first * tensions[tensions.index(first) - 1])
    axes.axvspan(left, right, color="0.94", zorder=0)
    clogs = sum(group["clogs"] for group in groups if group["line_tension"] == first)
    axes.text(math.sqrt(left * right), 0.5, "not run" + ("" if clogs else f":\nno droplet\nclogs at {first:g}"),
              ha="center", va="center", fontsize=8, color="0.35", transform=axes.get_xaxis_transform())


def draw(runner: Runner, config: str, panels: Sequence[Panel], without: Collection[str], across: int = 2,
         marks: Sequence[tuple[Artist, str]] = (), on_each: Callable[[Axes], None] = lambda axes: None) -> Figure:
    """Draws the panels.
    @param config  a sweep, for its columns and its confidence
    @param without  parameters that the caption leaves out
    @param across  number of panels side by side
    @param marks  legend entries for what `on_each` draws and for other marks"""
    every = [group for _, curves in panels for groups, *_ in curves for group in groups]
    tensions = sorted({group["line_tension"] for group in every})
    num_colours = 1 + max(index for _, curves in panels for _, index, *_ in curves)
    down = math.ceil(len(panels) / across)
    drawing = style.new_figure(figsize=(4.4 * across, 3.5 * down + 1.2), layout="constrained")
    above, below = drawing.subfigures(2, 1, height_ratios=[3.5 * down + 0.5, 0.7])
    all_axes = above.subplots(down, across, sharex=True, sharey=True, squeeze=False)
    entries: dict[str, Any] = {}
    for (title, curves), axes in zip(panels, all_axes.flat):
        for groups, index, label, options in curves:
            shift = style.side_by_side(index, num_colours, tensions)**1.7  # panels are narrow
            draw_lengths(axes, [group["line_tension"] * shift for group in groups], groups, index, label, **options)
        on_each(axes)
        style.logarithmic_ordinate(axes)
        style.logarithmic_abscissa(axes, tensions)
        style.grid(axes)
        axes.set_title(title, fontsize=9)
        explain_gap(axes, tensions, [group for groups, *_ in curves for group in groups])
        entries |= {label: handle for handle, label in zip(*axes.get_legend_handles_labels())
                    if label not in entries or handle.has_yerr}
    for axes in list(all_axes.flat)[len(panels):]:
        axes.axis("off")
    for line in all_axes:
        line[0].set_ylabel(AXES["length"])
    for axes in all_axes[-1]:
        axes.set_xlabel(AXES["line_tension"])
    handles = [(handle, label) for label, handle in entries.items()] + list(marks)
    below.legend(*zip(*handles), loc="center", ncols=4, frameon=False, fontsize=8, handlelength=3.5)
    fits = style.fitting(drawing, 8, 0.9 * drawing.bbox.width)
    drawing.suptitle(style.in_lines(describe(runner.columns(config), every, without), fits), fontsize=8, color="0.25")
    style.notes_of_panels(drawing, length_notes(every, runner.confidence(config), all_axes.flat))
    return drawing
