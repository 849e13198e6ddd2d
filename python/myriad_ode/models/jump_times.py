# SPDX-License-Identifier: MIT
"""The times at which expressions of time jump: sums of time and constants, and where they have some values.

At the time of a jump, rounding may put what is compared on either side of it. So the next jump is sought a little later
than now: by the rounding errors of what is compared, which depend on its summands and on the precision of the run.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Collection, Mapping
from typing import Any

from ..symbolic import expression as ex, functions as fn, symbols as sym
from ..symbolic.folding import (add, apply, choose, compare, constant, divide, is_constant, make_folded, multiply,
                                subtract, total, value_of)
from ..symbolic.node import symbols_of, walk
from ..symbolic.rewrite import replaced

_comparisons = "less", "less_equal", "greater", "greater_equal", "equal", "not_equal"
_remainders = "fmod", "floor_mod"
_whole = "floor", "rint", "floor_divide", *_remainders
kinked = "abs", "min", "max"
_waves = {"sin": (math.pi, fn.asin), "cos": (math.pi, fn.acos), "sinpi": (1.0, fn.asin), "cospi": (1.0, fn.acos)}

_partly_defined = ("divide", "reciprocal", "rsqrt", "sqrt", "log", "log1p", "log2", "log10", "pow", "powr", "asin",
                   "acos")

_one = constant(1.0)

Form = dict[Any, Any]  #: a sum: coefficients by what they multiply, which is 1, the time, or a function of time
Time = tuple[Any, Any]  #: a time, and how far it has to be ahead to be still to come


def unit_roundoff() -> Any:
    """The largest relative error of rounding in the precision of a run. One text is compiled for both: 1 + 1e-10 is 1
    in single precision alone."""
    one = 1.0 + ex.abs(sym.t_begin)
    return choose(compare("equal", one * (1.0 + 1e-10), one), constant(2.0**-24), constant(2.0**-53))


class JumpTimes:
    """Of an operation that may jump, the times at which it does, among them the last jump before now and the next one.
    `kinks` are the comparisons in absolute values, minima and maxima that were met."""

    def __init__(self, equations: Mapping[Any, Any], changing: Collection[Any]) -> None:
        self._changing = changing
        self._still = {s for s, rate in equations.items() if s not in changing and
                       is_constant(rate) and value_of(rate) == 0}
        self._clocks = {s: rate for s, rate in equations.items() if s not in changing and  # which measure time
                        s not in self._still and self._is_still(rate)}
        self._forms: dict[Any, Form | None] = {}
        self._times: dict[Any, list[Time] | None] = {}
        self.kinks: list[Any] = []
        self.direction = choose(compare("less", sym.t_end, sym.t_begin), constant(-1.0), constant(1.0))

    def may_jump(self, node: Any) -> bool:
        return node.op in (*_comparisons, *_whole) and node.value != ex.continuous and self.is_of_time(node)

    def without_copysign(self, node: Any) -> Any:
        """The sign of a function of time as a choice."""
        if node.op != "copysign" or not self.is_of_time(node.args[1]):
            return node
        size = ex.abs(node.args[0])
        return choose(compare("less", node.args[1], constant(0.0)), make_folded("negate", size), size)

    def is_of_time(self, node: Any) -> bool:
        """Whether time and what changes at actions alone decide an expression."""
        return self._has_time(node) and all(s is sym.time or s in self._clocks or self._is_still(s)
                                            for s in symbols_of([node]))

    def may_be_undefined(self, node: Any) -> bool:
        """Whether there may be times at which an expression has no finite value because of the time itself."""
        return any(self._has_time(argument) for one in walk([node]) if one.op in _partly_defined
                   for argument in one.args[one.op == "divide":])

    def _has_time(self, node: Any) -> bool:
        return any(s is sym.time or s in self._clocks for s in symbols_of([node]))

    def _is_still(self, node: Any) -> bool:
        """Whether an expression changes at actions alone."""
        kinds = "parameter", "shared", "shared_integer", "accessory", "integer_accessory"
        return all(s.value[0] in kinds and s not in self._changing or s in self._still for s in symbols_of([node]))

    def _at(self, node: Any, time: Any) -> Any:
        """An expression at another time."""
        clocks = {s: s + rate * (time - sym.time) for s, rate in self._clocks.items()}
        return replaced([node], {sym.time: time, **clocks})[0]

    def first(self, times: list[Time]) -> Any:
        """The first of some times that is still to come, infinite if there is none. Multiplied by the direction, so
        that it is the smallest backwards, too."""
        to_come = [choose(compare("greater", self.direction * (t - sym.time), ahead), self.direction * t,
                          constant(math.inf)) for t, ahead in times]
        return self.direction * functools.reduce(lambda a, b: ex.make("min", (a, b)), to_come)

    def between(self, node: Any, middle: Any, known: dict[Any, Any]) -> Any:
        """What jumps, as it is between two jumps; what jumps in it is known."""
        inside = self._at(node, middle)
        if node.op not in _remainders:
            return inside
        value, = replaced([node.args[0]], known)
        return subtract(value, subtract(self._at(node.args[0], middle), inside))  # less whole multiples

    # -- When it jumps -------------------------------------------------------------------------------------------------

    def __call__(self, node: Any) -> list[Time] | None:
        """Some times, among them the last jump before now and the next one; None if they have no formula."""
        if node not in self._times:
            self._times[node] = self._found_times_of(node)
        return self._times[node]

    def _found_times_of(self, node: Any) -> list[Time] | None:
        if node.op in _comparisons:
            form = self._form(_decisive(node))
            waves = _waves_of(form)
            if form is None or len(waves) > 1 or waves and sym.time in form:
                return None
            if waves:
                rest = self._rest({key: factor for key, factor in form.items() if key is not waves[0]})
                return self._angles(waves[0], divide(_negative(rest), form[waves[0]]))
            return self._roots(form, [constant(0.0)])
        inside = _decisive(node)
        form = self._form(inside)
        if form is None or _waves_of(form):
            return None
        shift = 0.5 if node.op == "rint" else 0.0
        below = apply(ex.floor, subtract(self._now_of(inside, form), constant(shift)))
        return self._roots(form, [add(below, constant(shift + k)) for k in (-1, 0, 1)])

    def _now_of(self, node: Any, own: Form | None = None) -> Any:
        """The value of an expression a little later than now, so that rounding cannot put it before a jump that is at
        this time. `own`: the expression as a sum, where its own size decides, as of whole parts and angles."""
        inside = [self._form(_decisive(one)) for one in walk([node]) if self.may_jump(one)]
        forms = [form for form in (own, *inside) if form is not None]
        if not forms:
            return node
        ahead = functools.reduce(lambda a, b: ex.make("max", (a, b)), [self._ahead(form) for form in forms])
        return self._at(node, sym.time + self.direction * ahead)

    def _ahead(self, form: Form) -> Any:
        """The error of the time at which a sum has some value, by rounding; more than zero, so that one is ahead of a
        jump at zero, too."""
        size = total([ex.abs(self._term(factor, key)) for key, factor in form.items() if key is not sym.time])
        if (by := form.get(sym.time)) is not None:
            size = choose(compare("equal", by, constant(0.0)), constant(0.0), divide(size, ex.abs(by)))
        return 16.0 * unit_roundoff() * (ex.abs(sym.time) + size) + 1e-30

    def _rest(self, form: Form) -> Any:
        """A sum without its multiple of the time."""
        return total([self._term(factor, self._now_of(key)) for key, factor in form.items() if key is not sym.time])

    @staticmethod
    def _term(factor: Any, value: Any) -> Any:
        """A product that is zero where the factor is, even if the value is not finite, as floor(time / 0)."""
        product = multiply(factor, value)
        if is_constant(factor) or is_constant(value):
            return product
        return choose(compare("equal", factor, constant(0.0)), constant(0.0), product)

    def _roots(self, form: Form, values: list[Any]) -> list[Time]:
        """The times at which a sum has some values."""
        if sym.time not in form:
            return []
        less = _negative(self._rest(form))
        times = [divide(add(value, less), form[sym.time]) for value in values]
        # what does not follow from the time has the same bits whenever it is computed
        ahead = self._ahead(form) if any(self._has_time(one) for one in times) else constant(0.0)
        return [(time, ahead) for time in times]

    def _angles(self, wave: Any, height: Any) -> list[Time]:
        """The times at which a sine or cosine of time has a value."""
        angle, = wave.args
        form = self._form(angle)
        assert form is not None
        half_turn, inverse = _waves[wave.op]
        principal = multiply(constant(half_turn / math.pi), apply(inverse, height))
        other = subtract(constant(half_turn if wave.op in ("sin", "sinpi") else 0.0), principal)
        turns = apply(ex.floor, divide(self._now_of(angle, form), constant(2 * half_turn)))
        return self._roots(form, [add(one, multiply(add(turns, constant(k)), constant(2 * half_turn)))
                                  for one in (principal, other) for k in (-1.0, 0.0, 1.0)])

    # -- Sums ----------------------------------------------------------------------------------------------------------

    def _form(self, node: Any) -> Form | None:
        """An expression of time and constants as a sum that is valid until the next jump; None if it is none."""
        if node not in self._forms:
            self._forms[node] = self._form_of(node)
        return self._forms[node]

    def _form_of(self, node: Any) -> Form | None:
        if node is sym.time:
            return {sym.time: _one}
        if node in self._clocks:
            rate = self._clocks[node]
            return {sym.time: rate, _one: node - rate * sym.time}
        if not self._has_time(node):
            return {_one: node}
        if node.op in kinked:
            return self._form(self._with_kink(node))
        forms: list[Form] = []
        for argument in node.args:
            form = {} if argument.type == ex.condition else self._form(argument)
            if form is None:
                return None
            forms.append(form)
        first, second, third = [*forms, {}, {}][:3]
        jumps = [node] if node.op in _whole else walk(node.args[:1]) if node.op == "select" else []
        if any(self.may_jump(one) and self(one) is None for one in jumps):
            return None
        if node.op == "select":
            chosen = self._now_of(node.args[0])
            return {key: choose(chosen, second.get(key, constant(0.0)), third.get(key, constant(0.0)))
                    for key in {**second, **third}}
        if node.op in ("add", "subtract"):
            return _sum(first, second if node.op == "add" else _opposite(second))
        if node.op == "negate":
            return _opposite(first)
        if node.op in ("multiply", "divide"):
            if node.op == "multiply" and all(key is _one for key in first):
                first, second = second, first
            of = multiply if node.op == "multiply" else divide
            if any(key is not _one for key in second):
                return None
            by = second.get(_one, constant(0.0))
            return {key: of(factor, by) for key, factor in first.items()}
        if node.op in _remainders:
            return _sum(first, {ex.make("subtract", (node.args[0], node)): constant(-1.0)})
        if node.op in _whole or node.op in _waves and not _waves_of(first):
            return {node: _one}
        return None

    def _with_kink(self, node: Any) -> Any:
        """An absolute value, a minimum or a maximum by a comparison."""
        a, b = node.args if len(node.args) == 2 else (node.args[0], constant(0.0))
        self.kinks.append(comparison := is_less(node))
        if node.op == "abs":
            return choose(comparison, ex.make("negate", (a,)), a)
        return choose(comparison, *((a, b) if node.op == "min" else (b, a)))

    def comes_back(self, node: Any) -> bool:
        """Whether a sum has other parts than a constant and a multiple of the time, as a sine."""
        return any(key is not sym.time and key is not _one for key in self._form(node) or ())


def is_less(node: Any) -> Any:
    """Whether the first argument of an absolute value, a minimum or a maximum is less than the second."""
    return compare("less", *(node.args if len(node.args) == 2 else (node.args[0], constant(0.0))))


def _decisive(node: Any) -> Any:
    """What decides when an operation jumps: at zero if it is a comparison, else at whole numbers."""
    if node.op in _comparisons:
        return ex.make("subtract", node.args)
    return node.args[0] if len(node.args) == 1 else ex.make("divide", node.args)


def _sum(a: Form, b: Form) -> Form:
    made = {key: add(a.get(key, constant(0.0)), b.get(key, constant(0.0))) for key in {**a, **b}}
    return {key: factor for key, factor in made.items() if not (is_constant(factor) and value_of(factor) == 0)}


def _opposite(form: Form) -> Form:
    return {key: _negative(factor) for key, factor in form.items()}


def _negative(value: Any) -> Any:
    return value.args[0] if value.op == "negate" else make_folded("negate", value)


def _waves_of(form: Form | None) -> list[Any]:
    return [key for key in form or () if key.op in _waves]
