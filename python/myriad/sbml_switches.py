# SPDX-License-Identifier: MIT
"""Conditions in time alone, as of inputs that are switched on and off: steps end where they begin or cease to hold, and
between these times the equations do not jump."""

from __future__ import annotations

import functools
import operator
from collections.abc import Callable, Iterable
from typing import Any

from . import expression as ex, symbols as sym
from .derivatives import derivatives
from .expression import evaluate, symbols_of, walk
from .folding import choose, compare, constant, divide, is_constant, opposite, subtract, value_of
from .model import Stop, stop
from .sbml_conditions import substituted

_linear = ("symbol", "add", "subtract", "multiply", "divide", "negate", "fma")
_comparisons = ("less", "less_equal", "greater", "greater_equal")
_near = 1e-13  # relative difference of times that are the same but for rounding
_on, _off = ex.constant(1), ex.constant(0)
_forwards = compare("less_equal", sym.t_begin, sym.t_end)


class Switches:
    """What becomes of equations with such conditions: `equations` that read integers instead, `initialise`, which sets
    these at the begin of a phase, and `stops`, which set them where conditions change. A condition is one of the four
    comparisons, of expressions of time and parameters whose difference has a constant slope in time. Times that are
    numbers share a stop, and an integer that counts them. `name_of` gives the integers names."""

    def __init__(self, equations: Iterable[Any], name_of: Callable[[str], str]) -> None:
        self.equations = list(equations)
        self.stops: list[Stop] = []
        self.initialise: dict[Any, Any] = {}
        self.names: list[str] = []
        found = {node: time for node in walk(self.equations)
                 if node.op in _comparisons and (time := _time_of(node)) is not None}
        if not found:
            return
        times = dict.fromkeys(at for at, _ in found.values())
        numbers = sorted(value_of(at) for at in times if is_constant(at))
        passed: dict[Any, Any] = {}  # the condition that time is past a time, in the direction of the integration
        if numbers:
            count = self._integer(name_of("switches"))
            between = [(a + b) / 2 for a, b in zip(numbers, numbers[1:])]
            self.initialise[count] = _sum(_is_past(constant(number)) for number in numbers)
            # at one of the numbers, whatever its rounding
            reached = _sum(compare("greater", sym.time, constant(middle)) for middle in between)
            for order in (numbers, numbers[::-1])[:len(numbers)]:  # for integration forwards and backwards
                self.stops.append(stop(order, name=f"{count.value[1]}_time_{len(self.stops) + 1}",
                                       do={count: reached + choose(_forwards, _on, _off)}))
            passed = {at: compare("greater", count, ex.constant(numbers.index(value_of(at))))
                      for at in times if is_constant(at)}
        for at in times:
            if not is_constant(at):
                switch = self._integer(name_of(f"switch_{len(self.names) + 1}"))
                self.initialise[switch] = choose(_is_past(at), _on, _off)
                self.stops.append(stop(at, name=f"{switch.value[1]}_time", do={switch: choose(_forwards, _on, _off)}))
                passed[at] = compare("equal", switch, _on)
        self.equations = substituted(self.equations, {
            node: passed[at] if holds_after else opposite(passed[at]) for node, (at, holds_after) in found.items()})

    def _integer(self, name: str) -> Any:
        self.names.append(name)
        return sym.integer_accessory(name)


def _sum(conditions: Iterable[Any]) -> Any:
    return functools.reduce(operator.add, (choose(c, _on, _off) for c in conditions), _off)


def _is_past(at: Any) -> Any:
    """Whether a phase that begins now has passed a time, which it has if it begins there."""
    away = subtract(sym.time, at)
    rounding = _near * ex.abs(sym.time)
    return choose(_forwards, compare("greater_equal", away, -rounding), compare("greater", away, rounding))


def _moves(node: Any) -> bool:
    return any(s is sym.time for s in symbols_of([node]))


def _time_of(comparison: Any) -> tuple[Any, bool] | None:
    """The time at which a comparison begins or ceases to hold, and whether it holds afterwards; None if it is none of
    time and parameters whose difference has a constant slope."""
    others = [s for s in symbols_of([comparison]) if s is not sym.time]
    if not _moves(comparison) or any(s.value[0] not in ("parameter", "shared") for s in others):
        return None
    a, b = comparison.args
    if any(n.op not in _linear and _moves(n) for n in walk([a, b])):
        return None
    found = derivatives([subtract(a, b)], [sym.time])
    if found is None or symbols_of(list(found[0].values())):
        return None
    slope = float(evaluate([found[0][0]], {})[0]) if 0 in found[0] else 0.0
    if slope == 0:
        return None
    if a is sym.time and slope == 1:  # without rounding
        at = b
    elif b is sym.time and slope == -1:
        at = a
    else:
        at = divide(subtract(*substituted([b, a], {sym.time: constant(0.0)})), constant(slope))
    return at, (slope > 0) == comparison.op.startswith("greater")
