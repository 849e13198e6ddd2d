# SPDX-License-Identifier: MIT
"""The names of a model's components."""

from __future__ import annotations

import difflib
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ..base import component_kinds as kinds
from ..base.errors import Error
from ..symbolic import symbols as sym
from ..symbolic.evaluate import evaluate
from ..symbolic.expression import is_sympy
from ..symbolic.node import Node, symbols_of, text
from ..symbolic.read_text import sympy_name
from .any_model import counts_of, names_of
from .units import one_by_one, spread

if TYPE_CHECKING:
    from ..symbolic.types import Array, ByComponent, Component, SomeComponents
    from .any_model import AnyModel


def _briefly(key: object) -> str:
    """What somebody gave, in a few words: an array may have many lines."""
    return f"an array of shape {key.shape}" if isinstance(key, np.ndarray) else repr(key)


def name_of(key: Component) -> str:
    """The name of a component: a symbol's, SymPy's too, or the text itself."""
    if isinstance(key, str):
        return key
    if is_sympy(key):
        return sympy_name(key)
    if isinstance(key, Node) and key.op == "symbol" and key.value[0] != "built-in":
        return key.value[1]
    raise Error(f"{_briefly(key)} is no component of a model: give a symbol, such as x, or its name, such as \"x\"")


def short_name(name: str) -> str:
    """A component's name without its kind, as studies and the core have it in "state.x"."""
    return name.rpartition(".")[2]


def listed(chosen: SomeComponents) -> list[Any]:
    """One component or several, as a list."""
    return [chosen] if isinstance(chosen, (str, Node)) else list(chosen)


def by_component(values: ByComponent, what: str, called: Callable[[Component], str] = name_of) -> dict[str, Any]:
    """Values by the names of components, or by what else they are called; refuses one that is given by its symbol and
    by its name."""
    named: dict[str, Any] = {}
    for key, value in spread(values, what, None).items():
        name = called(key)
        if name in named:
            raise Error(f"'{short_name(name)}' is given twice in {what}: give it once")
        named[name] = value
    return named


def unknown(name: str, known: Iterable[str], what: str) -> Error:
    """The error of a name that is none of the known ones."""
    near = [k for k in known if k.lower() == name.lower()] or difflib.get_close_matches(name, known, 1)
    hint = f"did you mean '{near[0]}'?" if near else f"there are {', '.join(known)}" if known else "there is none"
    return Error(f"'{name}' is no {what}: {hint}")


class Components:
    """Where a model's components are: the kind and number of each name."""

    def __init__(self, model: AnyModel) -> None:
        self.names, self.counts = names_of(model), counts_of(model)
        self.states, self.event_names = self.names["state"], self.names["event"]
        self.tables = model.shared_values  # shared values that the model itself has
        self.defaults = {**self.tables, **model.defaults}  # of components that need not be given
        self.aliases, self.outputs, self.constants = model.aliases, model.outputs, model.constants
        self.past_outputs, self.history_of_outputs = model.past_outputs, model.history_of_outputs
        self.units, self.time_unit = model.units, model.time_unit
        self.generated = list(model.generated)  # components that the model sets in a study
        self.writes_parameters = model.writes_parameters
        self.hidden = model.hidden  # accessories that no user has named
        self.events = list(model.events)
        self.derivatives_by = list(model.free)  # components that a model has derivatives by
        self.place = {name: (kind, number) for kind in kinds.valued for number, name in enumerate(self.names[kind])}

    def component(self, key: Component) -> str:
        """The name of a component that is given by its symbol, its name, or another name of it."""
        name = name_of(key)
        return self.aliases.get(name, name)

    def unknown(self, name: str, known: Iterable[str], what: str) -> Error:
        """The error of a name that is no component, or none of the known ones."""
        if name in self.outputs and name not in self.place:
            return Error(f"'{name}' is an output, which a run computes from its results, and no {what}: name the "
                         "components that it follows from")
        return unknown(name, known, what)

    def completed(self, given: Mapping[str, Any], begin: Any) -> dict[str, Any]:
        """What is given by name, and the defaults of what is not: those that are expressions follow what is given."""
        values, under_way = dict(given), []

        def value(name: str) -> Any:
            if name in values or name not in self.defaults:
                return values.get(name)
            if name in under_way:
                raise Error(f"the value of '{name}' at the start depends on itself: give it in the sweep or in start=")
            under_way.append(name)
            default = self.defaults[name]
            values[name] = self._expression(default, value, begin) if isinstance(default, Node) else np.asarray(default)
            under_way.pop()
            return values[name]

        for name in self.defaults:
            value(name)
        return values

    def follows(self, name: str, others: Collection[str], given: Collection[str]) -> bool:
        """Whether the default of a component depends on any of other components, or on "t", through defaults of others
        that are not given."""
        default = self.defaults.get(name)
        if not isinstance(default, Node) or name in given:
            return False
        names = {"t" if symbol is sym.time else symbol.value[1] for symbol in symbols_of([default])}
        return bool(names & set(others)) or any(self.follows(n, others, given) for n in names - {name})

    @staticmethod
    def _expression(expression: Node, value: Callable[[str], Any], begin: Any) -> Array | None:
        """The value of a default that is an expression, if all that it depends on is known, else None."""
        known = {}
        for symbol in symbols_of([expression]):
            found = begin if symbol is sym.time else value(symbol.value[1])
            if found is None:
                return None
            if hasattr(found, "address"):
                raise Error(f"`{text(expression)}` is the value of a component at the start, and '{symbol.value[1]}' "
                            "is on a GPU: copy it to the host, or give the component itself")
            known[symbol] = np.asarray(found, float)
        result, = evaluate([expression], known)
        return np.asarray(result, float)

    def of(self, some_kinds: Iterable[str]) -> list[str]:
        """The names of the components of some kinds, one kind after the other."""
        return [name for kind in some_kinds for name in self.names[kind]]

    def numbers(self, chosen: SomeComponents, what: str, some_kinds: Sequence[str]) -> list[list[int]]:
        """The numbers of named components of each of some kinds."""
        found: dict[str, list[int]] = {kind: [] for kind in some_kinds}
        chosen = [chosen] if isinstance(chosen, (str, Node)) else chosen
        try:
            chosen = one_by_one(chosen)
        except TypeError:
            raise Error(f"{what}{chosen!r} names no components: give a list of them, as in {what}[x, v]") from None
        for key in chosen:
            name = self.component(key)
            kind, number = self.place.get(name, ("", -1))
            if kind not in found:
                known = [n for n, (k, _) in self.place.items() if k in found]
                raise self.unknown(name, known, f"component of the model that {what} can name")
            found[kind].append(number)
        return [found[kind] for kind in some_kinds]
