# SPDX-License-Identifier: MIT
"""Lyapunov exponents of a run or a study of a model with tangents."""

from __future__ import annotations

from itertools import count, takewhile
from typing import TYPE_CHECKING

import numpy as np

from ..base.errors import Error, at, users_line

if TYPE_CHECKING:
    from collections.abc import Mapping

    from ..symbolic.types import Array

__all__ = ["exponents"]


def exponents(run: Mapping[str, Array]) -> Array:
    """The Lyapunov exponents of a run or a study of a model `with_tangents`, per unit of time, by the natural
    logarithm: one row per instance, or the axes of the study, and the largest first. NaN if no phase was summed."""
    names = list(takewhile(run.__contains__, (f"exponent_{i}_end" for i in count(1))))
    # Stores of studies that were begun before exponents had a name have the sums that they follow from.
    sums = [] if names else list(takewhile(run.__contains__, (f"growth_{i}_end" for i in count(1))))
    if not names and (not sums or "time_summed_end" not in run):
        raise Error(f"there are no exponents in this result{at(users_line())}: solve my.with_tangents(model), and let "
                    "a study keep all, or exponent_1, ...")
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.stack([run[name] for name in names] or [run[name] / run["time_summed_end"] for name in sums], axis=-1)
