#!/usr/bin/python3
"""Regenerates a figure of the paper from runs of our own: sweeps, clogfit, picture.

    analysis/figures.py list
    analysis/figures.py 6c 7c
    analysis/figures.py all --size full --output results/figures

The same command goes on with an interrupted sweep, and never repeats finished runs. Figures that share a sweep run it once.
Beside FOLDER/SIZE/figure-NAME.png are the same as .pdf, the numbers drawn as .csv, and where they came from as .txt.
"""

import csv
import datetime
import os
import pathlib
import sys

import command_line
from command_line import UserError

with command_line.needs_modules():
    import style
    from paper import arrays, channels, hanging  # noqa: F401, they fill the catalogue
    from paper.plate import CATALOGUE
    import programs
    from paper.workshop import Override, Workshop, measured
    from programs import ROOT

ORDER = ["1", "2", "3", "4", "5", "6a", "6b", "6c", "7a", "7b", "7c", "8a", "8b", "8ca", "9a", "9b", "A1", "B1", "B2", "C1", "C2", "D", "E", "W1", "W2"]


def print_list():
    print(f"{'name':5} {'reduced size':24} {'sweep or settings':24} what")
    for name in ORDER:
        entry = CATALOGUE[name]
        print(f"{name:5} {entry.cost:24} {', '.join(entry.configs) or '-':24} {entry.caption}")


def output_of(name, shop):
    """Without ending."""
    return shop.folder / f"figure-{name}"


def refuse_unwritable(name, shop):
    """Before minutes of work, of the four files of write()."""
    output = output_of(name, shop)
    command_line.refuse_unwritable_picture(output, *shop.profiles)
    for ending in ("csv", "txt"):
        command_line.refuse_unwritable(pathlib.Path(f"{output}.{ending}"), "text", *shop.profiles)


def write(plate, entry, shop, command):
    output = output_of(entry.name, shop)
    sources = shop.take_sources()
    version = programs.run_program(shop.programs / "clogsweep", "--version").splitlines()[0]
    about = "\n".join([f"Figure {entry.name}, {shop.size} size: {entry.caption}", f"drawn by {command}",
                       f"{version}, {datetime.datetime.now(datetime.timezone.utc):%Y-%m-%dT%H:%M:%SZ}", "from", *sources]) + "\n"
    style.save(plate.figure, output, {"Title": f"Figure {entry.name}: {entry.caption}", "Description": about, "Software": "clogsweep"})
    columns = list(dict.fromkeys(name for row in plate.data for name in row))
    with open(f"{output}.csv", "w", newline="") as out:
        table = csv.DictWriter(out, columns)
        table.writeheader()
        table.writerows(plate.data)
    pathlib.Path(f"{output}.txt").write_text(about)
    print(f"{output}.png (and .pdf, .csv, .txt)", flush=True)


def parse():
    parser = command_line.Parser(__doc__)
    parser.add_argument("names", nargs="+", metavar="NAME", help="of figures, or list, or all")
    parser.add_argument("--size", choices=["reduced", "full"], default="reduced", help="reduced: minutes on two cores; full: as published")
    parser.add_argument("--ranks", type=command_line.whole(1), default=2, help="MPI ranks of the sweeps, and runs at a time (2)")
    parser.add_argument("-o", "--output", type=pathlib.Path, default=pathlib.Path("results/figures"), help="folder (results/figures)")
    parser.add_argument("--draw-only", action="store_true", help="run nothing, draw from what is there")
    parser.add_argument("--profile", type=pathlib.Path, action="append", default=[], metavar="FILE.csv",
                        help="measured passage h [sigma], v [v_t], A to draw in 2, 3 (twice: w = 0.9, 0.7), 4, or to compare with in B2")
    parser.add_argument("--set", action="append", default=[], metavar="[CONFIG:]KEY=VALUE",
                        help="another value than the config's, e.g. clogging:seeds=1..50; keys that a figure itself sets stay")
    programs.add_option(parser)
    return parser.parse_args()


def body():
    arguments = parse()
    if arguments.names == ["list"]:
        print_list()
        return 0
    names = ORDER if arguments.names == ["all"] else arguments.names
    for name in names:
        if name not in CATALOGUE:
            raise UserError(f"no figure {name}; analysis/figures.py list names them")
    shop = Workshop(size=arguments.size, ranks=arguments.ranks, folder=arguments.output / arguments.size,
                    programs=programs.programs_in(arguments.programs), overrides=[Override.parse(text) for text in getattr(arguments, "set")],
                    profiles=arguments.profile, draw_only=arguments.draw_only)
    for path in arguments.profile:
        measured(path)
    try:
        shop.folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise UserError(f"cannot make {shop.folder} ({error.strerror}); give another --output") from error
    for name in names:
        refuse_unwritable(name, shop)
    command = " ".join([os.path.relpath(sys.argv[0], ROOT), *sys.argv[1:]])
    for name in names:
        write(CATALOGUE[name].draw(shop), CATALOGUE[name], shop, command)
    return 0


if __name__ == "__main__":
    sys.exit(command_line.run(body))
