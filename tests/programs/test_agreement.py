"""Tests the verdicts on statements of the article (Cheng et al.) with artificial curves that have known verdicts."""

import contextlib
import csv
import io
import math
import sys
import unittest
import unittest.mock

import h5py
import numpy as np

import stored_rows
from drawing import Analysis
from support import BIN

from clogsweep.agreement import evidence, frames, lengths, passages, statements
from clogsweep.agreement.statements import FORMULA, NOTHING, STATEMENTS
from clogsweep.agreement.verdicts import (AGREES, BY_MESH, DOES_NOT, FITTED, FORCED, IN_KIND, NOT_KNOWN, NOT_RUN,
                                          Finding, the_version, with_variants)
from clogsweep.commands import agreement
from clogsweep.paper import dilute, outlines, runner
from clogsweep.tools.errors import UserError

FACTOR = 1.5  # Ratio of the upper end of a confidence interval to the value, and of the value to the lower end.


def point(tension, length, gap=0.2, wrapped=0, squeezed=10, hybrid=0, clogs=None, **more):
    """A point of a curve. @param length  a negative number means that no run clogged, and that its absolute value is
    the lower bound"""
    if length < 0:
        return {"line_tension": tension, "obstacle_gap": gap, "clogs": 0, "wrapped": 0, "squeezed": 0, "hybrid": 0, "obstacle_density": 0.35, "obstacle_filling": "density",
                "total_distance": -3 * length, "clogging_length": None, "clogging_length_lower": -length, "clogging_length_upper": None} | more
    clogs = wrapped + squeezed + hybrid if clogs is None else clogs
    return {"line_tension": tension, "obstacle_gap": gap, "clogs": clogs, "wrapped": wrapped, "squeezed": squeezed, "hybrid": hybrid, "obstacle_density": 0.35,
            "obstacle_filling": "density", "total_distance": clogs * length, "clogging_length": length, "clogging_length_lower": length / FACTOR,
            "clogging_length_upper": length * FACTOR} | more


def curve(*points, gap=0.2):
    return [point(tension, length, gap) for tension, length in points]


class Lengths(unittest.TestCase):
    RISES_AND_FALLS = curve((0.03, 40), (0.1, 100), (0.2, 2800), (0.5, 40), (1.09, 13))

    def test_a_curve_with_a_peak_is_non_monotonic(self):
        self.assertEqual(lengths.is_not_monotonic(self.RISES_AND_FALLS).verdict, AGREES)
        self.assertEqual(lengths.peak(self.RISES_AND_FALLS)["line_tension"], 0.2)

    def test_a_curve_that_only_falls_is_not(self):
        self.assertEqual(lengths.is_not_monotonic(curve((0.1, -2000), (0.3, 700), (1.09, 13))).verdict, DOES_NOT)

    def test_a_rise_within_the_errors_is_not_known(self):
        self.assertEqual(lengths.is_not_monotonic(curve((0.1, 600), (0.3, 700), (1.09, 13))).verdict, NOT_KNOWN)

    def test_one_gap_of_two_with_a_peak_agrees_qualitatively(self):
        falling = curve((0.1, -2000), (0.3, 700), (1.09, 13), gap=0.3)
        self.assertEqual(lengths.is_not_monotonic(self.RISES_AND_FALLS + falling).verdict, IN_KIND)

    def test_the_peak_moves_if_nearly_all_draws_of_the_fitted_curves_say_so(self):
        tensions = np.geomspace(0.03, 3, 13)

        def peaked(at, gap, clogs=100):
            return [point(tension, 5000 * math.exp(-2 * math.log(tension / at) ** 2), gap, clogs=clogs)
                    for tension in tensions]

        for wide, verdict in [(peaked(0.4, 0.5), AGREES), (peaked(0.1, 0.5), DOES_NOT),
                              (peaked(0.2, 0.5, clogs=5), NOT_KNOWN),
                              (curve((0.03, -4000), (0.1, 2000), (0.5, 30), (1.09, 13), gap=0.5), NOT_KNOWN)]:
            self.assertEqual(lengths.peak_moves(peaked(0.2, 0.2) + wide).verdict, verdict)

    def test_wide_gaps_let_droplets_travel_farther_at_every_line_tension(self):
        narrow = curve((0.1, -2000), (0.3, 10), (1, 5))
        for wide, verdict in [(curve((0.1, -2000), (0.3, 30), (1, 15), gap=0.5),
                               AGREES), (curve((0.3, 30), (1, 6), gap=0.5), IN_KIND),
                              (curve((0.3, 30), (1, 1), gap=0.5),
                               IN_KIND), (curve((0.3, 3), (1, 1), gap=0.5),
                                          DOES_NOT), (curve((0.3, 12), (1, 6), gap=0.5), NOT_KNOWN)]:
            self.assertEqual(lengths.longer_in_wide_gaps(narrow + wide).verdict, verdict)

    def test_continuous_flow_lies_between_line_tensions_at_which_droplets_clog(self):
        for points, verdict in [([(0.1, 40), (0.2, -2000), (1, 10)], AGREES),
                                ([(0.1, -2000), (0.2, 400), (1, 10)], IN_KIND),
                                ([(0.1, 40), (0.2, 400), (1, 10)], DOES_NOT)]:
            self.assertEqual(lengths.flows_between(curve(*points)).verdict, verdict)

    def test_hybrids_are_sought_between_the_branches(self):
        def clogs(between, elsewhere):
            return [point(0.05, 40, wrapped=10, squeezed=0, hybrid=elsewhere),
                    point(0.1, 40, wrapped=10, squeezed=0, hybrid=between),
                    point(0.3, 40, hybrid=between), point(1, 40, hybrid=elsewhere)]

        self.assertEqual(lengths.hybrids_between(clogs(6, 0)).verdict, AGREES)
        self.assertEqual(lengths.hybrids_between(clogs(1, 0)).verdict, NOT_KNOWN)
        self.assertEqual(lengths.hybrids_between(clogs(0, 3)).verdict, DOES_NOT)
        self.assertEqual(lengths.hybrids_between(clogs(0, 0)).verdict, NOT_KNOWN)

    def test_the_published_length_is_compared_with_the_interval(self):
        for length, verdict in [(24, FITTED), (35, FITTED), (38, IN_KIND), (200, DOES_NOT), (-2000, NOT_KNOWN)]:
            self.assertEqual(lengths.published_length([point(1.09, length), point(1.09, 1, gap=0.3)]).verdict, verdict)


