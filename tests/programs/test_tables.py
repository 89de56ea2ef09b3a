"""Tests that no line of a user's table is lost or misread without a message. Each property holds for every program that
reads tables."""

import re
import unittest

import numpy as np

from drawing import Analysis
from support import QUICK, ROOT, ProgramTest

from clogsweep.calibration import profiles
from clogsweep.commands import critical_angle
from clogsweep.paper import runner
from clogsweep.tools import tables
from clogsweep.tools.errors import UserError

# Errors that Excel and LibreOffice write in several languages. The list has all errors that a reader knows by name, and
# examples of the other forms.
ERRORS = ["#N/A", "#DIV/0!", "#REF!", "#VALUE!", "#NAME?", "#NUM!", "#NULL!", "#SPILL!", "#WERT!", "#NV", "#BEZUG!", "#VALEUR!", "#NOM ?", "#¡REF!", "#N/D",
          "#AD?", "#ДЕЛ/0!", "#NA", "#N/B", "#I/T", "#Н/Д", "#YOK", "#HIÁNYZIK", "#GETTING_DATA", "Err:502", "Fehler:502", "Erreur:502", "####"]
SEPARATORS = [",", ";", "\t", " "]
OWN = ["box=10", "vertices=64", "max-time=60", "--dry-run"]


def without_costs(printed):
    return [line for line in printed.splitlines() if "core-hours" not in line]


