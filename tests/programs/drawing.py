"""Runs commands of the Python module as a person would."""

import multiprocessing
import os
import subprocess
import sys

import tables  # noqa: F401, see run_command
from matplotlib import image

from support import ROOT, ProgramTest

sys.path.insert(1, str(ROOT / "analysis"))
import clogsweep.__main__  # noqa: E402


def run_command(words, folder, out, error):
    """python3 -m clogsweep, in a process forked for it: what takes a second to load is there already."""
    os.chdir(folder)
    for file, descriptor in [(out, 1), (error, 2)]:
        with open(file, "w") as stream:
            os.dup2(stream.fileno(), descriptor)
    sys.argv = ["clogsweep", *words]
    sys.exit(clogsweep.__main__.main())


class Analysis(ProgramTest):
    def analyse(self, command, *arguments):
        words = [command, *map(str, arguments)]
        out, error = self.folder / "stdout.txt", self.folder / "stderr.txt"
        process = multiprocessing.get_context("fork").Process(target=run_command, args=(words, self.folder, out, error))
        process.start()
        process.join(300)
        if process.exitcode is None:
            process.kill()
            self.fail(f"{words} takes more than 300 s")
        return subprocess.CompletedProcess(words, process.exitcode, out.read_text(), error.read_text())

    def draw(self, command, *arguments):
        done = self.analyse(command, *arguments)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        return done

    def refuse_analysis(self, command, *arguments, words):
        done = self.analyse(command, *arguments)
        self.assertEqual(done.returncode, 2, done.stdout + done.stderr)
        self.assertEqual(len(done.stderr.strip().splitlines()), 1, done.stderr)
        for word in words:
            self.assertIn(word, done.stderr)

    def assert_picture(self, name):
        pixels = image.imread(self.folder / f"{name}.png")
        self.assertGreater(min(pixels.shape[:2]), 300)
        self.assertGreater(pixels[..., :3].std(), 0.05, "a picture that is not blank")
        margins = [pixels[:2], pixels[-2:], pixels[:, :2], pixels[:, -2:]]
        self.assertTrue(all((margin == 1).all() for margin in margins), f"{name}: something is cut off at the margin")
        self.assertTrue((self.folder / f"{name}.pdf").read_bytes().startswith(b"%PDF"))
