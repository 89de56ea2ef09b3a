"""Standard input, output and error of every command are closed, full, or have no reader."""

import os
import shutil

from launch import EXIT_CODES, READER_GONE, quoted, run
from samples import FILE, Sample, check_complete, in_child, stored_rows

PROFILE = "h [sigma], v [v_t], A\n-1,1,1\n-0.5,0.9,1.02\n0,0.5,1.1\n0.5,0.7,1.05\n1,1,1\n"
WALL = "d [sigma], v [v_t]\n0.01,0.2\n0.1,0.5\n0.3,0.7\n1,0.9\n"
SHORT = ["vertices=64", "box=20", "obstacle-density=saturated", "max-time=1", "obstacle-gap=0.4"]
REPORTS = [
    ["clogsweep", "--help"], ["clogsweep", "--version"], ["clogsweep", "--print-config"],
    ["clogsweep", *SHORT, "--dry-run"], ["clogsweep", "status", FILE],
    ["clogsweep", "status", FILE, "--format", "json"],
    ["clogsweep", "verify", FILE], ["clogsweep", "replay", FILE, "0"], ["clogsweep", "doctor"],
    ["clogfit", FILE], ["clogfit", FILE, "--format", "csv"], ["clogfit", FILE, "--format", "json"],
    ["clogfit", "--help"], ["clogfit", "curve", "--help"],
    ["clogfit", "deviation", "p.csv", "p.csv"], ["clogfit", "drag", "d.csv"], ["clogfit", "report", "--help"],
    ["clogrun", "sag", "vertices=64", "line-tension=1"], ["clogrun", "--version"], ["clogsweep", "no-such-word"],
]
TRAJECTORIES = [["clogrun", "array", *SHORT, "--output", "r.h5"],
                ["clogrun", "channel", "vertices=32", "max-time=1", "--start=-1", "--output", "r.h5"]]
CHANGING = {"doctor", "replay", "--dry-run"}  # what these print holds times
NAMES = ["stdin", "stdout", "stderr"]


class Streams:
    """What stdin, stdout and stderr of a program are: usual, closed, full, or gone (nobody reads)."""

    def __init__(self, states):
        self.states = states
        self.files = []

    def __enter__(self):
        return {name: self.open(state) for name, state in self.states.items() if state in ("full", "gone")}

    def __exit__(self, *_):
        for descriptor in self.files:
            os.close(descriptor)

    def open(self, state):
        if state == "full":
            descriptor = os.open("/dev/full", os.O_RDWR)
        else:
            reader, descriptor = os.pipe()
            os.close(reader)
        self.files.append(descriptor)
        return descriptor

    def close_those_closed(self):
        """To be called in the new process."""
        for number, name in enumerate(NAMES):
            if self.states[name] == "closed":
                os.close(number)


class Faults:
    def __init__(self, folder):
        self.sample = Sample("disks", folder)

    def try_one(self, case):
        shutil.copy(self.sample.path, case.folder)
        (case.folder / "p.csv").write_text(PROFILE)
        (case.folder / "d.csv").write_text(WALL)
        case.chance.choice([self.report, self.report, self.trajectory, self.sweep])(case)

    def run(self, case, words):
        """@return the outcome, and the states of the streams"""
        states = {name: case.chance.choice(["usual", "closed", *([] if name == "stdin" else ["full", "gone"])])
                  for name in NAMES}
        shown = ", ".join(f"{name} {state}" for name, state in states.items() if state != "usual")
        case.note(f"{quoted(words)}: {shown or 'as usual'}")
        streams = Streams(states)
        codes = EXIT_CODES | ({READER_GONE} if states["stdout"] == "gone" else set())
        with streams as opened:
            return run(case, *words, prepare=streams.close_those_closed, exit_codes=codes, **opened), states

    def report(self, case):
        words = case.chance.choice(REPORTS)
        usual = run(case, *words)
        outcome, states = self.run(case, words)
        if not outcome.is_over:
            return
        if states["stdout"] == "full" and usual.output:
            case.expect(outcome.code == 2, f"{outcome.name}: exit code {outcome.code} though its output is lost")
        elif states["stdout"] != "gone":
            case.expect(outcome.code == usual.code,
                        f"{outcome.name}: exit code {outcome.code} instead of {usual.code}")
        if states["stdout"] == "usual" and not CHANGING & set(words):
            case.expect(outcome.output == usual.output, f"{outcome.name}: prints something else than usual")

    def trajectory(self, case):
        words = case.chance.choice(TRAJECTORIES)
        outcome, states = self.run(case, words)
        if outcome.is_over and states["stdout"] in ("usual", "closed"):
            case.expect(outcome.code == 0, f"{outcome.name}: exit code {outcome.code}")
        if outcome.code == 0:
            row, _ = in_child(stored_rows, case.folder / "r.h5")
            case.expect(row is not None, f"{outcome.name}: leaves a file that cannot be read, exit code 0")

    def sweep(self, case):
        """Nobody has to listen to a sweep; its table is whole all the same."""
        (case.folder / FILE).unlink()
        outcome, _ = self.run(case, ["clogsweep", *self.sample.sweep])
        case.expect(outcome.code == 0 or not outcome.is_over, f"{outcome.name}: a sweep ends with {outcome.code}")
        check_complete(case, case.folder / FILE, self.sample.rows)
