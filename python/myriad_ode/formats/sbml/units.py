# SPDX-License-Identifier: MIT
"""Units of SBML as texts for the labels of results. No value depends on them."""

from __future__ import annotations

from typing import Any

from .. import unit_text
from ..unit_text import Factor

# Of Levels 1 and 2, unless a file defines them; an area is a square.
_predefined = {"substance": "mole", "time": "second", "length": "metre", "area": "metre", "volume": "litre"}


def text_of(libsbml: Any, definition: Any) -> str:
    """A unit as "mmol/l"; empty where it is not known or has no dimension."""
    units = [] if definition is None else [definition.getUnit(i) for i in range(definition.getNumUnits())]
    if any(unit.getKind() == libsbml.UNIT_KIND_INVALID for unit in units):
        return ""
    return unit_text.text_of(Factor(libsbml.UnitKind_toString(unit.getKind()), unit.getScale(), unit.getMultiplier(),
                                    unit.getExponentAsDouble()) for unit in units)


class Units:
    """The units of a model's quantities."""

    def __init__(self, libsbml: Any, model: Any) -> None:
        self.libsbml, self.model = libsbml, model

    def of(self, element: Any) -> Any:
        """The definition of the unit of a compartment or parameter, or None. libsbml would also derive units from
        formulas, and for that expands each call of a function: 2^n times where n functions call the next one twice."""
        unit = element.getUnits()
        if not unit and element.getTypeCode() == self.libsbml.SBML_COMPARTMENT:
            size = {1.0: "length", 2.0: "area", 3.0: "volume"}.get(element.getSpatialDimensionsAsDouble())
            if size and self.model.getLevel() > 2:
                unit = getattr(self.model, f"get{size.capitalize()}Units")()
            else:
                unit = size or ""
        return self._named(unit)

    def _named(self, unit: str) -> Any:
        """The definition of a unit that is given by its name."""
        defined = self.model.getUnitDefinition(unit) if unit else None
        if not unit or defined is not None:
            return defined
        made = self.libsbml.UnitDefinition(self.model.getLevel(), self.model.getVersion())
        factor = made.createUnit()
        factor.initDefaults()
        factor.setKind(self.libsbml.UnitKind_forName(_predefined.get(unit, unit)))
        factor.setExponent(2 if unit == "area" else 1)
        return made

    def time(self) -> str:
        """The unit of time."""
        name = self.model.getTimeUnits() if self.model.getLevel() > 2 else "time"
        return text_of(self.libsbml, self._named(name))

    def of_species(self, species: Any) -> tuple[str, str]:
        """The units of a species' amount and concentration."""
        substance = species.getSubstanceUnits() or (
            self.model.getSubstanceUnits() if self.model.getLevel() > 2 else "substance")
        amount, size = self._named(substance), self.of(self.model.getCompartment(species.getCompartment()))
        if amount is None:
            return "", ""
        if size is None:
            return text_of(self.libsbml, amount), ""
        inverse = size.clone()
        for i in range(inverse.getNumUnits()):
            unit = inverse.getUnit(i)
            unit.setExponent(-unit.getExponentAsDouble())
        both = self.libsbml.UnitDefinition.combine(amount, inverse)
        return text_of(self.libsbml, amount), text_of(self.libsbml, both)

    def text(self, element: Any) -> str:
        """The unit of a compartment or parameter."""
        return text_of(self.libsbml, self.of(element))

    def of_rate(self, reaction: Any) -> str:
        """The unit of a reaction's rate: of its extent, by time."""
        extent = self.model.getExtentUnits() if self.model.getLevel() > 2 else "substance"
        amount, time = text_of(self.libsbml, self._named(extent)), self.time()
        return f"{amount}/{time}" if amount and time else ""
