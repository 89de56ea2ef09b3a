"""Makes small sweeps for tests that damage them, and records what the programs report about the intact sweeps."""

import multiprocessing
import os
import resource
import subprocess

import h5py
from clogsweep.reading import stored
from clogsweep.tools.errors import UserError

from launch import command, run
from processes import CPU_SECONDS
from support import BLOCKED, FAMILIES, QUICK, TIMING

FILE = "s.h5"
SEAL = b"\nclogsweep seal"  # marks the end of a file
SALVAGED = "salvaged.h5"
SWEEPS = {
    "polygons": [*QUICK, "obstacle-gap=0.4", "line-tension=0.05,0.5,1", "seeds=1..2"],
    "failures": [*BLOCKED, "seeds=63..64"],
    "families": [*FAMILIES[:-1], "seeds=1..2"],
    "disks": ["model=sp", "wall-stiffness=1", "box=20", "obstacle-density=saturated",
              "max-time=60", "obstacle-gap=0.4,1.2", "seeds=1..2"],
}
VERIFY = ("clogsweep", "verify", FILE)
REPORTS = [("clogsweep", "status", FILE, "--format", "json"), ("clogfit", FILE, "--format", "json")]
ENDINGS = (b"clogged", b"broken", b"flowing")


def in_child(function, *arguments):
    """Calls a function in a child process, because it may crash or never end. @return the function's value, or None and
    the reason"""
    def work(connection):
        resource.setrlimit(resource.RLIMIT_CPU, (CPU_SECONDS, CPU_SECONDS))
        os.dup2(os.open(os.devnull, os.O_WRONLY), 2)  # hides warnings
        try:
            connection.send((function(*arguments), None))
        except (OSError, UserError) as error:
            connection.send((None, f"refused: {error}"))
        except Exception as error:
            connection.send((None, f"{type(error).__name__}: {error}"))

    fork = multiprocessing.get_context("fork")
    receiver, sender = fork.Pipe(duplex=False)
    process = fork.Process(target=work, args=(sender,))
    process.start()
    sender.close()
    try:
        answer = receiver.recv()
    except EOFError:
        answer = None
    process.join()
    return answer or (None, f"died, exit code {process.exitcode}")


def stored_rows(path):
    """The bytes of each column of every task, and of the droplets of its family, read by h5py."""
    with h5py.File(path, "r") as file:
        rows = file["runs"][()]
        droplets = file["droplets"][()] if "droplets" in file else None
    stored = {int(row["task"]): {name: row[name].tobytes() for name in rows.dtype.names} for row in rows}
    if droplets is not None:
        for task, row in stored.items():
            row["droplets"] = droplets[droplets["task"] == task].tobytes()
    return stored


def stored_texts(path):
    """The attributes of the file and of its table."""
    with h5py.File(path, "r") as file:
        return {f"{place} {name}": bytes(value) for place, item in (("file", file), ("runs", file["runs"]))
                for name, value in item.attrs.items()}


def read_with_python(path):
    """The rows that the Python module reads, as text with all digits."""
    return stored.read_table(path).to_csv()


def results(rows, ignored=TIMING):
    """Rows without those columns in which two computations of the same run may differ."""
    return {task: {name: value for name, value in row.items() if name not in ignored} for task, row in rows.items()}


def finished_rows(case):
    """The results of runs that have ended. The result is empty if there is no table yet."""
    path = case.folder / FILE
    if not path.exists():
        return {}
    rows, why = in_child(stored_rows, path)
    case.expect(rows is not None, f"a table is left that cannot be read: {why}")
    return {task: row for task, row in results(rows or {}).items() if row["status"].rstrip(b"\0") in ENDINGS}


def differing(some, others):
    """Names of the columns in which the rows of two tables differ, and tasks with a row in only one of the tables."""
    names = {name for task in some.keys() & others.keys() for name in some[task].keys() | others[task].keys()
             if some[task].get(name) != others[task].get(name)}
    return sorted(names | {f"task {task}" for task in some.keys() ^ others.keys()})


