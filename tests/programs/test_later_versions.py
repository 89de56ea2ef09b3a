"""Tests that every version 1.x reads a sweep that version 1.0.0 wrote, and that a version with another model_version
than 11 refuses to continue this sweep.

    clogsweep line-tension=1,3 model=dp vertices=32 obstacle-gap=0.2 obstacle-density=0.5 box=20 boxes=2 max-time=1000 \
        seeds=1..4 --instruction-set=baseline --output written-by-1.0.0.h5
"""

import gzip
import pathlib
import unittest

from drawing import Analysis

import clogsweep

DATA = pathlib.Path(__file__).parent / "data"
COMMAND = ["line-tension=1,3", "model=dp", "vertices=32", "obstacle-gap=0.2", "obstacle-density=0.5", "box=20", "boxes=2",
           "max-time=1000", "seeds=1..4", "--instruction-set=baseline"]


class LaterVersions(Analysis):
    def setUp(self):
        super().setUp()
        (self.folder / "s.h5").write_bytes(gzip.decompress((DATA / "written-by-1.0.0.h5.gz").read_bytes()))

    def test_resume_refuses_it_with_one_line(self):
        before = (self.folder / "s.h5").read_bytes()
        self.refuse("clogsweep", *[word.replace("1..4", "1..5") for word in COMMAND], "--output", "s.h5", words=["model version 11, this program"])
        self.assertEqual((self.folder / "s.h5").read_bytes(), before)

    def test_programs_and_python_read_it(self):
        self.succeed("clogsweep", "verify", "s.h5")
        self.assertIn("lambda", self.succeed("clogfit", "s.h5").stdout)
        sweep = clogsweep.open(self.folder / "s.h5")
        self.assertEqual(sweep.fit().groups.runs.tolist(), [4, 4])


if __name__ == "__main__":
    unittest.main()
