"""Converts the quantities of a laboratory's droplet between tilted plates to the model's units, by `clogfit units`."""

import json
import pathlib
import re
from collections.abc import Mapping
from typing import Any

from ..results import laboratory
from ..tools.errors import ProgramFailed, UserError
from .profiles import ReducedUnits

# Values of quantities that clogfit units requires, for commands that do not ask their user for these quantities.
UNKNOWN = {"diameter": "1 mm", "angle": "90 deg"}


def quantities(given: Mapping[str, str | None], folder: pathlib.Path) -> tuple[dict[str, Any], ReducedUnits]:
    """Asks clogfit units. @return its answer, and the divisors of columns in laboratory units

    @param given  quantities by their names in a lab file, None if unknown
    @throws UserError  that names the wrong option
    """
    known = {name: text for name, text in given.items() if text}
    try:
        answer = laboratory.units(UNKNOWN | known, folder=folder)
    except ProgramFailed as failure:
        reason = re.sub("^.*lab.cfg (invalid )?", lambda found: "invalid --" if found[1] else "", str(failure))
        raise UserError(reason) from failure
    return answer, ReducedUnits(answer["diameter_mm"] * 1e-3 if "diameter" in known else 0,
                                answer["speed_mm_per_s"] * 1e-3 if "speed" in known else 0)


def print_json(answer: Mapping[str, Any], document: Mapping[str, Any]) -> None:
    """Prints the document as JSON, with the version of the programs in front. NaN and infinity become null."""
    text = json.dumps({"version": answer["version"], "git_describe": answer["git_describe"], **document})
    print(json.dumps(json.loads(text, parse_constant=lambda _: None), indent=2))
