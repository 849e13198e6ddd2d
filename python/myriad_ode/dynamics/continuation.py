# SPDX-License-Identifier: MIT
"""`continuation`: attractors and their basins' shares over a parameter."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ..base.errors import Error
from ..base.packages import package
from ..sweeps.inputs import real
from ..sweeps.sweep import Sweep
from . import attractor_plots
from .attractors import Attractor, Attractors, attractors
from .clusters import PointSet
from .starts import along_one

if TYPE_CHECKING:
    import xarray
    from matplotlib.axes import Axes

    from ..models.any_model import AnyModel
    from ..symbolic.types import Array, ByComponent

__all__ = ["Continuation", "continuation"]


class Continuation(Sequence[Attractors]):
    """The attractors at each value of a parameter, those that belong together with one number."""

    def __init__(self, parameter: str, values: Array, found: list[Attractors], numbers: list[list[int]]) -> None:
        self.parameter = parameter  #: the name of what is varied
        self.values = values  #: its values
        #: at each value the number of each attractor, which those at other values have that it was matched with
        self.numbers = numbers
        self._found = found
        count = 1 + max((max(of) for of in numbers if of), default=-1)
        #: of all starts, by value and number; zero where an attractor is not there
        self.shares: Array = np.zeros((len(values), count))
        for i, (at, of) in enumerate(zip(found, numbers)):
            self.shares[i, of] = at.shares

    def __getitem__(self, place: Any) -> Any:
        return self._found[place]

    def __len__(self) -> int:
        return len(self._found)

    def kinds(self, number: int) -> list[str]:
        """What an attractor is at each value in a few words; empty where it is not there."""
        return [at[of.index(number)].name if number in of else "" for at, of in zip(self, self.numbers)]

    def plot(self, *, axes: Axes | None = None, **style: Any) -> Any:
        """The shares over the parameter, one above the other; what is above all of them comes to no attractor. Further
        arguments go to matplotlib's `stackplot`. Returns the axes."""
        return attractor_plots.shares(self, axes, style)

    def to_xarray(self) -> xarray.Dataset:
        """The shares along the parameter and the numbers of attractors, and the means of the states."""
        xarray = package("xarray", "to_xarray")
        names = list(next((one.mean for at in self for one in at), {}))
        means = {name: np.full(self.shares.shape, np.nan) for name in names}
        for i, (at, of) in enumerate(zip(self, self.numbers)):
            for one, number in zip(at, of):
                for name, value in one.mean.items():
                    means[name][i, number] = value
        dims = (self.parameter, "attractor")
        return xarray.Dataset({"share": (dims, self.shares), **{f"{name}_mean": (dims, of) for name, of in
                                                                means.items()}},
                              {self.parameter: self.values, "attractor": np.arange(self.shares.shape[1])})

    def __repr__(self) -> str:
        lines = [f"{self.shares.shape[1]} attractors over {len(self)} values of {self.parameter}"]
        for number in range(self.shares.shape[1]):
            there = np.flatnonzero([number in of for of in self.numbers])
            kinds = self.kinds(number)
            first, last = self.values[there[0]], self.values[there[-1]]
            share = self.shares[there, number]
            lines.append(f"{number}: from {first:.4g} ({kinds[there[0]]}) to {last:.4g} ({kinds[there[-1]]}), "
                         f"{100 * share.min():.3g} to {100 * share.max():.3g} % of the starts")
        return "\n".join(lines)


def continuation(model: AnyModel, sweep: Sweep | ByComponent, *, start: Sweep | ByComponent, reach: float = 0.3,
                 **options: Any) -> Continuation:
    """The attractors of a model over the values of a parameter, and the share of starts that each has. Attractors at
    neighbouring values are matched: those that are nearest to each other, as sets of points, have the same number; one
    that was lost is found again by where it was last.

    model     as of `my.attractors`, as are start, and all further arguments: time, transient, draws ...
    sweep     the values of one parameter or shared component in an array, and one of each other
    reach     how far an attractor may move from value to value, relative to the extent of all attractors at all
              values; what is farther away is another one"""
    parameter, values, others = along_one(model, sweep)
    if not real(reach, "reach") > 0:
        raise Error(f"reach is {reach}: give a positive number")
    found = [attractors(model, {**others, parameter: value}, start=start, **options) for value in values]
    return Continuation(parameter, values, found, _matched(found, reach))


def _points(one: Attractor) -> Array:
    return np.stack(list(one.points.values()), axis=1)


def _matched(found: list[Attractors], reach: float) -> list[list[int]]:
    """The numbers of the attractors at each value."""
    every = [_points(one) for at in found for one in at]
    if not every:
        return [[] for _ in found]
    scale = found[0]._scale.spanning(np.concatenate(every))
    known: list[PointSet] = []  # where each number was last
    numbers = []
    for at in found:
        now = [PointSet(scale(_points(one)), True) for one in at]
        numbers.append(_nearest(now, known, reach))
        for one, number in zip(now, numbers[-1]):
            known[number:number + 1] = [one]
    return numbers


def _nearest(now: list[PointSet], before: list[PointSet], reach: float) -> list[int]:
    """The number of each set: that of the one before that is nearest, each taken once, or a new one."""
    pairs = sorted((max(a.off(b.some), b.off(a.some)), i, j) for i, a in enumerate(now) for j, b in enumerate(before))
    numbers = [-1] * len(now)
    taken: set[int] = set()
    for distance, i, j in pairs:
        if distance <= reach and numbers[i] < 0 and j not in taken:
            numbers[i] = j
            taken.add(j)
    following = len(before)
    for i in range(len(now)):
        if numbers[i] < 0:
            numbers[i], following = following, following + 1
    return numbers
