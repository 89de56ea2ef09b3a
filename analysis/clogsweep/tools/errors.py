"""Errors that are not bugs of this package."""

import sys


def lacking(error: ImportError) -> str:
    """The message for a missing module."""
    return f"cannot start ({error}); {sys.executable} needs h5py, pandas, SciPy, tables and matplotlib: install them, or use another python3"


class UserError(Exception):
    """An error that the user can fix, in one line: what, why, remedy. Commands end with exit code 2."""


class NotThere(UserError):
    """--draw-only was given, but the result has not been computed yet, or belongs to another run."""


class ProgramFailed(Exception):
    """A program of ours printed its error in one line, and ended with this exit code."""

    def __init__(self, message: str, exit_code: int) -> None:
        super().__init__(message)
        self.exit_code = exit_code


class Damaged(UserError):
    """A file whose content has changed since it was written. The message names the file."""
