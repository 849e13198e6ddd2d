# SPDX-License-Identifier: MIT
"""Experiments of PEtab's version 2 in its SBML: what their first periods change are initial assignments, and what later
ones change are events, for which a parameter tells experiments apart."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from ..sbml.document import library
from ..sbml.math import Refused
from .formulas import parsed

EXPERIMENT = "petab_experiment"  #: the parameter whose value is the number of an experiment
START = "petab_start_of_period_"  #: those of the times of later periods
NEVER = 1e300


@dataclass
class Period:
    """What changes at a time: formulas as text, by target."""

    time: float
    changes: dict[str, str]


class Periods:
    """Writes periods of experiments, `[experiment][period]`, into a model of SBML. A period later than the first is an
    event, whose values are those from before it, all at one time, and which comes before other events of the time."""

    def __init__(self, text: str, experiments: Sequence[Sequence[Period]]) -> None:
        self._libsbml = library()
        self._document = self._libsbml.readSBMLFromString(text)
        if self._document.getLevel() < 3 and not self._document.setLevelAndVersion(3, 1, False):
            raise Refused("the experiments need events of SBML's level 3, and the model cannot be converted to it")
        self._model = self._document.getModel()
        self._experiments = experiments
        self.count = max(map(len, experiments), default=1) - 1  #: of later periods
        for name in (EXPERIMENT, *(f"{START}{i + 1}" for i in range(self.count))):
            if self._model.getElementBySId(name) is not None:
                raise Refused(f"the model has something called '{name}', which read_petab needs: rename it")
            self._add_parameter(name, 0.0)
        self._start()
        if self.count:
            self._order_events()
        for place in range(1, self.count + 1):
            self._event(place)

    @property
    def text(self) -> str:
        """The model with its events."""
        return str(self._libsbml.writeSBMLToString(self._document))

    def settings(self, experiment: int, at_rest: bool = False) -> dict[str, float]:
        """What an experiment, or the steady state before it, sets parameters to."""
        later = self._experiments[experiment][1:]
        return {EXPERIMENT: float(experiment), **{
            f"{START}{i + 1}": later[i].time if i < len(later) and not at_rest else NEVER for i in range(self.count)}}

    def _add_parameter(self, name: str, value: float) -> None:
        made = self._model.createParameter()
        made.setId(name)
        made.setConstant(True)
        made.setValue(value)

    def _start(self) -> None:
        """The initial assignments of first periods."""
        first = [periods[0].changes if periods else {} for periods in self._experiments]
        for target in dict.fromkeys(t for changes in first for t in changes):
            before = self._model.getInitialAssignmentBySymbol(target)
            if before is not None:
                otherwise = self._libsbml.formulaToL3String(before.getMath())
                self._model.removeInitialAssignment(target)
            else:
                otherwise = self._value(target)
            assignment = self._model.createInitialAssignment()
            assignment.setSymbol(target)
            assignment.setMath(self._parsed(_chosen({k: changes[target] for k, changes in enumerate(first)
                                                     if target in changes}, otherwise)))

    def _value(self, target: str) -> str:
        """The initial value that the file has, in the unit that conditions use."""
        species = self._model.getSpecies(target)
        if species is not None and species.getHasOnlySubstanceUnits():
            known, value, factor = species.isSetInitialAmount(), species.getInitialAmount(), ""
            if not known:
                known, value = species.isSetInitialConcentration(), species.getInitialConcentration()
                factor = f" * {species.getCompartment()}"
        elif species is not None:
            known, value, factor = species.isSetInitialConcentration(), species.getInitialConcentration(), ""
            if not known:
                known, value = species.isSetInitialAmount(), species.getInitialAmount()
                factor = f" / {species.getCompartment()}"
        elif self._model.getCompartment(target) is not None:
            compartment = self._model.getCompartment(target)
            known, value, factor = compartment.isSetSize(), compartment.getSize(), ""
        else:
            parameter = self._model.getParameter(target)
            known, value, factor = parameter.isSetValue(), parameter.getValue(), ""
        return f"{value!r}{factor}" if known else "notanumber"

    def _order_events(self) -> None:
        """Events of the model have a priority and, at the time of a period, values from after its changes."""
        events = list(self._model.getListOfEvents())
        self._priority = 1.0  # of periods: above all others
        for event in events:
            where = f"event '{event.getId()}' of the model"
            priority = event.getPriority() if event.isSetPriority() else None
            if priority is None:
                event.createPriority().setMath(self._parsed("0"))
            elif priority.getMath() is None or not priority.getMath().isNumber():
                raise Refused(f"{where} has a priority by a formula, and the changes of later periods of experiments "
                              "come before all events: give it a number")
            else:
                self._priority = max(self._priority, 1.0 + float(priority.getMath().getValue()))
            if event.getUseValuesFromTriggerTime():
                if len(events) > 1 or event.isSetDelay():
                    raise Refused(f"{where} takes its values from the time of its trigger, and the changes of later "
                                  "periods of experiments come before: set useValuesFromTriggerTime to false")
                event.setUseValuesFromTriggerTime(False)  # there is no other event from whose time they would differ

    def _event(self, place: int) -> None:
        """The event of periods of this number, of all experiments that have one."""
        changes = {k: self._compensated(periods[place].changes) for k, periods in enumerate(self._experiments)
                   if place < len(periods)}
        targets = dict.fromkeys(t for of in changes.values() for t in of)
        if not targets:
            return
        event = self._model.createEvent()
        event.setUseValuesFromTriggerTime(True)
        trigger = event.createTrigger()
        trigger.setInitialValue(False)
        trigger.setPersistent(True)
        trigger.setMath(self._parsed(f"time >= {START}{place}"))
        event.createPriority().setMath(self._parsed(repr(self._priority)))
        for target in targets:
            self._model.getElementBySId(target).setConstant(False)
            assignment = event.createEventAssignment()
            assignment.setVariable(target)
            assignment.setMath(self._parsed(_chosen({k: of[target] for k, of in changes.items() if target in of},
                                                    target)))

    def _compensated(self, changes: Mapping[str, str]) -> dict[str, str]:
        """Changes whose event leaves concentrations as PEtab does where the size of a compartment changes: SBML has the
        amounts stay."""
        found = dict(changes)
        for species in self._model.getListOfSpecies():
            size = species.getCompartment()
            if size in changes and not species.getHasOnlySubstanceUnits():
                name = species.getId()
                found[name] = f"({changes.get(name, name)}) * ({changes[size]}) / {size}"
        return found

    def _parsed(self, text: str) -> Any:
        return parsed(text, self._model, "the condition table")


def _chosen(by_experiment: Mapping[int, str], otherwise: str) -> str:
    """A formula that is another one in some experiments."""
    pieces = [f"({formula}), abs({EXPERIMENT} - {k}) < 0.5" for k, formula in by_experiment.items()]
    return f"piecewise({', '.join([*pieces, f'({otherwise})'])})"
