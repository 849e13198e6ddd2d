# SPDX-License-Identifier: MIT
"""Steady states by Newton's method, with the model's own derivatives, and what their eigenvalues say."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from ..base import component_kinds as kinds
from ..base.errors import Error
from ..models import delays
from ..models.components import Components, name_of
from ..models.recorded import RecordedModel
from ..sweeps.inputs import numbers, real
from ..symbolic import symbols as sym
from ..symbolic.derivatives import derivatives
from ..symbolic.evaluate import evaluate
from ..symbolic.expression import as_number
from ..symbolic.node import symbols_of
from .orbits import counted
from .starts import Starts, constant_values, parameter_of

if TYPE_CHECKING:
    from ..models.any_model import AnyModel
    from ..sweeps.sweep import Sweep
    from ..symbolic.types import Array, ByComponent

__all__ = ["SteadyState", "steady_states"]

_rounding = 1e-12  # of the scale of a state


@dataclass(frozen=True, eq=False)
class SteadyState:
    """A state at which nothing changes."""

    state: dict[str, float]  #: values by name
    eigenvalues: Array  #: of the Jacobian there, the one with the largest real part first, per unit of time
    jacobian: Array  #: derivatives of the equations by the states, a row for each equation
    #: "stable node", "stable focus", "saddle", "saddle-focus", "unstable node", "unstable focus", "centre", or
    #: "non-hyperbolic" where an eigenvalue has no real part
    kind: str
    _least: dict[str, float] = field(repr=False)  # what is less is rounding, by state

    @property
    def is_stable(self) -> bool:
        """Whether all nearby orbits come closer: all real parts are negative."""
        return self.kind.startswith("stable")

    def __repr__(self) -> str:
        at = ", ".join(f"{name} = {value if abs(value) > self._least[name] else 0:.6g}"
                       for name, value in self.state.items())
        return f"<{self.kind} at {at}; eigenvalues {', '.join(map(_shown, self.eigenvalues))}>"


def _shown(value: complex) -> str:
    real_part = f"{value.real + 0.0:.4g}"  # no minus sign of zero
    return real_part if value.imag == 0 else f"{real_part}{value.imag:+.4g}i"


def kind_of(eigenvalues: Array, error: Array) -> str:
    """What a steady state with these eigenvalues is called, whose real parts are known within `error`. Node or focus,
    saddle or saddle-focus: by the leading eigenvalues, those next to the imaginary axis on its sides."""
    small = 1e-9 * max(np.abs(eigenvalues).max(), 1e-300)
    inner = eigenvalues[np.abs(eigenvalues.real) <= np.maximum(small, error)]
    if inner.size:
        return "centre" if inner.size == eigenvalues.size and (np.abs(inner.imag) > small).all() else "non-hyperbolic"
    left, right = eigenvalues[eigenvalues.real < 0], eigenvalues[eigenvalues.real > 0]
    turns = any(abs(side[np.abs(side.real).argmin()].imag) > small for side in (left, right) if side.size)
    if left.size and right.size:
        return "saddle-focus" if turns else "saddle"
    return f"{'stable' if left.size else 'unstable'} {'focus' if turns else 'node'}"


class Equations:
    """The right-hand side of a model and its Jacobian at many states, with some parameters, by NumPy."""

    def __init__(self, model: AnyModel, values: Mapping[Any, Any]) -> None:
        if not isinstance(model, RecordedModel):
            raise Error("steady states need the model's derivatives, and this model is not recorded in Python: make it "
                        "by my.model(...)")
        delays.refuse(model, "steady states", "find those of the model without delays; whether they are stable is "
                      "another matter")
        if model.mass_matrix is not None:
            raise Error("the model has a mass matrix, with which the eigenvalues are others: solve its algebraic "
                        "equations in the others")
        self._functions = list(model.equations.values())
        found = symbols_of(self._functions)
        if any(symbol is sym.time for symbol in found):
            raise Error("the equations depend on time, so that there is no steady state: look for cycles, by "
                        "my.attractors")
        self.states, self._symbols = model.states, [sym.symbol("state", name) for name in model.states]
        components = Components(model)
        given = {parameter_of(components, key): numbers(value, name_of(key)) for key, value in values.items()}
        given = components.completed(given, np.asarray(0.0))
        self._known = {}
        for symbol in found:
            kind, name = symbol.value
            if kind != "state" and kind in kinds.valued:
                if kind in kinds.accessories:
                    raise Error(f"the equations depend on the accessory {name}, which hooks change: make it a "
                                "parameter")
                if given.get(name) is None:
                    raise Error(f"the value of '{name}' is missing: give it in the sweep")
                if not np.isfinite(given[name]).all():
                    raise Error(f"'{name}' is {given[name]}: give a finite number")
                self._known[symbol] = given[name]
        self._derivatives = derivatives(self._functions, self._symbols)

    def _at(self, states: Array) -> dict[Any, Any]:
        return {**self._known, **dict(zip(self._symbols, states.T))}

    def __call__(self, states: Array) -> Array:
        """The derivatives of states in rows."""
        found = evaluate(self._functions, self._at(states))
        return np.stack([np.broadcast_to(np.asarray(one, float), len(states)) for one in found], axis=1)

    def jacobian(self, states: Array) -> Array:
        """Matrices (rows of `states`, equations, states); by central differences where an equation has a function
        without a rule, as the lookup in a table."""
        count, size = states.shape
        made = np.zeros((count, size, size))
        if self._derivatives is None:
            step = 6e-6 * np.maximum(np.abs(states), 1e-3)  # the cube root of the resolution of numbers
            for i in range(size):
                off = np.zeros_like(states)
                off[:, i] = step[:, i]
                made[:, :, i] = (self(states + off) - self(states - off)) / (2 * step[:, i, None])
            return made
        places = [(row, i) for row, of in enumerate(self._derivatives) for i in of]
        values = evaluate([as_number(self._derivatives[row][i]) for row, i in places], self._at(states))
        for (row, i), value in zip(places, values):
            made[:, row, i] = value
        return made

    def newton(self, states: Array, iterations: int, scale: Array) -> tuple[Array, Array]:
        """Where Newton's method leads from states in rows, with steps that are halved until the derivatives are
        smaller; and which of them have arrived: within rounding of themselves, or of the scale of each state."""
        states = states.astype(float)
        arrived, active = np.zeros(len(states), bool), np.arange(len(states))
        for _ in range(iterations):
            here, f = states[active], self(states[active])
            step, solves = self._steps(here, f)
            length, size = np.ones(len(active)), np.linalg.norm(f, axis=1)
            for _ in range(8):
                with np.errstate(invalid="ignore", over="ignore"):
                    worse = ~(np.linalg.norm(self(here - length[:, None] * step), axis=1) <= size)
                if not worse.any():
                    break
                length[worse] /= 2
            states[active] = here - length[:, None] * step
            small = np.abs(step) <= 1e-9 * np.abs(here) + _rounding * scale
            done = small.all(axis=1) & solves
            arrived[active[done]] = True
            active = active[~done & np.isfinite(states[active]).all(axis=1)]
            if not active.size:
                break
        return states, arrived

    def _steps(self, states: Array, f: Array) -> tuple[Array, Array]:
        """Newton's steps, by the pseudoinverse of the Jacobian, and whether they solve its equations, which may have
        no solution where it is singular."""
        matrices = self.jacobian(states)
        well = np.isfinite(matrices).all(axis=(1, 2)) & np.isfinite(f).all(axis=1)
        steps, solves = np.full_like(states, np.nan), np.zeros(len(states), bool)
        rows = _largest(matrices[well], 2)  # equations and states have units, which must make no difference
        columns = _largest(matrices[well] / rows, 1)
        inverse = np.linalg.pinv(matrices[well] / rows / columns)
        steps[well] = np.einsum("nij,nj->ni", inverse, f[well] / rows[:, :, 0]) / columns[:, 0]
        left = np.einsum("nij,nj->ni", matrices[well], steps[well]) - f[well]
        solves[well] = np.abs(left).max(axis=1) <= 1e-6 * np.abs(f[well]).max(axis=1)
        return steps, solves

    def steady_state(self, state: Array, scale: Array) -> SteadyState:
        """What a state is at which nothing changes. Where Newton's method comes to it slowly, an eigenvalue is zero: it
        is known no closer than it changes in another step, or within the rounding of a double root."""
        step, _ = self._steps(state[None], self(state[None]))
        matrix, further = self.jacobian(np.stack([state, state * (1 + 1.5e-8) - step[0]]))
        if not np.isfinite(further).all():
            further = matrix
        eigenvalues, others = (_sorted(np.linalg.eigvals(of)) for of in (matrix, further))
        return SteadyState(dict(zip(self.states, state.tolist())), eigenvalues, matrix,
                           kind_of(eigenvalues, 3 * np.abs(eigenvalues.real - others.real)),
                           dict(zip(self.states, (_rounding * scale).tolist())))


def _largest(matrices: Array, axis: int) -> Array:
    """The largest magnitude along an axis, 1 where all are zero."""
    found = np.abs(matrices).max(axis=axis, keepdims=True)
    return np.where(found > 0, found, 1.0)


def _sorted(eigenvalues: Array) -> Array:
    """The one with the largest real part first."""
    return eigenvalues[np.lexsort((-eigenvalues.imag, -eigenvalues.real))]


def steady_states(model: AnyModel, sweep: Sweep | ByComponent | None = None, *, start: Sweep | ByComponent,
                  draws: int | None = None, seed: int = 0, iterations: int = 50,
                  tolerance: float = 1e-6) -> list[SteadyState]:
    """Steady states that Newton's method finds from some starts, stable or not, each once, with the eigenvalues of the
    Jacobian and their kind; in ascending order of the states. From a grid of starts these are usually all that the
    grid surrounds, without proof. The Jacobian is made of the model's equations symbolically.

    model       from `my.model(...)`, whose equations do not depend on time
    sweep       the values of parameters and shared components, one of each
    start       states from which to begin: as of `my.attractors`
    draws, seed   the number of random starts, if `start` has some, and their seed
    iterations  the most of each start
    tolerance   how far apart two steady states are at least, relative to the largest value of each state, in
                starts too

    Raises `Error` where no start leads to a steady state."""
    if not real(tolerance, "tolerance") > 0:
        raise Error(f"tolerance is {tolerance}: give a positive number, as 1e-6")
    equations = Equations(model, constant_values(sweep, "a call for each value"))
    starts = Starts(Components(model), start, draws, seed)
    rows = np.stack([starts.values[name] for name in model.states], axis=1)
    scale = np.abs(rows).max(axis=0)
    scale[scale == 0] = scale.max() or 1.0
    found, arrived = equations.newton(rows, counted(iterations, "iterations", 1), scale)
    found = found[arrived]
    if not len(found):
        raise Error("no start leads to a steady state: give other starts, or look whether there is one")
    found = found[np.lexsort(found.T[::-1])]
    apart = tolerance * np.maximum(np.abs(found).max(axis=0), scale)
    kept: list[Array] = []
    for state in found:
        if not any((np.abs(state - other) <= apart).all() for other in kept):
            kept.append(state)
    return [equations.steady_state(state + 0.0, scale) for state in kept]
