"""Draws the pictures whose runs are lost but whose numbers are in tables.

    PYTHONPATH=analysis /usr/bin/python3 docs/gallery/from_tables.py build/release/bin
"""

import json
import math
import pathlib
import subprocess
import sys

import pandas
from clogsweep import style
from clogsweep.collisions.prediction import Prediction
from clogsweep.drawing import lengths, predicted
from clogsweep.labels import key_phrase
from clogsweep.labels.groups import Groups
from PIL import Image

DOCS = pathlib.Path(__file__).resolve().parents[1]
LENGTHS = DOCS / "gallery/tables/figure-6c-full.csv"
PREDICTIONS = DOCS / "notes/2026-11-27-predicted-curve.csv"
SETTINGS = ["preset", "friction", "line_tension", "obstacle_gap", "obstacle_diameter", "obstacle_density", "vertices"]


def save(figure, name):
    output = DOCS / "pictures" / name
    style.Picture(figure).save(output)
    output.with_suffix(".pdf").unlink()
    Image.open(f"{output}.png").convert("RGB").quantize(256).save(f"{output}.png", optimize=True)


def groups_of(table):
    """The lines of a table of clogfit as groups."""
    for group in table.astype(object).where(table.notna(), None).to_dict("records"):
        other = group["clogs"] - sum(group[name] for name in ("wrapped", "squeezed", "hybrid"))
        yield group | {"other": other, "automatic": [], "met_none": 0, "obstacle_filling": "density", "laboratory": "",
                       "obstacles": "none"}


def predictions(table):
    """The predicted lengths. They are infinite where the table has no number."""
    for line in table.dropna(subset="b").to_dict("records"):
        words = (line[f"predicted {name}"] for name in ("squeezed", "wrapped"))
        squeezed, wrapped = (float(word) if word[0].isdigit() else math.inf for word in words)
        rate = 1 / squeezed + 1 / wrapped
        yield Prediction(line["line tension"], 1 / rate if rate else math.inf, squeezed, wrapped)


def main(programs):
    schema = json.loads(subprocess.run([f"{programs}/clogsweep", "--schema"], check=True, capture_output=True).stdout)
    found = list(groups_of(pandas.read_csv(LENGTHS, comment="#")))
    columns = [column for column in schema["columns"] if column["name"] in SETTINGS]
    known = Groups({"groups": found, "columns": columns, "lists": [], "confidence": 0.95})
    save(style.figure_of(lengths.draw_on, known), "figure-6c-full")
    table = pandas.read_csv(PREDICTIONS, comment="#", dtype={"predicted wrapped": str, "predicted squeezed": str})
    measured = [group for group in found if group["friction"] == 0.05 and group["line_tension"] <= table["line tension"].max()]
    keys = {"preset": "elastic", "friction": "0.05", "obstacle-gap": "0.2", "obstacle-density": "0.35"}
    save(predicted.draw(list(predictions(table[table.friction == 0.05])), measured, 0.95,
                        [key_phrase(*key) for key in keys.items()]), "predicted-curve")


main(*sys.argv[1:])
