"""Tests three features: the comparison of the clogging lengths of two sweeps, several files that are read as one sweep,
and the events of a sweep."""

import json
import math

import pandas
from PIL import Image

import stored_rows
from drawing import Analysis
from support import BIN, FEW, QUICK, SLOW, SMALL, SweepTest, table

import clogsweep
from clogsweep.drawing import activity


class Compared(Analysis):
    def sweep(self, output, *keys, seeds="1..6"):
        self.copy_sweep(output, *SMALL, "line-tension=0.5,2", "obstacle-gap=0.4",
                        "max-time=200", f"seeds={seeds}", *keys)

    def both_presets(self):
        for preset in ("robust", "elastic"):
            self.sweep(f"{preset}.h5", f"preset={preset}")
        self.succeed("clogsweep", "merge", "robust.h5", "elastic.h5", "--output", "both.h5")

    def compare(self, *arguments):
        return json.loads(self.succeed("clogfit", "compare", *arguments, "--format", "json").stdout)

    def test_ratios_are_those_of_the_lengths_that_clogfit_gives(self):
        self.both_presets()
        groups = pandas.DataFrame(json.loads(self.succeed("clogfit", "both.h5", "--format", "json").stdout)["groups"])
        printed = self.compare("both.h5", "--by", "preset")
        self.assertEqual(printed["columns"], ["line_tension"])
        self.assertIn("preset", printed["differing"])
        self.assertEqual(len(printed["comparisons"]), 2)
        rows = table(self.folder / "both.h5")
        for one in printed["comparisons"]:
            self.assertEqual((one["here"], one["there"], one["pairs"]), ("preset=robust", "preset=elastic", 6))
            lengths = {group.preset: group for group in groups[groups.line_tension == one["line_tension"]].itertuples()}
            self.assertEqual(one["clogging_length_here"], lengths["robust"].clogging_length)
            if one["interval"] == "unpaired":
                self.assertAlmostEqual(one["ratio"],
                                       lengths["robust"].clogging_length / lengths["elastic"].clogging_length)
            own = rows[rows.line_tension == one["line_tension"]]
            sides = [own[own.preset == preset].set_index("seed") for preset in ("robust", "elastic")]
            both = [side[side.status == "clogged"] for side in sides]
            pairs = both[0].join(both[1], rsuffix="_there", how="inner")
            near = (0.3 + 0.4) / 2
            same = ((pairs.distance - pairs.distance_there).abs() <= near) & ((pairs.lateral_displacement - pairs.lateral_displacement_there).abs() <= near)
            self.assertEqual((one["both_clogged"], one["same_place"]), (len(pairs), same.sum()))

    def test_lengths_are_in_millimetres_if_the_laboratory_is_known(self):
        self.both_presets()
        self.write("lab.cfg", "diameter = 2 mm\nangle = 20 deg\n")
        for arguments in (["both.h5", "--by", "preset"], ["elastic.h5", "robust.h5"]):
            for one in self.compare(*arguments, "--lab", "lab.cfg")["comparisons"]:
                self.assertEqual(one["clogging_length_there_mm"], 2 * one["clogging_length_there"])
        self.assertIn("lambda/mm",
                      self.succeed("clogfit", "compare", "both.h5", "--by", "preset", "--lab", "lab.cfg").stdout)

    def test_files_are_compared_as_values_of_one_file_are(self):
        self.both_presets()
        of_files, of_values = self.compare("elastic.h5", "robust.h5"), self.compare("both.h5", "--by", "preset")
        for printed in (of_files, of_values):
            for one in printed["comparisons"]:
                del one["here"], one["there"]
        self.assertEqual(of_files["comparisons"], of_values["comparisons"])
        self.assertEqual(self.compare("robust.h5", "elastic.h5", "--by", "preset")["comparisons"][0]["there"],
                         "preset=elastic")

    def test_a_sweep_is_at_the_same_place_as_itself(self):
        for name in ("s.h5", "t.h5"):
            self.sweep(name, "preset=robust")
        for one in self.compare("s.h5", "t.h5")["comparisons"]:
            self.assertEqual((one["ratio"], one["same_place"], one["unlike_pairs"]), (1, one["both_clogged"], 0))
            self.assertEqual((one["interval"], one["ratio_lower"], one["ratio_upper"], one["unpaired_lower"]),
                             ("identical", None, None, None))
        text = self.succeed("clogfit", "compare", "s.h5", "t.h5").stdout
        self.assertRegex(text, r" 1 +identical +no ")
        self.assertIn("identical: all runs end at the same places here and there", text)
        self.write("own.csv", "distance [mm],clogged\n41.5,1\n120,0\n7,1\n")
        self.write("copy.csv", "distance [mm],clogged\n7,1\n41.5,1\n120,0\n")
        one, = self.compare("own.csv", "copy.csv")["comparisons"]
        self.assertEqual((one["ratio"], one["interval"], one["ratio_lower"]), (1, "identical", None))
        # Two sweeps are not identical if one of them has an additional run.
        self.sweep("more.h5", "preset=robust", seeds="1..7")
        self.assertEqual({one["interval"] for one in self.compare("s.h5", "more.h5")["comparisons"]}, {"unpaired"})

    def test_parameter_sets_without_a_counterpart_are_named(self):
        for name, gaps, tensions in (("s.h5", "0.4,0.5,0.6", "0.5,2"), ("t.h5", "0.4", "0.5,2")):
            self.copy_sweep(name, *SMALL, f"line-tension={tensions}", f"obstacle-gap={gaps}", "max-time=60",
                            "seeds=1..2")
        left_out = "clogfit compare: s.h5: left out, 4 of 6 groups match no runs of t.h5, such as obstacle_gap=0.5, line_tension=0.5\n"
        for files in (["s.h5", "t.h5"], ["t.h5", "s.h5"]):
            done = self.succeed("clogfit", "compare", *files)
            self.assertEqual(done.stderr, left_out)
        self.assertIn(left_out, self.run_program("clogfit", "compare", "s.h5", "t.h5", "--picture", "ratio.png").stderr)
        self.assertEqual(self.succeed("clogfit", "compare", "s.h5", "--by", "obstacle-gap").stderr, "")
        self.succeed("clogsweep", "select", "s.h5", "obstacle_gap!=0.5", "--output", "one.h5")
        self.succeed("clogsweep", "select", "s.h5", "obstacle_gap=0.5", "line_tension=2", "--output", "other.h5")
        self.succeed("clogsweep", "merge", "one.h5", "other.h5", "--output", "both.h5")
        self.assertEqual(self.succeed("clogfit", "compare", "both.h5", "--by", "obstacle-gap").stderr,
                         "clogfit compare: obstacle_gap=0.4: "
                         "left out, 1 of 2 groups match no runs of obstacle_gap=0.5, such as line_tension=0.5\n")

    def test_a_side_without_a_value_is_named(self):
        for name, *keys in (("random.h5", "obstacle-gap=0.4"), ("lattice.h5", "obstacle-layout=lattice",
                                                                "obstacle-gap=0.4", "lattice-angle=0")):
            self.copy_sweep(name, "vertices=64", *(["box=20"] if name == "random.h5" else []), *keys,
                            "line-tension=1,2", "max-time=20", "seeds=1..2")
        self.succeed("clogsweep", "merge", "random.h5", "lattice.h5", "--output", "both.h5")
        printed = json.loads(self.succeed("clogfit", "compare", "both.h5", "--by", "lattice-angle", "--format", "json").stdout)["comparisons"]
        self.assertEqual({(one["here"], one["there"]) for one in printed}, {("lattice_angle=0", "no lattice_angle")})
        self.write("own.csv", "distance [mm],clogged,wall\n5,1,glass\n6,0,glass\n7,1,\n8,0,\n")
        self.assertIn("over that of no wall\n", self.succeed("clogfit", "compare", "own.csv", "--by", "wall").stdout)

    def test_text_csv_and_a_picture(self):
        self.sweep("s.h5", "near-wall-drag=0,2", seeds="1..3")
        text = self.succeed("clogfit", "compare", "s.h5", "--by", "near-wall-drag").stdout
        self.assertRegex(text, r"lambda of each over that of near_wall_drag=0")
        self.assertRegex(text, r"of +line_tension +clogs +lambda/sigma +clogs there +lambda there +ratio +95 % +paired "
                               r"+gain +same place")
        self.succeed("clogfit", "compare", "s.h5", "--by", "near_wall_drag", "--format", "csv", "--confidence", "0.9")
        drawn = self.run_program("clogfit", "compare", "s.h5", "--by", "near-wall-drag", "--picture", "ratio.png")
        self.assertEqual(drawn.returncode, 0, drawn.stderr)
        self.assertGreater(min(Image.open(self.folder / "ratio.png").size), 400)
        self.assertTrue((self.folder / "ratio.pdf").exists())

    def test_mistakes_get_one_line(self):
        self.sweep("s.h5", "preset=robust")
        self.copy_sweep("t.h5", *FEW)
        for arguments, words in [(["s.h5"], ["--by"]), ([], ["missing sweep files"]), (["s.h5", "t.h5"], ["line_tension", "none of these values"]),
                                 (["s.h5", "--by", "line-tention"], ["did you mean line_tension?"]), (["s.h5", "--by", "friction"], ["all runs have the same"]),
                                 (["s.h5", "none.h5"], ["none.h5"]), (["s.h5", "t.h5", "--within", "0"], ["--within=0"])]:
            self.refuse("clogfit", "compare", *arguments, words=words)


