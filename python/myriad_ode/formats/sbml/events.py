# SPDX-License-Identifier: MIT
"""Events of SBML as triggers of a model.

A trigger of SBML's is one of the library's, and so are its delay, its priority and what it does when its condition
ceases to hold. What an event gives is stored as the model has it, an amount for a concentration: with the volume at the
execution, but with values from the time of the trigger. Only those are kept that may change until the execution.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from ...models.trigger import Trigger, waiting_value
from ...symbolic import expression as ex
from ...symbolic.node import symbols_of
from ...symbolic.folding import divide, is_constant, multiply, number, truth, value_of
from .document import named
from .math import Refused
from .semantics import Quantity, Semantics

_tie_seed = 1  #: of the order of events of equal priority, where that matters


@dataclass(eq=False)
class Occurrence:
    """An event of the file."""

    where: str
    trigger: Trigger  #: as the model has it, but for its assignments
    given: dict[str, Any]  #: what its assignments give, by id
    from_trigger: bool  #: whether the values are those at the time of the trigger
    writes: set[Any] = field(default_factory=set)  #: what is stored
    reads: set[Any] = field(default_factory=set)  #: what `given`, delay, priority and storing read


class Events:
    """The triggers of a model, for `my.model`."""

    def __init__(self, semantics: Semantics) -> None:
        self.semantics = semantics
        model = semantics.model
        self.all = [made for i in range(model.getNumEvents()) if (made := self._occurrence(model.getEvent(i), i))]
        for one in self.all:
            self._act(one)
        self.triggers = [one.trigger for one in self.all]
        ties = any(self._interfere(a, b) for i, a in enumerate(self.all) for b in self.all[:i])
        self.tie_seed = _tie_seed if ties else None

    def _occurrence(self, element: Any, index: int) -> Occurrence | None:
        """What the file has of an event; None if it never happens."""
        where = named(element, "event")
        trigger = element.getTrigger()
        if not element.isSetTrigger() or not trigger.isSetMath():
            return None
        translate, level3 = self.semantics.translate, self.semantics.level > 2
        delay = priority = None
        if element.isSetDelay() and element.getDelay().isSetMath():
            delay = number(translate(element.getDelay().getMath(), f"the delay of {where}"))
            if is_constant(delay) and not value_of(delay) >= 0:
                raise Refused(f"{where} has a negative delay")
            delay = None if is_constant(delay) and value_of(delay) == 0 else delay
        if element.isSetPriority() and element.getPriority().isSetMath():
            priority = number(translate(element.getPriority().getMath(), f"the priority of {where}"))
        condition = truth(translate(trigger.getMath(), f"the trigger of {where}"))
        starts = trigger.getInitialValue() if level3 and trigger.isSetInitialValue() else True
        persistent = trigger.getPersistent() if level3 and trigger.isSetPersistent() else True
        if is_constant(condition):
            if starts or not value_of(condition):
                return None
            condition = ex.make("equal", (ex.constant(0.0), ex.constant(0.0)), type=ex.condition)
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
        made = Trigger(condition, {}, delay, priority, starts, persistent, False, 1, name)
        from_trigger = not element.isSetUseValuesFromTriggerTime() or element.getUseValuesFromTriggerTime()
        stored = self._stores(where, given)
        reads = {*symbols_of([*given.values(), *stored.values(), *(e for e in (delay, priority) if e is not None)])}
        return Occurrence(where, made, given, from_trigger, {*stored}, reads)

    def _interfere(self, a: Occurrence, b: Occurrence) -> bool:
        """Whether it may matter which of two events at one instant is executed first."""
        reads_of_a, reads_of_b = (one.reads | {*symbols_of([one.trigger.condition])} for one in (a, b))
        return bool(a.writes & (reads_of_b | b.writes) or b.writes & reads_of_a)

    def _act(self, one: Occurrence) -> None:
        """Gives a trigger its assignments."""
        trigger, kept = one.trigger, dict[Any, Any]()
        written = {s for other in self.all for s in other.writes}
        by_others = {s for other in self.all if other is not one for s in other.writes}
        if by_others & {*symbols_of([trigger.condition])}:  # it may be triggered twice before it is executed
            by_others |= one.writes
        elif trigger.delay is None:  # the condition cannot cease to hold before
            trigger.persistent = True
        changing = by_others if trigger.delay is None else written | {
            s for s in one.reads if s.value[0] in ("state", "built-in", "delayed")}
        for value in one.given.values():
            if one.from_trigger and changing & {*symbols_of([value])} and value not in kept:
                kept[value] = waiting_value(len(kept))
        trigger.values = list(kept)
        trigger.do = self._stores(one.where, {name: kept.get(value, value) for name, value in one.given.items()})
        delayed = sum(other.trigger.delay is not None for other in self.all)
        trigger.room = 1 if trigger.delay is None else max(4, min(16, 32 // delayed))

    def _stores(self, where: str, given: dict[str, Any]) -> dict[Any, Any]:
        """The new values of what is stored, from the values of ids."""
        stored: dict[Any, Any] = {}
        quantities = self.semantics.quantities
        for name, value in given.items():
            quantity = quantities[name]
            if quantity.compartment:  # the amount follows from the volume before the event
                volume = self.semantics.meaning(quantity.compartment, where)
                if quantity.in_amount:
                    value = multiply(value, volume)
                elif quantity.compartment in given:
                    value = divide(multiply(value, volume), given[quantity.compartment])
            stored[quantity.symbol] = value
        for quantity in quantities.values():
            if quantity.compartment in given and quantity.id not in given:
                self._keep_amount(quantity, given, stored, where)
        return stored

    def _keep_amount(self, quantity: Quantity, given: dict[str, Any], stored: dict[Any, Any], where: str) -> None:
        """A concentration that is stored changes with the volume."""
        if not quantity.in_amount and quantity.changes != "assignment":
            volume = self.semantics.meaning(quantity.compartment, where)
            stored[quantity.symbol] = divide(multiply(quantity.symbol, volume), given[quantity.compartment])
