# SPDX-License-Identifier: MIT
"""Models from .ode files of XPPAUT, the format of nonlinear dynamics."""

from __future__ import annotations

import functools
import os
import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Any, NoReturn

import numpy as np

from ...base.errors import Error, users_line
from ...codegen.model import Model
from ...models.event import Event, event
from ...symbolic import expression as ex, symbols as sym
from ...symbolic.evaluate import evaluate
from ...symbolic.expression import symbols_of
from ...symbolic.folding import compare, constant, is_constant, value_of
from ...symbolic.interpolate import interpolate
from ..deep_stack import deeply
from .formula import Names, NoFormula, formula, words

if TYPE_CHECKING:
    from ...symbolic.types import Path

__all__ = ["read_xpp", "XppModel"]


def read_xpp(source: Path | str, *, name: str | None = None) -> XppModel:
    """The model of an .ode file of XPPAUT, given by its path or as a text of several lines.

    Equations (`x'=`, `dx/dt=`) are states, `par` are parameters, `init` initial values; `aux` and other quantities,
    `!` parameters among them, are outputs of a run by their names. `number` are constants, functions and tables are
    written into the equations, and `global` are events. Names are those of the file in small letters, as XPPAUT does
    not tell the letters' size apart; results have those of the file too. `model.time` are the ends of the time domain,
    `model.settings` all that stands behind `@`, and `model.sets` the values of `set` by name.

    Raises `my.Error` with the line for what is not supported: maps, delays, integrals over the past, random
    numbers and Markov processes, algebraic equations, boundary conditions, networks of `special`.
    """
    text, folder, called = _text_of(source)
    return deeply(lambda: XppModel(_File(text, folder), name or called))


def _text_of(source: Path | str) -> tuple[str, FilePath, str]:
    if isinstance(source, str) and "\n" in source:
        return source, FilePath("."), "model"
    path = FilePath(os.fspath(source))
    if not path.is_file():
        raise Error(f"there is no file '{path}': give the path of an .ode file, or its text")
    return path.read_text(errors="replace"), path.parent, path.stem


@dataclass
class _Line:
    number: int
    text: str

    def refuse(self, why: str) -> NoReturn:
        raise Error(f"line {self.number}, `{self.text[:80]}`: {why}")


@dataclass
class _Global:
    line: _Line
    sign: int
    condition: str
    resets: list[tuple[str, str]]


@dataclass
class _Parts:
    """What a file has, in its order."""

    equations: dict[str, tuple[_Line, str]] = field(default_factory=dict)
    parameters: dict[str, float] = field(default_factory=dict)
    numbers: dict[str, float] = field(default_factory=dict)
    initial: dict[str, tuple[_Line, str]] = field(default_factory=dict)
    derived: dict[str, tuple[_Line, str]] = field(default_factory=dict)
    quantities: dict[str, tuple[_Line, str]] = field(default_factory=dict)
    outputs: dict[str, tuple[_Line, str]] = field(default_factory=dict)
    functions: dict[str, tuple[_Line, list[str], str]] = field(default_factory=dict)
    tables: list[tuple[_Line, str, str]] = field(default_factory=list)
    events: list[_Global] = field(default_factory=list)


_statement = re.compile(r"([a-z]+)\s+(?![=(])(.*)", re.DOTALL)
_equation = re.compile(r"(?:([a-z]\w*)\s*'|d([a-z]\w*)\s*/\s*dt)\s*=(?!=)(.*)")
_of_arguments = re.compile(r"([a-z]\w*)\s*\(([^()]*)\)\s*=(?!=)(.*)")
_definition = re.compile(r"([a-z]\w*)\s*=(?!=)(.*)")
_pair = re.compile(r"([a-z]\w*)\s*=\s*([^\s,;=]+)")
_range = re.compile(r"\[\s*(\d+)\s*\.\.\s*(\d+)\s*\]")
_index = re.compile(r"\[\s*(?:j\s*(?:([-+*])\s*(\d+))?|(\d+))\s*\]")

