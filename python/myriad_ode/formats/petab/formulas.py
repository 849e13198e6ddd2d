# SPDX-License-Identifier: MIT
"""Formulas of PEtab's tables as those of SBML."""

from __future__ import annotations

import re
from typing import Any

from ..sbml.document import library
from ..sbml.math import Refused


def parsed(text: str, model: Any, where: str) -> Any:
    """A formula as SBML's tree. Names of the model come before those that SBML's formulas know, as pi, which are told
    from them by their case."""
    if _has_base(text):
        from petab.v1.math import sympify_petab
        text = written(sympify_petab(text))
    libsbml = library()
    settings = libsbml.L3ParserSettings()
    settings.setParseLog(libsbml.L3P_PARSE_LOG_AS_LN)  # as PEtab means it
    settings.setModel(model)
    settings.setComparisonCaseSensitivity(libsbml.L3P_COMPARE_BUILTINS_CASE_SENSITIVE)
    tree = libsbml.parseL3FormulaWithSettings(text, settings)
    if tree is None:
        raise Refused(f"{where} is {text}: {' '.join(libsbml.getLastParseL3Error().split())}")
    return tree


def _has_base(text: str) -> bool:
    """Whether a formula has log(x, base), whose arguments have the other order in SBML's formulas."""
    for found in re.finditer(r"\blog\s*\(", text):
        depth = 1
        for letter in text[found.end():]:
            depth += (letter == "(") - (letter == ")")
            if depth == 0:
                break
            if letter == "," and depth == 1:
                return True
    return False


def written(expression: Any) -> str:
    """An expression of SymPy's, as the library of PEtab reads formulas, as a text."""
    import sympy
    from petab.v1.math import petab_math_str
    expression = expression.replace(sympy.sign, lambda x: sympy.Piecewise((1, x > 0), (-1, x < 0), (0, True)))
    # petab_math_str writes x^(1/2) as x ^ 1/2
    fractions = {r: sympy.Float(r, 17) for r in expression.atoms(sympy.Rational) if not r.is_Integer}
    text = str(petab_math_str(expression.xreplace(fractions)))
    return re.sub(r"([&|])\1?", r"\1\1", text)
