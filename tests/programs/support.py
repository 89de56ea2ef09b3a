"""Runs the programs as a user would, with a command line in an empty folder."""

import fcntl
import hashlib
import json
import os
import pathlib
import re
import shutil
import signal
import subprocess
import tempfile
import time
import unittest

import pandas

BIN = pathlib.Path(os.environ["CLOG_BIN"])
# Tests need to know the MPI of this mpirun, because those of Open MPI and MPICH behave differently.
_mpi = re.search(r"^MPI: (.*) v?(\d+)",
                 subprocess.run([BIN / "clogsweep", "--version"], check=True, capture_output=True, text=True).stdout,
                 re.MULTILINE)
MPI, MPI_MAJOR = _mpi[1], int(_mpi[2])
STEPS_PER_SNAPSHOT = 2**18  # Stopped runs resume from a snapshot.
ROOT = pathlib.Path(__file__).resolve().parents[2]
MPIRUN = ROOT / "tests" / "mpirun.sh"

# After this number of seconds a program counts as hanging. On a busy machine, some programs with sanitizers take
# minutes.
LONGEST = 1500

# Settings of small droplets in a small box. Runs with these settings take some hundredths of a second.
SMALL = ["vertices=64", "box=20", "obstacle-density=saturated"]
QUICK = [*SMALL, "max-time=60"]
# A sweep that tests share, see shared_sweep(). Each of its two parameter sets has two droplets. Some of the droplets
# clog.
FEW = [*QUICK, "line-tension=1,3", "seeds=1..2"]
# Long runs. Each makes several snapshots, at a rate of four per second.
SWEEP = [*SMALL, "obstacle-gap=0.4,0.5", "line-tension=0.05,0.5", "max-time=4000", "seeds=1..6",
         "--report-seconds=0.1", "--output", "s.h5"]
FEW_LONG = [word.replace("1..6", "1") for word in SWEEP]
# Two runs that take seconds each. At the first snapshot both runs are in progress.
SLOW = [*SMALL, "obstacle-gap=0.4,0.5", "line-tension=0.05", "max-time=2e4", "seeds=1",
        "--report-seconds=0.1", "--output", "s.h5"]
# The same runs, but they take hours. The runs are in progress until something ends them, even if the test has to wait
# long for the processor.
ENDLESS = [word.replace("max-time=2e4", "max-time=1e9") for word in SLOW]
# The obstacles are so close together that some seeds (53 and 64 of 51..70) give no void for the release of the droplet.
BLOCKED = ["vertices=64", "box=13", "obstacle-density=saturated", "max-time=5", "obstacle-diameter=3",
           "obstacle-gap=0.06", "self-contact-range=0.1"]
# Soft droplets that break up, some of them twice, within a second
FAMILIES = ["break-up=daughters", "break-up-neck=0.08", "self-contact-range=0.02", "line-tension=0.05",
            "vertices=64", "box=20", "obstacle-density=0.8", "obstacle-gap=0.3", "max-time=700", "seeds=1..4"]
# The first bytes of a snapshot of a daughter (src/core/run/family.cpp)
SNAPSHOT_OF_A_DAUGHTER = (0x636C6F6766000001).to_bytes(8, "little")
# Columns that may differ when the same run is recomputed. The columns state who computed the run, and how long this
# took.
TIMING = ["wall_seconds", "processor_seconds", "rank", "host"]


# The folder of the sweeps that several suites read. CTest empties this folder before it starts the first of the suites.
if "CLOG_SHARED_SWEEPS" in os.environ:
    SHARED = pathlib.Path(os.environ["CLOG_SHARED_SWEEPS"])
    SHARED.mkdir(parents=True, exist_ok=True)
else:
    of_this_process = tempfile.TemporaryDirectory(prefix="clog_shared_")
    SHARED = pathlib.Path(of_this_process.name)


