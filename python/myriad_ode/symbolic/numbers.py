# SPDX-License-Identifier: MIT
"""Numbers as users give them."""

from __future__ import annotations

import decimal
import math
import numbers
from typing import TYPE_CHECKING, Any

import numpy as np

from ..base.errors import Error, at, users_line
from .axes import drawn

if TYPE_CHECKING:
    from .types import Array


def as_numbers(values: Any) -> Array:
    """What users give as numbers, as an array; also objects that are real numbers, as in `fractions`."""
    try:
        array = np.asarray(drawn(values))
    except ValueError as why:  # lists of different lengths
        raise Error(f"{values!r} is no array{at(users_line())}: {why}") from None
    if array.dtype == object and all(isinstance(x, (numbers.Real, decimal.Decimal)) for x in array.flat):
        try:
            array = array.astype(float)
        except OverflowError:
            raise Error(f"a value is too large for double precision{at(users_line())}: give numbers up to 1.8e308"
                        ) from None
    return array


def is_whole(value: object, least: int, largest: float = math.inf) -> bool:
    """Whether it is a whole number between two; truth values are none."""
    return isinstance(value, (int, np.integer)) and not isinstance(value, bool) and least <= int(value) <= largest
