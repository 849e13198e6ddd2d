# SPDX-License-Identifier: MIT
"""How large the whole numbers of `generate` become in a study, and the refusal of numbers that would be cut."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING

from ..base.errors import Error, at
from ..symbolic.node import integer, text, walk
from ..symbolic.whole_and_real import is_long

if TYPE_CHECKING:
    from ..symbolic.node import Node

_most_32 = 2**31 - 1
_most_exact = 2**53  # what double precision and numbers of 64 bits both hold


def check_constants(nodes: Iterable[Node], assigned: Iterable[Node]) -> None:
    """Refuses whole constants that the whole numbers beside them, or what they are assigned to, cannot hold. Those
    beside real numbers are real already."""
    for constant, user in [(a, node) for node in nodes for a in node.args] + [(e, e) for e in assigned]:
        if constant.op != "constant" or constant.type != integer:
            continue
        beside_long = is_long(user)
        most = _most_exact if beside_long else _most_32
        if not -most - 1 <= constant.value <= most:
            raise Error(f"the whole number {constant.value}{at(constant.line)} has more than "
                        f"{53 if beside_long else 32} bits: those of a model are from {-most - 1} to {most}; for a "
                        f"real number write {constant.value}.0, and use an accessory")


def check_whole_numbers(assignments: Sequence[tuple[Node, Node]], instances: int, shared: Mapping[str, int]) -> None:
    """Refuses whole numbers of `generate`, [(target, value)], that a study of so many instances makes too large.
    `shared` has the values of shared integers by name. Whole numbers computed from the instance's number have 64 bits,
    all others, and integer accessories, have 32."""
    known: dict[int, tuple[int, int, bool]] = {}  # by node: the least and the largest value, and whether it has 64 bits
    for node in walk([value for _, value in assignments]):
        if node.type != integer:
            continue
        low, high, is_long = known[id(node)] = _range(node, known, instances, shared)
        most = _most_exact if is_long else _most_32
        if low < -most - 1 or high > most:
            raise Error(f"generate computes `{text(node)}`{at(node.line)}, which is from {low} to {high} in a study of "
                        f"{instances} instances: whole numbers are exact up to {most} there; begin with a real number, "
                        "as in `1.0 * a * b`")
    for target, value in assignments:
        low, high, _ = known.get(id(value), (0, 0, False))
        if target.type == integer and (low < -_most_32 - 1 or high > _most_32):
            raise Error(f"generate gives the whole number {target.value[1]} values from {low} to {high} in a study of "
                        f"{instances} instances, and it has 32 bits: use an accessory")


def _range(node: Node, known: Mapping[int, tuple[int, int, bool]], instances: int,
           shared: Mapping[str, int]) -> tuple[int, int, bool]:
    if node.op == "constant":
        return node.value, node.value, abs(node.value) > _most_32
    if node.op == "symbol":
        if node.value == ("built-in", "instance"):
            return 0, instances - 1, True
        value = shared.get(node.value[1]) if node.value[0] == "shared_integer" else None
        return (-_most_32 - 1, _most_32, False) if value is None else (value, value, False)
    of = [known[id(a)] for a in node.args if a.type == integer]
    (a, b, _), (c, d, _) = of[0], of[-1]
    products = a * c, a * d, b * c, b * d
    largest = max(abs(a), abs(b))
    quotients = [p // q for p in (a, b) for q in (c, d)] if c > 0 or d < 0 else [-largest, largest, 0]
    low, high = {
        "add": (a + c, b + d), "subtract": (a - d, b - c), "min": (min(a, c), min(b, d)),
        "max": (max(a, c), max(b, d)), "multiply": (min(products), max(products)), "select": (min(a, c), max(b, d)),
        "quotient": (min(quotients), max(quotients)),
        "remainder": (min(0, c + 1), min(b, d - 1) if a >= 0 and c > 0 else max(0, d - 1)),
    }[node.op]
    return low, high, any(is_long for _, _, is_long in of)
