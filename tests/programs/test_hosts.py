"""Tests a sweep on two hosts, one of which dies. tests/two_hosts.sh explains how it simulates hosts."""

import contextlib
import os
import re
import signal
import subprocess
import unittest

import pandas

from support import LONGEST, ROOT, SLOW, SWEEP, TIMING, SweepTest, table, undisturbed

TWO_HOSTS = ROOT / "tests" / "two_hosts.sh"


class TwoHosts(SweepTest):
    def start_on_both(self):
        process = self.start(*SLOW, ranks=1, launcher=TWO_HOSTS)
        self.addCleanup(lambda: [os.kill(pid, signal.SIGKILL) for pid in self.members(process)])
        return process

    def members(self, process, *name):
        """The processes that the launcher has started on both hosts. @param name  options of `pgrep` that select a
        name; without them, all processes"""
        found = subprocess.run(["pgrep", "--session", str(process.pid), *name], capture_output=True, text=True)
        states = {pid: subprocess.run(["ps", "-o", "state=", pid], capture_output=True, text=True).stdout.strip()
                  for pid in found.stdout.split()}
        return [int(pid) for pid, state in states.items() if state not in ("", "Z")]

    def lose_a_host(self):
        """Kills one of the two hosts. @return the rows before its death, in a tuple; None if the sweep ended before"""
        process = self.start_on_both()
        self.wait_for(lambda: process.poll() is not None or
                      (self.folder / "s.h5").exists() and set(table(self.folder / "s.h5")["rank"]) == {0, 1})
        before = table(self.folder / "s.h5")
        # Kills the rank on the second host, and the daemon that is the parent of this rank.
        for daemon in self.members(process, "--exact", "orted"):
            found = subprocess.run(["pgrep", "--parent", str(daemon)], capture_output=True, text=True).stdout.split()
            for pid in [*map(int, found), daemon]:
                with contextlib.suppress(ProcessLookupError):
                    os.kill(pid, signal.SIGKILL)
        _, error = process.communicate(timeout=LONGEST)
        self.wait_for(lambda: not self.members(process))
        if not (self.folder / "s.h5.journal").exists():
            return None
        self.assertNotEqual(process.returncode, 0, error)
        return (before,)

    def test_the_rows_do_not_depend_on_hosts(self):
        process = self.start_on_both()
        error = self.ended(process)
        self.check_equal("s.h5", undisturbed(SLOW))
        rows = table(self.folder / "s.h5")
        self.assertEqual(set(rows["rank"]), {0, 1})
        if "namespaces" in error:
            self.assertEqual(set(zip(rows["rank"], rows.host)), {(0, "host1"), (1, "host2")})

    def test_a_host_dies_and_the_same_command_goes_on(self):
        (before,) = self.until_in_time(self.lose_a_host)
        rows = table(self.folder / "s.h5")
        over = before[~before.status.isin(["running", "interrupted"])].task
        self.assertFalse(rows[rows.task.isin(over)].status.isin(["running", "interrupted"]).any(),
                         "a finished row was lost")
        process = self.start_on_both()
        self.ended(process)
        self.check_equal("s.h5", undisturbed(SLOW))

    def test_a_host_on_which_every_task_fails_gets_no_more_tasks(self):
        # Starts itself on both hosts. On the second host, where the last two ranks are, it kills the processes that the
        # helpers of these ranks start.
        launcher = self.folder / self.write("launcher.sh", f"""#!/bin/sh
            if [ -z "$OMPI_COMM_WORLD_RANK" ]; then
              num_ranks=$1
              shift
              exec {TWO_HOSTS} "$num_ranks" "$0" "$@"
            fi
            [ "$OMPI_COMM_WORLD_RANK" -lt 2 ] || while kill -0 $$; do
              for helper in $(pgrep --parent $$ clogsweep); do pkill -KILL --parent "$helper"; done
              sleep 0.02
            done >/dev/null 2>&1 &
            exec "$@"
            """)
        launcher.chmod(0o755)
        error = self.ended(self.start(*SWEEP, ranks=2, launcher=launcher))
        rows, whole = (table(path).drop(columns=[*TIMING, "attempt"])
                       for path in (self.folder / "s.h5", undisturbed(SWEEP)))
        pandas.testing.assert_frame_equal(rows, whole, check_exact=True)
        names = ["host host2"] if "namespaces" in error else [f"rank {rank} on {os.uname().nodename}" for rank in (2, 3)]
        self.assertEqual(sorted(re.findall(r" (\S+ \S+(?: on \S+)?) is set aside: tasks fail there", error)), names)


if __name__ == "__main__":
    unittest.main()
