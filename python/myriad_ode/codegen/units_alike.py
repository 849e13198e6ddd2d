# SPDX-License-Identifier: MIT
"""A model of coupled units as that of one unit: the expressions of a unit, with distances to others in the place of
their numbers, which are the same for all units."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ..models.units import CouplingTable, of_units
from ..symbolic.delays import Past
from ..symbolic.expression import make
from ..symbolic.node import Node, symbols_of, walk
from ..symbolic.symbols import free_name

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ..models.recorded import RecordedModel
    from ..models.units import Units
    from ..symbolic.types import Assignments


class NotAlike(Exception):
    """Two units differ in more than their numbers."""


class UnitsAlike:
    """Units that are alike, as one of them. Its symbols of components of units are ("of_unit", (kind, name, distance)),
    those of sums of a coupling ("sum", (table, what is summed, distance of the row)). A delayed value belongs to the
    unit whose parameters its lag reads, or else to that of its state."""

    def __init__(self, model: RecordedModel, units: Units) -> None:
        self.model, self.units = model, units
        self._shifted: dict[tuple[int, int], Node] = {}
        self._numbers = {str(i) for i in range(units.count)}
        of_kind = {"state": model.states, "parameter": model.parameters, "shared": model.scalar_shared,
                   "accessory": model.accessories, "integer_accessory": model.integer_accessories,
                   "event_count": [e.name for e in model.events], "observed": [name for name, _ in model.observed]}
        #: the kind of components that each unit has, by name without number
        self.groups = {base: kind for kind, several in of_kind.items() for base in of_units(several, units.count)}
        #: those of each kind
        self.of_unit = {kind: list(dict.fromkeys(base for name in several for base in [name.rpartition("_")[0]]
                                                 if self.number(kind, name) is not None))
                        for kind, several in of_kind.items()}
        for kind in ("event_count", "observed"):
            if len(self.of_unit[kind]) * units.count != len(of_kind[kind]):
                raise NotAlike
        #: the delayed values of a unit: their names by what they are, seen from it
        self.delayed_of_unit: dict[Past, str] = {}
        self._read_functions()
        self._read_hooks()
        self._read_past()

    def _read_functions(self) -> None:
        model, n = self.model, self.units.count
        equations, observed = dict(zip(model.states, model.rhs)), dict(model.observed)
        functions = {e.name: e.function for e in model.events}
        self.roots = [self._alike([equations[f"{name}_{i}"] for i in range(n)]) for name in self.of_unit["state"]]
        self.event_functions, self.quantities = ([
            self._alike([several[f"{name}_{i}"] for i in range(n)], coupled=False) for name in self.of_unit[kind]]
            for kind, several in (("event_count", functions), ("observed", observed)))
        self.factors: list[Node] = []
        if model.noise is not None:
            factors = dict(zip(model.states, model.noise.factors))
            self.factors = [self._alike([factors[f"{name}_{i}"] for i in range(n)], coupled=False)
                            for name in self.of_unit["state"]]
            if any(kind == "of_unit" and value[0] == "state" and value[2] != 0
                   for kind, value in (s.value for s in symbols_of(self.factors))):
                raise NotAlike  # a unit's factors see its own states alone
        summaries: list[list[tuple[str, str, str]]] = [[] for _ in range(n)]
        for one in model.summaries:
            unit, of_accessory = self.number("observed", one.observed), self.number("accessory", one.accessory)
            if unit is None or unit != of_accessory:
                raise NotAlike
            summaries[unit].append((one.observed.rpartition("_")[0], one.kind, one.accessory.rpartition("_")[0]))
        if any(of_unit != summaries[0] for of_unit in summaries):
            raise NotAlike
        self.summaries = summaries[0]
        several = dict.fromkeys(s.value[1][:2] for s in symbols_of(self.roots) if s.value[0] == "sum")
        if {table for table, _ in several} != {t for t in model.tables if isinstance(t, CouplingTable)}:
            raise NotAlike
        in_order = sorted(several, key=lambda one: model.tables.index(one[0]))
        #: the numbers of the couplings, as (table, what is summed), in the order of the tables' entries
        self.couplings = {one: i for i, one in enumerate(in_order)}
        self.published = {what: i for i, what in enumerate(dict.fromkeys(what for _, what in in_order))}

    def _read_hooks(self) -> None:
        """What hooks and stops assign, to the system and to each unit, and what events do, seen from their unit."""
        model, n = self.model, self.units.count
        self.hooks = {name: self._of_each(getattr(model, name)) for name in ("initialise", "after_step", "finalise")}
        self.at_stops = [self._of_each(stop.do) for stop in model.stops]
        self.at_events = []
        actions = {e.name: e.do for e in model.events}
        for name in self.of_unit["event_count"]:
            done = [{self._shift(target, i): self._shift(value, i) for target, value in actions[f"{name}_{i}"]}
                    for i in range(n)]
            if any(one.keys() != done[0].keys() or any(one[t] is not done[0][t] for t in one) for one in done):
                raise NotAlike
            self.at_events.append(self._without_sums(sorted(done[0].items(), key=lambda one: str(one[0].value))))

    def _read_past(self) -> None:
        """The delayed values of a unit, and what they were before the begin."""
        n, history = self.units.count, {state.value[1]: value for state, value in self.model.history.items()}
        if len(self.delayed_of_unit) * n != len(self.model.delays):
            raise NotAlike  # some are read of some units alone
        self.of_unit["delayed"] = list(self.delayed_of_unit.values())
        self.before: list[tuple[str, Node]] = []
        for past, name in self.delayed_of_unit.items():
            _, base, distance = past.state.value[1]
            of_each = [history.get(f"{base}_{(i + distance) % n}") for i in range(n)]
            given = [value for value in of_each if value is not None]
            if len(given) not in (0, n):
                raise NotAlike
            if given:
                self.before.append((name, self._alike(given)))

    def _delayed(self, past: Past, unit: int) -> Node:
        """A delayed value as one of the unit that it belongs to."""
        n = self.units.count
        if not past.has_constant_lag:
            raise NotAlike
        numbers = {number for s in symbols_of([past.lag]) if (number := self.number(*s.value)) is not None}
        of_state = self.number(*past.state.value)
        if of_state is None or len(numbers) > 1:
            raise NotAlike
        owner = numbers.pop() if numbers else of_state
        own = Past(self._shift(past.state, owner), self._shift(past.lag, owner), past.is_slope)
        if own not in self.delayed_of_unit:
            stem = f"{own.state.value[1][1]}_{'slope' if own.is_slope else 'past'}"
            taken = [*self.model.component_names, *self.groups, *self.delayed_of_unit.values()]
            self.delayed_of_unit[own] = free_name(stem, taken)
        return make("symbol", value=("of_unit", ("delayed", self.delayed_of_unit[own], (owner - unit) % n)))

    def _of_each(self, assignments: Assignments) -> tuple[Assignments, Assignments]:
        """The assignments of the system and those of each unit. All take effect together, while C++ calls the hook for
        one unit after the other: so no unit may read what is assigned to another, or to the system."""
        system: Assignments = []
        of_units: dict[tuple[str, str], list[Any]] = {}
        for target, value in assignments:
            unit = self.number(*target.value)
            if unit is None:
                system.append((target, value))
            else:
                values = of_units.setdefault((target.value[0], target.value[1].rpartition("_")[0]),
                                             [None] * self.units.count)
                values[unit] = value
        own: Assignments = []
        for (kind, base), values in of_units.items():
            if any(value is None for value in values):
                raise NotAlike
            target = next(t for t, _ in assignments if t.value == (kind, f"{base}_0"))
            own.append((self._shift(target, 0), self._alike(values)))
        written = {t.value for t, _ in system}
        for symbol in symbols_of([value for _, value in own]):
            kind, value = symbol.value
            if symbol.value in written or kind == "of_unit" and value[2] != 0 and value[:2] in of_units:
                raise NotAlike
        return self._without_sums(system), self._without_sums(own)

    @staticmethod
    def _without_sums(assignments: Assignments) -> Assignments:
        """The assignments, unless they use sums of couplings, which only right-hand sides have."""
        for node in walk([value for _, value in assignments]):
            if node.op == "symbol" and node.value[0] == "sum" or node.op == "dot":
                raise NotAlike
        return assignments

    def number(self, kind: str, name: Any) -> int | None:
        """The number of the unit that has this component; None if the system has it."""
        base, _, number = name.rpartition("_")
        return int(number) if self.groups.get(base) == kind and number in self._numbers else None

    def _alike(self, of_units: Sequence[Node], coupled: bool = True) -> Node:
        """The expressions of all units as that of one, without sums of couplings unless it may be `coupled`."""
        several = [self._shift(root, i) for i, root in enumerate(of_units)]
        if any(one is not several[0] for one in several) or not coupled and any(
                s.value[0] == "sum" for s in symbols_of(several[:1])):
            raise NotAlike
        return several[0]

    def _shift(self, root: Node, unit: int) -> Node:
        """An expression of a unit with distances to it in the place of numbers, the same node for units alike."""
        n = self.units.count
        waiting = [root]
        while waiting:
            node = waiting[-1]
            key = id(node), unit
            arguments = [] if node.op == "dot" else node.args
            missing = [a for a in arguments if (id(a), unit) not in self._shifted]
            if key in self._shifted or not missing:
                waiting.pop()
                if key not in self._shifted:
                    self._shifted[key] = self._one(node, unit, n)
            else:
                waiting += missing
        return self._shifted[id(root), unit]

    def _one(self, node: Node, unit: int, n: int) -> Node:
        if node.op == "dot":
            table, row = node.value
            if not isinstance(table, CouplingTable) or table.count != n:
                raise NotAlike
            summed = {self._shift(a, j) for j, a in zip(table.columns(row), node.args)}
            what = summed.pop()
            if summed or any(s.value[0] == "of_unit" and s.value[1][2] != 0 or s.value[0] == "sum"
                             for s in symbols_of([what])):
                raise NotAlike
            return make("symbol", value=("sum", (table, what, (row - unit) % n)))
        if node.op == "symbol":
            kind, name = node.value
            if kind == "delayed":
                return self._delayed(name, unit)
            number = self.number(kind, name)
            if number is None:
                return node
            return make("symbol", value=("of_unit", (kind, name.rpartition("_")[0], (number - unit) % n)),
                        type=node.type)
        return make(node.op, tuple(self._shifted[id(a), unit] for a in node.args), node.value,
                    node.type) if node.args else node
