import csv
import html
import itertools
import json
import math
import os
import shutil
import subprocess
import sys
import unittest
import unittest.mock
import xml.etree.ElementTree as xml
from types import SimpleNamespace

import h5py
import numpy as np
import pandas
import matplotlib
from matplotlib import image
from matplotlib.text import Text

import stored_rows
from drawing import Analysis
from support import BIN, FEW, QUICK, ROOT, SMALL, table

import clogsweep
from clogsweep import style
from clogsweep.drawing import clogs, film, lengths, survival_curve
from clogsweep.pages import report
from clogsweep.reading import programs, stored, trajectory
from clogsweep.tools import rounded
from clogsweep.labels.groups import Groups
from clogsweep.calibration.deviation import root_mean_square, speed_residuals
from clogsweep.calibration.profiles import Profile
from clogsweep.paper import arrays, channels, dilute

# Droplets are coarse and paths are short, so all runs together take a few seconds.
TINY = {
    **{name: ["vertices=32", "line-tension=0.3,3", "obstacle-gap=0.2,0.4", "obstacle-density=80%"]
       for name in ("clogging-robust", "clogging-friction", "clogging-elastic", "clogging-filling", "clogging-saturated")},
    **{f"{name}-mesh": ["vertices=64", "line-tension=3", "obstacle-gap=0.2", "obstacle-density=80%"]
       for name in ("clogging-robust", "clogging-friction", "clogging-elastic")},
    **{name: ["vertices=32", "line-tension=0.3,3", "obstacle-gap=0.2,0.4", "obstacle-density=0.35,saturated", "seeds=1..10"]
       for name in ("map-robust", "map-friction")},
    "clogging-sp": ["wall-stiffness=1,10", "obstacle-gap=0.2,0.4", "obstacle-density=80%"],
    "clogging-sp-saturated": ["wall-stiffness=1,10", "obstacle-gap=0.2,0.4"],
    "speed": ["vertices=32", "line-tension=0.1,1", "obstacle-gap=1.0,1.1", "seeds=1..3", "terminal-speed=0.2"],
    "speed-sp": ["wall-stiffness=1,10", "obstacle-gap=1.0,1.1", "seeds=1..3", "terminal-speed=0.2"],
    "speed-diameter": ["vertices=32", "line-tension=0.1,1", "seeds=1..3", "terminal-speed=0.2"],
    "near-wall-drag": ["vertices=32", "line-tension=0.1,1", "seeds=1..3", "max-time=100", "terminal-speed=0.2"],
    "survival": ["vertices=32", "obstacle-density=saturated", "max-time=150"],
    "trajectory": ["vertices=32"],
    "families": ["line-tension=0.05", "break-up-neck=0.08", "vertices=64", "speed-exponent=0,1",
                 "self-contact-range=0.02", "obstacle-density=0.8", "obstacle-gap=0.3", "boxes=1", "max-time=700"],
}
SETTINGS = [f"{name}:{key}" for name, keys in TINY.items() for key in ["box=20", "seeds=1..2", *keys]]
SET = [word for setting in [*SETTINGS, "max-time=40", "channel:vertices=64", "channel:max-time=300", "trajectory:max-time=150"] for word in ("--set", setting)]


SINGLE_RUNS = ("1", "2", "3", "4", "7b", "A1", "B1", "B2", "C1", "D")


class Survival(unittest.TestCase):
    """Tests the curve of figure C2 with numbers like those of clogfit."""

    STEPS = [{"distance": 2.0, "probability": 0.75, "lower": 0.13, "upper": 0.96},
             {"distance": 5.0, "probability": 0.375, "lower": 0.01, "upper": 0.8}]

    def draw(self, steps, censored):
        drawing, axes = style.subplots(figsize=(6.4, 4.8))
        group = {"survival": steps, "censored_distances": censored}
        arrays.draw_band(axes, group)
        survival_curve.draw(axes, group, "black", "")
        return survival_curve.longest_way(group), axes

    def test_it_goes_to_the_longest_way_with_a_tick_for_every_run_that_was_still_going(self):
        end, axes = self.draw(self.STEPS, [3.0, 9.0])
        curve, ticks = axes.lines
        self.assertEqual(end, 9)
        self.assertEqual(curve.get_xydata()[-1].tolist(), [9, 0.375])
        self.assertEqual(ticks.get_xydata().tolist(), [[3, 0.75], [9, 0.375]])
        self.assertEqual(axes.collections[0].get_paths()[0].get_extents().extents.tolist(), [0, 0.01, 9, 1])

    def test_its_band_ends_where_no_run_is_left(self):
        last = {"distance": 7.0, "probability": 0.0, "lower": None, "upper": None}
        end, axes = self.draw([*self.STEPS, last], [])
        curve, = axes.lines
        self.assertEqual((end, curve.get_xydata()[-1].tolist()), (7, [7, 0]))
        self.assertEqual(axes.collections[0].get_paths()[0].get_extents().extents.tolist(), [0, 0.01, 7, 1])

    def test_all_of_it_has_its_place_on_the_scale(self):
        lowest = arrays.lowest_shown({"survival": self.STEPS, "clogging_length": 5.0}, 9.0)
        self.assertLess(lowest, 0.01)


