"""Finds the rows of a file that belong to the values of a search.

A row does not store the parameters as they were given, but as clogsweep resolved them. For instance, the density of a
saturated array follows from the gap, and the box of a lattice follows from its angle. So clogsweep itself resolves the
values of the search: `--points ... --dry-run` prints the columns in which the tasks differ. A row belongs to a value if
all its parameters are those that clogsweep gives to this value.
"""

from collections.abc import Callable, Sequence
from typing import Any

import pandas

from ..tools.errors import UserError
from ..tools.hints import Column

Values = tuple[float, ...]  # One value for each key.
# Returns the tasks of some values, one row each. Throws UserError if clogsweep refuses the values.
Resolve = Callable[[Sequence[Values]], pandas.DataFrame]
MOST_TASKS = 1000  # Largest number of tasks that clogsweep prints.


def tasks_of(printed: str) -> pandas.DataFrame:
    """The tasks that `clogsweep --dry-run` printed, as texts of the columns in which they differ. `-` means a missing
    value. @throws UserError  if clogsweep did not print all tasks"""
    lines = printed.splitlines()
    names = next((line[2:].split() for line in lines if line.startswith("# task ")), ["task"])
    tasks = pandas.DataFrame([line.split() for line in lines if line[:1].isdecimal()], columns=names, dtype=str)
    if any(line.endswith(" more ...") for line in lines):
        raise UserError("cannot refine over more than 1000 combinations of values; give every other key one value")
    return tasks


def like(tasks: pandas.DataFrame, rows: pandas.DataFrame) -> pandas.DataFrame:
    """Converts the texts of tasks to the types of the columns of `rows`."""
    def column(name: str) -> Any:
        if pandas.api.types.is_numeric_dtype(rows[name]):
            return [float("nan" if text == "-" else text) for text in tasks[name]]
        return tasks[name].replace("-", "")

    return pandas.DataFrame({name: column(name) for name in tasks if name in rows})


class Membership:
    """Finds the rows of each value of a search. @param schema  output of clogsweep --schema"""

    def __init__(self, keys: Sequence[str], schema: dict[str, list[Column]], candidates: Sequence[Values],
                 resolve: Resolve) -> None:
        """@throws UserError  if clogsweep refuses a candidate, for instance because two candidates mean the same run"""
        columns = schema["columns"]
        self._names = [column["name"] for column in columns if column["role"] == "parameter"
                       and column.get("parameter_role") != "ensemble" and column["name"] != "preset"]
        # Columns that may follow from other values: columns with automatic values, and columns that no key sets.
        self._following = {key["column"] for key in schema["keys"] if key["kind"] != "word" and key.get("words")}
        self._following |= {column["name"] for column in columns if "key" not in column}
        self._resolve, self._candidates, self._asked = resolve, list(candidates), set(candidates)
        tasks = resolve(self._candidates)
        if len(tasks) != len(self._candidates):
            raise UserError(f"cannot refine {','.join(keys)} (another key has a list of values) give one, and the next in a "
                            "command of its own, with the same --output")
        self._varying = [name for name in tasks if name in self._names]
        self._tables = [(self._candidates, tasks)]
        # Columns of the keys. Runs of values other than the candidates can be identified only if these columns contain
        # the values as they were given.
        self._key_columns = [next(key["column"] for key in schema["keys"] if key["key"] == name) for name in keys]
        self._shows_values = all(
            column in tasks and [float(text) for text in tasks[column].replace("-", "nan")] == [values[i] for values in self._candidates]
            for i, column in enumerate(self._key_columns))

    def of_curve(self, rows: pandas.DataFrame, deciding: Callable[[str], bool] = lambda _: True) -> pandas.DataFrame:
        """The rows that agree with the first run in all parameters that are the same for all candidates.
        @param deciding  tells whether a column has to agree
        @throws UserError  if the file does not contain the first run"""
        fixed = [name for name in self._names if name not in self._varying and deciding(name)]
        first = rows.loc[rows["task"] == 0, fixed]  # The run of the first point has the number 0.
        if first.empty:
            raise UserError("the file lacks the first run of its points; give another --output")
        return rows.merge(first, on=fixed)

    def of_values(self, rows: pandas.DataFrame) -> pandas.DataFrame:
        """The rows of the candidates and of other values in the file. An additional column `values` contains the value
        of each row."""
        if self._shows_values:
            near = self.of_curve(rows, lambda name: name not in self._following)
            given = set(near[self._key_columns].itertuples(index=False, name=None)) - self._asked
            self._asked |= given
            new = sorted(values for values in given if all(value > 0 for value in values))
            for begin in range(0, len(new), MOST_TASKS - len(self._candidates)):
                self._resolve_these(new[begin:begin + MOST_TASKS - len(self._candidates)])
        found = []
        for values, tasks in self._tables:
            fixed = [name for name in self._names if name not in tasks]
            first = rows.loc[rows["task"] == 0, fixed]
            asked = like(tasks[[name for name in self._names if name in tasks]], rows)
            found.append(rows.merge(first, on=fixed).merge(asked.assign(values=values), on=list(asked)))
        return pandas.concat(found).drop_duplicates("task").sort_values("task")

    def _resolve_these(self, new: list[Values]) -> None:
        """Resolves new values together with the candidates, so that the parameters common to all remain those of the
        first run."""
        values = self._candidates + new
        try:
            tasks = self._resolve(values)
        except UserError:  # clogsweep refuses one of the values, so the rows with this value come from other settings.
            tasks = pandas.DataFrame()
        if len(tasks) == len(values):
            self._tables.append((values, tasks))
        elif len(new) > 1:
            for one in new:
                self._resolve_these([one])