class Together(Analysis):
    def test_several_files_are_fitted_and_read_as_one_sweep(self):
        self.copy_sweep("whole.h5", *FEW)
        self.succeed("clogsweep", *QUICK, "line-tension=1", "seeds=1..2", "--output", "a.h5")
        self.succeed("clogsweep", *QUICK, "line-tension=3", "seeds=1..2", "--output", "b.h5")
        whole, both = (json.loads(self.succeed("clogfit", *names, "--format", "json").stdout)
                       for names in (["whole.h5"], ["a.h5", "b.h5"]))
        self.assertEqual(both["groups"], whole["groups"])
        self.assertEqual((both["lists"], both["sweep"]["config"]), (whole["lists"], whole["sweep"]["config"]))
        sweep = clogsweep.open([self.folder / "a.h5", self.folder / "b.h5"], BIN)
        self.assertEqual(sweep.rows.distance.tolist(), table(self.folder / "whole.h5").distance.tolist())
        self.assertEqual(sweep.fit().groups.clogs.tolist(), [group["clogs"] for group in whole["groups"]])
        self.assertIn("a.h5 + ", repr(sweep))
        stored_rows.change_columns(self.folder / "b.h5", model_version=1)
        with self.assertRaisesRegex(clogsweep.UserError, "model versions"):
            clogsweep.open([self.folder / "a.h5", self.folder / "b.h5"], BIN)
        with self.assertRaisesRegex(clogsweep.UserError, "a list needs at least two files"):
            clogsweep.open([self.folder / "a.h5"], BIN)


