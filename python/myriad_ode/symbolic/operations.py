# SPDX-License-Identifier: MIT
"""The table of operations: of each its value by NumPy, its derivatives, what it costs, and what to call its result. A
function that is added to functions.py has its row here."""

from __future__ import annotations

import math
import operator
from collections.abc import Callable, Iterable, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from . import expression as ex, functions as fn
from .node import walk

if TYPE_CHECKING:
    from .expression import Expression, Operand
    from .node import Node


class Operation(NamedTuple):
    """What is known of an operation."""

    #: of its arguments, by NumPy; None where `evaluate` knows
    value: Callable[..., Any] | None
    #: of its result and its arguments, the derivatives by these: None where it does not depend on one, a condition
    #: where the argument is passed on if it holds
    partials: Callable[..., Sequence[Any]] | None = None
    #: about how many, of a processor; the same as in kernel/scalar/dependence.hpp
    instructions: int = 1
    #: of a variable with its result, in C++; otherwise the operation's own
    result: str = ""
    #: whether a derivative may be infinite where the value is finite, or a product that has no value, as sqrt at zero
    is_singular: bool = False


_ln2, _ln10 = math.log(2.0), math.log(10.0)


def _sinpi(x: Any) -> Any:
    return np.sin(np.pi * (x - 2.0 * np.rint(0.5 * x)))


def _cospi(x: Any) -> Any:
    return np.cos(np.pi * (x - 2.0 * np.rint(0.5 * x)))


def _quotient(a: Expression, by: Expression) -> Expression:
    """a / by; zero where both are."""
    return fn.where(by == 0.0, 0.0, a / by)


def _of_power(f: Expression, base: Expression, exponent: Expression,
              power: Callable[[Operand, Operand], Expression]) -> tuple[Expression, Expression | None]:
    slope = exponent * power(base, exponent - 1)
    if exponent.op == "constant":
        return slope, None
    return fn.where(exponent == 0.0, 0.0, slope), fn.where(f == 0.0, 0.0, f * fn.log(base))


def _of_product(f: Expression, *_: Expression) -> list[Any]:
    table, row = f.value
    return [ex.make("element", value=(table, place)) for place in table.places(row)]


