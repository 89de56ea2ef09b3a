"""Tests an installation by cmake --install in an environment that contains nothing else, and an installation of the
Python package by pip."""

import os
import pathlib
import pty
import re
import select
import shutil
import subprocess
import sys
import tempfile
import unittest

import pandas

from support import BIN, LONGEST, ROOT

KEYS = ["line-tension=0.5", "obstacle-density=saturated", "obstacle-gap=0.3", "vertices=64", "box=20", "max-time=200", "seeds=1..4"]


class Installation(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory(prefix="clog_install_")
        cls.addClassCleanup(folder.cleanup)
        cls.folder = pathlib.Path(folder.name)
        first = cls.folder / "first"
        cls.called("cmake", "--install", BIN.parent, "--prefix", first)
        # The installation is moved, so that programs fail if they depend on the first place.
        cls.prefix = cls.folder / "moved"
        first.rename(cls.prefix)

    @classmethod
    def called(cls, *command, **options):
        # The programs see only the installation and the system.
        environment = {"PATH": f"{cls.folder}/moved/bin:{BIN.parent}/launcher:/usr/bin:/bin", "HOME": str(cls.folder), "OMPI_ALLOW_RUN_AS_ROOT": "1",
                       "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1", "PYTHONDONTWRITEBYTECODE": "1",
                       "PYTHONPATH": f"{cls.folder}/moved/lib/python3/dist-packages", "ASAN_OPTIONS": os.environ.get("ASAN_OPTIONS", "")}
        done = subprocess.run([str(word) for word in command], cwd=cls.folder, env=environment, capture_output=True, text=True, timeout=LONGEST, **options)
        if done.returncode != 0:
            raise AssertionError(f"{command}: {done.stdout}{done.stderr}")
        return done.stdout


class Installed(Installation):
    def test_nothing_knows_where_it_was_built(self):
        cache = (BIN.parent / "CMakeCache.txt").read_text()
        # A build with sanitizers contains the full path of every source, but is not checked, because nobody installs
        # such a build.
        sources = [] if "CLOG_SANITIZE:STRING=address" in cache else [ROOT, BIN.parent]
        for path in self.prefix.rglob("*"):
            self.assertFalse(path.is_symlink(), path)
            if path.is_file() and path.suffix != ".png":  # A picture contains its command.
                content = path.read_bytes()
                for place in (*sources, self.folder / "first"):
                    self.assertFalse(str(place).encode() + b"/" in content, f"{path} knows {place}")

    def test_a_sweep_its_fit_its_report_and_its_pictures(self):
        self.called("clogsweep", *KEYS, "--output", "s.h5")
        self.assertIn("lambda/sigma", self.called("clogfit", "s.h5"))
        self.called("clogfit", "report", "s.h5", "--output", "s.html")
        self.assertIn("<figure>", (self.folder / "s.html").read_text())
        self.called("/usr/bin/python3", "-m", "clogsweep", "clogging-length", "s.h5", "--output", "curve")
        self.assertTrue((self.folder / "curve.png").exists())
        self.called("clogrun", "array", *KEYS[:-1], "seeds=1", "--polygon-interval", 20, "--output", "r.h5", "--frames", "film.gif")
        self.assertTrue((self.folder / "film.gif").exists())

    def test_pages_that_messages_name_are_there(self):
        said = self.called("clogsweep", *KEYS[1:], "line-tension=30", "--dry-run")
        title, = re.findall(r"outside the range tested for soundness \(handbook, ([^)]+)\)", said)
        pages = (self.prefix / "share/doc/clogsweep/docs").rglob("*.md")
        self.assertEqual([page.name for page in pages if page.read_text().startswith(f"# {title}\n")], ["trust.md"])

    def test_a_config_that_comes_with_it(self):
        said = self.called("clogsweep", "--config", self.prefix / "share/clogsweep/jobs/laptop.cfg", "--print-config")
        self.assertIn("line-tension = 0.07,0.1,0.2,0.25,0.3,0.4,0.6", said)

    def test_the_script_for_slurm_finds_what_is_installed(self):
        # Slurm runs a copy of the script in another folder.
        copy = shutil.copy(self.prefix / "share/clogsweep/jobs/slurm.sh", self.folder / "slurm_script")
        self.called("bash", copy, *KEYS[:-1], "seeds=1", "--output", "slurm.h5")
        self.assertEqual(len(pandas.read_hdf(self.folder / "slurm.h5", "runs")), 1)

    def test_a_program_of_ones_own_finds_the_libraries(self):
        # slow_install.py builds and runs this example.
        example = self.prefix / "share/doc/clogsweep/docs/examples/own-program"
        self.called("cmake", "-G", "Ninja", "-S", example, "-B", self.folder / "example",
                    f"-DCMAKE_PREFIX_PATH={self.prefix}")

    def completed(self, *words, function="_clogsweep"):
        """The completions that bash offers for the last word."""
        script = f"""
            compopt() {{ :; }}
            . {self.prefix}/share/bash-completion/completions/{words[0]}
            COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); {function}; printf '%s\\n' "${{COMPREPLY[@]}}"
        """
        return self.called("bash", "-c", script, "bash", *words).split()

    def test_bash_completes_commands_options_keys_and_words(self):
        self.assertEqual(self.completed("clogsweep", "stat"), ["status"])
        self.assertEqual(self.completed("clogsweep", "status", "--wat"), ["--watch"])
        self.assertEqual(self.completed("clogsweep", "line-t"), ["line-tension="])
        self.assertEqual(self.completed("clogrun", "array", "preset", "=", "el"), ["elastic"])
        self.assertEqual(self.completed("clogfit", "sweep.h5", "--dw"), ["--dwell"])
        self.assertEqual(self.completed("clogfit", "report", "--out"), ["--output"])
        self.assertEqual(self.completed("clogsweep", "status", "see"), [])
        self.assertEqual(self.completed("clogfit", "uni"), ["units"])

    def test_bash_completes_after_mpirun(self):
        self.assertEqual(self.completed("mpirun", "-np", "2", "clogsweep", "line-t", function="_clogsweep_mpirun"), ["line-tension="])
        self.assertEqual(self.completed("mpirun", "-np", "2", "/usr/bin/clogsweep", "--ou", function="_clogsweep_mpirun"), ["--output"])
        self.assertEqual(self.completed("mpirun", "-n", function="_clogsweep_mpirun"), [])

    def test_bash_completes_what_an_option_takes(self):
        (self.folder / "inputs").mkdir(exist_ok=True)
        (self.folder / "inputs/mine.csv").touch()
        for words in (["clogsweep", "--config"], ["clogsweep", "line-tension=1", "--output"], ["clogrun", "array", "--write-obstacles"],
                      ["clogrun", "array", "--frames"], ["clogfit", "report", "-o"], ["clogsweep", "--obstacles"],
                      ["clogsweep", "obstacles", "="], ["clogsweep", "--output", "="]):
            self.assertEqual(self.completed(*words, "inputs/"), ["inputs/mine.csv"], words)
        self.assertIn("inputs", self.completed("clogsweep", "--config", ""))
        self.assertIn("inputs", self.completed("clogsweep", "status", ""))
        for words, offered in ((["clogsweep", "--isolate"], ["yes", "no"]), (["clogsweep", "--master-computes"], ["auto", "yes", "no"]),
                               (["clogrun", "sag", "--instruction-set"], ["avx512", "avx2", "baseline"]),
                               (["clogsweep", "status", "--format"], ["text", "json"]), (["clogfit", "--format"], ["text", "csv", "json"]),
                               (["clogfit", "calibrate", "--format", "="], ["text", "json"]), (["clogsweep", "--model"], ["dp", "sp"]),
                               (["clogsweep", "--max-hours"], []), (["clogfit", "s.h5", "--dwell"], []), (["clogrun", "array", "--seed"], []),
                               (["clogsweep", "orifice", "="], []), (["clogsweep", "--orifice"], [])):
            self.assertEqual(self.completed(*words, ""), offered, words)
        self.assertEqual(self.completed("clogsweep", "--verbose", "stat"), [])  # A command must come first.
        self.assertIn("inputs", self.completed("clogfit", ""))
        self.assertIn("calibrate", self.completed("clogfit", ""))
        for option, words in (("--isolate", ["yes", "no"]), ("--master-computes", ["auto", "yes", "no"])):
            for word in words:
                self.called("clogsweep", option, word, "--print-config")

    def test_an_interactive_bash_completes_a_key_and_then_its_value(self):
        pid, terminal = pty.fork()
        if pid == 0:
            os.environ["TERM"] = "dumb"
            os.execvp("bash", ["bash", "--norc", "-i"])
        self.addCleanup(os.waitpid, pid, 0)
        self.addCleanup(os.close, terminal)
        os.write(terminal, f". {self.prefix}/share/bash-completion/completions/clogsweep; echo rea''dy\n".encode())
        self.read_until(terminal, b"ready\r")
        os.write(terminal, b"clogsweep pres\tel\t")
        self.read_until(terminal, b"clogsweep preset=elastic ")

    def read_until(self, terminal, text):
        """Reads from a terminal until the text has arrived. The terminal may be slow."""
        seen = b""
        while text not in seen:
            ready, _, _ = select.select([terminal], [], [], LONGEST)
            self.assertTrue(ready, seen)
            seen += os.read(terminal, 4096)


class InstalledByPip(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory(prefix="clog_pip_")
        cls.addClassCleanup(folder.cleanup)
        cls.folder = pathlib.Path(folder.name)
        cls.venv = cls.folder / "venv"
        cls.tree = sorted(ROOT.glob("analysis/*"))
        cls.called(sys.executable, "-m", "venv", "--system-site-packages", cls.venv)
        cls.called(cls.venv / "bin/pip", "install", "--no-deps", "--no-build-isolation", "--no-index",
                   ROOT / "analysis")
        cls.called(BIN / "clogsweep", *KEYS[1:], "line-tension=0.4,0.5", "--output", "s.h5")

    @classmethod
    def called(cls, *command, **variables):
        environment = {"PATH": "/usr/bin:/bin", "HOME": str(cls.folder), "ASAN_OPTIONS": os.environ.get("ASAN_OPTIONS", ""), **variables}
        done = subprocess.run([str(word) for word in command], cwd=cls.folder, env=environment, capture_output=True, text=True, timeout=LONGEST)
        if done.returncode != 0:
            raise AssertionError(f"{command}: {done.stdout}{done.stderr}")
        return done.stdout

    def draw(self, name, **variables):
        self.called(self.venv / "bin/python", "-m", "clogsweep", "clogging-length", "s.h5", "--output", name,
                    **variables)
        self.assertTrue((self.folder / f"{name}.png").exists())

    def test_nothing_is_left_in_the_source_tree(self):
        self.assertEqual(sorted(ROOT.glob("analysis/*")), self.tree)

    def test_it_finds_the_programs_that_a_variable_names(self):
        self.draw("by-variable", CLOG_BIN=str(BIN))

    def test_it_finds_the_programs_of_the_path(self):
        self.draw("by-path", PATH=f"{BIN}:/usr/bin:/bin")

    def test_it_finds_the_programs_beside_itself(self):
        for program in ("clogsweep", "clogrun", "clogfit"):
            (self.venv / "bin" / program).symlink_to(BIN / program)
            self.addCleanup((self.venv / "bin" / program).unlink)
        self.draw("beside")

    def test_without_programs_it_says_so_in_one_line(self):
        with self.assertRaisesRegex(AssertionError, r"^.*: python3 -m clogsweep clogging-length: "
                                                    r"no clogsweep in [^\n]*/venv/bin; [^\n]*\n$"):
            self.draw("without")

    def test_it_has_the_configs_of_the_figures(self):
        said = self.called(self.venv / "bin/python", "-c",
                           "from clogsweep.paper import runner; print(runner.CONFIGS)")
        configs = pathlib.Path(said.strip())
        self.assertEqual(configs.parents[1].parent, next(self.venv.glob("lib/python3*")) / "site-packages")
        names = sorted(path.name for path in (ROOT / "jobs/figures").iterdir() if path.suffix in (".cfg", ".csv"))
        self.assertEqual(sorted(path.name for path in configs.iterdir()), names)
        for name in names:
            self.assertEqual((configs / name).read_bytes(), (ROOT / "jobs/figures" / name).read_bytes(), name)
        self.called(BIN / "clogsweep", "--config", configs / "speed.reduced.cfg", "--output", "dry.h5", "--dry-run")
        self.assertIn("6c", self.called(self.venv / "bin/python", "-m", "clogsweep", "figures", "list"))


if __name__ == "__main__":
    unittest.main()
