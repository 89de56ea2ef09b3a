"""The statements of the article, and how each is judged.

A statement consists of its place in the article, its text, and a function that judges it from the sweeps of the
figures. The verdict is computed. If it is not `agrees`, the reason for it was written by hand.
"""

import dataclasses
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any

from ..paper.dilute import FAMILIES, Family
from ..paper.workshop import Workshop
from ..tools.errors import NotThere, UserError

AGREES, IN_KIND, FITTED = "agrees", "qualitatively", "by construction"
FORCED, BY_MESH = "agrees with an added force", "artefact of the mesh"
DOES_NOT, NOT_KNOWN, NOT_RUN = "does not agree", "not known", "not run"
VERDICTS = [AGREES, IN_KIND, FORCED, BY_MESH, FITTED, DOES_NOT, NOT_KNOWN, NOT_RUN]  # the summary of the table has this order


@dataclasses.dataclass(frozen=True)
class Finding:
    """What this program finds about a statement.
    @param value  text with numbers and their intervals
    @param variants  verdicts and values of other models
    @param brief  the same verdicts without values"""

    verdict: str
    value: str
    variants: str = ""
    brief: str = ""


Judge = Callable[..., Finding]


@dataclasses.dataclass(frozen=True)
class Statement:
    where: str
    text: str
    figures: tuple[str, ...]  # The statement is judged from the sweeps of these figures.
    judge: Judge
    reasons: Mapping[str, str] = dataclasses.field(default_factory=dict)  # by verdict


STATEMENTS: list[Statement] = []
NAMES = {"in_kind": IN_KIND, "fitted": FITTED, "does_not_agree": DOES_NOT, "not_known": NOT_KNOWN}
ALWAYS = {FORCED: "without it nothing holds a soft droplet that hangs over an obstacle",
          BY_MESH: "only corners of the polygon hold a soft droplet, and finer meshes hold fewer droplets"}


def statement(where: str, text: str, *figures: str, **reasons: str) -> Callable[[Judge], Judge]:
    """Registers a function that judges a statement.

    @param figures  figures whose sweeps the function needs
    @param reasons  the reason for each verdict; NAMES maps the argument's name to the verdict
    """

    def register(judge: Judge) -> Judge:
        STATEMENTS.append(Statement(where, text, figures, judge, ALWAYS | {NAMES[name]: why for name, why in reasons.items()}))
        return judge

    return register


def tried(judge: Judge, *arguments: Any) -> Finding:
    try:
        return judge(*arguments)
    except NotThere:
        return Finding(NOT_RUN, "")


def with_variants(found: Mapping[Family, Finding]) -> Finding:
    """The finding of the first family, which is nearest to the published model. If the first family does not agree but
    another family does, the verdict says whether friction or the mesh makes the difference."""
    (_, nearest), *others = found.items()
    verdict = nearest.verdict
    if verdict in (DOES_NOT, NOT_KNOWN):
        helps = [family for family, finding in others if finding.verdict == AGREES]
        verdict = FORCED if any(family.friction > 0 for family in helps) else BY_MESH if helps else verdict
    families = {one: ", ".join(family.in_words for family, finding in others if finding.verdict == one) for one in dict.fromkeys(finding.verdict for _, finding in others)}
    return Finding(verdict, nearest.value, "; ".join(f"{family.in_words}: {finding.verdict}" + (f", {finding.value}" if finding.value else "")
                                                     for family, finding in others), "; ".join(f"{one}: {names}" for one, names in families.items()) if len(families) > 1 or len(others) < 2 else f"{others[0][1].verdict}: all")


def statement_of_families(where: str, text: str, figure: str = "6c", families: Sequence[Family] = FAMILIES, **reasons: str) -> Callable[[Judge], Judge]:
    """Registers a function that judges a statement from the sweeps. The function is called for each family of walls.
    @param families  the first is nearest to the published model"""
    def register(judge: Judge) -> Judge:
        statement(where, text, figure, **reasons)(lambda shop: with_variants({family: tried(judge, shop, family) for family in families}))
        return judge

    return register


def statement_of_walls(where: str, text: str, figure: str = "6c", families: Sequence[Family] = FAMILIES, **reasons: str) -> Callable[[Judge], Judge]:
    """Registers a function that judges a statement from the groups of one family. The groups are sorted by gap, then by
    line tension."""
    def register(judge: Judge) -> Judge:
        def of_family(shop: Workshop, family: Family) -> Finding:
            return judge(sorted(family.of(shop.sweep(family.config)), key=lambda group: (group["obstacle_gap"], group["line_tension"])))

        statement_of_families(where, text, figure, families, **reasons)(of_family)
        return judge

    return register


@dataclasses.dataclass(frozen=True)
class Judged:
    statement: Statement
    finding: Finding

    @property
    def reason(self) -> str:
        """The reason for the verdict. If the statement does not agree or cannot be judged, the reason also names the
        figures whose runs were tried."""
        figures = ", ".join(self.statement.figures) if self.finding.verdict in (DOES_NOT, NOT_KNOWN) else ""
        return "; ".join(filter(None, [self.statement.reasons.get(self.finding.verdict), figures and f"tried: runs of figure{'s' * (',' in figures)} {figures}"]))


def judge(shop: Workshop, one: Statement) -> Judged:
    found = tried(one.judge, shop)
    return Judged(one, Finding(NOT_RUN, f"python3 -m clogsweep figures {' '.join(one.figures)}") if found.verdict == NOT_RUN else found)


def judge_all(shop: Workshop) -> tuple[list[Judged], int | None]:
    """Judges all statements.
    @param shop  a workshop that runs nothing
    @return the judged statements, and the model version of the sweeps, None without sweeps
    @throws UserError  if the sweeps have several model versions"""
    return [judge(shop, one) for one in STATEMENTS], the_version(shop.model_versions())


def the_version(versions: Mapping[str, Iterable[int]]) -> int | None:
    """The common model version of all sweeps; None without sweeps.
    @param versions  model versions in the rows of each sweep
    @throws UserError  if the sweeps have several model versions"""
    newest = max((version for of_sweep in versions.values() for version in of_sweep), default=None)
    older = sorted(name for name, of_sweep in versions.items() if set(of_sweep) - {newest})
    if older:
        raise UserError(f"sweeps are of several model versions; remove and rerun those older than {newest}: {', '.join(older)}")
    return newest
