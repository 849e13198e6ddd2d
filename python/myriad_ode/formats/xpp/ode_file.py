# SPDX-License-Identifier: MIT
"""The statements of an .ode file of XPPAUT, as text."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path as FilePath
from typing import Any, NoReturn

from ...base.errors import Error
from .formula import words


@dataclass
class Line:
    number: int
    text: str

    def refuse(self, why: str) -> NoReturn:
        raise Error(f"line {self.number}, `{self.text[:80]}`: {why}")


@dataclass
class Global:
    line: Line
    sign: int
    condition: str
    resets: list[tuple[str, str]]


@dataclass
class Parts:
    """What a file has, in its order."""

    equations: dict[str, tuple[Line, str]] = field(default_factory=dict)
    parameters: dict[str, float] = field(default_factory=dict)
    numbers: dict[str, float] = field(default_factory=dict)
    initial: dict[str, tuple[Line, str]] = field(default_factory=dict)
    history: dict[str, tuple[Line, str]] = field(default_factory=dict)
    derived: dict[str, tuple[Line, str]] = field(default_factory=dict)
    quantities: dict[str, tuple[Line, str]] = field(default_factory=dict)
    outputs: dict[str, tuple[Line, str]] = field(default_factory=dict)
    functions: dict[str, tuple[Line, list[str], str]] = field(default_factory=dict)
    tables: list[tuple[Line, str, str]] = field(default_factory=list)
    processes: dict[str, Line] = field(default_factory=dict)
    events: list[Global] = field(default_factory=list)
    residuals: list[tuple[Line, str]] = field(default_factory=list)  #: that are zero: those of 0=
    unknowns: dict[str, tuple[Line, str]] = field(default_factory=dict)  #: of these, with a first guess


_statement = re.compile(r"([a-z]+)\s+(?![=(])(.*)", re.DOTALL)
_condition = re.compile(r"(b[a-z]*)\s+(\([^=]*)")  # of a boundary, in parentheses
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
_integral = ("integrals over the past are not supported: write a kernel exp(-t/tau) as an equation of its own, "
             "w'=x-w/tau, and other kernels as chains of such equations")
_map = "a map has no derivatives, and is not supported: iterate it in NumPy, or write x'= where an equation is meant"
_refused = {"markov": "Markov processes are not supported: write the equation of their mean, or delete the line",
            "volterra": _integral,
            "special": "networks of `special` are not supported: write the sums out, as by sum(0,n)of(...)",
            "options": "files of options are not read: write them behind @"}


def _kind_of(word: str) -> str | None:
    """Which statement a word begins."""
    if word in ("set", "special", "solve", "solv", "export"):
        return word
    if any(known.startswith(word) or word.startswith(known[:3]) for known in _words) and word[0] in _kinds:
        return _kinds[word[0]]
    return None


def in_ascii(word: str) -> str:
    """A name like a word, in letters of ASCII: without accents, with the names of Greek letters."""
    def letter(c: str) -> str:
        if c.isascii() or unicodedata.combining(c):
            return c if c.isascii() else ""
        name = unicodedata.name(c, "").lower().partition(" letter ")[2].partition(" ")[0]
        return name if name.isidentifier() else f"u{ord(c):04x}"

    return "".join(letter(c) for c in unicodedata.normalize("NFKD", word))


def _names_in_ascii(text: str) -> tuple[str, dict[str, str]]:
    """A text with names in letters of ASCII, and {such a name in small letters: the one that the text has}."""
    found = dict.fromkeys(re.findall(r"[^\W\d]\w*", text))
    names = {word.lower(): word.lower() for word in found if word.isascii()}
    taken, spelled = {*names}, {}
    for word in found:
        if word.lower() in names:
            continue
        name, number = (first := in_ascii(word.lower())), 0
        while name in taken:
            number += 1
            name = f"{first}{number}"
        taken.add(name)
        names[word.lower()], spelled[name] = name, word
    return re.sub(r"[^\W\d]\w*", lambda at: at[0] if at[0].isascii() else names[at[0].lower()], text), spelled


class OdeFile:
    """The statements of a file in `parts`, what stands behind @ in `settings`, and the values of each `set`."""

    def __init__(self, text: str, folder: FilePath) -> None:
        self.folder = folder
        self.settings: dict[str, Any] = {}
        self.sets: dict[str, dict[str, float]] = {}
        self.parts = Parts()
        self.boundary: list[str] = []  # what is zero at the ends of a solution of the boundary value problem
        self.exported: Line | None = None  # what a library of functions computes
        text, self.spelled = _names_in_ascii(text)  # names as the file has them
        self.has_delays = re.search(r"\b(delay|del_shft)\s*\(", text.lower()) is not None
        self.as_map: Line | None = None  # the option by which the equations are those of a map
        for line in self._lines(text):
            self._read(line)
        if self.as_map:
            self.as_map.refuse(_map)
        if self.exported and {"dll_lib", "dll_fun"} & {*self.settings}:
            self.exported.refuse("the library that the options name is not called: write what it computes as formulas")
        if len(self.parts.residuals) != len(self.parts.unknowns):
            line, _ = [*self.parts.residuals, *self.parts.unknowns.values()][0]
            line.refuse(f"there are {len(self.parts.residuals)} algebraic equations, 0=, for "
                        f"{len(self.parts.unknowns)} unknowns of solv")
        if not self.parts.equations:
            raise Error("the file has no equation: write x'=... or dx/dt=...")

    # -- Lines ---------------------------------------------------------------------------------------------------------

    def _lines(self, text: str) -> Iterator[Line]:
        """The statements: without comments, with continued lines joined and arrays written out."""
        joined: list[Line] = []
        for number, written in enumerate(text.splitlines(), 1):
            if joined and joined[-1].text.endswith("\\"):
                joined[-1].text = joined[-1].text[:-1] + written.strip()
                continue
            joined.append(Line(number, written.strip()))
        group: list[Line] | None = None
        ends = range(0)
        for line in joined:
            if line.text[:1] in ("", "#", '"'):
                continue
            if re.fullmatch(r"(?i)d\w*", line.text):  # as XPPAUT, which reads no more than the first letter of `done`
                return
            if line.text.startswith("%"):
                if group is not None:
                    for j in ends:
                        yield from (Line(g.number, self._indexed(g, g.text, j)) for g in group)
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

    def _written_out(self, line: Line) -> Iterator[Line]:
        ranges = {(int(a), int(b)) for a, b in _range.findall(line.text)}
        if not ranges:
            yield Line(line.number, self._indexed(line, line.text, None))
            return
        if len(ranges) > 1:
            line.refuse("it has several ranges")
        (first, last), = ranges
        for j in range(first, last + 1):
            yield Line(line.number, self._indexed(line, _range.sub(str(j), line.text), j))

    @staticmethod
    def _indexed(line: Line, text: str, j: int | None) -> str:
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

    def _read(self, line: Line) -> None:
        for word in re.findall(r"[A-Za-z]\w*", line.text):
            self.spelled.setdefault(word.lower(), word)
        text = line.text.lower()
        parts = self.parts
        if text.startswith("@"):
            self._settings(line)
            return
        if text.startswith("!"):
            found = _definition.fullmatch(text[1:].strip())
            if not found:
                line.refuse("a derived parameter is written !name=formula")
            self._new(line, found[1], parts.derived, (line, found[2]))
            return
        statement = _statement.fullmatch(text) or _condition.fullmatch(text)
        kind = _kind_of(statement[1]) if statement else None
        if statement and kind:
            self._statement(line, kind, statement[2].strip())
            return
        if text.split()[0] == "only":  # which says what is plotted
            return
        if text.isdigit() and not parts.equations:  # how many equations follow
            return
        if re.search(r"\bint\s*[\[{]", text):
            line.refuse(_integral)
        found = re.fullmatch(r"0\s*=(?!=)(.*)", text)
        if found:
            parts.residuals.append((line, found[1]))
            return
        if re.match(r"[a-z]\w*\s*\(\s*t\s*\+\s*1\s*\)\s*=", text):
            line.refuse(_map)
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

    def _new(self, line: Line, name: str, among: dict[str, Any], value: Any) -> None:
        parts = self.parts
        if name in words:
            line.refuse(f"`{name}` has a meaning of its own and names no quantity")
        for known in (parts.equations, parts.parameters, parts.numbers, parts.derived, parts.quantities,
                      parts.functions, parts.processes, parts.unknowns):
            if name in known:
                line.refuse(f"`{name}` is defined a second time")
        among[name] = value

    def _of_arguments(self, line: Line, name: str, arguments: str, value: str) -> None:
        if arguments.strip() == "0":
            self.parts.initial[name] = self.parts.history[name] = (line, value)
        else:
            wanted = [a.strip() for a in arguments.split(",")]
            if not all(re.fullmatch(r"[a-z]\w*", a) for a in wanted):
                line.refuse("a function is written name(x,y)=formula")
            self._new(line, name, self.parts.functions, (line, wanted, value))

    def _statement(self, line: Line, kind: str, rest: str) -> None:
        parts = self.parts
        if kind in _refused:
            line.refuse(_refused[kind])
        if kind in ("parameter", "number"):
            among = parts.parameters if kind == "parameter" else parts.numbers
            for name, value in self._pairs(line, rest):
                self._new(line, name, among, self._number(line, value))
        elif kind == "init":
            for name, value in self._pairs(line, rest):
                parts.initial[name] = (line, value)
        elif kind == "aux":
            found = re.fullmatch(r"([a-z][^\s=]*)\s*=(?!=)(.*)", rest)
            if not found:
                line.refuse("an auxiliary quantity is written aux name=formula")
            name = re.sub(r"\W+", "_", found[1]).strip("_")  # P.E. is p_e
            parts.outputs[name] = (line, found[2])
        elif kind in ("solv", "solve"):
            found = re.fullmatch(r"([a-z]\w*)\s*(?:=(?!=)(.*))?", rest)
            if not found:
                line.refuse("an unknown of algebraic equations is written solv name=guess")
            self._new(line, found[1], parts.unknowns, (line, found[2] or "0"))
        elif kind == "bdry":
            self.boundary.append(rest)
        elif kind == "export":
            self.exported = line
        elif kind == "global":
            self._global(line, rest)
        elif kind == "wiener":
            for name in re.split(r"[\s,]+", rest):
                if not re.fullmatch(r"[a-z]\w*", name):
                    line.refuse("processes are written wiener name, name")
                self._new(line, name, parts.processes, line)
        elif kind == "table":
            name, _, what = rest.partition(" ")
            self._new(line, name, parts.functions, (line, ["x"], ""))
            del parts.functions[name]
            parts.tables.append((line, name, what.strip()))
        else:
            found = re.fullmatch(r"([a-z]\w*)\s*\{(.*)\}", rest)
            if not found:
                line.refuse("a set is written set name {a=1,b=2}")
            self.sets[found[1]] = {name: float(value) for name, value in _pair.findall(found[2])
                                   if is_number(value)}

    def _pairs(self, line: Line, text: str) -> list[tuple[str, str]]:
        pairs = _pair.findall(text)
        left = _pair.sub("", text).replace(",", " ").split()
        if not all(re.fullmatch(r"[a-z]\w*", name) for name in left) or not (pairs or left):
            line.refuse("it is no list of names with values, as in a=1, b=2")
        return pairs + [(name, "0") for name in left]

    @staticmethod
    def _number(line: Line, text: str) -> float:
        if not is_number(text):
            line.refuse(f"`{text}` is no number")
        return float(text)

    def _settings(self, line: Line) -> None:
        """Options; of one that is given twice the last holds."""
        for name, value in re.findall(r"(\w+)\s*=\s*([^\s,]+)", line.text[1:]):
            self.settings[name.lower()] = float(value) if is_number(value) else value
            if name.lower().startswith("meth"):  # of methods XPPAUT reads the first letter
                self.as_map = line if value.lower().startswith("d") else None

    def _global(self, line: Line, text: str) -> None:
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
        self.parts.events.append(Global(line, int(found[1]), found[2].strip("{} "), resets))


def is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True
