"""Tests sweeps of channels, flat walls and user-supplied circles. The keys of these sweeps are those of single runs,
and each run has a row."""

import json
import math
import unittest

import h5py
import numpy as np
import pandas

import stored_rows
from drawing import Analysis
from support import BIN, TIMING, ProgramTest, table

from clogsweep import labels, style
from clogsweep.drawing import passages
from clogsweep.reading import stored
from clogsweep.labels.groups import Groups

EXTREMES = [f"{extreme}{at}" for extreme in ("largest_shape_parameter", "smallest_relative_speed", "largest_relative_speed") for at in ("", "_at")]
CHANNEL = ["obstacle-layout=channel", "orifice=0.7", "near-wall-drag=0.07", "terminal-speed=0.05", "start=-1.5", "end=1", "vertices=64"]
CIRCLES = "# posts\nx,y,diameter\n2,5,0.5\n3.2,4.4,0.3\n3.4,5.9,0.4\n5,5.1,0.6\n7,4.2,0.3\n8.5,6.4,1\n"
OWN = ["obstacles=posts.csv", "box=10", "vertices=64", "max-time=60"]


def read_rows(path):
    """The rows of the table. Columns are attributes of a row."""
    return list(table(path).itertuples(index=False))


class BreakUp(Analysis):
    """Tests a droplet that sinks on one circle. The path of the droplet is a tenth of its diameter beside the middle of
    the circle."""

    KEYS = ["obstacles=one.csv", "box=20", "vertices=64", "max-time=250", "break-up-neck=0.03"]

    def setUp(self):
        super().setUp()
        (self.folder / "one.csv").write_text("x,y,diameter\n13,10.1,0.3\n")

    def test_soft_droplets_break_and_are_reported(self):
        self.succeed("clogsweep", *self.KEYS, "line-tension=0.03,0.05,0.07", "--output", "s.h5")
        rows = read_rows(self.folder / "s.h5")
        self.assertEqual([row.status for row in rows], ["broken", "broken", "flowing"])
        for row in rows[:2]:
            self.assertTrue(0 < row.thinnest_neck < 0.03)
            self.assertEqual((row.thinnest_neck_at, row.clogged_by, row.mechanism), (row.distance, "none", "none"))
        self.assertGreater(rows[2].thinnest_neck, 0.03)
        self.assertIn("0 clogged, 1 flowing, 0 failed, 2 broken; ", self.succeed("clogsweep", "status", "s.h5").stdout)
        self.assertEqual(json.loads(self.succeed("clogsweep", "status", "s.h5", "--format", "json").stdout)["broken"], 2)
        self.assertIn("2 broken", self.succeed("clogsweep", *self.KEYS, "line-tension=0.03,0.05", "--output", "t.h5").stderr)
        self.succeed("clogsweep", "verify", "s.h5")
        self.succeed("clogsweep", "replay", "s.h5", 0)
        self.assertIn("broken after", self.succeed("clogrun", "replay", "s.h5", 1, "--output", "r.h5").stdout)
        self.succeed("clogfit", "report", "s.h5", "--examples", 0)
        self.assertIn("2 broken", (self.folder / "s-report.html").read_text())

    def test_break_up_agrees_with_the_thinnest_neck_of_the_row(self):
        self.succeed("clogsweep", *self.KEYS, "line-tension=0.066,0.07,0.08,0.1", "--output", "s.h5")
        wider = 0.1
        self.succeed("clogsweep", *self.KEYS[:-1], "line-tension=0.066,0.07,0.08,0.1", f"break-up-neck={wider}",
                     "--output", "t.h5")
        predicted = [row.thinnest_neck < wider for row in read_rows(self.folder / "s.h5")]
        self.assertEqual([row.status == "broken" for row in read_rows(self.folder / "t.h5")], predicted)
        self.assertEqual(set(predicted), {True, False})

    def test_the_picture_of_collisions_closes_in_on_the_threshold(self):
        done = self.draw("collision", "--output", "c", "--programs", BIN, "--offsets", "0.1,0.4", "vertices=64")
        head, near, far = done.stdout.splitlines()
        self.assertEqual(head, "offset,symmetry,breaks_up_to,whole_from,capillary_number")
        low, high = map(float, near.split(",")[2:4])
        self.assertTrue(0.055 < low < high < 0.07 and high < 1.02 * low, near)
        self.assertEqual(far.split(",")[2:], ["", "0.01", ""])  # No droplet breaks up.
        self.assertTrue((self.folder / "c.png").exists())
        for words, said in [(["--offsets", "0.6"], "0.6"), (["vertices"], "KEY=VALUE"), (["vertices=x"], "vertices"),
                            (["--offsets", "0.4"], "nothing to draw")]:
            self.refuse_analysis("collision", "--output", "d", "--programs", BIN, *words, words=[said])


