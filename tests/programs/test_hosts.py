"""A sweep across two hosts, of which one dies. tests/two_hosts.sh says what a host is here."""

import os
import signal
import subprocess
import unittest

from support import LONGEST, ROOT, SWEEP, SweepTest, table

TWO_HOSTS = ROOT / "tests" / "two_hosts.sh"


class TwoHosts(SweepTest):
    def start_on_both(self):
        process = self.start(*SWEEP, ranks=1, launcher=TWO_HOSTS)
        self.addCleanup(lambda: [os.kill(pid, signal.SIGKILL) for pid in self.members(process)])
        return process

    def members(self, process, *name):
        """Processes of this name that the launcher has started, on both hosts."""
        found = subprocess.run(["pgrep", "--session", str(process.pid), *name], capture_output=True, text=True)
        states = {pid: subprocess.run(["ps", "-o", "state=", pid], capture_output=True, text=True).stdout.strip()
                  for pid in found.stdout.split()}
        return [int(pid) for pid, state in states.items() if state not in ("", "Z")]

    def wait_for_runs_of_both(self):
        def both_are_seen():
            return (self.folder / "s.h5").exists() and set(table(self.folder / "s.h5")["rank"]) == {0, 1}
        self.wait_for(both_are_seen)

    def test_the_rows_do_not_depend_on_hosts(self):
        process = self.start_on_both()
        _, error = process.communicate(timeout=LONGEST)
        self.assertEqual(process.returncode, 0, error)
        self.succeed("clogsweep", *SWEEP[:-1], "whole.h5", ranks=2)
        self.check_equal("s.h5", "whole.h5")
        rows = table(self.folder / "s.h5")
        self.assertEqual(set(rows["rank"]), {0, 1})
        if "namespaces" in error:
            self.assertEqual(set(zip(rows["rank"], rows.host)), {(0, "host1"), (1, "host2")})

    def test_a_host_dies_and_the_same_command_goes_on(self):
        self.succeed("clogsweep", *SWEEP[:-1], "whole.h5", ranks=2)
        process = self.start_on_both()
        self.wait_for_runs_of_both()
        before = table(self.folder / "s.h5")
        # The second host's rank and its daemon, the first's parent.
        (daemon,) = self.members(process, "--exact", "orted")
        rank = int(subprocess.run(["pgrep", "--parent", str(daemon)], capture_output=True, text=True).stdout)
        os.kill(rank, signal.SIGKILL)
        os.kill(daemon, signal.SIGKILL)
        _, error = process.communicate(timeout=LONGEST)
        self.assertNotEqual(process.returncode, 0, error)
        self.wait_for(lambda: not self.members(process))
        rows = table(self.folder / "s.h5")
        over = before[~before.status.isin(["running", "interrupted"])].task
        self.assertFalse(rows[rows.task.isin(over)].status.isin(["running", "interrupted"]).any(), "a finished row was lost")
        self.assertLess((~rows.status.isin(["running", "interrupted"])).sum(), 24, "it was over before its host died")
        process = self.start_on_both()
        _, error = process.communicate(timeout=LONGEST)
        self.assertEqual(process.returncode, 0, error)
        self.check_equal("s.h5", "whole.h5")


if __name__ == "__main__":
    unittest.main()
