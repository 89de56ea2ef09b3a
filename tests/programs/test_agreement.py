"""Verdicts on the article's statements, for curves that were made so that the verdict is known."""

import csv
import io
import unittest

import h5py
import numpy as np

import stored_rows
from drawing import Analysis
from support import BIN

from clogsweep import agreement
from clogsweep.agreement import evidence, lengths, passages, statements
from clogsweep.agreement.statements import AGREES, DOES_NOT, FITTED, IN_KIND, NOT_KNOWN, NOT_RUN
from clogsweep.tools.errors import UserError

FACTOR = 1.5  # of a confidence interval, on both sides


def point(tension, length, gap=0.2, wrapped=0, squeezed=10, hybrid=0, clogs=None, **more):
    """@param length  negative: a lower bound, no run clogged"""
    if length < 0:
        return {"line_tension": tension, "obstacle_gap": gap, "clogs": 0, "wrapped": 0, "squeezed": 0, "hybrid": 0, "obstacle_density": 0.35,
                "clogging_length": None, "clogging_length_lower": -length, "clogging_length_upper": None} | more
    return {"line_tension": tension, "obstacle_gap": gap, "clogs": wrapped + squeezed + hybrid if clogs is None else clogs, "wrapped": wrapped, "squeezed": squeezed,
            "hybrid": hybrid, "obstacle_density": 0.35, "clogging_length": length, "clogging_length_lower": length / FACTOR,
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

    def test_the_peak_has_to_lie_beyond_that_of_the_narrow_gap(self):
        for wide, verdict in [(curve((0.03, 40), (0.2, 300), (0.5, 5000), (1.09, 13), gap=0.5), AGREES),
                              (curve((0.03, 40), (0.1, 5000), (0.5, 300), (1.09, 13), gap=0.5), DOES_NOT),
                              (curve((0.03, 40), (0.2, 5000), (0.5, 5000), (1.09, 13), gap=0.5), IN_KIND),
                              (curve((0.03, -4000), (1.09, 13), gap=0.5), NOT_KNOWN)]:
            self.assertEqual(lengths.peak_moves(self.RISES_AND_FALLS + wide).verdict, verdict)

    def test_wide_gaps_let_droplets_travel_farther(self):
        narrow, wide = curve((0.3, 10), (1, 5)), curve((0.3, 30), (1, 15), gap=0.5)
        self.assertEqual(lengths.longer_in_wide_gaps(narrow + wide).verdict, AGREES)
        self.assertEqual(lengths.longer_in_wide_gaps(curve((0.3, 30), (1, 15)) + curve((0.3, 10), (1, 5), gap=0.5)).verdict, DOES_NOT)
        self.assertEqual(lengths.longer_in_wide_gaps(narrow + curve((0.3, 12), (1, 6), gap=0.5)).verdict, NOT_KNOWN)

    def test_hybrids_are_sought_between_the_branches(self):
        def clogs(between, elsewhere):
            return [point(0.05, 40, wrapped=10, squeezed=0, hybrid=elsewhere), point(0.1, 40, wrapped=10, squeezed=0, hybrid=between),
                    point(0.3, 40, hybrid=between), point(1, 40, hybrid=elsewhere)]

        self.assertEqual(lengths.hybrids_between(clogs(6, 0)).verdict, AGREES)
        self.assertEqual(lengths.hybrids_between(clogs(1, 0)).verdict, IN_KIND)
        self.assertEqual(lengths.hybrids_between(clogs(0, 3)).verdict, DOES_NOT)
        self.assertEqual(lengths.hybrids_between(clogs(0, 0)).verdict, NOT_KNOWN)

    def test_the_published_length_is_compared_with_the_interval(self):
        for length, verdict in [(24, FITTED), (35, FITTED), (38, IN_KIND), (200, DOES_NOT), (-2000, NOT_KNOWN)]:
            self.assertEqual(lengths.published_length([point(1.09, length), point(1.09, 1, gap=0.3)]).verdict, verdict)


class Evidence(unittest.TestCase):
    def test_the_start_from_rest_is_no_minimum_before_the_orifice(self):
        way = np.array([(-2.0, 0.0), (-1.5, 0.9), (-0.8, 0.8), (-0.3, 0.1), (-0.1, 0.4), (0.4, 0.05)], [("h", float), ("speed_ratio", float)])
        self.assertEqual(passages.slowest_before(way), -0.3)

    def test_fishers_exact_test(self):
        # The lady tasting tea: R. A. Fisher, The Design of Experiments (1935), chapter II.
        self.assertAlmostEqual(evidence.fisher_p_value(4, 4, 0, 4), 1 / 70)
        self.assertAlmostEqual(evidence.fisher_p_value(3, 4, 1, 4), 17 / 70)
        self.assertAlmostEqual(evidence.fisher_p_value(0, 4, 3, 4), 1)

    def test_what_curves_say_together(self):
        for verdicts, together in [([AGREES, AGREES], AGREES), ([AGREES, NOT_KNOWN], AGREES), ([AGREES, DOES_NOT], IN_KIND), ([DOES_NOT, IN_KIND], IN_KIND),
                                   ([DOES_NOT, NOT_KNOWN], DOES_NOT), ([NOT_KNOWN], NOT_KNOWN), ([], NOT_KNOWN)]:
            self.assertEqual(evidence.overall(verdicts), together)

    def test_rows_of_several_model_versions_are_refused(self):
        statements.refuse_mixed({"speed": [7], "clogging-sp": [7]})
        with self.assertRaisesRegex(UserError, "older than 7: clogging-sp$"):
            statements.refuse_mixed({"speed": [7], "clogging-sp": [6, 7]})


class Table(Analysis):
    SWEEP = "reduced/sweeps/clogging-sp.h5"
    SETTINGS = ["wall-stiffness=0.5,30", "obstacle-gap=0.2,0.4", "obstacle-density=80%", "box=20", "boxes=10", "seeds=1..10", "max-time=3000"]

    def agreement(self, *options):
        return self.draw("agreement", "--output", ".", "--programs", BIN, *options).stdout

    def test_the_table_is_made_from_the_sweeps_that_are_there(self):
        self.draw("figures", "7a", "--output", ".", "--programs", BIN, *(word for setting in self.SETTINGS for word in ("--set", setting)))
        rows = list(csv.DictReader(io.StringIO(self.agreement("--format", "csv"))))
        self.assertEqual(len(rows), len(statements.STATEMENTS))
        of_disks = {row["statement"]: row for row in rows if row["where"] == "4.2, figure 7a"}
        self.assertEqual({row["verdict"] for row in of_disks.values()}, {AGREES}, of_disks)
        for row, one in zip(rows, statements.STATEMENTS, strict=True):
            if row["where"] != "4.2, figure 7a" and one.figures:
                self.assertEqual(row["verdict"], NOT_RUN)
                self.assertRegex(row["here"], r"^python3 -m clogsweep figures \w+")
            elif row["verdict"] != AGREES:
                self.assertNotEqual(row["reason"], "", row["statement"])

        text = self.agreement()
        self.assertTrue(text.startswith(f"Of {len(rows)} statements "))
        for row in rows:
            self.assertIn(f"| {row['here']} | **{row['verdict']}**", text)

        def grow_older(stored):
            stored["model_version"][0] -= 1

        stored_rows.change(self.folder / self.SWEEP, grow_older)
        with h5py.File(self.folder / self.SWEEP) as file:
            newest = file["runs"]["model_version"].max()
        self.refuse_analysis("agreement", "--output", ".", "--programs", BIN, words=[f"older than {newest}: clogging-sp"])

    def test_every_statement_has_a_reason_where_it_may_need_one(self):
        self.assertGreater(len(agreement.WRITERS), 1)
        for one in statements.STATEMENTS:
            with self.subTest(statement=one.text):
                self.assertTrue(one.figures or one.reasons)
                self.assertLessEqual(set(one.reasons), {FITTED, IN_KIND, DOES_NOT, NOT_KNOWN})


if __name__ == "__main__":
    unittest.main()
