#!/usr/bin/python3
"""Tests that a new parameter needs only a member of RunParameters, an entry in core/parameters/schema.cpp, and its
physics. The patch quiet_checks.patch adds such a parameter.

    tests/newcomer/add_parameter.py            # applies the patch to a copy, builds it, and searches for the parameter
    tests/newcomer/add_parameter.py --check    # only checks that the patch still fits, which takes no time

Building the copy without optimisation takes some minutes. Exit code 1: the parameter is missing somewhere.
"""

import argparse
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
PATCH = pathlib.Path(__file__).with_name("quiet_checks.patch")
SWEEP = ["model=sp", "wall-stiffness=30", "box=20", "obstacle-density=saturated",
         "seeds=1..2", "max-time=300", "clog-detection=threshold", "quiet-checks=1,50"]


def output(*command, **options):
    return subprocess.run([str(word) for word in command], check=True, capture_output=True, text=True, **options).stdout


def copy_of_tree(folder):
    """Copies all files that git does not ignore, with uncommitted changes, and applies the patch."""
    for name in output("git", "ls-files", "--cached", "--others", "--exclude-standard", cwd=ROOT).splitlines():
        if (ROOT / name).is_file():
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(ROOT / name, folder / name)
    subprocess.run(["git", "apply", PATCH], cwd=folder, check=True)


def build(folder):
    subprocess.run(["cmake", "-S", folder, "-B", folder / "build", "-G", "Ninja",
                    "-DCMAKE_BUILD_TYPE=Debug", "-DCMAKE_CXX_FLAGS=-O0",
                    "-DCLOG_TESTS=OFF", "-DCLOG_BENCHMARKS=OFF"], check=True, stdout=subprocess.DEVNULL)
    subprocess.run(["cmake", "--build", folder / "build", "--target", "clogsweep", "clogfit"], check=True)
    return folder / "build" / "bin"


def findings(programs, folder):
    """Names the places where the parameter is missing."""
    schema = json.loads(output(programs / "clogsweep", "--schema"))
    yield "a key", any(key["key"] == "quiet-checks" and key["range"] == "at least 1, at most 1000"
                       for key in schema["keys"])
    yield "a column", any(column["name"] == "quiet_checks" for column in schema["columns"])
    refused = subprocess.run([programs / "clogsweep", *SWEEP[:-1], "quiet-checks=0", "--dry-run"],
                             capture_output=True, text=True)
    yield "a check with a remedy", refused.returncode == 2 and "use 1..1000" in refused.stderr
    listed = output(programs / "clogsweep", *SWEEP, "--dry-run").splitlines()
    yield "a place in a dry run", listed[0].split()[2:] == ["seed", "quiet_checks"] and [line.split()[2] for line in listed[1:3]] == ["1", "50"]
    subprocess.run([programs / "clogsweep", *SWEEP, "--quiet", "--output", "s.h5"], cwd=folder, check=True)
    fit = json.loads(output(programs / "clogfit", "s.h5", "--format", "json", cwd=folder))
    yield "groups of its own", sorted(group["quiet_checks"] for group in fit["groups"]) == [1, 50]
    text = output(programs / "clogfit", "s.h5", cwd=folder)
    yield "a column of the fit", "quiet_checks" in text
    picture = subprocess.run(["/usr/bin/python3", "-m", "clogsweep", "clogging-length", "s.h5", "--programs", programs],
                             cwd=folder, env={**os.environ, "PYTHONPATH": str(ROOT / "analysis")})
    yield "a curve", picture.returncode == 0 and (folder / "s-clogging-length.png").exists()
    tables = subprocess.run(["/usr/bin/python3", folder / "tests/lint/schema_tables.py",
                             programs / "clogsweep", folder], capture_output=True)
    yield "a demand for documentation", tables.returncode == 1
    subprocess.run(["/usr/bin/python3", folder / "tests/lint/schema_tables.py", programs / "clogsweep",
                    folder, "--write"], check=True)
    yield "documentation", "\n`quiet-checks` (`2`; " in (folder / "docs/reference/keys.md").read_text()
    verified = subprocess.run([programs / "clogsweep", "replay", "s.h5", "1"], cwd=folder,
                              capture_output=True, text=True)
    yield "a replay", verified.returncode == 0


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--check", action="store_true", help="only: does the patch fit?")
    if parser.parse_args().check:
        return subprocess.run(["git", "apply", "--check", PATCH], cwd=ROOT).returncode
    print(output("git", "apply", "--stat", PATCH, cwd=ROOT))
    with tempfile.TemporaryDirectory(prefix="clog_newcomer_") as place:
        folder = pathlib.Path(place)
        copy_of_tree(folder)
        all_findings = list(findings(build(folder), folder))
    for what, is_there in all_findings:
        print(f"{what}: {'yes' if is_there else 'MISSING'}")
    return 0 if all(is_there for _, is_there in all_findings) else 1


if __name__ == "__main__":
    sys.exit(main())
