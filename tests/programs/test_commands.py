"""Tests the answers to wrong commands, and checks what the programs refuse."""

import unittest

from support import BLOCKED, QUICK, SMALL, ProgramTest


class Meant(ProgramTest):
    """Tests messages that suggest what the user meant."""

    def test_a_misspelt_command_is_answered_with_the_one_meant(self):
        for program, words, meant in [("clogsweep", ["stauts", "s.h5"], "clogsweep status"),
                                      ("clogsweep", ["verfy", "s.h5"], "clogsweep verify"),
                                      ("clogfit", ["reprot", "s.h5", "--output", "x"], "clogfit report"),
                                      ("clogfit", ["calibrat", "a.csv"], "clogfit calibrate"),
                                      ("clogrun", ["aray", "--output", "r.h5"], "clogrun array")]:
            with self.subTest(program=program, words=words):
                self.refuse(program, *words, words=[f"unknown command '{words[0]}'; did you mean {meant}?"])

    def test_a_misspelt_word_of_a_key_is_answered_with_the_one_meant(self):
        self.refuse("clogsweep", "preset=robst", "--output", "s.h5",
                    words=["invalid preset=robst", "elastic, literal; did you mean robust?"])

    def test_a_file_of_a_command_s_name_is_a_file(self):
        self.write("drug", "")
        self.refuse("clogfit", "drug", words=["cannot read drug"])

    def test_a_message_says_where_surplus_words_belong(self):
        self.refuse("clogsweep", "s.h5", words=["no place for 's.h5'", "--output", "clogsweep status"])
        self.refuse("clogfit", "a.h5", "b.h5", "c.h5", words=["cannot read a.h5 (no such file)"])

    def test_a_column_s_name_is_answered_with_the_key(self):
        self.refuse("clogsweep", "line_tension=1", "--output", "s.h5",
                    words=["no place for 'line_tension=1'; did you mean line-tension=1?"])
        self.refuse("clogrun", "sag", "line-tension", "0.2",
                    words=["no place for 'line-tension'; did you mean line-tension=VALUE?"])

    def test_an_unknown_key_is_quoted_as_it_was_typed(self):
        for typed, printed in [("line-tensoin=1", "unknown key line-tensoin; did you mean line-tension?"),
                               ("--line-tensoin=1", "unknown option --line-tensoin; did you mean --line-tension?"),
                               ("frobnicate=1", "unknown key frobnicate; clogsweep --help lists the options")]:
            self.refuse("clogsweep", typed, "--output", "s.h5", words=[printed])

    def test_a_part_of_a_key_or_its_symbol_is_answered_with_the_key(self):
        for typed, printed in [("gap=0.3", "unknown key gap; did you mean obstacle-gap?"),
                               ("--gap=0.3", "unknown option --gap; did you mean --obstacle-gap?"),
                               ("contact=edge", "unknown key contact; did you mean wall-contact or self-contact?"),
                               ("obstacle=a.csv",
                                "unknown key obstacle; did you mean obstacles or obstacle-gap or obstacle-density?"),
                               ("Gamma=0.3", "unknown key Gamma; did you mean line-tension?"),
                               ("Γ=0.3", "unknown key Γ; did you mean line-tension?"),
                               ("w_ob=0.3", "unknown key w_ob; did you mean obstacle-gap?"),
                               ("Nv=64", "unknown key Nv; did you mean vertices?"),
                               ("Frobnicate=0.3", "unknown key Frobnicate; clogsweep --help lists the options")]:
            with self.subTest(typed=typed):
                self.refuse("clogsweep", typed, "--output", "s.h5", words=[printed + "\n"])
        self.refuse("clogrun", "array", "Gamma=0.3", "--output", "r.h5", words=["did you mean line-tension?"])
        self.refuse("clogfit", "--N_v=64", words=["unknown option --N_v; clogfit --help lists the options"])
        self.write("bad.cfg", "gap = 0.3\n")
        self.refuse("clogsweep", "--config", "bad.cfg", words=["unknown key 'gap'; did you mean obstacle-gap?"])
        self.refuse("clogsweep", "folder/a=1.h5", words=["no place for 'folder/a=1.h5'"])

    def test_a_missing_folder_is_named(self):
        run = ["array", *QUICK, "--output"]
        for words in (["clogsweep", *QUICK, "--output", "none/a.h5"], ["clogrun", *run, "none/a.h5"],
                      ["clogrun", *run, "a.h5", "--write-obstacles", "none/a.h5"],
                      ["clogrun", *run, "a.h5", "--polygon-interval=1", "--frames", "none/a"]):
            with self.subTest(words=words):
                self.refuse(*words, words=[" none/a", "(no folder none); make it first"])
        self.refuse("clogsweep", "status", "none/a.h5", words=["cannot read none/a.h5 (no such file)"])

    def test_h_is_help(self):
        for program in ("clogsweep", "clogrun", "clogfit"):
            self.assertEqual(self.succeed(program, "-h").stdout, self.succeed(program, "--help").stdout)

    def test_helps_have_each_heading_once(self):
        for words in (["clogsweep", "status"], ["clogsweep", "doctor"], ["clogfit", "drag"], ["clogfit", "deviation"],
                      ["clogfit", "calibrate"], ["clogrun"], ["clogfit"]):
            printed = self.succeed(*words, "--help").stdout
            self.assertEqual(printed.lower().count("\noptions:\n"), 1, printed)

    def test_a_byte_order_mark_is_passed_over(self):
        self.write("bom.cfg", "\ufeffline-tension = 0.5\n")
        self.assertIn("line-tension = 0.5\n", self.succeed("clogsweep", "--config", "bom.cfg", "--print-config").stdout)
        self.write("bom.csv", "\ufeffh [sigma], v [v_t]\n0,1\n1,1\n2,1\n")
        self.succeed("clogfit", "deviation", "bom.csv", "bom.csv")

    def test_a_decimal_comma_with_out_of_range_values_is_questioned(self):
        question = "invalid obstacle-gap=0 (must be positive) use a value above 0; 0,3 are two values: did you mean 0.3?"
        self.refuse("clogsweep", "obstacle-gap=0,3", "--output", "s.h5", words=[question])
        self.refuse("clogrun", "array", "obstacle-gap=0,3", "--output", "s.h5", words=[question])
        self.refuse("clogrun", "channel", "--orifice", "0,7", "--output", "r.h5", words=["did you mean 0.7?"])
        self.assertIn("line-tension = 1,3\n", self.succeed("clogsweep", "line-tension=1,3", "--print-config").stdout)

    def test_lists_whose_values_contradict_each_other_are_pointed_to_points(self):
        exchange = "invalid receding-angle=180 (larger than advancing-angle=155) exchange them"
        for advancing, end in [("155,180", "; each value of a list meets all of the other; "
                                           "to pair values, see clogsweep --points\n"), ("155", "\n")]:
            done = self.run_program("clogsweep", "receding-angle=140,180", f"advancing-angle={advancing}",
                                    "--output", "s.h5")
            self.assertEqual((done.returncode, done.stderr), (2, f"clogsweep: {exchange}{end}"))
        # The message also appears if the refused key has a single value. The list 64,128 could be a decimal number, but
        # the message must not suggest 64.128.
        self.refuse("clogsweep", "model=dp,sp", "vertices=64", "--output", "s.h5",
                    words=["invalid vertices=64",
                           "it meets each value of model; to pair values, see clogsweep --points"])
        done = self.run_program("clogsweep", "model=dp,sp", "vertices=64,128", "--output", "s.h5")
        self.assertIn("to pair values, see clogsweep --points", done.stderr)
        self.assertNotIn("did you mean", done.stderr)

    def test_a_list_that_could_be_a_decimal_is_run_with_a_line_about_it(self):
        printed = "line-tension=0,5 is a list of 0 and 5; decimals have a point, 0.5\n"
        sweep = [*SMALL, "line-tension=0,5", "max-time=1", "seeds=1", "--output", "s.h5"]
        self.assertIn("# " + printed, self.succeed("clogsweep", *sweep, "--dry-run").stdout)
        self.assertEqual(self.succeed("clogsweep", *sweep, ranks=2).stderr.count(printed), 1)

    def test_a_range_of_numbers_is_pointed_to_lin(self):
        self.refuse("clogsweep", "line-tension=0.1..0.5", "--output", "s.h5", words=["lin(0.1,0.5,5)"])

    def test_a_name_that_no_file_can_have_is_the_user_s_mistake(self):
        name = 300 * "x"
        for program, *arguments in [["clogfit", name], ["clogsweep", "salvage", name, "--output", "w.h5"],
                                    ["clogsweep", "--output", name], ["clogrun", "array", "--output", name],
                                    ["clogrun", "array", "--config", name, "--output", "w.h5"]]:
            self.refuse(program, *arguments, words=["File name too long"])

    def test_a_line_tension_that_is_too_large_is_named(self):
        for program in (["clogsweep"], ["clogsweep",
                                        "--dry-run"], ["clogsweep", "--print-config"], ["clogrun", "array"]):
            self.refuse(*program, "line-tension=1e300", "seeds=1", "--output", "s.h5",
                        words=["invalid line-tension=1e300"])


