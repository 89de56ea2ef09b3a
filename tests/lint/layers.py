"""Checks that each layer includes only the layers that its line in docs/developer/architecture.md names. Some libraries
may be included by only one layer. No header may include fmt.

The layers inside core have their own lines: core/world, core/polygon/step and so on. The modules of the Python package
are its folders, and another table of the page lists them. An import inside a function counts, too. Neither layers nor
Python files may include each other in a circle.

    tests/lint/layers.py ROOT
"""

import ast
import collections
import graphlib
import pathlib
import re
import sys

PAGE = "docs/developer/architecture.md"
OWN_LIBRARY = {"mpi.h": "scheduler", "hdf5.h": "store", "boost/program_options.hpp": "cli"}
PACKAGE = pathlib.Path("analysis/clogsweep")
PYTHON_SECTION = "\n## Modules of the Python package\n"
DRAWING = {"style", "drawing", "pages", "paper"}
PYTHON_LIBRARIES = {"h5py": {"reading"}, "matplotlib": DRAWING, "mpl_toolkits": DRAWING, "PIL": DRAWING}


def table(text):
    """The layers that each layer may use, read from a part of the page."""
    layers = {}
    for line in text.splitlines():
        cells = [cell.strip() for cell in line.strip("|").split("|")]
        if line.startswith("| `") and len(cells) == 3:
            layers[cells[0].strip("`")] = cells[2]
    return {layer: set(layers) if uses == "all" else set(re.findall(r"`([\w/]+)`", uses)) for layer, uses in layers.items()}


def layer_of(parts, layers):
    """The layer of a file. @param parts  the folders of the file below include/clog or src"""
    names = ("/".join(parts[:depth]) for depth in (3, 2))
    return next((name for name in names if name in layers), parts[0])


def includes(root, layers):
    """For every include: the file, the number of the line, the layer of the file, and the included layer."""
    for base in (root / "include" / "clog", root / "src"):
        for path in sorted(base.rglob("*.?pp")):
            for number, line in enumerate(path.read_text().splitlines(), 1):
                include = re.match(r'\s*#include [<"]([^>"]+)[>"]', line)
                if include:
                    yield path.relative_to(root), number, layer_of(path.relative_to(base).parts, layers), include.group(1)


def circle_of(uses):
    """A circle of names in which each name uses the next one, or nothing if there is no circle. @param uses  the names
    that each name uses"""
    try:
        graphlib.TopologicalSorter(uses).prepare()
    except graphlib.CycleError as error:
        return error.args[1][::-1]
    return []


def cpp_faults(root, uses):
    used = collections.defaultdict(set)
    for path, number, layer, target in includes(root, uses):
        if layer not in uses:
            yield f"{path}: the layer {layer} is not in {PAGE}"
            continue
        if target.startswith("clog/") or target.startswith("core/"):
            other = layer_of(target.removeprefix("clog/").split("/"), uses)
            if not layer.startswith("core/"):
                other = other.split("/")[0]
            if other != layer:
                used[layer].add(other)
                if other not in uses[layer]:
                    yield f"{path}:{number}: {layer} must not use {target}"
        owner = OWN_LIBRARY.get(target)
        if owner not in (None, layer) and not (layer == "programs" and owner == "cli"):
            yield f"{path}:{number}: only {owner} includes <{target}>"
        if target.startswith("fmt/") and path.suffix == ".hpp":
            yield f"{path}:{number}: no header includes <{target}>: it takes long to compile"
    for layer in uses.keys() - {"core"}:
        for other in sorted(uses[layer] - used[layer] - {"programs", layer}):
            if layer != "programs":
                yield f"{PAGE}: {layer} does not use {other}"
        if not (root / "src" / layer).is_dir():
            yield f"{PAGE}: there is no layer {layer}"


def file_of(base, parts):
    """The file of a module, relative to the package. None if the module does not exist."""
    folder = pathlib.Path(*parts)
    return next((place for place in (folder.with_suffix(".py") if parts else folder, folder / "__init__.py") if (base / place).is_file()), None)


def imports(base, path):
    """The line, the module and the file of every import in a Python file. The file is None if the module is outside the
    package."""
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
        layer = path.parts[0] if len(path.parts) > 1 else None
        if (layer or path.stem) not in {*uses, "__init__", "__main__"}:
            yield f"{PACKAGE / path}: the layer {layer} is not in {PAGE}" if layer else f"{PACKAGE / path}: lies in no layer"
            continue
        files[path] = set()
        for line, module, target in imports(base, path):
            library = module.split(".")[0]
            if target is None:
                if layer not in PYTHON_LIBRARIES.get(library, {layer}):
                    yield f"{PACKAGE / path}:{line}: {layer} must not import {library}"
                if library == PACKAGE.name:
                    yield f"{PACKAGE / path}:{line}: imports {module} as a stranger does"
                continue
            files[path].add(target)
            other = target.parts[0]
            if layer not in (None, other):
                used[layer].add(other)
                if other not in uses[layer]:
                    yield f"{PACKAGE / path}:{line}: {layer} must not use {target}"
    if circle := circle_of(files):
        yield f"{PACKAGE}: imports form a circle: {' -> '.join(map(str, circle))}"
    for layer in uses:
        for other in sorted(uses[layer] - used[layer] - {layer}):
            yield f"{PAGE}: {layer} does not use {other}"
        if not (base / layer).is_dir():
            yield f"{PAGE}: there is no layer {layer}"


def faults(root):
    text, _, rest = (root / PAGE).read_text().partition(PYTHON_SECTION)
    python, heading, after = rest.partition("\n## ")
    cpp_layers, python_layers = table(text + heading + after), table(python)
    for layers in (cpp_layers, python_layers):
        if circle := circle_of({layer: others - {layer} for layer, others in layers.items()}):
            yield f"{PAGE}: layers form a circle: {' -> '.join(circle)}"
    yield from cpp_faults(root, cpp_layers)
    yield from python_faults(root, python_layers)


found = list(faults(pathlib.Path(sys.argv[1])))
print("\n".join(found) or "layers are clean")
sys.exit(bool(found))
