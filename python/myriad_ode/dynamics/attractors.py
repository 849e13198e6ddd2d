# SPDX-License-Identifier: MIT
"""`attractors`: what the orbits of an ensemble of starts come to, and from where."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from ..base import html
from ..base.errors import Error
from ..base.packages import package
from ..base.statuses import status_names
from ..sweeps.inputs import real
from . import attractor_plots
from .orbits import Motion, counted, wrapped
from .search import Found, Search, diverged, unsettled
from .starts import Starts, constant_values

if TYPE_CHECKING:
    import pandas
    import xarray
    from matplotlib.axes import Axes

    from ..models.any_model import AnyModel
    from ..sweeps.sweep import Sweep
    from ..symbolic.types import Array, ByComponent, Component, SomeComponents, Values
    from .steady_states import SteadyState

__all__ = ["Attractor", "Attractors", "attractors"]


_most_shown = 20


@dataclass(frozen=True, eq=False)
class Attractor:
    """A set that orbits come to."""

    kind: str  #: "fixed point", "cycle", "quasiperiodic", "chaotic", or "aperiodic" if that was not told
    period: float  #: of a cycle, in the model's unit of time; NaN of others
    returns: int  #: phases after which a cycle returns: periods of a forcing, points on a section; 0 of others
    points: dict[str, Array]  #: its points by state: the fixed point, those of one cycle, or many
    exponent: float  #: the largest Lyapunov exponent, per unit of time; NaN if it was not asked for
    steady_state: SteadyState | None  #: of a fixed point, where the equations are known: eigenvalues and kind
    starts: int  #: how many starts lead to it
    share: float  #: of all starts
    error: float  #: the standard error of the share, if starts are random draws; else NaN
    end: dict[str, float]  #: states and accessories of an orbit on it, from which it goes on
    _least: dict[str, float] = field(repr=False)  # what is less is rounding, by state

    @property
    def mean(self) -> dict[str, float]:
        """The mean of its points, by state."""
        return {name: float(of.mean()) for name, of in self.points.items()}

    @property
    def ranges(self) -> dict[str, tuple[float, float]]:
        """The least and the largest value of its points, by state."""
        return {name: (float(of.min()), float(of.max())) for name, of in self.points.items()}

    @property
    def name(self) -> str:
        """What it is in a few words."""
        if self.kind == "fixed point":
            return self.steady_state.kind if self.steady_state is not None else self.kind
        if self.kind != "cycle":
            return self.kind
        return f"cycle of period {self.period:.4g}" + (f" ({self.returns} returns)" if self.returns > 1 else "")

    def place(self, states: Sequence[str] = ()) -> str:
        """Where it is in words, in the ranges of its states, or of some of them."""
        return ", ".join(_range(name, low, high, self._least[name]) for name, (low, high) in self.ranges.items()
                         if not states or name in states)

    def __repr__(self) -> str:
        share = f"{100 * self.share:.4g}" + ("" if np.isnan(self.error) else f" +- {100 * self.error:.2g}")
        exponent = "" if np.isnan(self.exponent) else f", largest exponent {self.exponent:.4g}"
        return f"<{self.name}, {self.place()}{exponent}; {share} % of the starts>"


def _range(name: str, low: float, high: float, least: float) -> str:
    """A range in words: a number, if it is no wider than rounding."""
    low, high = (value if abs(value) > least else 0.0 for value in (low, high))
    if high - low <= max(least, 1e-6 * max(abs(low), abs(high))):
        return f"{name} = {low:.4g}"
    return f"{name} from {low:.4g} to {high:.4g}"


class Attractors(Sequence[Attractor]):
    """The attractors of a model, those with most starts first, and the basin that each start is in."""

    def __init__(self, found: list[Found], label: Array, search: Search, states: Sequence[str],
                 parameters: Mapping[str, Any]) -> None:
        starts = search.starts
        self.start: Sweep = starts.sweep  #: the starts
        self._values, self._angles = starts.values, search.motion.angles
        self._scale = search.scale
        self.parameters = dict(parameters)  #: their values, as they were given
        #: of each start the number of its attractor; -1: diverged or failed, -2: at none, after a long transient.
        #: With the axes of the starts
        self.labels: Array = label.reshape(starts.sweep.shape)
        counts, size = np.bincount(label + 2, minlength=len(found) + 2)[2:], label.size
        shares = counts / size
        error = np.sqrt(shares * (1 - shares) / size) if starts.is_random else np.full(len(found), np.nan)
        least = dict(zip(states, (1e-6 * search.scale.extent).tolist()))
        self._attractors = [
            Attractor(one.kind, one.period, one.returns, self._by_state(states, one.points), one.exponent,
                      one.steady_state, int(count), float(share), float(off), one.end, least)
            for one, count, share, off in zip(found, counts, shares, error)]
        self.notes: list[str] = search.notes  #: what to know of the result
        codes, of_failed = np.unique(search.status[label == diverged], return_counts=True)
        #: starts without an attractor by how their instances ended: "success" of those that have left all bounds
        self.diverged: dict[str, int] = {status_names[code]: int(count) for code, count in zip(codes, of_failed)}

    def _by_state(self, states: Sequence[str], points: Array) -> dict[str, Array]:
        return {name: wrapped(of) if name in self._angles else of for name, of in zip(states, points.T)}

    def __getitem__(self, number: Any) -> Any:
        return self._attractors[number]

    def __len__(self) -> int:
        return len(self._attractors)

    @property
    def shares(self) -> Array:
        """The share of all starts that each attractor has: of random starts its basin stability."""
        return np.array([one.share for one in self])

    @property
    def errors(self) -> Array:
        """The standard errors of the shares of random starts; NaN of others."""
        return np.array([one.error for one in self])

    @property
    def borders(self) -> Array:
        """Of a grid of starts, which have a neighbour along an axis that goes elsewhere."""
        found = np.zeros(self.labels.shape, bool)
        if any(name == "draw" for name, _ in self.start.axes):
            raise Error("starts are drawn at random, and have no neighbours: give a grid, my.grid({x: ..., v: ...})")
        for axis in range(self.labels.ndim):
            differs = np.diff(self.labels, axis=axis) != 0
            before = [(0, 0)] * self.labels.ndim
            for side in ((1, 0), (0, 1)):
                before[axis] = side
                found |= np.pad(differs, before)
        return found

    def plot(self, x: Component | None = None, y: Component | None = None, *, axes: Axes | None = None,
             **style: Any) -> Any:
        """The basins in colour, and the attractors in black, over two states: the axes of a grid of starts, or of
        other starts those named, by default the first two that vary. What has no attractor is grey. Further arguments
        go to matplotlib's `pcolormesh`, or of starts that are no grid to `plot`. Returns the axes."""
        return attractor_plots.basins(self, self._values, x, y, axes, style)

    def _columns(self) -> dict[str, Any]:
        ranges = [one.ranges for one in self]
        columns: dict[str, Any] = {key: [getattr(one, key) for one in self] for key in (
            "kind", "period", "returns", "exponent", "starts", "share", "error")}
        for name in (ranges[0] if ranges else ()):
            columns[f"{name}_min"] = [of[name][0] for of in ranges]
            columns[f"{name}_max"] = [of[name][1] for of in ranges]
            columns[f"{name}_mean"] = [one.mean[name] for one in self]
        return columns

    def to_pandas(self) -> pandas.DataFrame:
        """A row for each attractor: kind, period, share, and the range and mean of each state."""
        pandas = package("pandas", "to_pandas")
        return pandas.DataFrame(self._columns(), index=pandas.RangeIndex(len(self), name="attractor"))

    def to_xarray(self) -> xarray.Dataset:
        """The labels along the axes of the starts, and what `to_pandas` has along `attractor`."""
        xarray = package("xarray", "to_xarray")
        names = [name if name in ("draw", "instance") else f"{name}_start" for name, _ in self.start.axes]
        of = {axis: name for (axis, _), name in zip(self.start.axes, names)}
        coordinates = {f"{name}_start": (of[axis], np.asarray(values))
                       for name, (axis, values) in self.start.coordinates.items()}
        flags = {"flag_values": [unsettled, diverged], "flag_meanings": "unsettled diverged"}
        variables = {"label": (names, self.labels, flags),
                     **{name: ("attractor", values) for name, values in self._columns().items()}}
        return xarray.Dataset(variables, {**coordinates, "attractor": np.arange(len(self))})

    def _head(self) -> str:
        count, size = len(self), self.labels.size
        return f"{count} attractor{'s' if count != 1 else ''} from {size} starts"

    def __repr__(self) -> str:
        lines = [self._head(), *(f"{i}: {one!r}" for i, one in enumerate(self[:_most_shown]))]
        if len(self) > _most_shown:
            share = 100 * self.shares[_most_shown:].sum()
            lines.append(f"and {len(self) - _most_shown} more, with {share:.4g} % of the starts")
        if self.diverged:
            ended = ", ".join(f"{count} {'beyond all bounds' if name == 'success' else name}"
                              for name, count in self.diverged.items())
            lines.append(f"diverged or failed: {100 * (self.labels == diverged).mean():.4g} % of the starts ({ended})")
        return "\n".join([*lines, *(f"note: {note}" for note in self.notes)])

    def _repr_html_(self) -> str:
        shown = self[:_most_shown]
        rows = [(str(i), one.name, one.place(), f"{100 * one.share:.4g} %") for i, one in enumerate(shown)]
        return (html.paragraphs([self._head()]) + html.columns(["", "attractor", "where", "starts"], rows)
                + html.paragraphs(repr(self).splitlines()[1 + len(shown):]))


