"""What can go wrong and is not a mistake of this package."""


def lacking(error: ImportError) -> str:
    """What to say where a machine lacks a module."""
    return f"cannot start ({error}); it needs Debian's python3, /usr/bin/python3, with h5py, pandas, tables and matplotlib"


class UserError(Exception):
    """What the user can mend, in one line: what, why, remedy. Commands end with exit code 2."""


class NotThere(UserError):
    """Nothing was to be run, and what is asked for has not been run before."""


class ProgramFailed(Exception):
    """A program of ours said why in one line, and left with this exit code."""

    def __init__(self, message: str, exit_code: int) -> None:
        super().__init__(message)
        self.exit_code = exit_code


class Damaged(UserError):
    """A file that is not as it was written; the message names it."""
