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


def markdown(judged: Sequence[Judged], version: int) -> str:
    """A table for each place of the article."""
    lines = [textwrap.fill(f"Of {len(judged)} statements {counts(judged)}. All rows have model version {version}.", 118)]
    for where in dict.fromkeys(one.statement.where for one in judged):
        rows = [cells(one)[1:] for one in judged if one.statement.where == where]
        has_variants = any(row[-1] for row in rows)
        lines += ["", f"**{where[0].upper()}{where[1:]}**", "", "| statement | here | verdict |" + " variants |" * has_variants,
                  "|---|---|---|" + "---|" * has_variants]
        for text, here, verdict, reason, variants in rows:
            lines.append(f"| {text} | {here} | **{verdict}**{': ' if reason else ''}{reason} |" + f" {variants} |" * has_variants)
    return "\n".join(lines) + "\n"


def comma_separated(judged: Sequence[Judged], _: int) -> str:
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerows([COLUMNS, *map(cells, judged)])
    return text.getvalue()


WRITERS: dict[str, Callable[[Sequence[Judged], int], str]] = {"markdown": markdown, "csv": comma_separated}
