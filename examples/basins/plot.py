#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Draws the basins of attraction that the program `basins` computed: colours for magnets, shades for the time to
capture.

Usage: plot.py CSV PNG

Needs matplotlib, and numpy, which comes with it (Debian: python3-matplotlib). Exit status 2, and no picture, if
something is missing or wrong.
"""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "common"))
import figure as figures  # pylint: disable=wrong-import-position

COLUMNS = ("x", "y", "magnet", "t")
# None, then magnets 1 to 3: equally light, and distinct to the colour-blind.
HUES = ((0.5, 0.5, 0.5), (0.95, 0.72, 0.30), (0.30, 0.70, 0.90), (0.85, 0.45, 0.62))
MAGNETS = ((0.5773502691896258, 0), (-0.2886751345948129, 0.5), (-0.2886751345948129, -0.5))
SHADES = 12


def shade(numpy, hue, depth):
    """The colour of a magnet at a depth from 0, light, to 1, dark."""
    light = 0.5 * (1 - depth[..., None]) ** 2
    return (numpy.asarray(hue) * (1 - light) + light) * (1 - 0.8 * depth[..., None] ** 1.6)


def draw(pyplot, numpy, table, _comments):
    """Returns the figure: the plane of initial positions, and three bars for the time."""
    side, ends = figures.square_grid(table, "x", "y", "basins")
    magnet = table["magnet"].reshape(side, side).astype(int)
    t = table["t"].reshape(side, side)
    longest = float(numpy.ceil(t.max()))
    # Whole steps show as contours, and keep the file small.
    depth = numpy.floor(numpy.clip(t / longest, 0, 1 - 1e-9) * SHADES) / (SHADES - 1)
    picture = numpy.zeros(t.shape + (3,))
    for number, hue in enumerate(HUES):
        picture[magnet == number] = shade(numpy, hue, depth[magnet == number])

    figure = pyplot.figure(figsize=(7.2, 6.2), layout="constrained")
    main, bar = figure.subplots(1, 2, width_ratios=(20, 1))
    main.imshow(picture, origin="lower", extent=ends)
    for number, (x, y) in enumerate(MAGNETS, start=1):
        main.plot(x, y, "o", markersize=4, color="black")
        main.annotate(str(number), (x, y), xytext=(5, 4), textcoords="offset points")
    main.set_xlabel("$x(0)$ (sides of the triangle)")
    main.set_ylabel("$y(0)$ (sides of the triangle)")
    main.set_title("Magnetic pendulum: over which magnet does it come to rest, and how soon?", fontsize=11)
    steps = numpy.arange(SHADES) / (SHADES - 1)
    legend = numpy.stack([shade(numpy, hue, steps) for hue in HUES[1:]], axis=1)
    bar.imshow(legend, origin="lower", extent=(0.5, 3.5, 0, longest), aspect="auto", interpolation="nearest")
    bar.set_xticks([1, 2, 3])
    bar.set_xlabel("magnet")
    bar.set_ylabel("time until it cannot leave any more (–)")
    bar.yaxis.set_label_position("right")
    bar.tick_params(axis="x", top=False, length=0)
    bar.tick_params(axis="y", labelleft=False, labelright=True)
    bar.minorticks_off()
    return figure


if __name__ == "__main__":
    figures.main(__doc__, "basins", COLUMNS, draw, dpi=150, colours=256)
