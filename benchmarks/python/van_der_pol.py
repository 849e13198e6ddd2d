#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Times a grid of 1 048 576 van der Pol oscillators on a GPU, from NumPy arrays to NumPy arrays, by Myriad's Python
package and, where it is installed, by CuBIE: x0 from 1 to 2 by mu from 1 to 3, 1024 values of each, until t = 20, by
Dormand and Prince's method of order five, relative tolerance 1e-3, absolute tolerance 1e-6.

Writes rows "program,precision,what,milliseconds": the first call with an empty cache ("cold"), and medians of later
calls: "call" until the report, "call and results" until both states are NumPy arrays, "kernel" the GPU's own clock.
CuBIE has the grid by name too; it always returns the initial states with the final ones."""

import argparse
import contextlib
import io
import os
import re
import statistics
import subprocess
import sys
import tempfile
import time

import numpy as np

SIDE = 1024
LIMITS = {("double", "call and results"): 12, ("float", "call and results"): 9}  # milliseconds on an H200


def rows(program, precision, cold, calls):
    """The rows of one program: seconds of its first call, and of others by name."""
    yield program, precision, "cold", 1e3 * cold
    for what in calls[0]:
        yield program, precision, what, 1e3 * statistics.median(call[what] for call in calls)


def by_myriad(precision, device, side, calls):
    import myriad_ode as my

    x, v, mu = *my.states("x v"), my.parameter("mu")
    model = my.model({x: v, v: mu * (1 - x * x) * v - x})
    x_values, mu_values = np.linspace(1, 2, side), np.linspace(1, 3, side)
    last = None

    def call():
        nonlocal last
        begin = time.perf_counter()
        last = my.solve(model, my.grid({x: x_values, mu: mu_values}), start={v: 0}, time=(0, 20),
                        method="dormand_prince_5", rtol=1e-3, atol=1e-6, precision=precision, device=device)
        done = time.perf_counter()
        results = last["x"], last["v"]
        there = time.perf_counter()
        assert np.isfinite(results).all() and last.report.failed == 0
        kernel = last.report.kernel_seconds or last.report.seconds  # a CPU has no time of its own for kernels
        return {"call": done - begin, "call and results": there - begin, "kernel": kernel}

    begin = time.perf_counter()
    call()
    cold = time.perf_counter() - begin
    kernel = last.report.kernel
    measured = [call() for _ in range(calls)]
    yield from rows("Myriad", precision, cold, measured)
    print(f"{precision}: first kernel {kernel}; {last.report}", file=sys.stderr)


def by_cubie(precision, side, calls):
    import cubie

    system = cubie.create_ODE_system(["dx = v", "dv = mu * (1 - x * x) * v - x"], states={"x": 1.0, "v": 0.0},
                                     parameters={"mu": 1.0},
                                     precision={"double": np.float64, "float": np.float32}[precision])
    solver = cubie.Solver(system, algorithm="rk45", rtol=1e-3, atol=1e-6)
    start, parameters = {"x": np.linspace(1, 2, side), "v": [0.0]}, {"mu": np.linspace(1, 3, side)}

    def call():
        begin = time.perf_counter()
        done = solver.solve(start, parameters, duration=20.0, grid_type="combinatorial")
        results = done.time_domain_array[-1]  # the first rows are the initial states
        there = time.perf_counter()
        assert np.isfinite(results).all()  # those that fail are NaN
        return {"call and results": there - begin}

    def kernel():
        """The same call with CuBIE's log of times, which has the kernel's."""
        log = io.StringIO()
        cubie.default_timelogger.set_verbosity("default")
        with contextlib.redirect_stdout(log):
            call()
        cubie.default_timelogger.set_verbosity(None)
        return {"kernel": 1e-3 * float(re.search(r"([0-9.]+)ms kernel", log.getvalue())[1])}

    begin = time.perf_counter()
    call()
    cold = time.perf_counter() - begin
    measured = [call() for _ in range(calls)]
    kernels = [kernel() for _ in range(calls)]  # later: the log takes time too
    yield from rows("CuBIE", precision, cold, [one | other for one, other in zip(measured, kernels)])


def in_a_process(program, precision, options):
    """The rows of one program in a process of its own, with an empty cache."""
    with tempfile.TemporaryDirectory() as cache:
        command = [sys.executable, __file__, "--only", program, precision, "--side", str(options.side), "--calls",
                   str(options.calls), "--device", options.device]
        caches = {"MYRIAD_CACHE_DIR": cache, "CUBIE_CACHE_DIR": cache}
        done = subprocess.run(command, env={**os.environ, **caches}, stdout=subprocess.PIPE, text=True, check=False)
        return done.returncode, done.stdout.splitlines()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--side", type=int, default=SIDE, help="values of x0 and of mu (default: 1024)")
    parser.add_argument("--calls", type=int, default=20, help="calls that are timed (default: 20)")
    parser.add_argument("--device", default="cuda", help="Myriad's device (default: cuda)")
    parser.add_argument("--output", help="file for the rows (default: standard output alone)")
    parser.add_argument("--check", action="store_true",
                        help="exit status 1 if Myriad takes longer than it should on an H200")
    parser.add_argument("--only", nargs=2, metavar=("PROGRAM", "PRECISION"),
                        help="one of the measurements, in this process")
    options = parser.parse_args()
    if options.only:
        program, precision = options.only
        made = by_cubie(precision, options.side, options.calls) if program == "cubie" else by_myriad(
            precision, options.device, options.side, options.calls)
        for name, real, what, milliseconds in made:
            print(f"{name},{real},{what},{milliseconds:.3f}")
        return 0
    lines, failed = ["program,precision,what,milliseconds"], 0
    import importlib.util
    programs = ["myriad"] + (["cubie"] if importlib.util.find_spec("cubie") else [])
    for program in programs:
        for precision in ("double", "float"):
            status, told = in_a_process(program, precision, options)
            failed |= status != 0
            lines += told
    print("\n".join(lines))
    if options.output:
        with open(options.output, "w", encoding="utf-8") as file:
            file.write("\n".join(lines) + "\n")
    for (precision, what), limit in LIMITS.items() if options.check else ():
        taken = [float(line.rpartition(",")[2]) for line in lines if line.startswith(f"Myriad,{precision},{what},")]
        if not taken or taken[0] > limit:
            print(f"{precision}: {what} took {taken or 'nothing'} ms, and may take {limit}", file=sys.stderr)
            failed = True
    return int(failed)


if __name__ == "__main__":
    sys.exit(main())
