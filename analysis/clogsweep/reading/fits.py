"""Calls clogfit and reads its answers."""

import json
import pathlib
from typing import Any

from ..tools.hints import AnyPath
from . import programs, stored


def told(clogfit: pathlib.Path, *words: object) -> dict[str, Any]:
    """clogfit's answer for these sweeps and options. @throws ProgramFailed  with its reason"""
    return json.loads(programs.run_program(clogfit, *words, "--format", "json"))


def fitted(clogfit: pathlib.Path, sweep: AnyPath, *options: object) -> tuple[dict[str, Any], dict[str, str]]:
    """clogfit's present answer, and stored.circle_files(). @throws ProgramFailed  with its reason"""
    fit = told(clogfit, sweep, *options)
    with stored.opened(sweep, folder=clogfit.parent) as file:
        return fit, stored.circle_files(file)
