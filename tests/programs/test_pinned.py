"""Tests that --instruction-set determines every bit of a row. The other abilities of the processor must not matter."""

import os
import subprocess
import sys
import unittest
from unittest import mock

import pandas
from support import TIMING, ProgramTest, table

# With these settings the C library behaves as on a processor without fused multiply-adds.
PLAIN = {"GLIBC_TUNABLES": "glibc.cpu.hwcaps=-FMA,-FMA4,-AVX2,-AVX512F"}
COSINES = "import math; print([math.cos(0.01 * i).hex() for i in range(10000)])"

# The release of droplets with 80 vertices uses sines and cosines. If they came from the C library, their values would
# differ. Droplets with a large line tension clog soon.
POLYGONS = ["vertices=80", "box=20", "obstacle-density=saturated", "obstacle-gap=0.3", "line-tension=log(0.3,1,3)", "max-time=100", "seeds=1..3"]
# The angle of this lattice (8 columns over 69 rows) would also differ.
DISKS = ["model=sp", "wall-stiffness=10,100", "obstacle-layout=lattice", "lattice-angle=6.6135",
         "obstacle-diameter=0.3", "obstacle-gap=0.2", "box=35", "max-time=100", "seeds=1..3"]


def cosines():
    return subprocess.run([sys.executable, "-c", COSINES], check=True, capture_output=True, text=True).stdout


class Pinned(ProgramTest):
    def setUp(self):
        super().setUp()
        with_everything = cosines()
        with mock.patch.dict(os.environ, PLAIN):
            if cosines() == with_everything:
                self.skipTest("the C library has only one cosine for this processor")

    def rows(self, name, *arguments):
        self.succeed("clogsweep", *arguments, "--output", name)
        return table(self.folder / name).sort_values("task", ignore_index=True).drop(columns=TIMING)

    def same_rows(self, *arguments):
        usual = self.rows("usual.h5", *arguments)
        with mock.patch.dict(os.environ, PLAIN):
            plain = self.rows("plain.h5", *arguments)
        pandas.testing.assert_frame_equal(usual, plain, check_exact=True)
        return usual

    def has(self, instruction_set):
        return self.run_program("clogsweep", "--print-config", "--instruction-set", instruction_set).returncode == 0

    def test_polygons_with_the_baseline(self):
        rows = self.same_rows(*POLYGONS, "--instruction-set=baseline")
        self.assertIn("certified", set(rows.clogged_by))

    def test_polygons_with_avx2(self):
        if not self.has("avx2"):
            self.skipTest("this processor has no AVX2")
        rows = self.same_rows(*POLYGONS, "--instruction-set=avx2")
        self.assertIn("certified", set(rows.clogged_by))

    def test_polygons_near_walls(self):
        self.same_rows(*POLYGONS, "preset=elastic", "near-wall-drag=0.1", "near-wall-exponent=1.1",
                       "--instruction-set=baseline")

    def test_disks(self):
        rows = self.same_rows(*DISKS)
        self.assertIn("certified", set(rows.clogged_by))


if __name__ == "__main__":
    unittest.main()
