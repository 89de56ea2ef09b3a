"""Applies the style sheets and the style attributes of an SVG: writes what they say about each element into the
attributes of the same names. The library that reads the drawing knows only a few kinds of selectors."""

from __future__ import annotations

import re
from typing import Any

from . import values
from .libraries import library
from .values import PACKAGE

STYLE = "{http://www.w3.org/2000/svg}style"
SIZES = ("width", "height")
# At-rules that have no effect on shapes. Selectors with the prefix of a @namespace are reported themselves.
HARMLESS = ("charset", "namespace", "font-face", "font-feature-values", "keyframes", "-webkit-keyframes", "page", "property", "counter-style")
SEEN_ON = ("all", "screen")
MEDIA = (*SEEN_ON, "print", "speech", "tty", "tv", "projection", "handheld", "braille", "embossed", "aural")


def apply(root: Any, notes: list[str]) -> None:
    """Applies the cascade: rules by specificity and place, the style attribute above rules, and !important above both.
    @param root  of the drawing. Its style attributes are removed
    @param notes  gets a line that names the rules that could not be applied"""
    sheets = Sheets()
    for element in root.iter(STYLE):
        if element.get("type", "text/css").strip().lower() in ("", "text/css"):
            sheets.read(element.get("media", "all"), element.text or "")
    wrapper = library("cssselect2", PACKAGE).ElementWrapper
    # All selectors look at the unchanged drawing, because [fill="red"] means the attribute.
    found = [(wrapped.etree_element, sheets.declared(wrapped)) for wrapped in wrapper.from_xml_root(root).iter_subtree()]
    ids = {element.get("id") for element in root.iter()}
    for element, declarations in found:
        element.attrib.pop("style", None)
        attributes = [(name, value, f'{name}="{value}"') for name, value in element.attrib.items() if name in values.FORMS]
        for name, text, words in [*attributes, *((name, text, "") for name, text in declarations)]:
            value = values.value_of(name, text, ids, bool(words))
            if value is not None:
                set_property(element, name, value, element is root)
            else:
                sheets.unknown.append(words or f"{name}:{text}")
                if words:
                    del element.attrib[name]
    if sheets.unknown:
        notes.append(f"styles ignored, which this command cannot apply: {', '.join(dict.fromkeys(sheets.unknown))}")


def set_property(element: Any, name: str, value: str, is_root: bool) -> None:
    """Writes a property into the attribute of the same name, or removes the attribute if the value is empty."""
    if is_root and name in SIZES and not re.fullmatch(r"[0-9.e+-]+[a-z]*", value, re.IGNORECASE):
        return  # Such a size, for example 100%, is that of a window, and not that of the drawing.
    if value:
        element.set(name, value)
    else:
        element.attrib.pop(name, None)


class Sheets:
    """The rules of all style sheets of a drawing."""

    def __init__(self) -> None:
        self._css = library("tinycss2", PACKAGE)
        self._selecting = library("cssselect2", PACKAGE)
        self._matcher = self._selecting.Matcher()
        self.unknown: list[str] = []  # Selectors and at-rules that cannot be applied.

    def read(self, media: str, text: str) -> None:
        """@param media  for which the style sheet is"""
        if self._is_seen(media, "media="):
            self._add(self._css.parse_stylesheet(text, skip_comments=True, skip_whitespace=True))

    def declared(self, wrapped: Any) -> list[tuple[str, str]]:
        """The properties of an element and their values. Later ones replace earlier ones."""
        rules = [declaration for _, _, pseudo, declarations in self._matcher.match(wrapped) if pseudo is None for declaration in declarations]
        own = self._declarations(wrapped.etree_element.get("style", ""))
        ordered = sorted([*rules, *own], key=lambda declaration: bool(declaration.important))  # a stable sort
        return [(declaration.lower_name, self._text(declaration.value)) for declaration in ordered]

    def _text(self, tokens: Any) -> str:
        return str(self._css.serialize(tokens)).strip()

    def _declarations(self, content: Any) -> list[Any]:
        found = self._css.parse_declaration_list(content, skip_comments=True, skip_whitespace=True)
        return [item for item in found if item.type == "declaration" and item.lower_name in values.FORMS]

    def _add(self, rules: Any) -> None:
        for rule in rules:
            prelude = self._text(getattr(rule, "prelude", []))
            if rule.type == "qualified-rule":
                try:
                    selectors = self._selecting.compile_selector_list(rule.prelude)
                except self._selecting.SelectorError:
                    self.unknown.append(prelude)
                    continue
                if any(token.type == "{} block" for token in rule.content):
                    self.unknown.append(f"rules within {prelude}")
                for selector in selectors:
                    self._matcher.add_selector(selector, self._declarations(rule.content))
            elif rule.type == "at-rule" and rule.lower_at_keyword == "media":
                if self._is_seen(prelude, "@media "):
                    self._add(self._css.parse_rule_list(rule.content or [], skip_comments=True, skip_whitespace=True))
            elif rule.type == "at-rule" and rule.lower_at_keyword not in HARMLESS:
                self.unknown.append(f"@{rule.at_keyword} {prelude}")
            elif rule.type == "error":
                self.unknown.append(f"a part that is no CSS ({rule.message})")

    def _is_seen(self, media: str, name: str) -> bool:
        """Whether a list of media includes screens. Media with conditions, such as the width of a window, are
        unknown."""
        queries = [re.sub(r"^only\s+", "", query.strip().lower()) for query in media.split(",")]
        if any(query in SEEN_ON or not query for query in queries):
            return True
        if any(query not in MEDIA for query in queries):
            self.unknown.append(f"{name}{media}")
        return False
