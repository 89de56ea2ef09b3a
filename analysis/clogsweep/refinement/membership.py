"""Which rows of a file belong to the values that a search asks for.

A row stores resolved parameters, not what was asked for: the density of a saturated array follows from the gap, the
box of a lattice from its angle. So clogsweep itself resolves the values (`--points ... --dry-run` prints what its
tasks differ in), and a row belongs to a value if it has exactly the parameters that clogsweep gives that value. No
column is taken for the value of a key, and none decides alone.
"""

import math
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from ..tools.errors import UserError
from ..tools.hints import Column, Records
from .candidates import number_text

Values = tuple[float, ...]  # one of each key
Resolved = dict[str, str]  # names and texts of the columns in which tasks differ
ROUNDED = {"lattice-angle": 0.1}  # clogsweep moves these values to the nearest one that is possible, within so much
MOST_TASKS = 900  # clogsweep prints no more than 1000


def resolved_tasks(table: str) -> list[Resolved]:
    """The tasks that `clogsweep --dry-run` printed, in order: columns that differ between them."""
    lines = table.splitlines()
    names = next((line[2:].split() for line in lines if line.startswith("# task")), [])
    return [dict(zip(names, line.split(), strict=True)) for line in lines if line[:1].isdecimal()]


def _equals(column: Any, text: str) -> Any:
    """Which entries of a column mean the same as the text of a dry run, in which `-` is an unset value."""
    if column.dtype.kind == "S":
        return column == (b"" if text == "-" else text.encode())
    value = _number(text)
    return np.isnan(column) if math.isnan(value) else column == value


def _number(text: str) -> float:
    return math.nan if text == "-" else float(text)


class Membership:
    """Rows by value. @param schema  of clogsweep --schema
    @param resolve  gives clogsweep's tasks for some values, one each; UserError if it refuses one"""

    def __init__(self, keys: Sequence[str], schema: dict[str, list[Column]], candidates: Sequence[Values],
                 resolve: Callable[[Sequence[Values]], list[Resolved]]) -> None:
        """@throws UserError  if two values mean the same runs"""
        columns = schema["columns"]
        self._columns = [column["name"] for column in columns if column["role"] == "parameter"
                         and column.get("parameter_role") != "ensemble" and column["name"] != "preset"]
        # Values that may follow from others: automatic ones, and what no key sets directly.
        self._following = {key["column"] for key in schema["keys"] if key["kind"] != "word" and key.get("words")}
        self._following |= {column["name"] for column in columns if "key" not in column}
        self._resolve = resolve
        self._candidates = list(candidates)
        self._asked = set(self._candidates)
        self._known: list[tuple[list[Values], list[Resolved]]] = [(self._candidates, resolve(self._candidates))]
        tasks = self._known[0][1]
        if len(tasks) != len(candidates):
            raise UserError(f"cannot refine {','.join(keys)} (some of its values mean the same runs); list values in a sweep")
        seen: dict[tuple[str, ...], Values] = {}
        for values, task in zip(candidates, tasks, strict=True):
            varying = tuple(text for name, text in task.items() if name in self._columns)
            if varying in seen:
                one, other = (",".join(map(number_text, each)) for each in (seen[varying], values))
                raise UserError(f"cannot refine {','.join(keys)} (its values {one} and {other} mean the same runs); "
                                "choose a key that the settings use")
            seen[varying] = values
        # Columns that hold the values as they were given; a key without one is known at its candidates only.
        self._key_columns = [self._column_of(key, i, columns) for i, key in enumerate(keys)]

    def _column_of(self, key: str, index: int, columns: Sequence[Column]) -> str:
        names = [column["name"] for column in columns if column.get("key") == key] or [key.replace("-", "_")]
        off = ROUNDED.get(key, 0.0)
        holds = all(abs(_number(task.get(names[0], "-")) - values[index]) <= off
                    for values, task in zip(self._candidates, self._known[0][1], strict=True))
        return names[0] if holds else ""

    def values_of(self, rows: Records) -> list[Values | None]:
        """The values that each row belongs to. Row of task 0: one that was asked for, as clogsweep numbers those of
        its points first. @throws UserError  if there is none"""
        first = np.flatnonzero(rows["task"] == 0)
        if first.size == 0:
            raise UserError("the file lacks the first run of the points that were asked for; remove the file beside the output")
        reference = rows[first[0]]
        found: list[Values | None] = [None] * len(rows)
        self._resolve_more(rows, reference)
        for all_values, tasks in self._known:
            varying = [name for name in tasks[0] if name in self._columns]
            same = self._agree(rows, reference, set(varying))
            for values, task in zip(all_values, tasks, strict=True):
                here = same.copy()
                for name in varying:
                    here &= _equals(rows[name], task[name])
                for i in np.flatnonzero(here):
                    found[i] = values
        return found

    def _agree(self, rows: Records, reference: np.void, varying: set[str]) -> Any:
        """Rows that agree with the reference in all other parameters."""
        same = rows["model_version"] == reference["model_version"]
        for name in self._columns:
            if name not in varying:
                value = reference[name]
                same &= np.isnan(rows[name]) if rows.dtype[name].kind == "f" and math.isnan(value) else rows[name] == value
        return same

    def _resolve_more(self, rows: Records, reference: np.void) -> None:
        """Has clogsweep resolve values that are in rows of an earlier sweep only."""
        if not all(self._key_columns):
            return
        varying = {name for name in self._known[0][1][0]}
        near = self._agree(rows, reference, varying | self._following)
        given = {tuple(float(rows[name][i]) for name in self._key_columns) for i in np.flatnonzero(near)}
        new = sorted(values for values in given - self._asked if all(0 < value < math.inf for value in values))
        self._asked |= given
        step = MOST_TASKS - len(self._candidates)
        for begin in range(0, len(new), step):
            self._resolve_these(new[begin:begin + step])

    def _resolve_these(self, new: list[Values]) -> None:
        """Together with the candidates, so that what all have in common is what the reference row has."""
        try:
            tasks = self._resolve(self._candidates + new)
        except UserError:  # clogsweep refuses one of them: its rows are of other settings
            if len(new) > 1:
                for one in new:
                    self._resolve_these([one])
            return
        if len(tasks) == len(self._candidates) + len(new):
            self._known.append((self._candidates + new, tasks))
