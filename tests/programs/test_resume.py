"""Tests sweeps that are stopped or changed, or that contain mistakes. No row may be lost, and the same command must
resume the sweep."""

import json
import os
import re
import shutil
import signal
import struct
import subprocess
import unittest
import zlib

import h5py
import numpy as np
import stored_rows
from support import (BIN, BLOCKED, ENDLESS, FEW_LONG, LONGEST, MPI, QUICK, ROOT, SLOW, STEPS_PER_SNAPSHOT, SWEEP,
                     ProgramTest, SweepTest, children_of, table, undisturbed)

LIBRARY_THAT_HANDLES_HANGUPS = """#include <signal.h>
static void ignore(int number) { (void)number; }
__attribute__((constructor)) static void begin(void) { signal(SIGHUP, ignore); }
"""
SEVERAL_SLOW = [word.replace("seeds=1", "seeds=1..3").replace("max-time=2e4", "max-time=8e3") for word in SLOW]


class Resumed(SweepTest):
    def journal(self):
        """The number of records in the journal, and the number of records with snapshots."""
        words = self.run_program("clogsweep", "verify", "s.h5").stdout
        found = re.search(r"s.h5.journal: (\d+) records?, (\d+) of them with snapshots", words)
        return (int(found[1]), int(found[2])) if found else (0, 0)

    def stop_with_unfinished_runs(self, sweep):
        """Stops the sweep while a run has a snapshot, which may take several attempts. @return the rows of unfinished
        runs"""
        for attempt in range(100):
            # Each attempt runs longer than the one before, because on a busy machine a snapshot takes longer.
            done = self.run_program("clogsweep", *sweep, f"--max-hours={0.0001 * 1.05**attempt:.6f}")
            if done.returncode != 75:
                (self.folder / "s.h5").resolve().unlink()  # The sweep is complete, so it starts again.
                continue
            self.assertIn("stopped by --max-hours", done.stderr)
            rows = table(self.folder / "s.h5")
            unfinished = rows[rows.status == "interrupted"]
            if (unfinished.steps > STEPS_PER_SNAPSHOT).any():
                return unfinished
        self.fail("no stop met a run with a snapshot")

    def stop_with_a_snapshot(self, sweep, signal_number, **options):
        """Stops a sweep. @return the sweep's process and its messages, or nothing if the sweep ended earlier"""
        process = self.start(*sweep, **options)
        self.wait_for(lambda: process.poll() is not None or (self.folder / "s.h5").exists() and
                      (table(self.folder / "s.h5").query("status == 'running'").steps > STEPS_PER_SNAPSHOT).any())
        process.send_signal(signal_number)
        _, error = process.communicate(timeout=LONGEST)
        return (process, error) if (self.folder / "s.h5.journal").exists() else None

    def test_a_signal_stops_and_the_same_command_resumes(self):
        # A fast machine needs more time to stop.
        sweep = [word.replace("max-time=2e4", "max-time=8e4") for word in SLOW]
        for signal_number in (signal.SIGUSR1, signal.SIGINT, signal.SIGTERM):
            process, error = self.until_in_time(lambda: self.stop_with_a_snapshot(sweep, signal_number))
            if signal_number == signal.SIGUSR1:  # A second after any other signal, mpirun kills the remaining ranks.
                self.assertIn("the same command resumes the sweep", error)
                rows = table(self.folder / "s.h5")
                self.assertGreater((rows.status == "interrupted").sum(), 0)
            if MPI == "Open MPI":  # MPICH's mpirun may end with 0 after any signal.
                self.assertEqual(process.returncode, 75 if signal_number == signal.SIGUSR1 else 1, error)
        done = self.succeed("clogsweep", *sweep, ranks=2)
        self.assertRegex(done.stderr, "1 run resumes from the last checkpoint|2 runs resume from the last checkpoint")
        self.check_equal("s.h5", undisturbed(sweep))
        again = self.succeed("clogsweep", *sweep, ranks=2)
        self.assertIn("there is nothing left to do", again.stderr)
        self.check_equal("s.h5", undisturbed(sweep))

    def test_a_rank_alone_stops_at_every_warning_and_its_processes_ignore_it(self):
        for warned in (signal.SIGUSR2, signal.SIGXCPU, signal.SIGHUP):
            with self.subTest(signal=warned):
                # The sweep runs without mpirun.
                process = self.start(*ENDLESS, launcher="env", ranks="--default-signal=HUP")
                self.wait_for(lambda: (self.folder / "s.h5").exists() and
                              (table(self.folder / "s.h5").status == "running").any())
                helper, = children_of(process.pid)
                for pid in (*children_of(helper), helper, process.pid):
                    os.kill(pid, warned)
                _, error = process.communicate(timeout=LONGEST)
                self.assertEqual((process.returncode, set(table(self.folder / "s.h5").status)), (75, {"interrupted"}), error)
                self.assertNotIn("helper", error)

    def test_under_nohup_it_survives_its_terminal(self):
        # A library may take over the signal before the program begins, as UCX does under Open MPI 5.
        (self.folder / "library.c").write_text(LIBRARY_THAT_HANDLES_HANGUPS)
        subprocess.run(["cc", "-shared", "-fPIC", "-o", "library.so", "library.c"], cwd=self.folder, check=True)
        launcher = self.folder / "launcher"
        for preloaded in ("", self.folder / "library.so"):
            with self.subTest(preloaded=preloaded):
                launcher.write_text(f'#!/bin/sh\nshift\nexec nohup env LD_PRELOAD={preloaded} '
                                    'ASAN_OPTIONS="$ASAN_OPTIONS:verify_asan_link_order=0" "$@"\n')
                launcher.chmod(0o755)
                (self.folder / "s.h5").unlink(missing_ok=True)
                process = self.start(*FEW_LONG, launcher=launcher, ranks=1)
                self.wait_for(lambda: process.poll() is not None or (self.folder / "s.h5").exists())
                process.send_signal(signal.SIGHUP)
                _, error = process.communicate(timeout=LONGEST)
                self.assertEqual(process.returncode, 0, error)

    def test_a_signal_while_it_starts_stops_it_too(self):
        os.mkfifo(self.folder / "s.cfg")  # Rank 0 waits for its config.
        process = self.start(*SWEEP, "--config", "s.cfg")
        with open(self.folder / "s.cfg", "w"):
            for rank in self.ranks_of(process):
                os.kill(rank, signal.SIGUSR1)
            error = self.ended(process, 75)
        self.assertIn("stopped by a signal while reading s.cfg", error)
        self.assertFalse((self.folder / "s.h5").exists())

    def hold_while_it_runs(self, ranks):
        """Starts a sweep and stops its ranks. @return the sweep's process and the processes of the ranks; nothing if
        the sweep ended before"""
        process = self.start(*SLOW, ranks=ranks)

        def runs():
            return (self.folder / "s.h5").exists() and (table(self.folder / "s.h5").status == "running").any()
        self.wait_for(lambda: process.poll() is not None or runs())
        stopped = self.ranks_of(process)
        for rank in stopped:
            os.kill(rank, signal.SIGSTOP)
        if stopped and runs():
            return process, stopped
        self.kill_all(process)
        return None

    def test_a_sweep_whose_journal_is_removed_leaves_the_table_to_the_next(self):
        for ranks in (1, 2):
            first, stopped = self.until_in_time(lambda: self.hold_while_it_runs(ranks))
            (self.folder / "s.h5.journal").unlink()
            self.succeed("clogsweep", *SLOW)
            for rank in stopped:
                os.kill(rank, signal.SIGCONT)
            error = self.ended(first, 2)
            self.assertIn("s.h5 (somebody has replaced it or its journal while the sweep was running); "
                          "all runs are in s.h5.rescued1", error)
            self.check_equal("s.h5", undisturbed(SLOW))
            self.assertFalse((self.folder / "s.h5.journal").exists())
            for name in ("s.h5", "s.h5.rescued1"):
                (self.folder / name).unlink()

    def test_running_tasks_are_in_the_table(self):
        process = self.start(*ENDLESS)
        self.wait_for(lambda: (self.folder / "s.h5").exists() and
                      (table(self.folder / "s.h5").query("status == 'running'").distance > 0).any())
        status = json.loads(self.succeed("clogsweep", "status", "s.h5", "--format", "json").stdout)
        self.assertTrue(status["alive"])
        self.assertEqual(status["runs"], 2)
        self.assertGreater(status["unfinished"], 0)
        self.assertIn(" running; ", self.succeed("clogsweep", "status", "s.h5").stdout)
        refused = self.run_program("clogsweep", *ENDLESS)
        self.assertEqual((refused.returncode, "another sweep is writing to it" in refused.stderr), (2, True))
        process.send_signal(signal.SIGUSR1)
        _, error = process.communicate(timeout=LONGEST)
        self.assertIn("the same command resumes the sweep", error)
        self.assertFalse(json.loads(self.succeed("clogsweep", "status", "s.h5", "--format", "json").stdout)["alive"])

    def test_the_end_of_a_sweep_ends_its_watch(self):
        self.start(*FEW_LONG)
        self.wait_for(lambda: (self.folder / "s.h5").exists())
        watched = self.succeed("clogsweep", "status", "s.h5", "--watch").stdout
        self.assertIn("4 of 4 runs finished", watched)
        self.assertNotIn("\x1b", watched)  # The output is no terminal, so the screen must not be cleared.

    def test_status_counts_unfinished_runs_as_not_clogged(self):
        unfinished = self.stop_with_unfinished_runs(SWEEP)
        status = json.loads(self.succeed("clogsweep", "status", "s.h5", "--format", "json").stdout)
        self.assertFalse(status["alive"])
        self.assertEqual(status["unfinished"], len(unfinished))
        rows = table(self.folder / "s.h5")
        for group in status["groups"]:
            members = rows[(rows.line_tension == group["line_tension"]) & (rows.obstacle_gap == group["obstacle_gap"])]
            clogs = (members.status == "clogged").sum()
            if clogs:
                self.assertAlmostEqual(group["clogging_length"], members.distance.sum() / clogs)
        self.assertIn("the command that started it resumes it", self.succeed("clogsweep", "status", "s.h5").stdout)
        self.assertIn("all undamaged", self.succeed("clogsweep", "verify", "s.h5").stdout)

    def test_a_smaller_sweep_keeps_the_unfinished_runs_of_a_larger_one(self):
        unfinished = self.stop_with_unfinished_runs(FEW_LONG)
        other = {0.05: "0.5", 0.5: "0.05"}[unfinished.line_tension[unfinished.steps.idxmax()]]
        smaller = [*SWEEP[:2], "obstacle-gap=0.5", f"line-tension={other}", "max-time=4000", "seeds=1", "--output", "s.h5"]
        self.succeed("clogsweep", *smaller)
        self.assertTrue((self.folder / "s.h5.journal").exists(), "a snapshot is still needed")
        done = self.succeed("clogsweep", *FEW_LONG, ranks=2)
        self.assertIn("1 run resumes from the last checkpoint", done.stderr)

    def test_salvage_keeps_what_only_the_journal_of_a_killed_sweep_has(self):
        self.stop_with_unfinished_runs(FEW_LONG)
        interrupted = table(self.folder / "s.h5")
        distance = interrupted.distance.max()
        content = (self.folder / "s.h5").read_bytes()
        (self.folder / "s.h5").write_bytes(content.replace(struct.pack("<d", distance), struct.pack("<d", 16 * distance)))
        done = self.succeed("clogsweep", "salvage", "s.h5", "--output", "salvaged.h5")
        self.assertRegex(done.stdout, r"salvaged.h5: \d+ undamaged rows?, 1 snapshot\n")
        done = self.succeed("clogsweep", *FEW_LONG[:-1], "salvaged.h5", ranks=2)
        self.assertIn("1 run resumes from the last checkpoint", done.stderr)
        self.check_equal("salvaged.h5", undisturbed(FEW_LONG))

    def test_salvage_says_that_records_were_not_compared_with_the_settings(self):
        self.stop_with_unfinished_runs(FEW_LONG)
        stored_rows.change_attribute(self.folder / "s.h5", "config", "viscosity = 3\n")
        done = self.succeed("clogsweep", "salvage", "s.h5", "--output", "salvaged.h5")
        self.assertEqual(done.stderr.count("s.h5: records of its journal may be of another sweep: cannot read s.h5 (its attribute config: "), 1)

    def test_a_journal_without_its_table_is_refused(self):
        self.stop_with_unfinished_runs(FEW_LONG)
        (self.folder / "s.h5").unlink()
        self.refuse("clogsweep", *FEW_LONG, words=["its table is gone", "put the table back"])

    def kill_with_records(self, number):
        """Kills a sweep with records in its journal. @return whether the journal had this number of records; otherwise
        the sweep ended earlier"""
        process = self.start(*SLOW)
        self.wait_for(lambda: process.poll() is not None or self.journal()[0] >= number)
        self.kill_all(process)
        return self.journal()[0] >= number

    def killed_behind_its_table(self):
        """Kills a sweep after some runs have ended, and puts back the table as it was at the start. @return whether the
        sweep had a journal, because it was not over"""
        process = self.start(*SEVERAL_SLOW)
        self.wait_for((self.folder / "s.h5").exists)
        before = (self.folder / "s.h5").read_bytes()
        self.wait_for(lambda: process.poll() is not None or
                      (~table(self.folder / "s.h5").status.isin(["running", "interrupted"])).any())
        self.kill_all(process)
        if not (self.folder / "s.h5.journal").exists():
            return False
        (self.folder / "s.h5").write_bytes(before)
        return "only the journal" in self.run_program("clogsweep", "status", "s.h5").stderr

    def test_runs_that_only_the_journal_of_a_dead_sweep_has_are_counted(self):
        self.until_in_time(self.killed_behind_its_table)
        for command in (("clogsweep", "status", "s.h5"), ("clogfit", "s.h5")):
            printed = self.run_program(*command).stderr
            self.assertRegex(printed, r"s.h5: \d+ runs? ended that only the journal of the stopped sweep has; "
                             r"the sweep's own command adds (it|them)\n")
        self.succeed("clogsweep", *SEVERAL_SLOW, ranks=2)
        self.assertNotIn("journal", self.run_program("clogsweep", "status", "s.h5").stderr)
        self.check_equal("s.h5", undisturbed(SEVERAL_SLOW))

    def test_a_damaged_record_costs_no_other(self):
        self.until_in_time(lambda: self.kill_with_records(2))
        self.assertIn(", all undamaged", self.succeed("clogsweep", "verify", "s.h5").stdout)
        journal = self.folder / "s.h5.journal"
        content = bytearray(journal.read_bytes())
        content[500] ^= 1  # changes a byte of the first record
        journal.write_bytes(content + b"the torn end of a kill")
        verified = self.run_program("clogsweep", "verify", "s.h5")
        self.assertEqual(verified.returncode, 1)
        self.assertRegex(verified.stdout, r"1 more damaged; the last one is torn, as after a kill")
        self.assertEqual(journal.read_bytes()[:-22], content)
        done = self.succeed("clogsweep", *SLOW, ranks=2)
        self.assertIn("s.h5.journal: 1 record is damaged; its run resumes from an earlier record or restarts\n",
                      done.stderr)
        self.check_equal("s.h5", undisturbed(SLOW))

    def test_a_checkpoint_that_cannot_be_used_is_reported(self):
        self.stop_with_unfinished_runs(FEW_LONG)
        _, num_snapshots = self.journal()
        with h5py.File(self.folder / "s.h5") as file:
            row_size = file["runs"].dtype.itemsize
        path = self.folder / "s.h5.journal"
        content = bytearray(path.read_bytes())
        record = struct.Struct("<QI4x")  # the size and the checksum of a row and a snapshot
        begin = 24 + record.size
        while begin <= len(content):
            size, _ = record.unpack_from(content, begin - record.size)
            if size > row_size:
                content[begin + row_size] ^= 1  # the first byte of a snapshot, which names its version
                struct.pack_into("<I", content, begin - 8, zlib.crc32(content[begin:begin + size]))
            begin += size + record.size
        path.write_bytes(content)
        done = self.succeed("clogsweep", *FEW_LONG, ranks=2)
        self.assertEqual(len(re.findall(r"task \d rank \d: restarts at the release \(its checkpoint cannot be used: "
                                        r"the snapshot is of another version\)\n", done.stderr)), num_snapshots)
        self.check_equal("s.h5", undisturbed(FEW_LONG))
        with h5py.File(self.folder / "s.h5") as file:
            sessions = file.attrs["activity"].decode().splitlines()
        self.assertEqual([json.loads(line)["restarts"] for line in sessions[-2:]], [0, num_snapshots])

    def test_a_link_is_followed(self):
        (self.folder / "scratch").mkdir()
        (self.folder / "s.h5").symlink_to("scratch/target.h5")
        self.stop_with_unfinished_runs(FEW_LONG)
        self.assertEqual({path.name for path in (self.folder / "scratch").iterdir()},
                         {"target.h5", "target.h5.journal"})
        self.succeed("clogsweep", *FEW_LONG[:-1], "scratch/target.h5", ranks=2)
        self.assertTrue((self.folder / "s.h5").is_symlink())
        self.assertIn("4 of 4 runs finished", self.succeed("clogsweep", "status", "s.h5").stdout)

    def test_other_files_beside_the_table_stay(self):
        short = self.write("s.h5.journal", "to do: eat")
        self.refuse("clogsweep", *FEW_LONG, words=["not a journal", "another --output"])
        (self.folder / short).unlink()
        notes = {self.write(name, name) for name in ("s.h5.new", "s.h5.journal.new", "s.h5.clogsweep-draft1")}
        self.stop_with_unfinished_runs(FEW_LONG)
        self.succeed("clogsweep", *FEW_LONG, ranks=2)
        self.assertEqual(set(self.snapshot()), {"s.h5", *notes})
        for name in notes:
            self.assertEqual((self.folder / name).read_text(), name)

    def test_a_table_that_cannot_be_made_leaves_no_journal(self):
        # The name of the journal is short enough for a file. The name of the draft is too long.
        self.refuse("clogsweep", *SWEEP[:-1], 240 * "s", words=["cannot create", "File name too long"])

    def test_many_sessions_with_long_commands_fit(self):
        seeds = "seeds=" + ",".join(str(seed) for seed in range(1, 251))
        for _ in range(25):
            self.run_program("clogsweep", "vertices=64", "box=20", "max-time=20", seeds, "--max-hours=1e-7",
                             "--output", "s.h5")
        self.assertEqual(self.run_program("clogsweep", "verify", "s.h5").returncode, 0)

    def test_every_rank_uses_the_instruction_set_asked_for(self):
        self.succeed("clogsweep", "vertices=64", "box=20", "max-time=20", "seeds=1..12", "--instruction-set",
                     "baseline", "--output", "s.h5", ranks=3)
        self.assertEqual(set(table(self.folder / "s.h5").instruction_set), {"baseline"})

    def test_a_run_under_two_instruction_sets_is_called_mixed(self):
        long = ["vertices=64", "box=20", "obstacle-gap=1.2", "max-time=2e4", "seeds=1..2", "--report-seconds=0.1",
                "--output", "s.h5"]

        def first_run_is_stopped():
            self.stop_with_a_snapshot(long, signal.SIGUSR1, ranks=1)
            return table(self.folder / "s.h5").status.tolist() == ["interrupted"]
        self.until_in_time(first_run_is_stopped)
        begun = table(self.folder / "s.h5")
        self.succeed("clogsweep", *long, "--instruction-set=baseline", ranks=2)
        only_one = begun.instruction_set[0] == "baseline"  # This processor has no other set.
        rows = table(self.folder / "s.h5").set_index("task")
        self.assertEqual(rows.instruction_set[begun.task[0]], "baseline" if only_one else "mixed")
        self.assertEqual((rows.instruction_set == "baseline").sum(), 2 if only_one else 1)
        if only_one:
            return
        replayed = self.run_program("clogsweep", "replay", "s.h5", begun.task[0])
        self.assertEqual(replayed.returncode, 2)
        self.assertIn("another instruction set", replayed.stderr)

    def test_replay_gives_the_same_bits_and_sees_others(self):
        self.succeed("clogsweep", "vertices=64", "box=20", "max-time=20", "line-tension=0.5,1", "seeds=1..2",
                     "--output", "s.h5")
        for task in range(4):
            self.assertIn("the same bits", self.succeed("clogsweep", "replay", "s.h5", task).stdout)

        def edit(rows):
            rows["distance"][2] = np.nextafter(rows["distance"][2], 1)
            rows["time"][3] = -1
            for task, cause in ((0, b"crash"), (1, b"divergence")):
                rows["status"][task], rows["failed_by"][task], rows["message"][task] = b"failed", cause, b"by " + cause
                rows["distance"][task] = np.nan

        stored_rows.change(self.folder / "s.h5", edit)
        crashed, diverged = (self.run_program("clogsweep", "replay", "s.h5", task) for task in (0, 1))
        self.assertEqual((crashed.returncode, diverged.returncode), (1, 1))
        self.assertIn("s\nthe row's run did not come to its end: by crash\n", crashed.stdout)
        self.assertRegex(diverged.stdout, r"differs from the row in: .*\nthe row has failed\n$")
        other = self.run_program("clogsweep", "replay", "s.h5", 2)
        self.assertEqual(other.returncode, 1, other.stdout)
        self.assertIn("differs from the row in: distance\n", other.stdout)
        self.assertIn("the file has no task 9", self.run_program("clogsweep", "replay", "s.h5", 9).stderr)
        verified = self.run_program("clogsweep", "verify", "s.h5")
        self.assertEqual(verified.returncode, 1)
        self.assertIn("task 3: time=-1 is not between 0 and max_time=20", verified.stdout)

    def test_a_sweep_can_grow(self):
        small = ["vertices=64", "box=20", "max-time=20", "--output", "s.h5"]
        self.succeed("clogsweep", *small, "line-tension=0.5,1", "seeds=1..2")
        before = table(self.folder / "s.h5")
        done = self.succeed("clogsweep", *small, "line-tension=1,2", "seeds=1..3")
        self.assertIn("s.h5 has 2 of 6 runs", done.stderr)
        rows = table(self.folder / "s.h5")
        self.assertEqual(len(rows), 8)
        self.assertEqual(sorted(rows.task), list(range(8)))
        self.assertFalse(rows.duplicated(["line_tension", "seed"]).any())
        kept = before.merge(rows, on=["line_tension", "seed", "distance", "wall_seconds"])
        self.assertEqual(len(kept), 4)

    def test_a_physically_impossible_row_is_named_and_recomputed(self):
        keys = [*QUICK, "line-tension=2", "seeds=1..4", "--output", "s.h5"]
        self.succeed("clogsweep", *keys)
        shutil.copy(self.folder / "s.h5", self.folder / "whole.h5")
        stored_rows.change(self.folder / "s.h5", lambda rows: rows["distance"].__setitem__(2, 1e308))
        done = self.run_program("clogsweep", "verify", "s.h5")
        self.assertEqual(done.returncode, 1)
        self.assertIn("task 2: distance=1e308", done.stdout)
        self.assertIn("3 undamaged rows, 1 fault", done.stdout)
        done = self.succeed("clogsweep", *keys)
        self.assertIn("s.h5: 1 row is physically impossible", done.stderr)
        self.assertIn("s.h5 has 3 of 4 runs", done.stderr)
        self.assertIn("all undamaged", self.succeed("clogsweep", "verify", "s.h5").stdout)
        self.check_equal("s.h5", "whole.h5")

    def test_a_config_that_cannot_be_read_is_said_to_be_the_file_s(self):
        keys = [*QUICK, "seeds=1", "--output", "s.h5"]
        self.succeed("clogsweep", *keys)
        for text in ("line-tension = many", "line-tensinn = 1", "line-tension - 1"):
            stored_rows.change_attribute(self.folder / "s.h5", "config", text)
            for command in [["status", "s.h5"], ["verify", "s.h5"], keys]:
                with self.subTest(text=text, command=command[0]):
                    self.refuse("clogsweep", *command, words=["cannot read s.h5 (its attribute config: "])
            self.assertIn("the same bits",
                          self.succeed("clogsweep", "replay", "s.h5", 0).stdout, "the row says all of its run")

    def test_a_config_that_is_missing_is_restored_by_the_sweeps_own_command(self):
        keys = [*QUICK, "seeds=1", "--output", "s.h5"]
        self.succeed("clogsweep", *keys)
        stored_rows.change_attribute(self.folder / "s.h5", "config", "")
        self.refuse("clogsweep", "status", "s.h5",
                    words=["its attribute config: it is missing; the sweep's own command restores it"])
        self.assertIn("its config is missing: the sweep's own command restores it",
                      self.succeed("clogsweep", "verify", "s.h5").stdout)
        self.succeed("clogsweep", *keys)
        self.assertIn("1 of 1 run", self.succeed("clogsweep", "status", "s.h5").stdout)

    def test_other_physics_is_refused_by_name(self):
        self.succeed("clogsweep", "vertices=64", "box=20", "max-time=20", "seeds=1", "--output", "s.h5")
        self.refuse("clogsweep", "vertices=64", "box=20", "max-time=20", "seeds=1", "clog-energy=1e-16",
                    "gravity=vertex", "perimeter-spring=mean", "--output", "s.h5",
                    words=["clog-energy=1e-16 (file: 1e-17)", "gravity=vertex (file: area)", "another --output"])
        # Two different texts for the same number count as equal.
        done = self.succeed("clogsweep", "vertices=64", "box=2e1", "max-time=20", "seeds=1", "--output", "s.h5")
        self.assertIn("nothing left to do", done.stderr)

    def test_it_grows_along_any_number_of_the_physics(self):
        keys = ["vertices=64", "box=20", "max-time=20", "seeds=1", "--output", "s.h5"]
        self.succeed("clogsweep", *keys, "wall-tension=1")
        self.succeed("clogsweep", *keys, "wall-tension=0.5,1")
        self.succeed("clogsweep", *keys, "wall-tension=0.5,1", "terminal-speed=0.03,0.04")
        rows = table(self.folder / "s.h5")
        self.assertEqual(sorted(zip(rows.wall_tension, rows.terminal_speed)), [(0.5, 0.03), (0.5, 0.04), (1, 0.03), (1, 0.04)])

    def test_every_set_gets_seeds_until_it_has_enough(self):
        keys = [*QUICK, "line-tension=0.5,1,2"]
        self.succeed("clogsweep", *keys, "seeds=2,7", "--output", "mine.h5")
        self.succeed("clogsweep", *QUICK, "line-tension=1", "seeds=9..13", "--output", "theirs.h5")
        self.succeed("clogsweep", "merge", "mine.h5", "theirs.h5", "--output", "s.h5")
        runs = lambda: set(table(self.folder / "s.h5")[["line_tension", "seed", "distance", "steps"]].itertuples(index=False))  # noqa: E731
        before = runs()
        fill = [*keys, "seeds=2", "--output", "s.h5", "--seeds-per-set", 6]
        self.assertIn("# 19 tasks", self.succeed("clogsweep", *fill, "--dry-run").stdout)
        self.run_program("clogsweep", *fill, "--max-hours=1e-9")  # The sweep stops at once.
        self.succeed("clogsweep", *fill, ranks=2)
        rows = table(self.folder / "s.h5")
        seeds = {tension: sorted(group.seed) for tension, group in rows.groupby("line_tension")}
        self.assertEqual(seeds, {0.5: [1, 2, 3, 4, 5, 7], 1: [2, 7, *range(9, 14)], 2: [1, 2, 3, 4, 5, 7]})
        self.assertLessEqual(before, runs())
        again = self.succeed("clogsweep", *fill)
        self.assertIn("there is nothing left to do", again.stderr)
        for other in (["--shard=1/2"], ["--until-precision=20%"]):
            self.refuse("clogsweep", *fill, *other, words=["both choose seeds", "give one of them"])

    def test_a_droplet_that_crosses_itself_is_not_tried_again(self):
        # Far below the tested line tensions.
        keys = ["line-tension=0.001", "vertices=64", "box=20", "obstacle-density=saturated", "max-time=1000", "seeds=1..4", "--attempts=3", "--output", "s.h5"]
        done = self.run_program("clogsweep", *keys, ranks=2)
        rows = table(self.folder / "s.h5")
        failed = rows[rows.status == "failed"]
        self.assertGreater(len(failed), 0, done.stderr)
        self.assertEqual((set(failed.failed_by), set(failed.attempt)), ({"crossing"}, {1}))
        # The crossing was detected at most 2112 steps (13 t0) after the last sound check. In this time droplets sink by
        # 0.4 sigma.
        apart = (failed.sound_distance - failed.distance).abs()
        self.assertTrue(((failed.sound_distance > 0) & (apart > 0) & (apart < 1)).all())
        self.assertNotIn("will be tried again", done.stderr)
        self.assertIn("nothing left to do", self.run_program("clogsweep", *keys).stderr)

    def test_a_failed_run_is_tried_again_up_to_a_limit(self):
        blocked = [*BLOCKED, "seeds=63..65", "--output", "s.h5"]
        self.succeed("clogsweep", *blocked, "--attempts=3", ranks=2)
        rows = table(self.folder / "s.h5")
        self.assertEqual(len(rows), 3)
        self.assertEqual(set(rows[rows.status == "failed"].attempt), {3})
        self.assertEqual(set(rows[rows.status != "failed"].attempt), {1})
        again = self.succeed("clogsweep", *blocked, "--attempts=3")
        self.assertIn("nothing left to do", again.stderr)


