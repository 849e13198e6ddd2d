# SPDX-License-Identifier: MIT
"""Priors of the free components of a fit, `my.fit(..., priors={k: my.priors.log_normal(0.5, 0.3)})`: what is known of
them before there are data."""

from __future__ import annotations

from dataclasses import dataclass
from math import lgamma
from typing import TYPE_CHECKING

import numpy as np

from ..base.errors import Error
from ..sweeps.inputs import real
from .measurements import Terms, scaled_by

if TYPE_CHECKING:
    from ..symbolic.types import Array

__all__ = ["cauchy", "chi_squared", "exponential", "gamma", "laplace", "log_laplace", "log_normal", "log_uniform",
           "normal", "rayleigh"]


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


@dataclass(frozen=True)
class CauchyPrior(Prior):
    """Cauchy's distribution."""

    location: float
    width: float

    def terms(self, value: Array) -> tuple[Array, Array, Array]:
        d = (value - self.location) / self.width
        weight = np.sqrt(2 / (1 + d**2))
        return np.log1p(d**2) + np.log(np.pi * self.width), d * weight, weight / self.width


@dataclass(frozen=True)
class PowerPrior(Prior):
    """The density x^power exp(-rate x^exponent - constant) of positive x, and zero elsewhere."""

    power: float
    rate: float
    exponent: float
    constant: float

    def terms(self, value: Array) -> tuple[Array, Array, Array]:
        with np.errstate(divide="ignore", invalid="ignore"):
            x = np.where(value > 0, value, np.nan)
            grown = self.rate * x**self.exponent
            loss = grown - self.power * np.log(x) + self.constant
            inner = np.sqrt(self.exponent**2 * grown + abs(self.power)) / x
            slope = (self.exponent * grown - self.power) / x
        return np.where(value > 0, loss, np.inf), slope / inner, inner


@dataclass(frozen=True)
class UniformPrior(Prior):
    """A density that is exp(-constant) everywhere: that of values between bounds, which a fit keeps."""

    constant: float

    def terms(self, value: Array) -> tuple[Array, Array, Array]:
        return np.full_like(value, self.constant), np.zeros_like(value), np.zeros_like(value)


@dataclass(frozen=True)
class ScaledPrior(Prior):
    """Another density times a factor exp(-constant), as where bounds cut off a part of it."""

    prior: Prior
    constant: float

    def terms(self, value: Array) -> tuple[Array, Array, Array]:
        loss, r, inner = self.prior.terms(value)
        return loss + self.constant, r, inner


@dataclass(frozen=True)
class BoundedPrior(Prior):
    """Another density that is zero outside an interval."""

    prior: Prior
    least: float
    most: float

    def terms(self, value: Array) -> tuple[Array, Array, Array]:
        loss, r, inner = self.prior.terms(value)
        return np.where((value >= self.least) & (value <= self.most), loss, np.inf), r, inner


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


def log_laplace(median: float, scale: float) -> Prior:
    """The distribution of a component whose logarithm has Laplace's, about the logarithm of `median`, with `scale`. The
    density is that of the component itself."""
    location = float(np.log(_positive(median, "median")))
    return LaplacePrior("log", location, _positive(scale, "scale"), True)


def cauchy(location: float, scale: float) -> Prior:
    """Cauchy's distribution, half of which lies between location - scale and location + scale."""
    return CauchyPrior(real(location, "location"), _positive(scale, "scale"))


def gamma(shape: float, scale: float) -> Prior:
    """A gamma distribution, with the mean shape * scale."""
    shape, scale = _positive(shape, "shape"), _positive(scale, "scale")
    return PowerPrior(shape - 1, 1 / scale, 1.0, lgamma(shape) + shape * float(np.log(scale)))


def exponential(scale: float) -> Prior:
    """An exponential distribution, with the mean `scale`."""
    return gamma(1.0, scale)


def chi_squared(degrees_of_freedom: float) -> Prior:
    """A chi-squared distribution."""
    return gamma(_positive(degrees_of_freedom, "degrees_of_freedom") / 2, 2.0)


def rayleigh(scale: float) -> Prior:
    """Rayleigh's distribution, with the mode `scale`."""
    scale = _positive(scale, "scale")
    return PowerPrior(1.0, 0.5 / scale**2, 2.0, 2 * float(np.log(scale)))


def log_uniform(least: float, most: float) -> Prior:
    """The distribution of a component whose logarithm is uniform between those of `least` and `most`; the density is
    zero outside."""
    least, most = _positive(least, "least"), _positive(most, "most")
    if not least < most:
        raise Error(f"a log-uniform prior from {least:g} to {most:g}: give the smaller number first")
    density = PowerPrior(-1.0, 0.0, 1.0, float(np.log(np.log(most / least))))
    return BoundedPrior(density, least, most)
