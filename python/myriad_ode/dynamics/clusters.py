# SPDX-License-Identifier: MIT
"""Which orbits go to one attractor, told by points of them: arrays alone, without a model. Features are computed where
the points are, in arrays of NumPy or of CuPy.

Orbits are first grouped by features that do not depend on the phase, as Stender and Hoffmann do (bSTAB, Nonlinear
Dynamics 107 (2022) 1451); groups are then compared as sets of points, after Datseris and Wagemakers' idea that an
attractor is where orbits return to (Chaos 32 (2022) 023104). What is compared is scaled: 1 is the extent of all that
was seen. No result depends on the order of the orbits."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from ..symbolic.types import Array

# A group takes orbits whose features differ by no more than those of its leader do between the halves of its points,
# nor by more than this part of its size.
_part_of_size = 0.1
_most_asked = 240  # points of a set
_most_of_path = 4000


class Features(NamedTuple):
    """Of each orbit: mean, deviation, minimum and maximum of each coordinate; within what they are known; the number of
    points after which the orbit returns, 0 if it does not."""

    values: Array
    error: Array
    lag: Array

    @classmethod
    def joined(cls, parts: list[Features]) -> Features:
        return cls(*(np.concatenate(of) for of in zip(*parts)))


def lags(points: Array, tolerance: float) -> tuple[Array, Array]:
    """After how many points each orbit of an array (orbits, points, coordinates) returns to where it was, always and
    within the tolerance, at most half of the points; 0 if it does not; and how far it is off at most."""
    orbits, count, _ = points.shape
    half = count // 2
    last = points[:, -1:]
    off = np.abs(points[:, count - 1 - half:count - 1][:, ::-1] - last).max(axis=2)
    near = off <= tolerance
    lag, error = np.zeros(orbits, int, like=points), np.zeros(orbits, like=points) + np.inf
    for _ in range(4):  # an orbit may pass by its last point before it returns
        first = near.argmax(axis=1) + 1
        open_ = np.flatnonzero((lag == 0) & near.any(axis=1))
        for k in np.unique(first[open_]).tolist():
            of = open_[first[open_] == k]
            after = (count // k - 1) * k  # as many returns as there are, as on a torus it may drift
            most = np.maximum(*(np.abs(points[of, shift:] - points[of, :-shift]).max(axis=(1, 2)) for shift in
                                (k, after)))
            lag[of[most <= tolerance]] = k
            error[of] = np.where(most <= tolerance, most, error[of])
        near[open_, first[open_] - 1] = False
    return lag, error


def _hann(points: Array) -> Array:
    """Weights of points by Hann's window, with which averages depend little on the parts of a period at either end."""
    count = points.shape[1]
    weights = np.sin(np.pi * (np.arange(count, like=points) + 0.5) / count)**2
    return weights / weights.sum()


def _averages(points: Array, weights: Array) -> list[Array]:
    """Mean and deviation of each coordinate."""
    mean = np.einsum("nkc,k->nc", points, weights)
    square = np.einsum("nkc,nkc,k->nc", points, points, weights)
    return [mean, np.sqrt(np.maximum(square - mean**2, 0))]


