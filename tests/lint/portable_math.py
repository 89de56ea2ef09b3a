"""Checks calls of the C library. The library has several versions of some functions, for different processors. The
modules that compute numbers of a sweep's rows must not call these functions.
include/clog/core/tools/portable_math.hpp replaces them.

    portable_math.py READELF ARCHIVE...
"""

import re
import subprocess
import sys

SEVERAL_VERSIONS = re.compile(
    r"(sincos|a?(sin|cos|tan)h?|atan2|exp|exp2|exp10|expm1|log|log2|log10|log1p|pow|lgamma|tgamma|erfc?)f?")


def called(readelf, path):
    listing = subprocess.run([readelf, "-W", "--syms", path], check=True, capture_output=True, text=True).stdout
    for line in listing.splitlines():
        match line.split():
            case [_, _, _, _, _, _, "UND", name]:
                yield name


readelf, *paths = sys.argv[1:]
found = sorted({f"{path}: {name}" for path in paths for name in called(readelf, path)
                if SEVERAL_VERSIONS.fullmatch(name)})
print("\n".join(found) or "nothing that depends on the processor")
sys.exit(bool(found))
