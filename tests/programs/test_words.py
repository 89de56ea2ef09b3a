"""Tests that messages name the remedy for the user's mistake."""

import unittest

from support import QUICK, ProgramTest

DRY = [*QUICK, "--dry-run"]


class Integers(ProgramTest):
    def tasks(self, seeds):
        printed = self.succeed("clogsweep", *DRY, f"seeds={seeds}").stdout.splitlines()
        return [line for line in printed if not line.startswith("#")]

    def test_ranges_with_a_step_are_those_of_python(self):
        for first, last, step in [(1, 10, 2), (1, 100, 25), (3, 3, 7), (0, 9, 9), (5, 12, 100)]:
            expected = ",".join(map(str, range(first, last + 1, step)))
            self.assertEqual(self.tasks(f"{first}..{last}:{step}"), self.tasks(expected))

    def test_a_sweep_of_seeds_with_a_step_resumes(self):
        for _ in range(2):
            printed = self.succeed("clogsweep", *QUICK, "seeds=1..5:2", "--output", "s.h5")
        self.assertIn("nothing left to do", printed.stderr)
        self.assertIn("3 runs", self.succeed("clogsweep", "status", "s.h5").stdout)

    def test_other_notations_of_integers_get_the_one_that_is_accepted(self):
        for text, words in [("1:10", ["1..10"]), ("1:10:2", ["1..10:2"]), ("1e3", ["1000"]), ("1;2;3", ["1,2,3"]),
                            ("1; 2", ["1,2"]), ("1 2 3", ["1,2,3"]), ("1-10", ["1..10"]), ("2.0", ["did you mean 2?"]),
                            ("1..9:0", ["step"]), ("-3", ["0 to 4294967295"]), ("-3..2", ["0 to 4294967295"]),
                            ("5000000000", ["0 to 4294967295"]), ("two", ["'two' is not an integer"])]:
            with self.subTest(text):
                done = self.run_program("clogsweep", *DRY, f"seeds={text}")
                self.refuse("clogsweep", *DRY, f"seeds={text}", words=[f"seeds={text}", *words])
                if text != "two":
                    self.assertNotIn("--lab", done.stderr)
        for text in ("1:10", "1;2"):
            done = self.run_program("clogsweep", *DRY, f"line-tension={text}")
            self.assertEqual((done.returncode, "--lab" in done.stderr), (2, False), done.stderr)
        self.refuse("clogsweep", *DRY, "obstacle-gap=1mm", words=["--lab"])


class Commands(ProgramTest):
    def test_a_command_of_another_program_is_named_with_it(self):
        for program, command, words in [("clogsweep", "export", "python3 -m clogsweep export"), ("clogsweep", "clogging-length", "python3 -m clogsweep clogging-length"),
                                        ("clogsweep", "compare", "clogfit compare"), ("clogsweep", "report", "clogfit report"), ("clogfit", "merge", "clogsweep merge"),
                                        ("clogfit", "status", "clogsweep status"), ("clogfit", "circles", "python3 -m clogsweep circles"), ("clogrun", "verify", "clogsweep verify")]:
            with self.subTest(program=program, command=command):
                self.refuse(program, command, "s.h5", "out.csv",
                            words=[f"unknown command '{command}'; did you mean {words}?"])
        self.write("export", "")
        self.refuse("clogsweep", "export", words=["no place for 'export'"])

    def test_names_that_are_too_long_are_named_as_such(self):
        for length in (240, 255, 300):
            name = "s" * (length - 3) + ".h5"
            done = self.run_program("clogsweep", *QUICK, "seeds=1", "--output", name)
            self.assertEqual(done.returncode, 2, done.stderr)
            self.assertIn("shorter name", done.stderr)
            self.assertNotIn("disk", done.stderr)
        self.assertEqual(self.snapshot(), {})


if __name__ == "__main__":
    unittest.main()
