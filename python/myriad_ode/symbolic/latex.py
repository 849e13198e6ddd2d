# SPDX-License-Identifier: MIT
"""Expressions and names as LaTeX."""

from __future__ import annotations

import collections
import math
import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import NamedTuple

from .node import Node, number_text, walk

_greek = set("""alpha beta gamma delta epsilon zeta eta theta iota kappa lambda mu nu xi pi rho sigma tau upsilon phi
chi psi omega Gamma Delta Theta Lambda Xi Pi Sigma Upsilon Phi Psi Omega""".split())
# How tightly a text binds: its terms, its factors, a power's base, and what needs no parentheses anywhere.
_or, _and, _comparison, _sum, _product, _power, _atom = range(7)
_comparisons = {"less": "<", "less_equal": r"\le", "greater": ">", "greater_equal": r"\ge", "equal": "=",
                "not_equal": r"\ne"}
# Functions that are written as they are called; {} are the arguments.
_functions = {
    "abs": r"\left|{}\right|", "floor": r"\left\lfloor {} \right\rfloor", "sqrt": r"\sqrt{{{}}}",
    "cbrt": r"\sqrt[3]{{{}}}", "rsqrt": r"\frac{{1}}{{\sqrt{{{}}}}}", "reciprocal": r"\frac{{1}}{{{}}}",
    "divide": r"\frac{{{}}}{{{}}}", "floor_divide": r"\left\lfloor \frac{{{}}}{{{}}} \right\rfloor",
    "quotient": r"\left\lfloor \frac{{{}}}{{{}}} \right\rfloor", "hypot": r"\left\|\left({}, {}\right)\right\|",
    "sinpi": r"\sin\left(\pi \left({}\right)\right)", "cospi": r"\cos\left(\pi \left({}\right)\right)",
    "sincos.sine": r"\sin\left({}\right)", "sincos.cosine": r"\cos\left({}\right)",
    "sincospi.sine": r"\sin\left(\pi \left({}\right)\right)",
    "sincospi.cosine": r"\cos\left(\pi \left({}\right)\right)", "log": r"\ln\left({}\right)",
    "log1p": r"\ln\left(1 + {}\right)", "log2": r"\log_{{2}}\left({}\right)", "log10": r"\log_{{10}}\left({}\right)",
    "asin": r"\arcsin\left({}\right)", "acos": r"\arccos\left({}\right)", "atan": r"\arctan\left({}\right)",
    "rint": r"\operatorname{{round}}\left({}\right)", "not": r"\lnot \left({}\right)",
    "is_finite": r"\left|{}\right| < \infty", "select": r"\begin{{cases}} {1} & \text{{if }} {0} \\ {2} & "
    r"\text{{otherwise}} \end{{cases}}", "uniform": r"\mathcal{{U}}\left({}, {}\right)",
    "normal": r"\mathcal{{N}}\left({}, \left({}\right)^{{2}}\right)",
    **{name: rf"\{name}\left({{}}\right)" for name in ("sin", "cos", "tan", "sinh", "cosh", "tanh")},
    **{name: rf"\{name}\left({{}}, {{}}\right)" for name in ("min", "max")}}
# Those that are fractions or comparisons stand in parentheses where something binds tighter.
_binds = {"divide": _power, "reciprocal": _power, "rsqrt": _power, "is_finite": _comparison, "select": _sum}
_most_operations = 400  # of an expression that is written without names for its parts
_named_from = 3  # operations of a part


class Latex(NamedTuple):
    """A text and how tightly it binds."""

    text: str
    binds: int

    def within(self, least: int) -> str:
        """The text where something binds it: in parentheses, if it binds less."""
        return self.text if self.binds >= least else rf"\left({self.text}\right)"


def name_latex(name: str) -> str:
    r"""A name: Greek letters by their names, what follows an underscore, and digits at the end, as subscripts: x_1 and
    x1 are x_{1}, k_on is k_{\mathrm{on}}."""
    first, *rest = [part for part in name.split("_") if part] or [name]
    digits = re.fullmatch(r"(.*\D)(\d+)", first)
    if digits is not None:
        first, rest = digits[1], [digits[2], *rest]
    return _word(first) + (f"_{{{','.join(map(_word, rest))}}}" if rest else "")


