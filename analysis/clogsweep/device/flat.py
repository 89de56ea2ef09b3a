"""Flattens SVG drawings with librsvg: all that is visible becomes paths, without style sheets, references and units."""

from __future__ import annotations

import copy
import dataclasses
import pathlib
import re
import subprocess
from typing import Any
from xml.etree import ElementTree

import numpy as np

from ..tools.errors import UserError
from ..tools.hints import Numbers

NAMESPACE = "{http://www.w3.org/2000/svg}"
LINK = "{http://www.w3.org/1999/xlink}href"
# Elements that are no shapes; attributes and properties that would make librsvg draw pixels or markers.
NO_SHAPES = ("text", "image", "foreignObject")
PIXELS = ("filter", "mask", "marker", "marker-start", "marker-mid", "marker-end", "mix-blend-mode", "isolation",
          "enable-background")
# CSS that librsvg does not know, and that would move shapes or change their size or colour in a browser.
TRANSFORMS = {"transform-origin": r"(?<![\w-])transform-origin\s*[:=]",
              "transform-box": r"(?<![\w-])transform-box\s*[:=]",
              "translate, rotate or scale": r"(?<![\w-])(?:translate|rotate|scale)\s*:"}
LENGTHS = {"lengths that depend on a font or a window": r"(?<![\w-])(?:[cr]?[xy]|r|width|height|[xy][12])\s*[:=]\s*[\"']?\s*[-+\d.]+(?:r?em|ex|ch|v[wh]|vmin|vmax)\b"}
FUNCTION = r"(?:([\w-]+)\s*[:=]\s*[\"']?[^;:=\"'{}<>]*?)?\b(var|calc)\("  # the property, if it is found, and the function
IGNORED = {"@media": r"@media\b", "@layer": r"@layer\b", "@import": r"@import\b",
           "animations": r"<(?:\w+:)?(?:animate\w*|set)\b|(?<![\w-])animation(?:-name)?\s*:",
           "blend modes": r"mix-blend-mode\s*:\s*(?!normal)\w", "masks": r"(?<![\w-])mask\s*[:=]",
           "filters": r"(?<![\w-])filter\s*[:=]", "patterns": r"<(?:\w+:)?pattern\b",
           "markers": r"(?<![\w-])marker(?:-start|-mid|-end)?\s*[:=](?!\s*[\"']?\s*none\b)",
           "media of style sheets": r"<(?:\w+:)?style[^>]*\smedia\s*=",
           "style sheets in other files": r"<\?xml-stylesheet|<(?:\w+:)?link\b"}
# The longer side of the page, the side of the canvas around the page, and the place of the page on the canvas. Shapes
# outside the page are on the canvas, too. librsvg has single precision, in which powers of two are exact.
PAGE, CANVAS, BEFORE = 2**16, 2**20, 2**19
SIZE = 2**22  # Size of the flat drawing [px]. Coordinates in the flat drawing are multiples of 1/256.
STEP = 1e-7  # Coordinates are rounded to multiples of this fraction of the page's longer side.


@dataclasses.dataclass
class Flat:
    """A flat drawing."""

    root: Any
    longer: float  # The longer side of the page [px].

    def to_page(self, points: Numbers) -> Numbers:
        """Points (n, 2) in pixels of the page. Rounding to STEP removes the rounding errors of librsvg, so points on
        the page's border stay on the border."""
        shares = (np.asarray(points) * CANVAS / self.size - BEFORE) / PAGE
        return np.round(shares / STEP) * STEP * self.longer

    @property
    def pixel(self) -> float:
        """The size of the drawing's unit [px]."""
        return CANVAS / self.size / PAGE * self.longer

    @property
    def size(self) -> float:
        """The width in the drawing's own units, which are pixels or points, depending on the version of librsvg."""
        return float(self.root.get("width"))


