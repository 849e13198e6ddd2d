#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Errors and times of the methods of high order for Lorenz' equations to t = 10, the table of docs/methods.md: the
median error of x in 8192 instances against verner_9 at a tolerance of 3e-14, and the best of four calls.

Usage: smallest_errors.py [DEVICE]"""

import sys
import time

import numpy as np

import myriad_ode as my

INSTANCES, CALLS = 8192, 4
x, y, z = my.states("x y z")
r = my.parameter("r")
lorenz = my.model({x: 10 * (y - x), y: x * (r - z) - y, z: x * y - 8 / 3 * z}, name="lorenz")


def solved(method, tolerance, device):
    return my.solve(lorenz, {r: np.linspace(0.5, 28, INSTANCES)}, start={x: 1.0, y: 0.0, z: 0.0}, time=(0, 10),
                    method=method, rtol=tolerance, atol=tolerance, device=device)[x]


def main():
    device = sys.argv[1] if len(sys.argv) > 1 else "cpu"
    reference = solved("verner_9", 3e-14, device)
    print("dormand_prince_8 at 3e-14 differs by", np.median(abs(solved("dormand_prince_8", 3e-14, device) - reference)))
    print("method,tolerance,median_error,milliseconds")
    for method in ("verner_7", "dormand_prince_8", "verner_9"):
        for tolerance in (1e-8, 1e-10, 1e-11, 1e-12, 1e-13):
            seconds = []
            for _ in range(CALLS):
                begin = time.perf_counter()
                found = solved(method, tolerance, device)
                seconds.append(time.perf_counter() - begin)
            error = np.median(abs(found - reference))
            print(f"{method},{tolerance:g},{error:.2g},{1e3 * min(seconds):.3g}", flush=True)


if __name__ == "__main__":
    main()
