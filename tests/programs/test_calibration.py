"""Tests the module behind clogfit calibrate, deviation and drag. Closed formulas replace the simulations."""

import json
import math
import re
import sys
import tempfile
import unittest
from pathlib import Path

import numpy as np

from support import BIN, ROOT

sys.path.insert(0, str(ROOT / "analysis"))
from clogsweep.calibration import profiles, search  # noqa: E402
from clogsweep.calibration.deviation import correlation, root_mean_square, shape_residuals, speed_residuals  # noqa: E402
from clogsweep.calibration.profiles import Profile, ReducedUnits  # noqa: E402
from clogsweep.calibration.simulation import Clogrun  # noqa: E402
from clogsweep.commands import calibrate, drag  # noqa: E402
from clogsweep.results import laboratory  # noqa: E402
from clogsweep.tools.errors import UserError  # noqa: E402


def frames(*rows):
    return Profile(*np.array(rows, dtype=float).T)


def model(tension, near_wall_drag):
    """The passage of a droplet that drag slows down near h = 0. A term with 1/(1 + tension) also changes the speed."""
    h = np.arange(-2, 2, 0.013)
    near = np.exp(-4 * h**2)
    return Profile(h, 1 / (1 + 8 * near_wall_drag * near) + 0.3 / (1 + tension) * h * near, 1 + near * 0.1 /
                   (1 + tension))


def measured(simulated, noise=0, seed=1, first=3, every=7):
    seen = Profile(*(values[first::every] for values in simulated))
    return seen._replace(speed=seen.speed * (1 + noise * np.random.default_rng(seed).standard_normal(len(seen.h))))


def deviation(seen, simulated):
    return root_mean_square(speed_residuals(seen, simulated)[0]), root_mean_square(shape_residuals(seen, simulated))


