# SPDX-License-Identifier: MIT
"""NumPy's functions of expressions and of arrays of them are the library's, which numpy_functions.py names."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ..base.errors import Error, at, users_line

if TYPE_CHECKING:
    from .node import Node

# What stands for NumPy's functions of single numbers, and for its others; numpy_functions.py fills both.
of_ufuncs: dict[Any, Callable[..., Any]] = {}
of_array_functions: dict[Any, Callable[..., Any]] = {}


class NumpyFunctions:
    """NumPy's functions of expressions, and arrays of them, are the library's."""

    __slots__ = ()

    def __array_ufunc__(self, ufunc: np.ufunc, method: str, *inputs: Any, **options: Any) -> Any:
        function = of_ufuncs.get(ufunc)
        if function is None or method != "__call__" or options:
            raise Error(f"numpy.{ufunc.__name__} cannot be applied to expressions of a model{at(users_line())}: use "
                        "the functions of myriad")
        return elementwise(function, *inputs)

    def __array_function__(self, function: Callable[..., Any], types: Iterable[type], args: Iterable[Any],
                           options: Mapping[str, Any]) -> Any:
        if (ours := of_array_functions.get(function)) is not None:
            return ours(*args, **options)
        raise Error(f"numpy.{function.__name__} cannot be applied to expressions of a model{at(users_line())}: use the "
                    "functions of myriad")


class Vector(np.ndarray):
    """An array of expressions: NumPy's functions of it are the library's, element by element."""

    def __array_ufunc__(self, ufunc: np.ufunc, method: str, *inputs: Any, out: Any = None, **options: Any) -> Any:
        function = of_ufuncs.get(ufunc)
        if function is not None and method == "__call__" and not options:
            result = elementwise(function, *inputs)
        elif function is not None and method == "reduce" and ufunc in (np.maximum, np.minimum):
            result = np.frompyfunc(function, 2, 1).reduce(inputs[0].view(np.ndarray), **options)
            result = result.view(Vector) if isinstance(result, np.ndarray) else result
        else:  # sums and products, of which NumPy's work on objects
            plain = [x.view(np.ndarray) if isinstance(x, Vector) else x for x in inputs]
            result = getattr(ufunc, method)(*plain, **options)
            result = result.view(Vector) if isinstance(result, np.ndarray) and result.dtype == object else result
        if out is None:
            return result
        out[0][...] = result
        return out[0]

    def __array_function__(self, function: Callable[..., Any], types: Iterable[type], args: Iterable[Any],
                           options: Mapping[str, Any]) -> Any:
        if (ours := of_array_functions.get(function)) is not None:
            return ours(*args, **options)
        return super().__array_function__(function, types, args, options)


def vector(expressions: Sequence[Node]) -> Vector:
    """A `Vector` of some expressions."""
    made = np.empty(len(expressions), object)
    made[:] = expressions
    return made.view(Vector)


def elementwise(function: Callable[..., Any], *inputs: Any) -> Any:
    """A function of arrays from one of their elements."""
    arrays = []
    for x in inputs:
        if isinstance(x, (list, tuple)):
            x = np.array(x, object)
        if not isinstance(x, np.ndarray):  # np.array(x) might look into it
            array = np.empty((), object)
            array[()] = x
            x = array
        arrays.append(x.view(np.ndarray))
    result = np.frompyfunc(function, len(arrays), 1)(*arrays)
    return result.view(Vector) if isinstance(result, np.ndarray) else result
