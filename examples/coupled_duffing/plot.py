#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Draws the rings that the program `coupled_duffing` computed: one panel for each start of the odd oscillator, with
how far each oscillator is from the opposite one at the ends of all periods.

Usage: plot.py CSV PNG
"""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "common"))
import figure as figures  # pylint: disable=wrong-import-position

COLUMNS = ("instance", "phase", "x_start", "v_start", "unit", "x", "v", "second_maximum", "maxima", "status")


def draw(pyplot, numpy, table, _comments):
    """Returns the figure."""
    instances = numpy.unique(table["instance"])
    x_starts, v_starts = numpy.unique(table["x_start"]), numpy.unique(table["v_start"])
    units = numpy.unique(table["unit"]).size
    phases = numpy.unique(table["phase"])
    odd_one = 11
    opposite = (odd_one + units // 2) % units
    x = table["x"].reshape(-1, units)
    away = (x - x[:, opposite:opposite + 1]).ravel()
    bound = float(numpy.nanmax(numpy.abs(away))) or 1.0
    figure, axes = pyplot.subplots(v_starts.size, x_starts.size, figsize=(7.2, 6.4), layout="constrained", sharex=True,
                                   sharey=True, squeeze=False)
    picture = None
    for instance in instances:
        own = table["instance"] == instance
        column = int(numpy.searchsorted(x_starts, table["x_start"][own][0]))
        row = v_starts.size - 1 - int(numpy.searchsorted(v_starts, table["v_start"][own][0]))
        axis = axes[row][column]
        picture = axis.imshow(away[own].reshape(phases.size, units).T, origin="lower", aspect="auto", cmap="RdBu_r",
                              vmin=-bound, vmax=bound, interpolation="none",
                              extent=(phases[0] + 0.5, phases[-1] + 1.5, -0.5, units - 0.5))
        axis.set_title(rf"$x_{{11}}(0) = {table['x_start'][own][0]:.3g}$, $v_{{11}}(0) = "
                       rf"{table['v_start'][own][0]:.3g}$", fontsize=6, pad=2)
    figure.supxlabel("period of the forcing", fontsize=9)
    figure.supylabel("oscillator", fontsize=9)
    figure.colorbar(picture, ax=axes, label=f"$x - x_{{{opposite}}}$ at the end of the period (–)", shrink=0.6)
    return figure


if __name__ == "__main__":
    figures.main(__doc__, "coupled_duffing", COLUMNS, draw, dpi=150)
