# SPDX-License-Identifier: MIT
"""Interpreted models: the operations of a traced model as a tape, which the core runs where there is no compiler."""

from __future__ import annotations

import math
import weakref
from collections.abc import Callable, Iterable, Sequence
from typing import TYPE_CHECKING, Any

from . import _core, kinds, symbols as sym
from .compiler import Kernel
from .errors import CannotInterpret, Error
from .expression import constant, fma, integer, is_long, walk, where
from .model import Model

if TYPE_CHECKING:
    from .components import Components
    from .expression import Node
    from .any_model import AnyModel
    from .hints import Assignments
    from .model import Event, Stop
    from .trigger import Edge, Trigger

methods = tuple(_core.interpreted_methods())
_codes = {name: number for number, name in enumerate(_core.tape_operations())}
_sizes = _core.tape_sizes  # of the interpreters, from the smallest: the most components of each kind


def _refuse(why: str) -> Error:
    return CannotInterpret(f"the model cannot be interpreted, as {why}: install a C++ compiler (g++ 12 or clang++ 14 "
                           "or newer), or `pip install ziglang`")


_of_whole_numbers = {"add": "wrapping_add", "subtract": "wrapping_subtract", "multiply": "wrapping_multiply",
                     "quotient": "quotient", "remainder": "remainder"}


def _plural(kind: str) -> str:
    return kinds.every[kind].plural.replace("_", " ") if kind in kinds.every else f"{kind}s"


def _size_for(components: Components) -> str:
    """The smallest interpreter that has all components of a model."""
    for size, limits in _sizes.items():
        if all(components.counts[kind] <= most for kind, most in limits.items()):
            return size
    kind, most = next((k, m) for k, m in limits.items() if components.counts[k] > m)
    raise _refuse(f"it has {components.counts[kind]} {_plural(kind)}, and the interpreter {most} at the most")


class Writer:
    """Writes the functions of one model, one after the other."""

    def __init__(self, components: Components) -> None:
        self.place = components.place
        self.events = components.event_names
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
        if kind == "built-in":
            self._emit(f"load_{name}", to)
        elif kind == "event_count":
            self._emit("load_event_count", to, self.events.index(name))
        elif kind == "side":
            self._emit("load_state", to, self.events.index(name))
        elif kind == "waiting":
            self._emit("load_waiting", to, int(name))
        else:
            self._emit(f"load_{kind}", to, self.place[name][1])

    def function(self, roots: Sequence[Node], stores: Sequence[tuple[str, int]]) -> None:
        """One function: the values of `roots`, each stored by (code, number) in `stores`. Everything is computed before
        anything is stored."""
        begin = len(self.codes)
        order = walk(roots)
        uses: dict[int, int] = {}
        for node in order:
            for argument in node.args:
                uses[id(argument)] = uses.get(id(argument), 0) + 1
        for root in roots:
            uses[id(root)] = uses.get(id(root), 0) + 1
        free = list(range(_core.tape_registers))[::-1]
        register: dict[int, int] = {}
        for node in order:
            arguments = [register[id(a)] for a in node.args]
            for argument in node.args:
                uses[id(argument)] -= 1
            for argument in dict.fromkeys(map(id, node.args)):
                if uses[argument] == 0:
                    free.append(register[argument])
            # products read their arguments after they have stored something
            unread = free if node.op != "dot" else [r for r in free if r not in arguments]
            if len(unread) < (2 if node.op == "dot" else 1):
                raise _refuse("one of its functions needs more intermediate values than the interpreter has")
            to = register[id(node)] = unread[-1]
            term = unread[-2] if node.op == "dot" else to
            free.remove(to)
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
        for root, (code, number) in zip(roots, stores):
            self._emit(code, register[id(root)], number)
        self.functions[-1].append((begin, len(self.codes)))

    def series(self, several: Iterable[Callable[[], None]]) -> None:
        """Functions of which a model has several."""
        self.functions.append([])
        for write in several:
            write()

    def value(self, root: Node | None) -> None:
        """A function with one result, or an empty one."""
        self.function([] if root is None else [root], [] if root is None else [("store_result", 0)])

    def triggered(self, edge: Edge, model: Model) -> None:
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


