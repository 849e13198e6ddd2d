# SPDX-License-Identifier: MIT
"""Expressions from text and from SymPy."""

from __future__ import annotations

import ast
import functools
import operator
import re
from collections.abc import Callable, Mapping
from typing import Any, NoReturn

from ..base.errors import Error, at, users_line
from . import expression as ex, functions as fn
from .delays import delayed, delayed_slope
from .symbols import symbol, time

_binary = {ast.Add: operator.add, ast.Sub: operator.sub, ast.Mult: operator.mul, ast.Div: operator.truediv,
           ast.FloorDiv: operator.floordiv, ast.Mod: operator.mod, ast.Pow: operator.pow, ast.BitAnd: operator.and_,
           ast.BitOr: operator.or_}
_compare = {ast.Lt: operator.lt, ast.LtE: operator.le, ast.Gt: operator.gt, ast.GtE: operator.ge, ast.Eq: operator.eq,
            ast.NotEq: operator.ne}
functions = {name: function for name, function in fn.by_name.items() if name not in ("sincos", "sincospi")}
functions.update(min=fn.minimum, max=fn.maximum, ln=fn.log, delayed=delayed, delayed_slope=delayed_slope)


def _shown(source: str) -> str:
    """A text for messages, cut where it is long."""
    return source if len(source) <= 100 else f"{source[:97]}..."


def parse(source: str, names: Mapping[str, Any], what: str) -> Any:
    """The expression that a text stands for; ^ is a power. `names` has the symbols, `what` says where it stands."""
    shown = _shown(source.strip())
    try:
        tree = ast.parse(source.strip().replace("^", "**"), mode="eval").body
        return _Reader(names, what).read(tree)
    except (RecursionError, MemoryError):
        raise Error(f"{what}: `{shown}` has too many operations within each other: write it in parts, as in "
                    "\"a = x + y; x' = a * z\"") from None
    except (SyntaxError, ValueError) as error:
        if isinstance(error, Error):
            raise
        raise Error(f"{what}: `{shown}` is no expression: {getattr(error, 'msg', error)}") from None


class _Reader:
    def __init__(self, names: Mapping[str, Any], what: str) -> None:
        self.names, self.what = names, what

    def fail(self, tree: ast.AST, why: str) -> NoReturn:
        raise Error(f"{self.what}: `{ast.unparse(tree)}` {why}")

    def read(self, tree: ast.expr) -> Any:
        if isinstance(tree, ast.Constant) and isinstance(tree.value, (int, float, complex)):
            return ex.constant(tree.value)
        if isinstance(tree, ast.Name):
            return self.name(tree)
        if isinstance(tree, ast.BinOp) and type(tree.op) in _binary:
            chain = []  # of the operations that come first, without recursion, as sums may have many terms
            while isinstance(tree, ast.BinOp) and type(tree.op) in _binary:
                chain.append(tree)
                tree = tree.left
            value = self.read(tree)
            for operation in reversed(chain):
                value = _binary[type(operation.op)](value, self.read(operation.right))
            return value
        if isinstance(tree, ast.UnaryOp):
            inner = self.read(tree.operand)
            if isinstance(tree.op, ast.USub):
                return ex.constant(-inner.value) if inner.op == "constant" else -inner
            return inner if isinstance(tree.op, ast.UAdd) else ~ex.as_condition(inner)
        if isinstance(tree, ast.Compare) and all(type(op) in _compare for op in tree.ops):
            sides = [self.read(t) for t in (tree.left, *tree.comparators)]
            return functools.reduce(operator.and_, (_compare[type(op)](a, b)
                                                    for op, a, b in zip(tree.ops, sides, sides[1:])))
        if isinstance(tree, ast.BoolOp):
            join = operator.and_ if isinstance(tree.op, ast.And) else operator.or_
            return functools.reduce(join, (ex.as_condition(self.read(t)) for t in tree.values))
        if isinstance(tree, ast.IfExp):
            return fn.where(self.read(tree.test), self.read(tree.body), self.read(tree.orelse))
        if isinstance(tree, ast.Call) and isinstance(tree.func, ast.Name) and not tree.keywords:
            function = functions.get(tree.func.id)
            if function is None:
                self.fail(tree, f"calls {tree.func.id}, which is no function of myriad: there are "
                                f"{', '.join(sorted(functions))}")
            try:
                return function(*map(self.read, tree.args))
            except TypeError:
                self.fail(tree, f"has {len(tree.args)} arguments, another number than {tree.func.id} takes")
        self.fail(tree, "is not understood: use numbers, names, operators and functions of myriad")

    def name(self, tree: ast.Name) -> Any:
        if tree.id in self.names:
            return self.names[tree.id]
        if tree.id == "pi":
            return ex.constant(fn.pi)
        if tree.id in ("True", "False"):
            return ex.constant(tree.id == "True")
        raise Error(f"{self.what}: '{tree.id}' is unknown: name it in parameters=\"...\" or shared=\"...\"")


