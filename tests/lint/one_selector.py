"""Checks that only --instruction-set can determine the bits of a row. Compiled files of ours may not query the
processor. They may not have indirect functions, either, because the processor on which a program starts determines the
versions of these functions.

    one_selector.py READELF OBJDUMP FILE...     (archives and programs)
"""

import re
import subprocess
import sys


def output(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def indirect_functions(path):
    for line in output(readelf, "-W", "--syms", path).splitlines():
        match line.split():
            case [_, _, _, "IFUNC", _, _, section, name] if section != "UND":
                yield name


def functions_that_ask(path):
    for line in output(objdump, "-d", "--no-show-raw-insn", path).splitlines():
        if label := re.fullmatch(r"[0-9a-f]+ <(.+)>:", line):
            name = label.group(1)
        elif line.endswith("\tcpuid"):
            yield name


readelf, objdump, *paths = sys.argv[1:]
found = sorted({f"{path}: {what} {name}" for path in paths
                for what, names in (("indirect", indirect_functions(path)), ("cpuid in", functions_that_ask(path)))
                for name in names})
print("\n".join(found) or "one selector")
sys.exit(bool(found))
