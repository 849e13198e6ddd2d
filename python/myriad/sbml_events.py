# SPDX-License-Identifier: MIT
"""Events of SBML as events of a model.

A trigger is a condition, and an event of a model a real function that rises through zero: the difference of the two
sides of a comparison. A trigger becomes true where one of its comparisons does; each is found by itself, so that none
is missed because another ceases to hold in the same step. What is delayed waits in slots, accessories with the time
when it is due, and one event finds the next of these times. What happens at one instant, in which order, and what that
makes happen at once, is worked out in the action, in rounds. SBML leaves open in which order events of equal priority,
or without one, are executed: where the order matters, the instance ends.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any

from . import expression as ex, symbols as sym
from .expression import symbols_of, walk
from .model import Event, event
from .sbml_document import named
from .sbml_math import (Refused, add, both, choose, compare, constant, divide, either, folded, is_constant, multiply,
                        number, opposite, subtract, truth, value_of)
from .sbml_semantics import Quantity, Semantics

_slots = 2  #: of each delayed event
_together = 12  #: at one instant, in an order that matters
_consequences = 4  #: of them, at the same instant
_near = 1e-10  #: relative difference of times that count as one instant
_never_due = 1e300  #: the time of a slot that is free
_true, _false = ex.constant(True), ex.constant(False)


@dataclass
class Slot:
    """A place for an execution that is delayed."""

    due: Any  #: the accessory with its time
    values: dict[str, Any]  #: accessories with the values from the time of the trigger, by id


@dataclass(eq=False)
class Occurrence:
    """An event of the file."""

    id: str
    where: str
    trigger: Any  #: a condition
    starts: bool  #: whether the trigger counts as true before the start
    persistent: bool
    given: dict[str, Any]  #: what its assignments give, by id
    from_trigger: bool  #: whether the values are those at the time of the trigger
    delay: Any = None
    priority: Any = None
    inputs: set[Any] = field(default_factory=set)  #: of its trigger
    reads: set[Any] = field(default_factory=set)
    late: set[Any] = field(default_factory=set)  #: those of them that are read at the execution in any case
    writes: set[Any] = field(default_factory=set)
    last: Any = None  #: the accessory with the time at which it was last executed
    slots: list[Slot] = field(default_factory=list)


@dataclass
class Pending:
    """An execution at an instant that is to come, where the condition holds; `values` are known at its trigger."""

    what: Occurrence
    condition: Any
    values: dict[str, Any] | None


def substituted(roots: Iterable[Any], values: dict[Any, Any]) -> list[Any]:
    """Expressions with other expressions in the place of symbols."""
    roots = list(roots)
    made: dict[int, Any] = {}
    for node in walk(roots):
        if node.op == "symbol":
            made[id(node)] = values.get(node, node)
        elif any(made[id(a)] is not a for a in node.args):
            arguments = tuple(made[id(a)] for a in node.args)
            if node.op in ("and", "or"):
                made[id(node)] = (both if node.op == "and" else either)(*arguments)
            elif node.op == "not":
                made[id(node)] = opposite(*arguments)
            elif node.op == "select":
                made[id(node)] = choose(*arguments)
            else:
                made[id(node)] = folded(ex.make(node.op, arguments, node.value, node.type))
        else:
            made[id(node)] = node
    return [made[id(root)] for root in roots]


_reverse = {"less": "greater_equal", "less_equal": "greater", "greater": "less_equal", "greater_equal": "less"}


def comparisons_alone(condition: Any, where: str, as_it_is: bool = True) -> Any:
    """A condition of comparisons, `and` and `or`, without `not`."""
    if condition.op == "not":
        return comparisons_alone(condition.args[0], where, not as_it_is)
    if condition.op in ("and", "or"):
        parts = [comparisons_alone(a, where, as_it_is) for a in condition.args]
        return both(*parts) if (condition.op == "and") is as_it_is else either(*parts)
    if condition.op in _reverse:
        return condition if as_it_is else compare(_reverse[condition.op], *condition.args)
    raise Refused(f"{where}: its trigger is no combination of <, <=, > and >=")


def comparisons_of(condition: Any) -> list[Any]:
    """The comparisons in a condition, each once."""
    return [n for n in walk([condition]) if n.op in _reverse] if condition.op != "truth" else []


def with_values(condition: Any, values: dict[Any, Any]) -> Any:
    """A condition with others in the place of some of its comparisons."""
    if condition.op in ("and", "or"):
        return (both if condition.op == "and" else either)(*(with_values(a, values) for a in condition.args))
    return values.get(condition, condition)


def function_of(condition: Any) -> Any:
    """A function that is positive where a condition holds and negative where it does not."""
    if condition.op in ("and", "or"):
        return ex.make("min" if condition.op == "and" else "max", tuple(function_of(a) for a in condition.args))
    a, b = condition.args if condition.op.startswith("greater") else condition.args[::-1]
    return subtract(a, b)


def _never(condition: Any) -> bool:
    """Whether a condition is known not to hold."""
    return is_constant(condition) and not value_of(condition)


def _any(conditions: Iterable[Any]) -> Any:
    return functools.reduce(either, conditions, _false)


def _all(conditions: Iterable[Any]) -> Any:
    return functools.reduce(both, conditions, _true)


def _at_once(earlier: Any) -> Any:
    """Whether a time is this instant."""
    return compare("less_equal", ex.abs(sym.time - earlier), _margin())


def _margin() -> Any:
    return _near * (1.0 + ex.abs(sym.time))


def _mark(name: str) -> Any:
    """What stands for the value that an event gives."""
    return ex.make("symbol", value=("value", name))


def interfere(a: Occurrence, b: Occurrence, at_once: bool = False) -> bool:
    """Whether it matters which of two events at one instant is executed first, apart from what they make happen;
    `at_once` if the values that they give are known."""
    reads_of_a, reads_of_b = (one.late if at_once and one.from_trigger else one.reads for one in (a, b))
    return bool(a.writes & (reads_of_b | b.writes | b.inputs) or b.writes & (reads_of_a | a.inputs))


class Events:
    """The events of a model, for `my.model`: `events`, and what `initialise` does at the start. `a_state` is some state
    of the model."""

    def __init__(self, semantics: Semantics, a_state: Any) -> None:
        self.semantics, self._state = semantics, a_state
        self.events: list[Event] = []
        self.initialise: dict[Any, Any] = {}
        self.reach: dict[Occurrence, set[Occurrence]] = {}
        model = semantics.model
        self.all = [made for i in range(model.getNumEvents()) if (made := self._occurrence(model.getEvent(i), i))]
        if not self.all:
            return
        written = {s for one in self.all for s in one.writes}
        for one in self.all:
            if any(o is not one and interfere(one, o) for o in self.all):
                one.last = self._accessory(f"{one.id}_time")
            if one.delay is not None:
                one.slots = [self._slot(one, i, written) for i in range(_slots)]
        self._now = {s: s for s in written} | {a: a for one in self.all for a in self._accessories_of(one)}
        groups: dict[Any, list[tuple[Occurrence, Any]]] = {}
        for one in self.all:
            for comparison in comparisons_of(one.trigger):
                function = function_of(comparison)
                if not is_constant(function):
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
        name = self.semantics.component_name(wanted)
        self.semantics.names[f"accessory {wanted}"] = name
        return sym.accessory(name)

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
        name = self.semantics.component_name(element.getIdAttribute() or f"event_{index + 1}")
        self.semantics.names[f"event {index}"] = name
        if condition.op != "truth":
            condition = comparisons_alone(condition, where)
        made = Occurrence(name, where, condition, starts, persistent, given, from_trigger, delay, priority)
        stored = self._stores(made, given)
        made.inputs = set(symbols_of([condition]))
        made.reads = set(symbols_of([*given.values(), *stored.values(), *(e for e in (delay, priority) if e is not None)
                                     ])) - {sym.time}
        marks = {n: _mark(n) for n in given}
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
        instant = _Instant(self, self._now)
        instant.located = [comparison for _, comparison in group]
        after, before = ({c: value for c in instant.located} for value in (_true, _false))
        happening = []
        for one in dict.fromkeys(o for o, _ in group):
            holds = with_values(one.trigger, after)
            happening.append((one, both(holds, opposite(with_values(one.trigger, before)))))
            for other in comparisons_of(one.trigger):
                if other not in after:  # which may begin or cease to hold at the same instant
                    a, b = other.args
                    is_near = compare("less_equal", ex.abs(subtract(a, b)), _near * add(ex.abs(a), ex.abs(b)))
                    matters = both(with_values(one.trigger, {**after, other: _true}),
                                   opposite(with_values(one.trigger, {**after, other: _false})))
                    instant.is_open = either(instant.is_open, both(is_near, matters))
        instant.truth = {one: with_values(one.trigger, after) for one in self.all}
        instant.happen([(one, condition) for one, condition in happening if not _never(condition)])
        names = [e.name for e in self.events]
        name = group[0][0].id
        if name in names:
            name = self.semantics.component_name(f"{name}_{len(names) + 1}")
            self.semantics.names[f"event {name}"] = name
        do = instant.assignments([one for one, _ in happening])
        self.events.append(event(function, name=name, direction="rising", do=do))

    def _due(self) -> None:
        """The event that finds when something delayed is due."""
        slots = [(one, slot) for one in self.all for slot in one.slots]
        next_time = functools.reduce(lambda a, b: ex.make("min", (a, b)), (slot.due for _, slot in slots))
        instant = _Instant(self, self._now)
        instant.truth = {one: one.trigger for one in self.all}
        for one, slot in slots:
            is_due = compare("less_equal", slot.due, sym.time + _margin())
            values = {n: slot.values.get(n, v) for n, v in one.given.items()} if one.from_trigger else None
            instant.pending.append(Pending(one, is_due, values))
            instant.values[slot.due] = choose(is_due, constant(_never_due), slot.due)
        name = self.semantics.component_name("due")
        self.semantics.names["event due"] = name
        instant.run()
        self.events.append(event(sym.time - next_time, name=name, direction="rising",
                                 do=instant.assignments([one for one, _ in slots])))

    def _cancel(self, one: Occurrence, comparison: Any) -> None:
        """The event that finds where a trigger ceases to hold whose executions must not outlast it."""
        function = function_of(comparison)
        if is_constant(function):
            return
        name = self.semantics.component_name(f"{one.id}_ceases")
        self.semantics.names[f"event {name}"] = name
        ceases = opposite(with_values(one.trigger, {comparison: _false}))
        do = {slot.due: choose(ceases, constant(_never_due), slot.due) for slot in one.slots}
        do[sym.end_instance] = both(ceases, _any(_at_once(slot.due) for slot in one.slots))
        self.events.append(event(ex.make("negate", (function,)), name=name, direction="rising", do=do))

    def _start(self) -> None:
        """What happens at the start: triggers that do not count as true before it."""
        start = dict(self._now)
        for one in self.all:
            for slot in one.slots:
                start[slot.due] = constant(_never_due)
                start |= {a: constant(0.0) for a in slot.values.values()}
        instant = _Instant(self, start)
        instant.truth = {one: one.trigger for one in self.all}
        for one in self.all:
            instant.notice(one, one.trigger)
        instant.happen([(one, one.trigger) for one in self.all if not one.starts and not _never(one.trigger)])
        begins = ex.make("equal", (sym.phase, ex.constant(0)), type=ex.condition)
        self.initialise = {s: choose(begins, v, s) for s, v in instant.values.items() if v is not s}
        for one in self.all:
            if one.last is not None:
                self.initialise[one.last] = choose(begins, constant(-_never_due), one.last)
        if not _never(instant.is_open):
            started = self.initialise.get(self._state, self._state)
            self.initialise[self._state] = choose(both(begins, instant.is_open), constant(math.nan), started)


class _Instant:
    """What happens at one instant. `values` are those of all that is stored, `truth` says which triggers hold, and
    `is_open` where SBML leaves open what happens."""

    def __init__(self, events: Events, values: dict[Any, Any]) -> None:
        self.events, self.values = events, dict(values)
        self.truth: dict[Occurrence, Any] = {}
        self.located: list[Any] = []  # comparisons that begin to hold, though rounding may leave them short of it
        self.pending: list[Pending] = []
        self.executed: list[tuple[Occurrence, Any]] = []
        self.is_open: Any = _false

    def _at(self, expression: Any) -> Any:
        """An expression with what is stored now."""
        return substituted([expression], self.values)[0]

    def _holds(self, one: Occurrence) -> Any:
        """Whether a trigger holds now."""
        begun = {}
        for comparison in self.located:
            inputs = set(symbols_of([comparison]))
            touched = _any(happens for other, happens in self.executed if other.writes & inputs)
            begun[comparison] = either(opposite(touched), self._at(comparison))
        return with_values(one.trigger, {c: begun.get(c, self._at(c)) for c in comparisons_of(one.trigger)})

    def _open(self, condition: Any) -> None:
        self.is_open = either(self.is_open, condition)

    def notice(self, one: Occurrence, holds: Any) -> None:
        """Looks for a trigger that does not hold, but may right afterwards, as x > 0 where x is zero: no crossing shows
        it."""
        if any(c.op in ("less", "greater") for c in comparisons_of(one.trigger)):
            on_surface = compare("equal", self._at(function_of(one.trigger)), constant(0.0))
            self._open(both(opposite(holds), on_surface))

    def happen(self, first: list[tuple[Occurrence, Any]]) -> None:
        """Triggers some events, and does what follows."""
        self._triggered(first)
        self.run()

    def _triggered(self, which: list[tuple[Occurrence, Any]]) -> None:
        before = dict(self.values)
        for one, condition in which:
            values = dict(zip(one.given, substituted(one.given.values(), before))) if one.from_trigger else None
            if one.delay is None:
                self.pending.append(Pending(one, condition, values))
                continue
            delay, = substituted([one.delay], before)
            self._open(both(condition, opposite(compare("greater_equal", delay, constant(0.0)))))
            self._open(both(condition, both(compare("greater", delay, constant(0.0)),
                                            compare("less_equal", delay, 10.0 * _margin()))))
            if not (is_constant(delay) and value_of(delay) > 0):
                at_once = both(condition, compare("equal", delay, constant(0.0)))
                self.pending.append(Pending(one, at_once, values))
            self._wait(one, both(condition, compare("greater", delay, constant(0.0))), add(sym.time, delay), values)

    def _wait(self, one: Occurrence, condition: Any, due: Any, values: dict[str, Any] | None) -> None:
        """Puts an execution into the first free slot."""
        waiting = condition
        for slot in one.slots:
            takes = both(waiting, compare("greater", self.values[slot.due], constant(0.5 * _never_due)))
            waiting = both(waiting, opposite(takes))
            self.values[slot.due] = choose(takes, due, self.values[slot.due])
            for name, accessory in slot.values.items():
                self.values[accessory] = choose(takes, (values or {})[name], self.values[accessory])
        self._open(waiting)
        for rival in self.events.all:  # whose action has changed what the values are from
            if rival.last is not None and one.from_trigger and rival.writes & one.reads:
                self._open(both(condition, _at_once(rival.last)))

    def _reach(self, one: Occurrence) -> set[Occurrence]:
        """An event with all that it may make happen at once."""
        known = self.events.reach.get(one)
        if known is not None:
            return known
        found, new = {one}, [one]
        while new:
            changed = new.pop().writes
            for other in self.events.all:
                if other not in found and other.inputs & changed:
                    found.add(other)
                    new.append(other)
        self.events.reach[one] = found
        return found

    def _order_matters(self, a: Occurrence, b: Occurrence) -> bool:
        one, other = self._reach(a), self._reach(b)
        return bool(one & other) or any(interfere(x, y, x is a and y is b) for x in one for y in other)

    def run(self) -> None:
        """Executes what is pending, in the order of priorities, and what that makes happen."""
        alone = [p for p in self.pending if len(self._reach(p.what)) == 1 and not any(
            o is not p and (o.what is p.what or self._order_matters(o.what, p.what)) for o in self.pending)]
        self.pending = [p for p in self.pending if p not in alone]
        self._execute([(p, p.condition) for p in alone])
        if len(self.pending) > _together:
            raise Refused(f"{self.pending[0].what.where} and {len(self.pending) - 1} others may be executed at one "
                          f"instant in an order that matters: up to {_together} can be")
        most = len(self.pending) + _consequences
        for _ in range(most):  # each of them executes one, if there is one
            if not self.pending:
                return
            chosen = self._chosen()
            for p, selected in chosen:
                p.condition = _false if selected is p.condition else both(p.condition, opposite(selected))
            self._execute(chosen)
            self.pending = [p for p in self.pending if not _never(p.condition)]
            if len(self.pending) > most:
                self._open(_any(p.condition for p in self.pending[most:]))
                del self.pending[most:]
        self._open(_any(p.condition for p in self.pending))

    def _chosen(self) -> list[tuple[Pending, Any]]:
        """Which execution comes next: each with the condition that it does."""
        priorities = [None if p.what.priority is None else self._at(p.what.priority) for p in self.pending]
        chosen = []
        for i, p in enumerate(self.pending):
            comes_first = []
            for j, other in enumerate(self.pending):
                if i == j:
                    continue
                a, b = priorities[i], priorities[j]
                if a is None or b is None:
                    before, is_tie = (a is not None or b is None and i < j), _true
                    first = ex.constant(before)
                else:
                    is_tie = compare("equal", a, b)
                    first = compare("greater" if j < i else "greater_equal", a, b)
                comes_first.append(either(opposite(other.condition), first))
                if i < j and (p.what is not other.what or p.values is not None) and self._order_matters(
                        p.what, other.what):
                    self._open(_all([p.condition, other.condition, is_tie]))
            chosen.append((p, _all([p.condition, *comes_first])))
        return chosen

    def _execute(self, which: list[tuple[Pending, Any]]) -> None:
        """Executes what is selected, and looks at the triggers afterwards."""
        before = dict(self.values)
        changed: set[Any] = set()
        for p, selected in which:
            if _never(selected):
                continue
            one = p.what
            values = p.values
            if values is None:
                values = dict(zip(one.given, substituted(one.given.values(), before)))
            marks = {n: _mark(n) for n in values}
            known = {marks[n]: v for n, v in values.items()}
            stored = self.events._stores(one, marks)
            for symbol, value in zip(stored, substituted(stored.values(), {**before, **known})):
                self.values[symbol] = choose(selected, value, self.values[symbol])
            self.executed.append((one, selected))
            changed |= one.writes
        newly = []
        for one in self.events.all:
            if not one.inputs & changed:
                continue
            holds = self._holds(one)
            newly.append((one, both(opposite(self.truth[one]), holds)))
            self.truth[one] = holds
            self.notice(one, holds)
            if not one.persistent:
                for p in self.pending:
                    if p.what is one:
                        p.condition = both(p.condition, holds)
                for slot in one.slots:
                    self.values[slot.due] = choose(holds, self.values[slot.due], constant(_never_due))
        self._triggered([(one, condition) for one, condition in newly if not _never(condition)])

    def assignments(self, group: list[Occurrence]) -> dict[Any, Any]:
        """What the action of an event of the model assigns."""
        do = {s: v for s, v in self.values.items() if v is not s}
        for one, happens in self.executed:
            for rival in self.events.all:
                if rival.last is not None and (rival is one or interfere(rival, one)):
                    self._open(both(happens, _at_once(rival.last)))
            if one.last is not None:
                do[one.last] = choose(happens, sym.time, do.get(one.last, one.last))
        if is_constant(self.is_open) and value_of(self.is_open):
            which = " and ".join(dict.fromkeys(one.where for one in group))
            raise Refused(f"{which} happen at one instant, and SBML leaves open what happens: their order matters")
        if not _never(self.is_open):
            do[sym.end_instance] = self.is_open
        return do
