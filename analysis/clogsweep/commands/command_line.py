"""Runs the commands of this folder, and reports mistakes as the programs do: in one line, with exit code 2."""

from __future__ import annotations

import argparse
import contextlib
import io
import logging
import math
import os
import pathlib
import sys
import warnings
from collections.abc import Callable, Iterator, Sequence
from typing import TYPE_CHECKING, NoReturn, TextIO

from ..reading import programs
from ..tools import outputs
from ..tools.errors import ProgramFailed, UserError, lacking
from ..tools.texts import printable

if TYPE_CHECKING:
    from ..style import Picture

USER_FAULT = 2
INTERRUPTED = 75
WITHOUT_READER = 141  # the code that a shell reports after SIGPIPE


_own_name = ""


def speak_as(name: str) -> None:
    """Sets the command's name in its messages. The default is the script's name."""
    global _own_name
    _own_name = name


def name() -> str:
    """Name of the command in its messages. If a program calls the command under another name, such as clogfit report,
    it sets CLOG_CALLED_AS."""
    return os.environ.get("CLOG_CALLED_AS") or _own_name or pathlib.Path(sys.argv[0]).name


class ShowVersion(argparse.Action):
    """Prints the version of the programs that a command calls, under the command's name."""

    def __call__(self, parser: argparse.ArgumentParser, namespace: argparse.Namespace, *_: object) -> NoReturn:
        clogfit = programs.programs_in(getattr(namespace, "programs", None)) / "clogfit"
        print(name() + programs.run_program(clogfit, "--version").removeprefix("clogfit"), end="")
        parser.exit()


class Parser(argparse.ArgumentParser):
    """Options of a command. @param about  its docstring"""

    def __init__(self, about: str | None) -> None:
        super().__init__(prog=name(), description=about, formatter_class=argparse.RawDescriptionHelpFormatter)
        self.add_argument("--version", action=ShowVersion, nargs=0, help="print versions and exit")

    def error(self, message: str) -> NoReturn:
        raise UserError(f"{message}; {name()} --help lists the options")


def whole(least: int) -> Callable[[str], int]:
    """Type of an option: a whole number that is not smaller than `least`."""
    def number(word: str) -> int:
        if not word.lstrip("+-").isdecimal() or int(word) < least:
            raise argparse.ArgumentTypeError(f"invalid value: {word} (must be a whole number, {least} or more)")
        return int(word)

    return number


def between(low: float, high: float, meaning: str) -> Callable[[str], float]:
    """Type of an option: a number from low to high."""
    def number(word: str) -> float:
        try:
            value = float(word)
        except ValueError:
            value = math.nan
        if not low <= value <= high:
            raise argparse.ArgumentTypeError(f"invalid value: {word} (must be {meaning}, {low:g} to {high:g})")
        return value

    return number


def tasks(word: str) -> set[int]:
    """Type of an option: numbers of tasks."""
    if not all(part.isdecimal() for part in word.split(",")):
        raise argparse.ArgumentTypeError(f"invalid value: {word} (must be whole numbers with commas between "
                                         "them) try 3,17,40")
    return {int(part) for part in word.split(",")}


def key_and_value(word: str) -> tuple[str, str]:
    """Type of an option: KEY=VALUE."""
    key, equals, value = word.partition("=")
    if not (key and equals and value):
        raise argparse.ArgumentTypeError(f"invalid key: {word} (must be KEY=VALUE) try vertices=256")
    return key, value


def add_output(parser: argparse.ArgumentParser, meaning: str, *endings: str, required: bool = False) -> None:
    """Adds --output. @param endings  that the command adds itself, such as ".png"; the user may write them or not"""
    def without_ending(word: str) -> pathlib.Path:
        path = pathlib.Path(word)
        return path.with_suffix("") if path.suffix in endings else path

    parser.add_argument("-o", "--output", type=without_ending, required=required, help=meaning)


def beside(source: pathlib.Path, ending: str) -> pathlib.Path:
    """The default name of a result without --output, such as sweep-clogs of sweep.h5."""
    if source.exists() and not source.is_file():
        raise UserError(f"no name for what is made of {source}; give --output")
    return source.with_name(f"{source.stem}-{ending}")


def sweep_to_draw(about: str | None, ending: str, what: str = "file of clogsweep --output",
                  more: Sequence[Callable[[argparse.ArgumentParser], None]] = ()) -> argparse.Namespace:
    """Parses the options of a command that makes one picture of a sweep: the sweep, --output, --programs.

    @param about  the command's docstring; @param ending  of the picture's default name, which begins with the sweep's
    name
    @param what  help text for the sweep; @param more  functions that add other options. @throws UserError  if the
    picture cannot be written
    """
    parser = Parser(about)
    parser.add_argument("sweep", type=pathlib.Path, help=what)
    add_output(parser, f"name of the picture; .png and .pdf are made (SWEEP-{ending})", ".png", ".pdf")
    programs.add_option(parser)
    for add in more:
        add(parser)
    arguments = parser.parse_args()
    arguments.output = arguments.output or beside(arguments.sweep, ending)
    outputs.refuse_unwritable_picture(arguments.output, arguments.sweep)
    return arguments


