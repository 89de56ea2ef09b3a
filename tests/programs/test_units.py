"""Tests clogfit units, and sweeps, fits and figures with a laboratory."""

import html
import json
import re
import subprocess
import sys
import unittest

import h5py
import numpy as np
import stored_rows
from support import BIN, FEW, QUICK, ROOT, ProgramTest, table

sys.path.insert(0, str(ROOT / "analysis"))
import clogsweep  # noqa: E402
from clogsweep import style  # noqa: E402
from clogsweep.pages import report  # noqa: E402
from clogsweep.tools import rounded  # noqa: E402

# The droplets of Cheng et al.: diameter, tilt, terminal speed, and the printed V_t and Gamma_exp, each with its
# uncertainty. The uncertainty is half of the last printed digit of the number itself, or follows from the last digits
# of the quantities in it. For instance, "v_t = 7 mm/s" may be wrong by one part in fourteen.
ARTICLE = [("3.5 mm", "28 deg", "7 mm/s", (0.08, 0.006), (0.57, 0.01)),
           ("1.98 mm", "8.5 deg", "0.97 mm/s", (0.028, 5e-4), (5.80, 0.07)),
           ("3.30 mm", "5.0 deg", "1.1 mm/s", (0.032, 5e-4), (3.47, 0.05))]
FITTED = [0.16, 1.7, 1.08]  # Gamma* of these three droplets in the article (Cheng et al.).
TENSION = "9.6 mN/m"  # The printed Gamma_exp follows from this value. The article states "about 10 mJ/m^2".


