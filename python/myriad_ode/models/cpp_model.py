# SPDX-License-Identifier: MIT
"""Models that are written in C++ rather than traced."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from ..base.errors import Error
from .any_model import AnyModel

if TYPE_CHECKING:
    from ..symbolic.types import Names


class CppEvent:
    """The name of an event of a model in C++, and how it is detected unless a call says otherwise."""

    def __init__(self, name: str, direction: str = "either", tolerance: float | None = None,
                 stop_after: int = 0) -> None:
        self.name, self.direction, self.tolerance, self.stop_after = name, direction, tolerance, stop_after


def _names(several: Any) -> tuple[str, ...]:
    return tuple(several.replace(",", " ").split() if isinstance(several, str) else several)


class CppModel(AnyModel):
    """A model as a C++ struct, as in the C++ library's documentation: `text` defines the struct `struct`. The other
    arguments name its components in the order of its enumerations, as one string or a list; events may be a dict from
    names to their `direction`, `tolerance` and `stop_after`. `generates` names what the struct's `generate` sets, if a
    study is to call it."""

    not_interpreted = "it is written in C++"
    generated: tuple[str, ...] = ()
    generator = ""
    has_noise = None
    delays = None

    def __init__(self, text: str, struct: str, states: Names, parameters: Names = (), shared: Names = (),
                 shared_integers: Names = (), accessories: Names = (), integer_accessories: Names = (),
                 events: Names | Mapping[str, Mapping[str, Any]] = (), generates: Names = ()) -> None:
        if struct not in text:
            raise Error(f"the text of the model defines no struct {struct}: give the name of the model's struct")
        self._text, self.name = text, struct
        self._set_names({kind: _names(given) for kind, given in (
            ("state", states), ("parameter", parameters), ("shared", shared), ("shared_integer", shared_integers),
            ("accessory", accessories), ("integer_accessory", integer_accessories))})
        options: Any = events if hasattr(events, "items") else dict.fromkeys(_names(events), {})
        self.generated = _names(generates)
        self.generator = f"{struct}::generate" if self.generated else ""
        self.events = tuple(CppEvent(name, **chosen) for name, chosen in options.items())

    def cpp(self) -> str:
        """The text of the model."""
        return self._text

    def source(self) -> tuple[str, str]:
        """The text that kernels are compiled from, and the name of its struct."""
        return self._text, self.name