def first_half(profile):
    return Profile(*(values[:len(values) // 2] for values in profile))


def clogging(tension, near_wall_drag):
    """The passage of a droplet that clogs at line tensions of 1 and more. The smallest speed of the droplet falls to
    zero when the line tension rises to 1. The profile has bumps that move with the line tension."""
    h = np.arange(-1, 1, 0.004)
    if tension >= 1:
        h = h[h <= -0.1]
    neck = np.exp(-25 * h**2)
    slow = (1 - min(tension, 1)) * (1 + 0.3 * np.sin(20 * h + 12 * math.log(max(1 - tension, 1e-9)))) / (0.02 + near_wall_drag)
    return Profile(h, 1 / (1 + near_wall_drag * (1 - neck)) * (1 - neck) + neck * np.minimum(slow, 1) + 1e-4,
                   np.ones(len(h)))


class Deviations(unittest.TestCase):
    stuck = frames([0, 1, 1], [1, 0.5, 1.1])

    def test_they_are_root_mean_squares_of_relative_differences(self):
        # The simulation has v = 1.5 and A = 1.05 at h = 0.5, and v = 2 and A = 1.1 at h = 1.
        speed, shape = deviation(frames([0.5, 1.8, 1.05 * 1.02], [1, 2, 1.1]), frames([0, 1, 1], [1, 2, 1.1]))
        self.assertAlmostEqual(speed, 0.2 / math.sqrt(2), places=12)
        self.assertAlmostEqual(shape, 0.02 / math.sqrt(2), places=12)

    def test_a_frame_that_is_never_reached_counts_ten_and_ten_for_each_missing_diameter(self):
        self.assertAlmostEqual(deviation(frames([2, 1, math.nan]), self.stuck)[0], 20, places=12)

    def test_frames_upstream_of_the_simulated_start_are_refused(self):
        with self.assertRaisesRegex(UserError, "^2 measured frames, down to h = -0.75, are upstream of the simulated "
                                               "start at h = 0; .*start=-1.25, or delete these frames"):
            deviation(frames([-0.75, 1, 1], [-0.5, 1, 1], [0.5, 1, 1]), self.stuck)
        # The droplet was pushed back upstream of its start, so a frame in this part of its path is upstream, too.
        with self.assertRaisesRegex(UserError, "^1 measured frame, .*is upstream of"):
            deviation(frames([-0.5, 1, 1]), frames([0, 1, 1], [-1, 1, 1], [1, 1, 1]))
        with self.assertRaisesRegex(UserError, "in the order of time$"):
            deviation(frames([0.5, 1, 1]), frames([1, 1, 1], [0, 1, 1]))

    def test_frames_at_the_ends_of_the_simulation_may_be_rounded(self):
        rounded = frames([-1e-15, 1, 1.05], [1 + 1e-15, 0.5, 1.1])
        np.testing.assert_allclose(speed_residuals(rounded, self.stuck)[0], 0, atol=1e-12)

    def test_unknown_shapes_are_excluded(self):
        self.assertTrue(math.isnan(deviation(frames([0.5, 0.75, math.nan]), self.stuck)[1]))
        self.assertTrue(math.isnan(deviation(frames([0.5, 1, 1.1]), frames([0, 1, math.nan], [1, 1, math.nan]))[1]))
        self.assertAlmostEqual(deviation(frames([0.5, 0.75, math.nan], [0, 1, 1.1]), self.stuck)[1], 0.1, places=12)

    def test_the_first_of_several_passages_counts(self):
        wavering = frames([0, 1, 1], [1, 1, 1], [0.5, 3, 1], [1.5, 3, 1])
        self.assertAlmostEqual(deviation(frames([0.75, 1, 1]), wavering)[0], 0, places=12)

    def test_residuals_of_another_shape_are_correlated(self):
        noisy = measured(model(1, 0.1), 0.02)
        self.assertLess(abs(correlation(speed_residuals(noisy, model(1, 0.1))[0])), 3 / math.sqrt(len(noisy.h)))
        faster = noisy._replace(speed=1.2 * noisy.speed)  # as if the speeds had been divided by a wrong terminal speed
        residuals = speed_residuals(faster, model(1, 0.1))[0]
        self.assertGreater(correlation(residuals), 0.9)
        self.assertTrue(math.isnan(correlation(residuals[:7])))

    def test_the_order_of_the_frames_does_not_matter(self):
        seen = measured(model(1, 0.1), 0.02)
        backwards = Profile(*(values[::-1] for values in seen))
        self.assertEqual(search.calibrate(backwards, model), search.calibrate(seen, model))


class Calibrations(unittest.TestCase):
    def test_what_made_a_profile_is_found(self):
        for tension in (0.16, 3.0):
            for near_wall_drag in (0.0, 0.064, 0.4):
                with self.subTest(tension=tension, near_wall_drag=near_wall_drag):
                    found = search.calibrate(measured(model(tension, near_wall_drag)), model)
                    self.assertAlmostEqual(found.line_tension, tension, delta=0.005 * (1 + tension))
                    self.assertAlmostEqual(found.near_wall_drag, near_wall_drag, delta=1e-3)
                    self.assertLess(max(found.delta_v, found.delta_a), 1e-3)
                    self.assertTrue(found.converged)
                    self.assertTrue(math.isnan(found.clogging_tension))
                    self.assertEqual(found.warnings, [])

    def test_trials_scatter_by_their_errors(self):
        number = 40
        found = [search.calibrate(measured(model(0.8, 0.1), 0.02, seed), model) for seed in range(number)]
        every = calibrate.means(found)
        # With 40 results, their standard deviation has an error of 11 %. The error of their mean is the standard
        # deviation divided by the square root of 40.
        self.assertAlmostEqual(every["line_tension_deviation"] / np.mean([one.line_tension_error for one in found]),
                               1, delta=0.35)
        self.assertAlmostEqual(every["near_wall_drag_deviation"] / np.mean([one.near_wall_drag_error for one in found]),
                               1, delta=0.35)
        self.assertAlmostEqual(every["line_tension"], 0.8,
                               delta=4 * every["line_tension_deviation"] / math.sqrt(number))
        self.assertAlmostEqual(every["near_wall_drag"], 0.1,
                               delta=4 * every["near_wall_drag_deviation"] / math.sqrt(number))

    def test_a_narrow_minimum_beside_a_clog_is_found(self):
        for tension in (0.91, 0.97, 0.985):
            with self.subTest(tension=tension):
                found = search.calibrate(measured(clogging(tension, 0.3), 0.02, 5, first=5, every=10), clogging)
                self.assertAlmostEqual(found.line_tension, tension, delta=4 * found.line_tension_error)
                self.assertAlmostEqual(found.near_wall_drag, 0.3, delta=4 * found.near_wall_drag_error)
                self.assertLess(found.line_tension_error, 0.01)
                self.assertLess(found.delta_v, 0.03)
                self.assertTrue(found.converged)
                self.assertAlmostEqual(found.clogging_tension, 1, delta=0.005)
                self.assertEqual(["close to a clog" in warning for warning in found.warnings],
                                 [True] if tension > 0.95 else [])

    def test_there_are_no_errors_where_the_profile_does_not_determine_both(self):
        found = search.calibrate(measured(model(1, 0.1), 0.01, 3), lambda _, near_wall_drag: model(1, near_wall_drag))
        self.assertTrue(math.isnan(found.line_tension_error))
        self.assertAlmostEqual(found.near_wall_drag, 0.1, delta=0.02)
        self.assertIn("no errors", " ".join(found.warnings))

    def test_there_are_no_errors_beside_a_line_tension_at_which_the_droplet_clogs(self):
        def abrupt(tension, near_wall_drag):
            return model(tension, near_wall_drag) if tension <= 1 else first_half(model(tension, near_wall_drag))

        beside = search.calibrate(measured(model(0.98, 0.1), 0.02, 2), abrupt)
        self.assertLessEqual(beside.line_tension, 1)
        self.assertNotIn("no simulated droplet comes to", " ".join(beside.warnings))
        self.assertGreater(search.calibrate(measured(model(0.5, 0.1), 0.02, 2), abrupt).line_tension_error, 0)

    def test_the_end_of_the_range_is_reported(self):
        for tension, near_wall_drag, is_at_bound in ((100, 0.1, True), (1, 5, True), (1, 0, False)):
            printed = " ".join(search.calibrate(measured(model(tension, near_wall_drag)), model).warnings)
            self.assertEqual("the best is at the end of what was searched" in printed, is_at_bound, printed)

    def test_frames_that_no_simulation_reaches_are_counted(self):
        seen = measured(model(1, 0.1))
        found = search.calibrate(seen, lambda *droplet: first_half(model(*droplet)))
        number = re.search(r"no simulated droplet comes to (\d+) of the frames", " ".join(found.warnings))[1]
        self.assertAlmostEqual(int(number), len(seen.h) / 2, delta=1)

    def test_every_simulation_is_reported_and_a_search_is_repeatable(self):
        printed = []
        found = search.calibrate(measured(model(1, 0.1), 0.02), model, lambda *attempt: printed.append(attempt))
        self.assertGreaterEqual(len(printed), found.simulations)  # Two threads may have tried the same value.
        self.assertAlmostEqual(min(delta for _, _, delta in printed), found.delta_v, places=12)
        self.assertEqual(search.calibrate(measured(model(1, 0.1), 0.02), model)[:4], found[:4])

    def test_what_a_simulation_throws_ends_the_search(self):
        def failing(tension, near_wall_drag):
            raise UserError("a droplet broke")

        with self.assertRaisesRegex(UserError, "a droplet broke"):
            search.calibrate(measured(model(1, 0.1)), failing)

    def test_one_trial_has_no_deviation(self):
        one = search.calibrate(measured(model(1, 0.1)), model)
        self.assertEqual(calibrate.means([one])["line_tension"], one.line_tension)
        self.assertTrue(math.isnan(calibrate.means([one])["line_tension_deviation"]))


class Drag(unittest.TestCase):
    def test_it_is_the_closed_form_s(self):
        distances = np.array([0.05, 0.1, 0.3, 1.0])
        found = drag.fit(distances, 1 / (1 + 0.07 * distances**-1.25))
        self.assertAlmostEqual(found["near_wall_exponent"], 1.25, places=12)
        self.assertAlmostEqual(found["near_wall_drag"], 0.07, places=12)
        self.assertLess(found["near_wall_exponent_error"], 1e-7)  # the square root of the rounding error

    def test_two_speeds_leave_no_errors(self):
        found = drag.fit(np.array([0.1, 1.0]), np.array([0.5, 0.9]))
        self.assertIsNone(found["near_wall_exponent_error"])
        self.assertAlmostEqual(found["near_wall_exponent"], math.log10(9), places=12)  # v/(v_t - v) is 1 and 9

    def test_errors_are_those_of_numpy_s_polyfit(self):
        distances = np.array([0.05, 0.1, 0.2, 0.5, 1.0])
        speeds = np.array([0.2, 0.45, 0.6, 0.85, 0.92])
        (slope, intercept), covariance = np.polyfit(np.log(distances), np.log(speeds / (1 - speeds)), 1, cov=True)
        expected = slope, math.sqrt(covariance[0,
                                               0]), math.exp(-intercept), math.exp(-intercept) * math.sqrt(covariance[1, 1])
        np.testing.assert_allclose(list(drag.fit(distances, speeds).values()), expected, rtol=1e-9)

    def test_it_is_that_of_the_recorded_program(self):
        # The expected numbers are the output of `clogfit drag speeds.csv --format json` in version 0.2.0 (git
        # 0b3b912ecf24), which was written in C++.
        recorded = 1.262664727769909, 0.0639355416714198, 0.08057491425594032, 0.009595554051668526
        found = drag.fit(np.array([0.05, 0.1, 0.2, 0.5, 1]), np.array([0.2, 0.45, 0.6, 0.85, 0.92]))
        np.testing.assert_allclose(list(found.values()), recorded, rtol=1e-12)

    def test_what_has_no_such_line_is_refused(self):
        for distances, speeds in (([0.1], [0.5]), ([0.1,
                                                    0.1], [0.5, 0.6]), ([0.1, -1], [0.5, 0.6]), ([0.1, 1], [0.5, 1])):
            with self.assertRaises(UserError):
                drag.fit(np.array(distances), np.array(speeds))


class SpeedFiles(unittest.TestCase):
    def read(self, text):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "speeds.csv"
            path.write_text(text)
            return profiles.read_table(str(path), "d", ReducedUnits())[:2]

    def test_decimal_commas_are_those_of_decimal_points(self):
        plain = "d [sigma];v [v_t]\n0.05;0.2\n0.1;0.45\n1.25;0.9\n"
        distances, speeds = self.read(plain)
        np.testing.assert_array_equal([distances, speeds], [[0.05, 0.1, 1.25], [0.2, 0.45, 0.9]])
        for commas in (plain.replace(".", ","), plain.replace(".", ",").replace(";", "\t"),
                       'd [sigma],v [v_t]\n"0,05","0,2"\n"0,1","0,45"\n"1,25","0,9"\n'):
            self.assertEqual(drag.fit(*self.read(commas)), drag.fit(distances, speeds))

    def test_ambiguous_commas_are_refused(self):
        for text, words in (("d [sigma];v [v_t]\n1,350;1\n2,050;1\n",
                             "'1,350' may have a decimal comma or separated thousands"),
                            ("d [sigma];v [v_t]\n0,5;0.2\n",
                             "line 2: v: '0.2' has a point, but '0,5' above has a comma"),
                            ("d [sigma];v [v_t]\n1.5;0\n1,5;0\n",
                             "line 3: d: '1,5' has a comma, but '1.5' above has a point"),
                            ("d [sigma];v [v_t]\n1.350,5;0\n", "line 2: d: '1.350,5' may have")):
            with self.subTest(text=text), self.assertRaisesRegex(UserError, words):
                self.read(text)


class ProfileFiles(unittest.TestCase):
    def read(self, text, scales=ReducedUnits(), encoding="utf-8"):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "profile.csv"
            path.write_text(text, encoding, newline="")
            return profiles.read_profile(str(path), scales)[0]

    def test_they_are_read_in_reduced_units(self):
        profile = self.read("# by hand\nh [sigma], v [v_t], A\n-1,0.9,1.01\n\n0,0.4,\n1,0.8,1.02\n")
        np.testing.assert_array_equal(profile, [[-1, 0, 1], [0.9, 0.4, 0.8], [1.01, math.nan, 1.02]])

    def test_they_are_read_in_laboratory_units(self):
        profile = self.read("t [s],v [mm/s],h [mm]\r\n0,7,-3.5\r\n1,3.5,0\r\n2,10.5,7\r\n", ReducedUnits(3.5e-3, 7e-3))
        np.testing.assert_allclose(profile[:2], [[-1, 0, 2], [1, 0.5, 1.5]], rtol=1e-14)

    def test_they_are_read_as_spreadsheets_and_other_programs_write_them(self):
        plain = "h [\u00b5m],v [\u00b5m/s],A\n-1,2,1\n0,3,\n1,4,1.5\n"
        expected = self.read(plain, ReducedUnits(1e-6, 1e-6))
        for text, encoding in [("sep=;\n" + plain.replace(",", " ; "), "utf-16"),
                               (plain.replace(",", "\t").replace("\n", "\r"), "latin-1"), (plain, "utf-8-sig"),
                               ('"# of R"\n"h [\u00b5m]" "v [\u00b5m/s]"  "A"\n -1 2 1\n0 3\n1 4   1.5 \n', "utf-8"),
                               (plain.replace(",", "\xa0,\xa0"), "utf-8"),
                               ("".join(f",{line}\n" for line in plain.splitlines()), "utf-8"),]:
            with self.subTest(text=text, encoding=encoding):
                np.testing.assert_array_equal(self.read(text, ReducedUnits(1e-6, 1e-6), encoding), expected)

    def test_units_of_columns_are_those_of_clogfit_units(self):
        for unit, metres in profiles.METRES.items():
            answer = laboratory.units({"diameter": f"1e-6 {unit}", "angle": "5 deg",
                                       "speed": f"1e-6 {unit}/s"}, folder=BIN)
            np.testing.assert_allclose([answer["diameter_mm"], answer["speed_mm_per_s"]], 1e-3 * metres, rtol=1e-12)

    def test_mistakes_name_the_line(self):
        for text, scales, words in [
            ("h [mm],v [mm/s]\n1,1\n", ReducedUnits(0, 1), "line 1: is in mm and needs --diameter"),
            ("h,v\n1,1\n", ReducedUnits(), "no unit"),
            ("h [furlong],v [v_t]\n", ReducedUnits(),
             r"line 1: unknown unit 'furlong' \(known: sigma, m, cm, mm, um, "),
            ("x,y\n1,1\n", ReducedUnits(), "columns h and v"),
            ("h [sigma],v [v_t]\n1,1\n1,fast\n", ReducedUnits(), "line 3: v: 'fast' is not a finite number"),
            ("h [sigma],v [v_t]\n1,1\n1\n", ReducedUnits(), "line 3: has too few columns"),
            ('h [sigma],v [v_t]\n1,1\n"1,1\n', ReducedUnits(), "line 3: "),
            ("h [sigma],v [v_t]\n1,1\n", ReducedUnits(), "fewer than three frames"),
        ]:
            with self.subTest(text=text), self.assertRaisesRegex(UserError, words):
                self.read(text, scales)


class Records(unittest.TestCase):
    """Compares with results of version 0.2.0, which was written in C++, for a coarse and fast droplet."""

    record = json.loads((Path(__file__).parent / "records" / "calibrate.json").read_text())

    def test_the_minimum_is_where_it_was_recorded(self):
        recorded = self.record["trials"][0]
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / recorded["profile"]
            path.write_text(self.record["profiles"][recorded["profile"]])
            seen = profiles.read_trial(str(path))[0]
            sought = search.Search(seen, Clogrun(BIN).past(seen, self.record["keys"]), lambda *_: None)
            place = math.log(recorded["line_tension"]), recorded["near_wall_drag"]
            errors = np.array([recorded["line_tension_error"] / recorded["line_tension"],
                               recorded["near_wall_drag_error"]])
            found = sought.linearise_over(np.array(place), errors)
        np.testing.assert_array_less(np.abs(found.step), 0.1 * errors)
        np.testing.assert_allclose(found.errors, errors, rtol=0.05)
        self.assertAlmostEqual(sought.attempt(place).delta, recorded["delta_v"], places=9)


if __name__ == "__main__":
    unittest.main()
