"""What clogfit says of a sweep."""

import json
import pathlib
from typing import Any

from ..tools.hints import AnyPath
from . import programs, stored


def fitted(clogfit: pathlib.Path, sweep: AnyPath, *options: object) -> tuple[dict[str, Any], dict[str, str]]:
    """What it says now, and stored.circle_files(). @throws ProgramFailed  with its reason"""
    told = json.loads(programs.run_program(clogfit, sweep, "--format", "json", *options))
    with stored.opened(sweep, folder=clogfit.parent) as file:
        return told, stored.circle_files(file)
