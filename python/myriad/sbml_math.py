# SPDX-License-Identifier: MIT
"""MathML of SBML as expressions of a model, with constants folded."""

from __future__ import annotations

import functools
import math
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from . import expression as ex
from .errors import Error
from .expression import Expression, as_node
from .numpy_functions import of_numbers
from .table import Table

#: Avogadro's constant as SBML Level 3 defines it, in 1/mol.
avogadro = 6.02214179e23


class Refused(Error):
    """Something in a file of SBML that is not supported, or not valid; the message has the element, its id and line."""


# -- Constants ---------------------------------------------------------------------------------------------------------


def constant(value: Any) -> Expression:
    """The node of a number, which may be infinite or NaN."""
    if isinstance(value, (bool, np.bool_)):
        return ex.constant(bool(value))
    value = float(value)
    if math.isnan(value):  # as a difference, since a constant of a model is never NaN, and 0 / 0 is whole in C++
        return ex.make("subtract", (ex.constant(math.inf), ex.constant(math.inf)))
    return ex.constant(value)


_nan = constant(math.nan)


def is_constant(node: Any) -> bool:
    """Whether an expression is a number or a truth value."""
    return node.op in ("constant", "truth") or node is _nan


def value_of(node: Any) -> Any:
    """The number or truth value that a constant is."""
    return math.nan if node is _nan else node.value


def folded(node: Any) -> Any:
    """The constant that an operation of constants is; other expressions as they are."""
    if node.args and node is not _nan and all(is_constant(a) for a in node.args):
        value, = ex.evaluate([node], {})
        return constant(bool(value) if node.type == ex.condition else value)
    return node


def number(node: Any) -> Any:
    """A number: of a condition 1 where it holds, and 0 elsewhere."""
    return folded(ex.make("select", (node, ex.constant(1.0), ex.constant(0.0)))) if node.type == ex.condition else node


def truth(node: Any) -> Any:
    """A condition: of a number whether it is not zero."""
    return node if node.type == ex.condition else folded(ex.make("not_equal", (node, ex.constant(0.0)),
                                                                  type=ex.condition))


def _make(op: str, *arguments: Any) -> Any:
    return folded(ex.make(op, tuple(number(a) for a in arguments)))


def add(a: Any, b: Any) -> Any:
    """a + b, of which zero is left out."""
    if is_constant(a) and value_of(a) == 0:
        return b
    return a if is_constant(b) and value_of(b) == 0 else _make("add", a, b)


def subtract(a: Any, b: Any) -> Any:
    """a - b, of which zero is left out."""
    if is_constant(a) and value_of(a) == 0:
        return _make("negate", b)
    return a if is_constant(b) and value_of(b) == 0 else _make("subtract", a, b)


def multiply(a: Any, b: Any) -> Any:
    """a * b, of which one is left out."""
    if is_constant(a) and value_of(a) == 1:
        return b
    return a if is_constant(b) and value_of(b) == 1 else _make("multiply", a, b)


def divide(a: Any, b: Any) -> Any:
    """a / b; infinite or NaN where b is zero."""
    return a if is_constant(b) and value_of(b) == 1 else _make("divide", a, b)


def both(a: Any, b: Any) -> Any:
    """Whether both conditions hold."""
    return _connective("and", a, b, neutral=True)


def either(a: Any, b: Any) -> Any:
    """Whether one of two conditions holds."""
    return _connective("or", a, b, neutral=False)


def _connective(op: str, a: Any, b: Any, neutral: bool) -> Any:
    a, b = truth(a), truth(b)
    for one, other in ((a, b), (b, a)):
        if one.op == "truth":
            return other if one.value is neutral else one
    return ex.make(op, (a, b), type=ex.condition)


def opposite(a: Any) -> Any:
    """Whether a condition does not hold."""
    a = truth(a)
    return a.args[0] if a.op == "not" else folded(ex.make("not", (a,), type=ex.condition))


def choose(condition: Any, a: Any, b: Any) -> Any:
    """a where the condition holds, else b."""
    condition = truth(condition)
    if condition.op == "truth":
        return a if condition.value else b
    if a.type == b.type == ex.condition:
        return either(both(condition, a), both(opposite(condition), b))
    a, b = number(a), number(b)
    kind = ex.integer if a.type == b.type == ex.integer else ex.real
    return a if a is b else ex.make("select", (condition, a, b), type=kind)


