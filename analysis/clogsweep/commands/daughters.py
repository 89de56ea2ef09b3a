"""Draws the droplets into which the droplets of a sweep break up.

    clogsweep --output sweep.h5 break-up=daughters break-up-neck=0.05 line-tension=0.05,0.1,0.2 seeds=1..20
    python3 -m clogsweep daughters sweep.h5              # sweep-daughters.png, sweep-daughters.pdf
    python3 -m clogsweep daughters sweep.h5 --task 3     # the family of one run
    python3 -m clogsweep daughters sweep.h5 --task 3 --film film                # its motion

The upper panels show two results against the distance from the release: the share of the droplets' area that passes,
with its interval, and the number of droplets that pass per released droplet. The lower panel is the distribution of the
diameters at the distance given by --outlet, where droplets leave the array; in a device, this is an x. With --task, the
picture shows one family: a bar for each droplet, from its birth to its end, as thick as the droplet's diameter. With
--film, all droplets of this family move in the array; each is replayed, the camera follows those that move, and those
that clog stay. A droplet that was too small to be followed is a circle where it was born. The exit of a device is a
dashed line. The film is FILM.mp4 with ffmpeg, otherwise FILM.gif.
"""

import argparse
import pathlib

from ..drawing import families, family_film, film
from ..labels.groups import Groups
from ..reading import fits, programs, stored
from ..results.fit import Fit
from ..style import Picture
from ..tools.errors import UserError
from . import command_line


def outlet(word: str) -> families.Outlet:
    unit = next((unit for unit in ("mm", "sigma") if word.endswith(unit)), "")
    place = command_line.between(1e-6, 1e7, "a distance in sigma, or in mm such as 100mm")(word.removesuffix(unit))
    return families.Outlet(place, unit or "sigma")


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--outlet", type=outlet, metavar="X",
                        help="line at which diameters are counted, in sigma, or in mm such as 100mm (the last of 10, "
                             "20, 50, 100, ... sigma and the exit that at most a tenth of the area may still pass)")
    parser.add_argument("--task", type=command_line.whole(0), help="draw the family of this run")
    parser.add_argument("--film", type=pathlib.Path,
                        help="with --task: make this film of the family instead of the picture, .mp4 or .gif")
    parser.add_argument("--frames", type=command_line.whole(2), default=300, help="number of frames of the film (300)")
    parser.add_argument("--rate", type=command_line.whole(1), default=20, help="frames of the film per second (20)")


def make_film(arguments: argparse.Namespace) -> int:
    if arguments.task is None:
        raise UserError("missing --task; a film shows the family of one run")
    path = film.path_of(arguments.film)
    with stored.opened(arguments.sweep, stored.SWEEP, arguments.programs) as file:
        family, rows = families.family_of(stored.droplets(file), arguments.task, arguments.sweep), file["runs"][:]
    clogrun = programs.programs_in(arguments.programs) / "clogrun"
    motions = family_film.motions_of(clogrun, arguments.sweep, family, family.end_time.max() / arguments.frames)
    row = rows[rows["task"] == arguments.task][0]
    exit_distance = row["exit"] - row["release_x"] if row["exit"] > 0 else None
    moving = family_film.FamilyFilm(motions, arguments.frames, arguments.rate, film.size_for(path), exit_distance)
    command_line.tell(film.write_film(moving, path, arguments.rate))
    return 0


def body() -> int:
    arguments = command_line.sweep_to_draw(__doc__, "daughters",
                                           more=[add_options, command_line.add_lab, command_line.add_width])
    if arguments.film:
        return make_film(arguments)
    with stored.opened(arguments.sweep, stored.SWEEP, arguments.programs) as file:
        droplets, rows = stored.droplets(file), file["runs"][:]
    clogfit = programs.programs_in(arguments.programs) / "clogfit"
    options = command_line.lab_options(arguments)
    fit = Fit(*fits.fitted(clogfit, arguments.sweep, *options))
    groups: Groups = fit.known.finished(arguments.sweep)
    if arguments.task is not None:
        family = families.family_of(droplets, arguments.task, arguments.sweep, families.remedy_for(groups))
        figure = families.draw_family(family, rows[rows["task"] == arguments.task][0], groups)
    else:
        members = families.with_families(groups, arguments.sweep)
        asked: families.Outlet | None = arguments.outlet
        if groups.are_in_mm and not asked:
            asked = families.common_outlet(members)
        if asked:
            asked.refuse_outside_devices(groups.members)
            fit = Fit(*fits.fitted(clogfit, arguments.sweep, *options, "--lines", f"{asked.place:.17g}{asked.unit}"))
            groups = fit.known.finished(arguments.sweep)
        figure = families.draw(groups, asked, arguments.sweep)
    return command_line.save(Picture(figure, fit.source), arguments)
