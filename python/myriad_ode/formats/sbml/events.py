# SPDX-License-Identifier: MIT
"""Events of SBML as events of a model.

A trigger is a condition, and an event of a model a real function that rises through zero: the difference of the two
sides of a comparison. A trigger becomes true where one of its comparisons does; each is found by itself, so that none
is missed because another ceases to hold in the same step. What is delayed waits in slots, accessories with the time
when it is due, and one event finds the next of these times. What happens at one instant, in which order, and what that
makes happen at once, is worked out in the action (instant.py).
"""

from __future__ import annotations

import functools
import math
from typing import Any

from ...models.event import Event, event
from ...symbolic import expression as ex, symbols as sym
from ...symbolic.expression import symbols_of
from ...symbolic.folding import (add, both, choose, compare, constant, divide, either, is_constant, multiply, number,
                                 opposite, subtract, truth, value_of)
from .conditions import (any_of, comparisons_alone, comparisons_of, complements, false, function_of, functions_of,
                         is_for_an_instant, never, true, with_values)
from .document import named
from .instant import Instant, Occurrence, Pending, Slot, at_once, interfere, mark, never_due, next_random, rounding
from .math import Refused
from .semantics import Quantity, Semantics

_slots = 2, 4, 12  #: for each delayed event: at least, at most, and for all together where these leave the choice
_near = 1e-10  #: relative difference of the sides of a comparison that may change at the same instant


