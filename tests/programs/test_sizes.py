"""Tests sweeps over several droplets and tilts, which a laboratory file lists."""

import json
import math
import os
import re
import subprocess
import sys
import unittest

import h5py
import numpy as np
import pandas
from matplotlib.text import Text
import stored_rows
from support import BIN, ROOT, SMALL, ProgramTest, table

sys.path.insert(0, str(ROOT / "analysis"))
import clogsweep  # noqa: E402
from clogsweep import style  # noqa: E402
from clogsweep.drawing import critical_angles, device, lengths, ratios, survival_curve  # noqa: E402
from clogsweep.pages import poster  # noqa: E402
from clogsweep.reading import fits  # noqa: E402

GRAVITY = 9.81 * (0.997 - 0.703) / 0.703  # [m/s^2], for octane in water between upright plates
LAB = {"diameter": "0.8 mm, 1.6 mm", "angle": "20 deg, 45 deg", "speed": "1 mm/s", "tension": "2 mN/m"}
SETS = [(diameter, angle) for diameter in (0.8, 1.6) for angle in (20, 45)]
ARRAY = ["obstacle-gap=0.4mm", "obstacle-diameter=0.24mm", "obstacle-density=0.8/mm^2", "vertices=64", "box=12", "max-time=40", "seeds=1..2"]
POSTS = "# units=mm droplet=1mm\nx,y,diameter\n" + "".join(f"{1.7 * i},{1.7 * j},0.3\n" for i in range(6) for j in range(6))


def sine(degrees):
    return math.sin(math.radians(degrees))


class LaboratoryTest(ProgramTest):
    def lab(self, name="lab.cfg", **changed):
        lines = {key: text for key, text in (LAB | {key.replace("_", "-"): text for key, text in changed.items()}).items() if text}
        return self.write(name, "".join(f"{key} = {text}\n" for key, text in lines.items()))

    def droplets(self, **changed):
        return json.loads(self.succeed("clogfit", "units", self.lab(**changed), "--format", "json").stdout)

    def sweep(self, *arguments, output="s.h5", ranks=None, **changed):
        return self.succeed("clogsweep", "--lab", self.lab(**changed), *(arguments or ARRAY), "--output", output,
                            ranks=ranks)

    def fit(self, *arguments):
        return json.loads(self.succeed("clogfit", *arguments, "--format", "json").stdout)


