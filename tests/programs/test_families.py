"""Tests droplets that break up and continue as daughters, from the sweep to its pictures."""

import json
import os
import signal
import unittest

import h5py
import matplotlib.patches
import matplotlib.text
import numpy as np
import pandas
import stored_rows
from drawing import Analysis
from support import BIN, FAMILIES, SNAPSHOT_OF_A_DAUGHTER, TIMING, SweepTest, shared_sweep, table

import clogsweep
from clogsweep.drawing import families, family_film
from clogsweep.reading import trajectory
from clogsweep.tools.errors import UserError

# Families with runs that take seconds, so that they have snapshots of ancestors and of daughters.
LONG = [word.replace("max-time=700", "max-time=6000") for word in FAMILIES]


def droplets(path):
    return pandas.read_hdf(path, "droplets")


class Families(SweepTest, Analysis):
    def setUp(self):
        super().setUp()
        self.copy_sweep("s.h5", *FAMILIES)
        self.droplets = droplets(self.folder / "s.h5")

    def check_equal(self, name, other):
        super().check_equal(name, other)
        pandas.testing.assert_frame_equal(droplets(self.folder / name), droplets(self.folder / other), check_exact=True)

    def deepest(self):
        """The table's line for a droplet of the youngest generation that was followed."""
        followed = self.droplets[self.droplets.status != "small"]
        return max(followed.itertuples(), key=lambda member: len(member.path))

    def sweep_device(self, *words):
        """Makes d.h5, a sweep of a device with an exit."""
        self.write("posts.csv", "x,y,diameter\n" + "".join(
            f"{x},{2 * y + 0.5 + x // 2 % 2},0.3\n" for x in range(4, 12, 2) for y in range(10)))
        self.succeed("clogsweep", "break-up=daughters", "break-up-neck=0.08", "self-contact-range=0.02",
                     "vertices=64", "obstacles=posts.csv", "box=20", "length=20", "release=entrance", "max-time=2000",
                     *words, "--quiet", "--output", "d.h5")

    def test_the_area_of_each_family_is_that_of_its_ancestor(self):
        rows = table(self.folder / "s.h5")
        self.assertEqual(sorted(set(self.droplets.task)), rows.task.tolist())
        ancestors = self.droplets[self.droplets.path == ""]
        self.assertEqual(ancestors.status.tolist(), rows.status.tolist())
        self.assertEqual(ancestors.end_distance.tolist(), rows.distance.tolist())
        self.assertEqual(ancestors.end_time.tolist(), rows.time.tolist())
        for _, family in self.droplets.groupby("task"):
            leaves = family[family.status != "broken"]
            self.assertAlmostEqual((leaves.diameter**2).sum(), 1, delta=1e-13)
        self.assertGreater(len(self.droplets), 2 * len(rows))

    def test_a_droplet_breaks_into_halves_on_a_post_ahead(self):
        self.write("post.csv", "x,y,diameter\n13,10,0.3\n")
        self.succeed("clogsweep", "obstacles=post.csv", "box=20", "seeds=1", "vertices=128", "line-tension=0.1",
                     "break-up=daughters", "break-up-neck=0.02", "max-time=200", "--output", "post.h5")
        first, *halves = droplets(self.folder / "post.h5").itertuples()
        self.assertEqual((first.status, [half.path for half in halves[:2]]), ("broken", ["0", "1"]))
        areas = [half.diameter**2 for half in halves[:2]]
        self.assertAlmostEqual(areas[0], areas[1], delta=1e-3)
        self.assertAlmostEqual(halves[0].birth_lateral, -halves[1].birth_lateral, delta=0.02)

    def test_rows_of_ancestors_are_those_of_runs_that_end_at_break_up(self):
        alone = [word for word in FAMILIES if not word.startswith("break-up=")]
        self.copy_sweep("alone.h5", *alone)
        family, single = (table(self.folder / name).drop(columns=[*TIMING, "break_up"]) for name in ("s.h5", "alone.h5"))
        pandas.testing.assert_frame_equal(family, single, check_exact=True)
        with h5py.File(self.folder / "alone.h5") as file:
            self.assertNotIn("droplets", file)
            self.assertEqual(file.attrs["format_version"], b"11")

    def test_programs_of_another_format_refuse_the_file_with_one_line(self):
        with h5py.File(self.folder / "s.h5") as file:
            self.assertEqual(file.attrs["format_version"], b"12")
        stored_rows.change_attribute(self.folder / "s.h5", "format_version", "13")
        self.refuse("clogsweep", "status", "s.h5", words=["format version 13", "9 to 12"])

    def test_a_replay_repeats_families_and_single_daughters(self):
        self.assertIn("the same bits", self.succeed("clogsweep", "replay", "s.h5", 0).stdout)
        member = self.deepest()
        self.assertGreater(len(member.path), 1)
        printed = self.succeed("clogsweep", "replay", "s.h5", member.task, "--droplet", member.path).stdout
        self.assertIn("the same bits", printed)
        paths = ", ".join(path for path in self.droplets[self.droplets.task == 0].path if path)
        for program, more in (("clogsweep", []), ("clogrun", ["--output", "r.h5"])):
            self.refuse(program, "replay", "s.h5", 0, "--droplet", "0000000", *more, words=[f"task 0 are {paths})"])

    def test_a_replay_repeats_daughters_with_the_springs_of_a_preset(self):
        """The springs of daughters follow from the ratio of spring stiffness to line tension. A row has only the
        stiffness for the ancestor, so the replay must take the ratio from the preset."""
        self.succeed("clogsweep", *FAMILIES, "preset=elastic", "--quiet", "--output", "e.h5")
        self.assertGreater(len(droplets(self.folder / "e.h5")), 1)
        self.assertIn("the same bits", self.succeed("clogsweep", "replay", "e.h5", 0).stdout)

    def test_a_replay_finds_a_changed_daughter(self):
        def change(file):
            lines = file["droplets"][:]
            lines["end_distance"][lines["path"] == b"0"] += 1e-9
            file["droplets"][:] = lines
            file["droplet_checksums"][:] = [stored_rows.zlib.crc32(line.tobytes()) for line in lines]

        stored_rows.edited(self.folder / "s.h5", change)
        for more in ([], ["--droplet", "0"]):
            done = self.run_program("clogsweep", "replay", "s.h5", 0, *more)
            self.assertEqual(done.returncode, 1, done.stdout + done.stderr)
            self.assertIn("differs", done.stdout)

    def test_clogrun_records_a_daughter_in_its_own_units(self):
        member = self.deepest()
        self.succeed("clogrun", "replay", "s.h5", member.task, "--droplet", member.path, "--output", "r.h5",
                     "--polygon-interval", 5)
        run = clogsweep.open(self.folder / "r.h5", BIN)
        scale = member.diameter
        self.assertEqual(float(run.attributes["droplet_diameter"]), scale)
        self.assertEqual(run.attributes["droplet"], member.path)
        self.assertEqual(run.row["status"], member.status)
        replayed = clogsweep.open(self.folder / "s.h5", BIN).replay(member.task, droplet=member.path, interval=5)
        self.assertEqual(replayed.attributes["droplet"], member.path)
        np.testing.assert_array_equal(replayed.polygons, run.polygons)
        with self.assertRaisesRegex(clogsweep.ProgramFailed, "task 0 are"):
            clogsweep.open(self.folder / "s.h5", BIN).replay(0, droplet="0000000")
        with self.assertRaisesRegex(UserError, "invalid droplet=0"):
            clogsweep.open(self.folder / "s.h5", BIN).replay(0, droplet=0)
        self.assertAlmostEqual(member.birth_distance + scale * run.row["distance"], member.end_distance, delta=1e-12)
        self.assertAlmostEqual(member.birth_time + scale**0.5 * run.row["time"], member.end_time, delta=1e-9)
        self.assertAlmostEqual(run.samples.area[0], np.pi / 4, delta=0.01)

    def test_damage_of_the_droplets_is_found(self):
        content = bytearray((self.folder / "s.h5").read_bytes())
        with h5py.File(self.folder / "s.h5") as file:
            place = file["droplets"].id.get_chunk_info(0).byte_offset
        content[place + 80] ^= 4
        (self.folder / "s.h5").write_bytes(content)
        self.assertEqual(self.run_program("clogsweep", "verify", "s.h5").returncode, 1)
        self.assertEqual(self.run_program("clogfit", "s.h5").returncode, 2)
        self.succeed("clogsweep", "salvage", "s.h5", "--output", "kept.h5")
        self.succeed("clogsweep", *FAMILIES, "--output", "kept.h5")
        self.copy_sweep("whole.h5", *FAMILIES)
        self.check_equal("kept.h5", "whole.h5")

    def test_a_changed_number_costs_its_family_only(self):
        def change(file):
            lines = file["droplets"][:]
            lines["end_time"][np.flatnonzero(lines["task"] == 1)[-1]] *= 1 + 1e-12
            file["droplets"][:] = lines

        stored_rows.edited(self.folder / "s.h5", change)
        said = self.run_program("clogsweep", "verify", "s.h5").stdout
        self.assertRegex(said, r"droplet \d+ \(task 1\) is not as it was written")
        self.assertIn("3 undamaged rows", said)
        self.succeed("clogsweep", "salvage", "s.h5", "--output", "kept.h5")
        self.assertEqual(set(droplets(self.folder / "kept.h5").task), {0, 2, 3})
        self.assertIn("4 runs", self.succeed("clogsweep", *FAMILIES, "--output", "kept.h5").stderr)
        self.copy_sweep("whole.h5", *FAMILIES)
        self.check_equal("kept.h5", "whole.h5")

    def test_families_do_not_depend_on_the_number_of_ranks(self):
        for ranks in (2, 3):
            self.succeed("clogsweep", *FAMILIES, "--output", f"{ranks}.h5", ranks=ranks)
            self.check_equal(f"{ranks}.h5", "s.h5")

    def test_select_and_merge_keep_families(self):
        self.succeed("clogsweep", "select", "s.h5", "seed<=2", "--output", "one.h5")
        self.succeed("clogsweep", "select", "s.h5", "seed>=2", "--output", "other.h5")
        self.succeed("clogsweep", "merge", "one.h5", "other.h5", "--output", "all.h5")
        self.check_equal("all.h5", "s.h5")

    def test_families_merge_with_runs_that_end_at_break_up(self):
        self.copy_sweep("end.h5", *(word for word in FAMILIES if not word.startswith("break-up=")))
        self.succeed("clogsweep", "merge", "s.h5", "end.h5", "--output", "both.h5")
        self.succeed("clogsweep", "verify", "both.h5")
        rows = table(self.folder / "both.h5").set_index("task")
        self.assertEqual(len(rows), 8)
        merged = droplets(self.folder / "both.h5")
        self.assertEqual(set(rows.break_up[merged.task]), {"daughters"})
        for name, form in (("end", b"11"), ("daughters", b"12")):
            self.succeed("clogsweep", "select", "both.h5", f"break_up={name}", "--output", f"{name}-again.h5")
            with h5py.File(self.folder / f"{name}-again.h5") as file:
                self.assertEqual([file.attrs["format_version"], "droplets" in file], [form, form == b"12"])
        self.check_equal("daughters-again.h5", "s.h5")

    def test_families_are_added_to_a_finished_sweep(self):
        few = [*FAMILIES[:-1], "seeds=1..3", "--output", "few.h5"]
        self.succeed("clogsweep", *few)
        self.succeed("clogsweep", *few, "--seeds-per-set", 4)
        pandas.testing.assert_frame_equal(droplets(self.folder / "few.h5"), self.droplets, check_exact=True)

    def test_killed_families_resume_bit_for_bit(self):
        sweep = [*LONG, "--report-seconds=0.1", "--output", "k.h5"]

        journal = self.folder / "k.h5.journal"

        def kill():
            process = self.start(*sweep)
            self.wait_for(lambda: process.poll() is not None or
                          journal.exists() and SNAPSHOT_OF_A_DAUGHTER in journal.read_bytes())
            for rank in self.ranks_of(process):
                os.kill(rank, signal.SIGKILL)
            process.communicate()
            return journal.exists() or (self.folder / "k.h5").unlink()

        self.until_in_time(kill)
        self.succeed("clogsweep", *sweep, ranks=2)
        (self.folder / "whole.h5").write_bytes(shared_sweep(*LONG).read_bytes())
        rows, others = (table(self.folder / name).drop(columns=[*TIMING, "attempt"]) for name in ("k.h5", "whole.h5"))
        pandas.testing.assert_frame_equal(rows, others, check_exact=True)
        pandas.testing.assert_frame_equal(droplets(self.folder / "k.h5"), droplets(self.folder / "whole.h5"),
                                          check_exact=True)

    def test_the_table_says_which_droplets_its_lengths_count(self):
        self.assertIn("daughters: only the table with droplets per ancestor counts them",
                      self.succeed("clogfit", "s.h5").stdout)

    def test_the_fit_accounts_for_the_whole_area(self):
        group, = json.loads(self.succeed("clogfit", "s.h5", "--format", "json").stdout)["groups"]
        families = group["families"]
        self.assertEqual(families["ancestors"], self.droplets.task.nunique())
        self.assertAlmostEqual(families["daughters"], (self.droplets.path != "").sum() / families["ancestors"], places=12)
        self.assertTrue(families["lines"])
        for line in families["lines"]:
            areas = line["passed"]["area"], line["clogged"], line["small"], line["not_known"]
            self.assertAlmostEqual(sum(areas), 1, places=12)
            self.assertAlmostEqual(sum(line["passed"]["areas"]), line["passed"]["area"], places=12)
        self.assertIn("not known", self.succeed("clogfit", "s.h5").stdout)

    def test_the_json_of_a_fit_has_the_units_of_families(self):
        units = json.loads(self.succeed("clogfit", "s.h5", "--format", "json").stdout)["units"]
        self.assertEqual(units["families"], {"diameter_class": "sigma", "distance": "sigma", "mean_diameter": "sigma"})

    def test_more_lines_are_counted_as_pandas_counts_them(self):
        """A droplet that passes a line counts at this line, but its daughters do not count there again."""
        lines = json.loads(self.succeed("clogfit", "s.h5", "--format", "json", "--lines", "3,7").stdout)
        for line in lines["groups"][0]["families"]["lines"]:
            reach = self.droplets[["birth_distance", "end_distance"]].max(axis=1)
            passed = self.droplets[reach >= line["distance"]]
            known = {(one.task, one.path) for one in passed.itertuples()}
            first = [one for one in passed.itertuples()
                     if not any((one.task, one.path[:size]) in known for size in range(len(one.path)))]
            self.assertAlmostEqual(line["passed"]["number"], len(first) / 4)
            self.assertIsNone(line["passed"]["number_lower"], "four families are too few for percentiles")
        self.assertEqual([line["distance"] for line in lines["groups"][0]["families"]["lines"]][:2], [3, 7])

    def test_the_exit_of_a_device_is_a_line(self):
        self.sweep_device("line-tension=0.05", "exit=15", "seeds=1..6")
        group, = json.loads(self.succeed("clogfit", "d.h5", "--format", "json").stdout)["groups"]
        line = next(line for line in group["families"]["lines"] if line["distance"] == 15)
        found = droplets(self.folder / "d.h5")
        self.assertGreater(len(found), 6)
        leaves = found[found.status != "broken"]
        self.assertAlmostEqual(line["passed"]["area"], (leaves[leaves.status == "passed"].diameter**2).sum() / 6)
        others = sum(line[name] for name in ("clogged", "small", "not_known"))
        self.assertAlmostEqual(others + line["passed"]["area"], 1)
        picture = clogsweep.open(self.folder / "d.h5", BIN).device(ways=0, map=0)
        self.assertIn("daughters draws their daughters", str(picture.figure.findobj(matplotlib.text.Text)))

    def test_python_reads_and_draws_families(self):
        sweep = clogsweep.open(self.folder / "s.h5", BIN)
        pandas.testing.assert_frame_equal(sweep.droplets, self.droplets)
        self.draw("daughters", "s.h5", "--programs", BIN)
        self.assert_picture("s-daughters")
        task = self.deepest().task
        self.draw("daughters", "s.h5", "--programs", BIN, "--task", task, "--output", "family")
        self.assert_picture("family")
        self.draw("daughters", "s.h5", "--programs", BIN, "--task", task, "--frames", 5, "--film", "f.gif")
        self.assertGreater((self.folder / "f.gif").stat().st_size, 1000)
        self.draw("daughters", "s.h5", "--programs", BIN, "--outlet", 7, "--output", "seven")
        self.draw("daughters", "s.h5", "--programs", BIN, "--outlet", "1000sigma", "--output", "beyond")
        self.draw("report", "s.h5", "--programs", BIN, "--examples", 0)
        self.assertIn("<h2>Families</h2>", (self.folder / "s-report.html").read_text())
        for words, said in ([["--outlet", "7mm"], "diameter is not known"], [["--task", 99], "has no family"],
                            [["--film", "g.gif"], "missing --task"]):
            self.refuse_analysis("daughters", "s.h5", "--programs", BIN, *words, "--output", "x", words=[said])

    def test_export_writes_the_droplets_into_a_second_file(self):
        for ending in ("csv", "h5"):
            printed = self.draw("export", "s.h5", f"rows.{ending}", "--programs", BIN).stdout
            self.assertEqual(printed, f"rows.{ending}\nrows-droplets.{ending}\n")
        read = pandas.read_csv(self.folder / "rows-droplets.csv", converters={"path": str},
                               float_precision="round_trip")
        self.assertIn("birth_distance [sigma]", read)
        same = self.droplets.assign(mechanism=self.droplets.mechanism.replace("", np.nan))
        pandas.testing.assert_frame_equal(read.set_axis(same.columns, axis=1), same, check_exact=True)
        with h5py.File(self.folder / "rows-droplets.h5") as file:
            self.assertEqual(file["path"].asstr()[:].tolist(), self.droplets.path.tolist())
            self.assertEqual(file["end_time"].attrs["unit"], "t0")
        self.refuse_analysis("export", "s.h5", "rows-droplets.csv", "--programs", BIN, words=["will not overwrite"])
        (self.folder / "rows.csv").unlink()
        self.refuse_analysis("export", "s.h5", "rows.csv", "--programs", BIN,
                             words=["will not overwrite rows-droplets.csv"])
        self.assertFalse((self.folder / "rows.csv").exists(), "one file without the other")

    def test_a_report_does_not_deny_clogs_that_it_does_not_show(self):
        self.succeed("clogsweep", "break-up=daughters", "break-up-neck=0.08", "self-contact-range=0.02",
                     "obstacle-density=saturated", "line-tension=0.1,0.2", "vertices=64", "box=20", "max-time=1500",
                     "seeds=3", "--quiet", "--output", "c.h5")
        found = droplets(self.folder / "c.h5")
        clogged = found[found.status == "clogged"]
        self.assertEqual([set(clogged.task[clogged.path == path]) for path in ("", "0", "1")], [{1}, {0}, {0}])
        for name, words in (("line_tension=0.1", "No released droplet has clogged, but daughters have"),
                            ("line_tension=0.2", "")):
            self.succeed("clogsweep", "select", "c.h5", name, "--output", "one.h5")
            self.draw("report", "one.h5", "--programs", BIN, "--examples", 0 if not words else 4)
            page = (self.folder / "one-report.html").read_text()
            self.assertIn(words, page)
            self.assertNotIn("No polygon has clogged", page)
            (self.folder / "one.h5").unlink()

    def test_an_error_about_an_outlet_names_the_option_outlet(self):
        self.write("lab.cfg", "diameter = 1.6 mm\nangle = 30 deg\nspeed = 30 mm/s\ntension = 0.03 mN/m\n")
        self.sweep_device("--lab", "lab.cfg", "line-tension=0.05", "entrance=1", "exit=15", "seeds=1")
        self.assertIn("0.5 is upstream of the release at x = 1, where no droplet counts",
                      self.succeed("clogfit", "d.h5", "--lines", "0.5,10").stderr)
        for place, words in (("25mm", ["invalid --outlet=25mm (behind the exit at x = 24 mm"]),
                             ("40", ["invalid --outlet=40sigma (behind the exit at x = 15 sigma"]),
                             ("1mm", ["invalid --outlet=1mm (upstream of the release at x = "]),
                             ("0", ["--outlet", "invalid value: 0", "must be", "1e-06"]), ("0mm", ["--outlet"])):
            with self.subTest(place=place):
                done = self.analyse("daughters", "d.h5", "--programs", BIN, "--outlet", place, "--output", "x")
                self.assertEqual(done.returncode, 2, done.stdout + done.stderr)
                self.assertNotIn("--lines", done.stderr)
                for word in words:
                    self.assertIn(word, done.stderr)

    def test_an_error_does_not_end_a_list_of_tasks_before_the_last_one(self):
        table_of_droplets = pandas.DataFrame({"task": [*range(60), 0], "path": ""})
        with self.assertRaisesRegex(UserError, "its tasks with one are 0, 1, .*, 18, 19 and 40 more$"):
            families.family_of(table_of_droplets, 999, "s.h5")
        with self.assertRaisesRegex(UserError, "its tasks with one are 0, 1, .*, 18, 19$"):
            families.family_of(table_of_droplets[table_of_droplets.task < 20], 999, "s.h5")

    def test_daughters_get_the_speed_exponent_of_the_laboratory(self):
        """The law that gives the speeds of droplets of several sizes also holds for daughters."""
        array = ["obstacle-gap=0.3mm", "obstacle-diameter=0.24mm", "obstacle-density=0.5/mm^2", "vertices=64", "box=20",
                 "max-time=0.5", "break-up-neck=0.05", "seeds=1"]
        law = "angle = 30 deg\nspeed = 30 mm/s\ntension = 0.03 mN/m\nspeed-exponent = 1\n"
        self.write("points.csv", "break-up\ndaughters\nend\n")
        for diameters in ("0.8 mm", "0.8 mm, 1.6 mm"):
            self.write("lab.cfg", f"diameter = {diameters}\n{law}")
            for words, exponents in ((["break-up=daughters"], {1.0}),
                                     (["break-up=daughters", "speed-exponent=0.5"], {0.5}),
                                     (["break-up=daughters", "speed-exponent=0"], {0.0}), ([], {0.0}),
                                     (["break-up=end,daughters"], {0.0}), (["--points", "points.csv"], {0.0, 1.0})):
                with self.subTest(words, diameters=diameters):
                    said = self.succeed("clogsweep", "--lab", "lab.cfg", *array, *words, "--output", "own.h5").stderr
                    self.assertEqual("not used for daughters" in said, words == ["break-up=end,daughters"])
                    rows = table(self.folder / "own.h5")
                    self.assertEqual(set(rows.speed_exponent), exponents)
                    self.assertEqual(set(rows.speed_exponent[rows.break_up == "end"]) - {0.0}, set())
                    (self.folder / "own.h5").unlink()

    def test_families_of_several_diameters_are_drawn_in_millimetres(self):
        self.write("lab.cfg", "diameter = 0.8 mm, 1.6 mm\nangle = 30 deg\nspeed = 30 mm/s\ntension = 0.03 mN/m\n")
        self.succeed("clogsweep", "--lab", "lab.cfg", "obstacle-gap=0.3mm", "obstacle-diameter=0.24mm",
                     "obstacle-density=0.5/mm^2", "vertices=64", "box=20", "boxes=4", "break-up=daughters",
                     "break-up-neck=0.05", "max-time=400", "seeds=1", "--quiet", "--output", "two.h5")
        groups = clogsweep.open(self.folder / "two.h5", BIN).fit().known
        share, number, sizes = families.draw(groups, None, "two.h5").axes
        for axes in (share, number, sizes):
            self.assertIn("[mm]", axes.get_xlabel())
        places = [curve.lines[0].get_xdata()[0] for curve in share.containers]
        self.assertAlmostEqual(max(places) / min(places), 2, delta=0.05, msg="10 diameters of each droplet")
        outlet = families.common_outlet(groups.members)
        self.assertEqual(outlet.unit, "mm")
        self.assertAlmostEqual(outlet.of(groups.members[0]) / outlet.of(groups.members[1]),
                               groups.members[1]["diameter_mm"] / groups.members[0]["diameter_mm"])
        self.draw("daughters", "two.h5", "--programs", BIN, "--output", "default")
        for option, others in (("6mm", [7.5, 3.75]), ("4sigma", [4, 4])):
            self.draw("daughters", "two.h5", "--programs", BIN, "--outlet", option, "--output", "mm")
            printed = json.loads(self.succeed("clogfit", "two.h5", "--format=json", "--lines", option).stdout)["groups"]
            found = [group["families"]["lines"][0]["distance"] for group in printed]
            np.testing.assert_allclose(sorted(found), sorted(others), rtol=1e-12)
        table_of_families = self.succeed("clogfit", "two.h5", "--lines", "6mm").stdout.split("droplets per ancestor")[1]
        self.assertIn("mean d/mm", table_of_families)
        self.refuse("clogfit", "two.h5", "--lines", "6s", words=["invalid --lines=6s", "unknown unit 's' for length"])

    def test_the_legend_covers_no_bar(self):
        self.sweep_device("line-tension=0.05,0.4", "exit=15", "seeds=1,2")
        figure = families.draw(clogsweep.open(self.folder / "d.h5", BIN).fit().known, None, "d.h5")
        figure.draw_without_rendering()
        sizes = figure.axes[2]
        box = sizes.get_legend().get_window_extent()
        curves = [line.get_transform().transform_path(line.get_path()) for line in sizes.lines if len(line.get_xdata())]
        self.assertEqual(len(curves), 2)
        self.assertFalse(any(curve.intersects_bbox(box, filled=False) for curve in curves))

    def test_places_in_a_device_are_also_in_millimetres(self):
        self.write("lab.cfg", "diameter = 1.6 mm\nangle = 30 deg\nspeed = 30 mm/s\ntension = 0.03 mN/m\n")
        self.sweep_device("--lab", "lab.cfg", "line-tension=0.05,0.4", "exit=15.25", "seeds=1,2")
        figure = families.draw(clogsweep.open(self.folder / "d.h5", BIN).fit().known, None, "d.h5")
        figure.draw_without_rendering()
        for axes in figure.axes[:2]:
            top, = axes.child_axes
            self.assertEqual([tick.get_text() for tick in axes.get_xticklabels()], ["10", "15.25"])
            self.assertEqual([tick.get_text() for tick in top.get_xticklabels()], ["16", "24.4"])
            self.assertEqual(top.get_xlabel(), "place in the device [mm]")
        words = " ".join(text.get_text() for text in figure.findobj(matplotlib.text.Text))
        self.assertEqual(words.replace("\N{NO-BREAK SPACE}", " ").count("at 15.25 σ (24.4 mm)"), 2,
                         "the ordinate and the note")

    def test_a_family_in_a_device_is_drawn_at_its_places_up_to_the_exit(self):
        self.write("lab.cfg", "diameter = 1.6 mm\nangle = 30 deg\nspeed = 30 mm/s\ntension = 0.03 mN/m\n")
        self.sweep_device("--lab", "lab.cfg", "line-tension=0.05", "entrance=1", "exit=15", "seeds=1")
        with h5py.File(self.folder / "d.h5") as file:
            row = file["runs"][0]
        family = droplets(self.folder / "d.h5")
        axes, = families.draw_family(family, row, clogsweep.open(self.folder / "d.h5", BIN).fit().known).axes
        bars = axes.findobj(matplotlib.patches.Rectangle)[:len(family)]
        self.assertAlmostEqual(bars[0].get_x(), row["release_x"])
        passed = family[family.status == "passed"]
        self.assertTrue(len(passed))
        for number in passed.index:
            self.assertAlmostEqual(bars[number].get_x() + bars[number].get_width(), 15, delta=0.1)
        self.assertIn("place in the device $x", axes.get_xlabel())
        self.assertEqual(axes.child_axes[0].get_xlabel(), "place in the device [mm]")
        self.assertEqual([list(line.get_xdata()) for line in axes.lines if line.get_label() == "exit"], [[15, 15]])

    def test_a_film_of_a_family_draws_the_exit_of_the_device(self):
        self.sweep_device("line-tension=0.05", "entrance=1", "exit=15", "seeds=1")
        family = droplets(self.folder / "d.h5")
        motions = family_film.motions_of(BIN / "clogrun", self.folder / "d.h5", family, family.end_time.max() / 50)
        shown = family_film.FamilyFilm(motions, 5, 20, "540p", exit_distance=14)
        place, = {float(x) for line in shown.figure.axes[0].lines for x in line.get_xdata()}
        for motion in motions:
            if motion.member.status == "passed":
                last = motion.outline_at(motion.member.end_time)
                self.assertAlmostEqual(trajectory.centroids(last[None])[0, 0], place, delta=0.3)
        self.draw("daughters", "d.h5", "--programs", BIN, "--task", 0, "--frames", 5, "--film", "f.gif")

    def test_notes_do_not_call_a_known_fate_unknown(self):
        space = "\N{NO-BREAK SPACE}"
        self.assertEqual(families.fate_note(str(families.Outlet(50, "sigma")), 0),
                         f"at 50{space}σ the fate of the whole area is known")
        self.assertEqual(families.fate_note(str(families.Outlet(7, "mm")), 0.0066),
                         f"at 7{space}mm the fate of at most 0.66 % of the area is not known")

    def test_keys_that_daughters_cannot_have_are_refused(self):
        keys = ["break-up=daughters", "break-up-neck=0.05", "vertices=64"]
        for words in (["time-step=1e-3"], ["wall-stiffness=50"], ["area-stiffness=5000"], ["near-wall-drag=0.07"],
                      ["wall-tension=0.6", "line-tension=0.3"], ["obstacle-layout=channel", "orifice=0.7"],
                      ["model=sp", "wall-stiffness=1"]):
            with self.subTest(words=words):
                given = [key for key in keys if "model=sp" not in words or "vertices" not in key]
                self.refuse("clogsweep", *given, *words, "--dry-run",
                            words=["break-up", *(["model=sp"] if "model=sp" in words else [])])
        self.refuse("clogsweep", "break-up=daughters", "--dry-run", words=["break-up-neck"])

    def test_keys_of_daughters_are_refused_without_them(self):
        for word in ("smallest-daughter=0.3", "speed-exponent=1"):
            with self.subTest(word=word):
                self.refuse("clogsweep", "break-up-neck=0.05", word, "--dry-run",
                            words=[word, "add break-up=daughters"])


if __name__ == "__main__":
    unittest.main()
