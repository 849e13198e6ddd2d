# SPDX-License-Identifier: MIT
"""Interpreted models: the operations of a traced model as a tape, which the core runs where there is no compiler."""

from __future__ import annotations

import collections
import functools
from collections.abc import Callable, Iterable, Sequence
from typing import TYPE_CHECKING

from .. import _core
from ..base import component_kinds as kinds
from ..base.errors import CannotInterpret, Error
from ..models.recorded import RecordedModel
from ..symbolic import symbols as sym
from ..symbolic.expression import constant
from ..symbolic.node import integer, walk
from ..symbolic.whole_and_real import is_long

if TYPE_CHECKING:
    from ..models.components import Components
    from ..models.trigger import Edge
    from ..symbolic.node import Node
    from ..symbolic.types import Assignments

methods = tuple(_core.interpreted_methods())
_codes = {name: number for number, name in enumerate(_core.tape_operations())}
_limits: dict[str, int] = _core.tape_limits  # the most events, stops and triggers


def _refuse(why: str) -> Error:
    return CannotInterpret(f"the model cannot be interpreted, as {why}: install a C++ compiler (g++ 12 or clang++ 14 "
                           "or newer), or `pip install ziglang`")


_of_whole_numbers = {"add": "wrapping_add", "subtract": "wrapping_subtract", "multiply": "wrapping_multiply",
                     "quotient": "quotient", "remainder": "remainder"}


def _plural(kind: str) -> str:
    return kinds.every[kind].plural.replace("_", " ") if kind in kinds.every else f"{kind}s"


def lengths_of(components: Components) -> list[int]:
    """How many components of each kind a tape has. Raises `Error` if there are too many for the interpreter."""
    counts = components.counts
    for kind, most in _limits.items():
        if counts[kind] > most:
            raise _refuse(f"it has {counts[kind]} {_plural(kind)}, and the interpreter {most} at the most")
    every = ("state", "parameter", "accessory", "integer_accessory", "event", "stop", "trigger")
    return [counts[kind] for kind in every]


