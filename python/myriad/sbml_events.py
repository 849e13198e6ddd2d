# SPDX-License-Identifier: MIT
"""Events of SBML as events of a model: those whose actions are at the time of their trigger.

A trigger is a condition, and an event of a model a real function that rises through zero: it is positive where the
condition holds, the least of two functions for `and`, the largest for `or`. What an action makes true at the same
instant is worked out in the action itself, in stages. SBML leaves open in which order events at one instant are
executed, but for priorities: where the order matters, the instance ends.
"""

from __future__ import annotations

import functools
import math
from dataclasses import dataclass, field
from typing import Any

from . import expression as ex, symbols as sym
from .expression import symbols_of, walk
from .model import Event, event
from .sbml_document import named
from .sbml_math import (Refused, both, choose, compare, constant, divide, either, folded, is_constant, multiply, number,
                        opposite, truth, value_of)
from .sbml_semantics import Quantity, Semantics

_stages = 4  #: of events that make others' triggers true at one instant
_near = 1e-10  #: relative difference of times that count as one instant


@dataclass
class Occurrence:
    """An event of the file."""

    id: str
    where: str
    trigger: Any  #: a condition
    function: Any  #: positive where the trigger holds; None if it never changes
    starts: bool  #: whether the trigger counts as true before the start
    persistent: bool
    assigned: dict[Any, Any]  #: new values of stored symbols
    reads: set[Any] = field(default_factory=set)
    writes: set[Any] = field(default_factory=set)
    last: Any = None  #: the accessory with the time at which it was last executed


def substituted(roots: list[Any], values: dict[Any, Any]) -> list[Any]:
    """Expressions with other expressions in the place of symbols."""
    made: dict[int, Any] = {}
    for node in walk(roots):
        if node.op == "symbol":
            made[id(node)] = values.get(node, node)
        elif any(made[id(a)] is not a for a in node.args):
            arguments = tuple(made[id(a)] for a in node.args)
            if node.op in ("and", "or"):
                made[id(node)] = (both if node.op == "and" else either)(*arguments)
            elif node.op == "select":
                made[id(node)] = choose(*arguments)
            else:
                made[id(node)] = folded(ex.make(node.op, arguments, node.value, node.type))
        else:
            made[id(node)] = node
    return [made[id(root)] for root in roots]


def trigger_function(condition: Any, where: str) -> Any:
    """A function that is positive where a condition holds and negative where it does not."""
    if condition.op in ("less", "less_equal"):
        return number(ex.make("subtract", condition.args[::-1]))
    if condition.op in ("greater", "greater_equal"):
        return number(ex.make("subtract", condition.args))
    if condition.op == "not":
        return ex.make("negate", (trigger_function(condition.args[0], where),))
    if condition.op in ("and", "or"):
        parts = tuple(trigger_function(a, where) for a in condition.args)
        return ex.make("min" if condition.op == "and" else "max", parts)
    if condition.op == "truth":
        return constant(math.inf if condition.value else -math.inf)
    raise Refused(f"{where}: its trigger is no combination of <, <=, > and >=")


