"""The judged statements as a table."""

import collections
import csv
import io
from collections.abc import Callable, Sequence

from .statements import AGREES, DOES_NOT, FITTED, IN_KIND, NOT_KNOWN, NOT_RUN, Judged

COLUMNS = ["where", "statement", "walls", "here", "verdict", "reason"]


def cells(one: Judged) -> list[str]:
    return [one.statement.where, one.statement.text, one.statement.walls, one.finding.value, one.finding.verdict, one.reason]


def counts(judged: Sequence[Judged]) -> str:
    """The verdicts counted, such as 31 agree, 12 agree qualitatively."""
    number = collections.Counter(one.finding.verdict for one in judged)
    words = {AGREES: "agree", IN_KIND: "agree qualitatively", FITTED: "agree by construction",
             DOES_NOT: "do not agree", NOT_KNOWN: "are not known", NOT_RUN: "have not been run"}
    return ", ".join(f"{number[verdict]} {word}" for verdict, word in words.items() if number[verdict])


def markdown(judged: Sequence[Judged]) -> str:
    """A table for each place of the article; a statement that is judged for several walls is written out once."""
    lines = [f"Of {len(judged)} statements {counts(judged)}."]
    for where in dict.fromkeys(one.statement.where for one in judged):
        lines += ["", f"**{where[0].upper()}{where[1:]}**", "", "| statement | walls | here | verdict |", "|---|---|---|---|"]
        before = ""
        for one in judged:
            if one.statement.where != where:
                continue
            text = "" if one.statement.text == before else one.statement.text
            before = one.statement.text
            verdict = f"**{one.finding.verdict}**" + (f": {one.reason}" if one.reason else "")
            lines.append(f"| {text} | {one.statement.walls} | {one.finding.value} | {verdict} |")
    return "\n".join(lines) + "\n"


def comma_separated(judged: Sequence[Judged]) -> str:
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerows([COLUMNS, *map(cells, judged)])
    return text.getvalue()


WRITERS: dict[str, Callable[[Sequence[Judged]], str]] = {"markdown": markdown, "csv": comma_separated}
