# SPDX-License-Identifier: MIT
"""What is known before any step of a model with delays whose lags are constant: how many fixed steps of the past an
instance needs, and whether the tables of its histories begin early enough."""

from __future__ import annotations

import functools
import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ..base.errors import Error, at, users_line
from ..models.components import short_name
from ..models.delays import first_of_lag
from ..models.extended import Extended
from ..models.methods import fixed_step
from ..models.recorded import RecordedModel
from ..symbolic import symbols as sym
from ..symbolic.axes import Random
from ..symbolic.evaluate import evaluate
from ..symbolic.node import symbols_of, text
from ..symbolic.table import tables_in

if TYPE_CHECKING:
    from ..models.any_model import AnyModel
    from .options import Options

_order = 4  # the highest of methods for fixed steps, that of runge_kutta_4
_most_jumps, _most_to_second = 1024, 16 * 1024  # as in kernel/event/breaking_points.hpp
_largest = 1048576  # of history_steps
_most_combined = 10_000_000  # instances of a study for which the values of several axes are combined
_with_jumps = 1024  # the fewest steps kept where actions, or slopes of the past, make any number of jumps


def values_of_axes(axes: Sequence[Mapping[str, Any]], constants: Mapping[str, Any]) -> dict[str, Any]:
    """What a study knows of its instances, by the names of components: numbers, and arrays along the axes, so that
    those of several axes are combined. Random values are not known."""
    numbers = {name: value for name, value in constants.items() if not isinstance(value, Random)}
    known: dict[str, Any] = {short_name(name): float(value) for name, value in numbers.items()}
    if math.prod(len(next(iter(axis.values()))) for axis in axes) > _most_combined:
        return known
    for number, axis in enumerate(axes):
        for name, values in axis.items():
            known[short_name(name)] = np.asarray(values, float).reshape(-1, *[1] * number)
    return known


def _recorded(model: AnyModel) -> RecordedModel | None:
    """The model that knows its lags as expressions."""
    own = model.model if isinstance(model, Extended) else model
    return own if isinstance(own, RecordedModel) and own.delays else None


def _changed(model: RecordedModel) -> set[Any]:
    """The symbols of what hooks assign."""
    return {target for _, assignments in model._hooks for target, _ in assignments}


def _value(expression: Any, given: Mapping[str, Any], time: Any = None) -> Any:
    """The value of an expression of parameters and shared values in each instance; None if it is not known here."""
    values = {}
    for symbol in symbols_of([expression]):
        value = time if symbol is sym.time else given.get(symbol.value[1])
        if value is None or hasattr(value, "address"):  # on a GPU
            return None
        values[symbol] = value
    return evaluate([expression], values)[0]


def _jumps(lags: int) -> int:
    """The jumps of the past that are followed for one at the begin, with so many lags: those up to the order that
    highest_jump of kernel/event/breaking_points.hpp gives."""
    jumps = 1
    for k in range(1, _order + 1):
        up_to_next = jumps * (lags + k) // k
        if k > 1 and up_to_next > (_most_jumps if k > 2 else _most_to_second):
            break
        jumps = up_to_next
    return jumps


def prepare_past(model: AnyModel, method: str, given: Mapping[str, Any], domain: tuple[Any, Any], options: Options,
                 core_options: Any) -> None:
    """Refuses tables of histories that are too short, and sets how many fixed steps of the past are kept, if that is
    known. `given` has what is known of the instances, by the names of components."""
    refuse_short_tables(model, given, domain[0])
    if (kept := steps_to_keep(model, method, given, domain, options)) is not None:
        core_options.history_steps = kept


def steps_to_keep(model: AnyModel, method: str, given: Mapping[str, Any], domain: tuple[Any, Any],
                  options: Options) -> int | None:
    """The most steps of the past that an instance reads, with fixed steps and constant lags: those over its longest
    lag, or over the whole time if that is shorter, and at each jump one without length and one that it cuts short. None
    where that is not known."""
    own = _recorded(model)
    if own is None or method not in fixed_step or options.history_steps != 0 or not options.step:
        return None
    changed = _changed(own)
    lags = list({id(one.lag): one.lag for one in own.delays}.values())
    if own.writes_time_domain or changed & {*symbols_of(lags)} or not all(one.is_constant for one in own.delays):
        return None
    values = [_value(lag, given) for lag in lags]
    if any(one is None or hasattr(one, "address") for one in (*values, *domain)):
        return None
    within = options.phases * (options.phase_length or np.subtract(domain[1], domain[0]))
    known = [np.where(np.isfinite(value), value, 0.0) for value in values]  # infinite ones never see a step
    reach = np.minimum(functools.reduce(np.maximum, known), np.where(within > 0, within, 0.0))
    steps = min(float(np.max(np.ceil(reach / options.step), initial=0)), _largest)
    jumps_anew = changed or own.events or own.stops or any(one.is_slope for one in own.delays)
    different = len({*first_of_lag(own.delays)})
    return min(max(int(steps) + 2 * _jumps(different) + 4, _with_jumps if jumps_anew else 0), _largest)


def refuse_short_tables(model: AnyModel, given: Mapping[str, Any], begin: Any) -> None:
    """Refuses a history by a table that has no value where a constant lag looks at the begin, or at the begin."""
    own = _recorded(model)
    if own is None or begin is None or hasattr(begin, "address"):
        return
    for one in own.delays:
        history = own.history.get(one.symbol.value[1].state)
        if history is None or not one.is_constant or not tables_in(history):
            continue
        if (lag := _value(one.lag, given)) is None or _changed(own) & {*symbols_of([one.lag, history])}:
            continue
        for time in (begin - lag, begin):
            found = _value(history, given, time)
            if found is None or not np.isnan(found).any():
                continue
            missing = np.broadcast_to(time, np.shape(found))[np.isnan(found)][0]
            raise Error(f"the history of {one.state}{at(users_line())} has no value at {missing:g}, which "
                        f"`{text(one.symbol)}` reads: give a table from the longest lag before the begin up to the "
                        "begin, or outside=\"hold\"")
