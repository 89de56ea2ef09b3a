"""Prints the judged statements as a table."""

import collections
import csv
import io
import textwrap
from collections.abc import Callable, Sequence

from .verdicts import VERDICTS, Judged

COLUMNS = ["where", "statement", "judged by", "criterion", "here", "verdict", "reason", "variants"]


def cells(one: Judged) -> list[str]:
    statement, finding = one.statement, one.finding
    return [statement.where, statement.text, statement.model, statement.criterion, finding.value, finding.verdict,
            one.reason, finding.variants]


def counts(judged: Sequence[Judged]) -> str:
    """The number of statements with each verdict, such as *agrees* for 31 and *qualitatively* for 12."""
    number = collections.Counter(one.finding.verdict for one in judged)
    *others, last = [f"*{verdict}* for {number[verdict]}" for verdict in VERDICTS if number[verdict]]
    return f"{', '.join(others)} and {last}" if others else last


def shortened(value: str) -> str:
    """The first and the last of several results, or the text itself if there are at most two."""
    parts = value.split("; ")
    return f"{parts[0]}; ...; {parts[-1]}" if len(parts) > 2 else value


def markdown(judged: Sequence[Judged], version: int | None) -> str:
    """A table for each section of the article. If a statement has several results, the table shows only the first and
    the last. For variants the table shows only the verdicts."""
    rows = "No sweep has been run" if version is None else f"All rows have model version {version}"
    summary = f"The verdicts on the article's {len(judged)} statements are {counts(judged)}. {rows}."
    lines = [textwrap.fill(summary, 118)]
    place_of = {id(one): one.statement.where.partition(", ") for one in judged}
    for section in dict.fromkeys(place[0] for place in place_of.values()):
        members = [one for one in judged if place_of[id(one)][0] == section]
        variants = {id(one): one.finding.brief or one.finding.variants for one in members}
        has_variants = any(variants.values())
        lines += ["", f"**{section[0].upper()}{section[1:]}**", "",
                  "| statement | here | verdict |" + " variants |" * has_variants,
                  "|---|---|---|" + "---|" * has_variants]
        for one in members:
            statement = ": ".join(filter(None, [place_of[id(one)][2], one.statement.text]))
            verdict = ": ".join(filter(None, [f"**{one.finding.verdict}**", one.reason]))
            lines.append(f"| {statement} | {shortened(one.finding.value)} | {verdict} |"
                         + f" {variants[id(one)]} |" * has_variants)
    return "\n".join(lines) + "\n"


def comma_separated(judged: Sequence[Judged], _: int | None) -> str:
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerows([COLUMNS, *map(cells, judged)])
    return text.getvalue()


WRITERS: dict[str, Callable[[Sequence[Judged], int | None], str]] = {"markdown": markdown, "csv": comma_separated}
