#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes one_step.hpp: one step of each method on the timed circle, from published coefficients in 60 decimal digits.

Usage: one_step.py FOLDER > one_step.hpp
FOLDER holds the coefficients, NAME.toml with A_exact, b_exact and c_exact as rationals or long decimals. Uses
nothing of Myriad, so that a coefficient of the library that differs from the published one is detected.
"""
import decimal
import fractions
import os
import sys
import tomllib

METHODS = {"runge_kutta_4": "RK4", "cash_karp": "CashKarp54", "tsitouras_5": "Tsit5", "dormand_prince_5": "DP54",
           "verner_7": "Vern7", "dormand_prince_8": "DOP853", "verner_9": "Vern9"}
H, ANGLE = "0.5", "0.75"  # step length; at the start ln u and ln w are sine and cosine of ANGLE


def number(text):
    """A rational or decimal number as Decimal."""
    value = fractions.Fraction(text)
    return decimal.Decimal(value.numerator) / decimal.Decimal(value.denominator)


def sine_and_cosine(x):
    """By their series."""
    sums, term = [decimal.Decimal(0), decimal.Decimal(0)], decimal.Decimal(1)
    for k in range(1, 120):
        sums[k % 2] += term * (1 if (k - 1) // 2 % 2 == 0 else -1)
        term = term * x / k
    return sums[0], sums[1]


def slopes(t, y):
    speed = 1 + t
    return [speed * y[0] * y[1].ln(), -(speed * y[1] * y[0].ln())]


def one_step(tableau, y, h):
    b = [number(x) for x in tableau["b_exact"]]
    c = [number(x) for x in tableau["c_exact"]]
    a = [[number(x) for x in row] for row in tableau["A_exact"]]
    while b[-1] == 0:  # extra stages, of the error estimate or the interpolant
        b.pop()
    k = []
    for i in range(len(b)):
        argument = [y[n] + h * sum((a[i][j] * k[j][n] for j in range(i)), decimal.Decimal(0)) for n in range(2)]
        k.append(slopes(c[i] * h, argument))
    return [y[n] + h * sum(b[i] * k[i][n] for i in range(len(b))) for n in range(2)]


def main(folder):
    decimal.getcontext().prec = 60
    sine, cosine = sine_and_cosine(decimal.Decimal(ANGLE))
    start = [sine.exp(), cosine.exp()]
    print("// SPDX-License-Identifier: MIT")
    print("// One step of each method on the timed circle, from published coefficients in 60 decimal digits. "
          "Written by one_step.py.")
    print("#pragma once\n\n#include <map>\n#include <string>\n#include <vector>\n\nnamespace validation {\n")
    print(f"inline constexpr double one_step_length = {H}, one_step_angle = {ANGLE};\n")
    print("inline const std::map<std::string, std::vector<double>> one_step = {")
    for method, file in METHODS.items():
        with open(os.path.join(folder, file + ".toml"), "rb") as source:
            y = one_step(tomllib.load(source), start, decimal.Decimal(H))
        print(f'    {{"{method}", {{{y[0]:.25f}, {y[1]:.25f}}}}},')
    print("};\n\n}  // namespace validation")


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    main(sys.argv[1])
