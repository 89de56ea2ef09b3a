"""Tests sweeps that are jobs of a real Slurm. Slurm warns, requeues or cancels the jobs, or a job loses a node. The
rows must equal those of an undisturbed sweep.

    tests/slurm.sh [slurm.Slurm.test_...]    # also starts the Slurm that these tests need
"""

import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "tests" / "programs"))

from support import BIN, MPIRUN, STEPS_PER_SNAPSHOT, SWEEP, SweepTest, table  # noqa: E402

# Runs that are long enough for a job to be still running when Slurm acts on it.
KEYS = [word.replace("max-time=4000", "max-time=2e4") for word in SWEEP[:-2]]
# Runs that together take a minute or more on two ranks.
LONG = [word.replace("max-time=2e4", "max-time=1e5") for word in KEYS]
NODES = {"node1", "node2"}


def slurm(*command):
    done = subprocess.run([*map(str, command)], capture_output=True, text=True, timeout=300)
    if done.returncode:
        raise AssertionError(f"{command}: {done.stdout}{done.stderr}")
    return done.stdout


def described(kind, name):
    """Slurm's description of a job or a node."""
    return dict(re.findall(r"(\w+)=(\S*)", slurm("scontrol", "--oneliner", "show", kind, name)))


class Slurm(SweepTest):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.whole = cls.sweep_without_slurm(KEYS, pathlib.Path(folder.name) / "whole.h5")

    @staticmethod
    def sweep_without_slurm(keys, path):
        subprocess.run([MPIRUN, "2", BIN / "clogsweep", *keys, "--output", path], check=True, capture_output=True,
                       timeout=1800)
        return path

    def setUp(self):
        super().setUp()
        self.wait_for(lambda: all(described("node", node)["State"] == "IDLE" for node in NODES))

    def submit(self, *options, script=ROOT / "jobs" / "slurm.sh", keys=KEYS):
        """Submits a job of two ranks that runs a sweep. The sweep writes to s.h5. @return the number of the job"""
        words = slurm("sbatch", "--parsable", f"--chdir={self.folder}", "--output=job.log", "--ntasks=2", *options,
                      script, *keys, "--output", "s.h5")
        job = words.strip()
        self.addCleanup(slurm, "scancel", "--full", job)
        return job

    def log(self):
        path = self.folder / "job.log"
        return path.read_text() if path.exists() else ""

    def wait_for_state(self, job, state):
        self.wait_for(lambda: described("job", job)["JobState"] == state or self.ended_otherwise(job, state))

    def ended_otherwise(self, job, state):
        now = described("job", job)["JobState"]
        self.assertNotIn(now, {"COMPLETED", "CANCELLED", "FAILED", "TIMEOUT", "NODE_FAIL"} - {state}, self.log())

    def wait_for_runs_with_snapshots(self):
        """Waits until some tasks have snapshots, and other tasks have ended."""
        def seen():
            if not (self.folder / "s.h5").exists():
                return False
            rows = table(self.folder / "s.h5")
            running = rows[rows.status == "running"]
            return len(running) < len(rows) and (running.steps > STEPS_PER_SNAPSHOT).any()
        self.wait_for(seen)

    def check_completed(self, job, restarts):
        self.wait_for_state(job, "COMPLETED")
        self.assertEqual(described("job", job)["Restarts"], str(restarts), self.log())
        self.check_equal("s.h5", self.whole)

    def check_went_on(self):
        """Checks that the last session resumed the sweep and did not restart it."""
        self.assertRegex(self.log(), r"s\.h5 has [1-9]\d* of 24 runs\n")

    def resume(self, node):
        if re.search("DOWN|DRAIN", described("node", node)["State"]):
            slurm("scontrol", "update", f"nodename={node}", "state=resume")

    def test_an_undisturbed_job_has_the_rows_of_a_sweep_without_slurm(self):
        self.check_completed(self.submit("--nodes=2", "--ntasks-per-node=1"), restarts=0)
        rows = table(self.folder / "s.h5")
        self.assertEqual(set(zip(rows["rank"], rows.host)), {(0, "node1"), (1, "node2")})

    def test_a_job_is_warned_before_its_time_is_up_and_queues_itself_again(self):
        # Slurm checks the time limit twice a minute, and warns half a minute before the limit. So the warning comes
        # after 20 to 50 s.
        job = self.submit("--nodes=2", "--ntasks-per-node=1", "--time=1", "--signal=B:USR1@10", keys=LONG)
        self.wait_for(lambda: described("job", job)["Restarts"] != "0" or self.ended_otherwise(job, "RUNNING"))
        slurm("scontrol", "update", f"jobid={job}", "timelimit=60")
        self.wait_for_state(job, "COMPLETED")
        restarts = int(described("job", job)["Restarts"])
        self.assertEqual(self.log().count("stopping because of a signal"), restarts, self.log())
        self.assertEqual(self.log().count("not complete; the job queues again"), restarts, self.log())
        self.check_equal("s.h5", self.sweep_without_slurm(LONG, self.folder / "whole.h5"))

    def test_a_job_that_is_queued_again_goes_on(self):
        job = self.submit("--nodes=2", "--ntasks-per-node=1")
        self.wait_for_runs_with_snapshots()
        slurm("scontrol", "requeue", job)
        self.check_completed(job, restarts=1)
        self.check_went_on()

    def test_a_cancelled_job_does_not_queue_again_and_another_goes_on(self):
        job = self.submit("--nodes=2", "--ntasks-per-node=1")
        self.wait_for_runs_with_snapshots()
        slurm("scancel", job)
        self.wait_for(lambda: all(described("node", node)["State"] == "IDLE" for node in NODES))
        self.assertEqual(described("job", job)["JobState"], "CANCELLED")
        self.assertEqual(described("job", job)["Restarts"], "0")
        self.check_completed(self.submit("--nodes=2", "--ntasks-per-node=1"), restarts=0)
        self.check_went_on()

    def test_a_job_whose_node_is_drained_goes_on_elsewhere(self):
        job = self.submit("--nodes=1", "--ntasks-per-node=2")
        self.wait_for_runs_with_snapshots()
        node = described("job", job)["BatchHost"]
        self.addCleanup(self.resume, node)
        slurm("scontrol", "update", f"nodename={node}", "state=drain", "reason=test")
        self.assertEqual(described("job", job)["JobState"], "RUNNING")
        slurm("scontrol", "requeue", job)
        self.check_completed(job, restarts=1)
        self.check_went_on()
        (other,) = NODES - {node}
        self.assertEqual(described("job", job)["BatchHost"], other)
        self.assertEqual(set(table(self.folder / "s.h5").host), NODES)

    def test_a_job_whose_node_goes_down_waits_until_it_is_back(self):
        job = self.submit("--nodes=2", "--ntasks-per-node=1")
        self.wait_for_runs_with_snapshots()
        self.addCleanup(self.resume, "node2")
        slurm("scontrol", "update", "nodename=node2", "state=down", "reason=test")
        self.wait_for_state(job, "PENDING")
        self.resume("node2")
        self.check_completed(job, restarts=1)
        self.check_went_on()

    def test_a_script_that_wraps_ours_sets_its_options_and_limits_its_requeues(self):
        wrapper = self.folder / "mine.sh"
        wrapper.write_text("#!/bin/bash\n#SBATCH --nodes=1 --ntasks-per-node=2 --requeue --open-mode=append\n"
                           f'export MAX_REQUEUES=1\nexec {ROOT}/jobs/slurm.sh "$@" --max-hours 1e-5\n')
        job = self.submit(script=wrapper, keys=LONG)
        self.wait_for_state(job, "FAILED")
        self.assertEqual((described("job", job)["Restarts"], described("job", job)["ExitCode"]), ("1", "75:0"), self.log())
        self.assertIn("not complete after 1 requeues, as many as MAX_REQUEUES allows", self.log())

    def preempt(self, partition):
        """Lets an urgent job preempt a job. @return the number of the preempted job"""
        job = self.submit("--nodes=2", "--ntasks-per-node=1", f"--partition={partition}")
        self.wait_for_runs_with_snapshots()
        urgent = slurm("sbatch", "--parsable", "--partition=urgent", "--nodes=2", "--ntasks-per-node=2",
                       "--output=/dev/null", "--wrap=sleep 5").strip()
        self.wait_for_state(urgent, "COMPLETED")
        return job

    def configure(self, old, new):
        """Changes the configuration of Slurm until the end of the test."""
        path = pathlib.Path(os.environ["SLURM_CONF"])

        def put(text):
            path.write_text(text)
            slurm("scontrol", "reconfigure")
        self.addCleanup(put, path.read_text())
        put(path.read_text().replace(old, new))

    def test_a_preempted_job_queues_again(self):
        user_signal = "SlurmctldParameters=preempt_send_user_signal\n"
        # Without preempt_send_user_signal, only the daemon on the other node receives a warning.
        for partition, removed, warned in [("requeue", "", False), ("cancel", "", True),
                                           ("cancel", user_signal, False)]:
            with self.subTest(partition=partition, removed=removed):
                self.setUp()  # makes an empty folder
                self.configure(removed, "")
                self.check_completed(self.preempt(partition), restarts=1)
                self.check_went_on()
                if warned:
                    self.assertIn("stopped by a signal; the same command resumes the sweep", self.log())

    def test_a_suspended_job_goes_on(self):
        self.configure("PreemptMode=REQUEUE", "PreemptMode=SUSPEND,GANG")
        # Slurm suspends a job only if both partitions may share processors.
        self.configure("PartitionName=requeue Nodes=ALL",
                       "PartitionName=DEFAULT OverSubscribe=FORCE:1\nPartitionName=requeue Nodes=ALL")
        job = self.preempt("requeue")
        self.assertNotEqual(described("job", job)["SuspendTime"], "None")
        self.check_completed(job, restarts=0)
        self.assertEqual(set(table(self.folder / "s.h5").attempt), {1})

    def test_srun_with_pmix_starts_the_ranks_without_mpirun(self):
        done = self.srun("--mpi=pmix")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("24 runs on 2 computing ranks", done.stderr)
        self.check_equal("s.h5", self.whole)

    def test_srun_without_pmix_starts_no_sweep(self):
        done = self.srun("--mpi=none")
        self.assertNotEqual(done.returncode, 0, done.stderr)
        self.assertFalse((self.folder / "s.h5").exists())

    def srun(self, mpi):
        return subprocess.run(["srun", mpi, "--nodes=2", "--ntasks=2", BIN / "clogsweep", *KEYS, "--output", "s.h5"],
                              cwd=self.folder, capture_output=True, text=True, timeout=600)


if __name__ == "__main__":
    unittest.main()
