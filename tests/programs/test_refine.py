"""--refine: values and seeds are put where the fitted curve needs them, the same ones however the sweep goes."""

import json
import math
import os
import re
import subprocess
import sys
import unittest

import h5py
import pandas
from support import BIN, QUICK, ROOT, TIMING, ProgramTest, shared_sweep, table

SWEEP = [*QUICK, "obstacle-gap=0.3", "seeds=1..3", "line-tension=0.3,3", "--refine=line-tension", "--most-seeds=12"]
GOAL = "--until=curve=70%"


class Refine(ProgramTest):
    def check_equal(self, name, other):
        rows, others = (table(self.folder / n).drop(columns=TIMING) for n in (name, other))
        pandas.testing.assert_frame_equal(rows, others, check_exact=True)

    def test_it_adds_values_and_seeds_until_the_curve_is_known(self):
        done = self.succeed("clogsweep", *SWEEP, GOAL, "--output", "s.h5", ranks=2)
        rows = table(self.folder / "s.h5")
        self.assertGreater(len(rows), 7 * 3)
        self.assertTrue(rows.line_tension.between(0.3, 3).all())
        self.assertTrue(all(value == float(f"{value:.3g}") for value in rows.line_tension))
        self.assertLessEqual(rows.groupby("line_tension").size().max(), 12)
        self.assertEqual(rows.seed.nunique(), len(rows), "values have seeds of their own")
        last = done.stderr.strip().splitlines()[-1]
        for words in ("lambda is known within", "% along the curve", "highest at line-tension"):
            self.assertIn(words, last)
        with h5py.File(self.folder / "s.h5") as file:
            self.assertIn("until curve=70%", file.attrs["stopping_rule"].decode())
            self.assertIn("round-keys = line-tension seeds", file.attrs["config"].decode())
        status = json.loads(self.succeed("clogsweep", "status", "s.h5", "--format=json").stdout)
        self.assertEqual((status["runs"], status["finished"]), (len(rows), len(rows)))
        self.succeed("clogsweep", "verify", "s.h5")
        self.assertIn("the same bits", self.succeed("clogsweep", "replay", "s.h5", rows.task.max()).stdout)
        again = self.succeed("clogsweep", *SWEEP, GOAL, "--output", "s.h5")
        self.assertEqual(again.stderr.strip().splitlines()[-1], last)
        self.assertEqual(len(table(self.folder / "s.h5")), len(rows))

    def test_the_rows_depend_neither_on_ranks_nor_on_interruptions_nor_on_isolation(self):
        whole = shared_sweep(*SWEEP, GOAL)
        self.succeed("clogsweep", *SWEEP, GOAL, "--isolate=no", "--output", "three.h5", ranks=3)
        self.check_equal("three.h5", whole)
        stopped, hours = 0, 0.0001
        while self.run_program("clogsweep", *SWEEP, GOAL, "--output", "stopped.h5", f"--max-hours={hours}").returncode == 75:
            stopped += 1
            hours *= 1.1  # on a machine that is busy a session may come to nothing
            self.assertLess(stopped, 200)
        self.assertGreater(stopped, 0)
        self.check_equal("stopped.h5", whole)

    def test_a_sweep_that_is_there_informs_it(self):
        self.succeed("clogsweep", *QUICK, "obstacle-gap=0.3", "line-tension=0.5,0.9,1.7", "seeds=1..10", "--output", "s.h5")
        self.succeed("clogsweep", *SWEEP, "--until=curve=95%", "--output", "s.h5")
        rows = table(self.folder / "s.h5")
        self.assertEqual((rows.line_tension == 0.9).sum(), 10)
        self.assertGreaterEqual(len(rows), 30 + 7 * 3 - 3)

    def test_all_values_may_have_the_same_seeds(self):
        self.succeed("clogsweep", *SWEEP, "--until=curve=90%", "--same-seeds", "--output", "s.h5")
        rows = table(self.folder / "s.h5")
        for _, of_value in rows.groupby("line_tension"):
            self.assertEqual(sorted(of_value.seed), list(range(1, len(of_value) + 1)))

    def test_a_budget_ends_it(self):
        done = self.succeed("clogsweep", *SWEEP, "--budget=0.000001h", "--output", "s.h5")
        self.assertEqual(len(table(self.folder / "s.h5")), 7 * 3)
        self.assertIn("the budget is used up", done.stderr)

    def test_a_dry_run_tells_what_the_rounds_may_cost(self):
        told = self.succeed("clogsweep", *SWEEP, "--until=curve=20%", "--dry-run").stdout
        for words in ("21 tasks: 7 parameter sets, 3 seeds each", "this is the first round", "if every run clogs"):
            self.assertIn(words, told)
        told = self.succeed("clogsweep", *SWEEP, "--budget=10h", "--dry-run").stdout
        self.assertIn("10 core-hours at most", told)

    def test_mistakes_get_one_line_and_exit_code_2(self):
        good = [word for word in SWEEP if not word.startswith("line-tension")]
        for settings, words in [
            (["line-tension=0.3,3"], ["--refine needs an end"]),
            (["line-tension=0.3,3", "--budget=0"], ["--budget=0"]),
            (["line-tension=0.3,3", "--until=curve"], ["--until=curve"]),
            (["line-tension=0.3,3", "--until=curve=0%"], ["--until=curve=0%"]),
            (["line-tension=0.3,3", "--until=slope=10%"], ["--until=slope=10%", "curve, peak, crossing"]),
            (["line-tension=0.3,3", "--until=crossing=5%"], ["--until=crossing=5%"]),
            (["line-tension=3,0.3", GOAL], ["line-tension=3,0.3", "lower bound"]),
            (["line-tension=0.3", GOAL], ["line-tension=0.3", "bounds"]),
            (["line-tension=0,3", GOAL], ["line-tension=0,3", "positive"]),
            (["line-tension=0.3cm,3", GOAL], ["line-tension=0.3cm,3"]),
            (["line-tension=0.3,3", "obstacle-gap=0.3,0.4", GOAL], ["obstacle-gap"]),
            (["line-tension=0.3,3", "seeds=1,3", GOAL], ["seeds=1,3"]),
            (["line-tension=0.3,3", GOAL, "--until-precision=20%"], ["--until-precision"]),
            (["line-tension=0.3,3", GOAL, "--refine=vertices"], ["refine"]),
            (["line-tension=3", "obstacle-gap=0.3,0.5", GOAL, "--refine=obstacle-gap"], ["obstacle_density changes with it"]),
            (["line-tension=3", "obstacle-gap=0.3,0.5", "obstacle-density=65%", GOAL, "--refine=obstacle-gap"], ["obstacle_density changes with it"]),
            (["line-tension=3", "obstacle-density=0.3,1", GOAL, "--refine=obstacle-density"], ["--refine=obstacle-density"]),
            (["line-tension=0.3,3", "obstacle-density=0.3,1", GOAL, "--refine=line-tension,obstacle-density"], ["--refine=line-tension,obstacle-density"]),
            (["line-tension=3", "perimeter-stiffness-ratio=5,9", "preset=elastic", GOAL, "--refine=perimeter-stiffness-ratio"], ["rows have no column"]),
        ]:
            with self.subTest(settings=settings):
                kept = [word for word in good if word.split("=")[0] not in {setting.split("=")[0] for setting in settings}]
                self.refuse("clogsweep", *kept, *settings, "--output", "no.h5", words=words)
                self.assertFalse((self.folder / "no.h5").exists())
        self.refuse("clogsweep", *QUICK, "line-tension=0.3,3", GOAL, "--output", "no.h5", words=["--until needs --refine"])


