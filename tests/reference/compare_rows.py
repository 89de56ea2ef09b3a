#!/usr/bin/python3
"""Compares the files that two builds write, bit for bit.

    tests/reference/compare_rows.py BEFORE AFTER        (folders of the programs)

In each case both builds make the same small run. Everything in the two files must be the same: datasets, columns, and
attributes with their units and meanings. Only the circumstances of a run may differ. Every key of AFTER's schema has a
value other than its default in at least one case, and every word of every key is used. Exit code 1: something differs,
or no case covers a key.
"""

import argparse
import collections
import json
import pathlib
import shlex
import signal
import subprocess
import sys
import tempfile
import time

import h5py
import numpy as np

# The comparison leaves out these columns, these attributes of the root ("@"), and the checksums of rows.
CIRCUMSTANCES = {*(f"runs/{name}" for name in ("wall_seconds", "processor_seconds", "rank", "host", "attempt")), "row_checksums",
                 *(f"@{name}" for name in ("version", "git_describe", "git_hash", "compiler", "mpi_version", "hdf5_version", "checksums",
                                           "start_time", "command_line", "sessions", "activity", "parts"))}
INPUTS = {"own.csv": "x,y,diameter\n2,5,0.5\n3.2,4.4,0.3\n3.4,5.9,0.4\n5,5.1,0.6\n7,4.2,0.3\n8.5,6.4,1\n",
          "points.csv": "line-tension,obstacle-gap\n0.1,0.3\n1,0.6\n"}
# Dense arrays, in which the droplet soon meets obstacles.
ARRAY = "clogsweep box=20 vertices=64 seeds=3..4 obstacle-density=saturated"
SWEEP = f"{ARRAY} max-time=40"
DEVICE = "clogsweep obstacles=own.csv obstacle-layout=file box=10 vertices=64 seeds=1..2"
CHANNEL = "vertices=64 start=-1.5 end=1"
TENSIONS = f"{SWEEP} line-tension=0.1,1"
CASES = {
    **{f"preset-{name}": f"{TENSIONS} preset={name}" for name in ("robust", "heavy-interface", "elastic", "literal")},
    **{f"instructions-{name}": f"{TENSIONS} --instruction-set={name}" for name in ("baseline", "avx2", "avx512")},
    "vertices": "clogsweep box=20 max-time=10 vertices=256 seeds=1 obstacle-density=saturated",
    "soft-disk": "clogsweep model=sp wall-stiffness=0.5,5 dwell-length=0.05,0.5 box=20 max-time=1000 seeds=1..3 obstacle-density=0.5",
    "lattice": "clogsweep obstacle-layout=lattice lattice-angle=10 obstacle-gap=0.8 box=60 max-time=40 vertices=64 seeds=3..4",
    "lattices": "clogsweep obstacle-layout=lattice lattice=triangular,rhombic pitch=1.2 lattice-angle=0 box=30 max-time=40 vertices=64 seeds=3",
    "dilute": "clogsweep box=20 max-time=40 vertices=64 seeds=3..4 obstacle-density=0.5 boxes=3 obstacle-gap=0.3",
    "mixture": f"{SWEEP} obstacle-diameter=0.4 obstacle-diameter-spread=0.3 obstacle-gap=0.4 dwell-length=0.1",
    "large-array": "clogsweep box=200 max-time=5 vertices=64 seeds=1 obstacle-density=saturated",
    "drag": f"{SWEEP} terminal-speed=0.05 near-wall-drag=0.07 near-wall-exponent=1 near-wall-cutoff=0.01 relative-drag=0.5",
    "numerics": f"{ARRAY} max-time=10 inertia=4 time-step=4e-4 area-stiffness=5000 wall-stiffness=50 wall-contact=vertex,edge",
    "springs": f"{SWEEP} perimeter-spring=along,mean perimeter-stiffness=0.2 contact-range=0.01",
    "rest-springs": f"{SWEEP} perimeter-spring=rest perimeter-stiffness-ratio=0.1 contact-range=half-vertex gravity=area,vertex",
    "contact-angles": f"{SWEEP} wall-tension=0.6 receding-angle=100 advancing-angle=150 line-tension=0.3",
    "dry-friction": f"{SWEEP} preset=elastic friction=0.2 film-friction=on,off line-tension=0.1",
    "yield-traction": f"{SWEEP} preset=elastic yield-traction=0.1 self-contact=on,off line-tension=0.1",
    # This droplet folds around an obstacle and clogs.
    "film-friction": "clogsweep preset=elastic friction=0.2 obstacle-gap=0.3 line-tension=0.05 self-contact-range=0.03 "
                     "box=20 max-time=1000 vertices=64 seeds=3 obstacle-density=saturated",
    "break-up": f"{ARRAY} break-up-neck=0.3 line-tension=0.05 obstacle-gap=0.4 max-time=200",
    "daughters": f"{ARRAY} break-up=daughters break-up-neck=0.08 smallest-daughter=0.4 speed-exponent=1 "
                 "line-tension=0.05 self-contact-range=0.02 obstacle-gap=0.4 max-time=300",
    "verdict": f"{SWEEP} clog-detection=threshold,certified clog-energy=1e-5 line-tension=3",
    "own-circles": f"{DEVICE} max-time=40 release=anywhere length=12",
    "side-walls": f"{DEVICE} max-time=150 side-walls=on release=entrance entrance=1 entrance-from=3 entrance-to=7 exit=4",
    "laboratory": f"{SWEEP} laboratory='angle = 20 deg; diameter = 1 mm; speed = 1 mm/s'",
    "wall": "clogsweep obstacle-layout=wall vertices=64 line-tension=1,3",
    "channel": f"clogsweep obstacle-layout=channel {CHANNEL} orifice=0.8 wedge-angle=30 tip-radius=0.05",
    "points": f"{SWEEP} --points points.csv",
    "until-precision": "clogsweep box=20 max-time=100 vertices=64 seeds=1..2 line-tension=3 obstacle-density=saturated "
                       "--until-precision 10% --most-seeds 4",
    "merge": f"{TENSIONS} --shard 1/2 --output one.h5\n{TENSIONS} --shard 2/2 --output two.h5\nclogsweep merge one.h5 two.h5",
    "select": f"{TENSIONS} --output all.h5\nclogsweep select all.h5 line_tension=1",
    "replay": f"{SWEEP} --output rows.h5\nclogrun replay rows.h5 1 --polygon-interval 5",
    "run-channel": f"clogrun channel {CHANNEL} orifice=0.7 --polygon-interval 5",
    "run-flat-channel": "clogrun channel vertices=64 wedge-angle=0 orifice=1.2 start=-1 end=0.5",
    "run-wall": "clogrun sag vertices=64 line-tension=1",
    "run-own-circles": "clogrun array obstacles=own.csv box=10 max-time=30 vertices=64 --polygon-interval 5",
    "run-soft-disk": "clogrun array model=sp wall-stiffness=1 box=20 max-time=30 obstacle-density=saturated --sample-interval 0.5",
    "interrupted": "clogsweep box=20 max-time=20000 vertices=64 seeds=1..4 line-tension=0.1 obstacle-gap=0.6 obstacle-density=saturated",
}


