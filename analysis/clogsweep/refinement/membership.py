"""Which rows of a file belong to the values of a search.

A row stores resolved parameters, not the given ones: the density of a saturated array follows from the gap, the box of
a lattice from its angle. So clogsweep itself resolves the values (`--points ... --dry-run` prints the columns in which
its tasks differ). A row belongs to a value if all its parameters are those that clogsweep gives to this value; no
single column decides.
"""

from collections.abc import Callable, Sequence
from typing import Any

import pandas

from ..tools.errors import UserError
from ..tools.hints import Column

Values = tuple[float, ...]  # one value for each key
Resolve = Callable[[Sequence[Values]], pandas.DataFrame]  # returns the tasks of some values, one row each; throws UserError if clogsweep refuses them
MOST_TASKS = 1000  # largest number that clogsweep prints


def tasks_of(printed: str) -> pandas.DataFrame:
    """The tasks that `clogsweep --dry-run` printed, with the texts of the columns in which they differ; `-` means a
    missing value. @throws UserError  if it did not print all tasks"""
    lines = printed.splitlines()
    names = next((line[2:].split() for line in lines if line.startswith("# task ")), ["task"])
    tasks = pandas.DataFrame([line.split() for line in lines if line[:1].isdecimal()], columns=names, dtype=str)
    if any(line.endswith(" more ...") for line in lines):
        raise UserError("cannot refine over more than 1000 combinations of values; give every other key one value")
    return tasks


def like(tasks: pandas.DataFrame, rows: pandas.DataFrame) -> pandas.DataFrame:
    """Converts the texts of tasks to values with the types of the rows' columns."""
    def column(name: str) -> Any:
        if pandas.api.types.is_numeric_dtype(rows[name]):
            return [float("nan" if text == "-" else text) for text in tasks[name]]
        return tasks[name].replace("-", "")

    return pandas.DataFrame({name: column(name) for name in tasks if name in rows})


class Membership:
    """Finds the rows of each value. @param schema  output of clogsweep --schema"""

    def __init__(self, keys: Sequence[str], schema: dict[str, list[Column]], candidates: Sequence[Values],
                 resolve: Resolve) -> None:
        """@throws UserError  if clogsweep refuses one of the candidates, as it does if two of them mean the same run"""
        columns = schema["columns"]
        self._names = [column["name"] for column in columns if column["role"] == "parameter"
                       and column.get("parameter_role") != "ensemble" and column["name"] != "preset"]
        # Columns that may follow from other values: those with automatic values, and those that no key sets.
        self._following = {key["column"] for key in schema["keys"] if key["kind"] != "word" and key.get("words")}
        self._following |= {column["name"] for column in columns if "key" not in column}
        self._resolve, self._candidates, self._asked = resolve, list(candidates), set(candidates)
        tasks = resolve(self._candidates)
        if len(tasks) != len(self._candidates):
            raise UserError(f"cannot refine {','.join(keys)} (another key has a list of values) give one, and the next in a "
                            "command of its own, with the same --output")
        self._varying = [name for name in tasks if name in self._names]
        self._tables = [(self._candidates, tasks)]
        # Columns of the keys. Only if they contain the values as given can runs of other values be identified.
        self._key_columns = [next(key["column"] for key in schema["keys"] if key["key"] == name) for name in keys]
        self._shows_values = all(
            column in tasks and [float(text) for text in tasks[column].replace("-", "nan")] == [values[i] for values in self._candidates]
            for i, column in enumerate(self._key_columns))

    def of_curve(self, rows: pandas.DataFrame, deciding: Callable[[str], bool] = lambda _: True) -> pandas.DataFrame:
        """The rows that agree with the first run in all parameters that are the same for all candidates.
        @param deciding  tells whether a column has to agree. @throws UserError  if the file lacks the first run"""
        fixed = [name for name in self._names if name not in self._varying and deciding(name)]
        first = rows.loc[rows["task"] == 0, fixed]  # the first point's run has number 0
        if first.empty:
            raise UserError("the file lacks the first run of its points; give another --output")
        return rows.merge(first, on=fixed)

    def of_values(self, rows: pandas.DataFrame) -> pandas.DataFrame:
        """The rows of the candidates, and of other values in the file, with an additional column `values`."""
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
        """Resolves values together with the candidates, so that common parameters are those of the first run."""
        values = self._candidates + new
        try:
            tasks = self._resolve(values)
        except UserError:  # clogsweep refuses one of the values, so its rows come from other settings
            tasks = pandas.DataFrame()
        if len(tasks) == len(values):
            self._tables.append((values, tasks))
        elif len(new) > 1:
            for one in new:
                self._resolve_these([one])
