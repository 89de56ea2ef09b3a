"""Tests that jobs/mpi-settings.sh sets the variables of each version of Open MPI, but not the variables that the user
has set."""

import os
import pathlib
import subprocess
import unittest

SETTINGS = pathlib.Path(__file__).resolve().parents[2] / "jobs" / "mpi-settings.sh"

EXPECTED = {
    "OMPI_ALLOW_RUN_AS_ROOT": "1",
    "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
    # Open MPI 4
    "OMPI_MCA_rmaps_base_oversubscribe": "1",
    "OMPI_MCA_hwloc_base_binding_policy": "none",
    "OMPI_MCA_btl_vader_single_copy_mechanism": "none",
    # Open MPI 5
    "PRTE_MCA_rmaps_default_mapping_policy": ":oversubscribe",
    "PRTE_MCA_hwloc_default_binding_policy": "none",
    "OMPI_MCA_smsc": "^cma",
}


def variables_after(**before):
    """The variables of Open MPI and PRRTE that mpirun gets from a script that has sourced the settings."""
    printed = subprocess.run(["bash", "-euc", '. "$0" && env', SETTINGS], env={"PATH": os.environ["PATH"], **before},
                             check=True, capture_output=True, text=True).stdout
    return {name: value for name, _, value in (line.partition("=") for line in printed.splitlines())
            if name.startswith(("OMPI_", "PRTE_"))}


class MpiSettings(unittest.TestCase):
    def test_the_variables_of_each_version_are_set(self):
        self.assertEqual(variables_after(), EXPECTED)

    def test_the_users_values_are_kept(self):
        for name in EXPECTED:
            with self.subTest(name):
                self.assertEqual(variables_after(**{name: "theirs"})[name], "theirs")

    def test_more_ranks_than_cores_do_not_keep_open_mpi_5_from_binding_them(self):
        bound = variables_after(PRTE_MCA_hwloc_default_binding_policy="core")
        self.assertNotIn("PRTE_MCA_rmaps_default_mapping_policy", bound)

    def test_a_script_that_is_called_by_another_one_changes_nothing(self):
        for policy in ("none", "core"):
            with self.subTest(policy):
                once = variables_after(PRTE_MCA_hwloc_default_binding_policy=policy)
                self.assertEqual(variables_after(**once), once)


if __name__ == "__main__":
    unittest.main()
