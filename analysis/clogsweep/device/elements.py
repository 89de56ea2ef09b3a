"""Prepares the elements of an SVG for the library that reads it: replaces <use>, lengths with units, and
transform-origin, which the library reads wrongly."""

from __future__ import annotations

import copy
import dataclasses
import math
import pathlib
import re
from typing import Any
from xml.etree import ElementTree

from ..tools.errors import UserError

NAMESPACE = "{http://www.w3.org/2000/svg}"
# Elements that are drawn only if something refers to them, and style sheets that are already applied.
TEMPLATES = [NAMESPACE + name for name in ("symbol", "marker", "mask", "style")]
LINKS = ("href", "{http://www.w3.org/1999/xlink}href")
PIXELS = {"": 1.0, "px": 1.0, "mm": 96 / 25.4, "cm": 96 / 2.54, "q": 96 / 101.6, "in": 96.0, "pt": 96 / 72, "pc": 16.0}
ACROSS, DOWN = ("x", "width", "cx", "rx", "x1", "x2"), ("y", "height", "cy", "ry", "y1", "y2")
LENGTHS = {"circle": ("cx", "cy", "r"), "ellipse": ("cx", "cy", "rx", "ry"), "rect": ("x", "y", "width", "height", "rx", "ry"), "line": ("x1", "y1", "x2", "y2"),
           "svg": ("x", "y", "width", "height"), "use": ("x", "y", "width", "height")}
# What the library understands in a transform. Other units depend on a font, a window or the size of an object.
FUNCTIONS = ("matrix", "translate", "translatex", "translatey", "scale", "scalex", "scaley", "rotate", "skew", "skewx", "skewy")
UNITS = ("px", "mm", "cm", "in", "pt", "pc", "deg", "grad", "rad", "turn", "e")  # e: of an exponent
UNREADABLE = "cannot be read); apply transforms in the drawing program, such as by ungrouping"


@dataclasses.dataclass
class Viewport:
    """The size to which percentages refer. None if the drawing has no size."""

    width: float | None
    height: float | None

    def whole(self, attribute: str) -> float | None:
        """The length that is 100 % for an attribute."""
        if attribute in ACROSS:
            return self.width
        if attribute in DOWN:
            return self.height
        return None if self.width is None or self.height is None else math.hypot(self.width, self.height) / math.sqrt(2)


def prepare(root: Any, path: pathlib.Path) -> None:
    """Prepares all elements of a drawing. @param path  for messages. @throws UserError"""
    if root.get("transform", "none").strip() not in ("", "none"):
        raise refusal(path, root, "transform", UNREADABLE)
    originals = {element.get("id"): element for element in copy.deepcopy(root).iter()}
    Preparation(originals, path).prepare(root, viewport_of(root))


def viewport_of(svg: Any) -> Viewport:
    """The size of the coordinate system within an <svg>."""
    view = re.fullmatch(r"\s*\S+?[\s,]+\S+?[\s,]+([^\s,]+)[\s,]+([^\s,]+)\s*", svg.get("viewBox", ""))
    sizes = view.groups() if view else (svg.get("width", ""), svg.get("height", ""))
    return Viewport(*(pixels(size, None) if size.strip() else None for size in sizes))


def pixels(text: str, whole: float | None) -> float | None:
    """A length in pixels, or None if it has a unit that depends on a font or a window. @param whole  100 %"""
    found = re.fullmatch(r"\s*([-+]?(?:\d+\.?\d*|\.\d+)(?:e[-+]?\d+)?)\s*([a-z%]*)\s*", text, re.IGNORECASE)
    factor = None if found is None else whole if found[2] == "%" else PIXELS.get(found[2].lower())
    return None if found is None or factor is None else float(found[1]) * factor / (100 if found[2] == "%" else 1)


def origin_of(text: str, viewport: Viewport) -> tuple[float | None, float | None]:
    """The origin of a transform. Percentages and words refer to the viewport. None for other lengths."""
    places = text.lower().split()[:2]
    across, down = [*places, "center"][:2]
    if across in ("top", "bottom") or down in ("left", "right"):
        across, down = down, across
    words = {"center": "50%", "left": "0%", "right": "100%", "top": "0%", "bottom": "100%"}
    return pixels(words.get(across, across), viewport.width), pixels(words.get(down, down), viewport.height)


def named(element: Any) -> str:
    """An element in words, such as <circle id="c1">."""
    attributes = [("id", element.get("id"))] if element.get("id") else list(element.attrib.items())
    text = " ".join(f'{name}="{value}"' for name, value in attributes if not name.startswith("{"))
    return f"<{' '.join([kind(element), text[:80]]).strip()}>"


def kind(element: Any) -> str:
    return str(element.tag).removeprefix(NAMESPACE)


def is_shown(element: Any) -> bool:
    """Whether a browser in English shows an element according to its conditions."""
    languages = element.get("systemLanguage", "en").lower().split(",")
    return element.get("requiredExtensions") is None and any(re.fullmatch(r"en(-.*)?", language.strip()) for language in languages)


def children_of(element: Any) -> list[Any]:
    """The elements within an element that may be drawn. A <switch> draws the first of them."""
    found = [child for child in element if child.tag not in TEMPLATES and is_shown(child)]
    return found[:1] if kind(element) == "switch" else found


