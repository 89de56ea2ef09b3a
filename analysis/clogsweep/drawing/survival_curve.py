"""Draws P(r) of a group in clogfit's JSON: the probability that a droplet has not clogged within a distance r."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes

from .. import style
from ..labels import parameter_label
from ..labels.groups import Groups
from ..reading import fits
from ..tools.errors import UserError
from ..tools.hints import Group, Numbers
from ..tools.texts import literal
from . import lengths

Curve = tuple[str, Group]  # The label of a curve, and a group with distances in the unit of the picture.


def longest_way(group: Group) -> float:
    """The longest distance of any run, including runs that still moved at their end [sigma]."""
    return max([step["distance"] for step in group["survival"]] + group["censored_distances"])


def probability(group: Group, distances: Sequence[float] | Numbers) -> Numbers:
    """The estimate of P(r) at these distances."""
    steps = group["survival"]
    values = np.array([1.0] + [step["probability"] for step in steps])
    return values[np.searchsorted([step["distance"] for step in steps], distances, side="right")]


def draw(axes: Axes, group: Group, colour: str | Sequence[float], label: str, label_of_ticks: str | None = None,
         begin: float = 0.0) -> None:
    """Draws the estimate up to the longest distance. Each run that still moved at its end has a tick.
    @param begin  distance at which the curve begins [sigma]; clogs before it, upstream of the release, are not drawn"""
    clogs = [step["distance"] for step in group["survival"]]
    corners = [*(distance for distance in clogs if distance >= begin), longest_way(group)]
    first = 1.0 if not clogs or begin <= clogs[0] else probability(group, [begin])[0]
    axes.step([begin, *corners], [first, *probability(group, corners)], where="post", color=colour, linewidth=1.2,
              label=label, gid=style.mark("point", [group]))
    censored = group["censored_distances"]
    if censored:
        axes.plot(censored, probability(group, censored), linestyle="none", marker="|", markersize=9,
                  markeredgewidth=1.2, color=colour, label=label_of_ticks)


def scaled(group: Group, factor: float) -> Group:
    """The group with its distances multiplied by a factor."""
    steps = [step | {"distance": factor * step["distance"]} for step in group["survival"]]
    return group | {"survival": steps,
                    "censored_distances": [factor * distance for distance in group["censored_distances"]]}


def of_groups(groups: Groups) -> list[Curve]:
    """The curves of a sweep."""
    return [(groups.label_of(group), scaled(group, group["diameter_mm"] if groups.are_in_mm else 1))
            for group in groups.members if group["runs"]]


def of_table(answer: dict[str, Any]) -> list[Curve]:
    """The curves of measured distances. @param answer  the JSON output of clogfit lengths"""
    droplets = {column["key"]: column for column in fits.droplet_columns().values()}

    def words(label: str, value: Any) -> str:
        if label in droplets and value is not None:
            return parameter_label(droplets[label], value)
        return literal(f"{label} {value:g}" if isinstance(value, int | float) else f"{label} {value}")

    return [(", ".join(words(label, group[label]) for label in answer["labels"]), group) for group in answer["groups"]]


def of_mixture(answer: dict[str, Any], unit: str) -> Curve | None:
    """The curve of clogfit --mixture, if the JSON output of clogfit has one. @throws UserError  if its distances and
    those of the groups have different units"""
    mixture = answer.get("mixture")
    if mixture is None:
        return None
    if mixture["unit"] != unit:
        raise UserError(f"cannot draw a mixture in {mixture['unit']} beside groups in {unit} "
                        "(some have no laboratory); leave "
                        "them out with clogsweep select")
    shares = ", ".join(f"{value} ({100 * share:.4g} %)" for value, share in mixture["weights"].items())
    return literal(f"mixture of {mixture['column']} {shares}"), mixture


def draw_on(axes: Axes, curves: Sequence[Curve], unit: str, mixture: Curve | None = None) -> None:
    """Draws P(r) of each group up to the group's longest distance. Also draws P(r) of a mixture, with intervals. @param
    unit  of the distances: sigma or mm. @throws UserError  if no droplet has moved"""
    if not any(longest_way(group) > 0 for _, group in curves):
        raise UserError("cannot draw P(r) (no droplet has moved)")
    drawn = [*curves, mixture] if mixture else curves
    begin = min([0.0] + [step["distance"] for _, group in drawn for step in group["survival"]])
    for (label, group), colour in zip(curves, style.shades(len(curves))):
        with style.curve(axes, label):
            draw(axes, group, colour, label, begin=begin)
    if mixture:
        label, group = mixture
        limits = [(step["distance"], step["lower"], step["upper"]) for step in group["survival"]]
        known = [one for one in limits if one[1] is not None]
        with style.curve(axes, label):
            draw(axes, group, "black", label, begin=begin)
            if known:
                end = (longest_way(group), *known[-1][1:])
                axes.fill_between(*zip(*known, end), step="post", color="black", alpha=0.12, linewidth=0)
    axes.set_xlim(left=begin)
    axes.set_ylim(0, 1.02)
    style.label(axes, r"displacement along gravity $r/\sigma$" if unit == "sigma" else "displacement along gravity $r$ [mm]", "$P(r)$, not yet clogged")
    if any(label for label, _ in curves):
        style.legend(axes)
    style.notes(axes, ["steps: clogs; ticks: droplets that were last seen moving",
                       *lengths.failure_notes([group for _, group in curves], "curve")])
