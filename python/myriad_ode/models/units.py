# SPDX-License-Identifier: MIT
"""Coupled units: components that every one of many units has, as arrays over the units, and couplings by matrices."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ..base.errors import Error, at, users_line
from ..symbolic import symbols as sym
from ..symbolic.expression import as_number, make, to_real
from ..symbolic.node import Node, integer, real
from ..symbolic.vectors import Vector, vector
from ..symbolic.numbers import as_numbers, is_whole
from ..symbolic.table import Table
from .event import Event, Summary, event

if TYPE_CHECKING:
    import numpy.typing as npt

    from ..symbolic.types import ByComponent, Direction, Names

__all__ = ["units", "Units", "UnitVector", "Coupling"]


class UnitVector(Vector):
    """A component of all units: `x[i]` is that of unit i. It may be a key of a model's equations and assignments, with
    an array of one value for each unit, or with one value for all."""

    units: Units  # of components as they were made, not of parts of them

    def __hash__(self) -> int:  # type: ignore[override]
        return id(self)


def units(count: int, *, threads_per_instance: int | None = None) -> Units:
    """`count` units that are alike: `ring = my.units(14)`, `x, v = ring.states("x v")`. On a GPU, so many threads
    integrate an instance together, a power of two up to 256; without a number as many as suit the number of states."""
    if not is_whole(count, 1):
        raise Error(f"there are {count!r} units{at(users_line())}: give their number, as in my.units(14)")
    if threads_per_instance is not None and not (
            is_whole(threads_per_instance, 1, 256) and int(threads_per_instance).bit_count() == 1):
        raise Error(f"threads_per_instance is {threads_per_instance!r}{at(users_line())}: give a power of two "
                    "from 1 to 256, or leave it out")
    return Units(int(count), threads_per_instance)


class Units:
    """Units that are alike, and what each of them has. Their components are arrays over the units; those of unit 3 of
    the states "x v" are called x_3 and v_3."""

    def __init__(self, count: int, threads_per_instance: int | None = None) -> None:
        self.count, self.threads_per_instance = count, threads_per_instance

    def __len__(self) -> int:
        return self.count

    def __repr__(self) -> str:
        return f"<{self.count} units>"

    def _of_each(self, kind: str, name: Any, type: str = real) -> UnitVector:
        sym.check_name(name, sym.a(kind))
        made = vector([sym.symbol(kind, f"{name}_{i}", type) for i in range(self.count)]).view(UnitVector)
        made.units = self
        return made

    def _several(self, kind: str, names: Names) -> tuple[UnitVector, ...]:
        return tuple(self._of_each(kind, name) for name in sym.names(names))

    def states(self, names: Names) -> tuple[UnitVector, ...]:
        """The unknowns of each unit; always a tuple."""
        return self._several("state", names)

    def state(self, name: str) -> UnitVector:
        """One unknown of each unit."""
        return self._of_each("state", name)

    def parameters(self, names: Names) -> tuple[UnitVector, ...]:
        """Several numbers with one value per instance and unit, as a tuple."""
        return self._several("parameter", names)

    def parameter(self, name: str) -> UnitVector:
        """A number with one value per instance and unit."""
        return self._of_each("parameter", name)

    def shared(self, name: str) -> UnitVector:
        """A number with one value per unit, the same for all instances."""
        return self._of_each("shared", name)

    def accessory(self, name: str) -> UnitVector:
        """A real number that the model stores by instance and unit."""
        return self._of_each("accessory", name)

    def integer_accessory(self, name: str) -> UnitVector:
        """A whole number that the model stores by instance and unit."""
        return self._of_each("integer_accessory", name, integer)

    def events(self, functions: Any, *, name: str, do: Callable[[int], ByComponent] | None = None,
               direction: Direction = "either", tolerance: float | None = None, stop_after: int = 0) -> list[Event]:
        """An event of each unit: `functions` is an array of their functions; `do` gives the assignments at the event of
        a unit by its number, which may be about all units: `do=lambda i: {v[i]: -r * v[i]}`. The rest is as in
        `my.event`."""
        found = self._one_each(functions, f"the events {name}")
        return [event(found[i], name=f"{name}_{i}", direction=direction, tolerance=tolerance, stop_after=stop_after,
                      do=None if do is None else do(i)) for i in range(self.count)]

    def _one_each(self, values: Any, what: str) -> list[Any]:
        shape = np.shape(values) if isinstance(values, np.ndarray) else (len(values),) if isinstance(
            values, (list, tuple)) else ()
        if shape != (self.count,):
            raise Error(f"{what} have shape {shape}{at(users_line())}: give one for each of the {self.count} units")
        return list(values)

    def full_coupling(self, name: str, matrix: npt.ArrayLike) -> Coupling:
        """A coupling by any matrix: `(A @ x)[i]` is the sum of `matrix[i, j] * x[j]` over all units."""
        return Coupling(name, self._square(name, matrix), "full")

    def banded_coupling(self, name: str, matrix: npt.ArrayLike, bandwidth: int) -> Coupling:
        """A coupling by a matrix whose entries are zero but on the diagonal and on `bandwidth` diagonals on either side
        of it."""
        array = self._square(name, matrix)
        self._check_bandwidth(name, bandwidth, self.count - 1)
        place = np.argwhere((array != 0) & (np.abs(np.subtract.outer(*2 * (np.arange(self.count),))) > bandwidth))
        if len(place):
            i, j = place[0]
            raise Error(f"entry ({i}, {j}) of the coupling {name} is {array[i, j]}, outside the band of {bandwidth} "
                        f"diagonals on either side{at(users_line())}: give a larger bandwidth")
        return Coupling(name, array, "banded", bandwidth)

    def circulant_coupling(self, name: str, matrix: npt.ArrayLike, bandwidth: int | None = None) -> Coupling:
        """A coupling by a matrix of which every row is the one above it, moved by one place to the right, round the
        end: a ring, in which all units are coupled alike. With `bandwidth`, a unit is coupled to that many neighbours
        on either side."""
        array = self._square(name, matrix)
        n = self.count
        round_the_end = np.stack([np.roll(array[0], i) for i in range(n)])
        if len(place := np.argwhere(array != round_the_end)):
            i, j = place[0]
            raise Error(f"the coupling {name} is not circulant: entry ({i}, {j}) is {array[i, j]}, but "
                        f"{round_the_end[i, j]} in row 0{at(users_line())}: make every row the one above it, moved by "
                        "one place, or give it to full_coupling")
        if bandwidth is None:
            return Coupling(name, array, "circulant")
        self._check_bandwidth(name, bandwidth, (n - 1) // 2)
        beyond = [j for j in range(n) if array[0, j] != 0 and min(j, n - j) > bandwidth]
        if beyond:
            raise Error(f"entry (0, {beyond[0]}) of the coupling {name} is {array[0, beyond[0]]}, outside the band of "
                        f"{bandwidth} diagonals on either side{at(users_line())}: give a larger bandwidth")
        return Coupling(name, array, "circulant", bandwidth)

    def _square(self, name: str, matrix: Any) -> Any:
        sym.check_name(name, "a coupling")
        array = as_numbers(matrix)
        if array.dtype.kind not in "biuf":
            raise Error(f"the coupling {name} has values of type {array.dtype}{at(users_line())}: give real numbers")
        if array.ndim != 2 or array.shape[0] != array.shape[1]:
            raise Error(f"the coupling {name} is not square, but has shape {array.shape}{at(users_line())}: give it a "
                        f"row and a column for each of the {self.count} units")
        if len(array) != self.count:
            raise Error(f"the coupling {name} has {len(array)} rows, but there are {self.count} units"
                        f"{at(users_line())}: give it a row and a column for each")
        if not np.isfinite(array).all():
            raise Error(f"the coupling {name} has entries that are not finite{at(users_line())}: check how it was "
                        "computed")
        return np.array(array, float)

    @staticmethod
    def _check_bandwidth(name: str, bandwidth: Any, most: int) -> None:
        if not is_whole(bandwidth, 0, most):
            raise Error(f"the bandwidth of the coupling {name} is {bandwidth!r}{at(users_line())}: give a whole number "
                        f"from 0 to {most}")


class CouplingTable(Table):
    """The matrix of a coupling of `count` units. Its form is "full", "banded" or "circulant", with `bandwidth`
    diagonals on either side of the main one, or all if it is None. Its elements are the entries of such a coupling in
    C++, in the same order."""

    def __init__(self, name: str, matrix: Any, form: str, bandwidth: int | None) -> None:
        self.form, self.bandwidth, self.count = form, bandwidth, len(matrix)
        self._diagonals = range(self.count) if bandwidth is None else range(-bandwidth, bandwidth + 1)
        if form == "full":
            entries = matrix.T  # column by column, so that the entries of neighbouring rows lie side by side
        else:
            rows = range(1 if form == "circulant" else self.count)
            entries = np.array([[matrix[i, (i + d) % self.count] if self._has(i, d) else 0.0 for i in rows]
                                for d in self._diagonals])
        super().__init__(name, entries.ravel())
        self._key = (*self._key, form, bandwidth)

    def _has(self, row: int, diagonal: int) -> bool:
        return self.form != "banded" or 0 <= row + diagonal < self.count

    def columns(self, row: int) -> list[int]:
        """The units over which the sum of that row goes, in its order."""
        first = 0 if self.form == "full" else row
        return [(first + d) % self.count for d in self._diagonals if self._has(row, d)]

    def places(self, row: int) -> list[int]:
        if self.form == "circulant":
            return list(range(len(self._diagonals)))
        return [k * self.count + row for k, d in enumerate(self._diagonals) if self._has(row, d)]

    def element_name(self, number: int) -> str:
        k, row = (number, 0) if self.form == "circulant" else divmod(number, self.count)
        column = self._diagonals[k] + (0 if self.form == "full" else row)
        return f"{self.name}[{row},{column % self.count if self.form == 'circulant' else column}]"

    def by_column(self, row: int, values: Sequence[Any]) -> list[Any]:
        """What a row without a band sums, in the order of the units."""
        return [value for _, value in sorted(zip(self.columns(row), values), key=lambda pair: pair[0])]


class Coupling:
    """A coupling of units by a matrix, whose entries all instances share: `A @ x` are its sums."""

    __array_ufunc__ = None  # array @ coupling is refused, and not left to NumPy

    def __init__(self, name: str, matrix: Any, form: str, bandwidth: int | None = None) -> None:
        self.name, self.matrix = name, matrix
        self._table = CouplingTable(name, matrix, form, bandwidth)

    def __repr__(self) -> str:
        return f"<coupling {self.name} of {len(self.matrix)} units>"

    def __matmul__(self, values: Any) -> Any:
        values = np.asarray(values, dtype=object)
        if values.shape != (len(self.matrix),):
            raise Error(f"the coupling {self.name} sums values of shape {values.shape}{at(users_line())}: give one for "
                        f"each of the {len(self.matrix)} units")
        summed = [to_real(as_number(value)) for value in values]
        return vector([make("dot", tuple(summed[j] for j in self._table.columns(row)), (self._table, row))
                       for row in range(len(summed))])


def one_by_one(chosen: Iterable[Any]) -> list[Any]:
    """Chosen components with those of all units one by one."""
    return [one for key in chosen for one in (key if isinstance(key, UnitVector) else [key])]


def only_units(equations: Mapping[Any, Any]) -> Units | None:
    """The units whose states have these equations; None if other states have equations too."""
    all_units = {getattr(key, "units", None) if isinstance(key, UnitVector) else None for key in equations}
    return all_units.pop() if len(all_units) == 1 else None


def of_units(names: Iterable[str], count: int) -> list[str]:
    """The names without number of components that each of so many units has."""
    names = set(names)
    bases = sorted({name.removesuffix("_0") for name in names if name.endswith("_0")})
    return [base for base in bases if all(f"{base}_{i}" in names for i in range(count))]


def together(names: Iterable[str], count: int) -> list[str]:
    """The same names, with components that each of so many units has one behind the other."""
    names = list(names)
    first = {f"{base}_{i}": f"{base}_0" for base in of_units(names, count) for i in range(count)}
    every = {base: [name for name in first if first[name] == base] for base in first.values()}
    return list(dict.fromkeys(one for name in names for one in every.get(first.get(name, ""), [name])))


def unit_by_unit(names: Iterable[str], count: int) -> list[str]:
    """The same names in another order: those of the system, then those of each of `count` units, unit by unit."""
    names = list(names)
    those = {f"{base}_{i}" for base in of_units(names, count) for i in range(count)}
    of_each = [name for name in together(names, count) if name in those]
    return [*(name for name in names if name not in those), *(
        name for i in range(count) for name in of_each[i::count])]


def spread(given: Mapping[Any, Any], what: str, line: tuple[str, int] | None) -> dict[Any, Any]:
    """Equations, assignments or values by component, with those of all units one by one."""
    made: dict[Any, Any] = {}

    def add(key: Any, value: Any) -> None:
        if isinstance(key, Node) and key in made:
            raise Error(f"{key.value[1]} stands in {what} twice{at(line)}: as a component of all units, and alone")
        made[key] = value

    for key, value in given.items():
        if not isinstance(key, UnitVector):
            add(key, value)
            continue
        values = value.quantity if isinstance(value, Summary) else value
        several = isinstance(values, (list, tuple))
        shape = (len(values),) if several else values.shape if isinstance(values, np.ndarray) else ()
        if shape[:1] not in ((), key.shape):
            raise Error(f"{what} has values of shape {shape} for {key[0].value[1]} to {key[-1].value[1]}{at(line)}: "
                        f"give one for each of the {len(key)} units, or one for all")
        for i, component in enumerate(key):
            one = values[i] if shape else values
            if isinstance(value, Summary):
                summary = Summary(value.kind, one)
                summary.line = value.line
                one = summary
            add(component, one)
    return made
