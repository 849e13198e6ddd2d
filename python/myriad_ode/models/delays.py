# SPDX-License-Identifier: MIT
"""The delayed values that a model reads, what they are before the begin, and what models with delays may not have."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

from ..base.errors import Error, at, users_line
from ..symbolic import symbols as sym
from ..symbolic.delays import pasts_of
from ..symbolic.node import symbols_of, text
from .methods import default, fixed_step, stochastic

if TYPE_CHECKING:
    from ..symbolic.types import ByComponent
    from .any_model import AnyModel
    from .reader import Reader


class Delay(NamedTuple):
    """A delayed value: its name in C++, its symbol, and of that the name of the state, the lag, whether the lag is
    constant in a phase, and whether it is the slope of the state."""

    name: str
    symbol: Any
    state: str
    lag: Any
    is_constant: bool
    is_slope: bool


def delays_of(symbols: Sequence[Any]) -> list[Delay]:
    """Delayed values of a model from their symbols, one state after the other; without names."""
    states = list(dict.fromkeys(symbol.value[1].state for symbol in symbols))
    pasts = [(symbol, symbol.value[1]) for symbol in symbols]
    return [Delay("", symbol, state.value[1], past.lag, past.has_constant_lag, past.is_slope)
            for state in states for symbol, past in pasts if past.state is state]


def first_of_lag(delays: Sequence[Delay]) -> list[int]:
    """Of each delayed value the number of the first one that is as long ago; slopes have lags of their own."""
    first: dict[tuple[int, bool], int] = {}
    return [first.setdefault((id(one.lag), one.is_slope), j) for j, one in enumerate(delays)]


def read_history(reader: Reader, given: ByComponent | None, states: Sequence[Any]) -> dict[Any, Any]:
    """What states were before the begin, as {state: expression of time, parameters and shared values}."""
    found: dict[Any, Any] = {}
    for key, value in reader.items(given, "history"):
        state = reader.target(key, "history")
        if not any(state is one for one in states):
            raise Error(f"history has '{state.value[1]}'{at(reader.line)}, which is no state: there are "
                        f"{', '.join(one.value[1] for one in states)}")
        if state in found:
            raise Error(f"'{state.value[1]}' is given twice in history{at(reader.line)}: give it once")
        what = f"the history of {state.value[1]}"
        found[state] = reader.expression(value, what)
        for symbol in symbols_of([found[state]]):
            if symbol is not sym.time and symbol.value[0] not in ("parameter", "shared", "shared_integer"):
                raise Error(f"{what}{at(reader.line)} reads {symbol.value[1]}: it is an expression of time, parameters "
                            "and shared values")
    return found


#: What a model with delays has besides what users name.
own_names = ("delayed", "n_delayed", "delayed_state", "is_delayed_slope", "same_lag", "lag", "history", "has_history")


def check(model: Any) -> None:
    """Refuses delayed values where they are not known, and what a model with delays may not have."""
    line = at(model.line)
    if (past := next(iter(pasts_of([e for _, e in model.generate])), None)) is not None:
        raise Error(f"generate reads `{text(past)}`{line}, before there is any past: let it set a parameter that the "
                    "history reads")
    if not model.delays:
        if model.history:
            raise Error(f"history is given{line}, and the model has no delays: read the past by my.delayed(x, tau), or "
                        "leave it out")
        return
    if model.noise is not None:
        raise Error(f"a model with noise has no delays yet{line}: leave out noise=, or give the model without delays")
    if model.mass_matrix is not None:
        raise Error(f"a model with a mass matrix has no delays yet{line}: divide its "
                    "equations by what stands before their derivatives")
    units = model.units_of_states
    if units is not None and (units.threads_per_instance or 1) > 1 and not all(d.is_constant for d in model.delays):
        raise Error(f"threads_per_instance is {units.threads_per_instance}{line}, and teams of threads take no units "
                    "whose delays depend on time or state: leave it out, and one thread integrates an instance")
    _check_lags(model)


def _check_lags(model: Any) -> None:
    """Refuses lags that change within a phase although they look constant."""
    changing = {target for what, assignments in model._hooks if what not in ("initialise", "finalise")
                for target, _ in assignments}
    for one in model.delays:
        if pasts_of([one.lag]):
            raise Error(f"the lag of `{text(one.symbol)}` reads the past itself{at(model.line)}, which is for outputs "
                        "of files alone: give a lag of parameters, time and states of now")
        for symbol in symbols_of([one.lag]):
            if one.is_constant and symbol in changing:
                raise Error(f"the lag of `{text(one.symbol)}` reads {symbol.value[1]}{at(model.line)}, which an action "
                            "assigns: a lag of parameters is constant in a phase; a state with the derivative 0 may "
                            "change")


def refuse(model: AnyModel, what: str, instead: str = "solve it for several values") -> None:
    """Refuses what models with delays have not."""
    if model.delays:
        raise Error(f"the model has delays, and {what} of such models are not there yet{at(users_line())}: {instead}")


def refuse_derivatives(model: AnyModel, what: str) -> None:
    """Refuses derivatives by the library's dual numbers of what has none."""
    if model.delays and model.triggers:
        raise Error(f"the model has delays and triggers{at(users_line())}, and {what} of such models are not there "
                    "yet: give events actions of their own, or solve it for several values")
    slope = next((one for one in model.delays or () if one.is_slope), None)
    if slope is not None:
        raise Error(f"the model reads `{text(slope.symbol)}`{at(users_line())}, and {what} of models that read slopes "
                    "of their past are not there yet: solve it for several values")


def refuse_history_steps(model: AnyModel, steps: Any) -> None:
    """Refuses the option for a model that keeps no past."""
    if model.delays is not None and not model.delays and steps != 0:
        raise Error(f"history_steps is {steps!r}, and the model has no delays, whose past it is for: leave it out")


def refuse_method(model: AnyModel, method: str) -> None:
    """Refuses a method that does not take the model's delays."""
    if model.delays and model.has_neighbours and method in fixed_step and not all(d.is_constant for d in model.delays):
        raise Error(f"a lag of the model depends on time or state, and tangents and sensitivities of such models need "
                    f"steps that end where jumps of the past arrive, which those of {method} do not: give an adaptive "
                    f"method, such as \"{default}\"")
    if model.delays and method in stochastic:
        raise Error(f"the model has delays, which {method} does not take: give a method for ordinary equations, such "
                    f"as \"{default}\"")
