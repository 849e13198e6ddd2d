# SPDX-License-Identifier: MIT
"""Units of files as texts for the labels of results."""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

_short = {"mole": "mol", "litre": "l", "liter": "l", "second": "s", "metre": "m", "meter": "m", "gram": "g",
          "kilogram": "kg", "item": "items", "dimensionless": "", "kelvin": "K", "ampere": "A", "volt": "V",
          "joule": "J", "newton": "N", "pascal": "Pa", "hertz": "Hz", "coulomb": "C", "watt": "W", "farad": "F",
          "siemens": "S", "ohm": "Ω", "weber": "Wb", "tesla": "T", "henry": "H", "lumen": "lm", "lux": "lx",
          "becquerel": "Bq", "gray": "Gy", "sievert": "Sv", "katal": "kat", "candela": "cd", "radian": "rad",
          "steradian": "sr", "avogadro": "N_A"}
_prefixes = {0: "", -1: "d", -2: "c", -3: "m", -6: "µ", -9: "n", -12: "p", -15: "f", 3: "k", 6: "M", 9: "G"}
_times = {60.0: "min", 3600.0: "h", 86400.0: "d", 604800.0: "weeks"}
_powers = {2.0: "²", 3.0: "³"}


class Factor(NamedTuple):
    """(multiplier 10^scale kind)^exponent"""

    kind: str
    scale: float
    multiplier: float
    exponent: float

    def text(self) -> str:
        """The unit without its exponent."""
        name = _short.get(self.kind, self.kind)
        if self.multiplier == 1 and self.scale in _prefixes and (name or self.scale == 0):
            return _prefixes[int(self.scale)] + name
        size = self.multiplier * 10.0**self.scale
        if self.kind == "second" and round(size, 6) in _times:
            return _times[round(size, 6)]
        return f"{size:g} {name}".strip()


def text_of(factors: Iterable[Factor]) -> str:
    """A product of units as "mmol/l"; empty where it has no dimension."""
    above: list[str] = []
    below: list[str] = []
    for factor in factors:
        name = factor.text()
        if not name or factor.exponent == 0:
            continue
        size = abs(factor.exponent)
        power = "" if size == 1 else _powers.get(size, f"^{size:g}")
        if power and " " in name:
            name = f"({name})"
        (above if factor.exponent > 0 else below).append(name + power)
    if not below:
        return "·".join(above)
    bottom = below[0] if len(below) == 1 else f"({'·'.join(below)})"
    return f"{'·'.join(above) or '1'}/{bottom}"
