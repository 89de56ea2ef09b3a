"""Tests streams that are closed or full, or that nobody reads. Also tests files that are not regular, and messages with
unusual names."""

import os
import shutil
import signal
import socket
import subprocess
import sys
import unittest

from support import BIN, ENDLESS, LONGEST, MPI, MPIRUN, QUICK, ROOT, SweepTest, shared_sweep, table

sys.path.insert(0, str(ROOT / "analysis"))
import clogsweep  # noqa: E402

SMALL_SWEEP = [*QUICK, "seeds=1..3", "--verbose", "--output", "s.h5"]
# All commands that end after they have printed something
REPORTS = [["clogsweep", "--help"], ["clogsweep", "--version"], ["clogsweep", "--print-config"],
           ["clogsweep", *QUICK, "--dry-run"], ["clogsweep", "doctor"], ["clogsweep", "doctor", "--help"],
           ["clogsweep", "status", "done.h5"], ["clogsweep", "verify", "done.h5"],
           ["clogsweep", "replay", "done.h5", "0"], ["clogrun", "--help"],
           ["clogrun", "sag", "vertices=64", "max-time=1"], ["clogrun", "array", *QUICK, "--output", "run.h5"],
           ["clogfit", "--help"], ["clogfit", "done.h5"], ["clogfit", "done.h5", "--format", "json"],
           ["clogfit", "drag", "speeds.csv"]]
SPEEDS = "d [sigma], v [v_t]\n0.01,0.05\n0.02,0.12\n0.05,0.3\n0.1,0.5\n0.2,0.7\n"


