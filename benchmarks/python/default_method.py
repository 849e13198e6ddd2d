# SPDX-License-Identifier: MIT
"""Which method a call should have that names none: error against work on ten smooth problems of 1024 instances each, on
one core. Prints the tables of docs/methods.md#the-default. Errors are the median over instances of the largest error of
a state at the end, over the state's size, against dormand_prince_8 at 1e-13; ratios are geometric means over the
problems that reach an error, of work interpolated between tolerances, relative to dormand_prince_5."""

import argparse

import numpy as np

import myriad_ode as my

METHODS = ["cash_karp", "dormand_prince_5", "tsitouras_5", "verner_7", "dormand_prince_8"]
TOLERANCES = [10.0**-n for n in range(3, 10)]
ERRORS = [10.0**-n for n in range(3, 9)]
N = 1024
t = my.time


def problems():
    """{name: model, sweep, start, end}"""
    x, y, z, u, v = my.states("x y z u v")
    k = my.parameter("k")

    def along(low, high):
        return {k: np.linspace(low, high, N)}

    cube, e = (x * x + y * y) ** 1.5, np.linspace(0, 0.8, N)
    d = x - y
    a = my.states([f"a_{i}" for i in range(8)])
    return {
        "lorenz": ({x: 10 * (y - x), y: x * (k - z) - y, z: x * y - 8 / 3 * z}, along(20, 30), {x: 1, y: 1, z: 1}, 3),
        "duffing": ({x: v, v: x - x**3 - k * v + 0.3 * my.cos(t)}, along(0.2, 0.3), {x: -0.5, v: -0.1}, 20),
        "van der pol": ({x: v, v: k * (1 - x * x) * v - x}, along(0.5, 5), {x: 2, v: 0}, 15),
        "kepler": ({x: u, y: v, u: -x / cube, v: -y / cube}, {}, {x: 1 - e, y: 0, u: 0, v: np.sqrt((1 + e) / (1 - e))},
                   15),
        "bubble": ({x: v, v: (1.02 * x**-3.9 - 1 - 0.4 * my.sin(2 * my.pi * k * t) - 0.05 / x - 0.02 * v / x) / x -
                    1.5 * v * v / x}, along(0.05, 0.2), {x: 1, v: 0}, 40),
        "lotka-volterra": ({x: x * (k - y), y: y * (x - 1)}, along(0.5, 2), {x: 1, y: 2}, 20),
        "pendula": ({x: u, y: v,
                     u: (-9.81 * my.sin(x) - my.sin(d) * (v * v + u * u * my.cos(d)) * k) / (1 + k * my.sin(d)**2),
                     v: my.sin(d) * (u * u * (1 + k) + 19.62 * my.cos(x) + v * v * my.cos(d) * k) /
                     (1 + k * my.sin(d)**2)}, along(0.1, 0.9), {x: 0.9, y: 0.5, u: 0, v: 0}, 4),
        "fitzhugh-nagumo": ({x: x - x**3 / 3 - y + k, y: 0.08 * (x + 0.7 - 0.8 * y)}, along(0, 1.2), {x: -1, y: -0.5},
                            80),
        "phases": ({a[i]: w + k / 8 * sum(my.sin(b - a[i]) for b in a) for i, w in enumerate(np.linspace(-1, 1, 8))},
                   along(0.5, 3), {b: 0.7 * i for i, b in enumerate(a)}, 15),
        "linear": ({x: v, v: -k * k * x - 0.1 * v}, along(1, 3), {x: 1, v: 0}, 20),
    }


def measure(equations, sweep, start, end, repeats):
    """{method: [(error, evaluations per instance, seconds) for each tolerance]}"""
    model, call = my.model(equations), dict(start=start, time=(0, end), device="cpu:1")
    exact = np.array(list(my.solve(model, sweep, method="dormand_prince_8", rtol=1e-13, atol=1e-14,
                                   **call).states.values()))
    size = np.abs(exact).max(axis=1, keepdims=True)

    def point(method, tolerance):
        runs = [my.solve(model, sweep, method=method, rtol=tolerance, atol=tolerance, **call) for _ in range(repeats)]
        error = np.abs(np.array(list(runs[0].states.values())) - exact) / size
        return (float(np.median(error.max(axis=0))), float(runs[0].rhs_evaluations.mean()),
                min(run.report.seconds for run in runs))

    return {method: [point(method, tolerance) for tolerance in TOLERANCES] for method in METHODS}


def work_at(points, error, column):
    """The logarithm of the work at an error; NaN where no tolerance has it."""
    errors, work = np.log([p[0] for p in points]), np.log([p[column] for p in points])
    order = np.argsort(errors)
    return np.interp(np.log(error), errors[order], work[order], left=np.nan, right=np.nan)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--repeats", type=int, default=4, help="of each call, of which the fastest counts")
    measured = [measure(*p, parser.parse_args().repeats) for p in problems().values()]
    for column, what in ((1, "evaluations"), (2, "time")):
        print(f"\n{what} at an error of | " + " | ".join(f"{e:.0e}" for e in ERRORS))
        for method in METHODS:
            ratios = [np.nanmean([work_at(m[method], e, column) - work_at(m["dormand_prince_5"], e, column)
                                  for m in measured]) for e in ERRORS]
            print(f"{method} | " + " | ".join(f"{np.exp(r):.2f}" for r in ratios))
    print("\nerror over tolerance at | " + " | ".join(f"{e:.0e}" for e in TOLERANCES))
    for method in METHODS:
        means = [np.exp(np.mean([np.log(m[method][i][0] / e) for m in measured])) for i, e in enumerate(TOLERANCES)]
        print(f"{method} | " + " | ".join(f"{mean:.2f}" for mean in means))


if __name__ == "__main__":
    main()
