# SPDX-License-Identifier: MIT
"""The values of expressions."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from .node import Node, real, walk
from .operations import operations


def _value_of(op: str) -> Callable[..., Any]:
    value = operations[op].value
    assert value is not None  # as `evaluate` knows the others
    return value


def evaluate(roots: Sequence[Node], values: Mapping[Any, Any]) -> list[Any]:
    """The values of expressions by NumPy: `values` has a number or an array for each symbol. Slow; a second opinion for
    tests and for looking at a model. Where C++ has functions of its own, the last places differ."""
    known: dict[int, Any] = {}
    with np.errstate(all="ignore"):
        for node in walk(roots):
            if node.op == "symbol":
                given = np.asarray(values[node])
                is_whole = node.type == real and given.dtype.kind in "biu"
                known[id(node)] = (given.astype(float) if is_whole else given)[()]
            elif node.op in ("constant", "truth"):
                known[id(node)] = np.float64(node.value) if node.type == real else node.value
            elif node.op == "element":
                known[id(node)] = node.value[0].values.flat[node.value[1]]
            elif node.op == "dot":
                table, row = node.value
                known[id(node)] = sum(table.values.flat[place] * known[id(a)]
                                      for place, a in zip(table.places(row), node.args))
            elif node.op == "lookup":
                table, first, stride, rows = node.value
                row = np.clip(np.nan_to_num(known[id(node.args[0])]), 0, rows - 1).astype(int)
                known[id(node)] = table.values[first + stride * row]
            elif node.op == "find_interval":
                table, first, knots = node.value
                place = np.searchsorted(table.values[first:first + knots], known[id(node.args[0])], side="right")
                known[id(node)] = np.clip(place - 1, 0, knots - 2)
            else:
                known[id(node)] = _value_of(node.op)(*(known[id(a)] for a in node.args))
    return [known[id(root)] for root in roots]
