import contextlib
import glob
import json
import os
import pathlib
import pty
import re
import signal
import subprocess
import time
import unittest

import h5py
import numpy as np
import pandas

import stored_rows
from support import BIN, BLOCKED, LONGEST, MPI, MPIRUN, QUICK, ROOT, SMALL, STEPS_PER_SNAPSHOT, ProgramTest, SweepTest

# Columns that are not results: they state where and how fast a row was computed.
CIRCUMSTANCES = ["wall_seconds", "processor_seconds", "rank", "host"]
# A library that writes to the file FORK_LOG which process has forked, and which process has started MPI.
FORK_LOGGER = r"""
#define _GNU_SOURCE
#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

static void note(const char *what) {
  FILE *log = fopen(getenv("FORK_LOG"), "a");
  fprintf(log, "%d %s\n", (int)getpid(), what);
  fclose(log);
}
pid_t fork(void) {
  note("forks");
  return ((pid_t(*)(void))dlsym(RTLD_NEXT, "fork"))();
}
int MPI_Init_thread(int *argc, char ***argv, int wanted, int *provided) {
  int code = ((int (*)(int *, char ***, int, int *))dlsym(RTLD_NEXT, "MPI_Init_thread"))(argc, argv, wanted, provided);
  note("has begun MPI");
  return code;
}
"""


def table(path):
    return pandas.read_hdf(path, "runs").sort_values("task").reset_index(drop=True)