class Parts(unittest.TestCase):
    """Tests pictures of invented numbers and outlines."""

    def test_the_legend_of_displacements_has_the_order_of_the_curves_at_their_ends(self):
        def run(end):
            row = dict.fromkeys(("obstacle_gap", "obstacle_diameter", "terminal_speed", "vertices", "seed"), 1)
            row = np.array([tuple(row.values())], dtype=[(name, float) for name in row])[0]
            return SimpleNamespace(row=row, table={"time": np.array([0, 1]), "distance": np.array([0, end])},
                                   word=lambda _: "flowing")

        with unittest.mock.patch.object(arrays, "displacements",
                                        lambda _: {0.1: run(0.5), 0.2: run(0.9), 0.5: run(0.7)}):
            axes, = arrays.displacement(None).figure.axes
        legend = axes.get_legend()
        self.assertEqual([text.get_text() for text in legend.get_texts()][1:],
                         [rf"$\Gamma = {number}$" for number in (0.2, 0.5, 0.1)])
        self.assertEqual([line.get_color() for line in legend.get_lines()[1:]],
                         [style.COLOURS[index] for index in (1, 2, 0)])

    def test_clogs_of_figure_5_have_one_scale_with_a_bar(self):
        circle = np.array([np.cos(np.linspace(0, 6, 40)), np.sin(np.linspace(0, 6, 40))]) / 2

        def example(_, mechanism):
            outlines = np.array([circle * [[5 if mechanism == "wrapped" else 1], [1]] + [[step / 2], [0]] for step in range(6)])
            row = SimpleNamespace(line_tension=1, obstacle_gap=0.2, friction=0, seed=1, distance=1, mechanism=mechanism)
            return SimpleNamespace(polygons=outlines, times=np.arange(6), obstacles=np.empty((0, 3)), wedges=[],
                                   word=lambda _: mechanism), row

        with unittest.mock.patch.object(arrays, "example", example):
            plates = [arrays.two_ways(None), *(arrays.snapshot(None, mechanism) for mechanism in ("wrapped", "squeezed"))]
        for figure in (plate.figure for plate in plates):
            figure.canvas.draw()
            scales = {round(axes.get_window_extent().width / np.ptp(axes.get_xlim()), 3) for axes in figure.axes if axes.axison}
            self.assertEqual(len(scales), 1)
            self.assertIn(r"$\sigma$", [text.get_text() for text in figure.findobj(Text)])

    def test_frames_of_the_map_tell_exponential_from_other_distances_and_too_few_clogs(self):
        axes = style.new_figure().subplots()
        for place, (clogs_, p_value) in enumerate([(10, 0.5), (10, 0.01), (9, 0.5)]):
            group = {"clogs": clogs_, "weibull_p_value": p_value, "doubts": None, "clogging_length": 3.0}
            dilute.draw_cell(axes, place, 0, group, matplotlib.colors.LogNorm(0.1, 10))
        frames = {round(patch.get_x() + 0.43): patch.get_linestyle() for patch in axes.patches if not patch.get_fill()}
        self.assertEqual(frames, {0: "-", 1: ":"})

    def test_neighbours_among_curves_have_colours_that_the_eye_tells_apart(self):
        for number in range(2, len(style.COLOURS) + 1):
            colours = matplotlib.colors.to_rgba_array(style.shades(number))
            self.assertGreater(np.abs(np.diff(colours, axis=0)).max(axis=1).min(), 0.3)

    def test_all_frames_of_the_reference_in_figure_B2_lie_within_the_compared_passages(self):
        # The passages have the same profile, but frames at different places. All deviations must be 0.
        def run(step):
            h = np.arange(-2, 2, step)
            word = {"line_tension": 1.7, "near_wall_drag": 0.21, "terminal_speed": 0.028, "vertices": 64, "orifice": 0.9}
            return SimpleNamespace(table=np.rec.fromarrays([h, 1 + 0.1 * h, 1 + 0 * h], names="h,speed_ratio,shape_parameter"), row=word, word=lambda _: "elastic")

        written = {}

        def fit(_, *names):
            reference, *compared = (Profile(*np.array(list(written[name])).T) for name in names)
            return {"deviations": [{"delta_v": root_mean_square(speed_residuals(reference, simulated)[0])} for simulated in compared]}

        runner = SimpleNamespace(
            profiles=[], table=lambda name, _, rows: written.setdefault(name, list(rows)) and name, fit=fit)
        with unittest.mock.patch.object(channels, "profiles", lambda *_, **__: [run(0.01 + 0.0007 * number) for number in range(7)]):
            plate = channels.perimeter_springs(runner)
        np.testing.assert_allclose([entry["delta_v"] for entry in plate.data], 0, atol=1e-12)

    def test_a_legend_stays_off_error_bars(self):
        # The error bars fill the axes completely, or everywhere except at the lower right. The legend would have room
        # above the points, but not above their bars.
        for lowest in (6, 0):
            axes = style.new_figure().subplots()
            right = np.arange(12) > 8
            axes.errorbar(range(12), np.where(right, 8, 2),
                          yerr=[np.where(right, 8 - lowest, 2), np.where(right, 2, 8)], label="a curve")
            axes.set_ylim(0, 10)
            style.legend(axes)
            axes.figure.canvas.draw()
            box = axes.get_legend().get_window_extent()
            bars = axes.containers[0].lines[2][0].get_segments()
            self.assertFalse([bar for bar in bars if box.overlaps(matplotlib.transforms.Bbox(axes.transData.transform(bar)))])
            self.assertEqual(axes.get_ylim()[1] > 10, lowest == 0)