def uncovered(programs):
    """@return the keys that have their defaults in all cases, and the words of keys that no case uses"""
    given = collections.defaultdict(set)
    for word in shlex.split("\n".join(CASES.values())):
        key, _, values = word.partition("=")
        given[key].update(values.split(","))
    schema = json.loads(subprocess.run([programs / "clogsweep", "--schema"], check=True, capture_output=True).stdout)
    for key in schema["keys"]:
        name, usual = key["key"], {key["default"]}
        if not given[name] - usual:
            yield name
        yield from (f"{name}={word}" for word in sorted({*key["words"]} - usual - given[name]))


def interrupt(command, folder):
    """Stops the sweep up to three times. @return whether any stop came before the end"""
    for count in range(3):
        process = subprocess.Popen(command, cwd=folder, stderr=subprocess.DEVNULL)
        time.sleep(0.6)
        process.send_signal(signal.SIGTERM)
        if process.wait() != 75:
            return count > 0
    return True


def make(programs, name, folder):
    """Makes the run of a case. @return the path of its file"""
    folder.mkdir()
    for file, text in INPUTS.items():
        (folder / file).write_text(text)
    for line in CASES[name].splitlines():
        program, *words = shlex.split(line)
        command = [programs / program, *words, *([] if "--output" in words else ["--output", "case.h5"])]
        if name == "interrupted" and not interrupt(command, folder):
            raise RuntimeError("ended before it was stopped; give it a longer max-time")
        done = subprocess.run(command, cwd=folder, capture_output=True, text=True)
        if done.returncode:
            raise RuntimeError(f"{programs / program} failed: {done.stderr.strip()}")
    return folder / "case.h5"


def contents(path):
    """@return everything in a file by name, with its type, shape and bytes"""
    found = {}

    def add(name, value):
        array = np.asarray(value)
        found[name] = name in CIRCUMSTANCES or (array.dtype.str, array.shape, array.tobytes())

    def visit(name, node):
        for attribute, value in node.attrs.items():
            add(f"{name}@{attribute}", value)
        if isinstance(node, h5py.Dataset):
            data = node[...]
            found[f"{name}, shape and types"] = data.shape, str(data.dtype)
            for column in data.dtype.names or ():
                add(f"{name}/{column}", data[column])
            if not data.dtype.names:
                add(name, data)

    with h5py.File(path) as file:
        visit("", file)
        file.visititems(visit)
    return found


def differences(before, after):
    """The names of everything that differs between two files."""
    one, two = contents(before), contents(after)
    for name in sorted({*one, *two}):
        if name not in one or name not in two:
            yield f"{name} (only {'BEFORE' if name in one else 'AFTER'})"
        elif one[name] != two[name]:
            yield name


def compare(programs, name):
    """Compares a case. @return names of the differences, or of what failed"""
    with tempfile.TemporaryDirectory(prefix="clog_reference_") as place:
        try:
            paths = [make(folder, name, pathlib.Path(place) / which) for which, folder in programs.items()]
        except RuntimeError as error:
            return [str(error)]
        return list(differences(*paths))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("before", type=pathlib.Path)
    parser.add_argument("after", type=pathlib.Path)
    programs = {which: folder.resolve() for which, folder in vars(parser.parse_args()).items()}
    num_differing = 0
    for name in CASES:
        instructions = name.removeprefix("instructions-")
        test = [programs["before"] / "clogsweep", "--print-config", f"--instruction-set={instructions}"]
        if instructions != name and subprocess.run(test, capture_output=True).returncode:
            print(f"{name}: left out, this processor lacks it", flush=True)
            continue
        found = compare(programs, name)
        num_differing += bool(found)
        print(f"{name}: {'differs in ' + ', '.join(found) if found else 'same bits'}", flush=True)
    missing = list(uncovered(programs["after"]))
    print(f"{len(CASES)} cases, {num_differing} differ; not covered: {', '.join(missing) or 'no key'}")
    return 1 if num_differing or missing else 0


if __name__ == "__main__":
    sys.exit(main())