class Sweep(ProgramTest):
    def test_no_process_forks_once_it_has_begun_mpi(self):
        (self.folder / "logger.c").write_text(FORK_LOGGER)
        subprocess.run(["cc", "-shared", "-fPIC", "-o", "logger.so", "logger.c", "-ldl"], cwd=self.folder, check=True)
        log = self.folder / "log.txt"
        env = {**os.environ, "LD_PRELOAD": str(self.folder / "logger.so"), "FORK_LOG": str(log),
               "ASAN_OPTIONS": f"{os.environ.get('ASAN_OPTIONS', '')}:verify_asan_link_order=0"}
        for more in (["--dry-run"], ["--output", "s.h5"], ["--output", "s.h5", "--dry-run"]):
            with self.subTest(more=more):
                log.unlink(missing_ok=True)
                self.succeed("clogsweep", *QUICK, "line-tension=0.5", "seeds=1..6", *more, env=env)
                begun, forks = set(), 0
                for line in log.read_text().splitlines():
                    process, what = line.split(" ", 1)
                    forks += what == "forks"
                    self.assertFalse(what == "forks" and process in begun, line)
                    if what != "forks":
                        begun.add(process)
                self.assertGreaterEqual(forks, 1, "the helper")
                self.assertEqual(len(begun), 1)

    def test_rows_do_not_depend_on_the_number_of_ranks(self):
        sweep = [*QUICK, "line-tension=0.3,2", "obstacle-gap=0.2,0.6", "seeds=1..4"]
        tables = {}
        for ranks in (None, 2, 4):
            self.succeed("clogsweep", *sweep, "--output", f"{ranks}.h5", ranks=ranks)
            tables[ranks] = table(self.folder / f"{ranks}.h5").drop(columns=CIRCUMSTANCES)
        self.assertEqual(len(tables[None]), 16)
        self.assertEqual(set(tables[None].status), {"clogged", "flowing"})
        for ranks in (2, 4):
            pandas.testing.assert_frame_equal(tables[ranks], tables[None], check_exact=True)

    def test_every_rank_works_and_a_serving_master_does_not(self):
        sweep = [*SMALL, "max-time=300", "obstacle-gap=0.6", "seeds=1..12"]
        self.succeed("clogsweep", *sweep, "--output", "shared.h5", ranks=2)
        self.assertEqual(set(table(self.folder / "shared.h5")["rank"]), {0, 1})
        self.succeed("clogsweep", *sweep, "--output", "served.h5", "--master-computes", "no", ranks=2)
        self.assertEqual(set(table(self.folder / "served.h5")["rank"]), {1})

    def test_pandas_and_h5py_read_the_table_as_it_is(self):
        self.succeed("clogsweep", *QUICK, "line-tension=0.5", "seeds=3,5", "near-wall-drag=0.1", "--output", "s.h5")
        rows = table(self.folder / "s.h5")
        self.assertEqual(list(rows.seed), [3, 5])
        self.assertEqual(rows.model[0], "dp")
        self.assertEqual(rows.line_tension[0], 0.5)
        self.assertEqual(rows.near_wall_drag[0], 0.1)
        self.assertEqual(rows.obstacle_filling[0], "saturated")
        for column in (
            "task model line_tension wall_stiffness obstacle_gap obstacle_diameter obstacle_density seed vertices "
            "time_step near_wall_drag terminal_speed status distance time mean_speed kinetic_energy_ratio "
            "shape_parameter steps wall_seconds rank host attempt"
        ).split():
            self.assertIn(column, rows.columns)
        with h5py.File(self.folder / "s.h5", "r") as file:
            self.assertEqual(file["runs"].shape, (2,))
            self.assertEqual(set(rows.columns), set(file["runs"].attrs), "every column has its meaning")
            self.assertIn(b"[sigma]", file["runs"].attrs["distance"])
            self.assertIn(b"line-tension = 0.5", file.attrs["config"])
            for name in "version git_describe git_hash command_line start_time mpi_version hdf5_version compiler".split():
                self.assertTrue(file.attrs[name], name)
            self.assertEqual(file.id.get_create_plist().get_version()[0], 0, "the earliest file format")

    def test_the_page_of_the_format_lists_every_column_and_attribute(self):
        self.succeed("clogsweep", *QUICK, "seeds=1", "--output", "s.h5")
        page = (ROOT / "docs/reference/files.md").read_text()
        with h5py.File(self.folder / "s.h5", "r") as file:
            for name in file["runs"].dtype.names:
                self.assertIn(f"`{name}`", page)
            for name in file.attrs:
                self.assertIn(f"`{name}`", page)

    def test_the_stored_config_repeats_the_sweep(self):
        self.succeed("clogsweep", *QUICK, "line-tension=log(0.3,3,2)", "seeds=1..2", "--output", "first.h5")
        with h5py.File(self.folder / "first.h5", "r") as file:
            self.write("again.cfg", file.attrs["config"].decode())
        self.succeed("clogsweep", "--config", "again.cfg", "--output", "second.h5")
        pandas.testing.assert_frame_equal(
            table(self.folder / "first.h5").drop(columns=CIRCUMSTANCES),
            table(self.folder / "second.h5").drop(columns=CIRCUMSTANCES),
            check_exact=True,
        )

    def test_soft_disks_are_swept_over_their_stiffness(self):
        self.succeed("clogsweep", "model=sp", "wall-stiffness=0.3,3", "box=20", "max-time=2000", "seeds=1..5",
                     "--output", "sp.h5", ranks=2)
        rows = table(self.folder / "sp.h5")
        self.assertTrue(rows.line_tension.isna().all())
        soft, stiff = rows[rows.wall_stiffness == 0.3], rows[rows.wall_stiffness == 3]
        self.assertTrue((soft.status == "flowing").all())
        self.assertTrue((stiff.status == "clogged").all())

    def test_the_command_line_overrides_the_config_file(self):
        self.write("sweep.cfg", "line-tension = 1,2  # a list\nseeds=1..3\n\n")
        done = self.succeed("clogsweep", "--config", "sweep.cfg", "--print-config", "seeds=7", "--box", "40")
        for line in ("line-tension = 1,2", "seeds = 7", "box = 40", "vertices = 128"):
            self.assertIn(line + "\n", done.stdout)
        self.assertRegex(done.stdout,
                         r"\n# wall-stiffness = 0\.0\d+\n# obstacle-density = 0\.348\d*\n# vertices = 128\n# time-step = 0\.00\d+\n# area-stiffness = \d+\n# perimeter-stiffness = 0\.1\n# wall-tension = 1\n# receding-angle = 180\n# advancing-angle = 180\n# film-friction = off\n$")
        self.write("printed.cfg", done.stdout)
        self.assertEqual(self.succeed("clogsweep", "--config", "printed.cfg", "--print-config").stdout, done.stdout)

    EXPECTED = r"^# expected [0-9.e+-]+ core-hours \(95 %: [0-9.e+-]+ to [0-9.e+-]+\), from \d+ runs "

    def test_a_dry_run_lists_the_tasks_and_runs_none(self):
        begin = time.time()
        done = self.succeed("clogsweep", *QUICK, "line-tension=lin(0.5,1.5,3)", "seeds=1..4",
                            "--dry-run", "--output", "s.h5")
        elapsed = time.time() - begin
        lines = [line for line in done.stdout.splitlines() if "obstacle spacing" not in line]
        self.assertEqual(len(lines), 1 + 12 + 3)
        self.assertIn("12 tasks: 3 parameter sets, 4 seeds each", lines[-3])
        self.assertRegex(lines[-2], "^# at most [0-9.e+-]+ core-hours on this machine")
        self.assertRegex(lines[-1], self.EXPECTED + r"tried for [0-9.e+-]+ s in total, \d+ of them ended$")
        # The printed time has two significant digits.
        self.assertLess(float(re.search("tried for ([^ ]+) s", lines[-1])[1]), 1.05 * elapsed)
        self.assertEqual(self.snapshot(), {})

    def test_a_dry_run_estimates_from_stored_runs(self):
        sweep = [*QUICK, "line-tension=0.5,1", "--output", "s.h5"]
        self.succeed("clogsweep", *sweep, "seeds=1..3")
        before = self.snapshot()
        expected, left = self.succeed("clogsweep", *sweep, "seeds=1..30", "--dry-run").stdout.splitlines()[-2:]
        self.assertRegex(expected, self.EXPECTED + "in s.h5, 6 of them ended$")
        self.assertEqual(self.snapshot(), before)
        hours = table(self.folder / "s.h5").processor_seconds.sum() / 3600
        self.assertRegex(left,
                         r"^# s.h5 has 6 of 60 runs; 54 to go: expected \S+ core-hours more \(95 %: \S+ to \S+\)$")
        of_all, more = (float(re.search("expected ([^ ]+) ", line)[1]) for line in (expected, left))
        self.assertAlmostEqual(more / of_all, 1 - hours / of_all, delta=0.1)
        # All runs of this command are finished, so there is nothing to estimate.
        printed = self.succeed("clogsweep", *sweep, "seeds=1..3", "--dry-run").stdout.splitlines()[-1]
        self.assertEqual(printed, f"# s.h5 has all 6 runs, which took {hours:.2g} core-hours; nothing is left to do")

    def test_a_dry_run_estimates_remaining_runs_from_their_own_parameter_set(self):
        sweep = [*QUICK, "--output", "s.h5"]
        self.succeed("clogsweep", *sweep, "line-tension=0.5", "seeds=1..6")
        self.succeed("clogsweep", *sweep, "line-tension=1", "seeds=1..3")

        def edit(rows):
            rows["processor_seconds"] = np.where(rows["line_tension"] == 0.5, 1000, 1)

        stored_rows.change(self.folder / "s.h5", edit)
        printed = self.succeed("clogsweep", *sweep, "line-tension=0.5,1", "seeds=1..6",
                               "--dry-run").stdout.splitlines()[-1]
        self.assertIn(f"9 of 12 runs; 3 to go: expected {3 / 3600:.2g} core-hours more ", printed)

    def test_the_expected_cost_is_within_its_interval_and_its_limit(self):
        sweep = [*QUICK, "--output", "s.h5"]
        self.succeed("clogsweep", *sweep, "line-tension=0.1", "seeds=1..6")
        self.succeed("clogsweep", *sweep, "line-tension=1", "seeds=1..2")
        number = r"(\S+) core-hours"
        random = np.random.default_rng(1)
        for factor in (1, 1e4, *random.lognormal(0, 5, 4)):
            seconds = random.lognormal(0, 0.1, 8)

            def edit(rows):
                rows["processor_seconds"] = np.where(rows["line_tension"] == 1, factor, 1) * seconds

            stored_rows.change(self.folder / "s.h5", edit)
            for more in (["line-tension=0.1,1", "seeds=1..6"], ["line-tension=0.1,1,2", "seeds=1..30"],
                         ["line-tension=0.1,1", "seeds=1..12", "--until-precision=20%", "--most-seeds=40"]):
                printed = self.succeed("clogsweep", *sweep, *more, "--dry-run").stdout
                bound = float(re.search(f"at most {number}", printed)[1])
                for expected, lower, upper, limit in re.findall(r"expected (\S+) core-hours \(95 %: (\S+) to ([^)]+)\)(?:, at most (\S+))?", printed):
                    # The numbers are printed with two or three digits.
                    self.assertLessEqual(float(lower), 1.05 * float(expected), printed)
                    self.assertLessEqual(float(expected), 1.05 * float(upper), printed)
                    if limit:
                        self.assertLessEqual(float(upper), 1.05 * float(limit), printed)
                    elif "all rounds" not in printed:
                        self.assertLessEqual(float(upper), 1.05 * bound, printed)

    def test_runs_beyond_shorter_lists_stay_and_are_counted_everywhere(self):
        sweep = [*QUICK, "line-tension=0.5,1", "--output", "s.h5"]
        self.assertNotIn("beyond", self.succeed("clogsweep", *sweep, "seeds=1..5").stderr)
        self.assertIn("10 rows of 10 runs, all undamaged", self.succeed("clogsweep", "verify", "s.h5").stdout)
        printed = self.succeed("clogsweep", *sweep, "seeds=1..3").stderr
        self.assertIn("s.h5 also has 4 runs outside this command's lists; they are kept", printed)
        beyond = "(4 outside the lists of its last command)"
        self.assertIn(f"10 rows of 10 runs {beyond}, all undamaged", self.succeed("clogsweep", "verify", "s.h5").stdout)
        status = self.succeed("clogsweep", "status", "s.h5").stdout
        self.assertIn(f"10 of 10 runs finished {beyond}, ", status)
        self.assertIn("; complete", status)
        status = json.loads(self.succeed("clogsweep", "status", "s.h5", "--format", "json").stdout)
        self.assertEqual((status["runs"], status["finished"], status["runs_beyond_lists"]), (10, 10, 4))

    def test_an_array_that_may_repeat_is_named_once_when_the_sweep_starts(self):
        sweep = [*SMALL, "max-time=700", "seeds=1", "--output", "s.h5"]
        repeats = "may travel farther than the length of their array"
        self.assertEqual(self.succeed("clogsweep", *sweep, ranks=2).stderr.count(repeats), 1)
        self.assertNotIn(repeats, self.succeed("clogsweep", *sweep).stderr, "nothing is left to do")
        self.assertEqual(self.succeed("clogsweep", *sweep[:-1], "quiet.h5", "--quiet").stderr, "")

    def test_a_dry_run_warns_of_lengths_below_an_obstacle_spacing(self):
        keys = ["line-tension=1", "vertices=32", "box=20", "max-time=3000"]
        self.assertNotIn("obstacle spacing", self.succeed("clogsweep", *keys, "seeds=1..8", "--dry-run").stdout)
        saturated = [*keys, "obstacle-density=saturated"]
        self.assertRegex(self.succeed("clogsweep", *saturated, "seeds=1..8", "--dry-run").stdout,
                         r"# \d of \d runs clogged within one obstacle spacing \(0.5 sigma\)")
        # Like clogfit, the message counts all runs of the file, even runs with seeds beyond those of the command.
        self.succeed("clogsweep", *saturated, "seeds=1..8", "--output", "s.h5")
        self.assertIn("clogged within one obstacle spacing",
                      self.succeed("clogsweep", *saturated, "seeds=1..9", "--dry-run", "--output", "s.h5").stdout)
        self.assertIn("below_spacing", self.succeed("clogfit", "s.h5", "--format", "csv").stdout)

    def test_a_dry_run_of_runs_that_cannot_begin_fails(self):
        done = self.run_program("clogsweep", *BLOCKED, "seeds=64", "--dry-run")
        self.assertEqual(done.returncode, 1)
        self.assertIn("no trial run can start; the first one: cannot release the droplet", done.stderr)

    def test_a_dry_run_of_many_tasks_shows_the_first_and_the_last(self):
        for seeds, num_tasks in [("1..500", 1000), ("1..501", 1002), ("1..1000000", 2_000_000)]:
            with self.subTest(tasks=num_tasks):
                printed = self.plan(*QUICK, "line-tension=2,3", f"seeds={seeds}")
                tasks = [int(line.split()[0]) for line in printed.splitlines() if line[0].isdigit()]
                self.assertIn(f"# {num_tasks} tasks: 2 parameter sets, {num_tasks // 2} seeds each", printed)
                if num_tasks == 1000:
                    self.assertEqual(tasks, list(range(1000)))
                    self.assertNotIn("more", printed)
                else:
                    self.assertEqual(tasks, [*range(20), *range(num_tasks - 20, num_tasks)])
                    self.assertIn(f"# ... {num_tasks - 40} more ...", printed)

    def test_a_dry_run_as_json_has_a_line_with_the_tasks_then_one_with_the_cost(self):
        sweep = [*QUICK, "line-tension=0.5,1", "--output", "s.h5"]
        self.succeed("clogsweep", *sweep, "seeds=1..3")  # runs enough for an estimate, so all dry runs print the same numbers
        for more, fields in [(["seeds=1..3"], []), (["seeds=1..30"], ["sample", "left"]), (["seeds=1..501"], ["sample", "left"]),
                             (["seeds=1..12", "--until-precision=20%", "--most-seeds=40"], ["sample", "left", "all_rounds"])]:
            with self.subTest(more=more):
                text = self.succeed("clogsweep", *sweep, *more, "--dry-run", "--format", "text").stdout
                plan, cost = map(json.loads, self.succeed("clogsweep", *sweep, *more, "--dry-run", "--format=json").stdout.splitlines())
                self.assertEqual(plan["text"] + cost["text"], text)
                names = text.splitlines()[0].removeprefix("# ").split()
                lines = [[float(word) for word in line.split()] for line in text.splitlines() if line[0].isdigit()]
                self.assertEqual([[task[name] for name in names] for task in plan["tasks"]], lines)
                self.assertIn(f"# {plan['number_of_tasks']} tasks: {plan['parameter_sets']} parameter sets, ", text)
                self.assertEqual((cost["runs"], cost["finished"], [name for name in ("sample", "left", "all_rounds") if name in cost]),
                                 (plan["number_of_tasks"], 6, fields))
                hours = [f"{of['expected']:.2g} core-hours (95 %: {of['lower']:.2g} to {of['upper']:.2g})" for of in self.estimates(cost)]
                more_hours = [words.replace(" more", "") for words in re.findall(r"expected (\S+ core-hours(?: more)? \([^)]+\))", text)]
                self.assertEqual(hours, more_hours)
                if fields:
                    self.assertIn(f"at most {cost['at_most']:.3g} core-hours on this machine, {cost['us_per_step']:.3g} us per step", text)
                    self.assertIn(f"from {cost['sample']['runs']} runs {cost['sample']['source']}, {cost['sample']['ended']} of them ended", text)
                else:
                    self.assertIn(f"which took {cost['spent']:.2g} core-hours", text)

    def estimates(self, cost):
        """The parts of `cost` that contain an estimate, in the order in which the text prints them."""
        rounds = cost.get("all_rounds", {})
        return [of for of in (cost, cost.get("left"), rounds.get("if_all_clog"), rounds.get("if_few_clog")) if of and "expected" in of]

    def test_a_format_is_only_for_dry_runs(self):
        for words, reason in [(["--format=json"], "--format needs --dry-run"), (["--format=csv", "--dry-run"], "is not one of text, json"),
                              (["--format=json", "--dry-run", "--print-config"], "--print-config prints no JSON")]:
            self.refuse("clogsweep", *QUICK, *words, words=[reason])

    def test_a_dry_run_within_the_box_and_the_tested_range_has_nothing_to_add(self):
        printed = self.plan(*QUICK)
        self.assertNotIn("box", printed)
        self.assertNotIn("soundness", printed)
        printed = self.plan(*SMALL, "max-time=2000")
        self.assertIn("# droplets of 1 of 1 parameter set may travel farther than the length of their array ", printed)
        self.assertIn("# outside the range tested for soundness (handbook, How far to trust it): line-tension=30 ",
                      self.plan(*QUICK, "line-tension=30"))

    def test_what_was_not_tested_is_said_once_when_the_sweep_starts(self):
        sweep = [*SMALL, "max-time=1", "line-tension=0.05,30", "seeds=1..3", "--output", "s.h5"]
        lines = self.succeed("clogsweep", *sweep, ranks=2).stderr.splitlines()
        self.assertEqual(sum("outside the range tested for soundness" in line and "line-tension=30 " in line
                             for line in lines), 1, lines)
        self.assertFalse(any("line-tension=0.05" in line for line in lines), lines)
        self.assertNotIn("soundness", self.succeed("clogsweep", *sweep).stderr, "nothing is left to do")
        self.assertEqual(self.succeed("clogsweep", *sweep[:-1], "quiet.h5", "--quiet").stderr, "")

    def test_one_of_a_kind_is_printed_in_the_singular(self):
        sweep = [*QUICK, "line-tension=0.5", "seeds=1", "--output", "s.h5"]
        printed = self.succeed("clogsweep", *sweep, "--dry-run").stdout
        self.assertIn("# 1 task: 1 parameter set, 1 seed each\n", printed)
        self.assertIn(", from 1 run tried ", printed)
        self.assertIn("1 run on 1 computing rank, results go to s.h5\n", self.succeed("clogsweep", *sweep).stderr)
        self.assertIn("s.h5 has 1 of 1 run; there is nothing left to do\n", self.succeed("clogsweep", *sweep).stderr)
        self.assertIn("s.h5: 1 of 1 run finished, ", self.succeed("clogsweep", "status", "s.h5").stdout)
        self.assertIn("s.h5: 1 row of 1 run, all undamaged\n", self.succeed("clogsweep", "verify", "s.h5").stdout)
        self.assertIn("whole.h5: 1 undamaged row\n",
                      self.succeed("clogsweep", "salvage", "s.h5", "--output", "whole.h5").stdout)

    def test_help_and_version(self):
        self.assertIn("--line-tension", self.succeed("clogsweep", "--help").stdout)
        version = self.succeed("clogsweep", "--version").stdout
        for word in ("clogsweep", "git", "compiler", f"MPI: {MPI} ", "HDF5: 1."):
            self.assertIn(word, version)

    def test_it_tells_how_it_is_getting_on(self):
        done = self.succeed("clogsweep", *QUICK, "seeds=1..3", "--output", "s.h5")
        self.assertIn("3/3 done, 0 running", done.stderr)

    def test_a_task_that_cannot_run_is_a_row(self):
        self.succeed("clogsweep", *BLOCKED, "seeds=63..66", "--output", "s.h5", ranks=2)
        rows = table(self.folder / "s.h5")
        self.assertEqual(len(rows), 4)
        failed = rows[rows.status == "failed"]
        self.assertEqual(set(failed.seed), {64})
        self.assertTrue(failed.message.str.contains("no void near the centre of the box").all())


