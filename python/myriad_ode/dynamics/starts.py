# SPDX-License-Identifier: MIT
"""Where orbits start: a grid of initial states, arrays of them, or random draws."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ..base import component_kinds as kinds
from ..base.errors import Error, quoted
from ..models.any_model import AnyModel
from ..models.components import Components, name_of, unknown
from ..sweeps.inputs import by_name, whole
from ..sweeps.sweep import Sweep, zip as together
from ..symbolic.axes import Random
from ..symbolic.node import Node

if TYPE_CHECKING:
    from ..symbolic.types import Array, ByComponent


def components_of(model: AnyModel) -> Components:
    """The components of what must be a model."""
    if not isinstance(model, AnyModel):
        raise Error(f"the model is a {type(model).__name__}: make it by my.model(...)")
    return Components(model)


def parameter_of(components: Components, key: Any) -> str:
    """The name of what must be a parameter or a shared component of the model."""
    name = components.component(key)
    if components.place.get(name, ("",))[0] not in ("parameter", *kinds.shared):
        raise unknown(name, components.of(["parameter", *kinds.shared]), "parameter of the model")
    return name


class Starts:
    """Initial states by name, one for each orbit. `sweep` has their axes; `is_random` tells whether they are drawn."""

    def __init__(self, components: Components, start: Sweep | ByComponent, draws: int | None, seed: int,
                 instead: str = "give the number of draws, as in draws=10_000") -> None:
        sweep = start if isinstance(start, Sweep) else together(by_name(start, "start", "start={x: 1, v: 0}"))
        if whole(seed, "seed") < 0:
            raise Error(f"seed is {seed}: give a whole number that is not negative")
        if draws is not None:
            if whole(draws, "draws") < 1:
                raise Error(f"draws is {draws}: give the number of random starts, at least one")
            sweep = Sweep([*sweep.axes, ("draw", np.arange(draws))], sweep.coordinates, sweep.constants)
        self.sweep, self.is_random = sweep, draws is not None
        random = {name: value for name, value in sweep.constants.items() if isinstance(value, Random)}
        if bool(random) != self.is_random:
            raise Error(f"{', '.join(random)} is drawn at random: {instead}"
                        if random else
                        "there are draws, and nothing is drawn: give start={x: my.uniform(-2, 2), ...}")
        generator = np.random.default_rng(seed)
        values: dict[str, Array] = {}
        for name in sorted(sweep.names):
            called = components.component(name)
            if components.place.get(called, ("",))[0] not in kinds.recorded:
                known = [n for n in components.of(kinds.recorded) if n not in components.hidden]
                raise unknown(name, known, "state that start= can set")
            if name in random:
                draw = getattr(generator, random[name].kind)
                values[called] = draw(*random[name].arguments, size=sweep.size)
            else:
                values[called] = np.asarray(sweep.values(name))
        #: initial states, and accessories, in the order of the model
        self.values = {name: values[name] for name in components.place if name in values}
        missing = [name for name in components.states if name not in values and name not in components.defaults]
        if missing:
            raise Error(f"the initial value of {quoted(missing)} is missing: give it in start=")
        if not sweep.size:
            raise Error("start= has no initial states: give at least one")

    @property
    def size(self) -> int:
        return self.sweep.size


def constant_values(sweep: Sweep | ByComponent | None, instead: str) -> dict[Any, Any]:
    """The values of parameters of a call, one of each. `instead`: what takes several."""
    if isinstance(sweep, Sweep):
        if sweep.axes:
            raise Error(f"the sweep varies {', '.join(name for name, _ in sweep.axes)}: give one value, or use "
                        f"{instead}")
        return dict(sweep.constants)
    values = dict(by_name(sweep, "the sweep", "{k: 0.2, B: 0.3}"))
    for key, value in values.items():
        if isinstance(value, (Node, Random)):
            raise Error(f"the value of {name_of(key)} in the sweep is {value!r}: give a number")
        if np.ndim(value):
            raise Error(f"the sweep has {np.size(value)} values of {name_of(key)}: give one, or use {instead}")
    return values


def along_one(model: AnyModel, sweep: Sweep | ByComponent) -> tuple[str, Array, dict[str, Any]]:
    """The component of a sweep that has several values, by name, its values, and the values of the others."""
    components = components_of(model)
    if not isinstance(sweep, Sweep):
        sweep = together(by_name(sweep, "the sweep", "{k: np.linspace(-1, 1, 100), B: 0.3}"))
    if len(sweep.coordinates) != 1:
        raise Error(f"the sweep varies {', '.join(sweep.coordinates) or 'nothing'}: give the values of one parameter, "
                    "as in {k: np.linspace(-1, 1, 100), B: 0.3}")
    (name, (_, values)), = sweep.coordinates.items()
    if not len(values):
        raise Error(f"the sweep has no values of {name}: give at least one")
    return parameter_of(components, name), np.asarray(values), dict(sweep.constants)
