#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Draws the maxima of the relief valve that the program `relief_valve_contact` computed, and its times at rest, over
the flow.

Usage: plot_contact.py CSV PNG
"""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "common"))
import figure as figures  # pylint: disable=wrong-import-position

COLUMNS = ("instance", "phase", "q", "y_min", "y_max", "u_contact", "time_at_rest", "status")


def draw(pyplot, numpy, table, _comments):
    """Returns the figure."""
    q, y_max, at_rest = table["q"], table["y_max"], table["time_at_rest"]
    figure, (maxima, times) = pyplot.subplots(2, 1, figsize=(7.2, 5.6), sharex=True, layout="constrained",
                                              height_ratios=(2.2, 1))
    size = float(numpy.clip(0.35 * (1e6 / q.size) ** 0.35, 0.25, 1.5))
    style = {"linestyle": "none", "marker": "o", "markeredgewidth": 0, "rasterized": True}
    rested = at_rest > 0
    maxima.plot(q[~rested], y_max[~rested], color="#10305a", markersize=size, label="after an impact", **style)
    maxima.plot(q[rested], y_max[rested], color="#c05020", markersize=max(2 * size, 1.5), label="after a rest", **style)
    maxima.set_yscale("log")
    maxima.set_ylabel("maxima of $y$ (–)")
    for handle in maxima.legend(frameon=False, loc="lower right").get_lines():
        handle.set_markersize(4)
    times.plot(q[rested], at_rest[rested], color="#c05020", markersize=max(2 * size, 1.5), **style)
    times.set_ylim(0, None)
    times.set_ylabel("time at rest (–)")
    times.set_xlabel("flow $q$ (–)")
    return figure


if __name__ == "__main__":
    figures.main(__doc__, "relief_valve_contact", COLUMNS, draw, dpi=160)
