# SPDX-License-Identifier: MIT
"""`hysteresis`: states that are carried up and down a sweep."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from ..base import plots
from ..base.errors import Error, UnknownName
from ..base.packages import package
from ..models.components import name_of
from ..sweeps.inputs import real
from ..sweeps.sweep import Sweep
from .orbits import Motion, counted
from .starts import Starts, along_one

if TYPE_CHECKING:
    import xarray
    from matplotlib.axes import Axes

    from ..models.any_model import AnyModel
    from ..symbolic.types import Array, ByComponent, Component, SomeComponents, Values

__all__ = ["Hysteresis", "hysteresis"]


class Hysteresis:
    """Points of orbits over a parameter, each of which begins where the one before has ended."""

    def __init__(self, parameter: str, values: Array, states: list[str], branches: dict[str, Array]) -> None:
        self.parameter = parameter  #: the name of what is varied
        self.values = values  #: its values, in ascending order
        self.states = states  #: the names of the states that were kept
        #: by direction, "up" and "down", by state: points (values, starts, points); NaN where an orbit has failed
        self.branches: dict[str, dict[str, Array]] = {
            direction: {name: points[..., c] for c, name in enumerate(states)}
            for direction, points in branches.items()}

    def __getitem__(self, key: tuple[str, Component]) -> Array:
        """`result["up", x]`: the points of a state on the way up, (values, starts, points)."""
        if not isinstance(key, tuple) or len(key) != 2:
            raise Error(f"{key!r} has no direction: give direction and state, as in result[\"up\", x]")
        direction, state = key
        if direction not in self.branches:
            raise UnknownName(f"there is no way '{direction}': there is {', '.join(self.branches)}")
        return self.branches[direction][self._kept(state)]

    def _kept(self, state: Component) -> str:
        """The name of a state that was kept."""
        name = name_of(state)
        if name not in self.states:
            raise Error(f"there are no points of {name}: there are those of {', '.join(self.states)}")
        return name

    def differs(self, tolerance: float = 0.01) -> Array:
        """Where the way up and the way down have other orbits, for each value and start: where minimum, mean or maximum
        of a state differ by more than a part of the extent of all points."""
        if len(self.branches) < 2:
            raise Error("there is one direction alone: give carry=\"both\"")
        found = np.zeros(self.branches["up"][self.states[0]].shape[:2], bool)
        for name in self.states:
            up, down = self.branches["up"][name], self.branches["down"][name]
            seen = np.concatenate([up, down], axis=None)
            seen = seen[np.isfinite(seen)]
            extent = np.ptp(seen) if seen.size else 0.0
            for of in (np.min, np.mean, np.max):
                found |= np.abs(of(up, axis=2) - of(down, axis=2)) > real(tolerance, "tolerance") * extent
        return found

    def interval(self, tolerance: float = 0.01) -> tuple[float, float]:
        """The least and the largest value at which up and down differ, of any start; NaN if they differ nowhere."""
        there = self.values[self.differs(tolerance).any(axis=1)]
        return (float(there.min()), float(there.max())) if there.size else (np.nan, np.nan)

    def plot(self, y: Component, *, axes: Axes | None = None, **style: Any) -> Any:
        """The points of a state over the parameter, in a colour for each direction; those of the way up are larger, so
        that they show where both ways have the same. Further arguments go to matplotlib's `plot`. Returns the axes."""
        name = self._kept(y)
        rows = [np.reshape(of[name], (len(self.values), -1)) for of in self.branches.values()]
        words = np.repeat(list(self.branches), len(self.values))
        axes = plots.bifurcation(np.tile(self.values, len(rows)), np.concatenate(rows), by=words, xlabel=self.parameter,
                                 ylabel=name, axes=axes, **{"markersize": 2.5, **style})
        if len(rows) > 1:
            up = axes.lines[-len(rows)]
            up.set_markersize(2 * up.get_markersize())
        return axes

    def to_xarray(self) -> xarray.Dataset:
        """The points by state along direction, parameter, start and phase."""
        xarray = package("xarray", "to_xarray")
        dims = ("direction", self.parameter, "start", "phase")
        return xarray.Dataset({name: (dims, np.stack([of[name] for of in self.branches.values()]))
                               for name in self.states},
                              {"direction": list(self.branches), self.parameter: self.values})

    def __repr__(self) -> str:
        shape = self.branches[next(iter(self.branches))][self.states[0]].shape
        return (f"<{' and '.join(self.branches)} {self.parameter} from {self.values[0]:.6g} to {self.values[-1]:.6g}: "
                f"{shape[0]} values, {shape[1]} starts, {shape[2]} points of {', '.join(self.states)}>")


def hysteresis(model: AnyModel, sweep: Sweep | ByComponent, *, start: Sweep | ByComponent,
               time: tuple[Values, Values], transient: int = 200, phases: int = 60,
               carry: Literal["both", "up", "down"] = "both", states: SomeComponents | None = None,
               stroboscopic: bool | None = None, **options: Any) -> Hysteresis:
    """Carries states along the values of a parameter: at each value orbits begin where those at the one before have
    ended, so that they stay on a branch for as long as it is stable.

    model       from `my.model(...)`, or another without noise
    sweep       the values of one parameter or shared component in an array, and one of each other:
                `{k: np.linspace(-1, 1, 100), B: 0.3}`
    start       initial states at the first value: numbers, or arrays and grids for several orbits
    time        the domain of a phase, as of `my.attractors`
    transient   phases that are left out, at each value
    phases      phases after that whose points are kept: those at their ends, or of a flow even ones
    carry       "up" from the least value to the largest, "down", or "both", up first and then down from there
    states      those to keep; all by default
    stroboscopic  as of `my.attractors`

    Further arguments are those of `solve`: method, rtol, atol, device ..."""
    if carry not in ("both", "up", "down"):
        raise Error(f"carry is {carry!r}: give \"up\", \"down\" or \"both\"")
    parameter, values, others = along_one(model, sweep)
    values = np.sort(values)
    motion = Motion(model, {**others, parameter: values[0]}, time, states, (), stroboscopic, options)
    starts = Starts(motion.components, start, None, 0, "give NumPy's random numbers, in an array")
    counted(transient, "transient", 0)
    counted(phases, "phases", 1)
    branches, ends = {}, dict(starts.values)
    for direction in ("up", "down") if carry == "both" else (carry,):
        branches[direction], ends = _carried(motion, parameter, values if direction == "up" else values[::-1], ends,
                                             transient, phases)
        if direction == "down":
            branches[direction] = branches[direction][::-1]
    return Hysteresis(parameter, values, motion.states, branches)


def _carried(motion: Motion, parameter: str, values: Array, ends: dict[str, Array], transient: int,
             phases: int) -> tuple[Array, dict[str, Array]]:
    """Points (values, starts, phases, states) along values in this order, and the ends at the last one. What has failed
    is NaN from there on."""
    kept, lost = [], np.zeros(len(next(iter(ends.values()))), bool)
    before = {name: np.array(of) for name, of in ends.items()}
    for value in values:
        orbits = motion.at(parameter, value).orbits(before, transient, phases)
        lost |= orbits.failed
        kept.append(np.where(lost[:, None, None], np.nan, orbits.points))
        before = {name: np.where(lost, before.get(name, of), of) for name, of in orbits.ends.items()}
    return np.stack(kept), before
