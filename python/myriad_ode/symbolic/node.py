# SPDX-License-Identifier: MIT
"""The graph that an expression is: its nodes, walks over them, and their text."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from typing import Any, NoReturn

from ..base.errors import Error

real, integer, condition = "real", "integer", "condition"  # the types of nodes


class Node:
    """An operation with its arguments. Nodes are made by `expression.make`, so that equal ones are the same object."""

    __slots__ = ("op", "args", "value", "type", "line", "__weakref__")
    op: str
    args: tuple[Any, ...]
    value: Any
    type: str
    line: tuple[str, int] | None

    def __hash__(self) -> int:
        return id(self) >> 4

    def __repr__(self) -> str:
        return text(self)

    def __bool__(self) -> NoReturn:
        raise Error(f"`{text(self)}` has no truth value while the model is recorded, as it differs between instances: "
                    "instead of `if`, `and`, `or`, `not` and chained comparisons use my.where(condition, a, b) "
                    "and (a < b) & (b < c), |, ~")

    def __iter__(self) -> NoReturn:
        raise Error(f"`{text(self)}` is one number and cannot be iterated over")


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
            return str(n.value[1])
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
