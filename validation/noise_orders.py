#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Orders of the methods for stochastic equations, by paths: strong errors against solutions that are functions of the
path, or by much shorter steps along it, weak ones against means in closed form.

Usage: noise_orders.py PICTURE [--device DEVICE] [--paths N]

Draws the errors over the length of steps, and prints the slope of each line with its standard error."""

import argparse

import numpy as np

import myriad_ode as my

x, y, w = my.states("x y w")
W1, W2 = my.wiener("W1 W2")
t = my.time
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
# Two processes that do not commute: E x^2 at t = 1 is that of a linear system of moments.
a, b, c, d = -1.0, 1.0, 0.5, 0.5
crossed = my.model({x: a * x, y: a * y}, noise={x: {W1: b * x, W2: c * y}, y: {W1: c * y, W2: d * x}}, name="crossed")
weak = [("euler_maruyama", 1.0, (8, 16, 32, 64)), ("dri1", 2.0, (2, 3, 4, 6))]  # numbers of steps


def mean_square():
    """E x^2 at t = 1 from x = 1, y = 0.5, by the equations of the second moments."""
    matrix = np.array([[2 * a + b * b, c * c], [d * d, 2 * a + c * c]])  # of E x^2 and E y^2
    values, vectors = np.linalg.eig(matrix)
    return (vectors @ np.diag(np.exp(values)) @ np.linalg.solve(vectors, [1.0, 0.25])).real[0]


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


def weak_errors(method, lengths, paths, device):
    """The same of the mean of x^2."""
    squares = np.array([my.solve(crossed, start={x: 1, y: 0.5}, time=(0, 1), method=method, step=float(h), seed=2,
                                 size=paths, device=device)["x"]**2 for h in lengths])
    return np.abs(squares.mean(axis=1) - mean_square()), squares.std(axis=1) / np.sqrt(paths)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("picture")
    parser.add_argument("--device", default="auto")
    parser.add_argument("--paths", type=int, default=1000, help="5 N paths for strong errors, 4000 N for weak ones")
    arguments = parser.parse_args()
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    figure, (left, right) = plt.subplots(1, 2, figsize=(9, 4), layout="constrained")
    lengths = 2.0 ** -np.arange(6, 12)
    print("| method | equation | order | slope |\n|---|---|---|---|")
    for problem, method, order in lines:
        errors, deviations = strong_errors(problem, method, lengths, 5 * arguments.paths, arguments.device)
        found, error = slope(lengths, errors, deviations)
        left.loglog(lengths, errors, "o-", markersize=4, label=f"{method}, {problem}: {found:.2f}")
        print(f"| `{method}` | {problem} | strong {order:g} | {found:.3f} ± {error:.3f} |")
    for method, order, steps in weak:
        lengths = 1 / np.array(steps)
        errors, deviations = weak_errors(method, lengths, 4000 * arguments.paths, arguments.device)
        found, error = slope(lengths, errors, deviations)
        right.errorbar(lengths, errors, deviations, fmt="o-", markersize=4, label=f"{method}: {found:.2f}")
        print(f"| `{method}` | two processes that do not commute | weak {order:g} | {found:.3f} ± {error:.3f} |")
    right.set(xscale="log", yscale="log", ylabel="error of the mean of x² at t = 1")
    left.set_ylabel("mean error of paths at t = 1")
    for axes in (left, right):
        axes.set_xlabel("length of steps")
        axes.legend(fontsize=7)
    figure.savefig(arguments.picture, dpi=110)


if __name__ == "__main__":
    main()
