# SPDX-License-Identifier: MIT
"""The kinds of components that a model may have, as the core lists them, and the names of a model's components."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

from . import _core


class Kind(NamedTuple):
    """One kind: its enumeration in C++, the model's attribute in Python, what messages call a component, whether its
    values are integers, whether they can be recorded, and whether each instance has its own."""

    name: str
    plural: str
    words: str
    integer: bool
    recorded: bool
    of_instances: bool


every = {facts[0]: Kind(*facts) for facts in _core.component_kinds}
valued = [kind.name for kind in every.values() if kind.name != "event"]  # those with values
recorded = [kind.name for kind in every.values() if kind.recorded]  # states and accessories, which change
accessories = [kind for kind in recorded if kind != "state"]
of_instances = [kind.name for kind in every.values() if kind.of_instances]
shared = [kind for kind in valued if kind not in of_instances]  # by all instances


class ComponentNames:
    """The names of a model's components, in their order."""

    states: Sequence[str]
    parameters: Sequence[str]
    shared: Sequence[str]
    shared_integers: Sequence[str]
    accessories: Sequence[str]
    integer_accessories: Sequence[str]
    events: Sequence[Any]

    def _set_names(self, names: Mapping[str, Sequence[str]]) -> None:
        """Takes names by kind, of kinds with values."""
        for kind in valued:
            setattr(self, every[kind].plural, names[kind])


def names_of(model: Any) -> dict[str, list[str]]:
    """The names of a model's components by kind."""
    return {name: [getattr(one, "name", one) for one in getattr(model, kind.plural)] for name, kind in every.items()}


def counts_of(model: Any) -> dict[str, int]:
    """How many a model has of each kind, also of stops and triggers."""
    counts = {kind: len(names) for kind, names in names_of(model).items()}
    return {**counts, "stop": len(getattr(model, "stop_names", ())), "trigger": len(getattr(model, "edges", ()))}
