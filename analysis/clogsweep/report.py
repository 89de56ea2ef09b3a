"""One page about a sweep: curves, table, example clogs or outlines, doubts, where the numbers came from."""

import base64
import html
import io
import json
import tempfile

import numpy as np

from . import clogs, lengths, passages, programs, rounded, stored, style, survival_curve
from .errors import UserError
from .groups import Groups

STYLE = """
body { font: 15px/1.5 system-ui, sans-serif; max-width: 72rem; margin: 2rem auto; padding: 0 1rem; color: #222; }
h1 { font-size: 1.5rem; margin-bottom: 0; } h2 { font-size: 1.15rem; margin-top: 2rem; }
p.about { color: #555; margin-top: .2rem; }
table { border-collapse: collapse; font-size: .85rem; font-variant-numeric: tabular-nums; }
.scroll { overflow-x: auto; }
th, td { padding: .2rem .5rem; text-align: right; border-bottom: 1px solid #ddd; white-space: nowrap; }
th { border-bottom: 2px solid #888; font-weight: 600; white-space: normal; vertical-align: bottom; }
.doubt { color: #9a3b00; } td.doubt { white-space: normal; min-width: 9rem; text-align: left; } .pictures { display: flex; flex-wrap: wrap; gap: 1rem; } .pictures img { max-width: 30rem; width: 100%; }
figure { margin: 0; flex: 1 1 26rem; } figcaption { color: #555; font-size: .9rem; }
pre { background: #f5f5f5; padding: .7rem; overflow-x: auto; font-size: .85rem; }
"""


def picture(figure, caption):
    out = io.BytesIO()
    figure.savefig(out, format="png", dpi=130)
    data = base64.b64encode(out.getvalue()).decode()
    return f'<figure><img alt="{html.escape(caption)}" src="data:image/png;base64,{data}"><figcaption>{html.escape(caption)}</figcaption></figure>'


