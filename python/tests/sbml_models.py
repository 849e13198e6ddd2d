# SPDX-License-Identifier: MIT
"""Small models of SBML, one for each rule of what its elements mean, with results in closed form. `write` makes folders
of them in the format of SBML's semantic test suite."""

import dataclasses
import re
from collections.abc import Callable

import libsbml
import numpy as np

# -- Elements ----------------------------------------------------------------------------------------------------------

_names = {"initialAssignment": "symbol", "assignmentRule": "variable", "rateRule": "variable",
          "eventAssignment": "variable"}


def math(formula):
    """The MathML of a formula."""
    tree = libsbml.parseL3Formula(formula)
    assert tree is not None, libsbml.getLastParseL3Error()
    return libsbml.writeMathMLToString(tree).partition("?>")[2]


def text(value):
    return str(value).lower() if isinstance(value, bool) else str(value)


def element(name, inside="", **attributes):
    written = "".join(f' {key}="{text(value)}"' for key, value in attributes.items() if value is not None)
    return f"<{name}{written}>{inside}</{name}>"


def several(name, elements):
    return element(name, "".join(elements)) if elements else ""


@dataclasses.dataclass
class Part:
    """An element with the list that it belongs to."""

    list: str
    xml: str


def compartment(id, size=1.0, constant=True, dimensions=3):
    return Part("Compartments", element("compartment", id=id, size=size, constant=constant,
                                        spatialDimensions=dimensions))


def species(id, amount=None, concentration=None, compartment="c", only_amounts=False, boundary=False, constant=False,
            factor=None):
    return Part("Species", element("species", id=id, compartment=compartment, initialAmount=amount,
                                   initialConcentration=concentration, hasOnlySubstanceUnits=only_amounts,
                                   boundaryCondition=boundary, constant=constant, conversionFactor=factor))


def parameter(id, value=None, constant=True):
    return Part("Parameters", element("parameter", id=id, value=value, constant=constant))


def variable(id, value=None):
    return parameter(id, value, constant=False)


def _formula(kind, id, formula):
    return element(kind, math(formula), **{_names[kind]: id})


def initially(id, formula):
    return Part("InitialAssignments", _formula("initialAssignment", id, formula))


def always(id, formula):
    return Part("Rules", _formula("assignmentRule", id, formula))


def rate(id, formula):
    return Part("Rules", _formula("rateRule", id, formula))


def function(id, formula):
    return Part("FunctionDefinitions", element("functionDefinition", math(formula), id=id))


def _side(kind, name, side):
    """Of "2 A + n:B": a number is a stoichiometry, a name before a colon the id of the reference."""
    references = []
    for term in filter(None, (t.strip() for t in side.split("+"))):
        number, id, what = re.fullmatch(r"(?:([\d.]+)\s+)?(?:(\w+):)?(\w+)", term).groups()
        references.append(element("speciesReference", species=what, id=id, constant=id is None,
                                  stoichiometry=number or (None if id else 1)))
    return several(name, references)


def reaction(id, equation, law, modifiers="", **local):
    left, _, right = equation.partition("->")
    parameters = several("listOfLocalParameters", [element("localParameter", id=i, value=v) for i, v in local.items()])
    modified = several("listOfModifiers", [element("modifierSpeciesReference", species=m) for m in modifiers.split()])
    return Part("Reactions", element(
        "reaction", _side("reactant", "listOfReactants", left) + _side("product", "listOfProducts", right) + modified +
        element("kineticLaw", math(law) + parameters), id=id, reversible=False))


def event(trigger, do, before=True, persistent=True, delay=None, priority=None, id=None, at_trigger=True):
    inside = element("trigger", math(trigger), initialValue=before, persistent=persistent)
    inside += element("priority", math(priority)) if priority else ""
    inside += element("delay", math(delay)) if delay else ""
    inside += several("listOfEventAssignments", [_formula("eventAssignment", v, f) for v, f in do.items()])
    return Part("Events", element("event", inside, id=id, useValuesFromTriggerTime=at_trigger))


_order = ("FunctionDefinitions", "Compartments", "Species", "Parameters", "InitialAssignments", "Rules", "Reactions",
          "Events")


def document(parts, **attributes):
    """The text of a model. Parts may be in any order."""
    lists = [several(f"listOf{kind}", [p.xml for p in parts if p.list == kind]) for kind in _order]
    inside = element("model", "\n".join(filter(None, lists)), id="a_model", **attributes)
    whole = element("sbml", inside, xmlns="http://www.sbml.org/sbml/level3/version2/core", level=3, version=2)
    return '<?xml version="1.0" encoding="UTF-8"?>\n' + whole.replace("><", ">\n<")


# -- Cases -------------------------------------------------------------------------------------------------------------


@dataclasses.dataclass
class Case:
    """A model, and its results as functions of time; names with _amount or _concentration are those of species."""

    name: str
    parts: list[Part]
    results: dict[str, Callable]
    end: float = 2.0
    attributes: dict[str, str] = dataclasses.field(default_factory=dict)

    @property
    def text(self):
        return document(self.parts, **self.attributes)


exp, sin, cos = np.exp, np.sin, np.cos


def _step(t, at, before, after):
    return np.where(t >= at, after, before)


