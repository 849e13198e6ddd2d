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
from ..models.components import Components, by_component
from ..models.noise import refuse_derivatives
from ..sweeps.inputs import by_name, real
from .data import Data, by_quantity, deviations, read_data
from .objective import Curve, Free, Objective

if TYPE_CHECKING:
    from ..models.any_model import AnyModel
    from ..results.run import Run
    from ..symbolic.types import Array, ByComponent, Values

__all__ = ["LeastSquares", "least_squares"]


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

    def _read(self, given: Any, sigma: Any) -> None:
        """Takes times, values and their standard deviations."""
        data = read_data(self._components, given, self._begin)
        self.data = data.values
        self.times, where = np.unique(data.times, return_inverse=True)
        self._where = {name: where[rows] for name, rows in data.there.items()}
        #: (name, time) of each residual
        self.labels = [(name, float(data.times[i])) for name, rows in data.there.items() for i in rows]
        self.has_sigma = sigma is not None
        self._sigma = np.concatenate(self._deviations(sigma, data))
        self._observed = np.concatenate([data.values[name][rows] for name, rows in data.there.items()])

    def _deviations(self, sigma: Any, data: Data) -> list[Array]:
        """The standard deviations of the values that are there, for each quantity; 1 where none are known."""
        given = by_quantity(self._components, sigma, data.values, "sigma")
        for name in data.values:
            if sigma is not None and given.get(name) is None:
                raise Error(f"sigma= has none for '{name}': give the standard deviation of each quantity in data")
        return [deviations(1.0 if sigma is None else given[name], data, name) for name in data.values]

    def run(self, values: Values, sensitivities: bool = True) -> Run:
        """The run of one set of values, or of several in rows."""
        states = [name for name in self.data if name in self._components.states]
        samples: dict[str, Any] = {"times": self.times}
        if len(states) == len(self.data):
            samples["states"] = states
        return self._forward.run(self._forward.of_rows(np.atleast_2d(self._sets(values))), sensitivities,
                                 time=(self._begin, float(self.times[-1])), samples=samples)

    def curves(self, values: Values) -> dict[str, list[Curve]]:
        """Data and model of each quantity, for one set of values; the model at times between those of the data too."""
        last = float(self.times[-1])
        times = np.union1d(np.linspace(self._begin, last, 400), self.times)
        run = self._forward.run(self._forward.of_rows(np.atleast_2d(self._sets(values))), time=(self._begin, last),
                                samples=times)
        units, t_label = self._components.units, f"t ({run.time_unit})" if run.time_unit else "t"
        found: dict[str, list[Curve]] = {}
        first = 0
        for name, where in self._where.items():
            these = slice(first, first := first + len(where))
            found[name] = [Curve("", self.times[where], self._observed[these], np.zeros(len(where)),
                                 self._sigma[these] if self.has_sigma else None, times, run._values_of(name)[0],
                                 t_label, f"{name} ({units[name]})" if name in units else name)]
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
