"""What the laboratory says about a droplet between tilted plates, asked of `clogfit units`."""

import json
import math
import pathlib
from collections.abc import Mapping
from typing import Any

from ..results import laboratory
from ..tools.errors import ProgramFailed, UserError
from .profiles import Scales, fault_of

# What clogfit units needs, but a command may do without.
UNKNOWN = {"diameter": "1 mm", "angle": "90 deg"}


def quantities(given: Mapping[str, str | None], folder: pathlib.Path) -> dict[str, Any]:
    """The answer of clogfit units. @param given  quantities by the names of a lab file, None if unknown.
    @throws UserError  naming the option"""
    known = {name: text for name, text in given.items() if text is not None}
    try:
        return laboratory.units(UNKNOWN | known, folder=folder)
    except ProgramFailed as failure:
        for name, text in known.items():
            if f"invalid {name}={text} (" in str(failure):
                raise UserError(f"invalid --{name}={text} ({fault_of(failure)})") from failure
        if "density and outer-density are equal" in str(failure):
            raise UserError("--density and --outer-density are equal: nothing drives the droplet") from failure
        raise


def scales(given: Mapping[str, str | None], answer: Mapping[str, Any]) -> Scales:
    """What columns in laboratory units are divided by."""
    return Scales(answer["diameter_mm"] * 1e-3 if given.get("diameter") else 0, answer["speed_mm_per_s"] * 1e-3 if given.get("speed") else 0)


def version_of(answer: Mapping[str, Any]) -> dict[str, str]:
    return {name: answer[name] for name in ("version", "git_describe")}


def print_json(document: Mapping[str, Any]) -> None:
    """NaN and infinity become null."""
    def known(value: Any) -> Any:
        if isinstance(value, dict):
            return {name: known(part) for name, part in value.items()}
        if isinstance(value, list):
            return [known(part) for part in value]
        return None if isinstance(value, float) and not math.isfinite(value) else value

    print(json.dumps(known(dict(document)), indent=2, ensure_ascii=False))