def _value(name, formula, value):
    """A case of one formula of p = 2.5, q = -1.5 and time."""
    return Case(f"formula: {name}", [parameter("p", 2.5), parameter("q", -1.5), variable("x"), always("x", formula)],
                {"x": value if callable(value) else lambda t, v=value: v + 0 * t})


_c = compartment("c", 2)
_decay = reaction("R", "A -> B", "c * k * A")
_a, _b, _k = species("A", concentration=3), species("B", concentration=1), parameter("k", 0.7)

cases = [
    # Reactions
    Case("concentrations", [_c, _a, _b, _k, _decay], {
        "A_concentration": lambda t: 3 * exp(-0.7 * t), "A_amount": lambda t: 6 * exp(-0.7 * t),
        "B_amount": lambda t: 2 + 6 * (1 - exp(-0.7 * t)), "R": lambda t: 2 * 0.7 * 3 * exp(-0.7 * t)}),
    Case("amounts in a formula", [_c, species("A", amount=3, only_amounts=True), _b, _k, reaction(
        "R", "A -> B", "k * A")], {"A_amount": lambda t: 3 * exp(-0.7 * t),
                                   "A_concentration": lambda t: 1.5 * exp(-0.7 * t)}),
    Case("an initial amount of a species in concentration", [_c, species("A", amount=3), _b, _k, _decay],
         {"A_concentration": lambda t: 1.5 * exp(-0.7 * t)}),
    Case("an initial concentration of a species in amounts", [
        _c, species("A", concentration=3, only_amounts=True), _b, _k, reaction("R", "A -> B", "k * A")],
        {"A_amount": lambda t: 6 * exp(-0.7 * t)}),
    Case("a boundary species is not changed by reactions", [
        _c, species("A", concentration=3, boundary=True), _b, _k, _decay],
        {"A_concentration": lambda t: 3 + 0 * t, "B_concentration": lambda t: 1 + 2.1 * t}),
    Case("a constant species", [_c, species("A", concentration=3, boundary=True, constant=True), _b, _k, _decay],
         {"A_concentration": lambda t: 3 + 0 * t, "B_concentration": lambda t: 1 + 2.1 * t}),
    Case("a boundary species with a rate rule", [
        _c, species("A", concentration=3, boundary=True), _b, _k, _decay, rate("A", "1")],
        {"A_concentration": lambda t: 3 + t, "B_concentration": lambda t: 1 + 0.7 * (3 * t + t**2 / 2)}),
    Case("a boundary species with an assignment rule", [
        _c, species("A", boundary=True), _b, _k, _decay, always("A", "2 * time")],
        {"A_amount": lambda t: 4 * t, "B_concentration": lambda t: 1 + 0.7 * t**2}),
    Case("stoichiometries", [_c, _a, _b, _k, reaction("R", "2 A -> 3 B", "c * k")],
         {"A_concentration": lambda t: 3 - 1.4 * t, "B_concentration": lambda t: 1 + 2.1 * t}),
    Case("a species on both sides", [_c, _a, _k, reaction("R", "A -> 3 A", "c * k * A")],
         {"A_concentration": lambda t: 3 * exp(1.4 * t)}),
    Case("a species twice on one side", [_c, _a, _k, reaction("R", "A + A ->", "c * k * A")],
         {"A_concentration": lambda t: 3 * exp(-1.4 * t)}),
    Case("a modifier", [_c, _a, _b, _k, reaction("R", "-> B", "c * k * A", modifiers="A")],
         {"A_concentration": lambda t: 3 + 0 * t, "B_concentration": lambda t: 1 + 2.1 * t}),
    Case("a local parameter hides a global one", [_c, _a, _b, _k, reaction("R", "A -> B", "c * k * A", k=0.2)],
         {"A_concentration": lambda t: 3 * exp(-0.2 * t), "k": lambda t: 0.7 + 0 * t}),
    Case("the rate of a reaction in a formula", [_c, _a, _b, _k, _decay, variable("x"), always("x", "2 * R")],
         {"x": lambda t: 2 * 2 * 0.7 * 3 * exp(-0.7 * t)}),
    Case("a reaction between two compartments", [
        _c, compartment("d", 5), _a, species("B", concentration=1, compartment="d"), _k, _decay],
        {"A_concentration": lambda t: 3 * exp(-0.7 * t), "B_concentration": lambda t: 1 + 1.2 * (1 - exp(-0.7 * t))}),
    Case("a compartment without dimensions", [
        compartment("c", None, dimensions=0), species("A", amount=3), _k, reaction("R", "A ->", "k * A")],
        {"A_amount": lambda t: 3 * exp(-0.7 * t)}),
    Case("a conversion factor of a species", [
        _c, species("A", concentration=3, factor="f"), _b, _k, parameter("f", 2), _decay],
        {"A_concentration": lambda t: 3 * exp(-1.4 * t), "B_concentration": lambda t: 1 + 1.5 * (1 - exp(-1.4 * t))}),
    Case("a conversion factor of the model", [_c, _a, _b, _k, parameter("f", 2), _decay],
         {"A_concentration": lambda t: 3 * exp(-1.4 * t)}, attributes={"conversionFactor": "f"}),
    # Stoichiometries as variables
    Case("an assigned stoichiometry", [_c, _a, _b, _k, reaction("R", "A -> n:B", "c * k"), always("n", "1 + time")],
         {"B_concentration": lambda t: 1 + 0.7 * (t + t**2 / 2), "n": lambda t: 1 + t}),
    Case("an initial assignment of a stoichiometry", [
        _c, _a, _b, _k, reaction("R", "A -> n:B", "c * k"), initially("n", "2 * k")],
        {"B_concentration": lambda t: 1 + 0.98 * t, "n": lambda t: 1.4 + 0 * t}),
    Case("a stoichiometry with a rate rule", [
        _c, _a, _b, _k, reaction("R", "A -> n:B", "c * k"), initially("n", "1"), rate("n", "2")],
        {"B_concentration": lambda t: 1 + 0.7 * (t + t**2)}),
    Case("a stoichiometry in a formula", [_c, _a, _b, _k, reaction("R", "A -> 3 n:B", "c * k"), variable("x"),
                                          always("x", "n + time")], {"x": lambda t: 3 + t}),
    # Rules and initial assignments
    Case("a rate rule of a parameter", [variable("x", 2), rate("x", "-x")], {"x": lambda t: 2 * exp(-t)}),
    Case("rate rules that are coupled", [variable("x", 1), variable("y", 0), rate("x", "y"), rate("y", "-x")],
         {"x": cos, "y": lambda t: -sin(t)}),
    Case("assignment rules in any order", [variable("x"), variable("y"), variable("z"), always("x", "y + 1"),
                                           always("y", "2 * z"), always("z", "time")],
         {"x": lambda t: 2 * t + 1, "y": lambda t: 2 * t}),
    Case("a rate rule that reads an assignment rule", [variable("x", 1), variable("y"), always("y", "3 * x"),
                                                       rate("x", "-y")], {"x": lambda t: exp(-3 * t)}),
    Case("initial assignments in any order", [
        variable("x", 9), variable("y"), parameter("z"), initially("x", "y + 1"), initially("y", "2 * z"),
        initially("z", "5"), rate("x", "1")], {"x": lambda t: 11 + t, "y": lambda t: 10 + 0 * t}),
    Case("an initial assignment that reads a rule", [variable("x"), variable("y"), always("y", "4 + time"),
                                                     initially("x", "y"), rate("x", "1")], {"x": lambda t: 4 + t}),
    Case("an initial assignment that reads a reaction", [_c, _a, _b, _k, _decay, parameter("x"), initially("x", "R")],
         {"x": lambda t: 4.2 + 0 * t}),
    Case("an initial assignment of a concentration", [_c, _a, _b, _k, _decay, initially("A", "4 * k")],
         {"A_amount": lambda t: 5.6 * exp(-0.7 * t)}),
    Case("an initial assignment of a compartment, before a concentration", [
        compartment("c"), species("A", concentration=3), _b, _k, _decay, initially("c", "1 + 4 * k")],
        {"A_amount": lambda t: 11.4 * exp(-0.7 * t)}),
    Case("an initial assignment of a compartment, before an amount", [
        compartment("c", 7), species("A", amount=3), _b, _k, _decay, initially("c", "1 + 4 * k")],
        {"A_concentration": lambda t: 3 / 3.8 * exp(-0.7 * t)}),
    # Volumes that change
    Case("a compartment that grows keeps amounts", [
        compartment("c", 2, constant=False), species("A", concentration=3), rate("c", "0.5")],
        {"A_amount": lambda t: 6 + 0 * t, "A_concentration": lambda t: 6 / (2 + 0.5 * t)}),
    Case("a reaction in a compartment that grows", [
        compartment("c", 2, constant=False), species("A", concentration=3), _k, rate("c", "0.5"),
        reaction("R", "A ->", "k")], {"A_amount": lambda t: 6 - 0.7 * t,
                                      "A_concentration": lambda t: (6 - 0.7 * t) / (2 + 0.5 * t)}),
    Case("a compartment with an assignment rule", [
        compartment("c", None, constant=False), species("A", amount=3), always("c", "2 + time")],
        {"A_amount": lambda t: 3 + 0 * t, "A_concentration": lambda t: 3 / (2 + t)}),
    Case("an initial concentration in a compartment with a rule", [
        compartment("c", None, constant=False), species("A", concentration=3), always("c", "2 + time")],
        {"A_amount": lambda t: 6 + 0 * t, "A_concentration": lambda t: 6 / (2 + t)}),
    Case("a rate rule of a concentration in a compartment that grows", [
        compartment("c", 2, constant=False), species("A", concentration=3, boundary=True), rate("c", "0.5"),
        rate("A", "1")], {"A_concentration": lambda t: 3 + t, "A_amount": lambda t: (3 + t) * (2 + 0.5 * t)}),
    # rateOf, time, avogadro, functions
    Case("rateOf of a parameter", [variable("x", 2), rate("x", "-x"), variable("y"), always("y", "rateOf(x)")],
         {"y": lambda t: -2 * exp(-t)}),
    Case("rateOf of a constant", [parameter("x", 2), variable("y"), always("y", "rateOf(x) + 1")],
         {"y": lambda t: 1 + 0 * t}),
    Case("rateOf of a concentration", [_c, _a, _b, _k, _decay, variable("y"), always("y", "rateOf(A)")],
         {"y": lambda t: -2.1 * exp(-0.7 * t)}),
    Case("rateOf of a concentration in a compartment that grows", [
        compartment("c", 2, constant=False), species("A", concentration=3), rate("c", "0.5"), variable("y"),
        always("y", "rateOf(A)")], {"y": lambda t: -3 / (2 + 0.5 * t)**2}),
    Case("time in a rate rule", [variable("x", 1), rate("x", "2 * time")], {"x": lambda t: 1 + t**2}),
    Case("Avogadro's constant", [variable("x"), always("x", "avogadro / 1e23")], {"x": lambda t: 6.02214179 + 0 * t}),
    Case("a function", [function("f", "lambda(x, y, x - 2 * y)"), variable("x", 1), variable("y"),
                        always("y", "f(time, x)"), rate("x", "f(3, 1)")], {"y": lambda t: t - 2 * (1 + t)}),
    Case("a function that calls another", [
        function("f", "lambda(x, x^2)"), function("g", "lambda(x, f(x) + f(2 * x))"), variable("y"),
        always("y", "g(time)")], {"y": lambda t: 5 * t**2}),
    Case("a function's argument hides a parameter", [
        parameter("x", 100), function("f", "lambda(x, x + 1)"), variable("y"), always("y", "f(time)")],
        {"y": lambda t: t + 1}),
    # Piecewise
    Case("piecewise in a rate rule", [variable("x", 0), rate("x", "piecewise(1, time < 1, 3)")],
         {"x": lambda t: np.where(t < 1, t, 1 + 3 * (t - 1))}),
    Case("piecewise with several pieces", [variable("x"), always(
        "x", "piecewise(1, time < 0.5, 2, time < 1.5, 3)")],
        {"x": lambda t: np.where(t < 0.5, 1.0, np.where(t < 1.5, 2.0, 3.0))}, end=2.2),
    Case("piecewise of conditions", [variable("x"), always(
        "x", "piecewise(1, piecewise(time < 0.5, time < 1.1, time > 1.7), 0)")],
        {"x": lambda t: np.where(np.where(t < 1.1, t < 0.5, t > 1.7), 1.0, 0.0)}),
    # Formulas
    _value("powers", "p^3 + p^q + (-2)^3", 2.5**3 + 2.5**-1.5 - 8),
    _value("roots", "sqrt(p) + root(3, -8) + root(4, 81)", 2.5**0.5 - 2 + 3),
    _value("logarithms", "ln(p) + log10(p) + log(2, p)", np.log(2.5) + np.log10(2.5) + np.log2(2.5)),
    _value("rounding", "floor(q) + 10 * ceil(q) + 100 * abs(q)", -2 - 10 + 150),
    _value("factorials", "factorial(4) + factorial(ceil(p))", 24 + 6),
    _value("quotient and remainder", "quotient(-7, p) + 10 * rem(-7, p)", -2 + 10 * -2.0),
    _value("extrema of several", "min(p, q, 1) + 10 * max(p, q, 1)", -1.5 + 25),
    _value("trigonometry", "sec(p) + csc(p) + cot(p)", 1 / cos(2.5) + 1 / sin(2.5) + cos(2.5) / sin(2.5)),
    _value("hyperbolic functions", "sech(p) + csch(p) + coth(p)",
           1 / np.cosh(2.5) + 1 / np.sinh(2.5) + 1 / np.tanh(2.5)),
    _value("inverse trigonometry", "arcsec(p) + arccsc(p) + arccot(p) + atan(q)",
           np.arccos(0.4) + np.arcsin(0.4) + np.arctan(0.4) + np.arctan(-1.5)),
    _value("inverse hyperbolic functions", "arcsinh(q) + arccosh(p) + arctanh(1 / p) + arccoth(p) + arcsech(1 / p)",
           np.arcsinh(-1.5) + np.arccosh(2.5) + 2 * np.arctanh(0.4) + np.arccosh(2.5)),
    _value("conditions as numbers", "(time > 1.1) + (p == 2.5)", lambda t: np.where(t > 1.1, 2.0, 1.0)),
    _value("xor and implies",
           "piecewise(1, xor(p > 1, q > 1, time > 1.1), 0) + piecewise(10, implies(q > 1, false), 0)",
           lambda t: 10 + np.where(t > 1.1, 0.0, 1.0)),
    _value("numbers as conditions", "piecewise(1, p && true, 0) + piecewise(10, !0, 0)", 11.0),
    _value("infinity and what is undefined", "piecewise(1, 1 / 0 > 5, 0) + piecewise(10, notanumber == 1, 20)", 21.0),
    # Events
    Case("an event at a time", [variable("x", 1), event("time >= 0.65", {"x": "5"})],
         {"x": lambda t: _step(t, 0.65, 1.0, 5.0)}),
    Case("an event of the state", [variable("x", 0), rate("x", "1"), event("x > 0.73", {"x": "x - 0.73"})],
         {"x": lambda t: np.mod(t, 0.73)}),
    Case("an event of two conditions", [
        variable("x", 1), event("time > 0.3 && (time > 0.95 || time < 0.1)", {"x": "2"})],
        {"x": lambda t: _step(t, 0.95, 1.0, 2.0)}),
    Case("a trigger that is true before the start", [variable("x", 1), event("time >= 0", {"x": "2"})],
         {"x": lambda t: 1 + 0 * t}),
    Case("a trigger that is true at the start", [variable("x", 1), event("time >= 0", {"x": "2"}, before=False)],
         {"x": lambda t: 2 + 0 * t}),
    Case("an event at the start that makes another happen", [
        variable("x", 1), variable("y", 1), event("time >= 0", {"x": "2"}, before=False), event("x > 1.5", {"y": "7"})],
        {"x": lambda t: 2 + 0 * t, "y": lambda t: 7 + 0 * t}),
    Case("assignments of an event take effect together", [
        variable("x", 1), variable("y", 2), event("time >= 0.65", {"x": "y", "y": "x"})],
        {"x": lambda t: _step(t, 0.65, 1.0, 2.0), "y": lambda t: _step(t, 0.65, 2.0, 1.0)}),
    Case("an event that makes another happen", [
        variable("x", 1), variable("y", 1), event("time >= 0.65", {"x": "3"}), event("x > 2", {"y": "x + 1"})],
        {"y": lambda t: _step(t, 0.65, 1.0, 4.0)}),
    Case("two events with one trigger read what was before", [
        variable("x", 1), variable("y", 2), event("time >= 0.65", {"x": "y"}), event("time >= 0.65", {"y": "x"})],
        {"x": lambda t: _step(t, 0.65, 1.0, 2.0), "y": lambda t: _step(t, 0.65, 2.0, 1.0)}),
    Case("a trigger that holds for a moment within a step", [
        variable("x", 1), event("time > 0.31 && time < 0.32", {"x": "2"})], {"x": lambda t: _step(t, 0.315, 1.0, 2.0)}),
    Case("a trigger of one condition or another", [
        variable("x", 1), variable("n", 0), rate("x", "1"), event("x > 1.55 || time > 0.25", {"n": "n + 1"})],
        {"n": lambda t: _step(t, 0.25, 0.0, 1.0)}),
    Case("a trigger of equality holds at the time", [variable("x", 1), event("time == 0.65", {"x": "5"})],
         {"x": lambda t: _step(t, 0.65, 1.0, 5.0)}),
    Case("a trigger of equality holds at every crossing, whatever its direction", [
        variable("x", 0), variable("n", 0), rate("x", "cos(4 * time)"), event("x == 0.11", {"n": "n + 1"})],
        {"n": lambda t: sum(np.where(t >= at, 1.0, 0.0) for at in (np.arcsin(0.44) + np.array(
            [0, np.pi - 2 * np.arcsin(0.44), 2 * np.pi])) / 4)}),
    Case("a trigger of equality and another condition", [
        variable("x", 0), variable("n", 0), rate("x", "cos(4 * time)"),
        event("!(x != 0.11) && time > 0.2", {"n": "n + 1"})],
        {"n": lambda t: sum(np.where(t >= at, 1.0, 0.0) for at in (np.pi - np.arcsin(0.44), 2 * np.pi + np.arcsin(
            0.44)) / np.array([4.0, 4.0]))}),
    Case("a trigger of equality that another event brings about, and that moves off without a crossing", [
        variable("x", 0), variable("n", 0), rate("x", "1"), event("time > 0.65", {"x": "2"}),
        event("x == 2", {"n": "n + 1"})], {"n": lambda t: _step(t, 0.65, 0.0, 1.0)}, end=1.9),
    Case("a trigger that fails for an instant holds again after it", [
        variable("n", 0), event("time != 0.65", {"n": "n + 1"})], {"n": lambda t: _step(t, 0.65, 0.0, 1.0)}),
    Case("a trigger of equality that waits and does not persist", [
        variable("x", 0), variable("y", 0), rate("x", "1"),
        event("x == 0.65", {"y": "x"}, delay="0.5", persistent=False)], {"y": lambda t: 0 * t}),
    Case("twenty events at one instant, each of which cancels the next", [
        *(variable(f"x{i}", 0) for i in range(20)), variable("sum"),
        always("sum", " + ".join(f"x{i}" for i in range(20))),
        *(event(f"time > 0.65 && x{(i + 1) % 20} < 2", {f"x{i}": "3"}, priority=f"x0 + {i}", persistent=False)
          for i in range(20))], {"x18": lambda t: 0 * t, "sum": lambda t: _step(t, 0.65, 0.0, 30.0)}),
    Case("a trigger of equality that waits", [
        variable("x", 0), variable("y", 0), rate("x", "1"), event("x == 0.65", {"y": "x"}, delay="0.5")],
        {"y": lambda t: _step(t, 1.15, 0.0, 0.65)}),
    Case("an event with a delay", [variable("x", 1), event("time >= 0.65", {"x": "5"}, delay="0.5")],
         {"x": lambda t: _step(t, 1.15, 1.0, 5.0)}),
    Case("an event with a delay has values from its trigger", [
        variable("x", 1), variable("y", 0), rate("x", "1"), event("time >= 0.65", {"y": "x"}, delay="0.5")],
        {"y": lambda t: _step(t, 1.15, 0.0, 1.65)}),
    Case("a delay that depends on the state", [
        variable("x", 1), variable("y", 0), rate("x", "1"), event("time >= 0.65", {"y": "1"}, delay="x / 10")],
        {"y": lambda t: _step(t, 0.815, 0.0, 1.0)}),
    Case("an event that waits twice", [
        variable("n", 0), variable("x", 0), rate("x", "6 * cos(6 * time)"),
        event("x > 0.5", {"n": "n + 1"}, delay="1.27")], {"n": lambda t: np.where(t > 1.27 + np.pi / 36, 1.0, 0.0)}),
    Case("a trigger that ceases to hold cancels an event that is not persistent", [
        variable("x", 1), event("time > 0.3 && time < 0.6", {"x": "2"}, delay="0.5", persistent=False)],
        {"x": lambda t: 1 + 0 * t}),
    Case("a trigger that holds does not cancel an event that is not persistent", [
        variable("x", 1), event("time > 0.3 && time < 0.9", {"x": "2"}, delay="0.55", persistent=False)],
        {"x": lambda t: _step(t, 0.85, 1.0, 2.0)}),
    Case("priorities order events at one instant", [
        variable("x", 1), variable("y", 0), event("time > 0.65", {"x": "2"}, priority="1"),
        event("time > 0.65", {"x": "3", "y": "x"}, priority="2")],
        {"x": lambda t: _step(t, 0.65, 1.0, 2.0), "y": lambda t: _step(t, 0.65, 0.0, 1.0)}),
    Case("an event may cancel another at the same instant", [
        variable("x", 1), variable("y", 0), event("time > 0.65 && x < 5", {"x": "6"}, priority="2"),
        event("time > 0.65 && x < 5", {"y": "1"}, priority="1", persistent=False)],
        {"x": lambda t: _step(t, 0.65, 1.0, 6.0), "y": lambda t: 0 * t}),
    Case("an event of a compartment keeps amounts", [
        compartment("c", 2, constant=False), species("A", concentration=3), event("time >= 0.65", {"c": "4"})],
        {"A_amount": lambda t: 6 + 0 * t, "A_concentration": lambda t: _step(t, 0.65, 3.0, 1.5)}),
    Case("an event of a concentration", [_c, _a, _b, _k, _decay, event("time >= 0.65", {"A": "10"})],
         {"A_amount": lambda t: _step(t, 0.65, 6 * exp(-0.7 * t), 20 * exp(-0.7 * (t - 0.65)))}),
    Case("an event without a trigger's change", [variable("x", 1), event("x > 3", {"x": "0"})],
         {"x": lambda t: 1 + 0 * t}),
    Case("a trigger that becomes true again", [
        variable("x", 0), variable("n", 0), rate("x", "6 * cos(6 * time)"), event("x > 0.5", {"n": "n + 1"})],
        {"n": lambda t: np.floor(6 * t / (2 * np.pi) + 11 / 12)}),
    Case("an event without a priority comes after those that have one", [
        variable("x", 1), event("time > 0.65", {"x": "2"}), event("time > 0.65", {"x": "3"}, priority="-5")],
        {"x": lambda t: _step(t, 0.65, 1.0, 2.0)}),
    Case("priorities that are computed", [
        variable("x", 1), variable("y", 2), event("time > 0.65", {"x": "10"}, priority="x"),
        event("time > 0.65", {"x": "20"}, priority="y"), event("time > 1.15", {"x": "30"}, priority="-x"),
        event("time > 1.15", {"x": "40"}, priority="-y")],
        {"x": lambda t: np.where(t < 0.65, 1.0, np.where(t < 1.15, 10.0, 30.0))}),
    Case("equality of what events alone change", [
        variable("n", 0), variable("x", 0), event("time >= 0.65", {"n": "2"}), event("n == 2", {"x": "1"}),
        event("n != 0 && time > 1.15", {"x": "5"})],
        {"x": lambda t: np.where(t < 0.65, 0.0, np.where(t < 1.15, 1.0, 5.0))}),
    Case("a threshold that is met exactly by an event", [
        variable("n", 0), variable("x", 0), event("time >= 0.65", {"n": "16"}),
        event("floor(n / 16) >= 1", {"x": "1", "n": "0"})],
        {"x": lambda t: _step(t, 0.65, 0.0, 1.0), "n": lambda t: 0 * t}),
    Case("events of equal priority that read what the other writes", [
        variable("n", 0), variable("m", 0), *2 * [event("time >= 0.65", {"n": "n + 1"}, priority="1")],
        *2 * [event("time >= 0.65", {"m": "m + 1"}, priority="1", at_trigger=False)]],
        {"n": lambda t: _step(t, 0.65, 0.0, 1.0), "m": lambda t: _step(t, 0.65, 0.0, 2.0)}),
    Case("one of two events that cancel each other", [
        variable("n", 0), variable("m", 0), variable("last", 0), variable("sum"), always("sum", "n + m"),
        event("time - last >= 0.33", {"n": "n + 1", "last": "time"}, priority="1", persistent=False),
        event("time - last >= 0.33", {"m": "m + 1", "last": "time"}, priority="1", persistent=False)],
        {"sum": lambda t: np.floor(t / 0.33)}),
    Case("an event that triggers others again and again at one instant", [
        variable("m", 0), variable("x", 0), variable("y", 0), variable("z", 0),
        *(event("time >= 0.65", {"m": "2" if i % 2 == 0 else "0"}, priority=str(10 - i)) for i in range(9)),
        event("m > 1", {"x": "x + 1"}, priority="1", at_trigger=False), event("m > 1", {"y": "y + 1"}, priority="1"),
        event("m > 1", {"z": "z + 3"}, priority="1", persistent=False, at_trigger=False)],
        {"x": lambda t: _step(t, 0.65, 0.0, 5.0), "y": lambda t: _step(t, 0.65, 0.0, 1.0),
         "z": lambda t: _step(t, 0.65, 0.0, 3.0)}),
    Case("an event that sets what its trigger reads to what it was", [
        variable("k", 1.5), variable("n", 0), event("time > k", {"k": "2", "n": "n + 1"})],
        {"n": lambda t: np.where(t > 2.01, 2.0, np.where(t > 1.5, 1.0, 0.0))}, end=4.1),
    Case("an event that waits three times", [
        variable("n", 0), variable("x"), always("x", "piecewise(sin(10 * time), time < 2, 1)"),
        event("x < 0", {"n": "n + 1"}, delay="2", at_trigger=False)],
        {"n": lambda t: np.floor(np.clip(t - 2, 0, 2) * 10 / (2 * np.pi) + 0.5)}, end=4.1),
    Case("a trigger that holds right after the start", [
        variable("x", 1), variable("y", 1), variable("n", 0), rate("x", "1"), rate("y", "2"),
        event("y > x", {"n": "n + 1"}, delay="0.5")], {"n": lambda t: _step(t, 0.5 + 1e-9, 0.0, 1.0)}, end=2.1),
    Case("thirty events with one trigger and delays of their own", [
        *(variable(f"x{i}", 0) for i in range(30)),
        *(event("time >= 0.15", {f"x{i}": "1"}, delay=f"{0.03 * i + 0.013}") for i in range(30))],
        {f"x{i}": lambda t, i=i: _step(t, 0.163 + 0.03 * i, 0.0, 1.0) for i in range(30)}),
    Case("forty events at times of their own", [
        *(variable(f"x{i}", 0) for i in range(40)),
        *(event(f"time > {0.047 * i + 0.02}", {f"x{i}": "1"}) for i in range(40))],
        {f"x{i}": lambda t, i=i: _step(t, 0.047 * i + 0.02, 0.0, 1.0) for i in range(40)}),
    Case("a chain of a hundred species", [
        _c, *(species(f"S{i}", concentration=float(i == 0)) for i in range(100)), _k,
        *(reaction(f"R{i}", f"S{i} -> S{i + 1}", f"c * k * S{i}") for i in range(99))],
        {"S0_concentration": lambda t: exp(-0.7 * t),
         "S9_concentration": lambda t: (0.7 * t)**9 * exp(-0.7 * t) / 362880}),
    # Ids
    Case("ids that are words of C++ or of the library", [
        variable("double", 1), variable("state", 2), variable("_x", 3), variable("a__b", 4), variable("t", 5),
        variable("M_G_0", 6), rate("double", "state"), rate("a__b", "_x * t"), rate("M_G_0", "state")],
        {"double": lambda t: 1 + 2 * t, "M_G_0": lambda t: 6 + 2 * t, "a__b": lambda t: 4 + 15 * t,
         "_x": lambda t: 3 + 0 * t}),
    Case("ids that are names of what triggers have", [
        *(variable(n, 1) for n in ("due", "queue", "persistent", "E_side_1", "due_time_1")), variable("E_ceases", 0),
        rate("E_ceases", "1"), event("E_ceases > 0.65", {"queue": "due + 1", "E_side_1": "3"}, delay="0.5", id="E",
                                     persistent=False)],
         {"queue": lambda t: _step(t, 1.15, 1.0, 2.0), "E_side_1": lambda t: _step(t, 1.15, 1.0, 3.0)}),
    # Delays
    Case("before the start a delayed value is the initial one", [
        variable("x", 1), rate("x", "2"), variable("y"), always("y", "3 + delay(x, 0.65)")],
        {"y": lambda t: 4 + 2 * np.maximum(t - 0.65, 0)}),
    Case("before the start an initial assignment follows the time", [
        variable("x"), initially("x", "sin(3 * time)"), rate("x", "1"), variable("y"), always("y", "delay(x, 0.65)")],
        {"y": lambda t: np.where(t < 0.65, sin(3 * (t - 0.65)), t - 0.65)}),
    Case("before the start a constant is what its initial assignment says", [
        parameter("k"), initially("k", "2 + time"), variable("y"), always("y", "delay(k, 0.65)")],
        {"y": lambda t: np.where(t < 0.65, 1.35 + t, 2.0)}),
    Case("before the start nothing changes", [
        variable("x", 1), rate("x", "-0.7 * x"), variable("y"), always("y", "delay(rateOf(x), 0.65)")],
        {"y": lambda t: np.where(t < 0.65, 0.0, -0.7 * exp(-0.7 * (t - 0.65)))}),
    Case("a delay of a delay", [
        variable("x", 1), rate("x", "-0.7 * x"), variable("y"), always("y", "delay(x, 0.25)"), variable("z"),
        always("z", "delay(2 * y, 0.4)")], {"z": lambda t: 2 * exp(-0.7 * np.maximum(t - 0.65, 0))}),
    Case("how long a delay is may be delayed itself", [
        variable("x", 0), rate("x", "1"), variable("y"), always("y", "delay(x, delay(x, 0.65) / 2)")],
        {"y": lambda t: t - np.maximum(t - 0.65, 0) / 2}),
    Case("how long a delay is may depend on time", [
        variable("x", 1), rate("x", "2"), variable("y"), always("y", "delay(x, time / 2)")], {"y": lambda t: 1 + t}),
    Case("a delayed value jumps where its variable did", [
        variable("x", 1), event("time >= 0.52", {"x": "4"}), variable("y"), always("y", "delay(x, 0.65)")],
        {"y": lambda t: _step(t, 1.17, 1.0, 4.0)}),
    Case("a delayed time", [variable("x", 1), rate("x", "delay(time, 0.5)")], {"x": lambda t: 1 + t**2 / 2 - t / 2}),
    Case("a delay of zero", [variable("x", 1), rate("x", "-0.7 * delay(x, 0)")], {"x": lambda t: exp(-0.7 * t)}),
    Case("a delayed value in a rate", [variable("x", 1), rate("x", "-delay(x, 1)")],
         {"x": lambda t: 1 - t + np.where(t > 1, (t - 1)**2 / 2, 0.0)}),
    Case("a delayed concentration in a kinetic law", [
        _c, species("A", amount=6, only_amounts=False), variable("v", 1), rate("v", "0.5"),
        reaction("R", "A ->", "c * delay(v, 0.65)")],
        {"A_concentration": lambda t: 3 - t - np.maximum(t - 0.65, 0)**2 / 4}),
    Case("an event on a delayed value", [
        variable("x", 0), rate("x", "1"), variable("n", 0), event("delay(x, 0.65) > 0.52", {"n": "n + 1"})],
        {"n": lambda t: _step(t, 1.17, 0.0, 1.0)}),
    Case("an event assigns a delayed value from its trigger", [
        variable("x", 0), rate("x", "1"), variable("y", 0),
        event("x > 0.82", {"y": "delay(x, 0.65)"}, delay="0.5")], {"y": lambda t: _step(t, 1.32, 0.0, 0.17)}),
    Case("an event assigns a delayed value from its execution", [
        variable("x", 0), rate("x", "1"), variable("y", 0),
        event("x > 0.82", {"y": "delay(x, 0.65)"}, delay="0.5", at_trigger=False)],
        {"y": lambda t: _step(t, 1.32, 0.0, 0.67)}),
    Case("ids that are names of what delays have", [
        variable("lag", 1), variable("history", 2), variable("delayed", 3), rate("lag", "delay(history, 0.5)"),
        rate("history", "delayed")],
        {"lag": lambda t: 1 + 2 * t + 1.5 * np.maximum(t - 0.5, 0)**2, "history": lambda t: 2 + 3 * t}),
    Case("ids that differ by underscores", [variable("x", 1), variable("x_", 2), variable("_x", 3), rate("x", "x_"),
                                            rate("_x", "x")],
         {"x": lambda t: 1 + 2 * t, "_x": lambda t: 3 + t + t**2}),
]

