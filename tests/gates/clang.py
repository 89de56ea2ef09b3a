#!/usr/bin/env python3
"""clang.py warnings|tidy [--changed] [--most N] [FILE...]: prints the findings of clang++ or clang-tidy in these
sources, or in all sources.

--changed selects changed sources (known.py prints since when), and for each changed header a source that includes it.
If there are more than N sources, only N of them are checked, and others at the next commit. Exit code 1: there is a
finding."""

import argparse
import concurrent.futures
import hashlib
import json
import os
import pathlib
import re
import shlex
import subprocess
import sys

import known

BUILD = known.ROOT / "build/gates"
# Matches the place where a finding begins.
FINDING = re.compile(r"^(?=[^\s:]+:\d+:\d+: (?:warning|error):)", re.MULTILINE)


def configure():
    """Lets CMake write to build/gates the command that compiles each source. Warnings of CMake are errors."""
    done = subprocess.run(["cmake", "--preset", "gates"], cwd=known.ROOT, capture_output=True, text=True)
    if done.returncode != 0 or "Warning" in done.stderr:
        sys.exit(done.stdout + done.stderr + "CMake fails or warns")


def compile_commands():
    """The arguments that compile each source in git. A source that no target compiles is an error. The examples are
    left out, because a test compiles them with an installation."""
    sources = set(known.files("*.cpp", ":(exclude)docs/examples"))
    commands = {}
    for entry in json.loads((BUILD / "compile_commands.json").read_text()):
        name = os.path.relpath(entry["file"], known.ROOT)
        if name in sources:
            commands[name] = shlex.split(entry["command"]), entry["directory"]
    forgotten = sources - commands.keys()
    if forgotten:
        sys.exit("no target of CMake compiles " + ", ".join(sorted(forgotten)))
    return commands


def source_of(header, sources):
    """A source that includes this header, if possible the source with the same name. None if no source includes the
    header."""
    path = pathlib.PurePath(header)
    line = f'"{path.relative_to("include")}"' if path.parts[0] == "include" else f'{path.name}"'
    including = [source for source in sources if line in (known.ROOT / source).read_text()]
    own = [source for source in including if pathlib.PurePath(source).stem == path.stem]
    return (own or including or [None])[0]


def chosen(sources, most):
    """Chooses at most this number of the sources that changed or that include a changed header. Prints the excluded
    sources."""
    answer = known.changed()
    if answer is None:
        print(f"what changed is not known: all {len(sources)} sources are candidates")
        wanted = set(sources)
    else:
        files, since = answer
        shown = {source_of(name, sources) for name in files if name.endswith(".hpp")} - {None}
        wanted = {source for source in sources if source in files} | shown
        print(f"{len(wanted)} of {len(sources)} sources changed since {since}, or show a header that did")
    if most and len(wanted) > most:
        print(f"of these, {most} are looked at; `tests/gates/run.sh --all tidy` looks at all")
        head = known.git("rev-parse", "HEAD") or ""
        wanted = set(sorted(wanted, key=lambda name: hashlib.sha256((head + name).encode()).digest())[:most])
    return sorted(wanted)


def compiler_words(source, command):
    """The options for a clang++ that only parses and checks. All warnings are on, except for those that need the
    optimiser."""
    arguments, folder = command
    words = [word for word in arguments if word != "-c"] + ["-Werror", "-fsyntax-only"]
    done = subprocess.run(words, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    return source, done.returncode, done.stdout


def tidy_words(source, command):
    words = ["clang-tidy", "--quiet", "--warnings-as-errors=*", "-p", BUILD, known.ROOT / source]
    done = subprocess.run(words, cwd=known.ROOT, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    # The standard error also counts warnings that clang-tidy does not show, so it is printed only after a failure.
    return source, done.returncode, done.stdout or (done.stderr if done.returncode else "")


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("kind", choices=["warnings", "tidy"])
    options.add_argument("--changed", action="store_true")
    options.add_argument("--most", type=int, metavar="N")
    options.add_argument("files", nargs="*", metavar="FILE")
    given = options.parse_args()

    configure()
    commands = compile_commands()
    sources = given.files or sorted(commands)
    unknown = [name for name in sources if name not in commands]
    if unknown:
        sys.exit("not a source that git knows: " + ", ".join(unknown))
    if given.changed:
        sources = chosen(sources, given.most)

    ask = {"warnings": compiler_words, "tidy": tidy_words}[given.kind]
    printed, faulty = set(), []
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for source, code, words in pool.map(lambda name: ask(name, commands[name]), sources):
            if code != 0:
                faulty.append(source)
            # A finding in a header is printed once, not for every source that includes the header.
            for finding in FINDING.split(words):
                if finding.strip() and finding not in printed:
                    printed.add(finding)
                    print(finding.rstrip(), flush=True)
    if faulty:
        sys.exit(f"there is something to mend in {len(faulty)} of {len(sources)} sources: " + " ".join(faulty))
    print(f"{len(sources)} sources are clean")


if __name__ == "__main__":
    main()
