#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Draws the planes that the program `bubble_dual_frequency` computed: growth, collapse and winding over both
frequencies.

Usage: plot_dual_frequency.py CSV PNG

Needs matplotlib, and numpy, which comes with it (Debian: python3-matplotlib). Exit status 2, and no picture, if
something is missing or wrong.
"""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "common"))
import figure as figures  # pylint: disable=wrong-import-position

COLUMNS = ("instance", "pa1_bar", "pa2_bar", "f1_kHz", "f2_kHz", "expansion", "compression", "collapse_us", "winding",
           "status")

# Column, label of the colours, colour map and scale: one row of planes each.
ROWS = (
    ("expansion", r"$(R_\mathrm{max} - R_E)/R_E$ (–)", "viridis", "root"),
    ("compression", r"$R_\mathrm{max}/R_\mathrm{min}$ (–)", "inferno", "log"),
    ("collapse_us", "collapse time (µs)", "cividis", "log"),
    ("winding", "winding number (–)", "plasma", "log"),
)
TICKS = (20, 100, 1000)
COLOURS = 24  # per map: as many as can be told apart, for a small file


def scale_of(pyplot, numpy, values, scale):
    """The colour scale shared by all planes of a row, without the outermost thousandth of the values."""
    finite = values[numpy.isfinite(values)]
    if finite.size == 0:
        raise figures.PlotError("The file has no finite values to draw: every instance failed")
    low, high = numpy.quantile(finite, (0.001, 0.999))
    high = max(high, low * 1.001 + 1e-12)
    if scale == "log" and low > 0:
        return pyplot.matplotlib.colors.LogNorm(low, high)
    return pyplot.matplotlib.colors.PowerNorm(0.5, low, high)


def draw(pyplot, numpy, table, _comments):
    """Returns the figure: a column of planes for each pair of pressure amplitudes."""
    pairs = sorted({*zip(table["pa1_bar"], table["pa2_bar"])})
    figure, axes = pyplot.subplots(len(ROWS), len(pairs), sharex=True, sharey=True, squeeze=False,
                                   figsize=(1.1 + 1.55 * len(pairs), 6.35), layout="compressed")
    for (name, label, colours, scale), row in zip(ROWS, axes):
        colours = pyplot.get_cmap(colours, COLOURS)
        norm = scale_of(pyplot, numpy, table[name], scale)
        for (first, second), axis in zip(pairs, row):
            chosen = (table["pa1_bar"] == first) & (table["pa2_bar"] == second)
            f_1, column = numpy.unique(table["f1_kHz"][chosen], return_inverse=True)
            f_2, line = numpy.unique(table["f2_kHz"][chosen], return_inverse=True)
            plane = numpy.full((f_2.size, f_1.size), numpy.nan)
            plane[line, column] = table[name][chosen]
            mesh = axis.pcolormesh(figures.edges_of_ratios(numpy, f_1), figures.edges_of_ratios(numpy, f_2), plane,
                                   norm=norm, cmap=colours, rasterized=True)
            axis.set(xscale="log", yscale="log", aspect="equal", xticks=TICKS, yticks=TICKS)
            axis.xaxis.set_major_formatter("{x:g}")
            axis.yaxis.set_major_formatter("{x:g}")
            axis.tick_params(direction="out", which="both", top=False, right=False)
            axis.xaxis.set_minor_formatter(pyplot.NullFormatter())
            axis.yaxis.set_minor_formatter(pyplot.NullFormatter())
        bar = figure.colorbar(mesh, ax=row, pad=0.01, aspect=14, label=label, format="{x:g}")
        if scale == "log":
            bar.ax.yaxis.set_major_locator(pyplot.matplotlib.ticker.LogLocator(subs=(1, 2, 5)))
        bar.ax.yaxis.set_minor_formatter(pyplot.NullFormatter())
        bar.ax.tick_params(direction="out", which="both")
        row[0].set_ylabel(r"$f_2$ (kHz)")
    for (first, second), top, bottom in zip(pairs, axes[0], axes[-1]):
        top.set_title(rf"$P_{{A1}} = {first:g}$, $P_{{A2}} = {second:g}$ bar", fontsize=9)
        bottom.set_xlabel(r"$f_1$ (kHz)")
    return figure


if __name__ == "__main__":
    figures.main(__doc__, "bubble_dual_frequency", COLUMNS, draw, dpi=150)
