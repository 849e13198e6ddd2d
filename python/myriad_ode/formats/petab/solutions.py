# SPDX-License-Identifier: MIT
"""The solutions of a problem of PEtab for sets of its free components: from initial values or from the steady states of
other conditions, up to measurements and on to steady states."""

from __future__ import annotations

import functools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from ...dynamics.equilibria import Equilibria
from ...inference.measurements import Given
from ...symbolic.derivatives import derivatives
from ...symbolic.evaluate import evaluate
from ...symbolic.node import Node, symbols_of
from ...symbolic.symbols import time

if TYPE_CHECKING:
    from ...gradients.forward import Forward
    from ...models.components import Components
    from ...results.run import Run
    from ...symbolic.types import Array


def varied_by(set_to: Mapping[str, Given], components: Components) -> list[str]:
    """The components of a model that conditions set to what is estimated, and the parameters that follow from them."""
    of_free = [n for n, given in set_to.items() if n in components.place and (given.free >= 0).any()]
    return of_free + [n for n in components.names["parameter"] if n not in set_to
                      and components.follows(n, of_free, list(set_to))]


class Instances:
    """The parameters of a model for sets of the free components at some conditions, and their derivatives by these.
    `values` are by component, [set, condition]; `chain`, [set or 1, condition, varied component, free component].
    `begins` are the times at which conditions begin."""

    def __init__(self, set_to: Mapping[str, Given], begins: Array, components: Components, sets: Array,
                 varied: Sequence[str]) -> None:
        conditions = len(begins)
        self.components, self.shape = components, (len(sets), conditions)
        self._begins = np.tile(begins, len(sets))
        self.given = {name: given for name, given in set_to.items() if name in components.place}
        self.varied = varied
        self._count = sets.shape[1]
        self.values = {name: given.values(sets) for name, given in self.given.items()}
        self._of = {name: (given.free[:, None] == np.arange(self._count)).astype(float)[None]
                    for name, given in self.given.items()}
        self.values |= {name: self.start(name) for name in varied if name not in self.given}
        parts = [self.of(name) for name in varied]
        self.chain = (np.stack(np.broadcast_arrays(*parts), axis=-2) if parts
                      else np.zeros((1, conditions, 0, self._count)))

    @functools.cached_property
    def _completed(self) -> dict[str, Any]:
        return self.components.completed({n: v.ravel() for n, v in self.values.items()}, self._begins)

    def start(self, name: str) -> Array:
        """The value of a component at the start, [set, condition]."""
        return np.broadcast_to(self._completed[name], self.shape[0] * self.shape[1]).reshape(self.shape)

    def of(self, name: str) -> Array:
        """Its derivatives by the free components, [set or 1, condition or 1, free component]."""
        if name not in self._of:
            default: Any = self.components.defaults.get(name)
            symbols = [s for s in symbols_of([default]) if s is not time] if isinstance(default, Node) else []
            partials = (derivatives([default], symbols) or [{}])[0] if symbols else {}
            known = {s: self._completed[s.value[1]] for s in symbols} | {time: self._begins}
            self._of[name] = sum((self._along(evaluate([partial], known)[0]) * self.of(symbols[i].value[1])
                                  for i, partial in partials.items()), np.zeros((1, 1, self._count)))
        return self._of[name]

    def _along(self, values: Any) -> Array:
        return np.broadcast_to(values, self.shape[0] * self.shape[1]).reshape(*self.shape, 1)

    def starts(self) -> tuple[Array, Array]:
        """The initial values of all states, [set, condition, state], and their derivatives by the free components."""
        states = self.components.states
        by = [np.broadcast_to(self.of(name), (*self.shape, self._count)) for name in states]
        return np.stack([self.start(name) for name in states], axis=2), np.stack(by, axis=2)

    def spread(self, by_free: Array) -> Array:
        """Derivatives by the varied components, [set, condition, state, varied component], that the chain rule makes
        those by the free components of: each of these stands in a varied component of the condition."""
        found = np.zeros((*by_free.shape[:3], len(self.varied)))
        taken = np.zeros((self.shape[1], self._count), bool)
        for place, name in enumerate(self.varied):
            if name in self.given:
                free = self.given[name].free
                for c in np.flatnonzero(free >= 0):
                    if not taken[c, free[c]]:
                        found[:, c, :, place] = by_free[:, c, :, free[c]]
                        taken[c, free[c]] = True
        return found


@dataclass
class SteadyStates:
    """What a problem has of steady states. `names` are those of the conditions before others, `before` has for each
    condition the number of the one before it, or -1, and `set_to` what those before set components to; `reset` by state
    tells where the condition sets it anew. `after` are the numbers of the conditions that go on to one."""

    names: list[str]
    before: Array
    set_to: dict[str, Given]
    reset: dict[str, Array]
    after: Array


@dataclass
class Solved:
    """The run of all sets, one set after the other, and the steady states after it, [set, condition, state], with their
    derivatives by the free components. `lost`, [set, condition], began in no steady state."""

    run: Run
    instances: Instances
    lost: Array
    after: Array | None = None
    by_after: Array | None = None
    before_status: Sequence[str] = ()  #: of the steady states before, one set after the other
    after_status: Sequence[str] = ()  #: of those after

    def at(self, state: str, condition: Array, place: Array) -> Array:
        """A state at samples of conditions, [set, one of several]; behind the last sample is the steady state."""
        samples = self._samples(state)
        if self.after is not None:
            samples = np.append(samples, self.after[:, :, [self.instances.components.states.index(state)]], axis=2)
        return samples[:, condition, place]

    def derivative_at(self, state: str, varied: str, condition: Array, place: Array) -> Array:
        """Its derivative by a varied component, zero behind the last sample."""
        samples = self._samples(f"{state}_by_{varied}")
        if self.after is not None:
            samples = np.append(samples, np.zeros((*samples.shape[:2], 1)), axis=2)
        return samples[:, condition, place]

    def _samples(self, name: str) -> Array:
        sets, conditions = self.instances.shape
        return np.where(self.lost[:, :, None], np.nan, self.run._values_of(name).reshape(sets, conditions, -1))


