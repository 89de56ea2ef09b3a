#!/usr/bin/env python3
"""Checks that the table of docs/gallery/index.md lists every picture of the gallery with the model version of its rows.
If this is not the program's version, the row's note is `waits`, for pictures that will be run again, or a later note must
show for a part of each picture that the program still gives the same rows. The note's CSV file contains these rows."""

import csv
import re
import sys

import known

GALLERY = known.ROOT / "docs/gallery"
VERSION = re.search(r"int model_version = (\d+);", (known.ROOT / "include/clog/core/parameters/parameters.hpp").read_text())[1]
ROW = re.compile(r"^\| ([^|]+) \| \w+ \| (\d+) \| ([\d-]+) \|(.*)\|$", re.MULTILINE)
NOTE = re.compile(r"\]\(\.\./notes/(([\d-]{10})-[\w-]+)\.md\)")


def same_now(link, date):
    """The pictures that the linked note found unchanged. The set is empty if the note is not later than `date`."""
    if not link or link[2] <= date:
        return set()
    with open(known.ROOT / f"docs/notes/{link[1]}.csv", newline="") as file:
        lines = list(csv.DictReader(line for line in file if not line.startswith("#")))
    return {line["picture"] for line in lines} - {line["picture"] for line in lines if line["then"] != line["now"] or line["version"] != VERSION}


def faults():
    listed = set()
    for names, version, date, note in ROW.findall((GALLERY / "index.md").read_text()):
        listed |= {*names.split(", ")}
        is_current = version == VERSION or note.strip() == "waits"
        aged = () if is_current else {*names.split(", ")} - same_now(NOTE.search(note), date)
        yield from (f"{name} has rows of model version {version}, and no note found the same with {VERSION}; draw it anew, or recompute a part" for name in sorted(aged))
    shown = {name for page in GALLERY.glob("*.md") for name in re.findall(r"pictures/(?:figure-)?([\w-]+)\.png", page.read_text())} | {"density"}
    yield from (f"{name} is missing in the table of model versions, or in the gallery" for name in sorted(shown ^ listed))
    tables = {VERSION, *(version for _, version, _, note in ROW.findall((GALLERY / "index.md").read_text()) if note.strip() == "waits")}
    if not any(f"All rows have model version {version}." in " ".join((GALLERY / "agreement.md").read_text().split()) for version in tables):
        yield f"the table of agreement is of another model version than {VERSION}; make it anew"


sys.exit("\n".join(f"docs/gallery: {fault}" for fault in faults()) or None)
