"""Draws docs/pictures/sketch.png: a squeezed and a wrapped droplet among posts, with the quantities of the README.

    PYTHONPATH=analysis /usr/bin/python3 docs/gallery/sketch.py build/release/bin

Both droplets are runs of clogrun, with the keys of jobs/laptop.cfg.
"""

import pathlib
import subprocess
import sys
import tempfile

import numpy as np
from clogsweep import style
from clogsweep.drawing import surroundings
from clogsweep.reading import trajectory
from clogsweep.reading.trajectory import with_middles
from PIL import Image

PICTURE = pathlib.Path(__file__).resolve().parents[1] / "pictures/sketch.png"
KEYS = ["preset=elastic", "vertices=256", "obstacle-gap=0.3", "obstacle-density=65%", "box=50", "boxes=4",
        "max-time=6000", "inertia=4"]
DROPLETS = {"squeezed": ["line-tension=0.5", "seeds=3"], "wrapped": ["friction=0.1", "line-tension=0.1", "seeds=8"]}
TITLES = {"squeezed": "squeezed: posts hold a stiff droplet in their gaps",
          "wrapped": "wrapped: friction holds a soft droplet on a post"}
WIDTH, HEIGHT = 6.3, 2.6  # of a panel [sigma]
# The handbook may show the picture at 360 pixels. There this text is 10 pixels high.
TEXT = 15
ARROW = {"arrowstyle": "<|-|>", "linewidth": 1.4, "color": "black", "shrinkA": 0, "shrinkB": 0, "mutation_scale": 12}


def computed(name, programs, folder):
    output = folder / f"{name}.h5"
    subprocess.run([programs / "clogrun", "array", *KEYS, *DROPLETS[name], "--polygon-interval", "2",
                    "--output", output], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    return trajectory.read(output)


def text(axes, x, y, words, **options):
    axes.text(x, y, words, fontsize=TEXT, zorder=7, path_effects=[surroundings.HALO],
              **{"ha": "center", "va": "center", **options})


def between(axes, start, end):
    """A dimension line with an arrowhead at both ends."""
    axes.annotate("", end, start, arrowprops=ARROW, zorder=7)


def narrowest(run, outline):
    """The ends of the narrowest gap between two obstacles that touch the droplet."""
    apart = np.hypot(*(outline[:, None, :] - run.obstacles[:, :2].T[:, :, None])).min(axis=1) - run.obstacles[:, 2] / 2
    holding = run.obstacles[apart < 0.03]
    pairs = [(one, other) for i, one in enumerate(holding) for other in holding[:i]]
    one, other = min(pairs, key=lambda pair: np.hypot(*(pair[0] - pair[1])[:2]))
    along = (other - one)[:2] / np.hypot(*(other - one)[:2])
    return one[:2] + one[2] / 2 * along, other[:2] - other[2] / 2 * along


def draw(axes, name, run):
    start, end = (run.polygons[frame].mean(axis=1) for frame in (0, -1))
    outline = with_middles(run.polygons[-1])
    surroundings.draw_surroundings(axes, run)
    axes.fill(*with_middles(run.polygons[0]), facecolor="none", edgecolor="0.4", linestyle="--", linewidth=1.5)
    axes.fill(*outline, facecolor=style.MECHANISM_COLOURS[name], alpha=0.85, edgecolor="black", linewidth=1.2, zorder=3)
    centres = np.array([polygon.mean(axis=1) for polygon in run.polygons])
    axes.plot(*centres.T, color="black", linewidth=1.4, zorder=4)
    low = np.array([start[0] - 0.75, start[1] - HEIGHT / 2])
    surroundings.frame_limits(axes, low, low + (WIDTH, HEIGHT))
    axes.set_xticks([])
    axes.set_yticks([])
    axes.set_title(TITLES[name], fontsize=TEXT, loc="left")
    level = low[1] + 0.3
    for x in (start[0], end[0]):
        axes.plot([x, x], [level - 0.12, start[1]], color="0.3", linewidth=0.9, linestyle=":", zorder=4)
    between(axes, (start[0], level), (end[0], level))
    text(axes, (start[0] + end[0]) / 2, level + 0.03, "distance $r$", va="bottom")
    if name == "squeezed":
        between(axes, start - (0.5, 0), start + (0.5, 0))
        text(axes, *(start + (0, 0.05)), r"$\sigma$", va="bottom")
        ends = narrowest(run, outline)
        middle = np.mean(ends, axis=0)
        axes.annotate("gap", middle, (low[0] + WIDTH - 0.75, low[1] + 0.45), fontsize=TEXT, ha="center", zorder=7,
                      arrowprops={"arrowstyle": "-", "color": "black", "shrinkB": 0})
        axes.plot(*np.transpose(ends), color="black", linewidth=2.5, zorder=6)
    else:
        post = min(run.obstacles, key=lambda circle: np.hypot(*(circle[:2] - low - (WIDTH - 1.4, HEIGHT / 2))))
        text(axes, post[0], post[1] - 0.22, "post", va="top")
        corner = low + (WIDTH, HEIGHT)
        axes.annotate("gravity", corner - (0.2, 0.35), corner - (2.2, 0.35), fontsize=TEXT, va="center", ha="center",
                      zorder=7, arrowprops={**ARROW, "arrowstyle": "-|>", "linewidth": 2, "mutation_scale": 18,
                                            "shrinkA": 8})


def main(programs):
    figure, panels = style.subplots(2, 1, figsize=(7.6, 7.4))
    with tempfile.TemporaryDirectory() as folder:
        for name, axes in zip(DROPLETS, panels):
            draw(axes, name, computed(name, pathlib.Path(programs).resolve(), pathlib.Path(folder)))
    figure.supxlabel(r"clogging length $\lambda$: the mean distance $r$ of many droplets", fontsize=TEXT)
    style.save(figure, PICTURE.with_suffix(""), dpi=100)
    PICTURE.with_suffix(".pdf").unlink()
    Image.open(PICTURE).convert("RGB").quantize(128).save(PICTURE, optimize=True)


main(*sys.argv[1:])
