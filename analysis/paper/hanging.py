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