# Three seconds of a core: droplets follow the rows up to about 19 degrees.
LATTICE = ["obstacle-layout=lattice", "obstacle-gap=2", "obstacle-diameter=1", "vertices=64", "terminal-speed=0.1", "max-time=1000", "box=100", "seeds=1",
           "lattice-angle=10.01,40", "--refine=lattice-angle"]
ANGLE = "--until=critical-angle=2"


class CriticalAngle(ProgramTest):
    def test_it_is_bracketed_by_rows_that_droplets_follow_and_rows_that_they_leave(self):
        done = self.succeed("clogsweep", *LATTICE, ANGLE, "--output", "s.h5", ranks=2)
        last = done.stderr.strip().splitlines()[-1]
        found = re.search(r"the critical angle is ([0-9.]+) degrees \(([0-9.]+) to ([0-9.]+)\)", last)
        self.assertTrue(found, last)
        middle, lower, upper = map(float, found.groups())
        self.assertLess(lower, middle)
        self.assertLess(middle, upper)
        self.assertLessEqual(upper - lower, 2)
        rows = table(self.folder / "s.h5")
        self.assertLess(len(rows), 15)
        for row in rows.itertuples():
            # Along the rows the slope is their tangent; a droplet that leaves them goes to the other side.
            if row.lattice_angle <= lower + 0.01:
                self.assertLess(math.tan(math.radians(row.lattice_angle)) - row.lateral_displacement / row.distance, 0.05)
            else:
                self.assertLess(row.lateral_displacement, 0)
        with h5py.File(self.folder / "s.h5") as file:
            self.assertIn("until critical-angle=2", file.attrs["stopping_rule"].decode())
        self.succeed("clogsweep", "verify", "s.h5")
        again = self.succeed("clogsweep", *LATTICE, ANGLE, "--output", "s.h5")
        self.assertEqual(again.stderr.strip().splitlines()[-1], last)
        finer = self.succeed("clogsweep", *LATTICE, "--until=critical-angle=0.5", "--output", "s.h5")
        self.assertIn("critical-angle=0.5 is reached", finer.stderr)
        self.assertGreater(len(table(self.folder / "s.h5")), len(rows))

    def test_the_rows_depend_neither_on_ranks_nor_on_interruptions(self):
        stopped, hours = 0, 0.0001
        while self.run_program("clogsweep", *LATTICE, ANGLE, "--output", "stopped.h5", f"--max-hours={hours}", ranks=3).returncode == 75:
            stopped += 1
            hours *= 1.1
            self.assertLess(stopped, 200)
        paths = (shared_sweep(*LATTICE, ANGLE), self.folder / "stopped.h5")
        rows, others = (table(path).drop(columns=TIMING) for path in paths)
        pandas.testing.assert_frame_equal(rows, others, check_exact=True)

    def test_what_does_not_bracket_it_is_said(self):
        def known(angles, max_time=1000):
            keys = [key for key in LATTICE if not key.startswith(("max-time", "lattice-angle"))]
            return self.succeed("clogsweep", *keys, f"lattice-angle={angles}", f"max-time={max_time}", ANGLE, "--output", "s.h5").stderr.splitlines()[-1]

        self.assertIn("at 32.47 degrees droplets leave the rows; try smaller angles", known("32.5,35,40"))
        (self.folder / "s.h5").unlink()
        self.assertIn("droplets follow the rows; try larger angles", known("9.46,10.01,11.31"))
        (self.folder / "s.h5").unlink()
        self.assertIn("no droplet went far enough", known("10.01,40", max_time=20))

    def test_a_dry_run_tells_what_the_rounds_may_cost(self):
        told = self.succeed("clogsweep", *LATTICE, "--until=critical-angle=0.5", "--dry-run").stdout
        for words in ("5 tasks: 5 parameter sets, 1 seed each", "this is the first round", "takes about 2 more rounds, 6 runs"):
            self.assertIn(words, told)

    def test_mistakes_get_one_line_and_exit_code_2(self):
        for settings, words in [
            (["--until=curve=20%"], ["--until=curve=20%", "critical-angle=0.5"]), (["--until=critical-angle=0"], ["critical-angle=0"]),
            (["--until=critical-angle=1 degree"], ["degree"]), ([ANGLE, "--same-seeds"], ["--same-seeds"]), ([ANGLE, "--most-seeds=10"], ["--most-seeds"]),
            ([], ["--refine needs an end"]),
        ]:
            with self.subTest(settings=settings):
                self.refuse("clogsweep", *LATTICE, *settings, "--output", "no.h5", words=words)
        for angles, words in [("20", ["lattice-angle=20", "bounds"]), ("0,40", ["above 0"]), ("40,10", ["lower bound"])]:
            with self.subTest(angles=angles):
                self.refuse("clogsweep", *LATTICE[:-2], "--refine=lattice-angle", f"lattice-angle={angles}", ANGLE, "--output", "no.h5", words=words)
        self.refuse("clogsweep", *QUICK, "line-tension=0.3,3", "--refine=line-tension", ANGLE, "--output", "no.h5", words=["--refine lattice-angle"])


class Optimiser(ProgramTest):
    """The ten lines of docs/how-to/optimiser.md."""

    def test_a_script_may_choose_the_points_and_goes_on_when_called_again(self):
        page = (ROOT / "docs" / "how-to" / "optimiser.md").read_text()
        script = re.search(r"```python\n(.*?)```", page, re.DOTALL)[1]
        self.assertLessEqual(sum(bool(line.strip()) for line in script.splitlines()), 13)
        self.write("optimiser.py", script)
        self.write("sweep.cfg", "\n".join(word.replace("=", " = ", 1) for word in [*QUICK, "seeds=1..3"]) + "\n")
        paths = {"PATH": f"{BIN}:{os.environ['PATH']}", "PYTHONPATH": str(ROOT / "analysis")}
        said = [subprocess.run([sys.executable, "optimiser.py"], cwd=self.folder, env=os.environ | paths, check=True, capture_output=True, text=True).stdout
                for _ in range(2)]
        self.assertIn("farthest between", said[0])
        self.assertEqual(said[0], said[1])
        self.assertGreaterEqual(table(self.folder / "sweep.h5").line_tension.nunique(), 6)


if __name__ == "__main__":
    unittest.main()
