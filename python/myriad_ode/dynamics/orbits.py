# SPDX-License-Identifier: MIT
"""Points of orbits after a transient: at the ends of phases, which are periods of a forcing or returns to a section; or
of a flow without either at times that have no common measure with any period."""

from __future__ import annotations

import contextlib
import copy
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ..base.errors import Error, refuse_options
from ..base.packages import installed
from ..models import delays
from ..models.any_model import AnyModel
from ..models.components import listed
from ..models.recorded import RecordedModel
from ..models.tangents import WithTangents
from ..solving.core_options import per_state
from ..solving.gather import ends_of
from ..solving.options import Options
from ..solving.solve import solve
from ..sweeps.inputs import real, whole
from ..symbolic.node import symbols_of
from ..symbolic.symbols import time
from .starts import components_of

if TYPE_CHECKING:
    from ..results.run import Run
    from ..symbolic.types import Array, SomeComponents, Values

samples_of_phase = 8  # of a flow
_most_numbers = 16_000_000  # of points that are in memory at a time
_taken = {"phases": "phases= and transient=", "record": "states=", "samples": "phases=, the number of points",
          "paths": "draws=", "size": "start=", "free": "nothing: it has no use here",
          "carry_on": "time=, the domain of one phase", "phase_length": "time=, the domain of one phase",
          "options": "options by their names", "tolerance_scale": "rtol= and atol="}
_further = ["method", "control", "precision", "device", "interpreted", "make_consistent", "progress"]


class Orbits(NamedTuple):
    """Points of orbits by state, as the array `points` (orbits, points, states); all states and accessories at their
    ends by name, from which they go on; codes of their statuses; and the times of the phases, where they are known."""

    points: Array
    ends: dict[str, Array]
    status: Array
    failed: Array
    times: Array | None