def library(model: AnyModel, components: Components, method: str) -> _core.Library:
    """The interpreter of the core with the tape of a traced model. Raises `Error` if the model or the method is beyond
    it."""
    if not isinstance(model, Model):
        raise _refuse(model.not_interpreted)
    if method not in methods:
        raise _refuse(f"the interpreter has the methods {', '.join(methods)} alone")
    if model.mass_matrix is not None:
        raise _refuse("it has a mass matrix")
    if model.summaries:
        raise _refuse("it has extrema or integrals over a phase")
    size = _size_for(components)
    if model.queue is not None and model.queue.values > _core.tape_values:
        raise _refuse(f"its actions that wait have {model.queue.values} values, and the interpreter "
                      f"{_core.tape_values} at the most")
    writer = Writer(components)
    results = [("store_result", c) for c in range(max(len(model.rhs), len(model.events)))]
    writer.function(model.rhs, results)
    writer.function([e.function for e in model.events], results)
    writer.hook(model.initialise, "initialise")
    writer.hook(model.after_step, "after_step")
    writer.hook(model.finalise, "finalise")
    writer.hook(model.generate, "generate")
    _write_actions(writer, model)
    actions = [one.do for one in (*model.events, *model.stops, *model.triggers)]
    may_stop = any(t.value[0] == "action" for a in (model.after_step, *actions) for t, _ in a)
    made = _tape(writer, model)
    shared, shared_integers = (len(components.names[kind]) for kind in kinds.shared)
    return _core.Library(method, size, shared, shared_integers, may_stop, made)


def _write_actions(writer: Writer, model: Model) -> None:
    """The functions of events, stops and triggers."""
    stops, triggers, edges = model.stops, model.triggers, model.edges

    def do(one: Event | Stop | Trigger) -> Callable[[], None]:
        return lambda: writer.hook(one.do, repr(one.name))

    def value(root: Node | None) -> Callable[[], None]:
        return lambda: writer.value(root)

    def edge(one: Edge) -> Callable[[], None]:
        return lambda: writer.triggered(one, model)

    writer.series(map(do, model.events))
    writer.series([value(_time_of(one)) for one in stops])
    writer.series(map(do, stops))
    writer.series([value(one.condition) for one in edges])
    writer.series(map(edge, edges))
    writer.series(map(do, triggers))
    writer.series([value(one.priority) for one in triggers])


def _time_of(one: Stop) -> Node:
    """The time of a stop by its number, which stands where the time does."""
    number = sym.time
    if one.every is not None:
        first, every, count = one.values
        return where(number < count, fma(number, every, first), math.inf)
    time: Any = constant(math.inf)
    for i, given in reversed(list(enumerate(one.times))):
        time = where(number == i, given, time)
    return time


def _tape(writer: Writer, model: Model) -> _core.Tape:
    """The tape of the functions of a model."""
    place = writer.place
    queue, edges = model.queue, model.edges
    where_waiting = [0, 0, 0, 0] if queue is None else [
        place[queue.accessories[0]][1], place[queue.integers[0]][1], queue.capacity, queue.values]
    return _core.Tape(writer.functions, writer.codes, writer.values, writer.registers,
                      [i for i, e in enumerate(edges) if not e.initial_value],
                      [i for i, e in enumerate(edges) if not e.persistent], where_waiting,
                      *((-1, -1) if queue is None else (len(model.stops), queue.seed)))


def give_model(library: _core.Library, model: AnyModel, components: Components, method: str) -> None:
    """Gives checks and notes of a GPU's program the functions of a traced model, unless they are beyond the
    interpreter."""
    if not isinstance(model, Model):
        return
    writer = Writer(components)
    try:
        for roots in (model.rhs, [] if model.initialise else [e.function for e in model.events]):
            writer.function(roots, [("store_result", c) for c in range(len(roots))])
    except Error:
        return
    for _ in range(4):  # no hooks
        writer.function([], [])
    for _ in range(7):
        writer.series([])
    mass = [] if model.mass_matrix is None or model.initialise else model.mass_matrix.ravel().tolist()
    library.give_model(_tape(writer, model), method, mass)


_known: weakref.WeakKeyDictionary[Any, Any] = weakref.WeakKeyDictionary()


def kernel(model: AnyModel, components: Components, method: str, why: str) -> Kernel:
    """The interpreter with a model; `why` is told in the report."""
    of_model = _known.setdefault(model, {})
    if method not in of_model:
        of_model[method] = library(model, components, method)
    return Kernel(of_model[method], f"interpreted, {why}", 0.0)


def padded(components: Components) -> dict[str, list[str]]:
    """The names of all components that the interpreter has: those of the model, and empty ones for the others."""
    limits = _sizes[_size_for(components)]
    return {kind: names + [""] * (limits.get(kind, 0) - len(names)) for kind, names in components.names.items()}
