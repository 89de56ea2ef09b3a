"""Sends signals to processes of a sweep on two ranks at random moments. The same command must then complete the
sweep."""

import os
import signal
import subprocess
import time

from launch import command, run
from processes import Hung, are_gone, descend, kill, send, wait_for
from samples import FILE, check_complete, finished_rows, stored_rows
from support import FAMILIES, SMALL, TIMING

# A task may be killed many times before it ends. The number of --attempts is so large that these kills do not make the
# task fail.
MORE = ["--attempts=1000", "--report-seconds=0.1", "--output", FILE]
SWEEPS = [[*SMALL, "obstacle-gap=0.4,0.5", "line-tension=0.05,0.5", "max-time=2000", "seeds=1..2", *MORE],
          [*FAMILIES[:-2], "max-time=1500", "seeds=1..2", *MORE]]
RANKS = 2
GENERATIONS = ["mpirun", "a rank", "a helper", "a computing process"]
SIGNALS = [signal.SIGKILL, signal.SIGTERM, signal.SIGINT, signal.SIGSTOP]
# Exit codes of a sweep if only its mpirun received this signal (docs/reference/exit-codes.md). On SIGINT mpirun itself
# chooses the code.
CODES_OF_MPIRUN = {signal.SIGTERM: {0, 1, 75}, signal.SIGSTOP: {0}}
# If a signal ends one process, the remaining processes of the sweep must end within this time [s]. After it the test
# kills them, as a batch system would.
PATIENCE = 5


class Faults:
    def __init__(self, folder):
        self.undisturbed = []
        for number, sweep in enumerate(SWEEPS):
            place = folder / str(number)
            place.mkdir()
            begin = time.monotonic()
            subprocess.run(command("clogsweep", *sweep, ranks=RANKS), cwd=place, check=True, stderr=subprocess.DEVNULL)
            self.undisturbed.append((sweep, time.monotonic() - begin, stored_rows(place / FILE)))

    def try_one(self, case):
        sweep, duration, rows = case.chance.choice(self.undisturbed)
        finished = {}
        for _ in range(case.chance.randint(1, 4)):
            self.disturb(case, sweep, duration)
            later = finished_rows(case)
            case.expect(all(later.get(task) == row for task, row in finished.items()), "a finished row was lost")
            finished = later
        outcome = run(case, "clogsweep", *sweep, ranks=RANKS)
        case.expect(outcome.code == 0, f"clogsweep: does not resume, exit code {outcome.code}")
        check_complete(case, case.folder / FILE, rows, ignored=[*TIMING, "attempt"])
        case.expect(os.listdir(case.folder) == [FILE], "a finished sweep leaves a journal or a draft")

    def disturb(self, case, sweep, duration):
        """Starts or resumes the sweep. Sends signals to one or two of its processes."""
        process = subprocess.Popen(command("clogsweep", *sweep, ranks=RANKS), cwd=case.folder,
                                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True)
        time.sleep(case.chance.uniform(0, duration))
        generations = descend(process.pid)
        sent = [self.send_one(case, generations) for _ in range(case.chance.randint(1, 2))]
        generations += descend(process.pid)  # processes that have begun since the first list
        pids = {pid for generation in generations for pid in generation}
        self.wait(case, process, sent)
        kill(pid for generation in descend(process.pid) for pid in generation)
        process.wait()
        case.expect(are_gone(pids), "processes are left after mpirun has ended")
        kill(pids)

    @staticmethod
    def send_one(case, generations):
        """Sends a signal to a process of a random generation. @return the process and the signal"""
        generation = case.chance.randrange(len(generations))
        victim = case.chance.choice(generations[generation])
        number = case.chance.choice(SIGNALS)
        who = GENERATIONS[min(generation, len(GENERATIONS) - 1)]
        case.note(f"{number.name} to {who}")
        send(victim, number)
        if number == signal.SIGSTOP:
            time.sleep(case.chance.uniform(0, 0.5))
            send(victim, signal.SIGCONT)
        return who, number

    @staticmethod
    def wait(case, process, sent):
        """Waits for the end of a process. Unless the process was killed, it must end by itself with an exit code of
        docs/reference/exit-codes.md."""
        is_killed = any(number == signal.SIGKILL for _, number in sent)
        try:
            code = process.wait(timeout=PATIENCE) if is_killed else wait_for(process.pid, process.wait)
        except subprocess.TimeoutExpired:
            return
        except Hung as hung:
            case.findings.append(f"a sweep after {sent}: {hung}")
            return
        if len(sent) == 1 and sent[0][0] == "mpirun":
            number = sent[0][1]
            case.expect(code in CODES_OF_MPIRUN.get(number, {code}), f"mpirun: exit code {code} after {number.name}")
