# SPDX-License-Identifier: MIT
"""Triggers that do what an event does, for what knows events alone: tangents and adjoints."""

from __future__ import annotations

from typing import TypeVar

from .event import Event
from .recorded import RecordedModel

Recorded = TypeVar("Recorded", bound=RecordedModel)


def with_events(model: Recorded) -> Recorded | None:
    """The model with an event in the place of each trigger; None where a trigger does more than an event: waits, has
    several comparisons, or counts as false before the start."""
    functions = {event.name: event.function for event in model.events}
    events: list[Event] = []
    of_triggers: set[str] = set()
    for one in model.triggers:
        rises = one.condition.op != "not"
        condition = one.condition if rises else one.condition.args[0]
        if not one.initial_value or condition.op != "symbol" or condition.value[0] != "side":
            return None
        name = condition.value[1]
        events.append(Event(functions[name], one.name, "rising" if rises else "falling", None, 0, one.do))
        of_triggers.add(name)
    if model.queue is not None:
        return None
    made = model.changeable()
    made.triggers, made.edges = [], []
    made.events = [*(event for event in model.events if event.name not in of_triggers), *events]
    return made
