# SPDX-License-Identifier: MIT
"""Values along an axis that are not stored one by one, and values drawn at random: for sweeps of studies, and where
arrays may be given."""

import numpy as np

from . import _core
from .errors import Error, at, users_line
from .expression import Node, draws

__all__ = ["linspace", "geomspace"]


class Axis:
    """Values by the function that makes them."""

    ndim = 1

    def __init__(self, kind, *arguments):
        self.kind, self.arguments = kind, tuple(arguments)
        self.core()  # which checks them

    def core(self):
        """The axis for the core."""
        try:
            return getattr(_core, self.kind)(*self.arguments)
        except TypeError:
            raise Error(f"{self!r} is no axis: give two real numbers and, unless they are random, a whole number of "
                        "values") from None

    @property
    def size(self):
        """The number of values."""
        return len(self)

    def __len__(self):
        return len(self.core())

    def __array__(self, dtype=None, copy=None):
        return np.asarray(self.core().array(), dtype)

    def __repr__(self):
        return f"{self.kind}({', '.join(map(repr, self.arguments))})"

    def __eq__(self, other):
        return isinstance(other, Axis) and (self.kind, self.arguments) == (other.kind, other.arguments)

    def __hash__(self):
        return hash((self.kind, self.arguments))


class Random(Axis):
    """A value for each instance, drawn by the core from the study's seed and the instance's number."""

    ndim = 0

    def item(self):
        """Itself: what a sweep has for all instances."""
        return self

    def __len__(self):
        raise TypeError(f"{self!r} has no length: it gives each instance a value")

    def __array__(self, dtype=None, copy=None):
        raise Error(f"{self!r} is drawn for each instance of a study: use it in myriad.study, or give an array of "
                    "NumPy's random numbers")


def linspace(first, last, size):
    """`size` evenly spaced values from `first` to `last`, both included, as numpy.linspace."""
    return Axis("linspace", first, last, size)


def geomspace(first, last, size):
    """`size` values from `first` to `last`, both included, with a constant ratio between neighbours, as
    numpy.geomspace."""
    return Axis("geomspace", first, last, size)


def drawn(value):
    """A call of `uniform` or `normal` as what it is in a sweep, `Random`; anything else as it is."""
    if not isinstance(value, Node) or value.op not in draws:
        return value
    if any(bound.op != "constant" for bound in value.args):
        raise Error(f"`{value}` is given in a sweep{at(users_line())}: give numbers, or draw it in generate= of the "
                    "model")
    return Random(value.op, *(float(bound.value) for bound in value.args))
