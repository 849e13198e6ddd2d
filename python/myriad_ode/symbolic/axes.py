# SPDX-License-Identifier: MIT
"""Values along an axis that are not stored one by one, and values drawn at random: for sweeps of studies, and where
arrays may be given."""

from __future__ import annotations

from typing import Any, NoReturn

import numpy as np

from .. import _core
from ..base.errors import Error, at, users_line
from .functions import draws
from .node import Node

__all__ = ["linspace", "geomspace"]


class Axis:
    """Values by the function that makes them."""

    ndim = 1

    def __init__(self, kind: str, *arguments: Any) -> None:
        self.kind, self.arguments = kind, tuple(arguments)
        self.core()  # which checks them

    def core(self) -> _core.AxisValues:
        """The axis for the core."""
        try:
            return getattr(_core, self.kind)(*self.arguments)
        except TypeError:
            raise Error(f"{self!r} is no axis: give two real numbers and, unless they are random, a whole number of "
                        "values") from None

    @property
    def size(self) -> int:
        """The number of values."""
        return len(self)

    def __len__(self) -> int:
        return len(self.core())

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> np.ndarray:
        return np.asarray(self.core().array(), dtype)

    def __repr__(self) -> str:
        return f"{self.kind}({', '.join(map(repr, self.arguments))})"

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Axis) and (self.kind, self.arguments) == (other.kind, other.arguments)

    def __hash__(self) -> int:
        return hash((self.kind, self.arguments))


class Random(Axis):
    """A value for each instance, drawn by the core from the study's seed and the instance's number."""

    ndim = 0

    def item(self) -> Random:
        """Itself: what a sweep has for all instances."""
        return self

    def __len__(self) -> int:
        raise TypeError(f"{self!r} has no length: it gives each instance a value")

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> NoReturn:
        raise Error(f"{self!r} is drawn for each instance of a study: use it in my.study, or give an array of "
                    "NumPy's random numbers")


def linspace(first: float, last: float, size: int) -> Axis:
    """`size` evenly spaced values from `first` to `last`, both included, as numpy.linspace."""
    return Axis("linspace", first, last, size)


def geomspace(first: float, last: float, size: int) -> Axis:
    """`size` values from `first` to `last`, both included, with a constant ratio between neighbours, as
    numpy.geomspace."""
    return Axis("geomspace", first, last, size)


def drawn(value: Any) -> Any:
    """A call of `uniform` or `normal` as what it is in a sweep, `Random`; anything else as it is."""
    if not isinstance(value, Node) or value.op not in draws:
        return value
    if any(bound.op != "constant" for bound in value.args):
        raise Error(f"`{value}` is drawn between bounds that differ{at(users_line())}: give it to my.study in a dict, "
                    "or give numbers")
    return Random(value.op, *(float(bound.value) for bound in value.args))
