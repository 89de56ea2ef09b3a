"""Finds and runs the C++ programs."""

import argparse
import os
import pathlib
import shlex
import shutil
import subprocess
import sys

from ..tools.errors import ProgramFailed, UserError

PACKAGE = pathlib.Path(__file__).resolve().parents[1]

try:
    # Folders relative to this package. cmake --install writes the module `_installed`.
    from .._installed import JOBS_FOLDER, PROGRAMS_FOLDER
except ImportError:
    if (PACKAGE / "jobs").is_dir():  # pip has installed the package as PREFIX/lib/python3.11/site-packages/clogsweep.
        JOBS = PACKAGE / "jobs"
        PROGRAMS = [PACKAGE.parents[3] / "bin"]
    else:  # The package is in the source tree.
        _SOURCE = PACKAGE.parents[1]
        JOBS = _SOURCE / "jobs"
        PROGRAMS = [_SOURCE / "build" / "release" / "bin"]
else:
    JOBS = (PACKAGE / JOBS_FOLDER).resolve()
    PROGRAMS = [(PACKAGE / PROGRAMS_FOLDER).resolve()]


def reason(text: str) -> str:
    """The error line of the program itself, without the lines that mpirun prints around it."""
    lines = [line for line in text.splitlines() if line.strip()]
    ours = [line for line in lines if line.startswith(("clogsweep", "clogrun", "clogfit"))]
    return (ours or lines[-1:] or ["no reason given"])[-1]


def programs_in(folder: str | os.PathLike[str] | None = None) -> pathlib.Path:
    """The folder with clogsweep, clogrun and clogfit: `folder` if it is given, or else the first existing folder among
    CLOG_BIN, the folder of clogsweep in the PATH, and the folder beside this package.

    @throws UserError  if the programs are not there
    """
    called = shutil.which("clogsweep")
    chosen = os.environ.get("CLOG_BIN")
    candidates = [pathlib.Path(folder)] if folder else [
        *([pathlib.Path(chosen)] if chosen else []), *([pathlib.Path(called).resolve().parent] if called else []), *PROGRAMS]
    for place in candidates:
        if (place / "clogsweep").exists():
            return place.resolve()
    raise UserError(f"no clogsweep in {place}; build it (cmake --workflow --preset release), or give --programs FOLDER")


def add_option(parser: argparse.ArgumentParser) -> None:
    """Adds --programs; its value is the folder for programs_in()."""
    parser.add_argument("--programs", type=pathlib.Path,
                        help="folder of clogsweep, clogrun and clogfit (CLOG_BIN, that of the PATH, or beside this package)")


def run_program(program: str | os.PathLike[str], *arguments: object, ranks: int = 1) -> str:
    """Runs a program. @return the program's output. @throws ProgramFailed  with its reason"""
    return _outputs(program, *arguments, ranks=ranks)[0]


def run_with_warnings(program: str | os.PathLike[str], *arguments: object) -> str:
    """Runs a program, and prints its warnings on the error stream. @return its output.
    @throws ProgramFailed  with its reason"""
    output, warnings = _outputs(program, *arguments)
    print(warnings, end="", file=sys.stderr)
    return output


def warnings_of(program: str | os.PathLike[str], *arguments: object) -> str:
    """Runs a program. @return its output on the error stream. @throws ProgramFailed  with its reason"""
    return _outputs(program, *arguments)[1]


def word_of(argument: object) -> str:
    """An argument as a word of a command line. Paths of Python lose the ./ of ./-dash.h5, and the rest would look like
    an option."""
    word = str(argument)
    return f"./{word}" if isinstance(argument, pathlib.PurePath) and word.startswith("-") else word


def _outputs(program: str | os.PathLike[str], *arguments: object, ranks: int = 1) -> tuple[str, str]:
    command = [str(program), *map(word_of, arguments)]
    environment = dict(os.environ)
    if ranks == 1:
        # If this variable of an allocation is set, clogsweep refuses to run on one rank.
        environment.pop("SLURM_NTASKS", None)
    else:
        settings = shlex.quote(str(JOBS / "mpi-settings.sh"))
        command = ["bash", "-c", f'. {settings} && exec mpirun -np {ranks} "$@"', "mpirun", *command]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, env=environment,
                          encoding="utf-8", errors="backslashreplace") as process:
        while True:
            try:
                out, error = process.communicate()
                break
            except KeyboardInterrupt:
                # The terminal also sends SIGINT to the programs, so they end cleanly by themselves and report their
                # progress.
                continue
    if process.returncode != 0:
        raise ProgramFailed(reason(error or out), process.returncode)
    return out, error
