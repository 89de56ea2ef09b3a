"""Checks arguments of Python functions. The messages are those of the commands."""

import operator
from collections.abc import Collection
from typing import Any

from .errors import UserError


def whole(name: str, value: Any, least: int) -> None:
    """Checks a number. @throws UserError  if the value is not a whole number, or is smaller than `least`"""
    try:
        is_right = operator.index(value) >= least
    except TypeError:
        is_right = False
    if not is_right:
        raise UserError(f"invalid {name}: {value} (must be a whole number, {least} or more)")


def one_of(name: str, value: object, choices: Collection[object]) -> None:
    """Checks a choice. @throws UserError  unless the value is one of the choices"""
    if value not in choices:
        raise UserError(f"invalid {name}: {value} (must be {' or '.join(map(str, choices))})")
