# SPDX-License-Identifier: MIT
"""A model: equations, events, accessories and hooks, recorded once and checked."""

from __future__ import annotations

import copy
import inspect
from collections.abc import Callable, Collection, Iterable, Sequence
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

from ..base import component_kinds as kinds
from ..base.errors import Error, at, users_line
from ..symbolic import symbols as sym
from ..symbolic.axes import Axis
from ..symbolic.evaluate import evaluate
from ..symbolic.expression import (Node, as_condition, as_number, draws, integer, is_sympy, real, symbols_of, text,
                                   to_real, vector, walk)
from ..symbolic.read_text import from_sympy, parse, parse_equations, sympy_name
from ..symbolic.table import tables_of
from ..symbolic.whole_and_real import generic_problem
from .any_model import AnyModel, names_of
from .event import Event, Stop, Summary, stop, stops_apart
from .mass_matrix import left_sides, read_mass_matrix
from .time_jumps import TimeSwitches
from .trigger import Edge, Queue, Sides, Trigger, check, edges_of, keep_values, needs_queue
from .units import CouplingTable, only_units, spread, together, unit_by_unit
from .whole_numbers import check_constants

if TYPE_CHECKING:
    import numpy.typing as npt

    from ..symbolic.expression import Expression
    from ..symbolic.types import Array, Assignments, ByComponent, Component, Names

Recorded = TypeVar("Recorded", bound="RecordedModel")


