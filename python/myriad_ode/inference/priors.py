# SPDX-License-Identifier: MIT
"""Priors of the free components of a fit, `my.fit(..., priors={k: my.priors.log_normal(0.5, 0.3)})`: what is known of
them before there are data."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ..base.errors import Error
from ..sweeps.inputs import real
from .measurements import Terms, scaled_by

if TYPE_CHECKING:
    from ..symbolic.types import Array

__all__ = ["laplace", "log_normal", "normal"]


class Prior:
    """A distribution of one component."""

    def terms(self, value: Array) -> tuple[Array, Array, Array]:
        """The negative logarithm of the density at values, a residual r, and its derivative j: j r is the slope of the
        logarithm, j^2 its bend or more."""
        raise NotImplementedError


@dataclass(frozen=True)
class NormalPrior(Prior):
    """Normally distributed on a scale, "lin", "log" or "log10": half the square of a residual, and a constant."""

    scale: str
    mean: float
    deviation: float
    constant: float

    def terms(self, value: Array) -> tuple[Array, Array, Array]:
        scaled, inner = scaled_by(self.scale, value)
        r = (scaled - self.mean) / self.deviation
        return 0.5 * r**2 + self.constant, r, inner / self.deviation


@dataclass(frozen=True)
class LaplacePrior(Prior):
    """Laplace's distribution on a scale; with `of_value` the density is that of the value itself, and the scale "log".
    A distance d, in units of `width`, is taken as sqrt(d^2 + 1e-8), that there is a derivative at 0."""

    scale: str
    location: float
    width: float
    of_value: bool = False

    def terms(self, value: Array) -> tuple[Array, Array, Array]:
        scaled, inner = scaled_by(self.scale, value)
        d = (scaled - self.location) / self.width
        size = np.sqrt(d**2 + 1e-8)
        slope, loss = d / size, size + np.log(2 * self.width)
        if self.of_value:
            slope, loss = slope + self.width, loss + scaled
        return loss, slope * np.sqrt(size), inner / (self.width * np.sqrt(size))


def terms_of(prior: Prior, sets: Array, component: int) -> Terms:
    """The term of a prior of the free component of this number, for sets of values in rows."""
    loss, r, inner = prior.terms(sets[:, [component]])
    return Terms(loss, r, inner[..., None] * (np.arange(sets.shape[1]) == component))


def _positive(value: float, name: str) -> float:
    number = real(value, name)
    if not 0 < number < np.inf:
        raise Error(f"{name} of a prior is {number:g}: give a positive number")
    return number


def normal(mean: float, deviation: float) -> Prior:
    """A normal distribution."""
    deviation = _positive(deviation, "deviation")
    return NormalPrior("lin", real(mean, "mean"), deviation, float(np.log(deviation * np.sqrt(2 * np.pi))))


def log_normal(median: float, deviation: float) -> Prior:
    """A distribution whose logarithm is normal, about that of `median`, with `deviation`. The density is that of the
    component itself, so that its mode is below the median."""
    deviation = _positive(deviation, "deviation")
    return log_normal_prior(float(np.log(_positive(median, "median"))), deviation)


def log_normal_prior(mean: float, deviation: float) -> NormalPrior:
    """The same by the mean of the logarithm."""
    # the density has 1 / value as a factor: the square is completed
    constant = float(np.log(deviation * np.sqrt(2 * np.pi))) + mean - deviation**2 / 2
    return NormalPrior("log", mean - deviation**2, deviation, constant)


def laplace(location: float, scale: float) -> Prior:
    """Laplace's distribution, of the density exp(-|value - location| / scale) / (2 scale)."""
    return LaplacePrior("lin", real(location, "location"), _positive(scale, "scale"))
