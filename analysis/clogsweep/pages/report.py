"""Writes one page about a sweep, with its curves, its table, examples of clogs or outlines, doubts, and the origin of
its numbers."""

from __future__ import annotations

import html
import json
import pathlib
import string
import tempfile
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from .. import style
from ..drawing import activity, clogs, curve, device, families, lengths, passages, survival_curve
from ..labels import LABORATORY
from ..labels.groups import Groups
from ..reading import fits, programs, stored
from ..tools import outputs, rounded
from ..tools.errors import UserError
from ..tools.hints import Group
from ..tools.texts import printable
from .chart import Charts

if TYPE_CHECKING:
    import pandas


def framed(content: str, caption: str, kind: str = "") -> str:
    return f'<figure{f" class={kind}" if kind else ""}>{content}<figcaption>{html.escape(caption)}</figcaption></figure>'


def draw_survival(axes: Axes, groups: Groups, label: str, members: Sequence[Group]) -> None:
    """Draws P(r) of the members of one curve, each up to its longest distance. If the clogging length of a member is
    known, the exponential law of this length is drawn, too."""
    begin = min(0.01 * (group["clogging_length"] or survival_curve.longest_way(group)) for group in members)
    for group, colour in zip(members, style.shades(len(members))):
        if group["survival"]:
            r = group["clogging_length"] * np.logspace(-2, 1, 100)
            axes.plot(r, np.exp(-r / group["clogging_length"]), color=colour, linewidth=0.8, linestyle="--",
                      gid=style.mark("curve", [group]))
        survival_curve.draw(axes, group, colour, groups.parameter_label(groups.abscissa, group[groups.abscissa]),
                            begin=begin)
    axes.set_xscale("log")
    axes.set_ylim(0, 1.02)
    style.label(axes, r"displacement along gravity $r/\sigma$", "$P(r)$, not yet clogged")
    mark_steps(axes)
    style.caption(axes, label or groups.caption())
    style.notes(axes, ["steps: clogs; ticks: censored runs; dashed: exponential of the same length"])


