# SPDX-License-Identifier: MIT
"""MathML of SBML as expressions of a model, with constants folded."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Mapping
from typing import Any

from ...base.errors import Error
from ...symbolic import expression as ex
from ...symbolic.folding import apply, both, choose, compare, constant, folded, nan, number
from ...symbolic.table import Table
from ..mathml import operation

#: Avogadro's constant as SBML Level 3 defines it, in 1/mol.
avogadro = 6.02214179e23


class Refused(Error):
    """Something in a file of SBML that is not supported, or not valid; the message has the element, its id and line."""


_factorials = [float(math.factorial(n)) for n in range(171)]  # that double precision holds


class Functions:
    """The user-defined functions of a model, which are written out where they are called, and the names of types of
    MathML's operations."""

    def __init__(self, libsbml: Any) -> None:
        self.names = {getattr(libsbml, name): name[4:] for name in dir(libsbml) if name.startswith("AST_")}
        self.definitions: dict[str, Any] = {}


class Translator:
    """Translates formulas. `lookup` gives the expression of an id, `rate_of` that of its time derivative, and `past`
    that of an expression some time ago; `where` says in messages which element of the file a formula belongs to."""

    def __init__(self, functions: Functions, lookup: Callable[[str, str], Any], rate_of: Callable[[str, str], Any],
                 time: Any) -> None:
        self.functions, self.lookup, self.rate_of, self.time = functions, lookup, rate_of, time
        self.is_past = False  # whether a formula is translated for times that may be before the start
        self.past: Callable[[Any, Any, str], Any] = lambda value, lag, where: value
        self.rate_of_expression: Callable[[Any, str], Any] = lambda expression, where: constant(0.0)
        self.factorials: Table | None = None
        self._calls: dict[Any, tuple[Any, Any]] = {}  # values by function and arguments, which may be called often
        self._calling: list[str] = []

    def __call__(self, formula: Any, where: str, bound: Mapping[str, Any] | None = None) -> Any:
        """The expression of a formula; `bound` has ids with a meaning of their own there."""
        outer, self._calls = self._calls, {}
        try:
            return self._node(formula, where, bound or {})
        finally:
            self._calls = outer

    def _node(self, node: Any, where: str, bound: Mapping[str, Any]) -> Any:
        kind = self.functions.names.get(node.getType(), "UNKNOWN")
        if kind == "NAME":
            name = node.getName()
            return bound[name] if name in bound else self.lookup(name, where)
        if kind == "INTEGER":
            return constant(node.getInteger())
        if kind in ("REAL", "REAL_E", "RATIONAL"):
            return constant(node.getReal())
        if kind in ("CONSTANT_E", "CONSTANT_PI", "CONSTANT_TRUE", "CONSTANT_FALSE", "NAME_AVOGADRO"):
            return constant({"CONSTANT_E": math.e, "CONSTANT_PI": math.pi, "CONSTANT_TRUE": True,
                             "CONSTANT_FALSE": False}.get(kind, avogadro))
        if kind == "NAME_TIME":
            return self.time
        children = [node.getChild(i) for i in range(node.getNumChildren())]
        if kind == "FUNCTION":
            return self._call(node, children, where, bound)
        if kind == "FUNCTION_RATE_OF":
            name = children[0].getName() if children and children[0].isName() else None
            if name is None:
                raise Refused(f"rateOf of something else than an id, in {where}")
            return self.rate_of_expression(bound[name], where) if name in bound else self.rate_of(name, where)
        if kind == "FUNCTION_DELAY" and len(children) == 2:
            return self._past(children[0], children[1], where, bound)
        arguments = [self._node(child, where, bound) for child in children]
        return self._operation(kind, node, arguments, where)

    def _past(self, value: Any, lag: Any, where: str, bound: Mapping[str, Any]) -> Any:
        """The value of a formula some time ago."""
        by = number(self._node(lag, where, bound))
        outer, self.is_past = self.is_past, True
        calls, self._calls = self._calls, {}
        try:
            return self.past(number(self._node(value, where, bound)), by, where)
        finally:
            self.is_past, self._calls = outer, calls

    def _operation(self, kind: str, node: Any, arguments: list[Any], where: str) -> Any:
        name = re.sub("^(FUNCTION|LOGICAL|RELATIONAL)_", "", kind).lower()
        if name == "factorial" and len(arguments) == 1:
            return folded(self._factorial(number(arguments[0])))
        made = operation(name, arguments)
        if made is None:
            raise Refused(f"`{node.getName() or name}` with {len(arguments)} arguments in {where}, which Myriad does "
                          "not know")
        return made

    def _factorial(self, n: Any) -> Any:
        """The factorial of a whole number, from a table; NaN of others."""
        if self.factorials is None:
            self.factorials = Table("factorials", _factorials)
        found = ex.make("lookup", (n,), (self.factorials, 0, 1, len(_factorials)))
        is_whole = both(compare("greater_equal", n, constant(0.0)), compare("equal", n, apply(ex.floor, n)))
        too_large = compare("greater", n, constant(len(_factorials) - 1.0))
        return choose(is_whole, choose(too_large, constant(math.inf), found), nan)

    def _call(self, node: Any, children: list[Any], where: str, bound: Mapping[str, Any]) -> Any:
        name = node.getName()
        definition = self.functions.definitions.get(name)
        if definition is None:
            raise Refused(f"the function `{name}`, which nothing defines, in {where}")
        if definition.getNumArguments() != len(children):
            raise Refused(f"`{name}` with {len(children)} arguments instead of {definition.getNumArguments()}, in "
                          f"{where}")
        if definition.getBody() is None:
            raise Refused(f"the function `{name}`, whose definition has no formula, in {where}")
        values = {definition.getArgument(i).getName(): self._node(child, where, bound)
                  for i, child in enumerate(children)}
        if name in self._calling:
            raise Refused(f"the function `{name}`, which calls itself, in {where}")
        # of functions that call others twice, each is written out once for the same arguments, which are kept alive
        key = (name, *map(id, values.values()))
        if key not in self._calls:
            self._calling.append(name)
            try:
                self._calls[key] = self._node(definition.getBody(), where, values), values
            finally:
                self._calling.pop()
        return self._calls[key][0]