class Sizes(LaboratoryTest):
    def test_gamma_falls_with_area_and_tilt(self):
        found = self.droplets()
        self.assertEqual([(one["diameter_mm"], round(one["angle_degrees"], 9)) for one in found], SETS)
        for one, (diameter, angle) in zip(found, SETS):
            # 0.3 gamma/(rho sigma^2 g sin(angle)), Eq. 7 of Cheng et al.
            gamma = 0.3 * 2e-3 / (703 * (1e-3 * diameter)**2 * GRAVITY * sine(angle))
            self.assertAlmostEqual(one["line_tension"] / gamma, 1, places=9)

    def check_speeds(self, speeds, **changed):
        for one, (diameter, angle), speed in zip(self.droplets(**changed), SETS, speeds):
            self.assertAlmostEqual(one["speed_mm_per_s"] / speed, 1, places=9)
            reduced = 1e-3 * speed / math.sqrt(1e-3 * diameter * GRAVITY * sine(angle))
            self.assertAlmostEqual(one["terminal_speed"] / reduced, 1, places=9)

    def test_a_measured_speed_is_scaled_by_a_law_that_is_printed(self):
        self.check_speeds([sine(angle) / sine(20) for _, angle in SETS])
        law = {"speed_diameter": "1.6 mm", "speed_angle": "45 deg", "speed_exponent": "2"}
        self.check_speeds([(diameter / 1.6)**2 * sine(angle) / sine(45) for diameter, angle in SETS], **law)
        words = "1 mm/s at 1.6 mm and 45 degrees, is scaled with sin(angle) and diameter^2"
        self.assertIn(words, self.succeed("clogfit", "units", self.lab(**law)).stdout)
        self.assertIn(words, self.sweep("--dry-run", *ARRAY, **law).stderr)
        self.assertNotIn(words, self.sweep("--dry-run", "terminal-speed=0.03", *ARRAY, **law).stderr)
        for name, given, is_law in [("s.h5", [], True), ("given.h5", ["terminal-speed=0.03"], False)]:
            self.assertNotIn(words, self.sweep("--quiet", *given, *ARRAY[:-1], "seeds=1", output=name, **law).stderr)
            self.assertEqual(words in self.succeed("clogsweep", "status", name).stdout, is_law)
        self.assertIn("no speed, so all droplets have terminal-speed=0.03",
                      self.sweep("--dry-run", *ARRAY, speed="").stderr)

    def test_a_list_of_speeds_has_one_for_each_droplet_and_tilt(self):
        self.check_speeds([1, 2, 3, 4], speed="1 mm/s, 2 mm/s, 3 mm/s, 4 mm/s")
        self.assertNotIn("scaled", self.succeed("clogfit", "units", "lab.cfg").stdout)

    def test_a_single_droplet_may_be_another_than_that_of_the_speed(self):
        one = json.loads(self.succeed("clogfit", "units", self.lab(diameter="2 mm", angle="30 deg", speed_diameter="1 mm", speed_angle="90 deg", speed_exponent="1"),
                                      "--format", "json").stdout)
        self.assertAlmostEqual(one["speed_mm_per_s"], 1)  # 2 sin(30)

    def test_a_random_array_keeps_its_millimetres(self):
        self.sweep()
        rows = table(self.folder / "s.h5")
        self.assertEqual(len(rows), 8)
        texts = self.fit("s.h5")["laboratories"]
        for row in rows.itertuples():
            diameter = float(texts[row.laboratory].split("diameter = ")[1].split(" mm")[0])
            self.assertAlmostEqual(row.obstacle_gap * diameter, 0.4)
            self.assertAlmostEqual(row.obstacle_diameter * diameter, 0.24)
            self.assertAlmostEqual(row.obstacle_density / diameter**2, 0.8)
            self.assertEqual(row.box, 12)
        self.assertEqual(rows.laboratory.nunique(), 4)

    def test_keys_in_laboratory_units_are_converted_for_one_droplet_too(self):
        printed = self.sweep("line-tension=lin(2mN/m,4mN/m,3)", "obstacle-gap=320 um, 0.45sigma,0.6", "box=0.96cm", "max-time=4s", "--print-config", diameter="0.8 mm", angle="20 deg").stdout
        config = dict(line.split(" = ") for line in printed.splitlines() if " = " in line and not line.startswith(("#", "laboratory")))
        gamma = 0.3 * 2e-3 / (703 * 0.8e-3**2 * GRAVITY * sine(20))
        first, last, count = config["line-tension"].removeprefix("lin(").removesuffix(")").split(",")
        np.testing.assert_allclose([float(first), float(last), float(count)], [gamma, 2 * gamma, 3], rtol=1e-9)
        self.assertEqual((config["obstacle-gap"], config["box"]), ("0.4, 0.45,0.6", "12"))
        self.assertAlmostEqual(float(config["max-time"]) * math.sqrt(0.8e-3 / (GRAVITY * sine(20))), 4)

    def test_own_circles_keep_their_millimetres(self):
        self.write("posts.csv", POSTS)
        keys = ["obstacles=posts.csv", "box=10.2mm", "release=anywhere", "vertices=64", "max-time=20", "seeds=1"]
        self.sweep(*keys, diameter="0.8 mm, 1 mm, 1.25 mm", angle="20 deg")
        texts = self.fit("s.h5")["laboratories"]
        with h5py.File(self.folder / "s.h5") as file:
            self.assertEqual(len(file["obstacles"]), 3)
            for row in file["runs"][:]:
                diameter = float(texts[row["laboratory"].decode()].split("diameter = ")[1].split(" mm")[0])
                circles = file["obstacles"][row["obstacles"].decode()][:]
                np.testing.assert_allclose(np.stack([circles["x"], circles["y"], 2 * circles["radius"]], axis=1) * diameter,
                                           np.loadtxt(self.folder / "posts.csv", delimiter=",", skiprows=2), rtol=1e-12, atol=1e-12)
                self.assertAlmostEqual(row["box"] * diameter, 10.2)
        # The stored circles of each droplet size equal the circles of a file for this size alone.
        self.write("small.csv", POSTS.replace("droplet=1mm", "droplet=0.8mm"))
        self.succeed("clogsweep", "--lab", self.lab(diameter="0.8 mm", angle="20 deg"), *keys[1:],
                     "obstacles=small.csv", "--output", "one.h5")
        rows, one = table(self.folder / "s.h5"), table(self.folder / "one.h5")
        self.assertIn(one.obstacles[0], set(rows.obstacles))
        self.assertEqual(rows.distance[rows.obstacles == one.obstacles[0]].tolist(), one.distance.tolist())
        self.succeed("clogsweep", "verify", "s.h5")

    def test_circles_of_another_droplet_are_scaled_for_one_droplet_too(self):
        self.write("posts.csv", POSTS)
        lab = self.lab(diameter="0.5 mm", angle="20 deg")
        self.succeed("clogrun", "array", "--lab", lab, "obstacles=posts.csv", "box=10.2mm", "vertices=64", "max-time=5",
                     "--output", "r.h5")
        with h5py.File(self.folder / "r.h5") as file:
            self.assertAlmostEqual(file["runs"]["box"][0], 20.4)
            self.assertAlmostEqual(file["runs"]["obstacle_gap"][0], 2 * (1.7 - 0.3))

    def test_circles_in_millimetres_get_the_droplet_of_the_laboratory(self):
        """A unit is enough, in a comment or in the header; the diameter may be obstacle-diameter."""
        rows = [line.split(",") for line in POSTS.splitlines()[2:]]
        centres = "".join(f"{x},{y}\n" for x, y, _ in rows)
        full = POSTS.split("\n", 2)[2]
        microns = "".join(f"{1000 * float(x):.0f},{1000 * float(y):.0f},150\n" for x, y, _ in rows)
        keys = ["obstacles=own.csv", "box=10.2mm", "vertices=64", "max-time=0.5", "seeds=1"]
        sets = [{"diameter": "0.8 mm", "angle": "20 deg"}, {"diameter": "0.8 mm, 1.6 mm", "angle": "20 deg"}]

        def circles(text, *more, **lab):
            self.write("own.csv", text)
            self.sweep(*keys, *more, output="own.h5", **lab)
            found = table(self.folder / "own.h5")
            (self.folder / "own.h5").unlink()
            return sorted(zip(found.obstacles, found.obstacle_gap))

        for lab in sets:
            known = circles(POSTS, **lab)
            for text in ("# units=mm\nx,y,diameter\n" + full, "x [mm],y [mm],diameter [mm]\n" + full,
                         "x_mm,y_mm,d\n" + full, "# x_mm y_mm diameter_mm\n" + full, "# units=um\nx,y,r\n" + microns):
                with self.subTest(text[:30], **lab):
                    self.assertEqual(circles(text, **lab), known)
            for text in ("# units=mm\n", "x [mm], y [mm]\n", "# units=mm droplet=1mm\nx,y\n"):
                with self.subTest(text, **lab):
                    gaps = [gap for _, gap in circles(text + centres, "obstacle-diameter=0.3mm", **lab)]
                    np.testing.assert_allclose(sorted(gaps), sorted(gap for _, gap in known), rtol=1e-9)
                    self.refuse("clogsweep", "--quiet", "--lab", self.lab(**lab), *keys, "--output", "x.h5",
                                words=["obstacle-diameter=0.3"])
        self.write("points.csv", "line-tension;obstacles\n1;own.csv\n")
        for lab in sets:
            self.write("own.csv", "# units=mm\nx,y,diameter\n" + full)
            self.sweep("--points", "points.csv", *keys[1:], output="own.h5", **lab)
            names = sorted(table(self.folder / "own.h5").obstacles)
            (self.folder / "own.h5").unlink()
            self.assertEqual(names, sorted(name for name, _ in circles(POSTS, **lab)))
        lab = ["--lab", self.lab(**sets[0]), "obstacle-diameter=0.3mm"]
        for text in ("# units=mm\nx,y,diameter\n" + full, "x [mm], y [mm]\n" + centres):
            self.write("own.csv", text)
            self.write("own.cfg", self.succeed("clogsweep", *lab, *keys, "--print-config").stdout)
            self.succeed("clogsweep", "--config", "own.cfg", "--output", "own.h5")  # It needs no laboratory.
            name = table(self.folder / "own.h5").obstacles[0]
            (self.folder / "own.h5").unlink()
            self.assertEqual(name, circles(text, lab[2], **sets[0])[0][0])
        for text, number in (("# units=mm\n" + full, 1), ("x [mm],y [mm]\n" + centres, 2)):
            self.write("own.csv", text)
            self.refuse("clogsweep", "obstacles=own.csv", "box=10", "--output", "x.h5",
                        words=[f"own.csv line {number}", "droplet=200um", "--lab"])

    def test_a_dry_run_names_the_unit_of_plain_circles(self):
        lab = ["--lab", self.lab(diameter="0.8 mm", angle="20 deg")]
        self.write("plain.csv", "x,y,diameter\n1,1,0.3\n4,4,0.3\n")
        self.write("mm.csv", "# units=mm\nx,y,diameter\n1,1,0.3\n4,4,0.3\n")
        said = self.succeed("clogsweep", *lab, "obstacles=plain.csv,mm.csv", "box=6", "--dry-run").stderr
        line = "clogsweep: obstacles=plain.csv names no unit, so its lengths are in droplet diameters (0.8 mm)"
        self.assertEqual([one for one in said.splitlines() if ".csv" in one], [line])
        for arguments in ([*lab, "--quiet"], []):
            said = self.succeed("clogsweep", *arguments, "obstacles=plain.csv", "box=6", "--dry-run").stderr
            self.assertNotIn("names no unit", said)

    def test_what_would_be_meant_in_droplet_diameters_is_refused(self):
        self.write("posts.csv", POSTS)
        lab = self.lab()
        for keys, words in [(["obstacle-gap=0.4"], "obstacle-gap=0.4"), (["obstacle-gap=0.4mm"], "obstacle-diameter=0.3"), (["obstacles=posts.csv", "box=10"], "box=10"),
                            (["obstacle-gap=0.4mm,0.5", *ARRAY[1:3]], "obstacle-gap=0.4mm,0.5"), (["obstacle-gap=lin(0.4,0.5,3)", *ARRAY[1:3]], "obstacle-gap=lin(0.4,0.5,3)"),
                            (["obstacle-layout=lattice", "pitch=0,1.8mm", "obstacle-diameter=0.3mm"], "obstacle-gap=0.2"),
                            (["obstacle-layout=lattice", "pitch=1.2,1.8mm", "obstacle-diameter=0.3mm"], "pitch=1.2,1.8mm"),
                            (ARRAY[:2] + ["obstacle-density=0.4"], "obstacle-density=0.4"), (["obstacles=posts.csv", "box=10mm", "length=10"], "length=10")]:
            with self.subTest(keys):
                self.refuse("clogsweep", "--quiet", "--lab", lab, *keys, "--output", "x.h5", words=[words, "without a unit", "sigma"])
        self.succeed("clogsweep", "--lab", lab, "obstacle-gap=0.4sigma", "obstacle-diameter=0.3sigma", "obstacle-density=saturated", "--dry-run")
        self.succeed("clogsweep", "--lab", lab, "obstacle-layout=lattice", "pitch=lin(1.6mm,1.8mm,2)", "obstacle-diameter=0.3mm", "--print-config")
        self.refuse("clogsweep", "--quiet", "--lab", self.lab("one.cfg", diameter="0.5 mm", angle="20 deg"), "obstacles=posts.csv", "box=10", "--output", "x.h5", words=["box=10"])
        self.refuse("clogsweep", "obstacle-gap=0.4mm", "--output", "x.h5", words=["obstacle-gap=0.4mm", "--lab"])
        self.write("plain.csv", "1,1,0.3\n")
        self.refuse("clogsweep", "--quiet", "--lab", lab, "obstacles=plain.csv", "box=10mm", "--output", "x.h5",
                    words=["plain.csv", "in droplet diameters", "# units"])
        for key in ("box=5mN/m", "line-tension=5mm", "vertices=3mm", "box=5furlong"):
            with self.subTest(key):
                self.refuse("clogsweep", "--quiet", "--lab", lab, key, *ARRAY[:3], "--output", "x.h5",
                            words=[f"invalid {key}"])

    def test_mistakes_in_lists_get_one_line(self):
        for changed, words in [({"speed": "1 mm/s, 2 mm/s"}, ["2 values of speed for 4 sets"]), ({"tension": "1 mN/m, 2 mN/m"}, ["tension=1 mN/m, 2 mN/m", "one value"]),
                               ({"diameter": "0.8, 1.6 mm"}, ["'0.8' has no unit"]), ({"speed_angle": "120 deg"}, ["speed-angle=120 deg", "beyond 90"]),
                               ({"speed": "", "speed_angle": "20 deg"}, ["has no speed"]), ({"speed": "1 mm/s, 2 mm/s, 3 mm/s, 4 mm/s", "speed_exponent": "1"}, ["leave them out"]),
                               ({"speed_exponent": "-1"}, ["speed-exponent=-1"]), ({"diameter": "0.8 mm,"}, ["diameter="])]:
            with self.subTest(changed):
                self.refuse("clogfit", "units", self.lab(**changed), words=["lab.cfg", *words])
        self.lab()
        self.refuse("clogrun", "array", "--lab", "lab.cfg", "--output", "r.h5", words=["lab.cfg describes 4 droplets"])
        self.refuse("clogfit", "units", "lab.cfg", "--length", "2", words=["--length", "4 droplets"])
        done = subprocess.run([sys.executable, "-m", "clogsweep", "refine", "terminal-speed", "terminal-speed=0.02,0.06", "--lab", "lab.cfg", *ARRAY, "--until", "curve=90%", "--output", "r.h5"],
                              cwd=self.folder, capture_output=True, text=True, env={**os.environ, "PYTHONPATH": str(ROOT / "analysis"), "PATH": str(BIN)})
        self.assertEqual(done.returncode, 2)
        self.assertIn("--lab several droplets", done.stderr)
        self.sweep()
        self.refuse("clogfit", "s.h5", "--lab", "lab.cfg", words=["lab.cfg describes 4 droplets", "omit --lab"])
        for words in (["compare", "s.h5", "--by", "diameter"], ["compare", "s.h5", "--by", "angle"]):
            self.refuse("clogfit", *words,
                        words=["no parameter of a run", "clogfit lists the lengths in mm of each droplet"])
        self.refuse("clogfit", "compare", "s.h5", "--by", "line-tension", words=["varies nothing", "clogsweep select"])
        self.refuse("clogsweep", "select", "s.h5", "diameter=0.8", "--output", "x.h5",
                    words=["no column 'diameter'", "laboratory"])
        self.refuse("clogsweep", "--quiet", "--lab", self.lab(diameter="0.8 mm, 0.8 mm"), *ARRAY, "--output", "x.h5",
                    words=["mean the same run"])

    def test_such_a_sweep_resumes_and_grows_and_is_one_of_its_config(self):
        self.sweep()
        before = table(self.folder / "s.h5")
        self.assertIn("nothing left to do", self.sweep().stderr)
        config = self.write("printed.cfg", self.sweep("--print-config", *ARRAY).stdout)
        self.assertIn("nothing left to do", self.succeed("clogsweep", "--config", config, "--output", "s.h5").stderr)
        self.sweep(*ARRAY, diameter="0.8 mm, 1.6 mm, 2 mm", speed_diameter="0.8 mm")
        rows = table(self.folder / "s.h5")
        self.assertEqual((len(rows), rows.laboratory.nunique()), (12, 6))
        self.assertEqual(set(before.laboratory) - set(rows.laboratory), set())

    def test_a_laboratory_in_other_words_runs_nothing_again(self):
        self.sweep()
        before = table(self.folder / "s.h5")
        for changed in ({"angle": "20.0 deg, 45deg"}, {"diameter": "800 um, 0.16 cm"}, {"speed": "0.1 cm/s"}):
            self.assertIn("nothing left to do", self.sweep(**changed).stderr, changed)
        pandas.testing.assert_frame_equal(table(self.folder / "s.h5"), before)
        self.refuse("clogsweep", "--quiet", "--lab", self.lab(diameter="0.8 mm, 800 um"), *ARRAY, "--output", "x.h5",
                    words=["mean the same run"])

    def test_runs_of_a_laboratory_that_says_more_are_adopted(self):
        self.sweep()
        before = table(self.folder / "s.h5")
        self.assertIn("nothing left to do", self.sweep(thickness="0.3 mm").stderr)
        rows = table(self.folder / "s.h5")
        self.assertTrue((rows.laboratory != before.laboratory).all())
        same = [name for name in rows if name != "laboratory"]
        pandas.testing.assert_frame_equal(rows[same], before[same])
        self.assertEqual(len(self.fit("s.h5")["groups"]), len(SETS))

    def test_laboratories_with_the_same_runs_share_them(self):
        # The laboratories differ in the tilt, but with these keys runs do not depend on the tilt.
        keys = ["line-tension=0.5", "terminal-speed=0.03", "obstacle-gap=0.4sigma", "vertices=64", "box=20sigma", "max-time=40", "seeds=1..2"]
        self.sweep(*keys, diameter="0.8 mm", angle="20 deg")
        before = table(self.folder / "s.h5")
        self.sweep(*keys, diameter="0.8 mm", angle="20 deg, 45 deg")
        rows = table(self.folder / "s.h5")
        self.assertEqual((len(rows), rows.laboratory.nunique(), rows.wall_seconds.sum()),
                         (4, 2, before.wall_seconds.sum()))
        self.assertEqual(set(rows.distance), set(before.distance))
        self.assertEqual({group["angle_degrees"] for group in self.fit("s.h5")["groups"]}, {20, 45})

    def test_runs_that_laboratories_share_are_computed_once_in_a_new_sweep(self):
        keys = ["line-tension=0.5", "terminal-speed=0.03", "obstacle-gap=0.4sigma", "vertices=64", "box=20sigma", "max-time=40"]

        def sweep(*options, output, ranks=None):
            printed = self.sweep(*keys, *options, output=output, diameter="0.8 mm", angle="20 deg, 45 deg",
                                 ranks=ranks).stderr
            rows = table(self.folder / output)
            per_seed = rows.groupby("seed")
            self.assertTrue((per_seed.laboratory.nunique() == 2).all())
            self.assertTrue((per_seed[["distance", "time"]].nunique() == 1).all(axis=None), "one computation")
            costs = per_seed.wall_seconds
            self.assertTrue(((costs.min() == 0) & (costs.max() > 0)).all(), "a copy costs nothing")
            return printed, rows

        printed = self.sweep(*keys, "seeds=1..3", "--dry-run", diameter="0.8 mm", angle="20 deg, 45 deg").stdout
        self.assertIn("# 3 tasks are the same runs in another laboratory, which are computed once", printed)
        printed, rows = sweep("seeds=1..3", output="new.h5", ranks=3)
        self.assertIn("3 runs on 3 computing ranks", printed)
        self.assertIn("3 more runs are the same in another laboratory and get these results", printed)
        self.assertEqual(len(rows), 6)
        self.assertIn("there is nothing left to do", sweep("seeds=1..3", output="new.h5")[0])
        self.assertIn("new.h5 has all 3 runs", self.sweep(*keys, "seeds=1..3", "--dry-run", output="new.h5", diameter="0.8 mm",
                                                          angle="20 deg, 45 deg").stdout)
        for part in (1, 2):
            sweep("seeds=1..3", "--shard", f"{part}/2", output=f"part{part}.h5")
        self.succeed("clogsweep", "merge", "part1.h5", "part2.h5", "--output", "all.h5")
        self.assertEqual(len(table(self.folder / "all.h5")), 6)
        _, rows = sweep("seeds=1..2", "--until-precision", "1%", "--most-seeds", "5", output="rounds.h5")
        self.assertEqual(len(rows), 10)

    def test_runs_that_laboratories_share_are_unfinished_in_each_of_them(self):
        keys = ["line-tension=0.5", "terminal-speed=0.03", "obstacle-gap=0.4sigma", "vertices=64", "box=20sigma", "max-time=4e5", "seeds=1..3"]
        options = {"diameter": "0.8 mm", "angle": "20 deg, 45 deg"}
        done = self.run_program("clogsweep", "--lab", self.lab(**options), *keys, "--max-hours", "0.0005", "--output", "s.h5")
        self.assertEqual(done.returncode, 75, done.stderr)
        rows = table(self.folder / "s.h5")
        one, other = (rows[rows.laboratory == laboratory].sort_values("seed")[["seed", "status", "distance"]].to_numpy().tolist() for laboratory in sorted(set(rows.laboratory)))
        self.assertEqual(one, other)
        self.assertIn("interrupted", set(rows.status))
        for group in self.fit("s.h5")["groups"]:
            self.assertGreater(group["interrupted"], 0)
            self.assertIn("i", [doubt[0] for doubt in group["doubts"].split()])

    def test_a_pitch_and_the_same_gap_are_one_parameter_set(self):
        keys = ["obstacle-layout=lattice", "obstacle-diameter=0.3", "vertices=64", "max-time=20", "box=6"]
        self.succeed("clogsweep", "pitch=1.2", *keys, "seeds=1..2", "--output", "p.h5")
        by_pitch = table(self.folder / "p.h5")
        self.assertNotEqual(by_pitch.obstacle_gap[0], 0.9, "the case is tested")
        self.succeed("clogsweep", "obstacle-gap=0.9", *keys, "seeds=3", "--output", "g.h5")
        self.succeed("clogsweep", "merge", "p.h5", "g.h5", "--output", "all.h5")
        self.assertEqual([group["runs"] for group in self.fit("all.h5")["groups"]], [3])
        self.assertIn("nothing left to do",
                      self.succeed("clogsweep", "obstacle-gap=0.9", *keys, "seeds=1..2", "--output", "p.h5").stderr)
        pandas.testing.assert_frame_equal(table(self.folder / "p.h5"), by_pitch)

    def test_points_and_shards_and_more_seeds_meet_droplets(self):
        self.write("points.csv", "obstacle-gap,max-time\n0.4mm,40\n0.5mm,\n")
        keys = [word for word in ARRAY if not word.startswith(("obstacle-gap", "max-time"))]
        for part in (1, 2):
            self.sweep("--points", "points.csv", "--shard", f"{part}/2", "max-time=20", *keys, output=f"{part}.h5")
        self.succeed("clogsweep", "merge", "1.h5", "2.h5", "--output", "all.h5")
        rows = table(self.folder / "all.h5")
        self.assertEqual(len(rows), 4 * 2 * 2)
        self.assertEqual(sorted(set(rows.obstacle_gap.round(9))), [0.25, 0.3125, 0.5, 0.625])
        self.assertEqual(set(rows.max_time[rows.obstacle_gap.isin([0.25, 0.5])]), {40})
        self.assertEqual(set(rows.max_time[rows.obstacle_gap.isin([0.3125, 0.625])]), {20})
        self.sweep(*ARRAY, "--until-precision", "50%", "--most-seeds", "3", output="more.h5")
        self.assertEqual(len(table(self.folder / "more.h5")), 4 * 3)

    def test_rows_of_one_droplet_can_be_selected_and_exported(self):
        self.sweep()
        groups = self.fit("s.h5")["groups"]
        for group in groups:
            self.assertIn((group["diameter_mm"], group["angle_degrees"]), SETS)
            self.assertAlmostEqual(group["clogging_length_lower_mm"],
                                   group["diameter_mm"] * group["clogging_length_lower"])
        self.succeed("clogsweep", "select", "s.h5", f"laboratory={groups[0]['laboratory']}", "--output", "one.h5")
        one, = self.fit("one.h5")["groups"]
        self.assertEqual((one["diameter_mm"], one["angle_degrees"]),
                         (groups[0]["diameter_mm"], groups[0]["angle_degrees"]))
        self.assertIn("diameter_mm,angle_degrees,", self.succeed("clogfit", "s.h5", "--format", "csv").stdout)
        heading, *lines = [line.split() for line in self.succeed("clogfit", "s.h5").stdout.split("\n\n")[1].splitlines()]
        self.assertEqual(heading[:3], ["diameter/mm", "angle/degrees", "lambda/mm"])
        self.assertEqual(heading[-3:], ["line_tension", "terminal_speed", "note"])
        self.assertNotIn("tension/(mN/m)", heading)  # The tension is 2 for all droplets.
        self.assertEqual({tuple(map(float, line[:2])) for line in lines}, set(SETS))
        summary = clogsweep.open(self.folder / "s.h5", BIN).fit().summary
        self.assertEqual({"diameter_mm", "angle_degrees"} & set(summary.columns), {"diameter_mm", "angle_degrees"})

    def test_measured_distances_are_compared_in_millimetres_with_the_same_droplet(self):
        self.sweep()
        for diameter, angle, factor in [("diameter [mm]", "angle", 1), ("diameter (mm)", "angle [deg]", 1), ("Diameter_um", "angle (degrees)", 1000)]:
            self.write("own.csv", f"distance [mm],clogged,{diameter},{angle}\n3,1,{1.6 * factor},20\n5,1,{1.6 * factor},20\n4,0,{0.8 * factor},45\n")
            found = json.loads(self.succeed("clogfit", "compare", "own.csv", "s.h5", "--format", "json").stdout)
            self.assertEqual({(one["diameter"], one["angle"]) for one in found["comparisons"]}, {(1.6, 20.0), (0.8, 45.0)})
            # Parameters that follow from the droplet are no columns.
            self.assertFalse({"laboratory", "line_tension", "obstacle_gap"} & set(found["comparisons"][0]))
        # In these two sweeps each size has another friction, but the user chose the friction, so it is a column.
        for size, friction in [("0.8 mm", "0"), ("1.6 mm", "0.3")]:
            self.sweep(*ARRAY, "preset=elastic", f"friction={friction}", output=f"{friction}.h5", diameter=size,
                       angle="20 deg")
        self.succeed("clogsweep", "merge", "0.h5", "0.3.h5", "--output", "merged.h5")
        self.write("own.csv", "distance [mm],clogged,diameter [mm]\n3,1,0.8\n4,1,1.6\n")
        found = json.loads(self.succeed("clogfit", "compare", "own.csv", "merged.h5", "--format", "json").stdout)
        self.assertEqual({(one["diameter"], one["friction"]) for one in found["comparisons"]}, {(0.8, 0), (1.6, 0.3)})
        self.lab()
        self.succeed("clogsweep", "select", "s.h5", f"laboratory={table(self.folder / 's.h5').laboratory[0]}",
                     "--output", "one.h5")
        self.refuse("clogfit", "compare", self.write("large.csv", "distance [mm],clogged,diameter [mm]\n3,1,1.6\n"),
                    "one.h5", words=["no group"])
        self.write("sigma.csv", "distance [sigma],clogged\n3,1\n")
        self.refuse("clogfit", "compare", "sigma.csv", "s.h5",
                    words=["several droplets", "distances in mm, and a column diameter [mm]"])
        self.refuse("clogfit", "compare", "sigma.csv", "s.h5", "--lab", "lab.cfg",
                    words=["omit --lab: the sweep stores its laboratories"])

    def test_sweeps_are_compared_in_millimetres_with_the_same_droplet(self):
        self.sweep(*ARRAY, "preset=elastic", "friction=0,0.3", output="f.h5")
        printed = json.loads(self.succeed("clogfit", "compare", "f.h5", "--by", "friction", "--format", "json").stdout)
        self.assertEqual((printed["columns"], printed["differing"]), (["diameter", "angle"], ["friction"]))
        lengths_in_mm = {(one["diameter_mm"], one["angle_degrees"], one["friction"]): one["clogging_length_lower_mm"]
                         for one in self.fit("f.h5")["groups"]}
        self.assertEqual(len(printed["comparisons"]), len(SETS))
        for one in printed["comparisons"]:
            for side, friction in [("here", 0.3), ("there", 0)]:
                self.assertAlmostEqual(one[f"clogging_length_{side}_lower_mm"], lengths_in_mm[one["diameter"], one["angle"], friction])
        figure = style.figure_of(ratios.draw_on, {**printed, "comparisons": [one | {"ratio": 1, "ratio_lower": 0.5, "ratio_upper": 2} for one in printed["comparisons"]]})
        self.assertEqual(figure.axes[0].get_xlabel(), "diameter of the droplet [mm]")
        self.assertEqual({text.get_text() for text in figure.axes[0].get_legend().get_texts()},
                         {"tilt 20°", "tilt 45°"})
        # Droplets of the same size and tilt may differ in their tension.
        self.sweep()
        self.sweep(*ARRAY, output="softer.h5", tension="1 mN/m")
        printed = json.loads(self.succeed("clogfit", "compare", "s.h5", "softer.h5", "--format", "json").stdout)
        self.assertEqual((printed["columns"], len(printed["comparisons"])), (["diameter", "angle"], len(SETS)))

    def test_figures_show_millimetres_over_the_diameter_and_a_curve_for_each_tilt(self):
        self.sweep()
        groups = clogsweep.open(self.folder / "s.h5", BIN).fit().known
        self.assertEqual([label for label, _ in groups.curves()], ["tilt 20°", "tilt 45°"])
        self.assertEqual(groups.axis_label(), "diameter of the droplet [mm]")
        self.assertEqual(groups.values("obstacle_gap"), {0.4})
        self.assertEqual(groups.values("obstacle_density"), {0.8})
        self.assertRegex(groups.caption(), r"gap \$0.4.*mm.*density \$0.8/.*mm.*\^2\$")
        axes = style.figure_of(lengths.draw_on, groups).axes[0]
        self.assertEqual(axes.get_ylabel(), r"$\lambda$ [mm]")
        bound = max(group["clogging_length_lower_mm"] for group in groups.members if group["clogs"] == 0)
        drawn = np.concatenate([np.asarray(line.get_ydata(), dtype=float) for line in axes.lines if line.get_marker() is style.LOWER_BOUND])
        self.assertAlmostEqual(np.nanmax(drawn), bound)

    def test_a_curve_runs_over_the_diameter_in_millimetres(self):
        keys = ["obstacle-gap=0.24mm", "obstacle-diameter=0.24mm", "obstacle-density=1.6/mm^2", "vertices=64", "box=12", "max-time=400", "seeds=1..4"]
        self.sweep(*keys, diameter="0.8 mm, 1 mm, 1.2 mm, 1.6 mm", angle="20 deg")
        found = json.loads(self.succeed("clogfit", "curve", "s.h5", "--format", "json").stdout)
        self.assertEqual((found["keys"], found["units"]["clogging_length"]), (["diameter_mm"], "mm"))
        groups = {group["diameter_mm"]: group for group in self.fit("s.h5")["groups"]}
        for point in found["curves"][0]["points"]:
            self.assertAlmostEqual(point["total_distance"], point["diameter_mm"] * groups[point["diameter_mm"]]["total_distance"])
        self.assertEqual(json.loads(self.succeed("clogfit", "curve", "s.h5", "--key", "diameter", "--format", "json").stdout)["keys"], found["keys"])
        # The lab file has the same droplets in other words, so the curve and its points stay the same.
        self.assertIn("nothing left to do",
                      self.sweep(*keys, diameter="800 um, 1.0 mm, 1200 um, 0.16 cm", angle="20.0 deg").stderr)
        again = json.loads(self.succeed("clogfit", "curve", "s.h5", "--key", "diameter", "--format", "json").stdout)
        for name in ("diameter_mm", "total_distance", "clogging_length"):
            np.testing.assert_allclose(*([point[name] or np.nan for point in one["curves"][0]["points"]] for one in (again, found)), rtol=1e-9)

        text = self.succeed("clogfit", "curve", "s.h5", "--crossing", "3").stdout
        for pattern in (r"highest at diameter_mm .* mm\n", r"cross(es)? 3 mm", "lambda/mm"):
            self.assertRegex(text, pattern)
        self.assertNotIn("sigma", text)

    def test_a_lattice_keeps_its_pitch_in_millimetres(self):
        keys = ["obstacle-layout=lattice", "lattice-angle=15", "obstacle-diameter=0.3mm", "vertices=64", "max-time=20", "seeds=1"]
        self.sweep("pitch=1.8mm", *keys, diameter="0.8 mm, 1 mm, 1.2 mm", angle="20 deg")
        spacing = [group["pitch"] * group["diameter_mm"] for group in self.fit("s.h5")["groups"]]
        np.testing.assert_allclose(spacing, 1.8, rtol=1e-9)
        for key in ([], ["--key", "diameter"]):
            self.refuse("clogfit", "curve", "s.h5", *key, words=["only 3 values of diameter", "a curve needs 4"])
        for key in (["pitch=1.8"], ["pitch=0"]):
            self.refuse("clogsweep", "--quiet", "--lab", "lab.cfg", *keys, *key, "--output", "x.h5",
                        words=["without a unit"])

    def test_a_comment_of_the_laboratory_may_have_any_character(self):
        plain = self.droplets()
        lines = [f"{key} = {text}" for key, text in LAB.items()]
        lab = self.write("lab.cfg",
                         "; ".join(lines[:2]) + "   # terminal; measured = with ; this\n" + "\n".join(lines[2:]) + "\n")
        self.assertEqual(json.loads(self.succeed("clogfit", "units", lab, "--format", "json").stdout), plain)
        self.refuse("clogfit", "units", self.write("lab.cfg", "diameter = 1 mm; angle = 20 deg # a; b\nspeed\n"),
                    words=["line 2: 'speed' is not"])

    def test_a_lattice_is_drawn_over_the_diameter_with_the_tangent_of_its_rows(self):
        lattice = ["obstacle-layout=lattice", *ARRAY[:2], "vertices=64", "box=15", "max-time=40", "seeds=1"]
        # Lattices for the two droplets fit this box at 14.93 and at 15.07 degrees.
        for name, angles, tangents in [("tilted", "15", [2 - math.sqrt(3)]),
                                       ("both", "lin(0,15,2)", [2 - math.sqrt(3)]), ("straight", "0", [])]:
            with self.subTest(name):
                self.sweep(*lattice, f"lattice-angle={angles}", output=f"{name}.h5", angle="20 deg")
                figure = poster.draw(self.folder / f"{name}.h5", BIN)
                axes = next(axes for axes in figure.axes if axes.get_ylabel() == "lateral displacement per distance")
                dashed = [line.get_ydata()[0] for line in axes.lines if line.get_linestyle() == "--"]
                np.testing.assert_allclose(dashed, tangents)
                legend = axes.get_legend()
                self.assertEqual([] if legend is None else [text.get_text() for text in legend.get_texts()],
                                 ["lattice angle 0°", "lattice angle 15°"] if name == "both" else [])
                texts = [text.get_text() for text in figure.findobj(Text)]
                self.assertEqual(any("lattice angle 15°" in text for text in texts), bool(tangents))
                self.assertIn("Lateral displacement vs diameter", texts)
                self.assertEqual(any("dashed: along the rows" in text for text in texts), bool(tangents))

    def test_each_size_of_a_device_can_be_drawn(self):
        self.write("posts.csv", POSTS)
        self.sweep("obstacles=posts.csv", "box=10.2mm", "release=anywhere", "vertices=64", "max-time=5", "seeds=1")
        together = clogsweep.Sweep(self.folder / "s.h5", BIN).device(ways=0, map=0).figure
        self.assertIn(" x 10.2 mm", together.texts[0].get_text())
        parts = self.picture_of("s.h5")
        self.assertEqual(len(parts), len(SETS))
        for part in device.in_one_unit(parts):
            self.assertAlmostEqual(part.place.width, 10.2)
            self.assertEqual(part.place.unit, "mm")

    def test_one_of_several_devices_can_be_drawn(self):
        self.write("posts.csv", POSTS)
        self.write("other.csv", POSTS + "5,6,0.2\n")
        self.sweep("obstacles=posts.csv,other.csv", "box=10.2mm", "release=anywhere", "vertices=64", "max-time=5",
                   "seeds=1", diameter="1 mm", angle="20 deg")
        with self.assertRaisesRegex(clogsweep.UserError,
                                    "cannot draw 2 devices as one; clogsweep select .*s.h5 obstacles=SUM ") as refused:
            self.picture_of("s.h5")
        check_sum = re.findall("[0-9a-f]{16}", str(refused.exception))[-1]
        self.succeed("clogsweep", "select", "s.h5", f"obstacles={check_sum}", "--output", "one.h5")
        self.assertEqual(len(self.picture_of("one.h5")), 1)

    def picture_of(self, name):
        path = self.folder / name
        return device.the_picture(device.places(path, BIN), clogsweep.Sweep(path, BIN).fit().known, path)

    def test_critical_angles_are_named_by_the_droplets(self):
        self.sweep("obstacle-layout=lattice", "pitch=2.4mm", "obstacle-diameter=0.8mm", "lattice-angle=15,25",
                   "line-tension=1,3", "vertices=64", "max-time=1", "seeds=1", angle="20 deg")
        command = [sys.executable, "-m", "clogsweep", "critical-angle", "s.h5"]
        around = {"cwd": self.folder, "capture_output": True, "text": True, "env": {**os.environ, "PYTHONPATH": str(ROOT / "analysis"), "PATH": str(BIN)}}
        done = subprocess.run([*command, "--format", "csv"], **around)
        self.assertEqual(done.stdout,
                         "diameter_mm,line_tension,lower,upper,runs\n0.8,1,,,0\n0.8,3,,,0\n1.6,1,,,0\n1.6,3,,,0\n",
                         done.stderr)
        empty = subprocess.run(command, **around)
        self.assertEqual((empty.returncode, empty.stderr), (2, "python3 -m clogsweep critical-angle: cannot draw critical angles (the paths within max-time=1 are too short: "
                                                               "straight on, they would cross fewer than two rows) try a larger max-time or lattice-angle\n"))
        columns = json.loads(self.succeed("clogsweep", "--schema").stdout)["columns"]
        found = pandas.DataFrame({"diameter_mm": [0.8, 0.8, 1.6, 1.6], "line_tension": [1, 3, 1, 3], "lower": 20.0, "upper": 21.0, "runs": 2})
        found.loc[3, ["lower", "upper"]] = np.nan
        figure = style.figure_of(critical_angles.draw_on, found,
                                 fits.droplet_columns() | {column["name"]: column for column in columns})
        self.assertEqual([text.get_text() for text in figure.axes[0].get_legend().get_texts()],
                         ["diameter 0.8 mm", "diameter 1.6 mm"])
        self.assertTrue(figure.axes[0].get_xlabel().startswith(r"line tension $\Gamma"))
        self.assertTrue(figure.axes[0].texts[0].get_text().endswith("\n1 of 4 points: the paths are too short"))

    def test_a_report_shows_each_droplet(self):
        self.write("posts.csv", POSTS)
        self.sweep("obstacles=posts.csv", "box=10.2mm", "release=anywhere", "vertices=64", "max-time=20", "seeds=1..3")
        self.succeed("clogfit", "report", "s.h5", "--output", "r.html")
        page = (self.folder / "r.html").read_text()
        self.assertIn("diameter mm", page)
        self.assertIn("1 to 3", page)


