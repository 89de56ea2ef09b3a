"""Compares the break-up length in a dilute random array with the kinetic theory of gases. In this theory a droplet
meets posts at uniformly distributed offsets from its path, and breaks up if the offset is less than b."""

import math
import sys
import unittest

from support import BIN, ROOT, SweepTest, table

sys.path.insert(0, str(ROOT / "analysis"))
from clogsweep.collisions import collision  # noqa: E402

DENSITY = 0.05  # [1/sigma^2]
KEYS = {"preset": "robust", "vertices": "64", "break-up-neck": "0.08", "self-contact-range": "0.02"}
TENSION = 0.03
RUNS = 200


class DiluteArray(SweepTest):
    def largest_offset(self):
        """The largest offset from one post at which a droplet breaks up [sigma]."""
        collisions = collision.Collisions(BIN / "clogsweep", self.folder, KEYS | {"exit": "17", "max-time": "3000"})
        low, high = 0.0, 0.6
        while high - low > 0.005:
            middle = (low + high) / 2
            low, high = (middle, high) if collisions.break_up(middle, [TENSION])[0] else (low, middle)
        return (low + high) / 2

    def test_the_break_up_length_follows_from_break_up_on_one_post(self):
        self.succeed("clogsweep", *(f"{key}={value}" for key, value in KEYS.items()), f"line-tension={TENSION}",
                     f"obstacle-density={DENSITY}", "box=45", "boxes=20", "max-time=20000", f"seeds=1..{RUNS}",
                     "--output", "s.h5")
        rows = table(self.folder / "s.h5")
        self.assertEqual(set(rows.status), {"broken"})
        three_errors = 3 / math.sqrt(RUNS)  # Distances are exponentially distributed.
        break_up = rows.distance.mean() * 2 * self.largest_offset() * DENSITY
        self.assertAlmostEqual(break_up, 1, delta=three_errors)
        first_contact = rows.first_contact_at.mean() * (1 + collision.DIAMETER) * DENSITY
        self.assertAlmostEqual(first_contact, 1, delta=three_errors)


if __name__ == "__main__":
    unittest.main()
