"""Tests that names and words with any bytes are shown as text, and that outputs of the Python package are complete and
in UTF-8."""

import json
import os
import subprocess
import sys
import unittest
from unittest import mock

import pandas
from matplotlib.text import Text
from PIL import Image, ImageDraw

import stored_rows
from drawing import Analysis
from support import BIN, LONGEST, QUICK, ROOT

import clogsweep
from clogsweep import style
from clogsweep.labels.groups import Groups
from clogsweep.tools import outputs, texts

CIRCLES = os.fsdecode("ü".encode() + b"a$x^2$b\xff\x1b[31m.csv")
SHOWN = r"üa$x^2$b\xff\x1b[31m.csv"
SWEEP = os.fsdecode(b"s$1$\xfe\x1b.h5")
WORD = 'x,"y$1$\x1b['  # replaces the name of a preset


class Texts(unittest.TestCase):
    def test_what_no_terminal_shows_is_escaped(self):
        self.assertEqual(texts.printable("größe\x1b\udcff\n"), r"größe\x1b\xff\n")
        self.assertEqual(texts.printable("one\ntwo\t", "\n"), "one\ntwo\\t")

    def test_a_dollar_begins_no_formula(self):
        figure, name = style.new_figure(), "a$x^2$b"
        widths = [figure.text(0, 0, text, parse_math=has_formulas).get_window_extent().width
                  for text, has_formulas in ((texts.literal(name), True), (name, False))]
        self.assertEqual(*widths)


class Names(Analysis):
    def setUp(self):
        super().setUp()
        (self.folder / CIRCLES).write_text("x,y,diameter\n2,3,0.6\n7,8,1\n", encoding="utf-8")
        self.succeed("clogsweep", f"obstacles={CIRCLES}", "box=10", "vertices=64", "max-time=30", "line-tension=0.5,1",
                     "--output", SWEEP)

    def test_json_is_utf_8(self):
        for command in (["clogfit", SWEEP], ["clogfit", "compare", SWEEP, SWEEP], ["clogsweep", "status", SWEEP]):
            with self.subTest(command):
                json.loads(self.run_program(*command, "--format", "json").stdout)

    def test_pages_and_pictures_name_their_files(self):
        for command in ("device", "poster", "clogging-length"):
            with self.subTest(command):
                self.draw(command, SWEEP, "--output", f"{SWEEP}-{command}", "--programs", BIN)
                with Image.open(self.folder / f"{SWEEP}-{command}.png") as picture:
                    self.assertRegex(picture.info["Description"], r"b(\\xff|\ufffd)\\x1b\[31m.csv")
        printed = self.draw("report", SWEEP, "--examples", 0, "--programs", BIN).stdout
        self.assertEqual(printed, r"s$1$\xfe\x1b-report.html" + "\n")
        page = (self.folder / f"{SWEEP[:-3]}-report.html").read_text(encoding="utf-8")
        self.assertIn(SHOWN, page)
        self.assertNotIn("\x1b", page)

    def test_a_name_that_begins_with_a_dash_is_given_with_its_folder(self):
        os.rename(self.folder / SWEEP, self.folder / "-dash.h5")
        for command in (["device"], ["poster"], ["clogging-length"], ["dwell"], ["report", "--examples", 0]):
            with self.subTest(command):
                name, *options = command
                self.draw(name, "./-dash.h5", *options, "--output", f"./-{name}", "--programs", BIN)
        self.draw("export", "./-dash.h5", "./-rows.csv", "--programs", BIN)
        # These commands must read the sweep before they refuse it.
        for name, more, words in (("clogs", [], "no clogged polygon"), ("curve", [], "only 2 values"), ("critical-angle", [], "no lattices"), ("compare", ["./-dash.h5"], "no ratio to draw")):
            with self.subTest(name):
                self.refuse_analysis(name, "./-dash.h5", *more, "--programs", BIN, words=[words])

    def test_pictures_do_not_depend_on_settings_of_the_user(self):
        (self.folder / "matplotlibrc").write_text("text.usetex: True\nbackend: GTK4Cairo\nfont.size: "
                                                  "30\naxes.grid: True\n")
        command = [sys.executable, "-m", "clogsweep", "clogging-length", os.fsencode(SWEEP), "--programs", str(BIN), "--output"]
        around = {"cwd": self.folder, "capture_output": True, "text": True}
        usual = {**os.environ, "PYTHONPATH": str(ROOT / "analysis")}
        pictures = []
        for name, foreign in (("usual", {}), ("inline", {"MPLBACKEND": "module://matplotlib_inline.backend_inline"}), ("none", {"MPLBACKEND": "inline"}),
                              ("latex", {"MATPLOTLIBRC": str(self.folder / "matplotlibrc")})):
            folder = {"cwd": self.folder} if name == "latex" else {"cwd": ROOT}
            done = subprocess.run([*command[:4], self.folder / SWEEP, *command[5:], self.folder / name],
                                  **{**around, **folder}, env={**usual, **foreign}, check=False)
            self.assertEqual(done.returncode, 0, done.stderr)
            with Image.open(self.folder / f"{name}.png") as picture:
                pictures.append(picture.tobytes())
        self.assertEqual(len(set(pictures)), 1)
        for backend in ("inline", "module://matplotlib_inline.backend_inline"):
            report = subprocess.run([*command[:3], "report", self.folder / SWEEP, "--examples", "0", "--programs", str(BIN), "--output", self.folder / "r.html"], cwd=ROOT,
                                    env={**usual, "MPLBACKEND": backend}, capture_output=True, text=True, check=False)
            self.assertEqual(report.returncode, 0, report.stderr)

    def test_a_name_is_drawn_as_it_is(self):
        sweep = clogsweep.open(self.folder / SWEEP, BIN)
        for figure in (sweep.device(ways=0, map=0).figure, sweep.fit().curve().figure):
            with self.subTest(figure=figure):
                self.assertTrue(any(SHOWN.replace("$", r"\$") in text.get_text() for text in figure.findobj(Text)))
                figure.draw_without_rendering()

    def test_a_page_is_utf_8_in_every_locale(self):
        locale = {"LC_ALL": "C", "PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0"}
        done = subprocess.run([sys.executable, "-m", "clogsweep", "report", os.fsencode(self.folder / SWEEP), "--output", self.folder / "r.html", "--examples", "0",
                               "--programs", BIN], cwd=ROOT / "analysis", env={**os.environ, **locale}, capture_output=True, timeout=LONGEST)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn(SHOWN, (self.folder / "r.html").read_text(encoding="utf-8"))


