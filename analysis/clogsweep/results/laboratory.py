"""Converts between the quantities of a laboratory and the numbers of the model."""

from __future__ import annotations

import json
import os
import pathlib
import tempfile
from collections.abc import Mapping, Sequence
from typing import Any

from ..reading import programs
from ..tools.errors import UserError

OneOrMore = float | Sequence[float] | None


def units(lab: str | os.PathLike[str] | Mapping[str, str], *, length: OneOrMore = None, time: OneOrMore = None,
          line_tension: OneOrMore = None, terminal_speed: OneOrMore = None, wall_stiffness: OneOrMore = None,
          folder: str | os.PathLike[str] | None = None) -> dict[str, Any]:
    """The answer of `clogfit units`, with numbers. For a file of several droplets it is a list of answers.

    @param lab  a file, or its lines, such as {"diameter": "3.5 mm", "angle": "28 deg", "tension": "9.6 mN/m", "speed":
    "7 mm/s"}
    @param length, time, line_tension, terminal_speed, wall_stiffness  quantities of the model to convert; "given" of
    the answer has a number for each, or a list of numbers for a list
    @param folder  of the programs
    @throws UserError  for entries that `lab` cannot have; ProgramFailed
    """
    import numpy as np

    numbers = {"--length": length, "--time": time, "--line-tension": line_tension,
               "--terminal-speed": terminal_speed, "--wall-stiffness": wall_stiffness}
    options = [word for name, value in numbers.items() if value is not None
               for word in (name, ",".join(repr(float(one)) for one in np.atleast_1d(value)))]
    clogfit = programs.programs_in(folder) / "clogfit"
    if not isinstance(lab, Mapping):
        return json.loads(programs.run_program(clogfit, "units", os.fspath(lab), *options, "--format", "json"))
    if any("\n" in f"{key}{value}" for key, value in lab.items()):
        raise UserError("invalid laboratory (a line break in a key or a value); give one quantity for each key")
    with tempfile.TemporaryDirectory(prefix="clogsweep-units-") as place:
        file = pathlib.Path(place) / "lab.cfg"
        file.write_text("".join(f"{key} = {value}\n" for key, value in lab.items()), encoding="utf-8")
        return units(file, length=length, time=time, line_tension=line_tension, terminal_speed=terminal_speed,
                     wall_stiffness=wall_stiffness, folder=folder)