def compare(op: str, a: Any, b: Any) -> Any:
    """A condition, such as `compare("less", a, b)`."""
    return folded(ex.make(op, (number(a), number(b)), type=ex.condition))


def apply(function: Callable[..., Any], *arguments: Any) -> Any:
    """A function of this package, computed at once where all arguments are constants."""
    arguments = tuple(number(a) for a in arguments)
    if not all(is_constant(a) for a in arguments):
        return as_node(function(*arguments))
    symbols = [ex.make("symbol", value=("argument", str(i))) for i in range(len(arguments))]
    value, = ex.evaluate([as_node(function(*symbols))], dict(zip(symbols, map(value_of, arguments))))
    return constant(value)


def power(base: Any, exponent: Any) -> Any:
    """base to the power exponent; whole constant exponents by multiplication."""
    base, exponent = number(base), number(exponent)
    if is_constant(base) and is_constant(exponent):
        with np.errstate(all="ignore"):
            return constant(np.power(np.float64(value_of(base)), np.float64(value_of(exponent))))
    if is_constant(exponent) and not math.isfinite(value_of(exponent)):
        return ex.make("pow", (base, exponent))
    return as_node(ex.pow(base, exponent))


# -- MathML ------------------------------------------------------------------------------------------------------------


def _numpys(name: str) -> Callable[..., Any]:
    return functools.partial(lambda function, x: of_numbers(function)(x), getattr(np, name))


def _of_reciprocal(function: Callable[..., Any]) -> Callable[..., Any]:
    return lambda x: function(1.0 / x)


_arsinh, _arcosh, _artanh = map(_numpys, ("arcsinh", "arccosh", "arctanh"))
_functions: dict[str, Callable[..., Any]] = {
    "FUNCTION_ABS": ex.abs, "FUNCTION_EXP": ex.exp, "FUNCTION_LN": ex.log, "FUNCTION_FLOOR": ex.floor,
    "FUNCTION_CEILING": ex.ceil, "FUNCTION_SIN": ex.sin, "FUNCTION_COS": ex.cos, "FUNCTION_TAN": ex.tan,
    "FUNCTION_SINH": ex.sinh, "FUNCTION_COSH": ex.cosh, "FUNCTION_TANH": ex.tanh, "FUNCTION_ARCSIN": ex.asin,
    "FUNCTION_ARCCOS": ex.acos, "FUNCTION_ARCTAN": ex.atan, "FUNCTION_ARCSINH": _arsinh, "FUNCTION_ARCCOSH": _arcosh,
    "FUNCTION_ARCTANH": _artanh,
    "FUNCTION_SEC": lambda x: 1.0 / ex.cos(x), "FUNCTION_CSC": lambda x: 1.0 / ex.sin(x),
    "FUNCTION_COT": lambda x: 1.0 / ex.tan(x), "FUNCTION_SECH": lambda x: 1.0 / ex.cosh(x),
    "FUNCTION_CSCH": lambda x: 1.0 / ex.sinh(x), "FUNCTION_COTH": lambda x: 1.0 / ex.tanh(x),
    "FUNCTION_ARCSEC": _of_reciprocal(ex.acos), "FUNCTION_ARCCSC": _of_reciprocal(ex.asin),
    "FUNCTION_ARCCOT": _of_reciprocal(ex.atan), "FUNCTION_ARCSECH": _of_reciprocal(_arcosh),
    "FUNCTION_ARCCSCH": _of_reciprocal(_arsinh), "FUNCTION_ARCCOTH": _of_reciprocal(_artanh),
    "FUNCTION_REM": ex.fmod, "FUNCTION_QUOTIENT": lambda a, b: ex.round((a - ex.fmod(a, b)) / b),
}
_comparisons = {"RELATIONAL_EQ": "equal", "RELATIONAL_NEQ": "not_equal", "RELATIONAL_LT": "less",
                "RELATIONAL_LEQ": "less_equal", "RELATIONAL_GT": "greater", "RELATIONAL_GEQ": "greater_equal"}


