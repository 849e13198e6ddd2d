# SPDX-License-Identifier: MIT
"""Expressions of a model: a graph of operations on its symbols, in double precision, in which equal subexpressions are
one object. Operators record what they are applied to and compute nothing, except with constants alone; so do the
functions of functions.py."""

from __future__ import annotations

import builtins
import decimal
import numbers
import operator
import threading
import weakref
from collections.abc import Callable
from typing import Any, NoReturn, TypeVar, Union

import numpy as np

from ..base.errors import Error, at, refuse_masked, users_line
from .node import Node, condition as condition, integer as integer, real as real, text
from .vectors import NumpyFunctions

__all__ = ["abs", "floor", "ceil", "trunc", "round"]  # of what users see; other functions are in functions.py

Result = TypeVar("Result")
_known: weakref.WeakValueDictionary[Any, Any] = weakref.WeakValueDictionary()
_lock = threading.RLock()


def make(op: str, args: tuple[Any, ...] = (), value: Any = None, type: str = real) -> Any:
    """The node of an operation; the same object whenever it is made of the same arguments."""
    key = (op, tuple(id(a) for a in args), value if op != "constant" else (value.__class__, repr(value)))
    with _lock:
        node = _known.get(key)
        if node is None:
            node = object.__new__(Condition if type == condition else Expression)
            node.op, node.args, node.value, node.type, node.line = op, args, value, type, users_line()
            _known[key] = node
        return node


def constant(number: object) -> Any:
    """The node of a number."""
    if isinstance(number, (bool, np.bool_)):
        return make("truth", value=bool(number), type=condition)
    if isinstance(number, numbers.Integral):
        number = int(number)
        if number.bit_length() > 1024:
            raise Error(f"a whole number of {number.bit_length()} bits is too large for double precision"
                        f"{at(users_line())}")
        return make("constant", value=number, type=integer)
    if isinstance(number, (numbers.Real, decimal.Decimal)):
        number = float(number)
        if number != number:
            raise Error(f"a constant is NaN{at(users_line())}: check how it was computed")
        return make("constant", value=number)
    if isinstance(number, numbers.Complex):
        raise Error(f"{number!r} is complex{at(users_line())}: a model is real, so write real and imaginary parts as "
                    "two states")
    raise TypeError


def is_sympy(value: object) -> bool:
    """Whether it is an object of SymPy, which is not imported for this."""
    return any((base.__module__ or "").partition(".")[0] == "sympy" for base in type(value).__mro__)


def as_node(value: object) -> Expression | Condition:
    """A node from an expression, a number, an array without axes, or a SymPy expression without free symbols."""
    if isinstance(value, (Expression, Condition)):
        return value
    refuse_masked(value, "a constant")
    if isinstance(value, np.ndarray) and value.ndim == 0:
        return as_node(value[()])
    try:
        return constant(value)
    except TypeError:
        pass
    if isinstance(value, np.ndarray):
        raise Error(f"an array of shape {value.shape} stands where one number is needed{at(users_line())}: take an "
                    "element of it, or give one equation per element")
    if is_sympy(value):
        raise Error(f"the SymPy expression `{value}` is mixed with Myriad's symbols{at(users_line())}: write the whole "
                    "equation in SymPy's symbols, or all of it in Myriad's")
    raise Error(f"{value!r} of type {type(value).__name__} is not an expression{at(users_line())}: use numbers and "
                "symbols from my.states, my.parameter and so on")


def as_number(value: object) -> Expression:
    """A real or integer node."""
    node = as_node(value)
    if isinstance(node, Condition):
        raise Error(f"`{text(node)}` is a condition and not a number{at(users_line())}: use "
                    "my.where(condition, 1.0, 0.0)")
    return node


def as_condition(value: object) -> Condition:
    """A node that is true or false."""
    node = as_node(value)
    if not isinstance(node, Condition):
        raise Error(f"`{text(node)}` is a number and not a condition{at(users_line())}: compare it with something")
    return node


def is_number(node: Node) -> bool:
    """Whether an expression is a number of its own."""
    return node.op == "constant"


def _is_whole(node: Node) -> bool:
    return is_number(node) and node.type == integer


def to_real(node: Expression) -> Expression:
    """Whole constants beside real numbers are real, so that x - 1 and x - 1.0 are the same."""
    if node.type != integer:
        return node
    if is_number(node):
        return _float(node.value)
    if node.op == "select":
        branches = tuple(to_real(a) for a in node.args[1:])
        if all(a.type == real for a in branches):
            return make("select", (node.args[0], *branches))
    return node


def _float(value: int) -> Expression:
    try:
        return constant(float(value))
    except OverflowError:
        raise Error(f"a whole number of {len(str(value))} digits is too large for double precision"
                    f"{at(users_line())}") from None


