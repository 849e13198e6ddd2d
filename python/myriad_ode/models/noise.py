# SPDX-License-Identifier: MIT
"""The noise of a model: the factors of the Wiener processes in dx = f dt + g dW, and the methods that take them."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any

from ..base.errors import Error, at
from ..symbolic import symbols as sym
from ..symbolic.derivatives import dependencies
from ..symbolic.expression import constant
from ..symbolic.node import Node, text
from ..symbolic.numbers import is_whole
from ..symbolic.types import NotGiven
from .delays import refuse_method
from .methods import (adaptive_on_paths, additive_noise, choices_of, default, diagonal_noise, fixed_step, halving,
                      methods, pathless, stiff, stochastic)

if TYPE_CHECKING:
    from ..symbolic.expression import Expression
    from ..symbolic.types import ByComponent
    from .any_model import AnyModel
    from .reader import Reader

_most_processes = {"double": 256, "float": 512}  # as in the C++ library, whose counters have room for these


def is_zero(factor: Node) -> bool:
    """Whether a factor is left out."""
    return factor.op == "constant" and factor.value == 0


class Noise:
    """Factors, a row for each state. `processes` are the Wiener processes that states share, a factor in a row for
    each; without them each state has a process and a factor of its own."""

    def __init__(self, states: Sequence[Node], processes: Sequence[Node], rows: Sequence[Sequence[Expression]]) -> None:
        self.states, self.processes, self.rows = states, processes, rows

    @property
    def names(self) -> list[str]:
        """The names of the processes that states share."""
        return [process.value[1] for process in self.processes]

    @property
    def count(self) -> int:
        """The number of Wiener processes."""
        return len(self.processes or self.states)

    @property
    def factors(self) -> list[Expression]:
        """All factors, row after row."""
        return [factor for row in self.rows for factor in row]

    def with_factors(self, factors: Sequence[Expression]) -> Noise:
        """The same noise with other factors."""
        n = len(self.processes) or 1
        return Noise(self.states, self.processes, [factors[i * n:(i + 1) * n] for i in range(len(self.states))])

    @property
    def noisy_states(self) -> list[Node]:
        """The states that have noise."""
        return [state for state, row in zip(self.states, self.rows) if not all(map(is_zero, row))]

    def terms(self, number: int) -> list[tuple[Expression, Node | None]]:
        """The factors in the equation of a state, each with its process, or None for the state's own."""
        of: Sequence[Node | None] = self.processes or [None]
        return [(factor, process) for factor, process in zip(self.rows[number], of) if not is_zero(factor)]

    def _read_by(self, number: int) -> set[int]:
        """The numbers of the states that the factors of one depend on."""
        return {read for of_factor in dependencies(self.rows[number], self.states) for read in of_factor}

    @property
    def is_additive(self) -> bool:
        """Whether no factor depends on a state."""
        return self.dependent is None

    @property
    def crossing(self) -> tuple[str, str] | None:
        """A state and another one that its factor depends on, if there are such."""
        names = [state.value[1] for state in self.states]
        return next(((names[i], names[j]) for i in range(len(names)) for j in sorted(self._read_by(i)) if i != j), None)

    @property
    def dependent(self) -> str | None:
        """A state that a factor depends on, if there is one."""
        read = set().union(*map(self._read_by, range(len(self.states))))
        return self.states[min(read)].value[1] if read else None


def read_noise(reader: Reader, given: ByComponent | None, states: Sequence[Node]) -> Noise | None:
    """The noise that was given, {state: factor}, or {state: {process: factor}}, for the states in their order."""
    found: dict[Node, Any] = {}
    known = set(states)
    for key, value in reader.items(given, "noise"):
        state = reader.target(key, "noise")
        if state not in known:
            raise Error(f"noise has a factor of '{state.value[1]}'{at(reader.line)}, which is no state: there are "
                        f"{', '.join(s.value[1] for s in states)}")
        if state in found:
            raise Error(f"'{state.value[1]}' is given twice in noise{at(reader.line)}: give it once")
        found[state] = value
    if not found:
        return None
    shared = {state: hasattr(value, "items") for state, value in found.items()}
    if not any(shared.values()):
        zero = constant(0.0)
        return Noise(states, [], [[_factor(reader, found[s], s) if s in found else zero] for s in states])
    if not all(shared.values()):
        own, named = (next(s.value[1] for s in found if shared[s] is kind) for kind in (False, True))
        raise Error(f"noise has a factor of {own}, for a Wiener process of its own, and names processes of "
                    f"{named}{at(reader.line)}: name them for all, as in {{{own}: {{W: factor}}}}")
    return _shared(reader, found, states)


