"""Runs commands of the Python module as a user would."""

import importlib
import io
import multiprocessing
import os
import subprocess
import sys

import tables  # noqa: F401, see warm_up
from matplotlib import image

from support import LONGEST, ROOT, ProgramTest

sys.path.insert(1, str(ROOT / "analysis"))
import clogsweep.__main__  # noqa: E402
from clogsweep import style  # noqa: E402


def warm_up():
    """Loads all commands, and draws a small picture to load the fonts. Forked processes share both, because loading
    takes more CPU time than drawing."""
    for command in clogsweep.__main__.COMMANDS:
        importlib.import_module(f"clogsweep.commands.{command.replace('-', '_')}")
    figure, axes = style.subplots(figsize=(2, 2))
    axes.set_title(r"fonts: $\lambda/\sigma_\mathrm{ob}$")
    for ending in ("png", "pdf"):
        figure.savefig(io.BytesIO(), format=ending)


warm_up()


def run_in(folder, out, error, call):
    os.chdir(folder)
    for file, descriptor in [(out, 1), (error, 2)]:
        with open(file, "w") as stream:
            os.dup2(stream.fileno(), descriptor)
    sys.exit(call())


class Analysis(ProgramTest):
    def fork(self, words, call):
        """Calls a function in the test's folder, in a forked process. The process shares everything that warm_up() has
        loaded.
        @param words  the call in words, for messages; @param call  returns an exit code"""
        out, error = self.folder / "stdout.txt", self.folder / "stderr.txt"
        process = multiprocessing.get_context("fork").Process(target=run_in, args=(self.folder, out, error, call))
        process.start()
        process.join(LONGEST)
        if process.exitcode is None:
            process.kill()
            self.fail(f"{words} takes more than {LONGEST} s")
        return subprocess.CompletedProcess(words, process.exitcode, out.read_text(), error.read_text())

    def analyse(self, command, *arguments):
        """Calls python3 -m clogsweep."""
        own_argv = ["clogsweep", command, *map(str, arguments)]

        def call():
            sys.argv = own_argv
            return clogsweep.__main__.main()

        return self.fork(own_argv[1:], call)

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
