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
from ...inference.measurements import Given, Terms, added, normal_loss, normal_terms, sample_times
from ...inference.objective import Free, Objective
from ...inference.priors import Prior, terms_of
from ...models.components import Components
from ...symbolic.derivatives import derivatives
from ...symbolic.evaluate import evaluate
from ...symbolic.node import Node, symbols_of
from ...symbolic.symbols import time
from ..sbml.model import SbmlModel

if TYPE_CHECKING:
    from ...models.any_model import AnyModel
    from ...results.run import Run
    from ...symbolic.types import Array, Values

__all__ = ["PetabLikelihood"]


@dataclass
class Observed:
    """An observable and its measurements: formulas of it and of its noise, the scale on which the noise is normally
    distributed, the rows of the table of measurements, and what each sets the placeholders to, by component."""

    name: str
    value: Node
    noise: Node
    scale: str
    rows: Array
    placeholders: dict[str, Given]


@dataclass
class Experiment:
    """The tables of a problem: `set_to` by component of the model has a value for each condition, the arrays one for
    each measurement."""

    model: SbmlModel
    free: list[Free]
    conditions: list[str]
    set_to: dict[str, Given]
    condition: Array
    time: Array
    measured: Array
    observables: list[Observed]
    priors: list[tuple[int, Prior]]


