"""Tests sweeps of points, sweeps over lists of words, sweeps in several parts, merged files, and selected rows."""

import json
import unittest

import h5py
import pandas
import stored_rows
from support import QUICK, SMALL, ProgramTest, table

TIMING = ["wall_seconds", "processor_seconds", "rank", "host"]


class PointsTest(ProgramTest):
    def sweep(self, output, *arguments, **options):
        self.succeed("clogsweep", *QUICK, *arguments, "--quiet", "--output", output, **options)
        return table(self.folder / output)

    def rows(self, name):
        return table(self.folder / name).drop(columns=TIMING)

    def attribute(self, name, attribute):
        with h5py.File(self.folder / name) as file:
            return file.attrs[attribute].decode()

    def check_same_rows(self, name, other):
        rows, others = self.rows(name), self.rows(other)
        self.assertEqual(rows.to_csv(index=False), others.to_csv(index=False))


class Points(PointsTest):
    def setUp(self):
        super().setUp()
        self.write("p.csv", "line-tension,obstacle-gap,seeds\n# two of one gap\n0.5,0.4,1..3\n2, 0.4, 1\n\n2,0.5,\n")

    def test_each_line_is_a_parameter_set_and_empty_cells_are_as_otherwise(self):
        rows = self.sweep("s.h5", "--points", "p.csv", "seeds=7..8", ranks=2)
        runs = sorted(zip(rows.line_tension, rows.obstacle_gap, rows.seed))
        self.assertEqual(runs, [(0.5, 0.4, 1), (0.5, 0.4, 2), (0.5, 0.4, 3), (2, 0.4, 1), (2, 0.5, 7), (2, 0.5, 8)])

    def test_points_of_spreadsheets_and_pandas(self):
        frame = pandas.DataFrame({"line-tension": [0.5, 2, 2], "obstacle-gap": [0.4, 0.4, 0.5], "seeds": [1, 2, 3], "vertices": [32, None, 32]})
        german = "line-tension;obstacle-gap;seeds;vertices;\r\n0,5;0,4;1;32;\r\n2;0,4;2;;\r\n2,0E+00;0,5;3;32;\r\n"
        texts = {"excel": ("sep=;\r\n" + german).encode("utf-16"), "windows": german.encode("cp1252"), "mac": german.replace("\r\n", "\r").encode("utf-8-sig"),
                 "pandas": frame.to_csv().encode(), "quoted": frame.to_csv(quoting=1).encode(), "tsv": frame.to_csv(sep="\t", decimal=",").encode()}
        for name, text in texts.items():
            with self.subTest(name):
                (self.folder / "q.csv").write_bytes(text)
                rows = self.sweep(f"{name}.h5", "--points", "q.csv")
                self.assertEqual(sorted(zip(rows.line_tension, rows.obstacle_gap, rows.seed)), [(0.5, 0.4, 1), (2, 0.4, 2), (2, 0.5, 3)])

    def test_dry_run_status_and_config_know_of_them(self):
        arguments = [*QUICK, "--points", "p.csv"]
        self.assertIn("# 14 tasks: 3 parameter sets, 1 to 10 seeds each", self.plan(*arguments))
        config = self.write("again.cfg", self.succeed("clogsweep", *arguments, "--print-config").stdout)
        listed = self.plan("--config", config).splitlines()
        own = self.plan(*arguments).splitlines()
        self.assertEqual(listed[:15], own[:15])
        self.sweep("s.h5", "--points", "p.csv")
        status = json.loads(self.succeed("clogsweep", "status", "s.h5", "--format", "json").stdout)
        self.assertEqual((status["runs"], status["finished"], len(status["groups"])), (14, 14, 3))
        self.assertIn("14 rows of 14 runs, all undamaged", self.succeed("clogsweep", "verify", "s.h5").stdout)

    def test_a_file_grows_by_points_and_by_lists(self):
        self.sweep("s.h5", "line-tension=0.5", "obstacle-gap=0.4", "seeds=1..2")
        before = self.rows("s.h5")
        done = self.succeed("clogsweep", *QUICK, "--points", "p.csv", "--output", "s.h5")
        self.assertIn("s.h5 has 2 of 14 runs", done.stderr)
        rows = self.rows("s.h5")
        self.assertEqual(len(rows), 14)
        common = rows.merge(before.drop(columns="task"), on=[name for name in before.columns if name != "task"])
        self.assertEqual(len(common), 2, "the old rows are there, bit for bit")
        self.assertIn("there is nothing left to do",
                      self.succeed("clogsweep", *QUICK, "--points", "p.csv", "--output", "s.h5").stderr)
        self.sweep("s.h5", "line-tension=7", "obstacle-gap=0.4", "seeds=1")
        self.assertEqual(len(self.rows("s.h5")), 15)

    def test_lists_of_words(self):
        rows = self.sweep("s.h5", "preset=robust,elastic", "obstacle-gap=0.4", "seeds=1..2")
        self.assertEqual(list(rows.preset), ["robust", "elastic"] * 2)
        self.sweep("e.h5", "preset=elastic", "obstacle-gap=0.4", "seeds=1..2")
        own = self.rows("s.h5")
        self.assertEqual(own[own.preset == "elastic"].drop(columns="task").to_csv(index=False),
                         self.rows("e.h5").drop(columns="task").to_csv(index=False))
        self.succeed("clogsweep", "status", "s.h5")
        self.assertIn("there is nothing left to do",
                      self.succeed("clogsweep", *QUICK, "preset=robust,elastic", "obstacle-gap=0.4", "seeds=1..2", "--output", "s.h5").stderr)

    def test_more_points_than_an_attribute_holds(self):
        self.write("many.csv", "line-tension,seeds\n" + "".join(f"{0.5 + i / 1e5:g},1\n" for i in range(5000)))
        self.write("one.csv", "line-tension,seeds\n0.5,1\n")
        self.sweep("s.h5", "--points", "one.csv", "obstacle-gap=0.4")
        done = self.run_program("clogsweep", *QUICK, "--points", "many.csv", "obstacle-gap=0.4", "--max-hours", "1e-4",
                                "--output", "s.h5")
        self.assertEqual(done.returncode, 75, done.stderr)
        self.assertIn("of 5000 runs", self.succeed("clogsweep", "status", "s.h5").stdout)
        self.succeed("clogsweep", "verify", "s.h5")
        with h5py.File(self.folder / "s.h5") as file:
            self.assertIn("config.2", file.attrs)

    def test_mistakes_get_one_line_and_nothing_is_written(self):
        for text, words in [("line-tension\n", ["holds no points"]), ("", ["holds no points"]),
                            ("line-tension [g rho]\n1\n", ["p.csv line 1", "without units"]),
                            ("lime-tension\n1\n", ["p.csv line 1", "did you mean line-tension?"]),
                            ("line-tension,line-tension\n1,2\n", ["line-tension", "twice"]),
                            ("line-tension,obstacle-gap\n1\n", ["p.csv line 2", "1 cell", "2 keys"]),
                            ("line-tension;seeds\n1;2,0\n", ["p.csv line 2", "seeds: '2,0'", "decimal comma"]),
                            ("line-tension;max-time\n1;1,350\n2;2,050\n", ["p.csv", "'1,350'", "thousands"]),
                            ("line-tension;seeds\n0.5,0.7;1\n",
                             ["p.csv line 2", "line-tension: '0.5,0.7' may be a list", "a line for each value"]),
                            ("line-tension\n1.234,5\n", ["p.csv line 2", "line-tension: '1.234,5'", "decimal comma"]),
                            ("line-tension,seeds\n\"0,5\",1\n",
                             ["p.csv line 2", "line-tension: '0,5'", "decimal comma"]),
                            ("line-tension\n1\nx\n", ["p.csv line 3", "invalid line-tension=x"]),
                            ("line-tension\n1\n-1\n", ["point 2", "invalid line-tension=-1"]),
                            ("line-tension\n1\n1.0\n", ["point 1 and point 2", "the same run"]),
                            ("line-tension,seeds\n1,1..3\n1,3\n", ["point 1 and point 2", "seed 3"]),
                            ("obstacle-gap\n0.001\n", ["point 1", "obstacle-gap"])]:
            self.write("p.csv", text)
            self.refuse("clogsweep", *QUICK, "--points", "p.csv", "--output", "s.h5", words=words)
        # Keys of some points, given for all of them
        self.write("p.csv", "obstacle-layout,orifice\nrandom,\nchannel,0.6\n")
        for setting in ("seeds=1..3", "box=20", "obstacle-gap=0.5"):
            key = setting.split("=")[0]
            self.refuse("clogsweep", "vertices=64", setting, "--points", "p.csv", "--output", "s.h5",
                        words=[f"point 2: invalid {setting}", f"to give {key} for some points, make it a column of the points file"])
        self.write("p.csv", "obstacle-layout,orifice,seeds,box\nrandom,,1..3,20\nchannel,0.6,,\n")
        printed = self.plan("vertices=64", "--points", "p.csv", "--output", "s.h5")
        self.assertEqual([line.split()[1] for line in printed.splitlines()[1:5]],
                         ["density", "channel", "density", "density"])
        self.write("p.csv", "model,vertices\ndp,32\nsp,\n")
        self.refuse("clogsweep", "vertices=64", "wall-stiffness=5", "--points", "p.csv", "--output", "s.h5",
                    words=["point 2: invalid vertices=64", "to give vertices for some points, leave it out elsewhere"])
        self.write("p.csv", "obstacle-layout,orifice,box\nrandom,,20\nchannel,0.6,20\n")
        done = self.run_program("clogsweep", "--points", "p.csv", "--output", "s.h5")
        self.assertNotIn("make it a column", done.stderr)
        self.write("p.csv", "obstacle-layout,pitch,seeds,obstacle-gap\nlattice,0.6,1..2,\nrandom,,1..2,0.3\n")
        for setting in ("lattice-angle=5", "lattice=triangular"):
            key = setting.split("=")[0]
            self.refuse("clogsweep", "vertices=64", setting, "--points", "p.csv", "--output", "s.h5",
                        words=[f"point 2: invalid {setting} (a random array has no rows) to give {key} for some "
                               "points, make it a column of the points file"])
        self.refuse("clogsweep", "vertices=64", "pitch=0.7", "--points", "p.csv", "--output", "s.h5",
                    words=["point 2: invalid pitch=0.7", "to give pitch for some points, "
                                                         "leave it out elsewhere and write it in their cells"])
        self.write("p.csv", "pitch,friction\n0.6,0\n,0\n")
        self.refuse("clogsweep", "vertices=64", "obstacle-layout=lattice", "obstacle-gap=0.3", "--points", "p.csv", "--output", "s.h5",
                    words=["point 1: invalid pitch=0.6 (obstacle-gap=0.3 is given as well)", "to give obstacle-gap for some points, make it a column"])
        self.write("p.csv", "line-tension\n1\n")
        self.refuse("clogsweep", *QUICK, "--points", "p.csv", "line-tension=2", "--output", "s.h5",
                    words=["p.csv", "line-tension"])
        self.refuse("clogsweep", *QUICK, "--points", "none.csv", "--output", "s.h5", words=["none.csv"])
        self.write("p.csv", "line-tension,seeds\n1,1..3\n2,1\n")
        self.refuse("clogsweep", *QUICK, "--points", "p.csv", "--until-precision", "50%", "--output", "s.h5",
                    words=["--until-precision"])
        for shard in ("6/5", "0/5", "2", "x"):
            self.refuse("clogsweep", *QUICK, "--shard", shard, "--output", "s.h5", words=[f"--shard={shard}", "2/5"])
        self.refuse("clogsweep", *QUICK, "--shard", "3/5", "seeds=1", "--output", "s.h5", words=["3/5", "is empty"])

    def test_points_without_chance_have_one_run(self):
        self.write("p.csv", "obstacle-layout,orifice\nrandom,\nchannel,0.7\nwall,\n")
        printed = self.plan("vertices=64", "max-time=1", "--seeds-per-set", 12, "--points", "p.csv")
        self.assertIn("# 14 tasks: 3 parameter sets, 1 to 12 seeds each", printed)
        printed = self.plan("vertices=64", "max-time=1", "--seeds-per-set", 12, "obstacle-layout=channel,wall")
        self.assertIn("# 2 tasks: 2 parameter sets", printed)
        self.write("c.csv", "x,y\n5,5\n")
        self.write("p.csv", "obstacles,release\nc.csv,centre\nc.csv,anywhere\n")
        printed = self.plan("vertices=64", "box=10", "max-time=1", "--seeds-per-set", 12, "--points", "p.csv")
        self.assertIn("# 13 tasks: 2 parameter sets, 1 to 12 seeds each", printed)
        self.refuse("clogsweep", "vertices=64", "box=10", "--until-precision", "20%", "--points", "p.csv", "--output",
                    "s.h5", words=["no place for --until-precision (nothing is random with release=centre"])
        self.write("p.csv", "obstacle-layout,orifice\nrandom,\nchannel,0.7\n")
        self.refuse("clogsweep", "vertices=64", "--until-precision", "20%", "--points", "p.csv", "--output", "s.h5",
                    words=["no place for --until-precision (nothing is random with obstacle-layout=channel", "apart"])


