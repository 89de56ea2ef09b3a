"""Compares mean speeds of runs of different lengths. The speed must not depend on the length."""

import json
import math
import unittest

from support import ProgramTest

# Stiff disks in gaps of 1, as in figure 9a. The array is longer than any path. No parameter of the programs was chosen
# by means of the seeds in this file.
STIFF = ["model=sp", "wall-stiffness=100", "obstacle-density=saturated", "obstacle-gap=1",
         "obstacle-diameter=0.3", "box=45", "boxes=12"]


class Speeds(ProgramTest):
    def group(self, max_time, seeds):
        file = f"{max_time}-{seeds}.h5"
        self.succeed("clogsweep", *STIFF, f"max-time={max_time}", f"seeds={seeds}", "--output", file)
        group, = json.loads(self.succeed("clogfit", file, "--format", "json").stdout)["groups"]
        return group

    def assert_equal(self, one, other, number_of_errors=2):
        """Checks that two independent speeds are equal within some standard errors of their difference."""
        error = math.hypot(*(group["relative_speed_steady_error"] for group in (one, other)))
        self.assertLess(abs(one["relative_speed_steady"] - other["relative_speed_steady"]), number_of_errors * error)

    def test_the_steady_speed_does_not_depend_on_how_long_runs_are(self):
        # Each length has its own 400 seeds, so that the speeds are independent.
        groups = [self.group(max_time, seeds)
                  for max_time, seeds in ((500, "5001..5400"), (3000, "5401..5800"), (20000, "5801..6200"))]
        self.assertEqual([group["relative_speed_steady_runs"] for group in groups], [400] * 3)
        self.assertLess(groups[0]["relative_speed_steady_error"], 0.008)
        short, middle, long = groups
        for one, other in ((short, middle), (short, long), (middle, long)):
            self.assert_equal(one, other)
        # In short runs, the mean of the speeds of single runs is known to be too high. The number of runs must suffice
        # to detect this error.
        bias = short["relative_speed"] - long["relative_speed"]
        self.assertGreater(bias, 4 * math.hypot(short["relative_speed_error"], long["relative_speed_error"]))

    def test_the_fixed_start_is_late_enough(self):
        # Short runs measure the steady speed between 167 and 300 t0, where an effect of the release would be largest.
        # There are ten times as many short runs as long runs. The speed from the release on is clearly higher.
        short, long = self.group(300, "20001..28000"), self.group(20000, "28001..28800")
        self.assert_equal(short, long)
        error = math.hypot(short["relative_speed_all_error"], long["relative_speed_steady_error"])
        self.assertGreater(short["relative_speed_all"] - long["relative_speed_steady"], 4 * error)


if __name__ == "__main__":
    unittest.main()
