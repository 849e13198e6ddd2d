# SPDX-License-Identifier: MIT
"""Least squares of a model and data: residuals and their derivatives, for many sets of parameters at once."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from ..base.errors import Error
from ..base.statuses import status_names
from ..gradients.adjoint import Adjoint
from ..gradients.forward import forward_of, refuse_chosen, tolerances
from ..models.components import Components, by_component, unknown
from ..models.noise import refuse_derivatives
from ..sweeps.inputs import by_name, real
from ..symbolic.symbols import time
from .objective import Curve, Free, Objective

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
        refuse_derivatives(model, "fits")
        self.model = model
        self._components = components = Components(model)
        super().__init__([Free(components.component(name), bounds) for name, bounds in by_component(
            by_name(free, "free", "free={k: (0.1, 10, \"log\")}"), "free=").items()])
        if not self.free:
            raise Error("free= names no component: give those to fit with their bounds, as in free={k: (0.1, 10)}")
        refuse_chosen(options, ("samples", "record", "phases", "size"), "a fit")
        self._forward = forward_of(model, self.names, sweep, start, {
            **options, "atol": tolerances(components, options, {f.name: f.size for f in self.free})})
        self._begin = real(begin, "begin")
        self._read(data, sigma)
        self._adjoint = self._make_adjoint() if adjoint else None
        self._last_gradient: tuple[Any, ...] = ()

    def _differentiated(self) -> AnyModel:
        return self.model

    def _make_adjoint(self) -> Adjoint:
        return Adjoint(self.model, self.names, list(self.data), self._forward.sweep, self._forward.start,
                       {**self._forward.plain_options(), "time": (self._begin, float(self.times[-1]))}, self.times)

    def _read(self, data: Any, sigma: Any) -> None:
        """Takes times, values and their standard deviations."""
        columns = self._columns(data)
        times = columns.pop("t", None)
        if times is None:
            raise Error("data has no times: give them as \"t\"")
        if not columns:
            raise Error("data has times alone: give values by the names of states or outputs")
        self._check(times, columns)
        self.data = columns
        self.times, where = np.unique(times, return_inverse=True)
        there = {name: np.flatnonzero(~np.isnan(values)) for name, values in columns.items()}
        self._where = {name: where[rows] for name, rows in there.items()}
        #: (name, time) of each residual
        self.labels = [(name, float(times[i])) for name, rows in there.items() for i in rows]
        self.has_sigma = sigma is not None
        self._sigma = np.concatenate(self._deviations(sigma, there, times.shape))
        self._observed = np.concatenate([columns[name][rows] for name, rows in there.items()])

    def _columns(self, data: Any) -> dict[str, Array]:
        """Data by the names of components, times as "t"."""
        if not hasattr(data, "items"):
            raise Error(f"data is a {type(data).__name__}: give a dict or a data frame with times and values by name, "
                        "as in {\"t\": times, x: values}")
        columns: dict[str, Array] = {}
        for key, values in data.items():
            is_time = key is time or isinstance(key, str) and key in _time_names and key not in self._components.place
            name = "t" if is_time else self._components.component(key)
            if name in columns:
                raise Error(f"data has '{name}' twice: give it once")
            try:
                columns[name] = np.asarray(values, float)
            except (TypeError, ValueError):
                raise Error(f"data of '{name}' has values that are no numbers: give numbers, NaN where there is none"
                            ) from None
        return columns

    def _check(self, times: Array, columns: Mapping[str, Array]) -> None:
        """Refuses data that the model has nothing to compare with."""
        possible = [*self._components.states, *self._components.outputs]
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

    def _deviations(self, sigma: Any, there: Mapping[str, Array], shape: tuple[int, ...]) -> list[Array]:
        """The standard deviations of the values that are there, for each quantity; 1 where none are known."""
        given = by_component(sigma, "sigma=") if hasattr(sigma, "items") else dict.fromkeys(there, sigma)
        for name in given:
            if self._components.component(name) not in there:
                raise unknown(self._components.component(name), list(there), "quantity in data")
        deviations = []
        for name, rows in there.items():
            of_name = given.get(name)
            if of_name is None and sigma is not None:
                raise Error(f"sigma= has none for '{name}': give the standard deviation of each quantity in data")
            values = np.asarray(1.0 if of_name is None else of_name, float)
            if values.ndim > 1 or values.ndim == 1 and values.shape != shape:
                raise Error(f"sigma of '{name}' has {values.size} values for {shape[0]} times: give one, or one for "
                            "each time")
            values = np.broadcast_to(values, shape)[rows]
            if not (np.isfinite(values) & (values > 0)).all():
                raise Error(f"sigma of '{name}' has values that are not positive: give standard deviations")
            deviations.append(values)
        return deviations

    def run(self, values: Values, sensitivities: bool = True) -> Run:
        """The run of one set of values, or of several in rows."""
        states = [name for name in self.data if name in self._components.states]
        samples: dict[str, Any] = {"times": self.times}
        if len(states) == len(self.data):
            samples["states"] = states
        return self._forward.run(self._forward.of_rows(np.atleast_2d(self._sets(values))), sensitivities,
                                 time=(self._begin, float(self.times[-1])), samples=samples)

    def curves(self, values: Values) -> dict[str, Curve]:
        """Data and model of each quantity, for one set of values; the model at times between those of the data too."""
        last = float(self.times[-1])
        times = np.union1d(np.linspace(self._begin, last, 400), self.times)
        run = self._forward.run(self._forward.of_rows(np.atleast_2d(self._sets(values))), time=(self._begin, last),
                                samples=times)
        units, t_label = self._components.units, f"t ({run.time_unit})" if run.time_unit else "t"
        found, first = {}, 0
        for name, where in self._where.items():
            these = slice(first, first := first + len(where))
            found[name] = Curve(self.times[where], self._observed[these],
                                self._sigma[these] if self.has_sigma else None, times, run._values_of(name)[0],
                                t_label, f"{name} ({units[name]})" if name in units else name)
        return found

    def evaluate(self, values: Values) -> tuple[Array, Array, Array]:
        """Of sets in rows the loss, residuals, [set, residual], and their derivatives by the free components, one more
        axis. NaN where the model has no solution up to a time of the data."""
        run = self.run(values)
        ended = run.status_codes > status_names.index("success")
        residuals = np.concatenate([run._values_of(n)[:, w] for n, w in self._where.items()], axis=1)
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