class Merged(PointsTest):
    LISTS = ["obstacle-gap=0.4,0.5", "line-tension=0.5,2", "seeds=1..5"]

    def merge(self, *paths, output="all.h5"):
        return self.succeed("clogsweep", "merge", *paths, "--output", output).stdout

    def test_shards_become_the_whole_sweep(self):
        self.sweep("whole.h5", *self.LISTS)
        parts = [self.sweep(f"{i}.h5", *self.LISTS, "--shard", f"{i}/3", ranks=i) for i in (1, 2, 3)]
        self.assertEqual(sum(map(len, parts)), 20)
        self.assertLessEqual(max(map(len, parts)) - min(map(len, parts)), 2)
        self.assertIn("all.h5: 20 rows of 3 files\n", self.merge("2.h5", "1.h5", "3.h5"))
        self.check_same_rows("all.h5", "whole.h5")
        self.assertIn("20 rows of 20 runs, all undamaged", self.succeed("clogsweep", "verify", "all.h5").stdout)

    def test_files_of_other_values_and_overlapping_seeds_become_what_one_sweep_would_have_made(self):
        self.sweep("whole.h5", "line-tension=0.5,1,2", "obstacle-gap=0.4", "seeds=1..6")
        self.sweep("a.h5", "line-tension=0.5,1", "obstacle-gap=0.4", "seeds=1..6")
        self.sweep("b.h5", "line-tension=2", "obstacle-gap=0.4", "seeds=3..6")
        self.sweep("c.h5", "line-tension=2,1", "obstacle-gap=0.4", "seeds=1..4")
        self.assertIn("all.h5: 18 rows of 3 files, 6 runs in more than one of them", self.merge("a.h5", "b.h5", "c.h5"))
        self.check_same_rows("all.h5", "whole.h5")
        self.assertEqual(self.attribute("all.h5", "config"), self.attribute("whole.h5", "config"))
        parts = [json.loads(line) for line in self.attribute("all.h5", "parts").splitlines()]
        self.assertEqual([(part["file"], part["rows"], len(part["hosts"])) for part in parts], [("a.h5", 12, 1), ("b.h5", 4, 1), ("c.h5", 8, 1)])
        self.assertEqual(self.attribute("all.h5", "sessions").count("\n"), 4, "of each part, and of merge")
        self.assertIn("--output b.h5", self.attribute("all.h5", "sessions"))
        self.succeed("clogsweep", *QUICK, "line-tension=0.5,1,2", "obstacle-gap=0.4", "seeds=1..7", "--output", "all.h5")
        self.assertEqual(len(self.rows("all.h5")), 21)
        self.assertIn("a.h5", self.attribute("all.h5", "parts"))

    def test_what_is_no_product_becomes_points(self):
        self.sweep("a.h5", "line-tension=0.5", "obstacle-gap=0.4", "preset=elastic", "seeds=1..2")
        self.sweep("b.h5", "line-tension=2,3", "obstacle-gap=0.5", "boxes=2", "seeds=2..3")
        self.merge("a.h5", "b.h5")
        self.assertIn("6 rows of 6 runs, all undamaged", self.succeed("clogsweep", "verify", "all.h5").stdout)
        own, a = self.rows("all.h5"), self.rows("a.h5")
        self.assertEqual(own[own.preset == "elastic"].drop(columns="task").to_csv(index=False),
                         a.drop(columns="task").to_csv(index=False))
        config = self.write("c.cfg", self.attribute("all.h5", "config"))
        self.assertIn("there is nothing left to do",
                      self.succeed("clogsweep", "--config", config, "--output", "all.h5").stderr)
        self.merge("all.h5", "a.h5", output="again.h5")
        self.check_same_rows("again.h5", "all.h5")

    def test_a_changed_row_is_refused_with_its_task(self):
        self.sweep("a.h5", *self.LISTS)
        self.sweep("b.h5", *self.LISTS[:2], "seeds=5..6")

        def change(rows):
            rows["distance"][2] *= 0.9

        stored_rows.change(self.folder / "b.h5", change)
        self.refuse("clogsweep", "merge", "a.h5", "b.h5", "--output", "all.h5",
                    words=["a.h5", "b.h5", "task 18", "task 2 ", "distance"])
        self.refuse("clogfit", "a.h5", "b.h5", words=["task 18", "task 2 "])

    def test_runs_that_differ_by_instruction_set_are_counted_once(self):
        self.sweep("a.h5", *self.LISTS)
        for name, part in (("b.h5", 0.9), ("c.h5", 0.8)):
            self.sweep(name, *self.LISTS[:2], "seeds=5..6")

            def change(rows, part=part):
                rows["distance"][2] *= part
                rows["instruction_set"][2] = b"other"

            stored_rows.change(self.folder / name, change)
        said = self.merge("a.h5", "b.h5", "c.h5")
        self.assertIn("24 rows of 3 files, 8 runs in more than one of them "
                      "(1 with results that differ by instruction set", said)
        self.assertEqual(self.rows("all.h5")["instruction_set"].nunique(), 1)

    def test_a_merge_names_numerical_keys_that_keep_parameter_sets_apart(self):
        for name, tension, vertices, seed in [("a", 1, 64, 1), ("b", 1, 80, 1), ("c", 3, 80, 1), ("d", 1, 64, 3)]:
            self.succeed("clogsweep", *SMALL[1:], "max-time=1", f"line-tension={tension}", f"vertices={vertices}", f"seeds={seed}", "--output", f"{name}.h5")
        for other, said in [("b", "clogsweep merge: no parameter set is in two of the files, "
                                  "because they differ in vertices; clogfit does not join their runs\n"),
                            ("c", ""), ("d", "")]:
            self.assertEqual(self.succeed("clogsweep", "merge", "a.h5", f"{other}.h5", "--output", f"a{other}.h5").stderr, said)

    def test_files_with_different_circles_of_one_name_are_not_merged(self):
        own = ["vertices=32", "box=10", "boxes=3", "max-time=30", "line-tension=1", "obstacles=c.csv", "release=anywhere", "seeds=1..2"]
        for name, size, words in [("a.h5", 0.5, []), ("b.h5", 0.6, []), ("c.h5", 0.7, ["--until-precision=90%", "--most-seeds=2"])]:
            self.write("c.csv", f"x,y,diameter\n2,2,0.5\n5,5,{size}\n8,3,0.5\n")
            self.run_program("clogsweep", *own, *words, "--output", name)
            self.assertEqual(len(self.rows(name)), 2)
        for other in ("b.h5", "c.h5"):
            self.refuse("clogsweep", "merge", "a.h5", other, "--output", "all.h5", words=["different circles under the same name c.csv"])
            self.assertEqual(self.succeed("clogfit", "a.h5", other).stderr.count(f"a.h5, {other}: read together without their settings: two files contain different circles"), 1)

    def test_a_stopped_sweep_goes_on_in_the_merged_file(self):
        long = [*SMALL, "max-time=3000", "obstacle-gap=0.6", "line-tension=0.5", "--report-seconds=0.05"]
        self.succeed("clogsweep", *long, "seeds=1..3", "--output", "whole.h5")
        done = self.run_program("clogsweep", *long, "seeds=1..2", "--output", "a.h5", "--max-hours", "1e-5")
        self.succeed("clogsweep", *long, "seeds=3", "--output", "b.h5")
        self.merge("a.h5", "b.h5")
        self.assertIn("of 3 runs", self.succeed("clogsweep", "status", "all.h5").stdout)
        self.assertEqual(self.attribute("all.h5", "config"), self.attribute("whole.h5", "config"))
        self.succeed("clogsweep", *long, "seeds=1..3", "--output", "all.h5")
        self.check_same_rows("all.h5", "whole.h5")
        self.assertIn(done.returncode, (0, 75))

    def test_mistakes_get_one_line_and_nothing_is_written(self):
        self.sweep("a.h5", "seeds=1", "obstacle-gap=0.4")
        self.sweep("b.h5", "seeds=2", "obstacle-gap=0.4")
        self.write("text.h5", "no table")
        self.refuse("clogsweep", "merge", "a.h5", "--output", "c.h5", words=["missing sweep files"])
        self.refuse("clogsweep", "merge", "a.h5", "b.h5", words=["missing --output"])
        self.refuse("clogsweep", "merge", "a.h5", "b.h5", "--output", "b.h5", words=["will not overwrite b.h5"])
        self.refuse("clogsweep", "merge", "a.h5", "none.h5", "--output", "c.h5", words=["none.h5", "no such file"])
        self.refuse("clogsweep", "merge", "a.h5", "text.h5", "--output", "c.h5", words=["text.h5", "not an HDF5 file"])
        content = (self.folder / "b.h5").read_bytes()
        (self.folder / "b.h5").write_bytes(content.replace(b"robust", b"rubust", 1))
        self.refuse("clogsweep", "merge", "a.h5", "b.h5", "--output", "c.h5", words=["b.h5", "damaged"])


