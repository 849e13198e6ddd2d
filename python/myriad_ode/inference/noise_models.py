# SPDX-License-Identifier: MIT
"""How data deviate from a model, `my.fit(..., sigma=my.noise_models.proportional("b"), free={..., "b": (0.01, 1)})`:
standard deviations that are numbers, or names in `free=`, which are then estimated."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..base.errors import Error
from ..sweeps.inputs import real

__all__ = ["combined", "constant", "log_normal", "proportional"]


@dataclass(frozen=True)
class NoiseModel:
    """The standard deviation sqrt(additive^2 + (relative * model)^2), on a linear or a logarithmic scale."""

    additive: float | str
    relative: float | str = 0.0
    scale: str = "lin"

    @property
    def names(self) -> list[str]:
        """Those that are estimated."""
        return [part for part in (self.additive, self.relative) if isinstance(part, str)]


def _part(value: float | str, name: str) -> float | str:
    if isinstance(value, str):
        return value
    number = real(value, name)
    if not 0 < number < np.inf:
        raise Error(f"{name} of a noise model is {number:g}: give a positive number, or a name that is in free=")
    return number


def constant(deviation: float | str) -> NoiseModel:
    """The same standard deviation for all values; `sigma="a"` is short for `sigma=my.noise_models.constant("a")`."""
    return NoiseModel(_part(deviation, "deviation"))


def proportional(share: float | str) -> NoiseModel:
    """A standard deviation of a share of the model's value: of 0.1 for ten percent."""
    return NoiseModel(0.0, _part(share, "share"))


def combined(deviation: float | str, share: float | str) -> NoiseModel:
    """Both, independent of each other: sqrt(deviation^2 + (share * model)^2)."""
    return NoiseModel(_part(deviation, "deviation"), _part(share, "share"))


def log_normal(deviation: float | str) -> NoiseModel:
    """The logarithm of the data is normally distributed about that of the model, with this standard deviation."""
    return NoiseModel(_part(deviation, "deviation"), scale="log")
