"""Tests the prediction of clogging lengths from droplets that fall on two obstacles. The result of each case has a
closed form."""

import math
import os
import pathlib
import unittest
from unittest import mock

import numpy as np

from drawing import Analysis
from support import BIN, table

from clogsweep.collisions import collision, prediction
from clogsweep.reading import stored

SLACK = 1e-9


class Geometry(unittest.TestCase):
    def test_pairs_are_found_across_the_borders_and_once(self):
        circles = np.array([[0.1, 0.1, 0.3], [9.6, 4.8, 0.3], [5, 2.5, 0.3], [5, 3.9, 0.6]])
        ways = np.concatenate(list(prediction.pairs_of(circles, width=5, length=10)))
        np.testing.assert_allclose(sorted(map(tuple, np.abs(ways))), [(0, 1.4, 0.45), (0.5, 0.3, 0.3)], atol=SLACK)

    def test_a_pair_of_all_directions_is_as_wide_as_its_mean_projection(self):
        held = [True] * round(90 / prediction.ANGLE_STEP)
        self.assertAlmostEqual(prediction.mean_cosine(held), 2 / math.pi, delta=SLACK)
        self.assertEqual(prediction.mean_cosine([False] * 5), 0)

    def test_a_rigid_disc_rests_on_two_obstacles_up_to_the_angle_at_which_it_stands_over_the_lower(self):
        for gap, diameter in [(0.2, 0.3), (0.7, 0.3), (0.5, 0.9)]:
            angle = math.radians(prediction.largest_angle(gap, diameter))
            apart, reach = gap + diameter, (1 + diameter) / 2
            lower = apart / 2 * np.array([math.cos(angle), -math.sin(angle)])  # y upwards
            above = math.sqrt(reach**2 - (apart / 2)**2)
            disc = above * np.array([math.sin(angle), math.cos(angle)])
            self.assertAlmostEqual(disc[0], lower[0], delta=SLACK)
            self.assertAlmostEqual(math.hypot(*(disc - lower)), reach, delta=SLACK)
        self.assertEqual(prediction.largest_angle(1, 0.3), 90)

    def test_the_width_within_which_one_obstacle_holds_a_droplet_is_found(self):
        droplets = prediction.Droplets(BIN / "clogsweep", pathlib.Path("."), {})
        for edge in (0, 0.0007, 0.0569, 0.3):
            def ends(arrays, tension, edge=edge):
                return {tension: [b"wrapped" if offset <= edge else b"" for (_, offset, _), in arrays]}
            with mock.patch.object(droplets, "ends", ends):
                self.assertAlmostEqual(droplets.half_width(0.3, 0.1), edge,
                                       delta=max(prediction.OFFSET_PRECISION, edge / 36))

    def test_lengths_that_may_be_wrong_are_doubted(self):
        self.assertEqual(prediction.doubts_of(1.09, 25), [])
        self.assertEqual(prediction.doubts_of(0.5, 25), ["soft"])
        self.assertEqual(prediction.doubts_of(0.5, 1), ["soft", "crowded"])


