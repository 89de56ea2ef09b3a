"""Tests that python3 -m clogsweep refine adds values and seeds where the fitted curve needs them. The command must add
the same values and seeds after any interruption."""

import contextlib
import functools
import json
import math
import os
import re
import signal
import subprocess
import sys
import time
import unittest
import unittest.mock

import numpy as np
import pandas

import stored_rows
from stored_rows import fail
from support import BIN, LONGEST, MPIRUN, QUICK, ROOT, TIMING, ProgramTest, children_of, table

sys.path.insert(0, str(ROOT / "analysis"))
from clogsweep.commands import refine  # noqa: E402
from clogsweep.curves.model import Curve  # noqa: E402
from clogsweep.refinement import choice, critical_angle, curve_search, driver, goals  # noqa: E402
from clogsweep.refinement.curve_search import CurveSearch, Options, combinations  # noqa: E402
from clogsweep.refinement.goals import Goal  # noqa: E402
from clogsweep.refinement.membership import Membership, tasks_of  # noqa: E402
from clogsweep.tools.errors import UserError  # noqa: E402

SCHEMA = json.loads(subprocess.run([BIN / "clogsweep", "--schema"], check=True, capture_output=True, text=True).stdout)
NUMBERS = {key["key"]: key for key in SCHEMA["keys"] if key.get("role") == "physics" and key["kind"].startswith("number")}
# Keys of channels have no curve. The angle of lattices has another search.
ELSEWHERE = {name for name, key in NUMBERS.items() if key["scope"] == "channel"} | {"lattice-angle"}
GOAL = "--until=curve=70%"
ENVIRONMENT = {**os.environ, "PYTHONPATH": str(ROOT / "analysis")}
SWEEP = [*QUICK, "obstacle-gap=0.3", "seeds=1..3", "line-tension=0.3,3"]


def descendants(pid):
    children = children_of(pid)
    return children + [more for child in children for more in descendants(child)]


def settings_for(name):
    """Settings to which the key applies."""
    scope = NUMBERS[name]["scope"]
    words = ["vertices=64", "max-time=1", "box=60"]
    if scope == "file":
        return [*words, "obstacles=posts.csv", *(["release=entrance"] if name.startswith("entrance") else [])]
    elastic = ["preset=elastic"] if name in ("perimeter-stiffness-ratio", "perimeter-stiffness", "friction",
                                             "yield-traction") else []
    if scope == "daughters":
        words += ["break-up=daughters", "break-up-neck=0.05"]
    if name == "advancing-angle":
        words.append("wall-tension=0.5")  # Young's angle is then 120 degrees.
    if name == "pitch":
        return [*words, "obstacle-layout=lattice"]
    return [*words, *elastic, *(["obstacle-gap=0.6"] if name != "obstacle-gap" else [])]


def bounds_of(name):
    key = NUMBERS[name]
    if name in ("exit", "entrance", "entrance-from", "entrance-to"):
        return {"exit": [45.0, 55.0], "entrance": [2.0, 8.0], "entrance-from": [2.0, 8.0], "entrance-to": [52.0, 58.0]}[name]
    if key["unit"] == "degrees":
        return [150.0, 170.0] if name == "advancing-angle" else [100.0, 120.0]
    if name in ("contact-range", "pitch"):
        return [0.02, 0.08] if name == "contact-range" else [0.8, 1.2]
    default = float(key["default"]) if re.fullmatch(r"[\d.e-]+", key["default"]) else 0.0
    return [0.5 * (default or 0.2), 0.9 * (default or 0.2)]


