"""Draws results of single droplets against the varied parameter: their passage through a channel, or their sag on a
wall."""

import dataclasses
import os
import pathlib
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from .. import style
from ..labels import AXES
from ..labels.groups import FINISHED, Groups
from ..reading import replays, stored
from ..reading.trajectory import Trajectory
from ..tools.hints import Group
from . import lengths, surroundings


@dataclasses.dataclass(frozen=True)
class Kind:
    """The headings, labels and columns for droplets in a channel, or for droplets on a wall."""

    heading: str
    goal: str  # Status of droplets that passed the channel, or came to rest on the wall.
    outcomes: dict[str, str]  # Words for each status.
    curves: dict[str, str]  # Columns that have a picture, with the labels of their axes.
    columns: dict[str, str]  # Columns of the table, with their headings.
    outline: str
    about: str


CHANNEL = Kind(
    "Passages", "passed", {"passed": "passed", "clogged": "clogged", "broken": "broken up",
                           "flowing": "flowing at the end"},
    {"largest_shape_parameter": r"largest shape parameter $A$",
     "smallest_relative_speed": r"smallest speed $v_g/v_t$",
     "largest_relative_speed": r"largest speed $v_g/v_t$"},
    {"largest_shape_parameter": "largest A", "largest_shape_parameter_at": "at h/&sigma;",
     "smallest_relative_speed": "smallest v<sub>g</sub>/v<sub>t</sub>",
     "smallest_relative_speed_at": "at h/&sigma;", "largest_relative_speed": "largest v<sub>g</sub>/v<sub>t</sub>",
     "largest_relative_speed_at": "at h/&sigma;"},
    "where its shape parameter is largest",
    "h is the position of the droplet's centre relative to the orifice, v<sub>t</sub> the speed of a free droplet.")
WALL = Kind(
    "Sags", "clogged", {"clogged": "at rest", "broken": "broken up", "flowing": "not yet at rest"},
    {"sag": AXES["sag"], "top_sag": AXES["top_sag"]},
    {"sag": "sag/&sigma;", "top_sag": "sag of the top/&sigma;", "shape_parameter": "A"},
    "at the end", "The sag is how far the droplet's centroid, or its top, sinks under its own weight.")


def kind_of(groups: Groups) -> Kind:
    return CHANNEL if groups.members[0]["obstacle_filling"] == "channel" else WALL


def share(kind: Kind, members: Sequence[Group]) -> str:
    """The number of a curve's droplets that passed or came to rest, and the number of all its droplets."""
    return f"{sum(group['status'] == kind.goal for group in members)} of {len(members)} {kind.outcomes[kind.goal]}"


def drawn_columns(groups: Groups) -> dict[str, str]:
    """The quantities with a curve, and their names."""
    return {column: column.replace("_", " ") for column in kind_of(groups).curves
            if groups.are_polygons or column != "largest_shape_parameter"}  # A soft disk always stays a circle.


def draw_curves(axes: Axes, groups: Groups, column: str) -> None:
    """Draws one point for each droplet. A cross means that the droplet clogged in a channel. A hollow marker means that
    the run ended before the droplet passed or came to rest."""
    kind = kind_of(groups)
    markers = {kind.goal: {"marker": "o"}, "flowing": {"marker": "o", "markerfacecolor": "white"},
               "broken": {"marker": "^"}}
    for index, (label, members) in enumerate(groups.curves()):
        members = sorted((group for group in members if group[column] is not None),
                         key=lambda group: float(group[groups.abscissa]))
        look = {name: style.curve_style(index)[name] for name in ("color", "linestyle")}
        axes.plot([group[groups.abscissa] for group in members], [group[column] for group in members], linewidth=1,
                  **look, label=f"{label}: {share(kind, members)}" if label else share(kind, members),
                  gid=style.mark("curve", members))
        for group in members:
            axes.plot(group[groups.abscissa], group[column], color=look["color"], markersize=6,
                      gid=style.mark("point", [group]), **markers.get(group["status"], {"marker": "X"}))
    lengths.draw_abscissa(axes, groups)
    ends = {group["status"] for group in groups.members}
    style.finish(axes, kind.curves[column], groups.caption(), ["; ".join(
        f"{sign}: {kind.outcomes[status]}" for sign, status in (
            ("dots", kind.goal), ("crosses", "clogged"), ("triangles", "broken"), ("hollow", "flowing"))
        if status in ends and (sign == "dots" or status != kind.goal))])


def shares(groups: Groups, value: Callable[[Any], str]) -> list[tuple[str, str]]:
    """For every curve, its label and the number of its droplets that passed or came to rest. @param value  formats the
    value of a parameter"""
    kind, names = kind_of(groups), groups.curve_parameters()
    return [(", ".join(f"{name.replace('_', ' ')} {value(members[0][name])}" for name in names), share(kind, members))
            for _, members in groups.curves()]


def examples(rows: npt.NDArray[np.void], count: int) -> list[np.void]:
    """Rows that are evenly spread over the sweep. The first and the last row are included."""
    over = [row for row in rows if stored.text(row["status"]) in FINISHED and row["model"] == b"dp"]
    places = {round(place) for place in np.linspace(0, len(over) - 1, min(count, len(over)))}
    return [over[place] for place in sorted(places)]


def followed(rows: Sequence[np.void], clogrun: pathlib.Path, sweep: pathlib.Path,
             folder: str | os.PathLike[str]) -> list[Trajectory]:
    """Replays the droplet of each row. @param folder  for the files of the replays"""
    if not rows:
        return []
    # At terminal speed a droplet moves by a fiftieth of its diameter between two frames.
    frame = min(0.02 / row["terminal_speed"] for row in rows)
    return replays.follow_all(clogrun, sweep, rows, folder, 2, frame, frame)


def draw_outlines(groups: Groups, rows: Sequence[np.void], clogrun: pathlib.Path, sweep: pathlib.Path,
                  folder: str | os.PathLike[str]) -> list[Figure]:
    """Draws one picture for each row's droplet."""
    pictures = []
    for run in followed(rows, clogrun, sweep, folder):
        figure, axes = style.subplots(figsize=(4.6, 4.6))
        draw_outline(axes, groups, run)
        pictures.append(figure)
    return pictures


def draw_outline(axes: Axes, groups: Groups, run: Trajectory) -> None:
    kind = kind_of(groups)
    shown = run.frame_at("h", run.row["largest_shape_parameter_at"]) if kind is CHANNEL else -1
    low, high = run.polygons[shown].min(axis=1), run.polygons[shown].max(axis=1)
    surroundings.draw_droplet(axes, run, shown, (low + high) / 2)
    half = (high - low).max() / 2 + 0.3
    surroundings.frame_limits(axes, (-half, -half), (half, half))
    axes.set_xlabel(r"$x/\sigma$ from the droplet's middle, along gravity")
    axes.set_ylabel(r"$y/\sigma$")
    names = [*groups.curve_parameters(), groups.abscissa]
    label = ", ".join(
        groups.parameter_label(name, run.word(name) if run.row[name].dtype.kind == "S" else float(run.row[name]))
        for name in names)
    axes.set_title(f"task {run.path.stem.rsplit('-', 1)[1]}: {label}\n{kind.outcomes[run.word('status')]}; "
                   f"{kind.outline}", fontsize=8)