def flatten(root: Any, width: float, height: float, path: pathlib.Path) -> Flat:
    """Draws everything that is visible.
    @param root  stays unchanged
    @param width, height  of the page [px]
    @param path  for messages. @throws UserError  if librsvg is missing, or cannot draw this"""
    inner = without_pixels(copy.deepcopy(root))
    longer = max(width, height)
    inner.attrib.setdefault("viewBox", f"0 0 {width!r} {height!r}")
    inner.attrib.update({"x": "0", "y": "0", "width": repr(PAGE * width / longer),
                         "height": repr(PAGE * height / longer), "overflow": "visible"})
    outer = ElementTree.Element(NAMESPACE + "svg", {"width": f"{SIZE}px", "height": f"{SIZE}px",
                                                    "viewBox": f"{-BEFORE} {-BEFORE} {CANVAS} {CANVAS}"})
    outer.append(inner)
    flat = ElementTree.fromstring(drawn(ElementTree.tostring(outer), path))
    replace_uses(flat)
    flat.attrib["width"], flat.attrib["height"] = flat.attrib["viewBox"].split()[2:]
    return Flat(flat, longer)


def without_pixels(root: Any) -> Any:
    """Removes everything that librsvg would draw as pixels."""
    properties = re.compile(rf"(?<![\w-])(?={'|'.join(PIXELS)})", re.IGNORECASE)
    for element in root.iter():
        if element.tag in [NAMESPACE + name for name in NO_SHAPES]:
            element.tag = NAMESPACE + "metadata"
        for name in PIXELS:
            element.attrib.pop(name, None)
        if "style" in element.attrib:
            element.set("style", properties.sub("no-", element.get("style")))
        if element.tag == NAMESPACE + "style":
            element.text = properties.sub("no-", element.text or "")
    return root


def drawn(svg: bytes, path: pathlib.Path) -> bytes:
    """The drawing as librsvg draws it with cairo."""
    try:
        done = subprocess.run(["rsvg-convert", "--format=svg", "--unlimited", "--accept-language=en"], input=svg,
                              capture_output=True, check=False)
    except FileNotFoundError as error:
        raise UserError("cannot read such a drawing (rsvg-convert is not there); apt install librsvg2-bin") from error
    if done.returncode or not done.stdout:
        reason = done.stderr.decode(errors="replace").strip().splitlines()
        raise UserError(f"cannot read {path} (librsvg: {reason[-1] if reason else 'no drawing'}); "
                        "simplify it in the drawing program")
    return done.stdout


def replace_uses(flat: Any) -> None:
    """Replaces each <use> of a group by the group itself. librsvg writes a group that has an opacity as a <use>."""
    originals = {element.get("id"): element for element in flat.iter(NAMESPACE + "g")}
    for parent in list(flat.iter()):
        for index, child in enumerate(list(parent)):
            target = originals.get(child.get(LINK, "")[1:]) if child.tag == NAMESPACE + "use" else None
            if target is not None:
                parent[index] = target
    for definitions in list(flat.iter(NAMESPACE + "defs")):
        definitions[:] = [element for element in definitions if element.tag == NAMESPACE + "clipPath"]


def named_in(text: str, patterns: dict[str, str]) -> str:
    """Names of the patterns that a drawing's text contains."""
    return ", ".join(name for name, pattern in patterns.items() if re.search(pattern, text, re.IGNORECASE))


def refuse_unknown_css(text: str, path: pathlib.Path) -> None:
    """@param text  of a drawing. @throws UserError  if librsvg would draw it in another way than a browser"""
    functions = dict.fromkeys(f"{function.lower()}()" + (f" in {name}" if name else "")
                              for name, function in re.findall(FUNCTION, text, re.IGNORECASE))
    for unknown, remedy in [(named_in(text,
                                      TRANSFORMS), "apply transforms in the drawing program, such as by ungrouping"),
                            (", ".join(functions), "write the value itself in the drawing"),
                            (named_in(text, LENGTHS), "give lengths in px or mm")]:
        if unknown:
            raise UserError(f"cannot read {path} (librsvg does not know {unknown}); {remedy}")
