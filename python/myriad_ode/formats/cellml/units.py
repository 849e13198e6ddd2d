# SPDX-License-Identifier: MIT
"""Units of CellML as texts for the labels of results."""

from __future__ import annotations

from typing import Any

from ..unit_text import Factor, text_of

_prefixes = {"yotta": 24, "zetta": 21, "exa": 18, "peta": 15, "tera": 12, "giga": 9, "mega": 6, "kilo": 3, "hecto": 2,
             "deca": 1, "deci": -1, "centi": -2, "milli": -3, "micro": -6, "nano": -9, "pico": -12, "femto": -15,
             "atto": -18, "zepto": -21, "yocto": -24}
_most = 100  #: units in one, and units in each other


def text(units: Any) -> str:
    """Units as "mV/ms"; empty where they have no dimension, or are not known."""
    if units is None:
        return ""
    return text_of(_factors(units, 0))


def _factors(units: Any, depth: int) -> list[Factor]:
    """The factors of units, with those of the units that they are made of in their place."""
    count = units.unitCount()
    if count == 0 or depth > _most:
        return [Factor(units.name(), 0, 1.0, 1.0)]  # of the standard, or a unit of the file's own
    model, found = units.parent(), list[Factor]()
    for i in range(count):
        name, prefix, exponent, multiplier, _ = units.unitAttributes(i)
        scale = _prefixes[prefix] if prefix in _prefixes else int(prefix or 0)
        known = model.units(name) if model is not None and model.hasUnits(name) else None
        inner = [Factor(name, 0, 1.0, 1.0)] if known is None else _factors(known, depth + 1)
        if len(inner) == 1 and inner[0].exponent == 1:
            only = inner[0]
            inner = [Factor(only.kind, only.scale + scale, only.multiplier * multiplier, 1.0)]
        elif scale or multiplier != 1:
            inner = [Factor("dimensionless", scale, multiplier, 1.0), *inner]
        found += [factor._replace(exponent=factor.exponent * exponent) for factor in inner]
        if len(found) > _most:
            return [Factor(units.name(), 0, 1.0, 1.0)]
    return found