class Writer:
    """Writes the functions of one model, one after the other."""

    def __init__(self, components: Components) -> None:
        self.place = components.place
        self.events = components.event_names
        self.delayed: dict[Node, int] = {}  #: numbers of delayed values
        self.codes: list[int] = []
        self.values: list[float] = []
        self.registers: list[tuple[int, int, int, int]] = []
        self.functions: list[list[tuple[int, int]]] = [[]]

    def _emit(self, code: str, to: int = 0, a: int = 0, b: int = 0, c: int = 0, value: float = 0.0) -> None:
        if code not in _codes:
            raise _refuse(f"it uses {code}")
        self.codes.append(_codes[code])
        self.values.append(value)
        self.registers.append((to, a, b, c))

    def _symbol(self, node: Node, to: int) -> None:
        kind, name = node.value
        if node is sym.stop_number:  # of an action, for which it is kept as a value that waits is
            self._emit("load_waiting", to, 0)
        elif kind == "built-in":
            self._emit(f"load_{name}", to)
        elif kind == "event_count":
            self._emit("load_event_count", to, self.events.index(name))
        elif kind == "delayed":
            self._emit("load_delayed", to, self.delayed[node])
        elif kind == "side":
            self._emit("load_state", to, self.events.index(name))
        elif kind == "waiting":
            self._emit("load_waiting", to, int(name))
        else:
            self._emit(f"load_{kind}", to, self.place[name][1])

    def _operation(self, node: Node, arguments: Sequence[int], to: int, term: int) -> None:
        """One operation, from the registers of its arguments; a sum of products has one more for a term."""
        if node.op == "symbol":
            self._symbol(node, to)
        elif node.op == "element":
            table, number = node.value
            self._emit("load_shared", to, self.place[table.element_name(number)][1])
        elif node.op == "dot":
            table, row = node.value
            for j, (place, argument) in enumerate(zip(table.places(row), arguments)):
                product = term if j else to
                self._emit("load_shared", product, self.place[table.element_name(place)][1])
                self._emit("multiply", product, product, argument)
                if j:
                    self._emit("add", to, to, product)
        elif node.op in ("lookup", "find_interval"):
            table, first, *numbers = node.value
            stride, rows = numbers if len(numbers) == 2 else (1, *numbers)
            place = self.place[table.element_name(first)][1]
            self._emit(node.op, to, rows, arguments[0], stride, float(place))
        elif node.type == integer and node.op in _of_whole_numbers:
            first, second = arguments
            self._emit(_of_whole_numbers[node.op], to, first, second, int(is_long(node)))
        elif node.op in ("constant", "truth"):
            self._emit("constant", to, value=float(node.value))
        else:
            name = {"sincos.sine": "sin", "sincos.cosine": "cos", "sincospi.sine": "sinpi",
                    "sincospi.cosine": "cospi"}.get(node.op, node.op)
            self._emit(name, to, *arguments)

    def function(self, roots: Sequence[Node], stores: Sequence[tuple[str, int]]) -> None:
        """One function: the values of `roots`, each stored by (code, number) in `stores`. Everything is computed before
        anything is stored."""
        begin = len(self.codes)
        order = walk(roots)
        uses = collections.Counter(id(one) for one in (*(a for node in order for a in node.args), *roots))
        # Results of functions are stored as soon as they are there, as nothing reads them.
        results: dict[int, list[tuple[str, int]]] = collections.defaultdict(list)
        later = []
        for root, store in zip(roots, stores):
            if store[0] == "store_result":
                results[id(root)].append(store)
            else:
                later.append((root, store))
        free: list[int] = []
        most = 0
        register: dict[int, int] = {}
        for node in order:
            arguments = [register[id(a)] for a in node.args]
            for argument in node.args:
                uses[id(argument)] -= 1
            for argument in dict.fromkeys(map(id, node.args)):
                if uses[argument] == 0:
                    free.append(register[argument])
            # products read their arguments after they have stored something
            kept = set(arguments) if node.op == "dot" else ()
            chosen = []
            for _ in range(2 if node.op == "dot" else 1):
                place = next((i for i in range(len(free) - 1, -1, -1) if free[i] not in kept), None)
                if place is None:
                    chosen.append(most)
                    most += 1
                else:
                    chosen.append(free.pop(place))
            if most > _core.tape_registers:
                raise _refuse("one of its functions needs more intermediate values than the interpreter has")
            to = register[id(node)] = chosen[0]
            free += chosen[1:]
            self._operation(node, arguments, to, chosen[-1])
            for code, number in results[id(node)]:
                self._emit(code, to, number)
                uses[id(node)] -= 1
            if uses[id(node)] == 0:
                free.append(to)
        for root, (code, number) in later:
            self._emit(code, register[id(root)], number)
        self.functions[-1].append((begin, len(self.codes)))

    def series(self, several: Iterable[Callable[[], None]]) -> None:
        """Functions of which a model has several."""
        self.functions.append([])
        for write in several:
            write()

    def series_of_values(self, roots: Iterable[Node | None]) -> None:
        """Such functions, each with one result, or empty ones."""
        self.series(functools.partial(self.value, root) for root in roots)

    def value(self, root: Node | None) -> None:
        """A function with one result, or an empty one."""
        self.function([] if root is None else [root], [] if root is None else [("store_result", 0)])

    def triggered(self, edge: Edge, model: RecordedModel) -> None:
        """What happens where the condition of a trigger comes to hold."""
        one = edge.starts
        if one is None:
            self.function([constant(0.0)], [("store_drop", edge.drops)])
        elif model.queue is None:
            self.hook(one.do, f"trigger {one.name}")
        else:
            due = sym.time if one.delay is None else sym.time + one.delay
            self.function([*one.values, due], [*(("store_waiting", v) for v in range(len(one.values))),
                                               ("store_put", model.triggers.index(one))])

    def hook(self, assignments: Assignments, what: str) -> None:
        """A hook, from its assignments [(target, value)]."""
        stores = []
        for target, _ in assignments:
            kind, name = target.value
            if kind == "action":
                if name == "end_instance" and what == "after_step":
                    raise _refuse("after_step ends instances")
                stores.append((f"store_{name}", 0))
            elif kind == "built-in":
                if name != "next_step":
                    raise _refuse(f"{what} assigns {name}")
                stores.append(("store_next_step", 0))
            else:
                stores.append((f"store_{kind}", self.place[name][1]))
        self.function([value for _, value in assignments], stores)
