"""Recomputes clogging lengths from the runs in docs/gallery/rows, and draws figures from such files."""

import csv
import json
import math
import subprocess
import unittest

import numpy as np

import test_figures
from support import BIN, ROOT

from clogsweep.paper import finished
from clogsweep.tools.errors import NotThere

LARGEST = 300_000  # bytes of the two files of a sweep
DISK = ["model=sp", "wall-stiffness=1,100", "box=45", "max-time=300", "seeds=1..6", "obstacle-density=0.35"]


def runs_of(sweep, group):
    """The runs of a group, by the parameters in the files."""
    rows = sweep.rows
    for name in finished.PARAMETERS:
        value = group[name]
        if value is None:
            rows = rows[rows[name].isna()]
        elif isinstance(value, str):
            rows = rows[rows[name] == value]
        else:
            rows = rows[np.isclose(rows[name].astype(float), value, rtol=1e-5)]
    return rows


def assert_fitted(test, sweep):
    """Recomputes the length of each group: all distances, divided by the number of clogs."""
    for group in sweep.fit["groups"]:
        rows = runs_of(sweep, group)
        over = rows[rows.status.isin(["clogged", "flowing", "passed", "broken", "failed"])]
        distances = np.where(over.status == "failed", over.sound_distance, over.distance)
        clogs = int((over.status == "clogged").sum())
        test.assertEqual(clogs, group["clogs"])
        if clogs and math.isfinite(distances.sum()):
            test.assertAlmostEqual(distances.sum() / clogs / group["clogging_length"], 1, delta=1e-9)
        if finished.is_complete(group):
            test.assertEqual(len(rows), group["planned"])
        test.assertEqual(sorted(rows.seed), sorted(set(rows.seed)), "a run is there twice")


class Rows(unittest.TestCase):
    def test_lengths_of_the_gallery_follow_from_their_runs(self):
        names = finished.names_in()
        self.assertGreater(len(names), 0)
        for name in names:
            with self.subTest(sweep=name):
                assert_fitted(self, finished.read(name))
                self.assertTrue((ROOT / "jobs" / "figures" / f"{name}.full.cfg").exists())
                files = finished.files_of(name, finished.FOLDER)
                self.assertLess(sum(path.stat().st_size for path in files), LARGEST)


class Parts(test_figures.Drawn):
    PLACE = "full"

    def sweep(self, file, *more):
        command = [str(BIN / "clogsweep"), *DISK, *more, "--output", str(self.folder / file)]
        subprocess.run(command, check=True, capture_output=True, cwd=self.folder)
        return self.folder / file

    def test_a_sweep_is_added_in_parts_and_drawn(self):
        rows = self.folder / "rows"
        rows.mkdir()
        with self.assertRaises(NotThere):
            finished.read("clogging-sp", rows)
        one, other = self.sweep("one.h5", "obstacle-gap=0.2"), self.sweep("other.h5", "obstacle-gap=0.3")
        finished.add("clogging-sp", [one], BIN, "a processor", rows)
        finished.add("clogging-sp", [other], BIN, "a processor", rows)
        sweep = finished.add("clogging-sp", [one], BIN, "a processor", rows)
        self.assertEqual([len(sweep.rows), len(sweep.groups), len(sweep.incomplete), len(sweep.fit["sources"])],
                         [24, 4, 0, 2])
        assert_fitted(self, sweep)

        # A figure from finished rows shows the same numbers as a figure from the sweep, but leaves out groups with
        # missing runs.
        sweep.fit["groups"][0]["planned"] = 7
        finished.write("clogging-sp", sweep, rows)
        self.draw("figures", "7a", "--from-rows", rows, "--output", ".", "--programs", BIN)
        names = ("obstacle_gap", "wall_stiffness", "clogging_length_lower")
        self.assertEqual(sorted([point[name] for name in names] for point in self.drawn("7a")),
                         sorted([str(group[name]) for name in names] for group in sweep.fit["groups"][1:]))
        self.assertIn("6 of 7 runs", (self.folder / "full" / "figure-7a.txt").read_text())

        # The message names the missing sweep.
        options = ["--from-rows", rows, "--output", ".", "--programs", BIN]
        self.refuse_analysis("figures", "9a", *options, words=["speed-sp", "--size full"])
        for option in ("--draw-only", "--set=seeds=1"):
            self.refuse_analysis("figures", "7a", *options, option, words=["--from-rows", option.split("=")[0]])

    def test_sizes_behind_an_array_are_those_of_clogfit_also_from_rows(self):
        options = ["--output", ".", "--programs", BIN]
        self.draw("figures", "sizes", *options, *test_figures.SET)
        sweep = self.folder / "reduced" / "sweeps" / "families.h5"
        groups = json.loads(self.succeed("clogfit", sweep, "--format", "json").stdout)["groups"]
        drawn = (self.folder / "reduced" / "figure-sizes.csv").read_text()
        points = list(csv.DictReader(drawn.splitlines()))
        for group in groups:
            line = next(line for line in group["families"]["lines"] if line["distance"] == float(points[0]["outlet"]))
            mine = [float(point["number"]) for point in points
                    if float(point["speed_exponent"]) == group["speed_exponent"]]
            self.assertEqual(mine, line["passed"]["numbers"])
            self.assertGreater(sum(mine), 1)
        rows = self.folder / "rows"
        rows.mkdir()
        added = finished.add("families", [sweep], BIN, "a processor", rows)
        self.assertEqual([len(added.rows), len(added.groups)], [4, 2])
        assert_fitted(self, added)
        self.draw("figures", "sizes", *options, "--from-rows", rows)
        self.assertEqual((self.folder / "full" / "figure-sizes.csv").read_text(), drawn)

    def test_a_failed_run_is_not_counted_twice(self):
        # clogfit counts failed runs that are censored among `runs`.
        group = {"runs": 49, "failed": 1, "planned": 50, "interrupted": 0}
        self.assertFalse(finished.is_complete(group))
        self.assertTrue(finished.is_complete(group | {"runs": 50}))

    def test_damaged_files_get_one_line(self):
        rows = self.folder / "rows"
        rows.mkdir()
        finished.add("clogging-sp", [self.sweep("one.h5", "obstacle-gap=0.2")], BIN, "a processor", rows)
        table = finished.files_of("clogging-sp", rows)[0]
        table.write_bytes(table.read_bytes()[:-20])
        self.refuse_analysis("figures", "7a", "--from-rows", rows, "--output", ".", "--programs", BIN,
                             words=["clogging-sp", "check them out again"])


if __name__ == "__main__":
    unittest.main()
