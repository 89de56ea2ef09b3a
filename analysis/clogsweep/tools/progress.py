"""Shows the progress of a script on the standard error. On a terminal this is one line that is redrawn. Elsewhere a new
line is printed from time to time."""

import sys
import time
from collections.abc import Callable, Iterable, Iterator
from typing import TypeVar

Item = TypeVar("Item")


def readable_duration(seconds: float) -> str:
    """A duration as clogsweep shows it. Below ten minutes it has seconds, because whole minutes would change too
    seldom."""
    if seconds < 119.5:
        return f"{seconds:.0f} s"
    whole = round(seconds)
    return f"{whole // 60} min {whole % 60:02} s" if whole < 600 else f"{whole / 60:.0f} min"


class StatusLine:
    def __init__(self) -> None:
        self.on_terminal = sys.stderr.isatty()
        self.begin = self.last = time.monotonic()

    def redraw(self, text: Callable[[float], str]) -> None:
        """Shows a new text if the last one is old enough. @param text  makes the text from the seconds since the
        beginning"""
        now = time.monotonic()
        if now - self.last >= (0.2 if self.on_terminal else 10):
            self.last = now
            shown = text(now - self.begin)
            print(f"\r{shown}\x1b[K" if self.on_terminal else shown, end="" if self.on_terminal else "\n",
                  file=sys.stderr, flush=True)

    def wipe(self) -> None:
        if self.on_terminal:
            print("\r\x1b[K", end="", file=sys.stderr, flush=True)


def shown(items: Iterable[Item], what: str, total: int) -> Iterator[Item]:
    """Yields the items. From time to time it shows the number of finished items and the remaining time."""
    line = StatusLine()
    for number, item in enumerate(items, start=1):
        yield item
        line.redraw(lambda seconds: f"{what} {number} of {total}, "
                    f"{readable_duration(seconds * (total / number - 1))} left")
    line.wipe()
