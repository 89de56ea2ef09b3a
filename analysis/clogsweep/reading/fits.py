"""Calls clogfit and reads its answers."""

import json
import pathlib
from collections.abc import Collection, Iterable
from typing import Any

from ..tools import lists
from ..tools.errors import UserError
from ..tools.hints import AnyPath, Column, Group
from . import programs, stored


def run_clogfit(clogfit: pathlib.Path, *words: object) -> dict[str, Any]:
    """The JSON output of clogfit for these sweeps and options. @throws ProgramFailed  with clogfit's reason"""
    return json.loads(programs.run_program(clogfit, *map(as_file, words), "--format", "json"))


def as_file(word: object) -> object:
    """A path in a form that no program mistakes for one of its commands, such as clogfit curve. Paths of Python lose
    the ./ of ./curve."""
    return f"./{word}" if isinstance(word, pathlib.PurePath) and len(word.parts) == 1 and not word.suffix else word


# Values of obstacle_filling for which droplets have no clogging length, and their names in messages.
PLACES = {"channel": "channels", "wall": "a flat wall"}


def refuse_mixed(fillings: Iterable[str], message: str) -> None:
    """@param fillings  values of obstacle_filling; @param message  with {} for the kinds of places
    @throws UserError  if the results are of different kinds: from arrays, channels and walls"""
    kinds: dict[str, list[str]] = {}
    for filling in sorted(fillings, key=lambda filling: (filling in PLACES, filling)):
        kinds.setdefault(PLACES.get(filling, "arrays"), []).append(filling)
    if len(kinds) > 1:
        raise UserError(f"{message.format(' and '.join(kinds))}; keep one kind, as by "
                        f"clogsweep select FILE obstacle_filling={','.join(next(iter(kinds.values())))} --output ONE_KIND.h5")


# The droplets of one sweep may differ in these quantities if a lab file lists several values.
DROPLETS: dict[str, dict[str, Any]] = {
    "diameter_mm": {"key": "diameter", "symbol": r"\sigma", "unit": "mm", "meaning": "diameter of the droplet", "label": "diameter {:.4g} mm"},
    "angle_degrees": {"key": "angle", "symbol": r"\theta", "unit": "degrees", "meaning": "tilt of the plates", "label": "tilt {:.4g}°"}}


def follows(groups: Collection[Group], name: str, others: Iterable[str]) -> bool:
    """Whether the value of this parameter follows from the values of the others."""
    known: dict[tuple[Any, ...], Any] = {}
    return all(known.setdefault(tuple(group[o] for o in others), group[name]) == group[name] for group in groups)


def in_millimetres(fit: dict[str, Any]) -> dict[str, Any]:
    """Converts a fit of several droplets in a laboratory. The diameter and the tilt become parameters. Lengths are
    converted to mm, because in droplet diameters the lengths of one array differ between the droplets. The angle of a
    lattice is the requested angle, because each droplet has other possible angles. "in_table" of a group contains its
    values as in the sweep's table, and "following" names the parameters with values that follow from the droplet. Fits
    of other sweeps stay unchanged."""
    groups = fit["groups"]
    if "laboratory" in fit or "in_mm" in fit or not groups or not all(group.get("diameter_mm") for group in groups):
        return fit
    asked = [angle for text in stored.values(fit.get("sweep", {}).get("config", ""), "lattice-angle") for angle in lists.numbers(text)]
    powers = {column["name"]: {"sigma": 1, "1/sigma^2": -2}.get(column["unit"], 0) for column in fit["columns"]}

    def scaled(group: Group) -> Group:
        lengths = {name: float(f"{group[name] * group['diameter_mm'] ** power:.10g}") for name, power in powers.items()
                   if power and isinstance(group[name], int | float)}
        nominal = {"lattice_angle": min(asked, key=lambda one: abs(one - group["lattice_angle"]))} if asked and group.get("lattice_angle") is not None else {}
        return group | {"in_table": group} | lengths | nominal

    groups = [scaled(group) for group in groups]
    columns = [column | ({"unit": column["unit"].replace("sigma", "mm")} if powers[column["name"]] else {}) for column in fit["columns"]]
    following = [name for name in powers if follows(groups, name, DROPLETS)]
    return fit | {"groups": groups, "columns": [*droplet_columns().values(), *columns], "in_mm": True, "following": following,
                  "lists": [*DROPLETS, *(name for name in fit["lists"] if name not in following)]}


def droplet_columns() -> dict[str, Column]:
    return {name: {"name": name, "kind": "number", "parameter_role": "physics", "shapes_array": False, **about} for name, about in DROPLETS.items()}


def fitted(clogfit: pathlib.Path, sweep: AnyPath, *options: object) -> tuple[dict[str, Any], dict[str, str]]:
    """The JSON output of clogfit for the present content of the file, and the result of stored.circle_files().
    @throws ProgramFailed  with clogfit's reason"""
    fit = run_clogfit(clogfit, sweep, *options)
    with stored.opened(sweep, folder=clogfit.parent) as file:
        return fit, stored.circle_files(file)