class Failing(ProgramTest):
    def test_a_sweep_whose_every_run_failed_is_no_success(self):
        for printed in ("failed, attempt 2", "nothing left to do"):
            done = self.run_program("clogsweep", *BLOCKED, "seeds=64", "--output", "f.h5")
            self.assertEqual(done.returncode, 1, done.stderr)
            self.assertIn(printed, done.stderr)
            self.assertIn("clogsweep: every run has failed; the first one: cannot release the droplet",
                          done.stderr.splitlines()[-1])
        self.succeed("clogsweep", *BLOCKED, "seeds=51,64", "--output", "f.h5")

    def test_quiet_tells_it_too(self):
        done = self.run_program("clogsweep", *BLOCKED, "seeds=64", "--output", "f.h5", "--quiet", ranks=2)
        self.assertIn("every run has failed", done.stderr)
        self.assertNotEqual(done.returncode, 0)


class Parameters(ProgramTest):
    """Tests lines of configs, and the line with parameters above the tables of clogfit and clogsweep status."""

    def test_a_line_of_a_config_that_is_no_setting_is_named(self):
        # Boost replaces names between percent signs in its messages. Because of this, the first line once made Boost
        # loop for ever.
        for line in ("%prefix%invalid_line%", "line-tension 3"):
            self.write("bad.cfg", f"# a comment\nvertices = 64\n{line}\n")
            self.refuse("clogsweep", "--config", "bad.cfg", "--output", "s.h5",
                        words=["bad.cfg line 3", line, "key = value"])

    def line(self, *settings):
        self.succeed("clogsweep", *settings, "max-time=1", "box=20", "seeds=1", "--output", "s.h5")
        printed = self.succeed("clogfit", "s.h5").stdout
        self.assertIn(printed.splitlines()[0], self.succeed("clogsweep", "status", "s.h5").stdout)
        (self.folder / "s.h5").unlink()
        return printed.split("\n(the rest as by default; --all-parameters names it)\n")[0]

    def test_it_names_what_differs_from_the_defaults(self):
        ours = "box=20 max_time=1"
        for settings, line in [
            ([], f"all runs: model=dp {ours}"),
            (["preset=elastic"], f"all runs: model=dp preset=elastic {ours}"),
            (["preset=literal"], f"all runs: model=dp preset=literal {ours}"),
            (["model=sp", "wall-stiffness=1"], f"all runs: model=sp {ours}"),
            (["obstacle-density=1"], f"all runs: model=dp obstacle_density=1 {ours}"),
            (["obstacle-density=12.5%", "obstacle-gap=0.3"], f"all runs: model=dp {ours}"),
            (["obstacle-density=saturated"], f"all runs: model=dp obstacle_filling=saturated {ours}"),
            (["obstacle-layout=lattice"], f"all runs: model=dp obstacle_filling=lattice lattice_angle=0 {ours}"),
            (["vertices=64", "time-step=2e-3"], f"all runs: model=dp {ours} vertices=64 time_step=0.002"),
            (["terminal-speed=0.05"], f"all runs: model=dp terminal_speed=0.05 {ours}"),
            (["wall-tension=0.9",
              "area-stiffness=700"], f"all runs: model=dp wall_tension=0.9 {ours} area_stiffness=700"),
        ]:
            with self.subTest(settings=settings):
                self.assertEqual(self.line(*settings), line)

    def test_all_of_them_can_be_had_in_lines_that_fit(self):
        self.succeed("clogsweep", *QUICK, "seeds=1", "--output", "s.h5")
        for command in (["clogfit", "s.h5"], ["clogsweep", "status", "s.h5"]):
            printed = self.succeed(*command, "--all-parameters").stdout
            for word in ("terminal_speed=0.03", "near_wall_cutoff=0.00614", "clog_detection=certified",
                         "model_version="):
                self.assertIn(word, printed)
            self.assertLessEqual(max(map(len, printed.splitlines())), 110, printed)


if __name__ == "__main__":
    unittest.main()
