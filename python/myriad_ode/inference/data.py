# SPDX-License-Identifier: MIT
"""Data that a model is compared with: a table of times and of values of states and outputs."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ..base.errors import Error
from ..models.components import Components, by_component, unknown
from ..symbolic.symbols import time

if TYPE_CHECKING:
    from ..symbolic.types import Array

_time_names = ("t", "time")


class Data(NamedTuple):
    """Times, values at them by the names of components, NaN where there is none, and which are there."""

    times: Array
    values: dict[str, Array]
    there: dict[str, Array]


def read_data(components: Components, data: Any, begin: float, what: str = "data") -> Data:
    """The times and values of a dict or data frame, checked; `what` it is in messages."""
    columns = _columns(components, data, what)
    times = columns.pop("t", None)
    if times is None:
        raise Error(f"{what} has no times: give them as \"t\"")
    if not columns:
        raise Error(f"{what} has times alone: give values by the names of states or outputs")
    _check(components, times, columns, begin, what)
    return Data(times, columns, {name: np.flatnonzero(~np.isnan(values)) for name, values in columns.items()})


def _columns(components: Components, data: Any, what: str) -> dict[str, Array]:
    """Data by the names of components, times as "t"."""
    if not hasattr(data, "items"):
        raise Error(f"{what} is a {type(data).__name__}: give a dict or a data frame with times and values by name, "
                    "as in {\"t\": times, x: values}, or my.fit and my.likelihood a list of my.experiment(...)")
    columns: dict[str, Array] = {}
    for key, values in data.items():
        is_time = key is time or isinstance(key, str) and key in _time_names and key not in components.place
        name = "t" if is_time else components.component(key)
        if name in columns:
            raise Error(f"{what} has '{name}' twice: give it once")
        try:
            columns[name] = np.asarray(values, float)
        except (TypeError, ValueError):
            raise Error(f"{what} of '{name}' has values that are no numbers: give numbers, NaN where there is none"
                        ) from None
    return columns


def _check(components: Components, times: Array, columns: Mapping[str, Array], begin: float, what: str) -> None:
    """Refuses data that the model has nothing to compare with."""
    possible = [*components.states, *components.outputs]
    for name, values in columns.items():
        if name not in possible:
            raise unknown(name, possible, f"state or output of the model, which {what} are compared with")
        if values.shape != times.shape or values.ndim != 1:
            raise Error(f"{what} has {values.size} values of '{name}' and {times.size} times: give one for each "
                        "time, NaN where there is none")
        if np.isinf(values).any() or np.isnan(values).all():
            raise Error(f"{what} of '{name}' has infinite values, or none: give numbers, NaN where there is none")
    if not np.isfinite(times).all() or (times < begin).any():
        wrong = times[~(np.isfinite(times) & (times >= begin))][0]
        raise Error(f"{what} has the time {wrong:g}, and the model begins at {begin:g}: give finite times from "
                    "there on, or begin=")
    if not (times > begin).any():
        raise Error(f"all times of {what} are {begin:g}, where the model begins: give later ones too")


def by_quantity(components: Components, given: Any, quantities: Collection[str], argument: str) -> dict[str, Any]:
    """What an argument gives for each quantity in data: one thing for all, or things by name."""
    if not hasattr(given, "items"):
        return dict.fromkeys(quantities, given)
    named = {components.component(key): value for key, value in by_component(given, f"{argument}=").items()}
    for name in named:
        if name not in quantities:
            raise unknown(name, list(quantities), "quantity in data")
    return named


def deviations(given: Any, data: Data, name: str, what: str = "sigma") -> Array:
    """Standard deviations of the values of a quantity that are there, from a number or one for each time."""
    values = np.asarray(given, float)
    if values.ndim > 1 or values.ndim == 1 and values.shape != data.times.shape:
        raise Error(f"{what} of '{name}' has {values.size} values for {data.times.size} times: give one, or one for "
                    "each time")
    values = np.broadcast_to(values, data.times.shape)[data.there[name]]
    if not (np.isfinite(values) & (values > 0)).all():
        raise Error(f"{what} of '{name}' has values that are not positive: give standard deviations")
    return values
