# SPDX-License-Identifier: MIT
"""What CellML 1.0 and 1.1 spell otherwise than 2.0, and libCellML does not take: written as 2.0 has it."""

from __future__ import annotations

import collections
import re
from collections.abc import Iterator

from ..xml_elements import Element
from .document import Document, mathml, split

_real = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)[eE][-+]?\d+")
_units = {"meter": "metre", "liter": "litre"}


def modernise(document: Document) -> None:
    """Changes a document in place."""
    for element in document.root.iter():
        assert isinstance(element, Element)
        tag = split(element.tag)[1]
        for i, child in enumerate(element):
            if split(child.tag)[1] == "semantics" and len(child):  # what it says beside the formula is for readers
                element[i] = child[0]
        if tag == "cn":
            _number(document, element)
        elif tag == "unit":
            _unit(document, element)
        elif tag == "bvar":
            _degree(document, element)
    if document.version != "2.0":
        _hoist_units(document)
        _one_encapsulation(document)
        for element, name in _references(document.root):
            element.set(name, _units.get(element.attrib[name], element.attrib[name]))
        if any(element.get(name) == "celsius" for element, name in _references(document.root)):
            document.root.insert(0, Element(f"{{{document.namespace}}}units", name="celsius", base_units="yes"))


def _number(document: Document, element: Element) -> None:
    """Numbers in other notations than a decimal one, as an exponent in a real number, which many files have."""
    kind, base, text = element.get("type", "real"), element.attrib.pop("base", "10"), (element.text or "").strip()
    parts = [text, *((child.tail or "").strip() for child in element)]
    try:
        if kind == "real" and base == "10" and len(parts) == 1 and _real.fullmatch(text):
            parts = re.split("[eE]", text)
        elif kind == "integer" and len(parts) == 1:
            parts = [str(int(text, int(base)))]
        elif kind == "rational" and base == "10" and len(parts) == 2:
            parts = re.split("e", repr(float(parts[0]) / float(parts[1])))
        elif base != "10":
            raise ValueError
        else:
            return
    except (ValueError, ZeroDivisionError, OverflowError):
        document.refuse(f"the number '{' '.join(parts)}' of type {kind} and base {base}: write a decimal one",
                        element.line)
    del element[:]
    element.text, element.attrib["type"] = parts[0], "real" if len(parts) == 1 else "e-notation"
    if len(parts) == 2:
        separator = Element(f"{{{mathml}}}sep")
        separator.tail = parts[1]
        element.append(separator)


def _unit(document: Document, element: Element) -> None:
    """Units with an offset, as of Fahrenheit's scale, are no factors of others."""
    offset = element.attrib.pop("offset", "0")
    if offset.strip("+-0. ") != "":
        document.refuse(f"a unit of '{element.get('units')}' with the offset {offset}, which Myriad does not convert: "
                        "leave the offset out, and add it in an equation", element.line)
    if element.get("prefix") == "deka":
        element.set("prefix", "deca")


def _degree(document: Document, element: Element) -> None:
    for degree in element.findall(f"{{{mathml}}}degree"):
        if (degree.findtext(f"{{{mathml}}}cn") or "").strip() not in ("1", "1.0"):
            document.refuse("a derivative of a higher degree: give the first derivative a variable of its own, which "
                            "has a derivative", element.line)
        element.remove(degree)


def _references(root: Element) -> Iterator[tuple[Element, str]]:
    """The elements that name units, and the attributes by which they do."""
    for element in root.iter():
        assert isinstance(element, Element)
        yield from ((element, name) for name in element.attrib if split(name)[1] == "units")


def _hoist_units(document: Document) -> None:
    """Units of a component become units of the model, with the component's name behind theirs where others have it."""
    kind = f"{{{document.namespace}}}units"
    count = collections.Counter(units.get("name") for units in document.root.iter(kind))
    for component in document.root.findall(f"{{{document.namespace}}}component"):
        assert isinstance(component, Element)
        new = {}
        for units in component.findall(kind):
            name = units.get("name", "")
            new[name] = f"{name}_of_{component.get('name')}" if count[name] > 1 else name
        for element, name in _references(component):
            element.set(name, new.get(element.attrib[name], element.attrib[name]))
        for units in component.findall(kind):
            units.set("name", new[units.get("name", "")])
            component.remove(units)
            document.root.append(units)


def _one_encapsulation(document: Document) -> None:
    """Groups that say which components are inside others become one, and groups of other kinds are left out."""
    space = f"{{{document.namespace}}}"
    inside = dict[str, dict[str, None]]()  # components by the one around them, "" if there is none
    for group in document.root.findall(f"{space}group"):
        document.root.remove(group)
        if "encapsulation" in [e.get("relationship") for e in group.findall(f"{space}relationship_ref")]:
            for outer in group.iter():
                within = [e.get("component", "") for e in outer.findall(f"{space}component_ref")]
                if within:
                    inside.setdefault(outer.get("component", ""), {}).update(dict.fromkeys(within))
    if not inside:
        return
    inner = {component for outer, within in inside.items() if outer for component in within}
    made = Element(f"{space}group")
    made.append(Element(f"{space}relationship_ref", relationship="encapsulation"))
    waiting = [(made, component) for component in inside[""] if component not in inner and component in inside]
    while waiting:
        around, component = waiting.pop()
        reference = Element(f"{space}component_ref", component=component)
        around.append(reference)
        waiting += [(reference, within) for within in inside.pop(component, {})]
    left = next((component for component in inside if component), None)
    if left is not None:
        document.refuse(f"component '{left}' is inside itself, or has components inside it twice: name each inside "
                        "one other")
    document.root.append(made)
