"""Tests devices of users: files of circles in any form, walls, entrance and exit, drawings of devices, and pictures of
devices."""

import contextlib
import io
import json
import re
import struct
import sys
import unittest
from unittest import mock

import h5py
import matplotlib
import numpy as np
import pandas
from matplotlib import image
from matplotlib.figure import Figure
from PIL import Image, ImageDraw, TiffImagePlugin

from drawing import Analysis
from support import BIN, table

import clogsweep
from clogsweep import style
from clogsweep.commands import circles
from clogsweep.device import areas, gds, lines, readers, shapes
from clogsweep.drawing import device as drawn
from clogsweep.drawing import device_plan
from clogsweep.tools.errors import UserError

# Places of posts, in droplet diameters.
ROW = [(4 + 3 * i, 0.9 + 1.7 * j + 0.6 * (i % 2)) for i in range(4) for j in range(3)]
# Columns of rows that are drawn without a file
COLUMNS = [*((name, float) for name in ("release_x", "release_y", "distance", "sound_distance", "lateral_displacement")),
           ("status", "S9"), ("mechanism", "S9"), ("release", "S9")]
KEYS = ["box=6", "length=18", "side-walls=on", "release=entrance", "entrance=1", "exit=16", "vertices=64", "line-tension=0.05",
        "max-time=2000", "seeds=1..3"]
SVG = """<svg xmlns="http://www.w3.org/2000/svg" width="3.6mm" height="1.2mm" viewBox="0 0 3600 1200">
<rect x="0" y="0" width="3600" height="1200" fill="none" stroke="black"/>{}</svg>"""


def box(left, bottom, right, top):
    return [(left, bottom), (right, bottom), (right, top), (left, top)]


def csv(scale=1.0):
    return "".join(f"{scale * x:.10g},{scale * y:.10g},{scale * 0.5:.10g}\n" for x, y in ROW)


class Walls(Analysis):
    def slide(self, angle, tolerance):
        """Without friction, a droplet slides along a wall at its terminal speed times the cosine of the angle between
        wall and flow. The droplet's speed along the flow is the terminal speed times the square of the cosine."""
        tangent = np.array([np.cos(np.radians(angle)), np.sin(np.radians(angle))])
        for radius, spacing, vertices in ((0.05, 0.0167, 128), (0.1, 0.0333, 64)):
            normal = np.array([-tangent[1], tangent[0]])
            centres = np.array([12, 14]) - radius * normal + np.arange(0, 14, spacing)[:, None] * tangent
            self.write("wall.csv", "".join(f"{x:.6f},{y:.6f},{2 * radius}\n" for x, y in centres))
            start = 14.6 + 1.2 * tangent[1]
            self.succeed("clogrun", "array", "obstacles=wall.csv", "box=30", "release=entrance", "entrance=9",
                         f"entrance-from={start}", f"entrance-to={start}", "line-tension=1", "terminal-speed=0.1",
                         f"vertices={vertices}", f"max-time={30 + 30 / tangent[0] ** 2:.0f}", "--output",
                         f"{angle}-{vertices}.h5")
            with h5py.File(self.folder / f"{angle}-{vertices}.h5") as file:
                run = file["trajectory"][:]
            end = run["time"] > run["time"][-1] - 20 / tangent[0] ** 2
            speed = np.polyfit(run["time"][end], run["distance"][end], 1)[0] / 0.1
            self.assertAlmostEqual(speed / tangent[0] ** 2, 1, delta=tolerance)


