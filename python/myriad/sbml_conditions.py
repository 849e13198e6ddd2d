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
    """Expressions with other expressions in the place of symbols and conditions."""
    roots = list(roots)
    made: dict[int, Any] = {}
    for node in walk(roots):
        if node in values:
            made[id(node)] = values[node]
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


def comparisons_alone(condition: Any, where: str, is_still: Callable[[Any], bool], as_it_is: bool = True) -> Any:
    """A condition of comparisons, `and` and `or`, without `not`. One by == of what `is_still` tells to change at other
    times than events too holds for an instant; one by != fails for an instant, and is refused."""
    if condition.op == "not":
        return comparisons_alone(condition.args[0], where, is_still, not as_it_is)
    if condition.op in ("and", "or"):
        parts = [comparisons_alone(a, where, is_still, as_it_is) for a in condition.args]
        return both(*parts) if (condition.op == "and") is as_it_is else either(*parts)
    if condition.op in _reverse:
        wanted = condition if as_it_is else compare(_reverse[condition.op], *condition.args)
        if wanted.op != "not_equal" or is_still(wanted):
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


def function_of(condition: Any) -> Any:
    """A function that is positive where a condition holds and negative where it does not."""
    if condition.op in ("equal", "not_equal"):
        return choose(condition, constant(math.inf), constant(-math.inf))
    if condition.op in ("and", "or"):
        return ex.make("min" if condition.op == "and" else "max", tuple(function_of(a) for a in condition.args))
    a, b = condition.args if condition.op.startswith("greater") else condition.args[::-1]
    return subtract(a, b)


def functions_of(condition: Any, is_still: Callable[[Any], bool]) -> list[Any]:
    """The functions that rise through zero where a comparison begins to hold."""
    if condition.op == "equal" and not is_still(condition):
        a, b = condition.args
        return [subtract(a, b), subtract(b, a)]
    return [function_of(condition)]


def never(condition: Any) -> bool:
    """Whether a condition is known not to hold."""
    return is_constant(condition) and not value_of(condition)


def any_of(conditions: Iterable[Any]) -> Any:
    return functools.reduce(either, conditions, false)


def all_of(conditions: Iterable[Any]) -> Any:
    return functools.reduce(both, conditions, true)