def parse_equations(source: str, names: dict[str, Any], where: str) -> dict[Any, Any]:
    """{state: derivative} from lines or parts between semicolons: "x' = v" or "dx/dt = v", and "a = x + v" for what
    later lines use. States are those with an equation; the symbols are added to `names`."""
    lines = [part.strip() for line in source.splitlines() for part in line.partition("#")[0].split(";")]
    lines = [line for line in lines if line]
    derivative = re.compile(r"(?:([^\W\d]\w*)\s*'|d([^\W\d]\w*)\s*/\s*dt)\s*=(?!=)\s*(.+)")
    definition = re.compile(r"([^\W\d]\w*)\s*=(?!=)\s*(.+)")
    for line in lines:
        match = derivative.fullmatch(line)
        if match:
            name = match[1] or match[2]
            names.setdefault(name, None)
            names[name] = names[name] if names[name] is not None else symbol("state", name)
    equations, known = {}, dict(names)
    for line in lines:
        what = f"equation `{_shown(line)}`{where}"
        match = derivative.fullmatch(line)
        if match:
            state = names[match[1] or match[2]]
            if state in equations:
                raise Error(f"{what}: {state.value[1]} has an equation already")
            equations[state] = parse(match[3], known, what)
            continue
        match = definition.fullmatch(line)
        if not match:
            raise Error(f"{what} is none: write \"x' = v\" for a state, \"a = x + v\" for what later lines use")
        if match[1] in known:
            raise Error(f"{what}: '{match[1]}' has a meaning already: a state's equation is \"{match[1]}' = ...\"")
        known[match[1]] = parse(match[2], known, what)
    if not equations:
        raise Error(f"`{source.strip()[:60]}`{where} has no equation of a state: write \"x' = v\"")
    return equations


# ----------------------------------------------------------------------------------------------------------------------
# SymPy
# ----------------------------------------------------------------------------------------------------------------------


def sympy_name(key: Any) -> str:
    """The name of a symbol, of a function of time such as x(t), or of what a first derivative is of."""
    import sympy

    if isinstance(key, sympy.Derivative):
        if key.derivative_count != 1:
            raise Error(f"`{key}` is a derivative of order {key.derivative_count}{at(users_line())}: make the first "
                        "derivative a state of its own, as in {x: v, v: ...}")
        key = key.expr
    if not isinstance(key, (sympy.Symbol, sympy.core.function.AppliedUndef)):
        raise Error(f"`{key}`{at(users_line())} is no name: use a symbol x, a function x(t), or its first derivative")
    return str(key.func if key.args else key)


def from_sympy(value: Any, names: Mapping[str, Any], what: str) -> Any:
    """The expression of a SymPy expression. Its symbols, and functions of time such as x(t), are found by name."""
    return _SympyReader(value, names, what).read(value)


_of_sympy = {"Abs": "abs", "floor": "floor", "Min": "minimum", "Max": "maximum", "ceiling": "ceil", "sqrt": "sqrt",
             "atan2": "atan2", "cbrt": "cbrt", "ln": "log",
             **{n: n for n in ("sin", "cos", "tan", "asin", "acos", "atan", "sinh", "cosh", "tanh", "exp", "log")}}


