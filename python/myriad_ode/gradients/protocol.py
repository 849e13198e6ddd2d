# SPDX-License-Identifier: MIT
"""What adapters to other packages need of a model as a function of some of its components."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Protocol

if TYPE_CHECKING:
    import numpy as np

    from ..symbolic.types import Array


class FunctionOfValues(Protocol):
    """A `Batched`, by what it does."""

    free: list[str]
    of: list[Any]
    n_samples: int | None
    adjoint: Any

    @property
    def shape(self) -> tuple[int, ...]: ...
    @property
    def real(self) -> np.dtype[Any]: ...
    @property
    def gpu(self) -> int | None: ...
    def __hash__(self) -> int: ...
    def __call__(self, values: Any) -> Array: ...
    def with_jacobian(self, values: Any) -> tuple[Array, Array]: ...
    def vjp(self, values: Any, weights: Any) -> tuple[Array, Array]: ...
    def run(self, values: Any, sensitivities: bool = False) -> Any: ...
    def run_columns(self, columns: Sequence[Any], sensitivities: bool = False) -> Any: ...
    def check_derivatives(self) -> None: ...
