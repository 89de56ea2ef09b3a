"""Tests that every reader counts failed runs up to their last sound check, or prints the number of failed runs.

The tests write failures into the rows of sound sweeps. The course of a failed droplet after its last sound check must
have no effect, so `distance` is absurd in these rows.
"""

import contextlib
import io
import json
import pathlib
import shutil
import unittest
import unittest.mock

import numpy as np
import pandas

import stored_rows
from drawing import Analysis
from stored_rows import fail
from support import BIN, ENDLESS, QUICK, SMALL, TIMING, ProgramTest, table
from test_clogfit import FAR

import clogsweep
from clogsweep import style
from clogsweep.collisions import collision, prediction
from clogsweep.drawing import device, lengths, ratios
from clogsweep.reading import programs, stored

TENSIONS = [0.25, 0.5, 1.0, 2.0]
SWEEP = [*SMALL, *FAR, "line-tension=" + ",".join(map(str, TENSIONS)), "seeds=1..12"]
PRECISE = [*QUICK, "obstacle-gap=0.3", "line-tension=2", "seeds=1..8"]
AMONG_CIRCLES = ["box=20", "release=anywhere", "vertices=64", "max-time=20", "seeds=1..3"]


def without_result(rows, which):
    """Gives rows the status `interrupted`."""
    for name, value in {"status": b"interrupted", "clogged_by": b"none", "mechanism": b"none"}.items():
        rows[name][which] = value


