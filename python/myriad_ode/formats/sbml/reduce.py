# SPDX-License-Identifier: MIT
"""Conserved sums of SBML's species: amounts that follow from others, as the rows of the stoichiometry matrix depend on
each other."""

from __future__ import annotations

from collections.abc import Iterable
from fractions import Fraction
from typing import Any

from ...models.trigger import Trigger
from ...symbolic import symbols as sym
from ...symbolic.delays import delayed, pasts_of
from ...symbolic.folding import add, constant, divide, folded, is_constant, multiply, number, subtract, value_of
from ...symbolic.rewrite import rebuilt
from .semantics import Quantity, Semantics


def _row(semantics: Semantics, name: str) -> dict[str, Fraction] | None:
    """How much of a species each reaction makes; None if that is not constant."""
    row: dict[str, Fraction] = {}
    for key, reaction in semantics.reactions.items():
        for i, reference in enumerate(semantics.references(reaction)):
            if reference.getSpecies() != name:
                continue
            made = semantics.stoichiometry(reference, reaction)
            if not is_constant(made):
                return None
            sign = -1 if i < reaction.getNumReactants() else 1
            row[key] = row.get(key, Fraction(0)) + sign * Fraction(value_of(made))
    return {key: made for key, made in row.items() if made}


def dependent(semantics: Semantics) -> dict[str, dict[str, Fraction]]:
    """The species whose amounts change as sums of those of others do: the others with their weights. Species that an
    event changes are left out."""
    written = {v for i in range(semantics.model.getNumEvents())
               for v in _changed_by(semantics, semantics.model.getEvent(i))}
    found: dict[str, dict[str, Fraction]] = {}
    bases: dict[str, list[tuple[str, dict[str, Fraction], dict[str, Fraction]]]] = {}  # by conversion factor
    for name, quantity in semantics.quantities.items():
        row = _row(semantics, name) if quantity.changes == "reactions" and name not in written else None
        if row is None:
            continue
        factor = quantity.element.getConversionFactor() or semantics.model.getConversionFactor()
        basis = bases.setdefault(factor, [])
        weights: dict[str, Fraction] = {}
        for pivot, other, in_species in basis:
            share = row.get(pivot, Fraction(0)) / other[pivot]
            if share:
                row = {k: v for k in {**row, **other} if (v := row.get(k, Fraction(0)) - share * other.get(k, 0))}
                for k, v in in_species.items():
                    weights[k] = weights.get(k, Fraction(0)) + share * v
        if row:
            basis.append((next(iter(row)), row, {name: Fraction(1), **{k: -v for k, v in weights.items()}}))
        else:
            found[name] = {k: v for k, v in weights.items() if v}
    return found


def _changed_by(semantics: Semantics, event: Any) -> set[str]:
    """The species whose amounts an event sets."""
    set_by = {event.getEventAssignment(i).getVariable() for i in range(event.getNumEventAssignments())}
    return set_by | {q.id for q in semantics.quantities.values() if q.compartment in set_by and not q.in_amount}


class Reduction:
    """What takes the place of the states that are left out: `values` by their symbols, and the parameters of the sums,
    whose values at the start are in the model's defaults. `sums` has such a parameter for each state in a sum."""

    def __init__(self, semantics: Semantics) -> None:
        self.values: dict[Any, Any] = {}
        self.parameters: list[Any] = []
        self.sums: dict[str, str] = {}
        for name, weights in dependent(semantics).items():
            quantity = semantics.quantities[name]
            start = semantics.defaults.get(semantics.names[name])
            if start is None:
                continue
            others = constant(0.0)
            for other, weight in weights.items():
                others = add(others, multiply(constant(float(weight)), semantics.amount(other)))
            component = semantics.names[f"conserved {name}"] = semantics.component_name(f"conserved_{name}")
            total = sym.symbol("parameter", component)
            self.parameters.append(total)
            self.sums |= {semantics.names[other]: component for other in weights}
            at_start, = rebuilt([semantics.amount(name)], folded, {quantity.symbol: number(start)})
            semantics.defaults[component] = subtract(at_start, others)
            del semantics.defaults[semantics.names[name]]
            self.values[quantity.symbol] = self._stored(semantics, quantity, add(total, others))

    @staticmethod
    def _stored(semantics: Semantics, quantity: Quantity, amount: Any) -> Any:
        if quantity.in_amount or not quantity.compartment:
            return amount
        return divide(amount, semantics.meaning(quantity.compartment, quantity.where))

    def of(self, expressions: dict[Any, Any]) -> dict[Any, Any]:
        """Expressions in what is left."""
        return dict(zip(expressions, self._written(expressions.values())))

    def rewrite(self, one: Trigger) -> None:
        """Writes a trigger in what is left."""
        one.condition, *one.values = self._written([one.condition, *one.values])
        one.do = self.of(one.do)
        one.delay, one.priority = (None if e is None else self._written([e])[0] for e in (one.delay, one.priority))

    def _written(self, expressions: Iterable[Any]) -> list[Any]:
        expressions, known = list(expressions), dict(self.values)
        for symbol in pasts_of(expressions):
            past = symbol.value[1]
            known[symbol] = delayed(*rebuilt([past.state, past.lag], folded, self.values))
        return rebuilt(expressions, folded, known)
