"""Runs the commands on pages of the handbook without changes. Each page begins in an empty folder. The pages of the
tutorial are an exception: they share one folder and are run one after the other.

Blocks of `bash` and `python` are run. The first line of a block of `text` must be in their output, apart from its
numbers. Every file that a page names must exist at the end.
"""

import re
import unittest

import pages
from support import ROOT, ProgramTest

FILE = re.compile(r"`([\w-]+\.(?:h5|csv|cfg|json|png|pdf|gif|mp4|html))`")


def outline(line):
    """A line without its numbers, and with single spaces between its columns."""
    return re.sub(r"\d[\d.]*(?:e[+-]?\d+)?", "#", " ".join(line.split()))


class Pages(ProgramTest):
    def follow(self, path):
        blocks = pages.blocks(path)
        self.assertIn("bash", [language for language, _ in blocks])
        seen = set()
        for language, block in blocks:
            if language == "text":
                self.assertIn(outline(block.splitlines()[0]), seen)
                continue
            done = pages.run(language, block, self.folder)
            self.assertEqual(done.returncode, 0, f"{block}\n{done.stdout}")
            seen.update(map(outline, done.stdout.splitlines()))
        prose = re.sub(r"^```.*?^```$", "", (ROOT / path).read_text(), flags=re.MULTILINE | re.DOTALL)
        files = FILE.findall(prose)
        self.assertNotEqual(files, [])
        for name in files:
            self.assertTrue((self.folder / name).exists(), f"{path} names {name}, which is not there")

    def test_the_tutorial(self):
        """Readers of the tutorial stay in one folder, so the files of one page must not affect another page."""
        self.assertGreaterEqual(len(pages.tutorial()), 3)
        for page in pages.tutorial():
            self.follow(page)

    def test_the_sweep_of_the_first_page(self):
        self.follow("README.md")

    def test_obstacles_of_your_own(self):
        self.follow("docs/how-to/own-obstacles.md")

    def test_a_lattice(self):
        self.follow("docs/how-to/lattice.md")

    def test_contact_angles(self):
        self.follow("docs/how-to/contact-angles.md")

    def test_droplets_of_several_sizes(self):
        self.follow("docs/how-to/sizes-and-tilts.md")

    def test_two_sweeps_compared(self):
        self.follow("docs/how-to/compare-sweeps.md")

    def test_results_in_python(self):
        self.follow("docs/how-to/python.md")


if __name__ == "__main__":
    unittest.main()
