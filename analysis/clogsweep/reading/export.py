"""Writes rows of a sweep to files that other programs read."""

from __future__ import annotations

import pathlib
from typing import TYPE_CHECKING

import h5py

from ..tools import outputs
from ..tools.errors import UserError

if TYPE_CHECKING:
    import pandas


def file_of_droplets(path: pathlib.Path) -> pathlib.Path:
    """The file for the table of droplets. @param path  of the rows"""
    return path.with_name(f"{path.stem}-droplets{path.suffix}")


def refuse_unwritable(path: pathlib.Path) -> None:
    """@throws UserError  if the ending is unknown, or the file exists"""
    if path.suffix not in (".csv", ".h5"):
        raise UserError(f"cannot write {path} (it can only be .csv or .h5); give another ending")
    if path.exists():  # The file may be a sweep, or a table that the user made.
        raise UserError(f"will not overwrite {path} (it exists); give another name, or remove it first")


def write(table: pandas.DataFrame, path: pathlib.Path, source: str) -> None:
    """Writes the table.
    @param table  see stored.read_table()
    @param path  .csv: each column has a name followed by its unit in brackets; .h5: each column is a dataset with the
    attributes `unit` and `meaning`
    @param source  provenance of the rows
    @throws UserError"""
    units, meanings = table.attrs["units"], table.attrs["meanings"]
    with outputs.replaced(path) as fresh:
        if path.suffix == ".csv":
            table.rename(columns=lambda name: f"{name} [{units[name]}]" if units[name] else name).to_csv(fresh, index=False)
            return
        with h5py.File(fresh, "w") as file:
            file.attrs["source"] = source[:2**14]  # an attribute holds 64 kB at most
            for name, column in table.items():
                dataset = file.create_dataset(name, data=column.str.encode("utf-8").to_numpy("S") if column.dtype == object else column)
                dataset.attrs.update(unit=units[name], meaning=meanings[name])
