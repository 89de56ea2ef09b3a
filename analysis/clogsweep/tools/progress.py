"""How far a script is, on the standard error: one line that is renewed on a terminal, now and then a new line elsewhere."""

import sys
import time
from collections.abc import Iterable, Iterator
from typing import TypeVar

Item = TypeVar("Item")


def readable_duration(seconds: float) -> str:
    """As clogsweep shows it: whole minutes alone would jump."""
    if seconds < 119.5:
        return f"{seconds:.0f} s"
    whole = round(seconds)
    return f"{whole // 60} min {whole % 60:02} s" if whole < 600 else f"{whole / 60:.0f} min"


def shown(items: Iterable[Item], what: str, total: int) -> Iterator[Item]:
    """Yields the items and tells after each, if it is time to, how many there have been and how long the rest takes."""
    on_terminal = sys.stderr.isatty()
    interval = 0.2 if on_terminal else 10
    begin = last = time.monotonic()
    for number, item in enumerate(items, start=1):
        yield item
        now = time.monotonic()
        if now - last >= interval:
            last = now
            text = f"{what} {number} of {total}, {readable_duration((now - begin) * (total / number - 1))} left"
            print(f"\r{text}\x1b[K" if on_terminal else text, end="" if on_terminal else "\n", file=sys.stderr, flush=True)
    if on_terminal:
        print("\r\x1b[K", end="", file=sys.stderr, flush=True)