class Devices(Walls):
    def rows_of(self, text, name="posts.csv"):
        self.write(name, text)
        self.succeed("clogsweep", f"obstacles={name}", *KEYS[:-3], "line-tension=1", "max-time=20", "seeds=1..2",
                     "--output", f"{name}.h5")
        return table(self.folder / f"{name}.h5")

    def test_columns_in_any_order_separator_and_unit_are_the_same_device(self):
        expected = self.rows_of("x,y,diameter\n" + csv())
        others = {
            "blanks.txt": "y  r  x\n" + "".join(f"{y:.10g}\t  0.25  {x:.10g}\n".replace("\t", " ") for x, y in ROW),
            "excel.csv": "\ufeffid;X;Y;Diameter\n"
            + "".join(f"{i};{x:.10g};{y:.10g};0,5\n".replace(".", ",") for i, (x, y) in enumerate(ROW)),
            "um.csv": "# units=um droplet=0.2mm\nx,y,diameter\n" + csv(200),
            "odd.csv": "# units=um droplet=187um\n" + csv(187),
        }
        for name, text in others.items():
            with self.subTest(name):
                rows = self.rows_of(text, name)
                for column in ("obstacles", "distance", "lateral_displacement", "release_x", "release_y", "steps"):
                    self.assertEqual(rows[column].tolist(), expected[column].tolist(), column)

    def test_tables_of_other_programs_are_the_same_device(self):
        expected = self.rows_of("x,y,diameter\n" + csv())
        um = "# units=um droplet=200um\n"
        rows = [(i + 1, 200 * x, 200 * y) for i, (x, y) in enumerate(ROW)]
        tsv = "".join(f"{i}\t{x:.10g}\t{y:.10g}\t100\t\n" for i, x, y in rows)
        excel = "".join(f"{x:.10g};{y:.10g};100\n".replace(".", ",") for _, x, y in rows)
        tables = {
            "index.tsv": um + "\tx\ty\tdiameter\tlabel\n" + tsv,
            "imagej.tsv": um + " \tX\tY\tFeret\tLabel\n" + tsv,
            "excel.csv": "sep=;\n" + um.replace("\n", ";;\n") + '"X [µm]";"Y [µm]";"Durchmesser";"Diameter [µm]"\n' + excel.replace(";100", ";;100"),
            "old.csv": (um + "x (um),y (um),d (um)\n" + "".join(f"{x:.10g},{y:.10g},100\n" for _, x, y in rows)).replace("\n", "\r"),
            "blanks.csv": um + "x\u00a0[um],y_um,r/um\n" + "".join(f'"{x:.10g}\u00a0",\u202f{y:.10g},50\n' for _, x, y in rows),
            "quoted.csv": um + "x,y,d\n" + "".join(f'"{x:g}","{y:.1f}","100,0"\n'.replace(".", ",") for _, x, y in rows),
            "numpy.txt": "# y x d\n" + "".join(f"{y:.10g} {x:.10g} 0.5\n" for x, y in ROW),
            "pandas.csv": um + pandas.DataFrame(rows, columns=["id", "x", "y"]).assign(diameter=100.0).to_csv(),
            "pandas.tsv": um + pandas.DataFrame(rows, columns=["id", "x", "y"]).assign(diameter=100.0).to_csv(sep="\t", decimal=",", quoting=1),
        }
        for name, text in tables.items():
            for encoding in ("utf-8", "utf-16", "cp1252") if name == "excel.csv" else ("utf-8",):
                with self.subTest(name, encoding=encoding):
                    (self.folder / name).write_bytes(text.encode(encoding))
                    self.succeed("clogsweep", f"obstacles={name}", *KEYS[:-3], "line-tension=1", "max-time=20",
                                 "seeds=1..2", "--output", f"{name}.{encoding}.h5")
                    read = table(self.folder / f"{name}.{encoding}.h5")
                    self.assertEqual(read["obstacles"].tolist(), expected["obstacles"].tolist())

    def test_tables_that_may_be_read_in_two_ways_are_refused(self):
        um = "# units=um droplet=200um\n"
        for text, words in [("x [um],y [um],d [um]\n1,2,3\n", ["line 2", "# units=um droplet=200um", "your droplet's diameter"]),
                            (um + "x [mm],y [mm],d [mm]\n1,2,3\n", ["line 3", "in mm", "units=um"]), (um + "x [mm],y [um],d\n1,2,3\n", ["line 2", "y [um]", "one unit"]),
                            (um + "x [sigma],y,d\n1,2,3\n", ["line 3", "in sigma", "units=um"]), ("x;y;d\n1;2;0,5\n1.5;2;0,5\n", ["line 3", "x: '1.5'"]),
                            ("x [px],y [px],d [px]\n1,2,3\n", ["line 1", "'px' is no unit"]), ('x,y,d\n"1,234","2,345","0,100"\n', ["line 2", "x: '1,234'", "thousands"]),
                            ("x;y;d\n1,350;6;1\n2,050;3;1\n", ["'1,350'", "thousands"]),
                            ("# two\nx,y,d\n1,2,0.5\n3,3,0.5\n1.0,2,0.50\n",
                             ["line 5", "the circle of line 3 again", "delete one of the two lines"]),
                            ("x;y;d\num;um;um\n1;2;3\n", ["line 2", "'um' is not a finite number", "#"]),
                            ("x;y;d\n1.5;2.5;0,5\n", ["line 2", "d: '0,5'"]),
                            ("x,y,d\n1,2,\n", ["line 2", "d: is empty"]), ('x,y,d\n1,"2,3\n', ["line 2", "quote"]),
                            ("x y d\n1 2 3 4\n", ["line 2", "has 4 cells", "line of names has 3"]),
                            ("x,y,d\n1,2\n", ["line 2", "has 2 cells"]), ("x,y,d\n1,2m,3\n", ["line 2", "y: '2m'"])]:
            with self.subTest(text):
                self.write("bad.csv", text)
                self.refuse("clogsweep", "obstacles=bad.csv", "box=6", "--output", "x.h5", words=["bad.csv", *words])

    def test_files_that_say_too_little_are_refused(self):
        for text, words in [("a,b\n1,2\n", ["columns have to be x, y"]), ("x,y,width\n1,2,3\n", ["columns have to be", "width"]),
                            ("x,y,d,r\n1,2,1,1\n", ["leave one"]), ("x,X,y\n1,2,1\n", ["two columns for x, the second is 'X'"]), ("x,y,d,diameter\n1,2,1,1\n", ["two columns for the diameter, the second is 'diameter'", "delete one"]),
                            ("# units=um\nx,y\n1,2\n", ["line 1", "droplet=200um"]), ("# units=foot droplet=2foot\n1,2\n", ["'foot' is no unit"]),
                            ("# units=um droplet=-2um\n1,2\n", ["droplet must be"]), ("x,y,diameter\n1\n", ["line 2"]),
                            ("# units=um droplet=200um\nx,y\n100,200\n", ["line 3", "needs a diameter", "in um"])]:
            with self.subTest(text):
                self.write("bad.csv", text)
                self.refuse("clogsweep", "obstacles=bad.csv", "box=6", "--output", "x.h5", words=["bad.csv", *words])

    def test_a_drawing_in_place_of_circles_is_refused(self):
        self.write("posts.svg", SVG.format(""))
        self.refuse("clogsweep", "obstacles=posts.svg", "box=6", "--output", "x.h5",
                    words=["posts.svg is a drawing", "circles"])

    def test_a_device_is_swept_in_laboratory_units(self):
        self.write("posts.csv", "# units=um droplet=200um\nx,y,diameter\n" + csv(200))
        self.write("lab.cfg", "diameter = 0.2 mm\nangle = 90 deg\ntension = 0.1 mN/m\nspeed = 1 mm/s\n")
        self.succeed("clogsweep", "--lab", "lab.cfg", "obstacles=posts.csv", "box=6", "length=18", "max-time=20",
                     "seeds=1", "--output", "s.h5")
        printed = self.succeed("clogfit", "s.h5")
        self.assertIn("tension/(mN/m)", printed.stdout)
        self.assertEqual(printed.stderr, "")
        self.write("other.cfg", "diameter = 0.2 mm\nangle = 45 deg\n")
        self.assertIn("other.cfg replaces the laboratory stored with the rows",
                      self.succeed("clogfit", "s.h5", "--lab", "other.cfg").stderr)

    def test_droplets_that_rest_uncertified_are_named(self):
        # The top of a row of circles across the flow is flat, so it does not hold the droplet sideways.
        self.write("row.csv", "".join(f"10,{y:.4f},0.1\n" for y in np.arange(3, 7, 0.0167)))
        self.succeed("clogsweep", "obstacles=row.csv", "box=10", "length=20", "release=entrance", "entrance=8",
                     "entrance-from=4.9", "entrance-to=5.1", "line-tension=1", "vertices=64", "max-time=1500",
                     "seeds=1", "clog-detection=threshold", "clog-energy=1e-30", "--output", "s.h5")
        printed = self.succeed("clogfit", "s.h5").stdout
        self.assertRegex(printed, r"1 run ended by max-time with the droplet at rest for 1[34]\d\d t0 or longer: "
                         r"--dwell=1000 counts it as clogged")
        group, = json.loads(self.succeed("clogfit", "s.h5", "--dwell", 1000, "--format", "json").stdout)["groups"]
        self.assertEqual((group["clogs"], group["flowing"]), (1, 0))
        self.assertNotIn("with the droplet at rest", self.succeed("clogfit", "s.h5", "--dwell", 1000).stdout)
        # The droplet rests from the beginning to max-time, which is 1000 t0. The --dwell that clogfit suggests must be
        # shorter.
        self.succeed("clogsweep", "obstacles=row.csv", "box=10", "length=20", "release=entrance", "entrance=9.44",
                     "entrance-from=4.9", "entrance-to=5.1", "line-tension=1", "vertices=64", "max-time=1000",
                     "seeds=1", "clog-detection=threshold", "clog-energy=1e-30", "--output", "t.h5")
        self.assertIn("--dwell=900 counts it as clogged", self.succeed("clogfit", "t.h5").stdout)
        group, = json.loads(self.succeed("clogfit", "t.h5", "--dwell", 900, "--format", "json").stdout)["groups"]
        self.assertEqual(group["clogs"], 1)

    def test_notes_about_passed_and_resting_droplets_are_of_arrays_only(self):
        channel = ["obstacle-layout=channel", "terminal-speed=0.05", "start=-1.5", "end=1", "vertices=64"]
        self.succeed("clogsweep", *channel, "orifice=0.95", "max-time=2000", "--output", "passed.h5")
        self.succeed("clogsweep", *channel, "orifice=0.3", "max-time=1000", "clog-detection=threshold",
                     "clog-energy=1e-30", "--output", "rests.h5")
        self.assertEqual([table(self.folder / f"{name}.h5")["status"][0] for name in ("passed", "rests")],
                         ["passed", "flowing"])
        for name in ("passed", "rests"):
            printed = self.succeed("clogfit", f"{name}.h5").stdout
            self.assertNotIn("reached the exit", printed)
            self.assertNotIn("at rest", printed)

    def test_droplets_enter_pass_and_leave_between_walls(self):
        self.write("posts.csv", "x,y,diameter\n" + csv())
        self.succeed("clogsweep", "obstacles=posts.csv", *KEYS, "--output", "s.h5")
        rows = table(self.folder / "s.h5")
        self.assertEqual(set(rows["status"]), {"passed"})
        np.testing.assert_allclose(rows["release_x"], 1, atol=0.01)
        ends = rows["release_x"] + rows["distance"]
        self.assertTrue(((ends >= 16) & (ends < 16.2)).all(), ends)
        across = np.concatenate([rows["release_y"], rows["release_y"] + rows["lateral_displacement"]])
        self.assertTrue(((across > 0.3) & (across < 5.7)).all(), across)
        group, = json.loads(self.succeed("clogfit", "s.h5", "--format", "json").stdout)["groups"]
        self.assertEqual((group["runs"], group["clogs"], group["passed"]), (3, 0, 3))
        self.succeed("clogsweep", "verify", "s.h5")
        self.succeed("clogsweep", "replay", "s.h5", 1)

        self.draw("device", "s.h5", "--ways", 1, "--map", 2, "--programs", BIN)
        self.assert_picture("s-device")
        place = drawn.places(self.folder / "s.h5")[0]
        self.assertEqual((place.name, place.length, place.width, place.has_walls, len(place.circles)),
                         ("posts.csv", 18, 6, True, 12))
        self.draw("report", "s.h5", "--examples", 1, "--programs", BIN)
        page = (self.folder / "s-report.html").read_text()
        self.assertIn("posts.csv", page)
        self.assertIn('<th scope="col">passed</th>', page)
        self.assertLess(page.index("<h2>Table"), page.index("<h2>Devices"))
        self.assertLess(page.index("<h2>What may spoil"), page.index("<h2>Devices"))
        self.assertLess(page.index("<h2>Devices"), page.index("<h2>How busy"))
        self.assertIn("passed: droplets that reached the exit", self.succeed("clogfit", "s.h5").stdout)
        self.assertNotIn("few_clogs", group["doubts"] or [], "more seeds of droplets that all pass tell nothing new")

    def test_droplets_that_met_no_post_are_drawn(self):
        self.write("posts.csv", "x,y,diameter\n2,5,0.5\n4,5,0.5\n")
        self.succeed("clogsweep", "obstacles=posts.csv", "box=6", "length=6", "side-walls=on", "release=entrance",
                     "entrance-from=1", "entrance-to=2", "exit=6", "line-tension=1", "vertices=64", "max-time=500",
                     "seeds=1..2", "--output", "s.h5")
        group, = json.loads(self.succeed("clogfit", "s.h5", "--format", "json").stdout)["groups"]
        self.assertEqual((group["runs"], group["met_none"]), (0, 2))
        for command in ("clogging-length", "poster"):
            self.refuse_analysis(command, "s.h5", "--output", "c", "--programs", BIN,
                                 words=["no droplet of s.h5 met an obstacle"])
        for command, output in [("device", "device"), ("report", "report.html")]:
            self.draw(command, "s.h5", "--output", output, "--programs", BIN)
        self.assertTrue("2 of 2 runs finished (2 passed)" in (self.folder / "report.html").read_text())
        # Merged with a second sweep, the file also has groups with droplets that met posts.
        self.succeed("clogsweep", "obstacles=posts.csv", "box=6", "length=6", "side-walls=on", "release=entrance",
                     "entrance-from=4.5", "entrance-to=5.5", "exit=6", "line-tension=1", "vertices=64", "max-time=500",
                     "seeds=1..2", "--output", "t.h5")
        self.succeed("clogsweep", "merge", "s.h5", "t.h5", "--output", "both.h5")
        for command, output in [("clogging-length", "c"), ("poster", "poster"), ("report", "both.html")]:
            self.draw(command, "both.h5", "--output", output, "--programs", BIN)

    def test_droplets_that_all_start_at_one_place_are_one_droplet(self):
        self.write("posts.csv", "x,y,diameter\n2,5,0.5\n4,5,0.5\n")
        device = ["obstacles=posts.csv", "box=6", "release=entrance", "entrance=1", "exit=6", "line-tension=1", "vertices=64", "max-time=20"]
        for places in (["entrance-from=3.2", "entrance-to=3.2"], ["entrance-from=3,3.2", "entrance-to=3.20,4"]):
            self.refuse("clogsweep", *device, *places, "seeds=1..2", "--dry-run",
                        words=["invalid seeds=1..2", "entrance-from", "whatever the seed"])
            self.plan(*device, *places, "seeds=3")
        self.plan(*device, "entrance-from=3.2", "entrance-to=3.3", "seeds=1..2")
        self.plan(*device, "seeds=1..2")

    def test_each_line_tension_has_a_panel(self):
        self.write("posts.csv", "x,y,diameter\n" + csv())
        self.succeed("clogsweep", "obstacles=posts.csv", *KEYS[:-3], "line-tension=0.5,1,1.5,2,3,4,5", "max-time=150",
                     "seeds=1", "--output", "s.h5")
        sweep = clogsweep.Sweep(self.folder / "s.h5", BIN)
        groups, place = sweep.fit().known, drawn.places(self.folder / "s.h5", BIN)[0]
        self.assertEqual([part.label for part in place.parts(groups)],
                         [rf"$\Gamma = {value:g}$" for value in (0.5, 1, 1.5, 2, 3, 4, 5)])
        for part in place.parts(groups):
            self.assertEqual([rf"$\Gamma = {row['line_tension']:g}$" for row in part.place.rows], [part.label])
        with contextlib.redirect_stderr(io.StringIO()) as printed:
            figure = sweep.device(ways=1, map=0).figure
        self.assertIn("posts.csv: 6 of 7 parameter sets are drawn; clogsweep select", printed.getvalue())
        panels = [axes.get_ylabel() for axes in figure.axes]
        self.assertEqual([label.split("\n")[0] for label in panels],
                         [rf"$\Gamma = {value:g}$" for value in (0.5, 1, 1.5, 3, 4, 5)] + ["share that"])
        self.assertIn("6 of 7 parameter sets", figure.texts[0].get_text())

    def test_a_sweep_of_both_models_has_panels_for_both(self):
        self.write("posts.csv", "x,y,diameter\n" + csv())
        self.succeed("clogsweep", "obstacles=posts.csv", "box=6", "length=18", "model=dp,sp", "wall-stiffness=1",
                     "max-time=20", "seeds=1", "--output", "s.h5")
        sweep = clogsweep.Sweep(self.folder / "s.h5", BIN)
        parts = drawn.places(self.folder / "s.h5", BIN)[0].parts(sweep.fit().known)
        self.assertEqual([(part.label, part.place.rows["model"].tolist()) for part in parts], [("model dp", [b"dp"]), ("model sp", [b"sp"])])
        figure = sweep.device(ways=0, map=1).figure
        self.assertEqual([axes.get_ylabel() for axes in figure.axes[:2]],
                         [f"model {model}\n$y/\\sigma$" for model in ("dp", "sp")])
        self.assertIn("share of 1 droplet each", figure.axes[-1].get_ylabel())

    def test_the_scale_of_the_maps_is_there_whichever_panel_has_one(self):
        rows = np.array([(1.0, 2.0, 4.0, 4.0, 0.0, b"flowing", b"none", b"anywhere")], dtype=COLUMNS)
        place = drawn.Place(name="none", circles=np.empty((0, 3)), length=10.0, width=4.0, has_walls=False, exit=0.0, rows=rows)
        way = [np.array([(1.0, 2.0), (5.0, 2.0)])]
        shares = drawn.passages(place, way)
        for parts in ([drawn.Part("a", place, mapped=way, shares=shares),
                       drawn.Part("b",
                                  place)], [drawn.Part("a", place),
                                            drawn.Part("b", place, mapped=way, shares=shares)]):
            figure = drawn.draw(parts, 2, 0.2)
            self.assertEqual(len(figure.axes), 4)
            self.assertIn("$\\sigma$ = 0.2 mm", figure.axes[2].get_xlabel())

    def test_no_curve_is_fitted_through_the_lengths_of_a_device_with_an_exit(self):
        self.write("posts.csv", "x,y,diameter\n" + "".join(f"{x},{y},1.1\n" for x, y in ROW))
        keys = ["obstacles=posts.csv", *KEYS[:-3], "line-tension=2,3,4,5", "max-time=600", "seeds=1..2"]
        for name, more in (("with", []), ("without", ["exit=0"])):
            self.succeed("clogsweep", *[key for key in keys if not (more and key.startswith("exit"))], "--output",
                         f"{name}.h5")
            groups = clogsweep.Sweep(self.folder / f"{name}.h5", BIN).fit().known
            self.assertGreaterEqual(sum(group["clogs"] > 0 for group in groups.members), 3)
            self.assertEqual(groups.fitted_curve(groups.members) is not None, name == "without")

    def test_droplets_count_only_at_lines_downstream_of_their_release(self):
        """Compares the strip of the picture and the table of clogfit with a count in the rows. A trap is close to the
        entrance, and some droplets are released in voids behind this trap."""
        posts = [(1.2, 4.0), *((3, y) for y in (3.2, 4.05, 4.9)), *((7, 0.5 + 0.85 * i) for i in range(9))]
        self.write("posts.csv", "x,y,diameter\n" + "".join(f"{x},{y:.4f},0.5\n" for x, y in posts))
        self.succeed("clogsweep", "obstacles=posts.csv", "box=8", "length=14", "side-walls=on", "release=entrance",
                     "entrance=2.3", "exit=12", "line-tension=0.15,0.4", "vertices=64", "max-time=350", "seeds=1..30",
                     "--output", "s.h5")
        rows = table(self.folder / "s.h5")
        self.assertEqual(set(rows["status"]), {"passed", "clogged", "flowing"})
        behind = (rows["release_x"] > 3) & (rows["line_tension"] == 0.4)
        self.assertGreater(behind.sum(), 0)
        figure = clogsweep.Sweep(self.folder / "s.h5", BIN).device(ways=0, map=0).figure
        panels, strip = figure.axes[:2], figure.axes[-1]
        lines = strip.lines[0].get_xdata()[::3]
        groups = json.loads(self.succeed("clogfit", "s.h5", "--format", "json", "--lines", ",".join(f"{x:.17g}" for x in lines)).stdout)["groups"]
        for panel, curve, group in zip(panels, strip.lines, groups, strict=True):
            own = rows[rows["line_tension"] == group["line_tension"]]
            for passage, share in zip(group["passages"][:-1], curve.get_ydata()[::3], strict=True):
                x = passage["x"]
                before = own[own["release_x"] <= x]
                passed = before["release_x"] + before["distance"] >= x
                stopped = ~passed & (before["status"] == "clogged")
                self.assertEqual((passage["passed"], passage["stopped"]), (passed.sum(), stopped.sum()), x)
                np.testing.assert_allclose(share, passed.sum() / (passed.sum() + stopped.sum()) if passed.any() or stopped.any() else np.nan)
            displaced = ((own["release_x"] - 2.3).abs() > 0.01).sum()
            self.assertGreaterEqual(group["displaced"], displaced)
            self.assertLess(group["displaced"], 20)
            self.assertIn(f"released: 30, displaced: {group['displaced']}",
                          [text.get_text() for text in panel.get_legend().texts])
        # A line behind the exit is refused. A line at the exit is printed only once.
        self.refuse("clogfit", "s.h5", "--lines", "5,12.5",
                    words=["--lines=5,12.5", "12.5 is behind the exit at x = 12"])
        for group in json.loads(self.succeed("clogfit", "s.h5", "--format", "json", "--lines",
                                             "5,12").stdout)["groups"]:
            self.assertEqual([passage["x"] for passage in group["passages"]], [5, 12])
        printed = self.succeed("clogfit", "s.h5").stdout
        self.assertIn(f"{sum(group['displaced'] for group in groups)} droplets were released in the nearest "
                      "void, from x = ", printed)
        self.assertNotIn("nearest void", self.succeed("clogfit", self.rows_path("none")).stdout)

    def rows_path(self, name):
        """A sweep in which no droplet is displaced."""
        self.write(f"{name}.csv", "x,y,diameter\n" + csv())
        self.succeed("clogsweep", f"obstacles={name}.csv", *KEYS[:-1], "seeds=1..2", "--output", f"{name}.h5")
        return f"{name}.h5"

    def test_several_sizes_are_in_one_picture(self):
        posts = [(600, y) for y in (640, 810, 980)] + [(1400, 100 + 170 * i) for i in range(9)]
        self.write("posts.csv",
                   "# units=um droplet=200um\nx,y,diameter\n" + "".join(f"{x},{y},100\n" for x, y in posts))
        self.write("lab.cfg", "diameter = 160 um, 200 um, 240 um\nangle = 90 deg\ntension = 0.1 mN/m\nspeed = 1 mm/s\n")
        keys = ["obstacles=posts.csv", "box=1.6mm", "length=2.8mm", "side-walls=on", "release=entrance", "entrance=0.46mm", "exit=2.4mm", "vertices=64", "max-time=600"]
        self.succeed("clogsweep", "--lab", "lab.cfg", *keys, "seeds=1..4", "--output", "s.h5")
        figure = clogsweep.Sweep(self.folder / "s.h5", BIN).device(ways=1, map=1).figure
        panels, strip = figure.axes[:3], figure.axes[3]
        self.assertEqual([axes.get_ylabel() for axes in panels],
                         [f"diameter {mm:g} mm\n$y$ [mm]" for mm in (0.24, 0.2, 0.16)])
        self.assertEqual(strip.get_xlabel(), "$x$ [mm], along gravity")
        self.assertIn("posts.csv: 2.8 x 1.6 mm", figure.texts[0].get_text())
        posts_drawn = [axes.collections[0].get_paths()[3].get_extents() for axes in panels]
        for extents in posts_drawn:
            np.testing.assert_allclose(extents.extents, [1.35, 0.05, 1.45, 0.15], atol=1e-6)
        rows = table(self.folder / "s.h5")
        groups = json.loads(self.succeed("clogfit", "s.h5", "--format", "json").stdout)["groups"]
        for curve, group in zip(strip.lines, groups, strict=True):
            at, shares = curve.get_data()
            passage = group["passages"][1]
            self.assertAlmostEqual(passage["x"] * group["diameter_mm"], 1.4, places=5)
            self.assertAlmostEqual(shares[np.argmin(np.abs(at - 1.4))], passage["passed"] /
                                   (passage["passed"] + passage["stopped"]))
        self.draw("report", "s.h5", "--examples", 0, "--programs", BIN)
        self.assertEqual((self.folder / "s-report.html").read_text().count("posts.csv: releases"), 1)
        # Exported rows have the diameter of their droplet. The length of the device [sigma] is 2.8 mm.
        self.draw("export", "s.h5", "rows.csv", "--programs", BIN)
        exported = pandas.read_csv(self.folder / "rows.csv", float_precision="round_trip")
        np.testing.assert_allclose(exported["diameter_mm [mm]"] * exported["length [sigma]"], 2.8, rtol=1e-9)
        self.assertEqual((set(exported["angle_degrees [degrees]"]), exported["distance [sigma]"].tolist()),
                         ({90}, rows["distance"].tolist()))
        # The two files contain different devices, which must not be drawn as one device.
        self.write("other.csv", "# units=um droplet=200um\nx,y,diameter\n700,500,100\n")
        self.succeed("clogsweep", "--lab", "lab.cfg", "obstacles=other.csv", *keys[1:], "seeds=1", "--output", "other.h5")
        self.succeed("clogsweep", "merge", "s.h5", "other.h5", "--output", "both.h5")
        self.refuse_analysis("device", "both.h5", "--programs", BIN, words=["cannot draw 6 devices as one"])
        self.assertEqual(len(rows), 12)

    def test_parameter_sets_without_an_ended_run_have_no_panel(self):
        rows = np.array([(1.0, 2.0, 4.0, 4.0, 0.0, status, b"none", b"anywhere", tension)
                         for status, tension in ((b"flowing", 1.0), (b"running", 2.0))],
                        dtype=[*COLUMNS, ("line_tension", float)])
        place = drawn.Place(name="none", circles=np.empty((0, 3)), length=10.0, width=4.0, has_walls=False, exit=0.0, rows=rows)
        groups = mock.Mock(members=[{"line_tension": 1.0, "displaced": 0}, {"line_tension": 2.0, "displaced": 0}])
        groups.row_values, groups.label_of, groups.distinguishing.return_value = (lambda member: {"line_tension": member["line_tension"]}), str, []
        self.assertEqual(len(place.parts(groups)), 1)

    def test_a_line_of_a_device_without_exit_is_its_next_image(self):
        # The third droplet failed, and was last sound at x = 4.
        rows = np.array([(1.0, 0.0, 4.0, 4.0, 0.0, b"flowing", b"none", b"anywhere"),
                         (1.0, 0.0, 13.0, 13.0, 0.0, b"clogged", b"none", b"anywhere"),
                         (1.0, 0.0, 2.0, 2.0, 0.0, b"clogged", b"none", b"anywhere"),
                         (1.0, 0.0, np.nan, 3.0, np.nan, b"failed", b"none", b"anywhere")], dtype=COLUMNS)
        place = drawn.Place(name="none", circles=np.empty((0, 3)), length=10.0, width=4.0, has_walls=False, exit=0.0, rows=rows)
        at, shares = drawn.came_past(place)
        for x, share in ((0.5, 1 / 2), (2.0, 1), (3.5, 3 / 4), (4.5, 2 / 3), (8.0, 1 / 2)):
            self.assertAlmostEqual(shares[np.argmin(np.abs(at - x))], share, msg=x)

    def test_each_place_of_clogs_has_its_count(self):
        statuses = [b"clogged"] * 60 + [b"clogged"] * 3 + [b"clogged", b"passed"]
        ends = np.array([(4 + 0.001 * i, 2.0) for i in range(60)] + [(7.0, 1.0 + 0.1 * i) for i in range(3)] + [(8.0, 3.0), (9.0, 3.0)])
        rows = np.array([(1.0, 0.0, x - 1, x - 1, y, status, b"squeezed" if i % 2 else b"wrapped", b"entrance") for i, ((x, y), status) in enumerate(zip(ends, statuses))],
                        dtype=COLUMNS)
        place = drawn.Place(name="none", circles=np.empty((0, 3)), length=10.0, width=4.0, has_walls=True, exit=9.0, rows=rows)
        axes = drawn.draw([drawn.Part("", place)], 1).axes[0]
        counts = {text.get_text(): text.xy for text in axes.texts if text.get_text().isdigit()}
        self.assertEqual(sorted(counts), ["3", "60"], "a single clog has no number")
        np.testing.assert_allclose(counts["60"], (4.03, 2), atol=0.01)

    def test_gaps_between_posts_are_those_of_all_pairs(self):
        random = np.random.default_rng(1)
        for number, size in ((2, 1.0), (3, 1.0), (60, 1.0), (300, 1.0), (300, 0.05)):
            circles = np.column_stack([random.uniform(0, 40, number), random.uniform(0, 20, number), size * random.uniform(0.1, 0.6, number)])
            posts = np.arange(number) // 3
            gaps = np.hypot(*(circles[:, None, :2]
                              - circles[None, :, :2]).T) - (circles[:, None, 2] + circles[None, :, 2]) / 2
            gaps[posts[:, None] == posts] = np.inf
            device = shapes.Device(circles=circles, others=[], length=40, width=20, has_frame=True, droplet_metres=1,
                                   post_of=posts)
            self.assertAlmostEqual(device.smallest_gap(), gaps.min(), places=12)
            self.assertEqual({frozenset(posts[list(pair)]) for pair in device.overlaps()},
                             {frozenset((posts[i], posts[j])) for i, j in np.argwhere(gaps <= 0)})

    def test_rows_of_circles_that_close_are_filled(self):
        around = np.linspace(0, 2 * np.pi, 40, endpoint=False)
        ring = np.column_stack([5 + np.cos(around), 2 + np.sin(around), np.full(40, 0.4)])
        filler, alone = [(5, 2, 1.0)], [(9, 2, 0.5), (9.7, 2, 0.5)]
        open_row = np.column_stack([np.arange(0, 2, 0.1), np.full(20, 7), np.full(20, 0.4)])
        found, = device_plan.rings_among(np.vstack([alone, ring, filler, open_row]))
        np.testing.assert_array_equal(found, ring[:, :2])
        self.assertEqual(device_plan.rings_among(np.empty((0, 3))), [])

    def test_the_map_is_the_share_of_droplets_that_passed_over_a_place(self):
        def place(**others):
            return drawn.Place(name="none", circles=np.empty((0, 3)), length=10.0, width=4.0, rows=np.empty(3), **others)

        ways = [np.array([(1.0, 2.0), (9.0, 2.0)]), np.array([(1.0, 0.2), (3.0, 0.2)])]
        shares = drawn.passages(place(has_walls=True, exit=9.0), ways)
        self.assertEqual(shares.shape, (40, 100))
        middle = shares[:, 50]
        np.testing.assert_array_equal(middle[[16, 20, 23]], 0.5)
        np.testing.assert_array_equal(middle[[0, 5, 13, 27, 39]], 0)
        np.testing.assert_array_equal(shares[[0, 39], 20], [0.5, 0])
        self.assertEqual(drawn.passages(place(has_walls=False, exit=0.0), ways)[39, 20], 0.5, "it repeats across the flow")
        twice = drawn.passages(place(has_walls=False, exit=0.0), [np.array([(1.0, 2.0), (25.0, 2.0)])])
        np.testing.assert_array_equal(twice[20], 1)

    def test_droplets_slide_along_a_row_of_circles_as_along_a_flat_wall(self):
        self.slide(45, 0.001)

    def test_what_is_no_device_is_refused(self):
        self.refuse("clogsweep", "length=20", "--output", "x.h5", words=["length=20", "obstacles=FILE.csv"])
        self.write("posts.csv", csv())
        for keys, words in [(["length=18", "boxes=2"], ["boxes=2", "length"]),
                            (["length=18", "exit=20", "release=entrance"], ["exit=20"]),
                            (["length=18", "entrance=3"], ["entrance=3", "release=entrance"]),
                            (["length=9"], ["outside the array", "length=9"])]:
            self.refuse("clogsweep", "obstacles=posts.csv", "box=6", *keys, "--output", "x.h5", words=words)


