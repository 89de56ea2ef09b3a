"""Makes text from outside safe for terminals, pages and pictures. Such text includes names of files, attributes, and
words of a table."""

import difflib
from collections.abc import Iterable


def escaped(letter: str) -> str:
    """A character as an escape. In Python, a byte that is not UTF-8 appears as a lone surrogate."""
    return f"\\x{ord(letter) - 0xdc00:02x}" if "\udc80" <= letter <= "\udcff" else letter.encode("unicode_escape").decode()


def printable(text: object, kept: str = "") -> str:
    """The text with escapes for control characters and for bytes that are not UTF-8. @param kept  characters that are
    not escaped, such as line breaks"""
    return "".join(letter if letter.isprintable() or letter in kept else escaped(letter) for letter in str(text))


def literal(text: object) -> str:
    """Printable text for matplotlib. Dollars are escaped, because matplotlib would read text between two dollars as a
    formula."""
    return printable(text, "\n").replace("$", r"\$")


def did_you_mean(word: str, names: Iterable[str]) -> str:
    """The end of a message about a mistyped word, or an empty text if no known name is similar."""
    near = difflib.get_close_matches(word, names, 1)
    return f"; did you mean {near[0]}?" if near else ""
