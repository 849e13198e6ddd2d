#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Runs known problems with delays at a tolerance and prints how far the results are from closed solutions, or from a
run by verner_7 at a much smaller one, in tolerances.

    validation/delays.py [--tolerance 1e-9] [--method dormand_prince_5] [--only A1]

The problems are those of DDETST without neutral terms: W. H. Enright, H. Hayashi, The evaluation of numerical software
for delay differential equations, in Quality of Numerical Software (1997) 179-193, as coded in SciML's
DDEProblemLibrary; and Wille and Baker's chain (J. Comput. Appl. Math. 43 (1992) 301-305). The package must be
installed. Exit status 1 if an error is above 100 tolerances.
"""
import argparse
import math
import sys
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np

import myriad_ode as my

t = my.time


@dataclass
class Problem:
    """A model, its domain, and its solution at the end if it is known."""

    equations: dict[Any, Any]
    begin: float
    end: float
    initial: dict[Any, float]
    history: dict[Any, Any] = field(default_factory=dict)
    exact: Callable[[float], list[float]] | None = None

    def at_end(self, method: str, tolerance: float) -> Any:
        """The run."""
        model = my.model(self.equations, history=self.history) if self.history else my.model(self.equations)
        return my.solve(model, start=self.initial, time=(self.begin, self.end), method=method, rtol=tolerance,
                      atol=tolerance, history_steps=8192)


def problems() -> dict[str, Problem]:
    """By their names."""
    u, v, w, z = my.states("u v w z")
    past = my.delayed
    a1 = past(u, 14)
    of = {"A1": Problem({u: 0.2 * a1 / (1 + a1**10) - 0.1 * u}, 0, 500, {u: 0.5})}
    leukemia = 10 * u / (1 + 40 * v)
    of["A2"] = Problem({u: 1.1 / (1 + math.sqrt(10) * past(u, 20)**1.25) - leukemia, v: 10 * leukemia - 2.43 * v},
                       0, 100, {u: 1.05767027 / 3, v: 1.030713491 / 3})
    of["B1"] = Problem({u: 1 - past(u, t - my.exp(1 - 1 / t))}, 0.1, 10, {u: math.log(0.1)}, {u: my.log(t)},
                       lambda end: [math.log(end)])
    of["B2"] = Problem({u: my.where(past(u, t / 2) < 0, 1, -1) - u}, 0, 2 * math.log(66), {u: 1.0},
                       exact=lambda end: [66 * math.exp(-end) - 1])
    of["C1"] = Problem({u: -2 * past(u, 1 + abs(u)) * (1 - u**2)}, 0, 30, {u: 0.5})
    c2 = past(u, v)
    of["C2"] = Problem({u: -2 * c2, v: (abs(c2) - abs(u)) / (1 + abs(c2))}, 0, 40, {u: 1.0, v: 0.5})
    for name, (s0, lag, gamma, q, k, a, end, u0, w0, before) in {
            "C3": (0.0031, 6.0, 0.001, 0.0275, 2.8, 6570, 300, 3.325, 120, my.where(t < -6, 9.5, 10)),
            "C4": (0.00372, 3.0, 0.1, 0.00178, 6.65, 15600, 100, 3.5, 50, None)}.items():
        of[name] = Problem({u: s0 * past(v, lag) - gamma * u - q, v: a / (1 + 0.0382 * u**6.96) - k * v,
                            w: 1 - q * my.exp(gamma * w) / (s0 * past(v, lag + w))},
                           0, end, {u: u0, v: 10.0, w: w0}, {} if before is None else {v: before})
    d1 = my.exp(1 - v)
    of["D1"] = Problem({u: v, v: -past(v, t - d1) * v**2 * d1}, 0.1, 5, {u: math.log(0.1), v: 10.0},
                       {u: my.log(t), v: 1 / t}, lambda end: [math.log(end), 1 / end])
    r1, r2, alpha, delta = 0.02, 0.005, 3, 0.01
    seen = past(u, z) * past(v, z)
    of["D2"] = Problem({u: -r1 * u * v + r2 * w, v: -r1 * u * v + alpha * r1 * seen, w: r1 * u * v - r2 * w,
                        z: 1 + (3 * delta - u * v - w) * my.exp(delta * z) / (seen + past(w, z))},
                       0, 40, {u: 5.0, v: 0.1, w: 0.0, z: 0.0})
    of["chain"] = Problem({u: past(u, 1), v: past(u, 1) + past(v, 0.2), w: v}, 0, 5, {u: 1.0, v: 1.0, w: 1.0})
    return of


def main() -> int:
    """The table."""
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("--tolerance", type=float, default=1e-9)
    options.add_argument("--method", default="dormand_prince_5")
    options.add_argument("--only")
    chosen = options.parse_args()
    print("problem,status,steps,rejected,error in tolerances")
    worst = 0.0
    for name, problem in problems().items():
        if chosen.only not in (None, name):
            continue
        run = problem.at_end(chosen.method, chosen.tolerance)
        names = [str(state) for state in problem.equations]
        found = np.array([run[state][0] for state in names])
        if problem.exact is not None:
            right = np.array(problem.exact(problem.end))
        else:
            tight = problem.at_end("verner_7", 1e-13)
            right = np.array([tight[state][0] for state in names])
        error = float(np.max(np.abs(found - right) / np.maximum(1, np.abs(right)))) / chosen.tolerance
        worst = max(worst, error) if error == error else math.inf
        print(f"{name},{run.status[0]},{run.accepted_steps[0]},{run.rejected_steps[0]},{error:.3g}", flush=True)
    return 0 if worst <= 100 else 1


if __name__ == "__main__":
    sys.exit(main())