class Streams(SweepTest):
    def redirect(self, redirection, name, *arguments, ranks=None):
        command = [*([str(MPIRUN), str(ranks)] if ranks else []), str(BIN / name), *arguments]
        return subprocess.run(["bash", "-c", f'"$@" {redirection}', "bash", *command], cwd=self.folder,
                              capture_output=True, text=True, timeout=LONGEST)

    def prepare_reports(self):
        shutil.copyfile(shared_sweep(*QUICK, "seeds=1..3"), self.folder / "done.h5")
        self.write("speeds.csv", SPEEDS)

    def check_complete(self):
        self.assertIn("3 rows of 3 runs, all undamaged", self.succeed("clogsweep", "verify", "s.h5").stdout)
        self.assertFalse((self.folder / "s.h5.journal").exists())
        (self.folder / "s.h5").unlink()

    def test_a_script_with_full_stdout_and_stderr_exits_with_2(self):
        done = self.redirect(">/dev/full 2>/dev/full", "clogfit", "report", "--help")
        self.assertEqual(done.returncode, 2)

    def test_a_closed_stream_suppresses_output(self):
        for redirection in (">&-", "2>&-", "<&-", "<&- >&- 2>&-", ">/dev/full 2>/dev/full"):
            # MPICH's mpirun does not start without its streams. Open MPI's mpirun waits if a stream is full.
            for ranks in (None, 2) if MPI == "Open MPI" and "full" not in redirection else (None,):
                with self.subTest(redirection, ranks=ranks):
                    done = self.redirect(redirection, "clogsweep", *SMALL_SWEEP, ranks=ranks)
                    self.assertEqual(done.returncode, 0, done.stderr)
                    self.assertEqual(done.stdout, "")
                    self.check_complete()
        self.prepare_reports()
        for report in REPORTS:
            with self.subTest(report):
                usual = self.redirect("", *report)
                for redirection in (">&-", "<&-", "2>&-", "2>/dev/full"):
                    (self.folder / "run.h5").unlink(missing_ok=True)
                    done = self.redirect(redirection, *report)
                    self.assertEqual((done.returncode, done.stderr),
                                     (usual.returncode, "" if "2>" in redirection else usual.stderr), redirection)
                (self.folder / "run.h5").unlink(missing_ok=True)

    def test_output_that_cannot_be_written_is_an_error(self):
        self.prepare_reports()
        for report in REPORTS:
            with self.subTest(report):
                done = self.redirect(">/dev/full", *report)
                self.assertEqual(done.returncode, 2, done.stderr)
                self.assertIn("cannot write the output", done.stderr)
                self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
                (self.folder / "run.h5").unlink(missing_ok=True)

    def without_reader(self, stream, name, *arguments):
        """Runs a program. The given stream is a pipe that nobody reads any more."""
        reader, writer = os.pipe()
        os.close(reader)
        streams = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, stream: writer}
        with subprocess.Popen([str(BIN / name), *arguments], cwd=self.folder, text=True, **streams) as process:
            os.close(writer)
            output = process.communicate(timeout=LONGEST)
        return process.returncode, *(text or "" for text in output)

    def test_a_sweep_goes_on_without_a_reader(self):
        self.assertEqual(self.without_reader("stderr", "clogsweep", *SMALL_SWEEP), (0, "", ""))
        self.check_complete()

    def test_a_report_without_a_reader_ends_quietly(self):
        self.prepare_reports()
        for report in [*REPORTS, ["clogsweep", *QUICK, "line-tension=lin(0.1,1,10)", "seeds=1..100", "--dry-run"]]:
            with self.subTest(report):
                self.assertEqual(self.without_reader("stdout", *report), (141, "", ""))
                (self.folder / "run.h5").unlink(missing_ok=True)

    def test_messages_show_control_characters(self):
        self.refuse("clogsweep", "--größe\x1b[31m\nx", words=["unknown option --größe\\x1b[31m\\nx"])
        self.refuse("clogsweep", "--config", "a\r\x07b", words=["a\\r\\x07b"])
        self.write("s.cfg", "\x1b]0;title\x07 = 3\n")
        self.refuse("clogsweep", "--config", "s.cfg", words=["\\x1b]0;title\\x07"])
        name = "\x1b[2J.h5"
        printed = self.succeed("clogsweep", *SMALL_SWEEP[:-1], name).stderr
        printed += self.succeed("clogsweep", "status", name).stdout + self.succeed("clogsweep", "verify", name).stdout
        self.assertNotIn("\x1b", printed)
        self.assertEqual(printed.count("\\x1b[2J.h5"), 3)
        for words in (["--examples", "\x1b[31m\x07"], ["--b\x1bus"], ["--output", "\x1b/r.html"]):
            printed = self.run_program("clogfit", "report", name, *words).stderr
            self.assertIn("\\x1b", printed)
            self.assertNotIn("\x1b", printed)

    def test_long_words_are_cut(self):
        self.write("long.cfg", "k" * 5_000_000 + " = 3\n")
        self.refuse("clogsweep", "--config", "long.cfg", words=["unknown key '" + "k" * 80 + "...'"])
        self.write("no.cfg", "k" * 5_000_000 + "\n")
        self.refuse("clogsweep", "--config", "no.cfg", words=["'" + "k" * 80 + "...' is not key = value"])
        for word in ("k" * 100_000, "K" * 100_000 + "=3", "--" + "k" * 100_000):
            self.assertLess(len(self.run_program("clogsweep", word).stderr), 300)