def survival(groups, label, members):
    """P(r) of one curve's members to their longest ways, each with the exponential of its length if it is known."""
    figure, axes = style.subplots(figsize=(6.4, 4.8))
    begin = min(0.01 * (group["clogging_length"] or survival_curve.longest_way(group)) for group in members)
    for group, colour in zip(members, style.VIRIDIS(np.linspace(0, 0.9, len(members)))):
        if group["survival"]:
            r = group["clogging_length"] * np.logspace(-2, 1, 100)
            axes.plot(r, np.exp(-r / group["clogging_length"]), color=colour, linewidth=0.8, linestyle="--")
        survival_curve.draw(axes, group, colour, groups.said(groups.abscissa, group[groups.abscissa]), begin=begin)
    axes.set_xscale("log")
    axes.set_ylim(0, 1.02)
    axes.set_xlabel(r"displacement along the flow $r/\sigma$")
    axes.set_ylabel("probability $P(r)$ of not having clogged")
    style.grid(axes)
    axes.legend(frameon=False, fontsize=8, ncols=1 + len(members) // 8)
    style.caption(axes, f"{label or groups.caption()}\nsteps: clogs; ticks: runs last seen going; "
                        "dashed: exponential of the same length")
    return figure


def occurring_causes(members):
    """Words of clogfit for what ended runs of these groups, in the order of their colours."""
    return [name for name in style.CAUSE_COLOURS if any(name in group["incidence"] for group in members)]


def incidence(groups, label, members):
    """How probable an end by each cause is on a way r, the others being at work (Aalen and Johansen's estimate), for one curve's members."""
    names = occurring_causes(members)
    figure, all_axes = style.subplots(1, len(names), figsize=(3.2 * len(names), 4.8), sharex=True, sharey=True, squeeze=False)
    longest = max(survival_curve.longest_way(group) for group in members)
    begin = 0.5 * min((step["distance"] for group in members for steps in group["incidence"].values() for step in steps if step["distance"] > 0), default=longest)
    for axes, name in zip(all_axes[0], names):
        for group, colour in zip(members, style.VIRIDIS(np.linspace(0, 0.9, len(members)))):
            steps = group["incidence"].get(name, [])
            way = [begin, *(step["distance"] for step in steps), survival_curve.longest_way(group)]
            share = [0, *(step["probability"] for step in steps)]
            axes.step(way, [*share, share[-1]], where="post", color=colour, linewidth=1.2, label=groups.said(groups.abscissa, group[groups.abscissa]))
        axes.set_title(name, fontsize=10)
        axes.set_xscale("log")
        axes.set_xlim(begin, longest)
        axes.set_ylim(0, 1.02)
        axes.set_xlabel(r"$r/\sigma$")
        style.grid(axes)
    all_axes[0][0].set_ylabel("probability to have ended so within $r$")
    all_axes[0][0].legend(frameon=False, fontsize=8, ncols=1 + len(members) // 8)
    figure.suptitle(label or groups.caption(), fontsize=8, wrap=True)
    return figure


def causes(groups, label, members):
    """What became of the runs of one curve, as shares."""
    figure, axes = style.subplots(figsize=(6.4, 4.8))
    places, base = np.arange(len(members)), np.zeros(len(members))
    shares = {name if name == "broken" else f"clogged, {name}": (colour, [(group[name] or 0) / group["runs"] for group in members])
              for name, colour in style.CAUSE_COLOURS.items()}
    shares["still going"] = ("0.88", [1 - (group["clogs"] + (group["broken"] or 0)) / group["runs"] for group in members])
    for name, (colour, share) in shares.items():
        if any(share):
            axes.bar(places, share, bottom=base, color=colour, width=0.8, label=name)
        base += share
    axes.set_xticks(places, [f"{group[groups.abscissa]:g}" for group in members], rotation=0 if len(members) <= 10 else 90)
    axes.set_xlabel(groups.axis_label())
    axes.set_ylabel("share of the runs")
    axes.legend(frameon=False, loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=5, fontsize=8, title=label, title_fontsize=8)
    return figure


def length(group):
    """The clogging length with its interval, or its lower bound."""
    ends = [group[f"clogging_length_{end}"] for end in ("lower", "upper")]
    return rounded.with_interval(group["clogging_length"], *ends) if group["clogs"] > 0 else f"&gt; {rounded.plain(ends[0])}"


def value(cell, digits=6):
    """Of a parameter, as a table shows it."""
    return "-" if cell is None else cell if isinstance(cell, str) else f"{cell:.{digits}g}"


def table(groups):
    names = [*groups.curve_parameters(), groups.abscissa]
    titles = [*names, "runs", "clogs", ", ".join(style.MECHANISM_COLOURS), f"&lambda;/&sigma; ({100 * groups.confidence:g} %)",
              "&lang;v<sub>g</sub>&rang;/v<sub>t</sub>", "Ca", "doubts"]
    lines = ["<tr>" + "".join(f"<th>{title.replace('_', ' ')}</th>" for title in titles) + "</tr>"]
    for group in groups.members:
        cells = [*(value(group[name]) for name in names), group["runs"], group["clogs"],
                 ", ".join(str(group[name]) for name in style.MECHANISM_COLOURS), length(group),
                 rounded.with_error(group["relative_speed"], group["relative_speed_error"]), rounded.plain(group["capillary_number"])]
        doubts = ", ".join((group["doubts"] or "").split()).replace("_", " ")
        lines.append("<tr>" + "".join(f"<td>{cell}</td>" for cell in cells) + f'<td class="doubt">{html.escape(doubts)}</td></tr>')
    return '<div class="scroll"><table>' + "\n".join(lines) + "</table></div>"


def doubts(groups, sentences, rows):
    """@param sentences  of clogfit, by the words that its groups hold"""
    words = []
    for name in dict.fromkeys(name for group in groups for name in (group["doubts"] or "").split()):
        count = sum(name in (group["doubts"] or "").split() for group in groups)
        words.append(f"<li class=doubt>{count} of {rounded.counted(len(groups), 'point')}: {html.escape(sentences[name])}</li>")
    failed = rows[rows.status == "failed"]
    for _, row in failed.head(5).iterrows():
        words.append(f"<li class=doubt>task {row.task} (seed {row.seed}) failed: {html.escape(row.message)}</li>")
    return "<ul>" + "\n".join(words) + "</ul>" if words else "<p>None.</p>"


def examples(clogs_of_sweep, count):
    """Clogs to be shown: the typical one of every mechanism, the others spread from the least to the most deformed.

    @param clogs_of_sweep  rows as clogs.of_polygons() gives them
    """
    ordered = sorted(clogs_of_sweep, key=lambda row: (row["shape_parameter"], row["task"]))
    if not ordered or count == 0:
        return []
    kinds = {}
    for row in ordered:
        kinds.setdefault(row["mechanism"], []).append(row)
    typical = [kind[len(kind) // 2] for kind in kinds.values()]
    # The extremes themselves are often the least sound runs.
    spread = [ordered[int(place)] for place in np.linspace(0.05, 0.95, count) * (len(ordered) - 1)]
    return list({row["task"]: row for row in typical + spread}.values())[:count]


def example_pictures(shown, sweep, clogrun):
    if not shown:
        return "<p>No polygon has clogged.</p>"
    try:
        again = clogs.run_all(clogrun, sweep, shown, 2)
    except UserError as error:
        raise UserError(f"{error}; --examples 0 does without") from error
    return side_by_side("".join(picture(clog.picture().figure, "touched obstacles blue, contact red, convex hull dashed") for clog in again))


def progress_of(status, rows):
    """@param status  of clogsweep status; @param rows  the tasks that have begun"""
    counts = ", ".join(f"{count} {name}" for name, count in rows.status.value_counts().items())
    return f"{status['over']} of {rounded.counted(status['runs'], 'run')} finished ({counts})"


LENGTHS = "&lambda; is the way after which 1/e of the droplets have not clogged, in droplet diameters; v<sub>t</sub> is the speed of a free droplet."


def of_lengths(groups, sweep, count, clogrun):
    """What is told of droplets among obstacles. @param count  clogs to show. @return contents by title, the table"""
    curves = picture(lengths.draw(groups), "clogging length")
    if any(group["relative_speed"] is not None for group in groups.members):
        curves += picture(lengths.draw_speeds(groups), "mean speed over terminal speed")
    survivals = "".join(picture(survival(groups, label, members), "P(r), to the longest way") for label, members in groups.curves()
                        if any(group["survival"] for group in members))
    survivals += "".join(picture(incidence(groups, label, members), "ends by cause") for label, members in groups.curves()
                         if len(occurring_causes(members)) > 1)
    ends = "".join(picture(causes(groups, label, members), "ends by cause, shares") for label, members in groups.curves())
    return {"Curves": side_by_side(curves), "How far droplets get": side_by_side(survivals), "What becomes of them": side_by_side(ends),
            "Example clogs": example_pictures(examples(clogs.of_polygons(stored.read_rows(sweep), sweep), count), sweep, clogrun)}, table(groups)


def of_passages(groups, sweep, count, clogrun):
    """The same of droplets in a channel or on a wall. @param count  outlines to show"""
    kind = passages.kind_of(groups)
    curves = "".join(picture(passages.draw_curves(groups, column), column.replace("_", " ")) for column in kind.curves
                     if groups.are_polygons or column != "largest_shape_parameter")  # a soft disk stays a circle
    with tempfile.TemporaryDirectory(prefix="clogsweep-report-") as folder:
        drawn = passages.draw_outlines(groups, passages.examples(stored.read_rows(sweep), count), clogrun, sweep, folder)
    outlines = "".join(picture(figure, f"outline {kind.outline}") for figure in drawn)
    return {kind.heading: passages.shares(groups, value) + side_by_side(curves), "Outlines": side_by_side(outlines) or "<p>None.</p>"}, passages.table(groups, value)


def side_by_side(pictures):
    return f'<div class="pictures">{pictures}</div>' if pictures else ""


def page(path, groups, sections, progress, about, fit):
    """@param sections  contents by title; about  what the sweep's file says of itself; fit  what clogfit says"""
    provenance = "\n".join([f"{key}: {about[key]}" for key in ("command_line", "version", "git_describe", "git_hash", "compiler", "mpi_version", "hdf5_version", "start_time", "num_ranks")
                            if key in about] + [f"fitted by clogfit {stored.writer(fit)}"])
    meaning = passages.kind_of(groups).about if groups.are_passages else LENGTHS
    told = "".join(f"<h2>{title}</h2>{content}\n" for title, content in sections.items())
    return f"""<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width"><title>{html.escape(path.name)}</title><style>{STYLE}</style></head><body>
<h1>Sweep {html.escape(path.name)}</h1>
<p class="about">{html.escape(progress)}, {rounded.counted(len(groups.members), "point")}.
{meaning}</p>
{told}<h2>Where they come from</h2><pre>{html.escape(provenance)}</pre><details><summary>All settings</summary><pre>{html.escape(about.get("config", ""))}</pre></details>
</body></html>
"""


def write(sweep, output, examples, folder):
    """@param examples  clogs or outlines to show; @param folder  of the programs. @return the output. @throws UserError, ProgramFailed"""
    fit = json.loads(programs.run_program(folder / "clogfit", sweep, "--format", "json"))
    status = json.loads(programs.run_program(folder / "clogsweep", "status", sweep, "--format", "json"))
    groups = Groups(fit)
    if not groups.members:
        raise UserError(f"{sweep} holds no finished runs; let the sweep finish some first")
    rows = stored.read_table(sweep)
    with stored.opened(sweep) as file:
        about = stored.attributes(file)
    tell = of_passages if groups.are_passages else of_lengths
    sections, numbers = tell(groups, sweep, examples, folder / "clogrun")
    sections |= {"What may spoil these numbers": doubts(groups.members, fit["doubts"], rows), "Table": numbers}
    try:
        output.write_text(page(sweep, groups, sections, progress_of(status, rows), about, fit))
    except OSError as error:
        raise UserError(f"cannot write {output} ({error.strerror}); give another --output") from error
    return output
