#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Draws the bifurcation diagram that the program `duffing` computed: Poincare sections and maxima against the damping.

Usage: plot.py CSV PNG

Needs matplotlib, and numpy, which comes with it (Debian: python3-matplotlib). Exit status 2, and no picture, if
something is missing or wrong.
"""

import os
import re
import sys

COLUMNS = ("instance", "phase", "k", "B", "x", "v", "x_local_max", "v_second_zero", "x_global_max", "zeros", "status")

# Column and label of the axis: the main panel, then the small ones below it.
PANELS = (
    ("x", r"displacement $x$ at $t = 2\pi n$ (–)"),
    ("x_local_max", r"local maximum of $x$ (–)"),
    ("v_second_zero", r"$\dot{x}$ at 2nd zero of $x$ (–)"),
    ("x_global_max", r"global maximum of $x$ (–)"),
)
K_LABEL = r"damping $k$ (–)"
INK = "#10305a"


class PlotError(Exception):
    """What stands in the way of a picture, for people."""


def import_libraries():
    """Returns the modules matplotlib.pyplot and numpy."""
    try:
        import matplotlib
        import numpy
    except ImportError as error:
        raise PlotError(f"{error.name} is missing for {sys.executable}: install it (Debian, Ubuntu: apt-get install "
                        "python3-matplotlib), or run this with a Python that has it, as /usr/bin/python3") from error
    matplotlib.use("Agg")  # no display needed
    from matplotlib import pyplot
    return pyplot, numpy


def read_table(numpy, path):
    """Returns the columns to draw as a dictionary of arrays, and the comments at the top of the file as one text."""
    wanted = ["k", "B"] + [name for name, _ in PANELS]
    comments = []
    try:
        with open(path, encoding="utf-8", errors="replace") as file:
            line = file.readline()
            while line.startswith("#"):
                comments.append(line[1:].strip())
                line = file.readline()
            names = tuple(line.strip().split(",")) if line.strip() else ()
            if not names:
                raise PlotError(f"{path} is empty: run the program `duffing` again")
            if names != COLUMNS:
                raise PlotError(f"{path} has the columns {ascii(line.strip()[:200])}, not those of the program "
                                f"`duffing`, {','.join(COLUMNS)}")
            start = file.tell()
            if not file.readline().strip():
                raise PlotError(f"{path} has no rows: run the program `duffing` again")
            file.seek(start)
            # Single precision is far finer than a dot, and halves the memory.
            table = numpy.loadtxt(file, comments="#", delimiter=",", usecols=[COLUMNS.index(name) for name in wanted],
                                  dtype=numpy.float32, ndmin=2)
    except OSError as error:
        raise PlotError(f"{path} cannot be read: {error.strerror or error}; run the program `duffing` first") from error
    except (ValueError, IndexError) as error:
        raise PlotError(f"{path} cannot be read as a table: {error}") from error
    return {name: table[:, column] for column, name in enumerate(wanted)}, "\n".join(comments)


def describe(table, comments):
    """The line of parameters under the title; what the file does not tell is left out."""
    parts = [rf"$B = {table['B'][0]:.6g}$"]
    start = re.search(r"x\(0\) = ([-\d.e+]+), v\(0\) = ([-\d.e+]+)", comments)
    if start:
        parts.append(rf"$(x, \dot{{x}})(0) = ({start[1]}, {start[2]})$")
    sweep = re.search(r"linspace\([^)]*, (\d+)\)", comments)
    phases = re.search(r"(\d+) transient, (\d+) recorded", comments)
    if sweep and phases:
        parts.append(f"{sweep[1]} values of $k$, {phases[2]} periods each after {phases[1]} transient ones")
    tolerance = re.search(r"absolute tolerance 1e-0*(\d+)", comments)
    if tolerance:
        parts.append(rf"Cash–Karp 5(4), tolerance $10^{{-{tolerance[1]}}}$")
    return ",  ".join(parts)


def limits(numpy, values):
    """Ends of an axis that hold all finite values with a small margin."""
    finite = values[numpy.isfinite(values)]
    if finite.size == 0:
        raise PlotError("The file has no finite values to draw: every instance failed")
    low, high = float(finite.min()), float(finite.max())
    margin = 0.03 * (high - low) or 0.5
    return low - margin, high + margin


def draw(pyplot, numpy, table, comments):
    """Returns the figure."""
    pyplot.rcParams.update({
        "font.family": "serif", "font.serif": ["STIXGeneral", "DejaVu Serif"], "mathtext.fontset": "stix",
        "font.size": 9, "axes.linewidth": 0.6, "axes.titlesize": 11,
        "xtick.direction": "in", "ytick.direction": "in", "xtick.top": True, "ytick.right": True,
        "xtick.minor.visible": True, "ytick.minor.visible": True,
    })
    figure = pyplot.figure(figsize=(7.2, 6.0))
    grid = figure.add_gridspec(2, 3, height_ratios=(1.75, 1), left=0.078, right=0.978, bottom=0.072, top=0.895,
                               hspace=0.27, wspace=0.36)
    axes = [figure.add_subplot(grid[0, :])] + [figure.add_subplot(grid[1, i]) for i in range(3)]

    # Rounded, since 0.2 in single precision is a little more, and would have no tick.
    k_limits = [round(float(end), 6) for end in (table["k"].min(), table["k"].max())]
    if k_limits[0] == k_limits[1]:
        k_limits = limits(numpy, table["k"])
    size = float(numpy.clip(0.35 * (1.5e6 / table["k"].size) ** 0.25, 0.35, 2))
    for number, ((name, label), axis) in enumerate(zip(PANELS, axes)):
        # Dots add up where points crowd: the more of them share a pixel, the fainter they are.
        alpha = float(numpy.clip((4.5e5 if number == 0 else 6e4) / table["k"].size, 0.03, 0.8))
        axis.plot(table["k"], table[name], linestyle="none", marker="o", markersize=size, markeredgewidth=0,
                  color=INK, alpha=alpha, rasterized=True)
        axis.set_xlim(*k_limits)
        axis.set_ylim(*limits(numpy, table[name]))
        axis.set_xlabel(K_LABEL)
        axis.set_ylabel(label)
        axis.set_title(f"({'abcd'[number]})", loc="left", fontsize=9, pad=3)
    center = (grid.left + grid.right) / 2
    title = r"Duffing oscillator  $\ddot{x} + k\,\dot{x} - x + x^3 = B\,\cos t$"
    figure.text(center, 0.965, title, ha="center", fontsize=12)
    figure.text(center, 0.928, describe(table, comments), ha="center", fontsize=8.5)
    return figure


def save(figure, path):
    """Writes the picture beside its place and renames it, so that there is a whole one or none."""
    kind = os.path.splitext(path)[1].lstrip(".").lower() or "png"
    temporary = f"{path}.{os.getpid()}.part"
    try:
        if os.path.exists(path) and not os.path.isfile(path):
            raise PlotError(f"{path} is not a regular file: name another one")
        folder = os.path.dirname(path)
        if folder and not os.path.isdir(folder):
            os.mkdir(folder)
        figure.savefig(temporary, format=kind, dpi=300)
        os.replace(temporary, os.path.realpath(path))
    except (OSError, ValueError) as error:
        raise PlotError(f"{path} cannot be written: {getattr(error, 'strerror', None) or error}") from error
    finally:
        if os.path.exists(temporary):
            os.remove(temporary)


def main(arguments):
    if arguments in (["-h"], ["--help"]):
        print(__doc__.strip())
        return
    if len(arguments) != 2:
        raise PlotError("Usage: plot.py CSV PNG")
    pyplot, numpy = import_libraries()
    table, comments = read_table(numpy, arguments[0])
    missing = int((~numpy.isfinite(table["x"])).sum())
    if missing:
        print(f"{missing} rows are not finite, of instances that failed: they are left out", file=sys.stderr)
    save(draw(pyplot, numpy, table, comments), arguments[1])


if __name__ == "__main__":
    try:
        main(sys.argv[1:])
    except PlotError as error:
        print(error, file=sys.stderr)
        sys.exit(2)
