"""Tests that clogsweep doctor finds problems of sweeps and prints remedies."""

import os
import pathlib
import subprocess
import unittest

from support import BIN, LONGEST, MPI, MPI_MAJOR, MPIRUN, ProgramTest

# The variable that binds ranks to cores has another name since Open MPI 5.
BINDING = "PRTE_MCA_hwloc_default_binding_policy" if MPI_MAJOR >= 5 else "OMPI_MCA_hwloc_base_binding_policy"


class Doctor(ProgramTest):
    def examine(self, *arguments, ranks=None, before=(), **environment):
        variables = {key: value for key, value in os.environ.items() if not key.startswith(("SLURM_", "OMPI_", "PRTE_"))}
        command = [*before, *([str(MPIRUN), str(ranks)] if ranks else []), str(BIN / "clogsweep"), "doctor", *arguments]
        return subprocess.run(command, cwd=self.folder, env={**variables, **environment}, capture_output=True,
                              text=True, timeout=LONGEST)

    def faults(self, done):
        lines = done.stdout.splitlines()
        found = {line[6:]: lines[number + 1].strip() for number, line in enumerate(lines) if line.startswith("MEND")}
        self.assertEqual(done.returncode, 1 if found else 0, done.stdout + done.stderr)
        return found

    def fault(self, done, words):
        (remedy,) = [remedy for what, remedy in self.faults(done).items() if words in what]
        return remedy

    def test_all_is_well_with_one_rank(self):
        done = self.examine(OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")
        self.assertEqual(self.faults(done), {})
        self.assertIn("locks work", done.stdout)
        self.assertIn(" ns per vertex", done.stdout)
        self.assertEqual(self.snapshot(), {})

    def test_ranks_that_share_a_core_are_seen(self):
        core = str(min(os.sched_getaffinity(0)))
        done = self.examine(ranks=2, before=["taskset", "-c", core])
        self.assertIn("2 ranks, started together", done.stdout)
        remedy = self.fault(done, "2 ranks, 1 core")
        self.assertIn("mpirun -np 1;", remedy)
        self.assertIn(f"{BINDING}=none" if MPI == "Open MPI" else "-bind-to none", remedy)

    @unittest.skipUnless(MPI == "Open MPI", "MPICH binds no ranks unless told by an option")
    def test_the_users_binding_wins_over_mpi_settings(self):
        cores = os.sched_getaffinity(0)
        of_one_core = (pathlib.Path("/sys/devices/system/cpu") / f"cpu{min(cores)}"
                       / "topology/thread_siblings").read_text()
        threads = bin(int(of_one_core.replace(",", ""), 16)).count("1")
        for policy, expected in (("none", len(cores)), ("core", threads)):
            with self.subTest(policy):
                found = subprocess.run([str(MPIRUN), "1", "nproc"], env={**os.environ, BINDING: policy}, check=True,
                                       capture_output=True, text=True, timeout=LONGEST).stdout
                self.assertEqual(int(found), expected)

    def test_four_ranks_start_on_two_cores(self):
        cores = ",".join(map(str, sorted(os.sched_getaffinity(0))[:2]))
        done = self.examine(ranks=4, before=["taskset", "-c", cores])
        self.assertIn("4 ranks, started together", done.stdout, done.stderr)

    def test_a_lonely_rank_of_many_is_seen(self):
        self.assertIn("use mpirun", self.fault(self.examine(SLURM_NTASKS="8"), "allocation of 8 tasks"))

    def test_the_mpirun_of_another_mpi_is_seen(self):
        other = {"Open MPI": "PMI_SIZE", "MPICH": "OMPI_COMM_WORLD_SIZE"}[MPI]
        self.assertIn(f"this mpirun belongs to another MPI: use that of {MPI}",
                      self.fault(self.examine(**{other: "2"}), "mpirun has started 2"))

    def test_a_single_rank_of_mpirun_in_a_larger_allocation_is_accepted(self):
        self.assertEqual(self.faults(self.examine(ranks=1, SLURM_NTASKS="8")), {})

    def test_root_in_a_container_gets_a_message(self):
        done = self.examine()
        if os.geteuid() == 0 and MPI == "Open MPI":
            self.assertIn("jobs/mpi-settings.sh", self.fault(done, "refuses to start more as root"))
        else:
            self.assertEqual(self.faults(done), {})

    def test_a_folder_that_is_not_there_is_seen(self):
        self.assertIn("--output", self.fault(self.examine("--output", "nowhere/s.h5"), "cannot write in nowhere"))

    def test_wrong_options_are_refused_on_all_ranks(self):
        done = self.examine("--outputs=x", ranks=2)
        self.assertEqual(done.returncode, 2)
        self.assertIn("unknown option", done.stderr)


if __name__ == "__main__":
    unittest.main()
