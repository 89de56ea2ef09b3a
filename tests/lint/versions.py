"""The version is the same wherever it is written: in `CMakeLists.txt`, in `CITATION.cff`, in the Python module, in the
recipe for Spack and, as the newest release, in `CHANGELOG.md`, which has the date of `CITATION.cff`, too.

    tests/lint/versions.py ROOT
"""

import pathlib
import re
import sys

NUMBER = r"(\d+\.\d+\.\d+)"
DATE = r"(\d{4}-\d\d-\d\d)"
WRITTEN = {
    "version": {
        "CMakeLists.txt": rf"^project\(clogsweep VERSION {NUMBER} ",
        "CITATION.cff": rf"^version: {NUMBER}$",
        "analysis/clogsweep/__init__.py": rf'^__version__ = "{NUMBER}"$',
        "CHANGELOG.md": rf"^## \[{NUMBER}\]",
        "cmake/spack/spack_repo/clogsweep/packages/clogsweep/package.py": rf'^    version\("{NUMBER}", tag="v\1"\)$',
    },
    "date": {
        "CITATION.cff": rf'^date-released: "{DATE}"$',
        "CHANGELOG.md": rf"^## \[{NUMBER[1:-1]}\] - {DATE}$",
    },
}


def first(root, file, pattern):
    """The newest release comes first in the changelog."""
    found = re.search(pattern, (root / file).read_text(), re.MULTILINE)
    return found.group(1) if found else None


def faults(root):
    for what, places in WRITTEN.items():
        values = {file: first(root, file, pattern) for file, pattern in places.items()}
        for file, value in values.items():
            if value is None:
                yield f"{file}: there is no {what} as {places[file]}"
        if len(set(values.values()) - {None}) > 1:
            yield f"the {what} is not the same: " + ", ".join(f"{value} in {file}" for file, value in values.items())


def main(root):
    found = list(faults(pathlib.Path(root)))
    print("\n".join(found) or "the version is the same everywhere")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
