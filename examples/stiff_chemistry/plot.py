#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Draws the periods of the Oregonator that the program `stiff_chemistry` computed, and their cost, over f and epsilon.

Usage: plot.py CSV PNG
"""

import pathlib
import re
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "common"))
import figure as figures  # pylint: disable=wrong-import-position

COLUMNS = ("instance", "f", "epsilon", "period", "z_least", "z_largest", "growth", "frequency", "steps", "status")


def draw(pyplot, numpy, table, comments):
    """Returns the figure: the period where the system oscillates, and the steps of every instance."""
    said = re.search(r"of cycle (\d+)", comments)
    cycles = f" in {said[1]} cycles" if said else ""
    f, epsilon = numpy.unique(table["f"]), numpy.unique(table["epsilon"])
    shape = (epsilon.size, f.size)
    if table["f"].size != epsilon.size * f.size:
        raise figures.PlotError("The rows are no complete plane of f and epsilon: "
                                "run the program `stiff_chemistry` again")
    oscillates = (table["period"] > 0) & (table["z_largest"] - table["z_least"] > 0.05 * table["z_largest"])
    period = numpy.where(oscillates, table["period"], numpy.nan)
    f_edges, epsilon_edges = figures.edges(numpy, f), figures.edges_of_ratios(numpy, epsilon)

    from matplotlib.colors import LogNorm
    figure, axes = pyplot.subplots(1, 2, sharey=True, figsize=(9, 4.2), layout="constrained")
    for axis, values, name, colours, title in (
            (axes[0], period, "period, in decay times of the catalyst", "viridis", "Period of the oscillation"),
            (axes[1], table["steps"], f"trial steps{cycles}", "cividis", "Cost")):
        mesh = axis.pcolormesh(f_edges, epsilon_edges, values.reshape(shape), cmap=colours, rasterized=True,
                               # a few that did not finish have other periods
                               norm=LogNorm(*numpy.nanquantile(values,
                                                               (0.002, 1))) if numpy.isfinite(values).any() else None)
        if min(shape) > 1:
            axis.contour(f, epsilon, table["growth"].reshape(shape), levels=[0], colors="#d03020", linewidths=1.1)
        figure.colorbar(mesh, ax=axis, label=name, pad=0.02)
        axis.set_yscale("log")
        axis.set_xlabel("stoichiometric factor $f$ (–)")
        axis.set_title(title)
    bar = figure.axes[2].yaxis
    bar.set_major_formatter("{x:g}")
    bar.set_minor_formatter("{x:g}")
    axes[0].set_ylabel(r"$\varepsilon$ (–)")
    axes[0].plot([], [], color="#d03020", linewidth=1.1, label="Hopf bifurcation, closed form")
    axes[0].legend(loc="upper right", frameon=False)
    return figure


if __name__ == "__main__":
    figures.main(__doc__, "stiff_chemistry", COLUMNS, draw)
