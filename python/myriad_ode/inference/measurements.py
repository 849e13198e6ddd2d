# SPDX-License-Identifier: MIT
"""What likelihoods of measurements are made of, for experiments in Python and problems of PEtab: values that follow
from the free components, times of sampling, and the terms of single measurements."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import erfc
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from ..symbolic.types import Array

_ln10 = float(np.log(10))


@dataclass
class Given:
    """What components are set to: each of several is a number, or the free component whose number `free` has, or -1."""

    free: Array
    number: Array

    @staticmethod
    def of(resolved: Sequence[tuple[int, float]]) -> Given:
        return Given(np.array([k for k, _ in resolved], int), np.array([v for _, v in resolved], float))

    @staticmethod
    def joined(parts: Sequence[Given]) -> Given:
        return Given(np.concatenate([part.free for part in parts]), np.concatenate([part.number for part in parts]))

    def values(self, sets: Array) -> Array:
        """The values for sets of the free components, [set, one of several]."""
        return np.where(self.free >= 0, sets[:, self.free], self.number)

    def at(self, rows: Array) -> Given:
        return Given(self.free[rows], self.number[rows])

    def add_chain(self, found: Array, partial: Array) -> None:
        """Adds to derivatives by the free components, [set, one of several, free component], what comes of those by
        these values, [set, one of several]."""
        rows = np.flatnonzero(self.free >= 0)
        found[:, rows, self.free[rows]] += partial[:, rows]


@dataclass
class Measurements:
    """Those of a quantity with noise on one scale, one after the other: numbers of their experiments and of the samples
    there, times, values or limits, the side of a limit that a value is on, and both parts of the deviation."""

    quantity: str
    scale: str
    experiment: Array
    place: Array
    time: Array
    measured: Array
    side: Array
    additive: Given
    relative: Given

    def __post_init__(self) -> None:
        self.varies = (self.additive.free >= 0) | (self.relative.free >= 0) | (self.relative.number > 0)

    @staticmethod
    def joined(parts: Sequence[Measurements]) -> Measurements:
        """Those of several experiments, with noise on the same scale."""
        def of(name: str) -> Array:
            return np.concatenate([getattr(part, name) for part in parts])

        return Measurements(parts[0].quantity, parts[0].scale, of("experiment"), of("place"), of("time"),
                             of("measured"), of("side"), Given.joined([part.additive for part in parts]),
                             Given.joined([part.relative for part in parts]))

    def deviation(self, sets: Array, mean: Array) -> tuple[Array, Array, Array, Array]:
        """The standard deviations about means, NaN where there is none, and their derivatives by the means and by both
        parts."""
        additive, relative = self.additive.values(sets), self.relative.values(sets)
        found = np.hypot(additive, relative * mean)
        found = np.where(found > 0, found, np.nan)
        return found, relative**2 * mean / found, additive / found, relative * mean**2 / found


def sample_times(of_experiments: Sequence[Array], begins: Array, ends: Array) -> Array:
    """Times of sampling of several experiments, as many of each, [experiment, sample]: those of its measurements,
    ascending, and others from begin to end where it has fewer than another."""
    most = max(map(len, of_experiments))
    rows = []
    for times, begin, end in zip(of_experiments, begins, ends):
        others = np.setdiff1d(np.linspace(begin, end, 2 * most + 1), times)
        rows.append(np.sort(np.append(times, others[:most - times.size])))
    return np.stack(rows)


def scaled_by(scale: str, value: Array) -> tuple[Array, Array]:
    """Values on the scale of a parameter or an observable, and the derivative of these by them."""
    if scale == "log":
        return np.log(value), 1 / value
    if scale == "log10":
        return np.log10(value), 1 / (_ln10 * value)
    return value, np.ones_like(value)


class Terms(NamedTuple):
    """Terms of a negative logarithm of a likelihood: its values, [set, measurement], and r and J, [set, residual] and
    [set, residual, free component], where J^T r is the gradient of their sum and J^T J its Fisher information, or of
    censored measurements its Hessian but for second derivatives of the model."""

    loss: Array
    residuals: Array
    jacobian: Array


def added(terms: Sequence[Terms]) -> tuple[Array, Array, Array]:
    """The sum of losses of each set, and all residuals and their derivatives; NaN of sets that have any."""
    total = np.sum([of.loss.sum(axis=1) for of in terms], axis=0)
    residuals = np.concatenate([of.residuals for of in terms], axis=1)
    jacobian = np.concatenate([of.jacobian for of in terms], axis=1)
    lost = ~(np.isfinite(total) & np.isfinite(residuals).all(axis=1))
    total[lost], residuals[lost], jacobian[lost] = np.nan, np.nan, np.nan
    return total, residuals, jacobian


def normal_loss(scale: str, measured: Array, mean: Array, deviation: Array) -> Array:
    """The negative logarithms of the densities of measurements, normally distributed on a scale."""
    loss = 0.5 * ((scaled_by(scale, mean)[0] - scaled_by(scale, measured)[0]) / deviation)**2 + np.log(deviation) + (
        0.5 * np.log(2 * np.pi))
    return loss + _log_of_value(scale, measured)


def _log_of_value(scale: str, measured: Array) -> Array:
    """What makes the negative logarithm of a density on a scale that of the value itself."""
    return np.zeros_like(measured) if scale == "lin" else np.log(measured * (_ln10 if scale == "log10" else 1.0))


def laplace_loss(scale: str, measured: Array, median: Array, width: Array) -> Array:
    """The same of measurements with Laplace's distribution."""
    distance = np.abs(scaled_by(scale, median)[0] - scaled_by(scale, measured)[0])
    return distance / width + np.log(2 * width) + _log_of_value(scale, measured)


