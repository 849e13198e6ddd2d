# SPDX-License-Identifier: MIT
"""The functions of a recorded model in C++: of time, state and parameters, of the past, and of the times of stops."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING

from ..models.delays import Delay, first_of_lag
from ..symbolic.node import walk
from .cpp_body import Body, Names, columns, wrap

if TYPE_CHECKING:
    from ..models.recorded import RecordedModel
    from ..symbolic.node import Node


def _depends_on_instance(node: Node) -> bool:
    """Whether a value differs between instances, so that it has the type of the state and not of a shared value."""
    return any(n.op == "symbol" and n.value[0] not in ("shared", "shared_integer") for n in walk([node]))


def _kinds_in(roots: Sequence[Node]) -> set[str]:
    """The kinds of components that some expressions read."""
    used = [node for node in walk(roots) if node.op in ("symbol", "element", "dot", "lookup", "find_interval")]
    return {node.value[0] if node.op == "symbol" else "shared" for node in used}


class FunctionWriter:
    """Writes the functions of one model."""

    def __init__(self, model: RecordedModel, names: Names | None = None) -> None:
        self.model = model
        self.names = names or Names(model)
        self.delayed = {one.symbol: one.name for one in model.delays}

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
