"""Tests that every key of a sweep can be drawn on a page."""

import unittest

import test_schema
from support import BIN


class EveryKey(test_schema.Sweeps):
    def test_a_sweep_over_any_key_has_a_page(self):
        for key in self.keys():
            with self.subTest(key=key["key"]):
                self.sweep(key["key"])
                # The page has curves, and a clog that was replayed.
                self.draw("report", "s.h5", "--programs", BIN, "--output", "r.html", "--examples", 1)
                page = (self.folder / "r.html").read_text()
                self.assertIn("touched obstacles blue", page)
                if key["role"] != "ensemble":
                    column = "diameter_mm" if key["key"] == "laboratory" else key["column"]
                    self.assertIn(f'<th scope="col">{column.replace("_", " ")}</th>', page)


if __name__ == "__main__":
    unittest.main()