def normal_terms(scale: str, measured: Array, mean: Array, by_mean: Array, deviation: Array, by_deviation: Array,
                 varies: Array) -> Terms:
    """The terms of measurements that are normally distributed on a scale about the means there: of a mean m and a
    deviation s the Fisher information is (dm / s)^2 + 2 (ds / s)^2. `by_` are derivatives by the free components. The
    second part has rows of its own, behind the others, for the measurements whose deviation `varies`."""
    on_scale, inner = scaled_by(scale, mean)
    r = (on_scale - scaled_by(scale, measured)[0]) / deviation
    residuals, jacobian = [r], [by_mean * (inner / deviation)[..., None]]
    if varies.any():
        residuals.append(((1 - r**2) / np.sqrt(2))[:, varies])
        jacobian.append((np.sqrt(2) * by_deviation / deviation[..., None])[:, varies])
    return Terms(normal_loss(scale, measured, mean, deviation), np.concatenate(residuals, axis=1),
                 np.concatenate(jacobian, axis=1))


def laplace_terms(scale: str, measured: Array, median: Array, by_median: Array, width: Array, by_width: Array,
                  varies: Array) -> Terms:
    """The same of measurements with Laplace's distribution, whose Fisher information is (dm / s)^2 + (ds / s)^2. At
    its kink the slope by the median is zero."""
    on_scale, inner = scaled_by(scale, median)
    d = (on_scale - scaled_by(scale, measured)[0]) / width
    residuals, jacobian = [np.sign(d)], [by_median * (inner / width)[..., None]]
    if varies.any():
        residuals.append((1 - np.abs(d))[:, varies])
        jacobian.append((by_width / width[..., None])[:, varies])
    return Terms(laplace_loss(scale, measured, median, width), np.concatenate(residuals, axis=1),
                 np.concatenate(jacobian, axis=1))


losses = {"normal": normal_loss, "laplace": laplace_loss}  #: of measurements, by the distribution of their noise
terms = {"normal": normal_terms, "laplace": laplace_terms}


def censored_terms(scale: str, limit: Array, side: Array, mean: Array, by_mean: Array, deviation: Array,
                   by_deviation: Array) -> Terms:
    """The terms of measurements of which only the side of a limit is known, -1 below and 1 above: the logarithms of the
    probabilities of that."""
    on_scale, inner = scaled_by(scale, mean)
    z = side * (on_scale - scaled_by(scale, limit)[0]) / deviation
    by_z = (side * inner / deviation)[..., None] * by_mean - (z / deviation)[..., None] * by_deviation
    loss, slope, bend = _log_probability(z)
    root = np.sqrt(bend)
    with np.errstate(divide="ignore", invalid="ignore"):
        residuals = np.where(root > 0, slope / root, 0.0)
    return Terms(loss, residuals, root[..., None] * by_z)


def _log_probability(z: Array) -> tuple[Array, Array, Array]:
    """The negative logarithm of the normal distribution's integral up to z, and its first and second derivatives."""
    far = z < -25  # beyond, an asymptotic series (Abramowitz and Stegun 26.2.12), to 1e-10
    near = np.where(far, 0.0, z)
    tail_of = np.vectorize(lambda x: 0.5 * erfc(x / np.sqrt(2)), otypes=[float])
    integral = tail_of(-near)
    density = np.exp(-0.5 * near**2) / np.sqrt(2 * np.pi)
    ratio = density / integral
    loss = np.where(near > 0, -np.log1p(-tail_of(np.abs(near))), -np.log(integral))
    x = np.where(far, z, -25.0)
    lack = 1 / x**2 - 3 / x**4 + 15 / x**6 - 105 / x**8
    tail = 0.5 * x**2 + 0.5 * np.log(2 * np.pi) + np.log(-x) - np.log1p(-lack)
    far_ratio = -x / (1 - lack)
    return (np.where(far, tail, loss), np.where(far, -far_ratio, -ratio),
            np.where(far, far_ratio * -x * lack / (1 - lack), ratio * (ratio + near)))
