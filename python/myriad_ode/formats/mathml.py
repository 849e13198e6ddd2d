# SPDX-License-Identifier: MIT
"""What the operations of MathML make of expressions, with constants folded."""

from __future__ import annotations

import functools
import math
from collections.abc import Callable
from typing import Any

import numpy as np

from ..symbolic import expression as ex, functions as fn
from ..symbolic.folding import (add, apply, both, choose, compare, constant, divide, either, is_constant, make_folded,
                                multiply, nan, number, opposite, power, subtract, truth, value_of)
from ..symbolic.numpy_functions import of_numbers


def _numpys(name: str) -> Callable[..., Any]:
    found = of_numbers(getattr(np, name))
    assert found is not None
    return found


def _of_reciprocal(function: Callable[..., Any]) -> Callable[..., Any]:
    return lambda x: function(1.0 / x)


_arsinh, _arcosh, _artanh = map(_numpys, ("arcsinh", "arccosh", "arctanh"))
_functions: dict[str, Callable[..., Any]] = {
    "abs": ex.abs, "exp": fn.exp, "ln": fn.log, "floor": ex.floor, "ceiling": ex.ceil,
    "sin": fn.sin, "cos": fn.cos, "tan": fn.tan, "sinh": fn.sinh, "cosh": fn.cosh, "tanh": fn.tanh,
    "arcsin": fn.asin, "arccos": fn.acos, "arctan": fn.atan,
    "arcsinh": _arsinh, "arccosh": _arcosh, "arctanh": _artanh,
    "sec": lambda x: 1.0 / fn.cos(x), "csc": lambda x: 1.0 / fn.sin(x), "cot": lambda x: 1.0 / fn.tan(x),
    "sech": lambda x: 1.0 / fn.cosh(x), "csch": lambda x: 1.0 / fn.sinh(x), "coth": lambda x: 1.0 / fn.tanh(x),
    "arcsec": _of_reciprocal(fn.acos), "arccsc": _of_reciprocal(fn.asin), "arccot": _of_reciprocal(fn.atan),
    "arcsech": _of_reciprocal(_arcosh), "arccsch": _of_reciprocal(_arsinh), "arccoth": _of_reciprocal(_artanh),
}
_binary: dict[str, Callable[..., Any]] = {
    "rem": fn.fmod, "quotient": lambda a, b: ex.round((a - fn.fmod(a, b)) / b),
}
_comparisons = {"eq": "equal", "neq": "not_equal", "lt": "less", "leq": "less_equal", "gt": "greater",
                "geq": "greater_equal"}


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


def _piecewise(arguments: list[Any]) -> Any:
    chosen = arguments[-1] if len(arguments) % 2 else nan
    for value, condition in reversed(list(zip(arguments[::2], arguments[1::2]))):
        chosen = choose(condition, value, chosen)
    return chosen


def operation(name: str, arguments: list[Any]) -> Any:
    """The value of an operation, by its name in MathML; None if it has none with so many arguments. The arguments of
    `piecewise` are values, each with its condition behind it, and what is otherwise; those of `root` and `log` may have
    the degree or the base first."""
    count = len(arguments)
    if name == "plus":
        return functools.reduce(add, arguments, constant(0.0))
    if name == "times":
        return number(functools.reduce(multiply, arguments, constant(1.0)))
    if name == "minus" and count in (1, 2):
        return make_folded("negate", *arguments) if count == 1 else subtract(*arguments)
    if name == "and":
        return functools.reduce(both, arguments, constant(True))
    if name == "or":
        return functools.reduce(either, arguments, constant(False))
    if name == "xor":
        return functools.reduce(lambda a, b: choose(a, opposite(b), truth(b)), arguments, constant(False))
    if name == "not" and count == 1:
        return opposite(arguments[0])
    if name == "piecewise":
        return _piecewise(arguments)
    if name in _comparisons:
        pairs = zip(arguments, arguments[1:])
        return functools.reduce(both, (compare(_comparisons[name], a, b) for a, b in pairs), constant(True))
    if name in ("min", "max") and arguments:
        return functools.reduce(functools.partial(make_folded, name), map(number, arguments))
    if name in ("root", "log") and count in (1, 2):
        first = constant(2.0 if name == "root" else 10.0)
        return (_root if name == "root" else _log)(*map(number, ([first] + arguments)[-2:]))
    if count == 2 and name in ("divide", "power", "implies"):
        made = {"divide": divide, "implies": lambda a, b: either(opposite(a), b)}
        return made.get(name, power)(*arguments)
    if (name in _functions and count == 1) or (name in _binary and count == 2):
        return apply(_functions[name] if count == 1 else _binary[name], *arguments)
    return None
