#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Times the Pleiades problem, seven stars in a plane (Hairer, Norsett, Wanner, Solving ODE I, II.10), for many masses
of the first star. In a few instances two stars nearly collide, so that they need far more steps than the others: the
call must end nevertheless, with the default `max_steps` and no other option, and in time where `time_limit` is given.

With --check exit status 1 if a call takes longer than it should on an H200."""

import argparse
import sys
import time

import numpy as np

import myriad_ode as my

SECONDS, LIMIT, LATENCY = 60.0, 1.0, 1.0  # of the whole call; a time limit, and how much later it may take effect


def pleiades():
    stars = range(1, 8)
    x, y, u, v = (np.array(my.states([f"{name}{i}" for i in stars])) for name in "xyuv")
    mass = [my.parameter("m1"), *range(2, 8)]
    slopes = {**dict(zip(x, u)), **dict(zip(y, v))}
    for i in range(7):
        ax = ay = 0
        for j in range(7):
            if i == j:
                continue
            dx, dy = x[j] - x[i], y[j] - y[i]
            square = dx * dx + dy * dy
            strength = mass[j] / (square * my.sqrt(square))
            ax, ay = ax + strength * dx, ay + strength * dy
        slopes[u[i]], slopes[v[i]] = ax, ay
    start = [3, 3, -1, -3, 2, -2, 2, 3, -3, 2, 0, 0, -4, 4, 0, 0, 0, 0, 0, 1.75, -1.5, 0, 0, 0, -1.25, 1, 0, 0]
    model = my.model(slopes, name="pleiades")
    return model, mass[0], dict(zip([*x, *y, *u, *v], start))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--instances", type=int, default=131_072, help="default: 131072")
    parser.add_argument("--device", default="cuda", help="default: cuda")
    parser.add_argument("--method", default="dormand_prince_8", help="default: dormand_prince_8")
    parser.add_argument("--max-steps", type=int, nargs="*", default=[20_000], help="tried beside the default")
    parser.add_argument("--check", action="store_true",
                        help="exit status 1 if a call takes longer than it should on an H200")
    options = parser.parse_args()
    model, m1, start = pleiades()

    def call(instances, **more):
        began = time.perf_counter()
        run = my.solve(model, {m1: np.linspace(0.5, 2, instances)}, start=start, time=(0, 3), rtol=1e-6, atol=1e-6,
                       method=options.method, device=options.device, **more)
        seconds = time.perf_counter() - began
        names = run.status
        counts = ", ".join(f"{count} {name}" for name, count in zip(*np.unique(names, return_counts=True)))
        print(f"{instances} instances {more}: {seconds:.3f} s, kernel {run.report.kernel_seconds:.3f} s; {counts}",
              flush=True)
        return seconds

    call(32)  # compiles
    slow = call(options.instances) > SECONDS
    for steps in options.max_steps:
        call(options.instances, max_steps=steps)
    slow |= call(options.instances, time_limit=LIMIT) > LIMIT + LATENCY
    if options.check and slow:
        print(f"may take {SECONDS:g} s, and {LATENCY:g} s more than a time limit", file=sys.stderr)
    return int(options.check and slow)


if __name__ == "__main__":
    sys.exit(main())
