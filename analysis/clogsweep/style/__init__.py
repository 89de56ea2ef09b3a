"""Style of all figures: colours, axes, markers, text beside a picture; and how one is shown and saved."""

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
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.legend import Legend

from ..tools import outputs, rounded
from ..tools.hints import AnyPath, Group
from ..tools.texts import printable
from . import journal
from .journal import NOTES, in_lines as in_lines

# Okabe and Ito's palette, safe for colour-blind readers, with a different marker for every curve.
COLOURS = ["#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000"]
MARKERS = ["o", "s", "D", "v", "P", "X", "*"]
MECHANISM_COLOURS = {"wrapped": COLOURS[0], "squeezed": COLOURS[1], "hybrid": COLOURS[2], "other": COLOURS[3]}
CAUSE_COLOURS = {**MECHANISM_COLOURS, "broken": COLOURS[4]}
PASSED_COLOUR = "0.62"
MECHANISM_MARKERS = {"wrapped": "o", "squeezed": "s", "hybrid": "D", "other": "X"}
VIRIDIS = matplotlib.colormaps["viridis"]
PASSAGES = matplotlib.colormaps["YlOrBr"]  # light for small fractions; lines and markers stay visible on it
OBSTACLE = "0.72"
NOTE_SIZE = 8
CURVE = "curve "  # the beginning of the name (`gid`) of a curve's artists; its label follows
DROPLET = "#D55E00"


def new_figure(**options: Any) -> Figure:
    """Creates a figure without `pyplot`, whose figures stay in memory and belong to a backend: a notebook has already chosen one."""
    made = Figure(**options)
    FigureCanvasAgg(made)
    return made


def subplots(rows: int = 1, columns: int = 1, *, figsize: tuple[float, float], **options: Any) -> tuple[Figure, Any]:
    """A figure with an automatic layout, and its axes, as `pyplot`'s."""
    made = new_figure(figsize=figsize, layout="constrained")
    return made, made.subplots(rows, columns, **options)


def figure_of(draw: Callable[..., None], *what: Any) -> Figure:
    """A figure with one drawing. @param draw  called with the axes and what follows here"""
    figure, axes = subplots(figsize=(6.4, 4.8))
    with without_warnings():
        draw(axes, *what)
    return figure


def curve_style(index: int) -> dict[str, Any]:
    """A different style for each curve: after all colours and markers, lines become dashed, with one more dot each
    round."""
    round_, which = divmod(index, len(COLOURS))
    line = (0, (6, 2) + (1, 2) * (round_ - 1)) if round_ > 0 else "-"
    return {"color": COLOURS[which], "marker": MARKERS[which], "linestyle": line}


@contextlib.contextmanager
def curve(axes: Axes, label: str) -> Iterator[None]:
    """Names what the block draws, for Picture.curves."""
    before = set(axes.get_children())
    yield
    for artist in axes.get_children():
        if artist not in before and artist.get_gid() is None:
            artist.set_gid(CURVE + label)


def mark(kind: str, groups: Collection[Group]) -> str | None:
    """The name (`gid`) of artists that represent groups of a report (report.write()); elsewhere they have no numbers.
    @param kind  point, curve or legend"""
    numbers = [str(group["number"]) for group in groups if "number" in group]
    return f"{kind}-{','.join(numbers)}" if numbers else None


def mark_legend(legend: Legend, handles: Sequence[Any]) -> None:
    """Gives the legend entry of each marked artist the name of the same groups."""
    for handle, text in zip(handles, legend.get_texts()):
        name = (handle.lines[0] if hasattr(handle, "lines") else handle).get_gid()
        if name:
            text.set_gid(f"legend-{name.partition('-')[2]}")


def doubts(group: Group) -> list[str]:
    return (group["doubts"] or "").split()


def main_mechanism(group: Group) -> str:
    """The mechanism that holds most of a group's clogs."""
    return max(MECHANISM_MARKERS, key=lambda name: group[name])


def legend(axes: Axes, groups: Collection[Group] = (), other: str = "other clogs") -> None:
    """Legend of named curves and of the markers that draw_lengths() gave these groups. A long legend is placed beside
    the axes, and the figure gets wider. @param other  name of clogs without a mechanism"""
    names = {main_mechanism(group) for group in groups if group["clogs"] > 0}
    for name, marker in MECHANISM_MARKERS.items():
        if name in names:
            axes.plot([], [], color="0.4", marker=marker, linestyle="none", label=f"most clogs {name}" if name != "other" else other)
    entries = journal.legend_entries(axes)
    if len(entries) > len(COLOURS):
        made = axes.legend(*zip(*entries), frameon=False, fontsize=7, handlelength=4, ncols=math.ceil(len(entries) / 28),
                           loc="upper left", bbox_to_anchor=(1, 1))
        figure = axes.figure
        if isinstance(figure, Figure):  # not for a part of one, whose width is fixed
            figure.set_figwidth(figure.get_figwidth() + made.get_window_extent(figure.canvas.get_renderer()).width / figure.dpi)
    elif entries:
        made = axes.legend(*zip(*entries), frameon=False)
    if entries:
        mark_legend(made, [handle for handle, _ in entries])


def logarithmic_margin(values: Collection[float]) -> float:
    """Factor by which a logarithmic axis extends beyond these values."""
    return (max(values) / min(values)) ** 0.05 if max(values) > min(values) else 1.3


def side_by_side(index: int, num_curves: int, values: Collection[float]) -> float:
    """Factor on logarithmic abscissae that curves share: a shift of a percent separates their bars; it is smaller if a
    curve would reach the frame."""
    outermost = max(num_curves - 1, 1) / 2
    return min(1.012, logarithmic_margin(values) ** (0.7 / outermost)) ** (index - (num_curves - 1) / 2)


