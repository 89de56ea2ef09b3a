import csv
import io
import json
import math
import re
import sys
import unittest
import zlib

import h5py
import numpy as np
import pandas
import scipy.stats

import stored_rows
from support import BIN, FEW, QUICK, ROOT, SMALL, ProgramTest, shared_sweep

sys.path.insert(0, str(ROOT / "analysis"))
from clogsweep.tools import rounded  # noqa: E402
from clogsweep.reading import stored  # noqa: E402

# Droplets of these runs can travel a hundred diameters, so a test may write any distance up to 100 into the rows.
FAR = ["max-time=1", "terminal-speed=100"]
# The distances of these ten runs follow the exponential law exactly.
EXPONENTIAL = -np.log(1 - (np.arange(10) + 0.5) / 10)


class Mixtures(ProgramTest):
    """Tests clogfit with files of droplets in arrays, in channels and on flat walls."""

    def setUp(self):
        super().setUp()
        self.parts = [str(shared_sweep(*FEW)), "channel.h5", "wall.h5"]
        self.succeed("clogsweep", *QUICK[:1], "orifice=0.6,0.8", "start=-1.5", "end=1", "max-time=60", "--output",
                     "channel.h5")
        self.succeed("clogsweep", *QUICK[:1], "obstacle-layout=wall", "line-tension=0.5,1", "--output", "wall.h5")

    def fit(self, *words, program=("clogfit",)):
        return self.succeed(*program, *words).stdout

    def test_each_kind_has_the_table_that_it_has_alone(self):
        array, channel, wall = parts = self.parts
        for files in (parts, parts[::-1], [channel, wall], [wall, array], [channel, array]):
            known = sorted(files, key=parts.index)
            self.assertEqual(self.fit(*files), "\n".join(self.fit(file) for file in known))
        self.assertNotIn("lambda", self.fit(wall) + self.fit(channel))
        self.succeed("clogsweep", "merge", *parts, "--output", "all.h5")
        self.assertEqual(self.fit("all.h5"), self.fit(*parts))
        status = self.fit("all.h5", program=("clogsweep", "status"))
        self.assertTrue(status.endswith("\n\n" + self.fit("all.h5")), status)

    def test_csv_and_json_have_the_cells_that_they_have_alone(self):
        parts = self.parts
        alone = [list(csv.DictReader(io.StringIO(self.fit(file, "--format=csv")))) for file in parts]
        for files in (parts, parts[::-1]):
            head, *lines = csv.reader(io.StringIO(self.fit(*files, "--format=csv")))
            self.assertEqual({len(line) for line in lines}, {len(head)})
            self.assertEqual(len(set(head)), len(head))
            self.assertEqual(head[:len(alone[0][0])], list(alone[0][0]))
            rows = [dict(zip(head, line)) for line in lines]
            self.assertEqual([{name: cell for name, cell in row.items() if cell} for row in rows],
                             [{name: cell for name, cell in row.items() if cell} for part in alone for row in part])
            self.assertEqual([row["clogging_length"] == "" for row in rows], [False] * 2 + [True] * 4)
            document = json.loads(self.fit(*files, "--format=json"))
            apart = [json.loads(self.fit(file, "--format=json")) for file in parts]
            self.assertEqual(document["groups"], [group for part in apart for group in part["groups"]])
            for part in apart:
                self.assertLessEqual(part["units"].items(), document["units"].items())

    def test_only_arrays_have_lengths_in_a_laboratory(self):
        self.write("lab.cfg", "diameter = 2 mm\nangle = 28 deg\nspeed = 3 mm/s\ndensity-difference = 100 "
                              "kg/m^3\ntension = 2 mN/m\n")
        text = self.fit(*self.parts[::-1], "--lab=lab.cfg")
        self.assertEqual(text.count("lambda/mm"), 1)
        for group in json.loads(self.fit(*self.parts[::-1], "--lab=lab.cfg", "--format=json"))["groups"]:
            self.assertEqual("clogging_length_mm" in group, group["obstacle_filling"] not in ("channel", "wall"))

    def test_what_needs_clogging_lengths_refuses_the_others(self):
        self.succeed("clogsweep", "merge", *self.parts, "--output", "all.h5")
        self.refuse("clogfit", "compare", "all.h5", "--by=line-tension", words=["on a wall", "clogsweep select"])
        self.refuse("clogfit", "report", "all.h5", words=["arrays", "clogsweep select"])
        self.refuse("clogfit", *self.parts[1:], "--dwell=5", words=["--dwell", "on a wall"])
        self.assertIn("clogged: has not moved", self.fit(*self.parts[::-1], "--dwell=30"))
        self.refuse("clogfit", *self.parts, "--mixture=orifice=0.6:1,0.8:1",
                    words=["orifice = 0.6 are in a channel", "no clogging length"])

    def test_automatic_values_above_the_table_have_a_star(self):
        for file in self.parts[:2]:
            usual, text = self.fit(file), self.fit(file, "--all-parameters")
            self.assertRegex(text.split("\n\n")[0], r" perimeter_stiffness=0\.1\*\s")
            self.assertRegex(text.split("\n\n")[0], r" near_wall_drag=[^\s*]+\s")
            self.assertIn("*: the automatic value", text)
            self.assertNotIn("*", usual.split("\n\n")[0])

    def test_models_differ_in_the_model_and_in_what_both_have(self):
        gaps = ["seeds=1", "obstacle-gap=0.3,0.5"]
        self.succeed("clogsweep", *QUICK[:1], *gaps, "box=20", "max-time=1", "--output", "dp.h5")
        self.succeed("clogsweep", "model=sp", "wall-stiffness=5", *gaps, "box=30", "max-time=2", "--output", "sp.h5")
        # No parameter that both models have differs from its default.
        self.assertTrue(self.fit("dp.h5", "sp.h5").startswith("runs with model=dp: "))
        mixture = "--mixture=obstacle-gap=0.3:1,0.5:1"
        self.refuse("clogfit", "dp.h5", "sp.h5", mixture,
                    words=["2 groups have obstacle_gap = 0.3 and differ in model"])
        done = self.run_program("clogfit", "dp.h5", "sp.h5", mixture)
        for name in ("friction", "vertices", "near_wall_drag", "preset"):
            self.assertNotIn(name, done.stderr)


