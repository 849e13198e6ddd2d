#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Lorenz' equations with a delay on one core of a CPU, by Myriad and, where it is installed, by jitcdde:
x' = 10 (y(t - 13/28) - x), y' = 10 x - y - z x, z' = x y - 8/3 z to t = 10, with y = sin(2 pi t) - 8 before t = 0.

Prints microseconds per instance, the best of several runs of what is compiled already, and the error of x at the end
against `verner_7` at 1e-12. The steps of both end where the jumps of the derivatives arrive. The last line compares
both at equal errors, between tolerances along a straight line of logarithms."""

import argparse
import importlib.util
import time

import numpy as np

LAG, END, START = 13 / 28, 10, -8.0


def myriad(instances, tolerances):
    """The rows (tolerance, seconds per instance, error) of Myriad, and the reference."""
    import myriad_ode as my

    x, y, z = my.states("x y z")
    r = my.parameter("r")
    model = my.model({x: 10 * (my.delayed(y, LAG) - x), y: r * x - y - z * x, z: x * y - 8 / 3 * z},
                     history={y: my.sin(2 * np.pi * my.time) + START}, name="delayed_lorenz")

    def solve(values, method, tolerance):
        return my.solve(model, {r: values}, start={x: START, y: START, z: START}, time=(0, END), method=method,
                        rtol=tolerance, atol=tolerance, device="cpu:1", history_steps=1024)

    reference = solve([10.0], "verner_7", 1e-12)["x"][0]
    rows = []
    for tolerance in tolerances:
        many = 10 + np.linspace(0, 1e-9, instances)
        solve(many, "dormand_prince_5", tolerance)  # compiles, and allocates the past
        best = np.inf
        for _ in range(3):
            begin = time.perf_counter()
            run = solve(many, "dormand_prince_5", tolerance)
            best = min(best, time.perf_counter() - begin)
        rows.append((tolerance, best / instances, abs(run["x"][0] - reference)))
    return rows, reference


def jitcdde(reference, tolerances):
    """The rows of jitcdde, whose method has order three: tolerances at which the errors are similar are smaller."""
    import jitcdde as peer

    y, t = peer.y, peer.t
    slopes = [10 * (y(1, t - LAG) - y(0)), 10 * y(0) - y(1) - y(2) * y(0), y(0) * y(1) - 8 / 3 * y(2)]
    rows = []
    for tolerance in tolerances:
        best = np.inf
        for _ in range(2):
            dde = peer.jitcdde(slopes, verbose=False)
            dde.past_from_function(lambda s: np.array([START, np.sin(2 * np.pi * s) + START, START]),
                                   times_of_interest=np.linspace(-LAG, 0, 200))
            dde.set_integration_parameters(rtol=tolerance, atol=tolerance, first_step=1e-4, max_step=0.1)
            dde.compile_C(verbose=False)
            begin = time.perf_counter()
            dde.step_on_discontinuities()
            end = dde.integrate(END)
            best = min(best, time.perf_counter() - begin)
        rows.append((tolerance, best, abs(end[0] - reference)))
    return rows


def seconds_at(rows, error):
    """What an error costs, between the rows."""
    errors, seconds = (np.log([row[i] for row in sorted(rows, key=lambda row: row[2])]) for i in (2, 1))
    return np.exp(np.interp(np.log(error), errors, seconds))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--instances", type=int, default=512, help="of Myriad's calls (jitcdde integrates one)")
    instances = parser.parse_args().instances
    results = {}
    results["Myriad"], reference = myriad(instances, (1e-6, 1e-7, 1e-8))
    if importlib.util.find_spec("jitcdde"):
        results["jitcdde"] = jitcdde(reference, (1e-5, 1e-6, 1e-7))
    print("program,tolerance,microseconds per instance,error")
    for program, rows in results.items():
        for tolerance, seconds, error in rows:
            print(f"{program},{tolerance:g},{1e6 * seconds:.1f},{error:.2g}")
    if len(results) == 2:
        low, high = (choose(bound(row[2] for row in rows) for rows in results.values())
                     for choose, bound in ((max, min), (min, max)))
        for error in dict.fromkeys((low, high)) if low <= high else ():
            ratio = seconds_at(results["jitcdde"], error) / seconds_at(results["Myriad"], error)
            print(f"at an error of {error:.2g} jitcdde takes {ratio:.0f} times as long")


if __name__ == "__main__":
    main()
