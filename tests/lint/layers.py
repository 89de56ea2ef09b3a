"""A room includes the rooms that its line in docs/explanation/architecture.md names, and no others; some libraries belong
to one room, fmt to no header.

The rooms inside core have lines of their own: core/world and so on.

    tests/lint/layers.py ROOT
"""

import collections
import pathlib
import re
import sys

PAGE = "docs/explanation/architecture.md"
OWN_LIBRARY = {"mpi.h": "parallel", "hdf5.h": "store", "boost/program_options.hpp": "cli"}


def table(root):
    """What each room uses, by the page."""
    rooms = {}
    for line in (root / PAGE).read_text().splitlines():
        cells = [cell.strip() for cell in line.strip("|").split("|")]
        if line.startswith("| `") and len(cells) == 3:
            rooms[cells[0].strip("`")] = cells[2]
    return {room: set(rooms) if uses == "all" else set(re.findall(r"`([\w/]+)`", uses)) for room, uses in rooms.items()}


def room_of(parts, rooms):
    """Of the folders of a file, below include/clog or src."""
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


def faults(root):
    uses = table(root)
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


found = list(faults(pathlib.Path(sys.argv[1])))
print("\n".join(found) or "layers are clean")
sys.exit(bool(found))
