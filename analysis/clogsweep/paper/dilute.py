"""Draws clogging lengths in dilute arrays, as in the article: the mechanisms with different walls, polygons and disks
against the sag, and the map."""

import dataclasses
import math
from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import LogNorm
from matplotlib.lines import Line2D
from matplotlib.patches import Rectangle

from .. import style
from ..labels import AXES, interface_of, parameter_label
from ..tools.errors import NotThere
from ..tools.hints import Group
from . import panels
from .arrays import HOLDS, by, numbers, of_each, over_sag
from .captions import describe
from .plate import Plate, figure
from .runner import Runner

# The only clogging length that was published as a number, with its error (appendix C). The density of the arrays was
# not published; figure `density` finds it from the length.
PUBLISHED = {"line_tension": 1.09, "obstacle_gap": 0.2, "clogging_length": 24.0, "error": 1.0, "obstacle_density": 0.35}
ENOUGH_CLOGS = 10  # With at least this many clogs, clogfit tests whether P(r) is exponential.
FINER = (0, (4, 2))
# The star is hollow, so that it hides no point.
STAR = {"color": "black", "marker": "*", "markersize": 15, "markeredgewidth": 1.4,
        "markerfacecolor": "none", "linestyle": "none"}


@dataclasses.dataclass(frozen=True)
class Family:
    """The curves for one law of walls. A sweep may contain several friction coefficients; a family has one of them."""

    config: str
    name: str
    friction: float = 0.0

    @property
    def label(self) -> str:
        return f"{self.name} {self.friction:g}" if self.friction else self.name

    @property
    def in_words(self) -> str:
        return f"{self.name} ({self.friction:g})" if self.friction else self.name

    def of(self, groups: Sequence[Group]) -> list[Group]:
        return [group for group in groups if math.isclose(group["friction"], self.friction, abs_tol=1e-12)]


FAMILIES = [
    Family("clogging-robust", "no friction, no corner pinning"),
    Family("clogging-friction", "wall friction", 0.05),
    Family("clogging-friction", "wall friction", 0.1),
    Family("clogging-elastic", "no friction, corner pinning"),
]


def draw_published(axes: Axes) -> None:
    axes.errorbar([PUBLISHED["line_tension"]], [PUBLISHED["clogging_length"]], yerr=[PUBLISHED["error"]],
                  zorder=5, **STAR)


def families(runner: Runner, chosen: Sequence[Family], finer: bool) -> Plate:
    """Draws a panel for each family, with a curve for each gap. @param finer  also draws the sweep CONFIG-mesh, which
    has a second mesh"""
    kinds = [(family, family.of(runner.sweep(family.config)),
              family.of(runner.sweep(f"{family.config}-mesh")) if finer and runner.has(f"{family.config}-mesh") else [])
             for family in chosen if runner.has(family.config)]
    kinds = [(family, coarse, fine) for family, coarse, fine in kinds if coarse]
    if not kinds:
        configs = ", ".join(family.config for family in chosen)
        raise NotThere(f"{runner.rows_folder} holds no finished group of {configs}; run it with --size full")
    every = [group for _, coarse, fine in kinds for group in [*coarse, *fine]]
    gaps = sorted({group["obstacle_gap"] for group in every})
    found: list[panels.Panel] = []
    data = []
    for family, coarse, fine in kinds:
        tensions = sorted({group["line_tension"] for group in [*coarse, *fine]})
        curves: list[panels.Curve] = []
        drawn: list[tuple[list[Group], dict[str, Any]]] = [(coarse, {}), (fine, {"linestyle": FINER, "size": 3.5})]
        for groups, options in drawn:
            for gap, curve in by(groups, "obstacle_gap"):
                label = "_finer" if options else parameter_label(runner.columns(family.config)["obstacle_gap"], gap)
                # A line is interrupted where this mesh lacks line tensions of the other mesh, because a line could hide
                # a peak there.
                places = [tensions.index(group["line_tension"]) for group in curve]
                for part in np.split(np.array(curve, dtype=object), np.flatnonzero(np.diff(places) > 1) + 1):
                    curves.append((list(part), gaps.index(gap), label, options))
                data += numbers(curve, f"{family.config}, friction {family.friction:g}, gap {gap:g}, "
                                       f"{curve[0]['vertices']} vertices",
                                **of_each(curve, "friction", *HOLDS))
        found.append((f"{family.label}\n{interface_of(coarse[0]['preset'])}", curves))
    meshes = sorted({group["vertices"] for group in every})
    marks: list[tuple[Artist, str]] = [(Line2D([], [], color="0.4", marker="s", markersize=3,
                                               linestyle=FINER), rf"{meshes[-1]} vertices, at fewer $\Gamma$ (else {meshes[0]})")] \
        if any(fine for _, _, fine in kinds) else []
    marks.append((Line2D([], [], **STAR), r"published, gap $0.2\,\sigma$"))
    return Plate(panels.draw(runner, kinds[0][0].config, found, ["preset"], marks=marks, on_each=draw_published), data)


