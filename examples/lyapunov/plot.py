#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Draws the Lyapunov exponents that the program `lyapunov` computed over rho.

Usage: plot.py CSV PNG

Needs matplotlib, and numpy, which comes with it (Debian: python3-matplotlib). Exit status 2, and no picture, if
something is missing or wrong.
"""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "common"))
import figure as figures  # pylint: disable=wrong-import-position

COLUMNS = ("instance", "rho", "lambda_1", "lambda_2", "lambda_3", "status")


def draw(pyplot, _numpy, table, _comments):
    """Returns the figure: the two largest exponents above, the smallest below."""
    rho = table["rho"]
    figure, (upper, lower) = pyplot.subplots(2, 1, sharex=True, figsize=(7.2, 5), height_ratios=(2, 1),
                                             layout="constrained")
    upper.axhline(0, color="0.6", linewidth=0.6)
    upper.plot(rho, table["lambda_1"], linewidth=0.7, color="#10305a", label=r"$\lambda_1$", zorder=3)
    upper.plot(rho, table["lambda_2"], linewidth=0.7, color="#c05020", label=r"$\lambda_2$")
    upper.set_ylim(-1.5, None)
    upper.set_ylabel(r"$\lambda_1$, $\lambda_2$ (per unit of time)")
    upper.legend(loc="upper left", frameon=False)
    lower.plot(rho, table["lambda_3"], linewidth=0.7, color="#307040")
    lower.set_ylabel(r"$\lambda_3$ (per unit of time)")
    lower.set_xlabel(r"$\rho$ (–)")
    lower.set_xlim(rho.min(), rho.max() if rho.max() > rho.min() else rho.min() + 1)
    upper.set_title(r"Lyapunov exponents of Lorenz' equations, $\sigma = 10$, $\beta = 8/3$", fontsize=11)
    return figure


if __name__ == "__main__":
    figures.main(__doc__, "lyapunov", COLUMNS, draw)
