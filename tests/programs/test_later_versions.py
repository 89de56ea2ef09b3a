"""Tests that every version 1.x reads a sweep that version 1.0.0 wrote, and that a version with another model_version
than 11 refuses to continue this sweep.

    clogsweep line-tension=1,3 model=dp vertices=32 obstacle-gap=0.2 obstacle-density=0.5 box=20 boxes=2 max-time=1000 \
        seeds=1..4 --instruction-set=baseline --output written-by-1.0.0.h5
"""

import gzip
import json
import pathlib
import unittest

import h5py

from drawing import Analysis
from support import BIN, table

import clogsweep

DATA = pathlib.Path(__file__).parent / "data"
COMMAND = ["line-tension=1,3", "model=dp", "vertices=32", "obstacle-gap=0.2", "obstacle-density=0.5", "box=20", "boxes=2",
           "max-time=1000", "seeds=1..4", "--instruction-set=baseline"]
OTHER_MODEL = "model version 11, this program"


class LaterVersions(Analysis):
    def setUp(self):
        super().setUp()
        (self.folder / "s.h5").write_bytes(gzip.decompress((DATA / "written-by-1.0.0.h5.gz").read_bytes()))

    def test_it_has_the_format_and_the_model_version_of_1_0_0(self):
        with h5py.File(self.folder / "s.h5") as file:
            self.assertEqual((file.attrs["version"], file.attrs["format_version"]), (b"1.0.0", b"10"))
            self.assertEqual(set(file["runs"]["model_version"]), {11})
            self.assertNotIn("sound_distance", file["runs"].dtype.names)

    def test_resume_refuses_it_with_one_line(self):
        longer = [word.replace("1..4", "1..5") for word in COMMAND]
        for command in (COMMAND, longer, [*COMMAND, "--until-precision=20%"], [*COMMAND[:-2], "--seeds-per-set=5"]):
            self.refuse("clogsweep", *command, "--output", "s.h5", words=["cannot resume s.h5", OTHER_MODEL])

    def test_its_runs_are_neither_repeated_nor_joined_with_others(self):
        self.refuse("clogsweep", "replay", "s.h5", 0, words=[OTHER_MODEL, "use the version that wrote the file"])
        self.refuse("clogrun", "replay", "s.h5", 0, "--output", "r.h5", words=[OTHER_MODEL])
        self.succeed("clogsweep", *COMMAND, "--output", "new.h5")
        self.refuse("clogsweep", "merge", "s.h5", "new.h5", "--output", "all.h5", words=["model versions 11 and "])

    def test_programs_read_it(self):
        self.succeed("clogsweep", "verify", "s.h5")
        rows = table(self.folder / "s.h5")
        fit = json.loads(self.succeed("clogfit", "s.h5", "--format", "json").stdout)
        for group, (tension, mine) in zip(fit["groups"], rows.groupby("line_tension"), strict=True):
            clogs = (mine.status == "clogged").sum()
            self.assertEqual((group["line_tension"], group["runs"], group["clogs"]), (tension, 4, clogs))
            self.assertAlmostEqual(group["clogging_length"], mine.distance.sum() / clogs, places=12)
            self.assertIsNone(group["relative_speed_steady"])
            self.assertEqual(group["failed"], 0)
        for arguments in (["s.h5"], ["s.h5", "--dwell=50"], ["compare", "s.h5", "--by", "line-tension"],
                          ["report", "s.h5", "--examples", 0]):
            self.succeed("clogfit", *arguments)

    def test_parts_of_it_are_whole_sweeps(self):
        self.succeed("clogsweep", "salvage", "s.h5", "--output", "salvaged.h5")
        for name, condition in (("one.h5", "seed<=2"), ("other.h5", "seed>=2")):
            self.succeed("clogsweep", "select", "s.h5", condition, "--output", name)
        self.succeed("clogsweep", "merge", "one.h5", "other.h5", "--output", "merged.h5")
        for name, number in (("s.h5", 8), ("salvaged.h5", 8), ("one.h5", 4), ("other.h5", 6), ("merged.h5", 8)):
            printed = self.succeed("clogsweep", "status", name).stdout
            self.assertIn(f"{name}: {number} of {number} runs finished, {number} clogged", printed)
            self.succeed("clogsweep", "verify", name)

    def test_python_reads_it(self):
        sweep = clogsweep.open(self.folder / "s.h5", BIN)
        self.assertEqual(len(sweep.rows), 8)
        fit = sweep.fit()
        self.assertEqual(fit.groups.runs.tolist(), [4, 4])
        self.assertEqual(fit.survival(0).at_risk.tolist(), [4, 4, 3, 2, 1])
        self.assertEqual(sweep.status()["clogged"], 8)
        for command in ("clogging-length", "dwell"):
            self.draw(command, "s.h5", "--programs", BIN)
        self.draw("export", "s.h5", "rows.csv", "--programs", BIN)


if __name__ == "__main__":
    unittest.main()
