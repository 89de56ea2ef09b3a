"""Checks that the version is the same in `CMakeLists.txt`, `CITATION.cff`, the Python module and the recipe for Spack,
and is the newest release in `CHANGELOG.md`. The dates in `CITATION.cff` and `CHANGELOG.md` must also agree. Checks that
the handbook's table of dependencies agrees with `cmake/dependencies.txt`.

    tests/lint/versions.py ROOT
"""

import pathlib
import re
import sys

NUMBER = r"(\d+\.\d+\.\d+)"
DATE = r"(\d{4}-\d\d-\d\d)"
EXAMPLE = r"find_package\(clogsweep (\d+\.\d+) "
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
    """The first match of a pattern in a file, or None. The first match in the changelog belongs to the newest
    release."""
    found = re.search(pattern, (root / file).read_text(), re.MULTILINE)
    return found.group(1) if found else None


def faults(root):
    example = "docs/examples/own-program/CMakeLists.txt"
    if not first(root, "CMakeLists.txt", WRITTEN["version"]["CMakeLists.txt"]).startswith(f"{first(root, example, EXAMPLE)}."):
        yield f"{example}: asks for another version than that of CMakeLists.txt"
    for what, places in WRITTEN.items():
        values = {file: first(root, file, pattern) for file, pattern in places.items()}
        for file, value in values.items():
            if value is None:
                yield f"{file}: there is no {what} as {places[file]}"
        if len(set(values.values()) - {None}) > 1:
            yield f"the {what} is not the same: " + ", ".join(f"{value} in {file}" for file, value in values.items())


def table_of_dependencies(text):
    """The rows of the handbook's table that follow from the lines of cmake/dependencies.txt."""
    for line in text.splitlines():
        if line[:1].isalpha():
            name, minimum, *packages = line.split()
            yield " ".join(["|", name, "|", minimum, "|", ", ".join(f"`{package}`" for package in packages if package != "-"), "|"]).replace("  ", " ")


def faults_of_dependencies(root):
    rows = list(table_of_dependencies((root / "cmake/dependencies.txt").read_text()))
    page = "docs/developer/build.md"
    section = (root / page).read_text().partition("\n## Dependencies\n")[2]
    written = [line for line in section.splitlines() if line.startswith("| ") and not line.startswith("| dependency ")]
    for row in rows:
        if row not in written:
            yield f"{page}: cmake/dependencies.txt has, and the table has not: {row}"
    for row in written:
        if row not in rows:
            yield f"{page}: the table has, and cmake/dependencies.txt has not: {row}"


def main(root):
    found = [*faults(pathlib.Path(root)), *faults_of_dependencies(pathlib.Path(root))]
    print("\n".join(found) or "versions are the same everywhere")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
