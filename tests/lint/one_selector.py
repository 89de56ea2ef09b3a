"""No compiled file of ours has indirect functions, of which the processor chooses one when a program starts: which
instructions decide the bits of a row is for --instruction-set to say.

    one_selector.py READELF FILE...     (archives and programs)
"""

import subprocess
import sys


def indirect_functions(readelf, path):
    listing = subprocess.run([readelf, "-W", "--syms", path], check=True, capture_output=True, text=True).stdout
    for line in listing.splitlines():
        match line.split():
            case [_, _, _, "IFUNC", _, _, section, name] if section != "UND":
                yield name


readelf, *paths = sys.argv[1:]
found = sorted({f"{path}: {name}" for path in paths for name in indirect_functions(readelf, path)})
print("\n".join(found) or "no indirect functions")
sys.exit(bool(found))
