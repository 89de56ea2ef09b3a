"""The style of all figures: colours, axes, markers, and text beside a picture. This module also shows and saves
pictures."""

from __future__ import annotations

import contextlib
import io
import logging
import math
import os
import pathlib
import warnings
from collections.abc import Callable, Collection, Iterator, Sequence
from typing import Any

import matplotlib
import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import PolyCollection
from matplotlib.container import ErrorbarContainer
from matplotlib.figure import Figure
from matplotlib.legend import Legend
from matplotlib.path import Path
from matplotlib.transforms import Bbox

from ..tools import outputs, rounded
from ..tools.hints import AnyPath, Group
from ..tools.texts import printable
from . import journal
from .journal import NOTES, fitting as fitting, in_lines as in_lines

if outputs.are_of_command:
    matplotlib.rcdefaults()

# The palette of Okabe and Ito, which is safe for colour-blind readers. Every curve has a different marker.
COLOURS = ["#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000"]
MARKERS = ["o", "s", "D", "v", "P", "X", "*"]
# No curve has these colours.
MECHANISM_COLOURS = {"wrapped": "#6A3D9A", "squeezed": "#8DB600", "hybrid": "#7F4F24", "other": "0.45"}
CAUSE_COLOURS = {**MECHANISM_COLOURS, "broken": COLOURS[4]}
PASSED_COLOUR = "0.62"
MECHANISM_MARKERS = {"wrapped": "o", "squeezed": "s", "hybrid": "D", "other": "X"}
MARKER_WORDS = {"wrapped": "circles", "squeezed": "squares", "hybrid": "diamonds", "other": "crosses"}
SCALE = matplotlib.colormaps["cividis"]  # This scale has none of the colours of mechanisms.
PASSAGES = matplotlib.colormaps["YlOrBr"]  # Small fractions are light, so that lines and markers remain visible.
OBSTACLE = "0.72"
NOTE_SIZE = 8
CURVE = "curve "  # The name (`gid`) of a curve's artists begins with this word. The curve's label follows.
DROPLET = "#D55E00"
# An arrow that rises from a foot. The foot is at the lower bound, in the middle of the marker's square, so the arrow
# fills the upper half of this square.
LOWER_BOUND = Path([(-0.25, 0), (0.25, 0), (0, 0), (0, 1), (-0.25, 0.6), (0, 1), (0.25, 0.6)], [1, 2, 1, 2, 1, 2, 2])


def new_figure(**options: Any) -> Figure:
    """Creates a figure without `pyplot`. Figures of `pyplot` stay in memory, and they belong to a backend, which a
    notebook has already chosen."""
    made = Figure(**options)
    FigureCanvasAgg(made)
    return made


def subplots(rows: int = 1, columns: int = 1, *, figsize: tuple[float, float], **options: Any) -> tuple[Figure, Any]:
    """A figure with an automatic layout, and its axes. The arguments are those of `pyplot.subplots`."""
    made = new_figure(figsize=figsize, layout="constrained")
    return made, made.subplots(rows, columns, **options)


def figure_of(draw: Callable[..., None], *what: Any) -> Figure:
    """A figure with one drawing. @param draw  is called with the axes and with `what`"""
    figure, axes = subplots(figsize=(6.4, 4.8))
    with without_warnings():
        draw(axes, *what)
    return figure


def curve_style(index: int) -> dict[str, Any]:
    """A different style for each curve. When all colours and markers are used, they are repeated with dashed lines.
    After that, lines have one dot between dashes, then two dots, and so on."""
    round_, which = divmod(index, len(COLOURS))
    line = (0, (6, 2) + (1, 2) * (round_ - 1)) if round_ > 0 else "-"
    return {"color": COLOURS[which], "marker": MARKERS[which], "linestyle": line}


def shades(number: int) -> Sequence[Any]:
    """The colours of curves in the order of a parameter. If there are few curves, neighbouring curves have different
    hues."""
    return COLOURS[:number] if number <= len(COLOURS) else SCALE(np.linspace(0, 0.95, number))


@contextlib.contextmanager
def curve(axes: Axes, label: str) -> Iterator[None]:
    """Gives the name of a curve to everything that is drawn in this block. Picture.curves() finds these artists by the
    name."""
    before = set(axes.get_children())
    yield
    for artist in axes.get_children():
        if artist not in before and artist.get_gid() is None:
            artist.set_gid(CURVE + label)


def mark(kind: str, groups: Collection[Group]) -> str | None:
    """The name (`gid`) of artists that represent groups of a report. The name is None outside reports, because only
    report.write() numbers groups.
    @param kind  point, curve or legend"""
    numbers = [str(group["number"]) for group in groups if "number" in group]
    return f"{kind}-{','.join(numbers)}" if numbers else None


