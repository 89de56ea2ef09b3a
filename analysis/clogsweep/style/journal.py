"""Lays a figure out for the width of a journal's column. All text has the same size, the legend is above the axes, and
labels do not overlap."""

import re
from collections.abc import Callable

from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.figure import Figure, FigureBase
from matplotlib.lines import Line2D
from matplotlib.text import Text
from matplotlib.transforms import Bbox

from ..tools.errors import UserError

NOTES = "notes"  # The name (`gid`) of the notes that explain the marks.
INCH = 2.54  # [cm]


def in_lines(text: str, fits: Callable[[str], bool], between: str = ", ") -> str:
    """Breaks the text into lines that fit. A line is broken only between phrases, never within a formula."""
    lines = []
    for line in re.sub(r"\$.*?\$", lambda formula: formula[0].replace(" ", "\0"), text.strip()).split("\n"):
        first, *others = line.split(between)
        lines.append(first)
        for phrase in others:
            if fits(f"{lines[-1]}{between}{phrase}".replace("\0", " ")):
                lines[-1] += between + phrase
            else:
                lines[-1] += between.rstrip()
                lines.append(phrase)
    return "\n".join(lines).replace("\0", " ")


def fitting(figure: FigureBase, size: float, pixels: float) -> Callable[[str], bool]:
    """Returns a function that checks whether a line of text in letters of `size` points fits into this width."""
    def fits(line: str) -> bool:
        text = figure.text(0, 0, line, fontsize=size)
        width = text.get_window_extent(figure.canvas.get_renderer()).width
        text.remove()
        return bool(width <= pixels)

    return fits


def legend_entries(axes: Axes) -> list[tuple[Artist, str]]:
    """The labelled artists. Artists without data come last, because they only explain a mark."""
    entries = [(artist, label) for artist, label in zip(*axes.get_legend_handles_labels()) if label]
    return sorted(entries, key=lambda entry: isinstance(entry[0], Line2D) and not len(entry[0].get_xdata()))


def draw_legend(axes: Axes, size: float) -> float:
    """Draws a legend at the top of the figure, with as many columns as fit. @return its height [pixels]"""
    figure = axes.figure
    fits = fitting(figure, size, figure.bbox.width - 4 * size / 72 * figure.dpi)  # the width beside a handle
    artists, labels = zip(*((artist, in_lines(label, fits)) for artist, label in legend_entries(axes)))
    earlier = axes.get_legend()
    title = earlier.get_title().get_text() if earlier else ""
    for columns in range(len(labels), 0, -1):
        made = axes.legend(artists, labels, title=title, title_fontsize=size, frameon=False, fontsize=size,
                           ncols=columns, loc="upper center", bbox_to_anchor=(0.5, 1),
                           bbox_transform=figure.transFigure, borderaxespad=0.2, borderpad=0.2, labelspacing=0.3,
                           columnspacing=0.8, handlelength=1.3, handletextpad=0.4)
        extent = made.get_window_extent(figure.canvas.get_renderer())
        if extent.width <= figure.bbox.width:
            break
    made.set_in_layout(False)
    return float(extent.height)


def hide_overlapping(axis: Axis) -> None:
    """Hides tick labels that overlap others. Labels of minor ticks are hidden first."""
    kept: list[Bbox] = []
    low, high = sorted(axis.get_view_interval())
    for label in [*axis.get_majorticklabels(), *axis.get_minorticklabels()]:
        if label.get_text() and low <= label.get_position()[axis.axis_name == "y"] <= high:
            box = label.get_window_extent(axis.figure.canvas.get_renderer()).padded(0.02 * axis.figure.dpi)
            label.set_visible(not any(box.overlaps(other) for other in kept))
            kept += [box] if label.get_visible() else []


def lay_out(figure: Figure, width: float, height: float | None, size: float) -> str:
    """Lays the figure out. The caption and the notes are removed from it.
    @param width, height  [cm]; @param size  size of letters [pt]
    @return the text of the caption and the notes
    @throws UserError"""
    if len(figure.axes) != 1:
        raise UserError(f"cannot lay out a picture of {len(figure.axes)} panels for a column; draw one panel")
    axes, = figure.axes
    texts = [axes.title, *(text for text in axes.texts if text.get_gid() == NOTES)]
    caption = "\n".join(text.get_text() for text in texts if text.get_text())
    axes.set_title("")
    for text in texts[1:]:
        text.remove()
    scales = [axis for one in (axes, *axes.child_axes) for axis in (one.xaxis, one.yaxis)]
    for axis in scales:
        axis.set_tick_params(which="both", labelsize=size)
    for text in figure.findobj(Text):
        text.set_fontsize(size)
    shape = 0.75 if axes.get_aspect() == "auto" else figure.get_figheight() / figure.get_figwidth()
    figure.set_size_inches(width / INCH, (height or shape * width) / INCH)
    above = draw_legend(axes, size) / figure.dpi if legend_entries(axes) else 0.0
    if height is None:
        figure.set_figheight(figure.get_figheight() + above)
    if above > 0.6 * figure.get_figheight() and height:
        raise UserError(f"cannot lay out a picture {height:g} cm high (its legend alone takes {INCH * above:.1f} cm); "
                        "make it higher, or draw fewer curves")
    figure.set_layout_engine("constrained", rect=(0, 0, 1, 1 - above / figure.get_figheight()))
    figure.draw_without_rendering()
    frame = axes.get_window_extent()
    for axis in scales:
        fits = fitting(figure, size, frame.width if axis.axis_name == "x" else frame.height)
        axis.label.set_text(in_lines(axis.label.get_text().replace("\n", " "), fits, " "))
    figure.draw_without_rendering()
    for axis in scales:
        hide_overlapping(axis)
    return caption
