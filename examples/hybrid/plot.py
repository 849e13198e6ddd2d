#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Draws the period of the stick-slip oscillation that the program `hybrid` computed, beside its closed form.

Usage: plot.py CSV PNG
"""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "common"))
import figure as figures  # pylint: disable=wrong-import-position

COLUMNS = ("instance", "phase", "belt", "x_slip", "x_stick", "period", "status")


def draw(pyplot, numpy, table, _comments):
    """Returns the figure: where the block slips and sticks, and the time from slip to slip."""
    figure, (places, periods) = pyplot.subplots(1, 2, figsize=(7.2, 3.2), layout="constrained")
    places.plot(table["belt"], table["x_slip"], linewidth=1, color="#10305a", label="slips")
    places.plot(table["belt"], table["x_stick"], linewidth=1, color="#c05020", label="sticks")
    places.set_xlabel("speed of the belt (–)")
    places.set_ylabel("place of the block (–)")
    places.set_ylim(-0.5, 1.5)
    places.legend(frameon=False)
    belt = numpy.linspace(table["belt"].min(), table["belt"].max(), 200)
    exact = 2 * numpy.pi - 2 * numpy.arctan(0.5 / belt) + 1 / belt
    periods.plot(table["belt"], table["period"], linewidth=1, color="#10305a", label="computed")
    periods.plot(belt, exact, linewidth=1, linestyle=(0, (1, 3)), color="#c05020", label="closed form")
    periods.set_xlabel("speed of the belt (–)")
    periods.set_ylabel("time from slip to slip (–)")
    periods.legend(frameon=False)
    return figure


if __name__ == "__main__":
    figures.main(__doc__, "hybrid", COLUMNS, draw)
