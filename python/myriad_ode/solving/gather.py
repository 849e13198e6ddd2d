# SPDX-License-Identifier: MIT
"""What a call of `solve` is given, by name and complete, and the ensemble that it fills."""

from __future__ import annotations

from collections.abc import Container, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ..base import component_kinds as kinds
from ..base.errors import Error
from ..models.components import Components, by_component, unknown
from ..sweeps.gpu_inputs import DeviceInput
from ..sweeps.inputs import Along, by_name, numbers, whole, whole_numbers
from ..sweeps.sweep import Sweep

if TYPE_CHECKING:
    import numpy.typing as npt

    from ..symbolic.types import ByComponent, Values


def _sweep_values(sweep: Sweep | ByComponent | None) -> dict[str, Any]:
    """The values of a sweep by name: of an object like `my.grid(...)`, or of a dict."""
    if sweep is None:
        return {}
    if isinstance(sweep, Sweep):
        return {**{name: Along(sweep, name) for name in sweep.coordinates}, **sweep.constants}
    if hasattr(sweep, "items"):
        return by_component(sweep, "the sweep")
    raise Error(f"the sweep is a {type(sweep).__name__}: give a dict, as in {{k: np.linspace(0, 1, 100)}}, or "
                "my.grid(k=..., B=...)")


def ends_of(time: tuple[Values, Values] | None) -> tuple[Values, Values]:
    """Begin and end of the time domain."""
    if time is None:
        raise Error("time is missing: give begin and end, as in time=(0, 10)")
    try:
        begin, end = time
    except (TypeError, ValueError):
        raise Error(f"time is {time!r}: give begin and end, as in time=(0, 10)") from None
    return begin, end


def refuse_missing(components: Components, given: Container[str]) -> None:
    """Refuses a call that leaves out what every instance needs."""
    for what, names, where in (
            ("initial value", components.states, "start="),
            ("value", components.of(["parameter", *kinds.shared]), "the sweep")):
        missing = [n for n in names if n not in given]
        if missing:
            hint = ", as generate= sets instances of studies alone" if set(missing) & set(components.generated) else ""
            raise Error(f"the {what} of {', '.join(map(repr, missing))} is missing: give it in {where}{hint}")


def gather(components: Components, sweep: Sweep | ByComponent | None, start: ByComponent | None,
            time: tuple[Values, Values] | None, size: int | None) -> tuple[dict[str, Any], tuple[Any, Any], int]:
    """All inputs by name, and the number of instances."""
    given = {}
    initial = by_component(by_name(start, "start", "start={x: 1, v: 0}"), "start=")
    for source, values, allowed in (("the sweep", _sweep_values(sweep), None),
                                  ("start=", initial, kinds.recorded)):
        for name, value in values.items():
            name = components.component(name)
            kind = components.place.get(name, (None,))[0]
            if kind is None or (allowed is not None and kind not in allowed):
                known = [n for n, (k, _) in components.place.items()
                         if n not in {*components.tables, *components.hidden} and (allowed is None or k in allowed)]
                raise unknown(name, known, f"component of the model that {source} can set")
            if name in given:
                raise Error(f"'{name}' is given in the sweep and in start=: give it once")
            given[name] = numbers(value, name)
    begin, end = ends_of(time)
    domain = numbers(begin, "begin of time"), numbers(end, "end of time")
    given = {name: value for name, value in components.completed(given, domain[0]).items() if value is not None}
    refuse_missing(components, given)
    lengths = {name: len(a) for name, a in (*given.items(), ("begin of time", domain[0]), ("end of time", domain[1]))
               if a.ndim == 1}
    if size is not None:
        lengths["size"] = whole(size, "size", 1 << 62)
    if isinstance(sweep, Sweep):
        lengths["the sweep"] = sweep.size
    if len(set(lengths.values())) > 1:
        (first, n), (other, m) = next((a, b) for a in lengths.items() for b in lengths.items() if a[1] != b[1])
        raise Error(f"'{first}' has {n} values and '{other}' has {m}: give one for each instance, or single numbers; "
                    "my.grid(...) combines all values with all")
    return given, domain, next(iter(lengths.values()), 1)


def names_given(components: Components, sweep: Sweep | ByComponent | None, start: ByComponent | None) -> set[str]:
    """The components that a call gives values of."""
    return {components.component(name) for values in (_sweep_values(sweep), start or {}) for name in values}


def fill(ensemble: Any, components: Components, given: Mapping[str, Any], domain: tuple[Any, Any],
          names: Mapping[str, Sequence[str]], real: npt.DTypeLike) -> None:
    for kind in kinds.of_instances:
        for number in range(len(components.names[kind]), len(names[kind])):  # which an interpreted model does not use
            ensemble.array(kind, number)[...] = 0
    for name, array in given.items():
        kind, number = components.place[name]
        if isinstance(array, DeviceInput):
            if kind not in ("state", "parameter"):
                raise Error(f"'{name}' is on a GPU, which only states and parameters can be: copy it to the host")
            if array.dtype != real:
                raise Error(f"'{name}' on the GPU has type {array.dtype}, and the run is in {real}: convert it there, "
                            "or give precision=")
            ensemble.set_on_device(kind, number, array.address)
        elif kind in ("state", "parameter"):
            values, repeat = (array.values, array.repeat) if isinstance(array, Along) else (array, 1)
            ensemble.spread(kind, number, np.ascontiguousarray(np.atleast_1d(values), dtype=real), repeat)
        elif kind in kinds.shared:
            if array.ndim == 1:
                raise Error(f"'{name}' is shared by all instances and has {len(array)} values: give one number, or "
                            "make it a parameter")
            ensemble.array(kind)[number] = whole_numbers(array, name) if kinds.every[kind].integer else array
        else:
            array = np.asarray(array)
            ensemble.array(kind, number)[...] = whole_numbers(array, name) if kinds.every[kind].integer else array
    if any(isinstance(array, DeviceInput) for array in domain):
        raise Error("the times are on a GPU: copy them to the host")
    if domain[0].ndim == 0 and domain[1].ndim == 0:
        ensemble.set_domain(float(domain[0]), float(domain[1]))
    else:
        ensemble.array("t_begin")[...] = domain[0]
        ensemble.array("t_end")[...] = domain[1]
