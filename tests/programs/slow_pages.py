"""Runs commands of the handbook. slow_tutorial runs the tutorial, the README and some how-to pages without changes.
This test runs the commands of all other pages, each in a folder with the files that the command names. Commands that
take long are shortened or only parsed.
"""

import pathlib
import re
import shutil
import sys
import tempfile
import unittest

import numpy as np
from PIL import Image, ImageDraw

import pages
from drawing import Analysis
from test_device import gdsii
from support import FAMILIES, FEW, ROOT, SMALL

from clogsweep.commands import agreement, collision, figures, predict
from clogsweep.paper.plate import CATALOGUE
from clogsweep.paper.runner import Override

FOLLOWED = {*pages.PAGES, *pages.tutorial()}
PAGES = sorted({str(path.relative_to(ROOT)) for part in ("how-to", "reference", "gallery", "explanation", "developer")
                for path in (ROOT / "docs" / part).glob("*.md")} - FOLLOWED)
PROGRAMS = ("clogsweep", "clogrun", "clogfit")
LAUNCHERS = {"mpirun": 3, "srun": 1}  # For each launcher, the number of words before the program.
# These commands are not run, because they need software that this machine may lack
NOT_RUN = {"docker", "spack", "sbatch", "qsub", "git", "sudo", "pydoc"}
# Options and keys that make the runs of a command short, by the first words of the command
SHORT = {"clogrun array": ["max-time=20", "seeds=1"], "clogrun replay": [],
         "clogrun channel": ["vertices=64", "start=-1.2", "end=-1"]}
# Commands of python3 -m clogsweep that take too long are only parsed
LONG = {"agreement": agreement, "collision": collision, "predict": predict}
SWEEP = ["preset=elastic", "line-tension=0.5,1,2,4", "seeds=1..4", *SMALL, "max-time=60"]


def own_program(words):
    """Removes the launcher from a command. @return the call, or nothing if it calls none of our programs"""
    while words and re.match(r"[A-Z_]+=", words[0]):
        words = words[1:]
    if words and words[0] in LAUNCHERS:
        words = words[LAUNCHERS[words[0]]:]
    if [pathlib.Path(word).name for word in words[:1]] == ["python3"] and words[1:3] == ["-m", "clogsweep"]:
        return words[1:]
    return words if words and words[0] in PROGRAMS else []


def replaced(words, options):
    """The words of a call. Options replace the keys with the same name."""
    keys = {word.split("=")[0] for word in options}
    return [word for word in words if word.split("=")[0] not in keys] + options