class Readers(Analysis):
    def setUp(self):
        """Makes a sweep. At every line tension three droplets fail, two are interrupted, and seven clog."""
        super().setUp()
        self.copy_sweep("s.h5", *SWEEP)
        stored_rows.change(self.folder / "s.h5", self.spoil)
        rows = table(self.folder / "s.h5")
        self.ways = rows.sound_distance.where(rows.status == "failed", rows.distance)
        self.lengths = {tension: self.ways[rows.line_tension == tension].sum() / 7 for tension in TENSIONS}

    def spoil(self, rows):
        way = rows["line_tension"] * np.random.default_rng(3).exponential(size=len(rows))
        rows["distance"], rows["sound_distance"], rows["status"], rows["failed_by"] = way, way, b"clogged", b"none"
        rows["clogged_by"], rows["mechanism"] = b"certified", b"squeezed"
        for seed, distance in ((3, np.nan), (7, 1e300), (12, -50.0)):
            fail(rows, rows["seed"] == seed, distance, way[rows["seed"] == seed])
        without_result(rows, np.isin(rows["seed"], [1, 8]))

    def fit(self, *arguments):
        return json.loads(self.succeed("clogfit", *arguments, "--format", "json").stdout)

    def check_groups(self, groups, names=("runs", "clogs", "failed", "interrupted")):
        self.assertEqual([group["line_tension"] for group in groups], TENSIONS)
        expected = {"runs": 12, "clogs": 7, "failed": 3, "interrupted": 2}
        for group in groups:
            self.assertEqual({name: group[name] for name in names}, {name: expected[name] for name in names})
            self.assertAlmostEqual(group["total_distance"], 7 * self.lengths[group["line_tension"]], places=9)
            self.assertAlmostEqual(group["clogging_length"], self.lengths[group["line_tension"]], places=9)

    def test_tables_and_states_of_a_sweep(self):
        self.check_groups(self.fit("s.h5")["groups"])
        self.check_groups(self.fit("s.h5", "--pool=max-time")["groups"])
        status = json.loads(self.succeed("clogsweep", "status", "s.h5", "--format", "json").stdout)
        self.assertEqual([status[name] for name in ("clogged", "failed", "unfinished")], [28, 12, 8])
        self.check_groups(status["groups"])
        text = self.succeed("clogsweep", "status", "s.h5").stdout
        self.assertIn("28 clogged, 0 flowing, 12 failed; 8 interrupted", text)
        for printed in (text, self.succeed("clogfit", "s.h5").stdout):
            self.assertIn("12 failed; the column `message` says why, and counted as not clogged up to", printed)
            self.assertIn("8 runs are unfinished", printed)

    def test_parts_of_a_sweep(self):
        for name, condition in (("few.h5", "seed<=6"), ("others.h5", "seed>6"), ("failed.h5", "status=failed")):
            self.succeed("clogsweep", "select", "s.h5", condition, "--output", name)
        self.succeed("clogsweep", "merge", "few.h5", "others.h5", "--output", "merged.h5")
        self.succeed("clogsweep", "salvage", "s.h5", "--output", "whole.h5")
        for files in (["merged.h5"], ["whole.h5"], ["few.h5", "others.h5"], ["s.h5", "failed.h5"]):
            self.check_groups(self.fit(*files)["groups"])
        for group in self.fit("failed.h5")["groups"]:
            self.assertEqual([group[name] for name in ("runs", "clogs", "failed")], [3, 0, 3])

    def test_comparisons(self):
        printed = self.fit("compare", "s.h5", "--by", "line-tension")["comparisons"]
        self.write("own.csv", "distance [sigma],clogged\n1,1\n2,1\n3,0\n")
        measured = self.fit("compare", "own.csv", "s.h5")["comparisons"]
        self.assertEqual((len(printed), len(measured)), (3, 4))
        for one in printed:
            self.assertEqual((one["runs_here"], one["clogs_here"], one["pairs"]), (12, 7, 12))
        for tension, one in zip(TENSIONS[1:], printed):
            self.assertAlmostEqual(one["clogging_length_here"], self.lengths[tension], places=9)
            self.assertAlmostEqual(one["ratio"], self.lengths[tension] / self.lengths[TENSIONS[0]], places=9)
        for tension, one in zip(TENSIONS, measured):
            self.assertEqual((one["runs_there"], one["clogs_there"]), (3, 2))
            self.assertEqual((one["runs_here"], one["clogs_here"]), (12, 7))
            self.assertAlmostEqual(one["clogging_length_here"], self.lengths[tension], places=9)

    def test_comparisons_and_curves_state_failures_and_doubts(self):
        doubts = {group["line_tension"]: group["doubts"] for group in self.fit("s.h5")["groups"]}
        self.assertIn("incomplete", doubts[2])
        for one in self.fit("compare", "s.h5", "--by", "line-tension")["comparisons"]:
            tension = float(one["here"].split("=")[1])
            self.assertEqual([one[f"{name}_{side}"] for side in ("here", "there") for name in ("failed", "doubts")],
                             [3, doubts[tension], 3, doubts[0.25]])
        self.write("own.csv", "distance [sigma],clogged,line-tension\n" + "5,1,2\n" * 12)
        one, = self.fit("compare", "own.csv", "s.h5")["comparisons"]
        self.assertEqual([one[name] for name in ("failed_here", "doubts_here", "failed_there", "doubts_there")],
                         [3, doubts[2], 0, "not_exponential equal_distances"])
        for command in (["s.h5", "--by", "line-tension"], ["own.csv", "s.h5"]):
            text = self.succeed("clogfit", "compare", *command).stdout
            self.assertRegex(text, r" note\n")
            self.assertIn("\ni: some runs are in progress", text)
            self.assertRegex(text, r"\n   (12|3) runs failed, and count as not clogged up to sound_distance\n")
        self.assertRegex(text, r"[a-z]*i[a-z]*/xe\n")
        curve, = self.fit("curve", "s.h5")["curves"]
        self.assertEqual((curve["failed"], curve["doubts"]["incomplete"]), (12, 4))
        text = self.succeed("clogfit", "curve", "s.h5").stdout
        self.assertIn("  (12 of 48 runs failed, and count as not clogged up to sound_distance)\n", text)
        self.assertIn("  (4 of 4 points: some runs are in progress", text)
        # Without failures and doubts, there is no message about them.
        rows = table(self.copy_sweep("s.h5", *SWEEP))
        exponential = -4 * np.log(1 - (rows.seed - 0.5) / 12)
        stored_rows.change_columns(self.folder / "s.h5", status=b"clogged", clogged_by=b"certified", mechanism=b"squeezed", failed_by=b"none",
                                   distance=exponential, sound_distance=exponential)
        text = self.succeed("clogfit", "compare", "s.h5", "--by", "line-tension").stdout + self.succeed("clogfit", "curve", "s.h5").stdout
        for word in ("note", "failed", "points:"):
            self.assertNotIn(word, text)

    def test_a_comparison_corrects_the_tests_of_all_its_groups_together(self):
        # By Weibull's test, the law of each group alone has p = 0.04.
        rows = table(self.folder / "s.h5")
        way = rows.line_tension * (-np.log(1 - (rows.seed - 0.5) / 12)) ** (1 / 1.8)
        stored_rows.change_columns(self.folder / "s.h5", status=b"clogged", clogged_by=b"certified",
                                   mechanism=b"squeezed", failed_by=b"none", distance=way, sound_distance=way)
        for group in self.fit("s.h5")["groups"]:
            self.assertTrue(0.05 / 2 < group["weibull_p_value"] < 0.05)
        for one in self.fit("compare", "s.h5", "--by", "line-tension")["comparisons"]:
            self.assertNotIn("not_exponential", f"{one['doubts_here']} {one['doubts_there']}")

    def test_pictures_of_comparisons_show_failures_and_doubts(self):
        def drawn(printed):
            axes, = style.figure_of(ratios.draw_on, printed).axes
            faces = [line.get_markerfacecolor() == "white" for line in axes.lines if line.get_marker() in style.MARKERS]
            return faces, [text.get_text() for text in axes.texts][-1], [[dashes is not None for _, dashes in bars.get_linestyle()] for bars in axes.collections]
        printed = self.fit("compare", "s.h5", "--by", "line-tension")
        for one in printed["comparisons"]:
            for side in ("here", "there"):
                one[f"doubts_{side}"], one[f"failed_{side}"] = "censored_by_time", 0
        faces, notes, _ = drawn(printed)
        self.assertEqual(faces, [False] * 3)
        for word in ("hollow", "failed", "incomplete"):
            self.assertNotIn(word, notes)
        first, second, third = printed["comparisons"]
        first["doubts_there"], second["doubts_here"], third["failed_here"] = "failures_matter not_exponential", "incomplete few_clogs", 2
        second["interval"] = "paired"
        faces, notes, dashed = drawn(printed)
        self.assertEqual((faces, dashed), ([True, True, False], [[True], [False], [True]]))
        for words in ("hollow: failures, which would change the length if they were clogs, or fewer than 5 clogs",
                      "incomplete: runs of 1 of 3 points", "failed: some runs of 1 of 3 points",
                      "solid bars: from pairs of the same seed; dashed bars: from numbers of clogs alone"):
            self.assertIn(words, " ".join(notes.split()))

    def test_curves_reports_and_the_python_module(self):
        curve, = self.fit("curve", "s.h5")["curves"]
        points = sorted(curve["points"], key=lambda point: point["line_tension"])
        self.check_groups(points, ["runs", "clogs"])
        self.succeed("clogfit", "report", "s.h5", "--examples", 0)
        page = (self.folder / "s-report.html").read_text()
        for words in ("failed per 1000&sigma;", "12 failed",
                      "Failed runs count as not clogged up to their last passed check"):
            self.assertTrue(words in page, f"the page of the report lacks {words}")
        for tension in TENSIONS:
            cells = "".join(f"<td>{cell:g}</td>" for cell in (tension, 12, 7, 7, 3))
            self.assertTrue(cells in page, f"the page of the report lacks {cells}")
        sweep = clogsweep.open(self.folder / "s.h5", BIN)
        self.assertIn("12 failed", repr(sweep))
        fit = sweep.fit()
        self.check_groups(fit.groups.to_dict("records"))
        notes = lengths.length_notes(fit.known.members, fit.known.confidence, [])
        self.assertIn("failed: some runs of 4 of 4 points (not clogged up to their last check)", notes)
        rows = table(self.folder / "s.h5")
        for number, tension in enumerate(TENSIONS):
            steps = fit.survival(number)
            ways = self.ways[rows.line_tension == tension]
            self.assertEqual(steps.at_risk.tolist(), [(ways >= distance).sum() for distance in steps.distance])
            self.assertEqual(steps.clogs.sum(), 7)

    def test_rests_count_as_clogs_if_they_began_before_the_failure(self):
        def let_droplets_rest(rows):
            rests = np.isin(rows["seed"], [1, 2, 3, 12])
            rows["dwells_known_from"], rows["last_dwell_at"], rows["last_dwell_from"] = 0.01, 0.9, 0.9
            for name in rows.dtype.names:
                if "_dwell" in name and not name.startswith("last"):
                    rows[name] = np.nan
            for name, value in {"longest_dwell": 0.5, "longest_dwell_at": 0.2, "longest_dwell_from": 0.3}.items():
                rows[name][rests] = value
            # The droplet of seed 3 fails before it rests. The droplet of seed 12 fails after its rest.
            for seed, share in ((3, 1.5), (12, 0.5)):
                rows["longest_dwell_at"][rows["seed"] == seed] = share * rows["sound_distance"][rows["seed"] == seed]
            rows["last_dwell_at"] = np.fmax(rows["last_dwell_at"], rows["longest_dwell_at"])

        stored_rows.change(self.folder / "s.h5", let_droplets_rest)
        self.succeed("clogsweep", "verify", "s.h5")
        for group in self.fit("s.h5", "--dwell=0.1")["groups"]:
            # Nine droplets clogged or rested. Of the others, the droplets of seeds 3 and 7 failed, and the droplet of
            # seed 8 was interrupted.
            self.assertEqual((group["runs"], group["clogs"], group["failed"], group["interrupted"]), (12, 9, 3, 1))
        rows = table(self.folder / "s.h5")
        rest, end = rows.longest_dwell_at, rows.last_dwell_at
        ways = np.select([rows.seed.isin([1, 2, 12]), rows.seed.isin([3, 7]), rows.seed == 8],
                         [rest, np.minimum(rows.sound_distance, end), end], rows.distance)
        for group in self.fit("s.h5", "--dwell=0.1")["groups"]:
            of_group = ways[rows.line_tension == group["line_tension"]]
            self.assertAlmostEqual(group["total_distance"], of_group.sum(), places=9)

    def test_dwells_are_known_from_the_time_on_from_which_those_of_failed_runs_are(self):
        rows = table(self.folder / "s.h5")
        stored_rows.change_columns(self.folder / "s.h5", dwells_known_from=np.where(rows.seed == 7, 0.2, 0.1))
        self.assertEqual({group["dwells_known_from"] for group in self.fit("s.h5")["groups"]}, {0.2})
        self.draw("dwell", "s.h5", "--programs", BIN)


