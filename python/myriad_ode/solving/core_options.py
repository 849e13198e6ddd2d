# SPDX-License-Identifier: MIT
"""From `Options` to the options of the core, by the table of options that the core has."""

from __future__ import annotations

import dataclasses
import inspect
import math
from collections.abc import Callable, Mapping
from typing import Any, TypeVar

import numpy as np

from .. import _core
from ..base import component_kinds as kinds
from ..base.errors import Error, refuse_masked, refuse_options
from ..base.option_names import left_out, names, true_choices
from ..models.components import Components, by_component, unknown
from ..sweeps.inputs import by_name, numbers, only, real, whole
from .options import EventChoice, Options, RecordChoice, SampleChoice

_rows = {row["name"]: row for row in _core.option_rows()}
_fields = {field.name: field for field in dataclasses.fields(Options)}
_largest = 1 << 62  # the core knows what is too large


# -- Options of a call -------------------------------------------------------------------------------------------------

_Function = TypeVar("_Function", bound=Callable[..., Any])


def takes_options(arguments: type) -> Callable[[_Function], _Function]:
    """Of a function that takes `options` and **keywords, which are some of `Options`: its signature with all of them,
    and its documentation with what they mean."""
    def with_signature(function: _Function) -> _Function:
        signature = inspect.signature(function)
        own = [p for p in signature.parameters.values() if p.kind is not p.VAR_KEYWORD]
        keywords = [name for name in _fields if name in _all_keys(arguments)]
        more = [inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, default=_fields[name].default,
                                  annotation=_fields[name].type) for name in keywords]
        function.__signature__ = signature.replace(parameters=own + more)  # type: ignore[attr-defined]
        function.__doc__ = f"{inspect.cleandoc(function.__doc__ or '')}\n\n" + _meanings(keywords)
        return function
    return with_signature


def _all_keys(arguments: type) -> set[str]:
    """The keys of a TypedDict and of what it extends."""
    return set(arguments.__required_keys__ | arguments.__optional_keys__)  # type: ignore[attr-defined]


def _meanings(keywords: list[str]) -> str:
    """What options mean: the part of the documentation of `Options` that is about them."""
    documented = inspect.cleandoc(Options.__doc__ or "").split("\n\n", 1)[1]
    entries = "\n".join(line for line in documented.splitlines())
    chosen, keep = [], False
    for line in entries.splitlines():
        if not line.startswith(" "):
            keep = line.partition(":")[0] in keywords
        if keep:
            chosen.append(line)
    return "\n".join(chosen)


def options_of(options: Options | None, given: Mapping[str, Any], call: Callable[..., Any]) -> Options:
    """The options of a call: some for all, others by name."""
    known = inspect.signature(call).parameters
    refuse_options({name: value for name, value in given.items() if name not in known}, known, call.__name__)
    if options is not None and not isinstance(options, Options):
        raise Error(f"options is a {type(options).__name__}: give my.Options(...), or each option by its name")
    return dataclasses.replace(options or Options(), **given)


def longest_step(given: Options) -> float | None:
    """The length that no step exceeds, if one is given."""
    return given.maximum_step if given.step is None else given.step


# -- Options of the core -----------------------------------------------------------------------------------------------

def make_options(components: Components, size: int, given: Options) -> tuple[_core.Options, dict[str, Any],
                                                                              dict[str, int]]:
    """The core's options, but for tolerances and events, and the places of what is recorded and sampled, by name."""
    made = _core.Options()
    for name, row in _rows.items():
        if "." in name or name in left_out:
            continue
        called = names.get(name, name)
        value = getattr(given, called)
        if row["type"] in ("whole number", "number"):
            if value is not None:  # which stands for the default
                setattr(made, name, _whole(value, called, row) if row["type"] == "whole number" else
                        _given(real(value, called), called))
        elif name in true_choices:
            other, = (c for c in row["choices"] if c != true_choices[name])
            setattr(made, name, true_choices[name] if value else other)
        elif row["type"] == "choice":
            setattr(made, name, _choice(value, called, row["choices"]))
    recorded = _set_records(made, given.record, components)
    sampled = _set_samples(made, given.samples, components, size)
    return made, recorded, sampled


def finish_options(made: _core.Options, given: Options, components: Components, n_state: int, n_event: int) -> None:
    """Sets tolerances and events, for so many states and events of the kernel."""
    made.relative_tolerance = per_state(given.rtol, components, "rtol", n_state)
    made.absolute_tolerance = per_state(given.atol, components, "atol", n_state)
    _set_events(made, given.events, components, n_event)


def _given(value: float, name: str) -> float:
    """An option that is given. In the core NaN stands for one that is not, and other options refuse it in words of
    their own."""
    if math.isnan(value) and _fields[name].default is None:
        raise Error(f"{name} is nan: give a number, or leave it out")
    return value


def _whole(value: Any, name: str, row: Mapping[str, Any]) -> int:
    """A whole number for an option. One that the core cannot hold is refused with the range in its row."""
    within = "" if row["range"].endswith("inf)") else row["range"]
    return whole(value, name, _largest, within)


def _choice(value: Any, name: str, choices: list[str]) -> str:
    if not isinstance(value, str) or value not in choices:
        *most, last = (f'"{c}"' for c in choices)
        raise Error(f"{name} is {value!r}: give {', '.join(most)} or {last}")
    return value


