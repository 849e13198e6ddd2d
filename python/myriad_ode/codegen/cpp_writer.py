# SPDX-License-Identifier: MIT
"""A recorded model as the header that a C++ user would write: enumerations, rhs, events and hooks."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING

from .._core import factor_entries
from ..models.delays import Delay, first_of_lag
from ..models.mass_matrix import left_sides, mass_entries
from ..models.noise import equation_texts
from ..symbolic.node import integer, real, walk
from ..symbolic.operations import cost
from ..symbolic.whole_and_real import generic_problem
from .cpp_body import Body, Names, branches, columns, returned, update, wrap
from .jacobian import is_autonomous, jacobian_of

if TYPE_CHECKING:
    from ..models.event import Event, Stop
    from ..models.recorded import RecordedModel
    from ..models.trigger import Edge, Queue
    from ..symbolic.node import Node
    from ..symbolic.types import Assignments


_headers = {"time": "t", "step": "h", "next_step": "h_next", "phase": "phase", "instance": "index",
            "t_begin": "t_begin", "t_end": "t_end"}


def _depends_on_instance(node: Node) -> bool:
    """Whether a value differs between instances, so that it has the type of the state and not of a shared value."""
    return any(n.op == "symbol" and n.value[0] not in ("shared", "shared_integer") for n in walk([node]))


def _kinds_in(roots: Sequence[Node]) -> set[str]:
    """The kinds of components that some expressions read."""
    used = [node for node in walk(roots) if node.op in ("symbol", "element", "dot", "lookup", "find_interval")]
    return {node.value[0] if node.op == "symbol" else "shared" for node in used}


class Writer:
    """Writes one model."""

    def __init__(self, model: RecordedModel, names: Names | None = None) -> None:
        self.model = model
        self.names = names or Names(model)
        self.delayed = {one.symbol: one.name for one in model.delays}

    def header(self, name: str) -> str:
        model = self.model
        out = ["// SPDX-License-Identifier: MIT", "// Written by Myriad's Python package from a traced model.",
               "#pragma once", "", *["#define MYRIAD_EXACT_FLOAT", ""] * model.exact_float,
               *["#include <myriad/action_queue.hpp>"] * bool(model.queue),
               "#include <myriad/model.hpp>", ""]
        macros = [n for n in model.component_names if re.search("[A-Z]{2}", n)]  # maybe, in headers of C
        out += [f"#undef {name}" for name in macros] + [""] * bool(macros)
        out += [f"/// {line}" for line in self.description()]
        out += [f"struct {name} {{"]
        out += ["    " + d for d in self.declarations()]
        last_elements = {f"{t.name}_last": f"{t.name}_last = {t.name} + {t.values.size - 1}" for t in model.tables}
        for kind, names in model.enumerations():
            if names:
                written = ", ".join(last_elements.get(n, n) if kind == "shared" else n for n in names)
                out += ["    " + line for line in wrap(f"enum {kind} {{ {written}, n_{kind} }};", 0)]
        if model.queue:
            out += ["    " + line for line in wrap(self.queue_type(model.queue), 0)]
        if model.summaries:
            out.append("    static constexpr myriad::summary summaries[] = {")
            out += [f"        {{{r.observed}, myriad::over_phase::{r.kind}, {r.accessory}}}," for r in model.summaries]
            out.append("    };")
        pattern, jacobian = self.jacobian()
        out += ["    " + line for line in pattern]
        if model.mass_matrix is not None:
            mass = f"static constexpr myriad::mass_entry mass_matrix[] = {{{mass_entries(model)}}};"
            out += ["    " + line for line in wrap(mass, 0)]
        blocks = [self.function("rhs", "n_state", model.rhs)] + jacobian
        if model.noise is not None:
            blocks.append(self.function("diffusion", "n_state", model.noise.factors,
                                        row="n_noise" if model.noise.processes else ""))
        if model.events:
            blocks.append(self.function("events", "n_event", [e.function for e in model.events]))
        if model.observed:
            blocks.append(self.function("observe", "n_observed", [q for _, q in model.observed]))
        if model.delays:
            blocks += self.past()
        if model.initialise:
            blocks.append(self.hook("initialise", model.initialise))
        if model.after_step:
            blocks.append(self.after_step())
        blocks += self.actions()
        if model.finalise:
            blocks.append(self.hook("finalise", model.finalise))
        if model.generate:
            blocks.append(Writer(model, self.names.in_generate()).hook("generate", model.generate))
        for block in blocks:
            out += [""] + ["    " + line if line else line for line in block]
        return "\n".join(out + ["};", ""])

    def description(self) -> list[str]:
        lines = equation_texts(self.model, left_sides(self.model), self.model.rhs)
        return lines if len(lines) <= 8 else lines[:7] + [f"... and {len(lines) - 7} more equations"]

    def declarations(self) -> list[str]:
        model = self.model
        declared = [name for name in ("accessories_are_outputs", "writes_parameters", "writes_time_domain")
                    if getattr(model, name)]
        declared += ["additive_noise"] * (model.noise is not None and model.noise.is_additive)
        # From which the library sees whether a kernel is to have one copy of rhs; in C++ it has to count.
        weight = [f"static constexpr int rhs_weight = {cost(model.rhs)};"]
        return [f"static constexpr bool {name} = true;" for name in declared] + weight

    def jacobian(self) -> tuple[list[str], list[list[str]]]:
        """What stiff methods need of a large model: the pattern of its Jacobian, whether it depends on time, as lines,
        and the derivatives, in a list of one function or none."""
        model = self.model
        entries, values = jacobian_of(model)
        if not entries:
            return [], []
        lines = [f"// {self.matrix(entries)}"]
        if is_autonomous(model):
            lines.append("static constexpr bool autonomous = true;")
        written = ", ".join(f"{{{model.states[row]}, {model.states[column]}}}" for row, column in entries)
        lines += wrap(f"static constexpr myriad::jacobian_entry jacobian_pattern[] = {{{written}}};", 0)
        return lines, [self.function("jacobian", len(entries), values)] if values else []

    def matrix(self, entries: Sequence[tuple[int, int]]) -> str:
        """What stiff methods make of the entries of the Jacobian."""
        n, mass = len(self.model.states), self.model.mass_matrix
        every, diagonal = list(entries), set(range(n))
        if mass is not None:
            every += [(int(i), int(j)) for i, j in zip(*mass.nonzero())]
            diagonal = {i for i, j in every if i == j}
        factors = factor_entries(n, every) if len(diagonal) == n else -1
        made = f"the factors of stiff methods have {factors}" if factors >= 0 else "stiff methods factorise all of it"
        return f"{len(entries)} of {n * n} entries of the Jacobian may differ from zero; {made}"

    # Functions of the state

    def in_function(self, node: Node) -> str:
        names, (kind, name) = self.names, node.value
        if kind == "built-in":
            return names.t if name == "time" else f"{names.R}({names.number})"
        if kind == "delayed":
            return f"{names.p}.delayed[{self.delayed[node]}]"
        prefix = {"state": names.y, "parameter": names.p}.get(kind, f"{names.p}.{kind}")
        return f"{prefix}[{name}]"

    def function(self, name: str, count: int | str, roots: Sequence[Node], further: Sequence[str] = (),
                 row: str = "") -> list[str]:
        """A function of time, state and parameters, and of `further` arguments. With `row` it returns a matrix whose
        rows have that length, and whose entries are given row after row."""
        n = self.names
        body = Body(roots, n, self.in_function, scalar=False)
        values = [self.real_text(body, root) for root in roots]
        kind = n.R
        if row:
            kind, length = f"myriad::vec<{n.R}, {row}>", len(values) // len(self.model.states)
            values = [f"{kind}{{{', '.join(values[i:i + length])}}}" for i in range(0, len(values), length)]
        kinds = _kinds_in(roots)
        arguments = [f"auto {n.t}" if "built-in" in kinds else "auto",
                     f"const myriad::vec<{n.R}, n_state>&" + (f" {n.y}" if "state" in kinds else ""),
                     "const auto&" + (f" {n.p}" if kinds - {"built-in", "state"} else ""), *further]
        lines = [f"template <class {n.R}>"]
        lines += wrap(f"MYRIAD_FUNCTION static myriad::vec<{kind}, {count}> {name}({', '.join(arguments)}) {{", 0)
        for statement in body.lines:
            lines += wrap(statement, 4)
        result = ", ".join(values)
        if len(values) == 1:
            lines += wrap(f"return myriad::vec<{kind}, {count}>{{{result}}};", 4)
        elif len(result) + 18 <= columns:
            lines.append(f"    return {{{result}}};")
        else:
            lines.append("    return {")
            for value in values:
                lines += wrap(value + ",", 8)
            lines[-1] = lines[-1].rstrip(",") + "};"
        return lines + ["}"]

    def real_text(self, body: Body, root: Node) -> str:
        """The text of an expression, of the type of the state."""
        value, R = body.text(root), self.names.R
        return value if _depends_on_instance(root) or value.startswith(R + "(") else f"{R}({value})"

    def other_units(self, nodes: Iterable[Node]) -> list[str]:
        """Statements before those of some expressions, with the numbers of the other units that are named."""
        return []

    # The past

    def past(self) -> list[list[str]]:
        """What a model has for its delayed values: their states, their lags, and what was before the begin."""
        delays, history = self.model.delays, self.model.history
        given = [(one.name, history[state]) for one in delays if (state := one.symbol.value[1].state) in history]
        return self.past_of(delays, given, "", "p" if all(one.is_constant for one in delays) else "typ")

    def past_of(self, delays: Sequence[Delay], given: Sequence[tuple[str, Node]], before: str,
                of_lag: str) -> list[list[str]]:
        """The same of some delayed values, with the histories that are `given` by name. `before` and `of_lag` say what
        functions have for arguments: `before` in front of the number, as in `of_past`."""
        n = self.names
        which = f"int {n.number}" if len({one.state for one in delays}) > 1 else "int"
        blocks = [["/// The state that a delayed value is of.",
                   f"MYRIAD_FUNCTION static int delayed_state({which}) {{",
                   *("    " + line for line in self.by_delay([(one.name, [f"return {one.state};"]) for one in delays])),
                   "}"]]
        slopes = [one.name for one in delays if one.is_slope]
        if slopes:
            every = len(slopes) == len(delays)
            those = "true" if every else " || ".join(f"{n.number} == {name}" for name in slopes)
            blocks.append(["/// Whether it is the slope that the state had.",
                           f"MYRIAD_FUNCTION static bool is_delayed_slope(int{'' if every else ' ' + n.number}) {{",
                           *wrap(f"return {those};", 4), "}"])
        first = first_of_lag(delays)
        if len({*first}) < len(delays):
            blocks.append(self.same_lag({one.name: delays[j].name for one, j in zip(delays, first)}))
        blocks.append(self.of_past("/// How long ago it was.", "lag", [(one.name, one.lag) for one in delays], of_lag))
        if given:
            blocks.append(self.of_past("/// Its value before the begin.", "history", given, before + "tp"))
        if 0 < len(given) < len(delays):
            named = wrap(f"return {' || '.join(f'{n.number} == {name}' for name, _ in given)};", 4)
            blocks.append(["/// Others had their initial value.",
                           f"MYRIAD_FUNCTION static bool has_history(int {n.number}) {{", *named, "}"])
        return blocks

    def same_lag(self, first: Mapping[str, str]) -> list[str]:
        """The function that gives the first delayed value with the lag of each, from their names."""
        n, lines = self.names, []
        others = {one: [name for name, its in first.items() if its == one != name] for one in first.values()}
        for one, several in others.items():
            if several:
                lines.append(f"if ({' || '.join(f'{n.number} == {name}' for name in several)}) return {one};")
        every = len(others) == 1
        lines = [f"return {next(iter(others))};"] if every else [*lines, f"return {n.number};"]
        return ["/// The first delayed value that is as long ago.",
                f"MYRIAD_FUNCTION static int same_lag(int{'' if every else ' ' + n.number}) {{",
                *(wrapped for line in lines for wrapped in wrap(line, 4)), "}"]

    def by_delay(self, cases: Sequence[tuple[str, list[str]]]) -> list[str]:
        """Statements of several delayed values, the last for all others; those that are equal once."""
        lines: list[str] = []
        last = cases[-1][1]
        for name, statements in cases[:-1]:
            if statements == last:
                continue
            start = f"if ({self.names.number} == {name}) "
            several = [start + "{", *("    " + line for line in statements), "}"]
            lines += [start + statements[0]] if len(statements) == 1 else several
        return [*lines, *last]

    def of_past(self, what: str, name: str, values: Sequence[tuple[str, Node]], wanted: str) -> list[str]:
        """A function of the number of a delayed value and of some of the time t, the state y and the inputs p; of the
        unit u too, which comes first."""
        n, cases = self.names, []
        for delayed, value in values:
            body = Body([value], n, self.in_function, scalar=False)
            cases.append((delayed, [*self.other_units([value]), *body.lines, f"return {self.real_text(body, value)};"]))
        lines, kinds = self.by_delay(cases), _kinds_in([value for _, value in values])
        is_read = any(re.search(rf"\b{n.number}\b", line) for line in lines)
        known = {"t": f"const {n.R}&" + (f" {n.t}" if "built-in" in kinds else ""),
                 "y": f"const myriad::vec<{n.R}, n_state>&" + (f" {n.y}" if "state" in kinds else ""),
                 "p": "const auto&" + (f" {n.p}" if kinds - {"built-in", "state"} else "")}
        arguments = ", ".join(["[[maybe_unused]] int unit"] * ("u" in wanted) +
                              [f"int {n.number}" if is_read else "int"] + [known[one] for one in wanted if one != "u"])
        return [what, f"template <class {n.R}>",
                *wrap(f"MYRIAD_FUNCTION static {n.R} {name}({arguments}) {{", 0),
                *(wrapped for line in lines for wrapped in wrap(line, 4)), "}"]

    def stop_time(self) -> list[str]:
        """The function with the times of all stops, of which each has a number."""
        n, stops = self.names, self.model.stops
        body = Body([value for s in stops for value in s.values], n, self.in_function, scalar=True)
        lines = []
        for i, one in enumerate(stops):
            if one.every is not None:
                first, every, count = (f"{n.R}({body.text(value)})" for value in one.values)
                value = f"myriad::recurring({n.number}, {first}, {every}, {count})"
            elif one.by_number:
                value = f"{n.R}({body.text(one.times[0])})"
            else:
                value = f"{n.R}(myriad::infinity_of<myriad::real_of<{n.R}>>)"
                for number, time in reversed(list(enumerate(one.times))):
                    value = f"{n.number} == {number} ? {n.R}({body.text(time)}) : {value}"
            is_last = i + 1 == len(stops) and not self.model.queue
            lines.append(("" if is_last else f"if (stop == {one.name}) ") + f"return {value};")
        if self.model.queue:
            lines.append(f"return queue::next_time({n.p});")
        used = [node for s in stops for node in walk(s.values) if node.op in ("symbol", "element", "lookup",
                                                                              "find_interval", "dot")]
        which = "int stop" if len(stops) + bool(self.model.queue) > 1 else "int"
        number = f"int {n.number}" if stops else "int"
        arguments = f"{which}, {number}, const auto&" + (f" {n.p}" if used or self.model.queue else "")
        return [f"template <class {n.R}>", f"MYRIAD_FUNCTION static {n.R} stop_time({arguments}) {{",
                *(wrapped for line in body.lines + lines for wrapped in wrap(line, 4)), "}"]

    # Hooks

    def in_hook(self, node: Node) -> str:
        lane, (kind, name) = self.names.lane, node.value
        if kind == "built-in":
            return f"{self.names.R}({self.names.number})" if name == "stop_number" else f"{lane}.{_headers[name]}"
        if kind == "delayed":
            return f"{lane}.delayed[{self.delayed[node]}]"
        if kind == "waiting":
            return f"{self.names.taken_action}.value[{name}]"
        member = {"state": "y"}.get(kind, kind)
        return f"{lane}.{member}[{name}]"

    def statements(self, assignments: Assignments, scalar: bool) -> tuple[list[str], dict[str, str]]:
        """The lines of assignments that take effect together, none seeing what another one has assigned, and the
        conditions that end a phase or an instance."""
        targets = [(t, e) for t, e in assignments if t.value[0] != "action"]
        ends = {t.value[1]: e for t, e in assignments if t.value[0] == "action"}
        plans = [update(target, value, scalar) for target, value in targets]
        roots = [e for only_if, _, value in plans for e in (only_if, value) if e is not None]
        body = Body(roots + list(ends.values()), self.names, self.in_hook, scalar)
        # What later assignments compute from components that are assigned before.
        early: dict[int, str] = {}
        assigned: set[int] = set()
        for target, value in targets:
            if body.reads(value) & assigned:
                early[id(target)] = body.early(value, "next_" + self.title(target))
            assigned.add(id(target))
        conditions = {action: body.early(value, "ends") if body.reads(value) & assigned else body.text(value)
                      for action, value in ends.items()}
        for (target, _), (only_if, operator, value) in zip(targets, plans):
            if id(target) in early:
                only_if, operator, written = None, "=", early[id(target)]
            else:
                written = body.text(value)
            if target.type == real and value.type == integer and value.op != "constant":
                written = f"{self.names.R}({written})"
            if target.type == integer and (value.type == real or value.op == "symbol" and
                                           value.value == ("built-in", "instance")):
                written = f"static_cast<std::int32_t>({written})"
            statement = f"{self.in_hook(target)} {operator} {written};"
            body.lines.append(statement if only_if is None else f"if ({body.text(only_if)}) {statement}")
        return body.lines, conditions

    def title(self, target: Node) -> str:
        """The name of a component."""
        return str(target.value[1])

    def block(self, lines: list[str]) -> list[str]:
        """Lines of a scalar hook, with the name of its real type if they need it."""
        n = self.names
        if any(re.search(rf"\b{n.R}\b", line) for line in lines):
            lines = [f"using {n.R} = {n.real_of_lane};"] + lines
        return [wrapped for line in lines for wrapped in wrap(line, 4)]

    def hook(self, name: str, assignments: Assignments) -> list[str]:
        lines, _ = self.statements(assignments, scalar=True)
        return [f"MYRIAD_FUNCTION static void {name}(auto& {self.names.lane}) {{", *self.block(lines), "}"]

    def after_step(self) -> list[str]:
        n, assignments = self.names, self.model.after_step
        values = [e for _, e in assignments]
        ends = {t.value[1] for t, _ in assignments if t.value[0] == "action"}
        mixed = any(t.type == real and e.type == integer and e.op != "constant" for t, e in assignments)
        if generic_problem(values) is not None or "end_instance" in ends or mixed:
            lines, conditions = self.statements(assignments, scalar=True)
            result = "myriad::action" if ends else "void"
            lines += returned(conditions) if ends else []
            return [f"MYRIAD_FUNCTION static {result} after_step(auto& {n.lane}) {{", *self.block(lines), "}"]
        lines, conditions = self.statements(assignments, scalar=False)
        result = f"myriad::mask_of<{n.R}>" if ends else "void"
        if ends:
            lines.append(f"return {conditions['end_phase']};")
        return [f"template <class {n.R}>", f"MYRIAD_FUNCTION static {result} after_step(auto& {n.lane}) {{",
                *(wrapped for line in lines for wrapped in wrap(line, 4)), "}"]

    # Actions: of events, stops and triggers

    def actions(self) -> list[list[str]]:
        """The functions of events, stops and triggers that a model has."""
        model = self.model
        at_stops = self.acting(model.stops)
        if model.queue:
            at_stops.append((model.queue.stop, self.due(model.queue.seed)))
        blocks = []
        if model.triggers:
            blocks += [self.condition(), *self.flags(), self.action(
                "trigger", [(e.name, self.triggered(e)) for e in model.edges], len(model.edges))]
        if model.stop_names:
            blocks.append(self.stop_time())
        at_events = self.acting(model.events)
        return [*([self.action("event", at_events, len(model.events))] if at_events else []), *blocks,
                *([self.action("stop", at_stops, len(model.stop_names), f", {self.number_of(at_stops)}")]
                  if at_stops else [])]

    def number_of(self, acting: Sequence[tuple[str, list[str]]]) -> str:
        """The argument for the number of a stop's time, which only actions from a table read."""
        number = self.names.number
        reads = any(re.search(rf"\b{number}\b", line) for _, lines in acting for line in lines)
        return f"int {number}" if reads else "int"

    def done(self, assignments: Assignments) -> list[str]:
        """The statements of an action."""
        lines, conditions = self.statements(assignments, scalar=True)
        return lines + (returned(conditions) if conditions else [])

    def acting(self, which: Sequence[Event] | Sequence[Stop]) -> list[tuple[str, list[str]]]:
        """The names and statements of those that have actions."""
        return [(str(e.name), self.done(e.do)) for e in which if e.do]

    def action(self, what: str, acting: list[tuple[str, list[str]]], among: int, further: str = "") -> list[str]:
        """The hook after an event, a stop or a trigger, from the names and statements of those that act `among` all."""
        n = self.names
        lines = branches(what, acting, among)
        ends = any("return" in line for line in lines)
        if ends and not (among == 1 and lines[-1].startswith("return")):
            lines.append("return myriad::action::proceed;")
        number = f"int {what}" if among > 1 else "int"
        result = "myriad::action" if ends else "void"
        return [f"MYRIAD_FUNCTION static {result} after_{what}({number}{further}, auto& {n.lane}) {{",
                *self.block(lines), "}"]

    def queue_type(self, queue: Queue) -> str:
        """The queue of the actions that wait."""
        room = f"{queue.capacity}" + (f", {queue.values}" if queue.values else "")
        return f"using queue = myriad::action_queue<{queue.accessories[0]}, {queue.integers[0]}, {room}>;"

    def condition(self) -> list[str]:
        """The function with the conditions of all triggers."""
        n, edges = self.names, self.model.edges
        body = Body([e.condition for e in edges], n, lambda node: f"{n.positive}[{node.value[1]}]", scalar=True)
        lines = [f"if (trigger == {e.name}) return {body.text(e.condition)};" for e in edges[:-1]]
        lines.append(f"return {body.text(edges[-1].condition)};")
        which = "int trigger" if len(edges) > 1 else "int"
        return [f"MYRIAD_FUNCTION static bool condition({which}, const auto& {n.positive}) {{",
                *self.block(body.lines + lines), "}"]

    def flags(self) -> list[list[str]]:
        """The functions that say what triggers have; without them all have it."""
        blocks = []
        for what in ("initial_value", "persistent"):
            without = [f"trigger != {e.name}" for e in self.model.edges if not getattr(e, what)]
            if without:
                returned = wrap(f"return {' && '.join(without)};", 4)
                blocks.append([f"MYRIAD_FUNCTION static bool {what}(int trigger) {{", *returned, "}"])
        return blocks

    def triggered(self, edge: Edge) -> list[str]:
        """What happens where a condition comes to hold: an action runs, or is put into the queue or dropped there."""
        n, one, queue = self.names, edge.starts, self.model.queue
        if one is None:
            return [f"queue::cancel({n.lane}, {edge.drops});"]
        if queue is None:
            return self.done(one.do)
        delay = [] if one.delay is None else [one.delay]
        body = Body([*delay, *one.values], n, self.in_hook, scalar=True)
        kept = f"std::remove_cvref_t<decltype({n.lane}.accessory[0])>"  # which has derivatives where values have
        values = [f"{kept}({body.text(v)})" for v in one.values] + [f"{kept}({n.R}(0))"] * (
            queue.values - len(one.values))
        arguments = [n.lane, str(self.model.triggers.index(one)), f"{n.lane}.t"]
        arguments[2:] = [f"{arguments[2]} + {body.text(one.delay)}"] if delay else arguments[2:]
        arguments += [f"{{{', '.join(values)}}}"] if values else []
        return [*body.lines, f"const bool fits = queue::put({', '.join(arguments)});",
                "return fits ? myriad::action::proceed : myriad::action::overflow;"]

    def due(self, seed: int) -> list[str]:
        """What happens at the time of an action that has waited."""
        n, triggers = self.names, self.model.triggers
        lines, priority = [], ""
        if len(triggers) > 1 and any(t.priority is not None for t in triggers):
            body = Body([t.priority for t in triggers if t.priority is not None], n, self.in_hook, scalar=True)
            values = [f"-myriad::infinity_of<{n.R}>" if t.priority is None else f"{n.R}({body.text(t.priority)})"
                      for t in triggers]
            name = body._name("priority")
            lines = [*body.lines, f"const {n.R} {name}[] = {{{', '.join(values)}}};"]
            priority = f", [&](int action) MYRIAD_LAMBDA {{ return {name}[action]; }}"
        elif seed >= 0:
            priority = ", [](int) MYRIAD_LAMBDA { return 0; }"
        taken = n.taken_action
        acting = [(str(number), self.done(t.do)) for number, t in enumerate(triggers) if t.do]
        priority += f", {seed}" if seed >= 0 else ""
        return [*lines, f"const auto {taken} = queue::take({n.lane}{priority});",
                *branches(f"{taken}.action", acting, len(triggers))]
