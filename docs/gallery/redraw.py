"""Draws figures of the gallery at their full size, and notes in pictures.csv from which runs they were drawn.

    python3 docs/gallery/redraw.py PROGRAMS FIGURE...        such as: build/release/bin 6c 7a

Sweeps come from the folder rows; runs of single droplets are made now, and their numbers go to rows/figures. Figures
whose sweep is not in the folder are not drawn.
"""

import csv
import datetime
import gzip
import pathlib
import re
import subprocess
import sys
import tempfile

import pandas
from clogsweep.paper import figures, finished
from clogsweep.paper.plate import CATALOGUE
from clogsweep.paper.runner import CONFIGS, config_keys
from PIL import Image

HERE = pathlib.Path(__file__).resolve().parent
PICTURES = HERE.parent / "pictures"
TABLE = HERE / "pictures.csv"
THUMBNAIL = (280, 160)
PARAMETERS = HERE.parents[1] / "include/clog/core/parameters/parameters.hpp"
MODEL_VERSION = int(re.search(r"int model_version = (\d+);", PARAMETERS.read_text())[1])


def line_of(name, programs):
    """The figure's line in pictures.csv: what was run for it."""
    sweeps = [config for config in CATALOGUE[name].configs if config in finished.names_in()]
    read = [finished.read(config) for config in sweeps]
    groups = [group for sweep in read for group in sweep.groups]
    planned = sorted({group["planned"] for group in groups})
    times = sorted({float(config_keys(CONFIGS / f"{config}.full.cfg")["max-time"]) for config in sweeps})
    version = subprocess.run([programs / "clogsweep", "--version"], check=True, capture_output=True, text=True).stdout
    sources = [source for sweep in read for source in sweep.fit["sources"]]
    return {"picture": name, "size": "full" if sweeps else "single runs", "sweeps": " ".join(sweeps),
            "runs per point": " to ".join(map(str, dict.fromkeys([planned[0], planned[-1]]))) if planned else "1",
            "max-time": " to ".join(f"{time:g}" for time in dict.fromkeys([times[0], times[-1]])) if times else "",
            "core-hours": f"{sum(sweep.core_hours for sweep in read):.2f}" if read else "",
            "git": re.search(r"git (?:\S*-g)?([0-9a-f]{7})", sources[0]["clogsweep"] if sources else version)[1],
            "model version": max([source["model_version"] for source in sources], default=MODEL_VERSION),
            "date": datetime.date.today().isoformat(), "note": ""}


def keep(name, folder):
    """Copies a picture to the handbook, with a palette of 256 colours, and the numbers of single runs to
    rows/figures."""
    drawn = folder / "full" / f"figure-{name}"
    picture = Image.open(f"{drawn}.png").convert("RGB")
    small = picture.copy()
    small.thumbnail(THUMBNAIL, Image.Resampling.LANCZOS)
    for one, target in ((picture, PICTURES), (small, PICTURES / "thumbnails")):
        place = target / f"figure-{name}.png"
        if target == PICTURES or place.exists():  # the gallery's first page shows some thumbnails
            one.quantize(256).save(place, optimize=True)
    if not set(CATALOGUE[name].configs) & set(finished.names_in()):
        series = HERE / "rows" / "figures" / f"{name}.csv.gz"
        series.parent.mkdir(exist_ok=True)
        numbers = pandas.read_csv(f"{drawn}.csv").to_csv(index=False, float_format="%.6g")
        series.write_bytes(gzip.compress(numbers.encode(), 9, mtime=0))


def main(programs, *names):
    programs = pathlib.Path(programs).resolve()
    with open(TABLE, newline="") as file:
        table = {line["picture"]: line for line in csv.DictReader(file)}
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        for name in names:
            options = ["--from-rows", "--output", folder, "--programs", programs]
            if subprocess.run([sys.executable, "-m", "clogsweep", "figures", name, *options]).returncode:
                continue
            keep(name, folder)
            table[name] = line_of(name, programs)
    order = dict.fromkeys(name for name in [*figures.ORDER, *table] if name in table)
    with open(TABLE, "w", newline="") as file:
        writer = csv.DictWriter(file, list(table[names[0]]), lineterminator="\n")
        writer.writeheader()
        writer.writerows(table[name] for name in order)


main(*sys.argv[1:])
