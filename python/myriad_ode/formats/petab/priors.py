# SPDX-License-Identifier: MIT
"""Priors of PEtab's parameters, from its table."""

from __future__ import annotations

from typing import Any

import numpy as np

from ...inference.priors import LaplacePrior, NormalPrior, Prior, log_normal_prior
from ..sbml.math import Refused

_of_scale = {"parameterScaleNormal": "normal", "parameterScaleUniform": "uniform", "parameterScaleLaplace": "laplace",
             "logNormal": "normal", "logLaplace": "laplace"}


def unscaled(scale: str, value: float) -> float:
    return float({"lin": value, "log": np.exp(value), "log10": 10.0 ** value}[scale])


def read_prior(name: str, row: Any) -> tuple[Prior | None, tuple[float, float]]:
    """The prior of a row of the table of parameters, and the interval outside which its density is zero."""
    kind = row.get("objectivePriorType")
    everywhere = -np.inf, np.inf
    if not isinstance(kind, str) or not kind:
        return None, everywhere
    given = row.get("objectivePriorParameters")
    where = f"the table of parameters, row '{name}', column objectivePrior"
    of_logarithm = kind in ("logNormal", "logLaplace")
    scale = row["parameterScale"] if kind.startswith("parameterScale") else "log" if of_logarithm else "lin"
    known = _of_scale.get(kind, kind)
    if known not in ("laplace", "normal", "uniform"):
        raise Refused(f"{where}Type: {kind}; supported are laplace, normal, uniform, logLaplace, logNormal, "
                      "parameterScaleLaplace, parameterScaleNormal and parameterScaleUniform")
    if not isinstance(given, str) or not given:
        if kind == "parameterScaleUniform":  # the default: within the bounds
            return None, everywhere
        raise Refused(f"{where}Parameters: {kind} needs two numbers")
    first, second = (float(part) for part in given.split(";"))
    if known == "uniform":
        return None, (unscaled(scale, first), unscaled(scale, second))
    if known == "laplace":
        return LaplacePrior(scale, first, second, of_logarithm), everywhere
    if of_logarithm:
        return log_normal_prior(first, second), everywhere
    return NormalPrior(scale, first, second, float(np.log(second * np.sqrt(2 * np.pi)))), everywhere
