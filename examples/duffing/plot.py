#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Draws the bifurcation diagram that the program `duffing` computed: Poincare sections and maxima against the damping.

Usage: plot.py FILE PNG

FILE is the netCDF file of the program, or its table, FILE.csv. Needs matplotlib, numpy, which comes with it (Debian:
python3-matplotlib), and for netCDF netCDF4 (Debian: python3-netcdf4). Exit status 2, and no picture, if something is
missing or wrong.
"""

import pathlib
import re
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "common"))
import figure as figures  # pylint: disable=wrong-import-position

COLUMNS = ("instance", "phase", "k", "B", "x", "v", "x_local_max", "v_second_zero", "x_global_max", "zeros", "status")

# Columns and axis labels: the main panel, then the small ones below it.
PANELS = (
    ("x", r"displacement $x$ at $t = 2\pi n$ (–)"),
    ("v", r"velocity $\dot{x}$ at $t = 2\pi n$ (–)"),
    ("x_local_max", r"local maximum of $x$"),
    ("v_second_zero", r"$\dot{x}$ at 2nd zero of $x$"),
    ("x_global_max", r"global maximum of $x$"),
)
K_LABEL = r"damping $k$ (–)"
INK = "#10305a"


def read(numpy, path, program, columns):
    """Columns with a row for each instance and recorded phase, and the text that a table has at its top."""
    if path.endswith(".csv"):
        return figures.read_table(numpy, path, program, columns)
    names = [name for name, _ in PANELS]
    with figures.open_netcdf(path, program, names + ["k", "B", "x_start", "v_start", "phase"]) as data:
        table = {name: data[name][:].ravel() for name in names}
        k, phases = data["k"][:], data["phase"][:]
        table["k"] = numpy.repeat(k, phases.size)
        table["B"] = numpy.full(1, data["B"][...])
        comments = (f"x(0) = {data['x_start'][...]}, v(0) = {data['v_start'][...]}\n"
                    f"linspace({k[0]}, {k[-1]}, {k.size})\n"
                    f"{int(phases[0])} transient, {phases.size} recorded\n"
                    f"absolute tolerance {numpy.max(data.getncattr('options_absolute_tolerance'))}")
    figures.check_finite(numpy, [table[name] for name in names])
    return table, comments


def describe(table, comments):
    """The line of parameters under the title, without those that the file does not state."""
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


def draw(pyplot, numpy, table, comments):
    """Returns the figure."""
    figure = pyplot.figure(figsize=(7.2, 7.6))
    grid = figure.add_gridspec(3, 2, height_ratios=(1.6, 1, 1), left=0.085, right=0.978, bottom=0.06, top=0.915,
                               hspace=0.3, wspace=0.24)
    axes = [figure.add_subplot(grid[0, :])] + [figure.add_subplot(grid[1 + i // 2, i % 2]) for i in range(4)]

    # Rounded, since 0.2 in single precision is slightly more than 0.2, and would get no tick.
    k_limits = [round(float(end), 6) for end in (table["k"].min(), table["k"].max())]
    if k_limits[0] == k_limits[1]:
        k_limits = figures.limits(numpy, table["k"])
    size = float(numpy.clip(0.35 * (1.5e6 / table["k"].size) ** 0.25, 0.35, 2))
    for number, ((name, label), axis) in enumerate(zip(PANELS, axes)):
        # Dots add up where points crowd: the more share a pixel, the fainter each is.
        alpha = float(numpy.clip((4.5e5 if number == 0 else 6e4) / table["k"].size, 0.03, 0.8))
        axis.plot(table["k"], table[name], linestyle="none", marker="o", markersize=size, markeredgewidth=0,
                  color=INK, alpha=alpha, rasterized=True)
        axis.set_xlim(*k_limits)
        axis.set_ylim(*figures.limits(numpy, table[name]))
        axis.set_xlabel(K_LABEL)
        axis.set_ylabel(label)
        axis.set_title(f"({'abcde'[number]})", loc="left", fontsize=9, pad=3)
    centre = (grid.left + grid.right) / 2
    title = r"Duffing oscillator  $\ddot{x} + k\,\dot{x} - x + x^3 = B\,\cos t$"
    figure.text(centre, 0.972, title, ha="center", fontsize=12)
    figure.text(centre, 0.94, describe(table, comments), ha="center", fontsize=8.5)
    return figure


if __name__ == "__main__":
    figures.main(__doc__, "duffing", COLUMNS, draw, dpi=150, colours=16, read=read)
