#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Draws the smallest and largest displacements of the relief valve that the program `relief_valve` computed, over the flow.

Usage: plot.py CSV PNG
"""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "common"))
import figure as figures  # pylint: disable=wrong-import-position

COLUMNS = ("instance", "phase", "q", "y_min", "y_max", "impacts", "status")


def draw(pyplot, numpy, table, _comments):
    """Returns the figure."""
    figure, axis = pyplot.subplots(figsize=(7.2, 4.2), layout="constrained")
    size = float(numpy.clip(0.5 * (1e6 / table["q"].size) ** 0.25, 0.5, 3))
    for name, color, label in (("y_max", "#c05020", "largest"), ("y_min", "#10305a", "smallest")):
        axis.plot(table["q"], table[name], linestyle="none", marker="o", markersize=size, markeredgewidth=0,
                  color=color, label=label, rasterized=True)
    axis.set_xlabel("flow $q$ (–)")
    axis.set_ylabel("displacement $y$ in one phase (–)")
    axis.legend(frameon=False, markerscale=6 / size)
    axis.set_title("Pressure relief valve", fontsize=11)
    return figure


if __name__ == "__main__":
    figures.main(__doc__, "relief_valve", COLUMNS, draw)
