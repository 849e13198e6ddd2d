# SPDX-License-Identifier: MIT
"""Least squares of a model and data: residuals and their derivatives, for many sets of parameters at once."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from ..base import component_kinds as kinds
from ..base.errors import Error
from ..base.statuses import status_names
from ..gradients.adjoint import Adjoint
from ..models.components import Components, by_component, unknown
from ..solving.core_options import per_state
from ..solving.options import Options
from ..solving.solve import solve
from ..sweeps.inputs import by_name, real
from ..symbolic.symbols import time
from .objective import Free, Objective

if TYPE_CHECKING:
    from ..models.any_model import AnyModel
    from ..results.run import Run
    from ..symbolic.types import Array, ByComponent, Values

__all__ = ["LeastSquares", "least_squares"]

_time_names = ("t", "time")


class LeastSquares(Objective):
    """The residuals (model - data) / sigma of a model and data, for `my.fit` and for other optimisers, as in
    `scipy.optimize.least_squares(problem.residuals, start, problem.jacobian, bounds=problem.bounds)`. Arguments are
    the values of the free components in the order of `names`, of one set, or of several in rows, which are integrated
    as one ensemble; residuals are in the order of `labels`."""

    def __init__(self, model: AnyModel, data: Any, free: ByComponent, sweep: ByComponent | None,
                 start: ByComponent | None, begin: float, sigma: Any, options: Mapping[str, Any],
                 adjoint: bool = False) -> None:
        self.model = model
        self._components = components = Components(model)
        super().__init__([Free(components.component(name), bounds) for name, bounds in by_component(
            by_name(free, "free", "free={k: (0.1, 10, \"log\")}"), "free=").items()])
        if not self.free:
            raise Error("free= names no component: give those to fit with their bounds, as in free={k: (0.1, 10)}")
        possible = components.of(("state", "parameter"))
        for name in self.names:
            if components.place.get(name, ("",))[0] in kinds.shared:
                raise Error(f"'{name}' is shared by all instances, and each start of a fit has its own value: make it "
                            "a parameter of the model")
            if name not in possible:
                raise unknown(name, possible, "component that a fit can determine")
        self._sweep = by_component(by_name(sweep, "sweep", "sweep={B: 0.3}"), "sweep=")
        self._start = by_component(by_name(start, "start", "start={x: 1}"), "start=")
        for name in self.names:
            if name in self._sweep or name in self._start:
                raise Error(f"'{name}' is free and has a value: give it in free= alone")
        for where, values in (("sweep", self._sweep), ("start", self._start)):
            for name, value in values.items():
                if np.ndim(value) != 0:
                    raise Error(f"'{name}' has several values in {where}=: a fit has one of each component that is not "
                                "free")
        for name in ("samples", "record", "phases", "sensitivities", "size"):
            if name in options:
                raise Error(f"a fit chooses {name}= itself: leave it out")
        self._options = {**options, "atol": self._tolerances(options)}
        self._begin = real(begin, "begin")
        self._read(data, sigma)
        self._adjoint = self._make_adjoint() if adjoint else None
        self._last_gradient: tuple[Any, ...] = ()

    def _differentiated(self) -> AnyModel:
        return self.model

    def _make_adjoint(self) -> Adjoint:
        return Adjoint(self.model, self.names, list(self.data), self._sweep, self._start,
                       {**self._plain_options(), "time": (self._begin, float(self.times[-1]))}, self.times)

    def _plain_options(self) -> dict[str, Any]:
        """The options of a call without sensitivities."""
        return {**self._options, "atol": {c: t for c, t in self._options["atol"].items()
                                          if c in self._components.states}}

    def _tolerances(self, options: Mapping[str, Any]) -> dict[str, float]:
        """Absolute tolerances of states, and of their derivatives, whose product with a free component is to be as
        accurate as the state."""
        known = options.get("options") or Options()
        given = options.get("atol", known.atol)
        states = self._components.states
        values = per_state(given, self._components, "atol", len(states))
        of_states = dict(zip(states, values * len(states) if len(values) == 1 else values))
        return {**of_states, **{f"{c}_by_{f.name}": tolerance / max(1.0, abs(f.least), abs(f.most))
                                for f in self.free for c, tolerance in of_states.items()}}

    def _read(self, data: Any, sigma: Any) -> None:
        """Takes times, values and their standard deviations."""
        if not hasattr(data, "items"):
            raise Error(f"data is a {type(data).__name__}: give a dict or a data frame with times and values by name, "
                        "as in {\"t\": times, x: values}")
        components = self._components
        columns = {}
        for key, values in data.items():
            is_time = key is time or isinstance(key, str) and key in _time_names and key not in components.place
            name = "t" if is_time else components.component(key)
            if name in columns:
                raise Error(f"data has '{name}' twice: give it once")
            try:
                columns[name] = np.asarray(values, float)
            except (TypeError, ValueError):
                raise Error(f"data of '{name}' has values that are no numbers: give numbers, NaN where there is none"
                            ) from None
        times = columns.pop("t", None)
        if times is None:
            raise Error("data has no times: give them as \"t\"")
        if not columns:
            raise Error("data has times alone: give values by the names of states or outputs")
        possible = [*components.states, *components.outputs]
        for name, values in columns.items():
            if name not in possible:
                raise unknown(name, possible, "state or output of the model, which data are compared with")
            if values.shape != times.shape or values.ndim != 1:
                raise Error(f"data has {values.size} values of '{name}' and {times.size} times: give one for each "
                            "time, NaN where there is none")
            if np.isinf(values).any() or np.isnan(values).all():
                raise Error(f"data of '{name}' has infinite values, or none: give numbers, NaN where there is none")
        if not np.isfinite(times).all() or (times < self._begin).any():
            wrong = times[~(np.isfinite(times) & (times >= self._begin))][0]
            raise Error(f"data has the time {wrong:g}, and the model begins at {self._begin:g}: give finite times from "
                        "there on, or begin=")
        if not (times > self._begin).any():
            raise Error(f"all times of data are {self._begin:g}, where the model begins: give later ones too")
        self.data = columns
        self.times, where = np.unique(times, return_inverse=True)
        self._there = {name: np.flatnonzero(~np.isnan(values)) for name, values in columns.items()}
        self._where = {name: where[there] for name, there in self._there.items()}
        #: (name, time) of each residual
        self.labels = [(name, float(times[i])) for name, there in self._there.items() for i in there]
        self.has_sigma = sigma is not None
        given = by_component(sigma, "sigma=") if hasattr(sigma, "items") else dict.fromkeys(columns, sigma)
        for name in given:
            if components.component(name) not in columns:
                raise unknown(components.component(name), list(columns), "quantity in data")
        deviations = []
        for name, there in self._there.items():
            of_name = given.get(name)
            if of_name is None and self.has_sigma:
                raise Error(f"sigma= has none for '{name}': give the standard deviation of each quantity in data")
            values = np.asarray(1.0 if of_name is None else of_name, float)
            if values.ndim > 1 or values.ndim == 1 and values.shape != times.shape:
                raise Error(f"sigma of '{name}' has {values.size} values for {times.size} times: give one, or one for "
                            "each time")
            values = np.broadcast_to(values, times.shape)[there]
            if not (np.isfinite(values) & (values > 0)).all():
                raise Error(f"sigma of '{name}' has values that are not positive: give standard deviations")
            deviations.append(values)
        self._sigma = np.concatenate(deviations)
        self._observed = np.concatenate([columns[name][there] for name, there in self._there.items()])

    def run(self, values: Values, sensitivities: bool = True) -> Run:
        """The run of one set of values, or of several in rows."""
        sets = np.atleast_2d(self._sets(values))
        given = {name: np.ascontiguousarray(sets[:, i]) for i, name in enumerate(self.names)}
        states = [name for name in self.data if name in self._components.states]
        samples: dict[str, Any] = {"times": self.times}
        if len(states) == len(self.data):
            samples["states"] = states
        initial = {name: value for name, value in given.items() if name in self._components.states}
        options = self._options if sensitivities else self._plain_options()
        return solve(self.model, {**self._sweep, **{n: v for n, v in given.items() if n not in initial}},
                     start={**self._start, **initial}, time=(self._begin, float(self.times[-1])), samples=samples,
                     sensitivities=self.names if sensitivities else None, **options)

    def evaluate(self, values: Values) -> tuple[Array, Array, Array]:
        """Of sets in rows the loss, residuals, [set, residual], and their derivatives by the free components, one more
        axis. NaN where the model has no solution up to a time of the data."""
        run = self.run(values)
        ended = run.status > status_names.index("success")
        residuals = np.concatenate([run[n][:, w] for n, w in self._where.items()], axis=1)
        jacobian = np.concatenate([run.sensitivity[n][:, w] for n, w in self._where.items()], axis=1)
        residuals = (residuals - self._observed) / self._sigma
        jacobian /= self._sigma[:, None]
        lost = ended & ~np.isfinite(residuals).all(axis=1)
        residuals[lost] = jacobian[lost] = np.nan
        with np.errstate(over="ignore", invalid="ignore"):
            return 0.5 * np.sum(residuals * residuals, axis=1), residuals, jacobian

    def residuals(self, values: Values) -> Array:
        """The residuals of one set of values, or rows of those of several; half the sum of squares is the loss."""
        return self._once(values, 1)

    def jacobian(self, values: Values) -> Array:
        """The derivatives of the residuals by the free components, one row for each residual."""
        self.check_derivatives()
        return self._once(values, 2)

    def _by_adjoint(self, adjoint: Adjoint, values: Values) -> tuple[Any, Array]:
        """The loss and its gradient, once for both of the same values."""
        sets = self._sets(values)
        if not self._last_gradient or not np.array_equal(self._last_gradient[0], sets):
            def weights_of(part: slice, found: Array) -> Array:
                weights, first = np.zeros(found.shape), 0
                for q, where in enumerate(self._where.values()):
                    these = slice(first, first := first + len(where))
                    sigma = self._sigma[these]
                    residuals = (found[:, where, q] - self._observed[these]) / sigma
                    np.add.at(weights[:, :, q].T, where, (residuals / sigma).T)
                    losses[part] += 0.5 * np.sum(residuals * residuals, axis=1)
                return weights

            rows = np.atleast_2d(sets)
            losses = np.zeros(len(rows))
            gradient = adjoint.gradient(rows, weights_of)[1]
            self._last_gradient = (sets.copy(), losses, gradient)
        _, losses, gradient = self._last_gradient
        return (losses[0], gradient[0].copy()) if sets.ndim == 1 else (losses.copy(), gradient.copy())

    def loss(self, values: Values) -> Any:
        """Half the sum of the squares of the residuals: a number, or one for each set."""
        if self._adjoint is not None:
            return self._by_adjoint(self._adjoint, values)[0]
        return super().loss(values)

    def gradient(self, values: Values) -> Array:
        """The derivatives of the loss by the free components."""
        if self._adjoint is not None:
            return self._by_adjoint(self._adjoint, values)[1]
        return super().gradient(values)


def least_squares(model: AnyModel, data: Any, *, free: ByComponent, sweep: ByComponent | None = None,
                  start: ByComponent | None = None, begin: float = 0.0, sigma: Any = None, adjoint: bool = False,
                  **options: Any) -> LeastSquares:
    """The least-squares problem of a model and data, for optimisers and samplers of other packages; arguments as of
    `fit`. It has `residuals`, `jacobian`, `loss`, `gradient` and `bounds`. With `adjoint=True` loss and gradient are
    computed together by an adjoint, at a cost that hardly depends on the number of free components."""
    return LeastSquares(model, data, free, sweep, start, begin, sigma, options, adjoint)