class Settled(ProgramTest):
    """Tests that a run is not repeated if every attempt would fail in the same way."""

    def setUp(self):
        super().setUp()
        self.command = [*ENDLESS, "--max-hours=0.0001"]
        self.assertEqual(self.run_program("clogsweep", *self.command).returncode, 75)
        shutil.copyfile(self.folder / "s.h5", self.folder / "interrupted.h5")
        stored_rows.change(self.folder / "s.h5", lambda rows: fail(rows, rows["task"] == 0, 7.0, 0.01))
        self.assertTrue((self.folder / "s.h5.journal").exists())

    def states(self, name):
        return list(table(self.folder / name).status)

    def test_an_earlier_record_of_the_journal_does_not_replace_it(self):
        self.succeed("clogsweep", "salvage", "s.h5", "--output", "whole.h5")
        self.assertEqual(self.states("whole.h5"), ["failed"])
        self.assertEqual(self.run_program("clogsweep", *self.command).returncode, 75)
        self.assertEqual(self.states("s.h5"), ["failed", "interrupted"])

    def test_merged_files_keep_it_in_either_order(self):
        (self.folder / "s.h5.journal").unlink()
        for number, names in enumerate((["s.h5", "interrupted.h5"], ["interrupted.h5", "s.h5"])):
            self.succeed("clogsweep", "merge", *names, "--output", f"{number}.h5")
            self.assertEqual(self.states(f"{number}.h5"), ["failed"])

    def test_a_crash_is_not_final(self):
        crashed = self.folder / "crashed.h5"
        shutil.copyfile(self.folder / "interrupted.h5", crashed)
        stored_rows.change(crashed, lambda rows: fail(rows, rows["task"] == 0, 7.0, 0.01, b"crash"))
        self.succeed("clogsweep", "merge", "crashed.h5", "interrupted.h5", "--output", "merged.h5")
        self.assertEqual(self.states("merged.h5"), ["interrupted"])