class Channels(Analysis):
    def test_a_row_has_what_the_run_itself_shows(self):
        self.succeed("clogsweep", *CHANNEL, "line-tension=0.3,0.6,5", "--output", "s.h5")
        rows = read_rows(self.folder / "s.h5")
        self.assertEqual([row.status for row in rows], ["passed", "passed", "clogged"])
        row = rows[1]
        self.succeed("clogrun", "channel", *CHANNEL, "line-tension=0.6", "--sample-interval", 0.001, "--output", "r.h5")
        with h5py.File(self.folder / "r.h5") as file:
            samples = file["trajectory"][1:]  # The first sample is the release, which the row's results do not include.
        largest = np.argmax(samples["shape_parameter"])
        self.assertEqual(row.largest_shape_parameter, samples["shape_parameter"][largest])
        self.assertEqual(row.largest_shape_parameter_at, samples["h"][largest])
        fastest = np.argmax(samples["speed_ratio"])
        self.assertEqual((row.largest_relative_speed, row.largest_relative_speed_at),
                         (samples["speed_ratio"][fastest], samples["h"][fastest]))
        fallen = samples[samples["time"] > 10 * 0.05]
        slowest = np.argmin(fallen["speed_ratio"])
        self.assertEqual((row.smallest_relative_speed, row.smallest_relative_speed_at),
                         (fallen["speed_ratio"][slowest], fallen["h"][slowest]))
        self.assertTrue(np.isnan(row.sag))
        # A droplet between two caps on rounded tips has a shape parameter of 1.0952 (tests/core/scene). The largest
        # shape parameter occurs in the orifice.
        self.assertAlmostEqual(row.largest_shape_parameter, 1.0952, delta=0.01)
        self.assertLess(abs(row.largest_shape_parameter_at), 0.05)

    def test_every_key_of_the_channel_is_swept(self):
        for key, values, column in [("orifice", "0.7,0.8", "orifice"), ("wedge-angle", "30,45", "wedge_angle"),
                                    ("tip-radius", "0.03,0.1", "tip_radius"), ("start", "-1.5,-1.2", "start"),
                                    ("end", "0.5,1", "end")]:
            keys = [word for word in CHANNEL if not word.startswith(f"{key}=")]
            self.succeed("clogsweep", *keys, "line-tension=0.3", "max-time=10", f"{key}={values}", "--output",
                         f"{key}.h5")
            rows = read_rows(self.folder / f"{key}.h5")
            self.assertEqual([getattr(row, column) for row in rows], [float(value) for value in values.split(",")])
            fits = json.loads(self.succeed("clogfit", f"{key}.h5", "--format", "json").stdout)
            self.assertEqual([group[column] for group in fits["groups"]], [float(value) for value in values.split(",")])

    def test_it_is_printed_as_passages_not_as_lengths(self):
        self.succeed("clogsweep", *CHANNEL, "line-tension=0.3,5", "--output", "s.h5")
        text = self.succeed("clogfit", "s.h5").stdout
        self.assertIn("largest A", text)
        self.assertNotIn("lambda", text)
        self.assertIn("passed", text)
        self.assertIn("largest A", self.succeed("clogsweep", "status", "s.h5").stdout)
        group, _ = json.loads(self.succeed("clogfit", "s.h5", "--format", "json").stdout)["groups"]
        self.assertEqual(group["status"], "passed")
        self.assertNotIn("clogging_length", group)
        self.succeed("clogsweep", "verify", "s.h5")
        self.succeed("clogsweep", "replay", "s.h5", 0)
        self.succeed("clogrun", "replay", "s.h5", 0, "--sample-interval", 0.5, "--output", "again.h5")
        self.succeed("clogrun", "channel", *CHANNEL, "line-tension=0.3", "--sample-interval", 0.5, "--output", "same.h5")
        again, same = (h5py.File(self.folder / name) for name in ("again.h5", "same.h5"))
        np.testing.assert_array_equal(again["trajectory"][:], same["trajectory"][:])
        self.assertIn("speed_ratio", again["trajectory"].dtype.names)
        for name in ("orifice", "wedge_angle", "tip_radius", "start_h", "end_h"):
            self.assertEqual(again.attrs[name], same.attrs[name])
        self.refuse_analysis("clogging-length", "s.h5", "--programs", BIN, words=["in a channel", "clogfit report"])
        self.refuse_analysis("clogs", "s.h5", "--programs", BIN, words=["in a channel", "clogfit report"])

    def test_a_report_shows_what_came_out_of_them(self):
        self.succeed("clogsweep", *CHANNEL[:1], *CHANNEL[2:], "orifice=0.6,0.7", "line-tension=0.3,0.6,5", "--output", "s.h5")
        fit = json.loads(self.succeed("clogfit", "s.h5", "--format", "json").stdout)
        self.draw("report", "--programs", BIN, "s.h5", "--output", "r.html", "--examples", 2)
        page = (self.folder / "r.html").read_text()
        for group in fit["groups"]:
            cells = [f"{group['orifice']:g}", f"{group['line_tension']:g}", group["status"], *(f"{group[name]:.4g}" for name in EXTREMES)]
            self.assertIn("".join(f"<td>{cell}</td>" for cell in cells), page)
        for orifice in (0.6, 0.7):
            passed = sum(group["status"] == "passed" for group in fit["groups"] if group["orifice"] == orifice)
            self.assertTrue(0 < passed < 3)
            self.assertIn(f"<li>orifice {orifice}: {passed} of 3 passed</li>", page)
        self.assertNotIn("lambda", page)
        self.assertEqual((page.count("<svg"), page.count("<img")), (6, 0))  # One of the charts shows the busy ranks.
        self.draw("report", "--programs", BIN, "s.h5", "--output", "r.html", "--examples", 0)
        page = (self.folder / "r.html").read_text()
        self.assertEqual((page.count("<svg"), page.count("<img")), (4, 0))

        # Each point has the number of its group, and each marker shows how the run ended.
        axes = style.figure_of(passages.draw_curves, Groups(fit), "largest_shape_parameter").axes[0]
        self.assertEqual(axes.get_xlabel(), labels.AXES["line_tension"])
        drawn = [(line.get_xdata()[0], line.get_ydata()[0], line.get_marker()) for line in axes.lines if len(line.get_xdata()) == 1]
        self.assertEqual(drawn, [(group["line_tension"], group["largest_shape_parameter"], {"passed": "o", "clogged": "X"}[group["status"]])
                                 for group in fit["groups"]])

    def test_a_report_of_soft_disks_has_no_shapes(self):
        self.succeed("clogsweep", "model=sp", "orifice=0.7", "wall-stiffness=1,50", "start=-1.5", "end=1",
                     "max-time=2000", "--output", "s.h5")
        self.draw("report", "--programs", BIN, "s.h5", "--output", "r.html")
        page = (self.folder / "r.html").read_text()
        self.assertEqual((page.count("<svg"), page.count("<img")), (3, 0))
        self.assertIn("<li>1 of 2 passed</li>", page)

    def test_a_report_leaves_out_what_is_not_over(self):
        self.succeed("clogsweep", *CHANNEL, "line-tension=0.5,0.6", "--output", "s.h5")

        def interrupt(*tasks):
            stored_rows.change(self.folder / "s.h5",
                               lambda rows: rows["status"].__setitem__(list(tasks), b"interrupted"))

        interrupt(1)
        self.draw("report", "--programs", BIN, "s.h5", "--output", "r.html")
        page = (self.folder / "r.html").read_text()
        self.assertIn("<li>1 of 1 passed</li>", page)
        self.assertIn("<td>0.5</td><td>passed</td>", page)
        self.assertNotIn("<td>0.6</td>", page)
        self.assertEqual((page.count("<svg"), page.count("<img")), (5, 0))
        interrupt(0, 1)
        self.refuse_analysis("report", "--programs", BIN, "s.h5", "--output", "s.html", words=["no finished runs"])

    def test_an_outline_of_a_report_is_the_most_deformed(self):
        self.succeed("clogsweep", *CHANNEL, "line-tension=0.3,5", "--output", "s.h5")
        groups = Groups(json.loads(self.succeed("clogfit", "s.h5", "--format", "json").stdout))
        rows = passages.examples(stored.read_rows(self.folder / "s.h5"), 5)
        self.assertEqual([row["task"] for row in rows], [0, 1])
        for row, figure in zip(rows,
                               passages.draw_outlines(groups, rows, BIN / "clogrun", self.folder / "s.h5", self.folder),
                               strict=True):
            outline = max((patch.get_path().vertices[:-1].T for patch in figure.axes[0].patches),
                          key=lambda points: points.shape[1])
            x, y = outline
            after_x, after_y = np.roll(outline, -1, axis=1)
            perimeter, area = np.hypot(after_x - x, after_y - y).sum(), abs((x * after_y - after_x * y).sum()) / 2
            self.assertAlmostEqual(perimeter**2 / (4 * np.pi * area), row["largest_shape_parameter"], delta=0.003)
            self.assertIn(row["status"].decode(), figure.axes[0].get_title())

    def test_a_stopped_sweep_resumes(self):
        keys = [*CHANNEL[:-1], "line-tension=0.3,0.6,1", "vertices=256"]
        self.succeed("clogsweep", *keys, "--output", "whole.h5")
        self.run_program("clogsweep", *keys, "--max-hours", 0.0001, "--output", "parts.h5")
        self.succeed("clogsweep", *keys, "--output", "parts.h5")
        for whole, parts in zip(read_rows(self.folder / "whole.h5"), read_rows(self.folder / "parts.h5"), strict=True):
            self.assertEqual((whole.distance, whole.smallest_relative_speed, whole.largest_shape_parameter_at),
                             (parts.distance, parts.smallest_relative_speed, parts.largest_shape_parameter_at))

    def test_keys_without_effect_or_out_of_range_are_refused(self):
        for words, shown_text in [(["obstacle-gap=0.3"], ["obstacle-gap", "no array"]),
                                  (["seeds=1..5"], ["seeds=1..5", "nothing is random"]),
                                  (["obstacles=none", "box=20"], ["box", "no array"]),
                                  (["start=-0.1"], ["start", "clear of the wedges"]),
                                  (["end=-3"], ["end", "downstream"]),
                                  (["orifice=0"], ["orifice"])]:
            names = [word.split("=")[0] for word in words]
            keys = [word for word in CHANNEL if word.split("=")[0] not in names]
            self.refuse("clogsweep", *keys, "line-tension=1", *words, "--output", "s.h5", words=shown_text)
        self.refuse("clogsweep", "orifice=0.6", "obstacle-layout=random", "--output", "s.h5",
                    words=["orifice=0.6", "obstacle-layout=channel"])
        # The key `orifice` implies a channel.
        self.succeed("clogsweep", "orifice=0.7", "vertices=64", "max-time=1", "--output", "s.h5")
        self.assertEqual([row.obstacle_filling for row in read_rows(self.folder / "s.h5")], ["channel"])
        self.refuse("clogrun", "channel", "obstacle-layout=wall", "--output", "r.h5", words=["obstacle-layout=channel"])
        self.refuse("clogrun", "array", "obstacle-layout=channel", "--output", "r.h5", words=["clogrun channel"])


