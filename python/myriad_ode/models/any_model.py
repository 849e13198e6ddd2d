# SPDX-License-Identifier: MIT
"""What a model of any kind has: recorded, from a file, written in C++, or with tangents or sensitivities."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from ..base import component_kinds as kinds
from ..base.errors import Error, at, users_line

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt


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
        for kind in kinds.valued:
            setattr(self, kinds.every[kind].plural, names[kind])


class AnyModel(ComponentNames):
    """A model of any kind. The defaults are for one that has nothing of it."""

    name: str

    # Of a model that is recorded, or made of one: what its hooks assign, as pairs of symbol and expression
    initialise: Sequence[tuple[Any, Any]] = ()
    generate: Sequence[tuple[Any, Any]] = ()
    triggers: Sequence[Any] = ()
    edges: Sequence[Any] = ()  # of conditions of triggers
    summaries: Sequence[Any] = ()  # extrema and integrals over phases
    noise: Any = None  # a `Noise`
    has_noise: bool | None = False  # None where only a compiler knows
    delays: Sequence[Any] | None = ()  # a `Delay` each; None where only a compiler knows
    mass_matrix: npt.NDArray[np.floating[Any]] | None = None
    writes_parameters = writes_time_domain = False  # whether a hook does
    jumps_to_miss: Sequence[str] = ()  # where equations and events jump and no step ends
    shared_values: Mapping[str, float] = {}  # of shared values that the model itself has
    hidden: frozenset[str] = frozenset()  # accessories that no user has named
    located_switches: Sequence[str] = ()  # accessories that stand for what jumped in the equations

    has_doses = False  # besides what the model itself does, so that time goes forwards
    has_table = False  # of doses, so that `subject` is the number of a record

    # Of a model from a file
    defaults: Mapping[str, Any] = {}  # further values of components that need not be given, also as expressions
    is_from_a_file = False
    aliases: Mapping[str, str] = {}  # components by other names
    called: Mapping[str, str] = {}  # what results call components that have another name in C++
    outputs: Mapping[str, Any] = {}  # what a run computes from its results, as expressions
    past_outputs: Mapping[str, Any] = {}  # those that read values of the past
    history_of_outputs: Mapping[str, Any] = {}  # what these read from before the begin, by state, as expressions
    constants: Mapping[Any, Any] = {}  # values of symbols in outputs that are no components
    conserved: Mapping[str, str] = {}  # by state, a parameter: a sum with it, from which what is left out follows
    units: Mapping[str, str] = {}  # texts by component or output
    time_unit = ""

    # Of a model that is made of another
    free: Sequence[str] = ()  # components that it has derivatives by
    has_neighbours = False  # whether it follows neighbouring solutions
    not_interpreted = ""  # why it cannot be interpreted, whatever is in it

    @property
    def generated(self) -> Sequence[str]:
        """The names of the components that `generate` sets."""
        return [target.value[1] for target, _ in self.generate]

    @property
    def generator(self) -> str:
        """What `generate` does, as text for the description of a study; empty if there is none."""
        return ""

    @property
    def component_names(self) -> list[str]:
        """All names, in the order of the kinds."""
        return [name for names in names_of(self).values() for name in names]

    @property
    def stop_names(self) -> Sequence[str]:
        """The names of the kinds of stop times."""
        return ()

    def with_doses(self, *several: Any) -> AnyModel:
        """The model whose states get these doses; refused here, as the model is not recorded."""
        raise Error(f"the model {self.name} is not recorded, and gets no doses{at(users_line())}: add them to the "
                    "model that it is made of, or write stops in C++")

    def with_generated(self, values: Mapping[Any, Any]) -> AnyModel:
        """The model whose `generate` also sets these components; here a refusal, of one that is not recorded."""
        raise Error(f"{', '.join(map(str, values))} are expressions in the sweep of a study{at(users_line())}, and the "
                    f"model {self.name} is no recorded one: give numbers, arrays, or draws of my.uniform and my.normal")

    def cpp(self) -> str:
        """The model as the text of a C++ header."""
        return self.source()[0]

    def source(self) -> tuple[str, str]:
        """The text that kernels are compiled from, and the name of its struct."""
        raise NotImplementedError

    def device_source(self, method: str, precision: str) -> tuple[str, str]:
        """The same for a GPU."""
        return self.source()


def names_of(model: AnyModel) -> dict[str, list[str]]:
    """The names of a model's components by kind."""
    return {name: [getattr(one, "name", one) for one in getattr(model, kind.plural)]
            for name, kind in kinds.every.items()}


def counts_of(model: AnyModel) -> dict[str, int]:
    """How many a model has of each kind, also of stops and triggers."""
    counts = {kind: len(names) for kind, names in names_of(model).items()}
    return {**counts, "stop": len(model.stop_names), "trigger": len(model.edges)}
