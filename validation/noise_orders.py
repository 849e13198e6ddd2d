#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Strong orders of the methods for stochastic equations: mean errors of paths, against solutions that are functions of
the path, or against much shorter steps along it.

Usage: noise_orders.py PICTURE [--device DEVICE] [--paths N]

Draws the errors over the length of steps, and prints the slope of each line with its standard error."""

import argparse

import numpy as np

import myriad_ode as my

x, w = my.states("x w")
drift, factor = -0.5, 1.0
# Solutions by the value w of the process at t = 1 (Kloeden and Platen, Numerical Solution of Stochastic Differential
# Equations, 4.4).
strong = {
    "linear, Ito": (my.model({x: drift * x}, noise={x: factor * x}),
                    lambda end: np.exp(drift - factor**2 / 2 + factor * end)),
    "linear, Stratonovich": (my.model({x: drift * x}, noise={x: factor * x}),
                             lambda end: np.exp(drift + factor * end)),
    "double well, additive": (my.model({x: x - x**3}, noise={x: 0.5}), None),
}
lines = [("linear, Ito", "euler_maruyama", 0.5), ("linear, Ito", "milstein", 1.0), ("linear, Ito", "sriw1", 1.5),
         ("linear, Ito", "linearly_implicit_euler_maruyama", 0.5), ("linear, Stratonovich", "stochastic_heun", 1.0),
         ("double well, additive", "euler_maruyama", 1.0), ("double well, additive", "sra1", 1.5),
         ("double well, additive", "linearly_implicit_euler_maruyama", 1.0)]


def slope(lengths, errors, deviations):
    """Of log(error) over log(length), and its standard error."""
    weights = np.asarray(errors) / np.asarray(deviations)
    (found, _), covariance = np.polyfit(np.log(lengths), np.log(errors), 1, w=weights, cov="unscaled")
    return found, np.sqrt(covariance[0, 0])


def strong_errors(problem, method, lengths, paths, device):
    """Mean errors at the end, and their standard errors."""
    model, solution = strong[problem]
    shortest = float(lengths[-1] / 16)
    call = dict(time=(0, 1), noise_step=shortest, seed=1, size=paths, device=device)
    if solution is None:
        exact = my.solve(model, start={x: 1}, method="sra1", step=shortest, **call)["x"]
    else:  # of the same path: process 0 of the same instances
        exact = solution(my.solve(my.model({w: 0}, noise={w: 1}), start={w: 0}, method="euler_maruyama", step=shortest,
                                  **call)["w"])
    errors = np.array([np.abs(my.solve(model, start={x: 1}, method=method, step=float(h), **call)["x"] - exact)
                       for h in lengths])
    return errors.mean(axis=1), errors.std(axis=1) / np.sqrt(paths)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("picture")
    parser.add_argument("--device", default="auto")
    parser.add_argument("--paths", type=int, default=4000, help="default: %(default)s")
    arguments = parser.parse_args()
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    figure, axes = plt.subplots(figsize=(9, 4), layout="constrained")
    lengths = 2.0 ** -np.arange(6, 12)
    print("| method | equation | strong order | slope |\n|---|---|---|---|")
    for problem, method, order in lines:
        errors, deviations = strong_errors(problem, method, lengths, arguments.paths, arguments.device)
        found, error = slope(lengths, errors, deviations)
        axes.loglog(lengths, errors, "o-", markersize=4, label=f"{method}, {problem}: {found:.2f}")
        print(f"| `{method}` | {problem} | {order:g} | {found:.3f} ± {error:.3f} |")
    axes.set_xscale("log", base=2)
    axes.set(xlabel="length of steps", ylabel="mean error of paths at t = 1")
    axes.legend(fontsize=9, loc="center left", bbox_to_anchor=(1, 0.5))
    figure.savefig(arguments.picture, dpi=110)


if __name__ == "__main__":
    main()
