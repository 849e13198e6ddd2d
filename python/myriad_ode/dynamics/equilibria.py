# SPDX-License-Identifier: MIT
"""The steady states that instances come to from where they start. Each is integrated over longer and longer times until
Newton's method, which keeps conserved sums, finds a stable steady state next to it; how that moves with parameters and
initial values is what the implicit function theorem says."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ..base import component_kinds as kinds
from ..models.components import Components
from ..models.recorded import RecordedModel
from ..solving.solve import solve
from ..symbolic import symbols as sym
from ..symbolic.node import symbols_of
from .equations import Equations, rounding
from .steady_states import refuse_unknown_equations

if TYPE_CHECKING:
    from ..models.any_model import AnyModel
    from ..symbolic.types import Array

_times = 10.0 ** np.arange(1, 11)  # up to which instances are integrated, one after the other
_near = 1e-3  # of the scale of a state, how far off a steady state may be
_still = 1e-6  # how little a state changes while time grows tenfold, where Newton's method cannot tell


class Equilibria:
    """The steady states that instances of a model come to. `values` are those of parameters and `start` of all states,
    in rows; `options` are those of `solve`."""

    def __init__(self, model: AnyModel, values: Mapping[str, Array], start: Array, options: Mapping[str, Any]) -> None:
        refuse_unknown_equations(model)
        assert isinstance(model, RecordedModel)  # as others are refused
        self._model, self._values, self._start, self._options = model, dict(values), start, dict(options)
        count = len(start)
        components = Components(model)
        self._symbols = symbols_of(list(model.equations.values()))
        self._moves_with_time = any(symbol is sym.time for symbol in self._symbols)
        completed = components.completed({**values, **dict(zip(model.states, start.T))}, np.zeros(count))
        self._known: dict[Any, Array] = {sym.time: np.zeros(count)} if self._moves_with_time else {}
        for symbol in self._symbols:
            if symbol is not sym.time and symbol.value[0] in kinds.valued and symbol.value[0] != "state":
                given = completed.get(symbol.value[1])
                self._known[symbol] = np.broadcast_to(np.nan if given is None else given, count).astype(float)
        self.states = np.full(start.shape, np.nan)  #: in rows, NaN where there is no steady state
        self.status = ["no steady state"] * count  #: "steady state", "no steady state", or how an integration ended
        self.ends = np.full(count, np.nan)  #: times at which they were reached
        #: whether the implicit function theorem knows their derivatives; where not, they are those at `ends`
        self.is_regular = np.zeros(count, bool)
        self._equations: dict[int, Equations] = {}
        self._conserving()
        self._reach()

    def _conserving(self) -> None:
        """The equations with conserved sums, which differ where other parameters are zero."""
        constants = [v for symbol, v in self._known.items() if symbol is not sym.time]
        pattern = np.stack([v == 0 for v in constants], axis=1) if constants else np.zeros((len(self._start), 0), bool)
        _, self._group = np.unique(pattern, axis=0, return_inverse=True)
        self._group = self._group.ravel()
        general = Equations(self._model, self._known)
        for group in range(self._group.max(initial=-1) + 1):
            first = int(np.flatnonzero(self._group == group)[0])
            sums = conserved_sums(general, {symbol: v[first] for symbol, v in self._known.items()})
            self._equations[group] = general.conserving(sums)

    def _of(self, rows: Array) -> Equations:
        """The equations of instances of one group."""
        return self._equations[int(self._group[rows[0]])].of(rows, self._known)

    def _reach(self) -> None:
        scale, pending = np.abs(self._start), np.arange(len(self._start))
        before = np.full(self._start.shape, np.nan)
        for end in _times:
            pending = self._integrate(pending, end, before, scale)
            if not pending.size:
                return

    def _integrate(self, pending: Array, end: float, before: Array, scale: Array) -> Array:
        """Integrates instances to some time. Returns those that have no steady state yet."""
        start = dict(zip(self._model.states, np.ascontiguousarray(self._start[pending].T)))
        values = {name: np.ascontiguousarray(np.broadcast_to(v, len(self._start))[pending])
                  for name, v in self._values.items()}
        run = solve(self._model, values, start=start, time=(0.0, end), size=len(pending), **self._options)
        for row in np.flatnonzero(run.failed):
            self.status[pending[row]] = str(run.status[row])
        went = np.flatnonzero(~run.failed)
        states = np.stack([run._values_of(name) for name in self._model.states], axis=1)[went]
        for symbol in self._known:
            if symbol is sym.time:
                self._known[symbol][pending] = end
            elif symbol.value[0] in kinds.accessories:
                self._known[symbol][pending] = run._values_of(symbol.value[1])
        pending = pending[went]
        scale[pending] = np.maximum(scale[pending], np.abs(states))
        settled = np.zeros(pending.size, bool)
        for group in np.unique(self._group[pending]):
            there = np.flatnonzero(self._group[pending] == group)
            settled[there] = self._settle(pending[there], states[there], before[pending[there]], scale[pending[there]])
        self.ends[pending] = end
        before[pending] = states
        return pending[~settled]

    def _settle(self, rows: Array, states: Array, before: Array, scale: Array) -> Array:
        """Keeps the steady states next to states of instances of one group, and tells where there are some."""
        equations = self._of(rows).with_totals_of(states)
        largest = scale.max(axis=1, keepdims=True)
        allowed = _near * np.maximum(scale, rounding * largest)
        scale = np.where(scale > 0, scale, np.where(largest > 0, largest, 1.0))  # of what is zero all the time
        found, arrived = equations.newton(states, 20, scale)
        near = (np.abs(found - states) <= np.maximum(allowed, _near * np.abs(found))).all(axis=1)
        good = np.flatnonzero(arrived & near)
        is_stable = _stable(equations.of(good), found[good], scale[good])
        good = good[is_stable & self._lasting(rows[good], found[good], scale[good])]
        self.is_regular[rows[good]] = not self._model.triggers
        with np.errstate(invalid="ignore"):
            still = (np.abs(states - before) <= _still * scale).all(axis=1)
        still[good] = False
        self.states[rows[good]], self.states[rows[still]] = found[good], states[still]
        still[good] = True
        for row in rows[still]:
            self.status[row] = "steady state"
        return still

    def _lasting(self, rows: Array, states: Array, scale: Array) -> Array:
        """Whether nothing changes at later times either."""
        lasts = np.ones(len(rows), bool)
        if self._moves_with_time and rows.size:
            for later in (10.0, 1e3):
                known = {**self._known, sym.time: self._known[sym.time] * later}
                equations = self._equations[int(self._group[rows[0]])].of(rows, known).with_totals_of(states)
                lasts &= (np.abs(equations.steps(states)[0]) <= 1e-6 * scale).all(axis=1)
        return lasts

    def derivatives(self, names: Sequence[str], of_values: Array, of_start: Array) -> Array:
        """The derivatives of the steady states, (instances, states, directions), along directions in which the
        parameters `names` move by `of_values`, (instances, names, directions), and the initial states by `of_start`.
        NaN where the implicit function theorem knows none."""
        found = np.full((*self.states.shape, of_start.shape[2]), np.nan)
        symbols = [s for s in self._symbols if s is not sym.time and s.value[1] in names]
        place = [list(names).index(s.value[1]) for s in symbols]
        for group in np.unique(self._group[self.is_regular]):
            rows = np.flatnonzero(self.is_regular & (self._group == group))
            equations, states = self._of(rows).with_totals_of(self.states[rows]), self.states[rows]
            by = equations.by(symbols, states)
            if by is None:
                continue
            right = np.concatenate([-by @ of_values[rows][:, place], equations.sums @ of_start[rows]], axis=1)
            found[rows] = equations.solved(states, right)[0]
        return found


def _stable(equations: Equations, states: Array, scale: Array) -> Array:
    """Whether Jacobians and sums leave no direction free, and states nearby come no further away."""
    found = equations.is_regular(states, scale)
    matrices = equations.of(found).jacobian(states[found])
    eigenvalues = np.linalg.eigvals(matrices)
    largest = np.abs(eigenvalues).max(axis=1, initial=0.0)
    found[found] = (eigenvalues.real <= 1e-6 * largest[:, None]).all(axis=1)
    return found


def conserved_sums(equations: Equations, known: Mapping[Any, Any]) -> Array:
    """Factors of the states, a row for each sum that never changes: those of the right-hand side, which give zero at
    random states and parameters, of which those that are zero stay so."""
    random, size = np.random.default_rng(0), len(equations.states)
    count = 2 * size + 10
    drawn = {symbol: np.sign(value) * np.exp(random.uniform(-1, 1, count)) for symbol, value in known.items()}
    if sym.time in drawn:
        drawn[sym.time] = np.exp(random.uniform(-3, 6, count))
    slopes = equations.of(slice(None), drawn)(np.exp(random.uniform(-1, 1, (count, size))))
    slopes = slopes[np.isfinite(slopes).all(axis=1)]
    if len(slopes) <= size:
        return np.zeros((0, size))
    largest = np.abs(slopes).max(axis=0)
    largest[largest == 0] = 1.0
    _, singular_values, directions = np.linalg.svd(slopes / largest)
    return _reduced(directions[singular_values <= 1e-11 * max(singular_values[0], 1e-300)] / largest)


def _reduced(rows: Array) -> Array:
    """Rows that span the same, with as many zeros as Gauss and Jordan's elimination gives."""
    rows = rows.copy()
    for i in range(len(rows)):
        place = np.unravel_index(np.abs(rows[i:]).argmax(), rows[i:].shape)
        rows[[i, i + int(place[0])]] = rows[[i + int(place[0]), i]]
        rows[i] /= rows[i, place[1]]
        others = np.arange(len(rows)) != i
        rows[others] -= rows[others][:, [place[1]]] * rows[i]
    rows[np.abs(rows) < 1e-9] = 0.0
    return rows
