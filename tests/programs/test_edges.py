"""Tests sweeps in difficult surroundings: names with any byte, links that are moved, file modes, and foreign journals.
No row may be lost."""

import errno
import os
import resource
import shutil
import stat
import struct
import subprocess
import unittest

from support import BIN, ENDLESS, LONGEST, QUICK, SLOW, SweepTest, table

OWN = ["obstacle-layout=file", "box=10", "vertices=64", "max-time=30"]


class Limits(SweepTest):
    """Tests limits of a shell or of a batch system. The program must name the limit in one line."""

    def test_too_few_open_files(self):
        for most in (8, 10, 12, 18):
            with self.subTest(most=most):
                done = self.under(resource.RLIMIT_NOFILE, (most, most))
                self.assertEqual(done.returncode, 2, done.stderr)
                self.assertEqual(done.stderr, f"clogsweep: cannot start MPI (this shell allows {most} open files, "
                                              "32 are needed); raise the limit: ulimit -n 1024\n")
        done = self.under(resource.RLIMIT_NOFILE, (10, 4096))
        self.assertEqual(done.returncode, 0, done.stderr)  # The program raises a soft limit by itself.

    def test_too_few_processes(self):
        done = self.under(resource.RLIMIT_NPROC, (1, 1))
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertIn("clogsweep: cannot start a process (Resource temporarily unavailable); "
                      "end other programs, or raise the limit", done.stderr)
        self.assertEqual(done.stderr.count("\n"), 1)

    def under(self, what, limits):
        """Runs the program under a limit. Root has no limit on processes, so for root the test runs a copy of the
        program as another user."""
        program = shutil.copy(BIN / "clogsweep", self.folder)
        os.chmod(self.folder, 0o777)

        def restrict():
            if os.geteuid() == 0:
                os.setgroups([])
                os.setgid(65534)
                os.setuid(65534)
            resource.setrlimit(what, limits)

        return subprocess.run([program, *QUICK, "line-tension=1", "seeds=1", "--output", "s.h5"], cwd=self.folder,
                              capture_output=True, text=True, preexec_fn=restrict)


class Names(SweepTest):
    """Tests that a file of circles may have any name that the file system accepts."""

    def sweep_among(self, name):
        with open(os.fsencode(self.folder) + b"/" + name, "w") as file:
            file.write("x,y,diameter\n2,3,0.6\n7,8,1\n")
        return self.run_program("clogsweep", "obstacles=" + os.fsdecode(name), *OWN, "line-tension=1", "--output", "s.h5")

    def test_no_byte_of_a_name_sets_a_key_or_ends_the_sweep(self):
        for name in (b"p.csv\nline-tension = 0.1", b"\nfake: line.csv", b"p.csv\n#circles q.csv", b"a#b.csv",
                     b"a\\x0a.csv", b"a\r.csv", b"\xff\xfe.csv", "\u0085\u2028.csv".encode(), b"a = b.csv",
                     b"\x01\x1b\x7f.csv", b"lin(1;2;3)%s{}$(date)'\".csv", b"auto"):
            with self.subTest(name=name):
                done = self.sweep_among(name)
                self.assertEqual(done.returncode, 0, done.stderr)
                self.assertEqual(set(table(self.folder / "s.h5").line_tension), {1})
                for command in ("verify", "status"):
                    self.succeed("clogsweep", command, "s.h5")
                self.succeed("clogfit", "s.h5")
                self.assertEqual(self.sweep_among(name).returncode, 0, "the same command resumes the sweep")
                (self.folder / "s.h5").unlink()

    def test_a_config_that_was_printed_names_the_same_file(self):
        for name in ("p.csv\nline-tension = 0.1", " a#b\\x41.csv"):
            with self.subTest(name=name):
                self.assertEqual(self.sweep_among(name.strip(" ").encode()).returncode, 0)
                printed = self.succeed("clogsweep", "obstacles=" + name, *OWN, "line-tension=1",
                                       "--print-config").stdout
                self.write("again.cfg", printed.split("\n# Values behind")[0])
                self.succeed("clogsweep", "--config", "again.cfg", "--output", "t.h5")
                self.check_equal("s.h5", "t.h5")
                for output in ("s.h5", "t.h5"):
                    (self.folder / output).unlink()


FINISHED = [*QUICK, "line-tension=0.5", "obstacle-gap=0.4", "seeds=100..103"]
BRIEF = [word.replace("max-time=2e4", "max-time=5e3") for word in SLOW]


