"""The fit of a sweep, with a table and with curves of lengths and speeds."""

from __future__ import annotations

import html
import json
import pathlib
from typing import TYPE_CHECKING, Any

from ..labels.groups import Groups
from ..reading import fits, programs, stored
from ..tools import checked, rounded
from ..tools.errors import UserError

if TYPE_CHECKING:
    import pandas

    from ..style import Picture

LENGTHS = ("runs", "clogs", "clogging_length", "clogging_length_lower", "clogging_length_upper",
           "clogging_length_met", "relative_speed_all",
           "relative_speed_all_error", "lateral_slope", "tension_mN_per_m", "clogging_length_mm",
           "speed_mm_per_s", "time_to_clog_s", "doubts")
PASSAGE = ("status", "largest_shape_parameter", "smallest_relative_speed", "largest_relative_speed",
           "sag", "top_sag", "doubts")
HDF5_BEGINNING = b"\x89HDF\r\n\x1a\n"


class Fit:
    """The results of clogfit: clogging lengths and mean speeds, with a group for each set of parameters.

    `groups` is a table with a row for each group. The columns are those of clogfit: the clogging length and its
    interval in droplet diameters, numbers of clogs by mechanism, doubts, and all parameters. `units` has the unit of
    each column. Groups of fewer than three runs have no mean speed.
    """

    def __init__(self, output: dict[str, Any], circle_files: dict[str, str] | None = None) -> None:
        """@param output  the JSON output of clogfit; @param circle_files  see stored.circle_files(). @throws KeyError,
        TypeError  if `output` does not come from clogfit"""
        self.output = output
        self.confidence: float = output["confidence"]
        self.units: dict[str, str] = output["units"]
        self.doubts: dict[str, str] = output["doubts"]
        self.known = Groups(output, circle_files)

    @property
    def source(self) -> str:
        """The provenance of the rows, their number, and the program that fitted them. Files of older programs state no
        provenance."""
        sweep = self.output.get("sweep", {})
        lines = [stored.source(sweep) if sweep else "", sweep.get("config", "").strip(),
                 f"{self._counted()}, fitted by clogfit {stored.writer(self.output)}"]
        return "\n".join(filter(None, lines))

    def _counted(self) -> str:
        groups = self.output["groups"]
        return f"{rounded.count_text(sum(group.get('runs', 1) for group in groups), 'run')} in {rounded.count_text(len(groups), 'group')}"

    @property
    def groups(self) -> pandas.DataFrame:
        """The results of each group that are single numbers or words. P(r) and incidences are in survival() and
        `output` instead."""
        import pandas

        flat = [{name: value for name, value in group.items() if not isinstance(value, list | dict)}
                for group in self.output["groups"]]
        return pandas.DataFrame(flat)

    def survival(self, group: int) -> pandas.DataFrame:
        """P(r) of a group: the probability that a droplet travels farther than r without a clog. The argument is the
        index of the group in `groups`.

        The first row is for r = 0, with P = 1, or for the first clog if droplets clogged upstream of their release. One row follows for each `distance` r at which droplets clogged [sigma].
        If runs went beyond the last clog, the last row is for the longest distance. `at_risk` is the number of runs
        that reached r, and `clogs` the number of them that clogged there. `probability` is P just beyond r, with its
        `standard_error` (Greenwood) and the ends of its interval, `lower` and `upper`. The error and both ends are NaN
        where P is 0, and where no droplet clogged.
        @throws UserError  if there is no such group or no P(r)"""
        import pandas

        checked.whole("group", group, 0)
        if group >= len(self.output["groups"]):
            raise UserError(f"no group {group}; there are {len(self.output['groups'])}, the first is 0")
        self.known.with_lengths()
        fitted = self.output["groups"][group]
        first = min((step["distance"] for step in fitted["survival"]), default=0.0)
        start = {"distance": min(0.0, first), "at_risk": fitted["runs"], "clogs": 0,
                 "probability": 1.0, "standard_error": 0.0, "lower": 1.0, "upper": 1.0}
        steps = [start, *fitted["survival"]]
        beyond = [distance for distance in fitted["censored_distances"] if distance > steps[-1]["distance"]]
        if beyond:
            at_end = steps[-1] if fitted["survival"] else start | dict.fromkeys(("lower", "upper"))
            steps.append(at_end | {"distance": max(beyond), "at_risk": beyond.count(max(beyond)), "clogs": 0})
        return pandas.DataFrame(steps)

    def curve(self) -> Picture:
        """Draws the clogging lengths against the parameter that the sweep varies. For lattices it draws the lateral
        displacement divided by the distance. @throws UserError  if there are none"""
        from .. import style  # This module is slow to load, like all modules that draw.
        from ..drawing import curve

        return style.Picture(style.figure_of(curve.draw_on, self.known.with_lengths()), self.source)

    def speeds(self) -> Picture:
        """Draws the mean speeds divided by the terminal speed, against the parameter that the sweep varies.
        @throws UserError  if there are none"""
        from .. import style
        from ..drawing import lengths

        return style.Picture(style.figure_of(lengths.draw_speeds_on, self.known.with_lengths()), self.source)

    @property
    def summary(self) -> pandas.DataFrame:
        """A part of `groups`: the parameters that vary, lengths and speeds (or the results in a channel or on a wall),
        and doubts."""
        known, columns = self.groups, list(self.known.columns)
        # Automatic values follow from these parameters, so they are left out.
        chosen = {self.known.abscissa, *self.known.curve_parameters()}
        varies = [name for name in columns if name in chosen and known[name].nunique(dropna=False) > 1]
        of_kind = [*(() if self.known.are_passages else LENGTHS), *(PASSAGE if "status" in known else ())]
        results = [name for name in of_kind if name in known and not known[name].isna().all()]
        return known[[*varies, *(name for name in results if name not in varies)]]

    def __repr__(self) -> str:
        return f"<fit of {self._counted()}>"

    def _repr_html_(self) -> str:
        return f"<p>{html.escape(repr(self)[1:-1])}; all {len(self.groups.columns)} columns are in <code>groups</code></p>{self.summary._repr_html_()}"


def read(path: pathlib.Path, folder: pathlib.Path | None, *options: object) -> Fit:
    """Reads the fit of a sweep. @param path  of a sweep, or of clogfit's JSON; @param folder  of the programs;
    @param options  of clogfit, for a sweep. @throws UserError, ProgramFailed"""
    try:
        content = path.read_bytes()
    except FileNotFoundError as error:
        raise UserError(f"cannot read {path} (no such file); check the name") from error
    except OSError as error:
        raise UserError(f"cannot read {path} ({error.strerror}); "
                        "give a sweep, or the output of clogfit --format json") from error
    if content.startswith(HDF5_BEGINNING):
        clogfit = programs.programs_in(folder) / "clogfit"
        fit = Fit(*fits.fitted(clogfit, path, *options))
        fit.known.fit_curves(path, clogfit.parent)
        return fit
    try:
        return Fit(json.loads(content))
    except ValueError as error:
        raise UserError(f"cannot read {path} (neither HDF5 nor JSON); "
                        "give a sweep, or the output of clogfit --format json") from error
    except (KeyError, TypeError) as error:
        raise UserError(f"cannot read {path} (JSON, but not of clogfit); "
                        "give a sweep, or the output of clogfit --format json") from error
