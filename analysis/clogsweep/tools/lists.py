"""Reads lists of numbers as clogsweep does."""

import math
import re

import numpy as np

SPACED = re.compile(r"(lin|log)\(([^,()]+),([^,()]+),\s*(\d+)\s*\)")


def number(word: str) -> float:
    """The word as a number, or NaN."""
    try:
        return float(word)
    except ValueError:
        return math.nan


def numbers(text: str) -> list[float]:
    """A list of numbers as clogsweep reads it: `0.2,0.3`, `1..50`, `1..50:7`, `lin(a,b,n)`, `log(a,b,n)`. Other texts
    are NaN."""
    values: list[float] = []
    for word in map(str.strip, re.split(r",(?![^()]*\))", text)):
        if spaced := SPACED.fullmatch(word):
            first, last, count = float(spaced[2]), float(spaced[3]), int(spaced[4])
            between = np.linspace(first, last, count) if spaced[1] == "lin" else np.geomspace(first, last, count)
            values += [float(f"{value:.12g}") for value in between]
        elif whole := re.fullmatch(r"(\d+)\.\.(\d+)(?::(\d+))?", word):
            values += map(float, range(int(whole[1]), int(whole[2]) + 1, int(whole[3] or 1)))
        else:
            values.append(number(word))
    return values
