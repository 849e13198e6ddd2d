# SPDX-License-Identifier: MIT
"""The quantities of a run by their names, which studies, datasets, tables and files have too: "x" at recorded phases,
"x_sample", "x_end" and "x_start" of a component, "t", "t_sample" and "t_last", "status" and others."""

from __future__ import annotations

import functools
from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from .. import _core
from ..base import component_kinds as kinds
from ..base.errors import UnknownName
from ..base.statuses import in_words
from ..models.components import unknown
from ..symbolic.node import Node
from .protocol import Quantity

if TYPE_CHECKING:
    from .protocol import Results

# What a component, or the time, stands for by itself: the first of these that there is.
_endings = ("", "_sample", "_end")
times = ("t", "t_sample", "t_last")
counters = ("accepted_steps", "rejected_steps", "located_steps", "rhs_evaluations")


def of_component(called: Iterable[str], there: Iterable[str]) -> str | None:
    """The name of what a component stands for by itself: what was recorded of it, else its samples, else its last
    value. `called` is what results may call it."""
    return next((name + ending for name in called for ending in _endings if name + ending in there), None)


def called(names: Mapping[str, Sequence[str]], outputs: Iterable[str] = ()) -> dict[str, str]:
    """What results call components, of which there are names by kind, and outputs."""
    return _core.result_names({kind: list(names.get(kind, ())) for kind in kinds.every}, list(outputs))


def names_of_symbol(symbol: Node) -> list[str]:
    """What results may call the component of a symbol."""
    kind, name = symbol.value
    return [f"{kind}_{name}", called({kind: [name]})[name]]


def quantities_of(run: Results) -> dict[str, Quantity]:
    """All quantities of a run by name."""
    return {**_records(run), **_samples(run), **_ends(run), **_inputs(run)}


def _records(run: Results) -> dict[str, Quantity]:
    units, called = run._components.units, run._called
    made = {called[name]: _record(run, *place, units.get(name, "")) for name, place in run._recorded.items()}
    if run._records_time:
        made["t"] = _record(run, "time", 0, run._components.time_unit)
    if not made:
        return made
    first = next(iter(made.values()))
    made |= _outputs(run, "phase", "")
    made["phase"] = Quantity(lambda: run.from_phase + np.arange(first.read().shape[1]), "phase", of_instances=False,
                             is_input=True)
    return made


def _record(run: Results, kind: str, number: int, unit: str) -> Quantity:
    read = functools.partial(run._records.records, kind, number)
    return Quantity(read, "phase", functools.partial(read, on_device=True), unit)


def _samples(run: Results) -> dict[str, Quantity]:
    if not run._sampled:
        return {}
    units, called = run._components.units, run._called
    made = {f"{called[name]}_sample": _sample(run, number, units.get(name, ""))
            for name, number in run._sampled.items()}
    made |= _outputs(run, "sample", "_sample")
    made["t_sample"] = _sample(run, -1, run._components.time_unit)._replace(is_input=True)
    made["stored_samples"] = Quantity(run._ensemble.stored_samples, long_name="number of samples")
    return made


def _sample(run: Results, number: int, unit: str) -> Quantity:
    read = functools.partial(run._ensemble.samples, number)
    return Quantity(read, "sample", functools.partial(read, on_device=True), unit)


def _array(run: Results, kind: str, number: int = 0, **more: Any) -> Quantity:
    return Quantity(functools.partial(run._ensemble.array, kind, number), None,
                    functools.partial(run._ensemble.device_array, kind, number), **more)


def _ends(run: Results) -> dict[str, Quantity]:
    """What an instance has at its end."""
    components = run._components
    changed = [*kinds.recorded, *(["parameter"] if components.writes_parameters else [])]
    made = {f"{run._called[name]}_end": _array(run, kind, number, unit=components.units.get(name, ""),
                                               listed=name not in components.hidden)
            for kind in changed for number, name in enumerate(components.names[kind])}
    made |= _outputs(run, None, "_end")
    made["t_last"] = _array(run, "t", unit=components.time_unit, long_name="time at which the last phase ended")
    codes = _array(run, "status", listed=False)
    made["status"] = Quantity(lambda: in_words(codes.read()), long_name="how the integration ended")
    made["status_codes"] = codes
    return {**made, **{name: _array(run, name, listed=False) for name in ("phases_done", *counters)}}


def _outputs(run: Results, along: str | None, ending: str) -> dict[str, Quantity]:
    """Outputs of the model where they are known: along phases or samples, or at the end."""
    components = run._components
    return {run._called[name] + ending: Quantity(functools.partial(run._output_at, along, expression), along,
                                                 unit=components.units.get(name, ""))
            for name, expression in run._outputs.items()
            if along is None or along in run._places_of(expression)}


def _inputs(run: Results) -> dict[str, Quantity]:
    """What instances were given."""
    components, made = run._components, {}
    for name, given in run._inputs.items():
        kind, number = components.place[name]
        if name in components.hidden or name in components.tables:
            continue
        called = run._called[name] + ("_start" if kind in kinds.recorded else "")
        if kind == "parameter" and not components.writes_parameters:
            made[called] = _array(run, kind, number)
        elif kind == "parameter" and not hasattr(given, "address"):  # which an array on a GPU has
            made[called] = Quantity(functools.partial(np.broadcast_to, given, run.size))
        elif kind in kinds.shared:
            made[called] = Quantity(functools.partial(_shared, run, kind, number), of_instances=False)
        elif kind != "parameter" and not hasattr(given, "address"):
            made[called] = Quantity(functools.partial(np.asarray, given), of_instances=given.ndim > 0)
        else:
            continue
        made[called] = made[called]._replace(unit=components.units.get(name, ""), is_input=True)
    for name, end in zip(("t_begin", "t_end"), run._domain):
        made[name] = Quantity(functools.partial(np.asarray, end), None, None, components.time_unit,
                              of_instances=end.ndim > 0, is_input=True)
    return made


def _shared(run: Results, kind: str, number: int) -> Any:
    return run._ensemble.array(kind)[number]


_renamed = {"samples_stored": "stored_samples", "time": "t"}
_renamed_endings = {"_begin": "_start", "_samples": "_sample"}


def unknown_quantity(name: str, there: Sequence[str]) -> UnknownName:
    """The error of a name that no quantity has, with the name that it has now."""
    now = _renamed.get(name, name)
    for before, after in _renamed_endings.items():
        if name.endswith(before):
            now = name.removesuffix(before) + after
    if now != name and now in there:
        return UnknownName(f"'{name}' has another name: use '{now}'")
    return UnknownName(str(unknown(name, there, "name of the results")))


def listed(quantities: Mapping[str, Quantity]) -> list[str]:
    """The names of those that datasets have."""
    return [name for name, quantity in quantities.items() if quantity.listed]
