"""Loads the libraries that read drawings, when they are first needed."""

from __future__ import annotations

import importlib
from typing import Any

from ..tools.errors import UserError


def library(name: str, package: str) -> Any:
    """Imports a library. @throws UserError  that names the Debian package if the library is missing"""
    try:
        return importlib.import_module(name)
    except ImportError as error:
        raise UserError(f"cannot read such a drawing ({error}); "
                        f"apt install {package}, and start /usr/bin/python3") from error
