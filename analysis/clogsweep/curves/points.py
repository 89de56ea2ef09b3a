"""Decides which groups of clogfit's table belong to a curve, and why others do not.

Groups with different physical parameters belong to different curves. A numerical parameter, such as `inertia` or `box`,
usually does not separate curves, because some parameter sets need another box or more time than others. A numerical
parameter separates curves only if the sweep varies this parameter while the physics stays the same. Values that follow
from other parameters never separate curves: automatic values, the name of the preset, and the density of a saturated
array.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Collection, Iterable, Sequence
from typing import Any

import numpy as np

from ..reading import stored
from ..tools.errors import UserError
from ..tools.hints import Column, Group, Numbers, Records
from ..tools.texts import did_you_mean

# A curve needs at least this many values of the key. With two or three values its shape would come from the prior.
FEWEST_VALUES = 4
FEWEST_CLOGGING = 3  # At least this many of these values need clogs. Lower bounds alone do not determine a shape.
MOST_KEYS = 2
# Densities, in units of the saturated density, are equal if they agree to this number of significant digits.
SAME_SHARE = 6

Fit = dict[str, Any]  # clogfit's JSON


@dataclasses.dataclass(frozen=True)
class Members:
    """The groups of one curve, as their indices in clogfit's table, in the order of the keys' values."""

    shared: dict[str, Any]  # parameters that distinguish this curve from the others
    groups: list[int]


@dataclasses.dataclass(frozen=True)
class Excluded:
    group: int
    reason: str


def place_of(group: Group, keys: Iterable[Column]) -> list[float]:
    """The logarithms of the keys."""
    return [math.log(group[key["name"]]) for key in keys]


def is_automatic(fit: Fit, column: Column, group: Group) -> bool:
    """Whether the parameter's value follows from other parameters. The user chose values that are in a list of the
    sweep, so they do not follow from others."""
    name = column["name"]
    return name not in fit["lists"] and (name in group["automatic"] or name in fit.get("following", ()))


def may_be_key(fit: Fit, column: Column) -> bool:
    """Whether the parameter can be a key of curves: a number that affects the physics and that the user chose. A number
    that follows from other parameters cannot be a key."""
    return column.get("parameter_role") == "physics" and column["kind"] != "word" and all(
        group[column["name"]] is not None and not is_automatic(fit, column, group) for group in fit["groups"])


def find_keys(fit: Fit, names: Sequence[str] = ()) -> list[Column]:
    """The columns of the keys with these names. If `names` is empty, the column of the only physical parameter that
    varies.
    @throws UserError  if a name is not the name of a possible key, or if values do not vary or have no logarithm; also
    if `names` is empty and several parameters vary, or none"""
    groups: list[Group] = fit["groups"]
    possible = {column["key"].replace("-", "_"): column for column in fit["columns"] if may_be_key(fit, column)}
    if names:
        keys = [possible.get(name.replace("-", "_")) or refuse_key(name, fit) for name in names]
        if len(keys) > MOST_KEYS or (len(keys) == MOST_KEYS and keys[0] is keys[1]):
            raise UserError(f"invalid --key={','.join(names)} (a curve is drawn over one key, or over two different ones)")
    else:
        keys = [column for column in possible.values() if len({group[column["name"]] for group in groups}) > 1]
        if not keys:
            raise UserError("cannot fit a curve (no number of the physics has several values); give the sweep a list")
        if len(keys) > 1:
            varied = ", ".join(key["key"] for key in keys)
            enough = [key["key"] for key in keys if min(group[key["name"]] for group in groups) > 0 and split(fit, [key])[0]]
            if not enough:
                raise UserError(f"cannot fit a curve (several keys vary, {varied}, and none has enough values while the others are the same); "
                                f"give the sweep {FEWEST_VALUES} values of one of them, with clogs at {FEWEST_CLOGGING}")
            raise UserError(f"no --key is given, and several vary ({varied}); try --key {enough[0]}")
    for key in keys:
        values = {group[key["name"]] for group in groups}
        if len(values) < 2:
            raise UserError(f"invalid --key={key['key']} (all runs have the same value of it)")
        if not min(values) > 0:
            raise UserError(f"cannot fit a curve over {key['key']} (it has the value {min(values):g}, of which there is no logarithm)")
    return keys


def refuse_key(name: str, fit: Fit) -> Column:
    """Refuses a name over which no curve can be drawn. @throws UserError  which suggests a key with a similar name, if
    there is one"""
    known = [column["key"] for column in fit["columns"] if "key" in column]
    hint = did_you_mean(name.replace("_", "-"), known)
    if name.replace("_", "-") not in known and hint:
        raise UserError(f"unknown key: {name}{hint}")
    raise UserError(f"invalid --key={name} (is not a number of the physics that the sweep gives)")


def are_shares(groups: Iterable[Group]) -> bool:
    """Whether the sweep varies the density of random arrays as a share of the saturated density. One share gives a
    different density for each gap and diameter, so a sweep of shares has fewer shares than densities."""
    given = [group for group in groups if group["obstacle_filling"] == "density"]
    return len({_share(group) for group in given}) < len({_rounded(group["obstacle_density"]) for group in given})


def _share(group: Group) -> float | None:
    return None if group.get("share_of_saturated") is None else _rounded(group["share_of_saturated"])


def _rounded(density: float) -> float:
    return float(f"{density:.{SAME_SHARE}g}")


def physics_of(fit: Fit, group: Group, keys: Collection[Column], with_share: bool) -> dict[str, Any]:
    """The values of the physical parameters, except for the keys and for parameters that follow from others.
    @param with_share  whether the density of a random array is given as its share of the saturated density"""
    values = {column["name"]: group[column["name"]] for column in fit["columns"]
              if column not in keys and column["name"] != "preset" and column.get("parameter_role", "physics") == "physics"
              and not is_automatic(fit, column, group)}
    if group["obstacle_filling"] != "density":
        values.pop("obstacle_density", None)  # The density follows from gap and diameter.
    elif with_share:
        del values["obstacle_density"]
        values["share_of_saturated"] = _share(group)
    return values


def numerics_of(fit: Fit, group: Group) -> dict[str, Any]:
    return {column["name"]: group[column["name"]] for column in fit["columns"]
            if column.get("parameter_role") == "numerics" and not is_automatic(fit, column, group)}


def _key(values: dict[str, Any]) -> tuple[tuple[str, Any], ...]:
    return tuple(values.items())


def crossed_numerics(fit: Fit, groups: Iterable[int], keys: Collection[Column]) -> set[str]:
    """Names of numerical parameters that vary among groups with the same physics and the same values of the keys."""
    seen: dict[tuple[Any, ...], dict[str, set[Any]]] = {}
    with_share = are_shares(fit["groups"])
    for index in groups:
        group = fit["groups"][index]
        values = seen.setdefault((_key(physics_of(fit, group, keys, with_share)), *place_of(group, keys)), {})
        for name, value in numerics_of(fit, group).items():
            values.setdefault(name, set()).add(value)
    return {name for values in seen.values() for name, several in values.items() if len(several) > 1}


def why_too_few(fit: Fit, members: Members, keys: Sequence[Column]) -> str:
    """The reason why these groups are too few for a curve. The text is empty if they are enough."""
    groups = [fit["groups"][index] for index in members.groups]
    names = " and ".join(key["key"] for key in keys)
    shared = [parameter_text(name.replace("_", "-"), value) for name, value in members.shared.items()]
    where = " with " + ", ".join(shared) if shared else ""
    places = {tuple(place_of(group, keys)) for group in groups}
    clogging = {tuple(place_of(group, keys)) for group in groups if group["clogs"] > 0}
    if len(places) < FEWEST_VALUES:
        number = f"only {len(places)} values" if len(places) > 1 else "only one value"
        return f"{number} of {names}{where}, a curve needs {FEWEST_VALUES}"
    if any(len({place[i] for place in places}) < 2 for i in range(len(keys))):
        return f"only one value of a key{where}, a curve needs several of each"
    if len(clogging) < FEWEST_CLOGGING:
        return f"clogs at only {len(clogging)} of the values of {names}{where}, a curve needs them at {FEWEST_CLOGGING}"
    return ""


def value_text(value: Any) -> str:
    return f"{value:.4g}" if isinstance(value, float) else str(value)


def parameter_text(name: str, value: Any) -> str:
    """A parameter and its value."""
    return f"no {name}" if value is None else f"{name}={value_text(value)}"


def split(fit: Fit, keys: Sequence[Column]) -> tuple[list[Members], list[Excluded]]:
    """The groups of each curve that can be drawn. All other groups come with the reason why they belong to no curve.
    `shared` contains the parameters in which the curves differ; parameters that are equal in all curves are
    excluded."""
    excluded, useful = [], []
    for index, group in enumerate(fit["groups"]):
        if not (group["total_distance"] or 0) > 0:
            excluded.append(Excluded(index, "no run of it has covered any distance"))
        elif group["exit"]:
            # In a short device only few places hold droplets, so clogs at one value of the key say nothing about
            # lengths at other values.
            excluded.append(Excluded(index, "the array ends at an exit, so its clogs are not at random places"))
        else:
            useful.append(index)
    crossed = crossed_numerics(fit, useful, keys)
    with_share = are_shares(fit["groups"])
    sets: dict[tuple[Any, ...], Members] = {}
    for index in useful:
        group = fit["groups"][index]
        shared = physics_of(fit, group, keys, with_share) | {name: value for name, value in numerics_of(fit, group).items() if name in crossed}
        sets.setdefault(_key(shared), Members(shared, [])).groups.append(index)
    differ = {name for members in sets.values() for name in members.shared
              if len({str(other.shared.get(name)) for other in sets.values()}) > 1}
    curves = []
    for members in sets.values():
        members.groups.sort(key=lambda index: place_of(fit["groups"][index], keys)[::-1])
        shown = Members({name: value for name, value in members.shared.items() if name in differ}, members.groups)
        if reason := why_too_few(fit, shown, keys):
            excluded += [Excluded(index, reason) for index in shown.groups]
        else:
            curves.append(shown)
    curves.sort(key=lambda members: [(value is None, isinstance(value, str), value) for value in members.shared.values()])
    return curves, sorted(excluded, key=lambda one: one.group)


def grid_over(places: Numbers) -> Numbers:
    """Places between the outermost values, evenly spaced on a logarithmic scale. For one key there are 97 places, so
    over two decades a step is 5 %. For two keys there are 25 x 25 places."""
    low, high = places.min(axis=0), places.max(axis=0)
    share = np.linspace(0, 1, 97 if len(low) == 1 else 25)
    axes = [(1 - share) * first + share * last for first, last in zip(low, high)]
    return np.stack(np.meshgrid(*axes), axis=-1).reshape(-1, len(low))


def seeds_of_groups(fit: Fit, rows: Records) -> list[set[int]]:
    """The seeds of the runs of each group. @param rows  from all files of the sweep"""
    names = [column["name"] for column in fit["columns"] if len({str(group[column["name"]]) for group in fit["groups"]}) > 1]

    def is_of(group: Group) -> Any:
        matches = np.ones(len(rows), dtype=bool)
        for name in set(names) & set(stored.columns_of(rows)):
            if isinstance(group[name], str):
                matches &= rows[name] == group[name].encode()
            elif group[name] is not None:
                matches &= rows[name] == group[name]
        return matches

    return [set(rows["seed"][is_of(group)].tolist()) for group in fit["groups"]]


def have_common_obstacles(members: Members, keys: Iterable[Column], seeds: Sequence[set[int]]) -> bool:
    """Whether the points of a curve share obstacles: if they share seeds, and no key shapes the array."""
    if any(key["shapes_array"] for key in keys):
        return False
    own = [seeds[index] for index in members.groups]
    return sum(map(len, own)) > len(set().union(*own))