class Stopped(SweepTest):
    LONG = ["vertices=64", "box=20", "obstacle-gap=1.2", "max-time=1e9", "seeds=1..4",
            "--report-seconds=0.1", "--output", "s.h5"]

    def ranks_that_move(self):
        return set(table(self.folder / "s.h5").query("status == 'running' and distance > 0")["rank"])

    def stop(self, command, signal_number, ranks):
        process = subprocess.Popen(command, cwd=self.folder, stderr=subprocess.PIPE, text=True)
        self.addCleanup(self.kill_all, process)
        self.wait_for(lambda: process.poll() is not None or
                      (self.folder / "s.h5").exists() and self.ranks_that_move() == set(range(ranks)))
        process.send_signal(signal_number)
        _, error = process.communicate(timeout=LONGEST)
        return process.returncode, error

    def check_rows(self):
        rows = table(self.folder / "s.h5")
        interrupted = rows[rows.status == "interrupted"]
        self.assertGreater(len(interrupted), 0)
        self.assertTrue((interrupted.distance > 0).all())
        self.assertTrue(np.isfinite(interrupted.time).all())

    def test_ctrl_c_keeps_the_distances_so_far(self):
        code, error = self.stop([str(BIN / "clogsweep"), *self.LONG], signal.SIGINT, ranks=1)
        self.assertEqual(code, 75, error)
        self.assertIn("stopped by a signal", error)
        self.check_rows()

    def test_ctrl_c_under_mpirun_keeps_the_distances_so_far(self):
        self.stop([str(MPIRUN), "2", str(BIN / "clogsweep"), *self.LONG], signal.SIGINT, ranks=2)
        self.check_rows()
        rows = table(self.folder / "s.h5")
        self.assertEqual(set(rows[rows.status == "interrupted"]["rank"]), {0, 1})


