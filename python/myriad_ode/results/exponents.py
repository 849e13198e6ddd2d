# SPDX-License-Identifier: MIT
"""Lyapunov exponents of a run of a model with tangents."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..base.errors import Error, at, users_line

if TYPE_CHECKING:
    from ..symbolic.types import Array
    from .run import Run

__all__ = ["exponents"]


def exponents(run: Run) -> Array:
    """The Lyapunov exponents of a run of a model `with_tangents`, per unit of time, by the natural logarithm: one row
    per instance, the largest first. NaN if no phase was summed."""
    names = [name for name in run.accessories if name.startswith("growth_")]
    if not names or "time_summed" not in run.accessories:
        raise Error(f"the model of this run has no tangents{at(users_line())}: solve my.with_tangents(model)")
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.stack([run[name] / run["time_summed"] for name in names], axis=1)
