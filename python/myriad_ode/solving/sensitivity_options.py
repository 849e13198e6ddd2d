# SPDX-License-Identifier: MIT
"""What a call of `solve` means for a model with sensitivities: its options, and where derivatives start."""

from __future__ import annotations

import dataclasses
from collections.abc import Collection, Mapping
from typing import TYPE_CHECKING, Any

from ..base.errors import Error
from ..models.components import Components, by_component, listed
from ..models.sensitivities import WithSensitivities, ends_of_domain
from ..sweeps.inputs import real
from ..symbolic import folding
from ..symbolic.derivatives import derivatives
from ..symbolic.node import symbols_of
from ..symbolic.symbols import t_begin, time
from .core_options import per_state

if TYPE_CHECKING:
    from .options import Options

_not_controlled = 1e30  # a tolerance that no error exceeds


def _derivatives_of(model: WithSensitivities, chosen: Any, components: Components) -> list[Any]:
    """Some components and their derivatives."""
    given = listed(chosen)
    names = [components.component(one) for one in given]
    have = [n for n in names if components.place.get(n, ("",))[0] in ("state", "accessory")]
    return [*given, *(f"{n}_by_{k}" for k in model.free for n in have if f"{n}_by_{k}" in components.place)]


def with_derivatives(model: WithSensitivities, given: Options, components: Components) -> Options:
    """The options of a call of the model alone as those of the model with sensitivities: their records, samples and
    tolerances."""
    record, samples = given.record, given.samples
    if record is not None:
        chosen = dict(record) if isinstance(record, Mapping) else {"states": record}
        for key in ("states", "accessories"):
            if key in chosen:
                chosen[key] = _derivatives_of(model, chosen[key], components)
        if chosen.get("time"):  # whose derivatives outputs need
            chosen["accessories"] = [*chosen.get("accessories", ()), *(f"time_by_{k}" for k in model.free)]
        record = chosen
    if isinstance(samples, Mapping) and "states" in samples:
        samples = {**samples, "states": _derivatives_of(model, samples["states"], components)}
    rtol = _tolerances(model, given.rtol, components, "rtol")
    atol = _tolerances(model, given.atol, components, "atol")
    return dataclasses.replace(given, record=record, samples=samples, rtol=rtol, atol=atol)


def _tolerances(model: WithSensitivities, value: Any, components: Components, name: str) -> list[float]:
    """Those of the model's states, and of their derivatives the same, or those that a dict names."""
    named = by_component(value, name) if hasattr(value, "items") else {}
    derivatives_of = components.states[model.n_original:]
    own = {c: t for c, t in named.items() if c not in derivatives_of} if hasattr(value, "items") else value
    of_states = per_state(own, Components(model.model), name, model.n_original)
    if len(of_states) == 1:
        of_states = of_states * model.n_original
    of_derivatives = dict(zip(derivatives_of, of_states * len(model.free)))
    of_derivatives.update((c, real(t, f"{name} of '{c}'")) for c, t in named.items() if c in of_derivatives)
    return [*of_states, *(t if model.control else _not_controlled for t in of_derivatives.values())]


def start_derivatives(model: WithSensitivities, given: Collection[str]) -> dict[str, Any]:
    """The derivatives of initial values that follow from components that sensitivities are by, as defaults of the
    derivatives at the start; refuses parameters that follow from them."""
    own = Components(model.model)
    starts_with = {k: "t" if k == ends_of_domain[t_begin] else k for k in model.free}  # what defaults read
    for name in own.of(("parameter", "shared")):
        if name not in model.free and own.follows(name, starts_with.values(), given):
            raise Error(f"the value of '{name}' follows from components that sensitivities are by: give it in the "
                        "sweep")
    found: dict[str, Any] = {}

    def derivative(name: str, k: str) -> Any:
        if name in given or name in model.free or not own.follows(name, [starts_with[k]], given):
            return folding.constant(float(name == k))
        default = own.defaults[name]
        by_time = k == ends_of_domain[t_begin]
        symbols = [s for s in symbols_of([default]) if by_time or s is not time]
        partials = derivatives([default], symbols)
        if partials is None:
            raise Error(f"the initial value of '{name}' looks up a table and has no derivatives: give it in start=")
        return folding.total([folding.multiply(folding.number(partial), folding.constant(1.0) if symbols[i] is time
                                               else derivative(symbols[i].value[1], k))
                              for i, partial in partials[0].items()])

    for name in own.of(("state", "accessory")):
        if name not in given and name not in model.free:
            found |= {f"{name}_by_{k}": derivative(name, k)
                      for k in model.free if own.follows(name, [starts_with[k]], given)}
    return found