class Walls(Analysis):
    def test_a_sweep_has_the_sags_that_clogrun_prints(self):
        keys = ["line-tension=0.1,1", "vertices=64"]
        shown_text = self.succeed("clogsweep", "obstacle-layout=wall", *keys, "--output", "s.h5").stderr
        self.assertIn(" 2 at rest, 0 flowing, ", shown_text)
        printed = [line.split(",") for line in self.succeed("clogrun", "sag", *keys).stdout.splitlines()[1:]]
        rows = read_rows(self.folder / "s.h5")
        self.assertEqual([f"{row.sag:.6g}" for row in rows], [words[3] for words in printed])
        self.assertEqual([f"{row.top_sag:.6g}" for row in rows], [words[4] for words in printed])
        self.assertIn("at rest", self.succeed("clogfit", "s.h5").stdout)
        status = self.succeed("clogsweep", "status", "s.h5").stdout
        self.assertIn("2 of 2 runs finished, 2 at rest, 0 flowing, 0 failed;", status)
        shown_text = json.loads(self.succeed("clogsweep", "status", "s.h5", "--format", "json").stdout)
        self.assertEqual([shown_text[name] for name in ("finished", "clogged", "at_rest")], [2, 0, 2])
        self.draw("report", "--programs", BIN, "s.h5", "--output", "r.html")
        page = (self.folder / "r.html").read_text()
        for row in rows:
            cells = [f"{row.line_tension:g}", "at rest", *(f"{value:.4g}" for value in (row.sag, row.top_sag, row.shape_parameter))]
            self.assertIn("".join(f"<td>{cell}</td>" for cell in cells), page)
        self.assertIn("<li>2 of 2 at rest</li>", page)
        self.assertIn("2 of 2 runs finished (2 at rest)", page)
        self.assertEqual((page.count("<svg"), page.count("<img")), (5, 0))
        self.refuse_analysis("clogging-length", "s.h5", "--programs", BIN, words=["on a wall", "clogfit report"])

    def test_a_soft_disk_sags_as_its_spring_says(self):
        self.succeed("clogsweep", "obstacle-layout=wall", "model=sp", "wall-stiffness=0.5,5", "--output", "s.h5")
        for row, stiffness in zip(read_rows(self.folder / "s.h5"), [0.5, 5], strict=True):
            self.assertAlmostEqual(row.sag, np.pi / (16 * stiffness), delta=1e-5)
        # The report has no outline to show, because disks have no outlines.
        self.draw("report", "--programs", BIN, "s.h5", "--output", "r.html")
        page = (self.folder / "r.html").read_text()
        self.assertEqual((page.count("<svg"), page.count("<img")), (3, 0))


