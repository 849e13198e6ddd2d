# SPDX-License-Identifier: MIT
"""Equations of libCellML's analysis as expressions of a model, with constants folded."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

from ...symbolic.folding import constant, make_folded, number
from ..mathml import operation
from .document import Refused

_largest = 700.0  #: exponent: larger ones would overflow, and rates of cells be infinite that are large for a moment
_constants = {"true": True, "false": False, "e": math.e, "pi": math.pi, "inf": math.inf, "nan": math.nan}
_inverse = {f"a{name}": f"arc{name}" for of in ("sin", "cos", "tan", "sec", "csc", "cot") for name in (of, f"{of}h")}


class Translator:
    """Translates trees. `lookup` gives the expression of a variable, `rate_of` that of its derivative by time."""

    def __init__(self, libcellml: Any, lookup: Callable[[Any], Any], rate_of: Callable[[Any], Any]) -> None:
        types = libcellml.AnalyserEquationAst.Type
        self._names = {getattr(types, name): name.lower() for name in dir(types) if name.isupper()}
        self.lookup, self.rate_of = lookup, rate_of

    def name(self, node: Any) -> str:
        """The operation of a node, by its name in MathML."""
        name = self._names.get(node.type(), "unknown")
        return _inverse.get(name, name)

    def __call__(self, node: Any, where: str) -> Any:
        """The expression of a node; `where` says in messages which equation it belongs to."""
        name = self.name(node)
        if name == "ci":
            return self.lookup(node.variable())
        if name == "cn":
            return constant(float(node.value()))
        if name in _constants:
            return constant(_constants[name])
        if name == "diff":
            return self.rate_of(node.rightChild().variable())
        children = [child for child in (node.leftChild(), node.rightChild()) if child is not None]
        if name in ("degree", "logbase", "otherwise"):
            return self(children[0], where)
        if name == "piecewise":
            return operation(name, self._pieces(node, where))
        arguments = [self(child, where) for child in children]
        if name == "exp" and len(arguments) == 1:
            arguments = [make_folded("min", number(arguments[0]), constant(_largest))]
        made = operation(name, arguments)
        if made is None:
            raise Refused(f"`{name}` with {len(children)} arguments in the equation of {where}, which Myriad does not "
                          "know")
        return made

    def _pieces(self, node: Any, where: str) -> list[Any]:
        """Values, each with its condition behind it, and what is otherwise, of pieces that hang one in the other."""
        parts: list[Any] = []
        while node is not None and self.name(node) == "piecewise":
            parts.append(node.leftChild())
            node = node.rightChild()
        if node is not None:
            parts.append(node)
        found = []
        for part in parts:
            inner = [part.leftChild(), part.rightChild()] if self.name(part) == "piece" else [part]
            found += [self(child, where) for child in inner]
        return found
