# SPDX-License-Identifier: MIT
"""What the core makes of a sweep, for one without instances, which the core does not take."""

from __future__ import annotations

import types
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, NoReturn

import numpy as np

from .. import _core
from ..base import component_kinds as kinds
from ..base.errors import Error

if TYPE_CHECKING:
    import numpy.typing as npt

    from ..models.components import Components
    from ..symbolic.types import Array

_names = _core.status_names()
_types = {"status": np.uint8, **{kind.name: np.int32 for kind in kinds.every.values() if kind.integer},
          **dict.fromkeys(("phases_done", "accepted_steps", "rejected_steps", "located_steps", "rhs_evaluations"),
                          np.int64)}


class EmptyEnsemble:
    """Arrays of length zero."""

    def __init__(self, components: Components, given: Mapping[str, Any], real: npt.DTypeLike, capacity: int) -> None:
        self._real, self._capacity = real, capacity
        self._shared = {kind: np.array([given[name] for name in components.names[kind]], _types.get(kind, real))
                        for kind in kinds.shared}

    def array(self, kind: str, number: int = 0) -> Array:
        return self._shared[kind] if kind in self._shared else np.empty(0, _types.get(kind, self._real))

    def device_array(self, *_: object) -> NoReturn:
        raise Error("a run without instances has nothing on a GPU: use run[...]")

    def stored_samples(self) -> Array:
        return np.empty(0, np.int32)

    def samples(self, number: int, on_device: bool = False) -> Array:
        return np.empty((0, self._capacity), self._real)


class EmptyReport:
    """A report of nothing."""

    by_status, device = [0] * len(_names), "none"
    notes: list[str] = []
    instances = accepted_steps = rejected_steps = located_steps = rhs_evaluations = 0
    seconds = kernel_seconds = 0.0

    def __init__(self, columns: int, real: npt.DTypeLike) -> None:
        self._columns, self._real = columns, real

    def records(self, kind: str, number: int, on_device: bool = False) -> Array:
        return np.empty((0, self._columns), _types.get(kind, self._real))

    def __str__(self) -> str:
        return "0 instances"


kernel = types.SimpleNamespace(origin="none, as there is no instance", seconds=0.0)