FILLINGS = [Family("clogging-elastic", "the same density in every array"),
            Family("clogging-filling", "an eighth of the saturated density of each gap")]

figure("6c", "clogging length against line tension for four values of the minimum gap, dilute arrays: "
             "what holds droplets, on two meshes",
       ["clogging-robust", "clogging-robust-mesh", "clogging-friction", "clogging-friction-mesh",
        "clogging-elastic", "clogging-elastic-mesh"], "25 min")(
    lambda runner: families(runner, FAMILIES, True))
figure("6c-filling", "6c without friction at the same density for every gap, "
                     "and at the same share of the saturated density",
       ["clogging-elastic", "clogging-filling"], "5 min, shared with 6c")(
    lambda runner: families(runner, FILLINGS, False))
figure("7c", "clogging length against sag, deformable polygons and soft disk, minimum gap 0.2, dilute arrays",
       ["clogging-robust", "clogging-friction", "clogging-elastic", "clogging-sp"], "shared with 6c, 7a")(
    lambda runner: over_sag(runner, [*((family.config, family.label, family.of)
                                       for family in FAMILIES if runner.has(family.config)),
                                     ("clogging-sp", "soft disk", list)], 0.2, "length"))


# The map

MAPS = [Family("map-robust", "no friction, no corner pinning"), Family("map-friction", "wall friction", 0.05)]


def is_exponential(group: Group) -> bool | None:
    """Whether P(r) is exponential: the shape of a Weibull law is compatible with 1, and lambda is longer than the void
    of the release.
    @return None if there are too few clogs to decide"""
    if group["clogs"] < ENOUGH_CLOGS or group["weibull_p_value"] is None:
        return None
    return group["weibull_p_value"] >= 0.05 and "below_spacing" not in style.doubts(group)


def known_length(group: Group) -> float:
    """The clogging length, or its lower bound if no run clogged."""
    return group["clogging_length_lower"] if group["clogs"] == 0 else group["clogging_length"]


def density_key(group: Group) -> tuple[bool, float]:
    """The key by which densities are sorted. Saturated arrays come last, whatever their density."""
    return (True, 0.0) if group["obstacle_filling"] == "saturated" else (False, group["obstacle_density"])


def place_of(values: Sequence[float], value: float) -> float:
    """The position of a value in a map. All columns are equally wide, and all rows equally high."""
    return float(np.interp(math.log(value), np.log(values), np.arange(len(values))))


