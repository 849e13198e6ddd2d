# SPDX-License-Identifier: MIT
"""Models from files of SBML, the format of systems biology and pharmacology."""

from __future__ import annotations

import math
import os
from typing import TYPE_CHECKING, Any

from ...base.errors import Error, quoted, users_line
from ...codegen.model import Model
from ...models.components import Components, name_of, unknown
from ...symbolic import symbols as sym
from ...symbolic.delays import pasts_of, read_now_or_then
from ...symbolic.node import Node
from ...symbolic.folding import constant, is_constant, value_of
from ..deep_stack import deeply
from .document import library, read
from .events import Events
from .math import Refused
from .reduce import Reduction
from .semantics import Semantics
from .units import Units

if TYPE_CHECKING:
    from ...symbolic.types import Names, Path

__all__ = ["read_sbml", "read_antimony", "SbmlModel"]


def read_sbml(source: Path | str, *, parameters: Names | None = None, reduce: bool = False,
              name: str | None = None) -> SbmlModel:
    """The model of a file of SBML (Level 1 to 3), given by its path or as text. It needs the package python-libsbml.

    Species, parameters and compartments keep their ids: `solve(model, {"k1": np.linspace(0, 1, 100)}, start={"S1": 2},
    time=(0, 10), samples=101)` changes a parameter and an initial value; what is not given has the value of the file,
    initial assignments follow what they depend on, and `run["S1"]` is what `S1` means in the file's formulas: the
    concentration of a species, or its amount if it has only substance units. `run` also has assignment rules and rates
    of reactions by their ids, and `run["S1_amount"]` or `run["S1_concentration"]`.

    `parameters` names the constants that sweeps may set; the others are written into the equations. Without it sweeps
    may set all, those of kinetic laws as `reaction_parameter`.

    `reduce=True` leaves out the states of species whose amounts follow from those of others, as of an enzyme that is
    free or bound. Their conserved sums are parameters, `conserved_E`, which follow from the initial values; the species
    are outputs.

    Raises `my.Error` with element, id and line for what is not supported: algebraic rules, fast reactions, delays in
    rates and events that are delayed values themselves, triggers other than those of docs/sbml.md, packages that change
    a model's meaning, and for what is not valid.
    """
    document, model = read(source)
    swept = None
    if parameters is not None:
        swept = [name_of(n) for n in ([parameters] if isinstance(parameters, Node) else sym.names(parameters))]
    return deeply(lambda: SbmlModel(Semantics(library(), document, model, swept), name or model.getId() or "model",
                                    reduce))


def read_antimony(source: Path | str, *, parameters: Names | None = None, reduce: bool = False,
                  name: str | None = None) -> SbmlModel:
    """The model of a text in Antimony, as `"S1 -> S2; k*S1; k = 1; S1 = 10"`, or of the file with such a text; its last
    model if there are several. All else is as in `read_sbml`. It needs the packages antimony and python-libsbml."""
    try:
        import antimony
    except ImportError:
        raise Error("read_antimony needs the package antimony: `pip install antimony python-libsbml`") from None
    is_path = not isinstance(source, str) or os.path.isfile(source)
    antimony.clearPreviousLoads()
    loaded = antimony.loadAntimonyFile(os.fspath(source)) if is_path else antimony.loadAntimonyString(source)
    if loaded < 0:
        raise Refused(f"the text is no Antimony: {' '.join(antimony.getLastError().split())}")
    return read_sbml(antimony.getSBMLString(antimony.getMainModuleName()), parameters=parameters, reduce=reduce,
                     name=name)


def _suffixed(taken: Any, name: str) -> str:
    while name in taken:
        name += "_"
    return name


