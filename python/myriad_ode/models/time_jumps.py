# SPDX-License-Identifier: MIT
"""Jumps of equations at times that are known beforehand: comparisons that time and constants alone decide, and whole
parts and remainders of time.

Steps end at each of these times, so that no step passes over what happens between two of them. Between two of them
everything that jumps keeps the value that it has halfway. The times are those of jump_times.py.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from ..symbolic import expression as ex, symbols as sym
from ..symbolic.folding import both, choose, compare, constant, is_constant, value_of
from ..symbolic.node import symbols_of, text, walk
from ..symbolic.rewrite import rebuilt, replaced
from .jump_times import JumpTimes, Time, is_less, kinked, unit_roundoff

if TYPE_CHECKING:
    from ..symbolic.types import Assignments
    from .any_model import AnyModel


def note(model: AnyModel, longest_step: float | None) -> str | None:
    """What to know of a model that jumps at times where no step ends; nothing where steps have a longest one."""
    if not model.jumps_to_miss or longest_step is not None:
        return None
    rename = ("" if "stop_time" not in model.component_names else
              ", or rename 'stop_time': a model whose steps end at jumps cannot have a component of that name")
    jumps = " and ".join(f"`{jump}`" for jump in model.jumps_to_miss)
    return (f"the model jumps where {jumps} changes, at times where no step ends: it may pass over what is between two "
            f"of them; give a maximum_step= shorter than that{rename}")


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
        times_of = self.times_of = JumpTimes(equations, changing)
        states, jumping = list(equations), rebuilt([*equations.values(), *quantities], times_of.without_copysign)
        functions = rebuilt(list(functions), times_of.without_copysign)
        found = {node: times_of(node) for node in walk([*jumping, *functions]) if times_of.may_jump(node)}
        self.jumps = [text(node) for node in found]
        self.unknown = [text(node) for node, times in found.items() if times is None]
        in_events = {node for node in walk(functions) if found.get(node)}
        for function in functions:
            if times_of.is_of_time(function) and (any(node in found for node in walk([function])) or
                                                  times_of.comes_back(function)):
                crossing = compare("less", function, constant(0.0))
                found[crossing] = times_of(crossing)
                in_events.add(crossing)
        found |= {kink: times_of(kink) for kink in times_of.kinks}
        between: dict[Any, Any] = {}
        for nodes, whole in self._apart(found, jumping, moves):
            if not (times := self._all_times(found, nodes)):
                continue
            switch = Switch(times_of.first(times), times_of.direction, not in_events.isdisjoint(nodes), free_name)
            self.switches.append(switch)
            inside: dict[Any, Any] = {}
            for node in nodes:  # arguments come before what is of them
                if found[node] is not None:
                    inside[node] = times_of.between(node, switch.between, inside)
            between |= {whole: inside[whole]} if whole is not None else inside
        self.located = {node for node, several in found.items() if several is not None}
        if self.switches:
            conditions = {node.args[0] for node in walk(jumping) if node.op == "select"}
            as_written = dict(zip(replaced(list(conditions), between), conditions))
            jumping = rebuilt(replaced(jumping, between), lambda node: self._guarded(node, as_written))
            self.equations, self.quantities = dict(zip(states, jumping)), jumping[len(states):]

    def _guarded(self, node: Any, as_written: Mapping[Any, Any]) -> Any:
        """A choice that a switch makes, as `where(t > 0, sin(t) / t, 1)`: at the very time of a jump, where the part
        chosen may have no value that is finite, the condition as it was written decides."""
        if node.op != "select" or (condition := as_written.get(node.args[0], node.args[0])) is node.args[0]:
            return node
        parts = node.args[1:]
        if not any(self.times_of.may_be_undefined(part) for part in parts):
            return node
        is_finite = compare("less", ex.abs(node), constant(math.inf))
        return choose(is_finite, node, choose(condition, *parts))

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
            inside |= {is_less(one) for one in inside if one.op in kinked}
            nodes = [one for one in found if one in inside]
            times = self._all_times(found, nodes)
            if times and moves is not None and moves(set(symbols_of([self.times_of.first(times)]))):
                apart.append((nodes, node))
        if not apart:
            return [(list(found), None)]
        alone = {node for _, node in apart}
        seen = set(walk([node for node in outermost if node not in alone]))
        seen |= {is_less(one) for one in seen if one.op in kinked}
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
