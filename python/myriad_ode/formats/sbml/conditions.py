# SPDX-License-Identifier: MIT
"""Conditions of SBML as trees of comparisons, `and` and `or`, and what is asked about them."""

from __future__ import annotations

import functools
import math
from collections.abc import Callable, Iterable
from typing import Any

from ...symbolic import expression as ex, symbols as sym
from ...symbolic.expression import walk
from ...symbolic.folding import (both, choose, compare, constant, either, folded, is_constant, opposite, subtract,
                                 value_of)
from .math import Refused

true, false = ex.constant(True), ex.constant(False)


def substituted(roots: Iterable[Any], values: dict[Any, Any]) -> list[Any]:
    """Expressions with other expressions in the place of symbols."""
    roots = list(roots)
    made: dict[int, Any] = {}
    for node in walk(roots):
        if node.op == "symbol":
            made[id(node)] = values.get(node, node)
        elif any(made[id(a)] is not a for a in node.args):
            arguments = tuple(made[id(a)] for a in node.args)
            if node.op in ("and", "or"):
                made[id(node)] = (both if node.op == "and" else either)(*arguments)
            elif node.op == "not":
                made[id(node)] = opposite(*arguments)
            elif node.op == "subtract" and arguments[0] is arguments[1] is sym.time:
                made[id(node)] = constant(0.0)
            elif node.op == "select":
                made[id(node)] = choose(*arguments)
            else:
                made[id(node)] = folded(ex.make(node.op, arguments, node.value, node.type))
        else:
            made[id(node)] = node
    return [made[id(root)] for root in roots]


_reverse = {"less": "greater_equal", "less_equal": "greater", "greater": "less_equal", "greater_equal": "less",
            "equal": "not_equal", "not_equal": "equal"}


_mirrored = {"less": "greater", "less_equal": "greater_equal", "greater": "less", "greater_equal": "less_equal"}


def complements(comparison: Any) -> list[Any]:
    """The comparisons that hold where that one does not."""
    a, b = comparison.args
    reverse = _reverse[comparison.op]
    return [compare(reverse, a, b), compare(_mirrored.get(reverse, reverse), b, a)]


def comparisons_alone(condition: Any, where: str, is_still: Callable[[Any], bool]) -> Any:
    """A condition of comparisons, `and` and `or`, without `not`. A comparison by != that fails for an instant alone is
    refused."""
    made: dict[tuple[Any, bool], Any] = {}  # as formulas share their parts

    def alone(condition: Any, as_it_is: bool) -> Any:
        key = condition, as_it_is
        if key not in made:
            made[key] = written(condition, as_it_is)
        return made[key]

    def written(condition: Any, as_it_is: bool) -> Any:
        if condition.op == "truth":
            return condition if as_it_is else opposite(condition)
        if condition.op == "not":
            return alone(condition.args[0], not as_it_is)
        if condition.op in ("and", "or"):
            parts = [alone(a, as_it_is) for a in condition.args]
            return both(*parts) if (condition.op == "and") is as_it_is else either(*parts)
        if condition.op in _reverse:
            for i, side in enumerate(condition.args):
                if side.op == "select":  # a piecewise compared: the comparison of the piece that is chosen
                    chosen, a, b = side.args
                    pieces = [compare(condition.op, *(piece if j == i else other
                                                      for j, other in enumerate(condition.args))) for piece in (a, b)]
                    return alone(choose(chosen, *pieces), as_it_is)
            wanted = condition if as_it_is else compare(_reverse[condition.op], *condition.args)
            if wanted.op != "not_equal" or not is_for_an_instant(wanted, is_still):
                return wanted
        raise Refused(f"{where}: its trigger is no combination of ==, <, <=, > and >=")

    return alone(condition, True)


def _connected(condition: Any) -> list[Any]:
    """The parts of a condition that `and` and `or` connect, and what these make of them; each once, and before what it
    is a part of."""
    order, seen, waiting = [], set(), [(condition, False)]
    while waiting:
        part, parts_are_there = waiting.pop()
        if parts_are_there:
            order.append(part)
        elif part not in seen:
            seen.add(part)
            waiting.append((part, True))
            if part.op in ("and", "or"):
                waiting += [(a, False) for a in reversed(part.args)]
    return order


def comparisons_of(condition: Any) -> list[Any]:
    """The comparisons that a condition is made of, each once."""
    return [part for part in _connected(condition) if part.op in _reverse]


def with_values(condition: Any, values: dict[Any, Any]) -> Any:
    """A condition with others in the place of some of its comparisons."""
    made: dict[Any, Any] = {}
    for part in _connected(condition):
        if part.op in ("and", "or"):
            made[part] = (both if part.op == "and" else either)(*(made[a] for a in part.args))
        else:
            made[part] = values.get(part, part)
    return made[condition]


def function_of(condition: Any, is_still: Callable[[Any], bool]) -> Any:
    """A function that is positive where a condition holds and negative where it does not."""
    made: dict[Any, Any] = {}
    for part in _connected(condition):
        if part.op in ("and", "or"):
            made[part] = ex.make("min" if part.op == "and" else "max", tuple(made[a] for a in part.args))
        else:
            made[part] = _function_of_one(part, is_still)
    return made[condition]


def _function_of_one(comparison: Any, is_still: Callable[[Any], bool]) -> Any:
    a, b = comparison.args if comparison.op.startswith("greater") else comparison.args[::-1]
    if comparison.op in ("equal", "not_equal") or not is_still(comparison) and _only_jumps(comparison, is_still):
        return choose(comparison, constant(math.inf), constant(-math.inf))  # as a - b may be zero for a while
    return subtract(a, b)


def _only_jumps(comparison: Any, is_still: Callable[[Any], bool]) -> bool:
    """Whether the sides of a comparison are constant between jumps, as floor(time) is."""
    waiting, seen = list(comparison.args), set()
    while waiting:
        part = waiting.pop()
        if part in seen:
            continue
        seen.add(part)
        if part.op in ("floor", "rint") or part.type == ex.condition or is_still(part):
            continue
        if part.op == "symbol":
            return False
        waiting += part.args
    return True


def is_for_an_instant(comparison: Any, is_still: Callable[[Any], bool]) -> bool:
    """Whether a comparison by == can hold, or one by != fail, for an instant alone. `is_still` tells what changes at
    events alone."""
    return comparison.op in ("equal", "not_equal") and not _only_jumps(comparison, is_still)


def functions_of(condition: Any, is_still: Callable[[Any], bool]) -> list[Any]:
    """The functions that rise through zero where a comparison begins to hold."""
    if condition.op == "equal" and is_for_an_instant(condition, is_still):
        a, b = condition.args
        return [subtract(a, b), subtract(b, a)]
    return [function_of(condition, is_still)]


def never(condition: Any) -> bool:
    """Whether a condition is known not to hold."""
    return is_constant(condition) and not value_of(condition)


def any_of(conditions: Iterable[Any]) -> Any:
    return functools.reduce(either, conditions, false)


def all_of(conditions: Iterable[Any]) -> Any:
    return functools.reduce(both, conditions, true)
