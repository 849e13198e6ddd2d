# SPDX-License-Identifier: MIT
"""Models from .ode files of XPPAUT, the format of nonlinear dynamics."""

from __future__ import annotations

import functools
import os
import re
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Any

import numpy as np

from ...base.errors import Error, users_line
from ...codegen.model import Model
from ...models.delays import own_names
from ...models.event import Event, event
from ...symbolic import symbols as sym
from ...symbolic.delays import pasts_of
from ...symbolic.derivatives import derivatives
from ...symbolic.node import symbols_of
from ...symbolic.folding import add, compare, constant, divide, is_constant, multiply, subtract, value_of
from ...symbolic.interpolate import interpolate
from ...symbolic.rewrite import rebuilt
from ..deep_stack import deeply
from .formula import Names, NoFormula, formula
from .ode_file import Global, Line, OdeFile, Parts, in_ascii, is_number

if TYPE_CHECKING:
    from ...symbolic.types import Path

__all__ = ["read_xpp", "XppModel"]


def read_xpp(source: Path | str, *, name: str | None = None) -> XppModel:
    """The model of an .ode file of XPPAUT, given by its path or as a text of several lines.

    Equations (`x'=`, `dx/dt=`) are states, `par` are parameters, `init` initial values; `aux` and other quantities,
    `!` parameters among them, are outputs of a run by their names. `number` are constants, functions and tables are
    written into the equations, `global` are events, and what `wiener` names is noise of the equations. Names are those
    of the file in small letters, as XPPAUT does not tell the letters' size apart; results have those of the file too.
    `model.time` are the ends of the time domain, `model.settings` all that stands behind `@`, and `model.sets` the
    values of `set` by name.

    An unknown of algebraic equations, `0=` with `solv`, is a state of a mass matrix, whose equation has no derivative:
    method="rodas_5p", and make_consistent=True to begin with a solution. `model.boundary_conditions` has the texts of
    `bdry`, which the initial value problem does not need.

    `delay(x, tau)` is `my.delayed`; before the begin x is what `x(0)=` says, also as a function of t, else zero.

    Raises `my.Error` with the line for what is not supported: maps, integrals over the past, random numbers and Markov
    processes, networks of `special`, libraries.
    """
    text, folder, called = _text_of(source)
    return deeply(lambda: XppModel(OdeFile(text, folder), name or called))


def _text_of(source: Path | str) -> tuple[str, FilePath, str]:
    if isinstance(source, str) and "\n" in source:
        return source, FilePath("."), "model"
    path = FilePath(os.fspath(source))
    if not path.is_file():
        raise Error(f"there is no file '{path}': give the path of an .ode file, or its text")
    return path.read_text(errors="replace"), path.parent, path.stem


def _in_line(line: Line, text: str, names: Names) -> Any:
    """The expression of a formula."""
    try:
        return formula(text.strip(), names)
    except NoFormula as why:
        line.refuse(str(why))


def _product(a: Any, b: Any) -> Any:
    """a b, and zero if one of them is."""
    return constant(0.0) if any(is_constant(c) and value_of(c) == 0 for c in (a, b)) else multiply(a, b)


_sums = {"add": add, "subtract": subtract, "multiply": _product}  # in which noise that is zero leaves nothing


