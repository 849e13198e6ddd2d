# SPDX-License-Identifier: MIT
"""Values of the past in expressions: a delayed value is a symbol, of a state and of how long ago, its lag."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ..base.errors import Error, at, users_line
from . import symbols as sym
from .expression import as_node, as_number, is_number, make, to_real
from .node import Node, symbols_of, text
from .rewrite import replaced
from .vectors import elementwise

if TYPE_CHECKING:
    from .types import Values

__all__ = ["delayed", "delayed_slope"]

_constants = ("parameter", "shared", "shared_integer")


class Past:
    """What a delayed value is: that of a state, or its derivative by time, a lag ago. Equal ones are one symbol."""

    __slots__ = ("state", "lag", "is_slope")

    def __init__(self, state: Any, lag: Any, is_slope: bool = False) -> None:
        self.state, self.lag, self.is_slope = state, lag, is_slope

    def __eq__(self, other: object) -> bool:
        return (isinstance(other, Past) and self.state is other.state and self.lag is other.lag
                and self.is_slope == other.is_slope)

    def __hash__(self) -> int:
        return hash((id(self.state), id(self.lag), self.is_slope))

    def __str__(self) -> str:
        return f"delayed{'_slope' if self.is_slope else ''}({text(self.state)}, {text(self.lag)})"

    __repr__ = __str__

    @property
    def has_constant_lag(self) -> bool:
        """Whether parameters and shared values alone decide the lag."""
        return all(symbol.value[0] in _constants for symbol in symbols_of([self.lag]))


def past(state: Any, lag: Any, is_slope: bool = False) -> Any:
    """The symbol of a delayed value."""
    return make("symbol", value=("delayed", Past(state, lag, is_slope)))


def pasts_of(roots: Iterable[Node]) -> list[Node]:
    """The delayed values in some expressions, in the order in which they are first needed, behind those in their
    lags."""
    found: dict[Node, None] = {}
    for symbol in symbols_of(roots):
        if symbol.value[0] == "delayed":
            found |= dict.fromkeys([*pasts_of([symbol.value[1].lag]), symbol])
    return list(found)


def read_now_or_then(roots: Sequence[Node]) -> set[Any]:
    """The symbols that some expressions depend on, and the states and lags of delayed values."""
    pasts = [symbol.value[1] for symbol in pasts_of(roots)]
    return {*symbols_of([*roots, *(past.lag for past in pasts)]), *(past.state for past in pasts)}


def delayed(expression: Any, lag: Values) -> Any:
    """The value that an expression had a time `lag` ago: `my.delayed(x, tau)` is x(t - tau). States and the time in it
    are those of then, parameters those of now. The lag is a positive number or an expression of parameters and shared
    values; or one of time and states too, which costs more. Equations, events and hooks may read it. Before the begin a
    state has its `history=` of `my.model`, or else its initial value. Of an array each element is delayed."""
    if any(isinstance(one, (list, tuple)) or isinstance(one, np.ndarray) and one.ndim for one in (expression, lag)):
        return elementwise(delayed, expression, lag)
    by = _checked(to_real(as_number(lag)))
    node: Any = as_node(expression)
    values: dict[Any, Any] = {}
    for symbol in symbols_of([node]):
        kind = symbol.value[0]
        if symbol is sym.time:
            values[symbol] = sym.time - by
        elif kind == "state":
            values[symbol] = past(symbol, by)
        elif kind == "delayed":
            values[symbol] = _further(symbol.value[1], by)
        elif kind not in _constants:
            raise Error(f"`{text(node)}` is delayed{at(users_line())}, and the past of {symbol.value[1]} is not kept: "
                        "delay expressions of states, time and parameters; a state with the derivative 0 keeps what "
                        "actions assign")
    return replaced([node], values)[0]


def delayed_slope(state: Any, lag: Values) -> Any:
    """The derivative by time that a state had a time `lag` ago: `my.delayed_slope(x, tau)` is x'(t - tau), as neutral
    equations read it. The lag is one of `my.delayed`. It is the derivative of the method's interpolant, and before the
    begin that of the state's `history=`, or else zero. At a jump of the state itself it is what is on either side: the
    jump is not passed on. Of an array each element is delayed."""
    if any(isinstance(one, (list, tuple)) or isinstance(one, np.ndarray) and one.ndim for one in (state, lag)):
        return elementwise(delayed_slope, state, lag)
    by = _checked(to_real(as_number(lag)))
    node: Any = as_node(state)
    if node.op != "symbol" or node.value[0] != "state":
        raise Error(f"delayed_slope({text(node)}, ...){at(users_line())}: only the slopes of states are kept: give a "
                    "state, and write those of other expressions by the chain rule")
    return past(node, by, True)


def _checked(lag: Any) -> Any:
    """The lag of a delayed value. Refuses one that cannot be."""
    if is_number(lag) and not 0 < lag.value < math.inf:
        raise Error(f"a value is delayed by {text(lag)}{at(users_line())}: the lag is how long ago, a positive and "
                    "finite time")
    for symbol in symbols_of([lag]):
        kind, name = symbol.value
        if kind not in ("state", "delayed", *_constants) and symbol is not sym.time:
            raise Error(f"the lag `{text(lag)}` reads {name}{at(users_line())}: a lag is made of parameters, shared "
                        "values, time and states")
    return lag


def _further(inner: Past, lag: Any) -> Any:
    """A delayed value, delayed again."""
    if not inner.has_constant_lag:
        raise Error(f"`{inner}` is delayed again{at(users_line())}, and its lag depends on time or states, of which it "
                    "would be that of then: give it a lag of parameters and shared values")
    return past(inner.state, inner.lag + lag, inner.is_slope)