class Drawn(Analysis):
    """Draws figures in the test's folder."""

    PLACE = "reduced"

    def figures(self, *arguments):
        return self.draw("figures", "--output", ".", "--programs", BIN, *SET, *arguments)

    def drawn(self, name):
        with open(self.folder / self.PLACE / f"figure-{name}.csv") as file:
            return list(csv.DictReader(file))

    def fit(self, sweep):
        return json.loads(self.succeed("clogfit", f"{self.PLACE}/sweeps/{sweep}.h5", "--format",
                                       "json").stdout)["groups"]

    def assert_groups(self, name, sweep, quantity):
        """Checks that the numbers beside the picture are exactly those of clogfit."""
        groups = [group for group in self.fit(sweep) if group[quantity] is not None]
        self.assertGreater(len(groups), 0)
        points = [row for row in self.drawn(name) if row["model"] == groups[0]["model"] and row[quantity]]
        keys = ["obstacle_gap", "obstacle_diameter", "near_wall_drag", "line_tension" if groups[0]["model"] == "dp" else "wall_stiffness"]
        self.assertEqual(sorted([*(float(point[key]) for key in keys), float(point[quantity])] for point in points),
                         sorted([*(group[key] for key in keys), group[quantity]] for group in groups))

    def assert_drawn(self, name):
        self.assert_picture(f"{self.PLACE}/figure-{name}")
        about = (self.folder / self.PLACE / f"figure-{name}.txt").read_text()
        for word in ("git", "clogsweep"):
            self.assertIn(word, about)
        if name not in SINGLE_RUNS:
            self.assertIn("seeds 1 to ", about)

    def assert_sags(self, name):
        """Checks the sags. A soft disk cannot change its shape, so its top and its centre both sink by pi/(16 E_w)."""
        disks = [point for point in self.drawn(name) if point["model"] == "sp"]
        self.assertGreater(len(disks), 0)
        for point in disks:
            self.assertAlmostEqual(float(point["top_sag"]), math.pi / 16 / float(point["wall_stiffness"]), delta=1e-4)
        found = pandas.concat(table(file) for file in (self.folder / self.PLACE / "sweeps").glob("sag-*.h5"))
        self.assertTrue({float(point["top_sag"]) for point in self.drawn(name)} <= set(found.top_sag))

    def call_wrapped(self, sweep, number):
        """Marks one clog of the sweep as wrapped, and all others as squeezed."""
        def edit(rows):
            clogged = np.flatnonzero(rows["status"] == b"clogged")
            rows["mechanism"][clogged] = b"squeezed"
            rows["mechanism"][clogged[number]] = b"wrapped"

        stored_rows.change(sweep, edit)

    def assert_clogs(self, sweep, *names):
        """Checks the figures of clogs. One clog is marked as wrapped, because no droplet wraps in such a short
        sweep."""
        self.call_wrapped(sweep, -1)
        before = table(sweep)
        # A repeated command runs nothing.
        self.figures(*names)
        pandas.testing.assert_frame_equal(table(sweep), before, check_exact=True)
        for name in names:
            self.assert_picture(f"{self.PLACE}/figure-{name}")
        wrapped, squeezed = self.drawn("6a")[0], self.drawn("6b")[0]
        self.assertEqual([wrapped["mechanism"], squeezed["mechanism"]], ["wrapped", "squeezed"])
        clogs = before[before.status == "clogged"]
        self.assertEqual(float(wrapped["distance"]), clogs.distance.iloc[-1])
        task = clogs.task.iloc[-1]
        with h5py.File(sweep.parent.parent / "runs" / f"clogging-friction-{task}.h5") as file:
            self.assertEqual(file["runs"]["distance"][0], float(wrapped["distance"]), "the same run, bit for bit")
        # With --draw-only a figure is refused if a stored replay is not that of the droplet that the figure would name.
        self.call_wrapped(sweep, 0)
        self.refuse_analysis("figures", "6a", "--output", ".", "--programs", BIN, *SET, "--draw-only",
                             words=["clogging-friction-", "leave out --draw-only"])
        # clogsweep refuses to resume the sweep with other settings.
        self.refuse_analysis("figures", "6a", "--output", ".", "--programs", BIN, *SET, "--set",
                             "clogging-friction:box=30", words=["box"])

    def assert_report(self, sweep):
        self.draw("report", sweep, "--output", "report.html", "--examples", 0, "--programs", BIN)
        page = (self.folder / "report.html").read_text()
        self.assertNotRegex(page, r"(src|href)=\"(?!data:|#)", "nothing from elsewhere")
        fit = json.loads(self.succeed("clogfit", sweep, "--format", "json").stdout)
        for group in fit["groups"]:
            self.assertIn(report.table_cell(report.speed(group)), page)
        for heading in ("How far droplets get", "What becomes of them"):
            self.assertIn(heading, page)
        self.assertIn("few clogs", page)
        self.assertIn(html.escape(fit["doubts"]["few_clogs"]), page)
        self.assertGreaterEqual(page.count("<svg"), 3)
        self.assertIn("command_line: clogsweep", page)

    def assert_curves(self, names, *more):
        """Checks figures with curves. @param names  for each figure with numbers of clogfit, by its name: the sweep and
        the quantity"""
        done = self.figures(*names, *more, "--ranks", 1)
        self.assertNotIn("Warning", done.stderr)
        for name in [*names, *more]:
            with self.subTest(figure=name):
                self.assert_drawn(name)
                if name in names:
                    self.assert_groups(name, *names[name])

    def assert_single_runs(self, names, num_runs, *redrawn):
        self.write("measured.csv", "\n".join(["h [sigma], v [v_t], A", *(f"{h / 10},{0.5 + 0.01 * h},1.0{abs(h)}" for h in range(-9, 10))]))
        done = self.figures(*names, "--profile", "measured.csv")
        self.assertEqual(done.stdout.count("sweep channel-0.4:"), 1, "1 and 2 share it")
        for name in names:
            with self.subTest(figure=name):
                self.assert_drawn(name)
        self.assert_passage_and_survival()
        # --draw-only uses existing files, whatever the settings are, and does not run anything.
        before = self.times_of_runs()
        self.assertEqual(len(before), num_runs)
        self.figures(*redrawn, "--draw-only", "--set", "channel:max-time=200")
        self.figures(*names, "--set", "seeds=1..3")
        self.assertEqual(self.times_of_runs(), before)
        # Without --draw-only, clogsweep refuses to resume the sweep with other settings.
        self.refuse_analysis("figures", redrawn[0], "--output", ".", "--programs", BIN, *SET, "--set",
                             "channel:max-time=200", words=["max-time"])

    def assert_passage_and_survival(self):
        """Checks figures 2 and C2."""
        with h5py.File(self.folder / self.PLACE / "runs" / "channel-0.4-0.h5") as file:
            trajectory = file["trajectory"][:]
        points = self.drawn("2")
        self.assertEqual(float(points[0]["h"]), trajectory["h"][0])
        self.assertTrue(set(float(point["shape_parameter"]) for point in points) <= set(trajectory["shape_parameter"]))
        group, points = self.fit("survival")[0], self.drawn("C2")
        for name in ("probability", "lower"):
            drawn = [float(point[name]) if point[name] else None for point in points[1:1 + len(group["survival"])]]
            self.assertEqual(drawn, [step[name] for step in group["survival"]])
        self.assertEqual([float(point["censored_distance"]) for point in points if point.get("censored_distance")],
                         group["censored_distances"])

    def times_of_runs(self):
        return {path: path.stat().st_mtime_ns for path in (self.folder / self.PLACE / "runs").iterdir() if path.suffix == ".h5"}


