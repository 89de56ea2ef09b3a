"""Tests that clogfit calibrate recovers the parameters of a simulated droplet. The profiles contain noise, and come in
both kinds of units."""

import json
import math
import os
import pty
import signal
import subprocess
import unittest

import h5py
import numpy as np
from support import BIN, ProgramTest, shared_sweep

LINE_TENSION, NEAR_WALL_DRAG = 0.6, 0.1
CHANNEL = ["--orifice=0.9", "vertices=64"]


class OnATerminal(ProgramTest):
    @staticmethod
    def read_some(terminal):
        try:
            return os.read(terminal, 4096)
        except OSError:  # The last writer has closed the terminal.
            return b""


class Calibrate(OnATerminal):
    def measure(self, **options):
        """Simulates a droplet with clogrun, and reads its profile."""
        run = shared_sweep("channel", f"line-tension={LINE_TENSION}", f"near-wall-drag={NEAR_WALL_DRAG}",
                           "--start=-2.5", "--end=1.3", "--sample-interval=0.3", "terminal-speed=0.05", *CHANNEL,
                           program="clogrun")
        with h5py.File(run) as file:
            table = file["trajectory"][:]
        h = np.linspace(-1.2, 1.2, 49)
        return h, np.interp(h, table["h"], table["speed_ratio"]), np.interp(h, table["h"], table["shape_parameter"])

    def test_it_recovers_what_made_the_profiles(self):
        h, v, shape = self.measure()
        chance = np.random.default_rng(1)
        noisy = [v * (1 + 0.02 * chance.standard_normal(len(v))) for _ in range(2)]
        lines = [f"{a:.5g},{b:.5g},{c:.5g}" for a, b, c in zip(h, noisy[0], shape)]
        self.write("reduced.csv", "\n".join(["h [sigma], v [v_t], A", *lines]))
        # The other file has laboratory units, which were converted by hand for a droplet of 2 mm at 3 mm/s.
        lines = [f"{25 * frame}, {2 * a:.4f}, {3 * b:.4f}" for frame, (a, b) in enumerate(zip(h, noisy[1]))]
        self.write("by_hand.csv", "\n".join(["# trial 2, 21 May", "t [ms], h [mm], v [mm/s]", *lines]))
        found = json.loads(self.succeed(
            "clogfit", "calibrate", "reduced.csv", "by_hand.csv", *CHANNEL, "terminal-speed=0.05", "--diameter=2mm",
            "--speed=3 mm/s", "--format=json").stdout)
        for trial in found["trials"]:
            self.assertLess(abs(trial["line_tension"] - LINE_TENSION), 3 * trial["line_tension_error"])
            self.assertLess(abs(trial["near_wall_drag"] - NEAR_WALL_DRAG), 3 * trial["near_wall_drag_error"] + 1e-3)
            self.assertLess(trial["line_tension_error"], 0.05)
            self.assertLess(trial["near_wall_drag_error"], 0.005)
            self.assertAlmostEqual(trial["delta_v"], 0.02, delta=0.008)
            self.assertFalse([warning for warning in trial["warnings"] if "V_t" in warning])
        self.assertLess(found["trials"][0]["delta_a"], 0.003)
        self.assertIsNone(found["trials"][1]["delta_a"])
        tensions = [trial["line_tension"] for trial in found["trials"]]
        self.assertAlmostEqual(found["line_tension"], sum(tensions) / 2)
        self.assertAlmostEqual(found["line_tension_deviation"], abs(tensions[0] - tensions[1]) / math.sqrt(2))

    def test_it_says_that_no_droplet_moves_like_that(self):
        self.write("odd.csv", "\n".join(["h [sigma], v [v_t]", *(f"{0.1 * i},{2 + i % 2}" for i in range(-5, 6))]))
        trial, = json.loads(self.succeed("clogfit", "calibrate", "odd.csv", *CHANNEL, "terminal-speed=0.05", "--format=json").stdout)["trials"]
        self.assertGreater(trial["delta_v"], 0.2)
        self.assertTrue(any("Delta_v is large" in warning for warning in trial["warnings"]), trial["warnings"])

    def test_a_wrong_terminal_speed_shows_in_the_shape_of_the_residuals(self):
        h, v, _ = self.measure()
        noisy = v * (1 + 0.02 * np.random.default_rng(5).standard_normal(len(v)))
        self.write("wrong.csv",
                   "\n".join(["h [sigma], v [v_t]", *(f"{a:.5g},{1.25 * b:.5g}" for a, b in zip(h, noisy))]))
        printed = self.succeed("clogfit", "calibrate", "wrong.csv", *CHANNEL, "terminal-speed=0.05").stdout
        self.assertTrue(printed.startswith("channel: orifice=0.9 wedge-angle=45 "), printed)
        self.assertRegex(printed, r"note: wrong.csv: the speeds of successive frames differ alike .*look at V_t")

    def test_a_signal_ends_it_with_the_best_so_far(self):
        self.write("trial.csv",
                   "\n".join(["h [sigma], v [v_t]", *(f"{0.1 * i},{1 - 0.05 * (i % 3)}" for i in range(-10, 11))]))
        ours, theirs = pty.openpty()
        self.addCleanup(os.close, ours)
        # The calibration is stopped early, because it would take minutes.
        with subprocess.Popen([BIN / "clogfit", "calibrate", "trial.csv", "--orifice=0.7",
                               "vertices=256", "--format=json"], cwd=self.folder,
                              stdout=subprocess.PIPE, stderr=theirs) as process:
            os.close(theirs)
            printed = b""
            while b"Delta_v" not in printed and (some := self.read_some(ours)):
                printed += some
            process.send_signal(signal.SIGINT)
            while some := self.read_some(ours):
                printed += some
            self.assertEqual(process.stdout.read(), b"")
        self.assertEqual(process.returncode, 75, printed)
        best = r"Delta_v down to \S+, with Gamma = [0-9.e+-]+, b_0/b_inf = [0-9.e+-]+"
        self.assertRegex(printed.decode(), rf"\r\d+ simulations?, {best}, ")
        self.assertRegex(printed.decode(), rf"clogfit calibrate: stopped by a signal; trial.csv: {best}\r\n$")

    def test_it_reads_only_channel_runs_of_clogrun(self):
        keys = ["vertices=32", "line-tension=0.3", "terminal-speed=0.3"]
        self.succeed("clogrun", "channel", "--output", "channel.h5", "--orifice=0.9",
                     "--start=-2.5", "--end=1.3", *keys)
        self.succeed("clogrun", "array", "--output", "array.h5", "box=20", "max-time=1", *keys)
        self.succeed("clogsweep", "--output", "sweep.h5", "box=20", "max-time=1", "seeds=1", *keys)
        self.succeed("clogrun", "channel", "--output", "clogged.h5", "--orifice=0.5", "--start=-1.5", "vertices=32",
                     "line-tension=3", "terminal-speed=0.3")
        content = bytearray((self.folder / "channel.h5").read_bytes())
        content[len(content) // 2] ^= 1
        (self.folder / "damaged.h5").write_bytes(content)
        (self.folder / "cut.h5").write_bytes(content[:len(content) // 2])
        found, = json.loads(self.succeed("clogfit", "deviation", "channel.h5", "channel.h5").stdout)["deviations"]
        self.assertEqual((found["delta_v"], found["delta_a"]), (0, 0))
        for arguments, words in [(["channel.h5", "--orifice=0.7", *keys[2:]], ["channel.h5", "orifice=0.9, not 0.7"]),
                                 (["channel.h5", "--orifice=0.9",
                                   "terminal-speed=0.03"], ["channel.h5", "terminal-speed=0.3, not 0.03"]),
                                 (["clogged.h5", "--orifice=0.5",
                                   "terminal-speed=0.3"], ["clogged.h5", "it clogged", "give a droplet that passed"]),
                                 (["array.h5"], ["array.h5", "not a passage"]),
                                 (["sweep.h5"], ["sweep.h5", "not a passage"]),
                                 (["damaged.h5"], ["damaged.h5", "damaged"]), (["cut.h5"], ["cut.h5", "damaged"]),]:
            with self.subTest(arguments=arguments):
                self.refuse("clogfit", "calibrate", *arguments, words=words)
        with h5py.File(self.folder / "clogged.h5") as file:
            self.assertEqual(file["runs"]["status"][0], b"clogged")
        with h5py.File(self.folder / "channel.h5", "a") as file:
            file.attrs["note"] = "changed by hand"  # This removes the seal.
        done = self.succeed("clogfit", "deviation", "channel.h5", "channel.h5")
        self.assertIn("may go unnoticed", done.stderr)

    def test_commands_in_python_have_the_version_of_the_programs(self):
        version = self.succeed("clogfit", "--version").stdout
        for command in ("calibrate", "curve", "deviation", "drag", "report"):
            self.assertEqual(self.succeed("clogfit", command, "--version").stdout,
                             version.replace("clogfit", f"clogfit {command}", 1))

    def test_its_help_says_what_the_errors_leave_out(self):
        self.assertIn("so without noise they are too small", self.succeed("clogfit", "calibrate", "--help").stdout)

    def test_mistakes_get_one_line_and_exit_code_2(self):
        self.write("p.csv", "h [mm],v [mm/s]\n-1,1\n0,0.5\n1,1\n")
        for arguments, words in [
            ([], ["missing profile"]),
            (["nowhere.csv"], ["cannot read nowhere.csv"]),
            (["p.csv"], ["p.csv line 1", "--diameter"]),
            (["p.csv", "--diameter=2", "--speed=3mm/s"], ["--diameter=2", "has no unit"]),
            (["p.csv", "--diameter=-2mm", "--speed=3mm/s"], ["--diameter=-2mm", "positive"]),
            (["p.csv", "--diameter=2mm", "--speed=3mm/s"], ["missing orifice", "orifice=0.8"]),
            (["p.csv", "--angle=8deg"], ["--angle needs --diameter"]),
            (["p.csv", "--tension=10mN/m"], ["--tension needs"]),
            (["p.csv", "--density=1g/ml", "--outer-density=1g/ml"], ["density and outer-density are equal"]),
            (["p.csv", "line-tension=1"], ["--line-tension is what"]),
            (["p.csv", "--diameter=2mm", "--speed=3mm/s", "vertices=64,128"], ["2 runs, but one is needed"]),
            (["p.csv", "--diameter=2mm", "--speed=3mm/s", "--format=xml"], ["--format=xml"]),
            (["p.csv", "--diameter=2mm", "--speed=3mm/s", "--orifice=0.01"], ["orifice"]),
        ]:
            with self.subTest(arguments=arguments):
                self.refuse("clogfit", "calibrate", *arguments, words=words)


if __name__ == "__main__":
    unittest.main()
