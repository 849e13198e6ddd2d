# SPDX-License-Identifier: MIT
"""NumPy's functions of expressions, and of arrays of them, as this package's."""

from __future__ import annotations

import functools
import inspect
import math
import operator
from collections.abc import Callable, Iterable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ..base.errors import Error, at, users_line
from . import expression as ex, functions as fn
from .operations import known_of
from .vectors import elementwise, of_array_functions, of_ufuncs

if TYPE_CHECKING:
    from .expression import Condition, Expression, Operand

_pi = math.pi


def _sign(x: Expression) -> Expression:
    return fn.where(x > 0, 1.0, fn.where(x < 0, -1.0, x))


def _rounded(x: Operand, decimals: int = 0, out: None = None) -> Expression:
    if decimals != 0:
        raise Error(f"an expression is rounded to {decimals} decimals{at(users_line())}: there is rounding to whole "
                    "numbers alone, as in my.round(10 * x) / 10")
    return ex.round(x)


def _select(conditions: Sequence[Any], choices: Sequence[Any], default: Any = 0) -> Any:
    if len(conditions) != len(choices) or not len(conditions):
        raise Error(f"numpy.select has {len(conditions)} conditions and {len(choices)} choices{at(users_line())}: give "
                    "one choice for each condition")
    chosen = default
    for condition, choice in reversed(list(zip(conditions, choices))):
        chosen = elementwise(fn.where, condition, choice, chosen)
    return chosen


def _piecewise(x: Any, conditions: Any, functions: Iterable[Any], *arguments: Any, **options: Any) -> Any:
    conditions = list(conditions) if isinstance(conditions, (list, tuple)) or np.ndim(conditions) else [
        conditions]
    values = [f(x, *arguments, **options) if callable(f) else f for f in functions]
    if len(values) not in (len(conditions), len(conditions) + 1):
        raise Error(f"numpy.piecewise has {len(conditions)} conditions and {len(values)} functions{at(users_line())}: "
                    "give one function for each condition, and maybe one for the rest")
    # the last condition that holds decides, as in NumPy
    chosen = values.pop() if len(values) > len(conditions) else 0.0
    for condition, value in zip(conditions, values):
        chosen = elementwise(fn.where, condition, value, chosen)
    return chosen


def _polyval(coefficients: Iterable[Any], x: Any) -> Any:
    chosen = 0.0
    for number, coefficient in enumerate(coefficients):  # Horner's rule
        chosen = coefficient if number == 0 else chosen * x + coefficient
    return chosen


def _is_nan(x: object) -> Condition:
    return ex.as_number(x) != x


def _is_infinite(x: Operand) -> Condition:
    return ~(fn.is_finite(x) | _is_nan(x))


def _of_nodes(operation: Callable[[Any, Any], Any]) -> Callable[[object, object], Any]:
    """An operation whose first operand may be a number of NumPy's, which would call NumPy's function again."""
    return lambda a, b: operation(ex.as_node(a), b)


