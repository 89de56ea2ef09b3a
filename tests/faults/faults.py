#!/usr/bin/python3
"""Injects faults into the programs, one after the other, and reports those that a program handled wrongly.

    tests/faults/faults.py bits --count 200 --seed 1 --bin build/release/bin

Exit code 0: the programs handled all faults. Exit code 1: some faults were handled wrongly. For each of these, the
command that repeats it is printed.
"""

import argparse
import collections
import importlib
import os
import pathlib
import random
import shutil
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
KINDS = {
    "bits": "a flipped bit of a finished sweep's file",
    "metadata": "damage to what describes a sweep's file, or to its journal",
    "disk": "a full disk, or too little memory",
    "kills": "signals to a sweep's processes",
    "journals": "journals of other sweeps, and with impossible rows and snapshots",
    "attributes": "one damaged attribute of a sweep's file",
    "calls": "command lines and files with mistakes",
}


class Case:
    """One fault, with its description and the wrong reactions of the programs."""

    def __init__(self, chance, folder):
        self.chance = chance
        self.folder = folder
        self.done = []
        self.findings = []

    def note(self, deed):
        self.done.append(deed)

    def expect(self, holds, finding):
        if not holds:
            self.findings.append(finding)


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("kind", choices=KINDS, help="; ".join(f"{kind}: {what}" for kind, what in KINDS.items()))
    parser.add_argument("--count", type=int, default=30, help="number of cases (30)")
    parser.add_argument("--seed", type=int, default=1, help="of the cases (1)")
    parser.add_argument("--case", type=int, help="only the case of this number; its folder is kept")
    parser.add_argument("--bin", type=pathlib.Path, default=ROOT / "build" / "release" / "bin",
                        help="folder of the programs (build/release/bin)")
    return parser.parse_args()


def try_case(faults, options, number):
    folder = pathlib.Path(tempfile.mkdtemp(prefix=f"clog_{options.kind}_{number}_"))
    case = Case(random.Random(f"{options.kind} {options.seed} {number}"), folder)
    try:
        faults.try_one(case)
    finally:
        if options.case is None:
            shutil.rmtree(folder)
        else:
            print(f"the case's folder: {folder}")
    return case


def report(case, options, number):
    print(f"{options.kind} {number}: {'; '.join(case.done)}")
    for finding in case.findings:
        print(f"    {finding}")
    print(f"    repeat: tests/faults/faults.py {options.kind} --seed {options.seed} --case {number} "
          f"--bin {options.bin}", flush=True)


def main():
    options = arguments()
    # tests/programs/support.py looks for the programs in this folder.
    os.environ["CLOG_BIN"] = str(options.bin.resolve())
    sys.path[:0] = [str(ROOT / "tests" / "programs"), str(ROOT / "analysis")]
    numbers = range(options.count) if options.case is None else [options.case]
    found = collections.Counter()
    num_bad = 0
    with tempfile.TemporaryDirectory(prefix="clog_faults_") as shared:
        faults = importlib.import_module(options.kind).Faults(pathlib.Path(shared))
        for number in numbers:
            case = try_case(faults, options, number)
            if case.findings:
                report(case, options, number)
                num_bad += 1
                found.update(set(case.findings))
    print(f"{options.kind}, seed {options.seed}: {len(numbers)} cases, {num_bad} with findings")
    for finding, count in found.most_common():
        print(f"{count:6d}  {finding}")
    return 1 if num_bad else 0


if __name__ == "__main__":
    sys.exit(main())
