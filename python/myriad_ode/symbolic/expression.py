# SPDX-License-Identifier: MIT
"""Expressions of a model: a graph of operations on its symbols, in double precision, in which equal subexpressions are
one object. Operators and functions record what they are applied to and compute nothing, except with constants alone.
"""

from __future__ import annotations

import builtins
import decimal
import math
import numbers
import operator
import threading
import uuid
import weakref
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, NoReturn, Union

import numpy as np

from ..base.errors import Error, at, refuse_masked, users_line

__all__ = ["sqrt", "cbrt", "abs", "floor", "ceil", "trunc", "round", "sin", "cos", "tan", "asin", "acos", "atan",
           "atan2", "sinpi", "cospi", "sinh", "cosh", "tanh", "exp", "exp2", "expm1", "log", "log2", "log10", "log1p",
           "pow", "powr", "reciprocal", "rsqrt", "hypot", "copysign", "fmod", "fma", "sincos", "sincospi", "minimum",
           "maximum", "where", "is_finite", "uniform", "normal", "pi"]

pi = math.pi  #: the number

real, integer, condition = "real", "integer", "condition"  # the types of nodes
_known: weakref.WeakValueDictionary[Any, Any] = weakref.WeakValueDictionary()
_lock = threading.RLock()

# What stands for NumPy's functions of single numbers, and for its others; numpy_functions.py fills both.
of_ufuncs: dict[Any, Callable[..., Any]] = {}
of_array_functions: dict[Any, Callable[..., Any]] = {}


class Node:
    """An operation with its arguments. Nodes are made by `make`, so that equal ones are the same object."""

    __slots__ = ("op", "args", "value", "type", "line", "__weakref__")
    op: str
    args: tuple[Any, ...]
    value: Any
    type: str
    line: tuple[str, int] | None

    def __hash__(self) -> int:
        return id(self) >> 4

    def __reduce__(self) -> tuple[Any, ...]:
        return make, (self.op, self.args, self.value, self.type)

    def __repr__(self) -> str:
        return text(self)

    def __bool__(self) -> NoReturn:
        raise Error(f"`{text(self)}` has no truth value while the model is recorded, as it differs between instances: "
                    "instead of `if`, `and`, `or`, `not` and chained comparisons use my.where(condition, a, b) "
                    "and (a < b) & (b < c), |, ~")

    def __iter__(self) -> NoReturn:
        raise Error(f"`{text(self)}` is one number and cannot be iterated over")


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


def _is_constant(node: Node) -> bool:
    return node.op == "constant"


def _is_whole(node: Node) -> bool:
    return _is_constant(node) and node.type == integer


def to_real(node: Expression) -> Expression:
    """Whole constants beside real numbers are real, so that x - 1 and x - 1.0 are the same."""
    if node.type != integer:
        return node
    if _is_constant(node):
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
    if _is_constant(a) and _is_constant(b):
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


def _power(base: object, exponent: object) -> Expression:
    """base ** exponent: whole exponents by multiplication, as myriad::pow does it, 0.5 as a square root."""
    base, exponent = as_number(base), as_number(exponent)
    if _is_constant(exponent):
        n = exponent.value
        if _is_constant(base):
            if base.type == exponent.type == integer and (base.value.bit_length() - 1) * n > 1024:
                raise Error(f"{text(base)} ** {text(exponent)} is not a number of double precision{at(users_line())}")
            try:
                return constant(base.value ** n)
            except (ZeroDivisionError, OverflowError):
                raise Error(f"{base.value} ** {n} is not a finite number{at(users_line())}") from None
        if n == 0.5:
            return sqrt(base)
        if exponent.type == integer or float(n).is_integer():
            return _whole_power(base, int(n))
    return make("pow", (to_real(base), to_real(exponent)))


def _whole_power(base: Expression, n: int) -> Expression:
    if n < 0:
        return 1.0 / _whole_power(base, -n)
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
    if _is_constant(a) and _is_constant(b):
        return constant(fold(a.value, b.value))
    if a.type != b.type:
        a, b = to_real(a), to_real(b)
    return make(op, (a, b), type=condition)


def _is_array(other: object) -> bool:
    return isinstance(other, np.ndarray) and other.ndim > 0


def _binary(build: Callable[[Any, Any], Any]) -> tuple[Any, Any]:
    def forward(self: Node, other: object) -> Any:
        return NotImplemented if _is_array(other) else build(self, other)

    def backward(self: Node, other: object) -> Any:
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
    if _is_constant(b) and b.value == 0:
        raise Error(f"`{text(a)}` is divided by zero{at(users_line())}")
    if _is_constant(a) and _is_constant(b):
        return constant(fold(a.value, b.value))
    if is_integer:
        return make(of_whole, (a, b), type=integer)
    return make(op, (to_real(a), to_real(b)))


