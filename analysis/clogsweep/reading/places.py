"""Where the programs and what belongs to them are."""

import pathlib

PACKAGE = pathlib.Path(__file__).resolve().parents[1]

try:
    from .._installed import JOBS_FOLDER, PROGRAMS_FOLDER  # relative to this package; cmake --install writes it
except ImportError:  # the source tree
    _SOURCE = PACKAGE.parents[1]
    JOBS = _SOURCE / "jobs"
    PROGRAMS = [_SOURCE / "build" / preset / "bin" for preset in ("release", "laptop")]
else:
    JOBS = (PACKAGE / JOBS_FOLDER).resolve()
    PROGRAMS = [(PACKAGE / PROGRAMS_FOLDER).resolve()]