class Selected(PointsTest):
    def test_rows_by_conditions_on_columns(self):
        self.sweep("s.h5", "line-tension=0.5,1,2", "obstacle-gap=0.4,0.5", "seeds=1..3")
        self.sweep("some.h5", "line-tension=1,2", "obstacle-gap=0.5", "seeds=1..2")
        done = self.succeed("clogsweep", "select", "s.h5", "line_tension>0.5", "obstacle_gap=0.5,0.7", "--where",
                            "seed<=2", "--output", "out.h5")
        self.assertEqual(done.stdout, "out.h5: 4 rows\n")
        self.check_same_rows("out.h5", "some.h5")
        part, = map(json.loads, self.attribute("out.h5", "parts").splitlines())
        self.assertIn("line_tension>0.5", part["selected"])
        self.succeed("clogsweep", "verify", "out.h5")
        self.succeed("clogsweep", "select", "s.h5", "status!=clogged", "--output", "flowing.h5")
        rows = table(self.folder / "s.h5")
        self.assertEqual(len(self.rows("flowing.h5")), (rows.status != "clogged").sum())

    def test_mistakes_get_one_line_and_nothing_is_written(self):
        self.sweep("s.h5", "seeds=1..2", "obstacle-gap=0.4")
        for condition, words in [("line-tension>1", ["did you mean line_tension?"]), ("status>clogged", ["is a word"]),
                                 ("seed", ["give one like"]), ("seed=x", ["'x'"]), ("seed>1,2", ["a list"]),
                                 ("seed>7", ["no row"])]:
            self.refuse("clogsweep", "select", "s.h5", condition, "--output", "o.h5", words=words)
        self.refuse("clogsweep", "select", "s.h5", "--output", "o.h5", words=["missing condition"])
        self.refuse("clogsweep", "select", "s.h5", "seed=1", words=["missing --output"])


if __name__ == "__main__":
    unittest.main()
