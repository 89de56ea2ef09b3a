"""Tests clogfit calibrate with a droplet that nearly clogs. Such a droplet takes the most simulations."""

import json
import os
import pty
import subprocess
import threading
import unittest

import h5py
import numpy as np

import test_calibrate
from support import BIN, ROOT


class Calibrate(test_calibrate.OnATerminal):
    def test_it_finds_what_made_a_passage_close_to_a_clog(self):
        # A droplet with a line tension that is 2 % larger clogs. Near this line tension Delta_v has narrow minima.
        line_tension, near_wall_drag = 1.0, 0.07
        keys = ["--orifice=0.7", "vertices=48", "terminal-speed=0.05"]
        self.succeed("clogrun", "channel", "--output", "channel.h5", f"line-tension={line_tension}",
                     f"near-wall-drag={near_wall_drag}", "--start=-2.2", "--end=1.3", *keys)
        with h5py.File(self.folder / "channel.h5") as file:
            table = file["trajectory"][:]
        h = np.linspace(-1.2, 1.2, 49)
        noise = 0.02 * np.random.default_rng(2).standard_normal(len(h))
        v = np.interp(h, table["h"], table["speed_ratio"]) * (1 + noise)
        self.write("noisy.csv", "\n".join(["h [sigma], v [v_t]", *(f"{a:.5g},{b:.5g}" for a, b in zip(h, v))]))
        found = self.calibrate_on_a_terminal("noisy.csv", "channel.h5", *keys)
        noisy, exact = found["trials"]
        self.assertLess(abs(noisy["line_tension"] - line_tension), 3 * noisy["line_tension_error"])
        self.assertLess(abs(noisy["near_wall_drag"] - near_wall_drag), 3 * noisy["near_wall_drag_error"])
        self.assertLess(noisy["line_tension_error"], 0.005)
        self.assertLess(noisy["delta_v"], 0.03)
        self.assertAlmostEqual(exact["line_tension"], line_tension, delta=0.002)
        self.assertAlmostEqual(exact["near_wall_drag"], near_wall_drag, delta=0.001)
        self.assertLess(exact["delta_v"], 0.005)
        for trial in (noisy, exact):
            self.assertTrue(trial["converged"])
            self.assertLess(trial["clogging_tension"], 1.1)
            self.assertIn("close to a clog", " ".join(trial["warnings"]))

    def test_it_finds_what_version_0_2_0_found(self):
        record = json.loads((ROOT / "tests" / "programs" / "records" / "calibrate.json").read_text())
        for expected in record["trials"][:2]:  # The third trial is no passage of a droplet.
            with self.subTest(profile=expected["profile"]):
                self.write(expected["profile"], record["profiles"][expected["profile"]])
                found, = json.loads(self.succeed("clogfit", "calibrate", expected["profile"], *record["keys"], "--format=json").stdout)["trials"]
                self.assertEqual(found.keys(), expected.keys())
                for name in ("line_tension", "near_wall_drag"):
                    self.assertAlmostEqual(found[name], expected[name], delta=0.1 * expected[f"{name}_error"])
                self.assertEqual(found["warnings"], expected["warnings"])

    def calibrate_on_a_terminal(self, *arguments):
        """Runs clogfit calibrate with a terminal as the standard error, so that it shows its progress."""
        ours, theirs = pty.openpty()
        self.addCleanup(os.close, ours)
        shown = []
        with subprocess.Popen([BIN / "clogfit", "calibrate", *arguments, "--format=json"], cwd=self.folder,
                              stdout=subprocess.PIPE, stderr=theirs, text=True) as process:
            os.close(theirs)
            reader = threading.Thread(target=lambda: shown.extend(iter(lambda: self.read_some(ours), b"")))
            reader.start()
            printed = process.stdout.read()
            reader.join()
        text = b"".join(shown).decode()
        self.assertEqual(process.returncode, 0, text)
        self.assertRegex(text, r"\r\d+ simulations, 0/2 trials done, Delta_v down to ")
        return json.loads(printed)


if __name__ == "__main__":
    unittest.main()