class GivenKeys(ProgramTest):
    """Tests that each numerical key with several values is a column of the table, even if it varies together with
    another key. A key with one value is above the table."""

    SETTINGS = ["box=20", "obstacle-density=saturated", "max-time=5", "seeds=1"]

    def table_of(self, points, *words):
        """@return the words above the table, and its lines as dictionaries"""
        (self.folder / "s.h5").unlink(missing_ok=True)
        self.write("p.csv", points)
        self.succeed("clogsweep", *self.SETTINGS, *words, "--points", "p.csv", "--output", "s.h5")
        shared, lines = self.succeed("clogfit", "s.h5").stdout.split("\n\n")[:2]
        head, *lines = [re.split(r"  +", line.strip()) for line in lines.splitlines()]
        return shared, [dict(zip(head, line)) for line in lines]

    def test_given_values_are_columns_and_automatic_values_are_not(self):
        lengths = {"runs", "clogs", "lambda/sigma"}
        for points in ("line-tension,vertices,wall-stiffness\n1,32,0.5\n2,64,0.7\n",
                       "obstacle-gap,time-step,area-stiffness\n0.4,0.001,60\n0.5,0.0005,70\n",
                       "obstacle-gap,line-tension,wall-stiffness\n0.4,1,0.6\n0.5,2,0.7\n"):
            _, lines = self.table_of(points)
            head, *rows = [line.split(",") for line in points.splitlines()]
            names = [name.replace("-", "_") for name in head]
            self.assertEqual([[float(line[name]) for name in names] for line in lines],
                             [[float(cell) for cell in row] for row in rows])
            before = list(lines[0])[:list(lines[0]).index("runs")]
            self.assertEqual(set(before) - {"obstacle_gap", "line_tension"},
                             set(names) - {"obstacle_gap", "line_tension"})
            self.assertLess(lengths, set(lines[0]))
        # Merged files have the same columns in the table.
        for name, tension, stiffness in (("a.h5", 1, 0.5), ("b.h5", 2, 0.7)):
            self.succeed("clogsweep", *self.SETTINGS, f"line-tension={tension}", f"wall-stiffness={stiffness}",
                         "--output", name)
        printed = self.succeed("clogfit", "a.h5", "b.h5").stdout
        self.assertIn("wall_stiffness", printed)
        self.assertNotIn("vertices", printed)

    def test_one_given_value_among_automatic_ones_is_a_column(self):
        _, lines = self.table_of("line-tension,vertices\n1,32\n2,\n")
        self.assertEqual([line["vertices"] for line in lines], ["32", "128*"])
        self.assertIn("\n*: the automatic value", self.succeed("clogfit", "s.h5").stdout)

    def test_values_that_follow_from_given_ones_are_not_printed(self):
        for given in (["wall-stiffness=1"], ["time-step=0.001"], ["time-step=0.0005", "wall-stiffness=0.5"]):
            shared, _ = self.table_of("line-tension\n1\n", *given)
            printed = {word.split("=")[0] for word in shared.split()} & {"time_step", "wall_stiffness", "vertices"}
            self.assertEqual(printed, {word.split("=")[0].replace("-", "_") for word in given})

    def test_a_given_ratio_of_stiffness_and_tension_is_printed(self):
        _, lines = self.table_of("line-tension\n1\n2\n", "perimeter-spring=rest", "perimeter-stiffness-ratio=3")
        self.assertEqual([float(line["perimeter_stiffness"]) for line in lines], [3, 6])

    def test_keys_that_only_one_model_has_are_columns_if_they_vary_in_it(self):
        shared, lines = self.table_of("model,line-tension,near-wall-drag,wall-stiffness\nsp,,,5\ndp,1,0.2,\ndp,2,0.2,\n")
        before = list(lines[0])[:list(lines[0]).index("runs")]
        self.assertEqual(before, ["model", "obstacle_gap", "line_tension", "wall_stiffness"])
        self.assertIn("near_wall_drag=0.2", shared.split())
        self.assertEqual([line["wall_stiffness"][-1] == "*" for line in lines], [True, True, False])
        shared, _ = self.table_of("model,line-tension,vertices,wall-stiffness\nsp,,,5\ndp,1,32,\n")
        for_all, of_polygons = shared.split("\n")[:2]
        self.assertNotIn("vertices", for_all)
        self.assertEqual(of_polygons, "runs with model=dp: vertices=32")
        shared, lines = self.table_of("model,line-tension,near-wall-drag,wall-stiffness\nsp,,,5\ndp,1,0.2,\ndp,2,0.3,\n")
        self.assertEqual([line["near_wall_drag"] for line in lines], ["0.2", "0.3", "0"])


class Profiles(ProgramTest):
    """Tests clogfit drag and clogfit deviation with CSV files."""

    def test_the_exponent_of_the_near_wall_drag_comes_from_speeds_along_a_wall(self):
        distances = [0.05, 0.1, 0.3, 1.0]
        speeds = [1 / (1 + 0.07 * d ** -1.25) for d in distances]
        self.write("reduced.csv", "\n".join(["d [sigma], v [v_t]", *(f"{d},{v}" for d, v in zip(distances, speeds))]))
        # The same profile in units of a laboratory, for a droplet of 2 mm at 0.5 mm/s.
        self.write("mm.csv",
                   "\n".join(["# tilt 5 deg", "frame, d [mm], v [mm/s]",
                              *(f"7,{2 * d},{v / 2}" for d, v in zip(distances, speeds))]))
        for arguments in (["reduced.csv"], ["mm.csv", "--diameter", "2mm", "--speed=0.5 mm/s"]):
            fit = json.loads(self.succeed("clogfit", "drag", *arguments, "--format", "json").stdout)
            self.assertAlmostEqual(fit["near_wall_exponent"], 1.25, places=9)
            self.assertAlmostEqual(fit["near_wall_drag"], 0.07, places=9)
            self.assertEqual(fit["speeds"], 4)
        self.assertIn("alpha = 1.25 ", self.succeed("clogfit", "drag", "reduced.csv").stdout)

    def test_the_deviation_between_profiles_is_that_of_the_interpolated_simulation(self):
        self.write("measured.csv", "h [sigma], v [v_t], A\n-0.5,0.55,1.05\n0,0.6,1.1\n0.5,0.9,1.0\n")
        self.write("simulated.csv", "h [sigma], v [v_t], A\n-1,1,1\n0,0.5,1.1\n1,1,1\n")
        found, = json.loads(self.succeed("clogfit", "deviation", "measured.csv", "simulated.csv").stdout)["deviations"]
        # The simulated values are v = 0.75, 0.5, 0.75 and A = 1.05, 1.1, 1.05.
        self.assertAlmostEqual(found["delta_v"], math.sqrt(((0.2 / 0.75) ** 2 + 0.2 ** 2 + 0.2 ** 2) / 3), places=12)
        self.assertAlmostEqual(found["delta_a"], math.sqrt((0.05 / 1.05) ** 2 / 3), places=12)

    def test_measured_frames_in_laboratory_units_are_those_in_reduced_units(self):
        self.write("measured.csv", "h [sigma], v [v_t], A\n-0.5,0.55,1.05\n0,0.6,1.1\n0.5,0.9,1.0\n")
        # The same frames for a droplet of 2 mm at 3 mm/s.
        self.write("mm.csv", "h [mm];v [mm/s];A\n-1,0;1,65;1,05\n0;1,8;1,1\n1,0;2,7;1,0\n")
        self.write("simulated.csv", "h [sigma], v [v_t], A\n-1,1,1\n0,0.5,1.1\n1,1,1\n")
        reduced, = json.loads(self.succeed("clogfit", "deviation", "measured.csv", "simulated.csv").stdout)["deviations"]
        found, = json.loads(self.succeed("clogfit", "deviation", "mm.csv", "simulated.csv", "--diameter", "2mm", "--speed=3mm/s").stdout)["deviations"]
        for name in ("delta_v", "delta_a"):
            self.assertAlmostEqual(found[name], reduced[name], places=12)
        self.refuse("clogfit", "deviation", "mm.csv", "simulated.csv",
                    words=["mm.csv line 1", "is in mm and needs --diameter"])

    def test_mistakes_get_one_line_and_exit_code_2(self):
        self.write("early.csv", "h [sigma], v [v_t]\n-1,1\n0,1\n1,1\n")
        self.write("good.csv", "h [sigma], v [v_t]\n0,1\n1,1\n2,1\n")
        self.write("fast.csv", "d [sigma], v [v_t]\n0.1,0.5\n0.2,1.5\n")
        for arguments, words in [
            (["drag"], ["missing file"]),
            (["drag", "no.csv"], ["cannot read no.csv"]),
            (["drag", "fast.csv"], ["fast.csv", "between 0 and v_t"]),
            (["drag", "good.csv"], ["columns d and v"]),
            (["drag", "fast.csv", "--diameter", "2"], ["--diameter=2"]),
            (["drag", "fast.csv", "--format", "xml"], ["--format=xml"]),
            (["deviation", "good.csv"], ["missing profiles"]),
            (["deviation", "good.csv", "no.csv"], ["cannot read no.csv"]),
            (["deviation", "early.csv", "good.csv"], ["good.csv: 1 measured frame, down to h = -1, is upstream "
                                                      "of the simulated start at h = 0", "start=-1.5, or delete"]),
        ]:
            with self.subTest(arguments=arguments):
                self.refuse("clogfit", *arguments, words=words)


