import contextlib
import csv
import io
import json
import math
import os
import pathlib
import subprocess
import sys
import types
import unittest
import unittest.mock

import h5py
import numpy as np
import scipy.stats

import support
from support import FEW, ROOT, ProgramTest, shared_sweep

sys.path.insert(0, str(ROOT / "analysis"))
from clogsweep import style  # noqa: E402
from clogsweep.drawing import measured, survival_curve  # noqa: E402
from clogsweep.results import fit  # noqa: E402
from clogsweep.tools.errors import UserError  # noqa: E402

# Times of survival after leukaemia, with and without maintenance chemotherapy. The times are the data set `aml` of R's
# package survival 3.5-3.
AML = {"Maintained": "9 1, 13 1, 13 0, 18 1, 23 1, 28 0, 31 1, 34 1, 45 0, 48 1, 161 0",
       "Nonmaintained": "5 1, 5 1, 8 1, 8 1, 12 1, 16 0, 23 1, 27 1, 30 1, 33 1, 43 1, 45 1"}
LAB = "diameter = 2 mm\nangle = 20 deg\nspeed = 7 mm/s\n"


def table(head, separator=",", number=str):
    lines = [f"{group}{separator}{separator.join(number(cell) for cell in pair.split())}" for group, pairs in AML.items() for pair in pairs.split(", ")]
    return "\n".join([separator.join(head), *lines]) + "\n"


