import os
import pty
import re
import select
import signal
import subprocess
import time
import unittest

import h5py
import numpy as np
import pandas

from support import BIN, LONGEST, QUICK, ROOT, SMALL, ProgramTest, table


def centroid_x(polygon):
    """The x coordinate of the centroid of the enclosed area. @param polygon  coordinates of shape (2, N)"""
    (x, y), (after_x, after_y) = polygon, np.roll(polygon, -1, axis=1)
    cross = x * after_y - after_x * y
    return ((x + after_x) * cross).sum() / (3 * cross.sum())


class Run(ProgramTest):
    def test_it_reproduces_a_row_of_a_sweep_bit_for_bit(self):
        keys = [*QUICK, "near-wall-drag=0.1", "obstacle-gap=0.4"]
        self.succeed("clogsweep", *keys, "line-tension=0.4,2", "seeds=1..3", "--output", "sweep.h5")
        rows = pandas.read_hdf(self.folder / "sweep.h5", "runs")
        row = rows[(rows.line_tension == 2) & (rows.seed == 3)].iloc[0]
        self.succeed("clogrun", "array", *keys, "line-tension=2", "--seed", 3, "--output", "run.h5")
        again = pandas.read_hdf(self.folder / "run.h5", "runs").iloc[0]
        for column in rows.columns.drop(["task", "wall_seconds", "processor_seconds", "rank", "host"]):
            if isinstance(row[column], float) and np.isnan(row[column]):
                self.assertTrue(np.isnan(again[column]), column)
            else:
                self.assertEqual(row[column], again[column], column)

    def test_it_replays_a_row_whatever_the_sweep_goes_over(self):
        self.succeed("clogsweep", *QUICK, "wall-tension=0.6,1", "line-tension=2", "seeds=4..5", "--output", "s.h5")
        rows = table(self.folder / "s.h5")
        for task in (1, 2):
            self.succeed("clogrun", "replay", "s.h5", task, "--output", f"r{task}.h5")
            again = table(self.folder / f"r{task}.h5").iloc[0]
            for column in ("wall_tension", "seed", "status", "distance", "steps", "shape_parameter"):
                self.assertEqual(again[column], rows.iloc[task][column], column)
        self.succeed("clogrun", "replay", "s.h5", 1, "--to-rest", "--output", "rest.h5")
        rest = table(self.folder / "rest.h5").iloc[0]
        self.assertEqual(rest.clog_detection, "threshold")
        self.assertGreaterEqual(rest.time, rows.time[1])
        self.refuse("clogrun", "replay", "s.h5", 77, "--output", "x.h5", words=["no task 77"])
        self.refuse("clogrun", "replay", "s.h5", "--output", "x.h5", words=["missing sweep file or task"])
        self.refuse("clogrun", "replay", "s.h5", 1, "line-tension=3", "--output", "x.h5", words=["remove line-tension"])
        self.refuse("clogrun", "array", "--to-rest", "--output", "x.h5",
                    words=["--to-rest has no meaning for clogrun array"])

    def test_a_droplet_in_a_long_array_does_not_meet_the_same_obstacles_again(self):
        for boxes, repeats in ((1, True), (4, False)):
            self.succeed("clogrun", "array", "vertices=64", "box=8", f"boxes={boxes}", "obstacle-density=0.3",
                         "line-tension=0.3", "max-time=600", "--polygon-interval=20", "--seed=2", "--output",
                         f"{boxes}.h5")
            with h5py.File(self.folder / f"{boxes}.h5") as file:
                met = file["obstacles"][:, :2].round(6).tolist()
            one_box_before_the_last = [[round(x + 8, 6), y] for x, y in met if x + 8 < max(x for x, _ in met)]
            self.assertGreater(len(one_box_before_the_last), 5)
            self.assertEqual([place in met for place in one_box_before_the_last],
                             [repeats] * len(one_box_before_the_last))

    def test_a_long_array_can_be_written_and_used_again(self):
        keys = ["vertices=64", "box=8", "boxes=3", "max-time=20"]
        self.succeed("clogrun", "array", *keys, "--write-obstacles", "array.csv", "--output", "own.h5")
        places = pandas.read_csv(self.folder / "array.csv")
        self.assertGreater(places.x.max(), 23)
        self.assertLess(places.y.max(), 8)
        self.succeed("clogrun", "array", *keys, "--obstacles", "array.csv", "--output", "again.h5")
        own, again = (pandas.read_hdf(self.folder / name, "runs").iloc[0] for name in ("own.h5", "again.h5"))
        self.assertAlmostEqual(own.distance, again.distance, places=9)
        self.assertAlmostEqual(again.obstacle_density, len(places) / (24 * 8), places=12)

    def test_what_was_not_tested_is_said_on_the_standard_error(self):
        for system in (["array", *SMALL, "--output",
                        "run.h5"], ["channel", "vertices=64", "--start=-1", "--output",
                                    "channel.h5"], ["sag", "vertices=64"]):
            with self.subTest(system=system[0]):
                keys = ["line-tension=0", "max-time=1"]
                done = self.run_program("clogrun", *system, *keys)
                self.assertEqual(done.stderr.splitlines()[0],
                                 "outside the range tested for soundness (handbook, How far to trust it): line-tension=0 "
                                 "(robust is tested from 0.05 to 10)")
        self.assertEqual(self.succeed("clogrun", "array", *SMALL, "max-time=1", "--output", "sound.h5").stderr, "")

    def test_a_coarse_polygon_in_a_channel_is_cautioned_against(self):
        for vertices, printed in ((96, ["with vertices=96 a droplet may clog where it passes with 128 or more "
                                        "(corners of the polygon catch on the wedges' tips); "
                                        "use vertices=128 or more"]), (128, [])):
            done = self.succeed("clogrun", "channel", f"vertices={vertices}", "max-time=1",
                                "--output", f"{vertices}.h5")
            self.assertEqual(done.stderr.splitlines(), printed)

    def test_it_writes_the_trajectory(self):
        done = self.succeed("clogrun", "array", *QUICK, "obstacle-gap=1.2", "--sample-interval", 2, "time-step=1e-3",
                            "--output", "run.h5")
        self.assertRegex(done.stdout.splitlines()[-1], r"^\d+ steps, [\d.]+ s, [\d.]+ ns per vertex-step$")
        samples = pandas.read_hdf(self.folder / "run.h5", "trajectory")
        self.assertEqual(samples.time[0], 0)
        self.assertEqual(samples.distance[0], 0)
        self.assertAlmostEqual(samples.time.iloc[-1], 60, places=9)
        self.assertAlmostEqual(np.diff(samples.time)[3], 2, delta=0.064)
        self.assertTrue(np.allclose(samples.area, np.pi / 4, atol=0.01))
        self.assertTrue((samples.shape_parameter >= 0.999).all())
        self.assertTrue(np.allclose(samples.shape_parameter, samples.perimeter**2 / (4 * np.pi * samples.area)))
        # The speed is the derivative of the distance.
        slope = np.gradient(samples.distance, samples.time)[2:-2]
        self.assertLess(np.median(np.abs(slope - samples.speed[2:-2])), 0.003)

    def test_another_interval_of_polygons_than_asked_for_is_said(self):
        for asked, is_said in ((0.25, True), (10, False)):
            done = self.succeed("clogrun", "array", *QUICK, "--polygon-interval", asked, "--output", f"{asked}.h5")
            with h5py.File(self.folder / f"{asked}.h5", "r") as file:
                stored = np.diff(file["polygon_times"][:-1]).mean()
            words = f"the polygons are {stored:.4g} t0 apart, not {asked}"
            self.assertEqual(words in done.stderr, is_said, done.stderr)
            self.assertEqual(abs(stored / asked - 1) > 0.05, is_said)

    def test_a_replay_writes_the_obstacles_of_its_run(self):
        self.succeed("clogsweep", *QUICK, "seeds=2", "--output", "s.h5")
        self.succeed("clogrun", "replay", "s.h5", 0, "--write-obstacles", "replay.csv", "--output", "r.h5")
        self.succeed("clogrun", "array", *QUICK, "seeds=2", "--write-obstacles", "array.csv", "--output", "a.h5")
        circles = [np.loadtxt(self.folder / f"{name}.csv", delimiter=",", comments=("#", "x"))
                   for name in ("replay", "array")]
        np.testing.assert_array_equal(*circles)

    def test_it_writes_polygons_and_the_obstacles_along_the_way(self):
        self.succeed("clogrun", "array", *QUICK, "--polygon-interval", 10, "--output", "run.h5")
        with h5py.File(self.folder / "run.h5", "r") as file:
            polygons, times, obstacles = file["polygons"][:], file["polygon_times"][:], file["obstacles"][:]
            samples = file["trajectory"][:]
        self.assertEqual(polygons.shape, (len(times), 2, 64))
        travelled = centroid_x(polygons[-1]) - centroid_x(polygons[0])
        self.assertAlmostEqual(travelled, samples["distance"][-1], places=10)
        self.assertGreater(len(obstacles), 5)
        # Contact is soft, so vertices may be inside an obstacle by some hundredths of the length of an edge. An edge is
        # 0.05 long.
        for x, y in polygons.transpose(0, 2, 1).reshape(-1, 2):
            gaps = np.hypot(obstacles[:, 0] - x, obstacles[:, 1] - y) - obstacles[:, 2] / 2
            self.assertGreater(gaps.min(), -0.002)

    def test_file_names_may_hold_an_equals_sign_and_intervals_be_huge(self):
        self.succeed("clogrun", "array", *QUICK, "--sample-interval", "1e12", "--output", "box=20.h5")
        self.assertEqual(len(pandas.read_hdf(self.folder / "box=20.h5", "trajectory")), 2)

    def test_a_lattice_reports_the_box_and_angle_used_and_its_row_gives_it_again(self):
        keys = ["model=sp", "wall-stiffness=10", "obstacle-layout=lattice", "obstacle-gap=1.2", "max-time=300"]
        self.succeed("clogrun", "array", *keys, "lattice-angle=10", "box=40", "--output", "a.h5")
        row = pandas.read_hdf(self.folder / "a.h5", "runs").iloc[0]
        self.assertEqual(row.obstacle_filling, "lattice")
        self.assertAlmostEqual(row.obstacle_density, 1 / 1.5**2)
        self.assertLess(row.box, 40)
        self.assertAlmostEqual(row.lattice_angle, 10, delta=0.1)
        self.assertNotEqual(row.lattice_angle, 10)
        self.succeed("clogrun", "array", *keys, f"lattice-angle={float(row.lattice_angle)!r}",
                     f"box={float(row.box)!r}", "--output", "b.h5")
        again = pandas.read_hdf(self.folder / "b.h5", "runs").iloc[0]
        for column in ("box", "lattice_angle", "distance", "lateral_displacement"):
            self.assertEqual(row[column], again[column], column)

    def test_the_posts_of_a_triangular_lattice_are_its_pitch_apart(self):
        keys = ["model=sp", "wall-stiffness=10", "obstacle-layout=lattice", "lattice=triangular",
                "pitch=2", "lattice-angle=19.1", "box=10", "max-time=1"]
        printed = self.succeed("clogrun", "array", *keys, "--output", "a.h5", "--dry-run").stdout
        self.assertIn("# triangular lattice: pitch 2 sigma, rows 1.732 sigma apart, "
                      "at 19.11 degrees (tan = sqrt(3)*1/5); period 5.292 sigma along "
                      "the flow, 9.165 across, 14 posts\n", printed)
        self.succeed("clogrun", "array", *keys, "--write-obstacles", "posts.csv", "--output", "a.h5")
        row = pandas.read_hdf(self.folder / "a.h5", "runs").iloc[0]
        self.assertEqual(row.obstacle_filling, "triangular")
        posts = pandas.read_csv(self.folder / "posts.csv", comment="#")
        self.assertEqual(len(posts), 14)
        for post in posts.itertuples():
            x = (posts.x - post.x + row.length / 2) % row.length - row.length / 2
            y = (posts.y - post.y + row.box / 2) % row.box - row.box / 2
            self.assertEqual(((np.hypot(x, y) - 2).abs() < 1e-9).sum(), 6)

    def test_a_mixture_of_obstacles_is_written(self):
        self.succeed("clogrun", "array", *QUICK, "obstacle-diameter-spread=0.5", "--write-obstacles", "array.csv",
                     "--output", "a.h5")
        diameters = pandas.read_csv(self.folder / "array.csv").diameter
        self.assertGreater(diameters.max() - diameters.min(), 0.28)
        row = pandas.read_hdf(self.folder / "a.h5", "runs").iloc[0]
        self.assertEqual(row.obstacle_diameter_spread, 0.5)
        self.assertTrue(np.isnan(row.obstacle_density))
        self.assertTrue(np.isnan(row.lattice_angle))

    def test_obstacles_written_can_be_read_back(self):
        self.succeed("clogrun", "array", *QUICK, "obstacle-gap=0.4", "seeds=2", "--write-obstacles", "array.csv",
                     "--output", "a.h5")
        header = (self.folder / "array.csv").read_text().splitlines()[0]
        self.assertEqual(header, "x,y,diameter")
        # With --obstacles a density in the config has no effect, even if no array with this gap could have such a
        # density.
        self.write("dense.cfg", "obstacle-density = 2.5\n")
        self.succeed("clogrun", "array", "vertices=64", "box=20", "max-time=60", "seeds=2", "--config", "dense.cfg",
                     "obstacle-density=12.5%", "--obstacles", "array.csv", "--output", "b.h5")
        first = pandas.read_hdf(self.folder / "a.h5", "runs").iloc[0]
        second = pandas.read_hdf(self.folder / "b.h5", "runs").iloc[0]
        self.assertEqual(first.distance, second.distance)
        self.assertEqual(second.obstacle_filling, "file")

    def test_a_droplet_comes_to_rest_on_the_users_own_obstacles(self):
        # Below the start of the droplet there are two circles, with a gap that is narrower than the droplet.
        self.write("gate.csv", "# a gate\n\n12,9.65,0.3\n12,10.35\n")
        done = self.succeed("clogrun", "array", "--obstacles", "gate.csv", "box=20", "vertices=128", "line-tension=3",
                            "max-time=3000", "--output", "run.h5")
        self.assertIn("clogged", done.stdout)
        row = pandas.read_hdf(self.folder / "run.h5", "runs").iloc[0]
        self.assertAlmostEqual(row.obstacle_gap, 0.4, places=12)
        self.assertGreater(row.distance, 1.4)
        self.assertLess(row.distance, 2)

    def test_walls_that_hold_take_energy_and_never_give_any(self):
        """Tests each law of walls in a whole run among obstacles. Only springs along the interface may add energy."""
        laws = {
            "friction": ["preset=elastic", "friction=0.2"],
            "traction": ["preset=elastic", "yield-traction=0.05"],
            "hysteresis": ["wall-tension=0.5", "receding-angle=90", "advancing-angle=150"],
        }
        stored = ["kinetic", "gravity", "line_tension", "area", "spring", "wall", "self_contact", "anchor"]
        for name, keys in laws.items():
            with self.subTest(name):
                self.succeed("clogrun", "array", *keys, "vertices=64", "line-tension=0.2", "obstacle-gap=0.3", "box=20",
                             "max-time=80", "seeds=1", "--sample-interval", 0.5, "--output", f"{name}.h5")
                samples = pandas.read_hdf(self.folder / f"{name}.h5", "trajectory")
                energy = sum(samples[f"{part}_energy"] for part in stored) - samples.spreading_work
                self.assertGreater(samples.anchor_energy.max(), 0)
                self.assertLess(energy.diff().max(), 0)
                self.assertLess((energy + samples.dissipated_energy).pipe(np.ptp),
                                1e-4 * samples.dissipated_energy.iloc[-1])

    def test_a_droplet_that_creeps_along_walls_with_friction_is_not_certified(self):
        # The droplet creeps for 3000 t0, and then travels another 15 sigma. If the search for a rest began as early as
        # without friction, it would certify a clog.
        self.succeed("clogrun", "array", "preset=elastic", "friction=0.1", "line-tension=0.3", "vertices=256",
                     "obstacle-gap=0.3", "obstacle-density=65%", "box=50", "boxes=4", "seeds=6", "max-time=300",
                     "--sample-interval=60", "--output", "creep.h5")
        with h5py.File(self.folder / "creep.h5") as file:
            last = file["trajectory"][-2:]
        self.assertLess(abs(last["distance"][1] - last["distance"][0]), 1e-3)
        self.assertTrue((last["kinetic_energy_ratio"] < 1e-7).all() and (last["kinetic_energy_ratio"] > 1e-9).all(),
                        last["kinetic_energy_ratio"])
        self.assertEqual(table(self.folder / "creep.h5").status[0], "flowing")

    def test_a_droplet_at_rest_is_certified_although_its_walls_yield_many_times(self):
        # Friction acts on both parts of the interface that are over an obstacle. The kinetic energy falls by a factor
        # of 10 in 330 t0. The search for a rest begins shortly before max-time.
        done = self.succeed("clogrun", "array", "preset=elastic", "friction=0.2", "line-tension=0.1", "vertices=256",
                            "obstacle-gap=0.3", "obstacle-density=saturated", "box=40", "seeds=1", "max-time=2400",
                            "--output", "rest.h5")
        self.assertIn("clogged after r = 1.3258", done.stdout)

    def test_a_channel_run_writes_h_speed_shape_and_polygons(self):
        self.succeed(
            "clogrun", "channel", "vertices=128", "line-tension=0.3", "terminal-speed=0.08", "--orifice", 0.7,
            "--start", -1.5, "--end", 1, "--sample-interval", 0.1, "--polygon-interval", 1, "--output", "run.h5",
        )
        samples = pandas.read_hdf(self.folder / "run.h5", "trajectory")
        self.assertEqual(samples.h[0], -1.5)
        self.assertGreaterEqual(samples.h.iloc[-1], 1)
        self.assertAlmostEqual(samples.speed_ratio.iloc[-1], 1, places=2)
        self.assertLess(samples.speed_ratio[samples.h.between(-0.4, 0)].min(), 0.7)
        self.assertGreater(samples.shape_parameter.max(), 1.07)
        self.assertAlmostEqual(samples.shape_parameter[0], 1, places=3)
        total = sum(samples[name] for name in samples if name.endswith("_energy")) - samples.spreading_work
        self.assertLess(np.ptp(total), 1e-4 * np.ptp(samples.gravity_energy))
        row = pandas.read_hdf(self.folder / "run.h5", "runs").iloc[0]
        self.assertEqual((row.status, row.obstacle_filling, row.preset), ("passed", "channel", "robust"))
        with h5py.File(self.folder / "run.h5", "r") as file:
            self.assertEqual(file["wedges"].shape, (2, 6))
            self.assertEqual(file["polygons"].shape[1:], (2, 128))
            self.assertEqual(file.attrs["orifice"], b"0.7")
            page = (ROOT / "docs/reference/files.md").read_text()
            for name in [*file["trajectory"].dtype.names, *file.attrs]:
                self.assertIn(f"`{name}`", page)
            for name, meaning in file["trajectory"].attrs.items():
                for unit in re.findall(r"\[(.+?)\]", meaning.decode()):
                    self.assertRegex(page, rf"(?m)^\|[^|]*`{name}`[^|]*\| {re.escape(unit)} \|")

    def test_a_droplet_is_released_whose_springs_would_keep_it_sliding(self):
        """This release was once refused, although a droplet with half the line tension could be released."""
        done = self.succeed("clogrun", "array", "preset=robust", "vertices=64", "box=40", "line-tension=0.1",
                            "obstacle-gap=0.4", "seeds=1", "max-time=1", "--output", "r.h5")
        self.assertTrue(done.stdout.startswith("flowing after "), done.stdout)

    def test_sag_prints_how_far_the_droplet_sinks(self):
        done = self.succeed("clogrun", "sag", "model=sp", "wall-stiffness=1,4")
        lines = done.stdout.splitlines()
        self.assertTrue(lines[0].startswith("model,line_tension,wall_stiffness,sag,top_sag"))
        for line, stiffness in zip(lines[1:], (1, 4), strict=True):
            self.assertAlmostEqual(float(line.split(",")[3]), np.pi / (16 * stiffness), places=5)
            self.assertEqual(line.split(",")[-1], "at_rest")

    def test_sag_ends_if_friction_holds_the_droplet(self):
        """The wall holds the droplet in a neutral balance. At two of eleven line tensions round-off made this balance
        unstable, and the run went on, at 1.2 until max-time. Friction holds the droplet in a range of sags."""
        for line in self.succeed("clogrun", "sag", "preset=elastic", "friction=0.05", "line-tension=1,1.2,2",
                                 "--sample-interval=50").stdout.splitlines()[1:]:
            _, tension, _, sag, _, _, time, status = line.split(",")
            self.assertEqual(status, "at_rest", tension)
            self.assertLess(float(time), 1000, tension)
            known = {"1": 0.064188, "1.2": 0.0566538, "2": 0.0384803}[tension]
            self.assertAlmostEqual(float(sag) / known, 1, delta=0.002)

    def test_presets_are_shown_and_stored(self):
        shown = self.succeed("clogsweep", "--print-config", "preset=literal", "gravity=area").stdout
        for line in ("preset = literal", "perimeter-spring = rest", "wall-contact = vertex", "gravity = area"):
            self.assertIn(line, shown)
        self.succeed("clogrun", "array", "vertices=128", "box=20", "preset=literal", "max-time=1", "--output", "run.h5")
        row = pandas.read_hdf(self.folder / "run.h5", "runs").iloc[0]
        self.assertEqual((row.preset, row.wall_contact, row.self_contact), ("literal", "vertex", "off"))

    def test_ctrl_c_writes_what_there_is(self):
        process = subprocess.Popen(
            [str(BIN / "clogrun"), "array", "vertices=64", "box=20", "obstacle-gap=1.2",
             "--polygon-interval", "100", "--frames", "film",
             "--output", "run.h5"], cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
        )
        self.addCleanup(process.kill)
        time.sleep(1)
        process.send_signal(signal.SIGINT)
        output, printed = process.communicate(timeout=LONGEST)
        self.assertEqual(process.returncode, 75)
        self.assertTrue(re.match("interrupted after r = ", output), output)
        self.assertRegex(printed, r"no film is drawn; PYTHONPATH=\S+ \S+ -m clogsweep droplet run.h5 --output=film --film "
                         r"draws what there is\n$")
        self.assertGreater(len(pandas.read_hdf(self.folder / "run.h5", "trajectory")), 10)

    def test_a_terminal_shows_the_progress(self):
        master, slave = pty.openpty()
        self.addCleanup(os.close, master)
        process = subprocess.Popen(
            [str(BIN / "clogrun"), "array", *SMALL, "obstacle-gap=1.2", "max-time=1e8",
             "--sample-interval", "1e4", "--output", "run.h5"],
            cwd=self.folder, stdout=subprocess.DEVNULL, stderr=slave)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        os.close(slave)
        printed = b""

        def read_on():
            self.assertTrue(select.select([master], [], [], LONGEST)[0], f"nothing more is printed after {printed}")
            return os.read(master, 1000)

        while printed.count(b" left") < 2:
            printed += read_on()
        self.assertRegex(printed.decode(),
                         r"^\rr = \S+ sigma, t = \S+ of at most 1e\+08 t0, .+ so far, at most .+ left\x1b\[K\rr = ")
        process.send_signal(signal.SIGINT)
        while not printed.endswith(b"\r\x1b[K"):
            printed += read_on()
        self.assertEqual(process.wait(), 75)

    def test_a_dry_run_prints_the_config_and_what_it_takes_at_most(self):
        keys = [*SMALL, "line-tension=0.3", "max-time=100", "--polygon-interval", 5]
        printed = self.succeed("clogrun", "array", *keys, "--dry-run", "--output", "run.h5").stdout
        self.assertEqual(self.snapshot(), {})
        self.assertIn("at most 100 t0 in ", printed)
        self.assertNotIn(": 0 s on",
                         self.succeed("clogrun", "array", *SMALL, "max-time=0.1", "--dry-run", "--output", "run.h5").stdout)
        self.assertIn("on this machine", printed)
        samples, polygons = map(int, re.search(r"# at most (\d+) samples and (\d+) polygons", printed).groups())
        # A run with the printed config must give the same result.
        self.write("told.cfg", printed)
        self.succeed("clogrun", "array", "--config", "told.cfg", "--polygon-interval", 5, "--output", "run.h5")
        with h5py.File(self.folder / "run.h5") as file:
            self.assertEqual(file["runs"]["line_tension"][0], 0.3)
            self.assertEqual(file["runs"]["max_time"][0], 100)
            self.assertLessEqual(len(file["polygons"]), polygons)
            self.assertLessEqual(len(file["trajectory"]), samples + 1)
        for system in (["channel", "--output", "c.h5"], ["sag", "line-tension=0.1,0.3"]):
            printed = self.succeed("clogrun", *system, "vertices=64", "max-time=50", "--dry-run").stdout
            self.assertIn("at most 50 t0" if system[0] == "channel" else "at most 100 t0", printed)

    def test_mistakes_get_one_line_and_exit_code_2(self):
        self.write("words.csv", "x,y\n1,2\n3,four\n")
        self.write("outside.csv", "1,25\n")
        self.write("twice.csv", "x,y\n3,3\n\n1,1\n# again\n1,1\n")
        self.write("semicolons.csv", "a;b;diameter" + 60 * ";" + "\n1;2;0.5\n")
        self.write("numbers.csv", "1;2;0.5;7\n")
        self.write("nan.csv", "x,y\n1,2\n3,nan\n")
        self.write("infinite.csv", "1,2,inf\n")
        self.write("header.csv", "x,y\n")
        self.write("empty.csv", "")
        self.write("lattice.cfg", "obstacle-layout = lattice\n")
        out = ["box=20", "--output", "r.h5"]
        for arguments, words in [
            ([*out], ["missing system", "clogrun array"]),
            (["channell", *out], ["channell"]),
            (["array"], ["missing --output"]),
            (["channel", "--output", "r.h5", "--orifice", "0.02"], ["orifice=0.02", "two vertex diameters"]),
            (["channel", "--output", "r.h5", "--orifice", "wide"], ["orifice=wide"]),
            (["channel", "--output", "r.h5", "--start", "0"], ["start=0", "upstream"]),
            (["channel", "--output", "r.h5", "--start", "5"], ["start=5", "upstream"]),
            (["channel", "--output", "r.h5", "--start", "5", "--wedge-angle", "0", "--orifice",
              "2"], ["start=5", "give end, too"]),
            (["channel", "--output", "r.h5", "--start", "-5", "--end", "-6"], ["end=-6", "downstream"]),
            (["channel", *out], ["box=20", "no array"]),
            (["array", "--orifice", "0.6", *out], ["obstacle-layout=channel", "clogrun channel"]),
            (["sag", "--seed", "3"], ["seeds=3", "nothing is random"]),
            (["sag", "line-tension=nan"], ["line-tension=nan"]),
            (["array", "line-tension=1,2", *out], ["2 runs", "one is needed"]),
            (["array", "--output", "no/such/folder/r.h5"], ["no/such/folder"]),
            (["array", "--write-obstacles", "words.csv", *out], ["words.csv", "will not overwrite"]),
            (["array", "--write-obstacles", "r.h5", *out], ["same file"]),
            (["array", "--write-obstacles", "new.csv", "--sample-interval=0", *out], ["--sample-interval=0"]),
            (["array", "--sample-interval=0", *out], ["--sample-interval=0"]),
            (["array", "--polygon-interval=often", *out], ["--polygon-interval=often"]),
            (["array", "--obstacles", "missing.csv", *out], ["missing.csv"]),
            (["array", "--obstacles", "words.csv", *out], ["words.csv line 3", "four"]),
            (["array", "--obstacles", "outside.csv", *out], ["outside.csv", "x=1, y=25", "outside the array"]),
            (["array", "--obstacles", "twice.csv", *out], ["twice.csv line 6", "lists the circle of line 4 again"]),
            (["array", "--obstacles", "nan.csv", *out], ["nan.csv line 3", "nan"]),
            (["array", "--obstacles", "infinite.csv", *out], ["infinite.csv line 1", "inf"]),
            (["array", "--obstacles", "header.csv", *out], ["no obstacles"]),
            (["array", "--obstacles", "semicolons.csv",
              *out], ["the columns have to be x, y", "here they are 'a,b,diameter'"]),
            (["array", "--obstacles", "numbers.csv",
              *out], ["numbers.csv line 1: needs x,y or x,y,diameter, separated by commas"]),
            (["array", "--obstacles", "empty.csv", *out], ["no obstacles"]),
            (["array", "--obstacles", "outside.csv", "obstacle-gap=0.3", *out], ["contradict", "the file's own gap"]),
            (["array", "--obstacles", "outside.csv", "obstacle-layout=lattice", *out], ["contradict"]),
            (["array", "--obstacles", "outside.csv", "--config", "lattice.cfg",
              *out], ["obstacle-layout=lattice", "contradict"]),
        ]:
            with self.subTest(arguments=arguments):
                self.refuse("clogrun", *arguments, words=words)


if __name__ == "__main__":
    unittest.main()
