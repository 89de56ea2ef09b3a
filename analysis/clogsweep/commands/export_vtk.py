"""Writes a run for ParaView: the droplet's outline against time, and the obstacles around it.

    clogrun array --output run.h5 --polygon-interval 5 line-tension=0.3 seeds=4
    python3 -m clogsweep export-vtk run.h5 --output run
    paraview run.pvd

Makes RUN.pvd, which lists every frame with its time, the frames in the folder RUN-vtk, and RUN-obstacles.vtp with discs
and walls (of diameter 0) within five diameters of the droplet's path. All are VTK's XML PolyData, as text. An outline
is the refined interface, in which vertices and midpoints of edges alternate. Each frame contains the speed of the
outline's points and, as field data, the columns of the trajectory at its time. Units are those of
docs/reference/files.md.
"""

import pathlib

from ..drawing import vtk
from ..reading import trajectory
from . import command_line


def body() -> int:
    parser = command_line.Parser(__doc__)
    parser.add_argument("run", type=pathlib.Path, help="output of clogrun with --polygon-interval")
    command_line.add_output(parser, "name of the files; .pvd and other endings are added", ".pvd", required=True)
    arguments = parser.parse_args()
    command_line.tell(vtk.export(trajectory.read(arguments.run), arguments.output))
    return 0