def _arithmetic(op: str, fold: Callable[[Any, Any], Any], a: object, b: object,
                always_real: bool = False) -> Expression:
    a, b = as_number(a), as_number(b)
    is_integer = a.type == b.type == integer and not always_real
    if is_number(a) and is_number(b):
        try:
            return constant(fold(a.value, b.value))
        except ZeroDivisionError:
            raise Error(f"{a.value} is divided by zero{at(users_line())}") from None
        except OverflowError:
            raise Error(f"`{text(a)}` and `{text(b)}` have a result too large for double precision"
                        f"{at(users_line())}") from None
    for one, other, neutral in ((a, b, op in ("add", "subtract")), (b, a, op == "add")):
        if other.value == 0 and neutral and _is_whole(other) or other.value == 1 and _is_whole(other) and (
                op == "multiply" or op == "divide" and other is b and one.type == real):
            return one  # as in the sums and products that Python's sum() and loops begin with
    if is_integer:
        return make(op, (a, b), type=integer)
    return make(op, (to_real(a), to_real(b)))


def power(base: object, exponent: object) -> Expression:
    """base ** exponent: whole exponents by multiplication, as myriad::pow does it, 0.5 as a square root."""
    base, exponent = as_number(base), as_number(exponent)
    if is_number(exponent):
        n = exponent.value
        if is_number(base):
            if base.type == exponent.type == integer and (base.value.bit_length() - 1) * n > 1024:
                raise Error(f"{text(base)} ** {text(exponent)} is not a number of double precision{at(users_line())}")
            try:
                return constant(base.value ** n)
            except (ZeroDivisionError, OverflowError):
                raise Error(f"{base.value} ** {n} is not a finite number{at(users_line())}") from None
        if n == 0.5:
            return make("sqrt", (to_real(base),))
        if exponent.type == integer or float(n).is_integer():
            return _wholepower(base, int(n))
    return make("pow", (to_real(base), to_real(exponent)))


def _wholepower(base: Expression, n: int) -> Expression:
    if n < 0:
        return 1.0 / _wholepower(base, -n)
    if n > 1 << 20:
        return make("pow", (to_real(base), _float(n)))
    result, factor = None, base
    while n:
        if n % 2:
            result = factor if result is None else factor * result
        n //= 2
        if n:
            factor = factor * factor
    return constant(1 if base.type == integer else 1.0) if result is None else result


def _compare(op: str, fold: Callable[[Any, Any], bool], a: object, b: object) -> Condition:
    a, b = as_number(a), as_number(b)
    if is_number(a) and is_number(b):
        return constant(fold(a.value, b.value))
    if a.type != b.type:
        a, b = to_real(a), to_real(b)
    return make(op, (a, b), type=condition)


def _is_array(other: object) -> bool:
    return isinstance(other, np.ndarray) and other.ndim > 0


def _binary(build: Callable[[Any, Any], Result]) -> tuple[Callable[[Any, Any], Result], Callable[[Any, Any], Result]]:
    """The operator and the one for operands that do not know it. With an array they give an array, which is another of
    these for a type checker."""
    def forward(self: Any, other: Any) -> Any:
        return NotImplemented if _is_array(other) else build(self, other)

    def backward(self: Any, other: Any) -> Any:
        return NotImplemented if _is_array(other) else build(other, self)

    return forward, backward


def add(a: object, b: object) -> Expression:
    return _arithmetic("add", operator.add, a, b)


def subtract(a: object, b: object) -> Expression:
    return _arithmetic("subtract", operator.sub, a, b)


def multiply(a: object, b: object) -> Expression:
    return _arithmetic("multiply", operator.mul, a, b)


def divide(a: object, b: object) -> Expression:
    return _arithmetic("divide", operator.truediv, a, b, always_real=True)


def _division(op: str, of_whole: str, fold: Callable[[Any, Any], Any], a: object, b: object) -> Expression:
    """// or %, as Python has them."""
    a, b = as_number(a), as_number(b)
    is_integer = a.type == b.type == integer
    if is_number(b) and b.value == 0:
        raise Error(f"`{text(a)}` is divided by zero{at(users_line())}")
    if is_number(a) and is_number(b):
        return constant(fold(a.value, b.value))
    if is_integer:
        return make(of_whole, (a, b), type=integer)
    return make(op, (to_real(a), to_real(b)))


def floor_divide(a: object, b: object) -> Expression:
    return _division("floor_divide", "quotient", operator.floordiv, a, b)


def remainder(a: object, b: object) -> Expression:
    return _division("floor_mod", "remainder", operator.mod, a, b)


def _remade(node: Node) -> tuple[Any, ...]:
    return make, (node.op, node.args, node.value, node.type)


