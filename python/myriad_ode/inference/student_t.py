# SPDX-License-Identifier: MIT
"""Student's distribution, of means whose standard error is estimated from the data themselves."""

from __future__ import annotations

from statistics import NormalDist

import numpy as np


def student_quantile(probability: float, degrees: float) -> float:
    """A quantile, of at least 1/2, of Student's distribution; of the normal one for infinitely many degrees of freedom.
    NaN without any."""
    if degrees <= 0:
        return np.nan
    if degrees > 1e5:  # where they agree to 1e-5
        return NormalDist().inv_cdf(probability)
    n = int(degrees)
    low, high = 0.0, np.pi / 2
    terms = np.arange(n % 2 + 1, n - 1, 2)
    while True:  # the angle whose tangent is t / sqrt(n), by bisection (Abramowitz and Stegun 26.7.3 and 26.7.4)
        angle = (low + high) / 2
        if angle in (low, high):
            return float(np.tan(angle) * np.sqrt(n))
        squares = np.cos(angle)**2
        series = 1 + np.sum(np.cumprod(terms / (terms + 1) * squares))
        within = np.sin(angle) * series if n % 2 == 0 else 2 / np.pi * (
            angle + (np.sin(angle) * np.cos(angle) * series if n > 1 else 0))
        low, high = (angle, high) if within < 2 * probability - 1 else (low, angle)
