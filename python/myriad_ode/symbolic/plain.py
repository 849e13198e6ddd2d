# SPDX-License-Identifier: MIT
"""Expressions as lists of plain values and arrays, for files that are read without running what is in them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from .expression import make
from .node import Node, condition, integer, real, walk
from .operations import operations
from .table import Table, tables_of

_without_row = ("symbol", "constant", "truth", "element", "lookup", "find_interval")
_of_tables = ("element", "dot", "lookup", "find_interval")


def to_plain(roots: Sequence[Node]) -> tuple[dict[str, Any], list[np.ndarray[Any, Any]]]:
    """Expressions as what JSON can hold, and the values of their tables. A product with a row of a table is written
    with the places of its elements."""
    nodes = walk(roots)
    tables = tables_of(nodes)
    values = [table.values for table in tables]
    place = {id(node): number for number, node in enumerate(nodes)}
    made = []
    for node in nodes:
        value = node.value
        if node.op == "dot":
            table, row = value
            value = [tables.index(table), [int(p) for p in table.places(row)]]
        elif node.op in _of_tables:
            value = [tables.index(value[0]), *(int(number) for number in value[1:])]
        elif node.op == "symbol":
            value = list(value)
        made.append([node.op, [place[id(a)] for a in node.args], value, node.type])
    return {"nodes": made, "roots": [place[id(root)] for root in roots],
            "tables": [table.name for table in tables]}, values


def from_plain(plain: Any, values: Sequence[np.ndarray[Any, Any]]) -> list[Any]:
    """The expressions. Raises ValueError, or another error of reading, if these are none."""
    tables = [Table(str(name), given) for name, given in zip(plain["tables"], values, strict=True)]
    nodes: list[Any] = []
    for op, arguments, value, type_ in plain["nodes"]:
        if op not in operations and op not in _without_row or type_ not in (real, integer, condition):
            raise ValueError(f"there is no operation {op!r}")
        args = tuple(_earlier(nodes, number) for number in arguments)
        if op == "dot":
            table, places = tables[value[0]], value[1]
            nodes.append(sum(table[np.unravel_index(number, table.shape)] * factor
                             for factor, number in zip(args, places, strict=True)))
            continue
        if op in _of_tables:
            value = (tables[value[0]], *value[1:])
        elif op == "symbol":
            kind, name = value
            value = (str(kind), str(name))
        nodes.append(make(op, args, value, type_))
    return [_earlier(nodes, number) for number in plain["roots"]]


def _earlier(nodes: list[Any], number: int) -> Any:
    if not 0 <= number < len(nodes):
        raise ValueError("an expression refers to one that is not there")
    return nodes[number]