def floor_divide(a: object, b: object) -> Expression:
    return _division("floor_divide", "quotient", operator.floordiv, a, b)


def remainder(a: object, b: object) -> Expression:
    return _division("floor_mod", "remainder", operator.mod, a, b)


def is_long(node: Node) -> bool:
    """Whether a whole number has 64 bits, as the number of the instance has; others have 32."""
    return any(n.value == ("built-in", "instance") for n in walk([node]) if n.op == "symbol")


class _NumpyFunctions:
    """NumPy's functions of expressions, and arrays of them, are this module's."""

    __slots__ = ()

    def __array_ufunc__(self, ufunc: np.ufunc, method: str, *inputs: Any, **options: Any) -> Any:
        function = of_ufuncs.get(ufunc)
        if function is None or method != "__call__" or options:
            raise Error(f"numpy.{ufunc.__name__} cannot be applied to expressions of a model{at(users_line())}: use "
                        "the functions of myriad")
        return elementwise(function, *inputs)

    def __array_function__(self, function: Callable[..., Any], types: Iterable[type], args: Iterable[Any],
                           options: Mapping[str, Any]) -> Any:
        if (ours := of_array_functions.get(function)) is not None:
            return ours(*args, **options)
        raise Error(f"numpy.{function.__name__} cannot be applied to expressions of a model{at(users_line())}: use the "
                    "functions of myriad")


class Vector(np.ndarray):
    """An array of expressions: NumPy's functions of it are this module's, element by element."""

    def __array_ufunc__(self, ufunc: np.ufunc, method: str, *inputs: Any, out: Any = None, **options: Any) -> Any:
        function = of_ufuncs.get(ufunc)
        if function is not None and method == "__call__" and not options:
            result = elementwise(function, *inputs)
        elif function is not None and method == "reduce" and ufunc in (np.maximum, np.minimum):
            result = np.frompyfunc(function, 2, 1).reduce(inputs[0].view(np.ndarray), **options)
            result = result.view(Vector) if isinstance(result, np.ndarray) else result
        else:  # sums and products, of which NumPy's work on objects
            plain = [x.view(np.ndarray) if isinstance(x, Vector) else x for x in inputs]
            result = getattr(ufunc, method)(*plain, **options)
            result = result.view(Vector) if isinstance(result, np.ndarray) and result.dtype == object else result
        if out is None:
            return result
        out[0][...] = result
        return out[0]

    def __array_function__(self, function: Callable[..., Any], types: Iterable[type], args: Iterable[Any],
                           options: Mapping[str, Any]) -> Any:
        if (ours := of_array_functions.get(function)) is not None:
            return ours(*args, **options)
        return super().__array_function__(function, types, args, options)


def vector(expressions: Sequence[Node]) -> Vector:
    """A `Vector` of some expressions."""
    made = np.empty(len(expressions), object)
    made[:] = expressions
    return made.view(Vector)


def elementwise(function: Callable[..., Any], *inputs: Any) -> Any:
    """A function of arrays from one of their elements."""
    arrays = []
    for x in inputs:
        if isinstance(x, (list, tuple)):
            x = np.array(x, object)
        if not isinstance(x, np.ndarray):  # np.array(x) might look into it
            array = np.empty((), object)
            array[()] = x
            x = array
        arrays.append(x.view(np.ndarray))
    result = np.frompyfunc(function, len(arrays), 1)(*arrays)
    return result.view(Vector) if isinstance(result, np.ndarray) else result


class Expression(Node, _NumpyFunctions):
    """A number, real or integer, that depends on the symbols of a model."""

    __slots__ = ()
    __hash__ = Node.__hash__
    if TYPE_CHECKING:  # with an array they give an array, which is another of these for a type checker
        def __add__(self, other: Any) -> Expression: ...
        def __radd__(self, other: Any) -> Expression: ...
        def __sub__(self, other: Any) -> Expression: ...
        def __rsub__(self, other: Any) -> Expression: ...
        def __mul__(self, other: Any) -> Expression: ...
        def __rmul__(self, other: Any) -> Expression: ...
        def __truediv__(self, other: Any) -> Expression: ...
        def __rtruediv__(self, other: Any) -> Expression: ...
        def __floordiv__(self, other: Any) -> Expression: ...
        def __rfloordiv__(self, other: Any) -> Expression: ...
        def __mod__(self, other: Any) -> Expression: ...
        def __rmod__(self, other: Any) -> Expression: ...
        def __pow__(self, other: Any) -> Expression: ...
        def __rpow__(self, other: Any) -> Expression: ...
        def __lt__(self, other: Any) -> Condition: ...
        def __le__(self, other: Any) -> Condition: ...
        def __gt__(self, other: Any) -> Condition: ...
        def __ge__(self, other: Any) -> Condition: ...
        def __eq__(self, other: Any) -> Condition: ...  # type: ignore[override]
        def __ne__(self, other: Any) -> Condition: ...  # type: ignore[override]
    else:
        __add__, __radd__ = _binary(add)
        __sub__, __rsub__ = _binary(subtract)
        __mul__, __rmul__ = _binary(multiply)
        __truediv__, __rtruediv__ = _binary(divide)
        __floordiv__, __rfloordiv__ = _binary(floor_divide)
        __mod__, __rmod__ = _binary(remainder)
        __pow__, __rpow__ = _binary(_power)
        __lt__, _ = _binary(lambda a, b: _compare("less", operator.lt, a, b))
        __le__, _ = _binary(lambda a, b: _compare("less_equal", operator.le, a, b))
        __gt__, _ = _binary(lambda a, b: _compare("greater", operator.gt, a, b))
        __ge__, _ = _binary(lambda a, b: _compare("greater_equal", operator.ge, a, b))
        __eq__, _ = _binary(lambda a, b: _compare("equal", operator.eq, a, b))
        __ne__, _ = _binary(lambda a, b: _compare("not_equal", operator.ne, a, b))
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


