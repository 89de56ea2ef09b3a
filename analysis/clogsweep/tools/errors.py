"""Errors that do not come from bugs of this package."""

import sys


def lacking(error: ImportError) -> str:
    """The message for a missing module."""
    return f"cannot start ({error}); {sys.executable} needs h5py, pandas, SciPy, tables and matplotlib: install them, or use another python3"


class UserError(Exception):
    """An error that the user can fix. The message has one line, with what failed, why, and what to do. Commands end
    with exit code 2."""


class NotThere(UserError):
    """With --draw-only, a required result does not exist yet or belongs to another run."""


class ProgramFailed(Exception):
    """One of the C++ programs printed an error in one line, and ended with this exit code."""

    def __init__(self, message: str, exit_code: int) -> None:
        super().__init__(message)
        self.exit_code = exit_code


class Damaged(UserError):
    """The content of a file has changed since it was written. The message names the file."""