class OwnCircles(ProgramTest):
    def setUp(self):
        super().setUp()
        (self.folder / "posts.csv").write_text(CIRCLES)

    def circles(self, name):
        with h5py.File(self.folder / name) as file:
            return {key: (table.attrs["file"].decode(), table[:]) for key, table in file["obstacles"].items()}

    def test_rows_name_the_circles_and_the_file_holds_them(self):
        self.succeed("clogsweep", *OWN, "line-tension=0.3,1", "--output", "s.h5")
        rows = read_rows(self.folder / "s.h5")
        (key, (name, table)), = self.circles("s.h5").items()
        self.assertEqual({row.obstacles for row in rows}, {key})
        self.assertEqual((name, len(table)), ("posts.csv", 6))
        # A radius of 0.15 is half of obstacle-diameter.
        self.assertEqual(table["radius"].tolist(), [0.25, 0.15, 0.2, 0.3, 0.15, 0.5])
        self.assertEqual({row.obstacle_filling for row in rows}, {"file"})
        self.assertEqual({row.obstacle_density for row in rows}, {0.06})
        self.assertAlmostEqual(rows[0].obstacle_gap, np.hypot(1.2, 0.6) - 0.4)
        # clogrun array must give the result that is in the sweep's row.
        self.succeed("clogrun", "array", *OWN, "line-tension=1", "--output", "r.h5")
        run, = read_rows(self.folder / "r.h5")
        self.assertEqual((run.distance, run.lateral_displacement, run.obstacles),
                         (rows[1].distance, rows[1].lateral_displacement, key))

    def test_the_table_is_enough(self):
        self.succeed("clogsweep", *OWN, "release=anywhere", "seeds=1..3", "--output", "s.h5")
        (self.folder / "posts.csv").unlink()
        for command in (["verify", "s.h5"], ["status", "s.h5"], ["replay", "s.h5", 2], ["salvage", "s.h5", "--output", "copy.h5"]):
            self.succeed("clogsweep", *command)
        self.assertEqual(self.circles("copy.h5").keys(), self.circles("s.h5").keys())
        self.succeed("clogrun", "replay", "s.h5", 1, "--output", "r.h5")
        self.assertEqual(read_rows(self.folder / "r.h5")[0].distance, read_rows(self.folder / "s.h5")[1].distance)
        self.refuse("clogsweep", *OWN, "--output", "s.h5", words=["posts.csv"])

    def test_seeds_release_it_anywhere(self):
        # Posts block every lane along the flow.
        (self.folder / "dense.csv").write_text("x,y,diameter\n"
                                               + "".join(f"{3 * i % 10},{1.25 * i + 0.6},0.5\n" for i in range(8)))
        keys = ["obstacles=dense.csv", *OWN[1:-1], "line-tension=0.1", "max-time=400", "release=anywhere"]
        self.succeed("clogsweep", *keys, "seeds=1..4", "--output", "s.h5")
        self.assertEqual(len({row.lateral_displacement for row in read_rows(self.folder / "s.h5")}), 4)
        self.succeed("clogsweep", *OWN[:-1], "max-time=1", "release=anywhere", "--output", "ten.h5")
        self.assertEqual(len(read_rows(self.folder / "ten.h5")), 10)
        self.refuse("clogsweep", *OWN, "seeds=1..4", "--output", "t.h5", words=["seeds=1..4", "release=anywhere"])
        self.refuse("clogsweep", "release=anywhere", "--output", "t.h5",
                    words=["release=anywhere", "obstacles=FILE.csv"])

    def test_other_circles_are_other_runs(self):
        self.succeed("clogsweep", *OWN, "--output", "s.h5")
        (self.folder / "posts.csv").write_text("# the same, said otherwise\n"
                                               + CIRCLES.replace("2,5,0.5", " 2.0 , 5.0 , 0.50 "))
        self.succeed("clogsweep", *OWN, "--output", "s.h5")
        self.assertEqual(len(read_rows(self.folder / "s.h5")), 1)
        (self.folder / "posts.csv").write_text(CIRCLES.replace("2,5,0.5", "2,5,0.55"))
        self.succeed("clogsweep", *OWN, "--output", "s.h5")
        first, second = read_rows(self.folder / "s.h5")
        self.assertNotEqual(first.obstacles, second.obstacles)
        names = {key: name for key, (name, _) in self.circles("s.h5").items()}
        # Only the name of the last file is known.
        self.assertEqual(names, {first.obstacles: "posts.csv", second.obstacles: ""})
        self.succeed("clogsweep", "replay", "s.h5", 1)
        self.succeed("clogsweep", "verify", "s.h5")

    def test_a_run_longer_than_its_circles_asks_for_a_longer_file(self):
        keys = [key for key in OWN if not key.startswith("max-time")]
        shown_text = self.plan(*keys, "release=anywhere", "max-time=500")
        self.assertIn("give a file of circles that is as long", shown_text)
        self.assertNotIn("boxes=", shown_text.split("meet the same obstacles again")[1].splitlines()[0])

    def test_how_wide_their_array_is_has_to_be_said(self):
        self.refuse("clogsweep", "obstacles=posts.csv", "--output", "s.h5", words=["obstacles=posts.csv", "give box"])
        self.refuse("clogrun", "array", "obstacles=posts.csv", "--output", "r.h5",
                    words=["obstacles=posts.csv", "give box"])
        (self.folder / "posts.csv").write_text("x,y\n" + "".join(f"{i % 5 * 2},{i // 5 * 2}\n" for i in range(25)))
        wide = [*OWN, "obstacle-diameter=1.1"]
        self.assertNotIn("bare", self.plan(*wide))
        shown_text = self.plan(*wide, "boxes=4")
        self.assertIn("obstacles=posts.csv leaves x=", shown_text)
        self.assertNotIn("leaves y=", shown_text)

    def test_droplets_that_fall_through_a_lane_met_nothing(self):
        # Posts between two walls at y = 1 and 7, in a device of width 8. Behind the walls there is a lane of width 1.7.
        # A droplet in this lane touches nothing.
        walls = [(0.53 * i % 16, y) for i in range(30) for y in (1, 7)] + [(1.0 + 2 * i, 0.5 * (i % 2) + y) for i in range(8) for y in (2, 3.1, 4.2, 5.3)]
        keys = ["box=8", "boxes=2", "release=anywhere", "vertices=64", "line-tension=4", "terminal-speed=0.1", "max-time=100", "seeds=1..12"]
        (self.folder / "walls.csv").write_text("x,y,diameter\n" + "".join(f"{x:.4f},{y},0.3\n" for x, y in walls))
        shown_text = self.plan("obstacles=walls.csv", *keys)
        self.assertRegex(shown_text, r"obstacles=walls.csv leaves y=7.15 to 8.85 bare, wider than a droplet")
        self.succeed("clogsweep", "obstacles=walls.csv", *keys, "--output", "s.h5")
        rows = read_rows(self.folder / "s.h5")
        for row in rows:
            fell = row.status == "flowing" and abs(row.distance - 10) < 0.1 and abs(row.lateral_displacement) < 1e-9
            self.assertEqual(row.contacts == 0, fell, row)
            self.assertEqual(math.isnan(row.first_contact_at), row.contacts == 0)
        free = sum(row.contacts == 0 for row in rows)
        self.assertTrue(0 < free < len(rows), free)
        group, = json.loads(self.succeed("clogfit", "s.h5", "--format", "json").stdout)["groups"]
        self.assertEqual((group["met_none"], "met_none" in group["doubts"].split()), (free, True))
        self.assertAlmostEqual(group["contacts_per_length"],
                               sum(row.contacts for row in rows) / sum(row.distance for row in rows), places=9)
        self.assertRegex(self.succeed("clogfit", "s.h5").stdout, r"met none +lambda_met")
        self.succeed("clogsweep", "verify", "s.h5")

    def test_the_length_between_two_walls_is_that_of_the_droplets_that_met_them_in_any_unit(self):
        # 60 posts form two walls at y = 1 and 7. Behind them is a lane of width 1.7. Between the walls there are a few
        # columns of posts.
        walls = [(round((i + 0.5) * 16 / 30, 4), y) for i in range(30) for y in (1, 7)]
        walls += [(1 + 4 * i, 1.75 + 0.75 * j + 0.3 * (i % 2)) for i in range(4) for j in range(7)]
        keys = ["box=8", "boxes=2", "release=anywhere", "vertices=64", "line-tension=3", "terminal-speed=0.1", "max-time=150", "seeds=1..20"]
        for name, head, scale in (("walls.csv", "x,y,diameter\n", 1), ("um.csv", "# units=um droplet=200um\nx,y,diameter\n", 200)):
            (self.folder / name).write_text(head + "".join(f"{scale * x:.8g},{scale * y:.8g},{scale * 0.3:g}\n" for x, y in walls))
            shown_text = self.succeed("clogsweep", f"obstacles={name}", *keys, "--output", name + ".h5").stderr
            self.assertIn("bare, wider than a droplet", shown_text)
        rows, others = (table(self.folder / name) for name in ("walls.csv.h5", "um.csv.h5"))
        pandas.testing.assert_frame_equal(rows.drop(columns=TIMING), others.drop(columns=TIMING), check_exact=True)
        group, = json.loads(self.succeed("clogfit", "walls.csv.h5", "--format", "json").stdout)["groups"]
        met = rows[rows.contacts > 0]
        self.assertTrue(0 < len(met) < len(rows))
        self.assertEqual((group["met_none"], "met_none" in group["doubts"].split()), (len(rows) - len(met), True))
        clogs = (met.status == "clogged").sum()
        self.assertGreater(clogs, 0)
        self.assertAlmostEqual(group["clogging_length_met"], (met.distance - met.first_contact_at).sum() / clogs, places=9)
        self.assertLess(group["clogging_length_met"], group["clogging_length"] / 2)
        # Keys of devices do not appear if they have their defaults.
        text = self.succeed("clogfit", "walls.csv.h5").stdout
        for word in ("side_walls", "entrance", "exit=", " length="):
            self.assertNotIn(word, text)
        self.assertIn("release=anywhere", text)

    def test_two_arrays_are_one_sweep(self):
        (self.folder / "few.csv").write_text("x,y,diameter\n5,7,1\n")
        self.succeed("clogsweep", "obstacles=posts.csv,few.csv", *OWN[1:], "--output", "s.h5")
        self.assertEqual(len({row.obstacles for row in read_rows(self.folder / "s.h5")}), 2)
        fits = json.loads(self.succeed("clogfit", "s.h5", "--format", "json").stdout)
        self.assertEqual(len(fits["groups"]), 2)
        self.assertEqual(fits["lists"], ["obstacles"])

    def test_ranks_and_helpers_receive_them(self):
        keys = [*OWN, "release=anywhere", "seeds=1..6"]
        self.succeed("clogsweep", *keys, "--output", "one.h5")
        self.succeed("clogsweep", *keys, "--isolate=no", "--output", "bare.h5")
        self.succeed("clogsweep", *keys, "--output", "two.h5", ranks=2)
        places = [[(row.distance, row.lateral_displacement) for row in read_rows(self.folder / name)]
                  for name in ("one.h5", "bare.h5", "two.h5")]
        self.assertEqual(places[0], places[1])
        self.assertEqual(places[0], places[2])

    def test_damage_to_them_is_noticed(self):
        self.succeed("clogsweep", *OWN, "--output", "s.h5")
        bytes_ = bytearray((self.folder / "s.h5").read_bytes())
        place = bytes(bytes_).index(np.array([3.4, 5.9, 0.2]).tobytes())
        bytes_[place + 3] ^= 4
        (self.folder / "s.h5").write_bytes(bytes_)
        shown_text = self.run_program("clogsweep", "verify", "s.h5")
        self.assertEqual(shown_text.returncode, 1)
        self.assertIn("its obstacles", shown_text.stdout)
        for command in (["clogfit", "s.h5"], ["clogsweep", "status", "s.h5"], ["clogsweep", *OWN, "--output", "s.h5"]):
            self.refuse(*command, words=["damaged"])


