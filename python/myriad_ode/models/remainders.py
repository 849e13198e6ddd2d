# SPDX-License-Identifier: MIT
"""Where a remainder equals a number, as in fmod(t, 12) == 3, by a function that crosses zero there and nowhere else.

A remainder less this number crosses zero at its jumps too, and only touches zero where the number is zero. The sine of
what is divided, in half periods from the number, crosses zero at each instant at which they are equal.
"""

from __future__ import annotations

import math
from typing import Any

from ..symbolic import expression as ex, functions as fn
from ..symbolic.folding import apply, both, compare, constant, divide, either, multiply, subtract

def equality(left: Any, right: Any) -> Any:
    """A condition that holds where a remainder equals something: `sin(...) == 0`, and that it can be equal; None if no
    side is a remainder."""
    for one, other in ((left, right), (right, left)):
        found = _remainder(one)
        if found is not None:
            has_sign_of_dividend, of, by = found
            turns = divide(subtract(of, other), by)
            wave = apply(fn.sin, multiply(constant(math.pi), turns))
            is_possible = _as_dividend(of, by, other) if has_sign_of_dividend else _as_divisor(by, other)
            return both(compare("equal", wave, constant(0.0)), is_possible)
    return None


def _remainder(node: Any) -> tuple[bool, Any, Any] | None:
    """Whether a remainder has the sign of what is divided, instead of the divisor's, what is divided, and by what: of
    fmod, floor_mod, and a difference as t - 12 * floor(t / 12)."""
    if node.op in ("fmod", "floor_mod"):
        return node.op == "fmod", *node.args
    if node.op == "subtract" and node.args[1].op == "multiply":
        of, product = node.args
        for by, whole in (product.args, product.args[::-1]):
            if whole.op == "floor" and divide(of, by) is whole.args[0]:
                return False, of, by
    return None


def _as_divisor(by: Any, value: Any) -> Any:
    """Whether a value lies between zero and the divisor."""
    zero = constant(0.0)
    return either(both(compare("greater_equal", value, zero), compare("less", value, by)),
                  both(compare("less_equal", value, zero), compare("greater", value, by)))


def _as_dividend(of: Any, by: Any, value: Any) -> Any:
    """Whether a value has the sign of what is divided, if it is not zero, and is smaller than the divisor."""
    zero = constant(0.0)
    is_small = compare("less", apply(ex.abs, value), apply(ex.abs, by))
    positive = both(compare("greater", value, zero), compare("greater", of, zero))
    negative = both(compare("less", value, zero), compare("less", of, zero))
    return both(is_small, either(compare("equal", value, zero), either(positive, negative)))
