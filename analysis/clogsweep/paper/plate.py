"""A finished figure, and the list of all figures."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Iterable
from typing import Any

from matplotlib.figure import Figure

from .runner import Runner

CATALOGUE: dict[str, Entry] = {}


@dataclasses.dataclass
class Plate:
    """A drawn figure, and its numbers. Each dictionary is one row of the table that is written beside the picture."""

    figure: Figure
    data: list[dict[str, Any]]


Drawing = Callable[[Runner], Plate]


@dataclasses.dataclass(frozen=True)
class Entry:
    name: str
    caption: str
    configs: tuple[str, ...]
    cost: str
    draw: Drawing


def figure(name: str, caption: str, configs: Iterable[str], cost: str) -> Callable[[Drawing], Drawing]:
    """Adds a drawing function to the catalogue. @param cost  time that the figure takes in its reduced size on two
    cores"""

    def enter(draw: Drawing) -> Drawing:
        CATALOGUE[name] = Entry(name, caption, tuple(configs), cost, draw)
        return draw

    return enter
