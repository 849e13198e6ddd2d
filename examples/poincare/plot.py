#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Draws the section points that the program `poincare` computed: over c, as a return map, and their return times.

Usage: plot.py CSV PNG
"""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "common"))
import figure as figures  # pylint: disable=wrong-import-position

COLUMNS = ("instance", "phase", "c", "x", "z", "return_time", "status")
MAPS = ((9.0, "#c05020"), (11.0, "#3a7a4a"), (18.0, "#10305a"))  # values of c whose return maps are drawn
MAP_WIDTH = 0.02  # of the interval of c whose points are plotted together


def density(axis, numpy, c, values, columns, rows):
    """Draws the number of points in each cell, darker for more points; the axis covers all points."""
    low, high = figures.limits(numpy, values)
    counts, c_edges, value_edges = numpy.histogram2d(c, values, bins=(columns, rows),
                                                     range=((c.min(), c.max()), (low, high)))
    share = counts.T / max(counts.sum(axis=1).max(), 1)
    shade = numpy.round(numpy.clip(share * rows / 6, 0, 1) ** 0.35 * 7) / 7  # few shades, for a small file
    axis.imshow(shade, origin="lower", aspect="auto", extent=(c_edges[0], c_edges[-1], value_edges[0], value_edges[-1]),
                cmap="Greys", vmin=0, vmax=1, interpolation="none")


def draw(pyplot, numpy, table, _comments):
    """Returns the figure."""
    good = numpy.isfinite(table["x"])
    c, x, time, instance = (table[name][good] for name in ("c", "x", "return_time", "instance"))
    figure = pyplot.figure(figsize=(7.2, 6.6), layout="constrained")
    grid = figure.add_gridspec(2, 2, height_ratios=(1.25, 1))
    diagram = figure.add_subplot(grid[0, :])
    columns = int(min(1000, numpy.unique(instance).size))
    density(diagram, numpy, c, x, columns, 400)
    diagram.set_xlabel("$c$ (–)")
    diagram.set_ylabel("$x$ on the section $y = 0$, $x < 0$ (–)")

    returns = figure.add_subplot(grid[1, 0])
    follows = (instance[1:] == instance[:-1]) & (numpy.diff(table["phase"][good]) == 1)
    for value, colour in MAPS:
        step = (c.max() - c.min()) / max(numpy.unique(instance).size - 1, 1)
        near = follows & (numpy.abs(c[:-1] - value) <= max(MAP_WIDTH / 2, step))
        if not near.any():
            continue
        returns.plot(x[:-1][near], x[1:][near], linestyle="none", marker="o", markersize=1.5, markeredgewidth=0,
                     color=colour,
                     label=f"$c = {value:g}$", rasterized=True)
        diagram.axvline(value, color=colour, linewidth=0.8, linestyle=(0, (4, 3)))
    low, high = figures.limits(numpy, x)
    returns.plot((low, high), (low, high), color="0.6", linewidth=0.6, zorder=0)
    returns.set_xlabel("$x_n$ (–)")
    returns.set_ylabel("$x_{n+1}$ (–)")
    returns.legend(frameon=False, markerscale=4, handletextpad=0.1)

    times = figure.add_subplot(grid[1, 1])
    density(times, numpy, c, time, min(columns, 450), 300)
    times.set_xlabel("$c$ (–)")
    times.set_ylabel("return time (–)")
    return figure


if __name__ == "__main__":
    figures.main(__doc__, "poincare", COLUMNS, draw, dpi=160)