def mark_steps(axes: Axes) -> None:
    """Draws one legend for several curves, each of which belongs to one group."""
    handles, _ = axes.get_legend_handles_labels()
    style.mark_legend(axes.legend(frameon=False, fontsize=8, ncols=1 + len(handles) // 8), handles)


def occurring_causes(members: Sequence[Group]) -> list[str]:
    """The causes that ended runs of these groups, with the names of clogfit and in the order of their colours."""
    return [name for name in style.CAUSE_COLOURS if any(name in group["incidence"] for group in members)]


def incidence(groups: Groups, label: str, members: Sequence[Group]) -> Figure:
    """Draws, for the members of one curve, the probability that a run ends by each cause within a distance r. The
    causes compete with each other (estimator of Aalen and Johansen)."""
    names = occurring_causes(members)
    figure, all_axes = style.subplots(1, len(names), figsize=(3.2 * len(names), 4.8), sharex=True, sharey=True,
                                      squeeze=False)
    longest = max(survival_curve.longest_way(group) for group in members)
    begin = 0.5 * min((step["distance"] for group in members for steps in group["incidence"].values()
                       for step in steps if step["distance"] > 0), default=longest)
    for axes, name in zip(all_axes[0], names):
        for group, colour in zip(members, style.shades(len(members))):
            steps = group["incidence"].get(name, [])
            way = [begin, *(step["distance"] for step in steps), survival_curve.longest_way(group)]
            share = [0, *(step["probability"] for step in steps)]
            axes.step(way, [*share, share[-1]], where="post", color=colour, linewidth=1.2,
                      label=groups.parameter_label(groups.abscissa, group[groups.abscissa]),
                      gid=style.mark("point", [group]))
        axes.set_title(name, fontsize=10)
        axes.set_xlim(begin, longest)
        style.logarithmic_abscissa(axes)
        axes.set_ylim(0, 1.02)
        axes.set_xlabel(r"$r/\sigma$")
        style.grid(axes)
    all_axes[0][0].set_ylabel("probability of having ended this way within $r$")
    mark_steps(all_axes[0][0])
    title = style.in_lines(label or groups.caption(), lambda line: len(line) <= 16 * figure.get_figwidth())
    figure.suptitle(title, fontsize=8)
    return figure


def with_runs(members: Sequence[Group]) -> list[Group]:
    """The groups in which at least one droplet met an obstacle."""
    return [group for group in members if group["runs"]]


def draw_causes(axes: Axes, groups: Groups, label: str, members: Sequence[Group]) -> None:
    """Draws, for each group of a curve, which fraction of its runs each cause ended. @param members  see
    with_runs()"""
    ranks, base = np.arange(len(members)), np.zeros(len(members))
    shares = {name if name == "broken" else f"clogged, {name}": (colour, [(group[name] or 0) / group["runs"] for group in members])
              for name, colour in style.CAUSE_COLOURS.items()}
    passed = [(group["passed"] or 0) / group["runs"] for group in members]
    ended = [(group["clogs"] + (group["broken"] or 0)) / group["runs"] for group in members]
    shares["passed"] = (style.PASSED_COLOUR, passed)
    shares["still going"] = ("0.88", [1 - one - other for one, other in zip(ended, passed)])
    for name, (colour, share) in shares.items():
        if any(share):
            for bar, group in zip(axes.bar(ranks, share, bottom=base, color=colour, width=0.8, label=name), members):
                bar.set_gid(style.mark("point", [group]))
        base += share
    tension = groups.abscissa == "line_tension" and "tension_mN_per_m" in members[0]
    below = [f"\n{rounded.plain(group['tension_mN_per_m'])}" if tension else "" for group in members]
    axes.set_xticks(ranks, [f"{group[groups.abscissa]:g}{more}" for group, more in zip(members, below)],
                    rotation=0 if len(members) <= 10 else 90)
    axes.set_xlabel(groups.axis_label() + (f"\n{LABORATORY['line_tension']}" if tension else ""))
    axes.set_ylabel("share of the runs")
    axes.legend(frameon=False, loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=5, fontsize=8, title=label,
                title_fontsize=8)


def length(group: Group) -> str:
    """The clogging length with its interval, or its lower bound."""
    ends = [group[f"clogging_length_{end}"] for end in ("lower", "upper")]
    if group["clogs"] == 0:
        return f"> {rounded.plain(ends[0])}"
    return rounded.with_interval(group["clogging_length"], *ends)


def speed(group: Group) -> str:
    """The total distance of all runs divided by their total time. If only some runs went far enough to have a speed of
    their own, the mean of these speeds follows."""
    runs = rounded.count_text(group["relative_speed_runs"], "run")
    mean = None if group["relative_speed"] is None else rounded.with_error(group["relative_speed"], group["relative_speed_error"])
    if group.get(lengths.OF_ALL_RUNS) is None:
        return f"{mean} ({runs})" if mean else "-"
    of_all = rounded.with_error(group[lengths.OF_ALL_RUNS], group[f"{lengths.OF_ALL_RUNS}_error"])
    return f"{of_all} (mean of {group['relative_speed_runs']} of {rounded.count_text(group['runs'], 'run')}: {mean or '-'})" \
        if group["relative_speed_runs"] < group["runs"] else f"{of_all} ({runs})"


def laboratory_columns(groups: Groups) -> dict[str, str]:
    """The headings of those columns of the table that are in laboratory units."""
    named = {"tension_mN_per_m": "tension [mN/m]", "clogging_length_mm": "&lambda; [mm]",
             "speed_mm_per_s": "v<sub>g</sub> [mm/s]", "time_to_clog_s": "time to clog [s]"}
    if not any("laboratory_scale" in group for group in groups.members):
        return {}
    return {column: title for column, title in named.items() if column != "tension_mN_per_m" or groups.are_polygons}


def in_laboratory(group: Group, name: str) -> str:
    """A number in laboratory units, or the lower bound of a length."""
    bound = group["clogging_length_lower_mm"] if name == "clogging_length_mm" and group["clogs"] == 0 else None
    return rounded.plain(group[name]) if bound is None else f"> {rounded.plain(bound)}"


def migration(group: Group, name: str) -> str:
    """The lateral displacement divided by the distance, or divided by the lateral displacement along the rows."""
    return "-" if group.get(name) is None else rounded.with_error(group[name], group[f"{name}_error"])


def value(cell: float | str | None, digits: int = 6) -> str:
    """A value as the table shows it."""
    return "-" if cell is None else printable(cell) if isinstance(cell, str) else f"{cell:.{digits}g}"


def cell(groups: Groups, group: Group, name: str) -> str:
    """The value of a parameter in a group as the table shows it. User-supplied circles are shown by the name of their
    file."""
    return value(groups.named(name, group[name]))


def parameters(groups: Groups) -> list[str]:
    """Names of the parameters that distinguish the groups."""
    return [*groups.curve_parameters(), groups.abscissa]


def seeds_of(values: dict[str, Any], rows: pandas.DataFrame) -> str:
    """The seeds of a group. @param values  values of the group that distinguish its rows from those of other groups"""
    of_group = rows
    for name, value in values.items():
        of_group = of_group[of_group[name] == value]
    seeds = sorted(set(of_group.seed))
    if len(seeds) < 3:
        return ", ".join(map(str, seeds))
    between = f"{seeds[0]} to {seeds[-1]}"
    return between if seeds[-1] - seeds[0] + 1 == len(seeds) else f"{len(seeds)} of {between}"


def doubts_of(group: Group, sentences: dict[str, str]) -> str:
    """The words for a group's doubts. Each word has a sentence that explains it."""
    return ", ".join(f'<abbr title="{html.escape(sentences[name])}">{name.replace("_", " ")}</abbr>'
                     for name in style.doubts(group))


def table_cell(text: str) -> str:
    """A cell in HTML. If the table is narrow, the part in brackets moves to its own line."""
    number, space, rest = text.partition(" (")
    if not rest:
        return f"<td>{html.escape(text)}</td>"
    return f"<td><span>{html.escape(number)}</span><small>{html.escape(space + rest)}</small></td>"


def table(titles: Sequence[str], lines: Sequence[Sequence[str]], doubts: Sequence[str]) -> str:
    """The table with every number of the page. `page.js` shows the numbers at the points of the charts, and sorts the
    table.

    @param titles  headings in HTML
    @param lines  cells of each group
    @param doubts  doubts of each group, in HTML
    """
    head = "".join(f'<th scope="col">{title}</th>' for title in [*titles, "doubts"])
    body = "\n".join(f'<tr data-groups="{number}">' + "".join(table_cell(cell) for cell in cells)
                     + f'<td class="doubt">{doubt}</td></tr>'
                     for number, (cells, doubt) in enumerate(zip(lines, doubts)))
    return f'<div class="scroll"><table><thead><tr>{head}</tr></thead><tbody>\n{body}\n</tbody></table></div>'


def per_1000_sigma(group: Group) -> float | None:
    rate = group["failures_per_length"]
    return None if rate is None else 1000 * rate


def table_of_lengths(groups: Groups, sentences: dict[str, str], rows: pandas.DataFrame) -> str:
    names = parameters(groups)
    mechanisms = [name for name in style.MECHANISM_COLOURS if any(group[name] for group in groups.members)]
    passed = ["passed", "flowing"] if any(group["passed"] for group in groups.members) else []
    has_failed = any(group["failed"] for group in groups.members)
    titles = [*(name.replace("_", " ") for name in names), "runs", "clogs", *mechanisms, *passed,
              *(["failed", "failed per 1000&sigma;"] if has_failed else []),
              f"&lambda;/&sigma; ({100 * groups.confidence:g} %)",
              *(["lateral/r", "along rows"] if groups.are_lattices else []), "&lang;v<sub>g</sub>&rang;/v<sub>t</sub>",
              *laboratory_columns(groups).values(), "Ca", "seeds"]
    lines = [[*(cell(groups, group, name) for name in names), str(group["runs"]), str(group["clogs"]),
              *(str(group[name]) for name in [*mechanisms, *passed]),
              *([str(group["failed"]), rounded.plain(per_1000_sigma(group))] if has_failed else []), length(group),
              *([migration(group, "lateral_slope"), migration(group, "row_share")] if groups.are_lattices else []),
              speed(group), *(in_laboratory(group, name) for name in laboratory_columns(groups)),
              rounded.plain(group["capillary_number"]), seeds_of(groups.row_values(group), rows)]
             for group in groups.members]
    return table(titles, lines, [doubts_of(group, sentences) for group in groups.members])


def table_of_passages(groups: Groups, sentences: dict[str, str]) -> str:
    kind, names = passages.kind_of(groups), parameters(groups)
    titles = [*(name.replace("_", " ") for name in names), "outcome", *kind.columns.values()]
    lines = [[*(cell(groups, group, name) for name in names), kind.outcomes[group["status"]],
              *(value(group[name], 4) for name in kind.columns)]
             for group in groups.members]
    return table(titles, lines, [doubts_of(group, sentences) for group in groups.members])


def doubts(groups: Groups, sentences: dict[str, str], rows: pandas.DataFrame) -> str:
    """The section about doubts. @param sentences  for each doubt that a group may have, the sentence of clogfit"""
    words = []
    for name in dict.fromkeys(name for group in groups.members for name in style.doubts(group)):
        count = sum(name in style.doubts(group) for group in groups.members)
        of_points = f"{count} of {rounded.count_text(len(groups.members), 'point')}"
        words.append(f"<li class=doubt>{of_points}: {html.escape(sentences[name])}</li>")
    failed = rows[rows.status == "failed"]
    for _, row in failed.head(5).iterrows():
        words.append(f"<li class=doubt>task {row.task} (seed {row.seed}) failed: {html.escape(row.message)}</li>")
    if len(failed) and not groups.are_passages:
        num_unknown = sum(group["failed_somewhere"] for group in groups.members)
        words.append("<li class=doubt>Failed runs count as not clogged up to their last passed check (column "
                     f"sound_distance){f', except {num_unknown} without one' if num_unknown else ''}.</li>")
    return "<ul>" + "\n".join(words) + "</ul>" if words else "<p>None.</p>"


def examples(clogs_of_sweep: Sequence[np.void], count: int) -> list[np.void]:
    """Chooses clogs to show: a typical one of every mechanism, and others, spread evenly from the least to the most
    deformed.

    Clogs of droplets that travelled at least a diameter come first. Other clogs depend on the void of the release, not
    on the array.

    @param clogs_of_sweep  rows from clogs.of_polygons()
    """
    farthest = sorted(clogs_of_sweep, key=lambda row: -row["distance"])
    travelled = sum(row["distance"] >= 1 for row in farthest)
    ordered = sorted(farthest[:max(travelled, count)], key=lambda row: (row["shape_parameter"], row["task"]))
    if not ordered or count == 0:
        return []
    kinds: dict[bytes, list[np.void]] = {}
    for row in ordered:
        kinds.setdefault(row["mechanism"], []).append(row)
    typical = [kind[len(kind) // 2] for kind in kinds.values()]
    # The most and the least deformed clogs are excluded, because they often come from the runs with the least reliable
    # numerics.
    spread = [ordered[int(place)] for place in np.linspace(0.05, 0.95, count) * (len(ordered) - 1)]
    return list({row["task"]: row for row in typical + spread + ordered}.values())[:count]


def example_pictures(shown: Sequence[np.void], sweep: pathlib.Path, clogrun: pathlib.Path, charts: Charts) -> str:
    if not shown:
        return ""
    caption = "touched obstacles blue, contact red, convex hull dashed"
    try:
        again = clogs.run_all(clogrun, sweep, shown, 2)
    except UserError as error:
        raise UserError(f"{error}; use --examples 0 to skip the replays") from error
    return side_by_side(framed(charts.draw(clog.picture().figure, caption), caption) for clog in again)


def no_clogs(groups: Groups) -> str:
    """The section about clogs if none of the released droplets is a clogged polygon."""
    if any(group["families"]["clogged"]["number"] for group in groups.members if group.get("families")):
        return "<p>No released droplet has clogged, but daughters have. Pictures of them are not part of this page.</p>"
    return "<p>No polygon has clogged.</p>"


def progress_of(status: dict[str, Any]) -> str:
    """The progress of the sweep in words. @param status  output of clogsweep status"""
    numbers = {name: status[name] for name in ("clogged", "at_rest", "broken", "passed", "flowing", "failed")}
    numbers["running" if status["alive"] else "interrupted"] = status["unfinished"]
    counts = ", ".join(f"{number} {name.replace('_', ' ')}" for name, number in numbers.items() if number)
    return f"{status['finished']} of {rounded.count_text(status['runs'], 'run')} finished ({counts})"


LENGTHS = ("&lambda; is the mean distance that droplets travel before they clog, "
           "in droplet diameters; v<sub>t</sub> is the speed of a free droplet. "
           "Each point of a curve has a row of the table.")


def label_of_length(groups: Groups, group: Group) -> str:
    """The title of a point. Browsers show it even without a script."""
    known = "" if speed(group) == "-" else f", speed {speed(group)}"
    return (f"{valued(groups, group)}: "
            f"length {length(group)}{known}, {group['clogs']} of {rounded.count_text(group['runs'], 'run')} clogged")


def valued(groups: Groups, group: Group) -> str:
    return ", ".join(f"{name.replace('_', ' ')} {cell(groups, group, name)}" for name in parameters(groups))


MAPPED = 4  # number of runs that the map of each panel of a device includes


def devices(groups: Groups, sweep: pathlib.Path, count: int, clogrun: pathlib.Path, charts: Charts) -> dict[str, str]:
    """Draws devices of user-supplied circles, with the places of releases and clogs.
    @param count  number of paths in each panel; with 0 nothing is replayed"""
    if groups.values("obstacle_filling") != {"file"}:
        return {}
    caption = "releases, clogs, where droplets went, and the share that came past each place"

    def drawn(every: list[device.Part]) -> str:
        parts = device.shown_parts(every, sweep, clogrun, count, MAPPED if count else 0, 2)
        return framed(charts.draw(device.draw(*parts, groups.laboratory.get("length_mm")), caption),
                      f"{parts[0][0].place.name}: {caption}", "wide")

    return {"Devices": "".join(drawn(parts)
                               for parts in device.pictures(device.places(sweep, clogrun.parent), groups) if parts)}


def of_lengths(groups: Groups, sweep: pathlib.Path, count: int, clogrun: pathlib.Path,
               charts: Charts) -> dict[str, str]:
    """The sections about droplets among obstacles. @param count  number of clogs to show. @return the contents of the
    sections by title"""
    def chart(figure: Figure, caption: str) -> str:
        is_wide = figure.get_figwidth() > 1.5 * figure.get_figheight()
        return framed(charts.draw(figure, caption), caption, "wide" if is_wide else "")

    curves = [chart(style.figure_of(curve.draw_on, groups), curve.heading(groups))] if with_runs(groups.members) else []
    if lengths.have_speeds(groups.members):
        curves.append(chart(style.figure_of(lengths.draw_speeds_on, groups), "mean speed over terminal speed"))
    survivals = [chart(style.figure_of(draw_survival, groups, label, members), "P(r), to the longest way")
                 for label, members in groups.curves()
                 if any(group["survival"] for group in members)]
    survivals += [chart(incidence(groups, label, members), "ends by cause") for label, members in groups.curves()
                  if len(occurring_causes(members)) > 1]
    ends = [chart(style.figure_of(draw_causes, groups, label, members), "ends by cause, shares")
            for label, all_of_it in groups.curves()
            if (members := with_runs(all_of_it))]
    broken = []
    if any((group.get("families") or {}).get("lines") for group in groups.members):
        broken.append(chart(families.draw(groups, None, sweep),
                            "droplets that break up, and the sizes of those that pass; all other tables and pictures "
                            "are of released droplets until they break up"))
    clogged = clogs.of_polygons(stored.read_rows(sweep, clogrun.parent), sweep)
    shown = example_pictures(examples(clogged, count), sweep, clogrun, charts)
    return {"Curves": side_by_side(curves), "How far droplets get": side_by_side(survivals),
            "What becomes of them": side_by_side(ends), "Families": side_by_side(broken),
            **devices(groups, sweep, count, clogrun, charts),
            "Example clogs": shown if clogged else no_clogs(groups)}


def label_of_passage(groups: Groups, group: Group) -> str:
    kind = passages.kind_of(groups)
    return f"{valued(groups, group)}: {kind.outcomes[group['status']]}"


def of_passages(groups: Groups, sweep: pathlib.Path, count: int, clogrun: pathlib.Path,
                charts: Charts) -> dict[str, str]:
    """The sections about droplets in a channel or on a wall. @param count  number of outlines to show"""
    kind = passages.kind_of(groups)
    curves = [framed(charts.draw(style.figure_of(passages.draw_curves, groups, column), name), name)
              for column, name in passages.drawn_columns(groups).items()]
    with tempfile.TemporaryDirectory(prefix="clogsweep-report-") as folder:
        drawn = passages.draw_outlines(groups, passages.examples(stored.read_rows(sweep, clogrun.parent), count),
                                       clogrun, sweep, folder)
    outlines = side_by_side(framed(charts.draw(figure, f"outline {kind.outline}"), f"outline {kind.outline}")
                            for figure in drawn)
    reached = "".join(f"<li>{html.escape(f'{curve}: {share}' if curve else share)}</li>"
                      for curve, share in passages.shares(groups, value))
    return {kind.heading: f"<ul>{reached}</ul>{side_by_side(curves)}", "Outlines": outlines or "<p>None.</p>"}


def busy_ranks(about: dict[str, str], charts: Charts) -> str:
    """The section about busy and idle ranks. @param about  attributes of the sweep's file"""
    sessions = activity.sessions_of(about)
    if not sessions:
        return ""
    caption = "busy ranks over time"
    return f"<p>{html.escape(activity.lost(sessions))}</p>" + side_by_side([framed(charts.draw(style.figure_of(activity.draw_on, sessions), caption), caption)])


def side_by_side(pictures: Iterable[str]) -> str:
    shown = "".join(pictures)
    return f'<div class="pictures">{shown}</div>' if shown else ""


PROVENANCE = ("command_line", "parts", "version", "git_describe", "git_hash", "compiler", "mpi_version", "hdf5_version",
              "start_time", "num_ranks")
RANDOM_ARRAYS = ("obstacle-gap", "obstacle-density", "obstacle-diameter-spread", "obstacle-layout")


def settings(config: str) -> str:
    """The settings of a sweep. With user-supplied circles, the keys of random arrays are left out."""
    own_circles = stored.settings(config).get("obstacles", "none") != "none"
    return "\n".join(line for line in config.split("\n")
                     if not (own_circles and line.partition(" = ")[0] in RANDOM_ARRAYS))


def laboratories_of(groups: Groups) -> list[str]:
    """The units of each laboratory, and its description."""
    lines: dict[str, None] = {}
    for group in groups.members:
        if scale := group.get("laboratory_scale"):
            units = ", ".join(f"{name.replace('_', ' ')} {rounded.plain(value)}" for name, value in scale.items()
                              if value is not None)
            lines[f"laboratory: {groups.laboratories.get(group['laboratory'], 'of --lab')} ({units})"] = None
    return list(lines)


def page(name: str, groups: Groups, sections: dict[str, str], progress: str, about: dict[str, str], charts: Charts,
         fitted_by: str) -> str:
    """The page in HTML. @param sections  contents by title; @param charts  the charts in these sections;
    @param fitted_by  version of clogfit"""
    def part(ending: str) -> str:
        return pathlib.Path(__file__).with_name(f"page.{ending}").read_text(encoding="utf-8")

    light, dark = charts.colours()
    return string.Template(part("html")).substitute(
        name=html.escape(printable(name)), style=part("css"), light=light, dark=dark, script=part("js"),
        progress=html.escape(f"{progress}, {rounded.count_text(len(groups.members), 'point')}"),
        meaning=passages.kind_of(groups).about if groups.are_passages else LENGTHS,
        sections="\n".join(f"<h2>{title}</h2>{content}" for title, content in sections.items() if content),
        provenance=html.escape("\n".join([*(f"{key}: {about[key]}" for key in PROVENANCE if key in about),
                                          *laboratories_of(groups), f"fitted by clogfit {fitted_by}"])),
        config=html.escape(settings(about.get("config", ""))))


def write(sweep: pathlib.Path, output: pathlib.Path, examples: int, folder: pathlib.Path,
          *options: object) -> pathlib.Path:
    """Writes the page. An earlier page is replaced, but no other file.
    @param examples  number of clogs or outlines to show; @param folder  of the programs; @param options  of clogfit
    @return the output
    @throws UserError, ProgramFailed"""
    outputs.refuse_unwritable(output, "html", sweep)
    answer, circle_files = fits.fitted(folder / "clogfit", sweep, *options)
    status = json.loads(programs.run_program(folder / "clogsweep", "status", sweep, "--format", "json"))
    groups = Groups(answer, circle_files).finished(sweep).fit_curves(sweep, folder)
    for number, group in enumerate(groups.members):
        group["number"] = number  # identifies the group in the page (style.mark())
    rows = stored.read_table(sweep, folder)
    with stored.opened(sweep, folder=folder) as file:
        about = stored.attributes(file)
    sentences = answer["doubts"]
    label, tell = (label_of_passage, of_passages) if groups.are_passages else (label_of_length, of_lengths)
    charts = Charts([label(groups, group) for group in groups.members])
    curves, *pictures = tell(groups, sweep, examples, folder / "clogrun", charts).items()
    sections = dict([curves,
                     ("Table", table_of_passages(groups, sentences) if groups.are_passages else table_of_lengths(groups, sentences, rows)),
                     ("What may spoil these numbers", doubts(groups, sentences, rows)),
                     *pictures,
                     ("How busy the ranks were", busy_ranks(about, charts))])
    with outputs.replaced(output) as fresh:
        fresh.write_text(page(sweep.name, groups, sections, progress_of(status), about, charts, stored.writer(answer)),
                         encoding="utf-8")
    return output
