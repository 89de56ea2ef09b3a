"""Finds the rows of a file that belong to the values of a search.

A row does not store the parameters as they were given, but as clogsweep resolved them. For instance, the density of a
saturated array follows from the gap, and the box of a lattice follows from its angle. For this reason clogsweep itself
resolves the values of the search: `--points ... --dry-run --format json` prints the columns in which the tasks differ.
A row belongs to a value if all parameters of the row equal those that clogsweep resolves for this value.
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


def tasks_of(plan: dict[str, Any]) -> pandas.DataFrame:
    """The columns in which the tasks of a plan differ. @param plan  first line of `clogsweep --dry-run --format json`
    @throws UserError  if clogsweep refuses the values, or if the line does not have all tasks"""
    if "refused" in plan:
        raise UserError(plan["text"])
    if len(plan["tasks"]) < plan["number_of_tasks"]:
        raise UserError("cannot refine over more than 1000 combinations of values; give every other key one value")
    return pandas.DataFrame(plan["tasks"])


def like(tasks: pandas.DataFrame, rows: pandas.DataFrame) -> pandas.DataFrame:
    """Converts tasks to the types of the columns of `rows`, in which a missing value is NaN or an empty text."""
    are_numbers = pandas.api.types.is_numeric_dtype
    return pandas.DataFrame({name: tasks[name].astype(float) if are_numbers(rows[name]) else tasks[name].fillna("")
                             for name in tasks if name in rows})


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
        self._shows_values = all(column in tasks and list(tasks[column]) == [values[i] for values in self._candidates]
                                 for i, column in enumerate(self._key_columns))

    def of_curve(self, rows: pandas.DataFrame, deciding: Callable[[str], bool] = lambda _: True) -> pandas.DataFrame:
        """The rows that agree with the first run in all parameters that are equal for all candidates.
        @param deciding  returns whether a column has to agree
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
