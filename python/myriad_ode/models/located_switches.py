# SPDX-License-Identifier: MIT
"""A model whose steps end where its equations jump because of the state or the past: each operation that jumps is a
mode, which the equations read in its place and triggers set."""

from __future__ import annotations

import copy
from collections.abc import Callable, Collection, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from ..base.errors import Error, at, users_line
from ..symbolic import expression as ex, symbols as sym
from ..symbolic.delays import read_now_or_then
from ..symbolic.folding import add, choose, compare, constant, divide, make_folded, multiply, opposite, subtract
from ..symbolic.node import walk
from ..symbolic.rewrite import rebuilt, replaced
from .recorded import RecordedModel
from .recorded_check import check_recorded
from .state_jumps import jumping
from .trigger import Queue, Trigger, edges_of, trigger

if TYPE_CHECKING:
    from ..symbolic.types import Assignments
    from .any_model import AnyModel

__all__ = ["with_located_switches"]

# Which argument of a comparison is to be greater than which other one, and whether that is where it holds.
_as_greater = {"greater": (0, 1, 1), "less": (1, 0, 1), "less_equal": (0, 1, 0), "greater_equal": (1, 0, 0)}
_partly_defined = "sqrt", "rsqrt", "log", "log1p", "log2", "log10", "pow", "powr", "asin", "acos"


def with_located_switches(model: AnyModel) -> RecordedModel:
    """The model in which steps end where equations, or quantities of summaries, jump because of the state or of delayed
    values, as those with `my.where(x > c, a, b)`, `np.sign(x)` or `x // 1` in them. Each such operation is a mode, an
    accessory that is set where it changes. So no step sees a jump, and derivatives by c are right. Where both sides
    lead to the jump, as to `x = 0` of `-np.sign(x)`, the solution would slide along it; the instance ends as
    `event_accumulation`."""
    line = users_line()
    if not isinstance(model, RecordedModel):
        raise Error(f"the switches of a {type(model).__name__} are to be located{at(line)}: give a model of my.model, "
                    "or of a file, before anything is made of it")
    if model.noise is not None:
        raise Error(f"the model has noise{at(line)}, whose paths cross a jump again and again, so that there is "
                    "nothing to locate: give the model without noise")
    roots, found = jumping(model)
    if not found:
        return model
    given, made = model._as_given, model.changeable()
    made.line, made._reader = line, copy.copy(model._reader)
    made._reader.line = line
    taken = [*given.component_names, *model._reserved, *model.aliases, *model.outputs, given.name,
             *(str(one.name) for one in (*given.events, *given.stops, *given.triggers))]

    def free_name(wanted: str) -> str:
        taken.append(sym.free_name(wanted, taken))
        return taken[-1]

    modes: list[_Mode] = []
    read: dict[Any, Any] = {}
    for node in found:  # what is in others comes before them
        names = _Names(free_name(f"switch_{len(modes) + 1}"), free_name, lambda one: replaced([one], read)[0])
        make = _of_comparison if node.op in _as_greater else _of_sign if node.op == "copysign" else _of_whole
        modes.append(make(node, names))
        read[node] = modes[-1].read
    before: list[Any] = walk(roots)
    written: dict[Any, Any] = dict(zip(replaced(before, read), before))
    modes_read = {*read.values()}
    roots = rebuilt(replaced(roots, read), lambda node: _finished(node, written.get(node, node), modes_read))
    made.equations = dict(zip(model.equations, roots))
    made.rhs = list(made.equations.values())
    made.observed = [(name, quantity) for (name, _), quantity in zip(given.observed, roots[len(made.rhs):])]
    actions, sides = made._reader.triggers([one for mode in modes for one in mode.triggers], made.equations)
    made.events = [*map(copy.copy, given.events), *sides]
    made.stops = [*map(copy.copy, given.stops)]
    made.triggers = [*map(copy.copy, given.triggers), *actions]
    made.initialise = _followed(given.initialise, modes, begins=True)
    for one in (*made.events[:len(given.events)], *made.stops, *made.triggers[:len(given.triggers)]):
        one.do = _followed(one.do, modes)
    made.hidden = given.hidden | {symbol.value[1] for mode in modes for symbol in mode.accessories}
    if given.queue is not None:
        made.queue = Queue(made.triggers, None if given.queue.seed < 0 else given.queue.seed)
        made.hidden |= {*made.queue.accessories, *made.queue.integers}
    made.edges = list(edges_of(made.triggers, made.queue))
    made.units_of_states = made.jumps_by_state = None
    made.located_switches = [mode.accessories[0].value[1] for mode in modes]
    made._collect(list(made.equations))
    made._make_jumps_exact(given.name or None, model.mass_matrix is not None)
    check_recorded(made)
    return made


class _Mode:
    """An operation that jumps, as its mode: the accessories that make it up, what equations `read` in its place, the
    `triggers` that set it, what it is at the `start`, and at the start of a `later` phase or after an action. It
    follows from some `operands`."""

    def __init__(self, operands: Sequence[Any], accessories: Sequence[Any], read: Any, triggers: Sequence[Trigger],
                 start: dict[Any, Any], later: dict[Any, Any]) -> None:
        self.operands, self.accessories, self.read, self.triggers = operands, accessories, read, triggers
        self.start, self.later = start, later

    def values(self, begins: bool) -> dict[Any, Any]:
        """What a hook gives it, which may begin a phase."""
        is_first = compare("equal", sym.phase, ex.constant(0))
        return {one: choose(is_first, self.start[one], value) if begins else value for one, value in self.later.items()}


