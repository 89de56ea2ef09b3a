"""python3 -m clogsweep refine: which rows belong to a curve, for every key of the schema, and what is refused."""

import contextlib
import json
import os
import pathlib
import signal
import subprocess
import sys
import unittest

import numpy as np
from support import BIN, QUICK, ROOT, ProgramTest

sys.path.insert(0, str(ROOT / "analysis"))
from clogsweep.refinement import rounds  # noqa: E402
from clogsweep.refinement.candidates import preferred_values, spread  # noqa: E402
from clogsweep.refinement.driver import Launcher  # noqa: E402
from clogsweep.refinement.membership import Membership, resolved_tasks  # noqa: E402
from clogsweep.tools.errors import ProgramFailed, UserError  # noqa: E402

SCHEMA = json.loads(subprocess.run([BIN / "clogsweep", "--schema"], check=True, capture_output=True, text=True).stdout)
REFINED = [key for key in SCHEMA["keys"] if key.get("role") == "physics" and key["kind"] in ("number", "number or share")]


def settings_for(key):
    """Settings in which the key means something."""
    if key["scope"] == "lattice":
        return ["obstacle-layout=lattice", "obstacle-gap=0.6", "box=60"]
    if key["scope"] == "file":
        return ["obstacles=posts.csv", "box=60", *(["release=entrance"] if key["key"].startswith("entrance") else [])]
    needs_springs = key["key"] in ("perimeter-stiffness-ratio", "friction", "yield-traction")
    return ["box=60", *(["obstacle-gap=0.6"] if key["key"] != "obstacle-gap" else []), *(["preset=elastic"] if needs_springs else [])]


def values_for(key):
    if key["unit"] == "degrees":
        return [130.0, 150.0, 170.0] if key["scope"] == "dp" else [10.0, 20.0, 30.0]
    if key["key"] in ("exit", "entrance"):
        return [45.0, 50.0, 55.0] if key["key"] == "exit" else [2.0, 5.0, 8.0]
    default = float(key["default"]) if key["default"][-1].isdecimal() and float(key["default"]) > 0 else 0.1
    return [0.5 * default, 0.7 * default, 0.9 * default]


class EveryKey(ProgramTest):
    def resolver(self, keys, settings):
        def resolve(values):
            self.write("points.csv", rounds.points_text(keys, [(one, (1, 1)) for one in values]))
            with contextlib.chdir(self.folder), Launcher([], BIN / "clogsweep") as launcher:
                try:
                    return resolved_tasks(launcher.tasks(*settings, "vertices=64", "max-time=1", "--points", "points.csv"))
                except ProgramFailed as failure:
                    raise UserError(str(failure)) from failure

        return resolve

    def fabricated(self, tasks):
        """Two rows for each task, with what all have in common set to numbers of no meaning."""
        kinds = {"number": "f8", "integer": "i8", "word": "S80"}
        dtype = [(column["name"], kinds[column["kind"]]) for column in SCHEMA["columns"]]
        rows = np.zeros(2 * len(tasks), dtype=dtype)
        for i, row in enumerate(rows):
            for name, text in tasks[i % len(tasks)].items():
                row[name] = text.encode() if rows.dtype[name].kind == "S" else float("nan" if text == "-" else text)
            row["task"], row["seed"] = i, 1 + i // len(tasks)
        return rows

    def check(self, keys, settings, values):
        """Each key is refused in one line, or exactly the rows of its values belong to the curve."""
        resolve = self.resolver(keys, settings)
        try:
            members = Membership(keys, SCHEMA, values, resolve)
        except UserError as refusal:
            self.assertNotIn("\n", str(refusal).strip())
            return str(refusal)
        tasks = resolve(values)
        rows = self.fabricated(tasks)
        self.assertEqual(members.values_of(rows), [*values, *values])
        for name in (column["name"] for column in SCHEMA["columns"] if column["role"] == "parameter" and column.get("parameter_role") in ("physics", "numerics")):
            other = rows.copy()
            beyond = slice(len(values), None)  # the second row of each value is of another sweep
            other[name][beyond] = b"other" if rows.dtype[name].kind == "S" else other[name][beyond] * 1.01 + 7
            self.assertEqual(members.values_of(other), [*values, *[None] * len(values)], name)
        return ""

    def test_rows_belong_to_the_values_that_were_asked_for_whatever_follows_from_them(self):
        self.write("posts.csv", "5,5,0.2\n7,5.5,0.3\n")
        refused = {}
        for key in REFINED:
            with self.subTest(key=key["key"]):
                values = values_for(key)
                if key["scope"] == "channel" or key["key"] == "lattice-angle":
                    continue  # refused by name, and the search for a critical angle
                keys, settings = [key["key"]], settings_for(key)
                if key["key"] != "line-tension":
                    keys.append("line-tension")
                    pairs = [(value, tension) for tension in (0.5, 2.0) for value in values]
                    refused[key["key"]] = self.check(keys, settings, pairs)
                if refusal := self.check(keys[:1], settings, [(value,) for value in values]):
                    refused[key["key"]] = refusal
        print({key: why for key, why in refused.items() if why})

    def test_a_gap_is_refined_although_the_density_follows_from_it(self):
        for density in ("12.5%", "saturated"):
            with self.subTest(density=density):
                settings = [*QUICK[:2], f"obstacle-density={density}"]
                self.assertEqual(self.check(["obstacle-gap"], settings, [(0.3,), (0.4,), (0.5,)]), "")


class Values(unittest.TestCase):
    def test_preferred_values_lie_between_the_bounds_and_include_them(self):
        values = preferred_values([0.3, 3.0], 100)
        self.assertEqual((values[0], values[-1]), (0.3, 3))
        self.assertLessEqual(len(values), 100)
        self.assertTrue(all(value == float(f"{value:.3g}") for value in values))
        self.assertEqual(spread(values, 7), [0.3, 0.442, 0.649, 0.953, 1.4, 2.05, 3])


class Rounds(ProgramTest):
    def test_a_round_is_added_below_those_before_it(self):
        stored = rounds.StoredRounds(pathlib.Path(self.folder / "points.csv"), ["line-tension"], "made by a test")
        stored.begin([((0.3,), (1, 3)), ((3.0,), (4, 1))])
        stored.add([((1.0,), (5, 3))])
        self.assertEqual(stored.path.read_text(), "# made by a test\nline-tension,seeds\n0.3,1..3\n3,4\n1,5..7\n")


class Warned(ProgramTest):
    def test_warnings_go_on_to_the_launcher_as_the_signal_that_mpirun_forwards(self):
        for number in (signal.SIGUSR1, signal.SIGTERM, signal.SIGINT):
            with self.subTest(signal=number), Launcher(["bash", "-c", f"trap 'exit 75' USR1; kill -{int(number)} {os.getpid()}; sleep 60 & wait; exit 3"],
                                                       pathlib.Path("clogsweep")) as launcher:
                self.assertEqual(launcher.run(), 75)
                self.assertTrue(launcher.is_warned)

    def test_codes_of_clogsweep_are_kept_and_a_signal_is_a_code(self):
        for words, code in [("exit 2", 2), ("exit 75", 75), ("kill -9 $$", 137)]:
            with self.subTest(words=words), Launcher(["bash", "-c", words], pathlib.Path("clogsweep")) as launcher:
                self.assertEqual(launcher.run(), code)


if __name__ == "__main__":
    unittest.main()
