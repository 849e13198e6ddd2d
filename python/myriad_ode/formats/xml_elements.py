# SPDX-License-Identifier: MIT
"""Documents of XML from anywhere, read without anything outside them and without growing beyond their length."""

from __future__ import annotations

import xml.etree.ElementTree as etree
from collections.abc import Callable
from typing import NoReturn
from xml.parsers import expat

deepest = 250  #: elements, as in libxml2


class Element(etree.Element):
    """An element and its line."""

    line = 0


def elements_of(data: bytes | str, refuse: Callable[[str, int], NoReturn],
                prefixes: dict[str, str] | None = None) -> Element:
    """The root of a document; its prefixes of namespaces go to `prefixes`. `refuse` is called with what is wrong and
    its line: no XML, entities, which may grow without bound or name files, and elements that are nested too deep."""
    parser = expat.ParserCreate(namespace_separator="}")
    builder = etree.TreeBuilder(element_factory=Element)
    depth = 0

    def name(text: str) -> str:
        return "{" + text if "}" in text else text

    def start(tag: str, attributes: dict[str, str]) -> None:
        nonlocal depth
        depth += 1
        if depth > deepest:
            refuse(f"elements are nested more than {deepest} deep: write formulas in parts, with variables of their "
                   "own", parser.CurrentLineNumber)
        element = builder.start(name(tag), {name(key): value for key, value in attributes.items()})
        assert isinstance(element, Element)
        element.line = parser.CurrentLineNumber

    def end(tag: str) -> None:
        nonlocal depth
        depth -= 1
        builder.end(name(tag))

    def declare(prefix: str | None, uri: str) -> None:
        if prefixes is not None and prefix:
            prefixes[prefix] = uri

    def entity(declared: str, *_: object) -> None:
        refuse(f"it declares the entity '{declared}': write its text where it stands", parser.CurrentLineNumber)

    parser.StartElementHandler, parser.EndElementHandler, parser.CharacterDataHandler = start, end, builder.data
    parser.EntityDeclHandler, parser.StartNamespaceDeclHandler = entity, declare
    try:
        parser.Parse(data, True)
    except expat.ExpatError as error:
        refuse(f"this is no XML: {expat.ErrorString(error.code)}", error.lineno)
    root = builder.close()
    assert isinstance(root, Element)
    return root
