"""Draws predicted clogging lengths against the line tension, beside measured lengths. Pairs of obstacles, single
obstacles, and both together have a line each."""

import math
from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure

from .. import style
from ..collisions.prediction import Prediction
from ..labels import AXES, runs_a_point
from ..tools.hints import Group
from .lengths import draw_lengths, length_notes

BLACK = style.COLOURS.index("#000000")  # The other colours belong to mechanisms.


def draw(found: Sequence[Prediction], measured: Sequence[Group], confidence: float, shared: Sequence[str]) -> Figure:
    """Draws the predictions. @param measured  groups of a sweep in the same array; @param shared  phrases of the
    caption"""
    figure, axes = style.subplots(figsize=(6.8, 5.0))
    tensions = [one.tension for one in found]
    colours = style.MECHANISM_COLOURS
    for label, name, look in (("both", "length", {"color": "0.8", "linewidth": 5}),
                              ("squeezed, by two obstacles", "squeezed", {"color": colours["squeezed"]}),
                              ("wrapped, by one obstacle", "wrapped", {"color": colours["wrapped"]})):
        # If only one of the two lengths is finite, `length` equals this one, so the line for both is not drawn.
        known = [math.isfinite(max(one.squeezed, one.wrapped) if name == "length" else getattr(one, name))
                 for one in found]
        if any(known):
            axes.plot(tensions, np.where(known, [getattr(one, name) for one in found], np.nan), marker=".",
                      label=f"predicted: {label}", **look)
    style.logarithmic_abscissa(axes, [*tensions, *(group["line_tension"] for group in measured)])
    if measured:
        draw_lengths(axes, [group["line_tension"] for group in measured], measured, BLACK, "measured", linestyle="none")
    style.logarithmic_ordinate(axes)
    axes.set_xlabel(AXES["line_tension"])
    notes = length_notes(measured, confidence, [axes]) if measured else []
    style.finish(axes, AXES["length"], ", ".join([*shared, *([runs_a_point(measured)] if measured else [])]),
                 [*notes, "no line: no obstacle and no pair holds the droplet"])
    return figure