def add_format(parser: argparse.ArgumentParser) -> None:
    """Adds --format, which is text or json."""
    def known(word: str) -> str:
        if word not in ("text", "json"):
            raise UserError(f"invalid --format={word} (is not one of text, json)")
        return word

    parser.add_argument("--format", type=known, default="text", help="text or json (%(default)s)")


def add_lab(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--lab", type=pathlib.Path,
                        help="file that describes the laboratory, see clogfit units; adds scales in laboratory units")


def add_width(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--width", type=between(4, 30, "a width in cm"), metavar="CM",
                        help="lay the picture out for a journal column of this width, such as 8.6, "
                             "and print the text that belongs in the caption")


def save(picture: Picture, arguments: argparse.Namespace) -> int:
    """@param arguments  with `output`, and possibly `width`. @return exit code 0"""
    if width := getattr(arguments, "width", None):
        picture.for_journal(width)
    tell("\n".join(filter(None, [f"{picture.save(arguments.output)} (and .pdf)", picture.caption])))
    return 0


def lab_options(arguments: argparse.Namespace) -> list[object]:
    """--lab for clogfit, if the user gave it."""
    return ["--lab", arguments.lab] if arguments.lab else []


def quieten_libraries() -> None:
    """Hides warnings of matplotlib, pandas and PyTables, which our users cannot fix; python -W shows them."""
    if not sys.warnoptions:
        warnings.simplefilter("ignore")
    logging.getLogger("matplotlib").setLevel(logging.ERROR)


@contextlib.contextmanager
def needs_modules() -> Iterator[None]:
    """Context manager of a block that loads modules. If a module is missing, the error says which package to install."""
    quieten_libraries()
    try:
        yield
    except ImportError as error:
        sys.exit(_refuse(lacking(error)))


def tell(text: object) -> None:
    """Prints lines with foreign names, which may contain a terminal's control sequences."""
    print(printable(text, "\n"))


def _give_up(stream: TextIO) -> None:
    """Redirects a failed stream to /dev/null. Without this, Python would try to write the rest of the output at exit,
    fail again, and return 120."""
    null = os.open(os.devnull, os.O_WRONLY)
    os.dup2(null, stream.fileno())
    os.close(null)


def _refuse(reason: object) -> int:
    try:
        print(printable(f"{name()}: {' '.join(str(reason).split())}"), file=sys.stderr, flush=True)
    except OSError:  # the reader of the stream may have closed it
        if sys.stderr is not None:
            _give_up(sys.stderr)
    return USER_FAULT


@contextlib.contextmanager
def _whole_output() -> Iterator[None]:
    """Flushes standard output at the end of the block, so that a full disk is an error inside the block."""
    if isinstance(sys.stdout, io.TextIOWrapper):
        # The locale's encoding may lack letters. Without buffering (PYTHONUNBUFFERED) each print() would fail on a full
        # disk, instead of the flush below.
        sys.stdout.reconfigure(errors="backslashreplace", write_through=False)
    try:
        yield
    finally:
        if sys.stdout is not None:
            try:
                sys.stdout.flush()
            except BrokenPipeError:  # the reader of the stream closed it
                _give_up(sys.stdout)
                raise
            except OSError as error:
                _give_up(sys.stdout)
                raise UserError("cannot write the output; the disk may be full") from error


def use_own_settings_of_pictures() -> None:
    """Makes pictures independent of the user's settings of matplotlib. Such settings may name a program for windows
    that is not installed here (MPLBACKEND in a notebook), or select LaTeX where it is not installed. The module `style`
    applies our settings when it is loaded."""
    os.environ["MPLBACKEND"] = "agg"
    outputs.are_of_command = True
    if "matplotlib" in sys.modules:
        sys.modules["matplotlib"].rcdefaults()


def run(body: Callable[[], int]) -> int:
    """@param body  the command, which returns its exit code. @return the exit code"""
    use_own_settings_of_pictures()
    try:
        with _whole_output():
            return body()
    except UserError as error:
        return _refuse(error)
    except BrokenPipeError:
        return WITHOUT_READER
    except OSError as error:
        return _refuse(f"cannot use {error.filename or 'a file'} ({error.strerror or error}); "
                       "look at its name and permissions")
    except KeyboardInterrupt:
        _refuse("interrupted; what was not complete has not been written")
        return INTERRUPTED
    except ProgramFailed as error:
        _refuse(str(error).removeprefix(f"{name().split()[0]}: "))  # clogfit report: clogfit: ...
        return error.exit_code if error.exit_code in (USER_FAULT, INTERRUPTED) else 1