class RecordedModel(AnyModel):
    """A recorded model. Names of components are in the order in which results and C++ enumerate them, elements of
    tables behind the other shared values; `shared_values` has what they are."""

    _reserved: Collection[str] = ()  # names for no component that the package adds

    def __init__(self, equations: ByComponent | Callable[..., Any] | str, events: Event | Sequence[Event],
                 accessories: ByComponent | None, initialise: ByComponent | None, after_step: ByComponent | None,
                 finalise: ByComponent | None, generate: ByComponent | None, states: Names | None, parameters: Names,
                 shared: Names, name: str | None, stops: Stop | Sequence[Stop] = (),
                 mass_matrix: npt.ArrayLike | ByComponent | None = None,
                 triggers: Trigger | Sequence[Trigger] = (), tie_seed: int | None = None) -> None:
        self.line = users_line()
        self.hidden: frozenset[str] = frozenset()  # accessories that no user has named
        self.jumps_to_miss: list[str] = []  # where equations and events jump and no step ends
        self.jumps_by_state: list[str] | None = None  # where the state makes the equations jump, once that is known
        self._made: dict[str, Any] = {}  # what has been made of it, such as its text
        self._declared = self._declare(states, parameters, shared, accessories)
        self._names = self._declared  # what texts may name: later also what the equations do
        targets, self.rhs = self._equations(equations, states)
        self.states = [t.value[1] for t in targets]
        others = [a for a in accessories or {} if isinstance(a, Node) and a.op == "symbol"]
        self._names = {**{s.value[1]: s for s in targets + symbols_of(self.rhs) + others}, **self._declared}
        self.events = self._events(events)
        self.stops = self._stops(stops)
        self.triggers = self._triggers(triggers, targets)
        self.queue = Queue(self.triggers, tie_seed) if needs_queue(self.triggers) or tie_seed is not None else None
        self.edges: list[Edge] = list(edges_of(self.triggers, self.queue))
        if self.queue is not None:
            self.hidden = frozenset(self.queue.accessories + self.queue.integers)
        start = self._accessories(accessories)
        self.initialise: Assignments = start + self._assignments(initialise, "initialise", {t for t, _ in start})
        self.after_step = self._assignments(after_step, "after_step")
        self.finalise = self._assignments(finalise, "finalise")
        self.generate: Assignments = self._generate(generate)
        self._collect(targets)
        self.equations = dict(zip(targets, self.rhs))  #: the derivatives as they were given
        self._make_jumps_exact(name, mass_matrix is not None)
        #: M of M y' = f by rows and columns; None for the identity
        self.mass_matrix = None if mass_matrix is None else read_mass_matrix(
            mass_matrix, self.states, lambda key: self._target(key, "mass_matrix").value[1], self.line)
        self.name = self._default_name(equations) if name is None else sym.check_name(name, "a model")
        self._check()

    def _default_name(self, equations: object) -> str:
        """The name of the function, if a struct can have it, or "model"."""
        for name in (getattr(equations, "__name__", ""), "model"):
            try:
                if name not in self.component_names:
                    return sym.check_name(name, "a model")
            except Error:
                continue
        return "traced"

    # What users may give

    def _declare(self, states: Names | None, parameters: Names, shared: Names,
                 accessories: ByComponent | None) -> dict[str, Node]:
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
        return declared

    def _value(self, value: Any, what: str) -> Any:
        """An expression from what a user gave."""
        if isinstance(value, str):
            return parse(value, self._names, f"{what}{at(self.line)}")
        if is_sympy(value):
            return from_sympy(value, self._names, f"{what}{at(self.line)}")
        return value

    def _target(self, key: Component, what: str) -> Node:
        if is_sympy(key):
            if what != "equations" and hasattr(key, "expr"):
                raise Error(f"{what}{at(self.line)} assigns the derivative `{key}`: assign the state itself")
            key = sympy_name(key)
            if key not in self._names:
                raise Error(f"{what}{at(self.line)}: '{key}' is unknown: name it in parameters=\"...\", or use a "
                            "symbol, as from my.accessory")
            key = self._names[key]
        elif isinstance(key, str):
            key = self._value(key, what)
        if not isinstance(key, Node) or key.op != "symbol":
            raise Error(f"{what}{at(self.line)}: {key!r} stands where a component is assigned: use a symbol, as from "
                        "my.states")
        return key

    def _equations(self, equations: Any, states: Names | None) -> tuple[list[Node], list[Expression]]:
        if isinstance(equations, str):
            equations = parse_equations(equations, self._declared, at(self.line))
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
            if isinstance(key, str) and key not in self._declared:
                self._declared[key] = sym.symbol("state", key)
            elif is_sympy(key) and sympy_name(key) not in self._declared:
                self._declared[sympy_name(key)] = sym.symbol("state", sympy_name(key))
        for key, value in equations.items():
            target = self._target(key, "equations")
            if target.value[0] != "state":
                raise Error(f"{target.value[1]} is no state but {sym.a(target.value[0])}{at(self.line)}: "
                            "only states have equations")
            if isinstance(value, (list, tuple)) or isinstance(value, np.ndarray) and value.ndim > 0:
                raise Error(f"the equation of {target.value[1]} has {len(value)} values{at(self.line)}: it needs one")
            targets.append(target)
            rhs.append(to_real(self._real(self._value(value, f"equation of {target.value[1]}"),
                                          f"the equation of {target.value[1]}")))
        if len(set(map(id, targets))) < len(targets):
            raise Error(f"a state has two equations{at(self.line)}: give each one")
        order = [id(s) for s in self._declared.values() if s.value[0] == "state" and any(s is t for t in targets)]
        if states is not None:  # in the order of `states`, then of the equations
            ranked = sorted(zip(targets, rhs), key=lambda pair: order.index(id(pair[0])) if id(pair[0]) in order else
                            len(order))
            targets, rhs = [t for t, _ in ranked], [e for _, e in ranked]
        elif self.units_of_states is not None:  # one unit after the other
            n = self.units_of_states.count
            targets, rhs = [t for i in range(n) for t in targets[i::n]], [e for i in range(n) for e in rhs[i::n]]
        return targets, rhs

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
        unknowns = [s for s in self._declared.values() if s.value[0] == "state"]
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
            if argument.name not in self._declared:
                if argument.default is not argument.empty:
                    continue  # a constant
                self._declared[argument.name] = sym.symbol("parameter", argument.name)
            further[argument.name] = self._declared[argument.name]
        unused = [n for n, s in self._declared.items() if s.value[0] in ("parameter", "shared") and n not in further]
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

    def _events(self, events: Event | Sequence[Event]) -> list[Event]:
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
            one.function = to_real(self._real(self._value(given.function, what), what))
            one.do = self._assignments(given.do, what, line=given.line)
        if self.units_of_states is not None:  # one unit after the other
            order = unit_by_unit([str(one.name) for one in made], self.units_of_states.count)
            made.sort(key=lambda one: order.index(str(one.name)))
        return made

    def _stops(self, stops: Stop | Sequence[Stop]) -> list[Stop]:
        made = []
        for i, given in enumerate([stops] if isinstance(stops, Stop) else stops):
            if not isinstance(given, Stop):
                raise Error(f"stops[{i}] is {type(given).__name__}{at(self.line)}: make it by my.stop(time, "
                            "do=...)")
            one = Stop([], None, None, given.name or f"stop_{i + 1}", None)
            one.line, what = given.line, f"stop {one.name}"

            def real_of(value: Any, what: str = what) -> Node | None:
                return None if value is None else to_real(self._real(self._value(value, what), what))

            one.times = [real_of(t) for t in given.times]
            one.every, one.count = real_of(given.every), real_of(given.count)
            if one.every is not None and one.count is None:
                one.count = real_of(float("inf"))
            for symbol in symbols_of(one.values):
                kind, name = symbol.value
                if kind == "state" or kind not in kinds.valued:
                    raise Error(f"{name} stands in the time of {what}{at(given.line)}: times are made of parameters, "
                                "shared values and accessories; make an event where a state decides")
            one.do = self._assignments(given.do, what, line=given.line)
            made += stops_apart(one)
        return made

    def _triggers(self, triggers: Trigger | Sequence[Trigger], states: list[Node]) -> list[Trigger]:
        moving = {sym.time, *(s for s, rate in zip(states, self.rhs) if rate.value != 0)}
        sides = Sides(lambda condition: not moving.intersection(symbols_of([condition])))
        made = []
        for i, given in enumerate([triggers] if isinstance(triggers, Trigger) else triggers):
            if not isinstance(given, Trigger):
                raise Error(f"triggers[{i}] is {type(given).__name__}{at(self.line)}: make it by "
                            "my.trigger(condition, do=...)")
            one = copy.copy(given)
            one.name = given.name or f"trigger_{i + 1}"
            what = f"trigger {one.name}"
            one.condition = as_condition(self._value(given.condition, what))
            one.delay, one.priority = (None if e is None else to_real(self._real(self._value(e, what), what))
                                       for e in (given.delay, given.priority))
            check(one, what)
            one.condition = sides.of(one.condition, one.name)
            one.do, one.values = self._assignments(given.do, what, line=given.line), list(given.values)
            if one.values_from_trigger_time:
                one.do = keep_values(one)
            made.append(one)
        made += sides.after_instants(made)
        self.events = [*self.events, *sides.events()]
        return made

    def _accessories(self, accessories: ByComponent | None) -> Assignments:
        self.summaries, self.observed, start = [], [], []
        quantities = {}
        self._accessory_targets = []
        for key, value in self._items(accessories, "accessories", self.line):
            target = self._target(key, "accessories")
            if target.value[0] not in kinds.accessories:
                raise Error(f"{target.value[1]} is no accessory but {sym.a(target.value[0])}"
                            f"{at(self.line)}: make it by my.accessory(\"{target.value[1]}\")")
            self._accessory_targets.append(target)
            if not isinstance(value, Summary):
                if value is not None:
                    start += self._assignments({target: value}, "accessories")
                continue
            if target.value[0] != "accessory":
                raise Error(f"the accessory {target.value[1]} holds whole numbers and cannot be a {value.kind}"
                            f"{at(value.line)}: make it by my.accessory")
            quantity = to_real(self._real(self._value(value.quantity, "accessories"),
                                          f"the quantity of {target.value[1]}"))
            if id(quantity) not in quantities:
                short = quantity.value[1] if quantity.op == "symbol" else target.value[1]
                quantities[id(quantity)] = f"observed_{short}"
                self.observed.append((f"observed_{short}", quantity))
            made = Summary(value.kind, quantity)
            made.observed, made.accessory, made.line = quantities[id(quantity)], target.value[1], value.line
            self.summaries.append(made)
        present = {(r.observed, r.kind) for r in self.summaries}
        for r in self.summaries:
            extremum = r.kind.removeprefix("time_of_")
            if (r.observed, extremum) not in present:
                raise Error(f"{r.accessory} is the time of a {extremum} that no accessory has{at(r.line)}: add one "
                            f"with my.phase_{extremum} of the same quantity")
        return start

    @staticmethod
    def _items(given: ByComponent | None, what: str, line: tuple[str, int] | None) -> Iterable[tuple[Any, Any]]:
        if given is not None and not hasattr(given, "items"):
            raise Error(f"{what} is a {type(given).__name__}{at(line)}: give a dict, as in {{target: value}}")
        return spread(given or {}, what, line).items()

    def _assignments(self, given: ByComponent | None, what: str, taken: Iterable[Node] = (),
                     line: tuple[str, int] | None = None) -> Assignments:
        """[(target, value)] of a hook or action, checked."""
        made: Assignments = []
        line = line or self.line
        for key, value in self._items(given, what, line):
            target = self._target(key, what)
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
            value = self._value(value, what)
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

    def _generate(self, given: ByComponent | None) -> Assignments:
        """The assignments of `generate`, checked. Texts may name the instance's number."""
        names = self._names
        self._names = {"instance": sym.instance, **names}
        made = self._assignments(given, "generate")
        self._names = names
        for symbol in symbols_of([value for _, value in made]):
            kind, name = symbol.value
            if kind in ("event_count", "action") or kind == "built-in" and name != "instance":
                raise Error(f"generate reads {name}{at(self.line)}, before there is any: it may read the instance's "
                            "number my.instance, components that the study sets, and what all instances share")
            if any(symbol is target for target, _ in made):
                raise Error(f"generate reads {name}{at(self.line)}, which it sets itself: write the expression in its "
                            "place, in a variable of Python's, so that random numbers in it are drawn once")
        return made

    # What follows from it

    def _make_jumps_exact(self, name: str | None, has_mass_matrix: bool) -> None:
        """Lets steps end at all jumps in time that are known beforehand, by a further stop and two accessories."""
        changing = {target for target, _ in (*self.after_step, *self.finalise)}
        changing |= {sym.symbol("accessory", one.accessory) for one in self.summaries}
        if has_mass_matrix:  # the slopes are others than the equations say
            changing |= set(self.equations)

        self._as_given = copy.copy(self)
        self._as_given.name, self._changing = name or "", changing
        self._as_given.events = [copy.copy(one) for one in self.events]
        self._as_given.stops = [copy.copy(one) for one in self.stops]
        self._switch(None)

    def _switch(self, moves: Callable[[set[Any]], bool] | None) -> None:
        """Makes jumps in time exact. `moves`: the symbols that jumps with stops of their own have times from."""
        given = self._as_given
        taken: list[str] = []

        def free(wanted: str) -> str:
            names = [*given.component_names, *self._reserved, *([given.name] if given.name else []), *taken]
            taken.append(sym.free_name(wanted, names))
            return taken[-1]

        switches = self.switches = TimeSwitches(self.equations, [quantity for _, quantity in given.observed],
                                                [e.function for e in given.events], self._changing, free, moves)
        self.jumps_to_miss = switches.unknown
        if not switches.switches:
            return
        if "stop_time" in given.component_names:  # which a model with stops cannot have
            self.jumps_to_miss = switches.jumps
            self.switches = TimeSwitches({}, [], [], [], free)  # none
            return
        self.rhs = list(switches.equations.values())
        self.observed = [(short, quantity) for (short, _), quantity in zip(given.observed, switches.quantities)]
        self.initialise = switches.continued(given.initialise, begins=True)
        for one in (*self.events, *self.stops, *self.triggers):
            if not switches.needed.isdisjoint(target for target, _ in one.do):
                one.do = switches.continued(one.do)
        self.stops = [*self.stops, *self._stops([
            stop(one.following, every=0, name=free("jump"), do=one.at_jump) for one in switches.switches])]
        self.hidden |= {target.value[1] for target in switches.at_start}
        self._collect(list(self.equations))

    @property
    def quantities_as_given(self) -> list[tuple[str, Expression]]:
        """The quantities of summaries before jumps in time were made exact."""
        return self._as_given.observed

    def changeable(self: Recorded) -> Recorded:
        """A copy that has nothing of what has been made of the model."""
        made = copy.copy(self)
        made._made = {}
        return made

    def with_jumps_apart(self: Recorded, moves: Callable[[set[Any]], bool]) -> Recorded:
        """The model in which jumps at times that depend on certain symbols have stops of their own, so that each
        contributes the derivative of its own time; the model itself if no jump depends on them."""
        if not self.switches.may_move(moves):
            return self
        made = self.changeable()
        made.hidden = self.hidden - {target.value[1] for target in self.switches.at_start}
        made.events = [copy.copy(one) for one in self._as_given.events]
        made.stops = [copy.copy(one) for one in self._as_given.stops]
        made._switch(moves)
        return made

    def _collect(self, targets: list[Node]) -> None:
        """The components, in the order in which the equations, events, accessories and hooks first name them."""
        hooks = [("initialise", self.initialise), ("after_step", self.after_step), ("finalise", self.finalise)]
        hooks += [(f"event {e.name}", e.do) for e in self.events] + [(f"stop {s.name}", s.do) for s in self.stops]
        hooks += [(f"trigger {t.name}", t.do) for t in self.triggers]
        times = [value for one in self.stops for value in one.values]
        waits = [e for t in self.triggers for e in (t.delay, t.priority, *t.values) if e is not None]
        self._functions = self.rhs + [e.function for e in self.events] + [q for _, q in self.observed]
        self._in_functions = symbols_of(self._functions)
        found = targets + self._in_functions + symbols_of(times) + self._accessory_targets
        for _, assignments in hooks:
            found += [t for t, _ in assignments] + symbols_of([e for _, e in assignments])
        found += symbols_of(waits)
        found += [t for t, _ in self.generate] + symbols_of([e for _, e in self.generate])
        components: dict[str, list[str]] = {kind: [] for kind in kinds.valued}
        declared = [s for s in self._declared.values() if s.value[0] in components]
        for symbol in dict.fromkeys(declared + found):
            if symbol.value[0] in components:
                components[symbol.value[0]].append(symbol.value[1])
        if self.units_of_states is not None:
            for kind in ("parameter", "shared"):
                components[kind] = together(components[kind], self.units_of_states.count)
            for kind in kinds.accessories:
                components[kind] = unit_by_unit(components[kind], self.units_of_states.count)
        missing = [n for n in components["state"] if n not in self.states]
        if missing:
            symbol = next(s for s in found + declared if s.value == ("state", missing[0]))
            raise Error(f"the state {missing[0]}{at(symbol.line)} has no equation{at(self.line)}: add its derivative, "
                        f"or make it a parameter if it is constant")
        if self.queue is not None:
            components["accessory"] += self.queue.accessories
            components["integer_accessory"] += self.queue.integers
        everything = walk(self._functions + times + waits + [e for _, assignments in hooks for _, e in assignments])
        drawn = next((n for n in everything if n.op in draws), None)
        if drawn is not None:
            raise Error(f"`{text(drawn)}`{at(drawn.line)} is drawn in an equation, event or hook{at(self.line)}: "
                        "random numbers are for generate= alone; let it set a parameter")
        check_constants(everything, waits + [e for _, assignments in hooks for _, e in assignments])
        everything += walk([e for _, e in self.generate])
        # Those of couplings are last, as in C++.
        self.tables = sorted(tables_of(everything), key=lambda t: isinstance(t, CouplingTable))
        self.shared_values = {t.element_name(i): float(v) for t in self.tables for i, v in enumerate(t.values.flat)}
        self.scalar_shared = components["shared"]
        self._set_names({**components, "state": self.states,
                         "shared": [*self.scalar_shared, *self.shared_values]})
        assigned = {t.value for _, assignments in hooks for t, _ in assignments}
        self.writes_parameters = any(kind == "parameter" for kind, _ in assigned)
        self.writes_time_domain = bool(assigned & {("built-in", "t_begin"), ("built-in", "t_end")})
        read = {s.value[0] for s in self._in_functions + symbols_of(times)}
        self.accessories_are_outputs = any(components[kind] for kind in kinds.accessories) and not (
            self.queue or read & {*kinds.accessories})
        self._hooks = hooks

    def enumerations(self) -> list[tuple[str, list[str]]]:
        """(kind, names) of everything that has an enumeration in C++."""
        shared = self.scalar_shared + [name for t in self.tables for name in (t.name, f"{t.name}_last")]
        return [*{**names_of(self), "shared": shared}.items(), ("observed", [n for n, _ in self.observed]),
                ("stop", self.stop_names),
                ("trigger", [e.name for e in self.edges])]

    @property
    def stop_names(self) -> list[str]:
        """The names of the kinds of stop times, those of actions that wait behind the others."""
        return [*(str(s.name) for s in self.stops), *([self.queue.stop] if self.queue else [])]

    @property
    def component_names(self) -> list[str]:
        """All names, in the order of `enumerations`."""
        return [n for _, names in self.enumerations() for n in names]

    def _check(self) -> None:
        kind_of: dict[str, str] = {}
        for kind, names in self.enumerations():
            for name in names:
                if name in kind_of:
                    clash = f"names both {sym.a(kind_of[name])} and {sym.a(kind)}"
                    clash = "is the name of two components" if kind_of[name] == kind else clash
                    raise Error(f"'{name}' {clash}{at(self.line)}: rename one of them")
                kind_of[name] = kind
        for symbol in self._in_functions:
            kind, name = symbol.value
            if kind in ("event_count", "action") or kind == "built-in" and name != "time":
                raise Error(f"{name} stands in an equation, event or summary{at(self.line)}, but only hooks and "
                            "actions see it: store it in an accessory there")
        problem = generic_problem(self._functions)
        if problem is not None:
            raise Error(f"`{text(problem)}`{at(problem.line)} mixes whole and real numbers, or multiplies whole ones, "
                        "in an equation or event: compare them, as in my.where(mode == 1, a, b)")
        for node in walk(self._functions):
            if node.op == "powr" and any(s.value[0] == "state" or s is sym.time for s in symbols_of([node.args[1]])):
                raise Error(f"the exponent of `{text(node)}`{at(node.line)} depends on the state or on time: use "
                            "my.pow, as powr has no derivative by its exponent")
        for what, assignments in self._hooks:
            for _, value in assignments:
                for symbol in symbols_of([value]):
                    kind, name = symbol.value
                    if kind == "action":
                        raise Error(f"{name} is read in {what}{at(self.line)}, but can only be assigned")
                    if kind == "event_count" and name not in [e.name for e in self.events]:
                        raise Error(f"event_count('{name}') in {what}{at(self.line)} names no event: there are "
                                    f"{', '.join(e.name for e in self.events) or 'none'}")
        for what, members, present in (
                ("stops", "stop stop_time", len(self.stop_names) - len(self.switches.switches)),
                ("triggers", "trigger condition after_trigger initial_value persistent queue", self.triggers)):
            taken = next((n for n in members.split() if n in kind_of), None)
            if taken is not None and present:
                raise Error(f"'{taken}' names {sym.a(kind_of[taken])}{at(self.line)}, and has a meaning of its own in "
                            f"a model with {what}: call it '{taken}_'")
        if self.name in kind_of:
            raise Error(f"the model has the name of its {kind_of[self.name]} '{self.name}'{at(self.line)}: give "
                        "it another one, name='...'")

    # What it is used for

    @property
    def generator(self) -> str:
        """What `generate` does, as text for the description of a study; empty if there is none."""
        return "; ".join(f"{target.value[1]} = {text(value)}" for target, value in self.generate)

    def derivatives(self, t: npt.ArrayLike, y: Any, **values: Any) -> Array:
        """The right-hand side f by NumPy: y has one entry per state, each a number or an array; parameters and shared
        values are given by name. For looking at a model and for tests; SciPy can integrate it."""
        known = {sym.time: t, **{sym.symbol("state", n): v for n, v in zip(self.states, y)}}
        for symbol in symbols_of(self.equations.values()):
            kind, name = symbol.value
            if kind in kinds.valued and kind != "state":
                if name not in values:
                    raise Error(f"derivatives needs a value of {name}: give it by name, {name}=...")
                known[symbol] = values[name]
        return np.array(np.broadcast_arrays(*evaluate(list(self.equations.values()), known), *y, t)[:len(y)])

    def __repr__(self) -> str:
        equations = [f"{side} = {text(e)}" for side, e in zip(left_sides(self)[:4], self.equations.values())]
        return f"<myriad model {self.name}: {'; '.join(equations)}{'; ...' if len(self.states) > 4 else ''}>"