class Places(SweepTest):
    """Tests that a sweep resolves its path only once. If other users change the path while the sweep runs, the sweep
    must not lose a row, and must not write to the files of others."""

    def begin(self, sweep, output):
        """Starts a sweep. Waits until the sweep has written its table."""
        process = self.start(*sweep[:-1], output, ranks=1)
        self.wait_for(lambda: (self.folder / output).exists() or process.poll() is not None)
        return process

    def end(self, process):
        return process.communicate(timeout=LONGEST)[1]

    def check_over(self, name):
        self.assertEqual((~table(self.folder / name).status.isin(["running", "interrupted"])).sum(), 2)
        self.assertFalse((self.folder / f"{name}.journal").exists())

    def test_changing_a_link_does_not_redirect_the_table(self):
        self.succeed("clogsweep", *FINISHED, "--output", "run-1.h5")
        before = (self.folder / "run-1.h5").read_bytes()
        (self.folder / "latest.h5").symlink_to("run-2.h5")
        process = self.begin(BRIEF, "latest.h5")
        (self.folder / "latest.h5").unlink()
        (self.folder / "latest.h5").symlink_to("run-1.h5")
        self.end(process)
        self.assertEqual((self.folder / "run-1.h5").read_bytes(), before)
        self.check_over("run-2.h5")

    def test_a_folder_that_moves_keeps_its_sweep(self):
        (self.folder / "one").mkdir()
        process = self.begin(BRIEF, "one/s.h5")
        (self.folder / "one").rename(self.folder / "other")
        (self.folder / "one").mkdir()
        self.end(process)
        self.assertEqual(list((self.folder / "one").iterdir()), [])
        self.check_over("other/s.h5")

    def test_a_table_that_is_removed_is_written_again(self):
        process = self.begin(BRIEF, "s.h5")
        (self.folder / "s.h5").unlink()
        self.end(process)
        self.check_over("s.h5")

    def test_a_table_that_somebody_moves_there_is_not_overwritten(self):
        self.succeed("clogsweep", *FINISHED, "--output", "run-1.h5")
        before = (self.folder / "run-1.h5").read_bytes()
        process = self.begin(ENDLESS, "s.h5")
        (self.folder / "run-1.h5").rename(self.folder / "s.h5")
        self.assertIn("somebody has replaced it or its journal", self.end(process))
        self.assertEqual((self.folder / "s.h5").read_bytes(), before)
        (self.folder / "s.h5.rescued1").rename(self.folder / "s.h5")
        resumed = self.run_program("clogsweep", *ENDLESS, "--max-hours=1e-7")
        self.assertEqual(resumed.returncode, 75, resumed.stderr)
        self.assertEqual(table(self.folder / "s.h5").status.tolist(), ["interrupted"])


ACCESS_LIST = "system.posix_acl_access"


def access_list(reader):
    """An access list that lets the owner of a file read and write, and a second user read."""
    nobody = 2**32 - 1
    entries = [(0x01, 6, nobody), (0x02, 4, reader), (0x04, 0, nobody), (0x10, 4, nobody),
               (0x20, 0, nobody)]  # owner, a user, group, mask, others
    return struct.pack("<I", 2) + b"".join(struct.pack("<HHI", *entry) for entry in entries)


class Access(SweepTest):
    """Tests that the owner of a file determines who may read it, before and after the file is rewritten."""

    GROWN = [*FINISHED[:-1], "seeds=100..104"]

    def begin_file(self):
        self.succeed("clogsweep", *FINISHED, "--output", "s.h5")
        return self.folder / "s.h5"

    def grow(self):
        self.succeed("clogsweep", *self.GROWN, "--output", "s.h5")
        self.assertEqual(len(table(self.folder / "s.h5")), 5)

    def test_new_files_follow_the_umask(self):
        before = os.umask(0)
        self.addCleanup(os.umask, before)
        for mask in (0o022, 0o077, 0o002):
            os.umask(mask)
            self.assertEqual(stat.S_IMODE(self.begin_file().stat().st_mode), 0o666 & ~mask)
            (self.folder / "s.h5").unlink()

    def test_a_table_keeps_its_mode_owner_and_group(self):
        file = self.begin_file()
        for mode in (0o600, 0o640, 0o664):
            file.chmod(mode)
            if os.geteuid() == 0:
                os.chown(file, 12, 34)
            else:
                os.chown(file, -1, os.getgroups()[-1])
            owners = file.stat().st_uid, file.stat().st_gid
            self.grow()
            self.assertEqual(stat.S_IMODE(file.stat().st_mode), mode)
            self.assertEqual((file.stat().st_uid, file.stat().st_gid), owners)

    def test_a_table_keeps_its_access_list(self):
        file = self.begin_file()
        try:
            os.setxattr(file, ACCESS_LIST, access_list(12))
        except OSError as error:
            self.assertEqual(error.errno, errno.ENOTSUP)  # The file system has no access lists.
            return
        self.grow()
        self.assertEqual(os.getxattr(file, ACCESS_LIST), access_list(12))


class LinksOfOthers(SweepTest):
    """Tests which links are followed. In a folder where everybody may make links, only the user's own links are
    followed. The Linux setting fs.protected_symlinks has the same rule."""

    def open_folder(self):
        folder = self.folder / "open"
        folder.mkdir()
        folder.chmod(0o1777)
        return folder

    def test_links_of_ones_own_are_followed(self):
        folder = self.open_folder()
        for name in ("s.h5", "s.h5.journal"):
            (folder / name).symlink_to(self.folder / name)
        self.run_program("clogsweep", *FINISHED, "--output", "open/s.h5")
        self.assertEqual(len(table(self.folder / "s.h5")), 4)

    def test_links_of_others_are_refused(self):
        if os.geteuid() != 0:
            return  # Only root can make links that belong to another user.
        folder = self.open_folder()
        for name in ("s.h5", "t.h5.journal"):
            (folder / name).symlink_to(self.folder / "elsewhere")
            os.lchown(folder / name, 12, 34)
        for output in ("open/s.h5", "open/t.h5"):
            self.refuse("clogsweep", *FINISHED, "--output", output,
                        words=["cannot follow the link", "it belongs to another user"])
        self.assertFalse((self.folder / "elsewhere").exists())


