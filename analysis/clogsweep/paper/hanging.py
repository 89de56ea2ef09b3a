"""Figures of droplets that hang over obstacles: whether the mesh or the wall holds them."""

import math
from collections.abc import Iterator, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.patches import Circle

from .. import style
from ..drawing import surroundings
from ..drawing.lengths import draw_lengths, length_notes
from ..labels import AXES, said
from ..reading.trajectory import Trajectory
from ..tools.hints import Group, Numbers
from .arrays import HOLDS, by, numbers, of_each
from .captions import describe
from .plate import Plate, figure, interface_of
from .workshop import Workshop

# x, y, diameter [sigma]: a droplet falls on it from 7 sigma above, beside its centre by 0.08.
POST = (47.0, 5.08, 0.3)
# Touching the post or the interface on it [sigma].
NEAR = 0.12


def explain(drawing: Figure, shop: Workshop, config: str, groups: Sequence[Group]) -> None:
    """Common parameters of all points above the panels, the meaning of the marks below them."""
    drawing.suptitle(describe(shop.columns(config), groups, ["vertices", "preset"]), fontsize=8, color="0.25")
    style.notes_of_panels(drawing, length_notes(groups, shop.confidence(config), drawing.axes))


def finish(axes: Axes, places: Sequence[float], groups: Sequence[Group], text: str) -> None:
    style.logarithmic_ordinate(axes)
    style.logarithmic_abscissa(axes, places)
    style.grid(axes)
    axes.set_title(text, fontsize=9)
    style.legend(axes, groups)


@figure("W1", "how the clogging length depends on the mesh: line tension, numbers of vertices, interfaces", ["hanging-robust", "hanging-elastic"], "5 min")
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


@figure("W2", "the clogging length with friction of walls: line tension, coefficients of friction, numbers of vertices", ["hanging-friction"], "5 min")
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
            # A colour for every friction; coarser meshes are dashed, the finest is solid.
            for vertices, curve in by(family, "vertices"):
                mesh = meshes.index(vertices)
                shift = style.side_by_side(index * len(meshes) + mesh, len(families) * len(meshes), places)
                line: str | tuple[int, tuple[int, ...]] = "-" if vertices == meshes[-1] else (0, (4, 1 + mesh))
                draw_lengths(axes, [group["line_tension"] * shift for group in curve], curve, index,
                             f"{said(columns['friction'], friction)}, $N_v = {vertices}$", line)
                data += numbers(curve, f"friction {friction:g}, gap {gap:g}", **of_each(curve, "friction", *HOLDS))
        of_gap = f"\n{said(columns['obstacle_gap'], gap)}" if len(gaps) > 1 else ""  # a common gap is printed above all panels
        finish(axes, places, members, interface_of(groups[0]["preset"]) + of_gap)
        axes.set_xlabel(AXES["line_tension"])
    panels[0][0].set_ylabel(AXES["length"])
    explain(drawing, shop, config, groups)
    return Plate(drawing, data)


def over_a_post(shop: Workshop, films: str) -> Trajectory:
    """A droplet of two lobes of unequal weight over a post. @param films  value of film-friction"""
    obstacles = shop.table("post", ["x", "y", "diameter"], [POST])
    row, = shop.runs(f"post-{films}", None, {
        "obstacles": obstacles, "box": 10, "boxes": 8, "preset": "elastic", "line-tension": 0.05, "friction": 0.3, "film-friction": films,
        "vertices": 512, "max-time": 2600, "seeds": 1})
    return shop.ways(f"post-{films}", [row], 20, 20)[0]


def tensions(vertices: Numbers, row: np.void) -> Numbers:
    """Tensions of the edges of a polygon whose springs pull them to their length at rest [g rho sigma^2].
    @param vertices  2 x N_v [sigma]"""
    number = vertices.shape[1]
    lengths = np.hypot(*(np.roll(vertices, -1, axis=1) - vertices))
    at_rest = math.sqrt(math.pi * math.tan(math.pi / number) / number)  # of a regular polygon as large as the droplet
    return row["line_tension"] + row["perimeter_stiffness"] * number * (lengths - at_rest)


def interfaces(vertices: Numbers) -> Iterator[Numbers]:
    """Indices of the parts of a contour over the post, the one that touches it first."""
    apart = np.hypot(vertices[0] - POST[0], vertices[1] - POST[1])
    begin = int(np.argmax(apart))  # in a lobe, so that no part is cut in two
    around = np.roll(np.arange(apart.size), -begin)
    near = around[apart[around] < POST[2] / 2 + NEAR]
    breaks = np.flatnonzero(np.diff((near - begin) % apart.size) > 1) + 1
    yield from sorted(np.split(near, breaks), key=lambda part: apart[part].min())


@figure("W3", "a droplet over a post: the tensions of its two interfaces, with friction on both of them and on the lower one alone", [], "1 min")
def tensions_over_a_post(shop: Workshop) -> Plate:
    held, slides = over_a_post(shop, "on"), over_a_post(shop, "off")
    drawing, (left, right) = style.subplots(1, 2, figsize=(9.6, 3.8), width_ratios=[1.3, 1])
    last = held.polygons[-1][:, ::2]  # without the middles of edges
    # The other one passes here on its way.
    passing = slides.polygons[int(np.argmin(np.abs(slides.polygons[:, 0].mean(axis=1) - held.polygons[-1][0].mean())))][:, ::2]
    edges = np.stack([last.T, np.roll(last, -1, axis=1).T], axis=1) - POST[:2]
    line = left.add_collection(LineCollection(edges, array=tensions(last, held.row) / held.row["line_tension"], cmap="viridis", linewidth=1.8))
    drawing.colorbar(line, ax=left, label=r"tension/$\Gamma$")
    left.add_patch(Circle((0, 0), POST[2] / 2, color="0.8"))
    surroundings.frame_limits(left, (-0.4, -0.9), (4.2, 0.9))
    left.set_xlabel(r"$x/\sigma$ from the post, along gravity")
    data = []
    for label, run, vertices, dashes in (("both", held, last, "-"), ("the lower one", slides, passing, "--")):
        for interface, part, colour in zip(("lower", "upper"), interfaces(vertices), style.COLOURS):
            angles = np.degrees(np.arctan2(vertices[1, part] - POST[1], POST[0] - vertices[0, part]))
            values = tensions(vertices, run.row)[part] / run.row["line_tension"]
            right.plot(angles, values, dashes, color=colour, label=f"{interface} interface, friction on {label}")
            data += [{"friction on": label, "interface": interface, "angle": angle, "tension": value} for angle, value in zip(angles, values)]
    right.set_xlabel("angle around the post from its top [degrees]")
    right.set_ylabel(r"tension/$\Gamma$")
    style.grid(right)
    right.legend(frameon=False, fontsize=7)
    return Plate(drawing, data)
