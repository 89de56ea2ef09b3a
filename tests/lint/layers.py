"""A room includes the rooms that its line in docs/explanation/architecture.md names, and no others; some libraries belong
to one room, fmt to no header.

The rooms inside core have lines of their own: core/world and so on. Rooms of the Python package are its folders, in a
table of their own; an import inside a function counts, too. Neither rooms nor Python files form a circle.

    tests/lint/layers.py ROOT
"""

import ast
import collections
import graphlib
import pathlib
import re
import sys

PAGE = "docs/explanation/architecture.md"
OWN_LIBRARY = {"mpi.h": "parallel", "hdf5.h": "store", "boost/program_options.hpp": "cli"}
PACKAGE = pathlib.Path("analysis/clogsweep")
PYTHON_SECTION = "\n## Rooms of the Python package\n"
DRAWING = {"style", "drawing", "pages", "paper"}
PYTHON_LIBRARIES = {"h5py": {"reading"}, "matplotlib": DRAWING, "mpl_toolkits": DRAWING, "PIL": DRAWING}


def table(text):
    """The rooms that each room uses, from a part of the page."""
    rooms = {}
    for line in text.splitlines():
        cells = [cell.strip() for cell in line.strip("|").split("|")]
        if line.startswith("| `") and len(cells) == 3:
            rooms[cells[0].strip("`")] = cells[2]
    return {room: set(rooms) if uses == "all" else set(re.findall(r"`([\w/]+)`", uses)) for room, uses in rooms.items()}


def room_of(parts, rooms):
    """The room of a file. @param parts  its folders below include/clog or src"""
    inner = "/".join(parts[:2])
    return inner if inner in rooms else parts[0]


def includes(root, rooms):
    """File, line, room and what is included."""
    for base in (root / "include" / "clog", root / "src"):
        for path in sorted(base.rglob("*.?pp")):
            for number, line in enumerate(path.read_text().splitlines(), 1):
                include = re.match(r'\s*#include [<"]([^>"]+)[>"]', line)
                if include:
                    yield path.relative_to(root), number, room_of(path.relative_to(base).parts, rooms), include.group(1)


def circle_of(uses):
    """Names that lead back to the first, or none. @param uses  names by name"""
    try:
        graphlib.TopologicalSorter(uses).prepare()
    except graphlib.CycleError as error:
        return error.args[1][::-1]
    return []


def cpp_faults(root, uses):
    used = collections.defaultdict(set)
    for path, number, room, target in includes(root, uses):
        if room not in uses:
            yield f"{path}: the room {room} is not in {PAGE}"
            continue
        if target.startswith("clog/") or target.startswith("core/"):
            other = room_of(target.removeprefix("clog/").split("/"), uses)
            if not room.startswith("core/"):
                other = other.split("/")[0]
            if other != room:
                used[room].add(other)
                if other not in uses[room]:
                    yield f"{path}:{number}: {room} must not use {target}"
        owner = OWN_LIBRARY.get(target)
        if owner not in (None, room) and not (room == "programs" and owner == "cli"):
            yield f"{path}:{number}: only {owner} includes <{target}>"
        if target.startswith("fmt/") and path.suffix == ".hpp":
            yield f"{path}:{number}: no header includes <{target}>: it takes long to compile"
    for room in uses.keys() - {"core"}:
        for other in sorted(uses[room] - used[room] - {"programs", room}):
            if room != "programs":
                yield f"{PAGE}: {room} does not use {other}"
        if not (root / "src" / room).is_dir():
            yield f"{PAGE}: there is no room {room}"


def file_of(base, parts):
    """The file of a module, below the package. None: it is not there"""
    folder = pathlib.Path(*parts)
    return next((place for place in (folder.with_suffix(".py") if parts else folder, folder / "__init__.py") if (base / place).is_file()), None)


def imports(base, path):
    """Line, module and file of all that a Python file imports. A file that is no part of the package is None."""
    for node in ast.walk(ast.parse((base / path).read_text())):
        if isinstance(node, ast.Import):
            yield from ((node.lineno, name.name, None) for name in node.names)
        elif isinstance(node, ast.ImportFrom):
            module = (node.module or "").split(".") if node.module else []
            if node.level == 0:
                yield node.lineno, node.module, None
                continue
            parts = [*path.parts[:len(path.parts) - node.level], *module]
            for name in node.names:
                yield node.lineno, ".".join(parts), file_of(base, [*parts, name.name]) or file_of(base, parts)


def python_faults(root, uses):
    base = root / PACKAGE
    paths = [path.relative_to(base) for path in sorted(base.rglob("*.py"))]
    used, files = collections.defaultdict(set), {}
    for path in paths:
        room = path.parts[0] if len(path.parts) > 1 else None
        if (room or path.stem) not in {*uses, "__init__", "__main__"}:
            yield f"{PACKAGE / path}: the room {room} is not in {PAGE}" if room else f"{PACKAGE / path}: lies in no room"
            continue
        files[path] = set()
        for line, module, target in imports(base, path):
            library = module.split(".")[0]
            if target is None:
                if room not in PYTHON_LIBRARIES.get(library, {room}):
                    yield f"{PACKAGE / path}:{line}: {room} must not import {library}"
                if library == PACKAGE.name:
                    yield f"{PACKAGE / path}:{line}: imports {module} as a stranger does"
                continue
            files[path].add(target)
            other = target.parts[0]
            if room not in (None, other):
                used[room].add(other)
                if other not in uses[room]:
                    yield f"{PACKAGE / path}:{line}: {room} must not use {target}"
    if circle := circle_of(files):
        yield f"{PACKAGE}: imports form a circle: {' -> '.join(map(str, circle))}"
    for room in uses:
        for other in sorted(uses[room] - used[room] - {room}):
            yield f"{PAGE}: {room} does not use {other}"
        if not (base / room).is_dir():
            yield f"{PAGE}: there is no room {room}"


def faults(root):
    text, _, rest = (root / PAGE).read_text().partition(PYTHON_SECTION)
    python, heading, after = rest.partition("\n## ")
    cpp_rooms, python_rooms = table(text + heading + after), table(python)
    for rooms in (cpp_rooms, python_rooms):
        if circle := circle_of({room: others - {room} for room, others in rooms.items()}):
            yield f"{PAGE}: rooms form a circle: {' -> '.join(circle)}"
    yield from cpp_faults(root, cpp_rooms)
    yield from python_faults(root, python_rooms)


found = list(faults(pathlib.Path(sys.argv[1])))
print("\n".join(found) or "layers are clean")
sys.exit(bool(found))
