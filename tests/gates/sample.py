#!/usr/bin/env python3
"""sample.py SEED: prints 100 sentences of README, handbook, help texts and comments. A reader counts those that need a
second reading. The same seed and the same sources give the same sentences.
"""

import random
import re
import sys

import known
import spelling
import width

# For each kind, the number of sentences to print and the files that contain them.
KINDS = {"README": (6, ["README.md"]), "tutorial": (10, ["docs/tutorial/*.md"]),
         "how-to": (12, ["docs/how-to/*.md", "docs/faq.md"]),
         "explanation": (16, ["docs/explanation/*.md"]), "reference": (14, ["docs/reference/*.md", "docs/glossary.md"]),
         "gallery": (8, ["docs/gallery/*.md"]), "notes": (6, ["docs/notes/*.md", "CHANGELOG.md", "docs/paper/*.md"]),
         "developer": (6, ["docs/developer/*.md"]),
         "help": (8, ["src/programs/*.cpp", "src/core/parameters/schema.cpp", "analysis/clogsweep/commands/*.py"]),
         "comment": (14, ["src/*.?pp", "include/*.?pp", "analysis/*.py", "tests/*.?pp", "tests/*.py"])}
FEWEST_WORDS = 5
NO_PROSE = re.compile(r"\$\$|--&?>|^\W*\w+=|\{\w*[}:]|[rf]\"")
END = re.compile(r"(?<=[.!?:])\s+(?=[A-Z`*$(\"\[])")
PAGE_MARKS, CODE_MARKS = re.compile(r"^\s*(?:[-*>] )?"), re.compile(r"^[\s/*<!#>\"'|-]+")


def lines(name, kind):
    """The lines of a file that belong to the kind, with their numbers."""
    text = (known.ROOT / name).read_text()
    if name.endswith(".md"):
        return [(number, line) for number, line in width.prose(text) if not line.startswith(("#", "!", ":", "---"))]
    of = spelling.of_python if name.endswith(".py") else spelling.of_cpp
    comments = list(of(text, False))
    return comments if kind == "comment" else [line for line in of(text, True) if line not in comments]


def sentences(name, kind):
    """Sentences with their places. A sentence also ends at a blank line, before a list item, at a gap between
    comments, and before a comment that follows code on its line."""
    first, paragraph, before = 0, [], 0
    source = (known.ROOT / name).read_text().splitlines()
    marks = PAGE_MARKS if name.endswith(".md") else CODE_MARKS
    for number, line in [*lines(name, kind), (None, "")]:
        is_after_code = number and re.match(r"[^/*]+//", source[number - 1].lstrip()) and name.endswith("pp")
        is_new = number != before + 1 or not line.strip() or re.match(r"\s*[-*] ", line) or is_after_code
        if is_new and paragraph:
            whole = " ".join(" ".join(paragraph).split())
            yield from (f"{name}:{first}: {one}" for one in END.split(whole)
                        if len(one.split()) >= FEWEST_WORDS and not NO_PROSE.search(one))
            paragraph = []
        if number is not None and marks.sub("", line).strip():
            first = first if paragraph else number
            paragraph.append(marks.sub("", line))
        before = number if number is not None else before


def main():
    chosen = random.Random(int(sys.argv[1]))
    for kind, (count, patterns) in KINDS.items():
        found = [sentence for name in known.files(*patterns) for sentence in sentences(name, kind)]
        for sentence in sorted(chosen.sample(found, min(count, len(found)))):
            print(sentence)


if __name__ == "__main__":
    main()
