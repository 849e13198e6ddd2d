# SPDX-License-Identifier: MIT
"""Formulas of XPPAUT as expressions of a model, with constants folded."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from typing import Any, NoReturn

from ...base.errors import Error
from ...symbolic import expression as ex, functions as fn
from ...symbolic.delays import delayed
from ...symbolic.folding import (add, apply, both, choose, compare, constant, divide, either, is_constant, make_folded,
                                 multiply, number, opposite, power, subtract, total, truth, value_of)

_tokens = re.compile(r"\s*((?:\d+\.?\d*|\.\d+)(?:e[+-]?\d+)?|[a-z_][a-z0-9_]*'?|\*\*|[<>=!]=|[-+*/^<>&|(),~{}\[\]])")

# Of two arguments, by how closely they bind; those of one strength from the left. Comparisons bind as closely as
# powers: a > b + 1 is (a > b) + 1.
_strength = {"+": 4, "-": 4, "|": 4, "*": 6, "/": 6, "&": 6, "^": 7, "**": 7,
             ">": 7, "<": 7, "==": 7, ">=": 7, "<=": 7, "!=": 7}
_prefix = 6  # of -x and not x
_comparisons = {">": "greater", "<": "less", "==": "equal", ">=": "greater_equal", "<=": "less_equal",
                "!=": "not_equal"}


def _modulo(x: Any, y: Any) -> Any:
    rest = apply(fn.fmod, x, y)
    return choose(compare("less", rest, constant(0.0)), add(rest, y), rest)


def _sign(x: Any) -> Any:
    zero = constant(0.0)
    return choose(compare("greater", x, zero), constant(1.0), choose(compare("less", x, zero), constant(-1.0), zero))


def _applied(function: Callable[..., Any]) -> Callable[..., Any]:
    return lambda *arguments: apply(function, *arguments)


_functions: dict[str, tuple[int, Callable[..., Any]]] = {
    **{name: (1, _applied(fn.by_name[name])) for name in (
        "sin", "cos", "tan", "asin", "acos", "atan", "sinh", "cosh", "tanh", "abs", "exp", "log", "log10", "sqrt",
        "ceil")},
    "ln": (1, _applied(fn.log)), "flr": (1, _applied(ex.floor)), "atan2": (2, _applied(fn.atan2)),
    "max": (2, lambda x, y: make_folded("max", x, y)), "min": (2, lambda x, y: make_folded("min", x, y)),
    "mod": (2, _modulo), "sign": (1, _sign), "not": (1, lambda x: opposite(truth(x))),
    "heav": (1, lambda x: choose(compare("less", x, constant(0.0)), constant(0.0), constant(1.0))),
}
words = frozenset([*_functions, "if", "then", "else", "sum", "of", "pi", "t", "shift"])  #: that no quantity can be
_beyond = {"int": "integrals over the past", "ran": "random numbers",
           "normal": "random numbers", "poisson": "random numbers", "hom_bcs": "boundary conditions"}


class NoFormula(Exception):
    """Why a text is no formula that is supported."""


class Names:
    """What formulas may name: expressions, functions {name: (arguments, formula)}, tables as functions of one
    expression, and in their order the states and the quantities, for `shift`."""

    def __init__(self) -> None:
        self.values: dict[str, Any] = {}
        self.functions: dict[str, tuple[list[str], str]] = {}
        self.tables: dict[str, Callable[[Any], Any]] = {}
        self.series: list[list[str]] = []
        self.later: dict[str, Callable[[], Any]] = {}  # expressions that are made when they are looked for
        self._under_way: list[str] = []

    def find(self, name: str) -> Any:
        """The expression of a name, or None."""
        if name in self._under_way:
            raise NoFormula(f"`{name}` depends on itself")
        if name in self.later:
            self._under_way.append(name)
            self.values[name] = self.later[name]()
            self._under_way.pop()
            del self.later[name]
        return self.values.get(name)


def formula(text: str, names: Names, bound: Mapping[str, Any] | None = None) -> Any:
    """The expression of a formula in small letters, a number; `bound` has the arguments of a function."""
    return number(_Reader(text, names, bound or {}, {}, ()).whole())


class _Reader:
    """`calls` has the values of functions by name and arguments, `calling` the functions that are under way."""

    def __init__(self, text: str, names: Names, bound: Mapping[str, Any], calls: dict[Any, tuple[Any, Any]],
                 calling: tuple[str, ...]) -> None:
        self.text, self.names, self.bound, self.calls, self.calling = text, names, bound, calls, calling
        self.tokens, place = [], 0
        while text[place:].strip():
            found = _tokens.match(text, place)
            if not found:
                raise NoFormula(f"`{text[place:].strip()[0]}` is not understood")
            self.tokens.append(found[1])
            place = found.end()
        self.at = 0

    def next(self) -> str:
        return self.tokens[self.at] if self.at < len(self.tokens) else ""

    def take(self) -> str:
        self.at += 1
        return self.tokens[self.at - 1] if self.at <= len(self.tokens) else ""

    def expect(self, token: str) -> None:
        got = self.take()
        if got != token:
            raise NoFormula(f"`{got or 'its end'}` stands where `{token}` is expected")

    def whole(self) -> Any:
        value = self.expression(0)
        if self.next():
            raise NoFormula(f"`{self.next()}` stands where an operator is expected")
        return value

    def expression(self, least: int) -> Any:
        """Operations that bind more closely than `least`."""
        token = self.take()
        if token in ("-", "~"):
            left = make_folded("negate", self.expression(_prefix))
        elif token == "+":
            left = self.expression(_prefix)
        else:
            left = self.operand(token)
        while _strength.get(self.next(), 0) > least:
            operator = self.take()
            left = self.operation(operator, left, self.expression(_strength[operator]))
        return left

    @staticmethod
    def operation(operator: str, a: Any, b: Any) -> Any:
        if operator in _comparisons:
            return compare(_comparisons[operator], a, b)
        if operator in "&|":
            return (both if operator == "&" else either)(truth(a), truth(b))
        a, b = number(a), number(b)
        return {"+": add, "-": subtract, "*": multiply, "/": divide}.get(operator, power)(a, b)

    def operand(self, token: str) -> Any:
        if token == "(":
            value = self.expression(0)
            self.expect(")")
            return value
        if token[:1].isdigit() or token[:1] == ".":
            return constant(float(token))
        if token == "if":
            return self.choice()
        if token == "sum":
            return self.sum()
        if token in self.bound:
            return self.bound[token]
        if (found := self.names.find(token)) is not None:
            return found
        if self.next() in ("(", "{", "["):
            return self.call(token)
        if token == "":
            raise NoFormula("it ends where a value is expected")
        raise NoFormula(f"`{token}` is unknown here")

    def within(self) -> Any:
        self.expect("(")
        value = self.expression(0)
        self.expect(")")
        return value

    def choice(self) -> Any:
        condition = truth(self.within())
        self.expect("then")
        first = self.within()
        self.expect("else")
        return choose(condition, number(first), number(self.within()))

    def arguments(self) -> list[Any]:
        self.expect("(")
        values = [number(self.expression(0))]
        while self.next() == ",":
            self.take()
            values.append(number(self.expression(0)))
        self.expect(")")
        return values

    def call(self, name: str) -> Any:
        if name in _beyond:
            raise NoFormula(f"`{name}`: {_beyond[name]} are not supported")
        if name == "shift":
            return self.shift()
        if name == "delay":
            given = self.arguments()
            self.check(name, given, 2)
            return self.past(*given)
        if name == "del_shft":
            return self.past(*self.shift(and_delayed=True))
        if name in self.names.tables:
            return self.names.tables[name](self.within())
        if name in self.names.functions:
            wanted, body = self.names.functions[name]
            given = self.arguments()
            self.check(name, given, len(wanted))
            if name in self.calling:
                raise NoFormula(f"the function `{name}` calls itself")
            # of functions that call others twice, each is written out once for the same arguments, which are kept alive
            key = (name, *map(id, given))
            if key not in self.calls:
                reader = _Reader(body, self.names, dict(zip(wanted, given)), self.calls, (*self.calling, name))
                self.calls[key] = number(reader.whole()), given
            return self.calls[key][0]
        if name not in _functions:
            raise NoFormula(f"the function `{name}` is unknown")
        count, function = _functions[name]
        given = self.arguments()
        self.check(name, given, count)
        return function(*given)

    @staticmethod
    def check(name: str, given: list[Any], count: int) -> None:
        if len(given) != count:
            raise NoFormula(f"`{name}` has {len(given)} arguments instead of {count}")

    def whole_number(self, value: Any, what: str) -> int:
        if not is_constant(value) or not float(value_of(value)).is_integer():
            raise NoFormula(f"{what} is no whole number that is known beforehand")
        return int(value_of(value))

    @staticmethod
    def past(value: Any, lag: Any) -> Any:
        """delay(x, tau); where the lag is zero, x itself."""
        if is_constant(value) or is_constant(lag) and value_of(lag) == 0:
            return value
        try:
            return delayed(value, lag)
        except Error as why:
            raise NoFormula(str(why)) from None

    def shift(self, and_delayed: bool = False) -> Any:
        """shift(x, n): the n-th state or quantity after x. That and the lag in del_shft(x, n, tau)."""
        self.expect("(")
        name = self.take()
        self.expect(",")
        by = self.whole_number(self.expression(0), "the second argument of `shift`")
        lag = None
        if and_delayed:
            self.expect(",")
            lag = number(self.expression(0))
        self.expect(")")
        series = next((one for one in self.names.series if name in one), None)
        if series is None:
            raise NoFormula(f"`shift` of `{name}`, which is no state and no quantity")
        place = series.index(name) + by
        if not 0 <= place < len(series):
            raise NoFormula(f"nothing is {by} after `{name}`")
        found = self.names.find(series[place])
        return (found, lag) if and_delayed else found

    def sum(self) -> Any:
        """sum(low, high) of (expression of i')."""
        ends = self.arguments()
        self.check("sum", ends, 2)
        low, high = (self.whole_number(e, "an end of `sum`") for e in ends)
        self.expect("of")
        begin, terms = self.at, []
        outer = self.bound
        if not 0 < high - low + 1 <= 10000:
            self.fail_of_sum(low, high)
        for i in range(low, high + 1):
            self.at, self.bound = begin, {**outer, "i'": constant(i)}
            terms.append(number(self.within()))
        self.bound = outer
        return total(terms)

    @staticmethod
    def fail_of_sum(low: int, high: int) -> NoReturn:
        raise NoFormula(f"`sum` goes from {low} to {high}")
