"""Runs the built programs as a person would: in an empty folder, by their command line."""

import os
import pathlib
import subprocess
import tempfile
import unittest

BIN = pathlib.Path(os.environ["CLOG_BIN"])
ROOT = pathlib.Path(__file__).resolve().parents[2]
MPIRUN = ROOT / "tests" / "mpirun.sh"

# Small droplets in a small box: a run takes some hundredths of a second.
SMALL = ["vertices=64", "box=20"]
QUICK = [*SMALL, "max-time=60"]


class ProgramTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="clog_program_")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def run_program(self, name, *arguments, ranks=None, timeout=300):
        command = [str(BIN / name), *map(str, arguments)]
        if ranks is not None:
            command = [str(MPIRUN), str(ranks), *command]
        return subprocess.run(command, cwd=self.folder, capture_output=True, text=True, timeout=timeout)

    def succeed(self, name, *arguments, **options):
        done = self.run_program(name, *arguments, **options)
        self.assertEqual(done.returncode, 0, f"{name} {arguments}: {done.stdout}{done.stderr}")
        return done

    def refuse(self, name, *arguments, words):
        """The program must leave with exit code 2, say each of the words in one line, and write nothing."""
        before = self.snapshot()
        done = self.run_program(name, *arguments)
        self.assertEqual(done.returncode, 2, done.stdout + done.stderr)
        self.assertEqual(len(done.stderr.strip().splitlines()), 1, done.stderr)
        self.assertEqual(done.stdout, "")
        for word in words:
            self.assertIn(word, done.stderr)
        self.assertEqual(self.snapshot(), before)

    def snapshot(self):
        return {path.name: path.read_bytes() for path in self.folder.iterdir() if path.is_file()}

    def write(self, name, text):
        (self.folder / name).write_text(text)
        return name
