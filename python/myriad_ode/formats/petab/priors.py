# SPDX-License-Identifier: MIT
"""Priors of PEtab's parameters, from its table."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from ...inference import priors
from ...inference.priors import LaplacePrior, NormalPrior, Prior, ScaledPrior, UniformPrior, log_normal_prior
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


_of_version_2: dict[str, Callable[..., Prior]] = {
    "normal": priors.normal, "laplace": priors.laplace, "cauchy": priors.cauchy, "gamma": priors.gamma,
    "exponential": priors.exponential, "chisquare": priors.chi_squared, "rayleigh": priors.rayleigh,
    "log-normal": log_normal_prior, "log-uniform": priors.log_uniform,
    "log-laplace": lambda location, width: LaplacePrior("log", location, width, True)}
_beyond = 1e-9  # the part of a prior that is left out on a side with an infinite bound


def read_prior_2(parameter: Any) -> tuple[Prior, tuple[float, float]]:
    """The prior of an estimated parameter of version 2, and the interval outside which its density is zero. A parameter
    without a prior has a uniform one between its bounds; bounds cut off any other. A quantile of the prior takes the
    place of an infinite bound, as fits need finite ones."""
    kind = str(getattr(parameter.prior_distribution, "value", parameter.prior_distribution or "uniform"))
    bounds = float(parameter.lb), float(parameter.ub)
    given = [float(v) for v in parameter.prior_parameters or bounds]
    where = f"the table of parameters, row '{parameter.id}', column priorDistribution"
    nothing_left = "the prior is zero between the bounds"
    if kind == "uniform":
        least, most = max(given[0], bounds[0]), min(given[1], bounds[1])
        if least > most:
            raise Refused(f"{where}: {nothing_left}")
        return UniformPrior(float(np.log(most - least)) if most - least < np.inf else 0.0), (least, most)
    if kind not in _of_version_2:
        raise Refused(f"{where}: {kind}; supported are {', '.join(['uniform', *_of_version_2])}")
    prior = _of_version_2[kind](*given)  # whose parameters petab has checked
    with np.errstate(all="ignore"):
        whole = parameter.model_copy(update={"lb": -np.inf, "ub": np.inf}).prior_dist
        within = float(whole.cdf(bounds[1]) - whole.cdf(bounds[0]))
    if not within > 0:
        raise Refused(f"{where}: {nothing_left}")
    support = given if kind == "log-uniform" else (float(whole.ppf(0)), float(whole.ppf(1)))
    least, most = (end if np.isfinite(end) else float(whole.ppf(abs(side - _beyond)))
                   for side, end in enumerate(bounds))
    return ScaledPrior(prior, float(np.log(within))), (max(least, support[0]), min(most, support[1]))