class _SympyReader:
    def __init__(self, whole: Any, names: Mapping[str, Any], what: str) -> None:
        import sympy

        self.sympy, self.whole, self.names, self.what = sympy, whole, names, what
        self.relations: dict[type, Callable[[Any, Any], Any]] = {
            sympy.StrictLessThan: operator.lt, sympy.LessThan: operator.le, sympy.StrictGreaterThan: operator.gt,
            sympy.GreaterThan: operator.ge, sympy.Equality: operator.eq, sympy.Unequality: operator.ne}
        self.read = functools.cache(self._read)

    def _read(self, e: Any) -> Any:
        sympy = self.sympy
        if isinstance(e, sympy.core.function.AppliedUndef) and not all(a.is_Symbol for a in e.args):
            return self._past(e)
        if isinstance(e, (sympy.Symbol, sympy.core.function.AppliedUndef)):
            return self._symbol(sympy_name(e))
        if isinstance(e, sympy.Derivative):
            raise Error(f"{self.what}: `{e}` is a derivative within an expression: write what it is equal to")
        if e.is_number or e in (sympy.true, sympy.false):
            return self._constant(e)
        for kind, read in ((sympy.Mul, self._product), (sympy.Add, self._sum), (sympy.Pow, self._power),
                           (sympy.Piecewise, self._pieces), (sympy.Heaviside, self._step)):
            if isinstance(e, kind):
                return read(e)
        if isinstance(e, sympy.Mod):
            return self.read(e.args[0]) % self.read(e.args[1])
        if type(e) in self.relations:
            return self.relations[type(e)](self.read(e.lhs), self.read(e.rhs))
        if isinstance(e, (sympy.And, sympy.Or)):
            join = operator.and_ if isinstance(e, sympy.And) else operator.or_
            return functools.reduce(join, map(self.read, sorted(e.args, key=sympy.default_sort_key)))
        if isinstance(e, sympy.Not):
            return ~self.read(e.args[0])
        name = _of_sympy.get(type(e).__name__)
        if name is None:
            raise Error(f"{self.what}: `{e}` has no counterpart in myriad: rewrite it with its functions, as by "
                        "expression.rewrite(...)")
        return fn.by_name[name](*map(self.read, e.args))

    def _past(self, e: Any) -> Any:
        """The delayed value that x(t - tau) is."""
        when = next((s for s in e.args[0].free_symbols if self.names.get(str(s)) is time), None)
        if len(e.args) > 1 or when is None:
            raise Error(f"{self.what}: `{e}` is no value of the past: write x(t - tau), with the time t")
        return delayed(self._symbol(sympy_name(e)), self.read(self.sympy.expand(when - e.args[0])))

    def _symbol(self, name: str) -> Any:
        if name not in self.names:
            raise Error(f"{self.what}: '{name}' of `{self.whole}` is unknown: name it in parameters=\"...\" or "
                        "shared=\"...\"")
        return self.names[name]

    def _constant(self, e: Any) -> Any:
        sympy = self.sympy
        if isinstance(e, sympy.Integer):
            return ex.constant(int(e))
        if e in (sympy.true, sympy.false):
            return ex.constant(bool(e))
        if e.is_real is not False and not e.has(sympy.oo, sympy.nan, sympy.zoo):
            return ex.constant(float(e))
        raise Error(f"{self.what}: `{e}` is no finite real number")

    def _product(self, e: Any) -> Any:
        above, below = [], []
        for factor in e.as_ordered_factors():
            if isinstance(factor, self.sympy.Pow) and factor.exp.is_Rational and factor.exp < 0:
                below.append(self.read(1 / factor))
            elif isinstance(factor, self.sympy.Rational) and not factor.is_Integer and factor.p in (1, -1):
                below.append(ex.constant(int(factor.q)))
                if factor.p < 0:
                    above.append(ex.constant(-1))
            else:
                above.append(self.read(factor))
        negative = bool(above) and above[0].op == "constant" and above[0].value == -1
        above = above[1:] if negative else above
        product = functools.reduce(operator.mul, above) if above else ex.constant(1)
        product = -product if negative else product
        return product / functools.reduce(operator.mul, below) if below else product

    def _sum(self, e: Any) -> Any:
        first, *terms = e.as_ordered_terms()
        total = self.read(first)
        for term in terms:
            is_negative = term.could_extract_minus_sign()
            total = total - self.read(-term) if is_negative else total + self.read(term)
        return total

    def _power(self, e: Any) -> Any:
        if e.exp == self.sympy.Rational(1, 2):
            return fn.sqrt(self.read(e.base))
        return self.read(e.base) ** self.read(e.exp)

    def _pieces(self, e: Any) -> Any:
        value, condition = e.args[-1]
        if condition != self.sympy.true:
            raise Error(f"{self.what}: `{e}` has no value where none of its conditions holds: end it with "
                        "(value, True)")
        chosen = self.read(value)
        for value, condition in reversed(e.args[:-1]):
            chosen = fn.where(self.read(condition), self.read(value), chosen)
        return chosen

    def _step(self, e: Any) -> Any:
        x = self.read(e.args[0])
        return fn.where(x > 0, 1.0, fn.where(x < 0, 0.0, self.read(e.args[1])))
