#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Draws the map of Lyapunov exponents that the program `lyapunov_map` computed, and how well its two methods agree.

Usage: plot.py CSV PNG

Needs matplotlib, and numpy, which comes with it (Debian: python3-matplotlib). Exit status 2, and no picture, if
something is missing or wrong.
"""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "common"))
import figure as figures  # pylint: disable=wrong-import-position

COLUMNS = ("k", "B", "lambda_hand", "lambda_library", "status")
SHOWN = 0.25  # larger exponents get the colours of the ends


def draw(pyplot, numpy, table, _comments):
    """Returns the figure: the map, and beside it the difference of both exponents, over the plane and the exponent."""
    from matplotlib import colors  # pylint: disable=import-outside-toplevel
    figure = pyplot.figure(figsize=(7.2, 4.4), layout="constrained")
    left, right = figure.subfigures(1, 2, width_ratios=(1.75, 1))
    main = left.subplots()
    above, below = right.subplots(2, 1)
    side, ends = figures.square_grid(table, "k", "B", "lyapunov_map")
    exponent = table["lambda_library"].reshape(side, side)
    smoothing = "nearest" if side < 700 else "antialiased"  # fewer cells than dots, or more
    image = main.imshow(exponent, origin="lower", extent=ends, aspect="auto", cmap=pyplot.get_cmap("RdBu_r", 100),
                        vmin=-SHOWN, vmax=SHOWN, interpolation=smoothing)
    k = numpy.array(ends[:2])
    main.plot(k, 0.7530 * k, color="0.15", linewidth=0.8, linestyle=(0, (5, 3)), scalex=False, scaley=False)
    main.annotate("Melnikov:\n$B = 0.753\\,k$", (0.22, 0.15), fontsize=8, va="top")
    main.set_ylabel("forcing $B$ (–)")
    main.set_xlabel("damping $k$ (–)")
    main.set_title(r"$\ddot{x} + k\,\dot{x} - x + x^3 = B\,\cos t$", fontsize=11)
    bar = left.colorbar(image, ax=main, ticks=[-0.2, -0.1, 0, 0.1, 0.2], pad=0.02)
    bar.set_label(r"largest Lyapunov exponent $\lambda$ (per unit of time)")
    bar.ax.minorticks_off()

    difference = numpy.abs(table["lambda_library"] - table["lambda_hand"])
    magnitude = numpy.log10(numpy.maximum(difference, 1e-17))
    image = above.imshow(magnitude.reshape(side, side), origin="lower", extent=ends, aspect="auto", cmap="cividis",
                         interpolation="nearest", norm=colors.BoundaryNorm(numpy.arange(-16, 1, 2), 256, extend="min"))
    above.set_xlabel("$k$")
    above.set_ylabel("$B$")
    above.set_title("by hand against by the library", fontsize=9)
    bar = right.colorbar(image, ax=[above, below], pad=0.03, aspect=40)
    bar.set_label(r"$\log_{10}\,|\lambda_{\mathrm{library}} - \lambda_{\mathrm{hand}}|$")
    bar.ax.minorticks_off()

    counts, across, up = numpy.histogram2d(table["lambda_library"], magnitude, bins=(90, 60),
                                           range=((-SHOWN - 0.02, SHOWN + 0.02), (-17.5, 0.5)))
    below.imshow(numpy.ma.masked_less(counts.T, 1), origin="lower", extent=(across[0], across[-1], up[0], up[-1]),
                 aspect="auto", cmap="Greys", norm=colors.LogNorm(0.3, counts.max()), interpolation="nearest")
    below.axvline(0, color="0.6", linewidth=0.6)
    below.set_xlabel(r"$\lambda$")
    below.set_ylabel(r"$\log_{10}$ of the difference")
    return figure


if __name__ == "__main__":
    figures.main(__doc__, "lyapunov_map", COLUMNS, draw, colours=256)