class Drawings(Analysis):
    def circles(self, drawing, *options):
        done = self.draw("circles", drawing, "--droplet", "200um", "--output", "posts", *options)
        self.assert_picture("posts")
        rows = np.loadtxt(self.folder / "posts.csv", delimiter=",", skiprows=4) / 200
        self.assertIn("box=6 length=18", done.stdout)
        return rows[np.lexsort((rows[:, 1], rows[:, 0]))]

    def assert_posts(self, rows, tolerance):
        expected = np.array(sorted((x, y, 0.5) for x, y in ROW))
        np.testing.assert_allclose(rows, expected, atol=tolerance)

    def test_dxf(self):
        import ezdxf

        drawing = ezdxf.new("R2010")
        drawing.header["$INSUNITS"] = 13
        space = drawing.modelspace()
        space.add_lwpolyline([(100, 0), (3700, 0), (3700, 1200), (100, 1200)], close=True)
        block = drawing.blocks.new("POST")
        block.add_circle((0, 0), 50)
        for x, y in ROW:
            space.add_blockref("POST", (100 + 200 * x, 200 * y))
        space.add_text("not a post")
        drawing.saveas(self.folder / "device.dxf")
        self.assert_posts(self.circles("device.dxf"), 1e-6)
        # clogsweep reads posts.csv.
        self.succeed("clogsweep", "obstacles=posts.csv", *KEYS[:-2], "max-time=5", "seeds=1", "--output", "s.h5")
        self.assertEqual(len(table(self.folder / "s.h5")), 1)

    def test_gdsii(self):
        import gdspy

        cell, post = gdspy.Cell("DEVICE", exclude_from_current=True), gdspy.Cell("POST", exclude_from_current=True)
        post.add(gdspy.Round((0, 0), 50, number_of_points=64))
        for x, y in ROW:
            cell.add(gdspy.CellReference(post, (200 * x, 200 * y)))
        cell.add(gdspy.Rectangle((0, 0), (3600, 1200), layer=5))
        library = gdspy.GdsLibrary()
        library.add([cell, post])
        library.write_gds(str(self.folder / "device.gds"))
        self.assert_posts(self.circles("device.gds"), 2e-3)

    def gdsii(self, **cells):
        """Writes a GDSII file. @param cells  the polygons of each top cell"""
        import gdspy

        library = gdspy.GdsLibrary()
        for name, polygons in cells.items():
            library.add(gdspy.Cell(name, exclude_from_current=True).add(polygons))
        library.write_gds(str(self.folder / "device.gds"))

    @staticmethod
    def rounds(layer=1, datatype=0):
        import gdspy

        return [gdspy.Round((200 * x, 200 * y), 50, number_of_points=64, layer=layer, datatype=datatype) for x, y in ROW]

    def refused(self, *options, words, drawing="device.gds"):
        self.refuse_analysis("circles", drawing, "--droplet", "200um", "--output", "posts", *options, words=words)
        self.assertFalse((self.folder / "posts.csv").exists())

    def test_gdsii_layers_with_their_datatypes(self):
        import gdspy

        edge = gdspy.Rectangle((0, 0), (3600, 1200), layer=1, datatype=5)
        marks = [gdspy.Rectangle((300 + 40 * i, 20), (320 + 40 * i, 40), layer=1, datatype=7) for i in range(3)]
        self.gdsii(DEVICE=[*self.rounds(), *marks])
        self.refused("--layer", "2", words=["layer 2", f"1/0 with {len(ROW)} objects", "1/7 with 3 objects"])
        self.gdsii(DEVICE=[*self.rounds(), edge])
        for layer in ("1", None):
            self.assert_posts(self.circles("device.gds", *(["--layer", layer] if layer else [])), 2e-3)
            (self.folder / "posts.csv").unlink()
        alone = self.draw("circles", "device.gds", "--droplet", "200um", "--layer", "1/0", "--output", "alone").stdout
        self.assertIn(f"{len(ROW)} posts, device 10.5 x 5.5 droplet diameters (no edge is drawn)", alone)

    def test_posts_that_cross_the_rim_of_a_reservoir_do_not_vanish(self):
        import gdspy

        reservoir = gdspy.Round((0, 600), 2000, number_of_points=400, layer=3)  # its rim crosses posts
        edge = gdspy.Rectangle((-2100, -1500), (3600, 2700), layer=5)
        self.gdsii(DEVICE=[*self.rounds(), reservoir, edge])
        for options in ([], ["--as-circles"], ["--as-rows"]):
            with self.subTest(options=options):
                done = self.analyse("circles", "device.gds", "--droplet", "200um", "--output", "posts", *options)
                self.assertEqual(done.returncode, 2, done.stdout)
                self.assertFalse((self.folder / "posts.csv").exists())
        self.refused("--as-circles", words=["4 round posts would vanish", f"1/0 with {len(ROW)} objects", "3/0 with"])

    def test_one_of_several_top_cells(self):
        import gdspy

        edge = gdspy.Rectangle((0, 0), (3600, 1200), layer=5)
        self.gdsii(CHIP=[*self.rounds(), edge], TEST=gdspy.Rectangle((0, 5000), (100, 5100)))
        self.assert_posts(self.circles("device.gds", "--cell", "CHIP"), 2e-3)
        (self.folder / "posts.csv").unlink()
        self.refused("--cell", "NONE", words=["no cell NONE", "CHIP, TEST"])

    def test_posts_that_are_holes(self):
        import ezdxf
        import gdspy

        area = gdspy.Rectangle((0, 0), (3600, 1200), layer=1)
        # The area is drawn as one polygon with a slit to each hole, and as several pieces.
        for most_points in (10000, 60):
            self.gdsii(DEVICE=gdspy.boolean(area, self.rounds(), "not", max_points=most_points))
            with self.subTest(most_points=most_points):
                self.assert_posts(self.circles("device.gds", "--holes"), 2e-3)
                (self.folder / "posts.csv").unlink()
                if most_points > 60:
                    self.refused(words=["round hole", "--holes"])
        drawing = ezdxf.new("R2010")
        drawing.header["$INSUNITS"] = 13
        hatch = drawing.modelspace().add_hatch()
        hatch.paths.add_polyline_path([(0, 0), (3600, 0), (3600, 1200), (0, 1200)], is_closed=True, flags=1)
        for x, y in ROW:
            hatch.paths.add_edge_path(flags=16).add_arc((200 * x, 200 * y), 50, 0, 360)
        drawing.saveas(self.folder / "device.dxf")
        self.refused(words=["round hole", "--holes"], drawing="device.dxf")
        self.assert_posts(self.circles("device.dxf", "--holes"), 2e-3)
        (self.folder / "posts.csv").unlink()
        self.gdsii(DEVICE=self.rounds())
        self.refused("--holes", words=["no holes", "leave out --holes"])

    def test_holes_that_were_cut_into_pieces_are_counted_as_at_least(self):
        import gdspy

        # The area has five holes and consists of two pieces. The border between the pieces cuts the third hole. Pieces
        # with a gap between them are not united, so this hole is then not counted.
        holes = [gdspy.Round((400 + 500 * i, 600), 50, number_of_points=64) for i in range(5)]
        for gap, number in ((1, "at least 4"), (0, "5")):
            pieces = [gdspy.boolean(gdspy.Rectangle((left, 0), (left + 1400 - gap, 1200)), holes, "not", max_points=10000)
                      for left in (0, 1400)]
            self.gdsii(DEVICE=pieces)
            self.refused(words=[f"the drawing has {number} round holes", "--holes"])
        self.gdsii(DEVICE=gdspy.boolean(gdspy.Rectangle((0, 0), (2800, 1200)), holes, "not", max_points=10000))
        self.refused(words=["the drawing has 5 round holes", "--holes"])
        # The area consists of six pieces, and a border cuts each hole through its centre.
        pieces = [gdspy.boolean(gdspy.Rectangle((left, 0), (min(left + 500, 2800), 1200)), holes, "not", max_points=0)
                  for left in range(-100, 2800, 500)]
        self.gdsii(DEVICE=pieces)
        for option in ([], ["--as-circles"]):
            self.refused(*option, words=["the drawing has 5 round holes", "--holes"])
        self.draw("circles", "device.gds", "--droplet", "200um", "--output", "posts", "--holes")
        posts = np.loadtxt(self.folder / "posts.csv", delimiter=",", skiprows=4)
        np.testing.assert_allclose(posts[:, 2], 100, atol=0.2)  # circles of the area of polygons with 64 corners
        np.testing.assert_allclose(np.diff(np.sort(posts[:, 0])), 500, atol=0.2)

    def test_holes_that_touch_the_outer_edge_do_not_vanish(self):
        import gdspy

        def mask(*more, area=gdspy.Rectangle((0, 0), (3600, 1200))):
            self.gdsii(DEVICE=gdspy.boolean(area, [*self.rounds(), *(gdspy.Round(place, 50, number_of_points=64) for place in more)], "not", max_points=0))

        for places, edges in (([(1000, 1200)], 1), ([(1000, 1180), (2000, 0), (3600, 600)], 3), ([(3600, 1200)], 1)):
            with self.subTest(places=places):
                mask(*places)
                self.refused("--holes", words=["the device's edge is no rectangle: "
                                               f"it has {edges} indentation", "posts at the edge", "--region"])
        # A region that leaves out the indentation has a rectangular edge.
        mask((0, 600))
        self.refused("--holes", words=["0.25 droplet diameters", "x=50 um, y=600 um"])
        self.draw("circles", "device.gds", "--droplet", "200um", "--output", "posts", "--holes", "--region",
                  "60,0,3600,1200")
        self.assertEqual(len(np.loadtxt(self.folder / "posts.csv", delimiter=",", skiprows=4)), len(ROW))
        (self.folder / "posts.csv").unlink()
        # A post that touches the edge in a point is a post.
        mask((1000, 50))
        self.draw("circles", "device.gds", "--droplet", "200um", "--output", "posts", "--holes")
        self.assertEqual(len(np.loadtxt(self.folder / "posts.csv", delimiter=",", skiprows=4)), len(ROW) + 1)

    def test_holes_of_any_form_within_the_edge_do_not_vanish(self):
        import gdspy

        area, square = gdspy.Rectangle((0, 0), (3600, 1200)), gdspy.Rectangle((800, 200), (900, 300))
        holed = gdspy.boolean(area, square, "not", max_points=0)
        for name, posts in (("with posts in the holed area", self.rounds()), ("alone", [])):
            with self.subTest(name):
                self.gdsii(DEVICE=[holed, *posts])
                self.refused("--as-circles", words=["1 hole", "--holes"])
        # The hole in a hollow post is no post.
        hollow = gdspy.boolean(gdspy.Rectangle((1800, 1000), (2000, 1150)), gdspy.Rectangle((1850, 1050), (1950, 1100)),
                               "not", max_points=0)
        self.gdsii(DEVICE=[area, hollow, *self.rounds()])
        self.assertEqual(len(self.circles("device.gds", "--as-circles")), len(ROW) + 1)

    def test_an_edge_that_is_no_rectangle_is_refused(self):
        import ezdxf

        posts = [(700 + 600 * i, 600) for i in range(5)]
        reservoir = [(0, 0), (400, 0), (500, 400), (3600, 400), (3600, 800), (500, 800), (400, 1200), (0, 1200)]
        slanted = [(0, 0), (3600, 0), (3600, 1200), (1800, 1180), (0, 1200)]
        chamfered = [(200, 0), (3600, 0), (3600, 1200), (0, 1200), (0, 100)]
        rounded = [(8, 0), (3600, 0), (3600, 1195), (0, 1200), (0, 8)]
        for outline, depth in ((reservoir, "2 indentations, the deepest of 2 droplet"),
                               (slanted, "1 indentation, the deepest of 0.1 droplet"), (chamfered, "1 indentation"),
                               (rounded, None)):
            drawing = ezdxf.new("R2010")
            drawing.header["$INSUNITS"] = 13
            for place in posts:
                drawing.modelspace().add_circle(place, 50)
            drawing.modelspace().add_lwpolyline(outline, close=True)
            drawing.saveas(self.folder / "device.dxf")
            with self.subTest(depth=depth):
                if depth is None:
                    self.assertEqual(len(self.circles("device.dxf")), len(posts))
                else:
                    self.refused(words=["the device's edge is no rectangle", depth, "--region"], drawing="device.dxf")

    def test_small_lengths_keep_six_digits(self):
        # Two posts with a gap of 26.79 nm.
        import ezdxf

        gap, drawing = 0.02679, ezdxf.new("R2010")
        drawing.header["$INSUNITS"] = 13
        for x, y in ((1, 1), (1.3 + gap, 1), (1, 2.2)):
            drawing.modelspace().add_circle((x, y), 0.15)
        drawing.saveas(self.folder / "device.dxf")
        self.draw("circles", "device.dxf", "--droplet", "1um", "--output", "posts")
        rows = np.loadtxt(self.folder / "posts.csv", delimiter=",", skiprows=4)
        ways = rows[:, None, :2] - rows[None, :, :2]
        gaps = np.hypot(*ways.T) - rows[:, 2]
        self.assertAlmostEqual(gaps[~np.eye(len(rows), dtype=bool)].min() / gap, 1, places=5)

    def test_svg(self):
        self.write("device.svg",
                   SVG.format("".join(f'<circle cx="{200 * x}" cy="{1200 - 200 * y}" r="50"/>' for x, y in ROW)))
        self.assert_posts(self.circles("device.svg"), 2e-3)

    def test_a_picture(self):
        image = Image.new("L", (1800, 600), 230)
        pen = ImageDraw.Draw(image)
        for x, y in ROW:
            pen.ellipse([100 * (x - 0.25), 600 - 100 * (y + 0.25), 100 * (x + 0.25), 600 - 100 * (y - 0.25)], fill=40)
        image.save(self.folder / "mask.png")
        self.refuse_analysis("circles", "mask.png", "--droplet", "200um", "--output", "posts", words=["--pixel"])
        self.assert_posts(self.circles("mask.png", "--pixel", "2um"), 0.02)

    def test_posts_that_are_not_round_are_shown_and_refused(self):
        triangle = '<path d="M2000 500 L2100 500 L2050 600 Z"/>'
        self.write("device.svg", SVG.format(triangle + '<circle cx="800" cy="300" r="50"/>'))
        self.refuse_analysis("circles", "device.svg", "--droplet", "200um", "--output", "posts",
                             words=["1 post of 2 not round", "--as-circles"])
        self.assertFalse((self.folder / "posts.csv").exists())
        self.assert_picture("posts")
        rows = self.circles("device.svg", "--as-rows")
        posts = np.unique(rows[:, 2].round(6))
        self.assertAlmostEqual(posts[-1], 0.5, places=3)
        triangle = rows[rows[:, 2] < 0.3]
        self.assertGreater(len(triangle), 20)
        self.assertLess(np.ptp(triangle[:, 2]), 1e-4)
        # A circle within the outline that touches each side
        radius = triangle[0, 2] / 2
        corners = np.array([(10.0, 3.5), (10.5, 3.5), (10.25, 3.0)])  # y upwards
        for (x, y), (end_x, end_y) in zip(corners, np.roll(corners, -1, axis=0)):
            along = np.array([end_x - x, end_y - y])
            off = np.abs(along[0] * (triangle[:, 1] - y) - along[1] * (triangle[:, 0] - x)) / np.hypot(*along)
            self.assertAlmostEqual(off.min(), radius, delta=1e-4)
        printed = self.succeed("clogsweep", "obstacles=posts.csv", "box=6", "length=18", "side-walls=on",
                               "release=entrance", "entrance=8", "exit=13", "line-tension=1", "max-time=300",
                               "seeds=1..4", "--output", "s.h5")
        self.assertEqual(set(table(self.folder / "s.h5")["status"]), {"passed"}, printed.stderr)
        for name in ("posts.csv", "posts.png", "posts.pdf"):
            (self.folder / name).unlink()
        rows = self.circles("device.svg", "--as-circles")
        np.testing.assert_allclose(rows[:, 2].min(), 2 * np.sqrt(5000 / np.pi) / 200, rtol=0.02)

    def test_what_is_no_drawing_is_refused(self):
        self.write("device.txt", "nothing")
        self.write("broken.gds", "nothing")
        self.refuse_analysis("circles", "device.txt", "--droplet", "200um", "--output", "posts",
                             words=["device.txt", ".dxf"])
        self.refuse_analysis("circles", "broken.gds", "--droplet", "200um", "--output", "posts",
                             words=["cannot read broken.gds"])
        self.refuse_analysis("circles", "none.gds", "--droplet", "200um", "--output", "posts", words=["no such file"])
        self.refuse_analysis("circles", "none.gds", "--droplet", "200", "--output", "posts",
                             words=["--droplet", "200um"])
        self.write("posts.csv", "my own")
        self.write("device.svg", SVG.format('<circle cx="800" cy="300" r="50"/>'))
        self.refuse_analysis("circles", "device.svg", "--droplet", "200um", "--output", "posts",
                             words=["will not overwrite"])


