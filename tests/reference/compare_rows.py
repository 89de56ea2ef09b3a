#!/usr/bin/python3
"""Do two builds give the same rows, bit for bit?

    tests/reference/compare_rows.py BEFORE AFTER        (folders of the programs)

A set of small runs goes through both: either model, every preset, layout and instruction set of this processor,
user-supplied circles, a channel, a wall, a sweep that is interrupted and resumed. Every column that both have must be the same, but for those
that tell of the circumstances of a run; every number of a trajectory, too. Exit code 1: something differs.
"""

import argparse
import pathlib
import signal
import subprocess
import sys
import tempfile
import time

import h5py

CIRCUMSTANCES = {"wall_seconds", "processor_seconds", "rank", "host", "attempt"}
SATURATED = "obstacle-density=saturated"  # the default of versions to compare with differs
DILUTE = ["box=20", "max-time=40", "vertices=64", "seeds=3..4"]
SMALL = [*DILUTE, SATURATED]
# Name, arguments of clogsweep.
SWEEPS = {
    **{preset: [*SMALL, f"preset={preset}", "line-tension=0.1,1"] for preset in ("robust", "heavy-interface", "elastic", "literal")},
    **{f"robust-{name}": [*SMALL, "line-tension=0.1,1", f"--instruction-set={name}"] for name in ("baseline", "avx2", "avx512")},
    "many-vertices": [SATURATED, "box=20", "max-time=10", "vertices=256", "seeds=1"],
    "soft-disk": [SATURATED, "model=sp", "wall-stiffness=0.5,5", "box=20", "max-time=100", "seeds=1..3"],
    "lattice": ["obstacle-layout=lattice", "lattice-angle=10", "obstacle-gap=0.8", "box=60", "max-time=40", "vertices=64", "seeds=3..4"],
    "dilute": [*DILUTE, "obstacle-density=0.5", "boxes=3", "obstacle-gap=0.3"],
    "mixture": [*SMALL, "obstacle-diameter-spread=0.3", "obstacle-gap=0.4"],
    "near-wall": [*SMALL, "near-wall-drag=0.07", "relative-drag=0.5", "wall-tension=0.6"],
    "threshold": [*SMALL, "clog-detection=threshold", "clog-energy=1e-5", "line-tension=3"],
    "large-array": [SATURATED, "box=200", "max-time=5", "vertices=64", "seeds=1"],
}
RUNS = {
    "channel": ["channel", "orifice=0.7", "start=-1.5", "end=1", "vertices=64", "line-tension=1"],
    "flat-channel": ["channel", "wedge-angle=0", "orifice=1.2", "start=-1", "end=0.5", "vertices=64"],
    "wall": ["sag", "vertices=64", "line-tension=1"],
    "own-circles": ["array", "--obstacles=own.csv", "box=10", "max-time=30", "vertices=64"],
}
OWN_CIRCLES = "x,y,diameter\n2,5,0.5\n3.2,4.4,0.3\n3.4,5.9,0.4\n5,5.1,0.6\n7,4.2,0.3\n8.5,6.4,1\n"
INTERRUPTED = [SATURATED, "box=20", "max-time=2000", "vertices=64", "seeds=1..4", "line-tension=0.1", "obstacle-gap=0.6"]


def is_possible(programs, name):
    """False for a sweep with an instruction set that this processor lacks."""
    command = [programs / "clogsweep", *SWEEPS.get(name, []), "--print-config"]
    return "--instruction-set" not in "".join(SWEEPS.get(name, [])) or subprocess.run(command, capture_output=True).returncode == 0


def sweep(programs, name, folder):
    path = folder / f"{name}.h5"
    subprocess.run([programs / "clogsweep", *SWEEPS[name], "--quiet", "--output", path], check=True, cwd=folder)
    return path


def run(programs, name, folder):
    path = folder / f"{name}.h5"
    subprocess.run([programs / "clogrun", *RUNS[name], "--output", path], check=True, cwd=folder, capture_output=True)
    return path


def interrupted(programs, folder):
    path = folder / "interrupted.h5"
    command = [programs / "clogsweep", *INTERRUPTED, "--quiet", "--output", path]
    for _ in range(3):
        process = subprocess.Popen(command, cwd=folder)
        time.sleep(2)
        process.send_signal(signal.SIGTERM)
        if process.wait() == 0:
            break
    subprocess.run(command, check=True, cwd=folder)
    return path


def differences(before, after):
    """Names of what differs between two files."""
    with h5py.File(before) as one, h5py.File(after) as two:
        rows = [file["runs"][...] for file in (one, two)]
        if len(rows[0]) != len(rows[1]):
            yield "number of rows"
            return
        for column in rows[0].dtype.names:
            if column in CIRCUMSTANCES or column not in rows[1].dtype.names:
                continue
            if rows[0][column].tobytes() != rows[1][column].tobytes():
                yield column
        for name in ("trajectory", "polygons", "obstacles", "wedges"):
            if (name in one) != (name in two):
                yield name
            elif name in one:
                before, after = one[name][...], two[name][...]
                columns = [column for column in before.dtype.names or () if column in after.dtype.names]
                pairs = [(before[column], after[column]) for column in columns] or [(before, after)]
                if any(a.tobytes() != b.tobytes() for a, b in pairs):
                    yield name


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("before", type=pathlib.Path)
    parser.add_argument("after", type=pathlib.Path)
    arguments = parser.parse_args()
    cases = [*((name, sweep) for name in SWEEPS), *((name, run) for name in RUNS), ("interrupted", None)]
    num_differing = 0
    with tempfile.TemporaryDirectory(prefix="clog_reference_") as place:
        for name, make in cases:
            if not is_possible(arguments.before.resolve(), name):
                print(f"{name}: left out, this processor lacks it", flush=True)
                continue
            paths = []
            for which in ("before", "after"):
                folder = pathlib.Path(place) / which
                folder.mkdir(exist_ok=True)
                (folder / "own.csv").write_text(OWN_CIRCLES)
                programs = getattr(arguments, which).resolve()
                paths.append(make(programs, name, folder) if make else interrupted(programs, folder))
            found = list(differences(*paths))
            num_differing += bool(found)
            print(f"{name}: {'differs in ' + ', '.join(found) if found else 'same bits'}", flush=True)
    print(f"{len(cases)} cases, {num_differing} differ")
    return 1 if num_differing else 0


if __name__ == "__main__":
    sys.exit(main())
