# SPDX-License-Identifier: MIT
"""Forward sensitivities: a model with the derivatives of its solution, by `myriad::with_sensitivities`."""

from __future__ import annotations

import dataclasses
from collections.abc import Collection, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from . import folding, state_jumps
from .components import Components, by_component, unknown
from .core_options import per_state
from .derivatives import derivatives
from .errors import Error, at, users_line
from .expression import Node, symbols_of
from .extended import Extended
from .inputs import real
from .model import Model
from .statuses import status_names
from .symbols import symbol as symbol_of
from .symbols import t_begin, t_end, time

if TYPE_CHECKING:
    from .any_model import AnyModel
    from .hints import Array, Component, SomeComponents
    from .options import Options
    from .run import Run

__all__ = ["with_sensitivities", "WithSensitivities", "Sensitivities"]

_not_controlled = 1e30  # a tolerance that no error exceeds
_domain = {t_begin: "t_begin", t_end: "t_end"}  # the ends of the time domain, by which there are derivatives too


def _name_of(components: Components, key: Component) -> str:
    """The name of what derivatives are by."""
    return _domain[key] if isinstance(key, Node) and key in _domain else components.component(key)


def _with_jumps_apart(model: Model, names: Sequence[str]) -> Model:
    """A traced model in which each jump in time has the derivative of its own time. What is not given may follow from
    the components, and actions may change states and accessories by them."""
    own = Components(model)

    def moves(needed: set[Node]) -> bool:
        return any(s.value[0] in ("state", "accessory") or s.value[1] in names or own.follows(s.value[1], names, ())
                   for s in needed)

    return model.with_jumps_apart(moves)


def with_sensitivities(model: AnyModel, by: SomeComponents, control: bool = True) -> WithSensitivities:
    """The model with the derivatives of its solution by some of its components, initial states, parameters and shared
    values, and by `myriad.t_begin` and `myriad.t_end`. Their errors take part in choosing the steps unless `control` is
    False. `solve(model, ..., sensitivities=[k, x])` makes one."""
    return WithSensitivities(model, by, control)


