"""Tests the commands of the Python module, and the texts of their pictures and pages."""

import json
import math
import os
import unittest
import unittest.mock
from types import SimpleNamespace

import numpy as np
from PIL import Image
from matplotlib.text import Text

from drawing import Analysis
from support import BIN, FEW, QUICK, SMALL, shared_sweep, table

import stored_rows
from clogsweep import labels, style
from clogsweep.drawing import clogs, dwell, film, lengths, way
from clogsweep.pages import poster, report
from clogsweep.paper import panels
from clogsweep.reading import stored, trajectory
from clogsweep.tools import rounded
from clogsweep.tools.errors import UserError
from clogsweep.labels.groups import Groups
from clogsweep.results.sweep import Sweep

ONE_CURVE = [*QUICK, "line-tension=0.5,3", "seeds=1..2", "near-wall-drag=0.07", "obstacle-gap=0.35", "terminal-speed=0.032"]


class Calls(Analysis):
    COMMANDS = ["clogging-length", "clogs", "critical-angle", "droplet", "dwell", "export-vtk", "poster", "report", "survival"]

    def needs(self, command):
        return [] if command in ("droplet", "export-vtk") else ["--programs", BIN]

    def test_a_run_is_no_sweep_and_a_sweep_no_run(self):
        self.copy_sweep("run.h5", "array", *QUICK, "--polygon-interval", 10, program="clogrun")
        self.copy_sweep("s.h5", *FEW)
        for command in self.COMMANDS:
            is_of_runs = not self.needs(command)
            with self.subTest(command=command):
                self.refuse_analysis(command, "s.h5" if is_of_runs else "run.h5", "--output", "x", *self.needs(command),
                                     words=["cannot read", "output of clogrun" if is_of_runs else "clogsweep"])
        self.refuse_analysis("clogs", "run.h5", *self.needs("clogs"),
                             words=["run.h5 (holds one run of clogrun, not a sweep)"])

    def test_a_file_that_is_not_there_is_called_so(self):
        for command in self.COMMANDS:
            with self.subTest(command=command):
                self.refuse_analysis(command, "nope.h5", "--output", "x", *self.needs(command),
                                     words=["cannot read nope.h5 (no such file); check the name"])

    def test_critical_angles_are_those_of_rigid_disks_and_drawn_from_the_table_too(self):
        # A rigid disk follows the rows up to the angle t with sin t = (sigma + sigma_ob)/(2 a) = 1/3 (Frechette and
        # Drazer 2009).
        self.succeed("clogsweep", "obstacle-layout=lattice", "lattice=square,triangular", "pitch=3",
                     "obstacle-diameter=1", "line-tension=1,3", "terminal-speed=0.1", "vertices=64", "box=200",
                     "max-time=1000", "seeds=1", "lattice-angle=15,18.5,20.7,25", "--output", "s.h5")
        printed = self.draw("critical-angle", "s.h5", "--format", "csv", "--programs", BIN).stdout
        lines = [line.split(",") for line in printed.splitlines()]
        self.assertEqual(lines[0], ["line_tension", "obstacle_filling", "lower", "upper", "runs"])
        self.assertEqual([line[:2] for line in lines[1:]],
                         [[tension, kind] for tension in "13" for kind in ("lattice", "triangular")])
        for line in lines[1:]:
            self.assertTrue(18 < float(line[2]) < 19.47 < float(line[3]) < 21.1, line)
        self.write("angles.csv", "# by hand\n" + printed)
        for source, output in (("s.h5", "one"), ("angles.csv", "two")):
            self.draw("critical-angle", source, "--output", output, "--programs", BIN)
            self.assert_picture(output)
        self.assertEqual(*(Image.open(self.folder / f"{name}.png").tobytes() for name in ("one", "two")))
        self.write("bounds.csv", "line_tension,lower,upper,runs\n1,20,,3\n2,21,,3\n")
        self.draw("critical-angle", "bounds.csv", "--programs", BIN)
        for text in ("", "a,b\n1,2\n", "lower,upper,runs\nx,y,z\n", "lower,upper,runs,colour\n1,2,3,4\n", "\0\xff",
                     "lower,upper,runs\n1,2,3\n"):
            self.write("rubbish.csv", text)
            self.refuse_analysis("critical-angle", "rubbish.csv", "--programs", BIN, words=["cannot"])

    def test_critical_angles_of_negative_angles_are_those_of_their_mirror_images(self):
        keys = ["obstacle-layout=lattice", "pitch=3", "obstacle-diameter=1", "line-tension=3", "terminal-speed=0.1", "vertices=64", "box=200", "max-time=1000", "seeds=1"]
        for name, angles in [("negative", "-15,-18.5,-20.7,-25"), ("both", "-15,18.5,-20.7,25")]:
            self.succeed("clogsweep", *keys, f"lattice-angle={angles}", "--output", f"{name}.h5")
            printed = self.draw("critical-angle", f"{name}.h5", "--format", "csv", "--programs", BIN).stdout
            lower, upper, runs = map(float, printed.splitlines()[1].split(","))
            # The critical angle of a rigid disk is arcsin(1/3).
            self.assertTrue(18 < lower < math.degrees(math.asin(1 / 3)) < upper < 21.1 and runs == 4, printed)

    def test_a_run_that_is_too_short_does_not_count_for_a_critical_angle(self):
        # After 30 t0 the droplet has moved by at most 3 diameters. On a straight path it would have crossed no row.
        self.succeed("clogsweep", "obstacle-layout=lattice", "pitch=3", "obstacle-diameter=1", "terminal-speed=0.1",
                     "vertices=64", "box=200", "max-time=30,1000", "seeds=1", "lattice-angle=15,25", "--output", "s.h5")
        printed = self.draw("critical-angle", "s.h5", "--format", "csv", "--programs", BIN).stdout
        self.assertEqual([line.split(",")[-1] for line in printed.splitlines()], ["runs", "0", "2"])

    def test_an_output_may_be_left_out_or_have_its_ending(self):
        self.copy_sweep("s.h5", *FEW)
        for command, made, *options in [("clogging-length", "s-clogging-length.png"),
                                        ("clogs", "s-clogs.png", "--most", 1), ("dwell", "s-dwell.png"),
                                        ("poster", "s-poster.png"), ("report", "s-report.html", "--examples", 0)]:
            self.assertIn(made, self.draw(command, "s.h5", "--programs", BIN, *options).stdout)
            self.assertTrue((self.folder / made).exists())
        for name in ("cl.png", "cl.pdf", "cl0.2"):
            self.draw("clogging-length", "s.h5", "-o", name, "--programs", BIN)
        self.assertEqual({path.name for path in self.folder.glob("cl*")},
                         {"cl.png", "cl.pdf", "cl0.2.png", "cl0.2.pdf"})
        self.refuse_analysis("clogging-length", "/dev/null", words=["no name", "--output"])

    def test_a_name_of_a_film_asks_for_one(self):
        self.copy_sweep("run.h5", "array", *QUICK, "--polygon-interval", 10, program="clogrun")
        self.assertEqual(self.draw("droplet", "run.h5", "-o", "run.gif").stdout, "run.gif\n")
        self.assertEqual((self.folder / "run.gif").read_bytes()[:4], b"GIF8")

    def test_earlier_pictures_of_a_longer_run_do_not_stay_between_those_of_a_film(self):
        self.copy_sweep("run.h5", "array", *QUICK, "--polygon-interval", 10, program="clogrun")
        for most in (4, 2):
            self.draw("droplet", "run.h5", "-o", "run", "--pictures", "--most-frames", most)
            self.assertEqual(len(list((self.folder / "run-frames").iterdir())), most)

    def test_invalid_numbers_and_missing_clogs_get_one_line(self):
        self.succeed("clogsweep", *QUICK, "line-tension=3", "seeds=1", "--output", "s.h5")
        self.succeed("clogsweep", "model=sp", "wall-stiffness=30", "box=20", "max-time=60", "seeds=1", "--output", "disk.h5")
        for arguments, words in [
            (["clogs", "s.h5", "--jobs", "0"], ["--jobs", "1 or more"]),
            (["clogs", "s.h5", "--most", "few"], ["--most", "whole number"]),
            (["clogs", "s.h5", "--tasks", "1-3"], ["--tasks", "1-3", "try 3,17,40"]),
            (["clogs", "s.h5", "--tasks", "7,0"], ["tasks 7:", "no such clogged polygon"]),
            (["clogs", "s.h5", "--mechanism", "wrapped"], ["mechanism wrapped", "no such clogged polygon"]),
            (["clogs",
              "disk.h5"], ["disk.h5 holds no clogged polygon", "soft disks", "longer max-time into another file"]),
            (["droplet", "s.h5", "-o", "x", "--size", "7p"], ["--size", "7p", "1080p"]),
            (["droplet", "s.h5", "-o", "x", "--rate", "0"], ["--rate", "1 or more"]),
            (["figures", "2", "--ranks", "0"], ["--ranks", "1 or more"]),
            (["figures", "2", "--profile", "none.csv"], ["cannot read none.csv (no such file); check the name"]),
        ]:
            with self.subTest(arguments=arguments):
                where = ["--programs", BIN] if arguments[0] != "droplet" else []
                self.refuse_analysis(*arguments, *where, words=words)

    def test_the_colour_of_obstacles_is_the_one_in_the_help(self):
        self.assertIn("obstacles are blue", " ".join(self.draw("clogs", "--help").stdout.split()))


