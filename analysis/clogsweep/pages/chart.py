"""Puts a figure into a page as a drawing. The drawing's colours follow light and dark mode, and the elements that
represent groups are marked.

The drawing functions mark these elements with style.mark().
"""

import io
import re
from collections.abc import Iterable, Sequence
from xml.etree import ElementTree

import matplotlib
from matplotlib.figure import Figure

SVG = "http://www.w3.org/2000/svg"
HREF = "{http://www.w3.org/1999/xlink}href"
COLOUR = re.compile(r"#([0-9a-f]{6})\b")
REFERENCE = re.compile(r"url\(#(\w+)\)")
DIGITS = re.compile(r"(\.\d\d)\d+")
MARK = re.compile(r"(point|curve|legend)-([\d,]+)")
REACH = 7  # A mouse selects a point within this radius around it [pt].

DARK_PAPER = (0x16, 0x18, 0x1D)
DARK_INK = (0xE6, 0xE6, 0xE6)
LEAST_CONTRAST = 3.5  # Smallest contrast of a colour on dark paper. WCAG 2.1 requires 3.

BLACK = "000000"
Colour = tuple[float, float, float]


def element(name: str, **attributes: str) -> ElementTree.Element:
    return ElementTree.Element(f"{{{SVG}}}{name}", {key.replace("_", "-"): value for key, value in attributes.items()})


def luminance(colour: Colour) -> float:
    """The relative luminance as WCAG 2.1 defines it, from 0 to 1. @param colour  red, green and blue, each from 0 to
    255"""
    linear: list[float] = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4
                           for c in (channel / 255 for channel in colour)]
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]


def mixed(colour: Colour, other: Colour, share: float) -> Colour:
    """A mixture of two colours. @param share  fraction of the other colour"""
    red, green, blue = ((1 - share) * a + share * b for a, b in zip(colour, other))
    return red, green, blue


def in_the_dark(colour: Colour) -> Colour:
    """The colour for dark mode. Greys are inverted, so that white paper becomes dark and black ink becomes light. Other
    colours are made lighter until they are visible."""
    if len(set(colour)) == 1:
        return mixed(DARK_INK, DARK_PAPER, colour[0] / 255)
    shares = (step / 20 for step in range(21))
    lighter = (mixed(colour, (255, 255, 255), share) for share in shares)
    return next(made for made in lighter if (luminance(made) + 0.05) / (luminance(DARK_PAPER) + 0.05) >= LEAST_CONTRAST)


class Charts:
    """The charts of one page. The charts share the shapes of letters, the markers and the colours.

    @param labels  the label of each group
    """

    def __init__(self, labels: Sequence[str]) -> None:
        self._labels = labels
        self._defined: set[str] = set()
        self._colours: set[str] = set()
        self._number = 0

    def draw(self, figure: Figure, caption: str) -> str:
        """Draws a chart. @return an HTML element"""
        out = io.StringIO()
        # Letters are drawn as shapes, because with the fonts of another machine the letters of a formula would be
        # misplaced. The salt is constant, so that equal elements of two charts have the same name.
        with matplotlib.rc_context({"svg.fonttype": "path", "svg.hashsalt": "clogsweep"}):
            figure.savefig(out, format="svg", transparent=True, metadata={"Date": None})
        ElementTree.register_namespace("", SVG)
        root = ElementTree.fromstring(out.getvalue())
        self._number += 1
        for name in ("width", "height", "version"):
            root.attrib.pop(name, None)
        root.attrib |= {"class": "chart", "role": "group", "aria-label": caption}
        for metadata in root.findall(f"{{{SVG}}}metadata"):
            root.remove(metadata)
        self._rename(root)
        for parent in list(root.iter()):
            drop_doubles(parent)
            self._mark(parent)
        return ElementTree.tostring(root, encoding="unicode")

    def colours(self) -> tuple[str, str]:
        """CSS declarations of the colours that were drawn so far, in light and in dark mode."""
        def declared(colours: Iterable[tuple[str, Colour]]) -> str:
            return " ".join(f"--c{name}: #{''.join(f'{round(channel):02x}' for channel in colour)};"
                            for name, colour in colours)

        named = {name: (int(name[:2], 16), int(name[2:4], 16), int(name[4:], 16))
                 for name in sorted(self._colours | {BLACK})}
        return declared(named.items()), declared((name, in_the_dark(colour)) for name, colour in named.items())

    def _rename(self, root: ElementTree.Element) -> None:
        """Replaces colours by names, and removes unused names. Also renames clips, because a clip of another chart may
        have the same name."""
        for node in root.iter():
            node.text = node.tail = None  # line breaks
            if HREF in node.attrib:
                node.set("href", node.attrib.pop(HREF))
            for key, value in node.attrib.items():
                if key == "style":
                    self._colours |= set(COLOUR.findall(value))
                    value = COLOUR.sub(r"var(--c\1)", value)
                elif key in ("x", "y", "d"):
                    value = DIGITS.sub(r"\1", " ".join(value.split()))
                node.set(key, REFERENCE.sub(rf"url(#\1-{self._number})", value))
        for parent in root.iter():
            for child in list(parent):
                name = child.get("id")
                if child.tag == f"{{{SVG}}}clipPath":
                    child.set("id", f"{name}-{self._number}")
                elif parent.tag == f"{{{SVG}}}defs" and name:
                    if name in self._defined:
                        parent.remove(child)
                    self._defined.add(name)
                elif name and not MARK.fullmatch(name):
                    del child.attrib["id"]

    def _mark(self, node: ElementTree.Element) -> None:
        found = MARK.fullmatch(node.get("id", ""))
        if not found:
            return
        del node.attrib["id"]
        kind, groups = found[1], found[2].split(",")
        markers = [(parent, child) for parent in node.iter() for child in parent if child.tag == f"{{{SVG}}}use"]
        if kind != "point":
            node.attrib |= {"class": kind, "data-groups": " ".join(groups)}
        elif markers:
            for line in node.findall(f"{{{SVG}}}path"):  # the lines through the points
                line.attrib |= {"class": "curve", "data-groups": " ".join(groups)}
            for (parent, marker), group in zip(markers, groups, strict=True):
                reach = element("circle", cx=marker.get("x", ""), cy=marker.get("y", ""), r=str(REACH),
                                **{"class": "reach"})
                place = list(parent).index(marker)
                parent[place] = self._point(group, "point", [reach, marker])
        else:
            group, = groups
            parts = []
            for path in node.findall(f".//{{{SVG}}}path"):
                is_line = "fill: none" in path.get("style", "")
                parts += [element("path", d=path.get("d", ""), **{"class": "reach"}), path] if is_line else [path]
            inner = self._point(group, "point line" if len(parts) > 1 else "point", parts)
            for child in list(node):
                node.remove(child)
            node.append(inner)

    def _point(self, group: str, kind: str, parts: Iterable[ElementTree.Element]) -> ElementTree.Element:
        """The element of a point that a mouse or the keyboard can select."""
        label = self._labels[int(group)]
        made = element("g", tabindex="0", role="img", aria_label=label, data_groups=group, **{"class": kind})
        title = element("title")
        title.text = label
        made.extend([title, *parts])
        return made


def drop_doubles(parent: ElementTree.Element) -> None:
    """Removes all but one marker of the same kind at the same place, because thousands of runs may have ended at one
    distance."""
    seen = set()
    for child in list(parent):
        if child.tag == f"{{{SVG}}}use" and "x" in child.attrib:
            what = tuple(sorted(child.attrib.items()))
            if what in seen:
                parent.remove(child)
            seen.add(what)
