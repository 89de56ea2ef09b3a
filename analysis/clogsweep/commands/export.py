"""Copies the rows of a sweep into a file for programs that cannot read compound tables of HDF5.

    python3 -m clogsweep export sweep.h5 rows.csv
    python3 -m clogsweep export monday.h5 tuesday.h5 rows.h5      # several files as one sweep

The first line of rows.csv has the names of the columns, each with its unit in brackets; the numbers equal those of the
sweep, bit for bit. rows.h5 has a dataset for each column, with the attributes `unit` and `meaning`. Missing values are
empty or NaN. With break-up=daughters, a second file has the droplets of all families: rows-droplets.csv or
rows-droplets.h5.
"""

import pathlib

from ..reading import export, programs
from ..results import sweep
from . import command_line


def body() -> int:
    parser = command_line.Parser(__doc__)
    parser.add_argument("sweeps", type=pathlib.Path, nargs="+", help="files of clogsweep --output")
    parser.add_argument("output", type=pathlib.Path,
                        help="file to write, .csv or .h5; an existing file is not replaced")
    programs.add_option(parser)
    arguments = parser.parse_args()
    paths, folder = arguments.sweeps, arguments.programs
    rows = sweep.merged(paths, folder) if len(paths) > 1 else sweep.Sweep(paths[0], folder)
    made = rows.export(arguments.output)
    command_line.tell(made)
    if len(rows.droplets):
        command_line.tell(export.file_of_droplets(made))
    return 0
