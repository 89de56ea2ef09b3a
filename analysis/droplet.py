#!/usr/bin/python3
"""Draws a droplet among obstacles: several moments of one run in one picture, or a film of it.

    clogrun array --output run.h5 --polygon-interval 5 line-tension=0.3 seeds=4
    analysis/droplet.py run.h5 --output droplet
    analysis/droplet.py run.h5 --output droplet --film --colour speed

The flow goes to the right. In a picture the last outline is filled; earlier ones are thin, evenly spaced along the way,
coloured by time. A film is DROPLET.mp4 if ffmpeg is there, DROPLET.gif if Pillow is, and numbered pictures in the folder
DROPLET-frames with --pictures. In it the way of the centre is a line, and the droplet has the colour of its interface's speed or,
with --colour mechanism, of how it ended.
"""

import pathlib
import shutil
import sys

import command_line
from command_line import UserError

with command_line.needs_modules():
    import matplotlib
    import numpy as np
    import style
    import trajectory
    from matplotlib import animation
    from matplotlib.collections import LineCollection
    from style import plt

MECHANISM_COLOURS = {"wrapped": style.COLOURS[0], "squeezed": style.COLOURS[1], "hybrid": style.COLOURS[2]}


def view(run):
    """Corners of what the droplet comes to."""
    return run.polygons.min(axis=(0, 2)) - 0.5, run.polygons.max(axis=(0, 2)) + 0.5


def canvas(run):
    low, high = view(run)
    width, height = high - low
    figure_width = min(12.0, max(5.0, 2.2 * width))
    figure, axes = plt.subplots(
        figsize=(figure_width, max(3.0, figure_width * height / width + 1.2)), layout="constrained"
    )
    trajectory.draw_surroundings(axes, run)
    trajectory.frame_limits(axes, low, high)
    axes.set_xlabel(r"$x/\sigma$, along the flow")
    axes.set_ylabel(r"$y/\sigma$")
    row = run.row
    where = rf", $w_\mathrm{{ob}} = {row['obstacle_gap']:.3g}\sigma$" if np.isfinite(row["obstacle_gap"]) else ""
    what = rf"$\Gamma = {row['line_tension']:g}$" if run.word("model") == "dp" else rf"$E_w = {row['wall_stiffness']:g}$"
    axes.set_title(
        rf"{what}{where}, seed {row['seed']}: {run.word('status')} at $r = {row['distance']:.2f}\sigma$", fontsize=9
    )
    return figure, axes


def draw(run, num_outlines):
    figure, axes = canvas(run)
    chosen = trajectory.along_the_way(run.polygons, num_outlines)
    colours = plt.get_cmap("viridis")
    for frame in chosen:
        x, y = run.polygons[frame]
        share = run.times[frame] / run.times[-1] if run.times[-1] > 0 else 1.0
        is_last = frame == chosen[-1]
        axes.fill(
            x, y, facecolor=style.DROPLET if is_last else "none", alpha=0.75 if is_last else 1.0,
            edgecolor="black" if is_last else colours(share), linewidth=1.0, zorder=3 if is_last else 2,
        )
    scale = plt.cm.ScalarMappable(matplotlib.colors.Normalize(0, run.times[-1]), cmap=colours)
    figure.colorbar(scale, ax=axes, label=r"$t/t_0$", fraction=0.03, pad=0.01)
    return figure


