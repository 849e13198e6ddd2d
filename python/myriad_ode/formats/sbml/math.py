# SPDX-License-Identifier: MIT
"""MathML of SBML as expressions of a model, with constants folded."""

from __future__ import annotations

import functools
import math
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from ...base.errors import Error
from ...symbolic import expression as ex, functions as fn
from ...symbolic.folding import (add, apply, both, choose, compare, constant, divide, either, folded, is_constant,
                                 make_folded, multiply, nan, number, opposite, power, subtract, truth, value_of)
from ...symbolic.numpy_functions import of_numbers
from ...symbolic.table import Table

#: Avogadro's constant as SBML Level 3 defines it, in 1/mol.
avogadro = 6.02214179e23


class Refused(Error):
    """Something in a file of SBML that is not supported, or not valid; the message has the element, its id and line."""


# -- MathML ------------------------------------------------------------------------------------------------------------


def _numpys(name: str) -> Callable[..., Any]:
    found = of_numbers(getattr(np, name))
    assert found is not None
    return found


def _of_reciprocal(function: Callable[..., Any]) -> Callable[..., Any]:
    return lambda x: function(1.0 / x)


_arsinh, _arcosh, _artanh = map(_numpys, ("arcsinh", "arccosh", "arctanh"))
_functions: dict[str, Callable[..., Any]] = {
    "FUNCTION_ABS": ex.abs, "FUNCTION_EXP": fn.exp, "FUNCTION_LN": fn.log, "FUNCTION_FLOOR": ex.floor,
    "FUNCTION_CEILING": ex.ceil, "FUNCTION_SIN": fn.sin, "FUNCTION_COS": fn.cos, "FUNCTION_TAN": fn.tan,
    "FUNCTION_SINH": fn.sinh, "FUNCTION_COSH": fn.cosh, "FUNCTION_TANH": fn.tanh, "FUNCTION_ARCSIN": fn.asin,
    "FUNCTION_ARCCOS": fn.acos, "FUNCTION_ARCTAN": fn.atan, "FUNCTION_ARCSINH": _arsinh, "FUNCTION_ARCCOSH": _arcosh,
    "FUNCTION_ARCTANH": _artanh,
    "FUNCTION_SEC": lambda x: 1.0 / fn.cos(x), "FUNCTION_CSC": lambda x: 1.0 / fn.sin(x),
    "FUNCTION_COT": lambda x: 1.0 / fn.tan(x), "FUNCTION_SECH": lambda x: 1.0 / fn.cosh(x),
    "FUNCTION_CSCH": lambda x: 1.0 / fn.sinh(x), "FUNCTION_COTH": lambda x: 1.0 / fn.tanh(x),
    "FUNCTION_ARCSEC": _of_reciprocal(fn.acos), "FUNCTION_ARCCSC": _of_reciprocal(fn.asin),
    "FUNCTION_ARCCOT": _of_reciprocal(fn.atan), "FUNCTION_ARCSECH": _of_reciprocal(_arcosh),
    "FUNCTION_ARCCSCH": _of_reciprocal(_arsinh), "FUNCTION_ARCCOTH": _of_reciprocal(_artanh),
    "FUNCTION_REM": fn.fmod, "FUNCTION_QUOTIENT": lambda a, b: ex.round((a - fn.fmod(a, b)) / b),
}
_comparisons = {"RELATIONAL_EQ": "equal", "RELATIONAL_NEQ": "not_equal", "RELATIONAL_LT": "less",
                "RELATIONAL_LEQ": "less_equal", "RELATIONAL_GT": "greater", "RELATIONAL_GEQ": "greater_equal"}


_factorials = [float(math.factorial(n)) for n in range(171)]  # that double precision holds


def _root(degree: Any, x: Any) -> Any:
    if not is_constant(degree):
        return power(x, divide(constant(1.0), degree))
    n = value_of(degree)
    if n == 2:
        return apply(fn.sqrt, x)
    if n % 2 == 1:  # odd roots are defined for all numbers
        return apply(fn.cbrt, x) if n == 3 else apply(lambda y: fn.copysign(fn.pow(ex.abs(y), 1.0 / n), y), x)
    return power(x, constant(1.0 / n if n else math.inf))


def _log(base: Any, x: Any) -> Any:
    if is_constant(base) and value_of(base) in (2, 10):
        return apply(fn.log2 if value_of(base) == 2 else fn.log10, x)
    return divide(apply(fn.log, x), apply(fn.log, base))


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
        if kind == "PLUS":
            return functools.reduce(add, arguments, constant(0.0))
        if kind == "TIMES":
            return number(functools.reduce(multiply, arguments, constant(1.0)))
        if kind == "MINUS" and len(arguments) in (1, 2):
            return make_folded("negate", *arguments) if len(arguments) == 1 else subtract(*arguments)
        if kind == "LOGICAL_AND":
            return functools.reduce(both, arguments, constant(True))
        if kind == "LOGICAL_OR":
            return functools.reduce(either, arguments, constant(False))
        if kind == "LOGICAL_XOR":
            return functools.reduce(lambda a, b: choose(a, opposite(b), truth(b)), arguments, constant(False))
        if kind == "LOGICAL_NOT" and len(arguments) == 1:
            return opposite(arguments[0])
        if kind == "FUNCTION_PIECEWISE":
            chosen = arguments.pop() if len(arguments) % 2 else nan
            for value, condition in reversed(list(zip(arguments[::2], arguments[1::2]))):
                chosen = choose(condition, value, chosen)
            return chosen
        if kind in _comparisons:
            pairs = zip(arguments, arguments[1:])
            return functools.reduce(both, (compare(_comparisons[kind], a, b) for a, b in pairs), constant(True))
        if kind in ("FUNCTION_MIN", "FUNCTION_MAX") and arguments:
            return functools.reduce(functools.partial(make_folded, kind[-3:].lower()), map(number, arguments))
        if kind == "FUNCTION_FACTORIAL" and len(arguments) == 1:
            return folded(self._factorial(number(arguments[0])))
        if kind in ("FUNCTION_ROOT", "FUNCTION_LOG") and len(arguments) in (1, 2):
            first = constant(2.0 if kind == "FUNCTION_ROOT" else 10.0)
            return (_root if kind == "FUNCTION_ROOT" else _log)(*map(number, ([first] + arguments)[-2:]))
        if len(arguments) == 2 and kind in ("DIVIDE", "POWER", "FUNCTION_POWER", "LOGICAL_IMPLIES"):
            made = {"DIVIDE": divide, "LOGICAL_IMPLIES": lambda a, b: either(opposite(a), b)}
            return made.get(kind, power)(*arguments)
        if kind in _functions and len(arguments) == _functions_arguments(kind):
            return apply(_functions[kind], *arguments)
        raise Refused(f"`{node.getName() or kind.removeprefix('FUNCTION_').lower()}` with {len(arguments)} arguments "
                      f"in {where}, which Myriad does not know")

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


def _functions_arguments(kind: str) -> int:
    return 2 if kind in ("FUNCTION_REM", "FUNCTION_QUOTIENT") else 1
