#!/usr/bin/env python3
"""Draws a droplet among obstacles at several moments of one run.

    clogrun array --output run.h5 --polygon-interval 20 line-tension=0.3 seeds=4
    analysis/droplet.py run.h5 --output droplet

The flow goes to the right. The last outline is filled; earlier ones are thin, evenly spaced along the way, coloured by
time.
"""

import argparse
import pathlib
import sys

import h5py
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import PatchCollection
from matplotlib.patches import Circle


def draw(polygons, times, obstacles, row, num_outlines):
    # Evenly along the way, not in time: a clogged droplet stands still for most of its run.
    centres = polygons.mean(axis=2)
    way = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(centres, axis=0).T))])
    chosen = np.unique(np.searchsorted(way, np.linspace(0, way[-1], num_outlines)).clip(max=len(times) - 1))
    chosen = np.unique(np.append(chosen, len(times) - 1))
    low = polygons.min(axis=(0, 2)) - 0.5
    high = polygons.max(axis=(0, 2)) + 0.5
    width, height = high - low
    figure_width = min(12.0, max(5.0, 2.2 * width))
    figure, axes = plt.subplots(
        figsize=(figure_width, max(3.0, figure_width * height / width + 1.2)), layout="constrained"
    )
    circles = [Circle((x, y), diameter / 2) for x, y, diameter in obstacles]
    axes.add_collection(PatchCollection(circles, facecolor="0.72", edgecolor="none"))
    colours = plt.get_cmap("viridis")
    for frame in chosen:
        x, y = polygons[frame]
        share = times[frame] / times[-1] if times[-1] > 0 else 1.0
        is_last = frame == chosen[-1]
        axes.fill(
            x, y, facecolor="#D55E00" if is_last else "none", alpha=0.75 if is_last else 1.0,
            edgecolor="black" if is_last else colours(share), linewidth=1.0, zorder=3 if is_last else 2,
        )
    axes.set_xlim(low[0], high[0])
    axes.set_ylim(low[1], high[1])
    axes.set_aspect("equal")
    axes.set_xlabel(r"$x/\sigma$, along the flow")
    axes.set_ylabel(r"$y/\sigma$")
    scale = plt.cm.ScalarMappable(matplotlib.colors.Normalize(0, times[-1]), cmap=colours)
    figure.colorbar(scale, ax=axes, label=r"$t/t_0$", fraction=0.03, pad=0.01)
    axes.set_title(
        rf"$\Gamma = {row['line_tension']:g}$, $w_\mathrm{{ob}} = {row['obstacle_gap']:.3g}\sigma$, "
        rf"seed {row['seed']}: {row['status'].decode()} at $r = {row['distance']:.2f}\sigma$",
        fontsize=9,
    )
    return figure


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("run", type=pathlib.Path, help="output of clogrun with --polygon-interval")
    parser.add_argument("--output", type=pathlib.Path, required=True, help="name without ending; .png and .pdf are made")
    parser.add_argument("--outlines", type=int, default=12, help="how many moments to show")
    arguments = parser.parse_args()
    try:
        with h5py.File(arguments.run, "r") as file:
            polygons, times = file["polygons"][:], file["polygon_times"][:]
            obstacles = file["obstacles"][:] if "obstacles" in file else []
            row = file["runs"][0]
    except (OSError, KeyError) as error:
        sys.exit(f"droplet.py: cannot read {arguments.run} ({error}); give the output of clogrun with --polygon-interval")
    figure = draw(polygons, times, obstacles, row, max(1, arguments.outlines))
    figure.savefig(arguments.output.with_suffix(".png"), dpi=140, bbox_inches="tight")
    figure.savefig(arguments.output.with_suffix(".pdf"), bbox_inches="tight")


if __name__ == "__main__":
    main()