def _table() -> dict[Any, Callable[..., Any]]:
    table = {known_of(name).value: function for name, function in fn.by_name.items()
             if isinstance(known_of(name).value, np.ufunc)}
    table.update({
        np.ceil: ex.ceil, np.trunc: ex.trunc, np.reciprocal: fn.reciprocal,
        np.absolute: ex.abs, np.fabs: ex.abs, np.minimum: fn.minimum, np.maximum: fn.maximum, np.fmin: fn.minimum,
        np.fmax: fn.maximum, np.power: fn.pow, np.float_power: lambda x, y: fn.pow(ex.to_real(ex.as_number(x)), y),
        np.square: lambda x: x * x, np.rint: ex.round, np.sign: _sign, np.isfinite: fn.is_finite, np.isnan: _is_nan,
        np.isinf: _is_infinite,
        np.heaviside: lambda x, h: fn.where(x > 0, 1.0, fn.where(x < 0, 0.0, h)),
        np.deg2rad: lambda x: x * (_pi / 180), np.radians: lambda x: x * (_pi / 180),
        np.rad2deg: lambda x: x * (180 / _pi), np.degrees: lambda x: x * (180 / _pi),
        np.arcsinh: _inverse_sinh, np.arccosh: lambda x: fn.log(x + fn.sqrt(x - 1) * fn.sqrt(x + 1)),
        np.arctanh: lambda x: 0.5 * fn.log1p(2 * x / (1 - x)),
        np.logaddexp: lambda a, b: fn.maximum(a, b) + fn.log1p(fn.exp(-abs(a - b))),
        np.add: ex.add, np.subtract: ex.subtract, np.multiply: ex.multiply, np.true_divide: ex.divide,
        np.floor_divide: ex.floor_divide, np.remainder: ex.remainder, np.negative: operator.neg,
        np.positive: operator.pos, np.less: _of_nodes(operator.lt), np.less_equal: _of_nodes(operator.le),
        np.greater: _of_nodes(operator.gt), np.greater_equal: _of_nodes(operator.ge), np.equal: _of_nodes(operator.eq),
        np.not_equal: _of_nodes(operator.ne), np.logical_and: _of_nodes(operator.and_),
        np.logical_or: _of_nodes(operator.or_), np.logical_not: operator.invert,
        np.logical_xor: _of_nodes(operator.xor), np.bitwise_and: _of_nodes(operator.and_),
        np.bitwise_or: _of_nodes(operator.or_), np.bitwise_xor: _of_nodes(operator.xor), np.invert: operator.invert,
    })
    return table


def _inverse_sinh(x: Expression) -> Expression:
    size = abs(x)
    small = fn.log1p(size + size * size / (1 + fn.sqrt(1 + size * size)))
    return fn.copysign(fn.where(size > 1e150, fn.log(size) + 0.6931471805599453, small), x)  # where squares overflow


def _clip(x: Any, low: Any = None, high: Any = None, out: None = None, **by_name: Any) -> Any:
    low = next((by_name[n] for n in ("a_min", "min") if n in by_name), low)
    high = next((by_name[n] for n in ("a_max", "max") if n in by_name), high)
    x = x if low is None else elementwise(fn.maximum, x, low)
    return x if high is None else elementwise(fn.minimum, x, high)


def _where(condition: Any, a: Any, b: Any) -> Any:
    return elementwise(fn.where, condition, a, b)


# Functions that NumPy hands over as they are called, with whole arrays.
_array_functions: dict[Callable[..., Any], Callable[..., Any]] = {
    np.where: _where, np.clip: _clip, np.select: _select, np.piecewise: _piecewise, np.polyval: _polyval,
    np.round: lambda x, decimals=0, out=None: elementwise(lambda a: _rounded(a, decimals), x),
    np.fix: lambda x, out=None: elementwise(ex.trunc, x),
    np.sinc: lambda x: elementwise(lambda a: fn.where(ex.as_number(a) == 0, 1.0, fn.sinpi(a) / (_pi * a)), x),
}
_array_functions[np.around] = _array_functions[np.round]
_of_numbers = _table()


def of_numbers(ufunc: np.ufunc) -> Callable[..., Any] | None:
    """What stands for one of NumPy's functions of single numbers, or None."""
    return _of_numbers.get(ufunc)


def _checked(function: Callable[..., Any], ours: Callable[..., Any], *arguments: Any, **options: Any) -> Any:
    try:
        inspect.signature(ours).bind(*arguments, **options)
    except TypeError as why:
        raise Error(f"numpy.{function.__name__} of expressions has other arguments than were given{at(users_line())}: "
                    f"{why}") from None
    return ours(*arguments, **options)


def _add_numpys_methods() -> None:
    """NumPy's functions of an array of objects call a method of each: np.sin(array) calls array[0].sin()."""
    for function, ours in _of_numbers.items():
        if function.nin == 1 and function.__name__ not in ("absolute", "negative", "positive", "invert"):
            setattr(ex.Expression, function.__name__, lambda self, ours=ours: ours(self))
    for name, ours in (("arctan2", fn.atan2), ("hypot", fn.hypot), ("copysign", fn.copysign), ("fmod", fn.fmod)):
        setattr(ex.Expression, name, lambda self, other, ours=ours: ours(self, other))


_add_numpys_methods()
of_ufuncs.update(_of_numbers)
of_array_functions.update({function: functools.partial(_checked, function, ours)
                           for function, ours in _array_functions.items()})
