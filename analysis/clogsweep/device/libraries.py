"""Libraries that read drawings, loaded only when they are needed."""

from __future__ import annotations

import importlib
from typing import Any

from ..tools.errors import UserError


def library(name: str, package: str) -> Any:
    """@throws UserError  that names the package of Debian"""
    try:
        return importlib.import_module(name)
    except ImportError as error:
        raise UserError(f"cannot read such a drawing ({error}); apt install {package}, and start /usr/bin/python3") from error
