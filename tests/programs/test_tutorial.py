"""Runs commands on pages of the handbook with fewer seeds and shorter runs. This tests that the programs and the module
know the keys and options of these commands.

slow_tutorial runs the commands without changes, and tests what they print and draw.
"""

import re
import unittest

import pages
from drawing import Analysis

# Parts of commands that take long, with their replacements
SHORTER = [(r"\bmpirun -np \d+ ", ""), (r"\bseeds( *)=( *)1\.\.\d+", r"seeds\1=\g<2>1..2"),
           (r"\bmax-time( *)=( *)\d{3,}", r"max-time\1=\g<2>300"), (r"\bstart=-2 end=\d\b", "start=-1 end=-0.9"),
           (r"\bfor tension in [\d. ]+", "for tension in 1"), (r"\bvertices=128\b", "vertices=64")]
# This function replaces python3, and only records its arguments. The test then makes the calls itself, without starting
# Python again.
LATER = "later() { echo \"$@\" >> later.txt; }\n"


class Commands(Analysis):
    def follow(self, path):
        later = self.folder / "later.txt"
        for language, block in pages.blocks(path):
            with self.subTest(path=path, block=block):
                if language == "python":
                    done = self.fork(block, lambda block=block: exec(block, {"__name__": "__main__"}))
                    self.assertEqual(done.returncode, 0, done.stderr)
                elif language == "bash":
                    for long, short in SHORTER:
                        block = re.sub(long, short, block)
                    later.write_text("")
                    done = pages.run(language,
                                     LATER + re.sub(r"\S*python3 -m clogsweep|clogfit(?= report)", "later", block),
                                     self.folder)
                    self.assertEqual(done.returncode, 0, done.stdout)
                    for line in later.read_text().splitlines():
                        self.draw(*line.split())

    def test_those_of_the_tutorial(self):
        """All pages are run in one folder, as the tutorial asks its readers to do."""
        for page in pages.tutorial():
            self.follow(page)

    def test_those_of_other_pages(self):
        folder = self.folder
        for number, page in enumerate(pages.PAGES):
            self.folder = folder / str(number)
            self.folder.mkdir()
            self.follow(page)


if __name__ == "__main__":
    unittest.main()
