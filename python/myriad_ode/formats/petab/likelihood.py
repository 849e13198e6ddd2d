# SPDX-License-Identifier: MIT
"""The likelihood of a problem of PEtab and its derivatives; all conditions of all sets of parameters are one ensemble.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from ...base.errors import Error
from ...gradients.forward import Forward, refuse_chosen, tolerances
from ...inference.measurements import Given, Terms, added, losses, sample_times, terms as noise_terms
from ...inference.objective import Free, Objective
from ...inference.priors import Prior, terms_of
from ...models.components import Components
from ...symbolic.derivatives import derivatives
from ...symbolic.evaluate import evaluate
from ...symbolic.node import Node, symbols_of
from ...symbolic.symbols import time
from ..sbml.model import SbmlModel
from .solutions import Solutions, Solved, SteadyStates, varied_by

if TYPE_CHECKING:
    from ...models.any_model import AnyModel
    from ...results.run import Run
    from ...symbolic.types import Array, Values

__all__ = ["PetabLikelihood"]


@dataclass
class Observed:
    """An observable and its measurements: formulas of it and of its noise, the distribution of that, "normal" or
    "laplace", and the scale on which it has that, the rows of the table of measurements, and what each sets the
    placeholders to, by component."""

    name: str
    value: Node
    noise: Node
    distribution: str
    scale: str
    rows: Array
    placeholders: dict[str, Given]


@dataclass
class Experiment:
    """The tables of a problem: `set_to` by component of the model has a value for each condition, the arrays one for
    each measurement, whose time is infinite in a steady state. Conditions after different steady states are several;
    `begins` has the time at which each begins. `sampled` are the times at which measurements are sampled, after what
    happens at `time`."""

    model: SbmlModel
    free: list[Free]
    conditions: list[str]
    set_to: dict[str, Given]
    condition: Array
    time: Array
    sampled: Array
    measured: Array
    observables: list[Observed]
    priors: list[tuple[int, Prior]]
    steady: SteadyStates
    begins: Array


class PetabLikelihood(Objective):
    """The negative logarithm of the likelihood of a problem of PEtab, and of its priors. Where noise depends on what is
    estimated, J^T J of `evaluate` is the Fisher information, of means and deviations: of a measurement with mean m and
    deviation s (dm / s)^2 + 2 (ds / s)^2, whose second part takes a row of its own in J."""

    def __init__(self, experiment: Experiment, options: Mapping[str, Any]) -> None:
        super().__init__(experiment.free)
        refuse_chosen(options, ("samples", "record", "phases", "free", "size", "start", "time"),
                      "a problem of PEtab")
        self._experiment, self._model = experiment, experiment.model
        self._components = components = Components(self._model)
        self._own_names = {component: name for name, component in self._model.aliases.items()}
        self.conditions = experiment.conditions  #: the names of the conditions, in the order of the instances of a run
        self._varied = varied_by(experiment.set_to, components)
        formulas = [f for o in experiment.observables for f in (o.value, o.noise)]
        read = {s.value[1] for s in symbols_of(formulas) if s is not time and s.value[0] == "state"}
        self._sampled = [n for n in components.states if n in read] or components.states[:1]
        self._is_steady = np.isinf(experiment.time)
        of_conditions = [np.unique(experiment.sampled[(experiment.condition == c) & ~self._is_steady])
                         for c in range(len(self.conditions))]
        begins = experiment.begins
        of_conditions = [t if t.size else np.array([begin + 1.0])  # where all is measured in a steady state
                         for t, begin in zip(of_conditions, begins)]
        ends = np.array([t[-1] if t[-1] > begin else begin + 1.0 for t, begin in zip(of_conditions, begins)])
        times = sample_times(of_conditions, begins, ends)
        self._place = np.array([np.searchsorted(times[c], t) for c, t in zip(experiment.condition, experiment.sampled)])
        self._estimated = {o.name: self._noise_varies(o) for o in experiment.observables}
        self.noise_is_estimated = any(varies.any() for varies in self._estimated.values())  #: or depends on the model
        self._forward, before = (Forward(self._model, varied, {}, {}, {
            **options, "atol": tolerances(components, options, {n: self._size_of(n, set_to) for n in varied})})
            for set_to, varied in ((experiment.set_to, self._varied),
                                   (experiment.steady.set_to, varied_by(experiment.steady.set_to, components))))
        self._solutions = Solutions(experiment.set_to, experiment.steady, components, self._forward, before,
                                    self._sampled, times, begins, ends)
        #: (observable, condition, time) of each residual; then of the noise that is estimated; then ("prior", name)
        self.labels: list[tuple[Any, ...]] = []
        for o in experiment.observables:
            of_rows = [(o.name, self.conditions[experiment.condition[r]], float(experiment.time[r])) for r in o.rows]
            self.labels += of_rows
            self.labels += [("noise", *label) for label, varies in zip(of_rows, self._estimated[o.name]) if varies]
        self.labels += [("prior", self.names[k]) for k, _ in experiment.priors]

    def _noise_varies(self, o: Observed) -> Array:
        """Whether the noise of each measurement of an observable depends on what is estimated."""
        varies = np.zeros(o.rows.size, bool)
        for symbol in symbols_of([o.noise]):
            if symbol is time:
                continue
            kind, name = symbol.value
            given = self._given(name, o)
            varies |= kind == "state" or name in self._varied or given is not None and given.free >= 0
        return varies

    def _given(self, name: str, o: Observed) -> Given | None:
        """What the measurements of an observable set a parameter to, or None if it follows from others."""
        if name in o.placeholders:
            return o.placeholders[name]
        given = self._experiment.set_to.get(name)
        return None if given is None else given.at(self._experiment.condition[o.rows])

    def _size_of(self, name: str, set_to: Mapping[str, Given]) -> float:
        """How large a parameter of the model may be."""
        given = set_to.get(name)
        return max((self.free[k].size for k in given.free if k >= 0), default=1.0) if given is not None else 1.0

    def _differentiated(self) -> AnyModel:
        return self._model

    def run(self, values: Values, sensitivities: bool = True) -> Run:
        """The run of one set of values, or of several in rows: an instance for each condition of each set, those of one
        set one after the other, with derivatives by the parameters of the model."""
        return self._solutions.of(np.atleast_2d(self._sets(values)), sensitivities).run

    def evaluate(self, values: Values) -> tuple[Array, Array, Array]:
        """Of sets in rows the loss, and r and J in the order of `labels`, where J^T r is the gradient of the loss and
        J^T J the Fisher information. NaN where the model has no solution."""
        sets = np.atleast_2d(self._sets(values))
        solved = self._solutions.of(sets, True)
        terms: list[Terms] = []
        with np.errstate(all="ignore"):
            for o in self._experiment.observables:
                known = self._known(o, solved, sets)
                mean, deviation = self._distribution(o, known)
                by_mean, by_noise = self._derivatives(o, solved, known)
                terms.append(noise_terms[o.distribution](o.scale, self._measured(o), mean, by_mean, deviation, by_noise,
                                                         self._estimated[o.name]))
            terms += [terms_of(prior, sets, k) for k, prior in self._experiment.priors]
        return added(terms)

    def simulate(self, values: Values) -> Array:
        """The observables at the measurements, in the order of their table, of one set or of sets in rows."""
        sets = np.atleast_2d(self._sets(values))
        solved = self._solutions.of(sets, False)
        found = np.empty((len(sets), self._experiment.time.size))
        for o in self._experiment.observables:
            found[:, o.rows] = evaluate([o.value], self._known(o, solved, sets))[0]
        return found[0] if np.ndim(values) == 1 else found

    def log_likelihood(self, values: Values) -> Any:
        """The logarithm of the likelihood, as petab's calculate_llh defines it, of one set or of sets in rows; without
        priors."""
        sets = np.atleast_2d(self._sets(values))
        solved = self._solutions.of(sets, False)
        with np.errstate(all="ignore"):
            found = -sum(losses[o.distribution](o.scale, self._measured(o), *self._distribution(
                o, self._known(o, solved, sets))).sum(axis=1) for o in self._experiment.observables)
        return found[0] if np.ndim(values) == 1 else found

    def steady_states(self, values: Values) -> dict[str, str]:
        """What became of each steady state for one set of values, by the name of the condition that comes before
        others, or is measured at the time inf: "steady state", "no steady state", or the status with which an
        integration failed. Where there is none the likelihood is NaN. Empty for a problem without steady states."""
        solved = self._solutions.of(self._sets(values)[None], False)
        after = [self.conditions[c] for c in self._experiment.steady.after]
        return {**dict(zip(self._experiment.steady.names, solved.before_status)),
                **dict(zip(after, solved.after_status))}

    @property
    def why_no_residuals(self) -> str:
        """Why the loss is no sum of squares; empty if it is one."""
        if any(o.distribution != "normal" for o in self._experiment.observables):
            return "the noise has Laplace's distribution, and the likelihood is no sum of squares"
        return ("the noise depends on what is estimated, and the likelihood is no sum of squares"
                if self.noise_is_estimated else "")

    def _measured(self, o: Observed) -> Array:
        return self._experiment.measured[o.rows]

    def _known(self, o: Observed, solved: Solved, sets: Array) -> dict[Any, Array]:
        """The values of all symbols of an observable and its noise at its measurements, [set, measurement]."""
        shape = len(sets), o.rows.size
        condition = self._experiment.condition[o.rows]
        known: dict[Any, Array] = {}
        for symbol in symbols_of([o.value, o.noise]):
            if symbol is time:
                known[symbol] = np.broadcast_to(self._experiment.time[o.rows], shape)
                continue
            kind, name = symbol.value
            given = self._given(name, o)
            if kind == "state":
                known[symbol] = solved.at(name, condition, self._place[o.rows])
            elif given is not None:
                known[symbol] = given.values(sets)
            elif name in solved.instances.values:
                known[symbol] = solved.instances.values[name][:, condition]
            elif symbol in self._components.constants:
                known[symbol] = np.full(shape, self._components.constants[symbol])
            else:
                known[symbol] = solved.run._values_of(name).reshape(len(sets), -1)[:, condition]
        return known

    def _distribution(self, o: Observed, known: dict[Any, Array]) -> tuple[Array, Array]:
        """Mean and standard deviation, or median and width, of the measurements of an observable, NaN where the second
        is not positive."""
        shape = next(iter(known.values())).shape if known else (1, o.rows.size)
        mean, deviation = (np.broadcast_to(f, shape) for f in evaluate([o.value, o.noise], known))
        return mean, np.where(deviation > 0, deviation, np.nan)

    def _derivatives(self, o: Observed, solved: Solved, known: dict[Any, Array]) -> tuple[Array, Array]:
        """Derivatives by the free components of the mean and the deviation, [set, measurement, free component]."""
        symbols = [s for s in known if s is not time]
        partials = derivatives([o.value, o.noise], symbols)
        if partials is None:
            raise Error(f"observable '{o.name}' has no derivatives")
        of_mean, of_deviation = (self._chained(o, of, symbols, solved, known) for of in partials)
        return of_mean, of_deviation

    def _chained(self, o: Observed, partials: Mapping[int, Node], symbols: Sequence[Any], solved: Solved,
                 known: dict[Any, Array]) -> Array:
        """The derivatives of a formula by the chain rule."""
        condition, place = self._experiment.condition[o.rows], self._place[o.rows]
        shape = solved.instances.shape[0], o.rows.size
        steady = np.flatnonzero(self._is_steady[o.rows])
        found = np.zeros((*shape, len(self.names)))
        by_model = np.zeros((*shape, len(self._varied)))
        for i, expression in partials.items():
            kind, name = symbols[i].value
            partial = np.broadcast_to(evaluate([expression], known)[0], shape)
            given = self._given(name, o)
            if kind == "state":
                for d, wrt in enumerate(self._varied):
                    by_model[..., d] += partial * solved.derivative_at(name, wrt, condition, place)
                if steady.size and solved.by_after is not None:
                    by = solved.by_after[:, condition[steady], self._components.states.index(name)]
                    found[:, steady] += partial[:, steady, None] * by
            elif given is not None:
                given.add_chain(found, partial)
            elif name in self._varied:
                by_model[..., self._varied.index(name)] += partial
        for c in range(len(self.conditions)):
            rows = np.flatnonzero(condition == c)
            if rows.size and self._varied:
                found[:, rows] += by_model[:, rows] @ solved.instances.chain[:, c]
        return found