class Frames(unittest.TestCase):
    """A droplet like an upside-down U. The inside of the U touches a post."""

    POST = (0.0, 0.0, 0.3)

    def outline(self, lobe=1.0):
        around = np.radians(np.linspace(100, 260, 60))  # over the upstream half of the post
        inner = 0.16 * np.array([np.cos(around), np.sin(around)])
        outer = 0.5 * np.array([np.cos(around[::-1]), np.sin(around[::-1])])
        ends = np.array([[lobe, lobe], [-0.3, -0.5]]), np.array([[lobe, lobe], [0.5, 0.3]])
        return np.concatenate([inner, ends[0], outer, ends[1]], axis=1)

    def test_the_angle_of_contact_is_that_of_the_arc(self):
        angle, none = outlines.touched_angles(self.outline(), np.array([self.POST, (3.0, 3.0, 0.3)]))
        self.assertAlmostEqual(angle, 160, delta=20)
        self.assertEqual(none, 0)

    def test_hybrids_wrap_a_post_and_fill_a_gap_downstream(self):
        circle = np.radians(np.arange(0, 360, 2))
        droplet = np.array([2 + 1.2 * np.cos(circle), 0.2 * np.sin(circle) + 0.0])  # The droplet is long along x.
        inside = np.array([[1.0, 0.0, 0.3]])  # A post inside the droplet.
        gap = np.array([[2.0, 0.36, 0.3], [2.0, -0.36, 0.3]])
        ring = 0.16 * np.array([np.cos(circle), np.sin(circle)]) + [[1.0], [0.0]]
        wrapping = np.concatenate([droplet, ring], axis=1)
        self.assertTrue(outlines.is_hybrid(wrapping, np.concatenate([inside, gap])))
        self.assertFalse(outlines.is_hybrid(wrapping, inside))
        self.assertFalse(outlines.is_hybrid(droplet, gap))
        upstream = np.array([[1.0, 0.36, 0.3], [1.0, -0.36, 0.3]]) - [[0.1, 0.05, 0]]
        self.assertFalse(outlines.is_hybrid(wrapping, np.concatenate([inside, upstream])))

    def test_a_droplet_unwraps_if_one_end_rises(self):
        def run(*ends):
            outlines = [np.array([[low, 47 - 0.5, high], [4.5, 5.08, 5.6]]) for low, high in ends]
            return unittest.mock.Mock(polygons=outlines)

        for ends, verdict in [(((47.5, 47.5), (47.9, 47.6), (48.6, 46.9)), AGREES),
                              (((47.5, 47.5), (47.9, 47.8)), DOES_NOT),
                              (((47.5, 47.5), (47.9, 47.3)), IN_KIND)]:
            with unittest.mock.patch.object(frames.hanging, "over_a_post", return_value=run(*ends)):
                self.assertEqual(frames.unwraps_against_the_drive(None).verdict, verdict)


