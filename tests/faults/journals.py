"""Makes valid journals with wrong content. The records come from another sweep or version, or contain rows and
snapshots that no run has made."""

import struct
import zlib

import h5py
import numpy

from launch import run
from metadata import JOURNAL, STOPPED, Stopped
from samples import FILE, REPORTS, VERIFY, check_complete, in_child, results, stored_rows
from support import FAMILIES, SNAPSHOT_OF_A_DAUGHTER

# Settings of other sweeps. Their journals do not belong to the tested sweep.
FOREIGN = ["max-time=9000", "vertices=48", "box=25"]
# Families whose runs take seconds, with snapshots of their daughters
DAUGHTERS = [*FAMILIES[:-2], "max-time=6000", "seeds=1..2", "--report-seconds=0.1", "--output", FILE]
FILE_HEADER = 24
RECORD_HEADER = struct.Struct("<QII")  # the size and CRC-32 of row and snapshot, and a magic word
SPECIAL = [0.0, -0.0, -1.0, 1e-308, 1e308, -1e308, float("inf"), float("-inf"), float("nan"), 1e9, 1e17]


def split(content, row_size):
    """The records of a journal, as pairs of a row and a snapshot."""
    records = []
    place = FILE_HEADER
    while place < len(content):
        size, _, _ = RECORD_HEADER.unpack_from(content, place)
        place += RECORD_HEADER.size
        records.append((content[place:place + row_size], content[place + row_size:place + size]))
        place += size
    return records


def join(content, records):
    """A journal that consists of these records, with correct checksums."""
    magic = RECORD_HEADER.unpack_from(content, FILE_HEADER)[2]
    payloads = [row + snapshot for row, snapshot in records]
    return content[:FILE_HEADER] + b"".join(RECORD_HEADER.pack(len(payload), zlib.crc32(payload), magic) + payload
                                            for payload in payloads)


def replaced(setting):
    """The command of the stopped sweep, with another value of a key."""
    key = setting.split("=")[0] + "="
    return [setting if word.startswith(key) else word for word in STOPPED]


class Faults:
    def __init__(self, folder):
        single = Stopped(folder)
        self.all = {self.foreign: single, self.hostile_row: single, self.hostile_snapshot: single,
                    self.hostile_snapshot_of_a_daughter: Stopped(folder, DAUGHTERS, SNAPSHOT_OF_A_DAUGHTER)}
        self.others = {setting: Stopped(folder, replaced(setting)) for setting in FOREIGN}

    def try_one(self, case):
        way = case.chance.choice(list(self.all))
        self.stopped = self.all[way]
        with h5py.File(self.stopped.folder / FILE) as file:
            self.row = file["runs"].dtype
        self.complete = (self.stopped.folder / FILE).read_bytes()
        self.own = split(self.stopped.files[JOURNAL], self.row.itemsize)
        way(case)

    def foreign(self, case):
        """Checks that a foreign journal is refused and changes nothing, and that the sweep resumes when this journal
        has been moved away."""
        origin = case.chance.choice([*self.others, "another version"])
        if origin in self.others:
            records = split(self.others[origin].files[JOURNAL], self.row.itemsize)
        else:
            records = [(self.edited(row, "model_version", 1), snapshot) for row, snapshot in self.own]
        if case.chance.random() < 0.5:  # a mixture of records of both sweeps
            records = case.chance.sample([*records, *self.own], len(records) + len(self.own))
        case.note(f"journal of {origin}, {len(records)} records")
        self.put(case, records, case.chance.choice([self.stopped.files[FILE], self.complete, None]))
        refused = self.go_on(case)
        case.expect(refused, "clogsweep: adopts a journal of another sweep")
        check_complete(case, case.folder / FILE, self.stopped.rows)

    def hostile_row(self, case):
        number = case.chance.randrange(len(self.own))
        row, snapshot = self.own[number]
        name = case.chance.choice(self.row.names)
        value = self.hostile_value(case.chance, self.row[name])
        case.note(f"record {number} of {len(self.own)}: {name} is {value!r}")
        self.check(case, number, (self.edited(row, name, value), snapshot))

    def hostile_snapshot_of_a_daughter(self, case):
        self.hostile_snapshot(case)

    def hostile_snapshot(self, case):
        number = case.chance.choice([number for number, (_, snapshot) in enumerate(self.own) if snapshot])
        row, snapshot = self.own[number]
        harmed = bytearray(snapshot)
        way = case.chance.choice(["special", "special", "random", "cut", "added"])
        if way == "cut":
            del harmed[case.chance.randrange(len(harmed)):]
        elif way == "added":
            harmed += case.chance.randbytes(case.chance.randint(1, 64))
        else:
            for _ in range(case.chance.choice([1, 1, 8])):
                place = case.chance.randrange(len(harmed) // 8) * 8
                value = struct.pack("<d", case.chance.choice(SPECIAL)) if way == "special" else case.chance.randbytes(8)
                harmed[place:place + 8] = value
                case.note(f"bytes {place} to {place + 8} are {value.hex()}")
        case.note(f"record {number} of {len(self.own)}: snapshot {way}")
        self.check(case, number, (row, bytes(harmed)))

    def check(self, case, number, record):
        """Checks that a forged record affects no run except its own. The rows of all other runs stay the same."""
        task = int(numpy.frombuffer(self.own[number][0], self.row)[0]["task"])
        self.put(case, [*self.own[:number], record, *self.own[number + 1:]], self.stopped.files[FILE])
        for report in (VERIFY, *REPORTS):
            run(case, *report)
        self.go_on(case)
        case.expect(run(case, *VERIFY).code == 0, "clogsweep verify: finds faults in what a sweep has finished")
        found, why = in_child(stored_rows, case.folder / FILE)
        case.expect(found is not None, f"the finished table cannot be read: {why}")
        if found is None:
            return
        rows, undisturbed = results(found), results(self.stopped.rows)
        case.expect(undisturbed.keys() <= rows.keys(), "a run is missing")
        case.expect(all(rows.get(other) == row for other, row in undisturbed.items() if other != task),
                    "the row of another run has changed")

    def put(self, case, records, table):
        (case.folder / JOURNAL).write_bytes(join(self.stopped.files[JOURNAL], records))
        if table is not None:
            (case.folder / FILE).write_bytes(table)

    def go_on(self, case):
        """Runs the sweep's command. If the command refuses the journal, deletes the journal and runs the command again.
        @return whether the command refused the journal"""
        before = {path.name: path.read_bytes() for path in case.folder.iterdir()}
        outcome = run(case, "clogsweep", *self.stopped.settings, exit_codes={0, 2})
        if outcome.code != 2:
            return False
        case.expect({path.name: path.read_bytes() for path in case.folder.iterdir()} == before,
                    "clogsweep: refuses a journal, but changes a file")
        (case.folder / JOURNAL).unlink()
        case.expect(run(case, "clogsweep", *self.stopped.settings).code == 0,
                    "clogsweep: does not resume without the journal")
        return True

    def edited(self, row, name, value):
        fields = numpy.frombuffer(row, self.row).copy()
        fields[name] = value
        return fields.tobytes()

    @staticmethod
    def hostile_value(chance, kind):
        """A value for a column: a number that no run can have, or random bytes."""
        if kind.kind == "f" and chance.random() < 0.7:
            return chance.choice(SPECIAL)
        if kind.kind in "iu" and chance.random() < 0.7:
            return chance.choice([0, -1, 1, 2**31 - 1, 2**62]) % 2**(8 * kind.itemsize - 1)
        return numpy.frombuffer(chance.randbytes(kind.itemsize), kind)[0]
