# SPDX-License-Identifier: MIT
"""States of a run at times of its past, for outputs that read delayed values."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from ..symbolic.evaluate import evaluate
from ..symbolic.node import symbols_of
from ..symbolic.symbols import time

if TYPE_CHECKING:
    from ..symbolic.types import Array
    from .protocol import Results


class PastStates:
    """States at any times: within the run from the same call with samples there, which `sampled` gives by state for
    times in rows, each in its order; before the begin from the model's history, or else the initial values."""

    def __init__(self, sampled: Callable[[Array], Mapping[str, Array]]) -> None:
        self._sampled = sampled
        self._known: dict[bytes, Mapping[str, Array]] = {}  # one call for all outputs with the same lag

    def __call__(self, run: Results, state: str, times: Array) -> Array:
        """Values of a state at times of instances, of any shape behind these; NaN at times that are not known."""
        shape, times = times.shape, times.reshape(run.size, -1)
        begin, end = (np.broadcast_to(np.asarray(one, float), (run.size,))[:, None] for one in run._domain)
        direction = np.where(end < begin, -1.0, 1.0)
        is_before = direction * (times - begin) < 0
        is_within = ~is_before & (direction * (times - end) <= 0)  # false where it is NaN
        values = np.where(is_before, self._before(run, state, times), np.nan)
        if is_within.any():
            rows = self._rows(np.where(is_within, direction * times, np.nan), direction * begin, direction * end)
            found = self._at(direction * rows)[state]
            for row, (wanted, sorted_times) in enumerate(zip(direction * times, rows)):
                chosen = is_within[row]
                values[row, chosen] = found[row, np.searchsorted(sorted_times, wanted[chosen])]
        return values.reshape(shape)

    @staticmethod
    def _rows(times: Array, begin: Array, end: Array) -> Array:
        """Times in rows of one length, each once and in order, filled with others."""
        rows = [np.unique(row[np.isfinite(row)]) for row in times]
        length = max(map(len, rows))
        made = np.empty((len(rows), length))
        for i, row in enumerate(rows):
            further = np.setdiff1d(np.linspace(begin[i, 0], end[i, 0], length + 2), row)[:length - len(row)]
            made[i] = np.union1d(row, further)
        return made

    def _at(self, times: Array) -> Mapping[str, Array]:
        key = times.tobytes()
        if key not in self._known:
            self._known[key] = self._sampled(times)
        return self._known[key]

    @staticmethod
    def _before(run: Results, state: str, times: Array) -> Array:
        components = run._components
        history = components.history_of_outputs.get(state)
        if history is None:
            given = run._inputs[state]
            given = np.asarray(given.get() if hasattr(given, "address") else given, float)
            return np.broadcast_to(given.reshape(-1, 1), times.shape)
        known: dict[Any, Any] = {}
        for symbol in symbols_of([history]):
            kind, name = symbol.value
            known[symbol] = times if symbol is time else (
                run.parameters[name][:, None] if kind == "parameter" else run.shared[name])
        return np.broadcast_to(evaluate([history], known)[0], times.shape)
