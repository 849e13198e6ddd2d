# SPDX-License-Identifier: MIT
"""Doses: amounts that states get at known times, at once or as infusions, in a model that is recorded or read from a
file."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ..base.errors import Error, at as written_at, users_line
from ..symbolic import symbols as sym
from ..symbolic.expression import constant, floor
from ..symbolic.folding import add, divide, is_constant, multiply, subtract
from ..symbolic.functions import maximum, minimum, where
from .components import name_of
from .event import Stop, stop

if TYPE_CHECKING:
    from ..symbolic.types import Component, Written

__all__ = ["doses"]

# A quotient this close below a whole number is that number: (24 - 0) / 0.1 is 239.99999999999997.
_rounding = 1e-12
_numbers = (int, float, np.number)
_at_once = ", or leave it out for doses at once"


class Doses:
    """Amounts that a state gets at known times. Made by `my.doses`."""

    def __init__(self, into: Any, amounts: list[Any], times: list[Any], every: Any, count: Any, until: Any, rate: Any,
                 duration: Any, lag: Any, bioavailability: Any) -> None:
        self.into, self.amounts, self.times, self.every, self.count, self.until = (into, amounts, times, every, count,
                                                                                   until)
        self.rate, self.duration, self.lag, self.bioavailability = rate, duration, lag, bioavailability
        self.line = users_line()

    def __repr__(self) -> str:
        return f"doses into {name_of(self.into)} at {self.times!r}"

    def read(self, expression: Callable[[Any, str], Any]) -> Doses:
        """The same with expressions in place of texts and numbers."""
        def of(value: Any, what: str) -> Any:
            return None if value is None else expression(value, f"{what} of doses")

        made = Doses(self.into, [of(one, "the amount") for one in self.amounts],
                     [of(one, "the time") for one in self.times], of(self.every, "the interval"),
                     of(self.count, "the number"), of(self.until, "the end"), of(self.rate, "the rate"),
                     of(self.duration, "the duration"), of(self.lag, "the lag"),
                     of(self.bioavailability, "the bioavailability"))
        made.line = self.line
        return made

    hidden: frozenset[str] = frozenset()  # accessories that it adds

    @property
    def parts(self) -> list[Doses]:
        """Those of each state."""
        return [self]

    @property
    def values(self) -> list[Any]:
        """All expressions of it."""
        others = (self.every, self.count, self.until, self.rate, self.duration, self.lag, self.bioavailability)
        return [*self.amounts, *self.times, *(one for one in others if one is not None)]

    @property
    def number(self) -> Any:
        """How many doses there are at equal intervals; None if they go on."""
        if self.until is None:
            return self.count
        intervals = (self.until - self.times[0]) / self.every
        return floor(intervals + _rounding * (1.0 + maximum(intervals, 0.0))) + 1.0

    @property
    def is_infusion(self) -> bool:
        """Whether doses take a while."""
        return self.rate is not None or self.duration is not None

    def stops(self, target: Any, free_name: Callable[[str], str], states: Sequence[Any]) -> list[Stop]:
        """The stops at which a state gets what is given at once: one for each amount whose times are known numbers,
        and else one for each time, as their order is not known."""
        if self.is_infusion:
            return []
        in_order = all(is_constant(time) for time in self.times)
        together: dict[int, tuple[Any, list[Any]]] = {}
        for number, (amount, time) in enumerate(zip(self.amounts, self.times)):
            together.setdefault(id(amount) if in_order else number, (amount, []))[1].append(add(time, self.lag))
        interval = {} if self.every is None else {"every": self.every, "count": self.number}
        made = []
        for amount, times in together.values():
            one = stop(times if self.every is None else times[0], **interval, name=free_name(f"{target.value[1]}_dose"),
                       do={target: target + multiply(self.bioavailability, amount)})
            one.line = self.line
            made.append(one)
        return made

    def at_start(self, target: Any, known: Mapping[Any, Any]) -> dict[Any, Any]:
        """What is assigned at the start of a phase, besides what is known: nothing."""
        return {}

    def inflow(self) -> Any:
        """What infusions add to the derivative of the state, a function of time."""
        total = constant(0.0)
        for amount, time in zip(self.amounts if self.is_infusion else (), self.times):
            amount, begin = multiply(self.bioavailability, amount), add(time, self.lag)
            # with a given rate what is available of the amount takes as long as it takes, as in NONMEM
            rate, duration = ((self.rate, divide(amount, self.rate)) if self.duration is None else
                              (divide(amount, self.duration), self.duration))
            total = add(total, rate * (self._begun(begin) - self._begun(begin + duration)))
        return total

    def _begun(self, first: Any) -> Any:
        """How many of the times that follow each other from the first one on are over."""
        if self.every is None:
            return where(sym.time >= first, 1.0, 0.0)
        begun = maximum(floor(subtract(sym.time, first) / self.every) + 1.0, 0.0)
        return begun if self.number is None else minimum(begun, self.number)


def doses(into: Component, amount: Written | Sequence[Written], *, at: Written | Sequence[Written] = 0.0,
          every: Written | None = None, count: Written | None = None, until: Written | None = None,
          rate: Written | None = None, duration: Written | None = None, lag: Written = 0.0,
          bioavailability: Written = 1.0) -> Doses:
    """Doses for `model.with_doses`: the state `into` gets `amount`, in its unit, at each time `at`.

    amount           of each dose; with several times also a list with one for each
    at               a time, or several, in the model's unit of time; numbers in increasing order
    every            the interval to the next dose; `at` is then the time of the first one
    count, until     with `every`: how many doses there are, or the time after which there are none; else without an end
    rate, duration   of an infusion, in amounts by time, or in time, above zero; without either a dose is given at once
    lag              how much later than at its time a dose comes
    bioavailability  the part of a dose that comes: an infusion of a given rate is shorter by it, one of a given
                     duration slower

    All are numbers or expressions of parameters, shared values and accessories, so that they may differ between
    instances, and have derivatives. Steps end exactly at the times of doses, and where infusions begin and end, which
    may overlap. A time that is an end of the time domain counts, also the first one. Before the time domain no dose is
    given at once, and infusions that are under way where it begins go on. Time must go forwards.
    """
    times, line = _several(at), users_line()
    amounts = _several(amount)
    if len(amounts) == 1:
        amounts *= len(times)
    if not times or len(amounts) != len(times):
        raise Error(f"doses have {len(amounts)} amounts at {len(times)} times{written_at(line)}: give one amount, or "
                    "one for each time")
    numbers = [time for time in times if isinstance(time, _numbers)]
    if len(numbers) == len(times) and any(later < earlier for earlier, later in zip(numbers, numbers[1:])):
        raise Error(f"the times {times!r} of doses decrease{written_at(line)}: sort them")
    if every is not None and len(times) > 1:
        raise Error(f"doses have {len(times)} times and every={every!r}{written_at(line)}: give one time, of the first "
                    "dose, with every=, or all times")
    if count is not None and until is not None:
        raise Error(f"doses have count={count!r} and until={until!r}{written_at(line)}: give one of them")
    if every is None and (count is not None or until is not None):
        given = "count" if until is None else "until"
        raise Error(f"doses have {given}= but no interval{written_at(line)}: give every=")
    for name, value, otherwise in (("every", every, ""), ("rate", rate, _at_once), ("duration", duration, _at_once)):
        if isinstance(value, _numbers) and not value > 0:
            raise Error(f"doses have {name}={value!r}{written_at(line)}: give a number above zero{otherwise}")
    if isinstance(count, _numbers) and not (count >= 0 and float(count).is_integer()):
        raise Error(f"doses have count={count!r}{written_at(line)}: give a whole number, or leave it out for doses "
                    "without an end")
    if rate is not None and duration is not None:
        raise Error(f"doses have rate={rate!r} and duration={duration!r}{written_at(line)}: give one of them, from "
                    "which the amount gives the other")
    return Doses(into, amounts, times, every, count, until, rate, duration, lag, bioavailability)


def _several(given: Any) -> list[Any]:
    is_list = isinstance(given, (Sequence, np.ndarray)) and not isinstance(given, str)
    return list(given) if is_list else [given]
