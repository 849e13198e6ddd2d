# SPDX-License-Identifier: MIT
"""What the instances of a study are given: values along its axes, random ones, and those of all instances."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from .. import _core
from ..base.component_kinds import shared as shared_kinds
from ..base.errors import Error
from ..models.components import Components, short_name
from ..solving.gather import full_name, gather_axes, refuse_missing, refuse_shared
from ..solving.past import values_of_axes
from ..symbolic.axes import Axis, Random

if TYPE_CHECKING:
    from ..sweeps.sweep import Sweep
    from ..symbolic.types import ByComponent


class Instances(NamedTuple):
    """What is known of the instances of a study."""

    values: dict[str, Any]  #: those that are known, by name, each axis along a dimension of its own
    shared_integers: dict[str, int]
    own_domains: bool  #: whether they begin or end at different times


def set_instances(made: _core.Study, components: Components, sweep: Sweep | ByComponent | None,
                  start: ByComponent | None, time: tuple[Any, Any] | None, repeated: bool) -> Instances:
    """Gives a study its axes, random values and values for all instances."""
    axes, constants = gather_axes(components, sweep, start, time)
    varying = [*(name for axis in axes for name in axis),
               *(name for name, value in constants.items() if isinstance(value, Random))]
    given = {short_name(name) for name in (*constants, *varying)}
    for name in components.generated:
        if name in given:
            raise Error(f"'{name}' is given to the study, and generate= of the model sets it: give it once")
    refuse_missing(components, {*components.defaults, *components.generated, *given})
    if components.generated and not axes and not repeated:
        raise Error("the model generates its instances, and nothing says how many: give draws=")
    defaults = _defaults(components, constants, varying)
    for name, value in defaults.items():
        if name not in given:
            made.set(full_name(components, name), value)
    for axis in axes:
        _set_axis(made, axis)
    shared_integers = {short_name(name): int(value) for name, value in constants.items()
                       if name.startswith("shared_integer.")}
    for name, value in constants.items():
        if isinstance(value, Random):
            if (kind := name.partition(".")[0]) in shared_kinds:
                refuse_shared(kind, short_name(name), value)
            made.axis(name, value.core())
        else:
            made.set(name, float(value))
    known = {**defaults, **values_of_axes(axes, constants)}
    known = {name: value for name, value in known.items() if name not in components.generated}
    return Instances(known, shared_integers, own_domains=not {"t_begin", "t_end"}.isdisjoint(varying))


def _set_axis(made: _core.Study, axis: Mapping[str, Any]) -> None:
    """An axis, with all whose values go along it."""
    for name, values in axis.items():
        if len(values) == 0:
            raise Error(f"'{short_name(name)}' has no values: a study has one instance or more; my.solve takes a "
                        "sweep of none")
        if (kind := name.partition(".")[0]) in shared_kinds:
            refuse_shared(kind, short_name(name), values)
    pairs = [(name, values.core() if isinstance(values, Axis) else
              _core.values(np.asarray(values, float).tolist())) for name, values in axis.items()]
    if len(pairs) == 1:
        made.axis(*pairs[0])
    else:
        made.zip(pairs)


def _defaults(components: Components, constants: Mapping[str, Any], varying: Sequence[str]) -> dict[str, float]:
    """The values of components that are not given, as numbers."""
    ends = {"t_begin", "t_end"}
    unknown = {short_name(name): np.nan for name in varying if name not in ends}
    fixed = {short_name(name): value for name, value in constants.items()
             if name not in ends and not isinstance(value, Random)}
    differ = {*unknown, *({"t"} if "t_begin" in varying else ())}
    known = components.completed({**fixed, **unknown}, constants.get("t_begin", 0.0))
    found = {n: v for n, v in known.items() if n in components.defaults and n not in components.tables}
    for name in found:
        if name not in fixed and name not in unknown and components.follows(name, differ, fixed):
            raise Error(f"'{name}' follows from what differs between the instances of the study: give it in the "
                        "sweep or in start=, or use my.solve")
    return {n: float(v) for n, v in found.items() if v is not None and n not in unknown}