class Isolated(ProgramTest):
    """Tests tasks that run in their own processes."""

    LONG = [*SMALL, "obstacle-gap=1.2", "--output", "s.h5"]

    def start(self, *arguments):
        process = subprocess.Popen([str(BIN / "clogsweep"), *self.LONG, *arguments], cwd=self.folder,
                                   stderr=subprocess.PIPE, text=True)
        self.addCleanup(process.kill)
        return process

    def children_of(self, pid):
        # `pgrep` is not used here: on a busy machine a run might end before `pgrep` has searched for it.
        children = []
        for thread in glob.glob(f"/proc/{pid}/task/*/children"):
            with contextlib.suppress(FileNotFoundError, ProcessLookupError):  # the thread may have ended since
                children += [int(child) for child in pathlib.Path(thread).read_text().split()]
        return children

    def computing_process(self, rank):
        """The process that the helper of the rank has started."""
        deadline = time.time() + LONGEST
        while time.time() < deadline:
            found = [process for helper in self.children_of(rank.pid) for process in self.children_of(helper)]
            if found:
                return found[0]
            self.assertIsNone(rank.poll(), "the sweep is over")
            time.sleep(0.005)
        self.fail("no process computes")

    def wait_for_end_of(self, processes):
        self.wait_for(lambda: not any(pathlib.Path(f"/proc/{pid}").exists() for pid in processes))

    def test_rows_are_the_same_without_isolation(self):
        sweep = [*QUICK, "line-tension=0.3,2", "obstacle-gap=0.2,0.6", "seeds=1..4", "--output"]
        self.succeed("clogsweep", *sweep, "yes.h5", "--isolate=yes", ranks=2)
        self.succeed("clogsweep", *sweep, "no.h5", "--isolate=no", ranks=2)
        pandas.testing.assert_frame_equal(*(table(self.folder / name).drop(columns=CIRCUMSTANCES)
                                            for name in ("yes.h5", "no.h5")), check_exact=True)

    def test_a_crash_fails_one_task_and_the_sweep_goes_on(self):
        process = self.start("--attempts=1", "seeds=1..2", "max-time=5e3")
        os.kill(self.computing_process(process), signal.SIGSEGV)
        error = self.ended(process)
        rows = table(self.folder / "s.h5")
        self.assertEqual(list(rows.status), ["failed", "flowing"])
        self.assertEqual(rows.message[0], "its process was ended by SIGSEGV (Segmentation fault)")
        self.assertRegex(error,
                         r"(?m)^\d\d:\d\d:\d\d task 0 rank 0: failed, attempt 1: its process was ended by SIGSEGV")

    def test_a_task_that_crashed_is_tried_again(self):
        process = self.start("seeds=1", "max-time=5e3")
        os.kill(self.computing_process(process), signal.SIGKILL)
        error = self.ended(process)
        self.assertIn("attempt 1, will be tried again: its process was ended by SIGKILL", error)
        rows = table(self.folder / "s.h5")
        self.assertEqual((rows.status[0], rows.attempt[0], rows.message[0]), ("flowing", 2, ""))

    def test_a_process_that_hangs_does_not_keep_the_sweep_from_stopping(self):
        sweep = ["seeds=1", "max-time=2e4", "--report-seconds=0.1"]
        process = self.start(*sweep)
        computing = self.computing_process(process)
        # The test waits for the first snapshot, because without a snapshot the resumed run would start at its release.
        self.wait_for(lambda: table(self.folder / "s.h5").steps.gt(STEPS_PER_SNAPSHOT).any())
        os.kill(computing, signal.SIGSTOP)
        time.sleep(0.5)  # During this time the rank requests reports.
        process.send_signal(signal.SIGTERM)
        self.ended(process, 75)
        rows = table(self.folder / "s.h5")
        self.assertEqual(rows.status[0], "interrupted")
        self.assertGreater(rows.distance[0], 0, "the last report counts")
        self.wait_for_end_of([computing])
        hung_at = rows.distance[0]
        # The process stops again before its first report, so the row must stay as it was stored.
        process = self.start(*sweep[:2], "--report-seconds=100")
        os.kill(self.computing_process(process), signal.SIGSTOP)
        process.send_signal(signal.SIGTERM)
        self.ended(process, 75)
        self.assertEqual(table(self.folder / "s.h5").distance[0], hung_at)
        self.assertIn("1 run resumes from the last checkpoint", self.succeed("clogsweep", *self.LONG, *sweep).stderr)
        self.assertEqual(table(self.folder / "s.h5").status[0], "flowing")

    def test_a_sweep_goes_on_without_the_helper(self):
        process = self.start("seeds=1..2", "max-time=5e3")
        self.computing_process(process)
        os.kill(self.children_of(process.pid)[0], signal.SIGKILL)
        error = self.ended(process)
        self.assertEqual(error.count("the helper process of its rank was killed"), 1, error)
        self.assertEqual(list(table(self.folder / "s.h5").status), ["flowing", "flowing"])

    def test_no_process_outlives_its_rank(self):
        process = self.start("seeds=1", "max-time=1e9")
        processes = [*self.children_of(process.pid), self.computing_process(process)]
        process.kill()
        process.communicate()
        self.wait_for_end_of(processes)