class WithSensitivities(Extended):
    """A model with sensitivities. The derivative of state or accessory c by component k is the state or accessory
    `<c>_by_<k>`, that of the time at which the last phase ended the accessory `time_by_<k>`."""

    not_interpreted = "it has sensitivities"

    def __init__(self, model: AnyModel, by: SomeComponents, control: bool = True) -> None:
        line = at(users_line())
        own = Components(model)
        if isinstance(model, Extended):
            raise Error(f"the model has {'sensitivities' if isinstance(model, WithSensitivities) else 'tangents'} "
                        f"already{line}: give the model alone")
        if model.mass_matrix is not None:
            raise Error(f"the model has a mass matrix{line}, with which initial values of algebraic states would not "
                        "be independent: solve its algebraic equations in the others")
        kinds_of = ("state", "parameter", "shared")
        wanted = [by] if isinstance(by, (str, Node)) else list(by)
        names = [_name_of(own, one) for one in wanted]
        possible = [name for name in own.of(kinds_of) if name not in own.tables]
        both = next((name for name in _domain.values() if name in names and name in own.place), None)
        if both is not None:
            raise Error(f"the model has a component '{both}'{line}, which cannot be told from the end of the time "
                        "domain of that name: rename it")
        possible += _domain.values()
        for name in names:
            if name not in possible:
                raise unknown(name, possible, "component that sensitivities can be by")
        twice = next((name for name in names if names.count(name) > 1), None)
        if not names or twice is not None:
            what = f"'{twice}' is there twice" if twice else "no component is named"
            raise Error(f"sensitivities={wanted!r}{line}: {what}; name each component once, as in sensitivities=[k, x]")
        for what in ("writes_parameters", "writes_time_domain"):
            if getattr(model, what):
                raise Error(f"the hooks of the model assign {what[7:].replace('_', ' ')}{line}, and what they assign "
                            "has no sensitivities: use an accessory, or end phases by an event")
        if isinstance(model, Model):
            model = _with_jumps_apart(model, names)
        own = Components(model)
        self.by = names
        self.control = control  #: whether errors of derivatives take part in choosing the steps
        self.n_original = len(own.states)
        self.places = [own.place.get(name, ("domain", 0)) for name in names]
        accessories = [f"{a}_by_{k}" for k in names for a in own.names["accessory"]]
        start = {f"{c}_by_{k}": float(c == k) for k in names for c in own.states}
        super().__init__(model, {"state": list(start), "accessory": [
            *accessories, *(f"time_by_{k}" for k in names), "time_of_event", "undefined_derivatives",
            *(["phase_carries_on", "phase_goes_to_t_end"] if set(names) & set(_domain.values()) else [])]}, start,
            "sensitivities")

    def source(self) -> tuple[str, str]:
        """The text that kernels are compiled from, and the name of its struct."""
        text, struct = self.model.source()
        wrt = ", ".join(f"myriad::time_domain::{name}" if kind == "domain" else
                        f"static_cast<decltype({struct}::n_{kind})>({number})"
                        for name, (kind, number) in zip(self.by, self.places))
        template = "with_sensitivities" if self.control else "uncontrolled_sensitivities"
        return (f"{text}\n#include <myriad/sensitivity.hpp>\n"
                f"using {struct}_sensitivities = myriad::{template}<{struct}, {wrt}>;\n"), f"{struct}_sensitivities"

    def __repr__(self) -> str:
        return f"<sensitivities of {self.model!r} by {', '.join(self.by)}>"

    # What a call of `solve` means for them

    def _derivatives_of(self, chosen: Any, components: Components) -> list[Any]:
        """Some components and their derivatives."""
        listed = [chosen] if isinstance(chosen, (str, Node)) else list(chosen)
        names = [components.component(one) for one in listed]
        have = [n for n in names if components.place.get(n, ("",))[0] in ("state", "accessory")]
        return [*listed, *(f"{n}_by_{k}" for k in self.by for n in have if f"{n}_by_{k}" in components.place)]

    def options(self, given: Options, components: Components) -> Options:
        """The options of a call of the model alone as those of the model with sensitivities: their records, samples and
        tolerances."""
        record, samples = given.record, given.samples
        if record is not None:
            chosen = dict(record) if isinstance(record, Mapping) else {"states": record}
            for key in ("states", "accessories"):
                if key in chosen:
                    chosen[key] = self._derivatives_of(chosen[key], components)
            if chosen.get("time"):  # whose derivatives outputs need
                chosen["accessories"] = [*chosen.get("accessories", ()), *(f"time_by_{k}" for k in self.by)]
            record = chosen
        if isinstance(samples, Mapping) and "states" in samples:
            samples = {**samples, "states": self._derivatives_of(samples["states"], components)}
        rtol = self._tolerances(given.rtol, components, "rtol")
        atol = self._tolerances(given.atol, components, "atol")
        return dataclasses.replace(given, record=record, samples=samples, rtol=rtol, atol=atol)

    def _tolerances(self, value: Any, components: Components, name: str) -> list[float]:
        """Those of the model's states, and of their derivatives the same, or those that a dict names."""
        named = by_component(value, name) if hasattr(value, "items") else {}
        derivatives_of = components.states[self.n_original:]
        own = {c: t for c, t in named.items() if c not in derivatives_of} if hasattr(value, "items") else value
        of_states = per_state(own, Components(self.model), name, self.n_original)
        if len(of_states) == 1:
            of_states = of_states * self.n_original
        of_derivatives = dict(zip(derivatives_of, of_states * len(self.by)))
        of_derivatives.update((c, real(t, f"{name} of '{c}'")) for c, t in named.items() if c in of_derivatives)
        return [*of_states, *(t if self.control else _not_controlled for t in of_derivatives.values())]

    def start_derivatives(self, given: Collection[str]) -> dict[str, Any]:
        """The derivatives of initial values that follow from components that sensitivities are by, as defaults of the
        derivatives at the start; refuses parameters that follow from them."""
        own = Components(self.model)
        starts_with = {k: "t" if k == _domain[t_begin] else k for k in self.by}  # what defaults read
        for name in own.of(("parameter", "shared")):
            if name not in self.by and own.follows(name, starts_with.values(), given):
                raise Error(f"the value of '{name}' follows from components that sensitivities are by: give it in the "
                            "sweep")
        found: dict[str, Any] = {}

        def derivative(name: str, k: str) -> Any:
            if name in given or name in self.by or not own.follows(name, [starts_with[k]], given):
                return folding.constant(float(name == k))
            default = own.defaults[name]
            by_time = k == _domain[t_begin]
            symbols = [s for s in symbols_of([default]) if by_time or s is not time]
            partials = derivatives([default], symbols)
            if partials is None:
                raise Error(f"the initial value of '{name}' looks up a table and has no derivatives: give it in start=")
            return folding.total([folding.multiply(folding.number(partial), folding.constant(1.0) if symbols[i] is time
                                                   else derivative(symbols[i].value[1], k))
                                  for i, partial in partials[0].items()])

        for name in own.of(("state", "accessory")):
            if name not in given and name not in self.by:
                found |= {f"{name}_by_{k}": derivative(name, k)
                          for k in self.by if own.follows(name, [starts_with[k]], given)}
        return found