def mark_legend(legend: Legend, handles: Sequence[Any]) -> None:
    """Marks legend entries: if an artist is marked with groups, its legend entry is marked with these groups, too."""
    for handle, text in zip(handles, legend.get_texts()):
        name = (handle.lines[0] if hasattr(handle, "lines") else handle).get_gid()
        if name:
            text.set_gid(f"legend-{name.partition('-')[2]}")


def doubts(group: Group) -> list[str]:
    return (group["doubts"] or "").split()


def main_mechanism(group: Group) -> str:
    """The most frequent mechanism of a group's clogs."""
    return max(MECHANISM_MARKERS, key=lambda name: group[name])


def mechanism_note(groups: Collection[Group], other: str = "other clogs") -> str:
    """Explains the markers that draw_lengths() gave these groups. @param other  the name for clogs of no mechanism"""
    names = {main_mechanism(group) for group in groups if group["clogs"] > 0}
    return "; ".join(f"{word}: {other if name == 'other' else 'most clogs ' + name}"
                     for name, word in MARKER_WORDS.items() if name in names)


def legend_off_curves(axes: Axes, entries: Sequence[tuple[Artist, str]], title: str) -> Legend:
    """Finds a place for the legend where nothing is drawn. If there is none, the ordinate is extended."""
    # matplotlib only avoids lines, so error bars and bands are represented by lines.
    rising: Any = np.geomspace if axes.get_yscale() == "log" else np.linspace
    bars = [bar for drawn in axes.containers if isinstance(drawn, ErrorbarContainer)
            for part in drawn.lines[2] for bar in part.get_segments() if len(bar)]
    points = [(x, y) for (x, low), (_, high) in bars if low < high for y in [*rising(low, high, 9), math.nan]]
    points += [point for band in axes.collections if isinstance(band, PolyCollection)
               for path in band.get_paths() for point in path.vertices]
    axes.plot(*np.reshape(points, (-1, 2)).T, linestyle="none", label="_bars")
    axes.figure.figure.draw_without_rendering()  # computes the layout
    paths = [line.get_transform().transform_path(line.get_path()) for line in axes.lines if len(line.get_xdata())]

    def put(place: str) -> tuple[Legend, Bbox]:
        made = axes.legend(*zip(*entries), title=title, edgecolor="none", framealpha=0.6, loc=place)
        return made, made.get_window_extent(axes.figure.canvas.get_renderer())

    made, box = put("best")
    if not any(path.intersects_bbox(box, filled=False) for path in paths):
        return made
    made, box = put("upper right")
    x, y = np.concatenate([path.interpolated(9).vertices for path in paths]).T
    highest = np.nanmax(y[(box.x0 < x) & (x < box.x1)], initial=box.y0) + 9
    scale = axes.yaxis.get_transform()
    low, high = scale.transform(axes.get_ylim())
    axes.set_ylim(top=scale.inverted().transform([low + (high - low) * (highest - axes.bbox.y0) / (box.y0 - axes.bbox.y0)])[0])
    return made


def width_of(legend: Legend) -> float:
    """The width in inches."""
    return legend.get_window_extent().width / legend.figure.dpi


def legend(axes: Axes, title: str = "") -> None:
    """Draws a legend of named curves. A long legend is placed beside the axes. The figure is widened for it, but only
    once."""
    entries = journal.legend_entries(axes)
    if len(entries) > len(COLOURS):
        before = axes.get_legend()
        width_before = width_of(before) if before and len(before.get_texts()) > len(COLOURS) else 0.0
        made = axes.legend(*zip(*entries), title=title, frameon=False, fontsize=7, handlelength=4,
                           ncols=math.ceil(len(entries) / 28), loc="upper left", bbox_to_anchor=(1, 1))
        figure = axes.figure
        if isinstance(figure, Figure):  # The width of a part of a figure is fixed.
            figure.set_figwidth(figure.get_figwidth() + width_of(made) - width_before)
    elif entries:
        made = legend_off_curves(axes, entries, title)
    if entries:
        mark_legend(made, [handle for handle, _ in entries])


def logarithmic_margin(values: Collection[float]) -> float:
    """Factor by which a logarithmic axis extends beyond these values."""
    return (max(values) / min(values)) ** 0.05 if max(values) > min(values) else 1.3


