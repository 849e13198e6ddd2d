#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Draws the distribution of an epidemic's peak that the program `monte_carlo` sampled, and how fast its mean converges.

Usage: plot.py CSV PNG
"""

import pathlib
import re
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "common"))
import figure as figures  # pylint: disable=wrong-import-position

COLUMNS = ("instance", "R0", "duration", "peak", "day", "status")
BLUE, RED = "#10305a", "#c05020"


def constants(comments):
    """Mean and standard deviation of R0, the initial fraction of infectious people, and the exact mean and variance."""
    number = r"([-+.e\d]+)"
    found = [re.search(pattern, comments) for pattern in (
        rf"mean {number}, standard deviation {number};", rf"i\(0\) = {number},",
        rf"mean of the peak: found {number}, expected {number},",
        rf"variance of the peak: found {number}, expected {number},")]
    if not all(found):
        raise figures.PlotError("The comments at the top of the file lack constants: "
                                "run the program `monte_carlo` again")
    return (*map(float, found[0].groups()), float(found[1][1]), float(found[2][2]), float(found[3][2]))


def density(numpy, R0, mean, deviation, start):
    """The peak for R0 > 1 in closed form and its probability density, from that of R0."""
    peak = 1 - (1 + numpy.log(R0 * (1 - start))) / R0
    slope = numpy.log(R0 * (1 - start)) / R0 ** 2
    return peak, numpy.exp(-((R0 - mean) / deviation) ** 2 / 2) / (deviation * numpy.sqrt(2 * numpy.pi)) / slope


def convergence(numpy, errors):
    """Sizes n with at least ten disjoint samples; for each, the root mean square error of the samples' means,
    and the number of samples."""
    sizes = 2 ** numpy.arange(max(1, int(numpy.log2(max(errors.size / 10, 1))) + 1))
    means = [errors[:errors.size // n * n].reshape(-1, n).mean(axis=1) for n in sizes]
    return sizes, numpy.array([numpy.sqrt((m ** 2).mean()) for m in means]), errors.size // sizes


def draw(pyplot, numpy, table, comments):
    """Returns the figure: the peak's distribution, peak and day together, and the convergence of the mean."""
    mean, deviation, start, exact_mean, exact_variance = constants(comments)
    peak, day = 100 * table["peak"], table["day"]
    figure, (left, middle, right) = pyplot.subplots(1, 3, figsize=(10.5, 3.5), layout="constrained")

    bins = int(numpy.clip(2 * peak.size ** (1 / 3), 10, 200))
    left.hist(peak, bins=bins, density=True, color="#b8c8e0", label=f"{peak.size} epidemics")
    exact, height = density(numpy, numpy.linspace(max(1.05, mean - 5 * deviation), mean + 5 * deviation, 400), mean,
                            deviation,
                            start)
    left.plot(100 * exact, height / 100, color=BLUE, linewidth=1.2, label="exact")
    top = 1.45 * height.max() / 100
    for share, style in ((0.05, ":"), (0.5, "-"), (0.95, "--")):
        left.plot([numpy.quantile(peak, share)] * 2, [0, top / 1.45], color=RED, linewidth=0.9, linestyle=style,
                  label=f"{100 * share:g} % below")
    left.set_ylim(0, top)
    left.set_xlabel("infectious at the peak (% of the population)")
    left.set_ylabel("probability density (1/%)")
    left.legend(frameon=False, ncols=2, fontsize=7.5, loc="upper left")

    last = numpy.quantile(day, 0.995) if day.size > 1 else day[0] + 1
    counts, *borders = numpy.histogram2d(day, peak, bins=bins // 2 + 1, range=((0, last), (0, peak.max() or 1)),
                                         density=True)
    image = middle.pcolormesh(*borders, numpy.where(counts > 0, counts, numpy.nan).T, cmap="viridis", rasterized=True)
    figure.colorbar(image, ax=middle, label="probability density (1/% per day)", pad=0.02)
    middle.set_xlabel("day of the peak")
    middle.set_ylabel("infectious at the peak (%)")

    sizes, errors, samples = convergence(numpy, table["peak"] - exact_mean)
    expected, spread = 100 * numpy.sqrt(exact_variance / sizes), 2 / numpy.sqrt(2 * samples)
    right.fill_between(sizes, expected * numpy.maximum(1 - spread, 0.1), expected * (1 + spread), color="#b8c8e0",
                       linewidth=0,
                       label="twice the scatter expected")
    right.loglog(sizes, expected, color=BLUE, linewidth=1.2, label=r"exact standard deviation $/ \sqrt{N}$")
    right.loglog(sizes, 100 * errors, "o", markersize=3.5, color=RED, label="disjoint samples of that size")
    right.set_xlabel("sample size $N$")
    right.set_ylabel("error of the mean peak, r.m.s. (%)")
    right.legend(frameon=False, fontsize=8)
    return figure


if __name__ == "__main__":
    figures.main(__doc__, "monte_carlo", COLUMNS, draw)
