"""Exports a run for ParaView, with the droplet's outline at each time and the obstacles around it. All files are text
in VTK's XML format PolyData."""

import math
import pathlib
import xml.etree.ElementTree as xml
from collections.abc import Iterable, Mapping, Sequence

import numpy as np
import numpy.typing as npt

from ..reading import stored, trajectory
from ..tools import outputs
from ..tools.errors import UserError
from ..tools.hints import Numbers


def data_array(parent: xml.Element, name: str, values: npt.ArrayLike, components: int = 1) -> xml.Element:
    values = np.asarray(values)
    kind = "Int64" if values.dtype.kind == "i" else "Float64"
    element = xml.SubElement(parent, "DataArray", type=kind, Name=name, format="ascii")
    if components > 1:
        element.set("NumberOfComponents", str(components))
    if not np.isfinite(values).all():
        raise UserError(f"{name} contains NaN or infinity, which VTK's readers reject; "
                        "replay the droplet (clogrun replay)")
    element.text = " ".join(map(repr, values.ravel().tolist()))
    return element


def polydata(outlines: Sequence[Numbers], point_data: Mapping[str, Numbers] | None = None,
             cell_data: Mapping[str, Numbers] | None = None,
             field_data: Mapping[str, float] | None = None) -> xml.ElementTree:
    """Closed polygons as PolyData. @param outlines  arrays n x 2; @param point_data, cell_data  arrays by name"""
    root = xml.Element("VTKFile", type="PolyData", version="1.0", byte_order="LittleEndian", header_type="UInt64")
    body = xml.SubElement(root, "PolyData")
    if field_data:
        fields = xml.SubElement(body, "FieldData")
        for name, value in field_data.items():
            data_array(fields, name, [value]).set("NumberOfTuples", "1")
    points = np.concatenate(outlines) if outlines else np.empty((0, 2))
    piece = xml.SubElement(body, "Piece", NumberOfPoints=str(len(points)), NumberOfPolys=str(len(outlines)),
                           NumberOfVerts="0", NumberOfLines="0", NumberOfStrips="0")
    for kind, data in [("PointData", point_data), ("CellData", cell_data)]:
        element = xml.SubElement(piece, kind)
        for name, values in (data or {}).items():
            data_array(element, name, values)
    data_array(xml.SubElement(piece, "Points"), "Points", np.column_stack([points, np.zeros(len(points))]),
               components=3)
    polygons = xml.SubElement(piece, "Polys")
    data_array(polygons, "connectivity", np.arange(len(points)))
    data_array(polygons, "offsets", np.cumsum([len(outline) for outline in outlines], dtype=np.int64))
    return xml.ElementTree(root)


def collection(files: Iterable[str], times: Iterable[float]) -> xml.ElementTree:
    root = xml.Element("VTKFile", type="Collection", version="1.0", byte_order="LittleEndian")
    body = xml.SubElement(root, "Collection")
    for file, time in zip(files, times):
        xml.SubElement(body, "DataSet", timestep=repr(float(time)), group="", part="0", file=file)
    return xml.ElementTree(root)


def write(tree: xml.ElementTree, path: pathlib.Path) -> None:
    outputs.refuse_unwritable(path, "vtk")
    with outputs.replaced(path) as fresh:
        tree.write(fresh, encoding="utf-8", xml_declaration=True)


def surroundings(run: trajectory.Trajectory) -> xml.ElementTree:
    angle = np.linspace(0, 2 * math.pi, 48, endpoint=False)
    circle = np.column_stack([np.cos(angle), np.sin(angle)])
    discs = [np.array([x, y]) + diameter / 2 * circle for x, y, diameter in run.obstacles]
    low, high = run.polygons.min(axis=(0, 2)) - 5, run.polygons.max(axis=(0, 2)) + 5
    walls = [np.clip(trajectory.wedge_outline(wedge), low, high) for wedge in run.wedges]
    diameters = [diameter for _, _, diameter in run.obstacles] + [0] * len(walls)
    return polydata(discs + walls, cell_data={"diameter": np.array(diameters, dtype=float)})


def export(run: trajectory.Trajectory, output: pathlib.Path) -> pathlib.Path:
    """Writes the files. @return the .pvd file"""
    folder = output.with_name(output.name + "-vtk")
    pvd, around = output.with_name(output.name + ".pvd"), output.with_name(output.name + "-obstacles.vtp")
    for path in (pvd, around):
        outputs.refuse_unwritable(path, "vtk", run.path)
    folder.mkdir(parents=True, exist_ok=True)
    speeds = trajectory.interface_speeds(run)
    columns = stored.columns_of(run.table)
    names = []
    for frame, (polygon, time) in enumerate(zip(run.polygons, run.times)):
        fields = {name: float(np.interp(time, run.table["time"], run.table[name]))
                  for name in columns if name != "time"}
        fields = {name: value for name, value in fields.items() if math.isfinite(value)}
        fields["TimeValue"] = float(time)
        names.append(f"{folder.name}/droplet-{frame:05d}.vtp")
        write(polydata([polygon.T], {"point_speed": speeds[frame]}, field_data=fields), output.parent / names[-1])
    write(surroundings(run), around)
    write(collection(names, run.times), pvd)
    return pvd