def _word(part: str) -> str:
    if part in _greek:
        return f"\\{part}"
    is_letter = len(part) == 1 and part.isascii() and part.isalpha()
    return part if is_letter or part.isdigit() else rf"\mathrm{{{plain(part)}}}"


def plain(text: str) -> str:
    """Any text within LaTeX, with nothing that has a meaning there."""
    special = {"\\": r"\backslash ", "^": r"\hat{}", "~": r"\tilde{}"}
    return "".join(special.get(c, f"\\{c}" if c in "{}_$&#%" else c) for c in text)


def names_latex(names: Iterable[str], taken: Iterable[str] = ()) -> dict[str, str]:
    """Different names as different texts: those that would look like others, or like what is taken, are written letter
    by letter."""
    made: dict[str, str] = {}
    others = set(taken)
    for name in dict.fromkeys(names):
        wanted = name_latex(name)
        made[name] = wanted if wanted not in others else rf"\mathrm{{{plain(name)}}}"
        others.add(made[name])
    return made


def expressions_latex(roots: Sequence[Node], symbol: Callable[[Node], str], part: str
                      ) -> tuple[list[Latex], dict[str, str]]:
    """Expressions, of which `symbol` writes symbols. Parts that a long expression needs several times get names, `part`
    with a number, and are told by these."""
    nodes = walk(roots)
    uses = collections.Counter(id(argument) for node in nodes for argument in node.args)
    by_id = {id(node): node for node in nodes}
    size = _sizes(nodes, {})
    is_long = any(size[id(root)] > _most_operations for root in roots)
    of_products: dict[int, dict[int, int]] = {}
    size = {}
    made: dict[int, Latex] = {}
    parts: dict[str, str] = {}
    for node in nodes:
        size[id(node)] = _size(node, size, of_products)
        if node.op == "multiply":
            written = _product_latex([(by_id[i], made[i], n) for i, n in of_products[id(node)].items()])
        elif node.op == "symbol":
            written = Latex(symbol(node), _atom)
        else:
            written = _written(node, [made[id(a)] for a in node.args])
        if is_long and uses[id(node)] > 1 and size[id(node)] > _named_from:
            parts[f"{part}_{{{len(parts) + 1}}}"] = written.text
            written = Latex(next(reversed(parts)), _atom)
            of_products.pop(id(node), None)
            size[id(node)] = 1
        made[id(node)] = written
    return [made[id(root)] for root in roots], parts


def _sizes(nodes: Iterable[Node], of_products: dict[int, dict[int, int]]) -> dict[int, int]:
    size: dict[int, int] = {}
    for node in nodes:
        size[id(node)] = _size(node, size, of_products)
    return size


def _size(node: Node, size: Mapping[int, int], of_products: dict[int, dict[int, int]]) -> int:
    """How many operations are written for a node; of a product, which also gets its factors."""
    arguments = [id(a) for a in node.args]
    if node.op == "multiply":
        of_products[id(node)] = _factors(node, of_products)
        arguments = list(of_products[id(node)])
    return 1 + sum(size[argument] for argument in arguments)


def _factors(node: Node, of_products: Mapping[int, dict[int, int]]) -> dict[int, int]:
    counts: dict[int, int] = {}
    for argument in node.args:
        for factor, n in of_products.get(id(argument), {id(argument): 1}).items():
            counts[factor] = counts.get(factor, 0) + n
    return counts


def _product_latex(factors: Sequence[tuple[Node, Latex, int]]) -> Latex:
    """Numbers come first, and a factor that occurs several times is a power."""
    texts: list[str] = []
    for _, written, count in sorted(factors, key=lambda factor: factor[0].op != "constant"):
        if count > 1:
            text = f"{written.within(_atom)}^{{{count}}}"
        else:
            text = written.within(_product)
            if text.startswith("-") and texts:
                text = rf"\left({text}\right)"
        texts.append(rf"\cdot {text}" if texts and text[0].isdigit() else text)
    return Latex(r" \, ".join(texts).replace(r"\, \cdot", r"\cdot"), _product)


