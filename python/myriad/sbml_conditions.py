# SPDX-License-Identifier: MIT
"""Conditions of SBML as trees of comparisons, `and` and `or`, and what is asked about them."""

from __future__ import annotations

import functools
import math
from collections.abc import Callable, Iterable
from typing import Any

from . import expression as ex, symbols as sym
from .expression import walk
from .folding import both, choose, compare, constant, either, folded, is_constant, opposite, subtract, value_of
from .sbml_math import Refused

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


def comparisons_alone(condition: Any, where: str, is_still: Callable[[Any], bool], as_it_is: bool = True) -> Any:
    """A condition of comparisons, `and` and `or`, without `not`. A comparison by != that fails for an instant alone is
    refused."""
    if condition.op == "truth":
        return condition if as_it_is else opposite(condition)
    if condition.op == "not":
        return comparisons_alone(condition.args[0], where, is_still, not as_it_is)
    if condition.op in ("and", "or"):
        parts = [comparisons_alone(a, where, is_still, as_it_is) for a in condition.args]
        return both(*parts) if (condition.op == "and") is as_it_is else either(*parts)
    if condition.op in _reverse:
        for i, side in enumerate(condition.args):
            if side.op == "select":  # a piecewise compared: the comparison of the piece that is chosen
                chosen, a, b = side.args
                pieces = [compare(condition.op, *(piece if j == i else other for j, other in enumerate(condition.args)))
                          for piece in (a, b)]
                return comparisons_alone(choose(chosen, *pieces), where, is_still, as_it_is)
        wanted = condition if as_it_is else compare(_reverse[condition.op], *condition.args)
        if wanted.op != "not_equal" or not is_for_an_instant(wanted, is_still):
            return wanted
    raise Refused(f"{where}: its trigger is no combination of ==, <, <=, > and >=")


def comparisons_of(condition: Any) -> list[Any]:
    """The comparisons that a condition is made of, each once."""
    if condition.op in ("and", "or"):
        return list(dict.fromkeys(c for a in condition.args for c in comparisons_of(a)))
    return [condition] if condition.op in _reverse else []


def with_values(condition: Any, values: dict[Any, Any]) -> Any:
    """A condition with others in the place of some of its comparisons."""
    if condition.op in ("and", "or"):
        return (both if condition.op == "and" else either)(*(with_values(a, values) for a in condition.args))
    return values.get(condition, condition)


def function_of(condition: Any, is_still: Callable[[Any], bool]) -> Any:
    """A function that is positive where a condition holds and negative where it does not."""
    if condition.op in ("and", "or"):
        sides = tuple(function_of(a, is_still) for a in condition.args)
        return ex.make("min" if condition.op == "and" else "max", sides)
    a, b = condition.args if condition.op.startswith("greater") else condition.args[::-1]
    if condition.op in ("equal", "not_equal") or not is_still(condition) and _only_jumps(condition, is_still):
        return choose(condition, constant(math.inf), constant(-math.inf))  # as a - b may be zero for a while
    return subtract(a, b)


def _only_jumps(comparison: Any, is_still: Callable[[Any], bool]) -> bool:
    """Whether the sides of a comparison are constant between jumps, as floor(time) is."""
    waiting = list(comparison.args)
    while waiting:
        part = waiting.pop()
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