class Events(SweepTest):
    def test_every_start_and_end_is_a_line_until_the_sweep_ends(self):
        process = self.start(*(word.replace("max-time=2e4", "max-time=4000") for word in SLOW))
        self.wait_for(lambda: (self.folder / "s.h5").exists() or process.poll() is not None)
        lines = [json.loads(line)
                 for line in self.succeed("clogsweep", "status", "s.h5", "--follow", "--format", "json").stdout.splitlines()]
        self.assertEqual(process.wait(), 0)
        self.assertEqual((lines[0]["event"], lines[0]["runs"]), ("begin", 2))
        self.assertEqual((lines[-1]["event"], lines[-1]["finished"], lines[-1]["complete"]), ("done", 2, True))
        ended = {line["task"]: line for line in lines if line["event"] == "end"}
        rows = table(self.folder / "s.h5").set_index("task")
        for task, line in ended.items():
            self.assertEqual((line["status"], line["distance"], line["seed"]),
                             (rows.status[task], rows.distance[task], rows.seed[task]))
        self.assertEqual(len(ended), 2 - lines[0]["finished"])

    def test_a_sweep_that_is_over_has_a_beginning_and_an_end(self):
        self.copy_sweep("s.h5", *FEW)
        lines = self.succeed("clogsweep", "status", "s.h5", "--follow", "--format", "json").stdout.splitlines()
        self.assertEqual([json.loads(line)["event"] for line in lines], ["begin", "done"])
        self.refuse("clogsweep", "status", "s.h5", "--follow", words=["--format json"])
        self.refuse("clogsweep", "status", "s.h5", "--follow", "--watch", words=["--follow and --watch"])

    def test_the_file_knows_how_busy_the_ranks_were(self):
        for seeds in ("1..4", "1..6"):
            self.succeed("clogsweep", *SMALL, "obstacle-gap=0.4", "max-time=500",
                         f"seeds={seeds}", "--output", "s.h5", ranks=2)
        sessions = activity.sessions_of(clogsweep.open(self.folder / "s.h5", BIN).attributes)
        self.assertEqual([session["ranks"] for session in sessions], [2, 2])
        busy = sum(mean * min(session["stretch"], session["seconds"] - i * session["stretch"])
                   for session in sessions for i, mean in enumerate(session["busy"]))
        worked = table(self.folder / "s.h5").wall_seconds.sum()
        self.assertGreater(busy, 0.9 * worked)
        for session in sessions:
            self.assertLessEqual(session["tail_seconds"], session["idle_seconds"] + 0.01)
        self.assertIn("core-hours", activity.lost(sessions))
        self.assertTrue(math.isfinite(busy))
