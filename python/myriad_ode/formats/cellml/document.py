# SPDX-License-Identifier: MIT
"""Files of CellML as XML, read without anything outside them, and written for libCellML with what it needs alone."""

from __future__ import annotations

import re
import xml.etree.ElementTree as etree
from html import escape
from pathlib import Path
from typing import Any, NoReturn

from ...base.errors import Error
from ..xml_elements import Element, elements_of

cellml = re.compile(r"http://www\.cellml\.org/cellml/(1\.0|1\.1|2\.0)#")
mathml = "http://www.w3.org/1998/Math/MathML"
_xlink = "http://www.w3.org/1999/xlink"
_longest = 5000  #: arguments of an operation and of the longest in it, on which libCellML recurs
_largest = 1000  #: factors of units, when those that they are made of are written out, as libCellML does
# What is refused wherever it is found: what it is, and what to write instead.
_refused = {
    "reset": ("a reset", "make it an event, my.event(...), of a model that is written in Python"),
    "reaction": ("a reaction", "write its rates as equations of the variables"),
    "partialdiff": ("a partial derivative", "give the equations of the points of a grid, with time alone"),
    "int": ("an integral", "make it a variable with a derivative"),
    "sum": ("a sum over an index", "write its terms"), "product": ("a product over an index", "write its factors"),
    "lambda": ("a function", "write it out where it is used"),
    "csymbol": ("a symbol from elsewhere", "write what it stands for in MathML; random values are for generate= of "
                                           "my.study, delays for my.delayed"),
    "limit": ("a limit", "write its value"), "vector": ("a vector", "write an equation for each of its elements"),
    "matrix": ("a matrix", "write an equation for each of its elements"),
    "set": ("a set", "write an equation for each of its elements"),
    "factorial": ("a factorial", "write the product"),
}


class Refused(Error):
    """Something in a file of CellML that is not supported, or not valid; the message has the component, the variable
    and the line."""


def split(tag: str) -> tuple[str, str]:
    """The namespace and the name of an element or attribute."""
    space, _, name = tag.rpartition("}")
    return space[1:], name


class Document:
    """A file. `lines` has those of components, by (component, "") and of variables, by (component, variable)."""

    def __init__(self, data: bytes | str, file: str = "") -> None:
        self.file, self.lines = file, dict[tuple[str, str], int]()
        self.root = elements_of(data, self.refuse)
        space, tag = split(self.root.tag)
        found = cellml.fullmatch(space)
        if found is None or tag != "model":
            self.refuse(f"the first element is <{tag}>, and not <model> of CellML 1.0, 1.1 or 2.0", self.root.line)
        self.namespace, self.version = found[0], found[1]
        self._look(self.root, "")
        self._check_units()

    def refuse(self, what: str, line: int = 0) -> NoReturn:
        at = f"line {line} of '{self.file}'" if self.file and line else f"line {line}" if line else f"'{self.file}'"
        raise Refused(f"{at}: {what}" if line or self.file else what)

    # -- Checks --------------------------------------------------------------------------------------------------------

    def _look(self, element: Element, component: str) -> int:
        """Takes what is not of CellML or MathML out, notes lines, and refuses what no model here can have. How deep
        libCellML recurs in a formula is returned: an operation of n arguments is n - 1 of two, each in the other."""
        space, tag = split(element.tag)
        name = element.get("name", "")
        if tag == "component" and name:
            component = name
            self.lines[component, ""] = element.line
        elif tag == "variable" and name:
            self.lines[component, name] = element.line
        if tag in _refused and space in (self.namespace, mathml):
            what, instead = _refused[tag]
            self.refuse(f"<{tag}> in component '{component}' is {what}, which Myriad does not read: {instead}",
                        element.line)
        deepest = 0
        for child in [*element]:
            if split(child.tag)[0] in (self.namespace, mathml):
                deepest = max(deepest, self._look(child, component))
            else:
                element.remove(child)
        if space != mathml or tag == "math":
            return 0
        if deepest + len(element) > _longest:
            self.refuse(f"a formula in component '{component}' has operations of more than {_longest} arguments, with "
                        "those in each other: write it in parts, with variables of their own", element.line)
        return deepest + len(element)

    def _check_units(self) -> None:
        """Refuses units that are made of themselves, or of too many, at which libCellML would not end."""
        made_of = {(units.get("name", "")): [unit.get("units", "") for unit in units if split(unit.tag)[1] == "unit"]
                   for units in self.root.iter(f"{{{self.namespace}}}units")}
        size = dict[str, int]()
        for first in made_of:
            waiting, under_way = [(first, False)], dict[str, None]()
            while waiting:
                name, is_known = waiting.pop()
                if is_known:
                    del under_way[name]
                    size[name] = sum(1 + size.get(part, 0) for part in made_of[name])
                    if size[name] > _largest:
                        self.refuse(f"the units '{name}' are a product of more than {_largest} others: define them by "
                                    "units of the standard")
                elif name in under_way:
                    self.refuse(f"the units '{name}' are made of themselves, by way of {', '.join(under_way)}: define "
                                "them by units of the standard")
                elif name in made_of and name not in size:
                    under_way[name] = None
                    waiting += [(name, True), *((part, False) for part in made_of[name])]

    # -- Imports -------------------------------------------------------------------------------------------------------

    def imports(self) -> list[Any]:
        return [child for child in self.root if child.tag == f"{{{self.namespace}}}import"]

    def path_of(self, element: Element, folder: Path | None, beside: Path | None) -> Path:
        """The file that an import names, below the folder `beside`."""
        name = element.get(f"{{{_xlink}}}href", "")
        what = f"the import of '{name}'"
        if folder is None or beside is None:
            self.refuse(f"{what} from a text, beside which there is no file: give the path of the file", element.line)
        if re.match(r"[A-Za-z][A-Za-z0-9+.-]*:|[/\\]", name):
            self.refuse(f"{what} is not of a file beside this one, and nothing else is opened: copy it there and name "
                        "it without a folder", element.line)
        path = (folder / name).resolve()
        if not path.is_relative_to(beside):
            self.refuse(f"{what} leads out of the folder of the model, and nothing else is opened: copy it there",
                        element.line)
        if not name or not path.is_file():
            self.refuse(f"{what}: there is no such file", element.line)
        return path

    # -- Writing -------------------------------------------------------------------------------------------------------

    def text(self) -> str:
        """The elements of CellML and MathML."""
        parts: list[str] = []
        self._write(self.root, "", parts)
        return "".join(parts)

    def _write(self, element: etree.Element, outer: str, parts: list[str]) -> None:
        space, tag = split(element.tag)
        parts.append(f"<{tag}")
        if space != outer:
            parts.append(f' xmlns="{escape(space)}"')
        if not outer:
            parts.append(f' xmlns:cellml="{self.namespace}" xmlns:xlink="{_xlink}"')
        for name, value in element.attrib.items():
            of, plain = split(name)
            prefix = {"": "", self.namespace: "cellml:", _xlink: "xlink:"}.get(of)
            if prefix is not None and plain != "id" and (of != _xlink or tag == "import"):
                parts.append(f' {prefix}{plain}="{escape(value)}"')
        parts.append(f">{escape(element.text or '')}")
        for child in element:
            self._write(child, space, parts)
            parts.append(escape(child.tail or ""))
        parts.append(f"</{tag}>")