class SbmlModel(Model):
    """A model from a file of SBML. `outputs` are expressions by name that a run computes from states and parameters:
    assignment rules, rates of reactions, amounts and concentrations. `defaults` are the values of the file by
    component, those of initial assignments as expressions; `aliases` are the components of ids that no component can
    have as its name; `units` has the file's units by component or output, as texts, and `time_unit`
    that of time."""

    is_from_a_file = True

    def __init__(self, semantics: Semantics, name: str, reduce: bool = False) -> None:
        states = semantics.states()
        equations: dict[Any, Any] = {q.symbol: semantics.slope(q) for q in states}
        if not equations:
            equations = {sym.symbol("state", semantics.component_name("nothing")): constant(0.0)}
        outputs = _outputs(semantics)
        for given in semantics.swept or ():
            known = [*(n for n, q in semantics.quantities.items() if not q.changes), *semantics.local_names]
            if given not in known:
                raise unknown(given, known, "constant of the file that parameters= can name")
        happening = Events(semantics)
        triggers = happening.triggers
        defaults = semantics.defaults
        reduction = Reduction(semantics) if reduce else None
        if reduction is not None and reduction.values:
            equations = reduction.of({s: e for s, e in equations.items() if s not in reduction.values})
            outputs = reduction.of(outputs)
            for one in triggers:
                reduction.rewrite(one)
        actions = [e for one in triggers for e in (one.condition, one.delay, one.priority, *one.values,
                                                   *one.do.values()) if e is not None]
        needed = read_now_or_then([*equations.values(), *defaults.values(), *actions,
                                    *(e for e in outputs.values() if pasts_of([e]))])
        constants: dict[Any, float] = {}
        declared = []
        for quantity in semantics.quantities.values():
            symbol = quantity.symbol
            if symbol is None or symbol.op != "symbol" or symbol.value[0] != "parameter":
                continue
            start = defaults.get(symbol.value[1])
            if symbol not in needed and (start is None or is_constant(start) and not math.isfinite(value_of(start))):
                constants[symbol] = math.nan if start is None else value_of(start)
                defaults.pop(symbol.value[1], None)
            else:
                declared.append(symbol)
        declared += reduction.parameters if reduction is not None else []
        name = _suffixed(semantics.names.values(), semantics.component_name(name))
        self._reserved = {*semantics.names.values(), *semantics.quantities, *semantics.reactions}
        super().__init__(equations, (), None, None, None, None, None, None, declared, (), name, triggers=triggers,
                         tie_seed=happening.tie_seed, history=_history(semantics, [*equations.values(), *actions]))
        self.line, self.hidden = users_line(), frozenset([*self.accessories, *self.integer_accessories])
        self.constants = constants
        self.conserved = {} if reduction is None else reduction.sums
        self.defaults: dict[str, Any] = {**self.shared_values}
        self.defaults |= {n: e for n, e in defaults.items() if n in self.states or n in self.parameters}
        for state in self.states:
            if state not in semantics.names.values():
                self.defaults[state] = constant(0.0)
        self.past_outputs = {n: outputs.pop(n) for n in [*outputs] if pasts_of([outputs[n]])}
        before = _history(semantics, list(self.past_outputs.values()), in_outputs=True)
        self.history_of_outputs = {state.value[1]: value for state, value in before.items()}
        self.outputs: dict[str, Any] = {n: e for n, e in outputs.items() if not (
            e.op == "symbol" and e.value[0] in ("state", "parameter") and e.value[1] == n and e not in constants)}
        units = Units(semantics.libsbml, semantics.model)
        self.stored = {q: n for q, n in semantics.names.items() if q in semantics.quantities}
        self.units, self.time_unit = _units(semantics, units), units.time()
        self.aliases = {id: component for id, component in semantics.names.items()
                        if id != component and not (
                            id in semantics.quantities and semantics.quantities[id].in_amount)}

    def start(self, given: dict[str, Any] | None = None) -> dict[str, float]:
        """The values of states and parameters at the start, for some that are given."""
        values = Components(self).completed(dict(given or {}), 0.0)
        missing = [n for n in [*self.states, *self.parameters] if n not in values]
        if missing:
            raise Error(f"the file has no value of {quoted(missing)}: give one")
        return {n: float(v) for n, v in values.items()}


def _history(semantics: Semantics, roots: list[Any], in_outputs: bool = False) -> dict[Any, Any]:
    """What delayed states were before the start, where that is not the initial value."""
    pasts = [past.value[1] for past in pasts_of(roots)]
    if not in_outputs and (nested := next((past for past in pasts if pasts_of([past.lag])), None)) is not None:
        raise Refused(f"`{nested}`, a delay that is a delayed value itself, in rates or events: there is that in rules "
                      "alone")
    states = dict.fromkeys(past.state for past in pasts)
    return {state: before for state in states if (before := semantics.before(state)) is not None}


def _units(semantics: Semantics, units: Units) -> dict[str, str]:
    """The units of components and outputs, as far as the file has them."""
    known: dict[str, str] = {}
    for name, quantity in semantics.quantities.items():
        component = semantics.names.get(name, name)
        if quantity.kind == "species":
            amount, concentration = units.of_species(quantity.element)
            known[name] = concentration if quantity.compartment else amount
            known[component] = amount if quantity.in_amount else known[name]
            known |= {f"{name}_amount": amount, f"{name}_concentration": concentration}
        elif quantity.kind in ("compartment", "parameter"):
            known[name] = known[component] = units.text(quantity.element)
    known |= {name: units.of_rate(reaction) for name, reaction in semantics.reactions.items()}
    return {name: unit for name, unit in known.items() if unit}


def _outputs(semantics: Semantics) -> dict[str, Any]:
    """What a run has besides states and parameters."""
    outputs: dict[str, Any] = {}
    for name, quantity in semantics.quantities.items():
        outputs[name] = semantics.meaning(name, quantity.where)
    for name in semantics.reactions:
        outputs[name] = semantics.reaction_rate(name)
    for name, quantity in list(semantics.quantities.items()):
        if quantity.kind == "species":
            if quantity.compartment:
                outputs[_suffixed(outputs, f"{name}_amount")] = semantics.amount(name)
            elif semantics.quantities[quantity.element.getCompartment()].value is not None:
                outputs[_suffixed(outputs, f"{name}_concentration")] = semantics.concentration(name)
    return outputs