class XppModel(Model):
    """A model from an .ode file. `outputs` are expressions by name that a run computes; `time` are the ends of the time
    domain, `settings` what stands behind @ by name, `sets` values by component of each `set`, and
    `boundary_conditions` what is zero at the ends of a solution of the file's boundary value problem, as texts."""

    is_from_a_file = True

    def __init__(self, file: OdeFile, name: str) -> None:
        parts = file.parts
        self._taken: dict[str, str] = dict.fromkeys(own_names, "") if file.has_delays else {}
        self._ids = {*parts.equations, *parts.parameters, *parts.derived, *parts.quantities, *parts.outputs,
                     *parts.processes, *parts.unknowns}
        states = {n: sym.symbol("state", self._component(n, n)) for n in (*parts.equations, *parts.unknowns)}
        parameters = {n: sym.symbol("parameter", self._component(n, n)) for n in parts.parameters}
        self._processes = [sym.symbol("noise", self._component(n, n)) for n in parts.processes]
        names = Names()
        names.series = [list(parts.equations), list(parts.quantities)]
        names.values = {"t": sym.time, "pi": constant(np.pi), **{n: constant(v) for n, v in parts.numbers.items()},
                        **parameters, **states, **dict(zip(parts.processes, self._processes))}
        names.functions = {n: (arguments, body) for n, (_, arguments, body) in parts.functions.items()}
        for line, table, what in parts.tables:
            names.tables[table] = _table(file, line, table, what, names, self._component(table))
        # each when it is needed, as a file may define them below what uses them
        names.later = {n: functools.partial(_in_line, *given, names)
                       for n, given in (*parts.derived.items(), *parts.quantities.items())}
        for n in (*parts.derived, *parts.quantities):
            names.find(n)
        noise: dict[Any, dict[Any, Any]] = {}
        equations = {states[n]: self._slope(line, text, names, noise.setdefault(states[n], {}))
                     for n, (line, text) in parts.equations.items()}
        for n, (line, text) in zip(parts.unknowns, parts.residuals):
            of_none: dict[Any, Any] = {}
            equations[states[n]] = self._slope(line, text, names, of_none)
            if of_none:
                line.refuse("an algebraic equation has noise, and so its solution no derivative: give noise to "
                            "differential equations alone, in a file without algebraic ones")
        if parts.unknowns and any(noise.values()):
            parts.residuals[0][0].refuse("algebraic equations beside noise, which no method takes: solve them in the "
                                         "others")
        noise = {state: factors for state, factors in noise.items() if factors}
        events = [self._event(one, number, names, states, parameters) for number, one in enumerate(parts.events, 1)]
        before = self._history(parts, states, names) if file.has_delays else {}
        read = {past.value[1].state for past in pasts_of([*equations.values(), *(
            e for one in events for e in (one.function, *one.do.values()))])}
        name = self._component(re.sub("_+", "_", re.sub(r"\W", "_", in_ascii(name.lower()))).strip("_") or "model")
        self._reserved = {*self._taken, *self._ids}
        super().__init__(equations, events, None, None, None, None, None, None, list(parameters.values()), (), name,
                         mass_matrix={states[n]: 0.0 for n in parts.unknowns} or None, noise=noise,
                         history={s: b for s, b in before.items() if s in read})
        self.line, self.hidden = users_line(), frozenset(self.accessories)
        self.defaults: dict[str, Any] = {**self.shared_values}
        self._set_initial_values(parts, states, names)
        for n, symbol in parameters.items():
            self.defaults[symbol.value[1]] = constant(parts.parameters[n])
        components = {n: symbol.value[1] for n, symbol in (*states.items(), *parameters.items())}
        self.aliases = {alias: component for n, component in components.items()
                        for alias in (n, file.spelled.get(n, n)) if alias != component}
        self._set_outputs(file, names, components)
        self.history_of_outputs = {state.value[1]: value for state, value in before.items()}
        self.boundary_conditions = file.boundary
        self.settings, begin = file.settings, file.settings.get("t0", 0.0)
        self.time = (begin, begin + file.settings.get("total", 20.0))
        self.sets = {given: {components[n]: v for n, v in values.items() if n in components}
                     for given, values in file.sets.items()}

    def _set_initial_values(self, parts: Parts, states: dict[str, Any], names: Names) -> None:
        """The values at the start: what the file says, the guesses of unknowns, else zero."""
        for n, symbol in states.items():
            self.defaults[symbol.value[1]] = constant(0.0)
            given = parts.initial.pop(n, parts.unknowns.get(n))
            if given is not None:
                line, text = given
                value = self.defaults[symbol.value[1]] = _in_line(line, text, names)
                if any(s.value[0] in ("state", "noise", "delayed") for s in symbols_of([value])):
                    line.refuse("an initial value depends on a state or on noise")
        for line, _ in parts.initial.values():
            line.refuse("it gives an initial value to what has no equation")

    def _set_outputs(self, file: OdeFile, names: Names, components: dict[str, str]) -> None:
        """What a run has besides components, those that read the past apart, and also as the file spells them."""
        parts = file.parts
        found = {n: names.values[n] for n in (*parts.derived, *parts.quantities)}
        found |= {n: _in_line(line, text, names) for n, (line, text) in parts.outputs.items() if n not in components}
        found = {n: value for n, value in found.items() if not self._is_noisy([value])}
        for n in [*found]:
            if file.spelled.get(n, n) not in (n, *self.aliases, *components):
                found[file.spelled[n]] = found[n]
        self.outputs = {n: value for n, value in found.items() if not pasts_of([value])}
        self.past_outputs = {n: value for n, value in found.items() if n not in self.outputs}

    def _component(self, wanted: str, of: str = "") -> str:
        """A name like the wanted one that a component of a model can have. Nothing in the file has it, except what is
        named, which the file calls `of`."""
        name = re.sub("_+", "_", wanted).rstrip("_") or "x"
        name = name if name[0].isalpha() else f"x{name}"
        free = sym.free_name(name, {*self._taken, *(self._ids - {of})})
        self._taken[free] = wanted
        return free

    def _is_noisy(self, expressions: list[Any]) -> bool:
        """Whether expressions depend on Wiener processes."""
        return not {*self._processes}.isdisjoint(symbols_of(expressions))

    @staticmethod
    def _history(parts: Parts, states: dict[str, Any], names: Names) -> dict[Any, Any]:
        """What states were before the begin: what x(0)= says, also as a function of t, else zero, as in XPPAUT."""
        found = {}
        for n, symbol in states.items():
            found[symbol] = _in_line(*parts.history[n], names) if n in parts.history else constant(0.0)
            if any(s.value[0] in ("state", "noise", "delayed") for s in symbols_of([found[symbol]])):
                parts.history[n][0].refuse("what was before the begin depends on a state or on noise")
        return found

    def _slope(self, line: Line, text: str, names: Names, noise: dict[Any, Any]) -> Any:
        """The right-hand side of an equation without its noise, and the factors of that, which go to `noise`."""
        slope = _in_line(line, text, names)
        if not self._is_noisy([slope]):
            return slope
        found = derivatives([slope], self._processes)
        factors = {} if found is None else {self._processes[i]: factor for i, factor in found[0].items()}
        if not factors or self._is_noisy(list(factors.values())):
            line.refuse("noise is a sum of Wiener processes, each times a factor without them")
        noise |= factors
        zero = {process: constant(0.0) for process in self._processes}
        return rebuilt([slope], lambda node: _sums[node.op](*node.args) if node.op in _sums else node, zero)[0]

    def _event(self, one: Global, number: int, names: Names, states: dict[str, Any],
               parameters: dict[str, Any]) -> Event:
        """Its resets one after the other, each with the states that those before it have set."""
        known = Names()
        known.values, known.functions, known.tables, known.series = (
            dict(names.values), names.functions, names.tables, names.series)
        function = _in_line(one.line, one.condition, names)
        do: dict[Any, Any] = {}
        for name, text in one.resets:
            value = _in_line(one.line, text, known)
            if name in states:
                do[states[name]] = known.values[name] = value
            elif name in parameters:
                do[parameters[name]] = value
            elif name == "arret":
                do[sym.end_instance] = compare("greater", value, constant(0.0))
            elif name != "out_put":
                one.line.refuse(f"it sets `{name}`, which is neither a state nor a parameter")
        return event(function, name=self._component(f"event_{number}"),
                     direction="rising" if one.sign > 0 else "falling", do=do)


