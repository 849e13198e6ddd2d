# SPDX-License-Identifier: MIT
"""About what expressions cost."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from .expression import walk

if TYPE_CHECKING:
    from .expression import Node

_instructions = {"pow": 40, "powr": 40, "find_interval": 20, "atan2": 25, "tan": 25, "fmod": 10, "floor_mod": 15,
                 "floor_divide": 20,
                 **dict.fromkeys(("sin", "cos", "sinpi", "cospi", "exp", "exp2", "expm1", "log", "log1p", "log2",
                                  "log10", "cbrt", "asin", "acos", "atan", "sinh", "cosh", "tanh", "hypot"), 15),
                 **dict.fromkeys(("sincos.sine", "sincos.cosine", "sincospi.sine", "sincospi.cosine"), 10)}


def work(roots: Iterable[Node]) -> int:
    """About how many instructions compute some expressions."""
    return sum(2 * len(n.args) if n.op == "dot" else _instructions.get(n.op, 1) for n in walk(roots) if n.args)