class Condition(Node, _NumpyFunctions):
    """True or false, by instance: what a comparison gives. Joined by & and |, inverted by ~; two are equal where both
    hold or neither does."""

    __slots__ = ()
    __hash__ = Node.__hash__
    if TYPE_CHECKING:
        def __and__(self, other: Any) -> Condition: ...
        def __rand__(self, other: Any) -> Condition: ...
        def __or__(self, other: Any) -> Condition: ...
        def __ror__(self, other: Any) -> Condition: ...
        def __xor__(self, other: Any) -> Condition: ...
        def __rxor__(self, other: Any) -> Condition: ...
        def __eq__(self, other: Any) -> Condition: ...  # type: ignore[override]
        def __ne__(self, other: Any) -> Condition: ...  # type: ignore[override]
    else:
        __and__, __rand__ = _binary(_both)
        __or__, __ror__ = _binary(_either)
        __xor__, __rxor__ = _binary(_differ)
        __eq__, _ = _binary(_equal)
        __ne__, _ = _binary(_differ)
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


# ----------------------------------------------------------------------------------------------------------------------
# Functions
# ----------------------------------------------------------------------------------------------------------------------


Operand = Union[Expression, float]  #: what stands in an equation


def _function(name: str, description: str) -> Callable[[Operand], Expression]:
    def function(x: Operand) -> Expression:
        return make(name, (to_real(as_number(x)),))

    function.__name__ = function.__qualname__ = name
    function.__doc__ = description
    return function


sqrt = _function("sqrt", "Square root; NaN of negative numbers.")
cbrt = _function("cbrt", "Cube root.")
_floor, _rint = _function("floor", ""), _function("rint", "")
continuous = "continuous"  #: the `value` of a floor that jumps while the expression around it does not


def _of_real(x: Operand, function: Callable[[Expression], Expression]) -> Expression:
    """A function that leaves whole numbers as they are."""
    x = as_number(x)
    return x if x.type == integer else function(x)


def floor(x: Operand) -> Expression:
    """The largest whole number that is not above x."""
    return _of_real(x, _floor)


def ceil(x: Operand) -> Expression:
    """The smallest whole number that is not below x."""
    return _of_real(x, lambda x: -_floor(-x))


def trunc(x: Operand) -> Expression:
    """x without its fraction."""
    return _of_real(x, lambda x: copysign(_floor(abs(x)), x))


def round(x: Operand) -> Expression:
    """The nearest whole number, halves to the even one, as Python and NumPy round."""
    return _of_real(x, _rint)


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
    return _power(x, y)


def abs(x: Operand) -> Expression:
    """Absolute value."""
    number = as_number(x)
    if _is_constant(number):
        return constant(builtins.abs(number.value))
    return maximum(number, -number) if number.type == integer else make("abs", (number,))


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
        if _is_constant(result) and _is_constant(other):
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
    if (a.type == "condition") != (b.type == "condition"):
        raise Error(f"where has a condition and a number to choose from{at(users_line())}: both must be of one kind")
    if chosen.op == "truth":
        return a if chosen.value else b
    if a is b:
        return a
    if a.type == "condition":
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
    return make("is_finite", (to_real(as_number(x)),), type=condition)


# ----------------------------------------------------------------------------------------------------------------------
# Walking through a graph
# ----------------------------------------------------------------------------------------------------------------------