class EveryKey(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("posts.csv", "5,5,0.2\n7,5.5,0.3\n")

    @functools.cache
    def tasks_of_points(self, points, *settings):
        self.write("points.csv", points)
        words = [word.replace("posts.csv", str(self.folder / "posts.csv")) for word in settings]
        return tasks_of(refine.planned(BIN / "clogsweep", *words, "--points", self.folder / "points.csv"))

    def tasks(self, keys, settings, values):
        return self.tasks_of_points(driver.points_text(keys, [(one, (1, 1)) for one in values]), *settings)

    def members(self, keys, settings, values):
        return Membership(keys, SCHEMA, values, functools.partial(self.tasks, keys, settings))

    def rows(self, tasks, copies):
        """Rows of the tasks. Columns in which the tasks do not differ contain zeros and empty texts."""
        rows = pandas.DataFrame(0.0, index=range(copies * len(tasks)),
                                columns=[column["name"] for column in SCHEMA["columns"]])
        for column in SCHEMA["columns"]:
            if column["kind"] in ("word", "text"):
                rows[column["name"]] = ""
            if column["name"] in tasks:
                values = list(tasks[column["name"]]) * copies
                rows[column["name"]] = [value or "" for value in values] if column["kind"] in ("word", "text") else [
                    math.nan if value is None else float(value) for value in values]
        return rows.assign(task=range(len(rows)), seed=range(1, len(rows) + 1), model="dp", vertices=64.0)

    def check_membership(self, keys, settings, values):
        """Checks that exactly those rows belong to a value that have all parameters of the value."""
        members, rows = self.members(keys, settings, values), self.rows(self.tasks(keys, settings, values), 2)
        others = []
        for column in SCHEMA["columns"]:
            name = column["name"]
            is_swept = name in {NUMBERS[key]["column"] for key in keys}
            if column.get("parameter_role") not in ("physics", "numerics") or is_swept:
                continue
            other = rows.iloc[-1:].copy()  # a row of another sweep that differs only in this column
            other[name] = "other" if rows[name].dtype == object else other[name].fillna(0) * 1.01 + 7
            others.append(other.assign(task=len(rows) + len(others)))
        found = members.of_values(pandas.concat([rows, *others]))
        self.assertEqual(list(zip(found["task"], found["values"])), list(enumerate([*values, *values])))

    def check_peak(self, name, settings, values):
        """Checks that the search finds the peak of a known curve. The peak is in the middle of the range."""
        search = CurveSearch([name], [values], [1, 2], 100.0, Options(Goal("peak", 0.001), math.inf, 100, False))
        members = self.members([name], settings, search.candidates)
        position = np.log(np.array(search.candidates)[:, 0] / values[0]) / math.log(values[-1] / values[0])
        lengths = np.tile(np.exp(3 - 16 * (position - 0.5) ** 2), 20)
        rows = self.rows(self.tasks([name], settings, search.candidates), 20).assign(
            status="clogged", distance=lengths, time=lengths, steps=lengths, processor_seconds=1.0)
        peak = float(re.search(rf"highest at {name} (\S+) \(", search.known(rows, members))[1])
        self.assertAlmostEqual(math.log(peak / values[0]) / math.log(values[-1] / values[0]), 0.5, delta=0.1)
        next_round = search.next_round(rows, members)
        self.assertTrue(next_round)
        self.assertEqual(next_round[0][1][0], len(rows) + 1, "seeds follow the last one")

    @unittest.mock.patch.dict(curve_search.MOST_VALUES, {1: 12})
    def test_every_key_is_refined_alone_and_with_line_tension_or_refused(self):
        refused = {}
        for name in NUMBERS.keys() - ELSEWHERE:
            with self.subTest(key=name):
                values = choice.preferred_values(bounds_of(name), 6)
                try:
                    self.check_peak(name, settings_for(name), values)
                    self.check_membership([name], settings_for(name), combinations([values]))
                    if name != "line-tension":
                        self.check_membership([name, "line-tension"], settings_for(name),
                                              combinations([values, [0.5, 2.0]]))
                except UserError as error:
                    self.assertNotIn("\n", str(error).strip())
                    refused[name] = str(error)
        self.assertEqual(refused, {})

    def test_a_gap_is_refined_although_the_density_follows_from_it(self):
        for density in ("12.5%", "saturated"):
            with self.subTest(density=density):
                settings = ["vertices=64", "max-time=1", "box=60", f"obstacle-density={density}"]
                self.check_membership(["obstacle-gap"], settings, [(0.3,), (0.4,), (0.5,)])
                self.check_peak("obstacle-gap", settings, [0.3, 0.5])

    def test_runs_of_an_earlier_sweep_belong_if_they_have_what_the_settings_give(self):
        keys, settings = ["obstacle-gap"], ["vertices=64", "max-time=1", "box=60"]
        members, asked = self.members(keys, settings, [(0.3,), (0.4,)]), [(0.3,), (0.35,), (0.4,)]
        rows = self.rows(self.tasks(keys, settings, asked), 1)
        self.assertEqual(list(members.of_values(rows)["values"]), asked)
        rows.loc[1, "obstacle_density"] = 0.1
        self.assertEqual(list(members.of_values(rows)["values"]), [(0.3,), (0.4,)])


class Values(unittest.TestCase):
    def test_preferred_values_lie_between_the_bounds_and_include_them(self):
        values = choice.preferred_values([0.3, 3.0], 100)
        self.assertEqual((values[0], values[-1]), (0.3, 3))
        self.assertLessEqual(len(values), 100)
        self.assertTrue(all(value == float(f"{value:.3g}") for value in values))
        self.assertEqual(choice.spread(values, 7), [0.3, 0.442, 0.649, 0.953, 1.4, 2.05, 3])


class Choice(unittest.TestCase):
    """Tests the choice of blocks of seeds for 41 places. The errors of neighbouring places are correlated."""

    NUMBER = 41

    def blocks(self, kind, clogs=1.0, work=10.0, most=100, work_of_round=400.0, most_work=math.inf):
        place = np.arange(self.NUMBER) - 20
        covariance = 0.25 * np.exp(-0.5 * ((place[:, None] - place) / 3) ** 2)
        curve = Curve(4 - 4 * (place / 10) ** 2 / (1 + (place / 10) ** 2), covariance, 0.0)
        return choice.choose_blocks(curve, np.broadcast_to(4.0 * clogs, self.NUMBER),
                                    np.broadcast_to(4.0 * work, self.NUMBER),
                                    goals.weights(curve, Goal(kind, 0.1, math.exp(2))), np.full(self.NUMBER, most),
                                    work_of_round, most_work)

    def test_blocks_are_spread_where_all_is_alike(self):
        blocks = self.blocks("curve")
        self.assertEqual(blocks.sum(), 10)
        self.assertTrue(all(blocks[begin:begin + 11].sum() >= 2 for begin in (0, 10, 20, 30)))

    def test_cheap_places_and_places_that_clog_come_first(self):
        is_right = np.arange(self.NUMBER) > 20
        self.assertEqual(self.blocks("curve", work=np.where(is_right, 1000.0, 10.0))[is_right].sum(), 0)
        self.assertEqual(self.blocks("curve", clogs=np.where(is_right, 0.01, 1.0))[is_right].sum(), 0)

    def test_a_peak_and_a_crossing_take_blocks_where_they_may_lie(self):
        self.assertGreater(self.blocks("peak")[12:29].sum(), 7)
        crossing = self.blocks("crossing")
        self.assertGreater(crossing[6:15].sum() + crossing[26:35].sum(), 6)

    def test_limits_hold(self):
        self.assertLessEqual(self.blocks("peak", most=2).max(), 2)
        self.assertEqual(self.blocks("curve", most_work=85.0).sum(), 2)
        self.assertEqual(self.blocks("curve", work_of_round=1.0).sum(), 1)
        self.assertEqual(self.blocks("curve", most_work=1.0).sum(), 0)


class RefineTest(ProgramTest):
    def command(self, key, *arguments, launcher=(str(MPIRUN), "2")):
        return [sys.executable, "-m", "clogsweep", "refine", key, *arguments, *(["--", *launcher] if launcher else [])]

    def run_refine(self, key, *arguments, **options):
        return subprocess.run(self.command(key, *arguments, **options), cwd=self.folder, capture_output=True, text=True,
                              timeout=LONGEST, env=ENVIRONMENT)

    def refine(self, key, *arguments, **options):
        done = self.run_refine(key, *arguments, **options)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        return done

    def points(self, output="s.h5"):
        (path,) = self.folder.glob(f"{output}.refine-*.csv")
        return path.read_text()

    def check_equal(self, name, other):
        rows, others = (table(self.folder / n).drop(columns=TIMING) for n in (name, other))
        pandas.testing.assert_frame_equal(rows, others, check_exact=True)


class Refine(RefineTest):
    def test_it_adds_values_and_seeds_until_the_curve_is_known(self):
        done = self.refine("line-tension", *SWEEP, GOAL, "--most-seeds=12", "--output", "s.h5")
        rows = table(self.folder / "s.h5")
        self.assertGreater(len(rows), 7 * 3)
        self.assertTrue(rows.line_tension.between(0.3, 3).all())
        self.assertLessEqual(rows.groupby("line_tension").size().max(), 12)
        self.assertEqual(rows.seed.nunique(), len(rows), "values have seeds of their own")
        last = done.stderr.strip().splitlines()[-1]
        for words in ("curve=70% is reached", "lambda is known within", "highest at line-tension"):
            self.assertIn(words, last)
        points = self.points()
        again = self.refine("line-tension", *SWEEP, GOAL, "--most-seeds=12", "--output", "s.h5", launcher=())
        self.assertEqual(again.stderr.strip().splitlines()[-1], last)
        self.assertEqual((len(table(self.folder / "s.h5")), self.points()), (len(rows), points))
        by_hand = self.succeed("clogsweep", "--config", *(path.name for path in self.folder.glob("*.cfg")), "--output",
                               "h.h5", "--points", *(path.name for path in self.folder.glob("*.csv")))
        self.assertIn(f"{len(rows)}/{len(rows)} done", by_hand.stderr)
        self.check_equal("h.h5", "s.h5")

    def test_kills_and_stops_change_neither_points_nor_rows(self):
        self.refine("line-tension", *SWEEP, GOAL, "--output", "whole.h5")
        stopped, hours = 0, 0.0002
        while (done := self.run_refine("line-tension", *SWEEP, GOAL, "--output", "s.h5",
                                       f"--max-hours={hours}")).returncode == 75:
            stopped += 1
            hours *= 1.1  # On a busy machine a session may make no progress.
            self.assertLess(stopped, 200)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertGreater(stopped, 0)
        for seconds in (1.5, 2, 3, 4):  # After this time SIGKILL is sent to all processes.
            with subprocess.Popen(self.command("line-tension", *SWEEP, GOAL, "--output", "killed.h5"), cwd=self.folder,
                                  env=ENVIRONMENT, stderr=subprocess.DEVNULL, start_new_session=True) as process:
                time.sleep(seconds)
                family = descendants(process.pid)
                for pid in [process.pid, *family]:
                    with contextlib.suppress(ProcessLookupError):
                        os.kill(pid, signal.SIGKILL)
        self.refine("line-tension", *SWEEP, GOAL, "--output", "killed.h5")
        for name in ("s.h5", "killed.h5"):
            self.check_equal(name, "whole.h5")
            self.assertEqual(self.points(name), self.points("whole.h5"))

    def test_an_unfinished_round_is_completed_before_another_is_planned(self):
        self.refine("line-tension", *SWEEP, "--until=curve=95%", "--output", "s.h5")
        (path,) = self.folder.glob("s.h5.refine-*.csv")
        path.write_text(path.read_text() + "1.5,1001..1003\n")  # The points are stored, but their round has not begun.
        self.refine("line-tension", *SWEEP, "--until=curve=95%", "--output", "s.h5")
        self.assertEqual(sorted(table(self.folder / "s.h5").query("line_tension == 1.5 and seed > 1000").seed),
                         [1001, 1002, 1003])

    def test_a_sweep_that_is_there_informs_it(self):
        self.succeed("clogsweep", *QUICK, "obstacle-gap=0.3", "line-tension=0.5,0.9,1.7", "seeds=1..10", "--output", "s.h5")
        first = self.refine("line-tension", *SWEEP, "--budget=0.0000001h", "--output", "s.h5").stderr.splitlines()[-1]
        alone = self.refine("line-tension", *SWEEP, "--budget=0.0000001h", "--output",
                            "alone.h5").stderr.splitlines()[-1]
        self.assertEqual(len(table(self.folder / "s.h5")), 30 + 7 * 3)
        self.assertLess(*(float(re.search(r"within (\S+) %", words)[1]) for words in (first, alone)))

    def test_two_keys_make_a_surface(self):
        done = self.refine("line-tension,obstacle-density", *QUICK[:2], "max-time=60", "obstacle-gap=0.3", "seeds=1..3",
                           "line-tension=0.5,2", "obstacle-density=0.5,0.8", "--until=curve=90%", "--most-seeds=30",
                           "--output", "s.h5")
        rows = table(self.folder / "s.h5")
        self.assertGreaterEqual(len(rows.groupby(["line_tension", "obstacle_density"])), 16)
        self.assertTrue(rows.obstacle_density.between(0.5, 0.8).all())
        self.assertRegex(done.stderr, r"highest at line-tension \S+ \(.*\), obstacle-density 0\.[5-8]")

    def test_all_values_may_have_the_same_seeds_and_a_budget_ends_it(self):
        done = self.refine("line-tension", *SWEEP, "--budget=0.000001h", "--same-seeds", "--output", "s.h5")
        self.assertIn("the budget is used up", done.stderr)
        rows = table(self.folder / "s.h5")
        self.assertEqual(len(rows), 7 * 3)
        for _, of_value in rows.groupby("line_tension"):
            self.assertEqual(sorted(of_value.seed), [1, 2, 3])

    def test_the_peak_over_a_gap_is_found_in_a_saturated_array(self):
        done = self.refine("obstacle-gap", "box=20", "boxes=2", "vertices=64", "max-time=200", "seeds=1..4",
                           "obstacle-density=saturated", "obstacle-gap=0.3,0.5", "--until=peak=50%", "--most-seeds=40",
                           "--output", "s.h5")
        self.assertRegex(done.stderr, r"peak=50% is reached; .*highest at obstacle-gap 0\.[45]")

    def test_a_search_over_a_gap_says_what_else_changes_and_which_runs_did_not_clog(self):
        words = ["box=20", "vertices=64", "max-time=60", "seeds=1..2", "obstacle-gap=0.3,1"]
        note = "obstacle-density=saturated changes the number of obstacles per area with obstacle-gap"
        done = self.refine("obstacle-gap", *words, "obstacle-density=saturated", "--until=crossing=20:60%",
                           "--most-seeds=2", "--output", "s.h5", launcher=())
        self.assertIn(note, done.stderr)
        rows = table(self.folder / "s.h5")
        without = rows.groupby("obstacle_gap").filter(lambda of_gap: not (of_gap.status == "clogged").any())
        self.assertGreater(len(without), 0)
        share = (without.steps * without.vertices).sum() / (rows.steps * rows.vertices).sum()
        named = ", ".join(f"obstacle-gap={gap:g}" for gap in sorted(set(without.obstacle_gap)))
        self.assertIn(f"{len(without)} runs ({100 * share:.0f} % of the computing time) did not clog, at {named}: "
                      "they only show", done.stderr)
        self.assertIn("obstacle-density=12.5% changes", self.refine("obstacle-gap", *words, "--budget=1h", "--dry-run", launcher=()).stderr)
        for more in (["obstacle-density=0.2"], ["obstacle-density=saturated", "--quiet"]):
            self.assertNotIn("changes the number",
                             self.refine("obstacle-gap", *words, *more, "--budget=1h", "--dry-run", launcher=()).stderr)

    def test_a_dry_run_tells_what_the_rounds_may_cost(self):
        printed = self.refine("line-tension", *SWEEP, "--until=curve=20%", "--dry-run", launcher=()).stdout
        for words in ("21 tasks: 7 parameter sets, 3 seeds each", "this is the first round",
                      "core-hours in all if every run clogs"):
            self.assertIn(words, printed)
        printed = self.refine("line-tension", *SWEEP, "--budget=10h", "--dry-run", launcher=()).stdout
        self.assertIn("10 core-hours at most", printed)
        self.assertEqual(self.snapshot(), {})

    def test_mistakes_get_one_line_and_exit_code_2(self):
        (self.folder / "posts.csv").write_text("5,5,0.2\n")
        before = self.snapshot()
        for key, settings, words in [
            ("line-tension", ["line-tension=0.3,3"], "refine needs an end"),
            ("line-tension", ["line-tension=0.3,3", "--budget=0"], "--budget=0"),
            ("line-tension", ["line-tension=0.3,3", "--until=curve"], "--until=curve"),
            ("line-tension", ["line-tension=0.3,3", "--until=curve=0%"], "--until=curve=0%"),
            ("line-tension", ["line-tension=0.3,3", "--until=slope=10%"], "curve, peak, crossing"),
            ("line-tension", ["line-tension=0.3,3", "--until=crossing=5%"], "--until=crossing=5%"),
            ("line-tension", ["line-tension=3,0.3", GOAL], "lower bound"),
            ("line-tension", ["line-tension=0.3", GOAL], "bounds"),
            ("line-tension", ["line-tension=0,3", GOAL], "positive"),
            ("line-tension", ["line-tension=0.3cm,3", GOAL], "line-tension=0.3cm"),
            ("line-tension", ["line-tension=0.3,3", "obstacle-gap=0.3,0.4", GOAL], "another key has a list"),
            ("line-tension", ["line-tension=0.3,3", "seeds=1,3", GOAL], "seeds=1,3"),
            ("line-tension", ["line-tension=0.3,3", "seeds=1..9", "--most-seeds=3", GOAL], "--most-seeds=3"),
            ("line-tension", ["line-tension=0.3,3", "obstacle-layout=wall", GOAL], "no clogging length"),
            ("line-tension", ["line-tension=0.3,3", "--until=critical-angle=1"], "refine lattice-angle"),
            ("line-tension,friction",
             ["line-tension=0.3,3", "friction=0.1,1", "preset=elastic", "--until=crossing=3:10%"], "give one key"),
            ("vertices", ["vertices=64,128", GOAL], "not a number of the physics"), ("nonsense", [GOAL], "no such key"),
            ("obstacle-density", ["obstacle-density=10%,20%", GOAL], "refine needs numbers"),
            ("exit", ["exit=3,4", GOAL], "no user-supplied circles"),
            ("lattice-angle", ["lattice-angle=10,40", GOAL], "obstacle-layout=lattice"),
        ]:
            with self.subTest(settings=settings):
                usual = {"box": "20", "obstacle-gap": "0.3", "vertices": "64", "seeds": "1..3"}
                if "obstacle-layout=wall" in settings:
                    usual = {"vertices": "64"}
                kept = [f"{name}={value}" for name, value in usual.items() if name not in {word.partition("=")[0] for word in settings}]
                done = self.run_refine(key, *kept, *settings, "--output", "no.h5", launcher=())
                self.assertEqual((done.returncode, len(done.stderr.splitlines())), (2, 1), done.stderr)
                self.assertIn(words, done.stderr)
                self.assertEqual(self.snapshot(), before)

    def test_the_option_of_clogsweep_names_the_command(self):
        self.refuse("clogsweep", *SWEEP, "--refine", "line-tension", GOAL, "--output", "no.h5",
                    words=["python3 -m clogsweep refine KEY"])

    def test_warnings_go_on_to_the_launcher_as_the_signal_that_mpirun_forwards(self):
        for number in (signal.SIGUSR1, signal.SIGUSR2, signal.SIGXCPU, signal.SIGHUP, signal.SIGTERM, signal.SIGINT):
            with self.subTest(signal=number):
                words = ["bash", "-c", "trap 'exit 75' USR1; echo ready >&2; sleep 60 & wait; exit 3"]
                command = self.command("line-tension", *SWEEP, GOAL, "--output", "s.h5", launcher=words)
                process = subprocess.Popen(["env", "--default-signal=HUP", *command], cwd=self.folder,
                                           stderr=subprocess.PIPE, text=True, env=ENVIRONMENT)
                with process:
                    self.assertEqual(process.stderr.readline(), "ready\n")
                    process.send_signal(number)
                    self.assertEqual(process.wait(LONGEST), 75)
                self.assertEqual(self.points(), "line-tension,seeds\n0.3,1..3\n0.442,4..6\n0.649,7..9\n0.953,10..12\n1.4,13..15\n2.05,16..18\n3,19..21\n")

    def test_codes_of_the_launcher_are_kept(self):
        for words, code in [("exit 2", 2), ("exit 75", 75), ("kill -9 $$", 137)]:
            with self.subTest(words=words):
                self.assertEqual(self.run_refine("line-tension", *SWEEP, GOAL, "--output", "s.h5", launcher=["bash", "-c", words]).returncode, code)


# This search takes three seconds on one core. In this lattice droplets follow the rows up to an angle of about 19
# degrees.
LATTICE = ["obstacle-layout=lattice", "obstacle-gap=2", "obstacle-diameter=1", "vertices=64", "terminal-speed=0.1", "box=100", "seeds=1"]


class CriticalAngle(RefineTest):
    def angle(self, angles, *arguments, max_time=1000, output="s.h5"):
        return self.refine("lattice-angle", *LATTICE, f"lattice-angle={angles}", f"max-time={max_time}", *arguments,
                           "--output", output)

    def test_it_is_bracketed_by_rows_that_droplets_follow_and_rows_that_they_leave(self):
        last = self.angle("10.01,40", "--until=critical-angle=2").stderr.strip().splitlines()[-1]
        middle, lower, upper = map(float, re.search(r"the critical angle is ([0-9.]+) degrees \(([0-9.]+) "
                                                    r"to ([0-9.]+)\)", last).groups())
        self.assertTrue(lower < middle < upper <= lower + 2)
        rows = table(self.folder / "s.h5")
        self.assertLess(len(rows), 15)
        for row in rows.itertuples():
            # The slope of a droplet that follows the rows is the tangent of the rows' angle. A droplet that leaves the
            # rows moves to the other side.
            if row.lattice_angle <= lower + 0.01:
                self.assertLess(math.tan(math.radians(row.lattice_angle)) - row.lateral_displacement / row.distance, 0.05)
            else:
                self.assertLess(row.lateral_displacement, 0)
        finer = self.angle("10.01,40", "--until=critical-angle=0.5")
        self.assertIn("critical-angle=0.5 is reached", finer.stderr)
        self.assertGreater(len(table(self.folder / "s.h5")), len(rows))

    def test_the_lattice_nearest_to_an_angle_is_that_of_clogsweep(self):
        lattice = ["obstacle-layout=lattice", "pitch=3", "obstacle-diameter=1", "seeds=1", "max-time=1"]
        for words, wanted in [(["box=200"], 13.3), (["box=200", "lattice=triangular"], 21),
                              (["box=200", "lattice=rhombic"], 8),
                              (["box=20"], 13.3), (["box=20"], 24), (["box=200", "lattice=rhombic", "length=13"], 8)]:
            with self.subTest(words=words, wanted=wanted):
                planned = refine.planned(BIN / "clogsweep", *lattice, *words, f"lattice-angle={wanted}")
                angle = critical_angle.nearest_angle(planned, wanted)
                printed = self.plan(*lattice, *words, f"lattice-angle={angle}")
                self.assertIn(f"at {angle:.4g} degrees (tan", printed)
                if words == ["box=20"]:  # The angle of the nearest lattice differs by more than clogsweep allows (0.1).
                    tilts = [math.degrees(math.atan2(q, p)) for p in range(1, 7) for q in range(p) if 4 <= p * p + q * q <= (20 / 3)**2]
                    self.assertAlmostEqual(angle, min(tilts, key=lambda tilt: abs(tilt - wanted)))
                elif "length=13" in words:  # Four columns fit. Each is shifted against the last by q/4 of the pitch.
                    self.assertAlmostEqual(angle, math.degrees(math.atan(1 / 4)))
        self.assertIsNone(critical_angle.nearest_angle(refine.planned(BIN / "clogsweep", *lattice, "box=5.2", "lattice-angle=8"), 8))

    def test_a_lattice_of_a_given_length_is_searched_among_lattices_of_this_length(self):
        words = ["obstacle-layout=lattice", "lattice=rhombic", "obstacle-gap=2", "obstacle-diameter=1", "vertices=64", "terminal-speed=0.1", "box=100", "length=30"]
        printed = self.refine("lattice-angle", *words, "seeds=1", "lattice-angle=11.31,45", "max-time=10", "--budget=1h", "--dry-run").stdout
        angles = [float(line.split("at ")[1].split()[0]) for line in printed.splitlines() if "rhombic lattice" in line]
        self.assertEqual(len(angles), 5)
        for angle in angles:
            self.assertTrue(any(abs(math.tan(math.radians(angle)) * p - round(math.tan(math.radians(angle)) * p)) < 1e-3 for p in range(2, 11)), angle)

    def test_what_does_not_bracket_it_is_said(self):
        for angles, max_time, words in [("32.5,35,40", 1000,
                                         "at 32.47 degrees droplets leave the rows; try smaller angles"),
                                        ("9.46,10.01,11.31", 1000, "droplets follow the rows; try larger angles"),
                                        ("10.01,40", 20, "no droplet went far enough")]:
            with self.subTest(angles=angles):
                self.assertIn(words, self.angle(angles, "--until=critical-angle=2", max_time=max_time, output=f"{max_time}-{angles}.h5").stderr)

    def test_failed_runs_are_counted(self):
        words = ["10.01,40", "--until=critical-angle=2"]
        self.angle(*words, max_time=20)
        number = len(table(self.folder / "s.h5"))
        stored_rows.change(self.folder / "s.h5", lambda rows: fail(rows, rows["task"] == 0, 7.0, 0.01))
        printed = self.angle(*words, max_time=20).stderr
        self.assertIn(f"; 1 of {number} runs failed and do not count", printed)

    def test_a_dry_run_tells_what_the_rounds_may_cost(self):
        printed = self.refine("lattice-angle", *LATTICE, "lattice-angle=10.01,40", "max-time=1000",
                              "--until=critical-angle=0.5", "--dry-run").stdout
        for words in ("5 tasks: 5 parameter sets, 1 seed each", "takes about 2 more rounds, 6 runs"):
            self.assertIn(words, printed)

    def test_mistakes_get_one_line_and_exit_code_2(self):
        for settings, words in [(["lattice-angle=10,40", "--until=curve=20%"], "critical-angle=0.5"),
                                (["lattice-angle=10,40", "--until=critical-angle=0"], "0.001"),
                                (["lattice-angle=10,40", "--until=critical-angle=1", "--same-seeds"], "--same-seeds"),
                                (["lattice-angle=20", "--until=critical-angle=1"], "bounds"),
                                (["lattice-angle=0,40", "--until=critical-angle=1"], "above 0"),
                                (["lattice-angle=40,10", "--until=critical-angle=1"], "lower bound")]:
            with self.subTest(settings=settings):
                done = self.run_refine("lattice-angle", *LATTICE, *settings, "--output", "no.h5", launcher=())
                self.assertEqual((done.returncode, len(done.stderr.splitlines())), (2, 1), done.stderr)
                self.assertIn(words, done.stderr)


class Optimiser(ProgramTest):
    """Runs the ten lines of code in docs/developer/optimiser.md."""

    def test_a_script_may_choose_the_points_and_goes_on_when_called_again(self):
        page = (ROOT / "docs" / "developer" / "optimiser.md").read_text()
        script = re.search(r"```python\n(.*?)```", page, re.DOTALL)[1]
        self.assertLessEqual(sum(bool(line.strip()) for line in script.splitlines()), 13)
        self.write("optimiser.py", script)
        self.write("sweep.cfg", "\n".join(word.replace("=", " = ", 1) for word in [*QUICK, "seeds=1..3"]) + "\n")
        paths = {"PATH": f"{BIN}:{os.environ['PATH']}", "PYTHONPATH": str(ROOT / "analysis")}
        said = [subprocess.run([sys.executable, "optimiser.py"], cwd=self.folder, env=os.environ | paths, check=True, capture_output=True, text=True).stdout
                for _ in range(2)]
        self.assertIn("farthest between", said[0])
        self.assertEqual(said[0], said[1])
        self.assertGreaterEqual(table(self.folder / "sweep.h5").line_tension.nunique(), 6)


if __name__ == "__main__":
    unittest.main()
