"""Figures of droplets that hang over obstacles: what holds them, the mesh or a law of walls."""

import style
from groups import said
from paper.arrays import by, numbers
from paper.plate import Plate, figure, interface_of
from style import plt


@figure("W1", "what of the clogging length is the mesh's: line tension, numbers of vertices, interfaces", ["hanging-robust", "hanging-elastic"], "32 min")
def lengths_by_mesh(shop):
    configs = ["hanging-robust", "hanging-elastic"]
    presets = [(config, shop.sweep(config)) for config in configs]
    groups = [group for _, members in presets for group in members]
    gaps = by(groups, "obstacle_gap")
    drawing, panels = plt.subplots(len(gaps), len(presets), figsize=(5.2 * len(presets), 4.0 * len(gaps)), layout="constrained",
                                   sharex=True, sharey=True, squeeze=False)
    data = []
    for (gap, _), line in zip(gaps, panels):
        for (config, members), axes in zip(presets, line):
            families = by([group for group in members if group["obstacle_gap"] == gap], "vertices")
            places = [group["line_tension"] for group in members]
            for index, (vertices, curve) in enumerate(families):
                shift = style.side_by_side(index, len(families), places)
                style.draw_lengths(axes, [group["line_tension"] * shift for group in curve], curve, index, f"$N_v = {vertices}$")
                data += numbers(curve, f"{config}, gap {gap:g}", vertices=[vertices] * len(curve),
                                on_mesh=[group["on_mesh"] for group in curve], wrapped=[group["wrapped"] for group in curve],
                                squeezed=[group["squeezed"] for group in curve], hybrid=[group["hybrid"] for group in curve])
            axes.set_yscale("log")
            style.logarithmic_abscissa(axes, places)
            style.grid(axes)
            axes.set_title(f"{interface_of(members[0]['preset'])}\n{said(shop.columns(config)['obstacle_gap'], gap)}", fontsize=9)
            style.legend(axes, [group for _, curve in families for group in curve])
        line[0].set_ylabel(style.AXES["length"])
    for axes in panels[-1]:
        axes.set_xlabel(style.AXES["line_tension"])
    note = style.length_note(groups, shop.confidence(configs[0]))
    drawing.suptitle(f"{style.runs_a_point(groups)}; saturated arrays, obstacles of {groups[0]['obstacle_diameter']:g}$\\sigma$, "
                     f"$T = {groups[0]['max_time']:g}\\,t_0$\n{note}", fontsize=8, color="0.25")
    return Plate(drawing, data)


@figure("W2", "the clogging length with friction of walls: line tension, coefficients of friction, numbers of vertices", ["hanging-friction"], "60 min")
def lengths_by_friction(shop):
    config = "hanging-friction"
    groups = shop.sweep(config)
    columns = shop.columns(config)
    gaps = by(groups, "obstacle_gap")
    meshes = sorted({group["vertices"] for group in groups})
    drawing, panels = plt.subplots(1, len(gaps), figsize=(6.8 * len(gaps), 5.4), layout="constrained", sharey=True, squeeze=False)
    data = []
    for (gap, members), axes in zip(gaps, panels[0]):
        places = [group["line_tension"] for group in members]
        families = by(members, "friction")
        for index, (friction, family) in enumerate(families):
            # A colour for every friction; coarser meshes are dashed, finest is whole.
            for vertices, curve in by(family, "vertices"):
                mesh = meshes.index(vertices)
                shift = style.side_by_side(index * len(meshes) + mesh, len(families) * len(meshes), places)
                line = "-" if vertices == meshes[-1] else (0, (4, 1 + mesh))
                style.draw_lengths(axes, [group["line_tension"] * shift for group in curve], curve, index,
                                   f"{said(columns['friction'], friction)}, $N_v = {vertices}$", line)
                data += numbers(curve, f"friction {friction:g}, gap {gap:g}", vertices=[vertices] * len(curve), friction=[friction] * len(curve),
                                on_mesh=[group["on_mesh"] for group in curve], wrapped=[group["wrapped"] for group in curve],
                                squeezed=[group["squeezed"] for group in curve], hybrid=[group["hybrid"] for group in curve])
        axes.set_yscale("log")
        style.logarithmic_abscissa(axes, places)
        style.grid(axes)
        axes.set_title(said(columns["obstacle_gap"], gap), fontsize=9)
        axes.set_xlabel(style.AXES["line_tension"])
        style.legend(axes, members)
    panels[0][0].set_ylabel(style.AXES["length"])
    note = style.length_note(groups, shop.confidence(config))
    drawing.suptitle(f"interface: {interface_of(groups[0]['preset'])}; {style.runs_a_point(groups)}; saturated arrays, "
                     f"obstacles of {groups[0]['obstacle_diameter']:g}$\\sigma$, $T = {groups[0]['max_time']:g}\\,t_0$\n{note}", fontsize=8, color="0.25")
    return Plate(drawing, data)
