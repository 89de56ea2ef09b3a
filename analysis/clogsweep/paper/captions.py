"""Describes the parameters that the points of a figure share, in the line above the figure."""

from collections.abc import Collection, Sequence

from ..labels import interface_of, phrase, runs_a_point
from ..tools.hints import Column, Group

# A caption names these parameters if all points share one value other than 0.
NAMED = ("line_tension", "obstacle_gap", "obstacle_diameter", "near_wall_drag")


def arrays_of(groups: Sequence[Group]) -> str:
    """How the arrays are filled, in words."""
    if {group["obstacle_filling"] for group in groups} == {"saturated"}:
        return "saturated arrays"
    densities = sorted({group["obstacle_density"] for group in groups})
    if len(densities) == 1:
        return rf"obstacle density ${densities[0]:g}/\sigma^2$"
    return rf"obstacle density {densities[0]:.3g} to ${densities[-1]:.3g}/\sigma^2$"


def describe(columns: dict[str, Column], groups: Sequence[Group], without: Collection[str] = ()) -> str:
    """The shared parameters as phrases separated by commas. Parameters that only polygons have are attributed to the
    polygons.
    @param columns  see Runner.columns()
    @param without  parameters that the figure names elsewhere"""
    polygons = [group for group in groups if group["model"] == "dp"]

    def common(name: str, members: Sequence[Group] = groups) -> bool:
        return name not in without and len({group[name] for group in members}) == 1

    words = [] if polygons else ["soft disk"]
    if polygons and "vertices" not in without:
        meshes = sorted({group["vertices"] for group in polygons})
        words.append(f"{' or '.join(map(str, meshes))} vertices")
    words += [phrase(columns[name], groups[0][name]) for name in NAMED if common(name) and groups[0][name]]
    if "obstacle_density" not in without:
        words.append(arrays_of(groups))
    if common("terminal_speed"):
        words.append(phrase(columns["terminal_speed"], groups[0]["terminal_speed"]))
    words.append(rf"up to ${max(group['max_time'] for group in groups):g}\,t_0$")
    if common("box"):
        words.append(rf"arrays ${groups[0]['box']:g}\,\sigma$ wide")
    words.append(runs_a_point(groups))
    if polygons and common("preset", polygons):
        words.append(interface_of(polygons[0]["preset"]))
    return ", ".join(words)
