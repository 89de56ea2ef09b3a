"""Draws a droplet among obstacles: several moments of one run in one picture, or a film.

    clogrun array --output run.h5 --polygon-interval 5 line-tension=0.3 seeds=4
    python3 -m clogsweep droplet run.h5 --output droplet
    python3 -m clogsweep droplet run.h5 --output droplet --film --colour speed

The flow is to the right. In a picture the last outline is filled; earlier ones are thin, evenly spaced along the path,
coloured by time. A film is DROPLET.mp4 with ffmpeg, otherwise DROPLET.gif; a name that ends in .mp4 or .gif selects the
format, and an existing film is never replaced. --pictures makes numbered pictures in the folder DROPLET-frames. The
camera follows the droplet, a line shows the path of its centre, and a corner shows r(t). The outline is coloured by its
speed; with --colour mechanism the last frame shows the mechanism of the clog.

A film has at most --most-frames. A longer run skips frames; if the droplet would move more than half its width between
frames, the film shows only the end of the run.
"""

import argparse
import pathlib
import sys

from ..drawing import film, way
from ..reading import stored, trajectory
from ..style import Picture
from ..tools import outputs
from ..tools.errors import UserError
from . import command_line


def body() -> int:
    parser = command_line.Parser(__doc__)
    parser.add_argument("run", type=pathlib.Path, help="output of clogrun with --polygon-interval")
    command_line.add_output(parser, "name of the picture, .png and .pdf are made; or of a film", ".png", ".pdf",
                            required=True)
    parser.add_argument("--outlines", type=command_line.whole(1), default=12,
                        help="number of outlines in a picture (12)")
    parser.add_argument("--film", action="store_true", help="make a film instead: .mp4 (ffmpeg) or .gif")
    parser.add_argument("--pictures", action="store_true", help="make numbered pictures in OUTPUT-frames instead")
    parser.add_argument("--colour", choices=film.COLOURS, default="speed",
                        help="quantity that the colours in a film show (speed)")
    parser.add_argument("--rate", type=command_line.whole(1), default=20, help="frames of a film per second (20)")
    parser.add_argument("--most-frames", type=command_line.whole(1), default=600,
                        help="largest number of frames of a film (600)")
    parser.add_argument("--size", choices=film.SIZES, help="size of the frames (1080p; 540p for a .gif)")
    arguments = parser.parse_args()
    if not arguments.output.parent.is_dir():
        raise UserError(f"no folder {arguments.output.parent}; make it first")
    arguments.film |= arguments.output.suffix in film.ENDINGS
    if not arguments.film and not arguments.pictures:
        return draw_picture(arguments)
    return draw_film(arguments)


def draw_picture(arguments: argparse.Namespace) -> int:
    outputs.refuse_unwritable_picture(arguments.output, arguments.run)
    run = trajectory.read(arguments.run)
    return command_line.save(Picture(way.draw(run, arguments.outlines), stored.source(run.attributes)), arguments)


def draw_film(arguments: argparse.Namespace) -> int:
    path = film.path_of(arguments.output) if arguments.film else None
    run = trajectory.read(arguments.run)
    frames = film.chosen_frames(run, arguments.most_frames)
    moving = film.Film(run, frames, arguments.colour, arguments.rate, arguments.size or film.size_for(path))
    if frames[0] > 0:
        print(f"{command_line.name()}: the film begins at t = {run.times[frames[0]]:.4g} t0; --most-frames shows more",
              file=sys.stderr)
    if path:
        command_line.tell(film.write_film(moving, path, arguments.rate))
    if arguments.pictures:
        command_line.tell(film.write_pictures(moving, f"{arguments.output}-frames"))
    return 0