class Tables(Analysis):
    # For each reader: the command, the columns, and three lines of cells.
    READERS = {"distances": (["clogfit", "lengths", "t.csv"], ["distance[mm]", "clogged", "wall"], [["9", "1", "a"], ["13", "0", "a"], ["18", "1", "b"]]),
               "points": (["clogsweep", *QUICK, "--points", "t.csv", "--dry-run"], ["line-tension", "obstacle-gap", "seeds"], [["1", "0.4", "1"], ["2", "0.4", "2"], ["3", "0.5", "3"]]),
               "circles": (["clogsweep", "obstacles=t.csv", *OWN], ["x", "y", "diameter"], [["2", "2", "1"], ["5", "5", "1"], ["8", "8", "1"]]),
               "profile": (["deviation", "t.csv", "good.csv"], ["h[sigma]", "v[v_t]", "A"], [["-1", "1", "1"], ["0", "1", "1"], ["1", "1", "1"]]),
               "speeds": (["drag", "t.csv"], ["d[sigma]", "v[v_t]", "A"], [["0.6", "0.5", "1"], ["1", "0.7", "1"], ["2", "0.9", "1"]]),
               "angles": (["critical-angle", "t.csv"], ["line_tension", "lower", "upper", "runs"], [["1", "5", "6", "9"], ["2", "6", "7", "9"], ["3", "7", "8", "9"]]),
               "passage": (["figures", "2", "--profile", "t.csv", "--output", "here"], ["h [sigma]", "v [v_t]", "A"], [["-1", "1", "1"], ["0", "1", "1"], ["1", "1", "1"]])}

    def call(self, arguments):
        return self.run_program(*arguments) if arguments[0].startswith("clog") else self.analyse(*arguments)

    def table(self, separator, lines):
        return self.write("t.csv", "".join(separator.join(line) + "\n" for line in lines))

    def setUp(self):
        super().setUp()
        self.write("good.csv", "h [sigma],v [v_t],A\n-1,1,1\n0,1,1\n1,1,1\n")

    def broken_tables(self, name):
        """Writes tables with each error of a spreadsheet in the first cell of a line, and in a later cell. In the first
        cell an error is most dangerous, because lines that begin with # are comments. @return the beginning of each
        message"""
        _, head, lines = self.READERS[name]
        for number, error in enumerate(ERRORS):
            separator = SEPARATORS[number % len(SEPARATORS)] if name not in ("angles", "passage") else ","
            if separator == " " and (" " in error or error == "####"):
                separator = ";"
            for column in (0, 1 + number % (len(head) - 1)):
                row = number % len(lines)
                broken = [list(line) for line in lines]
                broken[row][column] = error
                self.table(separator, [head, *broken])
                yield f"t.csv line {row + 2}: column {column + 1} is '{error}'"

    def test_errors_of_spreadsheets_are_refused_with_line_and_column(self):
        for name, (command, *_) in self.READERS.items():
            for message in self.broken_tables(name) if command[0].startswith("clog") else ():
                done = self.run_program(*command)
                self.assertEqual(done.returncode, 2, done.stdout + done.stderr)
                self.assertIn(message, done.stderr)

    def readers_in_python(self):
        """Reads t.csv in this process, because commands take long to start."""
        path = self.folder / "t.csv"
        return {"profile": lambda: profiles.read_profile(str(path)),
                "speeds": lambda: profiles.read_table(str(path), "d", profiles.ReducedUnits()),
                "angles": lambda: critical_angle.read_angles(path, ["line_tension"]),
                "passage": lambda: runner.measured(path)}

    def test_readers_in_python_refuse_the_same_errors(self):
        readers = self.readers_in_python()
        self.assertEqual([name for name, (command, *_) in self.READERS.items() if not command[0].startswith("clog")],
                         list(readers))
        for name, read in readers.items():
            command, head, lines = self.READERS[name]
            self.table(",", [head, *lines])
            read()
            for message in self.broken_tables(name):
                with self.assertRaisesRegex(UserError, re.escape(message)):
                    read()
            # The command uses the same reader.
            done = self.analyse(*command)
            self.assertEqual((done.returncode, message in done.stderr), (2, True), done.stderr)

    def test_two_columns_of_one_quantity_are_refused_with_their_names_and_the_line(self):
        # Two columns have the same quantity. The second one is next to the first or comes last, and it has the same
        # unit or another one.
        for name, read in self.readers_in_python().items():
            _, head, lines = self.READERS[name]
            for column, title in enumerate(head[:3]):
                quantity = title.partition("[")[0].strip()
                for other in {title, f"{quantity} [mm]"}:
                    for place in (column + 1, len(head)):
                        doubled = [[*cells[:place], cell, *cells[place:]]
                                   for cells, cell in zip([head, *lines], [other, *(line[column] for line in lines)])]
                        self.table(",", [["# measured"], *doubled])
                        with self.subTest(reader=name, header=doubled[0]), self.assertRaises(UserError) as refusal:
                            read()
                        self.assertIn(f"t.csv line 2: there are two columns for {quantity}, '{title}' and '{other}'; delete one", str(refusal.exception))

    def test_columns_without_a_title_are_not_two_columns_of_one_quantity(self):
        read = self.readers_in_python()["speeds"]
        self.write("t.csv", "d [sigma],v [v_t]\n0.6,0.5\n1,0.7\n")
        plain = read()
        self.write("t.csv", "d [sigma],v [v_t],,\n0.6,0.5,,\n1,0.7,,\n")
        np.testing.assert_array_equal(read(), plain)

    def test_both_languages_know_the_same_errors(self):
        words = re.findall(r'"(#[^"]+)"',
                           (ROOT / "src" / "console"
                            / "csv.cpp").read_text().partition("other_error_words[] =")[2].partition(";")[0])
        self.assertGreater(len(words), 8)
        for word in words:
            self.assertIn(word.casefold(), [error.casefold() for error in ERRORS])
            self.assertTrue(tables.ERROR_WORD.fullmatch(word), word)

    def test_decimal_commas_beside_decimal_points_are_refused_with_line_and_column(self):
        for name, (command, head, lines) in self.READERS.items():
            if name in ("angles", "passage"):
                continue  # These are CSV files with commas between the cells.
            columns = [column for column, title in enumerate(head) if title not in ("clogged", "wall", "seeds")]
            for one, other in (("0,5", "1.5"), ("1.5", "0,5")):
                # The two errors are in one column, in two columns, and in one line.
                for first, second in (((0, columns[0]), (2, columns[0])), ((0, columns[0]), (1, columns[1 % len(columns)])), ((1, columns[0]), (1, columns[-1]))):
                    if first == second:
                        continue
                    broken = [[cell.replace(".", one[1]) for cell in line] for line in lines]
                    broken[first[0]][first[1]], broken[second[0]][second[1]] = one, other
                    self.table(";", [head, *broken])
                    with self.subTest(reader=name, one=one, places=(first, second)):
                        done = self.call(command)
                        self.assertEqual(done.returncode, 2, done.stdout + done.stderr)
                        title = head[second[1]].partition("[")[0]
                        self.assertIn(f"t.csv line {second[0] + 2}: {title}: '{other}' has a", done.stderr)

    def test_the_first_line_and_quoted_cells_are_no_exceptions(self):
        for text in ("#N/A,2,1\n5,5,1\n", '"#N/A",2,1\n5,5,1\n', "#N/A 2 1\n5 5 1\n", "#REF!;2;1\n5;5;1\n",
                     '5,5,1\n"#DIV/0!",2,1\n'):
            self.refuse("clogsweep", f"obstacles={self.write('t.csv', text)}", *OWN,
                        words=["t.csv line", "column 1 is '#"])

    def test_comments_remain_comments(self):
        comments = ["# 55 posts, measured!", "#a, b", "## A section", "#", "######", "# is this right?", "#x,y,diameter", '"# quoted, with a comma"', "# #N/A", "#1"]
        for name, (command, head, lines) in self.READERS.items():
            if name in ("angles", "passage", "points"):
                continue
            for separator in SEPARATORS:
                self.table(separator, [head, *lines])
                expected = self.call(command)
                self.table(separator, [*([comment] for comment in comments), head, lines[0], *([comment] for comment in comments), *lines[1:]])
                printed = self.call(command)
                with self.subTest(reader=name, separator=separator):
                    self.assertEqual((printed.returncode, without_costs(printed.stdout)),
                                     (expected.returncode, without_costs(expected.stdout)), printed.stderr)