class Units(ProgramTest):
    def lab(self, diameter="3.5 mm", angle="28 deg", speed="7 mm/s", tension=TENSION, name="lab.cfg", **more):
        lines = {"diameter": diameter, "angle": angle, "speed": speed, "tension": tension, **more}
        return self.write(name, "# a droplet\n" + "".join(f"{key.replace('_', '-')} = {value}  # as measured\n" for key, value in lines.items()))

    def units(self, *arguments):
        return json.loads(self.succeed("clogfit", "units", *arguments, "--format", "json").stdout)

    def test_the_droplets_of_the_article_have_their_printed_numbers(self):
        for (diameter, angle, speed, terminal_speed, experiment), fitted in zip(ARTICLE, FITTED):
            found = self.units(self.lab(diameter, angle, speed))
            self.assertAlmostEqual(found["terminal_speed"], terminal_speed[0], delta=terminal_speed[1])
            self.assertAlmostEqual(found["line_tension_experiment"], experiment[0], delta=experiment[1])
            # The article states that "Gamma**/Gamma_exp" is about 0.3.
            self.assertAlmostEqual(found["line_tension"], fitted, delta=0.1 * fitted)
            self.assertAlmostEqual(found["capillary_number"], 3.14159265 / 4 / found["line_tension"], delta=1e-6)

    def test_what_is_converted_comes_back(self):
        lab = self.lab(thickness="0.4 mm")
        there = self.units(lab)
        self.assertAlmostEqual(there["line_tension_of_cell_uN"], 9.6 * 0.4, places=9)
        self.assertAlmostEqual(there["break_up_neck"], 0.4 / 3.5, places=9)
        back = self.units(lab, "--line-tension", there["line_tension"], "--terminal-speed", there["terminal_speed"],
                          "--wall-stiffness", there["wall_stiffness"], "--length", 24, "--time", 1000)["given"]
        for name, value in (("tension_mN_per_m", 9.6), ("angle_degrees", 28), ("speed_mm_per_s", 7), ("length_mm", 84),
                            ("line_tension_of_equal_sag", there["line_tension"]), ("time_s", 1000 * there["time_s"])):
            self.assertAlmostEqual(back[name] / value, 1, places=6, msg=name)
        printed = self.succeed("clogfit", "units", lab, "--length", 24).stdout
        self.assertRegex(printed, r"(?m)^length +84\.0 mm +r/sigma = 24\.0$")
        self.assertRegex(printed, r"(?m)^interfacial tension +9\.60 mN/m +Gamma_exp = 0\.5\d+$")

    def test_lists_are_converted_one_by_one(self):
        lab = self.lab()
        upright, = self.units(self.lab(angle="90 deg", name="upright.cfg"), "--line-tension",
                              "log(0.1,0.4,3)")["given"]["tension_mN_per_m"][:1]
        self.assertAlmostEqual(upright, self.units("upright.cfg", "--line-tension", 0.1)["given"]["tension_mN_per_m"])
        given = self.units(lab, "--line-tension", "0.05,0.2", "--length", "2,3")["given"]
        self.assertEqual(given["length_mm"], [7.0, 10.5])
        self.assertEqual(self.units(lab, "--length", "2,3,2")["given"]["length_mm"], [7.0, 10.5, 7.0])
        self.assertIsNone(given["angle_degrees"][0])
        self.assertAlmostEqual(given["angle_degrees"][1], 24.0, delta=0.5)
        self.assertEqual(clogsweep.units(self.folder / lab, length=[2, 3], folder=BIN)["given"]["length_mm"], [7.0, 10.5])
        # Between upright plates this droplet has Gamma = 0.0815. At any other tilt Gamma is larger.
        printed = self.succeed("clogfit", "units", lab, "--line-tension", "0.05,0.2").stdout
        self.assertRegex(printed,
                         r"(?m)^or tilt with this tension +none: even upright, Gamma is 0\.0815 +Gamma = 0\.0500$")
        self.assertRegex(printed, r"(?m)^or tilt with this tension +2\d\.\d deg +Gamma = 0\.200$")
        self.write("no-tension.cfg", "diameter = 3.5 mm\nangle = 28 deg\n")
        self.assertIn("not known without tension in lab.cfg",
                      self.succeed("clogfit", "units", "no-tension.cfg", "--line-tension", 0.2).stdout)
        self.refuse("clogfit", "units", lab, "--length", "1,-2", words=["--length=1,-2", "positive"])
        self.refuse("clogfit", "units", lab, "--length", "1,x", words=["--length=1,x", "x"])

    def test_a_droplet_of_unlikely_size_or_speed_is_refused(self):
        self.refuse("clogfit", "units", self.lab("0.2 m"), words=["diameter=0.2 m", "wider than 0.1 m", "unit"])
        self.refuse("clogfit", "units", self.lab("200 um", speed="1 m/s"), words=["speed=1 m/s", "V_t = ", "unit"])
        self.refuse("clogfit", "units", "nowhere.cfg", words=["cannot read nowhere.cfg (no such file); check the name"])

    def test_an_unlikely_density_or_thickness_is_refused_and_a_gas_named(self):
        for more, words in (({"density": "1855 g/ml"}, ["density=1855 g/ml", "above 25000 kg/m^3", "unit right?"]),
                            ({"outer_density": "0.001 kg/m^3"}, ["outer-density=", "below 0.05 kg/m^3", "right?"]),
                            ({"density_difference": "294 g/ml"}, ["density-difference=294 g/ml", "above 25000"]),
                            ({"thickness": "0.25 m"}, ["thickness=0.25 m", "thicker than 0.1 m", "unit right?"])):
            self.refuse("clogfit", "units", self.lab(**more), words=words)
        said = "the density of the droplet, 1.855 kg/m^3, is that of a gas; is the unit right?"
        lab = self.lab(density="1.855 kg/m^3", outer_density="998 kg/m^3", speed="0.2 m/s", tension="72 mN/m")
        self.assertIn(said, self.succeed("clogfit", "units", lab).stderr)
        self.assertIn(said, self.succeed("clogsweep", "--lab", lab, *QUICK, "--print-config").stderr)
        self.assertEqual(self.succeed("clogfit", "units", self.lab(density="1.855 g/ml")).stderr, "")

    def test_given_numbers_without_a_unit_are_named_with_their_values_in_the_laboratory(self):
        lab = self.lab("1.6 mm", thickness="0.25 mm")
        keys = ["break-up-neck=0.1", "obstacle-density=0.1736", "obstacle-gap=0.3mm,0.25,0.5", "box=20", "vertices=64",
                "line-tension=0.2", "near-wall-cutoff=0.00614", "preset=robust"]
        said = "clogsweep: numbers without a unit are in units of the model: " \
               "obstacle-gap=0.25 to 0.5 is 0.4 mm to 0.8 mm, obstacle-density=0.1736 is 0.06781 /mm^2, " \
               "break-up-neck=0.1 is 0.16 mm\n"
        for last in (["--dry-run", "max-time=2min"], ["max-time=0.5s", "--output", "s.h5"]):
            done = self.succeed("clogsweep", "--lab", lab, *keys, *last)
            self.assertEqual(done.stderr.count("without a unit"), 1)
            self.assertIn(said, done.stderr)
        with_units = ["break-up-neck=0.15mm", "obstacle-density=0.068/mm^2", "obstacle-gap=0.2sigma", "max-time=1s"]
        printed = self.succeed("clogsweep", "--lab", lab, *with_units, "box=20", "--print-config").stderr
        self.assertNotIn("without a unit", printed)
        self.assertNotIn("without a unit", self.succeed("clogsweep", *keys[:2], "--print-config").stderr)
        lab = self.lab("1.6 mm, 2 mm")
        printed = self.succeed("clogsweep", "--lab", lab, "break-up-neck=0.1", "obstacle-gap=0.2sigma",
                               "obstacle-diameter=0.3sigma", "--print-config").stderr
        self.assertIn("break-up-neck=0.1 is 0.16 mm with the first droplet of lab.cfg\n", printed)

    def test_messages_of_a_laboratory_repeat_the_numbers_as_given(self):
        lab = self.lab("1.6 mm")
        self.write("posts.csv", "# units=um droplet=1600um\nx,y,diameter\n500,500,300\n801,500,300\n")
        self.write("far.csv", "# units=mm droplet=1.6mm\nx,y,diameter\n23.5,13,0.3\n")
        self.write("plain.csv", "x,y,diameter\n2,2,0.3\n")
        device = ["obstacles=plain.csv"]
        sigma = "1 sigma is 1.6 mm"
        for keys, words in (
            (["break-up-neck=2.5cm"], ["=15.625", "at most 0.5", f"break-up-neck was given as 2.5cm; {sigma}"]),
            (["break-up-neck=-0.25mm"], ["try 0.05, or 0 for droplets that never break up", "given as -0.25mm"]),
            (["obstacles=far.csv"], ["x=14.6875, y=8.125 (23.5 mm, 13 mm) lies outside", sigma]),
            (["obstacles=posts.csv"], ["leave a gap of 0.000625 sigma", f"{sigma}: are the units and the droplet"]),
            ([*device, "length=32mm", "release=entrance", "exit=40mm"], ["exit=25 ", "exit was given as 40mm", sigma]),
            ([*device, "obstacle-gap=0.3mm"], ["remove obstacle-gap", "given as 0.3mm"]),
            (["speed-exponent=1m"], ["speed-exponent=1m", "a pure number) leave the unit out"]),
        ):
            with self.subTest(keys=keys):
                self.refuse("clogsweep", "--lab", lab, "box=16mm", *keys, "--output", "s.h5", words=words)
        self.refuse("clogrun", "array", "--lab", lab, "break-up-neck=2.5cm", "--output", "r.h5", words=["as 2.5cm"])
        self.refuse("clogfit", "units", self.lab(speed_exponent="1m"), words=["speed-exponent=1m", "without a unit"])

    def test_ranges_are_named_and_negative_numbers_are_no_options(self):
        for value in ("0", "-0.2"):
            self.refuse("clogsweep", "break-up=daughters", "break-up-neck=0.1", f"smallest-daughter={value}",
                        "near-wall-drag=0", "--output", "s.h5",
                        words=[f"smallest-daughter={value}", "at least 0.05, at most 0.7"])
        self.refuse("clogsweep", "replay", "s.h5", "-1", words=["invalid -1", "negative number", "0 or more"])

    def test_the_default_ratio_of_gamma_is_named_as_that_of_one_article(self):
        words = "(ratio of one article's droplets; calibrate yours: handbook, tutorial/calibrated-droplet)"
        self.assertIn(words, self.succeed("clogfit", "units", self.lab()).stdout)
        self.assertIn(words, self.succeed("clogfit", "units", self.lab("2 mm, 3 mm")).stdout)
        for more in ({"tension_ratio": "0.3"}, {"tension_ratio": "0.25"}):
            self.assertNotIn("article", self.succeed("clogfit", "units", self.lab(**more)).stdout)

    def test_several_droplets_have_their_necks(self):
        printed = self.succeed("clogfit", "units", self.lab("2 mm, 4 mm", thickness="0.4 mm")).stdout.splitlines()
        self.assertEqual([line.split()[-1] for line in printed[:3]], ["break-up-neck", "0.200", "0.100"])
        self.assertNotIn("neck", self.succeed("clogfit", "units", self.lab("2 mm, 4 mm")).stdout)

    def test_status_prints_the_units_of_the_laboratory_as_clogfit_does(self):
        self.succeed("clogsweep", "--lab", self.lab(), *QUICK, "seeds=1..4", "--output", "s.h5")
        column = "lambda/mm"
        self.assertIn(column, self.succeed("clogfit", "s.h5").stdout)
        self.assertIn(column, self.succeed("clogsweep", "status", "s.h5").stdout)
        group, = json.loads(self.succeed("clogsweep", "status", "s.h5", "--format", "json").stdout)["groups"]
        self.assertAlmostEqual(group["clogging_length_lower_mm"], 3.5 * group["clogging_length_lower"])
        with h5py.File(self.folder / "s.h5", "a") as file:
            del file["laboratories"]
        self.succeed("clogsweep", "status", "s.h5")

    def test_the_unit_that_is_missing_is_not_guessed(self):
        done = self.run_program("clogfit", "units", self.lab(density="1855"))
        self.assertIn("'1855' has no unit; write the unit of your density after the number: g/cm^3, g/ml, kg/m^3",
                      done.stderr)

    def test_a_nearly_rigid_droplet_gets_advice(self):
        self.assertNotIn("rigid", self.succeed("clogfit", "units", self.lab()).stdout)
        lab = self.lab("200 um", "90 deg", "1 mm/s", "20 mN/m", "stiff.cfg")
        printed = self.succeed("clogfit", "units", lab).stdout
        self.assertIn("Gamma = 52.", printed)
        self.assertIn("line-tension=30.0 clogs in the same places", printed)
        # Droplets of both models clog in the same places.
        common = ["obstacle-density=0.35", "obstacle-gap=0.2", "box=20", "max-time=1500", "seeds=1"]
        disk, = re.findall(r"model=sp wall-stiffness=\S*\d", printed)
        ways = []
        for number, keys in enumerate((["line-tension=52", "vertices=64"], ["line-tension=30", "vertices=64"], disk.split())):
            self.succeed("clogsweep", *common, *keys, "--output", f"{number}.h5")
            rows = table(self.folder / f"{number}.h5")
            self.assertEqual(set(rows["status"]), {"clogged"})
            ways.append(rows["distance"])
        np.testing.assert_allclose(ways[1:], [ways[0]] * 2, atol=0.1)

    def test_units_may_be_typed_with_their_signs(self):
        plain = self.units(self.lab("200 um", "60 deg", "800 um/s"))
        for micro in ("µ", "μ"):
            signed = self.units(self.lab(f"200 {micro}m", "60 °", f"800 {micro}m/s", name="signed.cfg"))
            self.assertEqual({name: value for name, value in signed.items()}, plain)

    def test_the_sag_is_that_of_a_droplet_on_a_wall(self):
        found = self.units(self.lab(tension="4 mN/m"))
        run = self.succeed("clogrun", "sag", f"line-tension={found['line_tension']}", "--output", "sag.h5")
        self.assertIsNotNone(run)
        with h5py.File(self.folder / "sag.h5") as file:
            self.assertAlmostEqual(file["runs"]["sag"][0], found["sag"], delta=0.003)

    def test_python_gives_the_same(self):
        lab = self.lab()
        program = f"import clogsweep, json; print(json.dumps([clogsweep.units('lab.cfg', length=2, folder='{BIN}'), " \
                  f"clogsweep.units({{'diameter': '3.5 mm', 'angle': '28 deg', 'speed': '7 mm/s', 'tension': '{TENSION}'}}, length=2, folder='{BIN}')]))"
        done = subprocess.run([sys.executable, "-c", program], cwd=self.folder, capture_output=True, text=True,
                              env={"PYTHONPATH": str(ROOT / "analysis"), "PATH": ""})
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(json.loads(done.stdout), 2 * [self.units(lab, "--length", 2)])

    def test_a_sweep_of_a_laboratory_is_printed_in_its_units(self):
        lab = self.lab()
        known = self.units(lab)
        self.succeed("clogsweep", "--lab", lab, *QUICK, "seeds=1..4", "--output", "s.h5")
        with h5py.File(self.folder / "s.h5") as file:
            text, = (text[()].decode() for text in file["laboratories"].values())
            self.assertIn("tension = 9.6 mN/m", text.split("; "))
            self.assertEqual([stored.decode() for stored in set(file["runs"]["laboratory"])],
                             list(file["laboratories"]))
            self.assertAlmostEqual(file["runs"]["line_tension"][0] / known["line_tension"], 1, places=3)
            self.assertAlmostEqual(file["runs"]["terminal_speed"][0] / known["terminal_speed"], 1, places=3)
        self.succeed("clogsweep", "--lab", lab, *QUICK, "seeds=1..5", "--output", "s.h5")  # gives the sweep more seeds
        self.succeed("clogsweep", "verify", "s.h5")
        fit = json.loads(self.succeed("clogfit", "s.h5", "--format", "json").stdout)
        group, = fit["groups"]
        self.assertAlmostEqual(fit["laboratory"]["length_mm"], 3.5)
        self.assertAlmostEqual(group["clogging_length_lower_mm"], 3.5 * group["clogging_length_lower"])
        if group["relative_speed_all"] is not None:
            self.assertAlmostEqual(group["speed_mm_per_s"] / (7 * group["relative_speed_all"]), 1, places=3)
        self.assertEqual(fit["units"]["clogging_length_mm"], "mm")
        self.assertRegex(self.succeed("clogfit", "s.h5").stdout, r"lambda/mm +95 %")
        self.copy_sweep("plain.h5", *FEW)
        self.assertNotIn("lambda/mm", self.succeed("clogfit", "plain.h5").stdout)
        self.assertIn("lambda/mm", self.succeed("clogfit", "plain.h5", "--lab", lab).stdout)

    def test_a_comment_in_a_laboratory_of_an_older_file_says_nothing(self):
        speed = self.units(self.lab())["terminal_speed"]
        self.succeed("clogsweep", *QUICK, f"terminal-speed={speed}", "seeds=1..2", "--output", "s.h5")
        before = json.loads(self.succeed("clogfit", "s.h5", "--format", "json", "--lab", self.lab()).stdout)
        stored_rows.change_attribute(self.folder / "s.h5", "laboratory",
                                     (self.folder / "lab.cfg").read_text() + "# measured in May\n")
        done = self.succeed("clogfit", "s.h5", "--format", "json")
        self.assertEqual((json.loads(done.stdout)["laboratory"], done.stderr), (before["laboratory"], ""))

    def test_speeds_are_those_of_the_runs(self):
        # The laboratory's droplet falls at 30 mm/s. The runs have another speed.
        self.lab(speed="30 mm/s")
        for keys, speed in ((["--lab", "lab.cfg",
                              "terminal-speed=1mm/s"], 1), ([], 0.03 * 3.5 / self.units("lab.cfg")["time_s"])):
            self.succeed("clogsweep", *keys, "line-tension=5", "obstacle-gap=1", "vertices=64", "box=20",
                         "max-time=600", "seeds=1..4", "--output", f"{len(keys)}.h5")
            printed = self.succeed("clogfit", f"{len(keys)}.h5", "--lab", "lab.cfg", "--format", "json")
            group, = json.loads(printed.stdout)["groups"]
            for name, model in (("speed_mm_per_s", "relative_speed_all"), ("speed_error_mm_per_s", "relative_speed_all_error")):
                self.assertAlmostEqual(group[name] / (speed * group[model]), 1, places=3)
            self.assertIn("those of runs with a terminal speed of", printed.stderr)
            self.assertIn("that of the laboratory's description is 30 mm/s", printed.stderr)
        run = self.succeed("clogrun", "array", "--lab", "lab.cfg", "terminal-speed=1mm/s", *QUICK, "seeds=1",
                           "--output", "r.h5").stdout
        time, = re.findall(r"t = ([-0-9.e]+) t0", run)
        long, = re.findall(r"t = ([-0-9.e]+) s", run)
        self.assertAlmostEqual(float(long) / (float(time) * self.units("lab.cfg")["time_s"]), 1, places=2)

    def test_droplets_with_several_speeds_are_named_by_their_range(self):
        self.lab(angle="10 deg, 20 deg", speed="1.2 mm/s")
        self.succeed("clogsweep", "--lab", "lab.cfg", "terminal-speed=1mm/s", *QUICK, "seeds=1", "--output", "s.h5")
        first, second = (1.2, 1.2 * np.sin(np.radians(20)) / np.sin(np.radians(10)))
        self.assertIn(f"with a terminal speed of 1 mm/s; that of the laboratory's description is {first:.4g} to {second:.4g} mm/s", self.succeed("clogfit", "s.h5").stderr)

    def test_numbers_are_those_of_the_laboratory_to_twelve_digits(self):
        known = self.units(self.lab("1.1 mm", "30 deg", "0.7 mm/s", "3 mN/m"), "--length", "0.3")
        self.assertEqual((known["angle_degrees"], known["diameter_mm"], known["tension_mN_per_m"], known["given"]["length_mm"]), (30, 1.1, 3, 0.33))
        for name, value in known.items():
            if isinstance(value, float):
                self.assertEqual(value, float(f"{value:.12g}"), name)
        # Runs have a Gamma that is rounded to four digits.
        self.succeed("clogsweep", "--lab", "lab.cfg", *QUICK, "seeds=1", "--output", "s.h5")
        group, = json.loads(self.succeed("clogfit", "s.h5", "--format", "json").stdout)["groups"]
        self.assertEqual((group["tension_mN_per_m"], group["angle_degrees"]), (3, 30))
        self.succeed("clogsweep", "--lab", "lab.cfg", "line-tension=0.5", *QUICK, "seeds=1", "--output", "half.h5")
        group, = json.loads(self.succeed("clogfit", "half.h5", "--format", "json").stdout)["groups"]
        self.assertAlmostEqual(group["tension_mN_per_m"], 0.5 * known["tension_mN_per_m_of_gamma_1"], places=9)

    def test_each_model_gets_the_value_of_its_droplet(self):
        known = self.units(self.lab())
        self.succeed("clogsweep", "--lab", "lab.cfg", "model=dp,sp", "box=20", "max-time=20", "seeds=1", "--output", "s.h5")
        rows = table(self.folder / "s.h5").set_index("model")
        self.assertAlmostEqual(rows.line_tension["dp"] / known["line_tension"], 1, places=3)
        self.assertAlmostEqual(rows.wall_stiffness["sp"] / known["wall_stiffness"], 1, places=3)
        self.write("p.csv", "model,obstacle-gap,vertices\ndp,0.4,64\nsp,0.5,\n")
        self.succeed("clogsweep", "--lab", "lab.cfg", "--points", "p.csv", "box=20", "max-time=20", "seeds=1",
                     "--output", "p.h5")
        pointed = table(self.folder / "p.h5").set_index("model")
        for name, model in (("line_tension", "dp"), ("wall_stiffness", "sp")):
            self.assertEqual(pointed[name][model], rows[name][model])
        self.write("p.csv", 'model\n"dp, sp"\n')
        printed = self.plan("--lab", "lab.cfg", "--points", "p.csv", "box=20", "max-time=20", "seeds=1")
        self.assertIn("2 parameter sets", printed)

    def test_points_with_units_are_named_with_their_line(self):
        lab = self.lab()
        self.write("p.csv", "line-tension,obstacle-gap\n1,0.3mm\n\nx,0.4mm\n")
        self.refuse("clogsweep", "--lab", lab, "--points", "p.csv", "--output", "s.h5", words=["p.csv line 4: invalid line-tension=x"])

    def sweeps_of_two_droplets(self):
        """Files of sweeps with droplets of 0.8 and 1.2 mm in the same cell. Both droplets have the same interfacial
        tension."""
        for diameter in ("0.8", "1.2"):
            lab = self.lab(f"{diameter} mm", "20 deg", "1.2 mm/s", tension="10 mN/m", name=f"{diameter}.cfg")
            self.succeed("clogsweep", "--lab", lab, "vertices=64", "box=20", "max-time=40", "seeds=1..2", "--output",
                         f"s{diameter}.h5")
        return ["s0.8.h5", "s1.2.h5"]

    def check_two_droplets(self, *files):
        groups = json.loads(self.succeed("clogfit", *files, "--format", "json").stdout)["groups"]
        self.assertEqual(len(groups), 2)
        for group in groups:
            diameter = group["clogging_length_lower_mm"] / group["clogging_length_lower"]
            self.assertAlmostEqual(min(abs(diameter - 0.8), abs(diameter - 1.2)), 0)
            self.assertAlmostEqual(group["tension_mN_per_m"], 10, delta=0.01)
        self.assertEqual(len({group["laboratory"] for group in groups}), 2)

    def test_droplets_of_two_laboratories_are_printed_each_in_its_own_units(self):
        files = self.sweeps_of_two_droplets()
        self.check_two_droplets(*files)
        printed = self.succeed("clogfit", *files).stdout
        self.assertRegex(printed, r"diameter/mm .*\n *1.2 .*\n *0.8 ")
        self.succeed("clogsweep", "merge", *files, "--output", "both.h5")
        self.check_two_droplets("both.h5")
        self.succeed("clogsweep", "verify", "both.h5")
        rows = table(self.folder / "both.h5")
        sums = rows.laboratory.unique()
        self.succeed("clogsweep", "select", "both.h5", f"laboratory={sums[1]}", "--output", "one.h5")
        self.assertEqual(set(table(self.folder / "one.h5").laboratory), {sums[1]})
        self.succeed("clogsweep", "salvage", "both.h5", "--output", "salvaged.h5")
        self.check_two_droplets("salvaged.h5")
        groups = clogsweep.open([self.folder / name for name in files], BIN).fit().known
        self.assertEqual({groups.parameter_label("laboratory", group["laboratory"]) for group in groups.members},
                         {"diameter = 0.8 mm", "diameter = 1.2 mm"})
        self.succeed("clogfit", "report", "both.h5", "--output", "r.html")
        self.assertIn("diameter = 0.8 mm", (self.folder / "r.html").read_text())

    def test_a_sweep_grows_by_another_laboratory(self):
        first, second = self.sweeps_of_two_droplets()
        self.succeed("clogsweep", "--lab", "1.2.cfg", "vertices=64", "box=20", "max-time=40", "seeds=1..2", "--output", first)
        self.check_two_droplets(first)

    def test_rows_of_a_lost_laboratory_are_printed_with_another_or_refused(self):
        first, _ = self.sweeps_of_two_droplets()
        with h5py.File(self.folder / first, "a") as file:
            del file["laboratories"]
        done = self.run_program("clogfit", first)
        self.assertEqual((done.returncode, done.stdout), (2, ""))
        self.assertIn("of some of its rows (another program changed the file); give this laboratory by --lab",
                      done.stderr)
        self.assertIn("lambda/mm", self.succeed("clogfit", first, "--lab", "0.8.cfg").stdout)

    def test_a_report_has_bounds_in_laboratory_units(self):
        self.succeed("clogsweep", "--lab", self.lab(), "vertices=64", "box=20", "max-time=20", "seeds=1..4", "--output", "s.h5")
        group, = json.loads(self.succeed("clogfit", "s.h5", "--format", "json").stdout)["groups"]
        self.assertEqual(group["clogs"], 0)
        self.succeed("clogfit", "report", "s.h5", "--output", "r.html")
        page = html.unescape((self.folder / "r.html").read_text())
        self.assertIn(f"> {rounded.plain(group['clogging_length_lower_mm'])}<", page)
        self.assertIn('<th scope="col">tension [mN/m]</th>', page)
        self.assertIn("<td>9.60</td>", page)
        groups, (_, axes) = clogsweep.Sweep(self.folder / "s.h5", BIN).fit().known, style.subplots(figsize=(4, 3))
        report.draw_causes(axes, groups, "", groups.members)
        self.assertEqual([label.get_text() for label in axes.get_xticklabels()], ["0.1736\n9.60"])
        self.assertIn("interfacial tension [mN/m]", axes.get_xlabel())
        fit = json.loads(self.succeed("clogfit", "s.h5", "--format", "json").stdout)
        self.assertAlmostEqual(fit["groups"][0]["tension_mN_per_m"], 9.6, delta=0.01)
        self.assertEqual(fit["units"]["tension_mN_per_m"], "mN/m")
        self.succeed("clogsweep", "model=sp", "wall-stiffness=1", "box=20", "max-time=20", "seeds=1", "--output", "disk.h5")
        printed = self.succeed("clogfit", "disk.h5", "--lab", "lab.cfg").stdout
        self.assertIn("lambda/mm", printed)
        self.assertNotIn("tension/(mN/m)", printed)

    def test_a_curve_tells_the_units_of_its_laboratory(self):
        self.succeed("clogsweep", "--lab", self.lab(), *QUICK, "line-tension=0.5,1,2,4", "seeds=1..3", "--output", "s.h5")
        gamma = self.units("lab.cfg")["tension_mN_per_m_of_gamma_1"]
        self.assertIn(f"in the laboratory: sigma = 3.50 mm, Gamma = 1 is {rounded.plain(gamma)} mN/m",
                      self.succeed("clogfit", "curve", "s.h5").stdout)

    def test_a_run_of_a_laboratory_is_printed_in_its_units(self):
        lab = self.lab()
        known = self.units(lab)
        printed = self.succeed("clogrun", "array", "--lab", lab, *QUICK, "seeds=1", "--output", "r.h5").stdout
        distance, time = map(float, re.search(r"after r = ([-0-9.e]+) sigma, t = ([-0-9.e]+) t0", printed).groups())
        far, long = map(float, re.search(r"in the laboratory: r = ([-0-9.e]+) mm, t = ([-0-9.e]+) s", printed).groups())
        self.assertAlmostEqual(far, 3.5 * distance, places=2)
        self.assertAlmostEqual(long / (time * known["time_s"]), 1, places=3)
        with h5py.File(self.folder / "r.h5") as file:
            text, = (text[()].decode() for text in file["laboratories"].values())
            self.assertIn("tension = 9.6 mN/m", text)
            self.assertAlmostEqual(float(re.search(r"line-tension = (.*)", file.attrs["config"].decode())[1]) / known["line_tension"], 1, places=3)
        given = self.succeed("clogrun", "array", "--lab", lab, *QUICK, "seeds=1", "line-tension=1", "--dry-run", "--output", "x.h5").stdout
        self.assertIn("line-tension = 1\n", given)

    def test_mistakes_in_a_lab_file_get_one_line(self):
        mistakes = [
            ("diameter = 3.5 mm\n", ["lab.cfg has no angle", "angle = 28 deg"]),
            ("diameter = 3.5\nangle = 28 deg\n", ["lab.cfg", "diameter=3.5", "has no unit"]),
            ("diameter = 3.5 mm\nangle = 128 deg\n", ["beyond 90 degrees"]),
            ("diameter = 3.5 mm\nangle = -1 deg\n", ["must be positive"]),
            ("diameter = 3.5 mm\nangle = 28 deg\ncolour = red\n", ["line 3", "unknown key 'colour' (known: "]),
            ("diameter = 3.5 mm\nangel = 28 deg\n", ["line 2", "unknown key 'angel'; did you mean angle?"]),
            ("diameter = 3.5 mm\ndiameter = 3.6 mm\n", ["line 2", "twice"]),
            ("diameter\n", ["line 1", "not key = value"]),
            ("diameter = 3.5 mm\nangle = 28 deg\ndensity = 1 g/ml\nouter-density = 1 g/ml\n", ["nothing drives"]),
        ]
        for text, words in mistakes:
            self.write("lab.cfg", text)
            with self.subTest(text=text):
                self.refuse("clogfit", "units", "lab.cfg", words=words)
                self.refuse("clogsweep", "--lab", "lab.cfg", *QUICK, "--output", "s.h5", words=words)
        self.refuse("clogfit", "units", words=["missing lab.cfg"])
        self.refuse("clogfit", "units", "nowhere.cfg", words=["nowhere.cfg"])


if __name__ == "__main__":
    unittest.main()
