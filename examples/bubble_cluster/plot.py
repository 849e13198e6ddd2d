#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Draws the clusters that the program `bubble_cluster` computed: radii at the ends of periods over the pressure, and
the cluster itself under the highest pressure.

Usage: plot.py CSV PNG
"""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "common"))
import figure as figures  # pylint: disable=wrong-import-position

COLUMNS = ("instance", "phase", "pressure", "bubble", "radius", "x", "y", "z", "y_end", "status")


def draw(pyplot, numpy, table, _comments):
    """Returns the figure."""
    figure, (diagram, cluster) = pyplot.subplots(1, 2, figsize=(7.2, 3.6), layout="constrained")
    bubbles = numpy.unique(table["bubble"])
    order = numpy.argsort([table["radius"][table["bubble"] == k][0] for k in bubbles])
    chosen = bubbles[order[[0, len(order) // 2, -1]]]
    for bubble, colour in zip(chosen, ("#10305a", "#3a7a4a", "#c05020")):
        own = table["bubble"] == bubble
        diagram.plot(table["pressure"][own], table["y_end"][own], linestyle="none", marker="o", markersize=1.2,
                     markeredgewidth=0, color=colour, rasterized=True,
                     label=rf"{table['radius'][own][0]:.2g} $\mu$m")
    diagram.set_xlabel("pressure amplitude (bar)")
    diagram.set_ylabel("radius at the end of a period, over that at rest (–)")
    diagram.legend(frameon=False, markerscale=5, handletextpad=0.1, title="radius at rest")
    last = (table["instance"] == table["instance"].max()) & (table["phase"] == table["phase"].max())
    shade = cluster.scatter(table["x"][last], table["y"][last], s=0.8 * table["radius"][last] ** 2,
                            c=table["y_end"][last], cmap="viridis", linewidths=0)
    cluster.set_aspect("equal")
    cluster.set_xlabel("$x$ (mm)")
    cluster.set_ylabel("$y$ (mm)")
    cluster.set_title(f"{table['pressure'][last][0]:.3g} bar, end of the last period", fontsize=8)
    figure.colorbar(shade, ax=cluster, label="radius over that at rest (–)", shrink=0.8)
    return figure


if __name__ == "__main__":
    figures.main(__doc__, "bubble_cluster", COLUMNS, draw, dpi=150)