class Events:
    """The events of a model, for `my.model`: `events`, and what `initialise` does at the start."""

    def __init__(self, semantics: Semantics, a_state: Any) -> None:
        self.semantics, self._state = semantics, a_state
        self.events: list[Event] = []
        self.initialise: dict[Any, Any] = {}
        model = semantics.model
        self.all = [made for i in range(model.getNumEvents()) if (made := self._occurrence(model.getEvent(i), i))]
        self._merge()
        for one in self.all:
            if self._rivals(one):
                name = semantics.component_name(f"{one.id}_time")
                one.last = sym.accessory(name)
                semantics.names[f"{one.id} time"] = name
        for one in self.all:
            if one.function is not None:
                self.events.append(self._event(one))
        if self.all:
            self._start()

    # -- What the file has ---------------------------------------------------------------------------------------------

    def _occurrence(self, element: Any, index: int) -> Occurrence | None:
        where = named(element, "event")
        if not element.isSetTrigger() or not element.getTrigger().isSetMath():
            return None  # which never happens
        translate = self.semantics.translate
        if element.isSetDelay() and element.getDelay().isSetMath():
            delay = translate(element.getDelay().getMath(), f"the delay of {where}")
            if not (is_constant(delay) and value_of(number(delay)) == 0):
                raise Refused(f"{where} has a delay")
        trigger = element.getTrigger()
        condition = truth(translate(trigger.getMath(), f"the trigger of {where}"))
        level3 = self.semantics.level > 2
        starts = trigger.getInitialValue() if level3 and trigger.isSetInitialValue() else True
        persistent = trigger.getPersistent() if level3 and trigger.isSetPersistent() else True
        function = None if condition.op == "truth" else trigger_function(condition, where)
        assigned = self._assigned(element, where)
        name = self.semantics.component_name(element.getIdAttribute() or f"event_{index + 1}")
        made = Occurrence(name, where, condition, function, starts, persistent, assigned)
        self.semantics.names[f"event {index}"] = name
        made.reads, made.writes = set(symbols_of(list(assigned.values()))), set(assigned)
        return made

    def _assigned(self, element: Any, where: str) -> dict[Any, Any]:
        """The new values of what is stored."""
        given: dict[str, Any] = {}
        for i in range(element.getNumEventAssignments()):
            assignment = element.getEventAssignment(i)
            if assignment.isSetMath():
                given[assignment.getVariable()] = number(self.semantics.translate(assignment.getMath(),
                                                                                  f"{named(assignment)} of {where}"))
        assigned: dict[Any, Any] = {}
        quantities = self.semantics.quantities
        for name, value in given.items():
            quantity = quantities[name]
            if quantity.changes == "assignment":
                raise Refused(f"{where} sets '{name}', which has an assignment rule")
            if quantity.compartment:  # the amount follows from the volume before the event
                volume = self.semantics.meaning(quantity.compartment, where)
                if quantity.in_amount:
                    value = multiply(value, volume)
                elif quantity.compartment in given:
                    value = divide(multiply(value, volume), given[quantity.compartment])
            assigned[quantity.symbol] = value
        for quantity in quantities.values():
            if quantity.compartment in given and quantity.id not in given:
                self._keep_amount(quantity, given, assigned, where)
        return assigned

    def _keep_amount(self, quantity: Quantity, given: dict[str, Any], assigned: dict[Any, Any], where: str) -> None:
        """A concentration that is stored changes with the volume."""
        if not quantity.in_amount and quantity.changes != "assignment":
            volume = self.semantics.meaning(quantity.compartment, where)
            assigned[quantity.symbol] = divide(multiply(quantity.symbol, volume), given[quantity.compartment])

    def _merge(self) -> None:
        """Events with the same trigger become one, if they set different things: their values are from before."""
        merged: list[Occurrence] = []
        for one in self.all:
            same = next((m for m in merged if one.function is not None and m.function is one.function and
                         m.trigger is one.trigger and m.starts == one.starts), None)
            if same is None:
                merged.append(one)
                continue
            if not (same.persistent and one.persistent) and (same.writes | one.writes) & self._inputs(one):
                raise Refused(f"{one.where} and {same.where} have the same trigger, and one may cancel the other")
            if same.writes & one.writes:
                raise Refused(f"{one.where} and {same.where} have the same trigger and set the same thing, so that "
                              "their order matters")
            if self._uses_execution_time(one) or self._uses_execution_time(same):
                raise Refused(f"{one.where} and {same.where} have the same trigger and read what the other sets, so "
                              "that their order matters")
            same.assigned |= one.assigned
            same.reads |= one.reads
            same.writes |= one.writes
            same.persistent = same.persistent and one.persistent
        self.all = merged

    def _uses_execution_time(self, one: Occurrence) -> bool:
        model = self.semantics.model
        for i in range(model.getNumEvents()):
            element = model.getEvent(i)
            if named(element, "event") == one.where:
                return element.isSetUseValuesFromTriggerTime() and not element.getUseValuesFromTriggerTime()
        return True

    # -- Events at one instant -----------------------------------------------------------------------------------------

    def _inputs(self, one: Occurrence) -> set[Any]:
        return {s for s in symbols_of([one.trigger])}

    def _interfere(self, a: Occurrence, b: Occurrence) -> bool:
        """Whether it matters which of two events at one instant is executed first."""
        return bool(a.writes & (b.reads | b.writes | self._inputs(b)) or b.writes & (a.reads | self._inputs(a)))

    def _rivals(self, one: Occurrence) -> list[Occurrence]:
        found = [o for o in self.all if o is not one and self._interfere(one, o)]
        return found + [one] if found else []

    def _event(self, one: Occurrence) -> Event:
        now = {s: s for o in self.all for s in o.writes}
        after, happened, is_open = self._instant([(one, ex.constant(True))], now)
        do = {s: v for s, v in after.items() if v is not s}
        for other, happens in happened:
            for rival in self._rivals(other):
                since = ex.abs(sym.time - rival.last)
                at_once = compare("less_equal", since, _near * (1.0 + ex.abs(sym.time)))
                is_open = either(is_open, both(happens, at_once))
            if other.last is not None:
                do[other.last] = choose(happens, sym.time, do.get(other.last, other.last))
        if not _never(is_open):
            do[sym.end_instance] = is_open
        return event(one.function, name=one.id, direction="rising", do=do)

    def _instant(self, first: list[tuple[Occurrence, Any]], now: dict[Any, Any]) -> tuple[
            dict[Any, Any], list[tuple[Occurrence, Any]], Any]:
        """What happens at one instant, from the events that happen first, each with a condition: the values of all
        that is stored, the events that happened, and the condition that SBML leaves open what happens."""
        before, happened, is_open = now, list(first), ex.constant(False)
        stage = first
        for number_of_stage in range(_stages + 1):
            for i, (a, happens) in enumerate(stage):
                for b, also in stage[i + 1:]:
                    if self._interfere(a, b):
                        is_open = either(is_open, both(happens, also))
            after = dict(before)
            for one, happens in stage:
                values = substituted(list(one.assigned.values()), before)
                for symbol, value in zip(one.assigned, values):
                    after[symbol] = choose(happens, value, after[symbol])
            changed = {s for one, _ in stage for s in one.writes}
            following = []
            for one in self.all:
                if not self._inputs(one) & changed:
                    continue
                was, = substituted([one.trigger], before)
                if number_of_stage == 0:  # those that happen first count as true, however closely they were located
                    was = functools.reduce(either, (c for o, c in stage if o is one), was)
                holds, = substituted([one.trigger], after)
                following.append((one, both(opposite(was), holds)))
                is_open = either(is_open, self._about_to_hold(one, holds, after))
            following = [(o, c) for o, c in following if not _never(c)]
            if not following:
                return after, happened, is_open
            if number_of_stage == _stages:
                break
            happened += following
            before, stage = after, following
        return after, happened, functools.reduce(either, (c for _, c in following), is_open)

    @staticmethod
    def _about_to_hold(one: Occurrence, holds: Any, values: dict[Any, Any]) -> Any:
        """Whether a trigger does not hold, but may right afterwards, as x > 0 where x is zero: no crossing shows it."""
        if one.function is None or not _is_strict(one.trigger, True):
            return ex.constant(False)
        function, = substituted([one.function], values)
        return both(opposite(holds), compare("equal", function, constant(0.0)))

    def _start(self) -> None:
        """What happens at the start: triggers that do not count as true before it."""
        now = {s: s for o in self.all for s in o.writes}
        first = [(o, o.trigger) for o in self.all if not o.starts and not _never(o.trigger)]
        after, _, is_open = self._instant(first, now)
        for one in self.all:
            holds, = substituted([one.trigger], after)
            is_open = either(is_open, self._about_to_hold(one, holds, after))
        begins = ex.make("equal", (sym.phase, ex.constant(0)), type=ex.condition)
        self.initialise = {s: choose(begins, v, s) for s, v in after.items() if v is not s}
        for one in self.all:
            if one.last is not None:
                self.initialise[one.last] = choose(begins, constant(-1e300), one.last)
        if not _never(is_open):
            started = self.initialise.get(self._state, self._state)
            self.initialise[self._state] = choose(both(begins, is_open), constant(math.nan), started)


def _never(condition: Any) -> bool:
    """Whether a condition is known not to hold."""
    return is_constant(condition) and not value_of(condition)


def _is_strict(condition: Any, as_it_is: bool) -> bool:
    """Whether a condition may not hold where its trigger function is zero."""
    if condition.op in ("less", "greater"):
        return as_it_is
    if condition.op in ("less_equal", "greater_equal"):
        return not as_it_is
    if condition.op == "not":
        return _is_strict(condition.args[0], not as_it_is)
    return any(_is_strict(a, as_it_is) for a in condition.args)
