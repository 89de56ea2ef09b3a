"""Damages the metadata of a sweep's file, or the journal of a stopped sweep."""

import itertools
import pathlib
import shutil
import subprocess
import tempfile

from damage import harm
from launch import command, run
from samples import (FILE, REPORTS, SEAL, VERIFY, check_complete, check_readers, check_resumed, rows_place, samples,
                     stored_rows)
from support import SMALL

JOURNAL = FILE + ".journal"
# The first run makes a snapshot every 2^18 steps, which take a sixth of its time.
STOPPED = [*SMALL, "obstacle-gap=0.4", "line-tension=0.05,0.5", "max-time=1e4", "seeds=1", "--output", FILE]
# The sweep is stopped after these times. The times grow, because on a slow or busy machine the first snapshot comes
# later.
HOURS = [1e-4 * 1.5**n for n in range(16)]


class Stopped:
    """A sweep that was stopped while one of its runs had a snapshot, and the table of the same sweep after its
    completion. @param sign  bytes of the snapshot"""

    def __init__(self, folder, settings=STOPPED, sign=b""):
        self.folder = pathlib.Path(tempfile.mkdtemp(dir=folder))
        self.settings = settings
        self.sign = sign
        for hours in itertools.cycle(HOURS):
            self.sweep(f"--max-hours={hours}")
            if self.has_snapshot():
                break
            shutil.rmtree(self.folder)
            self.folder.mkdir()
        self.files = {name: (self.folder / name).read_bytes() for name in (FILE, JOURNAL)}
        self.sweep()
        self.rows = stored_rows(self.folder / FILE)

    def sweep(self, *more):
        subprocess.run(command("clogsweep", *self.settings, *more), cwd=self.folder, stderr=subprocess.DEVNULL)

    def has_snapshot(self):
        journal = self.folder / JOURNAL
        return journal.exists() and journal.stat().st_size > 4096 and self.sign in journal.read_bytes()


class Faults:
    def __init__(self, folder):
        self.samples = samples(folder)
        self.places = {sample.name: self.outside_the_rows(sample) for sample in self.samples}
        self.stopped = Stopped(folder)

    @staticmethod
    def outside_the_rows(sample):
        begin, _, _, end = rows_place(sample.path)
        return [*range(begin), *range(end, len(sample.content))]

    def try_one(self, case):
        case.chance.choice([self.harm_a_table, self.harm_a_table, self.harm_a_journal])(case)

    def harm_a_table(self, case):
        """Damages a file that a sweep wrote, or another program's copy of this file. Such a copy has no seal, so
        nothing shows that a part is missing."""
        sample = case.chance.choice(self.samples)
        end = case.chance.choice([len(sample.content), sample.content.rindex(SEAL)])
        places = [place for place in self.places[sample.name] if place < end]
        way, content = harm(case.chance, sample.content[:end], places)
        case.note(f"{sample.name}{'' if end == len(sample.content) else ', a copy'}: {way}")
        (case.folder / FILE).write_bytes(content)
        check_readers(case, sample)
        check_resumed(case, sample.sweep, sample.rows)

    def harm_a_journal(self, case):
        journal = self.stopped.files[JOURNAL]
        way, content = harm(case.chance, journal, range(len(journal)))
        case.note(f"journal: {way}")
        (case.folder / FILE).write_bytes(self.stopped.files[FILE])
        (case.folder / JOURNAL).write_bytes(content)
        for report in (VERIFY, *REPORTS):
            run(case, *report)
        outcome = run(case, "clogsweep", *STOPPED, exit_codes={0, 2})
        if outcome.code == 2:
            case.expect((case.folder / JOURNAL).read_bytes() == content, "clogsweep: refuses a journal, but changes it")
            (case.folder / JOURNAL).unlink()  # The message of the program asks for this.
            case.expect(run(case, "clogsweep", *STOPPED).code == 0, "clogsweep: does not resume without the journal")
        check_complete(case, case.folder / FILE, self.stopped.rows)
