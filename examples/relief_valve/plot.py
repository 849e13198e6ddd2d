#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Draws the smallest and largest displacements of the relief valve that the program `relief_valve` computed, over the
flow.

Usage: plot.py CSV PNG
"""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "common"))
import figure as figures  # pylint: disable=wrong-import-position

COLUMNS = ("instance", "phase", "q", "y_min", "y_max", "impacts", "status")
SEAT = 1e-6  # accuracy of the seat's location
STABLE_FROM = 8.491118  # the equilibrium's stability limit, computed by check.sh


def draw(pyplot, numpy, table, _comments):
    """Returns the figure: both displacements, and the smallest one on a logarithmic scale, where the impacts are."""
    q, y_min, y_max = table["q"], table["y_min"], table["y_max"]
    figure, axis = pyplot.subplots(figsize=(7.2, 4.2), layout="constrained")
    size = float(numpy.clip(0.5 * (1e6 / q.size) ** 0.25, 0.4, 2.5))
    style = {"linestyle": "none", "marker": "o", "markersize": size, "markeredgewidth": 0, "rasterized": True}
    impact = y_min <= SEAT
    axis.plot(q, y_max, color="#c05020", label="largest", **style)
    axis.plot(q[~impact], y_min[~impact], color="#10305a", label="smallest, in flight", **style)
    axis.plot(q[impact], y_min[impact], color="#2a8a5a", label="smallest, an impact",
              **{**style, "markersize": size + 1})
    # below the stability limit the equilibrium is unstable: u = y + delta, q = y sqrt(u)
    y = numpy.linspace(0, 2.41031, 200)
    axis.plot(y * numpy.sqrt(y + 10), y, color="0.4", linewidth=0.8, linestyle=(0, (4, 3)),
              label="unstable equilibrium")
    grazing = q[impact].max() if impact.any() else numpy.nan
    for place, height, text in ((grazing, 3.7, "grazing"), (STABLE_FROM, 8.9, "Hopf bifurcation")):
        if q.min() < place < q.max():
            axis.axvline(place, color="0.75", linewidth=0.6, zorder=0)
            axis.text(place + 0.06, height, f"{text},\n$q = {place:.2f}$", ha="left", va="top", color="0.3", fontsize=8)
    axis.set_xlabel("flow $q$ (–)")
    axis.set_ylabel("displacement $y$ in one phase (–)")
    for handle in axis.legend(frameon=False, loc="upper left").get_lines()[:3]:
        handle.set_markersize(4)
    return figure


if __name__ == "__main__":
    figures.main(__doc__, "relief_valve", COLUMNS, draw)