class Expression(Node, NumpyFunctions):
    """A number, real or integer, that depends on the symbols of a model."""

    __slots__ = ()
    __hash__ = Node.__hash__
    __reduce__ = _remade
    __add__, __radd__ = _binary(add)
    __sub__, __rsub__ = _binary(subtract)
    __mul__, __rmul__ = _binary(multiply)
    __truediv__, __rtruediv__ = _binary(divide)
    __floordiv__, __rfloordiv__ = _binary(floor_divide)
    __mod__, __rmod__ = _binary(remainder)
    __pow__, __rpow__ = _binary(power)
    __lt__, _ = _binary(lambda a, b: _compare("less", operator.lt, a, b))
    __le__, _ = _binary(lambda a, b: _compare("less_equal", operator.le, a, b))
    __gt__, _ = _binary(lambda a, b: _compare("greater", operator.gt, a, b))
    __ge__, _ = _binary(lambda a, b: _compare("greater_equal", operator.ge, a, b))
    __eq__, _ = _binary(lambda a, b: _compare("equal", operator.eq, a, b))  # type: ignore[assignment]
    __ne__, _ = _binary(lambda a, b: _compare("not_equal", operator.ne, a, b))  # type: ignore[assignment]
    del _
    __divmod__, __rdivmod__ = _binary(lambda a, b: (floor_divide(a, b), remainder(a, b)))

    def __neg__(self) -> Expression:
        return subtract(0, self) if self.type == integer else make("negate", (self,))

    def __pos__(self) -> Expression:
        return self

    def __abs__(self) -> Expression:
        return abs(self)

    def __round__(self, digits: int | None = None) -> Expression:
        if digits:
            raise Error(f"`{text(self)}` is rounded to {digits} digits{at(users_line())}: there is rounding to whole "
                        "numbers alone, as in round(10 * x) / 10")
        return round(self)

    def __floor__(self) -> Expression:
        return floor(self)

    def __ceil__(self) -> Expression:
        return ceil(self)

    def __trunc__(self) -> Expression:
        return trunc(self)

    def _refuse_number(self, *_: object) -> NoReturn:
        raise Error(f"`{text(self)}` is not a number yet, while the model is recorded{at(users_line())}: use the "
                    "functions of myriad (my.sin, not math.sin), and keep it in arrays of objects, as "
                    "np.zeros_like(y) or np.zeros(2, dtype=object) makes them")

    __float__ = __int__ = __index__ = __complex__ = _refuse_number


def _both(a: object, b: object) -> Condition:
    return _logical("and", a, b)


def _either(a: object, b: object) -> Condition:
    return _logical("or", a, b)


def _equal(a: object, b: object) -> Condition:
    a, b = as_condition(a), as_condition(b)
    return make("truth", value=True, type=condition) if a is b else (a & b) | (~a & ~b)


def _differ(a: object, b: object) -> Condition:
    return ~_equal(a, b)


class Condition(Node, NumpyFunctions):
    """True or false, by instance: what a comparison gives. Joined by & and |, inverted by ~; two are equal where both
    hold or neither does."""

    __slots__ = ()
    __hash__ = Node.__hash__
    __reduce__ = _remade
    __and__, __rand__ = _binary(_both)
    __or__, __ror__ = _binary(_either)
    __xor__, __rxor__ = _binary(_differ)
    __eq__, _ = _binary(_equal)  # type: ignore[assignment]
    __ne__, _ = _binary(_differ)  # type: ignore[assignment]
    del _

    def __invert__(self) -> Condition:
        return make("truth", value=not self.value, type=condition) if self.op == "truth" else make(
            "not", (self,), type=condition)


def _logical(op: str, a: object, b: object) -> Condition:
    a, b = as_condition(a), as_condition(b)
    for one, other in ((a, b), (b, a)):
        if one.op == "truth":
            return other if one.value == (op == "and") else one
    return make(op, (a, b), type=condition)


Operand = Union[Expression, float]  #: what stands in an equation

# What Python's own functions and those of `math` need

continuous = "continuous"  #: the `value` of a floor that jumps while the expression around it does not


def floor(x: Operand) -> Expression:
    """The largest whole number that is not above x."""
    x = as_number(x)
    return x if x.type == integer else make("floor", (x,))


def ceil(x: Operand) -> Expression:
    """The smallest whole number that is not below x."""
    x = as_number(x)
    return x if x.type == integer else -make("floor", (-x,))


def trunc(x: Operand) -> Expression:
    """x without its fraction."""
    x = as_number(x)
    return x if x.type == integer else make("copysign", (make("floor", (abs(x),)), x))


def round(x: Operand) -> Expression:
    """The nearest whole number, halves to the even one, as Python and NumPy round."""
    x = as_number(x)
    return x if x.type == integer else make("rint", (x,))


def abs(x: Operand) -> Expression:
    """Absolute value."""
    number = as_number(x)
    if is_number(number):
        return constant(builtins.abs(number.value))
    return make("max", (number, -number), type=integer) if number.type == integer else make("abs", (number,))