class Words(Analysis):
    """Tests a file from elsewhere, with arbitrary words in its columns and attributes."""

    def setUp(self):
        super().setUp()
        sweep = self.copy_sweep("s.h5", *QUICK, "line-tension=0.5,3", "seeds=1..4", "--until-precision=90%",
                                "--most-seeds=4")
        stored_rows.change_columns(sweep, host=b"node\xff\x1b[31m")
        stored_rows.change_attribute(sweep, "stopping_rule", "until\x1b[31m red")

    def test_terminals_get_text(self):
        stored_rows.change_columns(self.folder / "s.h5", preset=WORD.encode())
        for command in (["clogsweep", "status", "s.h5"], ["clogsweep", "verify", "s.h5"], ["clogfit", "s.h5"], ["clogfit", "s.h5", "--format", "csv"],
                        ["clogfit", "compare", "s.h5", "--by", "line-tension"], ["clogfit", "curve", "s.h5"]):
            with self.subTest(command):
                done = self.run_program(*command)
                self.assertNotIn("\x1b", done.stdout + done.stderr)
        self.assertIn("until\\x1b[31m red\n", self.succeed("clogsweep", "status", "s.h5").stdout)

    def test_a_cell_of_csv_is_one_cell(self):
        stored_rows.change_columns(self.folder / "s.h5", preset=WORD.encode())
        (self.folder / "fit.csv").write_text(self.succeed("clogfit", "s.h5", "--format", "csv").stdout, encoding="utf-8")
        self.assertEqual(set(pandas.read_csv(self.folder / "fit.csv").preset), {'x,"y$1$\\x1b['})

    def test_pictures_draw_them(self):
        self.draw("report", "s.h5", "--examples", 0, "--programs", BIN)
        self.assertNotIn("\x1b", (self.folder / "s-report.html").read_text(encoding="utf-8"))
        printed = json.loads(self.succeed("clogfit", "s.h5", "--format", "json").stdout)
        for group in printed["groups"]:
            group["preset"] = WORD
        self.assertIn(r'preset x,"y\$1\$\x1b[', Groups(printed).caption())


