"""Reads circles and outlines from DXF drawings, with the shapes that a drawing program shows."""

from __future__ import annotations

import collections
import pathlib
from collections.abc import Iterator
from typing import Any

import numpy as np

from ..tools.errors import UserError
from ..tools.hints import Numbers
from . import areas
from .libraries import library
from .shapes import Drawing

UNITS = {1: 25.4e-3, 2: 0.3048, 4: 1e-3, 5: 1e-2, 6: 1.0, 8: 25.4e-9, 9: 25.4e-6, 11: 1e-10, 12: 1e-9, 13: 1e-6, 14: 0.1}  # $INSUNITS, in metres
UNITLESS = 0
FLATNESS = 1e-4  # Largest deviation of straight pieces from a curve, as a fraction of its size.
CURVES = ("LINE", "ARC", "LWPOLYLINE", "POLYLINE", "ELLIPSE", "SPLINE", "SOLID", "TRACE")
FILLED = ("SOLID", "TRACE")
HATCHES = ("HATCH", "MPOLYGON")
HATCH_IGNORES_HOLES = 2  # A value of hatch_style.
SEGMENTS = 256  # Number of straight pieces of a full circle. An arc of a wide line has a proportional number of pieces.


def read_dxf(path: pathlib.Path, layer: str | None) -> Drawing:
    """Reads circles and closed outlines of the model space, also those in blocks."""
    ezdxf = library("ezdxf", "python3-ezdxf")
    document = ezdxf.readfile(path)
    found = Drawing([], [], metres_of(document, path), skipped=collections.Counter())
    for entity, on_layer in visible(document.modelspace(), document.layers, None, found.skipped):
        found.layers[on_layer] = found.layers.get(on_layer, 0) + 1
        if layer is not None and on_layer.lower() != layer.lower():
            found.skipped[f"{entity.dxftype()} on layer {on_layer}"] += 1
            continue
        try:
            add(found, entity)
        except (TypeError, ValueError, ArithmeticError) as error:
            raise UserError(f"cannot read {path} ({entity.dxftype()} on layer {on_layer}: {error}); "
                            "explode it in the drawing program") from error
    return found


def metres_of(document: Any, path: pathlib.Path) -> float | None:
    """The length of the unit in $INSUNITS. @throws UserError  for a unit that is impossible for a device, such as a
    mile or a light year"""
    code = document.header.get("$INSUNITS", UNITLESS)
    if code == UNITLESS:
        return None
    if code not in UNITS:
        raise UserError(f"cannot read {path} (its unit, $INSUNITS={code}, is not one of a drawing of this size); "
                        "set $INSUNITS in the drawing program, 13 for um")
    return UNITS[code]


def visible(entities: Any, layers: Any, parent: str | None, skipped: dict[str, int]) -> Iterator[tuple[Any, str]]:
    """Yields the visible entities with their layers. Entities in blocks come in world coordinates. In a block, layer 0
    means the layer of the reference to this block.
    @param parent  layer of the reference to the block
    @throws UserError  if a block is in another file"""
    def count_distorted(part: Any, _: str) -> None:
        skipped[f"{part.dxftype()} in a distorted block"] += 1

    for entity in entities:
        kind, name = entity.dxftype(), entity.dxf.layer
        name = parent if parent is not None and name == "0" else name
        state = layers.get(name) if name in layers else None
        if entity.dxf.get("invisible", 0):
            skipped[f"invisible {kind}"] += 1
        elif state is not None and state.is_frozen():
            skipped[f"{kind} on frozen layer {name}"] += 1
        elif kind == "INSERT":
            if entity.block() is None or entity.block().block.is_xref:
                raise UserError(f"the drawing inserts '{entity.dxf.name}', which is not in the file; "
                                "bind external references in the drawing program")
            for copy in entity.multi_insert() if entity.mcount > 1 else [entity]:
                parts = copy.virtual_entities(skipped_entity_callback=count_distorted)
                yield from visible(parts, layers, name, skipped)
        elif state is not None and state.is_off():
            skipped[f"{kind} on layer {name}, which is off"] += 1
        else:
            yield entity, name


def add(found: Drawing, entity: Any) -> None:
    """Adds an entity as a circle, an outline or a line."""
    paths = library("ezdxf.path", "python3-ezdxf")
    kind = entity.dxftype()
    if kind == "CIRCLE" and abs(entity.dxf.extrusion.normalize().z) > 1 - 1e-9:
        centre = entity.ocs().to_wcs(entity.dxf.center)
        found.circles.append((centre.x, centre.y, 2 * entity.dxf.radius))
    elif kind in HATCHES:
        boundaries = [corners_of(curve) for curve in paths.from_hatch(entity)]
        areas.fill(found, boundaries, is_even_odd=entity.dxf.hatch_style != HATCH_IGNORES_HOLES)
    elif has_width(entity):
        areas.add(found, areas.union(trace_of(entity)))
    elif kind in (*CURVES, "CIRCLE"):
        curve = paths.make_path(entity)
        if curve.is_closed or getattr(entity, "is_closed", False) or kind in FILLED:
            found.outlines.append(corners_of(curve))
        else:
            found.pieces.append((kind if kind in ("LINE", "ARC") else f"open {kind}", corners_of(curve)))
    else:
        found.skipped[kind] += 1


def has_width(entity: Any) -> bool:
    kind = entity.dxftype()
    return bool((kind == "LWPOLYLINE" or kind == "POLYLINE" and entity.is_2d_polyline) and entity.has_width)


def trace_of(polyline: Any) -> list[Any]:
    """The quadrilaterals of which a wide LWPOLYLINE consists. The command DONUT of drawing programs makes a wide
    LWPOLYLINE from two arcs."""
    trace, geometry = library("ezdxf.render.trace", "python3-ezdxf"), library("shapely.geometry", "python3-shapely")
    builder = trace.TraceBuilder.from_polyline(polyline, segments=SEGMENTS)
    faces = builder.faces_wcs(polyline.ocs(), 0.0)  # The elevation is a position along z, which has no meaning here.
    return [geometry.MultiPoint([(point.x, point.y) for point in face]).convex_hull for face in faces]


def corners_of(curve: Any) -> Numbers:
    points = np.array([(point.x, point.y) for point in curve.control_vertices()])
    size = float(np.ptp(points, axis=0).max()) or 1.0
    return np.array([(point.x, point.y) for point in curve.flattening(FLATNESS * size)])
