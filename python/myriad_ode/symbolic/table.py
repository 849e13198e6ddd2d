# SPDX-License-Identifier: MIT
"""Tables: NumPy arrays that all instances share, as coefficients of a model's equations."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any, NoReturn

import numpy as np

from ..base.errors import Error, at, refuse_masked, users_line
from .expression import as_number, make, to_real
from .numbers import as_numbers
from .node import walk
from .symbols import check_name

if TYPE_CHECKING:
    import numpy.typing as npt

    from .expression import Expression
    from .node import Node

__all__ = ["table"]

unrolled = 8  # vectors up to this length are multiplied term by term in the generated code


def table(name: str, values: npt.ArrayLike) -> Table:
    """An array of one or two dimensions whose values all instances share: `A = my.table("A", array)`. `A[i, j]` is
    an element and `A @ vector` the product with a vector of expressions, an array of expressions. Generated code names
    its values and does not contain them, so that models with other values need not be compiled again."""
    return Table(check_name(name, "a table"), values)


class Table:
    """An array that all instances share."""

    __array_ufunc__ = None  # array @ table is refused by __rmatmul__, and not by NumPy

    def __init__(self, name: str, values: Any) -> None:
        self.name, self.line = name, users_line()
        refuse_masked(values, f"the table {name}")
        array = as_numbers(values)
        if array.dtype.kind not in "biuf":
            raise Error(f"the table {name} has values of type {array.dtype}{at(self.line)}: give real numbers")
        if array.ndim not in (1, 2) or not array.size:
            raise Error(f"the table {name} has shape {array.shape}{at(self.line)}: give an array of one or two "
                        "dimensions")
        if np.isnan(array).any():
            raise Error(f"the table {name} contains NaN{at(self.line)}: check how it was computed")
        self.values = np.array(array, float)
        self.values.setflags(write=False)
        self.shape = self.values.shape
        self._key: tuple[Any, ...] = (name, self.shape, hashlib.sha256(self.values.tobytes()).hexdigest())

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Table) and self._key == other._key

    def __hash__(self) -> int:
        return hash(self._key)

    def __repr__(self) -> str:
        return f"<table {self.name} of shape {self.shape}>"

    def __len__(self) -> int:
        return self.shape[0]

    def __getitem__(self, place: Any) -> Any:
        try:
            chosen = np.arange(self.values.size).reshape(self.shape)[place]
        except (IndexError, TypeError):
            raise Error(f"{self.name}[{place!r}] is no element of a table of shape {self.shape}{at(users_line())}: "
                        "index it with whole numbers from 0") from None
        if np.ndim(chosen) == 0:
            return self._element(int(chosen))
        elements = np.empty(chosen.shape, object)
        for i in np.ndindex(chosen.shape):
            elements[i] = self._element(int(chosen[i]))
        return elements

    def _element(self, number: int) -> Expression:
        return make("element", value=(self, number))

    def places(self, row: int) -> Sequence[int]:
        """The numbers of the elements that the row of a product sums, in the order of the sum."""
        columns = self.shape[-1]
        return range(row * columns, (row + 1) * columns)

    def element_name(self, number: int) -> str:
        """The name of an element, as in 'A[0,1]'."""
        return f"{self.name}[{','.join(str(i) for i in np.unravel_index(number, self.shape))}]"

    def sum(self, row: int, factors: Iterable[Any]) -> Expression:
        """The row of a product term by term."""
        return sum(self._element(place) * factor for place, factor in zip(self.places(row), factors))

    def __matmul__(self, vector: Any) -> Any:
        line = at(users_line())
        vector = np.asarray(vector, dtype=object)
        columns, rows = self.shape[-1], range(self.values.size // self.shape[-1])
        if vector.shape != (columns,):
            raise Error(f"the table {self.name} of shape {self.shape} is multiplied by a vector of shape {vector.shape}"
                        f"{line}: give one expression for each of its {columns} columns")
        entries = tuple(to_real(as_number(e)) for e in vector)
        sums = [make("dot", entries, (self, row)) if columns > unrolled else self.sum(row, entries) for row in rows]
        if len(self.shape) == 1:
            return sums[0]
        product = np.empty(len(sums), object)
        product[:] = sums
        return product

    def __rmatmul__(self, vector: Any) -> NoReturn:
        raise Error(f"a vector is multiplied from the left by the table {self.name}{at(users_line())}: make a table of "
                    "the transposed array, and write table @ vector")


def tables_in(expression: Node) -> list[Table]:
    """The tables that an expression reads, each once."""
    return tables_of(walk([expression]))


def tables_of(nodes: Iterable[Node]) -> list[Table]:
    """The tables that these nodes refer to, each once."""
    return list(dict.fromkeys(n.value[0] for n in nodes if n.op in ("element", "dot", "lookup", "find_interval")))