def far_apart(values: Collection[float]) -> list[float]:
    """The values whose labels fit side by side on a logarithmic axis."""
    ordered = sorted(set(values))
    room = 0.08 * math.log(ordered[-1] / ordered[0])
    kept = ordered[:1]
    for value in ordered[1:]:
        if math.log(value / kept[-1]) >= room:
            kept.append(value)
    return kept


def logarithmic_abscissa(axes: Axes, values: Collection[float] = ()) -> None:
    """Plain numbers; at the values themselves if these are few or within a decade."""
    axes.set_xscale("log")
    axis = axes.xaxis
    axis.set_major_formatter(matplotlib.ticker.FuncFormatter(lambda value, _: f"{value:.3g}"))
    if values and (len(set(values)) <= 10 or max(values) < 10 * min(values)):
        axis.set_ticks(far_apart(values), minor=False)
        axis.set_ticks(values, minor=True)
        axis.set_minor_formatter(matplotlib.ticker.NullFormatter())
    if values:
        # Ticks would widen an axis without a margin: artists at the last one would be on the frame.
        margin = logarithmic_margin(values)
        axes.set_xlim(min(values) / margin, max(values) * margin)


def logarithmic_ordinate(axes: Axes) -> None:
    """Plain numbers if it has fewer than two decades: at 1, 2 and 5, or at every mark of less than half a decade,
    because powers of ten would be too few."""
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
    """Numbers at 1, 2 and 5 of each decade, or only at its beginning. @param span  last number divided by the first, if
    it may be large"""
    axis.set_major_locator(matplotlib.ticker.LogLocator(subs=(1.0, 2.0, 5.0) if span < 1000 else (1.0,)))
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
    """Above the axes; lines that are wider than these go on below."""
    widest = 1.1 * axes.get_window_extent().width  # the layout makes axes wider than they are now
    axes.set_title(in_lines(text, journal.fitting(axes, 8, widest)), fontsize=8, color="0.25")


def finish(axes: Axes, up: str, shared: str, lines: Sequence[str], groups: Collection[Group] = (), other: str = "other clogs") -> None:
    """The ordinate's label, grid, legend, caption and notes of a picture of curves. @param groups, other  see legend()"""
    axes.set_ylabel(up)
    grid(axes)
    legend(axes, groups, other)
    caption(axes, shared)
    if lines:
        notes(axes, lines)


def notes(axes: Axes, lines: Sequence[str]) -> None:
    """Writes the meaning of the marks below the axes and their label."""
    axes.annotate("\n".join(lines), (0.5, 0), xycoords=axes.xaxis.label, xytext=(0, -4), textcoords="offset points", ha="center", va="top",
                  fontsize=NOTE_SIZE, color="0.25", gid=NOTES)


def notes_of_panels(figure: Figure, lines: Sequence[str]) -> None:
    """What marks mean, once below all panels."""
    figure.supxlabel("\n".join(lines), fontsize=NOTE_SIZE, color="0.25", gid=NOTES)


def save(figure: Figure, output: AnyPath, metadata: dict[str, str] | None = None, dpi: float = 160) -> None:
    """Writes OUTPUT.png and OUTPUT.pdf. @param output  path without ending; @param dpi  of the .png"""
    # Not with_suffix(): a name may hold a dot.
    metadata = {key: printable(value, "\n") for key, value in (metadata or {}).items()}
    with outputs.replaced(f"{output}.png") as fresh:
        figure.savefig(fresh, dpi=dpi, metadata=metadata)
    # Laid out once.
    figure.set_layout_engine("none")
    subject = {"Title": metadata.get("Title"), "Subject": metadata.get("Description")}
    # Journals refuse fonts of type 3, matplotlib's default.
    with outputs.replaced(f"{output}.pdf") as fresh, matplotlib.rc_context({"pdf.fonttype": 42}):
        figure.savefig(fresh, metadata={key: value for key, value in subject.items() if value})


@contextlib.contextmanager
def without_warnings() -> Iterator[None]:
    """Users cannot fix what matplotlib warns of while it lays out our figures."""
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
    """Shows itself in a notebook; `figure` is matplotlib's and may be changed. `source` is the origin of its numbers,
    saved as Description of the .png and Subject of the .pdf. `caption` is the text that for_journal() removes from the
    picture."""

    def __init__(self, figure: Figure, source: str = "") -> None:
        self.figure = figure
        self.source = source
        self.caption = ""
        self._dpi = 160.0

    @property
    def curves(self) -> dict[str, list[Artist]]:
        """The artists of each curve (lines, bars, markers, band), by its label in the legend; that of a single curve is
        empty."""
        found: dict[str, list[Artist]] = {}
        for artist in self.figure.findobj(lambda artist: (artist.get_gid() or "").startswith(CURVE)):
            found.setdefault(artist.get_gid().removeprefix(CURVE), []).append(artist)
        return found

    def for_journal(self, width_cm: float = 8.6, height_cm: float | None = None, *, font_size: float = 8) -> Picture:
        """Lays the picture out for a column of a journal: text of one size, the legend above the axes, no labels that
        overlap. Call this last, after changes of the figure. Conditions and notes leave the picture for `caption`.

        @param width_cm  of the picture
        @param height_cm  likewise; without it the height suits the legend
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
        """Writes OUTPUT.png and OUTPUT.pdf. @return the first. @throws UserError  if something else exists there"""
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
