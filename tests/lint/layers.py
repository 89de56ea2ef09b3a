"""Includes go down the layers only: programs -> {cli, parallel, store, fit} -> sweep -> core.

Also: <mpi.h> only in parallel, <hdf5.h> only in store, and fit knows no droplet.
"""

import pathlib
import re
import sys

MAY_USE = {
    "core": {"core"},
    "sweep": {"sweep", "core"},
    "fit": {"fit"},
    "store": {"store", "sweep", "core"},
    "parallel": {"parallel", "sweep", "core"},
    "cli": {"cli", "sweep", "core"},
    "programs": {"cli", "parallel", "store", "fit", "sweep", "core"},
}
OWN_LIBRARY = {"mpi.h": "parallel", "hdf5.h": "store", "boost/program_options.hpp": "cli"}


def faults(root):
    for base in (root / "include" / "clog", root / "src"):
        for path in sorted(base.rglob("*.?pp")):
            layer = path.relative_to(base).parts[0]
            for number, line in enumerate(path.read_text().splitlines(), 1):
                include = re.match(r'\s*#include [<"]([^>"]+)[>"]', line)
                if not include:
                    continue
                target = include.group(1)
                place = f"{path.relative_to(root)}:{number}"
                if target.startswith("clog/") and target.split("/")[1] not in MAY_USE[layer]:
                    yield f"{place}: {layer} must not use {target}"
                owner = OWN_LIBRARY.get(target)
                if owner not in (None, layer) and not (layer == "programs" and owner == "cli"):
                    yield f"{place}: only {owner} includes <{target}>"


found = list(faults(pathlib.Path(sys.argv[1])))
print("\n".join(found) or "layers are clean")
sys.exit(bool(found))
