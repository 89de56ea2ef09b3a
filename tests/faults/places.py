"""Links and folders are moved under a sweep, its table or journal are taken away or exchanged; then the same command."""

import os
import shutil
import subprocess
import time

import kills
from launch import command, run
from processes import Hung, wait_for
from samples import FILE, Sample, check_complete, finished_rows
from support import TIMING

RANKS = kills.RANKS
SWEEP = kills.SWEEP[:-1]  # without the file


class Faults:
    def __init__(self, folder):
        self.usual = kills.Faults(folder)
        self.other = Sample("disks", folder).content  # of another sweep, which is to stay as it is

    def try_one(self, case):
        deed = case.chance.choice([self.move_link, self.move_folder, self.move_table_there, self.remove_journal, self.remove_table])
        case.note(deed.__name__)
        (case.folder / "one").mkdir()
        (case.folder / "other.h5").write_bytes(self.other)
        (case.folder / "link.h5").symlink_to(f"one/{FILE}")
        output = case.chance.choice(["link.h5", f"one/{FILE}"]) if deed != self.move_link else "link.h5"
        process = subprocess.Popen(command("clogsweep", *SWEEP, output, ranks=RANKS), cwd=case.folder,
                                   stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, start_new_session=True)
        while not (case.folder / "one" / FILE).exists() and process.poll() is None:
            time.sleep(0.01)
        time.sleep(case.chance.uniform(0, self.usual.duration))
        finished = self.finished(case, "one")
        was_running = process.poll() is None
        folder = deed(case)
        code, error = self.end(case, process)
        if code is None:
            return
        case.note(f"{'running' if was_running else 'over'}, then exit code {code}: {error[-200:].decode('utf-8', 'replace')}")
        self.judge(case, folder, finished)

    def judge(self, case, folder, finished):
        """@param folder  of the sweep's file after the deed; nothing if the deed was the loss of a table that was complete"""
        case.expect(any(path.read_bytes() == self.other for path in case.folder.rglob("*.h5")), "another sweep's file was changed")
        if folder == "two":
            case.expect(not os.listdir(case.folder / "one"), "files were made in the folder that came in the place of the sweep's")
        path = case.folder / folder / FILE
        rescued = path.with_name(FILE + ".rescued1")
        if rescued.exists():
            case.expect(path.read_bytes() == self.other, "another sweep's file was overwritten")
            rescued.replace(path)
        elif not path.exists() or path.read_bytes() == self.other:
            return  # it was over before that
        later = self.finished(case, folder)
        case.expect(all(later.get(task) == row for task, row in finished.items()), "a finished row was lost")
        outcome = run(case, "clogsweep", *SWEEP, f"{folder}/{FILE}", ranks=RANKS)
        case.expect(outcome.code == 0, f"clogsweep: does not resume, exit code {outcome.code}")
        check_complete(case, path, self.usual.rows, ignored=[*TIMING, "attempt"])

    @staticmethod
    def finished(case, folder):
        whole, case.folder = case.folder, case.folder / folder
        try:
            return finished_rows(case)
        finally:
            case.folder = whole

    @staticmethod
    def end(case, process):
        try:
            _, error = wait_for(process.pid, process.communicate)
        except Hung as hung:
            case.findings.append(f"a sweep whose place was disturbed: {hung}")
            kills.kill(pid for generation in kills.descend(process.pid) for pid in generation)
            process.communicate()
            return None, b""
        case.expect(process.returncode in (0, 2), f"clogsweep: exit code {process.returncode}")
        return process.returncode, error

    @staticmethod
    def move_link(case):
        (case.folder / "next").symlink_to("other.h5")
        (case.folder / "next").replace(case.folder / "link.h5")
        return "one"

    @staticmethod
    def move_folder(case):
        (case.folder / "one").rename(case.folder / "two")
        (case.folder / "one").mkdir()
        return "two"

    @staticmethod
    def move_table_there(case):
        shutil.copy(case.folder / "other.h5", case.folder / "copy.h5")
        (case.folder / "other.h5").unlink()  # its only copy is in the sweep's place from now on
        (case.folder / "copy.h5").replace(case.folder / "one" / FILE)
        return "one"

    @staticmethod
    def remove_journal(case):
        (case.folder / "one" / (FILE + ".journal")).unlink(missing_ok=True)
        return "one"

    @staticmethod
    def remove_table(case):
        (case.folder / "one" / FILE).unlink(missing_ok=True)
        return "one"
