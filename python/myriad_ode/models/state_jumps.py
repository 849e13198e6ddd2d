# SPDX-License-Identifier: MIT
"""Jumps of equations where the state decides, which contribute nothing to derivatives: found, noted, and refused where
derivatives are to be right.

An operation that jumps, as a comparison in `where`, need not make the equations jump: `where(h > K, sqrt(h - K), 0)`
does not. Whether they do is looked at where the operation jumps: at points of its surface with otherwise random values,
the equations are evaluated with either of its values."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ..base.errors import Error
from ..symbolic import expression as ex, symbols as sym
from ..symbolic.delays import pasts_of
from ..symbolic.evaluate import evaluate
from ..symbolic.expression import make
from ..symbolic.node import symbols_of, text, walk
from ..symbolic.rewrite import rebuilt, replaced
from .recorded import RecordedModel

if TYPE_CHECKING:
    from ..symbolic.types import Array
    from .any_model import AnyModel

_comparisons = "less", "less_equal", "greater", "greater_equal"
_whole = "floor", "rint", "floor_divide"
_samples = 8
_cure = "give my.with_located_switches(model), whose steps end there, or write a transition that is continuous"


def jumps(model: AnyModel) -> list[str]:
    """What makes the equations of a traced model, or quantities of its summaries, jump where no step ends, as text."""
    if not isinstance(model, RecordedModel):
        return []
    if model.jumps_by_state is None:
        model.jumps_by_state = [text(node) for node in jumping(model)[1]]
    return model.jumps_by_state


def note(model: AnyModel) -> str | None:
    """What to know of derivatives of a model."""
    found = jumps(model)
    return found and f"{_where(found)}, and derivatives leave out what such jumps contribute: {_cure}" or None


def refuse(model: AnyModel, what: str) -> None:
    """Refuses derivatives that would be wrong; `what` there is not for this model."""
    if found := jumps(model):
        raise Error(f"there is no {what}, as {_where(found)}, and derivatives leave out what such jumps contribute: "
                    f"{_cure}")


def _where(found: Sequence[str]) -> str:
    several = [*(f"`{one}`" for one in found[:3]), *([f"{len(found) - 3} more"] if len(found) > 3 else [])]
    return f"the equations jump where {' and '.join(several)} changes"


def jumping(model: RecordedModel) -> tuple[list[Any], list[Any]]:
    """The equations and the quantities of summaries, and the operations in them that make them jump where no step ends:
    arguments before what is of them."""
    roots = rebuilt([*model.equations.values(), *(quantity for _, quantity in model.quantities_as_given)],
                    model.switches.times_of.without_copysign)
    moving = {sym.time, *(s for s, rate in model.equations.items() if not (rate.op == "constant" and rate.value == 0))}
    moving |= set(pasts_of(roots))
    located = model.switches.located
    return roots, [
        node for node in walk(roots) if (surface := _Surface.of(node)) is not None and node not in located
        and not moving.isdisjoint(symbols_of(surface.decisive))
        and _jumps(node, surface, [root for root in roots if node in set(walk([root]))], moving)]


class _Surface:
    """Where an operation jumps: where a function is zero, or a whole number plus a shift."""

    def __init__(self, function: Any, decisive: Sequence[Any], shift: float | None = None) -> None:
        self.function, self.decisive, self.shift = function, decisive, shift

    @staticmethod
    def of(node: Any) -> _Surface | None:
        """That of an operation; None for one that does not jump."""
        if node.value == ex.continuous:
            return None
        if node.op in _comparisons:
            return _Surface(ex.subtract(*node.args), node.args)
        if node.op == "copysign":
            return _Surface(node.args[1], node.args[1:])
        if node.op in _whole or node.op in ("floor_mod", "fmod"):
            inside = node.args[0] if len(node.args) == 1 else ex.divide(*node.args)
            return _Surface(inside, node.args, 0.5 if node.op == "rint" else 0.0)
        return None

    def values(self, node: Any, at: Mapping[Any, Array], whole: Array) -> tuple[Any, Any]:
        """Those of the operation on either side."""
        if node.op in _comparisons:
            return True, False
        if node.op in _whole:
            return whole, whole - 1.0
        first, second = evaluate(node.args, at)
        if node.op == "copysign":
            return np.abs(first), -np.abs(first)
        return 0.0, second if node.op == "floor_mod" else np.copysign(second, first)


def _jumps(node: Any, surface: _Surface, roots: Sequence[Any], moving: set[Any]) -> bool:
    """Whether expressions jump where an operation in them does."""
    random = np.random.default_rng(1)
    symbols = dict.fromkeys(symbols_of([*roots, *node.args]))
    at: dict[Any, Array] = {s: random.uniform(0.3, 3.0, (_samples, 1)) if s.type == ex.real else
                            random.integers(0, 3, (_samples, 1)) for s in symbols}
    whole = np.zeros((_samples, 1))
    if surface.shift is not None:
        near = np.broadcast_to(evaluate([surface.function], at)[0], whole.shape)
        whole = np.floor(np.where(np.isfinite(near), near, 0.0) - surface.shift) + 1.0
    for symbol in symbols_of([surface.function]):
        if symbol not in moving:
            continue
        zero = _zero(surface, node, symbol, at, whole)
        if not np.isfinite(zero).any():
            continue
        # A jump is about as large beside the surface as on it; what is continuous is much larger there, even a root.
        beside = np.fmax(*(_difference(node, surface, roots, {**at, symbol: zero + by * (np.abs(zero) + 1e-3)},
                                       whole)[0] for by in (-1e-8, 1e-8)))
        known = False
        for found in (zero, np.nextafter(zero, -np.inf), np.nextafter(zero, np.inf)):  # others may decide there too
            on, size = _difference(node, surface, roots, {**at, symbol: found}, whole)
            valid = np.isfinite(on)
            if (valid & (on > 1e-13 * size) & ~(on <= 0.1 * beside)).any():
                return True
            known = known or bool(valid.any())
        if known:
            return False
    return True  # who knows


def _difference(node: Any, surface: _Surface, roots: Sequence[Any], at: Mapping[Any, Array],
                whole: Array) -> tuple[Array, Array]:
    """By how much expressions differ between the values of an operation on either side, and how large they are."""
    forced = make("symbol", value=("forced", "value"), type=node.type)
    with_value = replaced(list(roots), {node: forced})
    first, second = (np.array(np.broadcast_arrays(*evaluate(with_value, {**at, forced: value}), whole)[:-1], float)
                     for value in surface.values(node, at, whole))
    with np.errstate(all="ignore"):
        return np.abs(first - second), np.abs(first) + np.abs(second)


def _zero(surface: _Surface, node: Any, symbol: Any, at: Mapping[Any, Array], whole: Array) -> Array:
    """Values of a symbol at which an operation jumps, NaN where none is found."""
    for one, other in (node.args, node.args[::-1]) if node.op in _comparisons else ():
        if one is symbol and symbol not in set(symbols_of([other])):
            return np.array(np.broadcast_to(evaluate([other], at)[0], whole.shape), float)
    target = 0.0 if surface.shift is None else whole + surface.shift

    def function(values: Array) -> Array:
        with np.errstate(all="ignore"):
            found = np.asarray(evaluate([surface.function], {**at, symbol: values})[0], float) - target
        return np.broadcast_to(found, values.shape)

    far = np.geomspace(1e-3, 1e200, 400)
    grid = np.broadcast_to(np.unique([*-far, *np.linspace(-10.0, 10.0, 402), *far]), (_samples, 1202))
    positive, known = function(grid) > 0, np.isfinite(function(grid))
    crossed = (positive[:, 1:] != positive[:, :-1]) & known[:, 1:] & known[:, :-1]
    # the first that is found from the middle on, as values far away mean little
    order = np.argsort(np.abs(grid[0, 1:]), kind="stable")
    place = order[np.argmax(crossed[:, order], axis=1)][:, None]
    low, high = (np.take_along_axis(grid, place + by, axis=1) for by in (0, 1))
    begins = np.take_along_axis(positive, place, axis=1)
    for _ in range(1100):
        middle = 0.5 * low + 0.5 * high
        if ((middle == low) | (middle == high)).all():
            break
        same = (function(middle) > 0) == begins
        low, high = np.where(same, middle, low), np.where(same, high, middle)
    return np.where(crossed.any(axis=1)[:, None], high, np.nan)
