#!/usr/bin/python3
"""Makes new seeds for the fuzz targets that read binary files. Run this script when a format changes.

    tests/faults/fuzz/make_corpus.py build/release/bin
"""

import pathlib
import shutil
import subprocess
import sys
import tempfile

CORPUS = pathlib.Path(__file__).parent / "corpus"
SOFT_DISK = ["model=sp", "wall-stiffness=1", "box=20", "obstacle-gap=1.2", "seeds=1"]


def main():
    clogsweep = pathlib.Path(sys.argv[1]).resolve() / "clogsweep"
    with tempfile.TemporaryDirectory() as folder:
        def sweep(*arguments):
            return subprocess.run([clogsweep, *SOFT_DISK, *arguments, "--quiet"], cwd=folder).returncode

        assert sweep("max-time=20", "--output", "complete") == 0
        assert sweep("max-time=2e5", "--max-hours=2e-4", "--output", "stopped") == 75
        shutil.copy(f"{folder}/complete", CORPUS / "sweep_file")
        shutil.copy(f"{folder}/stopped.journal", CORPUS / "journal" / "stopped")


if __name__ == "__main__":
    main()
