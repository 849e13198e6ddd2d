# SPDX-License-Identifier: MIT
"""Where whole and real numbers meet in an expression."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from .node import condition, integer, real, walk

if TYPE_CHECKING:
    from .node import Node


def converts(node: Node, argument: Node) -> bool:
    """Whether an argument is a whole number, not a constant, in an operation of real ones."""
    return (argument.type == integer and argument.op != "constant" and
            (node.type == real or node.type == condition and any(a.type == real for a in node.args)))


def is_plain(node: Node) -> bool:
    """Whether an expression is one number for all instances, so that packs do not come into it."""
    return all(n.value[0] in ("shared", "shared_integer") if n.op == "symbol" else n.op != "select" or n.type == real
               for n in walk([node]))


def is_long(node: Node) -> bool:
    """Whether a whole number has 64 bits, as the number of the instance has; others have 32."""
    return any(n.value == ("built-in", "instance") for n in walk([node]) if n.op == "symbol")


def generic_problem(roots: Iterable[Node]) -> Node | None:
    """The first node that cannot be computed for a whole pack, or None: packs of whole numbers have no products and do
    not mix with real ones."""
    for node in walk(roots):
        products = node.type == integer and node.op in ("multiply", "min", "max", "quotient", "remainder")
        if (products or any(converts(node, a) and not is_plain(a) for a in node.args)) and not is_plain(node):
            return node
    return None
