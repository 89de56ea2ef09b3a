#!/usr/bin/env python3
"""Checks that lines of prose in *.md have at most 120 characters. Tables, code, and words that cannot be broken may be
longer."""

import sys

import known

MOST = 120


def prose(text):
    """The lines of prose, with their numbers. Tables, fenced blocks and indented blocks are left out."""
    fenced = indented = False
    before = ""
    for number, line in enumerate(text.splitlines(), 1):
        if line.lstrip().startswith("```"):
            fenced = not fenced
        # A block of code is indented by four spaces and follows an empty line. An indented line without an empty line
        # before it continues a list.
        indented = line.startswith("    ") and (indented or not before.strip()) or (indented and not line.strip())
        before = line
        if not fenced and not indented and not line.lstrip().startswith("|"):
            yield number, line


def main():
    faults = 0
    for name in known.files("*.md"):
        for number, line in prose((known.ROOT / name).read_text()):
            if len(line) > MOST and " " in line.strip().lstrip("-#> "):
                print(f"{name}:{number}: {len(line)} characters, at most {MOST}")
                faults += 1
    if faults:
        sys.exit(f"{faults} lines are too long")


if __name__ == "__main__":
    main()
