"""Values of the CSS properties that decide where a shape is, and whether it is visible."""

from __future__ import annotations

import re
from collections.abc import Collection

from .libraries import library

PACKAGE = "python3-cssselect2"
NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:e[-+]?\d+)?"
FUNCTION = r"[a-z-]+\(.*\)"
LENGTH = rf"{NUMBER}(?:[a-z]+|%)|[-+]?0+\.?0*|{FUNCTION}"
NOT_NEGATIVE = rf"(?!-\s*[.0]*[1-9])(?:{LENGTH})"
ANYTHING = r".*"
PAINTS = ("fill", "stroke", "color")
OPACITIES = ("opacity", "fill-opacity", "stroke-opacity")
SIZES = ("width", "height", "r", "rx", "ry")
# What a style sheet may say about each property.
FORMS = {
    "display": r"none|contents|(?:inline-)?(?:block|flex|grid|table)|inline|flow-root|list-item|run-in|compact|marker|ruby|table-[a-z-]+", "visibility": "visible|hidden|collapse",
    "overflow": "(?:visible|hidden|scroll|auto|clip)(?: (?:visible|hidden|scroll|auto|clip))?", "fill-rule": "nonzero|evenodd", "clip-rule": "nonzero|evenodd",
    "stroke-width": rf"(?!-)(?:{NUMBER}|{LENGTH})", "clip-path": rf"none|{ANYTHING}\({ANYTHING}\){ANYTHING}", "mask": ANYTHING, "transform": ANYTHING, "transform-origin": ANYTHING,
    "transform-box": ANYTHING, "d": rf"none|path\({ANYTHING}\)", **dict.fromkeys(("x", "y", "cx", "cy"), LENGTH), **dict.fromkeys(SIZES, rf"auto|{NOT_NEGATIVE}"),
    # The library that reads drawings does not know these.
    **dict.fromkeys(("translate", "rotate", "scale"), "none"), **dict.fromkeys((*PAINTS, *OPACITIES), ANYTHING)}
# What an attribute may say that a style sheet may not: numbers without units. Other lengths are refused elsewhere.
OF_ATTRIBUTES = {**dict.fromkeys(("d", "x", "y", "cx", "cy", "translate", "rotate", "scale"), ANYTHING), **dict.fromkeys(SIZES, rf"(?!-\s*[.0]*[1-9]){ANYTHING}")}
# The first values of properties that parts of a group inherit from it.
INHERITED = {"visibility": "visible", "color": "black", "fill": "black", "fill-opacity": "1", "fill-rule": "nonzero", "stroke": "none", "stroke-opacity": "1", "stroke-width": "1", "clip-rule": "nonzero"}


def value_of(name: str, text: str, ids: Collection[str], in_attribute: bool) -> str | None:
    """The value of a property in the words of the library that reads drawings. Empty if the property is that of the
    group around, or as if it were not given. None if the property has no such value.
    @param ids  of the elements of the drawing, for paints such as url(#gradient)"""
    word = text.strip()
    if word.lower() in ("unset", "revert", "revert-layer") or word.lower() == "inherit" and name in INHERITED:
        return ""
    if word.lower() == "initial":
        return INHERITED.get(name, "")
    form = (OF_ATTRIBUTES if in_attribute else {}).get(name) or FORMS[name]
    if word.lower() == "inherit" or re.fullmatch(form, word, re.IGNORECASE | re.DOTALL) is None:
        return None
    if name in PAINTS:
        return paint(word, ids)
    if name in OPACITIES:
        return opacity(word)
    path = re.fullmatch(r"path\(\s*(?:\w+\s*,\s*)?[\"'](.*)[\"']\s*\)", word, re.DOTALL) if name == "d" else None
    return path[1] if path else word if "(" in word or name == "d" else word.lower()


def opacity(word: str) -> str | None:
    """A number from 0 to 1."""
    found = re.fullmatch(rf"({NUMBER})(%?)", word, re.IGNORECASE)
    return repr(min(max(float(found[1]) / (100 if found[2] else 1), 0.0), 1.0)) if found else None


def paint(word: str, ids: Collection[str]) -> str | None:
    """A colour, or none. Gradients and patterns are black."""
    link = re.fullmatch(r"url\(\s*[\"']?#?(.*?)[\"']?\s*\)\s*(.*)", word, re.IGNORECASE | re.DOTALL)
    if link:
        return "black" if link[1] in ids else paint(link[2], ids) if link[2] else "none"
    if word.lower() in ("none", "context-fill", "context-stroke"):
        return "none"  # The context is that of a marker, and markers are not drawn.
    colour = library("tinycss2.color3", PACKAGE).parse_color(word)
    return colour if colour is None or colour == "currentColor" else "#" + "".join(f"{round(255 * part):02x}" for part in colour)
