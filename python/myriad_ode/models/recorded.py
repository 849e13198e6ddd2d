# SPDX-License-Identifier: MIT
"""A model: equations, events, accessories and hooks, recorded once and checked."""

from __future__ import annotations

import copy
from collections.abc import Callable, Collection, Sequence
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

from ..base import component_kinds as kinds
from ..base.errors import Error, at, users_line
from ..symbolic import symbols as sym
from ..symbolic.delays import pasts_of
from ..symbolic.evaluate import evaluate
from ..symbolic.folding import add, constant, multiply
from ..symbolic.functions import draws
from ..symbolic.node import Node, symbols_of, text, walk
from ..symbolic.table import tables_of
from .any_model import AnyModel, names_of
from . import delays
from .components import name_of
from .dose_table import DoseTable
from .doses import Doses
from .event import Event, Stop, stop
from .latex import model_html, model_latex
from .mass_matrix import left_sides, read_mass_matrix
from .noise import equation_texts, read_noise, refuse_parts, refuse_symbols
from .reader import Reader
from .recorded_check import check_recorded
from .tabled_doses import refuse_misfits
from .time_jumps import TimeSwitches
from .trigger import Edge, Queue, Trigger, edges_of, needs_queue
from .units import CouplingTable, together, unit_by_unit
from .whole_numbers import check_constants

