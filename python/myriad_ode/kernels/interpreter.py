# SPDX-License-Identifier: MIT
"""The kernels that run interpreted models."""

from __future__ import annotations

import math
import weakref
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

from .. import _core
from ..base import component_kinds as kinds
from ..base.errors import Error
from ..codegen.jacobian import first_sparse, is_autonomous, jacobian_of, pattern_of
from ..codegen.tape_writer import Writer, _refuse, lengths_of, methods
from ..models.delays import first_of_lag
from ..models.methods import stiff
from ..models.recorded import RecordedModel
from ..models.sensitivities import WithSensitivities
from ..models.written_sensitivities import written_out
from ..symbolic import symbols as sym
from ..symbolic.expression import constant
from ..symbolic.functions import fma, where
from ..symbolic.rewrite import replaced
from .compiler import Kernel

if TYPE_CHECKING:
    from ..models.any_model import AnyModel
    from ..models.components import Components
    from ..models.event import Event, Stop
    from ..models.trigger import Edge, Trigger
    from ..symbolic.node import Node


def library(model: AnyModel, components: Components, method: str) -> _core.Library:
    """The interpreter of the core with the tape of a traced model. Raises `Error` if the model or the method is beyond
    it."""
    if isinstance(model, WithSensitivities):
        written = written_out(model)
        if isinstance(written, str):
            raise _refuse(written)
        model = written
    if not isinstance(model, RecordedModel):
        raise _refuse(model.not_interpreted)
    if model.noise is not None:
        raise _refuse("it has noise")
    if method not in methods:
        raise _refuse(f"the interpreter has the methods {', '.join(methods)} alone")
    if model.mass_matrix is not None:
        raise _refuse("it has a mass matrix")
    if model.summaries:
        raise _refuse("it has extrema or integrals over a phase")
    lengths = lengths_of(components)
    if model.queue is not None and model.queue.values > _core.tape_values:
        raise _refuse(f"its actions that wait have {model.queue.values} values, and the interpreter "
                      f"{_core.tape_values} at the most")
    writer = Writer(components)
    writer.delayed = {one.symbol: j for j, one in enumerate(model.delays)}
    results = [("store_result", c) for c in range(max(len(model.rhs), len(model.events)))]
    writer.function(model.rhs, results)
    writer.function([e.function for e in model.events], results)
    writer.hook(model.initialise, "initialise")
    writer.hook(model.after_step, "after_step")
    writer.hook(model.finalise, "finalise")
    writer.hook(model.generate, "generate")
    entries, values = _matrix(model) if method in stiff else ([], None)
    writer.function(values or [], [("store_result", e) for e in range(len(values or []))])
    _write_actions(writer, model)
    actions = [one.do for one in (*model.events, *model.stops, *model.triggers)]
    may_stop = any(t.value[0] == "action" for a in (model.after_step, *actions) for t, _ in a)
    _write_past(writer, model)
    made = _tape(writer, model, lengths, entries)
    shared, shared_integers = (len(components.names[kind]) for kind in kinds.shared)
    return _core.Library(method, shared, shared_integers, may_stop, made)


def _write_actions(writer: Writer, model: RecordedModel) -> None:
    """The functions of events, stops and triggers."""
    stops, triggers, edges = model.stops, model.triggers, model.edges

    def do(one: Event | Stop | Trigger) -> Callable[[], None]:
        return lambda: writer.hook(one.do, repr(one.name))

    def edge(one: Edge) -> Callable[[], None]:
        return lambda: writer.triggered(one, model)

    writer.series(map(do, model.events))
    writer.series_of_values(map(_time_of, stops))
    writer.series(map(do, stops))
    writer.series_of_values(one.condition for one in edges)
    writer.series(map(edge, edges))
    writer.series(map(do, triggers))
    writer.series_of_values(one.priority for one in triggers)


def _write_past(writer: Writer, model: RecordedModel) -> None:
    """The functions of delayed values: how long ago each is, and what it was before the begin."""
    writer.series_of_values(one.lag for one in model.delays)
    writer.series_of_values(model.history.get(one.symbol.value[1].state) for one in model.delays)


def _delays(model: RecordedModel) -> list[list[int]]:
    """Of each delayed value: the number of its state, the first delayed value that is as long ago, and whether it is
    the slope of the state."""
    number = {name: i for i, name in enumerate(model.states)}
    return [[number[one.state], first, int(one.is_slope)]
            for one, first in zip(model.delays, first_of_lag(model.delays))]


def _time_of(one: Stop) -> Node:
    """The time of a stop by its number, which stands where the time does."""
    number = sym.time
    if one.every is not None:
        first, every, count = one.values
        return where(number < count, fma(number, every, first), math.inf)
    if one.by_number:
        return replaced(one.times, {sym.stop_number: number})[0]
    time: Any = constant(math.inf)
    for i, given in reversed(list(enumerate(one.times))):
        time = where(number == i, given, time)
    return time


def _matrix(model: RecordedModel) -> tuple[list[tuple[int, int]], Sequence[Node] | None]:
    """The entries of the Jacobian, where it is not dense, and their values, if a tape is to compute them."""
    if len(model.states) < first_sparse:
        return [], None
    entries, values = jacobian_of(model)
    return entries or pattern_of(model), values


def _tape(writer: Writer, model: RecordedModel, lengths: list[int], entries: list[tuple[int, int]]) -> _core.Tape:
    """The tape of the functions of a model."""
    place = writer.place
    queue, edges = model.queue, model.edges
    where_waiting = [0, 0, 0, 0] if queue is None else [
        place[queue.accessories[0]][1], place[queue.integers[0]][1], queue.capacity, queue.values]
    return _core.Tape(writer.functions, writer.codes, writer.values, writer.registers, lengths, entries,
                      is_autonomous(model) and not model.delays,
                      [i for i, e in enumerate(edges) if not e.initial_value],
                      [i for i, e in enumerate(edges) if not e.persistent], where_waiting,
                      *((-1, -1) if queue is None else (len(model.stops), queue.seed)),
                      _delays(model), all(one.is_constant for one in model.delays))


def give_model(library: _core.Library, model: AnyModel, components: Components, method: str) -> None:
    """Gives checks and notes of a GPU's program the functions of a traced model, unless they are beyond the
    interpreter."""
    if not isinstance(model, RecordedModel) or model.noise is not None or model.delays:
        return
    writer = Writer(components)
    try:
        lengths = lengths_of(components)
        for roots in (model.rhs, [] if model.initialise else [e.function for e in model.events]):
            writer.function(roots, [("store_result", c) for c in range(len(roots))])
    except Error:
        return
    for _ in range(5):  # no hooks
        writer.function([], [])
    for _ in range(9):
        writer.series([])
    mass = [] if model.mass_matrix is None or model.initialise else model.mass_matrix.ravel().tolist()
    library.give_model(_tape(writer, model, lengths, []), method, mass)


_known: weakref.WeakKeyDictionary[Any, Any] = weakref.WeakKeyDictionary()


def kernel(model: AnyModel, components: Components, method: str, why: str) -> Kernel:
    """The interpreter with a model; `why` is told in the report."""
    of_model = _known.setdefault(model, {})
    if method not in of_model:
        of_model[method] = library(model, components, method)
    return Kernel(of_model[method], f"interpreted, {why}", 0.0)
