# SPDX-License-Identifier: MIT
"""Models that the C++ library makes of others by adding components: with tangents, with sensitivities."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from .errors import Error, at, users_line
from .kinds import ComponentNames, names_of

if TYPE_CHECKING:
    from .cpp_model import CppModel
    from .model import Model


class Extended(ComponentNames):
    """A model with components behind its own, `added` by kind, and defaults of them. `what` adds them."""

    def __init__(self, model: Model | CppModel, added: Mapping[str, list[str]], defaults: Mapping[str, Any],
                 what: str) -> None:
        if getattr(model, "triggers", ()):
            raise Error(f"the model has triggers{at(users_line())}, which {what} do not take: give events actions of "
                        "their own")
        self.model, self.name = model, model.name
        names = {kind: [*known, *added.get(kind, ())] for kind, known in names_of(model).items()}
        self._set_names(names)
        self.events = model.events
        self.generated, self.generator = model.generated, model.generator
        self.generate = getattr(model, "generate", [])  # not of a model in C++
        every = [name for of_kind in names.values() for name in of_kind]
        twice = next((name for name in every if every.count(name) > 1), None)
        if twice is not None:
            raise Error(f"the model has a component '{twice}'{at(users_line())}, which is the name of one that {what} "
                        "add: rename it")
        self.shared_values = getattr(model, "shared_values", {})
        self.aliases, self.outputs = getattr(model, "aliases", {}), getattr(model, "outputs", {})
        self.constants = getattr(model, "constants", {})
        self.hidden: frozenset[str] = getattr(model, "hidden", frozenset())
        self.units, self.time_unit = getattr(model, "units", {}), getattr(model, "time_unit", "")
        self.defaults = {**getattr(model, "defaults", self.shared_values), **defaults}

    def cpp(self) -> str:
        """The model and what is added as the text of a C++ header."""
        return self.source()[0]

    def source(self) -> tuple[str, str]:
        """The text that kernels are compiled from, and the name of its struct."""
        raise NotImplementedError
