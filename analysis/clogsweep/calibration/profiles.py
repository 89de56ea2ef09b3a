"""Reads measured and simulated passages through a channel, and speeds along a wall."""

import functools
import math
import os
import pathlib
import re
import stat
from typing import NamedTuple

import numpy as np

from ..reading import passages
from ..results import laboratory
from ..tools.errors import ProgramFailed, UserError
from ..tools.hints import Numbers

FEWEST_FRAMES = 3
# A simulated passage that is calibrated is seen as by a camera, up to this distance from the orifice [sigma].
FARTHEST_FRAME = 1.5
FRAMES_PER_DIAMETER = 20


class Profile(NamedTuple):
    """A droplet in a channel, frame by frame; arrays of equal length. Of a simulation in the order of time."""

    h: Numbers  # of the centre of mass from the orifice, positive downstream [sigma]
    speed: Numbers  # along the flow [v_t]
    shape: Numbers  # A = perimeter^2/(4 pi area); NaN where unknown


class Scales(NamedTuple):
    """What columns in laboratory units are divided by, in SI units; 0 if it is not known."""

    diameter: float = 0
    speed: float = 0


class Channel(NamedTuple):
    """What a passage depends on besides the droplet. The names are those of keys, with underscores."""

    orifice: float
    wedge_angle: float
    tip_radius: float
    terminal_speed: float


class Trial(NamedTuple):
    """A measured passage."""

    file: str
    frames: Profile
    channel: Channel | None  # known for files of clogrun


def fault_of(failure: ProgramFailed) -> str:
    """What clogfit units found wrong with a quantity, without the name of the file and the key."""
    inner = re.search(r"invalid [a-z-]+=.*? \((.*)\)$", str(failure))
    return inner[1] if inner else str(failure)


@functools.cache
def si_factor(unit: str, quantity: str, folder: pathlib.Path | None) -> float:
    """@param quantity  length or speed. @throws UserError  naming the units that clogfit units knows"""
    key, name = {"length": ("diameter", "diameter_mm"), "speed": ("speed", "speed_mm_per_s")}[quantity]
    small = 1e-6  # so that clogfit units does not take a droplet of one metre for a mistake
    lab = {"diameter": "1 mm", "angle": "90 deg"} | {key: f"{small} {unit}"}
    try:
        return laboratory.units(lab, folder=folder)[name] * 1e-3 / small
    except ProgramFailed as failure:
        raise UserError(fault_of(failure)) from failure


def column_factor(unit: str, reduced: str, quantity: str, scale: float, folder: pathlib.Path | None) -> float:
    """What to multiply a column with. @param reduced  the unit that needs no scale"""
    if unit == reduced:
        return 1
    if not unit:
        raise UserError(f"a column has no unit; write {reduced} or a laboratory unit in brackets")
    in_si = si_factor(unit, quantity, folder)
    if scale == 0:
        raise UserError(f"is in {unit} and needs {'--diameter' if quantity == 'length' else '--speed'}")
    return in_si / scale


def read_text(path: str) -> str:
    try:
        mode = os.stat(path).st_mode
        if not stat.S_ISREG(mode) and not stat.S_ISFIFO(mode):
            raise UserError(f"cannot read {path} (a folder, device or socket, neither a file nor a pipe); give another name")
        return pathlib.Path(path).read_text(encoding="utf-8-sig", errors="replace")
    except FileNotFoundError as error:
        raise UserError(f"cannot read {path} (no such file); check the name") from error
    except OSError as error:
        raise UserError(f"cannot read {path} ({error.strerror}); check name and permissions") from error


def number(cells: list[str], index: int) -> float:
    if index >= len(cells):
        raise UserError("has too few columns")
    try:
        value = float(cells[index])
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise UserError(f"'{cells[index]}' is not a finite number")
    return value


def name_and_unit(cell: str) -> tuple[str, str]:
    """The header "h [mm]" is the name h and the unit mm."""
    name, _, unit = cell.partition("[")
    return name.strip(), unit.partition("]")[0].strip()


