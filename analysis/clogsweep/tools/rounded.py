"""Writes numbers as text. A count is followed by its noun. Other numbers have as many figures as their uncertainty
allows, but at least three."""

import math
from typing import TypeGuard

LEAST_FIGURES = 3
MOST_FIGURES = 8


def is_number(value: float | None) -> TypeGuard[float]:
    return value is not None and math.isfinite(value)


def exponent(value: float) -> int:
    """The power of ten of the first significant digit."""
    return math.floor(math.log10(abs(value))) if value else 0


def plain(value: float | None, figures: int = LEAST_FIGURES) -> str:
    """The number as text. @param value  None, and values that are not finite, become a dash"""
    if not is_number(value):
        return "-"
    rounded = float(f"{value:.{figures - 1}e}")
    if rounded and not -5 < exponent(rounded) < 6:
        return f"{value:.{figures - 1}e}"
    return f"{rounded:.{max(0, figures - 1 - exponent(rounded))}f}"


def count_text(number: int, noun: str) -> str:
    """A number and its noun, such as 1 run, 2 runs."""
    return f"{number} {noun}" if number == 1 else f"{number} {noun}s"


def with_interval(value: float, lower: float, upper: float) -> str:
    """Text such as 223 (102 to 585). The narrower side of the interval has two significant digits, but each number has
    at least three."""
    side = min(value - lower, upper - value)
    figures = exponent(value) - exponent(side) + 2 if side > 0 else LEAST_FIGURES
    figures = min(max(figures, LEAST_FIGURES), MOST_FIGURES)
    return f"{plain(value, figures)} ({plain(lower, figures)} to {plain(upper, figures)})"


def with_error(value: float | None, error: float | None) -> str:
    """Text such as 0.379 ± 0.012. The error has two significant digits, and the value has at most eight."""
    if not is_number(value) or not is_number(error) or error <= 0:
        return plain(value)
    decimals = max(0, 1 - exponent(float(f"{error:.1e}")))
    if decimals > MOST_FIGURES - 1 - exponent(value):
        return f"{plain(value, MOST_FIGURES)} ± {plain(error, 2)}"
    return f"{value:.{decimals}f} ± {error:.{decimals}f}"
