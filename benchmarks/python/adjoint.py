#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""What the gradient of a loss costs by forward sensitivities without error control, and by an adjoint: times over those
of a call that gives the loss alone, and the largest difference of the two gradients in parts of the largest derivative.
The tables of docs/performance.md. Times are the best of several calls: processor time on CPUs, elapsed time on GPUs.

Usage: adjoint.py [--device DEVICE] [--instances N] [--calls N] [--problems NAME...] [--sizes N...]
       [--method NAME] [--tolerance NUMBER] [--most-forward N]"""

import argparse
import time

import numpy as np

import myriad_ode as my


def lotka_volterra(n):
    """n species, each of which competes with all others: n + n^2 parameters."""
    species = my.states([f"x{i}" for i in range(n)])
    growth = my.parameters([f"r{i}" for i in range(n)])
    effect = [my.parameters([f"a{i}_{j}" for j in range(n)]) for i in range(n)]
    model = my.model({x: x * (r - sum(a * z for a, z in zip(row, species)))
                      for x, r, row in zip(species, growth, effect)}, name="lotka_volterra")
    values = [1 + 0.1 * i for i in range(n)] + [1.0 if i == j else 0.3 + 0.1 * np.sin(i - 2 * j)
                                                for i in range(n) for j in range(n)]
    return model, [*growth, *(a for row in effect for a in row)], values, dict.fromkeys(species, 0.1), (0, 20)


def chain(n):
    """n substances, each made of the one before with a rate that saturates: n parameters."""
    substances = my.states([f"x{i}" for i in range(n)])
    rates = my.parameters([f"k{i}" for i in range(n)])
    flows = [k * x / (1 + x) for k, x in zip(rates, substances)]
    model = my.model({x: (flows[i - 1] if i else 0.0) - flows[i] for i, x in enumerate(substances)}, name="chain")
    start = {x: 10.0 if i == 0 else 0.1 for i, x in enumerate(substances)}
    return model, list(rates), list(1 + 0.5 * np.cos(np.arange(n))), start, (0, 20)


problems = {"lotka_volterra": (lotka_volterra, (2, 3, 4, 6)), "chain": (chain, (5, 10, 20, 40))}


def squares(function, rows):
    """The gradient of the sum of squares."""
    return function.vjp(rows, lambda found: 2 * found)[1]


def best(call, calls, clock):
    found = np.inf
    for _ in range(calls + 1):  # the first compiles
        begin = clock()
        result = call()
        found = min(found, clock() - begin)
    return found, result


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--device", default="cpu:1")
    parser.add_argument("--instances", type=int, default=4096)
    parser.add_argument("--calls", type=int, default=5)
    parser.add_argument("--method", default="tsitouras_5")
    parser.add_argument("--tolerance", type=float, default=1e-7)
    parser.add_argument("--problems", nargs="+", choices=problems, default=list(problems))
    parser.add_argument("--sizes", type=int, nargs="+", help="numbers of states")
    parser.add_argument("--most-forward", type=int, default=300, help="states with sensitivities, for which g++ takes "
                        "some minutes")
    options = parser.parse_args()
    clock = time.perf_counter if options.device.startswith("cuda") else time.process_time
    print("problem,states,parameters,milliseconds,forward,adjoint,difference")
    for name in options.problems:
        made, sizes = problems[name]
        for n in options.sizes or sizes:
            model, by, values, start, span = made(n)
            call = dict(free=by, of=list(start), start=start, time=span, samples=np.linspace(*span, 21)[1:],
                        method=options.method, rtol=options.tolerance, atol=options.tolerance, device=options.device)
            rows = values * np.random.default_rng(1).uniform(0.9, 1.1, (options.instances, len(values)))
            by_adjoint = my.batched(model, adjoint=True, **call)
            plain, _ = best(lambda f=by_adjoint: np.sum(f(rows)**2), options.calls, clock)  # noqa: B023
            cost, gradient = best(lambda f=by_adjoint: squares(f, rows), options.calls, clock)  # noqa: B023
            forward = difference = np.nan
            if n * (1 + len(by)) <= options.most_forward:
                function = my.batched(model, sensitivity_control=False, **call)
                forward, expected = best(lambda f=function: squares(f, rows), options.calls, clock)  # noqa: B023
                difference = np.abs((gradient - expected) / np.abs(expected).max(axis=1, keepdims=True)).max()
            print(f"{name},{n},{len(by)},{1e3 * plain:.1f},{forward / plain:.2f},{cost / plain:.2f},{difference:.1e}",
                  flush=True)


if __name__ == "__main__":
    main()