class Evidence(unittest.TestCase):
    def test_the_start_from_rest_is_no_minimum_before_the_orifice(self):
        way = np.array([(-2.0, 0.0), (-1.5, 0.9), (-0.8, 0.8), (-0.3, 0.1), (-0.1, 0.4), (0.4, 0.05)],
                       [("h", float), ("speed_ratio", float)])
        self.assertEqual(passages.slowest_before(way), -0.3)

    def test_the_peak_behind_the_orifice_is_not_the_approach_to_the_terminal_speed(self):
        way = np.array([(-0.3, 0.1), (0.1, 0.6), (0.2, 0.86), (0.3, 0.7), (0.4, 0.3), (0.55, 0.87), (0.9, 0.95)],
                       [("h", float), ("speed_ratio", float)])
        self.assertEqual(passages.top_behind(way)["speed_ratio"], 0.86)
        self.assertIsNone(passages.top_behind(way[:5]))

    def test_a_smooth_mesh_lets_the_droplet_pass_and_hardly_ripples(self):
        h = np.arange(-1, 1, 0.01)

        def run(amplitude, status="passed"):
            speed = 0.5 + 0.4 * np.tanh(8 * h) + amplitude * np.sqrt(2) * np.sin(2 * np.pi * h / 0.05)
            table = np.array(list(zip(h, speed)), [("h", float), ("speed_ratio", float)])
            return unittest.mock.Mock(table=table, word=lambda name: status)

        for runs, verdict in [({64: run(0.03), 128: run(0.012), 256: run(0.001), 512: run(0)}, AGREES),
                              ({64: run(0, "clogged"), 128: run(0.012), 512: run(0)}, IN_KIND),
                              ({64: run(0.01), 128: run(0.01), 512: run(0)}, IN_KIND),
                              ({64: run(0.03), 128: run(0.03), 256: run(0.001), 512: run(0)}, DOES_NOT),
                              ({64: run(0.03), 128: run(0.012), 256: run(0.03), 512: run(0)}, DOES_NOT),
                              ({64: run(0.03), 128: run(0.012), 512: run(0, "clogged")}, DOES_NOT),
                              ({64: run(0, "clogged"), 128: run(0, "clogged"), 512: run(0, "clogged")}, DOES_NOT),
                              ({64: run(0.03), 512: run(0)}, NOT_KNOWN), ({128: run(0)}, NOT_KNOWN)]:
            with unittest.mock.patch.object(passages.channels, "meshes", return_value=runs):
                self.assertEqual(passages.profiles_are_smooth(None).verdict, verdict)

    def test_lengths_that_grow_with_the_gap_at_some_stiffnesses_agree_qualitatively(self):
        def group(stiffness, gap, length):
            return {"wall_stiffness": stiffness, "obstacle_gap": gap, "clogs": 50, "clogging_length": length,
                    "clogging_length_lower": 0.8 * length, "clogging_length_upper": 1.25 * length}

        for wide, verdict in [((100, 200, 300), AGREES), ((10, 11, 300), IN_KIND), ((10, 11, 10), NOT_KNOWN)]:
            groups = [one for stiffness, length in zip((1, 2, 3), wide)
                      for one in (group(stiffness, 0.2, 10), group(stiffness, 0.5, length))]
            self.assertEqual(lengths.grows_with_gap(groups, "wall_stiffness").verdict, verdict)

    def test_rows_of_a_list_of_seeds_are_found_by_seed(self):
        row = np.array([(3, 0.5)], [("seed", "i8"), ("line_tension", float)])[0]
        self.assertEqual(runner.in_row(row, "seeds", "1"), "3")
        self.assertEqual(runner.in_row(row, "line-tension", "1"), "0.5")

    def test_variants_that_agree_say_what_makes_the_nearest_model_agree(self):
        slides, rubbed, _, pinned = dilute.FAMILIES
        for nearest, friction, corners, verdict in [(AGREES, DOES_NOT, DOES_NOT,
                                                     AGREES), (DOES_NOT, AGREES, AGREES, FORCED), (NOT_KNOWN, IN_KIND, AGREES, BY_MESH),
                                                    (DOES_NOT, IN_KIND, DOES_NOT,
                                                     DOES_NOT), (IN_KIND, AGREES, AGREES, IN_KIND)]:
            found = {family: Finding(one, "1")
                     for family, one in zip((slides, rubbed, pinned), (nearest, friction, corners))}
            self.assertEqual(with_variants(found), Finding(
                verdict, "1", f"wall friction (0.05): {friction}, 1; no friction, corner pinning: {corners}, 1",
                f"{friction}: all" if friction == corners else
                f"{friction}: wall friction (0.05); {corners}: no friction, corner pinning"))

    def test_what_curves_say_together(self):
        for verdicts, together in [([AGREES, AGREES], AGREES), ([AGREES, NOT_KNOWN], IN_KIND),
                                   ([AGREES, NOT_KNOWN, NOT_KNOWN], NOT_KNOWN),
                                   ([AGREES, DOES_NOT], IN_KIND), ([DOES_NOT, IN_KIND], IN_KIND),
                                   ([DOES_NOT, NOT_KNOWN], DOES_NOT), ([NOT_KNOWN], NOT_KNOWN), ([], NOT_KNOWN)]:
            self.assertEqual(evidence.overall(verdicts), together)

    def test_rows_of_several_model_versions_are_refused(self):
        self.assertEqual(the_version({"speed": [7], "clogging-sp": [7]}), 7)
        with self.assertRaisesRegex(UserError, "older than 7: clogging-sp$"):
            the_version({"speed": [7], "clogging-sp": [6, 7]})