def _number(node: Node) -> Latex:
    value = node.value
    if node.op == "truth":
        return Latex(rf"\mathrm{{{str(value).lower()}}}", _atom)
    if math.isinf(value):
        return Latex(r"\infty" if value > 0 else r"-\infty", _atom if value > 0 else _product)
    if value == math.pi:
        return Latex(r"\pi", _atom)
    mantissa, e, exponent = number_text(value).partition("e")
    if e:
        power = f"10^{{{int(exponent)}}}"
        return Latex({"1": power, "-1": f"-{power}"}.get(mantissa, rf"{mantissa} \cdot {power}"), _product)
    return Latex(mantissa, _product if mantissa.startswith("-") else _atom)


def _written(node: Node, arguments: Sequence[Latex]) -> Latex:
    op = node.op
    if op in ("constant", "truth"):
        return _number(node)
    if op in ("element", "dot", "lookup", "find_interval"):
        return _of_table(node, arguments)
    if op in ("add", "subtract", "fma"):
        if op == "fma":
            first, second, last = arguments
            arguments = [Latex(rf"{first.within(_product)} \, {second.within(_product)}", _product), last]
        return _sum_latex(arguments[0], arguments[1], op == "subtract")
    if op == "negate":
        inner = arguments[0].within(_product)
        return Latex(f"-{inner}" if not inner.startswith("-") else rf"-\left({inner}\right)", _product)
    if op in ("pow", "powr"):
        return Latex(f"{arguments[0].within(_atom)}^{{{arguments[1].text}}}", _power)
    if op in ("exp", "exp2"):
        return Latex(f"{'e' if op == 'exp' else '2'}^{{{arguments[0].text}}}", _power)
    if op == "expm1":
        return Latex(f"e^{{{arguments[0].text}}} - 1", _sum)
    if op in ("floor_mod", "remainder", "fmod"):
        return Latex(rf"{arguments[0].within(_power)} \bmod {arguments[1].within(_power)}", _product)
    if op in _comparisons:
        left, right = (a.within(_sum) for a in arguments)
        return Latex(f"{left} {_comparisons[op]} {right}", _comparison)
    if op in ("and", "or"):
        binds = _and if op == "and" else _or
        sign = r"\land" if op == "and" else r"\lor"
        # && within || in parentheses too
        left, right = (a.within(_comparison if op == "or" and a.binds == _and else binds) for a in arguments)
        return Latex(f"{left} {sign} {right}", binds)
    if op in _functions:
        return Latex(_functions[op].format(*(a.text for a in arguments)), _binds.get(op, _atom))
    return Latex(rf"\operatorname{{{plain(op)}}}\left({', '.join(a.text for a in arguments)}\right)", _atom)


def _sum_latex(left: Latex, right: Latex, is_difference: bool) -> Latex:
    text = right.within(_product if is_difference else _sum)
    if text.startswith("-"):
        sign, text = (" - ", rf"\left({text}\right)") if is_difference else (" - ", text[1:])
    else:
        sign = " - " if is_difference else " + "
    return Latex(f"{left.within(_sum)}{sign}{text}", _sum)


def difference_latex(left: str, right: Latex) -> str:
    """What is left of a name."""
    return _sum_latex(Latex(left, _atom), right, True).text


def _of_table(node: Node, arguments: Sequence[Latex]) -> Latex:
    table = node.value[0]
    name = rf"\mathrm{{{plain(table.name)}}}"
    if node.op == "element":
        indices = table.element_name(node.value[1]).partition("[")[2].rstrip("]")
        return Latex(f"{name}_{{{indices}}}", _atom)
    if node.op == "dot":
        entries = ", ".join(a.text for a in arguments)
        return Latex(rf"{name}_{{{node.value[1]}}} \cdot \left({entries}\right)", _product)
    if node.op == "find_interval":
        return Latex(rf"\operatorname{{interval}}_{{{name}}}\left({arguments[0].text}\right)", _atom)
    first, stride, _ = node.value[1:]
    row = arguments[0].within(_product)
    return Latex(rf"{name}_{{{first} + {stride} \, {row}}}" if stride > 1 else f"{name}_{{{first} + {row}}}", _atom)