class Batch(ProgramTest):
    """Tests the scripts for batch systems. The commands of these systems are replaced by commands that only record
    their arguments."""

    def script(self, name, *arguments, **environment):
        for command in ("scontrol", "qsub"):
            stub = self.folder / command
            stub.write_text(f'#!/bin/sh\n[ "$1" != show ] || exec echo "   WorkDir={self.folder}"\necho {command} "$@" '
                            f'>> "{self.folder}/called"\n')
            stub.chmod(0o755)
        variables = {**os.environ, "PATH": f"{self.folder}:{os.environ['PATH']}", "CLOG_BIN": str(BIN),
                     "OMPI_MCA_rmaps_base_oversubscribe": "1", **environment}
        process = subprocess.Popen([str(ROOT / "jobs" / name), *arguments], cwd=ROOT, env=variables, text=True,
                                   stdout=subprocess.PIPE, stderr=subprocess.STDOUT, start_new_session=True)
        self.addCleanup(lambda: process.poll() is None and os.killpg(process.pid, signal.SIGKILL))
        return process

    def called(self):
        notes = self.folder / "called"
        return notes.read_text() if notes.exists() else ""

    def sweep(self, *more):
        return ["vertices=64", "box=20", "obstacle-gap=1.2", "seeds=1..20", *more, "--output", str(self.folder / "s.h5")]

    def warn(self, process, signal_number=signal.SIGUSR1):
        """Checks that a warning interrupts the runs of the job, and that the job is queued again."""
        self.wait_for(lambda: process.poll() is not None or (
            (self.folder / "s.h5").exists() and (table(self.folder / "s.h5").status == "running").any()))
        process.send_signal(signal_number)
        self.ended(process, 75)
        self.assertEqual(self.called(), "scontrol requeue 77\n")
        self.assertGreater((table(self.folder / "s.h5").status == "interrupted").sum(), 0)

    def test_a_warning_of_a_batch_system_ends_the_sweep_and_the_job_queues_again(self):
        for warned in (signal.SIGUSR1, signal.SIGUSR2, signal.SIGXCPU):
            with self.subTest(signal=warned):
                self.setUp()  # makes an empty folder
                self.warn(self.script("slurm.sh", *self.sweep("max-time=1e5"), SLURM_JOB_ID="77"), warned)

    def test_a_warning_that_ends_mpirun_at_its_start_queues_again(self):
        for what, trap in {"it does not yet know what to do with the signal": "-",
                           "it cannot reach daemons that it has not yet started": "'exit 244'",
                           "it is MPICH's, and says nothing of the sweep's end": "'exit 0'"}.items():
            with self.subTest(what):
                stub = self.folder / "mpirun"
                stub.write_text(f"#!/bin/sh\ntrap {trap} USR1\nkill -USR1 $PPID\nwhile sleep 0.1; do :; done\n")
                stub.chmod(0o755)
                process = self.script("slurm.sh", *self.sweep(), SLURM_JOB_ID="77")
                self.ended(process, 75)
                self.assertEqual(self.called(), "scontrol requeue 77\n")
                (self.folder / "called").unlink()

    def test_a_warning_before_the_sweep_begins_does_not_begin_it(self):
        script = f"""
            . {ROOT}/jobs/batch.sh
            trap() {{ builtin trap "$@"; if [[ $1 != - ]]; then kill -USR1 $$; fi; }}  # as soon as it is set
            code=0
            run_sweep touch began || code=$?
            echo $code"""
        done = subprocess.run(["bash", "-euc", script], cwd=self.folder, capture_output=True, text=True,
                              timeout=LONGEST)
        self.assertEqual(done.stdout, "75\n", done.stderr)
        self.assertEqual(self.snapshot(), {})

    def test_a_complete_sweep_does_not_queue_again(self):
        self.write("lab.cfg", "diameter = 1 mm\nangle = 20 deg\ntension = 2 mN/m\nspeed = 1 mm/s\n")
        # Relative paths refer to the job's folder. The script was called in another folder by a wrapper.
        process = self.script("slurm.sh", *self.sweep("max-time=5", "--lab", "lab.cfg")[:-1], "s.h5", SLURM_JOB_ID="77")
        self.ended(process)
        self.assertEqual(self.called(), "")
        self.assertEqual(len(table(self.folder / "s.h5")), 20)

    def test_a_job_that_refines_passes_its_warning_on_and_queues_again(self):
        arguments = ["refine", "line-tension", *self.sweep("max-time=1e5", "line-tension=0.1,0.2"), "--budget=1h"]
        without_libraries = self.folder / "python3"
        without_libraries.write_text("#!/bin/sh\nexit 1\n")
        without_libraries.chmod(0o755)
        process = self.script("slurm.sh", *arguments, SLURM_JOB_ID="77")
        self.warn(process)

    def test_pbs_queues_again_when_its_hours_are_over(self):
        options = self.folder / "sweep.options"
        options.write_text("\n".join(self.sweep("max-time=1e5", "line-tension=0.1,0.2")) + "\n")
        process = self.script("pbs.sh", SWEEP=str(options), HOURS="0.0004", PBS_O_WORKDIR=str(ROOT))
        self.ended(process, 75)
        self.assertEqual(self.called(), "qsub -v SWEEP,HOURS,CLOG_BIN,JOB_SCRIPT,REQUEUES,MAX_REQUEUES jobs/pbs.sh\n")
        self.assertEqual(json.loads(self.succeed("clogsweep", "status", "s.h5", "--format", "json").stdout)["runs"], 40)

    def test_a_job_is_requeued_only_as_often_as_it_may_be(self):
        options = self.folder / "sweep.options"
        options.write_text("\n".join(self.sweep("max-time=1e5")) + "\n")
        for name, count in [("slurm.sh", "SLURM_RESTART_COUNT"), ("pbs.sh", "REQUEUES")]:
            with self.subTest(script=name):
                process = self.script(name, *self.sweep("max-time=1e5", "--max-hours=1e-5"), SWEEP=str(options),
                                      HOURS="1e-5", SLURM_JOB_ID="77", MAX_REQUEUES="3", **{count: "3"})
                output, _ = process.communicate(timeout=LONGEST)
                self.assertEqual(process.returncode, 75, output)
                self.assertIn("not complete after 3 requeues, as many as MAX_REQUEUES allows; "
                              "submit the job again", output)
                self.assertEqual(self.called(), "")
        process = self.script("slurm.sh", *self.sweep(), SLURM_JOB_ID="77", MAX_REQUEUES="many")
        self.assertRegex(process.communicate(timeout=LONGEST)[0], "^MAX_REQUEUES=many is not a whole number; set .*\n$")
        self.assertEqual(process.returncode, 2)

    def test_one_rank_of_many_tasks_is_refused(self):
        self.refuse("clogsweep", *self.sweep(), env={**os.environ, "SLURM_NTASKS": "8"},
                    words=["allocation of 8 tasks"])

    def test_ranks_of_another_mpis_launcher_are_refused(self):
        other = {"Open MPI": "PMI_SIZE", "MPICH": "OMPI_COMM_WORLD_SIZE"}[MPI]
        self.refuse("clogsweep", *self.sweep(), env={**os.environ, other: "2"},
                    words=[f"this mpirun belongs to another MPI: use that of {MPI}"])


if __name__ == "__main__":
    unittest.main()
