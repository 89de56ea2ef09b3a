"""Draws a poster of a sweep: one page with its curves, some of its droplets, and the origin of its numbers."""

from __future__ import annotations

import pathlib
import tempfile
from collections.abc import Callable, Sequence
from functools import partial
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from .. import style
from ..drawing import clogs, curve, lengths, passages, way
from ..labels.groups import Groups
from ..reading import fits, replays, stored
from ..reading.trajectory import Trajectory
from ..tools import rounded
from ..tools.hints import Group, Numbers
from ..tools.texts import literal
from . import report

if TYPE_CHECKING:
    import pandas

PAGE = (11.69, 16.54)  # A3 [inches]. On A2 the letters are 1.4 times as large.
MARGIN = 0.5
MOST_CURVES = 2  # P(r) and the causes are drawn only for the first and the last curve.
# The poster shows the path of a droplet that clogged near this distance [sigma]. Such a path shows how droplets move,
# and the droplet can still be drawn large.
WAY = 8.0
FRAMES_OF_WAY = 300

Draw = Callable[[Axes], None]
# The height of a row relative to the other rows, and its drawings from left to right.
Row = tuple[float, Sequence[Draw]]


def page(title: str, about: str, rows: Sequence[Row], footer: str) -> Figure:
    """Draws the page. @param about, footer  text of one or more lines"""
    figure = style.new_figure(figsize=PAGE, layout="constrained")
    _, body, _ = figure.subfigures(1, 3, width_ratios=[MARGIN, PAGE[0] - 2 * MARGIN, MARGIN])
    heights = [0.7, *(height for height, _ in rows), 0.25]
    head, *parts, foot = body.subfigures(len(heights), 1, height_ratios=heights)
    head.text(0.5, 0.72, title, ha="center", va="center", fontsize=26, weight="bold")
    about = style.in_lines(about, style.fitting(figure, 11, figure.bbox.width - 2 * MARGIN * figure.dpi))
    head.text(0.5, 0.42, about, ha="center", va="top", fontsize=11, color="0.25", linespacing=1.5)
    for part, (_, drawings) in zip(parts, rows):
        for axes, draw in zip(part.subplots(1, len(drawings), squeeze=False)[0], drawings):
            draw(axes)
    foot.text(0.5, 0.5, footer, ha="center", va="center", fontsize=7, color="0.35", linespacing=1.4)
    return figure


def cut(text: str) -> str:
    """Shortens lines that are wider than the page."""
    return "\n".join(line if len(line) < 150 else f"{line[:147]}..." for line in text.splitlines())


def counted(rows: pandas.DataFrame, words: dict[str, str]) -> str:
    """The number of runs with each status, in words. @param rows  the sweep's table; @param words  better words for
    some statuses"""
    counts = ", ".join(f"{count} {words.get(status, status)}" for status, count in rows.status.value_counts().items())
    return f"{rounded.count_text(len(rows), 'run')}: {counts}"


def shown_curves(groups: Groups) -> list[tuple[str, list[Group]]]:
    curves = groups.curves()
    return curves if len(curves) <= MOST_CURVES else [curves[0], curves[-1]]


def run_way(row: np.void, sweep: pathlib.Path, clogrun: pathlib.Path) -> Trajectory:
    with tempfile.TemporaryDirectory(prefix="clogsweep-poster-") as folder:
        interval = max(row["time"] / FRAMES_OF_WAY, 1e-3)
        run, = replays.follow_all(clogrun, sweep, [row], folder, 1, interval, interval)
    return run


def draw_clog(axes: Axes, clog: clogs.Clog, view: Numbers) -> None:
    axes.axis("off")
    clogs.draw(axes, clog, view)


def draw_way(axes: Axes, run: Trajectory) -> None:
    """Draws the droplet's path over the whole width of the page."""
    way.draw_on(axes, run, 12)
    axes.set_aspect("equal", adjustable="datalim")