def shared_sweep(*arguments, program="clogsweep"):
    """The file that the program writes for these arguments. The file is computed once for all suites of a CTest run,
    and is read-only. A test that changes the file has to copy it first."""
    command = [program, *map(str, arguments)]
    path = SHARED / (hashlib.sha256("\0".join(command).encode()).hexdigest()[:16] + ".h5")
    with open(path.with_suffix(".lock"), "w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if not path.exists():
            draft = path.with_suffix(".draft.h5")
            subprocess.run([str(BIN / program), *command[1:], "--output", str(draft)], cwd=SHARED, check=True,
                           capture_output=True, text=True, timeout=LONGEST)
            draft.chmod(0o444)
            draft.rename(path)
    return path


def undisturbed(sweep):
    """The file of an undisturbed sweep with these arguments, without the last two of them (--output and its value)."""
    return shared_sweep(*sweep[:-2])


class ProgramTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="clog_program_")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def run_program(self, name, *arguments, ranks=None, env=None):
        command = [str(BIN / name), *map(str, arguments)]
        if ranks is not None:
            command = [str(MPIRUN), str(ranks), *command]
        return subprocess.run(command, cwd=self.folder, capture_output=True, text=True, timeout=LONGEST, env=env)

    def succeed(self, name, *arguments, **options):
        done = self.run_program(name, *arguments, **options)
        self.assertEqual(done.returncode, 0, f"{name} {arguments}: {done.stdout}{done.stderr}")
        return done

    def plan(self, *arguments):
        """The text of a dry run without the cost, which takes ten seconds to estimate."""
        command = [str(BIN / "clogsweep"), *map(str, arguments), "--dry-run", "--format=json"]
        with subprocess.Popen(command, cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as dry_run:
            line = dry_run.stdout.readline()
            dry_run.terminate()
            said = dry_run.communicate(timeout=LONGEST)[1]
        self.assertTrue(line, said)
        return json.loads(line)["text"]

    def refuse(self, name, *arguments, words, **options):
        """Checks that the program ends with exit code 2, prints one line that contains each of the words, and writes no
        file."""
        before = self.snapshot()
        done = self.run_program(name, *arguments, **options)
        self.assertEqual(done.returncode, 2, done.stdout + done.stderr)
        self.assertEqual(len(done.stderr.strip().splitlines()), 1, done.stderr)
        self.assertEqual(done.stdout, "")
        for word in words:
            self.assertIn(word, done.stderr)
        self.assertEqual(self.snapshot(), before)

    def snapshot(self):
        return {path.name: path.read_bytes() for path in self.folder.iterdir() if path.is_file()}

    def wait_for(self, condition):
        deadline = time.time() + LONGEST
        while not condition():
            self.assertLess(time.time(), deadline, "it did not happen in time")
            time.sleep(0.02)

    def ended(self, process, code=0):
        """Waits until the process has ended, and checks its exit code. @return its standard error"""
        output, error = process.communicate(timeout=LONGEST)
        self.assertEqual(process.returncode, code, f"{output}{error}")
        return error

    def write(self, name, text):
        (self.folder / name).write_text(text)
        return name

    def copy_sweep(self, name, *arguments, program="clogsweep"):
        """Copies a shared sweep to a file that the test may change. An existing file is replaced."""
        return pathlib.Path(shutil.copyfile(shared_sweep(*arguments, program=program), self.folder / name))


def children_of(pid):
    found = subprocess.run(["pgrep", "-P", str(pid)], capture_output=True, text=True)
    return [int(child) for child in found.stdout.split()]


def table(path):
    return pandas.read_hdf(path, "runs")


class SweepTest(ProgramTest):
    """Tests that watch a sweep while it runs."""

    def start(self, *arguments, ranks=2, launcher=MPIRUN):
        process = subprocess.Popen([str(launcher), str(ranks), str(BIN / "clogsweep"), *arguments], cwd=self.folder,
                                   stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True,
                                   start_new_session=True)
        self.addCleanup(self.kill_all, process)
        return process

    def kill_all(self, process, more=()):
        """Kills mpirun and its ranks, which have their own process groups. @param more  ranks whose mpirun may have
        ended"""
        for pid in [*self.ranks_of(process), process.pid, *more]:
            try:
                os.kill(pid, signal.SIGKILL)
            except ProcessLookupError:
                pass
        process.wait()
        process.stderr.close()

    def ranks_of(self, process):
        children = children_of(process.pid)
        if MPI == "MPICH":  # MPICH's mpirun has another process between itself and the ranks.
            return [rank for proxy in children for rank in children_of(proxy)]
        return children

    def until_in_time(self, attempt):
        """Repeats attempt() until it returns something. attempt() returns nothing if the sweep ended too early for the
        test, which may happen on a busy machine."""
        for _ in range(20):
            if outcome := attempt():
                return outcome
            for path in self.folder.glob("s.h5*"):
                path.unlink()
        self.fail("the sweep was always over")

    def check_equal(self, name, other):
        rows, others = (table(self.folder / n).drop(columns=TIMING) for n in (name, other))
        pandas.testing.assert_frame_equal(rows, others, check_exact=True)
