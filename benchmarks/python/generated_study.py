#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Times a study of 10^9 instances of Lorenz' equations from random starts, ten steps of Runge-Kutta 4 each, which the
model generates on the device and which are reduced there to a histogram and a mean: benchmarks/large_study by the
Python package. Prints seconds, nanoseconds for each instance, and the most memory of the host that the process had.

With --check exit status 1 if it takes longer or more memory than it should on an H200."""

import argparse
import resource
import statistics
import sys

import myriad_ode as my

SECONDS, GIGABYTES = 0.5, 2.0  # limits on an H200, on which the C++ program takes 0.19 s


def study(instances):
    x, y, z = my.states("x y z")
    rho = my.parameter("rho")
    lorenz = my.model({x: 10 * (y - x), y: x * (rho - z) - y, z: x * y - 8 / 3 * z}, name="lorenz",
                      generate={x: my.uniform(-10, 10), y: my.uniform(-10, 10), z: my.uniform(15, 35)})
    return my.study(lorenz, {rho: 28}, draws=instances, time=(0, 0.1), method="runge_kutta_4", step=0.01,
                    keep=dict(status=False),
                    reduce=[my.reduce.histogram("x_end", my.linspace(-20, 20, 129)), my.reduce.mean("x_end")])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--instances", type=int, default=1_000_000_000, help="default: 1000000000")
    parser.add_argument("--device", default="cuda", help="default: cuda")
    parser.add_argument("--beside", nargs="+", default=[], help="devices that take part in a second study, as cpu")
    parser.add_argument("--repetitions", type=int, default=1, help="of which the median counts; default: 1")
    parser.add_argument("--check", action="store_true",
                        help="exit status 1 if it takes longer or more memory than it should on an H200")
    options = parser.parse_args()
    together = [options.device, *options.beside]
    study(min(options.instances, 1_000_000)).run(device=together)  # compiles, and creates what the devices need
    seconds, seconds_together = [], []
    for _ in range(options.repetitions):
        result = study(options.instances).run(device=options.device)
        seconds.append(result.seconds)
        if options.beside:
            seconds_together.append(study(options.instances).run(device=together).seconds)
    taken = statistics.median(seconds)
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024 / 1e9
    counted = result["x_end_histogram"].sum() + result["x_end_outside"].sum()
    print(f"{options.instances} instances: {taken:.4f} s, {1e9 * taken / options.instances:.3f} ns "
          f"each; most memory of the host: {memory:.2f} GB; mean of x: {result['x_end_mean']:.6f}")
    if options.beside:
        print(f"with {' '.join(options.beside)} beside it: {statistics.median(seconds_together):.4f} s, "
              f"{statistics.median(seconds_together) / taken:.4f} times as long")
    wrong = not result.complete or counted != options.instances
    if wrong:
        print("WRONG: instances are missing", file=sys.stderr)
    slow = options.check and (taken > SECONDS or memory > GIGABYTES)
    if slow:
        print(f"may take {SECONDS} s and {GIGABYTES} GB", file=sys.stderr)
    return int(wrong or slow)


if __name__ == "__main__":
    sys.exit(main())