SHIM = """
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>

static int is_to_fail(const char* what, int reason) {
  const char* named = getenv("FAILS");
  if (!named || strcmp(named, what) != 0) return 0;
  errno = reason;
  return 1;
}
int fsync(int file) {
  struct stat status;
  if (fstat(file, &status) == 0 && S_ISDIR(status.st_mode) && is_to_fail("folder", EIO)) return -1;
  return ((int (*)(int))dlsym(RTLD_NEXT, "fsync"))(file);
}
int flock(int file, int what) {
  if (what != LOCK_UN && is_to_fail("locks", ENOLCK)) return -1;
  return ((int (*)(int, int))dlsym(RTLD_NEXT, "flock"))(file, what);
}
int fstatat(int folder, const char* name, struct stat* status, int flags) {
  if (strstr(name, ".journal") && is_to_fail("state", ESTALE)) return -1;
  return ((int (*)(int, const char*, struct stat*, int))dlsym(RTLD_NEXT, "fstatat"))(folder, name, status, flags);
}
int unlinkat(int folder, const char* name, int flags) {
  if (strstr(name, ".journal") && is_to_fail("journal", EPERM)) return -1;
  return ((int (*)(int, const char*, int))dlsym(RTLD_NEXT, "unlinkat"))(folder, name, flags);
}
"""


class Refusals(SweepTest):
    """Tests a file system that stores the rows and then fails."""

    def where(self, fails, **more):
        """An environment that makes these system calls of a program fail."""
        self.write("shim.c", SHIM)
        subprocess.run(["cc", "-shared", "-fPIC", "-o", "shim.so", "shim.c", "-ldl"], cwd=self.folder, check=True)
        return {**os.environ, "LD_PRELOAD": str(self.folder / "shim.so"), "FAILS": fails, "ASAN_OPTIONS": f"{os.environ.get('ASAN_OPTIONS', '')}:verify_asan_link_order=0", **more}

    def succeed_where(self, fails, *arguments, **more):
        return self.succeed("clogsweep", *arguments, env=self.where(fails, **more))

    def test_a_sweep_goes_on_though_its_folder_cannot_be_synced(self):
        done = self.succeed_where("folder", *FINISHED, "--output", "s.h5")
        self.assertEqual(done.stderr.count("the folder of s.h5 cannot be synchronised (Input/output error): "
                                           "after a power cut the newest rows may be lost"), 1)
        self.assertIn("4 rows of 4 runs, all undamaged", self.succeed("clogsweep", "verify", "s.h5").stdout)

    def test_a_sweep_without_locks_is_for_users_who_ask_for_it(self):
        words = ["cannot lock s.h5.journal (No locks available); "
                 "use a folder whose file system has locks", "HDF5_USE_FILE_LOCKING=FALSE"]
        self.refuse("clogsweep", *FINISHED, "--output", "s.h5", env=self.where("locks"), words=words)
        self.succeed_where("locks", *FINISHED, "--output", "s.h5", HDF5_USE_FILE_LOCKING="FALSE")
        done = self.succeed_where("locks", "verify", "s.h5", HDF5_USE_FILE_LOCKING="TRUE")
        self.assertIn("4 rows of 4 runs, all undamaged", done.stdout)

    def test_a_journal_whose_state_cannot_be_read_ends_the_sweep(self):
        done = self.run_program("clogsweep", *FINISHED, "--output", "s.h5", env=self.where("state"))
        self.assertEqual(done.returncode, 2)
        self.assertIn("cannot use s.h5.journal (its state cannot be read: Stale file handle)", done.stderr)

    def test_a_merge_is_there_though_its_folder_cannot_be_synced(self):
        self.succeed("clogsweep", *FINISHED, "--output", "a.h5")
        self.succeed("clogsweep", *FINISHED[:-1], "seeds=104..105", "--output", "b.h5")
        done = self.succeed_where("folder", "merge", "a.h5", "b.h5", "--output", "c.h5")
        self.assertEqual(done.stderr, "c.h5 is complete, but its folder cannot be synced (Input/output error): "
                                      "a power cut may lose it; copy it elsewhere, too\n")
        self.assertIn("6 rows", self.succeed("clogsweep", "verify", "c.h5").stdout)

    def test_a_journal_that_cannot_be_removed_is_named(self):
        done = self.succeed_where("journal", *FINISHED, "--output", "s.h5")
        self.assertIn("clogsweep: cannot remove s.h5.journal (Operation not permitted); "
                      "the sweep is complete without it: remove it\n", done.stderr)
        self.assertIn("4 rows of 4 runs, all undamaged", self.succeed("clogsweep", "verify", "s.h5").stdout)


if __name__ == "__main__":
    unittest.main()
