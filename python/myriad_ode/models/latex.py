# SPDX-License-Identifier: MIT
"""A recorded model as LaTeX and as what a notebook shows."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Sequence
from html import escape
from typing import TYPE_CHECKING, Any

from ..base import component_kinds as kinds
from ..symbolic.latex import difference_latex, expressions_latex, names_latex, plain
from ..symbolic.node import Node
from ..symbolic.symbols import symbol as symbol_of
from .any_model import names_of
from .noise import is_factor, is_zero

if TYPE_CHECKING:
    from ..symbolic.types import Assignments
    from .event import Event, Stop, Summary
    from .trigger import Trigger

_built_in = {"time": "t", "step": r"\Delta t", "next_step": r"\Delta t_{\mathrm{next}}", "phase": r"\mathrm{phase}",
             "instance": r"\mathrm{instance}", "t_begin": r"t_{\mathrm{begin}}", "t_end": r"t_{\mathrm{end}}"}
_directions = {"rising": " (rising)", "falling": " (falling)", "either": "", "none": " (switched off)"}
_actions = {"end_phase": r"\text{end phase}", "end_instance": r"\text{end instance}"}
_shown = 40  # lines, in a notebook
_Write = Callable[[Any], str]


def _lines(model: Any, mass_matrix: Any) -> list[str]:
    """The lines of the model, with an & where they are aligned."""
    roots: list[Node] = []

    def note(node: Node) -> str:
        roots.append(node)
        return ""

    _content(model, mass_matrix, note)  # what will be written
    names = names_latex([*(name for kind in kinds.valued for name in names_of(model)[kind]),
                         *(model.noise.names if model.noise is not None else ())], _built_in.values())

    def symbol(node: Node) -> str:
        kind, name = node.value
        if kind == "built-in":
            return _counter(model) if name == "stop_number" else _built_in[name]
        if kind == "delayed":
            (lag,), _ = expressions_latex([name.lag], symbol, "")
            state = rf"\dot{{{symbol(name.state)}}}" if name.is_slope else symbol(name.state)
            return rf"{state}\left({difference_latex('t', lag)}\right)"
        if kind == "event_count":
            return rf"N_{{\mathrm{{{plain(name)}}}}}"
        return _actions[name] if kind == "action" else names.get(name, rf"\mathrm{{{plain(name)}}}")

    written, parts = expressions_latex(roots, symbol, _free_letter(model, "wuqz"))
    texts = iter(written)
    lines = _content(model, mass_matrix, lambda _: next(texts).text)
    return [*lines, *(f"{name} &= {text}" for name, text in parts.items())]


def _free_letter(model: Any, wanted: str) -> str:
    """A letter that no component has, nor one with a subscript."""
    taken = {re.split(r"[_\d]", name)[0] for names in names_of(model).values() for name in names}
    return next((letter for letter in wanted if letter not in taken), r"\ell")


def _counter(model: Any) -> str:
    """What the times of stops are counted by."""
    return _free_letter(model, "nijm")


def _content(model: Any, mass_matrix: Any, write: _Write) -> list[str]:
    """The lines of the model. `write` gets expressions, always in the same order."""
    quantities, counter = dict(model.observed), _counter(model)
    own = [one.as_given for one in model.triggers if one.as_given is not None]
    return [*_equations(model, mass_matrix, write), *_history(model, write),
            *(_summary(one, quantities[one.observed], write) for one in model.summaries),
            *_hook("at the start of a phase", model.initialise, write),
            *_hook("after a step", model.after_step, write), *_hook("at the end of a phase", model.finalise, write),
            *(_event(one, write) for one in model.events[:model._written_events]),
            *(_stop(one, write, counter) for one in model.stops), *(_trigger(one, write) for one in own),
            *_hook("instances of a study", model.generate, write)]


def _equations(model: Any, mass_matrix: Any, write: _Write) -> Iterable[str]:
    if model.noise is not None:
        yield from _stochastic_equations(model, write)
        return
    states = list(model.equations)
    slopes = [rf"\frac{{\mathrm{{d}} {write(state)}}}{{\mathrm{{d}} t}}" for state in states]
    for number, right in enumerate(model.equations.values()):
        left = slopes[number] if mass_matrix is None else _combined(mass_matrix[number], slopes)
        yield f"{left} &= {write(right)}"


def _stochastic_equations(model: Any, write: _Write) -> Iterable[str]:
    """The equations of differentials. The process of a state of its own is a letter with the state as subscript."""
    letter = _free_letter(model, "WBZ")
    for number, (state, drift) in enumerate(model.equations.items()):
        name = write(state)
        terms = [] if is_zero(drift) else [_term(drift, "t", write)]
        for factor, process in model.noise.terms(number):
            terms.append(_term(factor, rf"{letter}_{{{name}}}" if process is None else write(process), write))
        yield rf"\mathrm{{d}} {name} &= {' + '.join(terms) or 0}"


def _term(factor: Node, by: str, write: _Write) -> str:
    """A factor times a differential."""
    differential = rf"\mathrm{{d}} {by}"
    if factor.op == "constant" and factor.value == 1:
        return differential
    text = write(factor)
    return rf"{text} \, {differential}" if is_factor(factor) else rf"\left({text}\right) \, {differential}"


def _combined(factors: Sequence[float], slopes: Sequence[str]) -> str:
    """The left side of an equation with a mass matrix."""
    text = ""
    for factor, slope in zip(factors, slopes):
        if factor:
            sign = (" - " if factor < 0 else " + ") if text else "-" if factor < 0 else ""
            size = "" if abs(factor) == 1 else rf"{abs(float(factor)):.6g} \, "
            text += f"{sign}{_power_of_ten(size)}{slope}"
    return text or "0"


def _power_of_ten(size: str) -> str:
    return re.sub(r"e([+-]?\d+)", lambda match: rf" \cdot 10^{{{int(match[1])}}}", size)


def _summary(one: Summary, quantity: Node, write: _Write) -> str:
    target = write(symbol_of("accessory", one.accessory))
    of = {"maximum": r"\max_{\mathrm{phase}} ", "minimum": r"\min_{\mathrm{phase}} ",
          "time_of_maximum": r"\arg\max_{\mathrm{phase}} ", "time_of_minimum": r"\arg\min_{\mathrm{phase}} ",
          "integral": r"\int_{\mathrm{phase}} "}[one.kind]
    text = rf"\left({write(quantity)}\right)"
    return f"{target} &= {of}{text}" + (r" \, \mathrm{d} t" if one.kind == "integral" else "")


def _assigned(assignments: Assignments, write: _Write) -> str:
    return r", \; ".join(rf"{write(target)} \leftarrow {write(value)}" for target, value in assignments)


def _hook(when: str, assignments: Assignments, write: _Write) -> list[str]:
    return [rf"\text{{{when}:}} & \; {_assigned(assignments, write)}"] if assignments else []


def _history(model: Any, write: _Write) -> list[str]:
    known = ", \\; ".join(f"{write(state)} = {write(value)}" for state, value in model.history.items())
    return [rf"\text{{before the begin:}} & \; {known}"] if known else []


def _then(assignments: Assignments, write: _Write) -> str:
    return rf" \; \Rightarrow \; {_assigned(assignments, write)}" if assignments else ""


def _event(one: Event, write: _Write) -> str:
    often = f", the phase ends after {one.stop_after}" if one.stop_after else ""
    says = f"{_directions[one.direction]}{often}"
    return (rf"\text{{event {plain(str(one.name))}:}} & \; {write(one.function)} = 0"
            + (rf"\text{{{says}}}" if says else "") + _then(one.do, write))


def _stop(one: Stop, write: _Write, n: str) -> str:
    times = [write(time) for time in one.times]
    if one.every is None:
        at = rf"t = {', '.join(times)}" + (rf", \; {n} = 0, 1, \ldots" if one.by_number else "")
    else:
        endless = one.count.op == "constant" and one.count.value == float("inf")
        every, count = write(one.every), write(one.count)
        last = "" if endless else rf", \; {n} < {count}"
        at = rf"t = {times[0]} + {n} \left({every}\right), \; {n} = 0, 1, \ldots{last}"
    return rf"\text{{stop {plain(str(one.name))}:}} & \; {at}{_then(one.do, write)}"


def _trigger(one: Trigger, write: _Write) -> str:
    text = rf"\text{{trigger {plain(str(one.name))}:}} & \; {write(one.condition)}"
    if one.delay is not None:
        text += rf"\text{{, after }} {write(one.delay)}"
    if one.priority is not None:
        text += rf"\text{{, priority }} {write(one.priority)}"
    return text + _then(one.do, write)


def model_latex(as_given: Any, mass_matrix: Any) -> str:
    """The whole model, as it was given."""
    return _aligned(_lines(as_given, mass_matrix))


def _aligned(lines: Sequence[str]) -> str:
    return "\n".join([r"\begin{aligned}", " \\\\\n".join(lines), r"\end{aligned}"])


def model_html(model: Any, as_given: Any) -> str:
    """What a notebook shows of a model: its name, and its first lines, which MathJax sets."""
    lines = _lines(as_given, model.mass_matrix)
    more = f"<p>and {len(lines) - _shown} lines more: model.latex()</p>" if len(lines) > _shown else ""
    return f"<p>model {escape(model.name)}</p>$${escape(_aligned(lines[:_shown]))}$${more}"
