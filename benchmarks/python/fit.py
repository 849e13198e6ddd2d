#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Measures a fit of 6 parameters of a stiff model of three states to 100 data points of each state from 1000 starts:
seconds, how many starts reach the minimum, and where the time goes. Robertson's reactions, in which `a` is fed and lost
and `c` decays, from t = 0.1 to 400; the starts are within a factor of ten of the parameters of the data, either way."""

import argparse
import cProfile
import pstats
import time

import numpy as np

import myriad_ode as my

a, b, c = my.states("a b c")
k1, k2, k3, feed, loss, decay = my.parameters("k1 k2 k3 feed loss decay")
back, fast = k3 * b * c, k2 * b * b
model = my.model({a: feed - loss * a - k1 * a + back, b: k1 * a - back - fast, c: fast - decay * c},
                 name="fed_robertson")
true = {k1: 0.04, k2: 3e7, k3: 1e4, feed: 1e-3, loss: 2e-3, decay: 5e-3}
start = {a: 1, b: 0, c: 0}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--starts", type=int, default=1000)
    parser.add_argument("--device", default="cpu", help="default: cpu")
    parser.add_argument("--profile", action="store_true", help="where the time goes, too")
    arguments = parser.parse_args()
    options = {"method": "rodas_5p", "rtol": 1e-6, "atol": {a: 1e-8, b: 1e-12, c: 1e-8}, "device": arguments.device}
    times = np.geomspace(0.1, 400, 100)
    run = my.solve(model, true, start=start, time=(0, 400), samples=times, **options)
    random = np.random.default_rng(1)
    data = {"t": times, **{x: run[x][0] * (1 + 0.02 * random.standard_normal(100)) for x in (a, b, c)}}
    sigma = {x: 0.02 * run[x][0] for x in (a, b, c)}

    def fit(starts: int) -> my.Fit:
        return my.fit(model, data, free={k: (value / 10, value * 10, "log") for k, value in true.items()},
                      starts=starts, start=start, sigma=sigma, **options)

    began = time.perf_counter()
    fit(2)  # compiles
    print(f"compiled, and two starts: {time.perf_counter() - began:.1f} s")
    profiler = cProfile.Profile()
    began = time.perf_counter()
    if arguments.profile:
        found = profiler.runcall(fit, arguments.starts)
    else:
        found = fit(arguments.starts)
    print(f"{arguments.starts} starts: {time.perf_counter() - began:.2f} s, {found.iterations.sum()} iterations of "
          f"starts, {found.iterations.max()} at most\n{found}")
    print("as they ended:", {status: found.status.count(status) for status in sorted(set(found.status))})
    if arguments.profile:
        pstats.Stats(profiler).sort_stats("tottime").print_stats(12)


if __name__ == "__main__":
    main()
