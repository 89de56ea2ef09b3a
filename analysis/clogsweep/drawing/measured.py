"""Draws measured clogging lengths beside the simulated ones."""

import json
import math
import pathlib
import sys
from typing import Any

from matplotlib.axes import Axes

from .. import style
from ..labels.groups import Groups
from ..reading import fits, programs
from ..tools.errors import UserError

COLOUR = "#444444"
ABOVE = 4  # Drawing order in front of the simulated markers, which have 3.
ROUNDING = 0.005  # Users may round numbers to three digits, see clogfit compare.
LENGTHS = ("clogging_length", "clogging_length_lower", "clogging_length_upper")


def lengths_of(table: pathlib.Path, groups: Groups, folder: pathlib.Path | None,
               *options: object) -> list[dict[str, Any]]:
    """The groups that clogfit lengths finds in a table of distances. Lengths are in the unit of the picture.
    @param groups  of the sweep; its laboratory gives the diameter
    @throws UserError  if the table is in mm and no diameter is known"""
    answer = json.loads(programs.run_program(programs.programs_in(folder) / "clogfit", "lengths",
                                             table, "--format", "json", "--confidence", groups.confidence, *options))
    members: list[dict[str, Any]] = answer["groups"]
    known = {fits.DROPLETS[column]["key"] if column in fits.DROPLETS else column for column in groups.columns}
    if unmatched := [label for label in answer["labels"] if label.replace("-", "_") not in known]:
        print(f"{table}: columns without a match in the sweep: {', '.join(unmatched)}", file=sys.stderr)
    if answer["unit"] == ("mm" if groups.are_in_mm else "sigma"):
        return members if answer["unit"] == "sigma" else [group | {name: group[f"{name}_mm"] for name in LENGTHS}
                                                          for group in members]
    if groups.are_in_mm:
        raise UserError(f"{table} is in droplet diameters and the sweep has several droplets; give distances in mm")
    diameter = groups.laboratory.get("length_mm")
    sizes = [group.get("diameter") if isinstance(group.get("diameter"), int | float) else diameter for group in members]
    if None in sizes:
        raise UserError(f"{table} is in mm and the sweep in droplet diameters; "
                        "give the droplet's diameter by --lab lab.cfg")
    if diameter and (others := [size for size in sizes if not are_alike(size, diameter)]):
        print(f"{table}: left out, {len(others)} of {len(members)} groups have other diameters than the droplets "
              f"of the sweep, such as {others[0]:g} mm", file=sys.stderr)
    return [group | {name: None if group[f"{name}_mm"] is None else group[f"{name}_mm"] / size for name in LENGTHS}
            for group, size in zip(members, sizes) if not diameter or are_alike(size, diameter)]


def are_alike(one: Any, other: Any) -> bool:
    if isinstance(one, int | float) and isinstance(other, int | float):
        return math.isclose(one, other, rel_tol=ROUNDING)
    return bool(one == other)


def colour_of(group: dict[str, Any], groups: Groups) -> str:
    """The colour of the curve that has the values of a measured group, or dark grey if no curve has these values."""
    columns = {fits.DROPLETS[name]["key"] if name in fits.DROPLETS else name: name
               for name in groups.curve_parameters()}
    values = {columns[key]: value for name, value in group.items() if (key := name.replace("-", "_")) in columns}
    alike = [place for place, (_, members) in enumerate(groups.curves())
             if all(are_alike(value, members[0][name]) for name, value in values.items())]
    return str(style.curve_style(alike[0])["color"]) if values and len(alike) == 1 else COLOUR


def draw_on(axes: Axes, measured: list[dict[str, Any]], groups: Groups, label: str) -> None:
    """Draws the measured groups. A group with a value of the abscissa is a star with an interval. The star has the
    colour of the curve with the same values of all other parameters. A group without a value of the abscissa becomes a
    band over the whole range of the abscissa. If no droplet of a group clogged, an arrow points up from the lower
    bound."""
    drawn = False
    for group in measured:
        colour = colour_of(group, groups)
        place = next((value for name, value in group.items() if name.replace("-", "_") == groups.abscissa_key()), None)
        length, lower, upper = (group[f"clogging_length{end}"] for end in ("", "_lower", "_upper"))
        name = "_" if drawn else label
        if not isinstance(place, int | float):
            if length is None:
                axes.axhline(lower, color=colour, linestyle=":", label=f"{label} (lower bound)")
                continue
            axes.axhline(length, color=colour, linestyle="--", linewidth=1, label=name)
            axes.axhspan(lower, upper, color=colour, alpha=0.15, linewidth=0, zorder=0,
                         label=f"{name}, {100 * groups.confidence:g} % interval")
        elif length is None:
            axes.plot(place, lower, marker=style.LOWER_BOUND, color=colour, linestyle="none", markersize=25, label=name,
                      zorder=ABOVE)
        else:
            axes.errorbar(place, length, yerr=[[length - lower], [upper - length]], fmt="*", color=colour,
                          ecolor=COLOUR, markeredgecolor=COLOUR, markersize=9, capsize=2.5, label=name, zorder=ABOVE)
        drawn = True
    style.legend(axes)  # The legend has entries for the sweep's markers already.
