# SPDX-License-Identifier: MIT
"""The likelihood of the data of several experiments, which share components or have their own: all experiments of all
sets of values are one ensemble."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from ..base.errors import Error
from ..gradients.forward import forward_of, refuse_chosen, tolerances
from ..models.components import Components, by_component, listed, unknown
from ..models.noise import refuse_derivatives
from ..sweeps.inputs import by_name, real
from .data import by_quantity, deviations, read_data
from .experiments import Experiment
from .measurements import Given, Measurements, Terms, added, censored_terms, normal_terms, sample_times
from .noise_models import NoiseModel
from .objective import Curve, Free, Objective
from .priors import Prior, terms_of

if TYPE_CHECKING:
    from ..models.any_model import AnyModel
    from ..results.run import Run
    from ..symbolic.types import Array, ByComponent, SomeComponents, Values

__all__ = ["Likelihood", "likelihood"]


class Likelihood(Objective):
    """What `my.fit` minimises for several experiments, noise models, limits or priors, for other optimisers and
    samplers: `loss`, `gradient`, `bounds`. Arguments are the values of the free components in the order of `names`, of
    one set, or of several in rows; all experiments of all sets are integrated as one ensemble.

    The loss is the negative logarithm of the likelihood and the priors. Without noise models, limits and priors it is
    half the sum of squares of (model - data) / sigma, and there are `residuals` and `jacobian`."""

    def __init__(self, model: AnyModel, data: Any, free: ByComponent, own: SomeComponents | None,
                 sweep: ByComponent | None, start: ByComponent | None, begin: float, sigma: Any, limits: Any,
                 priors: ByComponent | None, options: Mapping[str, Any]) -> None:
        refuse_derivatives(model, "fits")
        refuse_chosen(options, ("samples", "record", "phases", "size", "time"), "a fit")
        self.model = model
        self._components = Components(model)
        self._given = _experiments(data)
        #: the names of the experiments, in the order of the instances of a run
        self.experiments = [str(e.name) for e in self._given]
        self._begins = np.array([real(begin, "begin") if e.begin is None else e.begin for e in self._given])
        self._read(own, free)
        super().__init__(self._named)
        self._condition(sweep, start, options)
        self._measure(sigma, limits)
        self._priors = self._read_priors(priors)
        self._finish()

    # What is free, and what of it each experiment has.

    def _read(self, own: SomeComponents | None, given: ByComponent) -> None:
        """The free components: of an own one there is one for each experiment that has not a value of its own."""
        called = self._components.component
        bounds = {called(name): bounds for name, bounds in by_component(
            by_name(given, "free", "free={k: (0.1, 10, \"log\")}"), "free=").items()}
        if not bounds:
            raise Error("free= names no component: give those to fit with their bounds, as in free={k: (0.1, 10)}")
        self._own = [called(name) for name in listed(own)] if own is not None else []
        for name in self._own:
            if name not in bounds:
                raise unknown(name, list(bounds), "component of free=, for own=")
        if self._own and len(self._given) == 1:
            raise Error("own= is for several experiments, and there is one: leave it out")
        self._conditions = [{called(name): called(value) if isinstance(value, str) else value for name, value in
                             {**e.sweep, **e.start}.items()} for e in self._given]
        self._named: list[Free] = []
        self._number: dict[tuple[str, int], int] = {}  # of a free component in an experiment
        for name, range_ in bounds.items():
            if name not in self._own:
                self._number |= dict.fromkeys(((name, x) for x in range(len(self._given))), len(self._named))
                self._named.append(Free(name, range_))
                continue
            for x, experiment in enumerate(self.experiments):
                if name not in self._conditions[x]:
                    self._number[name, x] = len(self._named)
                    self._named.append(Free(f"{name}[{experiment}]", range_))
        self._bases = list(bounds)
        self._used: set[str] = set()

    def _resolved(self, value: Any, experiment: int, what: str) -> tuple[int, float]:
        """What a value stands for in an experiment: the number of a free component, or -1 and a number."""
        if not isinstance(value, str):
            return -1, float(value)
        if (value, experiment) not in self._number:
            if value in self._bases:
                raise Error(f"{what} is '{value}', of which experiment '{self.experiments[experiment]}' has a value of "
                            "its own: give a number")
            raise Error(f"{what} is '{value}', which free= does not have: give its bounds there, or a number")
        self._used.add(value)
        return self._number[value, experiment], 0.0

    def _condition(self, sweep: ByComponent | None, start: ByComponent | None, options: Mapping[str, Any]) -> None:
        """What each experiment sets components of the model to."""
        components, called = self._components, self._components.component
        common = {argument: {called(name): value for name, value in by_component(
            by_name(given, argument, f"{argument}={{B: 0.3}}"), f"{argument}=").items()}
                  for argument, given in (("sweep", sweep), ("start", start))}
        possible = components.of(("state", "parameter"))
        here = {name: None for conditions in self._conditions for name in conditions}
        for name in here:
            if name not in possible:
                if name in components.place:
                    raise Error(f"experiments set '{name}', which is no parameter or state: make it a parameter of the "
                                "model, as each experiment is an instance")
                raise unknown(name, possible, "parameter or state that an experiment can set")
        kinds = {name: "start" if name in components.states else "sweep" for name in [*here, *self._bases]}
        for e in self._given:
            for argument, given in (("sweep", e.sweep), ("start", e.start)):
                for name in map(called, given):
                    if kinds[name] != argument:
                        raise Error(f"'{name}' is in {argument}= of experiment '{e.name}': give it in {kinds[name]}=")
        names = [*here, *(name for name in self._bases if name in possible and name not in here)]
        self._set_to = {name: Given.of([self._value(name, x, common[kinds[name]]) for x in range(len(self._given))])
                        for name in names}
        self._varied = [name for name, given in self._set_to.items() if (given.free >= 0).any()]
        rest = {argument: {name: value for name, value in given.items() if name in self._bases or name not in here}
                for argument, given in common.items()}
        self._forward = forward_of(self.model, [n for n in self._bases if n in possible or n in components.place],
                                   rest["sweep"], rest["start"], options)
        sizes = {name: max(self.free[k].size for k in self._set_to[name].free if k >= 0) for name in self._varied}
        self._forward.free = self._varied
        self._forward.options["atol"] = tolerances(components, options, sizes)

    def _value(self, name: str, x: int, common: Mapping[str, Any]) -> tuple[int, float]:
        """What a component is in an experiment: the number of a free one, or -1 and a number."""
        what = f"'{name}' in experiment '{self.experiments[x]}'"
        if name in self._conditions[x]:
            return self._resolved(self._conditions[x][name], x, what)
        if name in self._bases:
            return self._resolved(name, x, what)
        value = common.get(name, self._components.defaults.get(name))
        if value is None or np.ndim(value) != 0 or not isinstance(value, (int, float, np.number, np.ndarray)):
            argument = "start" if name in self._components.states else "sweep"
            raise Error(f"experiment '{self.experiments[x]}' has no value of '{name}', which others set: give it in "
                        f"its {argument}=, or one for all that have none in {argument}= of the fit")
        return -1, float(value)

    # What was measured.

    def _measure(self, sigma: Any, limits: Any) -> None:
        """Takes data, deviations and limits."""
        components = self._components
        self._data = [read_data(components, e.data, begin, "data" if len(self._given) == 1 else
                                f"data of experiment '{e.name}'") for e, begin in zip(self._given, self._begins)]
        self._quantities = list(dict.fromkeys(name for data in self._data for name in data.values))
        self._ends = np.array([data.times.max() for data in self._data])
        self._times = sample_times([np.unique(data.times) for data in self._data], self._begins, self._ends)
        of_all = {what: by_quantity(components, given, self._quantities, what)
                  for what, given in (("sigma", sigma), ("limits", limits))}
        parts: dict[tuple[str, str], list[Measurements]] = {}
        without = with_sigma = False
        self._is_likelihood = False
        for x, (e, data) in enumerate(zip(self._given, self._data)):
            own = {what: {} if given is None else by_quantity(components, given, self._quantities, what)
                   for what, given in (("sigma", e.sigma), ("limits", e.limits))}
            for name in data.values:
                spec = own["sigma"].get(name, of_all["sigma"].get(name))
                low, high = _limits(own["limits"].get(name, of_all["limits"].get(name)), name)
                without, with_sigma = without or spec is None, with_sigma or spec is not None
                scale, additive, relative = self._noise(spec, x, name)
                rows = data.there[name]
                values = data.values[name][rows]
                side = np.where(values <= low, -1, np.where(values >= high, 1, 0))
                values = np.clip(values, low, high)
                if scale == "log" and not (values > 0).all():
                    raise Error(f"'{name}' in experiment '{e.name}' has values that are not positive, and log-normal "
                                "noise: give limits= if they are below a limit of quantification, or another noise "
                                "model")
                self._is_likelihood |= isinstance(spec, (str, NoiseModel)) or min(-low, high) < np.inf
                parts.setdefault((name, scale), []).append(Measurements(
                    name, scale, np.full(rows.size, x), np.searchsorted(self._times[x], data.times[rows]),
                    data.times[rows], values, side, additive, relative))
        if without and with_sigma:
            raise Error("sigma= is given for some data and not for others: give it for each quantity and experiment")
        if without and self._is_likelihood:
            raise Error("limits= need the deviations of the data: give sigma=, as numbers or as names in free=")
        self.has_sigma = not without
        self._measurements = [Measurements.joined(of) for _, of in sorted(
            parts.items(), key=lambda part: self._quantities.index(part[0][0]))]

    def _noise(self, spec: Any, x: int, name: str) -> tuple[str, Given, Given]:
        """The scale and both parts of the deviations of a quantity in an experiment."""
        data = self._data[x]
        count = data.there[name].size
        if isinstance(spec, str):
            spec = NoiseModel(spec)
        if isinstance(spec, NoiseModel):
            called = f"sigma of '{name}'"
            additive, relative = (Given.of([self._resolved(part, x, called)] * count)
                                  for part in (spec.additive, spec.relative))
            return spec.scale, additive, relative
        numbers = np.ones(count) if spec is None else deviations(spec, data, name)
        none = np.full(count, -1)
        return "lin", Given(none, numbers), Given(none, np.zeros(count))

    def _read_priors(self, given: ByComponent | None) -> list[tuple[int, Prior]]:
        """The priors and the numbers of the free components that have them."""
        found = []
        for key, prior in by_component(by_name(given, "priors", "priors={k: my.priors.normal(1, 0.1)}"),
                                       "priors=").items():
            name = self._components.component(key)
            if not isinstance(prior, Prior):
                raise Error(f"the prior of '{name}' is {prior!r}: give one of my.priors, as in "
                            f"{{{name}: my.priors.log_normal(1, 0.3)}}")
            numbers = [self.names.index(name)] if name in self.names else sorted(
                {k for (base, _), k in self._number.items() if base == name})
            if not numbers:
                raise unknown(name, [*self.names, *self._own], "free component, for priors=")
            found += [(k, prior) for k in numbers]
            for k in numbers:
                if self.free[k].least <= 0 and getattr(prior, "scale", "") == "log":
                    raise Error(f"the lower bound of '{name}' is {self.free[k].least:g}, and its prior is log-normal: "
                                "give a positive one")
        if found and not self.has_sigma:
            raise Error("priors= need the deviations of the data: give sigma=, as numbers or as names in free=")
        self._is_likelihood |= bool(found)
        return found

    def _finish(self) -> None:
        """Labels, and the refusal of what is free without a use."""
        for name in self._bases:
            if name not in self._used:
                possible = self._components.of(("state", "parameter"))
                if name in possible:
                    raise Error(f"'{name}' is in free=, and all experiments have values of their own: leave it out")
                raise unknown(name, possible, "component that free= can name, nor a name in sigma= or in an experiment")
        #: (experiment, quantity, time) of each residual; then ("noise", ...) of deviations that vary, and
        #: ("prior", name)
        self.labels: list[tuple[Any, ...]] = []
        for m in self._measurements:
            labels = [(self.experiments[x], m.quantity, float(t)) for x, t in zip(m.experiment, m.time)]
            exact = m.side == 0
            self.labels += [label for label, e in zip(labels, exact) if e]
            self.labels += [("noise", *label) for label, e, v in zip(labels, exact, m.varies) if e and v]
            self.labels += [label for label, e in zip(labels, exact) if not e]
        self.labels += [("prior", self.names[k]) for k, _ in self._priors]
        self._lost_to = ""

    # What follows from values of the free components.

    def _differentiated(self) -> AnyModel:
        return self.model

    def run(self, values: Values, sensitivities: bool = True) -> Run:
        """The run of one set of values, or of several in rows: an instance for each experiment of each set, those of
        one set one after the other."""
        return self._solve(np.atleast_2d(self._sets(values)), self._times, sensitivities)

    def _solve(self, sets: Array, times: Array, sensitivities: bool) -> Run:
        count = len(sets)
        samples: dict[str, Any] = {"times": np.tile(times, (count, 1))}
        if all(name in self._components.states for name in self._quantities):
            samples["states"] = self._quantities
        return self._forward.run(
            {name: np.ascontiguousarray(given.values(sets).ravel()) for name, given in self._set_to.items()},
            sensitivities, time=(np.tile(self._begins, count), np.tile(self._ends, count)),
            size=count * len(self.experiments), samples=samples)

    def _means(self, m: Measurements, run: Run, sets: Array) -> tuple[Array, Array]:
        """The model at measurements, [set, measurement], and its derivatives by the free components."""
        shape = len(sets), len(self.experiments), self._times.shape[1]
        mean = run._values_of(m.quantity).reshape(shape)[:, m.experiment, m.place]
        by_mean = np.zeros((*mean.shape, len(self.names)))
        if self._varied:
            of_model = run.sensitivity[m.quantity].reshape(*shape, len(self._varied))[:, m.experiment, m.place]
            for v, name in enumerate(self._varied):
                self._set_to[name].at(m.experiment).add_chain(by_mean, of_model[..., v])
        return mean, by_mean

    def evaluate(self, values: Values) -> tuple[Array, Array, Array]:
        """Of sets in rows the loss, and r and J in the order of `labels`, where J^T r is the gradient of the loss and
        J^T J approximates its second derivatives. NaN where the model has no solution."""
        sets = np.atleast_2d(self._sets(values))
        run = self.run(sets)
        terms: list[Terms] = []
        self._lost_to = ""
        with np.errstate(all="ignore"):
            for m in self._measurements:
                mean, by_mean = self._means(m, run, sets)
                if not self._is_likelihood:
                    sigma = m.additive.number
                    r = (mean - m.measured) / sigma
                    terms.append(Terms(0.5 * r**2, r, by_mean / sigma[:, None]))
                    continue
                found = self._terms_of(m, sets, mean, by_mean)
                terms += found
                if np.isfinite(mean).all() and not all(np.isfinite(of.loss).all() for of in found):
                    self._lost_to = m.quantity
        return added([*terms, *(terms_of(prior, sets, k) for k, prior in self._priors)])

    def _terms_of(self, m: Measurements, sets: Array, mean: Array, by_mean: Array) -> list[Terms]:
        """The terms of the likelihood of measurements, exact ones and then censored ones."""
        deviation, slope, *of_parts = m.deviation(sets, mean)
        by_deviation = slope[..., None] * by_mean
        for part, partial in zip((m.additive, m.relative), of_parts):
            part.add_chain(by_deviation, partial)
        found, exact = [], m.side == 0
        if exact.any():
            found.append(normal_terms(m.scale, m.measured[exact], mean[:, exact], by_mean[:, exact],
                                      deviation[:, exact], by_deviation[:, exact], m.varies[exact]))
        if not exact.all():
            cut = ~exact
            found.append(censored_terms(m.scale, m.measured[cut], m.side[cut], mean[:, cut], by_mean[:, cut],
                                        deviation[:, cut], by_deviation[:, cut]))
        return found

    def why_none(self) -> str:
        """Why there may be no loss, and what to do, where `evaluate` has found none at any start."""
        if not self._lost_to:
            return super().why_none()
        return (f"the likelihood of '{self._lost_to}' is zero at all starts, as where the model is zero or negative "
                "and noise is proportional or log-normal: leave such times out, or give my.noise_models.combined")

    @property
    def why_no_residuals(self) -> str:
        """Why the loss is no sum of squares; empty if it is one."""
        return ("noise models, limits and priors make the loss a likelihood, which is no sum of squares"
                if self._is_likelihood else "")

    def curves(self, values: Values) -> dict[str, list[Curve]]:
        """Data and model of each quantity in each experiment that has it, for one set of values; the model at times
        between those of the data too."""
        sets = np.atleast_2d(self._sets(values))
        smooth = np.linspace(self._begins, self._ends, 400, axis=1)
        run, at_data = self._solve(sets, smooth, False), self._solve(sets, self._times, False)
        units, t_label = self._components.units, f"t ({run.time_unit})" if run.time_unit else "t"
        found: dict[str, list[Curve]] = {name: [] for name in self._quantities}
        for m in self._measurements:
            mean = at_data._values_of(m.quantity)[m.experiment, m.place]
            deviation = m.deviation(sets, mean[None])[0][0]
            for x in np.unique(m.experiment):
                rows = m.experiment == x
                found[m.quantity].append(Curve(
                    self.experiments[x] if len(self.experiments) > 1 else "", m.time[rows], m.measured[rows],
                    m.side[rows], deviation[rows] if self.has_sigma and m.scale == "lin" else None, smooth[x],
                    run._values_of(m.quantity)[x], t_label,
                    f"{m.quantity} ({units[m.quantity]})" if m.quantity in units else m.quantity))
        return found


def _limits(given: Any, name: str) -> tuple[float, float]:
    """The limits of quantification of a quantity, infinite where there is none."""
    if given is None:
        return -np.inf, np.inf
    if not isinstance(given, (tuple, list)) or len(given) != 2:
        raise Error(f"limits= of '{name}' is {given!r}: give the lower and the upper one, None where there is none, as "
                    "in (0.1, None)")
    low, high = (default if limit is None else real(limit, f"a limit of '{name}'")
                 for limit, default in zip(given, (-np.inf, np.inf)))
    if not low < high:
        raise Error(f"limits= of '{name}' are {low:g} and {high:g}: give the lower one first")
    return low, high


def _experiments(data: Any) -> list[Experiment]:
    """Experiments with names, from one, a list, or the data of one."""
    given = list(data) if isinstance(data, (list, tuple)) else [data]
    if not given:
        raise Error("the list of experiments is empty: give at least one my.experiment(data)")
    found = []
    for number, one in enumerate(given, 1):
        e = one if isinstance(one, Experiment) else Experiment(one, None, None, None, None, None, None)
        found.append(Experiment(e.data, number if e.name is None else e.name, e.sweep, e.start, e.begin, e.sigma,
                                e.limits))
    names = [e.name for e in found]
    for name in names:
        if names.count(name) > 1:
            raise Error(f"there are {names.count(name)} experiments with the name '{name}': give each its own name=")
    return found


def likelihood(model: AnyModel, data: Any, *, free: ByComponent, own: SomeComponents | None = None,
               sweep: ByComponent | None = None, start: ByComponent | None = None, begin: float = 0.0,
               sigma: Any = None, limits: Any = None, priors: ByComponent | None = None,
               **options: Any) -> Likelihood:
    """The likelihood of the data of one experiment or several, for optimisers and samplers of other packages; arguments
    as of `fit`. It has `loss`, the negative logarithm of likelihood and priors, `gradient` and `bounds`."""
    return Likelihood(model, data, free, own, sweep, start, begin, sigma, limits, priors, options)
