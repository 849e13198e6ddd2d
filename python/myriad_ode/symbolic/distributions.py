# SPDX-License-Identifier: MIT
"""Distributions that are functions of normal ones: of what differs between the instances of a study."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..base.errors import Error, at, users_line
from .expression import as_number
from .functions import exp, normal

if TYPE_CHECKING:
    import numpy.typing as npt

    from .expression import Expression, Operand

__all__ = ["lognormal", "multivariate_normal"]


def lognormal(median: Operand, sigma: Operand) -> Expression:
    """A random number whose logarithm is normally distributed around that of the median, with the standard deviation
    `sigma`: for the sweep of a study, or `generate` of a model, also as a part of an expression."""
    return as_number(median) * exp(normal(0.0, sigma))


def multivariate_normal(mean: npt.ArrayLike, covariance: npt.ArrayLike) -> tuple[Expression, ...]:
    """Correlated random numbers, normally distributed, as many as there are means: for the same as `lognormal`, as in
    {k: 5 * my.exp(a), V: 40 * my.exp(b)} of a, b = my.multivariate_normal([0, 0], [[0.1, 0.05], [0.05, 0.2]]).
    The covariance may be singular. Raises `Error` if it is not symmetric, or has a negative eigenvalue."""
    line = at(users_line())
    means, matrix = np.asarray(mean, float), np.asarray(covariance, float)
    if means.ndim != 1 or matrix.shape != (len(means), len(means)):
        raise Error(f"the means have shape {means.shape} and the covariance {matrix.shape}{line}: give a matrix with a "
                    "row and a column for each mean")
    if not np.isfinite(matrix).all() or not np.array_equal(matrix, matrix.T):
        raise Error(f"the covariance {matrix.tolist()} is not symmetric{line}: give that of each two values")
    values, vectors = np.linalg.eigh(matrix)
    if (values < -1e-12 * np.abs(values).max(initial=0.0)).any():
        raise Error(f"the covariance {matrix.tolist()} has the eigenvalue {values.min():.3g}{line}: correlations "
                    "cannot be that large together")
    # a triangle L with L L^T = the covariance, also where that is singular and has no Cholesky factor
    triangle = np.linalg.qr((vectors * np.sqrt(np.maximum(values, 0.0))).T)[1].T
    drawn = [normal() for _ in means]
    return tuple(sum((float(weight) * one for weight, one in zip(row, drawn) if weight), as_number(float(center)))
                 for center, row in zip(means, triangle))
