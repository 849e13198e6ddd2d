# SPDX-License-Identifier: MIT
"""Triggers of a model: conditions of several comparisons, whose actions run where they come to hold, or later."""

from __future__ import annotations

import re
import sys
from collections.abc import Callable, Iterator, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ..base.errors import Error, at, users_line
from ..symbolic import expression as ex, functions as fn, symbols as sym
from ..symbolic.node import symbols_of, text
from ..symbolic.folding import both, choose, compare, either, is_constant, number, opposite, subtract, value_of
from ..symbolic.numbers import is_whole
from .event import Event
from .remainders import equality

if TYPE_CHECKING:
    from ..symbolic.types import Assignments, ByComponent, Written

__all__ = ["trigger", "Trigger"]

_rooms = 1, 4  #: how many actions of a trigger may wait: without a delay, and with one
_most_waiting = 1000  #: actions of a model: each has a place in every instance, at which kernels look one by one


#: What a model with triggers has besides what users name.
own_names = re.compile(r"trigger|condition|after_trigger|initial_value|persistent|queue|stop|stop_time|due|due_count|"
                       r"due_(time|action|turn)_\d+|due_value_\d+_\d+|.+_ceases|"
                       r".+_side_\d+(_is_(zero|over)(_side_1)?)?")


class Trigger:
    """A condition; `do` is what happens where it comes to hold."""

    def __init__(self, condition: Any, do: Any, delay: Any, priority: Any, initial_value: bool, persistent: bool,
                 values_from_trigger_time: bool, room: int, name: str | None) -> None:
        self.condition, self.do, self.delay, self.priority = condition, do, delay, priority
        self.initial_value, self.persistent, self.room, self.name = initial_value, persistent, room, name
        self.values_from_trigger_time = values_from_trigger_time
        self.values: list[Any] = []  #: what the action gets from the time of the trigger, as its `waiting_value`s
        self.as_given: Trigger | None = None  #: as it was written; None of one that nobody has written
        self.line = users_line()

    def __repr__(self) -> str:
        return f"trigger {self.name or ''}: {self.condition!r}"


def trigger(condition: Written, *, do: ByComponent | None = None, delay: Written | None = None,
            priority: Written | None = None, initial_value: bool = True, persistent: bool = True,
            values_from_trigger_time: bool = False, room: int | None = None, name: str | None = None) -> Trigger:
    """A trigger of a model: `do` are the assignments made where `condition` comes to hold, a combination of comparisons
    by &, | and ~, as in trigger((x > 1) & (t < 5), do={v: 0}). Each comparison is located as an event is. x == 1 holds
    for an instant where x crosses 1, or an action puts it there.

    With a `delay`, in units of time, the action waits. There is `room` for so many actions of each trigger (4, or 1
    without a delay); if more wait than the triggers of a model together have room for, the instance ends as
    `queue_overflow`. If `persistent` is false, what waits is dropped where the condition ceases to hold. The values of
    `do` are those at the action, or with `values_from_trigger_time` those where the condition came to hold.

    Of the actions of one instant that with the largest `priority` comes first; those without one come last. Else the
    first that was triggered comes first, unless the model has a `tie_seed`. Delay and priority may be expressions: a
    delay counts where the condition comes to hold, a priority at the action. `initial_value` is what the condition
    counts as before the start: with False, one that holds at the start comes to hold there.
    """
    line = at(users_line())
    if room is not None and not is_whole(room, 1):
        raise Error(f"the room of a trigger is {room!r}{line}: give the number of its actions that may wait at one "
                    "time, as in room=10")
    if room is not None and room > _most_waiting:
        raise Error(f"the room of a trigger is {room}{line} (at most {_most_waiting}, as every instance has a place "
                    "for each action): give the number of its actions that may wait at one time")
    for flag, value in (("initial_value", initial_value), ("persistent", persistent),
                        ("values_from_trigger_time", values_from_trigger_time)):
        if not isinstance(value, (bool, np.bool_)):
            raise Error(f"{flag} of a trigger is {value!r}{line}: give True or False")
    if name is not None:
        sym.check_name(name, "a trigger")
    return Trigger(condition, {} if do is None else do, delay, priority, bool(initial_value), bool(persistent),
                   bool(values_from_trigger_time), int(room or _rooms[delay is not None]), name)


