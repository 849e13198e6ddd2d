#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Gradients by the adjoint beside those of SUNDIALS CVODES' adjoint, which integrates the adjoint equations backwards.
The loss is the sum of the squares of all states, each over its typical size, at ten times. Prints the table of
docs/performance.md: errors relative to the largest derivative by the logarithm of a parameter, with CVODES' forward
sensitivities at 1e-12 as the reference, and microseconds of processor time per instance, on one core. The equations are
written once, here; SymPy makes the derivatives that CVODES needs from them, as C++. Needs SymPy, a C++ compiler and
SUNDIALS (libsundials-dev).

Usage: adjoint_cvodes.py [--instances N] [--calls N] [--tolerance NUMBER] [--problems NAME...]
Exit status 1 if an error is beyond a thousand times the tolerance."""

import argparse
import ctypes
import pathlib
import subprocess
import sys
import tempfile
import time

import numpy as np
import sympy
from sympy.codegen.rewriting import create_expand_pow_optimization

import myriad_ode as my

folder = pathlib.Path(__file__).parent


def robertson(y, k):
    slow, fast, back = k[0] * y[0], k[1] * y[1] * y[1], k[2] * y[1] * y[2]
    return [back - slow, slow - back - fast, fast]


def pollution(y, k):
    r = [a * b for a, b in zip(k, [
        y[0], y[1] * y[3], y[4] * y[1], y[6], y[6], y[6] * y[5], y[8], y[8] * y[5], y[10] * y[1], y[10] * y[0], y[12],
        y[9] * y[1], y[13], y[0] * y[5], y[2], y[3], y[3], y[15], y[15], y[16] * y[5], y[18], y[18], y[0] * y[3],
        y[18] * y[0], y[19]])]
    r.insert(0, None)  # reactions are counted from 1
    return [-r[1] - r[10] - r[14] - r[23] - r[24] + r[2] + r[3] + r[9] + r[11] + r[12] + r[22] + r[25],
            -r[2] - r[3] - r[9] - r[12] + r[1] + r[21], -r[15] + r[1] + r[17] + r[19] + r[22],
            -r[2] - r[16] - r[17] - r[23] + r[15], -r[3] + 2 * r[4] + r[6] + r[7] + r[13] + r[20],
            -r[6] - r[8] - r[14] - r[20] + r[3] + 2 * r[18], -r[4] - r[5] - r[6] + r[13], r[4] + r[5] + r[6] + r[7],
            -r[7] - r[8], -r[12] + r[7] + r[9], -r[9] - r[10] + r[8] + r[11], 1 * r[9], -r[11] + r[10], -r[13] + r[12],
            1 * r[14], -r[18] - r[19] + r[16], -r[20], 1 * r[20], -r[21] - r[22] - r[24] + r[23] + r[25],
            -r[25] + r[24]]


def hires(y, k):
    bound = k[9] * y[5] * y[7]
    return [-k[0] * y[0] + k[1] * y[1] + k[2] * y[2] + k[3], k[0] * y[0] - k[4] * y[1],
            -k[5] * y[2] + k[1] * y[3] + k[6] * y[4], k[2] * y[1] + k[0] * y[2] - k[7] * y[3],
            -k[8] * y[4] + k[1] * y[5] + k[1] * y[6],
            -bound + k[10] * y[3] + k[0] * y[4] - k[1] * y[5] + k[10] * y[6], bound - k[11] * y[6],
            k[11] * y[6] - bound]


def lotka_volterra(y, k):
    n = len(y)
    return [y[i] * (k[i] - sum(k[n + n * i + j] * y[j] for j in range(n))) for i in range(n)]


def chain(y, k):
    flows = [rate * x / (1 + x) for rate, x in zip(k, y)]
    return [(flows[i - 1] if i else 0.0) - flows[i] for i in range(len(y))]


def spread(n):
    return [1.0 if i == j else 0.3 + 0.1 * np.sin(i - 2 * j) for i in range(n) for j in range(n)]


# equations, initial values, parameters, times, whether they are stiff
problems = {
    "Robertson": (robertson, [1, 0, 0], [0.04, 3e7, 1e4], np.geomspace(0.04, 400, 10), True),
    "air pollution": (pollution, [0, 0.2, 0, 0.04, 0, 0, 0.1, 0.3, 0.01, *[0] * 7, 0.007, 0, 0, 0], [
        0.35, 26.6, 12300, 0.00086, 0.00082, 15000, 0.00013, 24000, 16500, 9000, 0.022, 12000, 1.88, 16300, 4.8e6,
        0.00035, 0.0175, 1e8, 4.44e11, 1240, 2.1, 5.78, 0.0474, 1780, 3.12], np.linspace(6, 60, 10), True),
    "HIRES": (hires, [1, *[0] * 6, 0.0057], [
        1.71, 0.43, 8.32, 0.0007, 8.75, 10.03, 0.035, 1.12, 1.745, 280, 0.69, 1.81], np.geomspace(1, 300, 10), True),
    "Lotka-Volterra": (lotka_volterra, [0.1] * 4, [1 + 0.1 * i for i in range(4)] + spread(4), np.linspace(2, 20, 10),
                       False),
    "chain": (chain, [10, *[0.1] * 19], list(1 + 0.5 * np.cos(np.arange(20))), np.linspace(2, 20, 10), False),
}


products = create_expand_pow_optimization(4)  # in the place of powers


def code(name, arguments, outputs):
    """A C++ function that fills those of its output arrays that are not null."""
    lines = []
    for target, values in outputs.items():
        shared, left = sympy.cse(list(values), sympy.numbered_symbols("s"))
        body = [f"const double {symbol} = {sympy.ccode(products(value))};" for symbol, value in shared]
        body += [f"{target}[{i}] = {sympy.ccode(products(value))};" for i, value in enumerate(left)]
        lines += [f"    if ({target} != nullptr) {{", *(f"        {line}" for line in body), "    }"]
    of = ", ".join([*(f"[[maybe_unused]] const double* {a}" for a in arguments), *(f"double* {o}" for o in outputs)])
    return "\n".join([f"inline void {name}({of}) {{", *lines, "}"])


class Cvodes:
    """What adjoint_cvodes.cpp computes of a problem."""

    def __init__(self, equations, start, parameters, times, stiff):
        n, m = len(start), len(parameters)
        arrays = {name: [sympy.Symbol(f"{name}[{i}]") for i in range(size)]
                  for name, size in (("y", n), ("p", m), ("v", n))}
        y, p, v = arrays.values()
        f = sympy.Matrix(equations(y, p))
        jacobian, by_parameters = f.jacobian(y), f.jacobian(p)
        weighted = sympy.Matrix(v).T
        along = "\n".join(f"case {k}: return along_{k}(y, p, v, to);" for k in range(m))
        text = "\n".join([
            f"constexpr bool stiff = {str(stiff).lower()};\nconstexpr int n_state = {n}, n_parameter = {m};",
            code("rhs", ["y", "p"], {"to": f}),
            code("jacobian", ["y", "p"], {"to": jacobian.T}),  # by columns
            code("transposed", ["y", "p", "v"], {"to": -weighted * jacobian,
                                                 "of_parameters": -weighted * by_parameters}),
            *(code(f"along_{k}", ["y", "p", "v"], {"to": jacobian * sympy.Matrix(v) + by_parameters[:, k]})
              for k in range(m)),
            f"inline void along(int k, const double* y, const double* p, const double* v, double* to) {{\n"
            f"switch (k) {{\n{along}\n}}\n}}\n"])
        with tempfile.TemporaryDirectory() as made:
            pathlib.Path(made, "problem.hpp").write_text(text)
            library = pathlib.Path(made, "problem.so")
            subprocess.run(["c++", "-std=c++20", "-O3", "-march=native", "-shared", "-fPIC", f"-I{made}",
                            f"-I{folder.parent.parent}", folder / "adjoint_cvodes.cpp", "-o", library,
                            "-lsundials_cvodes", "-lsundials_nvecserial"], check=True)
            self._function = ctypes.CDLL(str(library)).gradients
        self._start, self._times = np.array(start, float), np.array(times, float)

    def __call__(self, rows, weights, tolerance, gradients=True, forward=False):
        """Losses, gradients and seconds."""
        rows, weights = np.ascontiguousarray(rows), np.ascontiguousarray(weights)
        losses, found, seconds = np.zeros(len(rows)), np.zeros(rows.shape), ctypes.c_double()
        address = lambda array: ctypes.c_void_p(array.ctypes.data)  # noqa: E731
        if self._function(len(rows), address(rows), address(self._start), address(weights), address(self._times),
                          len(self._times), ctypes.c_double(tolerance), int(forward), address(losses),
                          address(found) if gradients else None, ctypes.byref(seconds)):
            raise RuntimeError("CVODES failed")
        return losses, found, seconds.value


def best(call, calls):
    """The least time of several calls, after one that compiles, and the last result."""
    found = np.inf
    for _ in range(calls + 1):
        begin = time.process_time()
        result = call()
        found = min(found, time.process_time() - begin)
    return found, result


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--instances", type=int, default=256)
    parser.add_argument("--calls", type=int, default=3)
    parser.add_argument("--tolerance", type=float, default=1e-8)
    parser.add_argument("--problems", nargs="+", choices=problems, default=list(problems))
    options = parser.parse_args()
    right = True
    print("| problem | states | parameters | error | CVODES' error | loss | gradient | CVODES' loss | "
          "CVODES' gradient |\n|---|---|---|---|---|---|---|---|---|")
    for name in options.problems:
        equations, start, values, times, stiff = problem = problems[name]
        states = my.states([f"y{i}" for i in range(len(start))])
        parameters = my.parameters([f"p{i}" for i in range(len(values))])
        model = my.model(dict(zip(states, equations(states, parameters))), name="problem")
        call = dict(start=dict(zip(states, start)), time=(0, times[-1]), method="rodas_5p" if stiff else "tsitouras_5",
                    device="cpu:1")
        run = my.solve(model, dict(zip(parameters, values)), samples=times, **call)
        sizes = np.array([np.abs(run.samples[s.value[1]]).max() for s in states])
        tolerances = dict(rtol=options.tolerance, atol=list(options.tolerance * sizes))
        function = my.batched(model, free=parameters, of=states, samples=times, adjoint=True, **call, **tolerances)
        rows = values * np.random.default_rng(1).uniform(0.9, 1.1, (options.instances, len(values)))
        plain, _ = best(lambda: function(rows), options.calls)  # noqa: B023
        cost, (_, gradient) = best(lambda: function.vjp(rows, lambda y: 2 * y / sizes**2), options.calls)  # noqa: B023
        cvodes = Cvodes(*problem)
        plain_there = min(cvodes(rows, 1 / sizes, options.tolerance, gradients=False)[2] for _ in range(options.calls))
        there = [cvodes(rows, 1 / sizes, options.tolerance) for _ in range(options.calls)]
        few = rows[:4]
        expected = cvodes(few, 1 / sizes, 1e-12, forward=True)[1] * few  # by the logarithms of the parameters
        largest = np.abs(expected).max(axis=1, keepdims=True)
        errors = [np.abs((found[:4] * few - expected) / largest).max() for found in (gradient, there[0][1])]
        right = right and errors[0] <= 1e3 * options.tolerance
        each = np.array([plain, cost, plain_there, min(t[2] for t in there)]) / len(rows) * 1e6
        print(f"| {name} | {len(start)} | {len(values)} | {errors[0]:.1e} | {errors[1]:.1e} | "
              + " | ".join(f"{t:.3g}" for t in each) + " |", flush=True)
    return 0 if right else 1


if __name__ == "__main__":
    sys.exit(main())