class Solutions:
    """Solves a problem for sets of the free components. `times`, `begins` and `ends` are those of sampling, by
    condition; `before` integrates to the steady states before."""

    def __init__(self, set_to: Mapping[str, Given], steady: SteadyStates, components: Components, forward: Forward,
                 before: Forward, sampled: Sequence[str], times: Array, begins: Array, ends: Array) -> None:
        self._set_to, self._steady, self._components = set_to, steady, components
        self._forward, self._before = forward, before
        self._sampled, self._times, self._begins, self._ends = sampled, times, begins, ends

    def of(self, sets: Array, sensitivities: bool) -> Solved:
        instances = Instances(self._set_to, self._begins, self._components, sets, self._forward.free)
        more = {"time": (np.tile(self._begins, len(sets)), np.tile(self._ends, len(sets))),
                "samples": {"times": np.tile(self._times, (len(sets), 1)), "states": self._sampled}}
        if not self._steady.after.size and (self._steady.before < 0).all():
            run = _run(self._forward, instances, {}, sensitivities, more)
            return Solved(run, instances, np.zeros(instances.shape, bool))
        start, by_start, status = self._after_steady_states(instances, sets, sensitivities)
        lost: Array = np.logical_not(np.isfinite(start).all(axis=2))
        start[lost], by_start[lost] = instances.starts()[0][lost], 0.0
        given = self._given(instances, start, by_start, sensitivities)
        run = _run(self._forward, instances, given, sensitivities, more)
        solved = Solved(run, instances, lost, before_status=status)
        if self._steady.after.size:
            solved.after, solved.by_after, solved.after_status = self._settled(
                self._forward, instances, self._steady.after, start, by_start, sensitivities)
        return solved

    def _given(self, instances: Instances, start: Array, by_start: Array, sensitivities: bool) -> dict[str, Array]:
        """Initial values of states, and of their derivatives, as `solve` takes them."""
        states = self._components.states
        found = {name: np.ascontiguousarray(start[:, :, i].ravel()) for i, name in enumerate(states)}
        if sensitivities:
            spread = instances.spread(by_start)
            found |= {f"{name}_by_{varied}": np.ascontiguousarray(spread[:, :, i, k].ravel())
                      for i, name in enumerate(states) for k, varied in enumerate(instances.varied)}
        return found

    def _after_steady_states(self, instances: Instances, sets: Array, sensitivities: bool
                             ) -> tuple[Array, Array, Sequence[str]]:
        """Initial values of all conditions, those from steady states too, and their derivatives; and how the steady
        states ended."""
        start, by_start = instances.starts()
        status: Sequence[str] = ()
        steady = self._steady
        count = int(steady.before.max()) + 1
        if count:
            before = Instances(steady.set_to, np.zeros(count), self._components, sets, self._before.free)
            states, by_states, status = self._settled(self._before, before, np.arange(count), *before.starts(),
                                                      sensitivities)
            for i, name in enumerate(self._components.states):
                kept = np.flatnonzero((steady.before >= 0) & ~steady.reset.get(name, np.False_))
                start[:, kept, i] = states[:, steady.before[kept], i]
                by_start[:, kept, i] = by_states[:, steady.before[kept], i]
        return start, by_start, status

    def _settled(self, forward: Forward, instances: Instances, conditions: Array, start: Array, by_start: Array,
                 sensitivities: bool) -> tuple[Array, Array, Sequence[str]]:
        """The steady states that some conditions come to, NaN of the others, their derivatives, and their status."""
        sets, of_all, size, count = by_start.shape
        chosen = np.zeros((sets, of_all), bool)
        chosen[:, conditions] = True
        values = {name: v[chosen] for name, v in instances.values.items()}
        found = Equilibria(forward.model, values, start[chosen], forward.plain_options())
        states, by = np.full_like(start, np.nan), np.full_like(by_start, np.nan)
        states[chosen] = found.states
        if not sensitivities:
            return states, by, found.status
        chain = np.broadcast_to(instances.chain, (sets, of_all, len(instances.varied), count))
        by[chosen] = found.derivatives(instances.varied, chain[chosen], by_start[chosen])
        unknown = ~found.is_regular & np.isfinite(found.ends)
        if unknown.any():
            ends = np.ones((sets, of_all))
            ends[chosen] = np.where(unknown, found.ends, 1.0)
            run = _run(forward, instances, self._given(instances, start, by_start, True), True,
                       {"time": (0.0, ends.ravel())})
            integrated = np.stack([np.stack([run._values_of(f"{name}_by_{k}") for k in instances.varied], axis=1)
                                   for name in self._components.states], axis=1)
            integrated = integrated.reshape(sets, of_all, size, -1) @ chain
            there = np.zeros_like(chosen)
            there[chosen] = unknown
            by[there] = integrated[there]
        return states, by, found.status


def _run(forward: Forward, instances: Instances, start: Mapping[str, Array], sensitivities: bool,
         more: Mapping[str, Any]) -> Run:
    values = {name: np.ascontiguousarray(v.ravel()) for name, v in instances.values.items()}
    return forward.run({**values, **start}, sensitivities, size=instances.shape[0] * instances.shape[1], **more)
