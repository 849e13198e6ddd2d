# SPDX-License-Identifier: MIT
"""The right-hand side of a model at many states, with its derivatives, and Newton's method for where it is zero."""

from __future__ import annotations

import copy
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ..symbolic import symbols as sym
from ..symbolic.derivatives import derivatives
from ..symbolic.evaluate import evaluate
from ..symbolic.expression import as_number

if TYPE_CHECKING:
    from ..models.recorded import RecordedModel
    from ..symbolic.node import Node
    from ..symbolic.types import Array

rounding = 1e-12  # of the scale of a state


class Equations:
    """The right-hand side of a model and its derivatives at states in rows, by NumPy. `known` has the values of all
    symbols but the states, numbers or one for each row. Newton's method leaves `sums` as they are."""

    def __init__(self, model: RecordedModel, known: Mapping[Node, Any]) -> None:
        self._functions = list(model.equations.values())
        self.states, self._symbols = model.states, [sym.symbol("state", name) for name in model.states]
        self._known = dict(known)
        self.sums = np.zeros((0, len(self.states)))
        self._totals: Array = np.zeros(0)
        self._derivatives = derivatives(self._functions, self._symbols)

    def of(self, rows: Any, known: Mapping[Node, Any] | None = None) -> Equations:
        """Those of some rows, of others that are `known` or of these."""
        made = copy.copy(self)
        made._known = {symbol: v if np.ndim(v) == 0 else v[rows]
                       for symbol, v in (self._known if known is None else known).items()}
        made._totals = self._totals[rows] if self._totals.ndim == 2 else self._totals
        return made

    def conserving(self, sums: Array) -> Equations:
        """Those with sums that are conserved, a row of factors of the states for each."""
        made = copy.copy(self)
        made.sums, made._totals = sums, np.zeros(len(sums))
        return made

    def with_totals_of(self, states: Array) -> Equations:
        """Those whose sums are what they are of states in rows."""
        made = copy.copy(self)
        made._totals = states @ self.sums.T
        return made

    def _at(self, states: Array) -> dict[Any, Any]:
        return {**self._known, **dict(zip(self._symbols, states.T))}

    def __call__(self, states: Array) -> Array:
        """The derivatives of states in rows by time."""
        found = evaluate(self._functions, self._at(states))
        return np.stack([np.broadcast_to(np.asarray(one, float), len(states)) for one in found], axis=1)

    def jacobian(self, states: Array) -> Array:
        """Matrices (rows of `states`, equations, states); by central differences where an equation has a function
        without a rule, as the lookup in a table."""
        count, size = states.shape
        if self._derivatives is not None:
            return self._matrices(self._derivatives, size, states)
        made = np.zeros((count, size, size))
        step = 6e-6 * np.maximum(np.abs(states), 1e-3)  # the cube root of the resolution of numbers
        for i in range(size):
            off = np.zeros_like(states)
            off[:, i] = step[:, i]
            made[:, :, i] = (self(states + off) - self(states - off)) / (2 * step[:, i, None])
        return made

    def by(self, symbols: Sequence[Node], states: Array) -> Array | None:
        """The derivatives by other symbols (rows of `states`, equations, symbols), or None where a function has no
        rule."""
        found = derivatives(self._functions, symbols)
        return None if found is None else self._matrices(found, len(symbols), states)

    def _matrices(self, found: Sequence[Mapping[int, Any]], size: int, states: Array) -> Array:
        made = np.zeros((len(states), len(found), size))
        places = [(row, i) for row, of in enumerate(found) for i in of]
        values = evaluate([as_number(found[row][i]) for row, i in places], self._at(states))
        for (row, i), value in zip(places, values):
            made[:, row, i] = value
        return made

    def newton(self, states: Array, iterations: int, scale: Array) -> tuple[Array, Array]:
        """Where Newton's method leads from states in rows, with steps that are halved until the derivatives are
        smaller; and which of them have arrived: within rounding of themselves, or of the scale of each state."""
        states = states.astype(float)
        scale = np.broadcast_to(scale, states.shape)
        arrived, active = np.zeros(len(states), bool), np.arange(len(states))
        for _ in range(iterations):
            here, there = states[active], self.of(active)
            f = there.residual(here)
            step, solves = there.steps(here, f)
            length, size = np.ones(len(active)), np.linalg.norm(f, axis=1)
            for _ in range(8):
                with np.errstate(invalid="ignore", over="ignore"):
                    worse = ~(np.linalg.norm(there.residual(here - length[:, None] * step), axis=1) <= size)
                if not worse.any():
                    break
                length[worse] /= 2
            states[active] = here - length[:, None] * step
            small = np.abs(step) <= 1e-9 * np.abs(here) + rounding * scale[active]
            done = small.all(axis=1) & solves
            arrived[active[done]] = True
            active = active[~done & np.isfinite(states[active]).all(axis=1)]
            if not active.size:
                break
        return states, arrived

    def residual(self, states: Array) -> Array:
        """What is zero at a steady state: the derivatives by time, and how far sums are from their totals."""
        return np.concatenate([self(states), states @ self.sums.T - self._totals], axis=1)

    def steps(self, states: Array, residual: Array | None = None) -> tuple[Array, Array]:
        """Newton's steps, and whether they solve its equations, which may have no solution where they are singular."""
        f = self.residual(states) if residual is None else residual
        found, left = self.solved(states, f[:, :, None])
        matrices = self._with_sums(self.jacobian(states))
        noise = 1e-13 * (np.abs(matrices) @ np.abs(states)[:, :, None])[:, :, 0]  # what rounding alone leaves
        allowed = 1e-6 * np.abs(f).max(axis=1, keepdims=True) + noise
        return found[:, :, 0], (np.abs(left[:, :, 0]) <= allowed).all(axis=1)

    def solved(self, states: Array, right: Array) -> tuple[Array, Array]:
        """What Jacobian, and sums below it, take to right-hand sides (rows of `states`, equations and sums, any), by
        the pseudoinverse; and what is left of these. NaN where the Jacobian is."""
        matrices = self._with_sums(self.jacobian(states))
        well = np.isfinite(matrices).all(axis=(1, 2)) & np.isfinite(right).all(axis=(1, 2))
        found, left = np.full((len(states), states.shape[1], right.shape[2]), np.nan), np.full_like(right, np.nan)
        scaled, rows, columns = _scaled(matrices[well])
        found[well] = np.linalg.pinv(scaled) @ (right[well] / rows) / columns.transpose(0, 2, 1)
        left[well] = matrices[well] @ found[well] - right[well]
        return found, left

    def _with_sums(self, matrices: Array) -> Array:
        return np.concatenate([matrices, np.broadcast_to(self.sums, (len(matrices), *self.sums.shape))], axis=1)

    def is_regular(self, states: Array, scale: Array) -> Array:
        """Whether Jacobian and sums leave no direction free, so that a steady state is alone with its totals: where
        states change by their scale, all changes tell."""
        matrices = self._with_sums(self.jacobian(states)) * scale[:, None, :]
        well = np.isfinite(matrices).all(axis=(1, 2))
        found = np.zeros(len(states), bool)
        singular_values = np.linalg.svd(matrices[well] / _largest(matrices[well], 2), compute_uv=False)
        found[well] = singular_values[:, -1] > 1e-10 * singular_values[:, 0]
        return found


def _scaled(matrices: Array) -> tuple[Array, Array, Array]:
    """Matrices whose rows and columns have no units, which must make no difference, and what they were divided by."""
    rows = _largest(matrices, 2)
    columns = _largest(matrices / rows, 1)
    return matrices / rows / columns, rows, columns


def _largest(matrices: Array, axis: int) -> Array:
    """The largest magnitude along an axis, 1 where all are zero."""
    found = np.abs(matrices).max(axis=axis, keepdims=True)
    return np.where(found > 0, found, 1.0)