class Units(ProgramTest):
    CIRCLES = "2,2,1\n5,5,1\n8,8,1\n"

    def circles(self, text):
        """The circles of a file, in droplet diameters."""
        self.write("posts.csv", text)
        self.succeed("clogrun", "array", "obstacles=posts.csv", "box=10", "vertices=64", "max-time=0.1", "--output",
                     "run.h5", "--write-obstacles", "read.csv")
        found = np.loadtxt(self.folder / "read.csv", delimiter=",", skiprows=1, comments="#")
        for name in ("run.h5", "read.csv"):
            (self.folder / name).unlink()
        return sorted(map(tuple, found))

    def test_units_apply_to_all_circles_or_are_refused(self):
        units = "# units=um droplet=2um\n"
        lines = self.CIRCLES.splitlines(keepends=True)
        half = [(1, 1, 0.5), (2.5, 2.5, 0.5), (4, 4, 0.5)]
        for place in range(len(lines) + 1):
            text = "".join([*lines[:place], units, *lines[place:]])
            with self.subTest(place=place):
                if place == 0:
                    self.assertEqual(self.circles(text), half)
                else:
                    self.refuse("clogsweep", f"obstacles={self.write('posts.csv', text)}", *OWN,
                                words=[f"posts.csv line {place + 1}", "below circles", "above all circles"])
        # In concatenated files, the line with the units occurs again and again.
        self.assertEqual(self.circles(units + lines[0] + units + lines[1] + units + lines[2]), half)
        self.refuse("clogsweep",
                    f"obstacles={self.write('posts.csv', units + '# units=um droplet=3um' + chr(10) + self.CIRCLES)}",
                    *OWN, words=["line 2", "contradict"])

    def test_units_are_read_in_other_spellings(self):
        for units in ("# units = um, droplet = 2um", "# Units=um; Droplet=2", "#unit= um droplet =0.002mm",
                      "# units=um droplet=2um;;"):
            with self.subTest(units):
                self.assertEqual(self.circles(f"{units}\n{self.CIRCLES}"), [(1, 1, 0.5), (2.5, 2.5, 0.5), (4, 4, 0.5)])
        self.assertEqual(self.circles(f"# units=um droplet=4um\n{self.CIRCLES}"), [(0.5, 0.5, 0.25), (1.25, 1.25, 0.25), (2, 2, 0.25)])


class Points(ProgramTest):
    def test_a_blank_line_of_one_column_is_an_empty_cell(self):
        head, cells = "line-tension", ["0.5", "", "2", "", "3"]
        for ending in ("\n", "\r\n"):
            blank = self.plan(*QUICK, "seeds=1", "--points",
                              self.write("p.csv", ending.join([head, "0.5", "", "2", "3", "", ""])))
            quoted = self.plan(*QUICK, "seeds=1", "--points",
                               self.write("p.csv", ending.join([head, "0.5", '""', "2", "3"])))
            self.assertIn("# 4 tasks: 4 parameter sets", blank)
            self.assertEqual([line for line in blank.splitlines() if not line.startswith("#")],
                             [line for line in quoted.splitlines() if not line.startswith("#")])
        # Two points with missing values would be the same run.
        self.refuse("clogsweep", *QUICK, "seeds=1", "--points", self.write("p.csv", "\n".join([head, *cells]) + "\n"),
                    "--dry-run", words=["point 2 and point 4", "the same run"])
        # In a table of several columns, a blank line is not a point.
        self.assertIn("# 2 tasks", self.plan(*QUICK, "--points", self.write("p.csv", "line-tension,seeds\n1,1\n\n2,1\n")))

    def test_decimal_commas_with_units_are_those_of_decimal_points(self):
        self.write("lab.cfg", "diameter = 2 mm\nangle = 20 deg\nspeed = 7 mm/s\n")
        printed = {}
        for name, text in (("point", "obstacle-diameter;seeds\n0.4mm;1\n0.8 mm;2\n1.5e3um;3\n"),
                           ("comma", "obstacle-diameter;seeds\n0,4mm;1\n0,8 mm;2\n1,5e3um;3\n")):
            self.write("p.csv", text)
            printed[name] = self.plan("box=20", "obstacle-gap=0.4", "vertices=64", "max-time=1", "--lab",
                                      "lab.cfg", "--points", "p.csv").splitlines()[:4]
        self.assertEqual(printed["comma"], printed["point"])
        self.refuse("clogsweep", "box=20", "obstacle-gap=0.4", "--lab", "lab.cfg", "--points",
                    self.write("p.csv", "obstacle-diameter;seeds\n1,350mm;1\n"), "--dry-run",
                    words=["'1,350'", "thousands"])


if __name__ == "__main__":
    unittest.main()