class Lengths(ProgramTest):
    def lengths(self, *arguments):
        return json.loads(self.succeed("clogfit", "lengths", *arguments, "--format", "json").stdout)

    def succeed_in_python(self, *arguments):
        done = subprocess.run([sys.executable, "-m", "clogsweep", *map(str, arguments), "--programs", support.BIN],
                              cwd=self.folder, capture_output=True, text=True,
                              env={**os.environ, "PYTHONPATH": str(ROOT / "analysis")})
        self.assertEqual((done.returncode, done.stderr), (0, ""))

    def test_clogged_is_read_as_programs_write_it(self):
        answers = [("1", "0"), ("1.0", "0.0"), ("1,0", "0,0"), ("1.00", "0.00"), ("1e0", "-0"), ("+1", "0,000"), ("T", "F"), ("TRUE", "FALSE"), ("y", "n"), ("Yes", "No")]
        self.write("own.csv", "table;distance [mm];clogged\n" + "".join(f"t{i};3;{yes}\nt{i};5;{no}\nt{i};9;{yes}\n" for i, (yes, no) in enumerate(answers)))
        groups = self.lengths("own.csv")["groups"]
        self.assertEqual([(group["clogs"] / group["runs"], group["clogging_length_mm"]) for group in groups],
                         len(groups) * [(2 / 3, 17 / 2)])
        self.assertEqual(len(groups), len(answers))
        for cell in ("0.5", '"1,000"', "1.0.0", "2", ""):
            self.refuse("clogfit", "lengths", self.write("own.csv", f"distance [mm],clogged\n3,{cell}\n"),
                        words=["own.csv line 2", f"""clogged is '{cell.strip('"')}'"""])

    def test_droplets_that_were_pushed_back_come_first_in_survival(self):
        # Two of four droplets clog upstream of their release, so P falls to 3/4 at -2 and to 1/2 at -1.
        steps = [{"distance": way, "at_risk": 4 - i, "clogs": 1, "probability": (3 - i) / 4, "standard_error": 0.2, "lower": 0.1, "upper": 0.9} for i, way in enumerate((-2.0, -1.0, 3.0))]
        fitted = unittest.mock.Mock(output={"groups": [{"runs": 4, "survival": steps, "censored_distances": [5.0]}]})
        table = fit.Fit.survival(fitted, 0)
        self.assertEqual(table["distance"].tolist(), [-2, -2, -1, 3, 5])
        self.assertEqual(table["probability"].tolist(), [1, 0.75, 0.5, 0.25, 0.25])

    def test_lengths_shapes_and_survival_are_those_of_the_survival_package_of_r(self):
        self.write("aml.csv", table(["x", "distance [mm]", "clogged"]))
        printed = self.lengths("aml.csv")
        maintained, not_maintained = printed["groups"]
        # From R: `length` is exp(coef(survreg(Surv(time, status) ~ 1, dist="exponential"))). `shape` is 1/scale with
        # dist="weibull". `p_value` belongs to the likelihood-ratio test of these two fits.
        for group, name, runs, clogs, length, shape, p_value in [(maintained, "Maintained", 11, 7, 60.4285714279, 1.0318542417, 0.910781681452),
                                                                 (not_maintained, "Nonmaintained", 12, 11, 23.1818181818, 1.57362854769, 0.090487586318)]:
            self.assertEqual((group["x"], group["runs"], group["clogs"], group["doubts"]), (name, runs, clogs, None))
            self.assertAlmostEqual(group["clogging_length_mm"], length, places=6)
            self.assertAlmostEqual(group["weibull_shape"], shape, places=5)
            self.assertAlmostEqual(group["weibull_p_value"], p_value, places=5)
        # From R's survfit(..., conf.type="log-log"): time, number at risk, probability, standard error, and interval
        steps = maintained["survival"]
        self.assertEqual([(step["distance"], step["at_risk"], step["clogs"]) for step in steps],
                         [(9, 11, 1), (13, 10, 1), (18, 8, 1), (23, 7, 1), (31, 5, 1), (34, 4, 1), (48, 2, 1)])
        for name, expected in [("probability", 0.490909090909), ("standard_error", 0.1641932672211),
                               ("lower", 0.1673309097769), ("upper", 0.753399790371)]:
            self.assertAlmostEqual(steps[4][name], expected, places=9)
        self.assertEqual(maintained["censored_distances"], [13, 28, 45, 161])
        # Checks the last line of the Python module's table. For the first group the expected values come from R's
        # summary(..., times=161). At the end of the second group, R has no bounds, either.
        groups = [*printed["groups"], {"survival": [], "censored_distances": [1, 3, 3], "runs": 3}]
        known = types.SimpleNamespace(output={"groups": groups}, known=types.SimpleNamespace(with_lengths=lambda: None))
        end, not_censored, none = (fit.Fit.survival(known, group).iloc[-1].to_dict() for group in range(3))
        for name, expected in [("distance", 161), ("at_risk", 1), ("clogs", 0), ("probability", 0.184090909091),
                               ("standard_error", 0.1534927457863), ("lower", 0.0117384801232),
                               ("upper", 0.525014842727)]:
            self.assertAlmostEqual(end[name], expected, places=9)
        self.assertEqual((not_censored["distance"], not_censored["at_risk"], not_censored["clogs"]), (45, 1, 1))
        self.assertEqual((none["distance"], none["at_risk"], none["probability"], math.isnan(none["lower"])),
                         (3, 2, 1, True))

    def test_tables_of_spreadsheets_and_units_give_the_same_lengths(self):
        expected = [group["clogging_length_mm"] for group in self.lengths(self.write("mm.csv", table(["x", "distance [mm]", "clogged"])))["groups"]]
        decimal = self.write("excel.csv", table(["x", "Distance (cm)", "Clogged"], ";", lambda cell: cell if cell in "01" else f"{int(cell) / 10}".replace(".", ",")))
        metres = self.write("m.txt", table(["x", "distance_um", "clogged"], "\t", lambda cell: {"0": "no", "1": "TRUE"}.get(cell, f"{cell}000")))
        for name in (decimal, metres):
            for group, length in zip(self.lengths(name)["groups"], expected):
                self.assertAlmostEqual(group["clogging_length_mm"], length, places=9)

    def test_a_laboratory_gives_both_units_and_the_table_names_doubts(self):
        self.write("own.csv", "distance [mm],clogged\n10,1\n20,0\n")
        self.write("lab.cfg", LAB)
        for unit, factor in (("mm", 1), ("sigma", 2)):
            self.write("own.csv", f"distance [{unit}],clogged\n{10 / factor},1\n{20 / factor},0\n")
            group, = self.lengths("own.csv", "--lab", "lab.cfg")["groups"]
            self.assertEqual((group["clogging_length_mm"], group["clogging_length"], group["doubts"]),
                             (30, 15, "few_clogs"))
        text = self.succeed("clogfit", "lengths", "own.csv", "--lab", "lab.cfg").stdout
        for words in ("lambda/mm", "lambda/sigma", "f: fewer than 5 clogs"):
            self.assertIn(words, text)
        row, = csv.DictReader(io.StringIO(self.succeed("clogfit", "lengths", "own.csv", "--format", "csv").stdout))
        self.assertEqual((row["clogging_length"], row["runs"]), ("15", "2"))

    def test_distances_count_from_a_given_distance_on(self):
        self.write("aml.csv", table(["x", "distance [mm]", "clogged"]))
        done = self.succeed("clogfit", "lengths", "aml.csv", "--from-distance", "12", "--format", "json")
        self.assertEqual(json.loads(done.stdout)["from_distance"], 12)
        self.assertEqual(self.lengths("aml.csv")["from_distance"], 0)
        maintained, not_maintained = json.loads(done.stdout)["groups"]
        # From R: the sum of time - 12 divided by the number of events, for times of 12 or more.
        for group, runs, clogs, length in [(maintained, 10, 6, 49), (not_maintained, 8, 7, 19)]:
            self.assertEqual((group["runs"], group["clogs"]), (runs, clogs))
            self.assertAlmostEqual(group["clogging_length_mm"], length, places=9)
        # From R's survfit(Surv(rep(12, 10), time, status) ~ 1, conf.type="log-log").
        step = maintained["survival"][3]
        self.assertEqual((12 + step["distance"], step["at_risk"], step["clogs"]), (31, 5, 1))
        for name, expected in [("probability", 0.54), ("standard_error", 0.1731184565550), ("lower", 0.1811653384041),
                               ("upper", 0.800712517334)]:
            self.assertAlmostEqual(step[name], expected, places=9)
        self.assertEqual(done.stderr,
                         "clogfit lengths: aml.csv: left out, 5 droplets that ended before --from-distance=12 mm\n")
        text = self.succeed("clogfit", "lengths", "aml.csv", "--from-distance=50").stdout
        self.assertRegex(text, r"Nonmaintained +0 +0 +- +- +f")

    def test_a_delayed_entry_is_refused(self):
        for head in ("entry [mm]", "Entry", "entry_um", "start (mm)", "from [sigma]", "entrance [mm]", "Entered_um",
                     "x0 (sigma)"):
            self.write("own.csv", f"distance [mm],clogged,{head}\n10,1,2\n20,1,4\n")
            self.refuse("clogfit", "lengths", "own.csv", words=[f"own.csv line 1: column '{head}' says where droplets were first seen", "; delete the column and subtract its values", "--from-distance"])
        for name in ("start", "entrance"):
            self.write("own.csv", f"distance [mm],clogged,{name}\n10,1,left\n20,1,right\n")
            self.succeed("clogfit", "lengths", "own.csv")

    def test_a_label_that_restates_the_outcome_is_refused(self):
        results = [column["name"] for column in json.loads(self.succeed("clogfit", shared_sweep(*FEW), "--format", "json").stdout)["columns"]]
        with h5py.File(shared_sweep(*FEW)) as file:
            results = [name for name in file["runs"].dtype.names if name not in results]
        self.assertLess({"status", "mechanism", "clogged_by", "time"}, set(results))
        circumstances = {"task", "seed", "wall_seconds", "processor_seconds", "rank", "instruction_set", "host", "attempt", "message", "preset", "obstacle_density", "distance"}
        for name in ["Status", "Clogged by", "clogged-by", "censored", "event", "event [x]", "Event (0/1)", "Outcome", *sorted(set(results) - circumstances)]:
            self.write("own.csv", f"distance [mm],clogged,{name}\n5,1,a\n6,0,b\n7,1,a\n8,0,b\n")
            for command in (["lengths", "own.csv"], ["compare", "own.csv", "--by", name]):
                self.refuse("clogfit", *command, words=[f"own.csv line 1: column '{name}'", "outcome", "delete it"])

    def test_labels_with_only_clogged_or_only_moving_droplets_are_named(self):
        """The message is a note and not an error: for instance, no droplet may clog at one of two concentrations."""
        def printed(*lines):
            self.write("own.csv", "distance [mm],clogged,x,y\n" + "".join(f"{line}\n" for line in lines))
            return self.succeed("clogfit", "lengths", "own.csv").stderr

        note = "clogfit: own.csv: each value of 'x' has only clogged or only moving droplets; if the column restates the outcome, delete it\n"
        outcomes = ["5,1,c,1", "6,0,f,1", "7,1,c,1", "8,0,f,1"]
        self.assertEqual(printed(*outcomes), note)
        self.assertEqual(printed(*outcomes, "9,0,alone,2"), note)
        # The note also appears for a table of three droplets
        for lines in (outcomes[:3], outcomes[1:], ["5,1,c,1", "6,0,f,1", "7,0,f,1"]):
            self.assertEqual(printed(*lines), note)
        # No note appears if a column numbers the droplets, or if few droplets share a value
        self.assertNotIn("restates", printed("5,1,1,1", "6,0,2,1", "7,1,3,1", "8,0,4,1"))
        self.assertEqual(printed("4,0,0,1", *(f"{5 + i},{i % 2},{i},1" for i in range(9))), "")
        for line in ("9,0,c,1", "9,1,f,1"):
            self.assertEqual(printed(*outcomes, line), "")
        self.assertEqual(printed("5,1,c,1", "6,1,f,1", "7,1,c,1", "8,1,f,1"), "")
        self.assertEqual(printed("5,1,c,1", "7,1,c,1"), "")
        # No note appears for quantities that were set before the run
        for name in ("line-tension", "line_tension", "diameter [mm]", "angle"):
            self.write("own.csv", f"distance [mm],clogged,{name}\n5,1,1\n6,0,2\n7,1,1\n8,0,2\n")
            self.assertEqual(self.succeed("clogfit", "lengths", "own.csv").stderr, "")

    def test_a_diameter_of_each_group_is_its_sigma(self):
        self.write("lab.cfg", LAB)
        rows = [("", 60), (1, 10), (2, 10), (2, 30), (2.5, 50)]
        for unit, to_mm in (("mm", dict.fromkeys((1, 2, 2.5, ""), 1)), ("sigma", {1: 1, 2: 2, 2.5: 2.5, "": 2})):
            unknown = (60, None) if unit == "mm" else (None, 30)
            self.write("own.csv", f"diameter [um],distance [{unit}],clogged\n" + "".join(
                f"{diameter and 1000 * diameter},{way / to_mm[diameter]!r},1\n" for diameter, way in rows))
            for lab in ([], ["--lab", "lab.cfg"]):  # --lab must not fill in the diameter where a cell is empty.
                found = {group["diameter"]: (group["clogging_length_mm"], group["clogging_length"]) for group in self.lengths("own.csv", *lab)["groups"]}
                self.assertEqual(found, {None: unknown, 1: (10, 10), 2: (20, 10), 2.5: (50, 20)})
                text = self.succeed("clogfit", "lengths", "own.csv", *lab).stdout
                self.assertRegex(text, r"lambda/mm|lambda/sigma")
        self.write("own.csv", "diameter [um],distance [mm],clogged\n,5,1\n")
        group, = self.lengths("own.csv")["groups"]
        self.assertNotIn("clogging_length", group)
        self.write("other.csv", "distance [sigma],clogged\n5,1\n")
        self.refuse("clogfit", "compare", "own.csv", "other.csv", "--lab", "lab.cfg",
                    words=["one is in mm", "fill the empty cells of the column diameter"])

    def test_a_diameter_or_an_angle_needs_a_unit_and_numbers(self):
        for head, words in [("diameter", ["column 'diameter' has no unit", "diameter [mm]"]),
                            ("Diameter", ["column 'Diameter' has no unit"]),
                            ("diameter [px]", ["the unit 'px'", "diameter [mm]"]),
                            ("diameter [sigma]", ["the unit 'sigma'"]), ("diameter_px", ["the unit 'px'", "rename"]),
                            ("angle [grad]", ["the unit 'grad'", "angle [deg] or rad"])]:
            for line in ("3,1,200\n", "3,1,abc\n"):
                self.refuse("clogfit", "lengths", self.write("own.csv", f"distance [um],clogged,{head}\n{line}"), words=["own.csv line 1", *words])
        for head, cell, words in [("diameter [um]", "1,000", ["line 2", "'1,000'"]), ("diameter [um]", "big", ["line 2: diameter is 'big'", "above 0", "empty"]), ("diameter [mm]", "0", ["above 0"]),
                                  ("diameter [mm]", "-2", ["above 0"]), ("angle [deg]", "1,000", ["'1,000'"]), ("angle", "flat", ["line 2: angle is 'flat'", "empty"])]:
            self.refuse("clogfit", "lengths", self.write("own.csv", f"distance [mm];clogged;{head}\n12.5;1;{cell}\n"), words=["own.csv", *words])
            self.refuse("clogfit", "lengths", self.write("own.csv", f'{head},distance [mm],clogged\n"{cell}",12,1\n'), words=["own.csv", *words])
        # For a table without distances, the message must name the missing column, not the diameter.
        self.refuse("clogfit", "lengths", self.write("own.csv", "x,y,diameter\n1,2,3\n"),
                    words=["own.csv line 1: has no column distance"])

    def test_an_angle_is_in_degrees(self):
        for head, factor in (("angle", 1), ("angle [deg]", 1), ("Angle (°)", 1), ("angle_degrees", 1), ("angle [rad]", math.pi / 180)):
            self.write("own.csv", f"distance [mm],clogged,{head}\n" + "".join(f"{way},1,{angle * factor!r}\n" for way, angle in ((3, 20), (5, 20), (7, 45), (8, -90))))
            self.assertEqual([(group["angle"], group["clogging_length_mm"]) for group in self.lengths("own.csv")["groups"]], [(-90, 8), (20, 4), (45, 7)])

    def test_units_in_a_comment_are_refused(self):
        for comment in ("# units=um droplet=200um", "# units = um", "#droplet=200um", "# unit=mm"):
            for text in (f"{comment}\ndistance [mm],clogged\n100,1\n", f"distance [mm],clogged\n100,1\n{comment}\n"):
                self.refuse("clogfit", "lengths", self.write("own.csv", text),
                            words=[f"own.csv line {text.splitlines().index(comment) + 1}: "
                                   "units in a comment", "header", "'diameter [um]'", "--lab"])
        self.write("own.csv", "# units of the camera: px, droplet no. 7\ndistance [mm],clogged\n# day=2\n3,1\n")
        self.assertEqual(self.lengths("own.csv")["groups"][0]["clogging_length_mm"], 3)

    def test_a_column_does_not_have_the_name_of_a_result(self):
        """The names of results come from what the commands print, so results that are added later are tested, too."""
        self.write("lab.cfg", LAB)
        self.write("own.csv", "distance [mm],clogged,wall\n3,1,a\n5,1,b\n6,1,a\n")
        for arguments, labels in ((["lengths", "own.csv", "--lab",
                                    "lab.cfg"], ["wall"]), (["compare", "own.csv", "--by", "wall"], []),
                                  (["compare", "own.csv", "own.csv", "--lab", "lab.cfg"], ["wall"])):
            printed = json.loads(self.succeed("clogfit", *arguments, "--format", "json").stdout)
            names = [name for name in (printed.get("groups") or printed["comparisons"])[0] if name not in labels]
            self.assertGreater(len(names), 10)
            in_any_form = [form(name) for name in names for form in (str.title, "{} [mm]".format, lambda name: name.replace("_", "-"))]
            in_table = ["note", "Note", "95 %", "99%", "lambda/mm", "lambda [sigma]"] if arguments[0] == "lengths" else []
            for name in dict.fromkeys((*names, *in_any_form, *in_table)):
                self.write("taken.csv", f"distance [sigma],clogged,wall,{name}\n3,1,a,7\n5,1,b,7\n6,1,c,8\n")
                for form in ("text", "csv") if name in names else ["text"]:
                    self.refuse("clogfit", *(word.replace("own.csv", "taken.csv") for word in arguments), "--format",
                                form, words=[f"taken.csv line 1: column '{name}' has the name of a result; rename it"])
        # `ratio` is a result of clogfit compare, so clogfit lengths accepts a column of this name.
        self.write("own.csv", "distance [mm],clogged,ratio\n3,1,7\n5,1,8\n")
        self.assertEqual([group["ratio"] for group in self.lengths("own.csv")["groups"]], [7, 8])

    def test_different_labels_have_different_texts(self):
        values = [0.1, 0.1000001, 0.30000000000000004, 0.3, 20240501123456, 20240501123457, -5]
        self.write("own.csv", "distance [mm],clogged,n,wall\n" + "".join(f"{3 + i},1,{value!r},{wall}\n" for i, value in enumerate(values) for wall in "ab"))
        for arguments in (["lengths", "own.csv"], ["compare", "own.csv", "--by", "wall"]):
            text = self.succeed("clogfit", *arguments).stdout
            for value in values:
                self.assertRegex(text, rf"(?m)(^| ){value!r} ", text)
        self.write("own.csv", "distance [mm],clogged,n\n3,1,0.12345\n4,1,0.5\n")
        self.assertIn("0.1235 ", self.succeed("clogfit", "lengths", "own.csv").stdout)

    def test_tables_of_equal_droplets_have_a_doubt(self):
        random = np.random.default_rng(67)
        tables = {}
        for copies in range(2, 7):
            for droplets in range(1, 13):
                apart = [(way, way < 16) for way in random.exponential(8, size=droplets)]
                coarse = [(8 * round(way / 8), True) for way in random.exponential(8, size=5 * droplets)]
                for name, table in [("copies", apart * copies), ("coarse", coarse),
                                    ("zeros", [(0.0, True)] * copies * droplets),
                                    ("one place", [(5.0, True)] * copies * droplets + [(3.0, False)] * droplets),
                                    ("sound", [(way, True) for way in random.exponential(8, size=5 + droplets)])]:
                    tables[f"{name} {copies} {droplets}"] = table
        self.write("own.csv", "table,distance [mm],clogged\n" + "".join(f"{name},{way!r},{int(clogged)}\n" for name, table in tables.items() for way, clogged in table))
        groups = self.lengths("own.csv")["groups"]
        self.assertEqual(len(groups), len(tables))
        for group in groups:
            doubts = {"few_clogs", "equal_distances"} & set((group["doubts"] or "").split())
            self.assertEqual(bool(doubts), not group["table"].startswith("sound"), group["table"])

    def test_equal_droplets_are_not_exponential_either(self):
        self.write("own.csv", "distance [mm],clogged\n" + "5,1\n" * 12)
        group, = self.lengths("own.csv")["groups"]
        self.assertEqual((group["doubts"], group["weibull_p_value"], group["weibull_shape"]),
                         ("not_exponential equal_distances", 0, None))
        text = self.succeed("clogfit", "lengths", "own.csv").stdout
        self.assertRegex(text, r"9\.68 +xe")
        self.assertIn("\ne: at least half of the clogs", text)

    def test_what_was_read_is_said_in_words_for_experiments(self):
        self.write("own.csv", "distance [mm],clogged\n10,1\n20,0\n30,0\n")
        printed = self.succeed("clogfit", "lengths", "own.csv").stdout
        self.assertIn("read: of 3 droplets, 1 clogged (clogged = 1) and 2 still moved", printed)
        self.assertIn("more droplets are needed", printed)

    def test_groups_of_one_table_are_compared(self):
        random = np.random.default_rng(3)
        runs = [(group, wall, random.exponential(length)) for group, length in ((2, 50), (10, 20), (0.5, 90)) for wall in ("a", "b") for _ in range(6)]
        self.write("own.csv", "surfactant [mM],wall,distance [mm],clogged\n" + "".join(f"{group},{wall},{distance!r},1\n" for group, wall, distance in runs))
        printed = json.loads(self.succeed("clogfit", "compare", "own.csv", "--by", "surfactant [mM]", "--format", "json").stdout)
        self.assertEqual([(one["here"], one["there"], one["wall"]) for one in printed["comparisons"]],
                         [(f"surfactant [mM]={group}", "surfactant [mM]=0.5", wall)
                          for group in (2, 10)
                          for wall in ("a", "b")])
        for one in printed["comparisons"]:
            of = {group: sum(distance for g, wall, distance in runs if g == group and wall == one["wall"]) / 6 for group in (0.5, 2, 10)}
            ratio = of[float(one["here"].partition("=")[2])] / of[0.5]
            self.assertAlmostEqual(one["ratio"], ratio)
            # All droplets clogged, so the ratio follows Snedecor's F.
            self.assertAlmostEqual(one["ratio_upper"], ratio / scipy.stats.f.ppf(0.025, 12, 12))
        # A group without a counterpart is named.
        self.write("own.csv", "n,diameter [mm],distance "
                              "[mm],clogged\n1,0.5,1,1\n1,0.5,2,1\n2,0.5,5,1\n2,0.8,4,0\n3,0.5,6,1\n")
        self.assertEqual(self.succeed("clogfit", "compare", "own.csv", "--by", "n").stderr, "clogfit compare: n=2: left out, 1 of 2 groups match no runs of n=1, such as diameter=0.8\n")
        self.write("own.csv", "surfactant [mM],wall,distance [mm],clogged\n1,a,3,1\n2,a,3,1\n")
        for words, arguments in [(["no column", "wall"], ["--by", "wal"]), (["one table"], ["own.csv", "--by", "wall"])]:
            self.refuse("clogfit", "compare", "own.csv", *arguments, words=words)

    def test_survival_curves_of_groups_are_compared_by_the_log_rank_test(self):
        self.write("aml.csv", table(["x", "distance [mm]", "clogged"]))
        one, = json.loads(self.succeed("clogfit", "compare", "aml.csv", "--by", "x", "--format",
                                       "json").stdout)["comparisons"]
        # From R: `survdiff(Surv(time, status) ~ x, data = aml)`.
        self.assertAlmostEqual(one["log_rank_p"], 0.0653393220405, places=12)
        self.assertEqual(one["log_rank_p_holm"], one["log_rank_p"])
        text = self.succeed("clogfit", "compare", "aml.csv", "--by", "x").stdout
        self.assertRegex(text, r"log-rank p\n.* 0\.065\n")
        # From R: `p.adjust(c(0.0653393220405, 1), "holm")`.
        self.write("three.csv", table(["x", "distance [mm]", "clogged"]) + "".join(f"Z,{pair.replace(' ', ',')}\n" for pair in AML["Maintained"].split(", ")))
        printed = json.loads(self.succeed("clogfit", "compare", "three.csv", "--by", "x", "--format", "json").stdout)["comparisons"]
        for one, p_value in zip(printed, (0.130678644081, 1)):
            self.assertAlmostEqual(one["log_rank_p_holm"], p_value, places=9)
        self.assertIn("corrected for 2 comparisons (Holm)\n",
                      self.succeed("clogfit", "compare", "three.csv", "--by", "x").stdout)

    def test_a_picture_has_the_survival_curve_of_each_group(self):
        self.write("aml.csv", table(["x", "distance [mm]", "clogged"]))
        axes, = style.figure_of(survival_curve.draw_on, survival_curve.of_table(self.lengths("aml.csv")), "mm").axes
        self.assertEqual(axes.get_xlabel(), "displacement along gravity $r$ [mm]")
        curves = {line.get_label(): line for line in axes.lines if line.get_label().startswith("x ")}
        self.assertEqual(list(curves), ["x Maintained", "x Nonmaintained"])
        # From R: `survfit(Surv(time, status) ~ x, data = aml)`.
        way, probability = curves["x Maintained"].get_data()
        self.assertEqual(list(way), [0, 9, 13, 18, 23, 31, 34, 48, 161])
        for found, expected in zip(probability,
                                   [1, 0.909091, 0.818182, 0.715909, 0.613636, 0.490909, 0.368182, 0.184091, 0.184091]):
            self.assertAlmostEqual(found, expected, places=6)
        self.assertEqual(list(curves["x Nonmaintained"].get_data()[0]), [0, 5, 8, 12, 23, 27, 30, 33, 43, 45, 45])
        self.assertIn([13, 28, 45, 161], [list(line.get_xdata()) for line in axes.lines])
        for name in ("aml.csv", self.copy_sweep("sweep.h5", *FEW)):
            self.succeed_in_python("survival", name)
            self.assertTrue((self.folder / f"{pathlib.Path(name).stem}-survival.png").exists())

    def test_a_curve_begins_at_the_first_clog_upstream_of_a_release(self):
        # Three of four droplets clog at r = -2, -1 and 3, and one still moves at 5.
        steps = [{"distance": way, "probability": (3 - i) / 4} for i, way in enumerate((-2, -1, 3))]
        group = {"survival": steps, "censored_distances": [5], "failed": 0, "doubts": ""}
        axes, = style.figure_of(survival_curve.draw_on, [("a", group)], "sigma").axes
        curve, = (line for line in axes.lines if line.get_label() == "a")
        self.assertEqual([list(ends) for ends in curve.get_data()], [[-2, -2, -1, 3, 5], [1, 0.75, 0.5, 0.25, 0.25]])
        self.assertEqual(axes.get_xlim()[0], -2)

    def test_a_comparison_corrects_the_tests_of_all_its_groups_together(self):
        # Each group has 12 droplets at the quantiles of a Weibull law. The p-values for these shapes are 0.03 and
        # 0.0002.
        near, far = 1.65, 2.66

        def ways(shape, length):
            return [float(length * (-np.log(1 - (i + 0.5) / 12)) ** (1 / shape)) for i in range(12)]
        self.write("own.csv", "wall,distance [mm],clogged\n" + "".join(f"{wall},{way!r},1\n" for wall, shape in zip("abcd", (near, near, far, near)) for way in ways(shape, 5)))
        p_values = {group["wall"]: group["weibull_p_value"] for group in self.lengths("own.csv")["groups"]}
        for wall, p_value in p_values.items():
            self.assertTrue(p_value < 0.01 / 4 if wall == "c" else 0.05 / 2 < p_value < 0.05, p_values)
        printed = json.loads(self.succeed("clogfit", "compare", "own.csv", "--by", "wall", "--format", "json").stdout)["comparisons"]
        self.assertEqual([(one["doubts_here"], one["doubts_there"]) for one in printed], [(None, None), ("not_exponential", None), (None, None)])
        for wall in "ab":
            self.write(f"{wall}.csv",
                       "distance [mm],clogged\n" + "".join(f"{way!r},1\n" for way in ways(near, 5 + (wall == "b"))))
        one, = json.loads(self.succeed("clogfit", "compare", "a.csv", "b.csv", "--format",
                                       "json").stdout)["comparisons"]
        self.assertEqual((one["doubts_here"], one["doubts_there"]), (None, None))
        self.write("few.csv", "wall,distance [mm],clogged\na,5,1\na,6,1\nb,7,1\n")
        one, = json.loads(self.succeed("clogfit", "compare", "few.csv", "--by", "wall", "--format",
                                       "json").stdout)["comparisons"]
        self.assertEqual((one["doubts_here"], one["doubts_there"]), ("few_clogs", "few_clogs"))

    def test_mistakes_get_one_line_and_exit_code_2(self):
        for text, words in [("distance,clogged\n1,1\n", ["no unit", "distance [mm]"]), ("distance [ft],clogged\n1,1\n", ["'ft'"]),
                            ("distance [mm],wall\n1,2\n", ["no column clogged"]), ("distance [mm],censored\n1,0\n", ["no column clogged", "opposite of censored"]), ("way [mm],clogged\n1,1\n", ["no column distance"]),
                            ("distance [mm],clogged\n-1,1\n", ["line 2", "0 or more"]), ("distance [mm],clogged\n1,2\n", ["line 2", "clogged is '2'"]),
                            ("distance [mm],clogged\nnan,1\n", ["line 2"]), ("distance [mm],clogged\n1\n", ["line 2", "1 cell"]),
                            ("distance [mm],clogged\n", ["holds no distances"]), ("", ["holds no distances"]),
                            ("distance [mm],clogged,distance [cm]\n1,1,1\n", ["two columns"])]:
            with self.subTest(text=text):
                self.refuse("clogfit", "lengths", self.write("own.csv", text), words=["own.csv", *words])
        self.refuse("clogfit", "lengths", words=["missing table"])
        self.refuse("clogfit", "lengths", "curve.h5", words=["cannot read curve.h5", "; clogfit curve.h5 fits a sweep"])
        self.refuse("clogfit", "own.csv",
                    words=["cannot read own.csv", "; clogfit lengths own.csv fits measured distances"])


