# SPDX-License-Identifier: MIT
"""Values along an axis that are not stored one by one, and values drawn at random: for sweeps of studies, and where
arrays may be given."""

from __future__ import annotations

from typing import Any, NoReturn

import numpy as np

from . import _core
from .errors import Error

__all__ = ["linspace", "logspace", "random_uniform", "random_normal"]


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
        raise Error(f"{self!r} is drawn for each instance of a study: use it in myriad.study, or give an array of "
                    "NumPy's random numbers")


def linspace(first: float, last: float, size: int) -> Axis:
    """`size` evenly spaced values from `first` to `last`, both included, as numpy.linspace."""
    return Axis("linspace", first, last, size)


def logspace(first: float, last: float, size: int) -> Axis:
    """`size` values from `first` to `last`, both included, with a constant ratio between neighbours, as
    numpy.geomspace."""
    return Axis("logspace", first, last, size)


def random_uniform(low: float, high: float) -> Random:
    """A random value for each instance of a study, evenly distributed between two bounds."""
    return Random("random_uniform", low, high)


def random_normal(mean: float, deviation: float) -> Random:
    """A random value for each instance of a study, normally distributed with that standard deviation."""
    return Random("random_normal", mean, deviation)
