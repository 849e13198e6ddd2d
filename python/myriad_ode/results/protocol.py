# SPDX-License-Identifier: MIT
"""What pictures, derivatives and arrays on GPUs need of a run."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Protocol

if TYPE_CHECKING:
    from ..models.components import Components
    from ..sweeps.sweep import Sweep
    from ..symbolic.expression import Node
    from ..symbolic.types import Array, Component


class Results(Protocol):
    """The results of a run: arrays by name, and where they are."""

    _components: Components
    _ensemble: Any
    _records: Any
    _recorded: dict[str, tuple[str, int]]
    _sampled: dict[str, int]
    sweep: Sweep | None
    report: Any

    def __getitem__(self, name: Component) -> Array: ...
    @property
    def size(self) -> int: ...
    @property
    def status(self) -> Array: ...
    @property
    def states(self) -> dict[str, Array]: ...
    @property
    def accessories(self) -> dict[str, Array]: ...
    @property
    def records(self) -> dict[str, Array]: ...
    @property
    def samples(self) -> dict[str, Array]: ...
    def _place_of(self, expression: Node) -> str | None: ...
    def _output(self, expression: Node) -> Array: ...
    def _output_at(self, place: str | None, expression: Node) -> Array: ...