class Told(ProgramTest):
    """Tests the messages of a running sweep."""

    RUNS = [*QUICK, "seeds=1..3", "--output", "s.h5"]
    EVENT = r"\d\d:\d\d:\d\d task \d rank 0: (starts|(clogged|flowing) at \S+ sigma after \S+ t0) \(Gamma=1, gap=0.2, seed \d\)"

    def test_verbose_tells_of_every_start_and_end(self):
        lines = self.succeed("clogsweep", *self.RUNS, "--verbose").stderr.splitlines()
        self.assertEqual(len([line for line in lines if re.fullmatch(self.EVENT, line)]), 6, lines)
        self.assertIn("3/3 done", lines[-1])

    def test_by_default_only_what_is_out_of_the_ordinary(self):
        self.assertNotIn("task", self.succeed("clogsweep", *self.RUNS).stderr)
        failing = self.run_program("clogsweep", *BLOCKED, "seeds=64", "--output", "f.h5").stderr
        self.assertRegex(failing, r"(?m)^\S+ task 0 rank 0: failed, attempt 1, will be tried again: "
                                  r"cannot release the droplet .*seed 64\)$")
        self.assertRegex(failing, r"(?m)^\S+ task 0 rank 0: failed, attempt 2: cannot release the droplet .*seed 64\)$")

    def test_quiet_says_nothing(self):
        self.assertEqual(self.succeed("clogsweep", *self.RUNS, "--quiet").stderr, "")

    def test_a_terminal_s_progress_line_stays_below_the_events(self):
        ours, theirs = pty.openpty()
        process = subprocess.Popen([str(BIN / "clogsweep"), *self.RUNS, "--verbose"], cwd=self.folder, stderr=theirs)
        os.close(theirs)
        seen = b""
        try:
            while part := os.read(ours, 4096):
                seen += part
        except OSError:  # The other end has been closed.
            pass
        os.close(ours)
        self.assertEqual(process.wait(), 0)
        # `lines` is the final content of the screen. A carriage return makes the following text overwrite the line, and
        # the escape sequence clears the rest of the line.
        lines = []
        for line in seen.decode().removesuffix("\r\n").split("\r\n"):
            lines.append(line.split("\r")[-1].removesuffix("\x1b[K"))
            self.assertTrue("\r" not in line or line.endswith("\x1b[K"), line)
        self.assertEqual(len([line for line in lines if re.fullmatch(self.EVENT, line)]), 6, lines)
        self.assertEqual(len([line for line in lines if " done, " in line]), 1, lines)
        self.assertIn("3/3 done", lines[-1])