def side_by_side(index: int, num_curves: int, values: Collection[float]) -> float:
    """The factor by which the points of a curve are shifted on logarithmic abscissae, so that the bars of different
    curves can be distinguished. The shift is a fraction of the axis. It is smaller if neighbouring values or the frame
    are near."""
    ordered = sorted(set(values))
    outermost = max(num_curves - 1, 1) / 2
    nearest = min((b / a for a, b in zip(ordered, ordered[1:])), default=2.0)
    step = min(0.007 * math.log(max(ordered[-1] / ordered[0], 6)), 0.2 * math.log(nearest) / outermost,
               0.7 * math.log(logarithmic_margin(values)) / outermost)
    return math.exp(step * (index - (num_curves - 1) / 2))


def far_apart(values: Collection[float], span: float) -> list[float]:
    """Chooses the values whose labels have room side by side on a logarithmic axis, round numbers first. @param span
    last value of the axis divided by the first"""
    def roundness(value: float) -> tuple[bool, int]:
        digits = f"{value:.2e}".partition("e")[0].replace(".", "").rstrip("0")
        return digits not in ("1", "2", "5"), len(digits)

    kept: list[float] = []
    for value in sorted(set(values), key=lambda value: (roundness(value), value)):
        if all(abs(math.log(value / other)) >= 0.08 * math.log(span) for other in kept):
            kept.append(value)
    return sorted(kept)


def logarithmic_abscissa(axes: Axes, values: Collection[float] = ()) -> None:
    """Labels a logarithmic abscissa with plain numbers. If the values are few or within a decade, the values themselves
    are the ticks. Values for which there is no room have no label."""
    axes.set_xscale("log")
    axis = axes.xaxis
    axis.set_major_formatter(matplotlib.ticker.FuncFormatter(lambda value, _: f"{value:.3g}"))
    if values and (len(set(values)) <= 10 or max(values) < 10 * min(values)):
        span = max(values) / min(values)
        # Beside a single value, round numbers show the scale.
        locator = matplotlib.ticker.MaxNLocator(4, steps=[1, 2, 5, 10])
        around = [] if span > 1 else locator.tick_values(0.8 * min(values), 1.25 * min(values))
        shown = span if span > 1 else logarithmic_margin(values)**2
        axis.set_ticks(labelled := far_apart({*values, *around}, shown), minor=False)
        axis.set_ticks(sorted(set(values) - set(labelled)), minor=True)
        axis.set_minor_formatter(matplotlib.ticker.NullFormatter())
    else:
        low, high = (min(values), max(values)) if values else axes.get_xlim()
        plain_logarithmic(axis, high / low)
    if values:
        # Ticks would determine the range of the axis and leave no margin, so that artists at the last tick would be on
        # the frame.
        margin = logarithmic_margin(values)
        axes.set_xlim(min(values) / margin, max(values) * margin)


def logarithmic_ordinate(axes: Axes) -> None:
    """Labels a logarithmic ordinate with plain numbers if it has fewer than two decades, because there are too few
    powers of ten for labels. Labels are at 1, 2 and 5, or at every tick if the ordinate has less than a factor of
    five."""
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


def plain_logarithmic(axis: Axis, span: float = 1.0) -> None:
    """Puts plain numbers at 1, 2 and 5 of each decade, or only at the beginning of each decade if there are many
    decades. @param span  last number divided by the first"""
    axis.set_major_locator(matplotlib.ticker.LogLocator(subs=(1.0, 2.0, 5.0) if span < 2000 else (1.0,)))
    axis.set_major_formatter(matplotlib.ticker.FuncFormatter(lambda value, _: f"{value:g}"))
    axis.set_minor_formatter(matplotlib.ticker.NullFormatter())


def grid(axes: Axes) -> None:
    axes.grid(True, which="major", color="0.9", linewidth=0.6)
    axes.set_axisbelow(True)


def label(axes: Axes, along: str, up: str) -> None:
    """Names both axes, and draws a grid."""
    axes.set_xlabel(along)
    axes.set_ylabel(up)
    grid(axes)


def caption(axes: Axes, text: str) -> None:
    """Writes a caption above the axes. Lines that are wider than the axes are broken."""
    widest = 1.1 * axes.get_window_extent().width  # The layout will make the axes wider than they are now.
    axes.set_title(in_lines(text, fitting(axes.figure, 8, widest)), fontsize=8, color="0.25")


def finish(axes: Axes, up: str, shared: str, lines: Sequence[str]) -> None:
    """Adds the ordinate's label, grid, legend, caption and notes to a picture of curves."""
    axes.set_ylabel(up)
    grid(axes)
    caption(axes, shared)
    if lines:
        notes(axes, lines)
    legend(axes)