class RandomDevices(ProgramTest):
    """Tests random circles in random boxes, some of which extend across the border of the box."""

    KEYS = {"dp": ["vertices=64", "line-tension=0.5"], "sp": ["model=sp", "wall-stiffness=1"]}

    def setUp(self):
        super().setUp()
        self.random = np.random.default_rng(66)
        self.num_across_border = 0

    def device(self, name):
        """Writes a file of circles that leave gaps. @return the keys and the length of the device"""
        box, length = self.random.uniform(5, 12, 2)
        period = np.array([length, box])
        circles = []
        for _ in range(60):
            radius = self.random.uniform(0.05, 0.2 * period.min())
            place = self.random.uniform(0, period)
            ways = [place - other for *other, _ in circles]
            gaps = [np.hypot(*(way - period * np.round(way / period))) - radius - r
                    for way, (_, _, r) in zip(ways, circles)]
            if min(gaps, default=1) > 0.15 and len(circles) < 4:
                circles.append((*place, radius))
        self.num_across_border += any(min(*(period - place), *place) < r for *place, r in circles)
        self.write(name, "x,y,diameter\n" + "".join(f"{x},{y},{2 * r}\n" for x, y, r in circles))
        return [f"obstacles={name}", f"box={box}", f"length={length}"], length

    def check_sweep(self, name, keys):
        """Runs a sweep. Checks that its rows are sound, and that a replay of each row gives the same bits.
        @return its rows"""
        self.succeed("clogsweep", *keys, "--output", name)
        rows = table(self.folder / name)
        box, length = rows.box[0], rows.length[0] or rows.box[0]
        self.assertTrue(rows.release_x.between(0, length, "left").all(), f"{keys}: {rows.release_x.tolist()}")
        self.assertTrue(rows.release_y.between(0, box, "left").all(), f"{keys}: {rows.release_y.tolist()}")
        self.succeed("clogsweep", "verify", name)
        for task in rows.task:
            self.succeed("clogsweep", "replay", name, task)
            self.succeed("clogrun", "replay", name, task, "--output", f"{task}-{name}")
            again = table(self.folder / f"{task}-{name}").drop(columns=[*TIMING, "task"])
            expected = rows[rows.task == task].drop(columns=[*TIMING, "task"]).reset_index(drop=True)
            pandas.testing.assert_frame_equal(again, expected, check_exact=True)
        return rows

    def test_runs_start_inside_the_box_and_are_repeated_in_all_columns(self):
        for model, more in self.KEYS.items():
            for number in range(4):
                keys, length = self.device(f"{model}{number}.csv")
                keys += [*more, "max-time=60", "seeds=1..3"]
                entrance, exit = np.sort(self.random.uniform(0, length, 2))
                with self.subTest(keys=keys):
                    self.check_sweep(f"{model}{number}.h5", [*keys, "release=anywhere"])
                    entrance_keys = ["release=entrance", f"entrance={entrance}", f"exit={exit}"]
                    self.check_sweep(f"{model}{number}-entrance.h5", [*keys, *entrance_keys])
        self.assertGreater(self.num_across_border, 3)

    def test_no_droplet_starts_within_the_outline_of_a_post(self):
        # Rows of circles form a ring, a square and an open ring. A droplet would fit into each of them.
        for model, more in self.KEYS.items():
            places = self.random.permutation([(3, 3), (3, 9), (9, 6)])
            ring, square, open_ring = places + self.random.uniform(-0.5, 0.5, 2)
            radius, half = self.random.uniform(0.9, 1.7, 2)
            angles = np.arange(0, 2 * np.pi, 0.08 / radius)
            arc = radius * np.stack([np.cos(angles), np.sin(angles)], axis=1)
            side = np.stack(np.broadcast_arrays(np.arange(-half, half, 0.08), -half), axis=1)
            next_side = side[:, ::-1] * [-1, 1]
            sides = np.concatenate([side, next_side, -side, -next_side])
            circles = np.concatenate([ring + arc, square + sides, open_ring + arc[angles < 4]]) % 12
            self.write(f"{model}.csv", "x,y,diameter\n" + "".join(f"{x},{y},0.2\n" for x, y in circles))
            releases = ["release=anywhere seeds=1..6", "release=centre seeds=1"]
            releases += [f"release=entrance entrance={post[0] % 12} exit=11.9 seeds=1..6" for post in (ring, square)]
            for number, release in enumerate(releases):
                with self.subTest(model=model, release=release):
                    keys = [f"obstacles={model}.csv", "box=12", *more, "max-time=20", *release.split()]
                    rows = self.check_sweep(f"{model}{number}.h5", keys)
                    ways = [(rows[["release_x", "release_y"]] - post + 6) % 12 - 6 for post in (ring, square)]
                    self.assertGreater(np.hypot(*ways[0].to_numpy().T).min(), radius)
                    self.assertGreater(ways[1].abs().max(axis=1).min(), half)

    def test_droplets_that_start_across_the_border_are_inside(self):
        # Only the corners of these boxes have room for a droplet.
        self.write("one.csv", "x,y,diameter\n2.5,2.5,2\n")
        self.write("large.csv", "x,y,diameter\n5,5,8\n")
        keys = ["vertices=64", "max-time=2", "seeds=1..8"]
        self.check_sweep("one.h5", ["obstacles=one.csv", "box=5", "release=anywhere", *keys])
        entrance = ["release=entrance", "entrance=3", "exit=10"]
        rows = self.check_sweep("large.h5", ["obstacles=large.csv", "box=10", *entrance, *keys])
        self.assertEqual(set(rows.status), {"flowing"})


if __name__ == "__main__":
    unittest.main()
