"""Tests the Python module clogsweep as users call it in a notebook."""

import json
import os
import re
import subprocess
import sys

import h5py
import numpy as np
import pandas
from PIL import Image

import stored_rows
from drawing import Analysis
from support import BIN, QUICK, ROOT, SweepTest, table

import clogsweep.__main__
from clogsweep.pages import report
from clogsweep.reading import programs
from clogsweep.labels.groups import Groups

PNG = b"\x89PNG\r\n"


class Module(Analysis):
    def sweep(self, *keys):
        self.copy_sweep("s.h5", *QUICK, *(keys or ["line-tension=0.5,3", "seeds=1..4"]))
        return clogsweep.open(self.folder / "s.h5", BIN)

    def sweep_of_own(self, *keys):
        self.succeed("clogsweep", "vertices=64", "box=20", "max-time=60", "line-tension=0.5,3", *keys, "--output", "s.h5")
        return clogsweep.open(self.folder / "s.h5", BIN)

    def run_of_one_droplet(self, *options):
        self.copy_sweep("r.h5", "array", *QUICK, "line-tension=0.5", "seeds=1", *options, program="clogrun")
        return clogsweep.open(self.folder / "r.h5")

    def test_rows_are_those_of_the_file_with_units(self):
        sweep = self.sweep()
        self.assertIsInstance(sweep, clogsweep.Sweep)
        pandas.testing.assert_frame_equal(sweep.rows, table(self.folder / "s.h5"), check_dtype=False)
        self.assertEqual(sweep.rows.attrs["units"]["mean_speed"], "sqrt(sigma g)")
        self.assertIn("terminal-speed", sweep.attributes["config"])
        self.assertEqual(sweep.status()["runs"], 8)

    def test_groups_are_those_of_clogfit(self):
        fit = self.sweep().fit()
        printed = json.loads(self.succeed("clogfit", "s.h5", "--format", "json").stdout)
        self.assertEqual(fit.output, printed)
        self.assertEqual(fit.groups.line_tension.tolist(), [0.5, 3])
        self.assertEqual(fit.groups.clogging_length.tolist(), [group["clogging_length"] for group in printed["groups"]])
        curve = fit.survival(1)
        self.assertEqual(curve.iloc[0].to_dict(), {"distance": 0, "at_risk": 4, "clogs": 0, "probability": 1, "standard_error": 0, "lower": 1, "upper": 1})
        self.assertEqual(curve.probability.tolist()[1:len(printed["groups"][1]["survival"]) + 1], [step["probability"] for step in printed["groups"][1]["survival"]])
        self.assertEqual(curve.distance.iloc[-1], max(printed["groups"][1]["censored_distances"] + curve.distance.tolist()))
        self.assertEqual((fit.units["clogging_length"], fit.confidence), ("sigma", 0.95))

    def test_mean_speeds_of_fewer_than_three_runs_are_printed_nowhere(self):
        fit = self.sweep("line-tension=0.1,0.7,1", "obstacle-gap=0.4", "seeds=1..4").fit()
        self.assertEqual(fit.groups.relative_speed_runs.tolist(), [3, 2, 1])
        lines = [line.split() for line in self.succeed("clogfit", "s.h5").stdout.splitlines()]
        heading, = [line for line in lines if line[-7:] == ["<v_g>/v_t", "+-", "of", "all", "runs", "+-", "note"]]
        rows = lines[lines.index(heading) + 1:][:3]
        # The runs are shorter than 5 sigma/v_t, where the steady speed begins.
        self.assertEqual([row[-6] for row in rows], ["-"] * 3)
        self.assertTrue(fit.groups.relative_speed_steady.isna().all())
        for name in ("relative_speed_error", "capillary_number"):
            self.assertEqual(fit.groups[name].isna().tolist(), [False, True, True], name)
        self.assertEqual([group["relative_speed"] is None for group in fit.output["groups"]], [False, True, True])
        axes, = fit.speeds().figure.axes
        # The speeds are those of all runs.
        self.assertEqual([bars.lines[0].get_xdata().tolist() for bars in axes.containers], [[0.1, 0.7]])
        of_page = report.table_of_lengths(fit.known, fit.output["doubts"], table(self.folder / "s.h5"))
        cells = re.findall(r"<td><span>[^<]*</span><small>( \(mean of \d of \d runs: [^<]*\))</small></td>", of_page)
        self.assertEqual([re.search(r"\(.* runs", cell)[0] for cell in cells],
                         ["(mean of 3 of 4 runs", "(mean of 2 of 4 runs"])
        self.assertTrue(cells[1].endswith(": -)"))

    def test_a_notebook_shows_what_varies_and_how_far_a_sweep_is(self):
        sweep = self.sweep()
        fit = sweep.fit()
        self.assertEqual(fit.summary.columns.tolist()[:3], ["line_tension", "runs", "clogs"])
        self.assertLess(len(fit.summary.columns), 20)
        shown = fit._repr_html_()
        for words in ("<th>clogging_length</th>", f"all {len(fit.groups.columns)} columns are in"):
            self.assertIn(words, shown)
        self.assertNotIn("contact_range", shown)
        self.assertIn("<td>8</td>", sweep.status()._repr_html_())

    def test_lattices_are_drawn_by_how_far_droplets_migrate(self):
        angles = ["obstacle-layout=lattice", "obstacle-gap=0.9", "lattice-angle=0,14", "line-tension=5", "terminal-speed=0.1"]
        self.succeed("clogsweep", "vertices=64", "box=20", "max-time=60", *angles, "seeds=1", "--output", "s.h5")
        fit = clogsweep.open(self.folder / "s.h5", BIN).fit()
        axes, = fit.curve().figure.axes
        self.assertEqual(axes.get_ylabel(), "lateral displacement per distance")
        bars, = axes.containers
        self.assertEqual(bars.lines[0].get_ydata().tolist(), fit.groups.lateral_slope.tolist())
        self.assertEqual(bars.lines[0].get_xdata().tolist(), fit.groups.lattice_angle.tolist())

    def test_options_of_a_fit_reach_clogfit(self):
        options = {"dwell": 20.0, "from_distance": 0.5, "confidence": 0.5, "row_angle": 10.0}
        words = [word for name, value in options.items() for word in (f"--{name.replace('_', '-')}", value)]
        self.assertEqual(self.sweep().fit(**options).output,
                         json.loads(self.succeed("clogfit", "s.h5", "--format", "json", *words).stdout))

    def test_curves_draw_themselves_are_saved_and_know_where_they_come_from(self):
        sweep = self.sweep()
        fit = sweep.fit()
        for picture in (fit.curve(), fit.speeds()):
            self.assertTrue(picture._repr_png_().startswith(PNG))
        self.assertEqual(fit.curve().save(self.folder / "curve.png"), self.folder / "curve.png")
        self.assert_picture("curve")
        about = Image.open(self.folder / "curve.png").text["Description"]
        for words in (sweep.attributes["git_describe"], "line-tension=0.5,3", "seeds = 1..4",
                      "8 runs in 2 groups, fitted by clogfit "):
            self.assertIn(words, about)
        self.write("notes.png", "no picture")
        with self.assertRaisesRegex(clogsweep.UserError, "will not overwrite .*notes.png"):
            fit.curve().save(self.folder / "notes")

    def test_a_sweep_that_lost_attributes_is_drawn(self):
        def edit(file):
            for name in ("git_describe", "start_time"):
                del file.attrs[name]

        self.sweep()
        stored_rows.edited(self.folder / "s.h5", edit)
        fit = clogsweep.open(self.folder / "s.h5", BIN).fit()
        self.assertRegex(fit.curve().source, rf"^clogsweep {clogsweep.__version__}, git \S+\nclogsweep vertices")

    def test_clogs_draw_themselves_and_say_what_holds_them(self):
        sweep = self.sweep("line-tension=3", "seeds=1..8")
        clogs = sweep.clogs(most=2)
        clogged = sweep.rows[sweep.rows.status == "clogged"]
        self.assertEqual([clog.task for clog in clogs], clogged.task.tolist()[:2])
        self.assertEqual([clog.mechanism for clog in clogs], clogged.mechanism.tolist()[:2])
        self.assertIn("line-tension=3 seeds=1..8 --output ", clogs.picture().source)
        self.assertTrue(clogs.picture().source.endswith(f"\ntasks {clogs[0].task}, {clogs[1].task}"))
        self.assertTrue(all(drawn._repr_png_().startswith(PNG) for drawn in (clogs, clogs[0], clogs[:1])))
        self.assertEqual([clog.task for clog in sweep.clogs(tasks=[clogs[1].task])], [clogs[1].task])
        for options in ({"mechanism": "wraped"}, {"tasks": [77]}):
            with self.assertRaises(clogsweep.UserError):
                sweep.clogs(**options)

    def test_a_replay_reproduces_the_row(self):
        sweep = self.sweep()
        run = sweep.replay(3, interval=5)
        for column in ("status", "distance", "lateral_displacement", "steps"):
            self.assertEqual(run.row[column], sweep.rows[column][3])
        self.assertEqual(len(run.times), len(run.polygons))
        kept = sweep.replay(3, self.folder / "kept.h5", interval=5)
        np.testing.assert_array_equal(kept.polygons, run.polygons)
        with self.assertRaisesRegex(clogsweep.UserError, "no task 8; it has 8 rows"):
            sweep.replay(8)

    def test_a_run_has_its_way_a_picture_and_a_film(self):
        run = self.run_of_one_droplet("--polygon-interval", 10)
        self.assertIsInstance(run, clogsweep.Run)
        pandas.testing.assert_frame_equal(run.samples, pandas.read_hdf(self.folder / "r.h5", "trajectory"))
        self.assertEqual(run.polygons.shape[::2], (len(run.times), 128))
        self.assertEqual(run.obstacles.shape[1], 3)
        self.assertTrue(run._repr_png_().startswith(PNG))
        self.assertIn("\nclogrun array", run.picture().source)
        film = run.film(self.folder / "film.gif", most_frames=4)
        self.assertIn("data:image/gif;base64,", film._repr_html_())
        with self.assertRaisesRegex(clogsweep.UserError, "it exists"):
            run.film(self.folder / "film.gif")
        self.assertTrue(run.export_vtk(self.folder / "vtk").exists())

    def test_a_run_without_outlines_says_so(self):
        run = self.run_of_one_droplet()
        self.assertGreater(len(run.samples), 2)
        self.assertIsNone(run._repr_png_())
        with self.assertRaisesRegex(clogsweep.UserError, "r.h5 .holds no polygons"):
            run.picture()

    def test_a_run_has_no_fit(self):
        with self.assertRaisesRegex(clogsweep.UserError, "a run has no fit; give a sweep"):
            self.run_of_one_droplet().fit()

    def test_circles_of_one_s_own_are_called_by_their_file(self):
        for name, diameter in (("wide.csv", 0.3), ("narrow.csv", 0.5)):
            self.write(name, "x,y,diameter\n" + "".join(f"{x},{y},{diameter}\n" for x in range(1, 20, 2) for y in range(1, 20, 2)))
        one = self.sweep_of_own("obstacles=wide.csv")
        self.assertIn("circles of wide.csv", one.fit().curve().figure.axes[0].get_title())
        self.assertIn("circles of wide.csv", Groups(one.fit().output).caption())
        settings = report.settings(one.attributes["config"])
        self.assertIn("\nobstacles = wide.csv\n", settings)
        for untrue in ("obstacle-gap", "obstacle-density"):
            self.assertNotIn(f"\n{untrue} = ", settings)
        (self.folder / "s.h5").unlink()
        two = self.sweep_of_own("obstacles=wide.csv,narrow.csv")
        _, names = two.fit().curve().figure.axes[0].get_legend_handles_labels()
        self.assertEqual(sorted(name for name in names if name), ["obstacles narrow.csv", "obstacles wide.csv"])
        page = two.report(self.folder / "r.html", examples=0).read_text()
        self.assertIn("<h2>Curves</h2>", page)
        self.assertIn("<td>narrow.csv</td>", page)
        self.assertIn("\nobstacles = wide.csv,narrow.csv\n", page)

    def test_what_is_damaged_or_something_else_is_refused(self):
        self.sweep()
        content = bytearray((self.folder / "s.h5").read_bytes())
        content[len(content) // 2] ^= 1
        (self.folder / "d.h5").write_bytes(content)
        with self.assertRaisesRegex(clogsweep.Damaged, "d.h5"):
            clogsweep.open(self.folder / "d.h5")
        with self.assertRaisesRegex(clogsweep.UserError, "nope.h5 .no such file"):
            clogsweep.open("nope.h5")
        self.write("t.csv", "a,b\n")
        with self.assertRaisesRegex(clogsweep.UserError, "not an HDF5 file"):
            clogsweep.open(self.folder / "t.csv")
        pandas.DataFrame({"a": [1]}).to_hdf(self.folder / "p.h5", key="runs")
        with h5py.File(self.folder / "f.h5", "w") as file:
            file["runs"] = [1.0, 2.0]
            file.attrs["format_version"] = "10"
        for name in ("p.h5", "f.h5"):
            with self.assertRaisesRegex(clogsweep.UserError, f"cannot .*{name}"):
                clogsweep.open(self.folder / name)

    def test_a_sweep_of_channels_has_rows_but_no_lengths(self):
        self.succeed("clogsweep", "obstacle-layout=channel", "orifice=0.6", "line-tension=1", "max-time=50", "--output", "s.h5")
        sweep = clogsweep.open(self.folder / "s.h5", BIN)
        self.assertEqual(sweep.fit().groups.status.tolist(), sweep.rows.status.tolist())
        with self.assertRaisesRegex(clogsweep.UserError, "in a channel"):
            sweep.fit().curve()
        with self.assertRaisesRegex(clogsweep.UserError, "in a channel"):
            sweep.clogs()

    def test_a_report_takes_no_other_file_s_place(self):
        sweep = self.sweep()
        self.write("notes.html", "my notes")
        before = self.snapshot()
        for name in ("s.h5", "notes.html"):
            with self.subTest(name), self.assertRaisesRegex(clogsweep.UserError, f"will not overwrite .*{name}"):
                sweep.report(self.folder / name, examples=0)
        self.assertEqual(self.snapshot(), before)

    def test_invalid_arguments_are_named(self):
        sweep, run = self.sweep(), self.run_of_one_droplet("--polygon-interval", 10)
        film = self.folder / "film.gif"
        for words, call in {
            "invalid rate: 0 .must be a whole number, 1 or more": lambda: run.film(film, rate=0),
            "invalid most_frames: 1.5": lambda: run.film(film, most_frames=1.5),
            "invalid size: 9p .must be 540p or 1080p or 2160p": lambda: run.film(film, size="9p"),
            "invalid colour: red": lambda: run.film(film, colour="red"),
            "film.avi .it can only be .mp4 or .gif": lambda: run.film(self.folder / "film.avi"),
            "way.mp4 .it can only be .png or .pdf": lambda: run.picture().save(self.folder / "way.mp4"),
            "invalid outlines: 0": lambda: run.picture(0),
            "invalid most: 0": lambda: sweep.clogs(most=0),
            "invalid jobs: 0": lambda: sweep.clogs(jobs=0),
            "invalid examples: -1": lambda: sweep.report(self.folder / "r.html", examples=-1),
            "no group 2; there are 2, the first is 0": lambda: sweep.fit().survival(2),
            "invalid group: 1.0": lambda: sweep.fit().survival(1.0),
        }.items():
            with self.subTest(words), self.assertRaisesRegex(clogsweep.UserError, words):
                call()

    def test_repr_and_dir_describe_the_objects(self):
        self.assertEqual(repr(self.sweep().fit()), "<fit of 8 runs in 2 groups>")
        self.assertIn("Sweep", dir(clogsweep))
        self.assertIn(f"clogsweep {clogsweep.__version__} ", self.succeed("clogsweep", "--version").stdout)

    def test_a_python_module_that_is_lacking_gets_one_line(self):
        for lines in ("clogsweep.open('s.h5')", "clogsweep.Sweep"):
            # With None in sys.modules an import fails.
            done = subprocess.run([sys.executable, "-c", "import sys; sys.modules['pandas'] = None\nimport "
                                                         f"clogsweep\n{lines}"],
                                  cwd=ROOT / "analysis", capture_output=True, text=True)
            self.assertRegex(done.stderr.splitlines()[-1], "^ImportError: cannot start .*pandas.*; .*python.* needs "
                                                           "h5py, pandas, SciPy, tables and matplotlib")
            self.assertNotIn("ModuleNotFoundError", done.stderr)

    def test_nothing_is_loaded_that_a_call_does_not_need(self):
        self.sweep()
        libraries = ("numpy", "scipy", "h5py", "pandas", "matplotlib", "PIL")
        for lines, loaded in (("", []), ("clogsweep.UserError", []), ("clogsweep.Fit", ["numpy", "h5py"]),
                              ("len(clogsweep.open('s.h5').rows)", ["numpy", "h5py", "pandas"]),
                              ("import clogsweep.commands.predict", ["numpy", "h5py"])):
            with self.subTest(lines=lines):
                printed = subprocess.run([sys.executable, "-c", f"import sys, clogsweep\n{lines}\nprint([name for name in {libraries} if name in sys.modules])"],
                                         cwd=self.folder, env={**os.environ, "PYTHONPATH": str(ROOT / "analysis")},
                                         capture_output=True, text=True, check=True)
                self.assertEqual(printed.stdout, f"{loaded}\n")

    def test_programs_that_are_not_there_are_asked_for(self):
        self.sweep()
        with self.assertRaisesRegex(clogsweep.UserError, "no clogsweep in /nowhere; .*--programs"):
            clogsweep.open(self.folder / "s.h5", "/nowhere").fit()

    def test_commands_are_listed_and_found(self):
        def called(*words):
            return subprocess.run([sys.executable, "-m", "clogsweep", *words], capture_output=True, text=True,
                                  cwd=self.folder, env={**os.environ, "PYTHONPATH": str(ROOT / "analysis")})

        listed = called()
        self.assertEqual((listed.returncode, called("--help").stdout), (0, listed.stdout))
        paths = (ROOT / "analysis/clogsweep/commands").glob("[a-z]*.py")
        modules = {path.stem.replace("_", "-") for path in paths} - {"command-line"}
        self.assertEqual(modules, set(clogsweep.__main__.COMMANDS))
        for command in modules:
            self.assertIn(f"\n  {command} ", listed.stdout)
            helped = called(command, "--help")
            self.assertEqual(helped.returncode, 0, helped.stderr)
            self.assertTrue(helped.stdout.startswith(f"usage: python3 -m clogsweep {command} "), helped.stdout)
        for word, hint in [("quux", "--help lists them"), ("clogging-lenght", "did you mean clogging-length?")]:
            wrong = called(word)
            self.assertEqual(wrong.returncode, 2)
            self.assertRegex(wrong.stderr, f"unknown command: {word}; .*{re.escape(hint)}\n")


class UnderWay(SweepTest):
    def test_a_sweep_that_runs_can_be_read(self):
        process = self.start("vertices=64", "box=20", "obstacle-gap=0.4", "line-tension=0.05", "max-time=1e9", "seeds=1..4",
                             "--report-seconds=0.1", "--output", "s.h5")
        self.wait_for(lambda: (self.folder / "s.h5").exists() and len(table(self.folder / "s.h5")) > 0 or process.poll() is not None)
        sweep = clogsweep.open(self.folder / "s.h5", BIN)
        self.assertEqual(sweep.status()["runs"], 4)
        self.assertIn("running", set(sweep.rows.status))
        self.assertEqual(len(sweep.fit().groups), 1)


class Places(Analysis):
    def test_the_source_tree_has_them(self):
        self.assertEqual(programs.JOBS, ROOT / "jobs")
        self.assertEqual(programs.programs_in(BIN), BIN.resolve())