def _table(file: OdeFile, line: Line, name: str, what: str, names: Names, component: str) -> Any:
    """The function of a table: of values in a file, or of a formula of t at points between two ends."""
    if what.startswith("@"):
        line.refuse("tables of two arguments are not supported")
    x, y, kind = _points_of_formula(line, what, names) if what.startswith("%") else _points_of_file(file, line, what)
    if kind == "step":
        line.refuse("tables of steps are not supported")
    known = all(is_constant(one) for one in y)
    values = np.array([value_of(one) for one in y]) if known else None

    def function(argument: Any) -> Any:
        if is_constant(argument):
            place = float(value_of(argument))
            row = int(np.clip(np.searchsorted(x, place, side="right") - 1, 0, len(x) - 2))
            slope = divide(subtract(y[row + 1], y[row]), constant(x[row + 1] - x[row]))
            return add(y[row], multiply(constant(place - x[row]), slope)) if place != x[row] else y[row]
        if values is None:
            raise NoFormula(f"the table `{name}` has values that depend on parameters, and is looked up at what varies")
        return interpolate(argument, x, values, "linear", "extrapolate", component)

    return function


def _points_of_formula(line: Line, what: str, names: Names) -> tuple[Any, list[Any], str]:
    found = re.fullmatch(r"%\s*(\d+)\s+(\S+)\s+(\S+)\s+(.+)", what)
    if not found or not (is_number(found[2]) and is_number(found[3])) or int(found[1]) < 2:
        line.refuse("a table of a formula is written table name % points low high formula")
    x = np.linspace(float(found[2]), float(found[3]), int(found[1]))
    try:
        y = [formula(found[4].strip(), names, {"t": constant(float(at))}) for at in x]
    except NoFormula as why:
        line.refuse(str(why))
    if any(s.value[0] != "parameter" for s in symbols_of(y)):
        line.refuse("a table of a formula of states is not supported")
    return x, y, "linear"


def _points_of_file(file: OdeFile, line: Line, what: str) -> tuple[Any, Any, str]:
    """Of a file with the number of points, both ends, and the values, or "xyvals", the number, and pairs."""
    path = next((file.folder / w for w in re.findall(r"\S+", line.text)[-1:] if (file.folder / w.strip('"')).is_file()),
                file.folder / what.strip('"'))
    path = path.parent / path.name.strip('"')
    if not path.is_file():
        line.refuse(f"there is no file '{path}'")
    values = path.read_text().split()
    try:
        if values[0].lower() == "xyvals":
            pairs = np.array(values[2:2 + 2 * int(values[1])], float).reshape(int(values[1]), 2)
            return pairs[:, 0], [constant(one) for one in pairs[:, 1]], "linear"
        kind = {"i": "step", "s": "spline"}.get(values[0][0].lower(), "linear")
        count = int(values[0].lstrip("isIS"))
        low, high = float(values[1]), float(values[2])
        y = np.array(values[3:3 + count], float)
        if len(y) != count or not low < high:
            raise ValueError
    except (ValueError, IndexError):
        line.refuse(f"'{path}' has no number of points, two ends and as many values")
    if kind == "spline":
        line.refuse("tables with splines are not supported")
    return np.linspace(low, high, count), [constant(one) for one in y], kind
