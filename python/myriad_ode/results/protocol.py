# SPDX-License-Identifier: MIT
"""What pictures, derivatives and arrays on GPUs need of a run."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any, NamedTuple, Protocol

if TYPE_CHECKING:
    from ..models.components import Components
    from ..sweeps.sweep import Sweep
    from ..symbolic.node import Node
    from ..symbolic.types import Array, Component


class Quantity(NamedTuple):
    """One quantity: how it is read, and where it is on a GPU; what it is along behind the instances, "phase" or
    "sample"; its unit, and what it is in words; whether each instance has its own; whether it is an input; and whether
    datasets have it."""

    read: Callable[[], Any]
    along: str | None = None
    device: Callable[[], Any] | None = None
    unit: str = ""
    long_name: str = ""
    of_instances: bool = True
    is_input: bool = False
    listed: bool = True


class Results(Protocol):
    """The results of a run: arrays by name, and where they are."""

    _components: Components
    _ensemble: Any
    _records: Any
    _recorded: dict[str, tuple[str, int]]
    _sampled: dict[str, int]
    _inputs: dict[str, Any]
    _domain: tuple[Any, Any]
    _records_time: bool
    sweep: Sweep | None
    report: Any
    from_phase: int

    def __getitem__(self, key: Component) -> Array: ...
    def _along(self, dimension: str, name: str) -> Array | None: ...
    @property
    def size(self) -> int: ...
    @property
    def description(self) -> dict[str, Any]: ...
    @property
    def status_codes(self) -> Array: ...
    @property
    def states(self) -> dict[str, Array]: ...
    @property
    def accessories(self) -> dict[str, Array]: ...
    @property
    def records(self) -> dict[str, Array]: ...
    @property
    def samples(self) -> dict[str, Array]: ...
    @property
    def parameters(self) -> dict[str, Array]: ...
    @property
    def shared(self) -> dict[str, Any]: ...
    @property
    def _outputs(self) -> Mapping[str, Node]: ...
    @property
    def _called(self) -> dict[str, str]: ...
    @property
    def _quantities(self) -> dict[str, Quantity]: ...
    def _find(self, key: Component) -> str: ...
    def _of_component(self, name: str) -> str | None: ...
    def _values_of(self, component: str) -> Array: ...
    def _places_of(self, expression: Node) -> list[str | None]: ...
    def _output_at(self, place: str | None, expression: Node) -> Array: ...
