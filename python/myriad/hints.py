# SPDX-License-Identifier: MIT
"""Types of arguments, for type checkers."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any, Union

import numpy.typing as npt

from .expression import Node

# A symbol, as from `myriad.states`, or its name. Keys of mappings are any, since those of SymPy will do, and a mapping
# with keys of one kind is none with keys of several.
Component = Any
# One or several.
Components = Union[Node, str, Iterable[Union[Node, str]]]
# A number, an array of NumPy's or what it takes, an axis, or an array on a GPU.
Values = Union[npt.ArrayLike, Any]
# Values by component.
ByComponent = Mapping[Any, Any]
# One for all states, one for each, or those of some states.
Tolerance = Union[float, Sequence[float], npt.ArrayLike, Mapping[Any, float]]
# True for a bar, or a function of the numbers of instances done and of all.
Progress = Union[bool, Callable[[int, int], object], None]
