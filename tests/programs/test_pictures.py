"""How the scripts of analysis/ are called."""

import unittest

from scripts import Analysis
from support import BIN, QUICK


class Calls(Analysis):
    SCRIPTS = ["clogging_length.py", "clogs.py", "droplet.py", "export_vtk.py", "report.py"]

    def needs(self, script):
        return [] if script in ("droplet.py", "export_vtk.py") else ["--programs", BIN]

    def test_a_run_is_no_sweep_and_a_sweep_no_run(self):
        self.succeed("clogrun", "array", *QUICK, "--polygon-interval", 30, "--output", "run.h5")
        self.succeed("clogsweep", *QUICK, "seeds=1", "--output", "s.h5")
        for script in self.SCRIPTS:
            is_of_runs = not self.needs(script)
            with self.subTest(script=script):
                self.refuse_analysis(script, "s.h5" if is_of_runs else "run.h5", "--output", "x", *self.needs(script),
                                     words=["cannot read", "output of clogrun" if is_of_runs else "clogsweep"])
        self.refuse_analysis("clogs.py", "run.h5", *self.needs("clogs.py"), words=["run.h5 (holds one run of clogrun, not a sweep)"])

    def test_a_file_that_is_not_there_is_called_so(self):
        for script in self.SCRIPTS:
            with self.subTest(script=script):
                self.refuse_analysis(script, "nope.h5", "--output", "x", *self.needs(script), words=["cannot read nope.h5 (no such file); check the name"])

    def test_an_output_may_be_left_out_or_have_its_ending(self):
        self.succeed("clogsweep", *QUICK, "line-tension=1,3", "seeds=1..2", "--output", "s.h5")
        for script, made in [("clogging_length.py", "s-clogging-length.png"), ("clogs.py", "s-clogs.png"), ("report.py", "s-report.html")]:
            self.assertIn(made, self.draw(script, "s.h5", "--programs", BIN).stdout)
            self.assertTrue((self.folder / made).exists())
        for name in ("cl.png", "cl.pdf", "cl0.2"):
            self.draw("clogging_length.py", "s.h5", "-o", name, "--programs", BIN)
        self.assertEqual({path.name for path in self.folder.glob("cl*")}, {"cl.png", "cl.pdf", "cl0.2.png", "cl0.2.pdf"})
        self.refuse_analysis("clogging_length.py", "/dev/null", words=["no name", "--output"])

    def test_a_name_of_a_film_asks_for_one(self):
        self.succeed("clogrun", "array", *QUICK, "--polygon-interval", 30, "--output", "run.h5")
        self.assertEqual(self.draw("droplet.py", "run.h5", "-o", "run.gif").stdout, "run.gif\n")
        self.assertEqual((self.folder / "run.gif").read_bytes()[:4], b"GIF8")

    def test_the_colour_of_obstacles_is_the_one_in_the_help(self):
        self.assertIn("obstacles are blue", " ".join(self.draw("clogs.py", "--help").stdout.split()))


if __name__ == "__main__":
    unittest.main()