class Seeds(ProgramTest):
    """Tests rules that choose the number of runs."""

    def counts(self):
        rows = table(self.folder / "s.h5")
        return {word: int((rows.status == word).sum()) for word in rows.status.unique()}

    def spoil(self, seeds):
        stored_rows.change(self.folder / "s.h5", lambda rows: fail(rows, np.isin(rows["seed"], seeds), 7.0, 0.01))

    def test_failed_runs_are_among_the_seeds_of_each_set(self):
        self.copy_sweep("s.h5", *SMALL, *FAR, "line-tension=1,2", "seeds=1..4")
        self.spoil([2, 3])
        self.succeed("clogsweep", *SMALL, *FAR, "line-tension=1,2", "seeds=1", "--seeds-per-set=6", "--output", "s.h5")
        rows = table(self.folder / "s.h5")
        self.assertEqual(sorted(rows.seed), sorted([1, 2, 3, 4, 5, 6] * 2))
        self.assertEqual(self.counts()["failed"], 4)
        for group in json.loads(self.succeed("clogfit", "s.h5", "--format", "json").stdout)["groups"]:
            self.assertEqual((group["runs"], group["failed"]), (6, 2))

    def test_until_precision_counts_clogs_and_not_failures(self):
        # A precision of 75 % needs eleven clogs. At this line tension almost every droplet clogs.
        command = ["clogsweep", *PRECISE, "--until-precision=75%", "--most-seeds=20", "--output", "s.h5"]
        self.copy_sweep("s.h5", *PRECISE)
        self.spoil([2, 3, 4, 5])
        self.assertIn("1 of 1 parameter set reached --until-precision", self.succeed(*command).stderr)
        group, = json.loads(self.succeed("clogfit", "s.h5", "--format", "json").stdout)["groups"]
        width = (group["clogging_length_upper"] - group["clogging_length_lower"]) / (2 * group["clogging_length"])
        self.assertLess(width, 0.75)
        self.assertEqual((group["failed"], group["clogs"]), (4, 11))
        self.spoil(range(1, 20))
        printed = self.run_program(*command)
        self.assertEqual(printed.returncode, 1)  # Every run has failed.
        self.assertIn("not: the only one with 0 clogs of 8 seeds, 8 failed (it takes 11 clogs)", printed.stderr)

    def test_an_interrupted_run_is_resumed_and_not_failed(self):
        command = [*PRECISE, "--until-precision=75%", "--most-seeds=14"]
        whole = table(self.copy_sweep("s.h5", *command))
        stored_rows.change(self.folder / "s.h5", lambda rows: without_result(rows, rows["seed"] == 3))
        self.assertEqual(self.counts()["interrupted"], 1)
        self.assertNotIn("failed", self.succeed("clogsweep", *command, "--output", "s.h5").stderr)
        again = table(self.folder / "s.h5")
        pandas.testing.assert_frame_equal(again.drop(columns=TIMING), whole.drop(columns=TIMING), check_exact=True)


