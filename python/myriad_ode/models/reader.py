# SPDX-License-Identifier: MIT
"""What users give of a model, read and checked: equations, events, stops, triggers, accessories and assignments."""

from __future__ import annotations

import copy
import inspect
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ..base import component_kinds as kinds
from ..base.errors import Error, at
from ..symbolic import symbols as sym
from ..symbolic.axes import Axis
from ..symbolic.delays import read_now_or_then
from ..symbolic.expression import as_condition, as_number, is_sympy, to_real
from ..symbolic.node import Node, integer, real, symbols_of, text
from ..symbolic.read_text import from_sympy, parse, parse_equations, sympy_name
from ..symbolic.vectors import vector
from .event import Event, Stop, Summary, stops_apart
from .trigger import Sides, Trigger, check, keep_values
from .units import only_units, spread, unit_by_unit

if TYPE_CHECKING:
    from ..symbolic.expression import Expression
    from ..symbolic.types import Assignments, ByComponent, Component, Names
    from .units import Units


class Accessories(NamedTuple):
    """What accessories start with, the summaries that they are and the quantities of these, and their symbols."""

    start: Assignments
    summaries: list[Summary]
    observed: list[tuple[str, Expression]]
    targets: list[Node]


class Reader:
    """Reads what a model is made of, with the names that are known."""

    def __init__(self, line: tuple[str, int] | None, states: Names | None, parameters: Names, shared: Names,
                 accessories: ByComponent | None) -> None:
        self.line = line
        self.units_of_states: Units | None = None
        declared: dict[str, Node] = {}
        for kind, several in (("state", states or ()), ("parameter", parameters), ("shared", shared),
                              ("accessory", [a for a in accessories or {} if isinstance(a, str)])):
            for given in [several] if isinstance(several, Node) else sym.names(several):
                symbol = given if isinstance(given, Node) else sym.symbol(kind, given)
                other = declared.get(symbol.value[1], symbol)
                if other is not symbol:
                    raise Error(f"'{symbol.value[1]}' names both {sym.a(other.value[0])} and "
                                f"{sym.a(kind)}{at(self.line)}: a name stands for one component")
                declared[symbol.value[1]] = symbol
        declared.setdefault("t", sym.time)
        self.declared = declared
        self.names = declared  #: what texts may name: later also what the equations do

    def value(self, value: Any, what: str) -> Any:
        """An expression from what a user gave."""
        if isinstance(value, str):
            return parse(value, self.names, f"{what}{at(self.line)}")
        if is_sympy(value):
            return from_sympy(value, self.names, f"{what}{at(self.line)}")
        return value

    def target(self, key: Component, what: str) -> Node:
        if is_sympy(key):
            if what != "equations" and hasattr(key, "expr"):
                raise Error(f"{what}{at(self.line)} assigns the derivative `{key}`: assign the state itself")
            key = sympy_name(key)
            if key not in self.names:
                raise Error(f"{what}{at(self.line)}: '{key}' is unknown: name it in parameters=\"...\", or use a "
                            "symbol, as from my.accessory")
            key = self.names[key]
        elif isinstance(key, str):
            key = self.value(key, what)
        if not isinstance(key, Node) or key.op != "symbol":
            raise Error(f"{what}{at(self.line)}: {key!r} stands where a component is assigned: use a symbol, as from "
                        "my.states")
        return key

    def equations(self, equations: Any, states: Names | None) -> tuple[list[Node], list[Expression]]:
        if isinstance(equations, str):
            equations = parse_equations(equations, self.declared, at(self.line))
        elif callable(equations) and not isinstance(equations, dict):
            equations = self._call(equations, states)
        if not isinstance(equations, dict) or not equations:
            what = ("a model has no equation" if isinstance(equations, dict) else
                    f"the equations of a model are {type(equations).__name__}")
            raise Error(f"{what}{at(self.line)}: give a dictionary "
                        "{state: derivative}, a function f(t, y, ...) or a string \"x' = v; v' = -x\"")
        self.units_of_states = only_units(equations)
        equations = spread(equations, "equations", self.line)
        targets, rhs = [], []
        for key in equations:
            if isinstance(key, str) and key not in self.declared:
                self.declared[key] = sym.symbol("state", key)
            elif is_sympy(key) and sympy_name(key) not in self.declared:
                self.declared[sympy_name(key)] = sym.symbol("state", sympy_name(key))
        for key, value in equations.items():
            target = self.target(key, "equations")
            if target.value[0] != "state":
                raise Error(f"{target.value[1]} is no state but {sym.a(target.value[0])}{at(self.line)}: "
                            "only states have equations")
            if isinstance(value, (list, tuple)) or isinstance(value, np.ndarray) and value.ndim > 0:
                raise Error(f"the equation of {target.value[1]} has {len(value)} values{at(self.line)}: it needs one")
            targets.append(target)
            rhs.append(to_real(self._real(self.value(value, f"equation of {target.value[1]}"),
                                          f"the equation of {target.value[1]}")))
        if len(set(map(id, targets))) < len(targets):
            raise Error(f"a state has two equations{at(self.line)}: give each one")
        order = [id(s) for s in self.declared.values() if s.value[0] == "state" and any(s is t for t in targets)]
        if states is not None:  # in the order of `states`, then of the equations
            ranked = sorted(zip(targets, rhs), key=lambda pair: order.index(id(pair[0])) if id(pair[0]) in order else
                            len(order))
            targets, rhs = [t for t, _ in ranked], [e for _, e in ranked]
        elif self.units_of_states is not None:  # one unit after the other
            n = self.units_of_states.count
            targets, rhs = [t for i in range(n) for t in targets[i::n]], [e for i in range(n) for e in rhs[i::n]]
        return targets, rhs

    def expression(self, given: Any, what: str) -> Expression:
        """A real expression from what a user gave."""
        return to_real(self._real(self.value(given, what), what))

    def items(self, given: ByComponent | None, what: str) -> Iterable[tuple[Any, Any]]:
        """What is given by component."""
        return self._items(given, what, self.line)

    def _real(self, value: object, what: str) -> Expression:
        try:
            return as_number(value)
        except Error as error:
            raise Error(f"{what}: {error}") from None

    def _call(self, function: Callable[..., Any], states: Names | None) -> dict[Node, Any]:
        """The equations that a function f(t, y, ...) returns."""
        name = getattr(function, "__name__", "the function")
        if states is None:
            raise Error(f"the states of {name} have no names{at(self.line)}: give them in the order of y, as in "
                        "states=\"x v\"")
        unknowns = [s for s in self.declared.values() if s.value[0] == "state"]
        y = vector(unknowns)
        try:
            arguments = list(inspect.signature(function).parameters.values())
        except (TypeError, ValueError):
            raise Error(f"the arguments of {name} are not known{at(self.line)}: give a Python function f(t, y, ...)"
                        ) from None
        positional = (inspect.Parameter.POSITIONAL_ONLY, inspect.Parameter.POSITIONAL_OR_KEYWORD)
        if len(arguments) < 2 or any(a.kind not in positional for a in arguments[:2]):
            raise Error(f"{name} takes {len(arguments)} arguments{at(self.line)}: its first two are time and state, "
                        "f(t, y, ...)")
        further = {}
        for argument in arguments[2:]:
            if argument.kind not in positional + (inspect.Parameter.KEYWORD_ONLY,):
                raise Error(f"{name} takes *{argument.name}{at(self.line)}: give each parameter a name, f(t, y, k, B)")
            if argument.name not in self.declared:
                if argument.default is not argument.empty:
                    continue  # a constant
                self.declared[argument.name] = sym.symbol("parameter", argument.name)
            further[argument.name] = self.declared[argument.name]
        unused = [n for n, s in self.declared.items() if s.value[0] in ("parameter", "shared") and n not in further]
        if unused:
            raise Error(f"'{unused[0]}' is no argument of {name}{at(self.line)}: write {name}(t, y, {unused[0]})")
        by_position = [a.name for a in arguments[2:] if a.kind == inspect.Parameter.POSITIONAL_ONLY]
        try:
            returned = function(sym.time, y, *(further.pop(n) for n in by_position), **further)
        except Error:
            raise
        except Exception as error:
            hint = f" (y has shape ({len(y)},))" if isinstance(error, (ValueError, IndexError)) else ""
            raise Error(f"{name} failed while it was recorded{at(self.line)}: {type(error).__name__}: {error}{hint}"
                        ) from error
        shape = np.shape(np.asarray(returned, dtype=object)) if not isinstance(returned, Node) else ()
        if shape == () and len(y) == 1 and returned is not None:
            returned, shape = [returned], (1,)
        if shape != (len(y),):
            got = "nothing" if returned is None else f"values of shape {shape}"
            raise Error(f"{name} returns {got}{at(self.line)}: return one derivative for each of the {len(y)} states "
                        f"({', '.join(s.value[1] for s in unknowns)})")
        return dict(zip(unknowns, returned))

    def events(self, events: Event | Sequence[Event]) -> list[Event]:
        if isinstance(events, Event):
            events = [events]
        made = []
        for i, given in enumerate(events):
            if not isinstance(given, Event):
                raise Error(f"events[{i}] is {type(given).__name__}{at(self.line)}: make it by my.event(function, "
                            "direction=...)")
            made.append(Event(None, given.name or f"event_{i + 1}", given.direction, given.tolerance, given.stop_after,
                              None))
            made[-1].line = given.line
        for one, given in zip(made, events):
            what = f"event {one.name}"
            one.function = to_real(self._real(self.value(given.function, what), what))
            one.do = self.assignments(given.do, what, line=given.line)
        if self.units_of_states is not None:  # one unit after the other
            order = unit_by_unit([str(one.name) for one in made], self.units_of_states.count)
            made.sort(key=lambda one: order.index(str(one.name)))
        return made

    def stops(self, stops: Stop | Sequence[Stop]) -> list[Stop]:
        made = []
        for i, given in enumerate([stops] if isinstance(stops, Stop) else stops):
            if not isinstance(given, Stop):
                raise Error(f"stops[{i}] is {type(given).__name__}{at(self.line)}: make it by my.stop(time, "
                            "do=...)")
            one = Stop([], None, None, given.name or f"stop_{i + 1}", None)
            one.line, one.order, what = given.line, given.order, f"stop {one.name}"

            def real_of(value: Any, what: str = what) -> Node | None:
                return None if value is None else to_real(self._real(self.value(value, what), what))

            one.times = [real_of(t) for t in given.times]
            one.every, one.count = real_of(given.every), real_of(given.count)
            if one.every is not None and one.count is None:
                one.count = real_of(float("inf"))
            for symbol in symbols_of(one.values):
                kind, name = symbol.value
                if symbol is not sym.stop_number and (kind == "state" or kind not in kinds.valued):
                    raise Error(f"{name} stands in the time of {what}{at(given.line)}: times are made of parameters, "
                                "shared values and accessories; make an event where a state decides")
            one.do = self.assignments(given.do, what, line=given.line)
            made += stops_apart(one)
        return made

    def triggers(self, triggers: Trigger | Sequence[Trigger], rates: Mapping[Node, Expression]
                 ) -> tuple[list[Trigger], list[Event]]:
        """Triggers, and the events at which their conditions change."""
        moving = {sym.time, *(s for s, rate in rates.items() if rate.value != 0)}
        sides = Sides(lambda condition: not moving.intersection(read_now_or_then([condition])))
        made = []
        for i, given in enumerate([triggers] if isinstance(triggers, Trigger) else triggers):
            if not isinstance(given, Trigger):
                raise Error(f"triggers[{i}] is {type(given).__name__}{at(self.line)}: make it by "
                            "my.trigger(condition, do=...)")
            one = copy.copy(given)
            one.name = given.name or f"trigger_{i + 1}"
            what = f"trigger {one.name}"
            one.condition = as_condition(self.value(given.condition, what))
            one.delay, one.priority = (None if e is None else to_real(self._real(self.value(e, what), what))
                                       for e in (given.delay, given.priority))
            check(one, what)
            written = one.condition
            one.condition = sides.of(written, one.name)
            one.do, one.values = self.assignments(given.do, what, line=given.line), list(given.values)
            one.as_given = copy.copy(one)
            one.as_given.condition = written
            if one.values_from_trigger_time:
                one.do = keep_values(one)
            made.append(one)
        made += sides.after_instants(made)
        return made, list(sides.events())

    def accessories(self, accessories: ByComponent | None) -> Accessories:
        """What accessories start with or summarise."""
        made_of = Accessories([], [], [], [])
        quantities = {}
        for key, value in self._items(accessories, "accessories", self.line):
            target = self.target(key, "accessories")
            if target.value[0] not in kinds.accessories:
                raise Error(f"{target.value[1]} is no accessory but {sym.a(target.value[0])}"
                            f"{at(self.line)}: make it by my.accessory(\"{target.value[1]}\")")
            made_of.targets.append(target)
            if not isinstance(value, Summary):
                if value is not None:
                    made_of.start.extend(self.assignments({target: value}, "accessories"))
                continue
            if target.value[0] != "accessory":
                raise Error(f"the accessory {target.value[1]} holds whole numbers and cannot be a {value.kind}"
                            f"{at(value.line)}: make it by my.accessory")
            quantity = to_real(self._real(self.value(value.quantity, "accessories"),
                                          f"the quantity of {target.value[1]}"))
            if id(quantity) not in quantities:
                is_named = quantity.op == "symbol" and quantity.value[0] != "delayed"
                short = quantity.value[1] if is_named else target.value[1]
                quantities[id(quantity)] = f"observed_{short}"
                made_of.observed.append((f"observed_{short}", quantity))
            made = Summary(value.kind, quantity)
            made.observed, made.accessory, made.line = quantities[id(quantity)], target.value[1], value.line
            made_of.summaries.append(made)
        present = {(r.observed, r.kind) for r in made_of.summaries}
        for r in made_of.summaries:
            extremum = r.kind.removeprefix("time_of_")
            if (r.observed, extremum) not in present:
                raise Error(f"{r.accessory} is the time of a {extremum} that no accessory has{at(r.line)}: add one "
                            f"with my.phase_{extremum} of the same quantity")
        return made_of

    @staticmethod
    def _items(given: ByComponent | None, what: str, line: tuple[str, int] | None) -> Iterable[tuple[Any, Any]]:
        if given is not None and not hasattr(given, "items"):
            raise Error(f"{what} is a {type(given).__name__}{at(line)}: give a dict, as in {{target: value}}")
        return spread(given or {}, what, line).items()

    def assignments(self, given: ByComponent | None, what: str, taken: Iterable[Node] = (),
                     line: tuple[str, int] | None = None) -> Assignments:
        """[(target, value)] of a hook or action, checked."""
        made: Assignments = []
        line = line or self.line
        for key, value in self._items(given, what, line):
            target = self.target(key, what)
            kind, name = target.value
            if what == "generate" and kind not in kinds.of_instances:
                raise Error(f"generate assigns {name}{at(line)}: it sets states, parameters and accessories; give "
                            "my.study the time domain and what all instances share")
            if what == "generate" and isinstance(value, Axis):
                raise Error(f"generate sets {name} to {value!r}{at(line)}, which is for the sweep of a study: write it "
                            "with my.instance")
            if kind in (*kinds.shared, "event_count") or kind == "built-in" and name not in (
                    "next_step", "t_begin", "t_end"):
                raise Error(f"{what} assigns {name}{at(line)}, which no hook may: states, parameters, accessories, "
                            "next_step, t_begin and t_end can be assigned")
            if kind == "action" and what in ("initialise", "finalise", "accessories"):
                raise Error(f"{what} assigns {name}{at(line)}: only after_step and events can end a phase")
            if id(target) in map(id, taken) or any(t is target for t, _ in made):
                raise Error(f"{name} is assigned twice in {what}{at(line)}: give it one value")
            value = self.value(value, what)
            if kind == "action":
                value = as_condition(value)
            else:
                value = self._real(value, f"{what}, {name}")
                value = to_real(value) if target.type == real else value
            if target.type == integer and value.type != integer:
                raise Error(f"{what} gives the whole number {name} the real value `{text(value)}`{at(line)}: use an "
                            "accessory for real numbers, or whole constants")
            made.append((target, value))
        return made

    def generate(self, given: ByComponent | None) -> Assignments:
        """The assignments of `generate`, checked. Texts may name the instance's number."""
        names = self.names
        self.names = {"instance": sym.instance, **names}
        made = self.assignments(given, "generate")
        self.names = names
        for symbol in symbols_of([value for _, value in made]):
            kind, name = symbol.value
            if kind in ("event_count", "action") or kind == "built-in" and name != "instance":
                raise Error(f"generate reads {name}{at(self.line)}, before there is any: it may read the instance's "
                            "number my.instance, components that the study sets, and what all instances share")
            if any(symbol is target for target, _ in made):
                raise Error(f"generate reads {name}{at(self.line)}, which it sets itself: write the expression in its "
                            "place, in a variable of Python's, so that random numbers in it are drawn once")
        return made
