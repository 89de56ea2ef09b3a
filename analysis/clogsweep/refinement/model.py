"""What a search needs of the fitted curve of log lambda over the logarithms of one or two keys."""

from collections.abc import Sequence
from typing import NamedTuple, Protocol

import numpy as np

from ..tools.hints import Numbers


class Points(NamedTuple):
    """Sums over the runs at each place that is known, one entry per place."""

    places: Numbers  # logarithms of the keys, shape (points, keys)
    clogs: Numbers
    distance: Numbers  # of all runs together [sigma]
    time: Numbers  # [t0]
    work: Numbers  # steps times points of the droplet's outline


class Curve(NamedTuple):
    """Normal distribution of log lambda at some places."""

    mean: Numbers
    covariance: Numbers

    @property
    def deviation(self) -> Numbers:
        return np.sqrt(np.maximum(np.diag(self.covariance), 0))


class Peak(NamedTuple):
    """Where the curve is highest, with 95 % intervals. Places are logarithms of each key; lengths are lambda [sigma]."""

    place: Numbers
    lower: Numbers
    upper: Numbers
    length: float
    lowest: float
    highest: float


class Crossing(NamedTuple):
    """Where the curve of one key crosses a length, with its 95 % interval (logarithms of the key)."""

    place: float
    lower: float
    upper: float


class Model(Protocol):
    """A curve and its features."""

    def fit(self, points: Points, places: Numbers) -> Curve: ...

    def peak(self, curve: Curve, places: Numbers) -> Peak: ...

    def peak_probabilities(self, curve: Curve) -> Numbers: ...

    def crossings(self, curve: Curve, places: Numbers, length: float) -> Sequence[Crossing]: ...
