# SPDX-License-Identifier: MIT
"""What happens at one instant, worked out for the action of an event of a model, in rounds.

Executions are in the order of their priorities; those without a priority come last. Where priorities are equal and the
order matters, it is random, by numbers from a stream that each instance has in an accessory. What makes others happen
at once does so before the next execution. What SBML leaves open, or what is beyond the limits below, ends the instance.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, Protocol

from ...models.time_jumps import unit_roundoff
from ...symbolic import expression as ex, symbols as sym
from ...symbolic.expression import symbols_of
from ...symbolic.folding import add, both, choose, compare, constant, either, is_constant, opposite, value_of
from .conditions import all_of, any_of, comparisons_of, false, function_of, never, substituted, true, with_values
from .math import Refused

_together = 16, 64  #: whose order matters: where it is not known beforehand, and in any case
_consequences = 4  #: of them, at the same instant, likewise
_rounds = 1000  #: in any case
never_due = 1e300  #: the time of a slot that is free


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


@dataclass(eq=False)
class Pending:
    """An execution at an instant that is to come, where the condition holds; `values` are known at its trigger."""

    what: Occurrence
    condition: Any
    values: dict[str, Any] | None
    key: Any = None  #: a random number, once it has one

    def is_as(self, other: Pending) -> bool:
        """Whether it does not matter which of two executions of one event comes first."""
        mine, others = self.values, other.values
        return mine is others or mine is not None and others is not None and all(
            value is others[name] for name, value in mine.items())


def margin() -> Any:
    """The difference of times that count as one instant: rounding errors of the time and of where it began, whatever
    the model's unit of time is."""
    return 1e-10 * ex.abs(sym.time) + 1e-13 * ex.abs(sym.t_begin)


def rounding() -> Any:
    """The difference of times that differ by their rounding alone."""
    return 32.0 * unit_roundoff() * (ex.abs(sym.time) + ex.abs(sym.t_begin))


def at_once(earlier: Any) -> Any:
    """Whether a time is this instant."""
    return compare("less_equal", ex.abs(sym.time - earlier), margin())


def mark(name: str) -> Any:
    """What stands for the value that an event gives."""
    return ex.make("symbol", value=("value", name))


def interfere(a: Occurrence, b: Occurrence, at_once: bool = False) -> bool:
    """Whether it matters which of two events at one instant is executed first, apart from what they make happen;
    `at_once` if the values that they give are known."""
    reads_of_a, reads_of_b = (one.late if at_once and one.from_trigger else one.reads for one in (a, b))
    return bool(a.writes & (reads_of_b | b.writes | b.inputs) or b.writes & (reads_of_a | a.inputs))


def next_random(number: Any, at_start: bool = False) -> Any:
    """The number after one in a sequence of whole numbers of 32 bits that looks random. At the start they follow from
    the instance's number, which has more, and are kept small, so that interpreted models have them exactly."""
    following = number * 1664525 + 1013904223
    return following % (2**31 - 1) if at_start else following


def _may_tie(a: Any, b: Any) -> bool:
    """Whether two priorities may be equal."""
    if a is None or b is None:
        return a is b
    return not (is_constant(a) and is_constant(b)) or value_of(a) == value_of(b)


class OccurringEvents(Protocol):
    """What an instant needs of the events of a model."""

    all: list[Occurrence]
    reach: dict[Occurrence, set[Occurrence]]

    def is_still(self, expression: Any) -> bool: ...
    def rate_of(self, expression: Any, where: str) -> Any: ...
    def random_numbers(self) -> tuple[Any, Any]: ...
    def _stores(self, one: Occurrence, given: dict[str, Any]) -> dict[Any, Any]: ...


