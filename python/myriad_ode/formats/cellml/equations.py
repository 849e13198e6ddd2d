# SPDX-License-Identifier: MIT
"""What CellML's variables mean: each as an expression of states, parameters and time."""

from __future__ import annotations

import collections
import math
import re
from typing import Any

from ...symbolic import symbols as sym
from ...symbolic.folding import constant, divide, is_constant, multiply, number, value_of
from .document import Refused
from .library import Analysed
from .math import Translator

Key = tuple[str, str]  # of a variable: its component and its name


def key_of(variable: Any) -> Key:
    return str(variable.parent().name()), str(variable.name())


def usable(name: str) -> str:
    """A name like this of letters, digits and single underscores."""
    made = re.sub("_+", "_", re.sub("[^A-Za-z0-9_]", "_", name)).strip("_") or "unnamed"
    return made if made[0].isalpha() else f"x_{made}"


class Equations:
    """A model of libCellML's. Connected variables are one, by the name and in the units of that which the analysis
    chose: `variables` has them, by that variable. `parameters` are those constants that a sweep may set; None: all."""

    def __init__(self, analysed: Analysed, parameters: list[str] | None) -> None:
        self.analysed, self.model = analysed, analysed.model
        self.scaling = analysed.libcellml.Units.scalingFactor
        self.translate = Translator(analysed.libcellml, self.meaning, self._rate_of)
        model = self.model
        self.time = key_of(model.voi().variable()) if model.voi() is not None else None
        order = {key_of(v): place for place, v in enumerate(analysed.all_variables())}

        def ordered(variables: list[Any]) -> dict[Key, Any]:
            found = {key_of(v.variable()): v for v in variables}
            return {key: found[key] for key in sorted(found, key=lambda key: order[key])}

        self.states, self.constants = ordered(model.states()), ordered(model.constants())
        self.computed = ordered([*model.computedConstants(), *model.algebraicVariables()])
        self.variables = {**self.states, **self.constants, **self.computed}
        self.names = self._names()
        self._of: dict[Key, Key] = {}
        self._known: dict[Any, Any] = {}
        self._under_way, self._starting = set[Key](), set[Key]()
        self._starts: dict[Key, Any] = {}
        self.swept = None if parameters is None else {self._named(given) for given in parameters}

    # -- Names ---------------------------------------------------------------------------------------------------------

    def _names(self) -> dict[Key, str]:
        """A name for each variable: its own, with that of its component before it where others have it too."""
        count = collections.Counter(name for _, name in self.variables)
        taken, names = {name for name, number in count.items() if number == 1}, dict[Key, str]()
        for component, name in self.variables:
            wanted = usable(name if count[name] == 1 else f"{component}_{name}")
            if count[name] == 1:
                taken.discard(name)
            names[component, name] = sym.free_name(wanted, taken)
            taken.add(names[component, name])
        return names

    def aliases(self) -> dict[str, str]:
        """The names of variables by `component.variable`, also of those connected with them in the same units, and by
        their own names, where these are no names of components."""
        own = collections.Counter(name for _, name in self.names)
        found = {name: called for (_, name), called in self.names.items() if own[name] == 1 and name != called}
        for variable in self.analysed.all_variables():
            key = self.chosen(variable)
            if key in self.names and self.scaling(variable.units(), self.variables[key].variable().units()) == 1:
                found[".".join(key_of(variable))] = self.names[key]
        return found

    def _named(self, given: str) -> Key:
        """The constant that a user names."""
        for key in self.constants:
            if given in (self.names[key], ".".join(key), key[1]):
                return key
        raise Refused(f"parameters= names '{given}', which is no constant of the file: there are "
                      f"{', '.join(self.names[key] for key in self.constants)}")

    def where(self, key: Key) -> str:
        return self.analysed.where(*key)

    # -- What variables mean -------------------------------------------------------------------------------------------

    def chosen(self, variable: Any) -> Key:
        """The variable that stands for one and all that are connected with it."""
        key = key_of(variable)
        if key not in self._of:
            found = self.model.analyserVariable(variable)
            self._of[key] = key if found is None else key_of(found.variable())
        return self._of[key]

    def meaning(self, variable: Any) -> Any:
        """The expression of a variable, in the units of the chosen one."""
        return self.value(self.chosen(variable))

    def value(self, key: Key) -> Any:
        """The expression of a chosen variable."""
        if key not in self._known:
            if key in self._under_way:
                raise Refused(f"{self.where(key)} depends on itself: write its value by others alone")
            self._under_way.add(key)
            self._known[key] = self._value(key)
            self._under_way.discard(key)
        return self._known[key]

    def _value(self, key: Key) -> Any:
        if key == self.time:
            return sym.time
        if key in self.states:
            return sym.symbol("state", self.names[key])
        if key in self.constants:
            given = self.start(key)
            if is_constant(given) and (not math.isfinite(value_of(given)) or
                                       self.swept is not None and key not in self.swept):
                return given
            return sym.symbol("parameter", self.names[key])
        if key not in self.computed:
            raise Refused(f"{self.where(key)} has no value: give it an initial_value or an equation")
        return number(self.translate(self._equation(self.computed[key]).rightChild(), self.where(key)))

    def _equation(self, variable: Any) -> Any:
        return variable.analyserEquation(0).ast()

    def slope(self, key: Key) -> Any:
        """The derivative of a state by time. Its left side has a factor where the equation is in other units."""
        if ("slope", key) not in self._known:
            equation = self._equation(self.states[key])
            slope = number(self.translate(equation.rightChild(), self.where(key)))
            left = equation.leftChild()
            if self.translate.name(left) == "times":
                slope = divide(slope, self.translate(left.leftChild(), self.where(key)))
            self._known["slope", key] = slope
        return self._known["slope", key]

    def _rate_of(self, variable: Any) -> Any:
        return self.slope(self.chosen(variable))

    def start(self, key: Key) -> Any:
        """The value of a state or constant at the start: of its `initial_value`, a number or another variable's name,
        in the units of where that stands, or of an equation with numbers alone."""
        if key not in self._starts:
            if key in self._starting:
                raise Refused(f"the initial value of {self.where(key)} depends on itself: give it a number")
            self._starting.add(key)
            self._starts[key] = self._start(key)
            self._starting.discard(key)
        return self._starts[key]

    def _start(self, key: Key) -> Any:
        chosen = self.variables[key]
        given = chosen.initialisingVariable()
        if given is None:
            return number(self.translate(self._equation(chosen).rightChild(), self.where(key)))
        factor = self.scaling(chosen.variable().units(), given.units())
        try:
            value = constant(float(given.initialValue()))
        except ValueError:
            other = given.parent().variable(given.initialValue())
            if other is None:
                raise Refused(f"{self.where(key_of(given))} has the initial value '{given.initialValue()}', which is "
                              "neither a number nor a variable of its component") from None
            if (of := self.chosen(other)) in self.states:
                self.start(of)
            value = self.in_units_of(other)
        return multiply(constant(factor), value)

    def in_units_of(self, variable: Any) -> Any:
        """The value of a variable in its own units, which may be others than those of the chosen one."""
        key = self.chosen(variable)
        chosen = self.variables[key] if key in self.variables else self.model.voi()
        return multiply(constant(self.scaling(variable.units(), chosen.variable().units())), self.value(key))
