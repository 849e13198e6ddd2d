# SPDX-License-Identifier: MIT
"""What SBML's elements mean: each id as an expression of states, parameters and time, and the equations of the states.
"""

from __future__ import annotations

import collections
import functools
import math
import re
from typing import Any

from ...base.errors import Error
from ...models import delays
from ...models.trigger import own_names
from ...symbolic import symbols as sym
from ...symbolic.delays import delayed, pasts_of
from ...symbolic.derivatives import derivatives
from ...symbolic.folding import (add, choose, compare, constant, divide, folded, is_constant, multiply, number,
                                 subtract, total, value_of)
from ...symbolic.node import symbols_of
from ...symbolic.rewrite import rebuilt
from .document import named
from .elements import Elements, Quantity
from .math import Refused, Translator


class Semantics(Elements):
    """A model of libsbml's. `parameters` are the ids of those constants that a sweep may set; None: all."""

    def __init__(self, libsbml: Any, document: Any, model: Any, parameters: list[str] | None) -> None:
        super().__init__(libsbml, document, model)
        self.swept = parameters
        self.names: dict[str, str] = {}  # of components, by what they are for
        self.translate = Translator(self.functions, self.meaning, self.rate_of, sym.time)
        self.translate.rate_of_expression = self.total_derivative
        self.translate.past = self.past
        self.local_names: list[str] = []  # of parameters of kinetic laws
        self._known: dict[Any, Any] = {}
        self._under_way: list[Any] = []
        self.defaults: dict[str, Any] = {}  # values of components at the start, as expressions
        self._represent()

    # -- What is stored ------------------------------------------------------------------------------------------------

    def component_name(self, wanted: str, of: str = "") -> str:
        """A name like the wanted one that a component of a model can have. No component has it yet, and it is no id of
        the file, except the id `of` what is named."""
        name = re.sub("_+", "_", re.sub("[^A-Za-z0-9_]", "_", wanted)).strip("_") or "unnamed"
        name = name if name[0].isalpha() else f"x_{name}"
        if self.model.getNumEvents() and own_names.fullmatch(name) or name in delays.own_names and self.has_delays:
            name = f"{name}_x"
        return sym.free_name(name, {*self.names.values(), *({*self.quantities, *self.reactions} - {of})})

    def new_name(self, wanted: str) -> str:
        """Such a name for something that is no element of the file."""
        name = self.component_name(wanted)
        self.names[f"made {name}"] = name
        return name

    def _represent(self) -> None:
        """Decides how each quantity is stored, and with which name."""
        for quantity in self.quantities.values():
            if quantity.compartment and quantity.changes not in ("rate", "assignment"):
                volume = self.quantities[quantity.compartment]
                known = volume.value is not None or volume.initial is not None
                quantity.in_amount = volume.changes != "" or not known
        for quantity in sorted(self.quantities.values(), key=lambda q: q.kind == "species"):
            if quantity.changes != "assignment":
                self.names[quantity.id] = self.component_name(
                    f"{quantity.id}_amount" if quantity.in_amount else quantity.id, quantity.id)
        for quantity in self.quantities.values():
            self.stored(quantity)
        for quantity in self.quantities.values():
            name = self.names.get(quantity.id)
            start = self._start(quantity)
            if name is not None and start is not None and quantity.symbol.op == "symbol":
                self.defaults[name] = start() if callable(start) else start

    def stored(self, quantity: Quantity) -> Any:
        """The symbol of what is stored of a quantity, or the constant that it is."""
        if quantity.symbol is None and quantity.changes != "assignment":
            quantity.symbol = self._once(("stored", quantity.id), lambda: self._stored(quantity), quantity.where)
        return quantity.symbol

    def _stored(self, quantity: Quantity) -> Any:
        name = self.names[quantity.id]
        if quantity.changes:
            return sym.symbol("state", name)
        if quantity.kind == "stoichiometry" and quantity.initial is None or (
                self.swept is not None and quantity.id not in self.swept):
            start = self._start(quantity)
            start = start() if callable(start) else start
            if start is not None and is_constant(start):
                return start
        if quantity.value is not None and math.isinf(quantity.value) and quantity.initial is None and (
                quantity.id not in (self.swept or ())):
            return constant(quantity.value)  # which no parameter of a model can have
        return sym.symbol("parameter", name)

    def _start(self, quantity: Quantity) -> Any:
        """The value at the start, as it is stored: a constant, a function that gives an expression, or None."""
        volume = quantity.compartment
        if isinstance(quantity.initial, tuple):
            _, inside, given = quantity.initial
            return lambda: multiply(constant(given), self.meaning(inside, quantity.where))
        if quantity.initial is not None:
            formula, where = quantity.initial.getMath(), named(quantity.initial)
            if quantity.in_amount:
                return lambda: multiply(number(self.translate(formula, where)), self.meaning(volume, where))
            return lambda: number(self.translate(formula, where))
        if quantity.value is None:
            return None
        given = constant(quantity.value)
        if volume and quantity.given_amount != quantity.in_amount:
            if quantity.in_amount:
                return lambda: multiply(given, self.meaning(volume, quantity.where))
            return lambda: divide(given, self.meaning(volume, quantity.where))
        return given

    # -- What ids mean -------------------------------------------------------------------------------------------------

    def _once(self, key: Any, make: Any, where: str) -> Any:
        """What `make` gives, computed once, and once for times that may be before the start; refuses what depends on
        itself."""
        key = (*key, self.translate.is_past and key[0] != "stored")
        if key not in self._known:
            if key in self._under_way:
                raise Refused(f"{where} depends on itself")
            self._under_way.append(key)
            self._known[key] = make()
            self._under_way.pop()
        return self._known[key]

    def meaning(self, name: str, where: str) -> Any:
        """The expression that an id stands for in formulas."""
        if name in self.reactions:
            return self.reaction_rate(name)
        quantity = self.quantities.get(name)
        if quantity is None:
            raise Refused(f"'{name}', which is no species, parameter, compartment or reaction, in {where}")
        if quantity.changes == "assignment":
            rule = quantity.formula
            return self._once(("meaning", name), lambda: number(self.translate(rule.getMath(), named(rule))),
                              named(rule))
        symbol = self.stored(quantity)
        return divide(symbol, self.meaning(quantity.compartment, where)) if quantity.in_amount else symbol

    def amount(self, name: str) -> Any:
        """The amount of a species."""
        quantity = self.quantities[name]
        if quantity.in_amount:
            return self.stored(quantity)
        meaning = self.meaning(name, quantity.where)
        return multiply(meaning, self.meaning(quantity.compartment, quantity.where)) if quantity.compartment else (
            meaning)

    def concentration(self, name: str) -> Any:
        """The concentration of a species."""
        quantity = self.quantities[name]
        meaning = self.meaning(name, quantity.where)
        if quantity.compartment:
            return meaning
        return divide(meaning, self.meaning(quantity.element.getCompartment(), quantity.where))

    def reaction_rate(self, name: str) -> Any:
        """The rate of a reaction, in substance per time."""
        reaction = self.reactions[name]
        return self._once(("reaction", name), lambda: self._kinetic_law(reaction), named(reaction))

    def _kinetic_law(self, reaction: Any) -> Any:
        law = reaction.getKineticLaw()
        if law is None or not law.isSetMath():
            raise Refused(f"{named(reaction)} has no kinetic law")
        local = {}
        getters = (law.getNumLocalParameters, law.getLocalParameter) if self.level > 2 else (
            law.getNumParameters, law.getParameter)
        for i in range(getters[0]()):
            parameter = getters[1](i)
            full = f"{reaction.getId()}_{parameter.getId()}"
            self.local_names.append(full)
            given = constant(parameter.getValue()) if parameter.isSetValue() else None
            if self.swept is not None and full not in self.swept and given is not None:
                local[parameter.getId()] = given
                continue
            component = self.names[f"{reaction.getId()}.{parameter.getId()}"] = self.component_name(full)
            local[parameter.getId()] = sym.symbol("parameter", component)
            if given is not None:
                self.defaults[component] = given
        return number(self.translate(law.getMath(), f"the kinetic law of {named(reaction)}", local))

    def stoichiometry(self, reference: Any, reaction: Any) -> Any:
        """The stoichiometry of a species in a reaction."""
        name = reference.getIdAttribute()
        where = f"the stoichiometry of '{reference.getSpecies()}' in {named(reaction)}"
        if self.level == 2 and reference.isSetStoichiometryMath() and reference.getStoichiometryMath().isSetMath():
            return number(self.translate(reference.getStoichiometryMath().getMath(), where))
        if name:
            return self.meaning(name, where)
        given = self._stoichiometry_given(reference)
        if given is None:
            raise Refused(f"{where} has no value")
        return constant(given)

    def amount_rate(self, name: str) -> Any:
        """The rate of a species' amount that reactions cause."""
        return self._once(("amount rate", name), lambda: self._reactions_of(name), self.quantities[name].where)

    @functools.cached_property
    def _references_of(self) -> dict[str, list[tuple[str, Any, bool]]]:
        """Where reactions have each species: the reaction, the reference, and whether the reaction takes it."""
        found = collections.defaultdict(list)
        for key, reaction in self.reactions.items():
            reactants = reaction.getNumReactants()
            for i, reference in enumerate(self.references(reaction)):
                found[reference.getSpecies()].append((key, reference, i < reactants))
        return found

    def _reactions_of(self, name: str) -> Any:
        terms = [(lost, multiply(self.stoichiometry(reference, self.reactions[key]), self.reaction_rate(key)))
                 for key, reference, lost in self._references_of.get(name, ())]
        gained = total([t for lost, t in terms if not lost])
        rate = subtract(gained, total([t for lost, t in terms if lost]))
        element = self.quantities[name].element
        factor = element.getConversionFactor() or self.model.getConversionFactor()
        return multiply(rate, self.meaning(factor, self.quantities[name].where)) if factor else rate

    # -- Rates ---------------------------------------------------------------------------------------------------------

    def slope(self, quantity: Quantity) -> Any:
        """The derivative of a state by time."""
        return self._once(("slope", quantity.id), lambda: self._slope(quantity), quantity.where)

    def _slope(self, quantity: Quantity) -> Any:
        if quantity.changes == "rate":
            return number(self.translate(quantity.formula.getMath(), named(quantity.formula)))
        if quantity.changes != "reactions":
            return constant(0.0)
        rate = self.amount_rate(quantity.id)
        if quantity.compartment and not quantity.in_amount:
            return divide(rate, self.meaning(quantity.compartment, quantity.where))
        return rate

    def states(self) -> list[Quantity]:
        """What the model integrates."""
        return [q for q in self.quantities.values() if q.changes not in ("", "assignment")]

    def rate_of(self, name: str, where: str) -> Any:
        """The derivative by time of what an id stands for."""
        quantity = self.quantities.get(name)
        if quantity is not None and quantity.changes != "assignment" and not quantity.in_amount:
            return self._now(self.slope(quantity), where) if quantity.changes else constant(0.0)
        return self._now(self._once(("rate of", name), lambda: self.total_derivative(self.meaning(name, where), where),
                                    where), where)

    def _now(self, rate: Any, where: str) -> Any:
        """A rate, which is zero before the start, where nothing changes."""
        if not self.translate.is_past or is_constant(rate) and value_of(rate) == 0:
            return rate
        if any(s.value[0] == "state" and self.before(s) is not None for s in symbols_of([rate])):
            raise Refused(f"the rate, before the start, of what an initial assignment lets depend on time, in {where}")
        return choose(compare("less", sym.time, constant(0.0)), constant(0.0), rate)

    def total_derivative(self, expression: Any, where: str) -> Any:
        """The derivative by time of an expression along the solution."""
        states = self.states()
        found = derivatives([expression], [sym.time, *(q.symbol for q in states)])
        if found is None:
            raise Refused(f"the rate of something that has no derivative, in {where}")
        if pasts_of([expression]):
            raise Refused(f"the rate of a delayed value, in {where}")
        rate = constant(0.0)
        for i, partial in found[0].items():
            slope = constant(1.0) if i == 0 else self.slope(states[i - 1])
            if not (is_constant(slope) and value_of(slope) == 0):
                rate = add(rate, multiply(number(partial), slope))
        return rate

    # -- The past ------------------------------------------------------------------------------------------------------

    def past(self, value: Any, lag: Any, where: str) -> Any:
        """The value of an expression some time ago. Before the start, constants are what their initial assignments make
        of that time."""
        if is_constant(lag) and value_of(lag) == 0 or is_constant(value):
            return value
        if is_constant(lag) and not 0 < value_of(lag) < math.inf:
            raise Refused(f"a delay of {value_of(lag):g}, in {where}: it is a time, of zero or more")
        try:
            made = delayed(value, lag)
        except Error as error:
            raise Refused(f"a delay, in {where}: {error}") from None
        then = subtract(sym.time, lag)
        is_early = compare("less", then, constant(0.0))
        known: dict[Any, Any] = {}
        for symbol in symbols_of([value]):
            if symbol.value[0] == "parameter" and (before := self.before(symbol)) is not None:
                known[symbol] = choose(is_early, rebuilt([before], folded, {sym.time: then})[0], symbol)
        return rebuilt([made], folded, known)[0]

    def before(self, symbol: Any) -> Any:
        """What a state or constant was before the start, as an expression of time and constants: what its initial
        assignment makes of the time; None where it is the initial value."""
        where = f"the initial value of {symbol.value[1]}"
        return self._once(("before", symbol.value), lambda: self._before(symbol), where)

    def _before(self, symbol: Any) -> Any:
        quantity = next((q for q in self.quantities.values() if q.symbol is symbol), None)
        start = None if quantity is None else self._start(quantity)
        start = start() if callable(start) else start
        if start is None:
            return None
        states = {s for s in symbols_of([start]) if s.value[0] == "state"}
        inner = {s: found for s in states if (found := self.before(s)) is not None}
        if not inner and not any(s is sym.time for s in symbols_of([start])):
            return None
        if any(s not in inner for s in states):
            raise Refused(f"{quantity.where if quantity else symbol.value[1]} is read with a delay, and what it was "
                          "before the start depends on a state")
        return rebuilt([start], folded, inner)[0]