class Mixtures(LaboratoryTest):
    """Tests clogfit --mixture. The tests write the outcomes of runs into the rows."""

    SHARES = {0.8: 0.3, 1.6: 0.7}
    MIXTURE = ["--mixture", "diameter=0.8mm:3,1600 um:7"]
    TENSIONS = ["--mixture", "line-tension=0.5:1,1:3"]
    FAR = ["max-time=1", "terminal-speed=100"]  # droplets can travel a hundred diameters
    CLOG = {"status": b"clogged", "clogged_by": b"certified", "mechanism": b"squeezed"}

    def module(self, *arguments):
        path = f"{BIN}:{os.environ['PATH']}"
        done = subprocess.run([sys.executable, "-m", "clogsweep", *arguments], cwd=self.folder, capture_output=True,
                              text=True, env={**os.environ, "PYTHONPATH": str(ROOT / "analysis"), "PATH": path})
        self.assertEqual(done.returncode, 0, done.stderr)

    def rows(self, output, seeds, diameter, outcomes):
        """A sweep with these outcomes. @param outcomes  status and distance [mm] by diameter and seed"""
        self.sweep("--quiet", *ARRAY[:-2], *self.FAR, f"seeds={seeds}", output=output, angle="20 deg",
                   diameter=diameter)
        texts = self.fit(output)["laboratories"]

        def edit(rows):
            for row in range(len(rows)):
                size = float(texts[rows["laboratory"][row].decode()].split("diameter = ")[1].split(" mm")[0])
                status, way = outcomes(size, int(rows["seed"][row]))
                others = {"status": status, "clogged_by": b"none", "mechanism": b"none"}
                results = self.CLOG if status == b"clogged" else others
                for name, value in {**results, "distance": way / size, "sound_distance": np.nan}.items():
                    rows[name][row] = value
            failed = rows["status"] == b"failed"
            stored_rows.fail(rows, failed, rows["distance"][failed] + 1, rows["distance"][failed])

        stored_rows.change(self.folder / output, edit)

    @staticmethod
    def outcomes(diameter, seed):
        """Divided by the mean distances of their sizes, the distances of all droplets of a seed are nearly equal."""
        common, own = np.random.default_rng(seed).exponential(), np.random.default_rng([seed, int(10 * diameter)]).random()
        way = {0.8: 4, 1.6: 9}[diameter] * (common + 0.1 * own)
        if seed in (3, 55):
            return b"failed", way
        if seed in (5, 11):
            return b"interrupted", way
        return (b"clogged", way) if way < 15 else (b"flowing", 15 + way / 100)

    def observed(self, *files):
        """The runs of all files, from exported rows."""
        tables = []
        for name in files:
            if not (self.folder / f"{name}.csv").exists():
                self.module("export", name, f"{name}.csv")
            table = pandas.read_csv(self.folder / f"{name}.csv")
            tables.append(table.rename(columns=lambda head: head.split(" ")[0]))
        rows = pandas.concat(tables)
        way = np.where(rows.status == "failed", rows.sound_distance, rows.distance) * rows.diameter_mm
        return pandas.DataFrame({"size": rows.diameter_mm.round(6), "seed": rows.seed, "way": way,
                                 "clogged": rows.status == "clogged"})

    @staticmethod
    def in_order(runs):
        """By distance. Clogs count before runs that ended at the same distance."""
        return runs.sort_values(["way", "clogged"], ascending=[True, False])

    def estimates(self, runs, times, places):
        """Length and P(r) of resamples. @param times  by seed: for each resample, the number of times that the seed
        counts"""
        way = clogs = probability = 0
        for size, share in self.SHARES.items():
            own = self.in_order(runs[runs["size"] == size])
            clogged = own.clogged.to_numpy().astype(float)
            counts = np.stack([times[seed] for seed in own.seed], axis=-1)
            num = counts.sum(axis=-1)
            way = way + share * (counts @ own.way.to_numpy()) / num
            clogs = clogs + share * (counts @ clogged) / num
            at_risk = np.cumsum(counts[:, ::-1], axis=-1)[:, ::-1]
            steps = np.cumprod(1 - counts * clogged / np.maximum(at_risk, 1), axis=-1)
            steps = np.concatenate([np.ones((len(counts), 1)), steps], axis=-1)
            passed = np.searchsorted(own.way.to_numpy(), places * (1 + 1e-12), side="right")
            probability = probability + share * steps[:, passed]
        return way / clogs, probability

    def resampled(self, runs, places):
        """Length and P(r) of 8000 resamples of seeds."""
        strata = {}
        for seed, own in runs.groupby("seed"):
            strata.setdefault(tuple(sorted(own["size"])), []).append(seed)
        times, chance = {}, np.random.default_rng(1)
        for seeds in strata.values():
            counts = chance.multinomial(len(seeds), [1 / len(seeds)] * len(seeds), size=8000)
            times |= dict(zip(seeds, counts.T))
        return self.estimates(runs, times, places)

    def check(self, *files):
        """Compares clogfit's mixture with numpy. @return the mixture"""
        printed = self.fit(*files, *self.MIXTURE)["mixture"]
        runs = self.observed(*files)
        self.assertEqual((printed["column"], printed["unit"]), ("diameter", "mm"))
        self.assertEqual(list(printed["weights"]), ["0.8 mm", "1.6 mm"])
        np.testing.assert_allclose(list(printed["weights"].values()), [0.3, 0.7])
        last = [self.in_order(own).iloc[-1] for _, own in runs.groupby("size")]
        end = min((one.way for one in last if not one.clogged), default=np.inf) * (1 + 1e-12)
        known = runs[runs.way <= end]
        places = np.array([step["distance"] for step in printed["survival"]])
        np.testing.assert_allclose(places, np.unique(known.way[known.clogged]), rtol=1e-12)
        np.testing.assert_allclose(printed["censored_distances"], np.sort(known.way[~known.clogged]), rtol=1e-12)
        length, probability = self.estimates(runs, {seed: np.array([1]) for seed in runs.seed}, places)
        self.assertAlmostEqual(printed["clogging_length"] / length[0], 1, places=12)
        np.testing.assert_allclose([step["probability"] for step in printed["survival"]], probability[0], rtol=1e-12)
        # Each limit of 2000 resamples has a standard error of 0.06 standard deviations.
        lengths, probabilities = self.resampled(runs, places)
        np.testing.assert_allclose([printed["clogging_length_lower"], printed["clogging_length_upper"]],
                                   np.percentile(lengths, [2.5, 97.5]), rtol=0, atol=0.25 * lengths.std())
        for name, percentile in (("lower", 2.5), ("upper", 97.5)):
            limits = np.array([step[name] for step in printed["survival"]])
            difference = np.abs(limits - np.percentile(probabilities, percentile, axis=0))
            # The steps of P(r) are 0.3 and 0.7 of a fortieth.
            self.assertLess(np.max(difference - 0.25 * probabilities.std(axis=0)), 0.7 / 40)
        return printed

    def test_a_mixture_has_the_length_the_curve_and_the_intervals_of_numpy(self):
        self.rows("both.h5", "1..40", "0.8 mm, 1.6 mm", self.outcomes)
        shared = self.check("both.h5")
        # Runs of the same seed have nearly equal relative distances, which makes the interval wide. If the two groups
        # have different seeds, they scatter independently, and the interval is narrower.
        self.rows("small.h5", "1..40", "0.8 mm", self.outcomes)
        self.rows("large.h5", "101..140", "1.6 mm", lambda diameter, seed: self.outcomes(diameter, seed - 100))
        disjoint = self.check("small.h5", "large.h5")
        self.assertAlmostEqual(disjoint["clogging_length"], shared["clogging_length"])
        wide, narrow = (printed["clogging_length_upper"] - printed["clogging_length_lower"] for printed in (shared, disjoint))
        self.assertGreater(wide, 1.15 * narrow)
        # The two files have ten seeds in common.
        self.rows("later.h5", "31..70", "1.6 mm", self.outcomes)
        self.check("small.h5", "later.h5")

        text = self.succeed("clogfit", "both.h5", *self.MIXTURE).stdout
        self.assertRegex(text, r"\n\nmixture of diameter 0\.8 mm \(30 %\), 1\.6 mm \(70 %\): "
                               r"lambda = [0-9.]+ \([0-9.]+ \.\. [0-9.]+\) mm, 95 %\n$")
        half = self.fit("both.h5", *self.MIXTURE, "--confidence", "0.5")["mixture"]
        self.assertLess(half["clogging_length_upper"] - half["clogging_length_lower"], wide / 2)
        # A share of 1 gives the results of the group itself.
        pure = self.fit("both.h5", "--mixture", "diameter=0.8mm:1,1.6mm:0")
        group = next(group for group in pure["groups"] if group["diameter_mm"] == 0.8)
        self.assertAlmostEqual(pure["mixture"]["clogging_length"], group["clogging_length_mm"], places=12)
        np.testing.assert_allclose([step["probability"] for step in pure["mixture"]["survival"]],
                                   [step["probability"] for step in group["survival"]], rtol=1e-12)

        self.module("survival", "both.h5", *self.MIXTURE)
        self.assertTrue((self.folder / "both-survival.png").exists())
        curves = survival_curve.of_groups(clogsweep.open(self.folder / "both.h5", BIN).fit().known)
        mixture = survival_curve.of_mixture({"mixture": shared}, "mm")
        axes, = style.figure_of(survival_curve.draw_on, curves, "mm", mixture).axes
        drawn = {line.get_label(): line for line in axes.lines}
        self.assertLess({"diameter 0.8 mm", "diameter 1.6 mm"}, set(drawn))
        way, probability = drawn["mixture of diameter 0.8 mm (30 %), 1.6 mm (70 %)"].get_data()
        np.testing.assert_allclose(probability[1:-1], [step["probability"] for step in shared["survival"]])
        self.assertEqual(way[-1], max(shared["censored_distances"]))

    def test_parameters_can_be_mixed_too(self):
        path = self.copy_sweep("s.h5", *SMALL, *self.FAR, "line-tension=0.5,1", "seeds=1..8")
        stored_rows.change_columns(path, distance=np.arange(1.0, 17), status=b"flowing")
        self.assertIn("mixture of line_tension 0.5 (25 %), 1 (75 %): lambda is unknown, because no droplet clogged\n",
                      self.succeed("clogfit", "s.h5", *self.TENSIONS).stdout)
        rows = table(path)
        others = {"status": b"flowing", "clogged_by": b"none", "mechanism": b"none"}
        stored_rows.change_columns(path, **{name: np.where(rows.seed <= 2, word, others[name]) for name, word in self.CLOG.items()})
        printed = self.fit("s.h5", *self.TENSIONS)["mixture"]
        ways = [rows.distance[rows.line_tension == tension].mean() for tension in (0.5, 1)]
        self.assertEqual((printed["column"], printed["unit"]), ("line_tension", "sigma"))
        self.assertEqual(printed["weights"], {"0.5": 0.25, "1": 0.75})
        self.assertAlmostEqual(printed["clogging_length"], (ways[0] + 3 * ways[1]) / 4 / 0.25)
        # A tenth of the resamples has no clog.
        self.assertIsNone(printed["clogging_length_upper"])
        self.assertIn(" (above ", self.succeed("clogfit", "s.h5", *self.TENSIONS).stdout)
        one = self.copy_sweep("one.h5", *SMALL, *self.FAR, "line-tension=0.5,1", "seeds=1")
        stored_rows.change_columns(one, distance=[1, 2], **self.CLOG)
        self.assertIn("lambda = 1.75 sigma, without an interval\n",
                      self.succeed("clogfit", "one.h5", *self.TENSIONS).stdout)

    def test_what_is_no_mixture_is_refused(self):
        keys = [*ARRAY[:-2], "max-time=1", "seeds=1", "preset=elastic"]
        self.sweep(*keys, "friction=0,0.3", output="walls.h5", angle="20 deg")
        self.sweep(*keys, angle="20 deg")
        self.copy_sweep("own.h5", *SMALL, "line-tension=0.5,1", "seeds=1", "max-time=1")
        refusals = [
            ("s.h5", "diameter=0.8mm:1,1.2mm:1", ["no group has diameter = 1.2 mm", "the groups have 0.8 mm, 1.6 mm"]),
            ("walls.h5", "diameter=0.8mm:1,1.6mm:1", ["2 groups have diameter = 0.8 mm and differ in friction",
                                                      "clogsweep select"]),
            ("s.h5", "diameter=0.8mm:-1,1.6mm:2", ["a weight is negative"]),
            ("s.h5", "diameter=0.8mm:0,1.6mm:0", ["all weights are 0"]),
            ("s.h5", "diameter=0.8mm:1e308,1.6mm:1e308", ["the weights is infinite"]),
            ("s.h5", "diameter=0.8mm:1", ["a single value is no mixture"]),
            ("s.h5", "diameter=0.8mm:1,800um:1", ["0.8 mm occurs twice"]),
            ("s.h5", "diameter=0.8:1,1.6:1", ["the diameter '0.8' has no unit of length", "2.8mm"]),
            ("s.h5", "diameter=0.8mm:x,1.6mm:1", ["'x'", "diameter=2.8mm:0.3,3.2mm:0.7"]),
            ("s.h5", "diameter=0.8mm:nan,1.6mm:1", ["nan"]),
            ("s.h5", "diameter=0.8mm,1.6mm", ["'0.8mm' is not VALUE:WEIGHT"]),
            ("s.h5", "diameter", ["is not VALUE:WEIGHT"]),
            ("s.h5", "diametre=1:1,2:1", ["'diametre' is no parameter of a run"]),
            ("own.h5", "diameter=0.8mm:1,1.6mm:1", ["the runs have no laboratory"])
        ]
        for file, mixture, words in refusals:
            with self.subTest(mixture):
                self.refuse("clogfit", file, "--mixture", mixture, words=["--mixture", *words])
        self.refuse("clogfit", "s.h5", *self.MIXTURE, "--format", "csv", words=["no place for --mixture in CSV"])
        self.succeed("clogsweep", "obstacle-layout=channel", "vertices=64", "max-time=1", "--output", "channel.h5")
        self.refuse("clogfit", "channel.h5", *self.MIXTURE, words=["no place for --mixture (droplets in a channel"])


if __name__ == "__main__":
    unittest.main()
