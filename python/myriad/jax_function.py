# SPDX-License-Identifier: MIT
"""A batched function for JAX: a callback with a rule for its derivatives."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np

from .errors import Error

if TYPE_CHECKING:
    from .function import Batched


def jax_function(function: Batched) -> Callable[[Any], Any]:
    """As `Batched.to_jax`."""
    try:
        import jax
        import jax.numpy as jnp
    except ImportError:
        raise Error("to_jax needs the package jax: `pip install jax`") from None

    def shapes(theta: Any, *more: int) -> Any:
        return jax.ShapeDtypeStruct((*theta.shape[:-1], *function.shape, *more), theta.dtype)

    # `vmap` gives callbacks its axis as the first, and so calls them once.
    def values(theta: Any) -> Any:
        def on_host(rows: Any) -> Any:
            return function(np.asarray(rows)).astype(theta.dtype)

        return jax.pure_callback(on_host, shapes(theta), theta, vmap_method="expand_dims")

    def with_jacobian(theta: Any) -> Any:
        def on_host(rows: Any) -> Any:
            return tuple(found.astype(theta.dtype) for found in function.with_jacobian(np.asarray(rows)))

        return jax.pure_callback(on_host, (shapes(theta), shapes(theta, len(function.by))), theta,
                                 vmap_method="expand_dims")

    @jax.custom_jvp
    def of_floats(theta: Any) -> Any:
        return values(theta)

    @of_floats.defjvp
    def _(primals: Any, tangents: Any) -> Any:
        found, jacobian = with_jacobian(primals[0])
        batch = "abcdefgh"[:primals[0].ndim - 1]
        results = "xy"[:len(function.shape)]
        return found, jnp.einsum(f"{batch}{results}i,{batch}i->{batch}{results}", jacobian, tangents[0])

    def call(theta: Any) -> Any:
        theta = jnp.asarray(theta)
        if theta.ndim == 0 or theta.shape[-1] != len(function.by):
            raise Error(f"the argument has the shape {theta.shape}: its last axis has the values of "
                        f"{', '.join(function.by)}, {len(function.by)} in number")
        if not jnp.issubdtype(theta.dtype, jnp.floating):
            theta = theta.astype(jnp.result_type(float))
        return of_floats(theta)

    return call
