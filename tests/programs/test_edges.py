"""What is around a sweep: names with any byte, links that move, modes and journals of others. No row is lost there."""

import os
import unittest

from support import SweepTest, table

OWN = ["obstacle-layout=file", "box=10", "vertices=64", "max-time=30"]


class Names(SweepTest):
    """A file of circles may be called anything that a file system takes."""

    def sweep_among(self, name):
        with open(os.fsencode(self.folder) + b"/" + name, "w") as file:
            file.write("x,y,diameter\n2,3,0.6\n7,8,1\n")
        return self.run_program("clogsweep", "obstacles=" + os.fsdecode(name), *OWN, "line-tension=1", "--output", "s.h5")

    def test_no_byte_of_a_name_sets_a_key_or_ends_the_sweep(self):
        for name in (b"p.csv\nline-tension = 0.1", b"\nfake: line.csv", b"p.csv\n#circles q.csv", b"a#b.csv", b"a\\x0a.csv", b"a\r.csv", b"\xff\xfe.csv",
                     "\u0085\u2028.csv".encode(), b"a = b.csv", b"\x01\x1b\x7f.csv"):
            with self.subTest(name=name):
                done = self.sweep_among(name)
                self.assertEqual(done.returncode, 0, done.stderr)
                self.assertEqual(set(table(self.folder / "s.h5").line_tension), {1})
                for command in ("verify", "status"):
                    self.succeed("clogsweep", command, "s.h5")
                self.succeed("clogfit", "s.h5")
                self.assertEqual(self.sweep_among(name).returncode, 0, "the same command goes on")
                (self.folder / "s.h5").unlink()

    def test_a_config_that_was_printed_names_the_same_file(self):
        for name in ("p.csv\nline-tension = 0.1", " a#b\\x41.csv"):
            with self.subTest(name=name):
                self.assertEqual(self.sweep_among(name.strip(" ").encode()).returncode, 0)
                printed = self.succeed("clogsweep", "obstacles=" + name, *OWN, "line-tension=1", "--print-config").stdout
                self.write("again.cfg", printed.split("\n# Values behind")[0])
                self.succeed("clogsweep", "--config", "again.cfg", "--output", "t.h5")
                self.check_equal("s.h5", "t.h5")
                for output in ("s.h5", "t.h5"):
                    (self.folder / output).unlink()


if __name__ == "__main__":
    unittest.main()
