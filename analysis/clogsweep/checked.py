"""Arguments of the module that cannot be, refused as the commands refuse theirs."""

from __future__ import annotations

from collections.abc import Collection

from .errors import UserError


def whole(name: str, value: object, least: int) -> None:
    """@throws UserError  unless it is a whole number that is not less"""
    if not hasattr(value, "__index__") or value.__index__() < least:
        raise UserError(f"invalid {name}: {value} (must be a whole number, {least} or more)")


def one_of(name: str, value: object, choices: Collection[object]) -> None:
    """@throws UserError  unless it is one of them"""
    if value not in choices:
        raise UserError(f"invalid {name}: {value} (must be {' or '.join(map(str, choices))})")