class WrongDrawings(Analysis):
    """Tests drawings with content that the user may not have intended."""

    COMMAND = ["--droplet", "200um", "--output", "posts"]

    def dxf(self, unit=13, circles=(), outlines=(), lines=()):
        import ezdxf

        drawing = ezdxf.new("R2010")
        drawing.header["$INSUNITS"] = unit
        space = drawing.modelspace()
        for x, y in circles:
            space.add_circle((x, y), 50)
        for outline in outlines:
            space.add_lwpolyline(outline, close=True)
        for begin, end in lines:
            space.add_line(begin, end)
        drawing.saveas(self.folder / "device.dxf")

    def said_of(self, name, *options, **drawn):
        self.dxf(**drawn)
        return self.draw("circles", "device.dxf", "--droplet", "200um", "--output", name, *options).stdout

    def refuse(self, *options, words):
        super().refuse_analysis("circles", "device.dxf", *self.COMMAND, *options, words=words)
        self.assertFalse((self.folder / "posts.csv").exists())

    def test_a_device_too_large_or_too_small_for_the_droplet(self):
        edge, post = box(0, 0, 3600, 1200), box(500, 500, 600, 600)
        for unit, options, words in [(6, [], ["1.8e+07 by 6e+06 droplet diameters (the drawing's unit is m, "
                                              "in um it would be 18 by 6)", "$INSUNITS", "--droplet"]),
                                     (12, [], ["unit is nm"]), (0, ["--unit", "mm"], ["unit is mm", "check --unit"])]:
            with self.subTest(unit=unit):
                self.dxf(unit, outlines=[edge, post])
                self.refuse("--as-rows", *options, words=words)
                self.assertFalse((self.folder / "posts.png").exists())
        self.dxf(circles=[(800, 300), (800, 900)], outlines=[box(0, -20, 3600, 0), box(0, 1200, 3600, 1220)])
        self.refuse_analysis("circles", "device.dxf", "--droplet", "0.2m", "--output", "posts",
                             words=["0.018 by 0.0062 droplet diameters"])
        self.dxf(outlines=[box(0, 0, 36e4, 36e4), box(1e4, 1e4, 35e4, 35e4)])
        self.refuse("--as-rows", "--corner", "0.01", words=["circles (at most 200000)", "--corner"])
        self.write("device.svg", SVG.format('<circle cx="800" cy="300" r="50"/>').replace('width="3.6mm" height="1.2mm"', ""))
        self.refuse_analysis("circles", "device.svg", "--droplet", "10mm", "--output", "other", "--unit", "um", words=["unit is um"])
        self.refuse_analysis("circles", "device.svg", "--droplet", "10um", "--output", "other", words=["how long its unit is", "--unit, such as", "--pixel 0.2645833mm", "Inkscape before 0.92 had 90, --pixel 0.2822222mm"])
        printed = self.draw("circles", "device.svg", "--droplet", "200um", "--output", "old", "--pixel", "0.2822222mm").stdout
        self.assertIn("1 unit is 282.222 um", printed)  # 25.4 mm / 90

    def test_a_unit_other_than_the_drawing_states(self):
        self.dxf(circles=[(800, 300), (1600, 300)], outlines=[box(0, 0, 3600, 1200)])
        self.refuse("--unit", "mm", words=["--unit mm", "the drawing says um"])
        self.refuse("--pixel", "2um", words=["--pixel 2um", "the drawing says um"])
        self.draw("circles", "device.dxf", *self.COMMAND, "--unit", "um")
        self.write("device.svg", SVG.format('<circle cx="800" cy="300" r="50"/>'))
        self.refuse_analysis("circles", "device.svg", "--droplet", "200um", "--output", "other", "--unit", "um",
                             words=["the drawing says mm"])
        self.draw("circles", "device.svg", "--droplet", "200um", "--output", "other", "--unit", "mm")

    def test_lines_that_close_are_outlines(self):
        def sides(corners):
            return list(zip(corners, corners[1:] + corners[:1]))

        triangles = [[(x, 400), (x + 150, 400 + 1e-4), (x + 75, 550)] for x in (600, 1200, 1800)]
        lines = [side for corners in [box(0, 0, 3600, 1200), *triangles] for side in sides(corners)]
        loose = [((2500, 300), (2900, 700))]
        printed = self.said_of("posts", "--as-rows", lines=lines + loose)
        for words in ("3 posts, device 18 x 6", "13 lines closed into 4 outlines", "skipped: 1 LINE (lines red",
                      "draw closed outlines", "side-walls=on"):
            self.assertIn(words, printed)
        self.assertGreater(self.red().sum(), 100)
        crossing = [((500, 450), (2000, 450)), ((2300, 400), (2800, 400)), ((2350, 350), (2600, 900)),
                    ((2750, 350), (2500, 900))]
        printed = self.said_of("crossing", "--as-rows", lines=lines + lines[-3:] + crossing)
        for words in ("4 posts, device 18 x 6", "19 lines closed into 5 outlines", "skipped: 1 LINE"):
            self.assertIn(words, printed)
        printed = self.said_of("open", circles=[(800, 300), (1600, 300)], lines=sides(triangles[0])[:2])
        self.assertIn("skipped: 2 LINE", printed)
        with mock.patch.dict(sys.modules, {"shapely": None, "shapely.ops": None, "shapely.geometry": None}):
            printed = self.said_of("other", circles=[(800, 300), (1600, 300)], lines=lines)
        # The lines are parts of the device's edge.
        self.assertIn("2 outlines or lines extend along the whole device and are taken for walls", printed)
        self.assertIn("skipped: 11 LINE", printed)
        self.assertIn("install python3-shapely", printed)

    def red(self):
        """The red pixels of the picture."""
        pixels = image.imread(self.folder / "posts.png")
        return (pixels[..., 0] > 0.7) & (pixels[..., 1:3] < 0.5).all(axis=2)

    def run_printed(self, printed, *keys):
        """Runs the command that `circles` prints."""
        begin = printed.strip().splitlines()[-1].removesuffix(" ...").split()
        self.succeed(*begin, "line-tension=1", "vertices=64", "max-time=5", "seeds=1..2", *keys, "--output", "s.h5")
        return begin

    def test_without_an_edge_there_is_room_around_the_posts(self):
        printed = self.said_of("posts", circles=[(800, 300), (1600, 300), (1200, 900)])
        self.assertIn("no edge is drawn: the device ends half a droplet diameter beyond the posts on every side; "
                      "leave out side-walls=on", printed)
        self.assertNotIn("to a side", printed)
        self.assertIn("box=4.5", self.run_printed(printed))
        self.assertIn("length=5.5", printed)
        np.testing.assert_allclose(np.loadtxt(self.folder / "posts.csv", delimiter=",", skiprows=4)[0], (150, 150, 100))

    def test_walls_drawn_as_outlines_are_no_posts(self):
        walls, post = [box(0, -20, 3600, 0), box(0, 1200, 3600, 1220)], box(1500, 500, 1600, 600)
        printed = self.said_of("posts", "--as-rows", circles=[(800, 300), (800, 900)], outlines=[*walls, post])
        self.assertIn("2 outlines or lines extend along the whole device and are taken for walls: side-walls=on", printed)
        self.assertIn("3 posts, device 18 x 6 droplet diameters (between its walls)", printed)
        self.assertNotIn("no edge is drawn", printed)
        self.assertIn(", to a side 1.25 (250 um), in droplet diameters", printed)
        self.assertIn("side-walls=on", self.run_printed(printed))
        printed = self.said_of("one", circles=[(800, 300), (800, 900)], outlines=[box(0, -20, 3600, 1200), walls[0]])
        self.assertIn("1 outline or line extends along the whole device and is taken for a wall", printed)
        self.assertIn("box=6 length=18", printed)
        printed = self.said_of("down", "--flow", "down", circles=[(300, 800), (900, 800)],
                               outlines=[box(0, 0, 10, 3600), box(1200, 0, 1220, 3600)])
        self.assertIn("box=5.95 length=18", printed)
        with self.subTest("walls are single lines"):
            sides = [((0, 0), (3600, 0)), ((3600, 1200), (0, 1200))]
            printed = self.said_of("lines", circles=[(800, 300), (800, 900)], lines=[*sides, ((2500, 300), (2900, 700))])
            for words in ("2 outlines or lines extend along the whole device and are taken for walls",
                          "2 posts, device 18 x 6", "skipped: 1 LINE (lines red", "box=6 length=18"):
                self.assertIn(words, printed)

        posts, edge = [(800, 300), (800, 900)], box(0, 0, 3600, 1200)
        with self.subTest("a dimension line beside the device moves no edge"):
            self.assertIn("device 18 x 6",
                          self.said_of("dimension", circles=posts, outlines=[edge], lines=[((0, -200), (3600, -200))]))
            self.assertIn("device 18 x 6",
                          self.said_of("farther", circles=posts, lines=[*sides, ((-300, -900), (3900, -900))]))
        with self.subTest("of walls that are double lines the inner faces count"):
            double = [((0, -20), (3600, -20)), ((0, 1220), (3600, 1220))]
            printed = self.said_of("double", circles=posts, lines=[*sides, *double])
            self.assertIn("device 18 x 6", printed)
            self.assertNotIn("skipped", printed)
        with self.subTest("a long outline that is the only post is none"):
            printed = self.said_of("only", "--as-rows", outlines=[box(0, 500, 3600, 520)],
                                   lines=[((500, 800), (600, 900))])
            self.assertIn("1 post, device", printed)
        with self.subTest("a wall with teeth is a post"):
            teeth = [(3600 - 100 * i, 20 + 40 * (i % 2)) for i in range(37)]
            printed = self.said_of("teeth", "--as-rows", circles=[(800, 300), (800, 900)],
                                   outlines=[[(0, 0), (3600, 0), *teeth],
                                             box(0, 1200, 3600, 1220)])
            self.assertIn("1 outline or line extends along the whole device", printed)
            self.assertIn("3 posts", printed)

    def test_the_package_that_rows_need_is_named(self):
        self.dxf(outlines=[box(0, 0, 3600, 1200), box(500, 500, 600, 600)])
        with mock.patch.dict(sys.modules, {"shapely": None, "shapely.ops": None, "shapely.geometry": None}):
            self.refuse("--as-rows", words=["--as-rows needs python3-shapely (apt install python3-shapely)"])

    def test_rows_are_drawn_as_solid_posts(self):
        self.dxf(outlines=[box(0, 0, 3600, 1200), box(1600, 200, 2400, 1000)])
        self.draw("circles", "device.dxf", *self.COMMAND, "--as-rows")
        pixels = image.imread(self.folder / "posts.png")[..., :3]
        grey = (abs(pixels - np.array(matplotlib.colors.to_rgb(style.OBSTACLE))) < 0.02).all(axis=2)
        rows, columns = (np.flatnonzero(self.red().any(axis=axis)) for axis in (1, 0))
        self.assertGreater(grey[rows[0]:rows[-1], columns[0]:columns[-1]].mean(), 0.9)


def record(kind, form=0, data=b""):
    """A record of a GDSII file."""
    return struct.pack(">HBB", len(data) + 4, kind, form) + data


def real(value):
    """A number in GDSII, which consists of a sign, a power of 16, and 56 bits."""
    power = 0
    if value == 0:
        return bytes(8)
    while value < 1 / 16:
        value, power = value * 16, power - 1
    while value >= 1:
        value, power = value / 16, power + 1
    return struct.pack(">Q", (power + 64) << 56 | int(value * 2**56))


