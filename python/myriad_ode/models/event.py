# SPDX-License-Identifier: MIT
"""What a model does beside its equations: events, stops, and summaries over phases."""

from __future__ import annotations

import copy
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ..base import component_kinds as kinds
from ..base.errors import Error, at, users_line
from ..symbolic import symbols as sym
from ..symbolic.node import symbols_of
from ..symbolic.numbers import is_whole

if TYPE_CHECKING:
    from ..symbolic.types import ByComponent, Direction, Written

__all__ = ["event", "stop", "Event", "Stop", "phase_maximum", "phase_minimum", "time_of_maximum", "time_of_minimum",
           "integral"]
_directions = ("rising", "falling", "either", "none")


class Summary:
    """What is computed from a quantity over a phase, along the solution and not only at the ends of steps."""

    def __init__(self, kind: str, quantity: Any) -> None:
        self.kind, self.quantity, self.line = kind, quantity, users_line()
        self.observed = self.accessory = ""  # names, known with the model


def phase_maximum(quantity: Written) -> Summary:
    """For an accessory: the largest value of a quantity over each phase."""
    return Summary("maximum", quantity)


def phase_minimum(quantity: Written) -> Summary:
    """For an accessory: the smallest value of a quantity over each phase."""
    return Summary("minimum", quantity)


def time_of_maximum(quantity: Written) -> Summary:
    """For an accessory: when the quantity was largest; another accessory has its `phase_maximum`."""
    return Summary("time_of_maximum", quantity)


def time_of_minimum(quantity: Written) -> Summary:
    """For an accessory: when the quantity was smallest; another accessory has its `phase_minimum`."""
    return Summary("time_of_minimum", quantity)


def integral(quantity: Written) -> Summary:
    """For an accessory: the integral of a quantity over time, from the start of each phase."""
    return Summary("integral", quantity)


class Event:
    """A change of sign of a function of time and state; `do` is what happens then."""

    def __init__(self, function: Any, name: str | None, direction: Direction, tolerance: float | None, stop_after: int,
                 do: Any) -> None:
        self.function, self.name, self.direction = function, name, direction
        self.tolerance, self.stop_after, self.do = tolerance, stop_after, do
        self.line = users_line()

    def __repr__(self) -> str:
        return f"event {self.name or ''}: {self.function!r} {self.direction}"


def event(function: Written, *, name: str | None = None, direction: Direction = "either",
          tolerance: float | None = None, stop_after: int = 0, do: ByComponent | None = None) -> Event:
    """An event of a model: `function` changes its sign, "rising", "falling" or "either" ("none": switched off). Every
    change between the ends of steps is found; `tolerance` is the largest value of the function at which it counts as
    located (default, or 0: as close as time and state resolve). After `stop_after` detections the phase ends (0:
    never). `do` are assignments at the event: {v: -r * v, my.end_phase: count == 5}.
    """
    if direction not in _directions:
        raise Error(f"the direction of an event is {direction!r}{at(users_line())}: choose \"rising\", \"falling\", "
                    "\"either\" or \"none\"")
    if not is_whole(stop_after, 0):
        raise Error(f"stop_after is {stop_after!r}{at(users_line())}: give the number of detections after which the "
                    "phase ends, 0 for never")
    if tolerance is not None and not (isinstance(tolerance, (int, float)) and 0 <= tolerance < float("inf")):
        raise Error(f"the tolerance of an event is {tolerance!r}{at(users_line())}: give the largest value of the "
                    "event function that counts as zero, as in tolerance=1e-8, or 0 for as close as it gets")
    if name is not None:
        sym.check_name(name, "an event")
    return Event(function, name, direction, tolerance, int(stop_after), {} if do is None else do)


class Stop:
    """Times at which steps end, one after the other; `do` is what happens there. A single time may be a function of
    `sym.stop_number`, infinite beyond the last one; `do` may then read the number too."""

    order = 1  #: among others at the same time: 0 before them, 2 after them

    def __init__(self, times: list[Any], every: Any, count: Any, name: str | None, do: Any) -> None:
        self.times, self.every, self.count, self.name, self.do = times, every, count, name, do
        self.line = users_line()

    @property
    def values(self) -> list[Any]:
        """All expressions that the times are computed from."""
        return [*self.times, *(e for e in (self.every, self.count) if e is not None)]

    @property
    def by_number(self) -> bool:
        """Whether its time is a function of the number."""
        return any(s is sym.stop_number for s in symbols_of(self.times))


def stop(time: Written | Sequence[Written], *, every: Written | None = None, count: Written | None = None,
         name: str | None = None, do: ByComponent | None = None) -> Stop:
    """Exact times of a model: steps end there, no root is sought, and `do` are the assignments made. `time` is one
    time, or several that do not decrease; with `every` the first of `count` times at equal intervals (default: without
    an end), as in stop(0, every=24, count=doses, do={gut: gut + dose}). Times are numbers or expressions of parameters,
    shared values and accessories, and may change: a stop acts at the time that an accessory has, and again where an
    action sets another one that is not yet over. They act at both ends of a phase too, but once where one phase goes on
    from another.
    """
    several = list(time) if isinstance(time, (list, tuple, np.ndarray)) else [time]
    if not several or every is not None and len(several) > 1 or every is None and count is not None:
        raise Error(f"the times of a stop are {time!r}, every={every!r}, count={count!r}{at(users_line())}: give one "
                    "time or a list of times, or the first one with every= and maybe count=")
    if name is not None:
        sym.check_name(name, "a stop")
    return Stop(several, every, count, name, {} if do is None else do)


def stops_apart(several: Stop) -> list[Stop]:
    """A stop for each of several times that actions may set, as those need not stay in order."""
    if len(several.times) == 1 or not any(s.value[0] in kinds.accessories for s in symbols_of(several.times)):
        return [several]
    made = []
    for k, time in enumerate(several.times):
        one = copy.copy(several)
        one.times, one.name = [time], several.name if k == 0 else f"{several.name}_{k + 1}"
        made.append(one)
    return made
