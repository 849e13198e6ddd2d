# SPDX-License-Identifier: MIT
"""Derivatives of a run's results by chosen components."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any, NoReturn

import numpy as np

from ..base.errors import Error, UnknownName, renamed
from ..base.statuses import status_names
from ..models.sensitivities import name_of_derivative
from ..symbolic.derivatives import derivatives
from ..symbolic.node import Node, symbols_of
from ..symbolic.symbols import symbol as symbol_of, time

if TYPE_CHECKING:
    from ..symbolic.types import Array, Component
    from .protocol import Results

__all__ = ["Sensitivities"]


_places = {"_sample": "sample", "_end": None}  # where values are, by what stands behind a component's name


class Sensitivities(Mapping[Any, Any]):
    """The derivatives of a run's results. `run.sensitivity[x, k]` has the shape of `run[x]`, `run.sensitivity[x]` one
    more axis behind it, along the components that derivatives are by, `run.sensitivity.free`. x is a state, a real
    accessory, an output, one of these with a place, as "x_sample" or "x_end", or `my.time` for the time at which the
    last phase ended."""

    def __init__(self, run: Results, free: Sequence[str]) -> None:
        self._run = run
        self.free = list(free)  #: the names of the components that derivatives are by

    if not TYPE_CHECKING:
        def __getattr__(self, name: str) -> NoReturn:
            raise AttributeError(renamed("sensitivity", name, {"by": "free"}), name=name, obj=self)

    def __getitem__(self, key: Component | tuple[Component, Component]) -> Array:
        components = self._run._components
        if isinstance(key, tuple):
            of, wrt = key
            k = name_of_derivative(components, wrt)
            if k not in self.free:
                raise UnknownName(f"there are no sensitivities by {k!r}: they are by {', '.join(self.free)}")
            return self._by(of, k)
        return np.stack([self._by(key, k) for k in self.free], axis=-1)

    def _by(self, of: Component, k: str) -> Array:
        run = self._run
        components = run._components
        if of is time:
            return self._defined(run._values_of(f"time_by_{k}"))
        name, ending = self._of(components.component(of))
        if name in components.outputs and name not in components.place:
            expression = components.outputs[name]
            if ending is None:
                return self._of_output(expression, k, run._places_of(expression)[0])
            run._find(run._called[name] + ending)  # which refuses a place where it is not known
            return self._of_output(expression, k, _places[ending])
        derivative = f"{name}_by_{k}"
        if derivative not in components.place or components.place[derivative][0] not in ("state", "accessory"):
            raise UnknownName(f"there are no sensitivities of {name!r}: states, real accessories and outputs have them")
        values = run._values_of(derivative) if ending is None else run[run._called[derivative] + ending]
        return values if values.ndim == 2 else self._defined(values)

    def _of(self, name: str) -> tuple[str, str | None]:
        """The component or output that a name of the run's belongs to, as "x" of "x_sample", and what stands behind."""
        known = {*self._run._components.place, *self._run._components.outputs}
        for ending in _places:
            if name not in known and name.endswith(ending) and name.removesuffix(ending) in known:
                return name.removesuffix(ending), ending
        return name, None

    def _defined(self, values: Array) -> Array:
        """NaN where an instance ended since its derivatives do not exist."""
        run = self._run
        lost = (run._values_of("undefined_derivatives") > 0) & (run.status_codes == status_names.index("not_finite"))
        return np.where(lost, np.nan, values) if lost.any() else values

    def _of_output(self, expression: Node, k: str, place: str | None) -> Array:
        """By the chain rule, at a place where the run has the states that the output depends on."""
        run = self._run
        components = run._components
        symbols = [s for s in symbols_of([expression]) if s not in components.constants]
        found = derivatives([expression], symbols)
        if found is None:
            raise Error("an output that looks up a table has no sensitivities")
        total = np.zeros(np.shape(run._output_at(place, expression)))
        for number, partial in found[0].items():
            symbol = symbols[number]
            kind, name = symbol.value
            if kind in ("state", "accessory"):
                inner: Any = run._output_at(place, symbol_of(kind, f"{name}_by_{k}"))
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
        return iter([n for n in components.of(("state", "accessory")) if f"{n}_by_{self.free[0]}" in components.place])

    def __len__(self) -> int:
        return len(list(iter(self)))

    def __repr__(self) -> str:
        return f"<sensitivities of {', '.join(self)} by {', '.join(self.free)}>"


def note(run: Results) -> str | None:
    """What to know of derivatives that do not exist."""
    if not run._components.event_names:  # nor does what counts them have to be copied from a GPU
        return None
    count = int(np.count_nonzero(run._values_of("undefined_derivatives")))
    if count == 0:
        return None
    return (f"in {count} instance{'s' if count > 1 else ''} a derivative does not exist, as the function of an event "
            "passed zero with no slope in time: such derivatives are NaN, and an instance whose state would have one "
            "ended as not_finite")
