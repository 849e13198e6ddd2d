# SPDX-License-Identifier: MIT
"""Models that the C++ library makes of others by adding components: with tangents, with sensitivities."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from ..base.errors import Error, at, users_line
from .any_model import AnyModel, names_of


class Extended(AnyModel):
    """A model with components behind its own, `added` by kind, and defaults of them. `what` adds them."""

    has_neighbours = True

    def __init__(self, model: AnyModel, added: Mapping[str, list[str]], defaults: Mapping[str, Any], what: str) -> None:
        self.model, self.name = model, model.name
        names = {kind: [*known, *added.get(kind, ())] for kind, known in names_of(model).items()}
        self._set_names(names)
        self.events, self.triggers, self.edges = model.events, model.triggers, model.edges
        self.has_noise, self.delays = model.has_noise, model.delays
        self.generate, self.writes_parameters = model.generate, model.writes_parameters
        self.has_doses = model.has_doses
        every = [name for of_kind in names.values() for name in of_kind]
        twice = next((name for name in every if every.count(name) > 1), None)
        if twice is not None:
            raise Error(f"the model has a component '{twice}'{at(users_line())}, which is the name of one that {what} "
                        "add: rename it")
        self.shared_values, self.hidden = model.shared_values, model.hidden
        self.located_switches = model.located_switches
        self.aliases, self.outputs, self.constants = model.aliases, model.outputs, model.constants
        self.units, self.time_unit = model.units, model.time_unit
        self.defaults = {**model.defaults, **defaults}

    @property
    def generated(self) -> Sequence[str]:
        """The names of the components that `generate` sets."""
        return self.model.generated

    @property
    def generator(self) -> str:
        """What `generate` does, as text for the description of a study; empty if there is none."""
        return self.model.generator
