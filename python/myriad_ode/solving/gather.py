# SPDX-License-Identifier: MIT
"""What calls of `solve` and studies are given, by name and complete, and the ensemble that `solve` fills."""

from __future__ import annotations

import functools
from collections.abc import Callable, Collection, Container, Mapping, Sequence
from typing import TYPE_CHECKING, Any, NoReturn

import numpy as np

from ..base import component_kinds as kinds
from ..base.errors import Error, quoted
from ..models.any_model import AnyModel
from ..models.components import Components, by_component, short_name
from ..models.sensitivities import ends_of_domain
from ..sweeps.gpu_inputs import DeviceInput
from ..sweeps.inputs import Along, by_name, numbers, whole, whole_numbers
from ..sweeps.sweep import Sweep, refuse_others
from ..symbolic.axes import Axis, Random, drawn
from ..symbolic.node import Node

if TYPE_CHECKING:
    import numpy.typing as npt

    from ..symbolic.types import ByComponent, Component, Values


def _named(sweep: Sweep | ByComponent | None, start: ByComponent | None, in_sweep: Callable[[Component], str],
           in_start: Callable[[Component], str]) -> dict[str, Any]:
    """The values of a sweep, an object like `my.grid(...)` or a dict, and of start=, by what these functions call the
    components. Refuses a component that is given twice."""
    refuse_others(sweep)
    if isinstance(sweep, Sweep):
        sweep = {**{name: Along(sweep, name) for name in sweep.coordinates}, **sweep.constants}
    given = by_component({} if sweep is None else sweep, "the sweep", in_sweep)
    initial = by_component(by_name(start, "start", "start={x: 1, v: 0}"), "start=", in_start)
    for name in initial:
        if name in given:
            raise Error(f"'{short_name(name)}' is given in the sweep and in start=: give it once")
    return {**given, **initial}


def given_values(components: Components, sweep: Sweep | ByComponent | None,
                 start: ByComponent | None) -> dict[str, Any]:
    """The values that a call of `solve` gives, by the names of components."""
    def settable(source: str, some_kinds: Collection[str], key: Component) -> str:
        name = components.component(key)
        if components.place.get(name, ("",))[0] not in some_kinds:
            known = [n for n, (kind, _) in components.place.items()
                     if n not in {*components.tables, *components.hidden} and kind in some_kinds]
            raise components.unknown(name, known, f"component of the model that {source} can set")
        return name

    return _named(sweep, start, functools.partial(settable, "the sweep", kinds.valued),
                  functools.partial(settable, "start=", kinds.recorded))


def full_name(components: Components, key: Component) -> str:
    """The core's name of a component, "state.x", or of an end of the time domain, "t_begin"."""
    if isinstance(key, Node) and key in ends_of_domain:
        return ends_of_domain[key]
    name = components.component(key)
    if name in components.place:
        return f"{components.place[name][0]}.{name}"
    if name in ends_of_domain.values():
        return name
    known = [n for n in components.place if n not in components.tables]
    raise components.unknown(name, known, "component of the model")


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
            raise Error(f"the {what} of {quoted(missing)} is missing: give it in {where}{hint}")


def _refuse_lengths(lengths: Mapping[str, int]) -> None:
    """Refuses values of which there are not equally many."""
    if len(set(lengths.values())) > 1:
        (first, n), (other, m) = next((a, b) for a in lengths.items() for b in lengths.items() if a[1] != b[1])
        raise Error(f"'{first}' has {n} values and '{other}' has {m}: give one for each instance, or single numbers; "
                    "my.grid(...) combines all values with all")


def refuse_shared(kind: str, name: str, values: Any) -> NoReturn:
    """Refuses values of a component that all instances share, where they differ between instances."""
    if isinstance(values, Along):
        values = values.given
    what = "is random" if isinstance(values, Random) else f"has {len(values)} values"
    cure = ("and make a call for each" if kinds.every[kind].integer else
            f"or make it a parameter where the model is made, as by my.parameter(\"{name}\") instead of "
            f"my.shared(\"{name}\")")
    raise Error(f"'{name}' is shared by all instances and {what}: give one number, {cure}")


def refuse_backwards(model: AnyModel, begin: Any, end: Any) -> None:
    """Refuses a time domain that goes backwards, of arrays that fit, where the model has doses."""
    if model.has_doses and not isinstance(begin, DeviceInput) and not isinstance(end, DeviceInput):
        begin, end = np.broadcast_arrays(begin, end)
        if (end < begin).any():
            first, last = begin[end < begin][0], end[end < begin][0]
            raise Error(f"the model {model.name} has doses, and time goes from {first:g} to {last:g}: backwards a dose "
                        "would be given where it has to be taken away, so let time go forwards")


def gather(components: Components, values: Mapping[str, Any], sweep: Sweep | ByComponent | None,
           time: tuple[Values, Values] | None, size: int | None) -> tuple[dict[str, Any], tuple[Any, Any], int]:
    """All inputs of a call of `solve` by name, of which `values` are given, and the number of instances."""
    begin, end = ends_of(time)
    domain = numbers(begin, "begin of time"), numbers(end, "end of time")
    given: dict[str, Any] = {name: numbers(value, name) for name, value in values.items()}
    given = {name: value for name, value in components.completed(given, domain[0]).items() if value is not None}
    refuse_missing(components, given)
    lengths = {name: len(a) for name, a in (*given.items(), ("begin of time", domain[0]), ("end of time", domain[1]))
               if a.ndim == 1}
    if size is not None:
        lengths["size"] = whole(size, "size", 1 << 62)
    if isinstance(sweep, Sweep):
        lengths["the sweep"] = sweep.size
    _refuse_lengths(lengths)
    return given, domain, next(iter(lengths.values()), 1)


def gather_axes(components: Components, sweep: Sweep | ByComponent | None, start: ByComponent | None,
                time: tuple[Any, Any] | None) -> tuple[list[dict[str, Any]], dict[str, Any]]:
    """The inputs of a study by the core's names: the values along each axis, and those of all instances together, or
    that are drawn for each."""
    called = functools.partial(full_name, components)
    given = _named(sweep, start, called, called)
    for name, value in zip(ends_of_domain.values(), ends_of(time)):
        if value is not None and name in given:
            raise Error(f"'{name}' is given in the sweep and in time=: give None there")
        if value is not None:
            given[name] = value
    on_grid: dict[str, dict[str, Any]] = {axis: {} for axis, _ in sweep.axes} if isinstance(sweep, Sweep) else {}
    together: dict[str, Any] = {}
    constants: dict[str, Any] = {}
    for name, value in given.items():
        if isinstance(value, Along):
            on_grid[value.axis][name] = value.given
            continue
        value = drawn(value)
        if not isinstance(value, Axis):
            value = numbers(value, short_name(name))
        (together if value.ndim else constants)[name] = value
    if together and isinstance(sweep, Sweep):
        name, value = next(iter(together.items()))
        raise Error(f"'{name}' has {len(value)} values beside a grid: make it an axis of the grid, as in "
                    "my.grid({x: ...})")
    _refuse_lengths({short_name(name): len(value) for name, value in together.items()})
    return [*on_grid.values(), *([together] if together else [])], constants


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
            values, repeat = array.values_and_repeat if isinstance(array, Along) else (array, 1)
            ensemble.spread(kind, number, np.ascontiguousarray(np.atleast_1d(values), dtype=real), repeat)
        elif kind in kinds.shared:
            if array.ndim == 1:
                refuse_shared(kind, name, array)
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