# Statements by their first letters, as XPPAUT knows them.
_kinds = {"p": "parameter", "i": "init", "n": "number", "a": "aux", "g": "global", "t": "table", "w": "wiener",
          "m": "markov", "b": "bdry", "o": "options", "v": "volterra"}
_words = ("params", "parameters", "init", "number", "aux", "auxiliary", "global", "table", "wiener",
          "markov", "bdry", "bndry", "boundary", "options", "volterra", "set", "special", "solve", "solv", "export")
_refused = {"wiener": "noise is not supported", "markov": "Markov processes are not supported",
            "bdry": "boundary conditions are not supported", "volterra": "integrals over the past are not supported",
            "special": "networks of `special` are not supported: write the sums out, as by sum(0,n)of(...)",
            "solve": "algebraic equations are not supported", "solv": "algebraic equations are not supported",
            "export": "libraries of functions are not supported",
            "options": "files of options are not read: write them behind @"}


def _kind_of(word: str) -> str | None:
    """Which statement a word begins."""
    if word in ("set", "special", "solve", "solv", "export"):
        return word
    if any(known.startswith(word) for known in _words) and word[0] in _kinds:
        return _kinds[word[0]]
    return None


class _File:
    """The statements of a file."""

    def __init__(self, text: str, folder: FilePath) -> None:
        self.folder = folder
        self.settings: dict[str, Any] = {}
        self.sets: dict[str, dict[str, float]] = {}
        self.spelled: dict[str, str] = {}  # names as the file has them
        self.parts = _Parts()
        for line in self._lines(text):
            self._read(line)
        if not self.parts.equations:
            raise Error("the file has no equation: write x'=... or dx/dt=...")

    # -- Lines ---------------------------------------------------------------------------------------------------------

    def _lines(self, text: str) -> Iterator[_Line]:
        """The statements: without comments, with continued lines joined and arrays written out."""
        joined: list[_Line] = []
        for number, written in enumerate(text.splitlines(), 1):
            if joined and joined[-1].text.endswith("\\"):
                joined[-1].text = joined[-1].text[:-1] + written.strip()
                continue
            joined.append(_Line(number, written.strip()))
        group: list[_Line] | None = None
        ends = range(0)
        for line in joined:
            if line.text[:1] in ("", "#", '"'):
                continue
            if re.fullmatch("(?i)d(one)?", line.text):
                return
            if line.text.startswith("%"):
                if group is not None:
                    for j in ends:
                        yield from (_Line(g.number, self._indexed(g, g.text, j)) for g in group)
                    group = None
                    continue
                found = _range.match(line.text[1:].lstrip())
                if found:
                    group, ends = [], range(int(found[1]), int(found[2]) + 1)
                elif re.match(r"%\s*\[", line.text):
                    line.refuse("a group begins with its range, as in %[1..3]")
                continue  # else a remark
            if group is not None:
                group.append(line)
            elif line.text.startswith("@"):
                yield line
            else:
                yield from self._written_out(line)
        if group is not None:
            raise Error("a group that begins with % has no end: write % on a line of its own")

    def _written_out(self, line: _Line) -> Iterator[_Line]:
        ranges = {(int(a), int(b)) for a, b in _range.findall(line.text)}
        if not ranges:
            yield _Line(line.number, self._indexed(line, line.text, None))
            return
        if len(ranges) > 1:
            line.refuse("it has several ranges")
        (first, last), = ranges
        for j in range(first, last + 1):
            yield _Line(line.number, self._indexed(line, _range.sub(str(j), line.text), j))

    @staticmethod
    def _indexed(line: _Line, text: str, j: int | None) -> str:
        """A text with numbers in the place of [j], [j+1], [3]."""
        def number(found: re.Match[str]) -> str:
            operator, by, fixed = found.groups()
            if fixed:
                return fixed
            if j is None:
                line.refuse("[j] stands outside of an array")
            return str(j if not operator else {"+": j + int(by), "-": j - int(by), "*": j * int(by)}[operator])

        return _index.sub(number, text)

    # -- Statements ----------------------------------------------------------------------------------------------------

    def _read(self, line: _Line) -> None:
        for word in re.findall(r"[A-Za-z]\w*", line.text):
            self.spelled.setdefault(word.lower(), word)
        text = line.text.lower()
        parts = self.parts
        if text.startswith("@"):
            self._settings(line.text[1:])
            return
        if text.startswith("!"):
            found = _definition.fullmatch(text[1:].strip())
            if not found:
                line.refuse("a derived parameter is written !name=formula")
            self._new(line, found[1], parts.derived, (line, found[2]))
            return
        statement = _statement.fullmatch(text)
        kind = _kind_of(statement[1]) if statement else None
        if statement and kind:
            self._statement(line, kind, statement[2].strip())
            return
        if text.split()[0] == "only":  # which says what is plotted
            return
        if re.search(r"\bint\s*[\[{]", text):
            line.refuse("integral equations are not supported")
        if re.match(r"0\s*=", text):
            line.refuse("algebraic equations are not supported")
        if re.match(r"[a-z]\w*\s*\(\s*t\s*\+\s*1\s*\)\s*=", text):
            line.refuse("a map has no derivatives, and is not supported")
        found = _equation.fullmatch(text)
        if found:
            self._new(line, found[1] or found[2], parts.equations, (line, found[3]))
            return
        found = _of_arguments.fullmatch(text)
        if found:
            self._of_arguments(line, *found.groups())
            return
        found = _definition.fullmatch(text)
        if not found:
            line.refuse("it is no statement of an .ode file that is known")
        self._new(line, found[1], parts.quantities, (line, found[2]))

    def _new(self, line: _Line, name: str, among: dict[str, Any], value: Any) -> None:
        parts = self.parts
        if name in words:
            line.refuse(f"`{name}` has a meaning of its own and names no quantity")
        for known in (parts.equations, parts.parameters, parts.numbers, parts.derived, parts.quantities,
                      parts.functions):
            if name in known:
                line.refuse(f"`{name}` is defined a second time")
        among[name] = value

    def _of_arguments(self, line: _Line, name: str, arguments: str, value: str) -> None:
        if arguments.strip() == "0":
            self.parts.initial[name] = (line, value)
        else:
            wanted = [a.strip() for a in arguments.split(",")]
            if not all(re.fullmatch(r"[a-z]\w*", a) for a in wanted):
                line.refuse("a function is written name(x,y)=formula")
            self._new(line, name, self.parts.functions, (line, wanted, value))

    def _statement(self, line: _Line, kind: str, rest: str) -> None:
        if kind in _refused:
            line.refuse(_refused[kind])
        if kind in ("parameter", "number"):
            among = self.parts.parameters if kind == "parameter" else self.parts.numbers
            for name, value in self._pairs(line, rest):
                self._new(line, name, among, self._number(line, value))
        elif kind == "init":
            for name, value in self._pairs(line, rest):
                self.parts.initial[name] = (line, value)
        elif kind == "aux":
            found = _definition.fullmatch(rest)
            if not found:
                line.refuse("an auxiliary quantity is written aux name=formula")
            self.parts.outputs[found[1]] = (line, found[2])
        elif kind == "global":
            self._global(line, rest)
        elif kind == "table":
            name, _, what = rest.partition(" ")
            self._new(line, name, self.parts.functions, (line, ["x"], ""))
            del self.parts.functions[name]
            self.parts.tables.append((line, name, what.strip()))
        else:
            found = re.fullmatch(r"([a-z]\w*)\s*\{(.*)\}", rest)
            if not found:
                line.refuse("a set is written set name {a=1,b=2}")
            self.sets[found[1]] = {name: float(value) for name, value in _pair.findall(found[2])
                                   if _is_number(value)}

    def _pairs(self, line: _Line, text: str) -> list[tuple[str, str]]:
        pairs = _pair.findall(text)
        left = _pair.sub("", text).replace(",", " ").split()
        if not all(re.fullmatch(r"[a-z]\w*", name) for name in left) or not (pairs or left):
            line.refuse("it is no list of names with values, as in a=1, b=2")
        return pairs + [(name, "0") for name in left]

    @staticmethod
    def _number(line: _Line, text: str) -> float:
        if not _is_number(text):
            line.refuse(f"`{text}` is no number")
        return float(text)

    def _settings(self, text: str) -> None:
        for name, value in re.findall(r"(\w+)\s*=\s*([^\s,]+)", text):
            self.settings[name.lower()] = float(value) if _is_number(value) else value

    def _global(self, line: _Line, text: str) -> None:
        found = re.fullmatch(r"([-+]?\d+)\s*(\{.*?\}|[^{}]*)\s*\{(.*)\}", text)
        if not found or int(found[1]) not in (-1, 0, 1):
            line.refuse("an event is written global sign {condition} {name=formula; ...}, with the sign 1 or -1")
        if int(found[1]) == 0:
            line.refuse("an event of the sign 0, where a condition is zero without a change of sign, is not supported: "
                        "give 1 for one that rises through zero, -1 for one that falls")
        resets = []
        for reset in filter(None, (r.strip() for r in found[3].split(";"))):
            parts = re.fullmatch(r"([a-z]\w*)\s*=(.*)", reset)
            if not parts:
                line.refuse(f"`{reset}` sets nothing: write name=formula")
            resets.append((parts[1], parts[2]))
        self.parts.events.append(_Global(line, int(found[1]), found[2].strip("{} "), resets))


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True