class Refusals(ProgramTest):
    def test_mistakes_get_one_line_and_exit_code_2(self):
        self.write("bad.cfg", "line-tenson = 1\n")
        self.write("torn.cfg", "line-tension 1\n")
        self.write("empty.cfg", "line-tension =\n")
        self.write("twice.cfg", "box = 20\nbox = 30\n")
        self.write("taken.h5", "something of the user's")
        out = ["--output", "s.h5"]
        for arguments, words in [
            ([], ["missing --output"]),
            (["--line-tenson=1", *out], ["--line-tenson", "did you mean --line-tension"]),
            (["--frobnicate", *out], ["unknown option", "--frobnicate"]),
            (["line-tenson=1", *out], ["did you mean line-tension"]),
            (["stray", *out], ["no place for 'stray'"]),
            (["line-tension=soft", *out], ["line-tension=soft", "not a finite number"]),
            (["line-tension=-1", *out], ["line-tension=-1"]),
            (["seeds=3..1", *out], ["seeds=3..1", "no values"]),
            (["seeds=1,1", *out], ["twice"]),
            (["model=sph", *out], ["model=sph", "dp, sp"]),
            (["model=sp", "wall-stiffness=1", "line-tension=1,2", *out], ["does not depend on it"]),
            (["--config", "missing.cfg", *out], ["missing.cfg"]),
            (["--config", "bad.cfg", *out], ["bad.cfg", "did you mean line-tension"]),
            (["--config", "torn.cfg", *out], ["torn.cfg", "key = value"]),
            (["--config", "empty.cfg", *out], ["empty.cfg", "line-tension"]),
            (["--config", "twice.cfg", *out], ["twice.cfg", "box", "twice"]),
            (["seeds=" + ",".join(map(str, range(1, 2000))), *out], ["seeds=1,2,3", "too long"]),
            (["--master-computes=perhaps", *out], ["auto, yes, no"]),
            (["--output", "taken.h5"], ["taken.h5", "not an HDF5 file"]),
            (["--max-hours=soon", *out], ["max-hours"]),
            (["--attempts=0", *out], ["--attempts=0", "1..1000"]),
            (["--report-seconds=0", *out], ["--report-seconds=0"]),
            (["--report-seconds=nan", *out], ["invalid --report-seconds=nan"]),
            (["--report-seconds=1e300", *out], ["invalid --report-seconds=1e300"]),
            (["--isolate=perhaps", *out], ["--isolate=perhaps", "yes, no"]),
            (["--verbose", "--quiet", *out], ["--verbose and --quiet"]),
            (["--output", "no/such/folder/s.h5"], ["no/such/folder"]),
        ]:
            with self.subTest(arguments=arguments):
                self.refuse("clogsweep", *arguments, words=words)

    def test_a_mistake_ends_all_ranks(self):
        done = self.run_program("clogsweep", "line-tension=-1", "--output", "s.h5", ranks=2)
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertEqual(done.stderr.count("invalid line-tension=-1"), 1)

    def test_a_density_that_not_every_seed_reaches_is_refused_with_the_largest(self):
        keys = ["vertices=64", "box=20", "max-time=60"]
        # The second number of each pair is larger than the largest possible density by one in the fourth digit.
        for geometry, too_large in [([], ["9", "2.623"]), (["obstacle-diameter-spread=0.5"], ["6", "3.766"])]:
            largest = f"{float(too_large[1]) - 0.001:.3f}"
            for density in too_large:
                sweep = [*keys, *geometry, f"obstacle-density=1,{density}", "seeds=1..3"]
                for program, arguments in [("clogsweep", sweep), ("clogsweep", [*sweep, "--dry-run"]),
                                           ("clogrun", ["array", *keys, *geometry, f"obstacle-density={density}"])]:
                    self.refuse(program, *arguments, "--output", "s.h5",
                                words=[f"invalid obstacle-density={density} ", f"use at most {largest}, or saturated"])
            self.succeed("clogsweep", *keys, *geometry, f"obstacle-density={largest}",
                         "seeds=1..20", "--output", "s.h5")
            self.assertNotIn("failed", set(table(self.folder / "s.h5").status))
            self.succeed("clogrun", "array", *keys, *geometry, f"obstacle-density={largest}", "--output", "r.h5")
            for name in ("s.h5", "r.h5"):
                (self.folder / name).unlink()


if __name__ == "__main__":
    unittest.main()