if TYPE_CHECKING:
    import numpy.typing as npt

    from ..symbolic.expression import Expression
    from ..symbolic.types import Array, Assignments, ByComponent, Names

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
                 triggers: Trigger | Sequence[Trigger] = (), tie_seed: int | None = None,
                 exact_float: bool = False, noise: ByComponent | None = None,
                 history: ByComponent | None = None) -> None:
        self.line = users_line()
        self.exact_float = exact_float
        self.hidden: frozenset[str] = frozenset()  # accessories that no user has named
        self.jumps_to_miss: list[str] = []  # where equations and events jump and no step ends
        self.jumps_by_state: list[str] | None = None  # where the state makes the equations jump, once that is known
        self._made: dict[str, Any] = {}  # what has been made of it, such as its text
        reader = self._reader = Reader(self.line, states, parameters, shared, accessories)
        targets, self.rhs = reader.equations(equations, states)
        self.units_of_states = reader.units_of_states
        self.states = [t.value[1] for t in targets]
        others = [a for a in accessories or {} if isinstance(a, Node) and a.op == "symbol"]
        reader.names = {**{s.value[1]: s for s in targets + symbols_of(self.rhs) + others}, **reader.declared}
        self.events = reader.events(events)
        self.stops = reader.stops(stops)
        self.triggers, at_sides = reader.triggers(triggers, dict(zip(targets, self.rhs)))
        self._written_events = len(self.events)
        self.events += at_sides
        self.queue = Queue(self.triggers, tie_seed) if needs_queue(self.triggers) or tie_seed is not None else None
        self.edges: list[Edge] = list(edges_of(self.triggers, self.queue))
        if self.queue is not None:
            self.hidden = frozenset(self.queue.accessories + self.queue.integers)
        self.noise = read_noise(reader, noise, targets)
        self.has_noise = self.noise is not None
        self.history = delays.read_history(reader, history, targets)  #: of states, before the begin
        start, self.summaries, self.observed, self._accessory_targets = reader.accessories(accessories)
        self.initialise: Assignments = start + reader.assignments(initialise, "initialise", {t for t, _ in start})
        self.after_step = reader.assignments(after_step, "after_step")
        self.finalise = reader.assignments(finalise, "finalise")
        self.generate: Assignments = reader.generate(generate)
        self._collect(targets)
        self.equations = dict(zip(targets, self.rhs))  #: the derivatives as they were given
        self._make_jumps_exact(name, mass_matrix is not None)
        #: M of M y' = f by rows and columns; None for the identity
        self.mass_matrix = None if mass_matrix is None else read_mass_matrix(
            mass_matrix, self.states, lambda key: reader.target(key, "mass_matrix").value[1], self.line)
        if self.noise is not None:
            refuse_parts(self)
        self.name = self._default_name(equations) if name is None else sym.check_name(name, "a model")
        if self.history:
            self.defaults = {state.value[1]: value for state, value in self.history.items()}
        check_recorded(self)

    def _default_name(self, equations: object) -> str:
        """The name of the function, if a struct can have it, or "model"."""
        for name in (getattr(equations, "__name__", ""), "model"):
            try:
                if name not in self.component_names:
                    return sym.check_name(name, "a model")
            except Error:
                continue
        return "traced"

    # What follows from it

    def _make_jumps_exact(self, name: str | None, has_mass_matrix: bool) -> None:
        """Lets steps end at all jumps in time that are known beforehand, by a further stop and two accessories."""
        changing = {target for target, _ in (*self.after_step, *self.finalise)}
        changing |= {sym.symbol("accessory", one.accessory) for one in self.summaries}
        changing |= set(self.noise.noisy_states if self.noise else ())
        if has_mass_matrix:  # the slopes are others than the equations say
            changing |= set(self.equations)

        self._as_given = copy.copy(self)
        self._as_given.name, self._changing = name or "", changing
        self._switch(None)

    def _switch(self, moves: Callable[[set[Any]], bool] | None) -> None:
        """Makes jumps in time exact. `moves`: the symbols that jumps with stops of their own have times from."""
        given = self._as_given
        self.events = [copy.copy(one) for one in given.events]
        self.stops = [copy.copy(one) for one in given.stops]
        self.triggers = [copy.copy(one) for one in given.triggers]
        self.edges = list(edges_of(self.triggers, self.queue))
        taken: list[str] = []

        def free(wanted: str) -> str:
            names = [*given.component_names, *self._reserved, *([given.name] if given.name else []), *taken]
            taken.append(sym.free_name(wanted, names))
            return taken[-1]

        quantities = [*(quantity for _, quantity in given.observed), *(given.noise.factors if given.noise else ())]
        switches = self.switches = TimeSwitches(self.equations, quantities, [e.function for e in given.events],
                                                self._changing, free, moves)
        self.jumps_to_miss = switches.unknown
        if not switches.switches:
            return
        if "stop_time" in given.component_names:  # which a model with stops cannot have
            self.jumps_to_miss = switches.jumps
            self.switches = TimeSwitches({}, [], [], [], free)  # none
            return
        self.rhs = list(switches.equations.values())
        self.observed = [(short, quantity) for (short, _), quantity in zip(given.observed, switches.quantities)]
        if given.noise is not None:
            self.noise = given.noise.with_factors(switches.quantities[len(given.observed):])
        self.initialise = switches.continued(given.initialise, begins=True)
        for one in (*self.events, *self.stops, *self.triggers):
            if not switches.needed.isdisjoint(target for target, _ in one.do):
                one.do = switches.continued(one.do)
        self.stops = [*self.stops, *self._reader.stops([
            stop(one.following, every=0, name=free("jump"), do=one.at_jump) for one in switches.switches])]
        self.hidden |= {target.value[1] for target in switches.at_start}
        self._collect(list(self.equations))

    def latex(self) -> str:
        r"""The model as LaTeX, an `aligned` environment for between `$$` and `$$`: equations, summaries, events, stops
        and triggers with their actions, and hooks, as they were given. Greek letters are known by their names, and what
        follows an underscore is a subscript. Parts that a very long equation needs several times have a line of their
        own."""
        return model_latex(self._as_given, self.mass_matrix)

    def _repr_html_(self) -> str:
        return model_html(self, self._as_given)

    @property
    def quantities_as_given(self) -> list[tuple[str, Expression]]:
        """The quantities of summaries before jumps in time were made exact."""
        return self._as_given.observed

    def changeable(self: Recorded) -> Recorded:
        """A copy that has nothing of what has been made of the model."""
        made = copy.copy(self)
        made._made = {}
        return made

    def with_doses(self: Recorded, *several: Doses | DoseTable) -> Recorded:
        """The model whose states get these doses, from `my.doses(...)` or `my.dose_table(...)`, besides what the model
        itself does."""
        line, made, given, reader = users_line(), self.changeable(), self._as_given, copy.copy(self._reader)
        made.line, made.has_doses = line, True
        for part in ("rhs", "events", "stops", "triggers", "noise", "observed", "initialise", "hidden"):
            setattr(made, part, getattr(given, part))
        made.equations = dict(self.equations)
        names = list(given.component_names)

        def free_name(wanted: str) -> str:
            names.append(sym.free_name(wanted, [*names, *self._reserved]))
            return names[-1]

        wrong = next((one for one in several if not isinstance(one, (Doses, DoseTable))), None)
        if wrong is not None:
            raise Error(f"with_doses gets a {type(wrong).__name__}{at(line)}: make it by my.doses(state, amount, "
                        "at=...)")
        stops, parts = [], []
        for one in [part for table in several for part in table.parts]:
            reader.line = one.line
            parts.append(one.read(reader.expression))
        refuse_misfits(parts, given, self.has_table)
        for one in parts:
            reader.line, target = one.line, None
            if one.into is not None:
                given_name = name_of(one.into)
                target = sym.symbol("state", self.aliases.get(given_name, given_name))
            shares = [] if target is None else self._shares(target.value[1], one.line)
            for symbol in symbols_of(one.values):
                kind, name = symbol.value
                if kind == "state" or kind not in kinds.valued:
                    raise Error(f"doses{at(one.line)} depend on {name}: they are made of parameters, shared values and "
                                "accessories; write a my.stop where an amount depends on more")
                names.append(name)
            for state, share in zip(made.equations, shares):
                if share != 0:
                    made.equations[state] = add(made.equations[state], multiply(constant(share), one.inflow()))
            known = dict(made.initialise)
            started = one.at_start(sym.symbol("state", self.states[0]) if target is None else target, known)
            made.initialise = [*(known | dict(reader.assignments(started, "initialise"))).items()]
            stops += one.stops(target, free_name, list(self.equations))
            made.hidden |= one.hidden
        made.has_table = self.has_table or any(isinstance(table, DoseTable) for table in several)
        made.stops = sorted([*made.stops, *reader.stops(stops)], key=lambda one: one.order)
        made.rhs = list(made.equations.values())
        made._collect(list(made.equations))
        made._make_jumps_exact(given.name or None, self.mass_matrix is not None)
        check_recorded(made)
        return made

    def _shares(self, name: str, line: tuple[str, int] | None) -> list[float]:
        """What of an inflow into a state each equation gets: the state's column of the mass matrix. Refuses doses into
        what is no state, or one that follows from others or that others follow from."""
        mass = np.eye(len(self.states)) if self.mass_matrix is None else self.mass_matrix
        columns = {state: column for state, column in zip(self.states, mass.T.tolist()) if any(column)}
        if name not in columns:
            why = "whose derivative is in no equation" if name in self.states else "which is no state of the model"
            raise Error(f"doses go into {name}{at(line)}, {why}: choose one of {', '.join(columns)}")
        if name in self.conserved:
            raise Error(f"doses go into {name}{at(line)}, and the conserved sum {self.conserved[name]} would stay as "
                        "it is: read the file without reduce=True")
        return columns[name]

    def with_generated(self: Recorded, values: ByComponent) -> Recorded:
        """The model whose `generate` also sets these components of the instances of a study."""
        made = self.changeable()
        made.generate = [*self.generate, *self._reader.generate(values)]
        made._as_given = copy.copy(self._as_given)
        made._as_given.generate = made.generate
        made._collect(list(made.equations))
        check_recorded(made)
        return made

    def with_jumps_apart(self: Recorded, moves: Callable[[set[Any]], bool]) -> Recorded:
        """The model in which jumps at times that depend on certain symbols have stops of their own, so that each
        contributes the derivative of its own time; the model itself if no jump depends on them."""
        if not self.switches.may_move(moves):
            return self
        made = self.changeable()
        made.hidden = self.hidden - {target.value[1] for target in self.switches.at_start}
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
        self._functions += self.noise.factors if self.noise is not None else []
        pasts = pasts_of([*self._functions, *waits, *(e for _, assignments in hooks for _, e in assignments)])
        self._functions += [*(past.value[1].lag for past in pasts), *(self.history.values() if pasts else ())]
        self._in_functions = symbols_of(self._functions)
        found = targets + self._in_functions + symbols_of(times) + self._accessory_targets
        found += [past.value[1].state for past in pasts]
        for _, assignments in hooks:
            found += [t for t, _ in assignments] + symbols_of([e for _, e in assignments])
        found += symbols_of(waits)
        found += [t for t, _ in self.generate] + symbols_of([e for _, e in self.generate])
        components: dict[str, list[str]] = {kind: [] for kind in kinds.valued}
        declared = [s for s in self._reader.declared.values() if s.value[0] in components]
        for symbol in dict.fromkeys(declared + found):
            if symbol.value[0] in components:
                components[symbol.value[0]].append(symbol.value[1])
        if self.units_of_states is not None:
            for kind in ("parameter", "shared"):
                components[kind] = together(components[kind], self.units_of_states.count)
            for kind in kinds.accessories:
                components[kind] = unit_by_unit(components[kind], self.units_of_states.count)
        refuse_symbols(found, self.line)
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
        self._name_delays(pasts)

    def _name_delays(self, pasts: list[Node]) -> None:
        """The delayed values, with names that nothing else has."""
        self.delays: list[delays.Delay] = []
        taken = [*self.component_names, *self._reserved]
        for one in delays.delays_of(pasts):
            of_state = f"{one.state}_{'slope' if one.is_slope else 'past'}"
            number = 1 + sum((other.state, other.is_slope) == (one.state, one.is_slope) for other in self.delays)
            taken.append(sym.free_name(of_state + (f"_{number}" if number > 1 else ""), taken))
            self.delays.append(one._replace(name=taken[-1]))

    def enumerations(self) -> list[tuple[str, list[str]]]:
        """(kind, names) of everything that has an enumeration in C++."""
        shared = self.scalar_shared + [name for t in self.tables for name in (t.name, f"{t.name}_last")]
        return [*{**names_of(self), "shared": shared}.items(), ("observed", [n for n, _ in self.observed]),
                ("noise", [] if self.noise is None else self.noise.names),
                ("delayed", [one.name for one in self.delays]),
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

    # What it is used for

    @property
    def generator(self) -> str:
        """What `generate` does, as text for the description of a study; empty if there is none."""
        return "; ".join(f"{target.value[1]} = {text(value)}" for target, value in self.generate)

    def derivatives(self, t: npt.ArrayLike, y: Any, **values: Any) -> Array:
        """The right-hand side f by NumPy: y has one entry per state, each a number or an array; parameters and shared
        values are given by name. For looking at a model and for tests; SciPy can integrate it."""
        delays.refuse(self, "their slopes by NumPy", "integrate it by my.solve, whose equations know the past")
        known = {sym.time: t, **{sym.symbol("state", n): v for n, v in zip(self.states, y)}}
        for symbol in symbols_of(self.equations.values()):
            kind, name = symbol.value
            if kind in kinds.valued and kind != "state":
                if name not in values:
                    raise Error(f"derivatives needs a value of {name}: give it by name, {name}=...")
                known[symbol] = values[name]
        return np.array(np.broadcast_arrays(*evaluate(list(self.equations.values()), known), *y, t)[:len(y)])

    def __repr__(self) -> str:
        equations = equation_texts(self, left_sides(self)[:4], list(self.equations.values())[:4])
        return f"<myriad model {self.name}: {'; '.join(equations)}{'; ...' if len(self.states) > 4 else ''}>"
