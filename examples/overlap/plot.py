#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Draws the timeline that the program `overlap` recorded: the steps of each solver object.

Usage: plot.py CSV PNG

Needs matplotlib, and numpy, which comes with it (Debian: python3-matplotlib). Exit status 2, and no picture, if
something is missing or wrong.
"""

import pathlib
import re
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "common"))
import figure as figures  # pylint: disable=wrong-import-position

COLUMNS = ("solver", "device", "chunk", "step", "begin", "end", "kernel_seconds")
STEPS = (("fill", "#88ccee"), ("upload", "#44aa99"), ("integrate", "#10305a"), ("download", "#ddaa33"),
         ("write", "#cc6677"))
INTEGRATE = 2
LEAST_VISIBLE = 0.002  # of the whole time: three pixels


def under_way(numpy, table):
    """Times at which a step begins or ends, and how many steps are in progress from then on."""
    t = numpy.concatenate((table["begin"], table["end"]))
    change = numpy.concatenate((numpy.ones(len(table["begin"])), -numpy.ones(len(table["end"]))))
    order = numpy.lexsort((change, t))
    return t[order], numpy.cumsum(change[order])


def draw(pyplot, numpy, table, comments):
    """Returns the figure: a lane for each solver object, and below them the number of steps in progress."""
    solvers = sorted(set(table["solver"]))
    end = table["end"].max()
    scale, unit = (1, "s") if end >= 1 else (1e3, "ms")
    figure, (lanes, count) = pyplot.subplots(2, 1, sharex=True, figsize=(7.2, 1.9 + 0.55 * len(solvers)),
                                             height_ratios=(0.55 * len(solvers), 0.8), layout="constrained")
    for number, (_name, colour) in enumerate(STEPS):
        rows = table["step"] == number
        begin, length = scale * table["begin"][rows], scale * (table["end"] - table["begin"])[rows]
        lanes.barh(table["solver"][rows], length, left=begin, height=0.7, color=colour, edgecolor="white",
                   linewidth=0.3)
        if number != INTEGRATE:
            continue
        for solver, left, width, chunk in zip(table["solver"][rows], begin, length, table["chunk"][rows]):
            if width > 0.03 * scale * end:
                lanes.text(left + width / 2, solver, f"{chunk + 1:.0f}", color="white", fontsize=7, ha="center",
                           va="center")
    names = dict(re.findall(r"device (\d+): ([^,\s]+)", comments))
    device_of = dict(zip(table["solver"], table["device"]))
    lanes.set_yticks(solvers, [f"{names.get(f'{device_of[s]:.0f}', '')}\nsolver {s + 1:.0f}" for s in solvers])
    lanes.tick_params(axis="y", which="both", left=False, right=False)
    lanes.invert_yaxis()
    handles = [pyplot.Rectangle((0, 0), 1, 1, color=colour) for _name, colour in STEPS]
    labels = []
    for number, (name, _colour) in enumerate(STEPS):
        rows = table["step"] == number
        longest = (table["end"] - table["begin"])[rows].max(initial=0)
        labels.append(name if longest > LEAST_VISIBLE * end else f"{name} (too short to be seen)")
    lanes.legend(handles, labels, ncols=len(STEPS), loc="lower center", frameon=False,
                 bbox_to_anchor=(0.5, 1), fontsize=8, handlelength=1)

    t, running = under_way(numpy, table)
    count.fill_between(scale * t, running, step="post", color="0.75", linewidth=0)
    count.axhline(1, color="0.4", linewidth=0.5)
    count.set_ylim(0, len(solvers) + 0.3)
    count.yaxis.get_major_locator().set_params(integer=True)
    count.tick_params(axis="y", which="minor", left=False, right=False)
    count.set_ylabel("at once")
    count.set_xlabel(f"time ({unit})")
    count.set_xlim(0, scale * end)
    shared = numpy.diff(t)[running[:-1] >= 2].sum() / end
    count.set_title(f"two or more steps at once for {100 * shared:.0f} % of the time", fontsize=8, pad=2)
    return figure


if __name__ == "__main__":
    figures.main(__doc__, "overlap", COLUMNS, draw)
