# SPDX-License-Identifier: MIT
"""A model of coupled units as that of one unit, in C++: what teams of a GPU's threads integrate."""

from __future__ import annotations

import copy
from typing import TYPE_CHECKING, Any

from ..models.delays import Delay
from ..models.units import CouplingTable, of_units
from ..symbolic.delays import Past
from ..symbolic.expression import make
from ..symbolic.node import Node, symbols_of, walk
from ..symbolic.symbols import free_name
from .cpp_body import Body, Names, branches, wrap
from .cpp_writer import Writer

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from ..models.recorded import RecordedModel
    from ..models.units import Units
    from ..symbolic.types import Assignments


# What a unit has by these names, beside those that begin like its own variables.
_members = {"unit", "publish", "publication", "n_publication", "couplings", "diffusion", "observe", "events",
            "summaries", "threads_per_instance", "wanted", "delayed_unit"}


class _NotAlike(Exception):
    """Two units differ in more than their numbers."""


class UnitForm(Writer):
    """Units that are alike, as one of them. Its symbols of components of units are ("of_unit", (kind, name, distance)),
    those of sums of a coupling ("sum", (table, what is summed, distance of the row)). A delayed value belongs to the
    unit whose parameters its lag reads, or else to that of its state."""

    def __init__(self, model: RecordedModel, units: Units) -> None:
        self.model, self.units = model, units
        self._shifted: dict[tuple[int, int], Node] = {}
        self._numbers = {str(i) for i in range(units.count)}
        self._in_generate = False
        of_kind = {"state": model.states, "parameter": model.parameters, "shared": model.scalar_shared,
                   "accessory": model.accessories, "integer_accessory": model.integer_accessories,
                   "event_count": [e.name for e in model.events], "observed": [name for name, _ in model.observed]}
        #: the kind of components that each unit has, by name without number
        self.groups = {base: kind for kind, several in of_kind.items() for base in of_units(several, units.count)}
        #: those of each kind
        self.of_unit = {kind: list(dict.fromkeys(base for name in several for base in [name.rpartition("_")[0]]
                                                 if self._number(kind, name) is not None))
                        for kind, several in of_kind.items()}
        for kind in ("event_count", "observed"):
            if len(self.of_unit[kind]) * units.count != len(of_kind[kind]):
                raise _NotAlike
        #: the delayed values of a unit: their names by what they are, seen from it
        self.delayed_of_unit: dict[Past, str] = {}
        super().__init__(model, Names(model, [*self.groups, "unit"]))
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
                raise _NotAlike  # a unit's factors see its own states alone
        summaries: list[list[tuple[str, str, str]]] = [[] for _ in range(n)]
        for one in model.summaries:
            unit, of_accessory = self._number("observed", one.observed), self._number("accessory", one.accessory)
            if unit is None or unit != of_accessory:
                raise _NotAlike
            summaries[unit].append((one.observed.rpartition("_")[0], one.kind, one.accessory.rpartition("_")[0]))
        if any(of_unit != summaries[0] for of_unit in summaries):
            raise _NotAlike
        self.summaries = summaries[0]
        several = dict.fromkeys(s.value[1][:2] for s in symbols_of(self.roots) if s.value[0] == "sum")
        if {table for table, _ in several} != {t for t in model.tables if isinstance(t, CouplingTable)}:
            raise _NotAlike
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
                raise _NotAlike
            self.at_events.append(self._without_sums(sorted(done[0].items(), key=lambda one: str(one[0].value))))

    def _read_past(self) -> None:
        """The delayed values of a unit, and what they were before the begin."""
        n, history = self.units.count, {state.value[1]: value for state, value in self.model.history.items()}
        if len(self.delayed_of_unit) * n != len(self.model.delays):
            raise _NotAlike  # some are read of some units alone
        self.of_unit["delayed"] = list(self.delayed_of_unit.values())
        self.before: list[tuple[str, Node]] = []
        for past, name in self.delayed_of_unit.items():
            _, base, distance = past.state.value[1]
            of_each = [history.get(f"{base}_{(i + distance) % n}") for i in range(n)]
            given = [value for value in of_each if value is not None]
            if len(given) not in (0, n):
                raise _NotAlike
            if given:
                self.before.append((name, self._alike(given)))

    def _delayed(self, past: Past, unit: int) -> Node:
        """A delayed value as one of the unit that it belongs to."""
        n = self.units.count
        if not past.has_constant_lag:
            raise _NotAlike
        numbers = {number for s in symbols_of([past.lag]) if (number := self._number(*s.value)) is not None}
        of_state = self._number(*past.state.value)
        if of_state is None or len(numbers) > 1:
            raise _NotAlike
        owner = numbers.pop() if numbers else of_state
        own = Past(self._shift(past.state, owner), self._shift(past.lag, owner), past.is_slope)
        if own not in self.delayed_of_unit:
            stem = f"{own.state.value[1][1]}_{'slope' if own.is_slope else 'past'}"
            taken = [*self.model.component_names, *self.groups, *self.delayed_of_unit.values()]
            self.delayed_of_unit[own] = free_name(stem, taken)
            self.names.taken.add(self.delayed_of_unit[own])
        return make("symbol", value=("of_unit", ("delayed", self.delayed_of_unit[own], (owner - unit) % n)))

    def _of_each(self, assignments: Assignments) -> tuple[Assignments, Assignments]:
        """The assignments of the system and those of each unit. All take effect together, while C++ calls the hook for
        one unit after the other: so no unit may read what is assigned to another, or to the system."""
        system: Assignments = []
        of_units: dict[tuple[str, str], list[Any]] = {}
        for target, value in assignments:
            unit = self._number(*target.value)
            if unit is None:
                system.append((target, value))
            else:
                values = of_units.setdefault((target.value[0], target.value[1].rpartition("_")[0]),
                                             [None] * self.units.count)
                values[unit] = value
        own: Assignments = []
        for (kind, base), values in of_units.items():
            if any(value is None for value in values):
                raise _NotAlike
            target = next(t for t, _ in assignments if t.value == (kind, f"{base}_0"))
            own.append((self._shift(target, 0), self._alike(values)))
        written = {t.value for t, _ in system}
        for symbol in symbols_of([value for _, value in own]):
            kind, value = symbol.value
            if symbol.value in written or kind == "of_unit" and value[2] != 0 and value[:2] in of_units:
                raise _NotAlike
        return self._without_sums(system), self._without_sums(own)

    @staticmethod
    def _without_sums(assignments: Assignments) -> Assignments:
        """The assignments, unless they use sums of couplings, which only right-hand sides have."""
        for node in walk([value for _, value in assignments]):
            if node.op == "symbol" and node.value[0] == "sum" or node.op == "dot":
                raise _NotAlike
        return assignments

    def _number(self, kind: str, name: Any) -> int | None:
        """The number of the unit that has this component; None if the system has it."""
        base, _, number = name.rpartition("_")
        return int(number) if self.groups.get(base) == kind and number in self._numbers else None

    def _alike(self, of_units: Sequence[Node], coupled: bool = True) -> Node:
        """The expressions of all units as that of one, without sums of couplings unless it may be `coupled`."""
        several = [self._shift(root, i) for i, root in enumerate(of_units)]
        if any(one is not several[0] for one in several) or not coupled and any(
                s.value[0] == "sum" for s in symbols_of(several[:1])):
            raise _NotAlike
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
                raise _NotAlike
            summed = {self._shift(a, j) for j, a in zip(table.columns(row), node.args)}
            what = summed.pop()
            if summed or any(s.value[0] == "of_unit" and s.value[1][2] != 0 or s.value[0] == "sum"
                             for s in symbols_of([what])):
                raise _NotAlike
            return make("symbol", value=("sum", (table, what, (row - unit) % n)))
        if node.op == "symbol":
            kind, name = node.value
            if kind == "delayed":
                return self._delayed(name, unit)
            number = self._number(kind, name)
            if number is None:
                return node
            return make("symbol", value=("of_unit", (kind, name.rpartition("_")[0], (number - unit) % n)),
                        type=node.type)
        return make(node.op, tuple(self._shifted[id(a), unit] for a in node.args), node.value,
                    node.type) if node.args else node

    # C++

    def source(self, struct: str) -> str:
        """The text of a model of that name."""
        model, n = self.model, self.units.count
        lines = [f"static constexpr bool {name} = true;" for name in (
            "accessories_are_outputs", "writes_parameters", "writes_time_domain") if getattr(model, name)]
        if model.noise is not None and model.noise.is_additive:
            lines.append("static constexpr bool additive_noise = true;")
        if self.units.threads_per_instance is not None:
            lines.append(f"static constexpr int threads_per_instance = {self.units.threads_per_instance};")
        lines += self._enumerations()
        if self.couplings:
            lines.append(f"static constexpr myriad::coupling couplings[] = {{{', '.join(self._couplings())}}};")
        if self.summaries:
            lines.append("static constexpr myriad::summary summaries[] = {" + ", ".join(
                f"{{{quantity}, myriad::over_phase::{kind}, {accessory}}}"
                for quantity, kind, accessory in self.summaries) + "};")
        blocks = [self._function("publish", "n_publication", list(self.published))] if self.published else []
        blocks.append(self._function("rhs", "n_unit_state", self.roots))
        for name, count, roots in (("diffusion", "n_unit_state", self.factors),
                                   ("events", "n_unit_event", self.event_functions),
                                   ("observe", "n_unit_observed", self.quantities)):
            blocks += [self._function(name, count, roots)] if roots else []
        blocks += [*self._past_functions(), *self._hook_functions()]
        out = ["// SPDX-License-Identifier: MIT", "// Written by Myriad's Python package from traced units.", "",
               f"struct {struct}_unit {{", *("    " + line for one in lines for line in wrap(one, 0))]
        for block in blocks:
            out += ["", *("    " + line if line else line for line in block)]
        return "\n".join([*out, "};", f"using {struct} = myriad::coupled_units<{struct}_unit, {n}>;", ""])

    def _enumerations(self) -> Iterable[str]:
        """The components of the unit and of the system."""
        model = self.model
        last = {f"{t.name}_last": f"{t.name}_last = {t.name} + {t.values.size - 1}" for t in model.tables}
        of_couplings = {name for table, _ in self.couplings for name in (table.name, f"{table.name}_last")}
        for kind, several in (("state", self.of_unit["state"]), ("accessory", self.of_unit["accessory"]),
                              ("integer_accessory", self.of_unit["integer_accessory"]),
                              ("event", self.of_unit["event_count"]), ("observed", self.of_unit["observed"]),
                              ("delayed", self.of_unit["delayed"])):
            if several:
                yield f"enum unit_{kind} {{ {', '.join(several)}, n_unit_{kind} }};"
        for kind, several in model.enumerations():
            if kind in ("accessory", "integer_accessory"):
                several = [name for name in several if self._number(kind, name) is None]
            own = [last.get(c, c) for c in several if c not in of_couplings]
            if own and kind not in ("state", "event", "observed", "delayed"):
                yield f"enum {kind} {{ {', '.join(own)}, n_{kind} }};"
        if self.published:
            yield f"enum publication {{ {', '.join(f'published_{i}' for i in self.published.values())}, " \
                  "n_publication };"

    def _couplings(self) -> Iterable[str]:
        """The declarations of the couplings."""
        with_matrix: dict[CouplingTable, int] = {}
        for (table, what), number in self.couplings.items():
            form, arguments = "same", [f"published_{self.published[what]}"]
            if with_matrix.setdefault(table, number) != number:
                arguments.append(str(with_matrix[table]))
            else:
                form = table.form
                arguments += [] if table.bandwidth is None else [str(table.bandwidth)]
            yield f"myriad::{form}_coupling({', '.join(arguments)})"

    def other_units(self, nodes: Iterable[Node]) -> list[str]:
        """The numbers of the other units that are named."""
        distances = sorted({s.value[1][2] for s in symbols_of(nodes) if s.value[0] in ("of_unit", "sum")} - {0})
        return [f"const int unit_{d} = (unit + {d}) % {self.units.count};" for d in distances]

    @staticmethod
    def _of(distance: int) -> tuple[str, str]:
        """What stands for a unit at that distance: as an index, and behind what belongs to the unit itself."""
        return (f"unit_{distance}", f".of(unit_{distance})") if distance else ("unit", "")

    def in_function(self, node: Node) -> str:
        names, (kind, value) = self.names, node.value
        if kind == "sum":
            return f"{names.y}{self._of(value[2])[1]}.coupled({self.couplings[value[:2]]})"
        if kind != "of_unit":
            if self._number(kind, value) is not None and kind in ("accessory", "integer_accessory"):  # in stop_time
                of_kind = self.model.accessories if kind == "accessory" else self.model.integer_accessories
                return f"{names.p}.{kind}[{list(of_kind).index(value)}]"
            return super().in_function(node)
        kind, base, distance = value
        index, of = self._of(distance)
        if kind == "state":
            return f"{names.y}{of}[{base}]"
        if kind in ("parameter", "shared"):
            return f"{names.p if kind == 'parameter' else names.p + '.shared'}[{base}_0 + {index}]"
        return f"{names.p}{of}.unit_{kind}[{base}]"

    def in_hook(self, node: Node) -> str:
        lane, (kind, value) = self.names.lane, node.value
        if kind == "of_unit":
            kind, base, distance = value
            index, of = self._of(distance)
        else:
            unit = self._number(kind, value) if isinstance(value, str) else None
            if unit is None:
                return super().in_hook(node)
            base, index, of = value.rpartition("_")[0], str(unit), f".of({unit})"
            if self._in_generate and kind == "state":
                return f"{lane}.y[{list(self.model.states).index(value)}]"
            if self._in_generate and kind not in ("parameter", "shared"):
                of_kind = self.model.accessories if kind == "accessory" else self.model.integer_accessories
                return f"{lane}.{kind}[{list(of_kind).index(value)}]"
        if kind in ("parameter", "shared"):
            return f"{lane}.{kind}[{base}_0 + {index}]"
        member = {"state": "y", "event_count": "event_count"}.get(kind, f"unit_{kind}")
        return f"{lane}{of}.{member}[{base}]"

    def _function(self, name: str, count: str, roots: Sequence[Node]) -> list[str]:
        names = self.names
        body = Body(roots, names, self.in_function, scalar=False)
        values = [f"{names.R}({body.text(root)})" for root in roots]
        out = [f"template <class {names.R}>"]
        out += wrap(f"MYRIAD_FUNCTION static myriad::vec<{names.R}, {count}> {name}([[maybe_unused]] int unit, "
                     f"[[maybe_unused]] auto {names.t}, [[maybe_unused]] const auto& {names.y}, "
                     f"[[maybe_unused]] const auto& {names.p}) {{", 0)
        for line in [*self.other_units(roots), *body.lines]:
            out += wrap(line, 4)
        return [*out, *wrap(f"return myriad::vec<{names.R}, {count}>{{{', '.join(values)}}};", 4), "}"]

    def _past_functions(self) -> Iterable[list[str]]:
        """The functions of delayed values, if there are any."""
        if not self.delayed_of_unit:
            return
        n, number = self.units.count, self.names.number
        delays = [Delay(name, None, past.state.value[1][1], past.lag, True, past.is_slope)
                  for past, name in self.delayed_of_unit.items()]
        of_system = not any(s.value[0] == "of_unit" for s in symbols_of([one.lag for one in delays]))
        yield from self.past_of(delays, self.before, "u", "p" if of_system else "up")
        distances = [(name, past.state.value[1][2]) for past, name in self.delayed_of_unit.items()]
        if any(distance for _, distance in distances):
            lines = self.by_delay([(name, [f"return (unit + {distance}) % {n};" if distance else "return unit;"])
                                   for name, distance in distances])
            yield ["/// The unit whose state it is of.",
                   f"MYRIAD_FUNCTION static int delayed_unit(int unit, [[maybe_unused]] int {number}) {{",
                   *self.block(lines), "}"]

    def real_text(self, body: Body, root: Node) -> str:
        return f"{self.names.R}({body.text(root)})"

    def _hook_functions(self) -> Iterable[list[str]]:
        """The hooks that there are."""
        lane, model = f"auto& {self.names.lane}", self.model
        for name, (system, own) in self.hooks.items():
            if system or own:
                yield self._hook(name, f"[[maybe_unused]] int unit, {lane}", self._statements_of_each(system, own))
        if any(self.at_events):
            several = zip(self.of_unit["event_count"], self.at_events)
            acting = [(name, self._statements_of_event(do)) for name, do in several if do]
            lines = branches("event", acting, len(self.at_events))
            yield self._hook("after_event", f"[[maybe_unused]] int unit, [[maybe_unused]] int event, {lane}", lines)
        if model.stops:
            yield self.stop_time()
        if any(system or own for system, own in self.at_stops):
            acting = [(str(stop.name), self._statements_of_each(system, own))
                      for stop, (system, own) in zip(model.stops, self.at_stops) if system or own]
            lines = branches("stop", acting, len(model.stops))
            which = "int stop" if len(model.stops) > 1 else "int"
            number = self.number_of([("", lines)])
            yield self._hook("after_stop", f"[[maybe_unused]] int unit, {which}, {number}, {lane}", lines)
        if model.generate:
            writer = copy.copy(self)
            writer.names, writer._in_generate = self.names.in_generate(), True
            yield writer.hook("generate", model.generate)

    def _hook(self, name: str, arguments: str, lines: list[str]) -> list[str]:
        """A hook that returns an action if one of its statements does."""
        ends = any("return" in line for line in lines)
        last = ["    return myriad::action::proceed;"] if ends and not lines[-1].startswith("return") else []
        return [f"MYRIAD_FUNCTION static {'myriad::action' if ends else 'void'} {name}({arguments}) {{",
                *self.block(lines), *last, "}"]

    def _statements_of_event(self, do: Assignments) -> list[str]:
        return [*self.other_units([node for pair in do for node in pair]), *self.done(do)]

    def _statements_of_each(self, system: Assignments, own: Assignments) -> list[str]:
        """The statements of a hook that is called for one unit after the other. What belongs to the system is done in
        the first call, before anything is assigned to units."""
        lines: list[str] = []
        result = []
        if system:
            statements, conditions = self.statements(system, scalar=True)
            wanted = [f"if ({conditions[action]}) wanted = myriad::action::{action};"
                      for action in ("end_phase", "end_instance") if action in conditions]
            if wanted:
                lines.append("myriad::action wanted = myriad::action::proceed;")
                result = ["return wanted;"]
            lines += ["if (unit == 0) {", *("    " + line for line in [*statements, *wanted]), "}"]
        if own:
            statements, _ = self.statements(own, scalar=True)
            lines += [*self.other_units([value for _, value in own]), *statements]
        return [*lines, *result]

    def title(self, target: Node) -> str:
        return target.value[1][1] if target.value[0] == "of_unit" else super().title(target)


def unit_form(model: RecordedModel) -> UnitForm | None:
    """The model as that of one unit; None if its units are not alike, or have what units do not."""
    units = model.units_of_states
    if units is None or units.count < 2 or model.triggers or model.queue:
        return None
    if model.mass_matrix is not None or model.noise is not None and model.noise.processes:
        return None
    try:
        form = UnitForm(model, units)
    except _NotAlike:
        return None
    own = {base for several in form.of_unit.values() for base in several} | set(form.of_unit["state"])
    if own & set(model.component_names) or any(
            name in _members or name.startswith(("unit_", "n_unit_", "published_")) for name in [
                *own, *model.component_names]):
        return None
    return form