class Fit(ProgramTest):
    def sweep(self, *settings):
        return pandas.read_hdf(self.copy_sweep("sweep.h5", *SMALL, *settings), "runs")

    def change(self, **columns):
        """Writes other results into the rows of the sweep's file, and adjusts results that depend on the status."""
        if "status" in columns:
            status = np.array(columns["status"])
            columns.setdefault("clogged_by", np.where(status == b"clogged", b"certified", b"none"))
            columns.setdefault("failed_by", np.where(status == b"failed", b"crossing", b"none"))
            columns.setdefault("message", np.where(status == b"failed", b"made to fail", b""))
        stored_rows.change_columns(self.folder / "sweep.h5", **columns)

    def fit(self, *arguments):
        return json.loads(self.succeed("clogfit", "sweep.h5", "--format", "json", *arguments).stdout)

    def test_the_same_droplet_counts_once_in_a_pool(self):
        keys = [*SMALL, "line-tension=0.5", "obstacle-gap=0.4", "seeds=1..4"]
        for name, more in (("short", ["max-time=60"]), ("long", ["max-time=120"]), ("wide", ["max-time=60", "boxes=3"])):
            self.succeed("clogsweep", *keys, *more, "--output", f"{name}.h5")
        self.succeed("clogsweep", "merge", "short.h5", "long.h5", "--output", "sweep.h5")
        long = json.loads(self.succeed("clogfit", "long.h5", "--format", "json").stdout)["groups"]
        self.assertEqual(len(self.fit()["groups"]), 2)
        group, = self.fit("--pool=max-time")["groups"]
        self.assertEqual((group["runs"], group["repeated"], group["total_distance"]), (4, 4, long[0]["total_distance"]))
        printed = self.succeed("clogfit", "sweep.h5", "--pool", "max-time").stdout
        self.assertIn("4 runs repeat droplets of longer runs and do not count (--pool)\n", printed)
        self.assertIn("groups that differ only in max-time are joined (--pool)\n", printed)
        # With another number of boxes the same seed gives another array, so no run repeats a droplet, and all runs
        # count.
        self.succeed("clogsweep", "merge", "short.h5", "wide.h5", "--output", "boxes.h5")
        group, = json.loads(self.succeed("clogfit", "boxes.h5", "--format", "json",
                                         "--pool=boxes,max-time").stdout)["groups"]
        self.assertEqual((group["runs"], group["repeated"]), (8, 0))
        self.refuse("clogfit", "sweep.h5", "--pool=max-time,seeds",
                    words=["invalid --pool=max-time,seeds", "runs that differ in seeds"])

    def test_it_gives_the_reference_answer(self):
        # The classic leukaemia trial has 21 runs, of which 9 end, and a total distance of 359.
        self.sweep("seeds=1..21", *FAR)
        times = [6, 6, 6, 6, 7, 9, 10, 10, 11, 13, 16, 17, 19, 20, 22, 23, 25, 32, 32, 34, 35]
        clogged = [1, 1, 1, 0, 1, 0, 1, 0, 0, 1, 1, 0, 0, 0, 1, 1, 0, 0, 0, 0, 0]
        self.change(distance=times, status=[b"clogged" if c else b"flowing" for c in clogged])
        group, = self.fit()["groups"]
        self.assertEqual((group["runs"], group["clogs"], group["flowing"]), (21, 9, 12))
        self.assertAlmostEqual(group["clogging_length"], 39.8888889, places=7)
        self.assertAlmostEqual(group["clogging_length_lower"], 21.8553773, places=7)
        self.assertAlmostEqual(group["clogging_length_upper"], 80.6151318, places=7)
        self.assertAlmostEqual(group["clogging_length_profile_lower"], 22.1273051, places=7)
        self.assertAlmostEqual(group["weibull_shape"], 1.3537345, places=7)
        self.assertEqual(group["doubts"], "censored_by_time array_repeats")
        at_10 = group["survival"][2]
        self.assertEqual((at_10["distance"], at_10["at_risk"], at_10["clogs"]), (10, 15, 1))
        self.assertAlmostEqual(at_10["probability"], 0.75294118, places=8)
        self.assertAlmostEqual(at_10["standard_error"], 0.09634965, places=8)
        first = group["survival"][0]
        self.assertAlmostEqual(first["lower"], 0.6197, places=4)  # From R, survfit(conf.type = "log-log")
        self.assertAlmostEqual(first["upper"], 0.9516, places=4)
        self.assertEqual(group["censored_distances"], sorted(time for time, c in zip(times, clogged) if not c))
        self.assertGreater(self.fit("--confidence", 0.5)["groups"][0]["survival"][0]["lower"], first["lower"])
        narrow, = self.fit("--confidence", "1e-20")["groups"]
        self.assertAlmostEqual(narrow["clogging_length_profile_lower"], group["clogging_length"], places=9)
        self.assertAlmostEqual(narrow["clogging_length_profile_upper"], group["clogging_length"], places=9)

    # In these runs some droplets rest for 20 t0 or more, and no droplet clogs by wrapping
    DWELLING = ["seeds=1..8", "line-tension=0.05,0.3", "max-time=400"]

    def longest_first(self, table):
        """The lengths and places of the dwells of every row. The longest dwell comes first. Each later entry is a
        shorter dwell that was earlier in the run."""
        names = ["longest_dwell", *(f"earlier_dwell_{i}" for i in range(1, 8))]
        return [[(row[name], row[name + "_at"]) for name in names if row[name] > 0] for _, row in table.iterrows()]

    def expected_endings(self, table, dwell):
        """The distance of each run until its droplet rested longer than `dwell`, and whether the droplet rested so
        long. Both are computed from the table alone."""
        for row, dwells in zip(table.itertuples(), self.longest_first(table)):
            stood = [place for length, place in reversed(dwells) if length > dwell]
            is_clogged = row.status == "clogged"
            yield (stood[0], True) if stood else (row.distance, True) if is_clogged else (row.last_dwell_at, False)

    def test_droplets_that_have_not_moved_for_a_time_can_count_as_clogged(self):
        table = self.sweep(*self.DWELLING)
        usual = {group["line_tension"]: group for group in self.fit()["groups"]}
        stood_and_went_on = 0
        for dwell in (17, 25, 60, 399):
            for group in self.fit("--dwell", dwell)["groups"]:
                rows = table[table.line_tension == group["line_tension"]]
                ends = list(self.expected_endings(rows, dwell))
                clogs = sum(is_end for _, is_end in ends)
                self.assertEqual((group["dwell"], group["runs"], group["clogs"]), (dwell, 8, clogs))
                total = sum(max(place, 0) for place, _ in ends)
                self.assertAlmostEqual(group["total_distance"], total, places=12)
                self.assertEqual(group["clogging_length"] is None, clogs == 0)
                if clogs:
                    self.assertAlmostEqual(group["clogging_length"], total / clogs, places=12)
                # If a droplet moved on after its rest, its mechanism is unknown. Speeds come from all runs.
                of_clogs = usual[group["line_tension"]]
                self.assertEqual(group["flowing"], 8 - clogs)
                self.assertLessEqual(group["squeezed"], of_clogs["squeezed"])
                self.assertEqual(group["relative_speed"], of_clogs["relative_speed"])
                stood_and_went_on += clogs - of_clogs["clogs"]
        self.assertGreater(stood_and_went_on, 0)
        self.assertIn("hybrid, other (for instance at rest on one obstacle; or droplets that moved on)\n",
                      self.succeed("clogfit", "sweep.h5", "--dwell=25").stdout)

    def test_lengths_rise_with_the_time_to_those_of_clogs_alone(self):
        self.sweep(*self.DWELLING)
        known = [group["dwells_known_from"] for group in self.fit()["groups"]]
        self.assertAlmostEqual(min(known), 10 * 0.05 / 0.03, places=12)
        results = []
        for dwell in [*np.geomspace(max(known), 400, 8)[1:-1], 399.9, 400, 1e9]:
            groups = self.fit("--dwell", dwell)["groups"]
            results.append([(group["total_distance"], group["clogs"]) for group in groups])
        for shorter, longer in zip(results, results[1:]):
            for (way, clogs), (longer_way, fewer_clogs) in zip(shorter, longer):
                self.assertGreaterEqual(longer_way, way)
                self.assertLessEqual(fewer_clogs, clogs)
        self.assertLess(results[0], results[-1])
        # Runs last 400 t0, so no droplet rests longer, and these values of --dwell change nothing.
        usual = self.fit()["groups"]
        for dwell in (400, 1e9):
            self.assertEqual(self.fit("--dwell", dwell)["groups"], usual)
        # With --dwell, the distance of a droplet that was still moving ends at its last dwell. This is at most 0.05
        # before its end, because a droplet that moves by less counts as resting.
        for (way, clogs), group in zip(results[-3], usual):
            self.assertEqual(clogs, group["clogs"])
            self.assertLess(group["total_distance"] - way, 0.05 * (group["flowing"] + 1))

    def test_a_fit_of_dwells_says_what_it_calls_clogged(self):
        self.sweep("seeds=1..2", "line-tension=0.05", "max-time=40,60")
        text = self.succeed("clogfit", "sweep.h5", "--dwell=50").stdout
        self.assertIn("\nclogged: has not moved by 0.05 sigma for 50 t0; "
                      "where max_time is not longer, this is the fit without --dwell\n", text)
        self.assertIn("\nclogged: has not moved by 0.05 sigma for 20 t0\n",
                      self.succeed("clogfit", "sweep.h5", "--dwell=20").stdout)
        self.assertIn("\nno run lasts longer than --dwell=60, so this is the fit without --dwell\n",
                      self.succeed("clogfit", "sweep.h5", "--dwell=60").stdout)
        self.assertNotIn("clogged:", self.succeed("clogfit", "sweep.h5").stdout)
        self.assertEqual([group["dwell"] for group in self.fit("--dwell=50")["groups"]], [None, 50])

    def test_dwells_that_are_not_known_are_refused(self):
        self.sweep("seeds=1..2", "line-tension=0.05", "max-time=60")
        self.refuse("clogfit", "sweep.h5", "--dwell=10", words=["--dwell=10 (the rows do not hold", "use 16.7 or more"])
        self.succeed("clogfit", "sweep.h5", "--dwell=16.7")
        self.change(**{name: np.nan for name in stored_rows.columns(self.folder / "sweep.h5")
                       if "dwell" in name and name != "dwell_length"})
        group, = self.fit()["groups"]
        self.assertEqual((group["runs"], group["dwell_length"], group["dwells_known_from"]), (2, 0.05, None))
        self.refuse("clogfit", "sweep.h5", "--dwell=20",
                    words=["--dwell=20 (2 rows of a version", "compute the sweep anew"])
        self.assertIn("this is the fit without --dwell", self.succeed("clogfit", "sweep.h5", "--dwell=60").stdout)

    def test_numbers_have_their_unit_in_json_as_in_the_table(self):
        self.sweep("seeds=1..2", *FAR)
        fit = self.fit()
        in_table = stored.read_table(self.folder / "sweep.h5").attrs
        self.assertEqual(in_table["units"]["mean_speed"], "sqrt(sigma g)")
        self.assertEqual(in_table["units"]["mean_speed_error"], "sqrt(sigma g)")
        self.assertEqual(in_table["units"]["seed"], "")
        self.assertIn("obstacle surfaces", in_table["meanings"]["obstacle_gap"])
        group = fit["groups"][0]
        shared = set(group) & set(in_table["units"])
        self.assertIn("line_tension", shared)
        for name in shared:
            self.assertEqual(fit["units"].get(name, ""), in_table["units"][name], name)
        self.assertEqual(fit["units"]["relative_speed_pooled_error"], "v_t")
        self.assertEqual(fit["units"]["clogging_length_wrapped_upper"], "sigma")
        self.assertLessEqual(set(fit["units"]), set(group))
        self.assertNotIn("mean_speed", group)  # The sweep's table has a column of this name in other units.

    def test_it_says_what_spoils_a_length(self):
        self.sweep("seeds=1..24", *FAR)
        # These distances are far from exponential.
        self.change(distance=np.linspace(5, 5.1, 24), status=[b"clogged"] * 24)
        fit = self.fit()
        group, = fit["groups"]
        self.assertEqual(group["doubts"], "not_exponential")
        text = self.succeed("clogfit", "sweep.h5").stdout
        self.assertIn("x: P(r) is not exponential", text)
        self.assertIn("x: " + fit["doubts"]["not_exponential"], text)
        self.assertNotIn("f: ", text)
        self.change(status=[b"clogged"] * 3 + [b"running"] * 21)
        group, = self.fit()["groups"]
        self.assertIn("few_clogs", group["doubts"])
        self.assertIn("incomplete", group["doubts"])
        self.assertIn("f: fewer than 5 clogs", self.succeed("clogfit", "sweep.h5").stdout)

    def test_equal_runs_are_doubted(self):
        self.sweep("seeds=1..12", *FAR)
        apart, close = np.linspace(1, 9, 12), 5 + 1e-4 * np.linspace(0, 1, 12)
        met = {"contacts": 1, "first_contact_at": 0.5}
        for clogs, distance, are_met, is_doubtful in [(12, apart, met,
                                                       False), (12, np.repeat(apart[:6], 2), met, True), (6, np.repeat(apart[:6], 2), met, True),
                                                      (6, np.repeat(apart[:6], 2), {"contacts": 0, "first_contact_at": np.nan}, True),
                                                      (12, np.repeat(apart[:3], [3, 2, 7]),
                                                       met, True), (12, np.append(apart[:7], [9] * 5), met, False),
                                                      (6, np.append(apart[:6], [9] * 6),
                                                       met, False),  # droplets that were still moving
                                                      (0, np.repeat(apart[:6], 2), met,
                                                       True), (0, apart, met, False), (12, np.zeros(12), met, True),
                                                      (12, np.append(apart[:5], close[:7]), met, True),
                                                      (0, close, met, False),
                                                      # Droplets that sink freely all reach the same distance.
                                                      (0, [9.0] * 12, {"contacts": 0, "first_contact_at": np.nan}, False)]:
            self.change(distance=distance, status=[b"clogged"] * clogs + [b"flowing"] * (12 - clogs), **are_met)
            doubts = (self.fit()["groups"][0]["doubts"] or "").split()
            self.assertEqual("equal_distances" in doubts, is_doubtful, (clogs, distance))

    def test_clogs_at_one_place_are_doubted_in_the_table_too(self):
        self.sweep("seeds=1..12", *FAR)
        self.change(distance=np.append(np.linspace(1, 4, 5), 5 + 1e-4 * np.linspace(0, 1, 7)), status=[b"clogged"] * 12,
                    contacts=1, first_contact_at=0.5)
        text = self.succeed("clogfit", "sweep.h5").stdout
        self.assertRegex(text, r" ex?\n(.*\n)*e: at least half of the clogs .* at one place")

    def test_runs_that_went_farther_than_the_box_are_counted_and_doubted(self):
        self.sweep("seeds=1..6", *FAR)
        self.change(distance=[1, 5, 20, 19, 3, 2], status=[b"clogged"] * 6)
        group, = self.fit()["groups"]
        self.assertEqual((group["repeating"], group["doubts"]), (0, None))
        self.change(distance=[1, 5, 20.1, 30, 3, 2])
        fit = self.fit()
        group, = fit["groups"]
        self.assertEqual((group["repeating"], group["doubts"]), (2, "array_repeats"))
        self.assertIn("r: " + fit["doubts"]["array_repeats"], self.succeed("clogfit", "sweep.h5").stdout)

    def test_a_long_array_repeats_later(self):
        self.sweep("seeds=1..6", *FAR, "boxes=1,3")
        self.change(distance=np.repeat([1, 5, 20.1, 30, 3, 61], 2), status=[b"clogged"] * 12)
        self.assertEqual([(group["boxes"], group["repeating"]) for group in self.fit()["groups"]], [(1, 3), (3, 1)])

    def test_lattices_repeat_without_a_doubt(self):
        self.sweep("seeds=1..6", *FAR, "obstacle-layout=lattice", "obstacle-gap=1.2")
        self.change(distance=[10, 50, 20, 30, 40, 60], status=[b"clogged"] * 6, contacts=1, first_contact_at=0.1)
        group, = self.fit()["groups"]
        self.assertEqual((group["repeating"], group["doubts"]), (0, None))

    def test_lengths_below_one_spacing_are_doubted(self):
        self.sweep("seeds=1..6", *FAR, "obstacle-gap=0.2")  # the spacing is 0.5
        self.change(distance=[0.1, 0.2, 0.4, 0.6, 0.8, 0.91], status=[b"clogged"] * 6)
        self.assertIsNone(self.fit()["groups"][0]["doubts"])
        self.change(distance=[0.1, 0.2, 0.4, 0.6, 0.8, 0.89])
        fit = self.fit()
        self.assertEqual(fit["groups"][0]["doubts"], "below_spacing")
        self.assertIn("v: " + fit["doubts"]["below_spacing"], self.succeed("clogfit", "sweep.h5").stdout)

    def test_what_was_not_tested_is_doubted(self):
        self.sweep("seeds=1..5", *FAR, "line-tension=1,30")
        self.change(distance=[1, 2, 3, 4, 5] * 2, status=[b"clogged"] * 10, contacts=1, first_contact_at=0.1)
        fit = self.fit()
        self.assertEqual([group["doubts"] for group in fit["groups"]], [None, "untested"])
        self.assertIn("u: " + fit["doubts"]["untested"], self.succeed("clogfit", "sweep.h5").stdout)

    def test_lengths_can_count_from_a_distance_on(self):
        self.sweep("seeds=1..8", *FAR)
        mechanisms = [b"squeezed"] * 4 + [b"wrapped"] * 2 + [b"none"] * 2
        self.change(distance=[0.2, 0.4, 0.5, 1.5, 2.5, 3.5, 0.3, 4.5], mechanism=mechanisms,
                    status=[b"clogged"] * 6 + [b"flowing"] * 2)
        group, = self.fit("--from-distance", 0.5)["groups"]
        self.assertEqual((group["runs"], group["clogs"], group["left_out"]), (5, 4, 3))
        self.assertEqual((group["clogging_length"], group["total_distance"]), (10 / 4, 10))
        self.assertEqual((group["squeezed"], group["wrapped"], group["clogging_length_wrapped"]), (2, 2, 5))
        self.assertEqual([step["distance"] for step in group["survival"]], [0, 1, 2, 3])
        text = self.succeed("clogfit", "sweep.h5", "--from-distance=0.5").stdout
        self.assertIn("3 runs ended before --from-distance, left out of runs, clogs and lambda; "
                      "<v_g> is still of all runs", text)
        # Mechanisms are also printed if all remaining runs clogged by the same mechanism.
        self.assertRegex(self.succeed("clogfit", "sweep.h5", "--from-distance=3").stdout, "w/s/h/o.*\n.* 1/0/0/0 ")
        group, = self.fit()["groups"]
        self.assertEqual((group["runs"], group["clogs"], group["left_out"]), (8, 6, 0))
        group, = self.fit("--from-distance", 100)["groups"]
        self.assertEqual((group["runs"], group["clogs"], group["left_out"]), (0, 0, 8))
        self.assertIsNone(group["doubts"])  # There are no runs.
        text = self.succeed("clogfit", "sweep.h5", "--from-distance=100").stdout
        for words in ("> 0", "w/s/h/o"):
            self.assertNotIn(words, text)

    def test_each_mechanism_has_a_length_of_its_own(self):
        self.sweep("seeds=1..10", *FAR)
        mechanisms = [b"wrapped"] * 2 + [b"squeezed"] * 4 + [b"hybrid"] + [b"none"] * 3
        self.change(distance=np.arange(1.0, 11), status=[b"clogged"] * 8 + [b"flowing"] * 2, mechanism=mechanisms)
        group, = self.fit()["groups"]
        kinds = ("wrapped", "squeezed", "hybrid", "other")
        self.assertEqual([group[kind] for kind in kinds], [2, 4, 1, 1])
        lengths = [group[f"clogging_length_{kind}"] for kind in kinds]
        self.assertEqual(lengths, [55 / 2, 55 / 4, 55, 55])
        self.assertAlmostEqual(sum(1 / length for length in lengths), 1 / group["clogging_length"], places=12)
        self.assertLess(group["clogging_length_wrapped_lower"], 55 / 2)
        self.assertGreater(group["clogging_length_wrapped_upper"], 55 / 2)
        self.assertRegex(self.succeed("clogfit", "sweep.h5").stdout, "w/s/h/o.*\n.* 2/4/1/1 ")
        self.change(mechanism=[b"squeezed"] * 8 + [b"none"] * 2)
        group, = self.fit()["groups"]
        self.assertEqual((group["wrapped"], group["clogging_length_wrapped"]), (0, None))
        self.assertGreater(group["clogging_length_wrapped_lower"], 0)
        text = self.succeed("clogfit", "sweep.h5").stdout
        self.assertNotIn("w/s/h", text)
        self.assertIn("\nclogs: all squeezed\n", text)
        self.change(mechanism=[b"none"] * 10)
        self.assertIn("\nclogs: all other (for instance", self.succeed("clogfit", "sweep.h5").stdout)
        self.change(status=[b"flowing"] * 10)
        self.assertNotIn("clogs: all", self.succeed("clogfit", "sweep.h5").stdout)

    def test_a_list_of_vertices_is_printed_though_they_may_be_automatic(self):
        self.succeed("clogsweep", "seeds=1..2", "vertices=64,96", "box=20", *FAR, "--output", "sweep.h5")
        self.assertRegex(self.succeed("clogfit", "sweep.h5").stdout, r"\nobstacle_gap +line_tension +vertices +runs")

    def test_different_parameters_have_different_texts(self):
        self.copy_sweep("sweep.h5", *QUICK, "line-tension=1,1.00001,0.123456", "seeds=1")
        text = self.succeed("clogfit", "sweep.h5").stdout
        for value in ("1", "1.00001", "0.123456"):
            self.assertRegex(text, rf" {value} +1 ")
        self.copy_sweep("sweep.h5", *QUICK, "line-tension=1,0.123456", "seeds=1")
        self.assertRegex(self.succeed("clogfit", "sweep.h5").stdout, r" 0\.1235 +1 ")
        self.refuse("clogfit", "sweep.h5", "--lines", "2", words=["no place for --lines"])

    def test_clogs_that_the_mesh_may_hold_are_marked(self):
        self.sweep("seeds=1..10", *FAR)
        self.change(distance=3 * EXPONENTIAL, status=[b"clogged"] * 10, mechanism=[b"wrapped"] * 10,
                    mesh_hold=[0.009] * 10)
        group, = self.fit()["groups"]
        self.assertEqual((group["on_mesh"], group["doubts"]), (0, None))
        self.change(mesh_hold=[0.009] * 9 + [0.011])
        group, = self.fit()["groups"]
        self.assertEqual((group["on_mesh"], group["doubts"]), (1, "held_by_mesh"))
        self.assertRegex(self.succeed("clogfit", "sweep.h5").stdout, "m: in a tenth of the clogs or more.* mesh_hold")

    def test_where_the_mesh_hold_is_unknown_all_that_hang_are_marked(self):
        self.sweep("seeds=1..10", *FAR)
        self.change(status=[b"clogged"] * 10, distance=3 * EXPONENTIAL, mechanism=[b"hybrid"] + [b"squeezed"] * 9,
                    mesh_hold=np.nan)
        group, = self.fit()["groups"]
        self.assertEqual((group["on_mesh"], group["doubts"]), (1, "held_by_mesh"))

    def test_break_up_is_a_cause_of_its_own(self):
        self.sweep("seeds=1..10", "break-up-neck=0.05", *FAR)
        status = [b"clogged", b"broken", b"broken", b"clogged", b"flowing"] * 2
        necks = [0.04 if one == b"broken" else np.nan for one in status]
        self.change(distance=np.arange(1.0, 11), status=status,
                    mechanism=[b"squeezed" if one == b"clogged" else b"none" for one in status], thinnest_neck=necks,
                    thinnest_neck_at=necks)
        group, = self.fit()["groups"]
        self.assertEqual([group[name] for name in ("runs", "clogs", "broken", "flowing", "squeezed", "other")],
                         [10, 4, 4, 2, 4, 0])
        self.assertEqual([group[name] for name in ("total_distance", "clogging_length", "break_up_length")],
                         [55, 55 / 4, 55 / 4])
        self.assertTrue(group["break_up_length_lower"] < 55 / 4 < group["break_up_length_upper"])
        # Computed by hand: when a run ends, the incidence grows by P/n, with the P just before the end and n runs at
        # risk. P/n is 1/10 until a run is censored at 5. After 5, P is 6/10 and n is 5.
        broken = [(step["distance"], round(step["probability"], 12)) for step in group["incidence"]["broken"]]
        self.assertEqual(broken, [(2, 0.1), (3, 0.2), (7, 0.32), (8, 0.44)])
        clogged = [round(step["probability"], 12) for step in group["incidence"]["squeezed"]]
        self.assertEqual(clogged, [0.1, 0.2, 0.32, 0.44])
        self.assertEqual(set(group["incidence"]), {"squeezed", "broken"})
        self.assertEqual(group["censored_distances"], [2, 3, 5, 7, 8, 10])  # Clogged runs are not listed.
        text = self.succeed("clogfit", "sweep.h5").stdout
        self.assertRegex(text, r"95 % +broken +lambda_b/sigma.*\n.* 4 +13\.\d+ ")
        self.assertIn("lambda_b: mean distance before break-up", text)
        self.assertNotIn("w/s/h/o", text)
        # The run of a droplet that rested for long ends at the place of this rest, even if the droplet broke later.
        # The run of a droplet that did not rest ends where the droplet broke.
        dwells = [name for name in stored_rows.columns(self.folder / "sweep.h5")
                  if name.startswith(("longest_dwell", "earlier_dwell"))]
        self.change(**{name: np.nan for name in dwells})
        self.assertEqual(self.fit("--dwell", 0.9)["groups"][0]["broken"], 4)
        self.change(longest_dwell=[np.nan, 0.95] + [np.nan] * 8, longest_dwell_at=[np.nan, 0.01] + [np.nan] * 8,
                    longest_dwell_from=[np.nan, 0] + [np.nan] * 8)
        group, = self.fit("--dwell", 0.9)["groups"]
        self.assertEqual((group["broken"], group["other"]), (3, 1))
        self.change(status=[b"flowing"] * 10, mechanism=b"none", thinnest_neck=np.nan, thinnest_neck_at=np.nan)
        group, = self.fit()["groups"]
        self.assertEqual((group["broken"], group["break_up_length"], group["incidence"]), (0, None, {}))
        self.assertNotIn("broken", self.succeed("clogfit", "sweep.h5").stdout)

    def test_runs_of_different_model_versions_are_fitted_apart(self):
        self.sweep("max-time=60", "line-tension=2", "seeds=1..4")
        self.change(model_version=[3, 3, 5, 5])
        self.assertEqual([(group["model_version"], group["runs"]) for group in self.fit()["groups"]], [(3, 2), (5, 2)])
        self.assertRegex(self.succeed("clogfit", "sweep.h5").stdout, r"model_version +runs")

    def test_files_of_format_version_9_lack_the_newest_columns(self):
        self.sweep("max-time=60", "line-tension=2", "seeds=1..3")
        before, = self.fit()["groups"]
        stored_rows.make_older(self.folder / "sweep.h5", "9", ["film_friction", "laboratory", "processor_seconds"])
        group, = self.fit()["groups"]
        self.assertEqual((group["film_friction"], group["laboratory"], group["clogging_length"]),
                         ("off", "none", before["clogging_length"]))
        self.assertEqual(len(stored.read_rows(self.folder / "sweep.h5")), 3)
        self.succeed("clogsweep", "verify", "sweep.h5")

    def test_groups_agree_with_pandas(self):
        rows = self.sweep("max-time=60", "line-tension=0.4,2", "obstacle-gap=0.2,0.8", "seeds=1..6")
        groups = self.fit()["groups"]
        self.assertEqual(len(groups), 4)
        for group in groups:
            mine = rows[(rows.line_tension == group["line_tension"]) & (rows.obstacle_gap == group["obstacle_gap"])]
            clogs = int((mine.status == "clogged").sum())
            total = mine.distance.clip(lower=0).sum()
            self.assertEqual(group["clogs"], clogs)
            self.assertAlmostEqual(group["total_distance"], total, places=12)
            if clogs:
                self.assertAlmostEqual(group["clogging_length"], total / clogs, places=12)
            else:
                self.assertIsNone(group["clogging_length"])
                self.assertIsNone(group["clogging_length_upper"])
                self.assertAlmostEqual(group["clogging_length_lower"], total / math.log(20), places=12)
            speeds = (mine.mean_speed / mine.terminal_speed).dropna()
            if len(speeds) < 3:
                self.assertIsNone(group["relative_speed"])
            else:
                self.assertAlmostEqual(group["relative_speed"], speeds.mean(), places=12)
                self.assertAlmostEqual(group["relative_speed_error"], speeds.sem(), places=12)
                ratio = (mine.mean_speed / mine.terminal_speed * mine.travel_time).sum() / mine.travel_time.sum()
                self.assertAlmostEqual(group["relative_speed_pooled"], ratio, places=12)

    def test_steady_speeds_agree_with_pandas_and_are_unset_without_their_columns(self):
        rows = self.sweep("max-time=60", "terminal-speed=0.2", "line-tension=0.4,2", "obstacle-gap=0.4,0.8",
                          "seeds=1..8")
        known = 0
        for group in self.fit()["groups"]:
            mine = rows[(rows.line_tension == group["line_tension"]) & (rows.obstacle_gap == group["obstacle_gap"])]
            # The steady speed begins after 5 sigma/V_t = 25 t0, and ends with the run. For a clogged droplet it ends at
            # the last dwell.
            end = mine.time.where(mine.status != "clogged", mine.last_dwell_from)
            self.assertEqual((end > 25.4).tolist(), mine.steady_time.notna().tolist())
            mine = mine[mine.steady_time.notna()]
            np.testing.assert_allclose(mine.steady_time, end[mine.index] - 25, atol=0.4)  # the next check
            self.assertEqual(group["relative_speed_steady_runs"], len(mine))
            if len(mine) < 3:
                self.assertIsNone(group["relative_speed_steady"])
                continue
            known += 1
            distance, time = mine.steady_distance / mine.terminal_speed, mine.steady_time
            self.assertAlmostEqual(group["relative_speed_steady"], distance.sum() / time.sum(), places=12)
            without = (distance.sum() - distance) / (time.sum() - time)
            self.assertAlmostEqual(group["relative_speed_steady_error"],
                                   math.sqrt((len(mine) - 1) * without.var(ddof=0)), places=12)
        self.assertGreater(known, 1)
        self.assertEqual(self.fit()["units"]["relative_speed_steady_error"], "v_t")
        before = self.fit()["groups"]
        self.change(steady_distance=np.nan, steady_time=np.nan)  # as in a file of version 1.0
        for old, new in zip(self.fit()["groups"], before):
            self.assertEqual([old[f"relative_speed_steady{end}"] for end in ("", "_error", "_runs")], [None, None, 0])
            self.assertEqual([old[name] for name in ("relative_speed", "relative_speed_all", "clogging_length")],
                             [new[name] for name in ("relative_speed", "relative_speed_all", "clogging_length")])
        self.assertRegex(self.succeed("clogfit", "sweep.h5").stdout, r"<v_g>/v_t +\+- +of +all runs")

    def test_interrupted_runs_are_censored(self):
        self.sweep("seeds=1..3", *FAR)
        self.change(distance=[1, 2, 3], status=[b"clogged", b"flowing", b"interrupted"])
        group, = self.fit()["groups"]
        self.assertEqual((group["clogging_length"], group["runs"], group["interrupted"]), (6, 3, 1))
        self.assertIn("1 run is unfinished: lambda holds for the distances reached so far",
                      self.succeed("clogfit", "sweep.h5").stdout)

    def test_failed_runs_are_censored_where_they_were_sound(self):
        self.sweep("seeds=1..7", *FAR)
        status = [b"clogged"] * 3 + [b"flowing"] + [b"failed"] * 3
        # The results of a failed droplet after its last passed check have no effect.
        self.change(distance=[1, 2.5, 7, 10, 1e300, np.nan, 12], sound_distance=[1, 2.5, 7, 10, 0.5, 4, 6.25],
                    status=status, failed_by=[b"none"] * 4 + [b"divergence", b"crash", b"crossing"])
        group, = self.fit()["groups"]
        # From R 4.2.2, package survival 3.5-3:
        #   d <- c(1, 2.5, 7, 10, 0.5, 4, 6.25); clog <- c(1, 1, 1, 0, 0, 0, 0)
        #   exp(coef(survreg(Surv(d, clog) ~ 1, dist="exponential", control=survreg.control(rel.tolerance=1e-14))))
        #   s <- summary(survfit(Surv(d, clog) ~ 1)); cbind(s$time, s$n.risk, s$surv)
        self.assertAlmostEqual(group["clogging_length"], 10.4166666666667, delta=1e-9)
        self.assertEqual([(step["distance"], step["at_risk"])
                          for step in group["survival"]], [(1, 6), (2.5, 5), (7, 2)])
        for step, probability in zip(group["survival"], [0.833333333333333, 0.666666666666667, 0.333333333333333]):
            self.assertAlmostEqual(step["probability"], probability, delta=1e-9)
        self.assertEqual((group["runs"], group["clogs"], group["failed"], group["failed_somewhere"]), (7, 3, 3, 0))
        self.assertAlmostEqual(group["failures_per_length"], 3 / 31.25, places=12)
        self.assertEqual(group["doubts"], "few_clogs censored_by_time")
        self.assertEqual(group["censored_distances"], [0.5, 4, 6.25, 10])
        text = self.succeed("clogfit", "sweep.h5").stdout
        self.assertRegex(text, r"failed +per 1000 sigma .*\n.* 3 +96\.0 ")
        self.assertIn("3 failed; the column `message` says why, and counted as not clogged up to sound_distance", text)
        self.succeed("clogsweep", "verify", "sweep.h5")
        # --from-distance excludes all runs that ended before this distance, even failed ones.
        group, = self.fit("--from-distance", 5)["groups"]
        self.assertEqual((group["runs"], group["left_out"], group["total_distance"]), (3, 4, 2 + 5 + 1.25))

    def test_files_of_older_versions_tell_only_where_droplets_crossed_themselves(self):
        self.sweep("seeds=1..6", *FAR)
        self.change(distance=[1, 2, 3, 4, 5, 50], status=[b"clogged"] * 3 + [b"failed"] * 3,
                    message=[b""] * 3 + [b"the interface crossed itself by t=9; try",
                                         b"diverged at t=3", b"its process was ended by SIGSEGV"])
        new = ["sound_distance", "failed_by", "healed_crossings", "friction_use", "stability"]
        stored_rows.make_older(self.folder / "sweep.h5", "10", new)
        group, = self.fit()["groups"]
        self.assertEqual([group[name] for name in ("runs", "total_distance", "failed", "failed_somewhere")],
                         [4, 10, 3, 2])
        self.assertIn("incomplete", group["doubts"])
        self.assertIn("counted as not clogged up to sound_distance, except 2 without one",
                      self.succeed("clogfit", "sweep.h5").stdout)

    def test_failures_are_a_doubt_where_they_could_move_the_length_out_of_its_interval(self):
        self.sweep("seeds=1..10", *FAR)
        for num_failed, is_doubtful in ((0, False), (4, False), (5, True), (7, True)):
            # If failures were clogs, seven droplets would have clogged, and lambda would be 10/7.
            clogs = 7 - num_failed
            self.change(distance=1.0, sound_distance=1.0,
                        status=[b"clogged"] * clogs + [b"flowing"] * 3 + [b"failed"] * num_failed)
            lower = 20 / scipy.stats.chi2.ppf(0.975, 2 * clogs + 1) if clogs else 10 / -math.log(0.05)
            self.assertEqual(10 / 7 < lower, is_doubtful, num_failed)
            self.assertEqual("failures_matter" in (self.fit()["groups"][0]["doubts"] or ""), is_doubtful)

    def test_failures_at_random_places_do_not_move_the_length(self):
        self.sweep("seeds=1..120", "line-tension=0.5,2", *FAR)
        rows = stored.read_table(self.folder / "sweep.h5", BIN)
        may_fail = (rows.line_tension == 2).to_numpy()
        random = np.random.default_rng(1)
        clogs = np.zeros(2)
        distances = np.zeros(2)
        for _ in range(30):
            ends = [random.exponential(10, len(rows)), np.where(may_fail, random.exponential(10, len(rows)), np.inf),
                    np.full(len(rows), 30.0)]
            status = np.array([b"clogged", b"failed", b"flowing"])[np.argmin(ends, axis=0)]
            self.change(distance=np.min(ends, axis=0), sound_distance=np.min(ends, axis=0), status=status)
            groups = self.fit()["groups"]
            clogs += [group["clogs"] for group in groups]
            distances += [group["total_distance"] for group in groups]
        self.assertGreater((status == b"failed").sum(), 40)
        for length, number in zip(distances / clogs, clogs):
            self.assertLess(abs(math.log(length / 10)), 3 / math.sqrt(number))
        one, = json.loads(self.succeed("clogfit", "compare", "sweep.h5", "--by", "line-tension", "--format", "json").stdout)["comparisons"]
        self.assertEqual(one["pairs"], 120)
        self.assertTrue(one["ratio_lower"] < 1 < one["ratio_upper"], one)

    def test_the_longest_run_of_a_pool_counts_even_if_it_failed(self):
        for name, time in (("short", 1), ("long", 2)):
            self.succeed("clogsweep", *SMALL, FAR[1], "line-tension=0.5", "seeds=1..3", f"max-time={time}", "--output",
                         f"{name}.h5")
        self.succeed("clogsweep", "merge", "short.h5", "long.h5", "--output", "sweep.h5")
        rows = stored.read_table(self.folder / "sweep.h5", BIN)
        fails = ((rows.max_time == 2) & (rows.seed > 1)).to_numpy()
        crashes = fails & (rows.seed == 3).to_numpy()
        self.change(distance=np.where(fails, np.nan, 1.0), sound_distance=np.where(fails, 2.0, 1.0),
                    status=np.where(fails, b"failed", b"flowing"),
                    failed_by=np.where(crashes, b"crash", np.where(fails, b"crossing", b"none")))
        group, = self.fit("--pool=max-time")["groups"]
        self.assertEqual((group["runs"], group["repeated"], group["failed"], group["total_distance"]),
                         (3, 3, 1, 1 + 2 + 1))

    def test_clogs_near_the_limit_of_friction_are_marked(self):
        self.sweep("seeds=1..10", *FAR)
        for use, doubts in (([0.96] + [0.5] * 9,
                             None), ([0.96] + [1.0] * 9, None), ([0.96] * 2 + [np.nan] * 8, "near_friction_limit")):
            self.change(distance=3 * EXPONENTIAL, status=[b"clogged"] * 10, mechanism=[b"wrapped"] * 10,
                        mesh_hold=0.0, friction_use=use)
            self.assertEqual(self.fit()["groups"][0]["doubts"], doubts)
        self.assertIn("\nh: more than 15 % of the clogs", self.succeed("clogfit", "sweep.h5").stdout)

    def test_droplets_that_passed_are_counted(self):
        self.sweep("seeds=1..4", *FAR)
        self.assertNotIn("passed", self.succeed("clogfit", "sweep.h5").stdout)
        self.change(distance=[1, 2, 3, 3], status=[b"clogged", b"flowing", b"passed", b"passed"])
        group, = self.fit()["groups"]
        self.assertEqual((group["clogs"], group["passed"], group["flowing"]), (1, 2, 1))
        self.assertRegex(self.succeed("clogfit", "sweep.h5").stdout, r"clogs +passed")
        self.assertIn(", 1 clogged, 1 flowing, 0 failed, 2 passed;",
                      self.succeed("clogsweep", "status", "sweep.h5").stdout)
        self.assertEqual(json.loads(self.succeed("clogsweep", "status", "sweep.h5", "--format", "json").stdout)["passed"], 2)

    def test_physically_impossible_rows_are_excluded_with_a_doubt(self):
        self.sweep("seeds=1..8", *FAR)
        distance = np.array([1.0, 2, 3, 4, 5, 6, 7, 8])
        self.change(distance=distance, status=[b"clogged"] * 8)
        self.assertNotIn("damaged", self.fit()["groups"][0]["doubts"] or "")
        for absurd in (1e308, -1e300, np.nan, np.inf):
            with self.subTest(distance=absurd):
                distance[7] = absurd
                self.change(distance=distance)
                fit = self.fit()
                group, = fit["groups"]
                self.assertEqual((group["runs"], group["damaged"], group["clogging_length"]), (7, 1, 4))
                self.assertEqual(group["doubts"], "damaged")
                text = self.succeed("clogfit", "sweep.h5").stdout
                self.assertIn("d: " + fit["doubts"]["damaged"], text)
                self.assertIn("1 damaged", text)
                self.assertIn("1 damaged", self.succeed("clogsweep", "status", "sweep.h5").stdout)

    def test_nothing_clogged_is_a_lower_bound(self):
        self.sweep("seeds=1..3", *FAR)
        self.change(distance=[10, 20, 30], status=[b"flowing"] * 3, mean_speed=np.nan)
        self.assertIn("> 20.0 ", self.succeed("clogfit", "sweep.h5").stdout)  # 60/log(20)
        self.assertIn("> 26.1 ", self.succeed("clogfit", "sweep.h5", "--confidence", 0.9).stdout)  # 60/log(10)

    def test_the_table_in_every_format(self):
        self.sweep("max-time=60", "line-tension=0.4,2", "seeds=1..3")
        text = self.succeed("clogfit", "sweep.h5").stdout
        for word in ("obstacle_gap", "line_tension", "lambda/sigma", "95 %", "<v_g>/v_t", "vertices=64"):
            self.assertIn(word, text)
        lines = list(csv.DictReader(io.StringIO(self.succeed("clogfit", "sweep.h5", "--format", "csv").stdout)))
        groups = self.fit()["groups"]
        self.assertEqual(len(lines), 2)
        for line, group in zip(lines, groups):
            self.assertEqual(list(line), [name for name in group
                                          if name not in ("automatic", "survival", "incidence", "censored_distances")])
            self.assertEqual(float(line["total_distance"]), group["total_distance"])

    def test_numbers_have_the_figures_that_their_interval_allows(self):
        self.sweep("seeds=1..12", *FAR, "line-tension=0.3,1,3")
        chance = np.random.default_rng(1)
        lengths = np.tile([0.05, 7, 30], 12)  # In the order of the tasks, the seeds vary slowest.
        self.change(distance=np.minimum(lengths * chance.exponential(size=36), 90), status=[b"clogged"] * 36,
                    steady_distance=50 * chance.uniform(0.2, 0.4, 36), steady_time=0.5)
        text = self.succeed("clogfit", "sweep.h5").stdout
        for group in self.fit()["groups"]:
            value, lower, upper = re.fullmatch(r"(\S+) \((\S+) to (\S+)\)", rounded.with_interval(
                *(group["clogging_length" + which] for which in ("", "_lower", "_upper")))).groups()
            steady = [group["relative_speed_steady" + which] for which in ("", "_error")]
            speed, error = rounded.with_error(*steady).split(" \u00b1 ")
            self.assertRegex(text, rf"\n +\S+ +{group['line_tension']:g} +12 +12 +{value} +{lower} \.\. {upper}"
                                   rf" +{speed} +{error} ")
        self.assertGreater(len(str(self.fit()["groups"][0]["clogging_length"])), 12)

    def test_lattices_have_a_migration_angle(self):
        keys = ["model=sp", "wall-stiffness=10", "obstacle-layout=lattice", "obstacle-gap=1.2", "lattice-angle=-10,15"]
        self.succeed("clogsweep", *keys, "box=60", "max-time=2000", "seeds=1..4", "--output", "sweep.h5")
        rows = pandas.read_hdf(self.folder / "sweep.h5", "runs")
        groups = self.fit()["groups"]
        self.assertEqual(len(groups), 2)
        for group in groups:
            mine = rows[rows.lattice_angle == group["lattice_angle"]]
            slope = mine.lateral_displacement.sum() / mine.distance.sum()
            self.assertAlmostEqual(group["lateral_slope"], slope, places=12)
            # Below the critical angle (25.7 degrees for a rigid disk in this lattice), a disk follows the rows of
            # posts.
            self.assertAlmostEqual(slope, math.tan(math.radians(group["lattice_angle"])), delta=0.03)
            self.assertLess(group["lateral_slope_error"], 0.03)
            tangent = math.tan(math.radians(group["lattice_angle"]))
            self.assertAlmostEqual(group["row_share"], slope / tangent, places=12)
            self.assertAlmostEqual(group["row_share_error"], group["lateral_slope_error"] / abs(tangent), places=12)
            self.assertEqual((group["pitch"], group["row_spacing"], group["row_angle"]),
                             (1.5, 1.5, group["lattice_angle"]))
        self.assertRegex(self.succeed("clogfit", "sweep.h5").stdout, "lateral/r +[+]- +along rows +[+]-")

    def test_own_circles_have_a_share_along_the_rows_that_are_stated(self):
        disks = ["model=sp", "wall-stiffness=10", "max-time=1500"]
        # The posts form a rhombic lattice with 8 columns of 8 posts. Each column is shifted against the last by a
        # quarter of the pitch.
        posts = [(1.5 * i + 0.1, (1.5 * (j + i / 4)) % 12) for i in range(8) for j in range(8)]
        self.write("posts.csv", "x,y\n" + "".join(f"{x},{y}\n" for x, y in posts))
        self.succeed("clogsweep", *disks, "obstacles=posts.csv", "box=12", "seeds=1..3",
                     "release=anywhere", "--output", "sweep.h5")
        self.succeed("clogsweep", *disks, "obstacle-layout=lattice", "lattice=rhombic",
                     "pitch=1.5", f"lattice-angle={math.degrees(math.atan(0.25))}",
                     "box=12", "seeds=1..3", "--output", "lattice.h5")
        self.assertEqual(self.fit()["groups"][0]["row_share"], None)
        share = self.fit("--row-angle", str(math.degrees(math.atan(0.25))))["groups"][0]["row_share"]
        self.assertAlmostEqual(share, 1, delta=0.1)
        lattice = json.loads(self.succeed("clogfit", "lattice.h5", "--format", "json").stdout)["groups"][0]
        self.assertAlmostEqual(lattice["row_share"], share, delta=0.1)
        self.assertEqual((lattice["obstacle_filling"], lattice["length"], lattice["box"]), ("rhombic", 12, 12))
        self.assertAlmostEqual(lattice["row_spacing"], 1.5 * 4 / math.sqrt(17))
        self.assertIn("along rows", self.succeed("clogfit", "sweep.h5", "--row-angle=-10").stdout)
        for angle in ("0", "90", "nan", "steep"):
            self.assertEqual(self.run_program("clogfit", "sweep.h5", "--row-angle", angle).returncode, 2, angle)

    def test_random_arrays_have_no_column_for_migration(self):
        self.sweep("seeds=1..3", "max-time=1")
        self.assertNotIn("lateral/r", self.succeed("clogfit", "sweep.h5").stdout)

    def test_mistakes_get_one_line_and_exit_code_2(self):
        self.write("text.h5", "not a table")
        with h5py.File(self.folder / "foreign.h5", "w") as file:
            file["runs"] = [1, 2, 3]
        self.sweep("seeds=1", "max-time=1")
        with h5py.File(self.folder / "sweep.h5", "r") as file, h5py.File(self.folder / "future.h5", "w") as copy:
            file.copy("runs", copy)
            copy.attrs.update(file.attrs)
            copy.attrs["format_version"] = np.bytes_("99")
            copy.attrs["checksums"] = np.bytes_(f"{zlib.crc32(b'99'):08x} format_version\n")
        whole = (self.folder / "sweep.h5").read_bytes()
        (self.folder / "torn.h5").write_bytes(whole[: len(whole) // 2])
        for arguments, words in [
            ([], ["missing sweep file"]),
            (["missing.h5"], ["missing.h5", "no such file"]),
            (["text.h5"], ["text.h5", "not an HDF5 file"]),
            (["foreign.h5"], ["foreign.h5", "not one of clogsweep's"]),
            (["future.h5"], ["future.h5", "format version 99"]),
            (["torn.h5"], ["torn.h5"]),
            (["sweep.h5", "--format", "xml"], ["--format=xml", "text, csv, json"]),
            (["sweep.h5", "--confidence", "1"], ["--confidence=1"]),
            (["sweep.h5", "--confidence", "high"], ["--confidence=high"]),
            (["sweep.h5", "line-tension=1"], ["no place for 'line-tension=1'"]),
            (["sweep.h5", "--from-distance", "-1"], ["--from-distance=-1"]),
            (["sweep.h5", "--dwell", "0"], ["--dwell=0 (must be a positive number)"]),
        ]:
            with self.subTest(arguments=arguments):
                self.refuse("clogfit", *arguments, words=words)


if __name__ == "__main__":
    unittest.main()
