# SPDX-License-Identifier: MIT
"""What stiff methods use of a model with many states: the derivatives of its equations, and which are always zero."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from ..symbolic.derivatives import dependencies, derivatives
from ..symbolic.expression import as_number
from ..symbolic.node import symbols_of

if TYPE_CHECKING:
    from ..models.recorded import RecordedModel
    from ..symbolic.node import Node

# Stiff methods keep dense factors of fewer states in registers. Of more states than the last the derivatives are not
# written, as they take long to make.
first_sparse, last_written = 7, 128
# Beyond, the pattern alone is written, and the derivatives come from dual numbers. A network of 75 species with 1542
# derivatives takes 3.3 ms with them, and 9.4 ms without (a run by rodas_5p, AVX-512).
_most_derivatives = 2048


def is_autonomous(model: RecordedModel) -> bool:
    """Whether the equations do not read the time."""
    return all(s.value != ("built-in", "time") for s in symbols_of(model.rhs))


def jacobian_of(model: RecordedModel) -> tuple[list[tuple[int, int]], Sequence[Node] | None]:
    """Row and column of the entries of the Jacobian that may differ from zero, and their values; no entries where the
    matrix is dense, and no values where dual numbers are to find them."""
    if not first_sparse <= len(model.states) <= last_written:
        return [], None
    order, column = _states_of(model)
    most = max(len(model.states) ** 2 // 2, _most_derivatives)
    depends_on = dependencies(model.rhs, order)
    if sum(map(len, depends_on)) > most:  # told before all derivatives are made, which takes seconds
        return [], None
    found = derivatives(model.rhs, order)
    rows = found if found is not None else depends_on
    entries = [(row, i) for row, columns in enumerate(rows) for i in sorted(columns)]
    values = None
    if found is not None and len(entries) <= _most_derivatives:
        values = [as_number(found[row][i]) for row, i in entries]
    return [(row, column[i]) for row, i in entries], values


def pattern_of(model: RecordedModel) -> list[tuple[int, int]]:
    """The entries alone, of a model with any number of states."""
    order, column = _states_of(model)
    return [(row, column[i]) for row, columns in enumerate(dependencies(model.rhs, order)) for i in columns]


def _states_of(model: RecordedModel) -> tuple[list[Node], list[int]]:
    """The symbols of states that the equations read, and the number of each."""
    by_name = {s.value[1]: s for s in symbols_of(model.rhs) if s.value[0] == "state"}
    numbers = [i for i, name in enumerate(model.states) if name in by_name]
    return [by_name[model.states[i]] for i in numbers], numbers
