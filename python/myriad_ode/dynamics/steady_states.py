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
from ..symbolic.node import symbols_of
from .equations import Equations, rounding
from .orbits import counted
from .starts import Starts, constant_values, parameter_of

if TYPE_CHECKING:
    from ..models.any_model import AnyModel
    from ..sweeps.sweep import Sweep
    from ..symbolic.types import Array, ByComponent

__all__ = ["SteadyState", "steady_states"]

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


def equations_of(model: AnyModel, values: Mapping[Any, Any]) -> Equations:
    """The equations of a model with some parameters, which do not depend on time."""
    refuse_unknown_equations(model)
    assert isinstance(model, RecordedModel)  # as others are refused
    found = symbols_of(list(model.equations.values()))
    if any(symbol is sym.time for symbol in found):
        raise Error("the equations depend on time, so that there is no steady state: look for cycles, by "
                    "my.attractors")
    components = Components(model)
    given = {parameter_of(components, key): numbers(value, name_of(key)) for key, value in values.items()}
    given = components.completed(given, np.asarray(0.0))
    known = {}
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
            known[symbol] = given[name]
    return Equations(model, known)


def refuse_unknown_equations(model: AnyModel) -> None:
    """Refuses models of whose equations nothing is known, or too little."""
    if not isinstance(model, RecordedModel):
        raise Error("steady states need the model's derivatives, and this model is not recorded in Python: make it "
                    "by my.model(...)")
    delays.refuse(model, "steady states", "find those of the model without delays; whether they are stable is "
                  "another matter")
    if model.mass_matrix is not None:
        raise Error("the model has a mass matrix, with which the eigenvalues are others: solve its algebraic "
                    "equations in the others")


def steady_state_at(equations: Equations, state: Array, scale: Array) -> SteadyState:
    """What a state is at which nothing changes. Where Newton's method comes to it slowly, an eigenvalue is zero: it
    is known no closer than it changes in another step, or within the rounding of a double root."""
    step, _ = equations.steps(state[None])
    matrix, further = equations.jacobian(np.stack([state, state * (1 + 1.5e-8) - step[0]]))
    if not np.isfinite(further).all():
        further = matrix
    eigenvalues, others = (_sorted(np.linalg.eigvals(of)) for of in (matrix, further))
    return SteadyState(dict(zip(equations.states, state.tolist())), eigenvalues, matrix,
                       kind_of(eigenvalues, 3 * np.abs(eigenvalues.real - others.real)),
                       dict(zip(equations.states, (rounding * scale).tolist())))


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
    equations = equations_of(model, constant_values(sweep, "a call for each value"))
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
    return [steady_state_at(equations, state + 0.0, scale) for state in kept]
