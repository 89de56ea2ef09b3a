"""Gives Python the results of clogsweep as tables, fits, curves, pictures of clogs, and films::

    import clogsweep
    sweep = clogsweep.open("sweep.h5")
    sweep.rows                # pandas: a row for each run
    sweep.fit().groups        # clogging lengths, from clogfit
    sweep.fit().curve()       # draws itself in a notebook
    clogsweep.units("lab.cfg")  # what the model's units are in a laboratory

The C++ programs run the simulations and fit the clogging lengths.
"""

from __future__ import annotations

import importlib
import os

# A type checker assumes that TYPE_CHECKING is true. Importing it from `typing` would take longer than importing this
# module.
TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import Any

    from .drawing.clogs import Clog, Clogs
    from .results.fit import Fit
    from .results.laboratory import units
    from .results.run import Film, Run
    from .results.sweep import Sweep
    from .style import Picture
    from .tools.errors import Damaged, ProgramFailed, UserError

__version__ = "1.1.0"

__all__ = ["Clog", "Clogs", "Damaged", "Film", "Fit", "Picture", "ProgramFailed", "Run", "Sweep", "UserError", "open", "units"]

_MODULES = {"Clog": "drawing.clogs", "Clogs": "drawing.clogs", "Damaged": "tools.errors", "Film": "results.run", "Fit": "results.fit",
            "Picture": "style", "ProgramFailed": "tools.errors", "Run": "results.run", "Sweep": "results.sweep", "UserError": "tools.errors",
            "units": "results.laboratory"}


def __getattr__(name: str) -> Any:
    """Loads a name, and the libraries that it needs, on first use."""
    if name not in _MODULES:
        raise AttributeError(f"module {__name__} has no attribute {name}")
    return getattr(_loaded(_MODULES[name]), name)


def _loaded(module: str) -> Any:
    """Imports a module of this package.
    @throws ImportError  with a single line that names what is missing on this machine"""
    try:
        return importlib.import_module(f".{module}", __name__)
    except ImportError as error:
        from .tools import errors

        raise ImportError(errors.lacking(error)) from None


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})


def open(path: str | os.PathLike[str] | list[str | os.PathLike[str]], programs: str | os.PathLike[str] | None = None) -> Sweep | Run:
    """Opens a file of clogsweep or clogrun. Several files of clogsweep, given as a list, are read as one sweep, as
    `clogsweep merge` would join them.

    @param programs  folder of clogsweep, clogrun and clogfit, if they are not in the PATH or beside this module
    @throws UserError  for any other file; Damaged if the content has changed since the program wrote it
    @throws ImportError  if this python3 lacks a module
    """
    run, stored, sweep = (_loaded(module) for module in ("results.run", "reading.stored", "results.sweep"))
    if isinstance(path, list):
        return sweep.merged(path, programs)
    return run.Run(path) if stored.kind_of(path, programs) == stored.RUN else sweep.Sweep(path, programs)
