#!/usr/bin/env python3
"""Checks docs/gallery/pictures.csv, which lists every picture of the handbook with its size and the model version of
its rows. The list docs/gallery/rows/queue.csv has the sweeps that are still to be run. Every picture of reduced size
must wait for one of these sweeps, and its column `note` contains `waits`. A picture of an earlier model version must
also wait, or its column `note` must link to a note that is newer than the picture. The CSV file of this note shows that
the present version gives the same rows for a part of the picture."""

import csv
import re
import sys

import known

GALLERY = known.ROOT / "docs/gallery"
VERSION = re.search(r"int model_version = (\d+);", (known.ROOT / "include/clog/core/parameters/parameters.hpp").read_text())[1]
NOTE = re.compile(r"\]\(\.\./notes/(([\d-]{10})-[\w-]+)\.md\)")
SINGLE = ("single runs", "own sweep")  # No sweep of the queue will change these pictures.
FULL = ("full", *SINGLE)


def lines_of(path):
    with open(path, newline="") as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))


def same_now(link, date):
    """The pictures that the linked note found unchanged. The set is empty if the note is not later than `date`."""
    if not link or link[2] <= date:
        return set()
    lines = lines_of(known.ROOT / f"docs/notes/{link[1]}.csv")
    return {line["picture"] for line in lines} - {line["picture"] for line in lines if line["then"] != line["now"] or line["version"] != VERSION}


def faults():
    pictures = lines_of(GALLERY / "pictures.csv")
    queue = {line["sweep"] for line in lines_of(GALLERY / "rows/queue.csv")}
    for picture in pictures:
        name, version, note = picture["picture"], picture["model version"], picture["note"]
        waits = note == "waits" and (picture["size"] in SINGLE or queue & set(picture["sweeps"].split()))
        if picture["size"] not in FULL and not waits:
            yield f"{name} is not of full size, and no sweep of rows/queue.csv will change that; run it, or list it"
        if version != VERSION and not waits and name not in same_now(NOTE.search(note), picture["date"]):
            yield (f"{name} has rows of model version {version}, and no note found the same with {VERSION}; "
                   "draw it anew, or recompute a part")
    listed = {picture["picture"] for picture in pictures}
    pages = [known.ROOT / "README.md", *(known.ROOT / "docs").rglob("*.md")]
    shown = {name for page in pages for name in re.findall(r"pictures/(?:figure-)?([\w-]+)\.png", page.read_text())}
    yield from (f"{name} is missing in pictures.csv, or on the pages" for name in sorted(shown ^ listed))
    tables = {VERSION, *(picture["model version"] for picture in pictures if picture["note"] == "waits")}
    if not any(f"All rows have model version {version}." in " ".join((GALLERY / "agreement.md").read_text().split()) for version in tables):
        yield f"the table of agreement is of another model version than {VERSION}; make it anew"


sys.exit("\n".join(f"docs/gallery: {fault}" for fault in faults()) or None)