class Devices(Analysis):
    """Tests pictures and reports of droplets among user-supplied circles, and in channels."""

    def test_pictures_of_devices_count_failed_droplets_where_they_were_sound(self):
        places = [(x, y) for x in range(1, 20, 2) for y in range(1, 20, 2)]
        self.write("posts.csv", "x,y,diameter\n" + "".join(f"{x},{y},0.3\n" for x, y in places))
        self.succeed("clogsweep", "obstacles=posts.csv", *AMONG_CIRCLES, "--output", "s.h5")
        rows = table(self.folder / "s.h5")
        for distance in (np.nan, 1e300, -1e300):
            stored_rows.change(self.folder / "s.h5", lambda rows: fail(rows, rows["seed"] > 1, distance, 0.3))
            place, = device.places(self.folder / "s.h5", BIN)
            self.assertEqual(place.ends[1:, 0].tolist(), (rows.release_x + 0.3)[1:].tolist())
            figure, axes = style.subplots(figsize=(4, 4))
            device.draw_ends(axes, place)
            self.assertIn("failed: 2", [line.get_label() for line in axes.lines])
            self.draw("device", "s.h5", "--programs", BIN, "--output", "device.png")
        self.draw("report", "s.h5", "--programs", BIN, "--output", "r.html")

    def test_a_file_of_version_1_0_says_only_where_droplets_crossed_themselves(self):
        self.write("post.csv", "x,y,diameter\n1,1,0.3\n")
        self.succeed("clogsweep", "obstacles=post.csv", *AMONG_CIRCLES, "--output", "s.h5")

        def spoil(rows):
            fail(rows, rows["seed"] > 1, 0.5, 0.25)
            rows["message"][rows["seed"] == 2] = b"the interface crossed itself by t=9; try"

        stored_rows.change(self.folder / "s.h5", spoil)
        stored_rows.make_older(self.folder / "s.h5", "10", ["sound_distance", "failed_by", "healed_crossings"])
        rows = stored.read_rows(self.folder / "s.h5", BIN)
        self.assertEqual(stored.observed_distances(rows).tolist()[:2], [rows["distance"][0], 0.5])
        self.assertTrue(np.isnan(stored.observed_distances(rows)[2]))
        self.draw("report", "s.h5", "--programs", BIN, "--output", "r.html")
        page = (self.folder / "r.html").read_text()
        self.assertTrue("up to their last passed check (column sound_distance), except 1 without one" in page)

    def test_a_report_on_channels_names_failures_without_a_word_on_lengths(self):
        channel = ["obstacle-layout=channel", "orifice=0.7", "terminal-speed=0.05", "start=-1.5", "end=1", "vertices=64"]
        self.succeed("clogsweep", *channel, "line-tension=0.5,1", "--output", "s.h5")
        stored_rows.change(self.folder / "s.h5", lambda rows: fail(rows, rows["line_tension"] == 1, 7.0, 0.3))
        self.assertRegex(self.succeed("clogfit", "s.h5").stdout, r"\n +0\.7 +1 +failed ")
        self.draw("report", "s.h5", "--programs", BIN, "--output", "r.html")
        page = (self.folder / "r.html").read_text()
        for words, is_there in (("1 failed", True), ("failed: made to fail", True), ("sound_distance", False)):
            self.assertEqual(words in page, is_there, words)


