"""Adds finished sweeps to this folder.

    python3 docs/gallery/rows/add.py PROGRAMS NAME SWEEP.h5...       NAME: a config in jobs/figures

python3 -m clogsweep figures all --from-rows draws from the files.
"""

import pathlib
import sys

from clogsweep.paper import finished


def processor():
    return next(line.split(":")[1].strip() for line in open("/proc/cpuinfo") if line.startswith("model name"))


def main(programs, name, *sweeps):
    folder = pathlib.Path(__file__).parent
    sweep = finished.add(name, map(pathlib.Path, sweeps), pathlib.Path(programs), processor(), folder)
    print(f"{name}: {len(sweep.rows)} runs in {len(sweep.groups)} finished groups, {len(sweep.incomplete)} unfinished; "
          f"{sweep.core_hours:.2f} core-hours")


main(*sys.argv[1:])
