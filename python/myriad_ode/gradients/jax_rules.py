# SPDX-License-Identifier: MIT
"""JAX's rules for the derivatives of a function whose values and Jacobian are computed elsewhere."""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import Any

from ..base.errors import Error


@functools.cache
def product_with_vector() -> Any:
    """JAX's primitive for the product of a Jacobian and a vector, in which zero times what does not exist is zero, and
    so is it in the product with the transposed Jacobian, which reverse mode makes of it."""
    import jax
    import jax.numpy as jnp
    from jax.extend.core import Primitive
    from jax.interpreters import ad, batching, mlir

    def primitive(name: str, axis: int) -> Any:
        def product(jacobian: Any, vector: Any) -> Any:
            vector = jnp.expand_dims(vector, -3 - axis)
            return jnp.where(vector == 0, 0, jacobian * vector).sum(axis)

        def shape_of(*given: Any) -> Any:
            made = jax.eval_shape(product, *(jax.ShapeDtypeStruct(one.shape, one.dtype) for one in given))
            return jax.core.ShapedArray(made.shape, made.dtype)

        def batched(given: Any, axes: Any) -> Any:
            size = next(one.shape[place] for one, place in zip(given, axes) if place is not None)
            return made.bind(*(jnp.broadcast_to(one, (size, *one.shape)) if place is None else
                               jnp.moveaxis(one, place, 0) for one, place in zip(given, axes))), 0

        made = Primitive(name)
        made.def_impl(jax.jit(product))
        made.def_abstract_eval(shape_of)
        mlir.register_lowering(made, mlir.lower_fun(product, multiple_results=False))
        batching.primitive_batchers[made] = batched
        return made

    forwards, backwards = primitive("myriad_product", -1), primitive("myriad_transposed_product", -2)

    def transposed_to(other: Any) -> Callable[..., Any]:
        def rule(weights: Any, jacobian: Any, vector: Any) -> Any:
            return None, ad.Zero(vector.aval) if type(weights) is ad.Zero else other.bind(jacobian, weights)

        return rule

    ad.primitive_transposes[forwards], ad.primitive_transposes[backwards] = map(transposed_to, (backwards, forwards))
    return forwards


def _no_second() -> Error:
    return Error("the second derivatives of a solution are asked for, which there are not: let an optimiser or sampler "
                 "use gradients alone; of a sum of squares of residuals r, J.T @ J with J = jax.jacfwd(r)(theta) is "
                 "the Gauss-Newton approximation of the Hessian")


def _without_second(of: Callable[..., Any], linear: bool = False) -> Callable[..., Any]:
    """The function of theta and others, whose derivatives by theta are an error, unless nothing depends on them.
    `linear`: in the second argument."""
    import jax
    from jax.custom_derivatives import SymbolicZero

    once = jax.custom_jvp(of)

    def rule(primals: Any, tangents: Any) -> Any:
        if not isinstance(tangents[0], SymbolicZero):
            raise _no_second()
        found = once(*primals)
        if linear and not isinstance(tangents[1], SymbolicZero):
            return found, once(primals[0], tangents[1])
        return found, jax.tree.map(jax.numpy.zeros_like, found)

    once.defjvp(rule, symbolic_zeros=True)
    return once


def _along(jacobian: Any, direction: Any, shape: tuple[int, ...]) -> Any:
    """The derivatives along a direction of results of that shape, whose first axes are the direction's."""
    flat = jacobian.reshape(*direction.shape[:-1], -1, direction.shape[-1])
    return product_with_vector().bind(flat, direction).reshape(shape)


def _pushed_forward(values: Callable[[Any], Any], values_and_jacobian: Callable[[Any], Any],
                    pulled_back: Callable[[Any, Any], Any]) -> Any:
    """JAX's primitive for derivatives along a direction, by the Jacobian, which reverse mode transposes to products of
    weights and the Jacobian that are computed without it."""
    import jax
    import jax.numpy as jnp
    from jax.extend.core import Primitive
    from jax.interpreters import ad, batching, mlir

    pushed = Primitive("myriad_pushed_forward")

    def along(theta: Any, direction: Any) -> Any:
        found, jacobian = values_and_jacobian(theta)
        return _along(jacobian, direction, found.shape)

    def shape_of(theta: Any, direction: Any) -> Any:
        made = jax.eval_shape(values, jax.ShapeDtypeStruct(theta.shape, theta.dtype))  # without a kernel for `along`
        return jax.core.ShapedArray(made.shape, made.dtype)

    def batched(given: Any, axes: Any) -> Any:
        theta, direction = (one if place is None else jnp.moveaxis(one, place, 0) for one, place in zip(given, axes))
        if axes[0] is None:  # several directions at one place
            found, jacobian = values_and_jacobian(theta)
            size = len(direction)
            repeated = jnp.broadcast_to(jacobian, (size, *jacobian.shape))
            return _along(repeated, direction, (size, *found.shape)), 0
        return pushed.bind(theta, jnp.broadcast_to(direction, theta.shape)), 0

    def derivative(given: Any, tangents: Any) -> Any:
        if type(tangents[0]) is not ad.Zero:
            raise _no_second()
        return pushed.bind(*given), pushed.bind(given[0], tangents[1])

    def transposed(weights: Any, theta: Any, direction: Any) -> Any:
        return None, ad.Zero(direction.aval) if type(weights) is ad.Zero else pulled(theta, weights)

    pulled = _without_second(pulled_back, linear=True)
    pushed.def_impl(jax.jit(along))
    pushed.def_abstract_eval(shape_of)
    mlir.register_lowering(pushed, mlir.lower_fun(along, multiple_results=False))
    batching.primitive_batchers[pushed] = batched
    ad.primitive_jvps[pushed], ad.primitive_transposes[pushed] = derivative, transposed
    return pushed


def differentiable(values: Callable[[Any], Any], values_and_jacobian: Callable[[Any], Any],
                   pulled_back: Callable[[Any, Any], Any] | None, check: Callable[[], None]) -> Callable[[Any], Any]:
    """The function that JAX differentiates: `values` of an argument, with derivatives in forward mode by the Jacobian,
    and in reverse mode by `pulled_back(theta, weights)`, or by the Jacobian if that is None. `check` raises where there
    are no derivatives. Second ones are an error."""
    import jax

    with_jacobian = _without_second(values_and_jacobian)
    pushed = None if pulled_back is None else _pushed_forward(values, with_jacobian, pulled_back)
    rule = jax.custom_jvp(values)

    def forward(primals: Any, tangents: Any) -> Any:
        check()
        if pushed is not None:
            return rule(primals[0]), pushed.bind(primals[0], tangents[0])
        found, jacobian = with_jacobian(primals[0])
        return found, _along(jacobian, tangents[0], found.shape)

    rule.defjvp(forward)
    return rule
