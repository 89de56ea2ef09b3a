"""Checks arguments of the module, with the same messages as the commands."""

import operator
from collections.abc import Collection
from typing import Any

from .errors import UserError


def whole(name: str, value: Any, least: int) -> None:
    """@throws UserError  unless the value is a whole number, not smaller than `least`"""
    try:
        is_right = operator.index(value) >= least
    except TypeError:
        is_right = False
    if not is_right:
        raise UserError(f"invalid {name}: {value} (must be a whole number, {least} or more)")


def one_of(name: str, value: object, choices: Collection[object]) -> None:
    """@throws UserError  unless it is one of them"""
    if value not in choices:
        raise UserError(f"invalid {name}: {value} (must be {' or '.join(map(str, choices))})")
