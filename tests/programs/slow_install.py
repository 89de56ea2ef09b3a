"""Compiles the example own-program against an installation, in half a minute, and reads the installed handbook.
Sphinx takes a minute to build the handbook, so only tests/run.sh --all builds it (CLOG_HANDBOOK)."""

import json
import re
import shutil
import unittest

import pandas

from support import BIN
from test_install import KEYS, Installation

COMMANDS = {"clogsweep": ["status", "verify", "salvage", "replay", "doctor"], "clogrun": [],
            "clogfit": ["calibrate", "curve", "deviation", "drag", "report", "units"]}

# Arguments that are words without dashes
POSITIONAL = {"--file", "--system", "--task"}


class Built(Installation):
    def test_a_program_of_ones_own_finds_what_the_sweep_finds(self):
        example = self.folder / "example"
        shutil.copytree(self.prefix / "share/doc/clogsweep/docs/examples/own-program", example)
        build_type = "-DCMAKE_BUILD_TYPE=Release"
        flags = ["-DCMAKE_CXX_FLAGS=-fsanitize=address,undefined"] if "CLOG_SANITIZE:STRING=address" in (BIN.parent / "CMakeCache.txt").read_text() else []
        self.called("cmake", "-G", "Ninja", "-S", example, "-B", example / "build",
                    f"-DCMAKE_PREFIX_PATH={self.prefix}", build_type, *flags)
        self.called("cmake", "--build", example / "build")
        said = self.called(example / "build/own-program").splitlines()
        self.called("clogsweep", *KEYS, "--output", "own.h5")
        rows = pandas.read_hdf(self.folder / "own.h5", "runs").sort_values("seed")
        for line, row in zip(said[:-1], rows.itertuples(), strict=True):
            self.assertEqual(line, f"seed {row.seed}: {row.status} after {row.distance:.17g} sigma")
        self.assertRegex(said[-1], r"^lambda = \S+ sigma \(95 %: ")


class Handbook(Installation):
    def man_page(self, name, section):
        """The man page without its font commands."""
        return re.sub(r"\\f[BIP]", "",
                      (self.prefix / f"share/man/man{section}/{name}.{section}").read_text().replace("\\-", "-"))

    def test_man_pages_have_every_option_with_its_default_and_no_other(self):
        for program, commands in COMMANDS.items():
            printed = re.findall(r"^\.B (--[^\n]+)\n(.*?)(?=^\.)", self.man_page(program, 1), re.MULTILINE | re.DOTALL)
            helped = self.called(program, "--help").split("\nKeys")[0]
            for option, default in re.findall(r"^  (?:-\w \[ )?(--[a-z][a-z-]*)(?: \])?(?: arg \(=([^)]*)\))?", helped,
                                              re.MULTILINE):
                words = f"(default: {default})" if default else ""
                is_named = any(option in re.findall(r"--[a-z-]+", options) and words in meaning
                               for options, meaning in printed)
                self.assertTrue(is_named or option in POSITIONAL, f"{program} {option} {words}")
            known = helped + "".join(self.called(program, command, "--help") for command in commands)
            for option in re.findall(r"--[a-z-]+", " ".join(options for options, _ in printed)):
                self.assertRegex(known, rf"(?m)^  .*{option}\b")

    def test_man_pages_have_what_belongs_to_one_and_lead_to_others_that_are_there(self):
        pages = {(path.stem, path.suffix[1:]) for path in self.prefix.glob("share/man/man*/*")}
        self.assertEqual(len(pages), 7)
        for name, section in pages:
            page = self.man_page(name, section)
            of_a_program = ["SYNOPSIS", "EXAMPLES", "OPTIONS", "EXIT STATUS", "SEE ALSO"] if section == "1" else []
            for heading in ["NAME", "DESCRIPTION", *of_a_program]:
                self.assertRegex(page, f'(?m)^\\.SH "?{heading}"?$', name)
            self.assertLessEqual(set(re.findall(r"([a-z-]+)\((\d)\)", page)), pages, name)
            for place in re.findall(r"docs/[^\]\s]+\.md", page):
                self.assertTrue((self.prefix / "share/doc/clogsweep" / place).exists(), f"{name}: {place}")
            self.assertEqual([], re.findall(r"\\(?:sigma|sqrt|rho)|^\.TS", page, re.MULTILINE), name)

    def test_man_pages_have_every_key_and_column(self):
        schema = json.loads(self.called("clogsweep", "--schema"))
        for kind, naming, page in (("keys", "key", "keys"), ("columns", "name", "files")):
            words = set(re.findall(r"[\w-]+", self.man_page(f"clogsweep-{page}", 5).replace("\\-", "-")))
            for entry in schema[kind]:
                self.assertIn(entry[naming], words)

    def test_the_site_opens_without_a_network(self):
        site = self.prefix / "share/doc/clogsweep/html"
        for part in ("index.html", "reference/keys.html", "tutorial/own-device.html", "_static/mathjax/MathJax.js"):
            self.assertTrue((site / part).exists(), part)
        self.assertNotIn("import Gumshoe", (site / "_static/scripts/furo.js").read_text())


if __name__ == "__main__":
    unittest.main()