class Sample:
    """A finished sweep, and the report of every reader about it."""

    def __init__(self, name, folder):
        self.name = name
        self.sweep = [*SWEEPS[name], "--output", FILE]
        self.folder = folder / name
        self.folder.mkdir()
        subprocess.run(command("clogsweep", *self.sweep, "--quiet"), cwd=self.folder, check=True,
                       stderr=subprocess.DEVNULL)
        self.content = self.path.read_bytes()
        self.rows = stored_rows(self.path)
        self.texts = stored_texts(self.path)
        self.table = read_with_python(self.path)
        self.reports = [subprocess.run(command(*report), cwd=self.folder, check=True, capture_output=True).stdout
                        for report in REPORTS]

    @property
    def path(self):
        return self.folder / FILE


def samples(folder):
    return [Sample(name, folder) for name in SWEEPS]


def check_readers(case, sample):
    """Checks every reader of the case's file. A reader must report the undamaged numbers, or that the file is
    damaged."""
    path = case.folder / FILE
    before = path.read_bytes()
    for report, told in zip(REPORTS, sample.reports):
        outcome = run(case, *report)
        case.expect(outcome.code != 0 or outcome.output == told,
                    f"{outcome.name}: other numbers than from the undamaged file, exit code 0")
    table, why = in_child(read_with_python, path)
    case.expect(table is None or table == sample.table, "read_table: other numbers than from the undamaged file")
    case.expect(table is not None or why.startswith("refused"), f"read_table: {str(why).split(':')[0]}")
    # In a copy without a seal, verify checks only rows and settings.
    if run(case, *VERIFY).code == 0 and SEAL in before:
        check_called_whole(case, sample, path)
    check_salvaged(case, sample)
    case.expect(path.read_bytes() == before, "a reader changed the file")


def check_salvaged(case, sample):
    """Checks that the rows that salvage keeps from a damaged file are unchanged."""
    outcome = run(case, "clogsweep", "salvage", FILE, "--output", SALVAGED)
    if outcome.code != 0:
        return
    rows, why = in_child(stored_rows, case.folder / SALVAGED)
    case.expect(rows is not None, f"{outcome.name}: makes a file that cannot be read: {why}")
    case.expect(all(sample.rows.get(task) == row for task, row in (rows or {}).items()),
                f"{outcome.name}: accepts a changed row as undamaged")


def check_called_whole(case, sample, path):
    """If verify accepts a file as undamaged, every reader must find it unchanged."""
    rows, why = in_child(stored_rows, path)
    texts, why_no_texts = in_child(stored_texts, path)
    if rows is None or texts is None:
        case.findings.append("clogsweep verify: accepts a file as undamaged that h5py cannot read")
        case.note(why or why_no_texts)
        return
    changed = differing(rows, sample.rows)
    changed += [name for name in texts.keys() | sample.texts.keys() if texts.get(name) != sample.texts.get(name)]
    case.expect(not changed, "clogsweep verify: accepts a changed file as undamaged")
    if changed:
        case.note(f"changed: {', '.join(changed)}")


def check_resumed(case, sweep, rows):
    """Runs the command that made the file. The command must repair the file, or refuse it and leave it unchanged.

    @param rows  of the undisturbed sweep
    """
    path = case.folder / FILE
    before = path.read_bytes()
    outcome = run(case, "clogsweep", *sweep, exit_codes={0, 2})
    if outcome.code == 2:
        case.expect(path.read_bytes() == before, "clogsweep: refuses to resume, but has changed the file")
    if outcome.code == 0:
        check_complete(case, path, rows)


def check_complete(case, path, rows, ignored=TIMING):
    """Checks that the file has all rows of the undisturbed sweep. @param rows  of this sweep"""
    found, why = in_child(stored_rows, path)
    if found is None:
        case.findings.append("the finished table cannot be read")
        case.note(why)
        return
    changed = differing(results(found, ignored), results(rows, ignored))
    case.expect(not changed, "the finished table differs from the undisturbed one")
    if changed:
        case.note(f"changed: {', '.join(changed)}")


def rows_place(path):
    """The first and the last byte of the rows, the size of a row in bytes, and the place and size of each column in a
    row."""
    with h5py.File(path, "r") as file:
        table = file["runs"]
        begin = table.id.get_chunk_info(0).byte_offset if table.chunks else table.id.get_offset()
        size = table.dtype.itemsize
        columns = {name: (table.dtype.fields[name][1], table.dtype[name].itemsize) for name in table.dtype.names}
        room = table.chunks[0] if table.chunks else len(table)
        return begin, size, columns, begin + room * size
