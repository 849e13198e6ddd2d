#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Stochastic equations beside their known moments, by all methods that take them.

Usage: noise_problems.py [--device DEVICE] [--paths N]

Prints, for each quantity, how far its mean over the paths is from the known one with two lengths of steps, and its
standard error. Exits with 1 if one is further off than four standard errors and the error of the method: that of a step
of length one, as the problem allows it, times the step to the method's weak order."""

import argparse
import sys
from typing import NamedTuple

import numpy as np

import myriad_ode as my

x, y, t = my.state("x"), my.state("y"), my.time
W, V = my.wiener("W V")
nodes, weights = np.polynomial.hermite_e.hermegauss(80)
weights = weights / weights.sum()
diagonal = {"euler_maruyama": 1, "milstein": 1, "sriw1": 1.5, "dri1": 2, "linearly_implicit_euler_maruyama": 1}
general = {"euler_maruyama": 1, "dri1": 2, "linearly_implicit_euler_maruyama": 1}
additive = {**diagonal, "stochastic_heun": 1, "sra1": 2}


class Problem(NamedTuple):
    """An equation from t = 0, quantities of its end with their means, and the methods with their weak orders. `allowed`
    is the error of a step of length one."""

    name: str
    model: object
    start: dict
    end: float
    known: dict
    methods: dict
    allowed: float


def problems():
    """Kloeden and Platen, Numerical Solution of Stochastic Differential Equations, 4.4, has most of the solutions."""
    root2 = np.sqrt(2)
    of_tanh = (weights * np.tanh(0.5 + 0.5 * nodes)).sum(), (weights * np.tanh(0.5 + 0.5 * nodes)**2).sum()
    rate, width, mean = 2.0, 0.5, 1.0  # of the processes that return to a mean
    fade = np.exp(-rate)
    of_cir = (width**2 / rate * (0.5 * (fade - fade**2) + mean / 2 * (1 - fade)**2), mean + (0.5 - mean) * fade)
    linear = my.model({x: -x}, noise={x: 0.5 * x})
    yield Problem("linear, Ito", linear, {x: 1}, 1, {"x": np.exp(-1), "x^2": np.exp(-1.75)}, diagonal, 1)
    yield Problem("linear, Stratonovich", linear, {x: 1}, 1, {"x": np.exp(-0.875), "x^2": np.exp(-1.5)},
                  {"stochastic_heun": 1}, 1)
    yield Problem("two states on a circle", my.model({x: -x / 2, y: -y / 2}, noise={x: {W: -y}, y: {W: x}}),
                  {x: 1, y: 0}, 1, {"x": np.exp(-0.5), "x^2": (1 + np.exp(-2)) / 2}, general, 1)
    yield Problem("cubic drift", my.model({x: -x * (1 - x**2) / 4}, noise={x: (1 - x**2) / 2}), {x: np.tanh(0.5)}, 1,
                  {"x": of_tanh[0], "x^2": of_tanh[1]}, {m: o for m, o in diagonal.items() if m != "milstein"}, 2)
    yield Problem("additive, in time", my.model({x: 0.9 / my.sqrt(1 + t) - x / (2 * (1 + t))},
                                                noise={x: 0.63 / my.sqrt(1 + t)}), {x: 1}, 1,
                  {"x": 1.9 / root2, "x^2": 1.9**2 / 2 + 0.63**2 / 2}, additive, 1)
    yield Problem("stiff, x^2 / 2 as a potential", my.model({x: -50 * x}, noise={x: 1.0}), {x: 1}, 1,
                  {"x": 0.0, "x^2": 0.01}, {"linearly_implicit_euler_maruyama": 1}, 0.3)
    yield Problem("noise that does not commute", my.model(
        {x: -273 / 512 * x, y: -x / 160 + (root2 / 8 - 785 / 512) * y},
        noise={x: {W: x / 4, V: x / 16}, y: {W: (1 - 2 * root2) / 4 * y, V: x / 10 + y / 16}}), {x: 1, y: 1}, 3,
        {"x^2": np.exp(-3)}, general, 1)
    yield Problem("Ornstein-Uhlenbeck", my.model({x: rate * (mean - x)}, noise={x: width}), {x: 0.5}, 1,
                  {"x": of_cir[1], "x^2": of_cir[1]**2 + width**2 * (1 - fade**2) / (2 * rate)}, additive, 2)
    yield Problem("Cox-Ingersoll-Ross", my.model({x: rate * (mean - x)}, noise={x: width * my.sqrt(my.maximum(x, 0))}),
                  {x: 0.5}, 1, {"x": of_cir[1], "x^2": of_cir[1]**2 + of_cir[0]},
                  {"euler_maruyama": 1, "linearly_implicit_euler_maruyama": 1}, 2)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--device", default="auto")
    parser.add_argument("--paths", type=int, default=200_000, help="default: %(default)s")
    arguments = parser.parse_args()
    well = True
    print("| equation | method | mean of | known | step 1/8 | step 1/32 |\n|---|---|---|---|---|---|")
    for problem in problems():
        for method, order in problem.methods.items():
            off = {name: [] for name in problem.known}
            for seed, parts in enumerate((8, 32)):
                run = my.solve(problem.model, start=problem.start, time=(0, problem.end), paths=arguments.paths,
                               step=1 / parts, seed=seed, method=method, device=arguments.device)
                for name, known in problem.known.items():
                    values = run["x"]**2 if name == "x^2" else run["x"]
                    error = values.std() / np.sqrt(values.size)
                    difference = values.mean() - known
                    well = well and abs(difference) < 4 * error + problem.allowed * parts**-float(order)
                    off[name].append(f"{difference:+.5f} ± {error:.5f}")
            for name, known in problem.known.items():
                print(f"| {problem.name} | `{method}` | {name} | {known:.5f} | {' | '.join(off[name])} |", flush=True)
    return 0 if well else 1


if __name__ == "__main__":
    sys.exit(main())
