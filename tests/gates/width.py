#!/usr/bin/env python3
"""Checks that lines of prose in *.md have at most 120 characters. Tables, code, and words that cannot be broken may be
longer. No line may begin with %, because the handbook would not show this line. Also counts longer lines in `*.py`.
Their number may only fall; after a fall, LONG_PYTHON_LINES must be lowered."""

import sys

import known

MOST = 120
LONG_PYTHON_LINES = 725


def prose(text):
    """The lines of prose, with their numbers. Tables, fenced blocks and indented blocks are excluded."""
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
            if line.lstrip("> ").startswith("%"):
                print(f"{name}:{number}: begins with %, so it is a comment (MyST); break the line elsewhere")
                faults += 1
    if faults:
        sys.exit(f"{faults} lines of prose are faulty")
    texts = {name: (known.ROOT / name).read_text() for name in known.files("*.py")}
    long = [f"{name}:{number}" for name, text in texts.items()
            for number, line in enumerate(text.splitlines(), 1) if len(line) > MOST]
    if len(long) > LONG_PYTHON_LINES:
        changed = (known.changed() or (texts, ""))[0]
        print("\n".join(place for place in long if place.partition(":")[0] in changed))
        sys.exit(f"{len(long)} lines of Python have more than {MOST} characters, at most {LONG_PYTHON_LINES} may; "
                 "break those that you wrote")
    if len(long) < LONG_PYTHON_LINES:
        sys.exit(f"only {len(long)} lines of Python have more than {MOST} characters; "
                 f"set LONG_PYTHON_LINES = {len(long)} in tests/gates/width.py")


if __name__ == "__main__":
    main()
