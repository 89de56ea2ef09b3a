"""Reads lists of numbers as clogsweep does. tests/sweep/value_lists.txt has test cases for both readers."""

import math
import re

NUMBER = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)(e[-+]?\d+)?", re.ASCII | re.IGNORECASE)
SPACED = re.compile(r"(lin|log)\(([^,()]*),([^,()]*),\s*(\d+)\s*\)", re.ASCII)
RANGE = re.compile(r"(-?\d+)\s*\.\.\s*(-?\d+)\s*(?::\s*(\d+))?", re.ASCII)
LONGEST = 1_000_000


def number(word: str) -> float:
    """The word as a finite number, or NaN."""
    value = float(word) if NUMBER.fullmatch(word.strip(" \t")) else math.nan
    return value if math.isfinite(value) else math.nan


def spaced(law: str, first: float, last: float, count: int) -> list[float]:
    """The first and the last number, and the numbers between them to twelve digits. NaN if there are none."""
    if not (1 <= count <= LONGEST and math.isfinite(first + last)) or (law == "log" and min(first, last) <= 0):
        return [math.nan]
    shares = [place / (count - 1) for place in range(1, count - 1)]
    between = [first + (last - first) * share if law == "lin" else first * (last / first) ** share for share in shares]
    return [first, *(float(f"{value:.12g}") for value in between), last][:count]


def numbers(text: str) -> list[float]:
    """A list of numbers as clogsweep reads it: `0.2,0.3`, `1..50`, `1..50:7`, `lin(a,b,n)`, `log(a,b,n)`. Other texts
    are NaN."""
    values: list[float] = []
    for word in re.split(r",(?![^()]*\))", text):
        word = word.strip(" \t")
        if found := SPACED.fullmatch(word):
            values += spaced(found[1], number(found[2]), number(found[3]), int(found[4]))
        elif found := RANGE.fullmatch(word):
            first, last, step = int(found[1]), int(found[2]), int(found[3] or 1)
            is_possible = step > 0 and first <= last <= first + step * LONGEST
            values += map(float, range(first, last + 1, step)) if is_possible else [math.nan]
        else:
            values.append(number(word))
    return values