def notes(axes: Axes, lines: Sequence[str]) -> None:
    """Writes notes that explain the marks below the label of the abscissa."""
    axes.annotate("\n".join(lines), (0.5, 0), xycoords=axes.xaxis.label, xytext=(0, -4), textcoords="offset points",
                  ha="center", va="top", fontsize=NOTE_SIZE, color="0.25", gid=NOTES)


def notes_of_panels(figure: Figure, lines: Sequence[str]) -> None:
    """Writes notes that explain the marks below all panels. Lines that are wider than the figure are broken."""
    fits = fitting(figure, NOTE_SIZE, 0.97 * figure.bbox.width)
    figure.supxlabel("\n".join(in_lines(line, fits, " ") for line in lines), fontsize=NOTE_SIZE,
                     color="0.25", gid=NOTES)


def save(figure: Figure, output: AnyPath, metadata: dict[str, str] | None = None, dpi: float = 160) -> None:
    """Writes OUTPUT.png and OUTPUT.pdf. @param output  path without ending; @param dpi  resolution of the .png [dots
    per inch]"""
    # with_suffix() is not used, because it would cut a name that contains a dot.
    metadata = {key: printable(value, "\n") for key, value in (metadata or {}).items()}
    with outputs.replaced(f"{output}.png") as fresh:
        figure.savefig(fresh, dpi=dpi, metadata=metadata)
    # Keeps the layout of the .png.
    figure.set_layout_engine("none")
    subject = {"Title": metadata.get("Title"), "Subject": metadata.get("Description")}
    # Journals refuse fonts of type 3, which are matplotlib's default.
    with outputs.replaced(f"{output}.pdf") as fresh, matplotlib.rc_context({"pdf.fonttype": 42}):
        figure.savefig(fresh, metadata={key: value for key, value in subject.items() if value})


@contextlib.contextmanager
def without_warnings() -> Iterator[None]:
    """Hides matplotlib's warnings about the layout of our figures, because users cannot act on them."""
    logger = logging.getLogger("matplotlib")
    level = logger.level
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        logger.setLevel(logging.ERROR)
        try:
            yield
        finally:
            logger.setLevel(level)


class Picture:
    """A picture. In a notebook the object shows itself. `figure` belongs to matplotlib and may be changed. `source`
    states the origin of the numbers. The origin is saved as Description of the .png and as Subject of the .pdf.
    `caption` is the text that for_journal() removes from the picture."""

    def __init__(self, figure: Figure, source: str = "") -> None:
        self.figure = figure
        self.source = source
        self.caption = ""
        self._dpi = 160.0

    @property
    def curves(self) -> dict[str, list[Artist]]:
        """The artists of each curve (lines, bars, markers, band), by the curve's label in the legend. The label of a
        single curve is empty."""
        found: dict[str, list[Artist]] = {}
        for artist in self.figure.findobj(lambda artist: (artist.get_gid() or "").startswith(CURVE)):
            found.setdefault(artist.get_gid().removeprefix(CURVE), []).append(artist)
        return found

    def for_journal(self, width_cm: float = 8.6, height_cm: float | None = None, *, font_size: float = 8) -> Picture:
        """Lays the picture out for a column of a journal. All text has the same size, the legend is above the axes, and
        labels do not overlap. Conditions and notes are moved from the picture to `caption`. Make all other changes of
        the figure before this call.

        @param width_cm  of the picture
        @param height_cm  height of the picture; by default it suits the legend
        @param font_size  of all text [pt]
        @return  the same picture
        @throws UserError  if it has several panels
        """
        with without_warnings():
            self.caption = journal.lay_out(self.figure, width_cm, height_cm, font_size) or self.caption
        self._dpi = 600.0
        return self

    def png(self, dpi: float = 110) -> bytes:
        out = io.BytesIO()
        with without_warnings():
            self.figure.savefig(out, format="png", dpi=dpi)
        return out.getvalue()

    def save(self, output: str | os.PathLike[str]) -> pathlib.Path:
        """Writes OUTPUT.png and OUTPUT.pdf. @return the path of the .png. @throws UserError  if a file of another kind
        has one of these names"""
        path = pathlib.Path(output)
        if path.suffix in (".png", ".pdf"):
            path = path.with_suffix("")
        outputs.refuse_unwritable_picture(path)
        with without_warnings():
            save(self.figure, path, {"Description": self.source, "Software": "clogsweep"} if self.source else None, self._dpi)
        return pathlib.Path(f"{path}.png")

    def __repr__(self) -> str:
        return f"<picture of {' x '.join(f'{side:g}' for side in self.figure.get_size_inches())} inches>"

    def _repr_png_(self) -> bytes:
        return self.png()
