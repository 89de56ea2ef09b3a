"""Names for frequent types in signatures."""

import os
from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

# Public functions write this type out, for help(), and so do modules that must load without `numpy`.
AnyPath = str | os.PathLike[str]

Column = dict[str, Any]  # a parameter as clogsweep describes it: its name, symbol, unit, default
Group = dict[str, Any]  # a group of clogfit's JSON: parameters that its runs have in common, and their results
Numbers = npt.NDArray[np.float64]
Point = Sequence[float] | Numbers  # x and y
Records = npt.NDArray[np.void]  # rows of a table, whose columns have names
