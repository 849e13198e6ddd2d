# SPDX-License-Identifier: MIT
"""A model as a function of some of its components: what batched functions, least squares, likelihoods and adjoints
integrate."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ..base import component_kinds as kinds
from ..base.errors import Error
from ..models.components import Components, by_component, unknown
from ..solving.core_options import per_state
from ..solving.gather import given_values
from ..solving.options import Options
from ..solving.repeated import repeated_call
from ..solving.solve import solve
from ..sweeps.gpu_inputs import is_on_gpu
from ..sweeps.inputs import by_name

if TYPE_CHECKING:
    from ..models.any_model import AnyModel
    from ..results.run import Run
    from ..symbolic.types import ByComponent


class Forward:
    """A model of which each instance has values of its own of some components, those of others are in `sweep` and
    `start`, and derivatives are by the components `free`. `options` are those of `solve`."""

    def __init__(self, model: AnyModel, free: Sequence[str], sweep: Mapping[str, Any], start: Mapping[str, Any],
                 options: Mapping[str, Any]) -> None:
        self.model, self.free, self.states = model, list(free), Components(model).states
        self.sweep, self.start, self.options = sweep, start, dict(options)

    def of_rows(self, rows: Any) -> dict[str, Any]:
        """Values of the components `free`, from the rows of an array, of NumPy's or on a GPU."""
        return {name: _contiguous(rows[:, i]) for i, name in enumerate(self.free)}

    def run(self, values: Mapping[str, Any], sensitivities: bool = False, **more: Any) -> Run:
        """The run of values by name, one for each instance. `more` are options of this call."""
        free = self.free if sensitivities else []
        sweep = {name: value for name, value in values.items() if name not in self.states}
        start = {name: value for name, value in values.items() if name in self.states}
        return solve(self.model, {**self.sweep, **sweep}, start={**self.start, **start}, free=free or None,
                     **(self.options if free else self.plain_options()), **more)

    def repeated(self, results: Sequence[Sequence[Any]], samples: int | None, sensitivities: bool) -> Any:
        """The same for rows of values as a call of the core for these results, as `repeated_call` makes it; None if
        only `run` can do it."""
        return repeated_call(self.model, self.free, results, samples,
                             self.options if sensitivities else self.plain_options(), sweep=self.sweep,
                             start=self.start, free=self.free if sensitivities else None)

    def plain_options(self) -> dict[str, Any]:
        """The options of a call without sensitivities."""
        derived = {f"{c}_by_{k}" for c in self.states for k in self.free}

        def of_states(tolerance: Any) -> Any:
            if not hasattr(tolerance, "items"):
                return tolerance
            return {name: value for name, value in tolerance.items() if name not in derived}

        return {key: of_states(value) if key in ("rtol", "atol") else value
                for key, value in self.options.items() if key != "sensitivity_control"}


def forward_of(model: AnyModel, free: Sequence[str], sweep: ByComponent | None, start: ByComponent | None,
               options: Mapping[str, Any]) -> Forward:
    """A model as a function of the components `free` that a call names, with one value of each other."""
    components = Components(model)
    possible = components.of(("state", "parameter"))
    for name in free:
        if components.place.get(name, ("",))[0] in kinds.shared:
            raise Error(f"'{name}' is shared by all instances, and each has its own value of what is in free=: "
                        "make it a parameter of the model")
        if name not in possible:
            raise unknown(name, possible, "component that free= can name")
    given = {"sweep=": by_component(by_name(sweep, "sweep", "sweep={B: 0.3}"), "sweep="),
             "start=": by_component(by_name(start, "start", "start={x: 1}"), "start=")}
    for where, values in given.items():
        for name, value in values.items():
            if components.component(name) in free:
                raise Error(f"'{name}' is in free= and has a value in {where}: give it in free= alone")
            if np.ndim(value) != 0:
                raise Error(f"'{name}' has several values in {where}: what is not in free= has one value")
    given_values(components, given["sweep="], given["start="])  # refuses names that the model does not have
    return Forward(model, free, given["sweep="], given["start="], options)


def refuse_chosen(options: Mapping[str, Any], names: Sequence[str], what: str) -> None:
    """Refuses options of `solve` that something chooses itself."""
    for name in names:
        if name in options:
            raise Error(f"{what} chooses {name}= itself: leave it out")


def tolerances(components: Components, options: Mapping[str, Any], sizes: Mapping[str, float]) -> dict[str, float]:
    """Absolute tolerances of states, and of their derivatives by components of these sizes, whose product with the
    component is to be as accurate as the state."""
    given = options.get("atol", (options.get("options") or Options()).atol)
    states = components.states
    values = per_state(given, components, "atol", len(states))
    of_states = dict(zip(states, values * len(states) if len(values) == 1 else values))
    return {**of_states, **{f"{c}_by_{name}": tolerance / size for name, size in sizes.items()
                            for c, tolerance in of_states.items()}}


def _contiguous(column: Any) -> Any:
    if isinstance(column, np.ndarray):
        return np.ascontiguousarray(column)
    return column.contiguous() if is_on_gpu(column) and hasattr(column, "contiguous") else column
