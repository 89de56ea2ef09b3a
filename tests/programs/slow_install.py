"""Builds a program against an installation, which takes a compiler half a minute."""

import shutil
import unittest

import pandas

from support import BIN
from test_install import KEYS, Installation


class Built(Installation):
    def test_a_program_of_ones_own_finds_what_the_sweep_finds(self):
        example = self.folder / "example"
        shutil.copytree(self.prefix / "share/doc/clogsweep/docs/examples/own-program", example)
        build_type = "-DCMAKE_BUILD_TYPE=Release"
        flags = ["-DCMAKE_CXX_FLAGS=-fsanitize=address,undefined"] if "CLOG_SANITIZE:BOOL=ON" in (BIN.parent / "CMakeCache.txt").read_text() else []
        self.called("cmake", "-S", example, "-B", example / "build", f"-DCMAKE_PREFIX_PATH={self.prefix}", build_type, *flags)
        self.called("cmake", "--build", example / "build")
        said = self.called(example / "build/own-program").splitlines()
        self.called("clogsweep", *KEYS, "--output", "own.h5")
        rows = pandas.read_hdf(self.folder / "own.h5", "runs").sort_values("seed")
        for line, row in zip(said[:-1], rows.itertuples(), strict=True):
            self.assertEqual(line, f"seed {row.seed}: {row.status} after {row.distance:.17g} sigma")
        self.assertRegex(said[-1], r"^lambda = \S+ sigma \(95 %: ")


if __name__ == "__main__":
    unittest.main()
