"""The judged statements as a table."""

import collections
import csv
import io
import textwrap
from collections.abc import Callable, Sequence

from .statements import AGREES, BY_MESH, DOES_NOT, FITTED, FORCED, IN_KIND, NOT_KNOWN, NOT_RUN, Judged

COLUMNS = ["where", "statement", "here", "verdict", "reason", "variants"]


def cells(one: Judged) -> list[str]:
    return [one.statement.where, one.statement.text, one.finding.value, one.finding.verdict, one.reason, one.finding.variants]


def counts(judged: Sequence[Judged]) -> str:
    """The verdicts counted, such as 31 agree, 12 agree qualitatively."""
    number = collections.Counter(one.finding.verdict for one in judged)
    words = {AGREES: "agree", IN_KIND: "agree qualitatively", FORCED: "agree with an added force", BY_MESH: "are artefacts of the mesh",
             FITTED: "agree by construction", DOES_NOT: "do not agree", NOT_KNOWN: "are not known", NOT_RUN: "have not been run"}
    return ", ".join(f"{number[verdict]} {word}" for verdict, word in words.items() if number[verdict])


def shortened(value: str) -> str:
    """The first and the last of several results."""
    parts = value.split("; ")
    return f"{parts[0]}; ...; {parts[-1]}" if len(parts) > 2 else value


def markdown(judged: Sequence[Judged], version: int) -> str:
    """A table for each section of the article: the first and last of several results, and the verdicts on variants without theirs."""
    lines = [textwrap.fill(f"Of {len(judged)} statements {counts(judged)}. All rows have model version {version}.", 118)]
    place_of = {id(one): one.statement.where.partition(", ") for one in judged}
    for section in dict.fromkeys(place[0] for place in place_of.values()):
        members = [one for one in judged if place_of[id(one)][0] == section]
        variants = {id(one): one.finding.brief or one.finding.variants for one in members}
        has_variants = any(variants.values())
        lines += ["", f"**{section[0].upper()}{section[1:]}**", "", "| statement | here | verdict |" + " variants |" * has_variants, "|---|---|---|" + "---|" * has_variants]
        for one in members:
            place, reason = place_of[id(one)][2], one.reason
            lines.append(f"| {place}{': ' if place else ''}{one.statement.text} | {shortened(one.finding.value)} | **{one.finding.verdict}**{': ' if reason else ''}{reason} |"
                         + f" {variants[id(one)]} |" * has_variants)
    return "\n".join(lines) + "\n"


def comma_separated(judged: Sequence[Judged], _: int) -> str:
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerows([COLUMNS, *map(cells, judged)])
    return text.getvalue()


WRITERS: dict[str, Callable[[Sequence[Judged], int], str]] = {"markdown": markdown, "csv": comma_separated}
