# SPDX-License-Identifier: MIT
"""Checks of a recorded model as a whole."""

from __future__ import annotations

from typing import Any

from ..base.errors import Error, at
from ..symbolic import symbols as sym
from ..symbolic.node import symbols_of, text, walk
from ..symbolic.whole_and_real import generic_problem
from . import delays


def check_recorded(model: Any) -> None:
    """Refuses names that clash, and expressions that stand where they mean nothing."""
    kind_of: dict[str, str] = {}
    for kind, names in model.enumerations():
        for name in names:
            if name in kind_of:
                clash = f"names both {sym.a(kind_of[name])} and {sym.a(kind)}"
                clash = "is the name of two components" if kind_of[name] == kind else clash
                raise Error(f"'{name}' {clash}{at(model.line)}: rename one of them")
            kind_of[name] = kind
    for symbol in model._in_functions:
        kind, name = symbol.value
        if kind in ("event_count", "action") or kind == "built-in" and name != "time":
            raise Error(f"{name} stands in an equation, event or summary{at(model.line)}, but only hooks and "
                        "actions see it: store it in an accessory there")
    problem = generic_problem(model._functions)
    if problem is not None:
        raise Error(f"`{text(problem)}`{at(problem.line)} mixes whole and real numbers, or multiplies whole ones, "
                    "in an equation or event: compare them, as in my.where(mode == 1, a, b)")
    for node in walk(model._functions):
        if node.op == "powr" and any(s.value[0] == "state" or s is sym.time for s in symbols_of([node.args[1]])):
            raise Error(f"the exponent of `{text(node)}`{at(node.line)} depends on the state or on time: use "
                        "my.pow, as powr has no derivative by its exponent")
    for what, assignments in model._hooks:
        for _, value in assignments:
            for symbol in symbols_of([value]):
                kind, name = symbol.value
                if kind == "action":
                    raise Error(f"{name} is read in {what}{at(model.line)}, but can only be assigned")
                if kind == "event_count" and name not in [e.name for e in model.events]:
                    raise Error(f"event_count('{name}') in {what}{at(model.line)} names no event: there are "
                                f"{', '.join(e.name for e in model.events) or 'none'}")
    for what, members, present in (
            ("stops", "stop stop_time", len(model.stop_names) - len(model.switches.switches)),
            ("triggers", "trigger condition after_trigger initial_value persistent queue", model.triggers),
            ("noise", "noise n_noise diffusion additive_noise", model.noise),
            ("delays", " ".join(delays.own_names), model.delays)):
        taken = next((n for n in members.split() if n in kind_of), None)
        if taken is not None and present:
            raise Error(f"'{taken}' names {sym.a(kind_of[taken])}{at(model.line)}, and has a meaning of its own in "
                        f"a model with {what}: call it '{taken}_'")
    delays.check(model)
    if model.name in kind_of:
        raise Error(f"the model has the name of its {kind_of[model.name]} '{model.name}'{at(model.line)}: give "
                    "it another one, name='...'")