class Events:
    """The events of a model, for `my.model`: `events`, and what `initialise` does at the start. `a_state` is some state
    of the model."""

    def __init__(self, semantics: Semantics, a_state: Any) -> None:
        self.semantics, self._state = semantics, a_state
        self.events: list[Event] = []
        self.initialise: dict[Any, Any] = {}
        self.reach: dict[Occurrence, set[Occurrence]] = {}
        self._random: tuple[Any, Any] | None = None
        self._set_by_events = {q.symbol for q in semantics.quantities.values() if q.changes == "events"}
        model = semantics.model
        self.all = [made for i in range(model.getNumEvents()) if (made := self._occurrence(model.getEvent(i), i))]
        if not self.all:
            return
        written = {s for one in self.all for s in one.writes}
        least, most, together = _slots
        delayed = sum(one.delay is not None for one in self.all)
        slots = max(least, min(most, together // max(delayed, 1)))
        for one in self.all:
            if any(o is not one and interfere(one, o) for o in self.all):
                one.last = self._accessory(f"{one.id}_time")
            if one.delay is not None:
                one.slots = [self._slot(one, i, written) for i in range(slots)]
        self._now = {s: s for s in written} | {a: a for one in self.all for a in self._accessories_of(one)}
        groups: dict[Any, list[tuple[Occurrence, Any]]] = {}
        for one in self.all:
            for comparison in comparisons_of(one.trigger):
                for function in functions_of(comparison, self.is_still):
                    if not self.is_still(function):
                        groups.setdefault(function, []).append((one, comparison))
        for function, group in groups.items():
            self._trigger(function, group)
        if any(one.slots for one in self.all):
            self._due()
        for one in self.all:
            if one.slots and not one.persistent:
                for comparison in comparisons_of(one.trigger):
                    self._cancel(one, comparison)
        self._start()

    def _accessory(self, wanted: str) -> Any:
        return sym.accessory(self.semantics.new_name(wanted))

    def is_still(self, expression: Any) -> bool:
        """Whether an expression changes at events alone."""
        return all(s in self._set_by_events or s is not sym.time and s.value[0] == "parameter"
                   for s in symbols_of([expression]))

    def rate_of(self, expression: Any, where: str) -> Any:
        """The rate by time of an expression, or None where it has none."""
        try:
            return self.semantics.total_derivative(expression, where)
        except Refused:
            return None

    def random_numbers(self) -> tuple[Any, Any]:
        """The accessory with the latest random number of an instance, and its value at the start, which follows from
        the number of the instance."""
        if self._random is None:
            start = next_random(next_random(sym.instance % (2**31 - 1), True), True)
            self._random = sym.integer_accessory(self.semantics.new_name("random_number")), start
        return self._random

    def _slot(self, one: Occurrence, i: int, written: set[Any]) -> Slot:
        varying = [n for n, v in one.given.items() if one.from_trigger and any(
            s in written or s.value[0] == "state" or s is sym.time for s in symbols_of([v]))]
        return Slot(self._accessory(f"{one.id}_due_{i + 1}"),
                    {n: self._accessory(f"{one.id}_{n}_{i + 1}") for n in varying})

    @staticmethod
    def _accessories_of(one: Occurrence) -> list[Any]:
        return [a for slot in one.slots for a in (slot.due, *slot.values.values())]

    # -- What the file has ---------------------------------------------------------------------------------------------

    def _occurrence(self, element: Any, index: int) -> Occurrence | None:
        where = named(element, "event")
        if not element.isSetTrigger() or not element.getTrigger().isSetMath():
            return None  # which never happens
        translate = self.semantics.translate
        delay = priority = None
        if element.isSetDelay() and element.getDelay().isSetMath():
            delay = number(translate(element.getDelay().getMath(), f"the delay of {where}"))
            if is_constant(delay) and not value_of(delay) >= 0:
                raise Refused(f"{where} has a negative delay")
            delay = None if is_constant(delay) and value_of(delay) == 0 else delay
        if element.isSetPriority() and element.getPriority().isSetMath():
            priority = number(translate(element.getPriority().getMath(), f"the priority of {where}"))
        trigger = element.getTrigger()
        condition = truth(translate(trigger.getMath(), f"the trigger of {where}"))
        level3 = self.semantics.level > 2
        starts = trigger.getInitialValue() if level3 and trigger.isSetInitialValue() else True
        persistent = trigger.getPersistent() if level3 and trigger.isSetPersistent() else True
        from_trigger = not element.isSetUseValuesFromTriggerTime() or element.getUseValuesFromTriggerTime()
        given: dict[str, Any] = {}
        for i in range(element.getNumEventAssignments()):
            assignment = element.getEventAssignment(i)
            if not assignment.isSetMath():
                continue
            name = assignment.getVariable()
            if self.semantics.quantities[name].changes == "assignment":
                raise Refused(f"{where} sets '{name}', which has an assignment rule")
            given[name] = number(translate(assignment.getMath(), f"{named(assignment)} of {where}"))
        name = self.semantics.new_name(element.getIdAttribute() or f"event_{index + 1}")
        if condition.op != "truth":
            condition = comparisons_alone(condition, where, self.is_still)
        if delay is not None and not persistent and any(is_for_an_instant(c, self.is_still)
                                                        for c in comparisons_of(condition)):
            raise Refused(f"{where} waits, and its trigger by == ceases to hold at once: make it persistent")
        made = Occurrence(name, where, condition, starts, persistent, given, from_trigger, delay, priority)
        stored = self._stores(made, given)
        made.inputs = set(symbols_of([condition]))
        made.reads = set(symbols_of([*given.values(), *stored.values(), *(e for e in (delay, priority) if e is not None)
                                     ])) - {sym.time}
        marks = {n: mark(n) for n in given}
        late = [*self._stores(made, marks).values(), *([] if priority is None else [priority])]
        made.late = set(symbols_of(late)) - set(marks.values())
        made.writes = set(stored)
        return made

    def _stores(self, one: Occurrence, given: dict[str, Any]) -> dict[Any, Any]:
        """The new values of what is stored, from the values of ids."""
        stored: dict[Any, Any] = {}
        quantities = self.semantics.quantities
        for name, value in given.items():
            quantity = quantities[name]
            if quantity.compartment:  # the amount follows from the volume before the event
                volume = self.semantics.meaning(quantity.compartment, one.where)
                if quantity.in_amount:
                    value = multiply(value, volume)
                elif quantity.compartment in given:
                    value = divide(multiply(value, volume), given[quantity.compartment])
            stored[quantity.symbol] = value
        for quantity in quantities.values():
            if quantity.compartment in given and quantity.id not in given:
                self._keep_amount(quantity, given, stored, one.where)
        return stored

    def _keep_amount(self, quantity: Quantity, given: dict[str, Any], stored: dict[Any, Any], where: str) -> None:
        """A concentration that is stored changes with the volume."""
        if not quantity.in_amount and quantity.changes != "assignment":
            volume = self.semantics.meaning(quantity.compartment, where)
            stored[quantity.symbol] = divide(multiply(quantity.symbol, volume), given[quantity.compartment])

    # -- Events of the model -------------------------------------------------------------------------------------------

    def _trigger(self, function: Any, group: list[tuple[Occurrence, Any]]) -> None:
        """The event that finds where comparisons with that difference begin to hold."""
        instant = Instant(self, self._now)
        begin = [comparison for _, comparison in group]
        instant.located = after = {**{c: false for one in begin for c in complements(one)}, **{c: true for c in begin}}
        before = {c: opposite(value) for c, value in after.items()}
        happening = []
        for one in dict.fromkeys(o for o, _ in group):
            holds = with_values(one.trigger, after)
            happening.append((one, both(holds, opposite(with_values(one.trigger, before)))))
            for other in comparisons_of(one.trigger):
                # which may begin or cease to hold at the same instant
                if other not in after and not self.is_still(other):
                    a, b = other.args
                    is_near = compare("less_equal", ex.abs(subtract(a, b)), _near * add(ex.abs(a), ex.abs(b)))
                    matters = both(with_values(one.trigger, {**after, other: true}),
                                   opposite(with_values(one.trigger, {**after, other: false})))
                    instant.is_open = either(instant.is_open, both(is_near, matters))
        instant.truth = {one: with_values(one.trigger, after) for one in self.all}
        instant.happen(happening)
        names = [e.name for e in self.events]
        name = group[0][0].id
        if name in names:
            name = self.semantics.new_name(f"{name}_{len(names) + 1}")
        do = instant.assignments([one for one, _ in happening])
        self.events.append(event(function, name=name, direction="rising", do=do))

    def _due(self) -> None:
        """The event that finds when something delayed is due."""
        slots = [(one, slot) for one in self.all for slot in one.slots]
        next_time = functools.reduce(lambda a, b: ex.make("min", (a, b)), (slot.due for _, slot in slots))
        instant = Instant(self, self._now)
        instant.truth = {one: one.trigger for one in self.all}
        for one, slot in slots:
            is_due = compare("less_equal", slot.due, sym.time + rounding())
            values = {n: slot.values.get(n, v) for n, v in one.given.items()} if one.from_trigger else None
            instant.pending.append(Pending(one, is_due, values))
            instant.values[slot.due] = choose(is_due, constant(never_due), slot.due)
        instant.run()
        self.events.append(event(sym.time - next_time, name=self.semantics.new_name("due"), direction="rising",
                                 do=instant.assignments([one for one, _ in slots])))

    def _cancel(self, one: Occurrence, comparison: Any) -> None:
        """The event that finds where a trigger ceases to hold whose executions must not outlast it."""
        function = function_of(comparison, self.is_still)
        if self.is_still(function):
            return
        name = self.semantics.new_name(f"{one.id}_ceases")
        after = {comparison: false, **{c: true for c in complements(comparison)}}
        ceases = opposite(with_values(one.trigger, after))
        do = {slot.due: choose(ceases, constant(never_due), slot.due) for slot in one.slots}
        do[sym.end_instance] = both(ceases, any_of(at_once(slot.due) for slot in one.slots))
        self.events.append(event(ex.make("negate", (function,)), name=name, direction="rising", do=do))

    def _start(self) -> None:
        """What happens at the start: triggers that do not count as true before it."""
        start = dict(self._now)
        for one in self.all:
            for slot in one.slots:
                start[slot.due] = constant(never_due)
                start |= {a: constant(0.0) for a in slot.values.values()}
        instant = Instant(self, start, at_start=True)
        instant.truth = {one: one.trigger for one in self.all}
        instant.happen([(one, either(false if one.starts else one.trigger, instant.about_to_hold(one, one.trigger)))
                        for one in self.all])
        if self._random is not None:
            instant.values.setdefault(*self._random)
        begins = ex.make("equal", (sym.phase, ex.constant(0)), type=ex.condition)
        self.initialise = {s: choose(begins, v, s) for s, v in instant.values.items() if v is not s}
        for one in self.all:
            if one.last is not None:
                self.initialise[one.last] = choose(begins, constant(-never_due), one.last)
        if not never(instant.is_open):
            started = self.initialise.get(self._state, self._state)
            self.initialise[self._state] = choose(both(begins, instant.is_open), constant(math.nan), started)
