# SPDX-License-Identifier: MIT
"""Types of arguments, for type checkers."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any, Literal, Union

import numpy as np
import numpy.typing as npt

from .expression import Expression
from .node import Node

# A component: a symbol, as from `my.states`, or its name. Those of SymPy will do, and a mapping with keys of one
# kind is none with keys of several, so that it may be anything for a type checker.
Component = Any
# One or several.
SomeComponents = Union[Expression, str, Iterable[Any]]
# The same, or text.
Written = Union[Expression, float, str, Any]
# A number, an array of NumPy's or what it takes, an axis, or an array on a GPU.
Values = Union[npt.ArrayLike, Any]
# Values by component.
ByComponent = Mapping[Any, Any]
# One for all states, one for each, or values by state.
Tolerance = Union[float, Sequence[float], npt.NDArray[np.floating[Any]], Mapping[Any, float]]


class NotGiven(float):
    """A default, which is told from the same number of a call."""


# True for a bar, or a function of the numbers of instances done and of all.
Progress = Union[bool, Callable[[int, int], object], None]
# Names, as "x v" or in a list, or symbols.
Names = Union[str, Expression, Iterable[Any]]
# What a hook or an event of a model sets: targets, and the values that they get.
Assignments = list[tuple[Node, Node]]
Path = Union[str, "os.PathLike[str]"]
Array = npt.NDArray[Any]
Direction = Literal["falling", "either", "rising", "none"]
Precision = Literal["double", "float"]
