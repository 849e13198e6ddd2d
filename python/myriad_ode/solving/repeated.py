# SPDX-License-Identifier: MIT
"""A call of `solve` on a CPU that is prepared once, and made again and again with other values of some components."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from .. import _core
from ..base import component_kinds as kinds
from ..symbolic.symbols import time as time_symbol
from .core_options import options_of
from .solve import Call, devices_of, solve

if TYPE_CHECKING:
    from ..models.any_model import AnyModel
    from ..models.components import Components

# What has no place in a repeated call, unless it is None or False.
_left_out = ("tolerance_scale", "size", "paths", "make_consistent", "progress")
_of_solve = ("device", "interpreted", "method", "control", "precision", "sensitivity_control")


def repeated_call(model: AnyModel, given: Sequence[str], results: Sequence[Sequence[Any]], samples: int | None,
                  options: Mapping[str, Any], *, sweep: Mapping[str, Any], start: Mapping[str, Any],
                  free: Sequence[str] | None = None) -> Any:
    """A call of the core for values of the states and parameters `given`. Each of its `results` is an array of several
    quantities: states, accessories, or `my.time` for the time at which the last phase ended. `samples`: how many an
    instance has; None for what is there at the end. The other arguments are those of `solve`. Returns None if only
    `solve` can do it: not on one CPU, if anything else differs between instances or follows from what is given, or if
    a quantity is no array of the core's."""
    if model.delays:  # whose instances have a past
        return None
    own = {**options}
    left_out = [own.pop(name, None) for name in _left_out]
    if any(value is not None and value is not False for value in left_out):
        return None
    chosen = {name: own.pop(name) for name in _of_solve if name in own}
    time, common = own.pop("time", None), own.pop("options", None)
    devices, _ = devices_of(chosen.pop("device", "auto"), interpreted := chosen.pop("interpreted", None))
    if not devices[0].startswith("cpu"):
        return None
    call = Call(model, chosen.get("method"), chosen.get("control", ()), chosen.get("precision", "double"), free,
                chosen.get("sensitivity_control", True))
    values = dict.fromkeys(given, 1.0)  # any, as each call has its own
    states = call.components.states
    call.gather({**sweep, **{name: value for name, value in values.items() if name not in states}},
                {**start, **{name: value for name, value in values.items() if name in states}}, time, None,
                options_of(common, own, solve))
    known = {*sweep, *start, *values}
    sampled = call.core_options.samples
    if (call.count != 1 or any(end.ndim for end in call.domain) or sampled.times_of_instances
            or sampled.capacity != (samples or 0)
            or any(call.components.follows(name, given, known) for name in call.components.defaults)):
        return None
    arrays = [[_place(call.components, name, call.sampled if samples else None) for name in one] for one in results]
    if any(place is None for one in arrays for place in one):
        return None
    call.prepare(devices, interpreted)
    kind: Any = _core.RepeatedCall64 if call.real == np.float64 else _core.RepeatedCall32
    return kind(call.kernel.library, call.filled(), call.core_options, devices[0],
                [call.components.place[name] for name in given], arrays)


def _place(components: Components, name: Any, sampled: Mapping[str, int] | None) -> tuple[str, int] | None:
    """The array of a result: kind and number."""
    if name is time_symbol:
        return "t", 0
    if sampled is not None:
        return ("state", sampled[name]) if name in sampled else None
    kind, number = components.place.get(name, ("", 0))
    return (kind, number) if kind in kinds.recorded else None
