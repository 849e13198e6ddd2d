# SPDX-License-Identifier: MIT
"""Expressions made of others: some operations replaced, the others as they were."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

from . import expression as ex
from .node import walk
from .folding import constant

if TYPE_CHECKING:
    from .expression import Expression
    from .node import Node


def rebuilt(roots: list[Expression], changed: Callable[[Node], Any],
             known: Mapping[Any, Any] | None = None) -> list[Expression]:
    """Expressions with each operation as `changed` gives it, and those that are known replaced."""
    made: dict[Node, Any] = {}
    for node in walk(roots):
        if known and node in known:
            made[node] = known[node]
            continue
        arguments = tuple(made[a] for a in node.args)
        same = all(a is b for a, b in zip(arguments, node.args))
        made[node] = changed(node if same else ex.make(node.op, arguments, node.value, node.type))
    return [made[root] for root in roots]


def replaced(roots: list[Expression], values: Mapping[Any, Any]) -> list[Expression]:
    """Expressions with others in the place of some nodes."""
    return rebuilt(roots, lambda node: node, values)


def substituted(expression: Expression, values: Mapping[Any, float]) -> Expression:
    """An expression with the values of some symbols in their place."""
    return replaced([expression], {s: constant(float(v)) for s, v in values.items()})[0]
