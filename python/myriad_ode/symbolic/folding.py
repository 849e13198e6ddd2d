# SPDX-License-Identifier: MIT
"""Operations on expressions that compute constants at once, as readers of files need them: numbers and conditions stand
for each other, as files use them."""

from __future__ import annotations

import functools
import math
from collections.abc import Callable
from typing import Any

import numpy as np

from . import expression as ex, functions as fn
from .evaluate import evaluate
from .expression import Expression, as_node


def constant(value: Any) -> Expression:
    """The node of a number, which may be infinite or NaN."""
    if isinstance(value, (bool, np.bool_)):
        return ex.constant(bool(value))
    value = float(value)
    if math.isnan(value):  # as a difference, since a constant of a model is never NaN, and 0 / 0 is whole in C++
        return ex.make("subtract", (ex.constant(math.inf), ex.constant(math.inf)))
    return ex.constant(value)


nan = constant(math.nan)


def is_constant(node: Any) -> bool:
    """Whether an expression is a number or a truth value."""
    return node.op in ("constant", "truth") or node is nan


def value_of(node: Any) -> Any:
    """The number or truth value that a constant is."""
    return math.nan if node is nan else node.value


def folded(node: Any) -> Any:
    """The constant that an operation of constants is; other expressions as they are."""
    if node.args and node is not nan and all(is_constant(a) for a in node.args):
        value, = evaluate([node], {})
        return constant(bool(value) if node.type == ex.condition else value)
    return node


def number(node: Any) -> Any:
    """A number: of a condition 1 where it holds, and 0 elsewhere."""
    return folded(ex.make("select", (node, ex.constant(1.0), ex.constant(0.0)))) if node.type == ex.condition else node


def truth(node: Any) -> Any:
    """A condition: of a number whether it is not zero."""
    return node if node.type == ex.condition else folded(ex.make("not_equal", (node, ex.constant(0.0)),
                                                                  type=ex.condition))


def make_folded(op: str, *arguments: Any) -> Any:
    """An operation on numbers."""
    return folded(ex.make(op, tuple(number(a) for a in arguments)))


def add(a: Any, b: Any) -> Any:
    """a + b, of which zero is left out."""
    if is_constant(a) and value_of(a) == 0:
        return b
    return a if is_constant(b) and value_of(b) == 0 else make_folded("add", a, b)


def subtract(a: Any, b: Any) -> Any:
    """a - b, of which zero is left out."""
    if is_constant(a) and value_of(a) == 0:
        return make_folded("negate", b)
    return a if is_constant(b) and value_of(b) == 0 else make_folded("subtract", a, b)


def multiply(a: Any, b: Any) -> Any:
    """a * b, of which one is left out."""
    if is_constant(a) and value_of(a) == 1:
        return b
    return a if is_constant(b) and value_of(b) == 1 else make_folded("multiply", a, b)


def divide(a: Any, b: Any) -> Any:
    """a / b; infinite or NaN where b is zero."""
    return a if is_constant(b) and value_of(b) == 1 else make_folded("divide", a, b)


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
    parts = [*_parts(op, a), *_parts(op, b)]
    known = {id(part) for part in parts}
    if any(part.op == "not" and id(part.args[0]) in known for part in parts):
        return constant(not neutral)  # c and not c, c or not c
    if id(b) in {id(part) for part in _parts(op, a)}:
        return a
    return ex.make(op, (a, b), type=ex.condition)


def _parts(op: str, condition: Any) -> list[Any]:
    """Some of the conditions that `and` or `or` connects."""
    found: list[Any] = []
    waiting = [condition]
    while waiting and len(found) < 32:
        part = waiting.pop()
        if part.op == op:
            waiting += part.args
        else:
            found.append(part)
    return found


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
    value, = evaluate([as_node(function(*symbols))], dict(zip(symbols, map(value_of, arguments))))
    return constant(value)


def power(base: Any, exponent: Any) -> Any:
    """base to the power exponent; whole constant exponents by multiplication."""
    base, exponent = number(base), number(exponent)
    if is_constant(base) and is_constant(exponent):
        with np.errstate(all="ignore"):
            return constant(np.power(np.float64(value_of(base)), np.float64(value_of(exponent))))
    if is_constant(exponent) and not math.isfinite(value_of(exponent)):
        return ex.make("pow", (base, exponent))
    return as_node(fn.pow(base, exponent))


def total(terms: list[Any]) -> Any:
    """The sum of expressions."""
    return functools.reduce(add, terms, constant(0.0))
