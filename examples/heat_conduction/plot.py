#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Draws the heat flow and the temperatures that the program `heat_conduction` computed over the diffusivity.

Usage: plot.py CSV PNG

Needs matplotlib, and numpy, which comes with it (Debian: python3-matplotlib). Exit status 2, and no picture, if
something is missing or wrong.
"""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "common"))
import figure as figures  # pylint: disable=wrong-import-position

DEPTHS, OUTER = 33, 3.0
COLUMNS = ("instance", "phase", "t", "diffusivity", "through", "pulse", "mean_heat_flow", "heat_flow",
           *(f"T_{k}" for k in range(DEPTHS)), "status")
STILL = OUTER / (OUTER - 1)
COLOURS = ("#10305a", "#c05020", "#307040", "#7a3b8f")


def flow_name(through, pulse):
    """The flow of the liquid as a formula."""
    if pulse == 0:
        return rf"$u\,r^2 = {through:+g}$"
    return r"$u\,r^2 = " + (f"{pulse:g}\\," if pulse != 1 else "") + r"\cos 2\pi t$"


def draw_heat_flow(numpy, axis, last):
    """Heat flow over diffusivity with steady flows of liquid, and its closed form."""
    for through, colour in zip((-0.5, 0.5), COLOURS):
        of_flow = (last["pulse"] == 0) & (last["through"] == through)
        a = last["diffusivity"][of_flow]
        peclet = through / a / STILL
        axis.plot(a, peclet / numpy.expm1(peclet), color="0.75", linewidth=3.5)
        axis.plot(a, last["mean_heat_flow"][of_flow] / STILL, color=colour, linewidth=1, label=flow_name(through, 0))
    axis.plot([], [], color="0.75", linewidth=3.5, label="closed form")
    axis.set_xscale("log")
    axis.set_yscale("log")
    axis.set_xlim(last["diffusivity"].min(), last["diffusivity"].max() * 1.0001)
    axis.set_xlabel(r"diffusivity $a$ (radius$^2$/period)")
    axis.set_ylabel("heat flow over that in liquid at rest (–)")
    axis.legend(frameon=False, fontsize=8, loc="lower right")


def draw_gain(axis, last):
    """The gain in heat flow due to the oscillating flow."""
    for pulse, colour in zip(sorted(set(last["pulse"]) - {0}), COLOURS[2:]):
        of_flow = last["pulse"] == pulse
        axis.plot(last["diffusivity"][of_flow], 100 * (last["mean_heat_flow"][of_flow] / STILL - 1), color=colour,
                  linewidth=1, label=flow_name(0, pulse))
    axis.set_xscale("log")
    axis.set_xlim(last["diffusivity"].min(), last["diffusivity"].max() * 1.0001)
    axis.set_ylim(0, None)
    axis.set_xlabel(r"diffusivity $a$ (radius$^2$/period)")
    axis.set_ylabel("gain of the mean heat flow (%)")
    axis.legend(frameon=False, fontsize=7.5)


def draw_map(numpy, axis, table, instance):
    """Temperature over time and radius of one instance, in its last recorded period of sixteen phases."""
    rows = numpy.flatnonzero(table["instance"] == instance)[-16:]
    t = numpy.linspace(0, 1, len(rows) + 1)
    rows = numpy.append(rows[-1], rows)  # the period closes
    depth = numpy.linspace(0, 1, DEPTHS)
    r = 1 + (OUTER - 1) * depth**2
    temperature = numpy.array([table[f"T_{k}"][rows] for k in range(DEPTHS)])
    image = axis.contourf(t, r, temperature, levels=numpy.linspace(0, 1, 21), cmap="inferno")
    axis.contour(t, r, temperature, levels=[0.1, 0.3, 0.5, 0.7, 0.9], colors="white", linewidths=0.4)
    axis.set_title(rf"$a = {table['diffusivity'][rows[0]]:.3g}$,  {flow_name(0, table['pulse'][rows[0]])}", fontsize=9)
    axis.set_xlabel(r"time $t$ (periods)")
    axis.set_ylabel(r"radius $r$ (–)")
    axis.set_ylim(1, 2)
    return image


def draw(pyplot, numpy, table, _comments):
    """Returns the figure: heat flows above, temperatures of two diffusivities below."""
    last_rows = table["phase"] == table["phase"].max()
    last = {name: values[last_rows] for name, values in table.items()}
    figure, ((flow, gain), maps) = pyplot.subplots(2, 2, figsize=(7.2, 6), layout="constrained")
    draw_heat_flow(numpy, flow, last)
    draw_gain(gain, last)
    strongest = table["instance"][table["pulse"] == table["pulse"].max()]
    shown, rows = numpy.unique(strongest, return_counts=True)
    shown = shown[rows == rows.max()]
    for axis, instance in zip(maps, (shown[0], shown[len(shown) // 2])):
        image = draw_map(numpy, axis, table, instance)
    bar = figure.colorbar(image, ax=maps, ticks=numpy.linspace(0, 1, 6), pad=0.02)
    bar.set_label(r"temperature $T$ (of the wall)")
    for axis, letter in zip((flow, gain, *maps), "abcd"):
        axis.text(-0.02, 1.03, f"({letter})", transform=axis.transAxes, fontsize=9)
    return figure


if __name__ == "__main__":
    figures.main(__doc__, "heat_conduction", COLUMNS, draw)