class Figures(Drawn):
    """Tests some figures of every kind. slow_figures tests all figures."""

    def test_curves_show_what_clogfit_says(self):
        self.assert_curves({"7a": ("clogging-sp", "clogging_length"), "8ca": ("speed", "relative_speed_steady")}, "9b")
        self.assert_sags("9b")

    def test_clogs_are_those_of_the_sweep(self):
        self.figures("6b")
        sweep = self.folder / self.PLACE / "sweeps" / "clogging-friction.h5"
        self.assert_clogs(sweep, "6a", "6b")
        self.assert_report(sweep)

    def test_single_runs_are_drawn_as_they_were_run(self):
        self.assert_single_runs(["1", "2", "C2"], 2, "2")

    def test_settings_of_all_figures_are_accepted(self):
        for config in sorted((ROOT / "jobs" / "figures").glob("*.cfg")):
            with self.subTest(config=config.name):
                points = config.with_suffix(".csv")
                beside = ["--points", points] if points.exists() else []
                self.succeed("clogsweep", "--config", config, *beside, "--print-config")

    def test_soft_droplets_have_fine_meshes_or_their_own_inertia(self):
        """Soft droplets without friction need fine meshes. Droplets that slide off obstacles fast need their own
        inertia. Files of families are left out, because they compare meshes."""
        for points in (ROOT / "jobs/figures").glob("*.csv"):
            if points.name.startswith("families"):
                continue
            table = pandas.read_csv(points)
            column, value, limit = ("inertia", 1, 0.049) if "robust" in points.name else ("vertices", 512, 0.1)
            self.assertTrue(((table[column] == value) == (table["line-tension"] <= limit)).all(), points)

    def test_a_set_key_replaces_the_points_of_a_figure(self):
        tensions = "0.04,0.07,0.1,0.2,0.5,1,3,10"
        for settings, there, absent in [
            ([], ["--points", "speed.reduced.csv"], ["line-tension="]),
            (["speed:seeds=1..2"], ["--points"], ["line-tension="]),
            (["vertices=64"], [f"line-tension={tensions}", "vertices=64"], ["--points"]),
            (["speed:line-tension=1"], ["line-tension=1"], ["--points", tensions]),
            (["speed-sp:vertices=64"], ["--points"], ["vertices="]),
        ]:
            words = [word for setting in settings for word in ("--set", setting)]
            with self.subTest(settings=settings):
                printed = self.analyse("figures", "8a", "--programs", BIN, "--draw-only", "--output", ".", *words)
                self.assertEqual(printed.returncode, 2)
                for word in ("speed.h5", *there):
                    self.assertIn(word, printed.stderr)
                for word in absent:
                    self.assertNotIn(word, printed.stderr)
                self.assertEqual("replaces speed.reduced.csv, which pairs line-tension and vertices" in printed.stdout,
                                 "--points" in absent)

    def test_mistakes_get_one_line(self):
        for arguments, words in [
            (["6c", "13"], ["no figure 13", "list"]),
            (["6c", "--programs", "nowhere"], ["no clogsweep in nowhere"]),
            (["6c", "--programs", BIN, "--draw-only", "--output", "."], ["clogging-robust.h5", "--draw-only"]),
            (["6c", "--programs", BIN, "--set", "seeds"], ["--set seeds", "KEY=VALUE"]),
            (["6c", "--programs", BIN, "--set",
              "clogging:seeds=1..2"], ["--set clogging:seeds=1..2", "no figure has a config"]),
            (["6c", "--programs", BIN, "--output", ".", "--ranks", "1", "--set",
              "obstacle-gap=-1"], ["obstacle-gap=-1"]),
            (["2", "--programs", BIN, "--output", ".", *SET, "--profile", "no.csv"], ["cannot read no.csv"]),
        ]:
            with self.subTest(arguments=arguments):
                self.refuse_analysis("figures", *arguments, words=words)
        self.assertIn("A1", self.draw("figures", "list").stdout)


