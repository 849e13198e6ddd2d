# SPDX-License-Identifier: MIT
"""Forward sensitivities: a model with the derivatives of its solution, by `myriad::with_sensitivities`."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from ..base.errors import Error, at, users_line
from ..symbolic.node import Node
from ..symbolic.symbols import t_begin, t_end
from . import delays, state_jumps
from .components import Components, listed, unknown
from .extended import Extended
from .noise import refuse_derivatives
from .recorded import RecordedModel

if TYPE_CHECKING:
    from ..symbolic.types import Component, SomeComponents
    from .any_model import AnyModel

__all__ = ["with_sensitivities", "WithSensitivities"]
ends_of_domain = {t_begin: "t_begin", t_end: "t_end"}  # the ends of the time domain, by which there are derivatives too


def name_of_derivative(components: Components, key: Component) -> str:
    """The name of what derivatives are by."""
    return ends_of_domain[key] if isinstance(key, Node) and key in ends_of_domain else components.component(key)


def _with_jumps_apart(model: RecordedModel, names: Sequence[str]) -> RecordedModel:
    """A traced model in which each jump in time has the derivative of its own time. What is not given may follow from
    the components, and actions may change states and accessories by them."""
    own = Components(model)

    def moves(needed: set[Node]) -> bool:
        return any(s.value[0] in ("state", "accessory") or s.value[1] in names or own.follows(s.value[1], names, ())
                   for s in needed)

    return model.with_jumps_apart(moves)


def with_sensitivities(model: AnyModel, free: SomeComponents, control: bool = True) -> WithSensitivities:
    """The model with the derivatives of its solution by the components that are free: initial states, parameters and
    shared values, and `my.t_begin` and `my.t_end`. Their errors take part in choosing the steps unless `control` is
    False. `solve(model, ..., free=[k, x])` makes one."""
    return WithSensitivities(model, free, control)


class WithSensitivities(Extended):
    """A model with sensitivities. The derivative of state or accessory c by component k is the state or accessory
    `<c>_by_<k>`, that of the time at which the last phase ended the accessory `time_by_<k>`."""

    not_interpreted = "it has sensitivities"

    def __init__(self, model: AnyModel, free: SomeComponents, control: bool = True) -> None:
        line = at(users_line())
        own = Components(model)
        if isinstance(model, Extended):
            raise Error(f"the model has {'sensitivities' if isinstance(model, WithSensitivities) else 'tangents'} "
                        f"already{line}: give the model alone")
        refuse_derivatives(model, "derivatives")
        delays.refuse_derivatives(model, "derivatives")
        if model.mass_matrix is not None:
            raise Error(f"the model has a mass matrix{line}, with which initial values of algebraic states would not "
                        "be independent: solve its algebraic equations in the others")
        kinds_of = ("state", "parameter", "shared")
        wanted = listed(free)
        names = [name_of_derivative(own, one) for one in wanted]
        possible = [name for name in own.of(kinds_of) if name not in own.tables]
        both = next((name for name in ends_of_domain.values() if name in names and name in own.place), None)
        if both is not None:
            raise Error(f"the model has a component '{both}'{line}, which cannot be told from the end of the time "
                        "domain of that name: rename it")
        possible += ends_of_domain.values()
        for name in names:
            if name not in possible:
                raise unknown(name, possible, "component that sensitivities can be by")
        if model.delays and "t_begin" in names:
            raise Error(f"free={wanted!r}{line}: a model with delays has no derivatives by t_begin, as its past would "
                        "begin elsewhere")
        twice = next((name for name in names if names.count(name) > 1), None)
        if not names or twice is not None:
            what = f"'{twice}' is there twice" if twice else "no component is named"
            raise Error(f"free={wanted!r}{line}: {what}; name each component once, as in free=[k, x]")
        for what in ("writes_parameters", "writes_time_domain"):
            if getattr(model, what):
                raise Error(f"the hooks of the model assign {what[7:].replace('_', ' ')}{line}, and what they assign "
                            "has no sensitivities: use an accessory, or end phases by an event")
        if isinstance(model, RecordedModel):
            model = _with_jumps_apart(model, names)
        own = Components(model)
        self.free = names
        self.control = control  #: whether errors of derivatives take part in choosing the steps
        self.n_original = len(own.states)
        self.places = [own.place.get(name, ("domain", 0)) for name in names]
        accessories = [f"{a}_by_{k}" for k in names for a in own.names["accessory"]]
        start = {f"{c}_by_{k}": float(c == k) for k in names for c in own.states}
        super().__init__(model, {"state": list(start), "accessory": [
            *accessories, *(f"time_by_{k}" for k in names), "time_of_event", "undefined_derivatives",
            *(["phase_carries_on", "phase_goes_to_t_end"] if set(names) & set(ends_of_domain.values()) else [])]},
            start, "sensitivities")

    def source(self) -> tuple[str, str]:
        """The text that kernels are compiled from, and the name of its struct."""
        text, struct = self.model.source()
        wrt = ", ".join(f"myriad::time_domain::{name}" if kind == "domain" else
                        f"static_cast<decltype({struct}::n_{kind})>({number})"
                        for name, (kind, number) in zip(self.free, self.places))
        template = "with_sensitivities" if self.control else "uncontrolled_sensitivities"
        return (f"{text}\n#include <myriad/sensitivity.hpp>\n"
                f"using {struct}_sensitivities = myriad::{template}<{struct}, {wrt}>;\n"), f"{struct}_sensitivities"

    def __repr__(self) -> str:
        return f"<sensitivities of {self.model!r} by {', '.join(self.free)}>"


def note_on(model: AnyModel) -> str | None:
    """What to know of a model with sensitivities."""
    return state_jumps.note(model.model) if isinstance(model, WithSensitivities) else None
