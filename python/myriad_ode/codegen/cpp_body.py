# SPDX-License-Identifier: MIT
"""The statements of C++ that compute expressions, and the names in them."""

from __future__ import annotations

import copy
import itertools
import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import TYPE_CHECKING

from ..models.units import CouplingTable
from ..symbolic.functions import draws
from ..symbolic.node import condition, infix, integer, number_text, real, walk, write
from ..symbolic.operations import known_of
from ..symbolic.table import unrolled
from ..symbolic.whole_and_real import converts, is_long, is_plain

if TYPE_CHECKING:
    from ..models.recorded import RecordedModel
    from ..symbolic.node import Node

columns = 116  # inside the struct
_deepest = 50  # operations within each other in one statement: compilers limit the depth of parentheses
_largest_literal = 1 << 24  # exact in single precision

_of_whole_numbers = {"add": "wrapping_add", "subtract": "wrapping_subtract", "multiply": "wrapping_multiply",
                     "quotient": "floor_divide", "remainder": "floor_mod"}

# Of several of these with equal arguments, the arguments are used once.
_shared_work = ("sincos.sine", "sincos.cosine", "sincospi.sine", "sincospi.cosine", "dot")


def _is_natural(node: Node) -> bool:
    """Whether a whole number cannot be negative, as numbers of instances, phases and detections."""
    return all(n.value >= 0 if n.op == "constant" else
               n.value[0] in ("built-in", "event_count") if n.op == "symbol" else
               n.op in ("quotient", "remainder", "min", "max") for n in walk([node]))


class Names:
    """The names that a model's functions use for their arguments: the usual ones unless a component has that name, or
    it is among `others`."""

    def __init__(self, model: RecordedModel, others: Iterable[str] = ()) -> None:
        self.taken = {*model.component_names, *others, "i", "j", "r"}
        self.y = self._free("y", "s", "u", "state_")
        self.p = self._free("p", "in", "inputs")
        self.t = self._free("t", "time", "t_")
        self.R = self._free("R", "S", "Real", "R_")
        self.lane = self._free("lane", "instance", "lane_")
        self.number = self._free("number", "k_", "number_")
        self.positive = self._free("positive", "is_positive", "positive_")
        self.taken_action = self._free("taken", "action_due", "taken_")
        self.of_lane = f"std::remove_cvref_t<decltype({self.lane}.t)>"  # the type of its numbers
        self.real_of_lane = f"myriad::real_of<{self.of_lane}>"

    def in_generate(self) -> Names:
        """The names in `generate`, whose argument is no lane but an instance of a study."""
        names = copy.copy(self)
        names.lane = self._free("instance", "one", "instance_")
        names.of_lane = names.real_of_lane = f"typename std::remove_cvref_t<decltype({names.lane})>::real"
        return names

    def _free(self, *candidates: str) -> str:
        numbered = (f"{candidates[0]}_{i}" for i in itertools.count(1))
        return next(c for c in itertools.chain(candidates, numbered) if c not in self.taken)


