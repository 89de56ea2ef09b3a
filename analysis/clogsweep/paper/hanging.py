"""Draws figures of droplets that hang over obstacles, and shows whether the mesh or the wall holds them."""

import math
from collections.abc import Iterator, Sequence

import numpy as np
from matplotlib.collections import LineCollection
from matplotlib.patches import Circle

from .. import style
from ..drawing import surroundings
from ..labels import interface_of, parameter_label
from ..reading.trajectory import Trajectory
from ..tools.hints import Group, Numbers
from . import panels
from .arrays import HOLDS, by, numbers, of_each
from .plate import Plate, figure
from .runner import Runner

# The post: x, y and diameter [sigma]. A droplet falls onto the post from 7 sigma upstream, along a path that is
# 0.08 sigma beside the centre of the post.
POST = (47.0, 5.08, 0.3)
# Vertices that are closer to the post's surface than this belong to a part of the interface over the post [sigma].
NEAR = 0.12


def by_mesh(runner: Runner, config: str, kinds: Sequence[tuple[str, Sequence[Group]]], without: Sequence[str]) -> Plate:
    """Draws a panel for each kind, with a curve for each mesh.
    @param kinds  for each panel, words that distinguish it, and its groups
    @param config, without  see panels.draw()"""
    meshes = sorted({group["vertices"] for _, groups in kinds for group in groups})
    found: list[panels.Panel] = [(title, [(curve, meshes.index(vertices), f"{vertices} vertices", {})
                                          for vertices, curve in by(groups, "vertices")]) for title, groups in kinds]
    data = [row for title, groups in kinds
            for row in numbers(groups, title.replace("\n", ", "), **of_each(groups, "vertices", "friction", *HOLDS))]
    return Plate(panels.draw(runner, config, found, ["vertices", *without]), data)


@figure("W1", "how the clogging length depends on the mesh: line tension, numbers of vertices, interfaces",
        ["hanging-robust", "hanging-elastic"], "5 min")
def lengths_by_mesh(runner: Runner) -> Plate:
    sweeps = {config: by(runner.sweep(config), "obstacle_gap") for config in ("hanging-robust", "hanging-elastic")}
    kinds = [(f"{interface_of(groups[0]['preset'])}\n"
              f"{parameter_label(runner.columns(config)['obstacle_gap'], gap)}", groups)
             for of_gap in zip(*([(config, *one) for one in found] for config, found in sweeps.items()))
             for config, gap, groups in of_gap]
    return by_mesh(runner, "hanging-robust", kinds, ["preset", "obstacle_gap"])


@figure("W2", "the clogging length with friction of walls: line tension, coefficients of friction, numbers of vertices",
        ["hanging-friction"], "5 min")
def lengths_by_friction(runner: Runner) -> Plate:
    config = "hanging-friction"
    kinds = [(f"wall friction {friction:g}", groups)
             for friction, groups in by(runner.sweep(config), "friction")]
    return by_mesh(runner, config, kinds, [])


def over_a_post(runner: Runner, films: str) -> Trajectory:
    """Replays a droplet that hangs over a post. The lobes on the two sides have unequal weights. @param films  value of
    film-friction"""
    obstacles = runner.table("post", ["x", "y", "diameter"], [POST])
    row, = runner.runs(f"post-{films}", None, {
        "obstacles": obstacles, "box": 10, "boxes": 8, "preset": "elastic", "line-tension": 0.05,
        "friction": 0.3, "film-friction": films,
        "vertices": 512, "max-time": 2600, "seeds": 1})
    return runner.ways(f"post-{films}", [row], 20, 20)[0]


def tensions(vertices: Numbers, row: np.void) -> Numbers:
    """The tensions of the edges of a polygon with springs [g rho sigma^2]. A spring pulls its edge towards its length
    at rest.
    @param vertices  2 x N_v [sigma]"""
    number = vertices.shape[1]
    lengths = np.hypot(*(np.roll(vertices, -1, axis=1) - vertices))
    # Length of an edge of a regular polygon with the droplet's area.
    at_rest = math.sqrt(math.pi * math.tan(math.pi / number) / number)
    return row["line_tension"] + row["perimeter_stiffness"] * number * (lengths - at_rest)


def interfaces(vertices: Numbers) -> Iterator[Numbers]:
    """The indices of the parts of an outline that are over the post. The part that touches the post comes first."""
    apart = np.hypot(vertices[0] - POST[0], vertices[1] - POST[1])
    begin = int(np.argmax(apart))  # The outline begins in a lobe, so that no part is cut in two.
    around = np.roll(np.arange(apart.size), -begin)
    near = around[apart[around] < POST[2] / 2 + NEAR]
    breaks = np.flatnonzero(np.diff((near - begin) % apart.size) > 1) + 1
    yield from sorted(np.split(near, breaks), key=lambda part: apart[part].min())


@figure("W3", "a droplet over a post: the tensions of its two interfaces, "
              "with friction on both of them and on the lower one alone", [], "1 min")
def tensions_over_a_post(runner: Runner) -> Plate:
    held, slides = over_a_post(runner, "on"), over_a_post(runner, "off")
    drawing, (left, right) = style.subplots(1, 2, figsize=(9.6, 3.8), width_ratios=[1.3, 1])
    last = held.polygons[-1][:, ::2]  # Without the middles of the edges.
    # One droplet is held, and the other slides past the same position. `passing` is the outline of the other droplet at
    # this position.
    beyond = slides.polygons[:, 0].mean(axis=1) - held.polygons[-1][0].mean()
    passing = slides.polygons[int(np.argmin(np.abs(beyond)))][:, ::2]
    edges = np.stack([last.T, np.roll(last, -1, axis=1).T], axis=1) - POST[:2]
    line = left.add_collection(LineCollection(edges, array=tensions(last, held.row) / held.row["line_tension"],
                                              cmap=style.SCALE, linewidth=1.8))
    drawing.colorbar(line, ax=left, label=r"tension/$\Gamma$")
    left.add_patch(Circle((0, 0), POST[2] / 2, color="0.8"))
    surroundings.frame_limits(left, (-0.4, -0.9), (4.2, 0.9))
    left.set_xlabel(r"$x/\sigma$ from the post, along gravity")
    left.set_ylabel(r"$y/\sigma$")
    data = []
    for label, run, vertices, dashes in (("both", held, last, "o-"), ("the lower one", slides, passing, "o--")):
        for interface, part, colour in zip(("lower", "upper"), interfaces(vertices), style.COLOURS):
            angles = np.degrees(np.arctan2(vertices[1, part] - POST[1], POST[0] - vertices[0, part]))
            values = tensions(vertices, run.row)[part] / run.row["line_tension"]
            right.plot(angles, values, dashes, color=colour, markersize=3.5, label=f"{interface}, {label}")
            data += [{"friction on": label, "interface": interface, "angle": angle, "tension": value}
                     for angle, value in zip(angles, values)]
    right.set_xlabel("angle around the post from its top [degrees]")
    right.set_ylabel(r"tension/$\Gamma$")
    style.grid(right)
    row = held.row
    drawing.suptitle(f"line tension {row['line_tension']:g}, friction {row['friction']:g}, "
                     f"{row['vertices']} vertices, {interface_of(held.word('preset'))}; "
                     "the lower interface touches the post; left: friction on both", fontsize=9, color="0.25")
    style.legend(right, title="interface, friction on")
    return Plate(drawing, data)
