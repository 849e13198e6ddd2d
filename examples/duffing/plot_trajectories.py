#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Draws the trajectories that the program `duffing_trajectories` computed: against time, and as phase portraits.

Usage: plot_trajectories.py CSV PNG

Needs matplotlib, and numpy, which comes with it (Debian: python3-matplotlib). Exit status 2, and no picture, if
something is missing or wrong.
"""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "common"))
import figure as figures  # pylint: disable=wrong-import-position

COLUMNS = ("instance", "phase", "k", "t", "x", "v", "status")
X_COLOUR, V_COLOUR = "#10305a", "#c05020"
PERIODS_SHOWN = 6  # against time; phase portraits show all


def draw(pyplot, numpy, table, _comments):
    """Returns the figure: one row for each instance."""
    instances = numpy.unique(table["instance"])
    figure, axes = pyplot.subplots(len(instances), 2, squeeze=False, figsize=(7.2, 0.6 + 2.2 * len(instances)),
                                   width_ratios=(2.2, 1), sharex="col", sharey="col", layout="constrained")
    for instance, (history, portrait) in zip(instances, axes):
        chosen = table["instance"] == instance
        x, v, k = table["x"][chosen], table["v"][chosen], table["k"][chosen][0]
        periods = table["phase"][chosen] - table["phase"].min() + table["t"][chosen] / (2 * numpy.pi)
        history.plot(periods, x, linewidth=1, color=X_COLOUR, label=r"$x$")
        history.plot(periods, v, linewidth=0.8, color=V_COLOUR, label=r"$\dot{x}$")
        history.set_xlim(0, min(PERIODS_SHOWN, periods.max()))
        history.set_ylabel(r"$x$, $\dot{x}$ (–)")
        history.set_title(f"instance {instance:.0f}, $k = {k:.6f}$", loc="left", fontsize=9, pad=3)
        portrait.plot(x, v, linewidth=0.35, color=X_COLOUR)
        section = table["t"][chosen] == 0
        portrait.plot(x[section], v[section], linestyle="none", marker="o", markersize=3, color=V_COLOUR,
                      markeredgewidth=0)
        portrait.set_ylabel(r"$\dot{x}$ (–)")
    axes[0, 0].legend(frameon=False, loc="lower right", bbox_to_anchor=(1, 0.98), ncols=2, borderpad=0)
    axes[-1, 0].set_xlabel(r"time in periods of the forcing, $t/2\pi$ (–)")
    axes[-1, 1].set_xlabel(r"$x$ (–)")
    figure.suptitle(r"Duffing oscillator  $\ddot{x} + k\,\dot{x} - x + x^3 = 0.3\,\cos t$, dots: $t = 2\pi n$",
                    fontsize=11)
    return figure


if __name__ == "__main__":
    figures.main(__doc__, "duffing_trajectories", COLUMNS, draw, dpi=150, colours=32)
