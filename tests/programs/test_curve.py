"""Tests clogfit curve, which fits a smooth curve to the clogging lengths of a sweep. The rows have known distances."""

import csv
import io
import json
import math
import sys
import unittest

import numpy as np
import pandas

import stored_rows
from support import BIN, ROOT, SMALL, ProgramTest

sys.path.insert(0, str(ROOT / "analysis"))
import clogsweep  # noqa: E402

# Droplets of these runs can travel a hundred diameters, so a test may write any distance up to 100 into the rows.
FAR = ["max-time=1", "terminal-speed=100", "seeds=1..6"]
TENSIONS = [0.03, 0.1, 0.3, 1.0, 3.0]
LENGTHS = [0.1, 1.0, 10.0, 1.0, 0.1]  # The peak is at 0.3.
# The distances of these six runs follow the exponential law exactly.
EXPONENTIAL = -np.log(1 - (np.arange(6) + 0.5) / 6)
PEAKED = [*FAR, "line-tension=" + ",".join(map(str, TENSIONS))]


class Curve(ProgramTest):
    def sweep(self, *settings, lengths=None):
        """Makes a sweep. @param lengths  clogging lengths by line tension; all other runs keep their results"""
        given = {setting.split("=")[0] for setting in settings}
        small = [setting for setting in SMALL if setting.split("=")[0] not in given]
        table = pandas.read_hdf(self.copy_sweep("sweep.h5", *small, *settings), "runs")
        if lengths is not None:
            way = np.array([lengths[row.line_tension] * EXPONENTIAL[row.seed - 1] for row in table.itertuples()])
            stored_rows.change_columns(self.folder / "sweep.h5", distance=way,
                                       status=np.array([b"clogged"] * len(table)),
                                       clogged_by=np.array([b"certified"] * len(table)),
                                       failed_by=np.array([b"none"] * len(table)),
                                       mechanism=np.array([b"wrapped"] * len(table)))
        return table

    def curve(self, *arguments):
        return json.loads(self.succeed("clogfit", "curve", "sweep.h5", *arguments, "--format", "json").stdout)

    def test_it_goes_through_the_points_and_finds_peak_and_crossings(self):
        self.sweep(*PEAKED, lengths=dict(zip(TENSIONS, LENGTHS)))
        printed = self.curve("--crossing=0.5")
        self.assertEqual(printed["keys"], ["line_tension"])
        self.assertEqual(printed["units"]["clogging_length"], "sigma")
        curve, = printed["curves"]
        self.assertEqual([point["clogs"] for point in curve["points"]], [6] * 5)
        self.assertEqual(len(curve["curve"]), 97)
        for place in curve["curve"]:
            self.assertLess(place["clogging_length_lower"], place["clogging_length"])
            self.assertLess(place["clogging_length"], place["clogging_length_upper"])
            self.assertAlmostEqual(place["clogging_length_wrapped"], place["clogging_length"], places=9)
        at_points = {place["line_tension"]: place for place in curve["curve"]}
        for tension, length in zip(TENSIONS, LENGTHS):
            nearest = at_points[min(at_points, key=lambda other: abs(math.log(other / tension)))]
            self.assertLess(abs(math.log(nearest["clogging_length"] / length)), 0.6)
        peak = curve["peak"]
        self.assertLess(peak["line_tension_lower"], 0.3)
        self.assertGreater(peak["line_tension_upper"], 0.3)
        self.assertLess(peak["clogging_length_lower"], 10)
        self.assertGreater(peak["clogging_length_upper"], 10)
        self.assertGreater(peak["probability_between_borders"], 0.99)
        up, down = curve["crossings"]
        self.assertEqual((up["direction"], down["direction"]), ("upwards", "downwards"))
        self.assertLess(up["line_tension_lower"], up["line_tension"])
        self.assertTrue(0.03 < up["line_tension"] < 0.1 and 1 < down["line_tension"] < 3)

    def test_a_sweep_may_have_the_name_of_a_command(self):
        self.sweep(*PEAKED, lengths=dict(zip(TENSIONS, LENGTHS)))
        printed = self.succeed("clogfit", "curve", "sweep.h5").stdout
        for name in ("curve", "units"):  # a command in Python, and one in C++
            (self.folder / name).write_bytes((self.folder / "sweep.h5").read_bytes())
            self.assertEqual(self.succeed("clogfit", "curve", f"./{name}").stdout, printed)

    def test_text_and_csv_say_the_same(self):
        self.sweep(*PEAKED, lengths=dict(zip(TENSIONS, LENGTHS)))
        text = self.succeed("clogfit", "curve", "sweep.h5", "--crossing=0.5,1e5").stdout
        for words in ("fitted; 95 % intervals", "through 5 points with 30 clogs", "highest at line_tension",
                      "crosses 0.5 sigma upwards", "does not cross 100000 sigma", "lambda/sigma"):
            self.assertIn(words, text)
        lines = list(csv.DictReader(io.StringIO(self.succeed("clogfit", "curve", "sweep.h5", "--format=csv").stdout)))
        curve, = self.curve()["curves"]
        self.assertEqual([float(line["clogging_length"]) for line in lines],
                         [place["clogging_length"] for place in curve["curve"]])
        self.assertTrue(all(line["clogging_length_squeezed"] == "" for line in lines))

    def test_the_table_of_peaks_has_none_where_a_curve_only_rises(self):
        command = ("clogfit", "curve", "sweep.h5", "--key=line-tension", "--format=peaks")
        self.sweep(*PEAKED, lengths=dict(zip(TENSIONS, LENGTHS)))
        (peak,), found = csv.DictReader(io.StringIO(self.succeed(*command).stdout)), self.curve()["curves"][0]["peak"]
        self.assertEqual({name: peak[name] for name in list(peak)[:-1]},
                         {name: f"{found[name]:.3g}" for name in list(peak)[:-1]})
        self.sweep(FAR[0], FAR[2], "line-tension=0.1,0.3,1,3", "terminal-speed=50,100",
                   lengths={0.1: 1.0, 0.3: 3.0, 1.0: 10.0, 3.0: 30.0})
        self.assertEqual([line["line_tension"] for line in csv.DictReader(io.StringIO(self.succeed(*command).stdout))],
                         ["none", "none"])

    def test_a_peak_at_a_border_is_not_named_as_a_peak(self):
        self.sweep(*PEAKED, lengths=dict(zip(TENSIONS, LENGTHS)))
        self.assertNotIn("no peak", self.succeed("clogfit", "curve", "sweep.h5").stdout)
        for lengths, word in ((LENGTHS[0], "largest"), (LENGTHS[-1], "smallest")):
            rising = [lengths * (10 * i + 1) for i in range(5)]
            self.sweep(*PEAKED, lengths=dict(zip(TENSIONS, rising if word == "largest" else rising[::-1])))
            text = self.succeed("clogfit", "curve", "sweep.h5").stdout
            self.assertRegex(text, rf"\nno peak is known: highest at the {word} line_tension of these points, line_")
            self.assertRegex(text, r"probability of \d+ % it is higher at a border than anywhere between")

    def test_a_wider_confidence_has_a_wider_band(self):
        self.sweep(*PEAKED, lengths=dict(zip(TENSIONS, LENGTHS)))
        narrow, wide = (self.curve(f"--confidence={confidence}")["curves"][0]["curve"][40]
                        for confidence in (0.5, 0.99))
        self.assertGreater(wide["clogging_length_upper"], narrow["clogging_length_upper"])
        self.assertAlmostEqual(wide["clogging_length"], narrow["clogging_length"], places=9)

    def test_other_keys_tell_curves_apart_and_two_keys_make_a_surface(self):
        self.sweep(FAR[0], FAR[2], "line-tension=0.1,0.3,1,3", "terminal-speed=50,100",
                   lengths={0.1: 1.0, 0.3: 3.0, 1.0: 10.0, 3.0: 30.0})
        self.refuse("clogfit", "curve", "sweep.h5", words=["--key", "line-tension", "terminal-speed"])
        printed = self.curve("--key=line-tension")
        self.assertEqual([curve["shared"]["terminal_speed"] for curve in printed["curves"]], [50, 100])
        surface, = self.curve("--key=line-tension,terminal-speed")["curves"]
        self.assertEqual(len(surface["curve"]), 25 * 25)
        self.assertEqual(len(surface["points"]), 8)
        self.assertIn("terminal_speed_upper", surface["peak"])

    def test_points_without_a_clog_are_bounds_that_inform_it(self):
        self.sweep(*PEAKED, lengths=dict(zip(TENSIONS, LENGTHS)))
        before = self.curve()["curves"][0]["peak"]["clogging_length"]

        def not_clogged(rows):
            of_peak = rows["line_tension"] == 0.3
            rows["status"][of_peak], rows["clogged_by"][of_peak], rows["mechanism"][of_peak] = b"flowing", b"none", b"none"
            rows["distance"][of_peak] = 90

        stored_rows.change(self.folder / "sweep.h5", not_clogged)
        point = self.curve()["curves"][0]["points"][2]
        self.assertEqual((point["clogs"], point["clogging_length"]), (0, None))
        self.assertGreater(self.curve()["curves"][0]["peak"]["clogging_length"], 3 * before)

    def test_the_module_gives_and_draws_it(self):
        self.sweep(*PEAKED, lengths=dict(zip(TENSIONS, LENGTHS)))
        sweep = clogsweep.open(self.folder / "sweep.h5", programs=BIN)
        printed = sweep.fitted_curves("line_tension", crossing=[0.5])
        self.assertEqual(len(printed["curves"][0]["crossings"]), 2)
        axes = sweep.fit().curve().figure.axes[0]
        fitted, = (line for line in axes.lines if line.get_label().startswith("_fitted"))
        self.assertEqual(len(fitted.get_xdata()), 97)
        notes = "\n".join(text.get_text() for text in axes.figure.findobj() if hasattr(text, "get_text"))
        self.assertIn("fitted curves, with 95 % bands", notes)
        self.assertIn("points of a curve share seeds and so obstacles: their errors are correlated", notes)

    def test_bounds_alone_draw_no_curve(self):
        self.sweep(*PEAKED, lengths=dict(zip(TENSIONS, LENGTHS)))

        def clogged_at_two(rows):
            others = ~np.isin(rows["line_tension"], TENSIONS[:2])
            rows["status"][others], rows["clogged_by"][others], rows["mechanism"][others] = b"flowing", b"none", b"none"

        stored_rows.change(self.folder / "sweep.h5", clogged_at_two)
        axes = clogsweep.open(self.folder / "sweep.h5", programs=BIN).fit().curve().figure.axes[0]
        self.assertFalse([line for line in axes.lines if line.get_label().startswith("_fitted")])

    def test_it_says_where_points_share_obstacles(self):
        words = "points share seeds and so obstacles"
        tensions = {0.1: 1.0, 0.3: 3.0, 1.0: 10.0, 3.0: 30.0}
        self.sweep(FAR[0], FAR[2], "line-tension=0.1,0.3,1,3", "obstacle-gap=0.4,0.5", lengths=tensions)
        self.assertEqual([curve["common_obstacles"] for curve in self.curve("--key=line-tension")["curves"]],
                         [True, True])
        self.assertIn(words, self.succeed("clogfit", "curve", "sweep.h5", "--key=line-tension").stdout)
        # Keys that change the array, and points with different seeds, are tested in test_fitted_curves.py.

    def test_densities_are_printed_as_they_are_and_shares_as_shares(self):
        one_length = {1.0: 1.0}
        gaps = "obstacle-gap=0.3,0.4,0.5,0.6"
        several = ["line-tension=1", *FAR, "obstacle-density=20%,40%"]
        self.sweep(*several, gaps, lengths=one_length)
        self.assertEqual([curve["shared"] for curve in self.curve("--key=obstacle-gap")["curves"]],
                         [{"share_of_saturated": 0.2}, {"share_of_saturated": 0.4}])
        self.sweep(*several, "obstacle-diameter-spread=0.1,0.2,0.3,0.4", lengths=one_length)
        self.assertEqual([curve["shared"] for curve in self.curve("--key=obstacle-diameter-spread")["curves"]],
                         [{"share_of_saturated": 0.2}, {"share_of_saturated": 0.4}])
        tensions = dict.fromkeys((0.1, 0.3, 1.0, 3.0), 1.0)
        rows = self.sweep("line-tension=0.1,0.3,1,3", *FAR, "obstacle-density=20%,40%", lengths=tensions)
        curves = self.curve("--key=line-tension")["curves"]
        self.assertEqual([curve["shared"] for curve in curves],
                         [{"obstacle_density": density} for density in sorted(set(rows.obstacle_density))])
        rows = self.sweep("line-tension=0.1,0.3,1,3", *FAR, "obstacle-density=20%", "obstacle-gap=0.3,0.4",
                          lengths=tensions)
        self.assertEqual([curve["shared"] for curve in self.curve("--key=line-tension")["curves"]],
                         [{"obstacle_gap": 0.3}, {"obstacle_gap": 0.4}])
        # If all gaps have the same densities, these are not shares of the saturated density.
        rows = self.sweep("line-tension=1", *FAR, gaps, "obstacle-density=0.1,0.2", lengths=one_length)
        self.assertEqual([curve["shared"] for curve in self.curve("--key=obstacle-gap")["curves"]],
                         [{"obstacle_density": 0.1}, {"obstacle_density": 0.2}])

    def test_points_give_the_curves_of_the_same_sweep(self):
        self.sweep("line-tension=1", *FAR, "obstacle-density=20%", "obstacle-gap=0.3,0.4,0.5,0.6", lengths={1.0: 1.0})
        expected = self.curve()["curves"]
        self.write("points.csv",
                   "obstacle-gap,obstacle-density\n" + "".join(f"{gap},20%\n" for gap in (0.3, 0.4, 0.5, 0.6)))
        self.succeed("clogsweep", "vertices=64", "box=20", "line-tension=1", *FAR, "--points", "points.csv", "--output",
                     "points.h5")
        rows = pandas.read_hdf(self.folder / "points.h5", "runs")
        stored_rows.change_columns(self.folder / "points.h5", distance=[EXPONENTIAL[seed - 1] for seed in rows.seed],
                                   status=np.array([b"clogged"] * len(rows)), clogged_by=b"certified",
                                   mechanism=b"wrapped")
        (self.folder / "points.h5").replace(self.folder / "sweep.h5")
        self.assertEqual(self.curve("--key=obstacle-gap")["curves"], expected)

    def test_several_files_are_one_sweep(self):
        self.sweep(*PEAKED, lengths=dict(zip(TENSIONS, LENGTHS)))
        whole = self.curve()["curves"]
        names = []
        for tensions in ("<=0.1", ">0.1"):
            names.append(f"part{len(names)}.h5")
            self.succeed("clogsweep", "select", "sweep.h5", f"line_tension{tensions}", "--output", names[-1])
        printed = json.loads(self.succeed("clogfit", "curve", *names, "--format", "json").stdout)
        # The last digits are excluded, because they may depend on the number of BLAS threads.
        one, other = (json.loads(json.dumps(curves), parse_float=lambda number: float(f"{float(number):.8g}"))
                      for curves in (printed["curves"], whole))
        self.assertEqual(one, other)
        self.refuse("clogfit", "curve", "sweep.h5", "no.h5", words=["no.h5"])

    def test_mistakes_get_one_line_and_exit_code_2(self):
        self.sweep(*FAR, "line-tension=0.1,1", "preset=elastic", "friction=0,0.2")
        self.write("empty.h5", "")
        for arguments, words in [
            ([], ["missing sweep file"]),
            (["empty.h5"], ["empty.h5"]),
            (["no.h5"], ["no.h5"]),
            (["sweep.h5", "--key=friction"], ["friction", "0", "logarithm"]),
            (["sweep.h5", "--key=vertices"], ["--key=vertices"]),
            (["sweep.h5", "--key=line-tensoin"], ["line-tension"]),
            (["sweep.h5", "--key=obstacle-gap"], ["--key=obstacle-gap", "same value"]),
            (["sweep.h5", "--key=line-tension,line-tension"], ["--key"]),
            (["sweep.h5", "--key=line-tension", "--crossing=-1"], ["--crossing=-1"]),
            (["sweep.h5", "--key=line-tension", "--crossing=10sigma"], ["--crossing=10sigma"]),
            (["sweep.h5", "--key=line-tension", "--confidence=2"], ["--confidence=2"]),
            (["sweep.h5", "--key=line-tension", "--format=xml"], ["--format=xml"]),
        ]:
            with self.subTest(arguments=arguments):
                self.refuse("clogfit", "curve", *arguments, words=words)


if __name__ == "__main__":
    unittest.main()
