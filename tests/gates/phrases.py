#!/usr/bin/env python3
"""Finds phrases that were retired from prose. phrases.txt lists them with the words to use instead.

The section of a phrase in phrases.txt decides where it is searched. `[everywhere]` means *.md, comments, docstrings and
messages. `[documentation]` means *.md only. `[beginnings]` means only the beginnings of comments, docstrings and
messages, with the given upper or lower case. Code, `quoted` text and the dated pages (docs/notes, CHANGELOG.md) are
skipped. A phrase may span two lines.
"""

import re
import sys

import known
import spelling

PHRASES = known.ROOT / "tests/gates/phrases.txt"
DATED = ("docs/notes/", "CHANGELOG.md")
SOURCES = ("*.cpp", "*.hpp", "*.py", "*.sh", "*.cmake", "*CMakeLists.txt", "*.cfg")
SECTIONS = ("[everywhere]", "[beginnings]", "[documentation]")
LINE = re.compile(r"(?P<phrase>[^#\[\]:]+): (?P<instead>.+)")


def listed():
    """The phrases of each section as patterns, with the words to use instead."""
    section = None
    for number, line in enumerate(PHRASES.read_text().splitlines(), 1):
        entry = LINE.fullmatch(line)
        if line in SECTIONS:
            section = line
        elif entry and section:
            words = r"\s+".join(map(re.escape, entry["phrase"].split()))
            begins = section == "[beginnings]"
            pattern = re.compile(rf"\A{words}\b") if begins else re.compile(rf"\b{words}\b", re.IGNORECASE)
            yield section, pattern, entry["instead"]
        elif line and not line.startswith("#"):
            sys.exit(f"{PHRASES.name}:{number}: neither '[section]', '# comment' nor 'phrase: words to use instead'")


def paragraphs(name):
    """Blocks of consecutive lines of prose. Each block is one text, with the number of its first line."""
    first, lines = 0, []
    for number, line in spelling.prose(name):
        line = re.sub(r"^[\s/*<!#>\"']+", "", spelling.CODE.sub(" ", line)) if line.strip() else ""
        if lines and (number != first + len(lines) or not line):
            yield first, "\n".join(lines)
            lines = []
        if line:
            first = first if lines else number
            lines.append(line)
    if lines:
        yield first, "\n".join(lines)


def main():
    phrases = list(listed())
    pages = [name for name in known.files("*.md") if not name.startswith(DATED)]
    # tests/gates is excluded, because phrases.txt and this script contain the phrases themselves.
    sources = [name for name in known.files(*SOURCES) if not name.startswith("tests/gates/")]
    faults = 0
    for name in pages + sources:
        for first, text in paragraphs(name):
            for section, pattern, instead in phrases:
                if section != "[everywhere]" and (section == "[documentation]") != name.endswith(".md"):
                    continue
                for found in pattern.finditer(text):
                    number = first + text.count("\n", 0, found.start())
                    print(f"{name}:{number}: '{' '.join(found[0].split())}' is retired; write {instead}")
                    faults += 1
    if faults:
        sys.exit(f"{faults} retired phrases")
    print(f"{len(phrases)} retired phrases are absent from {len(pages)} pages and {len(sources)} sources")


if __name__ == "__main__":
    main()
