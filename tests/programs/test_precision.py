"""Tests that --until-precision adds seeds where lambda is not precise enough. The sweep must add the same seeds after
any interruption."""

import json
import re
import unittest

import h5py
import pandas
from support import QUICK, TIMING, ProgramTest, shared_sweep, table

# At Gamma = 2 every droplet clogs. At Gamma = 0.3 few droplets clog in such a short time.
SWEEP = [*QUICK, "obstacle-gap=0.3", "line-tension=0.3,2", "seeds=1..4", "--until-precision=75%", "--most-seeds=14"]


class Precision(ProgramTest):
    def check_equal(self, name, other):
        rows, others = (table(self.folder / n).drop(columns=TIMING) for n in (name, other))
        pandas.testing.assert_frame_equal(rows, others, check_exact=True)

    def test_it_adds_seeds_where_they_are_needed(self):
        done = self.succeed("clogsweep", *SWEEP, "--output", "s.h5", ranks=2)
        groups = {group["line_tension"]: group for group in
                  json.loads(self.succeed("clogfit", "s.h5", "--format=json").stdout)["groups"]}

        def width(group):
            return (group["clogging_length_upper"] - group["clogging_length_lower"]) / (2 * group["clogging_length"])

        self.assertLess(width(groups[2]), 0.75)
        self.assertGreater(groups[2]["runs"], 4)
        self.assertLess(groups[2]["runs"], 14)
        if groups[0.3]["runs"] < 14:
            self.assertLess(width(groups[0.3]), 0.75)
        self.assertGreaterEqual(groups[0.3]["runs"], groups[2]["runs"])
        self.assertIn("of 2 parameter sets reached --until-precision", done.stderr)
        with h5py.File(self.folder / "s.h5") as file:
            self.assertIn("within +-75 %", file.attrs["stopping_rule"].decode())
        status = json.loads(self.succeed("clogsweep", "status", "s.h5", "--format=json").stdout)
        self.assertEqual(status["runs"], groups[0.3]["runs"] + groups[2]["runs"])
        self.assertEqual(status["finished"], status["runs"])
        self.assertIn("complete", self.succeed("clogsweep", "status", "s.h5").stdout)
        last = table(self.folder / "s.h5").task.max()
        self.assertIn("the same bits", self.succeed("clogsweep", "replay", "s.h5", last).stdout)

    def test_the_rows_depend_neither_on_ranks_nor_on_interruptions(self):
        whole = shared_sweep(*SWEEP)
        self.succeed("clogsweep", *SWEEP, "--output", "three.h5", ranks=3)
        self.check_equal("three.h5", whole)
        stopped, hours = 0, 0.00004
        while self.run_program("clogsweep", *SWEEP, "--output", "stopped.h5", f"--max-hours={hours}").returncode == 75:
            stopped += 1
            hours *= 1.05  # On a busy machine a session may make no progress.
            self.assertLess(stopped, 200)
        self.assertGreater(stopped, 0)
        self.check_equal("stopped.h5", whole)
        again = self.succeed("clogsweep", *SWEEP, "--output", "stopped.h5")
        self.assertIn("parameter sets reached", again.stderr)
        self.check_equal("stopped.h5", whole)

    def test_a_sweep_without_it_can_go_on_with_it(self):
        plain = [word for word in SWEEP if not word.startswith("--")]
        self.succeed("clogsweep", *plain, "--output", "s.h5")
        self.assertEqual(len(table(self.folder / "s.h5")), 8)
        self.succeed("clogsweep", *SWEEP, "--output", "s.h5")
        self.check_equal("s.h5", shared_sweep(*SWEEP))

    def test_a_lower_precision_finishes_runs_of_a_higher_one(self):
        more = [*SWEEP[:-2], "--until-precision=30%", "--most-seeds=60"]
        begin = hours = 0.00004
        for _ in range(200):  # Repeats until the stop comes in a later round than the first.
            done = self.run_program("clogsweep", *more, "--output", "s.h5", f"--max-hours={hours}")
            if done.returncode == 0:  # The sweep ended before the stop, so it starts again.
                (self.folder / "s.h5").unlink()
                hours = begin
                continue
            self.assertEqual(done.returncode, 75, done.stderr)
            hours *= 1.05  # On a busy machine a session may make no progress.
            rows = table(self.folder / "s.h5")
            if len(rows) > 8 and (rows.status == "interrupted").any():
                break
        else:
            self.fail("no stop met a later round")
        self.succeed("clogsweep", *SWEEP[:-2], "--until-precision=90%", "--most-seeds=60", "--output", "s.h5")
        rows = table(self.folder / "s.h5")
        self.assertFalse(rows.status.isin(["running", "interrupted"]).any())
        self.assertFalse((self.folder / "s.h5.journal").exists())
        self.assertIn("; complete", self.succeed("clogsweep", "status", "s.h5").stdout)

    def test_a_sweep_that_goes_on_without_it_forgets_the_rule(self):
        self.succeed("clogsweep", *SWEEP, "--output", "s.h5")
        plain = [word.replace("1..4", "1..6") for word in SWEEP if not word.startswith("--")]
        self.succeed("clogsweep", *plain, "--output", "s.h5")
        with h5py.File(self.folder / "s.h5") as file:
            self.assertNotIn("stopping_rule", file.attrs)
        status = json.loads(self.succeed("clogsweep", "status", "s.h5", "--format=json").stdout)
        self.assertEqual(status["finished"], status["runs"])
        self.assertEqual(status["runs"], len(table(self.folder / "s.h5")))

    def test_a_dry_run_tells_between_what_limits_all_rounds_cost(self):
        def printed(*words):
            lines = self.succeed("clogsweep", *SWEEP[:-2], "--dry-run", *words).stdout.splitlines()
            return [line for line in lines if line.startswith("# ")]

        self.assertFalse(any("round" in line for line in self.succeed("clogsweep", *SWEEP[:-2], "--dry-run").stdout.splitlines()))
        *_, bound, expected, first, rounds = printed("--until-precision=20%", "--most-seeds=400")
        self.assertEqual(first, "# this is the first round: +-20 % needs 100 clogs per parameter set")
        bound = float(re.search("at most ([^ ]+) core-hours", bound)[1])
        expected = float(re.search("expected ([^ ]+) core-hours", expected)[1])
        found = re.fullmatch(r"# all rounds: 100 seeds each if every run clogs, expected (\S+) core-hours \(95 %: "
                             r"(\S+) to (\S+)\); "
                             r"400 seeds each \(--most-seeds\) if few do, expected (\S+) core-hours \(95 %: "
                             r"(\S+) to (\S+)\), at most (\S+)", rounds)
        fewest, *of_fewest, most, low, high, longest = map(float, found.groups())
        self.assertLessEqual(low, most)
        self.assertLessEqual(most, high)
        for end, of_most in zip(of_fewest, (low, high)):
            self.assertAlmostEqual(of_most / end / 4, 1, delta=0.11)
        self.assertAlmostEqual(fewest / expected / 25, 1, delta=0.11)  # The printed number has two significant digits.
        self.assertAlmostEqual(most / expected / 100, 1, delta=0.11)
        self.assertAlmostEqual(longest / bound / 100, 1, delta=0.02)
        self.assertIn("# --most-seeds=30 ends it before that; give 100 or more",
                      printed("--until-precision=20%", "--most-seeds=30"))

    def test_a_dry_run_after_the_first_round_does_not_call_the_sweep_done(self):
        self.succeed("clogsweep", *SWEEP[:-2], "--output", "s.h5")
        printed = self.succeed("clogsweep", *SWEEP, "--output", "s.h5", "--dry-run").stdout
        self.assertNotIn("nothing is left", printed)
        hours = table(self.folder / "s.h5").processor_seconds.sum() / 3600
        self.assertIn(f"# s.h5 has all 8 runs, which took {hours:.2g} core-hours\n", printed)
        self.assertIn(f"14 seeds each (--most-seeds) if few do, expected {hours * 14 / 4:.2g} core-hours", printed)

    def test_mistakes_get_one_line_and_exit_code_2(self):
        plain = [*QUICK, "--output", "s.h5"]
        for arguments, words in [
            (["--until-precision=0%"], ["--until-precision=0%", "try 20%"]),
            (["--until-precision=often"], ["--until-precision=often"]),
            (["seeds=1..4", "--until-precision=20%", "--most-seeds=3"], ["--most-seeds=3", "4..100000"]),
            (["seeds=4294967290..4294967293", "--until-precision=75%"], ["--most-seeds=80", "smaller seeds"]),
            (["--most-seeds=30"], ["needs --until-precision"]),
        ]:
            with self.subTest(arguments=arguments):
                self.refuse("clogsweep", *plain, *arguments, words=words)


if __name__ == "__main__":
    unittest.main()
