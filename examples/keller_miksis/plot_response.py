#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Draws the results of the program `bubble_response`: largest radii and winding numbers over the frequency.

Usage: plot_response.py CSV PNG

Needs matplotlib, and numpy, which comes with it (Debian: python3-matplotlib). Exit status 2, and no picture, if
something is missing or wrong.
"""

import pathlib
import re
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "common"))
import figure as figures  # pylint: disable=wrong-import-position

COLUMNS = ("instance", "phase", "f_kHz", "y_max", "maxima", "status")
INK = "#10305a"


def draw(pyplot, numpy, table, comments):
    """Returns the figure: a dot per recorded period above, the mean number of maxima per period below."""
    frequency = table["f_kHz"]
    figure, (upper, lower) = pyplot.subplots(2, 1, sharex=True, figsize=(7.2, 5.6), height_ratios=(2, 1),
                                             layout="constrained")
    size = float(numpy.clip(0.35 * (2e6 / frequency.size) ** 0.25, 0.35, 2))
    alpha = float(numpy.clip(3e5 / frequency.size, 0.06, 0.8))
    upper.plot(frequency, table["y_max"], linestyle="none", marker="o", markersize=size, markeredgewidth=0, color=INK,
               alpha=alpha, rasterized=True)
    upper.set_ylim(*figures.limits(numpy, table["y_max"]))
    upper.set_ylabel(r"largest radius $R_\mathrm{max} / R_E$ (–)")

    instances, start = numpy.unique(table["instance"], return_index=True)
    winding = numpy.add.reduceat(table["maxima"], start) / numpy.diff(numpy.append(start, frequency.size))
    dot = float(numpy.clip(0.8 * (4e4 / instances.size) ** 0.25, 0.8, 2.5))
    lower.plot(frequency[start], winding, linestyle="none", marker="o", markersize=dot, markeredgewidth=0, color=INK,
               alpha=float(numpy.clip(1.2e4 / instances.size, 0.25, 0.9)), rasterized=True)
    lower.set_yscale("log", base=2)
    lower.yaxis.set_major_formatter("{x:g}")
    lower.minorticks_on()
    lower.yaxis.set_minor_locator(pyplot.NullLocator())
    lower.set_ylabel("winding number:\nmaxima per period (–)")
    lower.set_xlabel(r"frequency $f_1$ (kHz)")
    lower.set_xscale("log")
    lower.xaxis.set_major_formatter("{x:g}")
    lower.xaxis.set_minor_formatter("")
    lower.set_xticks([20, 50, 100, 200, 500, 1000])
    lower.set_xlim(frequency.min(), frequency.max() if frequency.max() > frequency.min() else 2 * frequency.min())

    own = re.search(r"eigenfrequency ([\d.]+) kHz", comments)
    if own:
        for axis in (upper, lower):
            axis.axvline(float(own[1]), color="#c05020", linewidth=0.7, linestyle=(0, (4, 3)))
        upper.annotate(r"$f_0$", (float(own[1]), 1), xycoords=("data", "axes fraction"), xytext=(3, -11),
                       textcoords="offset points", color="#c05020")
    pressure = re.search(r"amplitude ([-\d.e+]+) bar", comments)
    title = "Keller–Miksis bubble, $R_E = 10$ µm in water"
    upper.set_title(title + (rf", $P_{{A1}} = {float(pressure[1]):g}$ bar" if pressure else ""))
    return figure


if __name__ == "__main__":
    figures.main(__doc__, "bubble_response", COLUMNS, draw, dpi=220)
