"""Tests devices that a user drew. These tests need long runs."""

import unittest

import test_device


class Devices(test_device.Walls):
    def test_droplets_slide_along_a_steep_row_of_circles_as_along_a_flat_wall(self):
        self.slide(75, 0.004)


if __name__ == "__main__":
    unittest.main()
