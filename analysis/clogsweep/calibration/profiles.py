"""Reads measured and simulated passages through a channel, and speeds along a wall."""

import math
from typing import NamedTuple

import numpy as np

from ..reading import passages
from ..tools import tables
from ..tools.errors import UserError
from ..tools.hints import Numbers

FEWEST_FRAMES = 3
# A calibration to a simulated passage uses only frames within this distance from the orifice [sigma], because
# experiments have no frames farther away.
FARTHEST_FRAME = 1.5
FRAMES_PER_DIAMETER = 20
ROUNDING = 1e-9  # [sigma].
# The units that clogfit units knows. Unicode has two characters for micro.
METRES = {"m": 1.0, "cm": 1e-2, "mm": 1e-3, "um": 1e-6, "\u00b5m": 1e-6, "\u03bcm": 1e-6}


class Profile(NamedTuple):
    """A droplet in a channel, frame by frame. The arrays have equal length. The frames of a simulation are in the order
    of time."""

    h: Numbers  # Distance of the centre of mass from the orifice, positive downstream [sigma].
    speed: Numbers  # Along the flow [v_t].
    shape: Numbers  # A = perimeter^2/(4 pi area); NaN where unknown.


class ReducedUnits(NamedTuple):
    """Divisors that convert columns in laboratory units to reduced units [m, m/s]. A divisor is 0 if it is unknown."""

    diameter: float = 0
    speed: float = 0


class Channel(NamedTuple):
    """The conditions of a passage that do not belong to the droplet. Each field has the name of a column of the table
    of runs. The name of the key is the name of the column with hyphens in place of underscores."""

    orifice: float
    wedge_angle: float
    tip_radius: float
    terminal_speed: float


def factor(header: str, reduced: str, scale: float, option: str) -> float:
    """The factor that converts a column to reduced units. @param header  of the column, such as h [mm]; @param reduced
    the reduced unit: sigma or v_t"""
    unit = header.partition("[")[2].partition("]")[0].strip()
    if unit == reduced:
        return 1
    if not unit:
        raise UserError(f"a column has no unit; write {reduced} or a laboratory unit in brackets")
    known = {name + ("/s" if reduced == "v_t" else ""): size for name, size in METRES.items()}
    if unit not in known:
        raise UserError(f"unknown unit '{unit}' (known: {reduced}, {', '.join(known)})")
    if scale == 0:
        raise UserError(f"is in {unit} and needs {option}")
    return known[unit] / scale


def read_table(path: str, length: str, scales: ReducedUnits) -> Numbers:
    """Reads the columns `length`, v and A of a text file as spreadsheets write it (docs/how-to/own-obstacles.md), and
    converts them to reduced units.

    @return shape (3, lines). A is NaN where its cell is empty, and everywhere if the file has no column A.
    @throws UserError  that names file and line
    """
    found = []
    numbers = tables.Numbers()
    columns: dict[str, int] = {}
    for line_number, cells in tables.rows(path):
        try:
            if not columns:
                columns = tables.columns_of(cells)
                if not {length, "v"} <= columns.keys():
                    raise UserError(f"needs a header that names the columns {length} and v, e.g. "
                                    f"{length} [mm], v [mm/s]")
                factors = (factor(cells[columns[length]], "sigma", scales.diameter, "--diameter"),
                           factor(cells[columns["v"]], "v_t", scales.speed, "--speed"))
                continue
            if len(cells) <= max(columns[length], columns["v"]):
                raise UserError("has too few columns")
            shape = (cells + [""])[min(columns.get("A", len(cells)), len(cells))]
            found.append([numbers.read(cells[columns[length]], length) * factors[0],
                          numbers.read(cells[columns["v"]], "v") * factors[1],
                          numbers.read(shape, "A") if shape else math.nan])
        except UserError as error:
            raise UserError(f"{path} line {line_number}: {error}") from error
    numbers.check(path)
    return np.array(found).reshape(-1, 3).T


def read_run(path: str) -> tuple[Profile, np.void]:
    """Reads the samples and the row of a passage that clogrun wrote. @throws UserError; Damaged"""
    table, row = passages.read(path)
    return Profile(table["h"], table["speed_ratio"], table["shape_parameter"]), row


def at(profile: Profile, h: Numbers) -> Profile:
    """The profile at the places h, interpolated linearly. If the droplet reaches h several times, its first arrival
    counts. Values are NaN upstream of the start, and at places that the droplet never reaches."""
    first = profile.h >= np.maximum.accumulate(profile.h)
    ends = np.array([profile.h[0], profile.h.max()])
    # When h was converted to diameters, rounding may have moved the first or the last frame beyond the profile's end.
    near = np.where(np.abs(h - np.clip(h, *ends)) < ROUNDING, np.clip(h, *ends), h)
    return Profile(h, *(np.interp(near, profile.h[first], values[first], left=math.nan, right=math.nan)
                        for values in profile[1:]))


def read_profile(path: str, scales: ReducedUnits = ReducedUnits()) -> tuple[Profile, np.void | None]:
    """Reads a text file, or a file of clogrun channel. @return all its frames; the row, if clogrun wrote the file.
    @throws UserError; Damaged"""
    profile, row = read_run(path) if passages.is_hdf5(path) else (Profile(*read_table(path, "h", scales)), None)
    if len(profile.h) < FEWEST_FRAMES:
        raise UserError(f"{path} holds fewer than three frames; give a longer one")
    return profile, row


def read_trial(path: str, scales: ReducedUnits = ReducedUnits()) -> tuple[Profile, Channel | None]:
    """Reads a passage with which simulations are compared. @return the passage; its channel, if clogrun wrote the file.
    @throws UserError  also if the droplet did not pass; Damaged"""
    profile, row = read_profile(path, scales)
    if row is None:
        return profile, None
    if profile.h[-1] < min(float(row["end"]), FARTHEST_FRAME):
        raise UserError(f"cannot calibrate with {path} (its droplet was at h = {profile.h[-1]:.3g} when the run ended: "
                        "it clogged, or was stopped); give a droplet that passed")
    last = round(FARTHEST_FRAME * FRAMES_PER_DIAMETER)
    frames = at(profile, np.arange(-last, last + 1) / FRAMES_PER_DIAMETER)
    profile = Profile(*(values[np.isfinite(frames.speed)] for values in frames))
    return profile, Channel(*(float(row[name]) for name in Channel._fields))
