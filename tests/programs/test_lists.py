"""Tests that Python reads lists of values as clogsweep does. The test of the reader in C++ has the same cases."""

import math
import sys
import unittest

from support import ROOT

sys.path.insert(0, str(ROOT / "analysis"))
from clogsweep.tools import lists  # noqa: E402


class Lists(unittest.TestCase):
    def test_lists_are_read_as_clogsweep_reads_them(self):
        for line in (ROOT / "tests/sweep/value_lists.txt").read_text(encoding="utf-8").splitlines():
            if line.startswith("#"):
                continue
            _, text, meaning = line.split(";")
            with self.subTest(text):
                values = lists.numbers(text)
                if meaning.startswith("!"):
                    self.assertTrue(any(map(math.isnan, values)))
                else:
                    self.assertEqual(values, [float(word) for word in meaning.split()])