def _shared(reader: Reader, found: dict[Node, Any], states: Sequence[Node]) -> Noise:
    """Noise of named processes, which are numbered in the order in which they are named."""
    rows: dict[Node, dict[Node, Expression]] = {}
    for state, factors in found.items():
        rows[state] = {}
        for key, factor in factors.items():
            process = sym.symbol("noise", key) if isinstance(key, str) else key
            if not isinstance(process, Node) or process.op != "symbol" or process.value[0] != "noise":
                shown = text(key) if isinstance(key, Node) else repr(key)
                raise Error(f"the noise of {state.value[1]} has a factor of {shown}{at(reader.line)}: name Wiener "
                            "processes, as from my.wiener(\"W1 W2\")")
            if process in rows[state]:
                raise Error(f"'{process.value[1]}' is given twice in the noise of {state.value[1]}{at(reader.line)}: "
                            "give it once")
            rows[state][process] = _factor(reader, factor, state)
    processes = list(dict.fromkeys(process for row in rows.values() for process in row))
    if not processes:
        raise Error(f"noise names no Wiener process{at(reader.line)}: give factors, as in {{x: {{W: factor}}}}")
    zero = constant(0.0)
    return Noise(states, processes, [[rows.get(s, {}).get(process, zero) for process in processes] for s in states])


def _factor(reader: Reader, given: Any, state: Node) -> Expression:
    return reader.expression(given, f"the noise of {state.value[1]}")


def refuse_symbols(symbols: Iterable[Node], line: tuple[str, int] | None) -> None:
    """Refuses Wiener processes in expressions and assignments."""
    for symbol in symbols:
        if symbol.value[0] == "noise":
            name = symbol.value[1]
            raise Error(f"the Wiener process {name} stands in an expression or is assigned{at(line)}, and is a key of "
                        f"noise= alone: noise={{x: {{{name}: factor}}}}; a state with the noise 1 and the slope 0 has "
                        "its value")


def refuse_parts(model: Any) -> None:
    """Refuses what a model with noise may not have."""
    what, instead = "", ""
    if model.triggers:
        what = "triggers"
        instead = ("its paths are too rough for conditions that come to hold; give it events, or look for a condition "
                   "at the ends of steps, in after_step")
    elif any(one.kind == "integral" for one in model.summaries):
        what, instead = "integrals over a phase", "give an integral a state of its own"
    elif model.summaries and model.events:
        what = "extrema over a phase beside events"
        instead = ("an event and an extreme would not know of each other within a step; take extrema in after_step")
    elif model.mass_matrix is not None:
        what, instead = "mass matrix", "divide its equations by what stands before their derivatives"
    elif model.writes_time_domain:
        what, instead = "hooks that assign t_begin or t_end", "its paths count time from t_begin"
    if what:
        raise Error(f"a model with noise has no {what} yet{at(model.line)}: {instead}")


def refuse_derivatives(model: AnyModel, what: str) -> None:
    """Refuses derivatives of a model with noise."""
    if model.has_noise:
        raise Error(f"the model has noise, and {what} along its paths are not there yet: solve it for several values, "
                    "with the same seed= along the same paths")


