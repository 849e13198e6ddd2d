# SPDX-License-Identifier: MIT
"""A model as a function of some of its components, for one set of values or many: for optimisers, samplers, and, by
`to_jax` and `to_torch`, for automatic differentiation."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ..base.errors import Error
from ..kernels.devices import device_names
from ..models import state_jumps
from ..models.components import Components, listed, unknown
from ..sweeps.inputs import whole
from ..symbolic.symbols import time as time_symbol
from .adjoint import Adjoint
from .forward import forward_of, refuse_chosen

if TYPE_CHECKING:
    from collections.abc import Callable

    from ..models.any_model import AnyModel
    from ..results.run import Run
    from ..symbolic.types import Array, ByComponent, Component, SomeComponents, Values

__all__ = ["Batched", "batched"]


class Batched:
    """A function of values of the components `free`, in the last axis of its argument, whose other axes are those of a
    batch: all of it is integrated by one call of `solve`. The result has the axes of the batch, one of the samples, if
    any were asked for, and one of the quantities `of`. It is NaN for instances that have failed."""

    def __init__(self, model: AnyModel, free: SomeComponents, of: SomeComponents, sweep: ByComponent | None,
                 start: ByComponent | None, options: Mapping[str, Any], adjoint: bool = False) -> None:
        components = Components(model)
        self.model = model
        self.free = [components.component(one) for one in listed(free)]  #: names of the components that vary
        self.of: list[Component] = [one if one is time_symbol else components.component(one) for one in listed(of)]
        self._forward = forward_of(model, self.free, sweep, start, options)
        if len(set(self.free)) < len(self.free) or not self.free or not self.of:
            raise Error(f"free= names {self.free!r} and of= {self.of!r}: name at least one component each, none twice "
                        "in free=")
        results = [*components.states, *components.of(("accessory",)), *components.outputs]
        for one in self.of:
            if one is not time_symbol and one not in results:
                raise unknown(str(one), results, "state, accessory or output that can be a result")
        refuse_chosen(options, ("record", "size"), "a batched function")
        self._of_states = all(one is not time_symbol and one in components.states for one in self.of)
        samples = self._option("samples", None)
        self.n_samples = None if samples is None else self._count(samples)  #: None without samples
        if self.n_samples is not None and any(one is time_symbol for one in self.of):
            raise Error("of= has the time at which the last phase ended, which has no samples: leave out samples=")
        self._repeated: dict[bool, Any] = {}
        #: of `vjp`; None for forward sensitivities
        self.adjoint = Adjoint(model, self.free, self.of, self._forward.sweep, self._forward.start,
                               self._forward.plain_options(), samples) if adjoint else None

    @staticmethod
    def _count(samples: Any) -> int:
        if isinstance(samples, Mapping):
            raise Error("samples= of a batched function is a number of evenly spaced times, or an array of times")
        return whole(samples, "samples", 1 << 40) if np.ndim(samples) == 0 else len(samples)

    @property
    def shape(self) -> tuple[int, ...]:
        """The shape of the result for one set of values."""
        return (len(self.of),) if self.n_samples is None else (self.n_samples, len(self.of))

    def _option(self, name: str, usual: Any) -> Any:
        options = self._forward.options
        common = options.get("options")
        return options.get(name, usual if common is None else getattr(common, name, usual))

    @property
    def real(self) -> np.dtype[Any]:
        """The type of the numbers that it integrates."""
        return np.dtype("f4" if self._option("precision", "double") == "float" else "f8")

    @property
    def gpu(self) -> int | None:
        """The number of the GPU that takes values of the type `real` in its memory, and keeps the results there; None
        if they have to be on the host, as where results are no states."""
        needs_host = self._option("make_consistent", False) or self._option("invalid", "refuse") == "mark"
        if needs_host or not self._of_states:
            return None
        names, _ = device_names(self._option("device", "auto"), self._option("interpreted", None))
        return int(names[0].partition(":")[2]) if len(names) == 1 and names[0].startswith("cuda") else None

    def run(self, values: Any, sensitivities: bool = False) -> Run:
        """The run of sets of values in the rows of an array, of NumPy's or on a GPU."""
        return self._forward.run(self._forward.of_rows(values), sensitivities)

    def run_columns(self, columns: Sequence[Any], sensitivities: bool = False) -> Run:
        """The same of one array of values for each component of free=."""
        return self._forward.run(dict(zip(self.free, columns)), sensitivities)

    def check_derivatives(self) -> None:
        """Refuses derivatives of a model that jumps where they leave that out."""
        state_jumps.refuse(self.model, "derivative")

    def _rows(self, values: Values) -> tuple[Array, tuple[int, ...]]:
        array = np.asarray(values)
        if array.ndim == 0 or array.shape[-1] != len(self.free):
            raise Error(f"the argument has the shape {array.shape}: its last axis has the values of "
                        f"{', '.join(self.free)}, {len(self.free)} in number")
        if array.dtype.kind not in "fiu":
            raise Error(f"the argument has the type {array.dtype}: give real numbers")
        return np.ascontiguousarray(array.reshape(-1, len(self.free)), dtype=float), array.shape[:-1]

    def _stacked(self, arrays: Iterable[Array], run: Run) -> Array:
        """Arrays [row, ...] as one [array, ..., row], as the run has them in memory; NaN where an instance has
        failed."""
        found = np.stack([array.T for array in arrays])
        if (failed := run.failed).any():
            found[..., failed] = np.nan
        return found

    def repeated(self, with_jacobian: bool) -> Any:
        """What computes the results for rows of values, and their derivatives if they are wanted, in the core alone;
        None if that takes `solve`."""
        if with_jacobian not in self._repeated:
            of: list[list[Any]] = [self.of]
            if with_jacobian:
                names = ["time" if one is time_symbol else one for one in self.of]
                of.append([f"{one}_by_{k}" for one in names for k in self.free])
            self._repeated[with_jacobian] = self._forward.repeated(of, self.n_samples, with_jacobian)
        return self._repeated[with_jacobian]

    def _solved(self, rows: Array, with_jacobian: bool) -> list[Array]:
        """The results for rows of values, and their derivatives if they are wanted."""
        count, by = len(rows), len(self.free)
        shapes = [self.shape, (*self.shape, by)][:1 + with_jacobian]
        if (call := self.repeated(with_jacobian)) is not None:
            made = [np.empty((count, *shape)) for shape in shapes]
            call(rows, made)
            return made
        run = self.run(rows, with_jacobian)
        found = [self._stacked((run.t_last if one is time_symbol else run._values_of(str(one)) for one in self.of),
                               run)]
        if with_jacobian:
            slopes = self._stacked((run.sensitivity[one, k] for k in self.free for one in self.of), run)
            found.append(slopes.reshape(by, len(self.of), *slopes.shape[1:]))
        return [array.T.reshape(count, *shape) for array, shape in zip(found, shapes)]

    def __call__(self, values: Values) -> Array:
        """The results for one set of values, or for those of a batch."""
        rows, batch = self._rows(values)
        return self._solved(rows, False)[0].reshape(*batch, *self.shape)

    def with_jacobian(self, values: Values) -> tuple[Array, Array]:
        """The results, and their derivatives by the values, along one more axis behind those of the results. What has
        no derivative is NaN."""
        self.check_derivatives()
        rows, batch = self._rows(values)
        found, slopes = self._solved(rows, True)
        return found.reshape(*batch, *self.shape), slopes.reshape(*batch, *self.shape, len(self.free))

    def vjp(self, values: Values, weights: Values | Callable[[Array], Any]) -> tuple[Array, Array]:
        """The results, and the derivatives by the values of a loss that depends on the results: a product of a vector
        and the Jacobian. `weights` are the loss's derivatives by the results, of their shape, or a function that
        returns them for results of some rows, [row, time, quantity] or [row, quantity]. With `adjoint=True` the cost
        hardly depends on the number of values; else it is that of `with_jacobian`. Instances that have failed have
        NaN."""
        rows, batch = self._rows(values)
        if self.adjoint is None:
            results, jacobian = self.with_jacobian(rows)
            given = weights(results) if callable(weights) else weights
            flat = np.broadcast_to(np.asarray(given, float), (*batch, *self.shape)).reshape(len(rows), -1)
            # a weight of zero counts nothing, though the derivative may not exist
            counts_not = (flat == 0) & np.isfinite(results.reshape(flat.shape))
            known = np.where(counts_not[:, :, None], 0.0, jacobian.reshape(len(rows), -1, len(self.free)))
            gradient = (flat[:, None, :] @ known)[:, 0]
        else:
            if not callable(weights):
                flat = np.broadcast_to(np.asarray(weights, float), (*batch, *self.shape)).reshape(-1, *self.shape)

            def of_part(part: slice, found: Array) -> Array:
                given = weights(found.reshape(-1, *self.shape)) if callable(weights) else flat[part]
                return np.broadcast_to(np.asarray(given, float), (len(found), *self.shape)).reshape(found.shape)

            results, gradient, _ = self.adjoint.gradient(rows, of_part)
        return results.reshape(*batch, *self.shape), gradient.reshape(*batch, len(self.free))

    def to_jax(self) -> Callable[[Any], Any]:
        """The function for JAX arrays, under `jit`, `vmap`, `grad`, `jvp` and `vjp`; a batch by `vmap` is one call of
        `solve`. The derivatives are along the solution, with its tolerances; second ones are an error. Results have the
        type of the argument: double precision needs `jax.config.update("jax_enable_x64", True)`. On a CPU programs of
        XLA's call the core without Python, where no result is an output and there is a C++ compiler. Arrays on the GPU
        that integrates stay there if they have the type of the integration and all of of= are states; others go by the
        host. Needs the package jax. JAX keeps the function for as long as the process runs."""
        from .jax_adapter import jax_function

        return jax_function(self)

    def to_torch(self) -> Callable[[Any], Any]:
        """The function for PyTorch tensors, which `backward`, `torch.func.grad`, `jacrev` and `vmap` take; a batch is
        one call of `solve`. There are no second derivatives. Tensors on the GPU that integrates stay there. Needs the
        package torch."""
        from .torch_adapter import torch_function

        return torch_function(self)

    def __getstate__(self) -> dict[str, Any]:
        return {**vars(self), "_repeated": {}}  # which is of this process

    def __repr__(self) -> str:
        return f"<myriad_ode.Batched of {self.model!r} by {', '.join(self.free)}>"


def batched(model: AnyModel, *, free: SomeComponents, of: SomeComponents, sweep: ByComponent | None = None,
            start: ByComponent | None = None, adjoint: bool = False, **options: Any) -> Batched:
    """The model as a function of values of some components, in arrays.

    free      the components that vary, parameters and initial states: the last axis of the argument
    of        states, accessories, outputs, or `my.time` for the time at which the last phase ended: the last axis
              of the result
    sweep     the other parameters and shared values, one number each
    start     the other initial states, one number each
    adjoint   whether gradients are computed by an adjoint, whose cost hardly depends on the number of components that
              they are by: those of `vjp`, and in JAX and PyTorch those of reverse mode, beside which PyTorch has no
              other then
    options   of `solve`, as time=, samples=, method=, rtol=, device=, sensitivity_control=

    The argument has any number of axes before the last, all of which are integrated at once."""
    return Batched(model, free, of, sweep, start, options, adjoint)