def draw_cell(axes: Axes, x: int, y: int, group: Group, norm: LogNorm) -> None:
    length = known_length(group)
    face = style.SCALE(norm(length))
    axes.add_patch(Rectangle((x - 0.5, y - 0.5), 1, 1, facecolor=face, edgecolor="white", linewidth=0.6,
                             hatch="///" if group["clogs"] == 0 else None))
    ink = "black" if norm(length) > 0.55 else "white"
    exponential = is_exponential(group)
    if exponential is not None:
        axes.add_patch(Rectangle((x - 0.43, y - 0.43), 0.86, 0.86, fill=False, edgecolor=ink,
                                 linewidth=1.4 if exponential else 1,
                                 linestyle="-" if exponential else ":"))
    text = f"{float(f'{length:.2g}'):g}" if length < 1e5 else f"{length:.1g}"
    axes.text(x, y, ("> " if group["clogs"] == 0 else "") + text, ha="center", va="center", fontsize=7.5, color=ink,
              bbox={"facecolor": face, "edgecolor": "none", "pad": 0.6})


@figure("map", "clogging length against line tension, obstacle density and gap, walls without and with friction",
        ["map-robust", "map-friction"], "5 min")
def lengths_on_a_map(runner: Runner) -> Plate:
    kinds = [(family, runner.sweep(family.config)) for family in MAPS]
    every = [group for _, groups in kinds for group in groups]
    gaps = sorted({group["obstacle_gap"] for group in every})
    tensions = sorted({group["line_tension"] for group in every})
    lines = sorted({density_key(group) for group in every})
    norm = LogNorm(0.1, max(1e3, *map(known_length, every)), clip=True)
    drawing, panels = style.subplots(len(kinds), len(gaps), figsize=(1.0 + 2.9 * len(gaps), 1.4 + 2.8 * len(kinds)),
                                     sharex=True, sharey=True, squeeze=False)
    data = []
    for (family, groups), row in zip(kinds, panels):
        for (gap, members), axes in zip(by(groups, "obstacle_gap"), row):
            for group in members:
                draw_cell(axes, tensions.index(group["line_tension"]), lines.index(density_key(group)), group, norm)
            gap_label = parameter_label(runner.columns(family.config)["obstacle_gap"], gap)
            axes.set_title(f"{family.label}\n{gap_label}", fontsize=9)
            data += numbers(members, family.config,
                            **of_each(members, "friction", "obstacle_filling", "weibull_shape",
                                      "weibull_p_value", *HOLDS))
        row[0].set_ylabel(r"obstacle density $\rho_\mathrm{ob}\sigma^2$")
    for axes in panels.flat:
        axes.set_xlim(-0.5, len(tensions) - 0.5)
        axes.set_ylim(-0.5, len(lines) - 0.5)
        axes.set_xticks(range(len(tensions)), [f"{value:g}" for value in tensions])
        axes.set_yticks(range(len(lines)),
                        ["saturated" if is_saturated else f"{value:g}" for is_saturated, value in lines])
    for axes in panels[-1]:
        axes.set_xlabel(AXES["line_tension"])
    numbered = [value for is_saturated, value in lines if not is_saturated]
    for axes in [axes for axes, gap in zip(panels.T, gaps) if math.isclose(gap, PUBLISHED["obstacle_gap"])
                 for axes in axes]:
        axes.plot(place_of(tensions, PUBLISHED["line_tension"]) + 0.33,
                  place_of(numbered, PUBLISHED["obstacle_density"]) + 0.28, marker="*", color="black",
                  markerfacecolor="gold", markersize=11)
    drawing.colorbar(ScalarMappable(norm, style.SCALE), ax=panels, label=AXES["length"], shrink=0.8, extend="min")
    drawing.suptitle(describe(runner.columns(MAPS[0].config), every, ["obstacle_density", "preset"]), fontsize=8,
                     color="0.25")
    style.notes_of_panels(drawing, [
        f"frames where {ENOUGH_CLOGS} runs or more clogged: solid if $P(r)$ is exponential "
        "(Weibull's exponent compatible with 1) and $\\lambda$ longer than one obstacle spacing, else dotted",
        "hatched, >: lower bound (no run clogged); "
        "star: the published $\\lambda = 24\\sigma$, at the density that gives this length here"])
    return Plate(drawing, data)