# What is refused: a model and what the message says.
refused = [
    ([variable("x", 1), Part("Rules", element("algebraicRule", math("x - time")))], "algebraicRule"),
    ([variable("x", 1), variable("y"), always("y", "delay(x, -1)")], "a delay of -1, in assignmentRule 'y' (line "),
    ([variable("x", 1), rate("x", "delay(x, delay(x, 1))")], "a delay that is a delayed value itself"),
    ([variable("x", 1), event("time > 1", {"x": "2"}, delay="-0.5", id="earlier")], "event 'earlier' (line "),
    ([variable("x", 1), event("time > 1", {"x": "2"}, persistent=False), event("x < 1.5 && time > 1", {"x": "3"}),
      Part("Rules", element("rateRule", variable="y"))], "no valid SBML"),
    ([variable("x"), variable("y"), always("x", "y"), always("y", "x")], "no valid SBML"),
    ([variable("x"), always("x", "unknown + 1")], "no valid SBML"),
]


def write(folder, case, number):
    """A case as files of the test suite, in a folder of its own, which is returned."""
    name = f"{number:05d}"
    path = folder / name
    path.mkdir()
    (path / f"{name}-sbml-l3v2.xml").write_text(case.text)
    times = np.linspace(0, case.end, 21)
    variables = [re.sub("_(amount|concentration)$", "", v) for v in case.results]
    of_kind = {k: [v.removesuffix(f"_{k}") for v in case.results if v.endswith(f"_{k}")]
               for k in ("amount", "concentration")}
    assert not set(of_kind["amount"]) & set(of_kind["concentration"])
    settings = {"start": 0, "duration": case.end, "steps": 20, "variables": ", ".join(variables), "absolute": 1e-6,
                "relative": 1e-6, **{k: ", ".join(v) for k, v in of_kind.items()}}
    (path / f"{name}-settings.txt").write_text("".join(f"{k}: {v}\n" for k, v in settings.items()))
    columns = [times, *(np.broadcast_to(f(times), times.shape) for f in case.results.values())]
    rows = [",".join(["time", *variables]), *(",".join(f"{v:.17g}" for v in row) for row in zip(*columns))]
    (path / f"{name}-results.csv").write_text("\n".join(rows) + "\n")
    return path