class Sensitivities(Mapping[Any, Any]):
    """The derivatives of a run's results. `run.sensitivity[x, k]` has the shape of `run[x]`, `run.sensitivity[x]` one
    more axis behind it, along the components that the derivatives are by, `run.sensitivity.by`. x is a state, a real
    accessory, an output, or `myriad.time` for the time at which the last phase ended."""

    def __init__(self, run: Run, by: Sequence[str]) -> None:
        self._run = run
        self.by = list(by)  #: the names of the components that derivatives are by

    def __getitem__(self, key: Component | tuple[Component, Component]) -> Array:
        components = self._run._components
        if isinstance(key, tuple):
            of, wrt = key
            k = _name_of(components, wrt)
            if k not in self.by:
                raise KeyError(f"there are no sensitivities by {k!r}: they are by {', '.join(self.by)}")
            return self._by(of, k)
        return np.stack([self._by(key, k) for k in self.by], axis=-1)

    def _by(self, of: Component, k: str) -> Array:
        run = self._run
        components = run._components
        if of is time:
            return self._defined(run[f"time_by_{k}"])
        name = components.component(of)
        if name in components.outputs and name not in components.place:
            return self._of_output(components.outputs[name], k)
        derivative = f"{name}_by_{k}"
        if derivative not in components.place or components.place[derivative][0] not in ("state", "accessory"):
            raise KeyError(f"there are no sensitivities of {name!r}: states, real accessories and outputs have them")
        values = run[derivative]
        return values if values.ndim == 2 else self._defined(values)

    def _defined(self, values: Array) -> Array:
        """NaN where an instance ended since its derivatives do not exist."""
        lost = (self._run["undefined_derivatives"] > 0) & (self._run.status == status_names.index("not_finite"))
        return np.where(lost, np.nan, values) if lost.any() else values

    def _of_output(self, expression: Node, k: str) -> Array:
        """By the chain rule, where the run has the states that the output depends on."""
        run = self._run
        components = run._components
        symbols = [s for s in symbols_of([expression]) if s not in components.constants]
        found = derivatives([expression], symbols)
        if found is None:
            raise Error("an output that looks up a table has no sensitivities")
        place = run._place_of(expression)
        total = np.zeros(np.shape(run._output(expression)))
        for number, partial in found[0].items():
            symbol = symbols[number]
            kind, name = symbol.value
            if kind == "state":
                inner: Any = run._output_at(place, symbol_of("state", f"{name}_by_{k}"))
            elif symbol is time:
                at_end = run.records if place == "phase" else run.accessories
                inner = 0.0 if place == "sample" else at_end[f"time_by_{k}"]
            else:
                inner = float(name == k)
            slope = run._output_at(place, partial)
            total = total + np.where(np.equal(inner, 0.0), 0.0, slope * inner)  # zero, even if the slope is infinite
        return total if place else self._defined(total)

    def __iter__(self) -> Iterator[str]:
        components = self._run._components
        return iter([n for n in components.of(("state", "accessory")) if f"{n}_by_{self.by[0]}" in components.place])

    def __len__(self) -> int:
        return len(list(iter(self)))

    def __repr__(self) -> str:
        return f"<sensitivities of {', '.join(self)} by {', '.join(self.by)}>"


def note_on(model: AnyModel) -> str | None:
    """What to know of a model with sensitivities."""
    return state_jumps.note(model.model) if isinstance(model, WithSensitivities) else None


def note(run: Run) -> str | None:
    """What to know of derivatives that do not exist."""
    if not run._components.event_names:  # nor does what counts them have to be copied from a GPU
        return None
    count = int(np.count_nonzero(run["undefined_derivatives"]))
    if count == 0:
        return None
    return (f"in {count} instance{'s' if count > 1 else ''} a derivative does not exist, as the function of an event "
            "passed zero with no slope in time: such derivatives are NaN, and an instance whose state would have one "
            "ended as not_finite")
