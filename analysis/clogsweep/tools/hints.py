"""Names of types that occur often in signatures."""

import os
from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

# Public functions do not use this name, so that help() shows the types themselves. Modules that must load without
# `numpy` do not use it, either.
AnyPath = str | os.PathLike[str]

Column = dict[str, Any]  # A parameter as clogsweep describes it, with its name, symbol, unit and default.
Group = dict[str, Any]  # A group in clogfit's JSON, with the common parameters of its runs and their results.
Numbers = npt.NDArray[np.float64]
Point = Sequence[float] | Numbers  # x and y.
Records = npt.NDArray[np.void]  # Rows of a table with named columns.
