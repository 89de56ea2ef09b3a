"""The statements of the article, and how each is judged.

A statement knows where the article makes it, what it says, and how to judge it from the sweeps behind the figures. The
verdict is computed. Only the reason for a verdict other than `agrees` is written by hand.
"""

import dataclasses
from collections.abc import Callable, Iterable, Mapping

from ..paper.dilute import FAMILIES, Family
from ..paper.workshop import Workshop
from ..tools.errors import NotThere, UserError
from ..tools.hints import Group

AGREES, IN_KIND, FITTED = "agrees", "qualitatively", "by construction"
DOES_NOT, NOT_KNOWN, NOT_RUN = "does not agree", "not known", "not run"


@dataclasses.dataclass(frozen=True)
class Finding:
    """The result of this program. @param value  in words, with numbers and their intervals"""

    verdict: str
    value: str


Judge = Callable[[Workshop], Finding]
JudgeOfWalls = Callable[[list[Group]], Finding]


@dataclasses.dataclass(frozen=True)
class Statement:
    where: str
    text: str
    figures: tuple[str, ...]  # whose sweeps it is judged from
    judge: Judge
    walls: str = ""  # the family, for statements that are judged for each
    reasons: Mapping[str, str] = dataclasses.field(default_factory=dict)  # by verdict


STATEMENTS: list[Statement] = []


def _by_verdict(reasons: Mapping[str, str]) -> dict[str, str]:
    names = {"in_kind": IN_KIND, "fitted": FITTED, "does_not_agree": DOES_NOT, "not_known": NOT_KNOWN}
    return {names[name]: why for name, why in reasons.items()}


def statement(where: str, text: str, *figures: str, **reasons: str) -> Callable[[Judge], Judge]:
    """Registers a function that judges a statement.

    @param figures  whose sweeps it needs
    @param reasons  for a verdict: in_kind, fitted, does_not_agree, not_known
    """

    def register(judge: Judge) -> Judge:
        STATEMENTS.append(Statement(where, text, figures, judge, reasons=_by_verdict(reasons)))
        return judge

    return register


def statement_of_family(where: str, text: str, figure: str, judge: Callable[[Workshop, Family], Finding], **reasons: str) -> None:
    """Registers a statement that is judged once for each family of walls."""
    for family in FAMILIES:
        def of_family(shop: Workshop, family: Family = family) -> Finding:
            return judge(shop, family)

        STATEMENTS.append(Statement(where, text, (figure,), of_family, family.in_words, _by_verdict(reasons)))


def statement_of_walls(where: str, text: str, **reasons: str) -> Callable[[JudgeOfWalls], JudgeOfWalls]:
    """Registers a function that judges the clogging lengths of figure 6c, once for each family of walls.

    The function gets the family's groups in the order of gap, then line tension.
    """

    def register(judge: JudgeOfWalls) -> JudgeOfWalls:
        def of_family(shop: Workshop, family: Family) -> Finding:
            return judge(sorted(family.of(shop.sweep(family.config)), key=lambda group: (group["obstacle_gap"], group["line_tension"])))

        statement_of_family(where, text, "6c", of_family, **reasons)
        return judge

    return register


@dataclasses.dataclass(frozen=True)
class Judged:
    statement: Statement
    finding: Finding

    @property
    def reason(self) -> str:
        return self.statement.reasons.get(self.finding.verdict, "")


def judge(shop: Workshop, one: Statement) -> Judged:
    try:
        return Judged(one, one.judge(shop))
    except NotThere:
        return Judged(one, Finding(NOT_RUN, f"python3 -m clogsweep figures {' '.join(one.figures)}"))


def judge_all(shop: Workshop) -> list[Judged]:
    """@param shop  that runs nothing. @throws UserError  if its sweeps are of several model versions"""
    found = [judge(shop, one) for one in STATEMENTS]
    refuse_mixed(shop.model_versions())
    return found


def refuse_mixed(versions: Mapping[str, Iterable[int]]) -> None:
    """@param versions  of the rows of each sweep"""
    newest = max((version for of_sweep in versions.values() for version in of_sweep), default=0)
    older = sorted(name for name, of_sweep in versions.items() if set(of_sweep) - {newest})
    if older:
        raise UserError(f"sweeps are of several model versions; remove and rerun those older than {newest}: {', '.join(older)}")