class Queue:
    """Where actions wait: the names of the accessories of a `myriad::action_queue`."""

    stop = "due"  #: the kind of stop times at which they run

    def __init__(self, triggers: Sequence[Trigger], seed: int | None) -> None:
        if not triggers or seed is not None and not is_whole(seed, 0, 2**63 - 1):
            raise Error(f"tie_seed is {seed!r}{at(users_line())}: give a model with triggers a whole number from 0 on")
        self.seed = -1 if seed is None else int(seed)  #: of the order of actions of one priority; -1: as triggered
        self.capacity, self.values = sum(t.room for t in triggers), max(len(t.values) for t in triggers)
        if self.capacity > _most_waiting:
            raise Error(f"the triggers have room for {self.capacity} actions{at(triggers[0].line)} (at most "
                        f"{_most_waiting} in a model, as every instance has a place for each): give them a smaller "
                        "room=")
        places = range(1, self.capacity + 1)
        self.accessories = [f"due_time_{i}" for i in places]
        self.accessories += [f"due_value_{v + 1}_{i}" for v in range(self.values) for i in places]
        self.integers = [f"due_{what}_{i}" for what in ("action", "turn") for i in places] + ["due_count"]


class Edge:
    """Where a condition of `side`s comes to hold. It puts or runs the action of `starts`, or drops what waits with the
    number `drops`."""

    def __init__(self, name: str, condition: Any, starts: Trigger | None = None, drops: int = -1) -> None:
        self.name, self.condition, self.starts, self.drops = name, condition, starts, drops
        self.initial_value = starts is None or starts.initial_value
        self.persistent = starts is None or starts.persistent


def needs_queue(triggers: Sequence[Trigger]) -> bool:
    """Whether actions have to wait for each other: without a queue they run as soon as they are triggered."""
    return any(t.delay is not None or t.priority is not None or t.values or t.values_from_trigger_time
               for t in triggers)


def edges_of(triggers: Sequence[Trigger], queue: Queue | None) -> Iterator[Edge]:
    """The edges of the triggers, in their order, and then those where conditions cease to hold."""
    for one in triggers:
        yield Edge(str(one.name), one.condition, starts=one)
    if queue is not None:
        for number, one in enumerate(triggers):
            if not one.persistent:
                yield Edge(part_name(one.name, "ceases"), opposite(one.condition), drops=number)


def part_name(of: str | None, part: str) -> str:
    """The name of a part of a trigger: without the two underscores at once that no name of C++ may have."""
    return f"{of}x_{part}" if of and of.endswith("_") else f"{of}_{part}"


def side(name: str) -> Any:
    """The condition that an event function is on its positive side."""
    return ex.make("symbol", value=("side", name), type=ex.condition)


def waiting_value(number: int) -> Any:
    """What stands in an action for a value from the time of its trigger."""
    return ex.make("symbol", value=("waiting", str(number)))


def keep_values(one: Trigger) -> Assignments:
    """The assignments of a trigger's action, with the values from the time of the trigger as `waiting_value`s."""
    kept: Assignments = []
    for target, value in one.do:
        if symbols_of([value]):
            place = waiting_value(len(one.values))
            one.values.append(number(value))
            value = place != 0 if value.type == ex.condition else place
        kept.append((target, value))
    return kept