def walk(roots: Iterable[Node]) -> list[Node]:
    """All nodes that the roots need, each once, arguments before what uses them; in a fixed order."""
    seen, order = set(), []
    for root in roots:
        stack = [] if id(root) in seen else [(root, iter(root.args))]
        seen.add(id(root))
        while stack:
            node, arguments = stack[-1]
            for argument in arguments:
                if id(argument) not in seen:
                    seen.add(id(argument))
                    stack.append((argument, iter(argument.args)))
                    break
            else:
                order.append(node)
                stack.pop()
    return order


def symbols_of(roots: Iterable[Node]) -> list[Node]:
    """The symbols in these expressions, in the order in which they are first needed."""
    return [node for node in walk(roots) if node.op == "symbol"]


infix = {  # symbol, precedence: higher binds tighter
    "or": ("||", 1), "and": ("&&", 2), "equal": ("==", 3), "not_equal": ("!=", 3), "less": ("<", 4),
    "less_equal": ("<=", 4), "greater": (">", 4), "greater_equal": (">=", 4), "add": ("+", 5), "subtract": ("-", 5),
    "multiply": ("*", 6), "divide": ("/", 6), "quotient": ("/", 6), "remainder": ("%", 6),
}
_as_in_python = {**infix, "quotient": ("//", 6), "floor_divide": ("//", 6), "floor_mod": ("%", 6)}
_prefix = {"negate": "-", "not": "!"}
_atom, _unary_precedence = 9, 8


def write(root: Node, leaf: Callable[[Node], str | None], call: Callable[[Node, list[str]], str],
          convert: Callable[[Node, Node], str | None], operator_of: Callable[[Node], tuple[str, int] | None]) -> str:
    """An expression as text with as few parentheses as C++ and Python need. `leaf(node)` is the text of a node without
    arguments or one that has a name, else None; `call(node, arguments)` that of a function; `convert(node, argument)`
    is the type that an argument is converted to first, or None; `operator_of(node)` is the sign and the precedence of
    an operator, or None."""
    texts = {}
    stack = [root]
    while stack:
        node = stack[-1]
        if id(node) in texts:
            stack.pop()
            continue
        known = leaf(node)
        if known is not None:
            texts[id(node)] = (known, _unary_precedence if known.startswith("-") else _atom)
            stack.pop()
            continue
        missing = [a for a in node.args if id(a) not in texts]
        if missing:
            stack.extend(reversed(missing))
            continue
        stack.pop()
        arguments = [texts[id(a)] for a in node.args]
        for i, argument in enumerate(node.args):
            if to := convert(node, argument):
                arguments[i] = (f"{to}({arguments[i][0]})", _atom)
        if (sign := operator_of(node)) is not None:
            symbol, precedence = sign
            (left, left_precedence), (right, right_precedence) = arguments
            mixed = node.op == "or"  # && within || in parentheses, as compilers suggest
            if left_precedence < precedence or mixed and left_precedence == 2:
                left = f"({left})"
            if right_precedence <= precedence or mixed and right_precedence == 2:
                right = f"({right})"
            texts[id(node)] = (f"{left} {symbol} {right}", precedence)
        elif node.op in _prefix:
            inner, precedence = arguments[0]
            inner = inner if precedence == _atom else f"({inner})"
            texts[id(node)] = (_prefix[node.op] + inner, _unary_precedence)
        else:
            texts[id(node)] = (call(node, [a for a, _ in arguments]), _atom)
    return texts[id(root)][0]


_called = {"select": "where", "rint": "round"}  # in Python


def number_text(value: float) -> str:
    """A number as Python writes it, whole ones without a fraction."""
    if isinstance(value, float) and value.is_integer() and -1e15 < value < 1e15 and math.copysign(1, value) == 1 - 2 * (
            value < 0):
        return str(int(value))
    return repr(value)


def text(node: Node) -> str:
    """An expression for messages and comments, cut where it is long."""
    def leaf(n: Node) -> str | None:
        if n.op == "symbol":
            return n.value[1]
        if n.op in ("constant", "truth"):
            return number_text(n.value) if n.op == "constant" else str(n.value)
        if n.op == "element":
            return f"{n.value[0].name}[{n.value[1]}]"
        return f"({n.value[0].name} @ vector)[{n.value[1]}]" if n.op == "dot" else None

    order = walk([node])
    length: dict[int, int] = {}  # of the text, in operations; what is used twice is written twice
    for one in order:
        length[id(one)] = min(1 + sum(length[id(a)] for a in one.args), 201)
    if length[id(node)] > 200:
        return f"({node.op} of {len(order)} operations)"
    written = write(node, leaf, lambda n, arguments: f"{_called.get(n.op, n.op)}({', '.join(arguments)})",
                    lambda *_: None, lambda n: _as_in_python.get(n.op))
    written = written.replace("&&", "and").replace("||", "or").replace("!(", "not (")
    return written if len(written) <= 100 else written[:97] + "..."
