"""Figures of droplets that hang over obstacles: what holds them, the mesh or a law of walls."""

from collections.abc import Sequence

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from .. import style
from ..drawing.lengths import draw_lengths, length_notes
from ..labels import AXES, said
from ..tools.hints import Group
from .arrays import HOLDS, by, numbers, of_each
from .captions import describe
from .plate import Plate, figure, interface_of
from .workshop import Workshop


def explain(drawing: Figure, shop: Workshop, config: str, groups: Sequence[Group]) -> None:
    """Above the panels what all points have in common, below them what the marks mean."""
    drawing.suptitle(describe(shop.columns(config), groups, ["vertices", "preset"]), fontsize=8, color="0.25")
    style.notes_of_panels(drawing, length_notes(groups, shop.confidence(config), drawing.axes))


def finish(axes: Axes, places: Sequence[float], groups: Sequence[Group], text: str) -> None:
    style.logarithmic_ordinate(axes)
    style.logarithmic_abscissa(axes, places)
    style.grid(axes)
    axes.set_title(text, fontsize=9)
    style.legend(axes, groups)


@figure("W1", "how the clogging length depends on the mesh: line tension, numbers of vertices, interfaces", ["hanging-robust", "hanging-elastic"], "32 min")
def lengths_by_mesh(shop: Workshop) -> Plate:
    configs = ["hanging-robust", "hanging-elastic"]
    presets = [(config, shop.sweep(config)) for config in configs]
    groups = [group for _, members in presets for group in members]
    gaps = by(groups, "obstacle_gap")
    drawing, panels = style.subplots(len(gaps), len(presets), figsize=(5.2 * len(presets), 4.0 * len(gaps)),
                                     sharex=True, sharey=True, squeeze=False)
    data = []
    for (gap, _), line in zip(gaps, panels):
        for (config, members), axes in zip(presets, line):
            families = by([group for group in members if group["obstacle_gap"] == gap], "vertices")
            places = [group["line_tension"] for group in members]
            for index, (vertices, curve) in enumerate(families):
                shift = style.side_by_side(index, len(families), places)
                draw_lengths(axes, [group["line_tension"] * shift for group in curve], curve, index, f"$N_v = {vertices}$")
                data += numbers(curve, f"{config}, gap {gap:g}", **of_each(curve, *HOLDS))
            finish(axes, places, [group for _, curve in families for group in curve],
                   f"{interface_of(members[0]['preset'])}\n{said(shop.columns(config)['obstacle_gap'], gap)}")
        line[0].set_ylabel(AXES["length"])
    for axes in panels[-1]:
        axes.set_xlabel(AXES["line_tension"])
    explain(drawing, shop, configs[0], groups)
    return Plate(drawing, data)


@figure("W2", "the clogging length with friction of walls: line tension, coefficients of friction, numbers of vertices", ["hanging-friction"], "60 min")
def lengths_by_friction(shop: Workshop) -> Plate:
    config = "hanging-friction"
    groups = shop.sweep(config)
    columns = shop.columns(config)
    gaps = by(groups, "obstacle_gap")
    meshes = sorted({group["vertices"] for group in groups})
    drawing, panels = style.subplots(1, len(gaps), figsize=(6.8 * len(gaps), 5.4), sharey=True, squeeze=False)
    data = []
    for (gap, members), axes in zip(gaps, panels[0]):
        places = [group["line_tension"] for group in members]
        families = by(members, "friction")
        for index, (friction, family) in enumerate(families):
            # A colour for every friction; coarser meshes are dashed, finest is whole.
            for vertices, curve in by(family, "vertices"):
                mesh = meshes.index(vertices)
                shift = style.side_by_side(index * len(meshes) + mesh, len(families) * len(meshes), places)
                line: str | tuple[int, tuple[int, ...]] = "-" if vertices == meshes[-1] else (0, (4, 1 + mesh))
                draw_lengths(axes, [group["line_tension"] * shift for group in curve], curve, index,
                             f"{said(columns['friction'], friction)}, $N_v = {vertices}$", line)
                data += numbers(curve, f"friction {friction:g}, gap {gap:g}", **of_each(curve, "friction", *HOLDS))
        of_gap = f"\n{said(columns['obstacle_gap'], gap)}" if len(gaps) > 1 else ""  # one gap stands above all panels
        finish(axes, places, members, interface_of(groups[0]["preset"]) + of_gap)
        axes.set_xlabel(AXES["line_tension"])
    panels[0][0].set_ylabel(AXES["length"])
    explain(drawing, shop, config, groups)
    return Plate(drawing, data)