class Table(Analysis):
    SWEEP = "reduced/sweeps/clogging-sp.h5"
    SETTINGS = ["wall-stiffness=0.5,30", "obstacle-gap=0.2,0.4", "obstacle-density=80%",
                "box=20", "boxes=10", "seeds=1..10", "max-time=3000"]

    def agreement(self, *options):
        return self.draw("agreement", "--output", ".", "--programs", BIN, *options).stdout

    def test_without_sweeps_no_model_version_is_named(self):
        text = " ".join(self.agreement().split())
        self.assertIn("No sweep has been run.", text)
        self.assertNotIn("model version", text)
        self.assertEqual(text.count(f"**{NOT_RUN}**"), sum(one.model not in (FORMULA, NOTHING) for one in STATEMENTS))

    def test_runs_are_announced_beside_the_table(self):
        one = next(one for one in STATEMENTS if one.figures == ("C1",))
        command = ["agreement", "--run", "--output", str(self.folder), "--programs", str(BIN), "--format", "csv"]
        patch = unittest.mock.patch.object
        with patch(statements, "STATEMENTS", [one]), patch(sys, "argv", command):
            with contextlib.redirect_stdout(io.StringIO()) as out, contextlib.redirect_stderr(io.StringIO()) as errors:
                self.assertEqual(agreement.body(), 0)
        self.assertEqual([row["statement"] for row in csv.DictReader(io.StringIO(out.getvalue()))], [one.text])
        self.assertIn("sweep energy:", errors.getvalue())

    def test_the_table_is_made_from_the_sweeps_that_are_there(self):
        self.draw("figures", "7a", "--output", ".", "--programs", BIN,
                  *(word for setting in self.SETTINGS for word in ("--set", setting)))
        rows = list(csv.DictReader(io.StringIO(self.agreement("--format", "csv"))))
        self.assertEqual(len(rows), len(STATEMENTS))
        of_disks = {row["statement"]: row for row in rows if row["where"] == "4.2, figure 7a"}
        self.assertEqual({row["verdict"] for row in of_disks.values()}, {AGREES}, of_disks)
        for row, one in zip(rows, STATEMENTS, strict=True):
            if one.figures != ("7a",) and one.model not in (FORMULA, NOTHING):
                self.assertEqual(row["verdict"], NOT_RUN)
                self.assertEqual(row["here"], "python3 -m clogsweep agreement --run")
            elif row["verdict"] in (DOES_NOT, NOT_KNOWN):
                self.assertRegex(row["reason"], "; tried: |^tried: ", row["statement"])

        text = self.agreement()
        self.assertTrue(text.startswith(f"The verdicts on the article's {len(rows)} statements are "))
        for row in rows:
            self.assertIn(f"| {row['here']} | **{row['verdict']}**", text)

        def grow_older(stored):
            stored["model_version"][0] -= 1

        stored_rows.change(self.folder / self.SWEEP, grow_older)
        with h5py.File(self.folder / self.SWEEP) as file:
            newest = file["runs"]["model_version"].max()
        self.refuse_analysis("agreement", "--output", ".", "--programs", BIN,
                             words=[f"older than {newest}: clogging-sp"])


if __name__ == "__main__":
    unittest.main()
