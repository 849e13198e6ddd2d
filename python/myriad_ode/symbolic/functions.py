# SPDX-License-Identifier: MIT
"""Functions of expressions, as models use them. A function has its row in operations.py."""

from __future__ import annotations

import math
import uuid
from collections.abc import Callable
from typing import Any

from ..base.errors import Error, at, users_line
from . import expression
from .expression import (Condition, Expression, Operand, as_condition, as_node, as_number, constant, is_number, make,
                         power, to_real)
from .node import Node, condition as of_conditions, integer

__all__ = ["sqrt", "cbrt", "sin", "cos", "tan", "asin", "acos", "atan", "atan2", "sinpi", "cospi", "sinh", "cosh",
           "tanh", "exp", "exp2", "expm1", "log", "log2", "log10", "log1p", "pow", "powr", "reciprocal", "rsqrt",
           "hypot", "copysign", "fmod", "fma", "sincos", "sincospi", "minimum", "maximum", "where", "is_finite",
           "uniform", "normal", "pi"]

pi = math.pi  #: the number


def _function(name: str, description: str) -> Callable[[Operand], Expression]:
    def function(x: Operand) -> Expression:
        return make(name, (to_real(as_number(x)),))

    function.__name__ = function.__qualname__ = name
    function.__doc__ = description
    return function


sqrt = _function("sqrt", "Square root; NaN of negative numbers.")
cbrt = _function("cbrt", "Cube root.")
sin = _function("sin", "Sine of an angle in radians.")
cos = _function("cos", "Cosine of an angle in radians.")
tan = _function("tan", "Tangent of an angle in radians.")
asin = _function("asin", "Inverse of the sine; NaN outside [-1, 1].")
acos = _function("acos", "Inverse of the cosine; NaN outside [-1, 1].")
atan = _function("atan", "Inverse of the tangent.")
sinpi = _function("sinpi", "sin(pi x), exact at multiples of a half.")
cospi = _function("cospi", "cos(pi x), exact at multiples of a half.")
sinh = _function("sinh", "Hyperbolic sine.")
cosh = _function("cosh", "Hyperbolic cosine.")
tanh = _function("tanh", "Hyperbolic tangent.")
exp = _function("exp", "Exponential function.")
exp2 = _function("exp2", "2 to the power of x.")
expm1 = _function("expm1", "exp(x) - 1, accurate for small x.")
log1p = _function("log1p", "log(1 + x), accurate for small x.")
log = _function("log", "Natural logarithm; NaN of negative numbers, minus infinity of zero.")
log2 = _function("log2", "Logarithm to base 2.")
log10 = _function("log10", "Logarithm to base 10.")
reciprocal = _function("reciprocal", "1 / x without a division, for normal x with a normal result.")
rsqrt = _function("rsqrt", "1 / sqrt(x) without a division, for positive normal x.")


def _function_of_two(name: str, description: str) -> Callable[[Operand, Operand], Expression]:
    def function(a: Operand, b: Operand) -> Expression:
        return make(name, (to_real(as_number(a)), to_real(as_number(b))))

    function.__name__ = function.__qualname__ = name
    function.__doc__ = description
    return function


atan2 = _function_of_two("atan2", "The angle of the point (second, first).")
hypot = _function_of_two("hypot", "sqrt(a^2 + b^2).")
copysign = _function_of_two("copysign", "The magnitude of the first with the sign of the second.")
fmod = _function_of_two("fmod", "The exact remainder of a division with its quotient cut, with the sign of the first; "
                                "% has that of the second.")
powr = _function_of_two("powr", "x to the power y for x >= 0, in half the time of pow: NaN for negative x.")


def pow(x: Operand, y: Operand) -> Expression:
    """x to the power y, the same as `x**y`: whole constants y by multiplication."""
    return power(x, y)


def fma(a: Operand, b: Operand, c: Operand) -> Expression:
    """a * b + c, with one rounding if the processor has the instruction."""
    return make("fma", tuple(to_real(as_number(x)) for x in (a, b, c)))


def sincos(x: Operand) -> tuple[Expression, Expression]:
    """Sine and cosine of one angle for about the price of one: up to 2^30 (float 2^16) radians, NaN beyond."""
    x = to_real(as_number(x))
    return make("sincos.sine", (x,)), make("sincos.cosine", (x,))


def sincospi(x: Operand) -> tuple[Expression, Expression]:
    """sin(pi x) and cos(pi x) for about the price of one: x up to 2^50 (float 2^21), NaN beyond."""
    x = to_real(as_number(x))
    return make("sincospi.sine", (x,)), make("sincospi.cosine", (x,))


def _extreme(op: str, pick: Callable[[Any, Any], Any], arguments: tuple[Any, ...]) -> Expression:
    if len(arguments) == 1 and not isinstance(arguments[0], Node):
        arguments = tuple(arguments[0])
    if not arguments:
        raise Error(f"{pick.__name__}imum of nothing{at(users_line())}: give it two numbers or more")
    result = as_number(arguments[0])
    for other in map(as_number, arguments[1:]):
        if is_number(result) and is_number(other):
            result = constant(pick(result.value, other.value))
        elif result.type == other.type == integer:
            result = make(op, (result, other), type=integer)
        else:
            result = make(op, (to_real(result), to_real(other)))
    return result


def minimum(*numbers: Any) -> Expression:
    """The smallest of two numbers or more; a NaN is left out."""
    return _extreme("min", min, numbers)


def maximum(*numbers: Any) -> Expression:
    """The largest of two numbers or more; a NaN is left out."""
    return _extreme("max", max, numbers)


def where(condition: Condition | bool, a: Any, b: Any) -> Any:
    """a where the condition holds, else b, by instance: what `if` is elsewhere. Both are evaluated."""
    chosen = as_condition(condition)
    a, b = as_node(a), as_node(b)
    if (a.type == of_conditions) != (b.type == of_conditions):
        raise Error(f"where has a condition and a number to choose from{at(users_line())}: both must be of one kind")
    if chosen.op == "truth":
        return a if chosen.value else b
    if a is b:
        return a
    if a.type == of_conditions:
        return (chosen & a) | (~chosen & b)
    if a.type == b.type == integer:
        return make("select", (chosen, a, b), type=integer)
    return make("select", (chosen, to_real(a), to_real(b)))


draws = ("uniform", "normal")


def _draw(kind: str, a: Operand, b: Operand) -> Expression:
    """A draw, with a number of its own: two equal calls are two draws."""
    return make(kind, (to_real(as_number(a)), to_real(as_number(b))), value=uuid.uuid4().int)


def uniform(low: Operand = 0.0, high: Operand = 1.0) -> Expression:
    """A random number, evenly distributed between two bounds: in `generate` of a model, where each call is a draw of
    its own, or as the values of a study's sweep, of which each instance draws one."""
    return _draw("uniform", low, high)


def normal(mean: Operand = 0.0, deviation: Operand = 1.0) -> Expression:
    """A random number, normally distributed with that standard deviation, for the same as `uniform`."""
    return _draw("normal", mean, deviation)


def is_finite(x: Operand) -> Condition:
    """A condition: neither infinite nor NaN."""
    return make("is_finite", (to_real(as_number(x)),), type=of_conditions)


#: all functions by name, those of expression.py among them
by_name: dict[str, Callable[..., Any]] = {
    **{name: getattr(expression, name) for name in expression.__all__},
    **{name: globals()[name] for name in __all__ if name != "pi"}}
