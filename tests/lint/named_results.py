"""Checks that the text of each result in docs/named-results.csv is on the pages that the file lists, and on no other
page of the handbook.

    tests/lint/named_results.py ROOT
"""

import csv
import pathlib
import re
import sys

TABLE = "docs/named-results.csv"
FREE = ("docs/gallery/tables/", "docs/README.md")


def faults(root):
    texts = {name: " ".join((root / name).read_text().split()) for name in
             ["README.md", *(path.relative_to(root).as_posix() for path in sorted((root / "docs").rglob("*.md")))]}
    for row in csv.DictReader(line for line in (root / TABLE).read_text().splitlines() if not line.startswith("#")):
        number = re.compile(rf"(?<![\w.,]){re.escape(row['text'])}(?![\w]|[.,]\d)")
        listed = set(row["pages"].split())
        found = {name for name, text in texts.items() if number.search(text) and not name.startswith(FREE)}
        yield from (f"{name}: {row['text']} ({row['result']}) is missing; {TABLE} lists this page" for name in sorted(listed - found))
        yield from (f"{name}: {row['text']} ({row['result']}) is a copy that {TABLE} does not list" for name in sorted(found - listed))


found = list(faults(pathlib.Path(sys.argv[1])))
print("\n".join(found) or "named results are the same on every page")
sys.exit(bool(found))