class _Names:
    """The names of what belongs to a mode, and its expressions with other modes in them."""

    def __init__(self, name: str, free_name: Callable[[str], str], with_modes: Callable[[Any], Any]) -> None:
        self.name, self.free_name, self.with_modes = name, free_name, with_modes

    def accessory(self, what: str) -> Any:
        return sym.accessory(self.free_name(f"{self.name}_{what}"))

    def trigger(self, what: str, condition: Any, do: dict[Any, Any]) -> Trigger:
        return trigger(condition, do=do, persistent=False, name=self.free_name(f"{self.name}_{what}"))


def _side(high: Any, low: Any, names: _Names) -> _Mode:
    """Whether one expression is greater than another one, as a whole number. If the state is still where the mode was
    set, rounding decides on which side that is, and the mode knows better."""
    mode, last = sym.integer_accessory(names.name), names.accessory("at")
    a, b = names.with_modes(high), names.with_modes(low)
    to = [names.trigger(what, compare(op, a, b), {mode: ex.constant(value), last: subtract(a, b)})
          for what, op, value in (("on", "greater", 1), ("off", "less_equal", 0))]
    start = choose(compare("greater", high, low), ex.constant(1), ex.constant(0))
    is_there = compare("less_equal", ex.abs(subtract(high, low)), ex.abs(last))
    return _Mode([high, low], [mode, last], compare("equal", mode, ex.constant(1)), to, {mode: start},
                 {mode: choose(is_there, mode, start)})


def _of_comparison(node: Any, names: _Names) -> _Mode:
    """The mode of a comparison."""
    high, low, holds = _as_greater[node.op]
    mode = _side(node.args[high], node.args[low], names)
    mode.read = mode.read if holds else opposite(mode.read)
    return mode


def _of_sign(node: Any, names: _Names) -> _Mode:
    """The mode of `copysign`."""
    mode, size = _side(constant(0.0), node.args[1], names), ex.abs(names.with_modes(node.args[0]))
    mode.read = choose(mode.read, make_folded("negate", size), size)
    return mode


def _of_whole(node: Any, names: _Names) -> _Mode:
    """The mode of a whole part or remainder: the whole number that is nearest to a quotient, and whether it is greater.
    It is looked at again where the quotient is a little more than half beyond it."""
    quotient = node.args[0] if len(node.args) == 1 else divide(*node.args)
    if node.op == "rint":
        quotient = add(quotient, constant(0.5))
    if node.op == "fmod":
        quotient = ex.abs(quotient)
    nearest = names.accessory("number")
    mode = _side(nearest, quotient, names)
    is_less, (below, *_) = mode.read, mode.accessories
    off = subtract(names.with_modes(quotient), nearest)
    mode.triggers = [*mode.triggers, *(names.trigger(what, compare(op, off, constant(0.6 * by)), {
        nearest: add(nearest, constant(by)), below: ex.constant(int(by > 0))}) for what, op, by in (
            ("up", "greater", 1.0), ("down", "less", -1.0)))]
    mode.operands, mode.accessories = [quotient], [*mode.accessories, nearest]
    anew = ex.round(quotient)
    is_near = compare("less", ex.abs(subtract(quotient, nearest)), constant(0.75))
    mode.start = {nearest: anew, below: replaced([mode.start[below]], {nearest: anew})[0]}
    mode.later = {nearest: choose(is_near, nearest, anew), below: choose(is_near, mode.later[below], mode.start[below])}
    whole = choose(is_less, subtract(nearest, constant(1.0)), nearest)
    if node.op in ("floor_mod", "fmod"):
        a, b = (names.with_modes(one) for one in node.args)
        whole = subtract(a, multiply(b, whole if node.op == "floor_mod" else ex.make(
            "copysign", (whole, divide(a, b)), ex.continuous)))
    mode.read = whole
    return mode


def note_on_sliding(model: AnyModel, by_status: Mapping[str, int]) -> str | None:
    """What to know of instances that ended where two sides of a jump lead to it."""
    if not model.located_switches or not by_status.get("event_accumulation"):
        return None
    return ("instances ended as event_accumulation: where the equations jump, if both sides lead to the jump, the "
            "solution would slide along it, which the equations do not say; give the sliding a mode with equations of "
            "its own")


def _followed(assignments: Assignments, modes: Sequence[_Mode], begins: bool = False) -> Assignments:
    """Assignments of a hook or action, and those of modes that follow from them. `begins`: they begin a phase, at a
    time that they may assign."""
    known = dict(assignments)
    if begins and sym.t_begin in known:
        known[sym.time] = known[sym.t_begin]
    further = {one: value for mode in modes if begins or not read_now_or_then(mode.operands).isdisjoint(known)
               for one, value in mode.values(begins).items()}
    return [*assignments, *zip(further, replaced(list(further.values()), known))]


def _finished(node: Any, written: Any, modes: Collection[Any]) -> Any:
    """An operation that was `written` otherwise. In a trial beyond a jump the part that a mode chooses may have no
    value, as of `where(x > 0, sqrt(x) + 1, 0)`: there the condition as it was written decides. The sign of a whole part
    changes where that is zero."""
    if node.op == "copysign" and node.args[0] in modes:
        return ex.make("copysign", node.args, ex.continuous)
    if node.op != "select" or written is node or all(one.op not in _partly_defined for one in walk(node.args[1:])):
        return node
    is_finite = ex.make("less", (ex.abs(node), constant(float("inf"))), ex.continuous, ex.condition)
    return choose(is_finite, node, choose(written.args[0], *node.args[1:]))