class Motion:
    """How a model moves with some parameters: what a call of `solve` needs for points of orbits."""

    def __init__(self, model: AnyModel, values: Mapping[Any, Any], domain: tuple[Values, Values] | None,
                 states: SomeComponents | None, angles: SomeComponents, stroboscopic: bool | None,
                 options: Mapping[str, Any]) -> None:
        self.model, self.values, self.components = model, dict(values), components_of(model)
        _refuse(model, options)
        self.begin, self.end = (real(value, f"the {which} of time") for which, value in zip(("begin", "end"),
                                                                                            ends_of(domain)))
        named = self.components.numbers(model.states if states is None else listed(states), "states=", ["state"])[0]
        turning = self.components.numbers(listed(angles), "angles=", ["state"])[0]
        self.states = [model.states[i] for i in sorted({*named, *turning})]  #: that are compared
        if not self.states:
            raise Error("states= names no state: name at least one, or leave it out for all")
        self.angles = [model.states[i] for i in turning]
        self.options = dict(options)
        self.has_section = any(getattr(one, "stop_after", 0) for one in model.events) or any(
            dict(choice).get("stop_after", 0) for choice in (options.get("events") or {}).values())
        #: whether points are those at the ends of phases, else those of a flow
        self.is_map = self._is_map() if stroboscopic is None else bool(stroboscopic)
        if not self.begin < self.end:
            raise Error(f"time goes from {self.begin:g} to {self.end:g}: give an end after the begin, as orbits come "
                        "to an attractor forwards")
        if not self.is_map and not np.isfinite([self.begin, self.end]).all():
            raise Error("no event ends a phase, and time has no end: give a slice of time, as in time=(0, 1), or the "
                        "model an event with stop_after=1")
        if self.is_map and "step" not in self.options:
            self.options.setdefault("carry_on_step", True)

    def _is_map(self) -> bool:
        """Whether points are those at the ends of phases: where something depends on time or happens at their ends."""
        model = self.model
        if self.has_section or not isinstance(model, RecordedModel):
            return True
        functions = [*model.equations.values(), *(one.function for one in model.events)]
        at_ends = {target.value[0] for target, _ in (*model.initialise, *model.finalise)}
        return bool(model.stops) or "state" in at_ends or any(
            symbol is time for symbol in symbols_of(functions))

    def at(self, parameter: str, value: Any) -> Motion:
        """The same with another value of a parameter."""
        made = copy.copy(self)
        made.values = {**self.values, parameter: value}
        return made

    @property
    def phase(self) -> float:
        """How long a phase lasts; infinite if an event ends it."""
        return self.end - self.begin

    def _run(self, starts: Mapping[str, Values], model: AnyModel | None = None, **more: Any) -> Run:
        return solve(self.model if model is None else model, self.values, start=starts, **{
            "time": (self.begin, self.end), "advice": False, **self.options, **more})

    def run_with_tangents(self, starts: Mapping[str, Values], transient: int, phases: int) -> Run:
        """A run from some states with a tangent vector, in phases as of `time`."""
        model = WithTangents(self.model, 1, transient)
        return self._run(starts, model, phases=transient + phases)

    def orbits(self, starts: Mapping[str, Array], transient: int, count: int, stay: bool = False) -> Orbits:
        """So many points of each orbit after so many phases. With `stay` they stay on a GPU that they were made on,
        as an array of CuPy, if that is installed."""
        if not self.is_map:
            return self._of_flow(starts, transient, count, stay)
        run = self._run(starts, phases=transient + count,
                        record={"from_phase": transient, "states": self.states, "time": True})
        points = self._points(run, stay, run.records, run.device.__getitem__)
        return Orbits(points, self._ends(run), run.status_codes, run.failed, run["t"])

    def _points(self, run: Run, stay: bool, here: Mapping[str, Array], there: Callable[[str], Any]) -> Array:
        """Records or samples of the states, on the host or on the GPU."""
        cupy = installed("cupy") if stay and run.report.device.startswith("cuda") else None
        if cupy is not None:
            with contextlib.suppress(Error):  # of a run in parts they are on the host alone
                return _together([cupy.asarray(there(name)) for name in self.states])
        return _together([here[name] for name in self.states])

    def _of_flow(self, starts: Mapping[str, Array], transient: int, count: int, stay: bool) -> Orbits:
        before, window = transient * self.phase, count * self.phase
        times = self.begin + before + window * (np.arange(samples_of_phase * count) + 0.5) / (samples_of_phase * count)
        run = self.sampled(starts, times, self.begin + before + window)
        points = self._points(run, stay, run.samples, run.device.samples)
        ends = self._ends(run)
        early = ~run.failed & (run.stored_samples < len(times))  # where a hook has ended the phase
        if early.any():
            points = on_host(points)
            at_end = np.stack([ends[name][early] for name in self.states], axis=1)[:, None]
            points[early] = np.where(np.isnan(points[early]), at_end, points[early])
        return Orbits(points, ends, run.status_codes, run.failed, None)

    def sampled(self, starts: Mapping[str, Array], times: Array, end: float) -> Run:
        """A run in one phase with samples at some times."""
        slices = max(1.0, abs((end - self.begin) / self.phase))
        most = {"max_steps": int(min(2e9, 200_000 * slices)), **self.options}["max_steps"]
        return self._run(starts, time=(self.begin, end), samples={"states": self.states, "times": times},
                         max_steps=most)

    def evenly(self, starts: Mapping[str, Array], lengths: Array, count: int) -> Run:
        """A run for so long with so many samples at equal intervals."""
        return self._run(starts, time=(self.begin, self.begin + lengths), max_steps=2_000_000,
                         samples={"states": self.states, "evenly": count})

    def at_steps(self, starts: Mapping[str, Array], lengths: Array) -> Run:
        """A run for so long with samples at the ends of steps, a few thousand at most."""
        return self._run(starts, time=(self.begin, self.begin + lengths), max_steps=2_000_000,
                         samples={"states": self.states, "every": 1, "capacity": 4000})

    def least_extents(self, starts: Mapping[str, Array]) -> Array:
        """A millionth of what each state varies in the first phases of some orbits, as a state on a section varies no
        more at their ends; or of its tolerance, if that is more."""
        states = self.components.states
        atol = np.broadcast_to(per_state(self.options.get("atol", Options.atol), self.components, "atol", len(states)),
                               len(states))
        least = 1e-6 * np.array([atol[states.index(name)] for name in self.states])
        if self.is_map and len(next(iter(starts.values()))):
            run = self.at_steps(starts, np.asarray(self.phase))
            within = np.stack([run.samples[name] for name in self.states])
            least = np.maximum(least, 1e-6 * (np.nanmax(within, axis=(1, 2)) - np.nanmin(within, axis=(1, 2))))
        return least

    def _ends(self, run: Run) -> dict[str, Array]:
        kept = {**run.states, **run.accessories}
        return {name: np.array(values) for name, values in kept.items() if name not in self.components.hidden}

    def chunks(self, size: int, count: int) -> Sequence[slice]:
        """Parts of so many orbits whose points, those of `count` phases, are in memory together."""
        each = count * len(self.states) * (1 if self.is_map else samples_of_phase)
        length = max(64, _most_numbers // each)
        return [slice(begin, min(begin + length, size)) for begin in range(0, size, length)]


def _together(columns: Sequence[Array]) -> Array:
    """Arrays of equal shape, one for each coordinate, as one with them along its last axis; in memory each is whole."""
    return np.moveaxis(np.stack(columns), 0, -1)


def on_host(array: Any) -> Array:
    """An array of NumPy or of CuPy as one of NumPy."""
    return array if isinstance(array, np.ndarray) else array.get()


def _refuse(model: AnyModel, options: Mapping[str, Any]) -> None:
    if model.has_noise:
        raise Error("the model has noise, and an orbit with noise comes to no attractor: leave noise= out, or look at "
                    "histograms of a study")
    delays.refuse(model, "attractors", "follow it by phases of one call, as a state alone does not say where its orbit "
                  "goes on")
    if model.free or isinstance(model, WithTangents):
        raise Error("the model has tangents or sensitivities: give the model itself, and exponents=True")
    if model.writes_parameters:
        raise Error("a hook of the model changes parameters, which would not be the same for all orbits: make them "
                    "accessories")
    for name in options:
        if name in _taken:
            raise Error(f"there is no option '{name}' here: give {_taken[name]}")
    known = [*_further, *Options.__dataclass_fields__]
    refuse_options([name for name in options if name not in known], known, "solve")


def wrapped(angles: Array) -> Array:
    """Angles from -pi to pi."""
    return (angles + np.pi) % (2 * np.pi) - np.pi


def counted(value: int, name: str, least: int) -> int:
    """A whole number, at least so many."""
    if whole(value, name) < least:
        raise Error(f"{name} is {value}: give at least {least}")
    return int(value)


class Scale:
    """Coordinates in which 1 is the extent of what was seen: of the ends of orbits, and of their motion if that is
    more than ten times as large. What varies by less than `least`, by state, does not vary. An angle has two
    coordinates, its cosine and sine."""

    def __init__(self, motion: Motion, moving: Array, ends: Array, least: Array) -> None:
        self._angles = [name in motion.angles for name in motion.states]
        self.middle, self.extent = np.zeros((2, len(motion.states)))
        for c, is_angle in enumerate(self._angles):
            column = moving[..., c]
            if is_angle or not column.size:
                self.extent[c] = 1.0
                continue
            low, high = np.quantile(column.min(axis=1), 0.05), np.quantile(column.max(axis=1), 0.95)
            first, middle, last = np.quantile(ends[..., c], (0.01, 0.5, 0.99))
            extent = max(last - first, 0.1 * (high - low), 1e-6 * abs(middle))
            self.middle[c], self.extent[c] = middle, extent
        self.extent = np.maximum(self.extent, least)
        self.extent[self.extent == 0] = 1.0

    def spanning(self, points: Array) -> Scale:
        """The same for the extent of some points in rows."""
        made = copy.copy(self)
        extent = np.ptp(points, axis=0)
        made.middle, made.extent = points.mean(axis=0), np.where(extent > 0, extent, self.extent)
        return made

    def __call__(self, points: Array) -> Array:
        """Points, states along the last axis, in these coordinates."""
        columns = []
        for c, is_angle in enumerate(self._angles):
            column = points[..., c]
            columns += [np.cos(column), np.sin(column)] if is_angle else [(column - self.middle[c]) / self.extent[c]]
        return _together(columns)
