# SPDX-License-Identifier: MIT
"""Interpolation of measured values, such as a forcing known at some times."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

import numpy as np

from ..base.errors import Error, at, refuse_masked, users_line
from .expression import as_number, continuous, make, to_real
from .folding import nan
from .functions import maximum, minimum, where
from .symbols import check_name
from .table import Table

if TYPE_CHECKING:
    import numpy.typing as npt

    from .expression import Expression, Operand
    from .types import Array

__all__ = ["interpolate"]

_outside = ("hold", "periodic", "extrapolate", "nan")


def interpolate(t: Operand, times: npt.ArrayLike, values: npt.ArrayLike, kind: Literal["linear", "cubic"] = "linear",
                outside: Literal["hold", "periodic", "extrapolate", "nan"] = "hold",
                name: str = "forcing") -> Expression:
    """The value at t, any expression, of data that are known at increasing times.

    kind     "linear", as numpy.interp, or "cubic", the spline with continuous second derivative whose first and last
             two pieces are one polynomial each, as scipy.interpolate.CubicSpline; periodic data have a periodic spline
    outside  "hold": the first and last value beyond the ends; "periodic": the data repeat, their first and last value
             being equal; "extrapolate": the first and last piece go on; "nan": no value, so that an instance that reads
             one ends as `not_finite`
    name     of the table; give each of several data of a model its own

    Evenly spaced times are found by their number, others by bisection. A linear interpolation has kinks at its times,
    and "hold" one at each end, where adaptive methods reject steps; give maximum_step= where steps might pass over
    details of the data."""
    line = at(users_line())
    times, values = _data(times, values, line)
    if kind not in ("linear", "cubic"):
        raise Error(f"kind is {kind!r}{line}: give \"linear\" or \"cubic\"")
    if outside not in _outside:
        raise Error(f"outside is {outside!r}{line}: give one of {', '.join(_outside)}")
    periodic = outside == "periodic"
    if periodic and values[0] != values[-1]:
        raise Error(f"periodic data begin with {values[0]} and end with {values[-1]}{line}: give the first value again "
                    "at the end of the period")
    x = to_real(as_number(t))
    if x.op == "constant":
        raise Error(f"the data are interpolated at a constant{line}: use NumPy's or SciPy's interpolation")
    pieces = _linear(times, values) if kind == "linear" else _cubic(times, values, periodic)
    rows, order = pieces.shape
    length = times[-1] - times[0]
    spacing = length / rows
    even = np.abs(times - (times[0] + spacing * np.arange(rows + 1))).max() <= 8 * np.finfo(float).eps * max(
        abs(times[0]), abs(times[-1]))
    head = [times[0], times[-1], length, spacing, 1 / spacing]
    knots = times[:0] if even else times
    table = Table(check_name(name, "a table"), np.concatenate([head, knots, pieces.ravel()]))
    begin, end, period, step, per_step = (table[i] for i in range(5))
    is_inside = (x >= begin) & (x <= end)
    if periodic:
        x = x - period * make("floor", ((x - begin) / period,), continuous)
    elif outside != "extrapolate":
        x = minimum(maximum(x, begin), end)
    if even:
        row = minimum(maximum(make("floor", ((x - begin) * per_step,), continuous), 0.0), float(rows - 1))
        offset = x - (begin + row * step)
    else:
        row = make("find_interval", (x,), (table, 5, rows + 1))
        offset = x - make("lookup", (row,), (table, 5, 1, rows + 1))
    first = 5 + len(knots)
    result = make("lookup", (row,), (table, first, order, rows))
    for power in range(1, order):
        result = result * offset + make("lookup", (row,), (table, first + power, order, rows))
    return where(is_inside, result, nan) if outside == "nan" else result


def _data(times: npt.ArrayLike, values: npt.ArrayLike, line: str) -> tuple[Array, Array]:
    """Times and values as arrays. Refuses what cannot be interpolated."""
    refuse_masked(times, "times of an interpolation")
    refuse_masked(values, "values of an interpolation")
    try:
        times, values = np.asarray(times, float), np.asarray(values, float)
    except (TypeError, ValueError) as why:
        raise Error(f"the data of an interpolation are no numbers{line}: {why}") from None
    if times.ndim != 1 or times.shape != values.shape or times.size < 2:
        raise Error(f"the interpolation has times of shape {times.shape} and values of shape {values.shape}{line}: "
                    "give one value for each of two times or more")
    if not (np.isfinite(times).all() and np.isfinite(values).all()):
        raise Error(f"the data of an interpolation are not finite{line}: leave such times out")
    if (np.diff(times) <= 0).any():
        where = int(np.flatnonzero(np.diff(times) <= 0)[0])
        raise Error(f"the times of an interpolation do not increase after number {where}{line}: sort them, each once")
    return times, values


def _linear(times: Array, values: Array) -> Array:
    return np.stack([np.diff(values) / np.diff(times), values[:-1]], axis=1)


def _cubic(times: Array, values: Array, periodic: bool) -> Array:
    """The coefficients of each piece, the highest power first, from the slopes at the knots, which a system of three
    diagonals, and two corners for periodic data, determines (de Boor, A Practical Guide to Splines, chapter IV)."""
    h, slope, n = np.diff(times), np.diff(values) / np.diff(times), times.size
    if n == 2 or n == 3 and periodic:
        slopes = np.full(n, slope[0]) if n == 2 else np.full(n, (slope / h).sum() / (1 / h).sum())
    elif n == 3:  # one parabola
        bend = (slope[1] - slope[0]) / (times[2] - times[0])
        slopes = slope[0] + bend * (2 * times - times[0] - times[1])
    else:
        lower, middle, upper, right = np.zeros(n), np.zeros(n), np.zeros(n), np.zeros((n, 2))
        lower[1:-1], middle[1:-1], upper[1:-1] = h[1:], 2 * (h[:-1] + h[1:]), h[:-1]
        right[1:-1, 0] = 3 * (h[1:] * slope[:-1] + h[:-1] * slope[1:])
        if periodic:  # slope 0 is unknown: solved for it as a second right side
            right[1, 1], right[n - 2, 1] = -lower[1], -upper[n - 2]
            middle[[0, -1]] = 1
            lower[1] = upper[n - 2] = 0
            inner, with_first = _three_diagonals(lower, middle, upper, right).T
            weight = 2 * (h[-1] + h[0]) + h[0] * with_first[n - 2] + h[-1] * with_first[1]
            known = 3 * (h[0] * slope[-1] + h[-1] * slope[0]) - h[0] * inner[n - 2] - h[-1] * inner[1]
            first = known / weight
            slopes = inner + first * with_first
            slopes[[0, -1]] = first
        else:
            d = times[2] - times[0]
            middle[0], upper[0] = h[1], d
            right[0, 0] = ((h[0] + 2 * d) * h[1] * slope[0] + h[0]**2 * slope[1]) / d
            d = times[-1] - times[-3]
            middle[-1], lower[-1] = h[-2], d
            right[-1, 0] = (h[-1]**2 * slope[-2] + (2 * d + h[-1]) * h[-2] * slope[-1]) / d
            slopes = _three_diagonals(lower, middle, upper, right)[:, 0]
    bend = (slopes[:-1] + slopes[1:] - 2 * slope) / h
    return np.stack([bend / h, (slope - slopes[:-1]) / h - bend, slopes[:-1], values[:-1]], axis=1)


def _three_diagonals(lower: Array, middle: Array, upper: Array, right: Array) -> Array:
    """Thomas' algorithm."""
    middle, right = middle.copy(), right.copy()
    for i in range(1, len(middle)):
        factor = lower[i] / middle[i - 1]
        middle[i] -= factor * upper[i - 1]
        right[i] -= factor * right[i - 1]
    right[-1] /= middle[-1]
    for i in range(len(middle) - 2, -1, -1):
        right[i] = (right[i] - upper[i] * right[i + 1]) / middle[i]
    return right