class _Instances:
    """The parameters of a model for sets of the free components, and their derivatives by these. `values` are by
    component, [set, condition]; `chain`, [set or 1, condition, component, free component]."""

    def __init__(self, experiment: Experiment, components: Components, sets: Array, varied: Sequence[str]) -> None:
        count, shape = len(experiment.free), (len(sets), len(experiment.conditions))
        own = {name: given for name, given in experiment.set_to.items() if name in components.place}
        self.values = {name: given.values(sets) for name, given in own.items()}
        chain = {name: (given.free[:, None] == np.arange(count)).astype(float)[None] for name, given in own.items()}
        derived = [name for name in varied if name not in own]
        completed = components.completed({n: v.ravel() for n, v in self.values.items()}, 0.0) if derived else {}
        self.values |= {n: np.broadcast_to(completed[n], shape[0] * shape[1]).reshape(shape) for n in derived}

        def of(name: str) -> Any:
            if name not in chain:
                default: Any = components.defaults.get(name)
                symbols = [s for s in symbols_of([default]) if s is not time] if isinstance(default, Node) else []
                partials = (derivatives([default], symbols) or [{}])[0] if symbols else {}
                known = {s: completed[s.value[1]] for s in symbols} | {time: 0.0}
                chain[name] = sum((np.broadcast_to(evaluate([partial], known)[0], shape[0] * shape[1]).reshape(
                    *shape, 1) * of(symbols[i].value[1]) for i, partial in partials.items()), np.zeros((1, 1, count)))
            return chain[name]

        self.of = of
        parts = [of(name) for name in varied]
        self.chain = np.stack(np.broadcast_arrays(*parts), axis=-2) if parts else np.zeros((1, shape[1], 0, count))


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
        of_free = [n for n, given in experiment.set_to.items() if n in components.place and (given.free >= 0).any()]
        derived = [n for n in components.names["parameter"] if n not in experiment.set_to
                   and components.follows(n, of_free, list(experiment.set_to))]
        self._varied = [*of_free, *derived]
        formulas = [f for o in experiment.observables for f in (o.value, o.noise)]
        read = {s.value[1] for s in symbols_of(formulas) if s is not time and s.value[0] == "state"}
        self._sampled = [n for n in components.states if n in read] or components.states[:1]
        of_conditions = [np.unique(experiment.time[experiment.condition == c]) for c in range(len(self.conditions))]
        self._ends = np.array([t[-1] if t[-1] > 0 else 1.0 for t in of_conditions])
        self._times = sample_times(of_conditions, np.zeros(len(self._ends)), self._ends)
        self._place = np.array([np.searchsorted(self._times[c], t)
                                for c, t in zip(experiment.condition, experiment.time)])
        self._estimated = {o.name: self._noise_varies(o) for o in experiment.observables}
        self.noise_is_estimated = any(varies.any() for varies in self._estimated.values())  #: or depends on the model
        self._forward = Forward(self._model, self._varied, {}, {}, {
            **options, "atol": tolerances(components, options, {n: self._size_of(n) for n in self._varied})})
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

    def _size_of(self, name: str) -> float:
        """How large a parameter of the model may be."""
        given = self._experiment.set_to.get(name)
        return max((self.free[k].size for k in given.free if k >= 0), default=1.0) if given is not None else 1.0

    def _differentiated(self) -> AnyModel:
        return self._model

    def run(self, values: Values, sensitivities: bool = True) -> Run:
        """The run of one set of values, or of several in rows: an instance for each condition of each set, those of one
        set one after the other, with derivatives by the parameters of the model."""
        return self._solve(np.atleast_2d(self._sets(values)), sensitivities)[0]

    def _solve(self, sets: Array, sensitivities: bool) -> tuple[Run, _Instances]:
        instances = _Instances(self._experiment, self._components, sets, self._varied)
        samples = {"times": np.tile(self._times, (len(sets), 1)), "states": self._sampled}
        run = self._forward.run({n: np.ascontiguousarray(v.ravel()) for n, v in instances.values.items()},
                                sensitivities, time=(0.0, np.tile(self._ends, len(sets))),
                                size=len(sets) * len(self.conditions), samples=samples)
        return run, instances

    def evaluate(self, values: Values) -> tuple[Array, Array, Array]:
        """Of sets in rows the loss, and r and J in the order of `labels`, where J^T r is the gradient of the loss and
        J^T J the Fisher information. NaN where the model has no solution."""
        sets = np.atleast_2d(self._sets(values))
        run, instances = self._solve(sets, True)
        terms: list[Terms] = []
        with np.errstate(all="ignore"):
            for o in self._experiment.observables:
                known = self._known(o, run, instances, sets)
                mean, deviation = self._distribution(o, known)
                by_mean, by_noise = self._derivatives(o, run, instances, known)
                terms.append(normal_terms(o.scale, self._measured(o), mean, by_mean, deviation, by_noise,
                                          self._estimated[o.name]))
            terms += [terms_of(prior, sets, k) for k, prior in self._experiment.priors]
        return added(terms)

    def simulate(self, values: Values) -> Array:
        """The observables at the measurements, in the order of their table, of one set or of sets in rows."""
        sets = np.atleast_2d(self._sets(values))
        run, instances = self._solve(sets, False)
        found = np.empty((len(sets), self._experiment.time.size))
        for o in self._experiment.observables:
            found[:, o.rows] = evaluate([o.value], self._known(o, run, instances, sets))[0]
        return found[0] if np.ndim(values) == 1 else found

    def log_likelihood(self, values: Values) -> Any:
        """The logarithm of the likelihood, as petab's calculate_llh defines it, of one set or of sets in rows; without
        priors."""
        sets = np.atleast_2d(self._sets(values))
        run, instances = self._solve(sets, False)
        with np.errstate(all="ignore"):
            found = -sum(normal_loss(o.scale, self._measured(o), *self._distribution(
                o, self._known(o, run, instances, sets))).sum(axis=1) for o in self._experiment.observables)
        return found[0] if np.ndim(values) == 1 else found

    @property
    def why_no_residuals(self) -> str:
        """Why the loss is no sum of squares; empty if it is one."""
        return ("the noise depends on what is estimated, and the likelihood is no sum of squares"
                if self.noise_is_estimated else "")

    def _measured(self, o: Observed) -> Array:
        return self._experiment.measured[o.rows]

    def _known(self, o: Observed, run: Run, instances: _Instances, sets: Array) -> dict[Any, Array]:
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
                known[symbol] = self._at(run._values_of(name), o, len(sets))
            elif given is not None:
                known[symbol] = given.values(sets)
            elif name in instances.values:
                known[symbol] = instances.values[name][:, condition]
            elif symbol in self._components.constants:
                known[symbol] = np.full(shape, self._components.constants[symbol])
            else:
                known[symbol] = run._values_of(name).reshape(len(sets), -1)[:, condition]
        return known

    def _at(self, samples: Array, o: Observed, count: int) -> Array:
        """Samples at the measurements of an observable."""
        by_condition = samples.reshape(count, len(self.conditions), -1)
        return by_condition[:, self._experiment.condition[o.rows], self._place[o.rows]]

    def _distribution(self, o: Observed, known: dict[Any, Array]) -> tuple[Array, Array]:
        """Mean and standard deviation of the measurements of an observable, NaN where that is not positive."""
        shape = next(iter(known.values())).shape if known else (1, o.rows.size)
        mean, deviation = (np.broadcast_to(f, shape) for f in evaluate([o.value, o.noise], known))
        return mean, np.where(deviation > 0, deviation, np.nan)

    def _derivatives(self, o: Observed, run: Run, instances: _Instances, known: dict[Any, Array]
                     ) -> tuple[Array, Array]:
        """Derivatives by the free components of the mean and the deviation, [set, measurement, free component]."""
        symbols = [s for s in known if s is not time]
        partials = derivatives([o.value, o.noise], symbols)
        if partials is None:
            raise Error(f"observable '{o.name}' has no derivatives")
        of_mean, of_deviation = (self._chained(o, of, symbols, run, instances, known) for of in partials)
        return of_mean, of_deviation

    def _chained(self, o: Observed, partials: Mapping[int, Node], symbols: Sequence[Any], run: Run,
                 instances: _Instances, known: dict[Any, Array]) -> Array:
        """The derivatives of a formula by the chain rule."""
        sets, condition = run.size // len(self.conditions), self._experiment.condition[o.rows]
        shape = sets, o.rows.size
        found = np.zeros((*shape, len(self.names)))
        by_model = np.zeros((*shape, len(self._varied)))
        for i, expression in partials.items():
            kind, name = symbols[i].value
            partial = np.broadcast_to(evaluate([expression], known)[0], shape)
            given = self._given(name, o)
            if kind == "state":
                for d, wrt in enumerate(self._varied):
                    by_model[..., d] += partial * self._at(run._values_of(f"{name}_by_{wrt}"), o, sets)
            elif given is not None:
                given.add_chain(found, partial)
            elif name in self._varied:
                by_model[..., self._varied.index(name)] += partial
        for c in range(len(self.conditions)):
            rows = np.flatnonzero(condition == c)
            if rows.size and self._varied:
                found[:, rows] += by_model[:, rows] @ instances.chain[:, c]
        return found
