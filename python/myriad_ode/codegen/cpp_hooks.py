# SPDX-License-Identifier: MIT
"""The hooks of a recorded model in C++, and the actions of its events, stops and triggers."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import TYPE_CHECKING

from ..symbolic.node import integer, real
from ..symbolic.whole_and_real import generic_problem
from .cpp_body import Body, branches, returned, update, wrap
from .cpp_functions import FunctionWriter

if TYPE_CHECKING:
    from ..models.event import Event, Stop
    from ..models.trigger import Edge, Queue
    from ..symbolic.node import Node
    from ..symbolic.types import Assignments


_headers = {"time": "t", "step": "h", "next_step": "h_next", "phase": "phase", "instance": "index",
            "t_begin": "t_begin", "t_end": "t_end"}


class HookWriter(FunctionWriter):
    """Writes the hooks of one model too."""

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