def attractors(model: AnyModel, sweep: Sweep | ByComponent | None = None, *, start: Sweep | ByComponent,
               time: tuple[Values, Values], transient: int = 200, phases: int = 120,
               states: SomeComponents | None = None, angles: SomeComponents = (), draws: int | None = None,
               seed: int = 0, tolerance: float = 0.01, exponents: bool | None = None, bound: float | None = None,
               stroboscopic: bool | None = None, **options: Any) -> Attractors:
    """Finds what the orbits from many starts come to, and from where: attractors, their kinds, and their basins.

    model       from `my.model(...)`, or another without noise
    sweep       the values of parameters and shared components, one of each
    start       initial states: a grid, `my.grid({x: np.linspace(-2, 2, 500), v: ...})`, arrays by name, or what draws
                them, `{x: my.uniform(-2, 2), v: my.normal(0, 1)}` with `draws`
    time        the domain of a phase: a period of the forcing, as in (0, 2 * np.pi); (0, np.inf) if an event of the
                model, with stop_after=1, ends it on a section; else a slice of time, a part of a period or a few
    transient   phases that are left out
    phases      phases after that, at whose ends orbits are compared. Cycles of up to this many returns are told, and
                of a flow, which needs no section, those whose period is at most half as many slices
    states      those to compare; all by default
    angles      states that are angles in radians, of which only the direction counts
    draws, seed   number of random starts, and the seed of their generator, NumPy's
    tolerance   what is nearer than this is one, relative to the extent of all ends of orbits in each state, or of a
                tenth of their motion if that is more
    exponents   whether largest Lyapunov exponents are computed: of what is neither fixed point nor cycle (None), to
                tell tori from chaos; of all (True); or not at all (False). They need a compiler
    bound       a state beyond which an orbit has diverged; 1e9 times the largest initial value, if that is above 1
    stroboscopic  whether points at the ends of phases are those of a map. By default where equations or events
                depend on time, an event ends phases, or the model is not recorded in Python

    Further arguments are those of `solve`: method, rtol, atol, device ...

    Every start is integrated for `transient + phases` phases. Orbits with equal features (mean, deviation, minimum and
    maximum of each state) are a group, and one of each group goes on for four times as long; groups whose sets of
    points then coincide have one attractor. Neither the order of the starts nor the phase on a cycle matters.

    Raises `Error` for what does not fit, before any work."""
    motion = Motion(model, constant_values(sweep, "my.continuation"), time, states, angles, stroboscopic, options)
    starts = Starts(motion.components, start, draws, seed)
    if not 0 < real(tolerance, "tolerance") < 0.5:
        raise Error(f"tolerance is {tolerance}: give a part of the extent of what is seen, as 0.01")
    if bound is not None and not real(bound, "bound") > 0:
        raise Error(f"bound is {bound}: give a positive number")
    search = Search(motion, starts, counted(transient, "transient", 0), counted(phases, "phases", 8), tolerance,
                    exponents, bound)
    found, label = search.run()
    parameters = {getattr(key, "value", ("", key))[1]: value for key, value in motion.values.items()}
    return Attractors(found, label, search, motion.states, parameters)