def find_columns(cells: list[str], length: str, scales: Scales, folder: pathlib.Path | None) -> dict[str, tuple[int, float]]:
    """Index and factor of the columns `length`, v and, if it is there, A."""
    found: dict[str, tuple[int, float]] = {}
    for index, (name, unit) in enumerate(map(name_and_unit, cells)):
        if name == length:
            found[name] = index, column_factor(unit, "sigma", "length", scales.diameter, folder)
        elif name == "v":
            found[name] = index, column_factor(unit, "v_t", "speed", scales.speed, folder)
        elif name == "A":
            found[name] = index, 1
    if not {length, "v"} <= found.keys():
        raise UserError(f"needs a header that names the columns {length} and v, e.g. {length} [mm], v [mm/s]")
    return found


def read_csv(path: str, length: str, scales: Scales, folder: pathlib.Path | None) -> Numbers:
    """Columns `length`, v and A in reduced units, shape (3, lines). An empty cell of A, or none, is NaN."""
    columns: dict[str, tuple[int, float]] = {}
    rows = []
    for line_number, line in enumerate(read_text(path).split("\n"), 1):
        if not line.strip() or line.startswith("#"):
            continue
        cells = [cell.strip() for cell in line.split(",")]
        try:
            if not columns:
                columns = find_columns(cells, length, scales, folder)
                continue
            values = [number(cells, columns[name][0]) * columns[name][1] for name in (length, "v")]
            index = columns.get("A", (len(cells),))[0]
            rows.append([*values, number(cells, index) if index < len(cells) and cells[index] else math.nan])
        except UserError as error:
            raise UserError(f"{path} line {line_number}: {error}") from error
    return np.array(rows).reshape(-1, 3).T


def read_run(path: str) -> tuple[Profile, Channel, float]:
    """Samples of a file of clogrun channel, its channel, and the h at which the run was to end."""
    table, row = passages.read(path)
    channel = Channel(*(float(row[name]) for name in Channel._fields))
    return Profile(table["h"], table["speed_ratio"], table["shape_parameter"]), channel, float(row["end"])


def at(profile: Profile, h: Numbers) -> Profile:
    """The droplet where it first comes to each h, interpolated linearly; NaN where it never comes."""
    if len(profile.h) < 2:
        return Profile(h, *np.full((2, len(h)), math.nan))
    comes = (profile.h[:-1] <= h[:, None]) & (h[:, None] <= profile.h[1:])
    first = comes.argmax(axis=1)
    length = profile.h[first + 1] - profile.h[first]
    share = np.divide(h - profile.h[first], length, out=np.zeros(len(h)), where=length > 0)
    share[~comes.any(axis=1)] = math.nan
    return Profile(h, *(values[first] + share * (values[first + 1] - values[first]) for values in profile[1:]))


def require_frames(path: str, profile: Profile) -> Profile:
    if len(profile.h) < FEWEST_FRAMES:
        raise UserError(f"{path} holds fewer than three frames; give a longer one")
    return profile


def read_profile(path: str, scales: Scales = Scales(), folder: pathlib.Path | None = None) -> Profile:
    """Every frame of a CSV file, or every sample of a file of clogrun channel."""
    profile = read_run(path)[0] if passages.is_hdf5(path) else Profile(*read_csv(path, "h", scales, folder))
    return require_frames(path, profile)


def read_trial(path: str, scales: Scales = Scales(), folder: pathlib.Path | None = None) -> Trial:
    """A passage to compare simulations with. @throws UserError  naming file and line; also for a droplet that did not pass"""
    if not passages.is_hdf5(path):
        return Trial(path, require_frames(path, Profile(*read_csv(path, "h", scales, folder))), None)
    passage, channel, end = read_run(path)
    reached = passage.h[-1] if len(passage.h) else 0
    if reached < min(end, FARTHEST_FRAME):
        raise UserError(f"cannot calibrate with {path} (its droplet was at h = {reached:.3g} when the run ended: it clogged, or was stopped); "
                        "give a droplet that passed")
    last = round(FARTHEST_FRAME * FRAMES_PER_DIAMETER)
    frames = at(passage, np.arange(-last, last + 1) / FRAMES_PER_DIAMETER)
    seen = np.isfinite(frames.speed)
    return Trial(path, require_frames(path, Profile(*(values[seen] for values in frames))), channel)