class Film:
    """One canvas whose droplet moves from frame to frame."""

    def __init__(self, run, colour):
        self._run = run
        self.figure, axes = canvas(run)
        self._centres = run.polygons.mean(axis=2)
        self._way, = axes.plot([], [], color="0.3", linewidth=1, linestyle="--")
        mechanism = run.word("mechanism") if "mechanism" in run.row.dtype.names else ""
        face = MECHANISM_COLOURS.get(mechanism, "0.5") if colour == "mechanism" else "white"
        self._inside, = axes.fill([0], [0], facecolor=face, alpha=0.6, zorder=3)
        self._outline = LineCollection([], cmap="viridis", linewidth=2, zorder=4)
        self._speeds = None
        if colour == "speed":
            self._speeds = trajectory.interface_speeds(run) / run.row["terminal_speed"]
            # A few fast moments would leave the rest dark.
            self._outline.set_norm(matplotlib.colors.Normalize(0, max(1e-3, np.percentile(self._speeds, 98))))
            self.figure.colorbar(self._outline, ax=axes, label="speed of the interface $/v_t$", fraction=0.03, pad=0.01)
        else:
            self._outline.set_color("black")
            axes.text(0.01, 0.02, mechanism or "mechanism not known", transform=axes.transAxes, fontsize=8)
        axes.add_collection(self._outline)
        self._clock = axes.text(0.01, 0.97, "", transform=axes.transAxes, va="top", fontsize=9,
                                bbox={"facecolor": "white", "edgecolor": "none", "alpha": 0.8, "pad": 2})
        # Laid out once: frames stay in register, and are drawn faster.
        self.figure.canvas.draw()
        self.figure.set_layout_engine("none")

    def show(self, frame):
        polygon = self._run.polygons[frame].T
        self._way.set_data(*self._centres[: frame + 1].T)
        self._inside.set_xy(polygon)
        self._outline.set_segments(np.stack([polygon, np.roll(polygon, -1, axis=0)], axis=1))
        if self._speeds is not None:
            self._outline.set_array(self._speeds[frame])
        self._clock.set_text(rf"$t = {self._run.times[frame]:.4g}\,t_0$")
        return []


def write_film(film, num_frames, output, rate):
    """@return the file written"""
    if shutil.which("ffmpeg"):
        # Even numbers of pixels are what players ask of H.264.
        path, writer = f"{output}.mp4", animation.FFMpegWriter(
            fps=rate, extra_args=["-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2", "-pix_fmt", "yuv420p"])
    else:
        path, writer = f"{output}.gif", animation.PillowWriter(fps=rate)
    animation.FuncAnimation(film.figure, film.show, frames=num_frames, blit=False).save(path, writer=writer, dpi=100)
    return path


def write_frames(film, num_frames, folder):
    folder.mkdir(parents=True, exist_ok=True)
    for frame in range(num_frames):
        film.show(frame)
        film.figure.savefig(folder / f"{frame:05d}.png", dpi=100)
    return folder


def body():
    parser = command_line.Parser(__doc__)
    parser.add_argument("run", type=pathlib.Path, help="output of clogrun with --polygon-interval")
    parser.add_argument("--output", type=pathlib.Path, required=True, help="name without ending; .png and .pdf are made")
    parser.add_argument("--outlines", type=int, default=12, help="how many moments to show in a picture (12)")
    parser.add_argument("--film", action="store_true", help="a film instead: .mp4 (ffmpeg) or .gif")
    parser.add_argument("--pictures", action="store_true", help="numbered pictures in OUTPUT-frames instead")
    parser.add_argument("--colour", choices=["speed", "mechanism"], default="speed", help="of the droplet in a film (speed)")
    parser.add_argument("--rate", type=int, default=20, help="frames of a film a second (20)")
    arguments = parser.parse_args()
    if arguments.rate < 1 or arguments.outlines < 1:
        raise UserError("--rate and --outlines must be positive")
    if not arguments.output.parent.is_dir():
        raise UserError(f"no folder {arguments.output.parent}; make it first")
    try:
        run = trajectory.read(arguments.run)
    except ValueError as error:
        raise UserError(error) from error
    if not arguments.film and not arguments.pictures:
        style.save(draw(run, arguments.outlines), arguments.output)
        return 0
    film = Film(run, arguments.colour)
    if arguments.film:
        print(write_film(film, len(run.times), arguments.output, arguments.rate))
    if arguments.pictures:
        print(write_frames(film, len(run.times), pathlib.Path(f"{arguments.output}-frames")))
    return 0


if __name__ == "__main__":
    sys.exit(command_line.run(body))
