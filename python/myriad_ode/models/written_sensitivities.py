# SPDX-License-Identifier: MIT
"""The variational equations of a traced model as equations of a larger one, for the interpreter, which has no dual
numbers: s' = (df/dy) s + df/dk for each component k (Hairer, Norsett and Wanner, Solving Ordinary Differential
Equations I, ch. I.14)."""

from __future__ import annotations

from ..symbolic import symbols as sym
from ..symbolic.derivatives import directional
from ..symbolic.expression import constant
from .any_model import names_of
from .recorded import RecordedModel
from .sensitivities import WithSensitivities, ends_of_domain


def written_out(model: WithSensitivities) -> RecordedModel | str:
    """The model with its derivatives as states, whose components have the same names; or why it cannot be written so:
    only equations are, and no action that moves neighbouring solutions at another time."""
    own = model.model
    if not isinstance(own, RecordedModel):
        return own.not_interpreted
    if set(model.free) & {*ends_of_domain.values()}:
        return "it has sensitivities by an end of the time domain"
    hooks = own.initialise or own.after_step or own.finalise
    if hooks or own.events or own.stops or own.triggers or names_of(own)["accessory"]:
        return "it has sensitivities, and events, stops, triggers, hooks or accessories"
    if own.delays:
        return "it has sensitivities, and delays"
    states = [sym.symbol("state", name) for name in own.states]
    made = own.changeable()
    made.units_of_states = None
    made.rhs, made.states = list(own.rhs), list(own.states)
    for name, (kind, _) in zip(model.free, model.places):
        moving = [sym.symbol("state", f"{state}_by_{name}") for state in own.states]
        by_itself = [] if kind == "state" else [sym.symbol(kind, name)]
        slopes = directional(own.rhs, [*states, *by_itself], [*moving, *(constant(1.0) for _ in by_itself)])
        if slopes is None:
            return "it has sensitivities, and looks up a table"
        made.rhs += slopes
        made.states += [one.value[1] for one in moving]
    added = [sym.symbol("accessory", name) for name in names_of(model)["accessory"]]
    made.initialise = [(one, sym.time if one.value[1] == "time_of_event" else constant(0.0)) for one in added]
    made._collect([sym.symbol("state", name) for name in made.states])
    return made
