"""The groups of a fit. Decides which parameters vary between the groups, chooses the abscissa, and makes all labels."""

from __future__ import annotations

import functools
import pathlib
from collections.abc import Callable, Collection, Iterable
from typing import Any

from ..reading import fits, stored
from ..tools.errors import UserError
from ..tools.hints import AnyPath, Column, Group
from ..tools.texts import literal
from . import AXES, INTERFACES, axis_label, interface_of, is_number, parameter_label, phrase, runs_a_point

NO_CURVES: dict[str, Any] = {"curves": [], "excluded": []}
LATTICES = {"lattice": "square", "triangular": "triangular", "rhombic": "rhombic"}  # names by obstacle_filling
FINISHED = ("passed", "clogged", "broken", "flowing")


def has_results(group: Group) -> bool:
    """Whether a group has finished runs. In a channel or on a wall each group is one run, with a status."""
    return group["status"] in FINISHED if "status" in group else group["runs"] + group["met_none"] > 0


class Groups:
    """The groups of one sweep that have runs, drawn against one parameter of the sweep."""

    def __init__(self, fit: dict[str, Any], circle_files: dict[str, str] | None = None) -> None:
        """@param fit  the JSON output of clogfit; @param circle_files  see stored.circle_files()"""
        # Nothing in a channel or on a wall is random, so each group consists of one run and has a status.
        self.are_passages = all("status" in group for group in fit["groups"])
        self._fit = fit
        fit = fits.in_millimetres(fit)
        self.are_in_mm = "in_mm" in fit  # whether parameters, and lengths in pictures, are in millimetres
        self.members: list[Group] = [group for group in fit["groups"] if has_results(group)]
        self._told: list[Group] = fit["groups"]
        self.confidence: float = fit["confidence"]
        # The model's units in the laboratory, if all groups have the same ones.
        self.laboratory: dict[str, float | None] = fit.get("laboratory", {})
        # Descriptions of the laboratories, by their checksums.
        self.laboratories: dict[str, str] = fit.get("laboratories", {})
        self.columns: dict[str, Column] = {column["name"]: column for column in fit["columns"]}
        self.lists: Collection[str] = fit["lists"]
        self.settings = stored.settings(fit.get("sweep", {}).get("config", ""))  # empty for files of older programs
        self._circle_files = circle_files or self._only_circle_file()
        self.tells_what_all_share = True  # Whether caption() describes the parameters that all groups share.
        self.abscissa = self._choose_abscissa() if self.members else ""  # Without members there is nothing to draw.
        self._ask_for_curves: Callable[[], dict[str, Any]] = lambda: NO_CURVES  # see fit_curves()

    def finished(self, source: object = "the sweep") -> Groups:
        """Returns the groups. @throws UserError  if no run has finished, or if they have different kinds of results:
        those of arrays, channels and walls cannot share a picture"""
        if not self.members:
            raise UserError(f"{source} holds no finished runs; let the sweep finish some first")
        fits.refuse_mixed(self.values("obstacle_filling"), f"cannot draw droplets in {{}} in one picture ({source})")
        return self

    def with_lengths(self, source: object = "the sweep") -> Groups:
        """Returns the groups, as finished() does. @throws UserError  also for droplets in a channel or on a wall, which
        have no clogging lengths"""
        if self.finished(source).are_passages:
            raise UserError("cannot draw clogging lengths (these droplets were in a channel or on a wall); clogfit report draws their results")
        if not any(group["runs"] for group in self.members):
            raise UserError(f"no droplet of {source} met an obstacle, so there is no clogging length; python3 -m clogsweep device or report shows their paths")
        return self

    def fit_curves(self, sweep: AnyPath, folder: pathlib.Path) -> Groups:
        """Arranges that smooth curves over the abscissa are fitted on first use, if that is possible.
        @param sweep  the file that was fitted; @param folder  of the programs"""
        def ask() -> dict[str, Any]:
            from ..curves import answer, points  # SciPy is slow to load

            try:
                return answer.of_fit(self._fit, points.seeds_of_groups(self._fit, stored.read_rows(sweep, folder)), [self.abscissa])
            except UserError:  # No curve can be fitted, for instance because the abscissa has the value 0.
                return NO_CURVES

        if self.members and not self.are_passages and self.is_logarithmic():
            self._ask_for_curves = ask
        return self

    @functools.cached_property
    def _fitted(self) -> dict[str, Any]:
        return self._ask_for_curves()

    def fitted_curve(self, members: Collection[Group]) -> dict[str, Any] | None:
        """The fitted curve for the groups of one drawn curve, if there is one. A fitted curve with groups of several
        drawn curves is returned only for the drawn curve that has the first point of the fitted curve."""
        for curve in self._fitted["curves"]:
            if any(self._told[curve["points"][0]["group"]] is group for group in members):
                return curve
        return None

    def excluded_from_curves(self) -> list[str]:
        """The points that belong to no fitted curve, grouped by reason. The list is empty if no curve was fitted."""
        if not self._fitted["curves"]:
            return []
        points: dict[str, list[str]] = {}
        for one in self._fitted["excluded"]:
            points.setdefault(one["reason"], []).append(self.parameter_label(self.abscissa, one[self.abscissa]))
        return [f"{', '.join(dict.fromkeys(places))} ({reason})" for reason, places in points.items()]

    @property
    def are_polygons(self) -> bool:
        return self.members[0]["model"] == "dp"

    @property
    def are_lattices(self) -> bool:
        return bool(self.members) and self.values("obstacle_filling") <= LATTICES.keys()

    def values(self, name: str) -> set[Any]:
        return {group[name] for group in self.members}

    def varies(self, name: str) -> bool:
        return len(self.values(name)) > 1

    def follows(self, name: str, others: Iterable[str]) -> bool:
        """Whether the value of this parameter follows from the values of the others."""
        return fits.follows(self.members, name, others)

    def _choose_abscissa(self) -> str:
        """Chooses the abscissa: the usual one if it varies, otherwise the numeric parameter with the most values.
        Parameters without an automatic value come first."""
        usual = "line_tension" if self.are_polygons else "wall_stiffness"
        if self.are_in_mm and self.follows(usual, fits.DROPLETS):
            return max(fits.DROPLETS, key=lambda name: len(self.values(name)))
        if self.are_lattices and self.varies("lattice_angle"):
            return "lattice_angle"
        known = [name for name in self.columns if self._is_number(name) and None not in self.values(name)]  # to both models
        if usual not in known:
            usual = next((name for name in known if not self.varies(name)), usual)
        elif self.varies(usual) and not self._is_automatic(usual) and not self.num_automatic(usual):
            return usual
        # Values that follow from the model, such as the one vertex of a disk, are no abscissa.
        varied = [name for name in known if self.varies(name) and not self.follows(name, ["model"])]
        return max(varied, key=lambda name: (not self.num_automatic(name), not self._is_automatic(name), len(self.values(name))), default=usual)

    def num_automatic(self, name: str) -> int:
        """The number of groups whose value of the parameter is automatic."""
        return sum(name in group["automatic"] for group in self.members)

    def _is_number(self, name: str) -> bool:
        return self.columns[name]["kind"] != "word"

    def _is_automatic(self, name: str) -> bool:
        """Whether values of the parameter can follow from other parameters. Values cannot follow from others if the
        sweep gives a number or a list for the parameter."""
        fillings = self.values("obstacle_filling")
        if name in ("obstacle_gap", "obstacle_density") and fillings == {"file"}:
            return True  # Gap and density follow from the circles and the length of their array.
        if name in self.lists or self._is_given_number(name):
            return False
        from_array = (name == "obstacle_density" and bool(self._share_of_saturated())) or (name in ("box", "length") and self.are_lattices)
        return from_array or all(name in group["automatic"] for group in self.members)

    def _is_of_preset(self, name: str) -> bool:
        """Whether the parameter's value follows from the abscissa and the preset. This is the case if the value is
        automatic for some presets, and the same number for all others. If there are several numbers, the user chose
        them."""
        models = {group["model"] for group in self.members if name in group["automatic"]}
        chosen = {group[name] for group in self.members if group["model"] not in models}
        return bool(models) and len(chosen) < 2 and self.follows(name, [self.abscissa, "preset"])

    def _share_of_saturated(self) -> str:
        """The filling of all random arrays, such as `12%`. The text is empty if the arrays have different fillings."""
        share = self.settings.get("obstacle-density", "")
        return share if share.endswith("%") and is_number(share[:-1]) and self.values("obstacle_filling") == {"density"} else ""

    def _is_given_number(self, name: str) -> bool:
        """Whether the config gives the parameter as a number. `box` never counts, because the box of a lattice follows
        from the number that was given."""
        return name != "box" and is_number(self.settings.get(name.replace("_", "-"), ""))

    def curve_parameters(self) -> list[str]:
        """Names of the parameters in which the curves differ."""
        # In general, other parameters, such as the place of an exit, follow from the laboratory or from the file of
        # circles.
        names = [name for name in ("model", "laboratory", "obstacles") if self.varies(name)]
        if self.are_in_mm:
            droplet = [name for name in fits.DROPLETS if self.varies(name) and name != self.abscissa]
            names = droplet + [name for name in names if not self.follows(name, fits.DROPLETS)]
        else:
            names += [name for name in self.columns
                      if self.varies(name) and name != self.abscissa and self._is_number(name)
                      and not self._is_automatic(name) and not self._is_of_preset(name)
                      and not (names and self.follows(name, names))]
        # A label leaves out words and automatic values that follow from its other parameters. A preset is named even
        # then, if presets with different interfaces occur. A preset comes before the parameters that it sets.
        rest = [name for name in self.columns if name not in names and name != self.abscissa]
        for name in sorted(rest, key=lambda name: (name != "preset", self._is_number(name))):
            have_interfaces = name == "preset" and len(self.values(name) & INTERFACES.keys()) > 1
            if have_interfaces or not self.follows(name, [self.abscissa, *names]):
                names.append(name)
        return self._of_models(names)

    def _of_models(self, names: Iterable[str]) -> list[str]:
        """Names of parameters in which groups differ. A parameter that follows from the model (one model has a single
        value, the other model lacks the parameter) is left out."""
        if not self.varies("model"):
            return list(names)
        return ["model", *(name for name in names if name != "model" and len(self.values(name) - {None}) > 1)]

    def parameter_label(self, name: str, value: float | str | None) -> str:
        if name == "laboratory" and value in self.laboratories:
            return literal(self.laboratory_label(str(value)))
        if name == "preset":
            return interface_of(str(value))
        return parameter_label(self.columns[name], self.named(name, value))

    def named(self, name: str, value: Any) -> Any:
        """A parameter's value. User-supplied circles are stored as a checksum. The name of their file replaces the
        checksum if the name is known."""
        return self._circle_files.get(value, value) if name == "obstacles" else value

    def laboratory_label(self, check_sum: str) -> str:
        """The entries in which a laboratory differs from the others, or all entries if it is the only laboratory."""
        parts = {one: text.split("; ") for one, text in self.laboratories.items()}
        own = [part for part in parts[check_sum] if not all(part in other for other in parts.values())]
        return "; ".join(own or parts[check_sum])

    def distinguishing(self) -> list[str]:
        """Names of the parameters in which the groups differ."""
        return self._of_models(name for name in [self.abscissa, *self.curve_parameters()] if self.varies(name))

    def row_values(self, member: Group) -> dict[str, Any]:
        """The values that identify the rows of a group. Values that clogfit does not know, such as the density of a
        saturated array, are left out, because they follow from the others. Parameters that the model of these runs
        lacks are also left out."""
        values = member.get("in_table", member)
        names = [name for name in self.distinguishing() if name not in fits.DROPLETS] + (["laboratory"] if self.are_in_mm else [])
        return {name: values[name] for name in names if values[name] is not None}

    def label_of(self, member: Group) -> str:
        """A label with the values that distinguish a group from the others."""
        return self._label({name: member[name] for name in self.distinguishing()})

    def _label(self, values: dict[str, Any]) -> str:
        """Names values. Parameters that a model lacks are left out."""
        return ", ".join(self.parameter_label(name, value) for name, value in values.items()
                         if value is not None or not self.varies("model"))

    def abscissa_key(self) -> str:
        """The name of the abscissa as a column of a user's table."""
        return fits.DROPLETS[self.abscissa]["key"] if self.abscissa in fits.DROPLETS else self.abscissa

    def axis_label(self) -> str:
        return axis_label(self.columns[self.abscissa])

    def curves(self) -> list[tuple[str, list[Group]]]:
        """For every curve, a label and its groups. The groups of a curve differ only in the abscissa."""
        names = self.curve_parameters()
        keys = sorted({tuple(group[name] for name in names) for group in self.members},
                      key=lambda key: [(value is None, isinstance(value, str), value) for value in key])
        return [(self._label(dict(zip(names, key))),
                 [group for group in self.members if tuple(group[name] for name in names) == key]) for key in keys]

    def is_logarithmic(self) -> bool:
        values = self.values(self.abscissa)
        return None not in values and min(values) > 0 and (self.abscissa in AXES or max(values) > 5 * min(values))

    def caption(self) -> str:
        """The parameters that all curves share, and the number of runs."""
        if not self.tells_what_all_share:
            return ""
        first = self.members[0]
        models = [name for model, name in (("dp", "deformable polygon"), ("sp", "soft disk")) if model in self.values("model")]
        words = [" and ".join(models)]
        words += [phrase(self.columns[name], self.named(name, first[name])) for name in self.columns
                  if self._is_worth_a_word(name, first[name])]
        if self.values("obstacle_filling") == {"saturated"}:
            words.append("saturated arrays")
        if share := self._share_of_saturated():
            words.append(f"{share[:-1]} % of the saturated density")
        if lattice := LATTICES.get(first["obstacle_filling"]):
            words.append(f"{lattice} lattice")
        if first["obstacle_filling"] == "file":
            words.append(f"circles of {literal(self._circle_file())}")
        if not self.are_passages:
            words.append(runs_a_point(self.members))
        if self.are_polygons and not self.varies("preset"):
            meaning = INTERFACES.get(first["preset"])
            words.append(f"preset {literal(first['preset'])}" + (f" ({meaning})" if meaning else ""))
        return ", ".join(words)

    def _only_circle_file(self) -> dict[str, str]:
        """The checksum and the name of the only file of circles in the config. Without the sweep's file, only the
        config has names of files. If it names several files, nothing shows which file has which checksum."""
        name = self.settings.get("obstacles", "none")
        if name == "none" or "," in name:
            return {}
        return {check_sum: pathlib.Path(name).name for check_sum in self.values("obstacles")}

    def _circle_file(self) -> str:
        sums = self.values("obstacles")
        return str(self.named("obstacles", *sums)) if len(sums) == 1 and sums <= self._circle_files.keys() else "a file" if len(sums) == 1 else "files"

    def _is_worth_a_word(self, name: str, value: Any) -> bool:
        """Whether the caption names a parameter. The caption names a parameter that shapes the array, or that differs
        from its default."""
        column = self.columns[name]
        if name == "obstacle_diameter" and self.values("obstacle_filling") == {"file"}:
            return False  # The parameter applies only to circles without a diameter of their own.
        if self.varies(name) or not self._is_number(name) or value is None or name == self.abscissa or self._is_automatic(name):
            return False
        if name == "obstacle_density":
            return self.values("obstacle_filling") == {"density"}  # In other arrays the density is a result.
        is_array = column["shapes_array"] and column.get("parameter_role") == "physics" and value != 0
        # The value to which `auto` evaluates if no contact angles are given.
        is_default = column.get("default") in (str(value), f"{value:g}") or (name, value) == ("wall_tension", 1)
        is_special = column.get("parameter_role") == "physics" and not is_default
        return is_array or is_special or (name == "vertices" and self.are_polygons)
