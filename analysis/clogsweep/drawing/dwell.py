"""Draws the clogging length against the waiting time after which a resting droplet counts as clogged."""

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from .. import style
from ..labels import LABORATORY
from ..labels.groups import Groups
from ..tools.errors import UserError
from .lengths import add_scale, draw_lengths, finish_lengths

NUM_TIMES = 12


def times_of(groups: Groups) -> list[float]:
    """Waiting times for all groups, evenly spaced on a logarithmic scale. @throws UserError  if no waiting time is
    possible"""
    known = [group["dwells_known_from"] for group in groups.members]
    if None in known:
        raise UserError("cannot draw dwells (the file holds rows of a version that did not look for them); "
                        "compute the sweep anew, into another file")
    first, last = max(known), max(groups.values("max_time"))
    if not 0 < first < last:
        raise UserError(f"cannot draw dwells (they are known from {first:.4g} t0 on, and no run is longer); "
                        "make max-time longer")
    # clogfit refuses a first time that is rounded down, so both ends must be exact.
    return [first, *np.geomspace(first, last, NUM_TIMES)[1:-1].tolist(), last]


def draw(times: Sequence[float], fits: Sequence[Groups]) -> Figure:
    """Draws a curve for each group of the sweep. @param fits  the groups, fitted with each of these times"""
    figure, axes = style.subplots(figsize=(6.4, 4.8))
    curves = list(zip(*(groups.members for groups in fits)))
    for index, members in enumerate(curves):
        places = [time * style.side_by_side(index, len(curves), times) for time in times]
        label = fits[-1].label_of(members[-1])
        with style.curve(axes, label):
            draw_lengths(axes, places, members, index, label, unit="_mm" if fits[-1].are_in_mm else "")
    style.logarithmic_abscissa(axes, times)
    axes.xaxis.set_major_formatter(lambda time, _: f"{time:.3g}" if time < 1000 else f"{time:.0f}")
    lengths = fits[-1].values("dwell_length")
    moved = f"{lengths.pop():g}" + r"\,\sigma" if len(lengths) == 1 else r"\delta_\mathrm{d}"
    axes.set_xlabel(f"time without having moved by ${moved}$ that counts as clogged $/t_0$")
    everyone = [group for groups in fits for group in groups.members]
    finish_lengths(axes, fits[-1], everyone, "most droplets moved on later, or other clogs")
    add_laboratory(axes, fits[-1])
    return figure


def add_laboratory(axes: Axes, groups: Groups) -> None:
    """Adds scales in millimetres and seconds, if the sweep or clogfit knows the laboratory."""
    lab = groups.laboratory
    if length := lab.get("length_mm"):
        add_scale(axes, "right", length, LABORATORY["length"])
    speeds = groups.values("terminal_speed")
    if length and (speed := lab.get("speed_mm_per_s")) and len(speeds) == 1:
        # Motion is overdamped, so all times are proportional to the inverse terminal speed.
        add_scale(axes, "top", speeds.pop() * length / speed, LABORATORY["time"])