def _in_line(line: _Line, text: str, names: Names) -> Any:
    """The expression of a formula."""
    try:
        return formula(text.strip(), names)
    except NoFormula as why:
        line.refuse(str(why))


class XppModel(Model):
    """A model from an .ode file. `outputs` are expressions by name that a run computes; `time` are the ends of the time
    domain, `settings` what stands behind @ by name, and `sets` values by component of each `set`."""

    is_from_a_file = True

    def __init__(self, file: _File, name: str) -> None:
        parts = file.parts
        self._taken: dict[str, str] = {}
        self._ids = {*parts.equations, *parts.parameters, *parts.derived, *parts.quantities, *parts.outputs}
        states = {n: sym.symbol("state", self._component(n, n)) for n in parts.equations}
        parameters = {n: sym.symbol("parameter", self._component(n, n)) for n in parts.parameters}
        names = Names()
        names.series = [list(states), list(parts.quantities)]
        names.values = {"t": sym.time, "pi": constant(np.pi), **{n: constant(v) for n, v in parts.numbers.items()},
                        **parameters, **states}
        names.functions = {n: (arguments, body) for n, (_, arguments, body) in parts.functions.items()}
        for line, table, what in parts.tables:
            names.tables[table] = _table(file, line, table, what, names, self._component(table))
        # each when it is needed, as a file may define them below what uses them
        names.later = {n: functools.partial(_in_line, *given, names)
                       for n, given in (*parts.derived.items(), *parts.quantities.items())}
        for n in (*parts.derived, *parts.quantities):
            names.find(n)
        equations = {states[n]: _in_line(line, text, names) for n, (line, text) in parts.equations.items()}
        events = [self._event(one, number, names, states, parameters) for number, one in enumerate(parts.events, 1)]
        name = self._component(re.sub("_+", "_", re.sub(r"\W", "_", name.lower())).strip("_") or "model")
        self._reserved = {*self._taken, *self._ids}
        super().__init__(equations, events, None, None, None, None, None, None, list(parameters.values()), (), name)
        self.line, self.hidden = users_line(), frozenset(self.accessories)
        self.defaults: dict[str, Any] = {**self.shared_values}
        for n, symbol in states.items():
            self.defaults[symbol.value[1]] = constant(0.0)
            if n in parts.initial:
                line, text = parts.initial.pop(n)
                value = self.defaults[symbol.value[1]] = _in_line(line, text, names)
                if any(s in states.values() for s in symbols_of([value])):
                    line.refuse("an initial value depends on a state")
        for line, _ in parts.initial.values():
            line.refuse("it gives an initial value to what has no equation")
        for n, symbol in parameters.items():
            self.defaults[symbol.value[1]] = constant(parts.parameters[n])
        self.outputs = {n: names.values[n] for n in (*parts.derived, *parts.quantities)}
        self.outputs |= {n: _in_line(line, text, names) for n, (line, text) in parts.outputs.items()
                         if n not in states and n not in parameters}
        components = {n: symbol.value[1] for n, symbol in (*states.items(), *parameters.items())}
        self.aliases = {alias: component for n, component in components.items()
                        for alias in (n, file.spelled.get(n, n)) if alias != component}
        for n in [*self.outputs]:
            if file.spelled.get(n, n) not in (n, *self.aliases, *components):
                self.outputs[file.spelled[n]] = self.outputs[n]
        self.settings, begin = file.settings, file.settings.get("t0", 0.0)
        self.time = (begin, begin + file.settings.get("total", 20.0))
        self.sets = {given: {components[n]: v for n, v in values.items() if n in components}
                     for given, values in file.sets.items()}

    def _component(self, wanted: str, of: str = "") -> str:
        """A name like the wanted one that a component of a model can have. Nothing in the file has it, except what is
        named, which the file calls `of`."""
        name = re.sub("_+", "_", wanted).rstrip("_") or "x"
        name = name if name[0].isalpha() else f"x{name}"
        free = sym.free_name(name, {*self._taken, *(self._ids - {of})})
        self._taken[free] = wanted
        return free

    def _event(self, one: _Global, number: int, names: Names, states: dict[str, Any],
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


def _table(file: _File, line: _Line, name: str, what: str, names: Names, component: str) -> Any:
    """The function of a table: of values in a file, or of a formula of t at points between two ends."""
    if what.startswith("@"):
        line.refuse("tables of two arguments are not supported")
    x, y, kind = _points_of_formula(line, what, names) if what.startswith("%") else _points_of_file(file, line, what)
    if kind == "step":
        line.refuse("tables of steps are not supported")

    def function(argument: Any) -> Any:
        if is_constant(argument):
            symbol = ex.make("symbol", value=("argument", "0"))
            found, = evaluate([interpolate(symbol, x, y, "linear", "extrapolate", component)],
                              {symbol: np.float64(value_of(argument))})
            return constant(found)
        return interpolate(argument, x, y, "linear", "extrapolate", component)

    return function


def _points_of_formula(line: _Line, what: str, names: Names) -> tuple[Any, Any, str]:
    found = re.fullmatch(r"%\s*(\d+)\s+(\S+)\s+(\S+)\s+(.+)", what)
    if not found or not (_is_number(found[2]) and _is_number(found[3])) or int(found[1]) < 2:
        line.refuse("a table of a formula is written table name % points low high formula")
    x = np.linspace(float(found[2]), float(found[3]), int(found[1]))
    expression = _in_line(line, found[4], names)
    if any(s is not sym.time for s in symbols_of([expression])):
        line.refuse("a table of a formula of states or parameters is not supported")
    if is_constant(expression):
        return x, np.full(x.shape, float(value_of(expression))), "linear"
    return x, np.asarray(evaluate([expression], {sym.time: x})[0], float), "linear"


def _points_of_file(file: _File, line: _Line, what: str) -> tuple[Any, Any, str]:
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
            return pairs[:, 0], pairs[:, 1], "linear"
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
    return np.linspace(low, high, count), y, kind
