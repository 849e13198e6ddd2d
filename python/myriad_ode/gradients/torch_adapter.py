# SPDX-License-Identifier: MIT
"""A batched function for PyTorch: a function of autograd, whose tensors stay on the GPU that integrates."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np

from ..base.errors import Error
from ..base.packages import package
from ..sweeps.gpu_inputs import is_on_gpu

if TYPE_CHECKING:
    from .protocol import FunctionOfValues


def _no_second() -> Error:
    return Error("the second derivatives of a solution are asked for, which there are not: let an optimiser use "
                 "gradients alone")


def _solver(torch: Any, function: FunctionOfValues) -> Callable[[Any, bool], tuple[Any, Any]]:
    """What gives values for a tensor, and derivatives if they are wanted."""
    def from_gpu(run: Any, names: list[Any]) -> Any:
        """Results where they are, [instance, sample, name] or [instance, name]; NaN where an instance has failed."""
        found = torch.stack([torch.from_dlpack(run.device.of_component(name)) for name in names], dim=-1)
        failed = torch.as_tensor(run.failed, device=found.device)
        return torch.where(failed.reshape(-1, *[1] * (found.ndim - 1)), torch.nan, found)

    def stays_on_gpu(theta: Any) -> bool:
        real = torch.float64 if function.real == np.float64 else torch.float32
        return is_on_gpu(theta) and theta.dtype == real and theta.device.index == function.gpu

    def solved(theta: Any, wanted: bool) -> tuple[Any, Any]:
        batch, count = theta.shape[:-1], len(function.free)
        if stays_on_gpu(theta):
            run = function.run(theta.detach().reshape(-1, count), sensitivities=wanted)
            values = from_gpu(run, function.of).reshape(*batch, *function.shape)
            if not wanted:
                return values, None
            slopes = torch.stack([from_gpu(run, [f"{one}_by_{k}" for k in function.free])
                                  for one in function.of], dim=-2)
            return values, slopes.reshape(*batch, *function.shape, count)
        rows = theta.detach().cpu().numpy()
        if not wanted:
            return torch.as_tensor(function(rows)).to(theta), None
        values, slopes = function.with_jacobian(rows)
        return torch.as_tensor(values).to(theta), torch.as_tensor(slopes).to(theta)

    return solved


def _with_jacobian(torch: Any, function: FunctionOfValues, solved: Callable[[Any, bool], Any]) -> Any:
    """Of autograd the function whose derivatives are computed with its values."""
    class Solved(torch.autograd.Function):
        """Values and derivatives; to differentiate these is an error, or gives NaN in forward mode."""

        @staticmethod
        def forward(theta: Any) -> Any:
            return solved(theta, True)

        @staticmethod
        def setup_context(ctx: Any, inputs: Any, output: Any) -> None:
            ctx.set_materialize_grads(False)
            ctx.save_for_backward(output[1])
            ctx.save_for_forward(output[1])

        @staticmethod
        def backward(ctx: Any, of_values: Any, of_jacobian: Any) -> Any:
            if of_jacobian is not None:
                raise _no_second()
            if of_values is None:
                return None
            jacobian, = ctx.saved_tensors
            extra = jacobian.ndim - 1 - len(function.shape)
            flat = of_values.reshape(*of_values.shape[:extra], 1, -1)
            # a weight of zero counts nothing, though the derivative may not exist
            known = jacobian.reshape(*jacobian.shape[:extra], -1, len(function.free)).masked_fill(flat.mT == 0, 0.0)
            return (flat @ known).squeeze(-2)

        @staticmethod
        def jvp(ctx: Any, tangent: Any) -> Any:
            jacobian, = ctx.saved_tensors
            batch = tangent.shape[:-1]
            along = tangent.reshape(*batch, *[1] * len(function.shape), -1)
            # Forward derivatives of the derivatives are wanted silently: they must be no numbers.
            return (jacobian * along).masked_fill(along == 0, 0.0).sum(-1), torch.full_like(jacobian, torch.nan)

        @staticmethod
        def vmap(info: Any, in_dims: Any, theta: Any) -> Any:
            return Solved.apply(theta.movedim(in_dims[0], 0)), (0, 0)

    return Solved


def _with_adjoint(torch: Any, function: FunctionOfValues, solved: Callable[[Any, bool], Any]) -> Any:
    """Of autograd the function whose derivatives an adjoint computes."""
    class ByAdjoint(torch.autograd.Function):
        """Values, whose derivatives an adjoint computes where they are asked for."""

        @staticmethod
        def forward(theta: Any) -> Any:
            return solved(theta, False)[0]

        @staticmethod
        def setup_context(ctx: Any, inputs: Any, output: Any) -> None:
            ctx.save_for_backward(*inputs)

        @staticmethod
        def backward(ctx: Any, weights: Any) -> Any:
            return PulledBack.apply(*ctx.saved_tensors, weights)

        @staticmethod
        def vmap(info: Any, in_dims: Any, theta: Any) -> Any:
            return ByAdjoint.apply(theta.movedim(in_dims[0], 0)), 0

    class PulledBack(torch.autograd.Function):
        """Products of weights and the Jacobian; to differentiate them is an error."""

        @staticmethod
        def forward(theta: Any, weights: Any) -> Any:
            gradient = function.vjp(theta.detach().cpu().numpy(), weights.detach().cpu().numpy())[1]
            return torch.as_tensor(gradient).to(theta)

        @staticmethod
        def setup_context(ctx: Any, inputs: Any, output: Any) -> None:
            pass

        @staticmethod
        def backward(ctx: Any, _: Any) -> Any:
            raise _no_second()

        @staticmethod
        def vmap(info: Any, in_dims: Any, theta: Any, weights: Any) -> Any:
            theta, weights = (one.expand(info.batch_size, *one.shape) if place is None else one.movedim(place, 0)
                              for one, place in zip((theta, weights), in_dims))
            return PulledBack.apply(theta, weights), 0

    return ByAdjoint


def _values_alone(torch: Any, solved: Callable[[Any, bool], Any]) -> Any:
    """Of autograd the function without derivatives."""
    class Values(torch.autograd.Function):
        """Values alone, where no derivatives are wanted."""

        @staticmethod
        def forward(theta: Any) -> Any:
            return solved(theta, False)[0]

        @staticmethod
        def setup_context(ctx: Any, inputs: Any, output: Any) -> None:
            ctx.mark_non_differentiable(output)

        @staticmethod
        def vmap(info: Any, in_dims: Any, theta: Any) -> Any:
            return Values.apply(theta.movedim(in_dims[0], 0)), 0

    return Values


def torch_function(function: FunctionOfValues) -> Callable[[Any], Any]:
    """As `Batched.to_torch`."""
    torch = package("torch", "to_torch")
    solved = _solver(torch, function)
    with_jacobian, with_adjoint = _with_jacobian(torch, function, solved), _with_adjoint(torch, function, solved)
    values_alone = _values_alone(torch, solved)

    def call(theta: Any) -> Any:
        if theta.ndim == 0 or theta.shape[-1] != len(function.free):
            raise Error(f"the argument has the shape {tuple(theta.shape)}: its last axis has the values of "
                        f"{', '.join(function.free)}, {len(function.free)} in number")
        moves = torch.autograd.forward_ad.unpack_dual(theta).tangent is not None if theta.is_floating_point() else False
        if moves or theta.requires_grad and torch.is_grad_enabled():
            function.check_derivatives()
            return with_jacobian.apply(theta)[0] if function.adjoint is None else with_adjoint.apply(theta)
        return values_alone.apply(theta if theta.is_floating_point() else theta.double())

    return call
