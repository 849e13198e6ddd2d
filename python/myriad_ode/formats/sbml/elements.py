# SPDX-License-Identifier: MIT
"""The elements of an SBML file that have values, and what changes each of them."""

from __future__ import annotations

import functools
from dataclasses import dataclass
from typing import Any

from .document import named
from .math import Functions, Refused


@dataclass
class Quantity:
    """Something with an id and a value: a compartment, species, parameter or stoichiometry."""

    id: str
    kind: str
    element: Any
    value: float | None  #: as the file has it
    changes: str = ""  #: what changes it: "assignment", "rate", "reactions", "events"; empty if nothing does
    formula: Any = None  #: of its rule
    initial: Any = None  #: its initial assignment
    compartment: str = ""  #: of a species whose id means a concentration
    given_amount: bool = False  #: whether the value of such a species is its amount
    in_amount: bool = False  #: whether such a species is stored as its amount
    symbol: Any = None

    @property
    def where(self) -> str:
        """The quantity in messages."""
        return named(self.element)


class Elements:
    """The elements of a model of libsbml's."""

    def __init__(self, libsbml: Any, document: Any, model: Any) -> None:
        self.libsbml, self.model, self.level = libsbml, model, document.getLevel()
        self.functions = Functions(libsbml)
        self.quantities: dict[str, Quantity] = {}
        self.reactions: dict[str, Any] = {}
        self._collect()
        self._rules()

    def _all(self, kind: str) -> list[Any]:
        return [getattr(self.model, f"get{kind}")(i) for i in range(getattr(self.model, f"getNum{kind}s")())]

    def _add(self, quantity: Quantity) -> None:
        if quantity.id in self.quantities or quantity.id in self.reactions:
            raise Refused(f"{quantity.where} has the id of something else")
        self.quantities[quantity.id] = quantity

    def _collect(self) -> None:
        for i in range(self.model.getNumFunctionDefinitions()):
            definition = self.model.getFunctionDefinition(i)
            self.functions.definitions[definition.getId()] = definition
        for c in self._all("Compartment"):
            # as in Level 1, and in other programs, the size is 1 where the file leaves it out
            self._add(Quantity(c.getId(), "compartment", c, c.getSize() if c.isSetSize() else 1.0))
        for p in self._all("Parameter"):
            self._add(Quantity(p.getId(), "parameter", p, p.getValue() if p.isSetValue() else None))
        for i in range(self.model.getNumSpecies()):
            self._add(self._species(self.model.getSpecies(i)))
        for r in self._all("Reaction"):
            if r.isSetFast() and r.getFast():
                raise Refused(f"{named(r)} is fast: such reactions are equations without derivatives, which Myriad "
                              "does not solve")
            self.reactions[r.getId()] = r
            for reference in self.references(r):
                name = reference.getIdAttribute()
                if name:
                    self._add(Quantity(name, "stoichiometry", reference, self._stoichiometry_given(reference)))

    def _species(self, s: Any) -> Quantity:
        compartment = self.model.getCompartment(s.getCompartment())
        if compartment is None:
            raise Refused(f"{named(s)} is in no compartment")
        flat = compartment.getSpatialDimensionsAsDouble() == 0 and not compartment.isSetSize()
        given = s.getInitialAmount() if s.isSetInitialAmount() else (
            s.getInitialConcentration() if s.isSetInitialConcentration() else None)
        as_amount = s.getHasOnlySubstanceUnits() or flat
        quantity = Quantity(s.getId(), "species", s, given)
        if not as_amount:
            quantity.compartment, quantity.given_amount = s.getCompartment(), s.isSetInitialAmount()
        elif s.isSetInitialConcentration() and not s.isSetInitialAmount():
            quantity.value, quantity.initial = None, ("concentration", s.getCompartment(), given)
        return quantity

    def references(self, reaction: Any) -> list[Any]:
        """The species of a reaction: its reactants, and then its products."""
        return [*(reaction.getReactant(i) for i in range(reaction.getNumReactants())),
                *(reaction.getProduct(i) for i in range(reaction.getNumProducts()))]

    def _stoichiometry_given(self, reference: Any) -> float | None:
        if self.level < 3:
            return reference.getStoichiometry() / (reference.getDenominator() or 1)
        return reference.getStoichiometry() if reference.isSetStoichiometry() else None

    def _changed(self, name: str, how: str, element: Any) -> Quantity:
        quantity = self.quantities.get(name)
        if quantity is None:
            if name in self.reactions:
                raise Refused(f"{named(element)} sets the rate of a reaction")
            raise Refused(f"{named(element)} sets '{name}', which is not there")
        if quantity.changes and quantity.changes != how:
            raise Refused(f"{quantity.where} is changed by several elements, one of which is {named(element)}")
        quantity.changes = how
        return quantity

    def _rules(self) -> None:
        for rule in self._all("Rule"):
            if rule.isAlgebraic():
                if rule.isSetMath():
                    raise Refused(f"the {named(rule)}: equations without derivatives are not solved")
                continue
            if not rule.isSetMath():
                continue  # as if it were not there
            how = "assignment" if rule.isAssignment() else "rate"
            quantity = self._changed(rule.getVariable(), how, rule)
            quantity.formula = rule
        for i in range(self.model.getNumInitialAssignments()):
            initial = self.model.getInitialAssignment(i)
            if not initial.isSetMath():
                continue
            symbol = initial.getSymbol()
            if symbol not in self.quantities:
                raise Refused(f"the {named(initial)} sets what is not there")
            self.quantities[symbol].initial = initial
        for reaction in self.reactions.values():
            for reference in self.references(reaction):
                name = reference.getSpecies()
                if name not in self.quantities:
                    raise Refused(f"{named(reference)} of {named(reaction)} names no species")
                quantity = self.quantities[name]
                element = quantity.element
                if not (element.getBoundaryCondition() or element.getConstant() or quantity.changes):
                    quantity.changes = "reactions"
        for event in self._all("Event"):
            for i in range(event.getNumEventAssignments()):
                assignment = event.getEventAssignment(i)
                name = assignment.getVariable()
                if name not in self.quantities:
                    raise Refused(f"{named(assignment)} of {named(event)} sets '{name}', which is not there")
                if assignment.isSetMath() and not self.quantities[name].changes:
                    self.quantities[name].changes = "events"

    @functools.cached_property
    def has_delays(self) -> bool:
        """Whether a formula of the file has a delay."""
        return "symbols/delay" in self.libsbml.writeSBMLToString(self.model.getSBMLDocument())