class Predicted(Analysis):
    """Tests predictions for one pair of obstacles with a gap of 0.5, in a box of 20."""

    def pair(self, name, degrees, beside=0.0, fall=3):
        half_x, half_y = (0.4 * part(math.radians(degrees)) for part in (math.sin, math.cos))
        x, y = 10 + fall + half_x, 10 - beside
        self.write(name, f"x,y,diameter\n{x - half_x},{y - half_y},0.3\n{x + half_x},{y + half_y},0.3\n")

    def predict(self, *words):
        done = self.draw("predict", "--programs", BIN, "vertices=64", *words)
        self.said = done.stderr
        head, *lines = done.stdout.splitlines()
        self.assertEqual(head, "line_tension,clogging_length,squeezed,wrapped,doubts")
        return [line.split(",") for line in lines]

    def test_a_droplet_is_stopped_between_the_middles_of_two_obstacles_and_nowhere_else(self):
        edge = 0.4 * math.cos(math.radians(15))
        offsets = {-edge - 0.03: "flowing", -edge + 0.03: "clogged", 0.0: "clogged", edge - 0.03: "clogged", edge + 0.03: "flowing"}
        files = [f"{index}.csv" for index in range(len(offsets))]
        for file, offset in zip(files, offsets):
            self.pair(file, 15, offset)
        self.succeed("clogsweep", "obstacles=" + ",".join(files), "box=20", "line-tension=3", "vertices=64",
                     "max-time=400", "--output", "s.h5")
        with stored.opened(self.folder / "s.h5") as file:
            names = stored.circle_files(file)
        ends = {names[row.obstacles]: row.status for row in table(self.folder / "s.h5").itertuples()}
        self.assertEqual(ends, dict(zip(files, offsets.values())))

    def test_a_pair_across_the_flow_catches_on_its_whole_width(self):
        for diameters, apart in [((0.3, 0.3), 0.8), ((0.3, 0.5), 0.9)]:
            self.write("pair.csv", "x,y,diameter\n" + "".join(f"13,{10 + side * apart / 2},{diameter}\n" for side, diameter in zip((-1, 1), diameters)))
            (tension, length, squeezed, wrapped, doubts), = self.predict("obstacles=pair.csv", "box=20", "line-tension=3")
            self.assertEqual((tension, length, wrapped, doubts), ("3", squeezed, "", ""))
            self.assertNotIn("no length", self.said)
            self.assertAlmostEqual(float(length), 20 * 20 / apart, delta=0.1)

    def test_a_laboratory_gives_the_droplet_and_units(self):
        # Gamma = 0.3 gamma/(g sin(angle) difference sigma^2) = 3, with 9.81 m/s^2 and a difference of 100 kg/m^3.
        tension = 3 / 0.3 * 9.81 * 0.5 * 100 * 0.002**2
        self.write("lab.cfg",
                   f"diameter = 2 mm\nangle = 30 deg\ntension = {tension} N/m\ndensity-difference = 0.1 g/ml\n")
        self.write("pair.csv", "# units=mm droplet=2mm\nx,y,diameter\n26,19.2,0.6\n26,20.8,0.6\n")
        head, line = self.draw("predict", "--programs", BIN, "vertices=64", "--lab", "lab.cfg", "obstacles=pair.csv",
                               "box=40mm").stdout.splitlines()
        self.assertEqual(head, "line_tension,clogging_length,squeezed,wrapped,doubts,clogging_length_mm")
        tension, length, *_, in_mm = line.split(",")
        # A pair across the flow holds droplets over its whole width, so lambda is 20 sigma times 20 sigma divided by
        # 0.8 sigma.
        self.assertEqual((tension, in_mm), ("3", "1000"))
        self.assertAlmostEqual(float(length), 20 * 20 / 0.8, delta=0.1)
        self.write("two.cfg", "diameter = 2 mm, 3 mm\nangle = 30 deg\n")
        self.refuse_analysis("predict", "--programs", BIN, "--lab", "two.cfg", "obstacles=pair.csv", "box=40mm",
                             words=["two.cfg", "2 droplets", "give one diameter"])

    def test_the_curve_is_drawn_beside_the_lengths_of_a_sweep(self):
        self.pair("pair.csv", 0)
        keys = ("obstacles=pair.csv", "box=20", "line-tension=3,4")
        self.succeed("clogsweep", *keys, "vertices=64", "max-time=400", "seeds=1", "--output", "s.h5")
        self.predict(*keys, "--output", "curve", "--with", "s.h5")
        for ending in ("png", "pdf"):
            self.assertTrue((self.folder / f"curve.{ending}").exists())

    def test_a_soft_droplet_hangs_on_one_obstacle(self):
        self.write("post.csv", "x,y,diameter\n13,10,0.3\n")
        soft = ("preset=elastic", "friction=0.3", "vertices=128", "inertia=4", "line-tension=0.1")
        (_, length, squeezed, wrapped, _), = self.predict("obstacles=post.csv", "box=20", *soft)
        self.assertEqual((length, squeezed), (wrapped, ""))
        half_width = 20 * 20 / float(wrapped) / 2
        files = [f"{sign}.csv" for sign in (-1, 1)]
        for sign, file in zip((-1, 1), files):
            self.write(file, f"x,y,diameter\n47,{10 - half_width * (1 + 0.05 * sign)},0.3\n")
        self.succeed("clogsweep", "obstacles=" + ",".join(files), "box=20", "boxes=4", *soft, "max-time=2000",
                     "--output", "p.h5")
        rows = table(self.folder / "p.h5")
        self.assertEqual(sorted(rows.status), ["clogged", "flowing"])

    def test_a_tilted_pair_catches_on_its_projection(self):
        self.pair("pair.csv", 20)
        soft, stiff = self.predict("obstacles=pair.csv", "box=20", "line-tension=0.1,3")
        self.assertEqual(soft, ["0.1", "", "", "", "soft"])
        self.assertIn("no length at line-tension=0.1: neither an obstacle nor a pair held a droplet", self.said)
        self.assertAlmostEqual(float(stiff[1]), 20 * 20 / 0.8 / math.cos(math.radians(20)), delta=0.1)

    def test_an_allocation_of_several_tasks_is_no_hindrance(self):
        self.pair("pair.csv", 80)
        with mock.patch.dict(os.environ, {"SLURM_NTASKS": "8"}):
            self.assertEqual(self.predict("obstacles=pair.csv", "box=20", "line-tension=3"), [["3", "", "", "", ""]])
            thrown = collision.Collisions(BIN / "clogsweep", self.folder, {"vertices": "64"})
            self.assertEqual(thrown.break_up(0.3, [0.5]), [False])

    def test_a_pair_along_the_flow_catches_nothing(self):
        self.pair("pair.csv", 80)
        self.assertEqual(self.predict("obstacles=pair.csv", "box=20", "line-tension=3"), [["3", "", "", "", ""]])

    def test_what_it_cannot_use_is_refused(self):
        self.write("two.csv", "x,y,diameter\n5,5,0.3\n5,5.8,0.3\n")
        for words, said in [(["seeds=1..5"], "seeds"), (["obstacle-gap=0.2,0.3"], "one value"),
                            (["release=anywhere"], "release"), (["--with", "s.h5"], "--output"),
                            (["terminal-speed=x"], "terminal-speed"), (["frobnicate=1", "obstacles=two.csv"], "")]:
            self.refuse_analysis("predict", "--programs", BIN, *words, words=[said])
        self.write("lab.cfg", "diameter = 1.2 mm\nangle = 30 deg\ntension = 2 mN/m\nspeed = 1 mm/s\n")
        self.refuse_analysis("predict", "--programs", BIN, "--lab", "lab.cfg", "line-tension=20mN/m",
                             words=["line-tension=20mN/m", "write it into lab.cfg as the tension"])
        self.assertEqual(sorted(path.name for path in pathlib.Path(self.folder).glob("*.h5")), [])


if __name__ == "__main__":
    unittest.main()