def refusal(path: pathlib.Path, element: Any, attribute: str, reason: str) -> UserError:
    return UserError(f"cannot read {path} ({attribute}=\"{element.get(attribute)[:60]}\" of {named(element)} {reason}")


class Preparation:
    def __init__(self, originals: dict[str | None, Any], path: pathlib.Path) -> None:
        self._originals = originals
        self._path = path

    def prepare(self, element: Any, viewport: Viewport) -> None:
        """Prepares the elements within an element. @param viewport  to which percentages refer"""
        element[:] = [self._prepared(child, viewport) for child in children_of(element)]

    def _prepared(self, element: Any, viewport: Viewport) -> Any:
        """The element, or what is drawn in its place."""
        if element.get("display") == "none" and kind(element) not in ("clipPath", "defs"):
            return element
        self._set_lengths(element, viewport)
        self._set_transform(element, viewport)
        if kind(element) == "svg":
            if any(pixels(element.get(size, "1"), None) == 0 for size in ("width", "height")):
                return ElementTree.Element(NAMESPACE + "g")  # The library would end the whole drawing here.
            viewport = viewport_of(element)
        drawn = self._group_of(element) if kind(element) == "use" else element
        self.prepare(drawn, viewport)
        return drawn

    def _set_lengths(self, element: Any, viewport: Viewport) -> None:
        """Writes lengths without units. @throws UserError  for units that depend on a font or a window"""
        for attribute in LENGTHS.get(kind(element), ()):
            text = element.get(attribute, "auto").strip()
            if text in ("", "auto"):
                element.attrib.pop(attribute, None)
                continue
            value = pixels(text, viewport.whole(attribute))
            if value is None:
                raise refusal(self._path, element, attribute, "is no length in px, mm, cm, in, pt or pc); give it in one of these or without a unit, or convert the object to a path")
            element.set(attribute, text if text[-1].isdigit() else repr(value))
        if kind(element) == "svg":
            for attribute in ("width", "height"):
                if element.get(attribute) is None:
                    if viewport.whole(attribute) is None:
                        raise UserError(f"cannot read {self._path} ({named(element)} within the drawing has no {attribute}, and neither has the drawing); give it in the drawing")
                    element.set(attribute, repr(viewport.whole(attribute)))
            # The library ignores x and y of an <svg> without a viewBox.
            element.set("viewBox", element.get("viewBox") or f"0 0 {element.get('width')} {element.get('height')}")
        elif kind(element) in ("rect", "circle"):  # The library draws one without a size as one of size 1.
            for attribute in ("width", "height") if kind(element) == "rect" else ("r",):
                element.set(attribute, element.get(attribute, "0"))
        elif kind(element) == "ellipse":
            for attribute, other in (("rx", "ry"), ("ry", "rx")):
                element.set(attribute, element.get(attribute) or element.get(other) or "0")

    def _set_transform(self, element: Any, viewport: Viewport) -> None:
        """Writes the origin of a transform into the transform.
        @throws UserError  for transforms and origins that the library cannot know"""
        transform = element.get("transform", "").strip()
        if transform in ("", "none"):
            element.set("transform", "")
            return
        function = r"([a-z0-9]+)\s*\(([^()]*)\)"
        is_known = all(name.lower() in FUNCTIONS and all(unit in UNITS for unit in re.findall("[a-z%]+", numbers.lower())) for name, numbers in re.findall(function, transform, re.IGNORECASE))
        if not is_known or re.sub(function, "", transform, flags=re.IGNORECASE).strip(" ,\t\r\n"):
            raise refusal(self._path, element, "transform", UNREADABLE)
        origin = element.get("transform-origin", "0 0")
        x, y = origin_of(origin, viewport)
        if x is None or y is None or element.get("transform-box", "view-box") != "view-box":
            attribute = "transform-box" if element.get("transform-box", "view-box") != "view-box" else "transform-origin"
            raise refusal(self._path, element, attribute, "depends on sizes that this command does not know); give x and y of transform-origin in px, or apply transforms in the drawing program")
        if x or y:
            element.set("transform", f"translate({x!r}, {y!r}) {transform} translate({-x!r}, {-y!r})")

    def _group_of(self, use: Any) -> Any:
        """A group with a copy of the target of a <use>.

        The library makes three mistakes in this step: it drops references to elements further down in the file, draws a
        <symbol> where it is defined, and ignores the viewBox of a <symbol>.
        @throws UserError  if the file lacks the target"""
        link = next((use.get(name) for name in LINKS if use.get(name)), "")
        if link[:1] != "#" or link[1:] not in self._originals:
            raise UserError(f"cannot read {self._path} (<use> refers to '{link[:60]}', which is not in the file); embed it, or unlink clones, in the drawing program")
        original = copy.deepcopy(self._originals[link[1:]])
        if original.tag == NAMESPACE + "symbol":
            original.tag = NAMESPACE + "svg"  # A <symbol> is drawn like an <svg> inside the drawing.
        if original.tag == NAMESPACE + "svg":
            original.attrib.update({name: use.get(name) for name in ("width", "height") if use.get(name)})
        attributes = {name: value for name, value in use.attrib.items() if name not in ("x", "y", "width", "height", *LINKS)}
        attributes["transform"] = f"{use.get('transform', '')} translate({use.get('x', 0)}, {use.get('y', 0)})"
        group = ElementTree.Element(NAMESPACE + "g", attributes)
        group.append(original)
        return group