def method_for(model: AnyModel, method: str | None, precision: str) -> str:
    """The method of a call, or the default for the model. Refuses one that does not take the model's noise."""
    if method is None:
        method = stochastic[0] if model.has_noise else default
    refuse_method(model, method)
    if model.has_noise is None or method not in methods:  # only a compiler knows; others refuse it
        return method
    if not model.has_noise:
        if method in stochastic:
            raise Error(f"{method} is for equations with noise, and the model has none: give noise= of my.model, or a "
                        f"method for ordinary equations, such as \"{default}\"")
        return method
    if method not in stochastic:
        *most, last = (f'"{one}"' for one in stochastic)
        raise Error(f"the model has noise, which {method} would ignore: give method={', '.join(most)} or {last}")
    noise, most_of = model.noise, _most_processes[precision]
    if noise.count > most_of:
        raise Error(f"the model has {noise.count} Wiener processes, and there may be {most_of} in {precision} "
                    "precision: let states share some")
    if method in pathless and (model.events or model.summaries):
        raise Error(f"{method} follows no path, so that between the ends of a step there is nothing for the model's "
                    f"{'events' if model.events else 'extrema'} to be found on: give method=\"euler_maruyama\", or "
                    "another one with a strong order")
    if method in stiff and (model.events or model.summaries):
        raise Error(f"{method} is for steps in which a stiff drift undoes the noise, and the model's "
                    f"{'events' if model.events else 'extrema'} are found within steps as if it did not: give "
                    "method=\"euler_maruyama\", with steps that resolve the drift")
    if method in additive_noise and noise.dependent is not None:
        raise Error(f"{method} takes noise that depends on no state, and that of the model depends on "
                    f"{noise.dependent}: give method=\"euler_maruyama\", or \"sriw1\" for diagonal noise")
    if method in diagonal_noise and noise.dependent is not None:
        otherwise = ("give method=\"euler_maruyama\", or \"stochastic_heun\" for the Stratonovich equation")
        if noise.processes:
            raise Error(f"{method} takes a Wiener process for each state, and the model names processes, which states "
                        f"may share: {otherwise}")
        if (both := noise.crossing) is not None:
            raise Error(f"{method} takes noise whose factor of a state depends on no other state, and that of "
                        f"{both[0]} depends on {both[1]}: {otherwise}")
    return method


def control_for(model: AnyModel, method: str, control: str | Sequence[str], options: Any) -> Any:
    """The control of a call: that by halving and doubling where a method for noise has tolerances and no step. Refuses
    a method for fixed steps that has no step."""
    if halving in choices_of(control):
        raise Error(f"there is no step-size control {halving!r}: leave out step=, and give rtol= and atol=")
    if method not in fixed_step or options.step is not None:
        return control
    if method not in adaptive_on_paths:
        raise Error(f"{method} takes fixed steps: give step=")
    if isinstance(options.rtol, NotGiven) and isinstance(options.atol, NotGiven):
        raise Error(f"{method} takes fixed steps or adaptive ones: give step=, or rtol= and atol=")
    if control:
        raise Error("adaptive steps along a path are halved and doubled, and have no other control: leave out control=")
    if model.has_noise is not None and (model.events or model.summaries):
        raise Error(f"the model's {'events' if model.events else 'extrema'} are so far found only with fixed steps: "
                    "give step= instead of tolerances")
    return (halving,)


def refuse_options_of_paths(method: str, seed: int, noise_step: float) -> None:
    """Refuses options of paths for a method that follows none."""
    for name, value in (("seed", seed), ("noise_step", noise_step)):
        if method not in stochastic and value != 0:
            raise Error(f"{name} is {value!r}, and the model has no noise, whose paths it is for: leave it out")


def count_of_paths(model: AnyModel, paths: Any) -> int:
    """The number of paths of each instance of a sweep."""
    if model.has_noise is False:
        raise Error(f"paths is {paths!r}, and the model has no noise, so that all would be the same: leave it out")
    if not is_whole(paths, 1):
        raise Error(f"paths is {paths!r}: give the number of paths of each instance of the sweep, 1 or more")
    return int(paths)


def equation_texts(model: Any, sides: Sequence[str], equations: Iterable[Expression]) -> list[str]:
    """The equations as text: "x' = ..." by their left sides, or with noise "dx = (...) dt + (...) dW_x"."""
    if model.noise is None:
        return [f"{side} = {text(e)}" for side, e in zip(sides, equations)]
    written = []
    for number, (state, drift) in enumerate(zip(model.states, equations)):
        terms = [] if is_zero(drift) else [f"{_in_product(drift)} dt"]
        for factor, process in model.noise.terms(number):
            of = f"dW_{state}" if process is None else f"d{process.value[1]}"
            terms.append(of if factor.op == "constant" and factor.value == 1 else f"{_in_product(factor)} {of}")
        written.append(f"d{state} = {' + '.join(terms) or 0}")
    return written


def is_factor(factor: Node) -> bool:
    """Whether an expression needs no parentheses in a product."""
    return not factor.args and not (factor.op == "constant" and factor.value < 0)


def _in_product(factor: Node) -> str:
    return text(factor) if is_factor(factor) else f"({text(factor)})"