class Beside(ProgramTest):
    """Tests the comparison of measured distances with the distances of a sweep."""

    def setUp(self):
        super().setUp()
        self.copy_sweep("sweep.h5", *FEW)
        self.write("lab.cfg", LAB)
        self.groups = {group["line_tension"]: group for group in json.loads(self.succeed("clogfit", "sweep.h5", "--format", "json").stdout)["groups"]}

    def compare(self, *arguments):
        return json.loads(self.succeed("clogfit", "compare", *arguments, "--format", "json").stdout)["comparisons"]

    def test_distances_that_a_sweep_holds_have_the_ratio_1_to_it(self):
        rows = support.table(self.folder / "sweep.h5")
        lines = [f"{2 * row.distance!r},{int(row.status == 'clogged')},{row.line_tension}" for row in rows.itertuples()]
        self.write("own.csv", "\n".join(["distance [mm],clogged,line-tension", *lines]))
        found = self.compare("own.csv", "sweep.h5", "--lab", "lab.cfg")
        self.assertEqual([one["line_tension"] for one in found], list(self.groups))
        for one, group in zip(found, self.groups.values()):
            self.assertEqual((one["runs_here"], one["runs_there"], one["pairs"]), (2, 2, 0))
            if group["clogging_length"]:
                self.assertAlmostEqual(one["ratio"], 1, places=12)
                self.assertAlmostEqual(one["clogging_length_there_mm"], 2 * group["clogging_length"], places=9)
        self.assertIn("lambda/mm", self.succeed("clogfit", "compare", "own.csv", "sweep.h5", "--lab", "lab.cfg").stdout)

    def test_a_table_without_a_common_column_is_compared_with_every_parameter_set(self):
        self.write("own.csv", "distance [sigma],clogged,wall\n3,1,glass\n5,1,glass\n9,0,steel\n")
        found = self.compare("sweep.h5", "own.csv")
        self.assertEqual([(one["wall"], one["line_tension"]) for one in found],
                         [(wall, tension) for wall in ("glass", "steel") for tension in self.groups])
        self.assertEqual({one["clogs_here"] for one in found}, {0, 2})
        # If all droplets clogged, the ratio of the two lengths follows Snedecor's F distribution. Each length has two
        # degrees of freedom per clog.
        one = next(one for one in found if one["wall"] == "glass" and one["clogs_there"] == 2)
        quantile = scipy.stats.f.ppf(0.975, 4, 4)
        self.assertAlmostEqual(one["ratio_lower"], one["ratio"] / quantile, places=6)
        self.assertAlmostEqual(one["ratio_upper"], one["ratio"] * quantile, places=6)

    def test_droplets_of_another_size_are_no_droplets_of_the_sweep(self):
        self.write("own.csv",
                   "distance [mm],clogged,diameter [mm],line-tension\n6,1,2,1\n10,1,2.004,1\n40,1,4,1\n60,1,4,3\n")
        done = self.succeed("clogfit", "compare", "own.csv", "sweep.h5", "--lab", "lab.cfg", "--format", "json")
        found = json.loads(done.stdout)["comparisons"]
        self.assertEqual([(one["diameter"], round(one["clogging_length_there_mm"], 9)) for one in found], [(2, 6), (2, 10)])
        self.assertIn("own.csv: left out, 2 of 4 groups match no runs of sweep.h5, such as diameter=4", done.stderr)
        self.write("angles.csv", "distance [mm],clogged,angle\n6,1,45\n")
        self.refuse("clogfit", "compare", "angles.csv", "sweep.h5", "--lab", "lab.cfg", words=["no group"])
        # If both tables have diameters, each length is that of the table's own droplet.
        self.write("other.csv", "distance [mm],clogged,diameter [mm]\n20,1,4\n5,1,2\n")
        for lab in ([], ["--lab", "lab.cfg"]):
            for one in self.compare("own.csv", "other.csv", *lab):
                self.assertNotIn("clogging_length_here", one)
                self.assertEqual(one["clogging_length_here_mm"], {4: 20}.get(one["diameter"], 5))
        self.write("other.csv", "distance [sigma],clogged\n10,1\n")
        self.assertEqual([one["ratio"] for one in self.compare("own.csv", "other.csv")],
                         [10 / 3, 10 / (10 / 2.004), 1, 10 / 15])
        # With --lab the picture also leaves out droplets with other diameters.
        for options, kept in ((["--lab", self.folder / "lab.cfg"], [(2, 3), (2.004, 10 / 2.004)]), ([], [(2, 3), (2.004, 10 / 2.004), (4, 10), (4, 15)])):
            with contextlib.redirect_stderr(io.StringIO()) as said:
                own = measured.lengths_of(self.folder / "own.csv",
                                          fit.read(self.folder / "sweep.h5", None, *options).known, None, *options)
            self.assertEqual([(group["diameter"], group["clogging_length"]) for group in own], kept)
            self.assertEqual("left out, 2 of 4 groups have other diameters than the droplets "
                             "of the sweep" in said.getvalue(), bool(options))

    def test_columns_that_match_nothing_are_named(self):
        self.write("own.csv", "distance [sigma],clogged,wall,line-tension,vertices\n3,1,glass,1,64\n4,1,glass,3,64\n5,1,steel,1,64\n5,1,steel,1,64\n")
        done = self.succeed("clogfit", "compare", "own.csv", "sweep.h5")
        self.assertEqual(done.stderr, "clogfit compare: own.csv: columns without a match in sweep.h5: "
                                      "wall (groups are compared whatever their values)\n")
        with contextlib.redirect_stderr(io.StringIO()) as said:
            measured.lengths_of(self.folder / "own.csv", fit.read(self.folder / "sweep.h5", None).known, None)
        self.assertTrue(said.getvalue().endswith("own.csv: columns without a match in the sweep: wall\n"),
                        said.getvalue())
        # Numbers in the table may be rounded. A key with only one value in the sweep must have this value in the table.
        self.write("own.csv", "distance [sigma],clogged,line-tension\n3,1,1.004\n")
        self.assertEqual([one["line_tension"] for one in self.compare("own.csv", "sweep.h5")], [1])
        self.write("own.csv", "distance [sigma],clogged,vertices\n3,1,96\n")
        self.refuse("clogfit", "compare", "own.csv", "sweep.h5", words=["no group"])

    def test_groups_that_match_nothing_are_named(self):
        self.write("own.csv", "distance [sigma],clogged,line-tension,wall\n3,1,1,glass\n4,1,7,glass\n4,1,7,steel\n")
        done = self.succeed("clogfit", "compare", "own.csv", "sweep.h5")
        self.assertEqual(done.stderr.splitlines()[-2:], ["clogfit compare: sweep.h5: left out, 1 of 2 groups match "
                                                         "no runs of own.csv, such as line_tension=3",
                                                         "clogfit compare: own.csv: left out, 2 of 3 groups match "
                                                         "no runs of sweep.h5, such as line-tension=7, wall=glass"])

    def test_a_column_of_numbers_of_droplets_gets_a_hint(self):
        for rows, hint in [("1,glass,3,1\n2,glass,4,0\n3,steel,5,0\n", "clogfit: own.csv: each droplet is a group of its own; delete columns such as no to join droplets\n"),
                           ("1,glass,3,1\n1,glass,4,1\n3,steel,5,0\n4,steel,6,1\n", "")]:
            self.write("own.csv", "no,wall,distance [mm],clogged\n" + rows)
            self.assertEqual(self.succeed("clogfit", "lengths", "own.csv").stderr, hint)

    def test_what_cannot_be_compared_is_refused(self):
        self.write("own.csv", "distance [mm],clogged\n3,1\n")
        self.write("other.csv", "distance [mm],clogged,line-tension\n3,1,7\n")
        for arguments, words in [(["own.csv", "sweep.h5"], ["--lab"]), (["own.csv"], ["nothing to compare"]),
                                 (["other.csv", "sweep.h5", "--lab", "lab.cfg"], ["no group"]),
                                 (["own.csv", "sweep.h5", "--by", "friction"], ["--by", "one table"])]:
            self.refuse("clogfit", "compare", *arguments, words=words)

    def test_the_picture_shows_measured_lengths_in_droplet_diameters(self):
        self.write("own.csv", "distance [mm],clogged,line-tension\n6,1,1\n10,1,1\n4,1,3\n8,0,3\n")
        groups = fit.read(self.folder / "sweep.h5", None, "--lab", self.folder / "lab.cfg").known
        own = measured.lengths_of(self.folder / "own.csv", groups, None)
        self.assertEqual([group["clogging_length"] for group in own], [4, 6])
        figure = style.figure_of(lambda axes, these: measured.draw_on(axes, own, these, "own.csv"), groups)
        stars = [line for line in figure.axes[0].lines if line.get_marker() == "*"]
        self.assertEqual([(line.get_xdata()[0], line.get_ydata()[0]) for line in stars], [(1, 4), (3, 6)])
        self.assertLess(max(line.get_zorder() for line in figure.axes[0].lines if line not in stars),
                        min(star.get_zorder() for star in stars))
        entries = [text.get_text() for text in figure.axes[0].get_legend().get_texts()]
        self.assertEqual((entries[0], len(entries)), ("own.csv", len(set(entries))))
        with self.assertRaisesRegex(UserError, "--lab"):
            measured.lengths_of(self.folder / "own.csv", fit.read(self.folder / "sweep.h5", None).known, None)

    def test_measured_lengths_have_the_colour_of_their_curve(self):
        self.succeed("clogsweep", "vertices=64", "box=20", "obstacle-density=saturated", "obstacle-gap=0.2,0.3",
                     "line-tension=1,3", "max-time=60", "seeds=1", "--output", "two.h5")
        groups = fit.read(self.folder / "two.h5", None).known
        self.write("own.csv", "distance [sigma],clogged,line-tension,obstacle-gap\n3,1,1,0.2\n4,1,1,0.301\n4,1,2,0.3\n5,1,1,0.25\n")
        own = measured.lengths_of(self.folder / "own.csv", groups, None)
        figure = style.figure_of(lambda axes, these: measured.draw_on(axes, own, these, "own.csv"), groups)
        stars = {(line.get_xdata()[0], line.get_ydata()[0]): line.get_color() for line in figure.axes[0].lines
                 if line.get_marker() == "*"}
        first, second = style.COLOURS[:2]
        self.assertEqual([groups.curves()[i][1][0]["obstacle_gap"] for i in range(2)], [0.2, 0.3])
        self.assertEqual(stars, {(1, 3): first, (1, 4): second, (2, 4): second, (1, 5): measured.COLOUR})

    def test_the_legend_names_the_bands_of_measured_lengths_with_the_confidence_of_the_sweep(self):
        self.write("own.csv", "distance [sigma],clogged,wall\n3,1,glass\n5,1,glass\n9,1,steel\n")
        groups = fit.read(self.folder / "sweep.h5", None, "--confidence", 0.5).known
        own = measured.lengths_of(self.folder / "own.csv", groups, None)
        # Two clogs at 3 and 5: twice their sum divided by lambda is chi-squared with four degrees of freedom.
        np.testing.assert_allclose([own[0]["clogging_length_lower"], own[0]["clogging_length_upper"]],
                                   16 / scipy.stats.chi2.ppf([0.75, 0.25], 4))
        figure = style.figure_of(lambda axes, these: measured.draw_on(axes, own, these, "own.csv"), groups)
        self.assertEqual([text.get_text() for text in figure.axes[0].get_legend().get_texts()],
                         ["own.csv", "own.csv, 50 % interval"])

    def test_a_long_legend_widens_the_picture_once(self):
        figure, axes = style.subplots(figsize=(6.4, 4.8))
        for curve in range(8):
            axes.plot([1, 2], [1, 2], label=f"curve {curve}")
        style.legend(axes)
        widened = figure.get_figwidth()
        self.assertGreater(widened, 6.5)
        style.legend(axes)
        self.assertAlmostEqual(figure.get_figwidth(), widened)

    def test_measured_lengths_are_not_drawn_among_lateral_displacements(self):
        self.succeed("clogsweep", "obstacle-layout=lattice", "pitch=2", "vertices=64", "box=20", "max-time=1",
                     "seeds=1", "--output", "lattice.h5")
        self.write("own.csv", "distance [sigma],clogged\n3,1\n")
        done = subprocess.run([sys.executable, "-m", "clogsweep", "clogging-length", "lattice.h5", "--with", "own.csv"],
                              cwd=self.folder, capture_output=True, text=True,
                              env={**os.environ, "PYTHONPATH": str(ROOT / "analysis"), "PATH": str(support.BIN)})
        self.assertEqual((done.returncode, done.stderr), (2, "python3 -m clogsweep clogging-length: no place for --with (pictures of lattices show lateral displacements); "
                                                          "clogfit compare own.csv lattice.h5 compares lengths\n"))


if __name__ == "__main__":
    unittest.main()
