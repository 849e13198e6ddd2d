#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Draws the resonance curves that the program `resonance` computed: the largest displacement over the frequency.

Usage: plot.py CSV PNG

Needs matplotlib, and numpy, which comes with it (Debian: python3-matplotlib). Exit status 2, and no picture, if
something is missing or wrong.
"""

import pathlib
import re
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "common"))
import figure as figures  # pylint: disable=wrong-import-position

COLUMNS = ("beta", "start", "omega", "maximum", "minimum", "mean_square", "maximum_sampled", "minimum_sampled",
           "mean_square_sampled", "status")
COLOURS = ("#10305a", "#307040", "#c05020")


def draw(pyplot, numpy, table, comments):
    """Returns the figure: the curves above, the difference between the two methods below."""
    found = re.search(r"zeta = ([-\d.e+]+)", comments)
    if not found:
        raise figures.PlotError("The file does not tell zeta: run the program `resonance` again")
    zeta = float(found[1])
    figure, (upper, lower) = pyplot.subplots(2, 1, sharex=True, figsize=(7.2, 6.2), height_ratios=(2.4, 1),
                                             layout="constrained")
    omega = table["omega"]
    grid = numpy.linspace(omega.min(), omega.max(), 1000)
    upper.plot(grid, 1 / numpy.hypot(1 - grid**2, 2 * zeta * grid), linewidth=5, color="0.8",
               label=r"closed form, $\beta = 0$", zorder=1)
    for beta, colour in zip(numpy.unique(table["beta"]), COLOURS):
        chosen = table["beta"] == beta
        if beta > 0:
            amplitude = numpy.linspace(0, 1.08 * table["maximum"].max(), 200)
            upper.plot(numpy.sqrt(1 + 0.75 * beta * amplitude**2), amplitude, linewidth=0.8, linestyle=(0, (5, 3)),
                       color=colour, alpha=0.7, zorder=1)
        upper.plot(omega[chosen], table["maximum"][chosen], linestyle="none", marker="o", markersize=1.6,
                   markeredgewidth=0, color=colour, label=rf"$\beta = {beta:.6g}$", rasterized=True)
        difference = 1 - table["maximum_sampled"][chosen] / table["maximum"][chosen]
        lower.semilogy(omega[chosen], numpy.maximum(difference, 1e-12), linestyle="none", marker="o", markersize=1.2,
                       markeredgewidth=0, color=colour, rasterized=True)
    upper.plot([], [], linewidth=0.8, linestyle=(0, (5, 3)), color="0.4", label="backbone, harmonic balance")
    upper.set_ylabel(r"largest $x$ in units of the static deflection (–)")
    upper.set_xlim(omega.min(), omega.max() if omega.max() > omega.min() else omega.min() + 1)
    upper.set_ylim(0, 1.06 * table["maximum"].max())
    upper.legend(frameon=False, loc="upper left", markerscale=3)
    upper.set_title(rf"$\ddot{{x}} + 2\zeta\dot{{x}} + x + \beta x^3 = \cos\,\omega t$,  $\zeta = {zeta:.6g}$")
    lower.set_ylim(1e-9, 1e-2)
    lower.set_ylabel("missed by samples (–)")
    lower.set_xlabel(r"frequency of the forcing $\omega/\omega_0$ (–)")
    return figure


if __name__ == "__main__":
    figures.main(__doc__, "resonance", COLUMNS, draw, dpi=180, colours=64)
