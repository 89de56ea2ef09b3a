"""Shows how many ranks were busy during the sessions of a sweep, and how much time idle ranks lost."""

from __future__ import annotations

import json
from collections.abc import Sequence
from typing import Any

from matplotlib.axes import Axes

from .. import style
from ..tools import rounded

Session = dict[str, Any]
# Name of a unit of time, its length [s], and the largest time that is given in this unit [s].
UNITS = [("s", 1.0, 120.0), ("min", 60.0, 7200.0), ("h", 3600.0, float("inf"))]


def sessions_of(attributes: dict[str, str]) -> list[Session]:
    """The sessions in which a task of the sweep ran. Files of older programs have no sessions."""
    lines = attributes.get("activity", "").splitlines()
    return [session for session in map(json.loads, lines) if session["seconds"] > 0 and any(session["busy"])]


def draw_on(axes: Axes, sessions: Sequence[Session]) -> None:
    """Draws the sessions one after the other."""
    whole = sum(session["seconds"] for session in sessions)
    name, unit, _ = next(known for known in UNITS if whole <= known[2])
    begin = 0.0
    for index, session in enumerate(sessions):
        edges = [begin + min(i * session["stretch"], session["seconds"]) for i in range(len(session["busy"]) + 1)]
        axes.stairs(session["busy"], [edge / unit for edge in edges], fill=True, color=style.COLOURS[0], alpha=0.6,
                    linewidth=0)
        axes.plot([begin / unit, (begin + session["seconds"]) / unit], [session["ranks"]] * 2, color="0.4", linewidth=1,
                  linestyle="--", label="all ranks" if index == 0 else None)
        if index > 0:
            axes.axvline(begin / unit, color="0.4", linewidth=0.8, linestyle=":")
        begin += session["seconds"]
    axes.set_xlim(0, whole / unit)
    axes.set_ylim(0, 1.1 * max(session["ranks"] for session in sessions))
    without_pauses = ", without pauses" if len(sessions) > 1 else ""
    axes.set_xlabel(f"time since the sweep began{without_pauses} [{name}]")
    axes.set_ylabel("busy ranks")
    axes.yaxis.get_major_locator().set_params(integer=True)
    style.grid(axes)
    notes = ["dashed: all ranks that compute"]
    if len(sessions) > 1:
        notes.append("dotted: the sweep was stopped, and went on")
    style.notes(axes, ["; ".join(notes)])


def hours(seconds: float) -> str:
    return rounded.plain(seconds / 3600)


def lost(sessions: Sequence[Session]) -> str:
    """States the cost of idle ranks in a sentence."""
    whole = sum(session["ranks"] * session["seconds"] for session in sessions)
    idle, tail = (sum(session[name] for session in sessions) for name in ("idle_seconds", "tail_seconds"))
    return (f"Of {hours(whole)} core-hours {hours(idle)} ({100 * idle / whole:.2g} %) were lost to ranks without work, "
            f"{hours(tail)} ({100 * tail / whole:.2g} %) of them in the tail: "
            "after the last task had been handed out.")
