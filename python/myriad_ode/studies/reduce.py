# SPDX-License-Identifier: MIT
"""Reductions over the instances of a study, which need not keep what they reduce: `reduce=` of `my.study`.

Variables are named as in results: "x" at recorded phases, "x_end" at the end, "x_sample". Instances that failed are
left out, but by `total`. Results do not depend on how the instances are divided into chunks, bit for bit.

A reduction is over all instances; or by `over=`, a name or several, over these axes of the study alone, such as "path":
then there is one for each point of the other axes, such as a set of parameters, and results have these in front."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from statistics import NormalDist
from typing import TYPE_CHECKING, Any, Union

import numpy as np

from .. import _core
from ..base.errors import Error
from ..base.statuses import in_words
from ..symbolic.axes import Axis

if TYPE_CHECKING:
    import numpy.typing as npt

__all__ = ["confidence_levels", "covariance", "histogram", "histograms", "maximum", "mean", "minimum", "quantiles",
           "standard_error", "total", "variance"]

# Axes that are reduced: a name or several; None for all.
Over = Union[str, Sequence[str], None]


class Reduction:
    """A reduction, made by the functions of this module."""

    def __init__(self, kind: str, *arguments: Any, over: Over = None) -> None:
        self.kind, self.arguments, self.over = kind, arguments, _axes(over)

    @property
    def variables(self) -> list[str]:
        """The names of what it reduces."""
        if self.kind == "sum_of":
            return list(self.arguments[1])
        return list(self.arguments[:2 if self.kind == "covariance_of" else 1])

    def core(self) -> _core.Reduction:
        """The reduction for the core."""
        arguments = [a.core() if isinstance(a, Axis) else a for a in self.arguments]
        made = getattr(_core, self.kind)(*arguments)
        return made if self.over is None else made.over(self.over)

    def __repr__(self) -> str:
        over = [] if self.over is None else [f"over={self.over!r}"]
        return f"{self.kind}({', '.join([*map(repr, self.arguments), *over])})"


def _axes(over: object) -> list[str] | None:
    """The axes that a reduction is over; None for all."""
    if over is None:
        return None
    names = [over] if isinstance(over, str) else list(over) if isinstance(over, (list, tuple)) else []
    if not names or not all(isinstance(one, str) for one in names):
        raise Error(f"over is {over!r}: give the name of an axis of the study, as \"path\", or several in a list")
    return names


def _variable(name: object) -> str:
    if not isinstance(name, str):
        raise Error(f"a reduction is asked for of {name!r}: give the name of a variable of the results, as \"x_end\"")
    return name


class _Values(Axis):
    """Values as they are given."""

    def core(self) -> _core.AxisValues:
        return _core.values(list(self.arguments))


def _edges(edges: Axis | npt.ArrayLike) -> Axis:
    return edges if isinstance(edges, Axis) else _Values("values", *np.asarray(edges, dtype=float).tolist())


def histogram(variable: str, edges: Axis | npt.ArrayLike, over: Over = None) -> Reduction:
    """How many values lie between neighbouring edges, as numpy.histogram: "x_end_histogram" along "x_end_bin"; and
    "x_end_outside", how many lie below, above, and are not finite."""
    return Reduction("histogram_of", _variable(variable), _edges(edges), over=over)


def histograms(variable: str, edges: Axis | npt.ArrayLike, over: Over = None) -> Reduction:
    """A histogram for each phase or sample: "x_sample_histograms" along "sample" and "x_sample_histograms_bin"; and
    "x_sample_histograms_outside"."""
    return Reduction("histograms_of", _variable(variable), _edges(edges), over=over)


def quantiles(variable: str, quantiles: npt.ArrayLike, edges: Axis | npt.ArrayLike, over: Over = None) -> Reduction:
    """Quantiles, numbers from 0 to 1, for each phase or sample: "x_sample_quantiles", the quantile first, as bands of
    percentiles over time. They are found by a histogram, to the width of a bin; NaN where one lies below the first edge
    or above the last one."""
    wanted = np.atleast_1d(np.asarray(quantiles, dtype=float)).tolist()
    return Reduction("quantiles_of", _variable(variable), wanted, _edges(edges), over=over)


def confidence_levels(quantiles: npt.ArrayLike, draws: int, level: float = 0.95) -> np.ndarray:
    """Which quantiles of so many independent draws bound the population's own with that confidence: a row of lower and
    one of upper ones, for `my.reduce.quantiles` of the same study. How many draws lie below a quantile p of the
    population has the binomial distribution, here its normal approximation: p ± z sqrt(p (1 - p) / draws). H. A. David,
    H. N. Nagaraja, Order Statistics (2003), section 7.1."""
    wanted = np.atleast_1d(np.asarray(quantiles, dtype=float))
    if not ((wanted >= 0) & (wanted <= 1)).all() or not 0 < level < 1 or draws < 1:
        raise Error(f"quantiles {wanted.tolist()} of {draws} draws with a confidence of {level}: give quantiles from 0 "
                    "to 1, at least one draw, and a confidence between 0 and 1")
    reach = NormalDist().inv_cdf((1 + level) / 2) * np.sqrt(wanted * (1 - wanted) / draws)
    return np.clip([wanted - reach, wanted + reach], 0, 1)


def minimum(variable: str, over: Over = None) -> Reduction:
    """The smallest value, for each phase or sample: "x_end_minimum"."""
    return Reduction("minimum_of", _variable(variable), over=over)


def maximum(variable: str, over: Over = None) -> Reduction:
    """The largest value, for each phase or sample: "x_end_maximum"."""
    return Reduction("maximum_of", _variable(variable), over=over)


def mean(variable: str, over: Over = None) -> Reduction:
    """The mean, for each phase or sample: "x_end_mean". The sum is exact and rounded once."""
    return Reduction("mean_of", _variable(variable), over=over)


def variance(variable: str, over: Over = None) -> Reduction:
    """The variance, for each phase or sample: "x_end_variance", the squares of deviations from the mean over their
    number less one. Sums are exact, so that nothing cancels; NaN of values beyond 1e144."""
    return Reduction("variance_of", _variable(variable), over=over)


def standard_error(variable: str, over: Over = None) -> Reduction:
    """The standard error of the mean, for each phase or sample: "x_end_standard_error", as `mean` is off by where
    instances are independent, as paths of a stochastic equation are."""
    return Reduction("standard_error_of", _variable(variable), over=over)


def covariance(variable: str, other: str, over: Over = None) -> Reduction:
    """The covariance of two variables, for each phase or sample: "x_end_v_end_covariance", the products of deviations
    from the means over their number less one, of instances where both are finite. Sums are exact, as of `variance`."""
    return Reduction("covariance_of", _variable(variable), _variable(other), over=over)


class _OfChunk:
    """A function of a chunk's arrays, which gets its statuses in words."""

    def __init__(self, function: Callable[[dict[str, Any]], Any]) -> None:
        self.function = function

    def __call__(self, arrays: dict[str, Any]) -> Any:
        return self.function({**arrays, "status": in_words(arrays["status"])})


def total(name: str, inputs: str | Sequence[str], size: int, function: Callable[[dict[str, Any]], Any],
          over: Over = None) -> Reduction:
    """The sum over chunks of `size` numbers that a function computes of each chunk: variable `name`. The function gets
    a dict of arrays, the inputs by name and "status", in words, with a row for each instance of the chunk, failed ones
    too, and returns the numbers. `name` stands for it in the study's description: give another one when it changes.
    Threads take turns in calling it; for executors it must pickle. With `over=` it is called for each run of
    neighbouring instances of one point of the other axes."""
    inputs = [inputs] if isinstance(inputs, str) else list(inputs)
    return Reduction("sum_of", _variable(name), [_variable(i) for i in inputs], int(size), _OfChunk(function),
                     over=over)


def __dir__() -> list[str]:
    return sorted(__all__)
