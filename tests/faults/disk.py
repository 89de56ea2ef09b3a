"""Runs programs while a resource runs out: the disk gets full, a file reaches its size limit, or memory is exhausted at
a random moment."""

import contextlib
import os
import resource
import subprocess

from launch import command, quoted, run
from samples import FILE, Sample, check_complete, finished_rows
from support import QUICK

TRAJECTORY = ["array", *QUICK, "--sample-interval=0.1", "--polygon-interval=0.5", "--output", "r.h5"]
MEGABYTE = 2**20
ENOUGH_MEMORY = 2048 * MEGABYTE
LOADER_GAVE_UP = 127  # The loader found no memory for the libraries, so the program did not begin.


def limit_files(size):
    """Limits the size of files. Writing beyond the limit fails, as on a full disk."""
    def prepare():
        # The shared memory of MPICH consists of files, so the limit would apply to it, too.
        os.environ["UCX_TLS"] = "self,tcp"
        resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))
    return prepare


def limit_memory(size):
    return lambda: resource.setrlimit(resource.RLIMIT_AS, (size, size))


@contextlib.contextmanager
def small_disk(folder, size):
    subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={size}", "none", folder], check=True, capture_output=True)
    try:
        yield
    finally:
        subprocess.run(["umount", folder], check=True)


def may_mount(folder):
    try:
        with small_disk(folder, MEGABYTE):
            return True
    except subprocess.CalledProcessError:
        return False


def may_limit_memory():
    """Whether memory can be limited. A limit is impossible for programs with sanitizers, which map more memory than any
    machine has."""
    return subprocess.run(command("clogfit", "--version"), capture_output=True,
                          preexec_fn=limit_memory(ENOUGH_MEMORY)).returncode == 0


class Faults:
    def __init__(self, folder):
        self.sample = Sample("polygons", folder)
        disk = folder / "disk"
        disk.mkdir()
        self.faults = [self.limited_sweep, self.limited_trajectory, self.limited_output]
        if may_mount(disk):
            self.faults.append(self.sweep_on_a_small_disk)
        if may_limit_memory():
            self.faults += [self.little_memory, self.sweep_in_little_memory]

    def try_one(self, case):
        case.chance.choice(self.faults)(case)

    def size(self, case):
        return case.chance.randrange(len(self.sample.content) * 3 // 2)

    def limited_sweep(self, case):
        size = self.size(case)
        case.note(f"sweep, files of {size} bytes at most")
        self.sweep_and_go_on(case, prepare=limit_files(size))

    def sweep_on_a_small_disk(self, case):
        size = (1 + self.size(case) // 4096) * 4096 * 2  # A draft of the table may exist beside the table.
        case.note(f"sweep, disk of {size} bytes")
        with small_disk(case.folder, size):
            self.sweep_and_go_on(case, make_room=lambda: subprocess.run(
                ["mount", "-o", f"remount,size={MEGABYTE}", case.folder], check=True))

    def sweep_in_little_memory(self, case):
        size = case.chance.randrange(20, 600) * MEGABYTE
        case.note(f"sweep, {size // MEGABYTE} MB of memory")
        self.sweep_and_go_on(case, prepare=limit_memory(size), exit_codes={0, 2, LOADER_GAVE_UP})

    def sweep_and_go_on(self, case, prepare=None, make_room=lambda: None, exit_codes=frozenset({0, 2})):
        """Runs a sweep on a full disk, and then runs the same command again with enough room."""
        run(case, "clogsweep", *self.sample.sweep, prepare=prepare, exit_codes=exit_codes)
        finished = finished_rows(case)
        make_room()
        outcome = run(case, "clogsweep", *self.sample.sweep)
        case.expect(outcome.code == 0, "clogsweep: does not resume when there is room")
        check_complete(case, case.folder / FILE, self.sample.rows)
        later = finished_rows(case)
        case.expect(all(later.get(task) == row for task, row in finished.items()), "a finished row was lost")

    def limited_trajectory(self, case):
        size = self.size(case)
        case.note(f"trajectory, files of {size} bytes at most")
        outcome = run(case, "clogrun", *TRAJECTORY, prepare=limit_files(size), exit_codes={0, 2})
        files = os.listdir(case.folder)
        case.expect(files == (["r.h5"] if outcome.code == 0 else []) or not outcome.is_over,
                    f"{outcome.name}: exit code {outcome.code}, and leaves {', '.join(files) or 'no file'}")

    def limited_output(self, case):
        """Prints to a file of limited size. Exit code 0 is correct only if everything was written."""
        words = case.chance.choice([["clogsweep", "--help"], ["clogsweep", *self.sample.sweep, "--dry-run"],
                                    ["clogsweep", "status", FILE], ["clogfit", FILE, "--format", "json"],
                                    ["clogrun", "--help"]])
        (case.folder / FILE).write_bytes(self.sample.content)
        whole = run(case, *words).output
        size = case.chance.randrange(len(whole) + 10)
        case.note(f"{quoted(words)}, {size} of {len(whole)} bytes can be printed")
        with open(case.folder / "printed", "wb") as file:
            outcome = run(case, *words, prepare=limit_files(size), stdout=file, exit_codes={0, 2})
        is_whole = (case.folder / "printed").stat().st_size == len(whole)
        case.expect(outcome.code == (0 if is_whole else 2), f"{outcome.name}: exit code {outcome.code} with "
                    f"{'all' if is_whole else 'a part'} of its output written")

    def little_memory(self, case):
        words = case.chance.choice([["clogsweep", "verify", FILE], ["clogsweep", "status", FILE], ["clogfit", FILE],
                                    ["clogrun", *TRAJECTORY], ["clogsweep", "replay", FILE, "0"]])
        size = case.chance.randrange(20, 400) * MEGABYTE
        case.note(f"{quoted(words)}, {size // MEGABYTE} MB of memory")
        (case.folder / FILE).write_bytes(self.sample.content)
        run(case, *words, prepare=limit_memory(size), exit_codes={0, 2, LOADER_GAVE_UP})
