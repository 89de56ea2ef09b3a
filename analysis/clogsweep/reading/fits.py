"""Calls clogfit and reads its answers."""

import json
import pathlib
from typing import Any

from ..tools.errors import ProgramFailed
from ..tools.hints import AnyPath
from . import programs, stored


NO_CURVE = 2  # exit code of clogfit, for what cannot be asked of a sweep


def fitted(clogfit: pathlib.Path, sweep: AnyPath, *options: object) -> tuple[dict[str, Any], dict[str, str]]:
    """clogfit's present answer, and stored.circle_files(). @throws ProgramFailed  with its reason"""
    told = json.loads(programs.run_program(clogfit, sweep, "--format", "json", *options))
    with stored.opened(sweep, folder=clogfit.parent) as file:
        return told, stored.circle_files(file)


def curves(clogfit: pathlib.Path, sweep: AnyPath, key: str, *options: str) -> dict[str, Any]:
    """clogfit's curves of lambda against a key, or against two with a comma between; if empty, against the only key that varies.
    @throws ProgramFailed  with its reason"""
    words = [f"--key={key}"] if key else []
    return json.loads(programs.run_program(clogfit, "curve", sweep, "--format", "json", *words, *options))


def curves_if_any(clogfit: pathlib.Path, sweep: AnyPath, key: str, *options: str) -> list[dict[str, Any]]:
    """The curves to draw: none against a key to which clogfit fits no curve, such as one with the value 0."""
    try:
        return curves(clogfit, sweep, key, *options)["curves"]
    except ProgramFailed as error:
        if error.exit_code != NO_CURVE:
            raise
        return []
