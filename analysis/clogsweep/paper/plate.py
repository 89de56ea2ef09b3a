"""A finished figure, and the list of all that there are."""

import dataclasses
from collections.abc import Callable

CATALOGUE = {}
# Presets of the interface, in words; docs/explanation/model.md says what is behind them.
INTERFACES = {
    "robust": "robust, weight on the liquid",
    "heavy-interface": "heavy-interface, weight on the interface",
    "elastic": "elastic, weight on the interface, which stretches",
    "literal": "literal, as published",
}


def interface_of(preset):
    return INTERFACES.get(preset, preset)


@dataclasses.dataclass
class Plate:
    """A drawn figure with the numbers in it: one dictionary for each row of the table beside the picture."""

    figure: object
    data: list


@dataclasses.dataclass(frozen=True)
class Entry:
    name: str
    caption: str
    configs: tuple
    cost: str
    draw: Callable


def figure(name, caption, configs, cost):
    """Enters a function Workshop -> Plate into the catalogue. @param cost  time of the reduced size on two cores"""

    def enter(draw):
        CATALOGUE[name] = Entry(name, caption, tuple(configs), cost, draw)
        return draw

    return enter
