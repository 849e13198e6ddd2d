# SPDX-License-Identifier: MIT
"""What a fit minimises."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ..base.errors import Error
from ..models import state_jumps
from ..sweeps.inputs import real

if TYPE_CHECKING:
    from ..models.any_model import AnyModel
    from ..results.run import Run
    from ..symbolic.types import Array, Values


class Free:
    """A component that varies within bounds, and whether its logarithm is what does."""

    def __init__(self, name: str, given: Any) -> None:
        form = f"{{{name}: (least, most)}} or {{{name}: (least, most, \"log\")}}"
        parts = list(given) if isinstance(given, (tuple, list)) else []
        if len(parts) not in (2, 3) or len(parts) == 3 and parts[2] not in ("log", "linear"):
            raise Error(f"the bounds of '{name}' are {given!r}: give {form}")
        self.name, self.log = name, len(parts) == 3 and parts[2] == "log"
        self.least, self.most = (real(p, f"a bound of '{name}'") for p in parts[:2])
        if not (np.isfinite(self.least) and np.isfinite(self.most) and self.least < self.most):
            raise Error(f"the bounds of '{name}' are {self.least:g} and {self.most:g}: give two finite numbers, the "
                        "smaller one first")
        if self.log and self.least <= 0:
            raise Error(f"the lower bound of '{name}' is {self.least:g}, and its logarithm varies: give a positive "
                        "one, or leave out \"log\"")

    @property
    def size(self) -> float:
        """What it is at the most, 1 or more."""
        return max(1.0, abs(self.least), abs(self.most))


class Curve(NamedTuple):
    """Data of a quantity in an experiment, with deviations if they are known, and the model at more times. `side` is 0,
    but -1 or 1 of values of which only is known that they are below or above."""

    experiment: str
    t_data: Array
    data: Array
    side: Array
    sigma: Array | None
    t: Array
    model: Array
    t_label: str
    label: str


class Objective:
    """What a fit minimises, as a function of the values of the free components, in the order of `names`: one set, or
    several in rows, which are integrated as one ensemble."""

    has_sigma = True  #: whether the deviations of the data are known, or part of what is minimised

    def __init__(self, free: Sequence[Free]) -> None:
        self.free = list(free)
        self.names = [f.name for f in self.free]  #: of the free components
        self._last: tuple[Any, ...] = ()

    @property
    def bounds(self) -> tuple[Array, Array]:
        """The lower and the upper bounds of the free components."""
        return np.array([f.least for f in self.free]), np.array([f.most for f in self.free])

    def check_derivatives(self) -> None:
        """Refuses derivatives of a model that jumps where they leave that out."""
        state_jumps.refuse(self._differentiated(), "gradient of the loss")

    def _differentiated(self) -> AnyModel:
        """The model whose derivatives the gradient is made of."""
        raise NotImplementedError

    def run(self, values: Values, sensitivities: bool = True) -> Run:
        """The run of one set of values, or of several in rows."""
        raise NotImplementedError

    def curves(self, values: Values) -> dict[str, list[Curve]]:
        """Data and model of each quantity in each experiment that has it, for one set of values."""
        raise Error(f"{type(self).__name__} has no picture of data and model: my.fit has one")

    @property
    def why_no_residuals(self) -> str:
        """Why the loss is no sum of squares; empty if it is one."""
        return ""

    def why_none(self) -> str:
        """Why there may be no loss, and what to do, where `evaluate` has found none at any start."""
        return ("no start of the fit has a solution up to the last time of the data: look at one by "
                "fit.problem.run(values).report, and give narrower bounds")

    def evaluate(self, values: Values) -> tuple[Array, Array, Array]:
        """Of sets in rows the loss, and residuals r, [set, residual], and a matrix J, [set, residual, free component]:
        J^T r is the gradient of the loss, and J^T J approximates its second derivatives. NaN where the model has no
        solution up to a time of the data."""
        raise NotImplementedError

    def _sets(self, values: Values) -> Array:
        sets = np.asarray(values, float)
        if sets.ndim not in (1, 2) or sets.shape[-1] != len(self.free):
            raise Error(f"the values of free components have the shape {sets.shape}: give {len(self.free)}, or rows of "
                        f"{len(self.free)}, in the order {', '.join(self.names)}")
        return sets

    def _once(self, values: Values, which: int) -> Array:
        """A part of what `evaluate` returns, once for all parts at the same values; of one set, if one is given."""
        sets = self._sets(values)
        if not self._last or not np.array_equal(self._last[0], sets):
            self._last = (sets.copy(), *self.evaluate(np.atleast_2d(sets)))
        found: Array = self._last[1 + which]
        return (found[0] if sets.ndim == 1 else found).copy()

    def loss(self, values: Values) -> Any:
        """What is minimised: a number, or one for each set."""
        return self._once(values, 0)

    def residuals(self, values: Values) -> Array:
        """The residuals of one set of values, or rows of those of several; half the sum of squares is the loss, but for
        a constant. Raises `Error` if the loss is no sum of squares."""
        if self.why_no_residuals:
            raise Error(f"{self.why_no_residuals}: use loss and gradient")
        return self._once(values, 1)

    def jacobian(self, values: Values) -> Array:
        """The derivatives of the residuals by the free components, one row for each residual."""
        if self.why_no_residuals:
            raise Error(f"{self.why_no_residuals}: use loss and gradient")
        self.check_derivatives()
        return self._once(values, 2)

    def gradient(self, values: Values) -> Array:
        """The derivatives of the loss by the free components."""
        self.check_derivatives()
        return np.einsum("...r,...rp->...p", self._once(values, 1), self._once(values, 2))


def logarithms(free: Sequence[Free], values: Array) -> Array:
    """Values of free components as what varies: logarithms, where these vary."""
    return np.stack([np.log(values[..., i]) if f.log else values[..., i] for i, f in enumerate(free)], axis=-1)


def from_logarithms(free: Sequence[Free], varied: Array) -> Array:
    """The reverse of `logarithms`, within the bounds in spite of rounding."""
    return np.stack([np.clip(np.exp(varied[..., i]) if f.log else varied[..., i], f.least, f.most)
                     for i, f in enumerate(free)], axis=-1)
