import json
import subprocess
import sys
import unittest

from matplotlib import image

from support import BIN, QUICK, ROOT, ProgramTest


class Figures(ProgramTest):
    def analyse(self, script, *arguments):
        return subprocess.run(
            [sys.executable, str(ROOT / "analysis" / script), *map(str, arguments)],
            cwd=self.folder, capture_output=True, text=True, timeout=120,
        )

    def assert_picture(self, name):
        pixels = image.imread(self.folder / f"{name}.png")
        self.assertGreater(min(pixels.shape[:2]), 300)
        self.assertGreater(pixels[..., :3].std(), 0.05, "a picture that is not blank")
        self.assertTrue((self.folder / f"{name}.pdf").read_bytes().startswith(b"%PDF"))

    def test_the_clogging_length_is_drawn_from_a_fit(self):
        self.succeed("clogsweep", *QUICK, "line-tension=0.3,2", "obstacle-gap=0.2,1.2", "seeds=1..3", "--output", "s.h5")
        self.write("fit.json", self.succeed("clogfit", "s.h5", "--format", "json").stdout)
        done = self.analyse("clogging_length.py", "fit.json", "--output", "curve")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assert_picture("curve")

    def test_soft_disks_are_drawn_over_their_stiffness(self):
        self.succeed("clogsweep", "model=sp", "wall-stiffness=0.3,3", "box=20", "max-time=500", "seeds=1..3", "--output", "s.h5")
        self.write("fit.json", self.succeed("clogfit", "s.h5", "--format", "json").stdout)
        done = self.analyse("clogging_length.py", "fit.json", "--output", "curve")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assert_picture("curve")

    def test_mixtures_and_lattices_are_drawn_too(self):
        soft_disks = ["model=sp", "wall-stiffness=0.3,3", "box=20", "max-time=300", "seeds=1..2"]
        for name, keys in [
            ("mixture", ["obstacle-diameter-spread=0.3", "obstacle-density=0.5,saturated"]),
            ("lattice", ["obstacle-layout=lattice", "lattice-angle=0,10"]),
        ]:
            self.succeed("clogsweep", *soft_disks, *keys, "--output", f"{name}.h5")
            self.write("fit.json", self.succeed("clogfit", f"{name}.h5", "--format", "json").stdout)
            done = self.analyse("clogging_length.py", "fit.json", "--output", name)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assert_picture(name)

    def test_a_droplet_is_drawn_from_a_run(self):
        self.succeed("clogrun", "array", *QUICK, "--polygon-interval", 5, "--output", "run.h5")
        done = self.analyse("droplet.py", "run.h5", "--output", "droplet")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assert_picture("droplet")

    def test_clogs_are_drawn_from_a_sweep(self):
        self.succeed("clogsweep", *QUICK, "line-tension=1,3", "seeds=1..2", "--output", "s.h5")
        done = self.analyse("clogs.py", "s.h5", "--clogrun", BIN / "clogrun", "--output", "clogs", "--most", 3)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assert_picture("clogs")

    def test_foreign_files_get_one_line(self):
        self.write("fit.json", json.dumps({"groups": "none"}))
        self.write("run.h5", "nothing")
        for script, file in [("clogging_length.py", "fit.json"), ("clogging_length.py", "no.json"), ("droplet.py", "run.h5"), ("clogs.py", "run.h5")]:
            with self.subTest(script=script, file=file):
                done = self.analyse(script, file, "--output", "x")
                self.assertNotEqual(done.returncode, 0)
                self.assertEqual(len(done.stderr.strip().splitlines()), 1, done.stderr)
                self.assertIn("cannot read", done.stderr)


if __name__ == "__main__":
    unittest.main()