class Looks(Analysis):
    def fit(self, *keys):
        self.copy_sweep("s.h5", *keys)
        return Groups(json.loads(self.succeed("clogfit", "s.h5", "--format", "json").stdout))

    def assert_title_is_whole(self, drawing):
        drawing.canvas.draw()
        page = drawing.bbox
        for axes in drawing.axes:
            title = axes.title.get_window_extent()
            self.assertTrue(page.x0 < title.x0 and title.x1 < page.x1 and title.y1 < page.y1, axes.get_title())
            for text in axes.texts:
                if text.get_gid() == style.NOTES:
                    notes = text.get_window_extent()
                    self.assertTrue(page.x0 < notes.x0 and notes.x1 < page.x1 and page.y0 < notes.y0, text.get_text())
                    self.assertLess(notes.y1, axes.xaxis.label.get_window_extent().y0)

    def test_one_curve_has_its_whole_title_the_interface_and_room_at_the_frame(self):
        groups = self.fit(*ONE_CURVE)
        for drawing in (style.figure_of(lengths.draw_on, groups), style.figure_of(lengths.draw_speeds_on, groups),
                        style.figure_of(report.draw_survival, groups, "", groups.members)):
            self.assert_title_is_whole(drawing)
            self.assertIn("2 runs per point", drawing.axes[0].get_title())
        # The stiffer droplets clog at once, so their speed is unknown.
        for group, speed in zip(groups.members, (0.4, None)):
            group.update(relative_speed=speed, relative_speed_error=0.1)
        drawing = style.figure_of(lengths.draw_speeds_on, groups)
        axes = drawing.axes[0]
        self.assertIn("preset robust", axes.get_title())
        low, high = axes.get_xlim()
        self.assertTrue(low < 0.5 and high > 3, (low, high))

    def test_two_presets_in_one_picture_have_a_curve_each(self):
        # K_l is a given number in robust. In elastic it follows from the line tension.
        self.succeed("clogsweep", *SMALL, "line-tension=0.3,1", "seeds=1..2", "--output", "robust.h5")
        self.succeed("clogsweep", *SMALL, "line-tension=0.3,1", "seeds=1..2", "preset=elastic", "friction=0.05",
                     "--output", "elastic.h5")
        groups = Groups(json.loads(self.succeed("clogfit", "robust.h5", "elastic.h5", "--format", "json").stdout))
        self.assertEqual(groups.curve_parameters(), ["friction", "preset"])

    def test_lengths_over_the_time_that_counts_as_clogged_are_those_of_clogfit(self):
        self.succeed("clogsweep", *SMALL, "line-tension=0.03,0.3", "max-time=400", "seeds=1..8", "--output", "s.h5")
        times = dwell.times_of(self.fit_at())
        self.assertEqual(len(times), 12)
        self.assertEqual((times[0], times[-1]),
                         (stored.read_rows(self.folder / "s.h5")["dwells_known_from"].max(), 400))
        fits = [self.fit_at("--dwell", repr(time)) for time in times]
        drawing = dwell.draw(times, fits)
        self.assert_title_is_whole(drawing)
        axes, = drawing.axes
        self.assertIn("moved by $0.05", axes.get_xlabel())
        self.assertEqual([curve.get_label() for curve in axes.containers], [r"$\Gamma = 0.03$", r"$\Gamma = 0.3$"])
        soft, stiff = axes.containers
        # No soft droplet rests, so arrows show the lower bounds.
        self.assertTrue(np.isnan(soft.lines[0].get_xydata()[:, 1]).all())
        bounds, = [line for line in axes.lines if line.get_marker() is style.LOWER_BOUND and len(line.get_xdata()) > 0]
        places, lengths = stiff.lines[0].get_xydata().T
        np.testing.assert_allclose(places, times, rtol=0.03)
        bars = [segment[:, 1] for segment in stiff.lines[2][0].get_segments()]
        for i, time in enumerate(times):
            bound, group = self.fit_at("--dwell", repr(time)).members
            self.assertEqual((bound["clogs"], bounds.get_ydata()[i]), (0, bound["clogging_length_lower"]))
            self.assertEqual(lengths[i], group["clogging_length"])
            np.testing.assert_allclose(bars[i], [group["clogging_length_lower"], group["clogging_length_upper"]])
        self.assertEqual(lengths[-1], self.fit_at().members[1]["clogging_length"])
        self.assertLess(lengths[0], 0.7 * lengths[-1])
        self.draw("dwell", "s.h5", "-o", "d", "--programs", BIN)
        self.assert_picture("d")

    def fit_at(self, *options):
        return Groups(json.loads(self.succeed("clogfit", "s.h5", "--format", "json", *options).stdout))

    def test_dwells_that_cannot_be_drawn_are_refused(self):
        self.succeed("clogsweep", *SMALL, "seeds=1", "max-time=10", "--output", "s.h5")
        self.refuse_analysis("dwell", "s.h5", "--programs", BIN, words=["from 16.67 t0 on", "make max-time longer"])
        dwells = [name for name in stored_rows.columns(self.folder / "s.h5") if "dwell" in name and name != "dwell_length"]
        stored_rows.change_columns(self.folder / "s.h5", **dict.fromkeys(dwells, np.nan))
        self.refuse_analysis("dwell", "s.h5", "--programs", BIN,
                             words=["did not look for them", "compute the sweep anew"])

    def test_many_curves_are_distinguished_beside_the_legend_and_off_the_frame(self):
        arrays = ["obstacle-gap=lin(0.2,0.35,4)", "obstacle-diameter=lin(0.3,0.45,4)"]
        for tensions in ("line-tension=6,8", "line-tension=3,3.3,9"):
            groups = self.fit(*QUICK, tensions, *arrays, "seeds=1")
            for group in groups.members:
                group.update(relative_speed=0.4, relative_speed_error=0.1)
            for drawing in (style.figure_of(lengths.draw_on, groups), style.figure_of(lengths.draw_speeds_on, groups)):
                self.assert_title_is_whole(drawing)
                axes, = drawing.axes
                legend, frame = axes.get_legend().get_window_extent(), axes.get_window_extent()
                self.assertLess(frame.x1, legend.x0)
                self.assertTrue(legend.x1 < drawing.bbox.x1 and legend.y0 > drawing.bbox.y0
                                and legend.y1 <= frame.y1 + 1)
                self.assertGreater(frame.width, 0.6 * 6.4 * drawing.dpi)
                lines = [bars.lines[0] for bars in axes.containers]
                self.assertEqual(len({(line.get_color(), str(line._dash_pattern)) for line in lines}), 16)
                for line in axes.lines:
                    for x, _ in axes.transData.transform(line.get_xydata()):
                        self.assertTrue(frame.x0 + 4 < x < frame.x1 - 4 or np.isnan(x), (frame, x))

    def test_long_captions_of_panels_are_wrapped_between_phrases(self):
        drawing, panels = style.subplots(1, 2, figsize=(7, 3))
        phrases = [rf"$\sigma_\mathrm{{ob}}/\sigma = {number}$" for number in range(9)]
        for axes in panels:
            style.caption(axes, ", ".join(phrases) + "\nsecond line")
            lines = axes.get_title().split("\n")
            self.assertGreater(len(lines), 2)
            self.assertEqual(" ".join(lines[:-1]).split(", "), phrases)
            self.assertEqual(lines[-1], "second line")
        self.assert_title_is_whole(drawing)

    def test_p_of_r_goes_to_the_longest_way_in_a_report_too(self):
        steps = [{"distance": 2.0, "probability": 0.75, "lower": 0.1, "upper": 0.9}]
        groups = self.fit(*QUICK, "line-tension=0.1,0.3", "seeds=1")
        for group, ways in zip(groups.members, ({"clogging_length": None, "survival": [], "censored_distances": [40.0]},
                                                {"clogging_length": 8.0, "survival": steps, "censored_distances": [3.0, 9.0]})):
            group.update(ways)
        drawing = style.figure_of(report.draw_survival, groups, "two", groups.members)
        curves = [line.get_xydata() for line in drawing.axes[0].lines if line.get_drawstyle() == "steps-post"]
        self.assertEqual([curve[-1].tolist() for curve in curves], [[40, 1], [9, 0.75]])
        self.assertTrue(all(curve[0, 0] > 0 and curve[0, 1] == 1 for curve in curves), "it begins where the scale does")
        ticks = [line.get_xydata().tolist() for line in drawing.axes[0].lines if line.get_marker() == "|"]
        self.assertEqual(ticks, [[[40, 1]], [[3, 0.75], [9, 0.75]]])

    def test_automatic_values_are_no_abscissa_beside_a_parameter_that_was_varied(self):
        for name, rows, abscissa, note in [
                ("gaps", "dp,1,,0.3,32\ndp,2,,0.4,32\nsp,,10,0.3,\nsp,,10,0.4,\n", "obstacle_gap", []),
                ("gap", "dp,1,,0.3,32\ndp,2,,0.3,32\nsp,,10,0.3,\n", "wall_stiffness", ["automatic: the wall stiffness of 2 of 3 points follows from other parameters"])]:
            self.write("p.csv", f"model,line-tension,wall-stiffness,obstacle-gap,vertices\n{rows}")
            self.succeed("clogsweep", "--points", "p.csv", "box=20", "max-time=1", "seeds=1", "--output", f"{name}.h5")
            groups = Sweep(self.folder / f"{name}.h5", BIN).fit().known
            self.assertEqual(groups.abscissa, abscissa)
            self.assertEqual(lengths.automatic_notes(groups), note)

    def test_clogs_of_arrays_are_drawn_beside_rows_of_channels_and_walls(self):
        self.write("kinds.csv", "obstacle-layout,obstacle-gap,obstacle-density,box,max-time\nwall,,,,1000\nrandom,0.3,saturated,20,60\n")
        self.succeed("clogsweep", "--points", "kinds.csv", "line-tension=3", "vertices=64", "seeds=1", "--output", "s.h5")
        self.assertEqual(table(self.folder / "s.h5").status.tolist(), 2 * ["clogged"])
        self.assertIn("left out: 1 clog in a channel or on a wall",
                      self.draw("clogs", "s.h5", "--programs", BIN).stderr)
        self.assert_picture("s-clogs")

    def test_a_run_of_several_laboratories_is_drawn_once(self):
        self.write("lab.cfg", "diameter = 0.8 mm\nangle = 20 deg, 45 deg\nspeed = 1 mm/s\ntension = 2 mN/m\n")
        self.succeed("clogsweep", "--lab", "lab.cfg", "line-tension=3", "terminal-speed=0.03", "obstacle-gap=0.3sigma",
                     "obstacle-density=saturated", "box=20sigma", "vertices=64", "max-time=60", "seeds=1..2",
                     "--output", "s.h5")
        rows = clogs.of_polygons(stored.read_rows(self.folder / "s.h5", BIN), "s.h5")
        drawn = clogs.chosen(rows, "s.h5", mechanism=None, tasks=None, most=12)
        self.assertEqual((len(rows), len(drawn)), (4, 2))
        self.assertEqual({row["seed"] for row in drawn}, {1, 2})
        self.assertEqual(len(clogs.chosen(rows, "s.h5", mechanism=None, tasks=[row["task"] for row in rows], most=1)), 4)

    def test_a_complete_sweep_without_clogs_is_not_to_be_resumed(self):
        self.succeed("clogsweep", *SMALL, "line-tension=1", "max-time=1", "seeds=1", "--output", "s.h5")
        done = self.analyse("clogs", "s.h5", "--programs", BIN)
        self.assertEqual(done.returncode, 2)
        self.assertIn("no clogged polygon", done.stderr)
        self.assertNotIn("resume", done.stderr)

    def test_a_soft_disk_can_be_seen(self):
        self.succeed("clogrun", "array", "model=sp", "wall-stiffness=1", "box=20", "max-time=30", "--polygon-interval",
                     10, "--output", "run.h5")
        run = trajectory.read(self.folder / "run.h5")
        size = run.polygons.max(axis=2) - run.polygons.min(axis=2)
        np.testing.assert_allclose(size, 1, atol=1e-3)
        for command, made in [("droplet", "disk.png"), ("export-vtk", "disk.pvd")]:
            self.draw(command, "run.h5", "-o", "disk")
            self.assertTrue((self.folder / made).exists())

    def test_arrays_channels_and_walls_share_no_picture_but_their_rows_and_fits_are_there(self):
        self.write("kinds.csv", "obstacle-layout,orifice,obstacle-gap,box,seeds\nwall,,,,1\nchannel,0.8,,,1\nrandom,,0.3,20,1..2\n")
        self.succeed("clogsweep", "--points", "kinds.csv", "line-tension=1", "vertices=32", "max-time=60", "--output", "s.h5")
        for command in ("clogging-length", "survival", "dwell", "report", "poster"):
            self.refuse_analysis(command, "s.h5", "--programs", BIN, words=["arrays", "channels", "a flat wall", "clogsweep select FILE obstacle_filling=density"])
        self.succeed("clogsweep", "select", "s.h5", "obstacle_filling=density", "--output", "arrays.h5")
        self.draw("survival", "arrays.h5", "--programs", BIN)
        sweep = Sweep(self.folder / "s.h5", BIN)
        self.assertEqual(len(sweep.fit().groups), 3)
        self.assertLessEqual({"runs", "sag"}, set(sweep.fit().summary))
        self.draw("export", "s.h5", "rows.csv", "--programs", BIN)

    def test_two_models_share_a_picture_over_what_both_have(self):
        self.write("models.csv", "model,wall-stiffness,obstacle-gap\nsp,2,0.3\nsp,4,0.4\ndp,,0.3\n")
        self.succeed("clogsweep", "--points", "models.csv", "box=20", "boxes=2", "max-time=60", "seeds=1..2",
                     "--output", "s.h5")
        for command in ("clogging-length", "survival", "dwell", "report", "poster"):
            self.draw(command, "s.h5", "--programs", BIN)
        groups = Groups(json.loads(self.succeed("clogfit", "s.h5", "--format", "json").stdout))
        self.assertEqual([label.split(",")[0] for label, _ in groups.curves()], ["model dp", "model sp", "model sp"])
        self.assertNotIn("no ", " ".join(label for label, _ in groups.curves()),
                         "parameters that a model lacks are not named")
        self.assertIn("deformable polygon and soft disk", groups.caption())

    def test_only_the_density_of_a_saturated_array_is_called_saturated(self):
        self.write("arrays.csv", "obstacle-layout,lattice-angle,obstacle-gap\nlattice,0,0.5\nrandom,,0.4\n")
        self.succeed("clogsweep", "--points", "arrays.csv", "vertices=32", "box=20", "max-time=30", "seeds=1..2",
                     "--output", "s.h5")
        groups = Groups(json.loads(self.succeed("clogfit", "s.h5", "--format", "json").stdout))
        self.assertEqual(groups.parameter_label("lattice_angle", None), "no lattice angle")
        self.assertIn("saturated", groups.parameter_label("obstacle_density", None))

    def test_a_caption_names_what_its_model_has(self):
        disk = self.fit("model=sp", "wall-stiffness=30", "box=20", "max-time=60", "seeds=1")
        self.assertNotRegex(disk.caption(), "vertices|drag")

    def test_a_caption_names_vertices_and_density_that_were_given(self):
        density = r"obstacle density $0.5/\sigma^2$"
        for given, words in [(["vertices=64"], ["64 vertices"]), (["obstacle-density=0.5"], [density]), ([], [])]:
            caption = self.fit("box=20", "max-time=20", "line-tension=0.5,1", "seeds=1", *given).caption()
            for word in ("64 vertices", density):
                self.assertEqual(word in caption, word in words, caption)
            self.assertNotIn("wall tension", caption)  # A film of water is the default.

    def test_a_passage_is_drawn_over_h_with_a_colour_bar_as_high_as_the_axes(self):
        self.succeed("clogrun", "channel", "vertices=64", "orifice=0.8", "start=-1", "end=1", "--polygon-interval", 10,
                     "--output", "run.h5")
        drawing = way.draw(trajectory.read(self.folder / "run.h5"), 4)
        drawing.canvas.draw()
        axes, = drawing.axes
        self.assertIn("relative to the orifice $h", axes.get_xlabel())
        np.testing.assert_allclose(axes.patches[2].get_xy().mean(axis=0), [-1, 0], atol=0.02)
        bar, = axes.child_axes
        self.assertAlmostEqual(bar.get_window_extent().height, axes.get_window_extent().height)

    def test_notes_explain_only_what_is_drawn(self):
        groups = self.fit(*SMALL, "max-time=20", "line-tension=0.05,0.1", "seeds=1..2")
        bars, dotted, arrows = "bars: ", "joined by dotted lines", "arrows: "

        def explained(drawing):
            notes = "".join(text.get_text() for text in drawing.axes[0].texts if text.get_gid() == style.NOTES)
            return [words for words in (bars, dotted, arrows) if words in notes]

        self.assertEqual(explained(style.figure_of(lengths.draw_on, groups)), [dotted, arrows])
        self.assertEqual(explained(style.figure_of(lengths.draw_speeds_on, groups)), [])
        groups.members = groups.members[:1]
        self.assertEqual(explained(style.figure_of(lengths.draw_on, groups)), [arrows])
        groups.members[0].update(clogs=2, clogging_length=1.0, clogging_length_upper=4.0)
        self.assertEqual(explained(style.figure_of(lengths.draw_on, groups)), [bars])

    def test_panels_explain_missing_points_and_share_a_legend_in_the_order_of_their_curves(self):
        groups = self.fit(*SMALL, "max-time=60", "line-tension=0.05,3", "obstacle-gap=0.2,0.4", "seeds=1..2")
        curves = [(members, index, label, {}) for index, (label, members) in enumerate(groups.curves())]
        stiff = [([group for group in members if group["line_tension"] == 3], *others) for members, *others in curves]
        runner = SimpleNamespace(columns=lambda _: groups.columns, confidence=lambda _: groups.confidence)
        drawing = panels.draw(runner, "", [("all", curves), ("stiff", stiff)], [])
        drawing.canvas.draw()
        self.assertEqual([[text.get_text()[:7] for text in axes.texts] for axes in drawing.axes], [[], ["not run"]])
        legend, = drawing.subfigs[1].legends
        self.assertEqual([text.get_text() for text in legend.get_texts()][:2], [label for label, _ in groups.curves()])

    def test_titles_of_a_sheet_of_clogs_stay_off_its_edge_and_its_panels_have_one_scale(self):
        drawing = Sweep(shared_sweep(*FEW), BIN).clogs().picture().figure
        drawing.canvas.draw()
        self.assertEqual(len({round(axes.get_window_extent().width / np.ptp(axes.get_xlim()), 6) for axes in drawing.axes}), 1)
        for axes in drawing.axes:
            self.assertLess(axes.title.get_window_extent().y1, drawing.bbox.y1 - 0.1 * drawing.dpi)

    def test_numbers_in_titles_have_four_figures_at_most(self):
        row = stored.read_rows(shared_sweep(*FEW))[0]
        row["obstacle_gap"] = 0.22190123
        self.assertIn(r"obstacle gap $0.2219\,\sigma$", clogs.title(row))

    def test_examples_are_of_droplets_that_came_a_diameter_far_if_there_are_any(self):
        columns = [("task", int), ("distance", float), ("shape_parameter", float), ("mechanism", "S8")]
        rows = np.array([(task, distance, 1 + task % 3, b"squeezed")
                         for task, distance in enumerate([0.1, 3, 0.2, 2, 0.5, 9, 0.4, 1])], columns)
        self.assertEqual({row["task"] for row in report.examples(rows, 4)}, {1, 3, 5, 7})
        self.assertEqual({row["task"] for row in report.examples(rows, 2)} - {1, 3, 5, 7}, set())
        self.assertTrue({1, 3, 5, 7} < {row["task"] for row in report.examples(rows, 6)})

    def test_one_is_no_plural(self):
        self.assertEqual([rounded.count_text(number, "run") for number in (0, 1, 2)], ["0 runs", "1 run", "2 runs"])
        self.assertEqual([labels.runs_a_point([{"runs": runs} for runs in all_runs]) for all_runs in ([1, 1], [4], [1, 3])],
                         ["1 run per point", "4 runs per point", "1 to 3 runs per point"])
        self.succeed("clogsweep", *QUICK, "seeds=1", "--output", "s.h5")
        self.draw("report", "s.h5", "--output", "s.html", "--examples", 0)
        self.assertNotRegex((self.folder / "s.html").read_text(), r"\b1 (runs|points|clogs|gaps|contacts)\b")

    def test_the_last_frame_of_a_film_is_the_end_of_the_run(self):
        self.copy_sweep("run.h5", "array", *QUICK, "--polygon-interval", 10, program="clogrun")
        run = trajectory.read(self.folder / "run.h5")
        # The row is changed to that of a certified clog. The equilibrium of such a clog is beyond the last frame.
        run.row["distance"] = run.table["distance"][-1] + 0.01
        moving = film.Film(run, film.chosen_frames(run, 50), "speed", 20)
        moving.show(len(moving) - 1)
        end = f"r = {run.row['distance']:.2f} "
        self.assertTrue(any(end in text.get_text() for text in moving.figure.texts),
                        [text.get_text() for text in moving.figure.texts])

    def film_of(self, **options):
        self.copy_sweep("run.h5", "array", *QUICK, "--polygon-interval", 3, program="clogrun")
        run = trajectory.read(self.folder / "run.h5")
        frames = film.chosen_frames(run, 50)
        return run, frames, film.Film(run, frames, **{"colour": "speed", "rate": 20} | options)

    def test_a_frame_shows_what_is_there_and_nothing_of_another_one(self):
        run, frames, moving = self.film_of(size="1080p")
        first, last = (moving.pixels(index).copy() for index in (0, len(moving) - 1))
        self.assertEqual(first.shape, (1080, 1920, 4))
        self.assertGreater((first != last).any(axis=2).mean(), 0.01)
        np.testing.assert_array_equal(moving.pixels(1), moving.pixels(1))
        axes = moving.figure.axes[0]

        def colour_at(index, point):
            picture = moving.pixels(index)
            x, y = axes.transData.transform(point)
            return picture[len(picture) - 1 - int(y), int(x), :3].astype(int)

        for index in (0, len(moving) // 2):
            red, green, blue = colour_at(index, trajectory.centroids(run.polygons)[frames[index]])
            self.assertTrue(red > green > blue, "the droplet is orange")
            (left, right), (low, high) = axes.get_xlim(), axes.get_ylim()
            # This obstacle is in the middle of the picture, where nothing covers it.
            inside = [(x, y) for x, y, _ in run.obstacles if left + 0.3 * (right - left) < x < left
                      + 0.6 * (right - left) and low + 0.4 * (high - low) < y < high - 0.3 * (high - low)]
            self.assertGreater(len(inside), 0)
            for place in inside:
                np.testing.assert_array_equal(colour_at(index, place), 184)

    def test_colours_of_a_gif_are_those_of_its_frames(self):
        for colour in film.COLOURS:
            (self.folder / "run.h5").unlink(missing_ok=True)
            _, _, moving = self.film_of(size="540p", colour=colour)
            film.write_gif(moving, self.folder / "film.gif", 20)
            with Image.open(self.folder / "film.gif") as shown:
                for index in (0, len(moving) - 1):
                    shown.seek(index)
                    pixels = np.asarray(shown.convert("RGB")).astype(int)
                    drawn = moving.pixels(index)[..., :3].astype(int)
                    self.assertLess(np.abs(pixels - drawn).max(axis=2).mean(), 1)
                    self.assertLess(np.percentile(np.abs(pixels - drawn).max(axis=2)[100:440, 885:894], 99), 12,
                                    "the colour bar")
                    self.assertEqual(pixels[20, 480].tolist(), [255, 255, 255])
                    self.assertLess(pixels[-3:, 100:500].min(axis=0).mean(), 128, "the line of the frame below")

    def test_without_a_colour_bar_its_place_is_the_film_s(self):
        widths = []
        for colour in film.COLOURS:
            (self.folder / "run.h5").unlink(missing_ok=True)
            run, frames, _ = self.film_of()
            run.row["mechanism"] = b"wrapped"
            axes = film.Film(run, frames, colour, 20).figure.axes[0]
            widths.append(axes.get_position().width)
            entries = [text.get_text() for text in axes.get_legend().get_texts()]
            self.assertEqual(entries, ["path of the centre", *(["clogged, wrapped"] if colour == "mechanism" else [])])
        self.assertLess(widths[0], 0.92)
        self.assertGreater(widths[1], 0.99)

    def test_a_film_goes_to_ffmpeg_frame_by_frame(self):
        _, _, moving = self.film_of(size="540p")
        program = self.folder / "ffmpeg"
        program.write_text('#!/bin/sh\nfor last; do :; done\necho "$@" > "$CALLED"\ncat > "${last#file:}"\n')
        program.chmod(0o755)
        environment = {"PATH": f"{self.folder}:{os.environ['PATH']}", "CALLED": str(self.folder / "called")}
        with unittest.mock.patch.dict(os.environ, environment):
            film.write_film(moving, self.folder / "film.mp4", 20)
            sent = (self.folder / "film.mp4").read_bytes()
            frame = 960 * 540 * 4
            self.assertEqual(len(sent), (len(moving) + film.SECONDS_OF_VERDICT * 20) * frame)
            self.assertEqual(sent[-frame:], moving.pixels(len(moving) - 1).tobytes())
            self.assertIn("-pix_fmt rgba -video_size 960x540 -framerate 20", (self.folder / "called").read_text())
            program.write_text("#!/bin/sh\necho 'no such encoder' >&2\nexit 1\n")
            with self.assertRaisesRegex(UserError, "other.*ffmpeg: no such encoder"):
                film.write_film(moving, self.folder / "other.mp4", 20)
        self.assertFalse(list(self.folder.glob("other*")))

    def test_posters_of_arrays_channels_and_walls(self):
        for name, keys in [("arrays", [*ONE_CURVE, "relative-drag=0.5,1,2"]),
                           ("channel", ["orifice=0.7", "vertices=64", "line-tension=0.5,5", "max-time=2000"]),
                           ("wall", ["obstacle-layout=wall", "vertices=64", "line-tension=0.3,1"])]:
            with self.subTest(name):
                self.succeed("clogsweep", *keys, "--output", f"{name}.h5")
                self.assertEqual(self.draw("poster", f"{name}.h5", "--programs", BIN).stdout, f"{name}-poster.png (and .pdf)\n")
                self.assert_picture(f"{name}-poster")
        drawing = poster.draw(self.folder / "arrays.h5", BIN)
        texts = " ".join(text.get_text() for text in drawing.findobj(Text))
        for once in ("deformable polygon", "2 runs per point", "preset robust"):
            self.assertEqual(texts.count(once), 1, once)
        for words in ("Clogging length vs line tension", "12 runs:", "begun 20", "\nclogsweep vertices=64",
                      "share of the runs"):
            self.assertIn(words, texts)

    def test_many_curves_leave_room_for_themselves_on_a_poster(self):
        self.succeed("clogsweep", *QUICK, "line-tension=2,8", "obstacle-gap=lin(0.2,0.35,8)", "seeds=1", "--output", "s.h5")
        self.draw("poster", "s.h5", "--programs", BIN)
        self.assert_picture("s-poster")


if __name__ == "__main__":
    unittest.main()
