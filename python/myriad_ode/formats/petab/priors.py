# SPDX-License-Identifier: MIT
"""Priors of PEtab's parameters as residuals: those whose density is that of a normal distribution on some scale."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from ..sbml.math import Refused

if TYPE_CHECKING:
    from ...symbolic.types import Array

_ln10 = float(np.log(10))
_of_scale = {"parameterScaleNormal": "normal", "parameterScaleUniform": "uniform"}


@dataclass
class Prior:
    """The prior of a parameter: its negative logarithm is half the square of a residual, and a constant."""

    name: str
    scale: str  #: "lin", "log" or "log10": of what is normally distributed
    mean: float
    deviation: float
    constant: float

    def residual(self, value: Array) -> tuple[Array, Array]:
        """The residual, and its derivative by the parameter."""
        scaled, inner = scaled_by(self.scale, value)
        return (scaled - self.mean) / self.deviation, inner / self.deviation


def scaled_by(scale: str, value: Array) -> tuple[Array, Array]:
    """Values on the scale of a parameter or an observable, and the derivative of these by them."""
    if scale == "log":
        return np.log(value), 1 / value
    if scale == "log10":
        return np.log10(value), 1 / (_ln10 * value)
    return value, np.ones_like(value)


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
    scale = row["parameterScale"] if kind.startswith("parameterScale") else "log" if kind == "logNormal" else "lin"
    known = _of_scale.get(kind, "normal" if kind == "logNormal" else kind)
    if known not in ("normal", "uniform"):
        raise Refused(f"{where}Type: {kind}; supported are normal, parameterScaleNormal, logNormal, uniform and "
                      "parameterScaleUniform")
    if not isinstance(given, str) or not given:
        if kind == "parameterScaleUniform":  # the default: within the bounds
            return None, everywhere
        raise Refused(f"{where}Parameters: {kind} needs two numbers")
    first, second = (float(part) for part in given.split(";"))
    if known == "uniform":
        return None, (unscaled(scale, first), unscaled(scale, second))
    constant = float(np.log(second * np.sqrt(2 * np.pi)))
    if kind == "logNormal":  # its density has 1 / value as a factor: the square is completed
        first, constant = first - second**2, constant + first - second**2 / 2
    return Prior(name, scale, first, second, constant), everywhere
