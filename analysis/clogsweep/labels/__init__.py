"""Names parameters and axes. The names, symbols, units and defaults of the parameters come from clogsweep. clogfit
passes them on as `columns` of its JSON."""

import math
from collections.abc import Collection

from ..tools import rounded
from ..tools.hints import Column, Group
from ..tools.texts import literal

AXES = {
    "line_tension": r"line tension $\Gamma$ [$g\rho\sigma^2$]",
    "wall_stiffness": r"wall stiffness $E_w$ [$g\rho\sigma^3$]",
    "capillary_number": r"capillary number $Ca = (v_g/v_t)\,\pi/(4\Gamma)$",
    "sag": r"sag of the centroid under its own weight $/\sigma$",
    "top_sag": r"sag of the top under its own weight $\delta_s/\sigma$",
    "length": r"clogging length $\lambda/\sigma$",
    "speed": r"mean speed $\langle v_g\rangle/v_t$",
    "slope": r"lateral displacement per distance",
    "h": r"position relative to the orifice $h/\sigma$",
    "shape": r"shape parameter $A = P^2/(4\pi a)$",
    "profile": r"speed $v_g/v_t$",
}


LABORATORY = {
    "line_tension": "interfacial tension [mN/m]",
    "length": r"$\lambda$ [mm]",
    "speed": r"$v_g$ [mm/s]",
    "time": "time [s]",
}


# The main difference between the presets of the interface. docs/explanation/model.md lists all differences.
INTERFACES = {
    "robust": "constant tension",
    "heavy-interface": "constant tension, weight on the interface",
    "elastic": "tension grows with the perimeter",
    "literal": "published equations",
}


def interface_of(preset: str) -> str:
    return INTERFACES.get(preset, f"preset {literal(preset)}")


def tex(unit: str) -> str:
    """Converts a unit for matplotlib. clogsweep writes units such as g rho sigma^2. Units of the model become italic,
    and millimetres upright."""
    unit = unit.replace("mm", r"\mathrm{mm}")
    for word in ("rho", "sigma"):
        unit = unit.replace(word, rf"\{word}")
    return unit.replace("sqrt(", r"\sqrt{").replace(")", "}").replace("t0", "t_0").replace("degrees", r"{}^\circ").replace(" ", r"\,")


def is_number(word: str) -> bool:
    try:
        return math.isfinite(float(word))
    except ValueError:
        return False


def symbol(column: Column) -> str:
    """The symbol of a parameter divided by its unit, so that the label belongs to a pure number. A parameter whose
    values are words has its name instead. The symbols in AXES belong to pure numbers already."""
    if column["symbol"] and column["name"] in AXES:
        return column["symbol"]
    if not column["symbol"]:
        return rf"\mathrm{{{column['name'].replace('_', ' ')}}}".replace(" ", r"\ ")
    if column["unit"].startswith("1/"):
        return rf"{column['symbol']}\,{tex(column['unit'][2:])}"
    return column["symbol"] + (f"/({tex(column['unit'])})" if " " in column["unit"] else f"/{tex(column['unit'])}" if column["unit"] else "")


def parameter_label(column: Column, value: float | str | None) -> str:
    """A parameter and its value for a legend. Parameters that have an axis have their symbol."""
    if column["name"] in AXES and isinstance(value, int | float):
        return f"${column['symbol']} = {value:.4g}$"
    return phrase(column, value)


def phrase(column: Column, value: float | str | None) -> str:
    """A parameter and its value in words, such as: obstacle gap 0.2 sigma."""
    if "label" in column:
        return str(column["label"].format(value))
    # clogfit has no number for the density of a saturated mixture, because it is unknown before the run.
    if value is None:
        return "saturated arrays" if column["name"] == "obstacle_density" else f"no {column['name'].replace('_', ' ')}"
    if isinstance(value, str):
        return f"{column['name'].replace('_', ' ')} {literal(value)}"
    if column["name"] == "vertices":
        return f"{value:g} vertices"
    if column["unit"] == "degrees":
        return f"{column['name'].replace('_', ' ')} {value:.4g}°"
    unit = column["unit"]
    after = f"/{tex(unit[2:])}" if unit.startswith("1/") else rf"\,{tex(unit)}" if unit else ""
    return f"{column['name'].replace('near_wall', 'near-wall').replace('_', ' ')} ${value:.4g}{after}$"


def key_phrase(key: str, value: str) -> str:
    """A key of clogsweep and its value in words, such as: obstacle gap 0.2."""
    if key == "preset":
        return interface_of(value)
    words = key.replace("-", " ").replace("near wall", "near-wall").replace("break up", "break-up")
    return f"{value} vertices" if key == "vertices" else f"{words} {literal(value)}"


def axis_label(column: Column) -> str:
    if "label" in column:
        return f"{column['meaning']} [{column['unit']}]"
    return AXES.get(column["name"]) or f"{column['name'].replace('_', ' ')} ${symbol(column)}$"


def runs_a_point(groups: Collection[Group]) -> str:
    counts = sorted({group["runs"] for group in groups})
    return f"{rounded.count_text(counts[0], 'run')} per point" if len(counts) == 1 else f"{counts[0]} to {counts[-1]} runs per point"
