# SPDX-License-Identifier: MIT
"""A batched function for JAX: a call of the core on a CPU, or on the GPU that integrates, where the argument is there,
and a callback to Python otherwise."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np

from ..base.errors import Error
from ..base.packages import package
from ..base.statuses import first_failure
from . import jax_rules, xla_handler

if TYPE_CHECKING:
    from .protocol import FunctionOfValues


def _is_there(platform: str) -> bool:
    """Whether JAX has devices of a platform."""
    import jax

    try:
        return bool(jax.devices(platform))
    except RuntimeError:
        return False


def _solved(function: FunctionOfValues, platform: str, with_jacobian: bool) -> Callable[[Any], Any]:
    """The values, or values and derivatives, for an argument with any axes of a batch."""
    import jax
    import jax.numpy as jnp

    shapes = [function.shape, (*function.shape, len(function.free))][:1 + with_jacobian]

    def by_python(theta: Any) -> Any:
        def call(rows: Any) -> list[Any]:
            rows = np.asarray(rows)
            found = function.with_jacobian(rows) if with_jacobian else [function(rows)]
            return [array.astype(theta.dtype, copy=False) for array in found]

        # `mapped` makes a batch of what `vmap` asks for.
        return jax.pure_callback(call, [jax.ShapeDtypeStruct((*theta.shape[:-1], *shape), theta.dtype)
                                        for shape in shapes], theta)

    def on_cpu(theta: Any) -> Any:
        found = xla_handler.call_on_cpu(function, with_jacobian, theta.reshape(-1, len(function.free)))
        return [array.reshape(*theta.shape[:-1], *shape) for array, shape in zip(found, shapes)]

    def on_gpu(theta: Any) -> Any:
        *found, status = xla_handler.call_on_gpu(function, with_jacobian, theta.reshape(-1, len(function.free)),
                                                 platform)
        marked = [jnp.where(status >= first_failure, jnp.nan, array) for array in found]  # instances are last
        return [array.T.reshape(*theta.shape[:-1], *shape) for array, shape in zip(marked, shapes)]

    def natively(theta: Any) -> dict[str, Callable[[Any], Any]]:
        """What needs no Python, by platform."""
        if theta.size == 0 or not xla_handler.is_there():
            return {}
        if theta.dtype == function.real and function.gpu is not None and _is_there(platform):
            return {platform: on_gpu}
        if theta.dtype in (np.float32, np.float64) and function.repeated(with_jacobian) is not None:
            return {"cpu": on_cpu}
        return {}

    @jax.jit
    def by_platform(theta: Any) -> Any:
        native = natively(theta)
        return jax.lax.platform_dependent(theta, **native, default=by_python) if native else by_python(theta)

    mapped = jax.custom_batching.custom_vmap(by_platform)
    mapped.def_vmap(lambda size, is_mapped, theta: (mapped(theta), [True] * len(shapes)))
    return mapped


def jax_function(function: FunctionOfValues, platform: str = "cuda") -> Callable[[Any], Any]:
    """As `Batched.to_jax`. `platform` is JAX's name of that whose arrays are in the memory of a GPU of Myriad's."""
    jax = package("jax", "to_jax")
    jnp = jax.numpy
    n_by = len(function.free)
    values, values_and_jacobian = (_solved(function, platform, with_jacobian) for with_jacobian in (False, True))

    def pulled_back(theta: Any, weights: Any) -> Any:
        def by_python(rows: Any, of_rows: Any) -> Any:
            return function.vjp(np.asarray(rows), np.asarray(of_rows))[1].astype(theta.dtype)

        return jax.pure_callback(by_python, jax.ShapeDtypeStruct(theta.shape, theta.dtype), theta, weights,
                                 vmap_method="broadcast_all")

    rule = jax_rules.differentiable(lambda theta: values(theta)[0], values_and_jacobian,
                                    None if function.adjoint is None else pulled_back, function.check_derivatives)

    def call(theta: Any) -> Any:
        theta = jnp.asarray(theta)
        if theta.ndim == 0 or theta.shape[-1] != n_by:
            raise Error(f"the argument has the shape {theta.shape}: its last axis has the values of "
                        f"{', '.join(function.free)}, {n_by} in number")
        if not jnp.issubdtype(theta.dtype, jnp.floating):
            theta = theta.astype(jnp.result_type(float))
        return rule(theta)

    return call
