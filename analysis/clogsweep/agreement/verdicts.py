"""The verdicts on statements of the article (Cheng et al.), and how a statement is judged.

The program computes the verdict. Each verdict other than `agrees` has a reason that was written by hand.
"""

import dataclasses
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any

from ..paper.dilute import FAMILIES, Family
from ..paper.runner import Runner
from ..tools.errors import NotThere, UserError
from ..tools.hints import Group

AGREES, IN_KIND, FITTED = "agrees", "qualitatively", "by construction"
FORCED, BY_MESH = "agrees with an added force", "artefact of the mesh"
DOES_NOT, NOT_KNOWN, NOT_RUN = "does not agree", "not known", "not run"
# The summary of the table lists the verdicts in this order.
VERDICTS = [AGREES, IN_KIND, FORCED, BY_MESH, FITTED, DOES_NOT, NOT_KNOWN, NOT_RUN]


@dataclasses.dataclass(frozen=True)
class Finding:
    """What this program finds about a statement.
    @param value  text with numbers and their intervals
    @param variants  verdicts and values of other models
    @param brief  verdicts of other models, without values"""

    verdict: str
    value: str
    variants: str = ""
    brief: str = ""


@dataclasses.dataclass(frozen=True)
class Statement:
    """A statement of the article.
    @param where  its place in the article
    @param model  the model, interface and contact that the verdict is for
    @param criterion  what `agrees` and other verdicts mean, with thresholds; written before the runs are read
    @param judge  finds the verdict
    @param figures  the figures with sweeps that the judge needs
    @param reasons  reasons by verdict, in addition to ALWAYS"""

    where: str
    text: str
    model: str
    criterion: str
    judge: Callable[[Runner], Finding]
    figures: tuple[str, ...] = ()
    reasons: Mapping[str, str] = dataclasses.field(default_factory=dict)


ALWAYS = {FORCED: "without it nothing holds a soft droplet that hangs over an obstacle",
          BY_MESH: "only corners of the polygon hold a soft droplet, and finer meshes hold fewer droplets"}


def tried(judge: Callable[..., Finding], *arguments: Any) -> Finding:
    try:
        return judge(*arguments)
    except NotThere:
        return Finding(NOT_RUN, "")


def with_variants(found: Mapping[Family, Finding]) -> Finding:
    """The finding of the first family, which is nearest to the published model. If only another family agrees, the
    verdict names the cause of the difference: friction, or the mesh."""
    (_, nearest), *others = found.items()
    verdict = nearest.verdict
    if verdict in (DOES_NOT, NOT_KNOWN):
        helps = [family for family, finding in others if finding.verdict == AGREES]
        verdict = FORCED if any(family.friction > 0 for family in helps) else BY_MESH if helps else verdict
    variants, brief = words_of_variants([(family.in_words, finding) for family, finding in others])
    return Finding(verdict, nearest.value, variants, brief)


def words_of_variants(found: Sequence[tuple[str, Finding]]) -> tuple[str, str]:
    """Two texts: the verdicts on the variants, each followed by its value, and the same verdicts without values.
    @param found  names and findings"""
    variants = "; ".join(f"{name}: {finding.verdict}" + (f", {finding.value}" if finding.value else "")
                         for name, finding in found)
    names: dict[str, list[str]] = {}
    for name, finding in found:
        names.setdefault(finding.verdict, []).append(name)
    if len(names) == 1 and len(found) > 1:
        return variants, f"{found[0][1].verdict}: all"
    return variants, "; ".join(f"{one}: {', '.join(of_verdict)}" for one, of_verdict in names.items())


def for_contacts(judge: Callable[..., Finding], **arguments: Any) -> Callable[[Runner], Finding]:
    """Judges a statement on passages through orifices. The published contact begins before the wall, at
    half the distance between two vertices. A variant has contact at the surface.
    @param judge  has a parameter `contact`"""
    def of_contacts(runner: Runner) -> Finding:
        published, surface = (judge(runner, contact=contact, **arguments) for contact in ("half-vertex", "surface"))
        return Finding(published.verdict, published.value, *words_of_variants([("contact at the surface", surface)]))

    return of_contacts


def for_families(judge: Callable[[Runner, Family], Finding],
                 families: Sequence[Family] = FAMILIES) -> Callable[[Runner], Finding]:
    """Judges a statement for each family of walls.
    @param families  the first is nearest to the published model"""
    return lambda runner: with_variants({family: tried(judge, runner, family) for family in families})


def for_walls(judge: Callable[[list[Group]], Finding],
              families: Sequence[Family] = FAMILIES) -> Callable[[Runner], Finding]:
    """Judges a statement from the groups of each family. The groups are sorted by gap, then by line tension."""
    def of_family(runner: Runner, family: Family) -> Finding:
        groups = family.of(runner.sweep(family.config))
        return judge(sorted(groups, key=lambda group: (group["obstacle_gap"], group["line_tension"])))

    return for_families(of_family, families)


@dataclasses.dataclass(frozen=True)
class Judged:
    statement: Statement
    finding: Finding

    @property
    def reason(self) -> str:
        """The reason for the verdict. If the statement does not agree or cannot be judged, the reason also names the
        figures with runs that were tried."""
        reasons = ALWAYS | dict(self.statement.reasons)
        figures = ", ".join(self.statement.figures) if self.finding.verdict in (DOES_NOT, NOT_KNOWN) else ""
        runs = f"tried: runs of figure{'s' * (',' in figures)} {figures}" if figures else ""
        return "; ".join(filter(None, [reasons.get(self.finding.verdict), runs]))


def judge(runner: Runner, one: Statement) -> Judged:
    found = tried(one.judge, runner)
    if found.verdict == NOT_RUN:
        found = Finding(NOT_RUN, "python3 -m clogsweep agreement --run")
    return Judged(one, found)


def the_version(versions: Mapping[str, Iterable[int]]) -> int | None:
    """The common model version of all sweeps; None without sweeps.
    @param versions  model versions in the rows of each sweep
    @throws UserError  if the sweeps have several model versions"""
    newest = max((version for of_sweep in versions.values() for version in of_sweep), default=None)
    older = sorted(name for name, of_sweep in versions.items() if set(of_sweep) - {newest})
    if older:
        raise UserError("sweeps are of several model versions; "
                        f"remove and rerun those older than {newest}: {', '.join(older)}")
    return newest