class Pictures(Analysis):
    def test_a_film_is_whole_or_not_there(self):
        def stopped(drawn, part, rate):
            part.write_bytes(b"half a film")
            raise KeyboardInterrupt

        with unittest.mock.patch.object(film, "write_gif", stopped), self.assertRaises(KeyboardInterrupt):
            film.write_film(None, self.folder / "film.gif", 25)
        self.assertEqual(list(self.folder.iterdir()), [])

    def test_mixtures_and_lattices_are_drawn_from_a_fit(self):
        soft_disks = ["model=sp", "wall-stiffness=0.3,3", "box=20", "max-time=300", "seeds=1..2"]
        for name, keys in [
            ("mixture", [*soft_disks, "obstacle-diameter-spread=0.3", "obstacle-density=0.5,saturated"]),
            ("lattice", [*soft_disks, "obstacle-layout=lattice", "lattice-angle=0,10"]),
        ]:
            self.succeed("clogsweep", *keys, "--output", f"{name}.h5")
            self.write("fit.json", self.succeed("clogfit", f"{name}.h5", "--format", "json").stdout)
            self.draw("clogging-length", "fit.json", "--output", name)
            self.assert_picture(name)

    def test_numbers_have_the_figures_that_their_interval_allows(self):
        for numbers, text in [((223.1, 101.8, 584.8), "223 (102 to 585)"),
                              ((0.1731, 0.1013, 0.3609), "0.173 (0.101 to 0.361)"),
                              ((1906, 407.7, 17660), "1910 (408 to 17700)"),
                              ((25.93, 22.52, 29.98), "25.9 (22.5 to 30.0)"),
                              ((1234.5, 1232.1, 1237.2), "1234.5 (1232.1 to 1237.2)")]:
            self.assertEqual(rounded.with_interval(*numbers), text)
        for numbers, text in [((0.3786, 0.01244), "0.379 ± 0.012"), ((0.4451, 0.003992), "0.4451 ± 0.0040"),
                              ((0.5, None), "0.500"), ((None, None), "-"), ((123.4, 17.2), "123 ± 17"),
                              ((0.730780239914, 3.8e-11), "0.73078024 ± 3.8e-11")]:
            self.assertEqual(rounded.with_error(*numbers), text)
        self.assertEqual([rounded.plain(value) for value in (0, 9.999, 1e-9, 2.5e7)],
                         ["0.00", "10.0", "1.00e-09", "2.50e+07"])

    def group(self, clogs, **columns):
        names = ("", "_lower", "_upper")
        lengths = {f"clogging_length{name}": length for name, length in zip(names, (2.0, 1.0, 4.0))}
        return {"clogs": sum(clogs), "doubts": None, **dict(zip(style.MECHANISM_MARKERS, clogs)), **lengths, **columns}

    def test_markers_show_by_what_droplets_clog_and_open_ones_a_doubt(self):
        axes = style.new_figure().subplots()
        groups = [self.group((4, 1, 0, 0), doubts="few_clogs held_by_mesh"), self.group((1, 4, 0, 0)), self.group((0, 1, 3, 0)), self.group((0, 0, 0, 0))]
        lengths.draw_lengths(axes, [1, 2, 3, 4], groups, 0, "")
        drawn = {line.get_xdata()[0]: (line.get_marker(), line.get_markerfacecolor() == "white") for line in axes.lines
                 if len(line.get_xdata()) == 1 and np.isfinite(line.get_ydata()[0])}
        arrow = drawn.pop(4)[0]
        self.assertEqual(drawn, {1: ("o", True), 2: ("s", False), 3: ("D", False)})
        # The arrow rises from the lower bound.
        self.assertEqual(arrow.vertices[:, 1].min(), 0)
        self.assertEqual([line.get_ydata().tolist() for line in axes.lines if line.get_marker() is arrow], [[1.0]])
        self.assertEqual(style.mechanism_note(groups), "circles: most clogs wrapped; squares: most clogs squeezed; "
                         "diamonds: most clogs hybrid")

    def test_labels_of_an_abscissa_are_plain_numbers_side_by_side(self):
        for values in ([0.2, 0.25, 0.3, 10], np.linspace(0.2, 0.4, 15), [0.3, 0.31], [0.3], [0.04, 0.045, 0.05, 0.5, 5], np.geomspace(0.01, 10, 30)):
            figure, axes = style.subplots(figsize=(6.4, 4.8))
            axes.plot(values, values)
            style.logarithmic_abscissa(axes, list(values))
            figure.canvas.draw()
            labels = [label for label in axes.get_xticklabels() + axes.get_xticklabels(minor=True) if label.get_text()]
            low, high = axes.get_xlim()
            boxes = [label.get_window_extent() for label in labels if low <= label.get_position()[0] <= high]
            self.assertGreater(len(boxes), 0)
            self.assertFalse([values for one, other in itertools.combinations(boxes, 2) if one.overlaps(other)])
            self.assertTrue(all(float(label.get_text()) > 0 for label in labels))
            if len(values) < 5:
                known = {(0.2, 0.25, 0.3, 10): [0.2, 0.3, 10], (0.3, 0.31): [0.3, 0.31],
                         (0.3,): [0.2, 0.25, 0.3, 0.35, 0.4]}
                self.assertEqual(sorted(float(label.get_text()) for label in labels), known[tuple(values)])
            self.assertEqual(len({label.get_window_extent().y0 for label in labels}), 1)

    def test_a_logarithmic_ordinate_has_several_labels(self):
        for ends, expected in [((3, 30), ["5", "10", "20"]), ((0.9, 6), ["1", "2", "5"]), ((2.1, 4.9), ["3", "4"]),
                               ((1, 1e4), ["$\\mathdefault{10^{%d}}$" % n for n in (1, 2, 3)])]:
            axes = style.new_figure().subplots()
            style.logarithmic_ordinate(axes)
            axes.set_ylim(ends)
            axes.figure.canvas.draw()
            shown = [label for label in axes.get_yticklabels() + axes.get_yticklabels(minor=True) if label.get_text() and ends[0] < label.get_position()[1] < ends[1]]
            self.assertEqual([label.get_text() for label in sorted(shown, key=lambda label: label.get_position()[1])], expected)

    def test_warnings_of_libraries_stay_away_from_the_terminal(self):
        lines = "from clogsweep.commands import command_line\nwith command_line.needs_modules():\n    import warnings\n    warnings.warn('of a library')"
        for switches, expected in [([], ""), (["-W", "default"], "of a library")]:
            done = subprocess.run([sys.executable, *switches, "-c", lines], cwd=ROOT / "analysis", capture_output=True, text=True)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertIn(expected, done.stderr)
            self.assertEqual(bool(done.stderr), bool(expected))

    def test_a_report_counts_the_runs_that_are_still_to_come(self):
        self.copy_sweep("s.h5", *FEW)
        self.assertEqual(self.run_program("clogsweep", *FEW[:-1], "seeds=1..20", "--max-hours=1e-9", "--output", "s.h5").returncode, 75)
        status = json.loads(self.succeed("clogsweep", "status", "s.h5", "--format", "json").stdout)
        self.assertEqual(status["runs"], 40)
        self.assertIn(f"{status['finished']} of 40 runs finished", report.progress_of(status))

    def test_a_report_says_which_programs_made_it(self):
        self.copy_sweep("s.h5", *FEW)
        self.draw("report", "s.h5", "--output", "report.html", "--examples", 0)
        with stored.opened(self.folder / "s.h5") as file:
            about = stored.attributes(file)
        page = (self.folder / "report.html").read_text()
        self.assertIn(f"git_describe: {about['git_describe']}\n", page)
        self.assertIn("4 of 4 runs finished", page)
        self.assertIn(f"fitted by clogfit {about['version']}, git {about['git_describe']}", page)
        older = {"version": "0.1.0", "git_hash": "0123456789ab"}
        self.assertEqual(stored.writer(older), "0.1.0, git 0123456789ab")

    def test_a_doubtful_length_has_a_hollow_marker_and_the_reason_below_it(self):
        self.copy_sweep("s.h5", *QUICK, "line-tension=2,30", "seeds=1..5")
        groups = Groups(json.loads(self.succeed("clogfit", "s.h5", "--format", "json").stdout))
        for group, doubts in zip(groups.members, (["below_spacing"], ["below_spacing", "untested"])):
            self.assertEqual(lengths.reasons_for_hollow_marker(group), doubts)

        def hollow_places():
            """@return the places of hollow markers, and the notes"""
            axes = style.figure_of(lengths.draw_on, groups).axes[0]
            notes, = [text.get_text() for text in axes.texts if text.get_gid() == style.NOTES]
            return [line.get_xdata()[0] for line in axes.lines if line.get_markerfacecolor() == "white"], notes

        groups.members[0]["doubts"] = "censored_by_time"
        places, notes = hollow_places()
        self.assertEqual(places, [30])
        for reason in ("outside the range that was tested for soundness", "lengths below one obstacle spacing"):
            self.assertIn(reason, " ".join(notes.partition("hollow: ")[2].split()))
        self.assertNotIn("incomplete", notes)
        groups.members[0]["doubts"] = "few_clogs incomplete"
        places, notes = hollow_places()
        self.assertEqual(places, [2, 30])
        self.assertIn("hollow: fewer than 5 clogs", notes)
        self.assertIn("incomplete: runs of 1 of 2 points are unfinished", notes)
        self.assertNotIn("failed", notes)
        groups.members[0]["clogs"] = 0  # An arrow already shows that there are no clogs.
        self.assertNotIn("fewer than 5 clogs", hollow_places()[1])

    def test_clogs_are_drawn_from_a_sweep(self):
        self.copy_sweep("s.h5", *FEW)
        printed = self.draw("clogs", "s.h5", "--programs", BIN, "--most", 2).stdout
        self.assertEqual(printed, "s-clogs.png (and .pdf)\n")
        self.assert_picture("s-clogs")
        self.refuse_analysis("clogs", "s.h5", "--programs", BIN, "--output", "clogs", "--tasks", "0,77", words=["77"])

    def test_the_clogging_length_comes_from_the_sweep_itself_by_the_programs_of_the_path(self):
        self.copy_sweep("s.h5", *FEW)
        self.write("fit.json", self.succeed("clogfit", "s.h5", "--format", "json").stdout)
        self.draw("clogging-length", "fit.json", "--output", "from-fit")
        (self.folder / "clogsweep").touch(mode=0o755)
        with unittest.mock.patch.dict(os.environ, {"CLOG_BIN": "/nowhere", "PATH": f"{BIN}:{os.environ['PATH']}"}):
            self.assertEqual(programs.programs_in(), BIN.resolve())
            os.environ["CLOG_BIN"] = str(self.folder)
            self.assertEqual(programs.programs_in(), self.folder.resolve())
            self.assertEqual(programs.programs_in(BIN), BIN.resolve())
            del os.environ["CLOG_BIN"]
            self.draw("clogging-length", "s.h5", "--output", "from-sweep")
        self.assertTrue((image.imread(self.folder / "from-fit.png") == image.imread(self.folder / "from-sweep.png")).all())

    def test_edges_marked_as_touching_are_those_that_the_program_counts(self):
        # Between the post and each side wall there is a gap that is narrower than the droplet.
        self.write("post.csv", "3,0.9,1\n")
        # The edges have different lengths, so straight edges touch at other places than the curved interface. The cases
        # have contact at the surface, or at the distance `contact-range` from the surface.
        for name, points_per_vertex, keys in [
            ("surface", 2, ["preset=elastic", "vertices=32", "line-tension=0.3,1", "box=20"]),
            ("off", 2, ["contact-range=half-vertex", "vertices=32", "line-tension=1", "box=20"]),
            ("vertices", 1, ["wall-contact=vertex", "contact-range=half-vertex", "vertices=64", "line-tension=1", "box=20"]),
            ("walls", 2, ["obstacles=post.csv", "box=1.8", "length=9", "side-walls=on", "release=entrance", "entrance=1.5", "line-tension=1"]),
        ]:
            self.succeed("clogsweep", *keys, "max-time=500", "seeds=1..4", "--output", f"{name}.h5")
            found = clogsweep.open(self.folder / f"{name}.h5", BIN).clogs(most=100)
            self.assertGreater(len(found), 0)
            for clog in found:
                row = clog.row
                with self.subTest(contact=name, task=clog.task):
                    self.assertEqual(clog.polygon.shape[1], points_per_vertex * row["vertices"])
                    depths = clogs.overlaps(clog)
                    touched = np.where(depths.max(axis=0) > 0, depths.argmax(axis=0), -1)
                    arcs = np.count_nonzero((touched >= 0) & (touched != np.roll(touched, 1)))
                    self.assertEqual(arcs, row["num_arcs"])
                    if name == "walls":
                        self.assertTrue((depths[len(clog.obstacles):] > 0).any(), "a wall is touched")
                        self.assertEqual(row["mechanism"], b"squeezed")

    def test_foreign_files_get_one_line(self):
        self.write("fit.json", json.dumps({"groups": "none"}))
        self.write("run.h5", "nothing")
        for command, file in [("clogging-length", "fit.json"), ("droplet", "run.h5"),
                              ("export-vtk", "run.h5"), ("clogs", "run.h5"), ("report", "run.h5")]:
            with self.subTest(command=command, file=file):
                where = ["--programs", BIN] if command in ("report", "clogs") else []
                self.refuse_analysis(command, file, "--output", "x", *where,
                                     words=["run.h5" if command == "report" else "cannot read"])

    def test_nothing_is_written_over_what_is_read_or_of_another_kind(self):
        self.copy_sweep("s.h5", *FEW)
        self.copy_sweep("run.h5", "array", *QUICK, "--polygon-interval", 10, program="clogrun")
        self.write("fit.json", self.succeed("clogfit", "s.h5", "--format", "json").stdout)
        self.write("profile.csv", "h [sigma], v [v_t]\n0,1\n1,1\n2,1\n")
        (self.folder / "soft.h5").symlink_to("s.h5")
        os.link(self.folder / "s.h5", self.folder / "hard.h5")
        for name in ("own.png", "own2.pdf", "own3.pvd", "own4.mp4", "own4.gif", "page.html"):
            self.write(name, "of the user")
        for folder, kept in [("own5", "figure-4.png"), ("own6", "figure-4.txt")]:
            (self.folder / folder / "reduced").mkdir(parents=True)
            os.link(self.folder / "profile.csv", self.folder / folder / "reduced" / kept)
        before = self.snapshot()
        for command, source, output, words in [
            ("report", "s.h5", "s.h5", ["it is an input"]),
            ("report", "s.h5", "soft.h5", ["it is an input"]),
            ("report", "s.h5", "hard.h5", ["it is an input"]),
            ("report", "soft.h5", "run.h5", ["run.h5", "it is no HTML file"]),
            ("report", "s.h5", "page.html", ["page.html", "it is no HTML file"]),
            ("clogging-length", "fit.json", "own", ["own.png", "it is no PNG file"]),
            ("clogs", "s.h5", "own2", ["own2.pdf", "it is no PDF file"]),
            ("droplet", "run.h5", "own", ["own.png", "it is no PNG file"]),
            ("export-vtk", "run.h5", "own3", ["own3.pvd", "it is no VTK file"]),
            ("droplet", "run.h5", "own4", ["own4.", "it exists", "--film"][:2]),
            ("droplet", "run.h5", "own4.gif", ["own4.gif", "it exists"]),
        ]:
            with self.subTest(command=command, output=output):
                film = ["--film"] if output.startswith("own4") else []
                where = ["--programs", BIN] if command in ("report", "clogs") else []
                self.refuse_analysis(command, source, "--output", output, *film, *where, words=words)
        self.refuse_analysis("figures", "4", "--programs", BIN, "--output", "own5",
                             words=["figure-4.png", "no PNG file"])
        self.refuse_analysis("figures", "4", "--programs", BIN, "--output", "own6", "--profile", "profile.csv",
                             words=["figure-4.txt", "it is an input"])
        for film in ("own4", "own4.mp4", "own4.gif"):
            self.refuse("clogrun", "array", *QUICK, "--polygon-interval", 15, "--frames", film, "--output", "r.h5",
                        words=["own4.", "it exists"])
        after = self.snapshot()
        self.assertEqual({name: after[name] for name in before}, before)
        # The command may replace a page or picture that it made earlier.
        self.write("report.html", "<!DOCTYPE html>\n<title>an earlier one</title>\n")
        self.draw("report", "s.h5", "--output", "report.html", "--programs", BIN, "--examples", 0)
        for _ in range(2):
            self.draw("clogging-length", "fit.json", "--output", "length")
            self.draw("export-vtk", "run.h5", "--output", "run")

    def test_no_two_outputs_of_a_run_are_one_file(self):
        for options in (["--output", "a.csv", "--write-obstacles",
                         "./a.csv"], ["--output", "film.mp4", "--frames", "film"],
                        ["--output", "r.h5", "--write-obstacles", "film.gif", "--frames", "./film.gif"]):
            self.refuse("clogrun", "array", *QUICK, "--polygon-interval", 15, *options,
                        words=["name the same file", "give two names"])

    def test_mistakes_get_one_line_from_every_command(self):
        self.copy_sweep("s.h5", *FEW)
        self.write("text.h5", "not a table")
        (self.folder / "folder").mkdir()
        for arguments, words in [
            (["missing.h5", "--output", "page.html"], ["missing.h5", "no such file"]),
            (["text.h5", "--output", "page.html"], ["text.h5", "not an HDF5 file"]),
            (["s.h5", "--output", "nowhere/page.html"], ["no folder nowhere"]),
            (["s.h5", "--output", "folder"], ["is a folder"]),
            (["s.h5", "--output", "/dev/full"], ["/dev/full", "not a regular file"]),
            (["s.h5", "--output", "page.html", "--colour", "red"], ["--colour red", "--help"]),
            (["s.h5", "--output", "page.html", "--examples", "-1"], ["--examples", "-1"]),
            (["s.h5", "--output", "page.html", "--programs", "folder"], ["no clogsweep in folder"]),
        ]:
            with self.subTest(arguments=arguments):
                self.refuse_analysis("report", *arguments, words=["python3 -m clogsweep report: ", *words])
        self.refuse("clogfit", "report", *arguments, words=["clogfit report: ", *words])
        for command in ("clogging-length", "clogs", "droplet", "export-vtk", "figures"):
            with self.subTest(command=command):
                self.refuse_analysis(command, "s.h5", "--colours",
                                     words=[f"python3 -m clogsweep {command}: ", "--help"])

    def test_a_message_names_matplotlib_if_it_is_missing(self):
        self.write("matplotlib.py", "raise ImportError('No module named matplotlib')")
        environment = os.environ | {"PYTHONPATH": str(self.folder)}
        done = subprocess.run([str(BIN / "clogfit"), "report", "s.h5", "--output", "page.html"], cwd=self.folder,
                              env=environment, capture_output=True, text=True)
        self.assertEqual(done.returncode, 2)
        self.assertRegex(done.stderr, r"^clogfit report: .*matplotlib.*; .*python.* needs h5py, .*\n$")

    def film_of(self, *keys, most=600, **options):
        """@return the run, the chosen frames and the film"""
        self.succeed("clogrun", "array", *SMALL, *keys, "--output", "filmed.h5")
        run = trajectory.read(self.folder / "filmed.h5")
        frames = film.chosen_frames(run, most)
        return run, frames, film.Film(run, frames, **{"colour": "speed", "rate": 20} | options)

    def test_the_camera_follows_the_droplet_and_the_verdict_comes_last(self):
        run, frames, moving = self.film_of("preset=elastic", "line-tension=0.3", "obstacle-gap=0.3", "max-time=400",
                                           "--polygon-interval", 10)
        self.assertEqual(frames.tolist(), list(range(len(run.times))))
        axes = moving.figure.axes[0]
        verdict = trajectory.verdict(run)
        shown = []
        for index, frame in enumerate(frames):
            moving.show(index)
            low, high = np.array([axes.get_xlim(), axes.get_ylim()]).T
            self.assertTrue((run.polygons[frame].min(axis=1) > low).all()
                            and (run.polygons[frame].max(axis=1) < high).all())
            self.assertGreater(1, (high - low).max() / 10, "the droplet can be seen")
            # The file contains obstacles wherever the camera looks.
            self.assertLess(run.obstacles[:, 0].min(), low[0] + 0.5)
            self.assertGreater(run.obstacles[:, 0].max(), high[0] - 0.5)
            shown.append([text.get_text() for text in axes.texts if text.get_visible()])
        self.assertTrue(all(verdict not in texts for texts in shown[:-1]))
        self.assertIn(verdict, shown[-1])

    def test_a_film_has_so_many_frames_at_most(self):
        run, frames, _ = self.film_of("obstacle-gap=1.2", "max-time=2000", "--polygon-interval", 1, most=100)
        self.assertGreater(len(run.times), 1000)
        self.assertEqual(frames[-1], len(run.times) - 1)
        self.assertLessEqual(len(frames), 100)
        # The whole run in 100 frames would have steps that the eye cannot follow, so the film shows only the end of the
        # run.
        self.assertGreater(frames[0], 0)
        steps = np.abs(np.diff(trajectory.centroids(run.polygons)[frames], axis=0)).sum(axis=1)
        self.assertLess(steps.max(), 2 * film.LONGEST_STEP)
        self.assertEqual(len(film.chosen_frames(run, 10**6)), len(run.times))
        for most in (1, 2):
            self.assertEqual(len(film.chosen_frames(run, most)), most)

    def test_a_film_that_has_room_for_the_whole_run_begins_with_its_first_frame(self):
        for count in (2, 3, 7, 40, 100, 601):
            run = SimpleNamespace(times=np.arange(count), polygons=np.tile([[0.0, 1, 0], [0, 0, 1]], (count, 1, 1)))
            for most in (2, 3, 5, 30, 600):
                frames = film.chosen_frames(run, most)
                self.assertEqual((frames[0], frames[-1]), (0, count - 1), (count, most))
                self.assertLessEqual(len(frames), most)
                self.assertTrue((np.diff(frames) > 0).all())

    def test_a_film_that_cannot_be_made_is_refused_before_the_run(self):
        filmed = ["--polygon-interval", 15, "--frames", "film.mp4", "--output", "run.h5"]
        self.refuse("clogrun", "array", *QUICK, *filmed, env={**os.environ, "PATH": str(self.folder)},
                    words=["film.mp4", "no ffmpeg", "film.gif"])
        self.assertFalse((self.folder / "run.h5").exists())

    def test_a_film_is_capped_by_an_option(self):
        self.refuse("clogrun", "array", *QUICK, "--most-frames", 3, "--output", "run.h5",
                    words=["--most-frames", "--frames"])
        filmed = [*QUICK, "--polygon-interval", 5, "--frames", "film", "--output", "run.h5"]
        self.refuse("clogrun", "array", *filmed, "--most-frames=few", words=["--most-frames=few"])
        self.succeed("clogrun", "array", *filmed, "--most-frames", 3)
        self.draw("droplet", "run.h5", "--output", "run", "--pictures", "--most-frames", 3)
        self.assertEqual(len(list((self.folder / "run-frames").iterdir())), 3)

    def numbers(self, parent, name):
        element, = parent.findall(f".//DataArray[@Name='{name}']")
        return np.array(element.text.split(), dtype=float)

    def test_a_run_is_drawn_filmed_and_exported(self):
        self.refuse("clogrun", "array", *QUICK, "--frames", "film", "--output", "run.h5",
                    words=["--frames", "--polygon-interval"])
        for name, words in [("nowhere/film", ["no folder nowhere"]), ("film/", ["names no file"])]:
            self.refuse("clogrun", "array", *QUICK, "--polygon-interval", 15, f"--frames={name}", "--output", "run.h5",
                        words=words)
        name = "film.mp4" if shutil.which("ffmpeg") else "film.gif"
        printed = self.succeed("clogrun", "array", *QUICK, "--polygon-interval", 15, "--output", "run.h5", "--frames",
                               name).stdout
        self.assertEqual(printed.splitlines()[-1], name)
        self.assertGreater((self.folder / name).stat().st_size, 1000)
        self.draw("droplet", "run.h5", "--output", "droplet")
        self.assert_picture("droplet")
        with h5py.File(self.folder / "run.h5") as file:
            polygons, times, obstacles = (file[name][:] for name in ("polygons", "polygon_times", "obstacles"))
        printed = self.draw("droplet", "run.h5", "--output", "droplet", "--pictures", "--film", "--colour",
                            "mechanism").stdout
        frames = sorted((self.folder / "droplet-frames").iterdir())
        self.assertEqual(len(frames), len(times))
        self.assertNotEqual(frames[0].read_bytes(), frames[-1].read_bytes())
        film = self.folder / printed.splitlines()[0]
        self.assertEqual(film.suffix, ".mp4" if shutil.which("ffmpeg") else ".gif")
        self.assertIn(film.read_bytes()[:8][4:] if film.suffix == ".mp4" else film.read_bytes()[:4], [b"ftyp", b"GIF8"])

        self.draw("export-vtk", "run.h5", "--output", "run")
        frames = xml.parse(self.folder / "run.pvd").findall(".//DataSet")
        self.assertEqual([float(frame.get("timestep")) for frame in frames], times.tolist())
        last = xml.parse(self.folder / frames[-1].get("file"))
        points = self.numbers(last, "Points").reshape(-1, 3)
        # The vertices come first, then the middles of the edges.
        np.testing.assert_array_equal(points[::2, :2], polygons[-1].T)
        piece, = last.findall(".//Piece")
        self.assertEqual(int(piece.get("NumberOfPoints")), len(points))
        self.assertEqual(self.numbers(last, "offsets").tolist(), [len(points)])
        self.assertEqual(self.numbers(last, "connectivity").tolist(), list(range(len(points))))
        self.assertEqual(len(self.numbers(last, "point_speed")), len(points))
        discs = xml.parse(self.folder / "run-obstacles.vtp")
        np.testing.assert_array_equal(self.numbers(discs, "diameter"), obstacles[:, 2])

    def test_a_channel_is_exported_in_numbers_that_vtk_reads(self):
        """VTK's readers stop at the first NaN."""
        self.succeed("clogrun", "channel", "vertices=32", "line-tension=0.5", "max-time=30", "--start", -1,
                     "--polygon-interval", 10, "--output", "run.h5")
        self.draw("export-vtk", "run.h5", "--output", "run")
        walls = xml.parse(self.folder / "run-obstacles.vtp")
        self.assertEqual(self.numbers(walls, "diameter").tolist(), [0, 0])
        for file in [self.folder / "run-obstacles.vtp", *(self.folder / "run-vtk").iterdir()]:
            for array in xml.parse(file).findall(".//DataArray"):
                self.assertTrue(np.isfinite(np.array(array.text.split(), dtype=float)).all(), f"{file.name}: {array.get('Name')}")


if __name__ == "__main__":
    unittest.main()