class Searches(Analysis):
    """Tests commands that depend on the ends of droplets."""

    def run_and_fail(self, failures):
        """@return a function that runs a program, and then makes runs of the program's sweep fail. failures(rows)
        chooses these runs"""
        original = programs.run_program

        def run(program, *words):
            printed = original(program, *words)
            path = pathlib.Path(words[words.index("--output") + 1])
            stored_rows.change(path, lambda rows: fail(rows, failures(rows), 7.0, 0.01))
            return printed

        return unittest.mock.patch.object(programs, "run_program", run)

    def warnings(self, call):
        error = io.StringIO()
        with contextlib.redirect_stderr(error):
            found = call()
        return found, error.getvalue()

    def test_collisions_and_predictions_state_failures(self):
        keys = {"vertices": "64", "max-time": "10"}
        falls = collision.Collisions(BIN / "clogsweep", self.folder, keys)
        with self.run_and_fail(lambda rows: rows["line_tension"] == 0.5):
            broken, printed = self.warnings(lambda: falls.break_up(0, [0.3, 0.5]))
        warning = "runs failed and count as {}; the first one: made to fail\n"
        self.assertEqual((broken, printed), ([False, False], "1 of 2 " + warning.format("whole")))
        droplets = prediction.Droplets(BIN / "clogsweep", self.folder, keys | {"line-tension": "1"})
        with self.run_and_fail(lambda rows: rows["task"] >= 0):
            ends, printed = self.warnings(lambda: droplets.ends([[(0, 0, 0.3)]]))
        self.assertEqual((ends, printed), ({1.0: [b""]}, "1 of 1 " + warning.format("passed")))
        self.assertEqual(self.warnings(lambda: droplets.ends([[(0, 0, 0.3)]]))[1], "")

    def test_critical_angles_state_failures_and_unfinished_runs(self):
        keys = ["obstacle-layout=lattice", "pitch=3", "obstacle-diameter=1", "vertices=64", "box=200", "max-time=600",
                "terminal-speed=0.1", "line-tension=1,2", "lattice-angle=15,25", "seeds=1"]
        self.copy_sweep("s.h5", *keys)
        expected = self.draw("critical-angle", "s.h5", "--programs", BIN, "--format", "csv").stdout
        self.assertEqual([line.split(",")[-1] for line in expected.splitlines()], ["runs", "2", "2"])
        stored_rows.change(self.folder / "s.h5", lambda rows: fail(rows, rows["task"] == 0, 7.0, 0.01))
        done = self.draw("critical-angle", "s.h5", "--programs", BIN, "--format", "csv")
        self.assertEqual([line.split(",")[-1] for line in done.stdout.splitlines()], ["runs", "1", "2"])
        self.assertEqual(done.stderr, "1 of 4 runs failed and do not count\n")
        # First all four runs are unfinished, and then the two runs at the smaller angle. An unfinished run shows
        # nothing, because its droplet may still leave the rows.
        before = [line.split(",") for line in expected.splitlines()]
        for which in (lambda rows: rows["task"] >= 0, lambda rows: rows["lattice_angle"] < 20):
            self.copy_sweep("s.h5", *keys)
            stored_rows.change(self.folder / "s.h5", lambda rows: without_result(rows, which(rows)))
            number = int(which(table(self.folder / "s.h5")).sum())
            done = self.draw("critical-angle", "s.h5", "--programs", BIN, "--format", "csv")
            self.assertEqual(done.stderr, f"{number} of 4 runs are unfinished and do not count\n")
            for line, old in zip(done.stdout.splitlines()[1:], before[1:]):
                self.assertEqual(line.split(","), [old[0], "", old[2] if number == 2 else "", str(2 - number // 2)])


if __name__ == "__main__":
    unittest.main()
