# SPDX-License-Identifier: MIT
"""Derivatives of recorded expressions by symbols, as expressions: the Jacobian that stiff methods use. Entries that are
always zero are left out."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from . import expression as ex, functions as fn
from .node import Node, walk
from .operations import known_of

if TYPE_CHECKING:
    from .expression import Condition, Expression

def _times(partial: Expression | Condition | int, derivative: Expression) -> Expression:
    """A product in which a condition chooses between the derivative and zero."""
    if isinstance(partial, ex.Condition):
        return fn.where(partial, derivative, 0.0)
    if isinstance(partial, int):
        return derivative if partial == 1 else -derivative
    if derivative.op == "constant" and derivative.value == 1:
        return ex.as_number(partial)
    return partial * derivative


def _forwards(node: Node, argument: Node, partial: Expression | Condition | int, derivative: Expression,
              singular: set[int], large: set[int]) -> Expression:
    """The product of a partial derivative and that of its argument; but zero, its limit, where it would be zero times
    infinity: where the argument does not vary; where an exponential is zero, as exp(n log(x)) at x = 0; where a
    quotient by one of the `singular` nodes is, as 1 / (1 + exp(x)) for large x; and where the argument of a function
    that becomes flat, one of the `large` nodes, overflows."""
    if derivative.op == "constant" and derivative.value == 0:
        return derivative
    if isinstance(partial, ex.Expression) and derivative.op != "constant":
        if known_of(node.op).is_singular:  # so that it has the right derivatives in its turn
            partial = fn.where(fn.is_finite(partial) | (derivative != 0.0), partial, 0.0)
        elif node.op in _exponentials and id(argument) in singular or _is_overflowing(node, argument, singular):
            return fn.where(partial == 0.0, 0.0, partial * derivative)
        if _becomes_flat(node, argument, large):
            return fn.where(_far_out(node, argument, derivative), 0.0, partial * derivative)
    return _times(partial, derivative)


_exponentials = ("exp", "exp2", "expm1")  # whose derivatives are zero where exp is
_flat = ("tanh", "atan", "rsqrt", "reciprocal", "pow", "powr")  # whose slopes may be zero where arguments overflow
_largest = float(np.finfo(float).max)


def _becomes_flat(node: Node, argument: Node, large: set[int]) -> bool:
    """Whether a node is a function of an argument that may overflow, and its slope may be zero there."""
    return node.op in _flat and argument is node.args[0] and id(argument) in large and not (
        len(node.args) == 2 and node.args[1].op == "constant" and float(node.args[1].value) >= 0)


def _far_out(node: Node, argument: Any, derivative: Expression) -> Condition:
    """Whether the argument of such a function has overflowed, or its derivative has and the argument nearly so; of a
    power only where the power is next to zero. As `flat_far_out` of kernel/scalar/partial.hpp, and `by_base` of
    kernel/scalar/dual.hpp."""
    size = abs(argument)
    far = (size > _largest) | ((size > _largest * 2.0**-32) & (abs(derivative) > _largest))
    return far & (abs(node.args[1] * node) < 2.0**64 / _largest) if len(node.args) == 2 else far


_overflow = ("exp", "exp2", "expm1", "sinh", "cosh")  # of arguments of usual size, and their derivatives with them


def _with_singular(order: Sequence[Node]) -> tuple[set[int], set[int]]:
    """Nodes whose derivatives may be infinite; and, of these, those whose values may overflow with them."""
    found: set[int] = set()
    large: set[int] = set()
    for node in order:
        if node.op in _overflow or any(id(a) in large for a in node.args):
            large.add(id(node))
        if id(node) in large or known_of(node.op).is_singular or any(id(a) in found for a in node.args):
            found.add(id(node))
    return found, large


def _is_overflowing(node: Node, argument: Node, singular: set[int]) -> bool:
    """Whether a node is a quotient by an argument that may be infinite, and its derivatives too."""
    return node.op == "divide" and argument is node.args[1] and id(argument) in singular


def dependencies(roots: Sequence[Node], symbols: Sequence[Node]) -> list[list[int]]:
    """For each root the numbers of the symbols that it depends on, in order."""
    bit = {id(s): 1 << i for i, s in enumerate(symbols)}
    masks: dict[int, int] = {}
    for node in walk(roots):
        mask = bit.get(id(node), 0)
        for argument in node.args:
            mask |= masks[id(argument)]
        masks[id(node)] = mask
    return [[i for i in range(len(symbols)) if masks[id(root)] >> i & 1] for root in roots]


def derivatives(roots: Sequence[Node], symbols: Sequence[Node]) -> list[dict[int, Expression]] | None:
    """For each root {number of a symbol: derivative by it}, or None if an operation has no rule here, as the lookup in
    a table. Derivatives of functions with steps, such as `floor`, are zero and left out."""
    one = ex.constant(1.0)
    number = {id(s): i for i, s in enumerate(symbols)}
    found: dict[int, dict[int, Expression]] = {}
    order = walk(roots)
    singular, large = _with_singular(order)
    for node in order:
        total: dict[int, Expression] = {}
        if id(node) in number:
            total[number[id(node)]] = one
        elif node.type == ex.real and any(found[id(a)] for a in node.args):
            rule = known_of(node.op).partials
            if rule is None:
                return None
            for partial, argument in zip(rule(node, *node.args), node.args):
                if partial is None:
                    continue
                for i, derivative in found[id(argument)].items():
                    term = _forwards(node, argument, partial, derivative, singular, large)
                    total[i] = total[i] + term if i in total else term
        found[id(node)] = total
    return [found[id(root)] for root in roots]


def _cheap_rule(op: str) -> Callable[..., Sequence[Any]] | None:
    """The derivatives of an operation by its arguments: of a quotient with one division, where the rule has three."""
    return (lambda f, a, b: (1 / b, -(a * (1 / b)) * (1 / b))) if op == "divide" else known_of(op).partials


def transposed(roots: Sequence[Node], weights: Sequence[Expression],
               symbols: Sequence[Node]) -> list[Expression] | None:
    """For each symbol the sum over the roots of a weight times the derivative by the symbol, at the cost of a few times
    the roots, however many symbols there are: reverse mode. None where `derivatives` gives None."""
    depends = {id(s) for s in symbols}
    order = walk(roots)
    above_singular, above_large = _with_singular(order)
    for node in order:
        if node.type == ex.real and any(id(a) in depends for a in node.args):
            depends.add(id(node))
    by: dict[int, Expression] = {}  # the derivative of the sum by each node
    # Nodes that only count where a condition holds, or within an exponential that may be zero, so that their derivative
    # is zero where they may have no value; and those whose derivative may be infinite, as it comes by that of a square
    # root. Products with what is zero are zero.
    conditional: set[int] = set()
    singular: set[int] = set()

    def add(node: Node, term: Expression, is_conditional: bool, is_singular: bool) -> None:
        if id(node) not in depends:
            return
        if is_singular:
            singular.add(id(node))
        if id(node) in by:
            by[id(node)] = by[id(node)] + term
            if not is_conditional:
                conditional.discard(id(node))
            return
        by[id(node)] = term
        if is_conditional:
            conditional.add(id(node))

    for root, weight in zip(roots, weights):
        add(root, weight, False, False)
    for node in reversed(order):
        if id(node) not in by or not node.args:
            continue
        rule = _cheap_rule(node.op)
        if rule is None:
            return None
        weight = by[id(node)]
        for partial, argument in zip(rule(node, *node.args), node.args):
            if partial is None or id(argument) not in depends:
                continue
            is_conditional, is_singular = id(node) in conditional, id(node) in singular
            term = _times(partial, weight)
            if isinstance(partial, ex.Condition):
                is_conditional = True
            elif isinstance(partial, Node) and partial.op != "constant":
                if is_conditional or known_of(node.op).is_singular:
                    term = fn.where(weight == 0.0, 0.0, term)
                if is_singular:
                    term = fn.where(partial == 0.0, 0.0, term)
                is_singular = is_singular or known_of(node.op).is_singular
                is_conditional = (is_conditional or node.op in _exponentials and id(argument) in above_singular
                                  or _is_overflowing(node, argument, above_singular)
                                  or _becomes_flat(node, argument, above_large))
            add(argument, term, is_conditional, is_singular)
    return [by.get(id(s), ex.constant(0.0)) for s in symbols]


def directional(roots: Sequence[Node], symbols: Sequence[Node],
                direction: Sequence[Expression]) -> list[Expression] | None:
    """The derivatives of the roots where each symbol moves by its component of a direction. None where `derivatives`
    gives None."""
    moves: dict[int, Expression] = {id(s): d for s, d in zip(symbols, direction)}
    order = walk(roots)
    singular, large = _with_singular(order)
    for node in order:
        if node.type != ex.real or not any(id(a) in moves for a in node.args):
            continue
        rule = _cheap_rule(node.op)
        if rule is None:
            return None
        terms = [_forwards(node, a, partial, moves[id(a)], singular, large)
                 for partial, a in zip(rule(node, *node.args), node.args) if partial is not None and id(a) in moves]
        for term in terms:
            moves[id(node)] = moves[id(node)] + term if id(node) in moves else term
    return [moves.get(id(root), ex.constant(0.0)) for root in roots]