class Sides:
    """The event functions of conditions. `is_still` tells what changes at events and other hooks alone."""

    def __init__(self, is_still: Callable[[Any], bool]) -> None:
        self._is_still = is_still
        self.functions: dict[Any, str] = {}  #: their names
        self.instants: dict[Any, Any] = {}  #: of functions whose zeros are such, accessories that say that one is now

    def of(self, condition: Any, what: str) -> Any:
        """A condition as one of sides. `what` is the name of its trigger."""
        self._what, self._first = what, len(self.functions)
        self._made: dict[Any, Any] = {}  # as formulas share their parts
        return self._of(condition)

    def _of(self, condition: Any) -> Any:
        if condition not in self._made:
            self._made[condition] = self._written(condition)
        return self._made[condition]

    def _written(self, condition: Any) -> Any:
        if condition.op in ("and", "or"):
            return (both if condition.op == "and" else either)(*map(self._of, condition.args))
        if condition.op == "not":
            return opposite(self._of(condition.args[0]))
        if is_constant(condition):
            return condition
        for i, part in enumerate(condition.args):
            if part.op == "select":  # the comparison of the value that is chosen
                first, second = (compare(condition.op, *(value if j == i else other
                                                         for j, other in enumerate(condition.args)))
                                 for value in part.args[1:])
                return self._of(choose(part.args[0], first, second))
        if only_jumps(condition, self._is_still):  # a difference may stay zero for a while
            return self._named(fn.where(condition, 1.0, -1.0))
        if condition.op in ("greater_equal", "less"):  # zero counts as positive
            above = self._named(subtract(*condition.args))
            return above if condition.op == "greater_equal" else opposite(above)
        if condition.op in ("less_equal", "greater"):
            below = self._named(subtract(*condition.args[::-1]))
            return below if condition.op == "less_equal" else opposite(below)
        if condition.op in ("equal", "not_equal"):
            of_remainder = equality(*condition.args)
            holds = self._is_zero(*condition.args) if of_remainder is None else self._of(of_remainder)
            return holds if condition.op == "equal" else opposite(holds)
        raise Error(f"`{text(condition)}` in trigger {self._what} is no comparison: write it with <, <=, >, >=, == or "
                    "!=")

    def _is_zero(self, a: Any, b: Any) -> Any:
        """Whether two sides are equal: at the instant of a crossing, or where an action has made them so."""
        function = subtract(a, b)
        there = both(self._named(function), self._named(subtract(b, a)))
        if function not in self.instants:
            self.instants[function] = sym.integer_accessory(f"{self.functions[function]}_is_zero")
        return either(there, self._named(fn.where(self.instants[function] == 1, 1.0, -1.0)))

    def _named(self, function: Any) -> Any:
        number = len(self.functions) - self._first + 1
        return side(self.functions.setdefault(function, part_name(self._what, f"side_{number}")))

    def events(self) -> Iterator[Event]:
        """The events of the functions. Those of instants note that they have come."""
        for function, name in self.functions.items():
            instant = self.instants.get(function)
            yield Event(function, name, "either", None, 0, [] if instant is None else [(instant, ex.constant(1))])

    def after_instants(self, triggers: Sequence[Trigger]) -> Iterator[Trigger]:
        """Triggers behind all others, at which instants are over."""
        if not self.instants:
            return
        for one in triggers:
            if one.priority is None:
                one.priority = ex.constant(-sys.float_info.max)
        for function, instant in self.instants.items():
            name = f"{self.functions[function]}_is_over"
            over = Trigger(self.of(instant == 1, name), [(instant, ex.constant(0))], None, None, True, True, False, 1,
                           name)
            yield over


def only_jumps(condition: Any, is_still: Callable[[Any], bool]) -> bool:
    """Whether a condition changes at jumps alone, as floor(time) == 3 and what only hooks change."""
    waiting, seen = [condition], set()
    while waiting:
        part = waiting.pop()
        if part in seen:
            continue
        seen.add(part)
        if part is not condition and part.type == ex.condition or part.op in ("floor", "rint") or is_still(part):
            continue
        if part.op == "symbol":
            return False
        waiting += part.args
    return True


def check(one: Trigger, what: str) -> None:
    """Refuses a trigger whose delay is negative or whose condition is known."""
    if is_constant(one.condition):
        raise Error(f"the condition of {what}{at(one.line)} always {'holds' if value_of(one.condition) else 'fails'}: "
                    "compare something that changes")
    if one.delay is not None and is_constant(one.delay) and not 0 <= value_of(one.delay) < float("inf"):
        raise Error(f"the delay of {what}{at(one.line)} is {text(one.delay)}: it is a time, of zero or more")
