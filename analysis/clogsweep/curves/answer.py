"""The curves of a sweep, as `clogfit curve --format json` prints them."""

from __future__ import annotations

import collections
import math
import pathlib
from collections.abc import Sequence
from typing import Any

import numpy as np

from ..reading import fits, stored
from ..tools.errors import UserError
from ..tools.hints import AnyPath, Column, Group, Numbers
from . import features, model, points

ALL = ("clogging_length", "clogging_length_lower", "clogging_length_upper")
# For each cause, the columns of clogfit. The key is the column with the number of runs that the cause ended. The value
# has the columns with the length and the two ends of its interval.
CAUSES = {cause: tuple(f"clogging_length_{cause}{end}" for end in ("", "_lower", "_upper")) for cause in ("wrapped", "squeezed", "hybrid", "other")}
CAUSES["broken"] = ("break_up_length", "break_up_length_lower", "break_up_length_upper")


def of_sweep(clogfit: pathlib.Path, paths: Sequence[AnyPath], keys: Sequence[str] = (), *options: object,
             crossing: Sequence[float] = ()) -> tuple[dict[str, Any], dict[str, Any]]:
    """The curves of one sweep, and the model's units in the laboratory if these are known. The sweep may consist of
    several files.
    @param keys  see points.find_keys()
    @param options  of clogfit
    @throws UserError; ProgramFailed with clogfit's reason"""
    fit = fits.run_clogfit(clogfit, *paths, *options)
    rows = [stored.read_rows(path, clogfit.parent) for path in paths]
    names = [name for name in stored.columns_of(rows[0]) if all(name in stored.columns_of(others) for others in rows)]
    together = np.concatenate([others[names] for others in rows])
    return of_fit(fit, points.seeds_of_groups(fit, together), keys, crossing), fit.get("laboratory") or {}


def of_fit(fit: points.Fit, seeds: Sequence[set[int]], names: Sequence[str] = (), crossing: Sequence[float] = ()) -> dict[str, Any]:
    """Fits the curves. @param fit  the JSON output of clogfit; @param seeds  seeds of the runs of each group. @throws
    UserError  if there is no curve"""
    fits.refuse_mixed({group["obstacle_filling"] for group in fit["groups"]}, "cannot fit a curve to droplets in {}")
    if any("status" in group for group in fit["groups"]):
        raise UserError("cannot fit a curve (droplets in a channel or on a wall have no clogging length)")
    fit = fits.in_millimetres(fit)
    unit = "mm" if "in_mm" in fit else "sigma"
    if unit == "mm":
        lengths = ("total_distance", *ALL, *(name for names in CAUSES.values() for name in names))
        fit = fit | {"groups": [group | {name: group[name] * group["diameter_mm"] for name in lengths if group.get(name) is not None} for group in fit["groups"]]}
    keys = points.find_keys(fit, names)
    if len(keys) > 1 and crossing:
        raise UserError("no place for --crossing (a surface over two keys crosses a length along lines); give one --key")
    curves, excluded = points.split(fit, keys)
    if not curves:
        reasons = "; ".join(dict.fromkeys(one.reason for one in excluded))
        raise UserError(f"cannot fit a curve over {', '.join(key['key'] for key in keys)} ({reasons})")
    return {
        "version": fit["version"],
        "git_describe": fit["git_describe"],
        "confidence": fit["confidence"],
        "doubts": fit.get("doubts", {}),
        "keys": [key["name"] for key in keys],
        "units": {"clogging_length": unit, "total_distance": unit} | {key["name"]: key["unit"] for key in keys if key["unit"]},
        "curves": [_curve(fit, members, keys, crossing) | {
            "common_obstacles": points.have_common_obstacles(members, keys, seeds)} for members in curves],
        "excluded": [{"group": one.group} | {key["name"]: fit["groups"][one.group][key["name"]] for key in keys} | {"reason": one.reason}
                     for one in excluded],
    }


def _finite(value: float) -> float | None:
    return float(value) if math.isfinite(value) else None


def _values(place: Numbers, keys: Sequence[Column], end: str = "") -> dict[str, float]:
    return {f"{key['name']}{end}": float(np.exp(x)) for key, x in zip(keys, place)}


def _point(index: int, group: Group, keys: Sequence[Column]) -> dict[str, Any]:
    return {"group": index} | {key["name"]: group[key["name"]] for key in keys} | {
        name: group[name] for name in ("runs", "clogs", "total_distance", *ALL)}


def _curve(fit: points.Fit, members: points.Members, keys: Sequence[Column], crossing: Sequence[float]) -> dict[str, Any]:
    groups = [fit["groups"][index] for index in members.groups]
    confidence = fit["confidence"]
    known = model.Points(np.array([points.place_of(group, keys) for group in groups]), _column(groups, "clogs"), _column(groups, "total_distance"))
    places = points.grid_over(known.places)
    fitted = model.fit_curve(known, places)
    whole = features.band(fitted, confidence)
    bands = {ALL: whole} | bands_by_cause(groups, known, places, confidence, whole)
    peak = features.find_peak(fitted, places, confidence)
    return {
        "shared": members.shared,
        "failed": sum(group.get("failed") or 0 for group in groups),
        "doubts": dict(collections.Counter(doubt for group in groups for doubt in (group.get("doubts") or "").split())),
        "points": [_point(index, group, keys) for index, group in zip(members.groups, groups)],
        "curve": [_values(place, keys) | {name: float(value) for names, band in bands.items() for name, value in zip(names, band[:, i])}
                  for i, place in enumerate(places)],
        "peak": _values(peak.place, keys) | _values(peak.place_lower, keys, "_lower") | _values(peak.place_upper, keys, "_upper") | dict(
            zip(ALL, (peak.length, peak.length_lower, peak.length_upper))) | {"probability_between_borders": peak.probability_inside},
        "crossings": [_crossing(one, length, keys[0]["name"]) for length in crossing
                      for one in features.find_crossings(fitted, places[:, 0], length, confidence)],
    }


def _column(groups: Sequence[Group], name: str) -> Numbers:
    return np.array([group[name] for group in groups], dtype=float)


def bands_by_cause(groups: Sequence[Group], known: model.Points, places: Numbers, confidence: float,
                   whole: Numbers) -> dict[tuple[str, ...], Numbers]:
    """The band of each cause by which some droplets clog. In the fit for one cause, clogs by the other causes count as
    censored. If the causes of some clogs are unknown, there are no bands.
    @param whole  the band of all clogs, which is returned for a cause to which all clogs belong"""
    if any(group[cause] is None for group in groups for cause in CAUSES):
        return {}
    counts = {names: _column(groups, cause) for cause, names in CAUSES.items() if any(group[cause] > 0 for group in groups)}
    return {names: whole if np.array_equal(clogs, known.clogs) else
            features.band(model.fit_curve(model.Points(known.places, clogs, known.distances), places), confidence)
            for names, clogs in counts.items()}


def _crossing(one: features.Crossing, length: float, name: str) -> dict[str, Any]:
    return {"clogging_length": length, name: float(np.exp(one.place)), f"{name}_lower": float(np.exp(one.lower)), f"{name}_upper": _finite(np.exp(one.upper)),
            "direction": "upwards" if one.is_upward else "downwards"}