class Commands(Analysis):
    def setUp(self):
        super().setUp()
        self.write("sweep.cfg", "".join(word.replace("=", " = ") + "\n" for word in SWEEP))
        self.write("posts.csv", "x,y\n" + "".join(f"{x},{y}\n" for x in range(20) for y in range(20)))
        self.write("post.csv", "47,5.02\n")
        self.write("distances.csv", "distance [mm],clogged\n4.1,1\n9.8,0\n")
        self.write("lab.cfg", "diameter = 2 mm\nangle = 20 deg\n")
        self.write("angles.csv", "line_tension,lower,upper,runs\n1,18,20,3\n2,18,20,3\n")
        self.write("points.csv", "line-tension,obstacle-density\n0.5,0.4\n1,0.5\n")
        for name, keys in {"robust": [*FEW,
                                      "preset=robust"], "elastic": [*FEW, "preset=elastic"], "monday": [*FEW, "inertia=1"],
                           "tuesday": [*FEW, "inertia=2"], "sweep": SWEEP, "frictions": [*SWEEP, "friction=0,0.1"],
                           "here": [*SWEEP, "--shard", "1/2"], "there": [*SWEEP, "--shard", "2/2"],
                           "lattice": ["obstacle-layout=lattice", "pitch=3", "obstacle-diameter=1",
                                       "vertices=64", "box=200", "max-time=600",
                                       "terminal-speed=0.1", "line-tension=1,2", "lattice-angle=15,25", "seeds=1"],
                           "families": FAMILIES,
                           "wrapped": [*SMALL, "preset=elastic", "friction=0.2", "line-tension=0.05", "obstacle-gap=0.3", "max-time=3000", "seeds=1..2"]}.items():
            self.copy_sweep(f"{name}.h5", *keys)
        self.write("fit.json", self.succeed("clogfit", "sweep.h5", "--format", "json").stdout)
        self.succeed("clogsweep", "obstacles=posts.csv", "box=20", "release=anywhere", "vertices=64", "max-time=20",
                     "seeds=1..2", "--output", "device.h5")
        self.succeed("clogrun", "array", "line-tension=0.5", *SHORT["clogrun array"], "--output", "run.h5",
                     "--polygon-interval", "2")
        angles = 2 * np.pi * np.arange(48) / 48
        post = 30 * np.column_stack([np.cos(angles), np.sin(angles)])
        (self.folder / "mask.gds").write_bytes(gdsii([post + [200 * x, 200 * y] for x in range(4)
                                                      for y in range(4)], 1e-6))
        picture = Image.new("L", (900, 900), 255)
        for x in range(100, 900, 200):
            for y in range(100, 900, 200):
                ImageDraw.Draw(picture).ellipse((x - 40, y - 40, x + 40, y + 40), fill=0)
        picture.save(self.folder / "scan.png")

    def provide(self, words):
        """Removes the outputs of a command. Makes those inputs that the page does not make."""
        made = [words[words.index(option) + 1] for option in ("--output", "--frames") if option in words]
        for name in made:
            for path in self.folder.glob(f"{name.removesuffix('.h5')}*"):
                if path.is_file() and (path.name == name or ".h5" not in (name[-3:], path.suffix)):
                    path.unlink()
        for word in words:
            name = word.removeprefix("obstacles=")
            source = {".h5": "sweep.h5", ".csv": "posts.csv"}.get(pathlib.Path(name).suffix)
            if source and name not in made and "/" not in name and not (self.folder / name).exists():
                shutil.copyfile(self.prepared / source, self.folder / name)

    def check(self, words):
        program, *rest = ["frictions.h5" if word == "sweep.h5" and "--by" in words else word for word in words]
        self.provide(rest)
        if program == "-m":
            self.check_python(rest[1:])
        elif program == "clogsweep" and ("=" in rest[0] or rest[0].startswith("--")):
            self.succeed(program, *rest, "--print-config")
        elif program == "clogsweep" and rest[0] == "doctor":  # The command may find problems.
            self.assertIn(self.run_program(program, *rest).returncode, (0, 1))
        elif program == "clogfit" and rest[0] == "calibrate":  # The command takes minutes.
            (self.folder / "trial.csv").unlink()
            self.refuse(program, *rest, words=["cannot read trial.csv"])
        else:
            short = SHORT.get(f"{program} {rest[0]}", [])
            # --watch would wait for the end of the sweep.
            self.succeed(program, *replaced([word for word in rest if word != "--watch"], short))

    def check_figures(self, words):
        sys.argv[1:] = words
        arguments = figures.parse()
        for name in arguments.names:
            self.assertIn(name, {*CATALOGUE, "list", "all"})
        for text in getattr(arguments, "set"):
            Override.parse(text)

    def check_python(self, words):
        command, *rest = words
        if command == "figures":
            self.check_figures(rest)
        elif command in LONG:
            sys.argv[1:] = rest
            LONG[command].parse()
        elif command == "refine":  # The launcher on the page may be one of a cluster.
            done = self.analyse(command, *rest[:rest.index("--")], "--dry-run")
            self.assertEqual(done.returncode, 0, done.stderr)
        else:
            sweep = {"device": "device.h5", "clogs": "wrapped.h5", "daughters": "families.h5"}.get(command, "sweep.h5")
            stand_ins = {"/dev/stdin": "fit.json", "sweep.h5": sweep}
            if command == "export":  # The command never replaces a file.
                (self.folder / rest[-1]).unlink(missing_ok=True)
            done = self.analyse(command, *(stand_ins.get(word, word) for word in rest))
            self.assertEqual(done.returncode, 0, done.stderr)

    def test_every_command_of_the_other_pages(self):
        self.prepared = self.folder
        for page in PAGES:
            with tempfile.TemporaryDirectory(prefix="clog_page_") as name:
                self.folder = pathlib.Path(name)
                shutil.copytree(self.prepared, self.folder, dirs_exist_ok=True)
                for words in pages.commands(page):
                    own = own_program(words)
                    if not own and {*words} & {*PROGRAMS}:
                        self.assertTrue({*words[:3]} & NOT_RUN, f"{page}: {words}")
                    elif own:
                        with self.subTest(page=page, words=" ".join(words)):
                            self.check(own)
        self.folder = self.prepared


class Pictures(Analysis):
    def stored(self, path):
        """The call of the program that made the rows of a picture. A picture of `figures` has no such call, so its
        result is empty."""
        with Image.open(path) as picture:
            about = picture.info.get("Description", "")
        for line in about.splitlines():
            words = line.split()
            if words[:1] and words[0] in PROGRAMS and "--version" not in words and any("=" in word for word in words):
                return words
        return []

    def keys(self, words):
        return {word for word in words if re.match(r"[a-z-]+=", word) and not word.startswith("--")}

    def test_a_picture_s_command_is_the_one_on_its_page(self):
        compared = 0
        for path in sorted((ROOT / "docs/pictures").glob("*.png")):
            shown = [page for page in (ROOT / "docs").glob("*/*.md") if f"pictures/{path.name}" in page.read_text()]
            words = self.stored(path)
            if not words or path.name.startswith("figure-") or not self.keys(words):
                continue
            with self.subTest(picture=path.name):
                calls = [self.keys(own_program(call)) for page in shown
                         for call in pages.commands(page.relative_to(ROOT))]
                self.assertIn(self.keys(words), calls)
                compared += 1
        self.assertGreater(compared, 1)


if __name__ == "__main__":
    unittest.main()
