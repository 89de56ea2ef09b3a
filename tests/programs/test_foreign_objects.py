"""Tests that no command deletes what users added to a sweep file."""

import subprocess
import unittest

import h5py
import numpy as np
import pandas
from support import FEW, ProgramTest, table


class Foreign(ProgramTest):
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
        for add, name in [(self.add_group, "/mine"), (self.add_attribute, "attribute note of /"), (self.add_attribute_of_the_table, "attribute note of /runs"), (self.add_frame, "/fit")]:
            with self.subTest(name):
                path = self.copy_sweep("s.h5", *FEW)
                path.chmod(0o644)
                add(path)
                # More seeds, and nothing left to do.
                for arguments in ([word.replace("1..2", "1..3") for word in FEW], FEW):
                    self.refuse("clogsweep", *arguments, "--output", "s.h5", words=["cannot resume s.h5", name, "clogsweep salvage s.h5 --output"])
                self.succeed("clogsweep", "salvage", "s.h5", "--output", "new.h5")
                self.assertIn("nothing left to do", self.succeed("clogsweep", *FEW, "--output", "new.h5").stderr)
                self.assertEqual(len(table(self.folder / "new.h5")), 4)
                (self.folder / "new.h5").unlink()
                path.unlink()

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
