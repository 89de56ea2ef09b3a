"""Tests that no command deletes what users added to a sweep file."""

import re
import shlex
import subprocess
import unittest

import h5py
import numpy as np
import pandas
from drawing import Analysis
from support import BIN, FEW, table


class Foreign(Analysis):
    def add_group(self, path):
        with h5py.File(path, "a") as file:
            file["mine/x"] = np.arange(3)

    def add_attribute(self, path):
        with h5py.File(path, "a") as file:
            file.attrs["note"] = "sample 7"

    def add_attribute_of_the_table(self, path):
        with h5py.File(path, "a") as file:
            file["runs"].attrs["note"] = "sample 7"

    def add_frame(self, path):
        pandas.DataFrame({"a": [1]}).to_hdf(path, key="fit")

    def test_a_sweep_with_objects_of_others_is_refused_before_it_is_touched(self):
        for add, name in [(self.add_group, "/mine"), (self.add_attribute, "attribute note of /"),
                          (self.add_attribute_of_the_table, "attribute note of /runs"), (self.add_frame, "/fit")]:
            with self.subTest(name):
                path = self.copy_sweep("s.h5", *FEW)
                path.chmod(0o644)
                add(path)
                # The first command adds seeds. With the second command nothing is left to do.
                for arguments in ([word.replace("1..2", "1..3") for word in FEW], FEW):
                    self.refuse("clogsweep", *arguments, "--output", "s.h5",
                                words=["cannot resume s.h5", name, "clogsweep salvage s.h5 --output"])
                self.succeed("clogsweep", "salvage", "s.h5", "--output", "new.h5")
                self.assertIn("nothing left to do", self.succeed("clogsweep", *FEW, "--output", "new.h5").stderr)
                self.assertEqual(len(table(self.folder / "new.h5")), 4)
                (self.folder / "new.h5").unlink()
                path.unlink()

    def changed_sweep(self, name="s.h5"):
        """A sweep with objects and attributes of others."""
        path = self.copy_sweep(name, *FEW)
        path.chmod(0o644)
        for add in (self.add_group, self.add_attribute, self.add_attribute_of_the_table, self.add_frame):
            add(path)
        return path

    def test_no_command_changes_a_sweep_with_objects_of_others(self):
        path = self.changed_sweep()
        before = path.read_bytes()
        self.copy_sweep("more.h5", *(word.replace("1..2", "3") for word in FEW))
        for program, *arguments in [("clogsweep", "status", "s.h5"), ("clogsweep", "verify", "s.h5"),
                                    ("clogsweep", "merge", "s.h5", "more.h5", "--output", "merged.h5"),
                                    ("clogsweep", "select", "s.h5", "seed=1", "--output", "selected.h5"),
                                    ("clogsweep", "replay", "s.h5", "0"), ("clogfit", "s.h5"),
                                    ("clogrun", "replay", "s.h5", "0", "--output", "run.h5"),
                                    ("clogsweep", *FEW, "--output", "s.h5", "--dry-run")]:
            with self.subTest(program=program, arguments=arguments):
                self.succeed(program, *arguments)
                self.assertEqual(path.read_bytes(), before)
        for command, *arguments in [("export", "s.h5", "rows.csv", "--programs", BIN),
                                    ("clogging-length", "s.h5", "--output", "l", "--programs", BIN)]:
            with self.subTest(command=command):
                self.draw(command, *arguments)
                self.assertEqual(path.read_bytes(), before)
        done = self.analyse("refine", "line-tension", *FEW, "--until", "curve=20%", "--output", "s.h5", "--programs", BIN)
        self.assertEqual((done.returncode, path.read_bytes()), (2, before), done.stdout + done.stderr)
        self.assertIn("cannot resume s.h5", done.stderr)
        # Commands that copy the sweep copy only its rows, so that the copy can be resumed.
        self.assertIn("nothing left to do", self.succeed("clogsweep", *(word.replace("1..2", "1..3") for word in FEW), "--output", "merged.h5").stderr)

    def test_the_named_command_copies_the_objects_out(self):
        for name in ("s.h5", "my sweep's.h5"):
            self.changed_sweep(name)
            said = self.run_program("clogsweep", *FEW, "--output", name).stderr
            command, = re.findall(r"by (h5copy .*), copy the sweep", said)
            subprocess.run(shlex.split(command), cwd=self.folder, check=True)
            with h5py.File(self.folder / "MINE.h5") as file:
                copied, = file
                self.assertEqual(list(file[copied]), list(h5py.File(self.folder / name)[copied]))
            (self.folder / "MINE.h5").unlink()
            command, = re.findall(r"by (clogsweep salvage .*), and resume NEW.h5", said)
            self.succeed(*shlex.split(command))
            (self.folder / "NEW.h5").unlink()

    def test_copies_of_other_programs_go_on(self):
        path = self.copy_sweep("s.h5", *FEW)
        path.chmod(0o644)
        subprocess.run(["h5repack", "-f", "GZIP=6", path, self.folder / "packed.h5"], check=True)
        pandas.HDFStore(path).close()
        with h5py.File(path, "a"):
            pass
        for name in ("s.h5", "packed.h5"):
            self.assertIn("nothing left to do", self.succeed("clogsweep", *FEW, "--output", name).stderr)

    def test_circles_and_laboratories_are_no_foreign_objects(self):
        self.write("posts.csv", "2,2,1\n5,5,1\n8,8,1\n")
        self.write("lab.cfg", "diameter = 2 mm\nangle = 20 deg\nspeed = 7 mm/s\n")
        arguments = ["obstacles=posts.csv", "box=10", "vertices=64", "max-time=1", "--lab", "lab.cfg", "seeds=1", "--output", "s.h5"]
        self.succeed("clogsweep", *arguments)
        subprocess.run(["h5repack", "-f", "GZIP=6", self.folder / "s.h5", self.folder / "packed.h5"], check=True)
        self.assertIn("nothing left to do", self.succeed("clogsweep", *arguments[:-1], "packed.h5").stderr)


if __name__ == "__main__":
    unittest.main()