# C++ has functions of its own for values.
operations: dict[str, Operation] = {
    "add": Operation(operator.add, lambda f, a, b: (1, 1), result="sum"),
    "subtract": Operation(operator.sub, lambda f, a, b: (1, -1), result="difference"),
    "multiply": Operation(operator.mul, lambda f, a, b: (b, a), result="product"),
    "divide": Operation(operator.truediv, lambda f, a, b: (1 / b, -f / b), 8, "quotient"),
    "negate": Operation(operator.neg, lambda f, a: (-1,), result="opposite"),
    "fma": Operation(lambda a, b, c: a * b + c, lambda f, a, b, c: (b, a, 1)),
    "reciprocal": Operation(lambda x: 1.0 / x, lambda f, a: (-f * f,), 8, "inverse"),
    "rsqrt": Operation(lambda x: 1.0 / np.sqrt(x), lambda f, a: (-0.5 * (f * f * f),), 8, "inverse_root"),
    "sqrt": Operation(np.sqrt, lambda f, a: (0.5 / f,), 8, "root", True),
    "cbrt": Operation(np.cbrt, lambda f, a: (1 / (3 * f * f),), 15, is_singular=True),
    "abs": Operation(np.abs, lambda f, a: (fn.copysign(1.0, a),), result="size"),
    "floor": Operation(np.floor, lambda f, a: (None,)),
    "rint": Operation(np.rint, lambda f, a: (None,)),
    "sin": Operation(np.sin, lambda f, a: (fn.cos(a),), 15, "sine"),
    "cos": Operation(np.cos, lambda f, a: (-fn.sin(a),), 15, "cosine"),
    "sinpi": Operation(_sinpi, lambda f, a: (fn.pi * fn.cospi(a),), 15),
    "cospi": Operation(_cospi, lambda f, a: (-fn.pi * fn.sinpi(a),), 15),
    "sincos.sine": Operation(np.sin, lambda f, a: (fn.sincos(a)[1],), 10),
    "sincos.cosine": Operation(np.cos, lambda f, a: (-fn.sincos(a)[0],), 10),
    "sincospi.sine": Operation(_sinpi, lambda f, a: (fn.pi * fn.sincospi(a)[1],), 10),
    "sincospi.cosine": Operation(_cospi, lambda f, a: (-fn.pi * fn.sincospi(a)[0],), 10),
    "tan": Operation(np.tan, lambda f, a: (1 + f * f,), 25),
    "asin": Operation(np.arcsin, lambda f, a: (1 / fn.sqrt(1 - a * a),), 15, is_singular=True),
    "acos": Operation(np.arccos, lambda f, a: (-1 / fn.sqrt(1 - a * a),), 15, is_singular=True),
    "atan": Operation(np.arctan, lambda f, a: (1 / (1 + a * a),), 15),
    "sinh": Operation(np.sinh, lambda f, a: (fn.cosh(a),), 15),
    "cosh": Operation(np.cosh, lambda f, a: (fn.sinh(a),), 15),
    "tanh": Operation(np.tanh, lambda f, a: (1 - f * f,), 15),
    "exp": Operation(np.exp, lambda f, a: (f,), 15, "exponential"),
    "exp2": Operation(np.exp2, lambda f, a: (_ln2 * f,), 15),
    "expm1": Operation(np.expm1, lambda f, a: (fn.exp(a),), 15),
    "log": Operation(np.log, lambda f, a: (1 / a,), 15, "logarithm", is_singular=True),
    "log1p": Operation(np.log1p, lambda f, a: (1 / (1 + a),), 15, is_singular=True),
    "log2": Operation(np.log2, lambda f, a: (1 / (_ln2 * a),), 15, is_singular=True),
    "log10": Operation(np.log10, lambda f, a: (1 / (_ln10 * a),), 15, is_singular=True),
    "hypot": Operation(np.hypot, lambda f, a, b: (_quotient(a, f), _quotient(b, f)), 15, "length", True),
    "atan2": Operation(np.arctan2, lambda f, a, b: (_quotient(b, a * a + b * b), _quotient(-a, a * a + b * b)), 25,
                       is_singular=True),
    "fmod": Operation(np.fmod, lambda f, a, b: (1, -ex.round((a - f) / b)), 10),
    "floor_mod": Operation(np.mod, lambda f, a, b: (1, -(a // b)), 15),
    "floor_divide": Operation(np.floor_divide, lambda f, a, b: (None, None), 20),
    "quotient": Operation(np.floor_divide),
    "remainder": Operation(np.mod),
    "copysign": Operation(np.copysign, lambda f, a, b: (fn.copysign(1.0, a) * fn.copysign(1.0, b), None)),
    "select": Operation(np.where, lambda f, chosen, a, b: (None, chosen, ~chosen), result="chosen"),
    "min": Operation(np.fmin, lambda f, a, b: (a < b, ~(a < b)), result="least"),
    "max": Operation(np.fmax, lambda f, a, b: (a > b, ~(a > b)), result="largest"),
    "pow": Operation(np.power, lambda f, a, b: _of_power(f, a, b, fn.pow), 40, "power", True),
    "powr": Operation(np.power, lambda f, a, b: _of_power(f, a, b, fn.powr), 40, "power", True),
    "dot": Operation(None, _of_product),
    "find_interval": Operation(None, lambda f, *_: (None,), 20),
    "less": Operation(operator.lt), "less_equal": Operation(operator.le), "greater": Operation(operator.gt),
    "greater_equal": Operation(operator.ge), "equal": Operation(operator.eq), "not_equal": Operation(operator.ne),
    "and": Operation(np.logical_and), "or": Operation(np.logical_or), "not": Operation(np.logical_not),
    "is_finite": Operation(np.isfinite),
}
_other = Operation(None)  # of what has no row, as the lookup in a table


def known_of(op: str) -> Operation:
    """What is known of an operation."""
    return operations.get(op, _other)


def cost(roots: Iterable[Node]) -> int:
    """About how many instructions compute some expressions."""
    return sum(2 * len(n.args) if n.op == "dot" else known_of(n.op).instructions for n in walk(roots) if n.args)