class Files(SweepTest):
    def make_others(self):
        """Makes a file of every kind except a regular one. @return the names of the files"""
        os.mkdir(self.folder / "folder")
        os.mkfifo(self.folder / "pipe")
        with socket.socket(socket.AF_UNIX) as address:
            address.bind(str(self.folder / "socket"))
        return ["folder", "socket", "/dev/zero", "pipe"]

    def test_only_regular_files_are_tables(self):
        for name in self.make_others():
            for command in (["clogsweep", *QUICK, "--output", name], ["clogsweep", "status", name],
                            ["clogsweep", "verify", name], ["clogsweep", "replay", name, "0"], ["clogfit", name],
                            ["clogfit", "report", name, "--output", "report.html"], ["clogsweep", "doctor", "--output", name]):
                with self.subTest(command):
                    self.refuse(*command, words=[name, "not a regular file"])
            self.refuse("clogrun", "array", *QUICK, "--output", name, words=["will not overwrite " + name])
        self.succeed("clogsweep", *SMALL_SWEEP)
        self.refuse("clogfit", "report", "s.h5", "--output", "pipe", words=["cannot write pipe", "not a regular file"])
        with self.assertRaisesRegex(clogsweep.UserError, "pipe .not a regular file"):
            clogsweep.open(self.folder / "pipe")

    def test_only_regular_files_are_journals(self):
        self.succeed("clogsweep", *SMALL_SWEEP)
        os.mkfifo(self.folder / "s.h5.journal")
        for command in (["clogsweep", *SMALL_SWEEP], ["clogsweep", "status", "s.h5"]):
            self.refuse(*command, words=["s.h5.journal", "not a regular file"])

    def test_a_text_is_a_file_or_a_pipe(self):
        *others, _ = self.make_others()
        for name in others:
            for command in (["clogsweep", "--config", name], ["clogrun", "array", *QUICK, "--obstacles", name, "--output", "r.h5"],
                            ["clogfit", "calibrate", name, "--orifice=0.7"], ["clogfit", "deviation", name, name],
                            ["clogfit", "drag", name]):
                with self.subTest(command):
                    self.refuse(*command, words=["cannot read " + name])
        for ranks in (None, 2):
            command = [*([str(MPIRUN), str(ranks)] if ranks else []), str(BIN / "clogsweep"), "--config", "/dev/stdin", "--dry-run"]
            config = "seeds = 1..7\nvertices = 64\nbox = 20\nmax-time = 1\n"
            done = subprocess.run(command, input=config, cwd=self.folder, capture_output=True, text=True,
                                  timeout=LONGEST)
            self.assertIn("# 7 tasks", done.stdout, done.stderr)

    def test_a_signal_ends_the_waiting_for_a_pipe(self):
        os.mkfifo(self.folder / "pipe")
        for arguments, exit_code in ((["clogsweep", "--config", "pipe"], 75),
                                     (["clogrun", "sag", "--config", "pipe"], -signal.SIGTERM),
                                     (["clogfit", "drag", "pipe"], -signal.SIGTERM)):
            with self.subTest(arguments):
                process = subprocess.Popen([str(BIN / arguments[0]), *arguments[1:]], cwd=self.folder,
                                           stderr=subprocess.PIPE)
                # The call returns when the program has opened its end.
                writer = os.open(self.folder / "pipe", os.O_WRONLY)
                process.terminate()
                process.communicate(timeout=LONGEST)
                os.close(writer)
                self.assertEqual(process.returncode, exit_code)


class Alone(SweepTest):
    """Tests a single rank that was started without a launcher."""

    def test_it_needs_neither_environment_nor_daemon(self):
        environment = {name: value for name, value in os.environ.items() if name == "ASAN_OPTIONS"}
        process = subprocess.Popen([str(BIN / "clogsweep"), *ENDLESS], cwd=self.folder, env=environment,
                                   stderr=subprocess.PIPE, text=True)
        self.addCleanup(lambda: process.poll() is None and process.kill())
        self.wait_for(lambda: (self.folder / "s.h5").exists() and
                      (table(self.folder / "s.h5").status == "running").any() or process.poll() is not None)
        names = subprocess.run(["ps", "-o", "comm=", "--ppid", str(process.pid)], capture_output=True, text=True).stdout
        process.send_signal(signal.SIGTERM)
        self.ended(process, 75)
        self.assertEqual(set(names.split()), {"clogsweep"})

    def test_it_needs_no_folder_for_its_own_files(self):
        # All ranks of a user would share such a folder. A rank would fail if it started while another rank ended.
        done = subprocess.run([str(BIN / "clogsweep"), *QUICK, "--output", "s.h5"], cwd=self.folder,
                              env={**os.environ, "TMPDIR": "/proc"}, capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)


if __name__ == "__main__":
    unittest.main()
