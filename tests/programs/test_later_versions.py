"""Tests that every version 1.x reads a sweep that version 1.0.0 wrote. A version with the same model_version (11) also
computes the same rows, and continues the sweep. A version with another model_version must refuse to continue the sweep.
These tests then have to be changed.

    clogsweep line-tension=1,3 model=dp vertices=32 obstacle-gap=0.2 obstacle-density=0.5 box=20 boxes=2 max-time=1000 \
        seeds=1..4 --instruction-set=baseline --output written-by-1.0.0.h5
"""

import gzip
import pathlib
import unittest

import pandas
from drawing import Analysis
from support import TIMING, table

import clogsweep

DATA = pathlib.Path(__file__).parent / "data"
COMMAND = ["line-tension=1,3", "model=dp", "vertices=32", "obstacle-gap=0.2", "obstacle-density=0.5", "box=20", "boxes=2",
           "max-time=1000", "seeds=1..4", "--instruction-set=baseline"]
OUTCOME = ["task", "seed", "line_tension", "status", "clogged_by", "mechanism", "distance"]


class LaterVersions(Analysis):
    def setUp(self):
        super().setUp()
        (self.folder / "s.h5").write_bytes(gzip.decompress((DATA / "written-by-1.0.0.h5.gz").read_bytes()))

    def test_its_rows_are_those_of_this_version(self):
        rows = table(self.folder / "s.h5")
        self.assertEqual(len(rows), 8)
        self.succeed("clogsweep", *COMMAND, "--output", "again.h5")
        again = table(self.folder / "again.h5")
        self.assertLessEqual(set(rows.columns), set(again.columns))
        rows, again = (one.drop(columns=TIMING).sort_values("task", ignore_index=True) for one in (rows, again[rows.columns]))
        compilers = {clogsweep.open(self.folder / file).attributes["compiler"] for file in ("s.h5", "again.h5")}
        if len(compilers) == 1:
            pandas.testing.assert_frame_equal(rows, again, check_exact=True)
        else:  # Other instruction sets may round differently.
            pandas.testing.assert_frame_equal(rows[OUTCOME], again[OUTCOME], rtol=1e-4)

    def test_more_seeds_continue_it(self):
        self.succeed("clogsweep", *[word.replace("1..4", "1..5") for word in COMMAND], "--output", "s.h5")
        self.assertEqual(len(table(self.folder / "s.h5")), 10)

    def test_programs_and_python_read_it(self):
        self.succeed("clogsweep", "verify", "s.h5")
        self.assertIn("lambda", self.succeed("clogfit", "s.h5").stdout)
        sweep = clogsweep.open(self.folder / "s.h5")
        self.assertEqual(sweep.fit().groups.runs.tolist(), [4, 4])


if __name__ == "__main__":
    unittest.main()