class Body:
    """The statements that compute some expressions, shared subexpressions first, and the text of each expression."""

    def __init__(self, roots: Sequence[Node], names: Names, symbol: Callable[[Node], str], scalar: bool) -> None:
        self.names, self.symbol, self.scalar = names, symbol, scalar
        self.shared = f"{names.lane if symbol.__name__ == 'in_hook' else names.p}.shared"
        self.lines: list[str] = []
        self.named: dict[int, str] = {}
        self.numbers: dict[str, int] = {}
        self.used_names = names.taken | {names.y, names.p, names.t, names.R, names.lane, names.number, "event", "stop"}
        uses: dict[int, int] = {}
        order = walk(roots)
        computed = {(node.op.partition(".")[0], node.op == "dot" and node.value[0], *map(id, node.args))
                    if node.op in _shared_work else node: node for node in order}
        for node in computed.values():
            for argument in node.args:
                uses[id(argument)] = uses.get(id(argument), 0) + 1
        for root in roots:
            uses[id(root)] = uses.get(id(root), 0) + 1
        # C++ evaluates operands in any order: draws within expressions are statements of their own, in one order
        drawn = [node for node in order if node.op in draws]
        in_order = all(uses[id(node)] == 1 and any(node is root for root in roots) for node in drawn)
        depth: dict[int, int] = {}
        for node in order:
            if id(node) in self.named:
                continue
            if node.op.startswith("sincos"):
                self._sine_and_cosine(node, order)
                continue
            if node.op == "dot":
                self._product(node, order)
                continue
            depth[id(node)] = 1 + max((depth.get(id(a), 0) for a in node.args), default=0)
            shared = uses[id(node)] > 1 and not (node.op == "negate" and not node.args[0].args)
            early = node.op in draws and not in_order
            if node.args and (shared or early or depth[id(node)] > _deepest):
                name = self._name(known_of(node.op).result or ("holds" if node.type == condition else node.op))
                self.lines.append(f"const auto {name} = {self.text(node)};")
                self.named[id(node)] = name
                depth[id(node)] = 0

    def _name(self, base: str) -> str:
        """A name that nothing else has: `base`, or with a number."""
        name = base
        while name in self.used_names:
            self.numbers[base] = self.numbers.get(base, 1) + 1
            name = f"{base}_{self.numbers[base]}"
        self.used_names.add(name)
        return name

    def _sine_and_cosine(self, node: Node, order: Iterable[Node]) -> None:
        function = node.op.partition(".")[0]
        sine, cosine = self._name("sine"), self._name("cosine")
        argument = self.text(node.args[0])
        if not node.args[0].args:
            argument = f"{self.names.R}({argument})" if node.args[0].op == "constant" else argument
        self.lines.append(f"const auto [{sine}, {cosine}] = myriad::{function}({argument});")
        for other in order:
            if other.args and other.args[0] is node.args[0] and other.op.startswith(function + "."):
                self.named[id(other)] = sine if other.op.endswith(".sine") else cosine

    def reads(self, node: Node) -> set[int]:
        """The symbols that the text of an expression names, by id."""
        found, stack = set(), [node]
        while stack:
            node = stack.pop()
            if id(node) not in self.named:
                stack.extend(node.args)
                if node.op == "symbol":
                    found.add(id(node))
        return found

    def _product(self, node: Node, order: Iterable[Node]) -> None:
        """Products of rows of a table with one vector, in a loop over all rows that are used, or term by term."""
        table, row = node.value
        n, kind = len(node.args), self.names.of_lane if self.scalar else self.names.R
        of_units = isinstance(table, CouplingTable)
        if of_units and (table.bandwidth is not None or n <= unrolled):
            self.named[id(node)] = self._name("coupled")
            self.lines.append(f"const auto {self.named[id(node)]} = {self.text(table.sum(row, node.args))};")
            return

        def summed(one: Node) -> list[Node]:
            return table.by_column(one.value[1], one.args) if of_units else list(one.args)

        same = [other for other in order if other.op == "dot" and other.value[0] == table and
                all(a is b for a, b in zip(summed(other), summed(node)))]
        first, last = min(o.value[1] for o in same), max(o.value[1] for o in same)
        vector, product, total = self._name("vector"), self._name("product"), self._name("total")
        self.lines.append(f"const myriad::vec<{kind}, {n}> {vector} = {{{', '.join(map(self.text, summed(node)))}}};")
        self.lines.append(f"myriad::vec<{kind}, {last - first + 1}> {product};")
        row_number, rows = f"({first} + i)" if first else "i", f"for (int i = 0; i < {last - first + 1}; ++i)"
        entry = f"{self.shared}[{table.name}"
        if of_units and table.form == "full":  # four rows at once, whose additions need not wait for each other
            first, number, each = 0, self._name("row"), "for (int r = 0; r < 4; ++r)"
            self.lines[-1] = f"myriad::vec<{kind}, {n}> {product};"
            self.lines += [f"for (int i = 0; i < {n}; i += 4) {{",
                           f"    const int {number} = i < {n - 4} ? i : {n - 4};",
                           f"    myriad::vec<{kind}, 4> {total};",
                           f"    {each} {total}[r] = {entry} + {number} + r] * {vector}[0];",
                           f"    for (int j = 1; j < {n}; ++j)",
                           f"        {each} {total}[r] += {entry} + j * {n} + {number} + r] * {vector}[j];",
                           f"    {each} {product}[{number} + r] = {total}[r];", "}"]
        else:
            begin, start, at = (entry, row_number, f"({row_number} + j) % {n}") if of_units else (
                f"{entry} + {row_number} * {n}", "0", "j")
            self.lines += [f"{rows} {{", f"    {kind} {total} = {begin}] * {vector}[{start}];",
                           f"    for (int j = 1; j < {n}; ++j) {total} += {begin} + j] * {vector}[{at}];",
                           f"    {product}[i] = {total};", "}"]
        for other in same:
            self.named[id(other)] = f"{product}[{other.value[1] - first}]"

    def early(self, node: Node, name: str) -> str:
        """The name of a variable with the value that the expression has here."""
        if id(node) in self.named or not node.args and node.op != "symbol":
            return self.text(node)
        name = self._name(name)
        self.lines.append(f"const auto {name} = {self.text(node)};")
        return name

    def text(self, node: Node) -> str:
        return write(node, self._leaf, self._call, self._convert, self._operator)

    @staticmethod
    def _operator(node: Node) -> tuple[str, int] | None:
        """C++'s operators. Those of whole numbers would be undefined at the ends of their range, and round quotients
        towards zero."""
        if node.type == integer and not (node.op in ("quotient", "remainder") and node.args[1].op == "constant" and
                                         node.args[1].value > 0 and _is_natural(node.args[0])):
            return None
        return infix.get(node.op)

    def _convert(self, node: Node, argument: Node) -> str | None:
        """The conversion of an argument, as the text before its parenthesis."""
        if not converts(node, argument):
            return None
        R = self.names.R
        return R if self.scalar else f"static_cast<myriad::real_of<{R}>>"

    def _leaf(self, node: Node) -> str | None:
        if id(node) in self.named:
            return self.named[id(node)]
        if node.op == "symbol":
            return self.symbol(node)
        if node.op == "element":
            table, number = node.value
            return f"{self.shared}[{table.name}{f' + {number}' if number else ''}]"
        if node.op == "truth":
            return "true" if node.value else "false"
        if node.op == "constant":
            if node.value == -2**31 and node.type == integer:
                return "(-2147483647 - 1)"  # C++'s -2147483648 has 64 bits
            return str(node.value) if node.type == integer else self._number(node.value)
        return None

    def _number(self, value: float) -> str:
        if value in (float("inf"), float("-inf")):
            infinity = f"myriad::infinity_of<myriad::real_of<{self.names.R}>>"
            return infinity if value > 0 else "-" + infinity
        if float(value).is_integer() and -_largest_literal <= value <= _largest_literal and not (
                value == 0 and str(value).startswith("-")):
            return str(int(value))
        return f"{self.names.R}({number_text(float(value))})"

    def _call(self, node: Node, arguments: list[str]) -> str:
        function = _of_whole_numbers.get(node.op, node.op) if node.type == integer else node.op
        if function in ("lookup", "find_interval"):
            table, first, *numbers = node.value
            return f"myriad::{function}(&{self.shared}[{table.name} + {first}], {', '.join(map(str, numbers))}, " \
                   f"{arguments[0]})"
        if function in draws:
            return f"{self.names.lane}.random.{function}({', '.join(arguments)})"
        values = list(arguments)
        numbers = node.args[1:] if function == "select" else node.args
        first = len(node.args) - len(numbers)
        if node.type != integer and (all(a.op == "constant" for a in numbers) or function in ("pow", "powr", "fma")):
            values[first:] = [f"{self.names.R}({v})" if a.op == "constant" and "(" not in v else v
                              for a, v in zip(numbers, values[first:])]
        elif node.type == integer and function in ("min", "max") and any(map(is_long, numbers)):
            values = [v if is_long(a) else f"std::int64_t({v})" for a, v in zip(numbers, values)]
        elif node.type == integer and not self.scalar and function == "select" and all(map(is_plain, numbers)):
            values[first] = f"myriad::integer_of<{self.names.R}>({values[first]})"
        return f"myriad::{function}({', '.join(values)})"