def of_lengths(groups: Groups, sweep: pathlib.Path, clogrun: pathlib.Path) -> list[Row]:
    first: list[Draw] = [partial(curve.draw_on, groups=groups)]
    if lengths.have_speeds(groups.members):
        first.append(partial(lengths.draw_speeds_on, groups=groups))
    curves = shown_curves(groups)
    survivals = [partial(report.draw_survival, groups=groups, label=label, members=members)
                 for label, members in curves if any(group["survival"] for group in members)]
    ends = [partial(report.draw_causes, groups=groups, label=label, members=counted)
            for label, members in curves if (counted := report.with_runs(members))]
    # If there is a single curve, P(r) and the causes are side by side.
    below: list[Row] = [(1.35, survivals + ends)] if len(curves) == 1 else [(1.35, survivals), (1.0, ends)]
    rows: list[Row] = [(1.6, first), *((height, drawings) for height, drawings in below if drawings)]
    clogged = clogs.of_polygons(stored.read_rows(sweep, clogrun.parent), sweep)
    if clogged:
        again = clogs.run_all(clogrun, sweep, report.examples(clogged, 4), 2)
        rows.append((1.25, [partial(draw_clog, clog=clog, view=clogs.view_of(again)) for clog in again]))
        run = run_way(min(clogged, key=lambda row: abs(float(row["distance"]) - WAY)), sweep, clogrun)
        rows.append((1.0, [partial(draw_way, run=run)]))
    return rows


def of_passages(groups: Groups, sweep: pathlib.Path, clogrun: pathlib.Path) -> list[Row]:
    def draw_outline(axes: Axes, run: Trajectory) -> None:
        passages.draw_outline(axes, groups, run)
        axes.xaxis.label.set_size(8)  # Three drawings are side by side, so the letters are small.

    rows: list[Row] = [(1.2, [partial(passages.draw_curves, groups=groups, column=column)])
                       for column in passages.drawn_columns(groups)]
    with tempfile.TemporaryDirectory(prefix="clogsweep-poster-") as folder:
        runs = passages.followed(passages.examples(stored.read_rows(sweep, clogrun.parent), 3), clogrun, sweep, folder)
    return [*rows, (1.2, [partial(draw_outline, run=run) for run in runs])] if runs else rows


def of_laboratory(groups: Groups) -> str:
    """A line that states sigma in mm, and v_t in mm/s if it is known; empty if the sweep has no laboratory."""
    lab = groups.laboratory
    if not lab:
        return ""
    speed = f", $v_t$ = {rounded.plain(lab['speed_mm_per_s'])} mm/s" if lab["speed_mm_per_s"] else ""
    return rf"in the laboratory $\sigma$ = {rounded.plain(lab['length_mm'])} mm{speed}" + "\n"


def draw(sweep: pathlib.Path, folder: pathlib.Path, *options: object) -> Figure:
    """Draws the poster. @param folder  of the programs; @param options  for clogfit. @throws UserError,
    ProgramFailed"""
    groups = Groups(*fits.fitted(folder / "clogfit", sweep, *options)).finished(sweep).fit_curves(sweep, folder)
    with stored.opened(sweep, folder=folder) as file:
        about = stored.attributes(file)
    abscissa = groups.abscissa_key().replace("_", " ")
    if groups.are_passages:
        kind = passages.kind_of(groups)
        title, words = f"{kind.heading} vs {abscissa}", kind.outcomes
        rows = of_passages(groups, sweep, folder / "clogrun")
    else:
        title, words = f"{curve.heading(groups).capitalize().removesuffix(' per distance')} vs {abscissa}", {"flowing": "still going"}
        rows = of_lengths(groups.with_lengths(sweep), sweep, folder / "clogrun")
    head = f"{groups.caption()}\n{of_laboratory(groups)}{counted(stored.read_table(sweep, folder), words)}"
    groups.tells_what_all_share = False  # The head of the poster describes these parameters.
    return page(title, head, rows, literal(cut(stored.source(about))))
