# SPDX-License-Identifier: MIT
"""Jumps of equations at times that are known beforehand: comparisons that time and constants alone decide, and whole
parts and remainders of time.

Steps end at each of these times, so that no step passes over what happens between two of them. Between two of them
everything that jumps keeps the value that it has halfway.

At the time of a jump, rounding may put what is compared on either side of it. So the next jump is sought a little later
than now: by the rounding errors of what is compared, which depend on its summands and on the precision of the run.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Callable, Collection, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from ..symbolic import expression as ex, symbols as sym
from ..symbolic.expression import symbols_of, text, walk
from ..symbolic.folding import (add, apply, both, choose, compare, constant, divide, is_constant, make_folded,
                                multiply, subtract, total, value_of)
from ..symbolic.rewrite import rebuilt, replaced

if TYPE_CHECKING:
    from ..symbolic.types import Assignments
    from .any_model import AnyModel

_comparisons = "less", "less_equal", "greater", "greater_equal", "equal", "not_equal"
_remainders = "fmod", "floor_mod"
_whole = "floor", "rint", "floor_divide", *_remainders
_kinked = "abs", "min", "max"
_waves = {"sin": (math.pi, ex.asin), "cos": (math.pi, ex.acos), "sinpi": (1.0, ex.asin), "cospi": (1.0, ex.acos)}

_one = constant(1.0)

Form = dict[Any, Any]  #: a sum: coefficients by what they multiply, which is 1, the time, or a function of time
Time = tuple[Any, Any]  #: a time, and how far it has to be ahead to be still to come


def note(model: AnyModel, longest_step: float | None) -> str | None:
    """What to know of a model that jumps at times where no step ends; nothing where steps have a longest one."""
    if not model.jumps_to_miss or longest_step is not None:
        return None
    rename = ("" if "stop_time" not in model.component_names else
              ", or rename 'stop_time': a model whose steps end at jumps cannot have a component of that name")
    jumps = " and ".join(f"`{jump}`" for jump in model.jumps_to_miss)
    return (f"the model jumps where {jumps} changes, at times where no step ends: it may pass over what is between two "
            f"of them; give a maximum_step= shorter than that{rename}")


def unit_roundoff() -> Any:
    """The largest relative error of rounding in the precision of a run. One text is compiled for both: 1 + 1e-10 is 1
    in single precision alone."""
    one = 1.0 + ex.abs(sym.t_begin)
    return choose(compare("equal", one * (1.0 + 1e-10), one), constant(2.0**-24), constant(2.0**-53))


class Switch:
    """The jumps at some times, one after the other: what jumps is computed for the time of the accessory `between`,
    which is between the last jump and the next. A step has to end at the time of the accessory `following`, where
    assignments `at_jump` are made; those of `at_start` are made at the start of a phase. The times follow from what is
    `needed`."""

    def __init__(self, first: Any, direction: Any, in_events: bool, free_name: Callable[[str], str]) -> None:
        self.following, self.between = (sym.accessory(free_name(name)) for name in ("next_jump", "between_jumps"))
        self.needed = set(symbols_of([first]))
        # after the last jump: some time, as an infinite one makes NaN of k * time where k is zero
        later = sym.time + direction * (1.0 + ex.abs(sym.time))
        is_finite = compare("less", ex.abs(first), constant(math.inf))
        to_middle = 0.5 * (sym.time + choose(is_finite, first, later))
        self.at_start = self.at_jump = {self.following: to_middle if in_events else first, self.between: to_middle}
        if in_events:
            # functions of events are seen in the middle, and once more shortly before the jump, as they are until then
            ahead = 64.0 * unit_roundoff() * (ex.abs(first) + ex.abs(sym.t_begin))
            is_near = both(is_finite, compare("less_equal", direction * (first - sym.time), 2.0 * ahead))
            before = choose(is_finite, first - direction * ahead, first)
            is_middle = compare("equal", self.following, self.between)
            self.at_jump = {self.following: choose(is_near, first, choose(is_middle, before, to_middle)),
                            self.between: choose(is_middle, self.between, to_middle)}


class TimeSwitches:
    """Makes the jumps in time of `equations`, by state, and of the `quantities` of summaries exact. If there are any,
    both are rewritten, with the accessories of `switches`, each of which has a stop. Jumps whose times have no formula
    are `unknown`, and stay as they are.

    One switch takes all jumps at their first time. Where derivatives are wanted, a jump contributes the derivative of
    its own time, also if others are at the same time: with `moves`, which says of symbols whether times that follow
    from them have derivatives, each such outermost operation that jumps has a switch of its own, and what jumps within
    it one more in its place.

    Jumps may also depend on what changes at actions alone, which then find the next jump anew: `continued`; not on
    what is `changing`. If `functions` of events jump or come back, steps also end halfway between jumps, where the
    signs of these functions are seen. `free_name` makes names of components."""

    def __init__(self, equations: Mapping[Any, Any], quantities: Sequence[Any], functions: Sequence[Any],
                 changing: Collection[Any], free_name: Callable[[str], str],
                 moves: Callable[[set[Any]], bool] | None = None) -> None:
        self.equations, self.quantities = dict(equations), list(quantities)
        self.switches: list[Switch] = []
        self.located: set[Any] = set()  #: what jumps at times at which steps end
        self.unknown: list[str] = []
        self.jumps: list[str] = []  #: all of them, known or not
        self._changing = changing
        self._still = {s for s, rate in equations.items() if s not in changing and
                       is_constant(rate) and value_of(rate) == 0}
        self._clocks = {s: rate for s, rate in equations.items() if s not in changing and  # which measure time
                        s not in self._still and self._is_still(rate)}
        states, jumping = list(equations), rebuilt([*equations.values(), *quantities], self.without_copysign)
        functions = rebuilt(list(functions), self.without_copysign)
        self._forms: dict[Any, Form | None] = {}
        self._times: dict[Any, list[Time] | None] = {}
        self._kinks: list[Any] = []
        self._direction = choose(compare("less", sym.t_end, sym.t_begin), constant(-1.0), constant(1.0))
        found = {node: self._times_of(node) for node in walk([*jumping, *functions]) if self._may_jump(node)}
        self.jumps = [text(node) for node in found]
        self.unknown = [text(node) for node, times in found.items() if times is None]
        in_events = {node for node in walk(functions) if found.get(node)}
        for function in functions:
            if self._is_of_time(function) and (any(node in found for node in walk([function])) or any(
                    key is not sym.time and key is not _one for key in self._form(function) or ())):
                crossing = compare("less", function, constant(0.0))
                found[crossing] = self._times_of(crossing)
                in_events.add(crossing)
        found |= {kink: self._times_of(kink) for kink in self._kinks}
        between: dict[Any, Any] = {}
        for nodes, whole in self._apart(found, jumping, moves):
            if not (times := self._all_times(found, nodes)):
                continue
            switch = Switch(self._first(times), self._direction, not in_events.isdisjoint(nodes), free_name)
            self.switches.append(switch)
            inside: dict[Any, Any] = {}
            for node in nodes:  # arguments come before what is of them
                if found[node] is not None:
                    inside[node] = self._between(node, switch.between, inside)
            between |= {whole: inside[whole]} if whole is not None else inside
        self.located = {node for node, several in found.items() if several is not None}
        if self.switches:
            jumping = replaced(jumping, between)
            self.equations, self.quantities = dict(zip(states, jumping)), jumping[len(states):]

    @property
    def at_start(self) -> dict[Any, Any]:
        """The assignments at the start of a phase."""
        return {target: value for one in self.switches for target, value in one.at_start.items()}

    @property
    def needed(self) -> set[Any]:
        """What the times of jumps follow from."""
        return {symbol for one in self.switches for symbol in one.needed}

    def may_move(self, moves: Callable[[set[Any]], bool]) -> bool:
        """Whether the times of jumps have derivatives."""
        return any(moves(one.needed) for one in self.switches)

    @staticmethod
    def _all_times(found: dict[Any, list[Time] | None], nodes: Collection[Any]) -> list[Time]:
        """The times of some jumps."""
        return [(t, ahead) for t, ahead in dict.fromkeys(one for node in nodes for one in found[node] or ())
                if not is_constant(t) or math.isfinite(value_of(t))]

    def _apart(self, found: dict[Any, list[Time] | None], jumping: list[Any],
               moves: Callable[[set[Any]], bool] | None) -> list[tuple[list[Any], Any]]:
        """What jumps, in sets of their own where their times have derivatives, each with the operation that it is for,
        and all others together, for none."""
        outermost = [] if moves is None else self._outermost(found, jumping)
        apart = []
        for node in outermost:
            inside = set(walk([node]))
            inside |= {_is_less(one) for one in inside if one.op in _kinked}
            nodes = [one for one in found if one in inside]
            times = self._all_times(found, nodes)
            if times and moves is not None and moves(set(symbols_of([self._first(times)]))):
                apart.append((nodes, node))
        if not apart:
            return [(list(found), None)]
        alone = {node for _, node in apart}
        seen = set(walk([node for node in outermost if node not in alone]))
        seen |= {_is_less(one) for one in seen if one.op in _kinked}
        in_some = {node for nodes, _ in apart for node in nodes}
        others = [node for node in found if node in seen or node not in in_some]
        return [*apart, (others, None)]

    @staticmethod
    def _outermost(found: dict[Any, list[Time] | None], roots: list[Any]) -> list[Any]:
        """What jumps in some expressions and is in nothing else that does."""
        seen: set[Any] = set()
        waiting, outermost = list(roots), []
        while waiting:
            if (node := waiting.pop()) in seen:
                continue
            seen.add(node)
            if found.get(node) is not None:
                outermost.append(node)
            else:
                waiting += node.args
        return [node for node in found if node in set(outermost)]  # in their order

    def continued(self, assignments: Assignments, begins: bool = False) -> Assignments:
        """Assignments of a hook or action, and then the next jumps after them, where they are others. `begins`: they
        begin a phase, at a time that they may assign."""
        known = dict(assignments)
        if begins and sym.t_begin in known:
            known[sym.time] = known[sym.t_begin]
        further = {target: value for one in self.switches if begins or not one.needed.isdisjoint(known)
                   for target, value in one.at_start.items()}
        return [*assignments, *zip(further, replaced(list(further.values()), known))]

    def _may_jump(self, node: Any) -> bool:
        return node.op in (*_comparisons, *_whole) and node.value != ex.continuous and self._is_of_time(node)

    def without_copysign(self, node: Any) -> Any:
        """The sign of a function of time as a choice."""
        if node.op != "copysign" or not self._is_of_time(node.args[1]):
            return node
        size = ex.abs(node.args[0])
        return choose(compare("less", node.args[1], constant(0.0)), make_folded("negate", size), size)

    def _is_of_time(self, node: Any) -> bool:
        """Whether time and what changes at actions alone decide an expression."""
        return self._has_time(node) and all(s is sym.time or s in self._clocks or self._is_still(s)
                                            for s in symbols_of([node]))

    def _has_time(self, node: Any) -> bool:
        return any(s is sym.time or s in self._clocks for s in symbols_of([node]))

    def _is_still(self, node: Any) -> bool:
        """Whether an expression changes at actions alone."""
        kinds = "parameter", "shared", "shared_integer", "accessory", "integer_accessory"
        return all(s.value[0] in kinds and s not in self._changing or s in self._still for s in symbols_of([node]))

    def _at(self, node: Any, time: Any) -> Any:
        """An expression at another time."""
        clocks = {s: s + rate * (time - sym.time) for s, rate in self._clocks.items()}
        return replaced([node], {sym.time: time, **clocks})[0]

    def _first(self, times: list[Time]) -> Any:
        """The first of some times that is still to come, infinite if there is none. Multiplied by the direction, so
        that it is the smallest backwards, too."""
        to_come = [choose(compare("greater", self._direction * (t - sym.time), ahead), self._direction * t,
                          constant(math.inf)) for t, ahead in times]
        return self._direction * functools.reduce(lambda a, b: ex.make("min", (a, b)), to_come)

    def _between(self, node: Any, middle: Any, known: dict[Any, Any]) -> Any:
        """What jumps, as it is between two jumps; what jumps in it is known."""
        inside = self._at(node, middle)
        if node.op not in _remainders:
            return inside
        value, = replaced([node.args[0]], known)
        return subtract(value, subtract(self._at(node.args[0], middle), inside))  # less whole multiples

    # -- When it jumps -------------------------------------------------------------------------------------------------

    def _times_of(self, node: Any) -> list[Time] | None:
        """Some times, among them the last jump before now and the next one; None if they have no formula."""
        if node not in self._times:
            self._times[node] = self._found_times_of(node)
        return self._times[node]

    def _found_times_of(self, node: Any) -> list[Time] | None:
        if node.op in _comparisons:
            form = self._form(_decisive(node))
            waves = _waves_of(form)
            if form is None or len(waves) > 1 or waves and sym.time in form:
                return None
            if waves:
                rest = self._rest({key: factor for key, factor in form.items() if key is not waves[0]})
                return self._angles(waves[0], divide(_negative(rest), form[waves[0]]))
            return self._roots(form, [constant(0.0)])
        inside = _decisive(node)
        form = self._form(inside)
        if form is None or _waves_of(form):
            return None
        shift = 0.5 if node.op == "rint" else 0.0
        below = apply(ex.floor, subtract(self._now_of(inside, form), constant(shift)))
        return self._roots(form, [add(below, constant(shift + k)) for k in (-1, 0, 1)])

    def _now_of(self, node: Any, own: Form | None = None) -> Any:
        """The value of an expression a little later than now, so that rounding cannot put it before a jump that is at
        this time. `own`: the expression as a sum, where its own size decides, as of whole parts and angles."""
        inside = [self._form(_decisive(one)) for one in walk([node]) if self._may_jump(one)]
        forms = [form for form in (own, *inside) if form is not None]
        if not forms:
            return node
        ahead = functools.reduce(lambda a, b: ex.make("max", (a, b)), [self._ahead(form) for form in forms])
        return self._at(node, sym.time + self._direction * ahead)

    def _ahead(self, form: Form) -> Any:
        """The error of the time at which a sum has some value, by rounding; more than zero, so that one is ahead of a
        jump at zero, too."""
        size = total([ex.abs(self._term(factor, key)) for key, factor in form.items() if key is not sym.time])
        if (by := form.get(sym.time)) is not None:
            size = choose(compare("equal", by, constant(0.0)), constant(0.0), divide(size, ex.abs(by)))
        return 16.0 * unit_roundoff() * (ex.abs(sym.time) + size) + 1e-30

    def _rest(self, form: Form) -> Any:
        """A sum without its multiple of the time."""
        return total([self._term(factor, self._now_of(key)) for key, factor in form.items() if key is not sym.time])

    @staticmethod
    def _term(factor: Any, value: Any) -> Any:
        """A product that is zero where the factor is, even if the value is not finite, as floor(time / 0)."""
        product = multiply(factor, value)
        if is_constant(factor) or is_constant(value):
            return product
        return choose(compare("equal", factor, constant(0.0)), constant(0.0), product)

    def _roots(self, form: Form, values: list[Any]) -> list[Time]:
        """The times at which a sum has some values."""
        if sym.time not in form:
            return []
        less = _negative(self._rest(form))
        times = [divide(add(value, less), form[sym.time]) for value in values]
        # what does not follow from the time has the same bits whenever it is computed
        ahead = self._ahead(form) if any(self._has_time(one) for one in times) else constant(0.0)
        return [(time, ahead) for time in times]

    def _angles(self, wave: Any, height: Any) -> list[Time]:
        """The times at which a sine or cosine of time has a value."""
        angle, = wave.args
        form = self._form(angle)
        assert form is not None
        half_turn, inverse = _waves[wave.op]
        principal = multiply(constant(half_turn / math.pi), apply(inverse, height))
        other = subtract(constant(half_turn if wave.op in ("sin", "sinpi") else 0.0), principal)
        turns = apply(ex.floor, divide(self._now_of(angle, form), constant(2 * half_turn)))
        return self._roots(form, [add(one, multiply(add(turns, constant(k)), constant(2 * half_turn)))
                                  for one in (principal, other) for k in (-1.0, 0.0, 1.0)])

    # -- Sums ----------------------------------------------------------------------------------------------------------

    def _form(self, node: Any) -> Form | None:
        """An expression of time and constants as a sum that is valid until the next jump; None if it is none."""
        if node not in self._forms:
            self._forms[node] = self._form_of(node)
        return self._forms[node]

    def _form_of(self, node: Any) -> Form | None:
        if node is sym.time:
            return {sym.time: _one}
        if node in self._clocks:
            rate = self._clocks[node]
            return {sym.time: rate, _one: node - rate * sym.time}
        if not self._has_time(node):
            return {_one: node}
        if node.op in _kinked:
            return self._form(self._with_kink(node))
        forms: list[Form] = []
        for argument in node.args:
            form = {} if argument.type == ex.condition else self._form(argument)
            if form is None:
                return None
            forms.append(form)
        first, second, third = [*forms, {}, {}][:3]
        jumps = [node] if node.op in _whole else walk(node.args[:1]) if node.op == "select" else []
        if any(self._may_jump(one) and self._times_of(one) is None for one in jumps):
            return None
        if node.op == "select":
            chosen = self._now_of(node.args[0])
            return {key: choose(chosen, second.get(key, constant(0.0)), third.get(key, constant(0.0)))
                    for key in {**second, **third}}
        if node.op in ("add", "subtract"):
            return _sum(first, second if node.op == "add" else _opposite(second))
        if node.op == "negate":
            return _opposite(first)
        if node.op in ("multiply", "divide"):
            if node.op == "multiply" and all(key is _one for key in first):
                first, second = second, first
            of = multiply if node.op == "multiply" else divide
            if any(key is not _one for key in second):
                return None
            by = second.get(_one, constant(0.0))
            return {key: of(factor, by) for key, factor in first.items()}
        if node.op in _remainders:
            return _sum(first, {ex.make("subtract", (node.args[0], node)): constant(-1.0)})
        if node.op in _whole or node.op in _waves and not _waves_of(first):
            return {node: _one}
        return None

    def _with_kink(self, node: Any) -> Any:
        """An absolute value, a minimum or a maximum by a comparison."""
        a, b = node.args if len(node.args) == 2 else (node.args[0], constant(0.0))
        self._kinks.append(is_less := _is_less(node))
        if node.op == "abs":
            return choose(is_less, ex.make("negate", (a,)), a)
        return choose(is_less, *((a, b) if node.op == "min" else (b, a)))


def _is_less(node: Any) -> Any:
    """Whether the first argument of an absolute value, a minimum or a maximum is less than the second."""
    return compare("less", *(node.args if len(node.args) == 2 else (node.args[0], constant(0.0))))


def _decisive(node: Any) -> Any:
    """What decides when an operation jumps: at zero if it is a comparison, else at whole numbers."""
    if node.op in _comparisons:
        return ex.make("subtract", node.args)
    return node.args[0] if len(node.args) == 1 else ex.make("divide", node.args)


def _sum(a: Form, b: Form) -> Form:
    made = {key: add(a.get(key, constant(0.0)), b.get(key, constant(0.0))) for key in {**a, **b}}
    return {key: factor for key, factor in made.items() if not (is_constant(factor) and value_of(factor) == 0)}


def _opposite(form: Form) -> Form:
    return {key: _negative(factor) for key, factor in form.items()}


def _negative(value: Any) -> Any:
    return value.args[0] if value.op == "negate" else make_folded("negate", value)


def _waves_of(form: Form | None) -> list[Any]:
    return [key for key in form or () if key.op in _waves]
