#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Draws the Lyapunov exponents that the program `lyapunov` computed over rho.

Usage: plot.py CSV PNG

Needs matplotlib, and numpy, which comes with it (Debian: python3-matplotlib). Exit status 2, and no picture, if
something is missing or wrong.
"""

import sys

HEADER = "instance,rho,lambda_1,lambda_2,lambda_3,status"


def read_table(path):
    """Returns rho and the exponents, one column each."""
    import numpy
    with open(path, encoding="utf-8") as file:
        lines = [line for line in file if not line.startswith("#")]
    if not lines or lines[0].strip() != HEADER:
        raise ValueError(f"{path} is no table of the program `lyapunov`, whose header is {HEADER}")
    table = numpy.loadtxt(lines[1:], delimiter=",", usecols=(1, 2, 3, 4), ndmin=2)
    return table[:, 0], table[:, 1:]


def draw(rho, exponents):
    """Returns the figure: the two largest exponents above, the smallest below."""
    import matplotlib
    matplotlib.use("Agg")  # no display needed
    from matplotlib import pyplot
    pyplot.rcParams.update({
        "font.family": "serif", "font.serif": ["STIXGeneral", "DejaVu Serif"], "mathtext.fontset": "stix",
        "font.size": 9, "axes.linewidth": 0.6, "xtick.direction": "in", "ytick.direction": "in",
    })
    figure, (upper, lower) = pyplot.subplots(2, 1, sharex=True, figsize=(7.2, 5), height_ratios=(2, 1),
                                             layout="constrained")
    upper.axhline(0, color="0.6", linewidth=0.6)
    upper.plot(rho, exponents[:, 1], linewidth=0.7, color="#c05020", label=r"$\lambda_2$")
    upper.plot(rho, exponents[:, 0], linewidth=0.7, color="#10305a", label=r"$\lambda_1$")
    upper.set_ylim(-1.5, None)
    upper.set_ylabel(r"$\lambda_1$, $\lambda_2$ (per unit of time)")
    upper.legend(loc="upper left", frameon=False)
    lower.plot(rho, exponents[:, 2], linewidth=0.7, color="#307040")
    lower.set_ylabel(r"$\lambda_3$ (per unit of time)")
    lower.set_xlabel(r"$\rho$ (–)")
    lower.set_xlim(rho.min(), rho.max() if rho.max() > rho.min() else rho.min() + 1)
    upper.set_title(r"Lyapunov exponents of Lorenz' equations, $\sigma = 10$, $\beta = 8/3$", fontsize=11)
    return figure


def main(arguments):
    if len(arguments) != 2 or arguments[0] in ("-h", "--help"):
        print(__doc__.strip())
        return 0 if arguments[:1] in (["-h"], ["--help"]) else 2
    try:
        draw(*read_table(arguments[0])).savefig(arguments[1], dpi=200)
    except ImportError as error:
        print(f"{error.name} is missing for {sys.executable}: install it (Debian, Ubuntu: apt-get install "
              "python3-matplotlib), or run this with a Python that has it, as /usr/bin/python3", file=sys.stderr)
        return 2
    except (OSError, ValueError, IndexError) as error:
        print(f"{error}; run the program `lyapunov` first", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