def per_state(value: Any, components: Components, name: str, count: int) -> list[float]:
    """One tolerance for all states, one for each in their order, or a dict by state; those that it leaves out get the
    default. For `count` states, of which those beyond the model's are not used."""
    if hasattr(value, "items"):
        values = [float(getattr(Options(), name))] * len(components.states)
        for state, tolerance in by_component(value, name).items():
            if state not in components.states:
                raise unknown(state, components.states, "state of the model")
            values[components.states.index(state)] = real(tolerance, f"{name} of '{state}'")
    else:
        values = [float(v) for v in np.atleast_1d(numbers(value, name))]
    if len(values) not in (1, len(components.states)):
        raise Error(f"{name} has {len(values)} values, but the model has {len(components.states)} state components: "
                    "give one value for all, or one for each")
    return values + [1.0] * (count - len(components.states)) if len(values) == len(components.states) > 1 else values


def _set_records(options: _core.Options, record: Any, components: Components) -> dict[str, tuple[str, int]]:
    """What of records is asked for: the names of recorded components with kind and number."""
    if record is None:
        return {}
    record = dict(record) if hasattr(record, "items") else {"states": record}
    only(record, RecordChoice.__annotations__, "record=")
    named = components.numbers(record.get("states", ()), "record=", kinds.recorded)
    others = components.numbers(record.get("accessories", ()), "record=", kinds.recorded)
    made = options.record
    places: dict[str, tuple[str, int]] = {}
    for kind, a, b in zip(kinds.recorded, named, others):
        setattr(made, kinds.every[kind].plural, a + b)
        places.update((components.names[kind][c], (kind, c)) for c in a + b)
    made.time = bool(record.get("time", False))
    made.from_phase = _whole(record.get("from_phase", 0), "record from_phase", _rows["record.from_phase"])
    return places


def _set_samples(options: _core.Options, samples: Any, components: Components, size: int) -> dict[str, int]:
    """What of dense output is asked for: the names of sampled states with their numbers."""
    if samples is None:
        return {}
    if not hasattr(samples, "items"):
        samples = {"evenly": samples} if np.ndim(samples) == 0 else {"times": samples}
    only(samples, SampleChoice.__annotations__, "samples=")
    made = options.samples
    made.states, = components.numbers(samples.get("states", components.states), "samples=", ("state",))
    for name in ("evenly", "every", "from_phase"):
        setattr(made, name, _whole(samples.get(name, 0), f"samples {name}", _rows[f"samples.{name}"]))
    made.minimum_spacing = real(samples.get("minimum_spacing", 0), "samples minimum_spacing")
    refuse_masked(samples.get("times"), "samples times")
    try:
        times = np.asarray(samples.get("times", ()), dtype=float)
    except (TypeError, ValueError):
        raise Error(f"samples times are {samples['times']!r}: give numbers") from None
    if sum((made.evenly != 0, made.every != 0, times.size > 0)) != 1:
        raise Error("samples= asks for no samples, or in several ways: give the number of evenly spaced times, the "
                    "times, or dict(every=, capacity=) for every n-th step")
    if times.ndim == 2 and len(times) != size:
        raise Error(f"the sample times have {len(times)} rows for {size} instances: give one row for each, or the same "
                    "times for all in one dimension")
    if times.ndim > 2:
        raise Error("the sample times have more than two dimensions: give one row for each instance, or one for all")
    capacity = samples.get("capacity")
    if capacity is None:
        if made.every:
            raise Error("samples every n-th step need capacity=, the number of samples to keep per instance")
        sampled = max(options.phases - made.from_phase, 1)
        given = times.shape[-1] * (1 if options.phase_length else sampled)
        capacity = made.evenly * sampled if made.evenly else given
    made.capacity = _whole(capacity, "samples capacity", _rows["samples.capacity"])
    if times.ndim == 2:
        made.times_of_instances = times.ravel().tolist()
    else:
        made.times = times.tolist()
    return {components.states[c]: c for c in made.states}


def _set_events(options: _core.Options, events: Any, components: Components, count: int) -> None:
    """Options of events: the model's own, replaced by those that the call gives by name; for `count` events."""
    changed = {}
    for key, value in by_name(events, "events", "events={\"impact\": dict(stop_after=5)}").items():
        name = key if isinstance(key, str) else getattr(key, "name", None)
        if name not in components.event_names:
            raise unknown(str(name), components.event_names, "event of the model")
        only(value, EventChoice.__annotations__, f"event '{name}'")
        changed[name] = value
    made = []
    for event in components.events:
        of_call = changed.get(event.name, {})
        one = _core.EventOptions()
        one.direction = _choice(of_call.get("direction", event.direction), f"the direction of event '{event.name}'",
                                _rows["events.direction"]["choices"])
        tolerance = of_call.get("tolerance", event.tolerance)
        if tolerance is not None:
            one.tolerance = real(tolerance, "tolerance")
        one.stop_after = _whole(of_call.get("stop_after", event.stop_after), "stop_after", _rows["events.stop_after"])
        made.append(one)
    options.events = made + [_core.EventOptions() for _ in range(len(components.events), count)]
