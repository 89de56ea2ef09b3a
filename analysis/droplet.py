#!/usr/bin/python3
"""Draws a droplet among obstacles: several moments of one run in one picture, or a film of it.

    clogrun array --output run.h5 --polygon-interval 5 line-tension=0.3 seeds=4
    analysis/droplet.py run.h5 --output droplet
    analysis/droplet.py run.h5 --output droplet --film --colour speed

The flow goes to the right. In a picture the last outline is filled; earlier ones are thin, evenly spaced along the way,
coloured by time. A film is DROPLET.mp4 if ffmpeg is there, otherwise DROPLET.gif; a name that ends in .mp4 or .gif asks
for that film, and a film that is there is never replaced. --pictures makes numbered pictures in the folder DROPLET-frames.
The camera follows the droplet, the way of its centre is a line, and r(t) grows in a corner. The outline has the colour of
its speed; with --colour mechanism the last frame has that of how the droplet clogged.

A film has --most-frames at most. A longer run is thinned; if the droplet moved more than half its width between frames
then, the film shows the end of the run alone.
"""

import pathlib
import sys

import command_line
from command_line import UserError

with command_line.needs_modules():
    import film
    import matplotlib
    import style
    import trajectory
    from style import plt


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
    trajectory.draw_guides(axes)
    axes.set_title(f"{trajectory.described(run)}: {trajectory.verdict(run)}", fontsize=9)
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


def body():
    parser = command_line.Parser(__doc__)
    parser.add_argument("run", type=pathlib.Path, help="output of clogrun with --polygon-interval")
    command_line.add_output(parser, "name of the picture, .png and .pdf are made; or of a film", ".png", ".pdf", required=True)
    parser.add_argument("--outlines", type=command_line.whole(1), default=12, help="how many moments to show in a picture (12)")
    parser.add_argument("--film", action="store_true", help="a film instead: .mp4 (ffmpeg) or .gif")
    parser.add_argument("--pictures", action="store_true", help="numbered pictures in OUTPUT-frames instead")
    parser.add_argument("--colour", choices=["speed", "mechanism"], default="speed", help="of the droplet in a film (speed)")
    parser.add_argument("--rate", type=command_line.whole(1), default=20, help="frames of a film a second (20)")
    parser.add_argument("--most-frames", type=command_line.whole(1), default=600, help="of a film (600)")
    arguments = parser.parse_args()
    if not arguments.output.parent.is_dir():
        raise UserError(f"no folder {arguments.output.parent}; make it first")
    arguments.film |= arguments.output.suffix in film.ENDINGS
    path = film.path_of(arguments.output) if arguments.film else None
    if not arguments.film and not arguments.pictures:
        command_line.refuse_unwritable_picture(arguments.output, arguments.run)
    run = trajectory.read(arguments.run)
    if not arguments.film and not arguments.pictures:
        style.save(draw(run, arguments.outlines), arguments.output)
        print(f"{arguments.output}.png (and .pdf)")
        return 0
    frames = film.chosen_frames(run, arguments.most_frames)
    moving = film.Film(run, frames, arguments.colour, arguments.rate)
    if frames[0] > 0:
        print(f"{command_line.name()}: the film begins at t = {run.times[frames[0]]:.4g} t0; --most-frames shows more", file=sys.stderr)
    if arguments.film:
        print(film.write_film(moving, path, arguments.rate))
    if arguments.pictures:
        print(film.write_pictures(moving, f"{arguments.output}-frames"))
    return 0


if __name__ == "__main__":
    sys.exit(command_line.run(body))
