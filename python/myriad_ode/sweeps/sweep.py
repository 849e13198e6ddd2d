# SPDX-License-Identifier: MIT
"""Sweeps by name: which value each instance has. A grid has an instance for every combination of the values of its
axes, the last one varying fastest; a zip takes the values of equally long arrays together.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from ..base.errors import Error, at, refuse_masked, users_line
from ..symbolic.axes import Axis, drawn
from ..symbolic.expression import is_sympy
from ..symbolic.node import Node
from ..symbolic.numbers import as_numbers
from ..symbolic.read_text import sympy_name

if TYPE_CHECKING:
    import numpy.typing as npt

    from ..symbolic.types import Array, Component, Values

__all__ = ["grid", "zip", "Sweep"]


def _name(key: Component, line: tuple[str, int] | None) -> str:
    if isinstance(key, Node) and key.op == "symbol" and key.value[0] not in ("action", "event_count"):
        return key.value[1]
    if isinstance(key, str):
        return key
    if is_sympy(key):
        return sympy_name(key)
    raise Error(f"{key!r} names nothing to sweep over{at(line)}: use a symbol, as from my.parameter, or its name")


def _numbers(name: str, values: Values, line: tuple[str, int] | None) -> Array | Axis:
    """Values as an array of whole numbers or of double precision, without NaN; axes of studies as they are."""
    values = drawn(values)
    if isinstance(values, Axis):
        return values
    if isinstance(values, Node):
        raise Error(f"the values of {name} are the expression `{values}`{at(line)}: give it to my.study in a dict, not "
                    "in a grid")
    refuse_masked(values, name)
    try:
        array = as_numbers(values)
        if array.dtype.kind == "c":
            raise Error(f"the values of {name} are complex{at(line)}: a model is real")
        array = array.astype(np.int64 if array.dtype.kind in "iub" else float, copy=False)
    except (TypeError, ValueError) as error:
        if isinstance(error, Error):
            raise
        raise Error(f"the values of {name} are no numbers{at(line)}: {error}") from None
    if np.isnan(array).any():
        where = np.flatnonzero(np.isnan(array.ravel()))
        raise Error(f"{name} is NaN in {where.size} of {array.size} values, first at index {where[0]}{at(line)}: every "
                    "instance needs a number")
    return array


class Sweep:
    """The values of all instances, by name.

    `axes` is a list of (name, values), `shape` has their lengths: instance i is at numpy.unravel_index(i, shape).
    `names` are all that have values, `values(name)` one per instance; `coordinates` {name: (axis, values)} are the
    names whose values go along one axis, `constants` {name: value} those that are equal for all instances.
    """

    def __init__(self, axes: list[tuple[str, Any]], coordinates: dict[str, tuple[str, Any]],
                 constants: dict[str, Any]) -> None:
        self.axes, self.coordinates, self.constants = axes, coordinates, constants
        self.shape = tuple(len(values) for _, values in axes)
        self.size = math.prod(self.shape)
        if self.size >= 1 << 62:
            raise Error(f"the sweep has {self.size} instances{at(users_line())}, and numbers of instances end at 2^62: "
                        "make its axes shorter")
        self.names = [*coordinates, *constants]

    def values(self, name: str) -> Array:
        """One value per instance, as an array of length `size`."""
        if name in self.constants:
            return np.full(self.size, np.asarray(self.constants[name]))
        if name not in self.coordinates:
            raise Error(f"the sweep has no values of '{name}'{at(users_line())}: it has "
                        f"{', '.join(self.names) or 'none'}")
        axis, values = self.coordinates[name]
        place = [a for a, _ in self.axes].index(axis)
        shape = [1] * len(self.axes)
        shape[place] = len(values)
        return np.ascontiguousarray(np.broadcast_to(np.asarray(values).reshape(shape), self.shape)).reshape(self.size)

    def along(self, name: str) -> tuple[Array, int]:
        """The values of a name along its axis, and how many instances in a row have each: instance i has
        `values[i // repeat % len(values)]`."""
        axis, values = self.coordinates[name]
        place = [a for a, _ in self.axes].index(axis)
        return np.asarray(values), math.prod(self.shape[place + 1:])

    def unstack(self, values: npt.ArrayLike) -> Array:
        """An array with a row per instance as one with the axes of the sweep: (size, ...) to shape + (...)."""
        values = np.asarray(values)
        if values.shape[:1] != (self.size,):
            raise Error(f"an array of shape {values.shape}{at(users_line())} has no row for each of {self.size} "
                        "instances: give one")
        return values.reshape(self.shape + values.shape[1:])

    def __len__(self) -> int:
        return self.size

    def __repr__(self) -> str:
        along = " x ".join(f"{name} ({len(values)})" for name, values in self.axes)
        fixed = ", ".join(f"{n} = {v}" for n, v in self.constants.items())
        return f"<sweep of {self.size} instances: {along or 'one'}{', ' + fixed if fixed else ''}>"


def _collect(mapping: Mapping[Any, Any] | None, named: Mapping[str, Any],
             line: tuple[str, int] | None) -> dict[str, Any]:
    given = {}
    for key, values in [*(mapping or {}).items(), *named.items()]:
        name = _name(key, line)
        if name in given:
            raise Error(f"'{name}' is given twice{at(line)}: give it one set of values")
        given[name] = values if isinstance(values, Sweep) else _numbers(name, values, line)
    return given


def refuse_others(sweep: Any) -> None:
    """Refuses what is no sweep."""
    if sweep is not None and not isinstance(sweep, Sweep) and not hasattr(sweep, "items"):
        raise Error(f"the sweep is a {type(sweep).__name__}: give a dict, as in {{k: np.linspace(0, 1, 100)}}, or "
                    "my.grid(k=..., B=...)")


def with_paths(sweep: Any, count: int) -> Sweep:
    """A sweep with a last axis of so many paths of each instance."""
    refuse_others(sweep)
    made = sweep if isinstance(sweep, Sweep) else zip(sweep)
    if "path" in [*made.names, *(name for name, _ in made.axes)]:
        raise Error("'path' is in the sweep, and the axis of paths= has that name: rename the component")
    return Sweep([*made.axes, ("path", np.arange(count))], made.coordinates, made.constants)


def grid(*parts: Sweep | Mapping[Any, Any], **axes: Values) -> Sweep:
    """All combinations of the values of several axes: `grid(k=np.linspace(0.2, 0.3, 100), B=[0.3, 0.4])`, or with
    symbols `grid({k: ..., B: ...})`. The last axis varies fastest. A single number is a value for all instances.
    Sweeps, as from `zip`, may be among the parts: their axes come first, in order."""
    line = users_line()
    made_axes: list[tuple[str, Any]] = []
    coordinates: dict[str, tuple[str, Any]] = {}
    constants: dict[str, Any] = {}

    def add(new_axes: list[tuple[str, Any]], new_coordinates: dict[str, tuple[str, Any]],
            new_constants: dict[str, Any]) -> None:
        for name in [*new_coordinates, *new_constants, *(a for a, _ in new_axes if a not in new_coordinates)]:
            if name in coordinates or name in constants or name in [a for a, _ in made_axes]:
                raise Error(f"'{name}' is on two axes of the grid{at(line)}: give it one set of values")
        made_axes.extend(new_axes)
        coordinates.update(new_coordinates)
        constants.update(new_constants)

    for part in [*parts, axes]:
        if isinstance(part, Sweep):
            add(part.axes, part.coordinates, part.constants)
            continue
        if not isinstance(part, dict):
            raise Error(f"{type(part).__name__} is no part of a grid{at(line)}: give a dictionary {{name: values}}, "
                        "names with values, or a sweep")
        for name, values in _collect(part, {}, line).items():
            if values.ndim == 0:
                add([], {}, {name: values.item()})
            elif values.ndim > 1:
                raise Error(f"{name} has values of shape {values.shape}{at(line)}: an axis of a grid is a list of "
                            "numbers")
            else:
                add([(name, values)], {name: (name, values)}, {})
    return Sweep(made_axes, coordinates, constants)


def zip(mapping: Mapping[Any, Any] | None = None, **arrays: Values) -> Sweep:
    """The values of equally long arrays together: instance i has the i-th of each. Single numbers are for all."""
    line = users_line()
    given = _collect(mapping, arrays, line)
    constants = {n: v.item() for n, v in given.items() if v.ndim == 0}
    along = {n: v for n, v in given.items() if v.ndim > 0}
    for name, values in along.items():
        if values.ndim > 1:
            raise Error(f"{name} has values of shape {values.shape}{at(line)}: give one number per instance, in one "
                        "dimension")
    lengths = {n: len(v) for n, v in along.items()}
    if len(set(lengths.values())) > 1:
        listed = ", ".join(f"{n} has {length}" for n, length in lengths.items())
        raise Error(f"the numbers of values differ: {listed}{at(line)}: give each one value per instance, or all "
                    "combinations by my.grid")
    if not along:
        return Sweep([], {}, constants)
    if len(along) == 1:
        (name, values), = along.items()
        return Sweep([(name, values)], {name: (name, values)}, constants)
    axis = "instance"
    return Sweep([(axis, np.arange(next(iter(lengths.values()))))], {n: (axis, v) for n, v in along.items()}, constants)