def features_of(points: Array, tolerance: float, may_return: bool) -> Features:
    """Features of orbits. With `may_return` points are those of a map, on which a cycle has a few points; its features
    are those of whole cycles."""
    orbits, count, _ = points.shape
    halves = [points[:, :count // 2], points[:, count // 2:]]
    first, second = ([*_averages(half, _hann(half)), half.min(axis=1), half.max(axis=1)] for half in halves)
    error = np.abs(np.concatenate(first, axis=1) - np.concatenate(second, axis=1)).max(axis=1)
    extremes = [np.minimum(first[2], second[2]), np.maximum(first[3], second[3])]
    values = np.concatenate([*_averages(points, _hann(points)), *extremes], axis=1)
    lag = np.zeros(orbits, int, like=points)
    if may_return:
        lag, off = lags(points, tolerance)
        error = np.where(lag > 0, off, error)
        for k in np.unique(lag[lag > 0]).tolist():
            of, whole = np.flatnonzero(lag == k), count // k * k
            values[of, :2 * points.shape[2]] = np.concatenate(
                _averages(points[of, count - whole:], np.zeros(whole, like=points) + 1 / whole), axis=1)
    return Features(values, error, lag)


class _Cells(NamedTuple):
    """Orbits with nearly the same features: the first of each cell in the order of values, how many there are, and the
    cell of each orbit; the best known first, then those with most orbits."""

    first: Array
    counts: Array
    cell: Array


def _mixed(keys: Array) -> Array:
    """A number of 64 bits for each row of whole numbers."""
    found = np.zeros(len(keys), np.uint64)
    for column in keys.T:
        found = (found ^ column.astype(np.int64).view(np.uint64)) * np.uint64(0x9E3779B97F4A7C15)
        found ^= found >> np.uint64(29)
    return found


def _cells(features: Features, ends: Array, tolerance: float) -> _Cells:
    level = np.ceil(np.log2(np.maximum(features.error / tolerance, 1))).clip(0, 60)
    rounded = np.rint(np.clip(features.values / tolerance, -1e15, 1e15))
    number = _mixed(np.concatenate([level[:, None], rounded], axis=1))
    order = np.lexsort((*ends.T[::-1], *features.values.T[::-1], number))
    begins = np.flatnonzero(np.concatenate([[True], np.diff(number[order]) != 0]))
    first, counts = order[begins], np.diff(np.append(begins, len(order)))
    sorted_ = np.lexsort((*ends[first].T[::-1], *features.values[first].T[::-1], -counts, level[first]))
    place = np.empty(len(first), int)
    place[sorted_] = np.arange(len(first))
    cell = np.empty(len(order), int)
    cell[order] = np.repeat(place, counts)
    return _Cells(first[sorted_], counts[sorted_], cell)


def grouped(features: Features, ends: Array, tolerance: float, most: int) -> tuple[Array, Array]:
    """Groups of orbits by their features: the orbit that leads each, and the group of each orbit, -1 of those that are
    left when there are as many groups as there may be. `ends` are the last points, which break ties."""
    cells = _cells(features, ends, tolerance)
    values, error = features.values[cells.first], features.error[cells.first]
    columns = values.shape[1] // 4
    size = (values[:, 3 * columns:] - values[:, 2 * columns:3 * columns]).max(axis=1)
    group = np.full(len(values), -1)
    rest = np.arange(len(values))
    leaders: list[int] = []
    while rest.size and len(leaders) < most:
        i = rest[0]
        radius = 1.5 * tolerance + (min(error[i], _part_of_size * size[i]) if error[i] > tolerance else 0)
        taken = (np.abs(values[rest] - values[i]).max(axis=1) <= radius) & (
            error[rest] <= 2 * max(error[i], tolerance))
        taken[0] = True
        group[rest[taken]] = len(leaders)
        leaders.append(cells.first[i])
        rest = rest[~taken]
    return np.array(leaders, int), group[cells.cell]


def distances(points: Array, to: Array) -> Array:
    """How far each of some points is from the nearest of others."""
    found = np.empty(len(points))
    for begin in range(0, len(points), 512):
        part = points[begin:begin + 512]
        squares = np.zeros((len(part), len(to)))
        for c in range(points.shape[1]):
            squares += (part[:, c, None] - to[None, :, c])**2
        found[begin:begin + 512] = np.sqrt(squares.min(axis=1))
    return found


def path(points: Array, step: float) -> tuple[Array, float]:
    """Points along the closed path through some points, evenly, with steps of at most so much if that takes no more
    than a few thousand of them; and half of their steps."""
    closed = np.concatenate([points, points[:1]])
    along = np.concatenate([[0.0], np.cumsum(np.sqrt((np.diff(closed, axis=0)**2).sum(axis=1)))])
    count = min(_most_of_path, int(np.ceil(along[-1] / step)) + 1)
    at = np.linspace(0, along[-1], count, endpoint=False)
    return np.stack([np.interp(at, along, column) for column in closed.T], axis=1), 0.5 * float(along[-1]) / count


def _some(points: Array) -> Array:
    """As many points as are looked at, evenly."""
    return points[::max(1, -(-len(points) // _most_asked))]


class PointSet:
    """Points of an attractor: those of one cycle, which it consists of (`is_closed`), or a sample of more."""

    def __init__(self, points: Array, is_closed: bool, spacing: float = 0.0) -> None:
        self.points, self.is_closed = points, is_closed
        self.some = _some(points)  #: those whose distances from other sets are looked at
        self.least, self.most = points.min(axis=0), points.max(axis=0)
        half = len(points) // 2
        #: how far points of the attractor are from the nearest of these
        self.spacing = spacing if is_closed else float(np.quantile(distances(_some(points[half:]), points[:half]), 0.9))

    @property
    def size(self) -> float:
        return float((self.most - self.least).max())

    def within(self, tolerance: float) -> float:
        """How far from these points what belongs to the attractor may be."""
        return 2 * tolerance + (1.0 if self.is_closed else 1.5) * self.spacing

    def off(self, points: Array) -> float:
        """How far points are from the attractor, but for the tenth of them that is farthest."""
        return float(np.quantile(distances(points, self.points), 0.9))

    def holds(self, points: Array, tolerance: float) -> bool:
        """Whether an orbit with these points is on the attractor: near to it, and not where it has drifted from."""
        middle = np.median(points, axis=0)
        inside = (middle >= self.least - 2 * tolerance) & (middle <= self.most + 2 * tolerance)
        return bool(inside.all()) and self.off(points) <= self.within(tolerance)

    def is_same(self, other: PointSet, tolerance: float) -> bool:
        """Whether two sets are of one attractor. An orbit that is near a cycle goes to it; two cycles, and two samples,
        are near to each other."""
        if self.is_closed != other.is_closed:
            closed, open_ = (self, other) if self.is_closed else (other, self)
            return closed.holds(open_.some, tolerance)
        within = max(self.within(tolerance), other.within(tolerance))
        slack = within + (0 if self.is_closed else 0.3 * max(self.size, other.size))
        if (np.abs(self.least - other.least) > slack).any() or (np.abs(self.most - other.most) > slack).any():
            return False
        if self.is_closed:
            return max(distances(self.some, other.points).max(), distances(other.some, self.points).max()) <= within
        return max(self.off(other.some), other.off(self.some)) <= within


def merged(sets: list[PointSet], weights: Array, tolerance: float) -> tuple[list[int], Array]:
    """Which sets are of one attractor: the set that stands for each, and the attractor of each set. Cycles come first,
    then those that are known best."""
    order = sorted(range(len(sets)), key=lambda i: (not sets[i].is_closed, round(sets[i].spacing / tolerance),
                                                    -weights[i], len(sets[i].points), *sets[i].points.mean(axis=0)))
    chosen: list[int] = []
    belongs = np.empty(len(sets), int)
    for i in order:
        same = [(sets[c].off(sets[i].some), n) for n, c in enumerate(chosen) if sets[c].is_same(sets[i], tolerance)]
        if not same:
            chosen.append(i)
        belongs[i] = min(same)[1] if same else len(chosen) - 1
    return chosen, belongs
