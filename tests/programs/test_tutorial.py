"""Pages of the handbook: their commands as they stand, one block after the other, in an empty folder; those of the tutorial
in one folder, one page after the other.

Blocks of `bash` and `python` are run. The first line of a block of `text` has to be among what they print, whatever its
numbers are, and every file that a page names has to be there in the end.
"""

import os
import re
import shutil
import subprocess
import sys
import unittest

from support import BIN, LONGEST, ROOT, ProgramTest

BLOCK = re.compile(r"^```(bash|python|text)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
FILE = re.compile(r"`([\w-]+\.(?:h5|csv|cfg|json|png|pdf|gif|mp4|html))`")
TOCTREE = re.compile(r"^```{toctree}\n(?::.*\n)*\n(.*?)^```$", re.MULTILINE | re.DOTALL)
# Settings from the page before the tutorials; `set` ends a block at the first command that fails.
BEFORE = f"set -euo pipefail; . {ROOT}/jobs/mpi-settings.sh\n"


def outline(line):
    """A line without its numbers and the widths of its columns."""
    return re.sub(r"\d[\d.]*(?:e[+-]?\d+)?", "#", " ".join(line.split()))


class Pages(ProgramTest):
    def follow(self, path):
        # Another python3 that comes first in the path may lack what Debian's has. mpirun stays the one it was.
        folders = [str(BIN), os.path.dirname(shutil.which("mpirun")), os.path.dirname(sys.executable), os.environ["PATH"]]
        environment = {**os.environ, "PATH": ":".join(folders), "PYTHONPATH": str(ROOT / "analysis")}
        page = (ROOT / path).read_text()
        blocks = BLOCK.findall(page)
        self.assertIn("bash", [language for language, _ in blocks])
        seen = set()
        for language, block in blocks:
            if language == "text":
                self.assertIn(outline(block.splitlines()[0]), seen)
                continue
            command = ["bash", "-c", BEFORE + block] if language == "bash" else [sys.executable, "-c", block]
            done = subprocess.run(command, cwd=self.folder, env=environment, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                  stderr=subprocess.STDOUT, text=True, timeout=LONGEST)
            self.assertEqual(done.returncode, 0, f"{block}\n{done.stdout}")
            seen.update(map(outline, done.stdout.splitlines()))
        files = FILE.findall(re.sub(r"^```.*?^```$", "", page, flags=re.MULTILINE | re.DOTALL))
        self.assertNotEqual(files, [])
        for name in files:
            self.assertTrue((self.folder / name).exists(), f"{path} names {name}, which is not there")

    def test_the_tutorial(self):
        """Its pages tell the reader to stay in one folder: what one of them writes must not be in the way of another."""
        pages = TOCTREE.search((ROOT / "docs/tutorial/index.md").read_text())[1].split()
        self.assertGreaterEqual(len(pages), 3)
        for page in pages:
            self.follow(f"docs/tutorial/{page}.md")

    def test_the_sweep_of_the_first_page(self):
        self.follow("README.md")

    def test_other_random_arrays(self):
        self.follow("docs/how-to/other-arrays.md")

    def test_obstacles_of_your_own(self):
        self.follow("docs/how-to/own-obstacles.md")

    def test_a_lattice(self):
        self.follow("docs/how-to/lattice.md")

    def test_two_sweeps_compared(self):
        self.follow("docs/how-to/compare-sweeps.md")

    def test_results_in_python(self):
        self.follow("docs/how-to/python.md")


if __name__ == "__main__":
    unittest.main()
