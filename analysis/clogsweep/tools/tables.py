"""Reads tables of spreadsheets, line by line. The programs read tables by the same rules (src/console/csv.cpp)."""

from __future__ import annotations

import contextlib
import csv
import math
import os
import pathlib
import re
import stat
from collections.abc import Iterator, Sequence

from .errors import UserError

# Errors that spreadsheets write instead of a value: #N/A, #DIV/0!, #REF!, #WERT!, Err:502, and those of other languages.
ERROR_WORD = re.compile(r"#[^\sa-z]{2,}\s*[!?]|(?i:#(n/a|na|nv|n/d|n/b|i/t|н/д|yok|hiányzik|getting_data))|(?i:(err|fehler|erreur):[0-9]+)")
HASHES = re.compile("##+")  # Excel writes ### into the cells of a column that is too narrow.


def read_text(path: str) -> str:
    """Reads a text in UTF-8, UTF-16 or Latin-1. @throws UserError"""
    try:
        mode = os.stat(path).st_mode
        if not stat.S_ISREG(mode) and not stat.S_ISFIFO(mode):
            raise UserError(f"cannot read {path} (a folder, device or socket, neither a file nor a pipe); "
                            "give another name")
        content = pathlib.Path(path).read_bytes()
    except OSError as error:
        raise UserError(f"cannot read {path} ({(error.strerror or str(error)).lower()}); "
                        "check name and permissions") from error
    for encoding in ("utf-16",) if content.startswith((b"\xff\xfe", b"\xfe\xff")) else ("utf-8-sig", "latin-1"):
        with contextlib.suppress(UnicodeDecodeError):
            return content.decode(encoding)
    raise UserError(f"cannot read {path} (damaged UTF-16); give a text file")


def cells_of(line: str, separator: str) -> list[str]:
    """The cells of a line, without quotes and blanks around them. @throws csv.Error"""
    words = " ".join(line.split()) if separator == " " else line
    return [cell.strip() for cell in next(csv.reader([words], delimiter=separator, skipinitialspace=True, strict=True))]


def refuse(cell: str, number: int) -> None:
    """@param number  of the cell in its line, from 1. @throws UserError"""
    raise UserError(f"column {number} is '{cell}', an error of a spreadsheet; "
                    "correct this cell, or begin comments with '# '")


def refuse_lost_line(comment: str, separator: str) -> None:
    """@param separator  of the table, or "" if no line of the table precedes this line
    @throws UserError  if a line that begins with # is a line of the table, and its first cell is an error of a
    spreadsheet"""
    ends = '"' if comment.startswith('"') else {"": "[,;\t]", " ": "\\s"}.get(separator, re.escape(separator))
    cell = re.split(ends, comment.removeprefix('"'))[0].strip()
    for word in [cell, *(cell.split()[:1] if separator in ("", " ") else [])]:
        if ERROR_WORD.fullmatch(word):
            refuse(word, 1)
    if separator != " " and HASHES.fullmatch(cell) and cell != comment:
        refuse(cell, 1)


class Numbers:
    """Reads the numbers of one table. The numbers may have decimal commas unless commas separate the cells."""

    def __init__(self) -> None:
        self._are_decimal = False
        self._ambiguous = ""  # The first number whose comma may separate thousands, such as 1,350.
        self._first: dict[str, str] = {}  # The first number with a comma, and the first with a point.

    def read(self, cell: str, column: str) -> float:
        """The number in a cell. @throws UserError  that names the column, also if some numbers so far have a comma, and
        others a point"""
        for mark in ",.":
            if mark in cell:
                self._first.setdefault(mark, cell)
        if len(self._first) == 2:
            words = {",": "comma", ".": "point"}
            own, other = (",", ".") if "," in cell else (".", ",")
            raise UserError(f"{column}: '{cell}' may have a decimal comma or separated thousands; "
                            "write all numbers with decimal points and without commas" if other in cell else
                            f"{column}: '{cell}' has a {words[own]}, but '{self._first[other]}' above has "
                            f"a {words[other]}; write all numbers of the file with decimal points, and without commas")
        if "," in cell:
            is_ambiguous = re.fullmatch(r"[+-]?[1-9]\d{0,2}(,\d{3})+", cell)
            self._are_decimal = self._are_decimal or not is_ambiguous
            self._ambiguous = self._ambiguous or (cell if is_ambiguous else "")
        try:
            value = float(cell.replace(",", ".", 1))
        except ValueError:
            value = math.nan
        if not math.isfinite(value):
            raise UserError(f"{column}: '{cell}' is not a finite number")
        return value

    def check(self, path: str) -> None:
        """Call this after the last line. @throws UserError  if each comma may separate thousands"""
        if self._ambiguous and not self._are_decimal:
            raise UserError(f"{path}: '{self._ambiguous}' may have a decimal comma or separated thousands; "
                            "write all numbers with decimal points and without commas")


def rows(path: str) -> Iterator[tuple[int, list[str]]]:
    """Yields the number and the cells of each line, apart from blank lines and those that begin with #.
    @throws UserError  that names file and line, also for a cell that is an error of a spreadsheet"""
    separator = ""
    for number, line in enumerate(read_text(path).replace("\xa0", " ").splitlines(), 1):
        text = line.strip()
        if not text:
            continue
        if not separator and line.startswith("sep="):
            separator = line[4:5]
            continue
        try:
            if text.startswith(("#", '"#')):
                refuse_lost_line(text, separator)
                continue
            separator = separator or next((letter for letter in ";\t," if letter in line), " ")
            cells = cells_of(line, separator)
            for place, cell in enumerate(cells, 1):
                if ERROR_WORD.fullmatch(cell) or HASHES.fullmatch(cell):
                    refuse(cell, place)
        except (UserError, csv.Error) as error:
            raise UserError(f"{path} line {number}: {error}") from error
        yield number, cells


def quantity(title: str) -> str:
    """The quantity of a column. @param title  with or without a unit, such as h [mm]"""
    return title.partition("[")[0].strip()


def columns_of(titles: Sequence[str]) -> dict[str, int]:
    """The places of the columns by their quantities. Columns without a title are left out.
    @throws UserError  if two columns have the same quantity, in whatever units"""
    found: dict[str, int] = {}
    for place, title in enumerate(titles):
        name = quantity(title)
        if name and found.setdefault(name, place) != place:
            raise UserError(f"there are two columns for {name}, '{titles[found[name]]}' and '{title}'; delete one")
    return found


def refuse_misread(path: str | os.PathLike[str]) -> None:
    """Call this before pandas reads the table. pandas treats errors of spreadsheets as comments or missing values, and
    renames the second of two columns with the same name. @throws UserError"""
    for index, (number, cells) in enumerate(rows(os.fspath(path))):
        if index == 0:
            try:
                columns_of(cells)
            except UserError as error:
                raise UserError(f"{path} line {number}: {error}") from error