def gdsii(outlines, metres, more=b"", in_user_units=0.001):
    """A GDSII file, written byte by byte. @param outlines  in layer 1, in user units; @param metres  length of a user
    unit"""
    date = struct.pack(">12h", *[0] * 12)
    begin = [record(0, 2, struct.pack(">h", 600)), record(1, 2, date), record(2, 6, b"LIB "), record(3, 5, real(in_user_units) + real(in_user_units * metres)),
             record(5, 2, date), record(6, 6, b"TOP ")]
    shapes_of_it = [record(8) + record(13, 2, struct.pack(">h", 1)) + record(14, 2, struct.pack(">h", 0))
                    + record(16, 3, b"".join(struct.pack(">2i", *(round(value / in_user_units) for value in corner)) for corner in [*outline, outline[0]])) + record(17)
                    for outline in outlines]
    return b"".join([*begin, *shapes_of_it, more, record(7), record(4)])


class OtherTools(Analysis):
    """Tests drawings as other programs write them."""

    def device(self, name, *, layer=None, region=None, posts=None, droplet=200e-6, unit=None, tolerance=0.04):
        self.drawing = readers.read(self.folder / name, layer, posts)
        lines.join(self.drawing)
        areas.tidy(self.drawing, None if region is None else np.reshape(region, (2, 2)), tolerance)
        return shapes.understood(self.drawing, unit or self.drawing.metres, droplet, tolerance, 0)

    def circles_of(self, name, **options):
        """The circles of the drawing, in micrometres from the device's lower left corner."""
        device = self.device(name, **options)
        self.assertEqual([outline.tolist() for outline in device.others], [])
        circles = device.circles * device.droplet_micrometres
        return circles[np.lexsort(np.round(circles[:, 1::-1].T, 2))]

    def refused(self, name, *words, **options):
        with self.assertRaises(UserError) as printed:
            self.device(name, **options)
        self.assertEqual(len(str(printed.exception).splitlines()), 1)
        for word in words:
            self.assertIn(word, str(printed.exception))

    def dxf(self, unit=13):
        import ezdxf

        drawing = ezdxf.new("R2010")
        drawing.header["$INSUNITS"] = unit
        drawing.modelspace().add_lwpolyline(box(0, 0, 3600, 1200), close=True, dxfattribs={"layer": "EDGE"})
        drawing.layers.add("EDGE")
        return drawing, drawing.modelspace()

    def saved(self, drawing, **options):
        drawing.saveas(self.folder / "device.dxf")
        return self.circles_of("device.dxf", **options)

    # SVG

    def svg(self, body, **options):
        self.write("device.svg", SVG.format(body))
        return self.circles_of("device.svg", **options)

    def test_svg_shapes_in_transformed_groups(self):
        for transform, circle, expected in [("rotate(30 1000 600)", (1000, 600, 250), (1000, 600, 500)),
                                            ("translate(3600 0) scale(-1 1)", (800, 300, 50), (2800, 900, 100)),
                                            ("scale(1 -1) translate(0 -1200)", (800, 300, 50), (800, 300, 100)),
                                            ("matrix(0 1 -1 0 1200 0)", (400, 300, 50), (900, 800, 100)),
                                            ("rotate(90 600 600) scale(2)", (400, 200, 50), (800, 400, 200))]:
            for shape in ('<circle cx="{0}" cy="{1}" r="{2}"/>', '<ellipse cx="{0}" cy="{1}" rx="{2}" ry="{2}"/>'):
                with self.subTest(transform):
                    body = f'<g transform="{transform}">{shape.format(*circle)}</g>'
                    np.testing.assert_allclose(self.svg(body), [expected], rtol=1e-4, atol=1e-2)
        self.write("device.svg",
                   SVG.format('<g transform="translate(1000 600) skewX(45)"><rect width="100" height="200"/></g>'))
        device = self.device("device.svg")
        np.testing.assert_allclose(np.array(device.others) * 200, [[(1000, 600), (1100, 600), (1300, 400), (1200, 400)]], atol=0.01)

    def test_svg_symbols_are_drawn_only_where_they_are_used(self):
        post = '<symbol id="post" viewBox="0 0 10 10"><circle cx="5" cy="5" r="5"/></symbol>'
        uses = '<use href="#post" x="300" y="200" width="100" height="100"/><use href="#later"/><g id="later"><circle cx="900" cy="500" r="30"/></g>'
        np.testing.assert_allclose(self.svg(f"<g>{post}</g><marker><circle r='5'/></marker>{uses}"), [(350, 950, 100), (900, 700, 60)], atol=0.01)
        self.assertEqual(self.drawing.duplicates, 1)
        self.write("device.svg", SVG.format('<use href="#none"/>'))
        self.refused("device.svg", "'#none', which is not in the file")

    def test_svg_has_exact_corners(self):
        edge = '<svg xmlns="http://www.w3.org/2000/svg" width="60mm" height="1.2mm" viewBox="0 0 60000 1200">{}</svg>'
        self.write("device.svg", edge.format('<path d="M0 0 L60000 0 L60000 1200 L0 1200 Z"/><path d="M8000 300 a50 50 '
                                             '0 1 0 0.001 0 z"/>'))
        device = self.device("device.svg")
        self.assertAlmostEqual(device.length, 300, places=3)

    def test_svg_without_a_unit_asks_for_it(self):
        for size in ("", 'width="3600" height="1200"', 'width="3600px" height="1200px"', 'width="100%"'):
            with self.subTest(size):
                self.write("device.svg", SVG.format('<circle cx="800" cy="300" r="50"/>').replace('width="3.6mm" height="1.2mm"', size))
                np.testing.assert_allclose(self.circles_of("device.svg", unit=1e-6), [(800, 900, 100)], rtol=1e-3)
                self.assertIsNone(self.drawing.metres)

    def test_svg_shapes_that_are_not_seen_are_no_posts(self):
        styles = "<style>.none{fill:none} .clear{opacity:0.0}</style>"
        hidden = ['opacity="0"', 'style="opacity:0%"', 'class="none"', 'fill="none" stroke="none"', 'fill-opacity="0"', 'fill="none" stroke="black" stroke-width="0"', 'class="clear"',
                  'fill="none" stroke="black" stroke-opacity="0"', 'visibility="hidden"']
        body = "".join(f'<circle cx="{300 * i + 200}" cy="300" r="50" {attributes}/>' for i, attributes in enumerate(hidden))
        seen = '<circle cx="800" cy="900" r="50" fill="none" stroke="red"/><g opacity="0"><circle cx="500" cy="900" r="50"/></g>'
        np.testing.assert_allclose(self.svg(styles + body + seen), [(800, 300, 100)], rtol=1e-3)

    def test_svg_style_sheets_follow_the_cascade(self):
        # CSS 2.1, 6.4: !important decides first, then specificity, then the order in the sheet. `opacity` in CSS
        # applies to a group as a whole.
        c, left = 'class="c"', '<clipPath id="left"><rect width="600" height="1200"/></clipPath>'
        seen, post = '<circle cx="800" cy="900" r="50"/>', '<circle cx="1600" cy="300" r="50" {}/>'
        for sheet, around, attributes in [
                ("g.h circle{display:none}", "<g class='h'>*</g>", ""), ("circle.a.b{display:none}", "*", 'class="a b"'), ('circle[data-k="q"]{visibility:hidden}', "*", 'data-k="q"'),
                ("g > .c{opacity:0}", "<g>*</g>", c), ("circle.f{display:none !important}", "*", 'class="f" style="display:inline"'), ("#p{display:none} .c{display:inline}", "*", f'id="p" {c}'),
                (".c{display:inline} .c{display:none}", "*", c), ("desc + circle{fill:none}", "<g><desc/>*</g>", ""), ("g:nth-of-type(2) *{display:none}", "<g/><g>*</g>", ""),
                (".c{fill:none}", "*", f'{c} fill="red"'), (".c{display:inline !important} "
                                                            "#p{display:none !important}", "*", f'id="p" {c}'),
                ("/* a comment */ .C, .c{ display : none ; } ", "*", c), ("g{opacity:0} .c{opacity:1}", "<g>*</g>", c), ("<![CDATA[ g > .c{display:none} ]]>", "<g>*</g>", c),
                (".c{clip-path:none} g .c{clip-path:url(#left)}", "<g>*</g>", c), ("#page > .c{display:none}", "<g id='page'>*</g>", c)]:
            body = around.replace("*", post.format(attributes)) + seen
            for text in (f"<style>{sheet}</style>{left}{body}", f"{left}{body}<style>{sheet}</style>"):
                with self.subTest(text):
                    np.testing.assert_allclose(self.svg(text), [(800, 300, 100)], rtol=1e-3)
        for sheet, attributes in [(".c{display:none}", f'{c} style="display:inline"'),
                                  (".c{display:inline} circle{display:none}", c),
                                  ("circle:hover, .c:not(circle){display:none}", c),
                                  (".c{clip-path:none}", f'{c} clip-path="url(#left)"'),
                                  (".c{fill:inherit}", f'{c} fill="none"'), (".b{display:none}", c),
                                  ("</style><style>", ""), (".c{cy:300px}", c)]:
            with self.subTest(sheet):
                np.testing.assert_allclose(self.svg(f"<style>{sheet}</style>{left}{post.format(attributes)}"),
                                           [(1600, 900, 100)], rtol=1e-3)
                self.assertEqual(self.drawing.notes, [])

    def test_svg_values_that_css_drops_leave_the_value_before_them(self):
        # CSS 2.1, 4.2: a declaration with a value that its property does not have is dropped.
        circle = '<circle cx="800" cy="300" r="50" {}/><circle cx="400" cy="300" r="50"/>'
        for attributes in ('style="display:none;display:foo"', 'style="fill:none;fill:foo"',
                           'style="opacity:0;opacity:none"', 'style="visibility:hidden; visibility:none"',
                           'style="fill-opacity:0;fill-opacity:#1"', 'style="r:0px;r:bogus"', 'style="r:0;r:-3px"',
                           'clip-path="url(#none)" style="clip-path:foo"'):
            with self.subTest(attributes):
                np.testing.assert_allclose(self.svg('<clipPath id="none"/>' + circle.format(attributes)),
                                           [(400, 900, 100)], rtol=1e-3)
        for attributes in ('style="cy:300px;cy:bogus"', 'fill="red" style="fill:foo"', 'stroke-width="null"',
                           'display="foo"', 'visibility="none"'):
            with self.subTest(attributes):
                self.assertEqual(len(self.svg(circle.format(attributes))), 2)

    def test_svg_paints_in_every_notation(self):
        grid = '<linearGradient id="grid"><stop stop-color="red"/></linearGradient>'
        circle = '<circle cx="800" cy="300" r="50" {}/>'
        for paint in ("none", "transparent", "rgba(0,0,0,0)", "#1230", "currentColor", "CURRENTCOLOR", "context-fill",
                      "url(#nope) none", "url(#nope)"):
            for attributes in (f'fill="{paint}" color="transparent"', f'style="fill:{paint}; color:#0000"'):
                with self.subTest(attributes):
                    self.assertEqual(len(self.svg(grid + circle.format(attributes) + '<circle cx="400" cy="300" r="50"/>')), 1)
        for paint in ("red", "RED", "url(#grid) none", "url(#grid)", "url('#grid')", "url(#nope) red", "currentColor"):
            for attributes in (f'fill="{paint}"', f'style="fill:{paint}"'):
                with self.subTest(attributes):
                    self.assertEqual(len(self.svg(f'{grid}<g fill="none">{circle.format(attributes)}</g>')), 1)
                    self.assertEqual(self.drawing.notes, [])
        # An inherited currentColor is the colour of the element that inherits it.
        for colours, count in [(("transparent", "red"), 2), (("red", "transparent"), 1)]:
            self.assertEqual(len(self.svg('<circle cx="400" cy="300" r="50"/><g fill="currentColor" color="{}"><g color="{}">'.format(*colours) + circle.format("") + "</g></g>")), count)
        for opacity, count in [("0%", 0), ("0.0", 0), ("-1", 0), ("1e-1", 1), ("50%", 1), ("7", 1)]:
            for name in ("fill-opacity", "opacity"):
                with self.subTest(f"{name} {opacity}"):
                    self.assertEqual(len(self.svg('<circle cx="400" cy="300" r="50"/>' + circle.format(f'{name}="{opacity}"'))), 1 + count)

    def test_svg_shows_what_a_viewer_shows(self):
        seen, hidden = '<circle cx="800" cy="300" r="50"/>', '<circle cx="400" cy="300" r="50" {}/>'
        clipped, faint = hidden.format('clip-path="url(#c)"'), hidden.format('fill="url(#g)"')
        for body in ['<svg x="100" y="50" width="3000" height="1000"><use href="#u"/><symbol id="u" '
                     'overflow="visible"><circle cx="700" cy="250" r="50"/></symbol></svg>',
                     '<defs><circle id="a" cx="800" cy="300" r="50"/><circle id="a" r="80"/></defs><use href="#a"/>', f'<clipPath id="c"><g><rect width="9999" height="999"/></g></clipPath>{seen}{clipped}',
                     f'<clipPath id="c"><rect width="9999" height="999" visibility="hidden"/></clipPath>{seen}{clipped}', f'{seen}<foo>{hidden.format("")}</foo>', f'{seen}<pattern id="p">{hidden.format("")}</pattern>',
                     f'{seen}<marker>{hidden.format("")}</marker>', f'{seen}<G>{hidden.format("")}</G>', f'<linearGradient id="g"/>{seen}{faint}',
                     f'<linearGradient id="g"><stop stop-opacity="0"/></linearGradient>{seen}{faint}']:
            with self.subTest(body):
                np.testing.assert_allclose(self.svg(body), [(800, 900, 100)], rtol=1e-3)
        self.assertEqual(len(self.svg(f'<use href="#r"/><g id="r"><use href="#r"/></g>{seen}')), 1)
        for size in ('viewBox="0 0 0 0"', 'width="0" height="0"', 'width="3mm" height="1mm" viewBox="0 0 3 -1"'):
            self.write("device.svg", f'<svg xmlns="http://www.w3.org/2000/svg" {size}>{seen}</svg>')
            self.refused("device.svg", "no size")

    def test_svg_shows_the_first_alternative_that_a_browser_knows(self):
        # SVG 1.1, 5.8: an empty list is false. Illustrator stores its own data as the first alternative.
        circle = '<circle cx="{}" cy="300" r="50"/>'
        own = '<foreignObject requiredExtensions="http://ns.adobe.com/AdobeIllustrator/10.0/"/>'
        for body in [f"<switch>{own}<g>{circle.format(800)}</g></switch>", f'<switch><g systemLanguage="de">{circle.format(400)}</g>{circle.format(800)}{circle.format(1200)}</switch>',
                     f'<defs><switch id="s"><g systemLanguage="de"/>{circle.format(0)}</switch></defs><use '
                     'href="#s" x="800"/>']:
            with self.subTest(body):
                np.testing.assert_allclose(self.svg(body), [(800, 900, 100)], rtol=1e-3)

    def test_svg_sizes_below_zero_are_not_drawn(self):
        # SVG 2, 7.2: such a value is invalid and ignored. A radius of a corner is then automatic.
        seen = '<circle cx="400" cy="300" r="50"/>'
        for attributes in ('circle cx="800" cy="300" r="-50"', 'rect x="750" y="250" width="-100" height="100" rx="50"',
                           'rect x="750" y="250" width="100" height="-100"',
                           'ellipse cx="800" cy="300" rx="-50" ry="-50"'):
            with self.subTest(attributes):
                np.testing.assert_allclose(self.svg(f"<{attributes}/>{seen}"), [(400, 900, 100)], rtol=1e-3)
        for attributes in ('ellipse cx="800" cy="300" rx="-50" ry="50"',
                           'rect x="750" y="250" width="100" height="100" rx="-3" ry="50"'):
            np.testing.assert_allclose(self.svg(f"<{attributes}/>"), [(800, 900, 100)], rtol=1e-3)

    def test_svg_transforms_of_the_whole_drawing_are_refused(self):
        self.write("device.svg",
                   SVG.format('<circle cx="800" cy="300" r="50"/>').replace("<svg", '<svg transform="scale(2)"', 1))
        self.refused("device.svg", "transform of the whole <svg>")
        np.testing.assert_allclose(self.svg('<svg transform="translate(100 0)" width="3600" height="1200"><circle '
                                            'cx="700" cy="300" r="50"/></svg>'), [(800, 900, 100)], rtol=1e-3)

    def test_svg_what_librsvg_does_not_know_is_named(self):
        sheet = '@import "other.css"; @media (max-width: 9px){circle{display:none}} @layer base{circle{display:none}} @keyframes k{to{opacity:0}} .k{animation: k 1s}'
        self.assertEqual(len(self.svg(f'<style media="print">{sheet}</style><circle cx="800" cy="300" r="50" '
                                      'filter="url(#f)" mask="url(#m)" style="mix-blend-mode: multiply"/>')), 1)
        self.assertEqual(self.drawing.notes, ["ignored: @media, @layer, @import, animations, blend modes, masks, "
                                              "filters, media of style sheets"])
        self.assertEqual(len(self.svg('<pattern id="p" width="9" height="9"><path d="M0 0h9"/></pattern><path d="M0 0h9" marker="none"/><circle cx="800" cy="300" r="50" style="marker-end:url(#m)"/>')), 1)
        self.assertEqual(self.drawing.notes, ["ignored: patterns, markers"])
        self.write("device.svg",
                   '<?xml-stylesheet href="other.css"?>' + SVG.format('<circle cx="800" cy="300" r="50"/>'))
        self.assertEqual(len(self.circles_of("device.svg")), 1)
        self.assertEqual(self.drawing.notes, ["ignored: style sheets in other files"])
        self.assertEqual(len(self.svg('<!-- @import, transform-origin: '
                                      '0 --><settings/><circle cx="800" cy="300" r="50"/>')), 1)
        self.assertEqual(self.drawing.notes, [])

    def test_svg_filled_paths_that_are_open_are_outlines(self):
        self.write("device.svg", SVG.format('<path d="M800 300h100v80h-100"/><polyline points="1200,300 1300,300 1300,380"/><path d="M100 100h100"/><path d="M500 300h100v80h-100" fill="none" stroke="black"/>'))
        device = self.device("device.svg")
        np.testing.assert_allclose(sorted(abs(shapes.area(outline)) * 200**2 for outline in device.others),
                                   [4000, 8000], rtol=1e-3)
        self.assertEqual(len(device.lines), 1)

    def test_an_outline_that_crosses_itself_becomes_no_circle(self):
        self.write("device.svg", SVG.format('<path d="M2200 300L2320 660L2010 440H2390L2080 660z"/>'))
        self.refuse_analysis("circles", "device.svg", "--droplet", "200um", "--output", "posts", "--as-circles",
                             words=["crosses itself", "in the drawing"])

    def test_posts_that_touch_get_a_remedy_that_fits(self):
        circle = '<circle cx="800" cy="{}" r="{}"/>'
        for inner, words in [(circle.format(300, 30), ["1 pair of posts touch", "1 of them is one outline within another", "remove the inner one", "--holes"]),
                             ('<path d="M770 300a30 30 0 0 1 60 0a30 30 0 0 1 -60 0z"/>', ["remove the inner one"])]:
            with self.subTest(inner):
                self.write("device.svg", SVG.format(circle.format(300, 50) + inner))
                self.refuse_analysis("circles", "device.svg", "--droplet", "200um", "--output", "posts", words=words)
        self.assertEqual(circles.remedy_of_touching(mock.Mock(circles=np.array([(1.0, 1, 1), (1.8, 1, 1)])), [(0, 1)], False), "Separate them in the drawing")

    def test_svg_shapes_that_are_blended_stay(self):
        circle = '<circle cx="800" cy="300" r="50"{}/>'
        for body in (circle.format(' style="mix-blend-mode:multiply"'),
                     f'<g style="isolation:isolate">{circle.format("")}</g>',
                     f'<style>circle{{mix-blend-mode:screen}}</style>{circle.format("")}',
                     f'<g enable-background="new">{circle.format("")}</g>',
                     f'<g style="enable-background:new; opacity:0.5">{circle.format("")}</g>'):
            with self.subTest(body):
                np.testing.assert_allclose(self.svg(body), [(800, 900, 100)], rtol=1e-3)

    def test_svg_shows_what_its_clips_leave(self):
        circles = "".join(f'<circle cx="{x}" cy="300" r="50"/>' for x in (400, 800, 1200))
        left = '<clipPath id="left"><rect width="600" height="1200"/></clipPath>'
        turned = '<clipPath id="turned" transform="rotate(45)"><rect y="-200" width="1000" height="700"/></clipPath>'  # contains the point (400, 300)
        styles = "<style>.left, .other {fill:red; clip-path:url(#left)}</style>"
        moved = circles.replace("cx", 'transform="translate(500 0)" cx')
        for body in [f'{left}<g clip-path="url(#left)">{circles}</g>', f'<defs>{left}</defs><g style="clip-path: url(&quot;#left&quot;)">{circles}</g>', f'{styles}{left}<g class="post left">{circles}</g>',
                     f'{left}<g clip-path="url(#left)"><g transform="translate(-500 0)">{moved}</g></g>',
                     f'{left}<g transform="translate(-100 0)" clip-path="url(#left)"><g '
                     f'transform="translate(100 0)">{circles}</g></g>',
                     f'{turned}<g clip-path="url(#turned)">{circles}</g>']:
            with self.subTest(body):
                np.testing.assert_allclose(self.svg(body), [(400, 900, 100)], rtol=1e-3)
        both = f'{left}<clipPath id="right"><rect x="450" width="3000" height="1200"/></clipPath><g clip-path="url(#left)"><rect x="300" y="300" width="400" height="200" clip-path="url(#right)"/></g>'
        self.write("device.svg", SVG.format(both))
        np.testing.assert_allclose(np.ptp(self.device("device.svg").others[0] * 200, axis=0), [150, 200], rtol=1e-4)
        box_units = '<clipPath id="left" clipPathUnits="objectBoundingBox"><rect width="0.3" height="1"/></clipPath>'
        np.testing.assert_allclose(self.svg(f'{box_units}<g clip-path="url(#left)">{circles}</g>'), [(400, 900, 100)], rtol=1e-3)

    def test_svg_that_librsvg_would_show_elsewhere_is_refused(self):
        for attributes, name, remedy in [
                ('transform="scale(2)" transform-origin="1000 200"', "transform-origin", "ungrouping"), ('style="transform:scale(2); transform-box:fill-box"', "transform-box", "ungrouping"),
                ('style="translate: 5px"', "translate, rotate or scale", "ungrouping"), ('style="rotate:3deg"', "translate, rotate or scale", "ungrouping"),
                ('style="stroke:red; r:calc(1px + 2%)"', "calc() in r", "write the value itself"), ('style="fill:var(--a)"', "var() in fill", "write the value itself"), ('fill="var(--a)"', "var() in fill", "write the value itself"),
                ('style="stroke: 1px rgb(0 0 var(--a))"', "var() in stroke", "write the value itself"), ("style='fill: url(\"#g\") var(--a)'", "var())", "write the value itself"), ('cy="5vh"', "lengths that depend on a font", "px or mm")]:
            with self.subTest(attributes):
                self.write("device.svg", SVG.format(f'<circle cx="800" r="50" {attributes}/>'))
                self.refused("device.svg", f"librsvg does not know {name}", remedy)

    def test_svg_viewports_within_the_drawing_clip(self):
        circles = "".join(f'<circle cx="{x}" cy="300" r="50"/>' for x in (400, 800, 1200))
        for body in [f'<svg width="600" height="1200">{circles}</svg>', f'<svg width="16.6666666667%" viewBox="0 0 600 1200">{circles}</svg>', f'<svg width="600" height="1200" overflow="hidden">{circles}</svg>',
                     f'<svg x="-100" width="700" height="1200"><g transform="translate(100 0)">{circles}</g></svg>',
                     '<g transform="rotate(90)"><svg width="1200" height="600" y="-600"><g transform="translate(0 600) '
                     f'rotate(-90)">{circles}</g></svg></g>']:
            with self.subTest(body):
                np.testing.assert_allclose(self.svg(body), [(400, 900, 100)], rtol=1e-3)
        for attributes in ('overflow="visible"', 'style="overflow:auto"'):
            self.assertEqual(len(self.svg(f'<svg width="600" height="1200" {attributes}>{circles}</svg>')), 3)
        # A post that crosses the border of the viewport is cut. An empty viewport shows nothing, but shapes after it
        # are drawn.
        self.write("device.svg", SVG.format(f'<svg width="400" height="1200">{circles}</svg>'))
        np.testing.assert_allclose(np.ptp(self.device("device.svg").others[0] * 200, axis=0), [50, 100], rtol=1e-3)
        self.assertEqual(len(self.svg(f'<svg width="0" height="1200">{circles}</svg><circle cx="800" '
                                      'cy="300" r="50"/>')), 1)

    def test_svg_lengths_have_units(self):
        # SVG 2, 8.9: percentages refer to the viewport, and for r to the square root of (width^2 + height^2) / 2.
        percent = 50 / np.sqrt((3600**2 + 1200**2) / 2) * 100
        for shape in [f'<circle cx="800" cy="300" r="{percent}%"/>', '<circle cx="22.2222222%" cy="25%" r="50"/>', '<ellipse cx="800" cy="300" rx="50"/>', '<ellipse cx="800" cy="300" ry="50" rx="auto"/>',
                      '<rect x="750" y="250" width="2.7777778%" height="8.333333%" rx="50"/>', '<circle cx="800px" cy="225pt" r="0.5208333333in"/>', '<circle style="cx:800px; cy:300px; r:50px"/>',
                      '<rect/><circle cx="200" cy="300"/><circle cx="800" cy="300" r="50"/>', '<circle cx="8e2" cy="+300" r="50"/>', f'<svg x="0" y="0" width="3600" height="1200" viewBox="0 0 36 12"><circle cx="22.2222222%" cy="25%" r="{percent}%"/></svg>',
                      '<use href="#c" x="50%" y="0"/><defs><circle id="c" cx="-1000" cy="300" r="50"/></defs>']:
            with self.subTest(shape):
                np.testing.assert_allclose(self.svg(shape), [(800, 900, 100)], rtol=1e-4)
        for shape in ('<circle id="a" r="5em"/>', '<ellipse rx="3" ry="1ex"/>', '<rect x="1rem" width="9" height="9"/>',
                      '<circle cx="5vw" r="1"/>', '<circle style="r: 2em"/>'):
            with self.subTest(shape):
                self.write("device.svg", SVG.format(shape))
                self.refused("device.svg", "cannot read",
                             "librsvg does not know lengths that depend on a font or a window",
                             "give lengths in px or mm")
        self.write("device.svg", '<svg xmlns="http://www.w3.org/2000/svg"><circle r="5%"/></svg>')
        self.refused("device.svg", "lengths in per cent", "viewBox")

    def test_svg_objects_outside_the_page_are_left_out_and_named(self):
        frame = '<rect x="{0}" y="{1}" width="3600" height="1200" fill="none" stroke="black"/>'
        posts = '<circle cx="{0}" cy="{1}" r="50"/>'
        size, view = 'width="3600" height="1200"', 'viewBox="{0} {1} 3600 1200"'
        # The page follows from the size of the drawing, from its viewBox, or from both. The size has several units.
        for page, left, top in ((size, 0, 0), (view.format(0, 0), 0, 0), (view.format(500, 200), 500, 200),
                                (f"{size} {view.format(500, 200)}", 500,
                                 200), (f'width="3.6mm" height="1.2mm" {view.format(-300, 70)}', -300,
                                        70), (f'width="100%" height="100%" {view.format(500, 200)}', 500, 200)):
            for has_frame in (True, False):
                seen = [(left + x, top + y) for x, y in ((800, 300), (1600, 900), (2400, 600))]
                # Shapes are outside each side and each corner of the page. The edge of a shape may touch the page.
                for places in ([(3651, 600)], [(-51, 600)], [(800, 1300), (900, 2000)], [(800, -50)], [(3700, 1300), (4500, 1400), (-700, -900)], [(3640, -40)]):
                    beyond = [(left + x, top + y) for x, y in places]
                    self.write("device.svg", f'<svg xmlns="http://www.w3.org/2000/svg" {page}>' + frame.format(left, top) * has_frame + "".join(posts.format(*place) for place in [*beyond, *seen]) + "</svg>")
                    with self.subTest(page=page, beyond=beyond, has_frame=has_frame):
                        expected = [(800, 900, 100), (1600, 300, 100), (2400, 600, 100)]
                        if not has_frame:  # The device then begins half a droplet (100 um) beside the posts.
                            expected = [(x - 650, y - 150, diameter) for x, y, diameter in expected]
                        np.testing.assert_allclose(self.circles_of("device.svg", unit=1e-6 / self.width_in_drawing(3600)), expected, rtol=1e-3)
                        x, y = np.transpose(beyond)
                        count = f"{len(beyond)} object{'s' * (len(beyond) > 1)} wholly outside the page left out, "
                        words = re.fullmatch(re.escape(count) + r"at x=(\S+) to (\S+), y=(\S+) to (\S+) \(enlarge the page .*", self.drawing.notes[0])
                        np.testing.assert_allclose([float(word) for word in words.groups()], [x.min() - 50, x.max() + 50, y.min() - 50, y.max() + 50], atol=0.1)
        self.write("device.svg", SVG.replace('<rect x="0" y="0" width="3600" height="1200" fill="none" '
                                             'stroke="black"/>', "").format(posts.format(5000, 600)))
        self.refused("device.svg", "holds no posts", "1 object wholly outside the page", "x=4950 to 5050")
        printed = self.write("device.svg", SVG.format(posts.format(800, 600) + posts.format(5000, 600))) and self.draw("circles", "device.svg", "--droplet", "200um", "--output", "posts").stdout
        self.assertIn("read 3 objects; 1 object wholly outside the page left out, at x=4950 to 5050, "
                      "y=550 to 650", printed)
        self.assertIn("device 18 x 6 droplet diameters (its own edge)", printed)
        # A drawing without a size and without a viewBox has no page.
        self.write("device.svg",
                   f'<svg xmlns="http://www.w3.org/2000/svg">{posts.format(800, 300)}{posts.format(9000, -700)}</svg>')
        self.assertEqual(len(self.circles_of("device.svg", unit=1e-6)), 2)

    def width_in_drawing(self, width):
        """The factor by which the viewBox scales lengths. @param width  of the page in units of the drawing program"""
        found = readers.read(self.folder / "device.svg").from_own([(0, 0), (width, 0)])
        return float(np.ptp(found[:, 0])) / width

    def test_svg_objects_that_cross_the_border_of_the_page_are_treated_as_those_of_a_region(self):
        whole = SVG.replace('<rect x="0" y="0" width="3600" height="1200" fill="none" stroke="black"/>', "")
        posts = "".join(f'<circle cx="{x}" cy="{y}" r="50"/>'
                        for x, y in ((20, 600), (800, -20), (1600, 1180), (2400, 600), (3600, 600), (3620, 300)))
        self.write("device.svg", whole.format(posts))
        # The drawing has no edge, so the device begins half a droplet (100 um) beside the posts.
        np.testing.assert_allclose(self.circles_of("device.svg"), [(150, 730, 100), (1730, 150, 100), (2530, 730, 100)], atol=0.2)
        self.assertEqual(self.drawing.notes, ["3 posts left out that reach into the page from outside"])
        # The same posts are in a larger drawing, of which a region is read. The border of the region becomes the edge
        # of the device.
        self.write("device.svg", whole.replace('0 0 3600 1200', '-1000 -1000 7200 2400').replace("3.6mm", "7.2mm").replace("1.2mm", "2.4mm").format(posts))
        np.testing.assert_allclose(self.circles_of("device.svg", region=(0, 0, 3600, 1200)), [(20, 600, 100), (1600, 20, 100), (2400, 600, 100)], atol=0.2)
        # A background that is larger than the page becomes the edge of the page. A bar that crosses the border of the
        # page is cut.
        self.write("device.svg", whole.format('<rect x="-100" y="-200" width="3800" height="1600"/><rect x="3000" '
                                              'y="400" width="900" height="300"/><circle cx="800" cy="300" r="50"/>'))
        device = self.device("device.svg")
        np.testing.assert_allclose([device.length, device.width], [18, 6], rtol=1e-5)
        np.testing.assert_allclose(np.ptp(device.others[0] * 200, axis=0), [600, 300], rtol=1e-5)

    def test_svg_holes_in_filled_paths_are_posts(self):
        def turned(x, y, sweep):
            return f"M{200 * x - 50} {1200 - 200 * y} a50 50 0 1 {sweep} 100 0 a50 50 0 1 {sweep} -100 0 z "

        edge = "M0 0 H3600 V1200 H0 Z "  # clockwise, as sweep=1
        expected = [(200 * x, 200 * y, 100) for x, y in sorted(ROW)]
        page = SVG.replace('<rect x="0" y="0" width="3600" height="1200" fill="none" stroke="black"/>', "")
        for name, sweep, body in (("even-odd", 1, '<path fill-rule="evenodd" d="{}"/>'), ("even-odd, opposite", 0, '<path style="fill-rule:evenodd" d="{}"/>'),
                                  ("in a group", 1, '<g fill-rule="evenodd"><path d="{}"/></g>'), ("nonzero", 0, '<path d="{}"/>')):
            self.write("device.svg", page.format(body.format(edge + "".join(turned(x, y, sweep) for x, y in ROW))))
            with self.subTest(name):
                self.draw("circles", "device.svg", "--droplet", "200um", "--output", "posts", "--holes")
                rows = np.loadtxt(self.folder / "posts.csv", delimiter=",", skiprows=4)
                np.testing.assert_allclose(rows[np.lexsort((rows[:, 1], rows[:, 0]))], expected, rtol=1e-3)
                # Without --holes, outlines within the outline are still posts.
                np.testing.assert_allclose(self.circles_of("device.svg"), expected, rtol=1e-3)
        # An area and a boundary within it with the same direction have no hole. A path without a fill has no hole,
        # either.
        (self.folder / "posts.csv").unlink()
        for sweep, paint in ((1, ""), (0, 'fill="none" stroke="black"')):
            self.write("device.svg", page.format(f'<path {paint} d="{edge}{turned(4, 3, sweep)}"/>'))
            self.refuse_analysis("circles", "device.svg", "--droplet", "200um", "--output", "posts", "--holes",
                                 words=["no holes", "leave out --holes"])
        # The clip shows only the right half of the drawing.
        self.write("device.svg", page.format(f'<clipPath id="right"><rect x="1800" width="1800" height="1200"/></clipPath><path clip-path="url(#right)" fill-rule="evenodd" d="{edge}{turned(4, 3, 1)}{turned(13, 3, 1)}"/>'))
        self.draw("circles", "device.svg", "--droplet", "200um", "--output", "posts", "--holes")
        np.testing.assert_allclose(np.loadtxt(self.folder / "posts.csv", delimiter=",", skiprows=4), (800, 600, 100), rtol=1e-3)

    def test_svg_strokes_are_not_counted_and_that_is_said(self):
        post = '<g transform="scale(2)"><circle cx="400" cy="150" r="25" stroke="black" stroke-width="5"/></g><path d="M 900 600 h 0" stroke="black" stroke-width="100" stroke-linecap="round"/>'
        np.testing.assert_allclose(self.svg(post), [(800, 900, 100)], rtol=1e-3)
        printed = self.draw("circles", "device.svg", "--droplet", "200um", "--output", "posts").stdout
        self.assertIn("strokes not counted (of filled shapes at most 10 wide)", printed)
        self.assertIn("skipped: 1 dot", printed)
        self.write("device.svg", SVG.format('<circle cx="500" cy="500" r="50"/>'))
        self.assertNotIn("dot", self.draw("circles", "device.svg", "--droplet", "200um", "--output", "posts").stdout)

    def test_svg_of_matplotlib(self):
        figure = Figure(figsize=(3.6, 1.2))
        axes = figure.add_axes([0, 0, 1, 1], xlim=(0, 3600), ylim=(0, 1200))
        axes.set_axis_off()
        for x, y in [(800, 300), (1600, 900)]:
            axes.add_patch(matplotlib.patches.Circle((x, y), 50))
        axes.scatter([2400], [600], s=(0.1 * 72)**2, linewidths=0)  # A circle with a diameter of 0.1 inch.
        axes.add_patch(matplotlib.patches.Circle((-500, 600), 50))  # The axes clip this circle.
        figure.savefig(self.folder / "device.svg")
        np.testing.assert_allclose(self.circles_of("device.svg", droplet=0.2 * 25.4e-3) / 25.4, [(800, 300, 100), (1600, 900, 100), (2400, 600, 100)], rtol=1e-3)

    def test_svg_in_the_style_of_inkscape(self):
        self.write("device.svg", """<svg xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink" width="3.6mm" height="1.2mm" viewBox="0 0 3.6 1.2"
 xmlns:inkscape="http://www.inkscape.org/namespaces/inkscape"><g inkscape:groupmode="layer" transform="translate(1,-1)">
<rect style="fill:none;stroke:#000000" width="3.6" height="1.2" x="-1" y="1"/>
<g id="g1" transform="matrix(0.8,0.6,-0.6,0.8,0,1)"><circle style="fill:#00ff00" id="c1" cx="0.1" cy="0.1" r="0.05"/></g>
<use x="0" y="0" xlink:href="#g1" transform="translate(1)"/></g>
<g style="display:none"><circle cx="2" cy="0.5" r="0.2"/></g><text x="1" y="1">note</text></svg>""")
        np.testing.assert_allclose(self.circles_of("device.svg"), [(1020, 1060, 100), (2020, 1060, 100)], atol=0.02)
        self.assertEqual(dict(self.drawing.skipped), {"text": 1})

    # DXF

    def test_dxf_arrays_of_blocks(self):
        drawing, space = self.dxf()
        drawing.blocks.new("POST").add_circle((0, 0), 50)
        space.add_blockref("POST", (100, 100),
                           dxfattribs={"row_count": 5, "column_count": 8, "row_spacing": 200, "column_spacing": 300})
        np.testing.assert_allclose(self.saved(drawing),
                                   [(100 + 300 * i, 100 + 200 * j, 100) for i in range(8) for j in range(5)], atol=1e-9)

    def test_dxf_circles_in_mirrored_blocks_and_with_an_extrusion(self):
        drawing, space = self.dxf()
        drawing.blocks.new("POST").add_circle((10, 0), 50)
        space.add_blockref("POST", (800, 300), dxfattribs={"xscale": -1})
        space.add_blockref("POST", (1200, 300), dxfattribs={"yscale": -2, "xscale": 2, "rotation": 90})
        space.add_circle((-1600, 900), 50, dxfattribs={"extrusion": (0, 0, -1)})
        space.add_lwpolyline([(-1950, 300, 1), (-2050, 300, 1)], format="xyb", close=True,
                             dxfattribs={"extrusion": (0, 0, -1)})
        np.testing.assert_allclose(self.saved(drawing), [(790, 300, 100), (1200, 320, 200), (1600, 900, 100),
                                                         (2000, 300, 100)], atol=0.01)

    def test_dxf_polylines_with_a_width(self):
        drawing, space = self.dxf()
        donut = [(475, 600, 50, 50, 1), (525, 600, 50, 50, 1)]  # a disc of diameter 100, as DONUT draws it
        space.add_lwpolyline(donut, format="xyseb", close=True)
        space.add_lwpolyline([(950, 600, 1), (1050, 600, 1)], format="xyb", close=True, dxfattribs={"const_width": 20})
        np.testing.assert_allclose(self.saved(drawing), [(500, 600, 100), (1000, 600, 120)], atol=0.02)
        space.add_lwpolyline([(2000, 600), (2300, 600)], dxfattribs={"const_width": 40})
        drawing.saveas(self.folder / "device.dxf")
        bar, = self.device("device.dxf").others
        np.testing.assert_allclose([*bar.min(axis=0) * 200, *bar.max(axis=0) * 200], [2000, 580, 2300, 620], atol=0.01)

    def test_dxf_edge_with_a_width_ends_at_its_inner_side(self):
        drawing, space = self.dxf()
        space.add_lwpolyline(box(1000, 100, 2000, 700), close=True, dxfattribs={"const_width": 20})
        space.add_circle((1500, 400), 50)
        np.testing.assert_allclose(self.saved(drawing), [(490, 290, 100)], atol=0.01)

    def test_dxf_shows_what_the_drawing_program_shows(self):
        drawing, space = self.dxf()
        drawing.layers.add("OFF").off()
        drawing.layers.add("FROZEN").freeze()
        drawing.layers.add("Posts")
        block = drawing.blocks.new("POST")
        block.add_circle((0, 0), 40)
        block.add_circle((0, 300), 60, dxfattribs={"layer": "Posts"})
        for x, layer in [(500, "OFF"), (1000, "FROZEN"), (1500, "Posts")]:
            space.add_circle((x, 900), 50, dxfattribs={"layer": layer})
            space.add_blockref("POST", (x, 300), dxfattribs={"layer": layer})
        space.add_circle((2000, 300), 50, dxfattribs={"layer": "HIDE"})
        drawing.saveas(self.folder / "device.dxf")
        text = (self.folder / "device.dxf").read_text()
        self.write("device.dxf", text.replace("\nHIDE\n100\n", "\n0\n 60\n1\n100\n"))
        expected = [(500, 600, 120), (1500, 300, 80), (1500, 600, 120), (1500, 900, 100)]
        np.testing.assert_allclose(self.circles_of("device.dxf"), expected, atol=1e-9)
        self.assertEqual(dict(self.drawing.skipped), {"CIRCLE on layer OFF, which is off": 2, "CIRCLE on frozen layer FROZEN": 1, "INSERT on frozen layer FROZEN": 1, "invisible CIRCLE": 1})
        self.assertEqual(len(self.saved(drawing, layer="POSTS")), 4)
        space.add_blockref("LIBRARY", (0, 0))
        drawing.saveas(self.folder / "device.dxf")
        self.refused("device.dxf", "inserts 'LIBRARY', which is not in the file", "external references")

    def test_dxf_hatches(self):
        drawing, space = self.dxf()
        space.add_hatch().paths.add_edge_path().add_arc((500, 600), 50, 0, 360)
        space.add_hatch().paths.add_polyline_path([(950, 600, 1), (1050, 600, 1)], is_closed=True)
        space.add_circle((500, 600), 50)
        np.testing.assert_allclose(self.saved(drawing), [(500, 600, 100), (1000, 600, 100)], atol=0.02)
        self.assertEqual(self.drawing.duplicates, 1)
        frame = space.add_hatch()
        for edge in (box(-100, -100, 3700, 1300), box(100, 100, 3500, 1100)):
            frame.paths.add_polyline_path(edge, is_closed=True)
        np.testing.assert_allclose(self.saved(drawing), [(400, 500, 100), (900, 500, 100)], atol=0.02)
        crossing = space.add_hatch()
        for edge in (box(2000, 300, 2100, 400), [(2000, 300), (2100, 400), (2100, 300), (2000, 400)]):
            crossing.paths.add_polyline_path(edge, is_closed=True)
        drawing.saveas(self.folder / "device.dxf")
        self.refused("device.dxf", "x=2040, y=340", "crosses itself")

    def test_dxf_units(self):
        for unit, metres in [(9, 25.4e-6), (1, 25.4e-3), (8, 25.4e-9), (14, 0.1)]:
            drawing, space = self.dxf(unit)
            space.add_circle((500, 600), 50)
            drawing.saveas(self.folder / "device.dxf")
            self.assertAlmostEqual(self.device("device.dxf").droplet_metres, 200e-6)
            self.assertAlmostEqual(self.drawing.metres / metres, 1)
        drawing, _ = self.dxf(19)
        drawing.saveas(self.folder / "device.dxf")
        self.refused("device.dxf", "$INSUNITS=19", "13 for um")
        self.assertEqual(shapes.length_in_metres("8mil", "--droplet"), 8 * 25.4e-6)

    def test_dxf_in_the_style_of_librecad(self):
        pairs = ["0", "SECTION", "2", "HEADER", "9", "$ACADVER", "1", "AC1009", "0", "ENDSEC", "0", "SECTION", "2", "ENTITIES"]
        for x, y in ROW:
            pairs += ["0", "CIRCLE", "8", "0", "62", "256", "10", f"{200 * x:g}", "20", f"{200 * y:g}", "30", "0.0", "40", "50"]
        corners = box(0, 0, 3600, 1200)
        for (x, y), (end_x, end_y) in zip(corners, corners[1:] + corners[:1]):
            pairs += ["0", "LINE", "8", "0", "10", str(x), "20", str(y), "30", "0.0", "11", str(end_x), "21", str(end_y), "31", "0.0"]
        self.write("device.dxf", "".join(f"{word}\r\n" for word in [*pairs, "0", "ENDSEC", "0", "EOF"]))
        self.assertIsNone(readers.read(self.folder / "device.dxf").metres)
        np.testing.assert_allclose(self.circles_of("device.dxf", unit=1e-6),
                                   sorted((200 * x, 200 * y, 100) for x, y in ROW), atol=1e-6)

    # GDSII

    def test_gdsii_units(self):
        (self.folder / "device.gds").write_bytes(gdsii([box(0, 0, 4000, 1000), box(500, 500, 600, 600)], 25.4e-6))
        device = self.device("device.gds")
        self.assertAlmostEqual(device.length * 0.2, 101.6, places=6)
        self.assertEqual(self.drawing.unit, "mil")
        self.refuse_analysis("circles", "device.gds", "--droplet", "200um", "--output", "posts", "--unit", "um",
                             words=["--unit um contradicts", "the drawing says mil"])

    def test_gdsii_circles_that_the_writer_cut(self):
        import gdspy

        cell = gdspy.Cell("DEVICE", exclude_from_current=True)
        for x in (500, 800):
            cell.add(gdspy.Round((x, 600), 50, number_of_points=360, max_points=60))
        cell.add([gdspy.Rectangle((0, 0), (3600, 1200)), gdspy.Rectangle((0, 0), (3600, 1200)), gdspy.Rectangle((0, 0), (3600, 20))])
        library = gdspy.GdsLibrary()
        library.add([cell])
        library.write_gds(str(self.folder / "device.gds"))
        self.assertGreater(len(readers.read(self.folder / "device.gds").outlines), 10)
        np.testing.assert_allclose(self.circles_of("device.gds"), [(500, 580, 100), (800, 580, 100)], atol=0.02)
        self.assertEqual((self.drawing.united[1], self.drawing.duplicates), (2, 1))
        printed = self.draw("circles", "device.gds", "--droplet", "200um", "--output", "posts").stdout
        self.assertRegex(printed, r"read \d+ objects; \d+ outlines that touch united into 2 outlines; "
                         r"1 duplicate ignored; 1 unit is 1 um, 0.005 droplet diameters")
        third = [(500 + 50 * np.cos(angle), 600 + 50 * np.sin(angle)) for angle in np.linspace(0, 2 * np.pi / 3, 41)]
        turned = [[((x - 500) * c - (y - 600) * s + 500, (x - 500) * s + (y - 600) * c + 600)
                   for x, y in [(500, 600), *third]]
                  for c, s in [(np.cos(angle), np.sin(angle)) for angle in 2 * np.pi / 3 * np.arange(3)]]
        (self.folder / "thirds.gds").write_bytes(gdsii([box(0, 0, 3600, 1200), *turned], 1e-6))
        np.testing.assert_allclose(self.circles_of("thirds.gds"), [(500, 600, 100)], atol=0.1)

    def test_gdsii_that_gdspy_would_read_in_part_is_refused(self):
        a_box = record(0x2D) + record(13, 2, struct.pack(">h", 1)) + record(0x2E, 2, struct.pack(">h", 0)) + record(16, 3, struct.pack(">10i", *[0] * 10)) + record(17)
        reference = record(10) + record(0x12, 6, b"NONE") + record(16, 3, struct.pack(">2i", 0, 0)) + record(17)
        for more, words in [(a_box, ["BOX", "polygons"]), (reference, ["lacks the cells NONE"])]:
            (self.folder / "device.gds").write_bytes(gdsii([box(0, 0, 100, 100)], 1e-6, more))
            self.refused("device.gds", *words)

    def test_gdsii_arrays_are_those_of_explicit_references(self):
        def reference(kind, name, corners, angle=0.0, mirrored=False, magnified=1.0, counts=()):
            name = name.encode() + b"\0" * (len(name) % 2)
            transform = record(0x1A, 1, struct.pack(">H", 0x8000 * mirrored)) + record(0x1B, 5, real(magnified)) + record(0x1C, 5, real(angle))
            size = record(0x13, 2, struct.pack(">2h", *counts)) if counts else b""
            return record(kind) + record(0x12, 6, name) + transform + size + record(16, 3, struct.pack(f">{2 * len(corners)}i", *(1000 * value for corner in corners for value in corner))) + record(17)

        def polygons(references):
            """The polygons of a drawing. @param references  references in the cell TOP to the cell MID, which contains
            an oblique array of the cell POST"""
            date = record(5, 2, struct.pack(">12h", *[0] * 12))
            post = record(8) + record(13, 2, struct.pack(">h", 1)) + record(14, 2, struct.pack(">h", 0)) + record(16, 3, struct.pack(">8i", 0, 0, 30000, 0, 0, 20000, 0, 0)) + record(17)
            cells = record(7) + date + record(6, 6, b"POST") + post + record(7) + date + record(6, 6, b"MID\0")
            inner = reference(11, "POST", [(5, 7), (5 + 2 * 60, 7 + 2 * 10), (5 - 3 * 20, 7 + 3 * 50)], counts=(2, 3))
            (self.folder / "device.gds").write_bytes(gdsii([], 1e-6, references + cells + inner))
            return sorted(outline.round(6).tolist() for outline in readers.read(self.folder / "device.gds").outlines)

        corners = {tuple(outline[0]) for outline in polygons(reference(10, "MID", [(600, 150)]))}
        self.assertEqual(corners, {(605 + 60 * i - 20 * j, 157 + 10 * i + 50 * j) for i in range(2) for j in range(3)})
        for transform in [{}, {"angle": 30.0}, {"angle": 90.0}, {"mirrored": True},
                          {"angle": 90.0, "mirrored": True, "magnified": 0.5}]:
            for along, across in [((300, 150), (0, 300)), ((300, 0), (0, 300)), ((0, 300), (-300, 0)),
                                  ((300, 0), (0, -300)), ((300, 0), (100, 260))]:
                with self.subTest(along=along, across=across, **transform):
                    ends = [(600, 150), (600 + 3 * along[0], 150 + 3 * along[1]),
                            (600 + 2 * across[0], 150 + 2 * across[1])]
                    places = [(600 + i * along[0] + j * across[0], 150 + i * along[1] + j * across[1]) for i in range(3)
                              for j in range(2)]
                    expected = polygons(b"".join(reference(10, "MID", [place], **transform) for place in places))
                    self.assertEqual(len(expected), 36)
                    np.testing.assert_allclose(polygons(reference(11, "MID", ends, counts=(3, 2), **transform)),
                                               expected, atol=1e-6)
        with mock.patch.object(gds, "exact_library", lambda gdspy: gdspy.GdsLibrary):
            self.refused("device.gds", "arrays of cells", "flatten them")

    def test_gdsii_paths_without_length_are_discs_if_their_ends_are_round(self):
        def path(ends, *corners):
            return (record(9) + record(13, 2, struct.pack(">h", 1)) + record(14, 2, struct.pack(">h", 0)) + record(0x21, 2, struct.pack(">h", ends)) + record(15, 3, struct.pack(">i", 100000))
                    + record(16, 3, struct.pack(f">{2 * len(corners)}i", *(1000 * value for corner in corners for value in corner))) + record(17))

        more = path(1, (500, 600)) + path(1, (900, 300), (900, 300))
        (self.folder / "device.gds").write_bytes(gdsii([box(0, 0, 3600, 1200)], 1e-6, more))
        np.testing.assert_allclose(self.circles_of("device.gds"), [(500, 600, 100), (900, 300, 100)], atol=0.05)
        (self.folder / "device.gds").write_bytes(gdsii([box(0, 0, 3600, 1200)], 1e-6, path(0, (500, 600))))
        self.refused("device.gds", "a path of layer 1 has no length", "convert everything to polygons")

    def test_a_post_of_uneven_corners_becomes_a_circle_around_its_centroid(self):
        corners = [(500, 500), *((500 + i, 500) for i in range(1, 100)), (600, 500), (600, 600), (500, 600)]
        (self.folder / "device.gds").write_bytes(gdsii([box(0, 0, 3600, 1200), corners], 1e-6))
        np.testing.assert_allclose(shapes.as_circles(self.device("device.gds")).circles * 200, [(550, 550, 2 * np.sqrt(1e4 / np.pi))], rtol=1e-6)

    # A part of a drawing

    def test_a_region_of_a_drawing_with_ports_and_marks(self):
        drawing, space = self.dxf()
        for x, y in [(800, 300), (1600, 900), (3300, 600), (1000, 290)]:
            space.add_circle((x, y), 50)
        space.add_circle((200, 600), 150)  # A port.
        space.add_lwpolyline(box(300, 250, 3300, 950), close=True)  # The channel.
        space.add_lwpolyline([(3590, 10), (3580, 10), (3580, 30)], close=True)  # A mark.
        space.add_line((3400, 0), (3400, 1200))
        device = self.saved(drawing, region=(500, 1200, 2000, 0))
        np.testing.assert_allclose(device, [(300, 50, 100), (500, 40, 100), (1100, 650, 100)], atol=1e-9)
        self.assertEqual(self.drawing.outside, 4)
        printed = self.draw("circles", "device.dxf", "--droplet", "200um", "--output", "posts", "--region",
                            "500,1200,2000,0").stdout
        self.assertIn("device 7.5 x 3.5 droplet diameters (the region)", printed)
        self.assertIn("4 outside the region", printed)
        self.refuse_analysis("circles", "device.dxf", "--droplet", "200um", "--output", "x", "--region", "500,0,500,9",
                             words=["--region", "x0,y0,x1,y1"])
        self.refuse_analysis("circles", "device.dxf", "--droplet", "200um", "--output", "x", "--region",
                             "2500,300,3100,800", words=["no posts", "--region"])

    def test_a_post_beside_the_edge_of_a_region_is_left_out_and_named(self):
        # Two posts reach into the region of 500..2000, from the left and from above.
        self.write("device.svg", SVG.format("".join(f'<circle cx="{x}" cy="{y}" r="50"/>' for x, y in ((480, 600), (800, 600), (1200, 380), (1300, 800), (1990, 700)))))
        printed = self.draw("circles", "device.svg", "--droplet", "200um", "--output", "posts", "--region", "500,400,2000,1000").stdout
        self.assertIn("2 posts left out that reach into the region from outside", printed)
        self.assertIn("3 posts, device 7.5 x 3 droplet diameters (the region)", printed)
        self.assertIn("the border is no wall", printed)
        self.assertTrue(printed.endswith("box=3 length=7.5 release=entrance entrance=1 exit=6.5 ...\n"), printed)

    def test_the_printed_command_has_walls_only_where_the_drawing_has_an_edge(self):
        image = Image.new("L", (1800, 600), 230)
        pen = ImageDraw.Draw(image)
        for x, y in ROW:
            pen.ellipse([100 * (x - 0.25), 600 - 100 * (y + 0.25), 100 * (x + 0.25), 600 - 100 * (y - 0.25)], fill=40)
        image.save(self.folder / "mask.png")
        self.write("device.svg",
                   SVG.format("".join(f'<circle cx="{200 * x}" cy="{1200 - 200 * y}" r="50"/>' for x, y in ROW)))
        for drawing, options, walls in (("mask.png", ["--pixel", "2um"], ""), ("device.svg", [], "side-walls=on ")):
            printed = self.draw("circles", drawing, "--droplet", "200um", "--output", "posts", *options).stdout
            self.assertIn(f"box=6 length=18 {walls}release=entrance entrance=1 exit=17 ...", printed)
        pen.rectangle([1400, 560, 1700, 570], fill=40)  # a scale bar
        image.save(self.folder / "bar.png")
        self.refuse_analysis("circles", "bar.png", "--droplet", "200um", "--pixel", "2um", "--output", "cut",
                             words=["not round", "cut scale bars", "--region"])
        # With --as-circles the scale bar becomes a post. A message names such slender posts.
        printed = self.draw("circles", "bar.png", "--droplet", "200um", "--pixel", "2um", "--output", "barred",
                            "--as-circles").stdout
        self.assertIn(f"{len(ROW) + 1} posts, device", printed)
        x, y = map(float, re.search(r"1 post is at least three times as long as wide, at x=([0-9.]+) um, "
                                    r"y=([0-9.]+) um; if this is a scale bar", printed).groups())
        np.testing.assert_allclose((x, y), (3100, 70), atol=20)

    def test_a_region_is_given_as_the_program_shows_it(self):
        np.testing.assert_allclose(self.svg('<circle cx="800" cy="300" r="50"/><circle cx="800" cy="900" r="50"/>', region=(700, 200, 1000, 400)), [(100, 100, 100)], atol=0.01)
        self.picture("L", 255, 0, "mask.png", extra=[(100, 50)])
        np.testing.assert_allclose(self.circles_of("mask.png", unit=1e-6, region=(0, 0, 300, 110)), [(100.5, 59.5, 61)], atol=0.5)

    # Pictures

    def picture(self, mode, ground, post, name, extra=(), **options):
        image = Image.new(mode, (900, 300), ground)
        pen = ImageDraw.Draw(image)
        for x, y in [(200, 150), (600, 150), *extra]:
            pen.ellipse([x - 30, y - 30, x + 30, y + 30], fill=post)
        image.save(self.folder / name, **options)

    def assert_two(self, name, **options):
        np.testing.assert_allclose(self.circles_of(name, unit=1e-6, **options), [(200.5, 149.5, 61), (600.5, 149.5, 61)], atol=0.5)

    def test_pictures_in_either_contrast_and_with_a_transparent_ground(self):
        for mode, ground, post in [("L", 255, 0), ("L", 0, 255), ("RGBA", (0, 0, 0, 0), (0, 0, 0, 255)),
                                   ("RGBA", (255, 255, 255, 0), (255, 255, 255, 255)), ("LA", (0, 0), (0, 255)),
                                   ("1", 1, 0), ("1", 0, 1)]:
            with self.subTest(mode=mode, ground=ground):
                self.picture(mode, ground, post, "mask.png")
                self.assert_two("mask.png")
        self.picture("L", 0, 255, "mask.png")
        self.assertIn("the posts are bright (--posts)", self.draw("circles", "mask.png", "--pixel", "2um", "--droplet", "200um", "--output", "posts").stdout)
        self.assertEqual(len(self.device("mask.png", unit=1e-6, posts="bright").circles), 2)
        framed = Image.new("L", (900, 300), 255)
        pen = ImageDraw.Draw(framed)
        pen.rectangle([0, 0, 899, 299], outline=0, width=5)
        pen.ellipse([170, 120, 230, 180], fill=0)
        framed.save(self.folder / "framed.png")
        self.device("framed.png", unit=1e-6)
        self.assertEqual(self.drawing.notes, ["the posts are dark (--posts)"])

    def test_posts_centred_beyond_the_border_of_a_picture_are_left_out_and_named(self):
        # Posts are added at three borders. Less than half of the first and of the third is in the picture. More than
        # half of the second is in the picture.
        self.picture("L", 255, 0, "mask.png", extra=[(-12, 100), (885, 200), (400, -10)])
        np.testing.assert_allclose(self.circles_of("mask.png", unit=1e-6), [(200.5, 149.5, 61), (600.5, 149.5, 61), (885.5, 99.5, 61)], atol=1)
        printed = self.draw("circles", "mask.png", "--pixel", "2um", "--droplet", "200um", "--output", "posts").stdout
        self.assertIn("2 posts left out that reach into the picture from outside", printed)
        self.assertIn("3 posts, device 9 x 3 droplet diameters", printed)
        self.assertEqual(len(np.loadtxt(self.folder / "posts.csv", delimiter=",", skiprows=4)), 3)
        # If the user drew an edge, a post with its centre on the edge is still an error.
        drawing, space = self.dxf()
        for x, y in ((800, 300), (1600, 1200)):
            space.add_circle((x, y), 50)
        drawing.saveas(self.folder / "device.dxf")
        self.refuse_analysis("circles", "device.dxf", "--droplet", "200um", "--output", "other",
                             words=["1 post with the centre outside the edge"])

    def test_pixels_of_tiff_files(self):
        info = TiffImagePlugin.ImageFileDirectory_v2()
        for unit, number, metres in [("micron", 0.4, 2.5e-6), ("\\u00B5m", 0.4, 2.5e-6), ("mm", 400, 2.5e-6),
                                     ("um", 2, 0.5e-6)]:
            info[270], info[282], info[283], info[296] = f"ImageJ=1.53t\nunit={unit}\n", number, number, 1
            self.picture("L", 255, 0, "mask.tif", tiffinfo=info)
            self.assert_two("mask.tif")
            self.assertAlmostEqual(self.drawing.metres / metres, 1)
        self.refuse_analysis("circles", "mask.tif", "--droplet", "200um", "--output", "posts", "--pixel", "2um",
                             words=["--pixel 2um contradicts"])
        info[283] = 4
        self.picture("L", 255, 0, "mask.tif", tiffinfo=info)
        self.refused("mask.tif", "not square")
        self.picture("L", 255, 0, "mask.tif", dpi=(254, 254))
        self.refuse_analysis("circles", "mask.tif", "--droplet", "200um", "--output", "posts",
                             words=["--pixel, such as --pixel 2.5um", "would mean 100um, if that is not a printer's"])

    def test_uneven_light_is_named_as_a_reason(self):
        image = Image.new("L", (300, 300), 255)
        ImageDraw.Draw(image).polygon([(60, 60), (200, 90), (90, 220)], fill=0)
        image.save(self.folder / "mask.png")
        self.refuse_analysis("circles", "mask.png", "--droplet", "200um", "--pixel", "2um", "--output", "posts",
                             words=["1 post of 1 not round", "lit unevenly"])

    def test_tiff_files_of_another_library(self):
        import tifffile

        mask = np.full((300, 900), 60000, np.uint16)
        for x in (200, 600):
            mask[120:180, x - 30:x + 30] = 100
        tifffile.imwrite(self.folder / "mask.tif", mask, imagej=True, resolution=(2, 2), metadata={"unit": "um"})
        self.assertEqual((len(self.device("mask.tif").others), self.drawing.metres), (2, 0.5e-6))
        tifffile.imwrite(self.folder / "white.tif",
                         np.where(mask > 1000, 0, 255).astype(np.uint8), photometric="miniswhite")
        self.assertEqual(len(self.device("white.tif", unit=1e-6).others), 2)
        tifffile.imwrite(self.folder / "stack.tif", np.stack([mask] * 7))
        self.refused("stack.tif", "several slices", "7 x 300 x 900")

    def test_tiff_files_in_the_compressions_of_scanners(self):
        for mode, compression in [("L", "tiff_lzw"), ("1", "group4"), ("1", "tiff_lzw"), ("L", "tiff_adobe_deflate"),
                                  ("1", "packbits")]:
            for ground, post in [(1, 0), (0, 1)]:
                with self.subTest(compression, mode=mode, ground=ground):
                    self.picture(mode, ground * (255 if mode == "L" else 1), post * (255 if mode == "L" else 1),
                                 "mask.tif", compression=compression)
                    self.assert_two("mask.tif")
                    self.assertEqual(self.drawing.notes,
                                     ["the posts are bright (--posts)" if post else "the posts are dark (--posts)"])
        image = Image.new("CMYK", (900, 300))
        image.save(self.folder / "mask.tif", compression="tiff_lzw")
        self.refused("mask.tif", "save it as PNG")

    def test_a_photograph_that_is_stored_turned(self):
        turned = Image.Exif()
        turned[274] = 6
        self.picture("L", 255, 0, "photo.jpg", exif=turned)
        self.refused("photo.jpg", "upright")


class Stored(Analysis):
    def test_other_arrays_are_no_device(self):
        self.succeed("clogsweep", "obstacle-gap=0.5", "box=20", "max-time=1", "vertices=64", "seeds=1", "--output",
                     "random.h5")
        self.refuse_analysis("device", "random.h5", "--programs", BIN, words=["no circles of your own"])


if __name__ == "__main__":
    unittest.main()
