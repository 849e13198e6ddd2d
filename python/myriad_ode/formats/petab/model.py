# SPDX-License-Identifier: MIT
"""The model of a problem of PEtab: its SBML with a rule for each observable and its noise, and a parameter for all that
conditions, measurements and fits set."""

from __future__ import annotations

import re
from typing import Any

from ..sbml.document import library
from ..sbml.math import Refused
from ..sbml.model import SbmlModel, read_sbml
from .formulas import parsed


class PetabModel:
    """The SBML of a problem, to which observables and parameters are added."""

    def __init__(self, text: str) -> None:
        self._libsbml = library()
        self._document = self._libsbml.readSBMLFromString(text)
        self._model = model = self._document.getModel()
        rules = [model.getRule(i) for i in range(model.getNumRules())]
        events = [model.getEvent(i) for i in range(model.getNumEvents())]
        self._ruled = {rule.getVariable() for rule in rules if rule.isAssignment()}
        self._changing = {rule.getVariable() for rule in rules} | {
            e.getEventAssignment(i).getVariable() for e in events for i in range(e.getNumEventAssignments())}
        self.swept: list[str] = []  #: ids of the parameters that instances set
        self.file_values: dict[str, float] = {}  #: those of the file by target, if they are numbers

    def add(self, name: str, formula: Any, where: str) -> str:
        """Adds a quantity with a formula. Returns its id."""
        name = self._unused(name)
        self._add_parameter(name, constant=False)
        rule = self._model.createAssignmentRule()
        rule.setVariable(name)
        rule.setMath(self._parsed(formula, where))
        return name

    def add_constant(self, name: str) -> str:
        """Adds a parameter that nothing reads and instances set. Returns its id."""
        name = self._unused(name)
        self._add_parameter(name, constant=True)
        self._model.getParameter(name).setValue(0.0)
        self.swept.append(name)
        return name

    def add_placeholders(self, formula: Any, kind: str, observable: str) -> list[str]:
        """Adds the placeholders of a formula, as `noiseParameter1_x`. Returns their ids in order."""
        numbers = re.findall(rf"\b{kind}Parameter(\d+)_{re.escape(observable)}\b", str(formula))
        names = [f"{kind}Parameter{i + 1}_{observable}" for i in range(max(map(int, numbers), default=0))]
        for name in names:
            if name not in self.swept:
                self._add_parameter(name, constant=True)
                self.swept.append(name)
        return names

    def set(self, name: str, what: str) -> str:
        """Makes a parameter, compartment or the initial value of a species something that instances set. Returns the id
        of the parameter to set; `what` names the table."""
        model = self._model
        if model.getElementBySId(name) is None and what == "the table of parameters":
            self._add_parameter(name, constant=True)
        element = model.getParameter(name) or model.getCompartment(name)
        species = model.getSpecies(name) if what != "the table of parameters" else None
        if element is None and species is None:
            raise Refused(f"{what} has '{name}', which is nothing of the model that it could set")
        if name in self._ruled:
            raise Refused(f"{what} has '{name}', which a rule of the model sets")
        had_formula = model.getInitialAssignmentBySymbol(name) is not None
        while model.getInitialAssignmentBySymbol(name) is not None:
            model.removeInitialAssignment(name)
        if not had_formula:
            self._note_value(name, species or element)
        parameter = name
        if species is not None or name in self._changing:
            parameter = self._unused(f"{name}_at_start")
            self._add_parameter(parameter, constant=True)
            assignment = model.createInitialAssignment()
            assignment.setSymbol(name)
            assignment.setMath(self._parsed(parameter, f"the initial value of '{name}'"))
        elif model.getParameter(name) is not None:
            element.unsetValue()
        self.swept.append(parameter)
        return parameter

    def fix(self, name: str, value: float) -> None:
        """Gives a parameter of the table of parameters a value."""
        self._model.getParameter(self.set(name, "the table of parameters")).setValue(value)
        self.swept.pop()

    def read(self) -> SbmlModel:
        """The model with all that was added."""
        return read_sbml(self._libsbml.writeSBMLToString(self._document), parameters=self.swept)

    def _note_value(self, name: str, element: Any) -> None:
        """Keeps the value that the file has, in the unit that tables of conditions use."""
        if element.getElementName() == "species":
            if element.getHasOnlySubstanceUnits():
                known, value = element.isSetInitialAmount(), element.getInitialAmount()
            else:
                known, value = element.isSetInitialConcentration(), element.getInitialConcentration()
        elif element.getElementName() == "compartment":
            known, value = element.isSetSize(), element.getSize()
        else:
            known, value = element.isSetValue(), element.getValue()
        if known:
            self.file_values[name] = value

    def _unused(self, name: str) -> str:
        while self._model.getElementBySId(name) is not None:
            name += "_"
        return name

    def _add_parameter(self, name: str, constant: bool) -> None:
        made = self._model.createParameter()
        made.setId(name)
        made.setConstant(constant)

    def _parsed(self, formula: Any, where: str) -> Any:
        return parsed(str(formula), self._model, where)