class Instant:
    """What happens at one instant. `values` are those of all that is stored, `truth` says which triggers hold, and
    `is_open` where SBML leaves open what happens."""

    def __init__(self, events: OccurringEvents, values: dict[Any, Any], at_start: bool = False) -> None:
        self.events, self.values = events, dict(values)
        self.truth: dict[Occurrence, Any] = {}
        # comparisons that begin to hold (true) or to fail (false) here, though rounding may leave them short of it
        self.located: dict[Any, Any] = {}
        self.pending: list[Pending] = []
        self.executed: list[tuple[Occurrence, Any]] = []
        self.is_open: Any = false
        self.given: Any = true  #: in which case what is worked out happens
        self.at_start = at_start

    def _at(self, expression: Any) -> Any:
        """An expression with what is stored now."""
        return substituted([expression], self.values)[0]

    def _holds(self, one: Occurrence) -> Any:
        """Whether a trigger holds now."""
        begun = {}
        for comparison, value in self.located.items():
            now = self._at(comparison)
            changed = any_of(compare("not_equal", self.values[s], s) for s in symbols_of([comparison])
                             if self.values.get(s, s) is not s)
            begun[comparison] = now if is_constant(now) else (
                either(opposite(changed), now) if value is true else both(changed, now))
        return with_values(one.trigger, {c: begun.get(c, self._at(c)) for c in comparisons_of(one.trigger)})

    def _open(self, condition: Any) -> None:
        self.is_open = either(self.is_open, both(self.given, condition))

    def about_to_hold(self, one: Occurrence, holds: Any, changed: Any = true) -> Any:
        """Whether a trigger does not hold, but does right afterwards, as x > 0 where x is zero and rises: no crossing
        shows it. That is asked where something has `changed` the trigger, and is open where the rate is zero too."""
        if not any(c.op in ("less", "greater") and not self.events.is_still(c) for c in comparisons_of(one.trigger)):
            return false
        function = function_of(one.trigger, self.events.is_still)
        on_surface = both(changed, both(opposite(holds), compare("equal", self._at(function), constant(0.0))))
        if never(on_surface):
            return false
        rate = self.events.rate_of(function, one.where)
        if rate is None:
            self._open(on_surface)
            return false
        rate = self._at(rate)
        self._open(both(on_surface, opposite(compare("not_equal", rate, constant(0.0)))))
        return both(on_surface, compare("greater", rate, constant(0.0)))

    def happen(self, first: list[tuple[Occurrence, Any]]) -> None:
        """Triggers some events, and does what follows."""
        self._triggered([(one, condition) for one, condition in first if not never(condition)])
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
                                            compare("less_equal", delay, 10.0 * margin()))))
            if not (is_constant(delay) and value_of(delay) > 0):
                at_once = both(condition, compare("equal", delay, constant(0.0)))
                self.pending.append(Pending(one, at_once, values))
            self._wait(one, both(condition, compare("greater", delay, constant(0.0))), add(sym.time, delay), values)

    def _wait(self, one: Occurrence, condition: Any, due: Any, values: dict[str, Any] | None) -> None:
        """Puts an execution into the first free slot."""
        waiting = condition
        for slot in one.slots:
            takes = both(waiting, compare("greater", self.values[slot.due], constant(0.5 * never_due)))
            waiting = both(waiting, opposite(takes))
            self.values[slot.due] = choose(takes, due, self.values[slot.due])
            for name, accessory in slot.values.items():
                self.values[accessory] = choose(takes, (values or {})[name], self.values[accessory])
        self._open(waiting)
        for rival in self.events.all:  # whose action has changed what the values are from
            if rival.last is not None and one.from_trigger and rival.writes & one.reads:
                self._open(both(condition, at_once(rival.last)))

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

    def _conflict(self, p: Pending, other: Pending) -> bool:
        """Whether it matters which of two executions comes first."""
        if p.what is other.what:
            return not p.is_as(other)
        return self._order_matters(p.what, other.what)

    def _excludes(self, p: Pending, other: Pending) -> bool:
        """Whether two executions cannot be worked out in one round."""
        if p.what is other.what:
            one = p.what  # executing it twice is as executing it once, if what it gives does not follow from that
            read = one.reads if p.values is None else one.late
            return bool(one.writes & read) or not p.is_as(other)
        return self._order_matters(p.what, other.what)

    def run(self) -> None:
        """Executes what is pending, in the order of priorities, and what that makes happen."""
        most, uncertain = len(self.pending) + _consequences, 0
        for _ in range(_rounds):
            first = self._certainly_first()
            if first:
                self.pending = [p for p in self.pending if p not in first]
                again = any(p.what is one for p in first for one, _ in self.executed)
                uncertain += again and not all(is_constant(p.condition) for p in first)
                self._execute([(p, p.condition) for p in first])
            else:
                if len(self._of_uncertain_order()) > _together[0] or len(self.pending) > _together[1]:
                    break
                one_is_certain = any(is_constant(p.condition) for p in self.pending) and all(
                    a is None or is_constant(a) for a in map(self._priority, self.pending))
                chosen = self._chosen()
                for p, selected in chosen:
                    p.condition = false if selected is p.condition else both(p.condition, opposite(selected))
                self._execute(chosen, one_is_certain)
                uncertain += not all(is_constant(selected) for _, selected in chosen)
            self.pending = [p for p in self.pending if not never(p.condition)]
            if not self.pending:
                return
            if uncertain == most:
                break
        if not self.executed:
            raise Refused(f"{self.pending[0].what.where} and {len(self.pending) - 1} others may be executed at one "
                          f"instant in an order that matters: up to {_together[0]} can be")
        self._open(any_of(p.condition for p in self.pending))

    def _certainly_first(self) -> list[Pending]:
        """Those that make nothing else happen, and come before all others whose order to them matters, in one round;
        else one that comes before all others."""
        priorities = [self._priority(p) for p in self.pending]

        def before(i: int, j: int) -> bool:
            a, b = priorities[i], priorities[j]
            return a is not None and is_constant(a) and (
                b is None or is_constant(b) and value_of(a) > value_of(b))

        first = [p for i, p in enumerate(self.pending) if len(self._reach(p.what)) == 1 and all(
            i == j or before(i, j) or not self._excludes(p, o) for j, o in enumerate(self.pending))]
        return first or [p for i, p in enumerate(self.pending) if all(
            i == j or before(i, j) for j in range(len(self.pending)))]

    def _of_uncertain_order(self) -> list[Pending]:
        """Those whose order to another matters, and is not known beforehand."""
        priorities = [self._priority(p) for p in self.pending]
        return [p for i, p in enumerate(self.pending) if not is_constant(p.condition) and any(
            i != j and _may_tie(priorities[i], priorities[j]) and self._conflict(p, other)
            for j, other in enumerate(self.pending))]

    def _priority(self, p: Pending) -> Any:
        return None if p.what.priority is None else self._at(p.what.priority)

    def _key(self, p: Pending) -> Any:
        """The random number of an execution: the next of the instance."""
        if p.key is None:
            stream, start = self.events.random_numbers()
            p.key = next_random(self.values.get(stream, start if self.at_start else stream), self.at_start)
            self.values[stream] = p.key
        return p.key

    def _chosen(self) -> list[tuple[Pending, Any]]:
        """Which execution comes next: each with the condition that it does."""
        pending = self.pending
        priorities = [self._priority(p) for p in pending]

        pairs = [(i, j) for i in range(len(pending)) for j in range(i)]
        is_random = any(_may_tie(priorities[i], priorities[j]) and self._conflict(pending[i], pending[j])
                        for i, j in pairs)
        keys = [self._key(p) if is_random else None for p in pending]

        def comes_first(i: int, j: int) -> Any:
            a, b = priorities[i], priorities[j]
            in_a_tie = ex.constant(i < j)
            if is_random:
                in_a_tie = compare("greater_equal" if i < j else "greater", keys[i], keys[j])
            if a is None or b is None:
                return in_a_tie if a is b else ex.constant(b is None)
            return either(compare("greater", a, b), both(compare("equal", a, b), in_a_tie))

        return [(p, all_of([p.condition, *(either(opposite(other.condition), comes_first(i, j))
                                           for j, other in enumerate(pending) if j != i)]))
                for i, p in enumerate(pending)]

    def _execute(self, which: list[tuple[Pending, Any]], one_is_certain: bool = False) -> None:
        """Executes what is selected, and looks at the triggers afterwards; `one_is_certain` if it is known that one of
        them is."""
        which = [(p, selected) for p, selected in which if not never(selected)]
        before = dict(self.values)
        writers = [p.what.writes for p, _ in which]
        certain = set.intersection(*writers) if one_is_certain and writers else set()
        if len(which) == 1:  # all that follows is worked out for the case that it is executed
            certain, self.given = set(writers[0]), which[0][1]
        changed: set[Any] = set()
        for p, selected in which:
            one = p.what
            values = p.values
            if values is None:
                values = dict(zip(one.given, substituted(one.given.values(), before)))
            marks = {n: mark(n) for n in values}
            known = {marks[n]: v for n, v in values.items()}
            stored = self.events._stores(one, marks)
            for symbol, value in zip(stored, substituted(stored.values(), {**before, **known})):
                self.values[symbol] = choose(true if symbol in certain else selected, value, self.values[symbol])
                certain.discard(symbol)
            self.executed.append((one, selected))
            changed |= one.writes
        newly = []
        for one in self.events.all:
            if not one.inputs & changed:
                continue
            holds = self._holds(one)
            by = any_of(true if selected is self.given else selected
                        for p, selected in which if p.what.writes & one.inputs)
            begins, is_about_to = both(opposite(self.truth[one]), holds), self.about_to_hold(one, holds, by)
            self.truth[one] = choose(self.given, holds, self.truth[one])
            if any(other is one for other, _ in self.executed):  # again and again, perhaps
                self._open(is_about_to)
            else:
                begins = either(begins, is_about_to)
            newly.append((one, both(self.given, begins)))
            if not one.persistent:
                for p in self.pending:
                    if p.what is one:
                        p.condition = both(p.condition, either(opposite(self.given), holds))
                for slot in one.slots:
                    self.values[slot.due] = choose(holds, self.values[slot.due], constant(never_due))
        self._triggered([(one, condition) for one, condition in newly if not never(condition)])
        self.values = {s: choose(self.given, value, before.get(s, s)) for s, value in self.values.items()}
        self.given = true

    def assignments(self, group: list[Occurrence]) -> dict[Any, Any]:
        """What the action of an event of the model assigns."""
        do = {s: v for s, v in self.values.items() if v is not s}
        for one, happens in self.executed:
            for rival in self.events.all:
                if rival.last is not None and (rival is one or interfere(rival, one)):
                    self._open(both(happens, at_once(rival.last)))
            if one.last is not None:
                do[one.last] = choose(happens, sym.time, do.get(one.last, one.last))
        if is_constant(self.is_open) and value_of(self.is_open):
            which = list(dict.fromkeys(one.where for one in group))
            if len(which) == 1:
                raise Refused(f"{which[0]} may make itself happen again at the same instant, without an end")
            raise Refused(f"{' and '.join(which)} happen at one instant, and SBML leaves open what happens: their "
                          "order matters")
        if not never(self.is_open):
            do[sym.end_instance] = self.is_open
        return do
