"""Runs programs under limits, and checks rules that hold for every program and every fault."""

import dataclasses
import os
import shlex
import signal
import subprocess

from processes import Hung, descend, kill, wait_for
from support import BIN, MPIRUN

EXIT_CODES = {0, 1, 2, 75}  # docs/reference/exit-codes.md
SUBCOMMANDS = {"status", "verify", "replay", "salvage", "merge", "select", "doctor",
               "array", "channel", "sag", "calibrate", "compare", "deviation",
               "drag", "report"}
# Words in the output of a program that show a bug of the program.
SIGNS_OF_FAULTS = {
    b"Traceback (most recent call last)": "a traceback",
    b"internal fault": "an internal fault",
    b"ERROR: AddressSanitizer": "the address sanitizer's report",
    b"runtime error:": "the undefined-behaviour sanitizer's report",
}


@dataclasses.dataclass
class Outcome:
    name: str
    code: int | None  # exit code, or None if the program did not end
    output: bytes
    error: bytes
    hung: str | None = None  # the reason why the test ended the program

    @property
    def is_over(self):
        """Whether the program ended by itself."""
        return self.code is not None and self.code >= 0


def command(name, *arguments, ranks=None):
    launcher = [] if ranks is None else [str(MPIRUN), str(ranks)]
    return [*launcher, str(BIN / name), *arguments]


def run(case, name, *arguments, prepare=None, ranks=None, exit_codes=EXIT_CODES, **streams):
    """Runs one of the programs in the case's folder, records forbidden behaviour, and returns the outcome.

    @param prepare  is called in the new process before the program begins
    @param streams  stdin, stdout and stderr as for `subprocess.Popen`; by default stdin is empty, and the outputs are
    read
    """
    streams = {"stdin": subprocess.DEVNULL, "stdout": subprocess.PIPE, "stderr": subprocess.PIPE, **streams}
    process = subprocess.Popen(command(name, *arguments, ranks=ranks), cwd=case.folder, preexec_fn=prepare,
                               start_new_session=True, **streams)
    hung = None
    try:
        output, error = wait_for(process.pid, process.communicate)
    except Hung as exception:
        hung = str(exception)
        kill([pid for generation in descend(process.pid) for pid in generation])
        output, error = process.communicate()
    code = None if hung else process.returncode
    outcome = Outcome(title(name, arguments), code, output or b"", error or b"", hung)
    found = list(wrongs(outcome, exit_codes))
    if found:
        case.note(f"{outcome.name} says: {outcome.error[-300:].decode('utf-8', 'replace').strip()}")
    case.findings += found
    return outcome


def title(name, arguments):
    """The name under which findings are counted: the program with its subcommand, such as clogsweep status."""
    first = os.fsdecode(arguments[0]) if arguments else ""
    return f"{name} {first}" if first in SUBCOMMANDS else name


def wrongs(outcome, exit_codes=EXIT_CODES):
    """Names everything in an outcome that is forbidden for all programs."""
    if outcome.hung:
        yield f"{outcome.name}: {outcome.hung}"
    elif outcome.code < 0:
        yield f"{outcome.name}: died of {signal.Signals(-outcome.code).name}"
    elif outcome.code not in exit_codes:
        yield f"{outcome.name}: exit code {outcome.code}"
    for sign, words in SIGNS_OF_FAULTS.items():
        if sign in outcome.error:
            yield f"{outcome.name}: {words}"


def quoted(arguments):
    """The command as bash reads it, without characters that a terminal would interpret."""
    return " ".join(quoted_word(os.fsencode(word)) for word in arguments)


def quoted_word(word):
    text = word.decode("latin-1")
    if all(map(is_plain, text)):
        return shlex.quote(text)
    return "$'" + "".join(c if is_plain(c) and c not in "'\\" else f"\\x{ord(c):02x}" for c in text) + "'"


def is_plain(character):
    return character.isascii() and character.isprintable()