_factorials = [float(math.factorial(n)) for n in range(171)]  # that double precision holds


def _root(degree: Any, x: Any) -> Any:
    if not is_constant(degree):
        return power(x, divide(constant(1.0), degree))
    n = value_of(degree)
    if n == 2:
        return apply(ex.sqrt, x)
    if n % 2 == 1:  # odd roots are defined for all numbers
        return apply(ex.cbrt, x) if n == 3 else apply(lambda y: ex.copysign(ex.pow(ex.abs(y), 1.0 / n), y), x)
    return power(x, constant(1.0 / n if n else math.inf))


def _log(base: Any, x: Any) -> Any:
    if is_constant(base) and value_of(base) in (2, 10):
        return apply(ex.log2 if value_of(base) == 2 else ex.log10, x)
    return divide(apply(ex.log, x), apply(ex.log, base))


class Functions:
    """The user-defined functions of a model, which are written out where they are called, and the names of types of
    MathML's operations."""

    def __init__(self, libsbml: Any) -> None:
        self.names = {getattr(libsbml, name): name[4:] for name in dir(libsbml) if name.startswith("AST_")}
        self.definitions: dict[str, Any] = {}


class Translator:
    """Translates formulas. `lookup` gives the expression of an id, `rate_of` that of its time derivative; `where` says
    in messages which element of the file a formula belongs to."""

    def __init__(self, functions: Functions, lookup: Callable[[str, str], Any], rate_of: Callable[[str, str], Any],
                 time: Any) -> None:
        self.functions, self.lookup, self.rate_of, self.time = functions, lookup, rate_of, time
        self.rate_of_expression: Callable[[Any, str], Any] = lambda expression, where: constant(0.0)
        self.factorials: Table | None = None

    def __call__(self, formula: Any, where: str, bound: Mapping[str, Any] | None = None) -> Any:
        """The expression of a formula; `bound` has ids with a meaning of their own there."""
        try:
            return self._node(formula, where, bound or {})
        except RecursionError:
            raise Refused(f"{where} is nested too deeply: write it in parts") from None

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
        if kind == "FUNCTION_DELAY":
            raise Refused(f"a delay, in {where}")
        arguments = [self._node(child, where, bound) for child in children]
        return self._operation(kind, node, arguments, where)

    def _operation(self, kind: str, node: Any, arguments: list[Any], where: str) -> Any:
        if kind == "PLUS":
            return functools.reduce(add, arguments, constant(0.0))
        if kind == "TIMES":
            return number(functools.reduce(multiply, arguments, constant(1.0)))
        if kind == "MINUS" and len(arguments) in (1, 2):
            return _make("negate", *arguments) if len(arguments) == 1 else subtract(*arguments)
        if kind == "LOGICAL_AND":
            return functools.reduce(both, arguments, constant(True))
        if kind == "LOGICAL_OR":
            return functools.reduce(either, arguments, constant(False))
        if kind == "LOGICAL_XOR":
            return functools.reduce(lambda a, b: choose(a, opposite(b), truth(b)), arguments, constant(False))
        if kind == "LOGICAL_NOT" and len(arguments) == 1:
            return opposite(arguments[0])
        if kind == "FUNCTION_PIECEWISE":
            chosen = arguments.pop() if len(arguments) % 2 else _nan
            for value, condition in reversed(list(zip(arguments[::2], arguments[1::2]))):
                chosen = choose(condition, value, chosen)
            return chosen
        if kind in _comparisons:
            pairs = zip(arguments, arguments[1:])
            return functools.reduce(both, (compare(_comparisons[kind], a, b) for a, b in pairs), constant(True))
        if kind in ("FUNCTION_MIN", "FUNCTION_MAX") and arguments:
            return functools.reduce(functools.partial(_make, kind[-3:].lower()), map(number, arguments))
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
        return choose(is_whole, choose(too_large, constant(math.inf), found), _nan)

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
        return self._node(definition.getBody(), where, values)


def _functions_arguments(kind: str) -> int:
    return 2 if kind in ("FUNCTION_REM", "FUNCTION_QUOTIENT") else 1


def total(terms: list[Any]) -> Any:
    """The sum of expressions."""
    return functools.reduce(add, terms, constant(0.0))