def wrap(line: str, indent: int) -> list[str]:
    """A statement in lines of at most 120 columns, broken after commas and operators, but not within a type."""
    indent += len(line) - len(line := line.lstrip())
    first, rest = " " * indent, " " * (indent + 4)
    if len(first) + len(line) <= columns:
        return [first + line]
    words: list[str] = []
    for word in line.split(" "):
        if words and (word in ("+", "-", "*", "/", "%", "&&", "||", "<", "<=", ">", ">=", "==", "!=", "=") or
                      re.search(r"\bconst$|\bvec<[^>]*$", words[-1])):
            words[-1] += " " + word
        else:
            words.append(word)
    lines, current = [], first + words[0]
    for word in words[1:]:
        if len(current) + 1 + len(word) > columns:
            lines.append(current)
            current = rest + word
        else:
            current += " " + word
    return lines + [current]


def update(target: Node, value: Node, scalar: bool) -> tuple[Node | None, str, Node]:
    """An assignment as (condition or None, operator, value): `if` where it keeps the old value, += where it adds to
    it."""
    only_if = None
    if scalar and value.op == "select":
        chosen, a, b = value.args
        if b is target:
            only_if, value = chosen, a
        elif a is target:
            only_if, value = ~chosen, b
    for op, operator in (("add", "+="), ("subtract", "-="), ("multiply", "*=")):
        if value.op == op and value.args[0] is target and target.type == real:
            return only_if, operator, value.args[1]
    return only_if, "=", value


def returned(conditions: Mapping[str, str]) -> list[str]:
    """The statements that return an action."""
    lines = []
    if "end_instance" in conditions:
        if conditions["end_instance"] == "true":
            return ["return myriad::action::end_instance;"]
        lines.append(f"if ({conditions['end_instance']}) return myriad::action::end_instance;")
    phase = conditions.get("end_phase", "false")
    simple = {"true": "myriad::action::end_phase", "false": "myriad::action::proceed"}
    either = f"{phase} ? myriad::action::end_phase : myriad::action::proceed"
    return lines + [f"return {simple.get(phase, either)};"]


def branches(what: str, acting: list[tuple[str, list[str]]], among: int) -> list[str]:
    """Statements, of which those of the name that `what` is equal to run."""
    if among == 1:
        return [line for _, statements in acting for line in statements]
    lines: list[str] = []
    for i, (name, statements) in enumerate(acting):
        start = "" if i == among - 1 else f"if ({what} == {name}) "
        lines += [f"}} else {start}{{" if i else start + "{", *("    " + s for s in statements)]
    return [*lines, "}"] if lines else []
