"""Reads the finished sweep that the sources contain. A change of format or model must not leave it unreadable."""

import json
import re
import shutil
import unittest

import pandas

from drawing import Analysis
from support import ROOT

SWEEP = ROOT / "docs/examples/first-curve/sweep.h5"
MOST_BYTES = 300_000


class FirstCurve(Analysis):
    def setUp(self):
        super().setUp()
        shutil.copyfile(SWEEP, self.folder / "sweep.h5")

    def test_the_sweep_is_complete_and_undamaged(self):
        told = self.succeed("clogsweep", "verify", "sweep.h5").stdout
        self.assertIn("sweep.h5: 70 rows of 70 runs, all undamaged", told)
        self.assertLess(SWEEP.stat().st_size, MOST_BYTES)

    def test_the_sweep_has_rows_of_the_present_model(self):
        header = (ROOT / "include/clog/core/parameters/parameters.hpp").read_text()
        present = int(re.search(r"int model_version = (\d+);", header)[1])
        rows = pandas.read_hdf(SWEEP, "runs")
        self.assertEqual(set(rows.model_version), {present}, f"make it anew: {SWEEP.parent}/README.md")

    def test_the_clogging_length_has_a_peak_between_wrapped_and_squeezed_clogs(self):
        groups = json.loads(self.succeed("clogfit", "sweep.h5", "--format", "json").stdout)["groups"]
        self.assertEqual([group["runs"] for group in groups], 7 * [10])
        soft, peak, *_, stiff = groups[1:]
        self.assertLess(soft["clogging_length_upper"], peak["clogging_length_lower"])
        self.assertLess(stiff["clogging_length_upper"], peak["clogging_length_lower"])
        self.assertEqual((soft["wrapped"], stiff["squeezed"]), (10, 10))

    def test_the_sweep_gives_a_picture_and_a_report(self):
        self.draw("clogging-length", "sweep.h5")
        self.assert_picture("sweep-clogging-length")
        self.draw("report", "sweep.h5", "--examples", 0)
        self.assertIn("70 of 70 runs finished", (self.folder / "sweep-report.html").read_text())


if __name__ == "__main__":
    unittest.main()