class Outputs(Analysis):
    def test_a_file_that_cannot_be_finished_leaves_the_earlier_one(self):
        path = self.folder / "page.html"
        path.write_text("earlier", encoding="utf-8")
        with self.assertRaisesRegex(clogsweep.UserError, "cannot write .*page.html .No space left on device.; "
                                                         "look at the folder"), outputs.replaced(path) as fresh:
            fresh.write_text("half", encoding="utf-8")
            raise OSError(28, "No space left on device")
        self.assertEqual(self.snapshot(), {"page.html": b"earlier"})
        self.assertEqual(len(list(self.folder.iterdir())), 1)

    def test_a_link_and_a_mode_stay(self):
        path, link = self.folder / "page.html", self.folder / "latest.html"
        path.write_text("earlier", encoding="utf-8")
        path.chmod(0o640)
        link.symlink_to("page.html")
        with outputs.replaced(link) as fresh:
            fresh.write_text("new", encoding="utf-8")
        self.assertTrue(link.is_symlink())
        self.assertEqual((path.read_text(encoding="utf-8"), path.stat().st_mode & 0o777), ("new", 0o640))

    def test_a_report_that_fails_leaves_the_page_that_was_there(self):
        self.copy_sweep("s.h5", *QUICK, "line-tension=0.5,3", "seeds=1..4")
        page = self.folder / "s-report.html"
        page.write_text("<!DOCTYPE html> earlier", encoding="utf-8")
        with mock.patch("pathlib.Path.write_text", side_effect=OSError(28, "No space left on device")):
            self.refuse_analysis("report", "s.h5", "--examples", 0, "--programs", BIN,
                                 words=["cannot write s-report.html (No space left on device)"])
        self.assertEqual(page.read_text(encoding="utf-8"), "<!DOCTYPE html> earlier")

    def test_every_output_takes_the_place_of_the_earlier_one(self):
        """The earlier file has a second name, which must still lead to the old content: a command must not write into
        an earlier file."""
        self.copy_sweep("s.h5", *QUICK, "line-tension=0.5,3", "seeds=1..4")
        self.copy_sweep("run.h5", "array", *QUICK, "line-tension=3", "seeds=1", "--polygon-interval=20",
                        program="clogrun")
        picture = Image.new("L", (600, 300), 255)
        for x in (100, 300, 500):
            ImageDraw.Draw(picture).ellipse((x - 40, 110, x + 40, 190), fill=0)
        picture.save(self.folder / "mask.png")
        commands = [["report", "s.h5", "--examples", 0, "--programs", BIN],
                    ["clogging-length", "s.h5", "--programs", BIN], ["export-vtk", "run.h5", "--output", "run"],
                    ["droplet", "run.h5", "--output", "frames", "--pictures", "--size", "540p"],
                    ["circles", "mask.png", "--pixel", "2um", "--droplet", "200um", "--output", "posts"]]
        inputs = set(self.folder.rglob("*"))
        for command in commands:
            self.draw(*command)
        first = sorted(path for path in set(self.folder.rglob("*")) - inputs
                       if path.is_file() and path.suffix != ".txt")
        self.assertLessEqual({".html", ".png", ".pdf", ".pvd", ".vtp", ".csv"}, {path.suffix for path in first})
        before = {path: path.stat().st_ino for path in first}
        for number, path in enumerate(first):
            os.link(path, self.folder / f"kept{number}")
        for command in commands:
            self.draw(*command)
        self.assertEqual([path for path in first if path.stat().st_ino == before[path]], [])

    def test_metadata_of_pictures_are_text(self):
        style.Picture(style.subplots(figsize=(2, 2))[0], os.fsdecode(b"of \xff.h5")).save(self.folder / "p")
        with Image.open(self.folder / "p.png") as picture:
            self.assertEqual(picture.info["Description"], r"of \xff.h5")


if __name__ == "__main__":
    unittest.main()
